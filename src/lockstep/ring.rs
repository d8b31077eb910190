//! The last ticks' states, world and game.

use crate::World;

/// What is kept of one tick.
struct Kept {
    world: World,
    own: Vec<u8>,
}

/// States by tick, the oldest replaced by the newest.
pub(super) struct Ring {
    kept: Vec<Option<Kept>>,
}

impl Ring {
    pub(super) fn new(ticks: u32) -> Self {
        Ring { kept: (0..ticks).map(|_| None).collect() }
    }

    /// How many ticks are kept.
    pub(super) fn len(&self) -> usize {
        self.kept.len()
    }

    fn place(&self, tick: u64) -> usize {
        tick.checked_rem(self.kept.len() as u64).unwrap_or(0) as usize
    }

    fn at(&self, tick: u64) -> Option<&Kept> {
        self.kept.get(self.place(tick))?.as_ref().filter(|kept| kept.world.tick() == tick)
    }

    /// Keeps a world; where the game's own state of that tick is to be written.
    pub(super) fn save(&mut self, world: &World) -> &mut Vec<u8> {
        let place = self.place(world.tick());
        let kept = self.kept[place].get_or_insert_with(|| Kept { world: world.clone(), own: Vec::new() });
        kept.world.clone_from(world);
        &mut kept.own
    }

    /// The game's own state at a tick.
    pub(super) fn own(&self, tick: u64) -> Option<&[u8]> {
        Some(&self.at(tick)?.own)
    }

    /// Makes a world what it was at a tick, if that is kept.
    pub(super) fn restore(&self, world: &mut World, tick: u64) -> bool {
        let kept = self.at(tick);
        if let Some(kept) = kept {
            world.clone_from(&kept.world);
        }
        kept.is_some()
    }
}
