//! How the surfaces of two colliders become one contact's.

use crate::num::{Friction, Restitution, sqrt};

impl Restitution {
    /// That of a contact of two surfaces: the larger one, so it stays within 0 … 1 and two equal ones give their own.
    pub fn combine(self, other: Restitution) -> Restitution {
        self.max(other)
    }
}

impl Friction {
    /// That of a contact of two surfaces: their geometric mean, so a surface without friction has none with any other and
    /// two equal ones give their own, exactly.
    ///
    /// Rounding: nearest. Range: both are accepted frictions, so not negative.
    pub fn combine(self, other: Friction) -> Friction {
        // What nearly all pairs are: a root of 128 bits would take longer than a row.
        if self == other {
            return self;
        }
        let product = u128::from(self.to_bits().unsigned_abs()).saturating_mul(other.to_bits().unsigned_abs().into());
        Friction::from_bits(sqrt(product) as i64)
    }
}
