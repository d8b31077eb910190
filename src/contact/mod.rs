//! Contacts: what persists of two colliders that touch, which of them do in this tick, and what a game is told of it.

mod event;
mod find;
mod row;
mod ways;

pub use event::{Collision, Event, EventKind, Pace};
pub(crate) use find::{Margins, NEW, Pair, Touch};
pub(crate) use row::{Contact, Contacts};
