#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]
//! Masses against exact rationals.

use super::tests::{Numbers, circle, metres, polygon, rectangle};
use super::{ColliderDef, MassData, Shape};
use crate::geom::{Rot, Vec2};
use crate::num::{Angle, Density, Length};
use num_bigint::BigInt;
use num_rational::BigRational;

type Exact = BigRational;

fn ratio(n: impl Into<BigInt>, d: impl Into<BigInt>) -> Exact {
    Exact::new(n.into(), d.into())
}

/// `bits` with `frac` fraction bits.
fn fixed(bits: impl Into<BigInt>, frac: u32) -> Exact {
    ratio(bits, BigInt::from(1) << frac)
}

/// A decimal number.
fn decimal(text: &str) -> Exact {
    let (whole, part) = text.split_once('.').unwrap_or((text, ""));
    let digits: BigInt = format!("{whole}{part}").parse().expect(text);
    ratio(digits, BigInt::from(10).pow(part.len() as u32))
}

fn pi() -> Exact {
    decimal("3.14159265358979323846264338327950288419716939937510582097494")
}

fn square(x: &Exact) -> Exact {
    x * x
}

fn magnitude(x: Exact) -> Exact {
    if x < fixed(0, 0) { -x } else { x }
}

/// Mass, centre and moment of inertia about the body's origin.
struct Moments {
    mass: Exact,
    center: [Exact; 2],
    inertia: Exact,
}

/// Those of one collider, by the integrals along its boundary from the origin of its axes, then turned as outlines are.
fn moments(def: &ColliderDef) -> Moments {
    let m = |length: Length| fixed(length.to_bits(), 32);
    let zero = || fixed(0, 0);
    let (area, center, gyration) = match &def.shape {
        Shape::Circle { radius } => {
            let square = square(&m(*radius));
            (pi() * &square, [zero(), zero()], square / fixed(2, 0))
        }
        Shape::Box { width, height } => {
            let [w, h] = [m(*width), m(*height)];
            (&w * &h, [zero(), zero()], (square(&w) + square(&h)) / fixed(12, 0))
        }
        Shape::Polygon { vertices } => {
            let points: Vec<_> = vertices.iter().map(|v| [m(v.x), m(v.y)]).collect();
            let (mut doubled, mut first, mut second) = (zero(), [zero(), zero()], zero());
            for (at, a) in points.iter().enumerate() {
                let b = &points[(at + 1) % points.len()];
                let c = &a[0] * &b[1] - &a[1] * &b[0];
                for axis in 0..2 {
                    first[axis] += &c * (&a[axis] + &b[axis]);
                    second += &c * (square(&a[axis]) + &a[axis] * &b[axis] + square(&b[axis]));
                }
                doubled += c;
            }
            let center = first.map(|sum| sum / (&doubled * fixed(3, 0)));
            let gyration = second / (&doubled * fixed(6, 0)) - square(&center[0]) - square(&center[1]);
            (magnitude(doubled) / fixed(2, 0), center, gyration)
        }
    };
    let rot = Rot::new(def.angle);
    let [cos, sin] = [rot.cos, rot.sin].map(|part| fixed(part, 30));
    let center = [
        &center[0] * &cos - &center[1] * &sin + m(def.offset.x),
        &center[0] * &sin + &center[1] * &cos + m(def.offset.y),
    ];
    let mass = area * fixed(def.density.to_bits(), 64);
    let inertia = &mass * (gyration + square(&center[0]) + square(&center[1]));
    Moments { mass, center, inertia }
}

/// Checks the mass to a unit per collider and one of its area's 92 fraction bits, the centre to half a unit and what
/// rounded masses make of it, and the inertia to two units per collider and metre and the given part.
fn check(defs: &[ColliderDef], part: &Exact) {
    let found = MassData::of(defs);
    let mut sum = Moments { mass: fixed(0, 0), center: [fixed(0, 0), fixed(0, 0)], inertia: fixed(0, 0) };
    for one in defs.iter().filter(|def| !def.sensor).map(moments) {
        for axis in 0..2 {
            sum.center[axis] += &one.mass * &one.center[axis];
        }
        sum.mass += one.mass;
        sum.inertia += one.inertia;
    }
    let center = sum.center.clone().map(|moment| moment / &sum.mass);
    let arm = defs.iter().map(|def| def.shape.outline(def.offset, def.angle, found.center).reach >> 32).max();
    let arm = fixed(arm.unwrap_or(0) + 1, 0);
    // How far a unit of mass at each collider but one moves the centre.
    let blur = fixed(defs.len() as u64 - 1, 64) * &arm / &sum.mass;
    let rounded = [found.center.x, found.center.y].map(|c| fixed(c.to_bits(), 32));
    for axis in 0..2 {
        let error = magnitude(&rounded[axis] - &center[axis]);
        assert!(error <= fixed(1, 33) + fixed(1, 56) + &blur, "{defs:?}: centre off by {error}");
    }
    let units = |sizes: u64| fixed(sizes * defs.len() as u64, 64);
    let error = magnitude(fixed(found.mass, 64) - &sum.mass);
    let areas = defs.iter().fold(fixed(0, 0), |sum, def| sum + fixed(def.density.to_bits(), 64 + 92));
    assert!(error <= units(1) + areas, "{defs:?}: mass off by {error}");
    // About the centre as it was rounded.
    let [x, y] = &rounded;
    let about =
        &sum.inertia - fixed(2, 0) * (x * &sum.center[0] + y * &sum.center[1]) + &sum.mass * (square(x) + square(y));
    let error = magnitude(fixed(found.inertia, 64) - &about);
    let allowed = units(2) * arm + part * &about;
    assert!(error <= allowed, "{defs:?}: inertia off by {error} of {about}");
}

