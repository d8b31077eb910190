//! Whom a body that was struck may meet on its new way.

use super::super::flight::{Flight, NONE, State};
use super::super::mover::Movers;
use super::{Engaged, Stage, Timeline};
use crate::geom::Aabb;
use crate::num::mul;

impl Timeline {
    /// A body that was struck goes another way: whom it may meet there.
    pub(super) fn meet_again(&mut self, place: usize, time: i64, to: i64, stage: &Stage<'_>, movers: &Movers) {
        self.find_again(place, stage, movers, |timeline, bodies, pair| timeline.is_slow(bodies, pair, stage));
        self.look_again(place, time, to, stage);
    }

    /// Takes in pairs of a body with those around its new way; of pairs that have rows those that are not `left` to them.
    pub(super) fn find_again(
        &mut self,
        place: usize,
        stage: &Stage<'_>,
        movers: &Movers,
        left: impl Fn(&Self, [u32; 2], u32) -> bool,
    ) {
        let Stage { bodies, colliders, touch, .. } = *stage;
        let Flight { slot, around, .. } = self.flights.list[place];
        let (mut found, mut known) = (core::mem::take(&mut self.found), core::mem::take(&mut self.known));
        found.clear();
        touch.around(&around, |collider| found.push(collider));
        for &other in &self.struck {
            let Flight { slot, around: other, .. } = self.flights.list[other as usize];
            if other.overlaps(&around) {
                found.extend(colliders.list(bodies.cold.value(slot as usize).first).map(|at| at as u32));
            }
        }
        found.sort_unstable();
        found.dedup();
        self.pairs_of(place, &mut known);
        for own in colliders.list(bodies.cold.value(slot as usize).first) {
            for &other in &found {
                let (a, b) = (other.min(own as u32), other.max(own as u32));
                // Exactly, so that what the broad phase hands out besides of what moves has no say.
                if a == b || !self.way(other, stage).overlaps(&around) || known.contains(&[a, b]) {
                    continue;
                }
                let (pair, held) = touch.pair_of([a, b]);
                let of = [a, b].map(|at| colliders.rows.value(at as usize).body);
                if !(held && left(self, of, pair)) && touch.may_strike([a, b], bodies, colliders) {
                    self.add([a, b], of, pair, held, stage, movers);
                }
            }
        }
        (self.found, self.known) = (found, known);
    }

    /// Whether bodies with rows are so slow that these take whatever comes together.
    fn is_slow(&self, bodies: [u32; 2], pair: u32, stage: &Stage<'_>) -> bool {
        let restitution = stage.touch.pairs[pair as usize].restitution;
        let smaller = stage.smaller(stage.touch.pairs[pair as usize].colliders);
        self.fastest(bodies, stage) < stage.scales.least_strike(restitution, stage.bears(pair), smaller)
    }

    /// A bound of the speed of points of two bodies against each other, Q48 m/s.
    pub(super) fn fastest(&self, bodies: [u32; 2], stage: &Stage<'_>) -> i64 {
        let [a, b] = bodies.map(|slot| {
            let at = slot as usize;
            let state = self.flights.known(at).map_or_else(|| self.past.state(at), |flight| flight.state);
            (state.v, mul(state.omega.saturating_abs(), stage.mobilities[at].reach, 32))
        });
        let line = [0, 1].map(|axis: usize| a.0[axis].saturating_sub(b.0[axis]).saturating_abs());
        line[0].saturating_add(line[1]).saturating_add(a.1).saturating_add(b.1)
    }

    /// A box around the way of a collider: its body's own, or where impacts sent that.
    fn way(&self, collider: u32, stage: &Stage<'_>) -> Aabb {
        let body = stage.colliders.rows.value(collider as usize).body as usize;
        match self.flights.known(body) {
            Some(flight) if flight.aside => flight.around,
            _ => {
                let (State { x, v, .. }, margins) = (self.past.state(body), stage.scales.margins);
                stage.touch.way(collider as usize, x, v, stage.drive.gain(body, margins.tick), margins)
            }
        }
    }

    /// The colliders of all pairs of a body.
    fn pairs_of(&self, place: usize, pairs: &mut Vec<[u32; 2]>) {
        pairs.clear();
        let mut at = self.flights.list[place].first;
        while at != NONE {
            let pair = &self.engaged[at as usize];
            pairs.push(pair.colliders);
            at = pair.next[usize::from(pair.flights[0] as usize != place)];
        }
    }

    /// Looks again when the pairs of a body that was struck meet.
    fn look_again(&mut self, place: usize, from: i64, to: i64, stage: &Stage<'_>) {
        let mut at = self.flights.list[place].first;
        while at != NONE {
            let Engaged { flights, next, .. } = self.engaged[at as usize];
            let side = usize::from(flights[0] as usize != place);
            // Of two that one answer changed, the first has looked at their pair.
            if self.flights.list[flights[1 ^ side] as usize].looked != self.order {
                self.foresee(at as usize, from, to, stage);
            }
            at = next[side];
        }
        self.flights.list[place].looked = self.order;
    }
}
