//! Looking at the candidates of a tick: in pieces, which have what was seen of them in the last tick.

use super::find::{Margins, NEW, Pair};
use super::look::{Look, See, Seen};
use super::proxy::Proxies;
use super::row::Contacts;
use crate::body::Bodies;
use crate::motion::Drive;
use crate::threads::Cut;

/// Candidates whose boxes overlap, ordered by colliders.
pub(super) struct Search<'t> {
    pub(super) candidates: &'t [(u32, u32)],
    /// Which of them.
    pub(super) close: &'t [u32],
    pub(super) seen: Seen<'t>,
    pub(super) view: View<'t>,
}

/// What they are looked at by.
#[derive(Clone, Copy)]
pub(super) struct View<'t> {
    pub(super) proxies: &'t Proxies,
    pub(super) bodies: &'t Bodies,
    pub(super) contacts: &'t Contacts,
    pub(super) drive: &'t Drive,
    pub(super) margins: Margins,
}

/// What a piece gave: pairs, what was seen of those that were not seen in the last tick, and how many of the others were.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) pairs: Vec<Pair>,
    pub(super) added: Vec<Look>,
    pub(super) kept: usize,
    /// Of how many looks.
    pub(super) of: usize,
}

impl Cut for Search<'_> {
    fn len(&self) -> usize {
        self.close.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let Search { candidates, close, seen, view } = self;
        let (before, close) = close.split_at(at);
        let first = close.first().map(|&at| candidates[at as usize]);
        let (seen_before, seen) = seen.cut_before(first);
        let part = |close, seen| Search { candidates, close, seen, view };
        (part(before, seen_before), part(close, seen))
    }
}

impl Search<'_> {
    pub(super) fn run(self, found: &mut Found) {
        let Search { candidates, close, mut seen, view } = self;
        let View { proxies, bodies, contacts, drive, margins } = view;
        let Found { pairs, added, kept, of } = found;
        pairs.clear();
        added.clear();
        let first = close.first().map(|&at| candidates[at as usize]);
        let mut old = first.map_or(0, |first| contacts.place_of(first));
        for &at in close {
            let (a, b) = candidates[at as usize];
            let slots = [a as usize, b as usize];
            let see = See { proxies, slots, bodies, drive, margins };
            let look = seen.next([a, b], added);
            let Some(manifold) = see.meet(look) else {
                continue;
            };
            let known = look.tick < proxies.now();
            let proxies = slots.map(|slot| proxies.get(slot));
            while old < contacts.len() && contacts.key(old) < (a, b) {
                old = old.saturating_add(1);
            }
            let lasts = old < contacts.len() && contacts.ids(old) == (proxies[0].id, proxies[1].id);
            let old = if lasts { old as u32 } else { NEW };
            pairs.push(Pair { known, ..Pair::new([a, b], proxies, manifold, old) });
        }
        (*kept, *of) = (seen.kept(), seen.len());
    }
}
