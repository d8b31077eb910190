//! What the fuzzers begin with: scenes, and their saves, frames, recordings and evidence, a few ticks of each, as this build writes
//! them; and noise. But for the noise each is read by its target to the end.

use super::{LONGEST, MOST_BODIES};
use std::path::{Path, PathBuf};
use std::{fs, io};
use tamias2d::Frame;
use tamias2d::hello::Hello;
use tamias2d::replay::{Evidence, Recorder, Recording};
use tamias2d::scene::Scene;

/// A target, the seed's name, and its bytes.
pub type Seed = (&'static str, String, Vec<u8>);

/// All of them, of the scenes in a folder.
pub fn all(replays: &Path) -> io::Result<Vec<Seed>> {
    let mut scenes: Vec<PathBuf> = fs::read_dir(replays)?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    scenes.retain(|path| path.extension().is_some_and(|end| end == "json"));
    scenes.sort();
    let mut seeds = Vec::new();
    for path in scenes {
        let text = fs::read_to_string(&path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if text.len() < 6000 {
            // With the fewest ticks a second a keyframe comes after few.
            let slow = ["60", "50"].iter().fold(text.clone(), |text, rate| {
                text.replace(&format!("\"tick_rate\": {rate},"), "\"tick_rate\": 15,")
            });
            of_scene(&mut seeds, &name, &Scene::parse(&slow).map_err(io::Error::other)?)?;
            seeds.push(("scene", name, text.into_bytes()));
        }
    }
    let mut state = 1u64;
    for size in [64, 256, 512, 1024, 2048, 4096] {
        for name in ["a", "b"] {
            let bytes = (0..size).map(|_| noise(&mut state)).collect();
            seeds.push(("commands", format!("{size}{name}"), bytes));
        }
    }
    Ok(seeds)
}

/// SplitMix64.
fn noise(state: &mut u64) -> u8 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 56) as u8
}

fn of_scene(seeds: &mut Vec<Seed>, name: &str, scene: &Scene) -> io::Result<()> {
    let (world, mut script) = scene.start().map_err(io::Error::other)?;
    if world.body_count() > MOST_BODIES {
        return Ok(());
    }
    // Evidence of many bodies is longer than what is looked at.
    let mut put =
        |target, bytes: Vec<u8>| seeds.extend((bytes.len() < LONGEST).then(|| (target, name.to_owned(), bytes)));
    put("hello", Hello::new(&world, 1).encode());
    let options = Recording { keyframe_seconds: 1, parts_ticks: 8, flight_ticks: 0 };
    let mut recorder = Recorder::with(world, Vec::new(), options)?;
    for tick in 0..scene.ticks().min(18) {
        script.apply(tick, &mut recorder).map_err(io::Error::other)?;
        recorder.step();
    }
    let mut world = recorder.world().clone();
    put("replay", [vec![1], recorder.finish()?].concat());

    let (mut frame, mut encoded) = (Frame::default(), Vec::new());
    world.save_frame(&mut frame);
    frame.encode_into(&mut encoded);
    let save = world.save();
    put("snapshot", [&[3], &(save.len() as u16).to_le_bytes()[..], &save, &encoded].concat());
    put("evidence", [vec![1], Evidence::of_step(&mut world).encode()].concat());
    Ok(())
}
