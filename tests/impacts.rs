//! Impacts at their times (IM:col2D's t_c), one or two bodies at a time: heights of bounces, corners against GD:impulse, VE1
//! and VE3 as shapes, Table 4, TC10c, TC11c.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/impact.rs"]
mod impact;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, close, close2, disc, newtons, num, omega, position, rectangle, run, velocity, world};
use impact::{Free, Hit, Side, TICK, body, collide, pebble, scatter, until_struck, wall_in};
use solid::{
    add, energy, fixed, get, mass_of, moving, polygon, scaled_world, solid, spin, surface, turned, weighing,
    worst_overlap,
};
use tamias2d::{BodyDef, BodyId, BodyKind, Bound, ColliderDef, Inertia, World, WorldDef};

const G: f64 = 9.81;

// Drops (DD:coeffRestitution, properties of a correct solution).

/// The heights of a body's first peaks above where it rests, and the fastest that it turned until the last of them.
/// A peak is that of the parabola that the body is on: y + v²/2g.
fn peaks(shape: &ColliderDef, height: f64, e: f64, count: usize) -> (Vec<f64>, f64) {
    let mut world = world(0.0, -G);
    add(&mut world, fixed(0.0, -1.0, surface(rectangle(20.0, 2.0), 0.6, e)));
    let id = add(&mut world, solid(0.25, 0.5 + height, surface(shape.clone(), 0.6, e)));
    let (mut peaks, mut turns) = (vec![height], 0.0f64);
    for _ in 0..600 {
        world.step();
        let (y, v) = (position(&world, id).1, velocity(&world, id).1);
        let peak = y - 0.5 + v * v / (2.0 * G);
        let last = peaks[peaks.len() - 1];
        if (peak / last - 1.0).abs() > 0.5 * (1.0 - e * e) {
            if peaks.len() > count {
                break;
            }
            peaks.push(peak);
        }
        turns = turns.max(omega(&world, id).abs());
    }
    (peaks.split_off(1), turns)
}

#[test]
fn what_is_dropped_bounces_to_the_squares_of_its_restitution() {
    let mut rng = Rng(1);
    let (mut worst, mut turned) = (0.0f64, 0.0f64);
    for e in [0.95, 0.9, 0.8, 0.7, 0.5, 0.4, 0.3] {
        for at in 0..12 {
            let height = if at == 0 { 1.0 } else { 0.7 + 0.6 * rng.unit() };
            // Bounces from less than g·T/2·C_R end within a tick: such contacts rest.
            let least = G * TICK / (2.0 * e);
            let fast = |bounce: i32| (2.0 * G * height).sqrt() * f64::powi(e, bounce) > least;
            let count = (0..5).filter(|&bounce| fast(bounce)).count();
            assert!(
                count
                    == if e < 0.35 {
                        3
                    } else if e < 0.45 {
                        4
                    } else {
                        5
                    },
                "{count} of e {e}"
            );
            for shape in [rectangle(1.0, 1.0), disc(0.5)] {
                let (peaks, spin) = peaks(&shape, height, e, count);
                assert!(peaks.len() >= count, "{:?}, e {e}: {} peaks", shape.shape, peaks.len());
                for (bounce, peak) in (1..).zip(&peaks[..count]) {
                    let off = peak / (height * f64::powi(e * e, bounce)) - 1.0;
                    worst = worst.max(off.abs());
                    assert!(off.abs() < 1e-3, "{:?}, e {e}, {height} m, peak {bounce}: {off:e} off", shape.shape);
                }
                turned = turned.max(spin);
                assert!(spin <= 1e-6, "{:?}, e {e}, {height} m: {spin:e} rad/s", shape.shape);
            }
        }
    }
    println!("peaks: {worst:.1e} off at most, {turned:.1e} rad/s");
}

#[test]
fn what_bounces_without_loss_goes_on_for_a_minute() {
    for shape in [rectangle(1.0, 1.0), disc(0.5)] {
        let mut world = world(0.0, -G);
        add(&mut world, fixed(0.0, -1.0, surface(rectangle(20.0, 2.0), 0.0, 1.0)));
        let id = add(&mut world, solid(0.25, 1.5, surface(shape.clone(), 0.0, 1.0)));
        let start = energy(&world);
        let mut worst = 0.0f64;
        for _ in 0..3600 {
            world.step();
            worst = worst.max((energy(&world) / start - 1.0).abs());
            close(omega(&world, id), 0.0, 1e-6);
        }
        println!("{:?}: energy {worst:.1e} off over 60 bounces", shape.shape);
        assert!(worst < 1e-6, "{:?}: energy {worst:e} off", shape.shape);
    }
}

