//! Shared by the tests of contacts: short constructors of bodies with colliders, and how deep colliders overlap, in `f64`.
#![allow(dead_code, reason = "each test file uses its part of this one")]

use crate::common::{acc, at, vel};
use tamias2d::{
    Angle, AngularVelocity, Body, BodyDef, BodyId, BodyKind, ColliderDef, Commands, Friction, Inertia, Mass,
    Restitution, Shape, World, WorldDef,
};

/// A collider with this friction and restitution.
pub fn surface(collider: ColliderDef, friction: f64, restitution: f64) -> ColliderDef {
    ColliderDef {
        friction: Friction::from_f64(friction).expect("in range"),
        restitution: Restitution::from_f64(restitution).expect("in range"),
        ..collider
    }
}

/// A strictly convex polygon at its body's origin.
pub fn polygon(vertices: &[(f64, f64)]) -> ColliderDef {
    ColliderDef::new(Shape::Polygon { vertices: vertices.iter().map(|&(x, y)| at(x, y)).collect() })
}

/// Radians, of any sign, as an angle in [0, 2π).
pub fn turned(radians: f64) -> Angle {
    Angle::from_radians_f64(radians.rem_euclid(std::f64::consts::TAU)).expect("in range")
}

/// A dynamic body with one collider.
pub fn solid(x: f64, y: f64, collider: ColliderDef) -> BodyDef {
    BodyDef { position: at(x, y), colliders: vec![collider], ..BodyDef::default() }
}

/// A static body with one collider.
pub fn fixed(x: f64, y: f64, collider: ColliderDef) -> BodyDef {
    BodyDef { kind: BodyKind::Static, ..solid(x, y, collider) }
}

/// The same with a velocity.
pub fn moving(def: BodyDef, vx: f64, vy: f64) -> BodyDef {
    BodyDef { velocity: vel(vx, vy), ..def }
}

/// The same with a mass; its inertia follows from its colliders.
pub fn weighing(def: BodyDef, mass: f64) -> BodyDef {
    BodyDef { mass: Some(Mass::from_f64(mass).expect("in range")), ..def }
}

/// Mass and inertia of a body, in `f64`.
pub fn mass_of(body: &Body<'_>) -> (f64, f64) {
    let def = body.def();
    (def.mass.map_or(0.0, Mass::to_f64), def.inertia.map_or(0.0, Inertia::to_f64))
}

/// A world of 60 ticks per second with this gravity and unit shift.
pub fn scaled_world(gx: f64, gy: f64, unit_shift: u32) -> World {
    World::new(&WorldDef { gravity: acc(gx, gy), unit_shift, ..WorldDef::default() }).expect("accepted")
}

/// Adds a body.
#[track_caller]
pub fn add(world: &mut World, def: BodyDef) -> BodyId {
    world.create_body(&def).expect("accepted")
}

/// A body, which exists.
#[track_caller]
pub fn get(world: &World, id: BodyId) -> Body<'_> {
    world.body(id).expect("it exists")
}

/// The bits that move: position, velocity, angle, angular velocity.
pub fn bits(body: &Body<'_>) -> [i64; 6] {
    let (p, v) = (body.position(), body.velocity());
    let [angle, spin] = [body.angle().to_bits(), body.angular_velocity().to_bits()];
    [p.x.to_bits(), p.y.to_bits(), v.x.to_bits(), v.y.to_bits(), angle, spin]
}

/// The greatest of the speeds of dynamic bodies, turning counted as m/s at 1 m.
pub fn fastest(world: &World) -> f64 {
    let speed = |body: Body<'_>| {
        let (x, y) = body.velocity().to_f64();
        x.hypot(y).max(body.angular_velocity().to_f64().abs())
    };
    world.bodies().filter(|body| body.kind() == BodyKind::Dynamic).map(speed).fold(0.0, f64::max)
}

/// KE + PE of all dynamic bodies, in J.
pub fn energy(world: &World) -> f64 {
    let dynamic = world.bodies().filter(|body| body.kind() == BodyKind::Dynamic);
    dynamic.map(|body| body.kinetic_energy().to_f64() + body.potential_energy().to_f64()).sum()
}

/// A spin in rad/s.
pub fn spin(omega: f64) -> AngularVelocity {
    AngularVelocity::from_f64(omega).expect("in range")
}

/// An outline in the world: a polygon's corners, counter-clockwise, or a disc's centre, and a radius.
pub struct Outline {
    /// Corners or centre.
    pub points: Vec<[f64; 2]>,
    /// 0 for a polygon.
    pub radius: f64,
    /// Its body.
    pub body: BodyId,
    /// Whether its body is dynamic.
    pub dynamic: bool,
}

