//! Rows written side by side against the definition, to the bit.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use super::super::tests::Dice;
use super::*;
use crate::body::{BodyData, BodyKind};
use crate::contact::NEW;
use crate::narrow::Point;
use crate::num::{Angle, Inertia, Length, Mass, flat, sin_cos};
use crate::solver::kernel::Kernel;
use crate::solver::rows::LANES;

/// A contact to be written.
#[derive(Clone)]
struct Given {
    pair: Pair,
    places: [u32; 2],
    between: [i64; 2],
    mobility: [Mobility; 2],
    old: Contact,
}

/// Of any mass and size, or much like what games have; static and kinematic ones, and such that do not turn.
fn mobility(dice: &mut Dice, wild: bool) -> Mobility {
    let kind = match dice.bits() >> 61 {
        0 => BodyKind::Static,
        1 => BodyKind::Kinematic,
        _ => BodyKind::Dynamic,
    };
    let reach = if wild { dice.within(1, 1 << 47) } else { (1 << 31) + dice.within(0, 1 << 31) };
    let mass = if wild { i128::from(dice.within(1 << 44, i64::MAX)) << 20 } else { 1 << 64 };
    // (1/4 … 1 of the reach)², or anything.
    let square =
        (i128::from(reach) * i128::from(reach) / 4) >> if wild { dice.bits() >> 59 } else { dice.bits() >> 63 };
    let inertia = crate::num::mul_div(square, mass, 1 << 64).max(1 << 25);
    Mobility::new(&BodyData {
        kind,
        fixed_rotation: dice.one_in(8),
        mass: Mass::from_bits(mass),
        inertia: Inertia::from_bits(inertia),
        reach: Length::from_bits(reach),
        ..BodyData::default()
    })
}

fn given(dice: &mut Dice) -> Given {
    let wild = dice.one_in(4);
    let mobility = [mobility(dice, wild), mobility(dice, wild)];
    let far = if wild { 1 << 50 } else { mobility[0].reach.max(1 << 20) };
    let count = if dice.one_in(3) { 1 } else { 2 };
    let gap = if wild { 1 << 52 } else { 1 << 27 };
    let mut points = [(); 2].map(|()| Point {
        arm: [dice.within(-far, far), dice.within(-far, far)],
        separation: dice.within(-gap, gap),
        id: dice.bits() as u8 & 3,
    });
    if count == 1 {
        points[1] = Point::default();
    }
    let (sin, cos) = sin_cos(Angle::from_bits(dice.bits() as i64 >> 16));
    let normal = if dice.one_in(4) { [0, -(1 << 30)] } else { [cos, sin] };
    let most = if wild { 1 << 60 } else { 1 << 48 };
    let pair = Pair {
        colliders: [0, 1],
        bodies: [0, 1],
        sensor: false,
        manifold: Manifold { normal, count, points },
        old: NEW,
        row: 0,
        depth: 0,
        met: false,
        known: false,
        stays: false,
        restitution: 0,
        friction: dice.within(0, if wild { 100 << 48 } else { 2 << 48 }),
    };
    let old = Contact {
        count: dice.bits() as u8 % 3,
        ids: [dice.bits() as u8 & 3, dice.bits() as u8 & 3],
        normal: [dice.within(0, most), dice.within(0, most)],
        tangent: dice.within(-most, most),
        ..Contact::default()
    };
    let places = [0, 1].map(|body: usize| if mobility[body].fixed { 0 } else { 1 + body as u32 });
    Given { pair, places, between: [dice.within(-far, far), dice.within(-far, far)], mobility, old }
}

/// Which of the paths that matter were gone, how often.
#[derive(Debug, Default)]
struct Seen {
    side_by_side: u32,
    left: u32,
    one_point: u32,
    second_lower: u32,
    immovable: u32,
    most_arm: u32,
    most_limit: u32,
    most_impulse: u32,
}