fn of(shape: Shape, density: &str) -> ColliderDef {
    ColliderDef { density: density.parse().expect(density), ..ColliderDef::new(shape) }
}

/// The value with so many decimals.
fn told(bits: i128, decimals: usize) -> String {
    let value = crate::num::Decimal { bits, frac: 64 };
    format!("{value:.decimals$}")
}

#[test]
fn moments_of_the_requirements() {
    let cases = [
        (of(rectangle("100", "100"), "0.00005"), "0.5000000000", "833.333333333"),
        (of(rectangle("500", "500"), "0.002"), "500.0000000000", "20833333.333333333"),
        (of(rectangle("2", "3"), "0.16666666666666666667"), "1.0000000000", "1.083333333"),
        (of(circle("2"), "1"), "12.5663706144", "25.132741229"),
    ];
    for (def, mass, inertia) in cases {
        let found = MassData::of(std::slice::from_ref(&def));
        assert_eq!(told(found.mass, 10), mass);
        assert_eq!(told(found.inertia, 9), inertia);
        assert!(found.center.is_zero());
    }
    let triangle = MassData::of(&[of(polygon("0 0, 10 10, 10 0"), "1")]);
    assert_eq!(triangle.center, Vec2::new(metres("6.6666666667"), metres("3.3333333333")));
    assert_eq!(triangle.mass, 50 << 64);
    // b·h·(b² + h²)/36 for the right triangle: 100·200/36.
    assert_eq!(told(triangle.inertia, 9), "555.555555556");
}

#[test]
fn forms_of_every_size_have_their_moments() {
    let mut numbers = Numbers(11);
    // 1 cm … 16 km to 1e-15, down to 1e-5 m to 1e-12.
    let scales = [("0.01", "15"), ("1", "15"), ("30", "15"), ("500", "15"), ("16000", "15"), ("0.00001", "12")];
    for (size, digits) in scales {
        let part = ratio(1, BigInt::from(10).pow(digits.parse().expect("digits")));
        let size = metres(size).to_bits();
        for round in 0..300 {
            let shape = match round % 8 {
                0 => Shape::Circle { radius: Length::from_bits(numbers.within(size / 10, size)) },
                1 => {
                    let [width, height] = [(); 2].map(|()| Length::from_bits(numbers.within(size / 10, size)));
                    Shape::Box { width, height }
                }
                _ => numbers.polygon(size),
            };
            // Up to 2^30 kg per square of the size, as far as densities go.
            let lift = (round % 31 + 64 - 2 * i64::from(size.ilog2())).clamp(-28, 39);
            let density = Density::from_bits((i128::from(numbers.next() | 1 << 63) << 39) >> (39 - lift));
            let def = ColliderDef { density, ..ColliderDef::new(shape) };
            check(&[def], &part);
        }
    }
}

#[test]
fn needles_and_slivers_have_their_moments() {
    let part = ratio(1, 1_000_000_000_000_i64);
    for shape in [
        polygon("0 0, 1000 0, 1000 1"),
        polygon("-16000 0, 16000 0, 0 0.000002"),
        polygon("1000 1000, 0 0, 1000 1000.00001"),
        rectangle("16000", "0.000001"),
        rectangle("0.000001", "0.000001"),
        circle("0.000001"),
    ] {
        check(&[of(shape, "1000000")], &part);
    }
}

