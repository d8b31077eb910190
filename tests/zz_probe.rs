#![allow(clippy::all, warnings)]
mod common;
#[path = "common/impact.rs"]
mod impact;
#[path = "common/solid.rs"]
mod solid;
use common::*;
use impact::*;
use solid::*;
use tamias2d::*;
#[test]
fn probe() {
    for e in [0.0, 1.0] {
        let mut world = world(0.0, 0.0);
        add(&mut world, surface_(rectangle(1.0, 1.0), e, 0.0, 0.0));
        let id = add(&mut world, moving(surface_(rectangle(1.0, 1.0), e, 1.1, 1.1), -10.0, -9.0));
        for _ in 0..4 {
            world.step();
            println!("{:?} overlap {:e}", Free::of(&world, id), worst_overlap(&world));
        }
    }
}
fn surface_(c: ColliderDef, e: f64, x: f64, y: f64) -> BodyDef {
    solid(x, y, surface(c, 0.0, e))
}
