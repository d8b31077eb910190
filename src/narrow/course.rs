//! How separations along an axis go: heights of vertices over it, bounded from below by quadratics in time.
//!
//! With n the normal of an edge of r that turns, D the way from r's centre to the other's, V and A its derivatives, q a
//! vertex from the other's centre, ω the angular velocities, α theirs, and J a quarter turn, the height n·(D + q) over
//! the edge's line has
//!
//! * f' = n·V − ω_r·n·JD + (ω_o − ω_r)·n·Jq
//! * f'' = n·A − 2·ω_r·n·JV − ω_r²·n·D − (ω_o − ω_r)²·n·q − α_r·n·J(D + q) + α_o·n·Jq
//!
//! and along a fixed n, with c what of r is farthest along it,
//!
//! * f' = n·V − ω_r·n·Jc + ω_o·n·Jq
//! * f'' = n·A + ω_r²·n·c − ω_o²·n·q − α_r·n·Jc + α_o·n·Jq.
//!
//! The second derivative is bounded over all the time that is left.

use super::moment::{Axes, Axis, Moment, seen};
use super::{along, difference, inner, sum};
use crate::num::mul;

/// Later than any time.
pub(super) const NEVER: i64 = i64::MAX;

/// The greatest rate, 2²⁰ m per tick, and curve, 2²⁶ m per tick²: beyond, they saturate and are no bounds any more.
/// Rims as fast as the greatest velocity at 15 ticks a second stay below.
const RATE: i128 = 1 << 60;
const CURVE: i128 = 1 << 62;

/// Limited to ±`limit`.
fn saturated(value: i128, limit: i128) -> i64 {
    value.clamp(limit.wrapping_neg(), limit) as i64
}

/// A height f + g·τ + ½·c·τ², with τ in Q32 of a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Course {
    /// Q38 m, |f| < 2⁵⁷.
    pub(super) height: i64,
    /// Q40 m per tick, |g| ≤ 2⁶⁰.
    pub(super) rate: i64,
    /// Q36 m per tick², |c| ≤ 2⁶².
    pub(super) curve: i64,
}

impl Course {
    /// The height at a time, Q72 m, rounded down. Products are below 2⁹⁶.
    fn at(self, time: i64) -> i128 {
        let time = i128::from(time);
        let fall = i128::from(self.curve).wrapping_mul(time) >> 29;
        let way = fall.wrapping_add(self.rate.into()).wrapping_mul(time);
        (i128::from(self.height) << 34).wrapping_add(way)
    }

    /// The first time at which the height is 0 or less, rounded down; [`NEVER`] if that is after `rest`.
    pub(super) fn end(self, rest: i64) -> i64 {
        let Course { height, rate, curve } = self;
        if height <= 0 {
            return 0;
        }
        // Open below, it is above 0 until `rest` if it is then.
        if curve <= 0 && self.at(rest) > 0 || curve > 0 && rate >= 0 {
            return NEVER;
        }
        // g² − 2·c·f, Q80: below 2¹²⁰ and 2¹²⁶.
        let [f, g, c] = [height, rate, curve].map(i128::from);
        let square = g.wrapping_mul(g).wrapping_sub(c.wrapping_mul(f) << 7);
        if square < 0 {
            return NEVER;
        }
        // Of the two ways to write the root that in which nothing cancels.
        let root = square.unsigned_abs().isqrt() as i128;
        let time = if rate < 0 {
            (f << 35).checked_div(root.wrapping_sub(g).wrapping_add(1))
        } else {
            (root.wrapping_add(g) << 28).checked_div(c.wrapping_neg())
        };
        match time {
            Some(time) if time <= i128::from(rest) => time as i64,
            // By rounding only, as was just seen.
            _ if curve <= 0 => rest,
            _ => NEVER,
        }
    }

    /// When the height may fall by more than `closing`, Q40 m per tick: the first unit of time after that.
    pub(super) fn falls(self, closing: i64) -> i64 {
        if self.curve >= 0 {
            return NEVER;
        }
        let spare = i128::from(self.rate).wrapping_add(closing.into()).max(0);
        let time = (spare << 28).checked_div(i128::from(self.curve).wrapping_neg()).unwrap_or(0);
        time.wrapping_add(1).min(NEVER.into()) as i64
    }
}

/// What the heights of all vertices over an axis have in common.
#[derive(Default)]
pub(super) struct Line {
    normal: [i32; 2],
    /// From what the owner has farthest along to the other's centre, Q32 m.
    shift: [i64; 2],
    /// Q38 m.
    radii: i64,
    /// As of a [`Course`], but for the terms in q.
    rate: i64,
    curve: i64,
    /// How the other turns, seen from the axis, Q40; the least and the greatest square of it, Q32.
    spin: i64,
    squares: [i64; 2],
    /// How far a vertex is from its centre at most, and how far it comes along the axis, Q38 m.
    arm: i64,
    sway: i64,
}

impl Line {
    /// The height of a vertex, from its body's centre.
    pub(super) fn course(&self, q: [i64; 2]) -> Course {
        let Line { normal, mut rate, mut curve, .. } = *self;
        let height = along(normal, sum(q, self.shift)).wrapping_sub(self.radii);
        if self.squares[1] > 0 {
            let turned = product(self.spin, along(normal, quarter(q)), 38);
            rate = saturated(turned.saturating_add(rate.into()), RATE);
            let out = along(normal, q).saturating_add(self.sway).saturating_add(2).min(self.arm);
            let pull = product(self.squares[usize::from(out > 0)], out, 34);
            curve = saturated(i128::from(curve).wrapping_sub(pull), CURVE);
        }
        Course { height, rate, curve }
    }
}

