//! A sweep over eight contacts side by side: what [`Block::solve`] does one after the other, to the bit.
//!
//! It can be, because no two of them share a body that contacts move. Integers make it exact; what the definition limits
//! in 64 bits is limited here where that gives the same, and each such place says why.

use super::avx2::{Avx2, Eight, Factor, Narrow, Wide};
use super::mover::Mover;
use super::rows::{BLOW, Block, IMPULSE_MAX, LOAD, Lane, PUSHES, Row};
use super::scales::{SLOP, Scales};

/// Solves each of the contacts whose bits are set once. By contact, from the lowest bit: whether it took a blow, and
/// whether a row pushed.
#[inline(always)]
pub(super) fn sweep<const BIASED: bool>(
    avx2: Avx2,
    block: &mut Block,
    lanes: u8,
    movers: &mut [Mover],
    scales: &Scales,
) -> (u8, u8) {
    let chosen = avx2.chosen(&block.bodies, lanes);
    let a = Eight::gather(avx2, movers, &block.bodies[0]);
    let b = Eight::gather(avx2, movers, &block.bodies[1]);
    let [nx, ny] = [avx2.factor(&block.normal[0]), avx2.factor(&block.normal[1])];

    let phi = [a.phi.low(), b.phi.low()];
    let da = Eight::ways(avx2, movers, &block.bodies[0]);
    let db = Eight::ways(avx2, movers, &block.bodies[1]);
    // A difference of two ways may have 33 bits.
    let apart = nx.mul(da[0]).sub(nx.mul(db[0])).add(ny.mul(da[1])).sub(ny.mul(db[1]));
    let separation = [separation(avx2, block, 0, apart, phi), separation(avx2, block, 1, apart, phi)];

    let v = [a.v[0].sub(b.v[0]).round::<28>(avx2), a.v[1].sub(b.v[1]).round::<28>(avx2)];
    let w = [a.w.round::<28>(avx2), b.w.round::<28>(avx2)];
    let along = nx.mul(v[0]).add(ny.mul(v[1]));
    let across = nx.mul(v[1]).sub(ny.mul(v[0]));
    let load = [avx2.load(&block.points[0].impulse), avx2.load(&block.points[1].impulse)];

    let limit = avx2.factor(&block.limit[0]).mul(load[0].factor());
    let limit = limit.add(avx2.factor(&block.limit[1]).mul(load[1].factor()));
    let limit = limit.round_limited(avx2).min(avx2.narrow(IMPULSE_MAX as i32));
    let before = avx2.load(&block.friction.impulse);
    // A slip beyond ±2³⁰ leaves no impulse within ±2²⁹ but a limit, as ±2³⁰ does.
    let slip = across.add(turning(avx2, &block.friction, w)).round_limited(avx2);
    let impulse = before.sub(slip).min(limit).max(avx2.narrow(0).sub(limit));
    let impulse = chosen.pick(impulse, before);
    impulse.store(&mut block.friction.impulse);
    let slide = impulse.sub(before).factor();

    let speed = along.add(turning(avx2, &block.points[0], w));
    let speed = coupled(speed, avx2.factor(&block.couple[0]), slide);
    let (first, pushes_first) = answer::<BIASED>(avx2, scales, speed, load[0], separation[0]);
    let first = chosen.pick(first, load[0]);
    let change_first = first.sub(load[0]);
    let speed = along.add(turning(avx2, &block.points[1], w));
    let speed = coupled(speed, avx2.factor(&block.couple[1]), slide);
    let speed = coupled(speed, avx2.factor(&block.couple[2]), change_first.factor());
    let speed = speed.add(avx2.factor(&block.points[0].line).mul(change_first.factor()));
    let (second, pushes_second) = answer::<BIASED>(avx2, scales, speed, load[1], separation[1]);
    let second = chosen.pick(second, load[1]);
    let change_second = second.sub(load[1]);
    keep(avx2, block, 0, first, chosen);
    keep(avx2, block, 1, second, chosen);

    if slide.narrow().or(change_first).or(change_second).any() {
        let [a, b] = give(avx2, block, [a, b], [slide, change_first.factor(), change_second.factor()]);
        a.scatter(movers, &block.bodies[0]);
        b.scatter(movers, &block.bodies[1]);
    }
    let mild = avx2.narrow(BLOW as i32).above(change_first.abs().max(change_second.abs()));
    (!mild.signs(), pushes_first.or(pushes_second).and(chosen).signs())
}

/// What the last tick's impulses do to the bodies.
#[inline(always)]
pub(super) fn warm_start(avx2: Avx2, block: &Block, movers: &mut [Mover]) {
    let chosen = avx2.chosen(&block.bodies, u8::MAX);
    let a = Eight::gather(avx2, movers, &block.bodies[0]);
    let b = Eight::gather(avx2, movers, &block.bodies[1]);
    let slide = avx2.load(&block.friction.impulse).and(chosen).factor();
    let first = avx2.load(&block.points[0].impulse).and(chosen).factor();
    let second = avx2.load(&block.points[1].impulse).and(chosen).factor();
    let [a, b] = give(avx2, block, [a, b], [slide, first, second]);
    a.scatter(movers, &block.bodies[0]);
    b.scatter(movers, &block.bodies[1]);
}

