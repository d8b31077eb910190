//! What was seen of pairs: kept for as long as nothing of what it was made of has changed.
//!
//! A memory of a function's values, each with all that it is a value of: so it has no say, whatever it holds, and may be empty at
//! any time. In a pile that has come to rest nearly every pair is what it was a tick before, to the bit.

use super::find::Margins;
use super::proxy::{Proxies, Proxy};
use super::search::Found;
use super::ways::way;
use crate::body::Bodies;
use crate::motion::Drive;
use crate::narrow::{Faces, Manifold, Near, near, overlap};
use crate::num::{cross, dot, mul};
use crate::shape::Placed;

/// Farther than limits are, 2¹⁶ m: sums with it stay in range.
const FAR: i64 = 1 << 48;

/// What was seen of a pair.
#[derive(Clone, Debug, Default)]
pub(super) struct Look {
    pub(super) colliders: [u32; 2],
    /// The tick in which; outlines turned since are others.
    pub(super) tick: u64,
    /// Where b's centre was from a's, Q32 m.
    pub(super) d: [i64; 2],
    pub(super) near: Near,
    pub(super) faces: Faces,
}

impl Look {
    /// Whether the pair lies as it did.
    #[inline]
    fn is_of(&self, d: [i64; 2], [a, b]: [&Proxy; 2]) -> bool {
        self.d == d && self.tick >= a.turned.tick.max(b.turned.tick)
    }

    /// Looks at the pair in the tick `now`.
    fn renew(&mut self, now: u64, d: [i64; 2], proxies: [&Proxy; 2], [a, b]: [&Placed; 2], limit: i64) {
        // An outline that is another one has other edges.
        if self.tick < proxies[0].turned.since.max(proxies[1].turned.since) {
            self.faces = Faces::default();
        }
        self.faces.follow([self.d, d], proxies.map(|proxy| proxy.turned.angle), proxies.map(|proxy| proxy.reach));
        self.near = near(a, b, d, limit, &mut self.faces);
        (self.tick, self.d) = (now, d);
    }

    /// Whether it is what is seen afresh, as far as its outlines still lie so.
    pub(super) fn check(&self, proxies: &Proxies) -> bool {
        let Look { colliders, tick: _, d, near: Near { apart, manifold, from, below }, faces } = self;
        let slots = colliders.map(|slot| slot as usize);
        let both = slots.map(|slot| proxies.get(slot));
        let same = |limit: i64| {
            let [a, b] = slots.map(|slot| proxies.placed(slot));
            let fresh = near(a, b, *d, limit, &mut Faces::default());
            let again = near(a, b, *d, limit, &mut faces.clone());
            let is = |near: &Near| near.apart == *apart && near.manifold == *manifold;
            is(&fresh) && is(&again)
        };
        let sensor = both.iter().any(|proxy| proxy.sensor);
        let lie = both.iter().all(|proxy| proxy.turned.done) && self.is_of(*d, both);
        sensor || !lie || from >= below || same((*from).max(0)) && same(below.saturating_sub(1).clamp(0, FAR))
    }
}

/// What was seen in the last tick, and what is seen in this one. Ordered by colliders.
#[derive(Debug, Default)]
pub(super) struct Looks {
    list: Vec<Look>,
    /// Of this tick, of pairs that were not seen in the last one: space.
    added: Vec<Look>,
}

/// What was seen of a piece of the candidates: of this tick up to `written`, from `read` on of the last one.
pub(super) struct Seen<'l> {
    list: &'l mut [Look],
    read: usize,
    written: usize,
}

