//! Keyframes: places from which a replay can be played without what comes before, and the index of them.

use super::error::ReplayError;
use super::format::{END_SIZE, Found, RecordReader, tag};
use super::player::Player;
use crate::World;
use crate::snapshot::{Digests, Frame};
use crate::store::{DecodeError, Reader, put, put_count};
use std::io::{Read, Seek, SeekFrom};
use twox_hash::XxHash3_64;

/// A place from which a replay can be played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keyframe {
    /// The ticks before it, from the start of the recording.
    pub tick: u64,
    /// Where its record begins.
    pub offset: u64,
    /// A hash of all ticks' hashes and commands before it: two recordings of a game agree up to here exactly if these do.
    pub history: u64,
}

/// What the history of a recording becomes with a tick: its hash and commands.
pub(super) fn history(before: u64, payload: &[u8]) -> u64 {
    XxHash3_64::oneshot_with_seed(before, payload)
}

/// The payload of a keyframe but for the state itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Head {
    pub(super) tick: u64,
    pub(super) commands: u64,
    pub(super) history: u64,
    /// The chain before the record.
    pub(super) chain: u64,
    /// Where the keyframe is that holds a whole save with the tables of this one: itself, or an earlier one.
    pub(super) base: u64,
}

impl Head {
    const SIZE: usize = 40;

    pub(super) fn write(&self, bytes: &mut Vec<u8>) {
        let Head { tick, commands, history, chain, base } = *self;
        for value in [tick, commands, history, chain, base] {
            put(bytes, value);
        }
    }

    /// The head, and the bytes of the state after it.
    pub(super) fn read(payload: &[u8]) -> Result<(Head, &[u8]), DecodeError> {
        let mut reader = Reader::new(payload);
        let mut take = || reader.take::<u64>("keyframe");
        let head = Head { tick: take()?, commands: take()?, history: take()?, chain: take()?, base: take()? };
        Ok((head, &payload[Self::SIZE..]))
    }
}

/// Writes states of a world: whole, or by reference to the last whole one, where no command has changed what that holds besides.
#[derive(Default)]
pub(super) struct States {
    frame: Frame,
    /// Where the last whole save is, and what it says of tables.
    base: Option<(u64, Digests)>,
    bytes: Vec<u8>,
}

impl States {
    /// Takes over: the last whole save is at this place, and has the tables of this world.
    pub(super) fn resume(&mut self, world: &World, base: u64) {
        self.base = Some((base, Digests::of(world)));
    }

    /// Where the last whole save is that has the tables of this world.
    pub(super) fn base(&self, world: &World) -> Option<u64> {
        self.base.filter(|(_, known)| *known == Digests::of(world)).map(|(base, _)| base)
    }

    /// The state of a world as a keyframe at this place holds it: whole, or without what the save at `base` holds.
    pub(super) fn write(&mut self, world: &World, offset: u64, base: u64) -> &[u8] {
        self.bytes.clear();
        if base == offset {
            self.resume(world, offset);
            world.save_into(&mut self.bytes);
        } else {
            world.save_frame(&mut self.frame);
            self.frame.encode_into(&mut self.bytes);
        }
        &self.bytes
    }
}

/// The payload of an index; `chain`: that before its record.
pub(super) fn encode_index(chain: u64, keyframes: &[Keyframe]) -> Vec<u8> {
    let mut bytes = Vec::new();
    put(&mut bytes, chain);
    put_count(&mut bytes, keyframes.len());
    for Keyframe { tick, offset, history } in keyframes {
        for value in [tick, offset, history] {
            put(&mut bytes, *value);
        }
    }
    bytes
}

/// The chain before the record of an index, and what it lists.
pub(super) fn decode_index(payload: &[u8]) -> Result<(u64, Vec<Keyframe>), DecodeError> {
    let mut reader = Reader::new(payload);
    let chain = reader.take("index")?;
    let mut keyframes = Vec::new();
    for _ in 0..reader.take_count(24, "index")? {
        let mut take = || reader.take::<u64>("index");
        keyframes.push(Keyframe { tick: take()?, offset: take()?, history: take()? });
    }
    reader.finish()?;
    Ok((chain, keyframes))
}

