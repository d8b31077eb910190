//! State: the same commands give the same hash, a save continues as its world did, and nothing else loads.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{Rng, Storm, acc, at, disc, measure, newton_seconds, newtons, num, rectangle, run, vel, world};
use proptest::prelude::{ProptestConfig, any, prop_assert, prop_assert_eq, prop_assert_ne, proptest};
use tamias2d::{
    Angle, Attractor, AttractorId, BodyDef, BodyId, BodyKind, ColliderDef, ColliderId, CommandError, Commands,
    DecodeError, Filter, HashPart, Integrator, LAW, SAVE_VERSION, Sleeping, Vec2, World, WorldDef,
};

#[global_allocator]
static ALLOCATOR: common::Counting = common::Counting;

fn few_cases() -> ProptestConfig {
    ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() }
}

/// A world in which much has happened.
fn stormy(seed: u64, ticks: u64) -> (World, Storm) {
    let mut storm = Storm::solid(seed, 1e6);
    let mut world = world(0.0, -9.8);
    for _ in 0..ticks {
        let commands = storm.rng.below(6);
        storm.tick(&mut world, commands);
    }
    (world, storm)
}

#[test]
fn the_same_commands_give_the_same_hash_at_every_tick() {
    for seed in 0..20 {
        let (mut one, mut other) = (Storm::solid(seed, 1e6), Storm::solid(seed, 1e6));
        let (mut a, mut b) = (world(0.0, -9.8), world(0.0, -9.8));
        for tick in 0..200 {
            assert_eq!(a.tick(), tick);
            one.tick(&mut a, tick % 5);
            other.tick(&mut b, tick % 5);
            assert_eq!(a.hash(), b.hash());
            assert_eq!(a.hash_parts(), b.hash_parts());
        }
        assert_eq!(a.save(), b.save());
        assert_eq!(a.diff(&b), []);
    }
}

proptest! {
    #![proptest_config(few_cases())]

    /// A world that is saved between any two commands, loaded, and goes on, goes on as the one that was not.
    #[test]
    fn a_loaded_world_continues_as_the_saved_one(seed in any::<u64>(), ticks in 1u64..120, cut in 0u64..120) {
        let mut storm = Storm::solid(seed, 1e6);
        let mut world = world(0.0, -9.8);
        let mut copy: Option<(World, Storm)> = None;
        for tick in 0..ticks {
            let before = storm.rng.below(4);
            for _ in 0..before {
                let _refused_or_not = storm.act(&mut world);
            }
            if tick == cut % ticks {
                let bytes = world.save();
                let loaded = World::load(&bytes).expect("just saved");
                prop_assert_eq!(loaded.save(), bytes);
                prop_assert_eq!(loaded.diff(&world), []);
                prop_assert!(loaded.check().is_ok());
                copy = Some((loaded, storm.clone()));
            }
            let after = storm.rng.below(4);
            storm.tick(&mut world, after);
            if let Some((copy, other)) = &mut copy {
                // The storm's own random numbers, from the same place.
                if tick != cut % ticks {
                    let before = other.rng.below(4);
                    for _ in 0..before {
                        let _refused_or_not = other.act(copy);
                    }
                }
                let after = other.rng.below(4);
                other.tick(copy, after);
                prop_assert_eq!(copy.hash(), world.hash());
            }
        }
        let (copy, _) = copy.expect("the cut is inside");
        prop_assert_eq!(copy.save(), world.save());
    }

    /// Every invariant holds after each tick and between any two commands.
    #[test]
    fn every_invariant_holds_in_a_storm_of_commands(seed in any::<u64>(), ticks in 1u64..60) {
        let mut storm = Storm::solid(seed, 1e9);
        let mut world = World::new(&WorldDef {
            integrator: if seed % 2 == 0 { Integrator::ForestRuth } else { Integrator::SymplecticEuler },
            tick_rate: 15 + (seed % 100) as u32,
            ..WorldDef::default()
        })
        .expect("accepted");
        for _ in 0..ticks {
            for _ in 0..storm.rng.below(8) {
                let _refused_or_not = storm.act(&mut world);
                prop_assert_eq!(world.check(), Ok(()));
            }
            world.step();
            prop_assert_eq!(world.check(), Ok(()));
            prop_assert_eq!(world.bodies().count(), world.body_count() as usize);
        }
    }

    /// A clone, and a clone into a world that was another, are the world, and go on as it does.
    #[test]
    fn clones_are_equal_and_continue_alike(seed in any::<u64>(), other in any::<u64>(), ticks in 1u64..60) {
        let (mut world, mut storm) = stormy(seed, ticks);
        let mut clone = world.clone();
        let mut buffer = stormy(other, 61 - ticks).0;
        prop_assert_ne!(buffer.hash(), world.hash());
        buffer.clone_from(&world);
        for _ in 0..10 {
            prop_assert_eq!(clone.hash(), world.hash());
            prop_assert_eq!(buffer.hash(), world.hash());
            prop_assert_eq!(buffer.save(), world.save());
            prop_assert!(buffer.check().is_ok() && clone.check().is_ok());
            let mut same = [storm.clone(), storm.clone()];
            same[0].tick(&mut clone, 3);
            same[1].tick(&mut buffer, 3);
            storm.tick(&mut world, 3);
        }
    }

    /// Saves with random bytes changed, and with the hash that fits them, are refused or are worlds.
    #[test]
    fn forged_saves_are_refused_or_are_worlds(seed in any::<u64>(), ticks in 1u64..30) {
        let (world, mut storm) = stormy(seed, ticks);
        let save = world.save();
        for _ in 0..50 {
            let mut bytes = save.clone();
            for _ in 0..=storm.rng.below(3) {
                let at = 16 + storm.rng.below(save.len() as u64 - 24) as usize;
                bytes[at] = [0, 1, 0x7f, 0x80, 0xff, storm.rng.bits() as u8][storm.rng.below(6) as usize];
            }
            forge(&mut bytes);
        }
    }
}

