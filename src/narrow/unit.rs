//! Directions and lengths without a root or a division: those of the standard library take 28 ns and 5 ns for 128 bits.

use super::inner;
use crate::num::sqrt;

/// 1/√a in the middle of each interval of 1/64 from 1/4 to 2, Q62: right to 2⁻⁶.
const START: [u64; 112] = {
    let mut start = [0; 112];
    let mut index = 0;
    while index < 112 {
        // a = (2·index + 33)/128, so 2⁶²/√a = √(2¹³¹/(2·index + 33)).
        start[index] = sqrt((1u128 << 127) / (2 * index as u128 + 33) * 16);
        index += 1;
    }
    start
};

/// The high half of a product: Q64·Qf is Qf.
#[inline]
fn high(a: u64, b: u64) -> u64 {
    (u128::from(a).wrapping_mul(u128::from(b)) >> 64) as u64
}

/// 1/√a, Q62, for 1/4 ≤ a < 2, Q63. Relative error: 2⁻⁴⁷.
///
/// Two rounds of r ← r·(1 + δ/2 + 3δ²/8) with δ = 1 − a·r², which takes an error of ε to 5/2·ε³.
#[inline]
fn inverse_root(a: u64) -> u64 {
    let mut root = START[((a >> 57) as usize).saturating_sub(16).min(111)];
    for _ in 0..2 {
        // Q62·Q62 has Q60 in its high half, with Q63 then Q59; |δ| < 2⁻⁴, and 31 bits of it
        // will do for its square.
        let error = (1i64 << 59).wrapping_sub(high(a, high(root, root)) as i64);
        let short = error >> 28;
        let squared = short.wrapping_mul(short) >> 3;
        let factor = (error >> 1).wrapping_add(squared.wrapping_mul(3) >> 3);
        root = root.wrapping_add((i128::from(root).wrapping_mul(i128::from(factor)) >> 59) as u64);
    }
    root
}

/// The unit vector along `v` (Q30, error below 0.51 units) and its length in the format of `v` (error below 0.51 units
/// and 2⁻⁴⁷ of it); none of the zero vector. Odd. Range: coordinates below 2⁶².
#[inline]
pub(super) fn unit(v: [i64; 2]) -> Option<([i32; 2], i64)> {
    let magnitude = v.map(i64::unsigned_abs);
    let bits = magnitude[0] | magnitude[1];
    if bits == 0 {
        return None;
    }
    // The greater coordinate to 2⁶¹ … 2⁶², so that the square is in 2¹²² … 2¹²⁵: 2¹²⁴ times an a from 1/4 to 2.
    let up = bits.leading_zeros().saturating_sub(2);
    let [x, y] = magnitude.map(|c| c.wrapping_shl(up));
    let a = (inner([x as i64, y as i64], [x as i64, y as i64]) >> 61) as u64;
    let inverse = inverse_root(a);
    // Of v·2^up/(2⁶²·√a) the high half has 60 fraction bits.
    let part = |c: u64, of: i64| {
        let magnitude = (high(c, inverse).wrapping_add(1 << 29) >> 30) as i32;
        if of < 0 { magnitude.wrapping_neg() } else { magnitude }
    };
    // √a = a·(1/√a), Q125, brought to Q62. The bit shifted out last rounds; there is none if `up` is 0.
    let root = (u128::from(a).wrapping_mul(u128::from(inverse)) >> 63) as u64;
    let length = (root >> up).wrapping_add(root.wrapping_shr(up.wrapping_sub(1)) & 1) as i64;
    Some(([part(x, v[0]), part(y, v[1])], length))
}
