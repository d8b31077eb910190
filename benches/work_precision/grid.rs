//! Error and cost of every case with every setting.

use crate::clock::{Cost, time};
use crate::exact::{CASES, Case};
use crate::stage::{Setting, Stage, Trial};
use crate::table::Table;
use std::fmt::Write;

/// Substeps of the curves.
pub const SUBSTEPS: [u32; 5] = [1, 2, 4, 8, 16];
/// Ticks per second along a curve.
pub const RATES: [u32; 5] = [30, 60, 120, 240, 480];

/// One case with one setting.
pub struct Point {
    pub case: usize,
    pub setting: Setting,
    pub error: f64,
    /// Nanoseconds a tick.
    pub cost: Cost,
}

impl Point {
    /// Microseconds for a sixtieth of a second: what a tick costs at 60 ticks per second, and comparable at others.
    pub fn work(&self) -> f64 {
        self.cost.best * 1e-3 * f64::from(self.setting.rate) / 60.0
    }
}

/// The settings: the curves', and the default.
pub fn settings() -> Vec<Setting> {
    let curves = SUBSTEPS.iter().flat_map(|&substeps| RATES.iter().map(move |&rate| Setting { rate, substeps }));
    curves.chain([Setting::default()]).collect()
}

/// Nanoseconds a tick; short runs are repeated until they take a millisecond together.
fn cost(case: &Case, setting: Setting) -> f64 {
    let (start, ticks) = (Stage::new(&(case.scene)(), setting), case.ticks(setting));
    let (mut spent, mut runs) = (0.0, 0u64);
    while spent < 1e6 {
        let mut stage = start.clone();
        spent += time(|| stage.run(ticks));
        runs += 1;
    }
    spent / (runs * ticks) as f64
}

/// Measures all; the settings of a case take turns in every round.
pub fn measure(rounds: usize) -> Vec<Point> {
    let settings = settings();
    let mut points = Vec::new();
    for (at, case) in CASES.iter().enumerate() {
        let mut costs = vec![Vec::new(); settings.len()];
        for round in 0..rounds {
            for k in 0..settings.len() {
                let k = if round % 2 == 0 { k } else { settings.len() - 1 - k };
                costs[k].push(cost(case, settings[k]));
            }
        }
        for (costs, &setting) in costs.iter().zip(&settings) {
            points.push(Point { case: at, setting, error: case.measure(setting), cost: Cost::of(costs) });
        }
        let last = &points[points.len() - 1];
        eprintln!("{}: {:.1e} at {:.2} µs a tick", case.name, last.error, last.cost.best * 1e-3);
    }
    points
}

/// As a table of comma-separated values.
pub fn csv(points: &[Point]) -> String {
    let mut text = String::from("case,error_of,ticks_per_second,substeps,error,best_us_per_tick,median_us_per_tick\n");
    for point in points {
        let (case, Setting { rate, substeps }) = (&CASES[point.case], point.setting);
        let (best, median) = (point.cost.best * 1e-3, point.cost.median * 1e-3);
        let _ = writeln!(
            text,
            "{},\"{}\",{rate},{substeps},{:.3e},{best:.4},{median:.4}",
            case.name, case.error, point.error
        );
    }
    text
}

/// The same, read back.
pub fn read(table: &Table) -> Vec<Point> {
    let point = |row: usize| {
        let number = |column| table.number(row, column).expect("every field has a number");
        let case = CASES.iter().position(|case| case.name == table.get(row, "case"))?;
        let setting = Setting { rate: number("ticks_per_second") as u32, substeps: number("substeps") as u32 };
        let cost = Cost { best: number("best_us_per_tick") * 1e3, median: number("median_us_per_tick") * 1e3 };
        Some(Point { case, setting, error: number("error"), cost })
    };
    (0..table.len()).filter_map(point).collect()
}
