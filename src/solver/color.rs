//! Colours: contacts of one colour share no body that moves, so a sweep may solve them side by side.
//!
//! The colouring is part of the algorithm: it follows from the order of the contacts alone.

use super::rows::{Block, LANES};
use crate::num::lane::next;

/// Contacts of two bodies that move take the lowest free colour from 0 on, those with one take the lowest from
/// [`GROUND`] on, so that what stands on the ground is solved last and holds best.
const GROUND: u32 = 20;
const COLORS: u32 = 32;
/// Contacts that no colour is free for: one at a time, after the others.
pub(crate) const REST: usize = COLORS as usize;
/// Contacts that are solved directly: no sweep comes by.
const APART: usize = REST + 1;

/// Where each contact goes: block and lane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colors {
    /// By mover: the colours that its contacts have.
    used: Vec<u32>,
    /// By contact.
    color: Vec<u8>,
    /// By contact: 8·block + lane.
    pub(crate) seats: Vec<u32>,
    /// How many blocks there are, and how many of them, from the first on, are swept.
    pub(crate) blocks: usize,
    pub(crate) swept: usize,
}

impl Colors {
    /// Colours contacts, given in order as the places of their two bodies. Static and kinematic bodies do not move by
    /// contacts: `free` says, by place, that a body needs no colour of its own. Within a colour the `heavy` ones sit
    /// first: sweeps of their own then take few blocks. Those that are solved `apart`, if there are any, come last.
    pub(crate) fn assign(&mut self, places: &[[u32; 2]], free: &[bool], heavy: &[bool], apart: &[bool]) {
        self.used.clear();
        self.used.resize(free.len(), 0);
        self.color.clear();
        let mut counts = [0usize; APART + 1];
        for (at, &[a, b]) in places.iter().enumerate() {
            if apart.get(at).is_some_and(|&apart| apart) {
                self.color.push(APART as u8);
                counts[APART] = next(counts[APART]);
                continue;
            }
            let (a_free, b_free) = (free[a as usize], free[b as usize]);
            let of = |place: u32, free: bool| if free { 0 } else { self.used[place as usize] };
            let taken = of(a, a_free) | of(b, b_free);
            let from = if a_free || b_free { GROUND } else { 0 };
            let color = (!taken & (u32::MAX << from)).trailing_zeros() as usize;
            if color < REST {
                for (place, free) in [(a, a_free), (b, b_free)] {
                    if !free {
                        self.used[place as usize] |= 1 << color;
                    }
                }
            }
            self.color.push(color as u8);
            counts[color] = next(counts[color]);
        }
        // The first seat of each colour; every colour begins with a new block, the rest have one each.
        let mut seats = [0u32; APART + 1];
        let mut blocks = 0usize;
        for color in 0..=APART {
            self.swept = if color == APART { blocks } else { self.swept };
            seats[color] = (blocks as u32).saturating_mul(8);
            let size = if color == REST { counts[color] } else { counts[color].div_ceil(8) };
            blocks = blocks.saturating_add(size);
        }
        self.blocks = blocks;
        self.seats.clear();
        self.seats.resize(places.len(), 0);
        for first in [true, false] {
            let rows = self.seats.iter_mut().zip(&self.color).zip(heavy);
            for ((seat, &color), _) in rows.filter(|&(_, &heavy)| heavy == first) {
                let color = color as usize;
                *seat = seats[color];
                seats[color] = seats[color].saturating_add(if color == REST { 8 } else { 1 });
            }
        }
    }

    /// Whether the contacts of a block are solved directly.
    pub(crate) fn is_apart(&self, block: usize) -> bool {
        (self.swept..self.blocks).contains(&block)
    }

    /// A seat for a contact that comes after those of the tick, among others of its kind; in a new block if need be.
    pub(crate) fn late(&mut self, blocks: &mut Vec<Block>, places: [u32; 2], free: &[bool]) -> usize {
        let found = (self.blocks..blocks.len()).find_map(|at| Some((at, blocks[at].vacancy(places, free)?)));
        let (at, i) = found.unwrap_or((blocks.len(), 0));
        if at == blocks.len() {
            blocks.push(Block::default());
        }
        let seat = at.saturating_mul(LANES).saturating_add(i);
        self.seats.push(seat as u32);
        seat
    }
}
