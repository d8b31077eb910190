//! Reading a recording tick by tick without playing it.

use super::error::ReplayError;
use super::evidence::Evidence;
use super::keyframe::Keyframe;
use super::player::{Player, Step};
use crate::store::{Reader, Record};
use crate::world::Command;
use std::io::Read;

/// A tick as recorded.
#[derive(Clone, Default)]
pub(super) struct Tick {
    /// As the world counts them.
    pub(super) tick: u64,
    /// As the recording does.
    pub(super) recorded: u64,
    pub(super) hash: u64,
    /// The commands' bytes.
    commands: Vec<u8>,
    /// The hashes of the parts, if they were recorded at this tick.
    pub(super) parts: Option<[u64; 9]>,
}

impl Tick {
    pub(super) fn commands(&self) -> Vec<Command> {
        let mut reader = Reader::new(&self.commands);
        let next = || if reader.remaining() > 0 { Command::load(&mut reader, "command").ok() } else { None };
        core::iter::from_fn(next).collect()
    }

    /// Whether two ticks have the same commands.
    pub(super) fn is_ordered_as(&self, other: &Tick) -> bool {
        self.commands == other.commands
    }
}

/// What a recording says of a tick behind it.
pub(super) struct Rest {
    pub(super) evidence: Option<Evidence>,
    pub(super) parts: Option<(u64, [u64; 9])>,
}

/// Reads ticks of a recording, each with what is recorded between it and the next.
pub(super) struct Skimmer<R> {
    player: Player<R>,
    /// How many ticks the world had before the recording.
    begun: u64,
    /// The tick read last and the one behind it, that was read to find its end.
    now: Tick,
    ahead: Option<Tick>,
    /// The last keyframe before the tick read last; and the last one read.
    keyframe: Option<Keyframe>,
    found: Option<Keyframe>,
    /// Of the tick that is wanted, else of the tick read last; one of each is enough, however often an alarm rang.
    evidence: Option<Evidence>,
    wanted: Option<u64>,
}

impl<R: Read> Skimmer<R> {
    /// `place`: the keyframe that the player comes from.
    pub(super) fn new(player: Player<R>, place: Option<Keyframe>) -> Self {
        let (world, recorded) = (player.world(), player.ticks());
        let begun = world.tick().saturating_sub(recorded);
        let now = Tick { tick: world.tick(), recorded, hash: world.hash(), ..Tick::default() };
        Skimmer { player, begun, now, ahead: None, keyframe: place, found: place, evidence: None, wanted: None }
    }

    /// The tick read last; at first that with which it begins.
    pub(super) fn now(&self) -> &Tick {
        &self.now
    }

    /// The last keyframe before it.
    pub(super) fn keyframe(&self) -> Option<Keyframe> {
        self.keyframe
    }

    /// Goes on to the next tick. Whether there is one.
    pub(super) fn next(&mut self) -> Result<bool, ReplayError> {
        if self.ahead.is_none() && !self.look_ahead()? {
            return Ok(false);
        }
        self.keyframe = self.found;
        self.evidence = self.evidence.take().filter(|_| self.wanted.is_some());
        self.now = core::mem::take(&mut self.ahead).unwrap_or_default();
        self.look_ahead()?;
        Ok(true)
    }

    /// Reads up to the next tick, and gives what is before it to the present one.
    fn look_ahead(&mut self) -> Result<bool, ReplayError> {
        while let Some(step) = self.player.read()? {
            match step {
                Step::Tick { is_tick: true, hash, .. } => {
                    let commands = self.player.payload().get(8..).unwrap_or(&[]).to_vec();
                    self.player.skip_tick();
                    let recorded = self.player.ticks();
                    let tick = self.begun.saturating_add(recorded);
                    self.ahead = Some(Tick { tick, recorded, hash, commands, parts: None });
                    return Ok(true);
                }
                Step::Tick { .. } | Step::Other => {}
                Step::Keyframe { offset, head } => {
                    self.found = Some(Keyframe { tick: head.tick, offset, history: head.history });
                }
                Step::Parts { .. } => {
                    let mut reader = Reader::new(self.player.payload());
                    self.now.parts = Some([(); 9].map(|()| reader.take("part").unwrap_or(0)));
                }
                Step::Evidence { offset } => {
                    let decode = |error| ReplayError::Decode { tick: self.player.ticks(), offset, error };
                    let evidence = Evidence::decode(self.player.payload()).map_err(decode)?;
                    let wanted = self.wanted.unwrap_or(self.now.tick);
                    if self.evidence.is_none() && evidence.tick() == wanted {
                        self.evidence = Some(evidence);
                    }
                }
            }
        }
        Ok(false)
    }

    /// Reads the rest for the evidence of the tick read last, and for parts at it or after it.
    pub(super) fn rest(mut self) -> Result<Rest, ReplayError> {
        self.wanted = Some(self.now.tick);
        let mut parts = None;
        loop {
            parts = parts.or(self.now.parts.map(|parts| (self.now.tick, parts)));
            if !self.next()? {
                return Ok(Rest { evidence: self.evidence, parts });
            }
        }
    }
}
