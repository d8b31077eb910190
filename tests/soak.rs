//! Long runs beside twins: taken back, read from saves, by several threads (with that feature), recorded and played, moved, turned. No
//! bit differs, or the first tick and field that do are named.
//!
//! The long ones: `.ci/soak`, which compares what they print, hashes on the way and a digest of all final states, between
//! builds; or one build's by `cargo test --release --features threads --test soak -- --ignored --nocapture`.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;
#[path = "common/solid.rs"]
mod solid;
#[path = "common/weather.rs"]
mod weather;

use common::position;
use std::io::Cursor;
use std::time::Instant;
use tamias2d::replay::{Player, Recorder, Recording, Segment};
use tamias2d::{Command, Commands, Rollback, Threads, Vec2, Velocity, World};
use weather::{View, Weather};

/// So far a rollback goes.
const DEPTH: u64 = 9;

/// A world that is as another one must be, or the first field that is not.
fn same(what: &str, world: &World, twin: &World) -> Result<(), String> {
    // The twin's as its memory holds it: a digest that was kept would be equal wherever it was taken over without its slots.
    if world.hash_parts() == twin.hash_parts_afresh() {
        return Ok(());
    }
    let found = world.diff(twin);
    let field = found.first().map_or_else(|| "the hash alone".into(), ToString::to_string);
    Err(format!("{what}, tick {}: {field}", world.tick()))
}

fn give(world: &mut World, commands: &[Command]) {
    for command in commands {
        let _refused_or_not = world.apply(command.clone());
    }
}

/// Two threads that cut up even the shortest loops; without the feature, the one that calls.
fn threads() -> Threads {
    #[cfg(feature = "threads")]
    return Threads::eager(2).expect("they start");
    #[cfg(not(feature = "threads"))]
    Threads::default()
}

/// A world that goes on from a save of it, anew every some ticks, one that is taken back, and one that threads step.
struct Twins {
    loaded: World,
    rolled: World,
    shared: World,
    threads: Threads,
    ring: Rollback,
    /// The commands of the last ticks, the latest last.
    past: Vec<Vec<Command>>,
    every: u64,
}

impl Twins {
    fn new(world: &World, threads: &Threads, every: u64) -> Twins {
        let (ring, threads) = (Rollback::new(DEPTH as u32 + 1), threads.clone());
        let [loaded, rolled, shared] = [world, world, world].map(World::clone);
        Twins { loaded, rolled, shared, threads, ring, past: Vec::new(), every }
    }

    /// The tick that the world has made; `deep` says how far back the way goes this time.
    fn tick(&mut self, world: &World, commands: Vec<Command>, deep: u64) -> Result<(), String> {
        give(&mut self.loaded, &commands);
        self.loaded.step();
        same("read from a save", world, &self.loaded)?;
        give(&mut self.shared, &commands);
        // Not in every tick: on busy cores threads wait for each other, milliseconds a tick.
        match world.tick() % 4 {
            0 => self.shared.step_on(&self.threads),
            _ => self.shared.step(),
        }
        same("by threads", world, &self.shared)?;
        self.past.push(commands);
        if self.past.len() as u64 > DEPTH {
            self.past.remove(0);
        }
        self.ring.save(&self.rolled);
        if world.tick() % self.every == 0 {
            let back = (1 + deep % DEPTH).min(self.past.len() as u64);
            let then = world.tick() - back;
            self.ring.restore(&mut self.rolled, then).map_err(|error| error.to_string())?;
            self.loaded = World::load(&world.save()).map_err(|error| error.to_string())?;
        }
        while self.rolled.tick() < world.tick() {
            let ago = (world.tick() - self.rolled.tick()) as usize;
            self.ring.save(&self.rolled);
            give(&mut self.rolled, &self.past[self.past.len() - ago]);
            self.rolled.step();
        }
        same("taken back", world, &self.rolled)
    }
}

/// A room by its seed for some ticks, with all twins. The hash at the end.
fn room(seed: u64, ticks: u64, threads: &Threads) -> Result<u64, String> {
    let (def, mut weather) = Weather::new(seed);
    let far = 1i64 << (36 + seed % 24);
    let views = [View::Moved([far, -far]), View::Turned];
    let options = Recording { keyframe_seconds: 5, ..Recording::default() };
    let mut main = Recorder::with(World::new(&def).expect("accepted"), Vec::new(), options).expect("memory takes all");
    let mut twins = Twins::new(main.world(), threads, 3 + seed % 11);
    let mut seen = views.map(|view| World::new(&view.def(&def)).expect("accepted"));
    for tick in 0..ticks {
        let mut commands = if tick == 0 { weather.begin() } else { Vec::new() };
        commands.extend(weather.commands(main.world()));
        for command in &commands {
            let reply = main.apply(command.clone());
            for (world, view) in seen.iter_mut().zip(views) {
                let other = world.apply(view.command(command.clone()));
                if other.is_ok() != reply.is_ok() {
                    return Err(format!(
                        "seed {seed}, tick {tick}, {view:?}: {command:?} gives {reply:?} and {other:?}"
                    ));
                }
            }
        }
        main.step();
        let world = main.world();
        twins.tick(world, commands, tick / 7).map_err(|error| format!("seed {seed}: {error}"))?;
        for (other, view) in seen.iter_mut().zip(views) {
            other.step();
            if let Some(field) = view.difference(world, other) {
                return Err(format!("seed {seed}, tick {}, {view:?}: {field}", world.tick()));
            }
        }
        if tick % 50 == 0 {
            world.check().map_err(|error| format!("seed {seed}, tick {}: {error}", world.tick()))?;
        }
    }
    let hash = main.world().hash();
    let file = main.finish().expect("memory takes all");
    played(&file, ticks, hash).map_err(|error| format!("seed {seed}: {error}"))?;
    Ok(hash)
}

