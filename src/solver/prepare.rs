//! From a pair's manifold to its rows.

use super::mobility::Mobility;
use super::rows::{Block, Row};
use super::scales::Scales;
use crate::contact::{Contact, Pair};
use crate::narrow::Point;
use crate::num::{lane, mul};

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

    /// α of both bodies along the normal and along the tangent (−n_y, n_x) at a point: r × n, and r × t = r·n. Across a
    /// gap each body has the point on its own surface, where it will be when the gap has closed.
    #[inline(always)]
    fn arms(&self, at: usize, point: &Point) -> [[i32; 2]; 2] {
        const LIMIT: i64 = (8 << 28) - 1;
        let half = point.separation.max(0) >> 1;
        let out = self.pair.manifold.normal.map(|n| mul(half, n.into(), 30));
        let [nx, ny] = self.normal;
        let mut arms = [[0; 2]; 2];
        for (body, place) in self.places.into_iter().enumerate() {
            if place == 0 {
                continue;
            }
            let r = [0, 1].map(|axis: usize| match body {
                0 => point.arm[axis].saturating_add(out[axis]),
                _ => point.arm[axis].saturating_sub(self.between[at][axis]).saturating_sub(out[axis]),
            });
            let [x, y] = self.mobility[body].relative(r);
            let along = lane::round::<28>(lane::sub(lane::mul(x, ny), lane::mul(y, nx)));
            let across = lane::round::<28>(lane::add(lane::mul(x, nx), lane::mul(y, ny)));
            arms[0][body] = lane::clamp(along, -LIMIT, LIMIT) as i32;
            arms[1][body] = lane::clamp(across, -LIMIT, LIMIT) as i32;
        }
        arms
    }

    #[inline(always)]
    fn lever(&self, arm: [i32; 2]) -> Lever {
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
        let manifold = &self.pair.manifold;
        let points = &manifold.points[..manifold.count as usize];
        let arms = [0, 1].map(|at| points.get(at).map(|point| self.arms(at, point)));
        let lower = usize::from(points.len() > 1 && points[1].separation < points[0].separation);
        let tangent = arms[lower].map_or(Lever::default(), |[_, arm]| self.lever(arm));
        let mut carried = 0;
        for (at, arms) in arms.iter().enumerate() {
            let normal = arms.map_or(Lever::default(), |[arm, _]| self.lever(arm));
            let known = points.get(at).and_then(|point| (0..old.count as usize).find(|&k| old.ids[k] == point.id));
            carried = if known.is_some() { old.tangent } else { carried };
            let line = block.points[at].put(i, &normal, known.map_or(0, |k| old.normal[k]));
            let ratio = lane::scale(line, tangent.kappa);
            block.limit[at][i] = mul(ratio, friction, 48).min(i32::MAX.into()) as i32;
            let shift = scales.shift.saturating_add(6) as i32;
            block.separation[at][i] =
                points.get(at).map_or(i32::MAX, |point| lane::limit(lane::shifted(point.separation, shift)));
            // Warm starting has pushed already, and friction may outlast it by a substep.
            block.peak[at][i] = block.points[at].impulse[i];
        }
        block.friction.put(i, &tangent, carried);
        let [first, second] = arms.map(|arms| arms.map_or([0; 2], |[arm, _]| arm));
        block.couple[0][i] = block.friction.turns(i, first);
        block.couple[1][i] = block.friction.turns(i, second);
        block.couple[2][i] = block.points[0].turns(i, second);
    }
}

impl Row {
    /// Takes a lever, and the impulse λ̂ = κ·(λ·S) that the last tick left. 1/κ.
    #[inline(always)]
    fn put(&mut self, i: usize, lever: &Lever, start: i64) -> i32 {
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
        line
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
