//! A world made of random numbers, and the commands that it gets: all that there is, in bursts between which bodies may come
//! to rest.

use super::draws::Draws;
use tamias2d::{
    Attractor, AttractorId, BodyDef, BodyId, BodyKind, ColliderDef, ColliderId, Command, Commands, Filter, Integrator,
    Length, Reply, Shape, Sleeping, Threads, Vec2, Velocity, World, WorldDef,
};

/// So many ticks are played of each scene.
pub const TICKS: u64 = 800;
/// Commands come in the first ticks of each so many.
const PERIOD: u64 = 266;

/// The corners of polygons: some of eight on a circle, in thousandths of its radius.
const CORNERS: [[i64; 2]; 8] =
    [[1000, 0], [707, 707], [0, 1000], [-707, 707], [-1000, 0], [-707, -707], [0, -1000], [707, -707]];

pub struct Scene {
    pub world: World,
    draws: Draws,
    /// What there was and, mostly, is.
    bodies: Vec<BodyId>,
    attractors: Vec<AttractorId>,
    /// How far from the middle bodies begin, and how fast, in thousandths.
    reach: i64,
    speed: i64,
    /// What bodies are made of.
    restitutions: &'static [i64],
    densities: &'static [i64],
    /// So many bodies are kept there.
    most: u32,
    /// Whether attractors come and go.
    pulls: bool,
    /// Whether values are at the edges of their ranges.
    edges: bool,
}

impl Scene {
    /// Seeds that five divides give worlds, bodies and commands at the edges of every range.
    pub fn new(seed: u64) -> Scene {
        let mut draws = Draws::new(seed);
        let edges = seed % 5 == 0;
        let unit_shift = if edges { draws.pick(&[0, 10]) } else { draws.pick(&[0, 0, 1, 5]) };
        let unit = 1 << unit_shift;
        let gravity = draws.pick(&[0, -9_800, -9_800]) * unit;
        let def = WorldDef {
            tick_rate: if edges { draws.pick(&[15, 60, 1000]) } else { draws.pick(&[30, 60, 60, 120]) },
            substeps: if edges { draws.pick(&[1, 10, 64]) } else { draws.pick(&[4, 10, 10, 13]) },
            gravity: Vec2::new(draws.acceleration(0, 0), draws.acceleration(gravity, gravity)),
            integrator: draws.pick(&[Integrator::ForestRuth, Integrator::ForestRuth, Integrator::SymplecticEuler]),
            unit_shift,
            sleeping: draws.chance(70).then(Sleeping::default),
        };
        let mut scene = Scene {
            world: World::new(&def).expect("what is drawn so is accepted"),
            reach: draws.pick(&[4_000, 6_000, 9_000]) * unit,
            speed: draws.pick(&[1_000, 5_000, 60_000]) * unit,
            restitutions: draws.pick(&[&[0][..], &[0, 0, 300, 800], &[1000]]),
            densities: draws.pick(&[&[1000][..], &[200, 1000, 5000], &[1000, 1000, 400_000]]),
            most: if edges { 16 } else { draws.between(20, 60) as u32 },
            pulls: draws.chance(40),
            edges,
            bodies: Vec::new(),
            attractors: Vec::new(),
            draws,
        };
        if scene.draws.chance(80) {
            scene.enclose();
        }
        scene
    }

    /// Commands and a step; `heard` is told which commands, and whether they were accepted.
    pub fn tick(&mut self, threads: &Threads, mut heard: impl FnMut(&Command, bool)) {
        let within = self.world.tick() % PERIOD;
        let commands = match within {
            0..20 => 4,
            20..50 => u64::from(within % 3 == 0),
            // Else mostly nothing, and nothing that moves what rests.
            _ => 0,
        };
        for _ in 0..commands {
            let command = self.command();
            self.carry_out(command, &mut heard);
        }
        if within > PERIOD / 2 && self.draws.chance(3) {
            let body = self.body();
            let command = if self.draws.chance(50) { Command::Wake { body } } else { Command::PutToSleep { body } };
            self.carry_out(command, &mut heard);
        }
        self.world.step_on(threads);
    }

    fn carry_out(&mut self, command: Command, heard: &mut impl FnMut(&Command, bool)) {
        let reply = self.world.apply(command.clone());
        heard(&command, reply.is_ok());
        match (reply, command) {
            (Ok(Reply::Body(id)), _) => self.bodies.push(id),
            (Ok(Reply::Attractor(id)), _) => self.attractors.push(id),
            // A few ids of what is gone are kept.
            (Ok(_), Command::DestroyBody { body }) if self.bodies.len() > 8 && self.draws.chance(90) => {
                self.bodies.retain(|id| *id != body);
            }
            (Ok(_), Command::DestroyAttractor { id }) if self.draws.chance(70) => {
                self.attractors.retain(|other| *other != id);
            }
            _ => {}
        }
    }

