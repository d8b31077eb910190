//! Random pairs against the oracle.

use super::oracle::*;
use super::*;
use crate::narrow::{along, difference, overlap, polygon::between, rounded, unit::unit};
use crate::num::{div, round_shift};
use num_bigint::BigInt;

const LIMIT: i64 = M / 20;

/// Units that a projection may be off: half for its own rounding, and what the rounding of a normal (half a unit of
/// 2⁻³⁰ per coordinate) makes of the distance to the far end of either outline.
fn tolerance(a: &Placed, b: &Placed) -> i64 {
    let extent = |p: &Placed| (p.max[0] - p.min[0]).max(p.max[1] - p.min[1]);
    1 + ((extent(a) + extent(b)) >> 30)
}

/// Two polygons and where b is, such that they touch or nearly do.
fn pair(noise: &mut Noise) -> (Placed, Placed, [i64; 2]) {
    let sizes = [noise.within(M / 4, 4 * M), noise.within(M / 4, 4 * M)];
    let (a, b) = (noise.polygon(sizes[0]), noise.polygon(sizes[1]));
    (a, b, noise.around(sizes[0] + sizes[1]))
}

/// Moves b towards a until they are about `gap` apart (down to a deep overlap).
fn approach(a: &Placed, b: &Placed, d: [i64; 2], gap: i64) -> [i64; 2] {
    let (mut near, mut far) = (0, 1 << 20);
    for _ in 0..20 {
        let half = (near + far) / 2;
        let d = d.map(|c| mul(c, half, 20));
        let apart = Exact::new(a, [0, 0]).greatest(&Exact::new(b, d));
        let back = Exact::new(b, d).greatest(&Exact::new(a, [0, 0]));
        *(if apart.max(back) < wide(gap) { &mut near } else { &mut far }) = half;
    }
    d.map(|c| mul(c, near, 20))
}

