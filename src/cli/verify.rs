//! `tamias2d verify`

use super::{Failure, progress, quoted, say};
use std::fs::File;
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tamias2d::replay::{Player, ReplayError, Summary};

/// Replay recordings and compare the hash of every tick.
///
/// Names the file and the first bad tick of a replay that does not give the recorded hashes. Several files are
/// verified in parallel.
#[derive(clap::Args)]
pub(crate) struct Verify {
    /// Replay files, and folders in which every *.replay file counts
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Print one JSON list of results
    #[arg(long, conflicts_with = "hashes")]
    json: bool,
    /// Print a line `FILE TICK HASH` for every tick as well, to compare two machines by
    #[arg(long)]
    hashes: bool,
}

/// A file's result.
struct Verified {
    path: PathBuf,
    result: Result<Summary, ReplayError>,
    /// The ticks that played well, also of a file that failed later.
    ticks: u64,
    time: Duration,
    hashes: Vec<u64>,
}

impl Verify {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let mut files = Vec::new();
        for path in &self.paths {
            collect(path, &mut files);
        }
        if files.is_empty() {
            return Err(Failure::usage("there is no *.replay file in what was given"));
        }
        let total = files.iter().filter_map(|path| path.metadata().ok()).map(|meta| meta.len()).sum();
        let bar = progress(total, "bytes");
        let next = AtomicUsize::new(0);
        let results = Mutex::new(Vec::new());
        let workers = std::thread::available_parallelism().map_or(1, |n| n.get()).min(files.len());
        std::thread::scope(|scope| {
            for _ in 0..workers {
                scope.spawn(|| {
                    while let Some(path) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                        let verified = self.verify(path, &bar);
                        results.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(verified);
                    }
                });
            }
        });
        bar.finish_and_clear();
        let mut results = results.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        results.sort_by(|a, b| a.path.cmp(&b.path));
        // That nobody reads the output to its end must not silence the alarm.
        let printed = if self.json { print_json(&results) } else { self.print(&results) };
        conclude(&results)?;
        Ok(printed?)
    }

    fn verify(&self, path: &Path, bar: &indicatif::ProgressBar) -> Verified {
        let start = Instant::now();
        let mut hashes = Vec::new();
        let mut ticks = 0;
        let result = File::open(path).map_err(ReplayError::Io).and_then(|file| {
            let mut player = Player::new(BufReader::new(bar.wrap_read(file)))?;
            if self.hashes {
                hashes.push(player.world().hash());
            }
            while let Some(hash) = player.step()? {
                ticks += 1;
                if self.hashes {
                    hashes.push(hash);
                }
            }
            player.verify()
        });
        Verified { path: path.into(), result, ticks, time: start.elapsed(), hashes }
    }

    fn print(&self, results: &[Verified]) -> std::io::Result<()> {
        let mut out = std::io::BufWriter::new(std::io::stdout().lock());
        for Verified { path, result, ticks, time, hashes } in results {
            let path = path.display();
            for (tick, hash) in hashes.iter().enumerate() {
                writeln!(out, "{path} {tick} {hash:016x}")?;
            }
            if let (false, Ok(summary)) = (self.hashes, result) {
                let (commands, hash, speed) = (summary.commands, summary.hash, speed(*ticks, *time));
                writeln!(out, "ok {path}: {ticks} ticks, {commands} commands, hash {hash:016x}, {speed} ticks/s")?;
            }
        }
        out.flush()
    }
}

/// The replays that a path stands for: itself, or those in the folder and its folders, sorted by name. What cannot be
/// read is kept: verifying it will say why. Links to folders are not followed, they may lead in circles.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if !path.is_dir() {
        return files.push(path.into());
    }
    let Ok(entries) = path.read_dir() else { return files.push(path.into()) };
    let mut entries: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() && !entry.is_symlink() {
            collect(&entry, files);
        } else if !entry.is_dir() && entry.extension().is_some_and(|extension| extension == "replay") {
            files.push(entry);
        }
    }
}

fn speed(ticks: u64, time: Duration) -> u64 {
    u64::try_from(u128::from(ticks) * 1_000_000_000 / time.as_nanos().max(1)).unwrap_or(u64::MAX)
}

fn print_json(results: &[Verified]) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    write!(out, "[")?;
    for (index, Verified { path, result, ticks, time, .. }) in results.iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        let (path, speed) = (quoted(&path.display().to_string()), speed(*ticks, *time));
        write!(out, "{comma}\n{{\"file\":{path},\"ticks\":{ticks},\"ticks_per_second\":{speed},")?;
        match result {
            Ok(Summary { commands, hash, .. }) => {
                write!(out, "\"ok\":true,\"commands\":{commands},\"hash\":\"{hash:016x}\"}}")?;
            }
            Err(error) => {
                let bad = bad_tick(error).map_or("null".into(), |tick| tick.to_string());
                write!(out, "\"ok\":false,\"bad_tick\":{bad},\"error\":{}}}", quoted(&error.to_string()))?;
            }
        }
    }
    writeln!(out, "\n]")?;
    out.flush()
}

/// The first bad tick, where there is one.
fn bad_tick(error: &ReplayError) -> Option<u64> {
    match error {
        ReplayError::Diverged { tick, .. }
        | ReplayError::Refused { tick, .. }
        | ReplayError::Corrupt { tick, .. }
        | ReplayError::UnknownRecord { tick, .. }
        | ReplayError::Decode { tick, .. } => Some(*tick),
        _ => None,
    }
}

/// 1 for a replay that reads but does not verify, 2 for one that is none.
fn status(error: &ReplayError) -> u8 {
    match error {
        ReplayError::Diverged { .. }
        | ReplayError::Refused { .. }
        | ReplayError::Corrupt { .. }
        | ReplayError::Decode { .. }
        | ReplayError::Truncated { .. } => 1,
        _ => 2,
    }
}

/// One line on stderr for each bad file, the last of them as the program's own; the worst status of all.
fn conclude(results: &[Verified]) -> Result<(), Failure> {
    let mut bad: Vec<(String, u8)> = Vec::new();
    for Verified { path, result, .. } in results {
        if let Err(error) = result {
            bad.push((format!("{}: {error}", path.display()), status(error)));
        }
    }
    let Some(worst) = bad.iter().map(|(_, status)| *status).max() else { return Ok(()) };
    let last = bad.pop().map(|(message, _)| message).unwrap_or_default();
    for (message, _) in bad {
        say(&message);
    }
    Err(if worst == 1 { Failure::failed(last) } else { Failure::usage(last) })
}

/// Opens a replay for reading.
pub(crate) fn open(path: &Path) -> Result<Player<impl Read + use<>>, Failure> {
    let file = File::open(path).map_err(|error| failure(path, &ReplayError::Io(error)))?;
    Player::new(BufReader::new(file)).map_err(|error| failure(path, &error))
}

/// The failure that a replay's error is.
pub(crate) fn failure(path: &Path, error: &ReplayError) -> Failure {
    let message = format!("{}: {error}", path.display());
    if status(error) == 1 { Failure::failed(message) } else { Failure::usage(message) }
}
