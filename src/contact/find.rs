//! Which colliders touch in this tick: from candidates to manifolds.
//!
//! What is found follows from bodies, colliders and contacts alone: the broad phase hands out more than that, in
//! order, and every pair is looked at exactly here.

use super::event::{Event, EventKind};
use super::island::rests;
use super::look::{Looks, See};
use super::proxy::{Proxies, Proxy};
use super::row::{Contact, Contacts};
use super::ways::{along, common_way};
use crate::body::{Bodies, Colliders};
use crate::broad::Broad;
use crate::geom::{Aabb, Vec2};
use crate::motion::Drive;
use crate::narrow::Manifold;
use crate::num::Length;
use crate::store::{Draft, Kind, Tables};

/// How far ahead contacts are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Margins {
    /// The distance at which resting colliders get contact points, Q32 m.
    pub(crate) base: i64,
    /// The tick in seconds, 63 fraction bits.
    pub(crate) tick: i64,
}

crate::store::show!(Margins { base, tick });

/// No contact of the last tick.
pub(crate) const NEW: u32 = u32::MAX;

/// Two colliders that have contact points, or a sensor and what overlaps it.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// Their slots, the lower one first.
    pub(crate) colliders: [u32; 2],
    /// The slots of their bodies.
    pub(crate) bodies: [u32; 2],
    /// Whether one of them is a sensor.
    pub(crate) sensor: bool,
    /// Without points for a sensor, and for what is not near but comes near in this tick.
    pub(crate) manifold: Manifold,
    /// Where the pair is among the contacts of the last tick, or [`NEW`].
    pub(crate) old: u32,
    /// Its place among those with rows, or [`NEW`].
    pub(crate) row: u32,
    /// How far they overlap when the tick begins, if they are about to strike; Q32 m.
    pub(crate) depth: i64,
    /// Whether it met in an impact, or has no rows and overlapped when the tick began.
    pub(crate) met: bool,
    /// C_R and the coefficient of friction of the two, Q48.
    pub(crate) restitution: i64,
    pub(crate) friction: i64,
    /// Whether the manifold was known from an earlier tick. Nothing but memories may ask.
    pub(crate) known: bool,
    /// Whether its bodies end the tick as they began it: then its contact does, too.
    pub(crate) stays: bool,
}

crate::store::show!(Pair { colliders, bodies, sensor, manifold, old, row, depth, met, restitution, friction, stays }
    apart { known });

impl Pair {
    fn new(slots: [u32; 2], [a, b]: [&Proxy; 2], manifold: Manifold, old: u32) -> Pair {
        Pair {
            colliders: slots,
            bodies: [a.body, b.body],
            sensor: a.sensor || b.sensor,
            manifold,
            old,
            row: NEW,
            depth: 0,
            met: false,
            restitution: a.restitution.combine(b.restitution).to_bits(),
            friction: a.friction.combine(b.friction).to_bits(),
            known: false,
            stays: false,
        }
    }

    /// What the last tick left of it.
    #[inline(always)]
    pub(crate) fn last(&self, contacts: &Contacts) -> Contact {
        if self.old == NEW { Contact::default() } else { contacts.get(self.old as usize) }
    }
}

/// The pairs of a tick, and what finding them needs. All of it is derived.
#[derive(Debug, Default)]
pub(crate) struct Touch {
    broad: Broad,
    proxies: Proxies,
    looks: Looks,
    /// Which candidates' boxes overlap, and then space.
    close: Vec<u32>,
    /// Ordered by colliders.
    pub(crate) pairs: Vec<Pair>,
}

impl Clone for Touch {
    fn clone(&self) -> Self {
        let mut copy = Touch::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        let Touch { broad, proxies, looks: _, close: _, pairs: _ } = source;
        self.broad.clone_from(broad);
        self.proxies.clone_from(proxies);
        self.looks.clear();
        self.pairs.clear();
    }
}

impl Touch {
    pub(crate) fn clear(&mut self) {
        self.broad.clear();
        self.looks.clear();
        self.pairs.clear();
    }

