//! Times of first touch against closed forms and against a search by small steps.

use super::*;
use crate::narrow::{Clearance, Motion};
use crate::num::{TURN_PER_RADIAN_Q64, hypot, sqrt};
use crate::shape::Outline;

/// A tick.
pub(super) const TICK: i64 = 1 << 32;
/// 1 mm.
pub(super) const MM: i64 = M / 1000;
/// 1e-7 m.
pub(super) const TOUCH: i64 = 430;

/// mm/s at 60 ticks a second, Q40 m per tick; mrad/s likewise.
pub(super) fn speed(v: i64) -> i64 {
    (i128::from(v) * (1 << 40) / 60_000) as i64
}

pub(super) fn speeds(v: [i64; 2]) -> [i64; 2] {
    v.map(speed)
}

/// mm/s² likewise.
pub(super) fn acceleration(a: i64) -> i64 {
    speed(a) / 60
}

/// What is placed with its own axes along the world's.
pub(super) fn outline(placed: &Placed) -> Outline {
    let far = |v: &[i64; 2]| hypot(v[0], v[1]) as i64;
    let far = placed.vertices[..usize::from(placed.count)].iter().map(far).max().unwrap();
    let &Placed { count, vertices, normals, radius, .. } = placed;
    let slack = if far == 0 { 0 } else { (far >> 29) + 2 };
    Outline { count, vertices, normals, radius, reach: far + slack + radius }
}

pub(super) fn disc(radius: i64) -> Outline {
    outline(&circle([0, 0], radius))
}

pub(super) fn block(width: i64, height: i64) -> Outline {
    outline(&rectangle(width, height, 0))
}

/// Where they are at a time.
pub(super) fn pose(pair: [&Outline; 2], motion: &Motion, time: i64) -> ([Placed; 2], [i64; 2]) {
    let way = |v: i64, a: i64| {
        let twice = i128::from(v) * i128::from(TICK) * 2 + i128::from(a) * i128::from(time);
        // Q72 and one for the half; in steps that do not overflow.
        ((twice >> 16) * i128::from(time)) >> 17
    };
    let d = [0, 1].map(|at| motion.d[at] + (way(motion.v[at], motion.a[at]) >> 40) as i64);
    let angle = |body: usize| {
        let turned = (way(motion.omega[body], motion.alpha[body]) >> 10) * (TURN_PER_RADIAN_Q64 >> 30);
        motion.angle[body].wrapping_add((turned >> (72 - 10 + 34 - 48)) as i64)
    };
    let placed = |body: usize| Placed::new(pair[body], Rot::new(Angle::from_bits(angle(body))));
    ([placed(0), placed(1)], d)
}

/// How far apart they are, Q32 m, as far as edges decide, and with a circle exactly.
pub(super) fn separation([a, b]: &[Placed; 2], d: [i64; 2]) -> i64 {
    let over = |own: &Placed, other: &Placed, d: [i64; 2]| {
        let corners = &other.vertices[..usize::from(other.count)];
        let height = |edge: usize, q: [i64; 2]| {
            let [n, from] = [own.normals[edge].map(i128::from), own.vertices[edge].map(i128::from)];
            let term = |at: usize| n[at] * (i128::from(q[at] + d[at]) - from[at]);
            ((term(0) + term(1)) >> 30) as i64 - other.radius
        };
        let edges = if own.count > 1 { usize::from(own.count) } else { 0 };
        (0..edges).map(|edge| corners.iter().map(|&q| height(edge, q)).min().unwrap()).max().unwrap_or(i64::MIN)
    };
    let edges = over(a, b, d).max(over(b, a, negated(d)));
    let apart = |p: [i64; 2], q: [i64; 2]| hypot(q[0] + d[0] - p[0], q[1] + d[1] - p[1]) as i64 - a.radius - b.radius;
    if a.count > 1 && b.count > 1 {
        return edges;
    }
    if a.count <= 1 && b.count <= 1 {
        return apart(a.vertices[0], b.vertices[0]);
    }
    let (center, polygon, d, radius) =
        if a.count <= 1 { (a.vertices[0], b, negated(d), a.radius) } else { (b.vertices[0], a, d, b.radius) };
    let center = [center[0] + d[0], center[1] + d[1]];
    let (_, distance) = closest(polygon, center);
    if distance > 0 { distance - radius } else { edges }
}

