//! Bodies that rows send another way than the one on which it was looked whom they may meet.
//!
//! Pairs of a tick are found around the ways that bodies would go freely, and rows leave these by little: a body that they
//! stop is where it was. But what is thrown, deflected, or limited in its speed comes to where nobody expects it.

use super::super::flight::Flight;
use super::super::mover::Movers;
use super::{Stage, Timeline};

impl Timeline {
    /// After rows have given ways for a substep, which ends at `to`: who leaves where it was looked for neighbours is looked
    /// for them again.
    pub(super) fn look_aside(&mut self, to: i64, stage: &Stage<'_>, movers: &Movers) {
        for slot in movers.turned_aside(stage.scales) {
            self.flight(slot, stage, movers);
        }
        for place in 0..self.flights.list.len() {
            if !self.is_astray(place, to, stage, movers) {
                continue;
            }
            let flight = &mut self.flights.list[place];
            flight.surround(stage.mobilities[flight.slot as usize].reach, stage.scales);
            if !flight.aside {
                flight.aside = true;
                self.struck.push(place as u32);
            }
            // Whom rows hold it against, they know.
            self.find_again(place, stage, movers, |_, _, _| true);
        }
    }

    /// Whether a body's way of this substep leads to where it was not looked for neighbours.
    fn is_astray(&self, place: usize, to: i64, stage: &Stage<'_>, movers: &Movers) -> bool {
        let (flight, scales) = (&self.flights.list[place], stage.scales);
        let slot = flight.slot as usize;
        if !flight.pushed || !stage.mobilities[slot].moves() {
            return false;
        }
        if flight.aside {
            let reach = stage.mobilities[slot].reach;
            return !flight.around.contains(&flight.box_at(to, reach, scales));
        }
        if !movers.is_aside(flight.place, scales) {
            return false;
        }
        let free = Flight { state: self.past.state(slot), ..Flight::default() };
        let (there, free) = (flight.place_at(to, scales), free.place_at(to, scales));
        (0..2).any(|axis| there[axis].abs_diff(free[axis]) > scales.astray().unsigned_abs())
    }
}
