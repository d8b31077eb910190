//! Bodies that are pressed into each other: between walls, where they were created, by a blow.
//!
//! A row that is pressed from both sides bears a load that no weight explains, and stores it as a spring. The direction of
//! that changes a little from tick to tick, so it throws out sideways what it holds: discs between two walls slipped out at
//! 79 m/s. A body with such a row gets no faster by rows than it, or what it touches, would have been without, or than overlaps are
//! pushed apart.
//!
//! What failed: to hold back all that overlaps, whatever it bears (a heap that a drum lifts is not let come along: overlaps
//! of 15 cm for 7); to let them gain as much as their weight gives in a tick (discs slip out at 10 m/s).

use super::mobility::Mobility;
use super::mover::Movers;
use super::scales::Scales;
use crate::motion::Drive;
use crate::num::{clamp_i64, div, hypot, lane, round_shift};
use core::mem::take;

/// Who is squeezed in this tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Squeeze {
    /// By place, how fast a body may be: Q48 m/s over 2^k, and its rim as fast; 0 if as fast as it likes.
    most: Vec<i64>,
    /// The places of those that are held back.
    places: Vec<u32>,
}

impl Squeeze {
    /// Finds who is. `squeezed`, `pairs`: by contact, whether its bodies are, and their places; `free`: by place, what impulses leave
    /// as it is.
    pub(super) fn find(
        &mut self,
        squeezed: &[bool],
        pairs: &[[u32; 2]],
        (movers, free): (&Movers, &[bool]),
        drive: &Drive,
        mobilities: &[Mobility],
        scales: &Scales,
    ) {
        self.places.clear();
        self.most.clear();
        if !squeezed.contains(&true) {
            return;
        }
        self.most.resize(free.len(), 0);
        for &place in pairs.iter().zip(squeezed).filter(|&(_, &squeezed)| squeezed).flat_map(|(pair, _)| pair) {
            if !free[place as usize] && self.most[place as usize] == 0 {
                self.most[place as usize] = scales.recovery;
                self.places.push(place);
            }
        }
        for pair in pairs {
            if pair.map(|place| self.most[place as usize]) == [0; 2] {
                continue;
            }
            let speeds = pair.map(|place| if place == 0 { 0 } else { speed(place, movers, drive, mobilities, scales) });
            for most in pair.map(|place| place as usize) {
                let most = &mut self.most[most];
                *most = if *most > 0 { (*most).max(speeds[0]).max(speeds[1]) } else { 0 };
            }
        }
    }

    /// An impact changed the velocity of a body. σ is at least an eighth of its reach.
    pub(super) fn allow(&mut self, place: u32, change: [i64; 3]) {
        if let Some(most) = self.most.get_mut(place as usize).filter(|most| **most > 0) {
            let [x, y, w] = change;
            *most = most.saturating_add(length([x, y]).max(w.saturating_abs().saturating_mul(8)));
        }
    }

    /// Slows down what rows have made too fast.
    pub(super) fn hold(&self, mobilities: &[Mobility], movers: &mut Movers) {
        for &place in &self.places {
            let most = self.most[place as usize];
            let (mover, mobility) = (&movers.lanes[place as usize], &mobilities[movers.slot(place)]);
            let speed = length(mover.v);
            let [x, y] = mover.v.map(|v| if speed > most { scaled(v, most, speed) } else { v });
            let spin = scaled(most, mobility.sigma, mobility.reach);
            let w = lane::clamp(mover.w, spin.saturating_neg(), spin);
            if [x, y, w] != [mover.v[0], mover.v[1], mover.w] {
                movers.slow(place, [x, y, w]);
            }
        }
    }
}

impl Movers {
    /// Finds who is squeezed, of contacts between these places.
    pub(crate) fn find_squeezed(
        &mut self,
        squeezed: &[bool],
        pairs: &[[u32; 2]],
        free: &[bool],
        drive: &Drive,
        mobilities: &[Mobility],
        scales: &Scales,
    ) {
        let mut squeeze = take(&mut self.squeeze);
        squeeze.find(squeezed, pairs, (self, free), drive, mobilities, scales);
        self.squeeze = squeeze;
    }

    /// Slows down what rows have made too fast of what is squeezed.
    pub(crate) fn hold_back(&mut self, mobilities: &[Mobility]) {
        let squeeze = take(&mut self.squeeze);
        squeeze.hold(mobilities, self);
        self.squeeze = squeeze;
    }
}

/// How fast a body, or its rim, would be at the end of the tick if nothing touched it.
fn speed(place: u32, movers: &Movers, drive: &Drive, mobilities: &[Mobility], scales: &Scales) -> i64 {
    let (mover, slot) = (&movers.lanes[place as usize], movers.slot(place));
    let gain = drive.gain(slot, scales.margins.tick);
    let gain = gain.map(|gain| round_shift(gain.into(), scales.shift) as i64);
    let then = [0, 1].map(|axis: usize| mover.v[axis].saturating_add(gain[axis]));
    let rim = scaled(mover.w, mobilities[slot].reach, mobilities[slot].sigma);
    length(then).max(rim.saturating_abs())
}

fn length([x, y]: [i64; 2]) -> i64 {
    clamp_i64(i128::from(hypot(x, y)))
}

/// `value`·a/b; a and b are not negative.
fn scaled(value: i64, a: i64, b: i64) -> i64 {
    clamp_i64(div(i128::from(value).saturating_mul(a.into()), i128::from(b).max(1)))
}
