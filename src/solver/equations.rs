//! The equations of a hard island.
//!
//! With k the inverse mass of a row in units of the lightest body's and 2^h the power of two next to √k, the system
//! A_ij = J_i·M⁻¹·J_jᵀ/2^(h_i + h_j) has a diagonal in 1 … 4, and only ratios of masses enter. Its unknowns are x = λ·2^h, and a row's
//! λ̂ = k·λ is A_ii·2^h·x; its right side is a speed over 2^h.

use super::direct::{Weight, YIELD};
use super::rows::{Block, IMPULSE_MAX, LANES};
use crate::num::envelope::Envelope;
use crate::num::lane::{add, mul, sub};
use crate::num::{div, round_shift};

/// How many products an island may take in a tick: some milliseconds; then it is tired. With as many as [`LABOUR`] the tick was
/// laborious. A step counts as [`STEP`] for each contact.
const SHARE: u64 = 12_000_000;
const LABOUR: u64 = 1_000_000;
const STEP: u64 = 128;
/// The greatest ratio of inverse masses of rows, as a power of two of its root.
const RATIO: u32 = 16;
/// What is added to the diagonal, as a shift: a normal yields, and friction takes its steps a little short.
const EASE: [u32; 3] = [13, YIELD, YIELD];
const NONE: u16 = u16::MAX;

/// A contact in an island. Its rows: friction, and its points.
#[derive(Clone, Debug, Default)]
pub(super) struct Joined {
    pub(super) seat: u32,
    places: [u32; 2],
    /// Rows that there are, and those that are equations.
    pub(super) present: u8,
    pub(super) active: u8,
    /// What friction holds at most, by the loads when the solve began, Q20.
    pub(super) hold: i64,
    /// By row: h less the least of the island, A_ii, and its inverse, Q30.
    pub(super) shift: [u32; 3],
    pub(super) diagonal: [i64; 3],
    pub(super) inverse: [i64; 3],
    /// Its part of the couplings; the last is with itself.
    couplings: [u32; 2],
    /// By row, where it is among the equations.
    pub(super) row: [u16; 3],
    /// By row, the speed that it lacks, Q20, and lacked when the round began.
    pub(super) lack: [i64; 3],
    pub(super) lacked: [i64; 3],
    /// Impulses when the solve and when the round began, Q20.
    pub(super) before: [i64; 3],
    pub(super) start: [i64; 3],
}

/// A_ij of the rows of a contact with those of an earlier one, or its own.
#[derive(Clone, Copy, Debug, Default)]
struct Coupling {
    other: u32,
    entries: [[i64; 3]; 3],
}

/// What hangs together, for one tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Island {
    pub(super) contacts: Vec<Joined>,
    couplings: Vec<Coupling>,
    envelope: Envelope,
    /// What solves the equations.
    pub(super) solution: Vec<i64>,
    /// Bodies, and their velocities when the solve began.
    pub(super) before: Vec<(u32, [i64; 3])>,
    /// How many products it took in this tick, and whether the last factorisation is that of the equations.
    work: u64,
    factored: bool,
    /// Whether it has had its share of the tick, or has numbers beyond what formats hold.
    pub(super) tired: bool,
    /// Whether a body came to the bound of speeds in this pass.
    pub(super) over: bool,
    /// How its contacts were solved.
    pub(super) mode: u8,
    /// Whether a row pushed an overlap apart, and how fast one does at most: so that the highest body is not faster than one
    /// contact may make it.
    pub(super) pushes: bool,
    pub(super) push: i64,
}

impl Joined {
    /// Between which impulses a row is.
    pub(super) fn limits(&self, row: usize) -> [i64; 2] {
        if row == 0 { [sub(0, self.hold), self.hold] } else { [0, IMPULSE_MAX] }
    }

    /// The rows that are equations.
    pub(super) fn equations(&self) -> impl Iterator<Item = usize> + use<> {
        let active = self.active;
        (0..3).filter(move |row| active >> row & 1 != 0)
    }
}

/// The direction of a row and the arm on one of its bodies, Q28.
struct Jacobian {
    direction: [i32; 2],
    arm: i32,
}

fn jacobian(block: &Block, i: usize, body: usize, row: usize) -> Jacobian {
    let [nx, ny] = [block.normal[0][i], block.normal[1][i]];
    let (direction, rows) = match row {
        0 => ([ny.saturating_neg(), nx], &block.friction),
        _ => ([nx, ny], &block.points[row.saturating_sub(1)]),
    };
    Jacobian { direction, arm: rows.arm[body][i] }
}

/// J_i·M⁻¹·J_jᵀ of one body that two rows share, over 2^`shift`.
fn coupled(a: &Jacobian, b: &Jacobian, weight: &Weight, shift: u32) -> i128 {
    let along = add(mul(a.direction[0], b.direction[0]), mul(a.direction[1], b.direction[1]));
    let around = round_shift(i128::from(mul(a.arm, b.arm)).saturating_mul(weight.tau.into()), 28);
    // Q56, at most 2⁷¹, times 49 bits.
    round_shift(around.saturating_add(along.into()).saturating_mul(weight.w.into()), weight.shift.saturating_add(shift))
}

