//! What a world does after it was read: some ticks, beside a twin that is read from a save of it.

use super::{is_small, sound};
use tamias2d::World;

/// Steps a world if it is small, and says how far it came.
pub fn run(mut world: World, ticks: u64) -> World {
    sound(&world);
    if !is_small(&world) {
        return world;
    }
    let mut twin = World::load(&world.save()).expect("what was saved is read");
    for _ in 0..ticks {
        world.step();
        twin.step();
        sound(&world);
        assert!(world.hash() == twin.hash(), "tick {}: {:?}", world.tick(), world.diff(&twin).first());
        assert_eq!(world.events(), twin.events(), "tick {}", world.tick());
    }
    world
}
