//! How deep bodies overlap, by separating axes in `f64`.

use crate::stage::Stage;
use tamias2d::{BodyKind, Shape};

/// A collider in the world: corners, or a middle and a radius.
struct Outline {
    points: Vec<[f64; 2]>,
    radius: f64,
    body: usize,
    dynamic: bool,
    /// Left, right, low, high.
    bounds: [f64; 4],
}

fn outlines(stage: &Stage) -> Vec<Outline> {
    let mut all = Vec::new();
    for (at, &id) in stage.ids.iter().enumerate() {
        let body = stage.world.body(id).expect("scenes keep their bodies");
        let ((x, y), (cos, sin)) = (body.position().to_f64(), body.rotation().to_f64());
        for collider in body.def().colliders {
            let ((ox, oy), turned) = (collider.offset.to_f64(), collider.angle.to_radians_f64());
            let (c, s) = (turned.cos(), turned.sin());
            let place = |[px, py]: [f64; 2]| {
                let (lx, ly) = (ox + c * px - s * py, oy + s * px + c * py);
                [x + cos * lx - sin * ly, y + sin * lx + cos * ly]
            };
            let (local, radius) = match &collider.shape {
                Shape::Circle { radius } => (vec![[0.0, 0.0]], radius.to_f64()),
                Shape::Box { width, height } => {
                    let (w, h) = (width.to_f64() / 2.0, height.to_f64() / 2.0);
                    (vec![[-w, -h], [w, -h], [w, h], [-w, h]], 0.0)
                }
                Shape::Polygon { vertices } => (vertices.iter().map(|v| v.to_f64().into()).collect(), 0.0),
            };
            let points: Vec<[f64; 2]> = local.into_iter().map(place).collect();
            let around = |axis: usize| {
                let of = points.iter().map(|p| p[axis]);
                of.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v - radius), b.max(v + radius)])
            };
            let ([left, right], [low, high]) = (around(0), around(1));
            let dynamic = body.kind() == BodyKind::Dynamic;
            all.push(Outline { points, radius, body: at, dynamic, bounds: [left, right, low, high] });
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
pub fn worst_overlap(stage: &Stage) -> f64 {
    let mut all = outlines(stage);
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
