//! Sleeping: what rests falls asleep, island by island, stays to the bit, costs nothing, and wakes as a whole.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;

use common::{Rng, Storm, acc, at, close, disc, measure, newton_seconds, newtons, num, position, rectangle, run, vel};
use proptest::prelude::{ProptestConfig, any, prop_assert_eq, proptest};
use solid::{add, bits, energy, fixed, get, moving, polygon, solid, spin, surface, turned, worst_overlap};
use tamias2d::{
    Angle, Attractor, BodyDef, BodyId, BodyKind, ColliderDef, Command, CommandError, Commands, ConfigError, EventKind,
    Filter, Integrator, Reply, Sleeping, Vec2, World, WorldDef,
};

#[global_allocator]
static ALLOCATOR: common::Counting = common::Counting;

/// A world with sleeping as games use it.
fn dormitory(gx: f64, gy: f64) -> World {
    let sleeping = Some(Sleeping::default());
    World::new(&WorldDef { gravity: acc(gx, gy), sleeping, ..WorldDef::default() }).expect("accepted")
}

/// The same with a floor whose top is at y = 0.
fn floor() -> (World, BodyId) {
    let mut world = dormitory(0.0, -9.81);
    let floor = add(&mut world, fixed(0.0, -1.0, rectangle(200.0, 2.0)));
    (world, floor)
}

/// Boxes of 1 m on each other, from y = 0 on.
fn stack(world: &mut World, x: f64, rows: u32) -> Vec<BodyId> {
    (0..rows).map(|row| add(world, solid(x, 0.5 + f64::from(row), rectangle(1.0, 1.0)))).collect()
}

fn awake(world: &World, id: BodyId) -> bool {
    get(world, id).is_awake()
}

/// How many dynamic bodies are awake.
fn up(world: &World) -> usize {
    world.bodies().filter(|body| body.kind() == BodyKind::Dynamic && body.is_awake()).count()
}

/// Runs until all sleep, and says after how many ticks; every invariant holds in each.
#[track_caller]
fn until_asleep(world: &mut World, most: u64) -> u64 {
    for tick in 1..=most {
        world.step();
        world.check().expect("every invariant holds");
        if up(world) == 0 {
            return tick;
        }
    }
    panic!("{} bodies are awake after {most} ticks", up(world));
}

/// The bits of all bodies, by slot.
fn all_bits(world: &World) -> Vec<[i64; 6]> {
    world.bodies().map(|body| bits(&body)).collect()
}

/// A pile of boxes, polygons and discs between walls.
fn pile(world: &mut World, count: usize, seed: u64) {
    let mut rng = Rng(seed);
    for x in [-6.5, 6.5] {
        add(world, fixed(x, 20.0, surface(rectangle(1.0, 42.0), 0.6, 0.0)));
    }
    for at in 0..count {
        let size = 0.6 + 0.4 * rng.unit();
        let shape = match rng.below(4) {
            0 => disc(size * 0.5),
            1 => polygon(&[(-0.5, -0.4), (0.6, -0.5), (0.5, 0.4), (-0.1, 0.6)]),
            _ => rectangle(size, 0.5 + 0.5 * rng.unit()),
        };
        let (x, y) = ((at % 6) as f64 * 1.7 - 4.3 + 0.2 * rng.unit(), 1.0 + (at / 6) as f64 * 1.5);
        let body = solid(x, y, surface(shape, 0.6, 0.2));
        add(world, BodyDef { angle: turned(6.0 * rng.unit()), ..body });
    }
}

// Falling asleep.

#[test]
fn a_stack_falls_asleep_after_half_a_second_and_stays_to_the_bit() {
    let (mut world, _) = floor();
    let ids = stack(&mut world, 0.0, 10);
    let ticks = until_asleep(&mut world, 300);
    println!("a stack of 10 is asleep after {ticks} ticks");
    assert!((30..=120).contains(&ticks), "{ticks}");
    assert!(ids.iter().all(|&id| get(&world, id).velocity().is_zero()));
    assert!(ids.iter().all(|&id| get(&world, id).angular_velocity().to_bits() == 0));
    let (state, parts) = (all_bits(&world), world.hash_parts());
    for _ in 0..600 {
        world.step();
        assert_eq!(world.events(), []);
        assert_eq!(all_bits(&world), state);
    }
    // Nothing but the clock goes on.
    for (then, now) in parts.into_iter().zip(world.hash_parts()) {
        assert_eq!(then.hash == now.hash, then.name != "configuration", "{}", then.name);
    }
}

#[test]
fn a_pile_falls_asleep_and_stays() {
    for seed in 1..=3 {
        let (mut world, _) = floor();
        pile(&mut world, 120, seed);
        let ticks = until_asleep(&mut world, 1800);
        println!(
            "pile {seed} of 120 is asleep after {:.1} s, overlap {:.4}",
            ticks as f64 / 60.0,
            worst_overlap(&world)
        );
        let state = all_bits(&world);
        run(&mut world, 300);
        assert_eq!(all_bits(&world), state);
        assert_eq!(up(&world), 0);
    }
}

