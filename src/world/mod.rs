//! The world: the only owner of state, the one step, and the commands that change it.

mod apply;
mod body;
mod check;
mod command;
mod commands;
mod config;
mod status;
mod step;

use crate::body::{Attractor, Bodies};
use crate::motion::{Drive, Fault, Push};
use crate::store::{Arena, AttractorId, BodyId, record};
pub use body::Body;
pub use command::{Command, CommandError, INPUT_MAX, Reply};
pub use commands::Commands;
pub use config::{ConfigError, Integrator, WorldDef};
pub use status::{Bound, Status, StatusEntry};

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
    pub(crate) attractors: Arena<Attractor>,
    /// Forces and torques of one tick, in the order in which the bodies first got some.
    pub(crate) pushes: Vec<Push>,
    pub(crate) status: Status,
    /// Derived from the above.
    pub(crate) drive: Drive,
    /// Empty between ticks.
    pub(crate) faults: Vec<Fault>,
}

record!(World { config, tick, bodies, attractors, pushes, status } derived { drive, faults });

impl World {
    /// An empty world. Errors: a tick rate, substeps or gravity outside their ranges.
    pub fn new(def: &WorldDef) -> Result<World, ConfigError> {
        def.check()?;
        let mut world = World {
            config: def.clone(),
            tick: 0,
            bodies: Bodies::default(),
            attractors: Arena::default(),
            pushes: Vec::new(),
            status: Status::default(),
            drive: Drive::default(),
            faults: Vec::new(),
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

    /// Computes everything derived anew.
    pub(crate) fn rebuild(&mut self) {
        let World { config, bodies, attractors, drive, .. } = self;
        drive.prepare(config.integrator, config.tick_rate, config.substeps, bodies, attractors);
        self.drive.index_pushes(&self.pushes);
        for slot in 0..self.bodies.cold.len() {
            self.refresh(slot);
        }
    }

    /// Computes the motion of one body anew, without the forces of one tick.
    pub(crate) fn refresh(&mut self, slot: usize) {
        self.drive.grow(self.bodies.cold.len());
        self.drive.set(slot, self.bodies.cold.value(slot), self.config.gravity, None);
    }
}
