//! Scenes whose outcome is known: by a closed form, or by an equation that is easily solved.

use super::{Dice, Form, Kind, MILLI, Micro, ONE, Pair, Scene, Thing, floor, polygon, room};

/// 10 m/s to the right and up.
pub fn throw() -> Scene {
    Scene::new(vec![Thing::block([0, 0], ONE, ONE).moving([10 * ONE, 10 * ONE])])
}

/// 20 m/s to the right and 10 up, through something that takes half of the speed a second.
pub fn damped_throw() -> Scene {
    let thing = Thing::block([0, 0], ONE, ONE).moving([20 * ONE, 10 * ONE]);
    Scene::new(vec![Thing { damping: [500 * MILLI, 0], ..thing }])
}

/// From the nearest point of an ellipse about the origin: a = 10 m, e = 0.6, μ = 1000 m³/s², so v = 20 m/s there and the
/// period is 2π s.
pub fn orbit() -> Scene {
    let moon = Thing::block([4 * ONE, 0], ONE, ONE).moving([0, 20 * ONE]);
    Scene { attractors: vec![([0, 0], 1000 * ONE)], ..Scene::floating(vec![moon]) }
}

/// 10 rad/s.
pub fn spin() -> Scene {
    Scene::floating(vec![Thing::block([0, 0], ONE, ONE).spinning(10 * ONE)])
}

/// 1 m/s from here on.
pub fn drift(from: Micro) -> Scene {
    Scene::floating(vec![Thing::block([0, 0], ONE, ONE).moving([ONE, 0])]).moved(from)
}

/// A box that slides at 3 m/s.
pub fn sliding_stop(from: Micro) -> Scene {
    Scene::new(vec![floor(), Thing::block([0, 500 * MILLI], ONE, ONE).moving([3 * ONE, 0])]).moved(from)
}

/// Something of 1 m on a slope that rises 3 in 4 through the origin.
fn slope(form: Form, friction: Micro) -> Scene {
    let ground = Thing::wall([600 * MILLI, -800 * MILLI], 80 * ONE, 2 * ONE).facing([4, 3]);
    let thing = Thing::new(Kind::Dynamic, [-300 * MILLI, 400 * MILLI], form).facing([4, 3]);
    Scene::new(vec![ground, thing]).friction(friction)
}

/// A box that slides down.
pub fn incline() -> Scene {
    slope(Form::Box(ONE, ONE), 300 * MILLI)
}

/// A box that friction holds: 0.9 above 3/4.
pub fn incline_rest() -> Scene {
    slope(Form::Box(ONE, ONE), 900 * MILLI)
}

/// A disc that rolls down.
pub fn incline_roll() -> Scene {
    slope(Form::Disc(500 * MILLI), 900 * MILLI)
}

/// A disc that slides at 3 m/s until it rolls.
pub fn slide_to_roll() -> Scene {
    Scene::new(vec![floor(), Thing::disc([0, 500 * MILLI], 500 * MILLI).moving([3 * ONE, 0])])
}

/// Something of 50 cm, dropped from 1 m.
pub fn bounce(round: bool, restitution: Micro) -> Scene {
    let form = if round { Form::Disc(250 * MILLI) } else { Form::Box(500 * MILLI, 500 * MILLI) };
    Scene::new(vec![floor(), Thing::new(Kind::Dynamic, [0, 1250 * MILLI], form)]).restitution(restitution)
}

/// Boxes of 1 and 3 kg that meet at 1 m/s each, elastic.
pub fn head_on() -> Scene {
    Scene::floating(vec![
        Thing::block([-1500 * MILLI, 0], ONE, ONE).moving([ONE, 0]),
        Thing::block([1500 * MILLI, 0], ONE, ONE).moving([-ONE, 0]).dense(3 * ONE),
    ])
    .restitution(ONE)
}

