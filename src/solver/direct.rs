//! Hard islands solved at once: all normals and all friction that sticks, as one system of equations, instead of sweeps.
//!
//! A sweep passes on m_light/m_heavy of a load, and a soft row yields to it. Here the rows are rigid: those that push are
//! equations, v + bias = 0, and which ones push is found by pivoting in blocks. With k the inverse mass of a row in units of the
//! lightest body's and 2^h the power of two next to √k, the system A_ij = J_i·M⁻¹·J_jᵀ/2^(h_i + h_j) has a diagonal in 1 … 4 and
//! exact ratios; its unknowns are λ·2^h, and a row's λ̂ = k·λ = A_ii·2^h·(λ·2^h).
//!
//! Source: Júdice and Pires, block principal pivoting (1994).

use super::island::Islands;
use super::mobility::Mobility;
use super::mover::{Mover, Movers};
use super::rows::{Block, IMPULSE_MAX, LANES, Look};
use super::scales::{SLOP, Scales};
use crate::num::envelope::{EASE, Envelope, ROWS};
use crate::num::lane::{add, deeper, limit, mul, next, round, sub};
use crate::num::{div, mul as mul_wide, round_shift};

/// Rows of a contact: friction, and its points.
const FRICTION: u8 = 1;
const POINTS: u8 = 6;
/// How many rounds a solve may take, and how many of them with as many wrong rows as before.
const ROUNDS: u32 = 32;
const PATIENCE: u32 = 4;
/// How many factorisations an island may take in a tick; then it is swept.
const FACTORS: u32 = 128;
/// How fast a row that does not push may close, Q20: what the rounding of reads makes.
const STILL: i64 = 16;
/// How often an island is swept instead, when pivoting does not end.
const SWEEPS: u32 = 4;
/// The greatest ratio of inverse masses of rows, as a power of two of its root.
const RATIO: u32 = 16;
/// By row, with which part of its impulse it yields, as a shift.
const YIELDS: [u32; 3] = [13, 10, 10];
const NONE: u16 = u16::MAX;

/// All hard islands of a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Direct {
    islands: Vec<Island>,
    count: usize,
    /// By place of a body.
    weights: Vec<Weight>,
}

/// How a body yields: 1/m = `w`·2^-`shift`, and τ.
#[derive(Clone, Copy, Debug, Default)]
struct Weight {
    w: i64,
    shift: u32,
    tau: i64,
}

/// A contact in an island.
#[derive(Clone, Debug, Default)]
struct Joined {
    seat: u32,
    places: [u32; 2],
    /// Rows that there are, those that push, those that are equations at present, and whether friction slides.
    present: u8,
    active: u8,
    solved: u8,
    slides: bool,
    /// By row: h less the least of the island, and A_ii.
    shift: [u32; 3],
    diagonal: [i64; 3],
    /// Its part of the couplings; the last is with itself.
    couplings: [u32; 2],
    /// By row, where it is among the equations.
    row: [u16; 3],
    /// By row, the speed that it lacks, Q20.
    lack: [i64; 3],
    /// Impulses when the solve began, and what changes them: friction, points.
    before: [i32; 3],
    change: [i64; 3],
    /// Rows that are to change sides.
    wrong: u8,
}

/// A_ij of the rows of a contact with those of an earlier one, or its own.
#[derive(Clone, Copy, Debug, Default)]
struct Coupling {
    other: u32,
    entries: [[i64; 3]; 3],
}

#[derive(Clone, Debug, Default)]
struct Island {
    contacts: Vec<Joined>,
    couplings: Vec<Coupling>,
    envelope: Envelope,
    /// How many rows are equations, and what solves them.
    equations: u16,
    solution: Vec<i64>,
    /// Bodies, and their velocities when the solve began.
    before: Vec<(u32, [i64; 3])>,
    /// How many factorisations it took in this tick.
    factors: u32,
    /// Whether the envelope is that of the active rows.
    factored: bool,
    /// Whether a row pushed an overlap apart, and how fast one does at most: so that the highest body is not faster than one
    /// contact may make it.
    pushes: bool,
    push: i64,
    /// Whether it is swept.
    swept: bool,
}

