//! Records and their chain, the same for writing and reading.

use super::error::ReplayError;
use crate::snapshot::LAW;
use crate::store::{Reader, put};
use std::io::{Read, Write};
use twox_hash::XxHash3_64;

/// The format version of replays.
pub const REPLAY_VERSION: u32 = 3;

const MAGIC: &[u8; 8] = b"TAMIAS-R";
const HEADER: usize = 32;
/// How much is reserved for a payload before any of it was read.
const CHUNK: usize = 4096;

pub(super) mod tag {
    pub(crate) const WORLD: u8 = 0x01;
    pub(crate) const IDLE: u8 = 0x02;
    pub(crate) const TICK: u8 = 0x03;
    pub(crate) const TAIL: u8 = 0x04;
    pub(crate) const END: u8 = 0x0f;
    pub(crate) const ANCILLARY: u8 = 0x80;
    pub(crate) const KEYFRAME: u8 = 0x80;
    pub(crate) const PARTS: u8 = 0x81;
    pub(crate) const EVIDENCE: u8 = 0x82;
    pub(crate) const INDEX: u8 = 0x83;
}

/// The header of a replay at a tick rate.
fn header(tick_rate: u32) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER);
    bytes.extend_from_slice(MAGIC);
    for value in [REPLAY_VERSION, LAW, tick_rate, 0] {
        put(&mut bytes, value);
    }
    let check = XxHash3_64::oneshot(&bytes);
    put(&mut bytes, check);
    bytes
}

/// Writes records.
pub(super) struct RecordWriter<W> {
    out: W,
    chain: u64,
    offset: u64,
    scratch: Vec<u8>,
}

impl<W: Write> RecordWriter<W> {
    pub(super) fn new(out: W, tick_rate: u32) -> std::io::Result<Self> {
        let bytes = header(tick_rate);
        let chain = seed(&bytes);
        let mut writer = RecordWriter { out, chain, offset: 0, scratch: Vec::new() };
        writer.write(&bytes)?;
        Ok(writer)
    }

    fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.out.write_all(bytes)?;
        self.offset = self.offset.saturating_add(bytes.len() as u64);
        Ok(())
    }

    /// Where the next record begins, and the chain before it.
    pub(super) fn place(&self) -> (u64, u64) {
        (self.offset, self.chain)
    }

    /// Writes a record: its tag, the payload's length, the payload and the check; of an idle tick tag and payload alone.
    pub(super) fn record(&mut self, tag: u8, payload: &[u8]) -> std::io::Result<()> {
        let mut bytes = core::mem::take(&mut self.scratch);
        bytes.clear();
        bytes.push(tag);
        if tag != tag::IDLE {
            let length = u32::try_from(payload.len())
                .map_err(|_| std::io::Error::other("a replay's record is limited to 4 GiB"))?;
            put(&mut bytes, length);
        }
        bytes.extend_from_slice(payload);
        self.chain = XxHash3_64::oneshot_with_seed(self.chain, &bytes);
        if tag != tag::IDLE {
            put(&mut bytes, self.chain as u32);
        }
        let result = self.write(&bytes);
        self.scratch = bytes;
        result
    }

    /// Writes the end record and gives the destination back.
    pub(super) fn end(mut self, ticks: u64, index: u64) -> std::io::Result<W> {
        let mut bytes = vec![tag::END];
        put(&mut bytes, ticks);
        put(&mut bytes, index);
        let chain = XxHash3_64::oneshot_with_seed(self.chain, &bytes);
        put(&mut bytes, chain);
        self.write(&bytes)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

/// What the end record has, in bytes.
pub(super) const END_SIZE: u64 = 25;

/// The chain before the first record: the header's own hash.
fn seed(header: &[u8]) -> u64 {
    header.last_chunk().copied().map_or(0, u64::from_le_bytes)
}

/// A record as read; its payload is in the reader's buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    Record {
        tag: u8,
        offset: u64,
    },
    End {
        ticks: u64,
        /// Where the index is; 0 without one.
        index: u64,
    },
    /// The file ends here without an end record.
    Cut,
}

/// Reads records from any source, with memory bounded by the bytes that are really there.
pub(super) struct RecordReader<R> {
    input: R,
    chain: u64,
    offset: u64,
    bytes: Vec<u8>,
    payload: core::ops::Range<usize>,
    pub(super) tick_rate: u32,
}

