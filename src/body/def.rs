//! What a body is made of, and what of it is accepted.

use crate::geom::Vec2;
use crate::num::{
    Angle, AngularVelocity, Damping, Force, Inertia, Length, Mass, Mu, Quantity, RangeError, Torque, Velocity,
};
use crate::store::{Row, record, record_enum};
use core::fmt;
use serde::{Deserialize, Serialize};

/// What moves a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum BodyKind {
    /// Nothing: it stays where it is put.
    #[default]
    Static,
    /// Its own velocities, which only commands change.
    Kinematic,
    /// Forces.
    Dynamic,
}

record_enum!(BodyKind { 0 => Static {}, 1 => Kinematic {}, 2 => Dynamic {} });

/// A body to create. `BodyDef::default()` is a dynamic body of 1 kg and 1 kg m² at rest at the origin.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodyDef {
    /// What moves it.
    pub kind: BodyKind,
    /// Its origin, which is its centre of mass.
    pub position: Vec2<Length>,
    /// Its orientation, unwrapped; [`Angle::from_radians`] takes radians in [0, 2π].
    pub angle: Angle,
    /// The velocity of its centre of mass; zero for a static body.
    pub velocity: Vec2<Velocity>,
    /// Counter-clockwise positive; zero for a static body and with fixed rotation.
    pub angular_velocity: AngularVelocity,
    /// A force that acts each tick until it is set anew; zero unless the body is dynamic.
    pub force: Vec2<Force>,
    /// A torque that acts each tick until it is set anew; zero unless the body is dynamic and may turn.
    pub torque: Torque,
    /// Kept for every kind; what it means, it means while the body is dynamic.
    pub mass: Mass,
    /// About the centre of mass; as `mass`.
    pub inertia: Inertia,
    /// Whether forces do not turn the body.
    pub fixed_rotation: bool,
    /// The rate at which the velocity decays, v(t) = v₀·exp(−c·t) without forces.
    pub linear_damping: Damping,
    /// The rate at which the angular velocity decays.
    pub angular_damping: Damping,
    /// The gravitational parameter by which the body pulls every *other* dynamic body; 0 for none.
    pub mu: Mu,
    /// The game's own; stored, hashed, not looked at.
    pub user_data: u64,
}

impl Default for BodyDef {
    fn default() -> Self {
        BodyDef {
            kind: BodyKind::Dynamic,
            position: Vec2::default(),
            angle: Angle::ZERO,
            velocity: Vec2::default(),
            angular_velocity: AngularVelocity::ZERO,
            force: Vec2::default(),
            torque: Torque::ZERO,
            mass: Mass::from_bits(1 << 64),
            inertia: Inertia::from_bits(1 << 64),
            fixed_rotation: false,
            linear_damping: Damping::ZERO,
            angular_damping: Damping::ZERO,
            mu: Mu::ZERO,
            user_data: 0,
        }
    }
}

record!(BodyDef {
    kind,
    position,
    angle,
    velocity,
    angular_velocity,
    force,
    torque,
    mass,
    inertia,
    fixed_rotation,
    linear_damping,
    angular_damping,
    mu,
    user_data,
});

/// Why a body cannot have a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyError {
    /// Outside the quantity's accepted range.
    Range(RangeError),
    /// Only another kind of body has it; this kind may have 0 where it is a property.
    Kind {
        /// The quantity's name.
        quantity: &'static str,
        /// The body's kind.
        kind: BodyKind,
    },
    /// A body with fixed rotation has none; it may have 0 where it is a property.
    FixedRotation {
        /// The quantity's name.
        quantity: &'static str,
    },
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BodyError::Range(error) => error.fmt(f),
            BodyError::Kind { quantity, kind } => {
                let kind = match kind {
                    BodyKind::Static => "static",
                    BodyKind::Kinematic => "kinematic",
                    BodyKind::Dynamic => "dynamic",
                };
                write!(f, "a {kind} body has no {quantity}")
            }
            BodyError::FixedRotation { quantity } => {
                write!(f, "a body with fixed rotation has no {quantity}")
            }
        }
    }
}

impl core::error::Error for BodyError {}

impl From<RangeError> for BodyError {
    fn from(error: RangeError) -> Self {
        BodyError::Range(error)
    }
}

/// What of a body only commands change: the cold row beside the hot columns.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct BodyData {
    pub(crate) kind: BodyKind,
    pub(crate) fixed_rotation: bool,
    pub(crate) mass: Mass,
    pub(crate) inertia: Inertia,
    pub(crate) force: Vec2<Force>,
    pub(crate) torque: Torque,
    pub(crate) linear_damping: Damping,
    pub(crate) angular_damping: Damping,
    pub(crate) mu: Mu,
    pub(crate) user_data: u64,
}

record!(BodyData {
    kind,
    fixed_rotation,
    mass,
    inertia,
    force,
    torque,
    linear_damping,
    angular_damping,
    mu,
    user_data,
});

impl Row for BodyData {}

impl BodyDef {
    /// Whether a body can be like this.
    pub fn check(&self) -> Result<(), BodyError> {
        self.position.checked()?;
        self.angle.checked()?;
        self.velocity.checked()?;
        self.angular_velocity.checked()?;
        self.data().check(self.velocity, self.angular_velocity)
    }

    pub(crate) fn data(&self) -> BodyData {
        BodyData {
            kind: self.kind,
            fixed_rotation: self.fixed_rotation,
            mass: self.mass,
            inertia: self.inertia,
            force: self.force,
            torque: self.torque,
            linear_damping: self.linear_damping,
            angular_damping: self.angular_damping,
            mu: self.mu,
            user_data: self.user_data,
        }
    }
}

impl BodyData {
    pub(crate) fn is_dynamic(&self) -> bool {
        self.kind == BodyKind::Dynamic
    }

    /// Whether forces turn it.
    pub(crate) fn turns(&self) -> bool {
        self.is_dynamic() && !self.fixed_rotation
    }

    /// Ranges of its own values, and what its kind allows of them and of its velocities.
    pub(crate) fn check(&self, velocity: Vec2<Velocity>, omega: AngularVelocity) -> Result<(), BodyError> {
        let BodyData {
            kind, fixed_rotation, mass, inertia, force, torque, linear_damping, angular_damping, mu, ..
        } = self;
        mass.checked()?;
        inertia.checked()?;
        force.checked()?;
        torque.checked()?;
        linear_damping.checked()?;
        angular_damping.checked()?;
        mu.checked()?;
        let only = |allowed: bool, zero: bool, quantity| {
            if allowed || zero { Ok(()) } else { Err(BodyError::Kind { quantity, kind: *kind }) }
        };
        let moves = *kind != BodyKind::Static;
        only(moves, velocity.is_zero(), Velocity::NAME)?;
        only(moves, omega == AngularVelocity::ZERO, AngularVelocity::NAME)?;
        only(self.is_dynamic(), force.is_zero(), Force::NAME)?;
        only(self.is_dynamic(), *torque == Torque::ZERO, Torque::NAME)?;
        only(self.is_dynamic(), *linear_damping == Damping::ZERO, Damping::NAME)?;
        only(self.is_dynamic(), *angular_damping == Damping::ZERO, Damping::NAME)?;
        if *fixed_rotation && omega != AngularVelocity::ZERO {
            return Err(BodyError::FixedRotation { quantity: AngularVelocity::NAME });
        }
        if *fixed_rotation && *torque != Torque::ZERO {
            return Err(BodyError::FixedRotation { quantity: Torque::NAME });
        }
        Ok(())
    }
}
