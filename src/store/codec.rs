//! The bytes of stored state. The only file that uses `bincode`, and the place to replace it.
//!
//! # Layout
//!
//! | value | bytes |
//! |---|---|
//! | `u8`, `u32`, `u64`, `u128`, `i64`, `i128` | fixed width, little-endian, two's complement |
//! | `bool` | one byte, 0 or 1; others are refused |
//! | a quantity | its raw bits as the integer of its format |
//! | a vector, a struct | its fields in the order of its field list, nothing between them |
//! | an enum | one byte of tag as its field list numbers them, then the variant's fields |
//! | a sequence | a `u32` count, then its elements |
//!
//! `bincode` 2.0.1 with fixed-width little-endian integers gives exactly these bytes for the first two rows; it never
//! sees a sequence, because it would reserve memory by the claimed count. A count is checked here against the bytes
//! that remain before anything is reserved. The crate is unmaintained (RUSTSEC-2025-0141): what it does here is
//! copying little-endian integers, the layout above is all a successor needs, and no file would change.

use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use core::fmt;
use twox_hash::XxHash3_64;

/// The widest primitive is 16 bytes; no call may read or write more.
const CONFIG: Configuration<LittleEndian, Fixint, Limit<16>> =
    bincode::config::standard().with_little_endian().with_fixed_int_encoding().with_limit::<16>();

/// Where bytes go: a file image or a hash.
pub(crate) trait Sink {
    fn bytes(&mut self, bytes: &[u8]);
}

impl Sink for Vec<u8> {
    fn bytes(&mut self, bytes: &[u8]) {
        self.extend_from_slice(bytes);
    }
}

/// XXH3-64 of bytes, seed 0: the hash of all state and files.
pub(crate) fn hash_bytes(bytes: &[u8]) -> u64 {
    XxHash3_64::oneshot(bytes)
}

/// XXH3-64 of the little-endian bytes of rows of words: one pass over memory where that is how memory holds them.
pub(crate) fn hash_words<const N: usize>(rows: &[[u64; N]]) -> u64 {
    if cfg!(target_endian = "little") {
        hash_bytes(bytemuck::cast_slice(rows.as_flattened()))
    } else {
        let swapped: Vec<u64> = rows.iter().flatten().map(|word| word.to_le()).collect();
        hash_bytes(bytemuck::cast_slice(&swapped))
    }
}

/// XXH3-64 of the little-endian bytes of numbers.
pub(crate) fn hash_numbers(numbers: &[u32]) -> u64 {
    if cfg!(target_endian = "little") {
        hash_bytes(bytemuck::cast_slice(numbers))
    } else {
        let swapped: Vec<u32> = numbers.iter().map(|number| number.to_le()).collect();
        hash_bytes(bytemuck::cast_slice(&swapped))
    }
}

/// XXH3-64 of what is written, without allocating: exactly that for up to 256 bytes; longer input is hashed in
/// blocks of 256, each seeded with the hash of those before.
pub(crate) struct Hasher {
    block: [u8; Self::BLOCK],
    used: usize,
    seed: u64,
}

impl Hasher {
    const BLOCK: usize = 256;

    pub(crate) fn new() -> Self {
        Hasher { block: [0; Self::BLOCK], used: 0, seed: 0 }
    }

    pub(crate) fn finish(&self) -> u64 {
        XxHash3_64::oneshot_with_seed(self.seed, &self.block[..self.used])
    }
}

impl Sink for Hasher {
    fn bytes(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            if self.used == Self::BLOCK {
                self.seed = self.finish();
                self.used = 0;
            }
            let room = &mut self.block[self.used..];
            let taken = room.len().min(bytes.len());
            room[..taken].copy_from_slice(&bytes[..taken]);
            self.used = self.used.saturating_add(taken);
            bytes = &bytes[taken..];
        }
    }
}

/// Writes a primitive.
pub(crate) fn put<T: bincode::Encode>(sink: &mut impl Sink, value: T) {
    let mut bytes = [0; 16];
    let written = bincode::encode_into_slice(value, &mut bytes, CONFIG);
    debug_assert!(written.is_ok(), "a primitive has at most 16 bytes");
    sink.bytes(&bytes[..written.unwrap_or(0)]);
}

/// Writes the count of a sequence. Every table's limit is far below `u32::MAX`.
pub(crate) fn put_count(sink: &mut impl Sink, count: usize) {
    debug_assert!(u32::try_from(count).is_ok(), "a sequence has fewer than 2^32 elements");
    put(sink, u32::try_from(count).unwrap_or(u32::MAX));
}

