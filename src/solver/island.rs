//! Hard islands: bodies that hang together by contacts of which one bears a load that rows would yield to.
//!
//! Found anew each tick, from the contacts in order and what the last tick left of them, so ids have no say but for order.

use super::constraints::overlap;
use super::direct::GIVEN_UP;
use super::mobility::Mobility;
use super::scales::Scales;
use crate::body::Bodies;
use crate::contact::{Contact, Pair};
use crate::num::{Velocity, lane::next};

/// What an island has at most, contacts: beyond, a direct solve costs more than it is worth.
pub(crate) const MOST: u32 = 80;
/// How fast two bodies may pass each other and are still said to stand: 1/4 m/s, Q48; beyond twice that their island is swept. A
/// falling heap is loaded by blows, of which each lasts a tick: solved directly, 100 bodies once took 9 ms.
const CALM: i64 = 1 << 46;
const NONE: u32 = u32::MAX;

/// What a contact says about its island.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Vote {
    None,
    /// It bears so much, or overlaps so deep, that the island is hard.
    Hard,
    /// It is not to be solved directly, whatever it bears.
    Sweep,
}

/// Which contacts are solved directly.
#[derive(Clone, Debug, Default)]
pub(crate) struct Islands {
    /// By contact, whether it is of a hard island; empty if there is none.
    pub(crate) apart: Vec<bool>,
    /// By place of a body: another one of its island, nearer to the one that stands for it.
    leader: Vec<u32>,
    /// By place, of those that stand for an island: how many contacts it has, their vote, and its place
    /// among the hard islands.
    count: Vec<u32>,
    hard: Vec<Vote>,
    number: Vec<u32>,
    /// By place: how many contacts lie between a body and what does not move.
    level: Vec<u32>,
    /// By hard island: its contacts, from what does not move on.
    members: Vec<Vec<u32>>,
    /// By hard island: its highest level.
    depth: Vec<u32>,
    found: usize,
}

impl Islands {
    /// Finds the hard islands. `places`: of each contact's bodies; `free`: by place, what impulses leave as it is; `votes`: by
    /// contact.
    pub(crate) fn find(&mut self, places: &[[u32; 2]], free: &[bool], votes: &[Vote]) {
        self.apart.clear();
        self.found = 0;
        if !votes.contains(&Vote::Hard) {
            return;
        }
        self.lead(places, free);
        self.count.clear();
        self.count.resize(free.len(), 0);
        self.hard.clear();
        self.hard.resize(free.len(), Vote::None);
        self.number.clear();
        self.number.resize(free.len(), NONE);
        for (&pair, &vote) in places.iter().zip(votes).filter(|&(&pair, _)| !free[moving(pair, free) as usize]) {
            let leader = leader_of(&mut self.leader, moving(pair, free)) as usize;
            self.count[leader] = self.count[leader].saturating_add(1);
            let island = &mut self.hard[leader];
            *island = match (*island, vote) {
                (Vote::Sweep, _) | (_, Vote::Sweep) => Vote::Sweep,
                (Vote::Hard, _) | (_, Vote::Hard) => Vote::Hard,
                _ => Vote::None,
            };
        }
        self.apart.resize(places.len(), false);
        for (at, &pair) in places.iter().enumerate() {
            let leader = leader_of(&mut self.leader, moving(pair, free)) as usize;
            if free[leader] || self.hard[leader] != Vote::Hard || self.count[leader] > MOST {
                continue;
            }
            if self.number[leader] == NONE {
                self.number[leader] = self.found as u32;
                if self.members.len() == self.found {
                    self.members.push(Vec::new());
                }
                self.members[self.found].clear();
                self.found = next(self.found);
            }
            self.members[self.number[leader] as usize].push(at as u32);
            self.apart[at] = true;
        }
        self.level.clear();
        self.level.resize(free.len(), NONE);
        self.depth.clear();
        for members in &mut self.members[..self.found] {
            self.depth.push(order(members, places, free, &mut self.level));
        }
    }

