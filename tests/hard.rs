//! Scenes that are hard to keep standing, each with a bar: heavy on light, tall, thin, deep, far, fast, and long.
//!
//! What takes more than some seconds, or is not held yet, is ignored with its figure:
//! `cargo test --release --test hard -- --ignored --nocapture`.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, disc, phi, position, rectangle, run, vel, velocity, world};
use scenes::{Scene, floor, heavy_top, tower};
use solid::{
    add, bits, energy, fastest, fixed, moving, polygon, solid, spin, surface, turned, weighing, worst_overlap,
};
use tamias2d::{BodyDef, BodyId, BodyKind, ColliderDef, Commands, Length, Vec2, World};

/// What was seen of a scene, metres and seconds.
#[derive(Debug)]
struct Seen {
    /// How far a body went down, at any second.
    down: f64,
    /// How far one went sideways, and how far after the first two seconds.
    side: f64,
    late: f64,
    /// How far one turned, radians.
    turned: f64,
    /// The kinetic energy of the last seconds at most, as a part of what the scene weighs times its height.
    motion: f64,
    /// How far total energy rose above the least that it had been, as the same part.
    gain: f64,
    overlap: f64,
}

/// Kinetic energy, in J.
fn motion(world: &World) -> f64 {
    world.bodies().map(|body| body.kinetic_energy().to_f64()).sum()
}

/// Watches for some seconds.
fn watch(name: &str, (world, ids): &mut Scene, seconds: u32) -> Seen {
    let places = |world: &World| ids.iter().map(|&id| (position(world, id), phi(world, id))).collect::<Vec<_>>();
    let start = places(world);
    let mut settled = start.clone();
    let weight: f64 = world.bodies().map(|body| body.def().mass.map_or(0.0, |mass| mass.to_f64())).sum();
    let height = ids.iter().map(|&id| position(world, id).1).fold(1.0, f64::max);
    let scale = weight * 9.81 * height;
    let (mut least, mut gain) = (energy(world), 0.0f64);
    let mut seen = Seen { down: 0.0, side: 0.0, late: 0.0, turned: 0.0, motion: 0.0, gain: 0.0, overlap: 0.0 };
    for second in 1..=seconds {
        for _ in 0..60 {
            world.step();
            if ids.len() < 100 {
                let now = energy(world);
                gain = gain.max(now - least);
                least = least.min(now);
            }
        }
        for ((now, start), settled) in places(world).iter().zip(&start).zip(&settled) {
            seen.down = seen.down.max(start.0.1 - now.0.1);
            seen.side = seen.side.max((now.0.0 - start.0.0).abs());
            seen.turned = seen.turned.max((now.1 - start.1).abs());
            seen.late = seen.late.max(if second > 2 { (now.0.0 - settled.0.0).abs() } else { 0.0 });
        }
        if second == 2 {
            settled = places(world);
        }
        if second > seconds - 3 {
            seen.motion = seen.motion.max(motion(world) / scale);
        }
    }
    world.check().expect("every invariant holds");
    (seen.gain, seen.overlap) = (gain / scale, worst_overlap(world));
    println!(
        "{name}: down {:.5}, sideways {:.1e}, after 2 s {:.1e}, turned {:.1e}; motion {:.1e}, gain {:.1e}; overlap {:.5}",
        seen.down, seen.side, seen.late, seen.turned, seen.motion, seen.gain, seen.overlap
    );
    seen
}

/// Kinetic energy at rest, of weight times height.
const REST: f64 = 1e-9;

/// Bars of what stands: down, sideways, and at rest.
#[track_caller]
fn stands(name: &str, scene: &mut Scene, seconds: u32, down: f64, side: f64) -> Seen {
    let seen = watch(name, scene, seconds);
    assert!(seen.down < down, "{name}: {} m down", seen.down);
    assert!(seen.side < side, "{name}: {} m sideways", seen.side);
    assert!(seen.motion <= REST, "{name}: it moves still: {:e}", seen.motion);
    assert!(seen.gain < 1e-3, "{name}: it gained {:e} of its energy", seen.gain);
    seen
}

// Heavy on light.

#[test]
fn a_thousand_kilograms_stand_on_one() {
    stands("1000 kg on 1 kg", &mut heavy_top(2, 1000.0), 60, 0.02, 1e-3);
}

