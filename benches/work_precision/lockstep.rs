//! What agreeing with others costs a tick: the hash, a recording, and verifying one.

use crate::clock::{Cost, time};
use crate::scenes::hard;
use crate::stage::{Setting, Stage, Trial};
use crate::table::{Table, markdown};
use std::fmt::Write;
use std::hint::black_box;
use tamias2d::World;
use tamias2d::replay::{Player, Recorder};

/// Ticks of a round. A recording of these has the hashes of its parts, which are written every second, and no keyframe.
const TICKS: u64 = 240;

/// What is done, as the page names it; the first is what the others are compared with.
const WAYS: [&str; 4] = ["plain stepping", "hash of every tick", "recording", "verifying the recording"];

/// A way and what it takes, in nanoseconds a tick.
pub struct Line {
    way: &'static str,
    cost: Cost,
}

fn record<W: std::io::Write>(world: &World, out: W) -> Recorder<W> {
    Recorder::new(world.clone(), out).expect("memory takes all")
}

/// Nanoseconds a tick.
fn run(way: usize, start: &World, file: &[u8]) -> f64 {
    let mut world = start.clone();
    let spent = match way {
        0 => time(|| (0..TICKS).for_each(|_| world.step())),
        1 => time(|| {
            for _ in 0..TICKS {
                world.step();
                black_box(world.hash());
            }
        }),
        2 => {
            let mut recorder = record(start, Vec::with_capacity(2 * file.len()));
            time(|| (0..TICKS).for_each(|_| recorder.step()))
        }
        // With opening the file and loading its world.
        _ => time(|| {
            let played = Player::new(file).and_then(Player::verify).expect("it was just recorded");
            assert_eq!(played.ticks, TICKS);
        }),
    };
    spent / TICKS as f64
}

/// All ways take turns in every round, one way and the other.
pub fn measure(rounds: usize) -> Vec<Line> {
    let mut stage = Stage::new(&hard::pyramid(40), Setting::default());
    stage.run(120);
    let mut recorder = record(&stage.world, Vec::new());
    (0..TICKS).for_each(|_| recorder.step());
    let file = recorder.finish().expect("memory takes all");
    let mut costs = vec![Vec::new(); WAYS.len()];
    for round in 0..rounds {
        for k in 0..WAYS.len() {
            let k = if round % 2 == 0 { k } else { WAYS.len() - 1 - k };
            costs[k].push(run(k, &stage.world, &file));
        }
    }
    WAYS.into_iter().zip(&costs).map(|(way, rounds)| Line { way, cost: Cost::of(rounds) }).collect()
}

/// As a table of comma-separated values.
pub fn csv(lines: &[Line]) -> String {
    let mut text = String::from("what,best_us_per_tick,median_us_per_tick\n");
    for Line { way, cost } in lines {
        let _ = writeln!(text, "{way},{:.2},{:.2}", cost.best * 1e-3, cost.median * 1e-3);
    }
    text
}

/// The page's part.
pub fn page(table: &Table) -> String {
    let of =
        |way: &str, column| table.find(&[("what", way)]).and_then(|row| table.number(row, column)).unwrap_or(f64::NAN);
    let columns = ["best_us_per_tick", "median_us_per_tick"];
    let ratio = |way: &str| columns.map(|column| of(way, column) / of(WAYS[0], column));
    let adds = |way: &str| ratio(way).map(|ratio| format!("{:.1} %", 100.0 * (ratio - 1.0)));
    let mut page = String::from("\n## What lockstep costs\n\n");
    let [best, median] = adds(WAYS[1]);
    let _ = write!(
        page,
        "On the pyramid of 820 boxes, after 2 s. The hash of the complete state after every tick adds {best} to a tick in the best \
         round ({median} in the median)."
    );
    let [best, median] = adds(WAYS[2]);
    let _ = write!(page, " Recording to memory, which takes that hash as well, adds {best} ({median}) in all.");
    let [best, median] = ratio(WAYS[3]).map(|ratio| format!("{:.3}", 1.0 / ratio));
    let _ = write!(
        page,
        " Verifying that recording, with opening it and comparing every hash, goes at {best} ({median}) of plain stepping's speed."
    );
    page += " All take turns in every round, 240 ticks at a time.\n\n";
    let row = |way: &&str| {
        let [best, median] = columns.map(|column| format!("{:.1}", of(way, column)));
        let share = if *way == WAYS[0] { "–".into() } else { ratio(way).map(|r| format!("{r:.3}")).join(" (") + ")" };
        vec![way.to_string(), best, median, share]
    };
    let head = ["820 boxes", "µs a tick: best", "median", "of plain stepping's time: best (median)"];
    page + &markdown(&head, &WAYS.iter().map(row).collect::<Vec<_>>())
}
