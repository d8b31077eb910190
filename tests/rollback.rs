//! Frames and the ring of them: a world that is rolled back and simulated anew is the one that never was.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{Rng, Storm, acc, at, disc, measure, newtons, num, rectangle, vel, world};
use proptest::prelude::{ProptestConfig, any, proptest};
use std::collections::BTreeMap;
use std::path::Path;
use tamias2d::replay::Player;
use tamias2d::{
    Attractor, BodyDef, BodyId, BodyKind, Command, Commands, DecodeError, EventId, EventLog, Frame, FrameError, LAW,
    Reply, Rollback, RollbackError, SAVE_VERSION, Sleeping, World, WorldDef,
};

#[global_allocator]
static ALLOCATOR: common::Counting = common::Counting;

/// So far a rollback goes.
const DEPTH: u64 = 16;

/// The world with which a recording begins, and the commands of each tick.
fn recorded(name: &str) -> (World, Vec<Vec<Command>>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("replays").join(format!("{name}.replay"));
    let bytes = std::fs::read(path).expect("a recording");
    let mut player = Player::new(bytes.as_slice()).expect("it opens");
    let world = player.world().clone();
    let mut ticks = Vec::new();
    while player.step().expect("it plays").is_some() {
        ticks.push(player.commands().collect());
    }
    (world, ticks)
}

/// A command that nobody gave, on what there is in a world.
fn wrong(world: &World, storm: &mut Storm) -> Command {
    let count = u64::from(world.body_count());
    let at = storm.rng.below(count.max(1)) as usize;
    let Some(body) = world.bodies().nth(at).map(|body| body.id()) else { return storm.command() };
    match storm.rng.below(12) {
        0 => Command::PutToSleep { body },
        1 => Command::Wake { body },
        2 => Command::SetAllowSleep { body, allow: storm.rng.below(2) == 0 },
        3 | 4 => Command::DestroyBody { body },
        5 => Command::SetPosition { body, position: at_random(&mut storm.rng, storm.reach) },
        _ => {
            let _known = storm.heed(Ok(Reply::Body(body)));
            storm.command()
        }
    }
}

/// Some of them may be refused, always the same.
fn give(world: &mut World, commands: &[Command]) {
    for command in commands {
        let _refused_or_not = world.apply(command.clone());
    }
}

fn at_random(rng: &mut Rng, reach: f64) -> tamias2d::Vec2<tamias2d::Length> {
    at(rng.signed(1e-2, reach), rng.signed(1e-2, reach))
}

/// Two worlds that get the same commands; one is rolled back on the way, and has wrong futures.
struct Pair {
    plain: World,
    rolled: World,
    ring: Rollback,
    /// The commands of each tick so far, and the hash before them.
    past: Vec<(Vec<Command>, u64)>,
    start: u64,
    rng: Rng,
}

impl Pair {
    fn new(world: World, seed: u64) -> Pair {
        let (plain, start) = (world.clone(), world.tick());
        let ring = Rollback::new(DEPTH as u32 + 1);
        Pair { plain, rolled: world, ring, past: Vec::new(), start, rng: Rng(seed) }
    }

    fn tick(&mut self, commands: Vec<Command>) {
        self.past.push((commands, self.plain.hash()));
        let (commands, _) = self.past.last().expect("just pushed");
        give(&mut self.plain, commands);
        self.plain.step();
        self.resimulate();
    }

    /// From where the rolled world is to where the plain one is.
    fn resimulate(&mut self) {
        while self.rolled.tick() < self.plain.tick() {
            let (commands, hash) = &self.past[(self.rolled.tick() - self.start) as usize];
            assert_eq!(self.rolled.hash(), *hash, "tick {}", self.rolled.tick());
            self.ring.save(&self.rolled);
            assert_eq!(self.ring.frame(self.rolled.tick()).expect("held").hash(), *hash);
            give(&mut self.rolled, commands);
            self.rolled.step();
        }
    }

