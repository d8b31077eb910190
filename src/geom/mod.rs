//! Geometry: knows no time and no bodies.

mod rot;
mod vec;

pub use rot::Rot;
pub use vec::Vec2;
