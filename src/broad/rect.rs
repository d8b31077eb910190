//! Boxes as the broad phase keeps them: bare bits, in the world or in a frame.

use crate::geom::Aabb;

/// A box, Q32 m. Closed: boxes that share an edge overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) min: [i64; 2],
    pub(super) max: [i64; 2],
}

impl Rect {
    /// The box around nothing: what it is united with stays as it is.
    pub(super) const NOTHING: Rect = Rect { min: [i64::MAX; 2], max: [i64::MIN; 2] };
    pub(super) const EVERYTHING: Rect = Rect { min: [i64::MIN; 2], max: [i64::MAX; 2] };

    #[inline]
    pub(super) fn new(aabb: &Aabb) -> Rect {
        Rect { min: [aabb.min.x.to_bits(), aabb.min.y.to_bits()], max: [aabb.max.x.to_bits(), aabb.max.y.to_bits()] }
    }

    /// Seen from a frame at `origin`. Saturates, which never parts boxes that overlap.
    #[inline]
    pub(super) fn seen_from(&self, origin: [i64; 2]) -> Rect {
        let seen = |at: [i64; 2]| [at[0].saturating_sub(origin[0]), at[1].saturating_sub(origin[1])];
        Rect { min: seen(self.min), max: seen(self.max) }
    }

    /// Whether the two have a point in common. Without branches: which comparison fails cannot be foretold.
    #[inline]
    pub(super) fn overlaps(&self, other: &Rect) -> bool {
        (self.min[0] <= other.max[0])
            & (other.min[0] <= self.max[0])
            & (self.min[1] <= other.max[1])
            & (other.min[1] <= self.max[1])
    }

    #[inline]
    pub(super) fn contains(&self, other: &Rect) -> bool {
        (self.min[0] <= other.min[0])
            & (self.min[1] <= other.min[1])
            & (other.max[0] <= self.max[0])
            & (other.max[1] <= self.max[1])
    }

    /// The smallest box around both.
    #[inline]
    pub(super) fn union(&self, other: &Rect) -> Rect {
        Rect {
            min: [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])],
            max: [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])],
        }
    }

    /// Width and height.
    pub(super) fn size(&self) -> [i64; 2] {
        [self.max[0].saturating_sub(self.min[0]), self.max[1].saturating_sub(self.min[1])]
    }
}
