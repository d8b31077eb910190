#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]
//! Outlines and surfaces, against exact integers.

use super::tests::{Numbers, circle, metres, outline, polygon, rectangle};
use super::{Outline, Placed, Shape};
use crate::geom::{Rot, Vec2};
use crate::num::{Angle, Friction, Length, Quantity, Restitution, dot, hypot};
use num_bigint::BigInt;

#[test]
fn an_outline_without_a_turn_is_exact() {
    const ONE: i32 = 1 << 30;
    let m = |x: i64| x << 31;
    let shift = |shape: &Shape| {
        let [offset, center] = [("10", "20"), ("0.5", "-1")].map(|(x, y)| Vec2::new(metres(x), metres(y)));
        shape.outline(offset, Angle::ZERO, center)
    };
    let of_box = shift(&rectangle("3", "2"));
    // Half metres: the box about (9.5, 21).
    assert_eq!(of_box.vertices[..4], [[m(16), m(40)], [m(22), m(40)], [m(22), m(44)], [m(16), m(44)]]);
    assert_eq!(of_box.normals[..4], [[0, -ONE], [ONE, 0], [0, ONE], [-ONE, 0]]);
    assert_eq!((of_box.count, of_box.radius), (4, 0));
    let of_circle = shift(&circle("3"));
    assert_eq!((of_circle.count, of_circle.vertices[0], of_circle.radius), (1, [m(19), m(42)], m(6)));
    assert_eq!(of_circle.normals, [[0; 2]; 8]);
    // 3-4-5.
    let of_polygon = shift(&polygon("0 0, 4 0, 0 3"));
    assert_eq!(of_polygon.vertices[..3], [[m(19), m(42)], [m(27), m(42)], [m(19), m(48)]]);
    assert_eq!(of_polygon.normals[..3], [[0, -ONE], [644_245_094, 858_993_459], [-ONE, 0]]);
    // Half of an odd width is rounded once, and alike on both sides.
    let odd = Shape::Box { width: Length::from_bits(10_001), height: Length::from_bits(10_000) };
    assert_eq!(outline(&odd).vertices[..2], [[-5001, -5000], [5001, -5000]]);
}

#[test]
fn quarter_turns_of_a_collider_are_exact() {
    let form = polygon("0 0, 4 1, 1 3");
    let straight = outline(&form);
    for quarters in -4..=4_i64 {
        let turned = form.outline(Vec2::default(), Angle::from_bits(quarters << 46), Vec2::default());
        let (cos, sin) = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarters.rem_euclid(4) as usize];
        for at in 0..3 {
            let [x, y] = straight.vertices[at];
            assert_eq!(turned.vertices[at], [x * cos - y * sin, x * sin + y * cos]);
            let [x, y] = straight.normals[at].map(i64::from);
            assert_eq!(turned.normals[at].map(i64::from), [x * cos - y * sin, x * sin + y * cos]);
        }
        assert_eq!(turned.reach, straight.reach);
    }
}

#[test]
fn normals_are_unit_vectors_to_nearest() {
    let mut numbers = Numbers(3);
    for round in 0..2000 {
        let shape = numbers.polygon(1 << (14 + round % 32));
        let Outline { count, vertices, normals, .. } = outline(&shape);
        for at in 0..count as usize {
            let [next, here] = [vertices[(at + 1) % count as usize], vertices[at]];
            let edge = [next[0] - here[0], next[1] - here[1]].map(BigInt::from);
            let square = &edge[0] * &edge[0] + &edge[1] * &edge[1];
            for (normal, side) in normals[at].into_iter().zip([edge[1].clone(), -&edge[0]]) {
                // |side|·2^50/|edge|, floored.
                let exact: BigInt = (((&side * &side) << 100_u32) / &square).sqrt();
                assert!(normal == 0 || (normal < 0) == (side < BigInt::from(0)));
                let error: BigInt = (BigInt::from(normal.unsigned_abs()) << 20_u32) - exact;
                // Half a unit, and two of 2^-20 of one: the floor's and the length's.
                assert!(error.magnitude() <= BigInt::from((1 << 19) + 2).magnitude(), "{shape:?}: {error}");
            }
        }
    }
}

