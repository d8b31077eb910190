//! What each fuzz target does with its input: whatever that is, nothing panics, hangs, takes memory without bound or breaks an
//! invariant. Each says whether its input was read to the end, so that one sees what a corpus reaches. `tests/corpus.rs` of the engine
//! compiles these files as well, and gives them the committed corpus and fresh seeds.

pub mod commands;
mod course;
mod draw;
pub mod evidence;
pub mod hello;
mod mend;
pub mod replay;
pub mod scene;
pub mod seeds;
pub mod snapshot;

/// Longer input is passed over: what a tick takes grows with what there is, and without a bound the fuzzers look for nothing else.
const LONGEST: usize = 1 << 15;
/// Worlds with more bodies, or colliders, are read but not stepped, for the same reason: 60 bodies that strike each other at
/// 20 000 m/s use up a tick's budget of impacts in 0.5 s, optimised and without a sanitizer.
const MOST_BODIES: u32 = 24;
const MOST_COLLIDERS: usize = 96;
/// So many ticks are played at most.
const MOST_TICKS: u64 = 32;

/// Whether a world is small enough to be stepped.
fn is_small(world: &tamias2d::World) -> bool {
    world.body_count() <= MOST_BODIES && world.colliders().count() <= MOST_COLLIDERS
}

/// Every invariant, or a panic that names the broken one.
fn sound(world: &tamias2d::World) {
    if let Err(reason) = world.check() {
        panic!("tick {}: {reason}", world.tick());
    }
}
