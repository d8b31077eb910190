//! The contacts of a block, written side by side: what [`Joint::write`](super::Joint::write) does one after the other, to the
//! bit.
//!
//! One loop over lanes without a branch, which compilers turn into whatever instructions a processor has: for AVX-512, 880
//! for eight contacts. It knows no products of 128 bits. What needs them, because one body is so thin or so much heavier, or
//! a point so far away, is left over for the definition.

use super::super::mobility::Mobility;
use super::super::rows::{Block, LANES, Row};
use super::known;
use crate::contact::{Contact, Pair};
use crate::num::flat::{add, beyond, carry, hold, inverse, mul, part, pick, round, scale, sign, sub, within};

type Column = [i64; LANES];

/// What the rows of eight contacts are made of. Formats as in [`Joint`](super::Joint), [`Mobility`] and [`Pair`].
#[derive(Clone, Debug, Default)]
#[repr(align(64))]
pub(crate) struct Joints {
    /// By point and axis.
    arm: [[Column; 2]; 2],
    separation: [Column; 2],
    normal: [Column; 2],
    /// From a's centre to b's.
    between: [Column; 2],
    bodies: [Side; 2],
    friction: Column,
    /// What the last tick left of both points, and of their friction.
    start: [Column; 3],
    /// All bits set where there is a second point.
    two: Column,
}

/// One body of each.
#[derive(Clone, Debug, Default)]
struct Side {
    share: Column,
    tau: Column,
    sigma: Column,
    /// 0 of what rows do not know.
    scale: Column,
    shift: Column,
}

/// One row's lever: α of both, p·τ·α of both, κ, 1/κ, and p·τ·α/κ of both; Q28. Of a point that is not there, zero.
#[derive(Clone, Copy)]
struct Lever {
    arm: [i64; 2],
    turn: [i64; 2],
    kappa: i64,
    line: i64,
    coefficient: [i64; 2],
}

impl Joints {
    /// Takes a contact in.
    #[inline(always)]
    pub(crate) fn seat(
        &mut self,
        i: usize,
        pair: &Pair,
        places: [u32; 2],
        between: [i64; 2],
        mobility: [&Mobility; 2],
        old: &Contact,
    ) {
        let manifold = &pair.manifold;
        for at in 0..2 {
            self.arm[at][0][i] = manifold.points[at].arm[0];
            self.arm[at][1][i] = manifold.points[at].arm[1];
            self.separation[at][i] = manifold.points[at].separation;
        }
        for (axis, between) in between.into_iter().enumerate() {
            self.normal[axis][i] = manifold.normal[axis].into();
            self.between[axis][i] = between;
        }
        let first = mobility[0].share(mobility[1]);
        let second = if mobility[1].moves() { (1i32 << 28).saturating_sub(first) } else { 0 };
        for (body, share) in [first, second].into_iter().enumerate() {
            let (side, mobility) = (&mut self.bodies[body], mobility[body]);
            side.share[i] = share.into();
            side.tau[i] = mobility.tau;
            side.sigma[i] = mobility.sigma;
            side.scale[i] = if places[body] == 0 { 0 } else { mobility.scale };
            side.shift[i] = mobility.scale_shift.into();
        }
        self.friction[i] = pair.friction;
        let known = [known(manifold, 0, old), known(manifold, 1, old)];
        self.start[0][i] = known[0].map_or(0, |k| old.normal[k]);
        self.start[1][i] = known[1].map_or(0, |k| old.normal[k]);
        self.start[2][i] = if known == [None; 2] { 0 } else { old.tangent };
        self.two[i] = if manifold.count > 1 { -1 } else { 0 };
    }

    /// Writes all of them into a block. Those that are left over have bits that are set, from the lowest on; so may lanes in
    /// which nobody sits.
    #[inline(always)]
    pub(crate) fn write(&self, block: &mut Block, shift: u32) -> u8 {
        let mut left = [0; LANES];
        for (i, left) in left.iter_mut().enumerate() {
            *left = self.write_lane(i, block, shift);
        }
        (0..LANES).fold(0, |bits, i| bits | u8::from(left[i] != 0) << i)
    }

