//! One bit of memory, between stages, between substeps, or before a stage reads it.

use super::{Dice, PUSHED, shake, world_of_everything};
use crate::World;
use crate::contact::NEW;
use crate::replay::evidence::{Evidence, Origin, Taker};
use crate::replay::finding::{Divergence, Finding};
use crate::solver::Substep;
use crate::store::Draft;
use crate::threads::Crew;
use crate::world::{Stage, Watch};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// What a fault did: the row of its table, and the bits before and after.
pub(super) type Done = Option<(usize, u128, u128)>;

/// A kind of field: its table, its name, from which stage to which it is there, and what flips a bit of it.
pub(super) struct Kind {
    pub(super) table: &'static str,
    pub(super) field: &'static str,
    stages: [Stage; 2],
    pub(super) flip: fn(&mut World, &mut Dice) -> Done,
}

trait Bits: Copy {
    fn flipped(self, dice: &mut Dice) -> Self;
    fn wide(self) -> u128;
}

macro_rules! bits {
    ($($type:ident as $unsigned:ident;)*) => {$(
        impl Bits for $type {
            fn flipped(self, dice: &mut Dice) -> Self {
                self ^ (1 << dice.below($type::BITS as usize))
            }

            fn wide(self) -> u128 {
                u128::from(self as $unsigned)
            }
        }
    )*};
}

bits! { u8 as u8; u32 as u32; u64 as u64; u128 as u128; i32 as u32; i64 as u64; i128 as u128; }

/// Only that bit of it is memory that may change.
impl Bits for bool {
    fn flipped(self, _: &mut Dice) -> Self {
        !self
    }

    fn wide(self) -> u128 {
        self.into()
    }
}

fn flip<T: Bits>(value: &mut T, row: usize, dice: &mut Dice) -> Done {
    let before = *value;
    *value = before.flipped(dice);
    Some((row, before.wide(), value.wide()))
}

/// A quantity: its raw bits.
macro_rules! raw {
    ($value:expr, $row:expr, $dice:expr) => {{
        let mut bits = $value.to_bits();
        let done = flip(&mut bits, $row, $dice);
        $value = quantity(&$value, bits);
        done
    }};
}

/// A quantity of the same type with other bits.
fn quantity<Q: FromRaw>(_: &Q, bits: Q::Raw) -> Q {
    Q::from_raw(bits)
}

trait FromRaw {
    type Raw;
    fn from_raw(bits: Self::Raw) -> Self;
}

macro_rules! from_raw {
    ($($type:ident: $raw:ident;)*) => {$(
        impl FromRaw for crate::num::$type {
            type Raw = $raw;
            fn from_raw(bits: $raw) -> Self {
                Self::from_bits(bits)
            }
        }
    )*};
}

from_raw! { Mass: i128; Inertia: i128; Length: i64; Force: i128; Torque: i128; Damping: i64; Mu: u128; Density: i128;
Restitution: i64; Friction: i64; Acceleration: i64; Velocity: i64; Time: i64; Angle: i64; }

const ALWAYS: [Stage; 2] = [Stage::Begin, Stage::Close];
const FOUND: [Stage; 2] = [Stage::Find, Stage::Release];
const PREPARED: [Stage; 2] = [Stage::Prepare, Stage::Release];

/// A kind of field by an expression over world `w`, a row `i` of so many, and dice `d`.
macro_rules! kinds {
    ($($table:literal $field:literal $stages:ident |$w:ident, $i:ident of $count:expr, $d:ident| $flip:expr;)*) => {
        vec![$(Kind { table: $table, field: $field, stages: $stages, flip: |$w, $d| {
            let count: usize = $count;
            if count == 0 {
                return None;
            }
            let $i = $d.below(count);
            $flip
        } },)*]
    };
}

