//! Queries against brute force in `f64`, and exactly where the answer is known to the bit: order, filters, ties, borders.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, acc, at, close, close2, disc, rectangle, run, world};
use solid::{Outline, add, fixed, gap, outlines, outside, polygon, solid, turned};
use tamias2d::{Aabb, BodyDef, BodyId, ColliderDef, ColliderId, Commands, Filter, Length, RayHit, Vec2, World};

const ALL: Filter = Filter { category: 1, mask: u32::MAX };

/// Boxes, discs and polygons at random places, turned, some of several parts.
fn scattered(seed: u64, count: u32, reach: f64) -> World {
    let (mut world, mut rng) = (world(0.0, 0.0), Rng(seed));
    for _ in 0..count {
        let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
        let (x, y, angle, offset) = (r(reach), r(reach), turned(r(3.0)), at(r(1.0), r(1.0)));
        let size = rng.scale(0.2, 3.0);
        let corner = |x: f64, y: f64| (x * size, y * size);
        let shape = match rng.below(4) {
            0 => disc(size),
            1 => polygon(&[corner(-0.5, -0.4), corner(0.6, -0.5), corner(0.5, 0.4), corner(-0.1, 0.6)]),
            2 => polygon(&[corner(-0.5, -0.4), corner(0.6, -0.4), corner(0.0, 0.5)]),
            _ => rectangle(size, rng.scale(0.2, 3.0)),
        };
        let shape = ColliderDef { offset, angle: turned(rng.unit()), ..shape };
        let mut def = BodyDef { angle, ..solid(x, y, shape) };
        if rng.below(3) == 0 {
            def.colliders.push(ColliderDef { offset: at(0.5, -1.0), ..disc(0.3) });
        }
        add(&mut world, def);
    }
    world
}

/// How far a point is outside an outline, negative inside.
fn distance(outline: &Outline, p: [f64; 2]) -> f64 {
    if outline.radius > 0.0 {
        (p[0] - outline.points[0][0]).hypot(p[1] - outline.points[0][1]) - outline.radius
    } else {
        outside(&outline.points, p).0
    }
}

/// Where a ray enters an outline, as a part of its way, and its least distance from the border if it only nearly does.
fn enters(outline: &Outline, from: [f64; 2], way: [f64; 2]) -> Option<f64> {
    if distance(outline, from) <= 0.0 {
        return Some(0.0);
    }
    if outline.radius > 0.0 {
        let d = [from[0] - outline.points[0][0], from[1] - outline.points[0][1]];
        let (a, b) = (way[0] * way[0] + way[1] * way[1], d[0] * way[0] + d[1] * way[1]);
        let c = d[0] * d[0] + d[1] * d[1] - outline.radius * outline.radius;
        let root = b * b - a * c;
        let t = (-b - root.max(0.0).sqrt()) / a;
        return (root >= 0.0 && (0.0..=1.0).contains(&t)).then_some(t);
    }
    // The first crossing with an edge, each as a segment.
    let mut first = f64::INFINITY;
    for (at, p) in outline.points.iter().enumerate() {
        let q = outline.points[(at + 1) % outline.points.len()];
        let (edge, to) = ([q[0] - p[0], q[1] - p[1]], [p[0] - from[0], p[1] - from[1]]);
        let cross = way[0] * edge[1] - way[1] * edge[0];
        let t = (to[0] * edge[1] - to[1] * edge[0]) / cross;
        let s = (to[0] * way[1] - to[1] * way[0]) / cross;
        if cross != 0.0 && (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s) {
            first = first.min(t);
        }
    }
    first.is_finite().then_some(first)
}

