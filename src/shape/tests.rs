#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]
//! What is accepted, and the stored order.

use super::hull::cross;
use super::{ColliderDef, Outline, Shape, ShapeError};
use crate::geom::Vec2;
use crate::num::{Angle, Density, Friction, Length, Quantity, Restitution};

/// Splitmix64: the tests' numbers, the same in every run.
pub(super) struct Numbers(pub(super) u64);

impl Numbers {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn within(&mut self, low: i64, high: i64) -> i64 {
        low + (self.next() % (high - low + 1) as u64) as i64
    }

    pub(super) fn angle(&mut self) -> Angle {
        Angle::from_bits(self.within(-(1 << 50), 1 << 50))
    }

    /// A convex polygon of 3 to 8 vertices with coordinates within ±`size`.
    pub(super) fn polygon(&mut self, size: i64) -> Shape {
        loop {
            let points: Vec<_> = (0..12).map(|_| [self.within(-size, size), self.within(-size, size)]).collect();
            let mut hull = hull(points);
            hull.truncate(self.within(3, 8) as usize);
            let start = self.next() as usize % hull.len();
            hull.rotate_left(start);
            let shape = of(&hull);
            if ColliderDef::new(shape.clone()).check().is_ok() {
                return shape;
            }
        }
    }
}

/// The strict hull, counter-clockwise from the lowest of the leftmost points.
fn hull(mut points: Vec<[i64; 2]>) -> Vec<[i64; 2]> {
    points.sort();
    points.dedup();
    let half = |points: &[[i64; 2]]| {
        let mut chain: Vec<[i64; 2]> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..] {
                if cross([b[0] - a[0], b[1] - a[1]], [p[0] - b[0], p[1] - b[1]]) > 0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&points);
    points.reverse();
    lower.extend(half(&points));
    lower
}

/// The polygon of these vertices, in bits.
pub(super) fn of(points: &[[i64; 2]]) -> Shape {
    let vertices = points.iter().map(|&[x, y]| Vec2::new(Length::from_bits(x), Length::from_bits(y))).collect();
    Shape::Polygon { vertices }
}

pub(super) fn metres(text: &str) -> Length {
    text.parse().expect(text)
}

/// The polygon of these metres: `"0 0, 1 0, 0 1"`.
pub(super) fn polygon(text: &str) -> Shape {
    let vertices = text.split(',').map(|pair| {
        let (x, y) = pair.trim().split_once(' ').expect(pair);
        Vec2::new(metres(x), metres(y))
    });
    Shape::Polygon { vertices: vertices.collect() }
}

pub(super) fn rectangle(width: &str, height: &str) -> Shape {
    Shape::Box { width: metres(width), height: metres(height) }
}

pub(super) fn circle(radius: &str) -> Shape {
    Shape::Circle { radius: metres(radius) }
}

fn refusal(def: &ColliderDef) -> String {
    def.check().map_or_else(|error| error.to_string(), |()| "accepted".to_owned())
}

pub(super) fn outline(shape: &Shape) -> Outline {
    shape.outline(Vec2::default(), Angle::ZERO, Vec2::default())
}

