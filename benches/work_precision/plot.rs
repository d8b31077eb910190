//! Diagrams as SVG: panels of curves, and rows of dots. Both axes are logarithmic; colours are those of Okabe and Ito, which
//! colour-blind readers tell apart, and every series has its own mark as well.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::ops::Range;
use std::path::Path;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const FONT: &str = "DejaVu Sans, Verdana, Arial, sans-serif";
const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(225, 225, 225);
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

/// What belongs together: its points, joined where it is a curve.
pub struct Series {
    /// Which colour and mark.
    pub style: usize,
    pub joined: bool,
    pub points: Vec<[f64; 2]>,
}

/// One diagram of a sheet.
pub struct Panel {
    pub title: String,
    pub unit: String,
    pub series: Vec<Series>,
}

/// What a sheet's diagrams have in common.
pub struct Sheet<'a> {
    pub title: &'a str,
    pub x: &'a str,
    pub legend: &'a [(&'a str, usize)],
    pub columns: usize,
    /// The power of ten at which what is below is drawn.
    pub floor: i32,
    /// Whether all diagrams have one range of y.
    pub common: bool,
}

/// A row of dots.
pub struct Row {
    pub label: String,
    /// By style; `None` draws nothing.
    pub values: Vec<Option<f64>>,
}

fn text(size: u32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&INK)
}

/// A power of ten in superior figures.
fn power(exponent: f64) -> String {
    const FIGURES: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent = exponent.round() as i32;
    match exponent {
        0 => return "1".into(),
        1 => return "10".into(),
        2 => return "100".into(),
        _ => {}
    }
    let sign = if exponent < 0 { "⁻" } else { "" };
    let digits = exponent.unsigned_abs().to_string();
    let figures: String = digits.bytes().map(|digit| FIGURES[usize::from(digit - b'0')]).collect();
    format!("10{sign}{figures}")
}

/// A range of exponents with a line at every `step`-th.
struct Decades {
    range: RangedCoordf64,
    from: i32,
    to: i32,
    step: usize,
}

impl Decades {
    fn new(from: i32, to: i32, step: usize, margin: f64) -> Decades {
        Decades { range: (f64::from(from) - margin..f64::from(to) + margin).into(), from, to, step }
    }
}

