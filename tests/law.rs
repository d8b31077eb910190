//! The arithmetic law by a second implementation, in plain Python integers (`tests/law`): kernels, goldens, and scenes
//! made of random numbers, whose every tick's hash Python has to find as well. What is rare is sought in scenes of its own,
//! and Python says whether it came to that.
//!
//! It needs `python3`. Without one these tests say so and hold nothing, but where `TAMIAS_PYTHON` is set (as `.ci/run`
//! does) they fail.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

#[path = "streams/play/draws.rs"]
#[allow(dead_code, reason = "not every quantity is drawn here")]
mod draws;
#[path = "common/trials.rs"]
mod trials;

use draws::Draws;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tamias2d::num::{cross, cross_wide, div, dot, hypot, mul, mul_add, mul_div, round_shift, sin_cos, sqrt};
use tamias2d::replay::{Player, Recorder};
use tamias2d::{
    Acceleration, Angle, AngularVelocity, BodyDef, BodyKind, ColliderDef, Commands, Friction, Impulse, Inertia, Length,
    Mass, Restitution, Shape, Vec2, Velocity, World, WorldDef,
};
use trials::Kind;

/// Runs a script of `tests/law` with arguments and input; it must end with status 0. What it says; none without Python.
fn python(script: &str, arguments: &[PathBuf], input: &str) -> Option<String> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/law").join(script);
    let mut command = Command::new("python3");
    command.arg(path).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => {
            assert!(std::env::var_os("TAMIAS_PYTHON").is_none(), "python3 does not start: {error}");
            // Not by a macro, whose words nobody sees of a test that passes.
            let _unseen = writeln!(std::io::stderr(), "NOT RUN, {script}: python3 does not start: {error}");
            return None;
        }
    };
    child.stdin.take().expect("piped").write_all(input.as_bytes()).expect("it reads all");
    let output = child.wait_with_output().expect("it ends");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    println!("{out}");
    assert!(output.status.success(), "{script}: {}\n{out}{err}{}", output.status, differences(&out));
    Some(out.into_owned())
}

/// Field by field, what the worlds that Python saved have instead of those of the same ticks here.
fn differences(out: &str) -> String {
    let mut text = String::new();
    for line in out.lines().filter_map(|line| line.strip_prefix("DIFFERS\t")) {
        let [replay, tick, save] = line.splitn(3, '\t').collect::<Vec<_>>()[..] else { continue };
        let replay = std::fs::read(replay).expect("the replay is there");
        let mut player = Player::new(&replay[..]).expect("a replay");
        for _ in 0..tick.parse().expect("a tick") {
            // The goldens may be of an older law: then these hashes differ as well.
            let _ = player.step();
        }
        match World::load(&std::fs::read(save).expect("the save is there")) {
            Ok(other) => {
                let found = player.world().diff(&other);
                text += &format!("here, and in Python, after tick {tick}:\n");
                found.iter().take(20).for_each(|difference| text += &format!("  {difference}\n"));
            }
            Err(error) => text += &format!("Python's world after tick {tick}: {error}\n"),
        }
    }
    text
}

/// Of any size up to 64 bits; the ends are frequent.
fn narrow(draws: &mut Draws) -> i64 {
    match draws.below(12) {
        0 => draws.pick(&[0, 1, -1, i64::MAX, -i64::MAX, i64::MIN]),
        _ => draws.bits() as i64 >> draws.below(64),
    }
}

/// Of any size up to 128 bits.
fn wide(draws: &mut Draws) -> i128 {
    match draws.below(12) {
        0 => draws.pick(&[0, 1, -1, i128::MAX, -i128::MAX, i128::MIN]),
        _ => (i128::from(draws.bits() as i64) << 64 | i128::from(draws.bits())) >> draws.below(128),
    }
}

