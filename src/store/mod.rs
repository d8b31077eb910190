//! Stored state: bytes in and out, field lists, columns, slots with generations; what memory holds, field by field.

mod arena;
mod codec;
mod column;
mod record;
#[cfg(feature = "ggrs")]
mod serial;
mod sheet;
mod show;
#[cfg(test)]
mod tests;

pub(crate) use arena::{Arena, Row};
pub use arena::{AttractorId, BodyId, ColliderId};
pub use codec::DecodeError;
pub(crate) use codec::{Hasher, Reader, Sink, hash_bytes, hash_numbers, hash_words, put, put_count};
pub(crate) use column::Column;
pub use record::Difference;
pub(crate) use record::{Diff, Record, clone_fields, record, record_copy, record_enum};
#[cfg(feature = "ggrs")]
pub(crate) use serial::{read_value, write_value};
pub(crate) use sheet::{Cell, Sheet, Spot, take_text};
pub(crate) use show::{Cells, Draft, Kind, Show, Tables, put_text, show};
