//! Kernels of the contact rows: 32-bit operands, 64-bit sums, as eight lanes side by side could do them.
//!
//! | value | format | bound | kept by |
//! |---|---|---|---|
//! | velocity of a body in the sweeps | Q48, i64 | 2⁵⁷ (512 m/s) | [`held`] |
//! | velocity read, or a difference of two | Q20, i32 | 2²⁹, 2³⁰ | [`held`] |
//! | coefficient | Q28, i32 | 2³¹ (8) | preparation |
//! | coefficient from row to row | Q27, i32 | 11·2²⁷ | preparation |
//! | impulse λ̂ | Q20, i32 | 2²⁹ (512 m/s) | [`clamp`] |
//! | position delta, separation | Q26, i32 | 2³⁰ (16 m) | [`round_to`], [`limit`] |
//!
//! A coefficient times a read has 48 fraction bits, the state's own, so what a row adds to a velocity is exact. A row's
//! impulse changes by 2²⁹ along a normal, by 2³⁰ along a tangent. Sums: the speed of a second point is two products below
//! 2⁵⁸, of the normal's components, two below 2⁶⁰, of arms, and what two impulses add: 11·2⁵⁸ and 11·2⁵⁷ + 2⁵⁷. That is
//! 27·2⁵⁸ < 2⁶³. A w plus all that one contact adds is 2⁵⁷ + 2⁶¹ + 2·2⁶⁰ < 2⁶³; a v is less. In builds with overflow
//! checks the sums below check that.

/// `v / 2^SHIFT` to nearest and odd, limited to ±2³⁰. Range: |v| + 2^(SHIFT−1) < 2⁶³.
#[inline(always)]
pub(crate) const fn round_to<const SHIFT: u32>(v: i64) -> i32 {
    limit(round::<SHIFT>(v))
}

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

/// A body's velocity between ticks, limited to ±2⁶⁰. Range: |v| < 2⁶² + 2⁶⁰.
#[inline(always)]
pub(crate) const fn bounded(v: i64) -> i64 {
    clamp(v, -(1 << 60), 1 << 60)
}

/// The bound of a body's velocities in the sweeps, 512 m/s in Q48.
pub(crate) const HELD: i64 = 1 << 57;

/// A body's velocities in the sweeps, limited to ±[`HELD`]. Range: |v| < 2⁶³ − 2⁵⁷.
#[inline(always)]
pub(crate) fn held(v: [i64; 3]) -> [i64; 3] {
    const LIMIT: i64 = HELD;
    // One comparison for all three that is nearly never true.
    if ((v[0] + LIMIT) | (v[1] + LIMIT) | (v[2] + LIMIT)) as u64 >= 2 * LIMIT as u64 {
        return v.map(|v| clamp(v, -LIMIT, LIMIT));
    }
    v
}

/// `value`, limited to ±2³⁰.
#[inline(always)]
pub(crate) const fn limit(value: i64) -> i32 {
    const MAX: i64 = 1 << 30;
    // One comparison that is nearly never true, where a minimum and a maximum would be six instructions each time.
    if (value + MAX) as u64 > 2 * MAX as u64 {
        return if value < 0 { -MAX as i32 } else { MAX as i32 };
    }
    value as i32
}

/// A speed, and what an impulse adds to it by a coefficient with 27 fraction bits.
#[inline(always)]
pub(crate) const fn coupled(speed: i64, coefficient: i32, impulse: i32) -> i64 {
    speed + 2 * mul(coefficient, impulse)
}

/// An overlap beyond the slop, not positive: of a separation of at least −2³⁰.
#[inline(always)]
pub(crate) const fn deeper(separation: i32, slop: i32) -> i32 {
    if separation < -slop { separation + slop } else { 0 }
}

/// A load of which what is beyond 4/3 of `firm` counts a quarter. Range: 0 ≤ load ≤ 2²⁹, 0 ≤ firm < 2³⁰.
#[inline(always)]
pub(crate) const fn eased(load: i32, firm: i32) -> i32 {
    let less = (load >> 2) + firm;
    if load < less { load } else { less }
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
    // Nearly always: then 64 bits do.
    if v as i32 as i64 == v {
        return round::<28>(coefficient as i64 * v);
    }
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
