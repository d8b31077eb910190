//! Half a turn and exchange.

use super::*;
use crate::narrow::{closest, contains, overlap, ray};

/// Outlines from 1 cm to 500 m at distances at which they may touch.
fn pairs(seed: u64) -> impl Iterator<Item = (Placed, Placed, [i64; 2])> {
    let mut noise = Noise(seed);
    (0..6000).map(move |_| {
        let sizes = [0; 2].map(|_| (M / 100) << noise.within(0, 15));
        let (a, b) = (noise.outline(sizes[0]), noise.outline(sizes[1]));
        let reach = noise.within(0, sizes[0] + sizes[1]);
        (a, b, noise.around(reach))
    })
}

#[test]
fn half_a_turn_negates_vectors_and_nothing_else() {
    let mut counts = [0; 3];
    for (a, b, d) in pairs(11) {
        let manifold = collide(&a, &b, d, M / 50);
        let mut turned = collide(&opposite(&a), &opposite(&b), negated(d), M / 50);
        counts[usize::from(manifold.count)] += 1;
        turned.normal = turned.normal.map(|n| -n);
        for point in &mut turned.points {
            point.arm = negated(point.arm);
        }
        assert_eq!(turned, manifold);
        assert_eq!(overlap(&opposite(&a), &opposite(&b), negated(d)), overlap(&a, &b, d));

        let other = opposite(&a);
        assert_eq!(contains(&other, negated(d)), contains(&a, d));
        let (at, distance) = closest(&a, d);
        assert_eq!(closest(&other, negated(d)), (negated(at), distance));
        let way = [3 - 2 * d[0], d[1] - 2 * d[0]];
        let hit = ray(&a, d, way).map(|hit| (hit.fraction, hit.normal.map(|n| -n)));
        assert_eq!(ray(&other, negated(d), negated(way)).map(|hit| (hit.fraction, hit.normal)), hit);
    }
    assert!(counts.iter().all(|&count| count > 800), "{counts:?}");
}

#[test]
fn exchanged_outlines_have_the_same_points() {
    for (a, b, d) in pairs(12) {
        let manifold = collide(&a, &b, d, M / 50);
        let mirror = collide(&b, &a, negated(d), M / 50);
        assert_eq!(mirror.normal.map(|n| -n), manifold.normal);
        assert_eq!(mirror.count, manifold.count);
        assert_eq!(overlap(&a, &b, d), overlap(&b, &a, negated(d)));
        let mut there = points(&manifold);
        let mut back: Vec<_> = points(&mirror);
        back.sort_by_key(|point| !point.2 & 1);
        for (here, other) in there.iter_mut().zip(&back) {
            if a.count > 1 && b.count > 1 {
                // The edges change places, and each runs the other way.
                assert_eq!(other.2, (here.2 >> 1 & 7) << 4 | (here.2 >> 4) << 1 | (!here.2 & 1));
            }
            assert_eq!(other.1, here.1);
            let off = (0..2).map(|axis| (other.0[axis] + d[axis] - here.0[axis]).abs()).max();
            assert!(off <= Some(i64::from(a.count == 1 && b.count == 1)), "{off:?}");
        }
    }
}

#[test]
fn of_two_equal_axes_it_is_a_s() {
    // Boxes a 1000 mm and b 500 mm wide, level: a's upper edge and b's lower one are 2⁻²⁰ m apart. Either way the normal
    // is that of a's edge and the points are the same.
    let (a, b) = (rectangle(M, M, 0), rectangle(M / 2, M, 0));
    let above = collide(&a, &b, [0, M + 4096], 9999);
    let below = collide(&b, &a, [0, -M - 4096], 9999);
    assert_eq!((above.normal, below.normal), ([0, -ONE], [0, ONE]));
    let y = M / 2 + 2048;
    assert_eq!(points(&above), [([M / 4, y], 4096, id(2, 0, 0)), ([-M / 4, y], 4096, id(2, 0, 1))]);
    assert_eq!(
        points(&below),
        [([-M / 4, y - M - 4096], 4096, id(0, 2, 0)), ([M / 4, y - M - 4096], 4096, id(0, 2, 1))]
    );
}
