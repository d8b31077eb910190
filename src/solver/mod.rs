//! The contact solver: substepped, soft, in mass-normalised rows.
//!
//! A tick: rows from manifolds, last tick's impulses, then in each substep forces, a sweep with soft rows, positions, a
//! sweep without; at the end the bounces.

mod bounce;
mod color;
mod impact;
mod mobility;
mod mover;
mod prepare;
mod rows;
mod scales;

use crate::body::{Bodies, Colliders};
use crate::contact::{Contact, Contacts, NEW, Touch};
use crate::motion::Fault;
use bounce::Bounce;
use color::Colors;
pub use impact::{Impact, ImpactError, Striker, impact};
pub(crate) use mobility::Mobility;
use mover::Movers;
use prepare::Joint;
use rows::{Block, LANES};
pub(crate) use scales::Scales;

/// How many substeps pass between sweeps that take back what pushing overlaps apart added to velocities: there is one
/// after every fifth substep and after the last; and in between for contacts with a row that pushes without bearing a load.
/// With one after each substep, stacks and piles stand no better and a tick takes 1.6 times as long.
const RELAX: u32 = 5;

/// The solver's own memory. All of it is derived, and none of it but mobilities and scales lasts from tick to tick.
#[derive(Debug, Default)]
pub(crate) struct Solver {
    /// By slot of a body; kept by commands.
    pub(crate) mobilities: Vec<Mobility>,
    pub(crate) scales: Scales,
    movers: Movers,
    before: Vec<[i64; 6]>,
    free: Vec<bool>,
    places: Vec<[u32; 2]>,
    /// By pair: its place among those with rows. Pairs with sensors have none.
    rows: Vec<u32>,
    colors: Colors,
    blocks: Vec<Block>,
    bounces: Vec<Bounce>,
    bounced: Vec<bool>,
}

impl Clone for Solver {
    fn clone(&self) -> Self {
        Solver { mobilities: self.mobilities.clone(), scales: self.scales, ..Solver::default() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.mobilities.clone_from(&source.mobilities);
        self.scales = source.scales;
    }
}

impl Solver {
    /// Rows for the pairs of this tick, while the bodies are where it begins.
    pub(crate) fn prepare(&mut self, touch: &Touch, contacts: &Contacts, bodies: &Bodies, colliders: &Colliders) {
        let Solver { mobilities, scales, movers, before, free, places, rows, colors, blocks, bounces, bounced } = self;
        movers.clear(bodies.cold.len());
        places.clear();
        rows.clear();
        bounces.clear();
        bounced.clear();
        for pair in &touch.pairs {
            rows.push(places.len() as u32);
            if pair.manifold.count > 0 {
                places.push(pair.bodies.map(|slot| movers.place(slot, bodies, &mobilities[slot as usize], scales)));
            }
        }
        movers.remember(bodies, before);
        movers.yielding(mobilities, free);
        colors.assign(places, free);
        blocks.resize_with(colors.blocks, Block::default);
        blocks.iter_mut().for_each(Block::clear);
        bounced.resize(places.len(), false);

        let solid = touch.pairs.iter().filter(|pair| pair.manifold.count > 0);
        for (row, pair) in solid.enumerate() {
            let [a, b] = pair.bodies.map(|slot| slot as usize);
            let between = |c: &[i64]| c[b].saturating_sub(c[a]);
            let between = [between(bodies.x.bits()), between(bodies.y.bits())];
            let joint = Joint::new(pair, places[row], between, [&mobilities[a], &mobilities[b]]);
            let [first, second] = pair.colliders.map(|slot| colliders.rows.value(slot as usize));
            let friction = first.friction.combine(second.friction).to_bits();
            let old = if pair.old == NEW { Contact::default() } else { contacts.get(pair.old as usize) };
            let seat = colors.seats[row] as usize;
            joint.write(&mut blocks[seat / LANES], seat % LANES, &old, friction, scales);
            let restitution = first.restitution.combine(second.restitution).to_bits();
            bounces.extend(joint.bounce(row as u32, &movers.lanes, restitution, scales));
        }
    }

    /// The substeps, after the bodies have moved as if nothing touched them; bodies that contacts pushed are put where
    /// contacts bring them.
    pub(crate) fn run(&mut self, bodies: &mut Bodies, faults: &mut Vec<Fault>) {
        let Solver { mobilities, scales, movers, before, places, colors, blocks, bounces, bounced, .. } = self;
        if blocks.is_empty() {
            return;
        }
        movers.take_kicks(bodies, mobilities, scales);
        for block in blocks.iter_mut() {
            block.warm_start(&mut movers.lanes);
        }
        for substep in 1..=scales.substeps {
            movers.begin(substep == 1);
            for block in blocks.iter_mut() {
                block.solve::<true>(u8::MAX, &mut movers.lanes, scales);
            }
            movers.drift(scales);
            let all = substep % RELAX == 0 || substep == scales.substeps;
            for block in blocks.iter_mut().filter(|block| all || block.pushes != 0) {
                let lanes = if all { u8::MAX } else { block.pushes };
                block.solve::<false>(lanes, &mut movers.lanes, scales);
            }
        }
        let spent = |row: usize| {
            let seat = colors.seats[row] as usize;
            blocks[seat / LANES].spent(seat % LANES)
        };
        for (row, &places) in places.iter().enumerate() {
            if spent(row) != [0; 2] {
                movers.hit(places);
            }
        }
        for bounce in bounces.iter() {
            let row = bounce.row as usize;
            let fast = bounce.speed < movers.still(bounce, scales).saturating_neg();
            if fast && spent(row) != [0; 2] {
                bounce.solve(&mut movers.lanes, spent(row));
                bounced[row] = true;
            }
        }
        movers.store(bodies, before, mobilities, scales, faults);
    }

    /// What became of a contact, for the next tick. `pair` is its place among the pairs.
    pub(crate) fn outcome(&self, touch: &Touch, pair: usize) -> Contact {
        let row = self.rows[pair] as usize;
        let seat = self.colors.seats[row] as usize;
        let (block, i) = (&self.blocks[seat / LANES], seat % LANES);
        let manifold = &touch.pairs[pair].manifold;
        let mut contact = Contact { count: manifold.count, ..Contact::default() };
        for at in 0..manifold.count as usize {
            contact.ids[at] = manifold.points[at].id;
            contact.touching |= block.peak[at][i] > 0 || manifold.points[at].separation <= 0;
        }
        // What stopped a body is spent: as the load of a contact at rest it would throw it back.
        if !self.bounced[row] {
            contact.normal = [0, 1].map(|at| block.points[at].carried(i));
            contact.tangent[0] = block.friction.carried(i);
        }
        contact
    }
}