/// Whether the answer would be another one if the outline were `by` larger or smaller: too near to tell in `f64`.
fn grazes(outline: &Outline, from: [f64; 2], way: [f64; 2], by: f64) -> bool {
    // Steps along the way, near the outline only: the least distance to its border.
    let along = way[0].hypot(way[1]);
    let signed = |t: f64| distance(outline, [from[0] + way[0] * t, from[1] + way[1] * t]);
    // Convex: the least signed distance along a line by ternary search.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if signed(a) < signed(b) { high = b } else { low = a }
    }
    signed((low + high) / 2.0).min(signed(0.0)).min(signed(1.0)).abs() < by * (1.0 + along * 1e-3)
}

fn ids(hits: &[RayHit]) -> Vec<ColliderId> {
    hits.iter().map(|hit| hit.collider).collect()
}

fn fraction(hit: &RayHit) -> f64 {
    hit.fraction as f64 / (1u64 << 62) as f64
}

#[test]
fn rays_meet_what_brute_force_meets() {
    let mut rng = Rng(1);
    let mut met = 0;
    for seed in 0..10 {
        let world = scattered(seed, 60, 20.0);
        let (all, colliders): (Vec<Outline>, Vec<ColliderId>) =
            (outlines(&world), world.colliders().map(|c| c.id()).collect());
        for _ in 0..100 {
            let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
            let (from, way) = (at(r(25.0), r(25.0)), at(r(40.0), r(40.0)));
            let (p, w) = (<[f64; 2]>::from(from.to_f64()), <[f64; 2]>::from(way.to_f64()));
            let hits = world.ray_cast_all(from, way, ALL);
            assert_eq!(world.ray_cast(from, way, ALL), hits.first().copied());
            assert!(hits.is_sorted_by_key(|hit| (hit.fraction, hit.collider.index)));
            for (outline, id) in all.iter().zip(&colliders) {
                if grazes(outline, p, w, 1e-6) {
                    continue;
                }
                let (want, got) = (enters(outline, p, w), hits.iter().find(|hit| hit.collider == *id));
                assert_eq!(want.is_some(), got.is_some(), "{id} from {from:?} by {way:?}: {want:?}");
                let (Some(want), Some(hit)) = (want, got) else { continue };
                met += 1;
                close(fraction(hit), want, 1e-5);
                let point = [p[0] + w[0] * fraction(hit), p[1] + w[1] * fraction(hit)];
                close2(hit.point.to_f64(), point.into(), 1e-9);
                let normal = hit.normal.map(|n| f64::from(n) / f64::from(1 << 30));
                if want == 0.0 {
                    assert_eq!((hit.normal, hit.fraction, hit.point), ([0, 0], 0, from));
                    continue;
                }
                // On the border, and the normal points out of it, against the ray.
                close(distance(outline, point), 0.0, 1e-7);
                close(normal[0].hypot(normal[1]), 1.0, 1e-8);
                assert!(normal[0] * w[0] + normal[1] * w[1] < 0.0, "against the ray");
                let out = [point[0] + normal[0] * 1e-3, point[1] + normal[1] * 1e-3];
                close(distance(outline, out), 1e-3, 1e-6);
            }
        }
    }
    assert!(met > 500, "only {met} hits");
}

#[test]
fn points_are_in_what_brute_force_says() {
    let mut rng = Rng(2);
    let mut inside = 0;
    for seed in 10..20 {
        let world = scattered(seed, 60, 8.0);
        let (all, colliders): (Vec<Outline>, Vec<ColliderId>) =
            (outlines(&world), world.colliders().map(|c| c.id()).collect());
        for _ in 0..200 {
            let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
            let point = at(r(10.0), r(10.0));
            let p = <[f64; 2]>::from(point.to_f64());
            let found = world.overlap_point(point, ALL);
            assert!(found.is_sorted_by_key(|id| id.index));
            inside += found.len();
            for (outline, id) in all.iter().zip(&colliders) {
                let d = distance(outline, p);
                if d.abs() > 1e-7 {
                    assert_eq!(d < 0.0, found.contains(id), "{id} at {point:?}: {d}");
                }
            }
        }
    }
    assert!(inside > 400, "only {inside}");
}