/// A point's impulse.
#[inline(always)]
fn keep(avx2: Avx2, block: &mut Block, at: usize, impulse: Narrow, chosen: Narrow) {
    impulse.store(&mut block.points[at].impulse);
    let peak = avx2.load(&block.peak[at]);
    chosen.pick(peak.max(impulse), peak).store(&mut block.peak[at]);
}

/// How far a point is from touching, rounded, then counted from the separation at the tick's beginning, which is whole.
#[inline(always)]
fn separation(avx2: Avx2, block: &Block, at: usize, apart: Wide, phi: [Factor; 2]) -> Narrow {
    let moved = apart.add(turning(avx2, &block.points[at], phi)).half::<28>(avx2);
    moved.add(avx2.factor(&block.separation[at]).mul(avx2.narrow(1 << 28).factor())).limited(avx2)
}

/// What turning at these rims adds to the speed of a row.
#[inline(always)]
fn turning(avx2: Avx2, row: &Row, [a, b]: [Factor; 2]) -> Wide {
    avx2.factor(&row.arm[0]).mul(a).sub(avx2.factor(&row.arm[1]).mul(b))
}

/// [`coupled`](crate::num::lane::coupled).
#[inline(always)]
fn coupled(speed: Wide, coefficient: Factor, impulse: Factor) -> Wide {
    let product = coefficient.mul(impulse);
    speed.add(product).add(product)
}

/// `Scales::answer`. The pushes are all bits of their lanes.
#[inline(always)]
fn answer<const BIASED: bool>(
    avx2: Avx2,
    scales: &Scales,
    speed: Wide,
    load: Narrow,
    separation: Narrow,
) -> (Narrow, Narrow) {
    let [zero, most] = [avx2.narrow(0), avx2.narrow(IMPULSE_MAX as i32)];
    let gap = separation.above(zero);
    if !BIASED {
        // A speed beyond ±2³⁰ leaves no impulse within 0 … 2²⁹ but one of these, as ±2³⁰ does.
        let speed = speed.round_limited(avx2);
        let speed = gap.pick(speed.max(zero), speed);
        return (load.sub(speed).min(most).max(zero), zero);
    }
    let way = gap.pick(separation, separation.add(avx2.narrow(SLOP)).min(zero));
    let rate = gap.pick(avx2.narrow(scales.close_rate), avx2.narrow(scales.push_rate));
    // Limited before it is shifted, which is the same. The shift brings in zeros, so the number is moved up to be positive,
    // and back. The lower half of the bias is its own.
    let bias = way.factor().mul(rate.factor()).max(avx2.wide(-(1 << 50))).min(avx2.wide((1 << 50) - (1 << 20)));
    let bias = bias.sub(avx2.wide(i64::MIN)).shifted::<20>().sub(avx2.wide(1 << 43));
    let mass = gap.pick(avx2.narrow(1 << 30), avx2.narrow(scales.soft[0])).factor();
    let eased = load.min(load.shifted::<2>().add(avx2.narrow(scales.firm)));
    let give = gap.pick(zero, avx2.narrow(scales.soft[1])).factor().mul(eased.factor());
    let opens = mass.mul(bias.low()).add(give);
    let pushes = avx2.wide(PUSHES).above(opens).mask();
    let pushes = pushes.or(avx2.narrow(LOAD as i32).above(load)).and(zero.above(way));
    // Below 2³¹.
    let speed = speed.round_limited(avx2).factor();
    let answer = mass.mul(speed).add(opens.max(avx2.wide(scales.least_opens()))).round::<30>(avx2).narrow();
    (load.sub(answer).min(most).max(zero), pushes)
}

/// `Block::give`: changes of the impulses of friction and of both points, to the bodies.
#[inline(always)]
fn give(avx2: Avx2, block: &Block, [mut a, mut b]: [Eight; 2], [slide, first, second]: [Factor; 3]) -> [Eight; 2] {
    let (f, [p, q]) = (&block.friction, &block.points);
    let push = avx2.factor(&p.line).mul(first).add(avx2.factor(&q.line).mul(second)).round::<28>(avx2);
    let drag = avx2.factor(&f.line).mul(slide).round::<28>(avx2);
    (a.v, a.w) =
        (push_along(avx2, &block.reply[0], a.v, push, drag), a.w.add(turn(avx2, block, 0, [slide, first, second])));
    (b.v, b.w) =
        (push_along(avx2, &block.reply[1], b.v, push, drag), b.w.sub(turn(avx2, block, 1, [slide, first, second])));
    [a.held(avx2), b.held(avx2)]
}

/// A velocity after pushes along the normal and the tangent.
#[inline(always)]
fn push_along(avx2: Avx2, reply: &[Lane; 2], v: [Wide; 2], push: Factor, drag: Factor) -> [Wide; 2] {
    let [x, y] = [avx2.factor(&reply[0]), avx2.factor(&reply[1])];
    [v[0].add(x.mul(push).sub(y.mul(drag))), v[1].add(y.mul(push).add(x.mul(drag)))]
}

/// What impulses add to the rim's speed of a body.
#[inline(always)]
fn turn(avx2: Avx2, block: &Block, body: usize, [slide, first, second]: [Factor; 3]) -> Wide {
    let (f, [p, q]) = (&block.friction, &block.points);
    let turn = avx2.factor(&p.turn[body]).mul(first).add(avx2.factor(&q.turn[body]).mul(second));
    avx2.factor(&f.turn[body]).mul(slide).add(turn)
}
