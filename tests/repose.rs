//! Repose: what has come to rest is left to the bit as it is, for good, and what is not computed would have been so.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/solid.rs"]
mod solid;
#[path = "common/weather.rs"]
mod weather;

use common::{Rng, acc, at, disc, newton_seconds, newtons, num, position, rectangle, run, world};
use solid::{add, fixed, moving, solid, surface, weighing};
use tamias2d::{
    Angle, BodyDef, BodyId, BodyKind, ColliderDef, Command, Commands, Force, Sleeping, Vec2, Velocity, World, WorldDef,
};
use weather::Weather;

#[global_allocator]
static ALLOCATOR: common::Counting = common::Counting;

/// A floor whose top is at y = 0.
fn floor(world: &mut World) -> BodyId {
    add(world, fixed(0.0, -1.0, rectangle(400.0, 2.0)))
}

/// A pyramid of boxes of 1 m, its middle at x.
fn pyramid(world: &mut World, x: f64, rows: u32) -> Vec<BodyId> {
    let mut bodies = Vec::new();
    for row in 0..rows {
        for at in 0..rows - row {
            let x = x + f64::from(at) - f64::from(rows - row - 1) / 2.0;
            bodies.push(add(world, solid(x, 0.5 + f64::from(row), rectangle(0.99, 1.0))));
        }
    }
    bodies
}

/// What of a world moves and pushes, but for the tick.
fn state(world: &World) -> Vec<u64> {
    world.hash_parts().iter().filter(|part| part.name != "configuration").map(|part| part.hash).collect()
}

/// Runs until a tick changes nothing, and says how many that took.
#[track_caller]
fn until_still(world: &mut World, most: u64) -> u64 {
    let mut last = state(world);
    for tick in 1..=most {
        world.step();
        let now = state(world);
        if now == last {
            return tick;
        }
        last = now;
    }
    panic!("something moves after {most} ticks");
}

/// Steps both, one of which is watched, so that all of it is computed.
#[track_caller]
fn step_both(world: &mut World, watched: &mut World, what: impl Fn() -> String) {
    world.step();
    watched.step_watched(|_, _| {});
    if world.hash() != watched.hash() {
        panic!("{}: tick {}: {:?}", what(), world.tick(), world.diff(watched));
    }
    assert_eq!(world.events(), watched.events(), "{}: tick {}", what(), world.tick());
    assert_eq!(world.collisions(), watched.collisions(), "{}: tick {}", what(), world.tick());
}

#[test]
fn what_stands_comes_to_repose_and_stays_to_the_bit() {
    let mut world = world(0.0, -9.81);
    floor(&mut world);
    pyramid(&mut world, 0.0, 12);
    for row in 0..20 {
        add(&mut world, solid(30.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)));
    }
    add(&mut world, solid(40.0, 0.5, disc(0.5)));
    let ticks = until_still(&mut world, 600);
    assert!(ticks > 10, "it settles first");
    assert!(world.bodies().all(|body| body.velocity() == Vec2::default()));
    let now = state(&world);
    run(&mut world, 20_000);
    assert_eq!(state(&world), now, "for good");
}

#[test]
fn what_reposes_allocates_nothing() {
    let mut world = world(0.0, -9.81);
    floor(&mut world);
    pyramid(&mut world, 0.0, 10);
    until_still(&mut world, 600);
    run(&mut world, 2);
    assert_eq!(common::measure(|| run(&mut world, 100)).1, 0, "allocations");
}

