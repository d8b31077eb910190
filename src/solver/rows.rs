//! The rows of contacts, eight contacts side by side: the scalar definition of what a sweep does.
//!
//! A contact has a row for friction and one for each point. They are solved in its own frame: bodies are read once, a
//! row's impulse changes the speeds of the rows after it through coefficients that preparation has made, and what the
//! bodies gain goes back to them once, at the contact's end. So the rows wait for little of each other's arithmetic.

use super::mover::Mover;
use super::scales::{SLOP, Scales};
use crate::contact::Contact;
use crate::num::lane::{self, add, mul, sub};

/// Contacts side by side.
pub(crate) const LANES: usize = 8;
/// The speed from which on a row is said to push: 1/64 m/s, 50 fraction bits, as a bias.
pub(super) const PUSHES: i64 = -(1 << 44);
/// The impulse from which on a row is said to bear a load: 1/128 m/s, Q20.
pub(super) const LOAD: i64 = 1 << 13;
/// The change of an impulse from which on it is a blow: 1/64 m/s, Q20.
pub(super) const BLOW: i64 = 1 << 14;
/// How often a blow goes round.
pub(super) const ROUNDS: u32 = 8;
/// The greatest impulse λ̂: 512 m/s.
pub(super) const IMPULSE_MAX: i64 = 1 << 29;
pub(super) type Lane = [i32; LANES];

/// One direction at one point. Formats as in [`lane`]: coefficients Q28, `impulse` Q20.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Row {
    /// α_a and α_b.
    pub(crate) arm: [Lane; 2],
    /// 1/κ.
    pub(crate) line: Lane,
    /// p·τ·α/κ of a and of b.
    pub(crate) turn: [Lane; 2],
    /// λ̂, accumulated.
    pub(crate) impulse: Lane,
}

/// Eight contacts of which no two share a body that moves. A lane without a contact has the same body twice. A second
/// point that a contact does not have has coefficients of zero and a separation that never closes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Places among the movers.
    pub(crate) bodies: [[u32; LANES]; 2],
    /// The normal from b to a, Q28.
    pub(crate) normal: [Lane; 2],
    /// p·n of a, and −p·n of b, Q28.
    pub(crate) reply: [[Lane; 2]; 2],
    /// Both points slide alike, as they lie along the tangent: one row of friction, at the lower one.
    pub(crate) friction: Row,
    pub(crate) points: [Row; 2],
    /// By point, μ·κ_t/κ_n, Q28: what friction may take of each one's load.
    pub(crate) limit: [Lane; 2],
    /// By point, separation when the tick began, Q26.
    pub(crate) separation: [Lane; 2],
    /// By point, the greatest impulse along the normal in this tick.
    pub(crate) peak: [Lane; 2],
    /// What an impulse of friction adds to the speed of the first point, of the second, and what one of the first adds
    /// to that of the second by turning; Q27.
    pub(crate) couple: [Lane; 3],
    /// By contact, from the lowest bit: whether a row pushed an overlap apart in the last sweep, instead of bearing a load.
    pub(crate) pushes: u8,
    /// By contact, from the lowest bit: whether it is heavy, by the impulses of the last tick.
    pub(crate) heavy: u8,
}

/// What the rows of a contact read: speeds along the tangent and along the normal at each point, Q48, and how far the points
/// are from touching, Q26.
pub(super) struct Look {
    pub(super) slip: i64,
    pub(super) speed: [i64; 2],
    pub(super) separation: [i32; 2],
}

impl Default for Block {
    fn default() -> Self {
        const NONE: Lane = [0; LANES];
        Block {
            bodies: [[0; LANES]; 2],
            normal: [NONE; 2],
            reply: [[NONE; 2]; 2],
            friction: Row::default(),
            points: [Row::default(); 2],
            limit: [NONE; 2],
            separation: [[i32::MAX; LANES]; 2],
            peak: [NONE; 2],
            couple: [NONE; 3],
            pushes: 0,
            heavy: 0,
        }
    }
}

