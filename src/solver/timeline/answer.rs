//! What an impact does to the bodies that it meets.

use super::super::flight::{Flight, NONE, State, rim};
use super::super::mover::Movers;
use super::super::scales::weight;
use super::super::strike::{LIMIT, ONE, Strike, solve};
use super::{AGAIN, Engaged, FLAT, LATE, LATER, LEAP, MANY, MOST, NEVER, OFTEN, REACH, Settled, Stage, Timeline};
use crate::contact::{Collision, Pace};
use crate::geom::{Rot, Vec2};
use crate::motion::{Bound, Fault};
use crate::narrow::{Manifold, Point, collide};
use crate::num::{Angle, AngularVelocity, Velocity, add_sat, clamp_i64, lane::next, mul, round_shift};
use crate::shape::Placed;

/// By how many strikes one counts against a body that stays.
const SOON: u32 = 40;
/// So many contacts are answered together at most, but for those that meet at one time.
const BLOCK: usize = 64;

impl Timeline {
    /// Answers the group.
    pub(super) fn answer(&mut self, span: [i64; 2], stage: &Stage<'_>, movers: &mut Movers, faults: &mut Vec<Fault>) {
        let time = self.group.iter().fold(0, |time: i64, &at| time.max(self.engaged[at as usize].time));
        self.begin(time, stage);
        if self.strikes.is_empty() {
            // What comes nearer lies beside what it would meet, as a corner over the end of an edge.
            for at in 0..self.group.len() {
                let at = self.group[at] as usize;
                let bodies = self.engaged[at].flights.map(|place| self.flights.list[place as usize].slot);
                let speed = mul(self.fastest(bodies, stage), stage.scales.margins.tick, 79).max(1);
                let pair = &mut self.engaged[at];
                let leap = (LEAP << 32).checked_div(speed).unwrap_or(0).clamp(1, LATER);
                let leap = leap.saturating_mul(1 << pair.misses.min(10)).min(LATER);
                pair.misses = pair.misses.saturating_add(1);
                pair.depth = stage.scales.slack;
                self.foresee(at, time.saturating_add(leap), span[1], stage);
            }
            return;
        }
        let met = self.members.len();
        self.lean(time, stage);
        solve(&mut self.strikes, &self.restitutions, &self.weights, &mut self.speeds, &mut self.before);
        for (&at, &restitution) in self.members.iter().zip(&self.restitutions) {
            let pair = &mut self.engaged[at as usize];
            pair.rests = restitution == 0;
            if (pair.rests || pair.answers >= AGAIN) && pair.restitution < ONE && !pair.held && pair.pair < LATE {
                self.settling.push(at);
            }
        }
        for at in 0..self.locals.len() {
            self.change(at, time, span, stage, movers, faults);
        }
        self.tell(time, stage);
        for at in 0..met {
            self.note(self.members[at]);
        }
        self.rest(stage);
        self.locals.retain(|&place| self.flights.list[place as usize].changed);
        for &place in &self.locals {
            let flight = &mut self.flights.list[place as usize];
            flight.surround(stage.mobilities[flight.slot as usize].reach, stage.scales);
        }
        for at in 0..self.locals.len() {
            self.meet_again(self.locals[at] as usize, time, span[1], stage, movers);
        }
    }

    /// Takes in what of the group touches and closes.
    fn begin(&mut self, time: i64, stage: &Stage<'_>) {
        self.locals.clear();
        self.speeds.clear();
        self.priors.clear();
        self.weights.clear();
        self.strikes.clear();
        self.restitutions.clear();
        self.members.clear();
        let spent = self.overspent() > 0;
        for at in 0..self.group.len() {
            let at = self.group[at];
            self.engaged[at as usize].time = NEVER;
            let Some(strike) = self.contact(at, time, stage) else { continue };
            let pair = &mut self.engaged[at as usize];
            let approach = strike.approach(&self.speeds).saturating_neg();
            if approach <= pair.least / 2 {
                continue;
            }
            let [a, b] = pair.flights.map(|place| &self.flights.list[place as usize]);
            let press = press(a, b);
            let threshold = stage.scales.threshold(pair.restitution, press, a.place != 0 && b.place != 0);
            let spent = spent || a.strikes.max(b.strikes) >= MANY || strike.is_joined();
            let bounces = approach > threshold && !spent;
            if !bounces {
                // It rests, and is a row's in the next tick: until then it is not answered over and over.
                pair.least = pair.least.max(stage.scales.least_settled());
            }
            let stays = a.strikes.max(b.strikes) >= MOST;
            let flights = pair.flights;
            (pair.answers, pair.misses) = (pair.answers.saturating_add(1), 0);
            self.restitutions.push(if bounces { pair.restitution } else { 0 });
            self.strikes.push(strike);
            self.members.push(at);
            // Who meets one that stays comes to that soon, or a crowd would strike it for as long as each may.
            for place in flights.into_iter().filter(|_| stays) {
                let strikes = &mut self.flights.list[place as usize].strikes;
                *strikes = strikes.saturating_add(SOON);
            }
        }
    }

