//! Recording: a world, and a file of everything that is done to it.

use super::format::{RecordWriter, tag};
use crate::World;
use crate::store::Record;
use crate::world::{Command, CommandError, Commands, Reply};
use std::io::{self, Write};

/// A world whose commands and ticks are recorded.
///
/// It owns the world, so nothing reaches it unrecorded: commands go through [`Commands`], ticks through
/// [`Recorder::step`]. Dropped without [`Recorder::finish`], it leaves a file that is cut off but plays.
///
/// ```
/// use tamias2d::replay::{Player, Recorder};
/// use tamias2d::{BodyDef, Commands, Vec2, World, WorldDef};
///
/// let mut game = Recorder::new(World::new(&WorldDef::default())?, Vec::new())?;
/// let ship = game.create_body(&BodyDef::default())?;
/// for _ in 0..10 {
///     game.input(b"thrust".to_vec())?;
///     game.apply_force(ship, Vec2::from_f64(3.0, 0.0)?, None)?;
///     game.step();
/// }
/// let file = game.finish()?;
/// let played = Player::new(file.as_slice())?.verify()?;
/// assert_eq!(played.ticks, 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Recorder<W> {
    world: World,
    writer: RecordWriter<W>,
    /// The commands since the last tick, encoded after room for a hash.
    pending: Vec<u8>,
    ticks: u64,
    /// The first error of the destination; nothing is written after it.
    error: Option<io::Error>,
}

/// Room for the hash in front of a tick's commands.
const HASH: usize = 8;

impl<W: Write> Recorder<W> {
    /// Starts a recording at the world's present state.
    ///
    /// `out` gets a small write per tick: give it a `BufWriter`. Errors: those of writing.
    pub fn new(world: World, out: W) -> io::Result<Self> {
        let mut writer = RecordWriter::new(out, world.config().tick_rate)?;
        writer.record(tag::WORLD, &world.save())?;
        Ok(Recorder { world, writer, pending: vec![0; HASH], ticks: 0, error: None })
    }

    /// The world, to look at.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Advances the world by one tick and records it.
    ///
    /// Never fails: where writing does, the simulation goes on, and [`Recorder::error`] and [`Recorder::finish`]
    /// say so.
    pub fn step(&mut self) {
        self.world.step();
        self.ticks = self.ticks.saturating_add(1);
        self.write(if self.pending.len() == HASH { tag::IDLE } else { tag::TICK });
    }

    /// Writes what happened since the last record under `tag`.
    fn write(&mut self, tag: u8) {
        self.pending[..HASH].copy_from_slice(&self.world.hash().to_le_bytes());
        if self.error.is_none() {
            self.error = self.writer.record(tag, &self.pending).err();
        }
        self.pending.truncate(HASH);
    }

    /// The first error of writing, if there was one; the file ends there.
    pub fn error(&self) -> Option<&io::Error> {
        self.error.as_ref()
    }

    /// Ends the recording. Commands after the last tick are recorded without one. Errors: the first of writing.
    pub fn finish(mut self) -> io::Result<W> {
        if self.pending.len() > HASH {
            self.write(tag::TAIL);
        }
        match self.error {
            Some(error) => Err(error),
            None => self.writer.end(self.ticks),
        }
    }
}

impl<W: Write> Commands for Recorder<W> {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        let length = self.pending.len();
        command.save(&mut self.pending);
        let reply = self.world.apply(command);
        if reply.is_err() {
            self.pending.truncate(length);
        }
        reply
    }
}
