//! Which colliders touch in this tick: from candidates to manifolds.
//!
//! What is found follows from bodies, colliders and contacts alone: the broad phase hands out more than that, in
//! order, and every pair is looked at exactly here.

use super::event::{Event, EventKind};
use super::island::rests;
use super::row::{Contact, Contacts};
use super::ways::{along, around, common_way, rim_speed, sweep, way};
use crate::body::{Bodies, Colliders};
use crate::broad::Broad;
use crate::geom::{Aabb, Rot, Vec2};
use crate::motion::Drive;
use crate::narrow::{Manifold, near, overlap};
use crate::num::{Length, cross, dot, mul};
use crate::shape::Placed;
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
    pub(crate) fn new(slots: [u32; 2], bodies: [u32; 2], manifold: Manifold, colliders: &Colliders) -> Pair {
        let [a, b] = slots.map(|slot| colliders.rows.value(slot as usize));
        Pair {
            colliders: slots,
            bodies,
            sensor: a.sensor || b.sensor,
            manifold,
            old: NEW,
            row: NEW,
            depth: 0,
            met: false,
            restitution: a.restitution.combine(b.restitution).to_bits(),
            friction: a.friction.combine(b.friction).to_bits(),
        }
    }
}

/// What is known of a collider without looking it up.
#[derive(Clone, Copy, Debug, Default)]
struct Proxy {
    body: u32,
    /// No point is farther from the centre of mass, Q32 m.
    reach: i64,
}

/// The pairs of a tick, and what finding them needs. All of it is derived, and none of it lasts but the broad phase.
#[derive(Debug, Default)]
pub(crate) struct Touch {
    broad: Broad,
    proxies: Vec<Proxy>,
    /// By collider: its outline in the world's axes, and the box around its way, if `seen` is this tick's number.
    placed: Vec<Placed>,
    boxes: Vec<Aabb>,
    seen: Vec<u64>,
    now: u64,
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
        let Touch { broad, proxies, placed, boxes: _, seen: _, now: _, pairs: _ } = source;
        self.broad.clone_from(broad);
        self.proxies.clone_from(proxies);
        // What was placed for a tick is placed anew in the next one.
        self.make_room(placed.len());
        self.seen.fill(0);
        self.now = 0;
        self.pairs.clear();
    }
}

impl Touch {
    pub(crate) fn clear(&mut self) {
        self.broad.clear();
        self.pairs.clear();
    }

