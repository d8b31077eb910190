//! What `.ci/cross` compares between builds and machines: after every tick of the goldens and of some scenes made of random
//! numbers, the hash of the world, and of what the tick tells and queries answer.
//!
//! On the way each scene is checked against its own invariants, goes on as a world that was saved and loaded, and is taken
//! back some ticks, so that a machine that does these differently does not agree with the others either.

mod draws;
pub mod scene;

use scene::{Scene, TICKS};
use std::hash::{Hash, Hasher};
use tamias2d::replay::Player;
use tamias2d::{Filter, Frame, Vec2, World};

/// The seeds of the scenes.
pub const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;

/// FNV-1a over the same bytes on every machine: the standard's derived hashes feed words in the machine's own order and size.
struct Fnv(u64);

macro_rules! little_endian {
    ($($name:ident: $from:ty as $to:ty;)*) => {$(
        fn $name(&mut self, value: $from) {
            self.write(&(value as $to).to_le_bytes());
        }
    )*};
}

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }

    little_endian! {
        write_u16: u16 as u16;
        write_u32: u32 as u32;
        write_u64: u64 as u64;
        write_u128: u128 as u128;
        write_usize: usize as u64;
        write_i16: i16 as i16;
        write_i32: i32 as i32;
        write_i64: i64 as i64;
        write_i128: i128 as i128;
        write_isize: isize as i64;
    }
}

/// The hash of what is no state: events and collisions of the last step, and what two queries see.
fn told(world: &World) -> u64 {
    let mut hasher = Fnv(0xcbf2_9ce4_8422_2325);
    world.events().hash(&mut hasher);
    world.collisions().hash(&mut hasher);
    if let Some(body) = world.bodies().last() {
        let (center, filter) = (body.center_of_mass(), Filter::default());
        let way = Vec2::new(center.y, center.x);
        if let Some(hit) = world.ray_cast(center, way, filter) {
            (hit.collider, hit.point, hit.fraction, hit.normal).hash(&mut hasher);
        }
        if let Some(near) = world.closest_point(way, center.x, filter) {
            (near.collider, near.point, near.distance).hash(&mut hasher);
        }
    }
    hasher.finish()
}

/// A line of a stream.
fn line(name: &str, world: &World) -> String {
    format!("{name} {} {:016x} {:016x}\n", world.tick(), world.hash(), told(world))
}

/// The lines of a recording, from its beginning to its end. Errors: what does not give the recorded hashes.
pub fn golden(name: &str, replay: &[u8]) -> Result<String, String> {
    let wrong = |error| format!("{name}: {error}");
    let mut player = Player::new(replay).map_err(wrong)?;
    let mut lines = line(name, player.world());
    while player.step().map_err(wrong)?.is_some() {
        lines += &line(name, player.world());
    }
    Ok(lines)
}

/// The lines of a scene. Errors: an invariant that is broken, or a world that does not go on as itself.
pub fn random(seed: u64) -> Result<String, String> {
    let (name, mut scene) = (format!("scene{seed}"), Scene::new(seed));
    let mut lines = line(&name, &scene.world);
    while scene.world.tick() < TICKS {
        scene.tick(|_, _| {});
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
