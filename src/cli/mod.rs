//! Commands, their help, and how they end.

mod diff;
mod golden;
mod info;
mod run;
mod table;
mod verify;

use clap::{CommandFactory, Parser, Subcommand};
use std::fmt;
use std::io::{IsTerminal, Read, Write};
use std::process::ExitCode;

/// Deterministic fixed-point 2D physics: run scenes, record and verify replays.
///
/// The same scene gives the same bits on every machine. A replay holds the hash of the complete state after every
/// tick, and `verify` recomputes each of them.
#[derive(Parser)]
#[command(
    version,
    after_help = "\
Examples:
  tamias2d scenes --show orbit > orbit.json          a scene to start from
  tamias2d run orbit.json --ticks 600 --every 60     where its bodies are, each second
  tamias2d run orbit.json --ticks 600 --record orbit.replay
  tamias2d verify orbit.replay                       on any machine: the same hashes at every tick
  tamias2d diff mine.replay theirs.replay            where two recordings of a game part, and in what

Exit status: 0 ok; 1 diverged, failed or truncated; 2 wrong usage, unreadable, or bytes after the end."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(run::Run),
    Verify(verify::Verify),
    Diff(diff::Diff),
    Info(info::Info),
    Scenes(golden::Scenes),
    Record(golden::Record),
}

/// How a command failed: its exit status and the one line for stderr.
pub(crate) struct Failure {
    status: u8,
    message: String,
}

impl Failure {
    /// Diverged, failed or truncated.
    pub(crate) fn failed(message: impl fmt::Display) -> Self {
        Failure { status: 1, message: message.to_string() }
    }

    /// Wrong usage, unreadable, or bytes after the end.
    pub(crate) fn usage(message: impl fmt::Display) -> Self {
        Failure { status: 2, message: message.to_string() }
    }
}

/// Errors of writing to stdout. That its reader has had enough (`| head`) is none: the program ends in silence.
impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::BrokenPipe {
            return Failure { status: 0, message: String::new() };
        }
        Failure::failed(format_args!("cannot write: {error}"))
    }
}

pub(crate) fn main() -> ExitCode {
    let result = match Cli::try_parse() {
        Ok(cli) => execute(cli.command),
        Err(error) if error.use_stderr() => Err(usage(&error)),
        // Help and version.
        Err(help) => help.print().map_err(Failure::from),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { status: 0, .. }) => ExitCode::SUCCESS,
        Err(Failure { status, message }) => {
            say(&message);
            ExitCode::from(status)
        }
    }
}

/// One line on stderr, whatever the message holds: line ends, terminal escapes and endless text of a hostile file too.
pub(crate) fn say(message: &str) {
    const LONGEST: usize = 1000;
    let unsafe_for_a_line = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    let line: String = message.chars().take(LONGEST).map(|c| if unsafe_for_a_line(c) { ' ' } else { c }).collect();
    let rest = if message.chars().nth(LONGEST).is_some() { " …" } else { "" };
    // That stderr is closed is no reason to panic.
    let _ = writeln!(std::io::stderr(), "tamias2d: {line}{rest}");
}

/// What the parser has to say, in one line: its own text up to the usage, which `--help` shows in full.
fn usage(error: &clap::Error) -> Failure {
    if error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return Failure::usage(
            "a command is missing: run, verify, diff, info, scenes or record; see `tamias2d --help`",
        );
    }
    // The command's own help, if there is one by its name: `tamias2d run --help`.
    let named = std::env::args_os().nth(1).filter(|name| Cli::command().find_subcommand(name).is_some());
    let help = named.map_or(String::new(), |name| format!(" {}", name.to_string_lossy()));
    let text = error.to_string();
    let lines: Vec<&str> = text
        .lines()
        .take_while(|line| !line.starts_with("Usage") && !line.starts_with("For more"))
        .map(str::trim)
        .collect();
    // How to pass a text that begins with a dash is no help to who gave a negative number.
    let lines: Vec<&str> =
        lines.into_iter().filter(|line| !line.is_empty() && !line.starts_with("tip: to pass")).collect();
    let words = lines.join("; ").replace(":; ", ": ");
    let words = words.trim_start_matches("error: ").trim_end_matches("; ");
    Failure::usage(format_args!("{words}; see `tamias2d{help} --help`"))
}

fn execute(command: Command) -> Result<(), Failure> {
    match command {
        Command::Run(run) => run.execute(),
        Command::Verify(verify) => verify.execute(),
        Command::Diff(diff) => diff.execute(),
        Command::Info(info) => info.execute(),
        Command::Scenes(scenes) => scenes.execute(),
        Command::Record(record) => record.execute(),
    }
}

/// A progress bar on stderr where that is a terminal, else nothing.
pub(crate) fn progress(length: u64, unit: &str) -> indicatif::ProgressBar {
    if !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let template = format!("{{bar:40}} {{percent}} % of {{len}} {unit}, {{eta}} left");
    let style = indicatif::ProgressStyle::with_template(&template).unwrap_or(indicatif::ProgressStyle::default_bar());
    indicatif::ProgressBar::new(length).with_style(style)
}

/// The longest scene file that is read, in bytes: 10⁵ bodies with all their keys take a fifth of it.
const SCENE_MAX: u64 = 256 << 20;

/// Reads a scene from a file, or from standard input for `-`.
pub(crate) fn read_scene(path: &str) -> Result<tamias2d::scene::Scene, Failure> {
    let refused = |error: &dyn fmt::Display| Failure::usage(format_args!("{path}: {error}"));
    let mut bytes = Vec::new();
    let read = if path == "-" {
        std::io::stdin().take(SCENE_MAX + 1).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|file| file.take(SCENE_MAX + 1).read_to_end(&mut bytes))
    };
    read.map_err(|error| refused(&error))?;
    if bytes.len() as u64 > SCENE_MAX {
        return Err(refused(&format_args!("a scene of more than {SCENE_MAX} bytes")));
    }
    let text = String::from_utf8(bytes).map_err(|error| refused(&error.utf8_error()))?;
    tamias2d::scene::Scene::parse(&text).map_err(|error| Failure::usage(format_args!("{path}: {error}")))
}

/// A JSON string.
pub(crate) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
