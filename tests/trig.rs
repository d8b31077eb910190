//! Sine, cosine and the angle of a vector against power series of 160 bits in big integers. No float is used.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod num_oracle;

use fixed::types::I32F32;
use num_bigint::{BigInt, Sign};
use num_oracle::{any_i64, draws, pi, power};
use proptest::prelude::*;
use tamias2d::num::{atan2, sin_cos};
use tamias2d::{Angle, Rot};

/// Fraction bits of the oracle.
const WIDE: u32 = 160;
/// Fraction bits in which errors are compared, in `i128`.
const NARROW: u32 = 100;
/// One turn, a quarter and an eighth of it.
const TURN: i64 = 1 << 48;
const QUARTER: i64 = TURN / 4;
const EIGHTH: i64 = TURN / 8;

/// (cos, sin) of an angle in radians, |angle| ≤ 4, with [`WIDE`] fraction bits in and out: the power series, until
/// its terms vanish. Each of the about 60 terms is floored: the error is below 2⁻¹⁵⁰.
fn series(angle: &BigInt) -> (BigInt, BigInt) {
    let (mut cos, mut sin) = (BigInt::from(0), BigInt::from(0));
    let (mut term, mut k) = (power(WIDE), 0u32);
    while term.magnitude().bits() > 1 {
        match k % 4 {
            0 => cos += &term,
            1 => sin += &term,
            2 => cos -= &term,
            _ => sin -= &term,
        }
        k += 1;
        term = ((term * angle) >> WIDE) / k;
    }
    (cos, sin)
}

/// [`series`] of an angle in units of 2⁻⁴⁸ turns, any number of turns.
struct Oracle {
    tau: BigInt,
}

impl Oracle {
    fn new() -> Self {
        Oracle { tau: pi(WIDE) * 2 }
    }

    /// Radians in [−π, π).
    fn radians(&self, bits: i64) -> BigInt {
        let fraction = (bits + TURN / 2).rem_euclid(TURN) - TURN / 2;
        (&self.tau * fraction) >> 48
    }

    fn sin_cos(&self, bits: i64) -> (BigInt, BigInt) {
        series(&self.radians(bits))
    }
}

/// The oracle's number as an integer of [`NARROW`] fraction bits.
fn narrow(value: &BigInt) -> i128 {
    (value >> (WIDE - NARROW)).try_into().expect("at most 1 in magnitude")
}

/// The error of both parts of `sin_cos`, the greater, with [`NARROW`] fraction bits.
fn error(bits: i64, exact: &(BigInt, BigInt)) -> i128 {
    let (cos, sin) = sin_cos(Angle::from_bits(bits));
    let off = |part: i32, exact: &BigInt| ((i128::from(part) << (NARROW - 30)) - narrow(exact)).abs();
    off(cos, &exact.0).max(off(sin, &exact.1))
}

/// An error with [`NARROW`] fraction bits in units of 10⁻¹², rounded up.
fn in_trillionths(error: i128) -> i128 {
    (((error >> 40) * 1_000_000_000_000) >> (NARROW - 40)) + 1
}

/// |cos² + sin² − 1| with 60 fraction bits.
fn norm_error(bits: i64) -> i128 {
    let (cos, sin) = sin_cos(Angle::from_bits(bits));
    let (cos, sin) = (i128::from(cos), i128::from(sin));
    (cos * cos + sin * sin - (1 << 60)).abs()
}

/// 4.8e-10, the bound that the documentation of `sin_cos` states.
const STATED_TRILLIONTHS: i128 = 480;

/// A fixed sequence of numbers without pattern (splitmix64).
fn scattered(index: u64) -> u64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[test]
fn the_oracle_knows_the_angles_that_everyone_knows() {
    let oracle = Oracle::new();
    let near = |value: &BigInt, exact: BigInt| (value - exact).bits() < 12;
    // π to 60 bits: 3.14159265358979323846…
    assert_eq!(narrow(&pi(WIDE)) / (1 << 40), 3_622_009_729_038_561_421);
    let one = power(WIDE);
    let (cos, sin) = oracle.sin_cos(QUARTER);
    assert!(near(&cos, BigInt::from(0)) && near(&sin, one.clone()));
    let (cos, sin) = oracle.sin_cos(EIGHTH);
    // √½ is the root of 2^(2·160 − 1).
    assert!(near(&cos, power(2 * WIDE - 1).sqrt()) && near(&sin, power(2 * WIDE - 1).sqrt()));
    let (cos, sin) = series(&(pi(WIDE) / 6));
    assert!(near(&sin, &one >> 1) && near(&cos, (power(2 * WIDE - 2) * 3u32).sqrt()));
}

