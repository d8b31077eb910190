//! Replays: a world, the commands of every tick and the hash after it; recorded, played, verified.
//!
//! A file is a header and a chain of records: the initial world, then each tick's commands and the hash of the complete
//! state after it, then an end with a digest of every byte. `replays/FORMAT.md` has all of it byte by byte. A record that
//! was changed, moved, doubled or left out breaks the chain there. An idle tick costs 13 bytes.
//!
//! A file without its end was cut off, by a crash or a full disk: it is played to its last whole tick and reported as
//! truncated.

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
