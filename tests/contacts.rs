//! Contacts: impulses against closed forms (GD:impulse, IM:col2D, VE1, VE3, TC10c, TC11c), friction, what contacts must
//! not change, events, and that contacts are state like everything else.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;

use common::{
    Rng, Storm, ULP_V, acc, at, close, close2, disc, newtons, num, omega, position, rectangle, run, vel, velocity,
    world,
};
use num_bigint::BigInt;
use solid::{
    add, bits, energy, fastest, fixed, get, mass_of, moving, polygon, scaled_world, solid, spin, surface, turned,
    weighing, worst_overlap,
};
use tamias2d::{
    Angle, BodyDef, BodyId, BodyKind, Bound, ColliderDef, ColliderId, Commands, Damping, Density, Event, EventKind,
    Filter, Impact, ImpactError, Inertia, Length, Mass, RangeError, Restitution, Shape, Striker, Vec2, Velocity, World,
    impact,
};

// The impulse by itself (GD:impulse, IM:col2D, DD:reVeInColl).

fn striker(mass: &str, inertia: &str, v: (f64, f64), omega: f64, arm: (f64, f64)) -> Striker {
    Striker {
        mass: Some(num(mass)),
        inertia: Some(num(inertia)),
        velocity: vel(v.0, v.1),
        angular_velocity: spin(omega),
        arm: at(arm.0, arm.1),
    }
}

fn ve1() -> [Striker; 2] {
    [striker("2", "3", (0.0, -5.0), 2.0, (1.0, -1.0)), striker("4", "6", (0.0, 1.0), -1.0, (-1.0, 1.0))]
}

fn hit(a: &Striker, b: &Striker, normal: (f64, f64), restitution: f64) -> Impact {
    impact(a, b, at(normal.0, normal.1), Restitution::from_f64(restitution).expect("in range")).expect("a collision")
}

#[test]
fn ve1_gives_the_impulse_and_all_velocities() {
    let [a, b] = ve1();
    // e, j, v_A, ω_A, v_B, ω_B.
    let table = [
        (0.0, 4.0, -3.0, 10.0 / 3.0, 0.0, -1.0 / 3.0),
        (0.5, 6.0, -2.0, 4.0, -0.5, 0.0),
        (1.0, 8.0, -1.0, 14.0 / 3.0, -1.0, 1.0 / 3.0),
    ];
    for (e, j, va, wa, vb, wb) in table {
        let Impact { impulse, speed_before, a, b } = hit(&a, &b, (0.0, 1.0), e);
        close2(impulse.to_f64(), (0.0, j), 1e-15);
        assert_eq!(speed_before, num("-5"));
        for (got, want) in [(a, (va, wa)), (b, (vb, wb))] {
            close2(got.velocity.to_f64(), (0.0, want.0), ULP_V);
            close(got.angular_velocity.to_f64(), want.1, ULP_V);
        }
    }
}

#[test]
fn the_length_of_the_normal_does_not_matter() {
    let [a, b] = ve1();
    // Along an axis: the same bits, from the shortest to the longest.
    let one = hit(&a, &b, (0.0, 1.0), 0.5);
    assert_eq!(hit(&a, &b, (0.0, 10.0), 0.5), one);
    for bits in [1, 2, 1 << 20, 10 << 32, i64::MAX] {
        let normal = Vec2::new(Length::ZERO, Length::from_bits(bits));
        assert_eq!(impact(&a, &b, normal, num("0.5")), Ok(one), "length {bits} · 2⁻³² m");
    }
}

#[test]
fn the_length_of_an_oblique_normal_does_not_matter() {
    let [a, b] = ve1();
    let one = hit(&a, &b, (1.0, 2.0), 0.5);
    for k in [1i64, 3, 1 << 10, 1 << 20, 1 << 40, 1 << 60] {
        let normal = Vec2::new(Length::from_bits(k), Length::from_bits(2 * k));
        let other = impact(&a, &b, normal, num("0.5")).expect("a collision");
        let drift = |x: Velocity, y: Velocity| (x.to_bits() - y.to_bits()).abs();
        let worst = drift(one.a.velocity.x, other.a.velocity.x).max(drift(one.a.velocity.y, other.a.velocity.y));
        assert!(worst <= 8, "a normal of {normal:?} gives {:?} instead of {:?}", other.a.velocity, one.a.velocity);
    }
}

#[test]
fn a_partner_without_mass_has_no_inverse_mass() {
    let [a, b] = ve1();
    // D = 1/2 + 1/3, v·n = −3: j = 3.6·(1 + e).
    for (e, j) in [(0.0, 3.6), (0.5, 5.4), (1.0, 7.2)] {
        let Impact { impulse, a: after, b: wall, .. } = hit(&a, &Striker::default(), (0.0, 1.0), e);
        close2(impulse.to_f64(), (0.0, j), 1e-14);
        close(after.velocity.y.to_f64(), -5.0 + j / 2.0, ULP_V);
        close(after.angular_velocity.to_f64(), 2.0 + j / 3.0, ULP_V);
        assert_eq!(wall, Striker::default());
    }
    // A moving one keeps its velocities, to the bit, on either side.
    let pusher = Striker { mass: None, inertia: None, ..b };
    let Impact { a: after, b: wall, .. } = hit(&a, &pusher, (0.0, 1.0), 1.0);
    assert_eq!(wall, pusher);
    // v·n −5 turns into +5 at the point.
    close(after.velocity.y.to_f64() + after.angular_velocity.to_f64() - 2.0, 5.0, 4.0 * ULP_V);
    let Impact { b: mirrored, .. } = hit(&pusher, &a, (0.0, -1.0), 1.0);
    assert_eq!(mirrored, after);
}

#[test]
fn what_does_not_approach_gets_no_impulse() {
    let [a, b] = ve1();
    let Impact { impulse, speed_before, a: after_a, b: after_b } = hit(&a, &b, (0.0, -1.0), 1.0);
    assert_eq!((impulse, speed_before), (Vec2::default(), num("5")));
    assert_eq!((after_a, after_b), (a, b));
    // Nor does what only slides along.
    let still = striker("2", "3", (4.0, 0.0), 0.0, (0.0, -1.0));
    assert_eq!(hit(&still, &Striker::default(), (0.0, 1.0), 1.0).a, still);
}

#[test]
fn refused_collisions_say_why() {
    let [a, b] = ve1();
    let text = |a: &Striker, b: &Striker, n: Vec2<Length>, e: Restitution| {
        impact(a, b, n, e).expect_err("refused").to_string()
    };
    let (up, e) = (at(0.0, 1.0), num("0.5"));
    assert_eq!(impact(&a, &b, Vec2::default(), e), Err(ImpactError::ZeroNormal));
    assert_eq!(text(&a, &b, Vec2::default(), e), "the normal is zero");
    let wall = Striker { velocity: vel(0.0, -1.0), ..Striker::default() };
    assert_eq!(impact(&wall, &Striker::default(), up, e), Err(ImpactError::BothFixed));
    assert_eq!(text(&wall, &Striker::default(), up, e), "neither body has a mass");
    assert_eq!(
        text(&a, &b, up, Restitution::from_bits((1 << 48) + 1)),
        "restitution 1.000000000000003552713678800500929355621337890625 is outside 0 … 1"
    );
    assert_eq!(
        text(&a, &b, up, Restitution::from_bits(-1)),
        "restitution -0.000000000000003552713678800500929355621337890625 is outside 0 … 1"
    );
    let light = Striker { mass: Some(Mass::ZERO), ..a };
    assert_eq!(text(&light, &b, up, e), "mass 0 kg is outside 0.000001 … 2100000000 kg");
    assert_eq!(text(&b, &light, up, e), "mass 0 kg is outside 0.000001 … 2100000000 kg");
    let thin = Striker { inertia: Some(Inertia::ZERO), ..a };
    assert_eq!(text(&thin, &b, up, e), "inertia 0 kg m² is outside 1e-12 … 1e18 kg m²");
    let longest = Striker { arm: at(32_768.0, -32_768.0), angular_velocity: num("0"), ..a };
    assert!(impact(&longest, &b, up, e).is_ok());
    let long = Striker { arm: at(32_769.0, 0.0), ..a };
    assert_eq!(impact(&long, &b, up, e), Err(ImpactError::Arm { value: num("32769") }));
    assert_eq!(text(&long, &b, up, e), "arm coordinate 32769 m is outside ±32768 m");
}

#[test]
fn a_collision_that_leaves_the_range_of_velocities_is_refused() {
    // "A value outside its quantity's accepted range; velocities after the collision among them": 90 000 m/s after.
    let a = striker("1", "1", (0.0, -30_000.0), 0.0, (0.0, 0.0));
    let pusher = Striker { velocity: vel(0.0, 30_000.0), ..Striker::default() };
    match impact(&a, &pusher, at(0.0, 1.0), num("1")) {
        Err(ImpactError::Range(RangeError { quantity: "velocity", .. })) => {}
        other => panic!("90 000 m/s do not fit, but: {other:?}"),
    }
}