pub(super) fn state() -> Vec<Kind> {
    kinds! {
        "configuration" "tick_rate" ALWAYS |w, i of 1, d| flip(&mut w.config.tick_rate, i, d);
        "configuration" "substeps" ALWAYS |w, i of 1, d| flip(&mut w.config.substeps, i, d);
        "configuration" "gravity.x" ALWAYS |w, i of 1, d| raw!(w.config.gravity.x, i, d);
        "configuration" "gravity.y" ALWAYS |w, i of 1, d| raw!(w.config.gravity.y, i, d);
        "configuration" "unit_shift" ALWAYS |w, i of 1, d| flip(&mut w.config.unit_shift, i, d);
        "configuration" "sleeping.speed" ALWAYS |w, i of 1, d| raw!(w.config.sleeping.as_mut()?.speed, i, d);
        "configuration" "sleeping.time" ALWAYS |w, i of 1, d| raw!(w.config.sleeping.as_mut()?.time, i, d);
        "clock" "tick" ALWAYS |w, i of 1, d| flip(&mut w.tick, i, d);
        "motion" "position.x" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.x.bits_mut()[i], i, d);
        "motion" "position.y" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.y.bits_mut()[i], i, d);
        "motion" "velocity.x" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.vx.bits_mut()[i], i, d);
        "motion" "velocity.y" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.vy.bits_mut()[i], i, d);
        "motion" "angle" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.angle.bits_mut()[i], i, d);
        "motion" "angular_velocity" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.omega.bits_mut()[i], i, d);
        "quiet" "ticks" ALWAYS |w, i of w.bodies.rest.len(), d| flip(&mut w.bodies.rest.memory().0[i], i, d);
        "sleepers" "count" ALWAYS |w, i of 1, d| flip(w.bodies.rest.memory().1, i, d);
        "bodies" "generation" ALWAYS |w, i of w.bodies.cold.len(), d| flip(w.bodies.cold.memory(i).0, i, d);
        "bodies" "link" ALWAYS |w, i of w.bodies.cold.len(), d| flip(w.bodies.cold.memory(i).1, i, d);
        "bodies" "fixed_rotation" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.cold.memory(i).2.fixed_rotation, i, d);
        "bodies" "mass" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.mass, i, d);
        "bodies" "inertia" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.inertia, i, d);
        "bodies" "center.x" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.center.x, i, d);
        "bodies" "center.y" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.center.y, i, d);
        "bodies" "reach" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.reach, i, d);
        "bodies" "first" ALWAYS |w, i of w.bodies.cold.len(), d| flip(w.bodies.cold.memory(i).2.first.as_mut()?, i, d);
        "bodies" "force.x" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.force.x, i, d);
        "bodies" "force.y" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.force.y, i, d);
        "bodies" "torque" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.torque, i, d);
        "bodies" "linear_damping" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.linear_damping, i, d);
        "bodies" "angular_damping" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.angular_damping, i, d);
        "bodies" "mu" ALWAYS |w, i of w.bodies.cold.len(), d| raw!(w.bodies.cold.memory(i).2.mu, i, d);
        "bodies" "user_data" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.cold.memory(i).2.user_data, i, d);
        "bodies" "allow_sleep" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.bodies.cold.memory(i).2.allow_sleep, i, d);
        "slots of bodies" "free" ALWAYS |w, i of 1, d| flip(w.bodies.cold.chain_memory()[0], i, d);
        "slots of bodies" "live" ALWAYS |w, i of 1, d| flip(w.bodies.cold.chain_memory()[1], i, d);
        "slots of bodies" "digest" ALWAYS |w, i of 1, d| flip(w.bodies.cold.digest_memory(), i, d);
        "slots of colliders" "digest" ALWAYS |w, i of 1, d| flip(w.colliders.rows.digest_memory(), i, d);
        "slots of forms" "digest" ALWAYS |w, i of 1, d| flip(w.colliders.forms.digest_memory(), i, d);
        "slots of attractors" "digest" ALWAYS |w, i of 1, d| flip(w.attractors.digest_memory(), i, d);
        "colliders" "generation" ALWAYS |w, i of w.colliders.rows.len(), d| flip(w.colliders.rows.memory(i).0, i, d);
        "colliders" "link" ALWAYS |w, i of w.colliders.rows.len(), d| flip(w.colliders.rows.memory(i).1, i, d);
        "colliders" "body" ALWAYS |w, i of w.colliders.rows.len(), d| flip(&mut w.colliders.rows.memory(i).2.body, i, d);
        "colliders" "next" ALWAYS |w, i of w.colliders.rows.len(), d| flip(w.colliders.rows.memory(i).2.next.as_mut()?, i, d);
        "colliders" "form" ALWAYS |w, i of w.colliders.rows.len(), d| flip(&mut w.colliders.rows.memory(i).2.form, i, d);
        "colliders" "density" ALWAYS |w, i of w.colliders.rows.len(), d| raw!(w.colliders.rows.memory(i).2.density, i, d);
        "colliders" "restitution" ALWAYS |w, i of w.colliders.rows.len(), d| raw!(w.colliders.rows.memory(i).2.restitution, i, d);
        "colliders" "friction" ALWAYS |w, i of w.colliders.rows.len(), d| raw!(w.colliders.rows.memory(i).2.friction, i, d);
        "colliders" "filter.category" ALWAYS |w, i of w.colliders.rows.len(), d| flip(&mut w.colliders.rows.memory(i).2.filter.category, i, d);
        "colliders" "filter.mask" ALWAYS |w, i of w.colliders.rows.len(), d| flip(&mut w.colliders.rows.memory(i).2.filter.mask, i, d);
        "colliders" "sensor" ALWAYS |w, i of w.colliders.rows.len(), d| flip(&mut w.colliders.rows.memory(i).2.sensor, i, d);
        "forms" "offset.x" ALWAYS |w, i of w.colliders.forms.len(), d| raw!(w.colliders.forms.memory(i).2.offset.x, i, d);
        "forms" "angle" ALWAYS |w, i of w.colliders.forms.len(), d| raw!(w.colliders.forms.memory(i).2.angle, i, d);
        "forms" "center.y" ALWAYS |w, i of w.colliders.forms.len(), d| raw!(w.colliders.forms.memory(i).2.center.y, i, d);
        "forms" "shape.width" ALWAYS |w, i of w.colliders.forms.len(), d| match &mut w.colliders.forms.memory(i).2.shape {
            crate::Shape::Box { width, .. } => raw!(*width, i, d),
            _ => None,
        };
        "forms" "shape.vertices[1].y" ALWAYS |w, i of w.colliders.forms.len(), d| match &mut w.colliders.forms.memory(i).2.shape {
            crate::Shape::Polygon { vertices } => raw!(vertices[1].y, i, d),
            _ => None,
        };
        "outlines" "reach" ALWAYS |w, i of w.colliders.outlines.len(), d| flip(&mut w.colliders.outlines[i].reach, i, d);
        "outlines" "vertices[2][1]" ALWAYS |w, i of w.colliders.outlines.len(), d| flip(&mut w.colliders.outlines[i].vertices[2][1], i, d);
        "outlines" "normals[0][0]" ALWAYS |w, i of w.colliders.outlines.len(), d| flip(&mut w.colliders.outlines[i].normals[0][0], i, d);
        "attractors" "position.x" ALWAYS |w, i of w.attractors.len(), d| raw!(w.attractors.memory(i).2.position.x, i, d);
        "attractors" "position.y" ALWAYS |w, i of w.attractors.len(), d| raw!(w.attractors.memory(i).2.position.y, i, d);
        "attractors" "mu" ALWAYS |w, i of w.attractors.len(), d| raw!(w.attractors.memory(i).2.mu, i, d);
        "attractors" "generation" ALWAYS |w, i of w.attractors.len(), d| flip(w.attractors.memory(i).0, i, d);
        "forces" "slot" ALWAYS |w, i of w.pushes.len(), d| flip(&mut w.pushes[i].slot, i, d);
        "forces" "force.x" ALWAYS |w, i of w.pushes.len(), d| raw!(w.pushes[i].force.x, i, d);
        "forces" "force.y" ALWAYS |w, i of w.pushes.len(), d| raw!(w.pushes[i].force.y, i, d);
        "forces" "torque" ALWAYS |w, i of w.pushes.len(), d| raw!(w.pushes[i].torque, i, d);
        "contacts" "a.index" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 0, 0, 32, i, d);
        "contacts" "a.generation" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 0, 32, 32, i, d);
        "contacts" "b.index" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 1, 0, 32, i, d);
        "contacts" "b.generation" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 1, 32, 32, i, d);
        "contacts" "touching" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 0, 1, i, d);
        "contacts" "sensor" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 8, 1, i, d);
        "contacts" "count" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 16, 8, i, d);
        "contacts" "points[0].id" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 24, 8, i, d);
        "contacts" "points[1].id" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 32, 8, i, d);
        "contacts" "mode" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 2, 40, 8, i, d);
        "contacts" "points[0].normal" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 3, 0, 64, i, d);
        "contacts" "points[1].normal" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 4, 0, 64, i, d);
        "contacts" "tangent" ALWAYS |w, i of w.contacts.len(), d| part(w.contacts.raw(i), 5, 0, 64, i, d);
        "sleeping contacts" "points[0].normal" ALWAYS |w, i of w.resting.contacts.len(), d| part(w.resting.contacts.raw(i), 3, 0, 64, i, d);
        "sleeping contacts" "b.index" ALWAYS |w, i of w.resting.contacts.len(), d| part(w.resting.contacts.raw(i), 1, 0, 32, i, d);
        "status" "tick" ALWAYS |w, i of w.status.entries().len(), d| flip(&mut w.status.memory()[i].tick, i, d);
        "status" "body.index" ALWAYS |w, i of w.status.entries().len(), d| flip(&mut w.status.memory()[i].body.index, i, d);
        "status" "body.generation" ALWAYS |w, i of w.status.entries().len(), d| flip(&mut w.status.memory()[i].body.generation, i, d);
    }
}

