//! What evidence says of itself, and of what differs; what is kept last; how much of two recordings is read; what is forged.

use super::{Dice, PUSHED, at, shake, world_of_everything};
use crate::replay::evidence::Evidence;
use crate::replay::{Comparison, Flight, Player, Recorder, Recording, ReplayError, compare, read_index};
use crate::world::Stage;
use crate::{BodyDef, BodyKind, ColliderDef, Commands, Length, Shape, World};
use std::io::{Cursor, Read, Result, Seek, SeekFrom};
use twox_hash::XxHash3_64;

/// A world in which much moves, a second old.
fn lively() -> World {
    let mut world = world_of_everything();
    for tick in 0..60 {
        shake(&mut world, tick, PUSHED);
        world.step();
    }
    world
}

#[test]
fn evidence_is_of_a_state_or_of_a_step_and_says_which() {
    let mut world = lively();
    let (state, save) = (Evidence::of_state(&world), world.save());
    assert!(state.is_of_state() && state.after().is_empty());
    assert_eq!((state.tick(), state.hash(), state.before()), (world.tick(), world.hash(), save.as_slice()));
    let step = Evidence::of_step(&mut world);
    assert!(!step.is_of_state());
    assert_eq!((step.tick(), step.hash()), (world.tick(), world.hash()));
    assert_eq!((step.before(), step.after()), (save.as_slice(), world.save().as_slice()));
    // Its end alone is what the state after it is.
    let end = step.ending();
    assert!(end.is_of_state());
    assert_eq!((end.before(), end.hash()), (step.after(), world.hash()));
    assert_eq!(end.first_difference(&Evidence::of_state(&world)).expect("evidence"), None);
    assert_eq!(state.ending().before(), save.as_slice());
}

#[test]
fn the_last_tick_of_a_flight_is_that_of_the_last_step() {
    let (mut world, mut flight) = (World::new(&crate::WorldDef::default()).expect("accepted"), Flight::new(3));
    assert!(flight.last().is_none());
    for tick in 1..=7 {
        flight.step(&mut world);
        let last = flight.last().expect("it was kept");
        assert_eq!((last.tick(), last.hash()), (tick, world.hash()));
    }
}

/// A fault is a cause where the stage does not write; where it does, on both sides, what differs is what it made.
#[test]
fn causes_are_what_the_stage_does_not_change() {
    let world = lively();
    let clean = Evidence::of_step(&mut world.clone());
    type Fault = fn(&mut World);
    let gravity: Fault = |world| world.config.gravity.x = "3".parse().expect("in range");
    let velocity: Fault = |world| world.bodies.vx.bits_mut()[3] ^= 1 << 30;
    for (stage, fault, table, causes) in [
        (Stage::Find, gravity, "configuration", 1),
        (Stage::Solve, gravity, "configuration", 1),
        (Stage::Find, velocity, "motion", 1),
        (Stage::Integrate, velocity, "motion", 0),
        (Stage::Solve, velocity, "motion", 0),
    ] {
        let faulty = super::faults::evidence_of(&world, stage, fault);
        for (a, b) in [(&clean, &faulty), (&faulty, &clean)] {
            let divergence = a.first_difference(b).expect("evidence").expect("it differs");
            let tables: Vec<&str> = divergence.findings.iter().map(|finding| finding.table.as_str()).collect();
            assert_eq!((divergence.stage, tables.as_slice(), divergence.causes), (stage, &[table][..], causes));
        }
    }
}

/// Who is squeezed is shown with how fast it may be, and nobody else is.
#[test]
fn who_is_held_back_is_shown() {
    let mut world = World::new(&crate::WorldDef::default()).expect("accepted");
    let length = |metres: f64| Length::from_f64(metres).expect("in range");
    let mut add = |kind, x, collider: ColliderDef| {
        let def = BodyDef { kind, position: at(x, 0.0), colliders: vec![collider], ..BodyDef::default() };
        world.create_body(&def).expect("accepted").index
    };
    let disc = || ColliderDef::new(Shape::Circle { radius: length(0.5) });
    // Walls 0.9 m apart around a disc of 1 m, and a disc that leans on one of them from outside.
    for x in [-1.45, 1.45] {
        add(BodyKind::Static, x, super::rectangle(2.0, 4.0));
    }
    let squeezed = add(BodyKind::Dynamic, 0.0, disc());
    let free = add(BodyKind::Dynamic, 2.95, disc());
    for _ in 0..20 {
        world.step();
    }
    let evidence = Evidence::of_step(&mut world);
    let mut seen = 0;
    for at in (0..evidence.count()).filter(|&at| evidence.moment(at).is_some_and(|(_, substep)| substep > 0)) {
        let sheets = evidence.sheets(at).expect("evidence");
        let (_, movers) = sheets.iter().find(|(_, sheet)| sheet.name == "movers").expect("it is shown");
        for row in 0..movers.len() {
            let most = movers.cell(row, "most").expect("it is shown").bits;
            match movers.key(row)[0] {
                slot if slot == u128::from(squeezed) => {
                    assert!(most >= 1 << 48, "{most}");
                    seen += 1;
                }
                slot => assert!(slot != u128::from(free) || most == 0, "{slot}: {most}"),
            }
        }
    }
    assert!(seen > 0, "it is a mover");
}

/// A file of which is counted how much is read.
struct Counted {
    file: Cursor<Vec<u8>>,
    read: usize,
}

impl Read for Counted {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let count = self.file.read(into)?;
        self.read += count;
        Ok(count)
    }
}

impl Seek for Counted {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.file.seek(to)
    }
}

