//! Sine, cosine and the angle of a vector, from and to turns.
//!
//! `sin_cos` runs in the step: a reduction that is exact in turns and two short polynomials. `cordic` serves `atan2`
//! at the interface's edge, where its time (about 0.2 µs) does not matter, behind guards: its own `atan2` overflows
//! in y/x and its `sqrt` does not return for some inputs, so neither is called.

use super::angle::{TAU_Q60, TURN_PER_RADIAN_Q64};
use super::{Angle, div, round_shift};
use fixed::FixedI64;
use fixed::types::extra::U56;

/// Fraction bits inside the polynomials.
const Q: u32 = 62;
/// One turn, a quarter and an eighth of it, in the 48 fraction bits of [`Angle`].
const TURN: i64 = 1 << 48;
const QUARTER: i64 = TURN >> 2;
const EIGHTH: i64 = TURN >> 3;

/// Product of two numbers with `Q` fraction bits, floored: only between even powers, so oddness is not touched.
#[inline]
const fn mul_q(a: i64, b: i64) -> i64 {
    ((a as i128 * b as i128) >> Q) as i64
}

/// (cos, sin) of an angle, with 30 fraction bits each.
///
/// Range: any angle; whole turns drop out exactly. Error: below 4.8e-10 (half a unit is 4.66e-10), measured over
/// 2²⁰ angles and all octant edges by the tests; exact at the quadrants; |cos² + sin² − 1| < 2e-9.
/// Symmetry, to the bit: sin(−θ) = −sin θ, cos(−θ) = cos θ, sin(θ + ¼) = cos θ.
/// Why it cannot overflow: |r| ≤ π/4 and each Horner value lies in (½, 1], all in 62 fraction bits of 64.
///
/// ```
/// use tamias2d::{Angle, num::sin_cos};
/// assert_eq!(sin_cos(Angle::from_bits(1 << 46)), (0, 1 << 30)); // a quarter turn
/// ```
#[inline]
pub const fn sin_cos(angle: Angle) -> (i32, i32) {
    let fraction = angle.to_bits() & (TURN - 1);
    // The nearest quadrant, and what is left of the angle: at most an eighth of a turn to either side.
    let quadrant = (fraction + EIGHTH) >> 46;
    let rest = fraction - quadrant * QUARTER;
    let r = round_shift(rest as i128 * TAU_Q60, 48 + 60 - Q) as i64;
    let r2 = mul_q(r, r);

    const ONE: i64 = 1 << Q;
    // 1 − r²/2·3 (1 − r²/4·5 (…)): the first term left out is r¹³/13! < 7e-12.
    let mut s = ONE - mul_q(r2, ONE / 110);
    s = ONE - mul_q(mul_q(r2, ONE / 72), s);
    s = ONE - mul_q(mul_q(r2, ONE / 42), s);
    s = ONE - mul_q(mul_q(r2, ONE / 20), s);
    s = ONE - mul_q(mul_q(r2, ONE / 6), s);
    // The same for the cosine; the first term left out is r¹⁴/14! < 4e-13.
    let mut c = ONE - mul_q(r2, ONE / 132);
    c = ONE - mul_q(mul_q(r2, ONE / 90), c);
    c = ONE - mul_q(mul_q(r2, ONE / 56), c);
    c = ONE - mul_q(mul_q(r2, ONE / 30), c);
    c = ONE - mul_q(mul_q(r2, ONE / 12), c);
    c = ONE - mul_q(mul_q(r2, ONE / 2), c);

    let sin = round_shift(r as i128 * s as i128, 2 * Q - 30) as i32;
    let cos = round_shift(c as i128, Q - 30) as i32;
    match quadrant & 3 {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    }
}

/// The angle of the vector (x, y) from the x axis, in (−½, ½] turns; (0, 0) gives 0.
///
/// Range: any two coordinates of one format. Error: below 0.52 units of 2⁻⁴⁸ turns, measured by the tests. Odd in y,
/// but for the half turn itself. Source: `cordic::atan` in `I8F56` on a ratio of at most 1, where it neither overflows nor
/// loops.
///
/// ```
/// use tamias2d::{Angle, num::atan2};
/// assert_eq!(atan2(3, -3), Angle::from_bits(3 << 45)); // three eighths of a turn
/// ```
pub fn atan2(y: i64, x: i64) -> Angle {
    let (ax, ay) = (x.unsigned_abs() as i128, y.unsigned_abs() as i128);
    let (small, big) = if ay > ax { (ax, ay) } else { (ay, ax) };
    let octant = if small == 0 {
        0
    } else if small == big {
        EIGHTH
    } else {
        let ratio = FixedI64::<U56>::from_bits(div(small << 56, big) as i64);
        let radians = cordic::atan(ratio).to_bits();
        round_shift(radians as i128 * TURN_PER_RADIAN_Q64, 56 + 64 - 48) as i64
    };
    let from_axis = if ay > ax { QUARTER - octant } else { octant };
    let upper = if x < 0 { 2 * QUARTER - from_axis } else { from_axis };
    // So flat a vector that its angle rounds to the half turn is at the half turn, on whichever side it lies.
    Angle::from_bits(if y < 0 && upper < 2 * QUARTER { -upper } else { upper })
}
