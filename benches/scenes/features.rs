//! A thousand boxes, at rest and falling: what features cost is measured on them.

use super::{Dice, MILLI, ONE, Scene, Thing};

/// Stacks of 10 boxes of 1 m, 20 cm apart.
pub fn stacks() -> Scene {
    let mut things = vec![Thing::wall([0, -ONE], 200 * ONE, 2 * ONE)];
    for k in 0..1000 {
        let at = [(k / 10 - 50) * 1200 * MILLI, 500 * MILLI + (k % 10) * ONE];
        things.push(Thing::block(at, ONE, ONE));
    }
    Scene::new(things)
}

/// Boxes of 60 cm to 1 m in a bin of 30 m, dropped from where they are.
pub fn pile() -> Scene {
    let mut dice = Dice::new(11);
    let mut things = vec![
        Thing::wall([0, -ONE], 34 * ONE, 2 * ONE),
        Thing::wall([-16 * ONE, 40 * ONE], 2 * ONE, 84 * ONE),
        Thing::wall([16 * ONE, 40 * ONE], 2 * ONE, 84 * ONE),
    ];
    for k in 0..1000 {
        let at =
            [(k % 25) * 1180 * MILLI - 14_160 * MILLI + dice.between(-20, 20) * MILLI, ONE + (k / 25) * 1200 * MILLI];
        things.push(Thing::block(at, dice.between(600, 1000) * MILLI, dice.between(600, 1000) * MILLI));
    }
    Scene::new(things)
}