/// Each disturbs a pyramid that reposes, or one beside it, in another way.
#[test]
fn what_is_disturbed_goes_on_as_if_all_had_been_computed() {
    type Disturb = fn(&mut World, &[BodyId], BodyId);
    let disturbances: [(&str, Disturb); 14] = [
        ("a ball falls on it", |world, _, _| {
            add(world, moving(solid(0.3, 9.0, disc(0.4)), 0.0, -12.0));
        }),
        ("a ball is thrown through two others at it", |world, _, _| {
            add(world, moving(solid(9.0, 0.5, disc(0.45)), 0.0, 0.0));
            add(world, moving(solid(10.0, 0.5, disc(0.45)), 0.0, 0.0));
            add(world, moving(solid(14.0, 0.5, disc(0.45)), -300.0, 0.0));
        }),
        ("one is pushed", |world, bodies, _| {
            let command = Command::ApplyImpulse { body: bodies[7], impulse: newton_seconds(900.0, 0.0), point: None };
            world.apply(command).expect("accepted");
        }),
        ("one is pushed so little that it stays", |world, bodies, _| {
            world
                .apply(Command::ApplyForce { body: bodies[0], force: newtons(3.0, 0.0), point: None })
                .expect("accepted");
        }),
        ("one is given a velocity of one unit", |world, bodies, _| {
            let velocity = Vec2::new(Velocity::from_bits(1), Velocity::ZERO);
            world.apply(Command::SetVelocity { body: bodies[0], velocity }).expect("accepted");
        }),
        ("one is taken away", |world, bodies, _| {
            world.apply(Command::DestroyBody { body: bodies[2] }).expect("accepted");
        }),
        ("the top is taken away", |world, bodies, _| {
            world.apply(Command::DestroyBody { body: *bodies.last().expect("some") }).expect("accepted");
        }),
        ("one becomes heavier", |world, bodies, _| {
            let mass = tamias2d::Mass::from_f64(3000.0).expect("in range");
            let inertia = tamias2d::Inertia::from_f64(500.0).expect("in range");
            world.apply(Command::SetMass { body: bodies[5], mass, inertia }).expect("accepted");
        }),
        ("the floor goes down", |world, _, floor| {
            world.apply(Command::SetPosition { body: floor, position: at(0.0, -1.01) }).expect("accepted");
        }),
        ("the floor goes away", |world, _, floor| {
            world.apply(Command::DestroyBody { body: floor }).expect("accepted");
        }),
        ("gravity turns", |world, _, _| {
            world.apply(Command::SetGravity { gravity: acc(6.0, -7.0) }).expect("accepted");
        }),
        ("a plough comes", |world, _, _| {
            let plough = BodyKind::Kinematic;
            let mut def = moving(solid(8.0, 0.6, rectangle(0.5, 1.0)), -2.0, 0.0);
            def.kind = plough;
            add(world, def);
        }),
        ("one meets nothing any more", |world, bodies, _| {
            let collider = world.body(bodies[1]).expect("it is").colliders().next().expect("one").id();
            let filter = tamias2d::Filter { category: 0, mask: 0 };
            world.apply(Command::SetFilter { collider, filter }).expect("accepted");
        }),
        ("the world is another one for a moment", |world, _, _| {
            let bytes = world.save();
            *world = World::load(&bytes).expect("a save");
        }),
    ];
    for (what, disturb) in disturbances {
        let mut world = world(0.0, -9.81);
        let floor = floor(&mut world);
        let bodies = pyramid(&mut world, 0.0, 5);
        pyramid(&mut world, -20.0, 4);
        until_still(&mut world, 600);
        run(&mut world, 3);
        let mut watched = world.clone();
        for tick in 0..240 {
            if tick == 3 {
                disturb(&mut world, &bodies, floor);
                disturb(&mut watched, &bodies, floor);
            }
            step_both(&mut world, &mut watched, || what.into());
        }
    }
}