fn derived() -> Vec<Kind> {
    kinds! {
        "prepared motion" "kick[0]" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.drive.kick[0][i], i, d);
        "prepared motion" "kick[1]" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.drive.kick[1][i], i, d);
        "prepared motion" "kick[2]" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.drive.kick[2][i], i, d);
        "prepared motion" "bow[1]" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.drive.bow[1][i], i, d);
        "prepared motion" "push" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.drive.push_at[i], i, d);
        "prepared damping" "line_span" ALWAYS |w, i of w.drive.damped.len(), d| flip(&mut w.drive.damped[i].line_span, i, d);
        "prepared damping" "turn.exp" ALWAYS |w, i of w.drive.damped.len(), d| flip(&mut w.drive.damped[i].turn.exp, i, d);
        "mobilities" "sigma" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.solver.mobilities[i].sigma, i, d);
        "mobilities" "tau" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.solver.mobilities[i].tau, i, d);
        "mobilities" "fixed" ALWAYS |w, i of w.bodies.cold.len(), d| flip(&mut w.solver.mobilities[i].fixed, i, d);
        "scales" "push" ALWAYS |w, i of 1, d| flip(&mut w.solver.scales.push, i, d);
        "scales" "soft[1]" ALWAYS |w, i of 1, d| flip(&mut w.solver.scales.soft[1], i, d);
        "scales" "margins.base" ALWAYS |w, i of 1, d| flip(&mut w.solver.scales.margins.base, i, d);
    }
}

