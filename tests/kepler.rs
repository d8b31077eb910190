//! Attraction: orbits, their energy and angular momentum, and the pull itself against floating point.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{Rng, ULP_V, at, close2, num, position, run, vel, velocity, world};
use std::f64::consts::TAU;
use tamias2d::{
    Attractor, BodyDef, BodyId, BodyKind, Bound, Commands, Integrator, Length, Mu, Vec2, Velocity, World, WorldDef,
};

/// μ of an orbit with a semi-major axis of 10 m and a period of 10 s: 4π²·a³/T².
const MU: f64 = TAU * TAU * 10.0;
/// Ticks in a period.
const PERIOD: u64 = 600;

/// A body at the periapsis of an orbit of eccentricity `e` around an attractor at `center`.
fn orbit(substeps: u32, e: f64, center: (f64, f64)) -> (World, BodyId) {
    let mut world = World::new(&WorldDef { substeps, ..WorldDef::default() }).expect("accepted");
    let mu = Mu::from_f64(MU).expect("in range");
    world.create_attractor(Attractor { position: at(center.0, center.1), mu }).expect("accepted");
    let r = 10.0 * (1.0 - e);
    let v = (MU * (1.0 + e) / r).sqrt();
    let def = BodyDef { position: at(center.0 + r, center.1), velocity: vel(0.0, v), ..BodyDef::default() };
    let id = world.create_body(&def).expect("accepted");
    (world, id)
}

/// Energy and angular momentum per kilogram about the origin.
fn invariants(world: &World, id: BodyId) -> (f64, f64) {
    let ((x, y), (vx, vy)) = (position(world, id), velocity(world, id));
    (0.5 * (vx * vx + vy * vy) - MU / x.hypot(y), x * vy - y * vx)
}

/// The means over a period.
fn means(world: &mut World, id: BodyId) -> (f64, f64) {
    let (mut energy, mut momentum) = (0.0, 0.0);
    for _ in 0..PERIOD {
        world.step();
        let (e, l) = invariants(world, id);
        energy += e;
        momentum += l;
    }
    (energy / PERIOD as f64, momentum / PERIOD as f64)
}

/// Drifts over 100 periods: of the mean energy, the mean angular momentum, and the worst angular momentum of any tick.
fn drifts(e: f64) -> (f64, f64, f64) {
    let (mut world, id) = orbit(4, e, (0.0, 0.0));
    let (_, start) = invariants(&world, id);
    let first = means(&mut world, id);
    let (mut energy, mut momentum, mut worst) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 1..100 {
        let mean = means(&mut world, id);
        energy = energy.max((mean.0 / first.0 - 1.0).abs());
        momentum = momentum.max((mean.1 / start - 1.0).abs());
        worst = worst.max((invariants(&world, id).1 / start - 1.0).abs());
    }
    assert!(world.status().is_clear());
    world.check().expect("every invariant holds");
    (energy, momentum, worst)
}

#[test]
fn tm_universal_grav_law_eccentric_orbit_keeps_energy_and_angular_momentum() {
    let (energy, momentum, worst) = drifts(0.6);
    println!("e = 0.6, 100 periods: energy {energy:.2e}, angular momentum {momentum:.2e} (a tick: {worst:.2e})");
    assert!(energy <= 2e-6, "{energy:e}");
    assert!(momentum <= 1e-7 && worst <= 1e-7, "{momentum:e} {worst:e}");
}

#[test]
fn tm_universal_grav_law_circular_orbit_keeps_energy_and_angular_momentum() {
    let (energy, momentum, worst) = drifts(0.0);
    println!("e = 0, 100 periods: energy {energy:.2e}, angular momentum {momentum:.2e} (a tick: {worst:.2e})");
    assert!(energy <= 2e-6, "{energy:e}");
    assert!(momentum <= 1e-7 && worst <= 1e-7, "{momentum:e} {worst:e}");
    // And its radius.
    let (mut world, id) = orbit(4, 0.0, (0.0, 0.0));
    for _ in 0..10 * PERIOD {
        world.step();
        let (x, y) = position(&world, id);
        assert!((x.hypot(y) - 10.0).abs() < 1e-4, "{}", x.hypot(y));
    }
}

#[test]
fn an_orbit_far_from_the_origin_has_the_same_bits() {
    let (mut one, a) = orbit(4, 0.6, (0.0, 0.0));
    let (mut other, b) = orbit(4, 0.6, (536_870_912.0, -1_048_576.0));
    for _ in 0..PERIOD {
        one.step();
        other.step();
        let (p, q) = (one.body(a).expect("it exists"), other.body(b).expect("it exists"));
        assert_eq!(p.velocity(), q.velocity());
        assert_eq!(p.position().x.to_bits() + (1 << 61), q.position().x.to_bits());
        assert_eq!(p.position().y.to_bits() - (1 << 52), q.position().y.to_bits());
    }
}

