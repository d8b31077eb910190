//! Lockstep and rollback matches by the crate `ggrs`. Feature `ggrs`, which needs rustc 1.87.
//!
//! [`Game`] is what a game writes: its own state, and how inputs become commands. [`Lockstep`] holds it together with its
//! [`World`] and does what a session of ggrs asks for: save, load, advance, a checksum of everything. The same two serve
//! rollback, lockstep by input delay (a session whose prediction window is 0), spectators, those who join late, and ggrs's
//! test of whether a game is deterministic. The chapter [`guide::lockstep`](crate::guide::lockstep) builds a game.
//!
//! Three rules are kept by construction. Inputs reach the game without a word of whether they are predicted: one that
//! asked would compute differently on each peer. The world changes by [`Turn`] alone, which logs every command. And what
//! a game keeps is what it serialises, so a rollback forgets nothing of it.

mod error;
mod ring;
mod session;
mod snapshot;

pub use error::{Alarm, LockstepError};
pub use session::{Net, Session};

use crate::World;
use crate::replay::{Evidence, Flight};
use crate::store::{hash_bytes, write_value};
use crate::threads::Threads;
use crate::world::{Command, CommandError, Commands, Reply};
use ggrs::{Frame, GgrsError, GgrsRequest, InputStatus};
use ring::Ring;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::VecDeque;

/// A game's own state beside its world, and its rules.
///
/// All of the value is state: it is saved, restored, compared between peers and sent to those who join late, as serde
/// writes it, in at most 1 MiB. What is not state (sounds, sprites, the camera) is kept elsewhere. Hash maps have no place in
/// it: equal ones are written differently.
pub trait Game: Serialize + DeserializeOwned {
    /// What a player does in a tick; the default is doing nothing. Serialised it has the same size for every value.
    type Input: Copy + PartialEq + Default + Serialize + DeserializeOwned + 'static;

    /// Before the step of a tick: turns inputs into commands, by player; `None` is one who was cut off.
    ///
    /// It goes by its arguments and `self` alone, and gives the same on every machine: no clock, no random numbers but
    /// those whose state is in `self`, no floats that decide anything. It may run several times for one tick.
    fn act(&mut self, inputs: &[Option<Self::Input>], turn: &mut Turn<'_>);

    /// After the step: events and collisions are read here, because a restored world has none.
    fn watch(&mut self, world: &World) {
        let _ = world;
    }
}

/// The world in a tick's [`Game::act`]: to be looked at, and changed by [`Commands`].
pub struct Turn<'a> {
    world: &'a mut World,
    log: &'a mut Vec<Command>,
}

impl Turn<'_> {
    /// The world as the commands so far have left it.
    pub fn world(&self) -> &World {
        self.world
    }
}

impl Commands for Turn<'_> {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        let reply = self.world.apply(command.clone())?;
        self.log.push(command);
        Ok(reply)
    }
}

/// A tick that no input to come can change any more.
#[derive(Clone, Copy, Debug)]
pub struct Confirmed<'a, I> {
    /// The world's tick after the step.
    pub tick: u64,
    /// The hash of the world then.
    pub world: u64,
    /// The hash of the game's own state then.
    pub own: u64,
    /// The inputs that led there, by player.
    pub inputs: &'a [Option<I>],
    /// The commands that led there, for a [`Recorder`](crate::replay::Recorder).
    pub commands: &'a [Command],
}

/// A tick in the making.
struct Moment<I> {
    tick: u64,
    /// Of the world and of the game, once they are known.
    hashes: Option<[u64; 2]>,
    inputs: Vec<Option<I>>,
    commands: Vec<Command>,
}

/// A game and its world in a match.
pub struct Lockstep<G: Game> {
    game: G,
    world: World,
    /// The world's tick at the session's frame 0.
    begin: u64,
    ring: Ring,
    /// Steps the world; empty unless evidence is wanted.
    flight: Flight,
    threads: Threads,
    /// The ticks since the last one that was handed out as confirmed.
    moments: VecDeque<Moment<G::Input>>,
    /// Moments to be used again, the one handed out last at the end.
    spare: Vec<Moment<G::Input>>,
    /// No input to come changes what is up to this tick.
    settled: u64,
    /// The newest tick that was saved.
    saved: u64,
    steps: u64,
}

