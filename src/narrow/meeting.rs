//! When two moving outlines first touch within a tick: conservative advancement of second order.
//!
//! Along an axis (an edge's normal, which turns with its outline, or with a circle the fixed direction from its centre
//! to the nearest vertex or centre) the separation is the least height of the other outline's vertices. `course` bounds
//! each height from below by a quadratic in time, so the axis separates until the first of these is 0. One axis is
//! enough: the latest of these times is a step within which nothing touches. Where nothing turns the quadratics are the
//! heights themselves, and the step is exact.
//!
//! Sources: Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems" (1996), for conservative advancement;
//! Ericson, "Real-Time Collision Detection" 5.5, for separating axes that move.
//!
//! Turned by half a turn, or with a and b exchanged, a pair has the same times bit by bit, with one exception: two
//! circles that turn about points beside their centres, exchanged, by a few units.

use super::clearance::Clearance;
use super::course::{Course, Line, NEVER, bound};
use super::inner;
use super::moment::{Axes, Moment, way};
use crate::geom::Rot;
use crate::num::{Angle, TURN_PER_RADIAN_Q64, mul};
use crate::shape::{Outline, Placed};

/// 1e-7 m, Q38: outlines no farther apart than this touch. Where one reaches farther than 4 m it is 1e-7 of a quarter
/// of that, for the rounding of what is turned grows with it.
const TOUCH: i64 = 430 << 6;
/// 1e-5 m, Q38: that is touching for a pair that has not come to an end in [`PATIENCE`] rounds.
pub(super) const NEAR: i64 = 42_950 << 6;
const PATIENCE: u32 = 40;
/// After so many rounds the present time is the answer, whatever is seen: an impact too many, but nothing is passed.
/// Usual are one to three, a needle of 2 m at 400 rad/s takes up to nine; what turns by a hundred radians in a tick
/// close to another may come here, after 100 µs.
const ROUNDS: u32 = 256;

/// How two bodies move against each other; times are parts of a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    /// From a's centre of mass to b's at time 0, Q32 m.
    pub(crate) d: [i64; 2],
    /// The velocity of b minus that of a at time 0, Q40 m per tick.
    pub(crate) v: [i64; 2],
    /// Their accelerations, likewise, Q40 m per tick².
    pub(crate) a: [i64; 2],
    /// Angles of a and of b at time 0, Q48 turns.
    pub(crate) angle: [i64; 2],
    /// Angular velocities of a and b at time 0, Q40 radians per tick.
    pub(crate) omega: [i64; 2],
    /// Angular accelerations, Q40 radians per tick².
    pub(crate) alpha: [i64; 2],
}

/// The first time τ in 0 ..= until (Q32 of a tick, until ≤ 2³²) at which the outlines are no farther apart than
/// [`TOUCH`] and close faster than `closing` (Q40 m per tick, ≥ 0) along every axis that separates them or overlaps by
/// no more than `slack` (Q32 m, ≥ 0, or [`TOUCH`] if that is more), but for the sides that are behind the widest one; none if
/// there is none.
///
/// * It is never late: until then they are no deeper in each other than rounding (2⁻³² m, 2⁻²⁸ of their reach, and what
///   they move in 2⁻³² of a tick), or half of [`TOUCH`] where they touched before without closing. Coming from farther
///   apart it is a time at which they are between [`TOUCH`] and 0 apart, 0 (up to rounding) where polygons do not turn.
/// * Deeper than that along every axis, be it at time 0 or because they closed too slowly to count, they touch no more.
/// * A pair that stays undecided for [`PATIENCE`] rounds touches at [`NEAR`]; see [`ROUNDS`].
///
/// `clearance` is told how far apart they are when that is looked at first.
///
/// Range: vertices to 39 100 m; speeds to 8192 m and 4096 rad a tick, limited beyond; rims to 2184 m a tick, far beyond
/// which times may be late. Without allocation; 6 ns where boxes around the ways are apart, 0.2 µs where discs are,
/// else 0.3 µs to 0.6 µs a round.
pub(crate) fn first_touch(
    a: &Outline,
    b: &Outline,
    motion: &Motion,
    until: i64,
    closing: i64,
    slack: i64,
    clearance: &mut Clearance,
) -> Option<i64> {
    let until = until.clamp(0, 1 << 32);
    let reach = a.reach.saturating_add(b.reach);
    let motion = motion.limited();
    let apart = |axis: usize| {
        let [d, v, a] = [motion.d[axis], motion.v[axis], motion.a[axis]].map(i64::saturating_abs);
        let far = mul(v, until, 40).saturating_add(mul(a, until, 41)).saturating_add(2);
        d.saturating_sub(far) > reach
    };
    if apart(0) || apart(1) {
        return None;
    }
    let touch = mul(TOUCH, a.reach.max(b.reach).max(4 << 32), 34);
    let mut terms = Terms { touch, tolerance: touch, closing, slack: slack.clamp(0, 1 << 40).wrapping_shl(6) };
    let path = Path::new([a, b], &motion, until);
    let mut time = path.before([a, b], touch, clearance)?;
    let mut moment = path.at([a, b], time);
    for round in 0..ROUNDS {
        if round == PATIENCE {
            terms.tolerance = terms.tolerance.max(NEAR);
        }
        let mut axes = moment.axes();
        let (widest, separation) = moment.separation(&mut axes);
        if round == 0 {
            *clearance = Clearance::new(&moment, &axes, widest, path.angles(time), path.arms);
        }
        match moment.look(&mut axes, widest, separation, &terms) {
            Look::Touch => break,
            Look::Never => return None,
            // Less than a unit of time away.
            Look::Apart(separation, 0) => terms.tolerance = separation,
            Look::Apart(_, step) | Look::Held(step) => {
                time = time.saturating_add(step);
                path.go([a, b], time, &mut moment);
            }
        }
    }
    Some(time)
}

