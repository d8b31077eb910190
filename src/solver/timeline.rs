//! The impacts of a tick, in the order of their times (IM:col2D's t_c).
//!
//! Pairs that come together fast are not rows': each is looked for along the ways of its bodies, and answered when it
//! meets. What touches at one time and hangs together by bodies that move is answered together; what a blow sends on
//! meets again, at the same time or later. Bodies that rows push have a way for a substep only, so this goes on between
//! the substeps.
//!
//! Source: conservative advancement after Mirtich (1996); time-ordered events with local body times.

mod answer;
mod astray;
mod neighbours;

use super::flight::{Flight, Flights, NONE, Past, State, TICK, motion};
use super::mobility::Mobility;
use super::mover::Movers;
use super::repose::Repose;
use super::rows::{Block, LANES};
use super::scales::Scales;
use super::strike::{ONE, Speed, Strike, Weight};
use crate::body::{Bodies, Colliders};
use crate::contact::{Collision, Touch};
use crate::motion::{Drive, Fault};
use crate::narrow::{Clearance, Manifold, first_touch};
use crate::num::{lane::next, mul};
use core::cmp::Reverse;
use std::collections::BinaryHeap;

/// Impacts within this of each other are one: 16 ns at 60 ticks/s, Q32 of a tick. Positions are rounded every tick, and
/// two bodies that come to a third alike differ by 1 ns after some ticks.
const SAME: i64 = 1 << 12;
/// How far the surfaces of an impact are apart at most: 0.2 µm, Q32 m; for bodies over 4 m more, as `first_touch` has it.
const REACH: i64 = 860;
/// Of two points, one that is farther out than the other by more than this takes no part: 15 µm. What lands flatter than
/// that lands flat, where exactly it would fall from one corner to the other within microseconds.
const FLAT: i64 = 1 << 16;
/// How often a body is struck in a tick before its impacts take all speed out of it, and how often at all.
const MANY: u32 = 256;
const MOST: u32 = 320;
/// So many answers a world has in a tick before nothing bounces in it, and so many more for each body that may be struck;
/// after twice as many, who is struck stays. A pile that falls together has two a body, 200 elastic polygons have 50.
const BUDGET: u32 = 2048;
const BUDGET_EACH: u32 = 8;
/// How often a pair is answered in a tick before its bodies go on as one while they touch: what rolls on another, or is
/// struck to and fro, would close again and again. Not what is elastic.
const OFTEN: u32 = 8;
/// How often a pair that rows push is answered in a tick before they hold it.
const AGAIN: u32 = 2;
/// Contacts that rows hold are struck on so often only, unless they are elastic: then rows have them back.
const PASSED_ON: u32 = 8;

/// A pair of colliders whose bodies may strike each other.
#[derive(Clone, Copy, Debug)]
struct Engaged {
    colliders: [u32; 2],
    /// Places of the flights.
    flights: [u32; 2],
    /// When they meet, Q32 of the tick; [`NEVER`] if they do not, as far as is known.
    time: i64,
    /// The next pair of each body.
    next: [u32; 2],
    /// Its place among the pairs of the tick, or [`NONE`].
    pair: u32,
    /// Whether it has rows.
    held: bool,
    /// How often it was answered, and how often it only seemed to meet.
    answers: u32,
    misses: u32,
    /// How far they may overlap already, Q32 m.
    depth: i64,
    /// The least speed of approach that is answered, Q48 m/s.
    least: i64,
    /// C_R and the coefficient of friction, Q48.
    restitution: i64,
    friction: i64,
    /// What was seen of it.
    clearance: Clearance,
    /// Whether an impact of this tick brought it to rest.
    rests: bool,
}

/// How much deeper than when it was taken in a pair may be, and is not lost: 5 µm, Q32 m. One at rest is pressed in by some
/// 0.1 µm until it closes.
const DEEPER: i64 = 21_475;
/// When what only seemed to meet is looked at again: when it may have moved by 0.1 mm, Q32 m, and twice as far each time;
/// 1/64 of a tick later at most.
const LEAP: i64 = 429_497;
const LATER: i64 = TICK >> 6;
const NEVER: i64 = i64::MAX;
/// As a place among the pairs of the tick: one of those that were not among them.
const LATE: u32 = u32::MAX - 1;