#[test]
fn a_placed_outline_stays_within_its_box_and_its_reach() {
    let mut numbers = Numbers(4);
    for round in 0..20_000 {
        let shape = match round % 4 {
            0 => circle("1.5"),
            1 => rectangle("0.25", "4"),
            _ => numbers.polygon(1 << (14 + round % 31)),
        };
        let far = 8 << (round % 41);
        let [offset, center] = [(); 2].map(|()| {
            let [x, y] = [(); 2].map(|()| Length::from_bits(numbers.within(-far, far)));
            Vec2::new(x, y)
        });
        let outline = shape.outline(offset, numbers.angle(), center);
        let rot = Rot::new(numbers.angle());
        let placed = Placed::new(&outline, rot);
        let count = outline.count as usize;
        let (cos, sin) = (i64::from(rot.cos), i64::from(rot.sin));
        let turn = |v: [i64; 2]| [dot(v, [cos, -sin], 30), dot(v, [sin, cos], 30)];
        for at in 0..count {
            assert_eq!(placed.vertices[at], turn(outline.vertices[at]));
            let normal = turn(outline.normals[at].map(i64::from));
            assert_eq!(placed.normals[at].map(i64::from), normal.map(|n| n.clamp(-(1 << 30), 1 << 30)));
            if count > 1 {
                let [x, y] = normal;
                // Two turns of 2^-30 each.
                assert!((hypot(x, y) as i64 - (1 << 30)).abs() <= 3, "{normal:?}");
            }
        }
        for axis in 0..2 {
            let along: Vec<_> = placed.vertices[..count].iter().map(|v| v[axis]).collect();
            assert_eq!(placed.min[axis], along.iter().min().expect("a vertex") - outline.radius);
            assert_eq!(placed.max[axis], along.iter().max().expect("a vertex") + outline.radius);
            assert!(placed.min[axis] >= -outline.reach && placed.max[axis] <= outline.reach);
        }
        let distance = |vertices: &[[i64; 2]; 8]| {
            let squares = vertices[..count].iter().map(|v| {
                let [x, y] = v.map(i128::from);
                (x * x + y * y) as u128
            });
            squares.max().expect("a vertex")
        };
        let inner = (outline.reach - outline.radius) as u128;
        assert!(distance(&placed.vertices) <= inner * inner, "the turned outline is within its reach");
        // Not much more than it needs: 2^-29 of it and three units.
        let least = inner.saturating_sub((inner >> 29) + 3);
        assert!(distance(&outline.vertices) >= least * least, "the reach is no farther than it must be");
        let half = Placed::new(&outline, Rot { cos: -rot.cos, sin: -rot.sin });
        for at in 0..count {
            assert_eq!(half.vertices[at], placed.vertices[at].map(|c| -c));
            assert_eq!(half.normals[at], placed.normals[at].map(|c| -c));
        }
    }
    assert_eq!(outline(&circle("1.5")).reach, 3 << 31);
}

#[test]
fn ties_of_a_turn_go_away_from_zero() {
    let outline = Outline { count: 1, vertices: [[1, -1]; 8], ..Outline::default() };
    let placed = Placed::new(&outline, Rot { cos: 1 << 29, sin: 0 });
    assert_eq!(placed.vertices[0], [1, -1]);
    // Beyond what is accepted nothing wraps.
    let outline = Outline { count: 1, vertices: [[i64::MAX, i64::MIN]; 8], ..Outline::default() };
    let placed = Placed::new(&outline, Rot { cos: 1 << 30, sin: 1 << 30 });
    assert_eq!(placed.vertices[0], [i64::MAX, -1]);
}

#[test]
fn surfaces_combine_by_the_larger_restitution_and_the_mean_friction() {
    let [r, s] = [Restitution::from_bits(3 << 40), Restitution::MAX];
    assert_eq!([r.combine(s), s.combine(r), r.combine(r), Restitution::ZERO.combine(r)], [s, s, r, r]);
    let f = |text: &str| text.parse::<Friction>().expect(text);
    assert_eq!(f("0.25").combine(f("0.64")), f("0.4"));
    assert_eq!(f("100").combine(Friction::ZERO), Friction::ZERO);
    let mut numbers = Numbers(5);
    for round in 0..20_000 {
        let limit = Friction::MAX.to_bits() >> (round % 54);
        let [a, b] = [(); 2].map(|()| numbers.within(0, limit));
        let [x, y] = [a, b].map(Friction::from_bits);
        assert_eq!(x.combine(x), x);
        assert_eq!(x.combine(y), y.combine(x));
        // Between root − ½ and root + ½: squares of the doubles.
        let root = i128::from(x.combine(y).to_bits());
        let four = 4 * i128::from(a) * i128::from(b);
        let lower = (2 * root - 1).max(0);
        assert!(lower * lower <= four && four <= (2 * root + 1) * (2 * root + 1), "{a} {b}");
    }
    assert_eq!(Friction::MAX.combine(Friction::MAX), Friction::MAX);
}
