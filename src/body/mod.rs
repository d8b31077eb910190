//! Bodies: pure data. It moves nothing.

mod attractor;
mod bodies;
mod def;

pub use attractor::Attractor;
pub(crate) use bodies::Bodies;
pub(crate) use def::BodyData;
pub use def::{BodyDef, BodyError, BodyKind};
