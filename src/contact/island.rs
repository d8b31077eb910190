//! Islands: what hangs together by contacts, falls asleep and wakes together. The contacts of what sleeps lie apart, so
//! that a tick does not look at them.
//!
//! A contact connects two dynamic bodies whether it pushes or not, but for sensors. Static and kinematic bodies connect
//! nothing.

use super::row::{Contact, Contacts};
use crate::body::{Bodies, BodyKind, Colliders};
use crate::num::AngularVelocity;
use crate::store::{DecodeError, Diff, Draft, Kind, Reader, Record, Sink, Tables, clone_fields, show};
use core::ops::Range;

/// Whether a pair of colliders is left as it is: one of its bodies sleeps, and the other does as well or stays. A kinematic
/// body stays while it has no velocity; a sensor on one or in its way is looked at all the same.
pub(super) fn rests(bodies: &Bodies, colliders: &Colliders, [a, b]: [u32; 2], of: [u32; 2]) -> bool {
    let asleep = of.map(|slot| bodies.rest.is_asleep(slot as usize));
    if asleep == [false; 2] {
        return false;
    }
    let sensor = || [a, b].iter().any(|&slot| colliders.rows.value(slot as usize).sensor);
    let stays = |slot: u32| match bodies.cold.value(slot as usize).kind {
        BodyKind::Static => true,
        BodyKind::Kinematic => !sensor() && !moves(bodies, slot as usize),
        BodyKind::Dynamic => false,
    };
    (asleep[0] || stays(of[0])) && (asleep[1] || stays(of[1]))
}

/// Whether a body has a velocity.
fn moves(bodies: &Bodies, slot: usize) -> bool {
    !bodies.velocity(slot).is_zero() || bodies.omega.get(slot) != AngularVelocity::ZERO
}

/// The bodies of a contact; `None` if a collider is gone.
fn bodies_of(contact: &Contact, colliders: &Colliders) -> Option<[u32; 2]> {
    let of = |id| colliders.slot(id).map(|slot| colliders.rows.value(slot).body);
    Some([of(contact.a)?, of(contact.b)?])
}

/// Whether a contact belongs to those of what sleeps.
fn is_resting(contact: &Contact, bodies: &Bodies, colliders: &Colliders) -> bool {
    let of = bodies_of(contact, colliders);
    of.is_some_and(|of| rests(bodies, colliders, [contact.a.index, contact.b.index], of))
}

/// Sets of bodies, by slot: a forest for telling sets apart, and a ring through each for going round it.
#[derive(Debug, Default)]
pub(crate) struct Sets {
    parent: Vec<u32>,
    ring: Vec<u32>,
}

clone_fields!(Sets { parent, ring });

impl Sets {
    /// Every body by itself, of those in these runs; the others are not asked for.
    fn clear(&mut self, slots: usize, runs: impl Iterator<Item = Range<usize>>) {
        self.parent.resize(slots, 0);
        self.ring.resize(slots, 0);
        for slot in runs.flatten() {
            (self.parent[slot], self.ring[slot]) = (slot as u32, slot as u32);
        }
    }

    /// The body that stands for a set: which one does not matter.
    fn root(&mut self, slot: u32) -> u32 {
        let mut at = slot;
        while self.parent[at as usize] != at {
            let above = self.parent[at as usize];
            self.parent[at as usize] = self.parent[above as usize];
            at = above;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (one, other) = (self.root(a), self.root(b));
        if one != other {
            self.parent[one.max(other) as usize] = one.min(other);
            self.ring.swap(a as usize, b as usize);
        }
    }

    /// Joins the bodies of all contacts that `connects`.
    fn join_all(&mut self, contacts: &Contacts, colliders: &Colliders, connects: impl Fn(usize) -> bool) {
        for contact in contacts.iter().filter(|contact| !contact.sensor) {
            if let Some([a, b]) = bodies_of(&contact, colliders) {
                if connects(a as usize) && connects(b as usize) {
                    self.join(a, b);
                }
            }
        }
    }

    /// The next body of a set, round and round.
    pub(crate) fn next(&self, slot: usize) -> usize {
        self.ring.get(slot).map_or(slot, |&next| next as usize)
    }

    /// Visits a set from one of its bodies on.
    pub(crate) fn round(&self, from: usize, mut visit: impl FnMut(usize)) {
        let mut slot = from;
        loop {
            visit(slot);
            slot = self.next(slot);
            if slot == from {
                return;
            }
        }
    }
}

/// The contacts of what sleeps: as they were when it fell asleep, impulses too, so that what wakes stands as it stood.
#[derive(Debug, Default)]
pub(crate) struct Resting {
    pub(crate) contacts: Contacts,
    /// Their hash. Derived, as all that follows.
    hash: u64,
    /// The islands of what sleeps.
    pub(crate) islands: Sets,
    /// By slot of a body: whether a contact of what sleeps is with it, or was.
    bears: Vec<bool>,
    /// Whether contacts may be on the wrong list, because somebody woke or is gone.
    stale: bool,
    // Space: for sets that may fall asleep, for those that must not, for lists of bodies, for lists of contacts, and what
    // the step changes.
    sets: Sets,
    up: Vec<bool>,
    pub(crate) found: Vec<u32>,
    space: [Contacts; 2],
    pub(crate) before: Vec<i64>,
}

impl Clone for Resting {
    fn clone(&self) -> Self {
        let mut copy = Resting::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        let Resting { contacts, hash, islands, bears, stale, sets: _, up: _, found: _, space: _, before: _ } = source;
        self.contacts.clone_from(contacts);
        self.hash = *hash;
        self.islands.clone_from(islands);
        self.bears.clone_from(bears);
        self.stale = *stale;
    }
}

impl Record for Resting {
    const LEAST: usize = Contacts::LEAST;

