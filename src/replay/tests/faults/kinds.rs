//! Which bits of a world a fault may change, and where they are to be found.

use super::super::Dice;
use crate::World;
use crate::contact::NEW;
use crate::world::Stage;

/// What a fault did: the row of its table, and the bits before and after.
pub(in crate::replay::tests) type Done = Option<(usize, u128, u128)>;

/// A kind of field: its table, its name, from which stage to which it is there, and what flips a bit of it.
pub(in crate::replay::tests) struct Kind {
    pub(in crate::replay::tests) table: &'static str,
    pub(in crate::replay::tests) field: &'static str,
    pub(super) stages: [Stage; 2],
    pub(in crate::replay::tests) flip: fn(&mut World, &mut Dice) -> Done,
}

pub(super) trait Bits: Copy {
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

pub(super) fn flip<T: Bits>(value: &mut T, row: usize, dice: &mut Dice) -> Done {
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

pub(in crate::replay::tests) fn state() -> Vec<Kind> {
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

pub(super) fn derived() -> Vec<Kind> {
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

pub(super) fn results() -> Vec<Kind> {
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
pub(super) fn bits_of_blocks() -> Vec<Kind> {
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
