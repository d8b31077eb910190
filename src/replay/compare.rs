//! Two recordings of one game: where they part, and what either of them knows of it.

use super::error::ReplayError;
use super::evidence::Evidence;
use super::keyframe::{Keyframe, read_index};
use super::player::Player;
use super::skim::{Rest, Skimmer, Tick};
use crate::world::Command;
use std::io::{Read, Seek};

/// What one recording knows of the tick at which it parts from another one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Account {
    /// The recorded hash.
    pub hash: u64,
    /// The commands before the tick.
    pub commands: Vec<Command>,
    /// Evidence of the tick that was taken as it happened.
    pub evidence: Option<Evidence>,
    /// The hashes of the state's parts, at the tick or the first one after it at which they were recorded: its number, as the world
    /// counts them, and nine hashes in the order of [`World::hash_parts`](crate::World::hash_parts).
    pub parts: Option<(u64, [u64; 9])>,
    /// The last place before the tick from which the recording can be played; `None`: its beginning.
    pub keyframe: Option<Keyframe>,
    /// The tick, as this recording counts them.
    pub recorded_tick: u64,
}

/// How two recordings compare.
#[derive(Clone, Debug, PartialEq)]
pub enum Comparison {
    /// They agree as far as both go.
    Same {
        /// The first tick that both have, as the world counts them.
        from: u64,
        /// The last one.
        to: u64,
    },
    /// They part at a tick.
    Parted {
        /// The tick, as the world counts them after its step.
        tick: u64,
        /// Whether it is the commands before the tick that differ: then the game gave its worlds different orders.
        by_commands: bool,
        /// What either knows.
        accounts: Box<[Account; 2]>,
    },
    /// They do not overlap: one ends before the other begins.
    Apart {
        /// The world's tick at which either begins.
        begins: [u64; 2],
    },
}

/// Compares two recordings of a game without playing them, by the keyframes of both if they begin alike: so it takes as long as reading
/// a minute of either.
///
/// Errors: the first of either file.
pub fn compare<R: Read + Seek>(inputs: [&mut R; 2]) -> Result<Comparison, (usize, ReplayError)> {
    let [a, b] = inputs;
    let places = common([&mut *a, &mut *b])?;
    let mut sides =
        [start(a, places[0]).map_err(|error| (0, error))?, start(b, places[1]).map_err(|error| (1, error))?];
    let begins = [0, 1].map(|side: usize| sides[side].now().tick);
    let first = begins[0].max(begins[1]);
    let go_on = |sides: &mut [Skimmer<&mut R>; 2], side: usize| sides[side].next().map_err(|error| (side, error));
    // The later one may begin in the middle of the other.
    for side in 0..2 {
        while sides[side].now().tick < first {
            if !go_on(&mut sides, side)? {
                return Ok(Comparison::Apart { begins });
            }
        }
    }
    let mut by_commands = false;
    loop {
        let [a, b] = &sides;
        let (a, b) = (a.now(), b.now());
        if by_commands || a.hash != b.hash || differ(a, b) {
            break;
        }
        if !go_on(&mut sides, 0)? || !go_on(&mut sides, 1)? {
            let to = [0, 1].map(|side: usize| sides[side].now().tick);
            return Ok(Comparison::Same { from: first, to: to[0].min(to[1]) });
        }
        by_commands = !sides[0].now().is_ordered_as(sides[1].now());
    }
    let tick = sides[0].now().tick;
    let mut accounts = [Account::default(), Account::default()];
    for (side, skimmer) in sides.into_iter().enumerate() {
        accounts[side] = account(skimmer).map_err(|error| (side, error))?;
    }
    Ok(Comparison::Parted { tick, by_commands, accounts: Box::new(accounts) })
}

/// Whether both have parts and they differ though the hash does not: memory that no command has looked at.
fn differ(a: &Tick, b: &Tick) -> bool {
    matches!((a.parts, b.parts), (Some(a), Some(b)) if a != b)
}

fn start<R: Read + Seek>(input: &mut R, place: Option<Keyframe>) -> Result<Skimmer<&mut R>, ReplayError> {
    input.rewind().map_err(ReplayError::Io)?;
    let player = match place {
        Some(keyframe) => Player::at(input, &keyframe)?,
        None => Player::new(input)?,
    };
    Ok(Skimmer::new(player, place))
}

/// The last pair of keyframes up to which two recordings that begin alike agree, found by halving; none if they agree to the end:
/// a difference in parts alone is in no history, and must be read for.
fn common<R: Read + Seek>(inputs: [&mut R; 2]) -> Result<[Option<Keyframe>; 2], (usize, ReplayError)> {
    let (mut begins, mut lists) = ([0; 2], [Vec::new(), Vec::new()]);
    for (side, input) in inputs.into_iter().enumerate() {
        let look = || {
            lists[side] = read_index(input)?;
            input.rewind().map_err(ReplayError::Io)?;
            begins[side] = Player::new(input)?.world().hash();
            Ok(())
        };
        look().map_err(|error| (side, error))?;
    }
    let [ours, theirs] = lists;
    let pair = |one: &Keyframe| {
        let at = theirs.binary_search_by_key(&one.tick, |other| other.tick).ok()?;
        Some([*one, theirs[at]])
    };
    let pairs: Vec<[Keyframe; 2]> = ours.iter().filter_map(pair).collect();
    let agree = pairs.partition_point(|[one, other]| one.history == other.history);
    let last = agree.checked_sub(1).filter(|_| begins[0] == begins[1] && agree < pairs.len());
    Ok(last.map_or([None; 2], |at| pairs[at].map(Some)))
}

/// What a recording knows of the tick that was read last.
fn account<R: Read>(skimmer: Skimmer<R>) -> Result<Account, ReplayError> {
    let (now, keyframe) = (skimmer.now().clone(), skimmer.keyframe());
    let Rest { evidence, parts } = skimmer.rest()?;
    let (hash, commands, recorded_tick) = (now.hash, now.commands(), now.recorded);
    Ok(Account { hash, commands, evidence, parts, keyframe, recorded_tick })
}

/// What this build makes of a tick of a recording: evidence, computed again from the last keyframe before it. `tick` is counted from
/// the start of the recording.
///
/// Errors: those of playing up to the tick; a recording that is shorter.
pub fn recompute<R: Read + Seek>(input: &mut R, tick: u64) -> Result<Evidence, ReplayError> {
    let keyframes = read_index(input)?;
    let before = keyframes.partition_point(|keyframe| keyframe.tick < tick);
    let keyframe = before.checked_sub(1).map(|at| keyframes[at]);
    input.rewind().map_err(ReplayError::Io)?;
    let mut player = match keyframe {
        Some(keyframe) => Player::at(&mut *input, &keyframe)?,
        None => Player::new(&mut *input)?,
    };
    while player.ticks().saturating_add(1) < tick {
        if player.step()?.is_none() {
            break;
        }
    }
    let mut evidence = None;
    if tick > 0 && player.ticks().saturating_add(1) == tick {
        player.step_by(|world| evidence = Some(Evidence::of_step(world)))?;
    }
    let ticks = player.ticks();
    evidence.ok_or(ReplayError::NoSuchTick { tick, ticks })
}