/// Ticks that are kept at least: those before an alarm are its evidence.
const KEPT: u32 = 32;

impl<G: Game> Lockstep<G> {
    /// A match that begins with this world and this game. Errors: a state that serde cannot write or that is too large.
    pub fn new(game: G, world: World) -> Result<Self, LockstepError> {
        let tick = world.tick();
        let mut lockstep = Lockstep {
            game,
            world,
            begin: tick,
            ring: Ring::new(KEPT),
            flight: Flight::default(),
            threads: Threads::default(),
            moments: VecDeque::new(),
            spare: Vec::new(),
            settled: tick,
            saved: tick,
            steps: 0,
        };
        lockstep.keep()?;
        Ok(lockstep)
    }

    /// Keeps the states of the last `ticks` ticks, of which a session needs its prediction window and two more; 32 if nobody
    /// says so. What is kept is there for [`Lockstep::world_at`].
    pub fn keep_ticks(&mut self, ticks: u32) -> Result<(), LockstepError> {
        self.ring = Ring::new(ticks.max(2));
        self.keep().map(drop)
    }

    /// From now on keeps evidence of the last `ticks` ticks: what memory held before each, after each stage of it, and after it.
    /// It makes a tick cost several times as much, so it is for games that are being tested, or that suspect a desync.
    pub fn keep_evidence(&mut self, ticks: u32) {
        self.flight = Flight::new(ticks);
    }

    /// Has these threads step the world from now on. No peer can tell: others have as many as they like, or none.
    pub fn use_threads(&mut self, threads: &Threads) {
        self.threads = threads.clone();
    }

    /// The evidence of a tick, if it is kept: of the step that led to it. When an alarm rings, that of two peers says where they part
    /// ([`Evidence::first_difference`]). What happened between two steps shows at the beginning of the second.
    pub fn evidence(&self, tick: u64) -> Option<&Evidence> {
        self.flight.evidence(tick)
    }

    /// The game as it is now, predictions included: what is drawn.
    pub fn game(&self) -> &G {
        &self.game
    }

    /// The world as it is now, predictions included: what is drawn.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The newest tick that no input to come can change.
    pub fn settled(&self) -> u64 {
        self.settled.min(self.saved)
    }

    /// How many steps were taken, those of rollbacks included.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Advances a session and does what it asks for. Whether time went on: a session waits for its peers when they are not
    /// there yet or too far behind.
    ///
    /// Call [`Lockstep::confirmed`] afterwards until it has no more; what was not taken is lost with the next call.
    pub fn advance<S: Session<G::Input>>(&mut self, session: &mut S) -> Result<bool, LockstepError> {
        self.advance_telling(session, |_| ())
    }

    /// As [`Lockstep::advance`]; `told` sees the world after each step, of a tick computed again as well: for an
    /// [`EventLog`](crate::EventLog), which tells of each event once.
    pub fn advance_telling<S: Session<G::Input>>(
        &mut self,
        session: &mut S,
        mut told: impl FnMut(&World),
    ) -> Result<bool, LockstepError> {
        let window = session.window();
        if window.saturating_add(2) > self.ring.len() {
            self.keep_ticks(u32::try_from(window.saturating_add(2)).unwrap_or(u32::MAX))?;
        }
        while self.confirmed().is_some() {}
        let requests = match session.advance() {
            Ok(requests) => requests,
            Err(GgrsError::NotSynchronized | GgrsError::PredictionThreshold) => return Ok(false),
            Err(error) => return Err(LockstepError::Session(error)),
        };
        let before = self.world.tick();
        for request in requests {
            match request {
                GgrsRequest::SaveGameState { cell, frame } => {
                    let [world, own] = self.keep()?;
                    cell.save(frame, None, Some(u128::from(own) << 64 | u128::from(world)));
                }
                GgrsRequest::LoadGameState { frame, .. } => self.go_back(self.tick_of(frame))?,
                GgrsRequest::AdvanceFrame { inputs } => {
                    self.step(inputs.iter().map(|(input, status)| match status {
                        InputStatus::Disconnected => None,
                        InputStatus::Confirmed | InputStatus::Predicted => Some(*input),
                    }));
                    told(&self.world);
                    // A session that never goes back does not ask for saving.
                    if window == 0 {
                        self.keep()?;
                    }
                }
            }
        }
        self.settled = self.settled.max(self.tick_of(session.confirmed().saturating_add(1))).min(self.world.tick());
        Ok(self.world.tick() > before)
    }

