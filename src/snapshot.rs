//! Saving, loading, hashing and comparing worlds.
//!
//! A save is a magic, the format version and the arithmetic law, the state by its field lists, and the state's hash;
//! `replays/FORMAT.md` has all of it byte by byte.

mod frame;
mod header;
mod tables;

use crate::World;
use crate::motion::Push;
use crate::store::{DecodeError, Diff, Difference, Hasher, Record, put};
use crate::world::Status;
pub use frame::{Frame, FrameError};
pub(crate) use tables::{Digests, Tables};

/// The format version of saved worlds.
pub const SAVE_VERSION: u32 = 4;
/// The arithmetic law: what every number, rounding and order of operations is. Worlds of two laws continue
/// differently, so a build refuses other laws.
pub const LAW: u32 = 9;

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
        header::put(bytes, header::SAVE);
        Record::save(self, bytes);
        put(bytes, self.hash());
    }

    /// The world that was saved.
    ///
    /// Errors: everything but the exact bytes of a save, by place; the memory reserved is bounded by the bytes given.
    pub fn load(bytes: &[u8]) -> Result<World, DecodeError> {
        let mut reader = header::take(bytes, header::SAVE)?;
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
        root(&self.hash_parts())
    }

    /// The hash of each part of the state.
    pub fn hash_parts(&self) -> [HashPart; 9] {
        self.hashes().parts()
    }

    /// The hash of each part of the state as memory holds it now, without digests that were kept. They differ from
    /// [`World::hash_parts`] only where memory has a fault.
    ///
    /// Cost: a small hash for each slot, about what saving costs.
    pub fn hash_parts_afresh(&self) -> [HashPart; 9] {
        let World { bodies, colliders, attractors, resting, .. } = self;
        let hashes = Hashes {
            bodies: bodies.cold.hash_afresh(),
            colliders: colliders.hash_afresh(),
            attractors: attractors.hash_afresh(),
            sleep: [bodies.rest.hash(), resting.contacts.hash()],
            ..self.hashes()
        };
        hashes.parts()
    }

    fn hashes(&self) -> Hashes<'_> {
        let World { config: _, tick: _, bodies, colliders, attractors, pushes, contacts, resting, status, .. } = self;
        Hashes {
            clock: self.clock_hash(),
            bodies: bodies.cold.hash(),
            motion: bodies.motion_hash(),
            colliders: colliders.hash(),
            attractors: attractors.hash(),
            pushes,
            contacts: contacts.hash(),
            sleep: [bodies.rest.hash(), resting.hash()],
            status,
        }
    }

    /// The hash of the configuration with the tick.
    fn clock_hash(&self) -> u64 {
        let mut hasher = Hasher::new();
        self.config.save(&mut hasher);
        self.tick.save(&mut hasher);
        hasher.finish()
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

/// What the hash of a state is made of, wherever that lies.
struct Hashes<'s> {
    clock: u64,
    bodies: u64,
    motion: u64,
    colliders: u64,
    attractors: u64,
    pushes: &'s Vec<Push>,
    contacts: u64,
    /// Who sleeps, and the contacts of what does.
    sleep: [u64; 2],
    status: &'s Status,
}

impl Hashes<'_> {
    fn parts(&self) -> [HashPart; 9] {
        let Hashes { clock, bodies, motion, colliders, attractors, pushes, contacts, sleep, status } = self;
        let of = |record: &dyn Fn(&mut Hasher)| {
            let mut hasher = Hasher::new();
            record(&mut hasher);
            hasher.finish()
        };
        let part = |name, hash| HashPart { name, hash };
        [
            part("configuration", *clock),
            part("bodies", *bodies),
            part("motion", *motion),
            part("colliders", *colliders),
            part("attractors", *attractors),
            part("forces", of(&|hasher| pushes.save(hasher))),
            part("contacts", *contacts),
            part("sleep", of(&|hasher| sleep.iter().for_each(|hash| put(hasher, *hash)))),
            part("status", of(&|hasher| status.save(hasher))),
        ]
    }
}

/// The hash over those of all parts.
fn root(parts: &[HashPart; 9]) -> u64 {
    let mut hasher = Hasher::new();
    for part in parts {
        put(&mut hasher, part.hash);
    }
    hasher.finish()
}
