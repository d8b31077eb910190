//! Lanes side by side in plain arrays: safe code, of which a compiler makes the vectors that its processor has.
//!
//! It does so where a loop over arrays has no branches, and its vectors are as long as the widest number that the loop loads
//! or stores lets them be. So there are three loops: what rows read of velocities of 64 bits; all rows, in 32; and what the
//! velocities gain. The words are those of a [`Pair`], lanes i and i + 4: said four times, that is one straight line over all
//! eight, in which none waits for another's answers. What failed: eight numbers a word, which a compiler takes apart into
//! single ones before it looks for vectors; one number a word, which gives loops over two or four lanes (a third slower).

use super::mover::Mover;
use super::rows::{Block, LANES, Lane};
use super::scales::Scales;
use super::sweep::{self, Answer, Look};
use super::words::{self, Eight, Words};
use crate::num::lane;

const HALF: usize = LANES / 2;

/// The words of lanes i and i + 4.
#[derive(Clone, Copy)]
struct Plain(usize);

/// A number of each.
#[derive(Clone, Copy)]
struct Pair<T>(T, T);

/// What movers are to contacts, in columns.
struct Columns {
    v: [[i64; LANES]; 2],
    w: [i64; LANES],
    phi: Lane,
    d: [Lane; 2],
}

/// One sweep over a block, see [`sweep::sweep`].
#[inline(never)]
pub(super) fn sweep<const BIASED: bool, const FRICTION: bool>(
    block: &mut Block,
    lanes: u8,
    movers: &mut [Mover],
    scales: &Scales,
) -> (u8, u8) {
    let places = block.bodies;
    let mut bodies = places.each_ref().map(|places| Columns::gather(movers, places));
    let chosen = chosen(&places, lanes);
    let (v, w) = speeds(&bodies);
    let (mut change, mut flags) = ([[0; LANES]; 3], [[0; LANES]; 2]);
    for plain in Plain::all() {
        let two = |[x, y]: &[Lane; 2]| [plain.load(x), plain.load(y)];
        let [a, b] = &bodies;
        let phi = [plain.load(&a.phi), plain.load(&b.phi)];
        let look = Look { v: two(&v), w: two(&w), phi, ways: [two(&a.d), two(&b.d)] };
        let chosen = plain.load(&chosen).each(|chosen| chosen != 0);
        let answer: Answer<Plain> = sweep::solve::<_, BIASED, FRICTION>(plain, block, chosen, look, scales);
        // Word by word: behind an iterator over arrays this is no loop for vectors any more.
        let [slide, first, second] = answer.change;
        plain.store(slide, &mut change[0]);
        plain.store(first, &mut change[1]);
        plain.store(second, &mut change[2]);
        plain.store(answer.mild.each(|mild| i32::from(!mild)), &mut flags[0]);
        plain.store(answer.pushes.each(i32::from), &mut flags[1]);
    }
    if change != [[0; LANES]; 3] {
        give(block, &mut bodies, &change);
        bodies.iter().zip(&places).for_each(|(columns, places)| columns.scatter(movers, places));
    }
    let [blows, pushes] = flags.map(|flags| (0..LANES).fold(0, |bits, i| bits | (flags[i] as u8) << i));
    (blows, pushes)
}

/// Last tick's impulses, see [`sweep::warm_start`].
#[inline(never)]
pub(super) fn warm_start(block: &Block, movers: &mut [Mover]) {
    let mut bodies = block.bodies.each_ref().map(|places| Columns::gather(movers, places));
    let chosen = chosen(&block.bodies, u8::MAX);
    let rows = [&block.friction, &block.points[0], &block.points[1]];
    let change = rows.map(|row| core::array::from_fn(|i| if chosen[i] != 0 { row.impulse[i] } else { 0 }));
    give(block, &mut bodies, &change);
    bodies.iter().zip(&block.bodies).for_each(|(columns, places)| columns.scatter(movers, places));
}

/// Not zero where a contact is to be solved: its bit is set, and its bodies are two.
#[inline(always)]
fn chosen(bodies: &[[u32; LANES]; 2], lanes: u8) -> Lane {
    const BITS: Lane = [1, 2, 4, 8, 16, 32, 64, 128];
    core::array::from_fn(|i| if bodies[0][i] != bodies[1][i] { i32::from(lanes) & BITS[i] } else { 0 })
}

