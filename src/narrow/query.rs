//! The nearest point of an outline, and where a ray enters it. Not of the step: about a microsecond where the products
//! need 256 bits.
//!
//! Points and rays are from the outline's body, Q32 m, below ±2⁶² (a world of 1e9 m); beyond they are limited to it. The
//! placed vertices decide, exactly, not the normals, whose 30 bits are 1 m at 1e9 m. (The rounding of vertices tilts an
//! edge of 1e-6 m by 3e-4: where that is more than the polygon bends there, an outline 1 m long is wrong by 3e-4 m.)

use super::circle::{Region, region};
use super::overlap::at_most;
use super::unit::unit;
use super::{difference, inner, next, outer, sum};
use crate::num::{clamp_i64, cross_wide, dot, hypot, mul_div, sqrt};
use crate::shape::Placed;

/// Where a ray enters an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Hit {
    /// Of the ray's length, Q62, 0 … 1.
    pub(crate) fraction: i64,
    /// Of the outline there, unit, Q30; zero if the ray starts in the outline or on its border.
    pub(crate) normal: [i32; 2],
}

/// The farthest coordinate.
const FAR: i64 = (1 << 62) - 1;
/// 1, Q62.
const WHOLE: i128 = 1 << 62;

fn limited(v: [i64; 2]) -> [i64; 2] {
    v.map(|c| c.clamp(-FAR, FAR))
}

/// The length of a vector times 2^shift, with 62 bits or more, and the shift. Coordinates below 2⁶³.
fn length(v: [i64; 2]) -> (i128, u32) {
    let square = inner(v, v).unsigned_abs();
    let shift = square.leading_zeros().saturating_sub(1).min(126) / 2;
    (i128::from(sqrt(square.wrapping_shl(shift.wrapping_mul(2)))), shift)
}

/// From an edge's first vertex to its second.
fn side(polygon: &Placed, edge: usize) -> [i64; 2] {
    difference(polygon.vertices[next(edge, usize::from(polygon.count))], polygon.vertices[edge])
}

/// How far `p` is to the left of an edge, times the edge's length; the inside is on the left. Below 2¹¹⁴.
fn left_of(polygon: &Placed, edge: usize, p: [i64; 2]) -> i128 {
    outer(side(polygon, edge), difference(p, polygon.vertices[edge]))
}

/// Whether a point is in the outline or on its border.
pub(crate) fn contains(a: &Placed, p: [i64; 2]) -> bool {
    if (0..2).any(|axis| p[axis] < a.min[axis] || p[axis] > a.max[axis]) {
        return false;
    }
    if a.count > 1 {
        (0..usize::from(a.count)).all(|edge| left_of(a, edge, p) >= 0)
    } else {
        at_most(difference(p, a.vertices[0]), a.radius)
    }
}

/// The point of an outline nearest to `p` and its distance; `p` itself and 0 if it is inside or on the border.
///
/// Rounding: each coordinate and the distance to nearest (but for 2⁻⁶⁰ of what is rounded). The distance is that of the
/// exact nearest point.
pub(crate) fn closest(a: &Placed, p: [i64; 2]) -> ([i64; 2], i64) {
    let p = limited(p);
    if contains(a, p) {
        return (p, 0);
    }
    if a.count <= 1 {
        let off = difference(p, a.vertices[0]);
        let (long, shift) = length(off);
        let part = |c: i64| clamp_i64(mul_div(i128::from(c), i128::from(a.radius).wrapping_shl(shift), long));
        let distance = clamp_i64(i128::from(hypot(off[0], off[1]))).saturating_sub(a.radius);
        return (sum(a.vertices[0], off.map(part)), distance);
    }
    let from = |edge: usize| difference(p, a.vertices[edge]);
    // The edge that it is farthest outside of; ties: lower index.
    let outside = |edge: &usize| inner(a.normals[*edge].map(i64::from), from(*edge));
    let face = (0..usize::from(a.count)).rev().max_by_key(outside).unwrap_or(0);
    match region(a, p, face) {
        Region::Vertex(vertex) => {
            let off = from(vertex);
            (a.vertices[vertex], clamp_i64(i128::from(hypot(off[0], off[1]))))
        }
        Region::Edge(edge) => {
            let along = side(a, edge);
            let (part, whole) = (inner(from(edge), along), inner(along, along));
            let at = along.map(|c| clamp_i64(mul_div(i128::from(c), part, whole)));
            let (long, shift) = length(along);
            let distance = mul_div(left_of(a, edge, p).saturating_abs(), 1i128.wrapping_shl(shift), long);
            (sum(a.vertices[edge], at), clamp_i64(distance))
        }
    }
}

