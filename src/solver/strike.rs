//! The answer to impacts: impulses for all points of the contacts that meet at one time, together (IM:col2D, GD:impulse).
//!
//! Wide arithmetic: impacts are few. As in the rows an impulse λ is carried as μ = λ·(1/m_a + 1/m_b), a velocity, and a
//! body's turning as w = σ·ω, so that every coefficient is a ratio (`mobility.rs`).
//!
//! | value | format | bound |
//! |---|---|---|
//! | velocities, impulses | Q48 m/s | 2⁶¹ |
//! | share p, lever p·τ | Q48 | 1, 231 |
//! | arm α | Q48 | 8 |
//! | κ | Q48 | 120² + 1 < 2¹⁴: a body's gyration is at least 1/120 of its reach |

mod contact;
#[cfg(test)]
mod tests;

use super::mobility::Mobility;
use crate::geom::Vec2;
use crate::narrow::Manifold;
use crate::num::{Impulse, Length, Mass, Quantity, div, dot, mul, mul_div};

/// The velocities of a body: x, y and w.
pub(crate) type Speed = [i64; 3];

/// The bound of speeds, 8192 m/s over 2^k: who reaches it is named.
pub(crate) const LIMIT: i64 = 1 << 61;
/// How often contacts are gone through at most, if one is elastic until no impulse changes any more; else until none does
/// by more than a 2²⁶th of the fastest approach: what is left then is met again.
const ROUNDS: [u32; 2] = [32, 256];
/// C_R = 1, Q48.
pub(crate) const ONE: i64 = 1 << 48;

fn bounded(v: i64) -> i64 {
    v.clamp(-LIMIT, LIMIT)
}

/// A direction at a point, as levers on both bodies.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// The direction, Q30.
    along: [i64; 2],
    /// α of a and of b.
    arm: [i64; 2],
    /// p·τ·α of a and of b.
    turn: [i64; 2],
    /// What an impulse of it adds to its own speed, κ, and 1/κ, Q62.
    kappa: i64,
    inverse: i64,
    /// The speed that it is to have.
    target: i64,
    /// The impulse, accumulated.
    impulse: i64,
}

impl Row {
    /// The speed of a against b.
    fn speed(&self, a: &Speed, b: &Speed) -> i64 {
        let between = [a[0].saturating_sub(b[0]), a[1].saturating_sub(b[1])];
        let turning = mul(self.arm[0], a[2], 48).saturating_sub(mul(self.arm[1], b[2], 48));
        dot(between, self.along, 30).saturating_add(turning)
    }

    /// What an impulse of another row of the contact adds to the speed of this one by turning.
    fn turned_by(&self, other: &Row) -> i64 {
        mul(self.arm[0], other.turn[0], 48).saturating_add(mul(self.arm[1], other.turn[1], 48))
    }
}

/// A contact at the time of its impact.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strike {
    /// Places of a and b among the speeds.
    pub(crate) bodies: [usize; 2],
    share: [i64; 2],
    count: usize,
    /// From a's centre to the points, Q32.
    arms: [[i64; 2]; 2],
    points: [Row; 2],
    /// Of bodies that go on as one: at a second point, along the normal and across.
    brace: Option<[Row; 2]>,
    /// At the first point, along the normal turned counter-clockwise: both points slide alike.
    friction: Row,
    /// μ, Q48.
    rough: i64,
    /// What an impulse at one point adds to the speed of the other, Q48.
    couple: i64,
    /// Of the matrix that takes impulses at both points to their speeds; none where a single point says all.
    determinant: Option<i128>,
}

