//! The kernels of the rows, and those of their preparation, against plain arithmetic of 128 bits: at ties, and at the ends of
//! what they take.
#![allow(clippy::arithmetic_side_effects, clippy::disallowed_types, reason = "tests, not the engine")]

use super::{Length, flat, lane, mul};
use crate::geom::{Rot, Vec2};

/// `value / 2^shift` to nearest, ties away from zero.
fn nearest(value: i128, shift: u32) -> i128 {
    let magnitude = (value.abs() + (1 << shift >> 1)) >> shift;
    if value < 0 { -magnitude } else { magnitude }
}

/// `most`, zero, powers of two and halves between, all with their neighbours, and some of any size; of both signs.
fn samples(most: i64) -> Vec<i64> {
    let powers = (0..63).map(|shift| 1i64 << shift).chain((1..62).map(|shift| 3 << shift));
    let mut seed = 1u64;
    let random = (0..400).map(|at| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> (1 + at % 62)) as i64
    });
    let near = |value: i64| [value - 1, value, value + 1];
    let all = powers.chain([0]).flat_map(near).chain(random).chain([most, most - 1]);
    let mut values: Vec<i64> = all.filter(|value| (0..=most).contains(value)).flat_map(|v| [v, -v]).collect();
    values.sort_unstable();
    values.dedup();
    values
}

/// Numbers of 32 bits.
fn factors() -> Vec<i64> {
    samples(i32::MAX.into()).into_iter().step_by(3).chain([i32::MAX.into(), i32::MIN.into(), 1, -1, 3, -3]).collect()
}

#[test]
fn shifts_are_to_nearest_and_odd() {
    for v in samples((1 << 62) - 1) {
        let wide = i128::from(v);
        assert_eq!(i128::from(lane::round::<1>(v)), nearest(wide, 1), "{v}");
        assert_eq!(i128::from(lane::round::<28>(v)), nearest(wide, 28), "{v}");
        assert_eq!(i128::from(flat::round::<28>(v)), nearest(wide, 28), "{v}");
        for shift in [1, 2, 20, 28, 61] {
            assert_eq!(i128::from(lane::shifted(v, shift)), nearest(wide, shift as u32), "{v} / 2^{shift}");
        }
        assert_eq!(lane::shifted(v, 0), v);
        let small = v >> 20;
        assert_eq!(lane::shifted(small, -7), small * 128);
    }
}

#[test]
fn limits_are_reached_and_not_passed() {
    for v in samples((1 << 62) - 1) {
        let limited = |most: i64| v.clamp(-most, most);
        assert_eq!(i64::from(lane::limit(v)), limited(1 << 30), "{v}");
        assert_eq!(lane::bounded(v), limited(1 << 60), "{v}");
        assert_eq!(flat::within(v, 1 << 30), limited(1 << 30), "{v}");
        assert_eq!(lane::clamp(v, -5, 1 << 40), v.clamp(-5, 1 << 40), "{v}");
        let rounded = nearest(v.into(), 20).clamp(-(1 << 30), 1 << 30);
        assert_eq!(i128::from(lane::round_to::<20>(v)), rounded, "{v}");
        // Each of the three is limited by itself, whatever the others are.
        for other in [0, 1, lane::HELD, -lane::HELD, lane::HELD + 1, -lane::HELD - 1, 1 << 61] {
            let held = limited(lane::HELD);
            let rest = other.clamp(-lane::HELD, lane::HELD);
            assert_eq!(lane::held([v, other, 7]), [held, rest, 7], "{v} {other}");
            assert_eq!(lane::held([other, -7, v]), [rest, -7, held], "{v} {other}");
            assert_eq!(lane::held([0, v, other]), [0, held, rest], "{v} {other}");
        }
    }
}

#[test]
fn products_of_rows_are_exact_or_rounded_once() {
    for a in factors() {
        let coefficient = a as i32;
        for v in samples((1 << 61) - 1).into_iter().step_by(5) {
            let product = i128::from(a) * i128::from(v);
            if nearest(product, 28).abs() < 1 << 62 {
                assert_eq!(i128::from(lane::scale(coefficient, v)), nearest(product, 28), "{a} {v}");
            }
        }
        for b in factors() {
            let product = i128::from(a) * i128::from(b);
            assert_eq!(i128::from(lane::mul(coefficient, b as i32)), product);
            assert_eq!(i128::from(flat::mul(a, b)), product);
            assert_eq!(
                i128::from(lane::coupled(12_345, coefficient >> 1, b as i32)),
                12_345 + 2 * (i128::from(a >> 1) * i128::from(b))
            );
            assert_eq!(i128::from(lane::times(coefficient >> 1, b)), i128::from(a >> 1) * i128::from(b));
            assert_eq!(i128::from(flat::scale(a, b)), nearest(product, 28), "{a} {b}");
        }
    }
}

#[test]
fn loads_beyond_four_thirds_of_what_is_firm_count_a_quarter() {
    let loads = samples(1 << 29).into_iter().filter(|&load| load >= 0);
    for load in loads {
        for firm in [0, 1, 3, 100, 1 << 20, (1 << 29) / 4 * 3, 1 << 29, (1 << 30) - 1] {
            let expected = load.min(firm + load / 4);
            assert_eq!(i64::from(lane::eased(load as i32, firm as i32)), expected, "{load} {firm}");
        }
    }
    for slop in [0, 1, 335_544] {
        for separation in samples(1 << 30) {
            let expected = (separation + slop).min(0);
            assert_eq!(i64::from(lane::deeper(separation as i32, slop as i32)), expected, "{separation} {slop}");
        }
    }
}

#[test]
fn lanes_of_the_preparation_give_the_bits_of_what_they_stand_for() {
    let fitting = |bits: u32| samples((1i64 << bits) - 1).into_iter().step_by(2);
    for factor in factors() {
        for value in fitting(47).filter(|&value| value >= 0) {
            assert_eq!(flat::part(value, factor), mul(value, factor, 30), "{value} {factor}");
        }
        if factor < 0 {
            continue;
        }
        for value in fitting(59) {
            assert_eq!(flat::carry(value, factor), mul(value, factor, 56), "{value} {factor}");
        }
        for value in fitting(55).filter(|&value| value >= 0) {
            assert_eq!(flat::hold(value, factor), mul(value, factor, 48), "{value} {factor}");
        }
    }
    for v in samples(i64::MAX) {
        assert_eq!(flat::beyond(v), i64::from(i32::try_from(v).is_err()), "{v}");
        assert_eq!(flat::sign(v), v.signum().min(0));
        assert_eq!([flat::pick(v > 0, 1, 2), flat::pick(v <= 0, 1, 2)], if v > 0 { [1, 2] } else { [2, 1] });
    }
    let divisors = samples((1 << 31) - 1).into_iter().filter(|&v| v >= 1 << 28);
    for v in divisors {
        assert_eq!(i128::from(flat::inverse(v)), super::div(1 << 56, v.into()), "{v}");
    }
}

#[test]
fn what_is_drawn_has_each_component_by_itself() {
    for (x, y) in [(0.5, -2.0), (-1e9, 2f64.powi(-32)), (0.0, 3.25)] {
        assert_eq!(Vec2::<Length>::from_f64(x, y).expect("in range").to_f64(), (x, y));
    }
    for (cos, sin) in [(0.5, -0.75), (-1.0, 0.0), (0.0, 1.0), (2f64.powi(-30), -(2f64.powi(-30)))] {
        let bits = |part: f64| (part * f64::from(1 << 30)) as i32;
        assert_eq!(Rot { cos: bits(cos), sin: bits(sin) }.to_f64(), (cos, sin));
    }
}