/// Where the way from `origin` to `origin + ray` first meets an outline; touching is enough.
///
/// A polygon's edge and whether it is met are exact (ties, through a vertex: lower index), the fraction is rounded to
/// nearest. Of a circle the error is 2⁻⁴⁶ m along and across the ray, and 2⁻⁶² of the distance: of a ray that
/// nearly touches it, √(2·radius·2⁻⁴⁶ m) along.
pub(crate) fn ray(a: &Placed, origin: [i64; 2], ray: [i64; 2]) -> Option<Hit> {
    let (origin, ray) = (limited(origin), limited(ray));
    if contains(a, origin) {
        return Some(Hit::default());
    }
    if a.count > 1 { into_polygon(a, origin, ray) } else { into_circle(a, origin, ray) }
}

/// Cyrus and Beck: from the last edge entered to the first one left.
fn into_polygon(a: &Placed, origin: [i64; 2], ray: [i64; 2]) -> Option<Hit> {
    // Fractions as numerator and denominator, both below 2¹¹⁴.
    let after = |left: [i128; 2], right: [i128; 2]| cross_wide(left, right, 1) > 0;
    let (mut enter, mut exit, mut face) = ([-1, 1], [1, 1], None);
    for edge in 0..usize::from(a.count) {
        let (inside, inward) = (left_of(a, edge, origin), outer(side(a, edge), ray));
        if inside < 0 && inward <= 0 {
            return None;
        }
        if inside < 0 && after([inside.saturating_neg(), inward], enter) {
            (enter, face) = ([inside.saturating_neg(), inward], Some(edge));
        }
        if inward < 0 && after(exit, [inside, inward.saturating_neg()]) {
            exit = [inside, inward.saturating_neg()];
        }
    }
    let face = face.filter(|_| !after(enter, exit))?;
    let fraction = clamp_i64(mul_div(enter[0], WHOLE, enter[1]));
    Some(Hit { fraction, normal: a.normals[face] })
}

/// In the ray's own axes: how far along it and beside it the centre is.
fn into_circle(a: &Placed, origin: [i64; 2], ray: [i64; 2]) -> Option<Hit> {
    let from = difference(origin, a.vertices[0]);
    let (long, shift) = length(ray);
    let ahead = inner(from, ray);
    if ahead >= 0 {
        return None;
    }
    // Q46 m from here on: 14 bits more than lengths have, radii up to 2⁶².
    let scale = 1i128.wrapping_shl(shift.saturating_add(14));
    let beside = clamp_i64(mul_div(outer(from, ray), scale, long));
    let radius = a.radius.saturating_mul(1 << 14);
    if beside.saturating_abs() > radius {
        return None;
    }
    let chord = sqrt(inner([radius, 0], [radius, 0]).saturating_sub(inner([beside, 0], [beside, 0])).unsigned_abs());
    let chord = clamp_i64(i128::from(chord));
    let start = mul_div(ahead, scale, long).saturating_neg().saturating_sub(i128::from(chord)).max(0);
    let fraction = mul_div(start, 1i128.wrapping_shl(shift.saturating_add(48)), long);
    if fraction > WHOLE {
        return None;
    }
    // Back along the ray by the chord, and to the side that the centre is not on.
    let [x, y] = unit(ray)?.0.map(i64::from);
    let back = chord.saturating_neg();
    let out = [dot([back, beside], [x, y], 30), dot([back, beside], [y, x.saturating_neg()], 30)];
    Some(Hit { fraction: clamp_i64(fraction), normal: unit(out)?.0 })
}
