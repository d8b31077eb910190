//! What went out of range, for as long as nobody clears it.

pub use crate::motion::Bound;
use crate::store::{BodyId, record};

/// A body that a step had to limit.
#[derive(Debug, PartialEq, Eq)]
pub struct StatusEntry {
    /// The tick whose step limited it.
    pub tick: u64,
    /// Which body.
    pub body: BodyId,
    /// In what.
    pub bound: Bound,
}

record!(StatusEntry { tick, body, bound } shown);

impl core::fmt::Display for StatusEntry {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "tick {}: {} was limited in its {}", self.tick, self.body, self.bound)
    }
}

/// The first body that ran into each bound. Sticky: it stays until [`Command::ClearStatus`](crate::Command), is
/// saved, and is part of the hash.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Status {
    entries: Vec<StatusEntry>,
}

record!(Status { entries });

impl Status {
    /// Whether nothing was limited.
    pub fn is_clear(&self) -> bool {
        self.entries.is_empty()
    }

    /// At most one entry per bound, in the order in which they occurred.
    pub fn entries(&self) -> &[StatusEntry] {
        &self.entries
    }

    pub(crate) fn note(&mut self, tick: u64, body: BodyId, bound: Bound) {
        if self.entries.iter().all(|entry| entry.bound != bound) {
            self.entries.push(StatusEntry { tick, body, bound });
        }
    }

    /// The entries as memory has them, for faults.
    #[cfg(test)]
    pub(crate) fn memory(&mut self) -> &mut [StatusEntry] {
        &mut self.entries
    }

    pub(crate) fn clear(&mut self) {
        self.entries.clear();
    }

    /// Whether no bound has two entries.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        let twice = |(at, entry): (usize, &StatusEntry)| self.entries[..at].iter().any(|e| e.bound == entry.bound);
        if self.entries.iter().enumerate().any(twice) { Err("names a bound twice") } else { Ok(()) }
    }
}
