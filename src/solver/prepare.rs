//! From a pair's manifold to its rows.

mod basis;
mod joints;
#[cfg(test)]
mod tests;

use super::mobility::Mobility;
use super::rows::{Block, Row};
use super::scales::Scales;
use crate::contact::{Contact, Pair};
use crate::narrow::Manifold;
use crate::num::{lane, mul};
pub(crate) use basis::Basis;
pub(super) use joints::Joints;

/// Two bodies with contact points, and what is the same for all their rows.
pub(crate) struct Joint<'p> {
    pair: &'p Pair,
    /// Places among the movers.
    places: [u32; 2],
    /// For each point, from a's centre to b's, Q32.
    between: [[i64; 2]; 2],
    mobility: [&'p Mobility; 2],
    /// p and p·τ of both, Q28.
    share: [i32; 2],
    inertia: [i64; 2],
    /// The normal, Q28.
    normal: [i32; 2],
}

/// One row's lever: α of both, p·τ·α of both, κ; Q28. Of a point that is not there, all zero.
#[derive(Default)]
struct Lever {
    arm: [i32; 2],
    turn: [i64; 2],
    kappa: i64,
}

impl<'p> Joint<'p> {
    #[inline(always)]
    pub(crate) fn new(pair: &'p Pair, places: [u32; 2], between: [[i64; 2]; 2], mobility: [&'p Mobility; 2]) -> Self {
        const ONE: i32 = 1 << 28;
        let first = mobility[0].share(mobility[1]);
        let second = if mobility[1].moves() { ONE.saturating_sub(first) } else { 0 };
        let share = [first, second];
        let inertia = [0, 1].map(|body| lane::scale(share[body], mobility[body].tau));
        let normal = pair.manifold.normal.map(|n| lane::round::<2>(n.into()) as i32);
        Joint { pair, places, between, mobility, share, inertia, normal }
    }

    /// α of both bodies along the normal and along the tangent (−n_y, n_x) at a point: r × n, and r × t = r·n. Of a point that
    /// is not there, zero.
    #[inline(always)]
    fn arms(&self, at: usize) -> [[i32; 2]; 2] {
        if at >= usize::from(self.pair.manifold.count) {
            return [[0; 2]; 2];
        }
        let ([along_a, across_a], [along_b, across_b]) = (self.arm(at, 0), self.arm(at, 1));
        [[along_a, along_b], [across_a, across_b]]
    }

    /// α of a body along both. Across a gap each body has the point on its own surface, where it will be when the gap has
    /// closed.
    #[inline(always)]
    fn arm(&self, at: usize, body: usize) -> [i32; 2] {
        const LIMIT: i64 = (8 << 28) - 1;
        if self.places[body] == 0 {
            return [0; 2];
        }
        let point = &self.pair.manifold.points[at];
        let half = point.separation.max(0) >> 1;
        let [out_x, out_y] = self.pair.manifold.normal.map(|n| mul(half, n.into(), 30));
        let [x, y] = point.arm;
        let r = if body == 0 {
            [x.saturating_add(out_x), y.saturating_add(out_y)]
        } else {
            let [far_x, far_y] = self.between[at];
            [x.saturating_sub(far_x).saturating_sub(out_x), y.saturating_sub(far_y).saturating_sub(out_y)]
        };
        let [x, y] = self.mobility[body].relative(r);
        let [nx, ny] = self.normal;
        let along = lane::round::<28>(lane::sub(lane::mul(x, ny), lane::mul(y, nx)));
        let across = lane::round::<28>(lane::add(lane::mul(x, nx), lane::mul(y, ny)));
        [lane::clamp(along, -LIMIT, LIMIT) as i32, lane::clamp(across, -LIMIT, LIMIT) as i32]
    }

    /// The lever of a row of a point, from its arms; of one that is not there, zero.
    #[inline(always)]
    fn lever(&self, at: usize, arm: [i32; 2]) -> Lever {
        if at >= usize::from(self.pair.manifold.count) {
            return Lever::default();
        }
        let turn = [lane::scale(arm[0], self.inertia[0]), lane::scale(arm[1], self.inertia[1])];
        let kappa = lane::add(lane::scale(arm[0], turn[0]), lane::scale(arm[1], turn[1]));
        Lever { arm, turn, kappa: lane::add(1 << 28, kappa) }
    }

    /// Writes the contact into a lane of a block. `old` is the pair's contact of the last tick, or an empty one.
    // Once: where it is copied into its callers, its own parts are no longer put into it.
    #[inline(never)]
    pub(crate) fn write(&self, block: &mut Block, i: usize, old: &Contact, friction: i64, scales: &Scales) {
        for axis in 0..2 {
            block.bodies[axis][i] = self.places[axis];
            block.normal[axis][i] = self.normal[axis];
            let part = |body: usize| lane::round::<28>(lane::mul(self.share[body], self.normal[axis])) as i32;
            (block.reply[0][axis][i], block.reply[1][axis][i]) = (part(0), part(1).saturating_neg());
        }
        let [first, second] = [self.arms(0), self.arms(1)];
        let [one, other] = &self.pair.manifold.points;
        let lower_is_second = self.pair.manifold.count > 1 && other.separation < one.separation;
        let tangent = self.lever(0, if lower_is_second { second[1] } else { first[1] });
        let known = [0, 1].map(|at| known(&self.pair.manifold, at, old));
        self.write_point(block, i, 0, &self.lever(0, first[0]), known[0].map(|k| old.normal[k]));
        self.write_point(block, i, 1, &self.lever(1, second[0]), known[1].map(|k| old.normal[k]));
        for at in 0..2 {
            let ratio = lane::scale(block.points[at].line[i], tangent.kappa);
            block.limit[at][i] = mul(ratio, friction, 48).min(i32::MAX.into()) as i32;
            block.separation[at][i] = self.separation(at, scales);
        }
        block.friction.put(i, &tangent, if known == [None; 2] { 0 } else { old.tangent });
        block.couple[0][i] = block.friction.turns(i, first[0]);
        block.couple[1][i] = block.friction.turns(i, second[0]);
        block.couple[2][i] = block.points[0].turns(i, second[0]);
    }

    /// A point's row, and what its load is known to have been.
    #[inline(always)]
    fn write_point(&self, block: &mut Block, i: usize, at: usize, lever: &Lever, load: Option<i64>) {
        block.points[at].put(i, lever, load.unwrap_or(0));
        // Warm starting has pushed already, and friction may outlast it by a substep.
        block.peak[at][i] = block.points[at].impulse[i];
    }

    /// Q26; of a point that is not there, what never closes.
    #[inline(always)]
    fn separation(&self, at: usize, scales: &Scales) -> i32 {
        if at >= usize::from(self.pair.manifold.count) {
            return i32::MAX;
        }
        let shift = scales.shift.saturating_add(6) as i32;
        lane::limit(lane::shifted(self.pair.manifold.points[at].separation, shift))
    }
}

