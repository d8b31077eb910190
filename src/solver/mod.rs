//! The contact solver: substepped, soft, in mass-normalised rows.
//!
//! A tick: rows from manifolds, last tick's impulses, then in each substep forces, a sweep with soft rows, positions,
//! impacts at their times, a sweep without. What comes together fast has no rows: it strikes (`timeline`). Islands of
//! which a contact bears far more than its bodies weigh are solved directly instead of swept (`direct`).

#[cfg(target_arch = "x86_64")]
mod avx2;
mod color;
mod direct;
mod equations;
mod flight;
mod impact;
mod island;
mod kernel;
mod mobility;
mod mover;
mod prepare;
mod rows;
mod scales;
mod strike;
#[cfg(target_arch = "x86_64")]
mod sweep;
#[cfg(test)]
mod tests;
mod timeline;

use crate::body::{Bodies, Colliders};
use crate::contact::{Collision, Contact, Contacts, NEW, Pair, Touch};
use crate::motion::{Drive, Fault};
use crate::num::{cross, dot, mul};
use color::Colors;
use direct::{Direct, GIVEN_UP, Rows};
use flight::TICK;
pub use impact::{Impact, ImpactError, Striker, impact};
use island::{Islands, Vote};
use kernel::Kernel;
pub(crate) use mobility::Mobility;
use mover::Movers;
use prepare::Joint;
use rows::{Block, LANES};
pub(crate) use scales::Scales;
use scales::weight;
use timeline::{Stage, Timeline};

/// How many substeps pass between sweeps that take back what pushing overlaps apart added to velocities: there is one
/// after every fifth substep and after the last; and in between for contacts with a row that pushes without bearing a load,
/// and for heavy ones: a stack with a heavy top would ring. With one after each substep for all, stacks and piles stand no
/// better and a tick takes 1.6 times as long.
const RELAX: u32 = 5;

/// What two ways of computing how far two bodies overlap may differ by: 10 nm, Q32 m.
const ROUNDING: i64 = 43;

/// The solver's own memory. All of it is derived, and none of it but mobilities and scales lasts from tick to tick.
#[derive(Debug, Default)]
pub(crate) struct Solver {
    /// By slot of a body; kept by commands.
    pub(crate) mobilities: Vec<Mobility>,
    pub(crate) scales: Scales,
    movers: Movers,
    before: Vec<[i64; 6]>,
    free: Vec<bool>,
    /// By contact: the places of its bodies among the movers, whether it is heavy, how it was solved, and what it says of how its
    /// island is to be.
    places: Vec<[u32; 2]>,
    heavy: Vec<bool>,
    modes: Vec<u8>,
    votes: Vec<Vote>,
    islands: Islands,
    direct: Direct,
    /// Pairs that may strike.
    fast: Vec<u32>,
    timeline: Timeline,
    colors: Colors,
    blocks: Vec<Block>,
    kernel: Kernel,
}

