//! Commands: every change of a world, as a value.

use crate::body::{Attractor, BodyDef, BodyError, BodyKind};
use crate::geom::Vec2;
use crate::num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Force, Friction, Impulse, Inertia, Length, Mass, Mu,
    Restitution, Torque, Velocity,
};
use crate::shape::Filter;
use crate::store::{AttractorId, BodyId, ColliderId, record_enum};
use core::fmt;
use serde::{Deserialize, Serialize};

/// The most bytes of one [`Command::Input`].
pub const INPUT_MAX: usize = 65_536;

/// Every change of a world. The methods of [`Commands`](crate::Commands) are sugar for these, so a recorder that
/// records commands misses nothing. A refused command changes nothing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
#[allow(clippy::large_enum_variant, reason = "commands are few and short-lived, a box would cost each creation")]
pub enum Command {
    /// Creates a body; the reply is its id.
    CreateBody {
        /// The body to create.
        def: BodyDef,
    },
    /// Destroys a body and the forces of this tick on it.
    DestroyBody {
        /// Which.
        body: BodyId,
    },
    /// Changes what moves a body. What the new kind does not have becomes zero: forces and damping of a body that is no
    /// longer dynamic, and velocities of one that becomes static.
    SetKind {
        /// Which.
        body: BodyId,
        /// Its new kind.
        kind: BodyKind,
    },
    /// Puts a body somewhere else.
    SetPosition {
        /// Which.
        body: BodyId,
        /// Where to.
        position: Vec2<Length>,
    },
    /// Turns a body.
    SetAngle {
        /// Which.
        body: BodyId,
        /// Its new orientation, unwrapped.
        angle: Angle,
    },
    /// Sets a body's velocity.
    SetVelocity {
        /// Which.
        body: BodyId,
        /// Of its centre of mass.
        velocity: Vec2<Velocity>,
    },
    /// Sets a body's angular velocity.
    SetAngularVelocity {
        /// Which.
        body: BodyId,
        /// Counter-clockwise positive.
        angular_velocity: AngularVelocity,
    },
    /// Sets the force that acts on a body each tick.
    SetForce {
        /// Which.
        body: BodyId,
        /// It acts at the centre of mass.
        force: Vec2<Force>,
    },
    /// Sets the torque that acts on a body each tick.
    SetTorque {
        /// Which.
        body: BodyId,
        /// Counter-clockwise positive.
        torque: Torque,
    },
    /// Sets a body's mass and moment of inertia.
    SetMass {
        /// Which.
        body: BodyId,
        /// Its new mass.
        mass: Mass,
        /// Its new moment of inertia about the centre of mass.
        inertia: Inertia,
    },
    /// Lets a body turn under forces, or not. Fixing it stops it from turning.
    SetFixedRotation {
        /// Which.
        body: BodyId,
        /// Whether it is fixed.
        fixed: bool,
    },
    /// Sets a body's damping.
    SetDamping {
        /// Which.
        body: BodyId,
        /// The rate at which its velocity decays.
        linear: Damping,
        /// The rate at which its angular velocity decays.
        angular: Damping,
    },
    /// Sets by how much a body pulls the others.
    SetMu {
        /// Which.
        body: BodyId,
        /// Its gravitational parameter; 0 for none.
        mu: Mu,
    },
    /// Sets a body's user data.
    SetUserData {
        /// Which.
        body: BodyId,
        /// The game's own.
        user_data: u64,
    },
    /// Adds a force for the next tick. The lever is that of the moment of the call.
    ApplyForce {
        /// Which; it is dynamic.
        body: BodyId,
        /// The force.
        force: Vec2<Force>,
        /// Where in the world it acts; `None` is the centre of mass.
        point: Option<Vec2<Length>>,
    },
    /// Adds a torque for the next tick.
    ApplyTorque {
        /// Which; it is dynamic and may turn.
        body: BodyId,
        /// The torque.
        torque: Torque,
    },
    /// Changes a body's velocities by an impulse, at once (DD:impulseV).
    ApplyImpulse {
        /// Which; it is dynamic.
        body: BodyId,
        /// The impulse.
        impulse: Vec2<Impulse>,
        /// Where in the world it acts; `None` is the centre of mass.
        point: Option<Vec2<Length>>,
    },
    /// Changes a body's angular velocity by an angular impulse, at once.
    ApplyAngularImpulse {
        /// Which; it is dynamic and may turn.
        body: BodyId,
        /// The angular impulse.
        impulse: AngularImpulse,
    },
    /// Creates an attractor; the reply is its id.
    CreateAttractor {
        /// The attractor to create.
        attractor: Attractor,
    },
    /// Changes an attractor.
    SetAttractor {
        /// Which.
        id: AttractorId,
        /// Its new place and strength.
        attractor: Attractor,
    },
    /// Destroys an attractor.
    DestroyAttractor {
        /// Which.
        id: AttractorId,
    },
    /// Changes gravity.
    SetGravity {
        /// The acceleration of every dynamic body.
        gravity: Vec2<Acceleration>,
    },
    /// Changes what a collider does to others that it touches.
    SetSurface {
        /// Which.
        collider: ColliderId,
        /// C_R.
        restitution: Restitution,
        /// The coefficient of friction.
        friction: Friction,
    },
    /// Changes what a collider meets.
    SetFilter {
        /// Which.
        collider: ColliderId,
        /// What it is and meets.
        filter: Filter,
    },
    /// Lets a body fall asleep, or never again: then it wakes.
    SetAllowSleep {
        /// Which.
        body: BodyId,
        /// Whether it may.
        allow: bool,
    },
    /// Wakes a body with all that hangs together with it, or what sleeps on a static or kinematic one. What is awake begins
    /// to count anew.
    Wake {
        /// Which.
        body: BodyId,
    },
    /// Puts a body and all that hangs together with it to sleep, however fast it is. It stays where it is, in the air as
    /// well, until something wakes it.
    PutToSleep {
        /// Which; it is dynamic.
        body: BodyId,
    },
    /// Forgets what went out of range.
    ClearStatus,
    /// Attaches the game's own bytes to this tick. The world does not look at them; replays carry them.
    Input {
        /// At most [`INPUT_MAX`] bytes.
        bytes: Vec<u8>,
    },
}