/// Why bytes are no saved state. Nothing is built from such bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DecodeError {
    /// The bytes end inside a value.
    Truncated {
        /// Where the value begins.
        offset: u64,
        /// What was being read.
        field: &'static str,
    },
    /// A value that no saved state has.
    Invalid {
        /// Where the value begins.
        offset: u64,
        /// What was being read.
        field: &'static str,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// Bytes after the end.
    Trailing {
        /// Where they begin.
        offset: u64,
    },
    /// The first bytes are not those of a save.
    NotASave,
    /// The first bytes are not those of a frame.
    NotAFrame,
    /// A save of another format version.
    Version {
        /// The version found.
        found: u32,
        /// The version this build reads.
        known: u32,
    },
    /// A save of another arithmetic law: it would continue differently here.
    Law {
        /// The law found.
        found: u32,
        /// The law this build computes by.
        known: u32,
    },
    /// The state read does not have the hash that was saved with it.
    Hash {
        /// The hash in the bytes.
        saved: u64,
        /// The hash of the state read.
        computed: u64,
    },
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DecodeError::Truncated { offset, field } => write!(f, "the bytes end inside {field} at byte {offset}"),
            DecodeError::Invalid { offset, field, reason } => write!(f, "{field} at byte {offset} {reason}"),
            DecodeError::Trailing { offset } => write!(f, "unexpected bytes after the end at byte {offset}"),
            DecodeError::NotASave => f.write_str("not a saved tamias2d world"),
            DecodeError::NotAFrame => f.write_str("not a frame of a tamias2d world"),
            DecodeError::Version { found, known } => write!(
                f,
                "saved in format version {found}, this build reads version {known}: load it with a build of version {found}"
            ),
            DecodeError::Law { found, known } => write!(
                f,
                "saved under arithmetic law {found}, this build computes by law {known}: continue it with a build of law \
                 {found}"
            ),
            DecodeError::Hash { saved, computed } => write!(
                f,
                "the state read has hash {computed:016x}, saved was {saved:016x}: the bytes were changed on their way, fetch \
                 them again"
            ),
        }
    }
}

impl core::error::Error for DecodeError {}

/// Reads values from the front of a byte slice.
pub(crate) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Reader { bytes, at: 0 }
    }

    /// How far reading has come, in bytes.
    pub(crate) fn offset(&self) -> u64 {
        self.at as u64
    }

    /// How many bytes are left.
    pub(crate) fn remaining(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// Reads a primitive.
    pub(crate) fn take<T: bincode::Decode<()>>(&mut self, field: &'static str) -> Result<T, DecodeError> {
        use bincode::error::DecodeError as E;
        let offset = self.offset();
        match bincode::decode_from_slice(&self.bytes[self.at..], CONFIG) {
            Ok((value, used)) => {
                self.at = self.at.saturating_add(used);
                Ok(value)
            }
            Err(E::UnexpectedEnd { .. }) => Err(DecodeError::Truncated { offset, field }),
            Err(_) => Err(DecodeError::Invalid { offset, field, reason: "has a value that is none" }),
        }
    }

    /// Takes `count` bytes as they are.
    pub(crate) fn take_bytes(&mut self, count: usize, field: &'static str) -> Result<&'a [u8], DecodeError> {
        let offset = self.offset();
        let rest = &self.bytes[self.at..];
        let taken = rest.get(..count).ok_or(DecodeError::Truncated { offset, field })?;
        self.at = self.at.saturating_add(count);
        Ok(taken)
    }

    /// Reads a count of elements of at least `size` bytes each, which the remaining bytes must be able to hold.
    pub(crate) fn take_count(&mut self, size: usize, field: &'static str) -> Result<usize, DecodeError> {
        let offset = self.offset();
        let count = self.take::<u32>(field)? as usize;
        if count.saturating_mul(size) > self.remaining() {
            return Err(DecodeError::Truncated { offset, field });
        }
        Ok(count)
    }

    /// The error for a value that was read well but is none.
    pub(crate) fn invalid(&self, offset: u64, field: &'static str, reason: &'static str) -> DecodeError {
        DecodeError::Invalid { offset, field, reason }
    }

    /// Refuses bytes that nobody read.
    pub(crate) fn finish(self) -> Result<(), DecodeError> {
        if self.remaining() > 0 { Err(DecodeError::Trailing { offset: self.offset() }) } else { Ok(()) }
    }
}
