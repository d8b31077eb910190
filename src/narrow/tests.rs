//! Manifolds against exact rational arithmetic, their symmetries, and what they cost.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod exact;
mod faces;
mod hard;
mod identity;
mod limits;
mod meeting;
mod oracle;
mod queries;
mod search;
mod symmetry;

use super::{Faces, Manifold, closest, collide};
use crate::geom::{Rot, Vec2};
use crate::num::{Angle, Length, mul, sin_cos};
use crate::shape::{Placed, Shape};

/// 1 m.
const M: i64 = 1 << 32;
const ONE: i32 = 1 << 30;

/// Reproducible noise (splitmix64).
struct Noise(u64);

impl Noise {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// `low` … `high`, both included.
    fn within(&mut self, low: i64, high: i64) -> i64 {
        (i128::from(low) + i128::from(self.bits()) % (i128::from(high) - i128::from(low) + 1)) as i64
    }

    /// A point at `radius` from the origin.
    fn around(&mut self, radius: i64) -> [i64; 2] {
        at(self.within(0, (1 << 48) - 1), radius)
    }

    /// A convex polygon with its corners on a circle about a point near the origin.
    fn polygon(&mut self, radius: i64) -> Placed {
        let count = self.within(3, 8);
        let shift = self.within(0, radius);
        let center = self.around(shift);
        loop {
            let mut turns: Vec<i64> = (0..count).map(|_| self.within(0, (1 << 48) - 1)).collect();
            turns.sort_unstable();
            // No edge shorter than a sixtieth of the way round.
            let far = |pair: &[i64]| pair[1] - pair[0] > (1 << 42);
            if turns.windows(2).all(far) && turns[0] + (1 << 48) - turns[turns.len() - 1] > (1 << 42) {
                let corners = turns.iter().map(|&turn| at(turn, radius)).map(|[x, y]| [x + center[0], y + center[1]]);
                return polygon(&corners.collect::<Vec<_>>());
            }
        }
    }

    fn circle(&mut self, radius: i64) -> Placed {
        let away = self.within(0, radius);
        circle(self.around(away), radius)
    }

    /// A polygon or, one in four, a circle.
    fn outline(&mut self, radius: i64) -> Placed {
        if self.within(0, 3) == 0 { self.circle(radius) } else { self.polygon(radius) }
    }
}

/// The point at `radius` from the origin in the direction `turn`, 48 fraction bits of a turn.
fn at(turn: i64, radius: i64) -> [i64; 2] {
    let (cos, sin) = sin_cos(Angle::from_bits(turn));
    [mul(radius, cos.into(), 30), mul(radius, sin.into(), 30)]
}

fn vec(v: [i64; 2]) -> Vec2<Length> {
    Vec2::new(Length::from_bits(v[0]), Length::from_bits(v[1]))
}

fn place(shape: &Shape, offset: [i64; 2], turn: i64) -> Placed {
    let outline = shape.canonical().outline(vec(offset), Angle::ZERO, Vec2::default());
    Placed::new(&outline, Rot::new(Angle::from_bits(turn)))
}

fn polygon(corners: &[[i64; 2]]) -> Placed {
    place(&Shape::Polygon { vertices: corners.iter().map(|&v| vec(v)).collect() }, [0, 0], 0)
}

fn circle(center: [i64; 2], radius: i64) -> Placed {
    place(&Shape::Circle { radius: Length::from_bits(radius) }, center, 0)
}

/// Vertices from the lower left, edges from the lower one.
fn rectangle(width: i64, height: i64, turn: i64) -> Placed {
    let shape = Shape::Box { width: Length::from_bits(width), height: Length::from_bits(height) };
    place(&shape, [0, 0], turn)
}

fn negated(v: [i64; 2]) -> [i64; 2] {
    [-v[0], -v[1]]
}

/// The outline turned by half a turn.
fn opposite(p: &Placed) -> Placed {
    Placed {
        vertices: p.vertices.map(negated),
        normals: p.normals.map(|n| [-n[0], -n[1]]),
        min: negated(p.max),
        max: negated(p.min),
        ..p.clone()
    }
}

/// The id of a's edge, b's edge and the end by the direction of a's.
const fn id(a: u8, b: u8, end: u8) -> u8 {
    a << 4 | b << 1 | end
}

/// Its points as arm, separation and id.
fn points(manifold: &Manifold) -> Vec<([i64; 2], i64, u8)> {
    let all = manifold.points.iter().map(|p| (p.arm, p.separation, p.id));
    all.take(manifold.count.into()).collect()
}
