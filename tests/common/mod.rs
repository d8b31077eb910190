//! Shared by the tests: short constructors, random commands, and an allocator that counts.
#![allow(dead_code, reason = "each test file uses its part of this one")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::str::FromStr;
use tamias2d::{
    Acceleration, Attractor, AttractorId, BodyDef, BodyId, BodyKind, ColliderDef, ColliderId, Command, CommandError,
    Commands, Filter, Force, Friction, Impulse, Length, NumError, Reply, Restitution, Shape, Vec2, Velocity, World,
    WorldDef,
};

/// One unit of a position, in metres.
pub const ULP_X: f64 = 1.0 / 4_294_967_296.0;
/// One unit of a velocity or an acceleration, in m/s, rad/s, m/s² or rad/s².
pub const ULP_V: f64 = 1.0 / 281_474_976_710_656.0;
/// One unit of an angle, in radians.
pub const ULP_PHI: f64 = std::f64::consts::TAU * ULP_V;

/// A quantity from its decimal text.
pub fn num<Q: FromStr<Err = NumError>>(text: &str) -> Q {
    text.parse().expect("a number in range")
}

macro_rules! vectors {
    ($($(#[$doc:meta])* $name:ident: $quantity:ident;)*) => {$(
        $(#[$doc])*
        pub fn $name(x: f64, y: f64) -> Vec2<$quantity> {
            Vec2::from_f64(x, y).expect("in range")
        }
    )*};
}

vectors! {
    /// A position in metres.
    at: Length;
    /// A velocity in m/s.
    vel: Velocity;
    /// An acceleration in m/s².
    acc: Acceleration;
    /// A force in N.
    newtons: Force;
    /// An impulse in N s.
    newton_seconds: Impulse;
}

/// An empty world with 60 ticks per second and this gravity.
pub fn world(gx: f64, gy: f64) -> World {
    World::new(&WorldDef { gravity: acc(gx, gy), ..WorldDef::default() }).expect("accepted")
}

/// A disc at its body's origin.
pub fn disc(radius: f64) -> ColliderDef {
    ColliderDef::new(Shape::Circle { radius: Length::from_f64(radius).expect("in range") })
}

/// A rectangle at its body's origin.
pub fn rectangle(width: f64, height: f64) -> ColliderDef {
    let [width, height] = [width, height].map(|side| Length::from_f64(side).expect("in range"));
    ColliderDef::new(Shape::Box { width, height })
}

/// Steps `ticks` times.
pub fn run(world: &mut World, ticks: u64) {
    for _ in 0..ticks {
        world.step();
    }
}

/// The position of a body in metres.
pub fn position(world: &World, id: BodyId) -> (f64, f64) {
    world.body(id).expect("it exists").position().to_f64()
}

/// The velocity of a body in m/s.
pub fn velocity(world: &World, id: BodyId) -> (f64, f64) {
    world.body(id).expect("it exists").velocity().to_f64()
}

/// The unwrapped angle of a body in radians.
pub fn phi(world: &World, id: BodyId) -> f64 {
    world.body(id).expect("it exists").angle().to_radians_f64()
}

/// The angular velocity of a body in rad/s.
pub fn omega(world: &World, id: BodyId) -> f64 {
    world.body(id).expect("it exists").angular_velocity().to_f64()
}

/// Asserts that two numbers are within `tolerance` of each other.
#[track_caller]
pub fn close(got: f64, want: f64, tolerance: f64) {
    let error = (got - want).abs();
    assert!(error <= tolerance, "{got} is not {want}: the error {error:e} is above {tolerance:e}");
}

/// Asserts [`close`] for both components.
#[track_caller]
pub fn close2(got: (f64, f64), want: (f64, f64), tolerance: f64) {
    close(got.0, want.0, tolerance);
    close(got.1, want.1, tolerance);
}

/// A small generator of random numbers (SplitMix64), the same on every machine.
#[derive(Clone)]
pub struct Rng(pub u64);

impl Rng {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `count`.
    pub fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number between two positive ones, every order of magnitude as likely as the others.
    pub fn scale(&mut self, least: f64, most: f64) -> f64 {
        least * (most / least).powf(self.unit())
    }

    /// As [`Rng::scale`], of either sign, and sometimes 0.
    pub fn signed(&mut self, least: f64, most: f64) -> f64 {
        match self.below(9) {
            0 => 0.0,
            1..=4 => -self.scale(least, most),
            _ => self.scale(least, most),
        }
    }
}

/// A stream of random commands: all kinds of them, on bodies that exist and on some that do not any more.
#[derive(Clone)]
pub struct Storm {
    /// What decides.
    pub rng: Rng,
    /// Positions are within ± this.
    pub reach: f64,
    /// Whether bodies have colliders.
    solid: bool,
    bodies: Vec<BodyId>,
    attractors: Vec<AttractorId>,
}

impl Storm {
    /// A storm with positions within ±`reach`, of bodies without colliders.
    pub fn new(seed: u64, reach: f64) -> Storm {
        Storm { rng: Rng(seed), reach, solid: false, bodies: Vec::new(), attractors: Vec::new() }
    }

    /// A storm of bodies of which most have colliders.
    pub fn solid(seed: u64, reach: f64) -> Storm {
        Storm { solid: true, ..Storm::new(seed, reach) }
    }

    /// Carries out the next command.
    pub fn act(&mut self, target: &mut impl Commands) -> Result<Reply, CommandError> {
        let command = self.command();
        let reply = target.apply(command);
        self.heed(reply)
    }

    /// `count` commands and then a tick.
    pub fn tick(&mut self, world: &mut World, count: u64) {
        for _ in 0..count {
            let _refused_or_not = self.act(world);
        }
        world.step();
    }

    /// Remembers the ids that a reply gives out.
    pub fn heed(&mut self, reply: Result<Reply, CommandError>) -> Result<Reply, CommandError> {
        match reply {
            Ok(Reply::Body(id)) => self.bodies.push(id),
            Ok(Reply::Attractor(id)) => self.attractors.push(id),
            _ => {}
        }
        reply
    }

    fn place(&mut self) -> Vec2<Length> {
        at(self.rng.signed(1e-3, self.reach), self.rng.signed(1e-3, self.reach))
    }

    fn point(&mut self) -> Option<Vec2<Length>> {
        (self.rng.below(2) == 0).then(|| self.place())
    }

    fn kind(&mut self) -> BodyKind {
        [BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Static]
            [self.rng.below(5) as usize]
    }

    fn mu(&mut self) -> f64 {
        if self.rng.below(3) == 0 { self.rng.scale(1e-9, 1e12) } else { 0.0 }
    }

    fn attractor(&mut self) -> Attractor {
        let mu = self.rng.scale(1e-9, 1e15);
        Attractor { position: self.place(), mu: tamias2d::Mu::from_f64(mu).expect("in range") }
    }

    fn filter(&mut self) -> Filter {
        let bits = |rng: &mut Rng| 1 | rng.bits() as u32 & 6;
        Filter { category: bits(&mut self.rng), mask: bits(&mut self.rng) }
    }

    fn collider(&mut self) -> ColliderDef {
        let size = self.rng.scale(0.1, 10.0);
        let shape = match self.rng.below(4) {
            0 => disc(size),
            1 => {
                let corner = |x, y| at(x * size, y * size);
                let vertices = vec![corner(-1.0, -0.5), corner(0.9, -0.6), corner(0.7, 0.4), corner(-0.2, 0.8)];
                ColliderDef::new(Shape::Polygon { vertices })
            }
            _ => rectangle(size, self.rng.scale(0.1, 10.0)),
        };
        let filter = if self.rng.below(4) == 0 { self.filter() } else { Filter::default() };
        ColliderDef {
            offset: if self.rng.below(2) == 0 {
                at(self.rng.signed(0.01, 3.0), self.rng.signed(0.01, 3.0))
            } else {
                at(0.0, 0.0)
            },
            angle: tamias2d::Angle::from_bits((self.rng.bits() >> 16) as i64),
            restitution: Restitution::from_f64(self.rng.unit()).expect("in range"),
            friction: Friction::from_f64(self.rng.unit()).expect("in range"),
            sensor: self.rng.below(8) == 0,
            filter,
            ..shape
        }
    }

    /// A collider that there may be.
    fn collider_id(&mut self) -> ColliderId {
        let count = self.bodies.len() as u64 + 1;
        ColliderId { index: self.rng.below(count) as u32, generation: self.rng.below(3) as u32 }
    }

    fn def(&mut self) -> BodyDef {
        let colliders = if self.solid { self.rng.below(4) } else { 0 };
        let colliders: Vec<ColliderDef> = (0..colliders).map(|_| self.collider()).collect();
        let given = colliders.is_empty() || self.rng.below(3) == 0;
        let kind = self.kind();
        let position = self.place();
        let mu = self.mu();
        let rng = &mut self.rng;
        let moves = kind != BodyKind::Static;
        let dynamic = kind == BodyKind::Dynamic;
        let fixed = rng.below(5) == 0;
        let some = |value: f64, allowed: bool| if allowed { value } else { 0.0 };
        BodyDef {
            kind,
            position,
            angle: tamias2d::Angle::from_bits((rng.bits() >> 12) as i64),
            velocity: vel(some(rng.signed(1e-6, 1e3), moves), some(rng.signed(1e-6, 1e3), moves)),
            angular_velocity: tamias2d::AngularVelocity::from_f64(some(rng.signed(1e-6, 1e3), moves && !fixed))
                .expect("in range"),
            force: newtons(some(rng.signed(1e-6, 1e3), dynamic), some(rng.signed(1e-6, 1e3), dynamic)),
            torque: tamias2d::Torque::from_f64(some(rng.signed(1e-6, 1e3), dynamic && !fixed)).expect("in range"),
            mass: given.then(|| tamias2d::Mass::from_f64(rng.scale(0.1, 1e6)).expect("in range")),
            inertia: given.then(|| tamias2d::Inertia::from_f64(rng.scale(0.1, 1e9)).expect("in range")),
            center: (!given && rng.below(4) == 0).then(|| at(rng.signed(0.01, 3.0), rng.signed(0.01, 3.0))),
            fixed_rotation: fixed,
            linear_damping: tamias2d::Damping::from_f64(some(
                rng.scale(0.01, 1000.0),
                dynamic && rng.clone().below(2) == 0,
            ))
            .expect("in range"),
            angular_damping: tamias2d::Damping::from_f64(some(
                rng.scale(0.01, 1000.0),
                dynamic && rng.clone().below(2) == 0,
            ))
            .expect("in range"),
            mu: tamias2d::Mu::from_f64(mu).expect("in range"),
            user_data: rng.bits(),
            allow_sleep: rng.clone().below(8) > 0,
            colliders,
        }
    }

    /// The next command. Many are accepted, some are not.
    pub fn command(&mut self) -> Command {
        use tamias2d::{Angle, AngularImpulse, AngularVelocity, Damping, Inertia, Mass, Mu, Torque};
        let unknown = BodyId { index: 7, generation: 7 };
        let body = match self.bodies.len() as u64 {
            0 => unknown,
            // Rather one of the later ones, which still exist.
            count => self.bodies[(count - 1 - self.rng.below(count.min(8))) as usize],
        };
        let id = match self.attractors.len() as u64 {
            0 => AttractorId { index: 7, generation: 7 },
            count => self.attractors[(count - 1 - self.rng.below(count.min(3))) as usize],
        };
        let choice = match self.bodies.len() {
            0..4 => 0,
            _ => self.rng.below(if self.solid { 46 } else { 42 }),
        };
        match choice {
            0..=5 => Command::CreateBody { def: self.def() },
            6..=8 => Command::DestroyBody { body },
            9 => Command::SetKind { body, kind: self.kind() },
            10 => Command::SetPosition { body, position: self.place() },
            11 => Command::SetAngle { body, angle: Angle::from_bits(self.rng.bits() as i64) },
            12 => Command::SetVelocity { body, velocity: vel(self.rng.signed(1e-6, 3e4), self.rng.signed(1e-6, 3e4)) },
            13 => {
                let spin = self.rng.signed(1e-6, 3e4);
                Command::SetAngularVelocity { body, angular_velocity: AngularVelocity::from_f64(spin).expect("fits") }
            }
            14..=15 => {
                Command::SetForce { body, force: newtons(self.rng.signed(1e-6, 1e5), self.rng.signed(1e-6, 1e5)) }
            }
            16 => Command::SetTorque { body, torque: Torque::from_f64(self.rng.signed(1e-6, 1e5)).expect("fits") },
            17 => Command::SetMass {
                body,
                mass: Mass::from_f64(self.rng.scale(1e-3, 1e6)).expect("fits"),
                inertia: Inertia::from_f64(self.rng.scale(1e-3, 1e9)).expect("fits"),
            },
            18 => Command::SetFixedRotation { body, fixed: self.rng.below(2) == 0 },
            19..=20 => Command::SetDamping {
                body,
                linear: Damping::from_f64(self.rng.signed(0.01, 1000.0).max(0.0)).expect("fits"),
                angular: Damping::from_f64(self.rng.signed(0.01, 1000.0).max(0.0)).expect("fits"),
            },
            21 => Command::SetMu { body, mu: Mu::from_f64(self.mu()).expect("fits") },
            22 => Command::SetUserData { body, user_data: self.rng.bits() },
            23..=26 => Command::ApplyForce {
                body,
                force: newtons(self.rng.signed(1e-6, 1e5), self.rng.signed(1e-6, 1e5)),
                point: self.point(),
            },
            27..=28 => {
                Command::ApplyTorque { body, torque: Torque::from_f64(self.rng.signed(1e-6, 1e5)).expect("fits") }
            }
            29..=31 => Command::ApplyImpulse {
                body,
                impulse: newton_seconds(self.rng.signed(1e-6, 1e4), self.rng.signed(1e-6, 1e4)),
                point: self.point(),
            },
            32 => {
                let impulse = AngularImpulse::from_f64(self.rng.signed(1e-6, 1e4)).expect("fits");
                Command::ApplyAngularImpulse { body, impulse }
            }
            33..=34 => Command::CreateAttractor { attractor: self.attractor() },
            35 => Command::SetAttractor { id, attractor: self.attractor() },
            36..=37 => Command::DestroyAttractor { id },
            38 => Command::SetGravity { gravity: acc(self.rng.signed(1e-6, 1e3), self.rng.signed(1e-6, 1e3)) },
            39 => Command::ClearStatus,
            42..=43 => Command::SetSurface {
                collider: self.collider_id(),
                restitution: Restitution::from_f64(self.rng.unit()).expect("fits"),
                friction: Friction::from_f64(self.rng.unit()).expect("fits"),
            },
            44..=45 => Command::SetFilter { collider: self.collider_id(), filter: self.filter() },
            _ => {
                let length = self.rng.below(20);
                Command::Input { bytes: (0..length).map(|_| self.rng.bits() as u8).collect() }
            }
        }
    }
}

/// Counts what each thread allocates. A test file makes it its global allocator.
pub struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

fn count(size: usize) {
    ALLOCATIONS.with(|n| n.set(n.get() + 1));
    LARGEST.with(|n| n.set(n.get().max(size)));
}

// SAFETY: every call goes to the system's allocator unchanged; the counters are thread-local cells without a
// destructor, so reaching them neither allocates nor fails.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`, which is that of the system's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the pointer came from `System` above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        // SAFETY: the pointer came from `System` above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// What `work` gives, how often this thread allocated in it, and the largest allocation in bytes.
pub fn measure<T>(work: impl FnOnce() -> T) -> (T, u64, usize) {
    ALLOCATIONS.with(|n| n.set(0));
    LARGEST.with(|n| n.set(0));
    let result = work();
    (result, ALLOCATIONS.with(Cell::get), LARGEST.with(Cell::get))
}
