//! Products, quotients and shifts with the one rounding: to nearest, ties away from zero, hence odd.
//!
//! | kernel | operands | exact intermediate | why it cannot overflow |
//! |---|---|---|---|
//! | `round_shift` | `i128` | magnitude `u128` | a magnitude below 2¹²⁷ shifted by ≥ 1 leaves room for the carry |
//! | `mul`, `mul_add` | `i64` |  product at most 2¹²⁶ in `i128` | 2⁶³ · 2⁶³ = 2¹²⁶; an addend of 2¹²⁵ and half a unit of 2¹²⁵ more fit |
//! | `dot`, `cross` | four `i64` | sum of two products | at most 2¹²⁷ in magnitude, added with saturation |
//! | `div` | `i128` by `i128` | quotient and remainder | the remainder is compared, never doubled |

/// The greatest magnitude a kernel returns: the range is symmetric, `i64::MIN` is never produced.
const MAX: i128 = i64::MAX as i128;

/// `value / 2^shift`, rounded.
///
/// Range: any `value`; `shift` above 127 gives 0. Rounding: nearest, ties away from zero.
#[inline]
pub const fn round_shift(value: i128, shift: u32) -> i128 {
    if shift == 0 {
        return value;
    }
    if shift > 127 {
        return 0;
    }
    let magnitude = value.unsigned_abs();
    let rounded = ((magnitude >> shift) + ((magnitude >> (shift - 1)) & 1)) as i128;
    if value < 0 { -rounded } else { rounded }
}

/// [`round_shift`] without the detour by the magnitude, for the sums of the loops: 1 ≤ `shift` ≤ 126 and
/// |`value`| ≤ 2¹²⁶ + 2¹²⁵, so that adding half a unit, at most 2¹²⁵, does not reach 2¹²⁷.
#[inline]
const fn round_bounded(value: i128, shift: u32) -> i128 {
    debug_assert!(shift >= 1 && shift <= 126, "the shift leaves room for half a unit");
    // value >> 127 is −1 for negative values: it takes a tie away from zero, as for positive ones.
    (value + (1 << (shift - 1)) + (value >> 127)) >> shift
}

/// [`round_shift`], in less time where [`round_bounded`] may be asked: nearly always.
#[inline]
const fn round_sum(value: i128, shift: u32) -> i128 {
    let bounded = value >> 126 == value >> 127 && shift >= 1 && shift <= 126;
    if bounded { round_bounded(value, shift) } else { round_shift(value, shift) }
}

/// A shift within the contract of the product kernels.
const fn limited(shift: u32) -> u32 {
    debug_assert!(shift >= 1 && shift <= 126, "a product is shifted by 1 to 126 bits");
    if shift < 1 {
        1
    } else if shift > 126 {
        126
    } else {
        shift
    }
}

/// `value` limited to ±`i64::MAX`.
#[inline]
pub const fn clamp_i64(value: i128) -> i64 {
    if value > MAX {
        i64::MAX
    } else if value < -MAX {
        -i64::MAX
    } else {
        value as i64
    }
}

/// `a + b`, limited to ±`i64::MAX`.
#[inline]
pub const fn add_sat(a: i64, b: i64) -> i64 {
    let sum = a.saturating_add(b);
    if sum == i64::MIN { -i64::MAX } else { sum }
}

/// `a·b / 2^shift`: a product of two fixed-point numbers brought to another format.
///
/// Rounding: once, to nearest. Overflow: saturates at ±`i64::MAX`. Range: `shift` is 1 … 126.
///
/// ```
/// // 0.5 in 48 fraction bits times 1/60 in 63 fraction bits, as a length of 32 fraction bits.
/// let h = tamias2d::num::div(1 << 63, 60) as i64;
/// assert_eq!(tamias2d::num::mul(1 << 47, h, 48 + 63 - 32), 35_791_394);
/// ```
#[inline]
pub const fn mul(a: i64, b: i64, shift: u32) -> i64 {
    clamp_i64(round_bounded(a as i128 * b as i128, limited(shift)))
}

/// `(a·b + c·2^lift) / 2^shift` with one rounding: `lift` brings `c` to the fraction bits of the product.
///
/// Range: `lift` is 0 … 62, `shift` 1 … 126. Overflow: saturates at ±`i64::MAX`.
#[inline]
pub const fn mul_add(a: i64, b: i64, c: i64, lift: u32, shift: u32) -> i64 {
    debug_assert!(lift <= 62, "an addend of 63 bits is lifted to at most 125");
    let lift = if lift > 62 { 62 } else { lift };
    clamp_i64(round_bounded(a as i128 * b as i128 + ((c as i128) << lift), limited(shift)))
}

/// `(ax·bx + ay·by) / 2^shift` with one rounding. Overflow: saturates at ±`i64::MAX`.
#[inline]
pub const fn dot(a: [i64; 2], b: [i64; 2], shift: u32) -> i64 {
    let sum = (a[0] as i128 * b[0] as i128).saturating_add(a[1] as i128 * b[1] as i128);
    clamp_i64(round_sum(sum, shift))
}

/// `(ax·by − ay·bx) / 2^shift` with one rounding; counter-clockwise positive. Overflow: saturates at ±`i64::MAX`.
#[inline]
pub const fn cross(a: [i64; 2], b: [i64; 2], shift: u32) -> i64 {
    let difference = (a[0] as i128 * b[1] as i128).saturating_sub(a[1] as i128 * b[0] as i128);
    clamp_i64(round_sum(difference, shift))
}

/// `n / d`, rounded to nearest, ties away from zero.
///
/// Overflow: `d = 0` gives ±`i128::MAX` by the sign of `n` (0 for 0/0); so does `i128::MIN / -1`.
pub const fn div(n: i128, d: i128) -> i128 {
    let (un, ud) = (n.unsigned_abs(), d.unsigned_abs());
    let negative = (n < 0) != (d < 0);
    let magnitude = match (un.checked_div(ud), un.checked_rem(ud)) {
        // r ≥ d − r is 2r ≥ d without the doubling that could overflow.
        (Some(q), Some(r)) => q + (r >= ud - r) as u128,
        _ if un == 0 => 0,
        _ => u128::MAX,
    };
    signed(negative, magnitude)
}

/// A magnitude with its sign, limited to ±`i128::MAX`.
pub(super) const fn signed(negative: bool, magnitude: u128) -> i128 {
    let limited = if magnitude > i128::MAX as u128 { i128::MAX } else { magnitude as i128 };
    if negative { -limited } else { limited }
}
