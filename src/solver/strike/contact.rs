//! One contact by itself: what its rows do to each other until they agree, before the bodies get it.

use super::{Row, Speed, Strike, give, over, product};
use crate::num::{clamp_i64, div, mul};

/// How often friction and the points of a contact are gone through at most, and from when on without foresight: that it
/// knows what the points will answer brings most to an end in two or three.
const PASSES: u32 = 24;
const PLAIN: u32 = 8;

/// What friction has to know of the points: how they answer it.
#[derive(Clone, Copy)]
struct Slope {
    /// 1/(κ − what the points' answer takes of it), Q62, and how much of friction's impulse their load gives way by, Q48.
    inverse: i64,
    yields: i64,
}

impl Strike {
    /// Solves friction and both points until none changes by more than `enough`, while nothing else pushes the bodies; the
    /// greatest change of an impulse.
    pub(super) fn sweep(&mut self, speeds: &mut [Speed], enough: i64) -> i64 {
        if self.brace.is_some() {
            return self.hold(speeds);
        }
        let [a, b] = self.bodies.map(|at| speeds[at]);
        let mut apart = [0, 1].map(|at: usize| self.points[at].speed(&a, &b));
        let start = [self.friction.impulse, self.points[0].impulse, self.points[1].impulse];
        if self.rough > 0 {
            let mut slip = self.friction.speed(&a, &b);
            let across = [0, 1].map(|at: usize| self.points[at].turned_by(&self.friction));
            for pass in 0..PASSES {
                let slide = self.slide(slip, across, pass < PLAIN);
                if pass > 0 && slide.saturating_abs() <= enough {
                    break;
                }
                self.friction.impulse = self.friction.impulse.saturating_add(slide);
                slip = slip.saturating_add(mul(self.friction.kappa, slide, 48));
                for (apart, across) in apart.iter_mut().zip(across) {
                    *apart = apart.saturating_add(mul(across, slide, 48));
                }
                for (change, across) in self.press(&mut apart).into_iter().zip(across) {
                    slip = slip.saturating_add(mul(across, change, 48));
                }
            }
        } else {
            self.press(&mut apart);
        }
        let mut changed = 0;
        for (at, start) in start.into_iter().enumerate() {
            let row = if at == 0 { &self.friction } else { &self.points[at.saturating_sub(1)] };
            let change = row.impulse.saturating_sub(start);
            give(self.bodies, self.share, row, change, speeds);
            changed = changed.max(change.saturating_abs());
        }
        changed
    }

    /// Of bodies that go on as one: once through all rows; the greatest change of an impulse.
    fn hold(&mut self, speeds: &mut [Speed]) -> i64 {
        let mut changed = 0;
        let rows = self.brace.iter_mut().flatten().chain([&mut self.friction, &mut self.points[0]]);
        for row in rows {
            let [a, b] = self.bodies.map(|at| speeds[at]);
            let change = mul(row.speed(&a, &b), row.inverse, 62).saturating_neg();
            row.impulse = row.impulse.saturating_add(change);
            give(self.bodies, self.share, row, change, speeds);
            changed = changed.max(change.saturating_abs());
        }
        changed
    }

    /// By how much the impulse of friction is to change, so that nothing slips, or within what it may be of the load; with
    /// `foresight` of what the points will make of it. `across`: what it adds to the points' speeds, Q48.
    fn slide(&self, slip: i64, across: [i64; 2], foresight: bool) -> i64 {
        let now = self.friction.impulse;
        let [load, _] = self.impulse();
        let slope = if foresight && load > 0 { self.slope(across) } else { None };
        let Slope { inverse, yields } = slope.unwrap_or(Slope { inverse: self.friction.inverse, yields: 0 });
        let change = mul(slip, inverse, 62).saturating_neg();
        let then = now.saturating_add(change);
        let most = mul(load.saturating_sub(mul(yields, change, 48)).max(0), self.rough, 48);
        if then.saturating_abs() <= most {
            return change;
        }
        // It slides: f = ±μ·(N − y·(f − f₀)), for f.
        let rough = if then < 0 { self.rough.saturating_neg() } else { self.rough };
        let by = mul(rough, yields, 48).saturating_add(1 << 48);
        let bound = if by > 1 << 45 {
            clamp_i64(div(product(rough, load.saturating_add(mul(yields, now, 48))), by.into()))
        } else {
            mul(rough, load, 48)
        };
        let bound = if (bound < 0) == (rough < 0) { bound } else { 0 };
        bound.saturating_sub(now)
    }

