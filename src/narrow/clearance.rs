//! What is left of a gap that was measured before: a bound for a few products, where looking for a first touch costs as
//! many hundreds.
//!
//! Along a direction n that turns with r, the owner of the edge that it is the normal of, by θ since the gap was measured,
//! the gap changes by n·(D − D₀) + θ·Jn·D, by what the other outline turns against it, at most arm·|θ_o − θ_r|, and by
//! ½·θ²·|D|. Along a direction that does not turn both outlines take arm·|θ| of it. A second derivative bounds what lies
//! between the ends of a time.

use super::course::bound;
use super::difference;
use super::meeting::{Motion, NEAR};
use super::moment::{Axes, Moment, way};
use crate::num::{dot, mul};

/// 2π, Q60.
const TURN: i64 = 7_244_019_458_077_122_842;
/// The greatest turn that the bound is for: 1/8, Q40 radians.
const SMALL: i64 = 1 << 37;

/// Two outlines that were apart.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clearance {
    /// From a to b, Q30.
    normal: [i32; 2],
    /// How far apart they were along it, Q32 m; 0 if nothing is known.
    gap: i64,
    /// From a's centre to b's then, Q32 m, and the angles, Q48 turns.
    d: [i64; 2],
    angle: [i64; 2],
    /// How far from its centre each has what turning moves, Q32 m.
    arms: [i64; 2],
    /// With whom the direction turns: 0, 1, or 2 for nobody.
    owner: usize,
}

impl Clearance {
    /// What a moment shows along its widest axis, at these angles.
    pub(super) fn new(moment: &Moment, axes: &Axes, index: usize, angle: [i64; 2], arms: [i64; 2]) -> Clearance {
        let Some(axis) = moment.axis(axes, index) else { return Clearance::default() };
        let normal = if axis.owner == 0 { axis.normal } else { axis.normal.map(i32::wrapping_neg) };
        let owner = if axis.edge { axis.owner } else { 2 };
        Clearance { normal, gap: (axes.limits[index] >> 6).max(0), d: moment.d, angle, arms, owner }
    }

    /// Whether outlines that move so surely stay apart, and not only just, for the time 0 ..= until (Q32 of a tick).
    ///
    /// Rounding: all of it is far below the 2e-5 m that must be left, of which centres that are far apart want more.
    pub(crate) fn lasts(&self, motion: &Motion, until: i64) -> bool {
        let Motion { d, v, a, angle, omega, alpha } = motion;
        let near = NEAR >> 5;
        if self.gap <= near {
            return false;
        }
        let end = [0, 1].map(|axis: usize| d[axis].saturating_add(way(v[axis], a[axis], until, 40)));
        // An eighth of the acceleration is what a course bends at most between its ends.
        let bend = half(bound(*a), until) / 4;
        let far = bound(*d).max(bound(end)).saturating_add(bend);
        let turned = [0, 1].map(|body: usize| mul(angle[body].saturating_sub(self.angle[body]), TURN, 68));
        let along = |at: [i64; 2]| dot(difference(at, self.d), self.normal.map(i64::from), 30);
        let sway = |turned: i64, omega: i64, alpha: i64| {
            let [turned, omega, alpha] = [turned, omega, alpha].map(i64::saturating_abs);
            turned.saturating_add(way(omega, alpha, until, 32)).saturating_add(1)
        };
        let lost = |arm: i64, sway: i64| mul(arm, sway, 40).saturating_add(1);
        let left = self.gap.saturating_sub(bend).saturating_sub(far >> 28);
        if self.owner > 1 {
            let both = [0, 1].map(|body: usize| lost(self.arms[body], sway(turned[body], omega[body], alpha[body])));
            let left = left.saturating_add(along(*d).min(along(end)));
            return left.saturating_sub(both[0]).saturating_sub(both[1]) > near;
        }
        let [r, o] = [self.owner, 1 ^ self.owner];
        let most = sway(turned[r], omega[r], alpha[r]);
        if most > SMALL {
            return false;
        }
        let [against, spin, change] = [turned, *omega, *alpha].map(|of| of[o].saturating_sub(of[r]));
        let quarter = [self.normal[1].wrapping_neg(), self.normal[0]].map(i64::from);
        let turns = turned[r].saturating_add(way(omega[r], alpha[r], until, 32));
        let at = |place: [i64; 2], turn: i64| along(place).saturating_add(mul(turn, dot(place, quarter, 30), 40));
        let ends = at(*d, turned[r]).min(at(end, turns));
        // ½·θ²·|D| and a 16th more for what is of third order, and what ω·V and α·D bend.
        let square = mul(mul(most, most, 41), far, 40);
        let square = square.saturating_add(square >> 4);
        let speed = bound(*v).saturating_add(mul(bound(*a), until, 32));
        let spun = omega[r].saturating_abs().saturating_add(mul(alpha[r].saturating_abs(), until, 32));
        let drive = mul(spun, speed, 40).saturating_add(mul(alpha[r].saturating_abs(), far, 32));
        let left = left.saturating_sub(square).saturating_sub(half(drive, until));
        left.saturating_sub(lost(self.arms[o], sway(against, spin, change))).saturating_add(ends) > near
    }
}

/// ½·a·τ² of an acceleration in Q40 m per tick², Q32 m, rounded up.
fn half(a: i64, time: i64) -> i64 {
    mul(mul(a, time, 32), time, 41).saturating_add(1)
}
