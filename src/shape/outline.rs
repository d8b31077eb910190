//! Outlines: what collides. Derived from shapes, shared by all colliders of the same form.

use super::def::Shape;
use super::hull::{bits, minus, product};
use crate::geom::{Rot, Vec2};
use crate::num::{Angle, Length, add_sat, clamp_i64, div, hypot, round_shift};

/// The most vertices of a polygon.
pub(crate) const MAX_VERTICES: usize = 8;

/// A convex outline in the body's axes, about the body's centre of mass.
///
/// | field | format | bound |
/// |---|---|---|
/// | `vertices` | Q32 m | 39 100 m from the centre, so differences and turns stay below 2⁴⁹; 32 766 m apart |
/// | `normals` | Q30, unit to 2⁻²⁹ | 2³⁰ |
/// | `radius`, `reach` | Q32 m | below 2¹⁶ m |
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outline {
    /// 1 for a circle, whose centre is its vertex; 3 … 8 for a polygon, counter-clockwise.
    pub(crate) count: u8,
    pub(crate) vertices: [[i64; 2]; MAX_VERTICES],
    /// `normals[i]` points out of the edge from vertex i to vertex i + 1.
    pub(crate) normals: [[i32; 2]; MAX_VERTICES],
    /// That of a circle; 0 for a polygon.
    pub(crate) radius: i64,
    /// No point of the outline is farther from the centre of mass, however it is turned: rounded up, and 2⁻²⁹ of a
    /// vertex's distance more, which a turn may stretch.
    pub(crate) reach: i64,
}

crate::store::show!(Outline { count, vertices, normals, radius, reach });

/// An outline turned into the world's axes, still about its body's centre of mass. Formats and bounds as there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Placed {
    pub(crate) count: u8,
    pub(crate) vertices: [[i64; 2]; MAX_VERTICES],
    pub(crate) normals: [[i32; 2]; MAX_VERTICES],
    pub(crate) radius: i64,
    /// The least box around it: lower left and upper right corner.
    pub(crate) min: [i64; 2],
    pub(crate) max: [i64; 2],
}

impl Shape {
    /// The outline of an accepted form whose origin is at `offset` from the body's and which is turned by `angle`, about
    /// `center`, a point of the body within ±16 000 m of its origin.
    ///
    /// Order: counter-clockwise, a polygon from its first vertex, a box from its lower left corner. Rounding: half a width
    /// to nearest; a turn once per coordinate, and exact at quarter turns; all else is exact. Normals are those of the
    /// form before it is turned, to nearest (half a unit of 2⁻³⁰, and 2⁻³² of one more), then turned as vertices are.
    pub(crate) fn outline(&self, offset: Vec2<Length>, angle: Angle, center: Vec2<Length>) -> Outline {
        let (corners, radius) = match self.canonical() {
            Shape::Circle { radius } => (vec![[0, 0]], radius.to_bits()),
            Shape::Box { width, height } => {
                let [x, y] = [width, height].map(|side| round_shift(side.to_bits().into(), 1) as i64);
                let [left, low] = [x, y].map(i64::saturating_neg);
                (vec![[left, low], [x, low], [x, y], [left, y]], 0)
            }
            Shape::Polygon { vertices } => (vertices.into_iter().map(bits).collect(), 0),
        };
        let rot = Rot::new(angle);
        let count = corners.len().min(MAX_VERTICES);
        let mut outline = Outline { count: count as u8, radius, ..Outline::default() };
        for (at, &corner) in corners[..count].iter().enumerate() {
            let turned = minus(turn(corner, rot), bits(center));
            let vertex = [add_sat(turned[0], offset.x.to_bits()), add_sat(turned[1], offset.y.to_bits())];
            outline.vertices[at] = vertex;
            outline.reach = outline.reach.max(farthest(vertex).saturating_add(radius));
            if count > 1 {
                let next = *corners[..count].get(at.saturating_add(1)).unwrap_or(&corners[0]);
                outline.normals[at] = turn_unit(normal(minus(next, corner)), rot);
            }
        }
        outline
    }
}

