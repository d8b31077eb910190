//! When a pair meets, as far as the ways of its bodies are known.

use super::super::flight::{Flight, State, TICK, motion};
use super::super::strike::ONE;
use super::{DEEPER, MOST, NEVER, PASSED_ON, SAME, Stage, Timeline};
use crate::narrow::{Clearance, first_touch};
use crate::num::mul;
use core::cmp::Reverse;

impl Timeline {
    /// Looks when a pair meets, from a time on and as far as the ways of its bodies are known: to `end` if rows push one.
    pub(super) fn foresee(&mut self, at: usize, from: i64, end: i64, stage: &Stage<'_>) {
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
        let rest = until.saturating_sub(from);
        if is_ample(&pair.clearance, [&p, &q], [&a.gain, &b.gain], mul(scales.margins.tick, rest, 32)) {
            return;
        }
        let motion = motion(&p, &q, [&a.gain, &b.gain], scales);
        let closing = mul(least, scales.margins.tick, 71);
        let [one, other] = pair.colliders.map(|slot| stage.colliders.outline(slot as usize));
        if pair.clearance.lasts(&motion, rest) || motion.fastest([one.reach, other.reach], rest) < closing {
            return;
        }
        let depth = pair.depth.saturating_add(DEEPER);
        let slack = if a.place != 0 || b.place != 0 { scales.slack.max(depth) } else { depth };
        // What closes so slowly that it is let, is not so deep when it closes faster that it is lost.
        let slack = slack.max(mul(least.min(scales.least_settled()), scales.margins.tick, 78));
        let placed = self.poses.of(pair.colliders, [one, other], motion.angle);
        if let Some(after) = first_touch(one, other, placed, &motion, rest, closing, slack, &mut pair.clearance) {
            let time = from.saturating_add(after);
            if time > TICK.saturating_sub(SAME) {
                // The next tick's, so that what meets when one ends and the other begins meets at one time.
                return;
            }
            pair.time = time;
            self.queue.push(Reverse((time, pair.colliders[0], pair.colliders[1], at as u32)));
        }
    }
}

/// Whether the gap of two bodies is so wide that it need not be known how they go, for a time (Q63 s).
fn is_ample(clearance: &Clearance, [p, q]: [&State; 2], [g, h]: [&[i64; 3]; 2], span: i64) -> bool {
    let length = |v: [i64; 2], u: [i64; 2]| {
        let [x, y] = [0, 1].map(|axis: usize| v[axis].saturating_sub(u[axis]).saturating_abs());
        x.max(y).saturating_add(x.min(y) >> 1)
    };
    let between = [q.x[0].saturating_sub(p.x[0]), q.x[1].saturating_sub(p.x[1])];
    let line = length(p.v, q.v).saturating_add(length([g[0], g[1]], [h[0], h[1]]));
    let spins =
        [(p, g), (q, h)].map(|(state, gain)| state.omega.saturating_abs().saturating_add(gain[2].saturating_abs()));
    clearance.is_ample(between, [p.angle, q.angle], line, spins, span)
}
