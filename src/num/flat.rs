//! Kernels of the preparation of rows, without branches and without products of 128 bits: a compiler puts eight of them
//! side by side. Each gives the bits of the kernel that it names, within the range that it names; beyond, anything.
//!
//! Factors are numbers of 32 bits in 64; of what is greater the upper half is left out. Nothing panics, whatever it is given:
//! lanes in which nobody sits, or whose contact is left over, are computed as well.

/// `a·b`, of factors.
#[inline(always)]
pub(crate) const fn mul(a: i64, b: i64) -> i64 {
    (a as i32 as i64).wrapping_mul(b as i32 as i64)
}

#[inline(always)]
pub(crate) const fn add(a: i64, b: i64) -> i64 {
    a.wrapping_add(b)
}

#[inline(always)]
pub(crate) const fn sub(a: i64, b: i64) -> i64 {
    a.wrapping_sub(b)
}

/// −1 for what is negative, else 0.
#[inline(always)]
pub(crate) const fn sign(v: i64) -> i64 {
    v >> 63
}

/// `no` or `yes`.
#[inline(always)]
pub(crate) const fn pick(condition: bool, yes: i64, no: i64) -> i64 {
    if condition { yes } else { no }
}

/// `value` limited to ±`most`.
#[inline(always)]
pub(crate) const fn within(value: i64, most: i64) -> i64 {
    let value = pick(value > most, most, value);
    pick(value < -most, -most, value)
}

/// [`lane::round`](super::lane::round).
#[inline(always)]
pub(crate) const fn round<const SHIFT: u32>(v: i64) -> i64 {
    add(add(v, 1 << (SHIFT - 1)), sign(v)) >> SHIFT
}

/// [`lane::scale`](super::lane::scale) of factors.
#[inline(always)]
pub(crate) const fn scale(coefficient: i64, v: i64) -> i64 {
    round::<28>(mul(coefficient, v))
}

/// Whether a number is no factor: 1 if so, else 0.
#[inline(always)]
pub(crate) const fn beyond(v: i64) -> i64 {
    (v as i32 as i64 != v) as i64
}

/// [`mul`](super::mul) of a number of 47 bits, which is not negative, and a factor, shifted by 30.
#[inline(always)]
pub(crate) const fn part(value: i64, factor: i64) -> i64 {
    // By halves; what the lower one leaves beyond 16 bits does not reach the rest.
    let low = add(add(mul(value & 0xffff, factor), sign(factor)), 1 << 29);
    add(mul(value >> 16, factor), low >> 16) >> 14
}

/// [`mul`](super::mul) of a number of 59 bits and a factor that is not negative, shifted by 56.
#[inline(always)]
pub(crate) const fn carry(value: i64, factor: i64) -> i64 {
    let low = add(mul(value & ((1 << 28) - 1), factor), sign(value));
    add(add(mul(value >> 28, factor), low >> 28), 1 << 27) >> 28
}

/// [`mul`](super::mul) of a number of 55 bits and a factor, shifted by 48; neither is negative.
#[inline(always)]
pub(crate) const fn hold(value: i64, factor: i64) -> i64 {
    let low = mul(value & ((1 << 24) - 1), factor);
    add(add(mul(value >> 24, factor), low >> 24), 1 << 23) >> 24
}

/// 2⁵⁶/v to nearest, for v from 2²⁸ on, below 2³¹.
///
/// By Newton's iteration from a straight line; the last unit by the remainder.
#[inline(always)]
pub(crate) const fn inverse(v: i64) -> i64 {
    // v·2^up from 2³⁰ on, as d from 1/2 to 1, Q31; its inverse Q29.
    let up = 2 - (v >= 1 << 29) as i64 - (v >= 1 << 30) as i64;
    let d = v << up;
    // 48/17 − 32/17·d is off by 1/17 at most; each round squares that.
    let mut r = sub(1_515_870_810, mul(d, 1_010_580_540) >> 31);
    let mut round = 0;
    while round < 3 {
        let left = sub(1 << 60, mul(d, r)) >> 29;
        r = add(r, mul(r, left) >> 31);
        round += 1;
    }
    // 2⁵⁶/v is r·2^(up − 4).
    let mut quotient = r >> (4 - up);
    let rest = sub(add(1 << 56, v >> 1), mul(quotient, v));
    quotient = add(quotient, (rest >= v) as i64);
    sub(quotient, (rest < 0) as i64)
}
