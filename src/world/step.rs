//! One tick.

use super::sleep::Sleepers;
use crate::World;
use crate::contact::name;
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
            resting,
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

        resting.settle(contacts, bodies, colliders);
        bodies.rest.settle();
        for attempt in 0.. {
            touch.find(bodies, colliders, contacts, drive, solver.scales.margins);
            solver.prepare(touch, contacts, bodies, drive);
            bodies.remember(&mut resting.before);
            integrate(bodies, drive, faults);
            solver.run(touch, bodies, colliders, contacts, drive, faults);
            // A tick that touches what sleeps is computed anew, with that awake.
            let mut sleepers = Sleepers { bodies, colliders, contacts, resting, touch, drive, gravity: config.gravity };
            if !sleepers.wake_touched(solver, attempt) {
                break;
            }
            faults.clear();
        }
        touch.finish(contacts, next, colliders, events, |pair| solver.outcome(pair));

        for push in pushes.drain(..) {
            let slot = push.slot as usize;
            drive.push_at[slot] = u32::MAX;
            drive.set(slot, bodies.cold.value(slot), config.gravity, None);
        }
        if let Some(sleeping) = config.sleeping {
            let limits = sleeping.limits(config.tick_rate, config.unit_shift);
            for slot in solver.shifted(limits.0) {
                if !bodies.rest.is_asleep(slot) {
                    bodies.rest.note(slot, 0);
                }
            }
            Sleepers { bodies, colliders, contacts, resting, touch, drive, gravity: config.gravity }.lull_quiet(limits);
        }
        for Fault { slot, bound } in faults.drain(..) {
            if let Some(body) = bodies.id(slot) {
                status.note(*tick, body, bound);
            }
        }
        name(*tick, events, solver.collisions_mut(), &mut resting.found);
        *tick = tick.saturating_add(1);
    }
}
