//! How deep bodies overlap, by separating axes in `f64`.

use crate::scenes::{Form, Kind, ONE, Pair, Scene};
use crate::stage::{State, angle};

/// A form in the world: corners, or a middle and a radius.
struct Outline {
    points: Vec<[f64; 2]>,
    radius: f64,
    body: usize,
    dynamic: bool,
    /// Left, right, low, high.
    bounds: [f64; 4],
}

fn metres(pair: Pair) -> [f64; 2] {
    pair.map(|micro| micro as f64 / ONE as f64)
}

/// A point turned by an angle and moved.
fn placed([x, y]: [f64; 2], turned: f64, [ox, oy]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = turned.sin_cos();
    [ox + cos * x - sin * y, oy + sin * x + cos * y]
}

fn outlines(scene: &Scene, states: &[State]) -> Vec<Outline> {
    let mut all = Vec::new();
    for (body, (thing, state)) in scene.things.iter().zip(states).enumerate() {
        for part in &thing.parts {
            let (local, radius) = match &part.form {
                Form::Disc(radius) => (vec![[0, 0]], *radius as f64 / ONE as f64),
                Form::Box(w, h) => (vec![[-w / 2, -h / 2], [w / 2, -h / 2], [w / 2, h / 2], [-w / 2, h / 2]], 0.0),
                Form::Polygon(corners) => (corners.clone(), 0.0),
            };
            let in_body = |corner| placed(metres(corner), angle(part.facing), metres(part.at));
            let points: Vec<[f64; 2]> =
                local.into_iter().map(|corner| placed(in_body(corner), state.angle, state.at)).collect();
            let around = |axis: usize| {
                let of = points.iter().map(|p| p[axis]);
                of.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v - radius), b.max(v + radius)])
            };
            let ([left, right], [low, high]) = (around(0), around(1));
            let dynamic = thing.kind == Kind::Dynamic;
            all.push(Outline { points, radius, body, dynamic, bounds: [left, right, low, high] });
        }
    }
    all
}

/// How far two outlines reach into each other along an axis; the axis is a unit vector.
fn along(a: &Outline, b: &Outline, [nx, ny]: [f64; 2]) -> f64 {
    let reach = |o: &Outline| {
        let of = o.points.iter().map(|p| p[0] * nx + p[1] * ny);
        of.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v - o.radius), h.max(v + o.radius)])
    };
    let ([a0, a1], [b0, b1]) = (reach(a), reach(b));
    (a1 - b0).min(b1 - a0)
}

/// The depth of the overlap of two outlines, negative where an axis separates them.
fn depth(a: &Outline, b: &Outline) -> f64 {
    let mut least = f64::INFINITY;
    let mut axis = |x: f64, y: f64| {
        let long = x.hypot(y);
        if long > 0.0 {
            least = least.min(along(a, b, [x / long, y / long]));
        }
    };
    for o in [a, b].into_iter().filter(|o| o.points.len() > 1) {
        for (k, p) in o.points.iter().enumerate() {
            let q = o.points[(k + 1) % o.points.len()];
            axis(q[1] - p[1], p[0] - q[0]);
        }
    }
    // A disc also separates along the way to the nearest corner, or to the other disc's middle.
    for (disc, other) in [(a, b), (b, a)].into_iter().filter(|(disc, _)| disc.radius > 0.0) {
        let [x, y] = disc.points[0];
        let far = |p: &&[f64; 2]| (p[0] - x).hypot(p[1] - y);
        if let Some(p) = other.points.iter().min_by(|p, q| far(p).total_cmp(&far(q))) {
            axis(p[0] - x, p[1] - y);
        }
    }
    least
}

/// The greatest overlap of two bodies of which one is dynamic, in metres.
pub fn worst_overlap(scene: &Scene, states: &[State]) -> f64 {
    let mut all = outlines(scene, states);
    all.sort_by(|a, b| a.bounds[0].total_cmp(&b.bounds[0]));
    let mut worst = 0.0f64;
    for (k, a) in all.iter().enumerate() {
        for b in all[k + 1..].iter().take_while(|b| b.bounds[0] < a.bounds[1]) {
            let level = a.bounds[2] < b.bounds[3] && b.bounds[2] < a.bounds[3];
            if level && a.body != b.body && (a.dynamic || b.dynamic) {
                worst = worst.max(depth(a, b));
            }
        }
    }
    worst
}
