//! The table of bodies: hot state in columns, cold data in slots.

use super::colliders::center_at;
use super::def::{BodyData, BodyDef};
use super::rest::Rest;
use crate::geom::Vec2;
use crate::num::{Angle, AngularVelocity, Length, Quantity, Velocity};
use crate::store::{
    Arena, BodyId, Cells, Column, DecodeError, Diff, Draft, Hasher, Kind, Reader, Record, Show, Sink, Tables, record,
};

/// Declares the table from one list of columns: struct, save, load, hash, diff and copy, and what of it a tick changes.
macro_rules! table {
    ($($(#[$doc:meta])* $column:ident: $quantity:ty, $path:literal;)*) => {
        /// All bodies. A column has one element per slot, zero where the slot is free.
        #[derive(Debug, Default)]
        pub(crate) struct Bodies {
            pub(crate) cold: Arena<BodyData>,
            /// Who sleeps.
            pub(crate) rest: Rest,
            $($(#[$doc])* pub(crate) $column: Column<$quantity>,)*
        }

        impl Bodies {
            /// Brings every column to the arena's number of slots.
            fn grow(&mut self) {
                $( while self.$column.len() < self.cold.len() { self.$column.push(<$quantity>::ZERO); } )*
                self.rest.grow(self.cold.len());
            }

            /// The hash of the columns, each in one pass over its little-endian bytes.
            pub(crate) fn motion_hash(&self) -> u64 {
                let Bodies { cold: _, rest: _, $($column),* } = self;
                let mut hasher = Hasher::new();
                $( $column.hash().save(&mut hasher); )*
                hasher.finish()
            }

            /// Whether every slot has its element in each column.
            fn is_rectangular(&self) -> bool {
                true $( && self.$column.len() == self.cold.len() )*
            }
        }

        /// The columns apart from their table: where bodies were.
        #[derive(Debug, Default)]
        pub(crate) struct Motion {
            $( $column: Column<$quantity>, )*
        }

        record!(Motion { $($column),* });

        impl Motion {
            /// As [`Bodies::motion_hash`].
            pub(crate) fn hash(&self) -> u64 {
                let Motion { $($column),* } = self;
                let mut hasher = Hasher::new();
                $( $column.hash().save(&mut hasher); )*
                hasher.finish()
            }

            /// How many bytes of memory the columns use.
            pub(crate) fn memory(&self) -> usize {
                let Motion { $($column),* } = self;
                0usize $( .saturating_add(size_of_val($column.bits())) )*
            }

            /// Copies the columns of a table.
            pub(crate) fn copy_from(&mut self, bodies: &Bodies) {
                let Bodies { cold: _, rest: _, $($column),* } = bodies;
                $( self.$column.clone_from($column); )*
            }

            /// Copies them back.
            pub(crate) fn copy_to(&self, bodies: &mut Bodies) {
                let Motion { $($column),* } = self;
                $( bodies.$column.clone_from($column); )*
            }

            /// Whether a body was at another place than now, or turned otherwise.
            #[inline]
            pub(crate) fn is_elsewhere(&self, slot: usize, bodies: &Bodies) -> bool {
                let differs = |was: &[i64], is: &[i64]| was.get(slot) != is.get(slot);
                differs(self.x.bits(), bodies.x.bits())
                    || differs(self.y.bits(), bodies.y.bits())
                    || differs(self.angle.bits(), bodies.angle.bits())
            }
        }

        impl Record for Bodies {
            fn save(&self, sink: &mut impl Sink) {
                let Bodies { cold, rest, $($column),* } = self;
                cold.save(sink);
                $( $column.save(sink); )*
                rest.save(sink);
            }

            fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
                let offset = reader.offset();
                let cold = Record::load(reader, "bodies")?;
                let mut bodies = Bodies { cold, rest: Rest::default(), $($column: Record::load(reader, $path)?),* };
                bodies.rest = Record::load(reader, "quiet")?;
                bodies.check_values().map_err(|reason| reader.invalid(offset, field, reason))?;
                Ok(bodies)
            }

            fn diff(&self, other: &Self, diff: &mut Diff) {
                self.cold.diff(&other.cold, diff);
                for slot in 0..self.cold.len().min(other.cold.len()) {
                    diff.element(slot, |d| {
                        $( d.field($path, |d| self.$column.get(slot).diff(&other.$column.get(slot), d)); )*
                        d.field("quiet", |d| self.rest.quiet(slot).diff(&other.rest.quiet(slot), d));
                        d.field("asleep", |d| self.rest.is_asleep(slot).diff(&other.rest.is_asleep(slot), d));
                    });
                }
            }
        }

        impl Clone for Bodies {
            fn clone(&self) -> Self {
                let Bodies { cold, rest, $($column),* } = self;
                Bodies { cold: cold.clone(), rest: rest.clone(), $($column: $column.clone()),* }
            }

            fn clone_from(&mut self, source: &Self) {
                let Bodies { cold, rest, $($column),* } = source;
                self.cold.clone_from(cold);
                self.rest.clone_from(rest);
                $( self.$column.clone_from($column); )*
            }
        }
    };
}

table! {
    /// The centre of mass.
    x: Length, "position.x";
    y: Length, "position.y";
    vx: Velocity, "velocity.x";
    vy: Velocity, "velocity.y";
    /// Orientation, unwrapped turns.
    angle: Angle, "angle";
    /// Counter-clockwise positive.
    omega: AngularVelocity, "angular_velocity";
}

/// Where a body is and how it moves, as the columns have it. Speeds stand first: they change places, not the other way round.
struct Moving<'b>(&'b Bodies, usize);

impl Show for Moving<'_> {
    fn show(&self, cells: &mut Cells<'_>) {
        let Moving(Bodies { cold: _, rest: _, x, y, vx, vy, angle, omega }, slot) = *self;
        cells.field("velocity.x", |c| vx.get(slot).show(c));
        cells.field("velocity.y", |c| vy.get(slot).show(c));
        cells.field("angular_velocity", |c| omega.get(slot).show(c));
        cells.field("position.x", |c| x.get(slot).show(c));
        cells.field("position.y", |c| y.get(slot).show(c));
        cells.field("angle", |c| angle.get(slot).show(c));
    }
}

impl Bodies {
    /// Hands on all of it as tables; `sorted`: whether a tick has sorted out who is awake.
    pub(crate) fn show(&self, sorted: bool, draft: &mut Draft, tables: &mut impl Tables) {
        self.cold.show(draft, tables, ["bodies", "slots of bodies"], Kind::Body);
        self.show_motion(draft, tables);
        self.rest.show(sorted, draft, tables);
    }

    /// Hands on the columns as a table.
    pub(crate) fn show_motion(&self, draft: &mut Draft, tables: &mut impl Tables) {
        draft.table(tables, "motion", Kind::Body, (0..self.cold.len()).map(|slot| Moving(self, slot)));
    }

    /// Adds a body with the row that its definition gives. The caller has checked that the arena has room.
    pub(crate) fn insert(&mut self, def: &BodyDef, data: BodyData) -> BodyId {
        let center = center_at(def.position, data.center, def.angle);
        let (index, generation) = self.cold.insert(data);
        self.grow();
        let slot = index as usize;
        self.set_position(slot, center);
        self.angle.set(slot, def.angle);
        self.set_velocity(slot, def.velocity);
        self.omega.set(slot, def.angular_velocity);
        BodyId { index, generation }
    }

    /// Removes a body and leaves zeros, so that no trace of it is in the hash.
    pub(crate) fn remove(&mut self, id: BodyId) -> bool {
        let removed = self.cold.remove(id.index, id.generation).is_some();
        if removed {
            let slot = id.index as usize;
            self.set_position(slot, Vec2::default());
            self.angle.set(slot, Angle::ZERO);
            self.set_velocity(slot, Vec2::default());
            self.omega.set(slot, AngularVelocity::ZERO);
            self.rest.rouse(slot);
        }
        removed
    }

    /// The slot of a current id.
    pub(crate) fn slot(&self, id: BodyId) -> Option<usize> {
        self.cold.slot(id.index, id.generation)
    }

    /// The id of the body in a slot in use.
    pub(crate) fn id(&self, slot: usize) -> Option<BodyId> {
        Some(BodyId { index: slot as u32, generation: self.cold.generation(slot)? })
    }

    pub(crate) fn position(&self, slot: usize) -> Vec2<Length> {
        Vec2::new(self.x.get(slot), self.y.get(slot))
    }

    pub(crate) fn set_position(&mut self, slot: usize, position: Vec2<Length>) {
        self.x.set(slot, position.x);
        self.y.set(slot, position.y);
    }

    pub(crate) fn velocity(&self, slot: usize) -> Vec2<Velocity> {
        Vec2::new(self.vx.get(slot), self.vy.get(slot))
    }

    pub(crate) fn set_velocity(&mut self, slot: usize, velocity: Vec2<Velocity>) {
        self.vx.set(slot, velocity.x);
        self.vy.set(slot, velocity.y);
    }

    /// Every invariant of the table; what is wrong, if one is broken.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        self.cold.check()?;
        self.rest.check(self.cold.len())?;
        self.check_values()
    }

    /// Whether columns are as long as the slots and values fit their bodies; what is wrong, if not.
    pub(crate) fn check_values(&self) -> Result<(), &'static str> {
        if !self.is_rectangular() || ![0, self.cold.len()].contains(&self.rest.len()) {
            return Err("has columns that are not as long as its slots");
        }
        for slot in 0..self.cold.len() {
            let (velocity, omega) = (self.velocity(slot), self.omega.get(slot));
            if self.cold.generation(slot).is_none() {
                let at_zero = self.position(slot).is_zero() && self.angle.get(slot) == Angle::ZERO;
                if !at_zero || !velocity.is_zero() || omega != AngularVelocity::ZERO {
                    return Err("has a free slot that moves");
                }
                if self.rest.is_asleep(slot) || self.rest.quiet(slot) > 0 {
                    return Err("has a free slot that sleeps");
                }
                continue;
            }
            let data = self.cold.value(slot);
            if !data.is_dynamic() && (self.rest.is_asleep(slot) || self.rest.quiet(slot) > 0) {
                return Err("has a body that sleeps though it is not dynamic");
            }
            let still = velocity.is_zero() && omega == AngularVelocity::ZERO;
            if self.rest.is_asleep(slot) && !(still && data.allow_sleep) {
                return Err("has a body that sleeps and must not, or moves");
            }
            let angle = self.angle.get(slot).checked();
            if self.position(slot).checked().is_err() || angle.is_err() {
                return Err("has a body outside the world");
            }
            if velocity.checked().is_err() || omega.checked().is_err() || data.check(velocity, omega).is_err() {
                return Err("has a body with a value that is out of range, or that its kind does not have");
            }
        }
        Ok(())
    }
}
