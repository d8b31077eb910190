//! The table of colliders and of the forms they share.

use crate::geom::{Rot, Vec2};
use crate::num::{Angle, Density, Friction, Length, Restitution};
use crate::shape::{ColliderDef, Filter, Outline, Shape};
use crate::store::{
    Arena, ColliderId, DecodeError, Diff, Draft, Hasher, Kind, Reader, Record, Row, Sink, Tables, put, record,
};

/// A form in a body's axes about its centre of mass: what colliders share instead of each having its own.
#[derive(Debug, PartialEq)]
pub(crate) struct Form {
    pub(crate) shape: Shape,
    pub(crate) offset: Vec2<Length>,
    pub(crate) angle: Angle,
    /// The centre of mass from the body's origin.
    pub(crate) center: Vec2<Length>,
    /// How many colliders have it.
    uses: u32,
}

record!(Form { shape, offset, angle, center, uses } shown);

impl Default for Form {
    fn default() -> Self {
        let (offset, center) = (Vec2::default(), Vec2::default());
        Form { shape: Shape::Circle { radius: Length::ZERO }, offset, angle: Angle::ZERO, center, uses: 0 }
    }
}

impl Row for Form {}

impl Form {
    fn same(&self, other: &Form) -> bool {
        let Form { shape, offset, angle, center, uses: _ } = other;
        self.shape == *shape && self.offset == *offset && self.angle == *angle && self.center == *center
    }

    fn outline(&self) -> Outline {
        self.shape.outline(self.offset, self.angle, self.center)
    }
}

/// A collider: only commands change it.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Collider {
    /// The slot of its body.
    pub(crate) body: u32,
    /// The slot of the body's next collider.
    pub(crate) next: Option<u32>,
    /// The slot of its form.
    pub(crate) form: u32,
    pub(crate) density: Density,
    pub(crate) restitution: Restitution,
    pub(crate) friction: Friction,
    pub(crate) filter: Filter,
    pub(crate) sensor: bool,
}

record!(Collider { body, next, form, density, restitution, friction, filter, sensor } shown);

impl Row for Collider {}

/// All colliders and forms.
#[derive(Debug, Default)]
pub(crate) struct Colliders {
    pub(crate) rows: Arena<Collider>,
    pub(crate) forms: Arena<Form>,
    /// By the forms' slots. Derived.
    pub(crate) outlines: Vec<Outline>,
    /// The slots of forms in use, ordered by their fields: where an equal one is found. Derived.
    sorted: Vec<u32>,
}

crate::store::clone_fields!(Colliders { rows, forms, outlines, sorted });

impl Record for Colliders {
    fn save(&self, sink: &mut impl Sink) {
        let Colliders { rows, forms, outlines: _, sorted: _ } = self;
        rows.save(sink);
        forms.save(sink);
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let offset = reader.offset();
        let (rows, forms) = (Record::load(reader, "colliders")?, Record::load(reader, "forms")?);
        let mut colliders = Colliders { rows, forms, outlines: Vec::new(), sorted: Vec::new() };
        colliders.check_rows().map_err(|reason| reader.invalid(offset, field, reason))?;
        for slot in 0..colliders.forms.len() {
            colliders.note_form(slot);
        }
        Ok(colliders)
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        diff.field("", |d| self.rows.diff(&other.rows, d));
        diff.field("forms", |d| self.forms.diff(&other.forms, d));
    }
}

/// An order of forms, for finding one: which one does not matter, it is derived.
fn order(a: &Form, b: &Form) -> core::cmp::Ordering {
    let key = |form: &Form| {
        let Form { offset, angle, center, .. } = form;
        (offset.x, offset.y, angle.to_bits(), center.x, center.y)
    };
    fn dims(shape: &Shape) -> (u8, &[Vec2<Length>], [Length; 2]) {
        match shape {
            Shape::Circle { radius } => (0, &[], [*radius, Length::ZERO]),
            Shape::Box { width, height } => (1, &[], [*width, *height]),
            Shape::Polygon { vertices } => (2, vertices, [Length::ZERO; 2]),
        }
    }
    let (a_kind, a_vertices, a_size) = dims(&a.shape);
    let (b_kind, b_vertices, b_size) = dims(&b.shape);
    let points = |v: &[Vec2<Length>]| v.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>();
    (a_kind, a_size, key(a)).cmp(&(b_kind, b_size, key(b))).then_with(|| points(a_vertices).cmp(&points(b_vertices)))
}