    /// What impacts of this tick brought to rest against a body that is hit leans on it: answered with the others, or a
    /// body without restitution is struck to and fro between two others until it is slow. Where something bounces, only
    /// what does not separate: an impulse on it would add energy.
    fn lean(&mut self, time: i64, stage: &Stage<'_>) {
        let bounces = self.restitutions.iter().any(|&restitution| restitution > 0);
        let mut seen = 0;
        while seen < self.locals.len() {
            let place = self.locals[seen];
            seen = next(seen);
            let flight = &self.flights.list[place as usize];
            if !stage.mobilities[flight.slot as usize].moves() {
                continue;
            }
            let mut at = flight.first;
            while at != NONE && self.strikes.len() < BLOCK {
                let Engaged { flights, next, rests, .. } = self.engaged[at as usize];
                if rests && !self.members.contains(&at) {
                    let known = self.locals.len();
                    match self.contact(at, time, stage) {
                        Some(strike) if !bounces || strike.parting(&self.speeds) <= stage.scales.still() => {
                            self.restitutions.push(0);
                            self.strikes.push(strike);
                            self.members.push(at);
                        }
                        _ => self.forget(known),
                    }
                }
                at = next[usize::from(flights[0] != place)];
            }
        }
    }

    /// The contact of a pair at a time, if it touches; its bodies are taken in.
    fn contact(&mut self, at: u32, time: i64, stage: &Stage<'_>) -> Option<Strike> {
        let (places, spent) = (self.engaged[at as usize].flights, self.overspent() > 0);
        let bodies = places.map(|place| self.local(place, time, stage));
        let pair = &mut self.engaged[at as usize];
        let [a, b] = places.map(|place| &self.flights.list[place as usize]);
        let (manifold, between) = touching(pair, a, b, stage)?;
        // What closes hundreds of times in a tick gets deeper by half of what touching is each time.
        let overlap = |point: &Point| point.separation.saturating_neg();
        pair.depth = manifold.points.iter().map(overlap).fold(pair.depth, i64::max);
        let mobility = [a, b].map(|flight| &stage.mobilities[flight.slot as usize]);
        let joined = pair.answers >= OFTEN && (pair.restitution < ONE || spent);
        let of = |manifold: &Manifold| Strike::new(bodies, manifold, between, mobility, pair.friction, joined);
        let [p, q] = manifold.points;
        if manifold.count < 2 || p.separation.abs_diff(q.separation) <= FLAT.unsigned_abs() {
            return Some(of(&manifold));
        }
        // Of two points that are not level the lower: but where both overlap already, it may part while the other closes.
        let [low, high] = if p.separation < q.separation { [p, q] } else { [q, p] };
        let alone = |point: Point| of(&Manifold { count: 1, points: [point, Point::default()], ..manifold.clone() });
        let strike = alone(low);
        let other = high.separation <= 0 && strike.approach(&self.speeds).saturating_neg() <= pair.least / 2;
        Some(if other { alone(high) } else { strike })
    }

    /// The place of a body among those of the answer, to whose time it is brought.
    fn local(&mut self, place: u32, time: i64, stage: &Stage<'_>) -> usize {
        if let Some(known) = self.locals.iter().position(|&local| local == place) {
            return known;
        }
        let scales = stage.scales;
        let flight = &mut self.flights.list[place as usize];
        let time = time.max(flight.time);
        (flight.state, flight.time, flight.changed) = (flight.at(time, scales), time, false);
        let State { v, omega, .. } = flight.state;
        let line = |v: i64| round_shift(v.into(), scales.shift) as i64;
        self.speeds.push([line(v[0]), line(v[1]), rim(omega, &stage.mobilities[flight.slot as usize], scales)]);
        self.priors.push(flight.state);
        self.weights.push(stage.mobilities[flight.slot as usize].weight());
        self.locals.push(place);
        self.locals.len().saturating_sub(1)
    }

    /// Leaves only the first bodies in.
    fn forget(&mut self, known: usize) {
        self.locals.truncate(known);
        self.speeds.truncate(known);
        self.priors.truncate(known);
        self.weights.truncate(known);
    }

