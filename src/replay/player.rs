//! Playing: the recorded world, its commands, and a comparison after every tick.

use super::error::ReplayError;
use super::format::{Found, RecordReader, tag};
use crate::World;
use crate::store::{Reader, Record};
use crate::world::{Command, Commands};
use std::io::Read;

/// What a replay amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The ticks.
    pub ticks: u64,
    /// The commands.
    pub commands: u64,
    /// The hash of the last state.
    pub hash: u64,
}

/// A tick as recorded, or the commands after the last one.
struct Recorded {
    offset: u64,
    is_tick: bool,
    hash: u64,
}

/// Plays a replay tick by tick, and compares the hash of the complete state after each.
pub struct Player<R> {
    records: RecordReader<R>,
    world: World,
    ticks: u64,
    commands: u64,
    /// Whether the record read last is a tick or the tail, so that its payload has commands.
    has_commands: bool,
    had_tail: bool,
    finished: bool,
}

impl<R: Read> Player<R> {
    /// Opens a replay and loads its initial world.
    ///
    /// `input` is read in small pieces: give it a `BufReader` or a slice. Errors: the header or the initial world.
    pub fn new(input: R) -> Result<Self, ReplayError> {
        let mut records = RecordReader::new(input)?;
        let offset = loop {
            match records.next()? {
                Found::Record { tag: tag::WORLD, offset } => break offset,
                Found::Record { tag: tag::ANCILLARY.., .. } => {}
                Found::Record { tag: tag::IDLE | tag::TICK | tag::TAIL, offset } => {
                    return Err(ReplayError::Corrupt { tick: 0, offset, reason: "there is a tick before the world" });
                }
                Found::Record { tag, offset } => return Err(ReplayError::UnknownRecord { tick: 0, offset, tag }),
                Found::Cut => return Err(ReplayError::Truncated { ticks: 0, offset: records.offset() }),
                Found::End { .. } => {
                    let offset = records.offset();
                    return Err(ReplayError::Corrupt { tick: 0, offset, reason: "there is no world" });
                }
            }
        };
        let world = World::load(records.payload()).map_err(|error| ReplayError::Decode { tick: 0, offset, error })?;
        if world.config().tick_rate != records.tick_rate {
            return Err(ReplayError::Corrupt { tick: 0, offset, reason: "its tick rate is not the header's" });
        }
        Ok(Player { records, world, ticks: 0, commands: 0, has_commands: false, had_tail: false, finished: false })
    }

    /// The world as played so far.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The commands before the tick played last, the game's own input among them. Decoded anew at each call: a file
    /// can hold more commands than memory does.
    pub fn commands(&self) -> impl Iterator<Item = Command> + '_ {
        let mut reader = Reader::new(if self.has_commands { self.records.payload() } else { &[] });
        // The hash stands first.
        let _ = reader.take::<u64>("hash");
        core::iter::from_fn(
            move || if reader.remaining() > 0 { Command::load(&mut reader, "command").ok() } else { None },
        )
    }

    /// Plays one tick and compares the hash. `Some` is that hash, `None` the end of the replay.
    ///
    /// Errors: the first divergence, or what is wrong with the file, by place. A file cut off gives
    /// [`ReplayError::Truncated`] after its last whole tick.
    pub fn step(&mut self) -> Result<Option<u64>, ReplayError> {
        while let Some(recorded) = self.read()? {
            // Each has been decoded once already, by `read`.
            let tick = self.ticks.saturating_add(1);
            let decode = |error| ReplayError::Decode { tick, offset: recorded.offset, error };
            let mut reader = Reader::new(self.records.payload());
            reader.take::<u64>("hash").map_err(decode)?;
            let mut index = 0u64;
            while reader.remaining() > 0 {
                let command = Command::load(&mut reader, "command").map_err(decode)?;
                let refused = |error| ReplayError::Refused { tick, index, error: Box::new(error) };
                self.world.apply(command).map_err(refused)?;
                index = index.saturating_add(1);
            }
            if recorded.is_tick {
                self.world.step();
                self.ticks = self.ticks.saturating_add(1);
            }
            let computed = self.world.hash();
            if computed != recorded.hash {
                return Err(ReplayError::Diverged { tick: self.ticks, recorded: recorded.hash, computed });
            }
            if recorded.is_tick {
                return Ok(Some(computed));
            }
        }
        Ok(None)
    }

    /// Plays the rest.
    pub fn verify(mut self) -> Result<Summary, ReplayError> {
        while self.step()?.is_some() {}
        Ok(Summary { ticks: self.ticks, commands: self.commands, hash: self.world.hash() })
    }

    /// Reads the rest without playing it: whether the file is whole, and what it amounts to. The hash is the last
    /// recorded one.
    pub fn inspect(mut self) -> Result<Summary, ReplayError> {
        let mut hash = self.world.hash();
        while let Some(recorded) = self.read()? {
            hash = recorded.hash;
            self.ticks = self.ticks.saturating_add(u64::from(recorded.is_tick));
        }
        Ok(Summary { ticks: self.ticks, commands: self.commands, hash })
    }

    /// Reads the next tick or tail, and its commands to see that they are some; `None` at the end.
    fn read(&mut self) -> Result<Option<Recorded>, ReplayError> {
        let recorded = self.read_record().map_err(|error| match error {
            // What a file that was cut off holds is whole ticks; everything else is wrong in the tick being read.
            ReplayError::Truncated { .. } => error.at(self.ticks),
            error => error.at(self.ticks.saturating_add(1)),
        })?;
        self.has_commands = recorded.is_some();
        let Some(recorded) = recorded else { return Ok(None) };
        let tick = self.ticks.saturating_add(1);
        let decode = |error| ReplayError::Decode { tick, offset: recorded.offset, error };
        let mut reader = Reader::new(self.records.payload());
        let hash = reader.take("hash").map_err(decode)?;
        while reader.remaining() > 0 {
            Command::load(&mut reader, "command").map_err(decode)?;
            self.commands = self.commands.saturating_add(1);
        }
        Ok(Some(Recorded { hash, ..recorded }))
    }

    fn read_record(&mut self) -> Result<Option<Recorded>, ReplayError> {
        let corrupt = |offset, reason| Err(ReplayError::Corrupt { tick: 0, offset, reason });
        while !self.finished {
            match self.records.next()? {
                Found::Record { tag: tag::IDLE | tag::TICK | tag::TAIL, offset } if self.had_tail => {
                    return corrupt(offset, "there is a tick after the tail");
                }
                Found::Record { tag: tag::IDLE | tag::TICK, offset } => {
                    return Ok(Some(Recorded { offset, is_tick: true, hash: 0 }));
                }
                Found::Record { tag: tag::TAIL, offset } => {
                    self.had_tail = true;
                    return Ok(Some(Recorded { offset, is_tick: false, hash: 0 }));
                }
                Found::Record { tag: tag::ANCILLARY.., .. } => {}
                Found::Record { tag: tag::WORLD, offset } => return corrupt(offset, "there is a second world"),
                Found::Record { tag, offset } => return Err(ReplayError::UnknownRecord { tick: 0, offset, tag }),
                Found::Cut => return Err(ReplayError::Truncated { ticks: 0, offset: self.records.offset() }),
                Found::End { ticks } if ticks != self.ticks => {
                    return corrupt(self.records.offset(), "the end counts other ticks");
                }
                Found::End { .. } => self.finished = true,
            }
        }
        Ok(None)
    }
}
