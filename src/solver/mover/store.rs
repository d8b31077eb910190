//! Where contacts brought the bodies that they pushed.

use super::Movers;
use crate::body::Bodies;
use crate::geom::Vec2;
use crate::motion::{Bound, Fault, turn_by};
use crate::num::{Angle, AngularVelocity, Length, Quantity, Velocity, add_sat, clamp_i64, mul};
use crate::solver::mobility::Mobility;
use crate::solver::scales::Scales;

impl Movers {
    /// What contacts made of the bodies that they pushed, instead of what free motion did. Bodies that nothing pushed
    /// keep that, which is exact, unless they are faster than the rows can follow.
    pub(crate) fn store(
        &self,
        bodies: &mut Bodies,
        before: &[[i64; 6]],
        mobilities: &[Mobility],
        scales: &Scales,
        faults: &mut Vec<Fault>,
    ) {
        for ((mover, course), before) in self.lanes.iter().zip(&self.courses).zip(before).skip(1) {
            let slot = course.slot as usize;
            let mobility = &mobilities[slot];
            if !(course.hit || course.slowed) || !mobility.moves() || bodies.rest.is_asleep(slot) {
                continue;
            }
            if course.slowed {
                faults.push(Fault { slot, bound: Bound::ContactSpeed });
            }
            let k = scales.shift;
            let sum = course.sum;
            let [x, y, angle, vx, vy, omega] = *before;
            let mut place = |from: i64, sum: i64| {
                let moved = from.saturating_add(mul(sum, scales.line, 51u32.saturating_sub(k)));
                let kept = moved.clamp(Length::MIN.to_bits(), Length::MAX.to_bits());
                if kept != moved {
                    faults.push(Fault { slot, bound: Bound::Position });
                }
                Length::from_bits(kept)
            };
            let position = Vec2::new(place(x, sum[0]), place(y, sum[1]));
            bodies.set_position(slot, position);
            // φ/2π in 2^k m with 50 fraction bits, then over σ as turns with 48.
            let rolled = mul(sum[2], scales.turn, 33);
            let (turned, over) = turn_by(angle, mobility.over_sigma(rolled, 50u32.saturating_sub(k), 48));
            bodies.angle.set(slot, Angle::from_bits(turned));
            if over {
                faults.push(Fault { slot, bound: Bound::Turns });
            }
            let line = |from: i64, start: i64, end: i64| {
                let change = i128::from(end).saturating_sub(start.into()) << k;
                clamp_i64(i128::from(from).saturating_add(change))
            };
            let v = [line(vx, course.start[0], mover.v[0]), line(vy, course.start[1], mover.v[1])];
            bodies.set_velocity(slot, Vec2::new(Velocity::from_bits(v[0]), Velocity::from_bits(v[1])));
            let spun = mobility.over_sigma(mover.w.saturating_sub(course.start[2]), 48u32.saturating_sub(k), 48);
            bodies.omega.set(slot, AngularVelocity::from_bits(add_sat(omega, spun)));
        }
    }
}
