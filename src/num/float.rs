//! The one file with floats: callers' literals in, numbers for drawing out. Nothing in the engine calls it.
#![allow(clippy::disallowed_types, reason = "the one conversion file for callers' literals and for drawing")]

use super::Decimal;
use super::quantity::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Density, Energy, Force, Friction, Impulse, Inertia,
    Length, Mass, Mu, NumError, Quantity, Radians, RangeError, Restitution, Time, Torque, Velocity,
};
use crate::geom::{Rot, Vec2};
use fixed::FixedI128;
use fixed::types::extra::{U32, U64};

/// A quantity that converts from and to `f64`.
pub trait FromF64: Quantity {
    /// The value nearest to `value` (ties to even). Exact for every `f64` that the format holds.
    ///
    /// Errors: NaN and infinities, and values outside the accepted range.
    fn from_f64(value: f64) -> Result<Self, NumError>;

    /// The nearest `f64`. For drawing and statistics: feeding it back into a lockstep game gives determinism away.
    fn to_f64(self) -> f64;
}

macro_rules! float {
    ($($name:ident)*) => {$(
        impl $name {
            /// The value nearest to `value` (ties to even). Exact for every `f64` that the format holds.
            ///
            /// Errors: NaN and infinities, and values outside the accepted range.
            pub fn from_f64(value: f64) -> Result<Self, NumError> {
                if !value.is_finite() {
                    return Err(NumError::NotFinite { quantity: Self::NAME });
                }
                match fixed_checked(value) {
                    Some(fixed) => Ok(Self::from_fixed(fixed).checked()?),
                    None => {
                        Err(RangeError::new::<Self>(beyond(value)).into())
                    }
                }
            }

            /// The nearest `f64`. For drawing and statistics: feeding it back into a lockstep game gives
            /// determinism away.
            pub fn to_f64(self) -> f64 {
                self.to_fixed().to_num()
            }
        }

        impl FromF64 for $name {
            fn from_f64(value: f64) -> Result<Self, NumError> {
                $name::from_f64(value)
            }

            fn to_f64(self) -> f64 {
                $name::to_f64(self)
            }
        }
    )*};
}

/// What a value beyond its format is shown as.
fn beyond(value: f64) -> Decimal {
    match FixedI128::<U64>::checked_from_num(value) {
        Some(shown) => Decimal { bits: shown.to_bits(), frac: 64 },
        None => Decimal { bits: FixedI128::<U32>::saturating_from_num(value).to_bits(), frac: 32 },
    }
}

fn fixed_checked<F: fixed::traits::Fixed>(value: f64) -> Option<F> {
    F::checked_from_num(value)
}

float! {
    Acceleration Angle AngularImpulse AngularVelocity Damping Density Energy Force Friction Impulse Inertia Length Mass Mu
    Radians Restitution Time Torque Velocity
}

impl<Q: FromF64> Vec2<Q> {
    /// Both components by the quantity's `from_f64`.
    ///
    /// ```
    /// use tamias2d::{Length, Vec2};
    /// let p = Vec2::<Length>::from_f64(0.5, -2.0)?;
    /// assert_eq!(p.to_f64(), (0.5, -2.0));
    /// # Ok::<(), tamias2d::NumError>(())
    /// ```
    pub fn from_f64(x: f64, y: f64) -> Result<Self, NumError> {
        Ok(Vec2 { x: Q::from_f64(x)?, y: Q::from_f64(y)? })
    }

    /// Both components as the nearest `f64`, for drawing.
    pub fn to_f64(self) -> (f64, f64) {
        (self.x.to_f64(), self.y.to_f64())
    }
}

impl Rot {
    /// (cos, sin) as `f64`, exactly, for drawing.
    pub fn to_f64(self) -> (f64, f64) {
        (f64::from(self.cos) / f64::from(1 << 30), f64::from(self.sin) / f64::from(1 << 30))
    }
}

impl Angle {
    /// An orientation in radians, in [0, 2π], as [`Angle::from_radians`] takes it.
    pub fn from_radians_f64(radians: f64) -> Result<Self, NumError> {
        Ok(Angle::from_radians(Radians::from_f64(radians)?)?)
    }

    /// The unwrapped angle in radians, for drawing.
    pub fn to_radians_f64(self) -> f64 {
        // The fraction goes through the exact reduction, so many turns do not cost its digits.
        let whole = (self.to_bits() >> 48) as i32;
        f64::from(whole) * core::f64::consts::TAU + self.radians().to_f64()
    }
}
