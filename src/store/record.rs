//! One field list per type drives save, load, hash, diff and copy.
//!
//! [`record!`] takes a struct apart without `..`, so the compiler refuses a list that forgets a field; with `shown` after
//! it, evidence shows the same fields. Derived
//! fields, which are computed from the others and rebuilt after loading, are listed apart, by name.

use super::codec::{DecodeError, Reader, Sink, put};
use crate::geom::Vec2;
use core::fmt::Write;

/// A place where two states differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The field, as `bodies[12].velocity.y`.
    pub path: String,
    /// The value in the first state: exact decimal, then raw bits.
    pub a: String,
    /// The value in the second.
    pub b: String,
}

impl core::fmt::Display for Difference {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}: {} and {}", self.path, self.a, self.b)
    }
}

/// Collects differences under the path of the field being compared.
#[derive(Default)]
pub(crate) struct Diff {
    path: String,
    pub(crate) found: Vec<Difference>,
}

impl Diff {
    /// Compares inside the field `name` of the present place; an empty name stays at it.
    pub(crate) fn field(&mut self, name: &str, compare: impl FnOnce(&mut Self)) {
        let length = self.path.len();
        if !name.is_empty() {
            if length > 0 {
                self.path.push('.');
            }
            self.path.push_str(name);
        }
        compare(self);
        self.path.truncate(length);
    }

    /// Compares inside element `index` of the present place.
    pub(crate) fn element(&mut self, index: usize, compare: impl FnOnce(&mut Self)) {
        let length = self.path.len();
        // Writing to a String does not fail.
        let _ = write!(self.path, "[{index}]");
        compare(self);
        self.path.truncate(length);
    }

    /// Notes a difference at the present place.
    pub(crate) fn note(&mut self, a: String, b: String) {
        self.found.push(Difference { path: self.path.clone(), a, b });
    }
}

/// Something that is saved, loaded, hashed and compared by one field list.
pub(crate) trait Record: Sized {
    /// The fewest bytes that `save` writes, for checking counts.
    const LEAST: usize = 1;
    fn save(&self, sink: &mut impl Sink);
    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError>;
    fn diff(&self, other: &Self, diff: &mut Diff);
}

macro_rules! integers {
    ($($type:ty)*) => {$(
        impl Record for $type {
            const LEAST: usize = size_of::<$type>();

            fn save(&self, sink: &mut impl Sink) {
                put(sink, *self);
            }

            fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
                reader.take(field)
            }

            fn diff(&self, other: &Self, diff: &mut Diff) {
                if self != other {
                    diff.note(self.to_string(), other.to_string());
                }
            }
        }
    )*};
}

integers! { u8 u32 u64 bool }

macro_rules! quantities {
    ($($type:ident)*) => {$(
        impl Record for crate::num::$type {
            const LEAST: usize = size_of::<Self>();

            fn save(&self, sink: &mut impl Sink) {
                put(sink, self.to_bits());
            }

            fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
                // Ranges are for the table that knows whether the value is in use: a free slot has mass 0.
                reader.take(field).map(Self::from_bits)
            }

            fn diff(&self, other: &Self, diff: &mut Diff) {
                if self != other {
                    let show = |v: &Self| format!("{v:?} (bits {:#x})", v.to_bits());
                    diff.note(show(self), show(other));
                }
            }
        }
    )*};
}

quantities! { Acceleration Angle AngularVelocity Damping Density Force Friction Restitution Inertia Length Mass Mu Torque Time Velocity Impulse AngularImpulse }

impl<Q: Record> Record for Vec2<Q> {
    const LEAST: usize = Q::LEAST.saturating_mul(2);

    fn save(&self, sink: &mut impl Sink) {
        let Vec2 { x, y } = self;
        x.save(sink);
        y.save(sink);
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        Ok(Vec2 { x: Q::load(reader, field)?, y: Q::load(reader, field)? })
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        diff.field("x", |d| self.x.diff(&other.x, d));
        diff.field("y", |d| self.y.diff(&other.y, d));
    }
}

impl<T: Record + PartialEq + core::fmt::Debug> Record for Option<T> {
    fn save(&self, sink: &mut impl Sink) {
        self.is_some().save(sink);
        if let Some(value) = self {
            value.save(sink);
        }
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        if bool::load(reader, field)? { T::load(reader, field).map(Some) } else { Ok(None) }
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        if self != other {
            diff.note(format!("{self:?}"), format!("{other:?}"));
        }
    }
}

impl<T: Record> Record for Vec<T> {
    const LEAST: usize = 4;

