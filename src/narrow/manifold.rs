//! Manifolds: at most two vertex-to-edge contacts of two convex outlines.
//!
//! An edge-to-edge touch is two of them. All values are integers of the formats below; turned by half a turn (vertices,
//! normals and `d` negated) a scene gives the negated bits of `normal` and `arm` and the same bits otherwise.
//! With a and b exchanged (and `d` negated) it gives the same points, the separations bit by bit, with two exceptions:
//! of two equal separating axes a's is chosen, and the arm of two circles may differ by a unit in the last place.
//!
//! Errors, with e the length of the longer edge or the sum of the radii: 2⁻³² m + 2⁻³⁰·e of a separation at a vertex,
//! most of it from the 30 fraction bits of the normals. Where an edge ends over a slanted one, the error along it is
//! multiplied by the slope.

use super::faces::Faces;
use super::{circle, polygon};
use crate::shape::Placed;

/// A vertex-to-edge contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Point {
    /// From a's centre of mass to the point half-way between the surfaces, Q32 m, world axes. b's arm is this minus the
    /// vector from a's centre to b's.
    pub(crate) arm: [i64; 2],
    /// The distance of the vertex from the edge along the normal, Q32 m; negative where they overlap.
    pub(crate) separation: i64,
    /// Which features these are, the same from tick to tick while the same edges face each other: bits 4 … 6 a's edge,
    /// bits 1 … 3 b's edge, bit 0 which end of their overlap it is, by the direction of a's edge (0: the first one).
    /// Whose vertex it is does not matter. A vertex alone is the end that it is of its own edge. With a circle 0.
    pub(crate) id: u8,
}

crate::store::show!(Point { arm, separation, id });

/// Where two outlines touch, or nearly do.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Manifold {
    /// Unit, Q30, from b to a. (The SRS's n points from the owner of the edge to the owner of the vertex: this one where
    /// the edge is b's, its negative where the edge is a's.) Zero without points.
    pub(crate) normal: [i32; 2],
    /// How many points there are: 0, 1 or 2.
    pub(crate) count: u8,
    /// By ascending id; zero beyond `count`.
    pub(crate) points: [Point; 2],
}

crate::store::show!(Manifold { normal, count, points });

/// What is near of two outlines, and for which limits that is so.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Near {
    /// Whether an axis separates them by more than the limit. Two polygons that are nearer may still have no points, a
    /// corner of one before a corner of the other.
    pub(crate) apart: bool,
    /// The points whose separation is at most the limit.
    pub(crate) manifold: Manifold,
    /// With limits from this one on and below that one all of it is the same, Q32 m.
    pub(crate) from: i64,
    pub(crate) below: i64,
}

impl Near {
    /// Nothing: something separates them by so much.
    pub(super) fn apart(by: i64) -> Near {
        Near { apart: true, manifold: Manifold::default(), from: i64::MIN, below: by }
    }

    /// What it is with a limit, if that is known.
    #[inline]
    pub(crate) fn holds(&self, limit: i64) -> bool {
        self.from <= limit && limit < self.below
    }
}

/// The manifold of two outlines, b's centre being `d` from a's (Q32 m), with the points whose separation is at most
/// `limit` (Q32 m, not negative). Outlines that overlap have at least one point.
///
/// Range: |d| < 2⁵⁰, vertices below 2⁴⁸: differences stay below 2⁵², their products with Q30 normals below 2⁸⁴.
pub(crate) fn collide(a: &Placed, b: &Placed, d: [i64; 2], limit: i64) -> Manifold {
    near(a, b, d, limit, &mut Faces::default()).manifold
}

/// The same, and which limits would give it as well. `faces`: what is known of how polygons lie.
pub(crate) fn near(a: &Placed, b: &Placed, d: [i64; 2], limit: i64, faces: &mut Faces) -> Near {
    if a.count <= 1 && b.count <= 1 {
        return match circle::from_circle(a, b, d, limit) {
            Ok(contact) => single(contact, true, d, i64::MIN),
            Err(by) => Near::apart(by),
        };
    }
    // Boxes apart: most pairs of a broad phase with margins end here.
    let between = |axis: usize| {
        let above = b.min[axis].wrapping_add(d[axis]).wrapping_sub(a.max[axis]);
        let below = a.min[axis].wrapping_sub(d[axis]).wrapping_sub(b.max[axis]);
        above.max(below)
    };
    let boxes = between(0).max(between(1));
    if boxes > limit {
        return Near::apart(boxes);
    }
    let contact = if b.count <= 1 {
        circle::from_polygon(a, b, d, limit)
    } else if a.count <= 1 {
        circle::from_polygon(b, a, d.map(i64::wrapping_neg), limit)
    } else {
        return polygon::near(a, b, d, limit, boxes, faces);
    };
    match contact {
        Ok(contact) => single(contact, b.count <= 1, d, boxes),
        Err(by) => Near::apart(by),
    }
}

/// A contact with a circle as its owner saw it: `normal` away from the owner, the point from the owner's centre. There is
/// one with limits from the greater of two on.
fn single(contact: circle::Contact, a_owns: bool, d: [i64; 2], boxes: i64) -> Near {
    let circle::Contact { normal, mut point, from } = contact;
    let normal = if a_owns { normal.map(i32::wrapping_neg) } else { normal };
    if !a_owns {
        point.arm = super::sum(point.arm, d);
    }
    let manifold = Manifold { normal, count: 1, points: [point, Point::default()] };
    Near { apart: false, manifold, from: boxes.max(from), below: i64::MAX }
}