/// What stays the same while impacts are answered.
pub(crate) struct Stage<'s> {
    pub(crate) bodies: &'s Bodies,
    pub(crate) colliders: &'s Colliders,
    pub(crate) touch: &'s Touch,
    pub(crate) drive: &'s Drive,
    pub(crate) mobilities: &'s [Mobility],
    pub(crate) scales: &'s Scales,
    pub(crate) seats: &'s [u32],
    pub(crate) blocks: &'s [Block],
    pub(crate) repose: &'s Repose,
}

impl Stage<'_> {
    /// Whether a pair has no point that touches.
    fn is_apart(&self, pair: u32) -> bool {
        let manifold = self.touch.pairs.get(pair as usize).map(|pair| &pair.manifold);
        manifold.is_some_and(|m| m.points[..m.count as usize].iter().all(|p| p.separation > self.scales.touching))
    }

    /// How far the smaller of two colliders reaches.
    fn smaller(&self, colliders: [u32; 2]) -> i64 {
        let [a, b] = colliders.map(|slot| self.colliders.outline(slot as usize).reach);
        a.min(b)
    }

    /// Whether the rows of a pair bear a load now.
    fn bears(&self, pair: u32) -> bool {
        let row = self.touch.pairs.get(pair as usize).map_or(NONE, |pair| pair.row);
        let seat = self.seats.get(row as usize).map(|&seat| seat as usize);
        seat.is_some_and(|seat| self.blocks[seat / LANES].bears(seat % LANES))
    }
}

/// A pair of the tick whose bodies rows know, and which an impact left at rest: where it touches when the substep ends.
#[derive(Debug)]
pub(crate) struct Settled {
    pub(crate) pair: u32,
    pub(crate) manifold: Manifold,
    /// From a's centre to b's, Q32 m.
    pub(crate) between: [i64; 2],
}

/// The impacts of a tick. Nothing in it lasts.
#[derive(Debug, Default)]
pub(crate) struct Timeline {
    pub(crate) past: Past,
    pub(crate) flights: Flights,
    /// When the substep began.
    from: i64,
    engaged: Vec<Engaged>,
    queue: BinaryHeap<Reverse<(i64, u32, u32, u32)>>,
    /// Places of flights that were struck, or that rows sent astray.
    struck: Vec<u32>,
    /// Pairs that were not among those of the tick and met: colliders, bodies.
    pub(crate) late: Vec<[[u32; 2]; 2]>,
    /// Places of those of the tick that met.
    pub(crate) met: Vec<u32>,
    /// Pairs whose rows are out for the rest of the tick.
    pub(crate) retired: Vec<u32>,
    /// Pairs that came to rest in this substep, by their places among the engaged; and what rows are to hold.
    settling: Vec<u32>,
    pub(crate) settled: Vec<Settled>,
    /// What happened, and how many answers there were.
    pub(crate) collisions: Vec<Collision>,
    order: u32,
    /// Whether one may be struck of which it was said that it ends the tick as it began it: then it is to be computed.
    pub(crate) disturbs: bool,
    // Space for one answer: pairs that meet, and those of one answer; places of their flights, how fast these are, and were; contacts.
    batch: Vec<(i64, u32)>,
    group: Vec<u32>,
    locals: Vec<u32>,
    speeds: Vec<Speed>,
    before: Vec<Speed>,
    priors: Vec<State>,
    weights: Vec<Weight>,
    members: Vec<u32>,
    strikes: Vec<Strike>,
    restitutions: Vec<i64>,
    found: Vec<u32>,
    known: Vec<[u32; 2]>,
}

impl Timeline {
    /// Forgets the last tick.
    pub(crate) fn clear(&mut self, slots: usize) {
        self.flights.clear(slots);
        self.engaged.clear();
        self.queue.clear();
        self.struck.clear();
        self.late.clear();
        self.met.clear();
        self.retired.clear();
        self.settling.clear();
        self.settled.clear();
        self.collisions.clear();
        (self.order, self.disturbs) = (0, false);
    }

    /// While bodies are where the tick begins, and some pair may meet in it.
    pub(crate) fn remember(&mut self, bodies: &Bodies) {
        self.past.take(bodies);
    }

    /// Takes a pair of the tick in, after bodies have moved freely.
    pub(crate) fn engage(&mut self, pair: usize, stage: &Stage<'_>, movers: &Movers) {
        let of = &stage.touch.pairs[pair];
        let at = self.add(of.colliders, of.bodies, pair as u32, false, stage, movers);
        self.foresee(at, 0, TICK, stage);
    }

