//! The shapes and positions that go wrong, each with the manifold it must have.

use super::*;
use crate::narrow::overlap;

const LIMIT: i64 = M / 50;
const UP: [i32; 2] = [0, ONE];
const DOWN: [i32; 2] = [0, -ONE];

fn check(a: &Placed, b: &Placed, d: [i64; 2], normal: [i32; 2], expected: &[([i64; 2], i64, u8)]) {
    let manifold = collide(a, b, d, LIMIT);
    assert_eq!(points(&manifold), expected);
    assert_eq!(manifold.normal, normal);
    let touching = expected.iter().any(|point| point.1 <= 0);
    assert_eq!((overlap(a, b, d), overlap(b, a, negated(d))), (touching, touching));
}

#[test]
fn a_vertex_on_an_edge() {
    let (a, b) = (rectangle(M, M, 0), polygon(&[[0, 0], [M, M], [-M, M]]));
    for gap in [-7, 0, 7] {
        // Of the two edges at the vertex that face alike, the one that starts there.
        let arm = [0, M / 2 + gap - mul(ONE.into(), gap, 31)];
        check(&a, &b, [0, M / 2 + gap], DOWN, &[(arm, gap, id(2, 0, 1))]);
    }
}

#[test]
fn a_vertex_on_a_vertex() {
    let (a, b) = (rectangle(M, M, 0), rectangle(M, M, 0));
    let corner = [M / 2, M / 2];
    // Both axes are as good: the lower edge of a, its right one.
    check(&a, &b, [M, M], [-ONE, 0], &[(corner, 0, id(1, 3, 0))]);
    check(&a, &b, [M, M + 1], DOWN, &[([M / 2, M / 2], 1, id(2, 0, 1))]);
    // Apart from corner to corner: no edge faces another.
    check(&a, &b, [M + 1, M + 1], [0, 0], &[]);
    let deep = [([M / 2, M / 2 - 2], -2, id(1, 3, 0)), ([M / 2, M / 2], -2, id(1, 3, 1))];
    let [low, high] = deep.map(|(arm, separation, id)| ([arm[0] - 1, arm[1]], separation, id));
    check(&a, &b, [M - 2, M - 2], [-ONE, 0], &[low, high]);
}

#[test]
fn the_same_outline_in_the_same_place() {
    let a = rectangle(M, M, 0);
    let arms = [[-M / 2, 0], [M / 2, 0]];
    check(&a, &a, [0, 0], UP, &[(arms[0], -M, id(0, 2, 0)), (arms[1], -M, id(0, 2, 1))]);
    for seed in 0..200 {
        let a = Noise(seed).outline(M);
        let manifold = collide(&a, &a, [0, 0], LIMIT);
        let deepest = points(&manifold).iter().map(|point| point.1).min();
        assert!(deepest < Some(0) && overlap(&a, &a, [0, 0]));
    }
}

#[test]
fn touching_by_rounding_alone() {
    // Corner beside corner: nothing is over the best edge, and its separation is rounded to 0. Found among 2e7 triangles.
    let large = |corners: [[i64; 2]; 3]| polygon(&corners.map(|v| v.map(|c| c << 22)));
    for (a, b, d) in [
        ([[-95, -28], [142, -58], [-122, 39]], [[-93, 2], [246, -6], [14, 63]], [-29, 37]),
        ([[4, 35], [-8, 60], [-5, -35]], [[427, -53], [99, 29], [-336, 6]], [-176, -46]),
        ([[-5, 43], [-8, -50], [4, -23]], [[-360, 32], [303, -48], [6, 44]], [-14, -94]),
    ] {
        let manifold = collide(&large(a), &large(b), d.map(|c| c << 22), 0);
        assert_eq!((manifold.count, manifold.points[0].separation), (1, 0));
    }
}

#[test]
fn one_inside_the_other() {
    let (a, b) = (rectangle(4 * M, 4 * M, 0), rectangle(M / 8, M / 8, 0));
    let depth = -2 * M - M / 16;
    let arm = |x: i64| [x, M / 16 + depth / 2];
    check(&a, &b, [0, 0], UP, &[(arm(-M / 16), depth, id(0, 2, 0)), (arm(M / 16), depth, id(0, 2, 1))]);
    // Nearer to the right side.
    let depth = -M - M / 16;
    let arm = |y: i64| [M - M / 16 - depth / 2, y];
    check(&a, &b, [M, 0], [-ONE, 0], &[(arm(-M / 16), depth, id(1, 3, 0)), (arm(M / 16), depth, id(1, 3, 1))]);
}

#[test]
fn of_equal_axes_the_first() {
    // As deep in each side of the box, but the middle of its first side is nearest to the box's left side.
    let b = polygon(&[[-M / 8, M / 4], [-M / 4, -M / 4], [M / 4, -M / 8]]);
    assert_eq!((b.min, b.max), ([-M / 4; 2], [M / 4; 2]));
    let manifold = collide(&rectangle(M, M, 0), &b, [0, 0], LIMIT);
    assert_eq!((manifold.normal, manifold.points[0].separation), (UP, -3 * (M / 4)));
}

