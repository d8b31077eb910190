//! The flight recorder: evidence of the last ticks, held in memory until somebody asks.

use super::evidence::{Evidence, Origin};
use crate::World;
use crate::store::Draft;
use crate::threads::Threads;

/// Steps a world and keeps evidence of the last ticks, for the day on which an alarm rings some ticks late.
///
/// A tick that is computed again, after a rollback, replaces what was kept of it. Its memory is reused.
///
/// ```
/// use tamias2d::replay::Flight;
/// use tamias2d::{World, WorldDef};
/// let mut world = World::new(&WorldDef::default())?;
/// let mut flight = Flight::new(8);
/// for _ in 0..20 {
///     flight.step(&mut world);
/// }
/// assert!(flight.evidence(12).is_none() && flight.evidence(13).is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct Flight {
    ticks: Vec<Evidence>,
    /// How many of them have been used, and which is the next.
    used: usize,
    next: usize,
    draft: Draft,
}

impl Flight {
    /// Keeps the last `ticks` ticks, at least one.
    pub fn new(ticks: u32) -> Flight {
        let mut flight = Flight::default();
        flight.ticks.resize_with((ticks as usize).max(1), Evidence::default);
        flight
    }

    /// Advances the world by one tick, as [`World::step`], and keeps it.
    pub fn step(&mut self, world: &mut World) {
        self.step_on(world, &Threads::default());
    }

    /// The same by several threads, as [`World::step_on`].
    pub fn step_on(&mut self, world: &mut World, threads: &Threads) {
        if self.ticks.is_empty() {
            return world.step_on(threads);
        }
        let tick = world.tick().saturating_add(1);
        let known = self.ticks[..self.used].iter().position(|kept| kept.tick() == tick);
        let at = known.unwrap_or(self.next);
        self.ticks[at].take(world, &mut self.draft, Origin::Taken, threads);
        if known.is_none() {
            self.next = at.saturating_add(1).checked_rem(self.ticks.len()).unwrap_or(0);
            self.used = self.used.max(at.saturating_add(1));
        }
    }

    /// What was kept of a tick, as the world counts them: of the step that brought it to this tick.
    pub fn evidence(&self, tick: u64) -> Option<&Evidence> {
        self.ticks[..self.used].iter().find(|kept| kept.tick() == tick)
    }

    /// What was kept of the last step.
    pub fn last(&self) -> Option<&Evidence> {
        self.ticks[..self.used].iter().max_by_key(|kept| kept.tick())
    }
}
