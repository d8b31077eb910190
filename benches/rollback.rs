//! What saving and going back cost, against a tick: `cargo bench --bench rollback`.
//!
//! All columns are measured in turn within each round, so that what else the machine does meets them alike; the ratios are to
//! the tick of the same round. Prints best and median.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "a bench, not the engine")]

use std::hint::black_box;
use std::time::Instant;
use tamias2d::{BodyDef, BodyKind, ColliderDef, Commands, Frame, Rollback, Shape, Sleeping, Vec2, World, WorldDef};

const ROUNDS: usize = 200;
/// As many ticks as a rollback of eight.
const DEPTH: u32 = 8;

fn unit_box(kind: BodyKind, x: f64, y: f64, width: f64) -> BodyDef {
    let width = tamias2d::Length::from_f64(width).expect("in range");
    let shape = Shape::Box { width, height: "1".parse().expect("in range") };
    let position = Vec2::from_f64(x, y).expect("in range");
    BodyDef { kind, position, colliders: vec![ColliderDef::new(shape)], ..BodyDef::default() }
}

/// A pyramid of boxes of 1 m on the ground, after as many ticks.
fn pyramid(rows: u32, sleeping: Option<Sleeping>, ticks: u32) -> World {
    let gravity = Vec2::from_f64(0.0, -9.81).expect("in range");
    let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
    world.create_body(&unit_box(BodyKind::Static, 0.0, -0.5, 1000.0)).expect("accepted");
    for row in 0..rows {
        for i in 0..rows - row {
            let x = 1.01 * (f64::from(i) - f64::from(rows - row) / 2.0);
            world.create_body(&unit_box(BodyKind::Dynamic, x, f64::from(row) + 0.5, 1.0)).expect("accepted");
        }
    }
    for _ in 0..ticks {
        world.step();
    }
    world
}

/// The times of a column, in µs, sorted at the end.
#[derive(Default)]
struct Column(Vec<f64>);

impl Column {
    fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.0.push(start.elapsed().as_secs_f64() * 1e6);
        result
    }

    fn say(&mut self, name: &str, against: &[f64]) {
        let mut ratios: Vec<f64> = self.0.iter().zip(against).map(|(time, tick)| time / tick).collect();
        let middle = |values: &mut Vec<f64>| {
            values.sort_by(f64::total_cmp);
            (values[0], values[values.len() / 2])
        };
        let ((best, median), (_, ratio)) = (middle(&mut self.0), middle(&mut ratios));
        println!("  {name:<34}{best:>10.2}{median:>10.2} µs{:>9.4} of a tick", ratio);
    }
}

/// Shoots a box into the world and takes the one away that was shot 8 ticks ago, which begins a version of the tables that
/// there was not yet.
fn shoot(world: &mut World, shot: u64) {
    let mut def = unit_box(BodyKind::Dynamic, -60.0, 30.0, 1.0);
    (def.velocity, def.user_data) = (Vec2::from_f64(5.0, 10.0).expect("in range"), shot);
    world.create_body(&def).expect("accepted");
    let old = world.bodies().find(|body| body.user_data() > 0 && body.user_data() + 8 <= shot).map(|body| body.id());
    if let Some(old) = old {
        world.destroy_body(old).expect("it is there");
    }
}

fn measure(name: &str, mut world: World) {
    let mut columns: [Column; 12] = Default::default();
    let [tick, save, restore, both, after, ring_save, ring_restore, versions, other, hash, clone, load] = &mut columns;
    let (mut frame, mut ring) = (Frame::default(), Rollback::new(DEPTH + 1));
    let (mut bytes, mut copy, mut shots) = (Vec::new(), world.clone(), 0);
    let mut shooter = world.clone();
    let mut second = Rollback::new(DEPTH + 1);
    for _ in 0..ROUNDS {
        tick.time(|| world.step());
        save.time(|| world.save_frame(&mut frame));
        for _ in 0..DEPTH {
            world.step();
        }
        restore.time(|| world.restore_frame(&frame).expect("its own"));
        after.time(|| world.step());
        both.time(|| {
            world.save_frame(&mut frame);
            world.restore_frame(&frame).expect("its own");
        });
        let now = world.tick();
        for _ in 0..DEPTH {
            ring.save(&world);
            world.step();
        }
        ring_save.time(|| ring.save(&world));
        ring_restore.time(|| ring.restore(&mut world, now).expect("held"));
        // The tables change in each tick.
        let now = shooter.tick();
        for _ in 0..DEPTH {
            second.save(&shooter);
            shots += 1;
            shoot(&mut shooter, shots);
            shooter.step();
        }
        versions.time(|| second.save(&shooter));
        other.time(|| second.restore(&mut shooter, now).expect("held"));
        hash.time(|| black_box(frame.hash()));
        clone.time(|| copy.clone_from(black_box(&world)));
        world.save_into(&mut bytes);
        load.time(|| black_box(World::load(&bytes).expect("just saved")));
    }
    let mut encoded = Vec::new();
    frame.encode_into(&mut encoded);
    let bodies = world.body_count();
    let each = |bytes: usize| bytes as f64 / f64::from(bodies);
    println!(
        "{name}: {bodies} bodies; a frame {:.1} B a body in memory, {:.1} encoded; a save {:.1}",
        each(frame.memory()),
        each(encoded.len()),
        each(bytes.len())
    );
    println!("  {:<34}{:>10}{:>10}", "", "best", "median");
    let against = tick.0.clone();
    let names = [
        "step",
        "save_frame",
        "restore_frame, 8 ticks back",
        "save_frame and restore_frame",
        "the step after it",
        "ring save",
        "ring restore, 8 ticks back",
        "ring save, other tables",
        "ring restore, other tables",
        "frame hash",
        "clone_from",
        "load",
    ];
    for (column, name) in columns.iter_mut().zip(names) {
        column.say(name, &against);
    }
}

fn main() {
    measure("pyramid of 40 rows", pyramid(40, None, 120));
    measure("pyramid of 40 rows, asleep", pyramid(40, Some(Sleeping::default()), 600));
    measure("pyramid of 10 rows", pyramid(10, None, 120));
}