    /// A wrong future, and back from it, to before the present.
    fn roll_back(&mut self) {
        let depth = 1 + self.rng.below(DEPTH);
        let ahead = self.rng.below(depth + 1);
        let mut storm = Storm::solid(self.rng.bits(), 20.0);
        for _ in 0..ahead {
            self.ring.save(&self.rolled);
            for _ in 0..self.rng.below(4) {
                let _refused_or_not = self.rolled.apply(wrong(&self.rolled, &mut storm));
            }
            self.rolled.step();
        }
        let target = (self.rolled.tick() - depth.min(self.rolled.tick())).max(self.start).max(self.oldest());
        if target == self.rolled.tick() {
            return;
        }
        let sent = (self.rng.below(4) == 0).then(|| self.send(target));
        self.ring.restore(&mut self.rolled, target).expect("it is held");
        assert_eq!(self.rolled.check(), Ok(()), "back at tick {target}");
        if let Some(sent) = sent.flatten() {
            assert!(sent == self.rolled.save(), "a frame from bytes is another at tick {target}");
        }
        if self.rng.below(4) == 0 {
            // A twin that was saved here goes on as it did.
            let mut twin = World::load(&self.rolled.save()).expect("just saved");
            for at in target..self.plain.tick() {
                let (commands, hash) = &self.past[(at - self.start) as usize];
                assert_eq!(twin.hash(), *hash, "the twin at tick {at}");
                give(&mut twin, commands);
                twin.step();
            }
        }
        let told = self.rolled.tick() < self.plain.tick();
        self.resimulate();
        self.compare();
        if told {
            assert_eq!(self.rolled.events(), self.plain.events());
            assert_eq!(self.rolled.collisions(), self.plain.collisions());
        }
    }

    /// What a copy of the world is after it got a frame as bytes, if its tables are still those of the frame.
    fn send(&self, tick: u64) -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        self.ring.frame(tick).expect("it is held").encode_into(&mut bytes);
        let frame = Frame::decode(&bytes).expect("just encoded");
        let mut other = self.rolled.clone();
        match other.restore_frame(&frame) {
            Ok(()) => {
                assert_eq!((other.hash(), other.check()), (frame.hash(), Ok(())));
                Some(other.save())
            }
            Err(error) => {
                assert!(matches!(error, FrameError::Tables { .. }), "{error}");
                assert!(other.save() == self.rolled.save(), "a refused frame changed the world");
                None
            }
        }
    }

    fn oldest(&self) -> u64 {
        self.ring.oldest().unwrap_or(self.rolled.tick())
    }

    fn compare(&self) {
        assert_eq!(self.rolled.hash(), self.plain.hash(), "{:?}", self.rolled.diff(&self.plain).first());
        assert_eq!(self.rolled.check(), Ok(()));
        assert!(self.rolled.save() == self.plain.save(), "saves differ at tick {}", self.plain.tick());
    }
}

/// Plays a recording with rollbacks: one in every `seldom` ticks.
fn play(name: &str, seldom: u64) {
    let (world, ticks) = recorded(name);
    let mut pair = Pair::new(world, 7);
    for commands in ticks {
        pair.tick(commands);
        if pair.rng.below(seldom) == 0 {
            pair.roll_back();
        }
    }
    pair.compare();
}

macro_rules! goldens {
    ($($test:ident: $($name:literal)*;)*) => {$(
        #[test]
        fn $test() {
            $( play($name, 12); )*
        }
    )*};
}

