//! Who sleeps: for how long each body has been quiet, and which bodies a tick moves.

use super::bodies::Bodies;
use crate::num::{Decimal, Quantity, RangeError, Time, Velocity, div, mul};
use crate::store::{
    DecodeError, Draft, Kind, Reader, Record, Sink, Tables, clone_fields, put_count, record_copy, show,
};
use core::ops::Range;
use serde::{Deserialize, Serialize};

/// When bodies fall asleep. What hangs together by contacts, but for those with static and kinematic bodies, falls asleep
/// together, once each of it has been quiet for long enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sleeping {
    /// The speed, in m/s, up to which a body is quiet: that of its centre of mass, and that of its rim, |ω| times its reach
    /// (for a body without colliders times 1 m). 0 … 400, times 2^k with k the world's `unit_shift`. 0.05 by default.
    pub speed: Velocity,
    /// For how long all have to be quiet, in s, 0 … 1000, rounded to ticks; one at least. 0.5 by default.
    pub time: Time,
}

record_copy!(Sleeping { speed, time } shown);

impl Default for Sleeping {
    fn default() -> Self {
        Sleeping { speed: Velocity::from_bits(div(1 << 48, 20) as i64), time: Time::from_bits(1 << 47) }
    }
}

impl Sleeping {
    /// Whether bodies can sleep so.
    pub(crate) fn check(&self) -> Result<(), RangeError> {
        let within = |value: Decimal, most: i128| (0..=most << 48).contains(&value.bits);
        let error = |quantity, unit, value, accepted| Err(RangeError { quantity, unit, value, accepted });
        if !within(self.speed.decimal(), 400) {
            return error("speed of what falls asleep", Velocity::UNIT, self.speed.decimal(), "0 … 400");
        }
        if !within(self.time.decimal(), 1000) {
            return error("time of falling asleep", Time::UNIT, self.time.decimal(), "0 … 1000");
        }
        Ok(())
    }

    /// The speed, Q48 m/s, and the number of ticks.
    pub(crate) fn limits(&self, tick_rate: u32, unit_shift: u32) -> (i64, u32) {
        let ticks = i128::from(self.time.to_bits()).saturating_mul(tick_rate.into());
        let ticks = ticks.saturating_add(1 << 47) >> 48;
        (self.speed.to_bits() << unit_shift, (ticks as u32).max(1))
    }
}

/// As a number of quiet ticks: the body sleeps.
const ASLEEP: u32 = u32::MAX;

/// For how many ticks each body has been quiet, or that it sleeps.
#[derive(Debug, Default)]
pub(crate) struct Rest {
    /// By slot, 0 for what is not dynamic; empty in a world without sleeping.
    ticks: Vec<u32>,
    /// Whether the world has sleeping. Derived, as all that follows.
    on: bool,
    /// How many sleep.
    sleepers: u32,
    /// From which slot on, and up to which, none sleeps: all of what a tick moves, in order.
    runs: Vec<[u32; 2]>,
    /// Whether the runs are to be found anew.
    stale: bool,
}

clone_fields!(Rest { ticks, on, sleepers, runs, stale });

impl Rest {
    /// Derives what is derived, for as many slots.
    pub(crate) fn derive(&mut self, on: bool, slots: usize) {
        (self.on, self.stale) = (on, on);
        self.sleepers = self.ticks.iter().filter(|&&ticks| ticks == ASLEEP).count() as u32;
        self.grow(slots);
        self.settle();
    }

    /// Room for as many slots.
    pub(super) fn grow(&mut self, slots: usize) {
        if self.on {
            self.stale |= self.ticks.len() != slots;
            self.ticks.resize(slots, 0);
        } else {
            self.runs.clear();
            self.runs.push([0, slots as u32]);
        }
    }

    /// Finds the runs, if need be.
    pub(crate) fn settle(&mut self) {
        if !core::mem::take(&mut self.stale) {
            return;
        }
        let Rest { ticks, runs, .. } = self;
        runs.clear();
        let mut slot = 0;
        while slot < ticks.len() {
            let asleep = ticks[slot] == ASLEEP;
            let same = ticks[slot..].iter().take_while(|&&ticks| (ticks == ASLEEP) == asleep).count();
            let end = slot.saturating_add(same);
            if !asleep {
                runs.push([slot as u32, end as u32]);
            }
            slot = end;
        }
    }