#[test]
fn boxes_overlap_what_brute_force_says() {
    let mut rng = Rng(3);
    let mut met = 0;
    for seed in 20..30 {
        let world = scattered(seed, 60, 12.0);
        let (all, colliders): (Vec<Outline>, Vec<ColliderId>) =
            (outlines(&world), world.colliders().map(|c| c.id()).collect());
        for _ in 0..100 {
            let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
            let (x, y) = (r(14.0), r(14.0));
            let (w, h) = (rng.scale(1e-3, 20.0), rng.scale(1e-3, 20.0));
            let aabb = Aabb { min: at(x - w, y - h), max: at(x + w, y + h) };
            let found = world.overlap_box(&aabb, ALL);
            assert!(found.is_sorted_by_key(|id| id.index));
            met += found.len();
            let points = vec![[x - w, y - h], [x + w, y - h], [x + w, y + h], [x - w, y + h]];
            let window = Outline { points, radius: 0.0, body: BodyId { index: 0, generation: 0 }, dynamic: false };
            for (outline, id) in all.iter().zip(&colliders) {
                let apart = gap(outline, &window);
                if apart.abs() > 1e-6 {
                    assert_eq!(apart < 0.0, found.contains(id), "{id} and {aabb:?}: {apart}");
                }
            }
        }
    }
    assert!(met > 1000, "only {met}");
}

#[test]
fn the_closest_point_is_that_of_brute_force() {
    let mut rng = Rng(4);
    let mut found = 0;
    for seed in 30..40 {
        let world = scattered(seed, 40, 20.0);
        let (all, colliders): (Vec<Outline>, Vec<ColliderId>) =
            (outlines(&world), world.colliders().map(|c| c.id()).collect());
        for _ in 0..100 {
            let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
            let point = at(r(25.0), r(25.0));
            let reach = rng.scale(0.01, 30.0);
            let p = <[f64; 2]>::from(point.to_f64());
            let least = all.iter().map(|outline| distance(outline, p).max(0.0)).fold(f64::INFINITY, f64::min);
            let got = world.closest_point(point, Length::from_f64(reach).expect("in range"), ALL);
            if (least - reach).abs() < 1e-7 {
                continue;
            }
            assert_eq!(got.is_some(), least < reach, "{least} of {reach} at {point:?}");
            let Some(got) = got else { continue };
            found += 1;
            close(got.distance.to_f64(), least, 1e-7);
            let own = all.iter().zip(&colliders).find(|(_, id)| **id == got.collider).expect("it exists").0;
            close(distance(own, p).max(0.0), least, 1e-7);
            let (x, y) = got.point.to_f64();
            close((x - p[0]).hypot(y - p[1]), least, 1e-7);
            if least > 0.0 {
                close(distance(own, [x, y]), 0.0, 1e-7);
            } else {
                assert_eq!((got.point, got.distance), (point, Length::ZERO));
            }
        }
    }
    assert!(found > 200, "only {found}");
}

/// Three discs in a row along x at 3, 6 and 9 m, radius 1, in this order of creation, with categories 1, 2 and 4.
fn row() -> (World, [ColliderId; 3]) {
    let mut world = world(0.0, 0.0);
    for (x, category) in [(6.0, 2), (3.0, 1), (9.0, 4)] {
        add(&mut world, solid(x, 0.0, ColliderDef { filter: Filter { category, mask: u32::MAX }, ..disc(1.0) }));
    }
    let id = |index| ColliderId { index, generation: 0 };
    (world, [id(1), id(0), id(2)])
}