    /// Hands on the pairs as a table.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        draft.table(tables, "pairs", Kind::Pair, self.pairs.iter());
    }

    /// Puts a collider where its body is now; after it was created, teleported, or changed its kind or filter.
    pub(crate) fn set(&mut self, slot: usize, bodies: &Bodies, colliders: &Colliders) {
        let body = colliders.rows.value(slot).body;
        let reach = colliders.outline(slot).reach;
        if self.proxies.len() <= slot {
            let slots = slot.saturating_add(1);
            self.proxies.resize(slots, Proxy::default());
            self.make_room(slots);
        }
        self.proxies[slot] = Proxy { body, reach };
        let at = body as usize;
        if bodies.is_still(at) {
            let placed = Placed::new(colliders.outline(slot), Rot::new(bodies.angle.get(at)));
            self.broad.set_fixed(slot as u32, around(bodies.position(at), placed.min, placed.max));
        } else {
            self.broad.set_moving(slot as u32, around(bodies.position(at), [reach.saturating_neg(); 2], [reach; 2]));
        }
        self.broad.touch(slot as u32);
    }

    fn make_room(&mut self, slots: usize) {
        self.placed.resize_with(slots, Placed::default);
        self.boxes.resize(slots, Aabb::default());
        self.seen.resize(slots, 0);
    }

    /// Adds to `found` the bodies of those colliders for which the broad phase has a fixed box, and which are `elsewhere`.
    pub(crate) fn find_displaced(&self, elsewhere: impl Fn(usize) -> bool, found: &mut Vec<u32>) {
        let bodies = self.broad.fixed().map(|slot| self.proxies[slot].body);
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
        let shift = common_way(bodies, margins.tick);
        let (proxies, boxes) = (&self.proxies, &mut self.boxes);
        let swept = |slot: u32| {
            let Proxy { body, reach } = proxies[slot as usize];
            let out = reach.saturating_add(margins.base);
            let around = sweep(bodies, drive, body as usize, [out.saturating_neg(); 2], [out; 2], margins.tick);
            boxes[slot as usize] = around;
            around
        };
        self.broad.update(shift, swept, |a, b| wanted(bodies, colliders, a as usize, b as usize));

        self.now = self.now.wrapping_add(1);
        let any_asleep = bodies.rest.any_asleep();
        let mut old = 0;
        for at in 0..self.broad.candidates().len() {
            let (a, b) = self.broad.candidates()[at];
            let body = [self.proxies[a as usize].body, self.proxies[b as usize].body];
            if any_asleep && rests(bodies, colliders, [a, b], body) {
                continue;
            }
            let still = body.map(|slot| bodies.is_still(slot as usize));
            // First by what is known of a moving one without turning its outline.
            if still[0] {
                self.place(a as usize, true, bodies, colliders, margins);
            }
            if still[1] {
                self.place(b as usize, true, bodies, colliders, margins);
            }
            let apart = |boxes: &[Aabb]| !boxes[a as usize].overlaps(&boxes[b as usize]);
            if apart(&self.boxes) {
                continue;
            }
            self.place(a as usize, still[0], bodies, colliders, margins);
            self.place(b as usize, still[1], bodies, colliders, margins);
            if apart(&self.boxes) {
                continue;
            }
            let Some(manifold) = self.meet([a as usize, b as usize], body, bodies, colliders, drive, margins) else {
                continue;
            };
            while old < contacts.len() && contacts.key(old) < (a, b) {
                old = old.saturating_add(1);
            }
            let ids = (colliders.id(a as usize), colliders.id(b as usize));
            let known = old < contacts.len() && contacts.ids(old) == ids;
            let old = if known { old as u32 } else { NEW };
            self.pairs.push(Pair { old, ..Pair::new([a, b], body, manifold, colliders) });
        }
    }

    /// The outline of a collider in this tick, and the box around its way: of a moving one less than the box in which it
    /// may turn, which the broad phase was given.
    fn place(&mut self, slot: usize, still: bool, bodies: &Bodies, colliders: &Colliders, margins: Margins) {
        if self.seen[slot] == self.now {
            return;
        }
        self.seen[slot] = self.now;
        let Proxy { body, reach } = self.proxies[slot];
        let at = body as usize;
        let placed = Placed::new(colliders.outline(slot), Rot::new(bodies.angle.get(at)));
        let around = &mut self.boxes[slot];
        if still {
            *around = self::around(bodies.position(at), placed.min, placed.max);
        } else {
            // Turning moves no point farther than this, and none out of reach: so this box is within the one that the broad
            // phase was given, or its history would decide what is found.
            let rim = way(rim_speed(bodies.omega.get(at).to_bits(), reach), margins.tick);
            let spare = |out: i64| reach.saturating_sub(out.saturating_add(rim)).max(0);
            let inward = |at: Length, by: i64| Length::from_bits(at.to_bits().saturating_add(by));
            let Aabb { min, max } = around;
            *min = Vec2::new(
                inward(min.x, spare(placed.min[0].saturating_neg())),
                inward(min.y, spare(placed.min[1].saturating_neg())),
            );
            *max = Vec2::new(
                inward(max.x, spare(placed.max[0]).saturating_neg()),
                inward(max.y, spare(placed.max[1]).saturating_neg()),
            );
        }
        self.placed[slot] = placed;
    }

    /// The manifold of two colliders whose boxes overlap; one without points for a sensor, and for two that are not near
    /// but may meet in this tick.
    fn meet(
        &self,
        [a, b]: [usize; 2],
        [body_a, body_b]: [u32; 2],
        bodies: &Bodies,
        colliders: &Colliders,
        drive: &Drive,
        margins: Margins,
    ) -> Option<Manifold> {
        let (placed_a, placed_b) = (&self.placed[a], &self.placed[b]);
        let (body_a, body_b) = (body_a as usize, body_b as usize);
        let between = |c: &[i64]| c[body_b].saturating_sub(c[body_a]);
        let d = [between(bodies.x.bits()), between(bodies.y.bits())];
        if colliders.rows.value(a).sensor || colliders.rows.value(b).sensor {
            return overlap(placed_a, placed_b, d).then(Manifold::default);
        }
        let (vx, vy, omega) = (bodies.vx.bits(), bodies.vy.bits(), bodies.omega.bits());
        let v = [vx[body_a].saturating_sub(vx[body_b]), vy[body_a].saturating_sub(vy[body_b])];
        let rim = |slot: usize, body: usize| rim_speed(omega[body], self.proxies[slot].reach);
        let fastest = [v[0].saturating_abs(), v[1].saturating_abs(), rim(a, body_a), rim(b, body_b)];
        let fastest = fastest.iter().fold(0i64, |sum, &speed| sum.saturating_add(speed));
        let [ga, gb] = [drive.gain(body_a, margins.tick), drive.gain(body_b, margins.tick)];
        let pressed = [0, 1].map(|axis: usize| ga[axis].saturating_sub(gb[axis]).saturating_abs());
        let pressed = pressed[0].saturating_add(pressed[1]) / 2;
        let ahead = way(fastest.saturating_add(pressed), margins.tick);
        let mut manifold = near(placed_a, placed_b, d, margins.base.saturating_add(ahead))?;
        if manifold.count == 0 {
            // Corner before corner: rows hold no such pair, so what matters is whether it may meet.
            return near(placed_a, placed_b, d, ahead);
        }
        if manifold.points[..manifold.count as usize].iter().all(|point| point.separation > margins.base) {
            return Some(Manifold::default());
        }

        // Of the points beyond the margin, those that the ways of this tick bring near.
        let n = manifold.normal.map(i64::from);
        let mut kept = 0;
        for at in 0..manifold.count as usize {
            let point = manifold.points[at];
            if point.separation > margins.base {
                let arm_b = [point.arm[0].saturating_sub(d[0]), point.arm[1].saturating_sub(d[1])];
                // Turning brings a point nearer by no more than what its reach is beyond where it is now.
                let turning = |collider: usize, body: usize, arm: [i64; 2], side: i64| {
                    let speed = mul(omega[body], cross(arm, n, 30), 32).saturating_mul(side);
                    let left = self.proxies[collider].reach.saturating_add(dot(arm, n, 30).saturating_mul(side)).max(0);
                    way(speed, margins.tick).max(left.saturating_neg())
                };
                let turned = turning(a, body_a, point.arm, 1).saturating_add(turning(b, body_b, arm_b, -1));
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
        let reach = self.proxies[slot].reach;
        let at = Vec2::new(Length::from_bits(at[0]), Length::from_bits(at[1]));
        along(at, v, gain, [reach.saturating_neg(); 2], [reach; 2], margins.tick)
    }

    /// Adds pairs that impacts brought together, though their own ways would not have.
    pub(crate) fn join(&mut self, late: &mut Vec<[[u32; 2]; 2]>, colliders: &Colliders, contacts: &Contacts) {
        if late.is_empty() {
            return;
        }
        for [pair, bodies] in late.drain(..) {
            let ids = pair.map(|slot| colliders.id(slot as usize));
            let old = (0..contacts.len()).find(|&at| contacts.ids(at) == (ids[0], ids[1])).map_or(NEW, |at| at as u32);
            self.pairs.push(Pair { old, met: true, ..Pair::new(pair, bodies, Manifold::default(), colliders) });
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

/// Whether two colliders have anything to do with each other.
fn wanted(bodies: &Bodies, colliders: &Colliders, a: usize, b: usize) -> bool {
    let (a, b) = (colliders.rows.value(a), colliders.rows.value(b));
    if a.body == b.body || !a.filter.meets(b.filter) || a.sensor && b.sensor {
        return false;
    }
    let dynamic = |body: u32| bodies.cold.value(body as usize).is_dynamic();
    a.sensor || b.sensor || dynamic(a.body) || dynamic(b.body)
}
