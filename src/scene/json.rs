//! The shape of a scene file.

use super::collider::ColliderJson;
use super::number::{Number, Pair};
use super::object::Object;
use crate::body::{Attractor, BodyDef, BodyKind, Sleeping};
use crate::motion::Integrator;
use crate::num::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Force, Friction, Impulse, Inertia, Length, Mass, Mu,
    Radians, RangeError, Restitution, Time, Torque, Velocity,
};
use crate::world::WorldDef;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneJson {
    pub(super) name: String,
    pub(super) tick_rate: u32,
    pub(super) bodies: Vec<Object<BodyJson>>,
    #[serde(default = "substeps")]
    pub(super) substeps: u32,
    #[serde(default)]
    pub(super) unit_shift: u32,
    #[serde(default, deserialize_with = "sleeping")]
    pub(super) sleeping: Option<Sleeping>,
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

fn substeps() -> u32 {
    WorldDef::default().substeps
}

fn six_hundred() -> u64 {
    600
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SleepingJson {
    #[serde(default, deserialize_with = "some")]
    speed: Option<Number<Velocity>>,
    #[serde(default, deserialize_with = "some")]
    time: Option<Number<Time>>,
}

/// Whether bodies sleep, or from when on: an object.
fn sleeping<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Sleeping>, D::Error> {
    struct Switch;

    impl<'de> Visitor<'de> for Switch {
        type Value = Option<Sleeping>;

        fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            f.write_str("true, false or an object")
        }

        fn visit_bool<E: Error>(self, on: bool) -> Result<Self::Value, E> {
            Ok(on.then(Sleeping::default))
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            let keys = SleepingJson::deserialize(MapAccessDeserializer::new(map))?;
            let Sleeping { speed, time } = Sleeping::default();
            let (speed, time) = (keys.speed.map_or(speed, |speed| speed.0), keys.time.map_or(time, |time| time.0));
            Ok(Some(Sleeping { speed, time }))
        }
    }

    deserializer.deserialize_any(Switch)
}

/// Declares a word of the file that stands for one of some values: text only, by these spellings.
macro_rules! word {
    ($(#[$doc:meta])* $name:ident($value:ty) = $default:expr; $($text:literal => $meaning:expr),* $(,)?) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(super) struct $name(pub(super) $value);

        impl Default for $name {
            fn default() -> Self {
                $name($default)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = String::deserialize(deserializer)?;
                match text.as_str() {
                    $($text => Ok($name($meaning)),)*
                    _ => Err(D::Error::unknown_variant(&text, &[$($text),*])),
                }
            }
        }
    };
}

word! {
    /// How motion is integrated.
    IntegratorJson(Integrator) = Integrator::ForestRuth;
    "forest_ruth" => Integrator::ForestRuth,
    "symplectic_euler" => Integrator::SymplecticEuler,
}

word! {
    /// What moves a body.
    KindJson(BodyKind) = BodyKind::Dynamic;
    "static" => BodyKind::Static,
    "kinematic" => BodyKind::Kinematic,
    "dynamic" => BodyKind::Dynamic,
}

/// A value that may be left out; `null` is none.
pub(super) fn some<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyJson {
    #[serde(default, deserialize_with = "some")]
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
    #[serde(default, deserialize_with = "some")]
    mass: Option<Number<Mass>>,
    #[serde(default, deserialize_with = "some")]
    inertia: Option<Number<Inertia>>,
    #[serde(default, deserialize_with = "some")]
    center: Option<Pair<Length>>,
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
    #[serde(default = "yes")]
    allow_sleep: bool,
    #[serde(default)]
    colliders: Vec<ColliderJson>,
}

impl BodyJson {
    pub(super) fn def(&self) -> BodyDef {
        BodyDef {
            kind: self.kind.0,
            position: self.position.0,
            angle: self.angle.0,
            velocity: self.velocity.0,
            angular_velocity: self.angular_velocity.0,
            force: self.force.0,
            torque: self.torque.0,
            mass: self.mass.map(|mass| mass.0),
            inertia: self.inertia.map(|inertia| inertia.0),
            center: self.center.map(|center| center.0),
            fixed_rotation: self.fixed_rotation,
            linear_damping: self.linear_damping.0,
            angular_damping: self.angular_damping.0,
            mu: self.mu.0,
            user_data: self.user_data,
            allow_sleep: self.allow_sleep,
            colliders: self.colliders.iter().map(|collider| collider.0.clone()).collect(),
        }
    }
}

fn yes() -> bool {
    true
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AttractorJson {
    #[serde(default, deserialize_with = "some")]
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

/// Declares the commands of a script: an object with one key, the command's name, whose value is an object as well.
macro_rules! actions {
    ($($text:literal => $name:ident $({ $($(#[$attribute:meta])* $field:ident: $type:ty),* $(,)? })? $(($json:ty))?),* $(,)?) => {
        #[allow(clippy::large_enum_variant, reason = "as `Command`: a box would cost each creation")]
        pub(super) enum Action {
            $($name(actions!(@type $name $(($json))?)),)*
        }

        $($(
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            pub(super) struct $name {
                $($(#[$attribute])* pub(super) $field: $type,)*
            }
        )?)*

        struct ActionVisitor;

        impl<'de> Visitor<'de> for ActionVisitor {
            type Value = Action;

            fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str("an object with one command")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Action, A::Error> {
                let name: String = map.next_key()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
                let action = match name.as_str() {
                    $($text => Action::$name(map.next_value::<Object<_>>()?.0),)*
                    _ => return Err(A::Error::unknown_variant(&name, &[$($text),*])),
                };
                match map.next_key::<String>()? {
                    None => Ok(action),
                    Some(_) => Err(A::Error::invalid_length(2, &self)),
                }
            }
        }

        impl<'de> Deserialize<'de> for Action {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_map(ActionVisitor)
            }
        }
    };
    (@type $name:ident) => { $name };
    (@type $name:ident ($json:ty)) => { $json };
}

actions! {
    "create_body" => CreateBody(BodyJson),
    "destroy_body" => DestroyBody { body: Reference },
    "set_kind" => SetKind { body: Reference, kind: KindJson },
    "set_position" => SetPosition { body: Reference, position: Pair<Length> },
    "set_angle" => SetAngle { body: Reference, angle: Phi },
    "set_velocity" => SetVelocity { body: Reference, velocity: Pair<Velocity> },
    "set_angular_velocity" => SetAngularVelocity { body: Reference, angular_velocity: Number<AngularVelocity> },
    "set_force" => SetForce { body: Reference, force: Pair<Force> },
    "set_torque" => SetTorque { body: Reference, torque: Number<Torque> },
    "set_mass" => SetMass {
        body: Reference,
        mass: Number<Mass>,
        #[serde(default, deserialize_with = "some")]
        inertia: Option<Number<Inertia>>,
    },
    "set_fixed_rotation" => SetFixedRotation { body: Reference, fixed: bool },
    "set_damping" => SetDamping { body: Reference, linear: Number<Damping>, angular: Number<Damping> },
    "set_mu" => SetMu { body: Reference, mu: Number<Mu> },
    "set_user_data" => SetUserData { body: Reference, user_data: u64 },
    "apply_force" => ApplyForce {
        body: Reference,
        force: Pair<Force>,
        #[serde(default, deserialize_with = "some")]
        point: Option<Pair<Length>>,
    },
    "apply_torque" => ApplyTorque { body: Reference, torque: Number<Torque> },
    "apply_impulse" => ApplyImpulse {
        body: Reference,
        impulse: Pair<Impulse>,
        #[serde(default, deserialize_with = "some")]
        point: Option<Pair<Length>>,
    },
    "apply_angular_impulse" => ApplyAngularImpulse { body: Reference, impulse: Number<AngularImpulse> },
    "create_attractor" => CreateAttractor(AttractorJson),
    "set_attractor" => SetAttractor { attractor: Reference, position: Pair<Length>, mu: Number<Mu> },
    "destroy_attractor" => DestroyAttractor { attractor: Reference },
    "set_gravity" => SetGravity { gravity: Pair<Acceleration> },
    "set_surface" => SetSurface {
        body: Reference,
        #[serde(default)]
        collider: u32,
        restitution: Number<Restitution>,
        friction: Number<Friction>,
    },
    "set_filter" => SetFilter {
        body: Reference,
        #[serde(default)]
        collider: u32,
        category: u32,
        mask: u32,
    },
    "set_allow_sleep" => SetAllowSleep { body: Reference, allow: bool },
    "wake" => Wake { body: Reference },
    "put_to_sleep" => PutToSleep { body: Reference },
    "clear_status" => ClearStatus {},
    "input" => Input { text: String },
}