impl Clone for Solver {
    fn clone(&self) -> Self {
        Solver { mobilities: self.mobilities.clone(), scales: self.scales, ..Solver::default() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.mobilities.clone_from(&source.mobilities);
        self.scales = source.scales;
        self.timeline.collisions.clear();
    }
}

impl Solver {
    /// Rows for the pairs of this tick that touch or come near slowly, while the bodies are where it begins; what comes
    /// fast is left to strike.
    pub(crate) fn prepare(&mut self, touch: &mut Touch, contacts: &Contacts, bodies: &Bodies, drive: &Drive) {
        let Solver {
            mobilities,
            scales,
            movers,
            before,
            free,
            places,
            heavy,
            modes,
            votes,
            islands,
            direct,
            fast,
            timeline,
            colors,
            blocks,
            kernel: _,
        } = self;
        movers.clear(bodies.cold.len());
        timeline.clear(bodies.cold.len());
        places.clear();
        heavy.clear();
        modes.clear();
        votes.clear();
        fast.clear();
        for (at, pair) in touch.pairs.iter().enumerate().filter(|(_, pair)| !pair.sensor) {
            let swings = || swings(pair, bodies, drive, mobilities, scales);
            if pair.manifold.count == 0 || strikes(pair, bodies, drive, scales, false) || swings() {
                fast.push(at as u32);
            } else {
                for slot in pair.bodies {
                    movers.place(slot, bodies, &mobilities[slot as usize], scales);
                }
            }
        }
        // Among others, what does not bounce is stopped by rows as well, and in piles for less; and more is slow.
        fast.retain(|&at| {
            let pair = &touch.pairs[at as usize];
            let among = pair.bodies.iter().all(|&slot| movers.place_of(slot) != 0);
            let strikes = || strikes(pair, bodies, drive, scales, true);
            let swings = || swings(pair, bodies, drive, mobilities, scales);
            !among || pair.manifold.count == 0 || pair.restitution > 0 && (strikes() || swings())
        });
        for &at in &*fast {
            let pair = &mut touch.pairs[at as usize];
            let deepest = overlap(pair);
            pair.met = deepest >= 0;
            pair.depth = deepest.max(0).saturating_add(ROUNDING);
            pair.manifold.count = 0;
        }
        for pair in touch.pairs.iter_mut().filter(|pair| pair.manifold.count > 0) {
            pair.row = places.len() as u32;
            places.push(pair.bodies.map(|slot| movers.place(slot, bodies, &mobilities[slot as usize], scales)));
            let old = if pair.old == NEW { Contact::default() } else { contacts.get(pair.old as usize) };
            heavy.push(Scales::is_heavy(old.normal));
            modes.push(old.mode);
            votes.push(vote(pair, &old, bodies, mobilities, scales));
        }
        if !fast.is_empty() {
            timeline.remember(bodies);
        }
        movers.remember(bodies, before);
        movers.yielding(mobilities, free);
        islands.find(places, free, votes);
        colors.assign(places, free, heavy, &islands.apart);
        blocks.resize_with(colors.blocks, Block::default);
        blocks.iter_mut().for_each(Block::clear);

        for pair in touch.pairs.iter().filter(|pair| pair.row != NEW) {
            let row = pair.row as usize;
            let [a, b] = pair.bodies.map(|slot| slot as usize);
            let between = |c: &[i64]| c[b].saturating_sub(c[a]);
            let between = [between(bodies.x.bits()), between(bodies.y.bits())];
            let joint = Joint::new(pair, places[row], between, [&mobilities[a], &mobilities[b]]);
            let old = if pair.old == NEW { Contact::default() } else { contacts.get(pair.old as usize) };
            let seat = colors.seats[row] as usize;
            let block = &mut blocks[seat / LANES];
            joint.write(block, seat % LANES, &old, pair.friction, scales);
            block.heavy |= u8::from(heavy[row]) << (seat % LANES);
        }
        let rows = Rows { places, modes, seats: &colors.seats, blocks };
        direct.build(islands, &rows, movers, mobilities, scales);
    }

    /// Impacts and substeps, after the bodies have moved as if nothing touched them; bodies that were struck or pushed are
    /// put where that brings them.
    pub(crate) fn run(
        &mut self,
        touch: &mut Touch,
        bodies: &mut Bodies,
        colliders: &Colliders,
        contacts: &Contacts,
        drive: &Drive,
        faults: &mut Vec<Fault>,
    ) {
        let Solver {
            mobilities, scales, movers, before, places, direct, fast, timeline, colors, blocks, kernel, ..
        } = self;
        let stage = Stage { bodies, colliders, touch, drive, mobilities, scales, seats: &colors.seats, blocks: &[] };
        for &pair in &*fast {
            timeline.engage(pair as usize, &stage, movers);
        }
        if blocks.is_empty() {
            timeline.run([0, TICK], &stage, movers, faults);
        } else {
            movers.take_kicks(bodies, mobilities, scales);
            let swept = colors.swept;
            for block in &blocks[..swept] {
                kernel.warm_start(block, &mut movers.lanes);
            }
            blocks[swept..].iter().for_each(|block| block.warm_start(&mut movers.lanes));
            for substep in 1..=scales.substeps {
                movers.begin(substep == 1);
                for block in &mut blocks[..swept] {
                    kernel.solve::<true>(block, u8::MAX, &mut movers.lanes, scales);
                }
                direct.solve::<true>(blocks, &mut movers.lanes, scales);
                movers.drift(scales);
                timeline.run(scales.span(substep), &Stage { blocks, ..stage }, movers, faults);
                for pair in timeline.retired.drain(..) {
                    let seat = colors.seats[touch.pairs[pair as usize].row as usize] as usize;
                    blocks[seat / LANES].retire(seat % LANES);
                }
                let all = substep % RELAX == 0 || substep == scales.substeps;
                for block in &mut blocks[..swept] {
                    let lanes = if all { u8::MAX } else { block.pushes | block.heavy };
                    if lanes == 0 {
                        continue;
                    }
                    kernel.solve::<false>(block, lanes, &mut movers.lanes, scales);
                }
                direct.solve::<false>(blocks, &mut movers.lanes, scales);
            }
            for (row, &places) in places.iter().enumerate() {
                let seat = colors.seats[row] as usize;
                if blocks[seat / LANES].spent(seat % LANES) {
                    movers.hit(places);
                }
            }
            movers.store(bodies, before, mobilities, scales, faults);
        }
        timeline.flights.store(bodies, movers, scales, faults);
        for &pair in &timeline.met {
            touch.pairs[pair as usize].met = true;
        }
        touch.join(&mut timeline.late, colliders, contacts);
    }