#[test]
fn kernels_give_what_plain_integers_give() {
    let mut lines = String::new();
    let mut note = |line: String| {
        lines.push_str(&line);
        lines.push('\n');
    };
    let draws = &mut Draws::new(1);
    for _ in 0..2000 {
        let (a, b) = ([narrow(draws), narrow(draws)], [narrow(draws), narrow(draws)]);
        let shift = draws.between(1, 126) as u32;
        let (lift, zero) = (draws.between(0, 62) as u32, draws.between(0, 130) as u32);
        let (u, v) = ([wide(draws), wide(draws)], [wide(draws), wide(draws)]);
        let (square, wide_shift) = (wide(draws) as u128, draws.between(1, 127) as u32);
        let four = format!("{} {} {} {}", a[0], a[1], b[0], b[1]);
        let [cos, sin] = <[i32; 2]>::from(sin_cos(Angle::from_bits(a[0])));
        note(format!("round_shift {} {zero} = {}", u[0], round_shift(u[0], zero)));
        note(format!("mul {} {} {shift} = {}", a[0], b[0], mul(a[0], b[0], shift)));
        note(format!("mul_add {} {} {} {lift} {shift} = {}", a[0], b[0], b[1], mul_add(a[0], b[0], b[1], lift, shift)));
        note(format!("dot {four} {shift} = {}", dot(a, b, shift)));
        note(format!("cross {four} {shift} = {}", cross(a, b, shift)));
        let wide = cross_wide(u, v, wide_shift);
        note(format!("cross_wide {} {} {} {} {wide_shift} = {wide}", u[0], u[1], v[0], v[1]));
        note(format!("div {} {} = {}", u[0], v[0], div(u[0], v[0])));
        note(format!("mul_div {} {} {} = {}", u[0], u[1], v[0], mul_div(u[0], u[1], v[0])));
        note(format!("sqrt {square} = {}", sqrt(square)));
        note(format!("hypot {} {} = {}", a[0], a[1], hypot(a[0], a[1])));
        note(format!("sin_cos {} = {cos} {sin}", a[0]));
    }
    python("kernels.py", &[], &lines);
}

#[test]
fn goldens_play_alike_in_python() {
    if let Some(said) = python("run.py", &[], "") {
        assert!(said.contains("sleep: 720 ticks the same"), "{said}");
    }
}

/// A quantity with 32 or 48 fraction bits, of thousandths.
fn thousandths(value: i64, frac: u32) -> i64 {
    div(i128::from(value) << frac, 1000) as i64
}

fn length(value: i64) -> Length {
    Length::from_bits(thousandths(value, 32))
}

fn place(draws: &mut Draws, x: i64, low: i64, high: i64) -> Vec2<Length> {
    Vec2::new(length(draws.between(-x, x)), length(draws.between(low, high)))
}

fn shape(draws: &mut Draws) -> Shape {
    let (a, b) = (draws.between(200, 2000), draws.between(200, 2000));
    match draws.below(3) {
        0 => Shape::Circle { radius: length(a / 2) },
        1 => Shape::Box { width: length(a), height: length(b) },
        _ => {
            // Convex whatever the numbers.
            let corner = |x: i64, y: i64| Vec2::new(length(x), length(y));
            Shape::Polygon { vertices: vec![corner(-a, -b), corner(a, -b / 2), corner(a / 2, b), corner(-a / 2, b)] }
        }
    }
}

fn body(draws: &mut Draws) -> BodyDef {
    let fast = draws.pick(&[1000, 5000, 40_000]);
    let spin = [0, 1000, 20_000][draws.below(3) as usize];
    let mut speed = |most: i64| thousandths(draws.between(-most, most), 48);
    let velocity = Vec2::new(Velocity::from_bits(speed(fast)), Velocity::from_bits(speed(fast)));
    let angular_velocity = AngularVelocity::from_bits(speed(spin));
    let collider = ColliderDef {
        restitution: Restitution::from_bits(thousandths([0, 0, 300, 1000][draws.below(4) as usize], 48)),
        friction: Friction::from_bits(thousandths([0, 200, 600, 1500][draws.below(4) as usize], 48)),
        ..ColliderDef::new(shape(draws))
    };
    BodyDef {
        position: place(draws, 4000, 500, 6000),
        angle: Angle::from_bits(draws.between(0, 1 << 48)),
        velocity,
        angular_velocity,
        colliders: vec![collider],
        ..BodyDef::default()
    }
}

