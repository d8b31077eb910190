//! Falling asleep and waking: who, when, and what goes with it.
//!
//! A body that sleeps is left out of the step: no forces, a box that stays in the broad phase, its contacts on a list of
//! their own. Only these functions let bodies fall asleep and wake, whole islands at a time.

use super::command::{Command, CommandError, Reply};
use super::commands::Commands;
use crate::World;
use crate::body::{Bodies, BodyData, BodyError, BodyKind, Colliders};
use crate::contact::{Contacts, Resting, Touch};
use crate::geom::Vec2;
use crate::motion::Drive;
use crate::num::{Acceleration, Angle, AngularVelocity, Length, Mu, Velocity};
use crate::solver::Solver;
use crate::store::BodyId;

/// So often a tick is computed again because it touched what sleeps, before all that sleeps is woken: what is hit in a
/// tick may hit what lies farther on.
const AGAIN: u32 = 8;

/// What falling asleep and waking changes.
pub(super) struct Sleepers<'w> {
    pub(super) bodies: &'w mut Bodies,
    pub(super) colliders: &'w Colliders,
    pub(super) contacts: &'w mut Contacts,
    pub(super) resting: &'w mut Resting,
    pub(super) touch: &'w mut Touch,
    pub(super) drive: &'w mut Drive,
    pub(super) gravity: Vec2<Acceleration>,
}

impl Sleepers<'_> {
    /// Every contact on its list.
    fn settle(&mut self) {
        self.resting.settle(self.contacts, self.bodies, self.colliders);
        self.bodies.rest.settle();
    }

    /// Whether the tick touched what sleeps: then it is taken back, and the islands that were touched are awake.
    pub(super) fn wake_touched(&mut self, solver: &Solver, attempt: u32) -> bool {
        if !self.bodies.rest.any_asleep() {
            return false;
        }
        self.touch.find_touched(self.bodies, |pair| solver.outcome(pair), &mut self.resting.found);
        if self.resting.found.is_empty() {
            return false;
        }
        self.bodies.take_back(&self.resting.before);
        if attempt < AGAIN {
            self.wake_found()
        } else {
            self.wake_all()
        }
        self.settle();
        true
    }

    /// After a tick: islands that have been quiet for long enough fall asleep. `limits`: speed, Q48 m/s, and ticks.
    pub(super) fn lull_quiet(&mut self, limits: (i64, u32)) {
        // What moves may pull what sleeps elsewhere.
        if self.drive.is_pulled_by_movers(self.bodies) {
            return;
        }
        self.resting.find_quiet(self.contacts, self.bodies, self.colliders, limits);
        self.lull_found();
    }

    /// Puts the bodies found to sleep.
    fn lull_found(&mut self) {
        if self.resting.found.is_empty() {
            return;
        }
        let (found, still) = (core::mem::take(&mut self.resting.found), BodyData::default());
        for slot in found.iter().map(|&slot| slot as usize) {
            if self.bodies.rest.lull(slot) {
                self.bodies.set_velocity(slot, Vec2::default());
                self.bodies.omega.set(slot, AngularVelocity::ZERO);
                self.drive.set(slot, &still, self.gravity, None);
                self.place(slot);
            }
        }
        self.resting.found = found;
        self.resting.stir();
        self.settle();
    }

    /// Wakes the islands of the bodies found.
    fn wake_found(&mut self) {
        let found = core::mem::take(&mut self.resting.found);
        for &slot in &found {
            self.wake(slot as usize);
        }
        self.resting.found = found;
    }

    pub(super) fn wake_all(&mut self) {
        for slot in 0..self.bodies.rest.len() {
            self.wake(slot);
        }
    }

    /// Wakes the island of a body, if that sleeps.
    fn wake(&mut self, slot: usize) {
        if !self.bodies.rest.is_asleep(slot) {
            return;
        }
        let mut at = slot;
        loop {
            if self.bodies.rest.rouse(at) {
                self.drive.set(at, self.bodies.cold.value(at), self.gravity, None);
                self.place(at);
            }
            at = self.resting.islands.next(at);
            if at == slot {
                break;
            }
        }
        self.resting.stir();
    }

    /// A command has changed a body: it counts anew, and wakes with its island, or with what lies on it.
    fn disturb(&mut self, slot: usize) {
        self.wake(slot);
        self.bodies.rest.rouse(slot);
        self.resting.find_on(slot, self.bodies, self.colliders);
        self.wake_found();
    }

    /// Tells the broad phase where a body's colliders are, and whether they stay there.
    fn place(&mut self, slot: usize) {
        for collider in self.colliders.list(self.bodies.cold.value(slot).first) {
            self.touch.set(collider, self.bodies, self.colliders);
        }
    }
}

/// Whom a command may wake.
enum Stirs {
    Nobody,
    /// A body, if it becomes another one.
    Changed(usize),
    /// A body, whatever becomes of it.
    Body(usize),
    /// A body that ceases to be.
    Gone(usize),
    Everybody,
}

/// A body as commands see it.
type Portrait = (Vec2<Length>, Angle, Vec2<Velocity>, AngularVelocity, BodyData);

