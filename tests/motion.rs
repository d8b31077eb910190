//! Motion under forces against closed forms: the acceptance cases TC1 to TC9, TIn and TC14, and what must not change.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{
    Rng, Storm, ULP_PHI, ULP_V, ULP_X, acc, at, close, close2, newton_seconds, newtons, num, omega, phi, position, run,
    vel, velocity, world,
};
use proptest::prelude::{Just, ProptestConfig, Strategy, any, prop_assert_eq, prop_oneof, proptest};
use tamias2d::{
    Angle, AngularVelocity, Attractor, BodyDef, BodyId, BodyKind, Bound, Command, Commands, Damping, Inertia,
    Integrator, Length, Mass, Radians, StatusEntry, Torque, Vec2, Velocity, World, WorldDef,
};

/// The rounding budget of a position after `ticks`: half a unit per tick, and what the rounding of velocities and
/// accelerations adds, which is 2^-16 times smaller per tick but sums over the time.
fn budget(ticks: u64) -> f64 {
    let n = ticks as f64;
    n * ULP_X / 2.0 + n * n * ULP_V + 1e-11
}

/// The rounding budget of a velocity after `ticks`: half a unit each, and that of the acceleration itself.
fn velocity_budget(ticks: u64) -> f64 {
    ticks as f64 * ULP_V + 1e-12
}

fn dynamic(mass: &str, position: (f64, f64)) -> BodyDef {
    let (mass, inertia) = (Some(num(mass)), Some(num("1")));
    BodyDef { mass, inertia, position: at(position.0, position.1), ..BodyDef::default() }
}

/// Runs a body under constant force for 4 s and checks x(t) = x0 + v0·t + ½·a·t² and v(t) = v0 + a·t each second,
/// and the table of the case where one is given.
fn constant_force(def: &BodyDef, gravity: (f64, f64), acceleration: (f64, f64), table: &[(f64, f64)]) {
    let mut world = world(gravity.0, gravity.1);
    let id = world.create_body(def).expect("accepted");
    let ((x, y), (vx, vy)) = (def.position.to_f64(), def.velocity.to_f64());
    for second in 1..=4u32 {
        run(&mut world, 60);
        let (t, ticks) = (f64::from(second), u64::from(second) * 60);
        let half = 0.5 * t * t;
        let want = (x + vx * t + acceleration.0 * half, y + vy * t + acceleration.1 * half);
        close2(position(&world, id), want, budget(ticks));
        close2(velocity(&world, id), (vx + acceleration.0 * t, vy + acceleration.1 * t), velocity_budget(ticks));
        if let Some(&row) = table.get(second as usize - 1) {
            close2(position(&world, id), row, budget(ticks));
        }
    }
    world.check().expect("every invariant holds");
    assert!(world.status().is_clear());
}

#[test]
fn tc1_at_rest_stays_to_the_bit() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&dynamic("10", (50.0, 50.0))).expect("accepted");
    for _ in 0..240 {
        world.step();
        let body = world.body(id).expect("it exists");
        assert_eq!(body.position(), at(50.0, 50.0));
        assert_eq!(body.velocity(), vel(0.0, 0.0));
        assert_eq!(body.angle(), Angle::ZERO);
        assert_eq!(body.angular_velocity(), AngularVelocity::ZERO);
    }
}

#[test]
fn tc2_constant_force() {
    let def = BodyDef { force: newtons(100.0, 0.0), ..dynamic("10", (20.0, 20.0)) };
    constant_force(&def, (0.0, 0.0), (10.0, 0.0), &[(25.0, 20.0), (40.0, 20.0), (65.0, 20.0), (100.0, 20.0)]);
}

#[test]
fn tc3_constant_force_to_the_left() {
    let def = BodyDef { force: newtons(-100.0, 0.0), ..dynamic("10", (950.0, 50.0)) };
    constant_force(&def, (0.0, 0.0), (-10.0, 0.0), &[(945.0, 50.0), (930.0, 50.0), (905.0, 50.0), (870.0, 50.0)]);
}

#[test]
fn tc4_every_mass_falls_alike() {
    let mut world = world(0.0, 9.8);
    let ids: Vec<BodyId> = [("100", 100.0), ("1000", 400.0), ("1000", 700.0)]
        .map(|(mass, x)| world.create_body(&dynamic(mass, (x, 50.0))).expect("accepted"))
        .into();
    for (second, y) in [(1u64, 54.9), (2, 69.6), (3, 94.1), (4, 128.4)] {
        run(&mut world, 60);
        for &id in &ids {
            close(position(&world, id).1, y, budget(60 * second));
            close(velocity(&world, id).1, 9.8 * second as f64, velocity_budget(60 * second));
            let (one, other) = (world.body(id).expect("it exists"), world.body(ids[0]).expect("it exists"));
            assert_eq!(one.position().y, other.position().y);
            assert_eq!(one.velocity(), other.velocity());
        }
    }
}

#[test]
fn tc5_b1_force_to_the_left() {
    let def = BodyDef { force: newtons(-300.0, 0.0), ..dynamic("1", (0.0, 50.0)) };
    let table = [(-150.0, 50.0), (-600.0, 50.0), (-1350.0, 50.0), (-2400.0, 50.0)];
    constant_force(&def, (0.0, 0.0), (-300.0, 0.0), &table);
}

#[test]
fn tc5_b2_heavy_body() {
    let def = BodyDef { force: newtons(0.0, 80_000.0), ..dynamic("4000", (300.0, 50.0)) };
    constant_force(&def, (0.0, 0.0), (0.0, 20.0), &[(300.0, 60.0), (300.0, 90.0), (300.0, 140.0), (300.0, 210.0)]);
}

#[test]
fn tc5_b3_oblique_force() {
    let def = BodyDef { force: newtons(1000.0, -2000.0), ..dynamic("10", (600.0, 50.0)) };
    let table = [(650.0, -50.0), (800.0, -350.0), (1050.0, -850.0), (1400.0, -1550.0)];
    constant_force(&def, (0.0, 0.0), (100.0, -200.0), &table);
}

