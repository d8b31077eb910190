//! Ways of bodies through a tick: free motion, or the motion of a substep, from one impact to the next.

use super::mobility::Mobility;
use super::mover::Movers;
use super::scales::Scales;
use crate::body::Bodies;
use crate::geom::{Aabb, Vec2};
use crate::motion::{Bound, Fault, turn_by};
use crate::narrow::Motion;
use crate::num::{Angle, AngularVelocity, Length, Quantity, Velocity, add_sat, mul};

/// A whole tick, of which times are parts: Q32.
pub(crate) const TICK: i64 = 1 << 32;
/// No place.
pub(crate) const NONE: u32 = u32::MAX;

/// Where a body is and how it moves.
///
/// | field | format |
/// |---|---|
/// | `x` | Q32 m, the centre of mass |
/// | `angle` | Q48 turns |
/// | `v`, `omega` | Q48 m/s, rad/s |
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct State {
    pub(crate) x: [i64; 2],
    pub(crate) angle: i64,
    pub(crate) v: [i64; 2],
    pub(crate) omega: i64,
}

/// A body's way from `time` to the end of the tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Flight {
    pub(crate) slot: u32,
    /// Its place among the movers; 0 if no row knows it.
    pub(crate) place: u32,
    /// Since when it moves so.
    pub(crate) time: i64,
    pub(crate) state: State,
    /// What forces add to x, y and turning in a whole tick, Q48 m/s and rad/s.
    pub(crate) gain: [i64; 3],
    /// That of lines, whatever holds the body.
    pub(crate) weight: [i64; 2],
    /// The first of the pairs in which it may be struck, or [`NONE`].
    pub(crate) first: u32,
    /// How often it was struck in this tick.
    pub(crate) strikes: u32,
    /// Whether it left its free way, struck or sent astray by rows; and then a box around its way since.
    pub(crate) aside: bool,
    pub(crate) around: Aabb,
    /// The number of the last answer after which its pairs were looked at, from 1 on.
    pub(crate) looked: u32,
    /// Whether the last answer that it took part in changed its velocities.
    pub(crate) changed: bool,
    /// Rows push it: its way is known to the end of the substep only.
    pub(crate) pushed: bool,
}

impl Flight {
    /// Where it is at a time that is not before its own. Rounding: once a coordinate (and 2⁻⁴⁰ m of a tick's way).
    pub(crate) fn at(&self, time: i64, scales: &Scales) -> State {
        let State { x, angle, v, omega } = self.state;
        let after = time.saturating_sub(self.time);
        if after == 0 {
            return self.state;
        }
        let gained = self.gain.map(|gain| mul(gain, after, 32));
        let turned = mul(mul(omega.saturating_add(gained[2] / 2), scales.tick_turn, 63), after, 32);
        State {
            x: [0, 1].map(|axis: usize| x[axis].saturating_add(way(v[axis], gained[axis], after, scales))),
            angle: turn_by(angle, turned).0,
            v: [add_sat(v[0], gained[0]), add_sat(v[1], gained[1])],
            omega: add_sat(omega, gained[2]),
        }
    }

    /// The same, its place alone.
    pub(crate) fn place_at(&self, time: i64, scales: &Scales) -> [i64; 2] {
        let after = time.saturating_sub(self.time);
        let gone = |axis: usize| way(self.state.v[axis], mul(self.gain[axis], after, 32), after, scales);
        [0, 1].map(|axis: usize| self.state.x[axis].saturating_add(gone(axis)))
    }

    /// Notes the box around its way, for a body of this reach. What rows know may yet be pushed aside a little.
    pub(crate) fn surround(&mut self, reach: i64, scales: &Scales) {
        let reach = reach.saturating_add(if self.place != 0 { scales.astray() } else { 0 });
        let (from, to) = (&self.state, self.at(TICK, scales));
        // A parabola lies within the triangle of its ends and where its first velocity leads in half of the time.
        let half = TICK.saturating_sub(self.time) / 2;
        let bound = |axis: usize| {
            let ahead = mul(mul(from.v[axis], scales.margins.tick, 71), half, 40).saturating_add(from.x[axis]);
            let (a, b) = (from.x[axis], to.x[axis]);
            let out = |at: i64, by: i64| Length::from_bits(at.saturating_add(by));
            (out(a.min(b).min(ahead), reach.saturating_neg()), out(a.max(b).max(ahead), reach))
        };
        let [(left, right), (low, high)] = [bound(0), bound(1)];
        self.around = Aabb { min: Vec2::new(left, low), max: Vec2::new(right, high) };
    }

    /// The box in which a body of this reach is at a time.
    pub(crate) fn box_at(&self, time: i64, reach: i64, scales: &Scales) -> Aabb {
        let x = self.place_at(time, scales);
        let out =
            |by: i64| Vec2::new(Length::from_bits(x[0].saturating_add(by)), Length::from_bits(x[1].saturating_add(by)));
        Aabb { min: out(reach.saturating_neg()), max: out(reach) }
    }
}

/// How far a speed and what it gains bring a body in a part of the tick: by the mean velocity, over a tick as Q40 m.
fn way(v: i64, gained: i64, after: i64, scales: &Scales) -> i64 {
    mul(mul(v.saturating_add(gained / 2), scales.margins.tick, 71), after, 40)
}