/// [`sweep::speeds`].
#[inline(always)]
fn speeds([a, b]: &[Columns; 2]) -> ([Lane; 2], [Lane; 2]) {
    let [mut v, mut w] = [[[0; LANES]; 2]; 2];
    for plain in Plain::all() {
        let ([x, y], [spin_a, spin_b]) = sweep::speeds(plain, &a.speed(plain), &b.speed(plain));
        plain.store(x, &mut v[0]);
        plain.store(y, &mut v[1]);
        plain.store(spin_a, &mut w[0]);
        plain.store(spin_b, &mut w[1]);
    }
    (v, w)
}

/// [`sweep::give`].
#[inline(always)]
fn give(block: &Block, [a, b]: &mut [Columns; 2], [slide, first, second]: &[Lane; 3]) {
    let mut over = 0;
    for plain in Plain::all() {
        let change = [plain.load(slide), plain.load(first), plain.load(second)];
        let [speed_a, speed_b] = sweep::give(plain, block, [a.speed(plain), b.speed(plain)], change);
        over |= above(&speed_a) | above(&speed_b);
        a.set(plain, speed_a);
        b.set(plain, speed_b);
    }
    // As in `held`, nearly never.
    if over as u64 >= (lane::HELD as u64).wrapping_mul(2) {
        a.hold();
        b.hold();
    }
}

/// Velocities from the lower bound on, or'ed: one that is beyond a bound sets a bit from 58 on.
#[inline(always)]
fn above(Eight { v: [x, y], w, .. }: &Eight<Plain>) -> i64 {
    let [x, y, w] = [x, y, w].map(|speed| speed.each(|speed| speed.wrapping_add(lane::HELD)));
    x.0 | x.1 | y.0 | y.1 | w.0 | w.1
}

impl Columns {
    #[inline(always)]
    fn gather(movers: &[Mover], places: &[u32; LANES]) -> Columns {
        let mut columns = Columns { v: [[0; LANES]; 2], w: [0; LANES], phi: [0; LANES], d: [[0; LANES]; 2] };
        for (i, place) in places.iter().enumerate() {
            let mover = &movers[*place as usize];
            [columns.v[0][i], columns.v[1][i]] = mover.v;
            (columns.w[i], columns.phi[i]) = (mover.w, mover.phi as i32);
            [columns.d[0][i], columns.d[1][i]] = mover.d;
        }
        columns
    }

    #[inline(always)]
    fn scatter(&self, movers: &mut [Mover], places: &[u32; LANES]) {
        for (i, place) in places.iter().enumerate() {
            let mover = &mut movers[*place as usize];
            mover.v = [self.v[0][i], self.v[1][i]];
            mover.w = self.w[i];
        }
    }

    #[cold]
    fn hold(&mut self) {
        let [x, y] = &mut self.v;
        for speed in x.iter_mut().chain(y).chain(&mut self.w) {
            *speed = lane::clamp(*speed, -lane::HELD, lane::HELD);
        }
    }

    /// Velocities. Nothing that asks for them reads φ.
    #[inline(always)]
    fn speed(&self, plain: Plain) -> Eight<Plain> {
        Eight { v: [plain.at(&self.v[0]), plain.at(&self.v[1])], w: plain.at(&self.w), phi: plain.wide(0) }
    }

    #[inline(always)]
    fn set(&mut self, plain: Plain, Eight { v: [x, y], w, .. }: Eight<Plain>) {
        plain.put(x, &mut self.v[0]);
        plain.put(y, &mut self.v[1]);
        plain.put(w, &mut self.w);
    }
}

impl Plain {
    #[inline(always)]
    fn all() -> impl Iterator<Item = Plain> {
        (0..HALF).map(Plain)
    }

    #[inline(always)]
    fn at<T: Copy>(self, lanes: &[T; LANES]) -> Pair<T> {
        Pair(lanes[self.0], lanes[HALF..][self.0])
    }

    #[inline(always)]
    fn put<T>(self, Pair(low, high): Pair<T>, lanes: &mut [T; LANES]) {
        (lanes[self.0], lanes[HALF..][self.0]) = (low, high);
    }
}

impl<T: Copy> Pair<T> {
    #[inline(always)]
    fn each<U>(self, f: impl Fn(T) -> U) -> Pair<U> {
        Pair(f(self.0), f(self.1))
    }

    #[inline(always)]
    fn both<U>(self, other: Pair<T>, f: impl Fn(T, T) -> U) -> Pair<U> {
        Pair(f(self.0, other.0), f(self.1, other.1))
    }
}