/// A random collision: two bodies, a normal of at least 1 m.
fn random_impact(rng: &mut Rng) -> (Striker, Striker, Vec2<Length>) {
    let mut one = || {
        let mut v = |r: f64| (rng.unit() * 2.0 - 1.0) * r;
        let (velocity, angular_velocity, arm) = (vel(v(50.0), v(50.0)), spin(v(10.0)), at(v(2.0), v(2.0)));
        let mass = Mass::from_f64(rng.scale(0.1, 1000.0)).expect("in range");
        let inertia = Inertia::from_f64(rng.scale(0.1, 1000.0)).expect("in range");
        Striker { mass: Some(mass), inertia: Some(inertia), velocity, angular_velocity, arm }
    };
    let (a, b) = (one(), one());
    let (angle, length) = (rng.unit() * std::f64::consts::TAU, rng.scale(1.0, 100.0));
    (a, b, at(angle.cos() * length, angle.sin() * length))
}

#[test]
fn impulses_keep_momentum_and_angular_momentum_to_the_rounding_of_velocities() {
    let mut rng = Rng(1);
    let big = |x: i64| BigInt::from(x);
    let mut struck = 0;
    for _ in 0..2000 {
        let (a, b, normal) = random_impact(&mut rng);
        let after = impact(&a, &b, normal, Restitution::from_f64(rng.unit()).expect("fits")).expect("a collision");
        struck += u32::from(!after.impulse.is_zero());
        // Twice the sums, in 2⁻¹¹² kg m/s and 2⁻¹⁴⁴ kg m²/s; no rounding here.
        let after_impulse = after.impulse;
        let mut line = [BigInt::ZERO, BigInt::ZERO];
        let (mut turn, mut line_budget, mut turn_budget) = (BigInt::ZERO, BigInt::ZERO, BigInt::from(1i128 << 80));
        for (before, after, sign) in [(a, after.a, 1), (b, after.b, -1)] {
            let (m, i) = (before.mass.expect("has one").to_bits(), before.inertia.expect("has one").to_bits());
            let dv = [
                big(after.velocity.x.to_bits() - before.velocity.x.to_bits()) * m,
                big(after.velocity.y.to_bits() - before.velocity.y.to_bits()) * m,
            ];
            // DD:impulseV: m·Δv is ±J of either, but for half a unit of v.
            for (dv, j) in dv.iter().zip([after_impulse.x, after_impulse.y]) {
                let off: BigInt = dv - (BigInt::from(j.to_bits()) << 48) * sign;
                assert!(off.magnitude() * 2u32 <= BigInt::from(m).magnitude() + 2u32, "m·Δv is not J");
            }
            let [rx, ry] = [before.arm.x.to_bits(), before.arm.y.to_bits()];
            turn += (big(after.angular_velocity.to_bits() - before.angular_velocity.to_bits()) * i) << 32;
            turn -= &dv[1] * rx - &dv[0] * ry;
            turn_budget += (BigInt::from(i) << 32) + BigInt::from(m) * (rx.abs() + ry.abs());
            line_budget += m;
            line[0] += &dv[0];
            line[1] += &dv[1];
        }
        for sum in line {
            assert!(sum.magnitude() * 2u32 <= *line_budget.magnitude(), "momentum changed by {sum} · 2⁻¹¹²");
        }
        assert!(turn.magnitude() * 2u32 <= *turn_budget.magnitude(), "angular momentum changed by {turn} · 2⁻¹⁴⁴");
    }
    assert!(struck > 800, "only {struck} collisions");
}

#[test]
fn the_energy_that_an_impulse_takes_is_that_of_the_formula() {
    // ΔKE = −(1 − e²)·(v·n)²/(2D), properties of a correct solution.
    let mut rng = Rng(2);
    let mut compared = 0;
    for _ in 0..2000 {
        let (a, b, normal) = random_impact(&mut rng);
        let e = [0.0, 1.0, rng.unit()][rng.below(3) as usize];
        let after = hit(&a, &b, normal.to_f64(), e);
        let (nx, ny) = normal.to_f64();
        let (nx, ny) = (nx / nx.hypot(ny), ny / nx.hypot(ny));
        let (mut speed, mut denominator, mut gained) = (0.0, 0.0, 0.0);
        for (before, after, sign) in [(a, after.a, 1.0), (b, after.b, -1.0)] {
            let (m, i) = (before.mass.expect("one").to_f64(), before.inertia.expect("one").to_f64());
            let ((vx, vy), (rx, ry)) = (before.velocity.to_f64(), before.arm.to_f64());
            let w = before.angular_velocity.to_f64();
            speed += sign * ((vx - w * ry) * nx + (vy + w * rx) * ny);
            denominator += 1.0 / m + (rx * ny - ry * nx).powi(2) / i;
            // Differences and sums of squares by exact differences: nothing cancels.
            let square = |x: i64, y: i64| (y - x) as f64 * (x as f64 + y as f64) * ULP_V * ULP_V;
            gained += 0.5 * m * square(before.velocity.x.to_bits(), after.velocity.x.to_bits());
            gained += 0.5 * m * square(before.velocity.y.to_bits(), after.velocity.y.to_bits());
            gained += 0.5 * i * square(before.angular_velocity.to_bits(), after.angular_velocity.to_bits());
        }
        close(after.speed_before.to_f64(), speed, 1e-9 * (1.0 + speed.abs()));
        if speed > -1.0 {
            continue;
        }
        compared += 1;
        let whole = speed * speed / (2.0 * denominator);
        close(gained / whole, -(1.0 - e * e), 1e-9);
    }
    assert!(compared > 800, "only {compared} collisions");
}

// Impulses of shapes (FR:Determine-Collision-Response-Over-Time).

/// A world without gravity.
fn space() -> World {
    world(0.0, 0.0)
}

/// Velocity and spin of a box of 1 kg that came down flat with 3 m/s onto a fixed edge, `gap` below it.
fn land_flat(gap: f64, friction: f64, restitution: f64) -> ((f64, f64), f64) {
    let mut world = space();
    add(&mut world, fixed(0.0, -1.0, surface(rectangle(20.0, 2.0), friction, restitution)));
    let falling = solid(0.25, 0.5 + gap, surface(rectangle(1.0, 1.0), friction, restitution));
    let id = add(&mut world, moving(weighing(falling, 1.0), 0.0, -3.0));
    run(&mut world, 60);
    (velocity(&world, id), omega(&world, id))
}

/// Several distances, so that the impact lies at several parts of a tick.
const GAPS: [f64; 8] = [0.001, 0.005, 0.02, 0.05, 0.1, 0.118, 0.333, 1.0];

#[test]
fn ve3_a_box_that_lands_flat_bounces_without_spin() {
    for gap in GAPS {
        let (velocity, omega) = land_flat(gap, 0.0, 1.0);
        close2(velocity, (0.0, 3.0), 1e-5);
        close(omega, 0.0, 1e-5);
    }
}

#[test]
fn a_box_that_lands_flat_on_a_rough_edge_bounces_straight_up() {
    // VE3 with friction: nothing slides, so friction has nothing to do.
    for gap in GAPS {
        let (velocity, omega) = land_flat(gap, 0.6, 1.0);
        close2(velocity, (0.0, 3.0), 1e-5);
        close(omega, 0.0, 1e-5);
    }
}

#[test]
fn a_box_that_lands_flat_without_restitution_stays_flat() {
    for gap in GAPS {
        let (velocity, omega) = land_flat(gap, 0.0, 0.0);
        close2(velocity, (0.0, 0.0), 1e-3);
        close(omega, 0.0, 2e-3);
    }
}