#[test]
fn a_body_falls_asleep_when_it_has_been_quiet_for_the_time_and_not_a_tick_before() {
    for (speed, time, ticks) in [("0.05", "0.5", 30), ("0.05", "0", 1), ("0.05", "0.001", 1), ("0", "1.01", 61)] {
        let sleeping = Some(Sleeping { speed: num(speed), time: num(time) });
        let mut world = World::new(&WorldDef { sleeping, ..WorldDef::default() }).expect("accepted");
        let id = add(&mut world, solid(0.0, 0.0, disc(1.0)));
        for tick in 1..=ticks {
            assert!(awake(&world, id), "{tick}");
            world.step();
        }
        assert!(!awake(&world, id));
    }
    // Just as fast as the limit, and one unit faster; the rim as well, of a disc of 2 m.
    let body = |v: &str, omega: &str| {
        let mut world = dormitory(0.0, 0.0);
        let def = solid(0.0, 0.0, disc(2.0));
        let velocity = Vec2 { x: num(v), y: num("0") };
        let id = add(&mut world, BodyDef { velocity, angular_velocity: num(omega), ..def });
        run(&mut world, 40);
        assert_eq!(
            get(&world, id).velocity().is_zero() && get(&world, id).angular_velocity().to_bits() == 0,
            !awake(&world, id)
        );
        awake(&world, id)
    };
    assert!(!body("0.05", "0") && !body("-0.05", "0"));
    assert!(body("0.05000000000001", "0") && body("-0.05000000000001", "0"));
    assert!(!body("0.03", "0.0249999") && body("0.03", "-0.0250001"));
}

#[test]
fn pixels_are_taken_as_such() {
    // 2 pixels a second where 2^6 of them are a metre: below 0.05·64.
    for (unit_shift, asleep) in [(6, true), (5, false)] {
        let sleeping = Some(Sleeping::default());
        let mut world = World::new(&WorldDef { unit_shift, sleeping, ..WorldDef::default() }).expect("accepted");
        let id = add(&mut world, moving(solid(0.0, 0.0, disc(30.0)), 2.0, 0.0));
        run(&mut world, 31);
        assert_eq!(awake(&world, id), !asleep);
    }
}

#[test]
fn without_sleeping_nothing_sleeps_and_with_it_nothing_moves_otherwise_until_it_does() {
    let build = |sleeping| {
        let gravity = acc(0.0, -9.81);
        let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
        add(&mut world, fixed(0.0, -1.0, rectangle(200.0, 2.0)));
        pile(&mut world, 40, 5);
        world
    };
    assert_eq!(WorldDef::default().sleeping, None);
    let (mut off, mut on) = (build(None), build(Some(Sleeping::default())));
    let mut ticks = 0;
    while up(&on) == 40 {
        assert_eq!(all_bits(&off), all_bits(&on), "tick {ticks}");
        off.step();
        on.step();
        ticks += 1;
        assert!(ticks < 1200, "somebody falls asleep");
    }
    run(&mut off, 300);
    assert_eq!(up(&off), 40);
    assert_eq!(off.put_to_sleep(off.bodies().last().expect("there are some").id()), Err(CommandError::NoSleeping));
}

#[test]
fn what_must_not_sleep_keeps_its_island_awake_and_only_that() {
    let (mut world, _) = floor();
    let restless = stack(&mut world, 0.0, 4);
    let others = stack(&mut world, 5.0, 4);
    world.set_allow_sleep(restless[2], false).expect("accepted");
    run(&mut world, 200);
    assert!(restless.iter().all(|&id| awake(&world, id)) && others.iter().all(|&id| !awake(&world, id)));
    assert!(!get(&world, restless[2]).def().allow_sleep);
    world.set_allow_sleep(restless[2], true).expect("accepted");
    assert!(until_asleep(&mut world, 40) <= 30);
    // And wakes it.
    world.set_allow_sleep(restless[0], false).expect("accepted");
    assert!(restless.iter().all(|&id| awake(&world, id)));
}

#[test]
fn what_is_pushed_does_not_sleep_and_what_leans_on_a_wall_does() {
    let (mut world, _) = floor();
    add(&mut world, fixed(5.0, 1.0, rectangle(1.0, 4.0)));
    let pushed = stack(&mut world, 0.0, 1)[0];
    let leaning = stack(&mut world, 4.0, 1)[0];
    world.set_force(leaning, newtons(3.0, 0.0)).expect("accepted");
    for _ in 0..200 {
        // Too little to move it.
        world.apply_force(pushed, newtons(0.5, 0.0), None).expect("accepted");
        world.step();
        assert!(awake(&world, pushed));
    }
    assert!(!awake(&world, leaning));
    // The same force again wakes nobody, another one does.
    world.set_force(leaning, newtons(3.0, 0.0)).expect("accepted");
    assert!(!awake(&world, leaning));
    world.set_force(leaning, newtons(-3.0, 0.0)).expect("accepted");
    assert!(awake(&world, leaning));
}

#[test]
fn nothing_sleeps_while_a_body_that_moves_pulls() {
    let mut world = dormitory(0.0, 0.0);
    let planet = add(&mut world, BodyDef { kind: BodyKind::Static, mu: num("500"), ..solid(0.0, 0.0, disc(10.0)) });
    let stone = add(&mut world, solid(0.0, 10.5, rectangle(1.0, 1.0)));
    run(&mut world, 120);
    assert!(!awake(&world, stone), "it lies on a planet that stays");
    let moon = add(&mut world, BodyDef { mu: num("1"), ..moving(solid(40.0, 0.0, disc(1.0)), 0.0, 3.5) });
    assert!(awake(&world, stone));
    run(&mut world, 120);
    assert!(awake(&world, stone) && awake(&world, planet));
    world.set_mu(moon, num("0")).expect("accepted");
    run(&mut world, 60);
    assert!(!awake(&world, stone));
    let star = Attractor { position: at(0.0, 100.0), mu: num("1") };
    let star = world.create_attractor(star).expect("accepted");
    assert!(awake(&world, stone));
    run(&mut world, 60);
    assert!(!awake(&world, stone));
    world.destroy_attractor(star).expect("accepted");
    assert!(awake(&world, stone));
}

// Waking.