    /// Takes one tick with inputs that are confirmed: of those who joined late and get them from a peer.
    pub fn follow(&mut self, inputs: &[Option<G::Input>]) -> Result<(), LockstepError> {
        while self.confirmed().is_some() {}
        self.step(inputs.iter().copied());
        self.keep()?;
        self.settled = self.world.tick();
        Ok(())
    }

    /// The next tick that was confirmed, in order. After a player was cut off a tick may come once more: ggrs has learnt that
    /// another peer lost him earlier.
    pub fn confirmed(&mut self) -> Option<Confirmed<'_, G::Input>> {
        let moment = self.moments.front()?;
        if moment.tick > self.settled || moment.hashes.is_none() {
            return None;
        }
        self.spare.extend(self.moments.pop_front());
        let Moment { tick, hashes, inputs, commands } = self.spare.last()?;
        let [world, own] = (*hashes)?;
        Some(Confirmed { tick: *tick, world, own, inputs, commands })
    }

    /// Goes back to a settled tick, for a session that begins there: after a pause, or with another player. All peers go to the same
    /// one. Errors: a tick that is not settled or not kept any more.
    pub fn restart(&mut self, tick: u64) -> Result<(), LockstepError> {
        if tick > self.settled() {
            return Err(LockstepError::Gone { tick });
        }
        self.go_back(tick)?;
        while self.confirmed().is_some() {}
        (self.begin, self.settled, self.saved) = (tick, tick, tick);
        Ok(())
    }

    /// The world at an earlier tick, if it is kept.
    pub fn world_at(&self, tick: u64) -> Option<World> {
        let mut world = self.world.clone();
        self.ring.restore(&mut world, tick).then_some(world)
    }

    /// Changes the world behind everybody's back, as a fault in memory would: for tests of the alarm.
    pub fn tamper(&mut self, change: impl FnOnce(&mut World)) {
        change(&mut self.world);
    }

    /// The session's frame as a tick of the world.
    fn tick_of(&self, frame: Frame) -> u64 {
        self.begin.saturating_add_signed(frame.into())
    }

    /// Goes back to a tick that was saved.
    fn go_back(&mut self, tick: u64) -> Result<(), LockstepError> {
        let own = self.ring.own(tick).ok_or(LockstepError::Gone { tick })?;
        let game = crate::store::read_value(own).ok_or(LockstepError::Unreadable)?;
        if !self.ring.restore(&mut self.world, tick) {
            return Err(LockstepError::Gone { tick });
        }
        self.game = game;
        while self.moments.back().is_some_and(|moment| moment.tick > tick) {
            self.spare.extend(self.moments.pop_back());
        }
        Ok(())
    }

    fn step(&mut self, inputs: impl Iterator<Item = Option<G::Input>>) {
        let fresh = || Moment { tick: 0, hashes: None, inputs: Vec::new(), commands: Vec::new() };
        let mut moment = self.spare.pop().unwrap_or_else(fresh);
        moment.inputs.clear();
        moment.commands.clear();
        moment.inputs.extend(inputs);
        self.game.act(&moment.inputs, &mut Turn { world: &mut self.world, log: &mut moment.commands });
        self.flight.step_on(&mut self.world, &self.threads);
        self.game.watch(&self.world);
        self.steps = self.steps.saturating_add(1);
        (moment.tick, moment.hashes) = (self.world.tick(), None);
        self.moments.push_back(moment);
    }

    /// Keeps the present state. Its hashes: of the world, of the game.
    fn keep(&mut self) -> Result<[u64; 2], LockstepError> {
        let tick = self.world.tick();
        let (hash, own) = self.ring.save(&self.world);
        if !write_value(own, &self.game) {
            return Err(LockstepError::State);
        }
        let hashes = [hash, hash_bytes(own)];
        self.saved = tick;
        if let Some(moment) = self.moments.back_mut().filter(|moment| moment.tick == tick) {
            moment.hashes = Some(hashes);
        }
        Ok(hashes)
    }
}
