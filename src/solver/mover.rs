//! Bodies as the rows see them, for one tick: velocities in full, positions as what changed since the tick began.

mod show;
mod store;

use super::flight::{Past, State, rim};
use super::mobility::Mobility;
use super::scales::{SPEED_MAX, Scales};
use super::squeeze::Squeeze;
use crate::body::Bodies;
use crate::motion::{Drive, turn_by};
use crate::num::{Velocity, clamp_i64, div, lane, mul, round_shift};
use crate::threads::Crew;
use core::mem::replace;

/// So many make a piece: 5 µs.
const MOVERS: usize = 512;

/// What rows read and write.
///
/// | field | format | bound |
/// |---|---|---|
/// | `v`, `w` | Q48 m/s over 2^k; w = σ·ω | 2⁵⁷ |
/// | `d`, `phi` | Q26 m over 2^k since the tick began; φ = σ·θ | 2³⁰ |
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Mover {
    // These four are read at once by lanes side by side.
    pub(crate) v: [i64; 2],
    pub(crate) w: i64,
    pub(crate) phi: i64,
    pub(crate) d: [i32; 2],
}

impl Mover {
    /// Puts it where the sum of its velocities brings it.
    fn go(&mut self, sum: &[i64; 3], scales: &Scales) {
        // At most 400 m/s for as many substeps as the tick has, Q20, times h in Q30: below 2⁵⁹; to Q26.
        let way = |sum: i64| lane::round_to::<24>(lane::times(scales.coarse, sum));
        self.d = [way(sum[0]), way(sum[1])];
        self.phi = way(sum[2]).into();
    }
}

/// What else a mover needs from substep to substep. Velocities x, y and w as above.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// At the beginning of the tick, and of the substep.
    start: [i64; 3],
    begin: [i64; 3],
    /// What forces other than contacts add in each substep.
    kick: [i64; 3],
    /// What the bound of speed took away in this substep.
    cut: [i64; 3],
    /// The sum of the velocities read, Q20: the way over h.
    sum: [i64; 3],
    /// The bound of w.
    spin_max: i64,
    slot: u32,
    /// Whether a contact pushed it in this tick.
    hit: bool,
    /// Whether rows have changed its velocity: until then its way is free motion.
    pushed: bool,
    slowed: bool,
}

/// The bodies of this tick's contacts. The first is one that does not move, for all static bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Movers {
    pub(crate) lanes: Vec<Mover>,
    courses: Vec<Course>,
    /// By slot of a body: its place here; 0 for none.
    places: Vec<u32>,
    /// Whether one of them is so fast that rows may send others far from where they would go.
    pub(crate) brisk: bool,
    /// Whether one of them may turn so fast that its rows must be made anew.
    pub(crate) turns: bool,
    /// Whether there are bodies of which it is known what their rows would do.
    pub(crate) others: bool,
    pub(super) squeeze: Squeeze,
}

impl Movers {
    /// Forgets those of the last tick.
    pub(crate) fn clear(&mut self, slots: usize) {
        for course in &self.courses {
            if let Some(place) = self.places.get_mut(course.slot as usize) {
                *place = 0;
            }
        }
        self.places.resize(slots, 0);
        self.lanes.clear();
        self.courses.clear();
        (self.brisk, self.turns, self.others) = (false, false, false);
        self.lanes.push(Mover::default());
        self.courses.push(Course { slot: u32::MAX, ..Course::default() });
    }

    /// The place of the body in a slot; it is taken in at its present velocities.
    pub(crate) fn place(&mut self, slot: u32, bodies: &Bodies, mobility: &Mobility, scales: &Scales) -> u32 {
        let at = slot as usize;
        if self.places[at] != 0 || mobility.fixed {
            return self.places[at];
        }
        self.turns |= bodies.omega.get(at).to_bits().unsigned_abs() >= TURNS;
        self.enter(slot, speeds(bodies, at, mobility, scales), mobility, scales)
    }

