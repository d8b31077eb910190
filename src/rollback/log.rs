//! What a game was told of a tick, and what of it still holds when the tick is simulated anew.

use crate::World;
use crate::contact::{Collision, Event, EventId};

/// Tells a game of each event and collision once, however often their ticks are simulated.
///
/// It keeps what it told of the last ticks, as many as a rollback may go back, and compares by [`EventId`]s. All memory is used
/// again. What happens a tick earlier or later than it was told is cancelled and new.
///
/// ```
/// use tamias2d::*;
/// let mut world = World::new(&WorldDef { gravity: Vec2::from_f64(0.0, -10.0)?, ..WorldDef::default() })?;
/// let disc = || ColliderDef::new(Shape::Circle { radius: "0.5".parse().expect("in range") });
/// let floor = BodyDef { kind: BodyKind::Static, colliders: vec![disc()], ..BodyDef::default() };
/// world.create_body(&floor)?;
/// let ball = BodyDef { position: Vec2::from_f64(0.0, 1.2)?, colliders: vec![disc()], ..BodyDef::default() };
/// world.create_body(&ball)?;
///
/// let (mut ring, mut log) = (Rollback::new(17), EventLog::new(17));
/// let mut sounds = Vec::new();
/// let mut tick = |world: &mut World, ring: &mut Rollback| {
///     ring.save(world);
///     world.step();
///     let told = log.tell(world);
///     sounds.extend(told.events.new.iter().filter(|event| event.kind == EventKind::ContactBegin).map(Event::id));
///     // `told.events.cancelled` did not happen after all: fade it out. `told.events.confirmed` is playing already.
/// };
/// for _ in 0..20 {
///     tick(&mut world, &mut ring);
/// }
/// // The input of another player comes late: twelve ticks again, in which the ball lands once more.
/// ring.restore(&mut world, 8)?;
/// for _ in 8..20 {
///     tick(&mut world, &mut ring);
/// }
/// assert_eq!(sounds.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EventLog {
    events: Log<Event>,
    collisions: Log<Collision>,
}

/// What is to be said of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Told<'l> {
    /// Of what began and ended to touch.
    pub events: Sorted<'l, Event>,
    /// Of collisions.
    pub collisions: Sorted<'l, Collision>,
}

/// What happened in a tick, against what had been told of it.
#[derive(Clone, Copy, Debug)]
pub struct Sorted<'l, T> {
    /// What happened and was not told yet, in the order of the step: play its sound.
    pub new: &'l [T],
    /// What had been told and happened again, in the order of the step and as it is now: it may be a little stronger or elsewhere.
    pub confirmed: &'l [T],
    /// What had been told and did not happen this time, as it was told, ordered by ids.
    pub cancelled: &'l [T],
}

impl EventLog {
    /// A log of the last `ticks` ticks, one at least: as many as a [`Rollback`](crate::Rollback) holds.
    pub fn new(ticks: u32) -> Self {
        EventLog { events: Log::new(ticks), collisions: Log::new(ticks) }
    }

    /// Sorts what the step just made told; to be called after every [`World::step`], of a first simulation or of one anew. A tick so
    /// old that it is not held any more has been told for good: all of it is confirmed.
    pub fn tell(&mut self, world: &World) -> Told<'_> {
        // A world that has not stepped has told nothing.
        let tick = world.tick().saturating_sub(1);
        let EventLog { events, collisions } = self;
        Told { events: events.tell(tick, world.events()), collisions: collisions.tell(tick, world.collisions()) }
    }
}

/// What has an id.
trait Named: Copy {
    fn id(&self) -> EventId;
}

impl Named for Event {
    fn id(&self) -> EventId {
        Event::id(self)
    }
}

impl Named for Collision {
    fn id(&self) -> EventId {
        Collision::id(self)
    }
}

/// What was told of a tick, ordered by ids.
#[derive(Debug)]
struct Page<T> {
    tick: Option<u64>,
    told: Vec<T>,
}

#[derive(Debug)]
struct Log<T> {
    /// A tick's is that of its number modulo theirs.
    pages: Vec<Page<T>>,
    new: Vec<T>,
    confirmed: Vec<T>,
    cancelled: Vec<T>,
}

impl<T: Named> Log<T> {
    fn new(ticks: u32) -> Self {
        let mut pages = Vec::new();
        pages.resize_with((ticks as usize).max(1), || Page { tick: None, told: Vec::new() });
        Log { pages, new: Vec::new(), confirmed: Vec::new(), cancelled: Vec::new() }
    }

    fn tell(&mut self, tick: u64, happened: &[T]) -> Sorted<'_, T> {
        let Log { pages, new, confirmed, cancelled } = self;
        [&mut *new, &mut *confirmed, &mut *cancelled].into_iter().for_each(Vec::clear);
        let place = tick.checked_rem(pages.len() as u64).unwrap_or(0) as usize;
        let page = &mut pages[place];
        if page.tick > Some(tick) {
            confirmed.extend_from_slice(happened);
        } else {
            if page.tick != Some(tick) {
                page.tick = Some(tick);
                page.told.clear();
            }
            for item in happened {
                let known = page.told.binary_search_by_key(&item.id(), T::id).is_ok();
                if known { &mut *confirmed } else { &mut *new }.push(*item);
            }
            // What is left of the told when the happened is taken out.
            cancelled.clone_from(&page.told);
            page.told.clear();
            page.told.extend_from_slice(happened);
            page.told.sort_unstable_by_key(T::id);
            cancelled.retain(|item| page.told.binary_search_by_key(&item.id(), T::id).is_err());
        }
        Sorted { new, confirmed, cancelled }
    }
}
