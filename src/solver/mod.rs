//! The contact solver: substepped, soft, in mass-normalised rows.
//!
//! A tick: rows from manifolds, last tick's impulses, then in each substep forces, a sweep with soft rows, positions,
//! impacts at their times, a sweep without. What comes together fast has no rows: it strikes (`timeline`). Islands of
//! which a contact bears far more than its bodies weigh are solved directly instead of swept (`direct`).

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(all(target_arch = "x86_64", avx512))]
mod avx512;
mod color;
mod direct;
mod equations;
mod fast;
mod flight;
mod impact;
mod island;
mod kernel;
mod mobility;
mod mover;
#[cfg(any(test, plain))]
mod plain;
mod prepare;
mod repose;
mod rows;
mod scales;
mod show;
mod squeeze;
mod strike;
#[cfg(any(test, plain, target_arch = "x86_64"))]
mod sweep;
#[cfg(test)]
mod tests;
mod timeline;
mod turning;
#[cfg(any(test, plain, target_arch = "x86_64"))]
mod words;

use crate::body::{Bodies, Colliders};
use crate::contact::{Collision, Contact, Contacts, NEW, Pair, Touch};
use crate::motion::{Drive, Fault};
use crate::num::mul;
use crate::threads::Crew;
use color::Colors;
use direct::{Direct, GIVEN_UP, Rows};
use fast::{strikes, swings};
use flight::TICK;
pub use impact::{Impact, ImpactError, Striker, impact};
use island::{Islands, Vote, hard, vote};
use kernel::Kernel;
pub(crate) use mobility::Mobility;
use mover::Movers;
use prepare::{Basis, Joint};
pub(crate) use repose::Repose;

use rows::{Block, LANES};
pub(crate) use scales::Scales;
pub(crate) use show::Substep;
use timeline::{Settled, Stage, Timeline};
use turning::{Turning, turns};

/// How many substeps pass between sweeps that take back what pushing overlaps apart added to velocities: there is one
/// after every fifth substep and after the last; and in between for contacts with a row that pushes without bearing a load,
/// and for heavy ones: a stack with a heavy top would ring. With one after each substep for all, stacks and piles stand no
/// better and a tick takes 1.6 times as long.
const RELAX: u32 = 5;

/// So many pairs make a piece: 4 µs.
const PAIRS: usize = 512;

/// What two ways of computing how far two bodies overlap may differ by: 10 nm, Q32 m.
const ROUNDING: i64 = 43;

/// The solver's own memory. All of it is derived, and none of it but mobilities and scales lasts from tick to tick.
#[derive(Debug, Default)]
pub(crate) struct Solver {
    /// By slot of a body; kept by commands.
    pub(crate) mobilities: Vec<Mobility>,
    pub(crate) scales: Scales,
    /// By pair, whether it comes too fast for rows.
    coming: Vec<bool>,
    movers: Movers,
    before: Vec<[i64; 6]>,
    free: Vec<bool>,
    /// By contact: the places of its bodies among the movers, its pair, whether it is heavy and squeezes, how it was solved, and what it says
    /// of how its island is to be.
    places: Vec<[u32; 2]>,
    rows: Vec<u32>,
    heavy: Vec<bool>,
    modes: Vec<u8>,
    votes: Vec<Vote>,
    squeezed: Vec<bool>,
    islands: Islands,
    direct: Direct,
    /// Pairs that may strike.
    fast: Vec<u32>,
    /// Pairs that turn so fast that their rows are made anew in each substep.
    turning: Vec<u32>,
    timeline: Timeline,
    colors: Colors,
    blocks: Vec<Block>,
    kernel: Kernel,
    pub(crate) repose: Repose,
}