    fn enter(&mut self, slot: u32, start: [i64; 3], mobility: &Mobility, scales: &Scales) -> u32 {
        // The rim below the bound of speed, and less than an eighth of a turn in a substep: σ·(π/4)/h.
        let eighth = i128::from(mobility.sigma).saturating_mul(scales.rate.into()).saturating_mul(EIGHTH_TURN);
        let eighth = round_shift(eighth, scales.shift.saturating_add(14));
        let spin_max = eighth.min(mobility.spin.into()) as i64;
        let place = self.lanes.len() as u32;
        let begin = start.map(lane::bounded);
        self.lanes.push(Mover { v: [begin[0], begin[1]], w: begin[2], ..Mover::default() });
        self.courses.push(Course { start, begin, spin_max, slot, ..Course::default() });
        self.places[slot as usize] = place;
        place
    }

    /// Whether rows can follow a body that was at `begin` when the tick began: not one that is too fast for them, or comes from
    /// farther away than half of what their positions hold.
    pub(crate) fn may_join(begin: &State, now: &State, scales: &Scales) -> bool {
        let fast = |v: &i64| v.unsigned_abs() >> scales.shift >= SPEED_MAX.unsigned_abs() << 48;
        let far = |axis: usize| now.x[axis].abs_diff(begin.x[axis]) > 1 << 35u32.saturating_add(scales.shift);
        !(now.v.iter().any(fast) || far(0) || far(1))
    }

    /// Takes a body in that rows did not know so far, at the end of a substep; it is `now` where impacts have brought it from
    /// where the tick began, and `bodies` are where free motion ends.
    pub(crate) fn join(
        &mut self,
        slot: u32,
        [begin, now]: [&State; 2],
        bodies: &Bodies,
        mobility: &Mobility,
        scales: &Scales,
    ) -> u32 {
        let k = scales.shift;
        let speed = |state: &State| {
            let line = |v: i64| round_shift(v.into(), k) as i64;
            [line(state.v[0]), line(state.v[1]), rim(state.omega, mobility, scales)]
        };
        let place = self.enter(slot, speed(begin), mobility, scales);
        let (mover, course) = (&mut self.lanes[place as usize], &mut self.courses[place as usize]);
        course.kick = kick(&course.start, speeds(bodies, slot as usize, mobility, scales), scales);
        // A rim may be as fast as the format goes, and that is beyond what `held` takes.
        let speed = lane::held(speed(now).map(lane::bounded));
        [mover.v[0], mover.v[1], mover.w] = speed;
        course.begin = [0, 1, 2].map(|axis: usize| lane::bounded(speed[axis].saturating_sub(course.kick[axis])));
        // The inverse of `state`: ways over h.
        let over = |way: i64, by: i64, bits: u32| div(i128::from(way) << bits, by.into()) as i64;
        let gone = |axis: usize| over(now.x[axis].saturating_sub(begin.x[axis]), scales.line, 51u32.saturating_sub(k));
        let rolled = mul(now.angle.saturating_sub(begin.angle), mobility.sigma, k.saturating_add(30));
        // A rim may have gone farther than `go` can say, by far: then it stands at the end of what positions hold, and stays there.
        let most = div((1 << 63) - (1 << 60), scales.coarse.into()) as i64;
        let rolled = lane::clamp(over(rolled, scales.turn, 33), most.saturating_neg(), most);
        course.sum = [gone(0), gone(1), rolled];
        (course.pushed, course.hit) = (true, true);
        mover.go(&course.sum, scales);
        place
    }

    /// Before the bodies move: notes whether one of them is, or gets by forces, so fast that rows may send others aside; or one of
    /// `others`, which are at rest.
    pub(crate) fn look_brisk(&mut self, others: impl Iterator<Item = usize>, drive: &Drive, scales: &Scales) {
        let most = scales.aside.unsigned_abs() / 2;
        let gains = |slot: usize| {
            let gain = drive.gain(slot, scales.margins.tick);
            gain.iter().any(|gain| gain.unsigned_abs() >> scales.shift > most)
        };
        let starts = |course: &Course| course.start.iter().any(|speed| speed.unsigned_abs() > most);
        self.brisk = self.courses[1..].iter().any(|course| starts(course) || gains(course.slot as usize));
        self.brisk |= others.into_iter().any(gains);
    }

