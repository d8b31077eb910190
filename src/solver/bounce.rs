//! Impacts: after the substeps, points that hit fast enough leave with C_R times the speed with which they came.
//!
//! Both points of a contact are answered together, so that a box that lands flat bounces, or rests, without spin. Wide
//! arithmetic: impacts are few.

use super::mover::Mover;
use crate::num::{clamp_i64, div, lane, mul, round_shift};

/// A contact whose bodies approach when the tick begins.
///
/// | field | format |
/// |---|---|
/// | `normal` | Q30, from b to a |
/// | `share`, `inertia` | p and p·τ of a and b, Q28 |
/// | `arm` | α_a and α_b of each point, Q28 |
/// | `speed` | of the faster point, Q48 m/s over 2^k, negative |
/// | `target` | the speed with which each point is to separate, Q48 |
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounce {
    /// The contact's place in the order of those with rows.
    pub(crate) row: u32,
    pub(crate) bodies: [u32; 2],
    pub(crate) normal: [i32; 2],
    pub(crate) share: [i32; 2],
    pub(crate) inertia: [i64; 2],
    pub(crate) arm: [[i32; 2]; 2],
    pub(crate) speed: i64,
    pub(crate) target: [i64; 2],
    /// Whether each point's own way in this tick closes its gap: then it takes part even if the other one's row stopped it.
    pub(crate) reaches: [bool; 2],
    /// C_R is 1.
    pub(crate) elastic: bool,
}

/// The relative velocity of two bodies along a normal (Q30) at arms α (Q28), Q48.
pub(crate) fn approach(a: &Mover, b: &Mover, normal: [i32; 2], arm: [i32; 2]) -> i64 {
    let between = |axis: usize| i128::from(a.v[axis]).saturating_sub(b.v[axis].into());
    let along = |axis: usize| between(axis).saturating_mul(normal[axis].into());
    let line = round_shift(along(0).saturating_add(along(1)), 30) as i64;
    line.saturating_add(lane::scale(arm[0], a.w)).saturating_sub(lane::scale(arm[1], b.w))
}

impl Bounce {
    /// Lets the contact bounce. `spent`: what pushed each point in this tick at most, as λ·S, Q48; 0 for a point that
    /// nothing pushed. As much may be taken back: over the tick a point never pulls.
    pub(crate) fn solve(&self, movers: &mut [Mover], spent: [i64; 2]) {
        let (a, b) = (movers[self.bodies[0] as usize], movers[self.bodies[1] as usize]);
        let want = |i: usize| self.target[i].saturating_sub(approach(&a, &b, self.normal, self.arm[i]));
        // κ of the points and of one on the other, Q28: v_i changes by K_ij·μ_j of the impulses μ = λ·S.
        let k = |i: usize, j: usize| {
            let part = |body: usize| lane::scale(self.arm[j][body], lane::scale(self.arm[i][body], self.inertia[body]));
            (1i64 << 28).saturating_add(part(0)).saturating_add(part(1))
        };
        let alone =
            |i: usize, b: i64| clamp_i64(div(i128::from(b) << 28, k(i, i).into())).max(spent[i].saturating_neg());
        let pushed = [0, 1].map(|i| spent[i] > 0 || self.reaches[i]);
        let impulse = match pushed {
            [true, true] => self.both([want(0), want(1)], [k(0, 0), k(0, 1), k(1, 1)], spent, alone),
            [true, false] => [alone(0, want(0)), 0],
            [false, true] => [0, alone(1, want(1))],
            [false, false] => return,
        };
        self.apply(movers, impulse);
    }

    /// The impulses that give both points their speed; where one would have to pull, it takes back what it can and the
    /// other gets its speed.
    fn both(&self, b: [i64; 2], k: [i64; 3], spent: [i64; 2], alone: impl Fn(usize, i64) -> i64) -> [i64; 2] {
        let product = |x: i64, y: i64| i128::from(x).saturating_mul(y.into());
        let determinant = product(k[0], k[2]).saturating_sub(product(k[1], k[1]));
        let deeper = usize::from(b[1] > b[0]);
        if determinant <= product(k[0], k[2]) >> 30 {
            let mut impulse = [0; 2];
            impulse[deeper] = alone(deeper, b[deeper]);
            return impulse;
        }
        let over = |n: i128| clamp_i64(crate::num::mul_div(n, 1 << 28, determinant));
        let x = [
            over(product(k[2], b[0]).saturating_sub(product(k[1], b[1]))),
            over(product(k[0], b[1]).saturating_sub(product(k[1], b[0]))),
        ];
        let pulls = |i: usize| x[i] < spent[i].saturating_neg();
        match [pulls(0), pulls(1)] {
            [false, false] => x,
            [first, _] => {
                let (held, free) = if first { (0, 1) } else { (1, 0) };
                let mut impulse = [0; 2];
                impulse[held] = spent[held].saturating_neg();
                impulse[free] = alone(free, b[free].saturating_sub(mul(k[1], impulse[held], 28)));
                impulse
            }
        }
    }

    fn apply(&self, movers: &mut [Mover], impulse: [i64; 2]) {
        let sum = impulse[0].saturating_add(impulse[1]);
        let world = self.normal.map(|n| mul(sum, n.into(), 30));
        for (body, sign) in [(0, 1), (1, -1i64)] {
            let mover = &mut movers[self.bodies[body] as usize];
            let signed = |v: i64| v.saturating_mul(sign);
            for (v, j) in mover.v.iter_mut().zip(world) {
                *v = lane::bounded(v.saturating_add(signed(mul(j, self.share[body].into(), 28))));
            }
            for (arm, j) in self.arm.iter().zip(impulse) {
                let turned = mul(lane::scale(arm[body], self.inertia[body]), j, 28);
                mover.w = lane::bounded(mover.w.saturating_add(signed(turned)));
            }
        }
    }
}