#[test]
fn two_bodies_orbit_their_common_centre() {
    let mut world = world(0.0, 0.0);
    // Masses 1 and 3, circular, 10 m apart, once in 10 s: they share μ as they share mass.
    let defs = [(1.0, -7.5, -7.5), (3.0, 2.5, 2.5)].map(|(share, x, speed)| BodyDef {
        mass: Some(num(if share == 1.0 { "1" } else { "3" })),
        mu: Mu::from_f64(MU * share / 4.0).expect("in range"),
        position: at(x, 0.0),
        velocity: vel(0.0, speed * TAU / 10.0),
        ..BodyDef::default()
    });
    let [a, b] = defs.map(|def| world.create_body(&def).expect("accepted"));
    let mut worst = (0.0f64, 0.0f64);
    for _ in 0..20 * PERIOD {
        world.step();
        let (p, q) = (position(&world, a), position(&world, b));
        worst.0 = worst.0.max(((p.0 - q.0).hypot(p.1 - q.1) - 10.0).abs());
        let center = ((p.0 + 3.0 * q.0) / 4.0).hypot((p.1 + 3.0 * q.1) / 4.0);
        worst.1 = worst.1.max(center);
    }
    println!("two bodies, 20 periods: distance off by {:.2e} m, common centre by {:.2e} m", worst.0, worst.1);
    assert!(worst.0 < 1e-4 && worst.1 < 1e-5, "{worst:?}");
    assert!(world.status().is_clear());
}

#[test]
fn a_body_that_is_not_dynamic_pulls_but_is_not_pulled() {
    for kind in [BodyKind::Static, BodyKind::Kinematic] {
        let mut world = world(0.0, 0.0);
        let mu = Mu::from_f64(MU).expect("in range");
        let heavy = world.create_body(&BodyDef { kind, mu, ..BodyDef::default() }).expect("accepted");
        let star = world.create_body(&BodyDef { mu, position: at(10.0, 0.0), ..BodyDef::default() }).expect("accepted");
        world.step();
        assert_eq!((position(&world, heavy), velocity(&world, heavy)), ((0.0, 0.0), (0.0, 0.0)));
        close2(velocity(&world, star), (-MU / 100.0 / 60.0, 0.0), 1e-4);
        // A body with its μ taken away, or destroyed, pulls no longer.
        world.set_mu(heavy, Mu::ZERO).expect("accepted");
        let free = velocity(&world, star);
        run(&mut world, 10);
        assert_eq!(velocity(&world, star), free);
        world.set_mu(heavy, mu).expect("accepted");
        world.step();
        assert_ne!(velocity(&world, star), free);
        let free = velocity(&world, star);
        world.destroy_body(heavy).expect("accepted");
        run(&mut world, 10);
        assert_eq!(velocity(&world, star), free);
        world.check().expect("every invariant holds");
    }
}

/// How far a body is from where Kepler's equation puts it after `ticks`, at `tick_rate`.
fn error_after(ticks: u64, tick_rate: u32, substeps: u32, integrator: Integrator) -> f64 {
    let (start, id) = orbit(substeps, 0.6, (0.0, 0.0));
    let def = WorldDef { integrator, tick_rate, ..start.config().clone() };
    let mut world = World::new(&def).expect("accepted");
    for (_, attractor) in start.attractors() {
        world.create_attractor(attractor).expect("accepted");
    }
    world.create_body(&start.body(id).expect("it exists").def()).expect("accepted");
    run(&mut world, ticks);
    // E − e·sin E = M, by Newton's method.
    let mean = TAU * ticks as f64 / f64::from(10 * tick_rate);
    let mut anomaly = mean;
    for _ in 0..50 {
        anomaly -= (anomaly - 0.6 * anomaly.sin() - mean) / (1.0 - 0.6 * anomaly.cos());
    }
    let (x, y) = position(&world, id);
    (x - 10.0 * (anomaly.cos() - 0.6)).hypot(y - 8.0 * anomaly.sin())
}

