//! The world: the only owner of state, the one step, and the commands that change it.

mod apply;
mod body;
mod check;
mod collider;
mod command;
mod commands;
mod config;
mod query;
mod show;
mod sleep;
mod stage;
mod status;
mod step;

use crate::body::{Attractor, Bodies, BodyData, Colliders};
use crate::contact::{Collision, Contacts, Event, Resting, Touch};
use crate::motion::{Drive, Fault, Push};
use crate::solver::{Mobility, Scales, Solver};
use crate::store::{Arena, AttractorId, BodyId, ColliderId, record};
pub use body::Body;
pub use collider::Collider;
pub use command::{Command, CommandError, INPUT_MAX, Reply};
pub use commands::Commands;
pub use config::{ConfigError, Integrator, Sleeping, WorldDef};
pub use query::{ClosestPoint, RayHit};
pub use stage::Stage;
pub use status::{Bound, Status, StatusEntry};
pub(crate) use step::Watch;

/// A world of bodies under forces.
///
/// A pure function of its state and the commands: [`World::step`] takes no time step, reads no clock and draws no
/// random numbers. Commands are methods of the trait [`Commands`].
///
/// ```
/// use tamias2d::{Acceleration, BodyDef, Commands, Vec2, World, WorldDef};
///
/// let mut world = World::new(&WorldDef { gravity: Vec2::from_f64(0.0, -10.0)?, ..WorldDef::default() })?;
/// let ball = world.create_body(&BodyDef { position: Vec2::from_f64(0.0, 20.0)?, ..BodyDef::default() })?;
/// for _ in 0..60 {
///     world.step();
/// }
/// let height = world.body(ball).expect("nobody destroyed it").position().y.to_f64();
/// assert!((height - 15.0).abs() < 1e-7); // ½·10·1² lower, exactly but for rounding
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct World {
    pub(crate) config: WorldDef,
    pub(crate) tick: u64,
    pub(crate) bodies: Bodies,
    pub(crate) colliders: Colliders,
    pub(crate) attractors: Arena<Attractor>,
    /// Forces and torques of one tick, in the order in which the bodies first got some.
    pub(crate) pushes: Vec<Push>,
    /// What touches, and the impulses with which the next tick begins.
    pub(crate) contacts: Contacts,
    /// The contacts of what sleeps.
    pub(crate) resting: Resting,
    pub(crate) status: Status,
    /// Derived from the above.
    pub(crate) drive: Drive,
    pub(crate) touch: Touch,
    pub(crate) solver: Solver,
    /// Of the last step: a value of it, not state.
    pub(crate) events: Vec<Event>,
    /// Empty between ticks.
    pub(crate) faults: Vec<Fault>,
    /// Where the contacts of the next tick are built.
    pub(crate) next: Contacts,
}

record!(World { config, tick, bodies, colliders, attractors, pushes, contacts, resting, status }
    derived { drive, touch, solver, events, faults, next });

impl World {
    /// An empty world. Errors: a tick rate, substeps or gravity outside their ranges.
    pub fn new(def: &WorldDef) -> Result<World, ConfigError> {
        def.check()?;
        let mut world = World {
            config: def.clone(),
            tick: 0,
            bodies: Bodies::default(),
            colliders: Colliders::default(),
            attractors: Arena::default(),
            pushes: Vec::new(),
            contacts: Contacts::default(),
            resting: Resting::default(),
            status: Status::default(),
            drive: Drive::default(),
            touch: Touch::default(),
            solver: Solver::default(),
            events: Vec::new(),
            faults: Vec::new(),
            next: Contacts::default(),
        };
        world.rebuild();
        Ok(world)
    }

    /// What the world was created with; gravity as it is now.
    pub fn config(&self) -> &WorldDef {
        &self.config
    }

    /// How many ticks the world has stepped.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Bounds that a step ran into, until they are cleared.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The body with this id; `None` if it was destroyed.
    pub fn body(&self, id: BodyId) -> Option<Body<'_>> {
        let slot = self.bodies.slot(id)?;
        Some(Body { world: self, slot })
    }

    /// All bodies in slot order: that of their creation, destroyed bodies' slots being reused.
    pub fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        self.bodies.cold.iter().map(|(slot, _)| Body { world: self, slot })
    }

    /// The number of bodies.
    pub fn body_count(&self) -> u32 {
        self.bodies.cold.live()
    }

    /// The attractor with this id; `None` if it was destroyed.
    pub fn attractor(&self, id: AttractorId) -> Option<Attractor> {
        self.attractors.slot(id.index, id.generation).map(|slot| *self.attractors.value(slot))
    }

    /// All attractors in slot order.
    pub fn attractors(&self) -> impl Iterator<Item = (AttractorId, Attractor)> {
        self.attractors.iter().filter_map(|(slot, attractor)| {
            let generation = self.attractors.generation(slot)?;
            Some((AttractorId { index: slot as u32, generation }, *attractor))
        })
    }

    /// The collider with this id; `None` if its body was destroyed.
    pub fn collider(&self, id: ColliderId) -> Option<Collider<'_>> {
        let slot = self.colliders.slot(id)?;
        Some(Collider { world: self, slot })
    }

    /// All colliders in slot order.
    pub fn colliders(&self) -> impl Iterator<Item = Collider<'_>> {
        self.colliders.rows.iter().map(|(slot, _)| Collider { world: self, slot })
    }

    /// What began and ended to touch in the last step, ordered by colliders. A value of the step: it is neither saved nor
    /// hashed, and a world just loaded has none.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The collisions of the last step, in the order in which they happened. A value of the step: neither saved nor
    /// hashed, and a copy of a world, or one just loaded, has none.
    pub fn collisions(&self) -> &[Collision] {
        self.solver.collisions()
    }

    /// Computes everything derived anew.
    pub(crate) fn rebuild(&mut self) {
        let World { config, bodies, colliders, contacts, resting, .. } = self;
        bodies.rest.derive(config.sleeping.is_some(), bodies.cold.len());
        resting.derive(contacts, bodies, colliders);
        self.prepare_motion();
        self.solver.scales = Scales::new(self.config.tick_rate, self.config.substeps, self.config.unit_shift);
        self.touch.clear();
        for slot in 0..self.bodies.cold.len() {
            self.place(slot);
        }
    }

    /// Computes the motion of all bodies anew: the scheme or gravity have changed.
    pub(crate) fn prepare_motion(&mut self) {
        let World { config, bodies, attractors, drive, .. } = self;
        drive.prepare(config.integrator, config.tick_rate, config.substeps, bodies, attractors);
        self.drive.index_pushes(&self.pushes);
        for slot in 0..self.bodies.cold.len() {
            self.refresh(slot);
        }
    }

    /// Computes the motion of one body anew, without the forces of one tick.
    pub(crate) fn refresh(&mut self, slot: usize) {
        let slots = self.bodies.cold.len();
        let (data, still) = (self.bodies.cold.value(slot), BodyData::default());
        self.drive.grow(slots);
        let driven = if self.bodies.rest.is_asleep(slot) { &still } else { data };
        self.drive.set(slot, driven, self.config.gravity, None);
        self.solver.mobilities.resize(slots, Mobility::default());
        self.solver.mobilities[slot] = Mobility::new(data);
        self.solver.repose.forget(slot);
    }

    /// Tells the broad phase where a body's colliders are, after a command has put them there.
    pub(crate) fn place(&mut self, slot: usize) {
        let World { bodies, colliders, touch, .. } = self;
        for collider in colliders.list(bodies.cold.value(slot).first) {
            touch.set(collider, bodies, colliders);
        }
    }
}
