//! The narrow phase: where two outlines touch.
//!
//! | file | what |
//! |---|---|
//! | `manifold` | what comes out, and which of the three cases it is |
//! | `polygon` | two polygons: separating axes, clipped edges |
//! | `faces` | which edges of two polygons face each other, from before |
//! | `circle` | a circle against a polygon or a circle |
//! | `overlap` | whether outlines have a point in common |
//! | `query` | points in outlines, nearest points, rays |
//! | `meeting`, `moment`, `course` | when two moving outlines first touch |
//! | `clearance` | that they do not, as far as a gap that is known tells |
//! | `unit` | directions and lengths without a division |

mod circle;
mod clearance;
mod course;
mod faces;
mod manifold;
mod meeting;
mod moment;
mod overlap;
mod polygon;
mod query;
#[cfg(test)]
mod tests;
mod unit;

pub(crate) use clearance::Clearance;
pub(crate) use faces::Faces;
pub(crate) use manifold::{Manifold, Near, Point, collide, near};
pub(crate) use meeting::{Motion, first_touch};
pub(crate) use overlap::overlap;
pub(crate) use query::{Hit, closest, contains, ray};

/// n·v, Q38 m, rounded down: the inputs negated, it is the same. In 64 bits, because a compiler that moves the widening to
/// 128 bits out of a loop multiplies three times for each product.
///
/// Range: |n| ≤ 2³⁰ and |v| < 2⁵². Of v's two parts the high one is below 2²⁸, a product of it below 2⁵⁸.
#[inline]
fn along(n: [i32; 2], v: [i64; 2]) -> i64 {
    let n = n.map(i64::from);
    let product = |v: [i64; 2]| n[0].wrapping_mul(v[0]).wrapping_add(n[1].wrapping_mul(v[1]));
    let low = product(v.map(|c| c & 0xff_ffff));
    product(v.map(|c| c >> 24)).wrapping_add(low >> 24)
}

/// Q38 m to Q32 m, to nearest, ties up.
#[inline]
fn rounded(value: i64) -> i64 {
    value.wrapping_add(1 << 5) >> 6
}

/// a·b exactly: coordinates up to 2⁶² and 2⁶³ give at most 2¹²⁶.
#[inline]
fn inner(a: [i64; 2], b: [i64; 2]) -> i128 {
    let term = |axis: usize| i128::from(a[axis]).wrapping_mul(i128::from(b[axis]));
    term(0).wrapping_add(term(1))
}

/// a × b exactly, counter-clockwise positive; bounds as there.
#[inline]
fn outer(a: [i64; 2], b: [i64; 2]) -> i128 {
    let term = |x: i64, y: i64| i128::from(x).wrapping_mul(i128::from(y));
    term(a[0], b[1]).wrapping_sub(term(a[1], b[0]))
}

/// a + b; positions and their differences are below 2⁵² here.
#[inline]
fn sum(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0].wrapping_add(b[0]), a[1].wrapping_add(b[1])]
}

/// a − b, as there.
#[inline]
fn difference(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0].wrapping_sub(b[0]), a[1].wrapping_sub(b[1])]
}

/// The next vertex or edge.
#[inline]
fn next(index: usize, count: usize) -> usize {
    let next = index.saturating_add(1);
    if next < count { next } else { 0 }
}

/// The one before.
#[inline]
fn previous(index: usize, count: usize) -> usize {
    if index == 0 { count.saturating_sub(1) } else { index.wrapping_sub(1) }
}