#[test]
fn tc6_throw() {
    let speed = 1200.0 * std::f64::consts::FRAC_1_SQRT_2;
    let def = BodyDef { velocity: vel(speed, speed), ..dynamic("10", (0.0, 0.0)) };
    constant_force(&def, (0.0, -100.0), (0.0, -100.0), &[]);

    let mut world = world(0.0, -100.0);
    let id = world.create_body(&def).expect("accepted");
    // v0 with 48 fraction bits: what it lacks is 2e-15 m/s and does not show.
    run(&mut world, 60);
    close2(position(&world, id), (848.5281, 798.5281), 5e-5);
    let mut top = 0.0f64;
    for tick in 61..=600u64 {
        world.step();
        let (t, (x, y)) = (tick as f64 / 60.0, position(&world, id));
        close2((x, y), (speed * t, speed * t - 50.0 * t * t), budget(tick));
        top = top.max(y);
    }
    close2(position(&world, id), (8485.2814, 3485.2814), 5e-5);
    // The apex 3600 m at 8.485281 s lies between two ticks: 50·(1/120)² lower at most.
    assert!((3600.0 - 50.0 / 14_400.0..3600.0 + 1e-6).contains(&top), "the apex is {top}");
    // And with the rate at which 8.4852814 s is closest to a whole number of ticks.
    let mut fine =
        World::new(&WorldDef { tick_rate: 1000, gravity: acc(0.0, -100.0), ..WorldDef::default() }).expect("ok");
    let id = fine.create_body(&def).expect("accepted");
    run(&mut fine, 8485);
    close(position(&fine, id).1, 3600.0 - 50.0 * (8.485_281_374_238_57f64 - 8.485).powi(2), budget(8485));
    close(velocity(&fine, id).1, 0.028_137_423_857, 1e-10);
}

/// A box of 100×100 and 0.5 kg, as TC8 and TC9 have it.
fn spun_box(inertia: &str, torque: f64) -> BodyDef {
    BodyDef {
        mass: Some(num("0.5")),
        inertia: Some(num(inertia)),
        torque: Torque::from_f64(torque).expect("in range"),
        ..BodyDef::default()
    }
}

#[test]
fn tc8_angle_under_constant_torque() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&spun_box("833.33333333333333333333", 100.0)).expect("accepted");
    for (second, angle) in [(1u64, 0.06), (2, 0.24), (3, 0.54), (4, 0.96)] {
        run(&mut world, 60);
        close(phi(&world, id), angle, 60.0 * second as f64 * ULP_PHI + 1e-12);
        assert_eq!(position(&world, id), (0.0, 0.0));
    }
}

#[test]
fn tc8_prime_unwrapped_and_normalised_angle() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&spun_box("8.33333333333333333333", 100.0)).expect("accepted");
    for (second, angle) in [(1u64, 6.0), (2, 24.0), (3, 54.0), (4, 96.0)] {
        run(&mut world, 60);
        close(phi(&world, id), angle, 60.0 * second as f64 * ULP_PHI + 1e-12);
        let normalised: Radians = world.body(id).expect("it exists").angle().radians();
        close(normalised.to_f64(), angle % std::f64::consts::TAU, 60.0 * second as f64 * ULP_PHI + 1e-12);
        assert!(normalised.to_f64() >= 0.0 && normalised.to_f64() < std::f64::consts::TAU);
    }
    close(world.body(id).expect("it exists").angle().radians().to_f64(), 1.752_220, 5e-7);
}

#[test]
fn tc9_angular_velocity_under_constant_torque() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&spun_box("833.33333333333333333333", 100.0)).expect("accepted");
    for (second, want) in [(1u64, 0.12), (2, 0.24), (3, 0.36), (4, 0.48)] {
        run(&mut world, 60);
        close(omega(&world, id), want, velocity_budget(60 * second));
    }
}

#[test]
fn tin_small_angular_velocity_keeps_its_digits() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef { mass: Some(num("500")), ..spun_box("20833333.333333333333333333", 100.0) };
    let id = world.create_body(&def).expect("accepted");
    run(&mut world, 240);
    // Half a unit of α over 4 s and half a unit per tick: 2.2e-8 of the value.
    close(omega(&world, id), 1.92e-5, 4.0 * ULP_V / 2.0 + 240.0 * ULP_V / 2.0);
    close(phi(&world, id), 3.84e-5, 240.0 * ULP_PHI);
}

#[test]
fn tc14_fifty_bodies_fall_identically() {
    let mut world = world(0.0, 98.0);
    let ids: Vec<BodyId> = (0..50)
        .map(|i| {
            let inertia = Inertia::from_f64(200.0 * 80_000.0 / 12.0).expect("in range");
            let def = BodyDef { inertia: Some(inertia), ..dynamic("200", (100.0 + 500.0 * f64::from(i), 560.0)) };
            world.create_body(&def).expect("accepted")
        })
        .collect();
    run(&mut world, 240);
    let first = world.body(ids[0]).expect("it exists");
    close(first.position().y.to_f64(), 1344.0, budget(240));
    close(first.velocity().y.to_f64(), 392.0, velocity_budget(240));
    for (i, &id) in ids.iter().enumerate() {
        let body = world.body(id).expect("it exists");
        assert_eq!(body.position().y, first.position().y);
        assert_eq!(body.velocity(), first.velocity());
        assert_eq!(body.angle(), Angle::ZERO);
        assert_eq!(body.position().x, at(100.0 + 500.0 * i as f64, 0.0).x);
    }
}

#[test]
fn im_rot_mot_example() {
    let mut world = world(0.0, 0.0);
    let id = world
        .create_body(&BodyDef {
            torque: num("200"),
            inertia: Some(num("74.5")),
            angular_velocity: num("2.1"),
            angle: Angle::from_radians_f64(std::f64::consts::FRAC_PI_2).expect("in range"),
            ..BodyDef::default()
        })
        .expect("accepted");
    run(&mut world, 60);
    close(omega(&world, id), 2.1 + 200.0 / 74.5, velocity_budget(60));
    close(omega(&world, id), 4.784_563_758, 5e-10);
    close(phi(&world, id), std::f64::consts::FRAC_PI_2 + 2.1 + 100.0 / 74.5, 60.0 * ULP_PHI + 1e-12);
    close(phi(&world, id), 5.013_078_206, 5e-10);
}

#[test]
fn tm_newton_sec_law_mot_forces_add() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&BodyDef { force: newtons(3.0, 0.0), ..dynamic("5", (0.0, 0.0)) }).expect("accepted");
    for _ in 0..60 {
        world.apply_force(id, newtons(0.0, 4.0), None).expect("accepted");
        world.step();
    }
    close2(velocity(&world, id), (0.6, 0.8), velocity_budget(60));
    close2(position(&world, id), (0.3, 0.4), budget(60));
}

#[test]
fn tm_newton_sec_law_rot_mot() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&spun_box("74.5", 200.0)).expect("accepted");
    run(&mut world, 60);
    close(omega(&world, id), 2.684_563_758, 5e-10);
}

#[test]
fn gd_accel_gravity_points_anywhere() {
    for (gx, gy) in [(0.0, 0.0), (3.0, 0.0), (-3.0, 4.0), (0.25, 1000.0)] {
        constant_force(&dynamic("56.2", (0.412, 44.2)), (gx, gy), (gx, gy), &[]);
    }
}