#[test]
fn rays_are_ordered_by_where_they_meet() {
    let (world, [near, middle, far]) = row();
    let (origin, way) = (at(0.0, 0.0), at(16.0, 0.0));
    let hits = world.ray_cast_all(origin, way, ALL);
    assert_eq!(ids(&hits), [near, middle, far]);
    let fractions: Vec<i64> = hits.iter().map(|hit| hit.fraction).collect();
    assert_eq!(fractions, [1 << 59, 5 << 58, 1 << 61]);
    assert_eq!(hits.iter().map(|hit| hit.point).collect::<Vec<_>>(), [at(2.0, 0.0), at(5.0, 0.0), at(8.0, 0.0)]);
    assert!(hits.iter().all(|hit| hit.normal == [-(1 << 30), 0]));
    // From the other side, and from within the middle one.
    assert_eq!(ids(&world.ray_cast_all(at(16.0, 0.0), at(-16.0, 0.0), ALL)), [far, middle, near]);
    assert_eq!(ids(&world.ray_cast_all(at(6.5, 0.0), at(16.0, 0.0), ALL)), [middle, far]);
    // It ends before the third one.
    assert_eq!(ids(&world.ray_cast_all(origin, at(7.5, 0.0), ALL)), [near, middle]);
}

#[test]
fn filters_leave_out_what_does_not_meet() {
    let (world, [near, middle, far]) = row();
    let filter = |category, mask| Filter { category, mask };
    let (origin, way) = (at(0.0, 0.0), at(16.0, 0.0));
    for (mask, want) in [(1, vec![near]), (2, vec![middle]), (6, vec![middle, far]), (8, vec![])] {
        assert_eq!(ids(&world.ray_cast_all(origin, way, filter(1, mask))), want);
    }
    assert_eq!(world.ray_cast(origin, way, filter(1, 4)).map(|hit| hit.collider), Some(far));
    assert_eq!(world.ray_cast_all(origin, way, filter(0, u32::MAX)), [], "no category that their masks have");
    assert_eq!(world.overlap_point(at(3.0, 0.0), filter(1, 2)), []);
    assert_eq!(world.overlap_point(at(3.0, 0.0), filter(1, 1)), [near]);
    let everything = Aabb { min: at(-50.0, -50.0), max: at(50.0, 50.0) };
    assert_eq!(world.overlap_box(&everything, filter(1, 5)), [near, far]);
    let nearest = world.closest_point(origin, Length::from_f64(20.0).expect("fits"), filter(1, 6)).expect("one");
    assert_eq!((nearest.collider, nearest.point), (middle, at(5.0, 0.0)));
}

#[test]
fn ties_go_to_the_lower_slot() {
    let mut world = world(0.0, 0.0);
    for _ in 0..4 {
        add(&mut world, solid(3.0, 0.0, rectangle(2.0, 2.0)));
    }
    // A free slot that is taken again: slot 1, generation 1.
    world.destroy_body(BodyId { index: 1, generation: 0 }).expect("it exists");
    add(&mut world, solid(3.0, 0.0, rectangle(2.0, 2.0)));
    let indices = |ids: Vec<ColliderId>| ids.iter().map(|id| (id.index, id.generation)).collect::<Vec<_>>();
    let want = [(0, 0), (1, 1), (2, 0), (3, 0)];
    assert_eq!(indices(ids(&world.ray_cast_all(at(0.0, 0.0), at(8.0, 0.0), ALL))), want);
    assert_eq!(indices(ids(&world.ray_cast_all(at(3.0, 0.0), at(8.0, 0.0), ALL))), want);
    assert_eq!(indices(world.overlap_point(at(3.5, 0.5), ALL)), want);
    assert_eq!(indices(world.overlap_box(&Aabb { min: at(3.0, 0.0), max: at(3.0, 0.0) }, ALL)), want);
    for point in [at(0.0, 0.0), at(3.0, 0.0), at(9.0, 4.0)] {
        let nearest = world.closest_point(point, Length::from_f64(50.0).expect("fits"), ALL).expect("one");
        assert_eq!(nearest.collider.index, 0);
    }
}

