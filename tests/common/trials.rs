//! Small worlds made of random numbers, integers alone, in which little that is left out or done in another order changes
//! bits: what hits nearly at one time, rows and stacks under blows, crowds that get commands, and what is hostile.
#![allow(dead_code, reason = "each test file uses its part of this one")]

use crate::draws::Draws;
use tamias2d::replay::Recorder;
use tamias2d::{
    Acceleration, Angle, AngularVelocity, Attractor, BodyDef, BodyId, BodyKind, ColliderDef, ColliderId, Command,
    Commands, Inertia, Integrator, Length, Mass, Shape, Sleeping, Time, Vec2, Velocity, World, WorldDef,
};

/// 1 m.
const METRE: i64 = 1 << 32;
/// The corners of polygons, in eighths of their size.
const CORNERS: [[i64; 2]; 8] = [[-8, -4], [0, -6], [7, -5], [8, 0], [5, 4], [0, 6], [-3, 6], [-8, 1]];

#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Some in a row, of which the outer ones come in and hit within micro- or nanoseconds of each other.
    Cradle,
    /// Rows and stacks that get blows.
    Row,
    /// A room full of bodies that get commands.
    Crowd,
    /// Masses and inertias of any order of magnitude, speeds up to the ends, thin walls, what turns and cannot be moved.
    Wild,
}

impl Kind {
    pub const ALL: [Kind; 4] = [Kind::Cradle, Kind::Row, Kind::Crowd, Kind::Wild];

    pub fn name(self) -> &'static str {
        ["cradle", "row", "crowd", "wild"][self as usize]
    }

    /// So many ticks are played of each.
    pub fn ticks(self) -> u64 {
        [3, 24, 32, 16][self as usize]
    }
}

/// What a world is told.
pub struct Trial {
    kind: Kind,
    draws: Draws,
    scale: Scale,
}

/// A world of a kind as it begins, and what will be commanded in it.
pub fn begin(kind: Kind, seed: u64) -> (World, Trial) {
    let mut draws = Draws::new((kind as u64) << 48 ^ seed);
    let scale = Scale::new(&mut draws);
    let world = match kind {
        Kind::Cradle => cradle(&mut draws),
        Kind::Row => row(&mut draws),
        Kind::Crowd => crowd(&mut draws),
        Kind::Wild => wild(&mut draws, scale),
    };
    (world, Trial { kind, draws, scale })
}

/// Plays a world; `after` sees it after every tick.
pub fn play(kind: Kind, seed: u64, mut after: impl FnMut(&World)) {
    let (mut world, mut trial) = begin(kind, seed);
    for _ in 0..kind.ticks() {
        for command in trial.commands(&world) {
            // Some are refused.
            let _ = world.apply(command);
        }
        world.step();
        after(&world);
    }
}

/// The recording of a world.
pub fn record(kind: Kind, seed: u64) -> Vec<u8> {
    let (world, mut trial) = begin(kind, seed);
    let mut recorder = Recorder::new(world, Vec::new()).expect("memory");
    for _ in 0..kind.ticks() {
        for command in trial.commands(recorder.world()) {
            let _ = recorder.apply(command);
        }
        recorder.step();
    }
    recorder.finish().expect("memory")
}

impl Trial {
    /// What is commanded before the next tick.
    fn commands(&mut self, world: &World) -> Vec<Command> {
        let percent = [0, 15, 35, 25][self.kind as usize];
        let count = if self.draws.chance(percent) { self.draws.between(1, 3) } else { 0 };
        (0..count).map(|_| self.command(world)).collect()
    }

    fn command(&mut self, world: &World) -> Command {
        let draws = &mut self.draws;
        let at = draws.below(world.body_count().max(1).into()) as usize;
        let body = world.bodies().nth(at).map_or(BodyId::default(), |body| body.id());
        match self.kind {
            Kind::Row if draws.chance(40) => Command::CreateBody { def: shot(draws) },
            Kind::Wild if draws.chance(40) => {
                Command::CreateBody { def: hostile(draws, BodyKind::Dynamic, self.scale) }
            }
            Kind::Row | Kind::Wild if draws.chance(60) => {
                let impulse = Vec2::new(draws.impulse(-6000, 6000), draws.impulse(-6000, 6000));
                Command::ApplyImpulse { body, impulse, point: draws.chance(50).then(|| place(draws, 800)) }
            }
            _ => any_command(draws, body, world),
        }
    }
}