#[test]
fn two_polygons_are_clipped_as_in_exact_arithmetic() {
    let mut noise = Noise(1);
    // Manifolds of 0, 1 and 2 points, and cases where rounding decides.
    let (mut seen, mut unclear) = ([0; 3], 0);
    for _ in 0..2000 {
        let (a, b, d) = pair(&mut noise);
        let d = approach(&a, &b, d, noise.within(-M / 2, M / 12));
        let tolerance = tolerance(&a, &b);
        let manifold = collide(&a, &b, d, LIMIT);
        seen[usize::from(manifold.count)] += 1;
        let exact = [Exact::new(&a, [0, 0]), Exact::new(&b, d)];
        let greatest = exact[0].greatest(&exact[1]).max(exact[1].greatest(&exact[0]));
        assert_eq!(overlap(&a, &b, d), greatest <= BigInt::ZERO, "{greatest} would have to be within rounding of 0");
        if manifold.count == 0 {
            assert_eq!(manifold, Manifold::default());
            // Apart, or corner to corner with no edge facing: no overlap is left without a point.
            assert!(greatest > BigInt::ZERO);
            continue;
        }
        let id = usize::from(manifold.points[0].id);
        let edges = [id >> 4, id >> 1 & 7];
        let owner = usize::from(manifold.normal == b.normals[edges[1]]);
        assert!(owner == 1 || manifold.normal == a.normals[edges[0]].map(|n| -n), "the normal is an edge's");
        let (own, other) = (&exact[owner], &exact[1 - owner]);
        let (edge, incident) = (edges[owner], edges[1 - owner]);
        assert!(near(&own.separation(edge, other), &greatest, 2 * tolerance));

        // The facing edge, low end first, and where it is over the reference edge.
        let ends = [&other.vertices[other.next(incident)], &other.vertices[incident]];
        let at = ends.map(|v| own.along(edge, v));
        let gaps = ends.map(|v| own.outside(edge, v));
        assert!(near(gaps.iter().min().expect("two"), &own.separation(edge, other), tolerance));
        let width = own.along(edge, &own.vertices[own.next(edge)]);
        let overlap = [at[0].clone().max(BigInt::ZERO), at[1].clone().min(width)];
        let run = &at[1] - &at[0];
        if run < wide(M / 1000) {
            unclear += 1;
            continue;
        }
        let slope = i64::try_from(magnitude(&(&gaps[1] - &gaps[0])) / &run).expect("a slope") + 1;
        let gap = |t: &BigInt| &gaps[0] + (&gaps[1] - &gaps[0]) * (t - &at[0]) / &run;
        let allowed = tolerance * (2 * slope + 2);
        let found: Vec<_> =
            points(&manifold).into_iter().map(|(arm, s, id)| (arm, s, usize::from(id & 1) ^ owner)).collect();
        for &(arm, separation, end) in &found {
            assert!(separation <= LIMIT);
            if overlap[0] > overlap[1] {
                // The nearest vertex alone.
                assert!(manifold.count == 1 && near(&wide(separation), &gaps[end], tolerance));
                assert!(near(&wide(separation), &greatest, 2 * tolerance));
                continue;
            }
            let (t, s) = (&overlap[end], gap(&overlap[end]));
            assert!(near(&wide(separation), &s, allowed), "{separation} is not {}", s >> FRACTION);
            let [nx, ny] = &own.normals[edge];
            let half = &s >> 1;
            let middle = [
                &own.vertices[edge][0] - ny * t / wide(1) + nx * &half / wide(1),
                &own.vertices[edge][1] + nx * t / wide(1) + ny * &half / wide(1),
            ];
            assert!((0..2).all(|axis| near(&wide(arm[axis]), &middle[axis], allowed)), "{arm:?}");
        }
        if magnitude(&(&overlap[1] - &overlap[0])) < wide(allowed) {
            unclear += 1;
            continue;
        }
        // No end within the limit is missing.
        for end in 0..2 {
            let there = found.iter().any(|point| point.2 == end);
            if overlap[0] < overlap[1] && !near(&gap(&overlap[end]), &wide(LIMIT), allowed) && found.len() != 1 {
                assert_eq!(there, gap(&overlap[end]) <= wide(LIMIT));
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 100) && unclear < 30, "{seen:?}, {unclear} unclear");
}

#[test]
fn the_edge_is_that_of_a_search_through_all() {
    let mut noise = Noise(4);
    let separation = |own: &Placed, other: &Placed, d, edge: usize| {
        let least = other.vertices[..other.count.into()].iter().map(|&v| along(own.normals[edge], v)).min();
        rounded(least.expect("vertices") + along(own.normals[edge], difference(d, own.vertices[edge])))
    };
    let mut ties = 0;
    for _ in 0..20_000 {
        // Few coordinates, so that separations are often equal; some slivers.
        let mut triangle = || loop {
            let grain = if noise.within(0, 1) == 0 { M } else { M / 256 };
            let corners = [0; 3].map(|_| [noise.within(-8, 8) * M, noise.within(-8, 8) * grain]);
            let [u, v] = [1, 2].map(|at| difference(corners[at], corners[0]));
            if u[0] / M * (v[1] / grain) > u[1] / grain * (v[0] / M) {
                return polygon(&corners);
            }
        };
        let (a, b) = (triangle(), triangle());
        let d = [noise.within(-9, 9) * M, noise.within(-9, 9) * M];
        let all: Vec<_> = (0..3)
            .map(|edge| (separation(&a, &b, d, edge), a.normals[edge].map(|n| -n)))
            .chain((0..3).map(|edge| (separation(&b, &a, negated(d), edge), b.normals[edge])))
            .collect();
        let greatest = all.iter().map(|at| at.0).max().expect("edges");
        let manifold = collide(&a, &b, d, 0);
        assert_eq!(manifold.count == 0, greatest > 0);
        if greatest < 0 {
            ties += usize::from(all.iter().filter(|at| at.0 == greatest).count() > 1);
            assert_eq!(Some(manifold.normal), all.iter().find(|at| at.0 == greatest).map(|at| at.1));
        }
    }
    assert!(ties > 20, "{ties}");
}

#[test]
fn roundings() {
    let mut noise = Noise(6);
    for _ in 0..20_000 {
        let size = 1 << noise.within(1, 51);
        let v = [noise.within(-size, size), noise.within(-size, size)];
        let n = [noise.within(-(1 << 30), 1 << 30), noise.within(-(1 << 30), 1 << 30)].map(|n| n as i32);
        let exact = i128::from(n[0]) * i128::from(v[0]) + i128::from(n[1]) * i128::from(v[1]);
        assert_eq!(i128::from(along(n, v)), exact >> 24);
        assert!((exact - (i128::from(rounded(along(n, v))) << 30)).abs() <= (1 << 29) + (1 << 24));

        let (a, b) = (noise.within(-size, size), noise.within(-size, size));
        let most = 1 << noise.within(0, 51);
        let whole = noise.within(1, most);
        let part = noise.within(0, whole);
        let share = div(i128::from(b - a) * i128::from(part), whole.into());
        assert_eq!(i128::from(between(a, b, part, whole)), i128::from(a) + share);
        assert_eq!((between(a, b, 0, whole), between(a, b, whole, whole)), (a, b));
    }
    assert_eq!(between(5, 9, 0, 0), 5);
    assert_eq!(rounded(32), i64::try_from(round_shift(32, 6)).expect("1"));
}

#[test]
fn a_circle_and_a_polygon_are_as_far_apart_as_in_exact_arithmetic() {
    let mut noise = Noise(2);
    let (mut seen, mut inside, mut corner) = ([0; 2], 0, 0);
    for _ in 0..4000 {
        let sizes = [noise.within(M / 4, 4 * M), noise.within(M / 100, 2 * M)];
        let (a, b) = (noise.polygon(sizes[0]), noise.circle(sizes[1]));
        let reach = noise.within(0, sizes[0] + sizes[1]);
        let center = noise.around(reach);
        let d = [center[0] - b.vertices[0][0], center[1] - b.vertices[0][1]];
        let tolerance = tolerance(&a, &b);
        let exact = Exact::new(&a, [0, 0]);
        let (distance, _) = exact.distance(&vector(center));
        let separation = &distance - wide(b.radius);
        assert!(near(&separation, &BigInt::ZERO, tolerance) || overlap(&a, &b, d) == (separation <= BigInt::ZERO));
        let manifold = collide(&a, &b, d, LIMIT);
        seen[usize::from(manifold.count)] += 1;
        if manifold.count == 0 {
            assert!(separation > wide(LIMIT - tolerance));
            continue;
        }
        let [point, _] = manifold.points;
        assert!(separation <= wide(LIMIT + tolerance) && point.id == 0);
        assert!(near(&wide(point.separation), &separation, tolerance), "{} {separation}", point.separation);
        // From the centre back by the radius and half the gap is the point.
        let back = b.radius + point.separation / 2;
        let off = |axis: usize| center[axis] + mul(back, manifold.normal[axis].into(), 30) - point.arm[axis];
        assert!(off(0).abs().max(off(1).abs()) <= 1 + tolerance);
        if !a.normals.contains(&manifold.normal.map(|n| -n)) {
            corner += 1;
        }
        inside += usize::from(distance < BigInt::ZERO);
    }
    assert!(seen[0] > 500 && inside > 500 && corner > 300, "{seen:?} {inside} {corner}");
}

#[test]
fn directions_and_lengths_are_those_of_exact_roots() {
    let mut noise = Noise(3);
    for round in 0..20_000 {
        let size = 1 << noise.within(1, if round % 2 == 0 { 51 } else { 62 });
        let v = [noise.within(-size, size), noise.within(-size, size) >> noise.within(0, 40)];
        let Some((direction, long)) = unit(v) else {
            assert_eq!(v, [0, 0]);
            continue;
        };
        let exact = length(&vector(v));
        // In 1/100 of the last place; of lengths 2⁻⁴⁷ of it besides.
        let error = (magnitude(&(&exact - wide(long))) * 100) >> FRACTION;
        assert!(error <= BigInt::from(51 + ((100 * (long >> 20)) >> 27)), "{v:?}: {long}");
        for axis in 0..2 {
            let part = (wide(v[axis]) << 30) * 100 / &exact;
            assert!(magnitude(&(part - 100 * i64::from(direction[axis]))) <= BigInt::from(51), "{v:?}: {direction:?}");
        }
        assert_eq!(unit(negated(v)), Some((direction.map(|n| -n), long)));
    }
    for (v, expected) in
        [([1, 0], ([ONE, 0], 1)), ([0, -M], ([0, -ONE], M)), ([3 * M, 4 * M], ([644_245_094, 858_993_459], 5 * M))]
    {
        assert_eq!(unit(v), Some(expected));
    }
    assert_eq!(unit([0, 0]), None);
}