#[test]
fn borders_count() {
    let ulp = Length::from_bits(1);
    let mut world = world(0.0, 0.0);
    let square = add(&mut world, fixed(0.0, 0.0, rectangle(2.0, 2.0)));
    let round = add(&mut world, fixed(10.0, 0.0, disc(1.0)));
    let id = |body: BodyId| ColliderId { index: body.index, generation: 0 };
    let (square, round) = (id(square), id(round));
    let beyond = |x: f64| Length::from_bits(at(x, 0.0).x.to_bits() + ulp.to_bits());
    for (x, y) in [(1.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (0.25, -1.0)] {
        assert_eq!(world.overlap_point(at(x, y), ALL), [square]);
    }
    assert_eq!(world.overlap_point(Vec2::new(beyond(1.0), Length::ZERO), ALL), []);
    assert_eq!(world.overlap_point(at(11.0, 0.0), ALL), [round]);
    // The bits nearest to (0.6, 0.8) from the centre decide, exactly.
    let rim = at(10.6, 0.8);
    let [x, y] = [rim.x.to_bits() - (10 << 32), rim.y.to_bits()].map(i128::from);
    assert_eq!(world.overlap_point(rim, ALL).len(), usize::from(x * x + y * y <= 1 << 64));
    assert_eq!(world.overlap_point(Vec2::new(beyond(11.0), Length::ZERO), ALL), []);
    // Boxes that share an edge, a corner, or one point of a disc.
    let boxed = |min, max| world.overlap_box(&Aabb { min, max }, ALL);
    assert_eq!(boxed(at(1.0, -5.0), at(3.0, 5.0)), [square]);
    assert_eq!(boxed(at(1.0, 1.0), at(3.0, 5.0)), [square]);
    assert_eq!(boxed(Vec2::new(beyond(1.0), Length::ZERO), at(3.0, 5.0)), []);
    assert_eq!(boxed(at(8.0, -5.0), at(9.0, 5.0)), [round]);
    assert_eq!(boxed(at(10.9, 0.9), at(12.0, 3.0)), [], "a disc has no corner");
    // A ray along an edge, one that ends on it, and one that stops short of it by the least there is.
    assert_eq!(ids(&world.ray_cast_all(at(-5.0, 1.0), at(10.0, 0.0), ALL)), [square]);
    let touching = world.ray_cast(at(-5.0, 0.5), at(4.0, 0.0), ALL).expect("it ends on it");
    assert_eq!((touching.collider, touching.fraction, touching.point), (square, 1 << 62, at(-1.0, 0.5)));
    let short = Vec2::new(Length::from_bits((4 << 32) - 1), Length::ZERO);
    assert_eq!(world.ray_cast(at(-5.0, 0.5), short, ALL), None);
    // The reach of the nearest point counts, too.
    let nearest = |reach: Length| world.closest_point(at(4.0, 0.0), reach, ALL).map(|found| found.collider);
    assert_eq!(nearest(at(3.0, 0.0).x), Some(square));
    assert_eq!(nearest(Length::from_bits((3 << 32) - 1)), None);
}

#[test]
fn a_ray_without_length_meets_what_its_origin_is_in() {
    let (world, [near, ..]) = row();
    let zero = at(0.0, 0.0);
    let hit = world.ray_cast(at(3.5, 0.0), zero, ALL).expect("inside");
    assert_eq!(hit, RayHit { collider: near, point: at(3.5, 0.0), fraction: 0, normal: [0, 0] });
    assert_eq!(world.ray_cast(at(2.0, 0.0), zero, ALL).map(|hit| hit.collider), Some(near), "on the border");
    assert_eq!(world.ray_cast(at(1.0, 0.0), zero, ALL), None);
    // And past a polygon.
    let mut world = common::world(0.0, 0.0);
    add(&mut world, solid(0.0, 0.0, rectangle(2.0, 2.0)));
    assert_eq!(world.ray_cast(at(1.5, 0.0), zero, ALL), None);
    assert_eq!(world.ray_cast(at(1.0, 0.0), zero, ALL).map(|hit| hit.fraction), Some(0));
}

#[test]
fn rays_across_the_world_meet() {
    for sign in [1.0, -1.0] {
        let mut world = world(0.0, 0.0);
        add(&mut world, fixed(sign * (1e9 - 1.0), 0.0, rectangle(2.0, 2.0)));
        add(&mut world, fixed(sign * (1e9 - 1.0), 1e9 - 1.0, disc(1.0)));
        // 1e9 m along an axis: a length's bits are exact there, the fraction's 62 are finer.
        let hit = world.ray_cast(at(0.0, 0.5), at(sign * 1e9, 0.0), ALL).expect("it is in the way");
        assert_eq!(hit.point, at(sign * (1e9 - 2.0), 0.5));
        assert_eq!(hit.normal, [if sign > 0.0 { -(1 << 30) } else { 1 << 30 }, 0]);
        assert_eq!(world.ray_cast(at(0.0, 0.5), at(sign * (1e9 - 2.0 - 1e-6), 0.0), ALL), None);
        // Along the diagonal.
        let hit = world.ray_cast(at(0.0, 0.0), at(sign * 1e9, 1e9), ALL).expect("it is in the way");
        let want = 1e9 - 1.0 - std::f64::consts::FRAC_1_SQRT_2;
        close2(hit.point.to_f64(), (sign * want, want), 1e-6);
        // From the other end of the world it ends in the middle.
        assert_eq!(world.ray_cast(at(-sign * 1e9, 0.5), at(sign * 1e9, 0.0), ALL), None);
    }
}

#[test]
fn huge_queries_do_no_harm() {
    let world = scattered(99, 40, 20.0);
    let ends = [i64::MIN, i64::MIN + 1, -(1 << 62), -1, 0, 1, 1 << 62, i64::MAX].map(Length::from_bits);
    let count = world.colliders().count();
    for x in ends {
        for y in ends {
            for z in ends {
                let (p, q) = (Vec2::new(x, y), Vec2::new(y, z));
                let hits = world.ray_cast_all(p, q, ALL);
                assert!(hits.iter().all(|hit| (0..=1 << 62).contains(&hit.fraction)));
                assert!(world.overlap_point(p, ALL).len() <= count);
                assert!(world.overlap_box(&Aabb { min: p, max: q }, ALL).len() <= count);
                let _any = world.closest_point(p, z, ALL);
            }
        }
    }
    let everything = Aabb { min: Vec2::new(ends[0], ends[0]), max: Vec2::new(ends[7], ends[7]) };
    assert_eq!(world.overlap_box(&everything, ALL).len(), count);
    // A box whose corners are the wrong way round is empty.
    assert_eq!(world.overlap_box(&Aabb { min: at(50.0, 50.0), max: at(-50.0, -50.0) }, ALL), []);
}

#[test]
fn queries_follow_what_commands_and_steps_do() {
    let mut world = world(0.0, 0.0);
    let wall = add(&mut world, fixed(5.0, 0.0, rectangle(1.0, 4.0)));
    let ball = add(&mut world, solid(0.0, 8.0, disc(1.0)));
    let ray = |world: &World| ids(&world.ray_cast_all(at(-10.0, 0.0), at(20.0, 0.0), ALL));
    let [wall_id, ball_id] = [wall, ball].map(|body| ColliderId { index: body.index, generation: 0 });
    assert_eq!(ray(&world), [wall_id]);
    // Teleports, before any step.
    world.set_position(ball, at(0.0, 0.0)).expect("accepted");
    assert_eq!(ray(&world), [ball_id, wall_id]);
    world.set_position(wall, at(-5.0, 1.5)).expect("accepted");
    assert_eq!(ray(&world), [wall_id, ball_id]);
    world.set_angle(wall, tamias2d::Angle::from_bits(1 << 46)).expect("accepted");
    assert_eq!(ray(&world), [ball_id], "4 m wide and 1 m high now, above the ray");
    assert_eq!(world.overlap_point(at(-6.9, 1.5), ALL), [wall_id]);
    // Motion.
    world.set_gravity(acc(0.0, -9.81)).expect("accepted");
    run(&mut world, 60);
    assert_eq!(ray(&world), []);
    assert_eq!(world.overlap_point(at(0.0, -9.81 / 2.0), ALL), [ball_id]);
    let nearest = world.closest_point(at(0.0, -1.0), Length::from_f64(4.0).expect("fits"), ALL).expect("one");
    assert_eq!(nearest.collider, ball_id);
    close(nearest.distance.to_f64(), 9.81 / 2.0 - 2.0, 1e-6);
    // Filters, and destroyed bodies.
    world.set_filter(wall_id, Filter { category: 2, mask: 2 }).expect("accepted");
    assert_eq!(world.overlap_point(at(-6.9, 1.5), ALL), []);
    assert_eq!(world.overlap_point(at(-6.9, 1.5), Filter { category: 2, mask: 2 }), [wall_id]);
    world.destroy_body(ball).expect("it exists");
    assert_eq!(world.overlap_point(at(0.0, -9.81 / 2.0), ALL), []);
    world.destroy_body(wall).expect("it exists");
    let everything = Aabb { min: at(-1e9, -1e9), max: at(1e9, 1e9) };
    assert_eq!(world.overlap_box(&everything, Filter { category: u32::MAX, mask: u32::MAX }), []);
    // And a loaded world answers like the one that was saved.
    let world = scattered(5, 30, 10.0);
    let loaded = World::load(&world.save()).expect("just saved");
    assert_eq!(world.overlap_box(&everything, ALL), loaded.overlap_box(&everything, ALL));
    let (from, way) = (at(-20.0, 1.0), at(40.0, 2.0));
    assert_eq!(world.ray_cast_all(from, way, ALL), loaded.ray_cast_all(from, way, ALL));
}

#[test]
fn sensors_are_met_like_others() {
    let mut world = world(0.0, 0.0);
    let sensor = ColliderDef { sensor: true, filter: Filter { category: 8, mask: u32::MAX }, ..disc(1.0) };
    add(&mut world, fixed(3.0, 0.0, sensor));
    let id = ColliderId { index: 0, generation: 0 };
    assert_eq!(ids(&world.ray_cast_all(at(0.0, 0.0), at(8.0, 0.0), ALL)), [id]);
    assert_eq!(world.overlap_point(at(3.0, 0.0), Filter { category: 1, mask: !8 }), []);
}

#[test]
fn queries_turn_by_half_a_turn() {
    // Everything negated gives negated points, to the bit, and the same fractions.
    let mut rng = Rng(6);
    let half = 1i64 << 47;
    let there = scattered(7, 50, 15.0);
    let negated = |p: Vec2<Length>| Vec2::new(Length::from_bits(-p.x.to_bits()), Length::from_bits(-p.y.to_bits()));
    let mut back = world(0.0, 0.0);
    for body in there.bodies() {
        let def = body.def();
        let angle = tamias2d::Angle::from_bits(def.angle.to_bits() + half);
        add(&mut back, BodyDef { position: negated(def.position), angle, ..def });
    }
    let mut met = 0;
    for _ in 0..300 {
        let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
        let (from, way) = (at(r(20.0), r(20.0)), at(r(30.0), r(30.0)));
        let one = there.ray_cast_all(from, way, ALL);
        let other = back.ray_cast_all(negated(from), negated(way), ALL);
        met += one.len();
        assert_eq!(one.len(), other.len());
        for (one, other) in one.iter().zip(&other) {
            assert_eq!((one.collider, one.fraction), (other.collider, other.fraction));
            assert_eq!((negated(one.point), one.normal.map(|n| -n)), (other.point, other.normal));
        }
        let reach = Length::from_f64(30.0).expect("fits");
        let (one, other) = (there.closest_point(from, reach, ALL), back.closest_point(negated(from), reach, ALL));
        let (one, other) = (one.expect("near"), other.expect("near"));
        assert_eq!((one.collider, negated(one.point), one.distance), (other.collider, other.point, other.distance));
    }
    assert!(met > 300, "only {met} hits");
}