// Corners (GD:impulse).

/// A box that comes down onto a floor at y = 0: half of its sides, and how it starts.
struct Fall {
    half: [f64; 2],
    start: Free,
    g: f64,
}

impl Fall {
    fn random(rng: &mut Rng) -> Fall {
        let mut within = |least: f64, most: f64| least + (most - least) * rng.unit();
        let half = [within(0.2, 1.0), within(0.2, 1.0)];
        let x = [0.0, within(1.5, 3.0)];
        let start =
            Free { x, phi: within(0.0, 6.0), v: [within(-3.0, 3.0), within(-9.0, -1.0)], omega: within(-4.0, 4.0) };
        Fall { half, start, g: [0.0, -G][rng.below(2) as usize] }
    }

    /// The lowest corner at a time, from the centre, and its height.
    fn lowest(&self, state: &Free) -> ([f64; 2], f64) {
        let [x, y] = self.half;
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|corner| state.arm(corner));
        let lowest = corners.into_iter().min_by(|p, q| p[1].total_cmp(&q[1])).expect("four");
        (lowest, lowest[1] + state.x[1])
    }

    fn at(&self, t: f64) -> Free {
        self.start.after(t, [0.0, self.g])
    }

    /// When a corner meets the floor, to rounding.
    fn meets(&self) -> f64 {
        let height = |t: f64| self.lowest(&self.at(t)).1;
        let mut late = 0.0;
        while height(late) > 0.0 {
            late += 1e-3;
        }
        let mut early = late - 1e-3;
        for _ in 0..60 {
            let middle = 0.5 * (early + late);
            if height(middle) > 0.0 { early = middle } else { late = middle }
        }
        late
    }
}

#[test]
fn a_box_that_lands_on_a_corner_goes_as_the_impulse_says() {
    let mut rng = Rng(2);
    let (mut compared, mut worst, mut late) = (0, 0.0f64, 0.0f64);
    for case in 0..600 {
        let mut fall = Fall::random(&mut rng);
        // So that it lands in the middle.
        fall.start.x[0] = -fall.start.v[0] * fall.meets();
        let (e, friction) = ([1.0, 0.8, 0.5, 0.3][case % 4], [0.0, 0.3, 1.0][case % 3]);
        let mut world = world(0.0, fall.g);
        // Outlines that reach farther than 4 m touch from farther away than 1e-7 m.
        add(&mut world, fixed(0.0, -1.0, surface(rectangle(7.7, 2.0), friction, e)));
        let shape = surface(rectangle(2.0 * fall.half[0], 2.0 * fall.half[1]), friction, e);
        let Free { x, phi, v, omega } = fall.start;
        let falling = moving(solid(x[0], x[1], shape), v[0], v[1]);
        let id = add(&mut world, BodyDef { angle: turned(phi), angular_velocity: spin(omega), ..falling });
        let mass = mass_of(&get(&world, id));
        let before_all = energy(&world);
        let Hit { time, before, after } = until_struck(&mut world, &[id], &[[0.0, fall.g]]).expect("it lands");
        let told = world.collisions()[0].time.to_f64() + (world.tick() - 1) as f64 * TICK;
        let gain = energy(&world) / before_all - 1.0;
        assert!(gain < 1e-7, "case {case}: gained {gain:e} of its energy");

        // By the pose that it had: what is compared is the impulse, at the corner.
        let (corner, _) = fall.lowest(&before[0]);
        let side = Side::new(mass, &before[0], corner);
        let [want, _] = collide(side, Side::default(), [0.0, 1.0], e, friction);
        let went = Free { v: want.v, omega: want.omega, ..before[0] };
        let approach = -(before[0].v[1] + before[0].omega * corner[0]);
        // Not those that come slowly, that another corner strikes before the tick ends, or where Newton's rule would add
        // energy, which the engine does not let it.
        let rest = (world.tick() as f64 * TICK - time).max(0.0);
        let again = (1..=100).any(|part| {
            let t = rest * f64::from(part) / 100.0;
            let others = went.after(t, [0.0, fall.g]);
            t * approach > 1e-4 && fall.lowest(&others).1 < 1e-6
        });
        let (_, level) = fall.lowest(&Free { phi: before[0].phi + 1e-3, ..before[0] });
        let (_, other) = fall.lowest(&Free { phi: before[0].phi - 1e-3, ..before[0] });
        let flat = level.min(other) < -1e-3 * 1.5;
        if approach < 1.1 || again || flat || want.energy() > side.energy() {
            continue;
        }
        compared += 1;
        late = late.max((time - fall.meets()).abs() * approach);
        // Positions have 2⁻³² m.
        close(told, time, 1e-9);
        worst = worst.max(went.faster(&after[0]));
        assert!(
            went.faster(&after[0]) <= 2e-6,
            "case {case}, e {e}, friction {friction}: {:?} instead of {went:?}",
            after[0]
        );
    }
    println!("{compared} corners: {worst:.1e} m/s or rad/s off at most, {late:.1e} m from the floor");
    assert!(compared > 300, "only {compared}");
    // 1e-7 m, and what the crossing of two ways is known by.
    assert!(late < 1.1e-7, "{late:e} m from the floor");
}

