//! Scenes that are hard to keep standing. All stand on a floor whose top is at y = 0, under 9.81 m/s².
#![allow(dead_code, reason = "each file uses its part of this one")]

use crate::common::{Rng, disc, rectangle, world};
use crate::solid::{add, fixed, moving, polygon, solid, spin, surface, turned, weighing};
use tamias2d::{BodyDef, BodyId, BodyKind, World};

/// A scene and the bodies that it is about.
pub type Scene = (World, Vec<BodyId>);

/// A floor alone.
pub fn floor() -> World {
    let mut world = world(0.0, -9.81);
    add(&mut world, fixed(0.0, -1.0, rectangle(400.0, 2.0)));
    world
}

/// Boxes of 1 m with these masses on each other, each within ±`offset` of the middle.
pub fn tower(masses: &[f64], offset: f64, seed: u64) -> Scene {
    let (mut world, mut rng) = (floor(), Rng(seed));
    let mut ids = Vec::new();
    for (row, &mass) in masses.iter().enumerate() {
        let x = (rng.unit() * 2.0 - 1.0) * offset;
        ids.push(add(&mut world, weighing(solid(x, row as f64 + 0.5, rectangle(1.0, 1.0)), mass)));
    }
    (world, ids)
}

/// Boxes of 1 kg, and one of `mass` on them.
pub fn heavy_top(rows: usize, mass: f64) -> Scene {
    let masses: Vec<f64> = (1..=rows).map(|row| if row == rows { mass } else { 1.0 }).collect();
    tower(&masses, 0.0, 1)
}

/// A pyramid of boxes of 1 m, `base` wide at the ground.
pub fn pyramid(base: u32) -> Scene {
    let (mut world, mut ids) = (floor(), Vec::new());
    for row in 0..base {
        for column in 0..base - row {
            let x = f64::from(column) - f64::from(base - 1 - row) * 0.5;
            ids.push(add(&mut world, solid(x, 0.5 + f64::from(row), rectangle(1.0, 1.0))));
        }
    }
    (world, ids)
}

/// A box of 20 m and 400 kg on two of 1 m and 1 kg.
pub fn table() -> Scene {
    let mut world = floor();
    let feet = [-9.0, 9.0].map(|x| add(&mut world, solid(x, 0.5, rectangle(1.0, 1.0))));
    let top = add(&mut world, solid(0.0, 11.0, rectangle(20.0, 20.0)));
    (world, vec![feet[0], feet[1], top])
}

/// Cards of 40 cm and 2 mm that lean on each other, in five storeys. Source: Box2D's sample.
pub fn card_house() -> Scene {
    let (mut world, mut ids) = (floor(), Vec::new());
    let half = 0.2;
    let mut card = |x: f64, y: f64, degrees: f64| {
        let shape = surface(rectangle(0.002, 0.4), 0.7, 0.0);
        ids.push(add(&mut world, BodyDef { angle: turned(degrees.to_radians()), ..solid(x, y, shape) }));
    };
    let (mut y, mut left) = (half - 0.02, 0.0);
    for tents in (1..=5).rev() {
        for at in 0..tents {
            let x = left + 0.35 * f64::from(at);
            if at + 1 < tents {
                card(x + 0.25, y + half - 0.015, 90.0);
            }
            card(x, y, -25.0);
            card(x + 0.175, y, 25.0);
        }
        y += half * 2.0 - 0.03;
        left += 0.175;
    }
    (world, ids)
}

/// An arch of 17 stones with four boxes on it. Source: Box2D's sample.
pub fn arch() -> Scene {
    const INNER: [(f64, f64); 9] = [
        (16.0, 0.0),
        (14.938_037, 5.133_601),
        (13.798_717, 10.249_281),
        (12.562_530, 15.341_070),
        (11.200_410, 20.398_565),
        (9.665_212, 25.403_699),
        (7.871_799, 30.317_934),
        (5.635_200, 35.038_207),
        (2.405_938, 39.095_541),
    ];
    const OUTER: [(f64, f64); 9] = [
        (24.0, 0.0),
        (22.336_195, 6.022_998),
        (20.549_369, 12.009_644),
        (18.608_546, 17.947_032),
        (16.467_693, 23.813_679),
        (14.053_250, 29.570_794),
        (11.235_510, 35.137_758),
        (7.752_568, 40.304_507),
        (3.016_932, 44.288_916),
    ];
    let (mut world, mut ids) = (floor(), Vec::new());
    let mut stone = |corners: [(f64, f64); 4]| {
        let (x, y) = corners.iter().fold((0.0, 0.0), |(x, y), c| (x + c.0 / 16.0, y + c.1 / 16.0));
        let corners = corners.map(|c| (c.0 * 0.25 - x, c.1 * 0.25 - y));
        ids.push(add(&mut world, solid(x, y, polygon(&corners))));
    };
    let mirrored = |p: (f64, f64)| (-p.0, p.1);
    for at in 0..8 {
        stone([INNER[at], OUTER[at], OUTER[at + 1], INNER[at + 1]]);
        stone([INNER[at + 1], OUTER[at + 1], OUTER[at], INNER[at]].map(mirrored));
    }
    stone([INNER[8], OUTER[8], mirrored(OUTER[8]), mirrored(INNER[8])]);
    for row in 0..4 {
        ids.push(add(&mut world, solid(0.0, 0.5 + OUTER[8].1 * 0.25 + f64::from(row), rectangle(4.0, 1.0))));
    }
    (world, ids)
}

