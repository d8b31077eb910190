//! Scenes as JSON.

use super::{LONGEST, MOST_TICKS, is_small, sound};
use tamias2d::scene::Scene;

/// The input as text: read, begun, and played for some ticks.
pub fn run(data: &[u8]) -> bool {
    let Ok(text) = core::str::from_utf8(data) else { return false };
    if text.len() > LONGEST {
        return false;
    }
    let scene = match Scene::parse(text) {
        Ok(scene) => scene,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    let Ok((mut world, mut script)) = scene.start() else { return false };
    for tick in 0..scene.ticks().min(MOST_TICKS) {
        if !is_small(&world) || script.apply(tick, &mut world).is_err() {
            break;
        }
        world.step();
        sound(&world);
    }
    // Scripts name ticks that are far away as well.
    let _may_be_refused = is_small(&world).then(|| script.apply(u64::MAX, &mut world));
    sound(&world);
    true
}