#[test]
fn a_hit_wakes_the_whole_stack_in_its_tick_and_nobody_else() {
    for (vx, row) in [(10.0, 4.5), (0.5, 4.5), (40.0, 0.5), (300.0, 7.5)] {
        let (mut world, _) = floor();
        let ids = stack(&mut world, 0.0, 8);
        // Near, and not in touch.
        let beside = stack(&mut world, 1.015, 1)[0];
        until_asleep(&mut world, 200);
        let ball = add(&mut world, moving(solid(-4.0, row, disc(0.25)), vx, (4.0 / vx * 4.9f64).min(20.0)));
        let mut touched = false;
        for _ in 0..600 {
            let before = all_bits(&world);
            world.step();
            world.check().expect("every invariant holds");
            touched = world.events().iter().any(|event| {
                let of = [event.a, event.b].map(|id| world.collider(id).expect("it exists").body());
                event.kind == EventKind::ContactBegin && of.contains(&ball) && of.iter().any(|id| ids.contains(id))
            });
            if touched {
                break;
            }
            assert!(ids.iter().all(|&id| !awake(&world, id)));
            // Not before it is touched, and so to the bit.
            for &id in &ids {
                assert_eq!(bits(&get(&world, id)), before[id.index as usize]);
            }
        }
        assert!(touched, "the ball arrives");
        assert!(ids.iter().all(|&id| awake(&world, id)), "{vx} m/s");
        if vx < 1.0 {
            assert!(!awake(&world, beside));
        }
        // It rolls on, and what is hit at 300 m/s falls off the edge.
        if vx > 100.0 {
            continue;
        }
        world.destroy_body(ball).expect("accepted");
        until_asleep(&mut world, 2000);
    }
}

/// Steps until something wakes; the world as it was before that tick.
fn until_woken(world: &mut World, most: u64) -> World {
    for _ in 0..most {
        let (before, awake) = (world.clone(), up(world));
        world.step();
        if up(world) > awake {
            return before;
        }
    }
    panic!("nothing wakes");
}

#[test]
fn a_tick_that_wakes_is_that_of_a_world_in_which_the_island_was_awake() {
    for (seed, speed) in [(1, 3.0), (2, 20.0), (3, 80.0), (4, 300.0)] {
        let (mut world, _) = floor();
        if seed % 2 == 0 {
            pile(&mut world, 40, seed);
        } else {
            stack(&mut world, 0.0, 6);
        }
        until_asleep(&mut world, 1800);
        let sleepers: Vec<BodyId> = world.bodies().map(|body| body.id()).collect();
        let ball = surface(disc(0.3), 0.4, 0.5);
        add(&mut world, BodyDef { angular_velocity: spin(3.0), ..moving(solid(0.3, 12.0, ball), 0.0, -speed) });
        let mut before = until_woken(&mut world, 600);
        for &id in sleepers.iter().filter(|&&id| awake(&world, id) && get(&world, id).kind() == BodyKind::Dynamic) {
            before.wake(id).expect("accepted");
        }
        for _ in 0..20 {
            // Whoever else wakes in the ticks after wakes in both.
            before.step();
            assert_eq!(before.hash(), world.hash(), "{speed} m/s");
            assert_eq!(before.events(), world.events());
            assert_eq!(before.collisions(), world.collisions());
            world.step();
        }
    }
}

/// The greatest gain of energy in a tick, and in a tick in which something wakes, of a pile onto which balls fall; and how
/// many such ticks there are.
fn gains(sleeping: Option<Sleeping>) -> (f64, f64, usize) {
    let gravity = acc(0.0, -9.81);
    let mut world = World::new(&WorldDef { gravity, sleeping, ..WorldDef::default() }).expect("accepted");
    add(&mut world, fixed(0.0, -1.0, rectangle(200.0, 2.0)));
    pile(&mut world, 50, 21);
    let (mut most, mut waking, mut wakes) = (0.0f64, 0.0f64, 0);
    for tick in 0..3600 {
        if tick > 400 && tick % 240 == 0 {
            let ball = solid(-3.0 + (tick % 7) as f64, 16.0, surface(disc(0.4), 0.6, 0.2));
            add(&mut world, moving(ball, (tick % 5) as f64 - 2.0, -8.0));
        }
        let (awake, before) = (up(&world), energy(&world));
        world.step();
        let gain = energy(&world) - before;
        most = most.max(gain);
        if up(&world) > awake {
            (waking, wakes) = (waking.max(gain), wakes + 1);
        }
    }
    (most, waking, wakes)
}

#[test]
fn waking_adds_no_energy() {
    let ((most, waking, wakes), (without, _, none)) = (gains(Some(Sleeping::default())), gains(None));
    println!(
        "{wakes} wakings; gained in one of them {waking:.1e} J, in a tick {most:.1e}, without sleeping {without:.1e}"
    );
    assert_eq!(none, 0);
    // What wakes them strikes in the same tick, and overlaps are pushed apart in any.
    assert!(wakes > 5 && waking < without && most < 2.0 * without);
}

#[test]
fn what_is_hit_hits_what_sleeps_farther_on_in_the_same_tick() {
    // Elastic discs 1 mm apart, each asleep by itself: as if awake.
    let build = |wake: bool| {
        let mut world = dormitory(0.0, 0.0);
        let ball = surface(disc(0.5), 0.0, 1.0);
        let ids: Vec<_> = (0..30).map(|i| add(&mut world, solid(f64::from(i) * 1.001, 0.0, ball.clone()))).collect();
        until_asleep(&mut world, 40);
        if wake {
            ids.iter().for_each(|&id| world.wake(id).expect("accepted"));
        }
        let cue = add(&mut world, moving(solid(-1.2, 0.0, ball), 100.0, 0.0));
        (world, ids, cue)
    };
    let ((mut slept, ids, cue), (mut never, ..)) = (build(false), build(true));
    for _ in 0..3 {
        slept.step();
        never.step();
        assert_eq!(all_bits(&slept), all_bits(&never));
        assert_eq!(slept.collisions(), never.collisions());
        slept.check().expect("every invariant holds");
    }
    assert!(get(&slept, ids[29]).velocity().x.to_f64() > 99.0);
    close(get(&slept, cue).velocity().x.to_f64(), 0.0, 1e-3);
}

