//! The constraints of a tick: which pairs are pressed together by rows, and which come so fast that they strike instead.

use super::Solver;
use super::fast::{strikes, swings};
use super::island::{Vote, hard, vote};
use super::scales::Scales;
use super::turning::turns;
use crate::body::Bodies;
use crate::contact::{Contacts, NEW, Pair};
use crate::motion::Drive;
use crate::threads::Crew;

/// So many pairs make a piece: 4 µs.
const PAIRS: usize = 512;

/// What two ways of computing how far two bodies overlap may differ by: 10 nm, Q32 m.
const ROUNDING: i64 = 43;

/// The contacts that have rows, in order.
#[derive(Debug, Default)]
pub(crate) struct Constraints {
    /// The places of its bodies among the movers, and its place among the pairs.
    pub(crate) places: Vec<[u32; 2]>,
    pub(crate) pairs: Vec<u32>,
    /// Whether it is heavy, and whether it squeezes.
    pub(crate) heavy: Vec<bool>,
    pub(crate) squeezed: Vec<bool>,
    /// How it was solved.
    pub(crate) modes: Vec<u8>,
    /// What it says of how its island is to be solved; empty if none asks for a direct solve.
    pub(crate) votes: Vec<Vote>,
}

impl Constraints {
    fn clear(&mut self) {
        let Constraints { places, pairs, heavy, squeezed, modes, votes } = self;
        places.clear();
        pairs.clear();
        heavy.clear();
        squeezed.clear();
        modes.clear();
        votes.clear();
    }
}

impl Solver {
    /// Finds which pairs strike. The bodies of all others are movers from here on, as are those of pairs that strike where rows stop
    /// them as well.
    pub(super) fn part(&mut self, pairs: &mut [Pair], bodies: &Bodies, drive: &Drive, crew: Crew) {
        let Solver { mobilities, scales, coming, movers, fast, repose, .. } = self;
        let swings = |pair: &Pair| swings(pair, bodies, drive, mobilities, scales);
        coming.resize(pairs.len(), false);
        crew.share((&*pairs, coming.as_mut_slice()), PAIRS, |(pairs, coming)| {
            for (pair, coming) in pairs.iter().zip(coming) {
                let strikes = || strikes(pair, bodies, drive, scales, false);
                *coming = !pair.stays && (pair.manifold.count == 0 || strikes() || swings(pair));
            }
        });
        fast.clear();
        for (at, pair) in pairs.iter().enumerate().filter(|(_, pair)| !pair.sensor) {
            if coming[at] {
                fast.push(at as u32);
            } else {
                // What others lie on that stay is known to rows all the same.
                for slot in pair.bodies.into_iter().filter(|&slot| !(pair.stays && repose.holds(slot))) {
                    movers.place(slot, bodies, &mobilities[slot as usize], scales);
                }
            }
        }
        // Among others, what does not bounce is stopped by rows as well, and in piles for less; and more is slow.
        fast.retain(|&at| {
            let pair = &pairs[at as usize];
            let among = pair.bodies.iter().all(|&slot| movers.place_of(slot) != 0);
            let strikes = || strikes(pair, bodies, drive, scales, true);
            !among || pair.manifold.count == 0 || pair.restitution > 0 && (strikes() || swings(pair))
        });
        for &at in &*fast {
            let pair = &mut pairs[at as usize];
            let deepest = overlap(pair);
            pair.met = deepest >= 0;
            pair.depth = deepest.max(0).saturating_add(ROUNDING);
            pair.manifold.count = 0;
        }
    }

    /// Lists the pairs that have rows, and those whose rows are made anew in each substep.
    pub(super) fn constrain(&mut self, pairs: &mut [Pair], contacts: &Contacts, bodies: &Bodies) {
        let Solver { mobilities, scales, movers, constraints, turning, .. } = self;
        constraints.clear();
        // Without a hard contact nobody asks for votes.
        let mut any_hard = false;
        // A sensor's pair has no points.
        for (at, pair) in pairs.iter_mut().enumerate().filter(|(_, pair)| pair.manifold.count > 0 && !pair.stays) {
            pair.row = constraints.places.len() as u32;
            // All that move have one by now.
            constraints.places.push(pair.bodies.map(|slot| movers.place_of(slot)));
            constraints.pairs.push(at as u32);
            let old = pair.last(contacts);
            let overlap = overlap(pair);
            constraints.heavy.push(Scales::is_heavy(old.normal));
            constraints.squeezed.push(scales.is_squeezed(old.normal, overlap));
            constraints.modes.push(old.mode);
            any_hard |= hard(overlap, &old, scales);
        }
        if any_hard {
            let vote = |&at: &u32| {
                let pair = &pairs[at as usize];
                vote(pair, &pair.last(contacts), bodies, mobilities, scales)
            };
            constraints.votes.extend(constraints.pairs.iter().map(vote));
        }
        turning.clear();
        if movers.turns {
            let turn = |pair: &Pair| pair.row != NEW && turns(pair, bodies, mobilities, scales);
            turning.extend(pairs.iter().enumerate().filter(|(_, pair)| turn(pair)).map(|(at, _)| at as u32));
        }
    }
}

/// By how much a pair overlaps, Q32 m; negative by the gap, and nothing is as far as one without points.
pub(super) fn overlap(pair: &Pair) -> i64 {
    let points = &pair.manifold.points[..pair.manifold.count as usize];
    points.iter().map(|point| point.separation.saturating_neg()).max().unwrap_or(i64::MIN)
}
