//! What `.ci/cross` plays on every platform: nothing is compared there that does not occur here.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod play;

use play::scene::{Scene, TICKS};
use play::{SEEDS, golden, random};
use std::collections::{BTreeMap, BTreeSet};
use tamias2d::{BodyId, Command, Threads, World};

/// How often what occurred.
#[derive(Default)]
struct Seen(BTreeMap<String, u64>);

impl Seen {
    fn note(&mut self, what: impl Into<String>) {
        *self.0.entry(what.into()).or_default() += 1;
    }

    fn command(&mut self, command: &Command, accepted: bool) {
        // The variant's name.
        let text = format!("{command:?}");
        let name = text.split([' ', '{']).next().unwrap_or_default();
        self.note(format!("{} {name}", if accepted { "accepted" } else { "refused" }));
        let Command::CreateBody { def } = command else { return };
        if accepted {
            self.note(format!("{:?} with {} colliders", def.kind, def.colliders.len()));
            for collider in &def.colliders {
                let text = format!("{:?}", collider.shape);
                self.note(text.split([' ', '{']).next().unwrap_or_default());
            }
        }
    }

    /// What a step has done; `quiet`: no command was carried out before it.
    fn step(&mut self, before: &World, world: &World, quiet: bool) {
        for event in world.events() {
            self.note(event.kind.to_string());
        }
        for _ in world.collisions() {
            self.note("collision");
        }
        for entry in world.status().entries() {
            self.note(format!("limited {}", entry.bound));
        }
        let asleep = |world: &World| -> BTreeSet<BodyId> {
            world.bodies().filter(|body| !body.is_awake()).map(|body| body.id()).collect()
        };
        let (then, now) = (asleep(before), asleep(world));
        if quiet && now.difference(&then).next().is_some() {
            self.note("fell asleep by itself");
        }
        if quiet && then.difference(&now).next().is_some() {
            self.note("woken by a touch");
        }
        // How a contact is solved: 0 by sweeps, from 1 on directly.
        for difference in before.diff(world).iter().filter(|difference| difference.path.ends_with(".mode")) {
            self.note(format!("solved in mode {}", difference.b.split(' ').next().unwrap_or_default()));
        }
    }
}

#[test]
fn everything_occurs_in_the_scenes() {
    let mut seen = Seen::default();
    for seed in SEEDS {
        let mut scene = Scene::new(seed);
        while scene.world.tick() < TICKS {
            let (before, mut quiet) = (scene.world.clone(), true);
            scene.tick(&Threads::default(), |command, accepted| {
                quiet = false;
                seen.command(command, accepted);
            });
            seen.step(&before, &scene.world, quiet);
        }
        seen.note(format!("unit_shift {}", scene.world.config().unit_shift));
        seen.note(format!("{:?}", scene.world.config().integrator));
    }
    let commands = [
        "CreateBody",
        "DestroyBody",
        "SetKind",
        "SetPosition",
        "SetAngle",
        "SetVelocity",
        "SetAngularVelocity",
        "SetForce",
        "SetTorque",
        "SetMass",
        "SetFixedRotation",
        "SetDamping",
        "SetMu",
        "SetUserData",
        "ApplyForce",
        "ApplyTorque",
        "ApplyImpulse",
        "ApplyAngularImpulse",
        "CreateAttractor",
        "SetAttractor",
        "DestroyAttractor",
        "SetGravity",
        "SetSurface",
        "SetFilter",
        "SetAllowSleep",
        "Wake",
        "PutToSleep",
        "ClearStatus",
        "Input",
    ];
    let expected = commands.map(|name| format!("accepted {name}")).into_iter();
    // These two cannot be refused as they are drawn.
    let refusable = commands.into_iter().filter(|name| !["ClearStatus", "Input"].contains(name));
    let expected = expected.chain(refusable.map(|name| format!("refused {name}")));
    let others = [
        "Circle",
        "Box",
        "Polygon",
        "Dynamic with 0 colliders",
        "Dynamic with 1 colliders",
        "Dynamic with 3 colliders",
        "Kinematic with 1 colliders",
        "Static with 1 colliders",
        "contact_begin",
        "contact_end",
        "sensor_begin",
        "sensor_end",
        "collision",
        "fell asleep by itself",
        "woken by a touch",
        "solved in mode 0",
        "solved in mode 1",
        "solved in mode 2",
        "limited position",
        "limited count of turns",
        "limited velocity",
        "limited angular velocity",
        "limited acceleration",
        "limited speed in contact",
        "limited number of impacts in a tick",
        "unit_shift 0",
        "unit_shift 10",
        "ForestRuth",
        "SymplecticEuler",
    ];
    for (what, count) in &seen.0 {
        println!("{count:8} {what}");
    }
    let missing: Vec<String> =
        expected.chain(others.map(String::from)).filter(|what| !seen.0.contains_key(what)).collect();
    assert!(missing.is_empty(), "never occurs: {missing:?}");
}

#[test]
fn scenes_hold_their_invariants_and_play_twice_alike() {
    for seed in SEEDS {
        let lines = random(seed, &Threads::default()).expect("the invariants hold");
        assert_eq!(lines.lines().count() as u64, TICKS + 1);
        assert!(lines == random(seed, &Threads::default()).expect("as before"), "scene {seed} differs from itself");
    }
}

#[test]
fn a_recording_that_does_not_play_has_no_stream() {
    let replay = include_bytes!("../../replays/pusher.replay");
    assert_eq!(golden("pusher", replay, &Threads::default()).expect("it plays").lines().count(), 301);
    let mut broken = replay.to_vec();
    let middle = broken.len() / 2;
    broken[middle] ^= 1;
    golden("pusher", &broken, &Threads::default()).expect_err("a bit was flipped");
}
