//! Whether this build computes what the build that wrote `pins.txt` did: for changes that are to leave every bit as it is.
//!
//! Goldens, and worlds that are long, reach few of the places at which order matters. These are many small worlds in which it
//! does (`common/trials.rs`): of each, twelve bits of what all its ticks gave are kept. Some are played in every test run; all by
//! `cargo test --release --test pins -- --ignored`. What differs is named, and recorded for the other build to play.
//!
//! When the law changes on purpose, `TAMIAS_PINS=write cargo test --release --test pins -- --ignored` writes them anew.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

#[path = "streams/play/draws.rs"]
#[allow(dead_code, reason = "not every quantity is drawn here")]
mod draws;
#[path = "streams/play/told.rs"]
mod told;
#[path = "common/trials.rs"]
mod trials;

use std::path::PathBuf;
use tamias2d::LAW;
use trials::{Kind, play, record};

/// Of each kind, so many worlds are played in every test run, and so many in all.
const SHORT: [u64; 4] = [3000, 100, 100, 250];
const LONG: [u64; 4] = [20_000, 2000, 2000, 4000];
/// So many are in a line of the file.
const LINE: usize = 48;
const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/pins.txt")
}

/// A world's pin: of the hashes after every tick, and of what it told.
fn pin(kind: Kind, seed: u64) -> String {
    let mut sum = 0u64;
    play(kind, seed, |world| {
        for word in [world.hash(), told::told(world)] {
            sum = (sum ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
        }
    });
    [52, 58].map(|shift| char::from(SIGNS[(sum >> shift & 63) as usize])).iter().collect()
}

/// Those of the first worlds of a kind, in the order of their seeds.
fn pins(kind: Kind, count: u64) -> Vec<String> {
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get() as u64);
    let part = |thread: u64| (thread..count).step_by(threads as usize).map(|seed| pin(kind, seed)).collect::<Vec<_>>();
    let parts: Vec<Vec<String>> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|thread| scope.spawn(move || part(thread))).collect();
        running.into_iter().map(|thread| thread.join().expect("no world panics")).collect()
    });
    (0..count).map(|seed| parts[(seed % threads) as usize][(seed / threads) as usize].clone()).collect()
}

/// The seeds of the worlds of which the file says something else. Errors: a file of another law, or without them.
fn differing(file: &str, kind: Kind, pins: &[String]) -> Result<Vec<usize>, String> {
    let law = file.lines().find_map(|line| line.strip_prefix("law ")).unwrap_or("?");
    if law != LAW.to_string() {
        return Err(format!("tests/pins.txt is of law {law}, and this build has law {LAW}: it is to be written anew"));
    }
    let lines = file.lines().filter_map(|line| line.strip_prefix(kind.name())?.strip_prefix(' '));
    let written: String = lines.filter_map(|line| line.split_once(' ')).map(|(_, pins)| pins).collect();
    if written.len() < 2 * pins.len() {
        return Err(format!(
            "tests/pins.txt has {} worlds of kind {}, not {}",
            written.len() / 2,
            kind.name(),
            pins.len()
        ));
    }
    Ok((0..pins.len()).filter(|&seed| written[2 * seed..2 * seed + 2] != pins[seed]).collect())
}

/// Plays the first worlds of a kind. What is wrong, if anything is.
fn compare(kind: Kind, count: u64) -> Result<(), String> {
    let file = std::fs::read_to_string(path()).map_err(|error| format!("tests/pins.txt: {error}"))?;
    let seeds = differing(&file, kind, &pins(kind, count))?;
    let Some(&first) = seeds.first() else { return Ok(()) };
    let recording = std::env::temp_dir().join(format!("{}{first}.replay", kind.name()));
    std::fs::write(&recording, record(kind, first as u64)).map_err(|error| error.to_string())?;
    Err(format!(
        "{} of {count} worlds of kind {} differ, the first by the seed {first}; this build's recording, which the other \
         build's `tamias2d verify` can play: {}",
        seeds.len(),
        kind.name(),
        recording.display()
    ))
}

#[track_caller]
fn hold(kind: Kind) {
    if let Err(wrong) = compare(kind, SHORT[kind as usize]) {
        panic!("{wrong}");
    }
}

#[test]
fn cradles_are_as_they_were() {
    hold(Kind::Cradle);
}

#[test]
fn rows_and_stacks_are_as_they_were() {
    hold(Kind::Row);
}

#[test]
fn crowds_are_as_they_were() {
    hold(Kind::Crowd);
}

#[test]
fn wild_worlds_are_as_they_were() {
    hold(Kind::Wild);
}

#[test]
#[ignore = "all worlds, minutes: cargo test --release --test pins -- --ignored"]
fn all_are_as_they_were() {
    if std::env::var_os("TAMIAS_PINS").is_some_and(|what| what == "write") {
        std::fs::write(path(), written()).expect("a file");
    }
    let wrong: Vec<String> =
        Kind::ALL.into_iter().filter_map(|kind| compare(kind, LONG[kind as usize]).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The file as this build has it.
fn written() -> String {
    let mut text = format!("Two characters a world, by kinds and seeds: see pins.rs.\nlaw {LAW}\n");
    for kind in Kind::ALL {
        for (line, pins) in pins(kind, LONG[kind as usize]).chunks(LINE).enumerate() {
            text += &format!("{} {} {}\n", kind.name(), line * LINE, pins.concat());
        }
    }
    text
}

#[test]
fn what_differs_is_named() {
    let pins: Vec<String> = ["AA", "AB", "AC"].map(String::from).to_vec();
    let file = |law: u32, third: &str| format!("law {law}\nrow 0 AAAA\nwild 0 AAAB\nwild 2 {third}\n");
    assert_eq!(differing(&file(LAW, "AC"), Kind::Wild, &pins), Ok(vec![]));
    assert_eq!(differing(&file(LAW, "AD"), Kind::Wild, &pins), Ok(vec![2]));
    let error = differing(&file(LAW + 1, "AC"), Kind::Wild, &pins).expect_err("another law");
    assert!(error.contains(&format!("law {}, and this build has law {LAW}", LAW + 1)), "{error}");
    let error = differing(&file(LAW, "AC"), Kind::Crowd, &pins).expect_err("no crowds");
    assert_eq!(error, "tests/pins.txt has 0 worlds of kind crowd, not 3");
}