pub(super) fn gap(pair: [&Outline; 2], motion: &Motion, time: i64) -> i64 {
    let (placed, d) = pose(pair, motion, time);
    separation(&placed, d)
}

fn first_touch(a: &Outline, b: &Outline, motion: &Motion, until: i64, closing: i64, slack: i64) -> Option<i64> {
    crate::narrow::first_touch(a, b, motion, until, closing, slack, &mut Clearance::default())
}

/// The same by exchange and by half a turn.
pub(super) fn same(pair: [&Outline; 2], motion: &Motion, until: i64, closing: i64, slack: i64) -> Option<i64> {
    let found = first_touch(pair[0], pair[1], motion, until, closing, slack);
    let &Motion { d, v, a, angle, omega, alpha } = motion;
    let [d, v, a] = [d, v, a].map(negated);
    let turned = Motion { d, v, a, angle: angle.map(|angle| angle + (1 << 47)), omega, alpha };
    assert_eq!(first_touch(pair[0], pair[1], &turned, until, closing, slack), found, "turned {motion:?}");
    let swap = |pair: [i64; 2]| [pair[1], pair[0]];
    let mirror = Motion { d, v, a, angle: swap(angle), omega: swap(omega), alpha: swap(alpha) };
    let exchanged = first_touch(pair[1], pair[0], &mirror, until, closing, slack);
    if omega == [0; 2] || pair[0].count > 1 || pair[1].count > 1 {
        assert_eq!(exchanged, found, "exchanged {motion:?}");
    }
    found
}

/// √ of a Q64 number, Q32.
fn root(value: i128) -> i128 {
    i128::from(sqrt(value.max(0) as u128))
}

#[test]
fn a_box_falls_onto_a_floor_at_the_time_of_the_closed_form() {
    let (floor, fallen) = (block(20 * M, M), block(M, M));
    let mut noise = Noise(21);
    let mut worst = 0;
    for _ in 0..2000 {
        let (gap, v) = (noise.within(1, 200 * MM), speed(noise.within(-20_000, 0)));
        let a = acceleration(-9810);
        let motion = Motion {
            d: [noise.within(-9 * M, 9 * M), M + gap],
            v: [speed(noise.within(-500, 500)), v],
            a: [0, a],
            ..Motion::default()
        };
        // gap + v·τ + ½·a·τ² = 0 in Q40: τ = (v + √(v² − 2·a·gap))/−a, or 2·gap over the difference.
        let (v, a) = (i128::from(v), i128::from(a));
        let discriminant = v * v - 2 * a * (i128::from(gap) << 8);
        let exact = (i128::from(gap) << 8 << 1 << 32) / (root(discriminant) - v).max(1);
        let found = same([&floor, &fallen], &motion, TICK, 0, 0);
        if exact > i128::from(TICK) + 2 {
            assert_eq!(found, None);
        } else if exact < i128::from(TICK) - 2 {
            let late = i128::from(found.expect("touches")) - exact;
            if gap > TOUCH {
                worst = worst.max(late.abs());
                assert!((-2..=1).contains(&late), "{late}: {motion:?}");
            }
        }
    }
    println!("worst {worst} of 2^-32 tick");
}

