//! How a body yields to impulses, without a reciprocal of mass or inertia: derived by commands.
//!
//! A row carries λ̂ = k·λ in m/s instead of the impulse λ, where k = 1/m_a + 1/m_b + a_a²/I_a + a_b²/I_b, and a body carries
//! w = σ·ω in m/s with a length σ of its own. With S = 1/m_a + 1/m_b, p = (1/m)/S, α = a/σ and τ = σ²·m/I, everything is a
//! ratio: κ = k/S = 1 + p_a·τ_a·α_a² + p_b·τ_b·α_b², a body's velocity changes by p·d·(λ̂/κ) and its w by p·τ·α·(λ̂/κ). So any
//! mass and size fits 32 bits, and only ratios of masses matter.

use super::scales::SPEED_MAX;
use super::strike::Weight;
use crate::body::{BodyData, BodyKind, gyration};
use crate::num::{div, lane, mul_div, round_shift};

/// The σ of a body, its τ, and its mass as a ratio's part.
///
/// | field | format | bound |
/// |---|---|---|
/// | `mantissa`, `exponent` | mass = mantissa·2^exponent Q64 kg, 34 bits | 0 for what impulses do not move |
/// | `sigma` | Q32 m | between reach/7.9 and reach, so that α ≤ 7.9 |
/// | `tau`, `tau_fine` | Q28, Q48 | below (120/7.9)² = 231 |
/// | `inverse`, `inverse_shift` | 2^shift/σ, 62 bits | – |
/// | `scale`, `scale_shift` | 2⁵⁸ over σ brought to 2²⁸ … 2²⁹ by a shift right, 30 bits | – |
/// | `reach` | Q32 m | – |
/// | `spin` | Q48 m/s | 400 m/s |
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Mobility {
    mantissa: i64,
    exponent: u32,
    pub(crate) sigma: i64,
    pub(crate) tau: i64,
    /// τ with 48 fraction bits.
    pub(crate) tau_fine: i64,
    inverse: i64,
    inverse_shift: u32,
    pub(super) scale: i64,
    pub(super) scale_shift: i32,
    pub(crate) reach: i64,
    /// How fast w may be so that no point of it turns faster than what is bound for speeds.
    pub(crate) spin: i64,
    /// Whether its velocities are always zero: its body is static.
    pub(crate) fixed: bool,
}

crate::store::show!(Mobility {
    mantissa,
    exponent,
    sigma,
    tau,
    tau_fine,
    inverse,
    inverse_shift,
    scale,
    scale_shift,
    reach,
    spin,
    fixed,
});

const MANTISSA_BITS: u32 = 34;

impl Mobility {
    pub(crate) fn new(data: &BodyData) -> Mobility {
        let reach = data.reach.to_bits();
        let fixed = data.kind == BodyKind::Static;
        if reach == 0 {
            return Mobility { fixed, ..Mobility::default() };
        }
        let rho = gyration(data.mass, data.inertia).min(i64::MAX as u64) as i64;
        // 7.9 = 79/10, rounded up so that α stays below it.
        let least = reach.saturating_mul(10).saturating_add(78) / 79;
        let sigma = if data.fixed_rotation { reach } else { rho.max(least).min(reach).max(1) };
        let (mut mantissa, mut exponent, mut tau_fine) = (0, 0, 0);
        if data.is_dynamic() {
            let mass = data.mass.to_bits();
            exponent = (128u32).saturating_sub(mass.leading_zeros()).saturating_sub(MANTISSA_BITS);
            mantissa = round_shift(mass, exponent) as i64;
            if !data.fixed_rotation {
                let square = i128::from(sigma).saturating_mul(sigma.into());
                // Q64 m² times Q64 over Q64.
                tau_fine = (mul_div(square, mass, data.inertia.to_bits()) >> 16) as i64;
            }
        }
        let tau = tau_fine >> 20;
        let inverse_shift = 62u32.saturating_add(sigma.ilog2());
        let inverse = div(1 << inverse_shift, sigma.into()) as i64;
        let scale_shift = (sigma.ilog2() as i32).saturating_sub(28);
        let scale = div(1 << 58, lane::shifted(sigma, scale_shift).into()) as i64;
        let spin = div(i128::from(sigma).saturating_mul(SPEED_MAX.into()) << 48, reach.into()) as i64;
        Mobility {
            mantissa,
            exponent,
            sigma,
            tau,
            tau_fine,
            inverse,
            inverse_shift,
            scale,
            scale_shift,
            reach,
            spin,
            fixed,
        }
    }

