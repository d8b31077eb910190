//! Evidence: what is shown follows from the state alone, survives its file, and names what differs.
#![cfg(feature = "cli")]
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use tamias2d::World;
use tamias2d::replay::Evidence;
use tamias2d::scene::Scene;

const SCENES: [&str; 15] = [
    "free_flight",
    "spin",
    "orbit",
    "everything",
    "tc10c",
    "tc11c",
    "pyramid55",
    "pusher",
    "sensors",
    "churn",
    "pixels",
    "tumbler",
    "bouncers",
    "pile300",
    "sleep",
];

fn scene(name: &str) -> Scene {
    let path = format!("{}/replays/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Scene::parse(&std::fs::read_to_string(path).expect("a scene")).expect("a scene")
}

/// All that is shown of each stage follows from the state: a world that was loaded shows the same.
#[test]
fn a_loaded_world_shows_the_same_at_every_stage() {
    for name in SCENES {
        let scene = scene(name);
        let (mut world, mut script) = scene.start().expect("it starts");
        let mut compared = 0;
        for tick in 0..scene.ticks().min(400) {
            script.apply(tick, &mut world).expect("its commands are accepted");
            if tick % 7 == 3 || tick > 300 && tick < 310 {
                let mut twin = World::load(&world.save()).expect("just saved");
                let (a, b) = (Evidence::of_step(&mut world), Evidence::of_step(&mut twin));
                let difference = a.first_difference(&b).expect("evidence");
                assert_eq!(difference, None, "{name}, tick {tick}");
                assert_eq!(a.hash(), b.hash(), "{name}, tick {tick}");
                compared += 1;
            } else {
                world.step();
            }
        }
        println!("{name}: {compared} ticks");
    }
}
