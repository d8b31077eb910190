//! Pairs of a quantity.

use crate::num::{Quantity, RangeError};
use core::fmt;
use serde::{Deserialize, Serialize};

/// A vector in the plane: x to the right, y up, counter-clockwise positive.
///
/// It has no operators: sums and products are the [`num`](crate::num) kernels, with their rounding and overflow.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Vec2<Q> {
    /// The component along x.
    pub x: Q,
    /// The component along y.
    pub y: Q,
}

impl<Q> Vec2<Q> {
    /// (x, y).
    pub const fn new(x: Q, y: Q) -> Self {
        Vec2 { x, y }
    }
}

impl<Q: Quantity> Vec2<Q> {
    /// The vector itself when both components are accepted.
    pub fn checked(self) -> Result<Self, RangeError> {
        Ok(Vec2 { x: self.x.checked()?, y: self.y.checked()? })
    }
}

impl<Q: Quantity + Default> Vec2<Q> {
    /// Whether both components are zero.
    pub fn is_zero(self) -> bool {
        self == Self::default()
    }
}

impl<Q: fmt::Display> fmt::Display for Vec2<Q> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("(")?;
        self.x.fmt(f)?;
        f.write_str(", ")?;
        self.y.fmt(f)?;
        f.write_str(")")
    }
}

impl<Q: fmt::Debug> fmt::Debug for Vec2<Q> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({:?}, {:?})", self.x, self.y)
    }
}