#[test]
fn a_stack_of_10_bears_a_top_of_a_hundred_times() {
    stands("100 kg on 9 of 1 kg", &mut heavy_top(10, 100.0), 60, 0.02, 5e-3);
}

#[test]
fn heavy_tops_that_are_not_quite_central_stand() {
    for seed in 1..=4 {
        let masses = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 100.0];
        stands(&format!("100 kg on 9, ± 1 cm, seed {seed}"), &mut tower(&masses, 0.01, seed), 20, 0.02, 0.03);
        stands(&format!("1000 kg on 1, ± 1 cm, seed {seed}"), &mut tower(&[1.0, 1000.0], 0.01, seed), 20, 0.02, 5e-3);
    }
}

#[test]
fn light_under_heavy_in_a_chain_stands() {
    stands(
        "1, 1000, 1, 100, 1, 10, 500",
        &mut tower(&[1.0, 1000.0, 1.0, 100.0, 1.0, 10.0, 500.0], 0.0, 1),
        60,
        0.02,
        5e-3,
    );
}

#[test]
fn a_box_of_20_m_stands_on_two_of_1_m() {
    stands("400 kg on two of 1 kg", &mut scenes::table(), 60, 0.02, 5e-3);
}

#[test]
fn three_thousand_kilograms_stand_on_one() {
    stands("3000 kg on 1 kg", &mut heavy_top(2, 3000.0), 20, 0.02, 1e-3);
}

/// A box of `mass` kg, 4 m wide, on light boxes four deep.
fn loaded_bed(columns: u32, rows: u32, mass: f64) -> Scene {
    let (mut world, mut ids) = (floor(), Vec::new());
    for row in 0..rows {
        for column in 0..columns {
            let x = f64::from(column) - f64::from(columns - 1) * 0.5;
            ids.push(add(&mut world, solid(x, f64::from(row) + 0.5, rectangle(1.0, 1.0))));
        }
    }
    let width = f64::from(columns);
    ids.push(add(&mut world, weighing(solid(0.0, f64::from(rows) + 0.5, rectangle(width, 1.0)), mass)));
    (world, ids)
}

#[test]
fn a_heavy_lid_on_a_bed_of_light_boxes_stands() {
    // Sideways while the load comes onto it, in the first ticks: 2.2 cm; 0.6 to 2.4 as details of the solve changed.
    stands("2000 kg on 4 by 4", &mut loaded_bed(4, 4, 2000.0), 20, 0.02, 0.03);
}

#[test]
#[ignore = "not held: 7.2 cm down, more contacts than a direct solve takes: cargo test --release --test hard -- --ignored a_heavy_lid"]
fn a_heavy_lid_on_a_large_bed_of_light_boxes_stands() {
    // More contacts than a direct solve takes.
    stands("5000 kg on 10 by 6", &mut loaded_bed(10, 6, 5000.0), 20, 0.02, 0.03);
}

/// A pile at rest, and a box of 2 m and 400 kg that falls on it. The greatest overlap after the landing, the later one,
/// and how fast it flies up.
fn drop_on_a_pile(seed: u64) -> [f64; 3] {
    let (mut world, _) = scenes::pile(200, 9.0, seed);
    run(&mut world, 600);
    let top = world.bodies().filter(|body| body.kind() == BodyKind::Dynamic);
    let top = top.map(|body| body.position().to_f64().1).fold(0.0, f64::max);
    let id = add(&mut world, weighing(solid(0.0, top + 3.0, rectangle(2.0, 2.0)), 400.0));
    let (mut worst, mut up) = (0.0f64, 0.0f64);
    for tick in 0..600 {
        world.step();
        up = up.max(velocity(&world, id).1);
        if tick % 5 == 0 {
            worst = worst.max(worst_overlap(&world));
        }
    }
    let late = worst_overlap(&world);
    println!("400 kg on a pile, seed {seed}: overlap {worst:.4} m, {late:.4} m later, up at {up:.2} m/s");
    world.check().expect("every invariant holds");
    [worst, late, up]
}

