//! Kernels of the contact rows: 32-bit operands, 64-bit sums, as eight lanes side by side could do them.
//!
//! | value | format | bound | kept by |
//! |---|---|---|---|
//! | velocity of a body | Q48, i64 | 2⁶⁰ (4096 m/s) | [`bounded`] |
//! | velocity read | Q20, i32 | 2³⁰ (1024 m/s) | [`read`] |
//! | coefficient | Q28, i32 | 2³¹ (8) | preparation |
//! | impulse λ̂ | Q20, i32 | 2²⁹ (512 m/s) | [`clamp`] |
//! | position delta, separation | Q26, i32 | 2³⁰ (16 m) | [`round_to`] |
//!
//! A coefficient times a read has 48 fraction bits, the state's own, so what a row adds to a velocity is exact. Sums:
//! a relative velocity is two products below 2⁵⁸, two below 2⁶¹ and two below 2⁵⁸: below 2⁶³. A body's velocity plus all
//! that one contact adds is 2⁶⁰ + 2·2⁶⁰ + 2·2⁶¹ < 2⁶³. In builds with overflow checks the sums below check that.

/// A velocity with 48 fraction bits as a read with 20, to nearest and odd, limited to ±2³⁰.
#[inline(always)]
pub(crate) const fn read(v: i64) -> i32 {
    round_to::<28>(v)
}

/// `v / 2^SHIFT` to nearest and odd, limited to ±2³⁰. Range: |v| + 2^(SHIFT−1) < 2⁶³.
#[inline(always)]
pub(crate) const fn round_to<const SHIFT: u32>(v: i64) -> i32 {
    let rounded = (v + (1 << (SHIFT - 1)) + (v >> 63)) >> SHIFT;
    // One comparison that is nearly never true, where a minimum and a maximum would be six instructions each time.
    if (rounded + READ_MAX) as u64 > 2 * READ_MAX as u64 {
        return if v < 0 { -READ_MAX as i32 } else { READ_MAX as i32 };
    }
    rounded as i32
}

const READ_MAX: i64 = 1 << 30;

/// `v / 2^SHIFT` to nearest and odd. Range: |v| < 2⁶².
#[inline(always)]
pub(crate) const fn round<const SHIFT: u32>(v: i64) -> i64 {
    (v + (1 << (SHIFT - 1)) + (v >> 63)) >> SHIFT
}

/// `v / 2^shift` to nearest and odd for a positive shift, `v·2^-shift` for a negative one, which must fit.
#[inline(always)]
pub(crate) const fn shifted(v: i64, shift: i32) -> i64 {
    if shift > 0 { (v + (1 << (shift - 1)) + (v >> 63)) >> shift } else { v << -shift }
}

/// The exact product.
#[inline(always)]
pub(crate) const fn mul(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

/// A sum that the table above bounds.
#[inline(always)]
pub(crate) const fn add(a: i64, b: i64) -> i64 {
    a + b
}

/// A difference that the table above bounds.
#[inline(always)]
pub(crate) const fn sub(a: i64, b: i64) -> i64 {
    a - b
}

/// A body's velocity, limited to ±2⁶⁰. Range: |v| < 2⁶² + 2⁶⁰.
#[inline(always)]
pub(crate) const fn bounded(v: i64) -> i64 {
    const LIMIT: i64 = 1 << 60;
    if (v.wrapping_add(LIMIT)) as u64 > 2 * LIMIT as u64 {
        return if v < 0 { -LIMIT } else { LIMIT };
    }
    v
}

/// `value` limited to `low ..= high`.
#[inline(always)]
pub(crate) const fn clamp(value: i64, low: i64, high: i64) -> i64 {
    let value = if value > high { high } else { value };
    if value < low { low } else { value }
}

/// A coefficient (Q28) times a velocity of 48 fraction bits below 2⁶¹, to nearest and odd.
#[inline(always)]
pub(crate) const fn scale(coefficient: i32, v: i64) -> i64 {
    let product = coefficient as i128 * v as i128;
    ((product + (1 << 27) + (product >> 127)) >> 28) as i64
}

/// `value + 1` of indices and counts, which are far below their format's end.
#[inline(always)]
pub(crate) const fn next(value: usize) -> usize {
    value + 1
}

/// A coefficient times a difference of two values of 31 bits: below 2⁶² for a normal, which is below 2²⁸·2.
#[inline(always)]
pub(crate) const fn times(coefficient: i32, difference: i64) -> i64 {
    coefficient as i64 * difference
}
