//! Points in outlines, nearest points and rays.

use super::oracle::*;
use super::*;
use crate::narrow::{Hit, closest, contains, ray};
use num_bigint::BigInt;
use num_rational::BigRational;

const WHOLE: i64 = 1 << 62;

/// A point at any distance up to 2 or up to 5·10⁸ m, and about as often inside as out.
fn somewhere(noise: &mut Noise, size: i64) -> [i64; 2] {
    let reach = if noise.within(0, 3) == 0 { size << noise.within(0, 24) } else { size };
    let reach = noise.within(0, reach);
    noise.around(reach)
}

#[test]
fn nearest_points_are_those_of_exact_arithmetic() {
    let mut noise = Noise(41);
    let (mut inside, mut vertices) = (0, 0);
    for _ in 0..3000 {
        let size = noise.within(M / 100, 8 * M);
        let a = noise.outline(size);
        let p = somewhere(&mut noise, 2 * size);
        let (at, distance) = closest(&a, p);
        let (exact, nearest) = if a.count > 1 {
            Exact::new(&a, [0, 0]).distance(&vector(p))
        } else {
            let off = minus(&vector(p), &vector(a.vertices[0]));
            let out = length(&off) - wide(a.radius);
            let on = plus(&vector(a.vertices[0]), &scaled(&off, &wide(a.radius), &length(&off).max(wide(1))));
            if out > BigInt::ZERO { (out, on) } else { (out, vector(p)) }
        };
        if exact <= BigInt::ZERO {
            assert!(contains(&a, p) && (at, distance) == (p, 0));
            inside += 1;
            continue;
        }
        assert!(!contains(&a, p));
        vertices += usize::from(a.count > 1 && a.vertices.contains(&at));
        let half = (wide(1) >> 1) + (wide(1) >> 10);
        assert!(magnitude(&(&exact - wide(distance))) <= half, "{distance} {exact}");
        assert!((0..2).all(|axis| magnitude(&(&nearest[axis] - wide(at[axis]))) <= half), "{at:?} {nearest:?}");
    }
    assert!(inside > 300 && vertices > 300, "{inside} {vertices}");
}

#[test]
fn rays_enter_polygons_where_exact_fractions_say() {
    let mut noise = Noise(42);
    let mut counts = [0; 3];
    for _ in 0..6000 {
        let size = noise.within(M / 100, 8 * M);
        let a = noise.polygon(size);
        let origin = somewhere(&mut noise, 2 * size);
        let target = noise.around(size);
        // Past the target, or not as far.
        let way = noise.within(1, 24);
        let way = [(target[0] - origin[0]) / 16 * way, (target[1] - origin[1]) / 16 * way];
        let hit = ray(&a, origin, way);
        if contains(&a, origin) {
            assert_eq!(hit, Some(Hit::default()));
            counts[0] += 1;
            continue;
        }
        let exact = Exact::new(&a, [0, 0]);
        let (mut enter, mut exit, mut face) =
            (BigRational::from_integer(BigInt::ZERO), BigRational::from_integer(1.into()), None);
        let mut parallel = false;
        for edge in 0..usize::from(a.count) {
            let side = minus(&exact.vertices[exact.next(edge)], &exact.vertices[edge]);
            let left = |v: &Vector| &side[0] * &v[1] - &side[1] * &v[0];
            let (inside, inward) = (left(&minus(&vector(origin), &exact.vertices[edge])), left(&vector(way)));
            if inward == BigInt::ZERO {
                parallel |= inside < BigInt::ZERO;
                continue;
            }
            let at = BigRational::new(-inside, inward.clone());
            if inward < BigInt::ZERO {
                exit = exit.min(at);
            } else if at >= enter && (face.is_none() || at > enter) {
                (enter, face) = (at, Some(edge));
            }
        }
        counts[1 + usize::from(hit.is_some())] += 1;
        let Some(Hit { fraction, normal }) = hit else {
            assert!(parallel || enter > exit);
            continue;
        };
        assert!(!parallel && enter <= exit);
        assert_eq!(Some(normal), face.map(|face| a.normals[face]));
        let off = enter * BigInt::from(WHOLE) - BigInt::from(fraction);
        assert!(BigRational::new(magnitude(off.numer()), off.denom().clone()) <= BigRational::new(1.into(), 2.into()));
    }
    assert!(counts.iter().all(|&count| count > 600), "{counts:?}");
}

#[test]
fn rays_enter_circles_at_their_border() {
    let mut noise = Noise(43);
    let mut counts = [0; 3];
    for _ in 0..6000 {
        let size = noise.within(M / 100, 8 * M);
        let a = noise.circle(size);
        let origin = somewhere(&mut noise, 3 * size);
        let target = noise.around(2 * size);
        let way = noise.within(1, 24);
        let way = [(target[0] - origin[0]) / 16 * way, (target[1] - origin[1]) / 16 * way];
        let from = minus(&vector(origin), &vector(a.vertices[0]));
        let hit = ray(&a, origin, way);
        if contains(&a, origin) {
            assert_eq!(hit, Some(Hit::default()));
            counts[0] += 1;
            continue;
        }
        // 2⁻¹² of a unit, and 2⁻⁶⁰ of the way.
        let allowed = (wide(1) >> 12) + ((length(&from) + length(&vector(way))) >> 60);
        let radius = wide(a.radius);
        counts[1 + usize::from(hit.is_some())] += 1;
        let (long, along) = (inner(&vector(way), &vector(way)), inner(&from, &vector(way)));
        let Some(Hit { fraction, normal }) = hit else {
            let at = (-along).clamp(BigInt::ZERO, long.clone());
            let least = length(&plus(&from, &scaled(&vector(way), &at, &long)));
            assert!(least >= radius - allowed, "{least} {a:?} {origin:?} {way:?}");
            continue;
        };
        let at = plus(&from, &scaled(&vector(way), &fraction.into(), &WHOLE.into()));
        assert!(magnitude(&(length(&at) - &radius)) <= allowed, "{} {}", length(&at), a.radius);
        // The near side of it.
        assert!(inner(&at, &vector(way)) <= wide(1) * (way[0].abs() + way[1].abs()), "{at:?}");
        // Beside the rounding of the normal that of the ray's direction and what of `at` is across it, over the radius.
        for axis in 0..2 {
            let exact = (&at[axis] << 30) / &radius;
            assert!(magnitude(&(exact - normal[axis])) <= 3 + (((allowed.clone() * 2) << 30) / &radius), "{normal:?}");
        }
    }
    assert!(counts.iter().all(|&count| count > 600), "{counts:?}");
}

