//! Whether outlines overlap, for sensors and boxes: the decision of `collide` without its points. Less than 2⁻³⁸ m apart
//! is touching.

use super::circle::{Region, region};
use super::{along, difference, inner, sum};
use crate::shape::Placed;

/// The edge that a point is farthest outside of (ties: lower index) and how far, Q38 m.
#[inline]
pub(super) fn farthest(polygon: &Placed, p: [i64; 2]) -> (usize, i64) {
    let outside = |edge: usize| along(polygon.normals[edge], difference(p, polygon.vertices[edge]));
    let mut greatest = (0, outside(0));
    for edge in 1..usize::from(polygon.count) {
        let distance = outside(edge);
        if distance > greatest.1 {
            greatest = (edge, distance);
        }
    }
    greatest
}

/// Whether two outlines, b's centre being `d` from a's (Q32 m), have a point in common; touching is enough.
/// Range: as `collide`.
pub(crate) fn overlap(a: &Placed, b: &Placed, d: [i64; 2]) -> bool {
    let back = d.map(i64::wrapping_neg);
    let apart = |axis: usize| {
        b.min[axis].wrapping_add(d[axis]) > a.max[axis] || a.min[axis].wrapping_sub(d[axis]) > b.max[axis]
    };
    if apart(0) || apart(1) {
        return false;
    }
    match (a.count > 1, b.count > 1) {
        (true, true) => !separated(a, b, d) && !separated(b, a, back),
        (true, false) => within(a, sum(b.vertices[0], d), b.radius),
        (false, true) => within(b, sum(a.vertices[0], back), a.radius),
        (false, false) => {
            let centers = difference(sum(b.vertices[0], d), a.vertices[0]);
            at_most(centers, a.radius.wrapping_add(b.radius))
        }
    }
}

/// Whether `other`, moved by `shift`, is wholly outside one of the edges of `own`.
fn separated(own: &Placed, other: &Placed, shift: [i64; 2]) -> bool {
    let corners = &other.vertices[..usize::from(other.count)];
    (0..usize::from(own.count)).any(|edge| {
        let from = difference(shift, own.vertices[edge]);
        corners.iter().all(|&v| along(own.normals[edge], sum(v, from)) > 0)
    })
}

/// Whether a point is at most `radius` from a polygon.
fn within(polygon: &Placed, p: [i64; 2], radius: i64) -> bool {
    let (face, distance) = farthest(polygon, p);
    if distance <= 0 {
        return true;
    }
    match region(polygon, p, face) {
        Region::Vertex(vertex) => at_most(difference(p, polygon.vertices[vertex]), radius),
        Region::Edge(edge) => along(polygon.normals[edge], difference(p, polygon.vertices[edge])) <= radius << 6,
    }
}

/// Whether a vector is at most this long; exact below 2⁶².
pub(super) fn at_most(v: [i64; 2], length: i64) -> bool {
    inner(v, v) <= inner([length, 0], [length, 0])
}