    /// A floor, two walls and a lid.
    fn enclose(&mut self) {
        let reach = self.reach;
        let (out, thick) = (reach + reach / 2, reach / 2);
        for (x, y, width, height) in [
            (0, -out, 4 * reach, thick),
            (0, out, 4 * reach, thick),
            (-out, 0, thick, 4 * reach),
            (out, 0, thick, 4 * reach),
        ] {
            // No collider is longer.
            let [width, height] = [width, height].map(|side| side.min(16_000_000));
            let [width, height] = [width, height].map(|side| self.draws.length(side, side));
            let colliders = vec![ColliderDef::new(Shape::Box { width, height })];
            let position = Vec2::new(self.draws.length(x, x), self.draws.length(y, y));
            let def = BodyDef { kind: BodyKind::Static, position, colliders, ..BodyDef::default() };
            self.world.create_body(&def).expect("a wall");
        }
    }

    fn unit(&self) -> i64 {
        1 << self.world.config().unit_shift
    }

    fn place(&mut self) -> Vec2<Length> {
        Vec2::new(self.draws.length(-self.reach, self.reach), self.draws.length(-self.reach, self.reach))
    }

    fn velocity(&mut self) -> Vec2<Velocity> {
        Vec2::new(self.draws.velocity(-self.speed, self.speed), self.draws.velocity(-self.speed, self.speed))
    }

    fn filter(&mut self) -> Filter {
        let category = self.draws.pick(&[1, 2, 4, 3]);
        Filter { category, mask: self.draws.pick(&[u32::MAX, u32::MAX, 1, 6]) }
    }

    fn shape(&mut self) -> Shape {
        let unit = self.unit();
        let [a, b] = [(); 2].map(|()| self.draws.between(200, 900) * unit);
        match self.draws.below(3) {
            0 => Shape::Circle { radius: self.draws.length(a / 2, a) },
            1 => Shape::Box { width: self.draws.length(a, 2 * a), height: self.draws.length(b, 2 * b) },
            _ => {
                let corners = self.draws.below(1 << 8);
                let wanted = |at: &usize| corners >> at & 1 == 1;
                let some: Vec<usize> = (0..CORNERS.len()).filter(wanted).collect();
                let some = if some.len() < 3 { vec![0, 3, 6] } else { some };
                let corner = |at: usize| {
                    let [x, y] = [CORNERS[at][0] * a / 1000, CORNERS[at][1] * b / 1000];
                    Vec2::new(self.draws.length(x, x), self.draws.length(y, y))
                };
                Shape::Polygon { vertices: some.into_iter().map(corner).collect() }
            }
        }
    }

    fn collider(&mut self, compound: bool) -> ColliderDef {
        let off = if compound { 700 * self.unit() } else { 0 };
        let density = self.draws.pick(self.densities);
        let restitution = self.draws.pick(self.restitutions);
        let friction = self.draws.pick(&[0, 300, 600, 600, 2000]);
        ColliderDef {
            shape: self.shape(),
            offset: Vec2::new(self.draws.length(-off, off), self.draws.length(-off, off)),
            angle: self.draws.angle(0, if compound { 1000 } else { 0 }),
            density: self.draws.density(density, density),
            restitution: self.draws.restitution(restitution, restitution),
            friction: self.draws.friction(friction, friction),
            filter: if self.draws.chance(10) { self.filter() } else { Filter::default() },
            sensor: self.draws.chance(6),
        }
    }

    fn kind(&mut self) -> BodyKind {
        use BodyKind::{Dynamic, Kinematic, Static};
        self.draws.pick(&[Dynamic, Dynamic, Dynamic, Dynamic, Dynamic, Dynamic, Dynamic, Kinematic, Static])
    }

    fn body_def(&mut self) -> BodyDef {
        let count = self.draws.pick(&[1, 1, 1, 1, 2, 3, 0]);
        let kind = self.kind();
        let (moves, dynamic) = (kind != BodyKind::Static, kind == BodyKind::Dynamic);
        let fixed_rotation = self.draws.chance(8);
        let pushed = dynamic && self.draws.chance(8);
        let damped = dynamic && self.draws.chance(20);
        let [mass, inertia] = [self.draws.chance(15), self.draws.chance(5)];
        let spins = moves && !fixed_rotation;
        BodyDef {
            kind,
            position: self.place(),
            angle: self.draws.angle(-2000, 2000),
            velocity: if moves { self.velocity() } else { Vec2::default() },
            angular_velocity: if spins { self.draws.spin(-3000, 3000) } else { Default::default() },
            force: if pushed { self.force(3000) } else { Vec2::default() },
            torque: if pushed && !fixed_rotation { self.draws.torque(-3000, 3000) } else { Default::default() },
            mass: mass.then(|| self.draws.mass(100, 50_000)),
            inertia: inertia.then(|| self.draws.inertia(20_000, 90_000)),
            center: self.draws.chance(5).then(|| Vec2::new(self.draws.length(-200, 200), self.draws.length(-200, 200))),
            fixed_rotation,
            linear_damping: if damped { self.draws.damping(0, 3000) } else { Default::default() },
            angular_damping: if damped { self.draws.damping(0, 3000) } else { Default::default() },
            mu: if self.pulls && self.draws.chance(4) { self.mu() } else { Default::default() },
            user_data: self.draws.bits(),
            allow_sleep: self.draws.chance(95),
            colliders: (0..count).map(|_| self.collider(count > 1)).collect(),
        }
    }

