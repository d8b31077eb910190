//! Motion: forces to velocities to positions.
//!
//! [`Drive`] holds what constant acceleration does to each body in one step of the scheme, prepared when commands
//! change it; [`mod@integrate`] holds the schemes, each a list of stages; [`gravity`] is the pull of attractors and
//! bodies.

mod damping;
mod drive;
mod gravity;
mod integrate;
mod span;

pub(crate) use drive::{Drive, Push, acceleration};
pub(crate) use gravity::Source;
pub use integrate::{Bound, Integrator};
pub(crate) use integrate::{Fault, integrate, turn_by};
