//! Looking at colliders.

use crate::World;
use crate::num::{Friction, Restitution};
use crate::shape::{ColliderDef, Filter};
use crate::store::{BodyId, ColliderId};

/// A collider of a world, to look at.
#[derive(Clone, Copy)]
pub struct Collider<'w> {
    pub(super) world: &'w World,
    pub(super) slot: usize,
}

impl Collider<'_> {
    /// Its id.
    pub fn id(&self) -> ColliderId {
        self.world.colliders.id(self.slot)
    }

    /// Its body.
    pub fn body(&self) -> BodyId {
        let slot = self.world.colliders.rows.value(self.slot).body as usize;
        BodyId { index: slot as u32, generation: self.world.bodies.cold.generation(slot).unwrap_or(u32::MAX) }
    }

    /// Everything about it, as it could be created anew.
    pub fn def(&self) -> ColliderDef {
        self.world.colliders.def(self.slot)
    }

    /// What it meets.
    pub fn filter(&self) -> Filter {
        self.world.colliders.rows.value(self.slot).filter
    }

    /// C_R.
    pub fn restitution(&self) -> Restitution {
        self.world.colliders.rows.value(self.slot).restitution
    }

    /// The coefficient of friction.
    pub fn friction(&self) -> Friction {
        self.world.colliders.rows.value(self.slot).friction
    }

    /// Whether it only reports overlaps.
    pub fn is_sensor(&self) -> bool {
        self.world.colliders.rows.value(self.slot).sensor
    }
}
