//! The last ticks of a world, to go back to: what a rollback game saves each tick.

mod log;

use crate::World;
use crate::snapshot::{Digests, Frame, Tables};
use core::fmt;
pub use log::{EventLog, Sorted, Told};

/// A ring of frames, and the tables that belong to them: one copy for each version of the tables, and a version begins when a command has
/// changed one. So bodies, colliders and attractors that were created after a save are gone when that is restored, those destroyed
/// are back, and the same commands give out the same ids again.
///
/// All memory is used again: once the ring has gone round, a save allocates nothing while the world does not grow.
///
/// ```
/// use tamias2d::{BodyDef, Commands, Rollback, World, WorldDef};
/// let mut world = World::new(&WorldDef::default())?;
/// let mut ring = Rollback::new(8);
/// for _ in 0..3 {
///     ring.save(&world);
///     world.step();
/// }
/// let late = world.create_body(&BodyDef::default())?;
/// // What a player did in tick 1 arrives: back to where that tick began, and on with it.
/// ring.restore(&mut world, 1)?;
/// assert!(world.body(late).is_none());
/// while world.tick() < 3 {
///     ring.save(&world);
///     world.step();
/// }
/// assert_eq!(world.create_body(&BodyDef::default())?, late);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Rollback {
    /// As many as the ring has; those in use from `first` on, in order of their ticks.
    held: Vec<Held>,
    first: usize,
    count: usize,
    versions: Vec<Version>,
}

/// A frame and the place of its tables among the versions.
#[derive(Debug, Default)]
struct Held {
    frame: Frame,
    version: usize,
}

/// Tables, and how many frames have them; none: memory to use again.
#[derive(Debug, Default)]
struct Version {
    tables: Tables,
    frames: usize,
}

/// Why a tick cannot be gone back to. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RollbackError {
    /// Nothing has been saved.
    Empty {
        /// The tick that was asked for.
        asked: u64,
    },
    /// A tick that is not among those held.
    NotHeld {
        /// The tick that was asked for.
        asked: u64,
        /// The first tick that is held.
        oldest: u64,
        /// The last.
        newest: u64,
    },
}

impl fmt::Display for RollbackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RollbackError::Empty { asked } => write!(f, "tick {asked} is not held: no tick has been saved"),
            RollbackError::NotHeld { asked, oldest, newest } => {
                write!(f, "tick {asked} is not held: those held are of {oldest} … {newest}")
            }
        }
    }
}

impl core::error::Error for RollbackError {}

impl Rollback {
    /// A ring of `frames` ticks, one at least: as many as there may be between a tick and the last one that all inputs
    /// are known of, and one.
    pub fn new(frames: u32) -> Self {
        let mut held = Vec::new();
        held.resize_with((frames as usize).max(1), Held::default);
        Rollback { held, first: 0, count: 0, versions: Vec::new() }
    }

    /// Holds a world's tick, in place of the oldest if the ring is full. Ticks from this one on that were held before are
    /// forgotten: they belong to a future that is being computed anew.
    pub fn save(&mut self, world: &World) {
        while self.newest().is_some_and(|newest| newest >= world.tick()) {
            self.count = self.count.saturating_sub(1);
            self.let_go(self.place(self.count));
        }
        if self.count == self.held.len() {
            self.let_go(self.first);
            self.first = self.place(1);
            self.count = self.count.saturating_sub(1);
        }
        let digests = Digests::of(world);
        let version = self.version_of(world, digests);
        let place = self.place(self.count);
        let held = &mut self.held[place];
        held.version = version;
        world.save_frame_of(&mut held.frame, digests);
        self.count = self.count.saturating_add(1);
    }

    /// Takes a world to a tick that is held; from there on it gives the bits that it gave then, with the same commands.
    /// Whatever the world was before, it is the one that was saved. Ticks that were held still are.
    ///
    /// Errors: a tick that is not held.
    pub fn restore(&self, world: &mut World, tick: u64) -> Result<(), RollbackError> {
        let Some(Held { frame, version }) = self.find(tick) else {
            return Err(match (self.oldest(), self.newest()) {
                (Some(oldest), Some(newest)) => RollbackError::NotHeld { asked: tick, oldest, newest },
                _ => RollbackError::Empty { asked: tick },
            });
        };
        let tables = &self.versions[*version].tables;
        let other = tables.digests() != Digests::of(world);
        world.go_to(frame, other.then_some(tables));
        Ok(())
    }

    /// The frame of a tick, if it is held: for its hash, or to send it.
    pub fn frame(&self, tick: u64) -> Option<&Frame> {
        self.find(tick).map(|held| &held.frame)
    }

    /// The first tick that is held.
    pub fn oldest(&self) -> Option<u64> {
        self.iter().next().map(|held| held.frame.tick())
    }

    /// The last tick that is held.
    pub fn newest(&self) -> Option<u64> {
        let last = self.count.checked_sub(1)?;
        Some(self.held[self.place(last)].frame.tick())
    }

    /// How many ticks the ring has room for.
    pub fn capacity(&self) -> u32 {
        self.held.len() as u32
    }

    /// Forgets all ticks, and keeps the memory.
    pub fn clear(&mut self) {
        self.count = 0;
        self.versions.iter_mut().for_each(|version| version.frames = 0);
    }

    fn iter(&self) -> impl Iterator<Item = &Held> {
        (0..self.count).map(|at| &self.held[self.place(at)])
    }

    fn find(&self, tick: u64) -> Option<&Held> {
        self.iter().find(|held| held.frame.tick() == tick)
    }

    /// Where the frame is that is so many after the first.
    fn place(&self, at: usize) -> usize {
        self.first.saturating_add(at).checked_rem(self.held.len()).unwrap_or(0)
    }

    fn let_go(&mut self, place: usize) {
        let version = &mut self.versions[self.held[place].version];
        version.frames = version.frames.saturating_sub(1);
    }

    /// The version that a world's tables are, for one more frame; a copy of them if there is none.
    fn version_of(&mut self, world: &World, digests: Digests) -> usize {
        let known = |version: &Version| version.tables.digests() == digests;
        let at = self.versions.iter().position(known).unwrap_or_else(|| {
            let spare = self.versions.iter().position(|version| version.frames == 0);
            let at = spare.unwrap_or_else(|| {
                self.versions.push(Version::default());
                self.versions.len().saturating_sub(1)
            });
            self.versions[at].tables.copy_from(world, digests);
            at
        });
        let version = &mut self.versions[at];
        version.frames = version.frames.saturating_add(1);
        at
    }
}
