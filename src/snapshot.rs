//! Saving, loading, hashing and comparing worlds.
//!
//! A save is a magic, the format version and the arithmetic law, the state by its field lists, and the state's hash;
//! `replays/FORMAT.md` has all of it byte by byte.

use crate::World;
use crate::store::{DecodeError, Diff, Difference, Hasher, Reader, Record, put};

const MAGIC: &[u8; 8] = b"TAMIAS-W";
/// The format version of saved worlds.
pub const SAVE_VERSION: u32 = 4;
/// The arithmetic law: what every number, rounding and order of operations is. Worlds of two laws continue
/// differently, so a build refuses other laws.
pub const LAW: u32 = 5;

/// The hash of one part of a world's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HashPart {
    /// What it covers.
    pub name: &'static str,
    /// XXH3-64, of what and how `replays/FORMAT.md` says.
    pub hash: u64,
}

impl World {
    /// The complete state as bytes, the same on every machine.
    ///
    /// ```
    /// use tamias2d::{World, WorldDef};
    /// let mut world = World::new(&WorldDef::default())?;
    /// let copy = World::load(&world.save())?;
    /// assert_eq!(copy.hash(), world.hash());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn save(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.save_into(&mut bytes);
        bytes
    }

    /// As [`World::save`], into a buffer that is cleared first and whose memory is reused.
    pub fn save_into(&self, bytes: &mut Vec<u8>) {
        bytes.clear();
        bytes.extend_from_slice(MAGIC);
        put(bytes, SAVE_VERSION);
        put(bytes, LAW);
        Record::save(self, bytes);
        put(bytes, self.hash());
    }

    /// The world that was saved.
    ///
    /// Errors: everything but the exact bytes of a save, by place; the memory reserved is bounded by the bytes given.
    pub fn load(bytes: &[u8]) -> Result<World, DecodeError> {
        let mut reader = Reader::new(bytes);
        if reader.take_bytes(MAGIC.len(), "magic").ok() != Some(MAGIC) {
            return Err(DecodeError::NotASave);
        }
        let found = reader.take("format version")?;
        if found != SAVE_VERSION {
            return Err(DecodeError::Version { found, known: SAVE_VERSION });
        }
        let found = reader.take("arithmetic law")?;
        if found != LAW {
            return Err(DecodeError::Law { found, known: LAW });
        }
        let offset = reader.offset();
        let mut world: World = Record::load(&mut reader, "world")?;
        let saved = reader.take("hash")?;
        reader.finish()?;
        let computed = world.hash();
        if saved != computed {
            return Err(DecodeError::Hash { saved, computed });
        }
        // Before anything is derived from it.
        if world.check_lists().is_err() {
            return Err(DecodeError::Invalid { offset, field: "world", reason: "breaks an invariant of worlds" });
        }
        world.rebuild();
        debug_assert_eq!(world.check(), Ok(()), "a world that was read is sound");
        Ok(world)
    }

    /// XXH3-64 over the complete state: over the hashes of [`World::hash_parts`], in their order.
    ///
    /// Cost: one pass over the bodies' columns (48 bytes a body, 52 with sleeping); what only commands change is covered by digests
    /// that commands renew.
    pub fn hash(&self) -> u64 {
        let mut hasher = Hasher::new();
        for part in self.hash_parts() {
            put(&mut hasher, part.hash);
        }
        hasher.finish()
    }

    /// The hash of each part of the state.
    pub fn hash_parts(&self) -> [HashPart; 9] {
        let World { config, tick, bodies, colliders, attractors, pushes, contacts, resting, status, .. } = self;
        let mut clock = Hasher::new();
        config.save(&mut clock);
        tick.save(&mut clock);
        let record = |record: &Vec<_>| {
            let mut hasher = Hasher::new();
            record.save(&mut hasher);
            hasher.finish()
        };
        let mut faults = Hasher::new();
        status.save(&mut faults);
        let mut sleep = Hasher::new();
        put(&mut sleep, bodies.rest.hash());
        put(&mut sleep, resting.hash());
        let part = |name, hash| HashPart { name, hash };
        [
            part("configuration", clock.finish()),
            part("bodies", bodies.cold.hash()),
            part("motion", bodies.motion_hash()),
            part("colliders", colliders.hash()),
            part("attractors", attractors.hash()),
            part("forces", record(pushes)),
            part("contacts", contacts.hash()),
            part("sleep", sleep.finish()),
            part("status", faults.finish()),
        ]
    }

    /// Where two worlds differ, field by field, in the order of the state; empty when they are equal.
    ///
    /// ```
    /// use tamias2d::{BodyDef, Commands, Vec2, World, WorldDef};
    /// let mut a = World::new(&WorldDef::default())?;
    /// let id = a.create_body(&BodyDef::default())?;
    /// let mut b = a.clone();
    /// b.set_velocity(id, Vec2::from_f64(0.0, 0.5)?)?;
    /// assert_eq!(a.diff(&b)[0].path, "bodies[0].velocity.y");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn diff(&self, other: &World) -> Vec<Difference> {
        let mut diff = Diff::default();
        Record::diff(self, other, &mut diff);
        diff.found
    }
}