/// Two bodies of these masses collide head-on, one of them coming with 2.51 m/s; every distance from [`GAPS`].
fn head_on(collider: &ColliderDef, friction: f64) {
    let mut wrong = Vec::new();
    for (masses, e, want) in [
        ([56.2, 56.2], 0.0, [1.255, 1.255]),
        ([56.2, 56.2], 0.8, [0.251, 2.259]),
        ([56.2, 56.2], 1.0, [0.0, 2.51]),
        ([1.0, 3.0], 1.0, [-1.255, 1.255]),
    ] {
        for gap in GAPS {
            let mut world = space();
            let collider = surface(collider.clone(), friction, e);
            let coming = weighing(solid(-1.0 - gap, 0.0, collider.clone()), masses[0]);
            let a = add(&mut world, moving(coming, 2.51, 0.0));
            let b = add(&mut world, weighing(solid(0.0, 0.0, collider), masses[1]));
            run(&mut world, 90);
            for (id, want) in [(a, want[0]), (b, want[1])] {
                let ((x, y), spin) = (velocity(&world, id), omega(&world, id));
                let off = (x - want).abs().max(y.abs()).max(spin.abs());
                if off > 1e-5 {
                    wrong.push(format!("{masses:?} kg, e {e}, {gap} m between: v ({x}, {y}) for {want}, ω {spin:e}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn head_on_collisions_of_discs_have_the_speeds_of_table_4() {
    head_on(&disc(0.5), 0.0);
    head_on(&disc(0.5), 0.6);
}

#[test]
fn head_on_collisions_of_boxes_have_the_speeds_of_table_4() {
    head_on(&rectangle(1.0, 1.0), 0.0);
}

#[test]
fn head_on_collisions_of_rough_boxes_have_the_speeds_of_table_4() {
    head_on(&rectangle(1.0, 1.0), 0.6);
}

#[test]
fn tc10c_two_driven_boxes_collide_and_come_back() {
    for unit_shift in [0, 4] {
        let mut world = scaled_world(0.0, 0.0, unit_shift);
        let mut driven = |x: f64, side: f64, force: f64| {
            let body = weighing(solid(x, 50.0, surface(rectangle(side, side), 0.0, 1.0)), 100.0);
            add(&mut world, BodyDef { force: newtons(force, 0.0), ..body })
        };
        let ids = [driven(0.0, 300.0, 500.0), driven(300.0, 100.0, -500.0)];
        let contact = 20f64.sqrt();
        for tick in 1..=537 {
            world.step();
            let t = f64::from(tick) / 60.0;
            let want = if t < contact { 5.0 * t } else { 5.0 * (t - 2.0 * contact) };
            let [a, b] = ids.map(|id| get(&world, id));
            close(a.velocity().x.to_f64(), want, 0.01 * 22.36);
            let bits = a.velocity().x.to_bits() + b.velocity().x.to_bits();
            assert_eq!(bits, 0, "momentum at tick {tick}, unit shift {unit_shift}");
            for body in [a, b] {
                assert_eq!(body.velocity().y, Velocity::ZERO);
                close(body.angular_velocity().to_f64(), 0.0, 1e-9);
            }
            if [60, 120, 180, 240].contains(&tick) {
                close(a.position().x.to_f64(), 2.5 * t * t, 1e-7);
            }
        }
        // Back at 8.944272 s, that is 536.66 ticks: of a way of 50 m, 1 %.
        close2(position(&world, ids[0]), (0.0, 50.0), 0.5);
        close2(position(&world, ids[1]), (300.0, 50.0), 0.5);
        world.check().expect("every invariant holds");
    }
}

/// TC11c: y down. The world, and the falling box.
fn tc11c(e: f64) -> (World, BodyId) {
    let mut world = world(0.0, 9.8);
    add(&mut world, fixed(0.0, 560.0, surface(rectangle(800.0, 100.0), 0.6, e)));
    let falling = weighing(solid(0.0, 260.0, surface(rectangle(300.0, 300.0), 0.6, e)), 100.0);
    let id = add(&mut world, falling);
    (world, id)
}

#[test]
fn tc11c_an_elastic_box_reverses_in_the_tick_of_the_impact() {
    let (mut world, id) = tc11c(1.0);
    let start = energy(&world);
    // t_c 4.517540 s is in the 272nd tick.
    run(&mut world, 271);
    close(velocity(&world, id).1, 9.8 * 271.0 / 60.0, 1e-9);
    world.step();
    let impact = 44.271_887;
    close(velocity(&world, id).1, -impact + 9.8 * (272.0 / 60.0 - 4.517_540), 0.01 * impact);
    for _ in 273..=540 {
        world.step();
        close(omega(&world, id), 0.0, 1e-5);
        // KE + PE, of the energy of the fall.
        close((energy(&world) - start) / (0.5 * 100.0 * impact * impact), 0.0, 0.02);
    }
}

#[test]
fn tc11c_an_inelastic_box_rests() {
    let (mut world, id) = tc11c(0.0);
    run(&mut world, 272 + 60);
    for _ in 0..300 {
        world.step();
        close2(velocity(&world, id), (0.0, 0.0), 1e-4);
        close(omega(&world, id), 0.0, 1e-5);
        close2(position(&world, id), (0.0, 360.0), 0.002);
    }
}

// Friction (FR:Input-Surface-Properties).

#[test]
fn without_friction_a_collision_leaves_the_tangential_velocity() {
    // Walls along the axes: to the bit. Wall, its place, and the velocity with which a box or disc comes.
    let walls = [
        (rectangle(40.0, 2.0), (0.0, -2.0), (2.3, -3.1)),
        (rectangle(40.0, 2.0), (0.0, 2.0), (-1.7, 3.1)),
        (rectangle(2.0, 40.0), (-2.0, 0.0), (-3.1, 0.9)),
        (rectangle(2.0, 40.0), (2.0, 0.0), (3.1, -2.9)),
    ];
    for (wall, (x, y), (vx, vy)) in walls {
        for shape in [rectangle(1.0, 1.0), disc(0.5)] {
            for e in [0.0, 0.5, 1.0] {
                let mut world = space();
                add(&mut world, fixed(x, y, surface(wall.clone(), 1.0, e)));
                let id = add(&mut world, moving(solid(0.0, 0.0, surface(shape.clone(), 0.0, 0.0)), vx, vy));
                run(&mut world, 60);
                let (v, before) = (get(&world, id).velocity(), vel(vx, vy));
                let ((along, kept), (across, old)) =
                    if x == 0.0 { ((v.x, before.x), (v.y, before.y)) } else { ((v.y, before.y), (v.x, before.x)) };
                assert_eq!(along, kept, "{:?} at a wall at ({x}, {y})", shape.shape);
                close(across.to_f64(), -e * old.to_f64(), 1e-3);
                close(omega(&world, id), 0.0, 1e-3);
            }
        }
    }
}

#[test]
fn without_friction_an_oblique_wall_leaves_the_tangential_velocity() {
    for (tilt, e) in [(0.3f64, 1.0), (1.1, 0.5), (-0.7, 1.0), (2.4, 0.0)] {
        let (sin, cos) = tilt.sin_cos();
        let mut world = space();
        let wall = surface(rectangle(40.0, 2.0), 1.0, e);
        add(&mut world, BodyDef { angle: turned(tilt), ..fixed(1.6 * sin, -1.6 * cos, wall) });
        // 2 m/s along the wall and 3 m/s into it.
        let (vx, vy) = (2.0 * cos + 3.0 * sin, 2.0 * sin - 3.0 * cos);
        let id = add(&mut world, moving(solid(0.0, 0.0, surface(disc(0.5), 0.0, 0.0)), vx, vy));
        run(&mut world, 60);
        let (x, y) = velocity(&world, id);
        close(-x * sin + y * cos, 3.0 * e, 1e-5);
        // The wall's direction has 30 bits, of an impulse of 3·(1 + e) m/s; and what the point of contact does.
        close(x * cos + y * sin, 2.0, 6.0 * 2e-9);
        close(x * cos + y * sin + 0.5 * omega(&world, id), 2.0, 1e-7);
    }
}

/// Bits of a box that slides on a floor of these frictions, relative to where it starts, for 2 s.
fn slide(x: f64, frictions: [f64; 2]) -> Vec<[i64; 6]> {
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(x, -1.0, surface(rectangle(40.0, 2.0), frictions[0], 0.0)));
    let id = add(&mut world, moving(solid(x, 0.5, surface(rectangle(1.0, 1.0), frictions[1], 0.0)), 3.0, 0.0));
    let start = bits(&get(&world, id))[0];
    let mut course = Vec::new();
    for _ in 0..120 {
        world.step();
        let mut bits = bits(&get(&world, id));
        bits[0] -= start;
        course.push(bits);
    }
    course
}

#[test]
fn a_sliding_box_stops_where_coulomb_says() {
    // v²/(2·μ·g). The third: √(0.36·1) = 0.6; the last one without friction.
    let want = 9.0 / (2.0 * 0.6 * 9.81);
    for frictions in [[0.6, 0.6], [1.0, 0.36], [0.36, 1.0]] {
        let course = slide(0.0, frictions);
        let end = course.last().expect("not empty");
        close(end[0] as f64 * common::ULP_X, want, 0.01 * want);
        assert!(end[2].unsigned_abs() < 1 << 30, "it stands: {} m/s", end[2] as f64 * ULP_V);
    }
    let frictionless = slide(0.0, [0.6, 0.0]);
    let end = frictionless.last().expect("not empty");
    assert_eq!(end[2], 3 << 48);
    close(end[0] as f64 * common::ULP_X, 6.0, 1e-6);
}

#[test]
fn a_sliding_box_has_the_same_bits_a_thousand_kilometres_away() {
    let here = slide(0.0, [0.6, 0.6]);
    for x in [2f64.powi(20), -2f64.powi(20), 1e6 + 0.375] {
        assert!(slide(x, [0.6, 0.6]) == here, "at {x} m");
    }
}

#[test]
fn an_incline_holds_below_the_angle_of_friction_and_not_above() {
    for friction in [0.3f64, 0.5, 0.9] {
        for (part, holds) in [(0.99, true), (1.01, false)] {
            let tilt = friction.atan() * part;
            let (sin, cos) = tilt.sin_cos();
            let mut world = world(0.0, -9.81);
            let incline = surface(rectangle(100.0, 1.0), friction, 0.0);
            add(&mut world, BodyDef { angle: turned(tilt), ..fixed(0.0, 0.0, incline) });
            let block = solid(-sin, cos, surface(rectangle(2.0, 1.0), friction, 0.0));
            let id = add(&mut world, BodyDef { angle: turned(tilt), ..block });
            run(&mut world, 600);
            let (x, y) = position(&world, id);
            let way = -(x + sin) * cos - (y - cos) * sin;
            // ½·a·t² with a = g·(sin − μ·cos).
            let free = 50.0 * 9.81 * (sin - friction * cos);
            if holds {
                close(way, 0.0, 1e-3);
            } else {
                close(way, free, 0.1 * free);
            }
        }
    }
}

// Symmetries of whole scenes.

/// Boxes, discs and polygons, some turning, over a floor between walls: all that a pile has.
fn pile(seed: u64, count: usize) -> Vec<BodyDef> {
    let mut rng = Rng(seed);
    let mut defs = vec![
        fixed(0.0, -1.0, surface(rectangle(12.0, 2.0), 0.6, 0.0)),
        fixed(-6.5, 4.0, surface(rectangle(1.0, 14.0), 0.4, 0.2)),
        fixed(6.5, 4.0, surface(rectangle(1.0, 14.0), 0.4, 0.2)),
    ];
    for at in 0..count {
        let (friction, e) = (rng.unit(), [0.0, 0.0, 0.5][rng.below(3) as usize]);
        let size = 0.6 + 0.6 * rng.unit();
        let shape = match rng.below(4) {
            0 => disc(size * 0.5),
            1 => polygon(&[(-0.5, -0.4), (0.6, -0.5), (0.5, 0.4), (-0.1, 0.6)]),
            2 => polygon(&[(-0.5, -0.4), (0.6, -0.4), (0.0, 0.5)]),
            _ => rectangle(size, 0.6 + 0.5 * rng.unit()),
        };
        let (x, y) = ((at % 6) as f64 * 1.7 - 4.3 + 0.2 * rng.unit(), 1.0 + (at / 6) as f64 * 1.5);
        let body = moving(solid(x, y, surface(shape, friction, e)), rng.unit() - 0.5, -rng.unit());
        defs.push(BodyDef { angle: turned(6.0 * rng.unit()), angular_velocity: spin(2.0 * rng.unit() - 1.0), ..body });
    }
    defs
}

/// A world with these bodies.
fn world_of(gy: f64, defs: impl IntoIterator<Item = BodyDef>) -> World {
    let mut world = world(0.0, gy);
    for def in defs {
        add(&mut world, def);
    }
    world
}

fn count_of(events: &[Event], kind: EventKind) -> usize {
    events.iter().filter(|event| event.kind == kind).count()
}

#[test]
fn a_pile_has_the_same_bits_wherever_it_is() {
    let far = 1i64 << 52;
    for by in [[far, 0], [0, -far], [-far, far], [0x0001_2345_6789_abcd, -0x0fed_cba9_8765]] {
        let moved = pile(3, 30).into_iter().map(|def| {
            let [x, y] =
                [(def.position.x, by[0]), (def.position.y, by[1])].map(|(p, by)| Length::from_bits(p.to_bits() + by));
            BodyDef { position: Vec2::new(x, y), ..def }
        });
        let (mut here, mut there) = (world_of(-9.81, pile(3, 30)), world_of(-9.81, moved));
        let mut begun = 0;
        for tick in 0..300 {
            here.step();
            there.step();
            begun += count_of(here.events(), EventKind::ContactBegin);
            assert_eq!(here.events(), there.events(), "events of tick {tick}");
            for (a, b) in here.bodies().zip(there.bodies()) {
                let mut moved = bits(&b);
                (moved[0], moved[1]) = (moved[0] - by[0], moved[1] - by[1]);
                assert_eq!(bits(&a), moved, "{} in tick {tick}, moved by {by:?} · 2⁻³² m", a.id());
            }
        }
        assert!(begun > 60, "only {begun} contacts began");
    }
}

#[test]
fn a_pile_turned_by_half_a_turn_has_the_negated_bits() {
    let half = 1i64 << 47;
    let turned = pile(4, 30).into_iter().map(|def| {
        let (p, v) = (def.position, def.velocity);
        let line = |v: Length| Length::from_bits(-v.to_bits());
        let speed = |v: Velocity| Velocity::from_bits(-v.to_bits());
        let angle = Angle::from_bits(def.angle.to_bits() + half);
        let (position, velocity) = (Vec2::new(line(p.x), line(p.y)), Vec2::new(speed(v.x), speed(v.y)));
        BodyDef { position, velocity, angle, ..def }
    });
    let (mut up, mut down) = (world_of(-9.81, pile(4, 30)), world_of(9.81, turned));
    let mut begun = 0;
    for tick in 0..400 {
        up.step();
        down.step();
        begun += count_of(up.events(), EventKind::ContactBegin);
        assert_eq!(up.events(), down.events(), "events of tick {tick}");
        for (a, b) in up.bodies().zip(down.bodies()) {
            let [x, y, vx, vy, angle, spin] = bits(&a);
            assert_eq!([-x, -y, -vx, -vy, angle + half, spin], bits(&b), "{} in tick {tick}", a.id());
        }
    }
    assert!(begun > 60, "only {begun} contacts began");
}

#[test]
fn a_free_body_keeps_its_exact_motion_among_contacts() {
    let damped = BodyDef { linear_damping: num("0.3"), angular_damping: num("0.1"), ..BodyDef::default() };
    // Without a collider through the pile; beside it; and a finger's breadth over the wall's top, faster than it falls.
    let free = [
        moving(BodyDef { position: at(-9.0, 2.0), ..damped }, 3.0, 8.0),
        BodyDef { angular_velocity: spin(7.0), ..moving(solid(30.0, 9.0, disc(0.5)), 1.0, 12.0) },
        BodyDef { angular_velocity: spin(-3.0), ..moving(solid(-20.0, 60.0, rectangle(1.0, 2.0)), -2.0, 3.0) },
    ];
    let mut alone = world_of(-9.81, free.iter().cloned());
    let mut crowd = world_of(-9.81, pile(5, 30).into_iter().chain(free));
    for tick in 0..240 {
        alone.step();
        crowd.step();
        for (a, b) in alone.bodies().zip(crowd.bodies().skip(33)) {
            assert_eq!(bits(&a), bits(&b), "{} in tick {tick}", a.id());
        }
    }
    assert!(fastest(&crowd) > 0.0);
}

#[test]
fn a_body_that_passes_within_the_margin_keeps_its_exact_motion() {
    // 1 cm over a floor, along it: within the 2 cm at which contacts are looked for.
    for shape in [disc(0.5), rectangle(1.0, 1.0)] {
        let free = moving(solid(-4.0, 0.51, shape), 4.3, 0.0);
        let (mut alone, mut over) =
            (world_of(0.0, [free.clone()]), world_of(0.0, [fixed(0.0, -1.0, rectangle(12.0, 2.0)), free]));
        for tick in 0..120 {
            alone.step();
            over.step();
            assert!(over.events().is_empty(), "it touched nothing");
            let [a, b] = [alone.bodies().last(), over.bodies().last()].map(|body| bits(&body.expect("it exists")));
            assert_eq!(a, b, "tick {tick}");
        }
    }
}

#[test]
fn a_body_that_spins_out_of_reach_of_a_floor_keeps_its_exact_motion() {
    // Its corners are 0.7072 m from its centre: it never comes nearer than 1 cm.
    let mut struck = Vec::new();
    for (height, omega) in
        [(0.718, 1.0), (0.718, 10.0), (0.72, 20.0), (0.74, 20.0), (0.74, 60.0), (0.9, 60.0), (1.5, 600.0)]
    {
        let free =
            BodyDef { angle: turned(0.3), angular_velocity: spin(omega), ..solid(0.0, height, rectangle(1.0, 1.0)) };
        let mut alone = world_of(0.0, [free.clone()]);
        let mut over = world_of(0.0, [fixed(0.0, -1.0, rectangle(12.0, 2.0)), free]);
        run(&mut alone, 60);
        run(&mut over, 60);
        let [a, b] = [alone.bodies().last(), over.bodies().last()].map(|body| bits(&body.expect("it exists")));
        if a != b {
            let velocity = over.bodies().last().map(|body| body.velocity());
            struck.push(format!("at {height} m with {omega} rad/s it was struck: {velocity:?}"));
        }
    }
    assert!(struck.is_empty(), "{}", struck.join("\n"));
}

#[test]
fn a_free_body_in_the_srs_profile_keeps_its_velocity_among_contacts() {
    // A free body keeps v and ω to the bit; its position is x + v·t to the rounding of each tick.
    let mut world = world_of(0.0, pile(6, 20));
    let free = moving(solid(0.0, 40.0, rectangle(1.0, 1.0)), 0.125, 1.0);
    let id = add(&mut world, BodyDef { angular_velocity: spin(0.7), ..free });
    let before = bits(&get(&world, id));
    run(&mut world, 2000);
    let after = bits(&get(&world, id));
    assert_eq!([before[2], before[3], before[5]], [after[2], after[3], after[5]]);
    close(position(&world, id).1, 40.0 + 2000.0 / 60.0, 2000.0 * common::ULP_X);
}

// Conservation (TM:NewtonThirdLawMot, properties of a correct solution).

/// 50 bodies of 1 kg that fly at each other.
fn cluster(seed: u64) -> World {
    let mut rng = Rng(seed);
    let mut world = space();
    for at in 0..50 {
        let (x, y) = (f64::from(at % 7) * 1.6 - 4.8, f64::from(at / 7) * 1.6 - 5.6);
        let shape = match rng.below(3) {
            0 => disc(0.5),
            1 => polygon(&[(-0.5, -0.4), (0.6, -0.5), (0.5, 0.4), (-0.1, 0.6)]),
            _ => rectangle(1.0, 0.8),
        };
        let body = weighing(solid(x, y, surface(shape, 0.6, 0.5)), 1.0);
        let jitter = |rng: &mut Rng| 2.0 * rng.unit() - 1.0;
        let (vx, vy) = (-x + jitter(&mut rng), -y + jitter(&mut rng));
        add(&mut world, BodyDef { angular_velocity: spin(3.0 * jitter(&mut rng)), ..moving(body, vx, vy) });
    }
    world
}

#[test]
fn an_isolated_cluster_keeps_its_momentum() {
    let mut world = cluster(7);
    let momentum = |world: &World| {
        let sum = |pick: fn(Vec2<Velocity>) -> i64| {
            world.bodies().map(|body| i128::from(pick(body.velocity()))).sum::<i128>()
        };
        [sum(|v| v.x.to_bits()), sum(|v| v.y.to_bits())]
    };
    // Angular momentum, and the sum of its parts' magnitudes.
    let spin = |world: &World| {
        world.bodies().fold((0.0, 0.0), |(sum, all), body| {
            let ((m, i), (x, y), (vx, vy)) = (mass_of(&body), body.center_of_mass().to_f64(), body.velocity().to_f64());
            let part = m * (x * vy - y * vx) + i * body.angular_velocity().to_f64();
            (sum + part, all + part.abs())
        })
    };
    let (before, (turning, scale)) = (momentum(&world), spin(&world));
    let (mut begun, mut drift, mut twist) = (0, 0, 0.0f64);
    for tick in 0..10_000 {
        world.step();
        begun += count_of(world.events(), EventKind::ContactBegin);
        let now = momentum(&world);
        drift = drift.max((now[0] - before[0]).abs()).max((now[1] - before[1]).abs());
        if tick % 100 == 0 {
            twist = twist.max((spin(&world).0 - turning).abs() / scale);
        }
    }
    println!("{begun} contacts began, drift {drift} · 2⁻⁴⁸ m/s, angular momentum {twist:e} of {scale}");
    assert!(begun > 100, "only {begun} contacts began");
    // Equal masses: what one gains the other loses, to the bit.
    assert_eq!(drift, 0, "the sum of 50 velocities drifted by so many 2⁻⁴⁸ m/s");
    // Impulses act at arms of the tick's begin, while bodies move on: 1 % of what turns.
    assert!(twist < 0.01, "angular momentum drifted by {twist:e} of {scale} kg m²/s");
    world.check().expect("every invariant holds");
}

#[test]
fn a_settling_pile_gains_no_energy() {
    // The budget: 3e-4 of the energy that settling takes, for overlaps that are pushed apart.
    for seed in 8..13 {
        let mut world = world_of(-9.81, pile(seed, 48));
        let start = energy(&world);
        let (mut least, mut gain, mut end) = (start, 0.0f64, start);
        for _ in 0..900 {
            world.step();
            end = energy(&world);
            least = least.min(end);
            gain = gain.max(end - least);
        }
        let fall = start - end;
        println!("seed {seed}: {start:.1} J to {end:.1} J, greatest gain over the least before {gain:.4} J");
        assert!(fall > 500.0, "seed {seed}: it settled");
        assert!(gain < 3e-4 * fall, "seed {seed}: KE + PE grew by {gain} J over its least; {fall} J were lost");
    }
}

#[test]
fn what_rests_stays_at_rest() {
    // Warm starting: with 5 boxes on each other, and a heap of three discs on a flat box between posts.
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(0.0, -1.0, rectangle(40.0, 2.0)));
    let ids: Vec<BodyId> =
        (0..5).map(|row| add(&mut world, solid(0.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)))).collect();
    for x in [9.0, 11.2] {
        add(&mut world, fixed(x, 0.5, rectangle(0.2, 1.0)));
    }
    for (x, y) in [(9.6, 0.5), (10.6, 0.5), (10.1, 1.366)] {
        add(&mut world, solid(x, y, disc(0.5)));
    }
    run(&mut world, 300);
    let start: Vec<(f64, f64)> = ids.iter().map(|&id| position(&world, id)).collect();
    for tick in 0..600 {
        world.step();
        let speed = fastest(&world);
        assert!(speed < 1e-4, "{speed:e} m/s in tick {tick}");
    }
    for (&id, &start) in ids.iter().zip(&start) {
        close2(position(&world, id), start, 1e-5);
    }
    world.check().expect("every invariant holds");
}

// Filters, sensors, events.

/// The id of a body's first collider.
fn collider(world: &World, body: BodyId) -> ColliderId {
    get(world, body).colliders().next().expect("it has one").id()
}

fn event(tick: u64, kind: EventKind, a: ColliderId, b: ColliderId) -> Event {
    Event { tick, kind, a, b }
}

#[test]
fn filters_decide_who_meets() {
    let filter = |category, mask| Filter { category, mask };
    let both = [
        // Floor, box, whether they meet.
        (filter(1, u32::MAX), filter(1, u32::MAX), true),
        (filter(2, 4), filter(4, 2), true),
        (filter(2, 4), filter(4, 1), false),
        (filter(2, 1), filter(4, 2), false),
        (filter(0, u32::MAX), filter(1, u32::MAX), false),
        (filter(1 << 31, 1 << 31), filter(1 << 31, 1 << 31), true),
    ];
    for (floor, falling, meets) in both {
        let mut world = world(0.0, -9.81);
        add(&mut world, fixed(0.0, -1.0, ColliderDef { filter: floor, ..rectangle(9.0, 2.0) }));
        let id = add(&mut world, solid(0.0, 0.7, ColliderDef { filter: falling, ..rectangle(1.0, 1.0) }));
        run(&mut world, 60);
        assert_eq!(position(&world, id).1 > 0.49, meets, "{floor:?} and {falling:?}");
    }
}

#[test]
fn a_sensor_reports_once_and_does_nothing_else() {
    let zone = |kind| BodyDef { kind, ..solid(0.0, 0.0, ColliderDef { sensor: true, ..rectangle(4.0, 1.0) }) };
    for kind in [BodyKind::Static, BodyKind::Kinematic] {
        let falling = BodyDef { angular_velocity: spin(1.0), ..solid(0.3, 3.0, rectangle(1.0, 1.0)) };
        let mut empty = world_of(-9.81, [falling.clone()]);
        let mut world = world(0.0, -9.81);
        let sensor = add(&mut world, zone(kind));
        let id = add(&mut world, falling);
        let pair = (collider(&world, sensor), collider(&world, id));
        let mut told = Vec::new();
        for _ in 0..120 {
            world.step();
            empty.step();
            told.extend(world.events().iter().copied());
            let alone = empty.bodies().next().map(|body| bits(&body)).expect("it exists");
            assert_eq!(bits(&get(&world, id)), alone);
        }
        let begin = told.first().map_or(0, |event: &Event| event.tick);
        let end = told.last().map_or(0, |event: &Event| event.tick);
        assert!(begin < end);
        let expected = [(begin, EventKind::SensorBegin), (end, EventKind::SensorEnd)];
        assert_eq!(told, expected.map(|(tick, kind)| event(tick, kind, pair.0, pair.1)));
    }
}

#[test]
fn a_sensor_weighs_nothing() {
    let dense = ColliderDef { sensor: true, density: Density::from_bits(1 << 80), offset: at(5.0, 0.0), ..disc(2.0) };
    let with = BodyDef { colliders: vec![rectangle(2.0, 3.0), dense.clone()], ..BodyDef::default() };
    let without = BodyDef { colliders: vec![rectangle(2.0, 3.0)], ..BodyDef::default() };
    let world = world_of(0.0, [with, without, BodyDef { colliders: vec![dense], ..BodyDef::default() }]);
    let defs: Vec<BodyDef> = world.bodies().map(|body| body.def()).collect();
    let data = |def: &BodyDef| (def.mass, def.inertia, def.center);
    assert_eq!(data(&defs[0]), data(&defs[1]));
    // With sensors alone: as without colliders.
    assert_eq!(data(&defs[2]), (Some(num("1")), Some(num("1")), Some(at(0.0, 0.0))));
}

#[test]
fn sensors_do_not_see_each_other_nor_their_own_body() {
    let sensor = ColliderDef { sensor: true, ..disc(1.0) };
    let mut world = space();
    add(&mut world, BodyDef { colliders: vec![sensor.clone(), disc(1.0)], ..BodyDef::default() });
    add(&mut world, solid(0.5, 0.0, ColliderDef { filter: Filter { category: 2, mask: 2 }, ..sensor.clone() }));
    add(&mut world, solid(0.2, 0.0, ColliderDef { filter: Filter { category: 2, mask: 2 }, ..sensor }));
    world.step();
    assert_eq!(world.events(), []);
}

#[test]
fn a_landing_begins_one_contact_and_its_end_comes_once() {
    let mut world = world(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(9.0, 2.0)));
    let id = add(&mut world, solid(0.0, 1.5, rectangle(1.0, 1.0)));
    let pair = (collider(&world, floor), collider(&world, id));
    let mut told = Vec::new();
    for _ in 0..180 {
        world.step();
        told.extend(world.events().iter().map(|event| (world.tick(), *event)));
    }
    // 1 m takes √(2/9.81) s: 27.09 ticks.
    assert_eq!(told, [(28, event(27, EventKind::ContactBegin, pair.0, pair.1))]);
    world.set_velocity(id, vel(0.0, 5.0)).expect("accepted");
    run(&mut world, 2);
    assert_eq!(world.events(), [event(world.tick() - 1, EventKind::ContactEnd, pair.0, pair.1)]);
    world.step();
    assert_eq!(world.events(), []);
}

#[test]
fn a_contact_ends_when_its_body_is_destroyed_even_if_another_takes_its_slot() {
    let mut world = world(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(9.0, 2.0)));
    let falling = solid(0.0, 0.5, rectangle(1.0, 1.0));
    let id = add(&mut world, falling.clone());
    let (under, old) = (collider(&world, floor), collider(&world, id));
    run(&mut world, 30);
    world.destroy_body(id).expect("it exists");
    let next = add(&mut world, falling);
    let new = collider(&world, next);
    assert_eq!((new.index, new.generation), (old.index, old.generation + 1));
    world.step();
    let ended = event(world.tick() - 1, EventKind::ContactEnd, under, old);
    assert_eq!(world.events(), [ended, event(world.tick() - 1, EventKind::ContactBegin, under, new)]);
    assert!(world.collider(old).is_none(), "its id is no longer valid");
    world.destroy_body(next).expect("it exists");
    world.step();
    assert_eq!(world.events(), [event(world.tick() - 1, EventKind::ContactEnd, under, new)]);
    world.step();
    assert_eq!(world.events(), []);
    world.check().expect("every invariant holds");
}

#[test]
fn events_are_ordered_and_the_same_after_a_save() {
    let mut world = world_of(-9.81, pile(9, 30));
    let mut told = 0;
    for tick in 0..240 {
        let mut loaded = World::load(&world.save()).expect("just saved");
        assert_eq!(loaded.events(), [], "a loaded world has none");
        world.step();
        loaded.step();
        assert_eq!(world.events(), loaded.events(), "tick {tick}");
        let keys: Vec<_> = world.events().iter().map(|event| (event.a.index, event.b.index)).collect();
        assert!(keys.is_sorted_by(|a, b| a < b), "{keys:?}");
        assert!(keys.iter().all(|(a, b)| a < b));
        told += keys.len();
    }
    assert!(told > 60, "only {told} events");
}

// Kinds and commands.

#[test]
fn a_kinematic_body_pushes_and_is_not_pushed() {
    let pusher = BodyDef { kind: BodyKind::Kinematic, ..moving(solid(-3.0, 0.6, rectangle(1.0, 1.0)), 1.0, 0.0) };
    let mut alone = world_of(-9.81, [pusher.clone()]);
    let mut world = world(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(40.0, 2.0)));
    let pushing = add(&mut world, pusher);
    let heavy = add(&mut world, weighing(solid(0.0, 0.5, rectangle(1.0, 1.0)), 1e6));
    let before = bits(&get(&world, floor));
    for _ in 0..240 {
        world.step();
        alone.step();
        let free = alone.bodies().next().map(|body| bits(&body)).expect("it exists");
        assert_eq!(bits(&get(&world, pushing)), free);
        assert_eq!(bits(&get(&world, floor)), before);
    }
    // 2 m of gap, then with it: 4 s at 1 m/s from −3 m, and 1 m between centres.
    close2(position(&world, heavy), (2.0, 0.5), 0.005);
    close2(velocity(&world, heavy), (1.0, 0.0), 0.01);
}