#[test]
fn waking_without_a_reason_moves_nothing_and_adds_no_energy() {
    let (mut world, _) = floor();
    let ids = stack(&mut world, 0.0, 20);
    until_asleep(&mut world, 400);
    let (before, start) = (energy(&world), all_bits(&world));
    world.wake(ids[7]).expect("accepted");
    assert_eq!(up(&world), 20);
    let (mut fastest, mut gain) = (0.0f64, 0.0f64);
    for _ in 0..29 {
        world.step();
        fastest = fastest.max(solid::fastest(&world));
        gain = gain.max(energy(&world) - before);
    }
    let moved = start.iter().zip(all_bits(&world)).map(|(a, b)| (a[1] - b[1]).abs().max((a[0] - b[0]).abs())).max();
    let moved = moved.expect("there are bodies") as f64 * common::ULP_X;
    println!("a stack of 20 woken: {fastest:.1e} m/s, {moved:.1e} m, {gain:.1e} J of {before:.0}");
    assert!(fastest < 2e-3 && moved < 1e-4 && gain < 1e-3 * before.abs());
    assert_eq!(until_asleep(&mut world, 60), 1);
}

#[test]
fn a_pile_that_sleeps_and_wakes_again_and_again_does_not_sink() {
    let (mut world, _) = floor();
    pile(&mut world, 60, 9);
    until_asleep(&mut world, 1800);
    let (start, overlap) = (all_bits(&world), worst_overlap(&world));
    for _ in 0..20 {
        let any = world.bodies().last().expect("there are bodies").id();
        world.wake(any).expect("accepted");
        until_asleep(&mut world, 600);
    }
    let lower = |(a, b): (&[i64; 6], [i64; 6])| (a[1] - b[1]) as f64 * common::ULP_X;
    let sunk = start.iter().zip(all_bits(&world)).map(lower).fold(0.0, f64::max);
    println!(
        "20 times asleep: the lowest sank {sunk:.1e} m, overlap {overlap:.4} m, then {:.4} m",
        worst_overlap(&world)
    );
    assert!(sunk < 5e-3 && worst_overlap(&world) < overlap + 2e-3);
}