/// A factor, which is never `i32::MIN`. That is nothing to do, but a compiler that sees 32 bits of an expression of 64 made
/// longer again leaves them there, and NEON has no product of 64.
#[inline(always)]
fn seen(factor: i32) -> i32 {
    Ord::max(factor, -i32::MAX)
}

impl Words for Plain {
    type Narrow = Pair<i32>;
    type Wide = Pair<i64>;
    type Factor = Pair<i32>;
    type Mask = Pair<bool>;

    #[inline(always)]
    fn narrow(self, value: i32) -> Pair<i32> {
        Pair(value, value)
    }

    #[inline(always)]
    fn wide(self, value: i64) -> Pair<i64> {
        Pair(value, value)
    }

    #[inline(always)]
    fn load(self, lane: &Lane) -> Pair<i32> {
        self.at(lane)
    }

    #[inline(always)]
    fn factor(self, lane: &Lane) -> Pair<i32> {
        self.at(lane)
    }

    #[inline(always)]
    fn store(self, narrow: Pair<i32>, lane: &mut Lane) {
        self.put(narrow, lane);
    }

    /// They are held after the loop.
    #[inline(always)]
    fn held(self, eight: Eight<Self>) -> Eight<Self> {
        eight
    }
}

/// Words that are the same for each of both numbers.
macro_rules! each {
    ($($name:ident($one:ident $(, $other:ident)?) -> $out:ty { $value:expr })*) => {$(
        #[inline(always)]
        fn $name(self $(, $other: Self)?) -> $out {
            each!(@ self, $one $(, $other)?, $value)
        }
    )*};
    (@ $self:ident, $one:ident, $value:expr) => { $self.each(|$one| $value) };
    (@ $self:ident, $one:ident, $other:ident, $value:expr) => { $self.both($other, |$one, $other| $value) };
}

impl words::Narrow<Plain> for Pair<i32> {
    each! {
        factor(a) -> Self { seen(a) }
        add(a, b) -> Self { a.wrapping_add(b) }
        sub(a, b) -> Self { a.wrapping_sub(b) }
        min(a, b) -> Self { Ord::min(a, b) }
        max(a, b) -> Self { Ord::max(a, b) }
        abs(a) -> Self { a.wrapping_abs() }
        or(a, b) -> Self { a | b }
        above(a, b) -> Pair<bool> { a > b }
    }

    #[inline(always)]
    fn shifted<const SHIFT: i32>(self) -> Self {
        self.each(|a| a >> SHIFT)
    }
}

impl words::Factor<Plain> for Pair<i32> {
    each! {
        mul(a, b) -> Pair<i64> { lane::mul(a, b) }
        narrow(a) -> Self { a }
    }
}

impl words::Wide<Plain> for Pair<i64> {
    each! {
        add(a, b) -> Self { a.wrapping_add(b) }
        sub(a, b) -> Self { a.wrapping_sub(b) }
        min(a, b) -> Self { Ord::min(a, b) }
        max(a, b) -> Self { Ord::max(a, b) }
        above(a, b) -> Pair<bool> { a > b }
        low(a) -> Pair<i32> { seen(a as i32) }
    }

    #[inline(always)]
    fn shifted<const SHIFT: i32>(self, _: Plain) -> Self {
        self.each(|a| a >> SHIFT)
    }

    #[inline(always)]
    fn half<const SHIFT: i32>(self, _: Plain) -> Self {
        self.each(|a| a.wrapping_add(a >> 63).wrapping_add((1 << SHIFT) >> 1))
    }

    #[inline(always)]
    fn round<const SHIFT: i32>(self, plain: Plain) -> Pair<i32> {
        self.half::<SHIFT>(plain).shifted::<SHIFT>(plain).low()
    }

    #[inline(always)]
    fn limited(self, _: Plain) -> Pair<i32> {
        // By the upper halves: the quotient is in ±2³⁰ if those are in ±2²⁶.
        self.each(|a| {
            let high = (a >> 32) as i32;
            let inner = if high > (1 << 26) - 1 { 1 << 30 } else { (a >> 28) as i32 };
            if high < -(1 << 26) { -(1 << 30) } else { inner }
        })
    }
}

impl words::Mask<Plain> for Pair<bool> {
    each! {
        and(a, b) -> Self { a & b }
        or(a, b) -> Self { a | b }
    }

    #[inline(always)]
    fn pick(self, yes: Pair<i32>, no: Pair<i32>) -> Pair<i32> {
        Pair(if self.0 { yes.0 } else { no.0 }, if self.1 { yes.1 } else { no.1 })
    }
}
