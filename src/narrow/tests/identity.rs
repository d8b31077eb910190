//! Ids and the order of points while outlines slide, tilt and tremble.

use super::*;

const LIMIT: i64 = M / 50;

fn ids(manifold: &Manifold) -> Vec<u8> {
    points(manifold).iter().map(|point| point.2).collect()
}

/// The upper edge of a below the lower edge of b.
const PAIR: [u8; 2] = [id(2, 0, 0), id(2, 0, 1)];

#[test]
fn aligned_equal_boxes_that_tremble() {
    let (a, b) = (rectangle(M, M, 0), rectangle(M, M, 0));
    for x in -3..=3 {
        for y in -3..=3 {
            let manifold = collide(&a, &b, [x, M + y], LIMIT);
            assert_eq!((ids(&manifold), manifold.normal), (PAIR.to_vec(), [0, -ONE]));
            // a's edge runs to the left.
            let [right, left] = manifold.points.map(|point| point.arm);
            assert_eq!((right[0], left[0]), (M / 2 + x.min(0), -M / 2 + x.max(0)));
            assert_eq!(manifold.points.map(|point| point.separation), [y; 2]);
        }
    }
}

#[test]
fn boxes_that_tilt_either_way() {
    let mut owners = [0; 2];
    let mut noise = Noise(31);
    for _ in 0..5000 {
        // Up to 1e-3 rad, down to the last bit of an angle.
        let size = 1 << noise.within(1, 35);
        let turns = [noise.within(-size, size), noise.within(-size, size)];
        let (a, b) = (rectangle(M, M, turns[0]), rectangle(M, M, turns[1]));
        let d = [noise.within(-5, 5), M + noise.within(-M / 1000, M / 1000)];
        let manifold = collide(&a, &b, d, LIMIT);
        assert_eq!(ids(&manifold), PAIR);
        let [right, left] = manifold.points.map(|point| point.arm[0]);
        assert!(right > M / 2 - M / 100 && left < M / 100 - M / 2);
        let of_a = manifold.normal == a.normals[2].map(|n| -n);
        let of_b = manifold.normal == b.normals[0];
        assert!(of_a || of_b);
        if of_a != of_b {
            owners[usize::from(of_b)] += 1;
        }
    }
    assert!(owners.iter().all(|&count| count > 100), "either edge is the reference: {owners:?}");
}

#[test]
fn a_box_that_slides_off() {
    let (a, b) = (rectangle(M, M, 0), rectangle(M, M, 0));
    for x in (-M..=M).step_by(1 << 26) {
        let expected = match x.abs() == M {
            false => PAIR.to_vec(),
            // Corner on corner: of two equal axes a's right edge comes before its upper one, that before its left one.
            // The vertex of b is the end that it was before.
            true => vec![if x > 0 { id(1, 3, 0) } else { id(2, 0, 0) }],
        };
        assert_eq!(ids(&collide(&a, &b, [x, M], LIMIT)), expected, "{x}");
    }
    assert!(ids(&collide(&a, &b, [M + 1, M + 1], LIMIT)).is_empty());
}

#[test]
fn the_point_that_stays_keeps_its_id() {
    let a = rectangle(M, M, 0);
    let mut counts = [0; 3];
    // From 0 to 3 degrees: the far corner lifts off at 1.15.
    for turn in (0..=1i64 << 41).step_by(1 << 35) {
        for (turn, stays) in [(turn, 1), (-turn, 0)] {
            let b = rectangle(M / 2, M / 2, turn);
            let lowest = b.min[1];
            for d in [[0, M / 2 - lowest], [M / 100, M / 2 - lowest - 9]] {
                let manifold = collide(&a, &b, d, M / 100);
                counts[usize::from(manifold.count)] += 1;
                let expected = if manifold.count == 2 { PAIR.to_vec() } else { vec![PAIR[stays]] };
                assert_eq!(ids(&manifold), expected);
            }
        }
    }
    assert!(counts[1] > 50 && counts[2] > 50, "{counts:?}");
}
