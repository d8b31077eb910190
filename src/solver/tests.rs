//! Lanes side by side against the definition, to the bit.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod astray;

use super::kernel::Kernel;
use super::mover::Mover;
use super::rows::{Block, LANES, Lane, Row};
use super::scales::Scales;
use crate::contact::Contact;
use crate::num::{lane, sin_cos};
use crate::{
    Acceleration, Angle, AngularVelocity, BodyDef, BodyKind, ColliderDef, Commands, Length, Shape, Vec2, World,
    WorldDef,
};

/// Numbers that follow from a seed: a linear congruential generator's upper bits (Knuth, MMIX).
pub(super) struct Dice(pub(super) u64);

impl Dice {
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 ^ self.0 >> 33
    }

    pub(super) fn one_in(&mut self, n: u64) -> bool {
        (self.bits() >> 20) % n == 0
    }

    /// Of `low ..= high`: an end, a power of two or one beside it, something of any order of magnitude, or anything.
    pub(super) fn within(&mut self, low: i64, high: i64) -> i64 {
        let any = (self.bits() as i64 >> (self.bits() >> 58)).clamp(low, high);
        match self.bits() >> 61 {
            0 => [low, high][usize::from(self.one_in(2))],
            1 => 0i64.clamp(low, high),
            3 => {
                let power = (1i64 << (self.bits() >> 58).min(58)) + (self.bits() >> 33) as i64 % 3 - 1;
                if self.one_in(2) { power.clamp(low, high) } else { (-power).clamp(low, high) }
            }
            2 => {
                let width = i128::from(high) - i128::from(low) + 1;
                (i128::from(low) + i128::from(self.bits()) % width) as i64
            }
            _ => any,
        }
    }

    fn lane(&mut self, low: i64, high: i64) -> Lane {
        [(); LANES].map(|()| self.within(low, high) as i32)
    }

    fn row(&mut self, impulse: [i64; 2]) -> Row {
        const ANY: i64 = (1 << 31) - 1;
        Row {
            arm: [self.lane(-ANY, ANY), self.lane(-ANY, ANY)],
            line: self.lane(0, 1 << 28),
            turn: [self.lane(-ANY, ANY), self.lane(-ANY, ANY)],
            impulse: self.lane(impulse[0], impulse[1]),
        }
    }

    fn mover(&mut self, fast: i64, d: i64) -> Mover {
        let mut v = || self.within(-fast, fast);
        let [x, y, w] = [v(), v(), v()];
        Mover { v: [x, y], w, phi: self.within(-d, d), d: [self.within(-d, d) as i32, self.within(-d, d) as i32] }
    }

    /// A block over movers of which the first does not move and the second goes its way whatever pushes it.
    fn block(&mut self, separation: i64) -> Block {
        let mut block = Block {
            friction: self.row([-(1 << 29), 1 << 29]),
            points: [self.row([0, 1 << 29]), self.row([0, 1 << 29])],
            limit: [self.lane(0, i32::MAX.into()), self.lane(0, i32::MAX.into())],
            separation: [self.lane(-separation, separation), self.lane(-separation, separation)],
            peak: [self.lane(0, 1 << 29), self.lane(0, 1 << 29)],
            couple: [(); 3].map(|()| self.lane(-(11 << 27), 11 << 27)),
            ..Block::default()
        };
        for i in 0..LANES {
            block.bodies = [[0, 1], [1, 0]].map(|side| {
                let mut bodies = block.bodies[side[0]];
                bodies[i] = 2 + 2 * i as u32 + side[0] as u32;
                bodies
            });
            let (sin, cos) = sin_cos(Angle::from_bits(self.bits() as i64 >> 16));
            let n = [cos, sin].map(|c| lane::round::<2>(c.into()) as i32);
            let n = if self.one_in(4) { [0, -(1 << 28)] } else { n };
            let share = self.within(0, 1 << 28);
            for (axis, n) in n.into_iter().enumerate() {
                block.normal[axis][i] = n;
                let part = |share: i64| ((i64::from(n) * share) >> 28) as i32;
                (block.reply[0][axis][i], block.reply[1][axis][i]) = (part(share), -part((1 << 28) - share));
            }
            if self.one_in(4) {
                block.separation[1][i] = i32::MAX;
            }
            match self.bits() >> 61 {
                0 => (block.bodies[0][i], block.bodies[1][i]) = (0, 0),
                side @ 1..=4 => {
                    // Against what impulses do not move.
                    let body = side as usize % 2;
                    block.bodies[body][i] = u32::from(side > 2);
                    block.reply[body].iter_mut().for_each(|reply| reply[i] = 0);
                    let rows = block.points.iter_mut().chain([&mut block.friction]);
                    rows.for_each(|row| row.turn[body][i] = 0);
                }
                _ => {}
            }
        }
        block
    }
}