    fn save(&self, sink: &mut impl Sink) {
        super::codec::put_count(sink, self.len());
        for element in self {
            element.save(sink);
        }
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let count = reader.take_count(T::LEAST, field)?;
        let mut elements = Vec::new();
        for _ in 0..count {
            elements.push(T::load(reader, field)?);
        }
        Ok(elements)
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        if self.len() != other.len() {
            diff.field("len", |d| d.note(self.len().to_string(), other.len().to_string()));
        }
        for (index, (a, b)) in self.iter().zip(other).enumerate() {
            diff.element(index, |d| a.diff(b, d));
        }
    }
}

/// [`record!`] for a type that is `Copy`, or needs no `Clone`.
macro_rules! record_copy {
    ($type:ident { $($field:ident),* $(,)? } shown) => {
        $crate::store::record_copy!($type { $($field),* });
        $crate::store::show!($type { $($field),* });
    };
    ($type:ident { $($field:ident),* $(,)? } $(derived { $($derived:ident),* $(,)? })?) => {
        impl $crate::store::Record for $type {
            fn save(&self, sink: &mut impl $crate::store::Sink) {
                let $type { $($field,)* $($($derived: _,)*)? } = self;
                $( $crate::store::Record::save($field, sink); )*
            }

            fn load(
                reader: &mut $crate::store::Reader<'_>,
                _field: &'static str,
            ) -> Result<Self, $crate::store::DecodeError> {
                Ok($type {
                    $( $field: $crate::store::Record::load(reader, stringify!($field))?, )*
                    $($( $derived: Default::default(), )*)?
                })
            }

            fn diff(&self, other: &Self, diff: &mut $crate::store::Diff) {
                $( diff.field(stringify!($field), |d| $crate::store::Record::diff(&self.$field, &other.$field, d)); )*
            }
        }
    };
}

/// Implements [`Record`] and a `Clone` whose `clone_from` reuses allocations, from one list of fields.
macro_rules! record {
    ($type:ident { $($field:ident),* $(,)? } shown) => {
        $crate::store::record!($type { $($field),* });
        $crate::store::show!($type { $($field),* });
    };
    ($type:ident { $($field:ident),* $(,)? } $(derived { $($derived:ident),* $(,)? })?) => {
        $crate::store::record_copy!($type { $($field),* } $(derived { $($derived),* })?);
        $crate::store::clone_fields!($type { $($field,)* $($($derived,)*)? });
    };
}

/// A `Clone` whose `clone_from` reuses allocations, which the derived one does not.
macro_rules! clone_fields {
    ($type:ident { $($field:ident),* $(,)? }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                let $type { $($field),* } = self;
                $type { $($field: $field.clone()),* }
            }

            fn clone_from(&mut self, source: &Self) {
                let $type { $($field),* } = source;
                $( self.$field.clone_from($field); )*
            }
        }
    };
}

/// Implements [`Record`] for an enum: a tag byte, then the variant's fields. The match and its patterns are
/// complete, so a forgotten variant or field does not compile.
macro_rules! record_enum {
    ($type:ident { $($tag:literal => $variant:ident { $($field:ident),* $(,)? }),* $(,)? } shown) => {
        $crate::store::record_enum!($type { $($tag => $variant { $($field),* }),* });

        impl $crate::store::Show for $type {
            fn show(&self, cells: &mut $crate::store::Cells<'_>) {
                match self {
                    $( $type::$variant { $($field),* } => {
                        cells.turn($tag);
                        $crate::store::Show::show(&($tag as u8), cells);
                        $( cells.field(stringify!($field), |c| $crate::store::Show::show($field, c)); )*
                    } )*
                }
            }
        }
    };
    ($type:ident { $($tag:literal => $variant:ident { $($field:ident),* $(,)? }),* $(,)? }) => {
        impl $crate::store::Record for $type {
            fn save(&self, sink: &mut impl $crate::store::Sink) {
                match self {
                    $( $type::$variant { $($field),* } => {
                        $crate::store::put(sink, $tag as u8);
                        $( $crate::store::Record::save($field, sink); )*
                    } )*
                }
            }

            fn load(
                reader: &mut $crate::store::Reader<'_>,
                field: &'static str,
            ) -> Result<Self, $crate::store::DecodeError> {
                let offset = reader.offset();
                match reader.take::<u8>(field)? {
                    $( $tag => Ok($type::$variant {
                        $( $field: $crate::store::Record::load(reader, stringify!($field))?, )*
                    }), )*
                    _ => Err(reader.invalid(offset, field, "has an unknown tag")),
                }
            }

            fn diff(&self, other: &Self, diff: &mut $crate::store::Diff) {
                if self != other {
                    diff.note(format!("{self:?}"), format!("{other:?}"));
                }
            }
        }
    };
}

pub(crate) use {clone_fields, record, record_copy, record_enum};