/// How two bodies move against each other from a time on.
pub(crate) fn motion(a: &State, b: &State, gains: [&[i64; 3]; 2], scales: &Scales) -> Motion {
    let tick = |v: i64| mul(v, scales.margins.tick, 71);
    let between = |a: i64, b: i64| tick(b.saturating_sub(a));
    Motion {
        d: [b.x[0].saturating_sub(a.x[0]), b.x[1].saturating_sub(a.x[1])],
        v: [between(a.v[0], b.v[0]), between(a.v[1], b.v[1])],
        a: [between(gains[0][0], gains[1][0]), between(gains[0][1], gains[1][1])],
        angle: [a.angle, b.angle],
        omega: [tick(a.omega), tick(b.omega)],
        alpha: [tick(gains[0][2]), tick(gains[1][2])],
    }
}

/// The columns of all bodies when the tick began.
#[derive(Debug, Default)]
pub(crate) struct Past {
    columns: [Vec<i64>; 6],
}

impl Past {
    pub(crate) fn take(&mut self, bodies: &Bodies) {
        let Bodies { cold: _, rest: _, x, y, vx, vy, angle, omega } = bodies;
        let now = [x.bits(), y.bits(), angle.bits(), vx.bits(), vy.bits(), omega.bits()];
        for (column, now) in self.columns.iter_mut().zip(now) {
            column.clear();
            column.extend_from_slice(now);
        }
    }

    /// All of them, by slot.
    pub(crate) fn rows(&self) -> impl Iterator<Item = State> + '_ {
        (0..self.columns[0].len()).map(|slot| self.state(slot))
    }

    /// A body's, when the tick began.
    pub(crate) fn state(&self, slot: usize) -> State {
        let [x, y, angle, vx, vy, omega] = [0, 1, 2, 3, 4, 5].map(|at: usize| self.columns[at][slot]);
        State { x: [x, y], angle, v: [vx, vy], omega }
    }
}

/// The flights of the bodies that may be struck in this tick.
#[derive(Debug, Default)]
pub(crate) struct Flights {
    pub(crate) list: Vec<Flight>,
    /// By slot of a body: its place in the list plus 1; 0 for none.
    places: Vec<u32>,
}

impl Flights {
    pub(crate) fn clear(&mut self, slots: usize) {
        for flight in &self.list {
            if let Some(place) = self.places.get_mut(flight.slot as usize) {
                *place = 0;
            }
        }
        self.places.resize(slots, 0);
        self.list.clear();
    }

    /// A body's flight, if it has one.
    pub(crate) fn known(&self, slot: usize) -> Option<&Flight> {
        self.list.get(self.places[slot].checked_sub(1)? as usize)
    }

    /// The place of a body's flight, which begins as its free motion: from `past` to what `bodies` are now.
    pub(crate) fn place(&mut self, slot: u32, past: &Past, bodies: &Bodies, movers: &Movers) -> u32 {
        let at = slot as usize;
        if let Some(place) = self.places[at].checked_sub(1) {
            return place;
        }
        let state = past.state(at);
        let (v, omega) = (bodies.velocity(at), bodies.omega.get(at).to_bits());
        let gain = [
            v.x.to_bits().saturating_sub(state.v[0]),
            v.y.to_bits().saturating_sub(state.v[1]),
            omega.saturating_sub(state.omega),
        ];
        let place = movers.place_of(slot);
        let weight = [gain[0], gain[1]];
        self.list.push(Flight { slot, place, state, gain, weight, first: NONE, ..Flight::default() });
        self.places[at] = self.list.len() as u32;
        self.places[at].saturating_sub(1)
    }

    /// Bodies that were struck, and that no row pushed, to where their flights end.
    pub(crate) fn store(&self, bodies: &mut Bodies, movers: &Movers, scales: &Scales, faults: &mut Vec<Fault>) {
        for flight in self.list.iter().filter(|flight| flight.strikes > 0) {
            let slot = flight.slot as usize;
            if movers.keeps(flight.place) || !bodies.cold.value(slot).is_dynamic() || bodies.rest.is_asleep(slot) {
                continue;
            }
            let State { x, angle: _, v, omega } = flight.at(TICK, scales);
            let held = x.map(|at| at.clamp(Length::MIN.to_bits(), Length::MAX.to_bits()));
            if held != x {
                faults.push(Fault { slot, bound: Bound::Position });
            }
            let [px, py] = held.map(Length::from_bits);
            bodies.set_position(slot, Vec2::new(px, py));
            // Unwrapped turns may end at their bound, which the free motion has noted.
            bodies.angle.set(slot, Angle::from_bits(flight.at(TICK, scales).angle));
            let [vx, vy] = v.map(Velocity::from_bits);
            bodies.set_velocity(slot, Vec2::new(vx, vy));
            bodies.omega.set(slot, AngularVelocity::from_bits(omega));
        }
    }
}

/// What a body's w is: σ·ω over 2^k, Q48.
pub(crate) fn rim(omega: i64, mobility: &Mobility, scales: &Scales) -> i64 {
    mul(omega, mobility.sigma, scales.shift.saturating_add(32))
}
