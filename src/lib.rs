#![doc = include_str!("../README.md")]
//!
//! # Map
//!
//! Each floor uses those above it in this list only.
//!
//! | module | what |
//! |---|---|
//! | [`num`] | quantity types, the one rounding and overflow policy, roots and trigonometry |
//! | [`geom`] | vectors and rotations |
//! | `store` | bytes, field lists, columns, slots with generations |
//! | `body` | what bodies and attractors are |
//! | `motion` | integrators, gravity, damping |
//! | `world` | the world, its step, its commands |
//! | `snapshot` | save, load, hash, diff |
//! | [`replay`] | recording, playing, verifying |
#![forbid(unsafe_code)]
#![deny(missing_docs, clippy::arithmetic_side_effects)]

mod body;
pub mod geom;
mod motion;
pub mod num;
pub mod replay;
#[cfg(feature = "scene")]
pub mod scene;
mod snapshot;
mod store;
mod world;

pub use body::{Attractor, BodyDef, BodyError, BodyKind};
pub use geom::{Rot, Vec2};
pub use num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Energy, Force, Impulse, Inertia, Length, Mass, Mu,
    NumError, Radians, RangeError, Torque, Velocity,
};
pub use snapshot::{HashPart, LAW, SAVE_VERSION};
pub use store::{AttractorId, BodyId, DecodeError, Difference};
pub use world::{
    Body, Bound, Command, CommandError, Commands, ConfigError, INPUT_MAX, Integrator, Reply, Status, StatusEntry,
    World, WorldDef,
};