impl<R: Read> RecordReader<R> {
    pub(super) fn new(input: R) -> Result<Self, ReplayError> {
        let mut reader = Self::at(input, 0, 0);
        let whole = reader.fetch(HEADER)?;
        let bytes = &reader.bytes;
        if !MAGIC.starts_with(&bytes[..bytes.len().min(MAGIC.len())]) {
            return Err(ReplayError::NotAReplay);
        }
        if !whole {
            return Err(ReplayError::Truncated { ticks: 0, offset: reader.offset });
        }
        let mut fields = Reader::new(&bytes[MAGIC.len()..]);
        let mut field =
            || fields.take::<u32>("header").map_err(|error| ReplayError::Decode { tick: 0, offset: 0, error });
        let (version, law, tick_rate) = (field()?, field()?, field()?);
        if version != REPLAY_VERSION {
            return Err(ReplayError::Version { found: version, known: REPLAY_VERSION });
        }
        if law != LAW {
            return Err(ReplayError::Law { found: law, known: LAW });
        }
        if *bytes != header(tick_rate) {
            return Err(ReplayError::Corrupt { tick: 0, offset: 0, reason: "the header's hash does not fit it" });
        }
        (reader.tick_rate, reader.chain) = (tick_rate, seed(bytes));
        reader.take_in();
        Ok(reader)
    }

    /// Reads from the middle on: `input` stands at `offset`, and `chain` is that of all records before.
    pub(super) fn at(input: R, offset: u64, chain: u64) -> Self {
        RecordReader { input, chain, offset, bytes: Vec::new(), payload: 0..0, tick_rate: 0 }
    }

    /// The chain of all records so far.
    pub(super) fn chain(&self) -> u64 {
        self.chain
    }

    /// Where reading has come to.
    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    /// The payload of the record read last.
    pub(super) fn payload(&self) -> &[u8] {
        &self.bytes[self.payload.clone()]
    }

    /// Adds `count` bytes to the buffer; whether they were there. Reserves at most an eighth more than was read, or a
    /// chunk more.
    fn fetch(&mut self, count: usize) -> Result<bool, ReplayError> {
        let target = self.bytes.len().saturating_add(count);
        while self.bytes.len() < target {
            let have = self.bytes.len();
            let next = target.min(have.saturating_add((have >> 3).max(CHUNK)));
            self.bytes.reserve_exact(next.saturating_sub(have));
            self.bytes.resize(next, 0);
            let mut filled = have;
            while filled < next {
                match self.input.read(&mut self.bytes[filled..]) {
                    Ok(0) => break,
                    Ok(read) => filled = filled.saturating_add(read),
                    Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(ReplayError::Io(error)),
                }
            }
            self.offset = self.offset.saturating_add(filled.saturating_sub(have) as u64);
            self.bytes.truncate(filled);
            if filled < next {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The buffered bytes are accepted, and the next record starts afresh.
    fn take_in(&mut self) {
        self.bytes.clear();
    }

    /// The next record.
    pub(super) fn next(&mut self) -> Result<Found, ReplayError> {
        let found = self.next_unchecked()?;
        if let Found::Record { tag, offset } = found {
            if tag != tag::IDLE && self.last_u32() != self.chain as u32 {
                return Err(ReplayError::Corrupt { tick: 0, offset, reason: "the record's check does not fit it" });
            }
        }
        Ok(found)
    }

    /// The next record, whose check nobody has looked at.
    pub(super) fn next_unchecked(&mut self) -> Result<Found, ReplayError> {
        self.take_in();
        let offset = self.offset;
        if !self.fetch(1)? {
            return Ok(Found::Cut);
        }
        let tag = self.bytes[0];
        if tag == tag::END {
            return self.end(offset);
        }
        let length = if tag == tag::IDLE {
            8
        } else {
            if !self.fetch(4)? {
                return Ok(Found::Cut);
            }
            self.last_u32() as usize
        };
        let start = self.bytes.len();
        let check = if tag == tag::IDLE { 0 } else { 4 };
        if !self.fetch(length)? || !self.fetch(check)? {
            return Ok(Found::Cut);
        }
        self.payload = start..start.saturating_add(length);
        let (body, _) = self.bytes.split_at(self.payload.end);
        self.chain = XxHash3_64::oneshot_with_seed(self.chain, body);
        Ok(Found::Record { tag, offset })
    }

    fn last_u32(&self) -> u32 {
        self.bytes.last_chunk().copied().map_or(0, u32::from_le_bytes)
    }

    fn last_u64(&self) -> u64 {
        self.bytes.last_chunk().copied().map_or(0, u64::from_le_bytes)
    }

    fn end(&mut self, offset: u64) -> Result<Found, ReplayError> {
        if !self.fetch(8)? {
            return Ok(Found::Cut);
        }
        let ticks = self.last_u64();
        if !self.fetch(8)? {
            return Ok(Found::Cut);
        }
        let index = self.last_u64();
        let chain = XxHash3_64::oneshot_with_seed(self.chain, &self.bytes);
        if !self.fetch(8)? {
            return Ok(Found::Cut);
        }
        if self.last_u64() != chain {
            return Err(ReplayError::Corrupt { tick: 0, offset, reason: "the end's chain is not that of the records" });
        }
        let end = self.offset;
        if self.fetch(1)? {
            return Err(ReplayError::Trailing { offset: end });
        }
        Ok(Found::End { ticks, index })
    }
}
