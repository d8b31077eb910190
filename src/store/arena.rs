//! Slots with generations: what an id refers to, and in which order everything is visited.
//!
//! Slot order is iteration order. A freed slot is reused last in, first out, and the chain of free slots is state:
//! two worlds that would hand out different ids next are different worlds, and their hashes say so.

use super::codec::{DecodeError, Hasher, Reader, Sink};
use super::record::{Diff, Record, record};
use super::show::{Cells, Draft, Kind, Show, Tables, show};
use core::fmt;
use serde::{Deserialize, Serialize};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident, $text:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub struct $name {
            /// The slot.
            pub index: u32,
            /// How often the slot had been reused when this id was given out.
            pub generation: u32,
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($text, " {}v{}"), self.index, self.generation)
            }
        }

        impl Record for $name {
            const LEAST: usize = 8;

            fn save(&self, sink: &mut impl Sink) {
                let $name { index, generation } = self;
                index.save(sink);
                generation.save(sink);
            }

            fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
                Ok($name { index: Record::load(reader, field)?, generation: Record::load(reader, field)? })
            }

            fn diff(&self, other: &Self, diff: &mut Diff) {
                if self != other {
                    diff.note(self.to_string(), other.to_string());
                }
            }
        }

        show!($name { index, generation });
    )*};
}

ids! {
    /// A body's id. Ids of destroyed bodies stay invalid: their slot's next body has another generation.
    BodyId, "body";
    /// An attractor's id.
    AttractorId, "attractor";
    /// A collider's id.
    ColliderId, "collider";
}

/// The link of a slot that is in use.
const LIVE: u32 = u32::MAX;
/// The end of the chain of free slots.
const END: u32 = u32::MAX - 1;

/// A value that a slot holds; `Default` is what a free slot holds.
pub(crate) trait Row: Record + Clone + Default + PartialEq {}

/// A slot: its generation, its place in the chain of free slots (or that it is in use), and its value.
#[derive(Debug, PartialEq)]
struct Slot<T> {
    generation: u32,
    link: u32,
    value: T,
}

impl<T: Row> Slot<T> {
    /// The slot's share of the arena's digest.
    fn hash(&self, index: usize) -> u64 {
        let mut hasher = Hasher::new();
        (index as u64).save(&mut hasher);
        self.save(&mut hasher);
        hasher.finish()
    }
}

// `record!` takes no type parameters, and this is the one generic record.
impl<T: Row> Record for Slot<T> {
    const LEAST: usize = T::LEAST.saturating_add(8);

    fn save(&self, sink: &mut impl Sink) {
        let Slot { generation, link, value } = self;
        generation.save(sink);
        link.save(sink);
        value.save(sink);
    }

    fn load(reader: &mut Reader<'_>, _field: &'static str) -> Result<Self, DecodeError> {
        Ok(Slot {
            generation: Record::load(reader, "generation")?,
            link: Record::load(reader, "free slot link")?,
            value: T::load(reader, "value")?,
        })
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        diff.field("generation", |d| self.generation.diff(&other.generation, d));
        diff.field("link", |d| self.link.diff(&other.link, d));
        self.value.diff(&other.value, diff);
    }
}

impl<T: Row + Show> Show for Slot<T> {
    fn show(&self, cells: &mut Cells<'_>) {
        let Slot { generation, link, value } = self;
        cells.field("generation", |c| generation.show(c));
        cells.field("link", |c| link.show(c));
        value.show(cells);
    }
}

impl<T: Row> Clone for Slot<T> {
    fn clone(&self) -> Self {
        Slot { generation: self.generation, link: self.link, value: self.value.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        let Slot { generation, link, value } = source;
        self.generation = *generation;
        self.link = *link;
        self.value.clone_from(value);
    }
}

/// The head of the chain of free slots and the number of slots in use.
#[derive(Debug)]
struct Chain {
    free: u32,
    live: u32,
}

record!(Chain { free, live } shown);

/// What is kept of all slots. The state's hash is made of the digest: a fault in that rings an alarm, though all slots are sound.
struct Kept<'a>(&'a Chain, u64);

impl Show for Kept<'_> {
    fn show(&self, cells: &mut Cells<'_>) {
        let Kept(chain, digest) = self;
        chain.show(cells);
        cells.field("digest", |c| digest.show(c));
    }
}