    /// Gives a body the speed that its impacts left it.
    fn change(
        &mut self,
        at: usize,
        time: i64,
        [_, to]: [i64; 2],
        stage: &Stage<'_>,
        movers: &mut Movers,
        faults: &mut Vec<Fault>,
    ) {
        let (place, overspent) = (self.locals[at], self.overspent());
        let flight = &mut self.flights.list[place as usize];
        let slot = flight.slot as usize;
        let (mobility, k) = (&stage.mobilities[slot], stage.scales.shift);
        let mut change = [0, 1, 2].map(|axis: usize| self.speeds[at][axis].saturating_sub(self.before[at][axis]));
        if !mobility.moves() || change == [0; 3] {
            return;
        }
        flight.changed = true;
        if !flight.aside {
            self.struck.push(place);
        }
        flight.aside = true;
        flight.strikes = flight.strikes.saturating_add(1);
        let bound = |speed: &i64| speed.unsigned_abs() >= LIMIT.unsigned_abs();
        if self.speeds[at].iter().any(bound) {
            faults.push(Fault { slot, bound: Bound::ContactSpeed });
        }
        if overspent > 1 {
            flight.strikes = flight.strikes.max(MOST);
        }
        if flight.strikes >= MANY || overspent > 0 {
            faults.push(Fault { slot, bound: Bound::Impacts });
        }
        if flight.strikes >= MOST {
            // It has been to and fro so often that it stays: better than to pass through something.
            change = self.before[at].map(i64::saturating_neg);
            flight.gain = [0; 3];
        }
        let State { v, omega, .. } = &mut flight.state;
        for (v, change) in v.iter_mut().zip(change) {
            *v = add_sat(*v, clamp_i64(i128::from(change) << k));
        }
        *omega = add_sat(*omega, mobility.over_sigma(change[2], 48u32.saturating_sub(k), 48));
        movers.strike(flight.place, change, to.saturating_sub(time), stage.scales);
    }

    /// Tells what happened.
    fn tell(&mut self, time: i64, stage: &Stage<'_>) {
        let Stage { bodies, colliders, scales, .. } = *stage;
        let Timeline { flights, engaged, locals, priors, strikes, members, collisions, order, .. } = self;
        for (strike, &at) in strikes.iter().zip(&*members) {
            let pair = &engaged[at as usize];
            let [one, other] = pair.flights.map(|place| flights.list[place as usize]);
            let masses = [one, other].map(|flight| bodies.cold.value(flight.slot as usize).mass);
            let impulse = strike.impulse_on_a(masses, scales.shift);
            if impulse.is_zero() {
                continue;
            }
            let id = |at: usize| colliders.id(pair.colliders[at] as usize);
            let prior = |at: usize| pace(&priors[strike.bodies[at]]);
            let latter = |at: usize| pace(&flights.list[locals[strike.bodies[at]] as usize].state);
            collisions.push(Collision {
                tick: 0,
                ordinal: 0,
                a: id(0),
                b: id(1),
                order: *order,
                time: scales.time(time),
                point: strike.center(one.state.x),
                normal: strike.normal(),
                impulse,
                before: [prior(0), prior(1)],
                after: [latter(0), latter(1)],
            });
        }
        *order = order.saturating_add(1);
    }

    /// What came to rest is held: of the forces, contacts take what would press them together in what is left of the tick.
    fn rest(&mut self, stage: &Stage<'_>) {
        let Timeline { flights, locals, speeds, strikes, restitutions, weights, before, .. } = self;
        let mut resting = restitutions.iter().map(|&restitution| restitution == 0);
        strikes.retain(|_| resting.next().unwrap_or(false));
        // Those that rows push have their forces already.
        let pressed = |&place: &u32| flights.list[place as usize].gain != [0; 3];
        if strikes.is_empty() || !locals.iter().any(pressed) {
            return;
        }
        let of =
            |place: u32| (&flights.list[place as usize], &stage.mobilities[flights.list[place as usize].slot as usize]);
        for (speed, &place) in speeds.iter_mut().zip(&*locals) {
            let (flight, mobility) = of(place);
            let [x, y, turning] = flight.gain;
            let line = |v: i64| round_shift(v.into(), stage.scales.shift) as i64;
            *speed = [line(x), line(y), rim(turning, mobility, stage.scales)];
        }
        strikes.iter_mut().for_each(Strike::smooth);
        restitutions.clear();
        restitutions.resize(strikes.len(), 0);
        solve(strikes, restitutions, weights, speeds, before);
        let k = stage.scales.shift;
        for (at, &place) in locals.iter().enumerate() {
            let slot = flights.list[place as usize].slot as usize;
            let mobility = &stage.mobilities[slot];
            let change = [0, 1, 2].map(|axis: usize| speeds[at][axis].saturating_sub(before[at][axis]));
            let gain = &mut flights.list[place as usize].gain;
            for (gain, change) in gain.iter_mut().zip([change[0], change[1]]) {
                *gain = add_sat(*gain, clamp_i64(i128::from(change) << k));
            }
            if mobility.moves() {
                gain[2] = add_sat(gain[2], mobility.over_sigma(change[2], 48u32.saturating_sub(k), 48));
            }
        }
    }

