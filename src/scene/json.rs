//! The shape of a scene file.

use super::number::{Number, Pair};
use super::object::Object;
use crate::body::{Attractor, BodyDef, BodyKind};
use crate::motion::Integrator;
use crate::num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Force, Impulse, Inertia, Length, Mass, Mu, Radians,
    RangeError, Torque, Velocity,
};
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneJson {
    pub(super) name: String,
    pub(super) tick_rate: u32,
    pub(super) bodies: Vec<Object<BodyJson>>,
    #[serde(default = "four")]
    pub(super) substeps: u32,
    #[serde(default)]
    pub(super) integrator: IntegratorJson,
    #[serde(default)]
    pub(super) gravity: Pair<Acceleration>,
    #[serde(default)]
    pub(super) attractors: Vec<Object<AttractorJson>>,
    #[serde(default)]
    pub(super) commands: Vec<Object<CommandJson>>,
    #[serde(default = "six_hundred")]
    pub(super) ticks: u64,
    #[serde(default)]
    pub(super) about: String,
}

fn four() -> u32 {
    4
}

fn six_hundred() -> u64 {
    600
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum IntegratorJson {
    #[default]
    ForestRuth,
    SymplecticEuler,
}

impl From<IntegratorJson> for Integrator {
    fn from(integrator: IntegratorJson) -> Self {
        match integrator {
            IntegratorJson::ForestRuth => Integrator::ForestRuth,
            IntegratorJson::SymplecticEuler => Integrator::SymplecticEuler,
        }
    }
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum KindJson {
    Static,
    Kinematic,
    #[default]
    Dynamic,
}

impl From<KindJson> for BodyKind {
    fn from(kind: KindJson) -> Self {
        match kind {
            KindJson::Static => BodyKind::Static,
            KindJson::Kinematic => BodyKind::Kinematic,
            KindJson::Dynamic => BodyKind::Dynamic,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyJson {
    #[serde(default)]
    pub(super) name: Option<String>,
    #[serde(default)]
    kind: KindJson,
    #[serde(default)]
    position: Pair<Length>,
    #[serde(default)]
    angle: Phi,
    #[serde(default)]
    velocity: Pair<Velocity>,
    #[serde(default)]
    angular_velocity: Number<AngularVelocity>,
    #[serde(default)]
    force: Pair<Force>,
    #[serde(default)]
    torque: Number<Torque>,
    #[serde(default)]
    mass: Option<Number<Mass>>,
    #[serde(default)]
    inertia: Option<Number<Inertia>>,
    #[serde(default)]
    fixed_rotation: bool,
    #[serde(default)]
    linear_damping: Number<Damping>,
    #[serde(default)]
    angular_damping: Number<Damping>,
    #[serde(default)]
    mu: Number<Mu>,
    #[serde(default)]
    user_data: u64,
    #[serde(default, rename = "colliders")]
    _colliders: NoColliders,
}

impl BodyJson {
    pub(super) fn def(&self) -> BodyDef {
        let mass = self.mass.map_or(BodyDef::default().mass, |mass| mass.0);
        BodyDef {
            kind: self.kind.into(),
            position: self.position.0,
            angle: self.angle.0,
            velocity: self.velocity.0,
            angular_velocity: self.angular_velocity.0,
            force: self.force.0,
            torque: self.torque.0,
            mass,
            inertia: inertia(self.inertia, mass),
            fixed_rotation: self.fixed_rotation,
            linear_damping: self.linear_damping.0,
            angular_damping: self.angular_damping.0,
            mu: self.mu.0,
            user_data: self.user_data,
        }
    }
}

/// The inertia given, or that of the mass at a radius of gyration of 1 m.
pub(super) fn inertia(given: Option<Number<Inertia>>, mass: Mass) -> Inertia {
    given.map_or(Inertia::from_bits(mass.to_bits()), |inertia| inertia.0)
}

/// An orientation φ given in radians in [0, 2π].
#[derive(Clone, Copy, Default)]
pub(super) struct Phi(pub(super) Angle);

impl<'de> Deserialize<'de> for Phi {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Number(radians) = Number::<Radians>::deserialize(deserializer)?;
        Angle::from_radians(radians).map(Phi).map_err(|error: RangeError| D::Error::custom(error))
    }
}

/// The place where colliders will be: for now an empty list.
#[derive(Clone, Copy, Default)]
pub(super) struct NoColliders;

impl<'de> Deserialize<'de> for NoColliders {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Empty;
        impl<'de> Visitor<'de> for Empty {
            type Value = NoColliders;

            fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str("a list of colliders")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<NoColliders, A::Error> {
                match seq.next_element::<serde::de::IgnoredAny>()? {
                    None => Ok(NoColliders),
                    Some(_) => Err(A::Error::custom("this version has no colliders, only an empty list is accepted")),
                }
            }
        }
        deserializer.deserialize_seq(Empty)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AttractorJson {
    #[serde(default)]
    pub(super) name: Option<String>,
    position: Pair<Length>,
    mu: Number<Mu>,
}

impl AttractorJson {
    pub(super) fn attractor(&self) -> Attractor {
        Attractor { position: self.position.0, mu: self.mu.0 }
    }
}

/// A name, or an index in order of creation.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a name or an index was expected")]
pub(super) enum Reference {
    Index(u32),
    Name(String),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CommandJson {
    pub(super) tick: u64,
    #[serde(rename = "do")]
    pub(super) action: Action,
}

/// The commands of a script, by the names that [`crate::Command`] has for them.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[allow(clippy::large_enum_variant, reason = "a script is read once")]
pub(super) enum Action {
    CreateBody(Object<BodyJson>),
    DestroyBody { body: Reference },
    SetKind { body: Reference, kind: KindJson },
    SetPosition { body: Reference, position: Pair<Length> },
    SetAngle { body: Reference, angle: Phi },
    SetVelocity { body: Reference, velocity: Pair<Velocity> },
    SetAngularVelocity { body: Reference, angular_velocity: Number<AngularVelocity> },
    SetForce { body: Reference, force: Pair<Force> },
    SetTorque { body: Reference, torque: Number<Torque> },
    SetMass { body: Reference, mass: Number<Mass>, inertia: Option<Number<Inertia>> },
    SetFixedRotation { body: Reference, fixed: bool },
    SetDamping { body: Reference, linear: Number<Damping>, angular: Number<Damping> },
    SetMu { body: Reference, mu: Number<Mu> },
    SetUserData { body: Reference, user_data: u64 },
    ApplyForce { body: Reference, force: Pair<Force>, point: Option<Pair<Length>> },
    ApplyTorque { body: Reference, torque: Number<Torque> },
    ApplyImpulse { body: Reference, impulse: Pair<Impulse>, point: Option<Pair<Length>> },
    ApplyAngularImpulse { body: Reference, impulse: Number<AngularImpulse> },
    CreateAttractor(Object<AttractorJson>),
    SetAttractor { attractor: Reference, position: Pair<Length>, mu: Number<Mu> },
    DestroyAttractor { attractor: Reference },
    SetGravity { gravity: Pair<Acceleration> },
    ClearStatus {},
    Input { text: String },
}
