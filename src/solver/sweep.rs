//! A sweep over eight contacts side by side: what [`Block::solve`] does one after the other, to the bit.
//!
//! It can be, because no two of them share a body that contacts move. Integers make it exact; what the definition limits
//! in 64 bits is limited here where that gives the same, and each such place says why.

use super::mover::Mover;
use super::rows::{BLOW, Block, IMPULSE_MAX, LOAD, Lane, PUSHES, Row};
use super::scales::{SLOP, Scales};
use super::words::{Eight, Factor, Mask, Narrow, Reach, Wide, Words};

/// What the rows of contacts read of their two bodies.
#[derive(Clone, Copy)]
pub(super) struct Look<K: Words> {
    /// The difference of their velocities.
    pub(super) v: [K::Factor; 2],
    pub(super) w: [K::Factor; 2],
    pub(super) phi: [K::Factor; 2],
    /// How far each has gone, x and y.
    pub(super) ways: [[K::Factor; 2]; 2],
}

/// What solving came to.
pub(super) struct Answer<K: Words> {
    /// By how much the impulses of friction and of both points change.
    pub(super) change: [K::Narrow; 3],
    /// Whether it took no blow.
    pub(super) mild: K::Mask,
    /// Whether a row pushed.
    pub(super) pushes: K::Mask,
}

/// Solves each of the contacts whose bits are set once, with or without their friction. By contact, from the lowest bit: whether it
/// took a blow, and whether a row pushed.
#[inline(always)]
pub(super) fn sweep<K: Reach, const BIASED: bool, const FRICTION: bool>(
    k: K,
    block: &mut Block,
    lanes: u8,
    movers: &mut [Mover],
    scales: &Scales,
) -> (u8, u8) {
    let chosen = k.chosen(&block.bodies, lanes);
    let [a, b] = [k.gather(movers, &block.bodies[0]), k.gather(movers, &block.bodies[1])];
    let ways = [k.ways(movers, &block.bodies[0]), k.ways(movers, &block.bodies[1])];
    let (v, w) = speeds(k, &a, &b);
    let look = Look { v, w, phi: [a.phi.low(), b.phi.low()], ways };
    let Answer { change, mild, pushes } = solve::<K, BIASED, FRICTION>(k, block, chosen, look, scales);
    if k.any(change[0].or(change[1]).or(change[2])) {
        let [a, b] = give(k, block, [a, b], change.map(Narrow::factor));
        k.scatter(a, movers, &block.bodies[0]);
        k.scatter(b, movers, &block.bodies[1]);
    }
    (!k.bits(mild), k.bits(pushes))
}

/// Velocities as rows read them: the difference of two, and how both turn.
#[inline(always)]
pub(super) fn speeds<K: Words>(k: K, a: &Eight<K>, b: &Eight<K>) -> ([K::Factor; 2], [K::Factor; 2]) {
    let v = [a.v[0].sub(b.v[0]).round::<28>(k), a.v[1].sub(b.v[1]).round::<28>(k)];
    (v, [a.w.round::<28>(k), b.w.round::<28>(k)])
}

