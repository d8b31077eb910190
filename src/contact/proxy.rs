//! Where colliders are in a tick: their outlines, turned, and the boxes around their ways.
//!
//! An outline stays as it is for as long as the very bits of its angle do, or the body stays where it is: in what has come to
//! rest that is nearly all. So it has the number of the tick in which it was turned, and what was made of it can be told from
//! that.

use super::find::Margins;
use super::ways::{around, rim_speed, sweep, way};
use crate::body::{Bodies, Colliders};
use crate::broad::Sweep;
use crate::geom::{Aabb, Rot, Vec2};
use crate::motion::Drive;
use crate::num::{Angle, Friction, Length, Restitution};
use crate::shape::{Outline, Placed};
use crate::store::ColliderId;
use crate::threads::Cut;

/// What is known of a collider without looking it up: [`Proxies::set`] notes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Proxy {
    pub(super) id: ColliderId,
    pub(super) body: u32,
    pub(super) sensor: bool,
    /// Whether its body stays where it is in every tick: its outline and its box do then, too.
    pub(super) still: bool,
    pub(super) turned: Turned,
    /// No point is farther from the centre of mass, Q32 m.
    pub(super) reach: i64,
    pub(super) restitution: Restitution,
    pub(super) friction: Friction,
}

/// How an outline lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Turned {
    /// Whether it lies as its body does now.
    pub(super) done: bool,
    /// Whether it was asked for in the last tick.
    asked: bool,
    /// The angle for which it was turned, and in which tick.
    pub(super) angle: i64,
    pub(super) tick: u64,
    /// The first tick in which it may be this one, and not that of another form.
    pub(super) since: u64,
}

/// All colliders, by slot.
#[derive(Debug, Default)]
pub(super) struct Proxies {
    list: Vec<Proxy>,
    /// Outlines in the world's axes, where that is done.
    placed: Vec<Placed>,
    /// Boxes around the ways of this tick; where the outline is not turned, around all in which it may lie.
    boxes: Vec<Aabb>,
    /// How fast turning moves what reaches farthest, Q48 m/s; of what moves and has its outline turned in this tick.
    rims: Vec<i64>,
    /// Counts ticks.
    now: u64,
}

impl Clone for Proxies {
    fn clone(&self) -> Self {
        let mut copy = Proxies::default();
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        let Proxies { list, placed, boxes, rims, now: _ } = source;
        self.list.clone_from(list);
        self.boxes.clone_from(boxes);
        self.rims.clone_from(rims);
        // Outlines are turned again.
        self.placed.resize_with(placed.len(), Placed::default);
        self.list.iter_mut().for_each(|proxy| proxy.turned = Turned::default());
        self.now = 0;
    }
}

impl Proxy {
    fn new(slot: usize, bodies: &Bodies, colliders: &Colliders) -> Proxy {
        let row = colliders.rows.value(slot);
        Proxy {
            id: colliders.id(slot),
            body: row.body,
            sensor: row.sensor,
            still: bodies.is_still(row.body as usize),
            turned: Turned::default(),
            reach: colliders.outline(slot).reach,
            restitution: row.restitution,
            friction: row.friction,
        }
    }
}

impl Proxies {
    pub(super) fn get(&self, slot: usize) -> &Proxy {
        &self.list[slot]
    }

    /// The number of this tick.
    pub(super) fn now(&self) -> u64 {
        self.now
    }

    pub(super) fn placed(&self, slot: usize) -> &Placed {
        &self.placed[slot]
    }

    /// How fast turning moves what of a pair's collider reaches farthest, Q48 m/s.
    #[inline]
    pub(super) fn rim(&self, slot: usize, bodies: &Bodies) -> i64 {
        let Proxy { body, reach, still, .. } = self.list[slot];
        if still { rim_speed(bodies.omega.bits()[body as usize], reach) } else { self.rims[slot] }
    }

    pub(super) fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// Notes what a collider is now, and where its body is. The box around it.
    pub(super) fn set(&mut self, slot: usize, bodies: &Bodies, colliders: &Colliders) -> Aabb {
        if self.list.len() <= slot {
            let slots = slot.saturating_add(1);
            self.list.resize(slots, Proxy::default());
            self.placed.resize_with(slots, Placed::default);
            self.boxes.resize(slots, Aabb::default());
            self.rims.resize(slots, 0);
        }
        let proxy = Proxy::new(slot, bodies, colliders);
        let (at, reach) = (bodies.position(proxy.body as usize), proxy.reach);
        self.list[slot] = proxy;
        self.list[slot].turned.since = self.now.wrapping_add(1);
        self.boxes[slot] = around(at, [reach.saturating_neg(); 2], [reach; 2]);
        if proxy.still {
            self.placed[slot] = turn(&mut self.list[slot], self.now, bodies, colliders.outline(slot));
            self.boxes[slot] = around(at, self.placed[slot].min, self.placed[slot].max);
            // What was made of the outline that it had in the last tick was not made of this one.
            self.list[slot].turned.tick = self.now.wrapping_add(1);
        }
        self.boxes[slot]
    }

