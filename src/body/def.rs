//! What a body is made of, and what of it is accepted.

use super::colliders::center_at;
use crate::geom::Vec2;
use crate::num::{
    Angle, AngularVelocity, Damping, Density, Force, Inertia, Length, Mass, Mu, Quantity, RangeError, Torque, Velocity,
    mul_div, sqrt,
};
use crate::shape::{ColliderDef, MassData, ShapeError};
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

record_enum!(BodyKind { 0 => Static {}, 1 => Kinematic {}, 2 => Dynamic {} } shown);

/// A body to create. `BodyDef::default()` is a dynamic body at rest at the origin, without colliders.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BodyDef {
    /// What moves it.
    pub kind: BodyKind,
    /// Its origin.
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
    /// Kept for every kind; what it means, it means while the body is dynamic. `None`: that of its colliders by their
    /// densities, or 1 kg.
    pub mass: Option<Mass>,
    /// About the centre of mass; as `mass`. `None`: that of its colliders, scaled to its mass, or mass times 1 m².
    pub inertia: Option<Inertia>,
    /// The centre of mass, in the body's axes from its origin. `None`: the origin when mass and inertia are both given,
    /// else that of its colliders, or the origin.
    pub center: Option<Vec2<Length>>,
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
    /// Whether it may fall asleep, if the world has sleeping: it keeps awake what hangs together with it if not.
    pub allow_sleep: bool,
    /// What of it collides. A body without colliders only moves.
    pub colliders: Vec<ColliderDef>,
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
            mass: None,
            inertia: None,
            center: None,
            fixed_rotation: false,
            linear_damping: Damping::ZERO,
            angular_damping: Damping::ZERO,
            mu: Mu::ZERO,
            user_data: 0,
            allow_sleep: true,
            colliders: Vec::new(),
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
    center,
    fixed_rotation,
    linear_damping,
    angular_damping,
    mu,
    user_data,
    allow_sleep,
    colliders,
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
    /// One of its colliders cannot be like this.
    Collider {
        /// Which, from 0, in the order given.
        index: u32,
        /// Why.
        error: ShapeError,
    },
    /// A moment of inertia that does not fit what collides: the radius of gyration √(I/m) of a body that may turn must
    /// be at least 1/120 of the distance of its farthest collider's farthest point from the centre of mass.
    Gyration {
        /// The radius of gyration.
        radius: Length,
        /// That farthest distance.
        reach: Length,
    },
    /// A centre of mass farther than 16 000 m from the origin.
    Center {
        /// The coordinate.
        value: Length,
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
            BodyError::Collider { index, error } => write!(f, "colliders[{index}]: {error}"),
            BodyError::Gyration { radius, reach } => {
                write!(f, "a radius of gyration of {radius} m is below 1/120 of the colliders' reach of {reach} m")
            }
            BodyError::Center { value } => write!(f, "center coordinate {value} m is outside ±16000 m"),
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
    /// The centre of mass from the origin, in the body's axes.
    pub(crate) center: Vec2<Length>,
    /// The greatest distance of a point of its colliders, sensors excepted, from the centre of mass; 0 without any.
    pub(crate) reach: Length,
    /// The slot of its first collider.
    pub(crate) first: Option<u32>,
    pub(crate) force: Vec2<Force>,
    pub(crate) torque: Torque,
    pub(crate) linear_damping: Damping,
    pub(crate) angular_damping: Damping,
    pub(crate) mu: Mu,
    pub(crate) user_data: u64,
    pub(crate) allow_sleep: bool,
}

record!(BodyData {
    kind,
    fixed_rotation,
    mass,
    inertia,
    center,
    reach,
    first,
    force,
    torque,
    linear_damping,
    angular_damping,
    mu,
    user_data,
    allow_sleep,
} shown);

impl Row for BodyData {}

impl BodyDef {
    /// Whether a body can be like this.
    pub fn check(&self) -> Result<(), BodyError> {
        self.data().map(drop)
    }