/// Solves the chosen contacts once, with or without their friction.
#[inline(always)]
pub(super) fn solve<K: Words, const BIASED: bool, const FRICTION: bool>(
    k: K,
    block: &mut Block,
    chosen: K::Mask,
    Look { v, w, phi, ways: [da, db] }: Look<K>,
    scales: &Scales,
) -> Answer<K> {
    let [nx, ny] = [k.factor(&block.normal[0]), k.factor(&block.normal[1])];
    // A difference of two ways may have 33 bits.
    let apart = nx.mul(da[0]).sub(nx.mul(db[0])).add(ny.mul(da[1])).sub(ny.mul(db[1]));
    let separation = [separation(k, block, 0, apart, phi), separation(k, block, 1, apart, phi)];

    let along = nx.mul(v[0]).add(ny.mul(v[1]));
    let across = nx.mul(v[1]).sub(ny.mul(v[0]));
    let load = [k.load(&block.points[0].impulse), k.load(&block.points[1].impulse)];

    let slide = if FRICTION { slide(k, block, across, w, load, chosen) } else { k.narrow(0) };

    let speed = along.add(turning(k, &block.points[0], w));
    let speed = if FRICTION { coupled::<K>(speed, k.factor(&block.couple[0]), slide.factor()) } else { speed };
    let (first, pushes_first) = answer::<K, BIASED>(k, scales, speed, load[0], separation[0]);
    let first = chosen.pick(first, load[0]);
    let change_first = first.sub(load[0]);
    let speed = along.add(turning(k, &block.points[1], w));
    let speed = if FRICTION { coupled::<K>(speed, k.factor(&block.couple[1]), slide.factor()) } else { speed };
    let speed = coupled::<K>(speed, k.factor(&block.couple[2]), change_first.factor());
    let speed = speed.add(k.factor(&block.points[0].line).mul(change_first.factor()));
    let (second, pushes_second) = answer::<K, BIASED>(k, scales, speed, load[1], separation[1]);
    let second = chosen.pick(second, load[1]);
    let change_second = second.sub(load[1]);
    keep(k, block, 0, first, chosen);
    keep(k, block, 1, second, chosen);
    Answer {
        change: [slide, change_first, change_second],
        mild: k.narrow(BLOW as i32).above(change_first.abs().max(change_second.abs())),
        pushes: pushes_first.or(pushes_second).and(chosen),
    }
}

/// By how much the impulse of friction changes, which is kept.
#[inline(always)]
fn slide<K: Words>(
    k: K,
    block: &mut Block,
    across: K::Wide,
    w: [K::Factor; 2],
    load: [K::Narrow; 2],
    chosen: K::Mask,
) -> K::Narrow {
    let limit = k.factor(&block.limit[0]).mul(load[0].factor());
    let limit = limit.add(k.factor(&block.limit[1]).mul(load[1].factor()));
    let limit = limit.round_limited(k).min(k.narrow(IMPULSE_MAX as i32));
    let before = k.load(&block.friction.impulse);
    // A slip beyond ±2³⁰ leaves no impulse within ±2²⁹ but a limit, as ±2³⁰ does.
    let slip = across.add(turning(k, &block.friction, w)).round_limited(k);
    let impulse = before.sub(slip).min(limit).max(k.narrow(0).sub(limit));
    let impulse = chosen.pick(impulse, before);
    k.store(impulse, &mut block.friction.impulse);
    impulse.sub(before)
}

/// What the last tick's impulses do to the bodies.
#[inline(always)]
pub(super) fn warm_start<K: Reach>(k: K, block: &Block, movers: &mut [Mover]) {
    let chosen = k.chosen(&block.bodies, u8::MAX);
    let a = k.gather(movers, &block.bodies[0]);
    let b = k.gather(movers, &block.bodies[1]);
    let impulse = |row: &Row| chosen.pick(k.load(&row.impulse), k.narrow(0)).factor();
    let [first, second] = &block.points;
    let [a, b] = give(k, block, [a, b], [impulse(&block.friction), impulse(first), impulse(second)]);
    k.scatter(a, movers, &block.bodies[0]);
    k.scatter(b, movers, &block.bodies[1]);
}

/// A point's impulse.
#[inline(always)]
fn keep<K: Words>(k: K, block: &mut Block, at: usize, impulse: K::Narrow, chosen: K::Mask) {
    k.store(impulse, &mut block.points[at].impulse);
    let peak = k.load(&block.peak[at]);
    k.store(chosen.pick(peak.max(impulse), peak), &mut block.peak[at]);
}

/// How far a point is from touching, rounded, then counted from the separation at the tick's beginning, which is whole.
#[inline(always)]
fn separation<K: Words>(k: K, block: &Block, at: usize, apart: K::Wide, phi: [K::Factor; 2]) -> K::Narrow {
    let moved = apart.add(turning(k, &block.points[at], phi)).half::<28>(k);
    moved.add(k.factor(&block.separation[at]).mul(k.narrow(1 << 28).factor())).limited(k)
}

/// What turning at these rims adds to the speed of a row.
#[inline(always)]
fn turning<K: Words>(k: K, row: &Row, [a, b]: [K::Factor; 2]) -> K::Wide {
    k.factor(&row.arm[0]).mul(a).sub(k.factor(&row.arm[1]).mul(b))
}

