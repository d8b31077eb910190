//! All rows of a tick, block by block.

use super::super::color::{Colors, VACANT};
use super::super::kernel::Kernel;
use super::super::mobility::Mobility;
use super::super::rows::{Block, LANES};
use super::super::scales::Scales;
use super::{Joint, Joints};
use crate::body::Bodies;
use crate::contact::{Contact, Contacts, Pair};
use crate::threads::{Crew, Cut};

/// What rows are made of.
pub(crate) struct Basis<'s> {
    pub(crate) pairs: &'s [Pair],
    /// By contact: its pair, the places of its bodies among the movers, and whether it is heavy.
    pub(crate) rows: &'s [u32],
    pub(crate) places: &'s [[u32; 2]],
    pub(crate) heavy: &'s [bool],
    /// Of the last tick.
    pub(crate) contacts: &'s Contacts,
    pub(crate) bodies: &'s Bodies,
    pub(crate) mobilities: &'s [Mobility],
    pub(crate) scales: &'s Scales,
}

/// So many blocks make a piece: 6 µs.
const BLOCKS: usize = 32;

/// Who sits in blocks, by seat.
struct Seats<'s>(&'s [u32]);

impl Cut for Seats<'_> {
    fn len(&self) -> usize {
        self.0.len() / LANES
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let (before, after) = self.0.split_at(at.saturating_mul(LANES));
        (Seats(before), Seats(after))
    }
}

/// What a contact's rows are made of.
struct Part<'s> {
    pair: &'s Pair,
    places: [u32; 2],
    /// From a's centre to b's.
    between: [i64; 2],
    mobility: [&'s Mobility; 2],
    old: Contact,
}

impl<'s> Basis<'s> {
    /// Writes every contact where it sits.
    pub(crate) fn write(&self, blocks: &mut [Block], colors: &Colors, kernel: Kernel, crew: Crew) {
        crew.share((blocks, Seats(&colors.sitting)), BLOCKS, |(blocks, seats)| self.write_piece(blocks, seats, kernel));
    }

    fn write_piece(&self, blocks: &mut [Block], Seats(sitting): Seats<'_>, kernel: Kernel) {
        // Two in turn: numbers that were put down one by one cannot be taken up side by side at once.
        let mut joints = [Joints::default(), Joints::default()];
        let mut seats = sitting.chunks_exact(LANES);
        let mut before: &[u32] = &[];
        for at in 0..=blocks.len() {
            let sitting = seats.next().unwrap_or(&[]);
            let [one, other] = &mut joints;
            let (now, last) = if at % 2 == 0 { (one, other) } else { (other, one) };
            if let Some(block) = blocks.get_mut(at) {
                self.seat(now, block, sitting);
            }
            if let Some(block) = at.checked_sub(1).and_then(|at| blocks.get_mut(at)) {
                let left = kernel.prepare(last, block, self.scales.shift);
                if left != 0 {
                    self.write_alone(block, before, left);
                }
            }
            before = sitting;
        }
    }

    /// Takes up the contacts of a block.
    #[inline(always)]
    fn seat(&self, joints: &mut Joints, block: &mut Block, sitting: &[u32]) {
        block.clear();
        for (i, &row) in sitting.iter().enumerate().filter(|&(_, &row)| row != VACANT) {
            let Part { pair, places, between, mobility, old } = self.part(row);
            (block.bodies[0][i], block.bodies[1][i]) = (places[0], places[1]);
            block.heavy |= u8::from(self.heavy[row as usize]) << i;
            joints.seat(i, pair, places, between, mobility, &old);
        }
    }

    /// Writes the contacts that are left over of a block.
    #[cold]
    #[inline(never)]
    fn write_alone(&self, block: &mut Block, sitting: &[u32], left: u8) {
        for (i, &row) in sitting.iter().enumerate().filter(|&(i, &row)| row != VACANT && left >> i & 1 != 0) {
            let Part { pair, places, between, mobility, old } = self.part(row);
            let joint = Joint::new(pair, places, [between; 2], mobility);
            joint.write(block, i, &old, pair.friction, self.scales);
        }
    }

    #[inline(always)]
    fn part(&self, row: u32) -> Part<'s> {
        let pair = &self.pairs[self.rows[row as usize] as usize];
        let [a, b] = pair.bodies.map(|slot| slot as usize);
        let between = |c: &[i64]| c[b].saturating_sub(c[a]);
        Part {
            pair,
            places: self.places[row as usize],
            between: [between(self.bodies.x.bits()), between(self.bodies.y.bits())],
            mobility: [&self.mobilities[a], &self.mobilities[b]],
            old: pair.last(self.contacts),
        }
    }
}
