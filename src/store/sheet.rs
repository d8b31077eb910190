//! Tables of fields, read and compared.
//!
//! | bytes | what |
//! |---|---|
//! | text | the table's name: a byte of length, then UTF-8 |
//! | 1 | what its rows are, see [`Kind`] |
//! | 1 | the number of layouts |
//! | … | for each layout the number of its fields, `u16`, and for each field its name (text), its form (a byte: the number of bytes 1, 2, 4, 8 or 16, with 0x80 if they are two's complement), the number of its fraction bits (a byte) and its unit (text) |
//! | 4 | the number of rows, `u32` |
//! | … | for each row the number of its layout (a byte), then its fields' bits, little-endian |

use super::codec::{DecodeError, Reader};
use super::show::{Kind, SIGNED};
use std::collections::BTreeMap;

/// What a field is.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Field {
    name: String,
    width: usize,
    signed: bool,
    frac: u8,
    unit: String,
}

/// The value of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    /// The bits, without sign.
    pub(crate) bits: u128,
    /// The same as the number that they are; what is above `i128::MAX` is limited to that.
    pub(crate) value: i128,
    /// How many bytes it has.
    pub(crate) width: usize,
    pub(crate) frac: u8,
    pub(crate) unit: String,
}

/// A place in which two tables differ. `None`: that side has no such row or field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Spot {
    /// The rows, of either side.
    pub(crate) rows: [Option<usize>; 2],
    /// The field; empty for a whole row.
    pub(crate) field: String,
    pub(crate) cells: [Option<Cell>; 2],
}

/// Where a row's bits begin, and its layout.
struct Row {
    layout: u8,
    at: u32,
}

/// A table, read from bytes.
pub(crate) struct Sheet<'b> {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    layouts: Vec<Vec<Field>>,
    rows: Vec<Row>,
    bytes: &'b [u8],
}

/// Reads a short text.
pub(crate) fn take_text(reader: &mut Reader<'_>, field: &'static str) -> Result<String, DecodeError> {
    let offset = reader.offset();
    let length = reader.take::<u8>(field)?;
    let bytes = reader.take_bytes(length.into(), field)?.to_vec();
    String::from_utf8(bytes).map_err(|_| reader.invalid(offset, field, "is no UTF-8"))
}