    /// The collisions of the tick.
    pub(crate) fn collisions(&self) -> &[Collision] {
        &self.timeline.collisions
    }

    /// What became of a contact, for the next tick.
    pub(crate) fn outcome(&self, pair: &Pair) -> Contact {
        let manifold = &pair.manifold;
        let mut contact = Contact { count: manifold.count, touching: pair.met, ..Contact::default() };
        if pair.row == NEW {
            return contact;
        }
        let seat = self.colors.seats[pair.row as usize] as usize;
        let (block, i) = (&self.blocks[seat / LANES], seat % LANES);
        for at in 0..manifold.count as usize {
            contact.ids[at] = manifold.points[at].id;
            contact.touching |= block.peak[at][i] > 0 || manifold.points[at].separation <= 0;
        }
        contact.normal = [0, 1].map(|at| block.points[at].carried(i));
        contact.tangent = block.friction.carried(i);
        contact.mode = match seat / LANES < self.colors.swept {
            true => {
                if self.modes[pair.row as usize] == GIVEN_UP {
                    GIVEN_UP
                } else {
                    0
                }
            }
            false => self.direct.mode([0, 1].map(|body: usize| block.bodies[body][i])),
        };
        contact
    }
}

/// What a pair says about how its island is to be solved. What a kinematic body presses while it moves may have no solution.
fn vote(pair: &Pair, old: &Contact, bodies: &Bodies, mobilities: &[Mobility], scales: &Scales) -> Vote {
    let hard = Scales::is_hard(old.normal, old.mode > 0) || overlap(pair) > scales.deep;
    let presses = |&slot: &u32| {
        let (at, mobility) = (slot as usize, &mobilities[slot as usize]);
        let v = bodies.velocity(at);
        let speeds = [v.x.to_bits(), v.y.to_bits(), bodies.omega.get(at).to_bits()];
        !mobility.moves() && !mobility.fixed && speeds != [0; 3]
    };
    match hard {
        _ if old.mode == GIVEN_UP => Vote::Sweep,
        true if pair.bodies.iter().any(presses) => Vote::Sweep,
        true => Vote::Hard,
        false => Vote::None,
    }
}

/// By how much a pair overlaps, Q32 m; negative by the gap, and nothing is as far as one without points.
fn overlap(pair: &Pair) -> i64 {
    let points = &pair.manifold.points[..pair.manifold.count as usize];
    points.iter().map(|point| point.separation.saturating_neg()).max().unwrap_or(i64::MIN)
}

/// No less than the speed at which the points of a pair come together, with what forces add: directions left out, for
/// pairs that are clearly slower than what strikes.
fn fastest(pair: &Pair, between: [i64; 2], v: [i64; 2], omega: [i64; 2], gain: [[i64; 2]; 2]) -> i64 {
    let add = |sum: i64, c: i64| sum.saturating_add(c.saturating_abs());
    let length = |v: [i64; 2]| add(add(1, v[0]), v[1]);
    let [first, second] = pair.manifold.points.map(|point| length(point.arm));
    let arm = first.max(second);
    let arms = [arm, add(arm, length(between))];
    let turning = [0, 1].map(|body: usize| mul(omega[body].saturating_abs(), arms[body], 32));
    // 16 for the roundings of both.
    turning.into_iter().chain(v).chain(gain.into_iter().flatten()).fold(16, add)
}

/// Whether a near pair turns so fast, and nothing presses it together, that another corner may swing in across the gap, of
/// which rows would not know. Under forces rows have it all the same: what is to come to rest must be theirs.
fn swings(pair: &Pair, bodies: &Bodies, drive: &Drive, mobilities: &[Mobility], scales: &Scales) -> bool {
    let rim = |slot: u32| {
        let omega = bodies.omega.get(slot as usize).to_bits().saturating_abs();
        mul(omega, mobilities[slot as usize].reach, 32)
    };
    let points = &pair.manifold.points[..pair.manifold.count as usize];
    points.iter().all(|point| point.separation > scales.touching)
        && rim(pair.bodies[0]).saturating_add(rim(pair.bodies[1])) > scales.swinging()
        && pair.bodies.iter().all(|&slot| drive.gain(slot as usize, scales.margins.tick) == [0; 2])
}

/// Whether a near pair comes together so fast that it strikes.
fn strikes(pair: &Pair, bodies: &Bodies, drive: &Drive, scales: &Scales, among: bool) -> bool {
    let [a, b] = pair.bodies.map(|slot| slot as usize);
    let (va, vb) = (bodies.velocity(a), bodies.velocity(b));
    let v = [va.x.to_bits().saturating_sub(vb.x.to_bits()), va.y.to_bits().saturating_sub(vb.y.to_bits())];
    let omega = [a, b].map(|at| bodies.omega.get(at).to_bits());
    let gain = [a, b].map(|at| drive.gain(at, scales.margins.tick));
    let between = |c: &[i64]| c[b].saturating_sub(c[a]);
    let between = [between(bodies.x.bits()), between(bodies.y.bits())];
    // Without restitution the threshold is the same whatever presses.
    let slow = pair.restitution == 0 && fastest(pair, between, v, omega, gain) <= scales.threshold(0, 0, among);
    let strikes = || comes_fast(pair, between, v, omega, gain, scales, among);
    debug_assert!(!slow || !strikes(), "a bound of the speed is below it");
    !slow && strikes()
}

/// The same by the directions and arms of its points.
fn comes_fast(
    pair: &Pair,
    between: [i64; 2],
    v: [i64; 2],
    omega: [i64; 2],
    gain: [[i64; 2]; 2],
    scales: &Scales,
    among: bool,
) -> bool {
    let n = pair.manifold.normal.map(i64::from);
    let press = gain.map(|gain| dot(gain, n, 30));
    let mut closest = i64::MAX;
    let mut slowest = i64::MAX;
    for point in &pair.manifold.points[..pair.manifold.count as usize] {
        let other = [point.arm[0].saturating_sub(between[0]), point.arm[1].saturating_sub(between[1])];
        let turning = |omega: i64, arm: [i64; 2]| mul(omega, cross(arm, n, 30), 32);
        let speed = dot(v, n, 30).saturating_add(turning(omega[0], point.arm)).saturating_sub(turning(omega[1], other));
        closest = closest.min(point.separation);
        slowest = slowest.min(speed);
    }
    let weight = weight(gain[0]).max(weight(gain[1]));
    let threshold = scales.threshold(pair.restitution, weight, among);
    // Across a gap forces make it faster; what rests is pressed by them and does not strike.
    let (gap, pressed) = (closest > scales.touching, press[1].saturating_sub(press[0]).max(0));
    let fast = slowest.min(0).saturating_neg().saturating_add(if gap { pressed } else { 0 }) > threshold;
    // What parts needs no row in this tick, which would stop what turns it about, or another corner that swings in.
    let parts = slowest.saturating_sub(pressed) > scales.parting(pair.restitution, gap, threshold, weight);
    (fast || parts) && closest > scales.slack.saturating_neg()
}