impl Block {
    /// Takes the contacts out: lanes keep their coefficients, but nothing reads them.
    pub(crate) fn clear(&mut self) {
        (self.bodies, self.pushes, self.heavy) = ([[0; LANES]; 2], 0, 0);
    }

    /// Takes one contact out.
    pub(crate) fn retire(&mut self, i: usize) {
        (self.bodies[0][i], self.bodies[1][i]) = (0, 0);
    }

    /// Whether a contact has been taken out.
    pub(crate) fn is_retired(&self, i: usize) -> bool {
        self.bodies[0][i] == self.bodies[1][i]
    }

    /// The impulses that a contact carries on.
    pub(crate) fn carried(&self, i: usize) -> Contact {
        let normal = [0, 1].map(|at| self.points[at].carried(i));
        Contact { normal, tangent: self.friction.carried(i), ..Contact::default() }
    }

    /// Has `write` write a contact anew between sweeps, by where its bodies are then. Its impulses are taken back along
    /// the old directions, and those that go on are given along the new ones: warm starting repeats what the rows hold.
    pub(crate) fn renew(&mut self, i: usize, movers: &mut [Mover], write: impl FnOnce(&mut Block)) {
        let given = |block: &Block| [&block.friction, &block.points[0], &block.points[1]].map(|row| row.impulse[i]);
        let peak = [self.peak[0][i], self.peak[1][i]];
        self.give(i, movers, given(self).map(i32::saturating_neg));
        write(self);
        self.give(i, movers, given(self));
        for (at, peak) in peak.into_iter().enumerate() {
            self.peak[at][i] = self.peak[at][i].max(peak);
        }
        self.backdate(i, movers);
    }

    /// Of a contact whose separations are of now: those with which the tick would have begun.
    pub(crate) fn backdate(&mut self, i: usize, movers: &[Mover]) {
        let [a, b] = [0, 1].map(|body: usize| &movers[self.bodies[body][i] as usize]);
        for at in 0..2 {
            let separation = self.separation[at][i];
            if separation < i32::MAX {
                self.separation[at][i] = lane::limit(sub(separation.into(), self.moved(i, at, a, b)));
            }
        }
    }

    /// A free lane in which a contact of these bodies shares none that moves; `free`: by place, what does not.
    pub(crate) fn vacancy(&self, places: [u32; 2], free: &[bool]) -> Option<usize> {
        let shares = |place: &u32| places.contains(place) && !free[*place as usize];
        if self.bodies.as_flattened().iter().any(shares) {
            return None;
        }
        (0..LANES).find(|&i| self.is_retired(i))
    }

    /// One sweep over the contacts whose bits are set: friction first, then the normals, which must hold. When `BIASED`,
    /// overlaps are pushed apart through the soft rows; else the rows only stop what approaches.
    #[inline(never)]
    pub(crate) fn solve<const BIASED: bool>(&mut self, lanes: u8, movers: &mut [Mover], scales: &Scales) {
        let (mut blows, mut pushes) = (0, 0);
        for i in (0..LANES).filter(|i| lanes >> i & 1 != 0) {
            let (blow, pushed) = self.contact::<BIASED, true>(i, movers, scales);
            blows |= u8::from(blow) << i;
            pushes |= u8::from(pushed) << i;
        }
        self.pushes = pushes;
        // A blow goes round between the two points until both bear their part of it: a box that lands flat is not to turn in the
        // substep in which it lands. The others share no body with it.
        for _ in 1..ROUNDS {
            if blows == 0 {
                break;
            }
            blows = self.go_round_once::<BIASED>(blows, movers, scales);
        }
    }

    /// Once more the contacts whose bits are set, without friction: which of them took a blow again.
    #[inline(never)]
    pub(super) fn go_round_once<const BIASED: bool>(&mut self, blows: u8, movers: &mut [Mover], scales: &Scales) -> u8 {
        (0..LANES)
            .filter(|i| blows >> i & 1 != 0)
            .fold(0, |again, i| again | u8::from(self.contact::<BIASED, false>(i, movers, scales).0) << i)
    }