#[test]
fn discs_meet_when_the_quadratic_says() {
    let mut noise = Noise(23);
    let (mut hits, mut worst) = (0, 0);
    for _ in 0..4000 {
        let radii = [0; 2].map(|_| noise.within(M / 100, 2 * M));
        let (a, b) = (disc(radii[0]), disc(radii[1]));
        let sum = radii[0] + radii[1];
        let (away, v) = (noise.within(sum + 1000, 2 * sum), noise.within(1000, 200_000));
        let (d, v) = (noise.around(away), noise.around(speed(v)));
        let motion = Motion { d, v, ..Motion::default() };
        let found = same([&a, &b], &motion, TICK, 0, 0);
        // |d + v·τ| = r, lengths Q32 and speeds Q40, both cut so that squares of squares fit.
        let [d, v, r] = [d.map(i128::from), v.map(i128::from), [i128::from(sum), 0]];
        let inner = |a: [i128; 2], b: [i128; 2]| a[0] * b[0] + a[1] * b[1];
        let (vv, dv, out) = (inner(v, v) >> 40, -inner(d, v) >> 36, (inner(d, d) - inner(r, r)) >> 32);
        // Q40, Q36, Q32: τ = (dv − √(dv² − vv·out))/vv.
        let square = dv * dv - vv * out;
        let exact = ((dv - root(square)) << 36).checked_div(vv).unwrap_or(-1);
        if square > 1 << 40 && dv > 0 && exact < i128::from(TICK) - 64 {
            let found = i128::from(found.expect("touch"));
            hits += 1;
            // Along the normal, in units of 2⁻³² m.
            let closing = root(square) * (1 << 28) / i128::from(sum);
            let early = ((exact - found) * closing) >> 32;
            worst = worst.max(early.abs());
        } else if square < -(1 << 40) || dv < 0 {
            assert_eq!(found, None, "{motion:?}");
        }
    }
    println!("{hits} hits, {worst} of 2^-32 m off");
    assert!(hits > 500 && worst <= i128::from(TOUCH));
}

#[test]
fn a_disc_that_passes_a_corner_does_not_touch_it() {
    let (wall, disc) = (block(2 * M, 2 * M), disc(100 * MM));
    let v = speeds([100_000, -50_000]);
    // The corner at (1, 1); at its nearest the centre is at this distance up and to the right of it, and 0.3 m on at
    // time ½.
    let at = |distance: i64| {
        // (1, 2)/√5.
        let (x, y) = (mul(distance, 480_191_942, 30), mul(distance, 960_383_885, 30));
        let d = [M + x - v[0] / 512, M + y - v[1] / 512];
        same([&wall, &disc], &Motion { d, v, ..Motion::default() }, TICK, 0, 0)
    };
    assert_eq!(at(400 * MM), None);
    assert_eq!(at(100 * MM + M / 100_000), None);
    assert_eq!(at(100 * MM + 2 * TOUCH), None);
    let grazing = at(100 * MM - 2 * TOUCH).expect("touches");
    assert!((TICK / 2 - TICK / 500..=TICK / 2).contains(&grazing), "{grazing}");
    assert!(at(50 * MM).is_some() && at(-50 * MM).is_some());
}

#[test]
fn at_corners_all_axes_have_to_close() {
    let (a, b) = (block(M, M), block(M, M));
    let at = |v: [i64; 2], closing: i64| {
        let motion = Motion { d: [M + 100, M + 100], v: speeds(v), ..Motion::default() };
        same([&a, &b], &motion, TICK, speed(closing), 0)
    };
    assert_eq!(at([-1000, -1000], 0), Some(0));
    assert_eq!(at([-1000, 1000], 0), None);
    assert_eq!(at([1000, -1000], 0), None);
    assert_eq!(at([-1000, 0], 0), None);
    assert_eq!(at([-1000, -10], 20), None);
    assert_eq!(at([-1000, -30], 20), Some(0));
    // Apart by 1 mm both ways they come to the corner at once; by different ways they may pass.
    let from = |gap: [i64; 2], v: [i64; 2]| {
        let d = gap.map(|gap| M + gap);
        same([&a, &b], &Motion { d, v: speeds(v), ..Motion::default() }, TICK, 0, 0)
    };
    let hit = from([MM, MM], [-1000, -1000]).expect("touches");
    assert!((hit - TICK * 60 / 1000).abs() <= 64);
    assert!(from([2 * MM, MM], [-1000, -1000]).is_some_and(|time| (time - 2 * TICK * 60 / 1000).abs() <= 64));
    assert_eq!(from([MM, -M + MM], [1000, 0]), None);
}

