//! Playing: the recorded world, its commands, and a comparison after every tick.

mod read;

use super::error::ReplayError;
use super::format::{Found, RecordReader, tag};
use super::keyframe::{Head, Keyframe, States};
use crate::World;
use crate::store::{Reader, Record};
use crate::threads::Threads;
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

/// What a replay holds, read without playing it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents {
    /// What it amounts to; the hash is the last recorded one.
    pub summary: Summary,
    /// Where it can be played from.
    pub keyframes: Vec<Keyframe>,
    /// How many records hold evidence.
    pub evidence: u64,
}

/// A record that means something here.
pub(super) enum Step {
    /// A tick, or the commands after the last one.
    Tick {
        offset: u64,
        is_tick: bool,
        is_idle: bool,
        hash: u64,
    },
    Keyframe {
        offset: u64,
        head: Head,
    },
    Parts {
        offset: u64,
    },
    Evidence {
        offset: u64,
    },
    Other,
}

/// Plays a replay tick by tick, and compares the hash of the complete state after each.
pub struct Player<R> {
    records: RecordReader<R>,
    world: World,
    threads: Threads,
    ticks: u64,
    commands: u64,
    history: u64,
    /// Whether the record read last is a tick or the tail, so that its payload has commands.
    has_commands: bool,
    had_tail: bool,
    finished: bool,
    /// Where the last keyframe with a whole save is.
    base: Option<u64>,
    /// The ticks before the last keyframe; 0 without one.
    marked: u64,
    states: States,
    /// Where the index is, once it has been read; and a hash of the keyframes so far.
    index: u64,
    seen: u64,
    /// Whether it went on from a keyframe, and does not know those before.
    is_resumed: bool,
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
                Found::Record { tag: tag::KEYFRAME..=tag::INDEX | tag::IDLE | tag::TICK | tag::TAIL, offset } => {
                    return Err(ReplayError::Corrupt { tick: 0, offset, reason: "there is a tick before the world" });
                }
                Found::Record { tag: tag::ANCILLARY.., .. } => {}
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
        let mut states = States::default();
        states.resume(&world, offset);
        let past = world.hash();
        Ok(Self::begun(records, world, past, (offset, states)))
    }

    fn begun(records: RecordReader<R>, world: World, history: u64, (base, states): (u64, States)) -> Self {
        Player {
            records,
            world,
            threads: Threads::default(),
            ticks: 0,
            commands: 0,
            history,
            has_commands: false,
            had_tail: false,
            finished: false,
            base: Some(base),
            marked: 0,
            states,
            index: 0,
            seen: 0,
            is_resumed: false,
        }
    }

    /// Goes on behind a keyframe that was read.
    pub(super) fn resumed(records: RecordReader<R>, world: World, head: &Head) -> Self {
        let mut states = States::default();
        states.resume(&world, head.base);
        let mut player = Self::begun(records, world, head.history, (head.base, states));
        (player.ticks, player.commands, player.is_resumed) = (head.tick, head.commands, true);
        player.marked = head.tick;
        player
    }

    /// The payload of the record read last.
    pub(super) fn payload(&self) -> &[u8] {
        self.records.payload()
    }

    /// Counts a tick that was read and is not played.
    pub(super) fn skip_tick(&mut self) {
        self.ticks = self.ticks.saturating_add(1);
    }

    /// The world as played so far.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The same, to go on with alone.
    pub fn into_world(self) -> World {
        self.world
    }

    /// Has these threads step the world from now on: the hashes are the same.
    pub fn use_threads(&mut self, threads: &Threads) {
        self.threads = threads.clone();
    }

    /// The ticks played so far, from the start of the recording.
    pub fn ticks(&self) -> u64 {
        self.ticks
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
        let threads = self.threads.clone();
        let hash = self.step_by(|world| world.step_on(&threads))?;
        self.compare(hash)
    }

    /// As [`Player::step`], with the tick left to `step`, and its hash not compared: the recorded one, and whether a check stands
    /// behind it.
    pub(super) fn step_by(&mut self, step: impl FnOnce(&mut World)) -> Result<Option<(u64, bool)>, ReplayError> {
        while let Some(read) = self.read()? {
            let (offset, is_tick, is_idle, hash) = match read {
                Step::Tick { offset, is_tick, is_idle, hash } => (offset, is_tick, is_idle, hash),
                Step::Keyframe { offset, head } => {
                    self.check_keyframe(offset, &head)?;
                    continue;
                }
                Step::Parts { offset } => {
                    self.check_parts(offset)?;
                    continue;
                }
                Step::Evidence { .. } | Step::Other => continue,
            };
            self.carry_out(offset)?;
            if is_tick {
                step(&mut self.world);
                self.ticks = self.ticks.saturating_add(1);
                return Ok(Some((hash, !is_idle)));
            }
            self.compare(Some((hash, true)))?;
        }
        Ok(None)
    }

    /// The world's hash, if it is the recorded one.
    fn compare(&mut self, recorded: Option<(u64, bool)>) -> Result<Option<u64>, ReplayError> {
        let Some((recorded, checked)) = recorded else { return Ok(None) };
        let (tick, computed) = (self.ticks, self.world.hash());
        if computed == recorded {
            return Ok(Some(computed));
        }
        if !checked {
            self.look_for_check(tick)?;
        }
        Err(ReplayError::Diverged { tick, recorded, computed })
    }

    /// An idle tick has no check of its own: the next one says whether the file is as it was written.
    fn look_for_check(&mut self, tick: u64) -> Result<(), ReplayError> {
        loop {
            match self.records.next().map_err(|error| error.at(tick))? {
                Found::Record { tag: tag::IDLE, .. } => {}
                Found::Record { .. } | Found::End { .. } => return Ok(()),
                Found::Cut => {
                    let reason = "a hash differs, and the file ends before a check says whether it was recorded so";
                    return Err(ReplayError::Corrupt { tick, offset: self.records.offset(), reason });
                }
            }
        }
    }

    /// Carries out the commands of the record read last; each has been decoded once already, by `read`.
    fn carry_out(&mut self, offset: u64) -> Result<(), ReplayError> {
        let tick = self.ticks.saturating_add(1);
        let decode = |error| ReplayError::Decode { tick, offset, error };
        let mut reader = Reader::new(self.records.payload());
        reader.take::<u64>("hash").map_err(decode)?;
        let mut index = 0u64;
        while reader.remaining() > 0 {
            let command = Command::load(&mut reader, "command").map_err(decode)?;
            let refused = |error| ReplayError::Refused { tick, index, error: Box::new(error) };
            self.world.apply(command).map_err(refused)?;
            index = index.saturating_add(1);
        }
        Ok(())
    }

    /// Whether a keyframe holds the world as played, to the byte.
    fn check_keyframe(&mut self, offset: u64, head: &Head) -> Result<(), ReplayError> {
        let own = head.base == offset || self.states.base(&self.world) == Some(head.base);
        let (_, state) = Head::read(self.records.payload()).map_err(|error| ReplayError::Decode {
            tick: self.ticks,
            offset,
            error,
        })?;
        if !own || self.states.write(&self.world, offset, head.base) != state {
            return Err(ReplayError::DivergedKeyframe { tick: self.ticks, offset });
        }
        Ok(())
    }

    /// Whether the parts of the state have the recorded hashes.
    fn check_parts(&mut self, offset: u64) -> Result<(), ReplayError> {
        let mut reader = Reader::new(self.records.payload());
        for part in self.world.hash_parts() {
            let decode = |error| ReplayError::Decode { tick: self.ticks, offset, error };
            let recorded = reader.take("part").map_err(decode)?;
            if recorded != part.hash {
                let (tick, part, computed) = (self.ticks, part.name, part.hash);
                return Err(ReplayError::DivergedPart { tick, part, recorded, computed });
            }
        }
        Ok(())
    }

    /// Plays the rest.
    pub fn verify(mut self) -> Result<Summary, ReplayError> {
        while self.step()?.is_some() {}
        Ok(self.summary())
    }

    /// What it amounts to as far as it was played.
    pub fn summary(&self) -> Summary {
        Summary { ticks: self.ticks, commands: self.commands, hash: self.world.hash() }
    }

    /// Plays up to a keyframe, which must hold the world as played. `each` gets the hash of every tick.
    pub fn verify_to(&mut self, keyframe: &Keyframe, mut each: impl FnMut(u64)) -> Result<(), ReplayError> {
        while self.ticks < keyframe.tick {
            match self.step()? {
                Some(hash) => each(hash),
                None => break,
            }
        }
        loop {
            match self.read()? {
                Some(Step::Keyframe { offset, head }) => {
                    self.check_keyframe(offset, &head)?;
                    if offset == keyframe.offset {
                        return Ok(());
                    }
                }
                Some(Step::Parts { offset }) => self.check_parts(offset)?,
                Some(Step::Evidence { .. } | Step::Other) => {}
                Some(Step::Tick { offset, .. }) => {
                    let reason = "there is no keyframe where one is named";
                    return Err(ReplayError::Corrupt { tick: self.ticks, offset, reason });
                }
                None => {
                    let (tick, offset) = (self.ticks, self.records.offset());
                    return Err(ReplayError::Corrupt {
                        tick,
                        offset,
                        reason: "there is no keyframe where one is named",
                    });
                }
            }
        }
    }

    /// Reads the rest without playing it: whether the file is whole, and what it holds.
    pub fn inspect(mut self) -> Result<Contents, ReplayError> {
        let mut hash = self.world.hash();
        let (mut keyframes, mut evidence) = (Vec::new(), 0u64);
        while let Some(read) = self.read()? {
            match read {
                Step::Tick { is_tick, hash: recorded, .. } => {
                    hash = recorded;
                    self.ticks = self.ticks.saturating_add(u64::from(is_tick));
                }
                Step::Keyframe { offset, head: Head { tick, history, .. } } => {
                    keyframes.push(Keyframe { tick, offset, history });
                }
                Step::Evidence { .. } => evidence = evidence.saturating_add(1),
                Step::Parts { .. } | Step::Other => {}
            }
        }
        let summary = Summary { ticks: self.ticks, commands: self.commands, hash };
        Ok(Contents { summary, keyframes, evidence })
    }
}