    /// The cold row of the body, without its colliders, if a body can be like this.
    pub(crate) fn data(&self) -> Result<BodyData, BodyError> {
        self.position.checked()?;
        self.angle.checked()?;
        self.velocity.checked()?;
        self.angular_velocity.checked()?;
        for (index, collider) in self.colliders.iter().enumerate() {
            collider.check().map_err(|error| BodyError::Collider { index: index as u32, error })?;
        }
        let (mass, inertia, center) = self.resolved()?;
        let solid = self.colliders.iter().filter(|collider| !collider.sensor);
        let reach = solid.map(|c| c.shape.outline(c.offset, c.angle, center).reach).max().unwrap_or(0);
        let data = BodyData {
            kind: self.kind,
            fixed_rotation: self.fixed_rotation,
            mass,
            inertia,
            center,
            reach: Length::from_bits(reach),
            first: None,
            force: self.force,
            torque: self.torque,
            linear_damping: self.linear_damping,
            angular_damping: self.angular_damping,
            mu: self.mu,
            user_data: self.user_data,
            allow_sleep: self.allow_sleep,
        };
        data.check(self.velocity, self.angular_velocity)?;
        center_at(self.position, center, self.angle).checked()?;
        Ok(data)
    }

    /// Mass, inertia and centre of mass: what is given, and the rest from the colliders.
    fn resolved(&self) -> Result<(Mass, Inertia, Vec2<Length>), BodyError> {
        let solid = MassData::of(&self.colliders);
        let any = solid.mass > 0;
        let mass = match self.mass {
            Some(mass) => mass,
            None if any => Mass::from_bits(solid.mass),
            None => Mass::from_bits(1 << 64),
        };
        mass.checked()?;
        let center = match (self.center, self.mass, self.inertia) {
            (Some(center), _, _) => center,
            (None, Some(_), Some(_)) => Vec2::default(),
            (None, _, _) => solid.center,
        };
        check_center(center)?;
        let inertia = match self.inertia {
            Some(inertia) => inertia,
            // Of the same distribution of mass: I is in the ratio of the masses.
            None if any => {
                let solid = self.enlarged(solid.mass);
                Inertia::from_bits(mul_div(solid.about(center), mass.to_bits(), solid.mass))
            }
            None => Inertia::from_bits(mass.to_bits()),
        };
        inertia.checked()?;
        Ok((mass, inertia, center))
    }

    /// The colliders' masses with all densities multiplied by a power of two, so that I/m of a small body keeps its
    /// digits: m has about 90 bits then, and I, m·r² with r below 2¹⁵ m, less than 121.
    fn enlarged(&self, mass: i128) -> MassData {
        let bits = |value: i128| 128u32.saturating_sub(value.leading_zeros());
        let densest = self.colliders.iter().map(|c| c.density.to_bits()).max().unwrap_or(1);
        let up = 90u32.saturating_sub(bits(mass)).min(126u32.saturating_sub(bits(densest)));
        let mut colliders = self.colliders.clone();
        for collider in &mut colliders {
            collider.density = Density::from_bits(collider.density.to_bits() << up);
        }
        MassData::of(&colliders)
    }
}

fn check_center(center: Vec2<Length>) -> Result<(), BodyError> {
    const MAX: u64 = 16_000 << 32;
    match [center.x, center.y].into_iter().find(|value| value.to_bits().unsigned_abs() > MAX) {
        Some(value) => Err(BodyError::Center { value }),
        None => Ok(()),
    }
}

/// The radius of gyration √(I/m) in Q32 m; saturates at 2³¹·⁵ m.
pub(crate) fn gyration(mass: Mass, inertia: Inertia) -> u64 {
    sqrt(mul_div(inertia.to_bits(), 1 << 64, mass.to_bits()).unsigned_abs())
}

impl BodyData {
    pub(crate) fn is_dynamic(&self) -> bool {
        self.kind == BodyKind::Dynamic
    }

    /// Whether forces turn it.
    pub(crate) fn turns(&self) -> bool {
        self.is_dynamic() && !self.fixed_rotation
    }

    /// Whether its inertia fits its colliders, were it of this kind.
    pub(crate) fn check_gyration(&self, kind: BodyKind, fixed_rotation: bool) -> Result<(), BodyError> {
        let radius = gyration(self.mass, self.inertia);
        let turns = kind == BodyKind::Dynamic && !fixed_rotation;
        if turns && radius.saturating_mul(120) < self.reach.to_bits().unsigned_abs() {
            return Err(BodyError::Gyration { radius: Length::from_bits(radius as i64), reach: self.reach });
        }
        Ok(())
    }

    /// Ranges of its own values, and what its kind allows of them and of its velocities.
    pub(crate) fn check(&self, velocity: Vec2<Velocity>, omega: AngularVelocity) -> Result<(), BodyError> {
        let BodyData {
            kind,
            fixed_rotation,
            mass,
            inertia,
            center,
            force,
            torque,
            linear_damping,
            angular_damping,
            mu,
            ..
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
        check_center(*center)?;
        self.check_gyration(*kind, *fixed_rotation)
    }
}