/// A command of a crowd.
fn any_command(draws: &mut Draws, body: BodyId, world: &World) -> Command {
    let at = draws.below(world.colliders().count().max(1) as u64) as usize;
    let collider = world.colliders().nth(at).map_or(ColliderId::default(), |collider| collider.id());
    match draws.below(16) {
        0 | 1 => Command::CreateBody { def: member(draws) },
        2 => Command::DestroyBody { body },
        3 => Command::SetPosition { body, position: place(draws, 2500) },
        4 => Command::SetAngle { body, angle: Angle::from_bits(draws.between(-4, 4) << draws.pick(&[0, 20, 45])) },
        5 | 6 => Command::SetVelocity { body, velocity: velocity(draws, 20_000) },
        7 => Command::SetAngularVelocity { body, angular_velocity: draws.spin(-9000, 9000) },
        8 => {
            let kind = draws.pick(&[BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Static]);
            Command::SetKind { body, kind }
        }
        9 => Command::SetFixedRotation { body, fixed: draws.chance(50) },
        10 => {
            let restitution = draws.pick(&[0, 500, 1000]);
            Command::SetSurface {
                collider,
                restitution: draws.restitution(restitution, restitution),
                friction: draws.friction(0, 1500),
            }
        }
        11 => Command::PutToSleep { body },
        12 => Command::Wake { body },
        13 => Command::SetMass { body, mass: draws.mass(100, 90_000), inertia: draws.inertia(20_000, 90_000) },
        14 => {
            let gravity = Vec2::new(draws.acceleration(-1000, 1000), draws.acceleration(-9800, 0));
            Command::SetGravity { gravity }
        }
        _ => {
            Command::ApplyForce { body, force: Vec2::new(draws.force(-90_000, 90_000), draws.force(0, 0)), point: None }
        }
    }
}

fn bits(x: i64, y: i64) -> Vec2<Length> {
    Vec2::new(Length::from_bits(x), Length::from_bits(y))
}

/// Within ± so many thousandths of a metre.
fn place(draws: &mut Draws, most: i64) -> Vec2<Length> {
    Vec2::new(draws.length(-most, most), draws.length(-most, most))
}

fn velocity(draws: &mut Draws, most: i64) -> Vec2<Velocity> {
    Vec2::new(draws.velocity(-most, most), draws.velocity(-most, most))
}

/// A world of the usual rate, without bodies; gravity in thousandths.
fn empty(draws: &mut Draws, gravity: i64, sleeping: Option<Sleeping>) -> World {
    let gravity = Vec2::new(Acceleration::ZERO, draws.acceleration(gravity, gravity));
    World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("what is drawn so is accepted")
}

/// A static box of this size in bits, about a place.
fn wall(position: Vec2<Length>, [width, height]: [i64; 2], friction: i64, draws: &mut Draws) -> BodyDef {
    let [width, height] = [width, height].map(Length::from_bits);
    let friction = draws.friction(friction, friction);
    let colliders = vec![ColliderDef { friction, ..ColliderDef::new(Shape::Box { width, height }) }];
    BodyDef { kind: BodyKind::Static, position, colliders, ..BodyDef::default() }
}

/// A disc or a square of 1 m.
fn unit(draws: &mut Draws, disc: bool, [friction, restitution]: [i64; 2]) -> ColliderDef {
    let [side, half] = [METRE, METRE / 2].map(Length::from_bits);
    let shape = if disc { Shape::Circle { radius: half } } else { Shape::Box { width: side, height: side } };
    ColliderDef {
        friction: draws.friction(friction, friction),
        restitution: draws.restitution(restitution, restitution),
        ..ColliderDef::new(shape)
    }
}

