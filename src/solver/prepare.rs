//! From a pair's manifold to its rows.

use super::bounce::{Bounce, approach};
use super::mobility::Mobility;
use super::mover::Mover;
use super::rows::{Block, Row};
use super::scales::Scales;
use crate::contact::{Contact, Pair};
use crate::num::{clamp_i64, lane, mul, round_shift};

/// Two bodies with contact points, and what is the same for all their rows.
pub(crate) struct Joint<'p> {
    pair: &'p Pair,
    /// Places among the movers.
    places: [u32; 2],
    /// From a's centre to b's, Q32.
    between: [i64; 2],
    mobility: [&'p Mobility; 2],
    /// p and p·τ of both, Q28.
    share: [i32; 2],
    inertia: [i64; 2],
    /// The normal, Q28.
    normal: [i32; 2],
}

/// One row's lever: α of both, p·τ·α of both, κ; Q28.
struct Lever {
    arm: [i32; 2],
    turn: [i64; 2],
    kappa: i64,
}

impl<'p> Joint<'p> {
    pub(crate) fn new(pair: &'p Pair, places: [u32; 2], between: [i64; 2], mobility: [&'p Mobility; 2]) -> Self {
        const ONE: i32 = 1 << 28;
        let first = mobility[0].share(mobility[1]);
        let second = if mobility[1].moves() { ONE.saturating_sub(first) } else { 0 };
        let share = [first, second];
        let inertia = [0, 1].map(|body| lane::scale(share[body], mobility[body].tau));
        let normal = pair.manifold.normal.map(|n| lane::round::<2>(n.into()) as i32);
        Joint { pair, places, between, mobility, share, inertia, normal }
    }

    /// α of both bodies along the normal and along the tangent (−n_y, n_x) at a point: r × n, and r × t = r·n.
    fn arms(&self, arm: [i64; 2]) -> [[i32; 2]; 2] {
        let arm_b = [arm[0].saturating_sub(self.between[0]), arm[1].saturating_sub(self.between[1])];
        let [nx, ny] = self.normal;
        let [a, b] = [arm, arm_b].map(|_| [0; 2]);
        let mut arms = [a, b];
        for (body, r) in [(0, arm), (1, arm_b)] {
            if self.places[body] == 0 {
                continue;
            }
            let [x, y] = self.mobility[body].relative(r);
            arms[0][body] = lane::round::<28>(lane::sub(lane::mul(x, ny), lane::mul(y, nx))) as i32;
            arms[1][body] = lane::round::<28>(lane::add(lane::mul(x, nx), lane::mul(y, ny))) as i32;
        }
        arms
    }

    fn lever(&self, arm: [i32; 2]) -> Lever {
        let turn = [lane::scale(arm[0], self.inertia[0]), lane::scale(arm[1], self.inertia[1])];
        let kappa = lane::add(lane::scale(arm[0], turn[0]), lane::scale(arm[1], turn[1]));
        Lever { arm, turn, kappa: lane::add(1 << 28, kappa) }
    }

    /// Writes the contact into a lane of a block. `old` is the pair's contact of the last tick, or an empty one.
    pub(crate) fn write(&self, block: &mut Block, i: usize, old: &Contact, friction: i64, scales: &Scales) {
        for axis in 0..2 {
            block.bodies[axis][i] = self.places[axis];
            block.normal[axis][i] = self.normal[axis];
            let part = |body: usize| lane::round::<28>(lane::mul(self.share[body], self.normal[axis])) as i32;
            (block.reply[0][axis][i], block.reply[1][axis][i]) = (part(0), part(1).saturating_neg());
        }
        let manifold = &self.pair.manifold;
        for (at, point) in manifold.points[..manifold.count as usize].iter().enumerate() {
            let [normal, tangent] = self.arms(point.arm).map(|arm| self.lever(arm));
            let known = (0..old.count as usize).find(|&k| old.ids[k] == point.id);
            let [normal_start, tangent_start] = known.map_or([0; 2], |k| [old.normal[k], old.tangent[k]]);
            let rows = &mut block.points[at];
            let line = rows.normal.put(i, &normal, normal_start);
            rows.tangent.put(i, &tangent, tangent_start);
            let ratio = lane::scale(line, tangent.kappa);
            rows.friction[i] = mul(ratio, friction, 48).min(i32::MAX.into()) as i32;
            let depth = round_shift(point.separation.into(), scales.shift.saturating_add(6));
            rows.separation[i] = depth.clamp(-(1 << 30), 1 << 30) as i32;
            rows.peak[i] = 0;
        }
    }

    /// How the contact is to bounce with this restitution (Q48), if it approaches.
    pub(crate) fn bounce(&self, row: u32, movers: &[Mover], restitution: i64, scales: &Scales) -> Option<Bounce> {
        let [a, b] = self.places.map(|place| &movers[place as usize]);
        // No point is faster than this; nothing slower than 1 mm/s bounces.
        let reach = |m: &Mover| m.w.saturating_abs().saturating_mul(8);
        let between = |axis: usize| a.v[axis].saturating_sub(b.v[axis]).saturating_abs();
        let fastest = [between(0), between(1), reach(a), reach(b)].into_iter().fold(0, i64::saturating_add);
        if fastest < 1 << 38 {
            return None;
        }
        let manifold = &self.pair.manifold;
        let (bodies, share, inertia) = (self.places, self.share, self.inertia);
        let mut bounce = Bounce { row, bodies, normal: manifold.normal, share, inertia, ..Bounce::default() };
        for (at, point) in manifold.points[..manifold.count as usize].iter().enumerate() {
            let [arm, _] = self.arms(point.arm);
            let speed = approach(a, b, manifold.normal, arm);
            bounce.arm[at] = arm;
            bounce.speed = bounce.speed.min(speed);
            // A substep's way more, so that two corners of a box that lands flat are in it together.
            let way = mul(speed, scales.margins.tick.saturating_add(scales.line), 48 + 63 - 32);
            let gap = round_shift(point.separation.into(), scales.shift) as i64;
            bounce.reaches[at] = speed < 0 && gap.saturating_add(way) <= 0;
            bounce.target[at] = mul(speed.min(0).saturating_neg(), restitution, 48);
        }
        bounce.elastic = restitution == 1 << 48;
        (bounce.speed < 0).then_some(bounce)
    }
}

impl Row {
    /// Takes a lever, and the impulse λ̂ = κ·(λ·S) that the last tick left. 1/κ.
    fn put(&mut self, i: usize, lever: &Lever, start: i64) -> i32 {
        // κ is at least 2²⁸.
        let line = (1i64 << 56).saturating_add(lever.kappa >> 1).checked_div(lever.kappa).unwrap_or(0) as i32;
        self.line[i] = line;
        for body in 0..2 {
            self.arm[body][i] = lever.arm[body];
            self.turn[body][i] = lane::scale(line, lever.turn[body]) as i32;
        }
        self.impulse[i] = 0;
        if start != 0 {
            let impulse = round_shift(i128::from(start).saturating_mul(lever.kappa.into()), 56);
            self.impulse[i] = clamp_i64(impulse).clamp(-(1 << 29), 1 << 29) as i32;
        }
        line
    }

    /// λ·S, exactly: the product of λ̂ and 1/κ.
    pub(crate) fn carried(&self, i: usize) -> i64 {
        lane::mul(self.impulse[i], self.line[i])
    }
}
