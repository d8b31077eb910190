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
