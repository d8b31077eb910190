//! What an impact does to the bodies that it meets.

use super::super::flight::{Flight, NONE, State, rim};
use super::super::mover::Movers;
use super::super::strike::{Strike, solve};
use super::{Engaged, FLAT, LATE, LATER, MANY, MOST, NEVER, REACH, Stage, Timeline};
use crate::geom::Rot;
use crate::motion::{Bound, Fault};
use crate::narrow::{Manifold, collide};
use crate::num::{Angle, add_sat, dot, round_shift};
use crate::shape::Placed;

impl Timeline {
    /// Answers the group.
    pub(super) fn answer(&mut self, span: [i64; 2], stage: &Stage<'_>, movers: &mut Movers, faults: &mut Vec<Fault>) {
        let scales = stage.scales;
        let Timeline {
            flights, engaged, group, locals, speeds, strikes, restitutions, members, before, settled, ..
        } = self;
        let time = group.iter().fold(0, |time: i64, &at| time.max(engaged[at as usize].time));
        locals.clear();
        speeds.clear();
        strikes.clear();
        restitutions.clear();
        members.clear();
        for &at in &*group {
            engaged[at as usize].time = NEVER;
            for place in engaged[at as usize].flights {
                if !locals.contains(&place) {
                    let flight = &mut flights.list[place as usize];
                    (flight.state, flight.time) = (flight.at(time.max(flight.time), scales), time.max(flight.time));
                    locals.push(place);
                    let State { v, omega, .. } = flight.state;
                    let mobility = &stage.mobilities[flight.slot as usize];
                    let line = |v: i64| round_shift(v.into(), scales.shift) as i64;
                    speeds.push([line(v[0]), line(v[1]), rim(omega, mobility, scales)]);
                }
            }
        }
        settled.clear();
        let spent = locals.iter().any(|&place| flights.list[place as usize].strikes >= MANY);
        for &at in &*group {
            let pair = &engaged[at as usize];
            let pick = |i: usize| &flights.list[pair.flights[i] as usize];
            let (a, b) = (pick(0), pick(1));
            let Some((manifold, between)) = touching(pair, a, b, stage) else { continue };
            let bodies = pair.flights.map(|place| locals.iter().position(|&p| p == place).unwrap_or(0));
            let mobility = [a, b].map(|flight| &stage.mobilities[flight.slot as usize]);
            let strike = Strike::new(bodies, &manifold, between, mobility, pair.friction);
            let approach = strike.approach(speeds).saturating_neg();
            if approach > pair.least / 2 {
                let threshold =
                    scales.threshold(pair.restitution, press(a, b, manifold.normal), a.place != 0 && b.place != 0);
                let bounces = approach > threshold && !spent;
                if !bounces {
                    // It rests, and is a row's in the next tick: until then it is not answered over and over.
                    settled.push(at);
                }
                restitutions.push(if bounces { pair.restitution } else { 0 });
                strikes.push(strike);
                members.push(at);
            }
        }
        if strikes.is_empty() {
            // What comes nearer lies beside what it would meet, as a corner over the end of an edge.
            let later = time.saturating_add(LATER);
            for at in 0..self.group.len() {
                let at = self.group[at] as usize;
                self.engaged[at].depth = scales.slack;
                self.foresee(at, later, span[1], stage);
            }
            return;
        }
        solve(strikes, restitutions, speeds, before);
        for &at in &*settled {
            let pair = &mut engaged[at as usize];
            pair.least = pair.least.max(scales.least_settled());
        }
        for at in 0..self.locals.len() {
            self.change(self.locals[at], at, time, span, stage, movers, faults);
        }
        for at in 0..self.members.len() {
            self.note(self.members[at]);
        }
        self.rest(stage);
        for &place in &self.locals {
            let flight = &mut self.flights.list[place as usize];
            flight.surround(stage.mobilities[flight.slot as usize].reach, scales);
        }
        for at in 0..self.locals.len() {
            let place = self.locals[at];
            let slot = self.flights.list[place as usize].slot as usize;
            if stage.mobilities[slot].moves() {
                self.meet_again(place as usize, time, span[1], stage, movers);
            }
        }
    }

