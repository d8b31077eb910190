//! A match between processes: two to four players over UDP on this machine, with a rough network, prediction, rollback and
//! desync detection; a spectator, and one who joins late. The confirmed states of all are compared at every tick.
//!
//!     cargo run --release --features ggrs --example p2p -- --help
#![allow(
    clippy::arithmetic_side_effects,
    clippy::disallowed_types,
    reason = "a program beside the engine, with clocks"
)]

mod game;
mod net;
mod parent;
mod peer;

use net::Weather;
use peer::Role;
use std::path::PathBuf;
use std::process::ExitCode;

/// The queue of inputs of ggrs has 128 places, and panics at what does not fit: seen with a delay of 60 ticks.
const DELAY_MAX: usize = 30;
const WINDOW_MAX: usize = 60;

const HELP: &str = "\
A match of two to four processes over UDP on the loopback: prediction, rollback, desync detection, and a network that
loses, doubles, delays and reorders packets. The confirmed states of all are compared at every tick.

    cargo run --release --features ggrs --example p2p            ten minutes of play, as fast as it goes

--players N       2 to 4 (3)
--ticks N         length of the match, 60 ticks a second (36000)
--window N        how many ticks are predicted at most, 0 to 60 (8). 0 and 1 predict none: lockstep, for which see --delay.
                  With 0 ggrs saves no states and so compares no checksums, with 1 it does
--delay N         input delay in ticks, 0 to 30 (0); for lockstep as many as a packet needs, such as 4
--loss N          of a thousand packets so many are lost (50)
--double N        of a thousand packets so many come twice (20)
--hold A-B        packets are held back by A to B polls, so that they overtake each other (1-4)
--spectator       one more process watches
--join TICK       one more process joins when the match has come so far, by a snapshot
--seed N          of the network and of what the players do (1)
--fault P:TICK    in player P's memory one bit of the world flips at about that tick
--evidence        the players keep evidence of the last ticks: after an alarm it says which field of what differs, and since
                  which stage of which tick
--other-law P     player P says that he computes by another arithmetic law
--other-scene P   player P loads another room
--out DIR         keep the hashes, recordings and evidence there

Exit status: 0 all states equal; 1 they are not, or a process failed; 2 wrong usage.
";

#[derive(Clone, Debug)]
pub struct Options {
    players: usize,
    ticks: u64,
    window: usize,
    delay: usize,
    weather: Weather,
    spectator: bool,
    join: u64,
    seed: u64,
    fault: Option<(usize, u64)>,
    evidence: bool,
    other_law: Option<usize>,
    other_scene: Option<usize>,
    out: PathBuf,
    keep: bool,
    role: Option<Role>,
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("{text:?} is no number that fits"))
}

fn pair<T: std::str::FromStr, U: std::str::FromStr>(text: &str, between: char) -> Result<(T, U), String> {
    let (a, b) = text.split_once(between).ok_or_else(|| format!("{text:?} is not A{between}B"))?;
    Ok((number(a)?, number(b)?))
}

fn parse(arguments: &[String]) -> Result<Options, String> {
    let mut options = Options {
        players: 3,
        ticks: 36_000,
        window: 8,
        delay: 0,
        weather: Weather { loss: 50, double: 20, delay: (1, 4) },
        spectator: false,
        join: 0,
        seed: 1,
        fault: None,
        evidence: false,
        other_law: None,
        other_scene: None,
        out: std::env::temp_dir().join(format!("tamias2d-p2p-{}", std::process::id())),
        keep: false,
        role: None,
    };
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--spectator" => options.spectator = true,
            "--evidence" => options.evidence = true,
            _ => {}
        }
        if matches!(word.as_str(), "--spectator" | "--evidence") {
            continue;
        }
        let value = words.next().ok_or_else(|| format!("{word} is unknown or lacks its value"))?;
        match word.as_str() {
            "--players" => options.players = number(value)?,
            "--ticks" => options.ticks = number(value)?,
            "--window" => options.window = number(value)?,
            "--delay" => options.delay = number(value)?,
            "--loss" => options.weather.loss = number(value)?,
            "--double" => options.weather.double = number(value)?,
            "--hold" => options.weather.delay = pair(value, '-')?,
            "--join" => options.join = number(value)?,
            "--seed" => options.seed = number(value)?,
            "--fault" => options.fault = Some(pair(value, ':')?),
            "--other-law" => options.other_law = Some(number(value)?),
            "--other-scene" => options.other_scene = Some(number(value)?),
            "--out" => (options.out, options.keep) = (value.into(), true),
            // Of the processes that this one starts.
            "--role" => options.role = Some(Role::parse(value).ok_or_else(|| format!("{value:?} is no role"))?),
            _ => return Err(format!("{word} is unknown")),
        }
    }
    if !(2..=4).contains(&options.players) {
        return Err("there are 2 to 4 players".into());
    }
    if options.weather.loss > 500 || options.weather.delay.0 > options.weather.delay.1 {
        return Err("of a thousand packets at most 500 are lost, and A of --hold is at most B".into());
    }
    if options.ticks == 0 {
        return Err("a match of 0 ticks has nothing to compare".into());
    }
    if options.delay > DELAY_MAX || options.window > WINDOW_MAX {
        return Err(format!("--delay is at most {DELAY_MAX} ticks, --window at most {WINDOW_MAX}"));
    }
    let named = [options.fault.map(|(player, _)| player), options.other_law, options.other_scene];
    if let Some(player) = named.into_iter().flatten().find(|player| *player >= options.players) {
        return Err(format!("there is no player {player}, only 0 to {}", options.players - 1));
    }
    Ok(options)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|word| word == "--help" || word == "-h") {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let options = match parse(&arguments) {
        Ok(options) => options,
        Err(error) => {
            eprintln!("p2p: {error}; --help has all that can be said");
            return ExitCode::from(2);
        }
    };
    let outcome = match options.role {
        Some(role) => peer::run(&options, role),
        None => parent::run(&options, &arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // A child's go to its standard output, where the parent reads them.
            match options.role {
                Some(role) => println!("{}: {error}", role.name()),
                None => eprintln!("p2p: {error}"),
            }
            ExitCode::FAILURE
        }
    }
}