#[test]
fn dd_torque_of_a_force_at_a_point() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&dynamic("2", (3.0, 4.0))).expect("accepted");
    world.set_mass(id, num("2"), num("30")).expect("accepted");
    world.apply_force(id, newtons(10.0, 0.0), Some(at(0.0, 10.0))).expect("accepted");
    world.step();
    // τ = r_x·F_y − r_y·F_x = −60 N m, so α = −2 rad/s² for one tick.
    close(omega(&world, id), -2.0 / 60.0, ULP_V);
    close2(velocity(&world, id), (5.0 / 60.0, 0.0), ULP_V);
    // It acted for one tick only.
    let (spin, speed) = (omega(&world, id), velocity(&world, id));
    run(&mut world, 10);
    assert_eq!((omega(&world, id), velocity(&world, id)), (spin, speed));
}

#[test]
fn dd_chasles_thm() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef {
        velocity: vel(0.0, -5.0),
        angular_velocity: num("2"),
        position: at(10.0, 20.0),
        ..BodyDef::default()
    };
    let id = world.create_body(&def).expect("accepted");
    assert_eq!(world.body(id).expect("it exists").velocity_at(at(11.0, 19.0)), vel(2.0, -3.0));
    assert_eq!(world.body(id).expect("it exists").velocity_at(at(10.0, 20.0)), vel(0.0, -5.0));
}

#[test]
fn dd_k_energy() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef { mass: Some(num("56.2")), velocity: vel(2.51, 0.0), ..BodyDef::default() };
    let id = world.create_body(&def).expect("accepted");
    close(world.body(id).expect("it exists").kinetic_energy().to_f64(), 177.032_81, 1e-8);
    let def = BodyDef { inertia: Some(num("74.5")), angular_velocity: num("2.1"), ..def };
    let id = world.create_body(&def).expect("accepted");
    let want = 0.5 * 56.2 * 2.51 * 2.51 + 0.5 * 74.5 * 2.1 * 2.1;
    close(world.body(id).expect("it exists").kinetic_energy().to_f64(), want, 1e-8);
}

#[test]
fn dd_pot_energy_and_kinetic_energy_of_a_falling_body_stay_constant() {
    let (mass, g, ticks) = (10.0, 9.8, 600u64);
    let mut world = world(0.0, -g);
    let id = world.create_body(&BodyDef { velocity: vel(7.0, 3.0), ..dynamic("10", (-5.0, 500.0)) }).expect("accepted");
    let total = |world: &World| {
        let body = world.body(id).expect("it exists");
        body.kinetic_energy().to_f64() + body.potential_energy().to_f64()
    };
    let start = total(&world);
    close(start, 0.5 * mass * 58.0 + mass * g * 500.0, 1e-7);
    let mut worst = 0.0f64;
    for tick in 1..=ticks {
        world.step();
        let n = tick as f64;
        // m·g times the position's rounding, and m·v times the velocity's.
        let bound = mass * g * budget(tick) + mass * 100.0 * n * ULP_V + 1e-10;
        close(total(&world), start, bound);
        worst = worst.max((total(&world) - start).abs());
    }
    println!("KE + PE of {start} J drifts by {worst:e} J in {ticks} ticks");
}

#[test]
fn dd_impulse_v_central() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&dynamic("1", (3.0, 4.0))).expect("accepted");
    world.apply_impulse(id, newton_seconds(10.0, 0.0), None).expect("accepted");
    let body = world.body(id).expect("it exists");
    assert_eq!(body.velocity(), vel(10.0, 0.0));
    assert_eq!(body.angular_velocity(), AngularVelocity::ZERO);
    world.apply_impulse(id, newton_seconds(-4.0, 2.5), None).expect("accepted");
    assert_eq!(world.body(id).expect("it exists").velocity(), vel(6.0, 2.5));
}

#[test]
fn dd_impulse_v_off_centre() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef { inertia: Some(num("30")), ..dynamic("2", (3.0, 4.0)) };
    let id = world.create_body(&def).expect("accepted");
    world.apply_impulse(id, newton_seconds(10.0, 0.0), Some(at(0.0, 10.0))).expect("accepted");
    let body = world.body(id).expect("it exists");
    assert_eq!(body.velocity(), vel(5.0, 0.0));
    // r × J = −60 N m s over 30 kg m².
    assert_eq!(body.angular_velocity(), num("-2"));
    world.apply_angular_impulse(id, num("75")).expect("accepted");
    assert_eq!(world.body(id).expect("it exists").angular_velocity(), num("0.5"));
    // A body that does not turn only moves.
    world.set_fixed_rotation(id, true).expect("accepted");
    world.apply_impulse(id, newton_seconds(10.0, 0.0), Some(at(0.0, 10.0))).expect("accepted");
    let body = world.body(id).expect("it exists");
    assert_eq!((body.velocity(), body.angular_velocity()), (vel(10.0, 0.0), AngularVelocity::ZERO));
}

/// Total momentum of bodies of mass 1, in units of velocity.
fn momentum(world: &World) -> [i128; 2] {
    world.bodies().fold([0; 2], |[x, y], body| {
        let v = body.velocity();
        [x + i128::from(v.x.to_bits()), y + i128::from(v.y.to_bits())]
    })
}

#[test]
fn tm_newton_third_law_two_equal_bodies_keep_momentum_to_the_bit() {
    let mut world = world(0.0, 0.0);
    for (x, v) in [(-5.0, -1.3), (5.0, 1.9)] {
        let def = BodyDef { mu: num("100"), velocity: vel(0.1, v), ..dynamic("1", (x, 0.3)) };
        world.create_body(&def).expect("accepted");
    }
    let start = momentum(&world);
    for _ in 0..10_000 {
        world.step();
        assert_eq!(momentum(&world), start);
    }
    let speeds = world.bodies().map(|body| body.velocity()).collect::<Vec<_>>();
    assert_ne!(speeds[0], vel(0.1, -1.3), "they do pull each other");
    assert!(world.status().is_clear());
}

#[test]
fn tm_newton_third_law_unequal_masses_drift_within_rounding() {
    let mut world = world(0.0, 0.0);
    // μ = G·m with a large G, so that the forces are opposite: m_a·μ_b = m_b·μ_a.
    for (mass, mu, x, v) in [("2", "20", -5.0, 0.0), ("7", "70", 5.0, 1.2)] {
        let def = BodyDef { mu: num(mu), velocity: vel(0.0, v), ..dynamic(mass, (x, 0.3)) };
        world.create_body(&def).expect("accepted");
    }
    let total = |world: &World| {
        world.bodies().fold([0i128; 2], |[x, y], body| {
            let (v, m) = (body.velocity(), body.mass().to_bits() >> 64);
            [x + m * i128::from(v.x.to_bits()), y + m * i128::from(v.y.to_bits())]
        })
    };
    let start = total(&world);
    run(&mut world, 10_000);
    let drift = [0, 1].map(|i| (total(&world)[i] - start[i]).unsigned_abs());
    // Per substep and body half a unit for a·T and, through it, a fraction of one for a: one unit times the mass.
    println!("momentum drift {drift:?} units of 2^-48 kg m/s, budget {}", 40_000 * 9);
    assert!(drift.iter().all(|&d| d <= 40_000 * 9), "{drift:?}");
    assert!(world.status().is_clear());
}

