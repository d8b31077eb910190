//! What is kept from tick to tick has no say.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use crate::{
    AngularVelocity, BodyDef, BodyKind, ColliderDef, Commands, Friction, Length, Restitution, Shape, Vec2, World,
    WorldDef,
};

fn body(kind: BodyKind, at: [f64; 2], shape: Shape) -> BodyDef {
    let position = Vec2::from_f64(at[0], at[1]).expect("in range");
    BodyDef { kind, position, colliders: vec![ColliderDef::new(shape)], ..BodyDef::default() }
}

fn length(metres: f64) -> Length {
    Length::from_f64(metres).expect("in range")
}

fn block(width: f64, height: f64) -> Shape {
    Shape::Box { width: length(width), height: length(height) }
}

fn triangle() -> Shape {
    let corners = [[-0.4, -0.3], [0.5, -0.3], [0.1, 0.5]];
    Shape::Polygon { vertices: corners.map(|[x, y]| Vec2::from_f64(x, y).expect("in range")).to_vec() }
}

/// Boxes, discs and triangles that fall into a trough, with a sensor in it and a slow paddle.
fn trough() -> World {
    let gravity = Vec2::from_f64(0.0, -10.0).expect("in range");
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).expect("a world");
    let mut add = |def: BodyDef| world.create_body(&def).expect("a body");
    add(body(BodyKind::Static, [0.0, -0.5], block(12.0, 1.0)));
    add(body(BodyKind::Static, [-5.5, 5.0], block(1.0, 10.0)));
    add(body(BodyKind::Static, [5.5, 5.0], block(1.0, 10.0)));
    let mut paddle = body(BodyKind::Kinematic, [3.0, 1.0], block(2.5, 0.2));
    paddle.angular_velocity = AngularVelocity::from_f64(0.4).expect("in range");
    add(paddle);
    let mut sensor = body(BodyKind::Static, [-2.0, 1.0], block(2.0, 1.0));
    sensor.colliders[0].sensor = true;
    add(sensor);
    for at in 0..60 {
        let place = [f64::from(at % 10) * 0.95 - 4.3, 1.0 + f64::from(at / 10) * 1.1];
        let shape = match at % 3 {
            0 => block(0.8, 0.6),
            1 => Shape::Circle { radius: length(0.4) },
            _ => triangle(),
        };
        add(body(BodyKind::Dynamic, place, shape));
    }
    world
}

/// A copy has seen nothing: it looks at all pairs afresh.
#[test]
fn a_world_that_has_seen_pairs_goes_on_as_one_that_has_not() {
    let mut world = trough();
    let mut kept = 0;
    for tick in 0..700 {
        let mut fresh = world.clone();
        if tick == 300 {
            let collider = world.colliders().nth(20).expect("there are more").id();
            let (bounce, grip) =
                (Restitution::from_f64(0.3).expect("in range"), Friction::from_f64(0.1).expect("in range"));
            for world in [&mut world, &mut fresh] {
                world.set_surface(collider, bounce, grip).expect("it is there");
            }
        }
        if tick == 200 {
            let paddle = world.bodies().nth(3).expect("the fourth").id();
            for world in [&mut world, &mut fresh] {
                world.set_angular_velocity(paddle, AngularVelocity::ZERO).expect("it is there");
            }
        }
        fresh.step();
        world.step();
        assert_eq!(fresh.hash(), world.hash(), "in tick {tick}");
        assert_eq!(world.check(), Ok(()), "in tick {tick}");
        assert_eq!(fresh.touch.known(), 0);
        kept = kept.max(world.touch.known());
    }
    assert!(kept > 20, "{kept} pairs were known from an earlier tick");
}

/// A slot's next collider, and a body put elsewhere and back: what was seen there before is not taken for it.
#[test]
fn what_was_seen_is_not_taken_for_another_collider() {
    let gravity = Vec2::from_f64(0.0, -10.0).expect("in range");
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).expect("a world");
    world.create_body(&body(BodyKind::Static, [0.0, -0.5], block(12.0, 1.0))).expect("a body");
    world.create_body(&body(BodyKind::Dynamic, [0.0, 0.5], block(1.0, 1.0))).expect("a body");
    for tick in 0..200 {
        let mut fresh = world.clone();
        for world in [&mut world, &mut fresh] {
            if tick % 50 == 40 {
                let last = world.bodies().nth(1).expect("there are two").id();
                world.destroy_body(last).expect("it is there");
                let shape = if tick % 100 == 40 { triangle() } else { block(1.0, 1.0) };
                world.create_body(&body(BodyKind::Dynamic, [0.0, 0.5], shape)).expect("a body");
            }
            world.step();
        }
        assert_eq!(fresh.hash(), world.hash(), "in tick {tick}");
        assert_eq!(world.check(), Ok(()), "in tick {tick}");
    }
}
