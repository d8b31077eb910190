//! Movers, field by field.

use super::{Course, Mover, Movers};
use crate::store::{Cells, Draft, Kind, Show, Tables, show};

show!(Mover { v, w, phi, d });
show!(Course { slot, start, begin, kick, cut, sum, spin_max, hit, pushed, slowed });

/// A body as rows see it: the speeds of a substep's beginning, those that they make of them, and how fast
/// it may be if it is squeezed.
struct Moved<'m>(&'m Course, &'m Mover, i64);

impl Show for Moved<'_> {
    fn show(&self, cells: &mut Cells<'_>) {
        self.0.show(cells);
        self.1.show(cells);
        cells.field("most", |c| self.2.show(c));
    }
}

impl Movers {
    /// Hands on all of it as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        let movers = self.courses.iter().zip(&self.lanes).enumerate();
        let movers = movers.map(|(place, (course, lane))| Moved(course, lane, self.squeeze.most(place)));
        draft.table(tables, "movers", Kind::OfBody, movers);
    }
}