fn rate(draws: &mut Draws) -> u32 {
    [30, 60, 120][draws.below(3) as usize]
}

/// Without bodies, of some unit.
fn world(draws: &mut Draws, tick_rate: u32, gravity: i64) -> Recorder<Vec<u8>> {
    let def = WorldDef {
        tick_rate,
        unit_shift: draws.below(3) as u32,
        gravity: Vec2::new(Acceleration::ZERO, Acceleration::from_bits(thousandths(gravity, 48))),
        ..WorldDef::default()
    };
    Recorder::new(World::new(&def).expect("a world"), Vec::new()).expect("a recorder")
}

/// A box about (x, y) that stays where it is.
fn wall([x, y]: [i64; 2], [width, height]: [i64; 2]) -> BodyDef {
    let colliders = vec![ColliderDef::new(Shape::Box { width: length(width), height: length(height) })];
    BodyDef { kind: BodyKind::Static, position: Vec2::new(length(x), length(y)), colliders, ..BodyDef::default() }
}

/// A recorded world of a floor or none, one to four bodies that collide, and some impulses.
fn record(seed: u64) -> Vec<u8> {
    let draws = &mut Draws::new(seed);
    let gravity = [0, 0, -9_800][draws.below(3) as usize];
    let rate = rate(draws);
    let mut recorder = world(draws, rate, gravity);
    if draws.chance(70) {
        recorder.create_body(&wall([0, -1000], [40_000, 2000])).expect("a floor");
    }
    let ids: Vec<_> = (0..draws.between(1, 4)).map(|_| recorder.create_body(&body(draws)).expect("a body")).collect();
    for _ in 0..40 {
        if draws.chance(4) {
            let mut part = || Impulse::from_bits(div(i128::from(draws.between(-9, 9)) << 64, 2));
            let impulse = Vec2::new(part(), part());
            let id = ids[draws.below(ids.len() as u64) as usize];
            // Refused where it would make too small a body too fast; that is not recorded.
            let _ = recorder.apply_impulse(id, impulse, Some(place(draws, 4000, 0, 4000)));
        }
        recorder.step();
    }
    recorder.finish().expect("memory")
}