/// The keyframes of a whole replay, by its index at the end: without reading what is between. None for a replay that was cut off,
/// or has none.
///
/// Errors: those of reading, and an index that is none.
pub fn read_index(input: &mut (impl Read + Seek)) -> Result<Vec<Keyframe>, ReplayError> {
    let size = input.seek(SeekFrom::End(0)).map_err(ReplayError::Io)?;
    let Some(end) = size.checked_sub(END_SIZE) else { return Ok(Vec::new()) };
    input.seek(SeekFrom::Start(end)).map_err(ReplayError::Io)?;
    let mut bytes = [0; END_SIZE as usize];
    input.read_exact(&mut bytes).map_err(ReplayError::Io)?;
    let [tag, ..] = bytes;
    let place = bytes[9..].first_chunk().copied().map_or(0, u64::from_le_bytes);
    if tag != tag::END || place == 0 {
        return Ok(Vec::new());
    }
    let corrupt = |offset| ReplayError::Corrupt { tick: 0, offset, reason: "the end names an index that is none" };
    if place >= end {
        return Err(corrupt(end));
    }
    let (chain, keyframes) = match read_at(input, place)? {
        (tag::INDEX, payload) => decode_index(&payload).map_err(|_| corrupt(place))?,
        _ => return Err(corrupt(place)),
    };
    // With the chain that it names its check must fit.
    input.seek(SeekFrom::Start(place)).map_err(ReplayError::Io)?;
    RecordReader::at(&mut *input, place, chain).next()?;
    let sound = keyframes.is_sorted_by(|a, b| a.tick < b.tick && a.offset < b.offset);
    if !sound || keyframes.last().is_some_and(|last| last.offset >= place) {
        return Err(corrupt(place));
    }
    Ok(keyframes)
}

/// The tag and the payload of the record at a place, whose check nobody has looked at.
fn read_at(input: &mut (impl Read + Seek), place: u64) -> Result<(u8, Vec<u8>), ReplayError> {
    input.seek(SeekFrom::Start(place)).map_err(ReplayError::Io)?;
    let mut records = RecordReader::at(input, place, 0);
    match records.next_unchecked()? {
        Found::Record { tag, .. } => Ok((tag, records.payload().to_vec())),
        Found::End { .. } | Found::Cut => Err(ReplayError::Truncated { ticks: 0, offset: records.offset() }),
    }
}

/// A keyframe record, whole and checked: its head and state.
fn read_keyframe(input: &mut (impl Read + Seek), place: u64) -> Result<(Head, Vec<u8>), ReplayError> {
    let corrupt = |reason| ReplayError::Corrupt { tick: 0, offset: place, reason };
    let (found, payload) = read_at(input, place)?;
    if found != tag::KEYFRAME {
        return Err(corrupt("there is no keyframe where one is named"));
    }
    let decode = |error| ReplayError::Decode { tick: 0, offset: place, error };
    let (head, state) = Head::read(&payload).map_err(decode)?;
    // With the chain that it names its check must fit.
    input.seek(SeekFrom::Start(place)).map_err(ReplayError::Io)?;
    RecordReader::at(&mut *input, place, head.chain).next()?;
    Ok((head, state.to_vec()))
}

/// The world in the record at a place that keyframes refer to: a keyframe with a whole save, or that with which the replay begins.
fn read_base(input: &mut (impl Read + Seek), place: u64) -> Result<World, ReplayError> {
    if read_at(input, place)?.0 == tag::WORLD {
        input.rewind().map_err(ReplayError::Io)?;
        return Ok(Player::new(input)?.into_world());
    }
    let (head, save) = read_keyframe(input, place)?;
    if head.base != place {
        return Err(ReplayError::Corrupt {
            tick: 0,
            offset: place,
            reason: "the keyframe refers to one without a save",
        });
    }
    World::load(&save).map_err(|error| ReplayError::Decode { tick: head.tick, offset: place, error })
}

impl<R: Read + Seek> Player<R> {
    /// Goes on from a keyframe, as if all before had been played.
    ///
    /// Errors: a place where there is no keyframe, or one that is damaged.
    pub fn at(mut input: R, keyframe: &Keyframe) -> Result<Self, ReplayError> {
        let place = keyframe.offset;
        let (head, state) = read_keyframe(&mut input, place)?;
        let decode = |error| ReplayError::Decode { tick: head.tick, offset: place, error };
        let corrupt = |reason| ReplayError::Corrupt { tick: head.tick, offset: place, reason };
        if head.tick != keyframe.tick || head.history != keyframe.history {
            return Err(corrupt("the keyframe is not the one that the index names"));
        }
        let world = if head.base == place {
            World::load(&state).map_err(decode)?
        } else if head.base < place {
            let mut world = read_base(&mut input, head.base)?;
            let frame = Frame::decode(&state).map_err(decode)?;
            world.restore_frame(&frame).map_err(|_| corrupt("the keyframe is none of the world that it refers to"))?;
            world
        } else {
            return Err(corrupt("the keyframe refers to a later one"));
        };
        input.seek(SeekFrom::Start(place)).map_err(ReplayError::Io)?;
        let mut records = RecordReader::at(input, place, head.chain);
        records.next()?;
        Ok(Player::resumed(records, world, &head))
    }
}
