//! The page of the report, from the files of figures beside it.

use crate::exact::CASES;
use crate::grid::{self, Point};
use crate::table::{Table, error, figures, length, markdown};
use crate::{draw, growth, lockstep, peers};
use std::path::Path;

const HOW: &str = "\
What moves, turns and bounces by itself is exact but for rounding, whatever the setting; friction and loads get better with \
substeps and ticks, for time.

An error is how far a scene ends from what mechanics says, in the unit named; a reference in `f64` is used where there is
no formula. Time is that which the thread had the processor, the best of rounds in which all settings take turns.
";

fn hard(table: &Table) -> String {
    let cell = |row: usize, column: &str| table.number(row, column).map_or("–".into(), length);
    let rows: Vec<Vec<String>> = (0..table.len())
        .map(|row| {
            let survived = table.get(row, "survived") == "true";
            let same = match table.get(row, "same_bits_elsewhere") {
                "true" => "same bits elsewhere",
                "false" => "**other bits elsewhere**",
                _ => "",
            };
            let notes = [same, table.get(row, "status")].into_iter().filter(|note| !note.is_empty());
            let ways = ["drift_m", "sag_m", "creep_in_2nd_half_m"].map(|column| cell(row, column));
            let mut cells = vec![table.get(row, "what").to_string(), if survived { "yes" } else { "**no**" }.into()];
            cells.extend(ways);
            cells.push(cell(row, "overlap_m"));
            cells.push(error(table.number(row, "end_speed_m_per_s").unwrap_or(f64::NAN)));
            cells.push(cell(row, "energy_gain_m_of_height"));
            cells.push(figures(table.number(row, "us_per_tick").unwrap_or(f64::NAN)));
            cells.push(notes.collect::<Vec<_>>().join("; "));
            cells
        })
        .collect();
    let head =
        ["scene", "survived", "drift", "sag", "creep", "overlap", "end speed, m/s", "energy", "µs a tick", "notes"];
    markdown(&head, &rows)
}

fn features(table: &Table) -> String {
    let scenes = table.distinct("scene");
    let names = table.distinct("feature");
    let cells = |name: &String| {
        let mut cells = vec![name.clone()];
        for scene in &scenes {
            let row = table.find(&[("scene", scene), ("feature", name)]).expect("every scene has every feature");
            let number = |column| table.number(row, column).unwrap_or(f64::NAN);
            let adds = number("adds_us_per_tick");
            let adds = if name == &names[0] { "–".into() } else { format!("{adds:+.0}") };
            cells.push(format!("{:.0}", number("best_us_per_tick")));
            cells.push(format!("{:.0}", number("median_us_per_tick")));
            cells.push(adds);
        }
        cells
    };
    let mut head = vec!["µs a tick".to_string()];
    for scene in &scenes {
        head.extend([format!("{scene}: best"), "median".into(), "adds".into()]);
    }
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    markdown(&head, &names.iter().map(cells).collect::<Vec<_>>())
}

/// Errors at the default setting, and the least of all settings with what it costs.
fn defaults(points: &[Point]) -> String {
    let rows = CASES.iter().enumerate().map(|(at, case)| {
        let of = || points.iter().filter(move |p| p.case == at);
        let default = of().find(|p| p.setting == crate::stage::Setting::default()).expect("measured");
        let best = of().min_by(|a, b| a.error.total_cmp(&b.error)).expect("measured");
        let setting = format!("{}/s, {}", best.setting.rate, best.setting.substeps);
        vec![
            case.title.into(),
            case.error.into(),
            error(default.error),
            format!("{:.2}", default.cost.best * 1e-3),
            error(best.error),
            setting,
        ]
    });
    let head = ["case", "error of", "at 60 ticks/s, 10 substeps", "µs a tick", "least", "with ticks/s, substeps"];
    markdown(&head, &rows.collect::<Vec<_>>())
}

/// Draws all diagrams and writes the page.
pub fn write(folder: &Path) {
    let file = |name: &str| Table::read(&folder.join(name));
    let machine = std::fs::read_to_string(folder.join("machine.txt")).unwrap_or_default();
    let mut page = String::from("# How wrong it is, and at what cost\n\n");
    page += "Written by `cargo bench --bench work_precision`";
    page += " and `benches/peers/run.sh`; do not edit. The figures are in the `.csv` files beside this page.\n\n";
    page += &peers::summary(folder);
    page += "Below: [work and precision](#work-and-precision), [hard cases](#hard-cases), [other engines](#other-engines), \
             [growth](#growth), [what features cost](#what-features-cost), [what lockstep costs](#what-lockstep-costs), \
             [the machine](#the-machine), [commands](#commands).\n\n";
    page += "## Work and precision\n\n";
    page += HOW;
    if let Some(points) = file("work_precision.csv").map(|table| grid::read(&table)) {
        draw::work_precision(folder, &points);
        page +=
            "\n![Motion](motion.svg)\n\n![Friction](friction.svg)\n\n![Impacts](impacts.svg)\n\n![Loads](rest.svg)\n\n";
        page += &defaults(&points);
    }
    if let Some(table) = file("hard.csv") {
        page += "\n## Hard cases\n\n";
        page += "At 60 ticks/s and 10 substeps, for a minute or until it should be over. What should stand survives if no body goes \
                 farther sideways than half its size, or down by more than that and a tenth of the whole's height; \
                 what should stay, if nothing is lost. Drift and sag: the greatest way of a body sideways \
                 and down from where it was put; creep: its way in the second half; overlap: the deepest at the end; energy: \
                 the greatest rise of KE + PE above its least so far, as the height to which it would lift everything. Notes: \
                 what the world's status names, and whether the same scene 2²⁰ m and 999 999 900 m away (drift and stop: 10⁶ m) \
                 gave the same bits in every tick. `–`: has no meaning there.\n\n";
        page += &hard(&table);
    }
    page += &peers::tables(folder);
    if let Some(table) = file("growth.csv") {
        page += &growth::page(folder, &table);
    }
    if let Some(table) = file("features.csv") {
        page += "\n## What features cost\n\n";
        page += "A thousand boxes; each row adds one thing to the first one. The pile's rows are different piles, for what is \
                 added changes how it falls.\n\n";
        page += &features(&table);
    }
    if let Some(table) = file("lockstep.csv") {
        page += &lockstep::page(&table);
    }
    page += "\n## The machine\n\n";
    page += &machine;
    if let Ok(machine) = std::fs::read_to_string(folder.join("peers_machine.txt")) {
        page += "\nThe runs of all engines:\n\n";
        page += &machine;
    }
    page += "\nThe load is that of the end; above 1 other work ran at the same time. Compare figures of one run with each other \
             only.\n";
    page += "\n## Commands\n\n";
    page += "| command | writes | takes |\n| --- | --- | --- |\n";
    page += "| `cargo bench --bench work_precision` | everything but the peers' figures | 6 min of processor time |\n";
    page += "| `cargo bench --bench work_precision -- grid` (or `hard`, `features`, `growth`, `lockstep`) | that part | |\n";
    page += "| `cargo bench --bench work_precision -- page` | diagrams and this page from the `.csv` files | 1 s |\n";
    page += "| `benches/peers/run.sh` | the peers' figures; see [its page](../peers/README.md) | 30 min, and 5 to 20 to build |\n";
    std::fs::write(folder.join("README.md"), page).expect("the folder is ours");
}