    /// Whether it is left over: 0 if not.
    #[inline(always)]
    fn write_lane(&self, i: usize, block: &mut Block, shift: u32) -> i64 {
        const MOST: i64 = i32::MAX as i64;
        let two = self.two[i];
        let n = [self.normal[0][i], self.normal[1][i]];
        let unit = [round::<2>(n[0]), round::<2>(n[1])];
        let shares = [self.bodies[0].share[i], self.bodies[1].share[i]];
        for (axis, &unit) in unit.iter().enumerate() {
            block.normal[axis][i] = unit as i32;
            block.reply[0][axis][i] = scale(shares[0], unit) as i32;
            block.reply[1][axis][i] = sub(0, scale(shares[1], unit)) as i32;
        }

        let [one, other] = [self.arms(i, 0, n, unit, -1), self.arms(i, 1, n, unit, two)];
        let separation = [self.separation[0][i], self.separation[1][i]];
        let lower = separation[1] < separation[0] && two != 0;
        let across = [pick(lower, other[1][0], one[1][0]), pick(lower, other[1][1], one[1][1])];
        let inertia = [scale(shares[0], self.bodies[0].tau[i]), scale(shares[1], self.bodies[1].tau[i])];
        let first = Lever::new(one[0], inertia, -1);
        let second = Lever::new(other[0], inertia, two);
        let tangent = Lever::new(across, inertia, -1);
        block.peak[0][i] = first.put(&mut block.points[0], i, self.start[0][i]);
        block.peak[1][i] = second.put(&mut block.points[1], i, self.start[1][i]);
        tangent.put(&mut block.friction, i, self.start[2][i]);
        block.couple[0][i] = tangent.turns(one[0]);
        block.couple[1][i] = tangent.turns(other[0]);
        block.couple[2][i] = first.turns(other[0]);

        let friction = self.friction[i];
        let limit =
            [hold(friction, scale(first.line, tangent.kappa)), hold(friction, scale(second.line, tangent.kappa))];
        block.limit[0][i] = pick(limit[0] > MOST, MOST, limit[0]) as i32;
        block.limit[1][i] = pick(limit[1] > MOST, MOST, limit[1]) as i32;
        block.separation[0][i] = brought(separation[0], shift) as i32;
        block.separation[1][i] = pick(two != 0, brought(separation[1], shift), MOST) as i32;
        self.left(i) | first.left() | second.left() | tangent.left()
    }

    /// Whether what it is made of is none of these numbers' size: 0 if not.
    #[inline(always)]
    fn left(&self, i: usize) -> i64 {
        let far = magnitude(self.arm[0][0][i]) | magnitude(self.arm[0][1][i]) | magnitude(self.arm[1][0][i]);
        let far = far | magnitude(self.arm[1][1][i]) | magnitude(self.between[0][i]) | magnitude(self.between[1][i]);
        let start = magnitude(self.start[0][i]) | magnitude(self.start[1][i]) | magnitude(self.start[2][i]);
        let gap = positive(self.separation[0][i]) | positive(self.separation[1][i]);
        let tau = self.bodies[0].tau[i] | self.bodies[1].tau[i];
        far >> 60 | start >> 58 | gap >> 47 | tau >> 31 | self.friction[i] >> 55
    }

    /// α of both bodies along the normal, and along the tangent, at a point; zero where a mask is.
    #[inline(always)]
    fn arms(&self, i: usize, at: usize, n: [i64; 2], unit: [i64; 2], there: i64) -> [[i64; 2]; 2] {
        let separation = self.separation[at][i];
        let half = positive(separation) >> 1;
        let out = [part(half, n[0]), part(half, n[1])];
        let [x, y] = [self.arm[at][0][i], self.arm[at][1][i]];
        let [far_x, far_y] = [self.between[0][i], self.between[1][i]];
        let [along_a, across_a] = self.bodies[0].arm(i, [add(x, out[0]), add(y, out[1])], unit);
        let [along_b, across_b] = self.bodies[1].arm(i, [sub(sub(x, far_x), out[0]), sub(sub(y, far_y), out[1])], unit);
        [[along_a & there, along_b & there], [across_a & there, across_b & there]]
    }
}

