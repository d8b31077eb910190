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
use crate::num::envelope::{Envelope, ROWS};
use crate::num::lane::{add, clamp, deeper, limit, mul, next, round, sub};
use crate::num::{div, round_shift};

/// How many steps a solve may take, and how often one is halved.
const ROUNDS: u32 = 8;
const HALVINGS: u32 = 12;
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
    /// Rows that there are, and those that are equations.
    present: u8,
    active: u8,
    /// What friction holds at most, by the loads when the solve began, Q20.
    hold: i64,
    /// By row: h less the least of the island, and A_ii.
    shift: [u32; 3],
    diagonal: [i64; 3],
    /// Its part of the couplings; the last is with itself.
    couplings: [u32; 2],
    /// By row, where it is among the equations.
    row: [u16; 3],
    /// By row, the speed that it lacks, Q20, and lacked before the last step.
    lack: [i64; 3],
    lacked: [i64; 3],
    /// Impulses when the solve began, and what changes them: friction, points.
    before: [i32; 3],
    change: [i64; 3],
    start: [i64; 3],
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
            if island.swept || !island.solve_all::<BIASED>(blocks, movers, scales) {
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
    /// Between which impulses a row is.
    fn limits(&self, row: usize) -> [i64; 2] {
        if row == 0 { [sub(0, self.hold), self.hold] } else { [0, IMPULSE_MAX] }
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

    /// Finds what pushes, and how much, by projected Newton steps. Whether all stayed in its range; all is as before if not.
    ///
    /// Impulses stay within their limits, and no step is taken that does not bring them nearer to the solution, so that where it
    /// ends too early is a state to go on from.
    fn solve_all<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) -> bool {
        self.pushes &= !BIASED;
        self.remember(blocks, movers);
        self.look::<BIASED>(blocks, movers, scales);
        for round in 0..ROUNDS {
            if !self.choose(blocks) && round > 0 {
                break;
            }
            loop {
                if !self.factor() || !self.solve() {
                    self.restore(blocks, movers);
                    self.swept |= self.factors >= FACTORS;
                    return false;
                }
                if !self.block() { break; }
            }
            let mut whole = false;
            let mut done = false;
            for shorter in 0..HALVINGS {
                whole = self.step(shorter, blocks, movers);
                self.look::<BIASED>(blocks, movers, scales);
                if whole || !self.rises(blocks) {
                    done = true;
                    break;
                }
            }
            if std::env::var("DBG").is_ok() && self.contacts.len() >= 20 && round > 0 { eprintln!("biased {BIASED} round {round} whole {whole} eqs {} factors {}", self.equations, self.factors); }
            if !done {
                if std::env::var("DBG").is_ok() { eprintln!("UNDONE {} round {round} eqs {}", self.contacts.len(), self.equations); }
                self.step(63, blocks, movers);
                break;
            }
        }
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let hold = block.hold(i, [0, 1].map(|at| block.points[at].impulse[i]));
            let drag = impulse_of(block, i, 0);
            joined.change = [sub(clamp(drag, sub(0, hold), hold), drag), 0, 0];
        }
        self.give(blocks, movers);
        true
    }

    /// Whether the last step leads away from the solution: by the sum of its impulses times the speeds before and after.
    fn rises(&self, blocks: &[Block]) -> bool {
        let mut work = 0i128;
        for joined in &self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                let speeds = i128::from(joined.lack[row].saturating_add(joined.lacked[row]));
                let change = sub(impulse_of(block, i, row), joined.start[row]);
                let part = div(speeds.saturating_mul(change.into()) << 40, (joined.diagonal[row] >> 18).into());
                work = work.saturating_add(round_shift(part, joined.shift[row].saturating_mul(2)));
            }
        }
        if std::env::var("DBG").is_ok() && self.contacts.len() >= 40 && work > 0 {
            let mut first = 0f64; let mut all = 0f64; let mut most = 0f64;
            for joined in &self.contacts {
                let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
                for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                    let d = (impulse_of(block, i, row) - joined.start[row]) as f64 / 1048576.0;
                    let w = 1.0 / (joined.diagonal[row] as f64 / 2f64.powi(58)) / 4f64.powi(joined.shift[row] as i32);
                    first += d * joined.lacked[row] as f64 / 1048576.0 * w;
                    all += d * (joined.lack[row] + joined.lacked[row]) as f64 / 1048576.0 * w;
                    most = most.max(d.abs());
                }
            }
            eprintln!("   work {work} first {first:.6} all {all:.6} most {most:.3}");
        }
        work > 0
    }

    fn remember(&mut self, blocks: &[Block], movers: &[Mover]) {
        for (place, before) in &mut self.before {
            let mover = &movers[*place as usize];
            *before = [mover.v[0], mover.v[1], mover.w];
        }
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            joined.before = [&block.friction, &block.points[0], &block.points[1]].map(|row| row.impulse[i]);
            joined.hold = block.hold(i, [joined.before[1], joined.before[2]]);
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

    /// What the rows lack. Those that yield do so in all, not by step: they are springs. Friction would creep.
    fn look<const BIASED: bool>(&mut self, blocks: &[Block], movers: &[Mover], scales: &Scales) {
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let look = block.look(i, movers);
            joined.lack[0] = limit(round::<28>(look.slip)).into();
            for at in 0..2 {
                let impulse = impulse_of(block, i, next(at));
                let yields = if BIASED { round::<{ YIELDS[1] }>(impulse) } else { 0 };
                joined.lack[next(at)] = lack::<BIASED>(&look, at, self.push, scales).saturating_add(yields);
                self.pushes |= BIASED && impulse > 0 && look.separation[at] < SLOP.saturating_neg();
            }
        }
    }

    /// Which rows are equations: those within their limits, and those that are to leave one. Whether there are any that do.
    fn choose(&mut self, blocks: &[Block]) -> bool {
        let (mut changed, mut wants) = (false, false);
        self.equations = 0;
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let mut active = 0;
            for row in (0..3).filter(|row| joined.present >> row & 1 != 0) {
                let (impulse, lack) = (impulse_of(block, i, row), joined.lack[row]);
                let [least, most] = joined.limits(row);
                let free = least < most
                    && (impulse > least || lack < STILL.saturating_neg())
                    && (impulse < most || lack > STILL);
                active |= u8::from(free) << row;
                wants |= free && lack.saturating_abs() > STILL;
            }
            // An impact may have taken the contact.
            active = if block.bodies[0][i] == block.bodies[1][i] { 0 } else { active };
            changed |= joined.active != active;
            joined.active = active;
            joined.lacked = joined.lack;
            joined.start = [0, 1, 2].map(|row| impulse_of(block, i, row));
        }
        self.number();
        self.factored &= !changed;
        wants
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
    fn solve(&mut self) -> bool {
        self.solution.clear();
        for joined in &self.contacts {
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                let lack = i128::from(joined.lack[row]).saturating_neg() << 24;
                self.solution.push(round_shift(lack, joined.shift[row]) as i64);
            }
        }
        self.envelope.solve(&mut self.solution)
    }

    /// Takes rows at a limit that a step would push beyond it out of the equations. Whether there were any.
    fn block(&mut self) -> bool {
        let mut blocked = false;
        for joined in &mut self.contacts {
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                let [least, most] = joined.limits(row);
                let x = self.solution[joined.row[row] as usize];
                let out = joined.start[row] <= least && x < 0 || joined.start[row] >= most && x > 0;
                joined.active &= !(u8::from(out) << row);
                blocked |= out;
            }
        }
        if blocked {
            self.number();
            self.factored = false;
        }
        blocked
    }

    /// Numbers the equations.
    fn number(&mut self) {
        self.equations = 0;
        for joined in &mut self.contacts {
            for row in 0..3 {
                joined.row[row] = NONE;
                if joined.active >> row & 1 != 0 {
                    joined.row[row] = self.equations;
                    self.equations = self.equations.saturating_add(1);
                }
            }
        }
    }

    /// Goes a 2^`shorter`th of the way from where the round began, within the limits. Whether that is all of it.
    fn step(&mut self, shorter: u32, blocks: &mut [Block], movers: &mut [Mover]) -> bool {
        let mut whole = shorter == 0;
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            joined.change = [0; 3];
            for row in (0..3).filter(|&row| joined.row[row] != NONE) {
                let x = i128::from(self.solution[joined.row[row] as usize]);
                let shift = 82u32.saturating_sub(joined.shift[row]).saturating_add(shorter);
                let change = round_shift(x.saturating_mul(joined.diagonal[row].into()), shift) as i64;
                let then = joined.start[row].saturating_add(change);
                let [least, most] = joined.limits(row);
                whole &= (least..=most).contains(&then);
                joined.change[row] = sub(clamp(then, least, most), impulse_of(block, i, row));
            }
        }
        self.give(blocks, movers);
        whole
    }

    /// Changes impulses.
    fn give(&self, blocks: &mut [Block], movers: &mut [Mover]) {
        for joined in self.contacts.iter().filter(|joined| joined.change != [0; 3]) {
            let (block, i) = (&mut blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let [slide, first, second] = joined.change.map(|change| change as i32);
            block.give(i, movers, [slide, first, second]);
            block.friction.impulse[i] = block.friction.impulse[i].saturating_add(slide);
            for (at, change) in [first, second].into_iter().enumerate() {
                let impulse = block.points[at].impulse[i].saturating_add(change);
                block.points[at].impulse[i] = impulse;
                block.peak[at][i] = block.peak[at][i].max(impulse);
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
