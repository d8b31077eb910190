//! What `.ci/cross` compares between builds and machines: after every tick of the goldens and of some scenes made of random
//! numbers, the hash of the world, and of what the tick tells and queries answer.
//!
//! On the way each scene is checked against its own invariants, goes on as a world that was saved and loaded, and is taken
//! back some ticks, so that a machine that does these differently does not agree with the others either.

mod draws;
pub mod scene;
mod told;

use scene::{Scene, TICKS};
use tamias2d::replay::Player;
use tamias2d::{Frame, Threads, World};
use told::told;

/// The seeds of the scenes.
pub const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;

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
