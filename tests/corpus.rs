//! The committed corpus of the fuzz targets (`fuzz/`), and what fuzzing begins with as this build writes it, through the same
//! functions, in whatever profile this runs: nothing panics, and no invariant breaks.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]
#![cfg(feature = "scene")]

#[path = "../fuzz/src/lib.rs"]
mod fuzz;

use std::fs;
use std::path::Path;
use std::time::Instant;

/// Gives each file of a target's corpus to it. How many there were.
fn play(target: &str, run: fn(&[u8]) -> bool) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("a corpus").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    let (start, mut slowest, mut read) = (Instant::now(), (0.0, String::new()), 0);
    for path in &files {
        let (bytes, begun) = (fs::read(path).expect("a file"), Instant::now());
        // Named before, so that the output says which one panics.
        println!("{}", path.display());
        read += u32::from(run(&bytes));
        let took = begun.elapsed().as_secs_f64();
        if took > slowest.0 {
            slowest = (took, path.display().to_string());
        }
    }
    println!(
        "{target}: {} files, {read} read to the end, in {:.2} s, {:.2} s for {}",
        files.len(),
        start.elapsed().as_secs_f64(),
        slowest.0,
        slowest.1
    );
    files.len()
}

/// Gives what this build writes to the target: it is read to the end. Of the corpus it need not be, for some was written under
/// another law, and then a target would see nothing but what it refuses.
fn play_seeds(target: &str, run: fn(&[u8]) -> bool) {
    let seeds = fuzz::seeds::all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("replays")).expect("seeds");
    let mut count = 0;
    for (_, name, bytes) in seeds.iter().filter(|seed| seed.0 == target) {
        // Noise makes commands, but not always a world.
        assert!(run(bytes) || target == "commands", "{target}: {name} ({} bytes) is not read", bytes.len());
        count += 1;
    }
    println!("{target}: {count} seeds");
    assert!(count > 0, "there are seeds");
}

macro_rules! targets {
    ($($target:ident)*) => {$(
        #[test]
        fn $target() {
            assert!(play(stringify!($target), fuzz::$target::run) > 0, "there is a corpus");
            play_seeds(stringify!($target), fuzz::$target::run);
        }
    )*};
}

targets! { replay snapshot scene commands hello evidence }
