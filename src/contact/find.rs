//! Which colliders touch in this tick: from candidates to manifolds.
//!
//! What is found follows from bodies, colliders and contacts alone: the broad phase hands out more than that, in
//! order, and every pair is looked at exactly here.

use super::event::{Event, EventKind};
use super::island::rests;
use super::look::{Look, Looks};
use super::proxy::{Proxies, Proxy};
use super::row::{Contact, Contacts};
use super::ways::{along, common_way, way};
use crate::body::{Bodies, Colliders};
use crate::broad::Broad;
use crate::geom::{Aabb, Vec2};
use crate::motion::Drive;
use crate::narrow::{Manifold, Near, near, overlap};
use crate::num::{Length, cross, dot, mul};
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
}

crate::store::show!(Pair { colliders, bodies, sensor, manifold, old, row, depth, met, restitution, friction });

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
        }
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
            let proxies = slots.map(|slot| self.proxies.get(slot));
            while old < contacts.len() && contacts.key(old) < (a, b) {
                old = old.saturating_add(1);
            }
            let known = old < contacts.len() && contacts.ids(old) == (proxies[0].id, proxies[1].id);
            let old = if known { old as u32 } else { NEW };
            self.pairs.push(Pair::new([a, b], proxies, manifold, old));
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

    /// Has the outlines of a pair whose boxes overlap lie as their bodies do; whether their boxes tell now that it is none.
    fn are_apart(&mut self, slots: [usize; 2], bodies: &Bodies, colliders: &Colliders, margins: Margins) -> bool {
        let mut late = false;
        for slot in slots {
            self.proxies.ask(slot);
            if !self.proxies.get(slot).turned.done {
                self.proxies.place(slot, bodies, colliders, margins);
                late = true;
            }
        }
        let boxes = self.proxies.boxes();
        late && !boxes[slots[0]].overlaps(&boxes[slots[1]])
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

/// A pair whose boxes overlap.
struct See<'t> {
    proxies: &'t Proxies,
    slots: [usize; 2],
    bodies: &'t Bodies,
    drive: &'t Drive,
    margins: Margins,
}

impl See<'_> {
    /// Its manifold; one without points for a sensor, and for two that are not near but may meet in this tick.
    #[inline]
    fn meet(&self, look: &mut Look) -> Option<Manifold> {
        let See { proxies, slots, bodies, margins, .. } = *self;
        let [a, b] = slots.map(|slot| proxies.get(slot));
        let between = |c: &[i64]| c[b.body as usize].saturating_sub(c[a.body as usize]);
        let d = [between(bodies.x.bits()), between(bodies.y.bits())];
        let mut known = look.d == d && look.tick >= a.turned.tick.max(b.turned.tick);
        let [placed_a, placed_b] = slots.map(|slot| proxies.placed(slot));
        if a.sensor || b.sensor {
            return overlap(placed_a, placed_b, d).then(Manifold::default);
        }
        // Where all points are within the margin it does not matter how fast they are, and most pairs stay so.
        let rests = |near: &Near| near.manifold.count > 0 && near.holds(margins.base) && near.below == i64::MAX;
        let rested = rests(&look.near);
        if rested && !known {
            (look.tick, look.d, look.near) = (proxies.now(), d, near(placed_a, placed_b, d, margins.base));
            known = true;
        }
        if rested && rests(&look.near) {
            return Some(look.near.manifold.clone());
        }
        let ahead = self.ahead();
        let limit = margins.base.saturating_add(ahead);
        if !known || !look.near.holds(limit) {
            (look.tick, look.d, look.near) = (proxies.now(), d, near(placed_a, placed_b, d, limit));
        }
        let Near { apart, ref manifold, from, .. } = look.near;
        if apart {
            return None;
        }
        if manifold.count == 0 {
            // Corner before corner: rows hold no such pair, so what matters is whether it may meet: whether less than its way
            // is between them.
            return (from <= ahead).then(Manifold::default);
        }
        self.of_this_tick(manifold, d)
    }

    /// How far the two may come nearer in this tick, Q32 m.
    fn ahead(&self) -> i64 {
        let See { bodies, drive, margins, .. } = *self;
        let [a, b] = self.slots.map(|slot| self.proxies.get(slot));
        let bodies_of = [a.body as usize, b.body as usize];
        let (vx, vy) = (bodies.vx.bits(), bodies.vy.bits());
        let apart = |c: &[i64]| c[bodies_of[0]].saturating_sub(c[bodies_of[1]]).saturating_abs();
        let [rim_a, rim_b] = self.slots.map(|slot| self.proxies.rim(slot, bodies));
        let fastest = [apart(vx), apart(vy), rim_a, rim_b];
        let fastest = fastest.iter().fold(0i64, |sum, &speed| sum.saturating_add(speed));
        let [ga, gb] = bodies_of.map(|body| drive.gain(body, margins.tick));
        let pressed = [0, 1].map(|axis: usize| ga[axis].saturating_sub(gb[axis]).saturating_abs());
        let pressed = pressed[0].saturating_add(pressed[1]) / 2;
        way(fastest.saturating_add(pressed), margins.tick)
    }

    /// A manifold without those points beyond the margin that the ways of this tick do not bring near.
    fn of_this_tick(&self, manifold: &Manifold, d: [i64; 2]) -> Option<Manifold> {
        let See { bodies, margins, .. } = *self;
        let mut manifold = manifold.clone();
        if manifold.points[..manifold.count as usize].iter().all(|point| point.separation > margins.base) {
            return Some(Manifold::default());
        }
        let [a, b] = self.slots.map(|slot| self.proxies.get(slot));
        let apart = |c: &[i64]| c[a.body as usize].saturating_sub(c[b.body as usize]);
        let (v, omega) = ([apart(bodies.vx.bits()), apart(bodies.vy.bits())], bodies.omega.bits());
        let n = manifold.normal.map(i64::from);
        let mut kept = 0;
        for at in 0..manifold.count as usize {
            let point = manifold.points[at];
            if point.separation > margins.base {
                let arm_b = [point.arm[0].saturating_sub(d[0]), point.arm[1].saturating_sub(d[1])];
                // Turning brings a point nearer by no more than what its reach is beyond where it is now.
                let turning = |proxy: &Proxy, arm: [i64; 2], side: i64| {
                    let speed = mul(omega[proxy.body as usize], cross(arm, n, 30), 32).saturating_mul(side);
                    let left = proxy.reach.saturating_add(dot(arm, n, 30).saturating_mul(side)).max(0);
                    way(speed, margins.tick).max(left.saturating_neg())
                };
                let turned = turning(a, point.arm, 1).saturating_add(turning(b, arm_b, -1));
                let nearer = way(dot(v, n, 30), margins.tick).saturating_add(turned);
                if point.separation.saturating_add(nearer) > margins.base >> 3 {
                    continue;
                }
            }
            manifold.points[kept] = point;
            kept = kept.saturating_add(1);
        }
        manifold.count = kept as u8;
        Some(manifold)
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
