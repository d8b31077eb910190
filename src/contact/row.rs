//! What of a contact is state: that it touches, and the impulses with which the next tick begins.

use crate::store::{Cells, ColliderId, DecodeError, Diff, Draft, Kind, Reader, Record, Show, Sink, Tables, hash_words};

/// A pair of colliders that has contact points, or a sensor and what overlaps it.
///
/// | field | format | bound |
/// |---|---|---|
/// | `normal`, `tangent` | Q48, metres per second over 2^k: the impulse times 1/m_a + 1/m_b | 2⁶⁰ |
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Contact {
    /// Slots and generations; the slot of `a` is the lower one.
    pub(crate) a: ColliderId,
    pub(crate) b: ColliderId,
    /// Whether they touched in the last step.
    pub(crate) touching: bool,
    /// Whether one of them is a sensor: then there are no points.
    pub(crate) sensor: bool,
    /// How it is solved: 0 by sweeps, from 1 on directly, the more the longer that has been laborious, and 255 by sweeps as
    /// long as it lasts, because it was for too long.
    pub(crate) mode: u8,
    /// How many of the points count.
    pub(crate) count: u8,
    /// Which features the points are of.
    pub(crate) ids: [u8; 2],
    /// The impulse of each point along the normal, not negative.
    pub(crate) normal: [i64; 2],
    /// The impulse along the tangent, which is the normal turned counter-clockwise.
    pub(crate) tangent: i64,
}

impl Show for Contact {
    fn show(&self, cells: &mut Cells<'_>) {
        let Contact { a, b, touching, sensor, mode, count, ids, normal, tangent } = self;
        cells.field("a", |c| a.show(c));
        cells.field("b", |c| b.show(c));
        cells.field("touching", |c| touching.show(c));
        cells.field("sensor", |c| sensor.show(c));
        cells.field("mode", |c| mode.show(c));
        cells.field("count", |c| count.show(c));
        for (i, (id, normal)) in ids.iter().zip(normal).enumerate() {
            cells.field("points", |c| {
                c.element(i, |c| {
                    c.field("id", |c| id.show(c));
                    c.field("normal", |c| c.fixed(*normal, 48, "m/s"));
                });
            });
        }
        cells.field("tangent", |c| c.fixed(*tangent, 48, "m/s"));
    }
}

const WORDS: usize = 6;

impl Contact {
    /// As 64-bit words: ids, then flags, count, features and mode by bytes from the lowest, then impulses.
    fn pack(&self) -> [u64; WORDS] {
        let Contact { a, b, touching, sensor, mode, count, ids, normal, tangent } = self;
        let id = |id: &ColliderId| u64::from(id.generation) << 32 | u64::from(id.index);
        let flags = [u8::from(*touching), u8::from(*sensor), *count, ids[0], ids[1], *mode, 0, 0];
        let [n0, n1] = normal.map(|bits| bits as u64);
        [id(a), id(b), u64::from_le_bytes(flags), n0, n1, *tangent as u64]
    }

    fn unpack([a, b, flags, n0, n1, tangent]: [u64; WORDS]) -> Contact {
        let id = |word: u64| ColliderId { index: word as u32, generation: (word >> 32) as u32 };
        let flags = flags.to_le_bytes();
        Contact {
            a: id(a),
            b: id(b),
            touching: flags[0] != 0,
            sensor: flags[1] != 0,
            mode: flags[5],
            count: flags[2],
            ids: [flags[3], flags[4]],
            normal: [n0 as i64, n1 as i64],
            tangent: tangent as i64,
        }
    }

    /// Whether it is kept: what neither touches nor pushes is forgotten.
    pub(crate) fn lasts(&self) -> bool {
        self.touching || self.normal != [0; 2] || self.tangent != 0
    }

    /// What `is` ordered by.
    fn key(&self) -> (u32, u32) {
        (self.a.index, self.b.index)
    }

    /// Whether it could be of a tick of this engine; what is wrong, if not.
    fn check(&self) -> Result<(), &'static str> {
        let used = self.count as usize;
        let unused = (used.min(2)..2).all(|i| self.ids[i] == 0 && self.normal[i] == 0);
        let unused = unused && (used > 0 || self.tangent == 0 && self.mode == 0);
        let bounded = |bits: i64| bits.unsigned_abs() <= 1 << 60;
        let normals = self.normal.iter().all(|&n| n >= 0 && bounded(n));
        if used > 2 || !unused || !normals || !bounded(self.tangent) || self.a.index >= self.b.index {
            return Err("has a contact that no step makes");
        }
        let pushes = self.normal != [0; 2] || self.tangent != 0;
        // An impact touches without points.
        let reason = if self.sensor { self.touching && used == 0 } else { self.touching || used > 0 && pushes };
        if !reason {
            return Err("has a contact without a reason");
        }
        Ok(())
    }
}

