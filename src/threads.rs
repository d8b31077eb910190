//! Several threads for one tick: how a loop is cut up, and who does the pieces.
//!
//! A loop goes in pieces if each item is written to a place of its own, or what it says is noted piece by piece and put
//! together in the order of the pieces. Then neither who does a piece nor how many there are shows in a bit. Stages are written
//! once, for a [`Crew`]: without the feature `threads` that is nobody else, and a loop is a loop.
//!
//! What waits is not put to sleep while a tick lasts. Waking it takes 8 µs of the thread that works, and 20 until it is there,
//! which is as long as most loops take; a loop that is begun while the others look out for it costs 1 µs.

#[cfg(not(feature = "threads"))]
#[path = "threads/alone.rs"]
mod crew;
#[cfg(feature = "threads")]
#[path = "threads/pool.rs"]
mod crew;

use core::ops::Range;
pub(crate) use crew::Crew;
pub use crew::Threads;
#[cfg(feature = "threads")]
pub use crew::ThreadsError;

/// What can be cut in two: slices and tuples of them, and what stages make of such.
pub(crate) trait Cut: Send + Sized {
    fn len(&self) -> usize;

    /// The items before `at`, and those from there on.
    fn cut(self, at: usize) -> (Self, Self);
}

impl<T: Send> Cut for &mut [T] {
    fn len(&self) -> usize {
        (**self).len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<T: Sync> Cut for &[T] {
    fn len(&self) -> usize {
        (**self).len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl Cut for Range<usize> {
    fn len(&self) -> usize {
        self.end.saturating_sub(self.start)
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let middle = self.start.saturating_add(at);
        (self.start..middle, middle..self.end)
    }
}

/// Of the same length.
impl<A: Cut, B: Cut> Cut for (A, B) {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.cut(at), self.1.cut(at));
        ((a, b), (c, d))
    }
}

impl<A: Cut, B: Cut, C: Cut> Cut for (A, B, C) {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let ((a, d), (b, e), (c, f)) = (self.0.cut(at), self.1.cut(at), self.2.cut(at));
        ((a, b, c), (d, e, f))
    }
}

impl Crew {
    /// Does all items, in pieces of `least` items or more.
    #[inline]
    pub(crate) fn share<C: Cut>(self, whole: C, least: usize, work: impl Fn(C) + Sync) {
        match self.pieces(whole.len(), least) {
            0 | 1 => work(whole),
            pieces => split(whole, &mut vec![(); pieces], &|piece, ()| work(piece)),
        }
    }

    /// The same, where items add something to a list, in their order.
    #[inline]
    pub(crate) fn gather<C: Cut, T: Send>(
        self,
        whole: C,
        least: usize,
        list: &mut Vec<T>,
        work: impl Fn(C, &mut Vec<T>) + Sync,
    ) {
        match self.pieces(whole.len(), least) {
            0 | 1 => work(whole, list),
            pieces => {
                let mut lists: Vec<Vec<T>> = Vec::new();
                lists.resize_with(pieces, Vec::new);
                split(whole, &mut lists, &work);
                lists.iter_mut().for_each(|piece| list.append(piece));
            }
        }
    }

    /// The same, where each piece notes something: `notes` has one for each piece, in order, and maybe more of earlier times
    /// behind. How many pieces there are; never none.
    #[inline]
    pub(crate) fn note<C: Cut, N: Default + Send>(
        self,
        whole: C,
        least: usize,
        notes: &mut Vec<N>,
        work: impl Fn(C, &mut N) + Sync,
    ) -> usize {
        let pieces = self.pieces(whole.len(), least).max(1);
        if notes.len() < pieces {
            notes.resize_with(pieces, N::default);
        }
        match &mut notes[..pieces] {
            [note] => work(whole, note),
            notes => split(whole, notes, &work),
        }
        pieces
    }
}

/// Halves what there is until there is a piece for each note.
fn split<C: Cut, N: Send>(whole: C, notes: &mut [N], work: &(impl Fn(C, &mut N) + Sync)) {
    if let [note] = notes {
        return work(whole, note);
    }
    let (pieces, half) = (notes.len(), notes.len() / 2);
    let middle = whole.len().saturating_mul(half).checked_div(pieces).unwrap_or(0);
    let ((a, b), (of_a, of_b)) = (whole.cut(middle), notes.split_at_mut(half));
    crew::both(|| split(a, of_a, work), || split(b, of_b, work));
}
