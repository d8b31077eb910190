//! What a step tells of contacts.

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