fn cradle(draws: &mut Draws) -> World {
    let gravity = draws.pick(&[0, -9810, -9810, -9810, -9810]);
    let mut world = empty(draws, gravity, None);
    let surface = [draws.pick(&[0, 300, 600, 1000]), draws.pick(&[0, 0, 300, 900, 1000])];
    if gravity != 0 {
        let floor = wall(bits(0, -METRE / 2), [100 * METRE, METRE], surface[0], draws);
        world.create_body(&floor).expect("a floor");
    }
    let speed = draws.between(500, 40_000);
    // What is gone in so many nanoseconds: one at 1 mm/s is a 233rd of a unit of length.
    let way = |nanoseconds: i64| speed * nanoseconds / 233;
    let [near, far] = [draws.between(1, 1000), draws.between(10_000, 3_000_000)];
    let gap = way(draws.pick(&[0, near, far, far, far]));
    // Mirrored, within some 16 ns, within a microsecond.
    let apart = draws.pick(&[0, 60, 60, 60, 1000]);
    let inner = draws.pick(&[0, 0, 1, 20_000, 43_000_000, gap]);
    let (count, discs, alike) = (draws.pick(&[3, 3, 3, 4, 5, 6]), draws.pick(&[0, 100, 100, 50]), draws.chance(75));
    let mut put = |draws: &mut Draws, x: i64, y: i64, toward: [i64; 2]| {
        let density = if alike { 1000 } else { draws.pick(&[300, 1000, 20_000]) };
        let disc = draws.chance(discs);
        let collider = ColliderDef { density: draws.density(density, density), ..unit(draws, disc, surface) };
        let [vx, vy] = toward.map(|v| draws.velocity(v, v));
        let velocity = Vec2::new(vx, vy);
        let def = BodyDef { position: bits(x, y), velocity, colliders: vec![collider], ..BodyDef::default() };
        world.create_body(&def).expect("one of the row");
    };
    let mut x = -count / 2 * METRE;
    for at in 0..count {
        let toward = if at == 0 {
            speed
        } else if at == count - 1 {
            -speed
        } else {
            0
        };
        put(draws, x, METRE / 2, [toward, 0]);
        if (1..count - 1).contains(&at) && draws.chance(60) {
            // One from above comes as well.
            let late = draws.between(-apart, apart);
            put(draws, x, METRE / 2 + METRE + gap + way(late), [0, -speed]);
        }
        x += METRE + if at == 0 || at == count - 2 { gap } else { inner };
        x += if at == count - 2 { way(draws.between(-apart, apart)) } else { 0 };
    }
    world
}

/// A fast disc from one side.
fn shot(draws: &mut Draws) -> BodyDef {
    let (side, speed) = (draws.pick(&[-1, 1]), draws.between(2000, 60_000));
    let [radius, density] = [draws.pick(&[100, 250, 500]), draws.pick(&[1000, 8000])];
    let collider = ColliderDef {
        density: draws.density(density, density),
        ..ColliderDef::new(Shape::Circle { radius: draws.length(radius, radius) })
    };
    BodyDef {
        position: Vec2::new(draws.length(side * 5000, side * 5000), draws.length(500, 3000)),
        velocity: Vec2::new(draws.velocity(-side * speed, -side * speed), Velocity::ZERO),
        colliders: vec![collider],
        ..BodyDef::default()
    }
}

fn row(draws: &mut Draws) -> World {
    let mut world = empty(draws, -9810, None);
    let surface = [draws.pick(&[0, 300, 600]), draws.pick(&[0, 0, 500, 900, 1000])];
    let floor = wall(bits(0, -METRE / 2), [300 * METRE, METRE], surface[0], draws);
    world.create_body(&floor).expect("a floor");
    let (stack, count) = (draws.chance(40), draws.between(3, 8));
    let discs = if stack { draws.pick(&[0, 0, 15]) } else { draws.pick(&[0, 100, 50]) };
    let gap = draws.pick(&[0, 0, 43_000, METRE / 100, METRE / 20]);
    let aside = draws.pick(&[0, 1, METRE / 50]);
    let speed = if stack { 0 } else { draws.between(0, 30_000) };
    for at in 0..count {
        let disc = draws.chance(discs);
        let along = at * (METRE + gap);
        let jitter = draws.between(-aside, aside);
        let position = if stack { bits(jitter, METRE / 2 + along) } else { bits(along - count / 2 * METRE, METRE / 2) };
        let toward = [speed, 0, -speed][usize::from(at > 0) + usize::from(at == count - 1)];
        let velocity = Vec2::new(draws.velocity(toward, toward), Velocity::ZERO);
        let colliders = vec![unit(draws, disc, surface)];
        let def = BodyDef { position, velocity, colliders, ..BodyDef::default() };
        world.create_body(&def).expect("one of the row");
    }
    world
}

