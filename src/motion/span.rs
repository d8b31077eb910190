//! Lengths of time, as multipliers with 63 fraction bits.

use crate::num::div;

/// 1/2π with 64 fraction bits.
const TURN_PER_RADIAN_Q64: i128 = 2_935_890_503_282_001_226;

/// A length of time T = 1/n s, exact up to 2⁻⁶⁴ in each multiplier.
///
/// | field | meaning | bound for n ≥ 15 |
/// |---|---|---|
/// | `line` | T, for v·T | 2⁶³/15 |
/// | `line2` | T², for a·T² | 2⁶³/225 |
/// | `turn` | T/2π: rad/s to turns | 2⁶³/94 |
/// | `turn2` | T²/2π | 2⁶³/1413 |
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Span {
    pub(crate) line: i64,
    pub(crate) line2: i64,
    pub(crate) turn: i64,
    pub(crate) turn2: i64,
    pub(crate) per_second: i64,
}

impl Span {
    /// A span of 1/`per_second` s, for 15 ≤ `per_second` < 2³¹.
    pub(crate) const fn new(per_second: u32) -> Span {
        debug_assert!(per_second >= 15, "the tick rate is at least 15");
        let n = per_second as i128;
        let n2 = n.saturating_mul(n);
        Span {
            line: div(1 << 63, n) as i64,
            line2: div(1 << 63, n2) as i64,
            turn: div(TURN_PER_RADIAN_Q64, n.saturating_mul(2)) as i64,
            turn2: div(TURN_PER_RADIAN_Q64, n2.saturating_mul(2)) as i64,
            per_second: per_second as i64,
        }
    }
}