/// 15 dominoes, the first of which is pushed. Source: Box2D's sample.
pub fn dominoes() -> Scene {
    let (mut world, mut ids) = (floor(), Vec::new());
    for at in 0..15 {
        let stone = solid(f64::from(at) - 7.5, 0.5, rectangle(0.25, 1.0));
        let stone = if at == 0 { BodyDef { angular_velocity: spin(-2.5), ..moving(stone, 1.2, 0.0) } } else { stone };
        ids.push(add(&mut world, stone));
    }
    (world, ids)
}

/// Needles of 1 m and 1 cm that fall across each other.
pub fn needles(count: u32) -> Scene {
    let (mut world, mut rng, mut ids) = (floor(), Rng(7), Vec::new());
    for at in 0..count {
        let body = solid(rng.unit() * 2.0 - 1.0, 0.5 + 0.3 * f64::from(at), rectangle(1.0, 0.01));
        ids.push(add(&mut world, BodyDef { angle: turned(6.3 * rng.unit()), ..body }));
    }
    (world, ids)
}

/// Boxes of 1 m that begin inside of each other by `part` of their height.
pub fn overlapping(rows: u32, part: f64) -> Scene {
    let (mut world, mut ids) = (floor(), Vec::new());
    for row in 0..rows {
        let y = 0.5 - part + f64::from(row) * (1.0 - part);
        ids.push(add(&mut world, solid(0.0, y.max(0.5 - part), rectangle(1.0, 1.0))));
    }
    (world, ids)
}

/// 625 discs in a room that is too small for them, without gravity. Source: Box2D's sample.
pub fn confined() -> Scene {
    let (mut world, mut ids) = (world(0.0, 0.0), Vec::new());
    for (x, y, width, height) in
        [(0.0, -0.5, 23.0, 2.0), (0.0, 21.5, 23.0, 2.0), (-11.0, 10.5, 2.0, 24.0), (11.0, 10.5, 2.0, 24.0)]
    {
        add(&mut world, fixed(x, y, rectangle(width, height)));
    }
    for at in 0..625 {
        let (column, row) = (f64::from(at % 25), f64::from(at / 25));
        ids.push(add(&mut world, solid(-8.75 + column * 0.72, 1.5 + row * 0.72, disc(0.5))));
    }
    (world, ids)
}

/// A wide pile of discs, triangles and boxes from 25 cm to 1 m between walls, dropped from a grid.
pub fn pile(count: u32, half: f64, seed: u64) -> Scene {
    let (mut world, mut rng, mut ids) = (floor(), Rng(seed), Vec::new());
    for x in [-half, half] {
        add(&mut world, fixed(x, 60.0, rectangle(2.0, 124.0)));
    }
    let columns = ((half - 2.0) * 2.0 / 1.25) as u32;
    for at in 0..count {
        let size = rng.scale(0.25, 1.0);
        let shape = match rng.below(4) {
            0 => disc(size * 0.5),
            1 => polygon(&[(-0.5 * size, -0.4 * size), (0.5 * size, -0.4 * size), (0.0, 0.5 * size)]),
            _ => rectangle(size, size * (0.5 + 0.5 * rng.unit())),
        };
        let x = f64::from(at % columns) * 1.25 - half + 2.0 + 0.1 * rng.unit();
        let y = 1.0 + f64::from(at / columns) * 1.3;
        ids.push(add(&mut world, BodyDef { angle: turned(6.0 * rng.unit()), ..solid(x, y, shape) }));
    }
    (world, ids)
}

/// A square drum that turns by 25° a second, with 500 boxes of 25 cm in it.
pub fn tumbler() -> Scene {
    let (mut world, mut ids) = (world(0.0, -9.81), Vec::new());
    let wall = |x: f64, y: f64, width: f64, height: f64| tamias2d::ColliderDef {
        offset: crate::common::at(x, y),
        ..rectangle(width, height)
    };
    let walls = vec![
        wall(10.0, 0.0, 1.0, 20.0),
        wall(-10.0, 0.0, 1.0, 20.0),
        wall(0.0, 10.0, 20.0, 1.0),
        wall(0.0, -10.0, 20.0, 1.0),
    ];
    let drum = BodyDef { kind: BodyKind::Kinematic, colliders: walls, ..BodyDef::default() };
    add(&mut world, BodyDef { angular_velocity: spin(25f64.to_radians()), ..drum });
    for at in 0..500 {
        let (column, row) = (f64::from(at % 25), f64::from(at / 25));
        ids.push(add(&mut world, solid((column - 12.0) * 0.55, (row - 10.0) * 0.55, rectangle(0.25, 0.25))));
    }
    (world, ids)
}

/// A ring with eight paddles that turns by 25° a second, with 400 boxes of 50 cm in it. Source: Box2D's sample.
pub fn washer() -> Scene {
    let (mut world, mut ids) = (world(0.0, -9.81), Vec::new());
    let at = |angle: f64, r: f64| (angle.cos() * r, angle.sin() * r);
    let mut walls = Vec::new();
    for part in 0..40 {
        let [from, to] = [part, part + 1].map(|at| f64::from(at) * std::f64::consts::TAU / 40.0);
        walls.push(polygon(&[at(from, 14.0), at(from, 16.0), at(to, 16.0), at(to, 14.0)]));
        if part % 5 == 0 {
            let [low, high] = [from - 0.02, from + 0.02];
            walls.push(polygon(&[at(low, 11.0), at(low, 14.5), at(high, 14.5), at(high, 11.0)]));
        }
    }
    let drum = BodyDef { kind: BodyKind::Kinematic, colliders: walls, ..BodyDef::default() };
    add(&mut world, BodyDef { angular_velocity: spin(25f64.to_radians()), ..drum });
    for at in 0..400 {
        let (column, row) = (f64::from(at % 20), f64::from(at / 20));
        ids.push(add(&mut world, solid((column - 9.5) * 0.7, (row - 9.5) * 0.7, rectangle(0.5, 0.5))));
    }
    (world, ids)
}
