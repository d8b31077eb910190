//! Looking for colliders: rays, points, boxes.
//!
//! Range: colliders within 2³⁰ m of where a ray begins or a point is, and rays not longer; beyond, hits are off.
//! Answers follow from the present state alone and come in a defined order. A query looks at each collider's reach first,
//! about 3 ns each, and computes what is near exactly.

use crate::World;
use crate::geom::{Aabb, Rot, Vec2};
use crate::narrow::{Hit, closest, contains, overlap, ray};
use crate::num::{Length, mul};
use crate::shape::{Filter, Placed};
use crate::store::ColliderId;

/// Where a ray meets a collider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayHit {
    /// Which.
    pub collider: ColliderId,
    /// The point, rounded to nearest.
    pub point: Vec2<Length>,
    /// The part of the ray before it, 62 fraction bits, 0 … 1.
    pub fraction: i64,
    /// Out of the collider, unit, 30 fraction bits; zero where the ray starts inside.
    pub normal: [i32; 2],
}

/// The point of a collider nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClosestPoint {
    /// Which.
    pub collider: ColliderId,
    /// The point; the given one if that is inside.
    pub point: Vec2<Length>,
    /// How far it is; 0 inside.
    pub distance: Length,
}

impl World {
    /// The first collider that the way from `origin` to `origin + way` meets, touching included; of several at the same
    /// place the one in the lowest slot. Sensors are met like others: leave them out by their filter.
    ///
    /// ```
    /// use tamias2d::{BodyDef, ColliderDef, Commands, Filter, Shape, Vec2, World, WorldDef};
    /// let mut world = World::new(&WorldDef::default())?;
    /// let ball = ColliderDef::new(Shape::Circle { radius: "0.5".parse()? });
    /// world.create_body(&BodyDef { position: Vec2::from_f64(3.0, 0.0)?, colliders: vec![ball], ..BodyDef::default() })?;
    /// let hit = world.ray_cast(Vec2::default(), Vec2::from_f64(10.0, 0.0)?, Filter::default()).expect("it is in the way");
    /// assert_eq!(hit.point, Vec2::from_f64(2.5, 0.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ray_cast(&self, origin: Vec2<Length>, way: Vec2<Length>, filter: Filter) -> Option<RayHit> {
        self.ray_cast_all(origin, way, filter).into_iter().next()
    }

    /// All colliders that the way from `origin` to `origin + way` meets, each where it is met first, ordered by fraction,
    /// then by slot.
    pub fn ray_cast_all(&self, origin: Vec2<Length>, way: Vec2<Length>, filter: Filter) -> Vec<RayHit> {
        let way_bits = [way.x.to_bits(), way.y.to_bits()];
        let end = |from: Length, by: i64| Length::from_bits(from.to_bits().saturating_add(by));
        let target = Vec2::new(end(origin.x, way_bits[0]), end(origin.y, way_bits[1]));
        let (left, right) = (origin.x.min(target.x), origin.x.max(target.x));
        let (low, high) = (origin.y.min(target.y), origin.y.max(target.y));
        let around = Aabb { min: Vec2::new(left, low), max: Vec2::new(right, high) };
        let mut hits: Vec<RayHit> = self
            .near(&around, filter)
            .filter_map(|(slot, placed, center)| {
                let Hit { fraction, normal } = ray(&placed, from(center, origin), way_bits)?;
                let point = Vec2::new(
                    end(origin.x, mul(way_bits[0], fraction, 62)),
                    end(origin.y, mul(way_bits[1], fraction, 62)),
                );
                Some(RayHit { collider: self.colliders.id(slot), point, fraction, normal })
            })
            .collect();
        hits.sort_by_key(|hit| (hit.fraction, hit.collider.index));
        hits
    }

    /// The colliders that a point is in, or on the border of, by slot.
    pub fn overlap_point(&self, point: Vec2<Length>, filter: Filter) -> Vec<ColliderId> {
        let around = Aabb { min: point, max: point };
        let inside = |(slot, placed, center): (usize, Placed, Vec2<Length>)| {
            contains(&placed, from(center, point)).then(|| self.colliders.id(slot))
        };
        self.near(&around, filter).filter_map(inside).collect()
    }

    /// The colliders that have a point in common with a box, borders included, by slot.
    pub fn overlap_box(&self, aabb: &Aabb, filter: Filter) -> Vec<ColliderId> {
        let inside = |(slot, placed, center): (usize, Placed, Vec2<Length>)| {
            // What of the box is near the collider; no more than that, which bounds the numbers.
            let metre = 1 << 32;
            let part = |bound: Vec2<Length>| {
                let [x, y] = from(center, bound);
                let clip = |v: i64, axis: usize| {
                    v.clamp(placed.min[axis].saturating_sub(metre), placed.max[axis].saturating_add(metre))
                };
                [clip(x, 0), clip(y, 1)]
            };
            let ([x0, y0], [x1, y1]) = (part(aabb.min), part(aabb.max));
            let mut window = Placed { count: 4, min: [x0, y0], max: [x1, y1], ..Placed::default() };
            window.vertices[..4].copy_from_slice(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
            const ONE: i32 = 1 << 30;
            const NORMALS: [[i32; 2]; 4] = [[0, -ONE], [ONE, 0], [0, ONE], [-ONE, 0]];
            window.normals[..4].copy_from_slice(&NORMALS);
            overlap(&placed, &window, [0, 0]).then(|| self.colliders.id(slot))
        };
        self.near(aabb, filter).filter_map(inside).collect()
    }

    /// The collider nearest to a point, if one is within `reach`; of several at the same distance the one in the lowest
    /// slot.
    pub fn closest_point(&self, point: Vec2<Length>, reach: Length, filter: Filter) -> Option<ClosestPoint> {
        let out = |p: Length, by: i64| Length::from_bits(p.to_bits().saturating_add(by));
        let by = reach.to_bits().max(0);
        let min = Vec2::new(out(point.x, by.saturating_neg()), out(point.y, by.saturating_neg()));
        let around = Aabb { min, max: Vec2::new(out(point.x, by), out(point.y, by)) };
        let nearest = self.near(&around, filter).map(|(slot, placed, center)| {
            let ([x, y], distance) = closest(&placed, from(center, point));
            let point = Vec2::new(out(center.x, x), out(center.y, y));
            ClosestPoint { collider: self.colliders.id(slot), point, distance: Length::from_bits(distance) }
        });
        // Of equal ones the first stays.
        nearest.filter(|found| found.distance <= reach).min_by_key(|found| found.distance)
    }

    /// The colliders whose reach meets a box, in slot order: slot, outline, centre of mass of the body.
    fn near(&self, around: &Aabb, filter: Filter) -> impl Iterator<Item = (usize, Placed, Vec2<Length>)> {
        self.colliders.rows.iter().filter_map(move |(slot, row)| {
            let body = row.body as usize;
            let (center, outline) = (self.bodies.position(body), self.colliders.outline(slot));
            let out = |p: Length, by: i64| Length::from_bits(p.to_bits().saturating_add(by));
            let reach = outline.reach;
            let min = Vec2::new(out(center.x, reach.saturating_neg()), out(center.y, reach.saturating_neg()));
            let whole = Aabb { min, max: Vec2::new(out(center.x, reach), out(center.y, reach)) };
            if !whole.overlaps(around) || !row.filter.meets(filter) {
                return None;
            }
            Some((slot, Placed::new(outline, Rot::new(self.bodies.angle.get(body))), center))
        })
    }
}

/// A point from a centre, Q32 m.
fn from(center: Vec2<Length>, point: Vec2<Length>) -> [i64; 2] {
    [point.x.to_bits().saturating_sub(center.x.to_bits()), point.y.to_bits().saturating_sub(center.y.to_bits())]
}