/// Two recordings of a game that part late are compared from the last keyframe before, not from their beginning.
#[test]
fn comparing_reads_a_small_part_of_what_agrees() {
    let options = Recording { keyframe_seconds: 1, parts_ticks: 7, ..Recording::default() };
    let mut dice = Dice(9);
    let mut games = [(); 2].map(|()| Recorder::with(lively(), Cursor::new(Vec::new()), options).expect("memory"));
    let fault = 1100 + dice.below(50) as u64;
    for tick in 1..=1200 {
        if tick == fault {
            games[1].world.bodies.omega.bits_mut()[4] ^= 1 << 40;
        }
        for game in &mut games {
            shake(game, tick, PUSHED);
            game.step();
        }
    }
    let mut files = games.map(|game| Counted { file: game.finish().expect("memory"), read: 0 });
    let [a, b] = &mut files;
    let Comparison::Parted { tick, .. } = compare([a, b]).expect("both can be read") else { panic!("they part") };
    assert_eq!(tick, lively().tick() + fault);
    for Counted { file, read } in files {
        let size = file.get_ref().len();
        assert!(read < size / 2, "{read} of {size} bytes were read");
    }
}

fn word(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

/// A number of a record is another one, and the record's check fits again, as one who forges a file makes it. `chain`: where the
/// record has that of the records before it.
fn forged(file: &[u8], place: usize, chain: usize, at: usize, value: u64) -> Vec<u8> {
    let mut bytes = file.to_vec();
    let end = place + 5 + word(file, place + 1) as u32 as usize;
    let seed = word(file, chain);
    bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
    let check = XxHash3_64::oneshot_with_seed(seed, &bytes[place..end]) as u32;
    bytes[end..end + 4].copy_from_slice(&check.to_le_bytes());
    bytes
}

/// A game of some seconds with a keyframe a second.
fn with_keyframes() -> Vec<u8> {
    let options = Recording { keyframe_seconds: 1, ..Recording::default() };
    let mut game = Recorder::with(lively(), Cursor::new(Vec::new()), options).expect("memory");
    for tick in 0..200 {
        shake(&mut game, tick, PUSHED);
        game.step();
    }
    game.finish().expect("memory").into_inner()
}

#[test]
fn an_index_that_cannot_be_is_refused() {
    let file = with_keyframes();
    let place = word(&file, file.len() - 16) as usize;
    // Tag and length; the chain before it and the count; tick, offset and history of each; the check.
    let entry = |at: usize| place + 5 + 12 + 24 * at;
    let count = (file.len() - 25 - 4 - entry(0)) / 24;
    assert!(count >= 3, "{count} keyframes");
    let read = |at: usize, value: u64| read_index(&mut Cursor::new(forged(&file, place, place + 5, at, value)));
    let tick = |at: usize| word(&file, entry(at));
    let offset = |at: usize| word(&file, entry(at) + 8);
    let listed = read(entry(1), tick(1)).expect("nothing is forged");
    let ticks: Vec<u64> = listed.iter().map(|keyframe| keyframe.tick).collect();
    assert_eq!(ticks, (0..count).map(tick).collect::<Vec<_>>());
    // A keyframe that is not later than the one before, in ticks or in the file; one where the index is, or behind it.
    for (what, at, value) in [
        ("tick", entry(1), tick(0)),
        ("tick", entry(1), tick(2)),
        ("offset", entry(1) + 8, offset(0)),
        ("offset", entry(1) + 8, offset(2)),
        ("end", entry(count - 1) + 8, place as u64),
        ("end", entry(count - 1) + 8, place as u64 + 9),
    ] {
        let found = read(at, value);
        assert!(
            matches!(found, Err(ReplayError::Corrupt { offset, .. }) if offset == place as u64),
            "{what}: {found:?}"
        );
    }
    // One byte before the index is possible, as far as an index shows.
    assert!(read(entry(count - 1) + 8, place as u64 - 1).is_ok());
}

#[test]
fn a_keyframe_of_another_place_is_refused() {
    let file = with_keyframes();
    let keyframe = read_index(&mut Cursor::new(&file)).expect("an index")[1];
    let place = keyframe.offset as usize;
    // Ticks and commands before it, and the history.
    for at in [0, 8, 16].map(|field| place + 5 + field) {
        for value in [word(&file, at).wrapping_add(1), word(&file, at).wrapping_sub(1)] {
            let bytes = forged(&file, place, place + 5 + 24, at, value);
            let error = Player::new(&bytes[..]).expect("a replay").verify().expect_err("it is of another place");
            let ReplayError::Corrupt { offset, reason, .. } = error else { panic!("{error}") };
            assert_eq!((offset, reason), (keyframe.offset, "the keyframe is not of this place"));
        }
    }
}

/// Also if they make no difference.
#[test]
fn other_orders_are_told_from_faults() {
    for differs in [false, true] {
        let mut games = [(); 2].map(|()| Recorder::new(lively(), Cursor::new(Vec::new())).expect("memory"));
        for tick in 0..20 {
            if tick == 7 && differs {
                games[1].apply(crate::Command::ClearStatus).expect("it always is");
            }
            games.iter_mut().for_each(Recorder::step);
        }
        let [mut a, mut b] = games.map(|game| game.finish().expect("memory"));
        match compare([&mut a, &mut b]).expect("both can be read") {
            Comparison::Same { .. } => assert!(!differs),
            Comparison::Parted { tick, by_commands, .. } => {
                assert_eq!((differs, by_commands, tick), (true, true, lively().tick() + 8));
            }
            Comparison::Apart { .. } => panic!("they overlap"),
        }
    }
}