impl Strike {
    /// From a manifold whose points touch; `between`: from a's centre to b's, Q32.
    pub(crate) fn new(
        bodies: [usize; 2],
        manifold: &Manifold,
        between: [i64; 2],
        mobility: [&Mobility; 2],
        friction: i64,
        joined: bool,
    ) -> Strike {
        let [first, second] = [mobility[0].part(mobility[1]), mobility[1].part(mobility[0])];
        let mut strike = Strike {
            bodies,
            share: [first, second],
            count: manifold.count as usize,
            arms: [0, 1].map(|at: usize| manifold.points[at].arm),
            rough: friction,
            ..Strike::default()
        };
        let n = manifold.normal.map(i64::from);
        let t = [n[1].saturating_neg(), n[0]];
        let row = |along: [i64; 2], arm: [i64; 2]| {
            let from_b = [arm[0].saturating_sub(between[0]), arm[1].saturating_sub(between[1])];
            let arm = [(arm, 0), (from_b, 1)].map(|(r, body): ([i64; 2], usize)| {
                // r × direction, Q32, over σ.
                let lever = crate::num::cross(r, along, 30);
                if mobility[body].fixed { 0 } else { mobility[body].over_sigma(lever, 32, 48) }
            });
            let turn = [0, 1].map(|body: usize| {
                let lever = mul(strike.share[body], mobility[body].tau_fine, 48);
                mul(lever, arm[body], 48)
            });
            let line = strike.share[0].saturating_add(strike.share[1]);
            let mut row = Row { along, arm, turn, ..Row::default() };
            row.kappa = line.saturating_add(row.turned_by(&row));
            row.inverse = div(1 << 110, row.kappa.into()) as i64;
            row
        };
        let points = [0, 1].map(|at: usize| row(n, manifold.points[at].arm));
        (strike.points, strike.friction) = (points, row(t, manifold.points[0].arm));
        if joined {
            // Held at the point and at the centre of one that moves, they neither slide nor turn against each other.
            let second = if mobility[0].moves() { [0; 2] } else { between };
            (strike.brace, strike.count, strike.rough) = (Some([row(n, second), row(t, second)]), 1, 0);
        }
        let line = strike.share[0].saturating_add(strike.share[1]);
        strike.couple = line.saturating_add(strike.points[0].turned_by(&strike.points[1]));
        strike.determinant = strike.determinant();
        strike
    }

    /// The determinant of the two points' matrix, Q96; none for one point, or if its rows say nearly the same.
    fn determinant(&self) -> Option<i128> {
        if self.count < 2 {
            return None;
        }
        let [a, b] = self.points.map(|row| row.kappa);
        let determinant = product(a, b).saturating_sub(product(self.couple, self.couple));
        (determinant > product(a, b) >> 30).then_some(determinant)
    }

    /// The fastest approach of its points, not positive.
    pub(crate) fn approach(&self, speeds: &[Speed]) -> i64 {
        let [a, b] = self.bodies.map(|at| speeds[at]);
        self.points[..self.count].iter().map(|row| row.speed(&a, &b)).min().unwrap_or(0).min(0)
    }

    /// Sets the speeds with which the points are to separate: C_R (Q48) times those with which they approach.
    ///
    /// Of two points of which one parts, that one takes no part in a bounce: what the other does to it would be an impulse
    /// along a speed, and add energy. Nor does the slower of two that are nearly one, whose speeds an impulse would have
    /// to match both. If it closes then, it is met again.
    pub(crate) fn aim(&mut self, speeds: &[Speed], restitution: i64) {
        let [a, b] = self.bodies.map(|at| speeds[at]);
        let apart = [0, 1].map(|at: usize| self.points[at].speed(&a, &b));
        let differ = (apart[0] >= 0) != (apart[1] >= 0) || self.determinant.is_none();
        if restitution > 0 && self.count == 2 && differ {
            if apart[0] > apart[1] {
                self.points.swap(0, 1);
                self.arms.swap(0, 1);
            }
            (self.count, self.determinant) = (1, None);
        }
        for row in &mut self.points {
            row.target = mul(row.speed(&a, &b).min(0), restitution, 48).saturating_neg();
        }
    }

    /// Whether its bodies go on as one.
    pub(crate) fn is_joined(&self) -> bool {
        self.brace.is_some()
    }

