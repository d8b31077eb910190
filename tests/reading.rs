//! What was given to a world can be read from it, and what it tells has words.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{acc, at, disc, vel, world};
use tamias2d::{
    Aabb, Angle, BodyDef, BodyKind, ColliderDef, Commands, EventKind, Filter, Length, Rot, Shape, Vec2, World, WorldDef,
};

#[test]
fn bodies_and_colliders_have_what_they_were_given() {
    let mut world = world(0.0, 0.0);
    let filter = Filter { category: 6, mask: 9 };
    let collider = ColliderDef {
        filter,
        sensor: true,
        restitution: "0.25".parse().expect("in range"),
        friction: "0.75".parse().expect("in range"),
        ..disc(0.5)
    };
    let mut def = BodyDef {
        kind: BodyKind::Kinematic,
        position: at(3.0, -4.0),
        angle: "1.5".parse().expect("in range"),
        velocity: vel(1.0, 2.0),
        mass: Some("7".parse().expect("in range")),
        user_data: 99,
        colliders: vec![collider.clone(), disc(1.0)],
        ..BodyDef::default()
    };
    let first = world.create_body(&BodyDef::default()).expect("accepted");
    let second = world.create_body(&def).expect("accepted");
    assert_eq!(world.body_count(), 2);
    assert!(world.status().is_clear());
    let body = world.body(second).expect("it lives");
    assert_eq!((body.kind(), body.user_data(), body.is_awake()), (BodyKind::Kinematic, 99, true));
    assert_eq!((body.position(), body.velocity()), (def.position, def.velocity));
    assert_eq!(Some(body.mass()), def.mass);
    assert_eq!((body.angle(), body.rotation()), (def.angle, Rot::new(def.angle)));
    let [sensor, solid] = body.colliders().collect::<Vec<_>>()[..] else { panic!("it has two") };
    assert_eq!((sensor.filter(), sensor.is_sensor()), (filter, true));
    assert_eq!((sensor.restitution(), sensor.friction()), (collider.restitution, collider.friction));
    assert_eq!((solid.filter(), solid.is_sensor()), (Filter::default(), false));
    // Its definition makes the same body again; inertia and centre were derived.
    let again = body.def();
    (def.inertia, def.center) = (again.inertia, again.center);
    assert_eq!(again, def);
    world.destroy_body(first).expect("accepted");
    assert_eq!((world.body_count(), world.bodies().count(), world.body(first).is_none()), (1, 1, true));
}

/// Two boxes over a floor, one of them put on it and one that falls.
fn landing() -> World {
    let mut world = World::new(&WorldDef { gravity: acc(0.0, -9.8), ..WorldDef::default() }).expect("accepted");
    let side = |side: f64| Length::from_f64(side).expect("in range");
    let solid = |width, height| vec![ColliderDef::new(Shape::Box { width: side(width), height: side(height) })];
    let mut create = |kind, position, velocity, colliders| {
        let def = BodyDef { kind, position, velocity, colliders, ..BodyDef::default() };
        world.create_body(&def).expect("accepted")
    };
    create(BodyKind::Static, at(0.0, -0.5), vel(0.0, 0.0), solid(20.0, 1.0));
    create(BodyKind::Dynamic, at(-3.0, 0.5), vel(0.0, 0.0), solid(1.0, 1.0));
    create(BodyKind::Dynamic, at(3.0, 0.6), vel(0.0, -9.0), solid(1.0, 1.0));
    world
}

#[test]
fn events_and_collisions_have_ids_and_words() {
    let mut world = landing();
    world.step();
    let told: Vec<String> = world.events().iter().map(|event| event.to_string()).collect();
    assert_eq!(
        told,
        ["contact_begin of collider 0v0 and collider 1v0", "contact_begin of collider 0v0 and collider 2v0"]
    );
    let event = &world.events()[0];
    assert_eq!((event.id().kind, event.id().ordinal, event.id().tick), (EventKind::ContactBegin, 0, 0));
    assert_eq!(event.id().to_string(), "contact_begin 0 of collider 0v0 and collider 1v0 in tick 0");
    let ids: Vec<_> = world.collisions().iter().map(|collision| collision.id()).collect();
    assert_eq!(ids[0].to_string(), "collision 0 of collider 0v0 and collider 2v0 in tick 0");
    // No two are called the same.
    let mut different = ids.clone();
    different.dedup();
    assert_eq!(different, ids);
}

#[test]
fn boxes_turns_and_vectors() {
    let aabb = |min: (f64, f64), max: (f64, f64)| Aabb { min: at(min.0, min.1), max: at(max.0, max.1) };
    let (a, b) = (aabb((0.0, -1.0), (2.0, 1.0)), aabb((-3.0, 0.0), (1.0, 4.0)));
    let union = a.union(&b);
    assert_eq!(union, aabb((-3.0, -1.0), (2.0, 4.0)));
    assert_eq!(b.union(&a), union);
    assert!(union.contains(&a) && union.contains(&b) && !a.contains(&b) && a.overlaps(&b));
    // A quarter of a turn, and back.
    let quarter = Rot::new(Angle::from_bits(1 << 46));
    assert_eq!(quarter.rotate(at(1.0, 2.0)), at(-2.0, 1.0));
    assert_eq!(quarter.unrotate(at(-2.0, 1.0)), at(1.0, 2.0));
    assert_eq!(Vec2::to_string(&at(1.5, -0.25)), "(1.5, -0.25)");
    // For drawing.
    assert_eq!((at(1.5, -0.25).to_f64(), quarter.to_f64()), ((1.5, -0.25), (0.0, 1.0)));
    let (cos, sin) = Rot::new(Angle::from_bits((1 << 48) / 12)).to_f64();
    assert!((cos - 0.75f64.sqrt()).abs() < 1e-9 && (sin - 0.5).abs() < 1e-9, "{cos} {sin}");
}