#[test]
fn tm_newton_third_law_fifty_bodies_drift_within_half_a_unit_each_per_tick() {
    let mut world = World::new(&WorldDef { substeps: 1, ..WorldDef::default() }).expect("accepted");
    let mut rng = Rng(3);
    for i in 0..50u32 {
        let place = (f64::from(i % 10) * 30.0 + rng.unit(), f64::from(i / 10) * 30.0 + rng.unit());
        let def = BodyDef { mu: num("0.25"), velocity: vel(rng.unit() - 0.5, rng.unit() - 0.5), ..dynamic("1", place) };
        world.create_body(&def).expect("accepted");
    }
    let start = momentum(&world);
    let ticks = 10_000;
    run(&mut world, ticks);
    let drift = [0, 1].map(|i| (momentum(&world)[i] - start[i]).unsigned_abs());
    println!("momentum drift of 50 bodies {drift:?} units of 2^-48 m/s, budget {}", ticks * 25);
    assert!(drift.iter().all(|&d| d <= u128::from(ticks) * 25), "{drift:?}");
    assert!(world.status().is_clear());
}

#[test]
fn fr_input_getters_return_the_bits_that_were_set() {
    let (mass, inertia) = (Mass::from_bits(0x1234_5678_9abc), Inertia::from_bits(0x1234_5678_9abc_def0_1234_5678));
    let def = BodyDef {
        kind: BodyKind::Dynamic,
        position: Vec2::new(Length::from_bits(0x0123_4567_89ab_cdef), Length::from_bits(-0x0fed_cba9_8765_4321)),
        angle: Angle::from_bits(-0x7123_4567_89ab_cdef),
        velocity: Vec2::new(Velocity::from_bits(i64::MAX), Velocity::from_bits(-0x1234_5678_9abc_def1)),
        angular_velocity: AngularVelocity::from_bits(-i64::MAX),
        force: Vec2::new(tamias2d::Force::from_bits(1), tamias2d::Force::from_bits(-3)),
        torque: Torque::from_bits(-7),
        mass: Some(mass),
        inertia: Some(inertia),
        center: Some(at(0.0, 0.0)),
        fixed_rotation: false,
        linear_damping: Damping::from_bits(1),
        angular_damping: Damping::from_bits(1000 << 48),
        mu: tamias2d::Mu::from_bits(1),
        user_data: u64::MAX - 1,
        allow_sleep: false,
        colliders: Vec::new(),
    };
    let mut created = world(0.0, 0.0);
    let id = created.create_body(&def).expect("accepted");
    assert_eq!(created.body(id).expect("it exists").def(), def);
    assert_eq!(created.body(id).expect("it exists").id(), id);

    // And by the setters, one at a time.
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&BodyDef::default()).expect("accepted");
    world.set_position(id, def.position).expect("accepted");
    world.set_angle(id, def.angle).expect("accepted");
    world.set_velocity(id, def.velocity).expect("accepted");
    world.set_angular_velocity(id, def.angular_velocity).expect("accepted");
    world.set_force(id, def.force).expect("accepted");
    world.set_torque(id, def.torque).expect("accepted");
    world.set_mass(id, mass, inertia).expect("accepted");
    world.set_damping(id, def.linear_damping, def.angular_damping).expect("accepted");
    world.set_mu(id, def.mu).expect("accepted");
    world.set_user_data(id, def.user_data).expect("accepted");
    world.set_allow_sleep(id, false).expect("accepted");
    let body = world.body(id).expect("it exists");
    assert_eq!(body.def(), def);
    assert_eq!(
        (body.kind(), body.position(), body.angle(), body.velocity(), body.angular_velocity()),
        (def.kind, def.position, def.angle, def.velocity, def.angular_velocity)
    );
    assert_eq!((body.mass(), body.user_data()), (mass, def.user_data));
    assert_eq!(world.hash(), created.hash());
    assert_eq!(world.diff(&created), []);

    let gravity = acc(-0.1, 32_767.9);
    world.set_gravity(gravity).expect("accepted");
    assert_eq!(world.config().gravity, gravity);
    let attractor = Attractor { position: def.position, mu: num("2e21") };
    let pull = world.create_attractor(attractor).expect("accepted");
    assert_eq!(world.attractor(pull), Some(attractor));
}

#[test]
fn a_body_with_fixed_rotation_is_moved_but_not_turned() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef { fixed_rotation: true, angle: Angle::from_bits(12345), ..dynamic("2", (0.0, 0.0)) };
    let id = world.create_body(&def).expect("accepted");
    for _ in 0..60 {
        world.apply_force(id, newtons(4.0, 0.0), Some(at(0.0, 3.0))).expect("accepted");
        world.step();
    }
    let body = world.body(id).expect("it exists");
    assert_eq!((body.angle(), body.angular_velocity()), (Angle::from_bits(12345), AngularVelocity::ZERO));
    close2(velocity(&world, id), (2.0, 0.0), velocity_budget(60));
    // Set free, it turns again; fixed while a torque waits for its tick, it stands still and stays so.
    world.set_fixed_rotation(id, false).expect("accepted");
    world.apply_torque(id, num("6")).expect("accepted");
    world.step();
    assert!(omega(&world, id) > 0.0);
    world.apply_torque(id, num("6")).expect("accepted");
    world.set_fixed_rotation(id, true).expect("accepted");
    assert_eq!(omega(&world, id), 0.0);
    let angle = world.body(id).expect("it exists").angle();
    run(&mut world, 10);
    assert_eq!((world.body(id).expect("it exists").angle(), omega(&world, id)), (angle, 0.0));
}

#[test]
fn a_kinematic_body_moves_by_its_velocity_and_ignores_gravity() {
    let mut world = world(0.0, -9.8);
    world.create_attractor(Attractor { position: at(10.0, 0.0), mu: num("1000") }).expect("accepted");
    let def = BodyDef {
        kind: BodyKind::Kinematic,
        velocity: vel(1.5, -0.25),
        angular_velocity: num("3"),
        ..dynamic("1", (1.0, 2.0))
    };
    let id = world.create_body(&def).expect("accepted");
    run(&mut world, 120);
    let body = world.body(id).expect("it exists");
    assert_eq!((body.velocity(), body.angular_velocity()), (def.velocity, def.angular_velocity));
    // With attraction four substeps make five drifts, each rounded.
    let drifts = 120.0 * 5.0 * f64::from(world.config().substeps.div_ceil(4));
    close2(position(&world, id), (4.0, 1.5), drifts * ULP_X / 2.0);
    close(phi(&world, id), 6.0, drifts * ULP_PHI);
}

