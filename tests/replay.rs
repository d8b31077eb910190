//! Replays: what is recorded plays, what is no replay is refused by place, and the file is as documented.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;
#[path = "common/forge.rs"]
mod forge;

use common::{Storm, acc, at, disc, measure, newton_seconds, newtons, num, run, vel, world};
use forge::Forge;
use proptest::prelude::{ProptestConfig, any, prop_assert_eq, proptest};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;
use tamias2d::replay::{Player, REPLAY_VERSION, Recorder, Recording, ReplayError, Summary, read_index};
use tamias2d::{
    Angle, Attractor, AttractorId, BodyDef, BodyId, BodyKind, ColliderId, Command, CommandError, Commands, DecodeError,
    Filter, LAW, Sleeping, Vec2, World, WorldDef,
};
use twox_hash::XxHash3_64;

#[global_allocator]
static ALLOCATOR: common::Counting = common::Counting;

/// Plays to the end.
fn verify(file: &[u8]) -> Result<Summary, ReplayError> {
    Player::new(file)?.verify()
}

/// The error that playing ends in.
#[track_caller]
fn error(file: &[u8]) -> ReplayError {
    verify(file).expect_err("it does not play")
}

/// A destination that others can look at while it is written to, and that can be full.
#[derive(Clone)]
struct Tape {
    bytes: Rc<RefCell<Vec<u8>>>,
    room: usize,
}

impl Tape {
    fn new(room: usize) -> Tape {
        Tape { bytes: Rc::default(), room }
    }

    fn len(&self) -> usize {
        self.bytes.borrow().len()
    }
}