#[test]
fn sin_cos_errs_by_less_than_stated_over_a_million_angles() {
    // Every sum of a coarse and a fine angle, each scattered over all bits: 2^9 · 2^11 = 2^20 angles by the addition
    // theorem, which the oracle's own bits make exact to 2⁻¹⁵⁰.
    let oracle = Oracle::new();
    let part = |bits: i64| (bits, oracle.sin_cos(bits));
    let coarse: Vec<_> = (0..512).map(|i| part((i << 39) + (scattered(i as u64) >> 25) as i64)).collect();
    let fine: Vec<_> = (0..2048).map(|i| part((i << 28) + (scattered(i as u64 + 512) >> 36) as i64)).collect();
    let (mut worst, mut worst_norm) = (0, 0);
    for (a, (cos_a, sin_a)) in &coarse {
        for (b, (cos_b, sin_b)) in &fine {
            let exact = ((cos_a * cos_b - sin_a * sin_b) >> WIDE, (sin_a * cos_b + cos_a * sin_b) >> WIDE);
            worst = worst.max(error(a + b, &exact));
            worst_norm = worst_norm.max(norm_error(a + b));
        }
    }
    println!("sin_cos: worst error {}e-12", in_trillionths(worst));
    println!("sin_cos: worst norm error {}e-12", (worst_norm * 1_000_000_000_000) >> 60);
    assert!(in_trillionths(worst) < STATED_TRILLIONTHS);
    assert!(worst_norm * 1_000_000_000 < 2 << 60);
}

#[test]
fn sin_cos_errs_by_less_than_stated_at_the_edges_of_octants() {
    let oracle = Oracle::new();
    let mut worst = 0;
    for octant in 0..8 {
        let steps = (-64..=64).chain((7..45).flat_map(|k| [-(1 << k), 1 << k]));
        for step in steps {
            let bits = octant * EIGHTH + step;
            worst = worst.max(error(bits, &oracle.sin_cos(bits)));
            assert!(norm_error(bits) * 1_000_000_000 < 2 << 60, "the norm at {bits}");
        }
    }
    println!("sin_cos at octant edges: worst error {}e-12", in_trillionths(worst));
    assert!(in_trillionths(worst) < STATED_TRILLIONTHS);
}

#[test]
fn sin_cos_is_exact_at_the_quadrants() {
    const ONE: i32 = 1 << 30;
    for whole in [0, 1, -1, 1000, -32_768, 32_767] {
        for (quadrant, expected) in [(ONE, 0), (0, ONE), (-ONE, 0), (0, -ONE)].into_iter().enumerate() {
            let bits = whole * TURN + quadrant as i64 * QUARTER;
            assert_eq!(sin_cos(Angle::from_bits(bits)), expected, "{quadrant} quarters and {whole} turns");
        }
    }
}

/// The symmetries of one angle, to the bit.
fn is_symmetric(bits: i64) -> Result<(), TestCaseError> {
    let of = |bits: i64| sin_cos(Angle::from_bits(bits));
    let (cos, sin) = of(bits);
    prop_assert_eq!(of(bits.wrapping_neg()), (cos, -sin), "the mirror of {}", bits);
    prop_assert_eq!(of(bits.wrapping_add(QUARTER)), (-sin, cos), "a quarter turn from {}", bits);
    prop_assert_eq!(of(bits.wrapping_add(TURN / 2)), (-cos, -sin), "half a turn from {}", bits);
    prop_assert_eq!(of(QUARTER.wrapping_sub(bits)), (sin, cos), "the complement of {}", bits);
    prop_assert_eq!(of(bits.wrapping_add(TURN)), (cos, sin), "a turn from {}", bits);
    prop_assert_eq!(of(bits & (TURN - 1)), (cos, sin), "{} without whole turns", bits);
    prop_assert_eq!(Rot::new(Angle::from_bits(bits)), Rot { cos, sin });
    prop_assert!(cos.abs() <= 1 << 30 && sin.abs() <= 1 << 30);
    Ok(())
}

#[test]
fn sin_cos_is_symmetric_at_the_edges_of_octants() -> Result<(), TestCaseError> {
    for octant in -16..=16 {
        for step in -300..=300 {
            is_symmetric(octant * EIGHTH + step)?;
        }
    }
    is_symmetric(i64::MIN)?;
    is_symmetric(i64::MAX)
}