#[test]
fn forms_are_accepted_or_refused_by_name_and_limit() {
    let nine = "4 0, 3 2, 2 3, 0 4, -2 3, -3 2, -4 0, -2 -3, 2 -3";
    let cases = [
        (circle("0.000001"), "accepted"),
        (circle("16000"), "accepted"),
        (circle("0"), "radius 0 m is outside 0.000001 … 16000 m"),
        (circle("-1"), "radius -1 m is outside 0.000001 … 16000 m"),
        (circle("16000.5"), "radius 16000.5 m is outside 0.000001 … 16000 m"),
        (rectangle("0.000001", "16000"), "accepted"),
        (rectangle("16000", "16000"), "accepted"),
        (rectangle("0", "1"), "width 0 m is outside 0.000001 … 16000 m"),
        (rectangle("1", "-0.5"), "height -0.5 m is outside 0.000001 … 16000 m"),
        (rectangle("1000000000", "1"), "width 1000000000 m is outside 0.000001 … 16000 m"),
        (polygon("0 0, 10 10, 10 0"), "accepted"),
        (polygon("0 0, 10 0, 10 10"), "accepted"),
        // Needles, and thin to the limit.
        (polygon("0 0, 1000 0, 1000 1"), "accepted"),
        (polygon("-8000 0, 8000 0, 0 0.000002"), "accepted"),
        (polygon("0 0, 0.000001 0, 0.000001 0.000001, 0 0.000001"), "accepted"),
        (polygon("-16000 0, 16000 0, 0 0.000001"), "accepted"),
        (
            polygon("-16000 0, 16000 0, 0 0.0000005"),
            "the polygon is thinner than 0.000001 m across the edge from vertex 0",
        ),
        (
            polygon("0 0, 1000 1000, 2000 2000.0000005"),
            "the polygon is thinner than 0.000001 m across the edge from vertex 0",
        ),
        (polygon("0 0, 1 0, 1 0.9999995, 0.9999998 1, 0 1"), "the edge from vertex 2 is shorter than 0.000001 m"),
        (polygon("0 0, 1 0"), "2 vertices are outside 3 … 8"),
        (Shape::Polygon { vertices: Vec::new() }, "0 vertices are outside 3 … 8"),
        (polygon(nine), "9 vertices are outside 3 … 8"),
        (polygon("0 0, 1 0, 16000.25 1"), "coordinate 16000.25 m is outside ±16000 m"),
        (polygon("0 0, 1 -1000000000, 16000 1"), "coordinate -1000000000 m is outside ±16000 m"),
        (polygon("0 0, 1 0, 0 0"), "vertex 2 is where another vertex is"),
        (polygon("0 0, 1 0, 1 0, 1 1"), "vertex 2 is where another vertex is"),
        (polygon("0 0, 1 0, 1 1, 0 1, 1 0"), "vertex 4 is where another vertex is"),
        (polygon("0 0, 1 0, 2 0"), "vertex 0 is on the line through its neighbours"),
        (polygon("0 0, 1 0, 2 0, 2 2"), "vertex 1 is on the line through its neighbours"),
        (polygon("1 0, 2 2, 0 2, 0.5 1"), "vertex 3 is on the line through its neighbours"),
        // A spike: the way back is collinear too.
        (polygon("0 0, 3 0, 1 0, 1 1"), "vertex 1 is on the line through its neighbours"),
        (polygon("0 0, 2 0, 1 0.5, 1 2"), "the polygon is not convex at vertex 2"),
        (polygon("1 0.5, 1 2, 0 0, 2 0"), "the polygon is not convex at vertex 0"),
        (polygon("0 0, 1 2, 1 0.5, 2 0"), "the polygon is not convex at vertex 2"),
        // Figures of eight, one of them without area.
        (polygon("0 0, 1 1, 1 0, 0 1"), "the polygon is not convex at vertex 1"),
        (polygon("0 0, 2 2, 2 0, 0 1"), "the polygon is not convex at vertex 0"),
        // A pentagram turns the right way everywhere, and round twice.
        (polygon("0 3, -2 -3, 3 1, -3 1, 2 -3"), "the polygon is not convex at vertex 3"),
        (polygon("2 -3, -3 1, 3 1, -2 -3, 0 3"), "the polygon is not convex at vertex 3"),
    ];
    for (shape, told) in cases {
        assert_eq!(refusal(&ColliderDef::new(shape.clone())), told, "{shape:?}");
    }
}

#[test]
fn a_collider_is_refused_for_any_of_its_values() {
    type Change = fn(&mut ColliderDef);
    let cases: [(Change, &str); 12] = [
        (|_| {}, "accepted"),
        (|def| def.density = Density::ZERO, "density 0 kg/m² is outside 0.000000001 … 1e12 kg/m²"),
        (|def| def.restitution = Restitution::from_bits(1 << 49), "restitution 2 is outside 0 … 1"),
        (|def| def.friction = Friction::from_bits(-(1 << 48)), "friction -1 is outside 0 … 100"),
        (|def| def.angle = Angle::from_bits(i64::MIN), "angle -32768 turns is outside ±(32768 − 2⁻⁴⁸) turns"),
        (|def| def.offset.x = metres("-16000"), "accepted"),
        (|def| def.offset.y = metres("16000.5"), "coordinate 16000.5 m is outside ±16000 m"),
        (|def| def.offset.x = Length::from_bits(i64::MIN), "coordinate -2147483648 m is outside ±16000 m"),
        (|def| def.shape = circle("0"), "radius 0 m is outside 0.000001 … 16000 m"),
        (
            |def| def.offset = Vec2::new(metres("16000"), metres("12000")),
            "the collider reaches 20001.0000372533686459064483642578125 m from its body's origin, farther than 16383 m",
        ),
        (|def| (def.shape, def.offset.x) = (circle("16000"), metres("382.999")), "accepted"),
        (
            |def| (def.shape, def.offset.x) = (circle("16000"), metres("383.25")),
            "the collider reaches 16383.250000714324414730072021484375 m from its body's origin, farther than 16383 m",
        ),
    ];
    for (change, told) in cases {
        let mut def = ColliderDef::new(circle("1"));
        change(&mut def);
        assert_eq!(refusal(&def), told);
    }
    let one_more = Friction::from_bits(Friction::MAX.to_bits() + 1);
    let def = ColliderDef { friction: one_more, ..ColliderDef::new(circle("1")) };
    assert!(matches!(def.check(), Err(ShapeError::Range(error)) if error.value == one_more.decimal()));
}