impl Colliders {
    /// Adds the colliders of a body; their checked definitions. The caller has checked that there is room. The slot of
    /// the first.
    pub(crate) fn insert(&mut self, body: u32, center: Vec2<Length>, defs: &[ColliderDef]) -> Option<u32> {
        let mut next = None;
        // From the last to the first, so that each knows the next.
        for def in defs.iter().rev() {
            let ColliderDef { shape, offset, angle, density, restitution, friction, filter, sensor } = def;
            let form = Form { shape: shape.canonical(), offset: *offset, angle: *angle, center, uses: 0 };
            let form = self.share(form);
            let (density, restitution, friction) = (*density, *restitution, *friction);
            let row = Collider { body, next, form, density, restitution, friction, filter: *filter, sensor: *sensor };
            next = Some(self.rows.insert(row).0);
        }
        next
    }

    /// Removes the colliders of a body from its first on, and the forms that nobody uses any more.
    pub(crate) fn remove(&mut self, first: Option<u32>) {
        let mut next = first;
        while let Some(slot) = next {
            let id = self.id(slot as usize);
            let Some(row) = self.rows.remove(id.index, id.generation) else { break };
            next = row.next;
            let form = row.form as usize;
            self.forms.update(form, |f| f.uses = f.uses.saturating_sub(1));
            if self.forms.value(form).uses == 0 {
                if let Ok(at) = self.find(self.forms.value(form)) {
                    self.sorted.remove(at);
                }
                let generation = self.forms.generation(form).unwrap_or(0);
                self.forms.remove(row.form, generation);
                self.outlines[form] = Outline::default();
            }
        }
    }

