//! `streams FOLDER [THREADS]`: a line `NAME TICK HASH TOLD` for every tick of the recordings in a folder, then of the random
//! scenes. By so many threads, between which even the shortest loops are cut up, with the feature `threads`.

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use tamias2d::Threads;
use tamias2d_streams::play::{SEEDS, golden, random};

fn main() -> ExitCode {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "replays".into());
    let count = std::env::args().nth(2);
    match count
        .map_or(Ok(Threads::default()), |count| threads(&count))
        .and_then(|threads| play(Path::new(&folder), &threads))
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("streams: {error}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(feature = "threads")]
fn threads(count: &str) -> Result<Threads, String> {
    let count = count.parse().map_err(|error| format!("{count}: {error}"))?;
    Threads::eager(count).map_err(|error| error.to_string())
}

#[cfg(not(feature = "threads"))]
fn threads(count: &str) -> Result<Threads, String> {
    Err(format!("{count} threads need the feature `threads`"))
}

fn play(folder: &Path, threads: &Threads) -> Result<(), String> {
    let mut out = std::io::stdout().lock();
    let mut say = |lines: String| out.write_all(lines.as_bytes()).map_err(|error| error.to_string());
    let unreadable = |error| format!("{}: {error}", folder.display());
    let mut names = Vec::new();
    for entry in folder.read_dir().map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned();
        names.extend(name.strip_suffix(".replay").map(String::from));
    }
    names.sort();
    for name in names {
        let path = folder.join(format!("{name}.replay"));
        say(golden(&name, &std::fs::read(&path).map_err(unreadable)?, threads)?)?;
    }
    SEEDS.into_iter().try_for_each(|seed| say(random(seed, threads)?))
}
