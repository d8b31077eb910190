//! Every invariant of a world, in words and in code.

use crate::World;
use crate::body::BodyData;
use crate::motion::Drive;
use crate::num::Quantity;
use crate::solver::{Mobility, Scales};

impl World {
    /// Whether every invariant holds: free slots are empty and chained, columns are as long as their slots, values
    /// are in range and fit their body's kind, forces of one tick belong to dynamic bodies, once each, and what
    /// is derived is what deriving it again gives. O(n); for tests and for suspicion.
    ///
    /// Errors: the first broken invariant, in words.
    pub fn check(&self) -> Result<(), String> {
        let World { config, bodies, colliders, attractors, pushes, contacts, resting, .. } = self;
        let World { drive, touch, solver, faults, .. } = self;
        self.check_lists()?;
        bodies.check().map_err(|reason| format!("the table of bodies {reason}"))?;
        colliders.check().map_err(|reason| format!("the table of colliders {reason}"))?;
        attractors.check().map_err(|reason| format!("the table of attractors {reason}"))?;
        resting.check(contacts, bodies, colliders).map_err(|reason| format!("the list of what sleeps {reason}"))?;
        touch.check(bodies, colliders).map_err(|reason| format!("the broad phase {reason}"))?;
        if !faults.is_empty() {
            return Err("faults of the last step were left over".into());
        }
        let (mut fresh, still) = (Drive::default(), BodyData::default());
        fresh.prepare(config.integrator, config.tick_rate, config.substeps, bodies, attractors);
        fresh.index_pushes(pushes);
        for slot in 0..bodies.cold.len() {
            let driven = if bodies.rest.is_asleep(slot) { &still } else { bodies.cold.value(slot) };
            fresh.set(slot, driven, config.gravity, None);
        }
        let mobilities: Vec<_> = (0..bodies.cold.len()).map(|slot| Mobility::new(bodies.cold.value(slot))).collect();
        let scales = Scales::new(config.tick_rate, config.substeps, config.unit_shift);
        if mobilities != solver.mobilities || scales != solver.scales {
            return Err("the prepared solver does not follow from the state".into());
        }
        // Where carried sources were at the last evaluation does not matter: each evaluation moves them first.
        let mut present = drive.clone();
        present.follow(bodies);
        fresh.follow(bodies);
        if fresh != present {
            return Err("the prepared motion does not follow from the state".into());
        }
        Ok(())
    }

    /// What is left to check of a world whose tables were read and are sound in themselves: the configuration, and
    /// the lists that refer to bodies. The first broken invariant, in words.
    pub(crate) fn check_lists(&self) -> Result<(), String> {
        let World { config, bodies, colliders, attractors, pushes, contacts, resting, status, .. } = self;
        config.check().map_err(|error| error.to_string())?;
        let limits = config.sleeping.map(|sleeping| sleeping.limits(config.tick_rate, config.unit_shift));
        if bodies.rest.len() != limits.map_or(0, |_| bodies.cold.len()) {
            return Err("the table of bodies says who sleeps where nobody can, or does not".into());
        }
        if (0..bodies.rest.len()).any(|slot| bodies.rest.quiet(slot) > limits.map_or(0, |(_, ticks)| ticks)) {
            return Err("a body has been quiet for longer than is counted".into());
        }
        contacts.check().map_err(|reason| format!("the list of contacts {reason}"))?;
        if config.sleeping.is_none() && resting.contacts.len() > 0 {
            return Err("there are contacts of what sleeps where nobody can".into());
        }
        // Each collider belongs to exactly one body's list, and to the body that it says.
        let mut listed = 0u32;
        for (slot, data) in bodies.cold.iter() {
            let mut reach = 0;
            let mut next = data.first;
            while let Some(at) = next {
                let row = (colliders.rows.generation(at as usize)).map(|_| colliders.rows.value(at as usize));
                let Some(row) = row.filter(|row| row.body as usize == slot && listed < colliders.rows.live()) else {
                    return Err(format!("the colliders of slot {slot} are not its own"));
                };
                if colliders.forms.value(row.form as usize).center != data.center {
                    return Err(format!("a collider of slot {slot} has a form about another centre"));
                }
                if !row.sensor {
                    reach = reach.max(colliders.outline(at as usize).reach);
                }
                listed = listed.saturating_add(1);
                next = row.next;
            }
            if data.reach.to_bits() != reach {
                return Err(format!("the reach of slot {slot} is not that of its colliders"));
            }
        }
        if listed != colliders.rows.live() {
            return Err("a collider belongs to no body".into());
        }
        status.check().map_err(|reason| format!("the table of status entries {reason}"))?;
        for (_, attractor) in attractors.iter() {
            attractor.checked().map_err(|error| error.to_string())?;
        }
        let mut slots: Vec<u32> = pushes.iter().map(|push| push.slot).collect();
        slots.sort_unstable();
        if !slots.is_sorted_by(|a, b| a < b) {
            return Err("the forces of this tick name a body twice".into());
        }
        for push in pushes {
            let slot = push.slot as usize;
            push.force.checked().map_err(|error| error.to_string())?;
            push.torque.checked().map_err(|error| error.to_string())?;
            if bodies.rest.is_asleep(slot) {
                return Err(format!("a force of this tick acts on slot {slot}, which sleeps"));
            }
            if bodies.id(slot).is_none() || !bodies.cold.value(slot).is_dynamic() {
                return Err(format!("a force of this tick acts on slot {slot}, which holds no dynamic body"));
            }
        }
        Ok(())
    }
}
