//! Piles that fall together and come to rest, with restitution: no endless impacts, no energy from nowhere, none lost.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, disc, rectangle, world};
use solid::{add, energy, fastest, fixed, polygon, solid, surface, turned, worst_overlap};
use std::time::Instant;
use tamias2d::{BodyDef, BodyKind, World};

/// A pile of boxes, polygons and discs between walls, dropped from a grid.
fn heap(count: u32, e: f64, seed: u64, discs: bool) -> World {
    let (mut world, mut rng) = (world(0.0, -9.81), Rng(seed));
    add(&mut world, fixed(0.0, -1.0, surface(rectangle(60.0, 2.0), 0.6, e)));
    for x in [-9.0, 9.0] {
        add(&mut world, fixed(x, 30.0, surface(rectangle(2.0, 64.0), 0.6, e)));
    }
    for at in 0..count {
        let size = 0.4 + 0.5 * rng.unit();
        let shape = match rng.below(4) {
            0 if discs => disc(size * 0.5),
            1 => {
                let corner = |x: f64, y: f64| (x * size, y * size);
                polygon(&[corner(-0.5, -0.4), corner(0.6, -0.5), corner(0.5, 0.4), corner(-0.1, 0.6)])
            }
            _ => rectangle(size, 0.4 + 0.5 * rng.unit()),
        };
        let (x, y) = (f64::from(at % 12) * 1.25 - 6.9 + 0.1 * rng.unit(), 1.0 + f64::from(at / 12) * 1.3);
        let body = solid(x, y, surface(shape, 0.6, e));
        add(&mut world, BodyDef { angle: turned(6.0 * rng.unit()), ..body });
    }
    world
}

/// How many dynamic bodies are faster than 1 cm/s, turning counted as m/s at 1 m.
fn restless(world: &World) -> usize {
    let fast = |body: &tamias2d::Body<'_>| {
        let (x, y) = body.velocity().to_f64();
        x.hypot(y).max(body.angular_velocity().to_f64().abs()) > 1e-2
    };
    world.bodies().filter(|body| body.kind() == BodyKind::Dynamic && fast(body)).count()
}

/// The kinetic energy, in J.
fn motion(world: &World) -> f64 {
    world.bodies().map(|body| body.kinetic_energy().to_f64()).sum()
}

/// Lets a pile fall for as long as its highest body needs, and then `seconds` more.
///
/// Polygons come to rest all of them. A disc that the pile presses on another one, or into a trough, rolls to and fro like
/// a pendulum and rocks its neighbours: nothing in the model slows rolling, and it loses no energy in a minute.
fn settles(count: u32, e: f64, seconds: f64, discs: bool) {
    let mut world = heap(count, e, 1, discs);
    let height = 1.0 + f64::from(count / 12) * 1.3;
    let landed = ((2.0 * height / 9.81).sqrt() * 60.0).ceil() as u64;
    let ticks = landed + (seconds * 60.0) as u64;
    let start = energy(&world);
    let (mut least, mut gain, mut overlap, mut quiet) = (start, 0.0f64, 0.0f64, None);
    let mut times = Vec::new();
    for tick in 1..=ticks {
        let begin = Instant::now();
        world.step();
        times.push(begin.elapsed().as_secs_f64() * 1e3);
        let now = energy(&world);
        gain = gain.max(now - least);
        least = least.min(now);
        if tick % 10 == 0 {
            overlap = overlap.max(worst_overlap(&world));
            if restless(&world) > 3 {
                quiet = None;
            } else if quiet.is_none() {
                quiet = Some((tick.saturating_sub(landed)) as f64 / 60.0);
            }
        }
    }
    times.sort_by(f64::total_cmp);
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    let (settled, speed, fall) = (worst_overlap(&world), fastest(&world), start - energy(&world));
    println!(
        "{count}, e {e}: at rest {quiet:.1?} s after landing, {speed:.1e} m/s; overlap {overlap:.4} m on the way, {settled:.4} m settled; \
         gained {:.1e} of the fall at most; {worst:.1} ms at worst, median {median:.2} ms; {:?}",
        gain / fall,
        world.status().entries()
    );
    let (moving, most) = if discs { (count as usize / 4, 1e-4) } else { (0, 1e-12) };
    assert!(restless(&world) <= moving, "{count}, e {e}: {} move, {speed} m/s", restless(&world));
    assert!(motion(&world) < most * fall, "{count}, e {e}: {} J of {fall}", motion(&world));
    assert!(settled < 0.02, "{count}, e {e}: overlap {settled} m");
    // What rows push apart that overlapped as it landed: 9e-5 at most was seen.
    assert!(gain < 3e-4 * fall, "{count}, e {e}: KE + PE grew by {gain} J over its least; {fall} J were lost");
    for body in world.bodies().filter(|body| body.kind() == BodyKind::Dynamic) {
        let (x, y) = body.position().to_f64();
        assert!(x.abs() < 8.0 && y > 0.0, "{count}, e {e}: {} is at {x}, {y}", body.id());
    }
    assert!(world.status().is_clear(), "{count}, e {e}: {:?}", world.status());
    world.check().expect("every invariant holds");
}

#[test]
fn a_pile_of_100_comes_to_rest() {
    for e in [0.0, 0.3, 0.5, 0.8, 0.9] {
        settles(100, e, 10.0, false);
    }
}

#[test]
fn a_pile_of_100_with_discs_comes_to_rest_but_for_what_rolls() {
    for e in [0.0, 0.3, 0.5, 0.8, 0.9] {
        settles(100, e, 10.0, true);
    }
}

#[test]
fn a_pile_of_300_comes_to_rest() {
    for e in [0.0, 0.3, 0.5] {
        settles(300, e, 10.0, false);
    }
}

#[test]
fn a_pile_of_300_that_bounces_well_comes_to_rest() {
    for e in [0.8, 0.9] {
        settles(300, e, 10.0, false);
    }
}

#[test]
fn a_pile_of_300_with_discs_comes_to_rest_but_for_what_rolls() {
    for e in [0.0, 0.3, 0.5] {
        settles(300, e, 10.0, true);
    }
}

#[test]
fn a_pile_of_300_with_discs_that_bounces_well_comes_to_rest_but_for_what_rolls() {
    for e in [0.8, 0.9] {
        settles(300, e, 10.0, true);
    }
}
