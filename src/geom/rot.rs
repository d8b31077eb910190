//! Rotations: derived from an angle, never integrated.

use super::Vec2;
use crate::num::{Angle, Length, dot, sin_cos};

/// A rotation as cosine and sine, `I2F30` each.
///
/// Derived from an [`Angle`] each time, so it never drifts: |cos² + sin² − 1| < 2e-9.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rot {
    /// The cosine, with 30 fraction bits.
    pub cos: i32,
    /// The sine, with 30 fraction bits.
    pub sin: i32,
}

impl Rot {
    /// No rotation.
    pub const IDENTITY: Rot = Rot { cos: 1 << 30, sin: 0 };

    /// The rotation by `angle`, counter-clockwise positive.
    #[inline]
    pub const fn new(angle: Angle) -> Rot {
        let (cos, sin) = sin_cos(angle);
        Rot { cos, sin }
    }

    /// A vector turned by this rotation. Rounding: once per component. Overflow: saturates.
    pub const fn rotate(self, v: Vec2<Length>) -> Vec2<Length> {
        let (v, cos, sin) = ([v.x.to_bits(), v.y.to_bits()], self.cos as i64, self.sin as i64);
        Vec2::new(Length::from_bits(dot(v, [cos, sin.saturating_neg()], 30)), Length::from_bits(dot(v, [sin, cos], 30)))
    }

    /// A vector turned back by this rotation. Rounding: once per component. Overflow: saturates.
    pub const fn unrotate(self, v: Vec2<Length>) -> Vec2<Length> {
        Rot { cos: self.cos, sin: self.sin.saturating_neg() }.rotate(v)
    }
}
