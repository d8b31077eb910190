//! Playing: the recorded world, its commands, and a comparison after every tick.

use super::error::ReplayError;
use super::format::{Found, RecordReader, tag};
use crate::World;
use crate::store::{Reader, Record};
use crate::world::{Command, Commands};
use std::io::Read;

/// What a verified replay amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The ticks played, each with the recorded hash.
    pub ticks: u64,
    /// The commands carried out.
    pub commands: u64,
    /// The hash of the last state.
    pub hash: u64,
}

/// Plays a replay tick by tick, and compares the hash of the complete state after each.
pub struct Player<R> {
    records: RecordReader<R>,
    world: World,
    ticks: u64,
    commands: u64,
    /// The commands of the tick played last.
    last: Vec<Command>,
    finished: bool,
}

impl<R: Read> Player<R> {
    /// Opens a replay and loads its initial world.
    ///
    /// `input` is read in small pieces: give it a `BufReader` or a slice. Errors: the header or the initial world.
    pub fn new(input: R) -> Result<Self, ReplayError> {
        let mut records = RecordReader::new(input)?;
        loop {
            let (tag, offset) = match records.next()? {
                Found::Record { tag, offset } => (tag, offset),
                Found::Cut => return Err(ReplayError::Truncated { ticks: 0, offset: records.offset() }),
                Found::End { .. } => {
                    return Err(ReplayError::Corrupt { offset: records.offset(), reason: "there is no world" });
                }
            };
            match tag {
                tag::WORLD => {
                    let world =
                        World::load(records.payload()).map_err(|error| ReplayError::Decode { offset, error })?;
                    if world.config().tick_rate != records.tick_rate {
                        return Err(ReplayError::Corrupt { offset, reason: "its tick rate is not the header's" });
                    }
                    let last = Vec::new();
                    return Ok(Player { records, world, ticks: 0, commands: 0, last, finished: false });
                }
                tag::ANCILLARY.. => {}
                tag::IDLE | tag::TICK | tag::TAIL => {
                    return Err(ReplayError::Corrupt { offset, reason: "there is a tick before the world" });
                }
                _ => return Err(ReplayError::UnknownRecord { offset, tag }),
            }
        }
    }

    /// The world as played so far.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The commands before the tick played last, the game's own input among them.
    pub fn commands(&self) -> &[Command] {
        &self.last
    }

    /// Plays one tick and compares the hash. `Some` is that hash, `None` the end of the replay.
    ///
    /// Errors: the first divergence, or what is wrong with the file, by place. A file cut off gives
    /// [`ReplayError::Truncated`] after its last whole tick.
    pub fn step(&mut self) -> Result<Option<u64>, ReplayError> {
        let mut tail = false;
        while !self.finished {
            let (tag, offset) = match self.records.next()? {
                Found::Record { tag, offset } => (tag, offset),
                Found::Cut => {
                    return Err(ReplayError::Truncated { ticks: self.ticks, offset: self.records.offset() });
                }
                Found::End { ticks } if ticks != self.ticks => {
                    let offset = self.records.offset();
                    return Err(ReplayError::Corrupt { offset, reason: "the end counts other ticks" });
                }
                Found::End { .. } => {
                    self.finished = true;
                    break;
                }
            };
            match tag {
                tag::IDLE | tag::TICK | tag::TAIL if tail => {
                    return Err(ReplayError::Corrupt { offset, reason: "there is a tick after the tail" });
                }
                tag::IDLE | tag::TICK => {
                    let recorded = self.carry_out(offset)?;
                    self.world.step();
                    self.ticks = self.ticks.saturating_add(1);
                    return self.compare(recorded).map(Some);
                }
                tag::TAIL => {
                    let recorded = self.carry_out(offset)?;
                    self.compare(recorded)?;
                    tail = true;
                }
                tag::ANCILLARY.. => {}
                tag::WORLD => return Err(ReplayError::Corrupt { offset, reason: "there is a second world" }),
                _ => return Err(ReplayError::UnknownRecord { offset, tag }),
            }
        }
        Ok(None)
    }

    /// Carries out the commands of the present record and returns the hash it expects afterwards.
    fn carry_out(&mut self, offset: u64) -> Result<u64, ReplayError> {
        let decode = |error| ReplayError::Decode { offset, error };
        self.last.clear();
        let mut reader = Reader::new(self.records.payload());
        let recorded = reader.take("hash").map_err(decode)?;
        while reader.remaining() > 0 {
            self.last.push(Command::load(&mut reader, "command").map_err(decode)?);
        }
        for (index, command) in self.last.iter().enumerate() {
            let tick = self.ticks.saturating_add(1);
            self.world.apply(command.clone()).map_err(|error| ReplayError::Refused {
                tick,
                index: index as u64,
                error,
            })?;
            self.commands = self.commands.saturating_add(1);
        }
        Ok(recorded)
    }

    fn compare(&self, recorded: u64) -> Result<u64, ReplayError> {
        let computed = self.world.hash();
        if computed == recorded {
            Ok(computed)
        } else {
            Err(ReplayError::Diverged { tick: self.ticks, recorded, computed })
        }
    }

    /// Plays the rest.
    pub fn verify(mut self) -> Result<Summary, ReplayError> {
        while self.step()?.is_some() {}
        Ok(Summary { ticks: self.ticks, commands: self.commands, hash: self.world.hash() })
    }
}
