//! What is known of the edges that face each other is what looking at all of them finds.

use super::super::near;
use super::*;
use crate::shape::Outline;

/// A box, long or square, or a polygon about a point beside its centre.
fn outline(noise: &mut Noise, radius: i64) -> Outline {
    let shape = if noise.within(0, 2) == 0 {
        let [width, height] = [0, 1].map(|_| Length::from_bits(noise.within(radius / 8, 2 * radius)));
        Shape::Box { width, height }
    } else {
        let count = noise.within(3, 8);
        let spread = |at: i64, noise: &mut Noise| ((at << 48) + noise.within(0, 1 << 46)) / count;
        Shape::Polygon { vertices: (0..count).map(|side| vec(at(spread(side, noise), radius))).collect() }
    };
    let away = noise.within(0, radius / 4);
    shape.canonical().outline(vec(noise.around(away)), Angle::ZERO, Vec2::default())
}

/// Pairs that move against each other, by micrometres or by a tenth of their size, jump now and then, or turn far.
#[test]
fn known_faces_are_those_that_all_edges_would_give() {
    let mut noise = Noise(29);
    let (mut known, mut seen) = (0, 0);
    for _ in 0..4000 {
        let radius = 1 << noise.within(26, 38);
        let outlines = [outline(&mut noise, radius), outline(&mut noise, radius)];
        let reach = outlines.each_ref().map(|outline| outline.reach);
        let mut angle = [0, 1].map(|_| noise.within(0, (1 << 50) - 1));
        let away = noise.within(radius, 2 * radius);
        let (mut d, mut last) = (noise.around(away), [0; 2]);
        let quick = noise.within(4, 20);
        let mut faces = Faces::default();
        for _ in 0..40 {
            let placed = [0, 1].map(|body| Placed::new(&outlines[body], Rot::new(Angle::from_bits(angle[body]))));
            let limit = noise.within(0, radius / 4);
            faces.follow([last, d], angle, reach);
            known += (0..2).filter(|&polygon| faces.of(polygon).known().is_some()).count();
            let by_faces = near(&placed[0], &placed[1], d, limit, &mut faces);
            let afresh = near(&placed[0], &placed[1], d, limit, &mut Faces::default());
            assert_eq!(
                (by_faces.apart, &by_faces.manifold),
                (afresh.apart, &afresh.manifold),
                "{outlines:?} {d:?} {angle:?}"
            );
            assert!(by_faces.apart || (by_faces.from, by_faces.below) == (afresh.from, afresh.below));
            seen += 2;
            last = d;
            let leap = noise.within(0, 30) == 0;
            let way = if leap { radius } else { radius >> quick };
            d = d.map(|c| (c + noise.within(-way, way)).clamp(-2 * radius, 2 * radius));
            let turn = if leap { 1 << 47 } else { (1 << 48) >> quick };
            angle = angle.map(|turned| turned + noise.within(-turn, turn));
        }
    }
    assert!(known > seen / 4 && known < seen, "{known} of {seen} were known");
}

/// A box that tips over on another one, by a tenth of a degree a tick: it is looked at anew once in a while.
#[test]
fn the_faces_of_a_box_that_tips_are_known_nearly_always() {
    let shape = rectangle(M, M, 0);
    let mut faces = Faces::default();
    let (mut ticks, mut known, mut angle) = (0, 0, 0);
    while angle < 1 << 46 {
        let top = rectangle(M, M, angle);
        let (below, d) = ([0, M - ticks], [0, M - ticks - 1000]);
        faces.follow([below, d], [0, angle], [M, M]);
        known += i64::from([0, 1].iter().all(|&polygon| faces.of(polygon).known().is_some()));
        let by_faces = near(&shape, &top, d, M / 50, &mut faces);
        assert_eq!(by_faces, near(&shape, &top, d, M / 50, &mut Faces::default()));
        (ticks, angle) = (ticks + 1, angle + (1 << 36));
    }
    assert!(ticks > 500 && known > ticks * 9 / 10, "{known} of {ticks}");
}