/// What was recorded plays to the same end, from its beginning and from its keyframes.
fn played(file: &[u8], ticks: u64, hash: u64) -> Result<(), String> {
    let open = || Player::new(file).map_err(|error| error.to_string());
    let summary = open()?.verify().map_err(|error| error.to_string())?;
    if (summary.ticks, summary.hash) != (ticks, hash) {
        return Err(format!("the recording ends otherwise: {summary:?}"));
    }
    let contents = open()?.inspect().map_err(|error| error.to_string())?;
    if let Some(last) = Segment::few(&contents, 4).last() {
        last.verify(Cursor::new(file), |_| ()).map_err(|error| format!("the last segment: {error}"))?;
    }
    Ok(())
}

/// Rooms by their seeds; all differences are told.
fn rooms(seeds: std::ops::Range<u64>, ticks: u64) {
    let (start, count) = (Instant::now(), seeds.end - seeds.start);
    let (threads, mut digest, mut found) = (threads(), 0u64, Vec::new());
    for seed in seeds {
        match room(seed, ticks, &threads) {
            // Equal on all machines and in all builds.
            Ok(hash) => digest = digest.rotate_left(1) ^ hash,
            Err(error) => {
                println!("{error}");
                found.push(error);
            }
        }
        if seed % 20 == 19 {
            println!("{} seeds: {:.0} s, {} differ", seed + 1, start.elapsed().as_secs_f64(), found.len());
        }
    }
    println!(
        "{count} seeds of {ticks} ticks, digest {digest:016x}, {} differ, {:.0} s",
        found.len(),
        start.elapsed().as_secs_f64()
    );
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The alarms ring: one bit of one body.
#[test]
fn a_difference_is_named_by_tick_and_field() {
    let (def, mut weather) = Weather::new(3);
    let mut world = World::new(&def).expect("accepted");
    give(&mut world, &weather.begin());
    world.step();
    let mut other = world.clone();
    let body = world.bodies().last().expect("there are some").id();
    let v = world.body(body).expect("it exists").velocity();
    let v = Vec2::new(v.x, Velocity::from_bits(v.y.to_bits() ^ 1));
    other.set_velocity(body, v).expect("in range");
    let error = same("changed", &world, &other).expect_err("one bit differs");
    assert!(error.starts_with(&format!("changed, tick 1: bodies[{}].velocity.y: ", body.index)), "{error}");
    let error = View::Moved([0, 0]).difference(&world, &other).expect("one bit differs");
    assert!(error.starts_with(&format!("{body}.velocity.y: ")), "{error}");
}

#[test]
fn rooms_and_their_twins_agree_for_ten_thousand_ticks_in_all() {
    rooms(0..20, 500);
}

#[test]
#[ignore = "takes minutes: cargo test --release --test soak -- --ignored --nocapture two_hundred"]
fn two_hundred_rooms_and_their_twins_agree() {
    rooms(0..200, 5000);
}

/// A drum that turns, for a long time; some ticks of every thousand with twins.
fn drum(ticks: u64) {
    let (mut world, ids) = scenes::tumbler();
    let start = Instant::now();
    let (threads, mut twins) = (threads(), None);
    for tick in 1..=ticks {
        world.step();
        match tick % 1000 {
            0 => {
                world.check().expect("every invariant holds");
                twins = Some(Twins::new(&world, &threads, 5));
                for &id in &ids {
                    let (x, y) = position(&world, id);
                    assert!(x.hypot(y) < 14.9, "{id} got out in tick {tick}: {x}, {y}");
                }
            }
            1..=20 => {
                if let Some(twins) = &mut twins {
                    twins.tick(&world, Vec::new(), tick / 1000).unwrap_or_else(|error| panic!("{error}"));
                }
            }
            _ => twins = None,
        }
        if tick % (ticks / 10) == 0 {
            let entries = world.status().entries().len();
            let seconds = start.elapsed().as_secs_f64();
            println!("{tick} ticks: hash {:016x}, {entries} status entries, {seconds:.0} s", world.hash());
        }
    }
}

#[test]
fn a_tumbler_and_its_twins_agree_for_a_thousand_ticks() {
    drum(1100);
}

#[test]
#[ignore = "takes half an hour: cargo test --release --test soak -- --ignored --nocapture a_million"]
fn a_million_ticks_of_a_tumbler_and_its_twins_agree() {
    drum(1_000_000);
}
