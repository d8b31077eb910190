//! What rows throw to where nobody looked for neighbours is lost to nobody.

use crate::{BodyDef, BodyId, BodyKind, ColliderDef, Commands, Length, Shape, Vec2, World, WorldDef};

fn mm(length: i64) -> Length {
    Length::from_bits((length << 32) / 1000)
}

/// A box that does not turn, in millimetres.
fn plate(world: &mut World, [x, y]: [i64; 2], [width, height]: [i64; 2], speed: &str, mass: &str) -> BodyId {
    let shape = Shape::Box { width: mm(width), height: mm(height) };
    let def = BodyDef {
        kind: BodyKind::Dynamic,
        position: Vec2::new(mm(x), mm(y)),
        velocity: Vec2::new(speed.parse().unwrap(), "0".parse().unwrap()),
        mass: Some(mass.parse().unwrap()),
        fixed_rotation: true,
        colliders: vec![ColliderDef::new(shape)],
        ..BodyDef::default()
    };
    world.create_body(&def).unwrap()
}

/// Two plates of 4 mm at rest, 2.2 cm from face to face and a part of them face to face: neither is looked for around the other.
/// Behind the rest of each lies something heavy that pushes it by a row, too slow for an impact, more than 1.1 cm in the first tick.
/// They meet in the middle all the same, and neither comes to the other's side.
#[test]
fn what_rows_push_into_each_other_unseen_meets() {
    // Slower than twice what counts as aside, 0.6 m/s at 60 ticks a second.
    for [left, right] in [["0.98", "-0.98"], ["0.9", "-0.9"]] {
        let mut world = World::new(&WorldDef::default()).unwrap();
        let plates = [(-1, left), (1, right)].map(|(side, speed)| {
            let pushed = plate(&mut world, [13 * side, 100 * side], [4, 400], "0", "0.01");
            plate(&mut world, [115 * side, 250 * side], [200, 100], speed, "1");
            pushed
        });
        for tick in 1..=20 {
            world.step();
            let apart = plates.map(|id| world.body(id).unwrap().position().x.to_bits());
            let apart = apart[1] - apart[0];
            assert!(apart > 0, "{left} m/s, tick {tick}: {apart}");
            // They were pushed at once.
            assert!(tick > 1 || apart < mm(5).to_bits(), "{left} m/s: {apart}");
        }
    }
}