record_enum!(Command {
    0 => CreateBody { def },
    1 => DestroyBody { body },
    2 => SetKind { body, kind },
    3 => SetPosition { body, position },
    4 => SetAngle { body, angle },
    5 => SetVelocity { body, velocity },
    6 => SetAngularVelocity { body, angular_velocity },
    7 => SetForce { body, force },
    8 => SetTorque { body, torque },
    9 => SetMass { body, mass, inertia },
    10 => SetFixedRotation { body, fixed },
    11 => SetDamping { body, linear, angular },
    12 => SetMu { body, mu },
    13 => SetUserData { body, user_data },
    14 => ApplyForce { body, force, point },
    15 => ApplyTorque { body, torque },
    16 => ApplyImpulse { body, impulse, point },
    17 => ApplyAngularImpulse { body, impulse },
    18 => CreateAttractor { attractor },
    19 => SetAttractor { id, attractor },
    20 => DestroyAttractor { id },
    21 => SetGravity { gravity },
    22 => ClearStatus {},
    23 => Input { bytes },
    24 => SetSurface { collider, restitution, friction },
    25 => SetFilter { collider, filter },
    26 => SetAllowSleep { body, allow },
    27 => Wake { body },
    28 => PutToSleep { body },
});

/// What an accepted command answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reply {
    /// It is done.
    Done,
    /// The id of the new body.
    Body(BodyId),
    /// The id of the new attractor.
    Attractor(AttractorId),
}

/// Why a command was refused. The world has not changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CommandError {
    /// The body was destroyed, or never was.
    NoSuchBody(BodyId),
    /// The attractor was destroyed, or never was.
    NoSuchAttractor(AttractorId),
    /// The collider's body was destroyed, or never was.
    NoSuchCollider(ColliderId),
    /// The body cannot have this value.
    Body(BodyError),
    /// A table is full.
    Full {
        /// What there are too many of.
        what: &'static str,
        /// The most there can be.
        limit: u32,
    },
    /// The world has no sleeping.
    NoSleeping,
    /// What is to be put to sleep hangs together with a body that must not sleep.
    MustNotSleep(BodyId),
    /// Input of more than [`INPUT_MAX`] bytes.
    InputTooLong {
        /// Its length in bytes.
        length: u64,
    },
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CommandError::NoSuchBody(id) => write!(f, "there is no {id}"),
            CommandError::NoSuchAttractor(id) => write!(f, "there is no {id}"),
            CommandError::NoSuchCollider(id) => write!(f, "there is no {id}"),
            CommandError::Body(error) => error.fmt(f),
            CommandError::Full { what, limit } => write!(f, "there are {limit} {what}, which is the most there can be"),
            CommandError::NoSleeping => f.write_str("nothing sleeps in a world without sleeping"),
            CommandError::MustNotSleep(id) => write!(f, "{id} must not sleep"),
            CommandError::InputTooLong { length } => write!(f, "input of {length} bytes is longer than {INPUT_MAX}"),
        }
    }
}

impl core::error::Error for CommandError {}

impl<E: Into<BodyError>> From<E> for CommandError {
    fn from(error: E) -> Self {
        CommandError::Body(error.into())
    }
}