    /// How the points that press now would answer friction; none if they hardly leave it anything.
    fn slope(&self, across: [i64; 2]) -> Option<Slope> {
        let [p, q] = &self.points;
        let reply = match [p.impulse > 0, q.impulse > 0] {
            [true, true] => {
                let determinant = self.determinant?;
                let part = |own: &Row, other: usize| {
                    let [mine, theirs] = [across[1 ^ other], across[other]];
                    over(product(own.kappa, mine).saturating_sub(product(self.couple, theirs)), determinant)
                };
                [part(q, 1), part(p, 0)]
            }
            [true, false] => [mul(across[0], p.inverse, 62), 0],
            [false, true] => [0, mul(across[1], q.inverse, 62)],
            [false, false] => return None,
        };
        let taken = mul(across[0], reply[0], 48).saturating_add(mul(across[1], reply[1], 48));
        let left = self.friction.kappa.saturating_sub(taken);
        let inverse = (left > self.friction.kappa >> 6).then(|| clamp_i64(div(1 << 110, left.into())))?;
        Some(Slope { inverse, yields: reply[0].saturating_add(reply[1]) })
    }

    /// Gives the points what they want; the changes of their impulses. `apart`: their speeds, which follow.
    fn press(&mut self, apart: &mut [i64; 2]) -> [i64; 2] {
        let change = self.answer(*apart);
        for (at, other) in [(0, 1), (1, 0)] {
            self.points[at].impulse = self.points[at].impulse.saturating_add(change[at]);
            let own = mul(self.points[at].kappa, change[at], 48);
            apart[at] = apart[at].saturating_add(own).saturating_add(mul(self.couple, change[other], 48));
        }
        change
    }

    /// The changes of the points' impulses that give them their target speeds, none of them pulling.
    fn answer(&self, apart: [i64; 2]) -> [i64; 2] {
        let want = [0, 1].map(|at: usize| self.points[at].target.saturating_sub(apart[at]));
        let least = [0, 1].map(|at: usize| self.points[at].impulse.saturating_neg());
        let alone = |at: usize, want: i64| mul(want, self.points[at].inverse, 62).max(least[at]);
        let Some(determinant) = self.determinant else {
            // One point, or two that are nearly the same: the one that wants more.
            let deeper = usize::from(self.count > 1 && want[1] > want[0]);
            let mut change = [0; 2];
            change[deeper] = alone(deeper, want[deeper]);
            return change;
        };
        let both = [0, 1].map(|at: usize| {
            let other = 1 ^ at;
            let change = product(self.points[other].kappa, want[at]).saturating_sub(product(self.couple, want[other]));
            over(change, determinant)
        });
        if both[0] >= least[0] && both[1] >= least[1] {
            return both;
        }
        // One point gives back what it has, and the other answers alone: right if the first then separates by itself.
        let single = |free: usize| {
            let held = 1 ^ free;
            let mut change = least;
            change[free] = alone(free, want[free].saturating_sub(mul(self.couple, least[held], 48)));
            let own = mul(self.points[held].kappa, least[held], 48);
            let speed = own.saturating_add(mul(self.couple, change[free], 48));
            (change, speed.saturating_sub(want[held]))
        };
        let [(first, second_parts), (second, first_parts)] = [single(0), single(1)];
        if second_parts >= first_parts { first } else { second }
    }
}
