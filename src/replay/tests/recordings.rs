//! Faults in recorded games: found in the files, and named by them.

use super::faults::{Kind, check, state};
use super::{Dice, PUSHED, shake, world_of_everything};
use crate::World;
use crate::replay::{Comparison, Evidence, Player, Recorder, Recording, Segment, compare, recompute};
use std::io::Cursor;

type Peers = ([Cursor<Vec<u8>>; 2], World, super::faults::Done);

/// Two peers of a game: the second one's memory has a fault before a tick, and both hear of it some ticks later. Gives both files,
/// what the fault did, and the worlds before.
fn peers(kind: &Kind, fault: u64, ticks: u64, flights: [u32; 2], seed: u64) -> Option<Peers> {
    let options = |flight_ticks| Recording { keyframe_seconds: 1, flight_ticks, ..Recording::default() };
    let start = || Cursor::new(Vec::new());
    let game = |flight| Recorder::with(world_of_everything(), start(), options(flight)).expect("memory");
    let mut games = flights.map(game);
    let (mut done, mut before) = (None, None);
    for tick in 1..=ticks {
        for game in &mut games {
            shake(game, tick, PUSHED);
        }
        if tick == fault {
            before = Some(games[1].world.clone());
            done = (kind.flip)(&mut games[1].world, &mut Dice(seed));
            done?;
        }
        for game in &mut games {
            game.step();
        }
        // An alarm comes late.
        if tick == fault + 4 {
            for game in &mut games {
                game.alarm(fault);
            }
        }
    }
    Some((games.map(|game| game.finish().expect("memory")), before?, done))
}

#[test]
fn a_fault_in_memory_is_named_by_two_recordings() {
    let mut dice = Dice(4);
    const HASHED: [&str; 10] = [
        "position.x",
        "position.y",
        "velocity.x",
        "velocity.y",
        "angle",
        "angular_velocity",
        "points[0].normal",
        "tangent",
        "tick",
        "force.x",
    ];
    let kinds = state()
        .into_iter()
        .filter(|kind| HASHED.contains(&kind.field) && ["motion", "contacts", "forces"].contains(&kind.table));
    let mut named = 0;
    for kind in kinds {
        let (fault, seed) = (70 + dice.below(60) as u64, dice.below(1 << 20) as u64);
        for flights in [[8, 8], [0, 8]] {
            let Some(([mut a, mut b], before, done)) = peers(&kind, fault, 150, flights, seed) else { continue };
            let compared = compare([&mut a, &mut b]).expect("both can be read");
            let Comparison::Parted { tick, by_commands, accounts } = compared else {
                // What the first stage writes over does no harm.
                continue;
            };
            assert_eq!((tick, by_commands), (fault, false), "{} {}", kind.table, kind.field);
            let [ours, theirs] = *accounts;
            assert_eq!(ours.evidence.is_some(), flights[0] > 0);
            assert!(ours.keyframe.is_some_and(|keyframe| keyframe.tick < fault && keyframe.tick + 60 >= fault));
            // Without evidence this build stands in: it computes what the sound peer recorded.
            let ours = ours.evidence.unwrap_or_else(|| recompute(&mut a, tick).expect("it plays"));
            let theirs = theirs.evidence.expect("it was held");
            assert_ne!(ours.hash(), theirs.hash());
            let divergence = ours.first_difference(&theirs).expect("evidence").expect("it differs");
            assert_eq!((divergence.tick, divergence.stage, divergence.findings.len()), (fault, crate::Stage::Begin, 1));
            check(&before, &kind, done.expect("it was put"), &divergence);
            named += 1;
        }
    }
    assert!(named >= 10, "{named}");
}

/// What only commands read is in no hash of a tick. Keyframes look at it.
#[test]
fn a_fault_in_cold_memory_is_found_at_the_next_keyframe() {
    for kind in state().into_iter().filter(|kind| ["bodies", "colliders", "forms", "attractors"].contains(&kind.table))
    {
        // These do something else than wait.
        if ["link", "generation", "form", "body", "next", "first", "sensor"].contains(&kind.field)
            || kind.table == "forms"
        {
            continue;
        }
        for seed in 1..3 {
            let Some(([mut a, mut b], before, done)) = peers(&kind, 83, 130, [0, 0], seed) else { continue };
            let Comparison::Parted { tick, accounts, .. } = compare([&mut a, &mut b]).expect("both can be read") else {
                panic!("{} {}: it is not seen", kind.table, kind.field);
            };
            let [ours, theirs] = *accounts;
            assert!(tick <= 120, "{} {}: tick {tick}", kind.table, kind.field);
            if tick < 120 {
                // It had a say in the motion before.
                continue;
            }
            assert_eq!(ours.hash, theirs.hash);
            assert_ne!(ours.parts, theirs.parts);
            let theirs = theirs.evidence.expect("the recorder saw that its memory is not what it was given");
            let ours = recompute(&mut a, tick).expect("it plays").ending();
            let divergence = ours.first_difference(&theirs.ending()).expect("evidence").expect("it differs");
            check(&before, &kind, done.expect("it was put"), &divergence);
            // It verifies up to there, and no farther.
            let error = Player::new(b.get_ref().as_slice()).expect("a replay").verify().expect_err("it diverges");
            assert!(error.to_string().starts_with("replay diverged at tick 120 in part "), "{error}");
        }
    }
}

