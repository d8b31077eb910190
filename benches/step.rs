//! What a tick costs, and what each part of it adds: `cargo bench --bench step`.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "a bench, not the engine")]

use criterion::{Bencher, BenchmarkId, Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::{Duration, Instant};
use tamias2d::{Attractor, BodyDef, BodyKind, ColliderDef, Commands, Length, Shape, Sleeping, Vec2, World, WorldDef};

/// `count` free bodies on a grid, each with its own velocity and spin, with or without a box of 1 m.
fn free_bodies(count: u32, gravity: f64, solid: bool) -> World {
    let one = "1".parse().expect("in range");
    let shape = Shape::Box { width: one, height: one };
    let gravity = Vec2::from_f64(0.0, gravity).expect("in range");
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).expect("accepted");
    for i in 0..count {
        let (column, row) = (f64::from(i % 100), f64::from(i / 100));
        world
            .create_body(&BodyDef {
                position: Vec2::from_f64(3.0 * column, 3.0 * row).expect("in range"),
                velocity: Vec2::from_f64(0.01 * row - 0.3, 0.02 * column).expect("in range"),
                angular_velocity: "0.75".parse().expect("in range"),
                colliders: if solid { vec![ColliderDef::new(shape.clone())] } else { Vec::new() },
                ..BodyDef::default()
            })
            .expect("accepted");
    }
    world
}

/// A pyramid of unit boxes on the ground, after a second: it comes to rest later. With sleeping it must not sleep.
fn pyramid(rows: u32, sleeping: Option<Sleeping>) -> World {
    let gravity = Vec2::from_f64(0.0, -9.81).expect("in range");
    let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
    let mut create = |kind, x, y, width: &str| {
        let (width, height) = (width.parse().expect("in range"), "1".parse().expect("in range"));
        let (position, colliders) =
            (Vec2::from_f64(x, y).expect("in range"), vec![ColliderDef::new(Shape::Box { width, height })]);
        let def = BodyDef { kind, position, colliders, allow_sleep: false, ..BodyDef::default() };
        world.create_body(&def).expect("accepted");
    };
    create(BodyKind::Static, 0.0, -0.5, "1000");
    for row in 0..rows {
        for i in 0..rows - row {
            let x = 1.01 * (f64::from(i) - f64::from(rows - row) / 2.0);
            create(BodyKind::Dynamic, x, f64::from(row) + 0.5, "1");
        }
    }
    for _ in 0..60 {
        world.step();
    }
    world
}

/// Columns of boxes on the ground, an island each, all asleep.
fn sleepers(columns: u32, rows: u32) -> World {
    let gravity = Vec2::from_f64(0.0, -9.81).expect("in range");
    let sleeping = Some(Sleeping::default());
    let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
    let mut create = |kind, x, y, width: &str| {
        let (width, height) = (width.parse().expect("in range"), "1".parse().expect("in range"));
        let (position, colliders) =
            (Vec2::from_f64(x, y).expect("in range"), vec![ColliderDef::new(Shape::Box { width, height })]);
        world.create_body(&BodyDef { kind, position, colliders, ..BodyDef::default() }).expect("accepted");
    };
    create(BodyKind::Static, 0.0, -0.5, "15000");
    for column in 0..columns {
        for row in 0..rows {
            create(BodyKind::Dynamic, 1.5 * f64::from(column), f64::from(row) + 0.5, "1");
        }
    }
    while world.bodies().any(|body| body.kind() == BodyKind::Dynamic && body.is_awake()) {
        world.step();
    }
    world
}

/// Boxes and discs that have fallen into a bin 30 m wide, after as many seconds.
fn pile(count: u32, sleeping: Option<Sleeping>, seconds: u32) -> World {
    let gravity = Vec2::from_f64(0.0, -9.81).expect("in range");
    let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
    let length = |metres: f64| Length::from_f64(metres).expect("in range");
    let mut create = |kind, x, y, shape| {
        let (position, colliders) = (Vec2::from_f64(x, y).expect("in range"), vec![ColliderDef::new(shape)]);
        world.create_body(&BodyDef { kind, position, colliders, ..BodyDef::default() }).expect("accepted");
    };
    create(BodyKind::Static, 0.0, -1.0, Shape::Box { width: length(40.0), height: length(2.0) });
    for x in [-16.0, 16.0] {
        create(BodyKind::Static, x, 60.0, Shape::Box { width: length(2.0), height: length(124.0) });
    }
    for i in 0..count {
        let (x, y) = (f64::from(i % 25) * 1.15 - 13.8 + 0.1 * f64::from(i % 3), 1.0 + 1.2 * f64::from(i / 25));
        let size = 0.6 + 0.1 * f64::from(i % 5);
        let shape = match i % 4 {
            0 => Shape::Circle { radius: length(size / 2.0) },
            _ => Shape::Box { width: length(size), height: length(1.4 - size) },
        };
        create(BodyKind::Dynamic, x, y, shape);
    }
    for _ in 0..60 * seconds {
        world.step();
    }
    world
}

