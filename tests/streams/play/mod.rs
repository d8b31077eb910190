//! What `.ci/cross` compares between builds and machines: after every tick of the goldens and of some scenes made of random
//! numbers, the hash of the world, and of what the tick tells and queries answer.
//!
//! On the way each scene is checked against its own invariants, goes on as a world that was saved and loaded, and is taken
//! back some ticks, so that a machine that does these differently does not agree with the others either.

mod draws;
pub mod scene;

use scene::{Scene, TICKS};
use tamias2d::replay::Player;
use tamias2d::{ColliderId, Collision, Event, Filter, Frame, Length, Pace, Threads, Vec2, World};

/// The seeds of the scenes.
pub const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;

/// A hash of numbers, the same on every machine: what the standard derives feeds some of them in the machine's own order of bytes.
struct Sum(u64);

impl Sum {
    fn word(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
    }

    fn number(&mut self, number: impl Into<i128>) {
        let number = number.into();
        self.word(number as u64);
        self.word((number >> 64) as u64);
    }

    fn collider(&mut self, id: ColliderId) {
        self.number(id.index);
        self.number(id.generation);
    }

    fn point(&mut self, point: Vec2<Length>) {
        self.number(point.x.to_bits());
        self.number(point.y.to_bits());
    }

    fn event(&mut self, event: &Event) {
        let Event { tick, kind, a, b } = *event;
        self.number(tick);
        self.number(kind as u8);
        self.collider(a);
        self.collider(b);
    }

    fn collision(&mut self, collision: &Collision) {
        let Collision { tick, ordinal, a, b, order, time, point, normal, impulse, before, after } = *collision;
        self.number(tick);
        self.number(ordinal);
        self.collider(a);
        self.collider(b);
        self.number(order);
        self.number(time.to_bits());
        self.point(point);
        normal.into_iter().for_each(|part| self.number(part));
        self.number(impulse.x.to_bits());
        self.number(impulse.y.to_bits());
        for Pace { velocity, angular_velocity } in before.into_iter().chain(after) {
            self.number(velocity.x.to_bits());
            self.number(velocity.y.to_bits());
            self.number(angular_velocity.to_bits());
        }
    }
}

/// The hash of what is no state: events and collisions of the last step, and what two queries see.
fn told(world: &World) -> u64 {
    let mut sum = Sum(0);
    world.events().iter().for_each(|event| sum.event(event));
    world.collisions().iter().for_each(|collision| sum.collision(collision));
    if let Some(body) = world.bodies().last() {
        let (center, filter) = (body.center_of_mass(), Filter::default());
        let elsewhere = Vec2::new(center.y, center.x);
        for hit in world.ray_cast_all(center, elsewhere, filter) {
            sum.collider(hit.collider);
            sum.point(hit.point);
            sum.number(hit.fraction);
            hit.normal.into_iter().for_each(|part| sum.number(part));
        }
        let reach = Length::from_bits(center.x.to_bits().saturating_abs());
        if let Some(near) = world.closest_point(elsewhere, reach, filter) {
            sum.collider(near.collider);
            sum.point(near.point);
            sum.number(near.distance.to_bits());
        }
    }
    sum.0
}

/// A line of a stream.
fn line(name: &str, world: &World) -> String {
    format!("{name} {} {:016x} {:016x}\n", world.tick(), world.hash(), told(world))
}

/// The lines of a recording, from its beginning to its end. Errors: what does not give the recorded hashes.
pub fn golden(name: &str, replay: &[u8], threads: &Threads) -> Result<String, String> {
    let wrong = |error| format!("{name}: {error}");
    let mut player = Player::new(replay).map_err(wrong)?;
    player.use_threads(threads);
    let mut lines = line(name, player.world());
    while player.step().map_err(wrong)?.is_some() {
        lines += &line(name, player.world());
    }
    Ok(lines)
}

/// The lines of a scene. Errors: an invariant that is broken, or a world that does not go on as itself.
pub fn random(seed: u64, threads: &Threads) -> Result<String, String> {
    let (name, mut scene) = (format!("scene{seed}"), Scene::new(seed));
    let mut lines = line(&name, &scene.world);
    while scene.world.tick() < TICKS {
        scene.tick(threads, |_, _| {});
        lines += &line(&name, &scene.world);
        doubt(&mut scene.world).map_err(|wrong| format!("{name}, after tick {}: {wrong}", scene.world.tick()))?;
    }
    Ok(lines)
}

/// From time to time: whether the invariants hold, and whether it goes on alike when it is loaded or taken back.
fn doubt(world: &mut World) -> Result<(), String> {
    if world.tick() % 16 == 0 {
        world.check()?;
    }
    if world.tick() % 50 == 0 {
        let hash = world.hash();
        *world = World::load(&world.save()).map_err(|error| error.to_string())?;
        if world.hash() != hash {
            return Err("the loaded world is another one".into());
        }
    }
    if world.tick() % 64 == 0 {
        let mut frame = Frame::default();
        world.save_frame(&mut frame);
        let mut ahead = || [(); 3].map(|()| (world.step(), world.hash()).1);
        let first = ahead();
        world.restore_frame(&frame).map_err(|error| error.to_string())?;
        let mut ahead = || [(); 3].map(|()| (world.step(), world.hash()).1);
        if ahead() != first {
            return Err("taken back, it goes on otherwise".into());
        }
        world.restore_frame(&frame).map_err(|error| error.to_string())?;
    }
    Ok(())
}
