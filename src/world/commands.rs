//! Commands as methods.

use super::command::{Command, CommandError, Reply};
use crate::body::{Attractor, BodyDef, BodyKind};
use crate::geom::Vec2;
use crate::num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Force, Friction, Impulse, Inertia, Length, Mass, Mu,
    Restitution, Torque, Velocity,
};
use crate::shape::Filter;
use crate::store::{AttractorId, BodyId, ColliderId};

/// The commands as methods, for whatever takes commands: a [`World`](crate::World), or a recorder around one.
pub trait Commands {
    /// Carries a command out, or refuses it and changes nothing.
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError>;

    /// Creates a body.
    fn create_body(&mut self, def: &BodyDef) -> Result<BodyId, CommandError> {
        match self.apply(Command::CreateBody { def: def.clone() })? {
            Reply::Body(id) => Ok(id),
            reply => unreachable!("creating a body answers with its id, not {reply:?}"),
        }
    }

    /// Creates an attractor.
    fn create_attractor(&mut self, attractor: Attractor) -> Result<AttractorId, CommandError> {
        match self.apply(Command::CreateAttractor { attractor })? {
            Reply::Attractor(id) => Ok(id),
            reply => unreachable!("creating an attractor answers with its id, not {reply:?}"),
        }
    }

    /// Destroys a body and the forces of this tick on it.
    fn destroy_body(&mut self, body: BodyId) -> Result<(), CommandError> {
        self.apply(Command::DestroyBody { body }).map(drop)
    }

    /// Changes what moves a body. See [`Command::SetKind`].
    fn set_kind(&mut self, body: BodyId, kind: BodyKind) -> Result<(), CommandError> {
        self.apply(Command::SetKind { body, kind }).map(drop)
    }

    /// Puts a body somewhere else.
    fn set_position(&mut self, body: BodyId, position: Vec2<Length>) -> Result<(), CommandError> {
        self.apply(Command::SetPosition { body, position }).map(drop)
    }

    /// Turns a body.
    fn set_angle(&mut self, body: BodyId, angle: Angle) -> Result<(), CommandError> {
        self.apply(Command::SetAngle { body, angle }).map(drop)
    }

    /// Sets a body's velocity.
    fn set_velocity(&mut self, body: BodyId, velocity: Vec2<Velocity>) -> Result<(), CommandError> {
        self.apply(Command::SetVelocity { body, velocity }).map(drop)
    }

    /// Sets a body's angular velocity.
    fn set_angular_velocity(&mut self, body: BodyId, angular_velocity: AngularVelocity) -> Result<(), CommandError> {
        self.apply(Command::SetAngularVelocity { body, angular_velocity }).map(drop)
    }

    /// Sets the force that acts on a body each tick.
    fn set_force(&mut self, body: BodyId, force: Vec2<Force>) -> Result<(), CommandError> {
        self.apply(Command::SetForce { body, force }).map(drop)
    }

    /// Sets the torque that acts on a body each tick.
    fn set_torque(&mut self, body: BodyId, torque: Torque) -> Result<(), CommandError> {
        self.apply(Command::SetTorque { body, torque }).map(drop)
    }

    /// Sets a body's mass and moment of inertia.
    fn set_mass(&mut self, body: BodyId, mass: Mass, inertia: Inertia) -> Result<(), CommandError> {
        self.apply(Command::SetMass { body, mass, inertia }).map(drop)
    }

    /// Lets a body turn under forces, or not. Fixing it stops it from turning.
    fn set_fixed_rotation(&mut self, body: BodyId, fixed: bool) -> Result<(), CommandError> {
        self.apply(Command::SetFixedRotation { body, fixed }).map(drop)
    }

    /// Sets a body's damping.
    fn set_damping(&mut self, body: BodyId, linear: Damping, angular: Damping) -> Result<(), CommandError> {
        self.apply(Command::SetDamping { body, linear, angular }).map(drop)
    }

