//! One tick.

use crate::World;
use crate::motion::{Fault, integrate};

impl World {
    /// Advances the world by one tick, 1/tick_rate s.
    ///
    /// Never fails, panics or wraps: a value that would leave its range is limited to it, and
    /// [`World::status`] names the body and the quantity. The same state and commands give the same bits on every
    /// machine.
    pub fn step(&mut self) {
        // All of the world: what is not here is not state.
        let World {
            config,
            tick,
            bodies,
            colliders,
            attractors: _,
            pushes,
            contacts,
            status,
            drive,
            touch,
            solver,
            events,
            faults,
            next,
        } = self;

        // Forces of this tick: into the prepared motion, and out of it again below.
        for push in pushes.iter() {
            let slot = push.slot as usize;
            drive.set(slot, bodies.cold.value(slot), config.gravity, Some(push));
        }

        touch.find(bodies, colliders, contacts, drive, solver.scales.margins);
        solver.prepare(touch, contacts, bodies, drive);
        integrate(bodies, drive, faults);
        solver.run(touch, bodies, colliders, contacts, drive, faults);
        touch.finish(contacts, next, colliders, events, |pair| solver.outcome(pair));

        for push in pushes.drain(..) {
            let slot = push.slot as usize;
            drive.push_at[slot] = u32::MAX;
            drive.set(slot, bodies.cold.value(slot), config.gravity, None);
        }
        for Fault { slot, bound } in faults.drain(..) {
            if let Some(body) = bodies.id(slot) {
                status.note(*tick, body, bound);
            }
        }
        *tick = tick.saturating_add(1);
    }
}
