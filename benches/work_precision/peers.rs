//! Other engines' figures beside ours, from the tables that `benches/peers/run.sh` leaves.

use crate::exact::CASES;
use crate::plot::{Panel, Row, Series, Sheet, dots, sheet};
use crate::scenes::hard;
use crate::table::{Table, figures, length, markdown};
use std::path::Path;

/// Names in tables, names for readers; the order is that of styles.
const ENGINES: [(&str, &str); 5] = [
    ("ours", "tamias2d"),
    ("box2d", "Box2D (AVX2)"),
    ("rapier", "Rapier (deterministic)"),
    ("chipmunk", "Chipmunk"),
    ("box2d-double", "Box2D (double)"),
];

/// The speed scenes' names and what they are.
const SPEED: [(&str, &str); 10] = [
    ("s1_pyramid40", "pyramid of 820 boxes"),
    ("s1_pyramid100", "pyramid of 5050 boxes"),
    ("s2_pile1000", "pile of 1000 polygons"),
    ("s2_pile4000", "pile of 4000 polygons"),
    ("s3_bouncers_nograv", "200 bouncers, no gravity"),
    ("s3_bouncers_grav", "200 bouncers under gravity"),
    ("s4_free10000", "10 000 bodies in free fall"),
    ("s5_tumbler500", "tumbler with 500 boxes"),
    ("s6_stack20", "stack of 20"),
    ("s7_chain100", "chain of 100 hinges"),
];

/// The scenes of rollbacks.
const ROLLBACK: [(&str, &str); 5] = [
    ("r_pile50", "pile of 50 polygons"),
    ("r_pile200", "pile of 200 polygons"),
    ("r_pile820", "pile of 820 polygons"),
    ("r_pile2000", "pile of 2000 polygons"),
    ("r_pyramid820", "pyramid of 820 boxes"),
];

fn legend(engines: usize) -> Vec<(&'static str, usize)> {
    ENGINES[..engines].iter().enumerate().map(|(style, (_, name))| (*name, style)).collect()
}

/// The error of an engine at its default setting.
fn at_default(table: &Table, case: &str, engine: &str) -> Option<f64> {
    let row = table.find(&[("case", case), ("engine", engine), ("default", "true")])?;
    table.number(row, "error")
}

fn accuracy_dots(folder: &Path, table: &Table) {
    let rows = CASES.iter().filter_map(|case| {
        let values: Vec<Option<f64>> = ENGINES.iter().map(|(engine, _)| at_default(table, case.name, engine)).collect();
        let any = values.iter().flatten().next().is_some();
        any.then(|| Row { label: format!("{}: {}", case.title, case.error), values })
    });
    let rows: Vec<Row> = rows.collect();
    let title = "Error at default settings, 60 ticks/s: farther left is better";
    let x = "error, in the unit of its row; what is below 10⁻¹² is drawn there";
    dots(&folder.join("accuracy.svg"), title, x, &legend(ENGINES.len()), &rows, -12);
}

fn speed_dots(folder: &Path, table: &Table) {
    let mut rows = Vec::new();
    for (scene, what) in SPEED {
        let mut windows: Vec<&str> = Vec::new();
        for row in (0..table.len()).filter(|&row| table.get(row, "scene") == scene) {
            if !windows.contains(&table.get(row, "window")) {
                windows.push(table.get(row, "window"));
            }
        }
        for window in windows {
            let value = |(engine, _): &(&str, &str)| {
                let row = table.find(&[("scene", scene), ("window", window), ("engine", engine)])?;
                table.number(row, "best_ms")
            };
            let when = if window == "all" { String::new() } else { format!(", {window}") };
            let ours = table.find(&[("scene", scene), ("window", window), ("engine", "ours")]);
            let lacks = ours.map_or("", |row| table.get(row, "unsupported"));
            let lacks = if lacks.is_empty() { String::new() } else { format!(" (tamias2d: no {lacks})") };
            rows.push(Row { label: format!("{what}{when}{lacks}"), values: ENGINES[..4].iter().map(value).collect() });
        }
    }
    let title = "Time per tick at default settings, one thread: farther left is better";
    dots(
        &folder.join("speed.svg"),
        title,
        "ms of processor time per tick, mean of the best round",
        &legend(4),
        &rows,
        -6,
    );
}