#[test]
#[ignore = "not held: 15 to 26 cm of overlap on landing and 1 to 5 cm later, seed 1 by chance of details: cargo test --release --test hard -- --ignored four_hundred"]
fn four_hundred_kilograms_dropped_on_a_pile_do_not_sink_in() {
    for seed in 1..=3 {
        let [worst, late, up] = drop_on_a_pile(seed);
        assert!(worst < 0.05, "seed {seed}: {worst} m of overlap");
        assert!(late < 0.02, "seed {seed}: {late} m of overlap later");
        assert!(up < 2.0, "seed {seed}: it flies up at {up} m/s");
    }
}

// Tall and wide.

#[test]
fn stacks_of_20_stand_a_minute() {
    for (offset, seed) in [(0.0, 1), (0.01, 1), (0.01, 2)] {
        stands(&format!("stack of 20, ± {offset}, seed {seed}"), &mut tower(&[1.0; 20], offset, seed), 60, 0.02, 0.02);
    }
}

#[test]
fn stacks_of_50_stand_a_minute() {
    for (offset, seed) in [(0.0, 1), (0.01, 1), (0.01, 2)] {
        stands(&format!("stack of 50, ± {offset}, seed {seed}"), &mut tower(&[1.0; 50], offset, seed), 60, 0.02, 0.02);
    }
}

#[test]
fn a_pyramid_40_wide_stands_a_minute() {
    stands("pyramid of 40", &mut scenes::pyramid(40), 60, 0.05, 0.02);
}

#[test]
#[ignore = "not held: rows of 100 go 10 cm sideways before they rest, 5 cm allowed; takes a minute: cargo test --release --test hard -- --ignored pyramid"]
fn a_pyramid_100_wide_stands_a_minute() {
    stands("pyramid of 100", &mut scenes::pyramid(100), 60, 0.25, 0.05);
}

#[test]
fn a_house_of_cards_stands() {
    stands("card house", &mut scenes::card_house(), 30, 0.03, 0.03);
}

#[test]
fn an_arch_stands() {
    // 21 stones, each of which yields as soft rows do: 5.3 cm of 15 m.
    stands("arch", &mut scenes::arch(), 60, 0.06, 0.05);
}

#[test]
fn dominoes_fall_one_after_the_other() {
    let (mut world, ids) = scenes::dominoes();
    let mut fell = vec![None; ids.len()];
    for tick in 0..900 {
        world.step();
        for (at, &id) in ids.iter().enumerate() {
            if fell[at].is_none() && phi(&world, id).abs() > 0.5 {
                fell[at] = Some(tick);
            }
        }
    }
    println!("dominoes: {fell:?}, {:.1e} m/s", fastest(&world));
    let ticks: Vec<u32> = fell.into_iter().map(|tick| tick.expect("every one falls")).collect();
    assert!(ticks.is_sorted(), "in order: {ticks:?}");
    assert!(fastest(&world) < 1e-3, "at rest: {}", fastest(&world));
}

#[test]
fn what_hangs_over_a_cliff_stays_if_its_centre_does() {
    for (over, stays) in [(-0.01, true), (-0.001, true), (0.001, false), (0.01, false)] {
        let mut world = world(0.0, -9.81);
        add(&mut world, fixed(-50.0, 4.5, rectangle(100.0, 1.0)));
        let id = add(&mut world, solid(over, 5.5, rectangle(1.0, 1.0)));
        run(&mut world, 1200);
        let y = position(&world, id).1;
        println!("centre {over} m over the edge: y {y:.3}");
        assert_eq!((y - 5.5).abs() < 1e-2, stays, "centre {over} m over the edge: at {y} m");
    }
}

#[test]
fn planks_hang_over_a_cliff_as_far_as_the_harmonic_series_lets_them() {
    let (mut world, mut ids) = (floor(), Vec::new());
    add(&mut world, fixed(-50.0, 2.0, rectangle(100.0, 4.0)));
    for row in 0..6 {
        // The planks from this one down reach 1/2, 1/4, 1/6 … of a length beyond what is below them: 96 % of that.
        let reach: f64 = (6 - row..=6).map(|at| 0.48 / f64::from(at)).sum();
        ids.push(add(&mut world, solid(reach - 0.5, 4.05 + 0.1 * f64::from(row), rectangle(1.0, 0.1))));
    }
    stands("planks over a cliff", &mut (world, ids), 30, 0.01, 0.01);
}

// Small, large, thin.

