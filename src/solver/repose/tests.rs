//! Who is left out of a tick, and who is not: that the bits are the same either way, `tests/repose.rs` shows.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use crate::{
    Acceleration, Attractor, BodyDef, BodyId, BodyKind, ColliderDef, Command, Commands, Force, Friction, Length, Mu,
    Restitution, Shape, Vec2, Velocity, World, WorldDef,
};

fn block(world: &mut World, kind: BodyKind, [x, y]: [i64; 2], width: i64) -> BodyId {
    let [width, height] = [width, 1].map(|side| Length::from_bits(side << 32));
    let position = Vec2::new(Length::from_bits(x << 31), Length::from_bits(y << 31));
    let colliders = vec![ColliderDef::new(Shape::Box { width, height })];
    world.create_body(&BodyDef { kind, position, colliders, ..BodyDef::default() }).expect("accepted")
}

/// Two stacks of boxes of 1 m, 3 and 4 high, and a box that moves without end, far away in the air.
fn stacks(tick_rate: u32) -> (World, BodyId) {
    let gravity = Vec2::new(Acceleration::ZERO, Acceleration::from_bits(-10 << 48));
    let mut world = World::new(&WorldDef { gravity, tick_rate, ..WorldDef::default() }).expect("accepted");
    block(&mut world, BodyKind::Static, [0, -1], 1000);
    for row in 0..4 {
        block(&mut world, BodyKind::Dynamic, [0, 1 + 2 * row], 1);
    }
    for row in 0..3 {
        block(&mut world, BodyKind::Dynamic, [40, 1 + 2 * row], 1);
    }
    let player = block(&mut world, BodyKind::Kinematic, [200, 200], 1);
    let velocity = Vec2::new(Velocity::from_bits(1 << 46), Velocity::ZERO);
    world.set_velocity(player, velocity).expect("accepted");
    for _ in 0..300 {
        world.step();
    }
    (world, player)
}

fn held(world: &World) -> usize {
    world.solver.repose.slots().count()
}

/// How many contacts were solved in the last tick.
fn rows(world: &World) -> usize {
    world.solver.constraints.places.len()
}

#[test]
fn what_reposes_is_left_out_whatever_happens_elsewhere() {
    for tick_rate in [30, 60, 240] {
        let (mut world, player) = stacks(tick_rate);
        assert_eq!(held(&world), 7, "at {tick_rate} ticks/s");
        for tick in 0..20i64 {
            let velocity = Vec2::new(Velocity::from_bits(tick << 46), Velocity::ZERO);
            world.set_velocity(player, velocity).expect("accepted");
            world.step();
            assert_eq!((held(&world), rows(&world)), (7, 0), "at {tick_rate} ticks/s, tick {tick}");
        }
    }
}

#[test]
fn a_command_has_its_island_computed_and_no_other() {
    let (mut world, _) = stacks(60);
    let lowest = world.bodies().nth(1).expect("one").id();
    let force = Vec2::new(Force::from_bits(1 << 32), Force::ZERO);
    world.apply(Command::SetForce { body: lowest, force }).expect("accepted");
    world.step();
    assert_eq!(held(&world), 7, "a newton does not move it, so it is known again");
    let velocity = Vec2::new(Velocity::from_bits(1 << 48), Velocity::ZERO);
    world.set_velocity(lowest, velocity).expect("accepted");
    world.step();
    assert_eq!(held(&world), 3);
}

#[test]
fn copies_watchers_and_attractors_have_all_of_it_computed() {
    let (mut world, _) = stacks(60);
    assert_eq!(held(&world.clone()), 0);
    let mut frame = crate::Frame::default();
    world.save_frame(&mut frame);
    world.restore_frame(&frame).expect("its own");
    assert_eq!(held(&world), 0);
    world.step();
    assert_eq!(held(&world), 7);
    // What is found of it when rows are done is for the next tick.
    let computing = crate::Stage::Find..=crate::Stage::Integrate;
    world.step_watched(|stage, world| assert!(!computing.contains(&stage) || held(world) == 0, "{stage:?}"));
    let far = Vec2::new(Length::from_bits(1 << 44), Length::ZERO);
    world.create_attractor(Attractor { position: far, mu: Mu::from_bits(1) }).expect("accepted");
    world.step();
    assert_eq!(held(&world), 0, "what pulls may move");
}

/// Two boxes side by side, `gap` beside a fixed one, without gravity. The second is pressed to the first.
fn weightless(gap: i64, press: bool) -> (World, [BodyId; 2]) {
    let mut world = World::new(&WorldDef { tick_rate: 64, substeps: 8, ..WorldDef::default() }).expect("accepted");
    block(&mut world, BodyKind::Static, [1, -2], 1000);
    let both = [0, 2].map(|x| {
        let body = block(&mut world, BodyKind::Dynamic, [x, 0], 1);
        let position = Vec2::new(Length::from_bits(x << 31), Length::from_bits(gap));
        world.set_position(body, position).expect("accepted");
        body
    });
    for collider in world.colliders().map(|collider| collider.id()).collect::<Vec<_>>() {
        world.set_surface(collider, Restitution::ZERO, Friction::ZERO).expect("accepted");
    }
    for (at, body) in both.into_iter().enumerate() {
        let force = if press { (1 - 2 * at as i128) << 56 } else { 0 };
        push(&mut world, body, [force, 0]);
    }
    for _ in 0..100 {
        world.step();
    }
    (world, both)
}

fn push(world: &mut World, body: BodyId, force: [i128; 2]) {
    let mass = world.body(body).expect("one").mass().to_bits();
    let [x, y] = force.map(|a| Force::from_bits(crate::num::mul_div(a, mass, 1 << 64)));
    world.set_force(body, Vec2::new(x, y)).expect("accepted");
}

/// What is left to the bit as it was needs nothing to hold it.
#[test]
fn what_lies_without_weight_is_left_out() {
    for gap in [0, 1 << 22] {
        let (mut world, _) = weightless(gap, false);
        world.step();
        assert_eq!((held(&world), rows(&world)), (2, 0), "{gap}");
    }
}

/// It has no velocity when the tick ends, but it has gone somewhere, and nothing holds it.
#[test]
fn what_a_force_stops_beside_what_stands_has_gone_its_way() {
    let (world, both) = weightless(1 << 22, true);
    let y = |world: &World| both.map(|body| world.body(body).expect("one").position().y.to_bits());
    // 2⁻¹⁶ m/s, and a deceleration by as much in a tick; what the contact adds, which is not quite level, is taken from the former.
    let mut speeds = [1 << 32; 2];
    for _ in 0..4 {
        let mut world = world.clone();
        for (at, body) in both.into_iter().enumerate() {
            let velocity = Vec2::new(Velocity::ZERO, Velocity::from_bits(speeds[at]));
            world.set_velocity(body, velocity).expect("accepted");
            push(&mut world, body, [(1 - 2 * at as i128) << 56, -1 << 54]);
        }
        let before = y(&world);
        world.step();
        for (now, before) in y(&world).into_iter().zip(before) {
            assert!((now - before - (1 << 9)).abs() < 1 << 7, "{}", now - before);
        }
        let ends = both.map(|body| world.body(body).expect("one").velocity());
        if ends == [Vec2::default(); 2] {
            return;
        }
        speeds = [0, 1].map(|at: usize| speeds[at] - ends[at].y.to_bits());
    }
    panic!("it ends at rest by none of these velocities");
}
