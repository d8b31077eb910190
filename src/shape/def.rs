//! Shapes and colliders as they are given, and what of them is accepted.

use crate::geom::Vec2;
use crate::num::{Angle, Density, Friction, Length, RangeError, Restitution};
use crate::store::{record, record_copy, record_enum};
use core::fmt;
use serde::{Deserialize, Serialize};

/// A convex form.
#[derive(Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Shape {
    /// A disc about the collider's origin: in the words of the SRS, a vertex with a radius.
    Circle {
        /// 1e-6 … 16 000 m.
        radius: Length,
    },
    /// A rectangle about the collider's origin.
    Box {
        /// Its full width, 1e-6 … 16 000 m.
        width: Length,
        /// Its full height, 1e-6 … 16 000 m.
        height: Length,
    },
    /// A strictly convex polygon of 3 to 8 vertices in the collider's axes, within ±16 000 m, its edges at least 1e-6 m
    /// long and itself as wide across each of them. It may be given clockwise; it is stored counter-clockwise, from the
    /// same first vertex.
    Polygon {
        /// Its vertices.
        vertices: Vec<Vec2<Length>>,
    },
}

impl Clone for Shape {
    fn clone(&self) -> Self {
        match self {
            Shape::Circle { radius } => Shape::Circle { radius: *radius },
            Shape::Box { width, height } => Shape::Box { width: *width, height: *height },
            Shape::Polygon { vertices } => Shape::Polygon { vertices: vertices.clone() },
        }
    }

    /// Reuses the memory of vertices, as the derived one does not.
    fn clone_from(&mut self, source: &Self) {
        match (self, source) {
            (Shape::Polygon { vertices }, Shape::Polygon { vertices: others }) => vertices.clone_from(others),
            (shape, source) => *shape = source.clone(),
        }
    }
}

record_enum!(Shape { 0 => Circle { radius }, 1 => Box { width, height }, 2 => Polygon { vertices } } shown);

/// Which colliders meet: both must have a category that the other's mask has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// What it is, a bit each.
    pub category: u32,
    /// What it meets, a bit each.
    pub mask: u32,
}

record_copy!(Filter { category, mask } shown);

impl Default for Filter {
    /// Category 1, meeting everything.
    fn default() -> Self {
        Filter { category: 1, mask: u32::MAX }
    }
}

impl Filter {
    /// Whether two colliders meet.
    #[inline]
    pub fn meets(self, other: Filter) -> bool {
        self.category & other.mask != 0 && other.category & self.mask != 0
    }
}

/// A collider to create with its body.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColliderDef {
    /// Its form.
    pub shape: Shape,
    /// Where the form's origin is, in the body's axes, from the body's origin; within ±16 000 m.
    #[serde(default)]
    pub offset: Vec2<Length>,
    /// By how much the form is turned against the body.
    #[serde(default)]
    pub angle: Angle,
    /// Mass per area, for bodies whose mass, centre or inertia is not given.
    #[serde(default = "one")]
    pub density: Density,
    /// C_R (DD:coeffRestitution). Of two colliders the larger counts.
    #[serde(default)]
    pub restitution: Restitution,
    /// The coefficient of friction. Of two colliders the geometric mean counts.
    #[serde(default = "default_friction")]
    pub friction: Friction,
    /// What it meets.
    #[serde(default)]
    pub filter: Filter,
    /// Whether it only reports overlaps: no contact, no mass.
    #[serde(default)]
    pub sensor: bool,
}

record!(ColliderDef { shape, offset, angle, density, restitution, friction, filter, sensor });

fn one() -> Density {
    Density::from_bits(1 << 64)
}

/// 0.6, as 48 fraction bits round it.
const FRICTION: Friction = Friction::from_bits(168_884_986_026_394);

fn default_friction() -> Friction {
    FRICTION
}

impl ColliderDef {
    /// A collider of this shape at its body's origin: density 1 kg/m², restitution 0, friction 0.6.
    pub fn new(shape: Shape) -> Self {
        ColliderDef {
            shape,
            offset: Vec2::default(),
            angle: Angle::ZERO,
            density: one(),
            restitution: Restitution::ZERO,
            friction: FRICTION,
            filter: Filter::default(),
            sensor: false,
        }
    }
}

/// Why a form is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A value outside its quantity's accepted range.
    Range(RangeError),
    /// A width, height or radius outside 1e-6 … 16 000 m.
    Size {
        /// `width`, `height` or `radius`.
        name: &'static str,
        /// What was given.
        value: Length,
    },
    /// A coordinate of a vertex or an offset beyond ±16 000 m.
    Far {
        /// What was given.
        value: Length,
    },
    /// A polygon with fewer than 3 or more than 8 vertices.
    VertexCount {
        /// How many.
        count: u64,
    },
    /// A vertex that is where another one is.
    RepeatedVertex {
        /// Which, from 0, in the order given.
        index: u32,
    },
    /// A vertex on the line through its neighbours; all of them, when the polygon has no area.
    Collinear {
        /// Which, from 0, in the order given.
        index: u32,
    },
    /// A vertex where the polygon turns the other way, or winds round more than once.
    NotConvex {
        /// Which, from 0, in the order given.
        index: u32,
    },
    /// An edge shorter than 1e-6 m: once turned, its ends are rounded to 2⁻³² m, and below that length its direction
    /// would be off by more than 2e-4 rad.
    ShortEdge {
        /// The vertex it starts from, from 0, in the order given.
        index: u32,
    },
    /// A polygon that reaches less than 1e-6 m inwards from an edge: a box as thin as that is refused as well.
    Thin {
        /// The vertex the edge starts from, from 0, in the order given.
        index: u32,
    },
    /// A collider with a point farther than 16 383 m from its body's origin.
    Reach {
        /// How far it reaches, rounded up.
        value: Length,
    },
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ShapeError::Range(error) => error.fmt(f),
            ShapeError::Size { name, value } => write!(f, "{name} {value} m is outside 0.000001 … 16000 m"),
            ShapeError::Far { value } => write!(f, "coordinate {value} m is outside ±16000 m"),
            ShapeError::VertexCount { count } => write!(f, "{count} vertices are outside 3 … 8"),
            ShapeError::RepeatedVertex { index } => write!(f, "vertex {index} is where another vertex is"),
            ShapeError::Collinear { index } => write!(f, "vertex {index} is on the line through its neighbours"),
            ShapeError::NotConvex { index } => write!(f, "the polygon is not convex at vertex {index}"),
            ShapeError::ShortEdge { index } => write!(f, "the edge from vertex {index} is shorter than 0.000001 m"),
            ShapeError::Thin { index } => {
                write!(f, "the polygon is thinner than 0.000001 m across the edge from vertex {index}")
            }
            ShapeError::Reach { value } => {
                write!(f, "the collider reaches {value} m from its body's origin, farther than 16383 m")
            }
        }
    }
}

impl core::error::Error for ShapeError {}

impl From<RangeError> for ShapeError {
    fn from(error: RangeError) -> Self {
        ShapeError::Range(error)
    }
}
