//! `tamias2d verify`

use super::{Failure, progress, quoted, say};
use std::fs::File;
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use tamias2d::replay::{Player, ReplayError, Segment, Summary, recompute};

/// Replay recordings and compare the hash of every tick.
///
/// Names the file and the first bad tick of a replay that does not give the recorded hashes. Several files, and the
/// segments between a long one's keyframes, are verified side by side.
///
/// With --evidence one file's first bad tick, or the tick given by --tick, is computed once more, and what memory holds
/// before it, after each stage and after it goes to a file, for `tamias2d diff`: to see on two machines where they part.
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
    /// How many segments are verified at a time; as many as there are cores if left out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Write evidence of the first bad tick to this file
    #[arg(long, value_name = "OUT", conflicts_with = "hashes")]
    evidence: Option<PathBuf>,
    /// The tick of which to write evidence, bad or not, from 1 on; nothing else is verified then
    #[arg(long, value_name = "T", requires = "evidence", value_parser = clap::value_parser!(u64).range(1..))]
    tick: Option<u64>,
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

/// A segment's result.
struct Played {
    file: usize,
    start: u64,
    result: Result<Summary, ReplayError>,
    ticks: u64,
    began: Instant,
    ended: Instant,
    hashes: Vec<u64>,
}

impl Verify {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let mut files = Vec::new();
        for path in &self.paths {
            collect(path, &mut files);
        }
        if files.is_empty() {
            let shown: Vec<String> = self.paths.iter().map(|path| path.display().to_string()).collect();
            return Err(Failure::usage(format_args!("there is no *.replay file in {}", shown.join(", "))));
        }
        if let (Some(_), [_, _, ..]) = (&self.evidence, files.as_slice()) {
            return Err(Failure::usage("--evidence is of one replay, and there are several"));
        }
        if let (Some(tick), Some(out), [path]) = (self.tick, &self.evidence, files.as_slice()) {
            return self.write_evidence(path, tick, out);
        }
        let results = self.verify(&files);
        // That nobody reads the output to its end must not silence the alarm.
        let printed = if self.json { print_json(&results) } else { self.print(&results) };
        if let (Some(out), [Verified { path, result, .. }]) = (&self.evidence, results.as_slice()) {
            match result.as_ref().err().and_then(diverged_tick) {
                Some(tick) => self.write_evidence(path, tick, out)?,
                None if result.is_ok() => {
                    say(&format!(
                        "{}: no tick is bad, so {} was not written; --tick T asks for one",
                        path.display(),
                        out.display()
                    ));
                }
                None => {}
            }
        }
        conclude(&results)?;
        Ok(printed?)
    }

    /// Writes what this build makes of a tick.
    fn write_evidence(&self, path: &Path, tick: u64, out: &Path) -> Result<(), Failure> {
        if let (Ok(replay), Ok(out)) = (std::fs::canonicalize(path), std::fs::canonicalize(out)) {
            if replay == out {
                return Err(Failure::usage(format_args!("{}: is the replay itself", out.display())));
            }
        }
        let mut file = open_file(path)?;
        let evidence = recompute(&mut file, tick).map_err(|error| failure(path, &error))?;
        let bytes = evidence.encode();
        std::fs::write(out, &bytes).map_err(|error| Failure::usage(format_args!("{}: {error}", out.display())))?;
        if !self.json {
            let (out, build, hash) = (out.display(), evidence.build(), evidence.hash());
            let mut stdout = std::io::stdout().lock();
            writeln!(stdout, "evidence of tick {tick}, hash {hash:016x} here ({build}): {out}, {} bytes", bytes.len())?;
        }
        Ok(())
    }

    /// All files, each split at its keyframes, on as many threads as wanted. Each thread reads its segment by itself, so no more is in
    /// memory than a world and a record for each.
    fn verify(&self, files: &[PathBuf]) -> Vec<Verified> {
        let total = files.iter().filter_map(|path| path.metadata().ok()).map(|meta| meta.len()).sum();
        let bar = progress(total, "bytes");
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
        let jobs = self.jobs.map_or(cores, |jobs| jobs as usize);
        // A file that is not whole is played from its beginning, up to where it is not.
        let whole = |path: &PathBuf| open(path).ok().and_then(|player| player.inspect().ok());
        let most = jobs.saturating_mul(PIECES);
        let split = |path: &PathBuf| whole(path).map_or(vec![WHOLE], |contents| Segment::few(&contents, most));
        let segments: Vec<Vec<Segment>> = side_by_side(jobs, files.len(), |at| split(&files[at]));
        let work: Vec<(usize, Segment)> = segments
            .into_iter()
            .enumerate()
            .flat_map(|(file, of)| of.into_iter().map(move |one| (file, one)))
            .collect();
        let mut played = side_by_side(jobs, work.len(), |at| {
            let (file, segment) = work[at];
            self.play(file, &files[file], segment, &bar)
        });
        bar.finish_and_clear();
        played.sort_by_key(|one| (one.file, one.start));
        let mut results: Vec<Verified> = Vec::new();
        let mut begun = None;
        for one in played {
            let same = begun.is_some_and(|(file, _)| file == one.file);
            let first = if same { begun.map_or(one.began, |(_, first)| first) } else { one.began };
            begun = Some((one.file, first.min(one.began)));
            match results.last_mut().filter(|_| same) {
                // The first error is a file's; what comes after began from what it recorded.
                Some(file) if file.result.is_err() => {}
                Some(file) => {
                    file.result = one.result;
                    file.ticks += one.ticks;
                    file.time = file.time.max(one.ended - first);
                    file.hashes.extend(one.hashes);
                }
                None => results.push(Verified {
                    path: files[one.file].clone(),
                    result: one.result,
                    ticks: one.ticks,
                    time: one.ended - one.began,
                    hashes: one.hashes,
                }),
            }
        }
        results.sort_by(|a, b| a.path.cmp(&b.path));
        results
    }

    fn play(&self, file: usize, path: &Path, segment: Segment, bar: &indicatif::ProgressBar) -> Played {
        let began = Instant::now();
        let (mut hashes, mut ticks) = (Vec::new(), 0);
        if self.hashes && segment.from.is_none() {
            hashes.extend(open(path).map(|player| player.world().hash()));
        }
        let result = File::open(path).map_err(ReplayError::Io).and_then(|file| {
            segment.verify(BufReader::new(bar.wrap_read(file)), |hash| {
                ticks += 1;
                if self.hashes {
                    hashes.push(hash);
                }
            })
        });
        Played { file, start: segment.start(), result, ticks, began, ended: Instant::now(), hashes }
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

/// So many pieces of a recording are made for each thread: enough that none waits long for the last one.
const PIECES: usize = 8;

/// A recording in one piece.
const WHOLE: Segment = Segment { from: None, to: None };

/// The results of a number of jobs, so many at a time, in order.
fn side_by_side<T: Send>(jobs: usize, count: usize, job: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(count) {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    if at >= count {
                        break;
                    }
                    let result = job(at);
                    results.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push((at, result));
                }
            });
        }
    });
    let mut results = results.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    results.sort_by_key(|(at, _)| *at);
    results.into_iter().map(|(_, result)| result).collect()
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
        | ReplayError::DivergedPart { tick, .. }
        | ReplayError::DivergedKeyframe { tick, .. }
        | ReplayError::Refused { tick, .. }
        | ReplayError::Corrupt { tick, .. }
        | ReplayError::UnknownRecord { tick, .. }
        | ReplayError::Decode { tick, .. } => Some(*tick),
        _ => None,
    }
}

/// The tick that this build computes otherwise than it was recorded.
fn diverged_tick(error: &ReplayError) -> Option<u64> {
    match error {
        ReplayError::Diverged { tick, .. }
        | ReplayError::DivergedPart { tick, .. }
        | ReplayError::DivergedKeyframe { tick, .. } => Some(*tick).filter(|&tick| tick > 0),
        _ => None,
    }
}

/// 1 for a replay that reads but does not verify, 2 for one that is none.
fn status(error: &ReplayError) -> u8 {
    match error {
        ReplayError::Diverged { .. }
        | ReplayError::DivergedPart { .. }
        | ReplayError::DivergedKeyframe { .. }
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

/// Opens a file for reading here and there.
pub(crate) fn open_file(path: &Path) -> Result<BufReader<File>, Failure> {
    File::open(path).map(BufReader::new).map_err(|error| failure(path, &ReplayError::Io(error)))
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
