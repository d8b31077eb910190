//! Replays: a world, the commands of every tick and the hash after it; recorded, played, verified, compared.
//!
//! A file is a header and a chain of records: the initial world, then each tick's commands and the hash of the complete
//! state after it, then an end. `replays/FORMAT.md` has all of it byte by byte. A record that was changed, moved, doubled or
//! left out breaks the chain. An idle tick costs 9 bytes. Between ticks are hashes of the state's parts, and keyframes, from
//! which a recording is played without what comes before ([`Player::at`]), and verified in segments ([`Segment`]).
//!
//! A file without its end was cut off, by a crash or a full disk: it is played to its last whole tick and reported as
//! truncated.
//!
//! When two machines disagree: [`compare`] says from which tick on, [`Flight`] holds what memory held in the last ticks,
//! [`recompute`] what this build makes of a tick, and [`Evidence::first_difference`] names stage, object, field and both values.

mod compare;
mod error;
mod evidence;
mod finding;
mod flight;
mod format;
mod keyframe;
mod player;
mod recorder;
mod segment;
mod skim;
#[cfg(test)]
mod tests;

pub use compare::{Account, Comparison, compare, recompute};
pub use error::ReplayError;
pub use evidence::{EVIDENCE_VERSION, Evidence, Origin};
pub use finding::{Divergence, FieldValue, Finding};
pub use flight::Flight;
pub use format::REPLAY_VERSION;
pub use keyframe::{Keyframe, read_index};
pub use player::{Contents, Player, Summary};
pub use recorder::{Recorder, Recording};
pub use segment::Segment;
