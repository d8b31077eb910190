//! A circle against a polygon or another circle: one point at most. A circle is a vertex with a radius.

use super::manifold::Point;
use super::overlap::at_most;
use super::unit::unit;
use super::{along, difference, inner, next, previous, rounded, sum};
use crate::num::mul;
use crate::shape::Placed;

/// From `normal` and what lies between the centre and the face, vertex or centre it is nearest to, in the owner's frame:
/// the middle of the gap is radius + separation/2 from the centre, against the normal.
fn point(normal: [i32; 2], center: [i64; 2], radius: i64, separation: i64) -> Point {
    let back = radius.wrapping_mul(2).wrapping_add(separation);
    let arm = difference(center, normal.map(|n| mul(i64::from(n), back, 31)));
    Point { arm, separation, id: 0 }
}

/// A circle's contact as its owner sees it.
pub(super) struct Contact {
    pub(super) normal: [i32; 2],
    pub(super) point: Point,
    /// It is one with limits from this one on.
    pub(super) from: i64,
}

/// Where a point outside a polygon has its nearest feature.
pub(super) enum Region {
    /// The edge from this vertex on.
    Edge(usize),
    Vertex(usize),
}

/// The region of a point outside, found from the edge it is farthest outside of. Decided exactly.
///
/// That edge is the one, or has the vertex, except among edges that are nearly in line, where the rounding of normals
/// decides: from there it is a walk along the outline.
pub(super) fn region(polygon: &Placed, p: [i64; 2], start: usize) -> Region {
    let count = usize::from(polygon.count);
    let ahead = |edge: usize, vertex: usize| {
        let side = difference(polygon.vertices[next(edge, count)], polygon.vertices[edge]);
        inner(difference(p, polygon.vertices[vertex]), side)
    };
    let mut edge = start;
    for _ in 0..count {
        let to = next(edge, count);
        if ahead(edge, to) <= 0 {
            break;
        }
        if ahead(to, to) < 0 {
            return Region::Vertex(to);
        }
        edge = to;
    }
    for _ in 0..count {
        if ahead(edge, edge) >= 0 {
            break;
        }
        let from = previous(edge, count);
        if ahead(from, edge) > 0 {
            return Region::Vertex(edge);
        }
        edge = from;
    }
    Region::Edge(edge)
}

/// `polygon` and the circle `other`, whose body's centre is `shift` from the polygon's: the normal from the polygon to
/// the circle and the point from the polygon's centre; or how far they are apart at least, which is more than the limit.
///
/// A centre inside or on the polygon has the normal of the face it is least inside of (ties: lower index).
pub(super) fn from_polygon(polygon: &Placed, other: &Placed, shift: [i64; 2], limit: i64) -> Result<Contact, i64> {
    let radius = other.radius;
    let reach = limit.wrapping_add(radius);
    let center = sum(other.vertices[0], shift);
    let outside = |edge: usize| rounded(along(polygon.normals[edge], difference(center, polygon.vertices[edge])));
    let (mut face, mut greatest) = (0, i64::MIN);
    for edge in 0..usize::from(polygon.count) {
        let distance = outside(edge);
        if distance > reach {
            return Err(distance.wrapping_sub(radius));
        }
        if distance > greatest {
            (face, greatest) = (edge, distance);
        }
    }
    let (normal, distance) = if greatest <= 0 {
        (polygon.normals[face], greatest)
    } else {
        match region(polygon, center, face) {
            Region::Edge(edge) => (polygon.normals[edge], outside(edge)),
            Region::Vertex(vertex) => unit(difference(center, polygon.vertices[vertex])).ok_or(i64::MAX)?,
        }
    };
    let separation = distance.wrapping_sub(radius);
    if distance > reach {
        return Err(separation);
    }
    let from = greatest.max(distance).wrapping_sub(radius);
    Ok(Contact { normal, point: point(normal, center, radius, separation), from })
}

/// Two circles: the normal from a to b and the point from a's centre; or how far they are apart at least, which is more
/// than the limit. Where the centres coincide, no direction is better than another: the normal is (0, −1), from b to a
/// (0, 1); it is the one case that half a turn does not negate.
pub(super) fn from_circle(a: &Placed, b: &Placed, d: [i64; 2], limit: i64) -> Result<Contact, i64> {
    let (from, to) = (a.vertices[0], sum(b.vertices[0], d));
    let centers = difference(to, from);
    let radii = a.radius.wrapping_add(b.radius);
    // Beyond this the length needs no root: |c| > r by more than rounding.
    let within = |limit: i64| at_most(centers, radii.wrapping_add(limit).wrapping_add(1));
    if !within(limit) {
        return Err(limit.wrapping_add(1));
    }
    let (normal, distance) = unit(centers).unwrap_or(([0, -(1 << 30)], 0));
    let separation = distance.wrapping_sub(radii);
    if separation > limit {
        return Err(separation);
    }
    // Half-way between from + n·r and to − n·r.
    let both = sum(from, to).map(|c| c.wrapping_add(c.signum()) / 2);
    let arm = sum(both, normal.map(|n| mul(n.into(), a.radius.wrapping_sub(b.radius), 31)));
    // Of circles kilometres apart the length is rounded by more than a unit.
    let from = if within(separation) { separation } else { limit };
    Ok(Contact { normal, point: Point { arm, separation, id: 0 }, from })
}