/// A circle, a box, or a polygon of three to eight corners, half as large as so many bits.
fn shape(draws: &mut Draws, [a, b]: [i64; 2]) -> Shape {
    match draws.below(3) {
        0 => Shape::Circle { radius: Length::from_bits(a) },
        1 => Shape::Box { width: Length::from_bits(2 * a), height: Length::from_bits(2 * b) },
        _ => {
            let left_out = draws.below(6) as usize;
            let corner = |&[x, y]: &[i64; 2]| bits(a / 8 * x, a / 8 * y);
            Shape::Polygon { vertices: CORNERS[left_out..].iter().map(corner).collect::<Vec<_>>() }
        }
    }
}

/// One of a crowd.
fn member(draws: &mut Draws) -> BodyDef {
    let [friction, restitution] = [draws.pick(&[0, 300, 600, 600, 3000]), draws.pick(&[0, 0, 0, 300, 1000])];
    let density = draws.pick(&[1000, 1000, 1000, 300, 50_000]);
    let compound = draws.chance(20);
    let mut collider = || {
        let size = [draws.between(METRE / 8, METRE / 2), draws.between(METRE / 8, METRE / 2)];
        let off = if compound { 500 } else { 0 };
        ColliderDef {
            shape: shape(draws, size),
            offset: place(draws, off),
            density: draws.density(density, density),
            restitution: draws.restitution(restitution, restitution),
            friction: draws.friction(friction, friction),
            sensor: draws.chance(4),
            ..ColliderDef::new(Shape::Circle { radius: Length::from_bits(METRE) })
        }
    };
    let colliders = if compound { vec![collider(), collider()] } else { vec![collider()] };
    let kind =
        draws.pick(&[BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Dynamic, BodyKind::Kinematic]);
    let speed = draws.pick(&[0, 1000, 5000, 40_000]);
    let spin = draws.pick(&[0, 2000, 30_000]);
    BodyDef {
        kind,
        position: place(draws, 2500),
        angle: draws.angle(0, 1000),
        velocity: if kind == BodyKind::Dynamic { velocity(draws, speed) } else { velocity(draws, 1000) },
        angular_velocity: draws.spin(-spin, spin),
        colliders,
        ..BodyDef::default()
    }
}

fn crowd(draws: &mut Draws) -> World {
    // They are to fall asleep within what is played.
    let sleeping = draws.chance(60).then(|| Sleeping { time: Time::from_bits(1 << 45), ..Sleeping::default() });
    let gravity = draws.pick(&[-9800, -9800, 0]);
    let mut world = empty(draws, gravity, sleeping);
    let thick = draws.pick(&[METRE, METRE, METRE / 100]);
    for (x, y) in [(0, -1), (0, 1), (-1, 0), (1, 0)] {
        let [width, height] = [thick + 7 * METRE * i64::from(x == 0), thick + 7 * METRE * i64::from(y == 0)];
        let out = 3 * METRE + thick / 2;
        let def = wall(bits(x * out, y * out), [width, height], 600, draws);
        world.create_body(&def).expect("a wall");
    }
    if draws.chance(15) {
        let mu = draws.mu(0, 20_000);
        let _ = world.create_attractor(Attractor { position: place(draws, 2000), mu });
    }
    for _ in 0..draws.between(4, 12) {
        let def = member(draws);
        world.create_body(&def).expect("one of the crowd");
    }
    world
}