impl Ranged for Decades {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        (self.from..=self.to).step_by(self.step).map(f64::from).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

impl plotters::coord::ranged1d::ValueFormatter<f64> for Decades {
    fn format(value: &f64) -> String {
        power(*value)
    }
}

/// The mark of a style at a pixel.
fn mark(area: &Area, [x, y]: [i32; 2], style: usize, size: i32) {
    let color = COLORS[style % COLORS.len()];
    let fill = color.filled();
    let polygon = |points: &[[i32; 2]]| {
        let points: Vec<(i32, i32)> = points.iter().map(|p| (x + p[0], y + p[1])).collect();
        area.draw(&Polygon::new(points, fill)).expect("drawn in memory");
    };
    let s = size;
    match style % 7 {
        0 => area.draw(&Circle::new((x, y), s, fill)).expect("drawn in memory"),
        1 => polygon(&[[-s, -s], [s, -s], [s, s], [-s, s]]),
        2 => polygon(&[[0, -s - 1], [s + 1, s], [-s - 1, s]]),
        3 => polygon(&[[0, -s - 1], [s + 1, 0], [0, s + 1], [-s - 1, 0]]),
        4 => polygon(&[[0, s + 1], [s + 1, -s], [-s - 1, -s]]),
        5 => {
            for (a, b) in [([-s, -s], [s, s]), ([-s, s], [s, -s])] {
                let line = vec![(x + a[0], y + a[1]), (x + b[0], y + b[1])];
                area.draw(&PathElement::new(line, color.stroke_width(2))).expect("drawn in memory");
            }
        }
        _ => {
            area.draw(&Circle::new((x, y), s + 2, color.stroke_width(2))).expect("drawn in memory");
        }
    }
}

/// Title and legend in the first rows of a drawing; gives back where they end.
fn head(area: &Area, title: &str, legend: &[(&str, usize)]) -> i32 {
    area.draw(&Text::new(title, (14, 12), text(18))).expect("drawn in memory");
    let mut x = 20;
    for (name, style) in legend {
        mark(area, [x, 50], *style, 4);
        area.draw(&Text::new(*name, (x + 10, 43), text(13))).expect("drawn in memory");
        x += 36 + 7 * name.chars().count() as i32;
    }
    66
}

/// The exponents between which values lie.
fn span(values: impl Iterator<Item = f64>) -> [i32; 2] {
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
    [low.log10().floor() as i32, (high.log10().ceil() as i32).max(low.log10().floor() as i32 + 1)]
}

fn panel(area: &Area, panel: &Panel, [left, right]: [i32; 2], [low, high]: [i32; 2]) {
    area.draw(&Text::new(panel.title.as_str(), (52, 6), text(14))).expect("drawn in memory");
    area.draw(&Text::new(panel.unit.as_str(), (52, 25), text(12))).expect("drawn in memory");
    let step = if high - low > 7 { 2 } else { 1 };
    let inner = area.clone().margin(42, 0, 0, 14);
    let mut chart = ChartBuilder::on(&inner)
        .x_label_area_size(24)
        .y_label_area_size(46)
        .build_cartesian_2d(Decades::new(left, right, 1, 0.05), Decades::new(low, high, step, 0.2))
        .expect("drawn in memory");
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(text(11))
        .draw()
        .expect("drawn in memory");
    let place = |[x, y]: [f64; 2]| (x.log10(), y.max(10f64.powi(low)).log10());
    for series in &panel.series {
        let color = COLORS[series.style % COLORS.len()];
        if series.joined {
            let line = series.points.iter().map(|&point| place(point));
            chart.draw_series(LineSeries::new(line, color.stroke_width(2))).expect("drawn in memory");
        }
    }
    for series in &panel.series {
        for &point in &series.points {
            let (x, y) = chart.backend_coord(&place(point));
            let (left, top) = area.get_base_pixel();
            mark(area, [x - left, y - top], series.style, 3);
        }
    }
}

/// Diagrams side by side, under one title and legend.
pub fn sheet(path: &Path, sheet: &Sheet, panels: &[Panel]) {
    let rows = panels.len().div_ceil(sheet.columns);
    // A single diagram is as wide as its legend.
    let size = ((340 * sheet.columns as u32).max(520), 66 + 240 * rows as u32 + 34);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE).expect("drawn in memory");
    let below = head(&root, sheet.title, sheet.legend);
    let (_, body) = root.split_vertically(below);
    let (body, foot) = body.split_vertically(240 * rows as u32);
    let points = |panels: &[Panel]| -> Vec<[f64; 2]> {
        let clip = |&[x, y]: &[f64; 2]| [x, y.max(10f64.powi(sheet.floor))];
        panels.iter().flat_map(|p| &p.series).flat_map(|s| &s.points).map(clip).collect()
    };
    let all = points(panels);
    for (area, one) in body.split_evenly((rows, sheet.columns)).iter().zip(panels) {
        let own = points(std::slice::from_ref(one));
        let errors = span((if sheet.common { &all } else { &own }).iter().map(|p| p[1]));
        panel(area, one, span(own.iter().map(|p| p[0])), errors);
    }
    foot.draw(&Text::new(sheet.x, (60, 8), text(13))).expect("drawn in memory");
    root.present().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// Rows of dots on one scale.
pub fn dots(path: &Path, title: &str, x: &str, legend: &[(&str, usize)], rows: &[Row], floor: i32) {
    let (label, pitch, wide) = (300, 28, 1000);
    let size = (wide, 66 + pitch * rows.len() as u32 + 60);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE).expect("drawn in memory");
    let top = head(&root, title, legend);
    let values = rows.iter().flat_map(|row| row.values.iter().flatten());
    let [low, high] = span(values.map(|v| v.max(10f64.powi(floor))));
    let bottom = top + pitch as i32 * rows.len() as i32;
    let at = |value: f64| {
        let part = (value.max(10f64.powi(floor)).log10() - f64::from(low)) / f64::from(high - low);
        label + 10 + (part * f64::from(wide as i32 - label - 40)) as i32
    };
    for exponent in low..=high {
        let x = at(10f64.powi(exponent));
        root.draw(&PathElement::new(vec![(x, top), (x, bottom)], GRID)).expect("drawn in memory");
        if high - low <= 8 || (exponent - low) % 2 == 0 {
            let middle = text(11).pos(plotters::style::text_anchor::Pos::new(
                plotters::style::text_anchor::HPos::Center,
                plotters::style::text_anchor::VPos::Top,
            ));
            root.draw(&Text::new(power(f64::from(exponent)), (x, bottom + 6), middle)).expect("drawn in memory");
        }
    }
    for (k, row) in rows.iter().enumerate() {
        let y = top + pitch as i32 * k as i32 + pitch as i32 / 2;
        root.draw(&PathElement::new(vec![(label + 10, y), (wide as i32 - 30, y)], GRID)).expect("drawn in memory");
        root.draw(&Text::new(row.label.as_str(), (14, y - 8), text(13))).expect("drawn in memory");
        // The first series is drawn last, on top.
        for (style, value) in row.values.iter().enumerate().rev() {
            if let Some(value) = value {
                // Equal values lie beside each other.
                mark(&root, [at(*value), y + 4 * style as i32 - 6], style, 4);
            }
        }
    }
    root.draw(&Text::new(x, (label + 10, bottom + 28), text(13))).expect("drawn in memory");
    root.present().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