    /// Up to so many thousandths of a newton for what weighs as much as things of this size.
    fn force(&mut self, most: i64) -> Vec2<tamias2d::Force> {
        let most = most * self.unit();
        Vec2::new(self.draws.force(-most, most), self.draws.force(-most, most))
    }

    fn impulse(&mut self) -> Vec2<tamias2d::Impulse> {
        let most = 4000 * self.unit();
        Vec2::new(self.draws.impulse(-most, most), self.draws.impulse(-most, most))
    }

    /// What pulls by up to some m/s² across the scene.
    fn mu(&mut self) -> tamias2d::Mu {
        let across = self.reach / 1000;
        self.draws.mu(0, 1000 * self.unit() * across * across)
    }

    fn attractor(&mut self) -> Attractor {
        Attractor { position: self.place(), mu: self.mu() }
    }

    fn body(&mut self) -> BodyId {
        match self.bodies.len() as u64 {
            0 => BodyId { index: 7, generation: 7 },
            count => self.bodies[self.draws.below(count) as usize],
        }
    }

    fn attractor_id(&mut self) -> AttractorId {
        match self.attractors.len() as u64 {
            0 => AttractorId { index: 7, generation: 7 },
            count => self.attractors[self.draws.below(count) as usize],
        }
    }

    /// One that there may be.
    fn collider_id(&mut self) -> ColliderId {
        let count = self.world.colliders().count() as u64;
        match self.world.colliders().nth(self.draws.below(count + 1) as usize) {
            Some(collider) => collider.id(),
            None => ColliderId { index: 7, generation: 7 },
        }
    }

    /// The next command. Many are accepted, some are not.
    fn command(&mut self) -> Command {
        let (body, live) = (self.body(), self.world.body_count());
        let point = self.draws.chance(50).then(|| self.place());
        let choice = if live < self.most / 2 { 0 } else { self.draws.below(48) };
        // A body has so many values that it would hardly ever be accepted.
        self.draws.edges = if !self.edges {
            0
        } else if choice == 0 {
            6
        } else {
            50
        };
        match choice {
            0..=12 if live < self.most => Command::CreateBody { def: self.body_def() },
            0..=14 => Command::DestroyBody { body },
            15 => Command::SetKind { body, kind: self.kind() },
            16..=17 => Command::SetPosition { body, position: self.place() },
            18 => Command::SetAngle { body, angle: self.draws.angle(-9000, 9000) },
            19..=20 => Command::SetVelocity { body, velocity: self.velocity() },
            21 => Command::SetAngularVelocity { body, angular_velocity: self.draws.spin(-9000, 9000) },
            22 => Command::SetForce { body, force: self.force(3000) },
            23 => Command::SetTorque { body, torque: self.draws.torque(-3000, 3000) },
            24 => Command::SetMass {
                body,
                mass: self.draws.mass(100, 50_000),
                inertia: self.draws.inertia(20_000, 90_000),
            },
            25 => Command::SetFixedRotation { body, fixed: self.draws.chance(40) },
            26 => {
                Command::SetDamping { body, linear: self.draws.damping(0, 3000), angular: self.draws.damping(0, 3000) }
            }
            27 => Command::SetMu {
                body,
                mu: if self.pulls && self.draws.chance(30) { self.mu() } else { Default::default() },
            },
            28 => Command::SetUserData { body, user_data: self.draws.bits() },
            29..=31 => Command::ApplyForce { body, force: self.force(90_000), point },
            32 => Command::ApplyTorque { body, torque: self.draws.torque(-90_000, 90_000) },
            33..=35 => Command::ApplyImpulse { body, impulse: self.impulse(), point },
            36 => Command::ApplyAngularImpulse { body, impulse: self.draws.angular_impulse(-900, 900) },
            // No more than two: what is pulled about does not come to rest.
            37 if self.pulls && self.attractors.len() < 2 => Command::CreateAttractor { attractor: self.attractor() },
            37..=38 => Command::DestroyAttractor { id: self.attractor_id() },
            39 => Command::SetAttractor { id: self.attractor_id(), attractor: self.attractor() },
            40 => {
                let most = 9_800 * self.unit();
                let gravity = Vec2::new(self.draws.acceleration(-1000, 1000), self.draws.acceleration(-most, 0));
                Command::SetGravity { gravity }
            }
            41 => Command::SetSurface {
                collider: self.collider_id(),
                restitution: self.draws.restitution(0, 1000),
                friction: self.draws.friction(0, 1500),
            },
            42 => Command::SetFilter { collider: self.collider_id(), filter: self.filter() },
            43 => Command::SetAllowSleep { body, allow: self.draws.chance(80) },
            44 => Command::Wake { body },
            45 => Command::PutToSleep { body },
            46 => Command::ClearStatus,
            _ => {
                let length = self.draws.below(20);
                Command::Input { bytes: (0..length).map(|_| self.draws.bits() as u8).collect() }
            }
        }
    }
}
