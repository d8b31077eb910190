//! The work-precision diagrams.

use crate::exact::CASES;
use crate::grid::{Point, RATES, SUBSTEPS};
use crate::plot::{Panel, Series, Sheet, sheet};
use crate::stage::Setting;
use std::path::Path;

/// Files, titles, and the names of the first case and of the one after the last.
const SHEETS: [(&str, &str, &str); 4] = [
    ("motion", "Motion", "throw"),
    ("friction", "Friction", "slide"),
    ("impacts", "Impacts", "bounce-disc"),
    ("rest", "Loads", "stack"),
];

fn panel(case: usize, points: &[Point]) -> Panel {
    let of = |setting: Setting| points.iter().find(|p| p.case == case && p.setting == setting);
    let place = |setting| of(setting).map(|point| [point.work(), point.error]);
    let curve = |(style, &substeps): (usize, &u32)| Series {
        style,
        joined: true,
        points: RATES.iter().filter_map(|&rate| place(Setting { rate, substeps })).collect(),
    };
    let mut series: Vec<Series> = SUBSTEPS.iter().enumerate().map(curve).collect();
    series.push(Series { style: 6, joined: false, points: place(Setting::default()).into_iter().collect() });
    let errors = |curve: &Series| curve.points.iter().map(|p| p[1]).collect::<Vec<f64>>();
    let alike = series[1..SUBSTEPS.len()].iter().all(|curve| errors(curve) == errors(&series[0]));
    let note = if alike { "; alike with any substeps" } else { "" };
    Panel { title: CASES[case].title.into(), unit: format!("error: {}{note}", CASES[case].error), series }
}

/// Draws all sheets into a folder.
pub fn work_precision(folder: &Path, points: &[Point]) {
    let begins = |name: &str| CASES.iter().position(|case| case.name == name).expect("a case");
    let names = SUBSTEPS.map(|n| if n == 1 { "1 substep".into() } else { format!("{n} substeps") });
    let mut legend: Vec<(&str, usize)> = names.iter().enumerate().map(|(style, name)| (name.as_str(), style)).collect();
    legend.push(("default: 60 ticks/s, 10 substeps", 6));
    for (k, (file, title, first)) in SHEETS.iter().enumerate() {
        let end = SHEETS.get(k + 1).map_or(CASES.len(), |next| begins(next.2));
        let panels: Vec<Panel> = (begins(first)..end).map(|case| panel(case, points)).collect();
        let title = format!(
            "{title}: error against time. Lower left is better; curves go from 30 over 60, 120, 240 to 480 ticks/s"
        );
        let style = Sheet {
            title: &title,
            x: "µs of processor time per 1/60 s of the scene: at 60 ticks/s, per tick",
            legend: &legend,
            columns: 3,
            floor: -14,
            common: true,
        };
        sheet(&folder.join(format!("{file}.svg")), &style, &panels);
    }
}