#[test]
fn stacks_of_1_cm_and_of_100_m_stand() {
    for (size, rows) in [(0.01, 5), (100.0, 5)] {
        let (mut world, mut ids) = (world(0.0, -9.81), Vec::new());
        add(&mut world, fixed(0.0, -size * 2.0, rectangle(size * 40.0, size * 4.0)));
        for row in 0..rows {
            ids.push(add(&mut world, solid(0.0, (f64::from(row) + 0.5) * size, rectangle(size, size))));
        }
        // What a row yields does not depend on size: 1.5 mm in all.
        let bar = (size * 0.02f64).max(2e-3);
        stands(&format!("{rows} boxes of {size} m"), &mut (world, ids), 30, bar, bar);
    }
}

#[test]
fn a_box_of_1_cm_bears_100_m_and_lies_on_it() {
    // Two feet of 1 m and 1 cm on it, all of 1 kg/m²: 10 000 kg on 1 kg each.
    let (mut world, mut ids) = (floor(), Vec::new());
    for x in [-45.0, 45.0] {
        ids.push(add(&mut world, solid(x, 0.5, rectangle(1.0, 1.0))));
    }
    ids.push(add(&mut world, solid(0.0, 51.0, rectangle(100.0, 100.0))));
    ids.push(add(&mut world, solid(3.0, 101.005, rectangle(0.01, 0.01))));
    stands("100 m on two of 1 m, 1 cm on it", &mut (world, ids), 30, 0.02, 5e-3);
}

#[test]
fn needles_come_to_rest_and_do_not_cross() {
    let (mut world, ids) = scenes::needles(40);
    run(&mut world, 1200);
    let (overlap, speed) = (worst_overlap(&world), fastest(&world));
    let lowest = ids.iter().map(|&id| position(&world, id).1).fold(f64::INFINITY, f64::min);
    println!("needles: overlap {overlap:.5} m, {speed:.1e} m/s, lowest {lowest:.4}");
    assert!(lowest > 0.0, "one fell through the floor: {lowest}");
    assert!(overlap < 0.005, "{overlap} m of 0.01 m");
    assert!(speed < 1e-3, "{speed} m/s");
}

// Pressed.

/// The greatest speed upward, and how far total energy rose above its least, of that least.
fn recover(name: &str, (world, ids): &mut Scene) -> (f64, f64) {
    let (mut up, mut least, mut gain) = (0.0f64, energy(world), 0.0f64);
    let weight: f64 = world.bodies().map(|body| body.def().mass.map_or(0.0, |mass| mass.to_f64())).sum();
    for _ in 0..900 {
        world.step();
        up = ids.iter().fold(up, |up, &id| up.max(velocity(world, id).1));
        let now = energy(world);
        gain = gain.max(now - least);
        least = least.min(now);
    }
    // What lifting everything to its place needs is not from nowhere: it is what the overlap stored.
    let (overlap, speed) = (worst_overlap(world), fastest(world));
    let top = ids.iter().map(|&id| position(world, id).1).fold(0.0, f64::max);
    println!(
        "{name}: up at {up:.2} m/s, energy + {gain:.1} J of {least:.0} J on {weight:.0} kg, overlap {overlap:.5} m, {speed:.1e} m/s, top at {top:.3}"
    );
    world.check().expect("every invariant holds");
    (up, overlap)
}

#[test]
fn overlaps_of_a_quarter_at_the_start_come_apart_without_a_pop() {
    let mut scene = scenes::overlapping(10, 0.25);
    let (up, overlap) = recover("10 boxes, a quarter inside", &mut scene);
    let top = position(&scene.0, scene.1[9]).1;
    assert!(up < 4.5, "{up} m/s");
    assert!(overlap < 0.02, "{overlap} m");
    assert!((top - 9.5).abs() < 0.05, "they stand on each other: the top is at {top}");
}

#[test]
fn boxes_in_one_place_come_apart() {
    let (up, overlap) = recover("6 boxes in one place", &mut scenes::overlapping(6, 1.0));
    assert!(up < 4.5, "{up} m/s");
    assert!(overlap < 0.02, "{overlap} m");
}