/// Which of the paths that matter were gone.
#[derive(Debug, Default, PartialEq)]
struct Seen {
    blow: bool,
    push: bool,
    limited_velocity: bool,
    limited_impulse: bool,
    zero: bool,
}

fn compare<const BIASED: bool>(dice: &mut Dice, kernel: Kernel, scales: &Scales, seen: &mut Seen) {
    // Ordinary numbers, or the ends of what the formats hold.
    let (fast, far) = if dice.one_in(2) { (1 << 57, 1 << 30) } else { (1 << 50, 1 << 14) };
    let mut movers: Vec<Mover> = (0..2 + 2 * LANES).map(|_| dice.mover(fast, far)).collect();
    movers[0] = Mover::default();
    let mut block = dice.block(far);
    let (mut movers_2, mut block_2) = (movers.clone(), block.clone());
    block.warm_start(&mut movers);
    kernel.warm_start(&block, &mut movers_2);
    assert_eq!(movers, movers_2, "from {block:#?}");
    for _ in 0..3 {
        let lanes = if dice.one_in(2) { u8::MAX } else { dice.bits() as u8 };
        let before = block.clone();
        block.solve::<BIASED>(lanes, &mut movers, scales);
        kernel.solve::<BIASED>(&mut block_2, lanes, &mut movers_2, scales);
        assert_eq!(block, block_2, "from {before:#?}");
        assert_eq!(movers, movers_2);
        for (now, before) in block.points.iter().zip(&before.points) {
            for (now, before) in now.impulse.iter().zip(before.impulse) {
                seen.blow |= (now - before).abs() > 1 << 14;
                seen.limited_impulse |= *now == 1 << 29 && before != 1 << 29;
                seen.zero |= *now == 0 && before > 0;
            }
        }
        seen.push |= block.pushes != 0;
        seen.limited_velocity |= movers.iter().any(|mover| mover.v[0].abs() == 1 << 57);
    }
}

#[test]
fn lanes_side_by_side_are_the_definition() {
    for kernel in Kernel::all() {
        let mut dice = Dice(7);
        let mut seen = [Seen::default(), Seen::default()];
        for round in 0..20_000 {
            let scales = match round % 3 {
                0 => Scales::new(60, 10, 0),
                1 => Scales::new(1000, 64, 10),
                _ => Scales::new(15, 1, 3),
            };
            compare::<true>(&mut dice, kernel, &scales, &mut seen[0]);
            compare::<false>(&mut dice, kernel, &scales, &mut seen[1]);
        }
        let all = Seen { blow: true, push: true, limited_velocity: true, limited_impulse: true, zero: true };
        assert_eq!(seen, [Seen { ..all }, Seen { push: false, ..all }], "{kernel:?}");
    }
}