    /// Sets by how much a body pulls the others.
    fn set_mu(&mut self, body: BodyId, mu: Mu) -> Result<(), CommandError> {
        self.apply(Command::SetMu { body, mu }).map(drop)
    }

    /// Sets a body's user data.
    fn set_user_data(&mut self, body: BodyId, user_data: u64) -> Result<(), CommandError> {
        self.apply(Command::SetUserData { body, user_data }).map(drop)
    }

    /// Adds a force for the next tick. The lever is that of the moment of the call.
    fn apply_force(
        &mut self,
        body: BodyId,
        force: Vec2<Force>,
        point: Option<Vec2<Length>>,
    ) -> Result<(), CommandError> {
        self.apply(Command::ApplyForce { body, force, point }).map(drop)
    }

    /// Adds a torque for the next tick.
    fn apply_torque(&mut self, body: BodyId, torque: Torque) -> Result<(), CommandError> {
        self.apply(Command::ApplyTorque { body, torque }).map(drop)
    }

    /// Changes a body's velocities by an impulse, at once (DD:impulseV).
    fn apply_impulse(
        &mut self,
        body: BodyId,
        impulse: Vec2<Impulse>,
        point: Option<Vec2<Length>>,
    ) -> Result<(), CommandError> {
        self.apply(Command::ApplyImpulse { body, impulse, point }).map(drop)
    }

    /// Changes a body's angular velocity by an angular impulse, at once.
    fn apply_angular_impulse(&mut self, body: BodyId, impulse: AngularImpulse) -> Result<(), CommandError> {
        self.apply(Command::ApplyAngularImpulse { body, impulse }).map(drop)
    }

    /// Changes an attractor.
    fn set_attractor(&mut self, id: AttractorId, attractor: Attractor) -> Result<(), CommandError> {
        self.apply(Command::SetAttractor { id, attractor }).map(drop)
    }

    /// Destroys an attractor.
    fn destroy_attractor(&mut self, id: AttractorId) -> Result<(), CommandError> {
        self.apply(Command::DestroyAttractor { id }).map(drop)
    }

    /// Changes gravity.
    fn set_gravity(&mut self, gravity: Vec2<Acceleration>) -> Result<(), CommandError> {
        self.apply(Command::SetGravity { gravity }).map(drop)
    }

    /// Changes what a collider does to others that it touches.
    fn set_surface(
        &mut self,
        collider: ColliderId,
        restitution: Restitution,
        friction: Friction,
    ) -> Result<(), CommandError> {
        self.apply(Command::SetSurface { collider, restitution, friction }).map(drop)
    }

    /// Changes what a collider meets.
    fn set_filter(&mut self, collider: ColliderId, filter: Filter) -> Result<(), CommandError> {
        self.apply(Command::SetFilter { collider, filter }).map(drop)
    }

    /// Lets a body fall asleep, or never again: then it wakes.
    fn set_allow_sleep(&mut self, body: BodyId, allow: bool) -> Result<(), CommandError> {
        self.apply(Command::SetAllowSleep { body, allow }).map(drop)
    }

    /// Wakes a body with all that hangs together with it. See [`Command::Wake`].
    fn wake(&mut self, body: BodyId) -> Result<(), CommandError> {
        self.apply(Command::Wake { body }).map(drop)
    }

    /// Puts a body and all that hangs together with it to sleep. See [`Command::PutToSleep`].
    fn put_to_sleep(&mut self, body: BodyId) -> Result<(), CommandError> {
        self.apply(Command::PutToSleep { body }).map(drop)
    }

    /// Forgets what went out of range.
    fn clear_status(&mut self) -> Result<(), CommandError> {
        self.apply(Command::ClearStatus).map(drop)
    }

    /// Attaches the game's own bytes to this tick. The world does not look at them; replays carry them.
    fn input(&mut self, bytes: Vec<u8>) -> Result<(), CommandError> {
        self.apply(Command::Input { bytes }).map(drop)
    }
}