    /// What the rows of a contact read.
    #[inline(always)]
    pub(super) fn look(&self, i: usize, movers: &[Mover]) -> Look {
        let (a, b) = (&movers[self.bodies[0][i] as usize], &movers[self.bodies[1][i] as usize]);
        let [nx, ny] = [self.normal[0][i], self.normal[1][i]];
        let v = [0, 1].map(|axis| lane::round::<28>(sub(a.v[axis], b.v[axis])) as i32);
        let w = [lane::round::<28>(a.w) as i32, lane::round::<28>(b.w) as i32];
        let along = add(mul(nx, v[0]), mul(ny, v[1]));
        let across = sub(mul(nx, v[1]), mul(ny, v[0]));
        let turning = |row: &Row, [a, b]: [i32; 2]| sub(mul(row.arm[0][i], a), mul(row.arm[1][i], b));
        Look {
            slip: add(across, turning(&self.friction, w)),
            speed: [0, 1].map(|at| add(along, turning(&self.points[at], w))),
            separation: [0, 1].map(|at| lane::limit(add(self.separation[at][i].into(), self.moved(i, at, a, b)))),
        }
    }

    /// What friction holds at most under these loads.
    #[inline(always)]
    pub(super) fn hold(&self, i: usize, load: [i32; 2]) -> i64 {
        let limit = add(mul(self.limit[0][i], load[0]), mul(self.limit[1][i], load[1]));
        lane::round::<28>(limit).min(IMPULSE_MAX)
    }

    /// Solves one contact, with or without its friction; whether an impulse changed much, and whether a row pushed.
    // Not inlined: in a loop the compiler makes branches of limits and choices that are as good as random.
    #[inline(never)]
    pub(super) fn contact<const BIASED: bool, const FRICTION: bool>(
        &mut self,
        i: usize,
        movers: &mut [Mover],
        scales: &Scales,
    ) -> (bool, bool) {
        let places = [self.bodies[0][i] as usize, self.bodies[1][i] as usize];
        if places[0] == places[1] {
            return (false, false);
        }
        let Look { slip, mut speed, separation } = self.look(i, movers);
        let load = [0, 1].map(|at| self.points[at].impulse[i]);

        let mut change = [0; 3];
        if FRICTION {
            let limit = self.hold(i, load);
            let before = i64::from(self.friction.impulse[i]);
            let impulse = lane::clamp(sub(before, lane::round::<28>(slip)), sub(0, limit), limit);
            self.friction.impulse[i] = impulse as i32;
            change[0] = sub(impulse, before) as i32;
            for (speed, couple) in speed.iter_mut().zip(&self.couple) {
                *speed = lane::coupled(*speed, couple[i], change[0]);
            }
        }
        let (first, pushes_first) = scales.answer::<BIASED>(speed[0], load[0], separation[0]);
        change[1] = sub(first.into(), load[0].into()) as i32;
        speed[1] = lane::coupled(speed[1], self.couple[2][i], change[1]);
        speed[1] = add(speed[1], mul(self.points[0].line[i], change[1]));
        let (second, pushes_second) = scales.answer::<BIASED>(speed[1], load[1], separation[1]);
        change[2] = sub(second.into(), load[1].into()) as i32;
        for (at, impulse) in [first, second].into_iter().enumerate() {
            self.points[at].impulse[i] = impulse;
            self.peak[at][i] = self.peak[at][i].max(impulse);
        }
        if change != [0; 3] {
            self.give(i, movers, change);
        }
        (change[1].abs().max(change[2].abs()) >= BLOW as i32, pushes_first | pushes_second)
    }

    /// How much farther apart a point is than when the tick began, by its direction and arms: Q26.
    #[inline(always)]
    fn moved(&self, i: usize, at: usize, a: &Mover, b: &Mover) -> i64 {
        let d = [0, 1].map(|axis| sub(a.d[axis].into(), b.d[axis].into()));
        let apart = add(lane::times(self.normal[0][i], d[0]), lane::times(self.normal[1][i], d[1]));
        let arm = &self.points[at].arm;
        lane::round::<28>(add(apart, sub(mul(arm[0][i], a.phi as i32), mul(arm[1][i], b.phi as i32))))
    }