impl Write for Tape {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut tape = self.bytes.borrow_mut();
        let taken = bytes.len().min(self.room - tape.len());
        if taken == 0 && !bytes.is_empty() {
            return Err(io::Error::new(io::ErrorKind::StorageFull, "the tape is full"));
        }
        tape.extend_from_slice(&bytes[..taken]);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A world with two bodies and a star.
fn start() -> World {
    start_of(world(0.0, -9.8))
}

/// The same, and bodies can sleep in it.
fn drowsy() -> World {
    let def = WorldDef { gravity: acc(0.0, -9.8), sleeping: Some(Sleeping::default()), ..WorldDef::default() };
    start_of(World::new(&def).expect("accepted"))
}

fn start_of(mut world: World) -> World {
    let gone = world.create_body(&BodyDef::default()).expect("accepted");
    for i in 0..2 {
        let colliders = vec![disc(0.75)];
        let def = BodyDef { position: at(f64::from(i), 0.0), velocity: vel(1.0, 2.0), colliders, ..BodyDef::default() };
        world.create_body(&def).expect("accepted");
    }
    world.destroy_body(gone).expect("accepted");
    world.create_attractor(Attractor { position: at(9.0, 9.0), mu: num("5") }).expect("accepted");
    world.step();
    world
}

const ONE: BodyId = BodyId { index: 1, generation: 0 };
const TWO: BodyId = BodyId { index: 2, generation: 0 };

/// A short recording: six ticks, two of them idle, with commands before the others and after the last.
/// Gives the bytes and how many there were after the world and after each tick.
fn short() -> (Vec<u8>, Vec<usize>) {
    let tape = Tape::new(usize::MAX);
    let mut game = Recorder::new(start(), tape.clone()).expect("it can be written");
    let mut ends = vec![tape.len()];
    for tick in 0..6u64 {
        match tick {
            0 => {
                game.apply_force(ONE, newtons(3.0, 4.0), Some(at(0.0, 1.0))).expect("accepted");
                game.input(b"jump".to_vec()).expect("accepted");
            }
            2 => drop(game.create_body(&BodyDef { mu: num("2"), ..BodyDef::default() }).expect("accepted")),
            3 => game.set_velocity(TWO, vel(0.5, -0.5)).expect("accepted"),
            5 => game.destroy_body(ONE).expect("accepted"),
            _ => {}
        }
        game.step();
        ends.push(tape.len());
    }
    game.set_user_data(TWO, 99).expect("accepted");
    drop(game.finish().expect("it can be written"));
    let bytes = tape.bytes.borrow().clone();
    (bytes, ends)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// What was recorded from any world on plays with the same hash at every tick.
    #[test]
    fn what_is_recorded_plays(seed in any::<u64>(), before in 0u64..20, ticks in 0u64..80, tail in 0u64..4) {
        let mut storm = Storm::solid(seed, 1e6);
        let mut world = world(0.0, -9.8);
        for _ in 0..before {
            storm.tick(&mut world, 3);
        }
        let mut game = Recorder::new(world, Vec::new()).expect("it can be written");
        let (mut hashes, mut accepted) = (Vec::new(), 0);
        let act = |game: &mut Recorder<Vec<u8>>, storm: &mut Storm| u64::from(storm.act(game).is_ok());
        for _ in 0..ticks {
            for _ in 0..storm.rng.below(4) {
                accepted += act(&mut game, &mut storm);
            }
            game.step();
            hashes.push(game.world().hash());
        }
        for _ in 0..tail {
            accepted += act(&mut game, &mut storm);
        }
        let hash = game.world().hash();
        let file = game.finish().expect("it can be written");

        let mut player = Player::new(file.as_slice()).expect("a replay");
        for want in hashes {
            prop_assert_eq!(player.step().expect("it plays"), Some(want));
            prop_assert_eq!(player.world().hash(), want);
        }
        prop_assert_eq!(player.step().expect("it plays"), None);
        prop_assert_eq!(player.step().expect("it has ended"), None);
        prop_assert_eq!(player.world().hash(), hash);
        let summary = Summary { ticks, commands: accepted, hash };
        prop_assert_eq!(verify(&file).expect("it plays"), summary);
        prop_assert_eq!(Player::new(file.as_slice()).expect("a replay").inspect().expect("whole").summary, summary);
    }
}

/// One command of each kind, in an order in which all are accepted.
fn one_of_each() -> Vec<Command> {
    let (body, id) = (ONE, AttractorId { index: 0, generation: 0 });
    let collider = ColliderId { index: 0, generation: 0 };
    let star = Attractor { position: at(7.0, 7.0), mu: num("3") };
    vec![
        Command::CreateBody { def: BodyDef { position: at(4.0, 4.0), user_data: 7, ..BodyDef::default() } },
        Command::SetPosition { body, position: at(1.0, -2.0) },
        Command::SetAngle { body, angle: Angle::from_bits(-77) },
        Command::SetVelocity { body, velocity: vel(3.0, -4.0) },
        Command::SetAngularVelocity { body, angular_velocity: num("-2.5") },
        Command::SetForce { body, force: newtons(1.0, -1.0) },
        Command::SetTorque { body, torque: num("-3") },
        Command::SetMass { body, mass: num("2.5"), inertia: num("7") },
        Command::SetDamping { body, linear: num("0.5"), angular: num("0.25") },
        Command::SetMu { body, mu: num("11") },
        Command::SetUserData { body, user_data: u64::MAX },
        Command::ApplyForce { body, force: newtons(5.0, 6.0), point: Some(at(1.0, 1.0)) },
        Command::ApplyForce { body, force: newtons(-5.0, 6.0), point: None },
        Command::ApplyTorque { body, torque: num("8") },
        Command::ApplyImpulse { body, impulse: newton_seconds(1.0, 2.0), point: Some(at(0.0, 1.0)) },
        Command::ApplyImpulse { body, impulse: newton_seconds(1.0, -2.0), point: None },
        Command::ApplyAngularImpulse { body, impulse: num("-9") },
        Command::SetAllowSleep { body: TWO, allow: false },
        Command::SetAllowSleep { body: TWO, allow: true },
        Command::PutToSleep { body },
        Command::Wake { body },
        Command::SetFixedRotation { body, fixed: true },
        Command::SetKind { body, kind: BodyKind::Kinematic },
        Command::CreateAttractor { attractor: star },
        Command::SetAttractor { id, attractor: star },
        Command::DestroyAttractor { id },
        Command::SetGravity { gravity: acc(1.0, 2.0) },
        Command::SetSurface { collider, restitution: num("0.5"), friction: num("0.25") },
        Command::SetFilter { collider, filter: Filter { category: 2, mask: 5 } },
        Command::ClearStatus,
        Command::Input { bytes: vec![1, 2, 3, 0, 255] },
        Command::Input { bytes: vec![] },
        Command::DestroyBody { body },
    ]
}

#[test]
fn no_command_is_missed() {
    let commands = one_of_each();
    let mut kinds: Vec<_> = Vec::new();
    for command in &commands {
        let kind = std::mem::discriminant(command);
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    assert_eq!(kinds.len(), 29, "every variant of `Command` is here");
    // Each before its own tick, and all before one.
    let mut game = Recorder::new(drowsy(), Vec::new()).expect("it can be written");
    for command in &commands {
        game.apply(command.clone()).expect("accepted");
        game.step();
    }
    let hash = game.world().hash();
    let file = game.finish().expect("it can be written");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    for command in &commands {
        player.step().expect("it plays").expect("a tick");
        assert_eq!(player.commands().collect::<Vec<_>>(), std::slice::from_ref(command));
    }
    assert_eq!(player.world().hash(), hash);
    let count = commands.len() as u64;
    assert_eq!(verify(&file).expect("it plays"), Summary { ticks: count, commands: count, hash });

    let mut game = Recorder::new(drowsy(), Vec::new()).expect("it can be written");
    for command in &commands {
        game.apply(command.clone()).expect("accepted");
    }
    game.step();
    let file = game.finish().expect("it can be written");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    player.step().expect("it plays");
    assert_eq!(player.commands().collect::<Vec<_>>(), commands);
    assert_eq!(player.step().expect("it plays"), None);
    assert_eq!(player.commands().count(), 0, "the end has no commands");
}

#[test]
fn the_methods_are_recorded_as_the_commands_are() {
    let (body, id) = (ONE, AttractorId { index: 0, generation: 0 });
    let collider = ColliderId { index: 0, generation: 0 };
    let star = Attractor { position: at(7.0, 7.0), mu: num("3") };
    let mut game = Recorder::new(drowsy(), Vec::new()).expect("it can be written");
    game.create_body(&BodyDef { position: at(4.0, 4.0), user_data: 7, ..BodyDef::default() }).expect("accepted");
    game.set_position(body, at(1.0, -2.0)).expect("accepted");
    game.set_angle(body, Angle::from_bits(-77)).expect("accepted");
    game.set_velocity(body, vel(3.0, -4.0)).expect("accepted");
    game.set_angular_velocity(body, num("-2.5")).expect("accepted");
    game.set_force(body, newtons(1.0, -1.0)).expect("accepted");
    game.set_torque(body, num("-3")).expect("accepted");
    game.set_mass(body, num("2.5"), num("7")).expect("accepted");
    game.set_damping(body, num("0.5"), num("0.25")).expect("accepted");
    game.set_mu(body, num("11")).expect("accepted");
    game.set_user_data(body, u64::MAX).expect("accepted");
    game.apply_force(body, newtons(5.0, 6.0), Some(at(1.0, 1.0))).expect("accepted");
    game.apply_force(body, newtons(-5.0, 6.0), None).expect("accepted");
    game.apply_torque(body, num("8")).expect("accepted");
    game.apply_impulse(body, newton_seconds(1.0, 2.0), Some(at(0.0, 1.0))).expect("accepted");
    game.apply_impulse(body, newton_seconds(1.0, -2.0), None).expect("accepted");
    game.apply_angular_impulse(body, num("-9")).expect("accepted");
    game.set_allow_sleep(TWO, false).expect("accepted");
    game.set_allow_sleep(TWO, true).expect("accepted");
    game.put_to_sleep(body).expect("accepted");
    game.wake(body).expect("accepted");
    game.set_fixed_rotation(body, true).expect("accepted");
    game.set_kind(body, BodyKind::Kinematic).expect("accepted");
    game.create_attractor(star).expect("accepted");
    game.set_attractor(id, star).expect("accepted");
    game.destroy_attractor(id).expect("accepted");
    game.set_gravity(acc(1.0, 2.0)).expect("accepted");
    game.set_surface(collider, num("0.5"), num("0.25")).expect("accepted");
    game.set_filter(collider, Filter { category: 2, mask: 5 }).expect("accepted");
    game.clear_status().expect("accepted");
    game.input(vec![1, 2, 3, 0, 255]).expect("accepted");
    game.input(vec![]).expect("accepted");
    game.destroy_body(body).expect("accepted");
    game.step();
    let file = game.finish().expect("it can be written");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    player.step().expect("it plays");
    assert_eq!(player.commands().collect::<Vec<_>>(), one_of_each());
}

#[test]
fn refused_commands_are_not_recorded() {
    let stale = BodyId { index: 9, generation: 0 };
    let mut game = Recorder::new(start(), Vec::new()).expect("it can be written");
    game.set_user_data(ONE, 5).expect("accepted");
    assert_eq!(game.destroy_body(stale), Err(CommandError::NoSuchBody(stale)));
    assert!(game.set_mass(ONE, tamias2d::Mass::ZERO, num("1")).is_err());
    assert!(game.input(vec![0; 65_537]).is_err());
    game.set_user_data(ONE, 6).expect("accepted");
    game.step();
    // A tick before which everything was refused is an idle one.
    assert!(game.destroy_body(stale).is_err());
    game.step();
    let file = game.finish().expect("it can be written");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    player.step().expect("it plays");
    let set = |user_data| Command::SetUserData { body: ONE, user_data };
    assert_eq!(player.commands().collect::<Vec<_>>(), [set(5), set(6)]);
    player.step().expect("it plays");
    assert_eq!(player.commands().count(), 0);
    assert_eq!(verify(&file).expect("it plays").commands, 2);
}

#[test]
fn input_comes_back_at_its_tick() {
    let mut game = Recorder::new(start(), Vec::new()).expect("it can be written");
    let input = |tick: u64| (0..tick * 37 % 200).map(|i| (i * tick) as u8).collect::<Vec<u8>>();
    for tick in 0..50 {
        if tick % 3 == 0 {
            game.input(input(tick)).expect("accepted");
        }
        game.step();
    }
    game.input(vec![7; 65_536]).expect("the longest that is accepted");
    game.step();
    let file = game.finish().expect("it can be written");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    for tick in 0..50 {
        player.step().expect("it plays").expect("a tick");
        if tick % 3 == 0 {
            assert_eq!(player.commands().collect::<Vec<_>>(), [Command::Input { bytes: input(tick) }]);
        } else {
            assert_eq!(player.commands().count(), 0);
        }
    }
    player.step().expect("it plays").expect("a tick");
    assert_eq!(player.commands().collect::<Vec<_>>(), [Command::Input { bytes: vec![7; 65_536] }]);
}

#[test]
fn input_is_not_state() {
    let mut one = start();
    let other = start();
    one.input(b"left".to_vec()).expect("accepted");
    assert_eq!(one.hash(), other.hash());
}

#[test]
fn commands_after_the_last_tick_are_played() {
    let (file, ends) = short();
    let summary = verify(&file).expect("it plays");
    assert_eq!((summary.ticks, summary.commands), (6, 6));
    let mut player = Player::new(file.as_slice()).expect("a replay");
    for _ in 0..6 {
        assert!(player.step().expect("it plays").is_some());
    }
    assert_eq!(player.world().body(TWO).expect("it exists").user_data(), 0);
    assert_eq!(player.step().expect("it plays"), None);
    assert_eq!(player.world().body(TWO).expect("it exists").user_data(), 99);
    assert_eq!(player.world().hash(), summary.hash);
    assert_eq!(player.world().tick(), 7, "one tick before the recording began");
    assert_eq!(ends.len(), 7);

    // And a recording of nothing but commands, or of nothing.
    for count in 0..3 {
        let mut game = Recorder::new(start(), Vec::new()).expect("it can be written");
        for user_data in 0..count {
            game.set_user_data(TWO, user_data).expect("accepted");
        }
        let hash = game.world().hash();
        let file = game.finish().expect("it can be written");
        assert_eq!(verify(&file).expect("it plays"), Summary { ticks: 0, commands: count, hash });
    }
}

#[test]
fn an_idle_tick_costs_nine_bytes() {
    let tape = Tape::new(usize::MAX);
    let mut game = Recorder::new(start(), tape.clone()).expect("it can be written");
    for _ in 0..10 {
        let before = tape.len();
        game.step();
        assert_eq!(tape.len() - before, 9);
    }
    let before = tape.len();
    drop(game.finish().expect("it can be written"));
    assert_eq!(tape.len() - before, 1 + 8 + 8 + 8);
}

#[test]
fn a_dropped_recorder_leaves_its_whole_ticks() {
    let tape = Tape::new(usize::MAX);
    let mut game = Recorder::new(start(), tape.clone()).expect("it can be written");
    for _ in 0..5 {
        game.set_user_data(ONE, 3).expect("accepted");
        game.step();
    }
    let hash = game.world().hash();
    game.set_user_data(ONE, 4).expect("accepted");
    drop(game);
    let file = tape.bytes.borrow().clone();
    let mut player = Player::new(file.as_slice()).expect("a replay");
    for _ in 0..5 {
        player.step().expect("it plays").expect("a tick");
    }
    assert_eq!(player.world().hash(), hash);
    let error = player.step().expect_err("there is no end");
    assert!(matches!(error, ReplayError::Truncated { ticks: 5, offset } if offset == file.len() as u64), "{error:?}");
    let offset = file.len();
    assert_eq!(error.to_string(), format!("replay truncated at byte {offset}, after 5 whole ticks"));
}

#[test]
fn every_truncation_names_the_whole_ticks() {
    let (file, ends) = short();
    println!("the short replay has {} bytes, {} of them before the first tick", file.len(), ends[0]);
    for length in 0..file.len() {
        let cut = &file[..length];
        let (result, _, largest) = measure(|| verify(cut));
        assert!(largest <= file.len().max(8192), "{length} bytes allocate {largest}");
        let error = result.expect_err("a truncated replay does not play to its end");
        let whole = ends.iter().filter(|&&end| end <= length).count().saturating_sub(1) as u64;
        match error {
            ReplayError::NotAReplay => assert_eq!(length, 0),
            ReplayError::Truncated { ticks, offset } => assert_eq!((ticks, offset), (whole, length as u64)),
            other => panic!("{length} bytes give {other:?}"),
        }
        if let Ok(player) = Player::new(cut) {
            let error = player.inspect().expect_err("it is cut off");
            assert!(matches!(error, ReplayError::Truncated { ticks, .. } if ticks == whole), "{error:?}");
        }
    }
}

#[test]
fn every_flipped_bit_is_found_at_its_place() {
    let (file, ends) = short();
    for at in 0..file.len() {
        for bit in 0..8 {
            let mut bytes = file.clone();
            bytes[at] ^= 1 << bit;
            let (result, _, largest) = measure(|| verify(&bytes));
            assert!(largest <= file.len().max(8192), "byte {at} bit {bit} allocates {largest}");
            let error = result.expect_err("a changed replay does not play");
            // The record in which it is, counted in ticks: what is before it has played.
            let tick = ends.iter().filter(|&&end| end <= at).count() as u64;
            match error {
                ReplayError::NotAReplay => assert!(at < 8),
                ReplayError::Version { known: REPLAY_VERSION, .. } => assert!((8..12).contains(&at)),
                ReplayError::Law { known: LAW, .. } => assert!((12..16).contains(&at)),
                ReplayError::Corrupt { tick: found, offset, .. } => {
                    assert_eq!(found, tick, "byte {at} bit {bit}");
                    assert!(offset <= file.len() as u64);
                }
                // A length that grew reaches beyond the end.
                ReplayError::Truncated { ticks, offset } => {
                    assert_eq!((ticks, offset), (tick.saturating_sub(1), file.len() as u64), "byte {at} bit {bit}");
                }
                other => panic!("byte {at} bit {bit} gives {other:?}"),
            }
        }
    }
}

#[test]
fn a_bit_flipped_in_the_header_or_the_end_is_named() {
    let (file, _) = short();
    let flipped = |at: usize| {
        let mut bytes = file.clone();
        bytes[at] ^= 1;
        error(&bytes).to_string()
    };
    let header = "replay corrupt at tick 0, byte 0: the header's hash does not fit it";
    assert_eq!(flipped(0), "not a tamias2d replay");
    assert_eq!(flipped(16), header);
    assert_eq!(flipped(20), header);
    assert_eq!(flipped(31), header);
    let end = file.len() - 25;
    let chain = format!("replay corrupt at tick 7, byte {end}: the end's chain is not that of the records");
    for at in [1, 9, 17, 24] {
        assert_eq!(flipped(end + at), chain);
    }
    assert_eq!(flipped(40), "replay corrupt at tick 0, byte 32: the record's check does not fit it");
}

#[test]
fn large_replays_are_read_in_bounded_memory() {
    let mut game = Recorder::new(start(), Vec::new()).expect("it can be written");
    for tick in 0..20 {
        game.input(vec![tick; 65_536]).expect("accepted");
        game.step();
    }
    let file = game.finish().expect("it can be written");
    let (summary, _, largest) = measure(|| verify(&file));
    assert_eq!(summary.expect("it plays").ticks, 20);
    assert!(largest <= 2 * 65_536, "{largest}");
    // A length that claims 4 GiB reserves at most an eighth more than what is there.
    let length = file.windows(4).position(|bytes| bytes == (8 + 1 + 4 + 65_536u32).to_le_bytes()).expect("a tick");
    let mut bytes = file.clone();
    bytes[length..length + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    let (result, _, largest) = measure(|| verify(&bytes));
    assert!(matches!(result, Err(ReplayError::Truncated { ticks: 0, .. })));
    println!("a claim of 4 GiB in a file of {} bytes: the largest allocation is {largest}", file.len());
    assert!(largest <= file.len() * 9 / 8 + 4096, "{largest} bytes for a file of {}", file.len());
}

#[test]
fn bytes_after_the_end_are_refused() {
    let (mut file, _) = short();
    let length = file.len() as u64;
    file.push(0);
    assert!(matches!(error(&file), ReplayError::Trailing { offset } if offset == length));
    assert_eq!(error(&file).to_string(), format!("unexpected bytes after the replay's end at byte {length}"));
    let (mut twice, again) = (short().0, short().0);
    twice.extend(again);
    assert!(matches!(error(&twice), ReplayError::Trailing { offset } if offset == length));
}

/// The command `SetUserData`: its tag 13, the body's index and generation, and the value.
fn set_user_data(body: BodyId, value: u64) -> Vec<u8> {
    let mut bytes = vec![13];
    bytes.extend(body.index.to_le_bytes());
    bytes.extend(body.generation.to_le_bytes());
    bytes.extend(value.to_le_bytes());
    bytes
}

/// The hashes after each of six ticks without commands.
fn idle_hashes() -> Vec<u64> {
    let mut world = start();
    (0..6)
        .map(|_| {
            world.step();
            world.hash()
        })
        .collect()
}

#[test]
fn the_format_is_as_documented() {
    // Written by hand, it is byte for byte what the recorder writes.
    let mut game = Recorder::new(start(), Vec::new()).expect("it can be written");
    let mut forge = Forge::new(60).world(game.world());
    game.step();
    forge = forge.idle(game.world().hash());
    game.set_user_data(TWO, 17).expect("accepted");
    game.set_user_data(ONE, 18).expect("accepted");
    game.step();
    let commands = [set_user_data(TWO, 17), set_user_data(ONE, 18)].concat();
    forge = forge.with_commands(0x03, game.world().hash(), &commands);
    game.step();
    forge = forge.idle(game.world().hash());
    game.set_user_data(TWO, 19).expect("accepted");
    forge = forge.with_commands(0x04, game.world().hash(), &set_user_data(TWO, 19));
    assert_eq!(game.finish().expect("it can be written"), forge.end(3));
    assert_eq!(REPLAY_VERSION, 3);
}

#[test]
fn a_divergence_is_named_at_its_tick() {
    let hashes = idle_hashes();
    for wrong in 0..6usize {
        let mut forge = Forge::new(60).world(&start());
        for (tick, &hash) in hashes.iter().enumerate() {
            forge = forge.idle(hash ^ u64::from(tick == wrong));
        }
        let file = forge.end(6);
        let error = error(&file);
        let computed = hashes[wrong];
        let recorded = computed ^ 1;
        let tick = wrong as u64 + 1;
        let ReplayError::Diverged { tick: t, recorded: r, computed: c } = error else { panic!("{error:?}") };
        assert_eq!((t, r, c), (tick, recorded, computed));
        assert_eq!(
            error.to_string(),
            format!("replay diverged at tick {tick}: hash {computed:016x}, recorded {recorded:016x}")
        );
        // The file itself is whole.
        assert_eq!(Player::new(file.as_slice()).expect("a replay").inspect().expect("it is whole").summary.ticks, 6);
    }
    // A tail that diverges is named at the last tick.
    let file = Forge::new(60).world(&start()).idle(hashes[0]).with_commands(0x04, 5, &set_user_data(TWO, 1)).end(1);
    assert!(matches!(error(&file), ReplayError::Diverged { tick: 1, recorded: 5, .. }));
}

#[test]
fn a_command_that_was_changed_with_its_checks_is_found_by_the_hash() {
    let mut world = start();
    world.set_user_data(TWO, 17).expect("accepted");
    world.step();
    let hash = world.hash();
    let file = |value| Forge::new(60).world(&start()).with_commands(0x03, hash, &set_user_data(TWO, value)).end(1);
    assert_eq!(verify(&file(17)).expect("it plays").hash, hash);
    assert!(matches!(error(&file(18)), ReplayError::Diverged { tick: 1, recorded, .. } if recorded == hash));
}

#[test]
fn a_command_that_is_refused_or_is_none_is_named() {
    let hash = idle_hashes()[0];
    let stale = BodyId { index: 0, generation: 0 };
    let commands = [set_user_data(TWO, 1), set_user_data(stale, 1)].concat();
    let file = Forge::new(60).world(&start()).idle(hash).with_commands(0x03, 0, &commands).end(2);
    let refused = error(&file);
    assert!(
        matches!(refused, ReplayError::Refused { tick: 2, index: 1, ref error } if **error == CommandError::NoSuchBody(stale))
    );
    assert_eq!(refused.to_string(), "replay diverged before tick 2: command 1 is refused, there is no body 0v0");

    let offset = (Forge::new(60).world(&start()).idle(hash).bytes.len()) as u64;
    for (commands, want) in [
        (vec![29], DecodeError::Invalid { offset: 8, field: "command", reason: "has an unknown tag" }),
        (vec![255], DecodeError::Invalid { offset: 8, field: "command", reason: "has an unknown tag" }),
        (set_user_data(TWO, 1)[..16].to_vec(), DecodeError::Truncated { offset: 17, field: "user_data" }),
    ] {
        let file = Forge::new(60).world(&start()).idle(hash).with_commands(0x03, 0, &commands).end(2);
        let found = error(&file);
        assert!(
            matches!(found, ReplayError::Decode { tick: 2, offset: o, error } if (o, error) == (offset, want)),
            "{found:?}"
        );
        assert_eq!(found.to_string(), format!("replay corrupt at tick 2, in the record at byte {offset}: {want}"));
    }
    // A tick's record without room for its hash.
    let file = Forge::new(60).world(&start()).record(0x03, &[1, 2, 3]).end(1);
    assert!(matches!(error(&file), ReplayError::Decode { tick: 1, error: DecodeError::Truncated { .. }, .. }));
}

#[test]
fn other_versions_laws_and_tick_rates_are_refused() {
    let file = |forge: Forge| forge.world(&start()).idle(idle_hashes()[0]).end(1);
    assert_eq!(verify(&file(Forge::new(60))).expect("it plays").ticks, 1);
    assert!(matches!(error(&file(Forge::of(1, LAW, 60, 0))), ReplayError::Version { found: 1, known: REPLAY_VERSION }));
    assert_eq!(
        error(&file(Forge::of(1, LAW, 60, 0))).to_string(),
        "replay of format version 1, this build reads version 3: record it anew, or play it with the build that made it"
    );
    assert!(matches!(error(&file(Forge::of(REPLAY_VERSION, LAW + 1, 60, 0))), ReplayError::Law { known: LAW, .. }));
    assert_eq!(
        error(&file(Forge::of(REPLAY_VERSION, 10, 60, 0))).to_string(),
        format!(
            "replay under arithmetic law 10, this build computes by law {LAW} and would play it differently: play it with a build \
             of law 10, or record it anew"
        )
    );
    assert_eq!(
        error(&file(Forge::new(61))).to_string(),
        "replay corrupt at tick 0, byte 32: its tick rate is not the header's"
    );
    assert!(matches!(
        error(&file(Forge::of(REPLAY_VERSION, LAW, 60, 1))),
        ReplayError::Corrupt { tick: 0, offset: 0, .. }
    ));
}

#[test]
fn ancillary_records_are_skipped_and_unknown_ones_refused() {
    let hashes = idle_hashes();
    let with = |tags: [u8; 3]| {
        let [before, between, last] = tags;
        Forge::new(60)
            .record(before, b"written by some tool")
            .world(&start())
            .idle(hashes[0])
            .record(between, b"")
            .idle(hashes[1])
            .record(last, &[0; 300])
            .end(2)
    };
    for tag in [0x84, 0x9c, 0xff] {
        assert_eq!(verify(&with([tag; 3])).expect("it plays"), Summary { ticks: 2, commands: 0, hash: hashes[1] });
    }
    for unknown in [0x00, 0x05, 0x0e, 0x10, 0x42, 0x7f] {
        for (place, tick) in [(0, 0), (1, 2), (2, 3)] {
            let mut tags = [0x84; 3];
            tags[place] = unknown;
            let found = error(&with(tags));
            let ReplayError::UnknownRecord { tick: at, offset, tag } = found else { panic!("{found:?}") };
            assert_eq!((at, tag), (tick, unknown));
            assert_eq!(with(tags)[offset as usize], unknown);
            assert_eq!(
                found.to_string(),
                format!("replay has a record of unknown kind {unknown:#04x} at tick {tick}, byte {offset}")
            );
        }
    }
}

#[test]
fn records_out_of_place_are_refused() {
    let (world, hashes) = (start(), idle_hashes());
    let corrupt = |file: &[u8]| match error(file) {
        ReplayError::Corrupt { tick, reason, .. } => (tick, reason),
        other => panic!("{other:?}"),
    };
    let begin = || Forge::new(60);
    assert_eq!(corrupt(&begin().idle(1).world(&world).end(1)), (0, "there is a tick before the world"));
    assert_eq!(corrupt(&begin().with_commands(0x03, 1, &[]).end(1)), (0, "there is a tick before the world"));
    assert_eq!(corrupt(&begin().with_commands(0x04, 1, &[]).end(1)), (0, "there is a tick before the world"));
    assert_eq!(corrupt(&begin().end(0)), (0, "there is no world"));
    assert_eq!(corrupt(&begin().world(&world).world(&world).end(0)), (1, "there is a second world"));
    assert_eq!(corrupt(&begin().world(&world).idle(hashes[0]).end(2)), (2, "the end counts other ticks"));
    assert_eq!(corrupt(&begin().world(&world).end(u64::MAX)), (1, "the end counts other ticks"));
    let tail = || begin().world(&world).idle(hashes[0]).with_commands(0x04, hashes[0], &[]);
    assert_eq!(verify(&tail().end(1)).expect("an empty tail plays").ticks, 1);
    assert_eq!(corrupt(&tail().idle(hashes[1]).end(2)), (2, "there is a tick after the tail"));
    assert_eq!(corrupt(&tail().with_commands(0x04, hashes[0], &[]).end(1)), (2, "there is a tick after the tail"));
    // A world that is none.
    let file = begin().record(0x01, b"no world").end(0);
    assert!(matches!(error(&file), ReplayError::Decode { tick: 0, offset: 32, error: DecodeError::NotASave }));
    // Records that were left out, doubled or moved, each with its own check.
    let records = |order: &[usize]| {
        let whole = begin().world(&world).idle(hashes[0]).idle(hashes[1]).idle(hashes[2]);
        let first = whole.bytes.len() - 3 * 9;
        let mut bytes = whole.bytes[..first].to_vec();
        for &at in order {
            bytes.extend(&whole.bytes[first + 9 * at..][..9]);
        }
        Forge { bytes, chain: whole.chain }.end(order.len() as u64)
    };
    assert_eq!(verify(&records(&[0, 1, 2])).expect("it plays").ticks, 3);
    // Idle ticks have no check of their own: the hash says where, and the next check that it is the file's fault.
    let check = "the end's chain is not that of the records";
    assert_eq!(corrupt(&records(&[1, 2])), (1, check));
    assert_eq!(corrupt(&records(&[0, 2])), (2, check));
    assert_eq!(corrupt(&records(&[0, 0, 1, 2])), (2, check));
    assert_eq!(corrupt(&records(&[1, 0, 2])), (1, check));
    assert_eq!(corrupt(&records(&[0, 1])), (3, check));
    // Where no check follows, nobody knows whose fault a hash is.
    let mut cut = records(&[1]);
    cut.truncate(cut.len() - 25);
    assert_eq!(corrupt(&cut), (1, "a hash differs, and the file ends before a check says whether it was recorded so"));
}

#[test]
fn a_full_disk_does_not_stop_the_simulation() {
    let play = |game: &mut Recorder<Tape>| {
        for user_data in 0..20 {
            if user_data % 3 == 0 {
                game.set_user_data(ONE, user_data).expect("accepted");
            }
            game.step();
        }
        game.world().hash()
    };
    let whole = Tape::new(usize::MAX);
    let mut game = Recorder::new(start(), whole.clone()).expect("it can be written");
    let before = whole.len();
    let hash = play(&mut game);
    assert!(game.error().is_none());
    drop(game.finish().expect("it can be written"));
    let file = whole.bytes.borrow().clone();

    for room in 0..file.len() {
        let tape = Tape::new(room);
        let Ok(mut game) = Recorder::new(start(), tape.clone()) else {
            assert!(room < before);
            continue;
        };
        assert!(room >= before);
        assert_eq!(play(&mut game), hash);
        assert_eq!(game.error().is_some(), room < file.len() - 25, "{room}");
        let Err(error) = game.finish() else { panic!("{room} bytes are not enough") };
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        // What is there is the beginning of the whole file, and plays as such.
        let tape = tape.bytes.borrow();
        assert_eq!(tape.as_slice(), &file[..room]);
        assert!(matches!(self::error(&tape), ReplayError::Truncated { .. }));
    }
}

#[test]
fn a_source_that_fails_is_an_error_of_reading() {
    struct Broken<'a>(&'a [u8], bool);
    impl io::Read for Broken<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.1 = !self.1;
            if self.1 {
                return Err(io::Error::new(io::ErrorKind::Interrupted, "again"));
            }
            if self.0.is_empty() {
                return Err(io::Error::other("the cable is out"));
            }
            // One byte at a time.
            buffer[0] = self.0[0];
            self.0 = &self.0[1..];
            Ok(1)
        }
    }
    let (file, ends) = short();
    let mut player = Player::new(Broken(&file[..ends[3] + 5], false)).expect("a replay");
    for _ in 0..3 {
        player.step().expect("it plays").expect("a tick");
    }
    let error = player.step().expect_err("the source fails");
    assert_eq!(error.to_string(), "cannot be read: the cable is out");
    // Slow sources are read to the end.
    struct Slow<'a>(&'a [u8]);
    impl io::Read for Slow<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(self.0.len()).min(3);
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }
    let slow = Player::new(Slow(&file)).expect("a replay").verify().expect("it plays");
    assert_eq!(slow, verify(&file).expect("it plays"));
}