    fn save(&self, sink: &mut impl Sink) {
        self.contacts.save(sink);
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let contacts = Contacts::load(reader, field)?;
        Ok(Resting { hash: contacts.hash(), contacts, ..Resting::default() })
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        self.contacts.diff(&other.contacts, diff);
    }
}

impl Resting {
    /// Derives what is derived.
    pub(crate) fn derive(&mut self, awake: &Contacts, bodies: &Bodies, colliders: &Colliders) {
        let Resting { contacts, hash, islands, bears, stale, .. } = self;
        *hash = contacts.hash();
        let slots = bodies.rest.len();
        islands.clear(slots, core::iter::once(0..slots));
        islands.join_all(contacts, colliders, |slot| bodies.rest.is_asleep(slot));
        bears.clear();
        bears.resize(slots, false);
        let resting = |contact: &Contact| is_resting(contact, bodies, colliders);
        *stale = !contacts.iter().all(|contact| resting(&contact)) || awake.iter().any(|contact| resting(&contact));
        for slot in contacts.iter().filter_map(|contact| bodies_of(&contact, colliders)).flatten() {
            bears[slot as usize] = true;
        }
    }

    /// Whether contacts may be on the wrong list.
    pub(crate) fn is_stirred(&self) -> bool {
        self.stale
    }

    /// Puts back the contacts that have this hash, after bodies and the contacts of what is awake were put back. `same`:
    /// whether the same bodies sleep as before, and have the same colliders; `stirred`: what [`Resting::is_stirred`] was.
    pub(crate) fn revert(
        &mut self,
        (contacts, hash): (&Contacts, u64),
        (same, stirred): (bool, bool),
        awake: &Contacts,
        bodies: &Bodies,
        colliders: &Colliders,
    ) {
        if !same || hash != self.hash || contacts.len() != self.contacts.len() {
            self.contacts.clone_from(contacts);
            self.derive(awake, bodies, colliders);
        }
        self.stale = stirred;
    }

    /// Notes that contacts may be on the wrong list.
    pub(crate) fn stir(&mut self) {
        self.stale = true;
    }

    /// Puts every contact on its list, of what is awake or of what sleeps, if one may be on the other.
    pub(crate) fn settle(&mut self, awake: &mut Contacts, bodies: &Bodies, colliders: &Colliders) {
        if !self.stale {
            return;
        }
        let Resting { contacts, space: [up, down], .. } = self;
        up.clear();
        down.clear();
        let (mut i, mut j) = (0, 0);
        while i < awake.len() || j < contacts.len() {
            let key = |list: &Contacts, at: usize| if at < list.len() { list.key(at) } else { (u32::MAX, u32::MAX) };
            let (a, b) = (key(awake, i), key(contacts, j));
            let contact = if b <= a { contacts.get(j) } else { awake.get(i) };
            // A pair is on one list only.
            i = i.saturating_add(usize::from(a <= b));
            j = j.saturating_add(usize::from(b <= a));
            if is_resting(&contact, bodies, colliders) { &mut *down } else { &mut *up }.push(&contact);
        }
        awake.clone_from(up);
        contacts.clone_from(down);
        self.derive(awake, bodies, colliders);
    }

    /// The sleeping bodies that touch a body, or are in a sensor of it, into `found`.
    pub(crate) fn find_on(&mut self, slot: usize, bodies: &Bodies, colliders: &Colliders) {
        self.found.clear();
        if self.bears.get(slot) != Some(&true) {
            return;
        }
        for of in self.contacts.iter().filter_map(|contact| bodies_of(&contact, colliders)) {
            if of.contains(&(slot as u32)) {
                self.found.extend(of.into_iter().filter(|&of| bodies.rest.is_asleep(of as usize)));
            }
        }
    }