    /// Hands on the pairs as a table.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        draft.table(tables, "pairs", Kind::Pair, self.pairs.iter());
    }

    /// Notes a collider and puts it where its body is now; after anything about it was changed but by steps.
    pub(crate) fn set(&mut self, slot: usize, bodies: &Bodies, colliders: &Colliders) {
        let around = self.proxies.set(slot, bodies, colliders);
        if self.proxies.get(slot).still {
            self.broad.set_fixed(slot as u32, around);
        } else {
            self.broad.set_moving(slot as u32, around);
        }
        self.broad.touch(slot as u32);
    }

    /// Whether what is kept from tick to tick follows from bodies and colliders.
    pub(crate) fn check(&self, bodies: &Bodies, colliders: &Colliders) -> Result<(), &'static str> {
        if !self.proxies.check(bodies, colliders) {
            return Err("knows a collider that is another one");
        }
        if self.looks.iter().all(|look| look.check(&self.proxies)) {
            Ok(())
        } else {
            Err("has seen a pair that is not so")
        }
    }

    /// Of how many pairs all was known in the last tick from an earlier one.
    #[cfg(test)]
    pub(super) fn known(&self) -> usize {
        self.looks.iter().filter(|look| look.tick > 0 && look.tick < self.proxies.now()).count()
    }

    /// Adds to `found` the bodies of those colliders for which the broad phase has a fixed box, and which are `elsewhere`.
    pub(crate) fn find_displaced(&self, elsewhere: impl Fn(usize) -> bool, found: &mut Vec<u32>) {
        let bodies = self.broad.fixed().map(|slot| self.proxies.get(slot).body);
        found.extend(bodies.filter(|&body| elsewhere(body as usize)));
    }

    pub(crate) fn remove(&mut self, slot: usize) {
        self.broad.remove(slot as u32);
    }

    /// Finds the pairs of this tick.
    pub(crate) fn find(
        &mut self,
        bodies: &Bodies,
        colliders: &Colliders,
        contacts: &Contacts,
        drive: &Drive,
        margins: Margins,
    ) {
        self.pairs.clear();
        if colliders.rows.live() == 0 {
            return;
        }
        self.proxies.begin();
        let proxies = &mut self.proxies;
        let swept = |slot: u32| proxies.sweep(slot as usize, bodies, colliders, drive, margins);
        let shift = common_way(bodies, margins.tick);
        self.broad.update(shift, swept, |a, b| wanted(bodies, colliders, a as usize, b as usize));

        let any_asleep = bodies.rest.any_asleep();
        let mut old = 0;
        self.looks.begin();
        for at in 0..self.find_close() {
            let (a, b) = self.broad.candidates()[self.close[at] as usize];
            let slots = [a as usize, b as usize];
            let body = slots.map(|slot| self.proxies.get(slot).body);
            if any_asleep && rests(bodies, colliders, [a, b], body) || self.are_apart(slots, bodies, colliders, margins)
            {
                continue;
            }
            let look = self.looks.next([a, b]);
            let seen = See { proxies: &self.proxies, slots, bodies, drive, margins };
            let Some(manifold) = seen.meet(look) else {
                continue;
            };
            let known = look.tick < self.proxies.now();
            let proxies = slots.map(|slot| self.proxies.get(slot));
            while old < contacts.len() && contacts.key(old) < (a, b) {
                old = old.saturating_add(1);
            }
            let lasts = old < contacts.len() && contacts.ids(old) == (proxies[0].id, proxies[1].id);
            let old = if lasts { old as u32 } else { NEW };
            self.pairs.push(Pair { known, ..Pair::new([a, b], proxies, manifold, old) });
        }
        self.looks.end();
    }

    /// Of the candidates those whose boxes overlap, as far as they are known. How many.
    fn find_close(&mut self) -> usize {
        let candidates = self.broad.candidates();
        let boxes = self.proxies.boxes();
        if self.close.len() < candidates.len() {
            self.close.resize(candidates.len(), 0);
        }
        // Without branches: which of them do cannot be foretold.
        let mut found = 0usize;
        for (at, &(a, b)) in (0..).zip(candidates) {
            self.close[found] = at;
            found = found.saturating_add(usize::from(boxes[a as usize].overlaps(&boxes[b as usize])));
        }
        found
    }

    /// Has the outlines of a pair whose boxes overlapped lie as their bodies do; whether their boxes tell now that it is none.
    /// Those may have become less since then for another pair.
    fn are_apart(&mut self, slots: [usize; 2], bodies: &Bodies, colliders: &Colliders, margins: Margins) -> bool {
        for slot in slots {
            self.proxies.ask(slot);
            if !self.proxies.get(slot).turned.done {
                self.proxies.place(slot, bodies, colliders, margins);
            }
        }
        let boxes = self.proxies.boxes();
        !boxes[slots[0]].overlaps(&boxes[slots[1]])
    }

    /// Where a pair is among those of the tick, or [`NEW`], and whether it has rows.
    pub(crate) fn pair_of(&self, colliders: [u32; 2]) -> (u32, bool) {
        match self.pairs.binary_search_by_key(&colliders, |pair| pair.colliders) {
            Ok(at) => (at as u32, self.pairs[at].row != NEW),
            Err(_) => (NEW, false),
        }
    }

    /// Whether two colliders that meet would push each other.
    pub(crate) fn may_strike(&self, [a, b]: [u32; 2], bodies: &Bodies, colliders: &Colliders) -> bool {
        let sensor = |slot: u32| colliders.rows.value(slot as usize).sensor;
        !sensor(a) && !sensor(b) && wanted(bodies, colliders, a as usize, b as usize)
    }

    /// Visits all colliders whose [`Touch::way`] overlaps `aabb`, and maybe others.
    pub(crate) fn around(&self, aabb: &Aabb, visit: impl FnMut(u32)) {
        self.broad.query(aabb, visit);
    }

    /// A box that is around the free way of a collider in this tick: from where its body was when the tick began, its
    /// velocity (Q48) then, and what that gains.
    pub(crate) fn way(&self, slot: usize, at: [i64; 2], v: [i64; 2], gain: [i64; 2], margins: Margins) -> Aabb {
        let reach = self.proxies.get(slot).reach;
        let at = Vec2::new(Length::from_bits(at[0]), Length::from_bits(at[1]));
        along(at, v, gain, [reach.saturating_neg(); 2], [reach; 2], margins.tick)
    }

    /// Adds pairs that impacts brought together, though their own ways would not have.
    pub(crate) fn join(&mut self, late: &mut Vec<[[u32; 2]; 2]>, contacts: &Contacts) {
        if late.is_empty() {
            return;
        }
        for [pair, _] in late.drain(..) {
            let proxies = pair.map(|slot| self.proxies.get(slot as usize));
            let ids = (proxies[0].id, proxies[1].id);
            let old = (0..contacts.len()).find(|&at| contacts.ids(at) == ids).map_or(NEW, |at| at as u32);
            self.pairs.push(Pair { met: true, ..Pair::new(pair, proxies, Manifold::default(), old) });
        }
        self.pairs.sort_unstable_by_key(|pair| pair.colliders);
    }

    /// The contacts after the step: `outcome` says of a pair what the solver made of it. What began and
    /// ended goes to `events`; `next` is where the list is built.
    pub(crate) fn finish(
        &self,
        contacts: &mut Contacts,
        next: &mut Contacts,
        colliders: &Colliders,
        events: &mut Vec<Event>,
        outcome: impl Fn(&Pair) -> Contact,
    ) {
        events.clear();
        next.clear();
        let mut old = 0;
        let end = |contact: Contact, events: &mut Vec<Event>| {
            if contact.touching {
                let kind = if contact.sensor { EventKind::SensorEnd } else { EventKind::ContactEnd };
                events.push(Event { tick: 0, kind, a: contact.a, b: contact.b });
            }
        };
        for pair in &self.pairs {
            let [a, b] = pair.colliders;
            while old < contacts.len() && (old as u32 != pair.old && contacts.key(old) <= (a, b)) {
                end(contacts.get(old), events);
                old = old.saturating_add(1);
            }
            let before = if pair.old == NEW { Contact::default() } else { contacts.get(old) };
            old = old.saturating_add(usize::from(pair.old != NEW));
            let (a, b) = (colliders.id(a as usize), colliders.id(b as usize));
            let contact = if pair.sensor {
                Contact { a, b, touching: true, sensor: true, ..Contact::default() }
            } else if pair.stays {
                before
            } else {
                Contact { a, b, ..outcome(pair) }
            };
            match (before.touching, contact.touching) {
                (false, true) if contact.sensor => events.push(Event { tick: 0, kind: EventKind::SensorBegin, a, b }),
                (false, true) => events.push(Event { tick: 0, kind: EventKind::ContactBegin, a, b }),
                (true, false) => end(before, events),
                _ => {}
            }
            if contact.lasts() {
                next.push(&contact);
            }
        }
        for at in old..contacts.len() {
            end(contacts.get(at), events);
        }
        core::mem::swap(contacts, next);
    }
}

/// Whether two colliders have anything to do with each other.
fn wanted(bodies: &Bodies, colliders: &Colliders, a: usize, b: usize) -> bool {
    let (a, b) = (colliders.rows.value(a), colliders.rows.value(b));
    if a.body == b.body || !a.filter.meets(b.filter) || a.sensor && b.sensor {
        return false;
    }
    let dynamic = |body: u32| bodies.cold.value(body as usize).is_dynamic();
    a.sensor || b.sensor || dynamic(a.body) || dynamic(b.body)
}