/// With three peers, or checksums each tenth tick, several alarms are heard at once, and the first bad tick is not the last of them.
#[test]
fn evidence_is_found_among_that_of_several_alarms() {
    let options = Recording { flight_ticks: 32, ..Recording::default() };
    let game = || Recorder::with(world_of_everything(), Cursor::new(Vec::new()), options).expect("memory");
    let mut games = [game(), game()];
    for tick in 1..=100u64 {
        if tick == 70 {
            games[1].world.bodies.omega.bits_mut()[4] ^= 1 << 40;
        }
        games.iter_mut().for_each(Recorder::step);
        if tick == 92 {
            for at in [70, 80, 90] {
                assert!(games.iter_mut().all(|game| game.alarm(at)));
            }
        }
    }
    let [mut a, mut b] = games.map(|game| game.finish().expect("memory"));
    let Comparison::Parted { tick, accounts, .. } = compare([&mut a, &mut b]).expect("both can be read") else {
        panic!("they part");
    };
    assert_eq!((tick, accounts.map(|account| account.evidence.map(|found| found.tick()))), (70, [Some(70); 2]));
}

#[test]
fn segments_verify_what_the_whole_does() {
    let mut game = Recorder::with(
        world_of_everything(),
        Cursor::new(Vec::new()),
        Recording { keyframe_seconds: 1, parts_ticks: 7, flight_ticks: 0 },
    )
    .expect("memory");
    for tick in 0..260 {
        shake(&mut game, tick, PUSHED);
        if tick == 100 {
            // The tables change, so the next keyframe is a whole save.
            game.world.clone_from(&game.world.clone());
            crate::Commands::set_user_data(&mut game, PUSHED, 5).expect("accepted");
        }
        game.step();
    }
    let file = game.finish().expect("memory");
    let contents = Player::new(file.get_ref().as_slice()).expect("a replay").inspect().expect("whole");
    let whole = Player::new(file.get_ref().as_slice()).expect("a replay").verify().expect("it plays");
    assert_eq!(contents.summary, whole);
    let segments = Segment::of(&contents);
    assert_eq!(segments.iter().map(Segment::start).collect::<Vec<_>>(), [0, 60, 120, 180, 240]);
    let mut ticks = 0;
    let mut last = None;
    for segment in segments {
        last = Some(segment.verify(file.clone(), |_| ticks += 1).expect("it plays"));
    }
    assert_eq!((ticks, last), (260, Some(whole)));
    for (most, starts) in [(0, &[0][..]), (1, &[0]), (2, &[0, 180]), (4, &[0, 120, 240]), (9, &[0, 60, 120, 180, 240])]
    {
        let few = Segment::few(&contents, most);
        assert_eq!(few.iter().map(Segment::start).collect::<Vec<_>>(), starts);
        let ends: Vec<_> = few.iter().map(|segment| segment.verify(file.clone(), |_| ()).expect("it plays")).collect();
        assert_eq!(ends.last(), Some(&whole));
    }
    assert_eq!(super::super::read_index(&mut file.clone()).expect("an index"), contents.keyframes);
    // And from each keyframe on to the end.
    for keyframe in &contents.keyframes {
        assert_eq!(Player::at(file.clone(), keyframe).expect("a keyframe").verify().expect("it plays"), whole);
    }
}

/// Ten minutes of play with 100 bodies, and a fault somewhere in it.
#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "takes minutes where nothing is optimised: cargo test --release --lib a_fault_in_ten_minutes"
)]
fn a_fault_in_ten_minutes_is_found_in_seconds() {
    let mut dice = Dice(5);
    for _ in 0..2 {
        let fault = 1 + dice.below(36_000) as u64;
        let game = |flight_ticks| {
            let options = Recording { flight_ticks, ..Recording::default() };
            Recorder::with(super::pile(100), Cursor::new(Vec::new()), options).expect("memory")
        };
        let mut games = [game(0), game(0)];
        let mut evidence = None;
        for tick in 1..=36_000 {
            for game in &mut games {
                shake(game, tick, PUSHED);
            }
            if tick == fault {
                // Not so small that repose takes it back.
                games[1].world.bodies.omega.bits_mut()[40] ^= 1 << 40;
                evidence = Some(Evidence::of_step(&mut games[1].world.clone()));
            }
            games.iter_mut().for_each(Recorder::step);
        }
        let [mut a, mut b] = games.map(|game| game.finish().expect("memory"));
        let size = a.get_ref().len();
        let start = std::time::Instant::now();
        let Comparison::Parted { tick, .. } = compare([&mut a, &mut b]).expect("both can be read") else {
            panic!("they part");
        };
        let compared = start.elapsed();
        let ours = recompute(&mut a, tick).expect("it plays");
        let divergence = ours.first_difference(&evidence.expect("taken")).expect("evidence").expect("it differs");
        let all = start.elapsed();
        assert_eq!(tick, fault);
        assert_eq!(divergence.findings.len(), 1, "{divergence:?}");
        assert_eq!(divergence.findings[0].field, "angular_velocity");
        println!(
            "tick {tick} of 36000, {size} bytes: compared in {compared:?}, named in {all:?}: {}",
            divergence.findings[0]
        );
        assert!(all.as_secs() < 5);
    }
}