    /// After the bodies have moved as if nothing touched them: what forces do to them in a substep.
    pub(crate) fn take_kicks(&mut self, bodies: &Bodies, mobilities: &[Mobility], scales: &Scales) {
        for course in &mut self.courses[1..] {
            let slot = course.slot as usize;
            course.kick = kick(&course.start, speeds(bodies, slot, &mobilities[slot], scales), scales);
        }
    }

    /// A substep begins: forces, and the impulses of the last substep once more.
    ///
    /// What contacts did to a body in a substep is the sum of its rows' accumulated impulses, so adding that again is
    /// warm starting, without going through the rows: forces and contacts together did now − begin + cut. In the first
    /// substep the rows have added theirs already.
    pub(crate) fn begin(&mut self, first: bool, crew: Crew) {
        self.each(crew, |mover, course| {
            let now = [mover.v[0], mover.v[1], mover.w];
            let change = if first {
                course.kick
            } else {
                let begin = replace(&mut course.begin, now);
                [0, 1, 2].map(|axis| lane::add(lane::sub(now[axis], begin[axis]), course.cut[axis]))
            };
            [mover.v[0], mover.v[1], mover.w] = lane::held([0, 1, 2].map(|axis| lane::add(now[axis], change[axis])));
        });
    }

    /// Does something to each, whatever the others are.
    #[inline]
    fn each(&mut self, crew: Crew, work: impl Fn(&mut Mover, &mut Course) + Sync) {
        crew.share((&mut self.lanes[1..], &mut self.courses[1..]), MOVERS, |(lanes, courses)| {
            for (mover, course) in lanes.iter_mut().zip(courses) {
                work(mover, course);
            }
        });
    }

    /// Positions by the velocities that rows read, after bounding these.
    pub(crate) fn drift(&mut self, scales: &Scales, crew: Crew) {
        const LIMIT: i64 = SPEED_MAX << 48;
        self.each(crew, |mover, course| {
            let limits = [LIMIT, LIMIT, course.spin_max];
            let now = [mover.v[0], mover.v[1], mover.w];
            let free = |axis: usize| lane::sub(now[axis], course.begin[axis]) == course.kick[axis];
            course.pushed |= !(free(0) && free(1) && free(2));
            let over = |axis: usize| now[axis].unsigned_abs() > limits[axis].unsigned_abs();
            course.cut = [0; 3];
            if over(0) || over(1) || over(2) {
                let kept = [0, 1, 2].map(|axis| lane::clamp(now[axis], limits[axis].saturating_neg(), limits[axis]));
                course.cut = [0, 1, 2].map(|axis| lane::sub(now[axis], kept[axis]));
                course.slowed = true;
                [mover.v[0], mover.v[1], mover.w] = kept;
            }
            for (sum, v) in course.sum.iter_mut().zip([mover.v[0], mover.v[1], mover.w]) {
                *sum = lane::add(*sum, lane::round::<28>(v));
            }
            mover.go(&course.sum, scales);
        });
    }

    /// The place of the body in a slot, 0 if it has none.
    pub(crate) fn place_of(&self, slot: u32) -> u32 {
        self.places.get(slot as usize).copied().unwrap_or(0)
    }

    /// It ends the tick where it began it.
    pub(crate) fn stay(&mut self, place: usize) {
        (self.lanes[place].d, self.lanes[place].phi) = ([0; 2], 0);
    }

    /// Whether rows left it no faster than `least`, Q20, and moved it no faster in the tick; none if that is for free motion to say,
    /// since no contact pushed it.
    pub(crate) fn creeps(&self, place: usize, least: u32, scales: &Scales) -> Option<bool> {
        let (mover, course) = (&self.lanes[place], &self.courses[place]);
        let within = |numbers: [i64; 3], most: u64| numbers.iter().all(|number| number.unsigned_abs() <= most);
        let slow = within([mover.v[0], mover.v[1], mover.w], u64::from(least) << 28);
        let near = || within(course.sum, u64::from(least.saturating_mul(scales.substeps)));
        if slow && !course.hit { None } else { Some(slow && near()) }
    }