/// Gives changed bytes the hash that the state in them has, as a forger could, and plays what loads.
fn forge(bytes: &mut [u8]) -> bool {
    if let Err(DecodeError::Hash { computed, .. }) = World::load(bytes) {
        let at = bytes.len() - 8;
        bytes[at..].copy_from_slice(&computed.to_le_bytes());
    }
    match World::load(bytes) {
        Ok(mut world) => {
            assert_eq!(world.check(), Ok(()));
            assert_eq!(world.save(), bytes);
            let mut storm = Storm::solid(bytes.len() as u64, 1e9);
            for _ in 0..3 {
                world.step();
                assert_eq!(world.check(), Ok(()));
                storm.tick(&mut world, 6);
                assert_eq!(world.check(), Ok(()));
            }
            true
        }
        Err(error) => {
            assert!(!matches!(error, DecodeError::Hash { .. }), "{error}");
            false
        }
    }
}

/// Everything that a world can hold, in few bytes.
fn small() -> World {
    let mut world = world(0.5, -9.8);
    let gone = world.create_body(&BodyDef::default()).expect("accepted");
    let body = world
        .create_body(&BodyDef {
            position: at(1.0, 2.0),
            velocity: vel(3.0, 32_767.9),
            linear_damping: num("0.5"),
            mu: num("3"),
            colliders: vec![disc(0.5), rectangle(1.0, 2.0)],
            ..BodyDef::default()
        })
        .expect("accepted");
    // A box on the floor, in a sensor.
    let colliders = vec![rectangle(5.0, 1.0), ColliderDef { sensor: true, ..disc(3.0) }];
    let floor = BodyDef { kind: BodyKind::Static, position: at(100.0, 0.0), colliders, ..BodyDef::default() };
    world.create_body(&floor).expect("accepted");
    let colliders = vec![rectangle(1.0, 1.0)];
    world.create_body(&BodyDef { position: at(100.0, 1.0), colliders, ..BodyDef::default() }).expect("accepted");
    world.destroy_body(gone).expect("accepted");
    let lost = world.create_attractor(Attractor { position: at(5.0, 5.0), mu: num("7") }).expect("accepted");
    world.create_attractor(Attractor { position: at(50.0, 5.0), mu: num("7") }).expect("accepted");
    world.destroy_attractor(lost).expect("accepted");
    world.set_force(body, newtons(0.0, 32_000.0)).expect("accepted");
    run(&mut world, 3);
    assert!(!world.status().is_clear());
    assert_eq!(world.colliders().count(), 5);
    world.apply_force(body, newtons(0.25, -1.0), Some(at(0.0, 0.0))).expect("accepted");
    world
}