fn results() -> Vec<Kind> {
    kinds! {
        "pairs" "colliders[0]" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].colliders[0], i, d);
        "pairs" "bodies[1]" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].bodies[1], i, d);
        "pairs" "sensor" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].sensor, i, d);
        "pairs" "old" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].old, i, d);
        "pairs" "depth" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].depth, i, d);
        "pairs" "met" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].met, i, d);
        "pairs" "restitution" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].restitution, i, d);
        "pairs" "friction" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].friction, i, d);
        "pairs" "manifold.normal[0]" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].manifold.normal[0], i, d);
        "pairs" "manifold.count" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].manifold.count, i, d);
        "pairs" "manifold.points[0].arm[1]" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].manifold.points[0].arm[1], i, d);
        "pairs" "manifold.points[1].separation" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].manifold.points[1].separation, i, d);
        "pairs" "manifold.points[0].id" FOUND |w, i of w.touch.pairs.len(), d| flip(&mut w.touch.pairs[i].manifold.points[0].id, i, d);
        "rows" "normal[1]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].normal[1][l], i, d) };
        "rows" "reply[0][1]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].reply[0][1][l], i, d) };
        "rows" "friction.arm[0]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].friction.arm[0][l], i, d) };
        "rows" "friction.impulse" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].friction.impulse[l], i, d) };
        "rows" "points[0].line" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].points[0].line[l], i, d) };
        "rows" "points[1].impulse" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].points[1].impulse[l], i, d) };
        "rows" "limit[0]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].limit[0][l], i, d) };
        "rows" "separation[1]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].separation[1][l], i, d) };
        "rows" "peak[0]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].peak[0][l], i, d) };
        "rows" "couple[2]" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; flip(&mut w.solver.memory().0[b].couple[2][l], i, d) };
        "movers" "v[0]" PREPARED |w, i of w.solver.memory().1.lanes.len(), d| flip(&mut w.solver.memory().1.lanes[i].v[0], i, d);
        "movers" "w" PREPARED |w, i of w.solver.memory().1.lanes.len(), d| flip(&mut w.solver.memory().1.lanes[i].w, i, d);
        "movers" "d[1]" PREPARED |w, i of w.solver.memory().1.lanes.len(), d| flip(&mut w.solver.memory().1.lanes[i].d[1], i, d);
        "collisions" "order" PREPARED |w, i of w.solver.memory().2.len(), d| flip(&mut w.solver.memory().2[i].order, i, d);
    }
}