impl Island {
    /// Takes in contacts in order. `before` has its bodies; their weights become those by the lightest of them.
    pub(super) fn build(
        &mut self,
        members: &[u32],
        places: &[[u32; 2]],
        seats: &[u32],
        blocks: &[Block],
        weights: &mut [Weight],
    ) {
        self.contacts.clear();
        self.couplings.clear();
        (self.work, self.factored) = (0, false);
        (self.pushes, self.tired) = (false, false);
        let least = self.before.iter().map(|&(place, _)| weights[place as usize].shift).min().unwrap_or(0);
        for &(place, _) in &self.before {
            let weight = &mut weights[place as usize];
            weight.shift = weight.shift.saturating_sub(least);
        }
        let mut lowest = u32::MAX;
        for &at in members {
            let seat = seats[at as usize];
            let (block, i) = (&blocks[seat as usize / LANES], seat as usize % LANES);
            let mut joined = Joined { seat, places: places[at as usize], ..Joined::default() };
            let slippery = block.limit[0][i] == 0 && block.limit[1][i] == 0;
            joined.present = u8::from(!slippery) | 2 | if block.points[1].line[i] > 0 { 4 } else { 0 };
            for row in 0..3 {
                let k = (0..2).fold(0i128, |sum, body| {
                    let jacobian = jacobian(block, i, body, row);
                    sum.saturating_add(coupled(&jacobian, &jacobian, &weights[joined.places[body] as usize], 0))
                });
                joined.shift[row] = k.max(1).ilog2().saturating_sub(58) >> 1;
                lowest = lowest.min(if joined.present >> row & 1 != 0 { joined.shift[row] } else { u32::MAX });
            }
            self.couple(&mut joined, blocks, weights);
            self.contacts.push(joined);
        }
        for joined in &mut self.contacts {
            joined.shift = joined.shift.map(|shift| shift.saturating_sub(lowest));
            if (0..3).any(|row| joined.present >> row & 1 != 0 && joined.shift[row] > RATIO) {
                self.tired = true;
            }
        }
    }

    /// Whether it took much of this tick.
    pub(super) fn is_laborious(&self) -> bool {
        self.work > LABOUR
    }

    /// Counts a step.
    pub(super) fn takes(&mut self, contacts: u64) {
        self.work = self.work.saturating_add(contacts.saturating_mul(STEP));
    }

    /// The couplings of a contact with those before it, and its own.
    fn couple(&mut self, joined: &mut Joined, blocks: &[Block], weights: &[Weight]) {
        let begin = self.couplings.len() as u32;
        for (other, earlier) in self.contacts.iter().enumerate() {
            let shares = |place: &u32| weights[*place as usize].w != 0 && earlier.places.contains(place);
            if joined.places.iter().any(shares) {
                let entries = entries(joined, earlier, blocks, weights);
                self.couplings.push(Coupling { other: other as u32, entries });
            }
        }
        let entries = entries(joined, joined, blocks, weights);
        self.couplings.push(Coupling { other: self.contacts.len() as u32, entries });
        joined.diagonal = [0, 1, 2].map(|row: usize| entries[row][row]);
        joined.inverse = joined.diagonal.map(|diagonal| div(1 << 88, diagonal.into()) as i64);
        joined.couplings = [begin, self.couplings.len() as u32];
    }

    /// Numbers the equations anew.
    pub(super) fn number(&mut self) {
        self.factored = false;
        let mut next = 0u16;
        for joined in &mut self.contacts {
            joined.row = [NONE; 3];
            for row in joined.equations() {
                joined.row[row] = next;
                next = next.saturating_add(1);
            }
        }
    }

    /// Factors the system of the equations, if it is another one than the last. Whether it could be.
    pub(super) fn factor(&mut self) -> bool {
        if self.factored {
            return true;
        }
        self.envelope.clear();
        for joined in &self.contacts {
            let couplings = &self.couplings[joined.couplings[0] as usize..joined.couplings[1] as usize];
            let of = |coupling: &Coupling| self.contacts[coupling.other as usize].row;
            let first = couplings.iter().flat_map(of).min().unwrap_or(0);
            for row in joined.equations() {
                let diagonal = joined.diagonal[row];
                self.envelope.push(first.into(), diagonal.saturating_add(diagonal >> EASE[row]));
                for coupling in couplings {
                    for (column, &at) in of(coupling).iter().enumerate() {
                        if at < joined.row[row] {
                            self.envelope.set(at.into(), coupling.entries[row][column]);
                        }
                    }
                }
            }
        }
        self.work = self.work.saturating_add(self.envelope.work());
        self.factored = self.work <= SHARE && self.envelope.factor();
        self.factored
    }

    /// Solves for what takes away all that rows lack. Whether that stayed in its range.
    pub(super) fn solve_for_lacks(&mut self) -> bool {
        self.solution.clear();
        for joined in &self.contacts {
            for row in joined.equations() {
                let lack = i128::from(joined.lack[row]).saturating_neg() << 24;
                self.solution.push(round_shift(lack, joined.shift[row]) as i64);
            }
        }
        self.envelope.solve(&mut self.solution)
    }
}

/// A_ij of the rows of two contacts.
fn entries(a: &Joined, b: &Joined, blocks: &[Block], weights: &[Weight]) -> [[i64; 3]; 3] {
    let (block_a, i) = (&blocks[a.seat as usize / LANES], a.seat as usize % LANES);
    let (block_b, j) = (&blocks[b.seat as usize / LANES], b.seat as usize % LANES);
    let mut entries = [[0i64; 3]; 3];
    for (body, other) in [(0usize, 0usize), (0, 1), (1, 0), (1, 1)] {
        let place = a.places[body];
        let weight = &weights[place as usize];
        if place != b.places[other] || weight.w == 0 {
            continue;
        }
        for (row, line) in entries.iter_mut().enumerate() {
            for (column, entry) in line.iter_mut().enumerate() {
                let [x, y] = [jacobian(block_a, i, body, row), jacobian(block_b, j, other, column)];
                let value = coupled(&x, &y, weight, a.shift[row].saturating_add(b.shift[column])) as i64;
                *entry = if body == other { entry.saturating_add(value) } else { entry.saturating_sub(value) };
            }
        }
    }
    entries
}