/// Error against time by substeps or iterations.
fn curves(folder: &Path, table: &Table) {
    let panel = |case: &crate::exact::Case| {
        let mut series = Vec::new();
        for (style, (engine, _)) in ENGINES.iter().enumerate() {
            let rows =
                || (0..table.len()).filter(|&r| table.get(r, "case") == case.name && table.get(r, "engine") == *engine);
            let point = |row: usize| Some([table.number(row, "best_us_per_step")?, table.number(row, "error")?]);
            series.push(Series { style, joined: true, points: rows().filter_map(point).collect() });
            let default = rows().filter(|&row| table.get(row, "default") == "true").filter_map(point).collect();
            series.push(Series { style: 6, joined: false, points: default });
        }
        let any = series.iter().any(|series| !series.points.is_empty());
        any.then(|| Panel { title: case.title.into(), unit: format!("error: {}", case.error), series })
    };
    let panels: Vec<Panel> = CASES.iter().filter_map(panel).collect();
    let mut legend = legend(ENGINES.len());
    legend.push(("default", 6));
    let style = Sheet {
        title: "60 ticks/s, substeps or solver iterations 1, 2, 4, 8, 16 and the default. Lower left is better",
        x: "µs of processor time per tick, mean of the best round",
        legend: &legend,
        columns: 3,
        floor: -12,
        common: false,
    };
    sheet(&folder.join("peers.svg"), &style, &panels);
}

/// In how many cases ours is the least wrong, and which the others are.
fn verdict(table: &Table) -> String {
    let (mut least, mut all, mut others) = (0, 0, Vec::new());
    for case in CASES {
        let Some(ours) = at_default(table, case.name, "ours") else { continue };
        let peers =
            ENGINES[1..].iter().filter_map(|(engine, name)| Some((at_default(table, case.name, engine)?, *name)));
        let Some((best, name)) = peers.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        all += 1;
        if ours <= best {
            least += 1;
        } else {
            others.push(format!("{} ({name}: {best:.2e}, here {ours:.2e})", case.title));
        }
    }
    let but = if others.is_empty() { String::new() } else { format!(" The others: {}.", others.join("; ")) };
    format!(
        "**In {least} of {all} cases with a known outcome this engine is the least wrong, at everyone's default settings.**{but}\n\n"
    )
}

/// What a reader sees first.
pub fn summary(folder: &Path) -> String {
    let mut page = String::new();
    if let Some(table) = Table::read(&folder.join("peers_accuracy.csv")) {
        accuracy_dots(folder, &table);
        curves(folder, &table);
        page += &verdict(&table);
        page += "![Errors of four engines](accuracy.svg)\n\n";
    }
    if let Some(table) = Table::read(&folder.join("peers_speed.csv")) {
        speed_dots(folder, &table);
        page += "![Time per tick of four engines](speed.svg)\n\n";
    }
    page
}

