//! A stream of commands at all ranges' ends, with ticks between; every now and then the world is taken back some ticks, or goes
//! on from a save. At the end it has to be what a recording of it plays.

use super::draw::Draw;
use super::{LONGEST, MOST_BODIES, MOST_TICKS, is_small, sound};
use tamias2d::replay::{Player, Recorder, Recording};
use tamias2d::{Aabb, AttractorId, BodyId, ColliderId, Command, Commands, Filter, Reply, Rollback, World};

/// So many commands in all; a tick of some bodies is dearer than a hundred.
const MOST_COMMANDS: usize = 256;

/// The input as decisions.
pub fn run(data: &[u8]) -> bool {
    if data.len() > LONGEST {
        return false;
    }
    let mut draw = Draw::new(data);
    let Ok(world) = World::new(&draw.world()) else { return false };
    let mut game = Game::new(world);
    while !draw.is_empty() && game.given < MOST_COMMANDS && game.world.tick() < MOST_TICKS {
        match draw.below(16) {
            0..=4 => game.tick(),
            5 => game.go_back(draw.byte()),
            6 => game.reload(),
            7 => ask(&game.world, &mut draw),
            _ => {
                let command = game.choose(&mut draw);
                game.give(command);
            }
        }
    }
    game.tick();
    game.record(draw.byte());
    true
}

struct Game {
    world: World,
    /// The same, gone on from a save.
    twin: World,
    ring: Rollback,
    start: World,
    /// The commands before each tick; those of the next one last.
    past: Vec<Vec<Command>>,
    bodies: Vec<BodyId>,
    attractors: Vec<AttractorId>,
    given: usize,
}

impl Game {
    fn new(world: World) -> Game {
        let [twin, start] = [world.clone(), world.clone()];
        let mut ring = Rollback::new(5);
        ring.save(&world);
        let (bodies, attractors) = (Vec::new(), Vec::new());
        Game { world, twin, ring, start, past: vec![Vec::new()], bodies, attractors, given: 0 }
    }

    fn give(&mut self, command: Command) {
        self.given += 1;
        if matches!(command, Command::CreateBody { .. }) && self.world.body_count() >= MOST_BODIES {
            return;
        }
        let before = self.world.hash();
        let reply = self.world.apply(command.clone());
        assert_eq!(self.twin.apply(command.clone()), reply);
        sound(&self.world);
        match reply {
            Ok(Reply::Body(id)) => self.bodies.push(id),
            Ok(Reply::Attractor(id)) => self.attractors.push(id),
            Ok(Reply::Done) => {}
            Err(error) => {
                assert!(self.world.hash() == before, "{command:?} is refused ({error}), and changes the world");
                assert!(!error.to_string().is_empty());
            }
        }
        if let Some(last) = self.past.last_mut() {
            last.push(command);
        }
        self.agree();
    }

    fn tick(&mut self) {
        if !is_small(&self.world) {
            return;
        }
        self.world.step();
        self.twin.step();
        sound(&self.world);
        self.agree();
        assert_eq!(self.world.events(), self.twin.events());
        assert_eq!(self.world.hash_parts(), self.world.hash_parts_afresh());
        self.ring.save(&self.world);
        self.past.push(Vec::new());
    }

    fn agree(&self) {
        let (world, twin) = (&self.world, &self.twin);
        assert!(world.hash() == twin.hash(), "tick {}: {:?}", world.tick(), world.diff(twin).first());
    }

    fn reload(&mut self) {
        let save = self.world.save();
        self.twin = World::load(&save).expect("what was saved is read");
        assert!(self.twin.save() == save);
        sound(&self.twin);
        self.agree();
    }

    /// Takes the twin back some ticks, and on again with the same commands.
    fn go_back(&mut self, depth: u8) {
        let Some(oldest) = self.ring.oldest() else { return };
        let now = self.world.tick();
        let then = now.saturating_sub(u64::from(depth % 6)).max(oldest);
        self.ring.restore(&mut self.twin, then).expect("it is held");
        sound(&self.twin);
        for (at, commands) in self.past.iter().enumerate().skip(then as usize) {
            for command in commands {
                let _refused_or_not = self.twin.apply(command.clone());
            }
            if (at as u64) < now {
                self.twin.step();
            }
        }
        sound(&self.twin);
        self.agree();
    }

