//! Rooms full of bodies, and what happens to them: by a seed, for as long as one likes. All of it is what games do, so a tick stays
//! short; what is at the ends of ranges, the fuzzers look for.
#![allow(dead_code, reason = "each file uses its part of this one")]

use crate::common::{Rng, acc, at, disc, newton_seconds, newtons, rectangle, vel};
use tamias2d::{
    Acceleration, Angle, AngularVelocity, Attractor, Body, BodyDef, BodyId, BodyKind, Bound, ColliderDef, Command,
    Damping, Filter, Force, Friction, Impulse, Integrator, Length, Mass, Mu, Restitution, Shape, Sleeping, StatusEntry,
    Torque, Vec2, Velocity, World, WorldDef,
};

/// Half of the room's width, between the middles of its walls.
const ROOM: f64 = 12.0;

/// What happens.
pub struct Weather {
    rng: Rng,
    most: u64,
    bounces: bool,
}

impl Weather {
    /// A world that is still empty, and what happens in it.
    pub fn new(seed: u64) -> (WorldDef, Weather) {
        let mut rng = Rng(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let def = WorldDef {
            tick_rate: [60, 60, 30, 120, 240][rng.below(5) as usize],
            substeps: [10, 10, 4, 6, 12][rng.below(5) as usize],
            gravity: [acc(0.0, -9.81), acc(0.0, -9.81), acc(0.0, 0.0), acc(3.0, -1.0)][rng.below(4) as usize],
            integrator: if rng.below(8) == 0 { Integrator::SymplecticEuler } else { Integrator::ForestRuth },
            unit_shift: [0, 0, 0, 1, 3][rng.below(5) as usize],
            sleeping: [None, Some(Sleeping::default())][rng.below(2) as usize],
        };
        let (most, bounces) = (6 + rng.below(30), rng.below(3) == 0);
        (def, Weather { rng, most, bounces })
    }

    /// The room, a paddle that turns, and half of the bodies.
    pub fn begin(&mut self) -> Vec<Command> {
        let wall =
            |x: f64, y: f64, width: f64, height: f64| ColliderDef { offset: at(x, y), ..rectangle(width, height) };
        let long = 2.0 * ROOM + 1.0;
        let walls = vec![
            wall(0.0, -ROOM, long, 1.0),
            wall(0.0, ROOM, long, 1.0),
            wall(-ROOM, 0.0, 1.0, long),
            wall(ROOM, 0.0, 1.0, long),
        ];
        let room = BodyDef { kind: BodyKind::Static, colliders: walls, ..BodyDef::default() };
        let paddle = BodyDef {
            kind: BodyKind::Kinematic,
            position: at(self.rng.signed(0.5, 6.0), self.rng.signed(0.5, 6.0)),
            angular_velocity: AngularVelocity::from_f64(self.rng.signed(0.1, 3.0)).expect("in range"),
            colliders: vec![rectangle(self.rng.scale(1.0, 8.0), 0.4)],
            ..BodyDef::default()
        };
        let mut commands = vec![Command::CreateBody { def: room }, Command::CreateBody { def: paddle }];
        commands.extend((0..self.most / 2).map(|_| Command::CreateBody { def: self.body() }));
        commands
    }

    fn place(&mut self) -> Vec2<Length> {
        let inside = ROOM - 1.5;
        at((self.rng.unit() * 2.0 - 1.0) * inside, (self.rng.unit() * 2.0 - 1.0) * inside)
    }

    fn collider(&mut self) -> ColliderDef {
        let size = self.rng.scale(0.2, 1.5);
        let shape = match self.rng.below(5) {
            0 | 1 => disc(size * 0.5),
            2 => {
                let corner = |x, y| at(x * size, y * size);
                let vertices = vec![corner(-0.5, -0.4), corner(0.5, -0.4), corner(0.4, 0.3), corner(-0.1, 0.5)];
                ColliderDef::new(Shape::Polygon { vertices })
            }
            _ => rectangle(size, self.rng.scale(0.2, 1.5)),
        };
        let bounce = if self.bounces { [0.0, 0.5, 0.9, 1.0][self.rng.below(4) as usize] } else { 0.0 };
        ColliderDef {
            restitution: Restitution::from_f64(bounce).expect("in range"),
            friction: Friction::from_f64(self.rng.unit()).expect("in range"),
            sensor: self.rng.below(12) == 0,
            filter: self.filter(),
            ..shape
        }
    }

    fn filter(&mut self) -> Filter {
        match self.rng.below(10) {
            0 => Filter { category: 2, mask: 1 },
            _ => Filter { category: 1, mask: u32::MAX },
        }
    }

    fn body(&mut self) -> BodyDef {
        let mut colliders = vec![self.collider()];
        if self.rng.below(4) == 0 {
            let offset = at(self.rng.signed(0.1, 0.6), self.rng.signed(0.1, 0.6));
            colliders.push(ColliderDef { offset, sensor: false, ..self.collider() });
        }
        // A sensor alone has no mass.
        let weighs = colliders.iter().any(|collider| !collider.sensor) && self.rng.below(3) > 0;
        let dynamic = self.rng.below(16) > 0;
        BodyDef {
            kind: if dynamic { BodyKind::Dynamic } else { BodyKind::Kinematic },
            position: self.place(),
            angle: Angle::from_bits((self.rng.bits() >> 16) as i64),
            velocity: vel(self.rng.signed(0.01, 8.0), self.rng.signed(0.01, 8.0)),
            angular_velocity: AngularVelocity::from_f64(self.rng.signed(0.01, 8.0)).expect("in range"),
            mass: (!weighs).then(|| Mass::from_f64(self.rng.scale(0.1, 100.0)).expect("in range")),
            linear_damping: Damping::from_f64(if dynamic && self.rng.below(4) == 0 { 0.3 } else { 0.0 })
                .expect("in range"),
            allow_sleep: self.rng.below(8) > 0,
            colliders,
            ..BodyDef::default()
        }
    }

    /// One of the bodies but the room.
    fn any(&mut self, world: &World) -> BodyId {
        let count = u64::from(world.body_count()).max(2);
        let at = 1 + self.rng.below(count - 1) as usize;
        world.bodies().nth(at).map(|body| body.id()).unwrap_or_default()
    }

    /// What happens before a tick of a world: mostly nothing.
    pub fn commands(&mut self, world: &World) -> Vec<Command> {
        let count = if self.rng.below(8) == 0 { 1 + self.rng.below(3) } else { 0 };
        (0..count).map(|_| self.command(world)).collect()
    }

    fn command(&mut self, world: &World) -> Command {
        let body = self.any(world);
        let crowded = u64::from(world.body_count()) >= self.most + 2;
        let (x, y) = (self.rng.signed(0.1, 10.0), self.rng.signed(0.1, 10.0));
        match self.rng.below(28) {
            0..=4 if crowded => Command::DestroyBody { body },
            0..=3 => Command::CreateBody { def: self.body() },
            4 | 5 => Command::DestroyBody { body },
            6 => Command::SetPosition { body, position: self.place() },
            7 => Command::SetAngle { body, angle: Angle::from_bits((self.rng.bits() >> 14) as i64) },
            8 | 9 => Command::SetVelocity { body, velocity: vel(x, y) },
            10 => {
                Command::SetAngularVelocity { body, angular_velocity: AngularVelocity::from_f64(x).expect("in range") }
            }
            11 | 12 => Command::ApplyImpulse { body, impulse: newton_seconds(x, y), point: Some(self.place()) },
            13..=15 => Command::ApplyForce { body, force: newtons(x * 20.0, y * 20.0), point: None },
            16 => Command::ApplyTorque { body, torque: Torque::from_f64(x).expect("in range") },
            17 => Command::SetForce { body, force: newtons(x, y) },
            18 => Command::SetGravity { gravity: acc(x * 0.3, y - 5.0) },
            19 => Command::Wake { body },
            20 => Command::PutToSleep { body },
            21 => Command::SetAllowSleep { body, allow: self.rng.below(4) > 0 },
            22 => {
                let kind = [BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Static][self.rng.below(3) as usize];
                Command::SetKind { body, kind }
            }
            23 => Command::SetFixedRotation { body, fixed: self.rng.below(2) == 0 },
            24 => {
                let mu = Mu::from_f64(self.rng.scale(1.0, 100.0)).expect("in range");
                Command::CreateAttractor { attractor: Attractor { position: self.place(), mu } }
            }
            25 => {
                let id = world.attractors().next().map(|(id, _)| id).unwrap_or_default();
                Command::DestroyAttractor { id }
            }
            26 => match world.body(body).and_then(|body| body.colliders().next().map(|collider| collider.id())) {
                Some(collider) => Command::SetFilter { collider, filter: self.filter() },
                None => Command::ClearStatus,
            },
            _ => {
                Command::SetDamping { body, linear: Damping::from_bits(1 << 47), angular: Damping::from_bits(1 << 46) }
            }
        }
    }
}

/// A world seen from elsewhere: moved by so many units of a position, or turned by half a turn about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// By so much, 2⁻³² m.
    Moved([i64; 2]),
    /// By half a turn.
    Turned,
}

