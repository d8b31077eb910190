//! Scenes as JSON, for programs that are not written in Rust.

use crate::{Body, Geom, Kind, Scene, V};

/// A number; `null` if there is none.
pub fn num(x: f64) -> String {
    if x.is_finite() { format!("{x:?}") } else { "null".into() }
}

fn pair(v: V) -> String {
    format!("[{},{}]", num(v[0]), num(v[1]))
}

impl Scene {
    pub fn to_json(&self) -> String {
        let body = |b: &Body| {
            let shapes: Vec<String> = b
                .shapes
                .iter()
                .map(|g| match g {
                    Geom::Box(x, y) => format!("{{\"box\":[{},{}]}}", num(*x), num(*y)),
                    Geom::Circle(r) => format!("{{\"circle\":{}}}", num(*r)),
                    Geom::Poly(p) => {
                        format!("{{\"poly\":[{}]}}", p.iter().map(|v| pair(*v)).collect::<Vec<_>>().join(","))
                    }
                })
                .collect();
            format!(
                "{{\"kind\":\"{}\",\"pos\":{},\"angle\":{},\"vel\":{},\"omega\":{},\"density\":{},\"collide\":{},\"shapes\":[{}]}}",
                match b.kind {
                    Kind::Static => "static",
                    Kind::Dynamic => "dynamic",
                    Kind::Kinematic => "kinematic",
                },
                pair(b.pos),
                num(b.angle),
                pair(b.vel),
                num(b.omega),
                num(b.density),
                b.collide,
                shapes.join(",")
            )
        };
        let win: Vec<String> = self.windows.iter().map(|(n, a, b)| format!("[\"{n}\",{a},{b}]")).collect();
        let hinges: Vec<String> = self
            .hinges
            .iter()
            .map(|h| format!("{{\"a\":{},\"b\":{},\"la\":{},\"lb\":{}}}", h.a, h.b, pair(h.la), pair(h.lb)))
            .collect();
        let tracked: Vec<String> = self.tracked().iter().map(|i| i.to_string()).collect();
        format!(
            "{{\"name\":\"{}\",\"group\":\"{}\",\"gravity\":{},\"dt\":{},\"friction\":{},\"restitution\":{},\"steps\":{},\"windows\":[{}],\"track_every\":{},\"tracked\":[{}],\"hinges\":[{}],\"bodies\":[{}]}}",
            self.name,
            self.group,
            pair(self.gravity),
            num(self.dt),
            num(self.friction),
            num(self.restitution),
            self.steps,
            win.join(","),
            self.track_every,
            tracked.join(","),
            hinges.join(","),
            self.bodies.iter().map(body).collect::<Vec<_>>().join(",\n")
        )
    }
}
