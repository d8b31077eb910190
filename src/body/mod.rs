//! Bodies and their colliders: pure data. It moves nothing.

mod attractor;
mod bodies;
mod colliders;
mod def;
mod rest;

pub use attractor::Attractor;
pub(crate) use bodies::{Bodies, Motion};
pub(crate) use colliders::{Collider, Colliders, center_at, origin_of};
pub(crate) use def::{BodyData, gyration};
pub use def::{BodyDef, BodyError, BodyKind};
pub(crate) use rest::Rest;
pub use rest::Sleeping;
