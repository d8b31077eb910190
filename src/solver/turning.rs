//! Contacts of bodies that turn fast: where a wall turns, its direction and the arms of its points are not those of the
//! tick's beginning for long, so these rows are made anew in each substep, from where their bodies are then.

use super::flight::State;
use super::mobility::Mobility;
use super::mover::{Mover, Movers};
use super::prepare::Joint;
use super::rows::Block;
use super::scales::Scales;
use crate::body::{Bodies, Colliders};
use crate::contact::{Contact, Pair};
use crate::geom::Rot;
use crate::narrow::collide;
use crate::num::{Angle, mul};
use crate::shape::Placed;

/// What turning may move a contact by beside its row until it is made anew: 1 mm in a tick, Q32 m.
const BESIDE: i64 = 4_294_967;
/// Slower than this nothing turns fast: 1/16 rad/s, Q48.
const SLOW: i64 = 1 << 44;

/// Whether a pair turns so fast that its rows would be beside its contact before the tick ends: by the turn times the way,
/// for a direction turns while points slide along it, and rims curve.
pub(super) fn turns(pair: &Pair, bodies: &Bodies, mobilities: &[Mobility], scales: &Scales) -> bool {
    let omega = pair.bodies.map(|slot| bodies.omega.get(slot as usize).to_bits().saturating_abs());
    let most = omega[0].saturating_add(omega[1]);
    if most < SLOW {
        return false;
    }
    let [a, b] = pair.bodies.map(|slot| bodies.velocity(slot as usize));
    let rim = |body: usize| mul(omega[body], mobilities[pair.bodies[body] as usize].reach, 32);
    let line = |a: i64, b: i64| a.saturating_sub(b).saturating_abs();
    let speed = line(a.x.to_bits(), b.x.to_bits())
        .saturating_add(line(a.y.to_bits(), b.y.to_bits()))
        .saturating_add(rim(0))
        .saturating_add(rim(1));
    // Q32 radians and Q32 m a tick.
    let [turn, way] = [most, speed].map(|rate| mul(rate, scales.margins.tick, 79));
    mul(turn, way, 33) > BESIDE << scales.shift
}

/// What of a tick it takes to make rows anew.
pub(super) struct Turning<'s> {
    pub(super) bodies: &'s Bodies,
    pub(super) colliders: &'s Colliders,
    pub(super) mobilities: &'s [Mobility],
    pub(super) scales: &'s Scales,
    /// By mover: where the tick began.
    pub(super) before: &'s [[i64; 6]],
}

impl Turning<'_> {
    /// Makes the rows of a pair anew, in a substep that has begun, by where its middle finds them as they go now: a
    /// direction of the beginning would let a wall of 300 m/s² in by 4 mm a tick. Impulses of points that are still there
    /// go on, along the direction that the contact has then.
    pub(super) fn renew(&self, pair: &mut Pair, places: [u32; 2], block: &mut Block, i: usize, movers: &mut Movers) {
        if block.is_retired(i) {
            return;
        }
        let ids = pair.manifold.points.map(|point| point.id);
        let old = Contact { count: pair.manifold.count, ids, ..block.carried(i) };
        let [(a, at_a), (b, at_b)] = [0, 1].map(|body: usize| self.half_on(pair.bodies[body], places[body], movers));
        let placed = |body: usize, state: &State| {
            let outline = self.colliders.outline(pair.colliders[body] as usize);
            Placed::new(outline, Rot::new(Angle::from_bits(state.angle)))
        };
        let between = [0, 1].map(|axis: usize| at_b.x[axis].saturating_sub(at_a.x[axis]));
        pair.met |= block.spent(i);
        pair.manifold = collide(&placed(0, &at_a), &placed(1, &at_b), between, self.scales.margins.base);
        let joint = Joint::new(pair, places, between, pair.bodies.map(|slot| &self.mobilities[slot as usize]));
        block.renew(i, &mut movers.lanes, [&a, &b], |block| joint.write(block, i, &old, pair.friction, self.scales));
    }

    /// A body in the middle of the substep.
    fn half_on(&self, slot: u32, place: u32, movers: &Movers) -> (Mover, State) {
        let at = slot as usize;
        if place == 0 {
            let x = [self.bodies.x.bits()[at], self.bodies.y.bits()[at]];
            let angle = self.bodies.angle.get(at).to_bits();
            return (Mover::default(), State { x, angle, ..State::default() });
        }
        let [x, y, angle, ..] = self.before[place as usize];
        let begin = State { x: [x, y], angle, ..State::default() };
        movers.half_on(place, &begin, &self.mobilities[at], self.scales)
    }
}