/// What lies on something that stays is known to rows whether it is computed or not.
#[test]
fn what_comes_to_where_something_reposes_meets_what_it_would_have_met() {
    for (kind, restitution, speed) in [
        (BodyKind::Kinematic, 0.0, 0.5),
        (BodyKind::Kinematic, 0.0, 3.0),
        (BodyKind::Kinematic, 0.3, 1.5),
        (BodyKind::Static, 0.0, 0.5),
    ] {
        let mut world = world(0.0, -9.81);
        let mut platform = fixed(0.0, -1.0, rectangle(100.0, 2.0));
        platform.kind = kind;
        add(&mut world, platform);
        add(&mut world, solid(20.0, 0.5, rectangle(1.0, 1.0)));
        until_still(&mut world, 200);
        let mut watched = world.clone();
        for tick in 0..200 {
            if tick == 3 {
                for x in [0.0, 1.0] {
                    let mut def = moving(solid(x, 1.5, rectangle(1.0, 1.0)), 0.0, -speed);
                    def.colliders[0].restitution = tamias2d::Restitution::from_f64(restitution).expect("in range");
                    add(&mut world, def.clone());
                    add(&mut watched, def);
                }
            }
            step_both(&mut world, &mut watched, || format!("{kind:?}, {restitution}, {speed}"));
        }
    }
}

/// What is sent aside so far that it comes within the tick to what was left out: the tick is taken back. A ball is thrown through two
/// discs, of which the nearer one lies beside the stack.
#[test]
fn what_is_thrown_at_what_reposes_within_a_tick_meets_what_it_would_have_met() {
    for place in 0..40 {
        let mut world = world(0.0, -9.81);
        floor(&mut world);
        for row in 0..4 {
            add(&mut world, solid(0.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)));
        }
        for x in [1.5, 2.7] {
            add(&mut world, solid(x, 0.5, disc(0.45)));
        }
        until_still(&mut world, 300);
        add(&mut world, moving(solid(3.8 + f64::from(place) * 0.1, 0.5, disc(0.45)), -300.0, 0.0));
        let mut watched = world.clone();
        for _ in 0..5 {
            step_both(&mut world, &mut watched, || format!("from place {place}"));
        }
    }
}

/// Five boxes of 1 m, the one on top heavy; and a wall beside them, if there is to be one.
fn loaded_stack(top: f64, gap: Option<f64>) -> World {
    let mut world = world(0.0, -9.81);
    floor(&mut world);
    for row in 0..5 {
        let mass = if row == 4 { top } else { 1.0 };
        add(&mut world, weighing(solid(0.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)), mass));
    }
    if let Some(gap) = gap {
        add(&mut world, fixed(1.0 + gap, 2.5, rectangle(1.0, 5.0)));
    }
    world
}

/// Such stacks are solved directly.
#[test]
fn a_loaded_stack_rests() {
    for top in [100.0, 1000.0] {
        println!("{top} kg: {} ticks", until_still(&mut loaded_stack(top, None), 100));
        println!("{top} kg, a wall 3 cm beside it: {} ticks", until_still(&mut loaded_stack(top, Some(0.03)), 100));
    }
}

#[test]
#[ignore = "not held: moves after 3600 ticks, for what it does not touch is news in each: cargo test --release --test repose -- --ignored a_loaded_stack"]
fn a_loaded_stack_rests_beside_a_wall_that_it_does_not_touch() {
    for (top, gap) in [(100.0, 0.001), (100.0, 0.015), (1000.0, 0.005)] {
        until_still(&mut loaded_stack(top, Some(gap)), 3600);
    }
}

/// Who falls asleep does so in the same tick, however little quiet is.
#[test]
fn what_reposes_falls_asleep_as_if_it_had_been_computed() {
    for speed in ["0", "0.000001", "0.000003", "0.01"] {
        let speed = speed.parse().expect("in range");
        let sleeping = Some(tamias2d::Sleeping { speed, ..tamias2d::Sleeping::default() });
        let mut world =
            World::new(&WorldDef { gravity: acc(0.0, -1.0), tick_rate: 15, sleeping, ..WorldDef::default() })
                .expect("accepted");
        floor(&mut world);
        pyramid(&mut world, 0.0, 4);
        for row in 0..6 {
            add(&mut world, solid(20.0, 0.5 + f64::from(row), rectangle(1.0, 1.0)));
        }
        let mut watched = world.clone();
        for _ in 0..300 {
            step_both(&mut world, &mut watched, || format!("quiet up to {speed}"));
        }
    }
}