/// What a block has a bit a lane of.
fn bits_of_blocks() -> Vec<Kind> {
    kinds! {
        "rows" "pushes" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; bit(&mut w.solver.memory().0[b].pushes, l, i) };
        "rows" "heavy" PREPARED |w, i of w.touch.pairs.len(), d| { let (b, l, i) = lane(w, i)?; bit(&mut w.solver.memory().0[b].heavy, l, i) };
    }
}

/// Some bits of a word of a contact's row.
fn part(row: &mut [u64; 6], word: usize, from: u32, bits: u32, at: usize, dice: &mut Dice) -> Done {
    let mask = u64::MAX >> (64 - bits);
    let of = |row: &[u64; 6]| u128::from(row[word] >> from & mask);
    let before = of(row);
    row[word] ^= 1 << (from as usize + dice.below(bits as usize));
    Some((at, before, of(row)))
}

/// A lane's bit of a block.
fn bit(byte: &mut u8, lane: usize, at: usize) -> Done {
    let before = u128::from(*byte >> lane & 1);
    *byte ^= 1 << lane;
    Some((at, before, before ^ 1))
}

/// The seat of a pair's row, and its place in the table of rows.
fn lane(world: &World, pair: usize) -> Option<(usize, usize, usize)> {
    let row = Some(world.touch.pairs[pair].row).filter(|&row| row != NEW)?;
    let (block, lane) = world.solver.seat(row);
    Some((block, lane, world.touch.pairs[..pair].iter().filter(|pair| pair.row != NEW).count()))
}

/// When in a tick a fault comes.
#[derive(Clone, Copy, PartialEq)]
enum When {
    /// When a stage has ended, before anybody looks.
    End(Stage),
    /// After somebody has looked at the end of a stage, so that the next one reads it.
    Next(Stage),
}

/// Takes evidence of a tick with a fault in it, as far as the fault is seen.
struct Faulty<'f, F> {
    taker: Taker<'f>,
    when: When,
    fault: F,
    done: &'f mut Done,
    over: bool,
}

impl<F: FnMut(&mut World) -> Done> Watch for Faulty<'_, F> {
    fn stage(&mut self, stage: Stage, world: &mut World) {
        if self.when == When::End(stage) {
            *self.done = (self.fault)(world);
            self.over = true;
        }
        self.taker.stage(stage, world);
        if self.over {
            // No hook, no message: the rest of the tick does not matter.
            resume_unwind(Box::new(()));
        }
        if self.when == When::Next(stage) {
            *self.done = (self.fault)(world);
            self.over = true;
        }
    }

    fn substep(&mut self, at: u32, substep: Substep<'_>) {
        self.taker.substep(at, substep);
    }
}

/// Evidence of the next tick of a world, with a fault; and what the fault did.
fn evidence_with(world: &World, when: When, fault: impl FnMut(&mut World) -> Done) -> (Evidence, Done) {
    let (mut evidence, mut draft, mut done) = (Evidence::default(), Draft::default(), None);
    let mut world = world.clone();
    evidence.begin(&world, &mut draft, Origin::Taken);
    let taker = Taker { evidence: &mut evidence, draft: &mut draft };
    let mut faulty = Faulty { taker, when, fault, done: &mut done, over: false };
    let _ = catch_unwind(AssertUnwindSafe(|| world.step_through(&mut faulty, Crew::ALONE)));
    (evidence, done)
}

/// Evidence of the next tick of a world in which something happens when a stage has ended, before anybody looks.
pub(super) fn evidence_of(world: &World, stage: Stage, fault: fn(&mut World)) -> Evidence {
    let happens = |world: &mut World| {
        fault(world);
        None
    };
    evidence_with(world, When::End(stage), happens).0
}

/// The words for what a row is of.
fn object(world: &World, kind: &Kind, finding: &Finding, row: usize) {
    let words = match kind.table {
        "bodies" | "motion" | "quiet" | "prepared motion" | "mobilities" => format!("body {row}v"),
        "colliders" => format!("collider {row}v"),
        "attractors" => format!("attractor {row}v"),
        "forms" | "outlines" => format!("form {row}"),
        "configuration" | "clock" | "scales" | "sleepers" | "slots of bodies" => "the world".into(),
        "status" => format!("number {row}"),
        _ => return,
    };
    assert!(finding.object.starts_with(&words), "{finding}: not {words}, tick {}", world.tick());
}

