//! What the solver's memory holds between stages, and between substeps, field by field.
//!
//! Not shown are the factors of islands that are solved directly, and the queue of impacts: a fault in them shows in what they
//! make, the speeds of movers and the flights.

use super::Solver;
use super::color::Colors;
use super::flight::{Flight, State};
use super::mover::Movers;
use super::rows::{Block, LANES, Row};
use super::scales::Scales;
use super::timeline::Timeline;
use crate::body::Bodies;
use crate::contact::{Collision, NEW, Pace, Pair, Touch};
use crate::geom::Aabb;
use crate::store::{Cells, Draft, Kind, Show, Tables, show};

show!(Pace { velocity, angular_velocity });
show!(State { x, angle, v, omega });
show!(Scales {
    shift,
    substeps,
    rate,
    line,
    turn,
    coarse,
    close_rate,
    push_rate,
    rigid_rate,
    push,
    soft,
    firm,
    margins,
    tick_turn,
    slack,
    recovery,
    deep,
    touching,
    aside,
});
show!(Flight { slot, place, time, state, gain, weight, first, strikes, aside, around, looked, changed, pushed });

impl Show for Aabb {
    fn show(&self, cells: &mut Cells<'_>) {
        let Aabb { min, max } = self;
        cells.field("min", |c| min.show(c));
        cells.field("max", |c| max.show(c));
    }
}

impl Show for Collision {
    fn show(&self, cells: &mut Cells<'_>) {
        // Tick and ordinal are given when the tick ends.
        let Collision { tick: _, ordinal: _, a, b, order, time, point, normal, impulse, before, after } = self;
        cells.field("a", |c| a.show(c));
        cells.field("b", |c| b.show(c));
        cells.field("order", |c| order.show(c));
        cells.field("time", |c| time.show(c));
        cells.field("point", |c| point.show(c));
        cells.field("normal", |c| normal.show(c));
        cells.field("impulse", |c| impulse.show(c));
        cells.field("before", |c| before.show(c));
        cells.field("after", |c| after.show(c));
    }
}

/// A contact's lane of its block.
struct Lane<'b>(&'b Pair, &'b Block, usize);

impl Show for Lane<'_> {
    fn show(&self, cells: &mut Cells<'_>) {
        let Lane(pair, block, i) = *self;
        let Block { bodies, normal, reply, friction, points, limit, separation, peak, couple, pushes, heavy } = block;
        let row = |row: &Row, cells: &mut Cells<'_>| {
            let Row { arm, line, turn, impulse } = row;
            cells.field("arm", |c| arm.map(|lane| lane[i]).show(c));
            cells.field("line", |c| line[i].show(c));
            cells.field("turn", |c| turn.map(|lane| lane[i]).show(c));
            cells.field("impulse", |c| impulse[i].show(c));
        };
        cells.field("colliders", |c| pair.colliders.show(c));
        cells.field("places", |c| bodies.map(|lane| lane[i]).show(c));
        cells.field("normal", |c| normal.map(|lane| lane[i]).show(c));
        cells.field("reply", |c| reply.map(|side| side.map(|lane| lane[i])).show(c));
        cells.field("friction", |c| row(friction, c));
        for (at, point) in points.iter().enumerate() {
            cells.field("points", |c| c.element(at, |c| row(point, c)));
        }
        cells.field("limit", |c| limit.map(|lane| lane[i]).show(c));
        cells.field("separation", |c| separation.map(|lane| lane[i]).show(c));
        cells.field("peak", |c| peak.map(|lane| lane[i]).show(c));
        cells.field("couple", |c| couple.map(|lane| lane[i]).show(c));
        cells.field("pushes", |c| (pushes >> i & 1).show(c));
        cells.field("heavy", |c| (heavy >> i & 1).show(c));
    }
}

/// What a substep leaves: what the next one reads.
pub(crate) struct Substep<'s> {
    pub(crate) touch: &'s mut Touch,
    pub(crate) bodies: &'s mut Bodies,
    pub(crate) movers: &'s mut Movers,
    pub(crate) blocks: &'s mut [Block],
    pub(super) colors: &'s Colors,
    pub(super) timeline: &'s Timeline,
}

impl Substep<'_> {
    /// Hands on all of it as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        let Substep { touch, bodies, movers, blocks, colors, timeline } = self;
        draft.table(tables, "pairs", Kind::Pair, touch.pairs.iter());
        show_rows(draft, tables, &touch.pairs, blocks, colors);
        movers.show(draft, tables);
        draft.table(tables, "flights", Kind::OfBody, timeline.flights.list.iter());
        bodies.show_motion(draft, tables);
    }
}

fn show_rows(draft: &mut Draft, tables: &mut impl Tables, pairs: &[Pair], blocks: &[Block], colors: &Colors) {
    let rows = pairs.iter().filter(|pair| pair.row != NEW).filter_map(|pair| {
        let seat = *colors.seats.get(pair.row as usize)? as usize;
        Some(Lane(pair, blocks.get(seat / LANES)?, seat % LANES))
    });
    draft.table(tables, "rows", Kind::Pair, rows);
}

/// What of the solver a fault may hit, in tests.
#[cfg(test)]
impl Solver {
    pub(crate) fn memory(&mut self) -> (&mut [Block], &mut Movers, &mut [Collision]) {
        (&mut self.blocks, &mut self.movers, &mut self.timeline.collisions)
    }

    /// Where the row of a pair sits: block and lane.
    pub(crate) fn seat(&self, row: u32) -> (usize, usize) {
        let seat = self.colors.seats[row as usize] as usize;
        (seat / LANES, seat % LANES)
    }
}

impl Solver {
    /// Hands on what lasts from tick to tick as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        draft.table(tables, "mobilities", Kind::Body, self.mobilities.iter());
        draft.table(tables, "scales", Kind::World, core::iter::once(&self.scales));
    }

    /// Hands on what is of one tick, from the preparation of its rows on.
    pub(crate) fn show_tick(&self, touch: &Touch, draft: &mut Draft, tables: &mut impl Tables) {
        let Solver { movers, before, free, constraints, fast, turning, timeline, colors, blocks, .. } = self;
        show_rows(draft, tables, &touch.pairs, blocks, colors);
        movers.show(draft, tables);
        draft.table(tables, "movers when the tick began", Kind::List, before.iter());
        draft.table(tables, "movers that no impulse moves", Kind::List, free.iter());
        draft.table(tables, "how contacts are solved", Kind::List, constraints.modes.iter());
        draft.table(tables, "pairs that may strike", Kind::List, fast.iter());
        draft.table(tables, "pairs that turn", Kind::List, turning.iter());
        if !fast.is_empty() || movers.brisk {
            draft.table(tables, "bodies when the tick began", Kind::Body, timeline.past.rows());
        }
        draft.table(tables, "flights", Kind::OfBody, timeline.flights.list.iter());
        draft.table(tables, "collisions", Kind::Contact, timeline.collisions.iter());
    }
}
