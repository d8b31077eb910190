//! What can be wrong with a replay, by place.

use crate::store::DecodeError;
use crate::world::CommandError;
use core::fmt;

/// Why a replay does not play.
#[derive(Debug)]
#[non_exhaustive]
pub enum ReplayError {
    /// The bytes could not be read.
    Io(std::io::Error),
    /// The first bytes are not those of a replay.
    NotAReplay,
    /// A replay of another format version.
    Version {
        /// The version found.
        found: u32,
        /// The version this build reads.
        known: u32,
    },
    /// A replay under another arithmetic law: it would play differently here.
    Law {
        /// The law found.
        found: u32,
        /// The law this build computes by.
        known: u32,
    },
    /// The file was changed: a check or a digest does not fit, or a record is where none can be.
    Corrupt {
        /// The tick being read, counted from the start of the recording; 0 is the header and the initial world.
        tick: u64,
        /// Where the record begins.
        offset: u64,
        /// What is wrong.
        reason: &'static str,
    },
    /// A record that this build does not know and must not skip.
    UnknownRecord {
        /// The tick being read.
        tick: u64,
        /// Where it begins.
        offset: u64,
        /// Its tag.
        tag: u8,
    },
    /// The initial world or a command cannot be read.
    Decode {
        /// The tick being read.
        tick: u64,
        /// Where the record begins; the error's own offset is inside its payload.
        offset: u64,
        /// What is wrong in it.
        error: DecodeError,
    },
    /// The file ends without its end record.
    Truncated {
        /// The whole ticks before the cut, all of which played.
        ticks: u64,
        /// Where the bytes end.
        offset: u64,
    },
    /// Bytes after the end record.
    Trailing {
        /// Where they begin.
        offset: u64,
    },
    /// A recorded command is refused, which it was not when it was recorded.
    Refused {
        /// The tick before which it stands.
        tick: u64,
        /// Which of that tick's commands, from 0.
        index: u64,
        /// Why.
        error: Box<CommandError>,
    },
    /// The world's hash after a tick is not the recorded one.
    Diverged {
        /// The tick, counted from the start of the recording; 0 is the initial world.
        tick: u64,
        /// The recorded hash.
        recorded: u64,
        /// The hash of the world as played.
        computed: u64,
    },
    /// A part of the state has another hash than the recorded one, though the state's own hash is that. A fault of the memory in
    /// which the recording was made is seen so: in what only commands change.
    DivergedPart {
        /// The tick.
        tick: u64,
        /// The part's name.
        part: &'static str,
        /// The recorded hash.
        recorded: u64,
        /// The hash of the part as played.
        computed: u64,
    },
    /// A tick was asked for that the recording does not have.
    NoSuchTick {
        /// The tick asked for.
        tick: u64,
        /// The recording's ticks.
        ticks: u64,
    },
    /// A keyframe does not hold the world as played.
    DivergedKeyframe {
        /// The tick.
        tick: u64,
        /// Where the keyframe begins.
        offset: u64,
    },
}

impl ReplayError {
    /// The same error, found while reading a tick.
    pub(super) fn at(mut self, now: u64) -> Self {
        if let ReplayError::Corrupt { tick, .. }
        | ReplayError::UnknownRecord { tick, .. }
        | ReplayError::Decode { tick, .. }
        | ReplayError::Truncated { ticks: tick, .. } = &mut self
        {
            *tick = now;
        }
        self
    }
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReplayError::Io(error) => write!(f, "cannot be read: {error}"),
            ReplayError::NotAReplay => f.write_str("not a tamias2d replay"),
            ReplayError::Version { found, known } => {
                let older = if found < known {
                    "record it anew, or play it with the build that made it"
                } else {
                    "play it with a newer build"
                };
                write!(f, "replay of format version {found}, this build reads version {known}: {older}")
            }
            ReplayError::Law { found, known } => {
                write!(
                    f,
                    "replay under arithmetic law {found}, this build computes by law {known} and would play it differently: play it \
                     with a build of law {found}, or record it anew"
                )
            }
            ReplayError::Corrupt { tick, offset, reason } => {
                write!(f, "replay corrupt at tick {tick}, byte {offset}: {reason}")
            }
            ReplayError::UnknownRecord { tick, offset, tag } => {
                write!(f, "replay has a record of unknown kind {tag:#04x} at tick {tick}, byte {offset}")
            }
            ReplayError::Decode { tick, offset, error } => {
                write!(f, "replay corrupt at tick {tick}, in the record at byte {offset}: {error}")
            }
            ReplayError::Truncated { ticks, offset } => {
                write!(f, "replay truncated at byte {offset}, after {ticks} whole ticks")
            }
            ReplayError::Trailing { offset } => write!(f, "unexpected bytes after the replay's end at byte {offset}"),
            ReplayError::Refused { tick, index, error } => {
                write!(f, "replay diverged before tick {tick}: command {index} is refused, {error}")
            }
            ReplayError::Diverged { tick, recorded, computed } => {
                write!(f, "replay diverged at tick {tick}: hash {computed:016x}, recorded {recorded:016x}")
            }
            ReplayError::DivergedPart { tick, part, recorded, computed } => {
                write!(
                    f,
                    "replay diverged at tick {tick} in part {part}: hash {computed:016x}, recorded {recorded:016x}"
                )
            }
            ReplayError::NoSuchTick { tick, ticks } => {
                write!(f, "there is no tick {tick} in the replay, which has ticks 1 to {ticks}")
            }
            ReplayError::DivergedKeyframe { tick, offset } => {
                write!(
                    f,
                    "replay diverged at tick {tick}: the keyframe at byte {offset} holds another world than was played"
                )
            }
        }
    }
}

impl core::error::Error for ReplayError {}
