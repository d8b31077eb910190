//! Where two pieces of evidence part: tick, stage, object, field, both values.

use super::evidence::Evidence;
use crate::num::Decimal;
use crate::store::{Cell, DecodeError, Kind, Sheet, Spot};
use crate::world::Stage;
use core::fmt;

/// At most so many fields are named; how many there are more is counted up to ten times as many.
const NAMED: usize = 1000;

/// A value of a field, as memory has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldValue {
    /// Exactly, with all digits.
    pub decimal: String,
    /// The raw bits, as many hexadecimal digits as the field has.
    pub bits: String,
    /// The unit; empty for a number.
    pub unit: String,
}

impl FieldValue {
    fn new(cell: &Cell) -> FieldValue {
        let decimal = Decimal { bits: cell.value, frac: cell.frac.into() }.to_string();
        let width = cell.width.saturating_mul(2).saturating_add(2);
        FieldValue { decimal, bits: format!("{:#0width$x}", cell.bits), unit: cell.unit.clone() }
    }
}

impl fmt::Display for FieldValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FieldValue { decimal, bits, unit } = self;
        let space = if unit.is_empty() { "" } else { " " };
        write!(f, "{decimal}{space}{unit} (bits {bits})")
    }
}

/// A field that differs. A side without a value does not have the object, or the object not the field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The table: which part of memory.
    pub table: String,
    /// Whose field, in words: a body, a collider, the contact of two, with slots and generations.
    pub object: String,
    /// The field; empty if one side does not have the object.
    pub field: String,
    /// The value of the first side.
    pub a: Option<FieldValue>,
    /// The value of the second.
    pub b: Option<FieldValue>,
    one_bit: bool,
}

impl Finding {
    /// Whether both values differ in a single bit, as a fault in memory makes them.
    pub fn is_one_bit(&self) -> bool {
        self.one_bit
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Finding { table, object, field, a, b, .. } = self;
        if field.is_empty() {
            let who = if a.is_some() { "A" } else { "B" };
            return write!(f, "{table}: {object} is there in {who} only");
        }
        let show = |value: &Option<FieldValue>| value.as_ref().map_or("absent".into(), |value| value.to_string());
        write!(f, "{table}: {object}: {field}: {} and {}", show(a), show(b))
    }
}

/// The first moment of a tick at which two pieces of evidence differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The tick, as the world counts them after its step.
    pub tick: u64,
    /// The first stage after which they differ; all before is equal, to the bit.
    pub stage: Stage,
    /// Of [`Stage::Solve`] the substep, from 1 on; 0 for the stage itself.
    pub substep: u32,
    /// The fields that differ then, the likeliest causes first: what the stage does not change, then what differs in a single
    /// bit; the rest may follow from them.
    pub findings: Vec<Finding>,
    /// How many of them the stage does not change: causes; 0 if all of them are what the stage makes.
    pub causes: usize,
}

impl Evidence {
    /// The first moment at which two pieces of evidence of the same tick differ; `None` if they agree throughout.
    ///
    /// Errors: evidence that was not made by this engine.
    pub fn first_difference(&self, other: &Evidence) -> Result<Option<Divergence>, DecodeError> {
        for at in 0.. {
            let (stage, substep) = match (self.moment(at), other.moment(at)) {
                (None, None) => return Ok(None),
                // They went different ways, which shows in what the moment before it left; so this is for what is made by hand.
                (Some(moment), _) | (None, Some(moment)) => moment,
            };
            if self.agrees(other, at) {
                continue;
            }
            let mut findings = Vec::new();
            let (a, b) = (self.sheets(at)?, other.sheets(at)?);
            let (ours, theirs) = (self.changed(at)?, other.changed(at)?);
            let names = (self.names(at)?, other.names(at)?);
            for (digest, sheet) in &a {
                let theirs = b.iter().find(|(_, theirs)| theirs.name == sheet.name);
                if theirs.is_none_or(|(theirs, _)| theirs != digest) {
                    compare(sheet, theirs.map(|(_, sheet)| sheet), [&names.0, &names.1], &mut findings);
                }
            }
            if substep > 0 {
                self.behind(other, at, &mut findings)?;
            }
            // What the stage changes, it changes on both sides.
            let made = |finding: &Finding| ours.contains(&finding.table) && theirs.contains(&finding.table);
            findings.sort_by_key(|finding| (made(finding), !finding.is_one_bit()));
            let causes = findings.iter().filter(|finding| !made(finding)).count();
            return Ok(Some(Divergence { tick: self.tick(), stage, substep, findings, causes }));
        }
        Ok(None)
    }

