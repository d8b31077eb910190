//! Geometry: knows no time and no bodies.

mod aabb;
mod rot;
mod vec;

pub use aabb::Aabb;
pub use rot::Rot;
pub use vec::Vec2;