    /// How fast its points separate, the fastest of them.
    pub(crate) fn parting(&self, speeds: &[Speed]) -> i64 {
        let [a, b] = self.bodies.map(|at| speeds[at]);
        self.points[..self.count].iter().map(|row| row.speed(&a, &b)).max().unwrap_or(0)
    }

    /// The direction from b to a, Q30.
    pub(crate) fn normal(&self) -> [i32; 2] {
        self.points[0].along.map(|n| n as i32)
    }

    /// The point at which one impulse would do what those of both points do; `from`: a's centre.
    pub(crate) fn center(&self, from: [i64; 2]) -> Vec2<Length> {
        let [first, second] = [0, 1].map(|at: usize| i128::from(self.points[at].impulse));
        let at = [0, 1].map(|axis: usize| {
            let [p, q] = self.arms.map(|arm| i128::from(arm[axis]));
            let part = div(q.saturating_sub(p).saturating_mul(second), first.saturating_add(second)) as i64;
            Length::from_bits(from[axis].saturating_add(self.arms[0][axis]).saturating_add(part))
        });
        Vec2::new(at[0], at[1])
    }

    /// What a gets, from the masses of both bodies: λ = μ·p·m, of the body whose share p is greater.
    pub(crate) fn impulse_on_a(&self, masses: [Mass; 2], shift: u32) -> Vec2<Impulse> {
        let heavy = usize::from(self.share[1] > self.share[0]);
        let [mut load, mut slide] = self.impulse();
        if let Some([along, across]) = &self.brace {
            (load, slide) = (load.saturating_add(along.impulse), slide.saturating_add(across.impulse));
        }
        let [n, t] = [self.points[0].along, self.friction.along];
        let along = |axis: usize| {
            let speed = dot([load, slide], [n[axis], t[axis]], 30);
            let part = i128::from(mul(speed, self.share[heavy], 48)) << shift;
            let bits = mul_div(part, masses[heavy].to_bits(), 1 << 48);
            Impulse::from_bits(bits.clamp(Impulse::MIN.to_bits(), Impulse::MAX.to_bits()))
        };
        Vec2::new(along(0), along(1))
    }

    /// The impulse of both points along the normal, and that of friction.
    pub(crate) fn impulse(&self) -> [i64; 2] {
        [self.points[0].impulse.saturating_add(self.points[1].impulse), self.friction.impulse]
    }

    /// Takes friction out.
    pub(crate) fn smooth(&mut self) {
        self.rough = 0;
    }

    fn forget(&mut self) {
        self.friction.impulse = 0;
        self.points.iter_mut().chain(self.brace.iter_mut().flatten()).for_each(|row| row.impulse = 0);
    }
}

/// Q96 from two of Q48.
fn product(a: i64, b: i64) -> i128 {
    i128::from(a).saturating_mul(b.into())
}

/// The quotient of two numbers in Q96, Q48. Both are shortened by what does not fit: the divisor has 66 bits at least, so
/// it keeps 44, and what is wrong by that the next round sees.
fn over(value: i128, by: i128) -> i64 {
    let up = value.unsigned_abs().leading_zeros().saturating_sub(1).min(48);
    crate::num::clamp_i64(div(value << up, by >> 48u32.saturating_sub(up)))
}

/// An impulse of a row to both bodies.
fn give(bodies: [usize; 2], share: [i64; 2], row: &Row, impulse: i64, speeds: &mut [Speed]) {
    if impulse == 0 {
        return;
    }
    for (body, sign) in [(0, 1), (1, -1i64)] {
        let speed = &mut speeds[bodies[body]];
        let impulse = impulse.saturating_mul(sign);
        let line = mul(impulse, share[body], 48);
        for (v, along) in speed.iter_mut().zip(row.along) {
            *v = bounded(v.saturating_add(mul(line, along, 30)));
        }
        speed[2] = bounded(speed[2].saturating_add(mul(impulse, row.turn[body], 48)));
    }
}

