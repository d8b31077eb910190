//! The broad phase: who might touch.
//!
//! Derived state. What it hands out is a superset of the pairs whose boxes overlap, sorted, and the caller filters it
//! exactly; so neither its form nor its history can be seen in a result, and it may be thrown away and made again.
//!
//! A moving proxy has two fat boxes, and as long as its present box stays inside both nothing is done for it. `fat` is
//! for pairs of moving proxies, in a frame that moves with them: ten thousand bodies that fall together never leave
//! theirs. `near` is for pairs with fixed proxies, in the world. A proxy that has left one gets two new ones, larger on
//! the sides to which it moves, and its pairs are searched again.

mod rect;
mod tree;

use crate::geom::Aabb;
use crate::store::clone_fields;
use crate::threads::{Crew, Cut};
use rect::Rect;
use tree::Tree;

#[cfg(test)]
mod tests;

/// For how many updates a fat box is made, at least; up to 7 more by slot, so that not all proxies leave in one update.
const AHEAD: i64 = 10;
/// A side of a fat box is at most this many times the present box's circumference/2 away from it.
const REACH: i64 = 2;
/// The least margin: 2⁻⁷ m.
const MARGIN: i64 = 1 << 25;
/// A frame that is farther away than this starts anew, so that coordinates in it do not saturate: 2²⁹ m.
const FARTHEST: u64 = 1 << 61;
/// So many proxies are looked at at once whether one moves.
const STRIDE: usize = 64;
/// So many proxies make a piece: 5 µs.
const SLOTS: usize = 512;
/// So many changed fixed boxes are looked at one by one, more as one box around all.
const CHANGES: usize = 8;

/// What a proxy is. Each kind is the due of pairs with that kind shifted by 2, so one expression tells which pairs go;
/// of what is gone, all.
const NONE: u8 = 0b1100;
const MOVING: u8 = 0b0100;
const FIXED: u8 = 0b1000;
const KIND: u8 = 0b1100;
/// Due: pairs with moving proxies, with fixed ones.
const DUE_MOVING: u8 = 0b0001;
const DUE_FIXED: u8 = 0b0010;
const DUE: u8 = 0b0011;

/// Proxies by slot, of which those that move are asked for their present boxes.
pub(crate) trait Sweep: Cut {
    /// Of the proxy at a place among them: its slot, and its box.
    fn sweep(&mut self, at: usize) -> (u32, Aabb);
}

/// The broad phase. Coordinates are the bits of lengths, Q32 m.
#[derive(Debug, Default)]
pub(crate) struct Broad {
    /// Counts updates.
    tick: u32,
    /// Where the frame is: its coordinates are those of the world minus this.
    frame: [i64; 2],
    /// Kind and due, by proxy; the next four too, for moving proxies.
    states: Vec<u8>,
    /// In the world.
    near: Vec<Rect>,
    /// In the frame.
    fat: Vec<Rect>,
    /// The box in the frame from which `near` and `fat` were made, and the update in which.
    from: Vec<Rect>,
    since: Vec<u32>,
    /// Boxes of the fixed, `fat` of the moving.
    fixed: Tree,
    moving: Tree,
    /// Proxies marked as due since the last update.
    touched: Vec<u32>,
    /// Where fixed boxes appeared since the last update, at most [`CHANGES`].
    changed: Vec<Rect>,
    /// Moving proxies due in this update, with their boxes, and the pairs it found: space only, empty between times.
    leaving: Vec<(u32, Rect)>,
    due: Vec<u32>,
    found: Vec<(u32, u32)>,
    pairs: Vec<(u32, u32)>,
}

clone_fields!(Broad {
    tick,
    frame,
    states,
    near,
    fat,
    from,
    since,
    fixed,
    moving,
    touched,
    changed,
    leaving,
    due,
    found,
    pairs
});