#[test]
fn every_truncation_of_a_save_is_refused() {
    let save = small().save();
    for length in 0..save.len() {
        let cut = &save[..length];
        let (result, _, largest) = measure(|| World::load(cut));
        let error = result.expect_err("a truncated save does not load");
        match error {
            DecodeError::NotASave => assert!(length < 8, "{length}"),
            DecodeError::Truncated { offset, .. } => assert!(offset <= length as u64),
            other => panic!("{length} bytes give {other}"),
        }
        assert!(largest <= save.len().max(8192), "{length} bytes allocate {largest}");
    }
}

#[test]
fn every_flipped_bit_of_a_save_is_refused_and_a_forged_one_is_a_world_or_refused() {
    let save = small().save();
    let (mut worlds, mut refused) = (0, 0);
    for at in 0..save.len() {
        for bit in 0..8 {
            let mut bytes = save.clone();
            bytes[at] ^= 1 << bit;
            let (result, _, largest) = measure(|| World::load(&bytes));
            let error = result.expect_err("a changed save does not load");
            assert!(largest <= save.len().max(8192), "byte {at} bit {bit} allocates {largest}");
            match at {
                0..8 => assert_eq!(error, DecodeError::NotASave),
                8..12 => assert!(matches!(error, DecodeError::Version { known: SAVE_VERSION, .. }), "{error}"),
                12..16 => assert!(matches!(error, DecodeError::Law { known: LAW, .. }), "{error}"),
                _ => {
                    let forged = at < save.len() - 8 && forge(&mut bytes);
                    worlds += u32::from(forged);
                    refused += u32::from(!forged);
                }
            }
        }
    }
    println!("a save of {} bytes: {worlds} flips give another world when forged, {refused} none", save.len());
    assert!(worlds > 1000 && refused > 100);
}

#[test]
fn loading_reserves_no_more_than_a_few_times_the_bytes() {
    let mut world = world(0.0, 0.0);
    for i in 0..500u32 {
        let def = BodyDef { linear_damping: num("1"), user_data: u64::from(i), ..BodyDef::default() };
        world.create_body(&def).expect("accepted");
    }
    let save = world.save();
    let (result, _, largest) = measure(|| World::load(&save));
    assert!(result.is_ok());
    println!("a save of {} bytes loads with a largest allocation of {largest}", save.len());
    assert!(largest <= 2 * save.len(), "{largest} bytes for a save of {}", save.len());
    // A count that claims more than there are bytes reserves nothing: the first one is that of the slots.
    for claimed in [501u32, 1000, 1 << 20, u32::MAX] {
        let count = 500u32.to_le_bytes();
        let places: Vec<usize> = (16..save.len() - 4).filter(|&at| save[at..at + 4] == count).collect();
        assert!(places.len() >= 7, "the slots and six columns have counts");
        for at in places {
            let mut bytes = save.clone();
            bytes[at..at + 4].copy_from_slice(&claimed.to_le_bytes());
            let (result, _, largest) = measure(|| World::load(&bytes));
            assert!(result.is_err());
            assert!(largest <= 2 * save.len(), "{largest} bytes for a save of {}", save.len());
        }
    }
}

