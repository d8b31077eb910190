//! Recordings of one game that part though both games were given the same commands: what the program says of them, by what they
//! hold. In place of a fault in memory a command that nobody recorded changes one machine's world.
#![cfg(feature = "cli")]
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

#[path = "common/forge.rs"]
mod forge;

use forge::Forge;
use std::path::{Path, PathBuf};
use std::process::Command;
use tamias2d::replay::Evidence;
use tamias2d::{BodyDef, BodyId, Commands, Vec2, World, WorldDef};

/// The tick before which the fault is, those that are recorded, and the one behind which there are parts.
const FAULT: u64 = 20;
const TICKS: u64 = 40;
const PARTS: u64 = 30;
const BODY: BodyId = BodyId { index: 0, generation: 0 };

fn start() -> World {
    let mut world = World::new(&WorldDef::default()).expect("accepted");
    let velocity = Vec2::from_f64(1.0, 0.0).expect("in range");
    world.create_body(&BodyDef { velocity, user_data: 7, ..BodyDef::default() }).expect("accepted");
    world
}

/// What a machine records.
#[derive(Clone, Copy, Default)]
struct Machine {
    /// Its memory has a fault.
    faulty: bool,
    /// It says another hash than its world has, from the fault's tick on.
    lying: bool,
    /// It records parts, and evidence of the fault's tick.
    parts: bool,
    evidence: bool,
}

impl Machine {
    fn record(self, path: &Path) {
        let mut world = start();
        let mut forge = Forge::new(60).world(&world);
        let mut evidence = None;
        for tick in 1..=TICKS {
            if tick == FAULT {
                if self.faulty {
                    world.set_velocity(BODY, Vec2::from_f64(1.5, 0.0).expect("in range")).expect("accepted");
                }
                evidence = Some(Evidence::of_step(&mut world));
            } else {
                world.step();
            }
            forge = forge.idle(world.hash() ^ u64::from(self.lying && tick >= FAULT));
            if self.parts && tick == PARTS {
                let parts = world.hash_parts();
                forge = forge.record(0x81, &parts.iter().flat_map(|part| part.hash.to_le_bytes()).collect::<Vec<_>>());
            }
        }
        if self.evidence {
            forge = forge.record(0x82, &evidence.expect("it came by").encode());
        }
        std::fs::write(path, forge.end(TICKS)).expect("a file");
    }
}

/// The program's status, output and line of error.
fn tamias(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_tamias2d")).args(arguments).output().expect("it starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("partings").join(name);
    std::fs::create_dir_all(&path).expect("a folder for the test");
    path
}

/// Two machines' recordings, and what `diff` says of them, with the folder left out.
fn parted(name: &str, [a, b]: [Machine; 2]) -> String {
    let folder = folder(name);
    let paths = ["a.replay", "b.replay"].map(|file| folder.join(file));
    a.record(&paths[0]);
    b.record(&paths[1]);
    let [a, b] = [0, 1].map(|side: usize| paths[side].to_str().expect("UTF-8"));
    let (status, out, err) = tamias(&["diff", a, b]);
    assert_eq!((status, err), (1, format!("tamias2d: {a} and {b} differ at tick {FAULT}\n")));
    let (status, json, _) = tamias(&["diff", a, b, "--json"]);
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((status, &report["same"], &report["tick"]), (1, &false.into(), &FAULT.into()));
    for line in report["notes"].as_array().expect("a list") {
        assert!(out.contains(line.as_str().expect("text")), "{line}");
    }
    out.replace(&format!("{}/", folder.display()), "")
}

/// A sound machine, and one with a fault.
const SOUND: Machine = Machine { faulty: false, lying: false, parts: false, evidence: false };
const FAULTY: Machine = Machine { faulty: true, ..SOUND };

/// The hash after a tick with the fault and without, as text.
fn hashes(tick: u64) -> [String; 2] {
    [false, true].map(|faulty| {
        let mut world = start();
        (1..FAULT).for_each(|_| world.step());
        if faulty {
            world.set_velocity(BODY, Vec2::from_f64(1.5, 0.0).expect("in range")).expect("accepted");
        }
        (FAULT..=tick).for_each(|_| world.step());
        format!("{:016x}", world.hash())
    })
}

#[test]
fn without_evidence_it_is_said_who_has_to_write_it() {
    let [sound, faulty] = hashes(FAULT);
    let out = parted("bare", [SOUND, FAULTY]);
    let expected = format!(
        "differ at tick 20\n  hash {sound}  A\n  hash {faulty}  B\n  hash {sound}  this build\n  \
         A is what this build computes, which stands in for it\n  \
         B holds no evidence of this tick, and this build computes something else\n  \
         the parts of the state were not recorded at it or after it\n  \
         next, on the machine that recorded A: tamias2d verify --evidence A.evidence --tick 20 a.replay\n  \
         next, on the machine that recorded B: tamias2d verify --evidence B.evidence --tick 20 b.replay\n  \
         next, then anywhere: tamias2d diff A.evidence B.evidence\n  \
         next, if both files agree, tick 20 went wrong in memory and is not repeated: record with evidence \
         (Recording::flight_ticks)\n"
    );
    assert_eq!(out, expected);
}