/// A kinematic wall presses three bodies against a static one, into a third of the room that they need, and goes back.
fn press_and_release(kinds: &[ColliderDef]) {
    for kind in kinds {
        let mut world = floor();
        add(&mut world, fixed(5.0, 2.0, rectangle(1.0, 6.0)));
        let press = BodyDef { kind: BodyKind::Kinematic, ..solid(-1.0, 2.0, rectangle(1.0, 5.0)) };
        let press = add(&mut world, moving(press, 0.5, 0.0));
        let ids = [0.5, 1.6, 2.7].map(|x| add(&mut world, solid(x, 0.5, kind.clone())));
        let mut worst = 0.0f64;
        for tick in 0..1200 {
            if tick == 480 {
                world.set_velocity(press, vel(-0.5, 0.0)).expect("accepted");
            }
            world.step();
            worst = worst.max(fastest(&world));
        }
        let (overlap, speed) = (worst_overlap(&world), fastest(&world));
        println!("pressed: {worst:.2} m/s at most; later overlap {overlap:.5} m, {speed:.1e}");
        assert!(worst < 8.0, "{worst} m/s");
        assert!(overlap < 0.02, "{overlap} m");
        assert!(ids.iter().all(|&id| position(&world, id).1 > 0.0), "none fell through the floor");
        world.check().expect("every invariant holds");
    }
}

#[test]
fn boxes_that_a_kinematic_wall_presses_against_a_static_one_do_not_explode() {
    press_and_release(&[rectangle(1.0, 1.0)]);
}

#[test]
fn discs_and_triangles_that_a_kinematic_wall_presses_do_not_explode() {
    press_and_release(&[disc(0.5), polygon(&[(-0.5, -0.4), (0.5, -0.4), (0.0, 0.5)])]);
}

#[test]
fn discs_in_a_room_that_is_too_small_stay_in_it_and_come_to_rest() {
    let mut scene = scenes::confined();
    for _ in 0..1200 {
        scene.0.step();
    }
    let (speed, overlap) = (fastest(&scene.0), worst_overlap(&scene.0));
    println!("confined: overlap {overlap:.4} m, {speed:.1e} m/s");
    for &id in &scene.1 {
        let (x, y) = position(&scene.0, id);
        assert!(x.abs() < 10.0 && (0.5..20.5).contains(&y), "one got out: {x}, {y}");
    }
    assert!(speed < 0.01, "{speed} m/s");
}

// Fast.

#[test]
fn what_spins_at_the_limit_lands_and_gains_nothing() {
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(0.0, -1.0, rectangle(16_000.0, 2.0)));
    let ids: Vec<BodyId> = [(disc(0.01), 32_767.0), (rectangle(0.02, 0.02), -32_767.0), (rectangle(1.0, 0.5), 799.0)]
        .into_iter()
        .enumerate()
        .map(|(at, (shape, omega))| {
            let body = solid(at as f64 * 30.0 - 30.0, 1.5, shape);
            add(&mut world, BodyDef { angular_velocity: spin(omega), ..body })
        })
        .collect();
    let (start, mut most) = (energy(&world), 0.0f64);
    for _ in 0..900 {
        world.step();
        most = most.max(energy(&world) - start);
    }
    world.check().expect("every invariant holds");
    let places: Vec<(f64, f64)> = ids.iter().map(|&id| position(&world, id)).collect();
    println!("spinning: {start:.1} J at the start, {most:.2e} J above; at {places:?}, {:?}", world.status().entries());
    assert!(most < 1e-3 * start, "it gained {most} J");
    assert!(places.iter().all(|p| p.1 > -0.01), "{places:?}");
}

// Far.

/// The heavy scenes and a pile, beside each other.
fn everything() -> Vec<BodyDef> {
    let mut defs = vec![fixed(0.0, -1.0, rectangle(200.0, 2.0))];
    for (row, mass) in [1.0, 1000.0, 1.0, 100.0].into_iter().enumerate() {
        defs.push(weighing(solid(-20.0, row as f64 + 0.5, rectangle(1.0, 1.0)), mass));
    }
    for row in 0..12 {
        defs.push(solid(-10.0 + 0.01 * f64::from(row % 3), f64::from(row) + 0.5, rectangle(1.0, 1.0)));
    }
    defs.push(solid(1.0, 0.5, rectangle(1.0, 1.0)));
    defs.push(solid(19.0, 0.5, rectangle(1.0, 1.0)));
    defs.push(solid(10.0, 11.0, rectangle(20.0, 20.0)));
    let mut rng = Rng(5);
    for at in 0..40 {
        let (size, x) = (0.4 + 0.6 * rng.unit(), f64::from(at % 5) * 1.1 + 30.0);
        let shape = if at % 3 == 0 { disc(size * 0.5) } else { rectangle(size, 0.6) };
        let body = weighing(solid(x, 0.6 + f64::from(at / 5) * 1.2, surface(shape, 0.6, 0.0)), rng.scale(0.1, 100.0));
        defs.push(BodyDef { angle: turned(6.0 * rng.unit()), ..body });
    }
    defs
}

