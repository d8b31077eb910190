//! Geometry in integers of any width: units of 2⁻³² m with 64 fraction bits more, roots right to the last of them.

use super::*;
use num_bigint::BigInt;

pub(super) const FRACTION: u32 = 64;
pub(super) type Vector = [BigInt; 2];

pub(super) fn wide(value: i64) -> BigInt {
    BigInt::from(value) << FRACTION
}

pub(super) fn vector(v: [i64; 2]) -> Vector {
    v.map(wide)
}

pub(super) fn minus(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1]]
}

pub(super) fn plus(a: &Vector, b: &Vector) -> Vector {
    [&a[0] + &b[0], &a[1] + &b[1]]
}

pub(super) fn inner(a: &Vector, b: &Vector) -> BigInt {
    (&a[0] * &b[0] + &a[1] * &b[1]) >> FRACTION
}

pub(super) fn length(v: &Vector) -> BigInt {
    (&v[0] * &v[0] + &v[1] * &v[1]).sqrt()
}

/// v·by/of.
pub(super) fn scaled(v: &Vector, by: &BigInt, of: &BigInt) -> Vector {
    [&v[0] * by / of, &v[1] * by / of]
}

pub(super) fn magnitude(value: &BigInt) -> BigInt {
    BigInt::from(value.magnitude().clone())
}

/// Whether two numbers differ by at most `units` of 2⁻³² m.
pub(super) fn near(a: &BigInt, b: &BigInt, units: i64) -> bool {
    magnitude(&(a - b)) <= wide(units)
}

/// A polygon with its own normals, from its vertices alone.
pub(super) struct Exact {
    pub(super) vertices: Vec<Vector>,
    /// Of length 1.
    pub(super) normals: Vec<Vector>,
}

impl Exact {
    pub(super) fn new(placed: &Placed, shift: [i64; 2]) -> Exact {
        let count = usize::from(placed.count);
        let vertices: Vec<Vector> =
            placed.vertices[..count].iter().map(|v| vector([v[0] + shift[0], v[1] + shift[1]])).collect();
        let normal = |at: usize| {
            let [x, y] = minus(&vertices[(at + 1) % count], &vertices[at]);
            scaled(&[y.clone(), -&x], &wide(1), &length(&[x, y]))
        };
        Exact { normals: (0..count).map(normal).collect(), vertices }
    }

    pub(super) fn next(&self, edge: usize) -> usize {
        (edge + 1) % self.vertices.len()
    }

    /// How far a point is outside an edge.
    pub(super) fn outside(&self, edge: usize, p: &Vector) -> BigInt {
        inner(&self.normals[edge], &minus(p, &self.vertices[edge]))
    }

    pub(super) fn along(&self, edge: usize, p: &Vector) -> BigInt {
        let [x, y] = &self.normals[edge];
        inner(&[-y, x.clone()], &minus(p, &self.vertices[edge]))
    }

    pub(super) fn separation(&self, edge: usize, other: &Exact) -> BigInt {
        other.vertices.iter().map(|v| self.outside(edge, v)).min().expect("vertices")
    }

    pub(super) fn greatest(&self, other: &Exact) -> BigInt {
        (0..self.vertices.len()).map(|edge| self.separation(edge, other)).max().expect("edges")
    }

    /// The distance of a point from the polygon, negative inside, and the nearest point of the border of one outside.
    pub(super) fn distance(&self, p: &Vector) -> (BigInt, Vector) {
        let edges = 0..self.vertices.len();
        let deepest = edges.clone().map(|edge| self.outside(edge, p)).max().expect("edges");
        let on = |edge: usize| {
            let (from, to) = (&self.vertices[edge], &self.vertices[self.next(edge)]);
            let side = minus(to, from);
            let (part, whole) = (inner(&minus(p, from), &side), inner(&side, &side));
            plus(from, &scaled(&side, &part.clamp(BigInt::ZERO, whole.clone()), &whole))
        };
        let nearest = edges.map(on).min_by_key(|at| length(&minus(p, at))).expect("edges");
        if deepest <= BigInt::ZERO { (deepest, p.clone()) } else { (length(&minus(p, &nearest)), nearest) }
    }
}
