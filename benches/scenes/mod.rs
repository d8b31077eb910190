//! Scenes as plain data, in whole numbers, of no engine: the benches build worlds of them, the peers' harness the worlds of
//! other engines.
//!
//! Every number is a count of millionths of its SI unit, so each is exact as a decimal, and a scene moved by whole metres
//! keeps its fractions. A direction is given by two numbers in any unit, of which only the ratio counts: 3-4-5 slopes are exact.
#![allow(dead_code, reason = "each user takes its part")]

pub mod exact;
pub mod features;
pub mod growth;
pub mod hard;

/// Millionths of an SI unit.
pub type Micro = i64;
/// A point or a vector in millionths.
pub type Pair = [Micro; 2];

/// One of anything.
pub const ONE: Micro = 1_000_000;
/// A thousandth.
pub const MILLI: Micro = 1_000;
/// Standard gravity as the scenes have it: 9.81 m/s².
pub const G: Micro = 9_810_000;

/// What moves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Static,
    Kinematic,
    Dynamic,
}

/// A convex form about its own origin.
#[derive(Clone, Debug)]
pub enum Form {
    /// Full width and height.
    Box(Micro, Micro),
    /// A radius.
    Disc(Micro),
    /// Counter-clockwise vertices.
    Polygon(Vec<Pair>),
}

/// A form of a body.
#[derive(Clone, Debug)]
pub struct Part {
    pub form: Form,
    /// Its origin, in the body's axes.
    pub at: Pair,
    /// Where its x axis points, in the body's axes.
    pub facing: Pair,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Thing {
    pub kind: Kind,
    pub at: Pair,
    /// Where its x axis points.
    pub facing: Pair,
    pub velocity: Pair,
    pub spin: Micro,
    pub parts: Vec<Part>,
    /// kg/m².
    pub density: Micro,
    /// Mass in kg and moment of inertia in kg m², where they are not those of the parts.
    pub inertia: Option<(Micro, Micro)>,
    /// Rates of decay of velocity and of spin, 1/s.
    pub damping: Pair,
    /// Whether forces do not turn it.
    pub fixed_rotation: bool,
}

/// A scene. Friction and restitution are those of every pair.
#[derive(Clone, Debug)]
pub struct Scene {
    pub gravity: Pair,
    pub friction: Micro,
    pub restitution: Micro,
    pub things: Vec<Thing>,
    /// Points that pull by μ/d²: where, and μ in m³/s².
    pub attractors: Vec<(Pair, Micro)>,
    /// Whether what rests falls asleep.
    pub sleeping: bool,
}

impl Part {
    pub fn new(form: Form, at: Pair) -> Part {
        Part { form, at, facing: [1, 0] }
    }
}

impl Thing {
    /// A body at rest, of 1 kg/m².
    pub fn new(kind: Kind, at: Pair, form: Form) -> Thing {
        Thing {
            kind,
            at,
            facing: [1, 0],
            velocity: [0, 0],
            spin: 0,
            parts: vec![Part::new(form, [0, 0])],
            density: ONE,
            inertia: None,
            damping: [0, 0],
            fixed_rotation: false,
        }
    }

    /// A static rectangle.
    pub fn wall(at: Pair, width: Micro, height: Micro) -> Thing {
        Thing::new(Kind::Static, at, Form::Box(width, height))
    }

    /// A dynamic rectangle.
    pub fn block(at: Pair, width: Micro, height: Micro) -> Thing {
        Thing::new(Kind::Dynamic, at, Form::Box(width, height))
    }

    /// A dynamic disc.
    pub fn disc(at: Pair, radius: Micro) -> Thing {
        Thing::new(Kind::Dynamic, at, Form::Disc(radius))
    }

    pub fn facing(self, facing: Pair) -> Thing {
        Thing { facing, ..self }
    }

    pub fn moving(self, velocity: Pair) -> Thing {
        Thing { velocity, ..self }
    }

    pub fn spinning(self, spin: Micro) -> Thing {
        Thing { spin, ..self }
    }

    pub fn dense(self, density: Micro) -> Thing {
        Thing { density, ..self }
    }
}

impl Scene {
    /// A scene of these under gravity, with friction 0.6 and no restitution.
    pub fn new(things: Vec<Thing>) -> Scene {
        Scene {
            gravity: [0, -G],
            friction: 600 * MILLI,
            restitution: 0,
            things,
            attractors: Vec::new(),
            sleeping: false,
        }
    }

    /// The same without gravity and friction.
    pub fn floating(things: Vec<Thing>) -> Scene {
        Scene { gravity: [0, 0], friction: 0, ..Scene::new(things) }
    }

    pub fn friction(self, friction: Micro) -> Scene {
        Scene { friction, ..self }
    }

    pub fn restitution(self, restitution: Micro) -> Scene {
        Scene { restitution, ..self }
    }

    /// The same, farther right.
    pub fn moved(mut self, by: Micro) -> Scene {
        for thing in &mut self.things {
            thing.at[0] += by;
        }
        for (at, _) in &mut self.attractors {
            at[0] += by;
        }
        self
    }
}

/// A floor of 80 m whose top is at y = 0.
pub fn floor() -> Thing {
    Thing::wall([0, -ONE], 80 * ONE, 2 * ONE)
}

/// Knuth's MMIX generator; its upper half.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(seed ^ 0x9e37_79b9_7f4a_7c15)
    }

    /// A number in from … to, both included.
    pub fn between(&mut self, from: Micro, to: Micro) -> Micro {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let range = (to - from + 1) as u64;
        from + (((self.0 >> 32) * range) >> 32) as Micro
    }
}

/// Convex polygons of 3 to 8 vertices on a circle of 1 m; [`polygon`] scales them.
const OUTLINES: [&[Pair]; 4] = [
    &[[1_000_000, 0], [-500_000, 866_025], [-500_000, -866_025]],
    &[[800_000, 600_000], [-600_000, 800_000], [-960_000, -280_000], [280_000, -960_000]],
    &[[1_000_000, 0], [309_017, 951_057], [-809_017, 587_785], [-809_017, -587_785], [309_017, -951_057]],
    &[
        [923_880, 382_683],
        [382_683, 923_880],
        [-382_683, 923_880],
        [-923_880, 382_683],
        [-923_880, -382_683],
        [-382_683, -923_880],
        [382_683, -923_880],
        [923_880, -382_683],
    ],
];

/// A triangle, quadrangle, pentagon or octagon of this radius.
pub fn polygon(which: Micro, radius: Micro) -> Form {
    let scale = |[x, y]: Pair| [x * (radius / MILLI) / MILLI, y * (radius / MILLI) / MILLI];
    Form::Polygon(OUTLINES[which as usize % OUTLINES.len()].iter().map(|&corner| scale(corner)).collect())
}

/// Four walls around a room of this half width and half height about the origin, 2 m thick.
pub fn room(half: Pair) -> Vec<Thing> {
    let [w, h] = half;
    let (across, up) = (2 * w + 4 * ONE, 2 * h + 4 * ONE);
    vec![
        Thing::wall([0, -h - ONE], across, 2 * ONE),
        Thing::wall([0, h + ONE], across, 2 * ONE),
        Thing::wall([-w - ONE, 0], 2 * ONE, up),
        Thing::wall([w + ONE, 0], 2 * ONE, up),
    ]
}