#[test]
fn crossed_needles() {
    let (a, b) = (rectangle(M, M / 1024, 0), rectangle(M, M / 1024, 1 << 46));
    let depth = -M / 2 - M / 2048;
    let arm = |x: i64| [x, M / 2 + depth / 2];
    check(&a, &b, [0, 0], UP, &[(arm(-M / 2048), depth, id(0, 1, 0)), (arm(M / 2048), depth, id(0, 1, 1))]);
}

#[test]
fn the_tip_of_a_needle() {
    let a = rectangle(M, M, 0);
    let b = polygon(&[[0, 0], [M / 2048, M], [-M / 2048, M]]);
    check(&a, &b, [M / 4, M / 2 - 8], DOWN, &[([M / 4, M / 2 - 4], -8, id(2, 0, 1))]);
    // 16 km high and 2e-6 m wide, leaning by less than normals can say: both sides have level normals, and the one that
    // starts at the tip leans over it.
    let b = polygon(&[[0, 0], [-300, 16_000 * M], [-9000, 16_000 * M]]);
    assert_eq!(b.normals[0], [ONE, 0]);
    check(&a, &b, [M / 4, M / 2 - 8], DOWN, &[([M / 4, M / 2 - 4], -8, id(2, 0, 1))]);
}

#[test]
fn a_sliver_on_either_side() {
    let a = rectangle(8 * M, M, 0);
    let flat = polygon(&[[-M, 0], [M, 0], [0, 4295]]);
    let y = M / 2;
    check(&a, &flat, [0, y], DOWN, &[([M, y], 0, id(2, 0, 0)), ([-M, y], 0, id(2, 0, 1))]);
    // On its blunt vertex: of two edges that face alike the one that starts there, with its far end 1e-6 m up.
    let blunt = polygon(&[[0, 0], [M, 4295], [-M, 4295]]);
    check(&a, &blunt, [0, y], DOWN, &[([M, y + 2147], 4295, id(2, 0, 0)), ([0, y], 0, id(2, 0, 1))]);
}

#[test]
fn a_flat_side_with_a_vertex_in_it() {
    // The vertex stands out by one unit: both edges have the same normal, and rounding says which is farther out.
    for bump in [-1, 1] {
        let top = [[2 * M, 0], [0, bump], [-2 * M, 0]];
        let a = polygon(&[[-2 * M, -M], [2 * M, -M], top[0], [0, 1], top[2]]);
        let mut a = Placed { vertices: a.vertices, ..a };
        a.vertices[3] = top[1];
        let b = rectangle(M / 2, M / 2, 0);
        for (x, edge) in [(M, 2), (-M, 3)] {
            for gap in -2..3 {
                let d = [x, M / 4 + gap];
                let manifold = collide(&a, &b, d, LIMIT);
                let mirror = collide(&b, &a, negated(d), LIMIT);
                assert_eq!((manifold.normal, manifold.count), (DOWN, 2));
                assert_eq!((mirror.normal, mirror.count), (UP, 2));
                for (at, point) in [M / 4, -M / 4].into_iter().zip(&manifold.points) {
                    assert!((point.separation - gap).abs() <= 2, "{} {gap}", point.separation);
                    assert!(point.arm[0] == x + at && point.arm[1].abs() <= 2);
                    assert_eq!(point.id & !1, id(edge, 0, 0));
                }
            }
        }
    }
}

#[test]
fn a_centimetre_on_half_a_kilometre() {
    let (a, b) = (rectangle(500 * M, 500 * M, 0), rectangle(M / 128, M / 128, 0));
    let (x, y) = (200 * M, 250 * M);
    let half = M / 256;
    let points = [([x + half, y], 0, id(2, 0, 0)), ([x - half, y], 0, id(2, 0, 1))];
    check(&a, &b, [x, y + half], DOWN, &points);
    // A thousandth of a radian askew: still on its own corner, and in its own size.
    let tilted = rectangle(M / 128, M / 128, 44_798_133_866);
    let corner = tilted.vertices[0];
    let manifold = collide(&a, &tilted, [x, y - corner[1]], LIMIT);
    assert_eq!((manifold.count, manifold.points[1].separation), (2, 0));
    assert_eq!(manifold.points[1].arm, [x + corner[0], y]);
    assert!((manifold.points[0].separation - M / 128_000).abs() < 32);
}