/// What the strict hull of the vertices says of a polygon.
fn by_hull(points: &[[i64; 2]]) -> &'static str {
    let count = points.len();
    if (1..count).any(|at| points[..at].contains(&points[at])) {
        return "repeated";
    }
    let at = |index: usize| points[index % count];
    let edge = |i: usize| [at(i + 1)[0] - at(i)[0], at(i + 1)[1] - at(i)[1]];
    if (0..count).any(|i| cross(edge(i), edge(i + 1)) == 0) {
        return "collinear";
    }
    let hull = hull(points.to_vec());
    let around = |points: &[[i64; 2]]| {
        let mut points = points.to_vec();
        let start = points.iter().position(|p| *p == hull[0]).unwrap_or(0);
        points.rotate_left(start);
        points == hull
    };
    let backwards: Vec<_> = points.iter().rev().copied().collect();
    if around(points) || around(&backwards) { "convex" } else { "not convex" }
}

#[test]
fn convexity_is_that_of_the_hull() {
    let mut numbers = Numbers(1);
    let octagon = [[4, 1], [4, 2], [2, 4], [1, 4], [-1, 2], [-1, 1], [1, -1], [2, -1]];
    let mut seen = std::collections::BTreeMap::new();
    for round in 0..60_000 {
        let count = numbers.within(3, 8) as usize;
        let mut points: Vec<[i64; 2]> = match round % 3 {
            0 => (0..count).map(|_| [numbers.within(0, 4), numbers.within(0, 4)]).collect(),
            // Of a convex polygon's vertices, every so many round and round: stars.
            1 => (0..count).map(|at| octagon[at * (round / 3 % 7 + 1) % 8]).collect(),
            _ => octagon[..count].to_vec(),
        };
        if round % 3 == 2 && round % 2 == 0 {
            let [a, b] = [(); 2].map(|()| numbers.next() as usize % count);
            points.swap(a, b);
        }
        if numbers.next() % 2 == 0 {
            points.reverse();
        }
        let start = numbers.next() as usize % count;
        points.rotate_left(start);
        let metres: Vec<_> = points.iter().map(|p| p.map(|c| c << 32)).collect();
        let told = match ColliderDef::new(of(&metres)).check() {
            Ok(()) => "convex",
            Err(ShapeError::RepeatedVertex { .. }) => "repeated",
            Err(ShapeError::Collinear { .. }) => "collinear",
            Err(ShapeError::NotConvex { .. }) => "not convex",
            Err(other) => panic!("{other}"),
        };
        assert_eq!(told, by_hull(&points), "{points:?}");
        *seen.entry(told).or_insert(0) += 1;
    }
    assert!(seen.len() == 4 && seen.values().all(|&times| times > 1000), "{seen:?}");
}

#[test]
fn one_unit_decides_exactly() {
    let far = 16_000_i64 << 32;
    // The middle vertex is on the diagonal of the greatest square, and one unit to either side.
    let with = |middle: [i64; 2]| refusal(&ColliderDef::new(of(&[[0, 0], middle, [far / 2, far / 2], [0, far / 2]])));
    assert_eq!(with([far / 4, far / 4]), "vertex 1 is on the line through its neighbours");
    assert_eq!(with([far / 4 + 1, far / 4]), "accepted");
    assert_eq!(with([far / 4, far / 4 + 1]), "the polygon is not convex at vertex 1");
}

#[test]
fn vertices_are_stored_counter_clockwise_from_the_same_one() {
    let clockwise = polygon("0 0, 0 2, 3 2, 3 0");
    assert_eq!(clockwise.canonical(), polygon("0 0, 3 0, 3 2, 0 2"));
    assert_eq!(clockwise.canonical().canonical(), clockwise.canonical());
    assert_eq!(outline(&clockwise), outline(&clockwise.canonical()));
    assert_eq!(circle("2").canonical(), circle("2"));
    assert_eq!(rectangle("2", "3").canonical(), rectangle("2", "3"));
    let mut numbers = Numbers(2);
    for _ in 0..200 {
        let given = numbers.polygon(1 << 34);
        let Shape::Polygon { vertices } = &given else { unreachable!() };
        let mut reversed = vertices.clone();
        reversed[1..].reverse();
        assert_eq!(given.canonical(), given);
        assert_eq!(Shape::Polygon { vertices: reversed }.canonical(), given);
    }
}
