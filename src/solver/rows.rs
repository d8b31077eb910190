//! The rows of contacts, eight contacts side by side: the scalar definition of what a sweep does.
//!
//! A contact is solved in its own frame: the relative velocity of the two centres along the normal and the tangent, and the
//! two w. A row then has two arms and three responses; what the linear velocities gain goes back to the bodies once, at
//! the contact's end.

use super::mover::Mover;
use super::scales::{SLOP, Scales};
use crate::num::lane::{self, add, mul, sub};

/// Contacts side by side.
pub(crate) const LANES: usize = 8;
/// The speed from which on a row is said to push: 1/64 m/s, 50 fraction bits, as a bias.
const PUSHES: i64 = -(1 << 44);
/// The impulse from which on a row is said to bear a load: 1/128 m/s, Q20.
const LOAD: i64 = 1 << 13;
/// The change of an impulse from which on it is a blow: 1/4 m/s, Q20.
const BLOW: i64 = 1 << 18;
/// How often a blow goes round.
const ROUNDS: u32 = 4;
type Lane = [i32; LANES];

/// The greatest impulse λ̂: 512 m/s.
const IMPULSE_MAX: i64 = 1 << 29;

/// One direction at one point. Formats as in [`lane`]: coefficients Q28, `impulse` Q20.
#[derive(Clone, Copy, Debug, Default)]
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

/// The rows of one point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PointRows {
    pub(crate) normal: Row,
    pub(crate) tangent: Row,
    /// Separation when the tick began, Q26.
    pub(crate) separation: Lane,
    /// μ·κ_t/κ_n, Q28.
    pub(crate) friction: Lane,
    /// The greatest impulse along the normal in this tick.
    pub(crate) peak: Lane,
}

/// Eight contacts of which no two share a body that moves. A lane without a contact, and a second point that a contact
/// does not have, have coefficients of zero and a separation that never closes.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Places among the movers.
    pub(crate) bodies: [[u32; LANES]; 2],
    /// The normal from b to a, Q28.
    pub(crate) normal: [Lane; 2],
    /// p·n of a, and −p·n of b, Q28.
    pub(crate) reply: [[Lane; 2]; 2],
    pub(crate) points: [PointRows; 2],
    /// Whether a row pushed an overlap apart in the last sweep, instead of bearing a load.
    pub(crate) pushes: bool,
}

impl Default for Block {
    fn default() -> Self {
        let empty = PointRows { separation: [i32::MAX; LANES], ..PointRows::default() };
        Block {
            bodies: [[0; LANES]; 2],
            normal: [[0; LANES]; 2],
            reply: [[[0; LANES]; 2]; 2],
            points: [empty; 2],
            pushes: false,
        }
    }
}

/// What one contact sees and changes while it is solved.
struct Frame {
    /// The relative velocity along the normal and the tangent, w_a and w_b: Q48.
    line: [i64; 2],
    turn: [i64; 2],
    /// The linear impulse along both so far, Q48.
    push: [i64; 2],
}

impl Frame {
    /// The relative velocity along a row, Q20.
    #[inline(always)]
    fn speed(&self, row: &Row, axis: usize, i: usize) -> i64 {
        let turn_a = mul(row.arm[0][i], lane::read(self.turn[0]));
        let turn_b = mul(row.arm[1][i], lane::read(self.turn[1]));
        lane::round_to::<28>(add(self.line[axis], sub(turn_a, turn_b))).into()
    }

    /// An impulse along a row.
    #[inline(always)]
    fn apply(&mut self, row: &mut Row, axis: usize, i: usize, impulse: i64) {
        let change = sub(impulse, row.impulse[i].into()) as i32;
        row.impulse[i] = impulse as i32;
        let line = mul(row.line[i], change);
        self.line[axis] = add(self.line[axis], line);
        self.push[axis] = add(self.push[axis], line);
        self.turn[0] = add(self.turn[0], mul(row.turn[0][i], change));
        self.turn[1] = sub(self.turn[1], mul(row.turn[1][i], change));
    }
}

impl Block {
    /// One sweep over the block: friction first, then the normals, which must hold. When `BIASED`, overlaps are pushed apart
    /// through the soft rows; else the rows only stop what approaches.
    #[inline(never)]
    pub(crate) fn solve<const BIASED: bool>(&mut self, movers: &mut [Mover], scales: &Scales) {
        let mut pushes = false;
        for i in 0..LANES {
            let places = [self.bodies[0][i] as usize, self.bodies[1][i] as usize];
            if places[0] == places[1] {
                // No contact in this lane.
                continue;
            }
            let (a, b) = (&movers[places[0]], &movers[places[1]]);
            let [nx, ny] = [self.normal[0][i], self.normal[1][i]];
            let v = [lane::read(sub(a.v[0], b.v[0])), lane::read(sub(a.v[1], b.v[1]))];
            let mut frame = Frame {
                line: [add(mul(nx, v[0]), mul(ny, v[1])), sub(mul(nx, v[1]), mul(ny, v[0]))],
                turn: [a.w, b.w],
                push: [0; 2],
            };
            let d = [sub(a.d[0].into(), b.d[0].into()), sub(a.d[1].into(), b.d[1].into())];
            let apart = add(lane::times(nx, d[0]), lane::times(ny, d[1]));
            let separation = [0, 1].map(|at| {
                let point = &self.points[at];
                let turned = sub(mul(point.normal.arm[0][i], a.phi), mul(point.normal.arm[1][i], b.phi));
                add(point.separation[i].into(), lane::round_to::<28>(add(apart, turned)).into())
            });
            for point in &mut self.points {
                let speed = frame.speed(&point.tangent, 1, i);
                let limit = i64::from(lane::round_to::<28>(mul(point.friction[i], point.normal.impulse[i])));
                let limit = limit.min(IMPULSE_MAX);
                let impulse = lane::clamp(sub(point.tangent.impulse[i].into(), speed), -limit, limit);
                frame.apply(&mut point.tangent, 1, i, impulse);
            }
            let (blow, pushed) = self.normals::<BIASED>(i, &mut frame, separation, scales);
            pushes |= pushed;
            if blow >= BLOW {
                self.go_round::<BIASED>(i, &mut frame, separation, scales);
            }
            self.give_back(movers, i, frame);
        }
        self.pushes = pushes;
    }