/// The unit vector to the right of `edge`, Q30. The edge is scaled up to 2⁶⁰ … 2⁶¹, so its rounded length is off by 2⁻⁶¹
/// of it only.
fn normal(edge: [i64; 2]) -> [i32; 2] {
    let greatest = edge[0].unsigned_abs().max(edge[1].unsigned_abs());
    let scale = 1_i64 << greatest.leading_zeros().saturating_sub(3).min(60);
    let [dx, dy] = edge.map(|d| d.saturating_mul(scale));
    let length = i128::from(hypot(dx, dy));
    [dy, dx.saturating_neg()].map(|d| div(product(d, 1 << 30), length).clamp(-(1 << 30), 1 << 30) as i32)
}

/// How far `v` may be from the origin once turned. A turn by a rounded rotation stretches by 1e-9 at most, less than
/// 2⁻²⁹, and rounds by less than a unit.
fn farthest(v: [i64; 2]) -> i64 {
    let distance = i64::try_from(hypot(v[0], v[1])).unwrap_or(i64::MAX);
    let slack = if distance == 0 { 0 } else { (distance >> 29).saturating_add(2) };
    distance.saturating_add(slack)
}

/// `v` turned, rounded to nearest and odd. Products are below 2⁹⁴, so the sums cannot wrap: half a unit is added, less one
/// of the last bit for negative sums, which takes a tie away from zero. [`num::dot`](crate::num::dot) gives the same bits
/// in twice the time.
#[inline]
fn turn([x, y]: [i64; 2], rot: Rot) -> [i64; 2] {
    let [x, y, cos, sin] = [x, y, rot.cos.into(), rot.sin.into()].map(i128::from);
    let nearest = |sum: i128| clamp_i64(sum.wrapping_add(1 << 29).wrapping_add(sum >> 127) >> 30);
    [
        nearest(x.wrapping_mul(cos).wrapping_sub(y.wrapping_mul(sin))),
        nearest(x.wrapping_mul(sin).wrapping_add(y.wrapping_mul(cos))),
    ]
}

/// A unit vector turned, likewise, in 64 bits: sums are below 2⁶¹ and a half. It does not grow beyond 1.
#[inline]
fn turn_unit([x, y]: [i32; 2], rot: Rot) -> [i32; 2] {
    let [x, y, cos, sin] = [x, y, rot.cos, rot.sin].map(i64::from);
    let nearest =
        |sum: i64| (sum.wrapping_add(1 << 29).wrapping_add(sum >> 63) >> 30).clamp(-(1 << 30), 1 << 30) as i32;
    [
        nearest(x.wrapping_mul(cos).wrapping_sub(y.wrapping_mul(sin))),
        nearest(x.wrapping_mul(sin).wrapping_add(y.wrapping_mul(cos))),
    ]
}

impl Placed {
    /// Turns an outline: about 40 ns for a box, 17 for a circle. Rounding: nearest and odd, once per coordinate, so an
    /// outline turned by half a turn more has the negated bits.
    pub(crate) fn new(outline: &Outline, rot: Rot) -> Placed {
        let mut placed = Placed { count: outline.count, radius: outline.radius, ..Placed::default() };
        let (mut min, mut max) = ([i64::MAX; 2], [-i64::MAX; 2]);
        for at in 0..usize::from(outline.count).min(MAX_VERTICES) {
            let vertex = turn(outline.vertices[at], rot);
            placed.vertices[at] = vertex;
            // That of a circle is (0, 0) and stays so.
            placed.normals[at] = turn_unit(outline.normals[at], rot);
            for axis in 0..2 {
                min[axis] = vertex[axis].min(min[axis]);
                max[axis] = vertex[axis].max(max[axis]);
            }
        }
        placed.min = min.map(|least| least.saturating_sub(outline.radius));
        placed.max = max.map(|greatest| greatest.saturating_add(outline.radius));
        placed
    }
}