/// Values in slots, with a digest over all of them that every change renews.
#[derive(Debug)]
pub(crate) struct Arena<T> {
    slots: Vec<Slot<T>>,
    chain: Chain,
    /// The wrapping sum of the slots' hashes. Derived.
    digest: u64,
}

impl<T: Row> Default for Arena<T> {
    fn default() -> Self {
        Arena { slots: Vec::new(), chain: Chain { free: END, live: 0 }, digest: 0 }
    }
}

impl<T: Row> Clone for Arena<T> {
    fn clone(&self) -> Self {
        Arena { slots: self.slots.clone(), chain: self.chain.clone(), digest: self.digest }
    }

    fn clone_from(&mut self, source: &Self) {
        let Arena { slots, chain, digest } = source;
        self.slots.clone_from(slots);
        self.chain.clone_from(chain);
        self.digest = *digest;
    }
}

impl<T: Row> Arena<T> {
    /// The most slots an arena may have.
    pub(crate) const LIMIT: u32 = 1 << 24;

    /// The number of slots, free ones included.
    pub(crate) fn len(&self) -> usize {
        self.slots.len()
    }

    /// The number of slots in use.
    pub(crate) fn live(&self) -> u32 {
        self.chain.live
    }

    /// Whether another value fits.
    pub(crate) fn has_room(&self) -> bool {
        self.chain.free != END || self.slots.len() < Self::LIMIT as usize
    }

    /// Puts a value into the slot freed last, or a new one. The caller has checked [`Arena::has_room`].
    pub(crate) fn insert(&mut self, value: T) -> (u32, u32) {
        let index = if self.chain.free == END {
            self.slots.push(Slot { generation: 0, link: LIVE, value });
            self.slots.len().saturating_sub(1)
        } else {
            let index = self.chain.free as usize;
            self.digest = self.digest.wrapping_sub(self.slots[index].hash(index));
            let slot = &mut self.slots[index];
            self.chain.free = slot.link;
            (slot.link, slot.value) = (LIVE, value);
            index
        };
        self.digest = self.digest.wrapping_add(self.slots[index].hash(index));
        self.chain.live = self.chain.live.saturating_add(1);
        (index as u32, self.slots[index].generation)
    }

    /// Frees the slot, if the id is current. A slot whose generations are used up is never used again.
    pub(crate) fn remove(&mut self, index: u32, generation: u32) -> Option<T> {
        let at = self.slot(index, generation)?;
        self.digest = self.digest.wrapping_sub(self.slots[at].hash(at));
        let slot = &mut self.slots[at];
        let value = core::mem::take(&mut slot.value);
        if let Some(next) = slot.generation.checked_add(1) {
            slot.generation = next;
            slot.link = self.chain.free;
            self.chain.free = index;
        } else {
            slot.link = END;
        }
        self.digest = self.digest.wrapping_add(self.slots[at].hash(at));
        self.chain.live = self.chain.live.saturating_sub(1);
        Some(value)
    }

    /// The slot that a current id refers to.
    pub(crate) fn slot(&self, index: u32, generation: u32) -> Option<usize> {
        let slot = self.slots.get(index as usize)?;
        (slot.link == LIVE && slot.generation == generation).then_some(index as usize)
    }

    /// The generation of a slot in use.
    pub(crate) fn generation(&self, slot: usize) -> Option<u32> {
        let slot = self.slots.get(slot)?;
        (slot.link == LIVE).then_some(slot.generation)
    }

    /// A slot's value; a free slot holds the default.
    pub(crate) fn value(&self, slot: usize) -> &T {
        &self.slots[slot].value
    }

    /// Changes a slot's value and renews the digest.
    pub(crate) fn update(&mut self, slot: usize, change: impl FnOnce(&mut T)) {
        let before = self.slots[slot].hash(slot);
        change(&mut self.slots[slot].value);
        let after = self.slots[slot].hash(slot);
        self.digest = self.digest.wrapping_sub(before).wrapping_add(after);
    }

