#![doc = include_str!("../README.md")]
//!
//! # Map
//!
//! Each floor uses those above it in this list only.
//!
//! | module | what |
//! |---|---|
//! | [`num`] | quantity types, the one rounding and overflow policy, roots and trigonometry |
//! | [`geom`] | vectors, rotations, boxes |
//! | `threads` | how loops are cut up for several threads (feature `threads`) |
//! | `store` | bytes, field lists, columns, slots with generations |
//! | `shape` | convex forms, their outlines and masses |
//! | `body` | what bodies, colliders and attractors are |
//! | `motion`, `broad`, `narrow` | integrators, gravity, damping; who might touch; where two outlines touch |
//! | `contact` | pairs, impulses that last, events |
//! | `solver` | the contact rows, impacts |
//! | `world` | the world, its step, its commands, its queries |
//! | `snapshot` | save, load, hash, diff, frames |
//! | `rollback` | the last ticks, to go back to |
//! | [`replay`] | recording, playing, verifying |
//! | [`hello`] | whether two peers compute the same, asked before a session |
//! | `lockstep` | lockstep and rollback sessions over a network (feature `ggrs`) |
//! | [`guide`] | chapters: what is promised, and why |
// Allowed in solver/avx2.rs and solver/avx512.rs alone.
#![deny(unsafe_code, clippy::undocumented_unsafe_blocks)]
#![deny(missing_docs, clippy::arithmetic_side_effects)]

mod body;
mod broad;
mod contact;
pub mod geom;
pub mod guide;
pub mod hello;
#[cfg(feature = "ggrs")]
pub mod lockstep;
mod motion;
mod narrow;
pub mod num;
pub mod replay;
mod rollback;
#[cfg(feature = "scene")]
pub mod scene;
mod shape;
mod snapshot;
mod solver;
mod store;
mod threads;
mod world;

pub use body::{Attractor, BodyDef, BodyError, BodyKind};
pub use contact::{Collision, Event, EventId, EventKind, Pace};
pub use geom::{Aabb, Rot, Vec2};
pub use num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Density, Energy, Force, Friction, Impulse, Inertia,
    Length, Mass, Mu, NumError, Radians, RangeError, Restitution, Time, Torque, Velocity,
};
pub use rollback::{EventLog, Rollback, RollbackError, Sorted, Told};
pub use shape::{ColliderDef, Filter, Shape, ShapeError};
pub use snapshot::{Frame, FrameError, HashPart, LAW, SAVE_VERSION};
pub use solver::{Impact, ImpactError, Striker, impact};
pub use store::{AttractorId, BodyId, ColliderId, DecodeError, Difference};
pub use threads::Threads;
#[cfg(feature = "threads")]
pub use threads::ThreadsError;
pub use world::{
    Body, Bound, ClosestPoint, Collider, Command, CommandError, Commands, ConfigError, INPUT_MAX, Integrator, RayHit,
    Reply, Sleeping, Stage, Status, StatusEntry, World, WorldDef,
};