#[test]
fn rows_side_by_side_are_the_definition() {
    for kernel in Kernel::all() {
        let (mut dice, mut seen) = (Dice(11), Seen::default());
        for round in 0..40_000 {
            let scales = Scales::new(60, 10, [0, 3, 10][round % 3]);
            let all: [Given; LANES] = [(); LANES].map(|()| given(&mut dice));
            let (mut joints, mut block, mut definition) = (Joints::default(), Block::default(), Block::default());
            for (i, Given { pair, places, between, mobility: [a, b], old }) in all.iter().enumerate() {
                joints.seat(i, pair, *places, *between, [a, b], old);
                Joint::new(pair, *places, [*between; 2], [a, b]).write(&mut definition, i, old, pair.friction, &scales);
            }
            let left = kernel.prepare(&joints, &mut block, scales.shift);
            for (i, Given { pair, places, between, mobility: [a, b], old }) in all.iter().enumerate() {
                if left >> i & 1 != 0 {
                    let joint = Joint::new(pair, *places, [*between; 2], [a, b]);
                    joint.write(&mut block, i, old, pair.friction, &scales);
                    seen.left += 1;
                    continue;
                }
                (block.bodies[0][i], block.bodies[1][i]) = (places[0], places[1]);
                let [first, second] = &pair.manifold.points;
                seen.side_by_side += 1;
                seen.one_point += u32::from(pair.manifold.count == 1);
                seen.second_lower += u32::from(pair.manifold.count == 2 && second.separation < first.separation);
                seen.immovable += u32::from(!a.moves() || !b.moves());
                seen.most_arm += u32::from(definition.points[0].arm[0][i].abs() == i32::MAX);
                seen.most_limit += u32::from(definition.limit[0][i] == i32::MAX);
                seen.most_impulse += u32::from(definition.friction.impulse[i].abs() == 1 << 29);
            }
            assert_eq!(block, definition, "{kernel:?}, {left:b}");
        }
        let Seen { side_by_side, left, one_point, second_lower, immovable, most_arm, most_limit, most_impulse } = seen;
        let paths = [side_by_side, left, one_point, second_lower, immovable, most_arm, most_limit, most_impulse];
        assert!(paths.iter().all(|&often| often > 100), "{kernel:?} {seen:?}");
    }
}

#[test]
fn the_inverse_is_the_quotient() {
    let same = |v: i64| assert_eq!(flat::inverse(v), ((1 << 56) + v / 2) / v, "of {v}");
    let ends = [1i64 << 28, 1 << 29, 1 << 30, (1 << 31) - 1];
    for at in 0..1000 {
        ends.iter().flat_map(|end| [end - at, end + at]).filter(|&v| v >> 28 != 0 && v >> 31 == 0).for_each(same);
    }
    (0..200_000).map(|step| (1 << 28) + step * 8_963).filter(|v| v >> 31 == 0).for_each(same);
    // Quotients near a half: where a unit in the last place decides.
    for quotient in (1i64 << 25..1 << 28).step_by(9_973) {
        let v = (1 << 57) / (2 * quotient + 1);
        (v - 1..=v + 1).filter(|&v| v >> 28 != 0 && v >> 31 == 0).for_each(same);
    }
}

/// One number alone that lanes do not hold, or any of those of its kind together, and the contact is left over; and else not.
#[test]
fn what_lanes_have_no_numbers_for_is_left_over() {
    let (mut dice, scales) = (Dice(5), Scales::new(60, 10, 0));
    let left = |kernel: Kernel, all: &[Given; LANES]| {
        let (mut joints, mut block) = (Joints::default(), Block::default());
        for (i, Given { pair, places, between, mobility: [a, b], old }) in all.iter().enumerate() {
            let ids = [0, 1].map(|at: usize| pair.manifold.points[at].id);
            let old = Contact { count: 2, ids, ..*old };
            joints.seat(i, pair, *places, *between, [a, b], &old);
        }
        kernel.prepare(&joints, &mut block, scales.shift)
    };
    // They do not turn, or arms as long as these are would be too much for what turns them.
    let mut plain = || loop {
        let given = given(&mut dice);
        let alike = [(); LANES].map(|()| given.clone());
        let turns = given.mobility.iter().any(|mobility| mobility.tau != 0);
        if given.pair.manifold.count == 2 && !turns && left(Kernel::Definition, &alike) == 0 {
            return given;
        }
    };
    let all = [(); LANES].map(|()| plain());
    type Change = fn(&mut Given, usize, i64);
    // Each with how many there are, and the first power of two beyond.
    let kinds: [(Change, usize, u32); 5] = [
        (|given, at, by| given.pair.manifold.points[at / 2].arm[at % 2] = by, 4, 60),
        (|given, at, by| given.between[at] = by, 2, 60),
        (|given, at, by| given.pair.manifold.points[at].separation = by, 2, 47),
        (|given, at, by| *given.old.normal.get_mut(at).unwrap_or(&mut given.old.tangent) = by, 3, 58),
        (|given, _, by| given.pair.friction = by, 1, 55),
    ];
    for kernel in Kernel::all() {
        assert_eq!(left(kernel, &all), 0, "{kernel:?}");
        for (kind, (change, count, bits)) in kinds.into_iter().enumerate() {
            for some in 1..1u32 << count {
                let mut all = all.clone();
                (0..count).filter(|at| some >> at & 1 != 0).for_each(|at| change(&mut all[3], at, 1 << bits));
                assert_eq!(left(kernel, &all), 1 << 3, "{kernel:?}, {kind}, {some:b}");
            }
        }
    }
}