#[test]
fn what_is_no_save_is_refused_in_these_words() {
    let save = small().save();
    let text = |bytes: &[u8]| World::load(bytes).expect_err("no save").to_string();
    assert_eq!(text(b""), "not a saved tamias2d world");
    assert_eq!(text(b"TAMIAS-R and more of it"), "not a saved tamias2d world");
    assert_eq!(text(b"TAMIAS-W"), "the bytes end inside format version at byte 8");
    assert_eq!(text(&save[..14]), "the bytes end inside arithmetic law at byte 12");
    assert_eq!(text(&save[..save.len() - 1]), format!("the bytes end inside hash at byte {}", save.len() - 8));
    let changed = |at: usize, value: u32| {
        let mut bytes = save.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let version = format!("this build reads version {SAVE_VERSION}: load it with a build of version 1");
    assert_eq!(text(&changed(8, 1)), format!("saved in format version 1, {version}"));
    let law = format!("this build computes by law {LAW}: continue it with a build of law 77");
    assert_eq!(text(&changed(12, 77)), format!("saved under arithmetic law 77, {law}"));
    let mut longer = save.clone();
    longer.push(0);
    assert_eq!(text(&longer), format!("unexpected bytes after the end at byte {}", save.len()));
    let mut bytes = save.clone();
    let last = bytes.len() - 8;
    bytes[last..].copy_from_slice(&[0xab; 8]);
    let hash = small().hash();
    let told = text(&bytes);
    let other = format!("the state read has hash {hash:016x}, saved was abababababababab");
    assert_eq!(told, format!("{other}: the bytes were changed on their way, fetch them again"));
    // The tick rate and the substeps are checked even where the hash fits.
    for (at, value, reason) in [
        (16, 14, "breaks an invariant of worlds"),
        (16, 0, "breaks an invariant of worlds"),
        (20, 65, "breaks an invariant of worlds"),
        (20, 0, "breaks an invariant of worlds"),
    ] {
        let mut bytes = changed(at, value);
        assert!(!forge(&mut bytes));
        assert_eq!(text(&bytes), format!("world at byte 16 {reason}"));
    }
}

#[test]
fn save_into_reuses_its_buffer() {
    let world = stormy(1, 50).0;
    let mut bytes = vec![7; 3];
    world.save_into(&mut bytes);
    assert_eq!(bytes, world.save());
    let ((), allocations, _) = measure(|| world.save_into(&mut bytes));
    assert_eq!(allocations, 0);
}

/// A world of `count` bodies with forces, damping, attraction and free slots.
fn busy(count: u32) -> (World, Vec<BodyId>) {
    let mut world = world(0.0, -9.8);
    let ids: Vec<BodyId> = (0..count)
        .map(|i| {
            let def = BodyDef {
                position: at(f64::from(i), 0.0),
                velocity: vel(1.0, f64::from(i) * 0.1),
                linear_damping: num(if i % 3 == 0 { "0.5" } else { "0" }),
                mu: num(if i % 10 == 0 { "0.001" } else { "0" }),
                colliders: if i % 3 == 0 { vec![disc(0.55)] } else { vec![rectangle(0.9, 0.9)] },
                ..BodyDef::default()
            };
            world.create_body(&def).expect("accepted")
        })
        .collect();
    world.create_attractor(Attractor { position: at(0.0, -100.0), mu: num("10") }).expect("accepted");
    for id in ids.iter().skip(1).step_by(4) {
        world.destroy_body(*id).expect("accepted");
    }
    (world, ids)
}

#[test]
fn a_clone_into_a_used_world_allocates_nothing() {
    let (mut source, ids) = busy(200);
    let mut touched = false;
    let states: Vec<World> = (0..50)
        .map(|_| {
            for id in &ids {
                let _refused_or_not = source.apply_force(*id, newtons(1.0, 0.0), None);
            }
            let state = source.clone();
            source.step();
            touched |= !source.events().is_empty();
            state
        })
        .collect();
    assert!(touched);
    let mut buffer = source.clone();
    for pass in 0..2 {
        for (tick, state) in states.iter().enumerate() {
            // The first time the buffer has no room for as many contacts and forces of a tick.
            let ((), allocations, _) = measure(|| buffer.clone_from(state));
            assert!(pass == 0 || allocations == 0, "tick {tick}: {allocations} allocations");
            assert_eq!(buffer.hash(), state.hash());
        }
    }
    // Nor does a clone into a world that held more.
    let (small, _) = busy(20);
    let ((), allocations, _) = measure(|| buffer.clone_from(&small));
    assert_eq!(allocations, 0);
    assert_eq!(buffer.save(), small.save());
}

#[test]
fn a_step_and_a_hash_allocate_nothing() {
    let (mut world, ids) = busy(200);
    // A body whose limits are hit again and again.
    let fast = world.create_body(&BodyDef { velocity: vel(0.0, 32_767.0), ..BodyDef::default() }).expect("accepted");
    world.set_force(fast, newtons(0.0, 32_000.0)).expect("accepted");
    let tick = |world: &mut World| {
        for id in &ids {
            let _refused_or_not = world.apply_force(*id, newtons(1.0, 0.0), None);
            let _refused_or_not = world.apply_torque(*id, num("1"));
        }
        world.step();
        world.hash()
    };
    // Once through, so that there is room for as many contacts.
    let _hashes = [tick(&mut world), tick(&mut world)];
    let start = world.clone();
    let mut first: Vec<u64> = (0..100).map(|_| tick(&mut world)).collect();
    world.clone_from(&start);
    let mut again = Vec::with_capacity(100);
    let ((), allocations, _) = measure(|| again.extend((0..100).map(|_| tick(&mut world))));
    assert_eq!(allocations, 0);
    assert_eq!(again, first);
    first.dedup();
    assert_eq!(first.len(), 100);
}

#[test]
fn fr_simulation_space_ids_slots_and_their_order() {
    let mut world = world(0.0, 0.0);
    let def = |user_data| BodyDef { user_data, ..BodyDef::default() };
    let ids: Vec<BodyId> = (0..4).map(|i| world.create_body(&def(i)).expect("accepted")).collect();
    assert_eq!(ids, [0, 1, 2, 3].map(|index| BodyId { index, generation: 0 }));
    assert_eq!(world.body_count(), 4);

    world.destroy_body(ids[1]).expect("accepted");
    world.destroy_body(ids[3]).expect("accepted");
    assert_eq!(world.body_count(), 2);
    let order = |world: &World| world.bodies().map(|body| (body.id(), body.user_data())).collect::<Vec<_>>();
    assert_eq!(order(&world), [(ids[0], 0), (ids[2], 2)]);
    for &stale in [&ids[1], &ids[3]] {
        assert!(world.body(stale).is_none());
        assert_eq!(world.destroy_body(stale), Err(CommandError::NoSuchBody(stale)));
        assert_eq!(world.set_user_data(stale, 1).expect_err("stale").to_string(), format!("there is no {stale}"));
    }
    assert_eq!(ids[3].to_string(), "body 3v0");

    // Last in, first out; each time with the next generation.
    let again = [world.create_body(&def(10)).expect("accepted"), world.create_body(&def(11)).expect("accepted")];
    assert_eq!(again, [BodyId { index: 3, generation: 1 }, BodyId { index: 1, generation: 1 }]);
    assert_eq!(world.create_body(&def(12)).expect("accepted"), BodyId { index: 4, generation: 0 });
    let values: Vec<u64> = order(&world).into_iter().map(|(_, value)| value).collect();
    assert_eq!(values, [0, 11, 2, 10, 12]);
    assert!(world.body(ids[1]).is_none() && world.body(ids[3]).is_none());
    assert!(world.body(BodyId { index: 1, generation: 2 }).is_none(), "a generation that is still to come");
    assert!(world.body(BodyId { index: 5, generation: 0 }).is_none());
    assert!(world.body(BodyId { index: u32::MAX, generation: u32::MAX }).is_none());
    world.destroy_body(again[1]).expect("accepted");
    assert_eq!(world.create_body(&def(13)).expect("accepted"), BodyId { index: 1, generation: 2 });

    // The same for attractors.
    let star = Attractor { position: at(0.0, 0.0), mu: num("1") };
    let ids: Vec<AttractorId> = (0..3).map(|_| world.create_attractor(star).expect("accepted")).collect();
    world.destroy_attractor(ids[0]).expect("accepted");
    world.destroy_attractor(ids[2]).expect("accepted");
    assert_eq!(world.attractor(ids[0]), None);
    assert_eq!(world.attractors().collect::<Vec<_>>(), [(ids[1], star)]);
    assert_eq!(world.destroy_attractor(ids[0]), Err(CommandError::NoSuchAttractor(ids[0])));
    assert_eq!(world.set_attractor(ids[2], star).expect_err("stale").to_string(), "there is no attractor 2v0");
    assert_eq!(world.create_attractor(star).expect("accepted"), AttractorId { index: 2, generation: 1 });
    world.check().expect("every invariant holds");
}

#[test]
fn the_order_of_destruction_is_state() {
    let make = |order: [usize; 2]| {
        let mut world = world(0.0, 0.0);
        let ids: Vec<BodyId> = (0..3).map(|_| world.create_body(&BodyDef::default()).expect("accepted")).collect();
        for at in order {
            world.destroy_body(ids[at]).expect("accepted");
        }
        world
    };
    let (mut one, mut other) = (make([0, 1]), make([1, 0]));
    assert_ne!(one.hash(), other.hash());
    let paths: Vec<String> = one.diff(&other).into_iter().map(|d| d.path).collect();
    assert_eq!(paths, ["bodies[0].link", "bodies[1].link", "bodies.slots.free"]);
    // As it must be: the next body gets another id.
    let (a, b) = (one.create_body(&BodyDef::default()), other.create_body(&BodyDef::default()));
    assert_ne!(a, b);
    // What is destroyed leaves nothing but its slot's place in that chain.
    let mut trace = world(0.0, 0.0);
    let id = trace
        .create_body(&BodyDef { position: at(1.0, 2.0), user_data: 5, mu: num("3"), ..BodyDef::default() })
        .expect("accepted");
    trace.destroy_body(id).expect("accepted");
    let mut plain = world(0.0, 0.0);
    let id = plain.create_body(&BodyDef::default()).expect("accepted");
    plain.destroy_body(id).expect("accepted");
    assert_eq!(trace.save(), plain.save());
}

const FOURTH: ColliderId = ColliderId { index: 3, generation: 0 };

/// Five bodies and two attractors, none at rest; the fourth body is the one to change.
fn base() -> (World, Vec<BodyId>, Vec<AttractorId>) {
    let mut world = world(0.25, -9.75);
    let ids = (0..5)
        .map(|i| {
            let x = f64::from(i);
            let def = BodyDef {
                position: at(x, 1.0),
                velocity: vel(2.0, x),
                angular_velocity: num("0.5"),
                angle: Angle::from_bits(12_345),
                user_data: 42,
                mass: Some(num("1")),
                inertia: Some(num("1")),
                colliders: vec![disc(0.25)],
                ..BodyDef::default()
            };
            world.create_body(&def).expect("accepted")
        })
        .collect();
    let star = Attractor { position: at(100.0, 100.0), mu: num("5") };
    let stars = (0..2).map(|_| world.create_attractor(star).expect("accepted")).collect();
    (world, ids, stars)
}

/// The names of the parts whose hashes differ.
fn parts(a: &World, b: &World) -> Vec<&'static str> {
    let differ = |(a, b): (HashPart, HashPart)| (a.hash != b.hash).then_some(a.name);
    a.hash_parts().into_iter().zip(b.hash_parts()).filter_map(differ).collect()
}

