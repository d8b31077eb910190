//! What became of the pairs of a tick: contacts that last, and what a game is told, piece by piece.

use super::event::{Event, EventKind};
use super::find::{NEW, Pair};
use super::row::{Contact, Contacts};
use crate::body::Colliders;
use crate::threads::Cut;
use core::ops::Range;

/// Pairs in order, and those contacts of the last tick that come from the first of them on, before what comes behind.
pub(super) struct Ending<'t> {
    pub(super) pairs: &'t [Pair],
    pub(super) contacts: &'t Contacts,
    pub(super) old: Range<usize>,
    pub(super) colliders: &'t Colliders,
}

/// What a piece gave.
#[derive(Debug, Default)]
pub(super) struct Kept {
    pub(super) contacts: Contacts,
    pub(super) events: Vec<Event>,
}

impl Cut for Ending<'_> {
    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let Ending { pairs, contacts, old, colliders } = self;
        let (before, pairs) = pairs.split_at(at);
        let first = pairs.first().map(|pair| (pair.colliders[0], pair.colliders[1]));
        let middle = first.map_or(old.end, |first| contacts.place_of(first).clamp(old.start, old.end));
        let part = |pairs, old| Ending { pairs, contacts, old, colliders };
        (part(before, old.start..middle), part(pairs, middle..old.end))
    }
}

impl Ending<'_> {
    pub(super) fn run(self, kept: &mut Kept, outcome: &impl Fn(&Pair) -> Contact) {
        let Ending { pairs, contacts, old: Range { start: mut old, end: last }, colliders } = self;
        let Kept { contacts: next, events } = kept;
        next.clear();
        events.clear();
        let end = |contact: Contact, events: &mut Vec<Event>| {
            if contact.touching {
                let kind = if contact.sensor { EventKind::SensorEnd } else { EventKind::ContactEnd };
                events.push(Event { tick: 0, kind, a: contact.a, b: contact.b });
            }
        };
        for pair in pairs {
            let [a, b] = pair.colliders;
            while old < last && (old as u32 != pair.old && contacts.key(old) <= (a, b)) {
                end(contacts.get(old), events);
                old = old.saturating_add(1);
            }
            let before = if pair.old == NEW { Contact::default() } else { contacts.get(old) };
            old = old.saturating_add(usize::from(pair.old != NEW));
            let (a, b) = (colliders.id(a as usize), colliders.id(b as usize));
            let contact = if pair.sensor {
                Contact { a, b, touching: true, sensor: true, ..Contact::default() }
            } else if pair.stays {
                before
            } else {
                Contact { a, b, ..outcome(pair) }
            };
            match (before.touching, contact.touching) {
                (false, true) if contact.sensor => events.push(Event { tick: 0, kind: EventKind::SensorBegin, a, b }),
                (false, true) => events.push(Event { tick: 0, kind: EventKind::ContactBegin, a, b }),
                (true, false) => end(before, events),
                _ => {}
            }
            if contact.lasts() {
                next.push(&contact);
            }
        }
        for at in old..last {
            end(contacts.get(at), events);
        }
    }
}