    /// The normals of both points of a contact; the greatest change of an impulse, and whether a row pushed.
    #[inline(always)]
    fn normals<const BIASED: bool>(
        &mut self,
        i: usize,
        frame: &mut Frame,
        separations: [i64; 2],
        scales: &Scales,
    ) -> (i64, bool) {
        let (mut blow, mut pushes) = (0, false);
        for (point, separation) in self.points.iter_mut().zip(separations) {
            let row = &mut point.normal;
            let impulse = i64::from(row.impulse[i]);
            let speed = frame.speed(row, 0, i);
            let next = if !BIASED {
                // What approaches is stopped; what is not there yet is left alone.
                sub(impulse, if separation > 0 { speed.max(0) } else { speed })
            } else if separation > 0 {
                // It may come just as near.
                sub(impulse, add(speed, scales.to_close(separation)))
            } else {
                let [mass, give] = scales.soft;
                let bias = scales.to_open(add(separation, SLOP));
                let wanted = lane::clamp(add(speed, bias), -(1 << 30), 1 << 30) as i32;
                let give = mul(give, impulse as i32);
                // The speed with which the row would open if nothing opposed it; or there is hardly a load at all.
                pushes |= bias < 0 && (add(mul(mass, bias as i32), give) < PUSHES || impulse < LOAD);
                sub(impulse, lane::round_to::<30>(add(mul(mass, wanted), give)).into())
            };
            let next = lane::clamp(next, 0, IMPULSE_MAX);
            blow = blow.max(sub(next, impulse).abs());
            frame.apply(row, 0, i, next);
            point.peak[i] = point.peak[i].max(next as i32);
        }
        (blow, pushes)
    }

    /// A blow goes round between the two points until both bear their part of it: a box that lands flat is not to turn in
    /// the substep in which it lands.
    #[cold]
    #[inline(never)]
    fn go_round<const BIASED: bool>(&mut self, i: usize, frame: &mut Frame, separations: [i64; 2], scales: &Scales) {
        for _ in 1..ROUNDS {
            if self.normals::<BIASED>(i, frame, separations, scales).0 < BLOW {
                break;
            }
        }
    }

    /// What the last tick's impulses do to the bodies.
    pub(crate) fn warm_start(&mut self, movers: &mut [Mover]) {
        for i in 0..LANES {
            let places = [self.bodies[0][i] as usize, self.bodies[1][i] as usize];
            if places[0] == places[1] {
                continue;
            }
            let turn = places.map(|place| movers[place].w);
            let mut frame = Frame { line: [0; 2], turn, push: [0; 2] };
            for point in &mut self.points {
                for (axis, row) in [(0, &mut point.normal), (1, &mut point.tangent)] {
                    let impulse = row.impulse[i];
                    row.impulse[i] = 0;
                    frame.apply(row, axis, i, impulse.into());
                }
            }
            self.give_back(movers, i, frame);
        }
    }

    /// The greatest impulse of each point of a contact along the normal in this tick, as λ·S, Q48.
    pub(crate) fn spent(&self, i: usize) -> [i64; 2] {
        [0, 1].map(|at| mul(self.points[at].peak[i], self.points[at].normal.line[i]))
    }

    /// A contact's linear impulse and the bodies' w, back to the bodies.
    #[inline(always)]
    fn give_back(&self, movers: &mut [Mover], i: usize, frame: Frame) {
        // Rounded once to what rows read: a change that no row could see waits for the next tick's warm start. Products of
        // 32 bits then, and bodies of equal mass get the same bits.
        let push = [lane::read(frame.push[0]), lane::read(frame.push[1])];
        for body in 0..2 {
            let [x, y] = [self.reply[body][0][i], self.reply[body][1][i]];
            let mover = &mut movers[self.bodies[body][i] as usize];
            mover.v = [
                lane::bounded(add(mover.v[0], sub(mul(x, push[0]), mul(y, push[1])))),
                lane::bounded(add(mover.v[1], add(mul(y, push[0]), mul(x, push[1])))),
            ];
            mover.w = lane::bounded(frame.turn[body]);
        }
    }
}