/// Solves the contacts, in their order, until no impulse changes any more. `restitutions`: C_R of each, Q48; `weights`: of
/// the bodies, by their places.
///
/// No impulse pulls, friction stays within Coulomb's cone, and energy does not grow: Newton's rule with friction can add
/// energy (Kane 1984), and so can several contacts of which some bounce. Then, and where elastic contacts that say nearly
/// the same do not come to an end, the fastest is answered alone, as the others meet again; if need be without
/// restitution, and at last without friction, which takes energy whatever the contacts.
pub(crate) fn solve(
    strikes: &mut [Strike],
    restitutions: &[i64],
    weights: &[Weight],
    speeds: &mut [Speed],
    before: &mut Vec<Speed>,
) {
    before.clear();
    before.extend_from_slice(speeds);
    let elastic = restitutions.iter().any(|&restitution| restitution >= ONE);
    let approach = strikes.iter().map(|strike| strike.approach(speeds));
    let (fastest, approach) = approach.enumerate().min_by_key(|&(_, approach)| approach).unwrap_or((0, 0));
    let enough = if elastic { 1 } else { (approach.saturating_neg() >> 26).max(1) };
    for attempt in 0..4 {
        let alone = attempt == 1 || strikes.len() < 2;
        if attempt == 1 && strikes.len() < 2 {
            continue;
        }
        for (strike, &restitution) in strikes.iter_mut().zip(restitutions) {
            strike.forget();
            strike.aim(before, if attempt < 2 { restitution } else { 0 });
            strike.rough = if attempt < 3 { strike.rough } else { 0 };
        }
        let some = if alone { &mut strikes[fastest..=fastest] } else { &mut *strikes };
        let ended = rounds(some, speeds, enough, ROUNDS[usize::from(elastic)]);
        if (ended || alone || !elastic) && !gains(weights, before, speeds) {
            return;
        }
        if attempt < 3 {
            speeds.copy_from_slice(before);
        }
    }
}

/// What a body's speeds weigh: mass = mantissa·2^exponent, and what that of w weighs of it, Q48. Without a mantissa it is
/// not moved by impulses.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Weight {
    pub(crate) mantissa: i64,
    pub(crate) exponent: u32,
    pub(crate) turning: i128,
}

/// Whether impulses add to the energy of the bodies, beyond what rounding does. One that is moved by nothing and moves
/// itself may do work.
///
/// Range: squares of speeds are Q48 and below 2⁷⁶, times a mantissa of 34 bits. A body that is hard to turn has a `turning`
/// of up to 96 bits, but then w changes by as much less: by p·τ·α·j, so that both are below 2¹²⁷ together.
fn gains(weights: &[Weight], before: &[Speed], after: &[Speed]) -> bool {
    let top = weights.iter().map(|weight| weight.exponent).max().unwrap_or(0);
    let mut gain = 0i128;
    for ((weight, before), after) in weights.iter().zip(before).zip(after) {
        if weight.mantissa == 0 && *before != [0; 3] {
            return false;
        }
        let grown = |axis: usize| {
            let [b, a] = [before[axis], after[axis]].map(i128::from);
            let rounding = b.saturating_abs().saturating_add(a.saturating_abs()) >> 38;
            (a.saturating_sub(b).saturating_mul(a.saturating_add(b)) >> 48).saturating_sub(rounding).saturating_sub(1)
        };
        let turning = grown(2).saturating_mul(weight.turning) >> 48;
        let sum = grown(0).saturating_add(grown(1)).saturating_add(turning);
        let part = sum.saturating_mul(weight.mantissa.into());
        gain = gain.saturating_add(part >> top.saturating_sub(weight.exponent).min(120));
    }
    gain > 0
}

/// Goes through contacts until no impulse changes by more than `enough`; false if that takes more rounds than `most`.
fn rounds(strikes: &mut [Strike], speeds: &mut [Speed], enough: i64, most: u32) -> bool {
    (0..most).any(|_| strikes.iter_mut().map(|strike| strike.sweep(speeds, enough)).fold(0, i64::max) <= enough)
}