/// Two boxes of the typical values of the requirements' Table 4: 56.2 kg, 74.5 kg m², 2.51 m/s, C_R 0.8.
pub fn typical() -> Scene {
    let typical = |x, v| {
        let block = Thing::block([x, 0], ONE, ONE).moving([v, 0]);
        Thing { inertia: Some((56_200 * MILLI, 74_500 * MILLI)), ..block }
    };
    Scene::floating(vec![typical(-1500 * MILLI, 2510 * MILLI), typical(500 * MILLI, 0)]).restitution(800 * MILLI)
}

/// A disc at 3 m/s towards two at rest that are 5 mm apart, elastic.
pub fn one_hits_two() -> Scene {
    let disc = |x, v| Thing::disc([x, 0], 500 * MILLI).moving([v, 0]);
    Scene::floating(vec![disc(-3 * ONE, 3 * ONE), disc(0, 0), disc(1005 * MILLI, 0)]).restitution(ONE)
}

/// A square that stands on a corner, at 3 m/s down to a bar of 4 m, which it meets 1 m from the middle; C_R 0.5.
pub fn corner_on_bar() -> Scene {
    // Half the diagonal of 1.4 m by 1.4 m rounded is what the closed form takes as well.
    let square = Thing::block([ONE, 2 * ONE], 1400 * MILLI, 1400 * MILLI).facing([1, 1]).moving([0, -3 * ONE]);
    Scene::floating(vec![Thing::block([0, 0], 4 * ONE, ONE), square]).restitution(500 * MILLI)
}

/// A square that turns at 4 rad/s while it moves down at 2 m/s, to a floor it meets with a corner.
pub fn turning_corner() -> Scene {
    let square = Thing::block([0, 2 * ONE], ONE, ONE).moving([0, -2 * ONE]).spinning(4 * ONE);
    Scene::floating(vec![floor(), square]).restitution(500 * MILLI)
}

/// Boxes of 1 m on each other, all of 1 kg but the last.
pub fn stack(rows: Micro, top: Micro) -> Scene {
    let mut things = vec![floor()];
    for row in 0..rows {
        let density = if row + 1 == rows { top } else { ONE };
        things.push(Thing::block([0, 500 * MILLI + row * ONE], ONE, ONE).dense(density));
    }
    Scene::new(things)
}

/// A box of 1 m by 2 m that turns about its right lower corner, at the origin, at 1.5 rad/s.
pub fn topple() -> Scene {
    let spin = -1500 * MILLI;
    let block = Thing::block([-500 * MILLI, ONE], ONE, 2 * ONE).spinning(spin).moving([-spin, -spin / 2]);
    Scene::new(vec![floor(), block]).friction(2 * ONE)
}

/// A plank of 6 m on a fixed triangle, a box that falls 1 m on its one end, and one that rests on the other.
pub fn seesaw() -> Scene {
    let triangle = Form::Polygon(vec![[-ONE, -ONE], [ONE, -ONE], [0, 500 * MILLI]]);
    let plank = [0, 600 * MILLI];
    Scene::new(vec![
        Thing::new(Kind::Static, [0, 0], triangle),
        Thing::block(plank, 6 * ONE, 200 * MILLI),
        Thing::block([2500 * MILLI, 1200 * MILLI], ONE, ONE),
        Thing::block([-2500 * MILLI, 2200 * MILLI], ONE, ONE).dense(3 * ONE),
    ])
}

/// Polygons in a room, elastic, in free flight between collisions.
pub fn gas(count: Micro) -> Scene {
    let mut things = room([10 * ONE, 10 * ONE]);
    let mut dice = Dice::new(7);
    for k in 0..count {
        let at: Pair = [(k % 10) * 2 * ONE - 9 * ONE, (k / 10) * 2 * ONE - 9 * ONE];
        let velocity = [dice.between(-10 * ONE, 10 * ONE), dice.between(-10 * ONE, 10 * ONE)];
        let thing = Thing::new(Kind::Dynamic, at, polygon(dice.between(0, 3), 500 * MILLI));
        things.push(thing.moving(velocity).spinning(dice.between(-3 * ONE, 3 * ONE)));
    }
    Scene::floating(things).restitution(ONE)
}
