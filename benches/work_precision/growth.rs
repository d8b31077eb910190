//! How time grows with the number of bodies.

use crate::clock::{Cost, time};
use crate::plot::{Panel, Series, Sheet, sheet};
use crate::scenes::{Kind, Scene, growth};
use crate::stage::{Setting, Stage, Trial};
use crate::table::{Table, error, markdown};
use std::fmt::Write;
use std::path::Path;

/// About how many bodies.
const COUNTS: [i64; 7] = [100, 300, 1000, 3000, 10_000, 30_000, 100_000];

/// How often ticks are timed; as many at a time as make this many bodies, or one.
const TIMES: usize = 12;
const BODIES: usize = 3000;

/// Names, scenes, and the ticks before the first that is timed.
type Kinds = [(&'static str, fn(i64) -> Scene, u64); 3];
const SCENES: Kinds = [
    ("free flight", growth::flight, 5),
    ("settled pile, 10 boxes deep", growth::pile, 150),
    ("pyramid", growth::pyramid, 60),
];

/// A scene of so many bodies that move, in nanoseconds a tick.
pub struct Line {
    scene: &'static str,
    bodies: usize,
    cost: Cost,
    /// Root of the mean square at the end, in m/s: how near rest it is.
    speed: f64,
}

fn line(scene: &'static str, things: &Scene, warm: u64) -> Line {
    let mut stage = Stage::new(things, Setting::default());
    stage.run(warm);
    let moving: Vec<usize> = (0..stage.count()).filter(|&at| things.things[at].kind == Kind::Dynamic).collect();
    let ticks = (BODIES / moving.len()).max(1) as u64;
    let times: Vec<f64> = (0..TIMES).map(|_| time(|| stage.run(ticks)) / ticks as f64).collect();
    let square = |&at: &usize| stage.state(at).velocity.iter().map(|v| v * v).sum::<f64>();
    let speed = (moving.iter().map(square).sum::<f64>() / moving.len() as f64).sqrt();
    Line { scene, bodies: moving.len(), cost: Cost::of(&times), speed }
}

/// Measures all scenes with up to this many bodies.
pub fn measure(most: i64) -> Vec<Line> {
    let counts = || COUNTS.into_iter().filter(move |&count| count <= most);
    SCENES.iter().flat_map(|&(name, scene, warm)| counts().map(move |n| line(name, &scene(n), warm))).collect()
}

/// As a table of comma-separated values.
pub fn csv(lines: &[Line]) -> String {
    let mut text = String::from("scene,bodies,best_ns_per_body,median_ns_per_body,rms_speed_m_per_s\n");
    for Line { scene, bodies, cost, speed } in lines {
        let of = |ns: f64| ns / *bodies as f64;
        let _ = writeln!(text, "\"{scene}\",{bodies},{:.1},{:.1},{speed:.2e}", of(cost.best), of(cost.median));
    }
    text
}

/// Draws the diagram.
fn draw(path: &Path, table: &Table) {
    let points = |scene: &String| {
        let rows = (0..table.len()).filter(|&row| table.get(row, "scene") == scene);
        rows.filter_map(|row| Some([table.number(row, "bodies")?, table.number(row, "best_ns_per_body")?])).collect()
    };
    let names = table.distinct("scene");
    let legend: Vec<(&str, usize)> = names.iter().enumerate().map(|(style, name)| (name.as_str(), style)).collect();
    let series = names.iter().enumerate().map(|(style, name)| Series { style, joined: true, points: points(name) });
    let panel =
        Panel { title: String::new(), unit: "ns of processor time per body and tick".into(), series: series.collect() };
    let style = Sheet {
        title: "A level line is linear growth",
        x: "bodies",
        legend: &legend,
        columns: 1,
        floor: -1,
        common: true,
    };
    sheet(path, &style, &[panel]);
}

/// Draws the diagram, and gives back the page's part.
pub fn page(folder: &Path, table: &Table) -> String {
    draw(&folder.join("growth.svg"), table);
    let mut page = String::from(
        "\n## Growth\n\n\
         Time per body and tick at 60 ticks/s and 10 substeps with sleeping off: what the thread had the processor, best and median \
         of 12 times. Free flight: boxes that turn and meet nothing. Pile: boxes of 60 cm to 1 m in a bin, ten rows whatever the \
         count, so it gets wider and not deeper; they are put down a little apart and have had 2.5 s to come to rest. Pyramid: whole \
         rows of boxes of 1 m that touch the row below, after 1 s; it gets higher, and a high one still sinks into itself then. The \
         speed, the root of the mean square at the end, says how near rest each was.\n\n",
    );
    for scene in table.distinct("scene") {
        let rows: Vec<usize> = (0..table.len()).filter(|&row| table.get(row, "scene") == scene).collect();
        let (few, many) = (rows.iter().copied().find(|&row| table.number(row, "bodies") > Some(900.0)), rows.last());
        if let (Some(few), Some(&many)) = (few, many) {
            let of = |row| table.number(row, "best_ns_per_body").unwrap_or(f64::NAN);
            let bodies = |row| table.get(row, "bodies");
            let (a, b, times) = (bodies(many), bodies(few), of(many) / of(few));
            let _ = writeln!(page, "* {scene}: with {a} bodies a body takes {times:.2} times what it takes with {b}.");
        }
    }
    page += "\n![Time per body over the number of bodies](growth.svg)\n\n";
    let row = |row| {
        let number = |column| table.number(row, column).unwrap_or(f64::NAN);
        let [best, median] = ["best_ns_per_body", "median_ns_per_body"].map(|column| format!("{:.0}", number(column)));
        let (scene, bodies) = (table.get(row, "scene").to_string(), table.get(row, "bodies").to_string());
        // In flight speed says nothing about rest.
        let speed = if scene == SCENES[0].0 { "–".into() } else { error(number("rms_speed_m_per_s")) };
        vec![scene, bodies, best, median, speed]
    };
    let head = ["scene", "bodies", "ns per body and tick: best", "median", "speed, m/s"];
    page + &markdown(&head, &(0..table.len()).map(row).collect::<Vec<_>>())
}