/// The first ticks of a world, of copies again and again: if it went on it would come to rest.
fn moving(b: &mut Bencher<'_>, world: &World) {
    const TICKS: u64 = 60;
    b.iter_custom(|count| {
        let (mut copy, mut spent) = (world.clone(), Duration::ZERO);
        for from in (0..count).step_by(TICKS as usize) {
            copy.clone_from(world);
            let begin = Instant::now();
            (from..count.min(from + TICKS)).for_each(|_| copy.step());
            spent += begin.elapsed();
        }
        spent
    });
}

/// Runs until a tick changes nothing that is hashed but the tick.
fn come_to_rest(world: &mut World) {
    let state = |world: &World| world.hash_parts()[1..].to_vec();
    let mut last = state(world);
    loop {
        world.step();
        let now = state(world);
        if now == last {
            return;
        }
        last = now;
    }
}

fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step");
    for count in [100, 1_000, 10_000, 100_000] {
        for (name, solid) in [("free", false), ("free, with colliders", true)] {
            let mut world = free_bodies(count, -9.8, solid);
            group.bench_function(BenchmarkId::new(name, count), |b| b.iter(|| world.step()));
        }
    }
    let mut world = free_bodies(1_000, 0.0, false);
    let star =
        Attractor { position: Vec2::from_f64(0.0, -500.0).expect("in range"), mu: "1000".parse().expect("in range") };
    world.create_attractor(star).expect("accepted");
    group.bench_function("attractor/1000", |b| b.iter(|| world.step()));
    for rows in [10, 40] {
        let mut world = pyramid(rows, None);
        group.bench_function(BenchmarkId::new("pyramid", rows), |b| moving(b, &world));
        come_to_rest(&mut world);
        group.bench_function(BenchmarkId::new("pyramid at rest", rows), |b| b.iter(|| world.step()));
    }
    let world = pile(1000, None, 4);
    group.bench_function("pile/1000", |b| moving(b, &world));
    // What sleeping costs what is awake.
    let world = pyramid(40, Some(Sleeping::default()));
    group.bench_function("pyramid that may sleep/40", |b| moving(b, &world));
    group.finish();

    let mut group = c.benchmark_group("asleep");
    for (columns, rows) in [(1, 1), (1000, 1), (100, 10), (1000, 10)] {
        let mut world = sleepers(columns, rows);
        let count = columns * rows;
        group.bench_function(BenchmarkId::new(format!("islands of {rows}"), count), |b| b.iter(|| world.step()));
    }
    let mut world = pyramid(40, Some(Sleeping::default()));
    for id in world.bodies().map(|body| body.id()).collect::<Vec<_>>() {
        world.set_allow_sleep(id, true).expect("accepted");
    }
    while world.bodies().any(|body| body.kind() == BodyKind::Dynamic && body.is_awake()) {
        world.step();
    }
    group.bench_function("pyramid/40", |b| b.iter(|| world.step()));
    let mut world = pile(1000, Some(Sleeping::default()), 40);
    let awake = world.bodies().filter(|body| body.kind() == BodyKind::Dynamic && body.is_awake()).count();
    group.bench_function(format!("pile, {awake} awake/1000"), |b| b.iter(|| world.step()));
    for count in [1u32, 10_000] {
        let mut world = sleepers(count.div_ceil(10), count.min(10));
        // A box on the ground that must not sleep.
        let one = "1".parse().expect("in range");
        let def = BodyDef {
            position: Vec2::from_f64(-10.0, 0.5).expect("in range"),
            colliders: vec![ColliderDef::new(Shape::Box { width: one, height: one })],
            allow_sleep: false,
            ..BodyDef::default()
        };
        world.create_body(&def).expect("accepted");
        group.bench_function(BenchmarkId::new("beside one awake", count), |b| b.iter(|| world.step()));
        group.bench_function(BenchmarkId::new("beside one awake, hash", count), |b| b.iter(|| black_box(world.hash())));
    }
    group.finish();

    let mut group = c.benchmark_group("state");
    let world = free_bodies(10_000, -9.8, false);
    group.bench_function("hash/10000", |b| b.iter(|| black_box(world.hash())));
    let mut copy = world.clone();
    group.bench_function("clone_from/10000", |b| b.iter(|| copy.clone_from(black_box(&world))));
    let mut bytes = Vec::new();
    group.bench_function("save/10000", |b| b.iter(|| world.save_into(&mut bytes)));
    group.bench_function("load/10000", |b| b.iter(|| World::load(&bytes).expect("just saved")));
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
