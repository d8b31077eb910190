//! Several threads step one world: the same bits as one, whatever is cut up between them and wherever.
#![cfg(feature = "threads")]
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "streams/play/mod.rs"]
mod streams;

use common::{Storm, disc, num, rectangle, world};
use std::path::Path;
use std::thread::scope;
use streams::{SEEDS, golden, random};
use tamias2d::replay::{Flight, Player, Recorder};
use tamias2d::{BodyDef, BodyKind, ColliderDef, Commands, Mu, Threads, Vec2, World};

const COUNTS: [usize; 5] = [1, 2, 3, 4, 8];

/// Even the shortest loops are cut up.
fn eager() -> Vec<Threads> {
    COUNTS.map(|count| Threads::eager(count).expect("they start")).into()
}

/// What a tick leaves and tells.
fn told(world: &World) -> (u64, String) {
    (world.hash(), format!("{:?} {:?}", world.events(), world.collisions()))
}

fn alike(world: &World, ticks: u64, threads: &[Threads]) {
    let mut alone = world.clone();
    let mut worlds: Vec<World> = threads.iter().map(|_| world.clone()).collect();
    for _ in 0..ticks {
        alone.step();
        for (world, threads) in worlds.iter_mut().zip(threads) {
            world.step_on(threads);
            assert!(told(world) == told(&alone), "tick {} by {} threads", world.tick(), threads.count());
        }
    }
    for world in &worlds {
        assert_eq!((world.check(), world.diff(&alone).len()), (Ok(()), 0));
    }
}

/// A pyramid of boxes.
fn pyramid(rows: u32) -> World {
    let mut world = world(0.0, -9.81);
    add(&mut world, BodyKind::Static, [0.0, -0.5], [0.0; 2], rectangle(1000.0, 1.0));
    for row in 0..rows {
        for i in 0..rows - row {
            let x = 1.01 * (f64::from(i) - f64::from(rows - row) / 2.0);
            add(&mut world, BodyKind::Dynamic, [x, f64::from(row) + 0.5], [0.0; 2], rectangle(1.0, 1.0));
        }
    }
    world
}

fn add(world: &mut World, kind: BodyKind, [x, y]: [f64; 2], [vx, vy]: [f64; 2], collider: ColliderDef) {
    let position = Vec2::from_f64(x, y).expect("in range");
    let velocity = Vec2::from_f64(vx, vy).expect("in range");
    let def = BodyDef { kind, position, velocity, colliders: vec![collider], ..BodyDef::default() };
    world.create_body(&def).expect("accepted");
}

/// Boxes and discs that fall into a bin, over each other.
fn pile(count: u32) -> World {
    let mut world = world(0.0, -9.81);
    add(&mut world, BodyKind::Static, [0.0, -1.0], [0.0; 2], rectangle(80.0, 2.0));
    for x in [-32.0, 32.0] {
        add(&mut world, BodyKind::Static, [x, 60.0], [0.0; 2], rectangle(2.0, 124.0));
    }
    for i in 0..count {
        let at = [f64::from(i % 50) * 1.2 - 29.0 + 0.1 * f64::from(i % 3), 0.6 + 1.1 * f64::from(i / 50)];
        let size = 0.6 + 0.1 * f64::from(i % 5);
        let collider = if i % 4 == 0 { disc(size / 2.0) } else { rectangle(size, 1.4 - size) };
        add(&mut world, BodyKind::Dynamic, at, [0.0, -2.0 - 0.01 * f64::from(i % 7)], collider);
    }
    world
}