    /// The slots in use with their values, in slot order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (usize, &T)> {
        self.slots.iter().enumerate().filter(|(_, slot)| slot.link == LIVE).map(|(at, slot)| (at, &slot.value))
    }

    /// The slots that another arena does not have so, in order; those that only one of both has too.
    pub(crate) fn differing<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = usize> + 'a {
        let same = self.digest == other.digest && self.slots.len() == other.slots.len();
        let slots = if same { 0 } else { self.slots.len().max(other.slots.len()) };
        (0..slots).filter(|&slot| self.slots.get(slot) != other.slots.get(slot))
    }

    /// The hash of everything in the arena, at the cost of one small hash.
    pub(crate) fn hash(&self) -> u64 {
        self.hash_with(self.digest)
    }

    fn hash_with(&self, digest: u64) -> u64 {
        let mut hasher = Hasher::new();
        (self.slots.len() as u64).save(&mut hasher);
        self.chain.save(&mut hasher);
        digest.save(&mut hasher);
        hasher.finish()
    }

    /// Whether the digest is that of the slots, and everything that [`Arena::check_chain`] looks at.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        if self.digest != self.sum() {
            return Err("has a digest that does not fit its slots");
        }
        self.check_chain()
    }

    /// Whether the free chain and the counts agree with the slots; what is wrong, if not.
    fn check_chain(&self) -> Result<(), &'static str> {
        let live = self.slots.iter().filter(|slot| slot.link == LIVE).count();
        if live != self.chain.live as usize {
            return Err("counts its slots in use wrongly");
        }
        if self.slots.len() > Self::LIMIT as usize {
            return Err("has too many slots");
        }
        let retired = |slot: &Slot<T>| slot.generation == u32::MAX && slot.link == END;
        let mut unlinked: usize = self.slots.iter().filter(|slot| slot.link != LIVE).count();
        let mut retired_slots = self.slots.iter().filter(|slot| retired(slot)).count();
        let mut next = self.chain.free;
        // Each step of the walk uses up one free slot, so a chain with a loop ends as well.
        while next != END {
            let Some(slot) = self.slots.get(next as usize).filter(|slot| slot.link != LIVE && unlinked > 0) else {
                return Err("has a chain of free slots that is broken");
            };
            unlinked = unlinked.saturating_sub(1);
            retired_slots = retired_slots.saturating_sub(usize::from(retired(slot)));
            next = slot.link;
        }
        if unlinked > retired_slots {
            return Err("has free slots outside its chain");
        }
        if self.slots.iter().any(|slot| slot.link != LIVE && slot.value != T::default()) {
            return Err("has a free slot that is not empty");
        }
        Ok(())
    }

    /// A slot as memory has it, for faults: generation, link, value. No digest is renewed.
    #[cfg(test)]
    pub(crate) fn memory(&mut self, slot: usize) -> (&mut u32, &mut u32, &mut T) {
        let Slot { generation, link, value } = &mut self.slots[slot];
        (generation, link, value)
    }

    /// The first free slot and the slots in use, likewise.
    #[cfg(test)]
    pub(crate) fn chain_memory(&mut self) -> [&mut u32; 2] {
        [&mut self.chain.free, &mut self.chain.live]
    }

    /// The digest, likewise.
    #[cfg(test)]
    pub(crate) fn digest_memory(&mut self) -> &mut u64 {
        &mut self.digest
    }

    /// Hands on tables of the slots, and of the chain of free ones with the digest.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables, names: [&'static str; 2], kind: Kind)
    where
        T: Show,
    {
        draft.table(tables, names[0], kind, self.slots.iter());
        draft.table(tables, names[1], Kind::World, core::iter::once(Kept(&self.chain, self.digest)));
    }

    /// As [`Arena::hash`], with a digest that is computed from the slots as memory holds them.
    pub(crate) fn hash_afresh(&self) -> u64 {
        self.hash_with(self.sum())
    }

    fn sum(&self) -> u64 {
        self.slots.iter().enumerate().fold(0u64, |sum, (at, slot)| sum.wrapping_add(slot.hash(at)))
    }
}

impl<T: Row> Record for Arena<T> {
    const LEAST: usize = 12;

    fn save(&self, sink: &mut impl Sink) {
        let Arena { slots, chain, digest: _ } = self;
        chain.save(sink);
        slots.save(sink);
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let offset = reader.offset();
        let chain = Record::load(reader, field)?;
        let mut arena = Arena { slots: Record::load(reader, field)?, chain, digest: 0 };
        arena.digest = arena.sum();
        arena.check_chain().map_err(|reason| reader.invalid(offset, field, reason))?;
        Ok(arena)
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        self.slots.diff(&other.slots, diff);
        diff.field("slots", |d| self.chain.diff(&other.chain, d));
    }
}