/// a·b·2^−shift, rounded down.
fn product(a: i64, b: i64, shift: u32) -> i128 {
    i128::from(a).wrapping_mul(i128::from(b)) >> shift
}

/// A quarter of a turn on.
fn quarter([x, y]: [i64; 2]) -> [i64; 2] {
    [y.wrapping_neg(), x]
}

/// n·v in the format of v, rounded down; |v| < 2⁶².
fn component(n: [i32; 2], v: [i64; 2]) -> i64 {
    (inner(n.map(i64::from), v) >> 30) as i64
}

/// An upper bound of a vector's length, an eighth too long at most.
pub(super) fn bound(v: [i64; 2]) -> i64 {
    let [x, y] = v.map(i64::saturating_abs);
    x.max(y).saturating_add(x.min(y) >> 1).saturating_add(1)
}

impl Moment {
    /// How heights over an axis go, and the vertices that matter: the nearest alone if nothing turns.
    ///
    /// Range: a few products of angular velocities below 2⁵⁴, speeds below 2⁵⁶ and distances below 2⁵², each shifted at
    /// once.
    pub(super) fn line(&self, axes: &Axes, index: usize) -> Option<(Line, &[[i64; 2]])> {
        let Axis { normal, owner, from, edge } = self.axis(axes, index)?;
        let (own, other) = (&self.placed[owner], &self.placed[1 ^ owner]);
        let [d, v, a] = [self.d, self.v, self.a].map(|v| seen(owner, v));
        let radii = if edge { other.radius } else { own.radius.wrapping_add(other.radius) };
        let mut line = Line {
            normal,
            shift: difference(d, from),
            radii: radii.wrapping_shl(6),
            rate: component(normal, v),
            curve: component(normal, a) >> 4,
            ..Line::default()
        };
        if self.turning == [false; 2] {
            let nearest = usize::from(axes.nearest[index]?);
            return Some((line, other.vertices.get(nearest..=nearest)?));
        }
        let [r, o] = [owner, 1 ^ owner];
        // An edge turns with its owner; of a circle only the centre does.
        let (spin, at) = if edge { (self.omega[o].wrapping_sub(self.omega[r]), d) } else { (self.omega[o], from) };
        let alpha = self.alpha.map(i64::saturating_abs);
        let change = mul(alpha[o].wrapping_add(if edge { alpha[r] } else { 0 }), self.rest, 32);
        let most = spin.saturating_abs().wrapping_add(change);
        let least = spin.saturating_abs().wrapping_sub(change).max(0);
        line.spin = spin;
        line.squares = [product(least, least, 48) as i64, (product(most, most, 48) as i64).wrapping_add(1)];
        line.arm = self.arms[o].wrapping_shl(6);
        line.sway = mul(mul(most, self.rest, 32).wrapping_add(1), line.arm, 40).saturating_add(1);

        let mut curve = i128::from(line.curve).wrapping_sub(product(alpha[o], self.arms[o], 36));
        if self.turning[r] {
            let turned = product(self.omega[r], along(normal, quarter(at)), 38);
            line.rate = saturated(i128::from(line.rate).wrapping_sub(turned), RATE);
            let loss = if edge {
                self.bend(normal, r, d, v)
            } else {
                // Q36 of ω², below 2⁶².
                let square = product(self.spins[r], self.spins[r], 44) as i64;
                product(square, self.arms[r], 32).wrapping_add(product(alpha[r], self.arms[r], 36))
            };
            curve = curve.wrapping_sub(loss);
        }
        // For what the products lost.
        line.curve = saturated(curve.wrapping_sub(8), CURVE);
        Some((line, &other.vertices[..usize::from(other.count)]))
    }

    /// What the turning of r's edge takes from second derivatives at most, but for the term in n·q: Q36 m per tick².
    /// The lesser of two bounds: by the terms' magnitudes, and by what they are now and how much they can change.
    fn bend(&self, normal: [i32; 2], r: usize, d: [i64; 2], v: [i64; 2]) -> i128 {
        let (spin, omega, alpha) = (self.spins[r], self.omega[r], self.alpha[r].saturating_abs());
        let (push, turned) = (bound(self.a), mul(self.spins[r], self.rest, 32).wrapping_add(1));
        // ω²·|D| and ω·|V|, and what n·A changes by.
        let square = (product(spin, spin, 48) as i64).wrapping_add(1);
        let (spun, fled) = (product(square, self.far, 28), product(spin, self.fast, 44));
        let mut least = spun.wrapping_add(fled.wrapping_mul(2)).wrapping_add(product(turned, push, 44));
        if turned < 1 << 40 {
            // 3·|A| + 3·ω·|V| + ω²·|D| a radian, and 2·α·(ω·|D| + |V|) a tick.
            let change = product(push, 3, 4).wrapping_add(fled.wrapping_mul(3)).wrapping_add(spun);
            let change = change.wrapping_mul(turned.into()) >> 40;
            let eased = product(spin, self.far, 32).wrapping_add(self.fast.into());
            let eased = product(alpha, self.rest, 32).wrapping_mul(eased) >> 43;
            let now = product(product(omega, omega, 48) as i64, along(normal, d), 34);
            let now = now.wrapping_add(product(omega, component(normal, quarter(v)), 43));
            least = least.min(now.wrapping_add(change).wrapping_add(eased));
        }
        least.wrapping_add(product(alpha, self.far.wrapping_add(self.arms[1 ^ r]), 36))
    }
}
