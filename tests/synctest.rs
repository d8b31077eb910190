//! Every golden scene in ggrs's test of determinism: each tick is computed again from a restored state, up to seven times,
//! and must give the same checksum. The scenes' scripts are the inputs.
#![cfg(all(feature = "ggrs", feature = "scene"))]
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use ggrs::{GgrsError, SessionBuilder, SyncTestSession};
use serde::{Deserialize, Serialize};
use std::cell::{Cell, RefCell};
use tamias2d::lockstep::{Game, Lockstep, LockstepError, Net, Turn};
use tamias2d::scene::{Scene, Stage};
use tamias2d::{Command, CommandError, Commands, Reply, Velocity, World};

const CHECK_DISTANCE: usize = 7;

thread_local! {
    /// The commands of the scene's ticks, which an input names. No state: the same at any time.
    static SCRIPT: RefCell<Vec<Vec<Command>>> = const { RefCell::new(Vec::new()) };
}

/// A game whose player says which tick of the script comes.
#[derive(Serialize, Deserialize)]
struct Scripted {
    /// What it has carried out: state of its own, so that restoring that counts as well.
    commands: u64,
}

impl Game for Scripted {
    /// The tick, from 1; 0 is nothing.
    type Input = u32;

    fn act(&mut self, inputs: &[Option<u32>], turn: &mut Turn<'_>) {
        let Some(at) = inputs[0].and_then(|tick| tick.checked_sub(1)) else { return };
        for command in SCRIPT.with_borrow(|script| script[at as usize].clone()) {
            turn.apply(command).expect("accepted when it was recorded");
            self.commands += 1;
        }
    }
}

/// A world that notes the commands it gets.
struct Noted {
    world: World,
    commands: Vec<Command>,
}

impl Commands for Noted {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        let reply = self.world.apply(command.clone())?;
        self.commands.push(command);
        Ok(reply)
    }
}

impl Stage for Noted {
    fn world(&self) -> &World {
        &self.world
    }

    fn step(&mut self) {
        self.world.step();
    }
}

/// A scene's first world, the commands before each tick, and the hash after it.
fn played(text: &str) -> (World, Vec<Vec<Command>>, Vec<u64>) {
    let scene = Scene::parse(text).expect("a scene");
    let (world, mut script) = scene.start().expect("accepted");
    let first = world.clone();
    let mut noted = Noted { world, commands: Vec::new() };
    let (mut commands, mut hashes) = (Vec::new(), Vec::new());
    for tick in 0..scene.ticks() {
        script.apply(tick, &mut noted).expect("accepted");
        noted.step();
        commands.push(std::mem::take(&mut noted.commands));
        hashes.push(noted.world.hash());
    }
    (first, commands, hashes)
}

fn session<G: Game + 'static>() -> SyncTestSession<Net<G>> {
    let builder = SessionBuilder::<Net<G>>::new().with_num_players(1).expect("one");
    builder.with_check_distance(CHECK_DISTANCE).start_synctest_session().expect("less than the window of 8")
}

/// Plays a scene in a session and compares each confirmed tick with the plain run.
fn check(name: &str) {
    let text = std::fs::read_to_string(format!("replays/{name}.json")).expect("a scene");
    let (world, commands, hashes) = played(&text);
    SCRIPT.set(commands);
    let mut lockstep = Lockstep::new(Scripted { commands: 0 }, world).expect("small");
    let (mut session, mut confirmed) = (session::<Scripted>(), 0);
    for tick in 0..hashes.len() as u32 {
        session.add_local_input(0, tick + 1).expect("a player");
        let went_on = lockstep.advance(&mut session).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(went_on);
        assert_eq!(lockstep.world().hash(), hashes[tick as usize], "{name}: tick {}", tick + 1);
        assert_eq!(lockstep.world().check(), Ok(()), "{name}");
        while let Some(settled) = lockstep.confirmed() {
            assert_eq!((settled.tick, settled.world), (confirmed as u64 + 1, hashes[confirmed]), "{name}");
            assert_eq!(settled.inputs, [Some(confirmed as u32 + 1)]);
            confirmed += 1;
        }
    }
    assert_eq!(confirmed, hashes.len() - CHECK_DISTANCE, "{name}");
    // The first eight ticks are not computed again, with each other one seven are.
    let ticks = hashes.len() as u64;
    assert_eq!(lockstep.steps(), ticks + (ticks - CHECK_DISTANCE as u64 - 1) * CHECK_DISTANCE as u64);
}

macro_rules! scenes {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name));
            }
        )*

        /// A scene that comes to the goldens comes here.
        #[test]
        fn no_scene_is_missing() {
            let mut here = vec![$(stringify!($name)),*];
            let mut there = Vec::new();
            for entry in std::fs::read_dir("replays").expect("the goldens") {
                let path = entry.expect("a file").path();
                if path.extension().is_some_and(|extension| extension == "json") {
                    there.push(path.file_stem().expect("a name").to_string_lossy().into_owned());
                }
            }
            here.sort_unstable();
            there.sort_unstable();
            assert_eq!(here, there);
        }
    };
}

scenes! {
    free_flight spin orbit everything tc10c tc11c pyramid55 pusher sensors churn pixels tumbler bouncers pile300 sleep
}

thread_local! {
    static CALLS: Cell<u32> = const { Cell::new(0) };
}

/// A game with state that nobody saves: its 100th call flips the lowest bit of a velocity.
#[derive(Serialize, Deserialize)]
struct Forgetful;

impl Game for Forgetful {
    type Input = u32;

    fn act(&mut self, _: &[Option<u32>], turn: &mut Turn<'_>) {
        CALLS.set(CALLS.get() + 1);
        if CALLS.get() == 100 {
            let top = turn.world().bodies().last().expect("a pyramid");
            let (id, mut velocity) = (top.id(), top.velocity());
            velocity.y = Velocity::from_bits(velocity.y.to_bits() ^ 1);
            turn.set_velocity(id, velocity).expect("it exists");
        }
    }
}

/// The alarm rings, and names the tick: the 100th call was the second one for frame 15, so the state before frame 16 is
/// another one than the first time.
#[test]
fn state_outside_the_game_is_found() {
    let (world, ..) = played(&std::fs::read_to_string("replays/pyramid55.json").expect("a scene"));
    let mut lockstep = Lockstep::new(Forgetful, world).expect("small");
    let mut session = session::<Forgetful>();
    let error = loop {
        session.add_local_input(0, 0).expect("a player");
        if let Err(error) = lockstep.advance(&mut session) {
            break error;
        }
    };
    // Frame 19 was kept for the first time after it.
    let mismatched_frames = vec![16, 17, 18];
    let mismatch = GgrsError::MismatchedChecksum { current_frame: 20, mismatched_frames };
    assert_eq!(error, LockstepError::Session(mismatch));
}
