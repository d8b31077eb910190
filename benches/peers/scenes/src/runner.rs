//! The protocol: `PROGRAM --group GROUP --scene NAME [--steps N] [--snapshot WARM] [--rollback WARM]` runs a scene and prints
//! a line of JSON.

use crate::Scene;
use crate::json::num;
use cpu_time::ThreadTime;
use std::time::Instant;

/// x, y, angle (radians, unwrapped or not), vx, vy, omega.
pub type State = [f64; 6];

pub struct Cost {
    pub name: &'static str,
    pub ns: Vec<u64>,
    pub bytes: usize,
}

/// What saving and restoring cost, and findings that are true or not.
pub type Snapshot = (Vec<Cost>, Vec<(&'static str, bool)>);

/// An engine with a scene in it.
pub trait Engine {
    /// Name and version.
    fn id(&self) -> (String, String);
    fn step(&mut self);
    fn state(&self, body: usize) -> State;
    /// Measures saving and restoring; `probe` steps on and gives the hash of where that leads.
    fn snapshot(&mut self, _reps: usize, _probe: &mut dyn FnMut(&mut Self) -> u64) -> Snapshot {
        (vec![], vec![])
    }
    /// Keeps the present state as that of a tick of a rollback, 0 to [`WINDOW`]; memory of earlier ones is used again.
    fn keep(&mut self, at: usize);
    /// Goes back to what was kept.
    fn back(&mut self, at: usize);
}

/// How many ticks a rollback goes back.
pub const WINDOW: usize = 8;

/// FNV-1a of the bits of all states.
pub fn hash_states<E: Engine>(engine: &E, bodies: &[usize]) -> u64 {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for byte in bodies.iter().flat_map(|&b| engine.state(b)).flat_map(|v| v.to_bits().to_le_bytes()) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    }
    hash
}

fn sample<E: Engine>(engine: &E, step: usize, ids: &[usize]) -> String {
    let row = |&b: &usize| format!("[{}]", engine.state(b).map(num).join(","));
    format!("[{step},[{}]]", ids.iter().map(row).collect::<Vec<_>>().join(","))
}

/// The value behind an option.
pub fn option(args: &[String], name: &str) -> Option<String> {
    args.iter().position(|a| a == name).and_then(|i| args.get(i + 1)).cloned()
}

/// An option's number, or what it is without it.
pub fn count(args: &[String], name: &str, without: usize) -> usize {
    option(args, name).map_or(without, |text| text.parse().unwrap_or_else(|_| panic!("{name} {text}")))
}

fn snapshot<E: Engine>(mut engine: E, ids: &[usize], warm: usize, reps: usize) -> String {
    for _ in 0..warm {
        engine.step();
    }
    let mut probe = |engine: &mut E| {
        for _ in 0..60 {
            engine.step();
        }
        hash_states(engine, ids)
    };
    let (costs, facts) = engine.snapshot(reps, &mut probe);
    let cost = |cost: &Cost| {
        let mut ns = cost.ns.clone();
        ns.sort();
        let (name, median, bytes) = (cost.name, ns[ns.len() / 2], cost.bytes);
        format!(
            "{{\"op\":\"{name}\",\"median_ns\":{median},\"min_ns\":{},\"reps\":{},\"bytes\":{bytes}}}",
            ns[0],
            ns.len()
        )
    };
    let costs: Vec<String> = costs.iter().map(cost).collect();
    let facts: Vec<String> = facts.iter().map(|(name, is)| format!("\"{name}\":{is}")).collect();
    format!("\"warm\":{warm},\"costs\":[{}],\"facts\":{{{}}}", costs.join(","), facts.join(","))
}

/// What a rollback costs: going back by [`WINDOW`] ticks, and each of these ticks again, kept as the first time.
fn rollback<E: Engine>(mut engine: E, ids: &[usize], warm: usize, reps: usize) -> String {
    for _ in 0..warm {
        engine.step();
    }
    let (mut back, mut again, mut same) = (vec![], vec![], true);
    for _ in 0..reps {
        for at in 0..WINDOW {
            engine.keep(at);
            engine.step();
        }
        let there = hash_states(&engine, ids);
        let begin = Instant::now();
        engine.back(0);
        back.push(begin.elapsed().as_nanos() as u64);
        for at in 0..WINDOW {
            let begin = Instant::now();
            engine.keep(at);
            engine.step();
            again.push(begin.elapsed().as_nanos() as u64);
        }
        same &= hash_states(&engine, ids) == there;
    }
    let list = |ns: &[u64]| ns.iter().map(u64::to_string).collect::<Vec<_>>().join(",");
    format!("\"warm\":{warm},\"back_ns\":[{}],\"again_ns\":[{}],\"same\":{same}", list(&back), list(&again))
}

/// Nanoseconds for which this thread had the processor in each window, nothing but steps being done.
fn windows<E: Engine>(engine: &mut E, scene: &Scene) -> String {
    let mut done = 0;
    let mut run = |engine: &mut E, to: usize| {
        let begin = ThreadTime::now();
        while done < to {
            engine.step();
            done += 1;
        }
        begin.elapsed().as_nanos().to_string()
    };
    let window = |&(_, from, to): &(&str, usize, usize)| {
        run(engine, from);
        run(engine, to)
    };
    scene.windows.iter().map(window).collect::<Vec<_>>().join(",")
}

/// Each step by itself, and states; before them the processor time of the windows, which is only right where states are not
/// told between.
fn steps<E: Engine>(mut engine: E, scene: &Scene, ids: &[usize], steps: usize) -> (String, String) {
    let mut ns = Vec::with_capacity(steps);
    let mut samples = vec![sample(&engine, 0, ids)];
    let (mut cpu, mut window) = (Vec::new(), ThreadTime::now());
    for k in 1..=steps {
        if scene.windows.iter().any(|&(_, from, _)| from + 1 == k) {
            window = ThreadTime::now();
        }
        let begin = Instant::now();
        engine.step();
        ns.push(begin.elapsed().as_nanos() as u64);
        if scene.windows.iter().any(|&(_, _, to)| to == k) {
            cpu.push(window.elapsed().as_nanos().to_string());
        }
        if k % scene.track_every == 0 || k == steps {
            samples.push(sample(&engine, k, ids));
        }
    }
    let hash = hash_states(&engine, ids);
    // A million numbers of one scene would be more than is read.
    let ns: Vec<String> = ns.iter().take(20_000).map(u64::to_string).collect();
    let (samples, ns) = (samples.join(","), ns.join(","));
    (cpu.join(","), format!("\"final_hash\":\"{hash:016x}\",\"samples\":[{samples}],\"step_ns\":[{ns}]"))
}

/// `build` gives an engine with the scene, or the name of what the engine does not have.
pub fn run<E: Engine>(build: impl Fn(&Scene, &[String]) -> Result<E, &'static str>) {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let name = option(&args, "--scene").expect("--scene NAME");
    let group = option(&args, "--group");
    let scene = crate::by_name(group.as_deref(), &name).unwrap_or_else(|| panic!("no scene {name}"));
    let mut engine = match build(&scene, &args) {
        Ok(engine) => engine,
        Err(what) => {
            println!("{{\"protocol\":2,\"scene\":\"{name}\",\"unsupported\":\"{what}\"}}");
            return;
        }
    };
    let (steps, ids, (id, version)) = (count(&args, "--steps", scene.steps), scene.tracked(), engine.id());
    let bodies = scene.bodies.len();
    let warm = |name: &str| option(&args, name).map(|warm| warm.parse().unwrap_or_else(|_| panic!("{name} WARM")));
    let rest = match (warm("--snapshot"), warm("--rollback")) {
        (Some(warm), _) => snapshot(engine, &ids, warm, steps.clamp(1, 200)),
        (None, Some(warm)) => rollback(engine, &ids, warm, steps.clamp(1, 200)),
        (None, None) => {
            // What tells its states at every step is timed by a run of its own.
            let alone = (scene.track_every == 1).then(|| windows(&mut engine, &scene));
            let Ok(again) = build(&scene, &args) else { unreachable!("it was built before") };
            let (within, rest) = self::steps(again, &scene, &ids, steps);
            format!("\"cpu_ns\":[{}],{rest}", alone.unwrap_or(within))
        }
    };
    println!(
        "{{\"protocol\":2,\"engine\":\"{id}\",\"version\":\"{version}\",\"scene\":\"{name}\",\"steps\":{steps},\"bodies\":{bodies},{rest}}}"
    );
}
