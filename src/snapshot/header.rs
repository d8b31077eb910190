//! The first bytes of saves and frames: what they are, their format version, the arithmetic law.

use super::{LAW, SAVE_VERSION};
use crate::store::{DecodeError, Reader, put as put_word};

/// What bytes begin with.
pub(super) type Magic = [u8; 8];
pub(super) const SAVE: &Magic = b"TAMIAS-W";
pub(super) const FRAME: &Magic = b"TAMIAS-F";

/// Writes the header.
pub(super) fn put(bytes: &mut Vec<u8>, magic: &Magic) {
    bytes.extend_from_slice(magic);
    put_word(bytes, SAVE_VERSION);
    put_word(bytes, LAW);
}

/// Reads the header, and refuses another one. The reader of what follows.
pub(super) fn take<'b>(bytes: &'b [u8], magic: &Magic) -> Result<Reader<'b>, DecodeError> {
    let mut reader = Reader::new(bytes);
    if reader.take_bytes(magic.len(), "magic").ok() != Some(magic) {
        return Err(if magic == SAVE { DecodeError::NotASave } else { DecodeError::NotAFrame });
    }
    let found = reader.take("format version")?;
    if found != SAVE_VERSION {
        return Err(DecodeError::Version { found, known: SAVE_VERSION });
    }
    let found = reader.take("arithmetic law")?;
    if found != LAW {
        return Err(DecodeError::Law { found, known: LAW });
    }
    Ok(reader)
}