#[test]
fn a_turning_kinematic_body_carries_what_lies_on_it() {
    // A belt of two rollers: what lies on a disc that turns is moved by friction at its rim.
    let mut world = world(0.0, -9.81);
    for x in [-1.5, 1.5] {
        let roller = BodyDef { kind: BodyKind::Kinematic, angular_velocity: spin(-2.0), ..solid(x, -0.5, disc(0.5)) };
        add(&mut world, roller);
    }
    let plank = add(&mut world, solid(-0.8, 0.05, rectangle(6.0, 0.1)));
    run(&mut world, 60);
    close(velocity(&world, plank).0, 1.0, 0.02);
}

#[test]
fn static_bodies_never_move_by_contacts() {
    let mut world = world_of(-9.81, pile(10, 30));
    let before: Vec<[i64; 6]> = world.bodies().take(3).map(|body| bits(&body)).collect();
    run(&mut world, 300);
    let after: Vec<[i64; 6]> = world.bodies().take(3).map(|body| bits(&body)).collect();
    assert_eq!(before, after);
}

#[test]
fn fixed_rotation_does_not_turn() {
    let mut world = space();
    let post = BodyDef { fixed_rotation: true, angle: turned(0.4), ..solid(0.0, 0.0, rectangle(0.5, 3.0)) };
    let post = add(&mut world, post);
    let free = add(&mut world, solid(0.0, 10.0, rectangle(0.5, 3.0)));
    for y in [1.0, 11.0] {
        add(&mut world, moving(weighing(solid(-3.0, y, disc(0.3)), 1.0), 5.0, 0.0));
    }
    run(&mut world, 120);
    let [post, free] = [post, free].map(|id| get(&world, id));
    assert!(post.velocity().x.to_f64() > 0.1, "it was hit");
    assert_eq!((post.angle(), post.angular_velocity()), (turned(0.4), spin(0.0)));
    assert!(free.angular_velocity().to_f64().abs() > 0.1, "one that may turn does");
}