/// A recorded world in which a kinematic wall presses bodies against a static one until they have half the room that they
/// need, and goes back; some are under a lid, and what bounces strikes the others.
fn press(seed: u64) -> Vec<u8> {
    let draws = &mut Draws::new(seed);
    let rate = rate(draws);
    let mut recorder = world(draws, rate, -9_800);
    recorder.create_body(&wall([0, -1000], [40_000, 2000])).expect("a floor");
    recorder.create_body(&wall([5000, 2000], [1000, 6000])).expect("a wall");
    let rate = i64::from(rate);
    let way = |per_tick: i64| Vec2::new(Velocity::from_bits(thousandths(per_tick * rate, 48)), Velocity::ZERO);
    let kind = BodyKind::Kinematic;
    let press = recorder.create_body(&BodyDef { kind, velocity: way(60), ..wall([-1000, 2000], [1000, 5000]) });
    let press = press.expect("a wall");
    let lid = draws.chance(50);
    if lid {
        recorder.create_body(&wall([2000, 2100], [12_000, 1000])).expect("a lid");
    }
    for at in 0..4 {
        let shape = match draws.below(3) {
            0 => Shape::Circle { radius: length(draws.between(300, 500)) },
            1 => Shape::Box { width: length(draws.between(500, 1000)), height: length(draws.between(500, 1000)) },
            _ => Shape::Polygon {
                vertices: [[-500, -400], [500, -400], [0, 500]].map(|[x, y]| Vec2::new(length(x), length(y))).to_vec(),
            },
        };
        let friction = Friction::from_bits(thousandths([0, 600][draws.below(2) as usize], 48));
        let colliders = vec![ColliderDef { friction, ..ColliderDef::new(shape) }];
        let position = Vec2::new(length(200 + 1100 * at), length(draws.between(550, 900)));
        recorder.create_body(&BodyDef { position, colliders, ..BodyDef::default() }).expect("a body");
    }
    for tick in 0..90 {
        if tick == 55 && !lid {
            let restitution = Restitution::from_bits(thousandths(1000, 48));
            let shape = Shape::Circle { radius: length(200) };
            let colliders = vec![ColliderDef { restitution, ..ColliderDef::new(shape) }];
            let velocity = Vec2::new(Velocity::ZERO, Velocity::from_bits(thousandths(-1000 * rate, 48)));
            let position = Vec2::new(length(draws.between(2800, 4000)), length(4000));
            let angular_velocity = AngularVelocity::from_bits(thousandths(draws.between(-9000, 9000), 48));
            let ball = BodyDef { position, velocity, angular_velocity, colliders, ..BodyDef::default() };
            recorder.create_body(&ball).expect("a ball");
        }
        if tick == 60 {
            recorder.set_velocity(press, way(-60)).expect("accepted");
        }
        recorder.step();
    }
    recorder.finish().expect("memory")
}

/// A recorded world of a rough box on a slope.
fn lean(seed: u64) -> Vec<u8> {
    let draws = &mut Draws::new(seed);
    let rate = rate(draws);
    let mut recorder = world(draws, rate, -9_800);
    let angle = Angle::from_bits(draws.between(-12_000, 12_000) << 32);
    recorder.create_body(&BodyDef { angle, ..wall([0, 0], [20_000, 1000]) }).expect("a slope");
    let [cos, sin] = <[i32; 2]>::from(sin_cos(angle));
    let size = draws.between(400, 1200);
    let out = length(500 + size / 2).to_bits();
    let position =
        Vec2::new(Length::from_bits(mul(out, -i64::from(sin), 30)), Length::from_bits(mul(out, cos.into(), 30)));
    let shape = Shape::Box { width: length(size), height: length(size) };
    let friction = Friction::from_bits(thousandths(5000, 48));
    let colliders = vec![ColliderDef { friction, ..ColliderDef::new(shape) }];
    recorder.create_body(&BodyDef { position, angle, colliders, ..BodyDef::default() }).expect("a box");
    for _ in 0..120 {
        recorder.step();
    }
    recorder.finish().expect("memory")
}

/// A recorded world of a box on a thousandth of its mass, both some millimetres beside a wall: rows that push nothing, of an
/// island that is solved directly.
fn beside(seed: u64) -> Vec<u8> {
    let draws = &mut Draws::new(seed);
    let rate = rate(draws);
    let mut recorder = world(draws, rate, -9_800);
    recorder.create_body(&wall([0, -500], [20_000, 1000])).expect("a floor");
    recorder.create_body(&wall([1000 + draws.between(3, 12), 1000], [1000, 2000])).expect("a wall");
    for (y, mass) in [(500, 1000), (1500, 1_000_000)] {
        let shape = Shape::Box { width: length(1000), height: length(1000) };
        let position = Vec2::new(Length::ZERO, length(y));
        let mass = Some(Mass::from_bits(i128::from(mass) * (1i128 << 64) / 1000));
        let colliders = vec![ColliderDef::new(shape)];
        recorder.create_body(&BodyDef { position, mass, colliders, ..BodyDef::default() }).expect("a box");
    }
    for _ in 0..200 {
        recorder.step();
    }
    recorder.finish().expect("memory")
}