#[test]
fn every_field_is_in_the_hash_and_a_difference_is_named_by_its_path() {
    type Change = fn(&mut World, BodyId, AttractorId) -> Result<(), CommandError>;
    let (world, ids, stars) = base();
    let changes: [(&str, &str, Change); 30] = [
        ("bodies[3].position.x", "motion", |w, b, _| w.set_position(b, at(3.5, 1.0))),
        ("bodies[3].position.y", "motion", |w, b, _| w.set_position(b, at(3.0, 1.5))),
        ("bodies[3].velocity.x", "motion", |w, b, _| w.set_velocity(b, vel(2.5, 3.0))),
        ("bodies[3].velocity.y", "motion", |w, b, _| w.set_velocity(b, vel(2.0, 3.5))),
        ("bodies[3].velocity.x", "motion", |w, b, _| w.apply_impulse(b, newton_seconds(0.5, 0.0), None)),
        ("bodies[3].angle", "motion", |w, b, _| w.set_angle(b, Angle::from_bits(12_346))),
        ("bodies[3].angular_velocity", "motion", |w, b, _| w.set_angular_velocity(b, num("0.75"))),
        ("bodies[3].angular_velocity", "motion", |w, b, _| w.apply_angular_impulse(b, num("0.75"))),
        ("bodies[3].force.x", "bodies", |w, b, _| w.set_force(b, newtons(1.0, 0.0))),
        ("bodies[3].force.y", "bodies", |w, b, _| w.set_force(b, newtons(0.0, 1.0))),
        ("bodies[3].torque", "bodies", |w, b, _| w.set_torque(b, num("1"))),
        ("bodies[3].mass", "bodies", |w, b, _| w.set_mass(b, num("2"), num("1"))),
        ("bodies[3].inertia", "bodies", |w, b, _| w.set_mass(b, num("1"), num("2"))),
        ("bodies[3].linear_damping", "bodies", |w, b, _| w.set_damping(b, num("1"), num("0"))),
        ("bodies[3].angular_damping", "bodies", |w, b, _| w.set_damping(b, num("0"), num("1"))),
        ("bodies[3].mu", "bodies", |w, b, _| w.set_mu(b, num("1"))),
        ("bodies[3].user_data", "bodies", |w, b, _| w.set_user_data(b, 43)),
        ("bodies[3].kind", "bodies", |w, b, _| w.set_kind(b, BodyKind::Kinematic)),
        ("attractors[1].position.x", "attractors", |w, _, a| {
            w.set_attractor(a, Attractor { position: at(100.5, 100.0), mu: num("5") })
        }),
        ("attractors[1].position.y", "attractors", |w, _, a| {
            w.set_attractor(a, Attractor { position: at(100.0, 100.5), mu: num("5") })
        }),
        ("attractors[1].mu", "attractors", |w, _, a| {
            w.set_attractor(a, Attractor { position: at(100.0, 100.0), mu: num("6") })
        }),
        ("colliders[3].restitution", "colliders", |w, _, _| w.set_surface(FOURTH, num("0.5"), num("0.6"))),
        ("colliders[3].friction", "colliders", |w, _, _| w.set_surface(FOURTH, num("0"), num("0.5"))),
        ("colliders[3].filter.category", "colliders", |w, _, _| {
            w.set_filter(FOURTH, Filter { category: 2, ..Filter::default() })
        }),
        ("colliders[3].filter.mask", "colliders", |w, _, _| {
            w.set_filter(FOURTH, Filter { mask: 2, ..Filter::default() })
        }),
        ("config.gravity.x", "configuration", |w, _, _| w.set_gravity(acc(0.5, -9.75))),
        ("config.gravity.y", "configuration", |w, _, _| w.set_gravity(acc(0.25, -9.5))),
        ("pushes.len", "forces", |w, b, _| w.apply_force(b, newtons(1.0, 0.0), None)),
        ("pushes.len", "forces", |w, b, _| w.apply_torque(b, num("1"))),
        ("bodies[3].allow_sleep", "bodies", |w, b, _| w.set_allow_sleep(b, false)),
    ];
    for (path, part, change) in changes {
        let mut other = world.clone();
        change(&mut other, ids[3], stars[1]).expect("accepted");
        assert_ne!(other.hash(), world.hash(), "{path}");
        let found: Vec<String> = world.diff(&other).into_iter().map(|d| d.path).collect();
        assert_eq!(found, [path]);
        assert_eq!(parts(&world, &other), [part], "{path}");
        other.check().expect("every invariant holds");
        // And it is saved.
        assert_eq!(World::load(&other.save()).expect("just saved").diff(&other), []);
    }

    // The forces of a tick, by value.
    let pushed = |x: f64, y: f64, torque: &str| {
        let mut world = world.clone();
        world.apply_force(ids[3], newtons(x, y), None).expect("accepted");
        world.apply_torque(ids[3], num(torque)).expect("accepted");
        world
    };
    let first = pushed(1.0, 1.0, "1");
    for (other, path) in [
        (pushed(2.0, 1.0, "1"), "pushes[0].force.x"),
        (pushed(1.0, 2.0, "1"), "pushes[0].force.y"),
        (pushed(1.0, 1.0, "2"), "pushes[0].torque"),
    ] {
        assert_ne!(first.hash(), other.hash());
        let found: Vec<String> = first.diff(&other).into_iter().map(|d| d.path).collect();
        assert_eq!(found, [path]);
        assert_eq!(parts(&first, &other), ["forces"]);
    }
    let mut second = world.clone();
    second.apply_force(ids[2], newtons(1.0, 1.0), None).expect("accepted");
    second.apply_torque(ids[2], num("1")).expect("accepted");
    assert_eq!(first.diff(&second)[0].path, "pushes[0].slot");
    assert_ne!(first.hash(), second.hash());
}