    /// A recording of the same plays to the same world.
    fn record(&self, seconds: u8) {
        let options = Recording { keyframe_seconds: u32::from(seconds & 1), parts_ticks: 7, flight_ticks: 0 };
        let mut recorder = Recorder::with(self.start.clone(), Vec::new(), options).expect("memory takes all");
        for (at, commands) in self.past.iter().enumerate() {
            for command in commands {
                let _refused_or_not = recorder.apply(command.clone());
            }
            if (at as u64) < self.world.tick() {
                recorder.step();
            }
        }
        let file = recorder.finish().expect("memory takes all");
        let player = Player::new(file.as_slice()).expect("it was recorded");
        let summary = player.verify().expect("what was recorded plays");
        assert_eq!((summary.ticks, summary.hash), (self.world.tick(), self.world.hash()));
    }

    /// An id of one that there is, was, or never was.
    fn body(&self, draw: &mut Draw<'_>) -> BodyId {
        let at = usize::from(draw.byte());
        match self.bodies.len() {
            0 => BodyId { index: draw.word(), generation: draw.word() },
            _ if at == 255 => BodyId { index: draw.word(), generation: draw.word() },
            count => self.bodies[count - 1 - at % count],
        }
    }

    fn attractor(&self, draw: &mut Draw<'_>) -> AttractorId {
        let at = usize::from(draw.byte());
        match self.attractors.len() {
            0 => AttractorId { index: draw.word(), generation: draw.word() },
            count => self.attractors[at % count],
        }
    }

    fn collider(&self, draw: &mut Draw<'_>) -> ColliderId {
        let at = usize::from(draw.byte());
        let live = self.world.colliders().nth(at % 16).map(|collider| collider.id());
        live.unwrap_or(ColliderId { index: u32::from(draw.byte()), generation: u32::from(draw.byte()) })
    }

    fn choose(&self, draw: &mut Draw<'_>) -> Command {
        let choice = draw.below(40);
        let body = if choice < 24 { self.body(draw) } else { BodyId::default() };
        match choice {
            0 => Command::DestroyBody { body },
            1 => Command::SetKind { body, kind: draw.kind() },
            2 | 3 => Command::SetPosition { body, position: draw.place() },
            4 => Command::SetAngle { body, angle: draw.angle() },
            5 | 6 => Command::SetVelocity { body, velocity: draw.speed() },
            7 => Command::SetAngularVelocity { body, angular_velocity: draw.spin() },
            8 => Command::SetForce { body, force: draw.push() },
            9 => Command::SetTorque { body, torque: draw.torque() },
            10 => Command::SetMass { body, mass: draw.mass(), inertia: draw.inertia() },
            11 => Command::SetFixedRotation { body, fixed: draw.yes() },
            12 => Command::SetDamping { body, linear: draw.damping(), angular: draw.damping() },
            13 => Command::SetMu { body, mu: draw.mu() },
            14 => Command::SetUserData { body, user_data: draw.word().into() },
            15 | 16 => Command::ApplyForce { body, force: draw.push(), point: draw.point() },
            17 => Command::ApplyTorque { body, torque: draw.torque() },
            18 | 19 => Command::ApplyImpulse { body, impulse: draw.kick(), point: draw.point() },
            20 => Command::ApplyAngularImpulse { body, impulse: draw.angular_impulse() },
            21 => Command::SetAllowSleep { body, allow: draw.yes() },
            22 => Command::Wake { body },
            23 => Command::PutToSleep { body },
            24 => Command::CreateAttractor { attractor: draw.attractor() },
            25 => Command::SetAttractor { id: self.attractor(draw), attractor: draw.attractor() },
            26 => Command::DestroyAttractor { id: self.attractor(draw) },
            27 => Command::SetGravity { gravity: draw.pull() },
            28 => Command::SetSurface {
                collider: self.collider(draw),
                restitution: draw.restitution(),
                friction: draw.friction(),
            },
            29 => Command::SetFilter { collider: self.collider(draw), filter: draw.filter() },
            30 => Command::ClearStatus,
            31 => {
                let length = usize::from(draw.byte());
                Command::Input { bytes: draw.take(length).to_vec() }
            }
            _ => Command::CreateBody { def: draw.body() },
        }
    }
}

/// Questions change nothing, and have answers wherever they are asked.
fn ask(world: &World, draw: &mut Draw<'_>) {
    let filter = if draw.yes() { Filter::default() } else { draw.filter() };
    let (one, other) = (draw.place(), draw.place());
    let all = world.ray_cast_all(one, other, filter);
    let first = world.ray_cast(one, other, filter);
    assert_eq!(first.is_some(), !all.is_empty(), "the first hit is one of all");
    assert!(all.len() <= world.colliders().count());
    drop(world.overlap_point(one, filter));
    drop(world.overlap_box(&Aabb { min: one, max: other }, filter));
    let _nearest = world.closest_point(one, draw.length(), filter);
    for body in world.bodies().take(4) {
        let _values = (body.velocity_at(other), body.kinetic_energy(), body.potential_energy(), body.def());
    }
}
