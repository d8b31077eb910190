//! Boxes around the ways of bodies in a tick.

use crate::body::Bodies;
use crate::geom::{Aabb, Vec2};
use crate::motion::Drive;
use crate::num::{Length, add_sat, mul};

/// A velocity's way in a tick, Q32 m.
pub(super) fn way(velocity: i64, tick: i64) -> i64 {
    mul(velocity, tick, 48 + 63 - 32)
}

/// The speed of a point at `reach` of a body that turns with `omega`, Q48 m/s.
pub(super) fn rim_speed(omega: i64, reach: i64) -> i64 {
    mul(omega.saturating_abs(), reach, 32)
}

/// The box from `min` to `max` about a point.
pub(super) fn around(point: Vec2<Length>, min: [i64; 2], max: [i64; 2]) -> Aabb {
    let at = |p: Length, by: i64| Length::from_bits(p.to_bits().saturating_add(by));
    Aabb {
        min: Vec2::new(at(point.x, min[0]), at(point.y, min[1])),
        max: Vec2::new(at(point.x, max[0]), at(point.y, max[1])),
    }
}

/// The box around a box from `min` to `max` about a body and its way in this tick.
// Where it is called and not copied, a body that moves freely takes 5 % longer.
#[inline(always)]
pub(super) fn sweep(bodies: &Bodies, drive: &Drive, body: usize, min: [i64; 2], max: [i64; 2], tick: i64) -> Aabb {
    let v = [bodies.vx.bits()[body], bodies.vy.bits()[body]];
    along(bodies.position(body), v, drive.gain(body, tick), min, max, tick)
}

/// The box around a box from `min` to `max` about a point that moves for a tick: with a velocity and what it gains, Q48.
pub(super) fn along(at: Vec2<Length>, v: [i64; 2], gain: [i64; 2], min: [i64; 2], max: [i64; 2], tick: i64) -> Aabb {
    // A parabola lies within the triangle of its ends and where its first velocity leads in half of the tick.
    let half = v.map(|v| way(v, tick) / 2);
    let whole = [0, 1].map(|axis: usize| way(add_sat(v[axis], gain[axis] / 2), tick));
    let stretch = |bound: [i64; 2], pick: fn(i64, i64) -> i64| {
        let out = |axis: usize| bound[axis].saturating_add(pick(pick(half[axis], whole[axis]), 0));
        [out(0), out(1)]
    };
    around(at, stretch(min, i64::min), stretch(max, i64::max))
}

/// About how far the bodies go together in this tick: a hint for the broad phase.
pub(super) fn common_way(bodies: &Bodies, tick: i64) -> [i64; 2] {
    let mean = |column: &[i64]| {
        let awake = bodies.rest.all_runs().flat_map(|run| &column[run]);
        let (sum, moving) = awake
            .filter(|&&v| v != 0)
            .fold((0i128, 0i128), |(sum, n), &v| (sum.saturating_add(v.into()), n.saturating_add(1)));
        sum.checked_div(moving).unwrap_or(0) as i64
    };
    [way(mean(bodies.vx.bits()), tick), way(mean(bodies.vy.bits()), tick)]
}