/// The outlines of all colliders but sensors, in slot order.
pub fn outlines(world: &World) -> Vec<Outline> {
    world
        .colliders()
        .filter(|collider| !collider.is_sensor())
        .map(|collider| {
            let (body, def) = (get(world, collider.body()), collider.def());
            let turn = |(x, y): (f64, f64), angle: Angle| {
                let (sin, cos) = angle.to_radians_f64().sin_cos();
                (x * cos - y * sin, x * sin + y * cos)
            };
            let place = |p: (f64, f64)| {
                let (p, offset, origin) = (turn(p, def.angle), def.offset.to_f64(), body.position().to_f64());
                let p = turn((p.0 + offset.0, p.1 + offset.1), body.angle());
                [p.0 + origin.0, p.1 + origin.1]
            };
            let (local, radius) = match &def.shape {
                Shape::Circle { radius } => (vec![(0.0, 0.0)], radius.to_f64()),
                Shape::Box { width, height } => {
                    let (x, y) = (width.to_f64() / 2.0, height.to_f64() / 2.0);
                    (vec![(-x, -y), (x, -y), (x, y), (-x, y)], 0.0)
                }
                Shape::Polygon { vertices } => (vertices.iter().map(|v| v.to_f64()).collect(), 0.0),
            };
            let points = local.into_iter().map(place).collect();
            Outline { points, radius, body: body.id(), dynamic: body.kind() == BodyKind::Dynamic }
        })
        .collect()
}

/// How far a point is outside a polygon, negative inside, and the nearest point of its border.
pub fn outside(polygon: &[[f64; 2]], p: [f64; 2]) -> (f64, [f64; 2]) {
    let (mut nearest, mut inside) = ((f64::INFINITY, p), true);
    for (at, a) in polygon.iter().enumerate() {
        let b = polygon[(at + 1) % polygon.len()];
        let (edge, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        inside &= edge[0] * from[1] - edge[1] * from[0] >= 0.0;
        let part = (from[0] * edge[0] + from[1] * edge[1]) / (edge[0] * edge[0] + edge[1] * edge[1]);
        let part = part.clamp(0.0, 1.0);
        let foot = [a[0] + edge[0] * part, a[1] + edge[1] * part];
        let distance = (p[0] - foot[0]).hypot(p[1] - foot[1]);
        if distance < nearest.0 {
            nearest = (distance, foot);
        }
    }
    (if inside { -nearest.0 } else { nearest.0 }, nearest.1)
}

/// The greatest distance along an edge's normal by which two polygons are apart; negative: they overlap by that.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let mut most = f64::NEG_INFINITY;
    for (own, other) in [(a, b), (b, a)] {
        for (at, p) in own.iter().enumerate() {
            let q = own[(at + 1) % own.len()];
            let edge = [q[0] - p[0], q[1] - p[1]];
            let long = edge[0].hypot(edge[1]);
            let out = |v: &[f64; 2]| ((v[0] - p[0]) * edge[1] - (v[1] - p[1]) * edge[0]) / long;
            most = most.max(other.iter().map(out).fold(f64::INFINITY, f64::min));
        }
    }
    most
}

/// How far two outlines are apart, negative by how deep they overlap. Of two polygons that are apart it is a lower bound.
pub fn gap(a: &Outline, b: &Outline) -> f64 {
    match (a.radius > 0.0, b.radius > 0.0) {
        (false, false) => apart(&a.points, &b.points),
        (true, false) => outside(&b.points, a.points[0]).0 - a.radius,
        (false, true) => outside(&a.points, b.points[0]).0 - b.radius,
        (true, true) => {
            let ([x, y], [u, v]) = (a.points[0], b.points[0]);
            (x - u).hypot(y - v) - a.radius - b.radius
        }
    }
}

/// The greatest overlap of two colliders of which one's body is dynamic, in metres; 0 without one.
pub fn worst_overlap(world: &World) -> f64 {
    let all = outlines(world);
    let bound = |o: &Outline| {
        o.points.iter().fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |m, p| {
            let [x, y] = *p;
            [m[0].min(x - o.radius), m[1].min(y - o.radius), m[2].max(x + o.radius), m[3].max(y + o.radius)]
        })
    };
    let bounds: Vec<[f64; 4]> = all.iter().map(bound).collect();
    let mut worst = 0.0f64;
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate().skip(i + 1) {
            let (m, n) = (bounds[i], bounds[j]);
            let near = m[0] < n[2] && n[0] < m[2] && m[1] < n[3] && n[1] < m[3];
            if near && a.body != b.body && (a.dynamic || b.dynamic) {
                worst = worst.max(-gap(a, b));
            }
        }
    }
    worst
}
