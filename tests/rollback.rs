//! Frames and the ring of them: a world that is rolled back and simulated anew is the one that never was.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{Rng, Storm, acc, at, measure, rectangle, vel, world};
use proptest::prelude::{ProptestConfig, any, proptest};
use std::path::Path;
use tamias2d::replay::Player;
use tamias2d::{
    BodyDef, BodyId, BodyKind, ColliderDef, Command, Commands, DecodeError, Frame, FrameError, LAW, Rollback,
    RollbackError, SAVE_VERSION, Shape, Sleeping, World, WorldDef,
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
            drop(storm.heed(Ok(tamias2d::Reply::Body(body))));
            storm.command()
        }
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
        commands.iter().for_each(|command| drop(self.plain.apply(command.clone())));
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
            commands.iter().for_each(|command| drop(self.rolled.apply(command.clone())));
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
        self.ring.restore(&mut self.rolled, target).expect("it is held");
        assert_eq!(self.rolled.check(), Ok(()), "back at tick {target}");
        if self.rng.below(4) == 0 {
            // A twin that was saved here goes on as it did.
            let mut twin = World::load(&self.rolled.save()).expect("just saved");
            for at in target..self.plain.tick() {
                let (commands, hash) = &self.past[(at - self.start) as usize];
                assert_eq!(twin.hash(), *hash, "the twin at tick {at}");
                commands.iter().for_each(|command| drop(twin.apply(command.clone())));
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