goldens! {
    free_bodies_roll_back: "free_flight" "spin" "orbit";
    everything_rolls_back: "everything" "churn" "sensors";
    collisions_roll_back: "tc10c" "tc11c" "bouncers" "pixels";
    piles_roll_back: "pyramid55" "pusher";
    a_drum_rolls_back: "tumbler";
    a_heap_rolls_back: "pile300";
    sleepers_roll_back: "sleep";
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Random commands of all kinds, with sleeping and without.
    #[test]
    fn storms_roll_back(seed in any::<u64>(), sleeping in any::<bool>(), crowd in 0u64..3) {
        let sleeping = sleeping.then(Sleeping::default);
        let world = World::new(&WorldDef { gravity: acc(0.0, -9.81), sleeping, ..WorldDef::default() }).expect("accepted");
        let mut storm = Storm::solid(seed, 20.0);
        let mut pair = Pair::new(world, seed ^ 1);
        for tick in 0..120u64 {
            // Then it becomes quiet, so that something sleeps.
            let count = if tick < 60 { storm.rng.below(1 << crowd) } else { storm.rng.below(12) / 10 };
            let commands = (0..count).map(|_| wrong(&pair.plain, &mut storm)).collect();
            pair.tick(commands);
            if pair.rng.below(6) == 0 {
                pair.roll_back();
            }
        }
        pair.compare();
    }
}

/// A body of one collider.
fn solid(x: f64, y: f64, collider: tamias2d::ColliderDef) -> BodyDef {
    BodyDef { position: at(x, y), colliders: vec![collider], ..BodyDef::default() }
}

fn fixed(x: f64, y: f64, collider: tamias2d::ColliderDef) -> BodyDef {
    BodyDef { kind: BodyKind::Static, ..solid(x, y, collider) }
}

/// A pyramid of boxes of 1 m that has settled, `gap` apart.
fn pyramid(rows: u32, gap: f64, sleeping: Option<Sleeping>) -> World {
    let def = WorldDef { gravity: acc(0.0, -9.81), sleeping, ..WorldDef::default() };
    let mut world = World::new(&def).expect("accepted");
    world.create_body(&fixed(0.0, -0.5, rectangle(1000.0, 1.0))).expect("accepted");
    for row in 0..rows {
        for i in 0..rows - row {
            let x = gap * (f64::from(i) - f64::from(rows - row) / 2.0);
            world.create_body(&solid(x, f64::from(row) + 0.5, rectangle(1.0, 1.0))).expect("accepted");
        }
    }
    common::run(&mut world, 120);
    world
}

#[test]
fn snapshots_of_a_pyramid_of_820_boxes_are_small() {
    for gap in [1.0, 1.01] {
        for sleeping in [None, Some(Sleeping::default())] {
            let mut world = pyramid(40, gap, sleeping);
            let mut frame = Frame::default();
            world.save_frame(&mut frame);
            let mut bytes = Vec::new();
            frame.encode_into(&mut bytes);
            let each = |bytes: usize| bytes as f64 / f64::from(world.body_count());
            let [here, there, save] = [frame.memory(), bytes.len(), world.save().len()].map(each);
            println!("{gap} m apart: a frame {here:.1} B a body, {there:.1} encoded; a save {save:.1}");
            assert!(here <= 250.0 && there <= 250.0 && save <= 400.0);
            // Place, angle and velocities alone are as many.
            assert!(here >= 48.0);
            // What no tick changes is held once, by whichever frame comes first.
            let mut ring = Rollback::new(2);
            let (_, _, first) = measure(|| ring.save(&world));
            world.step();
            let (_, _, second) = measure(|| ring.save(&world));
            assert!(second < first, "{first} B, then {second} B at once");
        }
    }
}