#[test]
fn a_static_body_stays() {
    for attracted in [false, true] {
        let mut world = world(5.0, -9.8);
        if attracted {
            world.create_attractor(Attractor { position: at(10.0, 0.0), mu: num("1000") }).expect("accepted");
        }
        let center = Some(at(0.0, 0.0));
        let def = BodyDef { kind: BodyKind::Static, angle: Angle::from_bits(77), center, ..dynamic("1", (1.0, 2.0)) };
        let id = world.create_body(&def).expect("accepted");
        run(&mut world, 120);
        assert_eq!(world.body(id).expect("it exists").def(), def);
    }
}

#[test]
fn a_force_that_is_set_persists_and_one_that_is_applied_lasts_a_tick() {
    let mut world = world(0.0, 0.0);
    let set = world.create_body(&dynamic("1", (0.0, 0.0))).expect("accepted");
    let applied = world.create_body(&dynamic("1", (0.0, 0.0))).expect("accepted");
    world.set_force(set, newtons(60.0, 0.0)).expect("accepted");
    world.set_torque(set, num("60")).expect("accepted");
    world.apply_force(applied, newtons(60.0, 0.0), None).expect("accepted");
    world.apply_torque(applied, num("60")).expect("accepted");
    let moving = world.hash_parts();
    world.step();
    close2(velocity(&world, set), (1.0, 0.0), ULP_V);
    assert_eq!(velocity(&world, applied), velocity(&world, set));
    assert_eq!(omega(&world, applied), omega(&world, set));
    let forces =
        |parts: [tamias2d::HashPart; 9]| parts.into_iter().find(|part| part.name == "forces").expect("a part").hash;
    assert_ne!(forces(world.hash_parts()), forces(moving), "the applied force is gone from the state");
    for tick in 2..=5 {
        world.step();
        close2(velocity(&world, set), (f64::from(tick), 0.0), 5.0 * ULP_V);
        close(omega(&world, set), f64::from(tick), 5.0 * ULP_V);
        close2(velocity(&world, applied), (1.0, 0.0), ULP_V);
        close(omega(&world, applied), 1.0, ULP_V);
    }
    // Applied forces of one tick add up, and to the persistent one.
    for _ in 0..3 {
        world.apply_force(set, newtons(-40.0, 15.0), None).expect("accepted");
    }
    world.step();
    close2(velocity(&world, set), (5.0 - 1.0, 0.75), 8.0 * ULP_V);
    world.set_force(set, newtons(0.0, 0.0)).expect("accepted");
    let stays = velocity(&world, set);
    run(&mut world, 5);
    assert_eq!(velocity(&world, set), stays);
}

/// The closed form of v' = a − c·v after t: velocity and way.
fn damped(v0: f64, a: f64, c: f64, t: f64) -> (f64, f64) {
    let y = c * t;
    let e = -(-y).exp_m1();
    // (1 − e^−y)/c, and (t − that)/c without cancellation for small y.
    let first = e / c;
    let second = if y < 1e-3 { t * t * (0.5 - y / 6.0 + y * y / 24.0) } else { (t - first) / c };
    (v0 * (-y).exp() + a * first, v0 * first + a * second)
}

#[test]
fn lc_include_dampening_follows_the_closed_form() {
    for (index, c) in [0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 60.0, 100.0, 333.3, 1000.0].into_iter().enumerate() {
        for (tick_rate, force) in [(60, 0.0), (60, 9.8), (15, -3.0), (1000, 2.5)] {
            let mut world = World::new(&WorldDef { tick_rate, ..WorldDef::default() }).expect("accepted");
            let rate = Damping::from_f64(c).expect("in range");
            let def = BodyDef {
                velocity: vel(25.0, -2.51),
                angular_velocity: num("2.1"),
                force: newtons(force, 2.0 * force),
                torque: Torque::from_f64(force).expect("in range"),
                linear_damping: rate,
                angular_damping: rate,
                ..dynamic("1", (0.0, 0.0))
            };
            // A neighbour without damping, so that the damped one is not alone in its columns.
            let free = world.create_body(&BodyDef { velocity: vel(25.0, 0.0), ..BodyDef::default() }).expect("ok");
            let id = world.create_body(&def).expect("accepted");
            let ticks = u64::from(tick_rate) * 2;
            for tick in 1..=ticks {
                world.step();
                let t = tick as f64 / f64::from(tick_rate);
                let ((vx, x), (vy, y)) = (damped(25.0, force, c, t), damped(-2.51, 2.0 * force, c, t));
                let (w, angle) = damped(2.1, force, c, t);
                close2(velocity(&world, id), (vx, vy), 1e-9);
                close2(velocity(&world, id), (vx, vy), tick as f64 * ULP_V + 1e-13 * (1.0 + vx.abs().max(vy.abs())));
                close2(position(&world, id), (x, y), 1e-9 + tick as f64 * ULP_X / 2.0);
                close(omega(&world, id), w, tick as f64 * ULP_V + 1e-12);
                close(phi(&world, id), angle, 1e-9);
            }
            assert_eq!(velocity(&world, free), (25.0, 0.0), "case {index}");
            // Terminal velocity a/c.
            if c >= 10.0 {
                close2(velocity(&world, id), (force / c, 2.0 * force / c), 25.0 * (-2.0 * c).exp() + 1e-9);
            }
        }
    }
}

#[test]
fn damping_does_not_stall_above_zero_nor_cross_it() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef { velocity: vel(-1.0, 1.0), linear_damping: num("10"), ..dynamic("1", (0.0, 0.0)) };
    let id = world.create_body(&def).expect("accepted");
    for _ in 0..600 {
        world.step();
        let v = world.body(id).expect("it exists").velocity();
        assert_eq!(v.x.to_bits(), -v.y.to_bits());
        assert!(v.y.to_bits() >= 0);
    }
    let v = world.body(id).expect("it exists").velocity();
    // e^−1/6 rounds 1, 2 and 3 units to themselves; that is 1e-14 m/s.
    assert!(v.y.to_bits() <= 3, "{v:?}");
}

