//! Which colliders touch in this tick: from candidates to manifolds.
//!
//! What is found follows from bodies, colliders and contacts alone: the broad phase hands out more than that, in
//! order, and every pair is looked at exactly here.

use super::end::{Ending, Kept};
use super::event::Event;
use super::island::rests;
use super::look::Looks;
use super::proxy::{Course, Proxies, Proxy};
use super::row::{Contact, Contacts};
use super::search::{Found, Search, View};
use super::ways::{along, common_way};
use crate::body::{Bodies, Colliders};
use crate::broad::Broad;
use crate::geom::{Aabb, Vec2};
use crate::motion::Drive;
use crate::narrow::Manifold;
use crate::num::{Length, lane::next};
use crate::store::{Draft, Kind, Tables};
use crate::threads::Crew;

/// How far ahead contacts are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Margins {
    /// The distance at which resting colliders get contact points, Q32 m.
    pub(crate) base: i64,
    /// The tick in seconds, 63 fraction bits.
    pub(crate) tick: i64,
}

crate::store::show!(Margins { base, tick });

/// So many candidates make a piece: 5 µs where nothing has changed.
const LOOKS: usize = 128;
/// So many pairs make a piece, of what became of them: 5 µs.
const OUTCOMES: usize = 256;

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
    pub(super) fn new(slots: [u32; 2], [a, b]: [&Proxy; 2], manifold: Manifold, old: u32) -> Pair {
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
    /// By piece of the candidates: space.
    found: Vec<Found>,
    /// By piece of the pairs: space.
    kept: Vec<Kept>,
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
        let Touch { broad, proxies, looks: _, close: _, found: _, kept: _, pairs: _ } = source;
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
        crew: Crew,
    ) {
        self.pairs.clear();
        if colliders.rows.live() == 0 {
            return;
        }
        self.proxies.begin();
        let course = Course { bodies, colliders, drive, margins };
        let (shift, swept) = (common_way(bodies, margins.tick), self.proxies.placing(course));
        self.broad.update(shift, swept, |a, b| wanted(bodies, colliders, a as usize, b as usize), crew);

        let close = self.place_close(course);
        let Touch { broad, proxies, looks, close: list, found, kept: _, pairs } = self;
        let view = View { proxies, bodies, contacts, drive, margins };
        let search = Search { candidates: broad.candidates(), close: &list[..close], seen: looks.seen(), view };
        let pieces = crew.note(search, LOOKS, found, |search, found| search.run(found));
        let found = &mut found[..pieces];
        // What the first one found is most of it, where there is one only.
        core::mem::swap(pairs, &mut found[0].pairs);
        found[1..].iter_mut().for_each(|found| pairs.append(&mut found.pairs));
        looks.end(found);
    }

    /// Has the outlines of all pairs lie whose boxes overlap, and then keeps those whose boxes still do. How many.
    fn place_close(&mut self, course: Course<'_>) -> usize {
        let Course { bodies, colliders, .. } = course;
        let any_asleep = bodies.rest.any_asleep();
        let mut kept = 0;
        for at in 0..self.find_close() {
            let candidate = self.close[at];
            let (a, b) = self.broad.candidates()[candidate as usize];
            let slots = [a as usize, b as usize];
            let body = slots.map(|slot| self.proxies.get(slot).body);
            if any_asleep && rests(bodies, colliders, [a, b], body) || self.are_apart(slots, course) {
                continue;
            }
            self.close[kept] = candidate;
            kept = next(kept);
        }
        kept
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
    fn are_apart(&mut self, slots: [usize; 2], course: Course<'_>) -> bool {
        for slot in slots {
            self.proxies.ask(slot);
            if !self.proxies.get(slot).turned.done {
                self.proxies.placing(course).place(slot);
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
        &mut self,
        contacts: &mut Contacts,
        next: &mut Contacts,
        colliders: &Colliders,
        events: &mut Vec<Event>,
        outcome: impl Fn(&Pair) -> Contact + Sync,
        crew: Crew,
    ) {
        let Touch { pairs, kept, .. } = self;
        let ending = Ending { pairs, contacts, old: 0..contacts.len(), colliders };
        let pieces = crew.note(ending, OUTCOMES, kept, |ending, kept| ending.run(kept, &outcome));
        let kept = &mut kept[..pieces];
        core::mem::swap(next, &mut kept[0].contacts);
        core::mem::swap(events, &mut kept[0].events);
        for kept in &mut kept[1..] {
            next.append(&mut kept.contacts);
            events.append(&mut kept.events);
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