    /// What its speeds weigh: w² as much as ω²·I/(m·σ²) = w²/τ.
    pub(crate) fn weight(&self) -> Weight {
        let turning = if self.tau_fine > 0 { div(1 << 96, self.tau_fine.into()) } else { 0 };
        Weight { mantissa: self.mantissa, exponent: self.exponent, turning }
    }

    /// 1/m as a ratio's part: `w·2^-shift`, `w` of 49 bits; 0 of what impulses do not move.
    pub(crate) fn inverse_mass(&self) -> (i64, u32) {
        if self.moves() { (div(1 << 82, self.mantissa.into()) as i64, self.exponent) } else { (0, 0) }
    }

    /// Whether impulses move it.
    pub(crate) fn moves(&self) -> bool {
        self.mantissa != 0
    }

    /// The part p of the first of two bodies, Q28: that of the other is 2²⁸ minus it. At least one must move.
    pub(crate) fn share(&self, other: &Mobility) -> i32 {
        const ONE: i64 = 1 << 28;
        match (self.moves(), other.moves()) {
            (true, false) => ONE as i32,
            (false, _) => 0,
            (true, true) => {
                // p = m_b/(m_a + m_b), of mantissas brought to the greater exponent.
                let top = self.exponent.max(other.exponent);
                let part = |m: &Mobility| m.mantissa >> (top.saturating_sub(m.exponent)).min(63);
                let (a, b) = (part(self), part(other));
                if a == b {
                    return (ONE >> 1) as i32;
                }
                let sum = a.saturating_add(b);
                // 2³⁵ · 2²⁸ fits.
                b.saturating_mul(ONE).saturating_add(sum >> 1).checked_div(sum).unwrap_or(0) as i32
            }
        }
    }

    /// The part p of the first of two bodies, Q48, from their masses to 34 bits; 0 if it does not move.
    pub(crate) fn part(&self, other: &Mobility) -> i64 {
        const ONE: i64 = 1 << 48;
        if !self.moves() || !other.moves() {
            return if self.moves() { ONE } else { 0 };
        }
        let top = self.exponent.max(other.exponent);
        // At most 2³⁴, brought to 2⁷⁶ by 48 bits of the quotient: below 2¹²⁴ with 48 more for the lesser exponent.
        let mass = |m: &Mobility| (i128::from(m.mantissa) << 40) >> top.saturating_sub(m.exponent).min(100);
        let (a, b) = (mass(self), mass(other));
        div(b << 48, a.saturating_add(b)) as i64
    }

    /// An arm over σ, Q28, from an arm in Q32 m: below 8 in magnitude. Error: 2⁻²⁸.
    #[inline]
    pub(crate) fn relative(&self, arm: [i64; 2]) -> [i32; 2] {
        const LIMIT: i64 = (8 << 28) - 1;
        // The middle of a gap may be farther from a tiny body than its arms are counted. At most 8·2²⁹, times 2³⁰.
        let most = self.sigma << 3;
        arm.map(|r| {
            let r = lane::shifted(lane::clamp(r, most.saturating_neg(), most), self.scale_shift);
            lane::clamp(lane::round::<30>(r.saturating_mul(self.scale)), -LIMIT, LIMIT) as i32
        })
    }

    /// A length over σ: `value / 2^from` m as a number with `to` fraction bits, for |value| < 2⁶³.
    pub(crate) fn over_sigma(&self, value: i64, from: u32, to: u32) -> i64 {
        // value·2^-from·2^32/σ, and 2^32/σ = inverse·2^(32 − inverse_shift).
        let product = i128::from(value).saturating_mul(self.inverse.into());
        let shift = self.inverse_shift.saturating_add(from).saturating_sub(to).saturating_sub(32);
        crate::num::clamp_i64(round_shift(product, shift))
    }
}
