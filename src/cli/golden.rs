//! `tamias2d scenes` and `tamias2d record`: the scenes that come with the program, and their recordings.

use super::table::rounded;
use super::{Failure, run};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use tamias2d::scene::Scene;

/// The scenes that come with the program.
const SCENES: &[(&str, &str)] = &[
    ("free_flight", include_str!("../../replays/free_flight.json")),
    ("spin", include_str!("../../replays/spin.json")),
    ("orbit", include_str!("../../replays/orbit.json")),
    ("everything", include_str!("../../replays/everything.json")),
    ("tc10c", include_str!("../../replays/tc10c.json")),
    ("tc11c", include_str!("../../replays/tc11c.json")),
    ("pyramid55", include_str!("../../replays/pyramid55.json")),
    ("pusher", include_str!("../../replays/pusher.json")),
    ("sensors", include_str!("../../replays/sensors.json")),
    ("churn", include_str!("../../replays/churn.json")),
    ("pixels", include_str!("../../replays/pixels.json")),
    ("tumbler", include_str!("../../replays/tumbler.json")),
    ("bouncers", include_str!("../../replays/bouncers.json")),
    ("pile300", include_str!("../../replays/pile300.json")),
    ("sleep", include_str!("../../replays/sleep.json")),
];

fn parse(name: &str, text: &str) -> Result<Scene, Failure> {
    Scene::parse(text).map_err(|error| Failure::failed(format_args!("{name}: {error}")))
}

fn find(name: &str) -> Result<&'static str, Failure> {
    let scene = SCENES.iter().find(|(known, _)| *known == name);
    scene.map(|(_, text)| *text).ok_or_else(|| Failure::usage(format_args!("there is no scene {name:?}")))
}

/// List the scenes that come with the program, or print one.
#[derive(clap::Args)]
pub(crate) struct Scenes {
    /// Print the JSON of this scene
    #[arg(long, value_name = "NAME")]
    show: Option<String>,
}

impl Scenes {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let mut out = std::io::stdout().lock();
        if let Some(name) = self.show {
            return Ok(write!(out, "{}", find(&name)?)?);
        }
        for (name, text) in SCENES {
            writeln!(out, "{name:<14}{}", parse(name, text)?.about())?;
        }
        Ok(())
    }
}

/// Record scenes that come with the program: a replay each.
///
/// With --all also GOLDEN.txt, which says what is in them. The files in `replays` are made by this command; they
/// change only when the arithmetic law does.
#[derive(clap::Args)]
pub(crate) struct Record {
    /// The scenes to record
    #[arg(value_name = "NAME", required_unless_present = "all", conflicts_with = "all")]
    names: Vec<String>,
    /// Record all of them, and write GOLDEN.txt
    #[arg(long)]
    all: bool,
    /// The folder to write to
    #[arg(long, value_name = "FOLDER", default_value = "replays")]
    dir: PathBuf,
}

impl Record {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let names = if self.all { SCENES.iter().map(|(name, _)| (*name).into()).collect() } else { self.names };
        let mut golden = String::from(
            "What the recordings in this folder hold, for people to review: the hash of the state each second, and where\n\
             the first bodies end. Made by `tamias2d record --all`. A change here is a change of the arithmetic law.\n",
        );
        for name in &names {
            let scene = parse(name, find(name)?)?;
            let (bytes, summary) = record(name, &scene)?;
            let path = self.dir.join(format!("{name}.replay"));
            write(&path, &bytes)?;
            golden.push_str(&summary);
            writeln!(std::io::stdout(), "{}: {} ticks, {} bytes", path.display(), scene.ticks(), bytes.len())?;
        }
        if self.all {
            write(&self.dir.join("GOLDEN.txt"), golden.as_bytes())?;
        }
        Ok(())
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    std::fs::write(path, bytes).map_err(|error| Failure::usage(format_args!("{}: {error}", path.display())))
}

/// A scene's recording, and what GOLDEN.txt says of it.
fn record(name: &str, scene: &Scene) -> Result<(Vec<u8>, String), Failure> {
    let mut text = format!("\n{name}: {}\n", scene.about());
    let last = scene.ticks();
    let bytes = run::record_scene(scene, Vec::new(), |world, script| {
        let tick = world.tick();
        // Writing to a String does not fail.
        if tick % u64::from(world.config().tick_rate) == 0 || tick == last {
            let _ = writeln!(text, "  tick {tick:>6}  hash {:016x}  bodies {}", world.hash(), world.body_count());
        }
        if tick == last {
            for body in world.bodies().take(4) {
                let (p, v) = (body.position(), body.velocity());
                let numbers = [rounded(p.x, 9), rounded(p.y, 9), rounded(v.x, 9), rounded(v.y, 9)];
                let [x, y, vx, vy] = numbers;
                let (turns, omega) = (rounded(body.angle(), 9), rounded(body.angular_velocity(), 9));
                let label = script.label(body.id());
                let _ = writeln!(text, "  {label}: x {x} y {y} turns {turns} vx {vx} vy {vy} omega {omega}");
            }
        }
    })?;
    Ok((bytes, text))
}