impl Motion {
    /// A bound of the speed of points of outlines of these reaches against each other, for the time 0 ..= until; Q40 m per
    /// tick.
    pub(crate) fn fastest(&self, reach: [i64; 2], until: i64) -> i64 {
        let line = bound(self.v).saturating_add(mul(bound(self.a), until, 32));
        let rim = |body: usize| {
            let spin = self.omega[body].saturating_abs();
            let spin = spin.saturating_add(mul(self.alpha[body].saturating_abs(), until, 32));
            mul(spin, reach[body], 32).saturating_add(1)
        };
        line.saturating_add(rim(0)).saturating_add(rim(1)).saturating_add(1)
    }

    /// In limits within which nothing wraps: 8192 m and 4096 rad a tick, and as much a tick².
    fn limited(mut self) -> Motion {
        let limit = |rate: &mut i64, most: i64| *rate = (*rate).clamp(most.wrapping_neg(), most);
        for at in 0..2 {
            limit(&mut self.v[at], 1 << 53);
            limit(&mut self.a[at], 1 << 53);
            limit(&mut self.omega[at], 1 << 52);
            limit(&mut self.alpha[at], 1 << 52);
        }
        self
    }
}

/// What a moment is judged by. Q38 m but for `closing`.
#[derive(Clone, Copy)]
struct Terms {
    /// How near touching is, by the sizes alone.
    touch: i64,
    /// How near it is now: more where time or patience is too short.
    tolerance: i64,
    closing: i64,
    slack: i64,
}

/// What a moment shows.
enum Look {
    /// They touch and close.
    Touch,
    /// They do not in the time there is, or overlap already.
    Never,
    /// So far apart, Q38 m, and so long before they may touch.
    Apart(i64, i64),
    /// They touch, but for so long at least not all axes close.
    Held(i64),
}

/// A motion, and what of it does not change.
pub(super) struct Path {
    pub(super) motion: Motion,
    pub(super) until: i64,
    /// Angular velocities and accelerations in turns, Q48.
    turns: [[i64; 2]; 2],
    /// How far a point that turns is from its body's centre at most, Q32 m; a circle's centre is what turns of it.
    pub(super) arms: [i64; 2],
    /// Whether turning changes anything.
    turning: [bool; 2],
}

impl Path {
    /// Of a motion in its limits.
    fn new(outlines: [&Outline; 2], motion: &Motion, until: i64) -> Path {
        let mut motion = *motion;
        let arms = outlines.map(|outline| outline.reach.saturating_sub(outline.radius));
        for (body, &arm) in arms.iter().enumerate() {
            // A circle about its centre of mass does not turn for anyone.
            if arm <= 0 {
                (motion.omega[body], motion.alpha[body]) = (0, 0);
            }
        }
        let turn = |rate: i64| mul(rate, TURN_PER_RADIAN_Q64 as i64, 64 + 40 - 48);
        let turns = [motion.omega.map(turn), motion.alpha.map(turn)];
        let turning = [0, 1].map(|body| (motion.omega[body] | motion.alpha[body]) != 0);
        Path { motion, until, turns, arms, turning }
    }

    /// The angles at a time, Q48 turns.
    fn angles(&self, time: i64) -> [i64; 2] {
        let turned = |body: usize| way(self.turns[0][body], self.turns[1][body], time, 32);
        [0, 1].map(|body| self.motion.angle[body].wrapping_add(turned(body)))
    }

    /// A body's outline at a time.
    fn placed(&self, outline: &Outline, body: usize, time: i64) -> Placed {
        Placed::new(outline, Rot::new(Angle::from_bits(self.angles(time)[body])))
    }