#[test]
fn a_ring_that_has_gone_round_allocates_nothing() {
    let mut world = pyramid(6, 1.0, Some(Sleeping::default()));
    world.create_body(&fixed(9.0, 1.0, disc(0.5))).expect("accepted");
    let (mut ring, mut log) = (Rollback::new(9), EventLog::new(9));
    let mut shots: Vec<BodyId> = Vec::with_capacity(64);
    let mut told = 0;
    let (mut saves, mut restores, mut tells) = (0, 0, 0);
    // Shoots, takes away what was shot before, pushes, changes a surface; back by up to 8 ticks now and then, with other shots after that.
    for tick in 0..2400u32 {
        let warm = tick >= 1800;
        let (_, count, _) = measure(|| ring.save(&world));
        saves += if warm { count } else { 0 };
        if tick % 3 == 0 {
            let shot =
                BodyDef { user_data: 1 + world.tick(), velocity: vel(-5.0, 3.0), ..solid(-20.0, 0.6, disc(0.3)) };
            shots.push(world.create_body(&shot).expect("accepted"));
            world.apply_force(*shots.last().expect("just shot"), newtons(1.0, 2.0), None).expect("accepted");
        }
        if shots.len() > 5 {
            world.destroy_body(shots.remove(0)).expect("it is there");
        }
        world.step();
        let (count, allocated, _) = measure(|| {
            let told = log.tell(&world);
            told.events.new.len() + told.collisions.new.len() + told.events.confirmed.len()
        });
        told += count;
        tells += if warm { allocated } else { 0 };
        if tick % 7 == 6 {
            let back = world.tick() - 1 - u64::from(tick) % 8;
            let (result, count, _) = measure(|| ring.restore(&mut world, back));
            result.expect("it is held");
            // Those taken away since are back, too.
            shots.clear();
            shots.extend(world.bodies().filter(|body| body.user_data() > 0).map(|body| body.id()));
            shots.sort_by_key(|&id| world.body(id).expect("it is there").user_data());
            restores += if warm { count } else { 0 };
            world.check().expect("every invariant holds");
        }
    }
    assert!(told > 100, "{told} things happened");
    assert_eq!((saves, restores, tells), (0, 0, 0));
}

#[test]
fn what_was_created_after_a_save_is_gone_and_comes_again_with_its_ids() {
    let mut world = world(0.0, -9.81);
    world.create_body(&fixed(0.0, -1.0, rectangle(40.0, 2.0))).expect("accepted");
    let lost = world.create_body(&solid(3.0, 0.5, rectangle(1.0, 1.0))).expect("accepted");
    let mut ring = Rollback::new(4);
    ring.save(&world);
    let act = |world: &mut World| {
        world.destroy_body(lost).expect("it is there");
        let first = world.create_body(&solid(0.0, 2.0, disc(0.5))).expect("accepted");
        let second = world.create_body(&solid(1.0, 2.0, disc(0.5))).expect("accepted");
        let star = world.create_attractor(Attractor { position: at(0.0, 50.0), mu: num("9") }).expect("accepted");
        let colliders: Vec<_> = world.colliders().map(|collider| collider.id()).collect();
        common::run(world, 3);
        (first, second, star, colliders, world.hash())
    };
    let before = world.save();
    let once = act(&mut world);
    ring.restore(&mut world, 0).expect("it is held");
    assert!(world.body(once.0).is_none() && world.body(once.1).is_none() && world.attractor(once.2).is_none());
    assert!(world.body(lost).is_some());
    assert_eq!(world.save(), before);
    assert_eq!(world.check(), Ok(()));
    assert_eq!(act(&mut world), once);
    // Into worlds that have nothing to do with it, too.
    let coarse = WorldDef { tick_rate: 20, substeps: 3, unit_shift: 4, ..WorldDef::default() };
    for mut other in [pyramid(3, 1.0, Some(Sleeping::default())), World::new(&coarse).expect("accepted")] {
        ring.restore(&mut other, 0).expect("it is held");
        assert_eq!((other.save(), other.check()), (before.clone(), Ok(())));
        assert_eq!(act(&mut other), once);
    }
}

