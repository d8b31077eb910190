//! Shared by the tests of impacts: free motion in `f64`, when a body was struck, what GD:impulse says, and closed rooms.
#![allow(dead_code, reason = "each test file uses its part of this one")]

use crate::common::{Rng, at, rectangle};
use crate::solid::{add, fixed, get, moving, polygon, solid, spin, surface, turned};
use tamias2d::{BodyDef, BodyId, ColliderDef, World};

/// A tick of 60 per second.
pub const TICK: f64 = 1.0 / 60.0;

/// Where a body's centre of mass is, and how it moves.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Of the centre of mass.
    pub x: [f64; 2],
    /// Unwrapped, in radians.
    pub phi: f64,
    /// Of the centre of mass.
    pub v: [f64; 2],
    /// Counter-clockwise positive.
    pub omega: f64,
}

impl Free {
    /// A body now.
    pub fn of(world: &World, id: BodyId) -> Free {
        let body = get(world, id);
        let ((x, y), (vx, vy)) = (body.center_of_mass().to_f64(), body.velocity().to_f64());
        let (phi, omega) = (body.angle().to_radians_f64(), body.angular_velocity().to_f64());
        Free { x: [x, y], phi, v: [vx, vy], omega }
    }

    /// The same later (or earlier), with a constant acceleration.
    pub fn after(&self, t: f64, a: [f64; 2]) -> Free {
        let axis = |i: usize| self.x[i] + self.v[i] * t + 0.5 * a[i] * t * t;
        let v = [self.v[0] + a[0] * t, self.v[1] + a[1] * t];
        Free { x: [axis(0), axis(1)], phi: self.phi + self.omega * t, v, omega: self.omega }
    }

    /// A point of the body, from its centre: turned as the body is.
    pub fn arm(&self, local: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.phi.sin_cos();
        [local[0] * cos - local[1] * sin, local[0] * sin + local[1] * cos]
    }

    /// The greatest difference of the velocities, rad/s counted as m/s.
    pub fn faster(&self, other: &Free) -> f64 {
        let line = (self.v[0] - other.v[0]).abs().max((self.v[1] - other.v[1]).abs());
        line.max((self.omega - other.omega).abs())
    }
}

/// An impact: its time in seconds since the world began, and the bodies at that time, before and after.
#[derive(Debug)]
pub struct Hit {
    /// t_c.
    pub time: f64,
    /// With the velocities with which they came.
    pub before: Vec<Free>,
    /// With the velocities with which they go.
    pub after: Vec<Free>,
}

/// Steps until the first of the bodies, which accelerate constantly, has been struck; `None` after a minute. If a body is
/// struck twice in that tick, or turned by what acts on it, the time is none.
///
/// The time follows from positions and velocities alone: where the way before and the way after cross.
pub fn until_struck(world: &mut World, ids: &[BodyId], accelerations: &[[f64; 2]]) -> Option<Hit> {
    for _ in 0..3600 {
        let start = world.tick() as f64 * TICK;
        let old: Vec<Free> = ids.iter().map(|&id| Free::of(world, id)).collect();
        world.step();
        let new: Vec<Free> = ids.iter().map(|&id| Free::of(world, id)).collect();
        let free = old[0].after(TICK, accelerations[0]);
        if free.faster(&new[0]) > 1e-6 {
            let into = crossing(&old[0], &new[0], accelerations[0]);
            let of = |states: &[Free], from: f64| {
                states.iter().zip(accelerations).map(|(state, &a)| state.after(into - from, a)).collect()
            };
            return Some(Hit { time: start + into, before: of(&old, 0.0), after: of(&new, TICK) });
        }
    }
    None
}

/// When in a tick a body went from one way to another, in seconds from the tick's beginning.
pub fn crossing(old: &Free, new: &Free, a: [f64; 2]) -> f64 {
    let back = new.after(-TICK, a);
    let change = [0, 1].map(|i| old.v[i] - back.v[i]);
    let way = [0, 1].map(|i| back.x[i] - old.x[i]);
    (change[0] * way[0] + change[1] * way[1]) / (change[0] * change[0] + change[1] * change[1])
}

/// What GD:impulse needs of a body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side {
    /// 1/m and 1/I; 0 for what an impulse does not move.
    pub inverse: [f64; 2],
    /// Of the centre of mass.
    pub v: [f64; 2],
    /// Counter-clockwise positive.
    pub omega: f64,
    /// From the centre of mass to the point.
    pub arm: [f64; 2],
}

impl Side {
    /// A body of this mass and inertia.
    pub fn new((m, i): (f64, f64), state: &Free, arm: [f64; 2]) -> Side {
        Side { inverse: [1.0 / m, 1.0 / i], v: state.v, omega: state.omega, arm }
    }