    /// Gives a body the speed that its impacts left it.
    #[expect(clippy::too_many_arguments, reason = "one place of the answer")]
    fn change(
        &mut self,
        place: u32,
        at: usize,
        time: i64,
        [_, to]: [i64; 2],
        stage: &Stage<'_>,
        movers: &mut Movers,
        faults: &mut Vec<Fault>,
    ) {
        let flight = &mut self.flights.list[place as usize];
        let slot = flight.slot as usize;
        let (mobility, k) = (&stage.mobilities[slot], stage.scales.shift);
        if !mobility.moves() {
            return;
        }
        if flight.strikes == 0 {
            self.struck.push(place);
        }
        flight.strikes = flight.strikes.saturating_add(1);
        let mut change = [0, 1, 2].map(|axis: usize| self.speeds[at][axis].saturating_sub(self.before[at][axis]));
        if flight.strikes >= MANY {
            faults.push(Fault { slot, bound: Bound::Impacts });
        }
        if flight.strikes >= MOST {
            // It has been to and fro so often that it stays: better than to pass through something.
            change = self.before[at].map(i64::saturating_neg);
            flight.gain = [0; 3];
        }
        let State { v, omega, .. } = &mut flight.state;
        for (v, change) in v.iter_mut().zip(change) {
            *v = add_sat(*v, change.saturating_mul(1 << k));
        }
        *omega = add_sat(*omega, mobility.over_sigma(change[2], 48u32.saturating_sub(k), 48));
        movers.strike(flight.place, change, to.saturating_sub(time), stage.scales);
    }

    /// What came to rest is held: of the forces, contacts take what would press them together in what is left of the tick.
    fn rest(&mut self, stage: &Stage<'_>) {
        let Timeline { flights, locals, speeds, strikes, restitutions, before, .. } = self;
        let mut resting = restitutions.iter().map(|&restitution| restitution == 0);
        strikes.retain(|_| resting.next().unwrap_or(false));
        if strikes.is_empty() {
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
        solve(strikes, restitutions, speeds, before);
        let k = stage.scales.shift;
        for (at, &place) in locals.iter().enumerate() {
            let slot = flights.list[place as usize].slot as usize;
            let mobility = &stage.mobilities[slot];
            let change = [0, 1, 2].map(|axis: usize| speeds[at][axis].saturating_sub(before[at][axis]));
            let gain = &mut flights.list[place as usize].gain;
            for (gain, change) in gain.iter_mut().zip([change[0], change[1]]) {
                *gain = add_sat(*gain, change.saturating_mul(1 << k));
            }
            if mobility.moves() {
                gain[2] = add_sat(gain[2], mobility.over_sigma(change[2], 48u32.saturating_sub(k), 48));
            }
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

/// Where a pair touches: its manifold, and the way from a's centre to b's. Of two points that are not level, the lower.
fn touching(pair: &Engaged, a: &Flight, b: &Flight, stage: &Stage<'_>) -> Option<(Manifold, [i64; 2])> {
    let outlines = pair.colliders.map(|slot| stage.colliders.outline(slot as usize));
    let placed = [(outlines[0], a), (outlines[1], b)]
        .map(|(outline, flight)| Placed::new(outline, Rot::new(Angle::from_bits(flight.state.angle))));
    let between = [0, 1].map(|axis: usize| b.state.x[axis].saturating_sub(a.state.x[axis]));
    let size = (outlines[0].reach.max(outlines[1].reach) >> 34).saturating_add(1);
    let reach = REACH.saturating_mul(size);
    let mut manifold = collide(&placed[0], &placed[1], between, reach.saturating_add(FLAT));
    if manifold.count == 2 {
        let [p, q] = manifold.points;
        if p.separation.abs_diff(q.separation) > FLAT.unsigned_abs() {
            manifold.points[0] = if p.separation < q.separation { p } else { q };
            manifold.count = 1;
        }
    }
    let near = manifold.points[..manifold.count as usize].iter().any(|point| point.separation <= reach);
    near.then_some((manifold, between))
}

/// How fast forces press on one of two bodies along a normal in a tick, Q48 m/s.
fn press(a: &Flight, b: &Flight, normal: [i32; 2]) -> i64 {
    let n = normal.map(i64::from);
    let along = |flight: &Flight| dot(flight.weight, n, 30).saturating_abs();
    along(a).max(along(b))
}
