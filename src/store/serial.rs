//! A game's own state as bytes, for rollback and for those who join late. Feature `ggrs`.
//!
//! Not a file format: these bytes live as long as a match, between equal builds. Fixed-width little-endian integers, so
//! that a `usize` has the same bytes on 32 and 64 bits; a sequence is a `u64` count and its elements.

use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use bincode::enc::write::Writer;
use bincode::error::EncodeError;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The most bytes a game's own state may have: what a damaged count may make a reader reserve.
pub(crate) const LARGEST: usize = 1 << 20;

const CONFIG: Configuration<LittleEndian, Fixint, Limit<LARGEST>> =
    bincode::config::standard().with_little_endian().with_fixed_int_encoding().with_limit::<LARGEST>();

struct Append<'a>(&'a mut Vec<u8>);

impl Writer for Append<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), EncodeError> {
        if self.0.len().saturating_add(bytes.len()) > LARGEST {
            return Err(EncodeError::Other("more than 1 MiB"));
        }
        self.0.extend_from_slice(bytes);
        Ok(())
    }
}

/// Writes a value into a buffer that is cleared first. Whether it could be: a type may refuse, or be too large.
pub(crate) fn write_value(bytes: &mut Vec<u8>, value: &impl Serialize) -> bool {
    bytes.clear();
    bincode::serde::encode_into_writer(value, Append(bytes), CONFIG).is_ok()
}

/// The value that was written; `None` if the bytes are not exactly one.
pub(crate) fn read_value<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    match bincode::serde::decode_from_slice(bytes, CONFIG) {
        Ok((value, used)) if used == bytes.len() => Some(value),
        _ => None,
    }
}