    /// What the last tick's impulses do to the bodies.
    pub(crate) fn warm_start(&self, movers: &mut [Mover]) {
        for i in 0..LANES {
            if self.bodies[0][i] != self.bodies[1][i] {
                self.give(i, movers, [&self.friction, &self.points[0], &self.points[1]].map(|row| row.impulse[i]));
            }
        }
    }

    /// Whether a contact bears a load, or the friction of one that it bore a substep ago: taken out now, that would act on
    /// for the rest of the tick.
    pub(crate) fn bears(&self, i: usize) -> bool {
        [&self.friction, &self.points[0], &self.points[1]].iter().any(|row| row.impulse[i] != 0)
    }

    /// Whether a contact pushed in this tick.
    pub(crate) fn spent(&self, i: usize) -> bool {
        self.peak[0][i] > 0 || self.peak[1][i] > 0
    }

    /// Changes of the impulses of friction and of both points, to the bodies.
    #[inline(always)]
    pub(super) fn give(&self, i: usize, movers: &mut [Mover], change: [i32; 3]) {
        let [slide, first, second] = change;
        let (f, [p, q]) = (&self.friction, &self.points);
        // Rounded once to what rows read: a change that no row could see waits for the next tick's warm start. Products of
        // 32 bits then, and bodies of equal mass get the same bits.
        let push = lane::round::<28>(add(mul(p.line[i], first), mul(q.line[i], second))) as i32;
        let drag = lane::round::<28>(mul(f.line[i], slide)) as i32;
        for (body, sign) in [(0, 1), (1, -1)] {
            let [x, y] = [self.reply[body][0][i], self.reply[body][1][i]];
            let mover = &mut movers[self.bodies[body][i] as usize];
            let turn = add(mul(p.turn[body][i], first), mul(q.turn[body][i], second));
            let turn = add(mul(f.turn[body][i], slide), turn);
            [mover.v[0], mover.v[1], mover.w] = lane::held([
                add(mover.v[0], sub(mul(x, push), mul(y, drag))),
                add(mover.v[1], add(mul(y, push), mul(x, drag))),
                if sign > 0 { add(mover.w, turn) } else { sub(mover.w, turn) },
            ]);
        }
    }
}

impl Scales {
    /// How fast an overlap opens at most, times the mass scale: Q50.
    #[inline(always)]
    pub(super) fn least_opens(&self) -> i64 {
        mul(self.soft[0], self.push as i32)
    }

    /// The impulse with which a point answers its speed (Q48), and whether that pushes an overlap apart.
    #[inline(always)]
    fn answer<const BIASED: bool>(&self, speed: i64, load: i32, separation: i32) -> (i32, bool) {
        let speed = lane::round::<28>(speed);
        let impulse = i64::from(load);
        let gap = separation > 0;
        if !BIASED {
            // What approaches is stopped; what is not there yet is left alone.
            let speed = if gap && speed < 0 { 0 } else { speed };
            return (lane::clamp(sub(impulse, speed), 0, IMPULSE_MAX) as i32, false);
        }
        // A gap may close in the substep, an overlap beyond the slop is to open.
        let (way, rate) =
            if gap { (separation, self.close_rate) } else { (lane::deeper(separation, SLOP), self.push_rate) };
        let bias = lane::limit(mul(way, rate) >> 20).min((1 << 30) - 1);
        let [mass, give] = if gap { [1 << 30, 0] } else { self.soft };
        // The greater the load, the less it yields. What is left of the bias opens the overlap, and not too fast.
        let opens = add(mul(mass, bias), mul(give, lane::eased(load, self.firm)));
        let answer = add(mul(mass, lane::limit(speed)), opens.max(self.least_opens()));
        // The speed with which the row would open if nothing opposed it; or there is hardly a load at all.
        let pushes = bias < 0 && (opens < PUSHES || impulse < LOAD);
        (lane::clamp(sub(impulse, lane::round::<30>(answer)), 0, IMPULSE_MAX) as i32, pushes)
    }
}