#[test]
fn parts_that_were_recorded_say_where_to_look() {
    let both = |machine: Machine| Machine { parts: true, ..machine };
    let out = parted("parts", [both(FAULTY), both(SOUND)]);
    assert!(out.contains("\n  at tick 30, the next at which parts were recorded, motion differs\n"), "{out}");
    assert!(out.contains("\n  this build's parts after the tick: configuration "), "{out}");
    // Of one side alone they say nothing.
    let out = parted("one_side", [both(FAULTY), SOUND]);
    assert!(out.contains("the parts of the state were not recorded"), "{out}");
    // A hash that is not its world's.
    let out = parted("lying", [both(SOUND), Machine { lying: true, ..both(SOUND) }]);
    assert!(out.contains("at tick 30, the next at which parts were recorded, no part differs"), "{out}");
}

#[test]
fn evidence_names_the_field() {
    let of = |machine: Machine| Machine { evidence: true, ..machine };
    let field = "motion: body 0v0 (user data 7): velocity.x\n      A  1 m/s (bits 0x0001000000000000)\n      \
                 B  1.5 m/s (bits 0x0001800000000000)\n";
    // Of the faulty side alone: this build stands in for the other one.
    let out = parted("evidence", [SOUND, of(FAULTY)]);
    assert!(out.contains("A is what this build computes, which stands in for it\n"), "{out}");
    assert!(out.contains("B holds evidence computed again, by tamias2d "), "{out}");
    assert!(out.contains(field) && !out.contains("next, "), "{out}");
    let out = parted("evidence_of_both", [of(SOUND), of(FAULTY)]);
    assert!(out.contains("A holds evidence computed again") && out.contains(field), "{out}");
    // Of the sound side alone it is no help: what the other one's memory held is known to nobody.
    let out = parted("evidence_of_the_sound", [of(SOUND), FAULTY]);
    assert!(out.contains("B holds no evidence of this tick, and this build computes something else"), "{out}");
    assert!(out.contains("on the machine that recorded B: ") && !out.contains("that recorded A: "), "{out}");
    // Two that hold the same memory and say different hashes of it.
    let out = parted("evidence_of_a_lie", [of(SOUND), Machine { lying: true, ..of(SOUND) }]);
    assert!(out.contains("the evidence of both sides agrees: what differs came about outside"), "{out}");
}

#[test]
fn a_replay_that_diverges_leaves_evidence_of_its_first_bad_tick() {
    let folder = folder("verify");
    let [replay, sound, evidence] = ["b.replay", "a.replay", "b.evidence"].map(|file| folder.join(file));
    FAULTY.record(&replay);
    SOUND.record(&sound);
    let [replay, sound, evidence] = [&replay, &sound, &evidence].map(|path| path.to_str().expect("UTF-8"));
    let _ = std::fs::remove_file(evidence);
    let (status, out, err) = tamias(&["verify", sound, "--evidence", evidence]);
    assert_eq!((status, std::fs::exists(evidence).expect("known")), (0, false), "{err}");
    assert!(format!("{out}{err}").contains("no tick is bad, so "), "{out}{err}");
    let (status, _, err) = tamias(&["verify", replay, "--evidence", evidence]);
    assert_eq!(status, 1, "{err}");
    let written = Evidence::decode(&std::fs::read(evidence).expect("written")).expect("evidence");
    assert_eq!((written.tick(), format!("{:016x}", written.hash())), (FAULT, hashes(FAULT)[0].clone()));
    // One replay at a time.
    let (status, _, err) = tamias(&["verify", replay, sound, "--evidence", evidence]);
    assert_eq!((status, err.as_str()), (2, "tamias2d: --evidence is of one replay, and there are several\n"));
}

#[test]
fn what_has_no_tick_in_common_is_not_compared() {
    let folder = folder("apart");
    let [early, late, save, evidence] =
        ["early.replay", "late.replay", "save", "evidence"].map(|file| folder.join(file));
    let mut world = start();
    world.step();
    let early_end = Forge::new(60).world(&start()).idle(world.hash()).end(1);
    std::fs::write(&early, early_end).expect("a file");
    let first = Evidence::of_step(&mut start());
    (1..5).for_each(|_| world.step());
    let begun = Forge::new(60).world(&world);
    std::fs::write(&save, world.save()).expect("a file");
    world.step();
    std::fs::write(&late, begun.idle(world.hash()).end(1)).expect("a file");
    std::fs::write(&evidence, first.encode()).expect("a file");
    let [early, late, save, evidence] = [&early, &late, &save, &evidence].map(|path| path.to_str().expect("UTF-8"));
    for (a, b, words) in [
        (early, late, "the recordings have no tick in common: A begins at tick 0, B at tick 5"),
        (late, evidence, "begins at tick 5, and the evidence is of tick 1"),
        (save, evidence, "a save is compared with a save: one side is one, the other is not"),
        (early, save, "a save is compared with a save: one side is one, the other is not"),
    ] {
        let (status, out, err) = tamias(&["diff", a, b]);
        assert_eq!((status, out.as_str()), (2, ""));
        assert!(err.contains(words) && err.lines().count() == 1, "{err}");
    }
    assert_eq!(tamias(&["diff", save, save]).0, 0);
}