impl Commands for World {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        if self.config.sleeping.is_none() {
            return self.carry_out(command);
        }
        match self.stirs(&command) {
            Stirs::Nobody => {
                let reply = self.carry_out(command)?;
                if let Reply::Body(id) = reply {
                    self.disturb_around(id.index as usize, Mu::ZERO);
                }
                Ok(reply)
            }
            Stirs::Everybody => {
                let reply = self.carry_out(command)?;
                self.sleepers().wake_all();
                Ok(reply)
            }
            Stirs::Changed(slot) => {
                let before = self.portrait(slot);
                let reply = self.carry_out(command)?;
                let after = self.portrait(slot);
                if before != after {
                    self.sleepers().disturb(slot);
                }
                let place = |of: &Portrait| (of.0, of.1, of.4.kind, of.4.mu);
                if place(&before) != place(&after) {
                    self.disturb_around(slot, before.4.mu);
                }
                Ok(reply)
            }
            Stirs::Body(slot) => {
                let meets = matches!(command, Command::SetFilter { .. });
                let reply = self.carry_out(command)?;
                self.sleepers().disturb(slot);
                if meets {
                    self.disturb_around(slot, Mu::ZERO);
                }
                Ok(reply)
            }
            Stirs::Gone(slot) => {
                let pulls = self.bodies.cold.value(slot).mu != Mu::ZERO;
                // While it is known who lies on it.
                self.sleepers().disturb(slot);
                self.resting.stir();
                let reply = self.carry_out(command)?;
                if pulls {
                    self.sleepers().wake_all();
                }
                Ok(reply)
            }
        }
    }
}

impl World {
    pub(super) fn sleepers(&mut self) -> Sleepers<'_> {
        let World { config, bodies, colliders, contacts, resting, touch, drive, .. } = self;
        Sleepers { bodies, colliders, contacts, resting, touch, drive, gravity: config.gravity }
    }

    fn portrait(&self, slot: usize) -> Portrait {
        let bodies = &self.bodies;
        let (v, omega) = (bodies.velocity(slot), bodies.omega.get(slot));
        (bodies.position(slot), bodies.angle.get(slot), v, omega, bodies.cold.value(slot).clone())
    }

    /// Whom a command may wake. A body that is not there is refused anyway.
    fn stirs(&self, command: &Command) -> Stirs {
        let of = |body: BodyId, stirs: fn(usize) -> Stirs| self.bodies.slot(body).map_or(Stirs::Nobody, stirs);
        match *command {
            Command::SetKind { body, .. }
            | Command::SetPosition { body, .. }
            | Command::SetAngle { body, .. }
            | Command::SetVelocity { body, .. }
            | Command::SetAngularVelocity { body, .. }
            | Command::SetForce { body, .. }
            | Command::SetTorque { body, .. }
            | Command::SetMass { body, .. }
            | Command::SetFixedRotation { body, .. }
            | Command::SetDamping { body, .. }
            | Command::SetMu { body, .. }
            | Command::SetAllowSleep { body, .. } => of(body, Stirs::Changed),
            Command::DestroyBody { body } => of(body, Stirs::Gone),
            Command::ApplyForce { body, .. }
            | Command::ApplyTorque { body, .. }
            | Command::ApplyImpulse { body, .. }
            | Command::ApplyAngularImpulse { body, .. }
            | Command::Wake { body } => of(body, Stirs::Body),
            Command::SetSurface { collider, .. } | Command::SetFilter { collider, .. } => {
                let slot = self.colliders.slot(collider);
                slot.map_or(Stirs::Nobody, |slot| Stirs::Body(self.colliders.rows.value(slot).body as usize))
            }
            Command::SetGravity { gravity } if gravity == self.config.gravity => Stirs::Nobody,
            Command::SetGravity { .. }
            | Command::CreateAttractor { .. }
            | Command::SetAttractor { .. }
            | Command::DestroyAttractor { .. } => Stirs::Everybody,
            Command::CreateBody { .. }
            | Command::SetUserData { .. }
            | Command::PutToSleep { .. }
            | Command::ClearStatus
            | Command::Input { .. } => Stirs::Nobody,
        }
    }

    /// A body is new where it is, or met otherwise: what sleeps there wakes, if a step would not find out because the body
    /// stays there; and everybody if it pulls, or did.
    fn disturb_around(&mut self, slot: usize, mu: Mu) {
        let data = self.bodies.cold.value(slot);
        if data.mu != Mu::ZERO || mu != Mu::ZERO {
            self.sleepers().wake_all();
        }
        if self.bodies.cold.value(slot).kind != BodyKind::Dynamic {
            let World { bodies, colliders, resting, touch, .. } = self;
            touch.find_in_place(slot, bodies, colliders, &mut resting.found);
            self.sleepers().wake_found();
        }
    }

    /// Puts a body and all that hangs together with it to sleep.
    pub(super) fn lull(&mut self, body: BodyId) -> Result<(), CommandError> {
        const NAME: &str = "sleep";
        let slot = self.bodies.slot(body).ok_or(CommandError::NoSuchBody(body))?;
        let kind = self.bodies.cold.value(slot).kind;
        if kind != BodyKind::Dynamic {
            return Err(BodyError::Kind { quantity: NAME, kind }.into());
        }
        if self.config.sleeping.is_none() {
            return Err(CommandError::NoSleeping);
        }
        if self.bodies.rest.is_asleep(slot) {
            return Ok(());
        }
        let World { bodies, colliders, contacts, resting, .. } = self;
        resting.find_island(slot, contacts, bodies, colliders);
        let awake = |&&slot: &&u32| !bodies.cold.value(slot as usize).allow_sleep;
        if let Some(id) = resting.found.iter().find(awake).and_then(|&slot| bodies.id(slot as usize)) {
            return Err(CommandError::MustNotSleep(id));
        }
        let found = core::mem::take(&mut self.resting.found);
        for &slot in &found {
            self.drop_push(slot as usize);
        }
        self.resting.found = found;
        self.sleepers().lull_found();
        Ok(())
    }
}
