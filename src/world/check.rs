//! Every invariant of a world, in words and in code.

use crate::World;
use crate::motion::Drive;
use crate::num::Quantity;

impl World {
    /// Whether every invariant holds: free slots are empty and chained, columns are as long as their slots, values
    /// are in range and fit their body's kind, forces of one tick belong to dynamic bodies, once each, and what
    /// is derived is what deriving it again gives. O(n); for tests and for suspicion.
    ///
    /// Errors: the first broken invariant, in words.
    pub fn check(&self) -> Result<(), String> {
        let World { config, tick: _, bodies, attractors, pushes, status: _, drive, faults } = self;
        self.check_lists()?;
        bodies.check().map_err(|reason| format!("the table of bodies {reason}"))?;
        attractors.check().map_err(|reason| format!("the table of attractors {reason}"))?;
        if !faults.is_empty() {
            return Err("faults of the last step were left over".into());
        }
        let mut fresh = Drive::default();
        fresh.prepare(config.integrator, config.tick_rate, config.substeps, bodies, attractors);
        fresh.index_pushes(pushes);
        for slot in 0..bodies.cold.len() {
            fresh.set(slot, bodies.cold.value(slot), config.gravity, None);
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
        let World { config, bodies, attractors, pushes, status, .. } = self;
        config.check().map_err(|error| error.to_string())?;
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
            if bodies.id(slot).is_none() || !bodies.cold.value(slot).is_dynamic() {
                return Err(format!("a force of this tick acts on slot {slot}, which holds no dynamic body"));
            }
        }
        Ok(())
    }
}