#[test]
fn lc_variable_ode_solver_euler_has_its_first_order_error() {
    let (a, t) = (10.0, 4.0);
    let mut errors = Vec::new();
    for substeps in [1u32, 2, 4, 8, 16, 32, 64] {
        let config = WorldDef { integrator: Integrator::SymplecticEuler, substeps, ..WorldDef::default() };
        let mut world = World::new(&config).expect("accepted");
        let def = BodyDef { force: newtons(100.0, 0.0), ..dynamic("10", (20.0, 20.0)) };
        let id = world.create_body(&def).expect("accepted");
        run(&mut world, 240);
        let h = 1.0 / (60.0 * f64::from(substeps));
        let error = position(&world, id).0 - (20.0 + 0.5 * a * t * t);
        let rounding = budget(240 * u64::from(substeps));
        close(error, 0.5 * a * h * t, rounding);
        close(velocity(&world, id).0, a * t, velocity_budget(240 * u64::from(substeps)));
        errors.push(error);
    }
    for pair in errors.windows(2) {
        close(pair[0] / pair[1], 2.0, 1e-3);
    }
}

#[test]
fn a_free_body_keeps_its_velocities_to_the_bit_for_a_million_ticks() {
    let mut world = world(0.0, 0.0);
    let def = BodyDef {
        velocity: vel(2.51, -0.412),
        angular_velocity: num("-2.1"),
        position: at(44.2, -7.0),
        ..BodyDef::default()
    };
    let id = world.create_body(&def).expect("accepted");
    let ticks = 1_000_000u64;
    for _ in 0..ticks {
        world.step();
        let body = world.body(id).expect("it exists");
        assert!(body.velocity() == def.velocity && body.angular_velocity() == def.angular_velocity);
    }
    let body = world.body(id).expect("it exists");
    let mut worst = 0.0f64;
    for (p, p0, v) in
        [(body.position().x, def.position.x, def.velocity.x), (body.position().y, def.position.y, def.velocity.y)]
    {
        // v·10⁶/60 in units of 2^-48, compared in those.
        let exact = i128::from(v.to_bits()) * i128::from(ticks) / 60;
        let moved = (i128::from(p.to_bits()) - i128::from(p0.to_bits())) << 16;
        let ulps = (moved - exact) as f64 / 65_536.0;
        worst = worst.max(ulps.abs());
        assert!(ulps.abs() <= ticks as f64 / 2.0, "{ulps} units of 2^-32 m");
    }
    let want = -2.1 * ticks as f64 / 60.0;
    let drift = body.angle().to_radians_f64() - want;
    println!("after 10^6 ticks: position off by {worst:.0} units of 2^-32 m, angle off by {drift:e} rad");
    assert!(drift.abs() <= ticks as f64 * ULP_PHI / 2.0 + 1e-10, "{drift}");
    assert!(world.status().is_clear());
}

#[test]
fn dd_ang_disp_of_a_long_spin() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&BodyDef { angular_velocity: num("10"), ..BodyDef::default() }).expect("accepted");
    run(&mut world, 3600);
    let error = phi(&world, id) - 600.0;
    println!("10 rad/s for 60 s: {error:e} rad from 600");
    assert!(error.abs() <= 3600.0 * ULP_PHI / 2.0 + 2e-13, "{error}");
}

#[test]
fn every_tick_rate_and_substep_count_gives_the_same_constant_acceleration() {
    for leapfrog in [false, true] {
        for (tick_rate, substeps) in
            [(15, 1), (15, 64), (60, 1), (60, 2), (60, 4), (60, 64), (144, 3), (144, 33), (1000, 1), (1000, 64)]
        {
            let gravity = acc(1.25, -9.8);
            let mut world =
                World::new(&WorldDef { tick_rate, substeps, gravity, ..WorldDef::default() }).expect("accepted");
            if leapfrog {
                // Far away and as weak as can be: it pulls nothing, but the scheme is the one with substeps.
                let star = Attractor { position: at(1e9, 1e9), mu: tamias2d::Mu::from_bits(1) };
                world.create_attractor(star).expect("accepted");
            }
            let def = BodyDef {
                velocity: vel(3.0, 12.0),
                force: newtons(7.0, 0.5),
                torque: num("0.3"),
                angular_velocity: num("0.5"),
                ..dynamic("3", (100.0, 50.0))
            };
            let id = world.create_body(&def).expect("accepted");
            run(&mut world, u64::from(tick_rate) * 4);
            let (ax, ay) = (1.25 + 7.0 / 3.0, -9.8 + 0.5 / 3.0);
            close2(position(&world, id), (112.0 + 8.0 * ax, 98.0 + 8.0 * ay), 1e-6);
            close2(velocity(&world, id), (3.0 + 4.0 * ax, 12.0 + 4.0 * ay), 1e-8);
            close(phi(&world, id), 2.0 + 2.4, 1e-8);
            assert!(world.status().is_clear());
        }
    }
}

/// The only entry of a world's status.
#[track_caller]
fn only_entry(world: &World) -> (u64, BodyId, Bound) {
    let [StatusEntry { tick, body, bound }] = world.status().entries() else {
        panic!("not one entry: {:?}", world.status());
    };
    (*tick, *body, *bound)
}

/// The status is there, is hashed and saved, stays, and goes away when it is cleared.
fn sticky(world: &mut World, id: BodyId, bound: Bound, text: &str) {
    let (tick, body, found) = only_entry(world);
    assert_eq!((body, found), (id, bound));
    assert_eq!(world.status().entries()[0].to_string(), format!("tick {tick}: {id} was limited in its {text}"));
    world.check().expect("every invariant holds");
    let mut cleared = world.clone();
    cleared.clear_status().expect("accepted");
    assert!(cleared.status().is_clear());
    assert_ne!(cleared.hash(), world.hash());
    assert_eq!(World::load(&world.save()).expect("just saved").status(), world.status());
    world.step();
    assert_eq!(only_entry(world), (tick, id, bound), "the first time is what is kept");
    *world = cleared;
}

/// A neighbour that nothing happens to, so that the body of interest is not the first one.
fn neighbour(world: &mut World) {
    world.create_body(&BodyDef { linear_damping: num("1"), ..BodyDef::default() }).expect("accepted");
}

#[test]
fn position_saturates_at_its_limit_and_says_so() {
    for sign in [1.0, -1.0] {
        for along_x in [true, false] {
            let pair = |a: f64| if along_x { (a, 5.0) } else { (5.0, a) };
            let mut world = world(0.0, 0.0);
            neighbour(&mut world);
            let (p, v) = (pair(sign * 999_999_999.0), pair(sign * 600.0));
            let def = BodyDef { position: at(p.0, p.1), velocity: vel(v.0, v.1), ..BodyDef::default() };
            let id = world.create_body(&def).expect("accepted");
            run(&mut world, 5);
            let limit = if sign > 0.0 {
                Length::from_bits(1_000_000_000 << 32)
            } else {
                Length::from_bits(-1_000_000_000 << 32)
            };
            let here = |world: &World| {
                let p = world.body(id).expect("it exists").position();
                if along_x { p.x } else { p.y }
            };
            assert_eq!(here(&world), limit);
            assert_eq!(world.body(id).expect("it exists").velocity(), def.velocity);
            sticky(&mut world, id, Bound::Position, "position");
            // It is limited again while it goes on, and comes back when its velocity turns.
            world.step();
            assert_eq!(only_entry(&world).2, Bound::Position);
            world.clear_status().expect("accepted");
            world.set_velocity(id, vel(-v.0, -v.1)).expect("accepted");
            run(&mut world, 60);
            close(here(&world).to_f64(), sign * (1e9 - 600.0), 1e-6);
            assert!(world.status().is_clear());
        }
    }
}