/// Forth again as well: who was not there sleeps, and is woken, as if nothing had been taken back.
#[test]
fn what_comes_again_falls_asleep_and_wakes() {
    let sleeping = Some(Sleeping::default());
    let mut world = World::new(&WorldDef { sleeping, ..WorldDef::default() }).expect("accepted");
    world.create_body(&fixed(0.0, -1.0, rectangle(40.0, 2.0))).expect("accepted");
    let mut ring = Rollback::new(4);
    ring.save(&world);
    let late = world.create_body(&solid(0.0, 0.5, disc(0.5))).expect("accepted");
    world.step();
    ring.save(&world);
    let mut twin = world.clone();
    for tick in [0, 1] {
        ring.restore(&mut world, tick).expect("it is held");
        assert_eq!(world.check(), Ok(()));
    }
    for tick in 0..200 {
        for world in [&mut world, &mut twin] {
            if tick == 150 {
                assert!(!world.body(late).expect("it is there").is_awake());
                world.wake(late).expect("it is there");
            }
            world.step();
        }
        assert_eq!((world.hash(), world.check()), (twin.hash(), Ok(())), "{tick}");
    }
}

#[test]
fn a_ring_says_what_it_holds() {
    let mut world = world(0.0, -9.81);
    world.create_body(&solid(0.0, 0.0, disc(0.5))).expect("accepted");
    let mut ring = Rollback::new(3);
    assert_eq!((ring.capacity(), ring.oldest(), ring.newest()), (3, None, None));
    let error = ring.restore(&mut world, 5).expect_err("nothing is held");
    assert_eq!(error, RollbackError::Empty { asked: 5 });
    assert_eq!(error.to_string(), "tick 5 is not held: no tick has been saved");
    for _ in 0..6 {
        ring.save(&world);
        world.step();
    }
    assert_eq!((ring.oldest(), ring.newest()), (Some(3), Some(5)));
    let before = world.save();
    for asked in [0, 2, 6, u64::MAX] {
        let error = ring.restore(&mut world, asked).expect_err("it is not held");
        assert_eq!(error, RollbackError::NotHeld { asked, oldest: 3, newest: 5 });
        assert_eq!(error.to_string(), format!("tick {asked} is not held: those held are of 3 … 5"));
        assert_eq!(world.save(), before);
    }
    // What is held is so until another future is saved.
    ring.restore(&mut world, 3).expect("it is held");
    ring.restore(&mut world, 5).expect("it is held");
    ring.restore(&mut world, 4).expect("it is held");
    ring.save(&world);
    assert_eq!((ring.oldest(), ring.newest()), (Some(3), Some(4)));
    ring.restore(&mut world, 5).expect_err("it belonged to another future");
    ring.clear();
    assert_eq!(ring.newest(), None);
    assert_eq!(Rollback::new(0).capacity(), 1);
}

/// A frame that is used again holds the contacts of who sleeps now, also if they are as many as before.
#[test]
fn a_frame_used_again_has_nothing_of_what_it_was() {
    let sleeping = Some(Sleeping::default());
    let mut world =
        World::new(&WorldDef { gravity: acc(0.0, -9.81), sleeping, ..WorldDef::default() }).expect("accepted");
    world.create_body(&fixed(0.0, -1.0, rectangle(40.0, 2.0))).expect("accepted");
    let both = [-5.0, 5.0].map(|x| world.create_body(&solid(x, 0.5, rectangle(1.0, 1.0))).expect("accepted"));
    let mut frame = Frame::default();
    for wakes in [0, 1] {
        common::run(&mut world, 200);
        assert!(both.iter().all(|&body| !world.body(body).expect("it is there").is_awake()));
        world.wake(both[wakes]).expect("it is there");
        common::run(&mut world, 1);
        world.save_frame(&mut frame);
        let mut twin = world.clone();
        // Else who sleeps is left as he is.
        world.wake(both[1 - wakes]).expect("it is there");
        common::run(&mut world, 3);
        world.restore_frame(&frame).expect("its own");
        assert_eq!((world.save() == twin.save(), world.check()), (true, Ok(())), "{wakes}");
        for tick in 0..100 {
            world.step();
            twin.step();
            assert_eq!(world.hash(), twin.hash(), "{wakes}, {tick}");
        }
    }
}

