//! Contacts of bodies that turn fast: where a wall turns, its direction and the arms of its points are not those of the
//! tick's beginning for long, so these rows are made anew in each substep, from where their bodies are then.

use super::flight::State;
use super::mobility::Mobility;
use super::mover::{Movers, TURNS};
use super::prepare::Joint;
use super::rows::Block;
use super::scales::Scales;
use crate::body::{Bodies, Colliders};
use crate::contact::{Contact, Pair};
use crate::geom::{Rot, Vec2};
use crate::narrow::{Manifold, collide};
use crate::num::{Angle, Length, cross, dot, mul};
use crate::shape::Placed;

/// By how much turning may move a contact beside its row in a tick, Q32 m: 1 mm where a body turns that no contact stops,
/// tick after tick; 8 mm else, which what tumbles in piles stays below.
const BESIDE: [i64; 2] = [4_294_967, 34_359_738];

/// Whether a pair turns so fast that its rows would be beside its contact before the tick ends: by the turn times the way,
/// for a direction turns while points slide along it, and rims curve.
pub(super) fn turns(pair: &Pair, bodies: &Bodies, mobilities: &[Mobility], scales: &Scales) -> bool {
    let omega = pair.bodies.map(|slot| bodies.omega.get(slot as usize).to_bits().saturating_abs());
    if omega[0].saturating_add(omega[1]).unsigned_abs() < TURNS {
        return false;
    }
    let mobility = pair.bodies.map(|slot| &mobilities[slot as usize]);
    let [a, b] = pair.bodies.map(|slot| bodies.velocity(slot as usize));
    let rim = |body: usize| mul(omega[body], mobility[body].reach, 32);
    let line = |a: i64, b: i64| a.saturating_sub(b).saturating_abs();
    let (x, y) = (line(a.x.to_bits(), b.x.to_bits()), line(a.y.to_bits(), b.y.to_bits()));
    let speed = x.saturating_add(y).saturating_add(rim(0)).saturating_add(rim(1));
    (0..2).any(|body| {
        // Q32 radians and Q32 m a tick; and nothing of a body goes farther than across it.
        let [turn, way] = [omega[body], speed].map(|rate| mul(rate, scales.margins.tick, 79));
        let beside = mul(turn, way, 33).min(mobility[body].reach << 1);
        beside > BESIDE[usize::from(mobility[body].moves())] << scales.shift
    })
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
    /// Makes the rows of a pair anew, in a substep that has begun. Impulses of points that are still there go on, along the
    /// direction that the contact has now.
    #[cold]
    #[inline(never)]
    pub(super) fn renew(&self, pair: &mut Pair, places: [u32; 2], block: &mut Block, i: usize, movers: &mut Movers) {
        if block.is_retired(i) {
            return;
        }
        let ids = pair.manifold.points.map(|point| point.id);
        let old = Contact { count: pair.manifold.count, ids, ..block.carried(i) };
        let states = [0, 1].map(|body: usize| self.state(pair.bodies[body], places[body], movers));
        let [a, b] = [0, 1].map(|body: usize| {
            let outline = self.colliders.outline(pair.colliders[body] as usize);
            Placed::new(outline, Rot::new(Angle::from_bits(states[body].angle)))
        });
        let between = [0, 1].map(|axis: usize| states[1].x[axis].saturating_sub(states[0].x[axis]));
        pair.met |= block.spent(i);
        pair.manifold = collide(&a, &b, between, self.reach(pair, &states));
        let betweens = self.half_on(&mut pair.manifold, [&a, &b], &states, between);
        let joint = Joint::new(pair, places, betweens, pair.bodies.map(|slot| &self.mobilities[slot as usize]));
        block.renew(i, &mut movers.lanes, |block| joint.write(block, i, &old, pair.friction, self.scales));
    }

    /// What may be met in the substep.
    fn reach(&self, pair: &Pair, [a, b]: &[State; 2]) -> i64 {
        let rim = |body: usize, state: &State| {
            mul(state.omega.saturating_abs(), self.mobilities[pair.bodies[body] as usize].reach, 32)
        };
        let line = |axis: usize| a.v[axis].saturating_sub(b.v[axis]).saturating_abs();
        let speed = line(0).saturating_add(line(1)).saturating_add(rim(0, a)).saturating_add(rim(1, b));
        self.scales.margins.base.saturating_add(mul(speed, self.scales.line, 79))
    }

    /// Turns a contact on to the middle of the substep: rows are straight, and with the direction of its beginning a wall
    /// that goes round with 300 m/s² would come in by 4 mm a tick. The direction turns with the edge's body, along whose
    /// edge the other's point slides. For each point, from a's centre to b's as its arms have it.
    fn half_on(
        &self,
        manifold: &mut Manifold,
        placed: [&Placed; 2],
        states: &[State; 2],
        between: [i64; 2],
    ) -> [[i64; 2]; 2] {
        let sides = [manifold.normal.map(i32::saturating_neg), manifold.normal];
        let owns = |body: usize| placed[body].normals[..placed[body].count.into()].contains(&sides[body]);
        // Beside a corner the direction turns away from it, which is left out. A circle has no normals.
        let edge = [1, 0].into_iter().find(|&body| placed[body].count > 1 && owns(body));
        let turned = |body: usize, v: [i64; 2]| {
            let half = mul(states[body].omega, self.scales.turn, 64);
            let Vec2 { x, y } =
                Rot::new(Angle::from_bits(half)).rotate(Vec2::new(Length::from_bits(v[0]), Length::from_bits(v[1])));
            [x.to_bits(), y.to_bits()]
        };
        let n = manifold.normal.map(i64::from);
        let t = [n[1].saturating_neg(), n[0]];
        let then = edge.map_or(n, |edge| turned(edge, n));
        manifold.normal = then.map(|c| c as i32);
        let mut betweens = [between; 2];
        for (point, between) in manifold.points[..manifold.count.into()].iter_mut().zip(&mut betweens) {
            let arms = [point.arm, [0, 1].map(|axis: usize| point.arm[axis].saturating_sub(between[axis]))];
            let arm = |body: usize| {
                if edge == Some(body) {
                    return self.slid(body, arms, states, t);
                }
                // Of a circle its centre goes round.
                let radius = if body == 0 { placed[body].radius } else { placed[body].radius.saturating_neg() };
                let center = [0, 1].map(|axis: usize| arms[body][axis].saturating_add(mul(radius, n[axis], 30)));
                let center = turned(body, center);
                [0, 1].map(|axis: usize| center[axis].saturating_sub(mul(radius, then[axis], 30)))
            };
            let arms = [arm(0), arm(1)];
            point.arm = arms[0];
            *between = [0, 1].map(|axis: usize| arms[0][axis].saturating_sub(arms[1][axis]));
        }
        betweens
    }

    /// The arm of an edge's body to a point that slides along the edge for half of the substep.
    fn slid(&self, edge: usize, arms: [[i64; 2]; 2], states: &[State; 2], t: [i64; 2]) -> [i64; 2] {
        let (own, other) = (&states[edge], &states[1 ^ edge]);
        let slide = dot(other.v, t, 30)
            .saturating_add(mul(other.omega, cross(arms[1 ^ edge], t, 30), 32))
            .saturating_sub(dot(own.v, t, 30));
        let way = mul(slide, self.scales.line, 80);
        [0, 1].map(|axis: usize| arms[edge][axis].saturating_add(mul(way, t[axis], 30)))
    }

    /// Where a body is now, and how it moves.
    fn state(&self, slot: u32, place: u32, movers: &Movers) -> State {
        let at = slot as usize;
        if place == 0 {
            let x = [self.bodies.x.bits()[at], self.bodies.y.bits()[at]];
            return State { x, angle: self.bodies.angle.get(at).to_bits(), ..State::default() };
        }
        let [x, y, angle, ..] = self.before[place as usize];
        let begin = State { x: [x, y], angle, ..State::default() };
        movers.now(place, &begin, &self.mobilities[at], self.scales)
    }
}
