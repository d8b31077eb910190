//! Without the feature `threads`: the thread that calls does everything.

/// The threads that step a world: the one that calls. The feature `threads` has more.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Threads;

/// Who does the loops of a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crew;

impl Threads {
    /// Has a tick done that takes about so many nanoseconds.
    #[inline(always)]
    pub(crate) fn work(&self, _: usize, tick: impl FnOnce(Crew)) {
        tick(Crew);
    }
}

impl Crew {
    pub(crate) const ALONE: Crew = Crew;

    /// Into how many pieces a loop is cut.
    #[inline(always)]
    pub(super) fn pieces(self, _: usize, _: usize) -> usize {
        1
    }
}

/// Does both.
pub(super) fn both(a: impl FnOnce(), b: impl FnOnce()) {
    a();
    b();
}