/// Of so many bits, every order of magnitude as likely as the others.
fn magnitude(draws: &mut Draws, low: i64, high: i64) -> i128 {
    let power = 1i128 << draws.between(low, high);
    power + (i128::from(draws.bits()) << 64 | i128::from(draws.bits())).rem_euclid(power)
}

fn signed(draws: &mut Draws, low: i64, high: i64) -> i64 {
    let value = magnitude(draws, low, high) as i64;
    if draws.chance(50) { value } else { -value }
}

/// Of how many bits sizes, speeds and spins of a hostile world are at most.
#[derive(Clone, Copy, Default)]
struct Scale {
    size: i64,
    /// So many bits less at least.
    spread: i64,
    speed: i64,
    spin: i64,
}

impl Scale {
    fn new(draws: &mut Draws) -> Scale {
        Scale {
            size: draws.pick(&[32, 34, 38, 43, 43]),
            spread: draws.pick(&[0, 4, 9]),
            speed: draws.pick(&[45, 50, 54, 58, 61]),
            spin: draws.pick(&[48, 52, 56, 60, 60]),
        }
    }
}

/// One of a hostile world. Some are refused.
fn hostile(draws: &mut Draws, kind: BodyKind, scale: Scale) -> BodyDef {
    let [friction, restitution] = [draws.pick(&[0, 500, 1000, 16_000]), draws.pick(&[0, 0, 500, 1000])];
    let mut size = || magnitude(draws, scale.size - 1 - scale.spread, scale.size - 1) as i64;
    let [a, b] = [size(), size()];
    let shape = match draws.below(4) {
        0 => Shape::Box { width: Length::from_bits(1 << scale.size), height: Length::from_bits((a >> 7).max(1 << 23)) },
        _ => shape(draws, [a, b]),
    };
    let collider = ColliderDef {
        restitution: draws.restitution(restitution, restitution),
        friction: draws.friction(friction, friction),
        ..ColliderDef::new(shape)
    };
    let Scale { speed, spin, .. } = scale;
    let [x, y, omega] = [[speed - 10, speed], [speed - 10, speed], [spin - 10, spin]]
        .map(|[low, high]| if kind == BodyKind::Static { 0 } else { signed(draws, low, high) });
    let [weighs, turns] = [draws.chance(60), draws.chance(15)];
    let span = 2 << scale.size;
    BodyDef {
        kind,
        position: bits(draws.between(-span, span), draws.between(-span, span)),
        angle: draws.angle(0, 1000),
        velocity: Vec2::new(Velocity::from_bits(x), Velocity::from_bits(y)),
        angular_velocity: AngularVelocity::from_bits(omega),
        mass: weighs.then(|| Mass::from_bits(magnitude(draws, 45, 90))),
        inertia: turns.then(|| Inertia::from_bits(magnitude(draws, 45, 110))),
        colliders: vec![collider],
        ..BodyDef::default()
    }
}

fn wild(draws: &mut Draws, scale: Scale) -> World {
    let unit_shift = draws.pick(&[0, 0, 0, 5, 10]);
    let gravity = draws.between(-9800, 0) << unit_shift;
    let def = WorldDef {
        tick_rate: draws.pick(&[15, 60, 60, 240, 1000]),
        substeps: draws.pick(&[1, 2, 10, 10, 10, 64]),
        gravity: Vec2::new(Acceleration::ZERO, draws.acceleration(gravity, gravity)),
        integrator: draws.pick(&[Integrator::ForestRuth, Integrator::ForestRuth, Integrator::SymplecticEuler]),
        unit_shift,
        sleeping: draws.chance(50).then(Sleeping::default),
    };
    let mut world = World::new(&def).expect("what is drawn so is accepted");
    use BodyKind::{Dynamic, Kinematic, Static};
    for at in 0..draws.between(4, 12) {
        let kind = if at == 0 { Static } else { draws.pick(&[Dynamic, Dynamic, Dynamic, Dynamic, Kinematic, Static]) };
        let _ = world.create_body(&hostile(draws, kind, scale));
    }
    world
}