    /// A time before which they cannot touch, found from the discs in which outlines turn; none if they never can.
    fn before(&self, outlines: [&Outline; 2], touch: i64, clearance: &mut Clearance) -> Option<i64> {
        let mut time = 0_i64;
        let reach = i128::from(outlines[0].reach.saturating_add(outlines[1].reach));
        let overlap = || inner(self.motion.d, self.motion.d) <= reach.wrapping_mul(reach);
        if self.turning == [false; 2] || self.turning == [true; 2] && overlap() {
            return Some(time);
        }
        let disc = |body: usize| Placed { count: 1, radius: outlines[body].reach, ..Placed::default() };
        let hull = |body: usize| if self.turning[body] { disc(body) } else { self.placed(outlines[body], body, 0) };
        let mut moment = Moment { placed: [hull(0), hull(1)], ..Moment::new(self) };
        for _ in 0..2 {
            moment.set(self, time);
            let mut axes = moment.axes();
            let (widest, separation) = moment.separation(&mut axes);
            if separation <= touch {
                break;
            }
            match moment.advance(&mut axes, separation) {
                NEVER => {
                    // A disc is the same however it turns.
                    let arms = [0, 1].map(|body: usize| if self.turning[body] { 0 } else { self.arms[body] });
                    *clearance = Clearance::new(&moment, &axes, widest, self.angles(time), arms);
                    return None;
                }
                step => time = time.saturating_add(step),
            }
        }
        Some(time)
    }

    /// The bodies at a time.
    fn at(&self, outlines: [&Outline; 2], time: i64) -> Moment {
        let mut moment = Moment { turning: self.turning, ..Moment::new(self) };
        for (body, outline) in outlines.into_iter().enumerate() {
            moment.placed[body] = self.placed(outline, body, time);
        }
        moment.set(self, time);
        moment
    }

    /// On to a time: what turns is placed anew.
    fn go(&self, outlines: [&Outline; 2], time: i64, moment: &mut Moment) {
        for (body, outline) in outlines.into_iter().enumerate() {
            if self.turning[body] {
                moment.placed[body] = self.placed(outline, body, time);
            }
        }
        moment.set(self, time);
    }
}

impl Moment {
    /// How long they cannot touch, being apart. Axes of much less separation than the greatest are left out.
    fn advance(&self, axes: &mut Axes, separation: i64) -> i64 {
        let least = separation.wrapping_mul(5) >> 4;
        let mut step = 0;
        for index in 0..axes.count {
            if self.apart(axes, index, least).is_some() {
                let Some((line, vertices)) = self.line(axes, index) else { continue };
                let mut first = NEVER;
                for &q in vertices {
                    first = first.min(line.course(q).end(self.rest.min(first)));
                }
                step = step.max(first);
            }
        }
        step
    }

    /// Whether they touch and close; if not, how long they cannot.
    fn look(&self, axes: &mut Axes, widest: usize, separation: i64, terms: &Terms) -> Look {
        if separation > terms.tolerance {
            return match self.advance(axes, separation) {
                NEVER => Look::Never,
                step => Look::Apart(separation, step),
            };
        }
        let band = terms.tolerance.max(terms.slack);
        let deep = band.wrapping_neg();
        if separation < deep {
            return Look::Never;
        }
        let toward = self.axis(axes, widest).map_or([0; 2], |axis| axis.outward());
        let mut held = None;
        for index in 0..axes.count {
            if let Some(overlap) = self.apart(axes, index, deep) {
                // The far side of what is thin is no side to leave by.
                let behind = overlap < terms.tolerance.wrapping_neg() && self.is_behind(axes, index, toward);
                if behind {
                    continue;
                }
                let Some((line, vertices)) = self.line(axes, index) else { continue };
                let wait = self.wait(&line, vertices, terms, band);
                held = held.max(wait);
            }
        }
        match held {
            None => Look::Touch,
            Some(step) if step > self.rest => Look::Never,
            Some(step) => Look::Held(step.max(1)),
        }
    }

    /// Whether an axis points against a direction from a to b.
    fn is_behind(&self, axes: &Axes, index: usize, [x, y]: [i64; 2]) -> bool {
        let [u, v] = self.axis(axes, index).map_or([0; 2], |axis| axis.outward());
        x.wrapping_mul(u).wrapping_add(y.wrapping_mul(v)) < 0
    }

    /// How long an axis on which they touch does not close; none if it does.
    fn wait(&self, line: &Line, vertices: &[[i64; 2]], terms: &Terms, band: i64) -> Option<i64> {
        let mut first = NEVER;
        for &q in vertices {
            let course = line.course(q);
            if course.height > terms.tolerance {
                first = first.min(course.end(self.rest.min(first)));
                continue;
            }
            if course.rate < terms.closing.wrapping_neg() {
                return None;
            }
            // Until it may close fast enough, or be so deep that this axis does not count. Half of what touching is
            // deeper does no harm, and gets what hardly moves out of its place.
            let lifted = Course { height: course.height.max(0).wrapping_add(terms.touch >> 1), ..course };
            let sunk = Course { height: course.height.wrapping_add(band), ..course };
            let slow = course.falls(terms.closing).min(sunk.end(self.rest));
            first = first.min(slow.max(lifted.end(self.rest)));
        }
        Some(first)
    }
}