/// Goldens and random scenes, each by one of the counts, or by all.
fn play(all: bool) {
    let threads = eager();
    let alike = |name: &str, at: usize, lines: &dyn Fn(&Threads) -> Result<String, String>| {
        let alone = lines(&Threads::default()).expect("it plays");
        for (_, threads) in threads.iter().enumerate().filter(|&(count, _)| all || count == at % COUNTS.len()) {
            assert!(lines(threads).expect("it plays") == alone, "{name} by {} threads", threads.count());
        }
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("replays");
    let entries = folder.read_dir().expect("it is there").map(|entry| entry.expect("it can be read").path());
    let mut replays: Vec<_> = entries.filter(|path| path.extension().is_some_and(|end| end == "replay")).collect();
    replays.sort();
    assert!(replays.len() > 10);
    for (at, path) in replays.iter().enumerate() {
        let replay = std::fs::read(path).expect("it can be read");
        alike(&path.display().to_string(), at, &|threads| golden("", &replay, threads));
    }
    for seed in SEEDS {
        alike(&format!("scene {seed}"), seed as usize, &|threads| random(seed, threads));
    }
}

#[test]
fn goldens_and_random_scenes_are_the_same() {
    play(false);
}

#[test]
#[ignore = "minutes; .ci/cross does it with one, two and eight: cargo test --release --features threads --test threads -- --ignored"]
fn goldens_and_random_scenes_are_the_same_by_every_count() {
    play(true);
}

/// Worlds that are cut up as in a game: where that pays.
#[test]
fn large_worlds_are_the_same() {
    let threads = COUNTS.map(|count| Threads::new(count).expect("they start"));
    alike(&pyramid(80), 12, &threads);
    alike(&pile(3000), 60, &threads);
    let mut flight = world(0.0, -9.81);
    for i in 0..70_000u32 {
        let (column, row) = (f64::from(i % 300), f64::from(i / 300));
        // One in a hundred leaves the range at once, so that pieces have faults.
        let (x, vx) = if i % 100 == 99 { (1e9 - column, 30_000.0) } else { (3.0 * column, row * 0.01) };
        add(&mut flight, BodyKind::Dynamic, [x, 3.0 * row], [vx, column * 0.01], disc(0.4));
    }
    alike(&flight, 8, &threads);
    flight.step_on(&threads[2]);
    assert!(!flight.status().is_clear());
}

/// Bodies that attract each other, some of them damped.
#[test]
fn attraction_is_the_same() {
    let mut stars = world(0.0, 0.0);
    for i in 0..300u32 {
        let (x, y) = (f64::from(i % 20) * 7.0 + 0.3 * f64::from(i % 7), f64::from(i / 20) * 9.0);
        let def = BodyDef {
            position: Vec2::from_f64(x, y).expect("in range"),
            mu: if i % 3 == 0 { num("20") } else { Mu::ZERO },
            linear_damping: num(if i % 11 == 0 { "0.5" } else { "0" }),
            colliders: vec![rectangle(0.5, 0.5)],
            ..BodyDef::default()
        };
        stars.create_body(&def).expect("accepted");
    }
    alike(&stars, 100, &COUNTS.map(|count| Threads::new(count).expect("they start")));
    alike(&stars, 40, &eager());
}

/// Whoever steps, a recording is the same to the byte, and so is what memory holds after each stage.
#[test]
fn recordings_and_evidence_are_the_same() {
    let record = |threads: &Threads| {
        let (mut storm, mut flight) = (Storm::solid(5, 20.0), Flight::new(4));
        let mut game = Recorder::new(world(0.0, -9.81), Vec::new()).expect("it can be written");
        game.use_threads(threads);
        for _ in 0..150 {
            for _ in 0..4 {
                let _ = storm.act(&mut game);
            }
            game.step();
        }
        let mut world = game.world().clone();
        for _ in 0..4 {
            flight.step_on(&mut world, threads);
        }
        let evidence: Vec<_> =
            (0..4).map(|back| flight.evidence(world.tick() - back).expect("it is held").encode()).collect();
        (game.finish().expect("it was written"), evidence)
    };
    let alone = record(&Threads::default());
    for threads in eager() {
        assert!(record(&threads) == alone, "by {} threads", threads.count());
        let mut player = Player::new(alone.0.as_slice()).expect("it is whole");
        player.use_threads(&threads);
        assert_eq!(player.verify().expect("it plays").ticks, 150);
    }
}

/// Worlds that are stepped at the same time by the same threads wait for nobody.
#[test]
fn threads_serve_several_worlds() {
    let threads = Threads::eager(3).expect("they start");
    scope(|scope| {
        for rows in [10, 11, 12, 13] {
            let threads = threads.clone();
            scope.spawn(move || alike(&pyramid(rows), 60, &[threads]));
        }
    });
}

#[test]
fn none_and_one_are_the_thread_that_calls() {
    for threads in [Threads::default(), Threads::new(0).expect("none"), Threads::new(1).expect("none")] {
        assert_eq!(threads.count(), 1);
    }
    assert_eq!(Threads::new(3).expect("they start").count(), 3);
}
