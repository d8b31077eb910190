//! Masses of forms: area, centre and moment of inertia.

use super::def::{ColliderDef, Shape};
use super::hull::{bits, cross, minus, product};
use crate::geom::{Rot, Vec2};
use crate::num::{Length, clamp_i64, div, mul_div, round_shift};

/// π with 120 fraction bits.
const PI_Q120: i128 = 4_175_892_906_503_776_358_826_876_457_663_557_747;
/// 1 with 92 fraction bits. Areas and squared radii of gyration have them: below 2³¹ m² for accepted forms, so below 2¹²³,
/// and the sums they are made of below 2¹²⁶.
const ONE_Q92: i128 = 1 << 92;
/// From the square of a Q32, Q64, to Q92.
const UP: i128 = 1 << 28;

/// Mass, centre of mass and moment of inertia about it.
///
/// | field | format | bound |
/// |---|---|---|
/// | `mass` | Q64 kg, before any range is checked | saturates at `i128::MAX` |
/// | `center` | Q32 m, in the body's axes from the body's origin | 2¹⁵ m |
/// | `inertia` | Q64 kg m² about `center` | saturates |
///
/// Error: the mass half a unit per collider; the centre half a unit and 2⁻²³ of one more, and what those half units of
/// mass move it; the inertia a part in 1e15 for sizes from 1 cm on, in 1e12 from 1e-6 m on, the mass's own relative error,
/// and a unit per collider and metre of its arm. Order: none, the same colliders give the same bits. The turn of a
/// collider is that of its outline, so the centre is that of what collides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MassData {
    pub(crate) mass: i128,
    pub(crate) center: Vec2<Length>,
    pub(crate) inertia: i128,
}

impl MassData {
    /// That of the colliders that are not sensors, together (DD:ctrOfMass); mass 0 if there is none.
    pub(crate) fn of(colliders: &[ColliderDef]) -> MassData {
        let parts: Vec<Part> = colliders.iter().filter(|def| !def.sensor).map(Part::of).collect();
        let mass = parts.iter().fold(0_i128, |sum, part| sum.saturating_add(part.mass));
        let along = |axis: usize| {
            let shares = parts.iter().map(|part| mul_div(part.mass, part.center[axis], mass));
            Length::from_bits(clamp_i64(round_shift(shares.fold(0_i128, i128::saturating_add), 32)))
        };
        let center = if mass == 0 { Vec2::default() } else { Vec2::new(along(0), along(1)) };
        let inertia = parts.iter().fold(0_i128, |sum, part| {
            let arm = [0, 1].map(|axis| part.center[axis].saturating_sub(wide(bits(center)[axis])));
            sum.saturating_add(mul_div(part.mass, part.gyration, ONE_Q92)).saturating_add(carried(part.mass, arm))
        });
        MassData { mass, center, inertia }
    }

    /// The moment of inertia about another point, `inertia + mass·d²` (parallel axis).
    pub(crate) fn about(&self, point: Vec2<Length>) -> i128 {
        let arm = minus(bits(point), bits(self.center)).map(wide);
        self.inertia.saturating_add(carried(self.mass, arm))
    }
}

/// Q32 to Q64.
fn wide(bits: i64) -> i128 {
    product(bits, 1 << 32)
}

/// `mass·|arm|²`, Q64 from Q64. Error: half a unit, and |arm| halves of one more.
fn carried(mass: i128, arm: [i128; 2]) -> i128 {
    const ONE: i128 = 1 << 64;
    let [x, y] = arm.map(|d| mul_div(mul_div(mass, d, ONE), d, ONE));
    x.saturating_add(y)
}

/// What one collider adds.
struct Part {
    /// Q64 kg.
    mass: i128,
    /// Q64 m, in the body's axes.
    center: [i128; 2],
    /// The square of the radius of gyration about `center`, Q92 m².
    gyration: i128,
}

impl Part {
    fn of(def: &ColliderDef) -> Part {
        let Form { area, center: [x, y], gyration } = Form::of(&def.shape);
        let rot = Rot::new(def.angle);
        // Below 2⁷⁹ · 2³⁰.
        let turn = |a: i32, b: i32| {
            let sum = x.saturating_mul(a.into()).saturating_add(y.saturating_mul(b.into()));
            round_shift(sum, 30)
        };
        let [left, up] = bits(def.offset).map(wide);
        let center =
            [turn(rot.cos, rot.sin.saturating_neg()).saturating_add(left), turn(rot.sin, rot.cos).saturating_add(up)];
        Part { mass: mul_div(def.density.to_bits(), area, ONE_Q92), center, gyration }
    }
}

/// A form without its density.
struct Form {
    /// Q92 m².
    area: i128,
    /// Q64 m.
    center: [i128; 2],
    /// Q92 m², about `center`.
    gyration: i128,
}

impl Form {
    fn of(shape: &Shape) -> Form {
        match shape {
            Shape::Circle { radius } => {
                let square = product(radius.to_bits(), radius.to_bits());
                Form {
                    area: mul_div(square, PI_Q120, ONE_Q92),
                    center: [0, 0],
                    gyration: square.saturating_mul(1 << 27),
                }
            }
            Shape::Box { width, height } => {
                let [w, h] = [width.to_bits(), height.to_bits()];
                let squares = product(w, w).saturating_add(product(h, h));
                Form {
                    area: product(w, h).saturating_mul(UP),
                    center: [0, 0],
                    gyration: div(squares.saturating_mul(UP), 12),
                }
            }
            Shape::Polygon { vertices } => Form::of_polygon(vertices),
        }
    }

    /// The triangles of vertex 0 and each edge that does not touch it, all seen from vertex 0. Twice a triangle's area is
    /// c = a × b, its centre (a + b)/3, and its second moment c·(a·a + a·b + b·b)/12. Of an accepted polygon all c have
    /// one sign, so nothing cancels in the sums; taking the centre's square from the second moment costs three bits.
    fn of_polygon(vertices: &[Vec2<Length>]) -> Form {
        let Some(&first) = vertices.first() else { return Form { area: 0, center: [0, 0], gyration: 0 } };
        let arms: Vec<[i64; 2]> = vertices.iter().map(|&v| minus(bits(v), bits(first))).collect();
        let triangles = || arms.windows(2).map(|pair| (pair[0], pair[1], cross(pair[0], pair[1])));
        let total = triangles().fold(0_i128, |sum, (_, _, c)| sum.saturating_add(c));
        let center = [0, 1].map(|axis| {
            triangles().fold(0_i128, |sum, (a, b, c)| {
                let share = wide(a[axis].saturating_add(b[axis]));
                sum.saturating_add(mul_div(c, share, total.saturating_mul(3)))
            })
        });
        let about_first = triangles().fold(0_i128, |sum, (a, b, c)| {
            let squares =
                [(a, a), (a, b), (b, b)].map(|(a, b)| product(a[0], b[0]).saturating_add(product(a[1], b[1])));
            let squares = squares.into_iter().fold(0_i128, i128::saturating_add);
            sum.saturating_add(mul_div(c, squares.saturating_mul(UP), total.saturating_mul(6)))
        });
        let moved = center.map(|g| mul_div(g, g, 1 << 36)).into_iter().fold(0_i128, i128::saturating_add);
        let [x, y] = bits(first).map(wide);
        Form {
            area: total.saturating_abs().saturating_mul(1 << 27),
            center: [center[0].saturating_add(x), center[1].saturating_add(y)],
            gyration: about_first.saturating_sub(moved),
        }
    }
}