#[test]
fn two_bodies_that_meet_with_a_corner_go_as_the_impulse_says() {
    // Pebbles at each other: the corner and the edge are found in f64 where they are at the time of the impact.
    let mut rng = Rng(3);
    let (mut compared, mut worst, mut spun) = (0, 0.0f64, 0.0f64);
    for case in 0..600 {
        let (e, friction) = ([1.0, 0.8, 0.5, 0.3][case % 4], [0.0, 0.0, 0.6][case % 3]);
        let mut world = world(0.0, 0.0);
        let mut ids = Vec::new();
        for side in [-1.0, 1.0] {
            let mut within = |most: f64| (2.0 * rng.unit() - 1.0) * most;
            let (x, y, omega) = (2.0 * side, within(0.4), within(4.0));
            let (vx, vy, angle) = (-5.0 * side + within(3.0), within(0.5), within(3.0));
            let body = moving(solid(x, y, surface(pebble(&mut rng), friction, e)), vx, vy);
            let body = weighing(body, rng.scale(0.1, 10.0));
            ids.push(add(&mut world, BodyDef { angle: turned(angle), angular_velocity: spin(omega), ..body }));
        }
        let masses = [0, 1].map(|at| mass_of(&get(&world, ids[at])));
        let outlines = [0, 1].map(|at| local(&world, ids[at]));
        let kinetic = energy(&world);
        let Some(Hit { before, after, .. }) = until_struck(&mut world, &ids, &[[0.0; 2]; 2]) else { continue };
        let gain = energy(&world) / kinetic - 1.0;
        assert!(gain < 1e-9, "case {case}: gained {gain:e} of its energy");
        let Some((owner, point, n)) = touching([0, 1].map(|at| place(&before[at], &outlines[at]))) else { continue };
        // a owns the vertex; n is from b to a.
        let order = [owner, 1 - owner];
        let sides = order
            .map(|at| Side::new(masses[at], &before[at], [point[0] - before[at].x[0], point[1] - before[at].x[1]]));
        let want = collide(sides[0], sides[1], n, e, friction);
        let lost = sides.iter().map(Side::energy).sum::<f64>() - want.iter().map(Side::energy).sum::<f64>();
        if lost < 0.0 || approach(&sides, n) < 1.1 {
            continue;
        }
        // A second meeting within the tick is another impact: then the ways of the two cross at different times.
        let (off, turn) = order.iter().zip(&want).fold((0.0f64, 0.0f64), |(off, turn), (&at, want)| {
            let Free { v, omega, .. } = after[at];
            let line = (v[0] - want.v[0]).abs().max((v[1] - want.v[1]).abs());
            (off.max(line), turn.max((omega - want.omega).abs()))
        });
        compared += 1;
        (worst, spun) = (worst.max(off), spun.max(turn));
        assert!(
            off <= 2e-6 && turn <= 2e-6,
            "case {case}, e {e}, friction {friction}: {off:e} m/s, {turn:e} rad/s off"
        );
    }
    println!("{compared} meetings: {worst:.1e} m/s, {spun:.1e} rad/s off at most");
    assert!(compared > 300, "only {compared}");
}

