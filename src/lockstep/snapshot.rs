//! A running match as bytes, for those who join late, and what an alarm of ggrs means.

use super::{Alarm, Game, Lockstep, LockstepError};
use crate::World;
use crate::hello::Hello;
use crate::store::{Reader, hash_bytes, put, put_count, read_value};
use ggrs::Frame;

const MAGIC: &[u8; 8] = b"TAMIAS-M";
/// Where the hello ends.
const HEADER: usize = MAGIC.len() + Hello::LENGTH;
/// Of the hash at the end.
const CHECK: usize = 8;

impl<G: Game> Lockstep<G> {
    /// What an alarm of the session means. The numbers are those of `GgrsEvent::DesyncDetected`.
    pub fn alarm(&self, frame: Frame, local_checksum: u128, remote_checksum: u128) -> Alarm {
        let both = |part: fn(u128) -> u64| [part(local_checksum), part(remote_checksum)];
        Alarm {
            tick: self.tick_of(frame),
            world: both(|checksum| checksum as u64),
            own: both(|checksum| (checksum >> 64) as u64),
        }
    }

    /// The match at its newest settled tick, for one who joins late; `hello` is the one that the match began with. `None` if
    /// that tick is not kept.
    ///
    /// Layout: `TAMIAS-M`, the hello, the game's own state behind its `u32` count of bytes, the world as
    /// [`World::save`] writes it, and XXH3-64 of all before it.
    pub fn snapshot(&self, hello: &Hello) -> Option<Vec<u8>> {
        let tick = self.settled();
        let (world, own) = (self.world_at(tick)?, self.ring.own(tick)?);
        let mut bytes = MAGIC.to_vec();
        bytes.extend(hello.encode());
        put_count(&mut bytes, own.len());
        bytes.extend_from_slice(own);
        bytes.extend(world.save());
        let check = hash_bytes(&bytes);
        put(&mut bytes, check);
        Some(bytes)
    }

    /// Joins a running match by a peer's snapshot; `hello` is that of one who would begin it. From there on
    /// [`Lockstep::follow`] takes the inputs since, or a new session of all begins.
    ///
    /// Errors: bytes that are no snapshot or were damaged, another law, format, game or scene, each by name.
    pub fn join(hello: &Hello, bytes: &[u8]) -> Result<Self, LockstepError> {
        if bytes.get(..MAGIC.len()) != Some(MAGIC) {
            return Err(LockstepError::NotASnapshot);
        }
        let (header, rest) = bytes.split_at_checked(HEADER).ok_or(LockstepError::Damaged)?;
        let theirs = Hello::decode(header.get(MAGIC.len()..).unwrap_or(&[])).map_err(LockstepError::Peer)?;
        hello.check(&theirs).map_err(LockstepError::Peer)?;
        let whole = bytes.len().saturating_sub(CHECK);
        let (all, check) = bytes.split_at(whole);
        if check != hash_bytes(all).to_le_bytes() {
            return Err(LockstepError::Damaged);
        }
        let mut reader = Reader::new(rest.get(..rest.len().saturating_sub(CHECK)).unwrap_or(&[]));
        let damaged = |_| LockstepError::Damaged;
        let count = reader.take_count(1, "the game's own state").map_err(damaged)?;
        let own = reader.take_bytes(count, "the game's own state").map_err(damaged)?;
        let game = read_value(own).ok_or(LockstepError::OwnState)?;
        let remaining = reader.remaining();
        let world = reader.take_bytes(remaining, "the world").map_err(damaged)?;
        Lockstep::new(game, World::load(world).map_err(LockstepError::World)?)
    }
}