pub(super) fn check(world: &World, kind: &Kind, (row, before, after): (usize, u128, u128), divergence: &Divergence) {
    let finding = &divergence.findings[0];
    assert_eq!((finding.table.as_str(), finding.field.as_str()), (kind.table, kind.field), "{finding}");
    let bits = |value: &Option<crate::replay::FieldValue>| {
        let text = &value.as_ref().expect("both sides have it").bits;
        u128::from_str_radix(&text[2..], 16).expect("hexadecimal")
    };
    assert_eq!((bits(&finding.a), bits(&finding.b)), (before, after), "{finding}");
    assert!(finding.is_one_bit());
    object(world, kind, finding, row);
}

/// A world and its twin, some random ticks on, ready for a tick.
fn ready(world: &mut World, dice: &mut Dice) {
    for _ in 0..=dice.below(40) {
        shake(world, world.tick(), PUSHED);
        world.step();
    }
    shake(world, world.tick(), PUSHED);
}

/// After a stage has written, and before anybody reads: one bit, one finding.
#[test]
fn a_fault_between_stages_is_named_exactly() {
    let mut dice = Dice(1);
    let mut world = world_of_everything();
    for _ in 0..60 {
        world.step();
    }
    let kinds: Vec<Kind> = [state(), derived(), results()].into_iter().flatten().collect();
    let mut tried = vec![0u32; kinds.len()];
    for _ in 0..8 {
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        for (at, kind) in kinds.iter().enumerate() {
            let stages: Vec<Stage> = Stage::ALL
                .iter()
                .copied()
                .filter(|s| (kind.stages[0].max(Stage::Forces)..=kind.stages[1]).contains(s) && *s != Stage::Wake)
                .collect();
            for _ in 0..3 {
                let stage = stages[dice.below(stages.len())];
                let (faulty, done) = evidence_with(&world, When::End(stage), |world| (kind.flip)(world, &mut dice));
                let Some(done) = done else { continue };
                let divergence = clean.first_difference(&faulty).expect("evidence").expect("it differs");
                assert_eq!((divergence.stage, divergence.substep), (stage, 0), "{} {}", kind.table, kind.field);
                // Rows are named by their pair, so what a pair is of shows in them too.
                let echoes = usize::from(kind.field == "colliders[0]" && divergence.findings.len() == 2);
                assert_eq!(divergence.findings.len(), 1 + echoes, "{divergence:?}");
                assert_eq!(divergence.tick, world.tick() + 1);
                check(&world, kind, done, &divergence);
                tried[at] += 1;
            }
        }
    }
    for (kind, tried) in kinds.iter().zip(&tried) {
        assert!(*tried >= 2, "{} {} was hit {tried} times", kind.table, kind.field);
    }
    println!("{} kinds of fields, {} faults", kinds.len(), tried.iter().sum::<u32>());
}

/// A bit of a block is that of one contact.
#[test]
fn a_fault_in_a_bit_of_a_block_is_that_of_its_contact() {
    let (mut dice, mut world) = (Dice(3), world_of_everything());
    (0..60).for_each(|_| world.step());
    let clean = Evidence::of_step(&mut world.clone());
    for kind in bits_of_blocks() {
        // Not every pair has rows.
        let mut tries = (0..50).map(|_| {
            let (faulty, done) =
                evidence_with(&world, When::End(Stage::Prepare), |world| (kind.flip)(world, &mut dice));
            Some((faulty, done?))
        });
        let (faulty, done) = tries.find_map(|tried| tried).expect("some have");
        let divergence = clean.first_difference(&faulty).expect("evidence").expect("it differs");
        assert_eq!((divergence.stage, divergence.findings.len()), (Stage::Prepare, 1), "{divergence:?}");
        check(&world, &kind, done, &divergence);
    }
}