#[test]
fn a_recorded_world_goes_on_as_one_that_is_not() {
    let config = WorldDef { tick_rate: 144, gravity: acc(0.0, -1.0), ..WorldDef::default() };
    let mut plain = World::new(&config).expect("accepted");
    let mut game = Recorder::new(plain.clone(), Vec::new()).expect("it can be written");
    let def = BodyDef { velocity: vel(1.0, 1.0), ..BodyDef::default() };
    let (a, b) = (plain.create_body(&def).expect("accepted"), game.create_body(&def).expect("accepted"));
    assert_eq!(a, b);
    for _ in 0..50 {
        plain.apply_impulse(a, newton_seconds(0.0, 0.01), Some(Vec2::default())).expect("accepted");
        game.apply_impulse(b, newton_seconds(0.0, 0.01), Some(Vec2::default())).expect("accepted");
        run(&mut plain, 1);
        game.step();
        assert_eq!(plain.hash(), game.world().hash());
    }
    assert_eq!(verify(&game.finish().expect("it can be written")).expect("it plays").hash, plain.hash());
}

/// A command may be one byte in the file and much more in memory.
#[test]
fn a_tick_of_very_many_commands_is_decoded_one_by_one() {
    let mut recorder = Recorder::new(World::new(&WorldDef::default()).expect("accepted"), Vec::new()).expect("memory");
    for _ in 0..100_000 {
        recorder.clear_status().expect("accepted");
    }
    recorder.step();
    let file = recorder.finish().expect("memory");
    let (result, _, largest) = measure(|| verify(&file));
    assert_eq!(result.expect("as recorded").commands, 100_000);
    assert!(largest <= file.len() * 9 / 8, "{largest} bytes for a file of {}", file.len());
    let player = Player::new(file.as_slice()).expect("as recorded");
    assert_eq!(player.inspect().expect("as recorded").summary.commands, 100_000);
}

