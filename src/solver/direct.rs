//! Hard islands solved at once: their rows as one system of equations, instead of sweeps.
//!
//! A sweep passes on m_light/m_heavy of a load, and a soft row yields to it. Here all normals and all friction that holds are
//! equations, J·v + bias + λ̂/2¹⁰ = 0, of which those are left out that would pull or hold too much. Which ones is found by
//! projected Newton steps on what a solution makes least, ½·λᵀ·A·λ + λᵀ·(J·v + bias): every step stays within the limits and leads
//! towards the solution, so where it ends too early is a state to go on from. In a biased pass a normal yields by a
//! thousandth of its impulse in all: that is what decides how a load is shared where bodies stand on more points than they need.
//!
//! What failed: pivoting (Júdice and Pires 1994) with rigid rows is exact in stacks, but goes round for ever where a lid
//! lies on a bed of boxes, and what sweeps make of such an island then explodes; 2⁻¹³ on the diagonal by step alone makes a
//! tower lean, for its bending is less than that; an overlap that opens by a fifth in a substep kicks it over.
//!
//! Source: Bertsekas, Projected Newton Methods (1982).

use super::equations::Island;
use super::island::Islands;
use super::mobility::Mobility;
use super::mover::{Mover, Movers};
use super::rows::{Block, LANES};
use super::scales::{SLOP, Scales};
use crate::num::lane::{self, clamp, deeper, limit, mul, next, round, sub};
use crate::num::round_shift;

/// How many steps a solve may take, and how often one is halved.
const ROUNDS: u32 = 8;
const HALVINGS: u32 = 12;
/// How fast a row at its limit may be left to go, Q20: what the rounding of reads makes.
const STILL: i64 = 16;
/// How often friction may be limited anew by loads that came of it, and what it may lose: 1/4 m/s, Q20; the last time an eighth
/// of the island's greatest load.
const HOLDS: u32 = 4;
const CUT: i64 = 1 << 18;
/// How often an island is swept instead, when it has had its share of the tick or is beyond what numbers hold.
const SWEEPS: u32 = 4;
/// For how many ticks on end an island may be laborious, and what its contacts keep of it then: they are swept as long as
/// they last. If it were tried again after some seconds, heaps would breathe.
const PATIENCE: u8 = 30;
pub(super) const GIVEN_UP: u8 = u8::MAX;
/// With which part of its impulse a normal yields, as a shift.
pub(super) const YIELD: u32 = 10;

/// All hard islands of a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Direct {
    islands: Vec<Island>,
    count: usize,
    /// By place of a body.
    weights: Vec<Weight>,
}

/// By contact: the places of its bodies, how it was solved, and where it sits among the blocks.
pub(crate) struct Rows<'r> {
    pub(crate) places: &'r [[u32; 2]],
    pub(crate) modes: &'r [u8],
    pub(crate) seats: &'r [u32],
    pub(crate) blocks: &'r [Block],
}

/// How a body yields: 1/m = `w`·2^-`shift`, and τ.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Weight {
    pub(super) w: i64,
    pub(super) shift: u32,
    pub(super) tau: i64,
}

impl Direct {
    /// Takes in the hard islands of a tick; their contacts have been written into blocks.
    pub(crate) fn build(
        &mut self,
        islands: &Islands,
        rows: &Rows<'_>,
        movers: &Movers,
        mobilities: &[Mobility],
        scales: &Scales,
    ) {
        let Rows { places, modes, seats, blocks } = *rows;
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
            island.mode = members.iter().map(|&at| modes[at as usize]).max().unwrap_or(0).max(1);
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

    /// How contacts of the island of one of these places were solved, see `Contact::mode`.
    pub(crate) fn mode(&self, places: [u32; 2]) -> u8 {
        let of = |island: &&Island| island.before.iter().any(|(place, _)| places.contains(place));
        self.islands[..self.count].iter().find(of).map_or(1, |island| match island.is_laborious() {
            true if island.mode >= PATIENCE => GIVEN_UP,
            true => island.mode.saturating_add(1),
            false => 1,
        })
    }

    /// Solves every hard island. When `BIASED`, overlaps are pushed apart, else what that did to velocities is taken back.
    pub(crate) fn solve<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) {
        for island in &mut self.islands[..self.count] {
            if !BIASED && !island.pushes {
                continue;
            }
            if island.tired || !island.solve::<BIASED>(blocks, movers, scales) {
                island.sweep::<BIASED>(blocks, movers, scales);
            }
        }
    }
}