/// At few ticks a second gravity makes everything fast, and games command something in every tick.
#[test]
fn commands_elsewhere_and_coarse_ticks_leave_alone_what_reposes() {
    let gravity = acc(0.0, -9.81);
    let mut world = World::new(&WorldDef { gravity, tick_rate: 30, ..WorldDef::default() }).expect("accepted");
    floor(&mut world);
    pyramid(&mut world, 0.0, 8);
    let player = add(&mut world, moving(solid(60.0, 0.5, disc(0.5)), 1.0, 0.0));
    run(&mut world, 600);
    let mut watched = world.clone();
    for tick in 0..200 {
        let command = Command::SetForce { body: player, force: newtons(f64::from(tick % 3), 0.0) };
        world.apply(command.clone()).expect("accepted");
        watched.apply(command).expect("accepted");
        step_both(&mut world, &mut watched, || "a player far away".into());
    }
}

/// Where rows would put a body beyond the end of a range, but it reposes, nothing is limited, whether it is computed or known.
#[test]
fn what_reposes_at_the_end_of_a_range_is_not_limited() {
    for far in [false, true] {
        let mut world = world(0.0, -9.81);
        let x = if far { 1e9 } else { 0.0 };
        add(&mut world, fixed(x, -1.0, rectangle(1.0, 2.0)));
        let body = add(&mut world, solid(x, 0.5, rectangle(1.0, 1.0)));
        run(&mut world, 300);
        if !far {
            world.set_angle(body, Angle::from_bits(i64::MAX)).expect("accepted");
        }
        run(&mut world, 100);
        world.apply(Command::ClearStatus).expect("accepted");
        let mut watched = world.clone();
        for tick in 0..3 {
            step_both(&mut world, &mut watched, || format!("far {far}, tick {tick}"));
        }
        assert!(world.status().is_clear(), "{:?}", world.status());
    }
}

/// Which forces on a box on ice, and which slopes under a disc at rest, are below what contacts hold, and which are not.
#[test]
fn what_hardly_pushes_moves_nothing_and_what_pushes_more_does() {
    let rested = |rate: u32, collider: ColliderDef, friction: f64| {
        let gravity = acc(0.0, -10.0);
        let mut world = World::new(&WorldDef { gravity, tick_rate: rate, ..WorldDef::default() }).expect("accepted");
        add(&mut world, fixed(0.0, -0.5, surface(rectangle(100.0, 1.0), friction, 0.0)));
        let body = add(&mut world, solid(0.0, 0.5, surface(collider, friction, 0.0)));
        run(&mut world, u64::from(rate) * 5);
        (world, body)
    };
    let goes = |mut world: World, body: BodyId| {
        let (from, _) = position(&world, body);
        let second = u64::from(world.config().tick_rate);
        run(&mut world, 2 * second);
        position(&world, body).0 - from
    };
    for (rate, forces, degrees) in [
        (60, [9e-4, 1e-3], [0.008f64, 0.01]),
        (240, [3e-3, 4e-3], [0.03, 0.05]),
        (1000, [1.4e-2, 1.6e-2], [0.12, 0.15]),
    ] {
        for (moves, (force, degrees)) in forces.into_iter().zip(degrees).enumerate() {
            let (mut world, body) = rested(rate, rectangle(1.0, 1.0), 0.0);
            world.set_force(body, newtons(force, 0.0)).expect("accepted");
            let (way, free) = (goes(world, body), 2.0 * force * moves as f64);
            assert!((way - free).abs() <= 0.01 * free, "{force} N at {rate} ticks/s: {way} m of {free}");

            let (mut world, body) = rested(rate, disc(0.5), 0.5);
            let (sin, cos) = degrees.to_radians().sin_cos();
            world.set_gravity(acc(10.0 * sin, -10.0 * cos)).expect("accepted");
            let (way, free) = (goes(world, body), 2.0 * 10.0 * sin * 2.0 / 3.0 * moves as f64);
            assert!((way - free).abs() <= 0.1 * free, "{degrees} degrees at {rate} ticks/s: {way} m of {free}");
        }
    }
}

