//! Lengths of time, as multipliers with 63 fraction bits.

use crate::num::{TURN_PER_RADIAN_Q64, div, mul};

/// A length of time T = w/n s; negative for a step back within a composed scheme.
///
/// | field | meaning | bound for n ≥ 15, |w| < 1.5 |
/// |---|---|---|
/// | `line` | T, for v·T | 2⁶³/10 |
/// | `turn` | T/2π: rad/s to turns | 2⁶³/62 |
///
/// Error: 2⁻⁶³ s in each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Span {
    pub(crate) line: i64,
    pub(crate) turn: i64,
}

crate::store::show!(Span { line, turn });

/// The fraction bits of a part of a span.
const PART_FRAC: u32 = 62;

impl Span {
    /// A span of 1/`per_second` s, for 15 ≤ `per_second` < 2³¹.
    pub(crate) const fn new(per_second: u32) -> Span {
        debug_assert!(per_second >= 15, "the tick rate is at least 15");
        let n = per_second as i128;
        Span { line: div(1 << 63, n) as i64, turn: div(TURN_PER_RADIAN_Q64, n.saturating_mul(2)) as i64 }
    }

    /// The part `part`/2⁶² of the span.
    pub(crate) const fn part(self, part: i64) -> Span {
        Span { line: mul(self.line, part, PART_FRAC), turn: mul(self.turn, part, PART_FRAC) }
    }

    /// T² and T²/2π, for the ways a·T² and α·T².
    pub(crate) const fn squared(self) -> Span {
        Span { line: mul(self.line, self.line, 63), turn: mul(self.turn, self.line, 63) }
    }
}