/// All contacts, ordered by the slots of their colliders, at most one a pair.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    rows: Vec<[u64; WORDS]>,
}

crate::store::clone_fields!(Contacts { rows });

impl Contacts {
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn get(&self, at: usize) -> Contact {
        Contact::unpack(self.rows[at])
    }

    /// The slots of a contact's colliders.
    pub(crate) fn key(&self, at: usize) -> (u32, u32) {
        let [a, b, ..] = self.rows[at];
        (a as u32, b as u32)
    }

    /// Where the first is that does not come before these slots.
    pub(crate) fn place_of(&self, key: (u32, u32)) -> usize {
        self.rows.partition_point(|&[a, b, ..]| (a as u32, b as u32) < key)
    }

    /// The ids of a contact's colliders.
    pub(crate) fn ids(&self, at: usize) -> (ColliderId, ColliderId) {
        let contact = self.get(at);
        (contact.a, contact.b)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Contact> + '_ {
        self.rows.iter().map(|&row| Contact::unpack(row))
    }

    /// A row as memory has it, for faults.
    #[cfg(test)]
    pub(crate) fn raw(&mut self, at: usize) -> &mut [u64; WORDS] {
        &mut self.rows[at]
    }

    pub(crate) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Adds the contact that comes next in the order.
    pub(crate) fn push(&mut self, contact: &Contact) {
        debug_assert_eq!(contact.check(), Ok(()));
        self.rows.push(contact.pack());
    }

    /// Adds those that come next, and leaves none of them there.
    pub(crate) fn append(&mut self, others: &mut Contacts) {
        self.rows.append(&mut others.rows);
    }

    /// Hands on a table of them.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables, name: &'static str) {
        draft.table(tables, name, Kind::Contact, self.iter());
    }

    /// How many bytes of memory the rows use.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(self.rows.as_slice())
    }

    /// XXH3-64 of the rows' little-endian bytes.
    pub(crate) fn hash(&self) -> u64 {
        hash_words(&self.rows)
    }

    /// Every invariant of the list; what is wrong, if one is broken.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        for (row, contact) in self.rows.iter().zip(self.iter()) {
            contact.check()?;
            if contact.pack() != *row {
                return Err("has bits that mean nothing");
            }
        }
        let keys: Vec<_> = self.iter().map(|contact| contact.key()).collect();
        if keys.is_sorted_by(|a, b| a < b) { Ok(()) } else { Err("is out of order") }
    }
}

impl Record for Contacts {
    const LEAST: usize = 4;

    fn save(&self, sink: &mut impl Sink) {
        let Contacts { rows } = self;
        crate::store::put_count(sink, rows.len());
        for word in rows.iter().flatten() {
            word.save(sink);
        }
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let offset = reader.offset();
        let count = reader.take_count(WORDS.saturating_mul(8), field)?;
        let mut contacts = Contacts { rows: Vec::with_capacity(count) };
        for _ in 0..count {
            let mut row = [0; WORDS];
            for word in &mut row {
                *word = u64::load(reader, field)?;
            }
            contacts.rows.push(row);
        }
        contacts.check().map_err(|reason| reader.invalid(offset, field, reason))?;
        Ok(contacts)
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        if self.len() != other.len() {
            diff.field("len", |d| d.note(self.len().to_string(), other.len().to_string()));
        }
        for (at, (a, b)) in self.iter().zip(other.iter()).enumerate() {
            diff.element(at, |d| {
                d.field("a", |d| a.a.diff(&b.a, d));
                d.field("b", |d| a.b.diff(&b.b, d));
                d.field("touching", |d| a.touching.diff(&b.touching, d));
                d.field("sensor", |d| a.sensor.diff(&b.sensor, d));
                d.field("mode", |d| a.mode.diff(&b.mode, d));
                d.field("count", |d| a.count.diff(&b.count, d));
                let velocity = crate::num::Velocity::from_bits;
                d.field("tangent", |d| velocity(a.tangent).diff(&velocity(b.tangent), d));
                for i in 0..2 {
                    d.field("points", |d| {
                        d.element(i, |d| {
                            d.field("id", |d| a.ids[i].diff(&b.ids[i], d));
                            d.field("normal", |d| velocity(a.normal[i]).diff(&velocity(b.normal[i]), d));
                        });
                    });
                }
            });
        }
    }
}
