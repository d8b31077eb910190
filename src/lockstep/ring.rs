//! The last ticks' states, world and game.

use crate::World;
use crate::rollback::Rollback;

/// The game's own state of a tick, as bytes.
#[derive(Default)]
struct Own {
    tick: u64,
    bytes: Vec<u8>,
}

/// States by tick, the oldest replaced by the newest.
pub(super) struct Ring {
    worlds: Rollback,
    owns: Vec<Own>,
}

impl Ring {
    pub(super) fn new(ticks: u32) -> Self {
        let mut owns = Vec::new();
        owns.resize_with(ticks as usize, Own::default);
        Ring { worlds: Rollback::new(ticks), owns }
    }

    /// How many ticks are kept.
    pub(super) fn len(&self) -> usize {
        self.owns.len()
    }

    fn place(&self, tick: u64) -> usize {
        tick.checked_rem(self.owns.len() as u64).unwrap_or(0) as usize
    }

    /// Keeps a world: its hash, and where the game's own state of that tick is to be written.
    pub(super) fn save(&mut self, world: &World) -> (u64, &mut Vec<u8>) {
        let tick = world.tick();
        self.worlds.save(world);
        let hash = self.worlds.frame(tick).map_or(0, |frame| frame.hash());
        let place = self.place(tick);
        let own = &mut self.owns[place];
        own.tick = tick;
        (hash, &mut own.bytes)
    }

    /// The game's own state at a tick.
    pub(super) fn own(&self, tick: u64) -> Option<&[u8]> {
        self.worlds.frame(tick)?;
        let own = &self.owns[self.place(tick)];
        (own.tick == tick).then_some(&own.bytes)
    }

    /// Makes a world what it was at a tick, if that is kept.
    pub(super) fn restore(&self, world: &mut World, tick: u64) -> bool {
        self.worlds.restore(world, tick).is_ok()
    }
}