#[test]
fn hard_scenes_have_the_same_bits_wherever_they_are() {
    let build = |by: [i64; 2]| {
        let mut world = world(0.0, -9.81);
        for def in everything() {
            let at = |p: Length, by: i64| Length::from_bits(p.to_bits() + by);
            let position = Vec2::new(at(def.position.x, by[0]), at(def.position.y, by[1]));
            add(&mut world, BodyDef { position, ..def });
        }
        world
    };
    let mut here = build([0, 0]);
    let moves = [[1i64 << 52, -(1i64 << 52)], [-(1i64 << 61), 1i64 << 61]];
    let mut there = moves.map(build);
    for tick in 0..600 {
        here.step();
        for (world, by) in there.iter_mut().zip(moves) {
            world.step();
            for (a, b) in here.bodies().zip(world.bodies()) {
                let mut moved = bits(&b);
                (moved[0], moved[1]) = (moved[0] - by[0], moved[1] - by[1]);
                assert_eq!(bits(&a), moved, "{} in tick {tick}, moved by {by:?} · 2⁻³² m", a.id());
            }
        }
    }
}

#[test]
fn hard_scenes_turned_by_half_a_turn_have_the_negated_bits() {
    let half = 1i64 << 47;
    let mut up = world(0.0, -9.81);
    let mut down = world(0.0, 9.81);
    for def in everything() {
        let line = |v: Length| Length::from_bits(-v.to_bits());
        let angle = tamias2d::Angle::from_bits(def.angle.to_bits() + half);
        let position = Vec2::new(line(def.position.x), line(def.position.y));
        add(&mut up, def.clone());
        add(&mut down, BodyDef { position, angle, ..def });
    }
    for tick in 0..600 {
        up.step();
        down.step();
        for (a, b) in up.bodies().zip(down.bodies()) {
            let [x, y, vx, vy, angle, spin] = bits(&a);
            assert_eq!([-x, -y, -vx, -vy, angle + half, spin], bits(&b), "{} in tick {tick}", a.id());
        }
    }
}

#[test]
fn hard_scenes_go_on_alike_after_saving_and_loading() {
    let mut world = world(0.0, -9.81);
    for def in everything() {
        add(&mut world, def);
    }
    for _ in 0..20 {
        run(&mut world, 10);
        let mut twin = World::load(&world.save()).expect("it loads");
        for tick in 0..10 {
            world.step();
            twin.step();
            assert_eq!(world.hash(), twin.hash(), "{tick} ticks after loading");
        }
    }
}

#[test]
fn at_the_edge_of_the_range_a_stack_stands_and_nothing_panics() {
    let mut world = world(0.0, -9.81);
    let edge = 1e9 - 1.0;
    add(&mut world, fixed(edge - 10.0, -edge, rectangle(20.0, 2.0)));
    let ids: Vec<BodyId> = (0..5)
        .map(|row| add(&mut world, solid(edge - 5.0, 1.5 - edge + f64::from(row), rectangle(1.0, 1.0))))
        .collect();
    // And one that leaves.
    add(&mut world, moving(solid(edge - 1.0, 3.0 - edge, disc(0.5)), 300.0, 0.0));
    run(&mut world, 1200);
    world.check().expect("every invariant holds");
    for (row, &id) in ids.iter().enumerate() {
        let y = position(&world, id).1 + edge;
        assert!((y - 1.5 - row as f64).abs() < 0.01, "box {row} at {y}");
    }
}