proptest! {
    #![proptest_config(draws(20_000))]

    #[test]
    fn sin_cos_is_symmetric_to_the_bit(bits in prop_oneof![any::<i64>(), any_i64()]) {
        is_symmetric(bits)?;
    }

    #[test]
    fn sin_cos_has_unit_norm(bits in prop_oneof![any::<i64>(), any_i64()]) {
        prop_assert!(norm_error(bits) * 1_000_000_000 < 2 << 60);
    }

    #[test]
    fn sin_cos_never_turns_back(bits in 0..EIGHTH, step in 0u32..40) {
        // In the first octant the sine grows and the cosine falls.
        let here = sin_cos(Angle::from_bits(bits));
        let there = sin_cos(Angle::from_bits((bits + (1 << step)).min(EIGHTH)));
        prop_assert!(there.0 <= here.0 && there.1 >= here.1);
    }
}

#[test]
fn cordic_agrees_within_its_own_error() {
    // `cordic` takes radians in 32 fraction bits and is called within ±π/2 only, where it reduces nothing.
    let oracle = Oracle::new();
    let (mut worst_cordic, mut worst_apart) = (0, 0);
    for index in 0..8192 {
        let bits = (scattered(index) as i64) >> 18;
        let radians: i64 = (oracle.radians(bits) >> (WIDE - 32)).try_into().expect("a small angle");
        let radians = I32F32::from_bits(radians);
        assert!(radians.abs() <= I32F32::FRAC_PI_2);
        let (sin, cos) = cordic::sin_cos(radians);
        let exact = series(&(BigInt::from(radians.to_bits()) << (WIDE - 32)));
        let ours = sin_cos(Angle::from_bits(bits));
        for (part, ours, exact) in [(cos, ours.0, &exact.0), (sin, ours.1, &exact.1)] {
            let wide = i128::from(part.to_bits()) << (NARROW - 32);
            worst_cordic = worst_cordic.max((wide - narrow(exact)).abs());
            worst_apart = worst_apart.max((wide - (i128::from(ours) << (NARROW - 30))).abs());
        }
    }
    let (own, apart) = (in_trillionths(worst_cordic), in_trillionths(worst_apart));
    println!("cordic: own error {own}e-12, apart {apart}e-12");
    // The floored radians are off by up to 2⁻³² = 233e-12 on top of both errors.
    assert!(own < CORDIC_TRILLIONTHS && apart < CORDIC_TRILLIONTHS + STATED_TRILLIONTHS + 233);
}

/// The greatest error of `cordic::sin_cos` in `I32F32` within ±π/2, measured 4.6e-9 by the test above.
const CORDIC_TRILLIONTHS: i128 = 5_000;

/// How far `atan2` is from the exact angle, in millionths of 2⁻⁴⁸ turns: (y·cos − x·sin)/|(x, y)| is the sine of
/// what is missing.
fn atan2_error(oracle: &Oracle, y: i64, x: i64) -> i128 {
    let angle = atan2(y, x);
    let (cos, sin) = oracle.sin_cos(angle.to_bits());
    let along = &cos * x + &sin * y;
    let across = &cos * y - &sin * x;
    assert_eq!(along.sign(), Sign::Plus, "atan2({y}, {x}) looks backwards");
    // |(x, y)| with 64 fraction bits; a sine this small is its angle.
    let length = ((BigInt::from(x) * x + BigInt::from(y) * y) << 128u32).sqrt();
    let whole_turn: BigInt = (length * &oracle.tau) >> WIDE;
    let turns: BigInt = (((across << (48 + 64)) * 1_000_000) / whole_turn) >> WIDE;
    i128::try_from(turns).expect("a small error").abs()
}

/// One unit of 2⁻⁴⁸ turns and 1e-15 turns, the bound that the documentation of `atan2` states, in millionths of the
/// unit: 2⁴⁸ · 1e-15 = 0.281474.
const STATED_MILLIONTHS: i128 = 1_281_474;

/// The ends of the coordinates' range and what lies next to zero.
const EDGES: [i64; 11] =
    [i64::MIN, -i64::MAX, -(1 << 56), -(1 << 32), -1, 0, 1, 1 << 32, 1 << 56, i64::MAX - 1, i64::MAX];