/// What touches only each other is held by nothing, however little pushes it.
#[test]
fn what_nothing_holds_goes_on() {
    for (rate, count, a) in [(60, 2, 8e-4), (240, 3, 3.3e-3), (1000, 2, 1.3e-2)] {
        let mut world = World::new(&WorldDef { tick_rate: rate, ..WorldDef::default() }).expect("accepted");
        let line =
            (0..count).map(|place| add(&mut world, solid(f64::from(place) * 0.999_99, 0.0, rectangle(1.0, 1.0))));
        let line: Vec<BodyId> = line.collect();
        run(&mut world, u64::from(rate));
        let (from, _) = position(&world, line[0]);
        world.set_force(line[0], newtons(f64::from(count) * a, 0.0)).expect("accepted");
        run(&mut world, u64::from(rate) * 10);
        let way = position(&world, line[0]).0 - from;
        assert!((way / (50.0 * a) - 1.0).abs() < 0.02, "{count} boxes at {rate} ticks/s went {way} m of {}", 50.0 * a);
    }
}

/// Nor by what stands but does not press it, and be it nearer than rows reach.
#[test]
fn what_stands_holds_only_what_is_pressed_to_it() {
    for (rate, a) in [(60, 8e-4), (240, 3e-3), (1000, 1.3e-2)] {
        let weightless = || World::new(&WorldDef { tick_rate: rate, ..WorldDef::default() }).expect("accepted");
        let ice = || surface(rectangle(1.0, 1.0), 0.0, 0.0);
        let seconds = |count: u32| u64::from(rate * count);
        let goes = |mut world: World, body: BodyId, what: &str| {
            let (_, from) = position(&world, body);
            run(&mut world, seconds(3));
            let way = position(&world, body).1 - from;
            assert!((way / (4.5 * a) - 1.0).abs() < 0.02, "{what}, {rate} ticks/s: {way} m of {}", 4.5 * a);
        };
        // Two boxes, one on the other, that lie beside one that stands.
        for gap in [0.001, 0.015] {
            let mut world = weightless();
            add(&mut world, fixed(0.0, -0.5, ice()));
            add(&mut world, solid(0.0, 0.5, ice()));
            let [upper, lower] = [0.75, -0.25].map(|y| add(&mut world, solid(1.0 + gap, y, ice())));
            run(&mut world, seconds(1));
            world.set_force(lower, newtons(0.0, 2.0 * a)).expect("accepted");
            goes(world, upper, &format!("{gap} m beside what stands"));
        }
        // Two boxes that press each other, on a floor that bears nothing: they lie in it by less than what rows leave alone.
        for (depth, press) in [(0.0, 0.01), (1e-5, 0.01), (5e-5, 0.01)] {
            let mut world = weightless();
            add(&mut world, fixed(0.5, depth - 0.5, rectangle(10.0, 1.0)));
            let both = [(0.0, press), (1.0, -press)].map(|(x, press)| (add(&mut world, solid(x, 0.5, ice())), press));
            let pull = |world: &mut World, up: f64| {
                for (body, press) in both {
                    world.set_force(body, newtons(press, up)).expect("accepted");
                }
            };
            pull(&mut world, 0.0);
            run(&mut world, seconds(1));
            pull(&mut world, a);
            goes(world, both[0].0, &format!("{depth} m in the floor"));
        }
    }
}

