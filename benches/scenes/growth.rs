//! The same three scenes of any number of bodies: how time grows is measured on them.

use super::{Dice, MILLI, ONE, Scene, Thing};

/// The least whole number whose square is not below this one.
fn side(count: i64) -> i64 {
    (1..).find(|side| side * side >= count).expect("some square is large enough")
}

/// Boxes of 1 m that turn and fly under gravity, 3 m apart, and meet nothing.
pub fn flight(count: i64) -> Scene {
    let columns = side(count);
    let thing = |k: i64| {
        let (column, row) = (k % columns, k / columns);
        // Each column rises alike and each row goes sideways alike, so neighbours do not close in.
        Thing::block([3 * column * ONE, 3 * row * ONE], ONE, ONE)
            .moving([row * MILLI, column * MILLI])
            .spinning(750 * MILLI)
    };
    Scene::new((0..count).map(thing).collect())
}

/// Boxes of 60 cm to 1 m, ten rows of them whatever the count, dropped from a few centimetres to a few metres into a bin that
/// is as wide as they take.
pub fn pile(count: i64) -> Scene {
    const ROWS: i64 = 10;
    let columns = (count + ROWS - 1) / ROWS;
    let mut dice = Dice::new(11);
    let half = columns * 550 * MILLI;
    let mut things = vec![
        Thing::wall([0, -ONE], 2 * half + 4 * ONE, 2 * ONE),
        Thing::wall([-half - ONE, 10 * ONE], 2 * ONE, 24 * ONE),
        Thing::wall([half + ONE, 10 * ONE], 2 * ONE, 24 * ONE),
    ];
    for k in 0..count {
        let x = (2 * (k % columns) + 1) * 550 * MILLI - half + dice.between(-20, 20) * MILLI;
        let at = [x, 510 * MILLI + (k / columns) * 1010 * MILLI];
        things.push(Thing::block(at, dice.between(600, 1000) * MILLI, dice.between(600, 1000) * MILLI));
    }
    Scene::new(things)
}

/// The pyramid of boxes of 1 m whose count is the nearest to this one.
pub fn pyramid(count: i64) -> Scene {
    let above = (1..).find(|rows| rows * (rows + 1) / 2 >= count).expect("some pyramid is large enough");
    let boxes = |rows: i64| rows * (rows + 1) / 2;
    let rows = if count - boxes(above - 1) < boxes(above) - count { above - 1 } else { above };
    super::hard::pyramid(rows)
}
