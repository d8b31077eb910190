//! Two outlines at a moment of their motion, and the axes that may separate them.

use super::circle::{Region, region};
use super::course::bound;
use super::meeting::{Motion, Path};
use super::overlap::farthest;
use super::unit::unit;
use super::{along, difference, sum};
use crate::num::mul;
use crate::shape::Placed;

/// The bodies at a time.
pub(super) struct Moment {
    pub(super) placed: [Placed; 2],
    pub(super) turning: [bool; 2],
    pub(super) arms: [i64; 2],
    /// As in [`Motion`], now; `a` and `alpha` do not change.
    pub(super) d: [i64; 2],
    pub(super) v: [i64; 2],
    pub(super) a: [i64; 2],
    pub(super) omega: [i64; 2],
    pub(super) alpha: [i64; 2],
    /// What is left of the time, Q32 of a tick.
    pub(super) rest: i64,
    /// The greatest distance of the centres in it, Q32 m, their speed, and the angular speeds, Q40.
    pub(super) far: i64,
    pub(super) fast: i64,
    pub(super) spins: [i64; 2],
}

/// An axis that may separate them.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    pub(super) normal: [i32; 2],
    /// Whose it is, and what of it is farthest along the normal. Heights are those of the other's vertices over that.
    pub(super) owner: usize,
    pub(super) from: [i64; 2],
    /// Whether it turns with its owner, being the normal of an edge.
    pub(super) edge: bool,
}

impl Axis {
    /// The normal as a direction from a to b.
    pub(super) fn outward(&self) -> [i64; 2] {
        let normal = self.normal.map(i64::from);
        if self.owner == 0 { normal } else { normal.map(i64::wrapping_neg) }
    }
}

/// The most axes: edges and, with a circle, one more.
const AXES: usize = 17;

/// The axes of a moment: a's edges, b's edges, and with a circle the one from its centre.
pub(super) struct Axes {
    pub(super) edges: [usize; 2],
    pub(super) radial: Option<Axis>,
    pub(super) count: usize,
    /// What the separation along each is not above, Q38 m; the separation itself, and the vertex it is at, where it was
    /// wanted.
    pub(super) limits: [i64; AXES],
    pub(super) nearest: [Option<u8>; AXES],
}

/// From the owner's centre to the other's, or how that changes.
pub(super) fn seen(owner: usize, v: [i64; 2]) -> [i64; 2] {
    if owner == 0 { v } else { v.map(i64::wrapping_neg) }
}

/// ½·`a`·τ² + `v`·τ of a rate with `shift` + 32 fraction bits more than wanted.
pub(super) fn way(v: i64, a: i64, time: i64, shift: u32) -> i64 {
    mul(v.wrapping_add(mul(a, time, 33)), time, shift)
}

impl Moment {
    /// At no time yet, and of nothing that turns.
    pub(super) fn new(path: &Path) -> Moment {
        Moment {
            placed: [Placed::default(), Placed::default()],
            turning: [false; 2],
            arms: path.arms,
            d: [0; 2],
            v: [0; 2],
            a: path.motion.a,
            omega: [0; 2],
            alpha: path.motion.alpha,
            rest: 0,
            far: 0,
            fast: 0,
            spins: [0; 2],
        }
    }

    /// To a time: all but what is placed.
    pub(super) fn set(&mut self, path: &Path, time: i64) {
        let Motion { d, v, a, omega, alpha, .. } = path.motion;
        self.rest = path.until.saturating_sub(time);
        for axis in 0..2 {
            self.d[axis] = d[axis].wrapping_add(way(v[axis], a[axis], time, 40));
            self.v[axis] = v[axis].wrapping_add(mul(a[axis], time, 32));
        }
        if self.turning == [false; 2] {
            return;
        }
        for body in 0..2 {
            let live = self.turning[body];
            self.omega[body] = if live { omega[body].wrapping_add(mul(alpha[body], time, 32)) } else { 0 };
            self.alpha[body] = if live { alpha[body] } else { 0 };
            let gain = mul(self.alpha[body], self.rest, 32).saturating_abs();
            self.spins[body] = self.omega[body].saturating_abs().saturating_add(gain);
        }
        self.fast = bound(self.v).saturating_add(mul(bound(a), self.rest, 32));
        self.far = bound(self.d).saturating_add(mul(self.fast, self.rest, 40)).saturating_add(2);
    }

