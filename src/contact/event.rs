//! What a step tells of contacts.

use crate::geom::Vec2;
use crate::num::{AngularVelocity, Impulse, Length, Time, Velocity};
use crate::store::ColliderId;
use core::fmt;
use serde::{Deserialize, Serialize};

/// What happened to a pair of colliders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum EventKind {
    /// They began to touch: they overlapped when the step began, or pushed each other in it.
    ContactBegin,
    /// They no longer touch, or one of them is gone.
    ContactEnd,
    /// A sensor and another collider began to overlap; looked at when the step begins.
    SensorBegin,
    /// A sensor and another collider no longer overlap, or one of them is gone.
    SensorEnd,
}

impl fmt::Display for EventKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            EventKind::ContactBegin => "contact_begin",
            EventKind::ContactEnd => "contact_end",
            EventKind::SensorBegin => "sensor_begin",
            EventKind::SensorEnd => "sensor_end",
        })
    }
}

/// An event of a step: a value, not state. Those of one step are ordered by the slots of `a`, then of `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// The collider in the lower slot; an id of a collider that is gone is no longer valid.
    pub a: ColliderId,
    /// The other one.
    pub b: ColliderId,
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} and {}", self.kind, self.a, self.b)
    }
}

/// How fast a body is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Pace {
    /// Of its centre of mass.
    pub velocity: Vec2<Velocity>,
    /// Counter-clockwise positive.
    pub angular_velocity: AngularVelocity,
}

/// A collision of a step, answered at its time (IM:col2D): a value, not state. Those of one step are in the order in which
/// they happened. What rests, or comes together too slowly to bounce, has none: rows hold it; nor has what comes together
/// without restitution from less than 2 cm while both bodies touch others. [`Event`](crate::Event)s tell of those.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Collision {
    /// The collider in the lower slot; an id of a collider that is gone is no longer valid.
    pub a: ColliderId,
    /// The other one.
    pub b: ColliderId,
    /// Which answer of the step it belongs to, from 0 on: contacts that meet at one time are answered together.
    pub order: u32,
    /// t_c, since the step began: 0 to 1/tick_rate.
    pub time: Time,
    /// Where the impulse acts; between two points by their shares of it. Rounding: to nearest.
    pub point: Vec2<Length>,
    /// From b to a, unit, 30 fraction bits.
    pub normal: [i32; 2],
    /// On a, friction included; b gets the negative. Rounding: 2⁻⁴⁷ of it and 2⁻⁴⁸ m/s times the lesser mass. A body that the
    /// status names for its impacts or its speed may have got less.
    pub impulse: Vec2<Impulse>,
    /// The bodies of a and of b before the answer.
    pub before: [Pace; 2],
    /// And after all of it: the contacts of one order share their bodies' changes.
    pub after: [Pace; 2],
}