fn hard_cases(table: &Table) -> String {
    let cell = |case: &str, engine: &str| {
        let Some(row) = table.find(&[("case", case), ("engine", engine)]) else { return "not run".into() };
        match table.get(row, "survived") {
            "" => "no end".into(),
            "true" => {
                let part = |name, column| table.number(row, column).map(|v| format!("{name} {}", length(v)));
                let parts = [
                    part("drift", "drift_m"),
                    part("sag", "sag_m"),
                    part("creep", "creep_in_2nd_half_m"),
                    part("overlap", "overlap_m"),
                ];
                format!("yes: {}", parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
            }
            _ => "**no**".into(),
        }
    };
    let row = |case: &hard::Case| {
        let engines = ENGINES[..4].iter().map(|(engine, _)| cell(case.name, engine));
        [case.what.to_string()].into_iter().chain(engines).collect()
    };
    let mut head = vec!["scene"];
    head.extend(ENGINES[..4].iter().map(|(_, name)| *name));
    markdown(&head, &hard::all().iter().map(row).collect::<Vec<_>>())
}

fn speed(table: &Table) -> String {
    let mut rows = Vec::new();
    for (scene, what) in SPEED {
        let mut seen: Vec<String> = Vec::new();
        for row in (0..table.len()).filter(|&row| table.get(row, "scene") == scene) {
            let window = table.get(row, "window").to_string();
            if seen.contains(&window) {
                continue;
            }
            let cell = |(engine, _): &(&str, &str)| {
                let Some(row) = table.find(&[("scene", scene), ("window", &window), ("engine", engine)]) else {
                    return "not run".to_string();
                };
                match (table.number(row, "best_ms"), table.get(row, "unsupported")) {
                    (Some(best), _) => {
                        let [median, step] =
                            ["median_ms", "median_step_ms"].map(|c| table.number(row, c).unwrap_or(f64::NAN));
                        format!("{best:.3} ({median:.3}; {step:.3})")
                    }
                    (None, what) => format!("no {what}"),
                }
            };
            let mut cells = vec![if window == "all" { what.into() } else { format!("{what}, {window}") }];
            cells.extend(ENGINES[..4].iter().map(cell));
            rows.push(cells);
            seen.push(window);
        }
    }
    let mut head = vec!["ms per tick"];
    head.extend(ENGINES[..4].iter().map(|(_, name)| *name));
    markdown(&head, &rows)
}

fn snapshots(table: &Table) -> String {
    let rows = (0..table.len()).map(|row| {
        let us = |column| table.number(row, column).map_or(String::new(), |v| format!("{} µs", figures(v)));
        let holds = match table.get(row, "holds") {
            "true" => "yes".into(),
            "false" => "**no**".into(),
            _ => us("best_us"),
        };
        let bytes = table.number(row, "bytes").filter(|&bytes| bytes > 0.0);
        let size = bytes.map_or(String::new(), |bytes| format!("{:.0} kB", bytes / 1000.0));
        let engine = ENGINES.iter().find(|(name, _)| *name == table.get(row, "engine")).map_or("", |(_, name)| name);
        let scene = SPEED.iter().find(|(name, _)| *name == table.get(row, "scene")).map_or("", |(_, what)| what);
        vec![scene.into(), engine.into(), table.get(row, "what").into(), holds, us("median_us"), size]
    });
    markdown(&["scene", "engine", "what", "best, or whether", "median", "size"], &rows.collect::<Vec<_>>())
}

fn rollbacks(table: &Table) -> String {
    let row = |(scene, what): &(&str, &str)| {
        let cell = |(engine, _): &(&str, &str)| {
            if *engine == "chipmunk" {
                return "its copies go on differently".into();
            }
            let Some(row) = table.find(&[("scene", scene), ("engine", engine)]) else { return "not run".into() };
            let number = |column| table.number(row, column).unwrap_or(f64::NAN);
            let same = if table.get(row, "same") == "true" { "" } else { ", **goes on differently**" };
            let [back, again] = ["back_us", "again_us"].map(|column| figures(number(column)));
            format!("**{:.0}** ({back}; {again}){same}", number("ticks_per_frame"))
        };
        [what.to_string()].into_iter().chain(ENGINES[..4].iter().map(cell)).collect()
    };
    let mut head = vec!["ticks a frame"];
    head.extend(ENGINES[..4].iter().map(|(_, name)| *name));
    markdown(&head, &ROLLBACK.iter().map(row).collect::<Vec<_>>())
}

/// The tables behind the diagrams.
pub fn tables(folder: &Path) -> String {
    let file = |name: &str| Table::read(&folder.join(name));
    let mut page = String::new();
    if let Some(table) = file("peers_hard.csv") {
        page += "\n### The same in other engines\n\nWhether each did what it should, and how. Only this engine is looked at in \
                 every tick, so the others' energies are not compared.\n\n";
        page += &hard_cases(&table);
    }
    let Some(engines) = file("peers_engines.csv") else { return page };
    page += "\n## Other engines\n\n![Work and precision of four engines](peers.svg)\n\n";
    let version = |row: usize| format!("{} is {}", engines.get(row, "engine"), engines.get(row, "version"));
    page += &(0..engines.len()).map(version).collect::<Vec<_>>().join("; ");
    page += ". All run the same scenes on one thread with sleeping off; the speed below which nothing bounces is as low \
             as each lets it be; Box2D and Rapier count in single precision, as they do by default. Engines take turns in \
             every round.\n";
    if let Some(table) = file("peers_speed.csv") {
        page += "\n### Time\n\nProcessor time of the mean tick in the best round; in brackets that of the median round, and the \
                 median tick by the clock on the wall. Here a heap that has come to rest to the bit is not computed again: the pile of 1000 and the \
                 stack rest before their windows begin, the pyramid of 820 (tick 262) and the pile of 4000 (tick 994) within theirs, the others do not.\n\n";
        page += &speed(&table);
    }
    if let Some(table) = file("peers_snapshots.csv") {
        page += "\n### Saving and restoring\n\n";
        page += &snapshots(&table);
    }
    if let Some(table) = file("peers_rollback.csv") {
        page += "\n### Rollback\n\nHow many ticks can be computed again in a frame of 16.7 ms: going back by 8 ticks once, then each \
                 tick with its state kept as the first time. In brackets going back, and a tick with keeping it, in µs, medians of the \
                 best round. Here a ring of `Rollback` does it, in Box2D its world's image, in Rapier a clone of its sets. No \
                 hash is computed.\n\n";
        page += &rollbacks(&table);
    }
    page
}