    /// The axes there are now, with a first limit each.
    pub(super) fn axes(&self) -> Axes {
        let edges = [0, 1].map(|body| match self.placed[body].count {
            0 | 1 => 0,
            count => usize::from(count).min(AXES / 2),
        });
        let mut axes = Axes { edges, radial: None, count: 0, limits: [i64::MIN; AXES], nearest: [None; AXES] };
        for (owner, &count) in edges.iter().enumerate() {
            if count == 0 {
                continue;
            }
            let (own, other) = (&self.placed[owner], &self.placed[1 ^ owner]);
            // A point in the other polygon is no lower than its lowest vertex; two units for rounding.
            let half = usize::from(other.count / 2);
            let middle = sum(other.vertices[0], other.vertices[half]).map(|c| c >> 1);
            let shift = sum(middle, seen(owner, self.d));
            let lift = 2_i64.wrapping_sub(other.radius).wrapping_shl(6);
            for edge in 0..count {
                let limit = along(own.normals[edge], difference(shift, own.vertices[edge])).wrapping_add(lift);
                axes.push(limit);
            }
        }
        self.radial(&mut axes);
        axes
    }

    /// The direction from a circle's centre to the nearest vertex of the other, if that is what it is nearest to.
    fn radial(&self, axes: &mut Axes) {
        let owner = usize::from(axes.edges[0] > 0);
        let (own, other) = (&self.placed[owner], &self.placed[1 ^ owner]);
        if own.count > 1 {
            return;
        }
        let from = own.vertices[0];
        let shift = difference(seen(owner, self.d), from);
        let vertex = if other.count <= 1 {
            0
        } else {
            let center = shift.map(i64::wrapping_neg);
            let (face, distance) = farthest(other, center);
            match region(other, center, face) {
                Region::Vertex(vertex) if distance > 0 => vertex,
                _ => return,
            }
        };
        let way = sum(other.vertices[vertex], shift);
        if let Some((normal, _)) = unit(way) {
            axes.radial = Some(Axis { normal, owner, from, edge: false });
            axes.push(along(normal, way).wrapping_sub(own.radius.wrapping_add(other.radius).wrapping_shl(6)));
        }
    }

    /// An axis by its place in the list.
    pub(super) fn axis(&self, axes: &Axes, index: usize) -> Option<Axis> {
        let owner = usize::from(index >= axes.edges[0]);
        let edge = if owner == 0 { index } else { index.wrapping_sub(axes.edges[0]) };
        if edge >= axes.edges[owner] {
            return axes.radial;
        }
        let own = &self.placed[owner];
        Some(Axis { normal: own.normals[edge], owner, from: own.vertices[edge], edge: true })
    }

    /// The separation along an axis, Q38 m, if it is not less than `least`.
    #[inline]
    pub(super) fn apart(&self, axes: &mut Axes, index: usize, least: i64) -> Option<i64> {
        if axes.limits[index] < least {
            return None;
        }
        if axes.nearest[index].is_none() {
            self.settle(axes, index);
        }
        Some(axes.limits[index]).filter(|&separation| separation >= least)
    }

    /// Finds the nearest vertex along an axis (ties: lower index).
    fn settle(&self, axes: &mut Axes, index: usize) {
        let Some(Axis { normal, owner, from, edge }) = self.axis(axes, index) else { return };
        let (own, other) = (&self.placed[owner], &self.placed[1 ^ owner]);
        let shift = difference(seen(owner, self.d), from);
        let (mut nearest, mut lowest) = (0, i64::MAX);
        for (vertex, &q) in other.vertices[..usize::from(other.count)].iter().enumerate() {
            let height = along(normal, sum(q, shift));
            (nearest, lowest) = if height < lowest { (vertex, height) } else { (nearest, lowest) };
        }
        let radii = if edge { other.radius } else { own.radius.wrapping_add(other.radius) };
        axes.limits[index] = lowest.wrapping_sub(radii.wrapping_shl(6));
        axes.nearest[index] = Some(nearest as u8);
    }

    /// How far apart they are, Q38 m, the greatest least height, and the axis of it.
    pub(super) fn separation(&self, axes: &mut Axes) -> (usize, i64) {
        let first = (0..axes.count).max_by_key(|&index| axes.limits[index]).unwrap_or(0);
        let mut widest = (first, self.apart(axes, first, i64::MIN).unwrap_or(i64::MIN));
        for index in 0..axes.count {
            widest = self.apart(axes, index, widest.1).map_or(widest, |separation| (index, separation));
        }
        widest
    }
}

impl Axes {
    /// Adds an axis of at most this separation.
    fn push(&mut self, limit: i64) {
        if let Some(free) = self.limits.get_mut(self.count) {
            *free = limit;
            self.count = self.count.saturating_add(1);
        }
    }
}
