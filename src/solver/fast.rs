//! Which pairs come together so fast that they strike, instead of being pressed together by rows.

use super::mobility::Mobility;
use super::scales::{Scales, weight};
use crate::body::Bodies;
use crate::contact::Pair;
use crate::motion::Drive;
use crate::num::{cross, dot, mul};

/// No less than the speed at which the points of a pair come together, with what forces add, Q40 m/s: directions left out,
/// for pairs that are clearly slower than what strikes.
#[inline(always)]
fn fastest(pair: &Pair, bodies: &Bodies, drive: &Drive, scales: &Scales) -> u64 {
    let [a, b] = pair.bodies.map(|slot| slot as usize);
    // Magnitudes over 2^SHIFT, rounded up, so that their sums fit: of 2⁶³ at most.
    const fn over<const SHIFT: u32>(magnitude: u64) -> u64 {
        (magnitude >> SHIFT).saturating_add(1)
    }
    let apart = |c: &[i64]| over::<8>(c[a].abs_diff(c[b]));
    let gain = |[x, y]: [i64; 2]| over::<8>(x.unsigned_abs()).saturating_add(over::<8>(y.unsigned_abs()));
    // Arms in Q16, turning in Q24.
    let length = |[x, y]: [i64; 2]| over::<16>(x.unsigned_abs()).saturating_add(over::<16>(y.unsigned_abs()));
    let [first, second] = &pair.manifold.points;
    let arm = length(first.arm).max(length(second.arm));
    let between = |c: &[i64]| over::<16>(c[a].abs_diff(c[b]));
    let (x, y) = (between(bodies.x.bits()), between(bodies.y.bits()));
    let turning = |slot: usize, arm: u64| over::<24>(bodies.omega.bits()[slot].unsigned_abs()).saturating_mul(arm);
    apart(bodies.vx.bits())
        .saturating_add(apart(bodies.vy.bits()))
        .saturating_add(gain(drive.gain(a, scales.margins.tick)))
        .saturating_add(gain(drive.gain(b, scales.margins.tick)))
        .saturating_add(turning(a, arm))
        .saturating_add(turning(b, arm.saturating_add(x).saturating_add(y)))
}

/// Whether a near pair turns so fast, and nothing presses it together, that another corner may swing in across the gap, of
/// which rows would not know. Under forces rows have it all the same: what is to come to rest must be theirs.
pub(super) fn swings(pair: &Pair, bodies: &Bodies, drive: &Drive, mobilities: &[Mobility], scales: &Scales) -> bool {
    let rim = |slot: u32| {
        let omega = bodies.omega.get(slot as usize).to_bits().saturating_abs();
        mul(omega, mobilities[slot as usize].reach, 32)
    };
    let points = &pair.manifold.points[..pair.manifold.count as usize];
    points.iter().all(|point| point.separation > scales.touching)
        && rim(pair.bodies[0]).saturating_add(rim(pair.bodies[1])) > scales.swinging()
        && pair.bodies.iter().all(|&slot| drive.gain(slot as usize, scales.margins.tick) == [0; 2])
}

/// Whether a near pair comes together so fast that it strikes.
#[inline(always)]
pub(super) fn strikes(pair: &Pair, bodies: &Bodies, drive: &Drive, scales: &Scales, among: bool) -> bool {
    // Without restitution the threshold is the same whatever presses.
    let least = scales.threshold(0, 0, among).unsigned_abs() >> 8;
    let slow = pair.restitution == 0 && fastest(pair, bodies, drive, scales) <= least;
    debug_assert!(!slow || !comes_fast(pair, bodies, drive, scales, among), "a bound of the speed is below it");
    !slow && comes_fast(pair, bodies, drive, scales, among)
}

/// The same by the directions and arms of its points.
#[inline(never)]
fn comes_fast(pair: &Pair, bodies: &Bodies, drive: &Drive, scales: &Scales, among: bool) -> bool {
    let [a, b] = pair.bodies.map(|slot| slot as usize);
    let (va, vb) = (bodies.velocity(a), bodies.velocity(b));
    let v = [va.x.to_bits().saturating_sub(vb.x.to_bits()), va.y.to_bits().saturating_sub(vb.y.to_bits())];
    let omega = [a, b].map(|at| bodies.omega.get(at).to_bits());
    let gain = [a, b].map(|at| drive.gain(at, scales.margins.tick));
    let between = |c: &[i64]| c[b].saturating_sub(c[a]);
    let between = [between(bodies.x.bits()), between(bodies.y.bits())];
    let n = pair.manifold.normal.map(i64::from);
    let press = gain.map(|gain| dot(gain, n, 30));
    let mut closest = i64::MAX;
    let mut slowest = i64::MAX;
    for point in &pair.manifold.points[..pair.manifold.count as usize] {
        let other = [point.arm[0].saturating_sub(between[0]), point.arm[1].saturating_sub(between[1])];
        let turning = |omega: i64, arm: [i64; 2]| mul(omega, cross(arm, n, 30), 32);
        let speed = dot(v, n, 30).saturating_add(turning(omega[0], point.arm)).saturating_sub(turning(omega[1], other));
        closest = closest.min(point.separation);
        slowest = slowest.min(speed);
    }
    let weight = weight(gain[0]).max(weight(gain[1]));
    let threshold = scales.threshold(pair.restitution, weight, among);
    // Across a gap forces make it faster; what rests is pressed by them and does not strike.
    let (gap, pressed) = (closest > scales.touching, press[1].saturating_sub(press[0]).max(0));
    let fast = slowest.min(0).saturating_neg().saturating_add(if gap { pressed } else { 0 }) > threshold;
    // What parts needs no row in this tick, which would stop what turns it about, or another corner that swings in.
    let parts = slowest.saturating_sub(pressed) > scales.parting(pair.restitution, gap, threshold, weight);
    (fast || parts) && closest > scales.slack.saturating_neg()
}
