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

/// No contact.
pub(crate) const VACANT: u32 = u32::MAX;

/// Where each contact goes: block and lane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colors {
    /// By mover: the colours that its contacts have.
    used: Vec<u32>,
    /// By contact.
    color: Vec<u8>,
    /// By contact: 8·block + lane.
    pub(crate) seats: Vec<u32>,
    /// By seat: the contact, or [`VACANT`].
    pub(crate) sitting: Vec<u32>,
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
        // By colour, of those that are not heavy, and of those that are.
        let mut counts = [[0usize; 2]; APART + 1];
        for (at, (&[a, b], &heavy)) in places.iter().zip(heavy).enumerate() {
            let heavy = usize::from(heavy);
            if apart.get(at).is_some_and(|&apart| apart) {
                self.color.push(APART as u8);
                counts[APART][heavy] = next(counts[APART][heavy]);
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
            counts[color][heavy] = next(counts[color][heavy]);
        }
        // The first seats of each colour; every colour begins with a new block, the rest have one each.
        let mut seats = [[0u32; 2]; APART + 1];
        let mut blocks = 0usize;
        for color in 0..=APART {
            self.swept = if color == APART { blocks } else { self.swept };
            let [light, heavy] = counts[color];
            // How many sit in a block, and how far apart seats are.
            let (width, pitch) = if color == REST { (1, LANES) } else { (LANES, 1) };
            let size = light.saturating_add(heavy);
            let first = blocks.saturating_mul(LANES);
            seats[color] = [first.saturating_add(heavy.saturating_mul(pitch)), first].map(|seat| seat as u32);
            blocks = blocks.saturating_add(size.div_ceil(width));
        }
        self.blocks = blocks;
        self.sitting.clear();
        self.sitting.resize(blocks.saturating_mul(LANES), VACANT);
        self.seats.clear();
        for (row, (&color, &heavy)) in self.color.iter().zip(heavy).enumerate() {
            let next = &mut seats[color as usize][usize::from(heavy)];
            self.seats.push(*next);
            self.sitting[*next as usize] = row as u32;
            *next = next.saturating_add(if color as usize == REST { LANES as u32 } else { 1 });
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