/// A floor and a box at rest on it.
fn at_rest() -> (World, BodyId, BodyId) {
    let mut world = world(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(9.0, 2.0)));
    let id = add(&mut world, solid(0.0, 0.5, rectangle(1.0, 1.0)));
    run(&mut world, 60);
    (world, floor, id)
}

#[test]
fn a_changed_kind_takes_effect() {
    // The floor falls with the box on it.
    let (mut world, floor, id) = at_rest();
    world.set_kind(floor, BodyKind::Dynamic).expect("accepted");
    run(&mut world, 60);
    close(position(&world, floor).1, -1.0 - 9.81 / 2.0, 0.01);
    close(position(&world, id).1, 0.5 - 9.81 / 2.0, 0.01);
    // A box that becomes static holds another.
    let (mut world, _, id) = at_rest();
    world.set_position(id, at(0.0, 5.0)).expect("accepted");
    world.set_kind(id, BodyKind::Static).expect("accepted");
    let other = add(&mut world, solid(0.2, 6.5, rectangle(1.0, 1.0)));
    run(&mut world, 120);
    assert_eq!(get(&world, id).position(), at(0.0, 5.0));
    close(position(&world, other).1, 6.0, 0.002);
    // And one that becomes kinematic goes through the floor.
    let (mut world, _, id) = at_rest();
    world.set_kind(id, BodyKind::Kinematic).expect("accepted");
    world.set_velocity(id, vel(0.0, -1.0)).expect("accepted");
    let height = position(&world, id).1;
    run(&mut world, 60);
    close(position(&world, id).1, height - 1.0, 1e-7);
}