impl Broad {
    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        *self = Broad::default();
    }

    /// Sets a proxy that does not move by itself: its box holds until it is set again.
    pub(crate) fn set_fixed(&mut self, proxy: u32, aabb: Aabb) {
        let slot = self.mark(proxy, FIXED);
        let rect = Rect::new(&aabb);
        self.fat[slot] = rect;
        self.moving.remove(proxy);
        self.fixed.set(proxy, &rect);
        self.change(&rect);
    }

    /// Sets a proxy that moves: `aabb` is its box until the next update asks.
    pub(crate) fn set_moving(&mut self, proxy: u32, aabb: Aabb) {
        let slot = self.mark(proxy, MOVING);
        let local = Rect::new(&aabb).seen_from(self.frame);
        (self.from[slot], self.since[slot]) = (local, self.tick);
        self.fixed.remove(proxy);
        self.moving.set(proxy, &local);
    }

    /// The proxies that do not move by themselves.
    pub(crate) fn fixed(&self) -> impl Iterator<Item = usize> + '_ {
        self.states.iter().enumerate().filter(|(_, state)| **state & KIND == FIXED).map(|(slot, _)| slot)
    }

    /// Removes a proxy, if it is there.
    pub(crate) fn remove(&mut self, proxy: u32) {
        if (proxy as usize) < self.states.len() {
            self.mark(proxy, NONE);
            self.moving.remove(proxy);
            self.fixed.remove(proxy);
        }
    }

    /// Has the next update search a proxy's pairs again: for a caller who would answer `wanted` differently now.
    pub(crate) fn touch(&mut self, proxy: u32) {
        let Some(kind) = self.states.get(proxy as usize).map(|state| state & KIND) else {
            return;
        };
        let slot = self.mark(proxy, kind);
        if kind == FIXED {
            let rect = self.fat[slot];
            self.change(&rect);
        }
    }

    /// Notes what a proxy is now, and that its pairs are to be searched again.
    fn mark(&mut self, proxy: u32, kind: u8) -> usize {
        let slot = proxy as usize;
        if self.states.len() <= slot {
            let len = slot.saturating_add(1);
            self.states.resize(len, NONE);
            self.near.resize(len, Rect::NOTHING);
            self.fat.resize(len, Rect::NOTHING);
            self.from.resize(len, Rect::NOTHING);
            self.since.resize(len, 0);
        }
        self.states[slot] = kind | DUE;
        self.touched.push(proxy);
        slot
    }

    /// Notes that a fixed box is new here.
    fn change(&mut self, rect: &Rect) {
        if self.changed.len() < CHANGES {
            self.changed.push(*rect);
        } else {
            self.changed[0] = self.changed[0].union(rect);
        }
    }

    /// Brings the candidates up to date, once per tick.
    ///
    /// `swept` gives moving proxies' present boxes; it is asked for each of them, once. `shift`, Q32 m, is how far moving proxies have commonly moved since
    /// the last update: any value is correct, a good one is fast. `wanted(a, b)`, a < b, says whether a pair is of
    /// interest; it is asked when a pair is found, which is not in every update.
    pub(crate) fn update(&mut self, shift: [i64; 2], swept: impl Sweep, wanted: impl Fn(u32, u32) -> bool, crew: Crew) {
        self.tick = self.tick.wrapping_add(1);
        self.advance(shift);
        self.sweep(shift, swept, crew);
        if self.touched.is_empty() && self.due.is_empty() {
            return;
        }
        self.fixed.tidy();
        self.moving.tidy();
        let states = &self.states;
        self.pairs.retain(|&(a, b)| {
            let (a, b) = (states[a as usize], states[b as usize]);
            ((a & (b >> 2)) | (b & (a >> 2))) & DUE == 0
        });
        self.search(wanted);
        self.merge();
        self.due.clear();
        self.touched.clear();
        self.states.iter_mut().for_each(|state| *state &= KIND);
        self.changed.clear();
    }

    /// Moves the frame.
    fn advance(&mut self, shift: [i64; 2]) {
        self.frame = [0, 1].map(|axis| self.frame[axis].saturating_add(shift[axis]));
        if self.frame.iter().any(|at| at.unsigned_abs() > FARTHEST) {
            // Fat boxes are then somewhere else, and few proxies will be found inside.
            self.frame = [0; 2];
        }
    }

    /// Finds the moving proxies that are due, and gives them new fat boxes.
    fn sweep(&mut self, shift: [i64; 2], swept: impl Sweep, crew: Crew) {
        let Broad { frame, states, near, fat, changed, leaving, .. } = self;
        let slots = (states.as_mut_slice(), (near.as_slice(), fat.as_slice()), swept);
        crew.gather(slots, SLOTS, leaving, |(states, (near, fat), swept), leaving| {
            leave(Slots { states, near, fat }, swept, *frame, changed, leaving);
        });
        let mut leaving = core::mem::take(&mut self.leaving);
        for (proxy, world) in leaving.drain(..) {
            self.due.push(proxy);
            self.fatten(proxy as usize, shift, &world);
        }
        self.leaving = leaving;
    }

    /// New fat boxes, from how the proxy's box moved and grew since the last ones.
    #[inline(never)]
    fn fatten(&mut self, slot: usize, shift: [i64; 2], world: &Rect) {
        let local = &world.seen_from(self.frame);
        let ticks = i64::from(self.tick.wrapping_sub(self.since[slot])).max(1);
        let ahead = AHEAD.saturating_add(slot as i64 & 7);
        let from = &self.from[slot];
        // Outwards: left, down, right, up.
        let moved = [
            (from.min[0], local.min[0]),
            (from.min[1], local.min[1]),
            (local.max[0], from.max[0]),
            (local.max[1], from.max[1]),
        ]
        .map(|(a, b)| a.saturating_sub(b).saturating_mul(ahead).checked_div(ticks).unwrap_or(0));
        let [x, y] = shift.map(|shift| shift.saturating_mul(ahead));
        let with_frame = [
            moved[0].saturating_sub(x),
            moved[1].saturating_sub(y),
            moved[2].saturating_add(x),
            moved[3].saturating_add(y),
        ];
        let due = self.states[slot];
        if due & DUE_MOVING != 0 {
            self.fat[slot] = grown(local, moved);
            self.moving.set(slot as u32, &self.fat[slot]);
        }
        if due & DUE_FIXED != 0 {
            self.near[slot] = if self.fixed.is_empty() { Rect::EVERYTHING } else { grown(world, with_frame) };
        }
        (self.from[slot], self.since[slot]) = (*local, self.tick);
    }

    /// Finds the pairs of the proxies that are due.
    fn search(&mut self, wanted: impl Fn(u32, u32) -> bool) {
        let Broad { states, near, fat, fixed, moving, due, found, .. } = self;
        let mut note = |proxy: u32, other: u32| {
            let (a, b) = (proxy.min(other), proxy.max(other));
            if wanted(a, b) {
                found.push((a, b));
            }
        };
        for &proxy in &*due {
            if states[proxy as usize] & DUE_FIXED != 0 && !fixed.is_empty() {
                fixed.search(&near[proxy as usize], |other| note(proxy, other));
            }
        }
        due.retain(|&proxy| states[proxy as usize] & DUE_MOVING != 0);
        moving.sort(due);
        for &proxy in &*due {
            moving.search(&fat[proxy as usize], |other| {
                // Of two that are due, the one with the greater slot finds the pair.
                if other < proxy || (other > proxy && states[other as usize] & DUE_MOVING == 0) {
                    note(proxy, other);
                }
            });
        }
    }

    /// Puts the pairs found among those kept, both in ascending order: from the back, so that none is in the way.
    fn merge(&mut self) {
        let Broad { found, pairs, .. } = self;
        found.sort_unstable_by_key(|&(a, b)| u64::from(a) << 32 | u64::from(b));
        let mut kept = pairs.len();
        let mut end = kept.saturating_add(found.len());
        pairs.resize(end, (0, 0));
        while let Some(&new) = found.last() {
            end = end.saturating_sub(1);
            if kept > 0 && pairs[kept.saturating_sub(1)] > new {
                kept = kept.saturating_sub(1);
                pairs[end] = pairs[kept];
            } else {
                pairs[end] = new;
                found.pop();
            }
        }
    }

    /// Visits every proxy whose box of the last update overlaps `aabb`, once and in no useful order, and some that move whose box
    /// did not; of those that do not move no other: a caller who asks less exactly must not hear of the broad phase's history.
    pub(crate) fn query(&self, aabb: &Aabb, mut visit: impl FnMut(u32)) {
        let world = Rect::new(aabb);
        let local = world.seen_from(self.frame);
        self.fixed.visit(|around| around.overlaps(&world), &mut visit);
        self.moving.visit(|around| around.overlaps(&local), &mut visit);
    }

    /// The pairs `(a, b)`, a < b, ascending and each once: every wanted pair with a moving proxy in it whose boxes
    /// overlapped in the last update, and some whose boxes did not.
    pub(crate) fn candidates(&self) -> &[(u32, u32)] {
        &self.pairs
    }
}

