//! What memory holds, field by field: names, formats and raw bits, as tables that say what they are.
//!
//! A save holds what is sound; this shows what is there, so that a fault in it can be named. A table carries the names and
//! formats of its fields, so that reading one takes no knowledge of the types that it was made from: see
//! [`Sheet`](super::sheet::Sheet).

use super::codec::{put, put_count};
use crate::geom::Vec2;
use core::fmt::Write;

/// What the bits of a field are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Form {
    /// Bytes: 1, 2, 4, 8 or 16.
    pub(crate) width: u8,
    pub(crate) signed: bool,
    /// How many of the bits are fraction.
    pub(crate) frac: u8,
    pub(crate) unit: &'static str,
}

impl Form {
    /// An integer of its own.
    const fn whole(width: usize, signed: bool) -> Form {
        Form { width: width as u8, signed, frac: 0, unit: "" }
    }
}

/// Something of which every field can be shown.
pub(crate) trait Show {
    fn show(&self, cells: &mut Cells<'_>);
}

/// The names of a row's fields, when they are wanted.
#[derive(Default)]
struct Names {
    path: String,
    found: Vec<(String, Form)>,
}

/// Takes the fields of one row.
pub(crate) struct Cells<'s> {
    bits: &'s mut Vec<u8>,
    /// What decides which fields there are: tags of enums, whether options have a value, counts.
    trail: &'s mut Vec<u32>,
    names: Option<&'s mut Names>,
}

impl Cells<'_> {
    /// Shows inside the field `name` of the present place.
    #[inline]
    pub(crate) fn field(&mut self, name: &str, show: impl FnOnce(&mut Self)) {
        let Some(names) = &mut self.names else { return show(self) };
        let length = names.path.len();
        if !name.is_empty() {
            if length > 0 {
                names.path.push('.');
            }
            names.path.push_str(name);
        }
        show(self);
        self.back_to(length);
    }

    /// Shows inside element `index` of the present place.
    #[inline]
    pub(crate) fn element(&mut self, index: usize, show: impl FnOnce(&mut Self)) {
        let Some(names) = &mut self.names else { return show(self) };
        let length = names.path.len();
        // Writing to a String does not fail.
        let _ = write!(names.path, "[{index}]");
        show(self);
        self.back_to(length);
    }

    fn back_to(&mut self, length: usize) {
        if let Some(names) = &mut self.names {
            names.path.truncate(length);
        }
    }

    /// Notes what decides which fields follow.
    #[inline]
    pub(crate) fn turn(&mut self, choice: u32) {
        self.trail.push(choice);
    }

    /// The bits of the present place, little-endian, as many bytes as the form has.
    #[inline]
    pub(crate) fn leaf(&mut self, form: Form, bytes: &[u8]) {
        debug_assert_eq!(bytes.len(), usize::from(form.width), "a form's width is that of its bits");
        self.bits.extend_from_slice(bytes);
        if let Some(names) = &mut self.names {
            let path = names.path.clone();
            names.found.push((path, form));
        }
    }

    /// A raw integer with fraction bits and a unit.
    pub(crate) fn fixed(&mut self, bits: i64, frac: u8, unit: &'static str) {
        self.leaf(Form { width: 8, signed: true, frac, unit }, &bits.to_le_bytes());
    }
}

/// What the rows of a table are, so that each can be named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// One row: the world's own.
    World = 0,
    /// A row per slot of bodies.
    Body = 1,
    /// A row per slot of colliders.
    Collider = 2,
    /// A row per slot of attractors.
    Attractor = 3,
    /// A row per slot of forms.
    Form = 4,
    /// Its first four fields are slot and generation of two colliders.
    Contact = 5,
    /// Its first two fields are the slots of two colliders.
    Pair = 6,
    /// Its first field is the slot of a body.
    OfBody = 7,
    /// In the order of a list.
    List = 8,
}

impl Kind {
    pub(crate) const ALL: [Kind; 9] = [
        Kind::World,
        Kind::Body,
        Kind::Collider,
        Kind::Attractor,
        Kind::Form,
        Kind::Contact,
        Kind::Pair,
        Kind::OfBody,
        Kind::List,
    ];

    /// How many of its first fields say what a row is of.
    pub(crate) fn keys(self) -> usize {
        match self {
            Kind::Contact => 4,
            Kind::Pair => 2,
            Kind::OfBody => 1,
            _ => 0,
        }
    }
}