impl Island {
    /// Finds what pushes, and how much. Whether all stayed in its range; all is as before if not.
    fn solve<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) -> bool {
        self.pushes &= !BIASED;
        self.over = false;
        self.remember(blocks, movers);
        self.look::<BIASED>(blocks, movers, scales);
        for again in (0..HOLDS).rev() {
            if !self.rounds::<BIASED>(blocks, movers, scales) || self.over {
                break;
            }
            let (cut, most) = self.hold(blocks, movers);
            if cut <= CUT || again == 0 && cut <= most >> 3 {
                return true;
            }
            self.look::<BIASED>(blocks, movers, scales);
        }
        self.restore(blocks, movers);
        self.tired = true;
        false
    }

    /// Newton steps with the limits that friction has; false if the equations have no solution in range.
    fn rounds<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) -> bool {
        let mut whole = false;
        for _ in 0..ROUNDS {
            if !self.choose(blocks) && whole {
                break;
            }
            if !self.direct() {
                return false;
            }
            let mut leads = false;
            for shorter in 0..HALVINGS {
                whole = self.step(shorter, blocks, movers);
                self.look::<BIASED>(blocks, movers, scales);
                // All of a Newton step never leads away.
                leads = whole || !self.rises(blocks);
                if leads {
                    break;
                }
            }
            if !leads {
                self.step(63, blocks, movers);
                break;
            }
        }
        true
    }

    fn remember(&mut self, blocks: &[Block], movers: &[Mover]) {
        for (place, before) in &mut self.before {
            let mover = &movers[*place as usize];
            *before = [mover.v[0], mover.v[1], mover.w];
        }
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            joined.before = [0, 1, 2].map(|row| impulse(block, i, row));
            joined.hold = block.hold(i, [1, 2].map(|row: usize| joined.before[row] as i32));
        }
    }

    fn restore(&mut self, blocks: &mut [Block], movers: &mut [Mover]) {
        for (place, before) in &self.before {
            let mover = &mut movers[*place as usize];
            [mover.v[0], mover.v[1], mover.w] = *before;
        }
        for joined in &self.contacts {
            let (block, i) = (&mut blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let [slide, first, second] = joined.before.map(|impulse| impulse as i32);
            (block.friction.impulse[i], block.points[0].impulse[i], block.points[1].impulse[i]) =
                (slide, first, second);
        }
    }

    /// What the rows lack. Normals yield by all that they bear, not by step: they are springs; friction would creep.
    fn look<const BIASED: bool>(&mut self, blocks: &[Block], movers: &[Mover], scales: &Scales) {
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let look = block.look(i, movers);
            joined.lack[0] = limit(round::<28>(look.slip)).into();
            for (at, (&speed, &separation)) in look.speed.iter().zip(&look.separation).enumerate() {
                let bears = impulse(block, i, next(at));
                let gap = separation > 0;
                let bias = match gap {
                    true => mul(separation, scales.close_rate) >> 20,
                    false if BIASED => (mul(deeper(separation, SLOP), scales.rigid_rate) >> 20).max(self.push),
                    false => 0,
                };
                let yields = if BIASED { round::<YIELD>(bears) } else { 0 };
                let lack = round::<28>(speed).saturating_add(bias);
                joined.lack[next(at)] = i64::from(limit(lack)).saturating_add(yields);
                self.pushes |= BIASED && bears > 0 && !gap;
            }
        }
    }

    /// Which rows are equations: those within their limits, and those that are to leave one. Whether they are others than before.
    fn choose(&mut self, blocks: &[Block]) -> bool {
        let mut changed = false;
        for joined in &mut self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let mut active = 0;
            // An impact may have taken the contact.
            let present = if block.is_retired(i) { 0 } else { joined.present };
            joined.lacked = joined.lack;
            joined.start = [0, 1, 2].map(|row| impulse(block, i, row));
            for row in (0..3).filter(|row| present >> row & 1 != 0) {
                let (impulse, lack) = (joined.start[row], joined.lack[row]);
                let [least, most] = joined.limits(row);
                let up = impulse > least || lack < STILL.saturating_neg();
                let down = impulse < most || lack > STILL;
                let equation = least < most && up && down;
                active |= u8::from(equation) << row;
            }
            changed |= joined.active != active;
            joined.active = active;
        }
        if changed {
            self.number();
        }
        changed
    }

    /// Solves the equations, without rows at a limit that a step would push beyond it. Whether all of it stayed in its range.
    fn direct(&mut self) -> bool {
        loop {
            if !self.factor() || !self.solve_for_lacks() {
                return false;
            }
            let mut beyond = false;
            for joined in &mut self.contacts {
                for row in joined.equations() {
                    let [least, most] = joined.limits(row);
                    let x = self.solution[joined.row[row] as usize];
                    let out = joined.start[row] <= least && x < 0 || joined.start[row] >= most && x > 0;
                    joined.active &= !(u8::from(out) << row);
                    beyond |= out;
                }
            }
            if !beyond {
                return true;
            }
            self.number();
        }
    }

    /// Goes a 2^`shorter`th of the way from where the round began, within the limits. Whether that is all of it.
    fn step(&mut self, shorter: u32, blocks: &mut [Block], movers: &mut [Mover]) -> bool {
        let (mut whole, mut over) = (shorter == 0, false);
        self.takes(self.contacts.len() as u64);
        for joined in &self.contacts {
            let (block, i) = (&mut blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let mut change = [0; 3];
            for row in joined.equations() {
                let x = i128::from(self.solution[joined.row[row] as usize]);
                let shift = 82u32.saturating_sub(joined.shift[row]).saturating_add(shorter);
                let way = round_shift(x.saturating_mul(joined.diagonal[row].into()), shift) as i64;
                let then = joined.start[row].saturating_add(way);
                let [least, most] = joined.limits(row);
                whole &= (least..=most).contains(&then);
                change[row] = sub(clamp(then, least, most), impulse(block, i, row)) as i32;
            }
            over |= give(block, i, movers, change);
        }
        self.over |= over;
        whole
    }

    /// Whether the last step leads away from the solution: by the sum of its impulses times the speeds before and after.
    fn rises(&self, blocks: &[Block]) -> bool {
        let mut work = 0i128;
        for joined in &self.contacts {
            let (block, i) = (&blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            for row in joined.equations() {
                let speeds = i128::from(joined.lack[row].saturating_add(joined.lacked[row]));
                let change = sub(impulse(block, i, row), joined.start[row]);
                let part = speeds.saturating_mul(change.into()).saturating_mul(joined.inverse[row].into());
                work = work.saturating_add(round_shift(part, joined.shift[row].saturating_mul(2)));
            }
        }
        work > 0
    }

    /// Limits friction by the loads as they are now; how much that takes away at most, and the greatest load. The equations had
    /// it, as the loads before allowed: what it held would go, and where loads and friction raise each other it would fly.
    fn hold(&mut self, blocks: &mut [Block], movers: &mut [Mover]) -> (i64, i64) {
        let (mut most_cut, mut most) = (0, 0);
        for joined in &mut self.contacts {
            let (block, i) = (&mut blocks[joined.seat as usize / LANES], joined.seat as usize % LANES);
            let loads = [0, 1].map(|at| block.points[at].impulse[i]);
            joined.hold = block.hold(i, loads);
            let drag = impulse(block, i, 0);
            let cut = sub(clamp(drag, sub(0, joined.hold), joined.hold), drag);
            (most_cut, most) =
                (cut.abs().max(most_cut), loads.into_iter().fold(most, |most, load| most.max(load.into())));
            give(block, i, movers, [cut as i32, 0, 0]);
        }
        (most_cut, most)
    }

    /// Sweeps the island as if it were soft.
    #[cold]
    fn sweep<const BIASED: bool>(&mut self, blocks: &mut [Block], movers: &mut [Mover], scales: &Scales) {
        self.pushes = true;
        for _ in 0..SWEEPS {
            for seat in self.contacts.iter().map(|joined| joined.seat as usize) {
                blocks[seat / LANES].contact::<BIASED, true>(seat % LANES, movers, scales);
            }
        }
    }
}

/// The impulse of a row of a contact: friction, and its points.
fn impulse(block: &Block, i: usize, row: usize) -> i64 {
    let row = if row == 0 { &block.friction } else { &block.points[row.saturating_sub(1)] };
    row.impulse[i].into()
}

/// Changes the impulses of a contact. Whether a body came to the bound of speeds: what is cut off there a later step does not
/// give back, and impulses and velocities belong together no more.
fn give(block: &mut Block, i: usize, movers: &mut [Mover], change: [i32; 3]) -> bool {
    if change == [0; 3] {
        return false;
    }
    block.give(i, movers, change);
    let bound = |&v: &i64| v.unsigned_abs() >= lane::HELD.unsigned_abs();
    let over = [0, 1].iter().any(|&body: &usize| {
        let mover = &movers[block.bodies[body][i] as usize];
        [mover.v[0], mover.v[1], mover.w].iter().any(bound)
    });
    let [slide, first, second] = change;
    block.friction.impulse[i] = block.friction.impulse[i].saturating_add(slide);
    for (at, change) in [first, second].into_iter().enumerate() {
        let impulse = block.points[at].impulse[i].saturating_add(change);
        block.points[at].impulse[i] = impulse;
        block.peak[at][i] = block.peak[at][i].max(impulse);
    }
    over
}