    /// A substep shows what substeps change. What lies behind it, and the stage does not change, is looked at when it has ended.
    fn behind(&self, other: &Evidence, substep: usize, findings: &mut Vec<Finding>) -> Result<(), DecodeError> {
        let Some(end) = (substep..self.count().min(other.count())).find(|&at| self.is_whole(at)) else { return Ok(()) };
        let (a, b, seen) = (self.sheets(end)?, other.sheets(end)?, self.titles(substep)?);
        let (ours, theirs) = (self.changed(end)?, other.changed(end)?);
        for (_, sheet) in &a {
            let made = ours.contains(&sheet.name) && theirs.contains(&sheet.name);
            if !made && !seen.iter().any(|(_, seen)| *seen == sheet.name) {
                let theirs = b.iter().find(|(_, theirs)| theirs.name == sheet.name);
                compare(sheet, theirs.map(|(_, sheet)| sheet), [&a, &b], findings);
            }
        }
        Ok(())
    }

    /// The names of tables that a moment has changed since they were last looked at, or that are new.
    fn changed(&self, at: usize) -> Result<Vec<String>, DecodeError> {
        let mut changed = Vec::new();
        let mut earlier = Vec::new();
        for before in (0..at).rev() {
            // Further back than the last whole moment nothing was looked at last.
            earlier.extend(self.titles(before)?);
            if self.is_whole(before) {
                break;
            }
        }
        for (digest, name) in self.titles(at)? {
            let last = earlier.iter().find(|(_, was)| *was == name);
            if at > 0 && last.is_none_or(|(was, _)| *was != digest) {
                changed.push(name);
            }
        }
        Ok(changed)
    }

    /// Whether all tables belong to a moment, not only those of a substep.
    fn is_whole(&self, at: usize) -> bool {
        self.moment(at).is_none_or(|(_, substep)| substep == 0)
    }

    /// The tables by which objects are named at a moment: those of the last whole one.
    fn names(&self, at: usize) -> Result<Vec<(u64, Sheet<'_>)>, DecodeError> {
        let whole = (0..=at).rev().find(|&at| self.is_whole(at)).unwrap_or(0);
        self.sheets(whole)
    }
}

/// The tables by which objects are named, of either side.
type Sides<'s> = [&'s [(u64, Sheet<'s>)]; 2];

fn compare(a: &Sheet<'_>, b: Option<&Sheet<'_>>, sides: Sides<'_>, findings: &mut Vec<Finding>) {
    let room = NAMED.saturating_sub(findings.len());
    let Some(b) = b else { return };
    for Spot { rows, field, cells } in a.differences(b, room) {
        let (side, sheet, row) = match rows {
            [Some(row), _] => (0, a, row),
            [None, row] => (1, b, row.unwrap_or(0)),
        };
        let object = name(sheet, row, sides[side]);
        let absent = |row: Option<usize>| {
            row.map(|row| FieldValue { decimal: row.to_string(), bits: String::new(), unit: String::new() })
        };
        let one_bit = matches!(&cells, [Some(a), Some(b)] if (a.bits ^ b.bits).is_power_of_two());
        let [a, b] =
            if field.is_empty() { rows.map(absent) } else { cells.map(|cell| cell.as_ref().map(FieldValue::new)) };
        findings.push(Finding { table: sheet.name.clone(), object, field, a, b, one_bit });
    }
}

/// What a row is of, in words.
fn name(sheet: &Sheet<'_>, row: usize, tables: &[(u64, Sheet<'_>)]) -> String {
    let table = |name: &str| tables.iter().map(|(_, sheet)| sheet).find(|sheet| sheet.name == name);
    let number = |sheet: Option<&Sheet<'_>>, row: u128, field: &str| {
        let row = usize::try_from(row).ok()?;
        sheet?.cell(row, field).map(|cell| cell.bits)
    };
    let in_slot = |kind: &str, names: &str, slot: u128| match number(table(names), slot, "generation") {
        Some(generation) => format!("{kind} {slot}v{generation}"),
        None => format!("{kind} {slot}"),
    };
    let body = |slot: u128| {
        let shown = in_slot("body", "bodies", slot);
        match number(table("bodies"), slot, "user_data") {
            Some(data) if data != 0 => format!("{shown} (user data {data})"),
            _ => shown,
        }
    };
    let collider = |slot: u128| {
        let shown = in_slot("collider", "colliders", slot);
        match number(table("colliders"), slot, "body") {
            Some(of) => format!("{shown} of {}", body(of)),
            None => shown,
        }
    };
    let key = sheet.key(row);
    match (sheet.kind, key.as_slice()) {
        (Kind::World, _) => "the world".into(),
        (Kind::Body, _) => body(row as u128),
        (Kind::Collider, _) => collider(row as u128),
        (Kind::Attractor, _) => in_slot("attractor", "attractors", row as u128),
        (Kind::Form, _) => format!("form {row}"),
        (Kind::Contact, [a, _, b, _]) | (Kind::Pair, [a, b]) => format!("{} and {}", collider(*a), collider(*b)),
        (Kind::OfBody, [slot]) => body(*slot),
        _ => format!("number {row}"),
    }
}