/// A bound of the magnitude: one less of what is negative.
#[inline(always)]
fn magnitude(v: i64) -> i64 {
    v ^ sign(v)
}

#[inline(always)]
fn positive(v: i64) -> i64 {
    pick(v > 0, v, 0)
}

/// A separation as rows have it.
#[inline(always)]
fn brought(separation: i64, shift: u32) -> i64 {
    let shift = shift.saturating_add(6);
    within(add(add(separation, (1 << shift) >> 1), sign(separation)) >> shift, 1 << 30)
}

impl Side {
    /// α along both.
    #[inline(always)]
    fn arm(&self, i: usize, r: [i64; 2], [nx, ny]: [i64; 2]) -> [i64; 2] {
        const LIMIT: i64 = (8 << 28) - 1;
        let [x, y] = [self.relative(i, r[0]), self.relative(i, r[1])];
        let along = round::<28>(sub(mul(x, ny), mul(y, nx)));
        let across = round::<28>(add(mul(x, nx), mul(y, ny)));
        [within(along, LIMIT), within(across, LIMIT)]
    }

    /// [`Mobility::relative`] of one coordinate, by its magnitude.
    #[inline(always)]
    fn relative(&self, i: usize, r: i64) -> i64 {
        const LIMIT: i64 = (8 << 28) - 1;
        let (most, sign) = (self.sigma[i] << 3, sign(r));
        let r = sub(r ^ sign, sign);
        let r = pick(r > most, most, r);
        let shift = self.shift[i];
        let (up, down) = (pick(shift < 0, sub(0, shift), 0) as u32 & 63, pick(shift > 0, shift, 0) as u32 & 63);
        let r = add(r << up, (1 << down) >> 1) >> down;
        // 2³² and one less are both beyond the limit.
        let r = pick(r > u32::MAX as i64, u32::MAX as i64, r);
        let product = (r as u32 as u64).wrapping_mul(self.scale[i] as u32 as u64) as i64;
        let r = add(product, 1 << 29) >> 30;
        let r = pick(r > LIMIT, LIMIT, r);
        sub(r ^ sign, sign)
    }
}

impl Lever {
    #[inline(always)]
    fn new(arm: [i64; 2], inertia: [i64; 2], there: i64) -> Lever {
        let turn = [scale(arm[0], inertia[0]), scale(arm[1], inertia[1])];
        let kappa = add(1 << 28, add(scale(arm[0], turn[0]), scale(arm[1], turn[1])));
        let line = inverse(kappa) & there;
        let coefficient = [scale(line, turn[0]), scale(line, turn[1])];
        Lever { arm, turn, kappa: kappa & there, line, coefficient }
    }

    /// `Row::put`, and the impulse.
    #[inline(always)]
    fn put(&self, row: &mut Row, i: usize, start: i64) -> i32 {
        row.line[i] = self.line as i32;
        for body in 0..2 {
            row.arm[body][i] = self.arm[body] as i32;
            row.turn[body][i] = self.coefficient[body] as i32;
        }
        let impulse = within(carry(start, self.kappa), 1 << 29) as i32;
        row.impulse[i] = impulse;
        impulse
    }

    /// `Row::turns`.
    #[inline(always)]
    fn turns(&self, arm: [i64; 2]) -> i32 {
        let [a, b] = self.coefficient;
        within(round::<29>(add(mul(a, arm[0]), mul(b, arm[1]))), 11 << 27) as i32
    }

    /// Whether it is none of these numbers' size: 0 if not.
    #[inline(always)]
    fn left(&self) -> i64 {
        beyond(self.turn[0]) | beyond(self.turn[1]) | beyond(self.kappa)
    }
}