impl Seen<'_> {
    /// Of the candidates before one, and from it on.
    pub(super) fn cut_before(self, candidate: Option<(u32, u32)>) -> (Self, Self) {
        let Seen { list, .. } = self;
        let end = list.len();
        let at = candidate.map_or(end, |(a, b)| list.partition_point(|look| look.colliders < [a, b]));
        let (before, list) = list.split_at_mut(at);
        (Seen { list: before, read: 0, written: 0 }, Seen { list, read: 0, written: 0 })
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// How many of them were seen again.
    pub(super) fn kept(&self) -> usize {
        self.written
    }

    /// What was seen of the next pair of this tick, if it was seen in the last one; else what was seen in tick 0.
    #[inline]
    pub(super) fn next<'s>(&'s mut self, colliders: [u32; 2], added: &'s mut Vec<Look>) -> &'s mut Look {
        while self.list.get(self.read).is_some_and(|look| look.colliders < colliders) {
            self.read = self.read.saturating_add(1);
        }
        if self.list.get(self.read).is_none_or(|look| look.colliders != colliders) {
            added.push(Look { colliders, ..Look::default() });
            let last = added.len().saturating_sub(1);
            return &mut added[last];
        }
        let (read, written) = (self.read, self.written);
        if written < read {
            self.list.swap(written, read);
        }
        (self.read, self.written) = (read.saturating_add(1), written.saturating_add(1));
        &mut self.list[written]
    }
}

impl Looks {
    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// A tick begins.
    pub(super) fn seen(&mut self) -> Seen<'_> {
        self.added.clear();
        Seen { list: &mut self.list, read: 0, written: 0 }
    }

    /// Puts together what was seen of all pieces, and what was added in its place: from the back, so that nothing is in the way.
    pub(super) fn end(&mut self, found: &mut [Found]) {
        let (mut kept, mut begin) = (0usize, 0usize);
        for found in found {
            for at in begin..begin.saturating_add(found.kept) {
                if kept < at {
                    self.list.swap(kept, at);
                }
                kept = kept.saturating_add(1);
            }
            begin = begin.saturating_add(found.of);
            self.added.append(&mut found.added);
        }
        self.list.truncate(kept);
        let mut end = kept.saturating_add(self.added.len());
        self.list.resize_with(end, Look::default);
        while let Some(look) = self.added.last() {
            end = end.saturating_sub(1);
            if kept > 0 && self.list[kept.saturating_sub(1)].colliders > look.colliders {
                kept = kept.saturating_sub(1);
                self.list.swap(kept, end);
            } else if let Some(look) = self.added.pop() {
                self.list[end] = look;
            }
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Look> {
        self.list.iter()
    }
}

/// A pair whose boxes overlap.
pub(super) struct See<'t> {
    pub(super) proxies: &'t Proxies,
    pub(super) slots: [usize; 2],
    pub(super) bodies: &'t Bodies,
    pub(super) drive: &'t Drive,
    pub(super) margins: Margins,
}

impl See<'_> {
    /// Its manifold; one without points for a sensor, and for two that are not near but may meet in this tick.
    #[inline]
    pub(super) fn meet(&self, look: &mut Look) -> Option<Manifold> {
        let See { proxies, slots, bodies, margins, .. } = *self;
        let [a, b] = slots.map(|slot| proxies.get(slot));
        let between = |c: &[i64]| c[b.body as usize].saturating_sub(c[a.body as usize]);
        let d = [between(bodies.x.bits()), between(bodies.y.bits())];
        let mut known = look.is_of(d, [a, b]);
        let placed = slots.map(|slot| proxies.placed(slot));
        if a.sensor || b.sensor {
            return overlap(placed[0], placed[1], d).then(Manifold::default);
        }
        // Where all points are within the margin it does not matter how fast they are, and most pairs stay so.
        let rests = |near: &Near| near.manifold.count > 0 && near.holds(margins.base) && near.below == i64::MAX;
        let rested = rests(&look.near);
        if rested && !known {
            look.renew(proxies.now(), d, [a, b], placed, margins.base);
            known = true;
        }
        if rested && rests(&look.near) {
            return Some(look.near.manifold.clone());
        }
        let ahead = self.ahead();
        let limit = margins.base.saturating_add(ahead);
        if !known || !look.near.holds(limit) {
            look.renew(proxies.now(), d, [a, b], placed, limit);
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
