//! With the feature `threads`: a pool of them, which the caller makes.

use core::fmt;
use rayon_core::{ThreadPool, ThreadPoolBuilder, Yield, yield_now};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::thread;

/// So many pieces a thread: then one that is late, or got what takes longer, is waited for less.
const PIECES: usize = 4;

/// A tick that takes less is left to the thread that calls, nanoseconds: to wake the others takes 0.07 ms, and where cores have no
/// cache in common, to carry over what they write takes longer than they save.
const LEAST: usize = 1_500_000;

/// Threads that step a world together.
///
/// They are nobody's state: no bit of a world, and nothing that is saved, hashed or recorded, depends on how many there are, or on
/// whether there are any. A copy is the same threads. Two worlds may be stepped by the same ones at the same time; whichever comes
/// second then is stepped by the thread that calls.
///
/// A tick of less than about 1.5 ms is left to the thread that calls. While a longer one lasts all of them are busy, those that
/// wait too; between ticks they sleep. The thread that calls waits.
///
/// ```
/// use tamias2d::{Threads, World, WorldDef};
/// let threads = Threads::new(4)?;
/// let mut world = World::new(&WorldDef::default())?;
/// let mut alone = world.clone();
/// for _ in 0..60 {
///     world.step_on(&threads);
///     alone.step();
///     assert_eq!(world.hash(), alone.hash());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Threads {
    /// None: the thread that calls.
    pool: Option<Arc<Pool>>,
}

#[derive(Debug)]
struct Pool {
    threads: ThreadPool,
    crew: Crew,
    /// Held while they are at a tick.
    busy: Mutex<()>,
}

/// The threads could not be started.
#[derive(Debug)]
pub struct ThreadsError(rayon_core::ThreadPoolBuildError);

impl fmt::Display for ThreadsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the threads could not be started: {}", self.0)
    }
}

impl core::error::Error for ThreadsError {}

/// Who does the loops of a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crew {
    /// Into how many pieces a loop is cut at most; 1 outside of a pool.
    pieces: usize,
    /// Whether even the shortest loops are.
    eager: bool,
}

impl Threads {
    /// Starts so many threads; for 0 and 1 none, and the thread that calls does everything. Errors: the system's.
    pub fn new(count: usize) -> Result<Threads, ThreadsError> {
        Threads::start(count, false)
    }

    /// As [`Threads::new`], but even the shortest loops are cut up: slower than one thread, and for tests, so that small scenes go
    /// through it as large ones do.
    pub fn eager(count: usize) -> Result<Threads, ThreadsError> {
        Threads::start(count, true)
    }

    fn start(count: usize, eager: bool) -> Result<Threads, ThreadsError> {
        if count < 2 {
            return Ok(Threads::default());
        }
        let name = |at: usize| format!("tamias2d {at}");
        let threads = ThreadPoolBuilder::new().num_threads(count).thread_name(name).build().map_err(ThreadsError)?;
        let crew = Crew { pieces: count.saturating_mul(PIECES), eager };
        Ok(Threads { pool: Some(Arc::new(Pool { threads, crew, busy: Mutex::new(()) })) })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.threads.current_num_threads())
    }

    /// Has a tick done that takes about so many nanoseconds: by one of them, and the others help.
    pub(crate) fn work(&self, nanoseconds: usize, tick: impl FnOnce(Crew) + Send) {
        let large = |pool: &&Arc<Pool>| pool.crew.eager || nanoseconds >= LEAST;
        let Some(pool) = self.pool.as_ref().filter(large) else { return tick(Crew::ALONE) };
        // One tick at a time: a thread that waits for a piece may begin whatever lies there, and two ticks could wait for each
        // other's end.
        let busy = pool.busy.try_lock();
        if matches!(busy, Err(TryLockError::WouldBlock)) {
            return tick(Crew::ALONE);
        }
        let (tick, over) = (Mutex::new(Some(tick)), AtomicBool::new(false));
        // All are woken at once. It is always the same one that has the tick: what is not cut up finds its numbers near.
        pool.threads.broadcast(|thread| {
            if thread.index() > 0 {
                return help(&over);
            }
            let _over = Ended(&over);
            if let Some(tick) = tick.lock().unwrap_or_else(PoisonError::into_inner).take() {
                tick(pool.crew);
            }
        });
    }
}

/// Says that a tick is over, also where it panics: the others would wait for ever.
struct Ended<'t>(&'t AtomicBool);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Takes pieces until the tick is over, awake.
fn help(over: &AtomicBool) {
    while !over.load(Ordering::Acquire) {
        if yield_now() != Some(Yield::Executed) {
            thread::yield_now();
        }
    }
}

impl Crew {
    pub(crate) const ALONE: Crew = Crew { pieces: 1, eager: false };

    /// Into how many pieces a loop is cut.
    #[inline]
    pub(super) fn pieces(self, items: usize, least: usize) -> usize {
        if self.pieces == 1 {
            return 1;
        }
        let least = if self.eager { 1 } else { least };
        items.checked_div(least).unwrap_or(1).clamp(1, self.pieces)
    }
}

/// Does both, on two threads if another one has time.
pub(super) fn both(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    rayon_core::join(a, b);
}
