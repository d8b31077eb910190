//! Writes what the fuzzers begin with into a folder: scenes, and their saves, frames, recordings and evidence, a few ticks of each.
//!
//! `cargo run --release --bin seeds FOLDER`

use std::path::{Path, PathBuf};
use std::{env, fs, io};
use tamias2d::Frame;
use tamias2d::hello::Hello;
use tamias2d::replay::{Evidence, Recorder, Recording};
use tamias2d::scene::Scene;

fn put(folder: &Path, target: &str, name: &str, bytes: &[u8]) -> io::Result<()> {
    let folder = folder.join(target);
    fs::create_dir_all(&folder)?;
    fs::write(folder.join(name), bytes)
}

fn main() -> io::Result<()> {
    let Some(folder) = env::args_os().nth(1).map(PathBuf::from) else {
        return Err(io::Error::other("name the folder that the seeds go to"));
    };
    let replays = Path::new(env!("CARGO_MANIFEST_DIR")).join("../replays");
    let mut scenes: Vec<PathBuf> = fs::read_dir(replays)?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    scenes.retain(|path| path.extension().is_some_and(|end| end == "json"));
    scenes.sort();
    for path in scenes {
        let text = fs::read_to_string(&path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if text.len() < 6000 {
            put(&folder, "scene", &name, text.as_bytes())?;
            of_scene(&folder, &name, &Scene::parse(&text).map_err(io::Error::other)?)?;
        }
    }
    let mut state = 1u64;
    for size in [64, 256, 512, 1024, 2048, 4096] {
        for name in ["a", "b"] {
            let bytes: Vec<u8> = (0..size).map(|_| noise(&mut state)).collect();
            put(&folder, "commands", &format!("{size}{name}"), &bytes)?;
        }
    }
    Ok(())
}

/// SplitMix64.
fn noise(state: &mut u64) -> u8 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 56) as u8
}

fn of_scene(folder: &Path, name: &str, scene: &Scene) -> io::Result<()> {
    let (world, mut script) = scene.start().map_err(io::Error::other)?;
    if world.body_count() > 24 {
        return Ok(());
    }
    put(folder, "hello", name, &Hello::new(&world, 1).encode())?;
    let options = Recording { keyframe_seconds: 1, parts_ticks: 8, flight_ticks: 0 };
    let mut recorder = Recorder::with(world.clone(), Vec::new(), options)?;
    // Keyframes come by seconds.
    let ticks = scene.ticks().min(if world.config().tick_rate <= 15 { 20 } else { 12 });
    for tick in 0..ticks {
        script.apply(tick, &mut recorder).map_err(io::Error::other)?;
        recorder.step();
    }
    let mut world = recorder.world().clone();
    let mut file = vec![1];
    file.extend(recorder.finish()?);
    put(folder, "replay", name, &file)?;

    let (mut frame, mut encoded) = (Frame::default(), Vec::new());
    world.save_frame(&mut frame);
    frame.encode_into(&mut encoded);
    let save = world.save();
    let mut file = vec![3];
    file.extend((save.len() as u16).to_le_bytes());
    file.extend(save);
    file.extend(encoded);
    put(folder, "snapshot", name, &file)?;

    let mut file = vec![1];
    file.extend(Evidence::of_step(&mut world).encode());
    if file.len() < 12_000 {
        put(folder, "evidence", name, &file)?;
    }
    Ok(())
}
