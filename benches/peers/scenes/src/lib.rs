//! Scenes of no engine in `f64`, and the protocol by which every engine's program runs them.
//!
//! Speed scenes are made here; their coordinates lie on a grid of 2⁻¹² m, so they are the same in `f32`, `f64` and fixed
//! point. Scenes with a known outcome and hard ones are those of the project's benches.

pub mod json;
pub mod runner;
#[path = "../../../scenes/mod.rs"]
pub mod shared;
pub mod speed;
mod taken;

pub type V = [f64; 2];

#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Kind {
    Static,
    Dynamic,
    Kinematic,
}

#[derive(Clone, Debug)]
pub enum Geom {
    /// Half extents.
    Box(f64, f64),
    Circle(f64),
    /// Counter-clockwise corners.
    Poly(Vec<V>),
}

#[derive(Clone, Debug)]
pub struct Body {
    pub kind: Kind,
    pub pos: V,
    pub angle: f64,
    pub vel: V,
    pub omega: f64,
    pub shapes: Vec<Geom>,
    pub density: f64,
    pub collide: bool,
}

impl Body {
    pub fn new(kind: Kind, x: f64, y: f64, shape: Geom) -> Body {
        let (angle, vel, omega, density) = (0.0, [0.0, 0.0], 0.0, 1.0);
        Body { kind, pos: [x, y], angle, vel, omega, shapes: vec![shape], density, collide: true }
    }
}

/// A point of one body, in its axes, that stays on one of another.
#[derive(Clone, Debug)]
pub struct Hinge {
    pub a: usize,
    pub b: usize,
    pub la: V,
    pub lb: V,
}

#[derive(Clone, Debug)]
pub struct Scene {
    pub name: &'static str,
    /// `speed`, `rollback`, `accuracy` or `hard`.
    pub group: &'static str,
    pub gravity: V,
    pub dt: f64,
    /// Of every pair.
    pub friction: f64,
    /// Of every pair.
    pub restitution: f64,
    pub steps: usize,
    /// Steps from … to, whose times are told apart.
    pub windows: Vec<(&'static str, usize, usize)>,
    pub bodies: Vec<Body>,
    pub hinges: Vec<Hinge>,
    /// Every how many steps the bodies' states are told.
    pub track_every: usize,
}

impl Scene {
    pub fn new(name: &'static str, group: &'static str, steps: usize) -> Scene {
        Scene {
            name,
            group,
            gravity: [0.0, -9.81],
            dt: 1.0 / 60.0,
            friction: 0.6,
            restitution: 0.0,
            steps,
            windows: vec![],
            bodies: vec![],
            hinges: vec![],
            track_every: steps.max(1),
        }
    }

    /// The bodies whose states are told.
    pub fn tracked(&self) -> Vec<usize> {
        (0..self.bodies.len()).filter(|&i| self.bodies[i].kind == Kind::Dynamic).collect()
    }
}

pub fn all() -> Vec<Scene> {
    let mut scenes = speed::all();
    scenes.extend(speed::rollback());
    scenes.extend(taken::accuracy());
    scenes.extend(taken::hard());
    scenes
}

pub fn by_name(group: Option<&str>, name: &str) -> Option<Scene> {
    all().into_iter().find(|s| s.name == name && group.is_none_or(|g| g == s.group))
}