#[test]
fn velocity_saturates_at_its_limit_and_says_so() {
    for sign in [1i64, -1] {
        let mut world = world(0.0, 0.0);
        neighbour(&mut world);
        let def = BodyDef { velocity: vel(0.0, sign as f64 * 32_767.0), ..BodyDef::default() };
        let id = world.create_body(&def).expect("accepted");
        world.set_force(id, newtons(0.0, sign as f64 * 600.0)).expect("accepted");
        run(&mut world, 7);
        assert_eq!(world.body(id).expect("it exists").velocity().y, Velocity::from_bits(sign * i64::MAX));
        sticky(&mut world, id, Bound::Velocity, "velocity");
        world.set_force(id, newtons(0.0, sign as f64 * -600.0)).expect("accepted");
        world.step();
        close(velocity(&world, id).1, sign as f64 * (32_768.0 - 10.0), 1e-9);
        assert!(world.status().is_clear());
    }
}

#[test]
fn angular_velocity_saturates_at_its_limit_and_says_so() {
    for sign in [1i64, -1] {
        let mut world = world(0.0, 0.0);
        neighbour(&mut world);
        let spin = AngularVelocity::from_f64(sign as f64 * 32_767.0).expect("in range");
        let id = world.create_body(&BodyDef { angular_velocity: spin, ..BodyDef::default() }).expect("accepted");
        world.set_torque(id, Torque::from_f64(sign as f64 * 600.0).expect("in range")).expect("accepted");
        run(&mut world, 7);
        let body = world.body(id).expect("it exists");
        assert_eq!(body.angular_velocity(), AngularVelocity::from_bits(sign * i64::MAX));
        sticky(&mut world, id, Bound::AngularVelocity, "angular velocity");
    }
}

#[test]
fn acceleration_saturates_at_its_limit_and_says_so() {
    for sign in [1.0, -1.0] {
        let mut world = world(0.0, sign * 32_000.0);
        neighbour(&mut world);
        // Each alone is accepted, their sum is beyond the format.
        let def = BodyDef { force: newtons(0.0, sign * 1000.0), ..BodyDef::default() };
        let id = world.create_body(&def).expect("accepted");
        world.step();
        close(velocity(&world, id).1, sign * 32_768.0 / 60.0, 1e-9);
        sticky(&mut world, id, Bound::Acceleration, "acceleration");
        world.set_gravity(acc(0.0, 0.0)).expect("accepted");
        world.step();
        assert!(world.status().is_clear());
    }
}

#[test]
fn the_turns_saturate_and_the_orientation_stays_exact() {
    let turn = 1i64 << 48;
    for sign in [1i64, -1] {
        let mut world = world(0.0, 0.0);
        neighbour(&mut world);
        let spin = AngularVelocity::from_f64(sign as f64 * 100.3).expect("in range");
        let start = sign * (32_767 * turn + 12_345);
        let far = BodyDef { angle: Angle::from_bits(start), angular_velocity: spin, ..BodyDef::default() };
        let near = BodyDef { angle: Angle::from_bits(sign * 12_345), ..far.clone() };
        let far = world.create_body(&far).expect("accepted");
        let near = world.create_body(&near).expect("accepted");
        let mut limited_at = None;
        for tick in 0..3000u64 {
            world.step();
            let angle = |id| world.body(id).expect("it exists").angle();
            assert_eq!(angle(far).fraction(), angle(near).fraction(), "tick {tick}");
            assert!(angle(far).to_bits().unsigned_abs() >> 48 >= 32_766);
            if limited_at.is_none() && !world.status().is_clear() {
                limited_at = Some(tick);
                sticky(&mut world, far, Bound::Turns, "count of turns");
                break;
            }
        }
        // 100.3 rad/s are 0.266 turns in a tick: the fourth passes the limit.
        assert_eq!(limited_at, Some(3));
        for tick in 0..3000u64 {
            world.step();
            let angle = |id| world.body(id).expect("it exists").angle();
            assert_eq!(angle(far).fraction(), angle(near).fraction(), "tick {tick}");
        }
        world.check().expect("every invariant holds");
    }
}

#[test]
fn opposite_spins_beyond_the_last_turn_give_opposite_angles() {
    let turn = 1i64 << 48;
    let mut world = world(0.0, 0.0);
    let ids = [1i64, -1].map(|sign| {
        let def = BodyDef {
            angle: Angle::from_bits(sign * 32_767 * turn),
            angular_velocity: AngularVelocity::from_f64(sign as f64 * 60.0).expect("in range"),
            ..BodyDef::default()
        };
        world.create_body(&def).expect("accepted")
    });
    for tick in 0..1000 {
        world.step();
        let [a, b] = ids.map(|id| world.body(id).expect("it exists").angle().to_bits());
        assert_eq!(a, -b, "tick {tick}: {} and {} turns", a as f64 / turn as f64, b as f64 / turn as f64);
    }
}

fn negated(v: Vec2<Length>) -> Vec2<Length> {
    Vec2::new(Length::from_bits(-v.x.to_bits()), Length::from_bits(-v.y.to_bits()))
}

/// A command for the scene turned by half a turn about the origin: vectors are negated, scalars stay.
fn half_turned(command: Command) -> Command {
    macro_rules! minus {
        ($v:expr) => {{
            let v = $v;
            let (mut x, mut y) = (v.x, v.y);
            negate(&mut x);
            negate(&mut y);
            Vec2::new(x, y)
        }};
    }
    trait Negate {
        fn negate(&mut self);
    }
    macro_rules! negates {
        ($($type:ty)*) => {$(
            impl Negate for $type {
                fn negate(&mut self) {
                    *self = <$type>::from_bits(-self.to_bits());
                }
            }
        )*};
    }
    negates! { Length Velocity tamias2d::Force tamias2d::Impulse tamias2d::Acceleration }
    fn negate(value: &mut impl Negate) {
        value.negate();
    }
    match command {
        Command::CreateBody { def } => Command::CreateBody {
            def: BodyDef {
                position: minus!(def.position),
                velocity: minus!(def.velocity),
                force: minus!(def.force),
                ..def
            },
        },
        Command::SetPosition { body, position } => Command::SetPosition { body, position: minus!(position) },
        Command::SetVelocity { body, velocity } => Command::SetVelocity { body, velocity: minus!(velocity) },
        Command::SetForce { body, force } => Command::SetForce { body, force: minus!(force) },
        Command::ApplyForce { body, force, point } => {
            Command::ApplyForce { body, force: minus!(force), point: point.map(negated) }
        }
        Command::ApplyImpulse { body, impulse, point } => {
            Command::ApplyImpulse { body, impulse: minus!(impulse), point: point.map(negated) }
        }
        Command::CreateAttractor { attractor } => {
            Command::CreateAttractor { attractor: Attractor { position: negated(attractor.position), ..attractor } }
        }
        Command::SetAttractor { id, attractor } => {
            Command::SetAttractor { id, attractor: Attractor { position: negated(attractor.position), ..attractor } }
        }
        Command::SetGravity { gravity } => Command::SetGravity { gravity: minus!(gravity) },
        other => other,
    }
}