#[test]
fn atan2_errs_by_less_than_stated() {
    let oracle = Oracle::new();
    let mut worst = 0;
    for y in EDGES {
        for x in EDGES.into_iter().filter(|&x| (x, y) != (0, 0)) {
            worst = worst.max(atan2_error(&oracle, y, x));
        }
    }
    println!("atan2 at the ends: worst error {worst} millionths of 2^-48 turns");
    for index in 0..100_000u64 {
        // All directions, and lengths of 2 to 63 bits.
        let shift = scattered(3 * index) % 62;
        let y = scattered(3 * index + 1) as i64 >> shift;
        let x = scattered(3 * index + 2) as i64 >> shift;
        if (x, y) != (0, 0) {
            worst = worst.max(atan2_error(&oracle, y, x));
        }
    }
    println!("atan2: worst error {worst} millionths of 2^-48 turns");
    assert!(worst < STATED_MILLIONTHS);
}

#[test]
fn atan2_is_exact_at_multiples_of_an_eighth() {
    assert_eq!(atan2(0, 0), Angle::ZERO);
    for k in (0..63).map(|exponent| 1i64 << exponent).chain([3, 5, 1_000_000_007, i64::MAX]) {
        let eighths = [(0, k), (k, k), (k, 0), (k, -k), (0, -k)];
        for (count, (y, x)) in eighths.into_iter().enumerate() {
            assert_eq!(atan2(y, x), Angle::from_bits(count as i64 * EIGHTH), "atan2({y}, {x})");
        }
        for (count, (y, x)) in [(-k, k), (-k, 0), (-k, -k)].into_iter().enumerate() {
            assert_eq!(atan2(y, x), Angle::from_bits(-(count as i64 + 1) * EIGHTH), "atan2({y}, {x})");
        }
    }
    const LEAST: i64 = i64::MIN;
    for (y, x, eighths) in [(LEAST, LEAST, -3), (LEAST, 0, -2), (0, LEAST, 4)] {
        assert_eq!(atan2(y, x), Angle::from_bits(eighths * EIGHTH), "atan2({y}, {x})");
    }
}

#[test]
fn atan2_stays_in_its_half_open_turn_for_the_flattest_vectors() {
    for (y, x) in [(-1, i64::MIN), (-1, -i64::MAX), (-1, -(1 << 56)), (-127, i64::MIN)] {
        let angle = atan2(y, x).to_bits();
        assert!(angle > -TURN / 2, "atan2({y}, {x}) is {} turns", Angle::from_bits(angle));
    }
}

proptest! {
    #![proptest_config(draws(20_000))]

    #[test]
    fn atan2_is_within_its_bound_for_all_magnitudes(y in any_i64(), x in any_i64()) {
        prop_assume!((x, y) != (0, 0));
        prop_assert!(atan2_error(&Oracle::new(), y, x) < STATED_MILLIONTHS);
    }

    #[test]
    fn atan2_is_symmetric_to_the_bit(y in any_i64(), x in any_i64()) {
        let (y, x) = (y.max(-i64::MAX), x.max(-i64::MAX));
        let of = |y, x| atan2(y, x).to_bits();
        let angle = of(y, x);
        prop_assert!((-TURN / 2..=TURN / 2).contains(&angle));
        if angle.abs() != TURN / 2 {
            prop_assert_eq!(of(-y, x), -angle, "mirrored at the x axis");
        }
        if x > 0 && y > 0 {
            prop_assert_eq!(of(y, -x), TURN / 2 - angle, "mirrored at the y axis");
            prop_assert_eq!(of(x, y), QUARTER - angle, "mirrored at the diagonal");
            prop_assert_eq!(of(x, -y), QUARTER + angle, "turned by a quarter");
        }
    }

    #[test]
    fn atan2_depends_on_the_direction_only(
        y in -(1i64 << 40)..1 << 40, x in -(1i64 << 40)..1 << 40, k in 1i64..1 << 22,
    ) {
        prop_assert_eq!(atan2(k * y, k * x), atan2(y, x));
    }

    #[test]
    fn atan2_inverts_sin_cos(bits in -TURN / 2 + 1..=TURN / 2) {
        let (cos, sin) = sin_cos(Angle::from_bits(bits));
        let back = atan2(sin.into(), cos.into()).to_bits();
        // Two errors of 4.8e-10 at a right angle are 6.8e-10 rad, 1.09e-10 turns, 30 500 units.
        let off = (back - bits + TURN / 2).rem_euclid(TURN) - TURN / 2;
        prop_assert!(off.abs() <= 30_500, "{} units apart", off);
    }
}