/// A force that changes by so little that it gives the same velocity, but another place, is another one.
#[test]
fn what_is_pushed_otherwise_is_computed_anew() {
    for gravity in [0.0, -10.0] {
        let mut world = world(0.0, gravity);
        add(&mut world, fixed(0.0, -0.5, surface(rectangle(100.0, 1.0), 0.0, 0.0)));
        let body = add(&mut world, solid(0.0, 0.5, surface(rectangle(1.0, 1.0), 0.0, 0.0)));
        run(&mut world, 100);
        // 8.4e-7 m/s² for a sixtieth of a second are half a unit of length; by units of the acceleration.
        for units in 235_929_500..235_929_700i128 {
            let mut twin = world.clone();
            let force = Vec2::new(Force::from_bits(units << 16), Force::ZERO);
            for world in [&mut world, &mut twin] {
                world.apply(Command::ApplyForce { body, force, point: None }).expect("accepted");
            }
            step_both(&mut world, &mut twin, || format!("gravity {gravity}, {units} units"));
        }
    }
}

/// A body that keeps a velocity with which it gets nowhere does not keep a stack beside it from repose.
#[test]
fn what_gets_nowhere_keeps_nobody_from_repose() {
    for (damping, speed) in [(1.0, 1e-3), (5.0, 1e-3), (0.0, 1e-9)] {
        let mut world = world(0.0, -10.0);
        floor(&mut world);
        let stack = (0..10).map(|at| add(&mut world, solid(0.0, 0.5 + f64::from(at), rectangle(1.0, 1.0))));
        let stack: Vec<BodyId> = stack.collect();
        let beside = solid(1.01, 2.0, surface(rectangle(1.0, 1.0), 0.0, 0.0));
        let linear_damping = num(&damping.to_string());
        let beside = add(&mut world, BodyDef { linear_damping, ..moving(weighing(beside, 1.0), 0.0, speed) });
        world.set_force(beside, newtons(0.0, 10.0)).expect("accepted");
        let moves = |world: &World, id: BodyId| !world.body(id).expect("it is there").velocity().is_zero();
        let tick = (0..3000).find(|_| {
            world.step();
            !moves(&world, stack[0]) && !moves(&world, stack[9])
        });
        assert!(tick.is_some(), "damping {damping}, {speed} m/s");
    }
}

/// Who sleeps between what is known and what is computed has rows with both.
#[test]
fn what_is_known_beside_who_sleeps_makes_no_difference() {
    let mut rng = Rng(3);
    let mut asleep = 0;
    for round in 0..200 {
        let sleeping = Some(Sleeping::default());
        let mut world = World::new(&WorldDef { substeps: 20, sleeping, ..WorldDef::default() }).expect("accepted");
        let mut ids = Vec::new();
        for column in 0..4 {
            for row in 0..3 {
                let collider = if rng.below(4) == 0 { disc(0.5) } else { rectangle(1.0, 1.0) };
                let def = solid(f64::from(column), 0.5 + 1.019 * f64::from(row), collider);
                ids.push(add(&mut world, weighing(def, [1.0, 10.0, 1e6][rng.below(3) as usize])));
            }
        }
        world.set_force(ids[6], newtons(-1e-3, 0.0)).expect("accepted");
        let mut watched = world.clone();
        for tick in 0..40 {
            if tick == 10 + round % 10 {
                for world in [&mut world, &mut watched] {
                    world.put_to_sleep(ids[10]).expect("accepted");
                }
            }
            step_both(&mut world, &mut watched, || format!("round {round}, tick {tick}"));
            asleep += usize::from(!world.body(ids[10]).expect("it is there").is_awake());
        }
    }
    assert!(asleep > 1000, "{asleep}");
}