/// Before a stage reads it, and after everybody has looked: what follows from it differs as well, and the fault stands first.
#[test]
fn a_fault_that_a_stage_goes_on_with_is_named_first() {
    let mut dice = Dice(2);
    let mut world = world_of_everything();
    for _ in 0..60 {
        world.step();
    }
    // Not what would make the rest of the stage read beyond its memory.
    const SOUND: [&str; 14] = [
        "position.x",
        "position.y",
        "velocity.x",
        "velocity.y",
        "angle",
        "angular_velocity",
        "force.x",
        "force.y",
        "points[0].normal",
        "tangent",
        "friction",
        "restitution",
        "kick[0]",
        "kick[1]",
    ];
    let kinds: Vec<Kind> = [state(), derived()]
        .into_iter()
        .flatten()
        .filter(|kind| SOUND.contains(&kind.field) && kind.table != "pairs")
        .collect();
    let (mut first, mut all, mut gone) = (0, 0, 0);
    for _ in 0..15 {
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        for kind in &kinds {
            let stage = [Stage::Forces, Stage::Sort, Stage::Find, Stage::Prepare, Stage::Integrate, Stage::Solve]
                [dice.below(6)];
            let (faulty, done) = evidence_with(&world, When::Next(stage), |world| (kind.flip)(world, &mut dice));
            let Some((row, ..)) = done else { continue };
            // What the stage writes anew without reading it is no fault any more.
            let Some(divergence) = clean.first_difference(&faulty).expect("evidence") else {
                gone += 1;
                continue;
            };
            all += 1;
            let hit = |finding: &Finding| (finding.table.as_str(), finding.field.as_str()) == (kind.table, kind.field);
            if divergence.findings.first().is_some_and(hit) {
                first += 1;
                object(&world, kind, &divergence.findings[0], row);
            } else {
                // Some of these are written by the very stage that read them.
                assert!(["motion", "contacts"].contains(&kind.table), "{} {}: {divergence:?}", kind.table, kind.field);
            }
        }
    }
    println!("{first} of {all} are named first; {gone} were written over");
    assert!(first * 10 >= all * 8, "{first} of {all}");
}

/// Between substeps, in what the next one reads.
#[test]
fn a_fault_between_substeps_is_named_exactly() {
    struct Inside<'t> {
        taker: Taker<'t>,
        at: u32,
        dice: Dice,
        done: Done,
    }
    impl Watch for Inside<'_> {
        fn stage(&mut self, stage: Stage, world: &mut World) {
            self.taker.stage(stage, world);
        }

        fn substep(&mut self, at: u32, substep: Substep<'_>) {
            if at == self.at {
                let row = 1 + self.dice.below(substep.movers.lanes.len() - 1);
                let mover = &mut substep.movers.lanes[row];
                let dice = &mut self.dice;
                self.done = match dice.below(4) {
                    0 => flip(&mut mover.v[0], row, dice),
                    1 => flip(&mut mover.v[1], row, dice),
                    2 => flip(&mut mover.w, row, dice),
                    _ => flip(&mut mover.d[1], row, dice),
                };
            }
            self.taker.substep(at, substep);
            if at == self.at {
                resume_unwind(Box::new(()));
            }
        }
    }
    let (mut world, mut dice) = (world_of_everything(), Dice(3));
    let mut named = 0;
    for seed in 0..40 {
        // In time its bodies go where nothing touches them.
        if seed % 10 == 0 {
            world = world_of_everything();
        }
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        let (mut evidence, mut draft) = (Evidence::default(), Draft::default());
        evidence.begin(&world, &mut draft, Origin::Taken);
        let at = 1 + dice.below(10) as u32;
        let taker = Taker { evidence: &mut evidence, draft: &mut draft };
        let mut inside = Inside { taker, at, dice: Dice(seed), done: None };
        let mut copy = world.clone();
        let _ = catch_unwind(AssertUnwindSafe(|| copy.step_through(&mut inside, Crew::ALONE)));
        // Without contacts a tick has no substeps.
        let Some((_, before, after)) = inside.done else { continue };
        named += 1;
        let divergence = clean.first_difference(&evidence).expect("evidence").expect("it differs");
        assert_eq!((divergence.stage, divergence.substep), (Stage::Solve, at));
        let finding = &divergence.findings[0];
        assert_eq!((divergence.findings.len(), finding.table.as_str()), (1, "movers"));
        let bits = |value: &Option<crate::replay::FieldValue>| {
            u128::from_str_radix(&value.as_ref().expect("there").bits[2..], 16).expect("hexadecimal")
        };
        assert_eq!((bits(&finding.a), bits(&finding.b)), (before, after));
        assert!(finding.object.starts_with("body "), "{finding}");
    }
    assert!(named >= 20, "{named}");
}
