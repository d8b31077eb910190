//! What scripts act on.

use crate::World;
use crate::replay::Recorder;
use crate::world::Commands;
use std::io::Write;

/// A world, or a recorder around one.
pub trait Stage: Commands {
    /// The world, to look at.
    fn world(&self) -> &World;

    /// Advances the world by one tick.
    fn step(&mut self);
}

impl Stage for World {
    fn world(&self) -> &World {
        self
    }

    fn step(&mut self) {
        World::step(self);
    }
}

impl<W: Write> Stage for Recorder<W> {
    fn world(&self) -> &World {
        Recorder::world(self)
    }

    fn step(&mut self) {
        Recorder::step(self);
    }
}