/// Bodies side by side, with and without gaps, some of them fixed, that are pushed by next to nothing, put to sleep and woken: `seeds`
/// of them, for so many ticks.
fn grids(seeds: std::ops::Range<u64>, ticks: u64) {
    for seed in seeds {
        let mut rng = Rng(seed);
        let pick = |rng: &mut Rng, from: &[f64]| from[rng.below(from.len() as u64) as usize];
        let tick_rate = [15, 60, 240, 1000][rng.below(4) as usize];
        let gravity = acc(0.0, pick(&mut rng, &[0.0, 0.0, -0.01, -10.0]));
        let sleeping = (rng.below(3) > 0).then(Sleeping::default);
        let substeps = [4, 10, 20][rng.below(3) as usize];
        let def = WorldDef { tick_rate, substeps, gravity, sleeping, ..WorldDef::default() };
        let mut world = World::new(&def).expect("accepted");
        if rng.below(3) == 0 {
            floor(&mut world);
        }
        let [across, up] = [1; 2].map(|least| least + rng.below(4));
        let gaps = [pick(&mut rng, &[0.0, 1e-3, 0.019]), pick(&mut rng, &[0.0, 1e-3, 0.01, 0.019])];
        let mut ids = Vec::new();
        for at in 0..across * up {
            let [column, row] = [at % across, at / across].map(|at| at as f64);
            let collider = if rng.below(4) == 0 { disc(0.5) } else { rectangle(1.0, 1.0) };
            let collider = surface(collider, pick(&mut rng, &[0.0, 0.5]), 0.0);
            let def = solid((1.0 + gaps[0]) * column, 0.5 + (1.0 + gaps[1]) * row, collider);
            let (damping, mass) = (pick(&mut rng, &[0.0, 0.0, 1.0]), pick(&mut rng, &[1.0, 10.0, 1e6]));
            let def = if rng.below(10) == 0 {
                BodyDef { kind: BodyKind::Kinematic, ..def }
            } else {
                BodyDef { linear_damping: num(&damping.to_string()), ..weighing(def, mass) }
            };
            ids.push(add(&mut world, def));
        }
        let mut watched = world.clone();
        for tick in 0..ticks {
            if tick == 0 || rng.below(8) == 0 {
                let id = ids[rng.below(ids.len() as u64) as usize];
                let small = f64::powi(10.0, -1 - rng.below(7) as i32);
                let [x, y] = [1.0, 1.0].map(|one| one * small * pick(&mut rng, &[-1.0, 0.0, 1.0]));
                let kind = if tick == 0 { 3 } else { rng.below(8) };
                for world in [&mut world, &mut watched] {
                    let _refused_or_not = match kind {
                        0 => world.wake(id),
                        1 => world.clear_status(),
                        2 => world.set_velocity(id, Vec2::from_f64(x / 100.0, y / 100.0).expect("in range")),
                        3 => world.set_force(id, newtons(x, y)),
                        4 => world.apply_force(id, newtons(x, y), None),
                        _ => world.put_to_sleep(id),
                    };
                }
            }
            step_both(&mut world, &mut watched, || format!("grid {seed}, tick {tick}"));
        }
    }
}

#[test]
fn grids_go_on_as_if_all_had_been_computed() {
    grids(0..2000, 60);
}

/// Rooms in which something happens now and then: `seeds` of them, for so many ticks.
fn rooms(seeds: std::ops::Range<u64>, ticks: u64) {
    for seed in seeds {
        let (def, mut weather) = Weather::new(seed);
        let gravity = if seed % 4 == 3 { def.gravity } else { acc(0.0, -9.81) };
        let mut world = World::new(&WorldDef { gravity, ..def }).expect("accepted");
        for command in weather.begin() {
            let _refused_or_not = world.apply(command);
        }
        let mut watched = world.clone();
        let mut rng = Rng(seed);
        for _ in 0..ticks {
            if rng.below(100) == 0 {
                for command in weather.commands(&world) {
                    let _refused_or_not = (world.apply(command.clone()), watched.apply(command));
                }
            }
            step_both(&mut world, &mut watched, || format!("room {seed}"));
        }
        world.check().expect("every invariant holds");
    }
}

#[test]
fn rooms_go_on_as_if_all_had_been_computed() {
    rooms(0..24, 600);
}

#[test]
#[ignore = "minutes: cargo test --release --test repose -- --ignored many_rooms"]
fn many_rooms_and_grids_go_on_as_if_all_had_been_computed() {
    rooms(0..600, 3000);
    grids(600..20_000, 120);
}