/// Boxes of 1 m on the ground, at places in centimetres, in worlds that are the same but for what solves their blocks.
fn same_with_and_without(places: impl Iterator<Item = (i64, i64)>) {
    let length = |cm: i64| Length::from_bits((cm << 32) / 100);
    let gravity = Vec2::new(Acceleration::ZERO, "-9.81".parse().unwrap());
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).unwrap();
    let mut create = |kind, (x, y), width| {
        let shape = Shape::Box { width: length(width), height: length(100) };
        let (position, colliders) = (Vec2::new(length(x), length(y)), vec![ColliderDef::new(shape)]);
        world.create_body(&BodyDef { kind, position, colliders, ..BodyDef::default() }).unwrap();
    };
    create(BodyKind::Static, (0, -50), 10_000);
    places.for_each(|at| create(BodyKind::Dynamic, at, 100));
    let mut worlds: Vec<World> = Kernel::all().map(|_| world.clone()).collect();
    worlds.iter_mut().zip(Kernel::all()).for_each(|(world, kernel)| world.solver.kernel = kernel);
    for tick in 0..150 {
        worlds.iter_mut().for_each(World::step);
        for world in &worlds {
            assert_eq!(world.hash(), worlds[0].hash(), "tick {tick}, {:?}", world.solver.kernel);
        }
    }
    assert!(matches!(worlds[0].solver.kernel, Kernel::Definition));
}

#[test]
fn a_pyramid_has_the_same_hashes_without_lanes() {
    same_with_and_without((0..12).flat_map(|row| (0..12 - row).map(move |i| (101 * i + 50 * row, 100 * row + 50))));
}

#[test]
fn a_pile_has_the_same_hashes_without_lanes() {
    same_with_and_without((0..60).map(|i| (i % 5 * 110 + i / 5 % 3 * 30, 200 + i / 5 * 140)));
}

/// Mass in the middle: its radius of gyration is 1/90 of its reach. Lanes have no numbers for how it turns, so its contacts are
/// left over for the definition, and are written all the same.
#[test]
fn a_box_that_lanes_have_no_numbers_for_rests_as_others_do() {
    let gravity = Vec2::new(Acceleration::ZERO, "-9.81".parse().unwrap());
    let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).unwrap();
    let side = |side: i64| Length::from_bits(side << 32);
    let shape = |width| vec![ColliderDef::new(Shape::Box { width: side(width), height: side(1) })];
    let at = |y: &str| Vec2::new(Length::ZERO, y.parse().unwrap());
    let floor = BodyDef { kind: BodyKind::Static, position: at("-0.5"), colliders: shape(9), ..BodyDef::default() };
    world.create_body(&floor).unwrap();
    let (mass, inertia) = (Some("1".parse().unwrap()), Some("0.00006".parse().unwrap()));
    let heavy = BodyDef { position: at("0.5"), mass, inertia, colliders: shape(1), ..BodyDef::default() };
    let heavy = world.create_body(&heavy).unwrap();
    assert!(world.solver.mobilities[heavy.index as usize].tau >> 31 != 0, "it is left over");
    let mut worlds: Vec<World> = Kernel::all().map(|_| world.clone()).collect();
    worlds.iter_mut().zip(Kernel::all()).for_each(|(world, kernel)| world.solver.kernel = kernel);
    for _ in 0..120 {
        worlds.iter_mut().for_each(World::step);
    }
    for world in &worlds {
        assert_eq!(world.hash(), worlds[0].hash(), "{:?}", world.solver.kernel);
        let place = world.body(heavy).unwrap().position();
        let sunk = (1i64 << 31) - place.y.to_bits();
        assert!(sunk.abs() < (1 << 32) / 100, "it is {sunk} units down, {:?}", world.solver.kernel);
    }
}

/// Without gravity, two boxes 1 cm apart, one of which turns: rows would not know of the corner that swings in, so there are none
/// once its rim is faster than 1 m/s. Under gravity there are, however it turns.
#[test]
fn what_turns_fast_across_a_gap_has_no_rows() {
    let has_row = |omega: &str, gravity: &str| {
        let gravity = Vec2::new(Acceleration::ZERO, gravity.parse().unwrap());
        let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() }).unwrap();
        let side = |side: i64| Length::from_bits(side << 32);
        let collider = |width| vec![ColliderDef::new(Shape::Box { width: side(width), height: side(1) })];
        let at = |y: &str| Vec2::new(Length::ZERO, y.parse().unwrap());
        let still = BodyDef { kind: BodyKind::Static, colliders: collider(9), ..BodyDef::default() };
        world.create_body(&still).unwrap();
        let angular_velocity = omega.parse().unwrap();
        let turning = BodyDef { position: at("1.01"), angular_velocity, colliders: collider(1), ..BodyDef::default() };
        world.create_body(&turning).unwrap();
        world.step();
        assert_eq!(world.touch.pairs.len(), 1, "they are near");
        world.touch.pairs[0].row != crate::contact::NEW
    };
    // Half a diagonal of 0.7071 m: 1 m/s at 1.4142 rad/s.
    for sign in ["", "-"] {
        assert!(!has_row(&format!("{sign}1.45"), "0"));
        assert!(has_row(&format!("{sign}1.40"), "0"));
        assert!(has_row(&format!("{sign}1.45"), "-0.1"));
    }
    assert!(has_row("0", "0"));
}