    /// Hands on all of it as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        self.rows.show(draft, tables, ["colliders", "slots of colliders"], Kind::Collider);
        self.forms.show(draft, tables, ["forms", "slots of forms"], Kind::Form);
        draft.table(tables, "outlines", Kind::Form, self.outlines.iter());
        draft.table(tables, "order of forms", Kind::List, self.sorted.iter());
    }

    /// As [`Colliders::hash`], of what memory holds, without digests that were kept.
    pub(crate) fn hash_afresh(&self) -> u64 {
        let mut hasher = Hasher::new();
        put(&mut hasher, self.rows.hash_afresh());
        put(&mut hasher, self.forms.hash_afresh());
        hasher.finish()
    }

    /// The hash of everything in the table, at the cost of one small hash.
    pub(crate) fn hash(&self) -> u64 {
        let mut hasher = Hasher::new();
        put(&mut hasher, self.rows.hash());
        put(&mut hasher, self.forms.hash());
        hasher.finish()
    }

    /// Makes the table another one. `changed` gets the slot of each collider that was or is another one by this, has
    /// another form, or is only in one of both, and whether it is there now.
    pub(crate) fn turn_into(&mut self, other: &Colliders, mut changed: impl FnMut(usize, Option<&Collider>)) {
        let live = |table: &Colliders, slot: usize| table.rows.generation(slot).is_some();
        let mut reformed = false;
        for form in self.forms.differing(&other.forms) {
            let same = form < self.forms.len().min(other.forms.len()) && {
                let (a, b) = (self.forms.value(form), other.forms.value(form));
                a.same(b) && (a.uses > 0) == (b.uses > 0)
            };
            reformed |= !same;
        }
        for slot in self.rows.differing(&other.rows) {
            changed(slot, live(other, slot).then(|| other.rows.value(slot)));
        }
        if reformed {
            // A form that has changed is seldom: then all of them are looked at.
            for (slot, row) in other.rows.iter() {
                if live(self, slot) && self.outline(slot) != other.outline(slot) {
                    changed(slot, Some(row));
                }
            }
        }
        self.clone_from(other);
    }

    /// Whether so many more fit.
    pub(crate) fn has_room(&self, count: usize) -> bool {
        let limit = Arena::<Collider>::LIMIT as usize;
        (self.rows.live() as usize).saturating_add(count) <= limit && self.rows.len().saturating_add(count) <= limit
    }

    /// The slots of a body's colliders from its first on.
    pub(crate) fn list(&self, first: Option<u32>) -> impl Iterator<Item = usize> + '_ {
        core::iter::successors(first, |&slot| self.rows.value(slot as usize).next).map(|slot| slot as usize)
    }

    /// The id of the collider in a slot in use.
    pub(crate) fn id(&self, slot: usize) -> ColliderId {
        ColliderId { index: slot as u32, generation: self.rows.generation(slot).unwrap_or(u32::MAX) }
    }

    /// The slot of a current id.
    pub(crate) fn slot(&self, id: ColliderId) -> Option<usize> {
        self.rows.slot(id.index, id.generation)
    }

    /// The outline of the collider in a slot.
    #[inline]
    pub(crate) fn outline(&self, slot: usize) -> &Outline {
        &self.outlines[self.rows.value(slot).form as usize]
    }

    /// The collider in a slot, as it could be created anew.
    pub(crate) fn def(&self, slot: usize) -> ColliderDef {
        let Collider { form, density, restitution, friction, filter, sensor, .. } = self.rows.value(slot);
        let Form { shape, offset, angle, .. } = self.forms.value(*form as usize);
        ColliderDef {
            shape: shape.clone(),
            offset: *offset,
            angle: *angle,
            density: *density,
            restitution: *restitution,
            friction: *friction,
            filter: *filter,
            sensor: *sensor,
        }
    }

    /// Where a form is in the sorted list, or would be.
    fn find(&self, form: &Form) -> Result<usize, usize> {
        self.sorted.binary_search_by(|&slot| order(self.forms.value(slot as usize), form))
    }

    /// The slot of a form equal to this one, which has one use more now.
    fn share(&mut self, form: Form) -> u32 {
        let slot = match self.find(&form) {
            Ok(at) => self.sorted[at] as usize,
            Err(_) => {
                let slot = self.forms.insert(form).0 as usize;
                self.note_form(slot);
                slot
            }
        };
        self.forms.update(slot, |f| f.uses = f.uses.saturating_add(1));
        slot as u32
    }

    /// Derives what belongs to a form.
    fn note_form(&mut self, slot: usize) {
        if self.outlines.len() <= slot {
            self.outlines.resize_with(slot.saturating_add(1), Outline::default);
        }
        if self.forms.generation(slot).is_none() {
            return;
        }
        self.outlines[slot] = self.forms.value(slot).outline();
        if let Err(at) = self.find(self.forms.value(slot)) {
            self.sorted.insert(at, slot as u32);
        }
    }

    /// Every invariant of the table in itself; what is wrong, if one is broken.
    pub(crate) fn check(&self) -> Result<(), &'static str> {
        self.rows.check()?;
        self.forms.check()?;
        self.check_rows()?;
        let mut fresh = Colliders { rows: Arena::default(), forms: self.forms.clone(), ..Colliders::default() };
        for slot in 0..self.forms.len() {
            fresh.note_form(slot);
        }
        if fresh.outlines != self.outlines || fresh.sorted != self.sorted {
            return Err("has outlines that do not follow from its forms");
        }
        Ok(())
    }

    /// Whether colliders have forms, forms the uses they count, and all of them values that are accepted.
    fn check_rows(&self) -> Result<(), &'static str> {
        let mut uses = vec![0u32; self.forms.len()];
        for (_, row) in self.rows.iter() {
            let Some(count) = uses.get_mut(row.form as usize) else { return Err("has a collider without a form") };
            *count = count.saturating_add(1);
        }
        for (slot, &count) in uses.iter().enumerate() {
            let live = self.forms.generation(slot).is_some();
            let form = self.forms.value(slot);
            if form.uses != count || live != (count > 0) {
                return Err("counts the uses of its forms wrongly");
            }
            if live && form.shape.canonical() != form.shape {
                return Err("has a form that is not counter-clockwise");
            }
        }
        for (slot, _) in self.rows.iter() {
            if self.def(slot).check().is_err() {
                return Err("has a collider that is not accepted");
            }
        }
        let mut live: Vec<u32> = (0..self.forms.len() as u32).collect();
        live.retain(|&slot| self.forms.generation(slot as usize).is_some());
        live.sort_by(|&a, &b| order(self.forms.value(a as usize), self.forms.value(b as usize)));
        if live.windows(2).any(|w| self.forms.value(w[0] as usize).same(self.forms.value(w[1] as usize))) {
            return Err("has a form twice");
        }
        Ok(())
    }
}

/// The centre of mass of a body whose origin is at `origin`: the arm is rounded once, so that taking it off again gives
/// the origin's very bits.
pub(crate) fn center_at(origin: Vec2<Length>, center: Vec2<Length>, angle: Angle) -> Vec2<Length> {
    if center.is_zero() {
        return origin;
    }
    let arm = Rot::new(angle).rotate(center);
    let sum = |a: Length, b: Length| Length::from_bits(a.to_bits().saturating_add(b.to_bits()));
    Vec2::new(sum(origin.x, arm.x), sum(origin.y, arm.y))
}

/// The origin of a body whose centre of mass is at `position`.
pub(crate) fn origin_of(position: Vec2<Length>, center: Vec2<Length>, angle: Angle) -> Vec2<Length> {
    let negated = Vec2::new(
        Length::from_bits(center.x.to_bits().saturating_neg()),
        Length::from_bits(center.y.to_bits().saturating_neg()),
    );
    center_at(position, negated, angle)
}
