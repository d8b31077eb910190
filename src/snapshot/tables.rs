//! What of a world only commands change, and becoming a world with other tables than one has.

use crate::World;
use crate::body::{Attractor, BodyData, Colliders};
use crate::geom::Vec2;
use crate::num::{Acceleration, Mu};
use crate::solver::{Mobility, Scales};
use crate::store::{Arena, Hasher, Record, clone_fields, record_copy};
use crate::world::WorldDef;

/// The digests of a world's tables: worlds that agree in them differ by what ticks change alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Digests {
    configuration: u64,
    bodies: u64,
    colliders: u64,
    attractors: u64,
}

record_copy!(Digests { configuration, bodies, colliders, attractors });

impl Digests {
    /// At the cost of four small hashes: commands keep those of the tables.
    pub(crate) fn of(world: &World) -> Digests {
        let World { config, bodies, colliders, attractors, .. } = world;
        let mut configuration = Hasher::new();
        config.save(&mut configuration);
        Digests {
            configuration: configuration.finish(),
            bodies: bodies.cold.hash(),
            colliders: colliders.hash(),
            attractors: attractors.hash(),
        }
    }

    /// The first table that differs, with both digests.
    pub(super) fn difference(&self, other: &Digests) -> Option<(&'static str, u64, u64)> {
        let Digests { configuration, bodies, colliders, attractors } = *self;
        let both = [
            ("configuration", configuration, other.configuration),
            ("bodies", bodies, other.bodies),
            ("colliders", colliders, other.colliders),
            ("attractors", attractors, other.attractors),
        ];
        both.into_iter().find(|(_, one, other)| one != other)
    }

    /// The parts of the state's hash that tables have alone: bodies, colliders, attractors.
    pub(super) fn parts(&self) -> [u64; 3] {
        [self.bodies, self.colliders, self.attractors]
    }
}

/// A copy of a world's tables.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    digests: Digests,
    config: WorldDef,
    bodies: Arena<BodyData>,
    colliders: Colliders,
    attractors: Arena<Attractor>,
}

clone_fields!(Tables { digests, config, bodies, colliders, attractors });

impl Tables {
    /// What they were copied of.
    pub(crate) fn digests(&self) -> Digests {
        self.digests
    }

    /// Copies those of a world, of which these are the digests.
    pub(crate) fn copy_from(&mut self, world: &World, digests: Digests) {
        let World { config, bodies: from, colliders: shapes, attractors: pull, .. } = world;
        let Tables { digests: known, config: constants, bodies, colliders, attractors } = self;
        *known = digests;
        constants.clone_from(config);
        bodies.clone_from(&from.cold);
        colliders.clone_from(shapes);
        attractors.clone_from(pull);
    }

    /// Gives a world these tables, while what a tick changes is still the old. The slots of bodies of which something has changed go to
    /// `changed`, for [`Change::derive`] to go on with when the rest is as it shall be.
    pub(super) fn copy_to(&self, world: &mut World, changed: &mut Vec<u32>) -> Change {
        let Tables { digests: _, config, bodies, colliders, attractors } = self;
        let pulls = |arena: &Arena<BodyData>, slot: usize| slot < arena.len() && arena.value(slot).mu != Mu::ZERO;
        let mut change = Change {
            config: world.config != *config,
            motion: world.config != *config || world.attractors.differing(attractors).next().is_some(),
        };
        for slot in world.bodies.cold.differing(bodies) {
            changed.push(slot as u32);
            change.motion |= pulls(&world.bodies.cold, slot) || pulls(bodies, slot);
        }
        let World { colliders: present, touch, .. } = world;
        present.turn_into(colliders, |slot, row| match row {
            Some(row) => changed.push(row.body),
            None => touch.remove(slot),
        });
        // Before their slots go.
        for slot in bodies.len()..world.bodies.cold.len() {
            world.drive.set(slot, &BodyData::default(), Vec2::<Acceleration>::default(), None);
        }
        world.drive.grow(bodies.len());
        world.solver.mobilities.resize(bodies.len(), Mobility::default());
        world.config.clone_from(config);
        world.bodies.cold.clone_from(bodies);
        world.attractors.clone_from(attractors);
        change
    }
}

/// What has to be derived anew for tables that were given to a world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    config: bool,
    motion: bool,
}

impl Change {
    /// Nothing.
    pub(super) const NONE: Change = Change { config: false, motion: false };

    /// Derives everything about bodies that changed, fell asleep, woke, or stay elsewhere.
    pub(super) fn derive(self, world: &mut World, changed: &[u32]) {
        if self.config {
            let World { config, solver, .. } = world;
            solver.scales = Scales::new(config.tick_rate, config.substeps, config.unit_shift);
        }
        if self.motion {
            world.prepare_motion();
        }
        let slots = world.bodies.cold.len();
        for slot in changed.iter().map(|&slot| slot as usize).filter(|&slot| slot < slots) {
            if !self.motion {
                world.refresh(slot);
            }
            world.place(slot);
        }
    }
}