#[test]
fn rays_at_a_box() {
    let a = rectangle(2 * M, 2 * M, 0);
    let hit = |fraction, normal| Some(Hit { fraction, normal });
    let left = [-ONE, 0];
    for (origin, way, expected) in [
        ([-3 * M, 0], [4 * M, 0], hit(WHOLE / 2, left)),
        // Up to the border, one unit short of it, and away.
        ([-3 * M, 0], [2 * M, 0], hit(WHOLE, left)),
        ([-3 * M, 0], [2 * M - 1, 0], None),
        ([-3 * M, 0], [-4 * M, 0], None),
        // From the border, inwards, outwards and along; from inside.
        ([-M, 0], [M, 0], hit(0, [0, 0])),
        ([-M, 0], [-M, 0], hit(0, [0, 0])),
        ([-M, 0], [0, M], hit(0, [0, 0])),
        ([0, 0], [M, M], hit(0, [0, 0])),
        // Along a side, past it, and one unit beside it.
        ([-3 * M, M], [4 * M, 0], hit(WHOLE / 2, left)),
        ([-3 * M, -M], [4 * M, 0], hit(WHOLE / 2, left)),
        ([-3 * M, M + 1], [4 * M, 0], None),
        // Through a corner: of two edges the lower. Into one: both are entered at once.
        ([-2 * M, 0], [2 * M, 2 * M], hit(WHOLE / 2, left)),
        ([-2 * M, 1], [2 * M, 2 * M], None),
        ([-3 * M, -3 * M], [4 * M, 4 * M], hit(WHOLE / 2, [0, -ONE])),
        // A ray without length.
        ([-3 * M, 0], [0, 0], None),
        ([M, M], [0, 0], hit(0, [0, 0])),
        // From the end of the world, and beyond what is limited to it.
        ([-(1 << 62), 0], [1 << 62, 0], hit(WHOLE - M, left)),
        ([i64::MIN, 0], [i64::MAX, 0], hit(WHOLE - M, left)),
        ([i64::MIN, i64::MIN], [1, 1], None),
    ] {
        assert_eq!(ray(&a, origin, way), expected, "{origin:?} {way:?}");
    }
}

#[test]
fn rays_at_a_circle() {
    let a = circle([M, 0], M);
    let hit = |fraction, normal| Some(Hit { fraction, normal });
    for (origin, way, expected) in [
        ([-2 * M, 0], [4 * M, 0], hit(WHOLE / 2, [-ONE, 0])),
        ([-2 * M, 0], [2 * M, 0], hit(WHOLE, [-ONE, 0])),
        ([-2 * M, 0], [2 * M - 1, 0], None),
        ([-2 * M, 0], [-2 * M, 0], None),
        // Touching it, and one unit beside it.
        ([-M, M], [4 * M, 0], hit(WHOLE / 2, [0, ONE])),
        ([-M, M + 1], [4 * M, 0], None),
        ([0, 0], [-M, 0], hit(0, [0, 0])),
        ([M, 0], [0, 0], hit(0, [0, 0])),
        ([-M, 0], [0, 0], None),
        ([-(1 << 62), 0], [1 << 62, 0], hit(WHOLE, [-ONE, 0])),
    ] {
        assert_eq!(ray(&a, origin, way), expected, "{origin:?} {way:?}");
    }
    // From the farthest corner of the world the error is 2⁻⁶² of the way, which is 1.4 units.
    let Some(Hit { fraction, normal }) = ray(&a, [i64::MAX; 2], [i64::MIN; 2]) else { panic!("a miss") };
    assert!((fraction - (WHOLE - M)).abs() <= 2 && normal == [0, ONE]);
}

#[test]
fn nearest_points_of_a_box_and_a_circle() {
    let (a, b) = (rectangle(2 * M, 2 * M, 0), circle([M, 0], M));
    for (outline, p, expected) in [
        (&a, [3 * M, M / 2], ([M, M / 2], 2 * M)),
        (&a, [4 * M, 5 * M], ([M, M], 5 * M)),
        (&a, [M, M], ([M, M], 0)),
        (&a, [M + 1, -M], ([M, -M], 1)),
        (&a, [0, 0], ([0, 0], 0)),
        (&a, [1 << 62, 0], ([M, 0], (1 << 62) - 1 - M)),
        (&a, [i64::MIN, 0], ([-M, 0], (1 << 62) - 1 - M)),
        (&b, [5 * M, 0], ([2 * M, 0], 3 * M)),
        (&b, [2 * M, 0], ([2 * M, 0], 0)),
        (&b, [M, -3 * M], ([M, -M], 2 * M)),
        (&b, [i64::MIN, 0], ([0, 0], (1 << 62) - 1)),
    ] {
        assert_eq!(closest(outline, p), expected, "{p:?}");
        assert_eq!(contains(outline, p), expected.1 == 0);
    }
}
