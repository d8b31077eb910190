//! 256-bit intermediates for quantities of 128 bits. Command time only: about a microsecond each.

use super::round::signed;

/// `a·b` as high and low halves of 256 bits.
const fn widening_mul(a: u128, b: u128) -> (u128, u128) {
    const LOW: u128 = u64::MAX as u128;
    let (a1, a0) = (a >> 64, a & LOW);
    let (b1, b0) = (b >> 64, b & LOW);
    let low = a0 * b0;
    // Each term is below 2^64 · 2^64 and each carry below 2^64: no sum below reaches 2^128.
    let mid = a1 * b0 + (low >> 64);
    let mid2 = a0 * b1 + (mid & LOW);
    (a1 * b1 + (mid >> 64) + (mid2 >> 64), (mid2 << 64) | (low & LOW))
}

/// `a·b / d` with a 256-bit product, rounded to nearest, ties away from zero.
///
/// Overflow: saturates at ±`i128::MAX`; so does `d = 0` (0 when the product is 0).
///
/// ```
/// use tamias2d::num::mul_div;
/// assert_eq!(mul_div(i128::MAX, 3, 3), i128::MAX);
/// assert_eq!(mul_div(-1, 1, 2), -1);
/// ```
pub const fn mul_div(a: i128, b: i128, d: i128) -> i128 {
    let negative = ((a < 0) != (b < 0)) != (d < 0);
    let divisor = d.unsigned_abs();
    let (high, low) = widening_mul(a.unsigned_abs(), b.unsigned_abs());
    if high >= divisor {
        // The quotient needs more than 128 bits, or there is no divisor.
        return if high == 0 && low == 0 { 0 } else { signed(negative, u128::MAX) };
    }
    if high == 0 {
        let (quotient, remainder) = (low / divisor, low % divisor);
        return signed(negative, quotient + (remainder >= divisor - remainder) as u128);
    }
    // Restoring division, one bit a round: remainder < divisor ≤ 2^127 holds throughout, so doubling it fits.
    let (mut remainder, mut quotient) = (high, 0u128);
    let mut bit = 128;
    while bit > 0 {
        bit -= 1;
        remainder = (remainder << 1) | ((low >> bit) & 1);
        quotient <<= 1;
        if remainder >= divisor {
            remainder -= divisor;
            quotient |= 1;
        }
    }
    let up = (remainder >= divisor - remainder) as u128;
    signed(negative, quotient.saturating_add(up))
}

/// `(ax·by − ay·bx) / 2^shift` with an exact 256-bit difference, rounded to nearest, ties away from zero;
/// counter-clockwise positive.
///
/// Range: operands below 2¹²⁶ in magnitude, larger ones are limited to it; `shift` is 1 … 127, others are limited.
/// Overflow: saturates at ±`i128::MAX`.
///
/// ```
/// // Both products are beyond 128 bits, their difference is not.
/// let far = 1 << 100;
/// assert_eq!(tamias2d::num::cross_wide([far, far], [far, far - 4], 1), -(1 << 101));
/// ```
pub const fn cross_wide(a: [i128; 2], b: [i128; 2], shift: u32) -> i128 {
    let (left_high, left_low) = signed_mul(a[0], b[1]);
    let (right_high, right_low) = signed_mul(a[1], b[0]);
    // Two's complement of 256 bits; each product is below 2^252, so their difference fits.
    let (low, borrow) = left_low.overflowing_sub(right_low);
    let high = left_high.wrapping_sub(right_high).wrapping_sub(borrow as u128);
    let negative = (high as i128) < 0;
    let (high, low) = if negative { negate(high, low) } else { (high, low) };
    let shift = if shift < 1 {
        1
    } else if shift > 127 {
        127
    } else {
        shift
    };
    let up = (low >> (shift - 1)) & 1;
    if high >> (shift - 1) != 0 {
        return signed(negative, u128::MAX);
    }
    signed(negative, ((high << (128 - shift)) | (low >> shift)).saturating_add(up))
}

/// `a·b` in two's complement of 256 bits, of operands limited to magnitudes below 2¹²⁶.
const fn signed_mul(a: i128, b: i128) -> (u128, u128) {
    const LIMIT: u128 = (1 << 126) - 1;
    let (ua, ub) = (a.unsigned_abs(), b.unsigned_abs());
    let (high, low) = widening_mul(if ua > LIMIT { LIMIT } else { ua }, if ub > LIMIT { LIMIT } else { ub });
    if (a < 0) != (b < 0) { negate(high, low) } else { (high, low) }
}

/// The negative in two's complement of 256 bits.
const fn negate(high: u128, low: u128) -> (u128, u128) {
    ((!high).wrapping_add((low == 0) as u128), low.wrapping_neg())
}