/// [`coupled`](crate::num::lane::coupled).
#[inline(always)]
fn coupled<K: Words>(speed: K::Wide, coefficient: K::Factor, impulse: K::Factor) -> K::Wide {
    let product = coefficient.mul(impulse);
    speed.add(product).add(product)
}

/// `Scales::answer`: the impulse, and where a row pushes.
#[inline(always)]
fn answer<K: Words, const BIASED: bool>(
    k: K,
    scales: &Scales,
    speed: K::Wide,
    load: K::Narrow,
    separation: K::Narrow,
) -> (K::Narrow, K::Mask) {
    let [zero, most] = [k.narrow(0), k.narrow(IMPULSE_MAX as i32)];
    let gap = separation.above(zero);
    if !BIASED {
        // A speed beyond ±2³⁰ leaves no impulse within 0 … 2²⁹ but one of these, as ±2³⁰ does.
        let speed = speed.round_limited(k);
        let speed = gap.pick(speed.max(zero), speed);
        return (load.sub(speed).min(most).max(zero), zero.above(zero));
    }
    let way = gap.pick(separation, separation.add(k.narrow(SLOP)).min(zero));
    let rate = gap.pick(k.narrow(scales.close_rate), k.narrow(scales.push_rate));
    // Limited before it is shifted, which is the same.
    let bias = way.factor().mul(rate.factor()).max(k.wide(-(1 << 50))).min(k.wide((1 << 50) - (1 << 20)));
    let bias = bias.shifted::<20>(k).low();
    let mass = gap.pick(k.narrow(1 << 30), k.narrow(scales.soft[0])).factor();
    let eased = load.min(load.shifted::<2>().add(k.narrow(scales.firm)));
    let give = gap.pick(zero, k.narrow(scales.soft[1])).factor().mul(eased.factor());
    let opens = mass.mul(bias).add(give);
    let pushes = k.wide(PUSHES).above(opens).or(k.narrow(LOAD as i32).above(load)).and(zero.above(way));
    // Below 2³¹.
    let speed = speed.round_limited(k).factor();
    let answer = mass.mul(speed).add(opens.max(k.wide(scales.least_opens()))).round::<30>(k).narrow();
    (load.sub(answer).min(most).max(zero), pushes)
}

/// `Block::give`: changes of the impulses of friction and of both points, to the bodies.
#[inline(always)]
pub(super) fn give<K: Words>(
    k: K,
    block: &Block,
    [mut a, mut b]: [Eight<K>; 2],
    change: [K::Factor; 3],
) -> [Eight<K>; 2] {
    let (f, [p, q]) = (&block.friction, &block.points);
    let [slide, first, second] = change;
    let push = k.factor(&p.line).mul(first).add(k.factor(&q.line).mul(second)).round::<28>(k);
    let drag = k.factor(&f.line).mul(slide).round::<28>(k);
    (a.v, a.w) = (push_along(k, &block.reply[0], a.v, push, drag), a.w.add(turn(k, block, 0, change)));
    (b.v, b.w) = (push_along(k, &block.reply[1], b.v, push, drag), b.w.sub(turn(k, block, 1, change)));
    [k.held(a), k.held(b)]
}

/// A velocity after pushes along the normal and the tangent.
#[inline(always)]
fn push_along<K: Words>(k: K, reply: &[Lane; 2], v: [K::Wide; 2], push: K::Factor, drag: K::Factor) -> [K::Wide; 2] {
    let [x, y] = [k.factor(&reply[0]), k.factor(&reply[1])];
    [v[0].add(x.mul(push).sub(y.mul(drag))), v[1].add(y.mul(push).add(x.mul(drag)))]
}

/// What impulses add to the rim's speed of a body.
#[inline(always)]
fn turn<K: Words>(k: K, block: &Block, body: usize, [slide, first, second]: [K::Factor; 3]) -> K::Wide {
    let (f, [p, q]) = (&block.friction, &block.points);
    let turn = k.factor(&p.turn[body]).mul(first).add(k.factor(&q.turn[body]).mul(second));
    k.factor(&f.turn[body]).mul(slide).add(turn)
}