/// What changes a table of a world, one after the other.
fn table_changes() -> Vec<(&'static str, Command)> {
    let body = BodyId { index: 1, generation: 0 };
    let collider = tamias2d::ColliderId { index: 1, generation: 0 };
    vec![
        ("configuration", Command::SetGravity { gravity: acc(0.0, -9.0) }),
        ("bodies", Command::CreateBody { def: BodyDef::default() }),
        ("bodies", Command::SetUserData { body, user_data: 8 }),
        ("bodies", Command::DestroyBody { body }),
        ("colliders", Command::SetSurface { collider, restitution: num("0.5"), friction: num("0.25") }),
        ("attractors", Command::CreateAttractor { attractor: Attractor { position: at(0.0, 9.0), mu: num("1") } }),
    ]
}

#[test]
fn a_frame_of_other_tables_is_refused_and_nothing_has_changed() {
    let start = pyramid(4, 1.0, None);
    let mut frame = Frame::default();
    start.save_frame(&mut frame);
    for (table, command) in table_changes() {
        let mut world = start.clone();
        world.apply(command).expect("accepted");
        common::run(&mut world, 3);
        let before = world.save();
        let error = world.restore_frame(&frame).expect_err("it is of other tables");
        assert!(matches!(error, FrameError::Tables { tick: 120, what, .. } if what == table), "{error}");
        let text = error.to_string();
        assert!(
            text.starts_with(&format!("the frame of tick 120 was saved with another table of {table} (digest ")),
            "{text}"
        );
        assert_eq!((world.save(), world.check()), (before, Ok(())));
    }
    let mut empty = world(0.0, 0.0);
    let before = empty.save();
    empty.restore_frame(&frame).expect_err("another world");
    empty.restore_frame(&Frame::default()).expect_err("no frame");
    assert_eq!(empty.save(), before);
    // As it was again, it is taken.
    let mut world = start.clone();
    world.set_gravity(acc(0.0, 1.0)).expect("accepted");
    common::run(&mut world, 9);
    world.set_gravity(acc(0.0, -9.81)).expect("accepted");
    world.restore_frame(&frame).expect("its own tables");
    assert_eq!((world.save(), world.check()), (start.save(), Ok(())));
}

/// A small world with everything that a frame holds: some that sleep, contacts, a force, a status.
fn small() -> World {
    let def = WorldDef { gravity: acc(0.0, -9.81), sleeping: Some(Sleeping::default()), ..WorldDef::default() };
    let mut world = World::new(&def).expect("accepted");
    world.create_body(&fixed(0.0, -1.0, rectangle(40.0, 2.0))).expect("accepted");
    world.create_body(&solid(-5.0, 0.5, rectangle(1.0, 1.0))).expect("accepted");
    common::run(&mut world, 60);
    let high = BodyDef { position: at(0.0, 999_999_900.0), velocity: vel(0.0, 8000.0), ..BodyDef::default() };
    world.create_body(&high).expect("accepted");
    let awake = world.create_body(&solid(5.0, 0.5, rectangle(1.0, 1.0))).expect("accepted");
    common::run(&mut world, 12);
    world.apply_force(awake, newtons(1.0, 2.0), None).expect("accepted");
    assert!(!world.status().is_clear());
    assert!(world.bodies().any(|body| body.kind() == BodyKind::Dynamic && !body.is_awake()));
    world
}