#[test]
fn drift_and_a_sliding_stop_are_the_same_a_million_metres_away() {
    // Whole metres: the distance is exact, so are the bits.
    let far = 1_000_000i64 << 32;
    let course = |by: i64| {
        let mut world = world(0.0, -9.81);
        let put = |def: BodyDef| {
            let x = Length::from_bits(def.position.x.to_bits() + by);
            BodyDef { position: Vec2::new(x, def.position.y), ..def }
        };
        add(&mut world, put(fixed(0.0, -1.0, rectangle(60.0, 2.0))));
        let slides = add(&mut world, put(moving(solid(0.0, 0.5, rectangle(1.0, 1.0)), 3.0, 0.0)));
        let rests = add(&mut world, put(solid(-5.0, 0.5, rectangle(1.0, 1.0))));
        let on = add(&mut world, put(weighing(solid(-5.0, 1.5, rectangle(1.0, 1.0)), 500.0)));
        let mut all = Vec::new();
        for _ in 0..1200 {
            world.step();
            for id in [slides, rests, on] {
                let mut now = bits(&world.body(id).expect("it exists"));
                now[0] -= by;
                all.push(now);
            }
        }
        all
    };
    assert!(course(0) == course(far), "not the same bits");
}

#[test]
fn a_million_ticks_of_rest_without_creep() {
    let mut world = floor();
    let tilt = 0.4f64;
    let (sin, cos) = tilt.sin_cos();
    add(&mut world, BodyDef { angle: turned(tilt), ..fixed(50.0, 20.0, rectangle(20.0, 1.0)) });
    let mut ids =
        vec![add(&mut world, BodyDef { angle: turned(tilt), ..solid(50.0 - sin, 20.0 + cos, rectangle(1.0, 1.0)) })];
    ids.extend((0..3).map(|row| add(&mut world, solid(0.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)))));
    ids.push(add(&mut world, solid(10.0, 0.5, rectangle(1.0, 1.0))));
    ids.push(add(&mut world, weighing(solid(10.0, 1.5, rectangle(1.0, 1.0)), 1000.0)));
    run(&mut world, 600);
    let all = |world: &World| -> Vec<_> { ids.iter().map(|&id| bits(&world.body(id).expect("it exists"))).collect() };
    let start = all(&world);
    run(&mut world, 1_000_000);
    assert_eq!(all(&world), start, "what rests is left as it is");
}

// Long.

/// Runs a drum for 10^4 ticks. The greatest overlap at any second.
fn tumble(name: &str, (world, ids): &mut Scene, radius: f64) {
    let mut worst = 0.0f64;
    for second in 0..166 {
        run(world, 60);
        let now = worst_overlap(world);
        worst = worst.max(now);
        for &id in &*ids {
            let (x, y) = position(world, id);
            assert!(x.hypot(y) < radius, "{name}: one got out after {second} s: {x}, {y}");
        }
    }
    world.check().expect("every invariant holds");
    println!("{name}: overlap {worst:.4} m at most, {:?}", world.status().entries().len());
    assert!(worst < 0.05, "{name}: {worst} m of overlap");
}

#[test]
#[ignore = "not held: 11 cm of overlap at the worst moment, 5 cm allowed; takes 20 s: cargo test --release --test hard -- --ignored a_tumbler"]
fn a_tumbler_turns_for_ten_thousand_ticks() {
    tumble("tumbler", &mut scenes::tumbler(), 14.9);
}

#[test]
#[ignore = "not held: 8 cm of overlap at the worst moment, 5 cm allowed; takes 20 s: cargo test --release --test hard -- --ignored a_washer"]
fn a_washer_turns_for_ten_thousand_ticks() {
    tumble("washer", &mut scenes::washer(), 16.0);
}

// Piles.

#[test]
#[ignore = "not held: 1 of 8 seeds overlaps by 1.01 cm, none or 2 by chance of details; takes a minute: cargo test --release --test hard -- --ignored settled_piles"]
fn settled_piles_of_1000_overlap_less_than_1_cm() {
    let mut over = Vec::new();
    for seed in 1..=8 {
        let (mut world, _) = scenes::pile(1000, 16.0, seed);
        run(&mut world, 1200);
        let overlap = worst_overlap(&world);
        println!("pile of 1000, seed {seed}: overlap {overlap:.5} m, {:.1e} m/s", fastest(&world));
        if overlap >= 0.01 {
            over.push((seed, overlap));
        }
    }
    assert!(over.is_empty(), "{over:?}");
}
