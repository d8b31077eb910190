//! Which edges of two polygons face each other: known for as long as they have not moved too far against each other.
//!
//! What separates most of all edges keeps doing so until the others have caught up. Its lead over them is known from when all
//! were looked at, and no height of a vertex over an edge changes by more than the bodies moved. So this is a memory that has
//! no say: what it names is what looking at all of them would find.

use super::course::bound;
use crate::num::mul;

/// The edges of greatest separation of two polygons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Faces {
    of: [Outermost; 2],
    /// The angles at which they lay, in 2⁻³² turns.
    angle: [i32; 2],
}

/// An edge that separates more than all others of its polygon, by more than `lead`, 2⁻²⁴ m; if that is not positive, any edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Outermost {
    edge: u8,
    lead: i32,
}

impl Outermost {
    /// `lead`: Q32 m.
    pub(super) fn new(edge: usize, lead: i64) -> Outermost {
        Outermost { edge: edge as u8, lead: (lead >> 8).clamp(0, i32::MAX.into()) as i32 }
    }

    /// The edge, if it is surely that one.
    #[inline(always)]
    pub(super) fn known(&self) -> Option<usize> {
        (self.lead > 0).then_some(usize::from(self.edge))
    }
}

impl Faces {
    #[inline(always)]
    pub(super) fn of(&mut self, polygon: usize) -> &mut Outermost {
        &mut self.of[polygon]
    }

    /// The polygons moved: their centres were `d[0]` from each other and are `d[1]` (Q32 m), they lie at these angles now (Q48 turns),
    /// and no point of them is farther from its centre than these `reach`es (Q32 m).
    #[inline]
    pub(crate) fn follow(&mut self, d: [[i64; 2]; 2], angle: [i64; 2], reach: [i64; 2]) {
        let angle = angle.map(|angle| (angle >> 16) as i32);
        let by = |body: usize| i64::from(angle[body].wrapping_sub(self.angle[body]).unsigned_abs());
        // A unit of each for what was cut off.
        let turned = by(0).saturating_add(by(1)).saturating_add(2);
        let gone = bound([d[1][0].saturating_sub(d[0][0]), d[1][1].saturating_sub(d[0][1])]);
        // Turning moves a vertex of one against an edge of the other by no more than the angle times this; 7 > 2π.
        let far = bound(d[1]).saturating_add(gone).saturating_add(reach[0]).saturating_add(reach[1]);
        // And a unit of 2⁻³⁰ for each component of two normals, and units for the rounding of vertices.
        let rounding = (far >> 28).saturating_add(16);
        let moved = gone.saturating_add(mul(turned.saturating_mul(7), far, 32)).saturating_add(rounding);
        // One edge may lose as much as another one gains.
        let lost = (moved >> 7).saturating_add(1).min(i32::MAX.into()) as i32;
        self.of.iter_mut().for_each(|of| of.lead = of.lead.saturating_sub(lost));
        self.angle = angle;
    }
}
