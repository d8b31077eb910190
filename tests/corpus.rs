//! The committed corpus of the fuzz targets (`fuzz/`), through the same functions, in whatever profile this runs: nothing
//! panics, and no invariant breaks.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]
#![cfg(feature = "scene")]

#[path = "../fuzz/src/lib.rs"]
mod fuzz;

use std::fs;
use std::path::Path;
use std::time::Instant;

/// Gives each file of a target's corpus to it. How many there were.
fn play(target: &str, run: fn(&[u8])) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("a corpus").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    let (start, mut slowest) = (Instant::now(), (0.0, String::new()));
    for path in &files {
        let (bytes, begun) = (fs::read(path).expect("a file"), Instant::now());
        // Named before, so that the output says which one panics.
        println!("{}", path.display());
        run(&bytes);
        let took = begun.elapsed().as_secs_f64();
        if took > slowest.0 {
            slowest = (took, path.display().to_string());
        }
    }
    println!(
        "{target}: {} files in {:.2} s, {:.2} s for {}",
        files.len(),
        start.elapsed().as_secs_f64(),
        slowest.0,
        slowest.1
    );
    files.len()
}

macro_rules! targets {
    ($($target:ident)*) => {$(
        #[test]
        fn $target() {
            assert!(play(stringify!($target), fuzz::$target::run) > 0, "there is a corpus");
        }
    )*};
}

targets! { replay snapshot scene commands hello evidence }
