//! Square roots by the integer roots of the standard library, rounded to nearest.

/// The square root of `value`, rounded to nearest.
///
/// A format with 2f fraction bits gives one with f. Error: at most half a unit. Range: any value; there is no tie,
/// because (r + ½)² is never an integer.
#[inline]
pub const fn sqrt(value: u128) -> u64 {
    let root = value.isqrt();
    // value > r² + r is value > (r + ½)² for integers; the root of 2^128 − 1 is 2^64 − 1 and would round to 2^64.
    let up = (value - root * root > root) as u128;
    let rounded = root + up;
    if rounded > u64::MAX as u128 { u64::MAX } else { rounded as u64 }
}

/// The length of (x, y) in the format of its coordinates, rounded to nearest.
///
/// Range: any; two coordinates of 2⁶³ give 2⁶³·⁵, which fits.
///
/// ```
/// assert_eq!(tamias2d::num::hypot(-3, 4), 5);
/// ```
#[inline]
pub const fn hypot(x: i64, y: i64) -> u64 {
    let (x, y) = (x.unsigned_abs() as u128, y.unsigned_abs() as u128);
    sqrt(x * x + y * y)
}