/// Some proxies: kind and due, fat boxes.
struct Slots<'b> {
    states: &'b mut [u8],
    near: &'b [Rect],
    fat: &'b [Rect],
}

/// Asks for the boxes of those that move, and notes who is due.
fn leave(slots: Slots<'_>, mut swept: impl Sweep, frame: [i64; 2], changed: &[Rect], leaving: &mut Vec<(u32, Rect)>) {
    let Slots { states, near, fat } = slots;
    let mut at = 0;
    while at < states.len() {
        let mut state = states[at];
        if state & KIND != MOVING {
            at = at.saturating_add(fixed_from(&states[at..]));
            continue;
        }
        let (proxy, aabb) = swept.sweep(at);
        let world = Rect::new(&aabb);
        if !near[at].contains(&world) || changed.iter().any(|rect| rect.overlaps(&near[at])) {
            state |= DUE_FIXED;
        }
        if !fat[at].contains(&world.seen_from(frame)) {
            state |= DUE_MOVING;
        }
        if state & DUE != 0 {
            states[at] = state;
            leaving.push((proxy, world));
        }
        at = at.saturating_add(1);
    }
}

/// How many of these, of which the first does not move, do not, at least; by many at a time where few do.
#[inline]
fn fixed_from(states: &[u8]) -> usize {
    let moves = |states: &[u8]| states.iter().fold(false, |any, state| any | (state & KIND == MOVING));
    let blocks = states.chunks(STRIDE).take_while(|states| !moves(states));
    blocks.fold(0usize, |skipped, states| skipped.saturating_add(states.len())).max(1)
}

/// A box with a margin, and larger by what lies ahead: to the left, down, right, up.
fn grown(rect: &Rect, ahead: [i64; 4]) -> Rect {
    let [width, height] = rect.size();
    let reach = width.saturating_add(height).saturating_mul(REACH).max(0);
    let margin = (width.min(height) >> 3).saturating_add(MARGIN);
    let [left, down, right, up] = ahead.map(|way| way.clamp(0, reach).saturating_add(margin));
    let (min, max) = (rect.min, rect.max);
    Rect {
        min: [min[0].saturating_sub(left), min[1].saturating_sub(down)],
        max: [max[0].saturating_add(right), max[1].saturating_add(up)],
    }
}