#[test]
fn a_teleport_takes_effect_on_static_and_dynamic_bodies() {
    let (mut world, floor, id) = at_rest();
    world.set_position(floor, at(0.0, -3.0)).expect("accepted");
    run(&mut world, 120);
    close2(position(&world, id), (0.0, -1.5), 0.002);
    world.set_position(id, at(3.0, -1.5)).expect("accepted");
    run(&mut world, 60);
    close2(position(&world, id), (3.0, -1.5), 0.002);
    world.set_position(id, at(30.0, -1.5)).expect("accepted");
    run(&mut world, 60);
    close2(position(&world, id), (30.0, -1.5 - 9.81 / 2.0), 1e-6);
    // A floor that is turned by a quarter is 2 m wide and no longer under it.
    let (mut world, floor, id) = at_rest();
    world.set_position(id, at(3.0, 0.5)).expect("accepted");
    world.set_angle(floor, Angle::from_bits(1 << 46)).expect("accepted");
    run(&mut world, 60);
    close(position(&world, id).1, 0.5 - 9.81 / 2.0, 1e-6);
}

#[test]
fn a_changed_filter_takes_effect() {
    let (mut world, floor, id) = at_rest();
    let pair = (collider(&world, floor), collider(&world, id));
    let height = position(&world, id).1;
    world.set_filter(pair.1, Filter { category: 1, mask: 0 }).expect("accepted");
    world.step();
    assert_eq!(world.events(), [event(world.tick() - 1, EventKind::ContactEnd, pair.0, pair.1)]);
    run(&mut world, 59);
    close(position(&world, id).1, height - 9.81 / 2.0, 1e-3);
    // Back again: it is inside the floor's column no more, but above it once it is put there.
    world.set_filter(pair.1, Filter::default()).expect("accepted");
    world.set_position(id, at(0.0, 0.5)).expect("accepted");
    world.set_velocity(id, vel(0.0, 0.0)).expect("accepted");
    run(&mut world, 60);
    close(position(&world, id).1, 0.5, 0.002);
}

#[test]
fn a_changed_surface_takes_effect() {
    let (mut world, floor, id) = at_rest();
    world.set_gravity(acc(2.0, -9.81)).expect("accepted");
    run(&mut world, 60);
    close(velocity(&world, id).0, 0.0, 1e-4);
    world.set_surface(collider(&world, floor), num("0"), num("0")).expect("accepted");
    run(&mut world, 60);
    close(velocity(&world, id).0, 2.0, 0.01);
    // Restitution: the larger of the two, from the next impact on.
    let (mut world, floor, id) = at_rest();
    world.set_surface(collider(&world, floor), num("1"), num("0.6")).expect("accepted");
    world.set_position(id, at(0.0, 1.5)).expect("accepted");
    let mut top = 0.0f64;
    for tick in 0..60 {
        world.step();
        if tick > 30 {
            top = top.max(position(&world, id).1);
        }
    }
    close(top, 1.5, 0.05);
}

