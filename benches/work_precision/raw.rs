//! What `benches/peers/driver.py` leaves, made into tables.

use crate::clock::Cost;
use crate::exact::CASES;
use crate::hard::Ways;
use crate::scenes::hard::{Should, all};
use crate::scenes::{Kind, ONE};
use crate::trace::Trace;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// All lines of one engine with one setting on one scene, by rounds.
type Runs = BTreeMap<[String; 4], Vec<Value>>;

fn text(line: &Value, field: &str) -> String {
    line[field].as_str().unwrap_or_default().to_string()
}

/// By group, scene, engine and setting.
fn read(folder: &Path) -> Runs {
    let mut runs = Runs::new();
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}; benches/peers/run.sh makes it", folder.display()))
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    for path in paths {
        let bytes = std::fs::read(&path).expect("it is listed");
        let line: Value = serde_json::from_slice(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let setting = format!("{:02}", line["setting"].as_u64().unwrap_or(0));
        let key = [text(&line, "group"), text(&line, "scene"), text(&line, "name"), setting];
        runs.entry(key).or_default().push(line);
    }
    runs
}

/// Times of steps from … to of a round, in ns.
fn steps(line: &Value, from: usize, to: usize) -> Vec<f64> {
    let all = line["step_ns"].as_array().map_or(&[][..], Vec::as_slice);
    all[from.min(all.len())..to.min(all.len())].iter().filter_map(Value::as_f64).collect()
}

/// Nanoseconds of processor time a step of a window, by rounds.
fn mean(lines: &[Value], window: usize, steps: usize) -> Option<Cost> {
    let rounds: Option<Vec<f64>> = lines.iter().map(|line| line["cpu_ns"][window].as_f64()).collect();
    Some(Cost::of(&rounds?.iter().map(|ns| ns / steps as f64).collect::<Vec<_>>()))
}

fn accuracy(runs: &Runs) -> String {
    let mut out =
        String::from("case,engine,setting,default,error,best_us_per_step,median_us_per_step,same_every_round\n");
    for case in CASES {
        for ([_, _, engine, setting], lines) in runs.iter().filter(|(k, _)| k[0] == "accuracy" && k[1] == case.name) {
            let Some(mut trace) = Trace::new(&(case.scene)(), &lines[0]) else { continue };
            let error = (case.judge)(&mut trace, (case.seconds * 60.0).round() as u64);
            let ticks = lines[0]["steps"].as_u64().unwrap_or(1) as usize;
            let Some(Cost { best, median }) = mean(lines, 0, ticks) else { continue };
            let same = lines.iter().all(|line| line["final_hash"] == lines[0]["final_hash"]);
            let default = lines[0]["default"].as_bool().unwrap_or(false);
            let setting: u32 = setting.parse().expect("written by two digits");
            let (best, median) = (best * 1e-3, median * 1e-3);
            let _ =
                writeln!(out, "{},{engine},{setting},{default},{error:.3e},{best:.3},{median:.3},{same}", case.name);
        }
    }
    out
}

fn hard(runs: &Runs) -> String {
    let mut out = String::from("case,engine,survived,drift_m,sag_m,creep_in_2nd_half_m,overlap_m,end_speed_m_per_s\n");
    for case in all() {
        for ([_, _, engine, _], lines) in runs.iter().filter(|(k, _)| k[0] == "hard" && k[1] == case.name) {
            let Some(trace) = Trace::new(&case.scene, &lines[0]) else {
                let _ = writeln!(out, "{},{engine},,,,,,", case.name);
                continue;
            };
            let [start, half, end] = trace.thirds();
            let ways = Ways::new(&case, start, half, end);
            let gravity = -(case.scene.gravity[1] as f64) / ONE as f64;
            let [before, weight] = trace.energy(start, gravity);
            let gain = (trace.energy(end, gravity)[0] - before) / weight;
            let dynamic = |at: &usize| case.scene.things[*at].kind == Kind::Dynamic;
            let finite = (0..end.len()).filter(dynamic).all(|at| end[at].at.iter().all(|v| v.is_finite()));
            let survived = ways.right && finite && (!matches!(case.should, Should::NotGain) || gain < 1e-3);
            let stands = matches!(case.should, Should::Stand(_)) && finite;
            let way = |v: f64| if stands { format!("{v:.3e}") } else { String::new() };
            let [drift, sag, creep] = [ways.drift, ways.sag, ways.creep].map(way);
            let _ = writeln!(
                out,
                "{},{engine},{survived},{drift},{sag},{creep},{:.3e},{:.3e}",
                case.name, ways.overlap, ways.speed
            );
        }
    }
    out
}

/// The windows of a speed scene.
fn windows(peers: &Path, scene: &str) -> Vec<(String, usize, usize)> {
    let path = peers.join(format!("scenes-json/speed.{scene}.json"));
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let scene: Value = serde_json::from_slice(&bytes).expect("written by the harness");
    let window = |w: &Value| Some((w[0].as_str()?.to_string(), w[1].as_u64()? as usize, w[2].as_u64()? as usize));
    scene["windows"].as_array().map_or(Vec::new(), |all| all.iter().filter_map(window).collect())
}