#[test]
fn lc_variable_ode_solver_forest_ruth_has_the_fourth_order_and_euler_the_first() {
    // At 15 ticks per second, where errors are far above rounding.
    for ticks in [150, 38, 94] {
        let errors = [4, 8, 16].map(|substeps| error_after(ticks, 15, substeps, Integrator::ForestRuth));
        println!("Forest-Ruth, error in m after {ticks} ticks with 4, 8, 16 substeps: {errors:?}");
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            // After a whole period the leading errors cancel in part, and what is left falls faster.
            assert!((14.0..36.0).contains(&ratio), "{errors:?}: {ratio}");
        }
        // Four substeps make one step, so fewer change nothing.
        assert_eq!(error_after(ticks, 15, 1, Integrator::ForestRuth), errors[0]);
    }
    println!(
        "Forest-Ruth, error in m after a period of 600 ticks with 4 and 8 substeps: {:?}",
        [4, 8].map(|substeps| error_after(PERIOD, 60, substeps, Integrator::ForestRuth))
    );
    // Not after a whole period, where the first-order errors of Euler's scheme cancel.
    for ticks in [PERIOD / 4, PERIOD * 5 / 8] {
        let errors = [1, 2, 4, 8].map(|substeps| error_after(ticks, 60, substeps, Integrator::SymplecticEuler));
        println!("Euler, error in m after {ticks} ticks with 1, 2, 4, 8 substeps: {errors:?}");
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((1.8..2.2).contains(&ratio), "{errors:?}: {ratio}");
        }
    }
}

#[test]
fn a_body_exactly_at_the_attractor_is_not_pulled() {
    for integrator in [Integrator::ForestRuth, Integrator::SymplecticEuler] {
        let mut world = World::new(&WorldDef { integrator, ..WorldDef::default() }).expect("accepted");
        let position = at(3.25, -7.5);
        world.create_attractor(Attractor { position, mu: num("2e21") }).expect("accepted");
        let (one, center) =
            (BodyDef { mass: Some(num("1")), inertia: Some(num("1")), ..BodyDef::default() }, at(0.0, 0.0));
        let def = BodyDef { position, mu: num("2e21"), center: Some(center), ..one };
        let id = world.create_body(&def).expect("accepted");
        // Nor by a body at the same place, nor by itself.
        let twin = world.create_body(&def).expect("accepted");
        run(&mut world, 60);
        for id in [id, twin] {
            assert_eq!(world.body(id).expect("it exists").def(), def);
        }
        assert!(world.status().is_clear());
    }
}

#[test]
fn close_passes_saturate_and_say_so() {
    let mut rng = Rng(11);
    let (mut accelerations, mut velocities) = (0, 0);
    for _ in 0..200 {
        let substeps = 1 + rng.below(8) as u32;
        let mut world = World::new(&WorldDef { substeps, ..WorldDef::default() }).expect("accepted");
        let mu = Mu::from_f64(rng.scale(1.0, 2e21)).expect("in range");
        world.create_attractor(Attractor { position: at(0.0, 0.0), mu }).expect("accepted");
        for _ in 0..4 {
            let position = at(rng.signed(1e-9, 1e7), rng.signed(1e-9, 1e7));
            let velocity = vel(rng.signed(1e-9, 30_000.0), rng.signed(1e-9, 30_000.0));
            let mu = Mu::from_f64(rng.scale(1e-3, 2e21)).expect("in range");
            world.create_body(&BodyDef { position, velocity, mu, ..BodyDef::default() }).expect("accepted");
        }
        for _ in 0..120 {
            world.step();
            world.check().expect("every invariant holds");
        }
        let has = |bound| world.status().entries().iter().any(|entry| entry.bound == bound);
        accelerations += i32::from(has(Bound::Acceleration));
        velocities += i32::from(has(Bound::Velocity));
    }
    println!("of 200 scenes {accelerations} limited an acceleration and {velocities} a velocity");
    assert!(accelerations > 100 && velocities > 20);
}

#[test]
fn a_pull_beyond_the_format_is_its_limit_in_the_right_direction() {
    for (dx, dy) in [(1i64, 0), (0, -1), (-5, 0), (3, 4), (-1, 1)] {
        let config = WorldDef { integrator: Integrator::SymplecticEuler, substeps: 1, ..WorldDef::default() };
        let mut world = World::new(&config).expect("accepted");
        let position = Vec2::new(Length::from_bits(dx), Length::from_bits(dy));
        world.create_attractor(Attractor { position, mu: num("2e21") }).expect("accepted");
        let id = world.create_body(&BodyDef::default()).expect("accepted");
        world.step();
        let v = world.body(id).expect("it exists").velocity();
        let limit = 32_768.0 / 60.0;
        close2(v.to_f64(), (limit * dx.signum() as f64, limit * dy.signum() as f64), 1e-9);
        let [entry] = world.status().entries() else { panic!("one entry: {:?}", world.status()) };
        assert_eq!((entry.tick, entry.body, entry.bound), (0, id, Bound::Acceleration));
    }
}

