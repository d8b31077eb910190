//! Scenes that are about time.

use crate::Geom::*;
use crate::Kind::*;
use crate::{Body, Hinge, Scene, V};

/// Knuth's MMIX generator; its upper half.
struct Lcg(u64);
impl Lcg {
    fn new(seed: u64) -> Lcg {
        let mut l = Lcg(seed ^ 0x9E37_79B9_7F4A_7C15);
        l.next();
        l
    }
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 32) as u32
    }
    fn unit(&mut self) -> f64 {
        self.next() as f64 / 4294967296.0
    }
    fn range(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }
}

fn q(x: f64) -> f64 {
    (x * 4096.0).round() / 4096.0
}

fn area_centroid(p: &[V]) -> (f64, V) {
    let (mut a, mut cx, mut cy) = (0.0, 0.0, 0.0);
    for i in 0..p.len() {
        let (u, v) = (p[i], p[(i + 1) % p.len()]);
        let c = u[0] * v[1] - v[0] * u[1];
        a += c;
        cx += (u[0] + v[0]) * c;
        cy += (u[1] + v[1]) * c;
    }
    (a * 0.5, [cx / (3.0 * a), cy / (3.0 * a)])
}

/// A convex polygon of n vertices on a circle of radius r with jittered angles, moved so that its
/// centroid is at the origin (up to the 2^-12 grid).
fn random_convex(rng: &mut Lcg, n: usize, r: f64) -> Vec<V> {
    let phase = rng.range(0.0, std::f64::consts::TAU);
    let mut pts: Vec<V> = (0..n)
        .map(|k| {
            let a = phase + std::f64::consts::TAU * (k as f64 + rng.range(-0.2, 0.2)) / n as f64;
            [r * a.cos(), r * a.sin()]
        })
        .collect();
    let (_, c) = area_centroid(&pts);
    for p in &mut pts {
        *p = [q(p[0] - c[0]), q(p[1] - c[1])];
    }
    pts
}

fn pyramid(name: &'static str, rows: usize, steps: usize, warm: usize) -> Scene {
    let mut s = Scene::new(name, "speed", steps);
    s.windows = vec![("settled", warm, steps)];
    let half = rows as f64;
    s.bodies.push(Body::new(Static, 0.0, -1.0, Box(half, 1.0)));
    for i in 0..rows {
        let n = rows - i;
        for j in 0..n {
            let x = j as f64 - (n - 1) as f64 * 0.5;
            s.bodies.push(Body::new(Dynamic, x, 0.5 + i as f64, Box(0.5, 0.5)));
        }
    }
    s
}

fn bin(s: &mut Scene, w: f64, h: f64) {
    s.bodies.push(Body::new(Static, 0.0, -1.0, Box(w * 0.5 + 2.0, 1.0)));
    s.bodies.push(Body::new(Static, -w * 0.5 - 1.0, h * 0.5, Box(1.0, h * 0.5)));
    s.bodies.push(Body::new(Static, w * 0.5 + 1.0, h * 0.5, Box(1.0, h * 0.5)));
}

fn pile(name: &'static str, n: usize, cols: usize, w: f64) -> Scene {
    let mut s = Scene::new(name, "speed", 1200);
    s.windows = vec![("falling", 0, if n > 2000 { 180 } else { 150 }), ("settled", 900, 1200)];
    let rows = n.div_ceil(cols);
    bin(&mut s, w, rows as f64 * 1.2 + 10.0);
    let mut rng = Lcg::new(1);
    for k in 0..n {
        let (r, c) = (k / cols, k % cols);
        let verts = 3 + (rng.next() % 6) as usize;
        let rad = rng.range(0.4, 0.6);
        let p = random_convex(&mut rng, verts, rad);
        let pitch = w / cols as f64;
        let x = q(-w * 0.5 + pitch * (c as f64 + 0.5) + rng.range(-0.02, 0.02));
        let y = q(2.0 + r as f64 * 1.2);
        s.bodies.push(Body::new(Dynamic, x, y, Poly(p)));
    }
    s
}

fn bouncers(name: &'static str, grav: bool, e: f64, steps: usize) -> Scene {
    let mut s = Scene::new(name, "speed", steps);
    if !grav {
        s.gravity = [0.0, 0.0];
    }
    s.friction = 0.0;
    s.restitution = e;
    s.windows = vec![("all", 0, steps)];
    let h = 20.0;
    for (x, y, a, b) in [
        (0.0, -h - 1.0, h + 2.0, 1.0),
        (0.0, h + 1.0, h + 2.0, 1.0),
        (-h - 1.0, 0.0, 1.0, h + 2.0),
        (h + 1.0, 0.0, 1.0, h + 2.0),
    ] {
        s.bodies.push(Body::new(Static, x, y, Box(a, b)));
    }
    let mut rng = Lcg::new(7);
    for k in 0..200 {
        let (r, c) = (k / 20, k % 20);
        let verts = 3 + (rng.next() % 6) as usize;
        let p = random_convex(&mut rng, verts, 0.5);
        let x = q(-h + 2.0 * (c as f64 + 0.5));
        let y = q(-h + 4.0 * (r as f64 + 0.5));
        let v = [q(rng.range(-10.0, 10.0)), q(rng.range(-10.0, 10.0))];
        let w = q(rng.range(-3.0, 3.0));
        s.bodies.push(Body { vel: v, omega: w, ..Body::new(Dynamic, x, y, Poly(p)) });
    }
    s
}

