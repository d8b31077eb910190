//! Attractors: fixed points that pull every dynamic body.

use crate::geom::Vec2;
use crate::num::{Length, Mu, Quantity, RangeError};
use crate::store::{Row, record_copy};
use serde::{Deserialize, Serialize};

/// A fixed point that pulls every dynamic body by μ/d² (TM:UniversalGravLaw).
///
/// A body exactly at the point is not pulled. A pull beyond 32 768 m/s² saturates and is noted in the world's status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attractor {
    /// Where it is.
    pub position: Vec2<Length>,
    /// Its gravitational parameter μ = G·M.
    pub mu: Mu,
}

record_copy!(Attractor { position, mu } shown);

impl Row for Attractor {}

impl Attractor {
    /// The attractor itself when its values are accepted.
    pub(crate) fn checked(self) -> Result<Self, RangeError> {
        self.position.checked()?;
        self.mu.checked()?;
        Ok(self)
    }
}