#[test]
fn bodies_of_several_colliders_are_weighted_by_mass() {
    // Two unit squares, one of three times the mass: centre at ¾ of the way; 4/6 and 1·3/4·16.
    let at = |x: &str, density: &str| {
        let def = of(rectangle("1", "1"), density);
        ColliderDef { offset: Vec2::new(metres(x), Length::ZERO), ..def }
    };
    let found = MassData::of(&[at("-2", "1"), at("2", "3")]);
    assert_eq!((found.mass, found.center), (4 << 64, Vec2::new(metres("1"), Length::ZERO)));
    assert_eq!(told(found.inertia, 12), "12.666666666667");
    let part = ratio(1, 1_000_000_000_000_000_i64);
    let mut numbers = Numbers(12);
    for round in 0..200 {
        let size = metres(["0.01", "1", "500"][round % 3]).to_bits();
        let defs: Vec<_> = (0..=round % 5)
            .map(|_| ColliderDef {
                offset: Vec2::new(
                    Length::from_bits(numbers.within(-2 * size, 2 * size)),
                    Length::from_bits(numbers.within(-2 * size, 2 * size)),
                ),
                angle: numbers.angle(),
                density: Density::from_bits(i128::from(numbers.next()) + (1 << 64)),
                sensor: numbers.next() % 8 == 0,
                ..ColliderDef::new(numbers.polygon(size))
            })
            .collect();
        if defs.iter().any(|def| !def.sensor) {
            check(&defs, &part);
        }
        // In any order the same bits.
        let forwards = MassData::of(&defs);
        assert_eq!(MassData::of(&defs.into_iter().rev().collect::<Vec<_>>()), forwards);
    }
}

#[test]
fn half_a_turn_negates_the_centre_and_nothing_else() {
    let mut numbers = Numbers(13);
    for _ in 0..200 {
        let size = 1 << numbers.within(28, 42);
        let [shape, other] = [(); 2].map(|()| numbers.polygon(size));
        let [angle, tilt] = [(); 2].map(|()| numbers.angle());
        let [x, y] = [(); 2].map(|()| numbers.within(-size, size));
        let body = |half: bool| {
            let sign = if half { -1 } else { 1 };
            let turn = |angle: Angle| Angle::from_bits(angle.to_bits() + (i64::from(half) << 47));
            let first = ColliderDef { angle: turn(angle), ..ColliderDef::new(shape.clone()) };
            let offset = Vec2::new(Length::from_bits(sign * x), Length::from_bits(sign * y));
            [first, ColliderDef { angle: turn(tilt), offset, ..ColliderDef::new(other.clone()) }]
        };
        let [straight, turned] = [false, true].map(|half| MassData::of(&body(half)));
        let center =
            Vec2::new(Length::from_bits(-straight.center.x.to_bits()), Length::from_bits(-straight.center.y.to_bits()));
        assert_eq!(turned, MassData { center, ..straight });
    }
}

#[test]
fn a_turn_moves_the_centre_and_keeps_the_inertia() {
    let quarter = Angle::from_bits(1 << 46);
    let def = of(polygon("0 0, 6 0, 0 3"), "1");
    let straight = MassData::of(std::slice::from_ref(&def));
    let turned = MassData::of(&[ColliderDef { angle: quarter, ..def }]);
    assert_eq!(straight.center, Vec2::new(metres("2"), metres("1")));
    assert_eq!(turned, MassData { center: Vec2::new(metres("-1"), metres("2")), ..straight });
}

#[test]
fn clockwise_vertices_have_the_same_moments() {
    let [one, other] = [polygon("3 1, 7 2, 6 5, 4 6"), polygon("3 1, 4 6, 6 5, 7 2")];
    assert_eq!(MassData::of(&[of(one, "2")]), MassData::of(&[of(other, "2")]));
}

#[test]
fn sensors_and_nothing_have_no_mass() {
    assert_eq!(MassData::of(&[]), MassData::default());
    let sensor = ColliderDef { sensor: true, ..of(circle("5"), "9") };
    assert_eq!(MassData::of(std::slice::from_ref(&sensor)), MassData::default());
    let disc = || of(circle("1"), "1");
    assert_eq!(MassData::of(&[sensor, disc()]), MassData::of(&[disc()]));
}

#[test]
fn inertia_about_another_point_adds_mass_times_distance_squared() {
    let found =
        MassData::of(&[ColliderDef { offset: Vec2::new(metres("10"), metres("-5")), ..of(rectangle("2", "3"), "1") }]);
    let about = |x: &str, y: &str| found.about(Vec2::new(metres(x), metres(y)));
    assert_eq!(about("10", "-5"), found.inertia);
    assert_eq!(about("13", "-1") - found.inertia, (6 * 25) << 64);
    assert_eq!(about("7", "-9"), about("13", "-1"));
}

#[test]
fn what_is_too_heavy_saturates() {
    let heavy = MassData::of(&[of(rectangle("16000", "16000"), "1000000000000"), of(circle("16000"), "1000000000000")]);
    assert_eq!((heavy.mass, heavy.inertia), (i128::MAX, i128::MAX));
    assert_eq!(heavy.about(Vec2::new(Length::from_bits(i64::MAX), Length::from_bits(i64::MIN))), i128::MAX);
    // Less than a unit of mass is none.
    assert_eq!(MassData::of(&[of(circle("0.000001"), "0.000000001")]), MassData::default());
}