#[test]
fn fixed_rotation_is_in_the_hash() {
    let mut world = world(0.0, 0.0);
    let ids: Vec<BodyId> = (0..4).map(|_| world.create_body(&BodyDef::default()).expect("accepted")).collect();
    let mut other = world.clone();
    other.set_fixed_rotation(ids[3], true).expect("accepted");
    assert_ne!(other.hash(), world.hash());
    let found = world.diff(&other);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].to_string(), "bodies[3].fixed_rotation: false and true");
}

#[test]
fn a_difference_shows_both_values_exactly() {
    let (world, ids, _) = base();
    let mut other = world.clone();
    other.set_velocity(ids[3], vel(2.0, -0.75)).expect("accepted");
    let found = world.diff(&other);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].path.as_str(), found[0].a.as_str()), ("bodies[3].velocity.y", "3 m/s (bits 0x3000000000000)"));
    assert_eq!(found[0].b, "-0.75 m/s (bits 0xffff400000000000)");
    // And the same the other way round.
    let back = other.diff(&world);
    assert_eq!((&back[0].a, &back[0].b), (&found[0].b, &found[0].a));
}

#[test]
fn configuration_tick_and_status_are_in_the_hash() {
    let new = |def: WorldDef| World::new(&def).expect("accepted");
    let plain = new(WorldDef::default());
    for (def, path) in [
        (WorldDef { tick_rate: 61, ..WorldDef::default() }, "config.tick_rate"),
        (WorldDef { substeps: 5, ..WorldDef::default() }, "config.substeps"),
        (WorldDef { integrator: Integrator::SymplecticEuler, ..WorldDef::default() }, "config.integrator"),
        (WorldDef { gravity: acc(0.0, 1.0), ..WorldDef::default() }, "config.gravity.y"),
        (WorldDef { unit_shift: 1, ..WorldDef::default() }, "config.unit_shift"),
        (WorldDef { sleeping: Some(Sleeping::default()), ..WorldDef::default() }, "config.sleeping"),
    ] {
        let other = new(def);
        assert_ne!(other.hash(), plain.hash());
        let found: Vec<String> = plain.diff(&other).into_iter().map(|d| d.path).collect();
        assert_eq!(found, [path]);
        assert_eq!(parts(&plain, &other), ["configuration"]);
    }
    let mut later = plain.clone();
    later.step();
    assert_ne!(later.hash(), plain.hash());
    assert_eq!(plain.diff(&later)[0].to_string(), "tick: 0 and 1");
    assert_eq!(parts(&plain, &later), ["configuration"]);

    // Two worlds that differ in nothing but what they remember of a limit.
    let mut limited = world(0.0, 0.0);
    let id = limited.create_body(&BodyDef { position: at(1e9, 0.0), ..BodyDef::default() }).expect("accepted");
    limited.set_velocity(id, vel(1.0, 0.0)).expect("accepted");
    limited.step();
    let mut cleared = limited.clone();
    cleared.clear_status().expect("accepted");
    assert_ne!(limited.hash(), cleared.hash());
    assert_eq!(parts(&limited, &cleared), ["status"]);
    let found: Vec<String> = limited.diff(&cleared).into_iter().map(|d| d.path).collect();
    assert_eq!(found, ["status.entries.len"]);
}

