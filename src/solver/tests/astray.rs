//! What rows throw to where nobody looked for neighbours is lost to nobody.

use crate::{BodyDef, BodyId, BodyKind, ColliderDef, Commands, Length, Shape, Vec2, World, WorldDef};

fn at(x: f64, y: f64) -> Vec2<Length> {
    Vec2::from_f64(x, y).unwrap()
}

/// A box that does not turn, which moves along x.
fn plate(world: &mut World, place: Vec2<Length>, [width, height]: [f64; 2], speed: f64, mass: &str) -> BodyId {
    let side = |side: f64| Length::from_f64(side).unwrap();
    let shape = Shape::Box { width: side(width), height: side(height) };
    let def = BodyDef {
        kind: BodyKind::Dynamic,
        position: place,
        velocity: Vec2::from_f64(speed, 0.0).unwrap(),
        mass: Some(mass.parse().unwrap()),
        fixed_rotation: true,
        colliders: vec![ColliderDef::new(shape)],
        ..BodyDef::default()
    };
    world.create_body(&def).unwrap()
}

/// Two plates of 4 mm at rest, 2.4 cm from face to face: neither is looked for around the other. Behind each lies something
/// heavy that pushes it by a row, too slow for an impact, 1.6 cm in the first tick: both together farther than to where they would
/// have changed sides. They meet in the middle all the same.
#[test]
fn what_rows_push_into_each_other_unseen_meets() {
    // Slower than twice what counts as aside, 0.6 m/s at 60 ticks a second.
    for speed in [0.95, 0.9] {
        let mut world = World::new(&WorldDef::default()).unwrap();
        let plates = [-1.0, 1.0].map(|side| {
            let plate_id = plate(&mut world, at(0.014 * side, 0.0), [0.004, 0.4], 0.0, "0.01");
            let behind = at((0.016 + 0.1) * side, 0.15 * side);
            plate(&mut world, behind, [0.2, 0.1], -speed * side, "100");
            plate_id
        });
        for tick in 1..=20 {
            world.step();
            let [left, right] = plates.map(|id| world.body(id).unwrap().position().x.to_bits());
            assert!(left < right, "{speed} m/s, tick {tick}: {left} {right}");
            // They were pushed at once.
            assert!(tick > 1 || right - left < (1 << 32) / 200, "{speed} m/s: {left} {right}");
        }
    }
}