/// Takes tables.
pub(crate) trait Tables {
    /// Takes the bytes of a table.
    fn table(&mut self, name: &'static str, bytes: &[u8]);
}

/// Space for writing tables, reused.
#[derive(Default)]
pub(crate) struct Draft {
    rows: Vec<u8>,
    trail: Vec<u32>,
    layouts: Vec<(Vec<u32>, Names)>,
    bytes: Vec<u8>,
}

impl Draft {
    /// Writes a table of these rows and hands it on.
    pub(crate) fn table<T: Show>(
        &mut self,
        tables: &mut impl Tables,
        name: &'static str,
        kind: Kind,
        rows: impl Iterator<Item = T>,
    ) {
        let mut count = 0usize;
        self.rows.clear();
        self.layouts.clear();
        for row in rows {
            count = count.saturating_add(1);
            let start = self.rows.len();
            self.rows.push(0);
            self.trail.clear();
            row.show(&mut Cells { bits: &mut self.rows, trail: &mut self.trail, names: None });
            let known = self.layouts.iter().position(|(trail, _)| *trail == self.trail);
            let layout = known.unwrap_or_else(|| {
                let (mut names, mut bits, mut trail) = (Names::default(), Vec::new(), Vec::new());
                row.show(&mut Cells { bits: &mut bits, trail: &mut trail, names: Some(&mut names) });
                self.layouts.push((trail, names));
                self.layouts.len().saturating_sub(1)
            });
            debug_assert!(layout <= 255, "the types have a few dozen layouts at most");
            self.rows[start] = layout as u8;
        }
        self.assemble(name, kind, count);
        tables.table(name, &self.bytes);
    }

    fn assemble(&mut self, name: &str, kind: Kind, count: usize) {
        let Draft { rows, layouts, bytes, .. } = self;
        bytes.clear();
        put_text(bytes, name);
        put(bytes, kind as u8);
        put(bytes, layouts.len() as u8);
        for (_, names) in layouts {
            put(bytes, names.found.len() as u16);
            for (name, form) in &names.found {
                put_text(bytes, name);
                put(bytes, form.width | if form.signed { SIGNED } else { 0 });
                put(bytes, form.frac);
                put_text(bytes, form.unit);
            }
        }
        put_count(bytes, count);
        bytes.extend_from_slice(rows);
    }
}

/// In the byte of a form: whether its bits are two's complement.
pub(crate) const SIGNED: u8 = 0x80;

/// Writes a short text: a byte of length, then UTF-8.
pub(crate) fn put_text(bytes: &mut Vec<u8>, text: &str) {
    let mut end = text.len().min(255);
    while !text.is_char_boundary(end) {
        end = end.saturating_sub(1);
    }
    put(bytes, end as u8);
    bytes.extend_from_slice(&text.as_bytes()[..end]);
}

macro_rules! whole {
    ($($type:ty)*) => {$(
        impl Show for $type {
            #[inline]
            fn show(&self, cells: &mut Cells<'_>) {
                #[allow(unused_comparisons, reason = "whether the type has negative values")]
                const SIGNED: bool = <$type>::MIN < 0;
                cells.leaf(Form::whole(size_of::<$type>(), SIGNED), &self.to_le_bytes());
            }
        }
    )*};
}

whole! { u8 u32 u64 i32 i64 i128 }

impl Show for bool {
    fn show(&self, cells: &mut Cells<'_>) {
        u8::from(*self).show(cells);
    }
}

macro_rules! quantities {
    ($($type:ident)*) => {$(
        impl Show for crate::num::$type {
            #[inline]
            fn show(&self, cells: &mut Cells<'_>) {
                use crate::num::Quantity;
                let bytes = self.to_bits().to_le_bytes();
                let signed = !matches!(stringify!($type).as_bytes(), b"Mu");
                let form = Form { width: bytes.len() as u8, signed, frac: Self::FRAC as u8, unit: Self::UNIT };
                cells.leaf(form, &bytes);
            }
        }
    )*};
}

quantities! { Impulse AngularImpulse Acceleration Angle AngularVelocity Damping Density Force Friction Restitution Inertia Length Mass Mu Torque Time Velocity }

impl<T: Show + ?Sized> Show for &T {
    #[inline]
    fn show(&self, cells: &mut Cells<'_>) {
        (**self).show(cells);
    }
}

impl<Q: Show> Show for Vec2<Q> {
    #[inline]
    fn show(&self, cells: &mut Cells<'_>) {
        cells.field("x", |c| self.x.show(c));
        cells.field("y", |c| self.y.show(c));
    }
}

impl<T: Show> Show for Option<T> {
    fn show(&self, cells: &mut Cells<'_>) {
        cells.turn(self.is_some().into());
        cells.field("given", |c| self.is_some().show(c));
        if let Some(value) = self {
            value.show(cells);
        }
    }
}

impl<T: Show> Show for [T] {
    fn show(&self, cells: &mut Cells<'_>) {
        for (index, element) in self.iter().enumerate() {
            cells.element(index, |c| element.show(c));
        }
    }
}

impl<T: Show, const N: usize> Show for [T; N] {
    fn show(&self, cells: &mut Cells<'_>) {
        self.as_slice().show(cells);
    }
}

impl<T: Show> Show for Vec<T> {
    fn show(&self, cells: &mut Cells<'_>) {
        cells.turn(self.len() as u32);
        cells.field("len", |c| (self.len() as u32).show(c));
        self.as_slice().show(cells);
    }
}

/// Implements [`Show`] from a list of fields.
macro_rules! show {
    ($type:ident { $($field:ident),* $(,)? } $(apart { $($apart:ident),* $(,)? })?) => {
        impl $crate::store::Show for $type {
            fn show(&self, cells: &mut $crate::store::Cells<'_>) {
                let $type { $($field,)* $($($apart: _,)*)? } = self;
                $( cells.field(stringify!($field), |c| $crate::store::Show::show($field, c)); )*
            }
        }
    };
}

pub(crate) use show;