    /// The contacts of each hard island, from what does not move on, and its highest level.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = (&[u32], u32)> {
        self.members[..self.found].iter().map(Vec::as_slice).zip(self.depth.iter().copied())
    }

    /// Joins what contacts hold together.
    fn lead(&mut self, places: &[[u32; 2]], free: &[bool]) {
        self.leader.clear();
        self.leader.extend(0..free.len() as u32);
        for &[a, b] in places.iter().filter(|pair| !pair.map(|place| free[place as usize]).contains(&true)) {
            unite(&mut self.leader, [a, b]);
        }
    }
}

/// One of two bodies that impulses move; the other one if they move neither.
fn moving([a, b]: [u32; 2], free: &[bool]) -> u32 {
    if free[a as usize] { b } else { a }
}

/// The body that stands for an island; paths to it get shorter.
pub(super) fn leader_of(leader: &mut [u32], mut place: u32) -> u32 {
    while leader[place as usize] != place {
        let up = leader[leader[place as usize] as usize];
        leader[place as usize] = up;
        place = up;
    }
    place
}

/// Lets the lower one of two leaders stand for both.
pub(super) fn unite(leader: &mut [u32], places: [u32; 2]) {
    let [a, b] = places.map(|place| leader_of(leader, place));
    leader[a.max(b) as usize] = a.min(b);
}

/// Orders an island's contacts by levels, so that what touches is near each other. The highest level.
fn order(members: &mut [u32], places: &[[u32; 2]], free: &[bool], level: &mut [u32]) -> u32 {
    let grounded = |at: &u32| places[*at as usize].into_iter().any(|place| free[place as usize]);
    if let (false, Some(&first)) = (members.iter().any(grounded), members.first()) {
        level[places[first as usize][0] as usize] = 1;
    }
    // As many times as there are levels.
    let mut changed = true;
    while changed {
        changed = false;
        for &at in &*members {
            let [a, b] = places[at as usize];
            let of = |place: u32| if free[place as usize] { 0 } else { level[place as usize] };
            let [over_a, over_b] = [of(a), of(b)].map(|level| level.saturating_add(1));
            for (place, over) in [(a, over_b), (b, over_a)] {
                if !free[place as usize] && over < level[place as usize] {
                    level[place as usize] = over;
                    changed = true;
                }
            }
        }
    }
    let levels =
        |at: u32| places[at as usize].map(|place| if free[place as usize] { 0 } else { level[place as usize] });
    members.sort_unstable_by_key(|&at| {
        let levels = levels(at);
        (levels[0].max(levels[1]), levels[0].min(levels[1]), at)
    });
    members.last().map_or(1, |&at| levels(at)[0].max(levels(at)[1]))
}

/// Whether a pair bears so much, or overlaps so deep, that its island may be hard.
#[inline]
pub(super) fn hard(overlap: i64, old: &Contact, scales: &Scales) -> bool {
    Scales::is_hard(old.normal, old.mode > 0) || overlap > scales.deep
}

/// What a pair says about how its island is to be solved. What a kinematic body presses while it moves may have no solution.
pub(super) fn vote(pair: &Pair, old: &Contact, bodies: &Bodies, mobilities: &[Mobility], scales: &Scales) -> Vote {
    let hard = hard(overlap(pair), old, scales);
    let presses = |&slot: &u32| {
        let (at, mobility) = (slot as usize, &mobilities[slot as usize]);
        let v = bodies.velocity(at);
        let speeds = [v.x.to_bits(), v.y.to_bits(), bodies.omega.get(at).to_bits()];
        !mobility.moves() && !mobility.fixed && speeds != [0; 3]
    };
    let [a, b] = pair.bodies.map(|slot| bodies.velocity(slot as usize));
    let apart = |a: Velocity, b: Velocity| a.to_bits().saturating_sub(b.to_bits()).saturating_abs() >> scales.shift;
    let passing = apart(a.x, b.x).max(apart(a.y, b.y));
    match hard && passing < CALM {
        _ if old.mode == GIVEN_UP || passing > CALM << 1 => Vote::Sweep,
        true if pair.bodies.iter().any(presses) => Vote::Sweep,
        true => Vote::Hard,
        false => Vote::None,
    }
}