    fn add(
        &mut self,
        colliders: [u32; 2],
        bodies: [u32; 2],
        pair: u32,
        held: bool,
        stage: &Stage<'_>,
        movers: &Movers,
    ) -> usize {
        let flights = bodies.map(|slot| self.flight(slot, stage, movers));
        let at = self.engaged.len();
        let [a, b] = colliders.map(|slot| stage.colliders.rows.value(slot as usize));
        let restitution = a.restitution.combine(b.restitution).to_bits();
        let friction = a.friction.combine(b.friction).to_bits();
        let list = &mut self.flights.list;
        let next = flights.map(|place| core::mem::replace(&mut list[place as usize].first, at as u32));
        // Rows would stop what was struck as it crosses a gap. What does not bounce is theirs.
        let free = held && restitution > 0 && !stage.bears(pair) && stage.is_apart(pair);
        if free {
            self.retired.push(pair);
        }
        let least = stage.scales.least_strike(restitution, held && stage.bears(pair), stage.smaller(colliders));
        let depth = stage.touch.pairs.get(pair as usize).map_or(0, |pair| pair.depth);
        self.engaged.push(Engaged {
            colliders,
            flights,
            time: NEVER,
            next,
            pair,
            held: held && !free,
            answers: 0,
            misses: 0,
            depth,
            least,
            restitution,
            friction,
            clearance: Clearance::default(),
            rests: false,
        });
        at
    }

    /// Looks when a pair meets, from a time on and as far as the ways of its bodies are known: to `end` if rows push one.
    fn foresee(&mut self, at: usize, from: i64, end: i64, stage: &Stage<'_>) {
        let scales = stage.scales;
        let pair = &mut self.engaged[at];
        pair.time = NEVER;
        let [a, b] = pair.flights.map(|place| &self.flights.list[place as usize]);
        // Who was struck too often stays, but others do not pass through it.
        let stays = |flight: &Flight| flight.strikes >= MOST || !stage.mobilities[flight.slot as usize].moves();
        if stays(a) && stays(b) {
            return;
        }
        let strikes = a.strikes.max(b.strikes);
        // What is passed on often, rows take: but for what is too fast for them.
        let passed = pair.held && strikes >= PASSED_ON && pair.restitution < ONE;
        let least = if passed {
            pair.least.max(scales.least_strike(0, true, stage.smaller(pair.colliders)))
        } else {
            pair.least
        };
        let from = from.max(a.time).max(b.time);
        let until = if a.pushed || b.pushed { end } else { TICK };
        if from > until {
            return;
        }
        let (p, q) = (a.at(from, scales), b.at(from, scales));
        let motion = motion(&p, &q, [&a.gain, &b.gain], scales);
        let rest = until.saturating_sub(from);
        let closing = mul(least, scales.margins.tick, 71);
        let [one, other] = pair.colliders.map(|slot| stage.colliders.outline(slot as usize));
        if motion.fastest([one.reach, other.reach], rest) < closing || pair.clearance.lasts(&motion, rest) {
            return;
        }
        let depth = pair.depth.saturating_add(DEEPER);
        let slack = if a.place != 0 || b.place != 0 { scales.slack.max(depth) } else { depth };
        // What closes so slowly that it is let, is not so deep when it closes faster that it is lost.
        let slack = slack.max(mul(least.min(scales.least_settled()), scales.margins.tick, 78));
        if let Some(after) = first_touch(one, other, &motion, rest, closing, slack, &mut pair.clearance) {
            let time = from.saturating_add(after);
            if time > TICK.saturating_sub(SAME) {
                // The next tick's, so that what meets when one ends and the other begins meets at one time.
                return;
            }
            pair.time = time;
            self.queue.push(Reverse((time, pair.colliders[0], pair.colliders[1], at as u32)));
        }
    }

    /// By how many times the answers of this tick exceed what a world has.
    fn overspent(&self) -> u32 {
        let budget = (self.flights.list.len() as u32).saturating_mul(BUDGET_EACH).saturating_add(BUDGET);
        self.order.checked_div(budget).unwrap_or(0)
    }

