//! Faults in memory: each is put where it can be, and must be named.
#![allow(clippy::arithmetic_side_effects, clippy::disallowed_types, reason = "tests, not the engine")]

mod claims;
mod faults;
mod goldens;
mod recordings;

use crate::{
    Acceleration, Attractor, BodyDef, BodyKind, ColliderDef, Commands, Length, Shape, Sleeping, Vec2, Velocity, World,
    WorldDef,
};

/// Numbers that follow from a seed (Knuth, MMIX).
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count.max(1)
    }
}

fn at(x: f64, y: f64) -> Vec2<Length> {
    Vec2::from_f64(x, y).expect("in range")
}

fn rectangle(width: f64, height: f64) -> ColliderDef {
    let side = |side: f64| Length::from_f64(side).expect("in range");
    ColliderDef::new(Shape::Box { width: side(width), height: side(height) })
}

/// A world that has something of everything: what rests, sleeps, bounces, turns, is damped, pulled, limited, overlapped.
fn world_of_everything() -> World {
    let gravity: Vec2<Acceleration> = Vec2::from_f64(0.0, -9.8).expect("in range");
    let def = WorldDef { gravity, sleeping: Some(Sleeping::default()), ..WorldDef::default() };
    let mut world = World::new(&def).expect("accepted");
    let mut add = |kind, position, velocity: (f64, f64), colliders: Vec<ColliderDef>, user_data| {
        let velocity: Vec2<Velocity> = Vec2::from_f64(velocity.0, velocity.1).expect("in range");
        let def = BodyDef { kind, position, velocity, colliders, user_data, ..BodyDef::default() };
        world.create_body(&def).expect("accepted")
    };
    add(BodyKind::Static, at(0.0, -1.0), (0.0, 0.0), vec![rectangle(200.0, 2.0)], 0);
    let gone = add(BodyKind::Dynamic, at(90.0, 9.0), (0.0, 0.0), vec![rectangle(1.0, 1.0)], 0);
    // A pile that keeps moving, since something heavy shakes it.
    for i in 0..4u32 {
        add(
            BodyKind::Dynamic,
            at(0.1 * f64::from(i), 0.5 + f64::from(i)),
            (0.0, 0.0),
            vec![rectangle(1.0, 1.0)],
            70 + u64::from(i),
        );
    }
    let mut ball = ColliderDef::new(Shape::Circle { radius: Length::from_f64(0.4).expect("in range") });
    ball.restitution = "1".parse().expect("in range");
    let ball = add(BodyKind::Dynamic, at(0.2, 9.0), (1.0, -3.0), vec![ball], 9);
    // What falls asleep by itself.
    add(BodyKind::Dynamic, at(20.0, 0.5), (0.0, 0.0), vec![rectangle(1.0, 1.0)], 0);
    add(BodyKind::Dynamic, at(20.0, 1.5), (0.0, 0.0), vec![rectangle(1.0, 1.0)], 0);
    let paddle = add(BodyKind::Kinematic, at(-6.0, 1.2), (0.0, 0.0), vec![rectangle(4.0, 0.2)], 0);
    let corners = [(-0.6, -0.4), (0.6, -0.4), (0.0, 0.7)].map(|(x, y)| at(x, y)).to_vec();
    add(BodyKind::Dynamic, at(-6.0, 3.0), (0.0, 0.0), vec![ColliderDef::new(Shape::Polygon { vertices: corners })], 0);
    let offset = at(0.0, 1.1);
    let pair = vec![rectangle(1.0, 1.0), ColliderDef { offset, ..rectangle(1.0, 1.0) }, rectangle(0.5, 0.5)];
    add(BodyKind::Dynamic, at(30.0, 0.5), (0.0, 0.0), pair, 0);
    let sensor = ColliderDef { sensor: true, ..rectangle(30.0, 12.0) };
    add(BodyKind::Static, at(0.0, 3.0), (0.0, 0.0), vec![sensor], 0);
    let fast = add(BodyKind::Dynamic, at(-900.0, 90.0), (32767.0, 0.0), vec![], 0);
    world.set_force(fast, Vec2::from_f64(30_000.0, 0.0).expect("in range")).expect("accepted");
    world.set_angular_velocity(paddle, "9".parse().expect("in range")).expect("accepted");
    world.set_damping(ball, "0.01".parse().expect("in range"), "0.5".parse().expect("in range")).expect("accepted");
    world
        .create_attractor(Attractor { position: at(0.0, 500.0), mu: "300".parse().expect("in range") })
        .expect("accepted");
    world.destroy_body(gone).expect("accepted");
    world
}

/// A pile of so many boxes on a floor.
fn pile(count: u32) -> World {
    let gravity: Vec2<Acceleration> = Vec2::from_f64(0.0, -9.8).expect("in range");
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).expect("accepted");
    let mut add = |kind, position, collider| {
        let def = BodyDef { kind, position, colliders: vec![collider], ..BodyDef::default() };
        world.create_body(&def).expect("accepted")
    };
    add(BodyKind::Static, at(0.0, -1.0), rectangle(200.0, 2.0));
    for i in 1..count {
        let (column, row) = (f64::from(i % 20), f64::from(i / 20));
        add(BodyKind::Dynamic, at(column * 1.1 - 11.0 + row * 0.01, row + 0.5), rectangle(1.0, 1.0));
    }
    world
}

/// The commands before a tick.
fn shake(world: &mut impl Commands, tick: u64, body: crate::BodyId) {
    let force = Vec2::from_f64(40.0, -20.0).expect("in range");
    world.apply_force(body, force, None).expect("accepted");
    if tick % 50 == 7 {
        let jump = Vec2::from_f64(1.0, 6.0).expect("in range");
        world.apply_impulse(body, jump, None).expect("accepted");
    }
}

/// The body that is pushed each tick: the lowest of the pile.
const PUSHED: crate::BodyId = crate::BodyId { index: 2, generation: 0 };