#[test]
fn a_frame_from_bytes_is_the_frame() {
    let mut world = small();
    let mut frame = Frame::default();
    world.save_frame(&mut frame);
    let mut bytes = vec![1, 2, 3];
    frame.encode_into(&mut bytes);
    let read = Frame::decode(&bytes[3..]).expect("just encoded");
    assert_eq!((read.tick(), read.hash()), (world.tick(), world.hash()));
    let mut again = Vec::new();
    read.encode_into(&mut again);
    assert_eq!(again, bytes[3..]);
    let save = world.save();
    let mut after = Vec::new();
    for _ in 0..40 {
        world.step();
        after.push(world.hash());
    }
    // Into the world it is of, at another tick, and into a world that was loaded.
    for mut world in [world, World::load(&save).expect("just saved")] {
        world.restore_frame(&read).expect("its own");
        assert_eq!((world.save(), world.check()), (save.clone(), Ok(())));
        for hash in &after {
            world.step();
            assert_eq!(world.hash(), *hash);
        }
    }
}

#[test]
fn a_frame_that_was_cut_or_changed_is_refused_and_a_forged_one_is_a_state_or_refused() {
    let world = small();
    let mut frame = Frame::default();
    world.save_frame(&mut frame);
    let mut bytes = Vec::new();
    frame.encode_into(&mut bytes);
    for length in 0..bytes.len() {
        match Frame::decode(&bytes[..length]).expect_err("it is cut") {
            DecodeError::NotAFrame => assert!(length < 8),
            DecodeError::Truncated { offset, .. } => assert!(offset <= length as u64),
            other => panic!("{length} bytes give {other}"),
        }
    }
    let (mut states, mut refused) = (0, 0);
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << bit;
            let error = Frame::decode(&changed).expect_err("it is changed");
            match at {
                0..8 => assert_eq!(error, DecodeError::NotAFrame),
                8..12 => assert!(matches!(error, DecodeError::Version { known: SAVE_VERSION, .. }), "{error}"),
                12..16 => assert!(matches!(error, DecodeError::Law { known: LAW, .. }), "{error}"),
                _ => {}
            }
            // Somebody who means it gives it the right hash.
            let end = changed.len() - 16;
            if at < end && matches!(error, DecodeError::Hash { .. }) {
                for place in [end, end + 8] {
                    if place == end + 8 {
                        let seal = twox_hash::XxHash3_64::oneshot(&changed[..place]);
                        changed[place..].copy_from_slice(&seal.to_le_bytes());
                    } else if let Err(DecodeError::Hash { saved, computed }) = Frame::decode(&changed) {
                        if saved == frame.hash() {
                            changed[place..place + 8].copy_from_slice(&computed.to_le_bytes());
                        }
                    }
                }
                let forged = Frame::decode(&changed).expect("it fits");
                let mut world = world.clone();
                if world.restore_frame(&forged).is_ok() {
                    states += 1;
                    assert_eq!(world.check(), Ok(()));
                    assert_eq!(world.hash(), forged.hash());
                    world.step();
                    assert_eq!(world.check(), Ok(()));
                } else {
                    refused += 1;
                    assert!(world.save() == small_save(), "a refused frame changed the world");
                }
            }
        }
    }
    println!("a frame of {} bytes: {states} flips give another state when forged, {refused} none", bytes.len());
    assert!(states > 1000 && refused > 500);
    assert_eq!(Frame::decode(b"TAMIAS-W and more").expect_err("a save").to_string(), "not a frame of a tamias2d world");
}

fn small_save() -> Vec<u8> {
    static SAVE: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    SAVE.get_or_init(|| small().save()).clone()
}

/// What a game knows of each tick: what it was told, less what was cancelled.
#[derive(Default)]
struct Heard {
    now: BTreeMap<EventId, bool>,
    twice: u32,
}