fn moved_by(v: Vec2<Length>, by: (i64, i64)) -> Vec2<Length> {
    Vec2::new(Length::from_bits(v.x.to_bits() + by.0), Length::from_bits(v.y.to_bits() + by.1))
}

/// A command for the scene moved by `by`, in units of a position.
fn moved(command: Command, by: (i64, i64)) -> Command {
    let shift = |p: Vec2<Length>| moved_by(p, by);
    match command {
        Command::CreateBody { def } => Command::CreateBody { def: BodyDef { position: shift(def.position), ..def } },
        Command::SetPosition { body, position } => Command::SetPosition { body, position: shift(position) },
        Command::ApplyForce { body, force, point } => Command::ApplyForce { body, force, point: point.map(shift) },
        Command::ApplyImpulse { body, impulse, point } => {
            Command::ApplyImpulse { body, impulse, point: point.map(shift) }
        }
        Command::CreateAttractor { attractor } => {
            Command::CreateAttractor { attractor: Attractor { position: shift(attractor.position), ..attractor } }
        }
        Command::SetAttractor { id, attractor } => {
            Command::SetAttractor { id, attractor: Attractor { position: shift(attractor.position), ..attractor } }
        }
        other => other,
    }
}

fn config() -> impl Strategy<Value = WorldDef> {
    let rate = prop_oneof![Just(15u32), Just(60), Just(144), Just(1000), 15u32..=1000];
    let scheme = prop_oneof![Just(Integrator::ForestRuth), Just(Integrator::SymplecticEuler)];
    (rate, 1u32..=8, scheme).prop_map(|(tick_rate, substeps, integrator)| WorldDef {
        tick_rate,
        substeps,
        integrator,
        ..WorldDef::default()
    })
}

fn few_cases() -> ProptestConfig {
    ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(few_cases())]

    /// Rounding is odd, so a scene turned by half a turn gives the negated bits at each tick.
    #[test]
    fn a_half_turned_scene_gives_the_negated_bits(seed in any::<u64>(), config in config(), ticks in 1u64..80) {
        let mut storm = Storm::new(seed, 1e6);
        let (mut one, mut other) = (World::new(&config).expect("accepted"), World::new(&config).expect("accepted"));
        for _ in 0..ticks {
            for _ in 0..storm.rng.below(6) {
                let command = storm.command();
                let turned = other.apply(half_turned(command.clone()));
                let reply = storm.heed(one.apply(command));
                prop_assert_eq!(turned.ok(), reply.ok());
            }
            one.step();
            other.step();
            prop_assert_eq!(one.body_count(), other.body_count());
            for (a, b) in one.bodies().zip(other.bodies()) {
                let (v, w) = (a.velocity(), b.velocity());
                prop_assert_eq!(a.position(), negated(b.position()));
                prop_assert_eq!([v.x.to_bits(), v.y.to_bits()], [-w.x.to_bits(), -w.y.to_bits()]);
                prop_assert_eq!((a.angle(), a.angular_velocity()), (b.angle(), b.angular_velocity()));
                prop_assert_eq!(a.kinetic_energy(), b.kinetic_energy());
                prop_assert_eq!(a.potential_energy(), b.potential_energy());
            }
            prop_assert_eq!(one.status(), other.status());
        }
        prop_assert_eq!(one.check(), Ok(()));
        prop_assert_eq!(other.check(), Ok(()));
    }

    /// Nothing but differences of positions enters the motion: far from the origin a scene has the same bits.
    #[test]
    fn a_moved_scene_gives_the_same_bits(seed in any::<u64>(), config in config(), ticks in 1u64..80, far in 0usize..4) {
        let by = [(1i64 << 52, 0), (1 << 61, 0), (-(1 << 61), 1 << 61), (12_345, -(1 << 52) - 1)][far];
        let mut storm = Storm::new(seed, 1e6);
        let (mut one, mut other) = (World::new(&config).expect("accepted"), World::new(&config).expect("accepted"));
        for _ in 0..ticks {
            for _ in 0..storm.rng.below(6) {
                let command = storm.command();
                let there = other.apply(moved(command.clone(), by));
                let reply = storm.heed(one.apply(command));
                prop_assert_eq!(there.ok(), reply.ok());
            }
            one.step();
            other.step();
            for (a, b) in one.bodies().zip(other.bodies()) {
                prop_assert_eq!(moved_by(a.position(), by), b.position());
                prop_assert_eq!(a.velocity(), b.velocity());
                prop_assert_eq!((a.angle(), a.angular_velocity()), (b.angle(), b.angular_velocity()));
            }
            prop_assert_eq!(one.status(), other.status());
        }
    }

    /// Constant acceleration of any size, to the rounding budget.
    #[test]
    fn constant_acceleration_of_any_size(
        p in (-1e6..1e6f64, -1e6..1e6f64),
        v in (-1e3..1e3f64, -1e3..1e3f64),
        exponent in -6..3i32,
        a in (-9.0..9.0f64, -9.0..9.0f64),
    ) {
        let scale = 10f64.powi(exponent);
        let def = BodyDef { position: at(p.0, p.1), velocity: vel(v.0, v.1), ..BodyDef::default() };
        let g = acc(a.0 * scale, a.1 * scale);
        let mut world = World::new(&WorldDef { gravity: g, ..WorldDef::default() }).expect("accepted");
        let id = world.create_body(&def).expect("accepted");
        run(&mut world, 120);
        let (start, v, g) = (def.position.to_f64(), def.velocity.to_f64(), g.to_f64());
        let want = (start.0 + 2.0 * v.0 + 2.0 * g.0, start.1 + 2.0 * v.1 + 2.0 * g.1);
        close2(position(&world, id), want, budget(120) + 1e-9);
        close2(velocity(&world, id), (v.0 + 2.0 * g.0, v.1 + 2.0 * g.1), velocity_budget(120));
    }
}