macro_rules! vector {
    ($turned:expr, $v:expr, $type:ident) => {{
        let v = $v;
        if $turned { Vec2::new($type::from_bits(-v.x.to_bits()), $type::from_bits(-v.y.to_bits())) } else { v }
    }};
}

/// Half a turn.
const HALF: i64 = 1 << 47;

impl View {
    fn point(self, p: Vec2<Length>) -> Vec2<Length> {
        match self {
            View::Moved(by) => {
                Vec2::new(Length::from_bits(p.x.to_bits() + by[0]), Length::from_bits(p.y.to_bits() + by[1]))
            }
            View::Turned => vector!(true, p, Length),
        }
    }

    fn angle(self, angle: Angle) -> Angle {
        if self == View::Turned { Angle::from_bits(angle.to_bits().wrapping_add(HALF)) } else { angle }
    }

    /// A world's definition as seen from there.
    pub fn def(self, def: &WorldDef) -> WorldDef {
        WorldDef { gravity: vector!(self == View::Turned, def.gravity, Acceleration), ..def.clone() }
    }

    /// A command as given there.
    pub fn command(self, command: Command) -> Command {
        let turned = self == View::Turned;
        match command {
            Command::CreateBody { def } => Command::CreateBody {
                def: BodyDef {
                    position: self.point(def.position),
                    angle: self.angle(def.angle),
                    velocity: vector!(turned, def.velocity, Velocity),
                    force: vector!(turned, def.force, Force),
                    ..def
                },
            },
            Command::SetPosition { body, position } => Command::SetPosition { body, position: self.point(position) },
            Command::SetAngle { body, angle } => Command::SetAngle { body, angle: self.angle(angle) },
            Command::SetVelocity { body, velocity } => {
                Command::SetVelocity { body, velocity: vector!(turned, velocity, Velocity) }
            }
            Command::SetForce { body, force } => Command::SetForce { body, force: vector!(turned, force, Force) },
            Command::ApplyForce { body, force, point } => {
                Command::ApplyForce { body, force: vector!(turned, force, Force), point: point.map(|p| self.point(p)) }
            }
            Command::ApplyImpulse { body, impulse, point } => Command::ApplyImpulse {
                body,
                impulse: vector!(turned, impulse, Impulse),
                point: point.map(|p| self.point(p)),
            },
            Command::CreateAttractor { attractor } => Command::CreateAttractor {
                attractor: Attractor { position: self.point(attractor.position), ..attractor },
            },
            Command::SetGravity { gravity } => Command::SetGravity { gravity: vector!(turned, gravity, Acceleration) },
            other => other,
        }
    }

