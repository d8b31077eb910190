//! Reading records in their order, and all that can be checked of them without playing.

use super::{Player, Step};
use crate::replay::error::ReplayError;
use crate::replay::evidence::Evidence;
use crate::replay::format::{Found, tag};
use crate::replay::keyframe::{Head, Keyframe, decode_index, history};
use crate::store::{Reader, Record};
use crate::world::Command;
use std::io::Read;

/// What stands for a list of keyframes: nothing of a file is kept whole.
fn list(before: u64, keyframe: &Keyframe) -> u64 {
    let Keyframe { tick, offset, history: past } = keyframe;
    [tick, offset, past].iter().fold(before, |hash, value| history(hash, &value.to_le_bytes()))
}

impl<R: Read> Player<R> {
    /// Reads the next record and everything in it that can be checked without playing; `None` at the end.
    pub(in crate::replay) fn read(&mut self) -> Result<Option<Step>, ReplayError> {
        let read = self.read_record().map_err(|error| match error {
            // What a file that was cut off holds is whole ticks; everything else is wrong in the tick being read.
            ReplayError::Truncated { .. } => error.at(self.ticks),
            error => error.at(self.ticks.saturating_add(1)),
        })?;
        self.has_commands = matches!(read, Some(Step::Tick { .. }));
        let Some(Step::Tick { offset, is_tick, is_idle, .. }) = read else { return Ok(read) };
        let tick = self.ticks.saturating_add(1);
        let decode = |error| ReplayError::Decode { tick, offset, error };
        let mut reader = Reader::new(self.records.payload());
        let hash = reader.take("hash").map_err(decode)?;
        while reader.remaining() > 0 {
            Command::load(&mut reader, "command").map_err(decode)?;
            self.commands = self.commands.saturating_add(1);
        }
        self.history = history(self.history, self.records.payload());
        Ok(Some(Step::Tick { offset, is_tick, is_idle, hash }))
    }

    fn read_record(&mut self) -> Result<Option<Step>, ReplayError> {
        let corrupt = |offset, reason| Err(ReplayError::Corrupt { tick: 0, offset, reason });
        while !self.finished {
            let chain = self.records.chain();
            match self.records.next()? {
                Found::Record { tag: tag::IDLE | tag::TICK | tag::TAIL, offset } if self.had_tail => {
                    return corrupt(offset, "there is a tick after the tail");
                }
                Found::Record { tag: tag::IDLE | tag::TICK | tag::TAIL, offset } if self.index > 0 => {
                    return corrupt(offset, "there is a tick after the index");
                }
                Found::Record { tag: tag @ (tag::IDLE | tag::TICK), offset } => {
                    return Ok(Some(Step::Tick { offset, is_tick: true, is_idle: tag == tag::IDLE, hash: 0 }));
                }
                Found::Record { tag: tag::TAIL, offset } => {
                    self.had_tail = true;
                    return Ok(Some(Step::Tick { offset, is_tick: false, is_idle: false, hash: 0 }));
                }
                Found::Record { tag: tag::KEYFRAME, offset } => return self.read_keyframe(offset, chain).map(Some),
                Found::Record { tag: tag::PARTS, offset } if self.records.payload().len() != 72 => {
                    return corrupt(offset, "the parts are not nine hashes");
                }
                Found::Record { tag: tag::PARTS, offset } => return Ok(Some(Step::Parts { offset })),
                Found::Record { tag: tag::EVIDENCE, offset } => {
                    let decoded = Evidence::decode(self.records.payload());
                    decoded.map_err(|error| ReplayError::Decode { tick: 0, offset, error })?;
                    return Ok(Some(Step::Evidence { offset }));
                }
                Found::Record { tag: tag::INDEX, offset } => {
                    self.read_index(offset, chain)?;
                    return Ok(Some(Step::Other));
                }
                Found::Record { tag: tag::ANCILLARY.., .. } => return Ok(Some(Step::Other)),
                Found::Record { tag: tag::WORLD, offset } => return corrupt(offset, "there is a second world"),
                Found::Record { tag, offset } => return Err(ReplayError::UnknownRecord { tick: 0, offset, tag }),
                Found::Cut => return Err(ReplayError::Truncated { ticks: 0, offset: self.records.offset() }),
                Found::End { ticks, .. } if ticks != self.ticks => {
                    return corrupt(self.records.offset(), "the end counts other ticks");
                }
                Found::End { index, .. } if index != self.index => {
                    return corrupt(self.records.offset(), "the end names another index");
                }
                Found::End { .. } => self.finished = true,
            }
        }
        Ok(None)
    }

    fn read_keyframe(&mut self, offset: u64, chain: u64) -> Result<Step, ReplayError> {
        let decode = |error| ReplayError::Decode { tick: 0, offset, error };
        let (head, _) = Head::read(self.records.payload()).map_err(decode)?;
        let expected =
            Head { tick: self.ticks, commands: self.commands, history: self.history, chain, base: head.base };
        if head != expected || self.had_tail {
            return Err(ReplayError::Corrupt { tick: 0, offset, reason: "the keyframe is not of this place" });
        }
        // Keyframes are found by their ticks.
        if head.tick <= self.marked {
            let reason = "a keyframe is not behind a tick, or there are two behind one";
            return Err(ReplayError::Corrupt { tick: 0, offset, reason });
        }
        self.marked = head.tick;
        if head.base == offset {
            self.base = Some(offset);
        } else if self.base != Some(head.base) {
            return Err(ReplayError::Corrupt {
                tick: 0,
                offset,
                reason: "the keyframe refers to another one than the last whole one",
            });
        }
        self.seen = list(self.seen, &Keyframe { tick: head.tick, offset, history: head.history });
        Ok(Step::Keyframe { offset, head })
    }

    /// An index must list the keyframes before it, whole and in order; of a player that went on from one it is not known.
    fn read_index(&mut self, offset: u64, chain: u64) -> Result<(), ReplayError> {
        let decode = |error| ReplayError::Decode { tick: 0, offset, error };
        let (before, keyframes) = decode_index(self.records.payload()).map_err(decode)?;
        let listed = keyframes.iter().fold(0, list);
        if before != chain || self.index > 0 || !self.is_resumed && listed != self.seen {
            return Err(ReplayError::Corrupt { tick: 0, offset, reason: "the index does not list the keyframes" });
        }
        self.index = offset;
        Ok(())
    }
}
