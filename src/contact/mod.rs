//! Contacts: what persists of two colliders that touch, which of them do in this tick, and what a game is told of it.

mod end;
mod event;
mod find;
mod island;
mod look;
mod proxy;
mod row;
mod search;
#[cfg(test)]
mod tests;
mod wake;
mod ways;

pub(crate) use event::name;
pub use event::{Collision, Event, EventId, EventKind, Pace};
pub(crate) use find::{Margins, NEW, Pair, Touch};
pub(crate) use island::Resting;
pub(crate) use row::{Contact, Contacts};
