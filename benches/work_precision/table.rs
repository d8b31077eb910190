//! Tables: comma-separated values read back, and Markdown.

use std::path::Path;

/// The rows of a file of comma-separated values, its head apart.
pub struct Table {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The values of a line; those with commas in them are in quotes, and none has a quote in it.
fn split(line: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => values.push(String::new()),
            _ => values.last_mut().expect("one at least").push(letter),
        }
    }
    values
}

impl Table {
    /// `None` if there is no such file.
    pub fn read(path: &Path) -> Option<Table> {
        let text = std::fs::read_to_string(path).ok()?;
        let mut lines = text.lines().map(split);
        let head = lines.next()?;
        Some(Table { head, rows: lines.collect() })
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn get(&self, row: usize, column: &str) -> &str {
        let at = self.head.iter().position(|name| name == column);
        &self.rows[row][at.unwrap_or_else(|| panic!("no column {column}"))]
    }

    /// A number; `None` where the field is empty.
    pub fn number(&self, row: usize, column: &str) -> Option<f64> {
        let text = self.get(row, column);
        (!text.is_empty()).then(|| text.parse().unwrap_or_else(|_| panic!("{column} is {text}, no number")))
    }

    /// The different values of a column, in their order.
    pub fn distinct(&self, column: &str) -> Vec<String> {
        let mut values: Vec<String> = Vec::new();
        for row in 0..self.len() {
            let value = self.get(row, column);
            if values.iter().all(|v| v != value) {
                values.push(value.into());
            }
        }
        values
    }

    /// The first row that has these values.
    pub fn find(&self, keys: &[(&str, &str)]) -> Option<usize> {
        (0..self.len()).find(|&row| keys.iter().all(|(column, value)| self.get(row, column) == *value))
    }
}

/// A Markdown table.
pub fn markdown(head: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &mut dyn Iterator<Item = &str>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
    let mut text = line(&mut head.iter().copied());
    text += &line(&mut head.iter().map(|_| "---"));
    for row in rows {
        text += &line(&mut row.iter().map(String::as_str));
    }
    text
}

/// A length in the unit that reads best.
pub fn length(metres: f64) -> String {
    match metres.abs() {
        0.0 => "0".into(),
        v if v < 9.95e-7 => format!("{metres:.0e} m"),
        v if v < 9.95e-4 => format!("{} µm", figures(metres * 1e6)),
        v if v < 0.995 => format!("{} mm", figures(metres * 1e3)),
        _ => format!("{} m", figures(metres)),
    }
}

/// Two figures at least.
pub fn figures(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if v < 9.95 => format!("{value:.1}"),
        v if v < 1e5 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

/// An error: two figures and a power of ten.
pub fn error(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else if value >= 0.1 {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}