    /// How many runs there are.
    pub(crate) fn runs(&self) -> usize {
        self.runs.len()
    }

    /// The slots of a run.
    pub(crate) fn run(&self, at: usize) -> Range<usize> {
        let [start, end] = self.runs[at];
        start as usize..end as usize
    }

    /// The slots of all runs.
    pub(crate) fn all_runs(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        (0..self.runs()).map(|at| self.run(at))
    }

    /// Whether a body sleeps.
    #[inline]
    pub(crate) fn is_asleep(&self, slot: usize) -> bool {
        self.ticks.get(slot) == Some(&ASLEEP)
    }

    /// Whether any body sleeps.
    #[inline]
    pub(crate) fn any_asleep(&self) -> bool {
        self.sleepers > 0
    }

    /// For how many ticks a body that is awake has been quiet.
    pub(crate) fn quiet(&self, slot: usize) -> u32 {
        self.ticks.get(slot).copied().filter(|&ticks| ticks != ASLEEP).unwrap_or(0)
    }

    /// Notes for how many ticks a body that is awake has been quiet.
    pub(crate) fn note(&mut self, slot: usize, ticks: u32) {
        debug_assert!(ticks < ASLEEP && !self.is_asleep(slot), "only what is awake is quiet or not");
        if let Some(known) = self.ticks.get_mut(slot) {
            *known = ticks;
        }
    }

    /// Puts a body to sleep. Whether it was awake.
    pub(crate) fn lull(&mut self, slot: usize) -> bool {
        let awake = self.on && !self.is_asleep(slot);
        if awake {
            self.ticks[slot] = ASLEEP;
            self.sleepers = self.sleepers.saturating_add(1);
            self.stale = true;
        }
        awake
    }

    /// Wakes a body, or begins to count anew. Whether it slept.
    pub(crate) fn rouse(&mut self, slot: usize) -> bool {
        let asleep = self.is_asleep(slot);
        if asleep {
            self.sleepers = self.sleepers.saturating_sub(1);
            self.stale = true;
        }
        if let Some(ticks) = self.ticks.get_mut(slot) {
            *ticks = 0;
        }
        asleep
    }

    /// Hands on who sleeps as tables. `sorted`: whether the runs are what a tick reads.
    pub(super) fn show(&self, sorted: bool, draft: &mut Draft, tables: &mut impl Tables) {
        struct Quiet {
            ticks: u32,
        }
        show!(Quiet { ticks });
        struct Sleepers {
            count: u32,
        }
        show!(Sleepers { count });
        draft.table(tables, "quiet", Kind::Body, self.ticks.iter().map(|&ticks| Quiet { ticks }));
        draft.table(tables, "sleepers", Kind::World, core::iter::once(Sleepers { count: self.sleepers }));
        if sorted {
            draft.table(tables, "runs of slots awake", Kind::List, self.runs.iter());
        }
    }

    /// What these numbers say; what follows from them is to be derived.
    pub(crate) fn of(numbers: &[u32]) -> Rest {
        Rest { ticks: numbers.to_vec(), ..Rest::default() }
    }

    /// The numbers: for how many ticks each body has been quiet, or that it sleeps.
    pub(crate) fn numbers(&self) -> &[u32] {
        &self.ticks
    }

    /// Puts numbers back, those of as many slots as there are now. Who sleeps and did not, or the other way round, is added
    /// to `turned`.
    pub(crate) fn revert(&mut self, numbers: &[u32], on: bool, slots: usize, turned: &mut Vec<u32>) {
        (self.on, self.stale) = (on, on && (self.stale || !self.on));
        if self.ticks != numbers {
            let (known, asleep) = (turned.len(), |ticks: Option<&u32>| ticks == Some(&ASLEEP));
            for slot in 0..self.ticks.len().max(numbers.len()) {
                if asleep(self.ticks.get(slot)) != asleep(numbers.get(slot)) {
                    turned.push(slot as u32);
                }
            }
            self.stale |= self.on && (turned.len() > known || self.ticks.len() != numbers.len());
            self.ticks.clear();
            self.ticks.extend_from_slice(numbers);
            self.sleepers = self.ticks.iter().filter(|&&ticks| ticks == ASLEEP).count() as u32;
        }
        self.grow(slots);
    }

