//! All that a tick reads from memory, field by field, as tables: state, what is derived from it, and what the stages of a tick
//! leave for each other.

use super::stage::Stage;
use crate::World;
use crate::store::{Draft, Kind, Tables, show};

impl World {
    /// Hands on all of it as it is after a stage, as tables, in an order in which what is first read stands first. What belongs
    /// to an earlier tick is left out: it may be anything.
    pub(crate) fn show(&self, stage: Stage, draft: &mut Draft, tables: &mut impl Tables) {
        struct Clock {
            tick: u64,
        }
        show!(Clock { tick });
        let World {
            config,
            tick,
            bodies,
            colliders,
            attractors,
            pushes,
            contacts,
            resting,
            status,
            drive,
            touch,
            solver,
            // A value of the step, which nothing reads.
            events: _,
            faults,
            // Where contacts are built, empty or the last tick's.
            next: _,
        } = self;
        draft.table(tables, "configuration", Kind::World, core::iter::once(config));
        draft.table(tables, "clock", Kind::World, core::iter::once(Clock { tick: *tick }));
        bodies.show((Stage::Sort..=Stage::Release).contains(&stage), draft, tables);
        colliders.show(draft, tables);
        attractors.show(draft, tables, ["attractors", "slots of attractors"], Kind::Attractor);
        draft.table(tables, "forces", Kind::OfBody, pushes.iter());
        contacts.show(draft, tables, "contacts");
        resting.show(draft, tables);
        draft.table(tables, "status", Kind::List, status.entries().iter());
        drive.show(draft, tables);
        solver.show(draft, tables);
        if (Stage::Find..=Stage::Release).contains(&stage) {
            touch.show(draft, tables);
        }
        if (Stage::Prepare..=Stage::Release).contains(&stage) {
            solver.show_tick(touch, draft, tables);
        }
        if (Stage::Integrate..Stage::Close).contains(&stage) {
            draft.table(tables, "faults", Kind::OfBody, faults.iter());
        }
    }
}
