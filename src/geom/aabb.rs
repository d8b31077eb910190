//! Boxes along the axes.

use super::Vec2;
use crate::num::Length;

/// A box along the axes of the world: closed, so boxes that share an edge overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Aabb {
    /// Its lower left corner.
    pub min: Vec2<Length>,
    /// Its upper right corner.
    pub max: Vec2<Length>,
}

impl Aabb {
    /// Whether the two have a point in common. Without branches: which comparison fails cannot be foretold.
    #[inline]
    pub fn overlaps(&self, other: &Aabb) -> bool {
        (self.min.x <= other.max.x)
            & (other.min.x <= self.max.x)
            & (self.min.y <= other.max.y)
            & (other.min.y <= self.max.y)
    }

    /// Whether all of `other` lies inside.
    #[inline]
    pub fn contains(&self, other: &Aabb) -> bool {
        self.min.x <= other.min.x && self.min.y <= other.min.y && other.max.x <= self.max.x && other.max.y <= self.max.y
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(&self, other: &Aabb) -> Aabb {
        Aabb {
            min: Vec2::new(self.min.x.min(other.min.x), self.min.y.min(other.min.y)),
            max: Vec2::new(self.max.x.max(other.max.x), self.max.y.max(other.max.y)),
        }
    }
}
