//! For which limits what is near is the same.

use super::super::near;
use super::*;

/// Two boxes whose facing edges overlap in one point, or nearly.
fn corners(noise: &mut Noise) -> (Placed, Placed, [i64; 2]) {
    let mut side = || 2 * noise.within(M / 16, M);
    let (a, b) = ([side(), side()], [side(), side()]);
    let mut d = [0, 1].map(|axis: usize| (a[axis] + b[axis]) / 2);
    let axis = usize::from(noise.within(0, 1) == 0);
    d[axis] += noise.within(-M / 16, M / 2);
    d[1 - axis] += noise.within(-1, 1);
    let d = d.map(|c| if noise.within(0, 1) == 0 { c } else { -c });
    (rectangle(a[0], a[1], 0), rectangle(b[0], b[1], 0), d)
}

/// Outlines that touch, nearly do, or stand corner before corner.
#[test]
fn what_is_near_is_the_same_from_one_limit_to_the_other() {
    let mut noise = Noise(11);
    let (mut without, mut partly, mut apart) = (0, 0, 0);
    for _ in 0..100_000 {
        let radius = noise.within(M / 8, 2 * M);
        let (a, b) = (noise.outline(radius), noise.outline(radius));
        let away = noise.within(radius / 2, 3 * radius);
        let d = noise.around(away);
        let (a, b, d) = if noise.within(0, 9) == 0 { corners(&mut noise) } else { (a, b, d) };
        let limit = noise.within(0, M / 2);
        let seen = near(&a, &b, d, limit, &mut Faces::default());
        assert!(seen.holds(limit), "{seen:?} {limit}");
        let (low, high) = (seen.from.max(0), seen.below.min(M) - 1);
        for other in [low, high.max(low), noise.within(low, high.max(low)), noise.within(0, M)] {
            let again = near(&a, &b, d, other, &mut Faces::default());
            if seen.holds(other) {
                assert_eq!((seen.apart, &seen.manifold), (again.apart, &again.manifold), "{limit} {other}");
            }
            if !seen.apart && seen.manifold.count == 0 && other <= limit {
                assert_eq!(again.apart, other < seen.from, "{limit} {other}");
                assert_eq!(again.manifold.count, 0);
            }
        }
        without += usize::from(!seen.apart && seen.manifold.count == 0);
        partly += usize::from(!seen.apart && seen.below < i64::MAX);
        apart += usize::from(seen.apart);
    }
    assert!(without > 500 && partly > 500 && apart > 500, "{without} {partly} {apart}");
}

/// A small triangle beyond the end of a box's side, its nearest corner off it, the next one just over its end: one point, farther
/// away than what separates them.
#[test]
fn a_point_that_a_larger_limit_would_take_is_noted() {
    let gaps = [3 * M / 10, 4 * M / 10];
    for (sign, limit) in [(1, gaps[0]), (-1, gaps[0]), (1, gaps[1] - 1), (-1, gaps[1] - 1)] {
        let top = [[sign * M / 10, -gaps[0]], [0, -gaps[1]]];
        let top = if sign > 0 { top } else { [top[1], top[0]] };
        let (small, square) = (polygon(&[top[0], top[1], [sign * M / 20, -M]]), rectangle(2 * M, 2 * M, 0));
        let d = [-sign * M, M];
        for (a, b, d) in [(&small, &square, d), (&square, &small, negated(d))] {
            let seen = near(a, b, d, limit, &mut Faces::default());
            assert!(!seen.apart && seen.manifold.count == 0, "{seen:?}");
            assert_eq!((seen.from, seen.below), (gaps[0], gaps[1]));
            assert_eq!(near(a, b, d, gaps[1], &mut Faces::default()).manifold.count, 1);
        }
    }
}