/// A small recording with all that a recording can have: keyframes by whole saves and by reference, parts, evidence, an index.
fn rich() -> Vec<u8> {
    let mut world = World::new(&WorldDef { tick_rate: 15, ..WorldDef::default() }).expect("accepted");
    let body = world.create_body(&BodyDef { velocity: vel(1.0, 2.0), ..BodyDef::default() }).expect("accepted");
    let options = Recording { keyframe_seconds: 1, parts_ticks: 6, flight_ticks: 2 };
    let mut game = Recorder::with(world, Vec::new(), options).expect("it can be written");
    for tick in 1..=48 {
        if tick == 20 {
            game.set_user_data(body, 5).expect("accepted");
        }
        game.step();
        if tick == 33 {
            assert!(game.alarm(33) && !game.alarm(30));
        }
    }
    game.set_user_data(body, 6).expect("accepted");
    assert_eq!(game.fault(), None);
    game.finish().expect("it can be written")
}

#[test]
fn every_truncation_and_every_flipped_bit_of_keyframes_parts_and_evidence_is_detected() {
    let file = rich();
    let contents = Player::new(file.as_slice()).expect("a replay").inspect().expect("whole");
    assert_eq!((contents.keyframes.len(), contents.evidence), (3, 2));
    assert_eq!(verify(&file).expect("it plays"), contents.summary);
    println!("{} bytes", file.len());
    for length in 0..file.len() {
        let read = Player::new(&file[..length]).and_then(Player::inspect);
        assert!(read.is_err(), "cut at {length}");
    }
    let whole = |bytes: &[u8]| Player::new(bytes).and_then(Player::inspect).map(drop);
    let mut bytes = file.clone();
    for at in 0..file.len() {
        for bit in 0..8 {
            bytes[at] ^= 1 << bit;
            let (result, _, largest) = measure(|| whole(&bytes));
            assert!(result.is_err(), "byte {at} bit {bit}");
            assert!(largest <= file.len() * 2, "byte {at} bit {bit} allocates {largest}");
            if bit == at % 8 {
                assert!(verify(&bytes).is_err(), "byte {at} bit {bit}");
                // Random access: the index, and a keyframe that it names, are right or refused.
                let mut input = io::Cursor::new(bytes.as_slice());
                for keyframe in read_index(&mut input).unwrap_or_default() {
                    assert!(contents.keyframes.contains(&keyframe), "byte {at} bit {bit}");
                    if let Ok(player) = Player::at(io::Cursor::new(bytes.as_slice()), &keyframe) {
                        let sound = Player::at(io::Cursor::new(file.as_slice()), &keyframe).expect("a keyframe");
                        assert_eq!(player.world().hash(), sound.world().hash());
                    }
                }
            }
            bytes[at] ^= 1 << bit;
        }
    }
}

