//! What several threads gain: one, and so many, step copies of a world in turn.

use crate::clock::Cost;
use crate::scenes::{Scene, growth};
use crate::stage::{Setting, Stage, Trial};
use std::time::Instant;
use tamias2d::{Threads, World};

/// Names, scenes of so many bodies, and the ticks before the first that is timed.
type Case = (&'static str, fn(i64) -> Scene, i64, u64);
const SCENES: [Case; 7] = [
    ("pyramid", growth::pyramid, 820, 60),
    ("pyramid", growth::pyramid, 5050, 60),
    ("pyramid", growth::pyramid, 20_100, 60),
    ("settled pile", growth::pile, 1000, 600),
    ("settled pile", growth::pile, 4000, 600),
    ("free flight", growth::flight, 10_000, 5),
    ("free flight", growth::flight, 100_000, 5),
];
const COUNTS: [usize; 3] = [2, 4, 8];
/// How often each has its turn, and for how many bodies' ticks.
const ROUNDS: usize = 15;
const BODIES: i64 = 10_000;

/// Milliseconds a tick, by the clock: threads work side by side. Best and median, and how many times as fast as one.
pub fn print() {
    println!("| scene | bodies | one thread | {} |", COUNTS.map(|count| format!("{count} threads")).join(" | "));
    println!("|---|---|---|{}", "---|".repeat(COUNTS.len()));
    for (name, scene, count, warm) in SCENES {
        let mut stage = Stage::new(&scene(count), Setting::default());
        stage.run(warm);
        let mut line = String::new();
        for threads in COUNTS {
            let [one, many] = compare(&stage.world, (BODIES / count).max(1) as u32, threads);
            let show = |cost: &Cost| format!("{:.2}, {:.2}", cost.best / 1e6, cost.median / 1e6);
            if line.is_empty() {
                line = format!("| {name} | {count} | {} |", show(&one));
            }
            let gain = [one.best / many.best, one.median / many.median];
            line += &format!(" {} (×{:.2}, {:.2}) |", show(&many), gain[0], gain[1]);
        }
        println!("{line}");
    }
}

/// Nanoseconds a tick of one thread, and of so many.
fn compare(world: &World, ticks: u32, count: usize) -> [Cost; 2] {
    let all = [Threads::default(), Threads::new(count).expect("they start")];
    let mut worlds = [world.clone(), world.clone()];
    let mut rounds = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for at in 0..2 {
            for _ in 0..ticks {
                let begin = Instant::now();
                worlds[at].step_on(&all[at]);
                rounds[at].push(begin.elapsed().as_secs_f64() * 1e9);
            }
        }
        assert_eq!(worlds[0].hash(), worlds[1].hash());
    }
    rounds.map(|rounds| Cost::of(&rounds))
}
