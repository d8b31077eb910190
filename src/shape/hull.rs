//! What is accepted of a form.
//!
//! Every decision about a polygon is made in exact integers: coordinates are below 2⁴⁶, their differences below 2⁴⁷ and
//! the products of two below 2⁹⁴. Only what is too short or too thin is measured with a root rounded to 2⁻³² m.

use super::def::{ColliderDef, Shape, ShapeError};
use super::outline::MAX_VERTICES;
use crate::geom::Vec2;
use crate::num::{Length, Quantity, hypot};

/// 1e-6 m, as 32 fraction bits round it: the least size, length of an edge and width of a polygon.
const LEAST: i64 = 4_295;
/// 16 000 m: the greatest size and coordinate.
const FAR: i64 = 16_000 << 32;
/// 16 383 m: how far a collider may reach from its body's origin, so two of its points are less than 2¹⁵ m apart,
/// however it is turned.
const REACH: i64 = 16_383 << 32;

/// `a × b`, exactly for differences of coordinates; counter-clockwise positive.
pub(super) fn cross(a: [i64; 2], b: [i64; 2]) -> i128 {
    product(a[0], b[1]).saturating_sub(product(a[1], b[0]))
}

/// `a·b`, exactly: at most 2¹²⁶.
pub(super) fn product(a: i64, b: i64) -> i128 {
    i128::from(a).saturating_mul(b.into())
}

/// `a − b`.
pub(super) fn minus(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0].saturating_sub(b[0]), a[1].saturating_sub(b[1])]
}

/// Its bits.
pub(super) fn bits(v: Vec2<Length>) -> [i64; 2] {
    [v.x.to_bits(), v.y.to_bits()]
}

impl ColliderDef {
    /// Whether a collider can be like this: its quantities in their ranges, its form as [`Shape`] says, and no point of
    /// it farther than 16 383 m from the body's origin.
    ///
    /// Errors, the first that holds of: a range, an offset or a vertex that is [far](ShapeError::Far), a size; of a
    /// polygon the count, a repeated vertex, a collinear one, a turn the other way, a short edge, too little width; the
    /// reach.
    pub fn check(&self) -> Result<(), ShapeError> {
        let ColliderDef { shape, offset, angle, density, restitution, friction, filter: _, sensor: _ } = self;
        angle.checked()?;
        density.checked()?;
        restitution.checked()?;
        friction.checked()?;
        near(*offset)?;
        shape.check()?;
        let reach = shape.outline(*offset, *angle, Vec2::default()).reach;
        if reach > REACH { Err(ShapeError::Reach { value: Length::from_bits(reach) }) } else { Ok(()) }
    }
}

impl Shape {
    fn check(&self) -> Result<(), ShapeError> {
        match self {
            Shape::Circle { radius } => size("radius", *radius),
            Shape::Box { width, height } => {
                size("width", *width)?;
                size("height", *height)
            }
            Shape::Polygon { vertices } => polygon(vertices),
        }
    }

    /// The same form with its vertices counter-clockwise, from the same first vertex.
    pub(crate) fn canonical(&self) -> Shape {
        let mut shape = self.clone();
        if let Shape::Polygon { vertices } = &mut shape {
            if vertices.len() > 1 && doubled_area(vertices) < 0 {
                vertices[1..].reverse();
            }
        }
        shape
    }
}

fn near(v: Vec2<Length>) -> Result<(), ShapeError> {
    match [v.x, v.y].into_iter().find(|c| c.to_bits().unsigned_abs() > FAR.unsigned_abs()) {
        Some(value) => Err(ShapeError::Far { value }),
        None => Ok(()),
    }
}

fn size(name: &'static str, value: Length) -> Result<(), ShapeError> {
    if (LEAST..=FAR).contains(&value.to_bits()) { Ok(()) } else { Err(ShapeError::Size { name, value }) }
}

/// Twice the area, Q64 m², positive counter-clockwise: exact for coordinates below 2⁴⁶.
fn doubled_area(vertices: &[Vec2<Length>]) -> i128 {
    let Some(&first) = vertices.first() else { return 0 };
    let arm = |v: Vec2<Length>| minus(bits(v), bits(first));
    vertices.windows(2).fold(0, |sum, pair| sum.saturating_add(cross(arm(pair[0]), arm(pair[1]))))
}

fn polygon(given: &[Vec2<Length>]) -> Result<(), ShapeError> {
    let count = given.len();
    if !(3..=MAX_VERTICES).contains(&count) {
        return Err(ShapeError::VertexCount { count: count as u64 });
    }
    for &v in given {
        near(v)?;
    }
    for (at, v) in given.iter().enumerate() {
        if given[..at].contains(v) {
            return Err(ShapeError::RepeatedVertex { index: at as u32 });
        }
    }
    // Twice round, so what follows a vertex is behind it.
    let ring: Vec<_> = given.iter().chain(given).map(|&v| bits(v)).collect();
    let edge = |at: usize| minus(ring[at.saturating_add(1)], ring[at]);
    // How the polygon turns at a vertex.
    let turn = |at: usize| cross(edge(at.saturating_add(count).saturating_sub(1)), edge(at)).signum();
    if let Some(at) = (0..count).find(|&at| turn(at) == 0) {
        return Err(ShapeError::Collinear { index: at as u32 });
    }
    // A figure of eight may have no area; its first turn decides then.
    let area = doubled_area(given).signum();
    let way = if area == 0 { turn(0) } else { area };
    if let Some(at) = (0..count).find(|&at| turn(at) != way) {
        return Err(ShapeError::NotConvex { index: at as u32 });
    }
    // How far a vertex is inside an edge, times the edge's length. With all turns right, none inside means that the
    // polygon winds round more than once.
    let height = |at: usize, other: usize| cross(edge(at), minus(ring[other], ring[at])).saturating_mul(way);
    let others = |at: usize| at.saturating_add(2)..at.saturating_add(count);
    for at in 0..count {
        if let Some(other) = others(at).find(|&other| height(at, other) <= 0) {
            let index = if other < count { other } else { other.saturating_sub(count) };
            return Err(ShapeError::NotConvex { index: index as u32 });
        }
    }
    for at in 0..count {
        let [dx, dy] = edge(at);
        let length = hypot(dx, dy);
        if length < LEAST.unsigned_abs() {
            return Err(ShapeError::ShortEdge { index: at as u32 });
        }
        let width = others(at).map(|other| height(at, other)).max().unwrap_or(0);
        if width < i128::from(length).saturating_mul(LEAST.into()) {
            return Err(ShapeError::Thin { index: at as u32 });
        }
    }
    Ok(())
}