impl Clone for Solver {
    fn clone(&self) -> Self {
        Solver { mobilities: self.mobilities.clone(), scales: self.scales, ..Solver::default() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.mobilities.clone_from(&source.mobilities);
        self.scales = source.scales;
        self.timeline.collisions.clear();
        self.repose.clear();
    }
}

impl Solver {
    /// Rows for the pairs of this tick that touch or come near slowly, while the bodies are where it begins; what comes
    /// fast is left to strike.
    pub(crate) fn prepare(
        &mut self,
        touch: &mut Touch,
        contacts: &Contacts,
        bodies: &Bodies,
        drive: &Drive,
        crew: Crew,
    ) {
        let Solver {
            mobilities,
            scales,
            coming,
            movers,
            before,
            free,
            places,
            rows,
            heavy,
            modes,
            votes,
            squeezed,
            islands,
            direct,
            fast,
            turning,
            timeline,
            colors,
            blocks,
            kernel,
            repose,
        } = self;
        repose.confirm(&mut touch.pairs, bodies, drive);
        movers.clear(bodies.cold.len());
        movers.others = !repose.is_empty();
        timeline.clear(bodies.cold.len());
        places.clear();
        rows.clear();
        heavy.clear();
        modes.clear();
        votes.clear();
        squeezed.clear();
        fast.clear();
        turning.clear();
        coming.resize(touch.pairs.len(), false);
        crew.share((touch.pairs.as_slice(), coming.as_mut_slice()), PAIRS, |(pairs, coming)| {
            for (pair, coming) in pairs.iter().zip(coming) {
                let swings = || swings(pair, bodies, drive, mobilities, scales);
                *coming = !pair.stays
                    && (pair.manifold.count == 0 || strikes(pair, bodies, drive, scales, false) || swings());
            }
        });
        for (at, pair) in touch.pairs.iter().enumerate().filter(|(_, pair)| !pair.sensor) {
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
        // Without a hard contact nobody asks for votes.
        let mut any_hard = false;
        for (at, pair) in touch.pairs.iter_mut().enumerate().filter(|(_, pair)| pair.manifold.count > 0 && !pair.stays)
        {
            pair.row = places.len() as u32;
            // All that move have one by now.
            places.push(pair.bodies.map(|slot| movers.place_of(slot)));
            rows.push(at as u32);
            let old = pair.last(contacts);
            let overlap = overlap(pair);
            heavy.push(Scales::is_heavy(old.normal));
            squeezed.push(scales.is_squeezed(old.normal, overlap));
            modes.push(old.mode);
            any_hard |= hard(overlap, &old, scales);
        }
        if any_hard {
            votes.extend(rows.iter().map(|&at| {
                let pair = &touch.pairs[at as usize];
                let old = pair.last(contacts);
                vote(pair, &old, bodies, mobilities, scales)
            }));
        }
        if movers.turns {
            let turn = |pair: &Pair| pair.row != NEW && turns(pair, bodies, mobilities, scales);
            turning.extend(touch.pairs.iter().enumerate().filter(|(_, pair)| turn(pair)).map(|(at, _)| at as u32));
        }
        movers.look_brisk(repose.slots(), drive, scales);
        if !fast.is_empty() || movers.brisk {
            timeline.remember(bodies);
        }
        movers.remember(bodies, before);
        movers.yielding(mobilities, free);
        movers.find_squeezed(squeezed, places, free, drive, mobilities, scales);
        islands.find(places, free, votes);
        colors.assign(places, free, heavy, &islands.apart);
        blocks.resize_with(colors.blocks, Block::default);

        let basis = Basis { pairs: &touch.pairs, rows, places, heavy, contacts, bodies, mobilities, scales };
        basis.write(blocks, colors, *kernel, crew);
        let rows = Rows { places, modes, seats: &colors.seats, blocks };
        direct.build(islands, &rows, movers, mobilities, scales);
    }

    /// Impacts and substeps, after the bodies have moved as if nothing touched them; bodies that were struck or pushed are
    /// put where that brings them. `watch` sees what each substep leaves.
    #[allow(clippy::too_many_arguments, reason = "what a tick is made of, and who looks")]
    pub(crate) fn run(
        &mut self,
        touch: &mut Touch,
        bodies: &mut Bodies,
        colliders: &Colliders,
        contacts: &Contacts,
        drive: &Drive,
        faults: &mut Vec<Fault>,
        mut watch: impl FnMut(u32, Substep<'_>),
        crew: Crew,
    ) {
        let Solver {
            mobilities,
            scales,
            movers,
            before,
            free,
            places,
            direct,
            fast,
            turning,
            timeline,
            colors,
            blocks,
            kernel,
            repose,
            ..
        } = self;
        let stage =
            Stage { bodies, colliders, touch, drive, mobilities, scales, seats: &colors.seats, blocks: &[], repose };
        for &pair in &*fast {
            timeline.engage(pair as usize, &stage, movers);
        }
        if movers.is_empty() {
            timeline.run([0, TICK], &stage, movers, faults);
        } else {
            movers.take_kicks(bodies, mobilities, scales);
            let swept = colors.swept;
            for block in &blocks[..swept] {
                kernel.warm_start(block, &mut movers.lanes);
            }
            blocks[swept..].iter().for_each(|block| block.warm_start(&mut movers.lanes));
            for substep in 1..=scales.substeps {
                movers.begin(substep == 1, crew);
                for &pair in &*turning {
                    let anew = Turning { bodies, colliders, mobilities, scales, before };
                    let pair = &mut touch.pairs[pair as usize];
                    let seat = colors.seats[pair.row as usize] as usize;
                    if colors.is_apart(seat / LANES) {
                        continue;
                    }
                    anew.renew(pair, places[pair.row as usize], &mut blocks[seat / LANES], seat % LANES, movers);
                }
                for (_, block) in blocks.iter_mut().enumerate().filter(|&(at, _)| !colors.is_apart(at)) {
                    kernel.solve::<true>(block, u8::MAX, &mut movers.lanes, scales);
                }
                direct.solve::<true>(blocks, &mut movers.lanes, scales);
                movers.hold_back(mobilities);
                movers.drift(scales, crew);
                let seats = &colors.seats;
                let stage = Stage { bodies, colliders, touch, drive, mobilities, scales, seats, blocks, repose };
                timeline.run(scales.span(substep), &stage, movers, faults);
                for pair in timeline.retired.drain(..) {
                    let seat = colors.seats[touch.pairs[pair as usize].row as usize] as usize;
                    blocks[seat / LANES].retire(seat % LANES);
                }
                movers.welcome(mobilities, &timeline.past, before, free);
                for Settled { pair, manifold, between } in timeline.settled.drain(..) {
                    let (at, pair) = (pair, &mut touch.pairs[pair as usize]);
                    if !turning.contains(&at) && turns(pair, bodies, mobilities, scales) {
                        turning.push(at);
                    }
                    (pair.manifold, pair.row) = (manifold, places.len() as u32);
                    places.push(pair.bodies.map(|slot| movers.place_of(slot)));
                    let both = places[pair.row as usize];
                    let seat = colors.late(blocks, both, free);
                    let (block, i) = (&mut blocks[seat / LANES], seat % LANES);
                    let mobility = pair.bodies.map(|slot| &mobilities[slot as usize]);
                    Joint::new(pair, both, [between; 2], mobility).write(
                        block,
                        i,
                        &Contact::default(),
                        pair.friction,
                        scales,
                    );
                    block.backdate(i, &movers.lanes);
                }
                let all = substep % RELAX == 0 || substep == scales.substeps;
                for (_, block) in blocks.iter_mut().enumerate().filter(|&(at, _)| !colors.is_apart(at)) {
                    let lanes = if all { u8::MAX } else { block.pushes | block.heavy };
                    if lanes == 0 {
                        continue;
                    }
                    kernel.solve::<false>(block, lanes, &mut movers.lanes, scales);
                }
                direct.solve::<false>(blocks, &mut movers.lanes, scales);
                watch(substep, Substep { touch, bodies, movers, blocks, colors, timeline });
            }
            movers.hold_back(mobilities);
            for (row, &places) in places.iter().enumerate() {
                let seat = colors.seats[row] as usize;
                if blocks[seat / LANES].spent(seat % LANES) {
                    movers.hit(places);
                }
            }
        }
        // Bounds that bodies meet where they end: those in repose do not end there.
        let ends = faults.len();
        movers.store(bodies, before, mobilities, scales, faults);
        timeline.flights.store(bodies, movers, scales, faults);
        for &pair in &timeline.met {
            touch.pairs[pair as usize].met = true;
        }
        repose.put_back(bodies);
        self.settle(&mut touch.pairs, contacts, bodies, drive, (faults, ends));
        touch.join(&mut self.timeline.late, contacts);
    }

    /// Whether the tick may have moved what was left out of it: then it is to be computed again, with that.
    pub(crate) fn disturbs(&self) -> bool {
        self.timeline.disturbs
    }

    /// The slots of bodies that contacts moved in this tick by more than a speed (Q48 m/s) would: where overlaps are pushed
    /// apart, that is not in their velocities.
    pub(crate) fn shifted(&self, speed: i64) -> impl Iterator<Item = usize> {
        self.movers.shifted(mul(speed, self.scales.margins.tick, 79), &self.scales)
    }

    /// The collisions of the tick, to be named.
    pub(crate) fn collisions_mut(&mut self) -> &mut [Collision] {
        &mut self.timeline.collisions
    }

    /// Forgets the collisions of the tick.
    pub(crate) fn forget_collisions(&mut self) {
        self.timeline.collisions.clear();
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
        contact.mode = match self.modes.get(pair.row as usize) {
            _ if manifold.count == 0 => 0,
            _ if self.colors.is_apart(seat / LANES) => {
                self.direct.mode([0, 1].map(|body: usize| block.bodies[body][i]))
            }
            Some(&GIVEN_UP) => GIVEN_UP,
            _ => 0,
        };
        contact
    }
}

/// By how much a pair overlaps, Q32 m; negative by the gap, and nothing is as far as one without points.
fn overlap(pair: &Pair) -> i64 {
    let points = &pair.manifold.points[..pair.manifold.count as usize];
    points.iter().map(|point| point.separation.saturating_neg()).max().unwrap_or(i64::MIN)
}
