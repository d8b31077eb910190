//! The process that starts the others, tells them where each other listens, and compares what they computed.

use crate::Options;
use crate::peer::Role;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;
use tamias2d::replay::Evidence;

type Failure = Box<dyn std::error::Error>;

/// A process, and its lines.
struct Process {
    role: Role,
    child: Child,
    orders: ChildStdin,
    lines: Receiver<String>,
}

impl Process {
    fn start(role: Role, options: &Options, arguments: &[String]) -> Result<Process, Failure> {
        let mut child = Command::new(std::env::current_exe()?)
            .args(arguments)
            .arg("--out")
            .arg(&options.out)
            .args(["--role", &role.name()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (Some(orders), Some(out)) = (child.stdin.take(), child.stdout.take()) else {
            unreachable!("both are piped")
        };
        let (to, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                if to.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Process { role, child, orders, lines })
    }

    /// The next line; none when it has ended.
    fn line(&self) -> Option<String> {
        self.lines.recv().ok()
    }

    fn ports(&self) -> Result<(u16, u16), Failure> {
        let line = self.line().ok_or("a process did not start")?;
        let ports = line.strip_prefix("ready ").and_then(|ports| ports.split_once(' '));
        let (udp, tcp) = ports.ok_or_else(|| format!("{}: {line}", self.role.name()))?;
        Ok((udp.parse()?, tcp.parse()?))
    }
}

pub fn run(options: &Options, arguments: &[String]) -> Result<(), Failure> {
    std::fs::create_dir_all(&options.out)?;
    let mut processes = Vec::new();
    let outcome = compete(options, arguments, &mut processes);
    for process in &mut processes {
        let _ = writeln!(process.orders, "over");
        if outcome.is_err() {
            let _ = process.child.kill();
        }
        let _ = process.child.wait();
    }
    let outcome = outcome.and_then(|()| compare(options));
    if options.keep {
        println!("what they wrote is in {}", options.out.display());
    } else {
        let _ = std::fs::remove_dir_all(&options.out);
    }
    outcome
}

/// Starts all, and waits until each has computed the whole match.
fn compete(options: &Options, arguments: &[String], processes: &mut Vec<Process>) -> Result<(), Failure> {
    let began = Instant::now();
    let mut roles: Vec<Role> = (0..options.players).map(Role::Player).collect();
    roles.extend(options.spectator.then_some(Role::Spectator));
    roles.extend((options.join > 0).then_some(Role::Joiner));
    for role in roles {
        processes.push(Process::start(role, options, arguments)?);
    }
    let (mut players, mut spectator, mut host) = (String::new(), 0, 0);
    for process in processes.iter() {
        let (udp, tcp) = process.ports()?;
        match process.role {
            Role::Player(number) => {
                players += &format!(" {udp}");
                host = if number == 0 { tcp } else { host };
            }
            Role::Spectator => spectator = udp,
            Role::Joiner => {}
        }
    }
    for process in processes.iter_mut() {
        writeln!(process.orders, "{host} {spectator}{players}")?;
    }
    let mut failed = false;
    for process in processes.iter() {
        loop {
            match process.line() {
                Some(line) if line == "done" => break,
                Some(line) => println!("{line}"),
                None => {
                    failed = true;
                    break;
                }
            }
        }
        if failed {
            return Err(format!("{} did not come to the end", process.role.name()).into());
        }
    }
    let seconds = began.elapsed().as_secs_f64();
    println!("{:.1} s for {} ticks: {:.0} ticks a second", seconds, options.ticks, options.ticks as f64 / seconds);
    Ok(())
}

/// The lines that a process wrote, and the tick of the first; each tick after it has come once, in order.
fn stream(options: &Options, role: Role) -> Result<(u64, Vec<String>), Failure> {
    let text = std::fs::read_to_string(options.out.join(format!("{}.hashes", role.name())))?;
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let tick = |line: &String| line.split(' ').next().unwrap_or("").parse::<u64>();
    let begin = lines.first().map_or(Ok(0), tick)?;
    for (line, expected) in lines.iter().zip(begin..) {
        if tick(line)? != expected {
            return Err(format!("{}: tick {expected} is missing or came twice", role.name()).into());
        }
    }
    Ok((begin, lines))
}

/// Compares all confirmed states, and names the first that differs.
fn compare(options: &Options) -> Result<(), Failure> {
    let (begin, first) = stream(options, Role::Player(0))?;
    if (begin, first.len() as u64) != (1, options.ticks) {
        return Err(format!("player0 confirmed {} of {} ticks", first.len(), options.ticks).into());
    }
    let mut others: Vec<Role> = (1..options.players).map(Role::Player).collect();
    others.extend(options.spectator.then_some(Role::Spectator));
    others.extend((options.join > 0).then_some(Role::Joiner));
    let mut parted: Option<(u64, Role)> = None;
    for role in others {
        let (begin, theirs) = stream(options, role)?;
        if begin == 0 || begin + theirs.len() as u64 != options.ticks + 1 || (role != Role::Joiner && begin != 1) {
            return Err(format!("{} does not have every tick", role.name()).into());
        }
        let ours = &first[begin as usize - 1..];
        match (begin..).zip(theirs.iter().zip(ours)).find(|(_, (theirs, ours))| theirs != ours) {
            None => println!("{}: ticks {begin} to {} are equal to player0's", role.name(), options.ticks),
            Some((tick, _)) => {
                println!("{}: differs from player0 from tick {tick} on", role.name());
                parted = parted.filter(|(earlier, _)| *earlier <= tick).or(Some((tick, role)));
            }
        }
    }
    let Some((tick, role)) = parted else { return Ok(()) };
    explain(options, tick, role)?;
    Err(format!("the worlds part at tick {tick}").into())
}

/// What differs, field by field, at the first tick that does. What changed between two ticks shows when the second begins.
fn explain(options: &Options, tick: u64, role: Role) -> Result<(), Failure> {
    for tick in [tick, tick + 1] {
        let read = |role: Role| std::fs::read(options.out.join(format!("{}.{tick}.evidence", role.name())));
        let (Ok(ours), Ok(theirs)) = (read(Role::Player(0)), read(role)) else { continue };
        let (ours, theirs) = (Evidence::decode(&ours)?, Evidence::decode(&theirs)?);
        let Some(divergence) = ours.first_difference(&theirs)? else { continue };
        println!("evidence of player0 (A) and {} (B): tick {tick}, {}", role.name(), divergence.stage);
        for finding in divergence.findings.iter().take(8) {
            println!("  {finding}");
        }
        return Ok(());
    }
    println!("there is no evidence of tick {tick}: --evidence keeps it");
    Ok(())
}
