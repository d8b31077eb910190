//! Exact decimal text: every fixed-point number has a finite decimal expansion, and it is what we print.

use core::fmt;

/// The longest decimal text that is read, in bytes: more digits than any quantity's exact expansion has.
pub const MAX_TEXT: usize = 256;
/// The greatest decimal exponent that is read, in magnitude.
pub const MAX_EXPONENT: u32 = 99;

/// A number for messages and tables: `bits / 2^frac`, printed exactly.
///
/// ```
/// use tamias2d::num::Decimal;
/// assert_eq!(Decimal { bits: -3, frac: 2 }.to_string(), "-0.75");
/// assert_eq!(format!("{:.1}", Decimal { bits: 1, frac: 2 }), "0.3");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decimal {
    /// The value's bits.
    pub bits: i128,
    /// How many of the bits are fraction, at most 64.
    pub frac: u32,
}

impl fmt::Display for Decimal {
    /// Without a precision, all digits; with one, rounded to it (ties away from zero).
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let frac = self.frac.min(64);
        let mask = (1u128 << frac) - 1;
        let magnitude = self.bits.unsigned_abs();
        let (mut whole, mut rest) = (magnitude >> frac, magnitude & mask);
        let mut digits = [0u8; 64];
        let mut count = 0;
        let wanted = f.precision().unwrap_or(64).min(64);
        while count < wanted && (rest != 0 || f.precision().is_some()) {
            rest *= 10;
            digits[count] = (rest >> frac) as u8;
            rest &= mask;
            count += 1;
        }
        if frac > 0 && rest >> (frac - 1) != 0 {
            // Round the printed digits up, carrying into the whole part.
            let mut at = count;
            loop {
                if at == 0 {
                    whole += 1;
                    break;
                }
                at -= 1;
                digits[at] += 1;
                if digits[at] < 10 {
                    break;
                }
                digits[at] = 0;
            }
        }
        let printed = &digits[..count];
        let zero = whole == 0 && printed.iter().all(|&digit| digit == 0);
        if self.bits < 0 && !zero {
            f.write_str("-")?;
        }
        write!(f, "{whole}")?;
        if !printed.is_empty() {
            f.write_str(".")?;
            for digit in printed {
                write!(f, "{digit}")?;
            }
        }
        Ok(())
    }
}

/// Whether `text` is a decimal number whose size is bounded: `-?digits[.digits][(e|E)[+-]digits]`, at most
/// [`MAX_TEXT`] bytes and an exponent of at most ±[`MAX_EXPONENT`]. Nothing is computed before this holds.
pub(super) fn is_bounded(text: &str) -> bool {
    let bytes = text.as_bytes();
    if bytes.len() > MAX_TEXT {
        return false;
    }
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(bytes.first() == Some(&b'-'));
    let whole = digits(at);
    at += whole;
    if whole == 0 {
        return false;
    }
    if bytes.get(at) == Some(&b'.') {
        let fraction = digits(at + 1);
        if fraction == 0 {
            return false;
        }
        at += 1 + fraction;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        at += 1;
        at += usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
        let exponent = digits(at);
        let value =
            bytes[at..at + exponent].iter().fold(0u32, |v, b| v.saturating_mul(10).saturating_add((b - b'0').into()));
        if exponent == 0 || value > MAX_EXPONENT {
            return false;
        }
        at += exponent;
    }
    at == bytes.len()
}