fn speed(peers: &Path, runs: &Runs) -> String {
    let mut out = String::from("scene,window,engine,best_ms,median_ms,median_step_ms,rounds,unsupported\n");
    for ([_, scene, engine, _], lines) in runs.iter().filter(|(k, _)| k[0] == "speed") {
        for (at, (window, from, to)) in windows(peers, scene).into_iter().enumerate() {
            if let Some(what) = lines[0]["unsupported"].as_str() {
                let _ = writeln!(out, "{scene},{window},{engine},,,,,{what}");
                continue;
            }
            let Some(Cost { best, median }) = mean(lines, at, to - from) else { continue };
            let steps = lines.iter().map(|line| steps(line, from, to)).filter(|ns| !ns.is_empty());
            let Some(step) = steps.map(|ns| Cost::of(&ns).median).min_by(f64::total_cmp) else { continue };
            let [best, median, step] = [best, median, step].map(|ns| ns * 1e-6);
            let _ = writeln!(out, "{scene},{window},{engine},{best:.5},{median:.5},{step:.5},{},", lines.len());
        }
    }
    out
}

fn snapshots(runs: &Runs) -> String {
    let mut out = String::from("scene,engine,what,best_us,median_us,bytes,holds\n");
    for ([_, scene, engine, _], lines) in runs.iter().filter(|(k, _)| k[0] == "snapshot") {
        for (at, cost) in lines[0]["costs"].as_array().into_iter().flatten().enumerate() {
            let of = |field: &str| -> Vec<f64> {
                lines.iter().filter_map(|line| line["costs"][at][field].as_f64()).map(|ns| ns * 1e-3).collect()
            };
            let (best, median) = (Cost::of(&of("min_ns")).best, Cost::of(&of("median_ns")).best);
            let (op, bytes) = (text(cost, "op"), cost["bytes"].as_u64().unwrap_or(0));
            let _ = writeln!(out, "{scene},{engine},{op},{best:.1},{median:.1},{bytes},");
        }
        for (fact, holds) in lines[0]["facts"].as_object().into_iter().flatten() {
            let _ = writeln!(out, "{scene},{engine},{fact},,,,{holds}");
        }
    }
    out
}

/// A frame at 60 Hz, in nanoseconds.
const FRAME: f64 = 1e9 / 60.0;

/// What going back costs, what a tick costs when it is computed again and kept, and how many of them a frame has room for. Of the
/// best round, by its medians: the mean is what others on the machine make of it.
fn rollbacks(runs: &Runs) -> String {
    let mut out = String::from("scene,engine,bodies,back_us,again_us,ticks_per_frame,same\n");
    for ([_, scene, engine, _], lines) in runs.iter().filter(|(k, _)| k[0] == "rollback") {
        let best = |field: &str| {
            let median = |line: &Value| {
                let ns: Vec<f64> = line[field].as_array()?.iter().filter_map(Value::as_f64).collect();
                (!ns.is_empty()).then(|| Cost::of(&ns).median)
            };
            lines.iter().filter_map(median).min_by(f64::total_cmp)
        };
        let (Some(back), Some(again)) = (best("back_ns"), best("again_ns")) else { continue };
        let ticks = ((FRAME - back) / again).floor().max(0.0);
        let bodies = lines[0]["bodies"].as_u64().unwrap_or(0);
        let same = lines.iter().all(|line| line["same"] == true);
        let _ = writeln!(out, "{scene},{engine},{bodies},{:.1},{:.1},{ticks},{same}", back * 1e-3, again * 1e-3);
    }
    out
}

fn engines(runs: &Runs) -> String {
    let mut versions: BTreeMap<&str, String> = BTreeMap::new();
    for ([_, _, engine, _], lines) in runs.iter().filter(|(_, lines)| lines[0]["version"].is_string()) {
        versions.insert(engine, text(&lines[0], "version"));
    }
    let line = |(engine, version): (&&str, &String)| format!("{engine},\"{version}\"\n");
    String::from("engine,version\n") + &versions.iter().map(line).collect::<String>()
}

/// Writes the tables of other engines beside ours. What was not run stays as it is.
pub fn write(peers: &Path, report: &Path) {
    let runs = read(&peers.join("raw"));
    let has = |group: &str| runs.keys().any(|key| key[0] == group);
    let put = |name: &str, text: String| std::fs::write(report.join(name), text).expect("the folder is ours");
    if has("accuracy") {
        put("peers_accuracy.csv", accuracy(&runs));
    }
    if has("hard") {
        put("peers_hard.csv", hard(&runs));
    }
    if has("speed") {
        put("peers_speed.csv", speed(peers, &runs));
    }
    if has("snapshot") {
        put("peers_snapshots.csv", snapshots(&runs));
    }
    if has("rollback") {
        put("peers_rollback.csv", rollbacks(&runs));
    }
    put("peers_engines.csv", engines(&runs));
    for (key, lines) in &runs {
        if let Some(error) = lines[0]["error"].as_str() {
            eprintln!("{}: {error}", key.join(" "));
        }
    }
}