#[test]
fn a_box_slides_over_the_seams_of_a_floor() {
    let (tile, sliding) = (block(1000 * MM, 1000 * MM), block(500 * MM, 500 * MM));
    let sunk = MM / 5;
    let motion = Motion { d: [-770 * MM, 750 * MM - sunk], v: speeds([3000, 0]), ..Motion::default() };
    assert_eq!(same([&tile, &sliding], &motion, TICK, 0, MM), None);
    let hit = same([&tile, &sliding], &motion, TICK, 0, 0).expect("the side of the tile");
    assert!((hit - TICK * 20 * 60 / 3000).abs() <= 200, "{hit}");
    // It sinks more slowly than counts, until it is deeper than the slack.
    let sinking = Motion { v: speeds([3000, -100]), ..motion };
    assert_eq!(same([&tile, &sliding], &sinking, TICK, speed(200), MM), None);
    let sinking = Motion { v: speeds([3000, -150]), ..motion };
    let deep = same([&tile, &sliding], &sinking, TICK, speed(200), MM).expect("too deep");
    assert!((deep - hit).abs() <= 2, "{deep} {hit}");
    // At the side already, 0.9 mm deep: 0.1 mm later the top does not count any more.
    let beside = Motion { d: [-750 * MM - 100, 750 * MM - 9 * (MM / 10)], v: speeds([300, -150]), ..motion };
    let deep = same([&tile, &sliding], &beside, TICK, speed(200), MM).expect("too deep");
    assert!((deep - TICK / 25).abs() < TICK / 10_000, "{deep}");
    // A ball rolls over them, and what moves down is a touch of the floor.
    let ball = disc(250 * MM);
    let near = Motion { d: [-540 * MM, 750 * MM - sunk], ..motion };
    let rolling = Motion { omega: [0, speed(-12_000)], ..near };
    assert_eq!(same([&tile, &ball], &rolling, TICK, 0, MM), None);
    assert!(same([&tile, &ball], &near, TICK, 0, 0).is_some());
    let on = Motion { d: [0, 750 * MM - sunk], v: speeds([3000, -10]), ..Motion::default() };
    assert_eq!(same([&tile, &sliding], &on, TICK, 0, MM), Some(0));
    assert_eq!(same([&tile, &sliding], &on, TICK, speed(20), MM), None);
}

#[test]
fn deep_overlaps_belong_to_others() {
    let (a, b) = (block(M, M), disc(M));
    let motion = |d: [i64; 2]| Motion { d, v: speeds([-1000, -1000]), ..Motion::default() };
    for pair in [[&a, &a], [&a, &b], [&b, &b]] {
        assert_eq!(same(pair, &motion([M / 2, M / 4]), TICK, 0, 0), None);
        assert_eq!(same(pair, &motion([0, 0]), TICK, 0, 0), None);
    }
}

#[test]
fn a_time_after_the_end_is_none() {
    let (a, b) = (block(M, M), block(M, M));
    let motion = Motion { d: [2 * M, 0], v: [-(2 << 40), 0], ..Motion::default() };
    assert_eq!(same([&a, &b], &motion, TICK / 2 + 1, 0, 0), Some(TICK / 2 - 1));
    assert_eq!(same([&a, &b], &motion, TICK / 2 - 8, 0, 0), None);
    assert_eq!(same([&a, &b], &Motion { d: [M, 0], ..motion }, 0, 0, 0), Some(0));
    // Slower than counts, it is none; until it is fast enough.
    assert_eq!(same([&a, &b], &motion, TICK, 2 << 40, 0), None);
    let pushed = Motion { d: [M, 0], v: [0; 2], a: [-(1 << 40), 0], ..motion };
    assert_eq!(same([&a, &b], &pushed, TICK, 1 << 30, MM), Some((TICK >> 10) + 1));
}
