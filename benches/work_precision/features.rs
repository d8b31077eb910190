//! What each feature adds to a tick of a thousand boxes, so that a game can model only what it needs.

use crate::clock::{Cost, time};
use crate::scenes::{MILLI, Micro, ONE, Pair, Scene, features};
use crate::stage::{Setting, Stage, Trial};
use std::fmt::Write;
use std::hint::black_box;
use tamias2d::replay::Recorder;

/// A feature: what it changes of the scene, and what is done after each tick.
struct Feature {
    name: &'static str,
    change: fn(&mut Scene),
    then: Then,
}

#[derive(Clone, Copy, PartialEq)]
enum Then {
    Nothing,
    Hash,
    Save,
    Record,
}

/// The first is what the others are compared with: boxes that neither turn nor rub nor bounce. A new feature is a new row.
#[rustfmt::skip]
const FEATURES: &[Feature] = &[
    Feature { name: "boxes that collide, and no more", change: |_| {}, then: Then::Nothing },
    Feature { name: "no colliders: motion only", change: |s| s.things.iter_mut().for_each(|t| t.parts.clear()), then: Then::Nothing },
    Feature { name: "rotation", change: |s| turning(s, true), then: Then::Nothing },
    Feature { name: "friction 0.6", change: |s| s.friction = 600 * MILLI, then: Then::Nothing },
    Feature { name: "restitution 0.3", change: |s| s.restitution = 300 * MILLI, then: Then::Nothing },
    Feature { name: "damping", change: |s| s.things.iter_mut().for_each(|t| t.damping = damped(t.kind)), then: Then::Nothing },
    Feature { name: "an attractor", change: |s| s.attractors.push(([0, -6_371_000 * ONE], 1_000_000 * ONE)), then: Then::Nothing },
    Feature { name: "sleeping", change: |s| s.sleeping = true, then: Then::Nothing },
    Feature { name: "hash of every tick", change: |_| {}, then: Then::Hash },
    Feature { name: "save of every tick", change: |_| {}, then: Then::Save },
    Feature { name: "recording", change: |_| {}, then: Then::Record },
    Feature { name: "rotation and friction", change: |s| { turning(s, true); s.friction = 600 * MILLI; }, then: Then::Nothing },
];

fn turning(scene: &mut Scene, turns: bool) {
    for thing in &mut scene.things {
        thing.fixed_rotation = !turns;
    }
}

fn damped(kind: crate::scenes::Kind) -> Pair {
    const RATE: Micro = 100 * MILLI;
    if kind == crate::scenes::Kind::Dynamic { [RATE, RATE] } else { [0, 0] }
}

/// What a feature costs on one scene, in nanoseconds a tick.
pub struct Line {
    pub scene: &'static str,
    pub feature: &'static str,
    pub cost: Cost,
    /// What it adds to the first feature's, of the best rounds.
    pub adds: f64,
}

/// Nanoseconds a tick of the mean of so many ticks.
fn run(start: &Stage, then: Then, ticks: u64) -> f64 {
    let mut stage = start.clone();
    let mut bytes = Vec::new();
    let spent = match then {
        Then::Record => {
            let mut recorder = Recorder::new(stage.world, std::io::sink()).expect("a sink takes all");
            time(|| (0..ticks).for_each(|_| recorder.step()))
        }
        _ => time(|| {
            for _ in 0..ticks {
                stage.world.step();
                match then {
                    Then::Hash => drop(black_box(stage.world.hash())),
                    Then::Save => stage.world.save_into(&mut bytes),
                    Then::Nothing | Then::Record => {}
                }
            }
        }),
    };
    spent / ticks as f64
}

/// The features take turns in every round, one way and the other.
fn scene(name: &'static str, scene: &Scene, warm: u64, ticks: u64, rounds: usize) -> Vec<Line> {
    let prepare = |feature: &Feature| {
        let mut scene = scene.clone();
        turning(&mut scene, false);
        scene.friction = 0;
        (feature.change)(&mut scene);
        let mut stage = Stage::new(&scene, Setting::default());
        stage.run(warm);
        stage
    };
    let starts: Vec<Stage> = FEATURES.iter().map(prepare).collect();
    let mut costs = vec![Vec::new(); FEATURES.len()];
    for round in 0..rounds {
        for k in 0..FEATURES.len() {
            let k = if round % 2 == 0 { k } else { FEATURES.len() - 1 - k };
            costs[k].push(run(&starts[k], FEATURES[k].then, ticks));
        }
    }
    let costs: Vec<Cost> = costs.iter().map(|rounds| Cost::of(rounds)).collect();
    let line = |(feature, &cost): (&Feature, &Cost)| Line {
        scene: name,
        feature: feature.name,
        cost,
        adds: cost.best - costs[0].best,
    };
    FEATURES.iter().zip(&costs).map(line).collect()
}

/// Measures all on both scenes.
pub fn measure(rounds: usize) -> Vec<Line> {
    let mut lines = scene("100 stacks of 10, at rest", &features::stacks(), 120, 60, rounds);
    lines.extend(scene("pile of 1000, falling", &features::pile(), 0, 240, rounds.div_ceil(2)));
    lines
}

/// As a table of comma-separated values.
pub fn csv(lines: &[Line]) -> String {
    let mut text = String::from("scene,feature,best_us_per_tick,median_us_per_tick,adds_us_per_tick\n");
    for Line { scene, feature, cost, adds } in lines {
        let (best, median) = (cost.best * 1e-3, cost.median * 1e-3);
        let _ = writeln!(text, "\"{scene}\",\"{feature}\",{best:.1},{median:.1},{:.1}", adds * 1e-3);
    }
    text
}
