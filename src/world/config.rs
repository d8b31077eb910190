//! A world's constants.

pub use crate::body::Sleeping;
use crate::geom::Vec2;
pub use crate::motion::Integrator;
use crate::num::{Acceleration, RangeError};
use crate::store::record;
use core::fmt;
use serde::{Deserialize, Serialize};

/// A world to create. `WorldDef::default()` has 60 ticks per second, 10 substeps, no gravity, and nothing sleeps.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorldDef {
    /// Ticks per second, 15 … 1000. A constant of the world, and part of its hash.
    pub tick_rate: u32,
    /// Substeps per tick, 1 … 64, of contacts and of motion that is not exact in one step. Under attraction, four of them (or what is
    /// left) make one step of the fourth order.
    pub substeps: u32,
    /// The acceleration of every dynamic body.
    pub gravity: Vec2<Acceleration>,
    /// How motion is integrated.
    pub integrator: Integrator,
    /// k, 0 … 10: contacts are solved in units of 2^k m, for scenes that count in pixels. The distance at which contacts
    /// are looked for is 2 cm·2^k, overlaps of 0.1 mm·2^k are left alone, bodies in contact move at most 400·2^k m/s.
    pub unit_shift: u32,
    /// When bodies fall asleep, `Some(Sleeping::default())` for what games use; `None`, the default: never. What sleeps costs
    /// nothing, but what moves more slowly than its threshold is stopped: so it is for those who want it.
    pub sleeping: Option<Sleeping>,
}

record!(WorldDef { tick_rate, substeps, gravity, integrator, unit_shift, sleeping } shown);

impl Default for WorldDef {
    fn default() -> Self {
        WorldDef {
            tick_rate: 60,
            substeps: 10,
            gravity: Vec2::default(),
            integrator: Integrator::ForestRuth,
            unit_shift: 0,
            sleeping: None,
        }
    }
}

/// Why a world cannot be like this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConfigError {
    /// Ticks per second outside 15 … 1000.
    TickRate {
        /// What was given.
        value: u32,
    },
    /// Substeps outside 1 … 64.
    Substeps {
        /// What was given.
        value: u32,
    },
    /// A unit shift outside 0 … 10.
    UnitShift {
        /// What was given.
        value: u32,
    },
    /// A gravity component, or a value of sleeping, outside its range.
    Range(RangeError),
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConfigError::TickRate { value } => write!(f, "tick_rate {value} 1/s is outside 15 … 1000 1/s"),
            ConfigError::Substeps { value } => write!(f, "substeps {value} is outside 1 … 64"),
            ConfigError::UnitShift { value } => write!(f, "unit_shift {value} is outside 0 … 10"),
            ConfigError::Range(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ConfigError {}

impl From<RangeError> for ConfigError {
    fn from(error: RangeError) -> Self {
        ConfigError::Range(error)
    }
}

impl WorldDef {
    /// Whether a world can be like this.
    pub fn check(&self) -> Result<(), ConfigError> {
        if !(15..=1000).contains(&self.tick_rate) {
            return Err(ConfigError::TickRate { value: self.tick_rate });
        }
        if !(1..=64).contains(&self.substeps) {
            return Err(ConfigError::Substeps { value: self.substeps });
        }
        if self.unit_shift > 10 {
            return Err(ConfigError::UnitShift { value: self.unit_shift });
        }
        self.gravity.checked()?;
        if let Some(sleeping) = &self.sleeping {
            sleeping.check()?;
        }
        Ok(())
    }
}
