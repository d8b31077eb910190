//! Linear drag, integrated exactly: v' = a − c·v has v(T) = v·e^(−y) + a·T·φ₁(y) and
//! x(T) = x + v·T·φ₁(y) + a·T²·φ₂(y) with y = c·T, φ₁ = (1 − e^(−y))/y, φ₂ = (1 − φ₁)/y. Without drag
//! e^(−y) = φ₁ = 1 and φ₂ = ½, which is the undamped step.

use crate::num::{Damping, div, mul, round_shift};

/// Fraction bits of the factors.
const Q: u32 = 62;
const ONE: i128 = 1 << Q;

/// What drag at one rate does over one span: factors in [0, 1] with 62 fraction bits.
///
/// Error: below 2⁻⁵⁸ in each, measured by the tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Decay {
    pub(crate) exp: i64,
    pub(crate) phi1: i64,
    pub(crate) phi2: i64,
}

crate::store::show!(Decay { exp, phi1, phi2 });

impl Decay {
    /// No drag.
    pub(crate) const NONE: Decay = Decay { exp: 1 << Q, phi1: 1 << Q, phi2: 1 << (Q - 1) };

    /// Drag at the rate `damping` over 1/`per_second` s.
    pub(crate) fn new(damping: Damping, per_second: u32) -> Decay {
        if damping == Damping::ZERO {
            return Decay::NONE;
        }
        // y with 48 + 14 fraction bits; at most 1000/15 < 2^7, so 69 bits.
        let y = div(i128::from(damping.to_bits()) << 14, per_second.into());
        let halvings = (0..8).find(|k| (y >> k) < ONE).unwrap_or(8);
        let small = round_shift(y, halvings) as i64;

        // φ₂ = ½(1 − y/3(1 − y/4(…(1 − y/24)))): no cancellation for y ≤ 1, first term left out 2/24! < 2⁻⁷⁸.
        let mut phi2 = ONE as i64;
        for k in (3..=24).rev() {
            let term = div(mul(small, phi2, Q).into(), k) as i64;
            phi2 = (ONE as i64).saturating_sub(term);
        }
        phi2 >>= 1;
        let mut phi1 = (ONE as i64).saturating_sub(mul(small, phi2, Q));
        let mut exp = (ONE as i64).saturating_sub(mul(small, phi1, Q));
        if halvings > 0 {
            for _ in 0..halvings {
                exp = mul(exp, exp, Q);
            }
            // y > ½ here: dividing by it loses one bit.
            phi1 = div(ONE.saturating_sub(exp.into()) << Q, y) as i64;
            phi2 = div(ONE.saturating_sub(phi1.into()) << Q, y) as i64;
        }
        Decay { exp, phi1, phi2 }
    }

    /// `multiplier·φ₁` and `multiplier2·φ₂`.
    pub(crate) fn scale(&self, multiplier: i64, multiplier2: i64) -> (i64, i64) {
        (mul(multiplier, self.phi1, Q), mul(multiplier2, self.phi2, Q))
    }

    /// v·e^(−y).
    #[inline]
    pub(crate) fn slow(&self, velocity: i64) -> i64 {
        mul(velocity, self.exp, Q)
    }
}