/// Which of the points of the last tick's contact a point is.
#[inline(always)]
fn known(manifold: &Manifold, at: usize, old: &Contact) -> Option<usize> {
    let there = at < usize::from(manifold.count);
    let id = manifold.points[at].id;
    if there && old.count > 0 && old.ids[0] == id {
        Some(0)
    } else if there && old.count > 1 && old.ids[1] == id {
        Some(1)
    } else {
        None
    }
}

impl Row {
    /// Takes a lever, and the impulse λ̂ = κ·(λ·S) that the last tick left.
    #[inline(always)]
    fn put(&mut self, i: usize, lever: &Lever, start: i64) {
        // κ is at least 2²⁸, or 0.
        let line = (1i64 << 56).saturating_add(lever.kappa >> 1).checked_div(lever.kappa).unwrap_or(0) as i32;
        self.line[i] = line;
        for body in 0..2 {
            self.arm[body][i] = lever.arm[body];
            self.turn[body][i] = lane::scale(line, lever.turn[body]) as i32;
        }
        self.impulse[i] = 0;
        if start != 0 {
            self.impulse[i] = mul(start, lever.kappa, 56).clamp(-(1 << 29), 1 << 29) as i32;
        }
    }

    /// What an impulse of this row adds by turning to the speed of a row with other arms, Q27. Limited to 11, which bodies
    /// of even density stay far below: beyond, a row learns of the rest in the next sweep, from w.
    #[inline(always)]
    fn turns(&self, i: usize, arm: [i32; 2]) -> i32 {
        const LIMIT: i64 = 11 << 27;
        let part = |body: usize| lane::mul(self.turn[body][i], arm[body]);
        lane::clamp(lane::round::<29>(lane::add(part(0), part(1))), -LIMIT, LIMIT) as i32
    }

    /// λ·S, exactly: the product of λ̂ and 1/κ.
    pub(crate) fn carried(&self, i: usize) -> i64 {
        lane::mul(self.impulse[i], self.line[i])
    }
}
