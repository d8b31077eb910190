//! Shapes: convex forms, their outlines and their masses. Knows no bodies and no time.

mod def;
mod hull;
mod mass;
mod outline;
mod surface;

pub use def::{ColliderDef, Filter, Shape, ShapeError};
pub(crate) use mass::MassData;
pub(crate) use outline::{Outline, Placed};

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_mass;
#[cfg(test)]
mod tests_outline;