/// One tick's change of velocity at 15 ticks per second by sources at `d` with `mu`, in bits.
fn kick(sources: &[(Vec2<Length>, Mu)], body: Vec2<Length>, carried: bool) -> Vec2<Velocity> {
    let config =
        WorldDef { tick_rate: 15, substeps: 1, integrator: Integrator::SymplecticEuler, ..WorldDef::default() };
    let mut world = World::new(&config).expect("accepted");
    let id = world.create_body(&BodyDef { position: body, ..BodyDef::default() }).expect("accepted");
    for &(position, mu) in sources {
        if carried {
            let def = BodyDef { kind: BodyKind::Static, position, mu, ..BodyDef::default() };
            world.create_body(&def).expect("accepted");
        } else {
            world.create_attractor(Attractor { position, mu }).expect("accepted");
        }
    }
    world.step();
    world.body(id).expect("it exists").velocity()
}

#[test]
fn tm_universal_grav_law_pull_against_floating_point() {
    let mut rng = Rng(5);
    let (mut compared, mut small, mut worst) = (0u32, 0u32, 0.0f64);
    for round in 0..60_000u32 {
        // The components of d may be of different orders; about the origin or across the whole world.
        let mut side = || {
            let length = (rng.signed(1e-9, 2e9) * 4_294_967_296.0) as i64;
            if length == 0 { i64::from(round % 2) } else { length }
        };
        let (dx, dy) = (side(), side());
        let limit = 1_000_000_000i64 << 32;
        // The body as far to the one side as the source has to be to the other.
        let place = |d: i64| (-(d / 2)).clamp(-limit, limit);
        let (bx, by) = (place(dx), place(dy));
        let (sx, sy) = ((bx + dx).clamp(-limit, limit), (by + dy).clamp(-limit, limit));
        let mu = Mu::from_f64(rng.scale(1e-17, 2e21)).expect("in range");
        let mu = if mu == Mu::ZERO { Mu::from_bits(1) } else { mu };
        let point = |x, y| Vec2::new(Length::from_bits(x), Length::from_bits(y));
        let got = kick(&[(point(sx, sy), mu)], point(bx, by), round % 2 == 0).to_f64();

        let (dx, dy) = ((sx - bx) as f64 / 4_294_967_296.0, (sy - by) as f64 / 4_294_967_296.0);
        let d = dx.hypot(dy);
        if d == 0.0 {
            assert_eq!(got, (0.0, 0.0));
            continue;
        }
        let a = mu.to_f64() / d / d;
        let want = (a * (dx / d), a * (dy / d));
        // The format ends at 32 768 m/s²; the body's own limit of a component applies to that component.
        for (got, want) in [(got.0 * 15.0, want.0), (got.1 * 15.0, want.1)] {
            if want.abs() >= 32_768.0 {
                close_relative(got, 32_768.0f64.copysign(want), 1e-12);
            } else if want.abs() > 1.0 {
                worst = worst.max((got / want - 1.0).abs());
                compared += 1;
                close_relative(got, want, 1e-12);
            } else {
                // Half a unit of the acceleration, and half a unit of the velocity times 15.
                small += 1;
                assert!((got - want).abs() <= 8.5 * ULP_V + 1e-15 * want.abs(), "{got} {want}");
            }
        }
    }
    println!("{compared} components above 1 m/s²: worst relative error {worst:.2e}; {small} smaller ones to rounding");
    assert!(compared > 5_000 && small > 5_000);
}

#[track_caller]
fn close_relative(got: f64, want: f64, tolerance: f64) {
    assert!((got / want - 1.0).abs() <= tolerance, "{got:e} is not {want:e}");
}

#[test]
fn pulls_of_many_sources_add_and_may_cancel_beyond_the_format() {
    // Two pulls of 10^21 m/s² each from opposite sides cancel to the bit, and a third one remains.
    let mu = num("2e21");
    let sources = [(at(1.0, 0.0), mu), (at(-1.0, 0.0), mu), (at(0.0, 10.0), num("1500"))];
    let v = kick(&sources, at(0.0, 0.0), false);
    assert_eq!(v.x, Velocity::ZERO);
    close2(v.to_f64(), (0.0, 1.0), 1e-12);

    let mut rng = Rng(9);
    let mut want = (0.0, 0.0);
    let sources: Vec<_> = (0..100)
        .map(|_| {
            let (x, y) = (rng.signed(1.0, 1e3), rng.scale(1.0, 1e3));
            let strength = rng.scale(1.0, 1e3);
            let cube = x.hypot(y).powi(3);
            want.0 += strength * x / cube / 15.0;
            want.1 += strength * y / cube / 15.0;
            (at(x, y), Mu::from_f64(strength).expect("in range"))
        })
        .collect();
    close2(kick(&sources, at(0.0, 0.0), true).to_f64(), want, 1e-8 * want.0.hypot(want.1));
}