/// The speed and the overlap that these begin at are not yet of them.
#[test]
fn what_swings_and_what_is_hard_begins_beyond_a_limit() {
    let limit = Scales::new(60, 10, 0).swinging();
    // A disc of half a metre: its rim has that speed at twice as many radians a second.
    let has_row = |omega: i64| {
        let mut world = World::new(&WorldDef::default()).unwrap();
        let side = |side: i64| Length::from_bits(side << 32);
        let floor = vec![ColliderDef::new(Shape::Box { width: side(9), height: side(1) })];
        world.create_body(&BodyDef { kind: BodyKind::Static, colliders: floor, ..BodyDef::default() }).unwrap();
        let disc = vec![ColliderDef::new(Shape::Circle { radius: Length::from_bits(1 << 31) })];
        let position = Vec2::new(Length::ZERO, "1.01".parse().unwrap());
        let angular_velocity = AngularVelocity::from_bits(omega);
        world.create_body(&BodyDef { position, angular_velocity, colliders: disc, ..BodyDef::default() }).unwrap();
        world.step();
        assert_eq!(world.touch.pairs.len(), 1, "they are near");
        world.touch.pairs[0].row != crate::contact::NEW
    };
    assert_eq!([limit * 2, limit * 2 + 2].map(has_row), [true, false]);
    let scales = Scales::new(60, 10, 0);
    let hard = |overlap: i64| super::island::hard(overlap, &Contact::default(), &scales);
    assert_eq!([scales.deep, scales.deep + 1].map(hard), [false, true]);
}

/// A world whose units are 2^k times as large measures speeds in them.
#[test]
fn speeds_grow_with_the_unit() {
    let speeds = |k: u32| {
        let scales = Scales::new(60, 10, k);
        [scales.still(), scales.swinging(), scales.least_settled(), scales.least_strike(0, false, 0)]
    };
    for k in 1..=10 {
        assert_eq!(speeds(k), speeds(0).map(|speed| speed << k), "{k}");
    }
}

/// Where something may strike, it is kept where all bodies were when the tick began, for evidence to show.
#[test]
fn where_a_tick_began_is_kept_of_all_bodies() {
    let mut world = World::new(&WorldDef::default()).unwrap();
    for (x, vx) in [("0", "10"), ("1.01", "-10"), ("50", "3")] {
        let at = |x: &str| Vec2::new(x.parse().unwrap(), "0.25".parse().unwrap());
        let disc = vec![ColliderDef::new(Shape::Circle { radius: Length::from_bits(1 << 31) })];
        let velocity = Vec2::new(vx.parse().unwrap(), "0.5".parse().unwrap());
        world.create_body(&BodyDef { position: at(x), velocity, colliders: disc, ..BodyDef::default() }).unwrap();
    }
    let columns = |world: &World| {
        let bodies = &world.bodies;
        [bodies.x.bits(), bodies.y.bits(), bodies.vx.bits(), bodies.vy.bits()].map(<[i64]>::to_vec)
    };
    let before = columns(&world);
    world.step();
    assert_ne!(columns(&world), before);
    let kept: Vec<_> = world.solver.timeline.past.rows().map(|state| [state.x, state.v]).collect();
    let [x, y, vx, vy] = before;
    let expected: Vec<_> = (0..3).map(|slot| [[x[slot], y[slot]], [vx[slot], vy[slot]]]).collect();
    assert_eq!(kept, expected);
}