impl Direct {
    /// Takes in the hard islands of a tick; their contacts have been written into blocks.
    pub(crate) fn build(
        &mut self,
        islands: &Islands,
        places: &[[u32; 2]],
        seats: &[u32],
        blocks: &[Block],
        movers: &Movers,
        mobilities: &[Mobility],
        scales: &Scales,
    ) {
        self.count = islands.iter().len();
        if self.count == 0 {
            return;
        }
        if self.islands.len() < self.count {
            self.islands.resize_with(self.count, Island::default);
        }
        self.weights.clear();
        self.weights.resize(movers.lanes.len(), Weight::default());
        for (island, (members, depth)) in self.islands.iter_mut().zip(islands.iter()) {
            island.push = scales.push.checked_div(depth.into()).unwrap_or(scales.push);
            island.before.clear();
            for &place in members.iter().flat_map(|&at| &places[at as usize]).filter(|&&place| place != 0) {
                let mobility = &mobilities[movers.slot(place)];
                if self.weights[place as usize].w == 0 && mobility.moves() {
                    let (w, shift) = mobility.inverse_mass();
                    self.weights[place as usize] = Weight { w, shift, tau: mobility.tau };
                    island.before.push((place, [0; 3]));
                }
            }
            island.build(members, places, seats, blocks, &mut self.weights);
        }
    }

    /// What the last tick's impulses do to the bodies.
    pub(crate) fn warm_start(&self, blocks: &[Block], movers: &mut [Mover]) {
        blocks.iter().for_each(|block| block.warm_start(movers));
    }

    /// Solves every hard island. When `BIASED`, overlaps are pushed apart.
    pub(crate) fn solve<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) {
        for island in &mut self.islands[..self.count] {
            // Where nothing was pushed apart nothing is to be taken back.
            if !BIASED && !island.pushes && !island.swept {
                continue;
            }
            if island.swept || !island.pivot::<BIASED>(blocks, movers, scales) {
                island.sweep::<BIASED>(blocks, movers, scales);
            }
        }
    }
}

/// The direction of a row and the arm on one of its bodies, Q28; and the sign of that body.
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

/// A row's impulse.
fn impulse_of(block: &Block, i: usize, row: usize) -> i64 {
    match row {
        0 => block.friction.impulse[i].into(),
        _ => block.points[row.saturating_sub(1)].impulse[i].into(),
    }
}

impl Joined {
    /// Which rows are equations at first: points that push or close, and friction that holds.
    fn begin(&mut self, block: &Block, i: usize, slip: i64, push: [bool; 2]) {
        (self.active, self.slides) = (0, false);
        // An impact may have taken the contact.
        if block.bodies[0][i] == block.bodies[1][i] {
            return;
        }
        let drag = impulse_of(block, i, 0);
        let against = drag > 0 && slip < STILL.saturating_neg() || drag < 0 && slip > STILL;
        self.slides = against && drag.saturating_abs() >= block.hold(i, [0, 1].map(|at| block.points[at].impulse[i]));
        let points = (u8::from(push[0]) << 1 | u8::from(push[1]) << 2) & self.present;
        let sticks = points != 0 && !self.slides;
        self.active = points | if sticks { self.present & FRICTION } else { 0 };
    }

    /// Changes impulses: friction's, and those of points.
    fn give(&self, blocks: &mut [Block], movers: &mut [Mover], change: [i32; 3]) {
        if change == [0; 3] {
            return;
        }
        let (block, i) = (&mut blocks[self.seat as usize / LANES], self.seat as usize % LANES);
        block.give(i, movers, change);
        let [slide, first, second] = change;
        block.friction.impulse[i] = block.friction.impulse[i].saturating_add(slide);
        for (at, change) in [first, second].into_iter().enumerate() {
            let impulse = block.points[at].impulse[i].saturating_add(change);
            block.points[at].impulse[i] = impulse;
            block.peak[at][i] = block.peak[at][i].max(impulse);
        }
    }
}