// Compound bodies and their centre of mass (DD:ctrOfMass, DD:momentOfInertia).

fn offset(collider: ColliderDef, x: f64, y: f64, density: f64) -> ColliderDef {
    ColliderDef { offset: at(x, y), density: Density::from_f64(density).expect("in range"), ..collider }
}

#[test]
fn a_compound_body_has_the_centre_and_inertia_of_its_parts() {
    // 2 kg at the origin and 3 kg at (3, 0): centre 1.8.
    let parts = vec![offset(rectangle(2.0, 1.0), 0.0, 0.0, 1.0), offset(rectangle(1.0, 1.0), 3.0, 0.0, 3.0)];
    let mut world = space();
    let angle = turned(1.234);
    let id = add(&mut world, BodyDef { colliders: parts, position: at(7.0, -4.0), angle, ..BodyDef::default() });
    let body = get(&world, id);
    let def = body.def();
    assert_eq!(def.mass, Some(num("5")));
    close2(def.center.expect("given out").to_f64(), (1.8, 0.0), 1e-9);
    let inertia = 2.0 * 5.0 / 12.0 + 2.0 * 1.8 * 1.8 + 3.0 * 2.0 / 12.0 + 3.0 * 1.2 * 1.2;
    close(mass_of(&body).1, inertia, 1e-8);
    // The very bits that were set, and the centre of mass turned with the body.
    assert_eq!(body.position(), at(7.0, -4.0));
    let (sin, cos) = 1.234f64.sin_cos();
    close2(body.center_of_mass().to_f64(), (7.0 + 1.8 * cos, -4.0 + 1.8 * sin), 1e-8);
}

#[test]
fn masses_of_the_srs() {
    let inertia = |colliders: Vec<ColliderDef>, mass: Option<f64>| {
        let mass = mass.map(|mass| Mass::from_f64(mass).expect("in range"));
        let mut world = space();
        let id = add(&mut world, BodyDef { colliders, mass, ..BodyDef::default() });
        let def = get(&world, id).def();
        (mass_of(&get(&world, id)).1, def.center.expect("given out").to_f64())
    };
    close(inertia(vec![rectangle(100.0, 100.0)], Some(0.5)).0, 833.333_333_333, 1e-8);
    close(inertia(vec![rectangle(500.0, 500.0)], Some(500.0)).0, 20_833_333.333_333, 1e-5);
    close(inertia(vec![rectangle(2.0, 3.0)], Some(1.0)).0, 13.0 / 12.0, 1e-12);
    let (_, center) = inertia(vec![polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])], None);
    close2(center, (20.0 / 3.0, 10.0 / 3.0), 1e-9);
}

#[test]
fn the_inertia_of_a_small_collider_follows_a_given_mass() {
    let mut wrong = Vec::new();
    for side in [1e-5, 1e-4, 1e-3, 1e-2, 0.1] {
        let mut world = space();
        let want = side * side / 6.0;
        match world.create_body(&weighing(solid(0.0, 0.0, rectangle(side, side)), 1.0)) {
            Ok(id) => {
                let off = mass_of(&get(&world, id)).1 / want - 1.0;
                // A side has 32 fraction bits: up to 1.2e-10 m of it, which both agree on but for f64's reading of it.
                if off.abs() > 1e-9 + 2.4e-10 / side {
                    wrong.push(format!("{side} m: {off:e} off"));
                }
            }
            Err(error) => wrong.push(format!("{side} m: {error}")),
        }
    }
    assert!(wrong.is_empty(), "boxes of 1 kg: {}", wrong.join("; "));
}

#[test]
fn a_given_centre_of_mass_is_kept_and_masses_follow_from_densities() {
    let mut rng = Rng(11);
    for _ in 0..200 {
        let mut r = |by: f64| (rng.unit() * 2.0 - 1.0) * by;
        let (p, center, angle) = (at(r(1e6), r(1e6)), at(r(3.0), r(3.0)), turned(r(3.0)));
        let colliders = vec![offset(rectangle(2.0, 1.0), r(1.0), r(1.0), 2.0), offset(disc(0.5), 0.0, 1.0, 1.0)];
        let mut world = space();
        let def = BodyDef { position: p, center: Some(center), angle, colliders, ..BodyDef::default() };
        let id = add(&mut world, def);
        let body = get(&world, id);
        assert_eq!(body.position(), p, "the very bits that were set");
        assert_eq!(body.def().center, Some(center));
        close(mass_of(&body).0, 4.0 + std::f64::consts::PI * 0.25, 1e-9);
        // And after it was put elsewhere and turned.
        world.set_angle(id, turned(0.3)).expect("accepted");
        assert_eq!(get(&world, id).position(), p, "turned about its origin");
        world.set_position(id, at(0.25, 8.0)).expect("accepted");
        assert_eq!(get(&world, id).position(), at(0.25, 8.0));
    }
}

#[test]
fn a_compound_body_lands_on_all_its_parts() {
    // A table: a plate on two legs of unequal mass.
    let parts = vec![
        offset(rectangle(3.0, 0.2), 0.0, 1.0, 1.0),
        offset(rectangle(0.2, 1.0), -1.3, 0.5, 1.0),
        offset(rectangle(0.2, 1.0), 1.3, 0.5, 5.0),
    ];
    let mut world = world(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(9.0, 2.0)));
    let table = add(&mut world, BodyDef { position: at(0.0, 0.3), colliders: parts, ..BodyDef::default() });
    let mut begun = Vec::new();
    for _ in 0..180 {
        world.step();
        begun.extend(world.events().iter().copied());
    }
    close2(position(&world, table), (0.0, 0.0), 0.005);
    assert!(fastest(&world) < 1e-4, "it stands");
    let legs: Vec<ColliderId> = get(&world, table).colliders().skip(1).map(|leg| leg.id()).collect();
    let under = collider(&world, floor);
    for leg in legs {
        let begins = |told: &Event| (told.kind, told.a, told.b) == (EventKind::ContactBegin, under, leg);
        assert!(begun.iter().any(begins), "{leg} stands on the floor");
    }
    // What it stands under its plate falls no farther than that: parts of one body do not meet.
    world.check().expect("every invariant holds");
}

// State (T0).

#[test]
fn worlds_that_are_saved_or_copied_go_on_as_the_one_that_is_not() {
    for (seed, every) in [(1, 1), (2, 3), (3, 10), (4, 1), (5, 7), (6, 2), (7, 30), (8, 1)] {
        let mut storm = Storm::solid(seed, 12.0);
        let mut world = world_of(-9.81, [fixed(0.0, -6.0, rectangle(60.0, 2.0))]);
        let (mut loaded, mut copied) = (world.clone(), world.clone());
        let mut told = 0;
        for tick in 0..240 {
            if tick % every == 0 {
                loaded = World::load(&loaded.save()).expect("just saved");
                let fresh = copied.clone();
                copied.clone_from(&fresh);
            }
            for _ in 0..tick % 4 {
                let command = storm.command();
                let reply = world.apply(command.clone());
                assert_eq!(loaded.apply(command.clone()), reply);
                assert_eq!(copied.apply(command), reply);
                let _refused_or_not = storm.heed(reply);
            }
            for world in [&mut world, &mut loaded, &mut copied] {
                world.step();
            }
            assert_eq!(world.hash(), loaded.hash(), "loaded, tick {tick}, seed {seed}");
            assert_eq!(world.hash(), copied.hash(), "copied, tick {tick}, seed {seed}");
            assert_eq!(world.events(), loaded.events());
            assert_eq!(world.events(), copied.events());
            told += count_of(world.events(), EventKind::ContactBegin);
            world.check().expect("every invariant holds");
        }
        assert!(told > 20, "seed {seed}: only {told} contacts began");
    }
}

#[test]
fn what_the_past_knew_of_a_near_floor_does_not_show() {
    // A body comes slowly near a floor; were it to spin at any tick, then a loaded world, which has no past, agrees.
    for step in 0..60 {
        let mut world = space();
        add(&mut world, fixed(0.0, -1.0, rectangle(10.0, 2.0)));
        let height = 0.9 + 0.01 * f64::from(step);
        let id = add(&mut world, BodyDef { angle: turned(0.3), ..solid(0.0, height, rectangle(1.0, 1.0)) });
        world.step();
        world.set_velocity(id, vel(0.0, -0.1)).expect("accepted");
        while position(&world, id).1 > 0.72 {
            if position(&world, id).1 < 0.78 {
                let mut known = world.clone();
                known.set_angular_velocity(id, spin(60.0)).expect("accepted");
                let mut loaded = World::load(&known.save()).expect("just saved");
                known.step();
                loaded.step();
                assert_eq!(known.diff(&loaded), [], "from {height} m, at {} m", position(&world, id).1);
            }
            world.step();
        }
    }
}