impl<'b> Sheet<'b> {
    /// The memory used is bounded by the bytes given.
    pub(crate) fn read(bytes: &'b [u8]) -> Result<Sheet<'b>, DecodeError> {
        let mut reader = Reader::new(bytes);
        let name = take_text(&mut reader, "table's name")?;
        let offset = reader.offset();
        let kind = reader.take::<u8>("kind of rows")?;
        let kind = Kind::ALL.get(kind as usize).copied();
        let kind = kind.ok_or(reader.invalid(offset, "kind of rows", "has a value that is none"))?;
        let mut layouts = Vec::new();
        for _ in 0..reader.take::<u8>("layouts")? {
            layouts.push(layout(&mut reader)?);
        }
        let offset = reader.offset();
        let count = reader.take::<u32>("rows")?;
        let mut rows = Vec::new();
        for _ in 0..count {
            let layout = reader.take::<u8>("row's layout")?;
            let fields = layouts.get(layout as usize);
            let fields = fields.ok_or(reader.invalid(offset, "row's layout", "is none of the table's"))?;
            let at = reader.offset() as u32;
            reader.take_bytes(width(fields), "row")?;
            rows.push(Row { layout, at });
        }
        reader.finish()?;
        Ok(Sheet { name, kind, layouts, rows, bytes })
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    fn fields(&self, row: usize) -> &[Field] {
        self.rows.get(row).map_or(&[], |row| &self.layouts[row.layout as usize])
    }

    fn bits(&self, row: usize) -> &[u8] {
        let from = self.rows.get(row).map_or(&[][..], |row| &self.bytes[row.at as usize..]);
        &from[..width(self.fields(row))]
    }

    /// The fields of a row with their values.
    fn cells(&self, row: usize) -> impl Iterator<Item = (&str, Cell)> + '_ {
        let fields = self.fields(row);
        let mut bits = self.bits(row);
        fields.iter().map(move |field| {
            let (own, rest) = bits.split_at(field.width);
            bits = rest;
            let mut bytes = [0; 16];
            bytes[..field.width].copy_from_slice(own);
            let unsigned = u128::from_le_bytes(bytes);
            let unused = (16u32.saturating_sub(field.width as u32)).saturating_mul(8);
            let signed = (unsigned << unused) as i128 >> unused;
            let value = if field.signed { signed } else { i128::try_from(unsigned).unwrap_or(i128::MAX) };
            let cell = Cell { bits: unsigned, value, width: field.width, frac: field.frac, unit: field.unit.clone() };
            (field.name.as_str(), cell)
        })
    }

    /// The value of a field of a row.
    pub(crate) fn cell(&self, row: usize, name: &str) -> Option<Cell> {
        self.cells(row).find(|(field, _)| *field == name).map(|(_, cell)| cell)
    }

    /// The first fields of a row, those that say what it is of.
    pub(crate) fn key(&self, row: usize) -> Vec<u128> {
        self.cells(row).take(self.kind.keys()).map(|(_, cell)| cell.bits).collect()
    }

    /// Where another table of the same name differs, in order; at most `most` places.
    pub(crate) fn differences(&self, other: &Sheet<'_>, most: usize) -> Vec<Spot> {
        let mut spots = Vec::new();
        for rows in self.matched(other) {
            if spots.len() >= most {
                break;
            }
            match rows {
                [Some(a), Some(b)] => self.compare([a, b], other, &mut spots),
                _ => spots.push(Spot { rows, field: String::new(), cells: [None, None] }),
            }
        }
        spots.truncate(most);
        spots
    }

    /// Which row of either side belongs to which. Where as many rows are of other things on both sides as one fault in memory
    /// could make so, rows go by their order, so that the fault itself is named; else by what they are of.
    fn matched(&self, other: &Sheet<'_>) -> Vec<[Option<usize>; 2]> {
        let keyed = self.kind.keys() > 0;
        let keys = |sheet: &Sheet<'_>| (0..sheet.len()).map(|row| sheet.key(row)).collect::<Vec<_>>();
        let (a, b) = if keyed { (keys(self), keys(other)) } else { (Vec::new(), Vec::new()) };
        let strange = a.iter().zip(&b).filter(|(a, b)| a != b).count();
        let in_order = |length: usize| {
            (0..length).map(|row| [(row < self.len()).then_some(row), (row < other.len()).then_some(row)])
        };
        if !keyed || self.len() == other.len() && strange <= 1 {
            return in_order(self.len().max(other.len())).collect();
        }
        let (mut i, mut j, mut matched) = (0usize, 0usize, Vec::new());
        while i < a.len() || j < b.len() {
            let (left, right) = (a.get(i), b.get(j));
            let only_a = right.is_none_or(|right| left.is_some_and(|left| left < right));
            let only_b = left.is_none_or(|left| right.is_some_and(|right| right < left));
            matched.push([(!only_b).then_some(i), (!only_a).then_some(j)]);
            i = i.saturating_add(usize::from(!only_b));
            j = j.saturating_add(usize::from(!only_a));
        }
        matched
    }

    fn compare(&self, [a, b]: [usize; 2], other: &Sheet<'_>, spots: &mut Vec<Spot>) {
        let rows = [Some(a), Some(b)];
        if self.bits(a) == other.bits(b) && self.fields(a) == other.fields(b) {
            return;
        }
        if self.fields(a) == other.fields(b) {
            for ((name, ours), (_, theirs)) in self.cells(a).zip(other.cells(b)) {
                if ours != theirs {
                    spots.push(Spot { rows, field: name.into(), cells: [Some(ours), Some(theirs)] });
                }
            }
            return;
        }
        let mut theirs: BTreeMap<_, _> = other.cells(b).collect();
        for (name, cell) in self.cells(a) {
            let matching = theirs.remove(name);
            if matching.as_ref() != Some(&cell) {
                spots.push(Spot { rows, field: name.into(), cells: [Some(cell), matching] });
            }
        }
        spots.extend(theirs.into_iter().map(|(name, cell)| Spot {
            rows,
            field: name.into(),
            cells: [None, Some(cell)],
        }));
    }
}

fn layout(reader: &mut Reader<'_>) -> Result<Vec<Field>, DecodeError> {
    let mut fields = Vec::new();
    for _ in 0..reader.take::<u16>("fields")? {
        let name = take_text(reader, "field's name")?;
        let offset = reader.offset();
        let form = reader.take::<u8>("field's form")?;
        let frac = reader.take::<u8>("fraction bits")?;
        let width = usize::from(form & !SIGNED);
        if ![1, 2, 4, 8, 16].contains(&width) || frac > 64 {
            return Err(reader.invalid(offset, "field's form", "is none"));
        }
        fields.push(Field { name, width, signed: form & SIGNED != 0, frac, unit: take_text(reader, "unit")? });
    }
    if fields.is_empty() {
        return Err(reader.invalid(reader.offset(), "fields", "are none"));
    }
    Ok(fields)
}

fn width(fields: &[Field]) -> usize {
    fields.iter().fold(0, |sum: usize, field| sum.saturating_add(field.width))
}