    /// Answers the impacts up to a time of the tick. `from`: where the substep began.
    pub(crate) fn run(
        &mut self,
        [from, to]: [i64; 2],
        stage: &Stage<'_>,
        movers: &mut Movers,
        faults: &mut Vec<Fault>,
    ) {
        self.from = from;
        self.follow(to, stage, movers);
        while let Some(time) = self.first().filter(|&time| time <= to) {
            // What an answer sends on meets after all that met with it, so ids have no say in it.
            self.take_batch(time);
            while self.gather(stage) {
                self.answer([from, to], stage, movers, faults);
            }
        }
        self.settle(to, stage, movers);
    }

    /// When the next pair meets. Times that are no longer a pair's have no say in what meets at one time, so a look that
    /// another one overtakes might as well have been left out.
    fn first(&mut self) -> Option<i64> {
        while let Some(&Reverse((time, _, _, at))) = self.queue.peek() {
            if self.engaged[at as usize].time == time {
                return Some(time);
            }
            self.queue.pop();
        }
        None
    }

    /// Takes the pairs that meet at a time out of the queue, in order.
    fn take_batch(&mut self, time: i64) {
        self.batch.clear();
        while let Some(&Reverse((other, _, _, at))) = self.queue.peek() {
            if other > time.saturating_add(SAME) {
                break;
            }
            self.queue.pop();
            if self.engaged[at as usize].time == other && !self.batch.contains(&(other, at)) {
                self.batch.push((other, at));
            }
        }
        let engaged = &self.engaged;
        self.batch.sort_unstable_by_key(|&(_, at)| engaged[at as usize].colliders);
    }

    /// Bodies that rows push go as these have them in this substep; what may meet them is looked at again.
    fn follow(&mut self, to: i64, stage: &Stage<'_>, movers: &Movers) {
        let mut any = false;
        for place in 0..self.flights.list.len() {
            any |= self.push(place, stage, movers);
        }
        self.look_aside(to, stage, movers);
        for at in 0..if any { self.engaged.len() } else { 0 } {
            let Engaged { flights, held, restitution, .. } = self.engaged[at];
            let pushed = flights.iter().any(|&place| self.flights.list[place as usize].pushed);
            if pushed && (!held || restitution >= ONE) {
                self.foresee(at, self.from, to, stage);
            }
        }
    }

    /// Puts a flight on the way of this substep if rows push its body, and says whether they do.
    fn push(&mut self, place: usize, stage: &Stage<'_>, movers: &Movers) -> bool {
        let flight = &mut self.flights.list[place];
        let pushed = flight.place != 0 && movers.is_pushed(flight.place);
        if pushed {
            let slot = flight.slot as usize;
            let begin = self.past.state(slot);
            flight.state = movers.state(flight.place, &begin, &stage.mobilities[slot], stage.scales);
            (flight.time, flight.gain, flight.pushed) = (self.from, [0; 3], true);
        }
        pushed
    }

    /// The place of a body's flight.
    fn flight(&mut self, slot: u32, stage: &Stage<'_>, movers: &Movers) -> u32 {
        let known = self.flights.list.len();
        let place = self.flights.place(slot, &self.past, stage.bodies, movers);
        if place as usize == known {
            self.disturbs |= stage.repose.holds(slot);
            self.push(known, stage, movers);
        }
        place
    }

    /// Of what is left of the batch the first pair, and what hangs together with it by bodies that move, in order; false if
    /// nothing is.
    fn gather(&mut self, stage: &Stage<'_>) -> bool {
        let Timeline { flights, engaged, batch, group, .. } = self;
        // An answer may have changed bodies of others, which then are in the queue again.
        batch.retain(|&(time, at)| engaged[at as usize].time == time);
        if batch.is_empty() {
            return false;
        }
        group.clear();
        group.push(batch.remove(0).1);
        let mut seen = 0;
        while seen < group.len() && !batch.is_empty() {
            let joined = engaged[group[seen] as usize].flights.map(|place| {
                let slot = flights.list[place as usize].slot as usize;
                if stage.mobilities[slot].moves() { place } else { NONE }
            });
            batch.retain(|&(_, at)| {
                let hangs = engaged[at as usize].flights.iter().any(|place| joined.contains(place));
                if hangs {
                    group.push(at);
                }
                !hangs
            });
            seen = next(seen);
        }
        group.sort_unstable_by_key(|&at| engaged[at as usize].colliders);
        true
    }
}