#[test]
fn every_command_that_touches_what_sleeps_wakes_it() {
    type Act = fn(&mut World, BodyId, BodyId) -> Result<(), CommandError>;
    // The middle of a stack of three, and the floor.
    let acts: [(&str, Act); 24] = [
        ("position", |w, b, _| w.set_position(b, at(0.01, 1.5))),
        ("angle", |w, b, _| w.set_angle(b, Angle::from_bits(1))),
        ("velocity", |w, b, _| w.set_velocity(b, vel(0.0, 1e-6))),
        ("spin", |w, b, _| w.set_angular_velocity(b, num("0.001"))),
        ("force", |w, b, _| w.set_force(b, newtons(0.0, 1.0))),
        ("torque", |w, b, _| w.set_torque(b, num("1"))),
        ("mass", |w, b, _| w.set_mass(b, num("2"), num("1"))),
        ("fixed", |w, b, _| w.set_fixed_rotation(b, true)),
        ("damping", |w, b, _| w.set_damping(b, num("1"), num("0"))),
        ("mu", |w, b, _| w.set_mu(b, num("1"))),
        ("kind", |w, b, _| w.set_kind(b, BodyKind::Kinematic)),
        ("push", |w, b, _| w.apply_force(b, newtons(0.0, 0.0), None)),
        ("twist", |w, b, _| w.apply_torque(b, num("0"))),
        ("impulse", |w, b, _| w.apply_impulse(b, newton_seconds(0.0, 0.0), None)),
        ("spin impulse", |w, b, _| w.apply_angular_impulse(b, num("0"))),
        ("wake", |w, b, _| w.wake(b)),
        ("gone", |w, b, _| w.destroy_body(b)),
        ("surface", |w, b, _| {
            let id = get(w, b).colliders().next().expect("it has one").id();
            w.set_surface(id, num("0"), num("0.1"))
        }),
        ("filter", |w, b, _| {
            let id = get(w, b).colliders().next().expect("it has one").id();
            w.set_filter(id, Filter { mask: 2, ..Filter::default() })
        }),
        ("gravity", |w, _, _| w.set_gravity(acc(0.0, -1.0))),
        ("floor gone", |w, _, f| w.destroy_body(f)),
        ("floor moved", |w, _, f| w.set_position(f, at(0.0, -50.0))),
        ("floor wakes", |w, _, f| w.wake(f)),
        ("floor dynamic", |w, _, f| w.set_kind(f, BodyKind::Dynamic)),
    ];
    for (name, act) in acts {
        let (mut world, ground) = floor();
        let ids = stack(&mut world, 0.0, 3);
        until_asleep(&mut world, 200);
        act(&mut world, ids[1], ground).expect("accepted");
        for &id in ids.iter().filter(|&&id| world.body(id).is_some()) {
            assert!(awake(&world, id), "{name}");
        }
        // A loaded world goes on alike, and the step finds nobody missing.
        world.check().unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut twin = World::load(&world.save()).expect("just saved");
        for _ in 0..100 {
            world.step();
            twin.step();
            assert_eq!(world.hash(), twin.hash(), "{name}");
            world.check().unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
}

#[test]
fn commands_that_change_nothing_wake_nobody_and_refused_ones_change_nothing() {
    let (mut world, ground) = floor();
    let ids = stack(&mut world, 0.0, 3);
    until_asleep(&mut world, 200);
    let place = get(&world, ids[1]).position();
    world.set_position(ids[1], place).expect("accepted");
    world.set_velocity(ids[1], vel(0.0, 0.0)).expect("accepted");
    world.set_user_data(ids[1], 7).expect("accepted");
    world.set_position(ground, at(0.0, -1.0)).expect("accepted");
    world.set_gravity(acc(0.0, -9.81)).expect("accepted");
    world.set_allow_sleep(ids[1], true).expect("accepted");
    world.put_to_sleep(ids[1]).expect("accepted");
    world.clear_status().expect("accepted");
    world.input(vec![1]).expect("accepted");
    // Elsewhere.
    add(&mut world, fixed(20.0, 3.0, rectangle(1.0, 1.0)));
    let other = stack(&mut world, 10.0, 1)[0];
    world.destroy_body(other).expect("accepted");
    assert_eq!(up(&world), 0);
    let hash = world.hash();
    assert!(world.set_velocity(ground, vel(1.0, 0.0)).is_err());
    assert!(world.set_velocity(other, vel(1.0, 0.0)).is_err());
    assert_eq!(world.put_to_sleep(other), Err(CommandError::NoSuchBody(other)));
    assert_eq!(world.put_to_sleep(ground).expect_err("static").to_string(), "a static body has no sleep");
    assert_eq!(world.wake(other), Err(CommandError::NoSuchBody(other)));
    assert_eq!(world.hash(), hash);
    let pair = stack(&mut world, 30.0, 2);
    run(&mut world, 3);
    world.set_allow_sleep(pair[0], false).expect("accepted");
    let hash = world.hash();
    let refused = world.put_to_sleep(pair[1]).expect_err("its neighbour must not");
    assert_eq!(refused, CommandError::MustNotSleep(pair[0]));
    assert_eq!(refused.to_string(), format!("{} must not sleep", pair[0]));
    assert_eq!(world.hash(), hash);
}

#[test]
fn removing_the_support_lets_it_fall() {
    let (mut world, _) = floor();
    let table = add(&mut world, fixed(0.0, 5.0, rectangle(4.0, 1.0)));
    let cup = add(&mut world, solid(0.0, 6.0, rectangle(1.0, 1.0)));
    let lamp = add(&mut world, solid(0.0, 7.0, rectangle(0.5, 1.0)));
    until_asleep(&mut world, 200);
    world.destroy_body(table).expect("accepted");
    run(&mut world, 30);
    for (id, height) in [(cup, 6.0), (lamp, 7.0)] {
        close(position(&world, id).1, height - 0.5 * 9.81 * 0.25, 0.01);
    }
    until_asleep(&mut world, 400);
    // The upper one stays until the lower one is gone.
    world.destroy_body(cup).expect("accepted");
    world.step();
    assert!(world.events().iter().any(|event| event.kind == EventKind::ContactEnd));
    run(&mut world, 60);
    close(position(&world, lamp).1, 0.5, 0.3);
}

#[test]
fn what_is_put_into_what_sleeps_wakes_it() {
    for kind in [BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic] {
        let (mut world, _) = floor();
        let ids = stack(&mut world, 0.0, 2);
        until_asleep(&mut world, 200);
        let wedge = BodyDef { kind, ..solid(0.4, 0.4, rectangle(0.5, 0.5)) };
        let id = add(&mut world, wedge);
        world.step();
        assert!(ids.iter().all(|&id| awake(&world, id)), "{kind:?}");
        // And again, by moving it there.
        world.set_position(id, at(30.0, 30.0)).expect("accepted");
        world.set_kind(id, kind).expect("accepted");
        run(&mut world, 300);
        assert!(ids.iter().all(|&id| !awake(&world, id)), "{kind:?}");
        let (x, y) = position(&world, ids[0]);
        world.set_position(id, at(x, y)).expect("accepted");
        world.step();
        assert!(ids.iter().all(|&id| awake(&world, id)), "{kind:?}");
    }
}

#[test]
fn kinematic_bodies_carry_push_and_wake() {
    let mut world = dormitory(0.0, -9.81);
    let lift = add(&mut world, BodyDef { kind: BodyKind::Kinematic, ..solid(0.0, -0.5, rectangle(4.0, 1.0)) });
    let ids = stack(&mut world, 0.0, 3);
    until_asleep(&mut world, 200);
    // While it moves, even more slowly than what is quiet.
    world.set_velocity(lift, vel(0.0, 0.01)).expect("accepted");
    assert_eq!(up(&world), 3);
    run(&mut world, 120);
    assert_eq!(up(&world), 3);
    close(position(&world, ids[0]).1, 0.52, 1e-3);
    // Down and away from under them.
    world.set_velocity(lift, vel(0.0, 0.0)).expect("accepted");
    until_asleep(&mut world, 60);
    world.set_velocity(lift, vel(0.0, 0.0)).expect("accepted");
    assert_eq!(up(&world), 0, "that changes nothing");
    world.set_velocity(lift, vel(0.0, -20.0)).expect("accepted");
    run(&mut world, 30);
    close(position(&world, ids[2]).1, 2.52 - 0.5 * 9.81 * 0.25, 0.02);

    // One that comes from afar.
    let (mut world, _) = floor();
    let ids = stack(&mut world, 0.0, 3);
    until_asleep(&mut world, 200);
    let ram = BodyDef { kind: BodyKind::Kinematic, velocity: vel(1.0, 0.0), ..solid(-3.0, 1.5, rectangle(1.0, 0.5)) };
    add(&mut world, ram);
    run(&mut world, 100);
    assert_eq!(up(&world), 0);
    run(&mut world, 40);
    assert_eq!(up(&world), 3);
    assert!(position(&world, ids[1]).0 > 0.1);
}

#[test]
fn sensors_tell_of_what_sleeps_and_wake_nobody() {
    let (mut world, _) = floor();
    let gate = ColliderDef { sensor: true, ..rectangle(3.0, 3.0) };
    let still = add(&mut world, fixed(0.0, 1.6, gate.clone()));
    let ids = stack(&mut world, 0.0, 2);
    until_asleep(&mut world, 200);
    let kinds = |world: &World| world.events().iter().map(|event| event.kind).collect::<Vec<_>>();
    // A sensor that passes, and one on a body that falls asleep itself.
    let scanner = BodyDef { kind: BodyKind::Kinematic, velocity: vel(6.0, 0.0), ..solid(-4.0, 1.6, gate.clone()) };
    let scanner = add(&mut world, scanner);
    let mut seen = Vec::new();
    for _ in 0..120 {
        world.step();
        seen.extend(kinds(&world));
        assert_eq!(up(&world), 0);
    }
    assert_eq!(seen, [EventKind::SensorBegin, EventKind::SensorBegin, EventKind::SensorEnd, EventKind::SensorEnd]);
    world.destroy_body(scanner).expect("accepted");
    // One that appears tells as well.
    let late = add(&mut world, fixed(0.0, 1.6, gate));
    world.step();
    assert_eq!(kinds(&world), [EventKind::SensorBegin; 2]);
    until_asleep(&mut world, 60);
    for id in [still, late] {
        world.destroy_body(id).expect("accepted");
        world.step();
        assert_eq!(kinds(&world), [EventKind::SensorEnd; 2]);
        world.check().expect("every invariant holds");
    }
    world.destroy_body(ids[0]).expect("accepted");
    world.step();
    assert_eq!(kinds(&world), [EventKind::ContactEnd; 2]);
}

#[test]
fn what_is_put_to_sleep_stays_where_it_is_until_something_comes() {
    let mut world = dormitory(0.0, -9.81);
    let cloud = add(&mut world, moving(solid(0.0, 10.0, rectangle(2.0, 1.0)), 3.0, 1.0));
    run(&mut world, 3);
    world.apply_force(cloud, newtons(5.0, 0.0), None).expect("accepted");
    world.put_to_sleep(cloud).expect("accepted");
    world.check().expect("every invariant holds");
    let state = bits(&get(&world, cloud));
    assert_eq!(state[2..4], [0, 0]);
    run(&mut world, 100);
    assert_eq!(bits(&get(&world, cloud)), state);
    // Queries see it.
    let (x, y) = position(&world, cloud);
    assert_eq!(world.overlap_point(at(x, y), Filter::default()).len(), 1);
    let hit = world.ray_cast(at(x, y + 5.0), at(0.0, -10.0), Filter::default()).expect("it is in the way");
    close(hit.point.y.to_f64(), y + 0.5, 1e-6);
    // So does what falls on it: together they go on.
    add(&mut world, solid(x, y + 2.0, disc(0.25)));
    run(&mut world, 60);
    assert!(awake(&world, cloud) && position(&world, cloud).1 < y);
}

// The same whatever the order, the place, the direction, and how often it was saved.

#[test]
fn twins_sleep_and_wake_alike() {
    let script = |world: &mut World, tick: u64| {
        let id = BodyId { index: 8, generation: 0 };
        match tick {
            200 => drop(add(world, moving(solid(-5.0, 8.0, disc(0.4)), 7.0, 0.0))),
            330 => world.apply_impulse(id, newton_seconds(0.0, 3.0), None).expect("accepted"),
            480 => world.destroy_body(BodyId { index: 12, generation: 0 }).expect("accepted"),
            520 => world.put_to_sleep(id).expect("accepted"),
            540 => world.set_gravity(acc(1.0, -9.0)).expect("accepted"),
            700 => drop(add(world, moving(solid(-1.0, 8.0, disc(0.4)), 0.0, -9.0))),
            _ => {}
        }
    };
    let start = || {
        let (mut world, _) = floor();
        pile(&mut world, 30, 3);
        world
    };
    let (mut one, mut saved, mut cloned) = (start(), start(), start());
    let mut buffer = start();
    let (mut slept, mut woke) = (0, 0);
    for tick in 0..1100 {
        for world in [&mut one, &mut saved, &mut cloned] {
            script(world, tick);
        }
        let before = up(&one);
        if tick % 7 == 0 {
            let loaded = World::load(&saved.save()).expect("just saved");
            assert_eq!(loaded.diff(&saved), []);
            saved = loaded;
        }
        if tick % 5 == 0 {
            buffer.clone_from(&cloned);
            std::mem::swap(&mut buffer, &mut cloned);
        }
        for world in [&mut one, &mut saved, &mut cloned] {
            world.step();
        }
        one.check().expect("every invariant holds");
        assert_eq!(one.hash(), saved.hash(), "tick {tick}");
        assert_eq!(one.hash(), cloned.hash(), "tick {tick}");
        assert_eq!(one.events(), saved.events());
        assert_eq!(one.save(), saved.save());
        let after = up(&one);
        slept += usize::from(after < before);
        woke += usize::from(after > before);
    }
    assert!(slept > 2 && woke >= 1, "{slept} {woke}");
    assert!(one.diff(&start()).iter().any(|difference| difference.path.ends_with("].asleep")));
}

#[test]
fn the_order_of_creation_has_no_say() {
    // Five islands and a ball, in two orders; each body by its name.
    let build = |order: [usize; 6]| {
        let (mut world, _) = floor();
        let mut names = vec![Vec::new(); 6];
        for at in order {
            names[at] = match at {
                5 => vec![add(&mut world, moving(solid(-8.0, 3.2, disc(0.3)), 5.0, 2.0))],
                rows => stack(&mut world, 4.0 * rows as f64, rows as u32 + 1),
            };
        }
        (world, names.concat())
    };
    let (mut one, names) = build([0, 1, 2, 3, 4, 5]);
    let (mut other, others) = build([3, 0, 4, 2, 1, 5]);
    let (mut slept, mut woke) = (false, false);
    for tick in 0..600 {
        if tick == 200 {
            for (world, names) in [(&mut one, &names), (&mut other, &others)] {
                let ball = *names.last().expect("the ball");
                world.set_position(ball, at(-1.5, 0.5)).expect("accepted");
                world.set_velocity(ball, vel(5.0, 0.0)).expect("accepted");
            }
        }
        let before = up(&one);
        one.step();
        other.step();
        for (a, b) in names.iter().zip(&others) {
            assert_eq!(awake(&one, *a), awake(&other, *b), "tick {tick}");
            assert_eq!(bits(&get(&one, *a)), bits(&get(&other, *b)), "{a} in tick {tick}");
        }
        (slept, woke) = (slept || up(&one) < before, woke || tick > 200 && up(&one) > before);
    }
    assert!(slept && woke);
}

/// Runs a pile that is hit again and again; the bits in each tick.
fn course(defs: &[BodyDef], gravity: (f64, f64), turn: bool, ticks: u64) -> (Vec<Vec<[i64; 6]>>, Vec<usize>) {
    let mut world = dormitory(gravity.0, gravity.1);
    let ids: Vec<BodyId> = defs.iter().map(|def| world.create_body(def).expect("accepted")).collect();
    let (mut course, mut ups) = (Vec::new(), Vec::new());
    for tick in 0..ticks {
        if tick % 150 == 149 {
            let side = if turn { -1.0 } else { 1.0 };
            let last = *ids.last().expect("not empty");
            world.apply_impulse(last, newton_seconds(side * 0.5, side * 1.0), None).expect("accepted");
        }
        world.step();
        course.push(all_bits(&world));
        ups.push(up(&world));
    }
    (course, ups)
}

fn pile_defs() -> Vec<BodyDef> {
    let (mut world, _) = floor();
    pile(&mut world, 24, 11);
    world.bodies().map(|body| body.def()).collect()
}

#[test]
fn a_world_turned_by_half_a_turn_has_the_negated_bits() {
    let half = 1i64 << 47;
    let defs = pile_defs();
    let turned: Vec<BodyDef> = pile_defs()
        .into_iter()
        .map(|def| {
            let (x, y) = def.position.to_f64();
            BodyDef { position: at(-x, -y), angle: Angle::from_bits(def.angle.to_bits() + half), ..def }
        })
        .collect();
    let ((one, ups), (other, others)) =
        (course(&defs, (0.0, -9.81), false, 600), course(&turned, (0.0, 9.81), true, 600));
    assert!(ups.contains(&0) && ups[ups.len() - 100..].iter().any(|&up| up > 0));
    assert_eq!(ups, others);
    for (tick, (a, b)) in one.iter().zip(&other).enumerate() {
        for (a, b) in a.iter().zip(b) {
            let [x, y, vx, vy, angle, spin] = *a;
            assert_eq!([-x, -y, -vx, -vy, angle + half, spin], *b, "tick {tick}");
        }
    }
}

#[test]
fn a_world_elsewhere_has_the_same_bits() {
    let far = 2f64.powi(20);
    let defs = pile_defs();
    let moved: Vec<BodyDef> = pile_defs()
        .into_iter()
        .map(|def| {
            let (x, y) = def.position.to_f64();
            BodyDef { position: at(x + far, y - far), ..def }
        })
        .collect();
    let ((one, ups), (other, others)) =
        (course(&defs, (0.0, -9.81), false, 400), course(&moved, (0.0, -9.81), false, 400));
    assert!(ups.contains(&0));
    assert_eq!(ups, others);
    let by = (far / common::ULP_X) as i64;
    for (a, b) in one.iter().flatten().zip(other.iter().flatten()) {
        assert_eq!([a[0] + by, a[1] - by, a[2], a[3], a[4], a[5]], *b);
    }
}

// Cost, and what cannot be.

#[test]
fn falling_asleep_and_waking_allocate_nothing_any_more() {
    let (mut world, _) = floor();
    let ids = stack(&mut world, 0.0, 12);
    let ball = add(&mut world, solid(-50.0, 0.5, disc(0.5)));
    let round = |world: &mut World| {
        for tick in 0..240 {
            if tick == 120 {
                world.set_position(ball, at(-2.0, 3.0)).expect("accepted");
                world.set_velocity(ball, vel(4.0, 0.0)).expect("accepted");
            }
            world.step();
            std::hint::black_box(world.hash());
        }
        for (row, &id) in ids.iter().enumerate() {
            world.set_position(id, at(0.0, 0.5 + row as f64)).expect("accepted");
            world.set_angle(id, Angle::ZERO).expect("accepted");
            world.set_velocity(id, vel(0.0, 0.0)).expect("accepted");
            world.set_angular_velocity(id, num("0")).expect("accepted");
        }
        world.set_position(ball, at(-50.0, 0.5)).expect("accepted");
        world.set_velocity(ball, vel(0.0, 0.0)).expect("accepted");
        world.set_angular_velocity(ball, num("0")).expect("accepted");
    };
    for _ in 0..2 {
        round(&mut world);
    }
    let ((), allocations, _) = measure(|| round(&mut world));
    assert_eq!(allocations, 0);
}

#[test]
fn settings_out_of_range_are_refused() {
    let new = |speed: &str, time: &str| {
        let sleeping = Some(Sleeping { speed: num(speed), time: num(time) });
        World::new(&WorldDef { sleeping, ..WorldDef::default() }).map(drop)
    };
    assert_eq!(new("0", "0"), Ok(()));
    assert_eq!(new("400", "1000"), Ok(()));
    let text = |result: Result<(), ConfigError>| result.expect_err("out of range").to_string();
    assert_eq!(text(new("400.5", "1")), "speed of what falls asleep 400.5 m/s is outside 0 … 400 m/s");
    assert_eq!(text(new("-0.5", "1")), "speed of what falls asleep -0.5 m/s is outside 0 … 400 m/s");
    assert_eq!(text(new("1", "1000.5")), "time of falling asleep 1000.5 s is outside 0 … 1000 s");
    assert_eq!(text(new("1", "-0.5")), "time of falling asleep -0.5 s is outside 0 … 1000 s");
}

/// The next of a storm of commands, those of sleeping among them. In a `calm` one nothing attracts, which would keep all
/// awake.
fn act(storm: &mut Storm, world: &mut World, calm: bool) {
    let ids: Vec<BodyId> = world.bodies().map(|body| body.id()).collect();
    let some = |rng: &mut Rng| ids.get(rng.below(ids.len() as u64 + 1) as usize).copied().unwrap_or_default();
    let _refused_or_not = match storm.rng.below(12) {
        0 => world.wake(some(&mut storm.rng)),
        1 => world.put_to_sleep(some(&mut storm.rng)),
        2 => world.set_allow_sleep(some(&mut storm.rng), storm.rng.clone().below(4) > 0),
        _ => {
            let reply = match storm.command() {
                Command::CreateBody { def } if calm => world.apply(Command::CreateBody {
                    def: BodyDef { mu: num("0"), velocity: vel(0.0, 0.0), angular_velocity: num("0"), ..def },
                }),
                Command::SetMu { .. } | Command::CreateAttractor { .. } | Command::SetForce { .. } if calm => {
                    Ok(Reply::Done)
                }
                command => world.apply(command),
            };
            storm.heed(reply).map(drop)
        }
    };
}

fn sleepy(seed: u64) -> World {
    let sleeping = Some(Sleeping {
        speed: [num("0.05"), num("5"), num("100")][(seed % 3) as usize],
        time: [num("0.02"), num("0.1")][(seed / 3 % 2) as usize],
    });
    let integrator = if seed % 2 == 0 { Integrator::ForestRuth } else { Integrator::SymplecticEuler };
    let def = WorldDef { integrator, sleeping, gravity: acc(0.0, -9.8), ..WorldDef::default() };
    let mut world = World::new(&def).expect("accepted");
    add(&mut world, fixed(0.0, -20.0, rectangle(100.0, 20.0)));
    world
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Every invariant holds after each command and tick, and a twin that was loaded goes on alike.
    #[test]
    fn storms_of_commands_break_nothing(seed in any::<u64>(), ticks in 10u64..90) {
        let (mut storm, calm) = (Storm::solid(seed, 12.0), seed % 4 > 0);
        let mut world = sleepy(seed);
        let mut twin = world.clone();
        let mut other = storm.clone();
        let (mut slept, mut woke) = (false, false);
        for tick in 0..ticks {
            // With pauses, in which bodies may fall asleep.
            let commands = if tick / 10 % 2 == 0 { storm.rng.clone().below(4) } else { 0 };
            for _ in 0..commands {
                act(&mut storm, &mut world, calm);
                act(&mut other, &mut twin, calm);
                prop_assert_eq!(world.check(), Ok(()));
                prop_assert_eq!(world.hash(), twin.hash());
                if tick % 3 == 1 {
                    twin = World::load(&twin.save()).expect("just saved");
                }
            }
            let before = up(&world);
            world.step();
            twin.step();
            (slept, woke) = (slept || up(&world) < before, woke || up(&world) > before);
            prop_assert_eq!(world.check(), Ok(()));
            prop_assert_eq!(world.hash(), twin.hash());
            if tick % 4 == 0 {
                twin = World::load(&twin.save()).expect("just saved");
                prop_assert_eq!(twin.check(), Ok(()));
            }
        }
        let _what_happened = (slept, woke);
    }
}

#[test]
fn storms_put_much_to_sleep_and_wake_it() {
    let (mut slept, mut woke) = (0, 0);
    for seed in 0..40 {
        let (mut storm, calm) = (Storm::solid(seed, 12.0), seed % 4 > 0);
        let mut world = sleepy(seed);
        for tick in 0..90 {
            for _ in 0..if tick / 10 % 2 == 0 { 2 } else { 0 } {
                act(&mut storm, &mut world, calm);
            }
            let before = up(&world);
            world.step();
            slept += usize::from(up(&world) < before);
            woke += usize::from(up(&world) > before);
        }
    }
    println!("ticks in which some fell asleep: {slept}, in which some woke: {woke}");
    assert!(slept > 100 && woke > 20, "{slept} {woke}");
}

#[test]
fn forged_saves_of_sleepers_are_refused_or_are_worlds() {
    let (mut world, _) = floor();
    stack(&mut world, 0.0, 3);
    add(&mut world, BodyDef { angular_velocity: spin(0.0), ..solid(9.0, 0.5, disc(0.5)) });
    until_asleep(&mut world, 300);
    let other = stack(&mut world, 5.0, 1)[0];
    world.step();
    world.wake(other).expect("accepted");
    let (save, mut rng) = (world.save(), Rng(1));
    let (mut worlds, mut refused) = (0, 0);
    for at in (16..save.len() - 8).rev() {
        let mut bytes = save.clone();
        bytes[at] = [0, 1, 2, 0x7f, 0xff, rng.bits() as u8][rng.below(6) as usize];
        if let Err(tamias2d::DecodeError::Hash { computed, .. }) = World::load(&bytes) {
            let at = bytes.len() - 8;
            bytes[at..].copy_from_slice(&computed.to_le_bytes());
        }
        match World::load(&bytes) {
            Ok(mut world) => {
                worlds += 1;
                assert_eq!(world.check(), Ok(()));
                for _ in 0..3 {
                    world.step();
                    assert_eq!(world.check(), Ok(()), "byte {at}");
                }
                let ids: Vec<BodyId> = world.bodies().map(|body| body.id()).collect();
                for id in ids {
                    let _refused_or_not = world.wake(id);
                    assert_eq!(world.check(), Ok(()), "byte {at}");
                }
                world.step();
                assert_eq!(world.check(), Ok(()), "byte {at}");
            }
            Err(_) => refused += 1,
        }
    }
    println!("{worlds} worlds, {refused} refused");
    assert!(worlds > 200 && refused > 50);
}
