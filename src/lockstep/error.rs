//! What can go wrong in a match.

use crate::hello::HelloError;
use crate::store::DecodeError;
use core::fmt;
use ggrs::GgrsError;

/// Why a match does not go on, or a snapshot of one is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LockstepError {
    /// The session has failed.
    Session(GgrsError),
    /// The game's own state cannot be written.
    State,
    /// The game's own state was written, and its type does not read what it writes.
    Unreadable,
    /// A state that is asked for is not kept.
    Gone {
        /// Its tick.
        tick: u64,
    },
    /// The bytes are no snapshot of a match.
    NotASnapshot,
    /// They were one, and are damaged or cut off.
    Damaged,
    /// The snapshot is of another game, scene or build.
    Peer(HelloError),
    /// The world in it is refused.
    World(DecodeError),
    /// The game's own state in it cannot be read.
    OwnState,
}

impl fmt::Display for LockstepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LockstepError::Session(error) => write!(f, "the session has failed: {error}"),
            LockstepError::State => {
                f.write_str("the game's own state cannot be written: it has more than 1 MiB, or a type that refuses")
            }
            LockstepError::Unreadable => f.write_str(
                "the game's own state was saved and cannot be read back: its Deserialize must read what its Serialize writes",
            ),
            LockstepError::Gone { tick } => {
                write!(
                    f,
                    "the state of tick {tick} is not there: it is not kept any more, or not settled yet; keep more ticks, and save every frame"
                )
            }
            LockstepError::NotASnapshot => f.write_str("not a snapshot of a match: ask the host for one"),
            LockstepError::Damaged => {
                f.write_str("the snapshot is damaged, its hash does not fit it: have it sent again")
            }
            LockstepError::Peer(error) => write!(f, "the snapshot is refused: {error}"),
            LockstepError::World(error) => write!(f, "the snapshot's world is refused: {error}"),
            LockstepError::OwnState => f.write_str(
                "the game's own state in the snapshot cannot be read: give both peers the same release of the game",
            ),
        }
    }
}

impl core::error::Error for LockstepError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            LockstepError::Session(error) => Some(error),
            LockstepError::Peer(error) => Some(error),
            LockstepError::World(error) => Some(error),
            _ => None,
        }
    }
}

/// What `ggrs::GgrsEvent::DesyncDetected` means: peers have computed different states from the same inputs.
///
/// The tick is the first one at which checksums were compared, and not necessarily the first that differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alarm {
    /// The world's tick.
    pub tick: u64,
    /// The hashes of the world, here and there.
    pub world: [u64; 2],
    /// The hashes of the game's own state, here and there.
    pub own: [u64; 2],
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Alarm { tick, world: [world, their_world], own: [own, their_own] } = self;
        write!(f, "desync at tick {tick}: ")?;
        match (world == their_world, own == their_own) {
            (false, same) => {
                write!(f, "the worlds differ, {world:016x} here and {their_world:016x} there")?;
                if !same {
                    write!(f, ", and the game's own states, {own:016x} and {their_own:016x}")?;
                }
                f.write_str("; compare the evidence or the recordings of both: tamias2d diff HERE THERE")
            }
            (true, _) => write!(
                f,
                "the game's own states differ, {own:016x} here and {their_own:016x} there, and the worlds do not; look for rules that go by anything but state and inputs"
            ),
        }
    }
}
