//! What a step tells of contacts.

use crate::geom::Vec2;
use crate::num::{AngularVelocity, Impulse, Length, Time, Velocity};
use crate::store::ColliderId;
use core::fmt;
use serde::{Deserialize, Serialize};

/// What an event or a collision is called: the same in every simulation of its tick in which it happens, and on every
/// machine, so that a game can tell whether it has heard of it. [`EventLog`](crate::EventLog) does so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct EventId {
    /// The tick in whose step it happens: that of the world before it.
    pub tick: u64,
    /// The collider in the lower slot.
    pub a: ColliderId,
    /// The other one.
    pub b: ColliderId,
    /// What happens.
    pub kind: EventKind,
    /// Which of that kind between the two in that tick, from 0 on.
    pub ordinal: u32,
}

impl fmt::Display for EventId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let EventId { tick, a, b, kind, ordinal } = self;
        write!(f, "{kind} {ordinal} of {a} and {b} in tick {tick}")
    }
}

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
    /// They collided: the kind that ids of [`Collision`]s have, and no [`Event`] has.
    Collision,
}

impl fmt::Display for EventKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            EventKind::ContactBegin => "contact_begin",
            EventKind::ContactEnd => "contact_end",
            EventKind::SensorBegin => "sensor_begin",
            EventKind::SensorEnd => "sensor_end",
            EventKind::Collision => "collision",
        })
    }
}

/// An event of a step: a value, not state. Those of one step are ordered by the slots of `a`, then of `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Event {
    /// The tick in whose step it happened: that of the world before it.
    pub tick: u64,
    /// What happened.
    pub kind: EventKind,
    /// The collider in the lower slot; an id of a collider that is gone is no longer valid.
    pub a: ColliderId,
    /// The other one.
    pub b: ColliderId,
}

impl Event {
    /// Its id. Of one kind there is at most one event of a pair in a tick.
    pub fn id(&self) -> EventId {
        let Event { tick, kind, a, b } = *self;
        EventId { tick, a, b, kind, ordinal: 0 }
    }
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
    /// The tick in whose step it happened: that of the world before it.
    pub tick: u64,
    /// Which of the two colliders' collisions in that tick it is, from 0 on.
    pub ordinal: u32,
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

impl Collision {
    /// Its id.
    pub fn id(&self) -> EventId {
        let Collision { tick, ordinal, a, b, .. } = *self;
        EventId { tick, a, b, kind: EventKind::Collision, ordinal }
    }
}

/// Gives what a step told its tick, and collisions their ordinals; `space` is some.
pub(crate) fn name(tick: u64, events: &mut [Event], collisions: &mut [Collision], space: &mut Vec<u32>) {
    events.iter_mut().for_each(|event| event.tick = tick);
    space.clear();
    space.extend(0..collisions.len() as u32);
    let pair = |collisions: &[Collision], at: u32| (collisions[at as usize].a, collisions[at as usize].b);
    space.sort_unstable_by_key(|&at| (pair(collisions, at), at));
    let mut last = None;
    for &at in &*space {
        let of = pair(collisions, at);
        let ordinal = match last {
            Some((known, ordinal)) if known == of => u32::saturating_add(ordinal, 1),
            _ => 0,
        };
        let collision = &mut collisions[at as usize];
        (collision.tick, collision.ordinal) = (tick, ordinal);
        last = Some((of, ordinal));
    }
}
