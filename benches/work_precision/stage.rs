//! Worlds from scenes, and what bodies of a world are like in `f64`.

use crate::scenes::{Form, Kind, Micro, Pair, Part, Scene, Thing};
use std::str::FromStr;
use tamias2d::{
    Angle, Attractor, BodyDef, BodyId, BodyKind, ColliderDef, Commands, Length, NumError, Radians, Shape, Sleeping,
    Vec2, World, WorldDef,
};

/// Ticks per second and substeps per tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    pub rate: u32,
    pub substeps: u32,
}

impl Setting {
    /// What `WorldDef::default()` has.
    pub fn default() -> Setting {
        let WorldDef { tick_rate: rate, substeps, .. } = WorldDef::default();
        Setting { rate, substeps }
    }
}

/// A world and its bodies, in the order of the scene.
#[derive(Clone)]
pub struct Stage {
    pub world: World,
    pub ids: Vec<BodyId>,
    pub setting: Setting,
}

/// Millionths as a quantity, digit by digit.
pub fn quantity<Q: FromStr<Err = NumError>>(micro: Micro) -> Q {
    let sign = if micro < 0 { "-" } else { "" };
    let micro = micro.unsigned_abs();
    format!("{sign}{}.{:06}", micro / 1_000_000, micro % 1_000_000).parse().expect("scenes are in range")
}

fn pair<Q: FromStr<Err = NumError>>([x, y]: Pair) -> Vec2<Q> {
    Vec2::new(quantity(x), quantity(y))
}

/// The angle of a direction, in [0, 2π).
pub fn angle([x, y]: Pair) -> f64 {
    (y as f64).atan2(x as f64).rem_euclid(std::f64::consts::TAU)
}

fn turn(facing: Pair) -> Angle {
    let radians: Radians = format!("{:.17}", angle(facing)).parse().expect("below a turn");
    Angle::from_radians(radians).expect("below a turn")
}

fn collider(scene: &Scene, thing: &Thing, part: &Part) -> ColliderDef {
    let shape = match &part.form {
        Form::Box(w, h) => Shape::Box { width: quantity(*w), height: quantity(*h) },
        Form::Disc(r) => Shape::Circle { radius: quantity(*r) },
        Form::Polygon(corners) => Shape::Polygon { vertices: corners.iter().map(|&c| pair::<Length>(c)).collect() },
    };
    ColliderDef {
        offset: pair(part.at),
        angle: turn(part.facing),
        density: quantity(thing.density),
        friction: quantity(scene.friction),
        restitution: quantity(scene.restitution),
        ..ColliderDef::new(shape)
    }
}

fn body(scene: &Scene, thing: &Thing) -> BodyDef {
    let kind = match thing.kind {
        Kind::Static => BodyKind::Static,
        Kind::Kinematic => BodyKind::Kinematic,
        Kind::Dynamic => BodyKind::Dynamic,
    };
    BodyDef {
        kind,
        position: pair(thing.at),
        angle: turn(thing.facing),
        velocity: pair(thing.velocity),
        angular_velocity: quantity(thing.spin),
        mass: thing.inertia.map(|(mass, _)| quantity(mass)),
        inertia: thing.inertia.map(|(_, inertia)| quantity(inertia)),
        linear_damping: quantity(thing.damping[0]),
        angular_damping: quantity(thing.damping[1]),
        fixed_rotation: thing.fixed_rotation,
        colliders: thing.parts.iter().map(|part| collider(scene, thing, part)).collect(),
        ..BodyDef::default()
    }
}

/// What a body is like, in SI units.
#[derive(Clone, Copy, Debug, Default)]
pub struct State {
    pub at: [f64; 2],
    pub angle: f64,
    pub velocity: [f64; 2],
    pub spin: f64,
}

/// A scene that goes on: a world, or what was written down of one in another engine.
pub trait Trial {
    fn run(&mut self, ticks: u64);
    /// The body that the scene has in this place.
    fn state(&self, at: usize) -> State;
    /// How many bodies the scene has.
    fn count(&self) -> usize;
    /// Ticks per second.
    fn rate(&self) -> f64;
    /// KE in J.
    fn kinetic(&self) -> f64;
    /// When in the last tick something met first, in seconds, where that is known.
    fn meeting(&self) -> Option<f64>;
}

impl Stage {
    pub fn new(scene: &Scene, setting: Setting) -> Stage {
        let Setting { rate, substeps } = setting;
        let sleeping = scene.sleeping.then(Sleeping::default);
        let def = WorldDef { gravity: pair(scene.gravity), tick_rate: rate, substeps, sleeping, ..WorldDef::default() };
        let mut world = World::new(&def).expect("scenes are accepted");
        let mut create = |thing: &Thing| world.create_body(&body(scene, thing)).expect("scenes are accepted");
        let ids = scene.things.iter().map(&mut create).collect();
        for &(position, mu) in &scene.attractors {
            let attractor = Attractor { position: pair(position), mu: quantity(mu) };
            world.create_attractor(attractor).expect("scenes are accepted");
        }
        Stage { world, ids, setting }
    }

    /// Mass of the body in this place, in kg; 0 unless it is dynamic.
    pub fn mass(&self, at: usize) -> f64 {
        let body = self.world.body(self.ids[at]).expect("scenes keep their bodies");
        if body.kind() == BodyKind::Dynamic { body.mass().to_f64() } else { 0.0 }
    }
}

impl Trial for Stage {
    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.world.step();
        }
    }

    fn state(&self, at: usize) -> State {
        let body = self.world.body(self.ids[at]).expect("scenes keep their bodies");
        let (p, v) = (body.position().to_f64(), body.velocity().to_f64());
        State {
            at: [p.0, p.1],
            angle: body.angle().to_radians_f64(),
            velocity: [v.0, v.1],
            spin: body.angular_velocity().to_f64(),
        }
    }

    fn count(&self) -> usize {
        self.ids.len()
    }

    fn rate(&self) -> f64 {
        f64::from(self.setting.rate)
    }

    fn kinetic(&self) -> f64 {
        self.world.bodies().map(|body| body.kinetic_energy().to_f64()).sum()
    }

    fn meeting(&self) -> Option<f64> {
        self.world.collisions().first().map(|first| first.time.to_f64())
    }
}