    /// The first field in which a world seen from there is not as it must be.
    pub fn difference(self, here: &World, there: &World) -> Option<String> {
        if here.body_count() != there.body_count() {
            return Some(format!("body_count: {} and {}", here.body_count(), there.body_count()));
        }
        for (a, b) in here.bodies().zip(there.bodies()) {
            let id = a.id();
            if id != b.id() {
                return Some(format!("id: {id} and {}", b.id()));
            }
            if let Some((name, a, b)) = self.unlike(&a, &b) {
                return Some(format!("{id}.{name}: {b} instead of {a}"));
            }
        }
        if here.events() != there.events() {
            return Some(format!("events: {:?} and {:?}", here.events(), there.events()));
        }
        // When the end of the turns is met hangs on half a turn, see below.
        let told = |entry: &&StatusEntry| self != View::Turned || entry.bound != Bound::Turns;
        let [here, there] = [here, there].map(|world| world.status().entries().iter().filter(told));
        (!here.eq(there)).then(|| "status".into())
    }

    /// A number of a body that is not as it must be, both.
    fn unlike(self, here: &Body<'_>, there: &Body<'_>) -> Option<(&'static str, i64, i64)> {
        let pairs = self.seen(here).into_iter().zip(View::Moved([0, 0]).seen(there));
        // An angle that has come to the end of its range goes on a whole turn before it. Half a turn sooner or later: then one of them
        // is a turn behind the other, within the last two.
        let again = |a: i64, b: i64| {
            let last = i64::MAX.unsigned_abs() - 4 * HALF.unsigned_abs();
            self == View::Turned
                && a.wrapping_sub(b).unsigned_abs() == 2 * HALF.unsigned_abs()
                && b.unsigned_abs() > last
        };
        let mut unlike = pairs.map(|((name, a), (_, b))| (name, a, b));
        unlike.find(|&(name, a, b)| a != b && !(name == "angle" && again(a, b)))
    }

    /// What moves of a body, as it must look from there. The centre: an origin is derived from it, and rounded.
    fn seen(self, body: &Body<'_>) -> [(&'static str, i64); 7] {
        let p = self.point(body.center_of_mass());
        let v = vector!(self == View::Turned, body.velocity(), Velocity);
        [
            ("center.x", p.x.to_bits()),
            ("center.y", p.y.to_bits()),
            ("velocity.x", v.x.to_bits()),
            ("velocity.y", v.y.to_bits()),
            ("angle", self.angle(body.angle()).to_bits()),
            ("angular_velocity", body.angular_velocity().to_bits()),
            ("awake", i64::from(body.is_awake())),
        ]
    }
}