#[test]
fn a_pile_with_bodies_coming_and_going_is_all_in_its_save() {
    let mut rng = Rng(12);
    let mut world = world_of(-9.81, pile(13, 36));
    let mut other = world.clone();
    let mut ids: Vec<BodyId> = world.bodies().skip(3).map(|body| body.id()).collect();
    for tick in 0..400u64 {
        if tick % 7 == 0 {
            let gone = ids.swap_remove(rng.below(ids.len() as u64) as usize);
            let new =
                solid(rng.unit() * 8.0 - 4.0, 9.0, if rng.below(2) == 0 { disc(0.4) } else { rectangle(0.8, 0.7) });
            for world in [&mut world, &mut other] {
                world.destroy_body(gone).expect("it exists");
            }
            let (a, b) = (add(&mut world, new.clone()), add(&mut other, new));
            assert_eq!(a, b);
            ids.push(a);
        }
        if tick % 5 == 0 {
            other = World::load(&other.save()).expect("just saved");
        }
        world.step();
        other.step();
        assert_eq!(world.hash(), other.hash(), "tick {tick}");
        assert_eq!(world.diff(&other), []);
        world.check().expect("every invariant holds");
    }
}

#[test]
fn refused_shapes_leave_the_hash_unchanged() {
    let mut world = world_of(-9.81, pile(14, 6));
    run(&mut world, 30);
    let before = world.hash();
    let side = |text: &str| num::<Length>(text);
    let boxed = |width: &str, height: &str| ColliderDef::new(Shape::Box { width: side(width), height: side(height) });
    let round = |radius: &str| ColliderDef::new(Shape::Circle { radius: side(radius) });
    let octagon: Vec<(f64, f64)> = (0..9).map(|at| (f64::from(at) * 0.7).sin_cos()).collect();
    let refused = [
        (boxed("0", "1"), "width 0 m is outside 0.000001 … 16000 m"),
        (boxed("1", "-1"), "height -1 m is outside 0.000001 … 16000 m"),
        (boxed("16001", "1"), "width 16001 m is outside 0.000001 … 16000 m"),
        (round("0"), "radius 0 m is outside 0.000001 … 16000 m"),
        (polygon(&[(0.0, 0.0), (1.0, 0.0)]), "2 vertices are outside 3 … 8"),
        (polygon(&octagon), "9 vertices are outside 3 … 8"),
        (polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]), "vertex 0 is on the line through its neighbours"),
        (polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0)]), "vertex 2 is where another vertex is"),
        (polygon(&[(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)]), "the polygon is not convex at vertex 2"),
        (ColliderDef { offset: at(16_001.0, 0.0), ..disc(1.0) }, "coordinate 16001 m is outside ±16000 m"),
        (
            ColliderDef { restitution: Restitution::from_bits((1 << 48) + 1), ..disc(1.0) },
            "restitution 1.000000000000003552713678800500929355621337890625 is outside 0 … 1",
        ),
        (
            ColliderDef { friction: tamias2d::Friction::from_bits(-1), ..disc(1.0) },
            "friction -0.000000000000003552713678800500929355621337890625 is outside 0 … 100",
        ),
        (ColliderDef { density: Density::ZERO, ..disc(1.0) }, "density 0 kg/m² is outside 0.000000001 … 1e12 kg/m²"),
    ];
    for (collider, text) in refused {
        let def = BodyDef { colliders: vec![disc(0.5), collider], ..BodyDef::default() };
        let error = world.create_body(&def).expect_err(text);
        assert_eq!(error.to_string(), format!("colliders[1]: {text}"));
        assert_eq!(world.hash(), before, "{text}");
    }
    world.check().expect("every invariant holds");
}

// The ends of the ranges.

#[test]
fn contacts_at_the_edge_of_the_world_hold() {
    for sign in [1.0, -1.0] {
        let mut world = world(sign * 9.81, 0.0);
        add(&mut world, fixed(sign * (1e9 - 1.0), 0.0, rectangle(2.0, 9.0)));
        let id = add(&mut world, solid(sign * (1e9 - 4.0), sign * 1e-3, rectangle(1.0, 1.0)));
        for _ in 0..180 {
            world.step();
            world.check().expect("every invariant holds");
        }
        close(position(&world, id).0, sign * (1e9 - 2.5), 0.005);
        assert!(world.status().is_clear(), "{:?}", world.status());
    }
}

#[test]
fn what_contacts_push_over_the_edge_of_the_world_is_held_there() {
    let mut world = space();
    // It overlaps the one beyond which there is nothing, and is driven outwards by another.
    let id = add(&mut world, solid(1e9 - 0.2, 1e9 - 0.2, rectangle(1.0, 1.0)));
    add(&mut world, fixed(1e9 - 0.9, 1e9 - 0.9, rectangle(1.0, 1.0)));
    add(&mut world, moving(weighing(solid(1e9 - 4.0, 1e9 - 0.2, rectangle(1.0, 0.5)), 1e5), 30.0, 0.0));
    for _ in 0..120 {
        world.step();
        world.check().expect("every invariant holds");
    }
    let (x, y) = position(&world, id);
    assert!(x <= 1e9 && y <= 1e9);
    assert!(world.status().entries().iter().any(|entry| entry.bound == Bound::Position), "{:?}", world.status());
}

#[test]
fn bodies_of_2000_metres_per_second_bounce_off_a_wall() {
    // Onto a wall of 4 m, from places all over the 33 m of a tick.
    for collider in [rectangle(1.0, 1.0), disc(0.5), polygon(&[(0.0, 0.0), (2.0, 0.1), (0.4, 1.0)])] {
        for way in 0..12 {
            let mut world = space();
            add(&mut world, fixed(0.0, 0.0, surface(rectangle(4.0, 40.0), 0.6, 1.0)));
            let way = 36.0 + 2.8 * f64::from(way);
            let fast = moving(solid(-way, 0.3, surface(collider.clone(), 0.6, 1.0)), 2000.0, 1.0);
            let id = add(&mut world, BodyDef { angular_velocity: spin(500.0), ..fast });
            let energy = |world: &World| get(world, id).kinetic_energy().to_f64();
            let before = energy(&world);
            for _ in 0..30 {
                world.step();
                world.check().expect("every invariant holds");
                assert!(position(&world, id).0 < -2.0, "{:?} from {way} m is in the wall", collider.shape);
            }
            assert!(velocity(&world, id).0 < 0.0, "{:?} from {way} m stays", collider.shape);
            assert!(energy(&world) <= before * (1.0 + 1e-9), "{:?} from {way} m gained energy", collider.shape);
        }
    }
}

#[test]
fn two_discs_of_2000_metres_per_second_exchange_their_velocities() {
    let mut world = space();
    let ids = [1.0, -1.0]
        .map(|side| add(&mut world, moving(solid(-2.0 * side, 0.0, surface(disc(0.5), 0.6, 1.0)), 2000.0 * side, 0.0)));
    for _ in 0..30 {
        world.step();
        world.check().expect("every invariant holds");
    }
    close2(velocity(&world, ids[0]), (-2000.0, 0.0), 2e-6);
    let [a, b] = ids.map(|id| get(&world, id).velocity().x.to_bits());
    assert_eq!(a + b, 0, "momentum");
}

#[test]
fn tiny_and_huge_bodies_in_contact_do_no_harm() {
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(0.0, -5000.0, rectangle(16_000.0, 10_000.0)));
    let mut ids = Vec::new();
    for (at, (size, mass)) in
        [(1e-6, 1e3), (1e-3, 1.0), (1.0, 1e9), (3000.0, 2e9), (3000.0, 1e-6)].into_iter().enumerate()
    {
        let x = at as f64 * 3300.0 - 7800.0;
        let inertia = Some(Inertia::from_f64(mass * size * size / 6.0).expect("in range"));
        let body = weighing(solid(x, size * 0.5 + 0.01, rectangle(size, size)), mass);
        ids.push((size, add(&mut world, BodyDef { inertia, ..body })));
    }
    for _ in 0..180 {
        world.step();
        world.check().expect("every invariant holds");
    }
    for (size, id) in ids {
        close(position(&world, id).1, size * 0.5, 0.001);
    }
}

#[test]
fn deep_overlaps_come_apart_without_an_explosion() {
    let mut world = space();
    for _ in 0..6 {
        add(&mut world, solid(0.0, 0.0, rectangle(1.0, 1.0)));
        add(&mut world, solid(0.0, 0.0, disc(0.5)));
    }
    for _ in 0..600 {
        world.step();
        // The greatest speed of pushing apart is 1 m/s a contact.
        assert!(fastest(&world) < 30.0, "{} m/s", fastest(&world));
    }
    let overlap = worst_overlap(&world);
    assert!(overlap < 0.01, "they still overlap by {overlap} m");
    world.check().expect("every invariant holds");
}

#[test]
fn damping_and_forces_act_in_contact() {
    // A box pushed along a floor without friction, damped: v(t) = (F/(m·c))·(1 − exp(−c·t)).
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(0.0, -1.0, surface(rectangle(40.0, 2.0), 0.0, 0.0)));
    let body = weighing(solid(0.0, 0.5, rectangle(1.0, 1.0)), 2.0);
    let damping = Damping::from_f64(0.5).expect("in range");
    let id = add(&mut world, BodyDef { force: newtons(4.0, 0.0), linear_damping: damping, ..body });
    run(&mut world, 120);
    close(velocity(&world, id).0, 4.0 * (1.0 - (-1.0f64).exp()), 0.01);
}