impl Island {
    fn build(&mut self, members: &[u32], places: &[[u32; 2]], seats: &[u32], blocks: &[Block], weights: &mut [Weight]) {
        self.contacts.clear();
        self.couplings.clear();
        (self.factors, self.factored, self.pushes, self.swept) = (0, false, false, false);
        // Masses by the lightest of the island.
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
                let own = (0..2).fold(0i128, |sum, body| {
                    let jacobian = jacobian(block, i, body, row);
                    sum.saturating_add(coupled(&jacobian, &jacobian, &weights[joined.places[body] as usize], 0))
                });
                // Even, so that its half is a power of the root.
                let h = (own.max(1).ilog2().max(58).saturating_sub(58)) >> 1;
                joined.shift[row] = h;
                if joined.present >> row & 1 != 0 {
                    lowest = lowest.min(h);
                }
            }
            self.couple(&mut joined, blocks, weights);
            self.contacts.push(joined);
        }
        for joined in &mut self.contacts {
            for row in 0..3 {
                joined.shift[row] = joined.shift[row].saturating_sub(lowest);
                self.swept |= joined.present >> row & 1 != 0 && joined.shift[row] > RATIO;
            }
        }
    }

    /// The couplings of a contact with those before it, and its own.
    fn couple(&mut self, joined: &mut Joined, blocks: &[Block], weights: &[Weight]) {
        let begin = self.couplings.len() as u32;
        let own = self.contacts.len() as u32;
        let part = |a: &Joined, b: &Joined| {
            let mut entries = [[0i64; 3]; 3];
            for (body, other) in [(0usize, 0usize), (0, 1), (1, 0), (1, 1)] {
                let place = a.places[body];
                let weight = &weights[place as usize];
                if place != b.places[other] || weight.w == 0 {
                    continue;
                }
                let (block_a, i) = (&blocks[a.seat as usize / LANES], a.seat as usize % LANES);
                let (block_b, j) = (&blocks[b.seat as usize / LANES], b.seat as usize % LANES);
                for (row, line) in entries.iter_mut().enumerate() {
                    for (column, entry) in line.iter_mut().enumerate() {
                        let [x, y] = [jacobian(block_a, i, body, row), jacobian(block_b, j, other, column)];
                        let value = coupled(&x, &y, weight, a.shift[row].saturating_add(b.shift[column])) as i64;
                        *entry = if body == other { entry.saturating_add(value) } else { entry.saturating_sub(value) };
                    }
                }
            }
            entries
        };
        for (other, earlier) in self.contacts.iter().enumerate() {
            let shares = |place: &u32| weights[*place as usize].w != 0 && earlier.places.contains(place);
            if joined.places.iter().any(shares) {
                self.couplings.push(Coupling { other: other as u32, entries: part(joined, earlier) });
            }
        }
        let entries = part(joined, joined);
        self.couplings.push(Coupling { other: own, entries });
        joined.diagonal = [0, 1, 2].map(|row: usize| entries[row][row]);
        joined.couplings = [begin, self.couplings.len() as u32];
    }

    /// Finds which rows push, and solves them. Whether that came to an end; all is as before if not.
    ///
    /// All rows that are wrong change sides at once, as long as there come to be fewer of them; if not, only the last one does,
    /// which comes to an end.
    fn pivot<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) -> bool {
        self.remember(blocks, movers);
        let (mut least, mut patience) = (u32::MAX, PATIENCE);
        for round in 0..ROUNDS {
            self.choose::<BIASED>(round == 0, blocks, movers, scales);
            if std::env::var("DBG").is_ok() && self.contacts.len() >= 20000 && round == 0 {
                for j in self.contacts.iter().take(6) { let b = &blocks[j.seat as usize / LANES]; let i = j.seat as usize % LANES; let l = b.look(i, movers);
                eprintln!("   {:?} slip {:.5} v {:.5} {:.5} s {:.6} {:.6} lambda {:.4} {:.4} {:.4} hold {:.4} slides {} active {:b}", j.places, l.slip as f64/2f64.powi(48), l.speed[0] as f64/2f64.powi(48), l.speed[1] as f64/2f64.powi(48), l.separation[0] as f64/2f64.powi(26), l.separation[1] as f64/2f64.powi(26), b.friction.impulse[i] as f64/1048576.0, b.points[0].impulse[i] as f64/1048576.0, b.points[1].impulse[i] as f64/1048576.0, b.hold(i, [b.points[0].impulse[i], b.points[1].impulse[i]]) as f64/1048576.0, j.slides, j.active); }
            }
            if !self.factor() || !self.solve::<BIASED>(blocks) {
                break;
            }
            self.apply(blocks, movers);
            let wrong = self.examine::<BIASED>(blocks, movers, scales);
            if std::env::var("DBG").is_ok() && self.contacts.len() >= 20 && (wrong > 0 || round > 0) {
                let most = self.contacts.iter().map(|j| (0..2).map(|at| blocks[j.seat as usize / LANES].points[at].impulse[j.seat as usize % LANES]).max().unwrap()).max().unwrap();
                let least = self.contacts.iter().map(|j| (0..2).map(|at| blocks[j.seat as usize / LANES].points[at].impulse[j.seat as usize % LANES]).min().unwrap()).min().unwrap();
                eprintln!("biased {BIASED} round {round} eqs {} wrong {wrong}: {:?} impulses {} {}", self.solution.len(), self.contacts.iter().enumerate().filter(|(_, j)| j.wrong != 0).map(|(at, j)| format!("{at}:{:b}/{:b}", j.wrong, j.active)).take(8).collect::<Vec<_>>(), least as f64 / 1048576.0, most as f64 / 1048576.0);
            }
            if wrong == 0 {
                return true;
            }
            patience = if wrong < least { PATIENCE } else { patience.saturating_sub(1) };
            least = least.min(wrong);
            self.exchange(patience > 0, blocks, movers);
        }
        eprintln!("FAIL n {} biased {} factors {} factored {} eqs {}", self.contacts.len(), BIASED, self.factors, self.factored, self.solution.len());
        self.restore(blocks, movers);
        self.swept |= self.factors >= FACTORS;
        false
    }

    fn remember(&mut self, blocks: &[Block], movers: &[Mover]) {
        for (place, before) in &mut self.before {
            let mover = &movers[*place as usize];
            *before = [mover.v[0], mover.v[1], mover.w];
        }
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            joined.before = [&block.friction, &block.points[0], &block.points[1]].map(|row| row.impulse[i]);
        }
    }

    fn restore(&mut self, blocks: &mut [Block], movers: &mut [Mover]) {
        self.factored = false;
        for (place, before) in &self.before {
            let mover = &mut movers[*place as usize];
            [mover.v[0], mover.v[1], mover.w] = *before;
        }
        for joined in &self.contacts {
            let (block, i) = (&mut blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            [block.friction.impulse[i], block.points[0].impulse[i], block.points[1].impulse[i]] = joined.before;
        }
    }

    /// What the rows that push lack. The `first` time it is chosen which do: those that did, and those that close.
    fn choose<const BIASED: bool>(&mut self, first: bool, blocks: &[Block], movers: &[Mover], scales: &Scales) {
        let mut changed = false;
        self.equations = 0;
        self.pushes &= !(first && BIASED);
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let look = block.look(i, movers);
            let slip = i64::from(limit(round::<28>(look.slip)));
            let lack = [0, 1].map(|at| lack::<BIASED>(&look, at, self.push, scales));
            if first {
                let load = [0, 1].map(|at| block.points[at].impulse[i]);
                joined.begin(block, i, slip, [0, 1].map(|at| load[at] > 0 || lack[at] < STILL.saturating_neg()));
            }
            for at in 0..2 {
                self.pushes |= BIASED && joined.active & 2 << at != 0 && look.separation[at] < SLOP.saturating_neg();
            }
            changed |= joined.active != joined.solved;
            joined.solved = joined.active;
            joined.lack = [slip, lack[0], lack[1]];
            for row in 0..3 {
                joined.row[row] = NONE;
                if joined.active >> row & 1 != 0 {
                    joined.row[row] = self.equations;
                    self.equations = self.equations.saturating_add(1);
                }
            }
        }
        self.factored &= !changed;
    }

    /// Factors the system of the active rows, if it is another one.
    fn factor(&mut self) -> bool {
        if self.factored {
            return true;
        }
        if usize::from(self.equations) > ROWS || self.factors >= FACTORS {
            return false;
        }
        self.factors = self.factors.saturating_add(1);
        self.envelope.clear();
        for joined in &self.contacts {
            let couplings = &self.couplings[joined.couplings[0] as usize..joined.couplings[1] as usize];
            let of = |coupling: &Coupling| self.contacts[coupling.other as usize].row;
            let first = couplings.iter().flat_map(of).min().unwrap_or(0);
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                self.envelope.push(first.into(), joined.diagonal[row].saturating_add(joined.diagonal[row] >> YIELDS[row]));
                for coupling in couplings {
                    for (column, &at) in of(coupling).iter().enumerate() {
                        if at < joined.row[row] {
                            self.envelope.set(at.into(), coupling.entries[row][column]);
                        }
                    }
                }
            }
        }
        self.factored = self.envelope.factor();
        self.factored
    }

    /// Solves the equations. Whether all of it stayed in its range.
    fn solve<const BIASED: bool>(&mut self, blocks: &[Block]) -> bool {
        self.solution.clear();
        for joined in &self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                let mut lack = i128::from(joined.lack[row]) << 24;
                if BIASED && row > 0 {
                    // In all, not in this round: it is a spring. Friction would creep.
                    lack = lack.saturating_add(i128::from(impulse_of(block, i, row)) << (24 - YIELDS[row]));
                }
                self.solution.push(round_shift(lack.saturating_neg(), joined.shift[row]) as i64);
            }
        }
        self.envelope.solve(&mut self.solution)
    }

    /// What was solved, as changes of impulses, and by which part of it the first of them reaches the end of its range.
    fn apply(&mut self, blocks: &mut [Block], movers: &mut [Mover]) {
        const WHOLE: i64 = 1 << 30;
        let mut part = WHOLE;
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            for row in 0..3 {
                joined.change[row] = 0;
                if joined.row[row] == NONE {
                    continue;
                }
                let x = i128::from(self.solution[joined.row[row] as usize]);
                let shift = 82u32.saturating_sub(joined.shift[row]);
                let change = round_shift(x.saturating_mul(joined.diagonal[row].into()), shift) as i64;
                joined.change[row] = change;
                let now = impulse_of(block, i, row);
                let room = sub(IMPULSE_MAX, if change > 0 { now } else { now.saturating_neg() });
                if change.saturating_abs() > room {
                    let fits = div(i128::from(room.max(0)) << 30, change.unsigned_abs().into()) as i64;
                    part = part.min(fits);
                }
            }
        }
        for joined in &mut self.contacts {
            if part < WHOLE {
                joined.change = joined.change.map(|change| mul_wide(change, part, 30));
            }
            let change = joined.change.map(|change| change as i32);
            joined.give(blocks, movers, change);
        }
    }

    /// How many rows are wrong: they pull, close without pushing, or hold more than friction can. What slides holds all that
    /// friction can.
    fn examine<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) -> u32 {
        let mut wrong = 0u32;
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            joined.wrong = 0;
            let load = [0, 1].map(|at| block.points[at].impulse[i]);
            let idle = joined.present & POINTS & !joined.active;
            if idle != 0 && block.bodies[0][i] != block.bodies[1][i] {
                let look = block.look(i, movers);
                for at in (0..2).filter(|at| idle >> next(*at) & 1 != 0) {
                    joined.wrong |= if lack::<BIASED>(&look, at, self.push, scales) < STILL.saturating_neg() { 2 << at } else { 0 };
                }
            }
            for (at, &load) in load.iter().enumerate() {
                joined.wrong |= if load < 0 { 2 << at } else { 0 };
            }
            let hold = block.hold(i, load.map(|load| load.max(0)));
            let drag = impulse_of(block, i, 0);
            if joined.active & FRICTION != 0 && drag.saturating_abs() > hold {
                joined.wrong |= FRICTION;
            } else if joined.slides {
                joined.give(blocks, movers, [sub(drag.signum().saturating_mul(hold), drag) as i32, 0, 0]);
            }
            wrong = wrong.saturating_add(joined.wrong.count_ones());
        }
        wrong
    }

    /// Rows that are wrong change sides, all of them or the last one.
    fn exchange(&mut self, all: bool, blocks: &mut [Block], movers: &mut [Mover]) {
        for joined in self.contacts.iter_mut().rev().filter(|joined| joined.wrong != 0) {
            let rows = if all { joined.wrong } else { 1 << joined.wrong.ilog2() };
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let mut now = [0, 1, 2].map(|row| impulse_of(block, i, row));
            for row in (1..3).filter(|row| rows >> row & 1 != 0 && joined.active >> row & 1 != 0) {
                now[row] = 0;
            }
            joined.active ^= rows & POINTS;
            joined.slides |= rows & FRICTION != 0;
            let sticks = joined.active & POINTS != 0 && !joined.slides;
            joined.active = joined.active & POINTS | if sticks { joined.present & FRICTION } else { 0 };
            if !sticks {
                let hold = block.hold(i, [now[1].max(0) as i32, now[2].max(0) as i32]);
                now[0] = now[0].signum().saturating_mul(if joined.active == 0 { 0 } else { hold });
            }
            let change = [0, 1, 2].map(|row| sub(now[row], impulse_of(block, i, row)) as i32);
            joined.give(blocks, movers, change);
            if !all {
                break;
            }
        }
    }

    /// Sweeps the island as if it were soft.
    fn sweep<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) {
        self.pushes = true;
        for _ in 0..SWEEPS {
            for joined in &self.contacts {
                blocks[joined.seat as usize / LANES].contact::<BIASED, true>(joined.seat as usize % LANES, movers, scales);
            }
        }
    }
}

/// The speed that a point lacks, Q20: its own and what its gap or its overlap asks for.
fn lack<const BIASED: bool>(look: &Look, at: usize, push: i64, scales: &Scales) -> i64 {
    let separation = look.separation[at];
    let bias = match separation > 0 {
        true => mul(separation, scales.close_rate) >> 20,
        false if BIASED => (mul(deeper(separation, SLOP), scales.rigid_rate) >> 20).max(push),
        false => 0,
    };
    limit(add(round::<28>(look.speed[at]), bias)).into()
}