fn free_flight() -> Scene {
    let mut s = Scene::new("s4_free10000", "speed", 400);
    s.windows = vec![("all", 60, 400)];
    let mut rng = Lcg::new(3);
    for k in 0..10_000 {
        let (r, c) = (k / 100, k % 100);
        let w = q(rng.range(-3.0, 3.0));
        let (x, y) = ((c as f64 - 49.5) * 4.0, r as f64 * 4.0);
        s.bodies.push(Body { omega: w, ..Body::new(Dynamic, x, y, Box(0.5, 0.5)) });
    }
    s
}

/// A drum of 19 m by 19 m inside that turns at 25 degrees a second, and boxes of 50 cm.
fn tumbler() -> Scene {
    let mut s = Scene::new("s5_tumbler500", "speed", 900);
    s.windows = vec![("tumbling", 300, 900)];
    let wall =
        |x: f64, y: f64, w: f64, h: f64| Poly(vec![[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]]);
    let mut drum = Body::new(Kinematic, 0.0, 0.0, wall(10.0, 0.0, 0.5, 10.0));
    drum.shapes.push(wall(-10.0, 0.0, 0.5, 10.0));
    drum.shapes.push(wall(0.0, 10.0, 10.0, 0.5));
    drum.shapes.push(wall(0.0, -10.0, 10.0, 0.5));
    drum.omega = 25.0_f64.to_radians();
    s.bodies.push(drum);
    for k in 0..500 {
        let (row, column) = (k / 25, k % 25);
        let [x, y] = [(column as f64 - 12.0) * 0.55, (row as f64 - 9.5) * 0.55].map(q);
        s.bodies.push(Body::new(Dynamic, x, y, Box(0.25, 0.25)));
    }
    s
}

fn stack(name: &'static str, n: usize, steps: usize) -> Scene {
    let mut s = Scene::new(name, "speed", steps);
    let x = 0.0;
    s.bodies.push(Body::new(Static, x, -1.0, Box(20.0, 1.0)));
    for i in 0..n {
        s.bodies.push(Body::new(Dynamic, x, 0.5 + i as f64, Box(0.5, 0.5)));
    }
    s.windows = vec![("settled", steps / 4, steps)];
    s
}

fn chain() -> Scene {
    let mut s = Scene::new("s7_chain100", "speed", 1200);
    s.windows = vec![("swinging", 60, 360), ("late", 900, 1200)];
    let n = 100;
    let mut pt = vec![[0.0, 0.0]];
    for i in 0..n {
        let l: V = *pt.last().unwrap();
        let dy = if i < n / 2 { -0.6 } else { 0.6 };
        pt.push([l[0] + 0.8, l[1] + dy]);
    }
    for k in [0usize, n] {
        let mut a = Body::new(Static, q(pt[k][0]), q(pt[k][1]), Box(0.25, 0.25));
        a.collide = false;
        s.bodies.push(a);
    }
    for i in 0..n {
        let (a, b) = (pt[i], pt[i + 1]);
        let mut l = Body::new(Dynamic, (a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5, Box(0.5, 0.125));
        l.angle = (b[1] - a[1]).atan2(b[0] - a[0]);
        l.collide = false;
        s.bodies.push(l);
    }
    s.hinges.push(Hinge { a: 0, b: 2, la: [0.0, 0.0], lb: [-0.5, 0.0] });
    for i in 0..n - 1 {
        s.hinges.push(Hinge { a: 2 + i, b: 3 + i, la: [0.5, 0.0], lb: [-0.5, 0.0] });
    }
    s.hinges.push(Hinge { a: 1 + n, b: 1, la: [0.5, 0.0], lb: [0.0, 0.0] });
    s
}

pub fn all() -> Vec<Scene> {
    vec![
        pyramid("s1_pyramid40", 40, 600, 120),
        pyramid("s1_pyramid100", 100, 360, 60),
        pile("s2_pile1000", 1000, 25, 30.0),
        pile("s2_pile4000", 4000, 50, 60.0),
        bouncers("s3_bouncers_nograv", false, 0.8, 600),
        bouncers("s3_bouncers_grav", true, 0.8, 600),
        free_flight(),
        tumbler(),
        stack("s6_stack20", 20, 1200),
        chain(),
    ]
}

/// What rollbacks are measured on: piles that have settled, and the pyramid that others are measured on.
pub fn rollback() -> Vec<Scene> {
    let scenes = [
        pile("r_pile50", 50, 8, 10.0),
        pile("r_pile200", 200, 13, 16.0),
        pile("r_pile820", 820, 24, 28.0),
        pile("r_pile2000", 2000, 36, 42.0),
        pyramid("r_pyramid820", 40, 1200, 0),
    ];
    scenes.into_iter().map(|scene| Scene { group: "rollback", ..scene }).collect()
}