impl Heard {
    fn hear(&mut self, log: &mut EventLog, world: &World) {
        let told = log.tell(world);
        let new = told.events.new.iter().map(|event| event.id());
        let new: Vec<EventId> = new.chain(told.collisions.new.iter().map(|collision| collision.id())).collect();
        let gone = told.events.cancelled.iter().map(|event| event.id());
        let gone: Vec<EventId> = gone.chain(told.collisions.cancelled.iter().map(|collision| collision.id())).collect();
        let kept = told.events.confirmed.iter().map(|event| event.id());
        let kept: Vec<EventId> = kept.chain(told.collisions.confirmed.iter().map(|collision| collision.id())).collect();
        for id in new {
            assert_eq!(self.now.insert(id, true), None, "{id} is new twice");
        }
        for id in gone {
            assert!(self.now.remove(&id).is_some(), "{id} was not told");
        }
        for id in kept {
            assert!(self.now.contains_key(&id), "{id} was not told");
            self.twice += 1;
        }
    }
}

#[test]
fn each_event_is_told_once_however_often_its_tick_is_simulated() {
    for name in ["bouncers", "sensors", "churn"] {
        let (start, ticks) = recorded(name);
        let (mut world, mut ring, mut log) = (start.clone(), Rollback::new(17), EventLog::new(17));
        let (mut rng, mut heard, mut truth) = (Rng(3), Heard::default(), Vec::new());
        let mut plain = start.clone();
        for commands in ticks.iter().take(600) {
            give(&mut plain, commands);
            plain.step();
            truth.extend(plain.events().iter().map(|event| event.id()));
            truth.extend(plain.collisions().iter().map(|collision| collision.id()));
        }
        let mut cancelled = false;
        for at in 0..ticks.len().min(600) {
            let go = |world: &mut World,
                      ring: &mut Rollback,
                      log: &mut EventLog,
                      heard: &mut Heard,
                      commands: &[Command]| {
                ring.save(world);
                give(world, commands);
                world.step();
                heard.hear(log, world);
            };
            go(&mut world, &mut ring, &mut log, &mut heard, &ticks[at]);
            if rng.below(10) == 0 {
                // A future that was predicted wrongly, and the right one after it up to where it was.
                let (now, count) = (world.tick(), heard.now.len());
                let mut storm = Storm::solid(rng.bits(), 20.0);
                let ahead = (1 + rng.below(8)).min((ticks.len() - 1 - at) as u64);
                for _ in 0..ahead {
                    let commands = [wrong(&world, &mut storm), wrong(&world, &mut storm)];
                    go(&mut world, &mut ring, &mut log, &mut heard, &commands);
                }
                let back = now - rng.below(8).min(now - ring.oldest().expect("some are held"));
                ring.restore(&mut world, back).expect("it is held");
                let before = heard.now.len();
                while world.tick() < now + ahead {
                    let commands = &ticks[(world.tick() - start.tick()) as usize];
                    go(&mut world, &mut ring, &mut log, &mut heard, commands);
                }
                cancelled |= before > count && heard.now.len() < before;
                ring.restore(&mut world, now).expect("it is held");
            }
        }
        let last = world.tick();
        let mut known: Vec<EventId> = heard.now.into_keys().filter(|id| id.tick < last).collect();
        truth.sort();
        known.sort();
        assert_eq!(known, truth, "{name}");
        assert!(truth.windows(2).all(|pair| pair[0] != pair[1]), "each has an id of its own");
        println!(
            "{name}: {} events and collisions, {} of them confirmed again, wrong ones: {cancelled}",
            truth.len(),
            heard.twice
        );
        assert!(!truth.is_empty() && heard.twice > 0);
    }
}

#[test]
fn an_id_is_written_and_read() {
    let a = tamias2d::ColliderId { index: 1, generation: 2 };
    let b = tamias2d::ColliderId { index: 3, generation: 4 };
    let id = EventId { tick: u64::MAX, a, b, kind: tamias2d::EventKind::Collision, ordinal: 5 };
    let text = serde_json::to_string(&id).expect("it is written");
    assert_eq!(serde_json::from_str::<EventId>(&text).expect("it is read"), id);
    assert_eq!(id.to_string(), format!("collision 5 of collider 1v2 and collider 3v4 in tick {}", u64::MAX));
}