/// A recorded world of a wheel that is hard to turn, and of what bounces off it: what w weighs of that wheel is far more than
/// 64 bits hold.
fn wheel(seed: u64) -> Vec<u8> {
    let draws = &mut Draws::new(seed);
    let rate = rate(draws);
    let mut recorder = world(draws, rate, 0);
    let collider = |shape: Shape| ColliderDef {
        restitution: Restitution::from_bits(1 << 48),
        friction: Friction::from_bits(thousandths(950, 48)),
        ..ColliderDef::new(shape)
    };
    let inertia = 1i128 << draws.between(70, 110);
    let side = length(draws.between(800, 1600));
    let wheel = BodyDef {
        mass: Some(Mass::from_bits(1 << 64)),
        inertia: Some(Inertia::from_bits(inertia)),
        angular_velocity: AngularVelocity::from_bits(thousandths(draws.between(-40_000, 40_000), 48)),
        colliders: vec![collider(Shape::Box { width: side, height: length(600) })],
        ..BodyDef::default()
    };
    recorder.create_body(&wheel).expect("a wheel");
    for side in [-1, 1] {
        let speed = [-side * draws.between(2000, 9000), draws.between(-1000, 1000)];
        let speed = speed.map(|v| Velocity::from_bits(thousandths(v, 48)));
        let shape = shape(draws);
        let ball = BodyDef {
            position: Vec2::new(length(side * draws.between(2600, 4000)), length(draws.between(-400, 400))),
            velocity: Vec2::new(speed[0], speed[1]),
            colliders: vec![collider(shape)],
            ..BodyDef::default()
        };
        recorder.create_body(&ball).expect("a ball");
    }
    for _ in 0..60 {
        recorder.step();
    }
    recorder.finish().expect("memory")
}

/// Plays worlds made of these seeds here and there. What Python says.
fn compare(name: &str, seeds: std::ops::RangeInclusive<u64>, record: impl Fn(u64) -> Vec<u8>) -> Option<String> {
    let folder = std::env::temp_dir().join(format!("tamias2d-law-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let files: Vec<PathBuf> = seeds
        .map(|seed| {
            let path = folder.join(format!("{name}{seed}.replay"));
            std::fs::write(&path, record(seed)).expect("a file");
            path
        })
        .collect();
    let said = python("run.py", &files, "");
    if let Some(said) = &said {
        assert_eq!(said.matches(" ticks the same").count(), files.len(), "{said}");
    }
    // Kept where the test fails.
    std::fs::remove_dir_all(&folder).expect("the folder is there");
    said
}

#[test]
fn random_worlds_play_alike_in_python() {
    compare("random", 1..=16, record);
}

#[test]
fn what_is_squeezed_plays_alike_in_python() {
    if let Some(said) = compare("press", 1..=12, press) {
        assert!(said.contains(" held back") && said.contains(" struck while squeezed"), "not reached: {said}");
    }
}

#[test]
fn what_comes_to_repose_plays_alike_in_python() {
    if let Some(said) = compare("lean", 1..=8, lean) {
        assert!(said.contains(" in repose"), "not reached: {said}");
    }
}

#[test]
fn what_is_solved_directly_beside_a_wall_plays_alike_in_python() {
    compare("beside", 1..=3, beside);
}

#[test]
fn what_is_hard_to_turn_plays_alike_in_python() {
    compare("wheel", 1..=8, wheel);
}

/// The worlds of `pins.rs`, among them what is hostile.
#[test]
fn trials_play_alike_in_python() {
    let all = [
        (Kind::Cradle, 0..=7),
        (Kind::Cradle, 1067..=1067),
        (Kind::Row, 2..=3),
        (Kind::Crowd, 1..=3),
        // Something here creeps, or lies, beside what stands and is not pressed to it; in that cradle, too.
        (Kind::Crowd, 142..=142),
        (Kind::Crowd, 703..=703),
        (Kind::Crowd, 1895..=1895),
        (Kind::Wild, 0..=13),
    ];
    for (kind, seeds) in all {
        compare(kind.name(), seeds, |seed| trials::record(kind, seed));
    }
}