#[test]
fn a_circle_at_a_corner() {
    let (a, b) = (rectangle(M, M, 0), circle([0, 0], M / 4));
    let corner = M / 2;
    // On the vertex the two faces are as near: the lower one. Then the faces, then the corner between them.
    check(&a, &b, [corner, corner], [-ONE, 0], &[([M / 4 + M / 8, corner], -M / 4, 0)]);
    check(&a, &b, [corner + 8, corner], [-ONE, 0], &[([corner - M / 8 + 4, corner], 8 - M / 4, 0)]);
    check(&a, &b, [corner, corner + 8], DOWN, &[([corner, corner - M / 8 + 4], 8 - M / 4, 0)]);
    let manifold = collide(&a, &b, [corner + 3, corner + 4], LIMIT);
    assert_eq!((manifold.normal, manifold.points[0].separation), ([-644_245_094, -858_993_459], 5 - M / 4));
    // 3, 4, 5 to scale: touching, and 2⁻³² m more or less.
    let unit = M / 20;
    for (gap, touches) in [(-1, true), (0, true), (1, false)] {
        let b = circle([0, 0], 5 * unit - gap);
        let d = [corner + 3 * unit, corner + 4 * unit];
        assert_eq!(collide(&a, &b, d, LIMIT).points[0].separation, gap);
        assert_eq!((overlap(&a, &b, d), overlap(&b, &a, negated(d))), (touches, touches));
    }
}

#[test]
fn a_circle_on_a_face() {
    let (a, b) = (rectangle(M, M, 0), circle([0, 0], M / 4));
    for gap in [-4, 0, 4] {
        check(&a, &b, [9, 3 * (M / 4) + gap], DOWN, &[([9, M / 2 + gap / 2], gap, 0)]);
    }
}

#[test]
fn a_circle_inside_a_box() {
    let (a, b) = (rectangle(M, M, 0), circle([0, 0], M / 4));
    // From the face at −1/2 to the far side of the circle at 1/4: half-way is −1/8.
    check(&a, &b, [0, 0], UP, &[([0, -M / 8], -3 * (M / 4), 0)]);
    check(&a, &b, [M / 8, 0], [-ONE, 0], &[([M / 8 + M / 16, 0], -(M / 2 + M / 8), 0)]);
    // The box's view and the circle's are one.
    check(&b, &a, [-M / 8, 0], [ONE, 0], &[([M / 16, 0], -(M / 2 + M / 8), 0)]);
}

#[test]
fn a_circle_over_the_second_half_of_a_flat_side() {
    let a = polygon(&[[-2 * M, -M], [2 * M, -M], [2 * M, 0], [0, 1], [-2 * M, 0]]);
    let b = circle([0, 0], M / 4);
    for x in [M, -M] {
        let manifold = collide(&a, &b, [x, M / 4], LIMIT);
        assert_eq!((manifold.normal, manifold.points[0].arm[0]), (DOWN, x));
        assert!(manifold.points[0].separation.abs() <= 1);
    }
}

#[test]
fn two_circles() {
    // Centres 3, 4, 5 apart: from (1, 0) twice (0.6, 0.8) and half the gap.
    let (a, b) = (circle([M, 0], 2 * M), circle([0, 0], 3 * M));
    for gap in [-10, 0, 10] {
        let d = [4 * M + gap / 5 * 3, 4 * M + gap / 5 * 4];
        let manifold = collide(&a, &b, d, LIMIT);
        let [point, _] = manifold.points;
        assert_eq!((manifold.normal, manifold.count), ([-644_245_094, -858_993_459], 1));
        assert_eq!((point.separation, overlap(&a, &b, d)), (gap, gap <= 0));
        let middle = [M + M / 5 * 6 + gap / 10 * 3, M / 5 * 8 + gap / 10 * 4];
        assert!((0..2).all(|axis| (point.arm[axis] - middle[axis]).abs() <= 4), "{point:?} {middle:?}");
    }
}

#[test]
fn circles_with_one_centre() {
    let (a, b) = (circle([M, M], 2 * M), circle([0, 0], M));
    check(&a, &b, [M, M], UP, &[([M, M / 2], -3 * M, 0)]);
    check(&b, &a, [-M, -M], UP, &[([0, M / 2], -3 * M, 0)]);
    // What half a turn does not turn.
    check(&opposite(&a), &opposite(&b), [-M, -M], UP, &[([-M, -M - M / 2], -3 * M, 0)]);
}

#[test]
fn the_largest_and_farthest_stay_defined() {
    let mut noise = Noise(21);
    let far = (1 << 50) - 1;
    for _ in 0..3000 {
        let size = 1 << noise.within(12, 47);
        let (a, b) = (noise.outline(1 << 47), noise.outline(size));
        let reach = if noise.within(0, 1) == 0 { far } else { 1 << 48 };
        let d = [noise.within(-reach, reach), noise.within(-reach, reach)];
        let limit = noise.within(0, 1 << 48);
        let manifold = collide(&a, &b, d, limit);
        for point in &manifold.points[..manifold.count.into()] {
            assert!(point.separation <= limit && point.arm.iter().all(|c| c.abs() < 1 << 51));
        }
        if manifold.count > 0 {
            let [x, y] = manifold.normal.map(i128::from);
            assert!(((x * x + y * y) - (1 << 60)).abs() < 1 << 32);
        }
        assert!(!overlap(&a, &b, d) || manifold.count > 0);
    }
}