    /// The dynamic bodies that hang together with one, into `found`.
    pub(crate) fn find_island(&mut self, slot: usize, awake: &Contacts, bodies: &Bodies, colliders: &Colliders) {
        let Resting { contacts, sets, found, .. } = self;
        sets.clear(bodies.rest.len(), core::iter::once(0..bodies.rest.len()));
        for list in [&*contacts, awake] {
            sets.join_all(list, colliders, |slot| bodies.cold.value(slot).is_dynamic());
        }
        found.clear();
        sets.round(slot, |slot| found.push(slot as u32));
    }

    /// Counts for how long each body has been quiet: up to `enough` ticks. The bodies of islands that have been for as long, into
    /// `found`: they fall asleep.
    pub(crate) fn find_quiet(
        &mut self,
        awake: &Contacts,
        bodies: &mut Bodies,
        colliders: &Colliders,
        (speed, enough): (i64, u32),
    ) {
        self.found.clear();
        if !count(bodies, speed, enough) {
            return;
        }
        let Resting { sets, up, found, .. } = self;
        let dynamic = |slot: usize| bodies.cold.value(slot).is_dynamic();
        sets.clear(bodies.rest.len(), bodies.rest.all_runs());
        sets.join_all(awake, colliders, dynamic);
        up.resize(bodies.rest.len(), false);
        bodies.rest.all_runs().for_each(|run| up[run].fill(false));
        // What a kinematic body moves against does not rest, however slowly that is.
        for contact in awake.iter().filter(|contact| !contact.sensor) {
            let Some(of) = bodies_of(&contact, colliders) else { continue };
            let of = of.map(|slot| slot as usize);
            if of.iter().any(|&slot| bodies.cold.value(slot).kind == BodyKind::Kinematic && moves(bodies, slot)) {
                of.into_iter()
                    .filter(|&slot| dynamic(slot))
                    .for_each(|slot| up[sets.root(slot as u32) as usize] = true);
            }
        }
        let awake = || bodies.rest.all_runs().flatten().filter(|&slot| dynamic(slot));
        for slot in awake() {
            if bodies.rest.quiet(slot) < enough || !bodies.cold.value(slot).allow_sleep {
                up[sets.root(slot as u32) as usize] = true;
            }
        }
        found.extend(awake().map(|slot| slot as u32).filter(|&slot| !up[sets.root(slot) as usize]));
    }

    /// Hands on what sleeps as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        struct Known {
            hash: u64,
        }
        show!(Known { hash });
        self.contacts.show(draft, tables, "sleeping contacts");
        draft.table(tables, "hash of sleeping contacts", Kind::World, core::iter::once(Known { hash: self.hash }));
    }

    /// The hash of all of it.
    pub(crate) fn hash(&self) -> u64 {
        self.hash
    }

    /// Every invariant; what is wrong, if one is broken.
    pub(crate) fn check(&self, awake: &Contacts, bodies: &Bodies, colliders: &Colliders) -> Result<(), &'static str> {
        self.contacts.check()?;
        let mut fresh = Resting { contacts: self.contacts.clone(), ..Resting::default() };
        fresh.derive(awake, bodies, colliders);
        if fresh.hash != self.hash {
            return Err("has a hash that is not its own");
        }
        if fresh.stale && !self.stale {
            return Err("has contacts of what is awake, or lacks some of what sleeps");
        }
        let asleep = |&slot: &usize| bodies.rest.is_asleep(slot);
        if (0..bodies.rest.len()).filter(asleep).any(|slot| fresh.islands.next(slot) != self.islands.next(slot)) {
            return Err("has islands that do not follow from it");
        }
        // What has woken since may still be noted.
        if fresh.bears.iter().zip(&self.bears).any(|(fresh, known)| *fresh && !known) {
            return Err("does not know what bears what sleeps");
        }
        Ok(())
    }
}

/// Counts quiet ticks of the dynamic bodies that are awake, and says whether one has had enough of them.
fn count(bodies: &mut Bodies, speed: i64, enough: u32) -> bool {
    let mut any = false;
    for at in 0..bodies.rest.runs() {
        for slot in bodies.rest.run(at) {
            let known = bodies.rest.quiet(slot);
            let quiet = bodies.is_quiet(slot, speed) && bodies.cold.value(slot).is_dynamic();
            let ticks = if quiet { known.saturating_add(1).min(enough) } else { 0 };
            any |= ticks == enough;
            if ticks != known {
                bodies.rest.note(slot, ticks);
            }
        }
    }
    any
}
