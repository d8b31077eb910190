//! Exact numbers to compare with: big integers and fractions, written from the definitions and sharing nothing with
//! the kernels. Each test file uses a part of it.
#![allow(dead_code, reason = "each test file uses a part")]

use num_bigint::{BigInt, BigUint, Sign};
use num_rational::BigRational;
use proptest::prelude::*;

/// 2^`exponent`.
pub fn power(exponent: u32) -> BigInt {
    BigInt::from(1) << exponent
}

/// `n / d` as a fraction in lowest terms.
pub fn ratio(n: impl Into<BigInt>, d: impl Into<BigInt>) -> BigRational {
    BigRational::new(n.into(), d.into())
}

/// The nearest integer, ties away from zero.
pub fn nearest_away(value: &BigRational) -> BigInt {
    value.round().to_integer()
}

/// The nearest integer, ties to the even one.
pub fn nearest_even(value: &BigRational) -> BigInt {
    let below = value.floor();
    let rest = value - &below;
    let (below, half) = (below.to_integer(), ratio(1, 2));
    let odd = below.bit(0);
    if rest > half || (rest == half && odd) { below + 1 } else { below }
}

/// `value` limited to ±(2^`bits` − 1).
pub fn limited(value: BigInt, bits: u32) -> BigInt {
    let limit: BigInt = power(bits) - 1;
    value.clamp(-&limit, limit)
}

/// The integer nearest to the root of `value`. No integer has a root halfway between two integers.
pub fn nearest_root(value: &BigUint) -> BigUint {
    let root = value.sqrt();
    let twice: BigUint = (&root << 1) + 1u32;
    if (value << 2) > &twice * &twice { root + 1u32 } else { root }
}

/// The exact decimal expansion of `bits / 2^frac`: multiplied by 10^frac it is the integer `bits · 5^frac`.
pub fn decimal_expansion(bits: &BigInt, frac: u32) -> String {
    let digits = (bits.magnitude() * BigUint::from(5u32).pow(frac)).to_string();
    let places = frac as usize;
    let digits = format!("{digits:0>width$}", width = places + 1);
    let (whole, fraction) = digits.split_at(digits.len() - places);
    let fraction = fraction.trim_end_matches('0');
    let sign = if bits.sign() == Sign::Minus { "-" } else { "" };
    if fraction.is_empty() { format!("{sign}{whole}") } else { format!("{sign}{whole}.{fraction}") }
}

/// `bits / 2^frac` with `places` digits after the point, ties away from zero; a zero has no sign.
pub fn decimal_rounded(bits: &BigInt, frac: u32, places: u32) -> String {
    let scaled = nearest_away(&ratio(bits * BigInt::from(10).pow(places), power(frac)));
    let sign = if scaled.sign() == Sign::Minus { "-" } else { "" };
    let digits = format!("{:0>width$}", scaled.magnitude().to_string(), width = places as usize + 1);
    let (whole, fraction) = digits.split_at(digits.len() - places as usize);
    if fraction.is_empty() { format!("{sign}{whole}") } else { format!("{sign}{whole}.{fraction}") }
}

/// What a decimal text of the form `-?digits[.digits][(e|E)[+-]digits]` means.
pub fn decimal_value(text: &str) -> BigRational {
    let (negative, text) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().expect("an exponent")),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: BigInt = format!("{whole}{fraction}").parse().expect("digits");
    let exponent = exponent - fraction.len() as i32;
    let scale = BigInt::from(10).pow(exponent.unsigned_abs());
    let value = if exponent < 0 { ratio(digits, scale) } else { ratio(digits * scale, 1) };
    if negative { -value } else { value }
}

/// arctan(1/n) with `bits` fraction bits, within 2 units times the number of terms.
fn arctan_of_inverse(n: u32, bits: u32) -> BigInt {
    let mut power_of_n = power(bits) / n;
    let (mut sum, mut k) = (BigInt::from(0), 0u32);
    while power_of_n.sign() != Sign::NoSign {
        let term = &power_of_n / (2 * k + 1);
        sum = if k % 2 == 0 { sum + term } else { sum - term };
        power_of_n /= n * n;
        k += 1;
    }
    sum
}

/// π with `bits` fraction bits, to the last of them: Machin, with 32 bits more while summing.
pub fn pi(bits: u32) -> BigInt {
    let wide = bits + 32;
    ((arctan_of_inverse(5, wide) * 16) - (arctan_of_inverse(239, wide) * 4)) >> 32u32
}

/// Integers of a signed type of `width` bits, of all magnitudes alike: lengths in bits are drawn uniformly, and every
/// third value is a power of two or its neighbour; the type's ends and the numbers next to zero are among them.
pub fn signed(width: u32) -> impl Strategy<Value = i128> {
    let least = i128::MIN >> (128 - width);
    let sized = (0..width, any::<u128>(), any::<bool>()).prop_map(|(length, raw, negative)| {
        let magnitude = if length == 0 { 0 } else { ((raw | 1 << 127) >> (128 - length)) as i128 };
        if negative { -magnitude } else { magnitude }
    });
    let edge = (0..width - 1, -1i128..=1, any::<bool>()).prop_map(|(exponent, by, negative)| {
        let value = (1i128 << exponent) + by;
        if negative { -value } else { value }
    });
    let ends = prop_oneof![Just(least), Just(-(least + 1)), Just(least + 1), Just(0), Just(1), Just(-1)];
    prop_oneof![6 => sized, 3 => edge, 1 => ends]
}

/// [`signed`] for `i64`.
pub fn any_i64() -> impl Strategy<Value = i64> {
    signed(64).prop_map(|value| value as i64)
}

/// Unsigned integers of all magnitudes alike, with the edges.
pub fn any_u128() -> impl Strategy<Value = u128> {
    let sized = (0..=128u32, any::<u128>()).prop_map(
        |(length, raw)| {
            if length == 0 { 0 } else { (raw | 1 << 127) >> (128 - length) }
        },
    );
    let edge = (0..128u32, -1i128..=1).prop_map(|(exponent, by)| (1u128 << exponent).wrapping_add_signed(by));
    prop_oneof![6 => sized, 3 => edge, 1 => prop_oneof![Just(0), Just(u128::MAX)]]
}

/// `cases` draws and no file beside the source.
pub fn draws(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}