    /// The slot of the body at a place other than 0.
    pub(crate) fn slot(&self, place: u32) -> usize {
        self.courses[place as usize].slot as usize
    }

    /// The slots of those that went farther than `way`, Q32 m, along an axis in this tick.
    pub(crate) fn shifted(&self, way: i64, scales: &Scales) -> impl Iterator<Item = usize> {
        let bits = scales.shift.saturating_add(6);
        let far = move |mover: &Mover| mover.d.iter().any(|&d| (i64::from(d) << bits).saturating_abs() > way);
        self.lanes.iter().zip(&self.courses).skip(1).filter(move |&(mover, _)| far(mover)).map(|(_, c)| c.slot as usize)
    }

    /// Whether rows have changed its velocity.
    pub(crate) fn is_pushed(&self, place: u32) -> bool {
        self.courses[place as usize].pushed
    }

    /// Whether rows have changed its velocity since the tick began so much that it may come to where it was not looked for
    /// neighbours.
    pub(crate) fn is_aside(&self, place: u32, scales: &Scales) -> bool {
        let (mover, course) = (&self.lanes[place as usize], &self.courses[place as usize]);
        let off = |axis: usize| mover.v[axis].abs_diff(course.start[axis]) > scales.aside.unsigned_abs();
        course.pushed && (off(0) || off(1))
    }

    /// The slots of such bodies.
    pub(crate) fn turned_aside<'s>(&'s self, scales: &'s Scales) -> impl Iterator<Item = u32> + 's {
        let places = if self.brisk { 1..self.courses.len() } else { 0..0 };
        places.filter(|&place| self.is_aside(place as u32, scales)).map(|place| self.courses[place].slot)
    }

    /// Whether [`Movers::store`] says where it ends; not for 0.
    pub(crate) fn keeps(&self, place: u32) -> bool {
        let course = &self.courses[place as usize];
        place != 0 && (course.hit || course.slowed)
    }

    /// Where it is when the way of this substep, which it has been given, begins, and with which velocities it goes it.
    /// `begin`: where the tick began.
    pub(crate) fn state(&self, place: u32, begin: &State, mobility: &Mobility, scales: &Scales) -> State {
        let (mover, course) = (&self.lanes[place as usize], &self.courses[place as usize]);
        let read = [mover.v[0], mover.v[1], mover.w].map(lane::round::<28>);
        let gone = [0, 1, 2].map(|axis: usize| lane::sub(course.sum[axis], read[axis]));
        Self::gone(gone, read, begin, mobility, scales)
    }

    /// Where it is before it is given the way of the substep that has begun, and with which velocities it will go.
    pub(crate) fn now(&self, place: u32, begin: &State, mobility: &Mobility, scales: &Scales) -> State {
        let (mover, course) = (&self.lanes[place as usize], &self.courses[place as usize]);
        let read = [mover.v[0], mover.v[1], mover.w].map(lane::round::<28>);
        Self::gone(course.sum, read, begin, mobility, scales)
    }

    /// Where a way over h, Q20, brings a body from where the tick began, with velocities as rows read them.
    fn gone(gone: [i64; 3], read: [i64; 3], begin: &State, mobility: &Mobility, scales: &Scales) -> State {
        let k = scales.shift;
        let at = |axis: usize| begin.x[axis].saturating_add(mul(gone[axis], scales.line, 51u32.saturating_sub(k)));
        let turned = mobility.over_sigma(mul(gone[2], scales.turn, 33), 50u32.saturating_sub(k), 48);
        let speed = |axis: usize| clamp_i64(i128::from(read[axis]) << 28u32.saturating_add(k));
        State {
            x: [at(0), at(1)],
            angle: turn_by(begin.angle, turned).0,
            v: [speed(0), speed(1)],
            omega: mobility.over_sigma(read[2], 20u32.saturating_sub(k), 48),
        }
    }