    /// The numbers and how many sleep as memory has them, for faults.
    #[cfg(test)]
    pub(crate) fn memory(&mut self) -> (&mut Vec<u32>, &mut u32) {
        (&mut self.ticks, &mut self.sleepers)
    }

    /// XXH3-64 of the numbers' little-endian bytes.
    pub(crate) fn hash(&self) -> u64 {
        crate::store::hash_numbers(&self.ticks)
    }

    /// The slots of which something is kept: all, or none.
    pub(crate) fn len(&self) -> usize {
        self.ticks.len()
    }

    /// Whether the runs are those of the numbers, unless they are to be found anew.
    pub(super) fn check(&self, slots: usize) -> Result<(), &'static str> {
        let mut fresh = Rest { ticks: self.ticks.clone(), ..Rest::default() };
        fresh.derive(self.on, slots);
        if fresh.sleepers != self.sleepers || !self.stale && fresh.runs != self.runs {
            return Err("does not know who sleeps");
        }
        Ok(())
    }
}

impl Record for Rest {
    const LEAST: usize = 4;

    fn save(&self, sink: &mut impl Sink) {
        let Rest { ticks, on: _, sleepers: _, runs: _, stale: _ } = self;
        put_count(sink, ticks.len());
        for ticks in ticks {
            ticks.save(sink);
        }
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let count = reader.take_count(u32::LEAST, field)?;
        let mut ticks = Vec::with_capacity(count);
        for _ in 0..count {
            ticks.push(u32::load(reader, field)?);
        }
        Ok(Rest::of(&ticks))
    }

    fn diff(&self, _: &Self, _: &mut crate::store::Diff) {
        // Slot by slot, with the bodies.
    }
}

impl Bodies {
    /// Whether a body stays where it is in every tick: a static one, and one that sleeps.
    #[inline]
    pub(crate) fn is_still(&self, slot: usize) -> bool {
        self.cold.value(slot).kind == super::BodyKind::Static || self.rest.is_asleep(slot)
    }

    /// Whether a body is so slow that it is quiet: both its speeds up to `speed`, Q48 m/s, of the rim as of the centre.
    pub(crate) fn is_quiet(&self, slot: usize, speed: i64) -> bool {
        let (vx, vy) = (self.vx.bits()[slot].unsigned_abs(), self.vy.bits()[slot].unsigned_abs());
        let most = speed.unsigned_abs();
        if vx > most || vy > most {
            return false;
        }
        let square = |v: u64| u128::from(v).saturating_mul(v.into());
        if square(vx).saturating_add(square(vy)) > square(most) {
            return false;
        }
        let omega = self.omega.bits()[slot].saturating_abs();
        let reach = match self.cold.value(slot).reach.to_bits() {
            0 => 1 << 32,
            reach => reach,
        };
        mul(omega, reach, 32) <= speed
    }

    /// Keeps what of the bodies that are awake a step changes.
    pub(crate) fn remember(&self, copy: &mut Vec<i64>) {
        let Bodies { cold: _, rest, x, y, vx, vy, angle, omega } = self;
        copy.clear();
        for column in [x.bits(), y.bits(), vx.bits(), vy.bits(), angle.bits(), omega.bits()] {
            rest.all_runs().for_each(|run| copy.extend_from_slice(&column[run]));
        }
    }

    /// Takes all of that back; nobody has woken or fallen asleep since.
    pub(crate) fn take_back(&mut self, copy: &[i64]) {
        let Bodies { cold: _, rest, x, y, vx, vy, angle, omega } = self;
        let mut copy = copy;
        let columns = [x.bits_mut(), y.bits_mut(), vx.bits_mut(), vy.bits_mut(), angle.bits_mut(), omega.bits_mut()];
        for column in columns {
            for run in rest.all_runs() {
                let run = &mut column[run];
                let (now, later) = copy.split_at(run.len());
                run.copy_from_slice(now);
                copy = later;
            }
        }
    }
}