    fn speed(&self, d: [f64; 2]) -> f64 {
        (self.v[0] - self.omega * self.arm[1]) * d[0] + (self.v[1] + self.omega * self.arm[0]) * d[1]
    }

    fn lever(&self, d: [f64; 2]) -> f64 {
        self.arm[0] * d[1] - self.arm[1] * d[0]
    }

    fn take(&mut self, d: [f64; 2], j: f64) {
        self.v = [self.v[0] + d[0] * j * self.inverse[0], self.v[1] + d[1] * j * self.inverse[0]];
        self.omega += self.lever(d) * j * self.inverse[1];
    }

    /// ½·m·v² + ½·I·ω².
    pub fn energy(&self) -> f64 {
        let half = |inverse: f64, square: f64| if inverse == 0.0 { 0.0 } else { square / (2.0 * inverse) };
        half(self.inverse[0], self.v[0] * self.v[0] + self.v[1] * self.v[1])
            + half(self.inverse[1], self.omega * self.omega)
    }
}

/// GD:impulse with Coulomb's friction: a and b after the collision, for the unit normal from b to a. What slides and would
/// come to rest sticks; what does not, slides on.
pub fn collide(mut a: Side, mut b: Side, n: [f64; 2], e: f64, friction: f64) -> [Side; 2] {
    let t = [-n[1], n[0]];
    let k = |d: [f64; 2], f: [f64; 2]| {
        (d[0] * f[0] + d[1] * f[1]) * (a.inverse[0] + b.inverse[0])
            + a.lever(d) * a.lever(f) * a.inverse[1]
            + b.lever(d) * b.lever(f) * b.inverse[1]
    };
    let (nn, nt, tt) = (k(n, n), k(n, t), k(t, t));
    let [un, ut] = [n, t].map(|d| a.speed(d) - b.speed(d));
    if un >= 0.0 {
        return [a, b];
    }
    let det = nn * tt - nt * nt;
    let mut j = [(-(1.0 + e) * un * tt + ut * nt) / det, (-ut * nn + (1.0 + e) * un * nt) / det];
    if j[1].abs() > friction * j[0] {
        let slope = friction * j[1].signum();
        let normal = -(1.0 + e) * un / (nn + slope * nt);
        j = [normal, slope * normal];
    }
    for (side, sign) in [(&mut a, 1.0), (&mut b, -1.0)] {
        side.take(n, sign * j[0]);
        side.take(t, sign * j[1]);
    }
    [a, b]
}

/// A convex polygon of 3 to 8 vertices and a radius of about 0.5 m.
pub fn pebble(rng: &mut Rng) -> ColliderDef {
    let count = 3 + rng.below(6);
    let radii = [0.42 + 0.16 * rng.unit(), 0.42 + 0.16 * rng.unit()];
    let corner = |at: u64| {
        let angle = (at as f64 + 0.7 * (rng.unit() - 0.5)) * std::f64::consts::TAU / count as f64;
        (radii[0] * angle.cos(), radii[1] * angle.sin())
    };
    let corners: Vec<(f64, f64)> = (0..count).map(corner).collect();
    polygon(&corners)
}

/// Walls of 4 m around a square of ±`half`.
pub fn wall_in(world: &mut World, half: f64, friction: f64, e: f64) {
    let (long, out) = (2.0 * half + 8.0, half + 2.0);
    for (x, y) in [(0.0, -out), (0.0, out)] {
        add(world, fixed(x, y, surface(rectangle(long, 4.0), friction, e)));
    }
    for (x, y) in [(-out, 0.0), (out, 0.0)] {
        add(world, fixed(x, y, surface(rectangle(4.0, long), friction, e)));
    }
}

/// `count` bodies on a grid of 2.5 m within ±20 m, each velocity's components within ±`speed`, turning at up to 3 rad/s.
pub fn scatter(world: &mut World, count: u32, speed: f64, rng: &mut Rng, mut body: impl FnMut(&mut Rng) -> BodyDef) {
    for place in 0..count {
        let (x, y) = (f64::from(place % 15) * 2.5 - 17.5, f64::from(place / 15) * 2.5 - 17.5);
        let mut within = |most: f64| (2.0 * rng.unit() - 1.0) * most;
        let (vx, vy, omega, angle) = (within(speed), within(speed), within(3.0), within(3.0));
        let def = body(rng);
        let omega = if def.fixed_rotation { 0.0 } else { omega };
        let def = BodyDef { position: at(x, y), angle: turned(angle), angular_velocity: spin(omega), ..def };
        add(world, moving(def, vx, vy));
    }
}

/// One collider with this surface, at the origin.
pub fn body(collider: ColliderDef, friction: f64, e: f64) -> BodyDef {
    solid(0.0, 0.0, surface(collider, friction, e))
}
