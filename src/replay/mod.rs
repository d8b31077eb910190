//! Replays: a world, the commands of every tick and the hash after it; recorded, played, verified.
//!
//! # The file, byte by byte
//!
//! Integers are little-endian. The file is a header and records; a record is a tag byte, for most tags a `u32` length
//! and that many bytes of payload, and a check.
//!
//! | header bytes | what |
//! |---|---|
//! | 8 | `TAMIAS-R` |
//! | 4 | format version, `u32`: 1 |
//! | 4 | arithmetic law, `u32` |
//! | 4 | ticks per second, `u32` |
//! | 4 | zero |
//! | 8 | `u64`: XXH3-64 of the 24 bytes before |
//!
//! | tag | record | payload |
//! |---|---|---|
//! | 0x01 | world | the initial world, as [`World::save`](crate::World::save) gives it. The first record, once |
//! | 0x02 | idle tick | no length; 8 bytes: the world's hash after the tick |
//! | 0x03 | tick | the hash after the tick, then the commands before it, one after the other |
//! | 0x04 | tail | the hash, then the commands after the last tick, without a tick. At most once, last before the end |
//! | 0x0f | end | ticks `u64`, chain `u64`, then the XXH3-64 of every byte of the file before this value. No check |
//! | 0x10 … 0x7f | reserved | refused by their tag: a build that does not know them could play them wrongly |
//! | 0x80 … 0xff | ancillary | skipped: keyframes, evidence, and what else does not change how a replay plays |
//!
//! A record's check is the low half of the *chain*: XXH3-64 of the record's bytes before the check, seeded with the
//! chain after the record before (for the first one: the header's last 8 bytes). A record that was changed, moved,
//! doubled or left out breaks the chain there. An idle tick costs 13 bytes.
//!
//! A file without an end record was cut off, by a crash or a full disk: it is played to its last whole tick and
//! reported as truncated.

mod error;
mod format;
mod player;
mod recorder;

pub use error::ReplayError;
pub use format::REPLAY_VERSION;
pub use player::{Player, Summary};
pub use recorder::Recorder;