/// The corners of a body's only collider, a polygon, from its centre of mass.
fn local(world: &World, id: BodyId) -> Vec<[f64; 2]> {
    let (def, center) = (get(world, id).def(), get(world, id).def().center.expect("given out").to_f64());
    let tamias2d::Shape::Polygon { vertices } = &def.colliders[0].shape else { unreachable!("a polygon") };
    let corner = |v: &tamias2d::Vec2<tamias2d::Length>| {
        let (x, y) = v.to_f64();
        [x - center.0, y - center.1]
    };
    vertices.iter().map(corner).collect()
}

fn place(state: &Free, local: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let put = |&corner: &[f64; 2]| {
        let [x, y] = state.arm(corner);
        [x + state.x[0], y + state.x[1]]
    };
    local.iter().map(put).collect()
}

/// Where two polygons that just touch do so: whose the vertex is, the vertex, and the normal to its owner. None if they
/// do not touch, or if a second vertex is nearly as near (an edge on an edge) or another edge nearly as far.
fn touching(polygons: [Vec<[f64; 2]>; 2]) -> Option<(usize, [f64; 2], [f64; 2])> {
    let mut axes = Vec::new();
    for owner in [0, 1] {
        let (edges, others) = (&polygons[1 - owner], &polygons[owner]);
        for (at, p) in edges.iter().enumerate() {
            let q = edges[(at + 1) % edges.len()];
            let (edge, long) = ([q[0] - p[0], q[1] - p[1]], (q[0] - p[0]).hypot(q[1] - p[1]));
            let n = [edge[1] / long, -edge[0] / long];
            let mut heights: Vec<(f64, [f64; 2])> =
                others.iter().map(|v| ((v[0] - p[0]) * n[0] + (v[1] - p[1]) * n[1], *v)).collect();
            heights.sort_by(|v, w| v.0.total_cmp(&w.0));
            axes.push((heights[0].0, heights[1].0 - heights[0].0, owner, heights[0].1, n));
        }
    }
    axes.sort_by(|v, w| w.0.total_cmp(&v.0));
    let (separation, level, owner, vertex, n) = axes[0];
    let clear = separation.abs() < 1e-6 && level > 1e-4 && axes[1].0 < -1e-4;
    clear.then_some((owner, vertex, n))
}

fn approach(sides: &[Side; 2], n: [f64; 2]) -> f64 {
    let [a, b] = sides.map(|Side { v, omega, arm, .. }| [v[0] - omega * arm[1], v[1] + omega * arm[0]]);
    (b[0] - a[0]) * n[0] + (b[1] - a[1]) * n[1]
}

