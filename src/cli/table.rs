//! What the row of a body or an event looks like, as CSV and as JSON. All numbers are exact or rounded from exact ones.

use std::io::{self, Write};
use tamias2d::num::{Decimal, Quantity};
use tamias2d::scene::Script;
use tamias2d::{Angle, Body, ColliderId, Collision, Event};

/// How rows are written.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    /// A header and a line per row.
    Csv,
    /// A list of objects, one on each line.
    Json,
}

/// What the rows are.
#[derive(Clone, Copy)]
pub(crate) enum Columns {
    /// With whether they sleep, in a world with sleeping.
    Bodies {
        sleeping: bool,
    },
    Events,
    Collisions,
}

/// Writes rows.
pub(crate) struct Table<W> {
    out: W,
    format: Format,
    rows: u64,
    tick_rate: u32,
    sleeping: bool,
}

impl<W: Write> Table<W> {
    pub(crate) fn new(mut out: W, format: Format, columns: Columns, tick_rate: u32) -> io::Result<Self> {
        match (format, columns) {
            (Format::Csv, Columns::Bodies { sleeping }) => {
                let asleep = if sleeping { ",asleep" } else { "" };
                writeln!(out, "tick,time,body,x,y,angle,turns,vx,vy,omega{asleep}")?;
            }
            (Format::Csv, Columns::Events) => writeln!(out, "tick,event,body_a,collider_a,body_b,collider_b")?,
            (Format::Csv, Columns::Collisions) => {
                writeln!(out, "tick,time,order,body_a,collider_a,body_b,collider_b,x,y,nx,ny,jx,jy")?;
            }
            (Format::Json, _) => write!(out, "[")?,
        }
        let sleeping = matches!(columns, Columns::Bodies { sleeping: true });
        Ok(Table { out, format, rows: 0, tick_rate, sleeping })
    }

    pub(crate) fn row(&mut self, tick: u64, label: &str, body: &Body<'_>) -> io::Result<()> {
        let (p, v) = (body.position(), body.velocity());
        let (time, angle) = (time(tick, self.tick_rate), phi(body.angle()));
        let (turns, omega) = (body.angle(), body.angular_velocity());
        let (x, y, vx, vy) = (p.x, p.y, v.x, v.y);
        match self.format {
            Format::Csv => {
                let label = csv_field(label);
                let asleep = if self.sleeping { format!(",{}", !body.is_awake()) } else { String::new() };
                writeln!(self.out, "{tick},{time},{label},{x},{y},{angle},{turns},{vx},{vy},{omega}{asleep}")?;
            }
            Format::Json => {
                let comma = if self.rows == 0 { "" } else { "," };
                let label = super::quoted(label);
                let asleep = if self.sleeping { format!(",\"asleep\":{}", !body.is_awake()) } else { String::new() };
                write!(
                    self.out,
                    "{comma}\n{{\"tick\":{tick},\"time\":{time},\"body\":{label},\"x\":{x},\"y\":{y},\"angle\":{angle},\
                     \"turns\":{turns},\"vx\":{vx},\"vy\":{vy},\"omega\":{omega}{asleep}}}"
                )?;
            }
        }
        self.rows += 1;
        Ok(())
    }

    pub(crate) fn collision(&mut self, tick: u64, collision: &Collision, script: &Script<'_>) -> io::Result<()> {
        let Collision { order, point, normal, impulse, .. } = collision;
        // t_c since tick 0, to 48 fraction bits.
        let began = (i128::from(tick.saturating_sub(1)) << 48) / i128::from(self.tick_rate);
        let time = Decimal { bits: began + i128::from(collision.time.to_bits()), frac: 48 };
        let time = format!("{time:.15}");
        let ((body_a, a), (body_b, b)) = (place(collision.a, script), place(collision.b, script));
        let [nx, ny] = normal.map(|n| Decimal { bits: n.into(), frac: 30 });
        let (x, y, jx, jy) = (point.x, point.y, impulse.x, impulse.y);
        match self.format {
            Format::Csv => {
                let (body_a, body_b) = (csv_field(body_a), csv_field(body_b));
                writeln!(self.out, "{tick},{time},{order},{body_a},{a},{body_b},{b},{x},{y},{nx},{ny},{jx},{jy}")?;
            }
            Format::Json => {
                let comma = if self.rows == 0 { "" } else { "," };
                let (body_a, body_b) = (super::quoted(body_a), super::quoted(body_b));
                write!(
                    self.out,
                    "{comma}\n{{\"tick\":{tick},\"time\":{time},\"order\":{order},\"body_a\":{body_a},\"collider_a\":{a},\
                     \"body_b\":{body_b},\"collider_b\":{b},\"x\":{x},\"y\":{y},\"nx\":{nx},\"ny\":{ny},\
                     \"jx\":{jx},\"jy\":{jy}}}"
                )?;
            }
        }
        self.rows += 1;
        Ok(())
    }

    pub(crate) fn event(&mut self, tick: u64, event: &Event, script: &Script<'_>) -> io::Result<()> {
        let (kind, (body_a, a), (body_b, b)) = (event.kind, place(event.a, script), place(event.b, script));
        match self.format {
            Format::Csv => {
                let (body_a, body_b) = (csv_field(body_a), csv_field(body_b));
                writeln!(self.out, "{tick},{kind},{body_a},{a},{body_b},{b}")?;
            }
            Format::Json => {
                let comma = if self.rows == 0 { "" } else { "," };
                let (body_a, body_b) = (super::quoted(body_a), super::quoted(body_b));
                write!(
                    self.out,
                    "{comma}\n{{\"tick\":{tick},\"event\":\"{kind}\",\"body_a\":{body_a},\"collider_a\":{a},\
                     \"body_b\":{body_b},\"collider_b\":{b}}}"
                )?;
            }
        }
        self.rows += 1;
        Ok(())
    }

    pub(crate) fn finish(mut self) -> io::Result<()> {
        if self.format == Format::Json {
            writeln!(self.out, "\n]")?;
        }
        self.out.flush()
    }
}

/// A collider as its body and its index there. The script created every collider of its world.
fn place<'s>(id: ColliderId, script: &'s Script<'_>) -> (&'s str, u32) {
    script.collider(id).map_or(("", 0), |(body, index)| (script.label(body), index))
}

/// The seconds after `tick` ticks, rounded to 15 decimals.
fn time(tick: u64, tick_rate: u32) -> String {
    const SCALE: u128 = 1_000_000_000_000_000;
    let rate = u128::from(tick_rate);
    let scaled = (u128::from(tick) * SCALE * 2 + rate) / (2 * rate);
    format!("{}.{:015}", scaled / SCALE, scaled % SCALE)
}

/// φ in [0, 2π), to 15 decimals, rounded down so that it never reads 2π.
fn phi(angle: Angle) -> String {
    const TAU_Q60: u128 = 7_244_019_458_077_122_842;
    const SCALE: u128 = 1_000_000_000_000_000;
    // 48 + 60 fraction bits; the whole part is below 7, the scaled fraction below 2^60 · 2^50.
    let product = (u128::from(angle.fraction()) * TAU_Q60) >> 48;
    let (whole, fraction) = (product >> 60, product & ((1 << 60) - 1));
    format!("{whole}.{:015}", (fraction * SCALE) >> 60)
}

/// A CSV field, quoted where it must be.
fn csv_field(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

/// A number rounded to some decimals, for summaries.
pub(crate) fn rounded(value: impl Quantity, decimals: usize) -> String {
    let decimal: Decimal = value.decimal();
    format!("{decimal:.decimals$}")
}
