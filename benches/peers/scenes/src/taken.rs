//! Scenes taken from the project's benches. Their names are those of the benches' cases.

use crate::shared::{self, Form, MILLI, Micro, ONE, Pair, Part, exact, hard};
use crate::{Body, Geom, Kind, Scene, V};

fn metres(pair: Pair) -> V {
    pair.map(|micro| micro as f64 / ONE as f64)
}

fn angle([x, y]: Pair) -> f64 {
    (y as f64).atan2(x as f64)
}

fn geom(part: &Part) -> Geom {
    let half = |micro: Micro| micro as f64 / ONE as f64 / 2.0;
    let (at, (sin, cos)) = (metres(part.at), angle(part.facing).sin_cos());
    let place = |[x, y]: V| [at[0] + cos * x - sin * y, at[1] + sin * x + cos * y];
    let moved = part.at != [0, 0] || part.facing != [1, 0];
    match &part.form {
        Form::Box(w, h) if moved => {
            let (w, h) = (half(*w), half(*h));
            Geom::Poly([[-w, -h], [w, -h], [w, h], [-w, h]].map(place).to_vec())
        }
        Form::Box(w, h) => Geom::Box(half(*w), half(*h)),
        Form::Disc(r) => {
            assert!(!moved, "no scene has a disc beside its body's origin");
            Geom::Circle(2.0 * half(*r))
        }
        Form::Polygon(corners) => Geom::Poly(corners.iter().map(|&corner| place(metres(corner))).collect()),
    }
}

fn body(thing: &shared::Thing) -> Body {
    assert!(thing.damping == [0, 0] && !thing.fixed_rotation, "engines do not agree on what damping is");
    let kind = match thing.kind {
        shared::Kind::Static => Kind::Static,
        shared::Kind::Kinematic => Kind::Kinematic,
        shared::Kind::Dynamic => Kind::Dynamic,
    };
    Body {
        kind,
        pos: metres(thing.at),
        angle: angle(thing.facing),
        vel: metres(thing.velocity),
        omega: thing.spin as f64 / ONE as f64,
        shapes: thing.parts.iter().map(geom).collect(),
        // A mass that is given is that of a form of 1 m² here.
        density: thing.inertia.map_or(thing.density, |(mass, _)| mass) as f64 / ONE as f64,
        collide: true,
    }
}

fn taken(name: &'static str, group: &'static str, scene: &shared::Scene, steps: usize) -> Scene {
    assert!(scene.attractors.is_empty());
    Scene {
        gravity: metres(scene.gravity),
        friction: scene.friction as f64 / ONE as f64,
        restitution: scene.restitution as f64 / ONE as f64,
        bodies: scene.things.iter().map(body).collect(),
        windows: vec![("all", 0, steps)],
        ..Scene::new(name, group, steps)
    }
}

/// Those with a known outcome that all engines can be given, for as many steps of 1/60 s as the benches run them.
pub fn accuracy() -> Vec<Scene> {
    let far = 1_000_000 * ONE;
    let scenes = [
        ("throw", exact::throw(), 60),
        ("spin", exact::spin(), 3600),
        ("drift-far", exact::drift(far), 600),
        ("topple", exact::topple(), 36),
        ("slide", exact::sliding_stop(0), 180),
        ("slide-far", exact::sliding_stop(far), 180),
        ("incline", exact::incline(), 60),
        ("incline-roll", exact::incline_roll(), 60),
        ("slide-to-roll", exact::slide_to_roll(), 120),
        ("incline-rest", exact::incline_rest(), 600),
        ("bounce-disc", exact::bounce(true, 800 * MILLI), 240),
        ("bounce-box", exact::bounce(false, 500 * MILLI), 240),
        ("head-on", exact::head_on(), 180),
        ("typical", exact::typical(), 180),
        ("one-hits-two", exact::one_hits_two(), 180),
        ("corner-on-bar", exact::corner_on_bar(), 30),
        ("turning-corner", exact::turning_corner(), 60),
        ("gas", exact::gas(50), 600),
        ("stack", exact::stack(10, ONE), 600),
        ("heavy", exact::stack(2, 100 * ONE), 600),
    ];
    let all = |(name, scene, steps): &(&'static str, shared::Scene, usize)| Scene {
        track_every: 1,
        ..taken(name, "accuracy", scene, *steps)
    };
    scenes.iter().map(all).collect()
}

/// The hard ones. States are told at the start, in the middle and at the end.
pub fn hard() -> Vec<Scene> {
    let all = |case: &hard::Case| {
        let steps = case.ticks as usize;
        Scene { track_every: steps / 2, ..taken(case.name, "hard", &case.scene, steps) }
    };
    hard::all().iter().map(all).collect()
}
