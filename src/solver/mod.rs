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
mod constraints;
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
use constraints::Constraints;
use direct::{Direct, GIVEN_UP, Rows};
use flight::TICK;
pub use impact::{Impact, ImpactError, Striker, impact};
use island::Islands;
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
    constraints: Constraints,
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
        self.repose.confirm(&mut touch.pairs, bodies, drive);
        self.movers.clear(bodies.cold.len());
        self.movers.others = !self.repose.is_empty();
        self.timeline.clear(bodies.cold.len());
        self.part(&mut touch.pairs, bodies, drive, crew);
        self.constrain(&mut touch.pairs, contacts, bodies);
        self.look_back(bodies, drive);

        let Solver { mobilities, scales, movers, free, constraints, islands, direct, colors, blocks, kernel, .. } =
            self;
        let Constraints { places, pairs: rows, heavy, squeezed, modes, votes } = &*constraints;
        movers.find_squeezed(squeezed, places, free, drive, mobilities, scales);
        islands.find(places, free, votes);
        colors.assign(places, free, heavy, &islands.apart);
        blocks.resize_with(colors.blocks, Block::default);
        let basis = Basis { pairs: &touch.pairs, rows, places, heavy, contacts, bodies, mobilities, scales };
        basis.write(blocks, colors, *kernel, crew);
        direct.build(islands, &Rows { places, modes, seats: &colors.seats, blocks }, movers, mobilities, scales);
    }

    /// Notes where the tick begins: bodies have moved by the time rows and impacts ask for it.
    fn look_back(&mut self, bodies: &Bodies, drive: &Drive) {
        let Solver { mobilities, scales, movers, before, free, fast, timeline, repose, .. } = self;
        movers.look_brisk(repose.slots(), drive, scales);
        if !fast.is_empty() || movers.brisk {
            timeline.remember(bodies);
        }
        movers.remember(bodies, before);
        movers.yielding(mobilities, free);
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
        self.engage(touch, bodies, colliders, drive);
        if self.movers.is_empty() {
            self.strike([0, TICK], touch, bodies, colliders, drive, faults);
        } else {
            self.warm_start(bodies);
            for substep in 1..=self.scales.substeps {
                self.movers.begin(substep == 1, crew);
                self.renew(&mut touch.pairs, bodies, colliders);
                self.sweep::<true>(|_| u8::MAX);
                self.movers.hold_back(&self.mobilities);
                self.movers.drift(&self.scales, crew);
                self.strike(self.scales.span(substep), touch, bodies, colliders, drive, faults);
                self.admit(&mut touch.pairs, bodies);
                let all = substep % RELAX == 0 || substep == self.scales.substeps;
                self.sweep::<false>(|block| if all { u8::MAX } else { block.pushes | block.heavy });
                let Solver { movers, blocks, colors, timeline, .. } = self;
                watch(substep, Substep { touch, bodies, movers, blocks, colors, timeline });
            }
            self.end_rows();
        }
        // Bounds that bodies meet where they end: those in repose do not end there.
        let ends = faults.len();
        let Solver { mobilities, scales, movers, before, timeline, repose, .. } = self;
        movers.store(bodies, before, mobilities, scales, faults);
        timeline.flights.store(bodies, movers, scales, faults);
        for &pair in &timeline.met {
            touch.pairs[pair as usize].met = true;
        }
        repose.put_back(bodies);
        self.settle(&mut touch.pairs, contacts, bodies, drive, (faults, ends));
        touch.join(&mut self.timeline.late, contacts);
    }

    /// Looks for when the pairs that come fast meet.
    fn engage(&mut self, touch: &Touch, bodies: &Bodies, colliders: &Colliders, drive: &Drive) {
        let Solver { mobilities, scales, movers, fast, timeline, colors, repose, .. } = self;
        let seats = &colors.seats;
        let stage = Stage { bodies, colliders, touch, drive, mobilities, scales, seats, blocks: &[], repose };
        for &pair in &*fast {
            timeline.engage(pair as usize, &stage, movers);
        }
    }

    /// Last tick's impulses.
    fn warm_start(&mut self, bodies: &Bodies) {
        let Solver { mobilities, scales, movers, colors, blocks, kernel, .. } = self;
        movers.take_kicks(bodies, mobilities, scales);
        let (swept, apart) = blocks.split_at(colors.swept);
        for block in swept {
            kernel.warm_start(block, &mut movers.lanes);
        }
        apart.iter().for_each(|block| block.warm_start(&mut movers.lanes));
    }

    /// Makes the rows of what turns fast anew.
    fn renew(&mut self, pairs: &mut [Pair], bodies: &Bodies, colliders: &Colliders) {
        let Solver { mobilities, scales, movers, before, constraints, turning, colors, blocks, .. } = self;
        let anew = Turning { bodies, colliders, mobilities, scales, before };
        for &pair in &*turning {
            let pair = &mut pairs[pair as usize];
            let seat = colors.seats[pair.row as usize] as usize;
            if !colors.is_apart(seat / LANES) {
                let places = constraints.places[pair.row as usize];
                anew.renew(pair, places, &mut blocks[seat / LANES], seat % LANES, movers);
            }
        }
    }

    /// Goes through all rows once, and of swept blocks through those lanes.
    fn sweep<const BIASED: bool>(&mut self, lanes: impl Fn(&Block) -> u8) {
        let Solver { scales, movers, direct, colors, blocks, kernel, .. } = self;
        for (_, block) in blocks.iter_mut().enumerate().filter(|&(at, _)| !colors.is_apart(at)) {
            let lanes = lanes(block);
            if lanes != 0 {
                kernel.solve::<BIASED>(block, lanes, &mut movers.lanes, scales);
            }
        }
        direct.solve::<BIASED>(blocks, &mut movers.lanes, scales);
    }

    /// The impacts of a part of the tick, Q32.
    fn strike(
        &mut self,
        span: [i64; 2],
        touch: &Touch,
        bodies: &Bodies,
        colliders: &Colliders,
        drive: &Drive,
        faults: &mut Vec<Fault>,
    ) {
        let Solver { mobilities, scales, movers, timeline, colors, blocks, repose, .. } = self;
        let seats = &colors.seats;
        let stage = Stage { bodies, colliders, touch, drive, mobilities, scales, seats, blocks, repose };
        timeline.run(span, &stage, movers, faults);
    }

    /// After impacts: takes the rows from what struck and parts, and gives rows to what struck and stays together.
    fn admit(&mut self, pairs: &mut [Pair], bodies: &Bodies) {
        let Solver { mobilities, scales, movers, before, free, constraints, turning, timeline, colors, blocks, .. } =
            self;
        for pair in timeline.retired.drain(..) {
            let seat = colors.seats[pairs[pair as usize].row as usize] as usize;
            blocks[seat / LANES].retire(seat % LANES);
        }
        movers.welcome(mobilities, &timeline.past, before, free);
        for Settled { pair: at, manifold, between } in timeline.settled.drain(..) {
            let pair = &mut pairs[at as usize];
            if !turning.contains(&at) && turns(pair, bodies, mobilities, scales) {
                turning.push(at);
            }
            let places = pair.bodies.map(|slot| movers.place_of(slot));
            (pair.manifold, pair.row) = (manifold, constraints.places.len() as u32);
            constraints.places.push(places);
            let seat = colors.late(blocks, places, free);
            let (block, i) = (&mut blocks[seat / LANES], seat % LANES);
            let joint = Joint::new(pair, places, [between; 2], pair.bodies.map(|slot| &mobilities[slot as usize]));
            joint.write(block, i, &Contact::default(), pair.friction, scales);
            block.backdate(i, &movers.lanes);
        }
    }

    /// After the last substep: notes whom rows pushed.
    fn end_rows(&mut self) {
        let Solver { mobilities, movers, constraints, colors, blocks, .. } = self;
        movers.hold_back(mobilities);
        for (&places, &seat) in constraints.places.iter().zip(&colors.seats) {
            let seat = seat as usize;
            if blocks[seat / LANES].spent(seat % LANES) {
                movers.hit(places);
            }
        }
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
        contact.mode = match self.constraints.modes.get(pair.row as usize) {
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
