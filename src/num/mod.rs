//! Numbers: one fixed-point format per quantity, one rounding and overflow policy.
//!
//! # Range table
//!
//! | type | format | unit | accepted | resolution |
//! |---|---|---|---|---|
//! | [`Length`] | `I32F32` | m | ±1e9 | 2.3e-10 |
//! | [`Velocity`] | `I16F48` | m/s | ±(32 768 − 2⁻⁴⁸) | 3.6e-15 |
//! | [`AngularVelocity`] | `I16F48` | rad/s | ±(32 768 − 2⁻⁴⁸) | 3.6e-15 |
//! | [`Acceleration`] | `I16F48` | m/s² | ±(32 768 − 2⁻⁴⁸) | 3.6e-15 |
//! | [`Angle`] | `I16F48` | turns | ±(32 768 − 2⁻⁴⁸) | 3.6e-15 (2.2e-14 rad) |
//! | [`Radians`] | `I16F48` | rad | ±(32 768 − 2⁻⁴⁸) | 3.6e-15 |
//! | [`Time`] | `I16F48` | s | ±32 768 | 3.6e-15 |
//! | [`Mass`] | `I64F64` | kg | 1e-6 … 2.1e9 | 5.4e-20 |
//! | [`Inertia`] | `I64F64` | kg m² | 1e-12 … 1e18 | 5.4e-20 |
//! | [`Force`] | `I64F64` | N | ±1e14 | 5.4e-20 |
//! | [`Torque`] | `I64F64` | N m | ±1e18 | 5.4e-20 |
//! | [`Impulse`] | `I64F64` | N s | ±1e14 | 5.4e-20 |
//! | [`AngularImpulse`] | `I64F64` | N m s | ±1e18 | 5.4e-20 |
//! | [`Damping`] | `I16F48` | 1/s | 0 … 1000 | 3.6e-15 |
//! | [`Density`] | `I64F64` | kg/m² | 1e-9 … 1e12 | 5.4e-20 |
//! | [`Restitution`] | `I16F48` | 1 | 0 … 1 | 3.6e-15 |
//! | [`Friction`] | `I16F48` | 1 | 0 … 100 | 3.6e-15 |
//! | [`Mu`] | `U72F56` | m³/s² | 0 … 2e21 | 1.4e-17 |
//! | [`Energy`] | `I64F64` | J | an output; saturates at ±9.2e18 | 5.4e-20 |
//! | [`geom::Rot`](crate::geom::Rot) | `I2F30` | 1 | −1 … 1 | 9.3e-10 |
//!
//! # Policy
//!
//! * **Rounding**: to nearest, ties away from zero. It is odd, op(−x) = −op(x), so a scene turned by half a turn
//!   gives the negated bits. Reading decimal text and `f64` rounds ties to even, which is odd as well.
//! * **Overflow**: nothing wraps and nothing panics. A kernel saturates at ±MAX (the extra negative value of two's
//!   complement is never produced), and what the step saturates, the world's [`Status`](crate::Status) names.
//! * **Operators**: the quantity types have none. `fixed`'s own operators panic in debug builds, wrap in release
//!   builds, floor (`*`) and truncate (`/`); the functions of this module are used instead.
//!
//! The kernels are public: game code that must agree bit for bit on every machine needs them as much as the engine.
#![allow(
    clippy::arithmetic_side_effects,
    reason = "this module is where arithmetic is defined; each kernel argues why it cannot overflow"
)]

mod angle;
pub mod decimal;
pub(crate) mod envelope;
pub(crate) mod flat;
mod float;
pub(crate) mod lane;
mod quantity;
mod root;
mod round;
#[cfg(test)]
mod tests;
mod trig;
mod wide;

pub(crate) use angle::TURN_PER_RADIAN_Q64;
pub use decimal::Decimal;
pub use float::FromF64;
pub use quantity::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Density, Energy, Force, Friction, Impulse, Inertia,
    Length, Mass, Mu, NumError, Quantity, Radians, RangeError, Restitution, Time, Torque, Velocity,
};
pub use root::{hypot, sqrt};
pub use round::{add_sat, clamp_i64, cross, div, dot, mul, mul_add, round_shift};
pub use trig::{atan2, sin_cos};
pub use wide::{cross_wide, mul_div};