    /// An impact changed its velocities, with a part of the tick `left` (Q32) of the substep whose way it has been given.
    pub(crate) fn strike(&mut self, place: u32, change: [i64; 3], left: i64, scales: &Scales) {
        if place == 0 {
            return;
        }
        self.squeeze.allow(place, change);
        let (mover, course) = (&mut self.lanes[place as usize], &mut self.courses[place as usize]);
        let now = [mover.v[0], mover.v[1], mover.w];
        let then = lane::held([0, 1, 2].map(|axis: usize| now[axis].saturating_add(change[axis])));
        [mover.v[0], mover.v[1], mover.w] = then;
        for axis in 0..3 {
            // Warm starting does not repeat it.
            let change = lane::sub(then[axis], now[axis]);
            course.begin[axis] = lane::bounded(course.begin[axis].saturating_add(change));
            let way = i128::from(change).saturating_mul(left.into()).saturating_mul(scales.substeps.into());
            course.sum[axis] = lane::add(course.sum[axis], round_shift(way, 60) as i64);
        }
        mover.go(&course.sum, scales);
    }

    /// Gives a body other velocities; what its rows do in a substep stays as it is.
    pub(super) fn slow(&mut self, place: u32, kept: [i64; 3]) {
        let (mover, course) = (&mut self.lanes[place as usize], &mut self.courses[place as usize]);
        let now = [mover.v[0], mover.v[1], mover.w];
        [mover.v[0], mover.v[1], mover.w] = kept;
        for axis in 0..3 {
            course.begin[axis] = lane::bounded(lane::add(course.begin[axis], lane::sub(kept[axis], now[axis])));
        }
    }

    /// By place, whether impulses leave it as it is.
    pub(crate) fn yielding(&self, mobilities: &[Mobility], free: &mut Vec<bool>) {
        let place = |course: &Course| mobilities.get(course.slot as usize).is_none_or(|m| !m.moves());
        free.clear();
        free.extend(self.courses.iter().map(place));
    }

    /// Whether rows know of no body.
    pub(crate) fn is_empty(&self) -> bool {
        self.lanes.len() < 2 && !self.others
    }

    /// What rows keep of each, for those that joined.
    pub(crate) fn welcome(
        &self,
        mobilities: &[Mobility],
        past: &Past,
        before: &mut Vec<[i64; 6]>,
        free: &mut Vec<bool>,
    ) {
        for course in self.courses.iter().skip(before.len()) {
            let State { x, angle, v, omega } = past.state(course.slot as usize);
            before.push([x[0], x[1], angle, v[0], v[1], omega]);
            free.push(!mobilities[course.slot as usize].moves());
        }
    }

    /// Notes that a contact pushed these bodies.
    pub(crate) fn hit(&mut self, places: [u32; 2]) {
        for place in places {
            self.courses[place as usize].hit = true;
        }
    }

    /// Position, angle and velocities of each, to go on from.
    pub(crate) fn remember(&self, bodies: &Bodies, before: &mut Vec<[i64; 6]>) {
        let Bodies { cold: _, rest: _, x, y, vx, vy, angle, omega } = bodies;
        let columns = [x.bits(), y.bits(), angle.bits(), vx.bits(), vy.bits(), omega.bits()];
        before.clear();
        before.push([0; 6]);
        before.extend(self.courses[1..].iter().map(|course| columns.map(|column| column[course.slot as usize])));
    }
}

/// A body's velocities as rows have them.
fn speeds(bodies: &Bodies, slot: usize, mobility: &Mobility, scales: &Scales) -> [i64; 3] {
    let (v, omega) = (bodies.velocity(slot), bodies.omega.get(slot));
    let line = |v: Velocity| round_shift(v.to_bits().into(), scales.shift) as i64;
    [line(v.x), line(v.y), rim(omega.to_bits(), mobility, scales)]
}

/// What forces add in a substep, of velocities when the tick begins and when free motion ends.
fn kick(start: &[i64; 3], end: [i64; 3], scales: &Scales) -> [i64; 3] {
    [0, 1, 2].map(|axis| {
        let change = i128::from(end[axis]).saturating_sub(start[axis].into());
        lane::bounded(div(change, scales.substeps.into()) as i64)
    })
}

/// Slower than this nothing turns fast: 1/16 rad/s, Q48.
pub(super) const TURNS: u64 = 1 << 44;
/// π/4 with 30 fraction bits.
const EIGHTH_TURN: i128 = 843_314_857;