    /// A tick begins, in which all that moves is going to be [swept](Sweep).
    pub(super) fn begin(&mut self) {
        self.now = self.now.wrapping_add(1);
    }

    /// All of them, to be put where they are in this tick.
    #[inline]
    pub(super) fn placing<'p>(&'p mut self, course: Course<'p>) -> Placing<'p> {
        let Proxies { list, placed, boxes, rims, now } = self;
        Placing { first: 0, list, placed, boxes, rims, now: *now, course }
    }

    /// Notes that a collider's outline is asked for in this tick.
    pub(super) fn ask(&mut self, slot: usize) {
        self.list[slot].turned.asked = true;
    }

    /// Whether all of it follows from bodies and colliders.
    pub(super) fn check(&self, bodies: &Bodies, colliders: &Colliders) -> bool {
        colliders.rows.iter().all(|(slot, _)| {
            let Some(&proxy) = self.list.get(slot) else { return false };
            let Turned { done, angle, .. } = proxy.turned;
            let placed = || Placed::new(colliders.outline(slot), Rot::new(Angle::from_bits(angle)));
            let known = Proxy { turned: Turned::default(), ..proxy };
            known == Proxy::new(slot, bodies, colliders) && (!done || self.placed[slot] == placed())
        })
    }
}

/// What ways follow from.
#[derive(Clone, Copy)]
pub(super) struct Course<'p> {
    pub(super) bodies: &'p Bodies,
    pub(super) colliders: &'p Colliders,
    pub(super) drive: &'p Drive,
    pub(super) margins: Margins,
}

/// Colliders from one slot on, to be put where they are in this tick.
pub(super) struct Placing<'p> {
    first: usize,
    list: &'p mut [Proxy],
    placed: &'p mut [Placed],
    boxes: &'p mut [Aabb],
    rims: &'p mut [i64],
    now: u64,
    course: Course<'p>,
}

impl Cut for Placing<'_> {
    fn len(&self) -> usize {
        self.list.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let Placing { first, list, placed, boxes, rims, now, course } = self;
        let columns = ((list, placed), (boxes, rims)).cut(at);
        let part = |first, ((list, placed), (boxes, rims))| Placing { first, list, placed, boxes, rims, now, course };
        (part(first, columns.0), part(first.saturating_add(at), columns.1))
    }
}

impl Sweep for Placing<'_> {
    /// The box around the way of a collider that moves, however it turns. What is known to be asked for gets its outline, too.
    #[inline]
    fn sweep(&mut self, at: usize) -> (u32, Aabb) {
        let Course { bodies, drive, margins, .. } = self.course;
        let Proxy { body, reach, turned, .. } = self.list[at];
        let out = reach.saturating_add(margins.base);
        let around = sweep(bodies, drive, body as usize, [out.saturating_neg(); 2], [out; 2], margins.tick);
        self.boxes[at] = around;
        let done = turned.done && turned.angle == bodies.angle.bits()[body as usize];
        self.list[at].turned = Turned { done, asked: false, ..turned };
        if done || turned.asked {
            self.place(at);
        }
        (self.first.saturating_add(at) as u32, around)
    }
}

impl Placing<'_> {
    /// The outline of a collider in this tick, and the box around its way: of a moving one less than the box in which it
    /// may turn, which the broad phase was given. Once a tick.
    pub(super) fn place(&mut self, at: usize) {
        let Course { bodies, colliders, margins, .. } = self.course;
        let Proxy { body, reach, still, turned, .. } = self.list[at];
        if !turned.done {
            let outline = colliders.outline(self.first.saturating_add(at));
            self.placed[at] = turn(&mut self.list[at], self.now, bodies, outline);
        }
        if still {
            return;
        }
        // Turning moves no point farther than this, and none out of reach: so this box is within the one that the broad
        // phase was given, or its history would decide what is found.
        let placed = &self.placed[at];
        self.rims[at] = rim_speed(bodies.omega.bits()[body as usize], reach);
        let rim = way(self.rims[at], margins.tick);
        let spare = |out: i64| reach.saturating_sub(out.saturating_add(rim)).max(0);
        let inward = |at: Length, by: i64| Length::from_bits(at.to_bits().saturating_add(by));
        let Aabb { min, max } = &mut self.boxes[at];
        *min = Vec2::new(
            inward(min.x, spare(placed.min[0].saturating_neg())),
            inward(min.y, spare(placed.min[1].saturating_neg())),
        );
        *max = Vec2::new(
            inward(max.x, spare(placed.max[0]).saturating_neg()),
            inward(max.y, spare(placed.max[1]).saturating_neg()),
        );
    }
}

/// A collider's outline as it lies in the tick `now`.
fn turn(proxy: &mut Proxy, now: u64, bodies: &Bodies, outline: &Outline) -> Placed {
    let angle = bodies.angle.get(proxy.body as usize);
    proxy.turned = Turned { done: true, asked: false, angle: angle.to_bits(), tick: now, ..proxy.turned };
    Placed::new(outline, Rot::new(angle))
}