/// The same of a replay as it lies in the repository, the smallest one.
#[test]
fn every_truncation_and_every_flipped_bit_of_a_golden_is_detected() {
    let mut file = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/replays/tc11c.replay")).expect("a golden");
    assert_eq!(verify(&file).expect("it plays").ticks, 420);
    let whole = |bytes: &[u8]| Player::new(bytes).and_then(Player::inspect).map(drop);
    whole(&file).expect("it is whole");
    for length in 0..file.len() {
        assert!(whole(&file[..length]).is_err(), "cut at {length}");
    }
    for at in 0..file.len() {
        for bit in 0..8 {
            file[at] ^= 1 << bit;
            assert!(whole(&file).is_err(), "byte {at} bit {bit}");
            // Played as well, of each byte one.
            assert!(bit != at % 8 || verify(&file).is_err(), "byte {at} bit {bit} plays");
            file[at] ^= 1 << bit;
        }
    }
}

/// At 60 ticks a second and 100 bodies that do nothing, with parts and keyframes.
#[test]
fn an_idle_game_records_less_than_a_kilobyte_a_second() {
    let mut world = world(0.0, -9.8);
    world
        .create_body(&BodyDef {
            kind: BodyKind::Static,
            position: at(0.0, -1.0),
            colliders: vec![common::rectangle(200.0, 2.0)],
            ..BodyDef::default()
        })
        .expect("accepted");
    for i in 1..100 {
        // Stacks of four: each body touches two others.
        let position = at(f64::from(i / 4) * 3.0 - 40.0, f64::from(i % 4) + 0.5);
        world
            .create_body(&BodyDef { position, colliders: vec![common::rectangle(1.0, 1.0)], ..BodyDef::default() })
            .expect("accepted");
    }
    run(&mut world, 60);
    let tape = Tape::new(usize::MAX);
    let mut game = Recorder::new(world, tape.clone()).expect("it can be written");
    let before = tape.len();
    const SECONDS: usize = 120;
    for _ in 0..SECONDS * 60 {
        game.step();
    }
    let rate = (tape.len() - before) as f64 / SECONDS as f64;
    println!("{rate:.1} bytes a second");
    assert!(rate <= 1000.0, "{rate} bytes a second");
    drop(game.finish().expect("it can be written"));
    let file = tape.bytes.borrow().clone();
    assert_eq!(Player::new(file.as_slice()).expect("a replay").inspect().expect("whole").keyframes.len(), 2);
}

