//! What was seen of pairs: kept for as long as nothing of what it was made of has changed.
//!
//! A memory of a function's values, each with all that it is a value of: so it has no say, whatever it holds, and may be empty at
//! any time. In a pile that has come to rest nearly every pair is what it was a tick before, to the bit.

use crate::narrow::Near;

/// What was seen of a pair.
#[derive(Clone, Debug, Default)]
pub(super) struct Look {
    pub(super) colliders: [u32; 2],
    /// The tick in which; outlines turned since are others.
    pub(super) tick: u64,
    /// Where b's centre was from a's, Q32 m.
    pub(super) d: [i64; 2],
    pub(super) near: Near,
}

/// What was seen in the last tick, and what is seen in this one. Ordered by colliders.
#[derive(Debug, Default)]
pub(super) struct Looks {
    /// Of this tick up to `written`, from `read` on of the last one.
    list: Vec<Look>,
    read: usize,
    written: usize,
    /// Of this tick, of pairs that were not seen in the last one.
    added: Vec<Look>,
}

impl Looks {
    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    pub(super) fn begin(&mut self) {
        (self.read, self.written) = (0, 0);
        self.added.clear();
    }

    /// What was seen of the next pair of this tick, if it was seen in the last one; else what was seen in tick 0.
    #[inline]
    pub(super) fn next(&mut self, colliders: [u32; 2]) -> &mut Look {
        while self.list.get(self.read).is_some_and(|look| look.colliders < colliders) {
            self.read = self.read.saturating_add(1);
        }
        if self.list.get(self.read).is_none_or(|look| look.colliders != colliders) {
            self.added.push(Look { colliders, ..Look::default() });
            let last = self.added.len().saturating_sub(1);
            return &mut self.added[last];
        }
        let (read, written) = (self.read, self.written);
        if written < read {
            self.list.swap(written, read);
        }
        (self.read, self.written) = (read.saturating_add(1), written.saturating_add(1));
        &mut self.list[written]
    }

    /// Puts what was added in its place, from the back, so that nothing is in the way.
    pub(super) fn end(&mut self) {
        self.list.truncate(self.written);
        let (mut kept, mut end) = (self.written, self.written.saturating_add(self.added.len()));
        self.list.resize_with(end, Look::default);
        while let Some(look) = self.added.last() {
            end = end.saturating_sub(1);
            if kept > 0 && self.list[kept.saturating_sub(1)].colliders > look.colliders {
                kept = kept.saturating_sub(1);
                self.list.swap(kept, end);
            } else if let Some(look) = self.added.pop() {
                self.list[end] = look;
            }
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Look> {
        self.list.iter()
    }
}