    /// What impacts of this substep left at rest between bodies that rows know, rows hold from its end on: else gravity and
    /// the neighbours bring it together again in every substep. Bodies that are answered again and again get to know rows.
    pub(super) fn settle(&mut self, to: i64, stage: &Stage<'_>, movers: &mut Movers) {
        let Timeline { engaged, flights, settling, settled, past, .. } = self;
        settling.sort_unstable_by_key(|&at| engaged[at as usize].colliders);
        settling.dedup();
        for at in settling.drain(..) {
            let pair = &mut engaged[at as usize];
            let [a, b] = pair.flights.map(|place| flights.list[place as usize]);
            let stranger = |flight: &Flight| flight.place == 0 && !stage.mobilities[flight.slot as usize].fixed;
            let strange = stranger(&a) || stranger(&b);
            if strange && (pair.answers < AGAIN || movers.is_empty()) {
                continue;
            }
            let outlines = pair.colliders.map(|slot| stage.colliders.outline(slot as usize));
            let states = [a.at(to, stage.scales), b.at(to, stage.scales)];
            let placed =
                [0, 1].map(|body: usize| Placed::new(outlines[body], Rot::new(Angle::from_bits(states[body].angle))));
            let between = [0, 1].map(|axis: usize| states[1].x[axis].saturating_sub(states[0].x[axis]));
            let manifold = collide(&placed[0], &placed[1], between, stage.scales.margins.base);
            if manifold.count == 0 {
                continue;
            }
            let begins = [a, b].map(|flight| past.state(flight.slot as usize));
            let far = |body: usize| !Movers::may_join(&begins[body], &states[body], stage.scales);
            if stranger(&a) && far(0) || stranger(&b) && far(1) {
                continue;
            }
            for ((place, now), begin) in pair.flights.into_iter().zip(&states).zip(&begins) {
                let flight = &mut flights.list[place as usize];
                if stranger(flight) {
                    let mobility = &stage.mobilities[flight.slot as usize];
                    flight.place = movers.join(flight.slot, [begin, now], stage.bodies, mobility, stage.scales);
                }
            }
            pair.held = true;
            pair.least = stage.scales.least_strike(pair.restitution, true, stage.smaller(pair.colliders));
            settled.push(Settled { pair: pair.pair, manifold, between });
        }
    }

    /// Notes that a pair has met.
    fn note(&mut self, at: u32) {
        let pair = &mut self.engaged[at as usize];
        match pair.pair {
            LATE => {}
            NONE => {
                pair.pair = LATE;
                let bodies = pair.flights.map(|place| self.flights.list[place as usize].slot);
                self.late.push([pair.colliders, bodies]);
            }
            met => self.met.push(met),
        }
    }
}

/// How fast a body is.
fn pace(state: &State) -> Pace {
    let [x, y] = state.v.map(Velocity::from_bits);
    Pace { velocity: Vec2::new(x, y), angular_velocity: AngularVelocity::from_bits(state.omega) }
}

/// Where a pair touches: its manifold, and the way from a's centre to b's.
fn touching(pair: &Engaged, a: &Flight, b: &Flight, stage: &Stage<'_>) -> Option<(Manifold, [i64; 2])> {
    let outlines = pair.colliders.map(|slot| stage.colliders.outline(slot as usize));
    let placed = [(outlines[0], a), (outlines[1], b)]
        .map(|(outline, flight)| Placed::new(outline, Rot::new(Angle::from_bits(flight.state.angle))));
    let between = [0, 1].map(|axis: usize| b.state.x[axis].saturating_sub(a.state.x[axis]));
    let size = (outlines[0].reach.max(outlines[1].reach) >> 34).saturating_add(1);
    let reach = REACH.saturating_mul(size);
    let manifold = collide(&placed[0], &placed[1], between, reach.saturating_add(FLAT));
    let near = manifold.points[..manifold.count as usize].iter().any(|point| point.separation <= reach);
    near.then_some((manifold, between))
}

/// How fast forces press on one of two bodies in a tick, Q48 m/s.
fn press(a: &Flight, b: &Flight) -> i64 {
    weight(a.weight).max(weight(b.weight))
}