#[test]
fn any_single_changed_body_is_localised() {
    let (world, storm) = stormy(77, 80);
    let mut rng = Rng(storm.rng.0);
    let ids: Vec<BodyId> = world.bodies().map(|body| body.id()).collect();
    assert!(!ids.is_empty());
    for _ in 0..200 {
        let id = ids[rng.below(ids.len() as u64) as usize];
        let p = world.body(id).expect("it exists").position();
        let mut other = world.clone();
        let moved = Vec2::new(tamias2d::Length::from_bits(p.x.to_bits() ^ 1), p.y);
        other.set_position(id, moved).expect("accepted");
        let found = world.diff(&other);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].path, format!("bodies[{}].position.x", id.index));
        assert_eq!(parts(&world, &other), ["motion"]);
    }
}

#[test]
fn user_data_is_kept_and_not_looked_at() {
    let mut one = world(0.0, -9.8);
    let mut other = one.clone();
    let a = one.create_body(&BodyDef { user_data: u64::MAX, ..BodyDef::default() }).expect("accepted");
    let b = other.create_body(&BodyDef::default()).expect("accepted");
    run(&mut one, 100);
    run(&mut other, 100);
    assert_eq!(one.body(a).expect("it exists").user_data(), u64::MAX);
    let loaded = World::load(&one.save()).expect("just saved");
    assert_eq!(loaded.body(a).expect("it exists").user_data(), u64::MAX);
    one.set_user_data(a, 0).expect("accepted");
    assert_eq!(one.body(a).expect("it exists").def(), other.body(b).expect("it exists").def());
    assert_eq!(one.hash(), other.hash());
}