#[test]
fn keyframes_that_hold_another_world_are_found_by_playing() {
    // A keyframe of a world that was not played, in a file that is whole.
    let mut world = start();
    world.step();
    let first = world.hash();
    let mut other = world.clone();
    other.set_user_data(TWO, 77).expect("accepted");
    let keyframe = |forge: Forge, state: &World| {
        let history = XxHash3_64::oneshot_with_seed(start().hash(), &first.to_le_bytes());
        let (offset, chain) = (forge.bytes.len() as u64, forge.chain);
        let mut payload = Vec::new();
        for value in [1, 0, history, chain, offset] {
            payload.extend(value.to_le_bytes());
        }
        payload.extend(state.save());
        forge.record(0x80, &payload)
    };
    let file = |state: &World| keyframe(Forge::new(60).world(&start()).idle(first), state).end(1);
    assert_eq!(verify(&file(&world)).expect("it plays").ticks, 1);
    let found = error(&file(&other));
    assert!(matches!(found, ReplayError::DivergedKeyframe { tick: 1, .. }), "{found:?}");
    // Seeking goes by ticks: one of two behind a tick would not be found, nor one behind none.
    let twice = keyframe(keyframe(Forge::new(60).world(&start()).idle(first), &world), &world).end(1);
    let mut none = Forge::new(60).world(&start());
    let mut payload = Vec::new();
    for value in [0, 0, start().hash(), none.chain, none.bytes.len() as u64] {
        payload.extend(value.to_le_bytes());
    }
    payload.extend(start().save());
    none = none.record(0x80, &payload);
    for file in [twice, none.idle(first).end(1)] {
        let found = error(&file);
        assert!(
            matches!(found, ReplayError::Corrupt { .. }) && found.to_string().contains("two behind one"),
            "{found}"
        );
    }
    // Parts as well.
    let mut parts: Vec<u8> = world.hash_parts().iter().flat_map(|part| part.hash.to_le_bytes()).collect();
    let with_parts = |parts: &[u8]| Forge::new(60).world(&start()).idle(first).record(0x81, parts).end(1);
    assert_eq!(verify(&with_parts(&parts)).expect("it plays").ticks, 1);
    parts[8] ^= 1;
    assert!(matches!(error(&with_parts(&parts)), ReplayError::DivergedPart { tick: 1, part: "bodies", .. }));
}