#[test]
fn ve1_happens_between_two_polygons() {
    // A's corner (1, −1) comes down on B's upper edge at (−1, 1), as the requirements' table has it, `early` seconds later.
    let upper = [(1.0, -1.0), (2.0, 0.8), (-1.0, 1.0)];
    let lower = [(-2.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (2.0, 1.0)];
    let table = [
        (0.0, -3.0, 10.0 / 3.0, 0.0, -1.0 / 3.0),
        (0.5, -2.0, 4.0, -0.5, 0.0),
        (1.0, -1.0, 14.0 / 3.0, -1.0, 1.0 / 3.0),
    ];
    let mut worst = 0.0f64;
    for (e, va, wa, vb, wb) in table {
        for phase in 0..20 {
            let early = TICK * (0.3 + 0.317 * f64::from(phase));
            let mut world = world(0.0, 0.0);
            let mut put =
                |corners: &[(f64, f64)], mass: &str, inertia: &str, (x, y): (f64, f64), v: f64, omega: f64| {
                    let def = solid(x, y - v * early, surface(polygon(corners), 0.0, e));
                    let def = BodyDef { mass: Some(num(mass)), inertia: Some(num(inertia)), ..moving(def, 0.0, v) };
                    add(&mut world, BodyDef { angle: turned(-omega * early), angular_velocity: spin(omega), ..def })
                };
            let ids = [put(&upper, "2", "3", (-1.0, 1.0), -5.0, 2.0), put(&lower, "4", "6", (1.0, -1.0), 1.0, -1.0)];
            let Hit { time, after, .. } = until_struck(&mut world, &ids, &[[0.0; 2]; 2]).expect("they meet");
            // 1e-7 m, at 5 m/s.
            close(time, early, 3e-8);
            for (got, (v, omega)) in after.iter().zip([(va, wa), (vb, wb)]) {
                let off = got.faster(&Free { v: [0.0, v], omega, ..*got });
                worst = worst.max(off);
                assert!(off <= 2e-6, "e {e}, {early} s early: {got:?} for v {v}, ω {omega}");
            }
        }
    }
    println!("VE1: {worst:.1e} m/s or rad/s off at most");
}

#[test]
fn ve3_a_flat_box_bounces_flat() {
    let mut rng = Rng(4);
    for (e, friction) in [(1.0, 0.0), (1.0, 0.6), (0.5, 0.0), (0.5, 0.6)] {
        for _ in 0..40 {
            let mut world = world(0.0, 0.0);
            add(&mut world, fixed(0.0, -1.0, surface(rectangle(20.0, 2.0), friction, e)));
            let falling = solid(rng.unit(), 0.5 + rng.scale(1e-4, 1.0), surface(rectangle(1.0, 1.0), friction, e));
            let id = add(&mut world, moving(weighing(falling, 1.0), 0.0, -3.0));
            run(&mut world, 40);
            close2(velocity(&world, id), (0.0, 3.0 * e), 2e-6);
            close(omega(&world, id), 0.0, 2e-6);
        }
    }
}

// Head-on (Table 4).

#[test]
fn flat_faces_that_meet_head_on_exchange_what_the_formula_says() {
    let mut rng = Rng(5);
    let mut worst = 0.0f64;
    // Masses, velocities, e, velocities after.
    for (masses, [va, vb], e, want) in [
        ([1.0, 3.0], [1.0, -1.0], 1.0, [-2.0, 0.0]),
        ([56.2, 56.2], [2.51, 0.0], 0.8, [0.251, 2.259]),
        ([56.2, 56.2], [2.51, 0.0], 1.0, [0.0, 2.51]),
        ([56.2, 56.2], [2.51, 0.0], 0.0, [1.255, 1.255]),
    ] {
        for friction in [0.0, 0.6] {
            for shape in [rectangle(1.0, 1.0), disc(0.5)] {
                for _ in 0..40 {
                    let mut world = world(0.0, 0.0);
                    let shape = surface(shape.clone(), friction, e);
                    let gap = rng.scale(1e-3, 1.0);
                    let a = moving(weighing(solid(-1.0 - gap, 0.0, shape.clone()), masses[0]), va, 0.0);
                    let b = moving(weighing(solid(0.0, 0.0, shape), masses[1]), vb, 0.0);
                    let ids = [add(&mut world, a), add(&mut world, b)];
                    run(&mut world, 70);
                    for (id, want) in ids.into_iter().zip(want) {
                        let state = Free::of(&world, id);
                        let off = state.faster(&Free { v: [want, 0.0], omega: 0.0, ..state });
                        worst = worst.max(off);
                        assert!(off <= 2e-6, "{masses:?} kg, e {e}, gap {gap}: {state:?} for {want}");
                    }
                }
            }
        }
    }
    println!("head-on: {worst:.1e} m/s or rad/s off at most");
}

/// Energy that a body's turning gives to its line is none that grows, however hard the body is to turn.
#[test]
fn what_is_hard_to_turn_bounces_and_rubs_as_its_coefficients_say() {
    for inertia in [1.0, 1e3, 1e6, 1e9] {
        let mut world = world(0.0, 0.0);
        let shape = surface(disc(0.5), 0.3, 1.0);
        let wheel = BodyDef {
            mass: Some(num("1")),
            inertia: Some(Inertia::from_f64(inertia).expect("in range")),
            angular_velocity: num("20"),
            ..solid(0.0, 0.0, shape.clone())
        };
        let wheel = add(&mut world, wheel);
        let ball = add(&mut world, moving(weighing(solid(1.2, 0.0, shape), 1.0), -5.0, 0.0));
        run(&mut world, 6);
        // 5 N s along the normal, 0.3 of that across: the rim goes at 10 m/s, and is not stopped by it.
        close2(velocity(&world, wheel), (-5.0, -1.5), 1e-6);
        close2(velocity(&world, ball), (0.0, 1.5), 1e-6);
        close(omega(&world, wheel), 20.0 - 0.75 / inertia, 1e-6);
    }
}

// Acceptance cases with a time.

#[test]
fn tc10c_the_driven_boxes_reverse_at_their_time() {
    let contact = 20f64.sqrt();
    for unit_shift in [0, 6] {
        let mut world = scaled_world(0.0, 0.0, unit_shift);
        let mut driven = |x: f64, side: f64, force: f64| {
            let body = weighing(solid(x, 50.0, surface(rectangle(side, side), 0.0, 1.0)), 100.0);
            add(&mut world, BodyDef { force: newtons(force, 0.0), ..body })
        };
        let ids = [driven(0.0, 300.0, 500.0), driven(300.0, 100.0, -500.0)];
        let accelerations = [[5.0, 0.0], [-5.0, 0.0]];
        let Hit { time, before, after } = until_struck(&mut world, &ids, &accelerations).expect("they meet");
        println!("TC10c, unit shift {unit_shift}: t_c {:.1e} s off", time - contact);
        for (at, side) in [(0, 1.0), (1, -1.0)] {
            close2((before[at].v[0], before[at].v[1]), (side * 22.360_68, 0.0), 3e-6);
            close2((after[at].v[0], after[at].v[1]), (-before[at].v[0], 0.0), 2e-6);
            close(after[at].omega, 0.0, 1e-12);
        }
        close(time, contact, 1e-7);
        while world.tick() < 537 {
            world.step();
            let t = world.tick() as f64 * TICK - 2.0 * contact;
            for (id, x, side) in [(ids[0], 0.0, 1.0), (ids[1], 300.0, -1.0)] {
                let state = Free::of(&world, id);
                close2((state.v[0], state.v[1]), (side * 5.0 * t, 0.0), 2e-6);
                close2((state.x[0], state.x[1]), (x + side * 2.5 * t * t, 50.0), 2e-5);
                close(state.omega, 0.0, 1e-12);
            }
        }
    }
}

#[test]
fn tc11c_the_box_reverses_at_its_time() {
    let contact = (2.0 * 100.0 / 9.8f64).sqrt();
    // Without restitution rows stop what is slower than 2^6 m/s where the unit is 2^6 m, within their resolution and slop.
    for (e, unit_shift, still, near) in
        [(1.0, 0, 2e-6, 1e-4), (1.0, 6, 2e-6, 1e-4), (0.0, 0, 2e-6, 1e-4), (0.0, 6, 64e-4, 64e-4)]
    {
        let mut world = scaled_world(0.0, 9.8, unit_shift);
        add(&mut world, fixed(0.0, 560.0, surface(rectangle(800.0, 100.0), 0.6, e)));
        let id = add(&mut world, weighing(solid(0.0, 260.0, surface(rectangle(300.0, 300.0), 0.6, e)), 100.0));
        let start = energy(&world);
        if e == 0.0 {
            run(&mut world, 272);
            close2(velocity(&world, id), (0.0, 0.0), still);
            close2(position(&world, id), (0.0, 360.0), near);
            continue;
        }
        let Hit { time, before, after } = until_struck(&mut world, &[id], &[[0.0, 9.8]]).expect("it lands");
        println!("TC11c, unit shift {unit_shift}: t_c {:.1e} s off", time - contact);
        close(time, 4.517_540, 1e-6);
        close2((before[0].v[0], before[0].v[1]), (0.0, 44.271_887), 3e-6);
        close2((after[0].v[0], after[0].v[1]), (0.0, -before[0].v[1]), 2e-6);
        // KE + PE, of the energy of the fall.
        let fall = 100.0 * 9.8 * 100.0;
        while world.tick() < 3000 {
            world.step();
            close((energy(&world) - start) / fall, 0.0, 1e-7);
            close(omega(&world, id), 0.0, 1e-9);
        }
    }
}

// A gas (properties of a correct solution: no systematic gain).

/// What became of 200 polygons in a closed room.
struct Gas {
    /// Of the energy, at the end and at most.
    end: f64,
    worst: f64,
    overlap: f64,
}

/// 200 polygons at up to ±10 m/s in a closed room of 40 m, elastic and without friction.
fn gas(seed: u64, gravity: f64, ticks: u32) -> Gas {
    let (mut world, mut rng) = (world(0.0, gravity), Rng(seed));
    wall_in(&mut world, 20.0, 0.0, 1.0);
    scatter(&mut world, 200, 10.0, &mut rng, |rng| body(pebble(rng), 0.0, 1.0));
    // PE counts from the floor.
    let weight = world.bodies().filter(|body| body.kind() == BodyKind::Dynamic).map(|body| body.mass().to_f64());
    let base = weight.sum::<f64>() * -gravity * 20.0;
    let total = |world: &World| energy(world) + base;
    let start = total(&world);
    let mut gas = Gas { end: 0.0, worst: 0.0, overlap: 0.0 };
    for tick in 1..=ticks {
        world.step();
        if tick % 5 == 0 || tick == ticks {
            gas.overlap = gas.overlap.max(worst_overlap(&world));
            gas.end = total(&world) / start - 1.0;
            gas.worst = gas.worst.max(gas.end.abs());
            // One that is crammed into itself takes minutes.
            assert!(world.status().is_clear(), "seed {seed}, tick {tick}: {:?}", world.status());
        }
    }
    world.check().expect("every invariant holds");
    gas
}

/// Runs a gas of each seed, and the mean of the changes of energy.
fn gases(seeds: u64, gravity: f64, ticks: u32, budget: f64) -> f64 {
    let mut sum = 0.0;
    for seed in 1..=seeds {
        let begin = std::time::Instant::now();
        let Gas { end, worst, overlap } = gas(seed, gravity, ticks);
        let took = begin.elapsed().as_secs_f64();
        println!("seed {seed}, g {gravity}: {end:+.1e} (at most {worst:.1e}), overlap {overlap:.1e} m, {took:.1} s");
        assert!(worst < budget, "seed {seed}: {worst:e} of the energy");
        assert!(overlap < 1e-5, "seed {seed}: they overlap by {overlap} m");
        sum += end;
    }
    sum / seeds as f64
}

#[test]
fn an_elastic_gas_keeps_its_energy_for_a_while() {
    let mean = gases(2, 0.0, 1200, 1e-5);
    assert!(mean.abs() < 1e-6, "{mean:e}");
    gases(1, -G, 600, 1e-4);
}

#[test]
#[ignore = "half a minute: cargo test --release --test impacts -- --ignored"]
fn an_elastic_gas_keeps_its_energy() {
    let mean = gases(10, 0.0, 10_000, 1e-5);
    println!("mean {mean:+.1e}");
    assert!(mean.abs() < 1e-6, "ten gases drift by {mean:e}");
}

#[test]
fn an_elastic_gas_in_gravity_keeps_its_energy() {
    // The slower of two points that are nearly one, answered with the other, once took 5e-4 of it (seed 1, tick 8254).
    gases(3, -G, 10_000, 1e-7);
}

#[test]
fn copies_of_a_world_have_no_collisions() {
    let mut world = world(0.0, 0.0);
    add(&mut world, fixed(0.0, 0.0, surface(rectangle(1.0, 1.0), 0.0, 1.0)));
    add(&mut world, moving(solid(1.1, 0.0, surface(rectangle(1.0, 1.0), 0.0, 1.0)), -30.0, 0.0));
    let start = world.clone();
    world.step();
    assert_eq!(world.collisions().len(), 1);
    assert!(world.clone().collisions().is_empty());
    world.clone_from(&start);
    assert!(world.collisions().is_empty());
    world.step();
    assert_eq!(world.collisions().len(), 1);
}

/// More happens in a tick than it has room for, to none of them so often that it would be said of that one.
#[test]
fn of_all_that_meet_too_often_together_it_is_said() {
    let mut world = World::new(&WorldDef::default()).expect("accepted");
    wall_in(&mut world, 3.5, 0.0, 1.0);
    let mut rng = Rng(5);
    let ids: Vec<BodyId> = (0..36)
        .map(|at| {
            let [x, y] = [at % 6, at / 6].map(|at| 1.1 * f64::from(at) - 2.75);
            let (sin, cos) = (6.3 * rng.unit()).sin_cos();
            add(&mut world, moving(solid(x, y, surface(disc(0.3), 0.0, 1.0)), 2e4 * cos, 2e4 * sin))
        })
        .collect();
    world.step();
    // The first body of each bound is named.
    let said: Vec<Bound> = world.status().entries().iter().map(|entry| entry.bound).collect();
    assert!(said.contains(&Bound::Impacts), "{} bodies: {said:?}", ids.len());
}
