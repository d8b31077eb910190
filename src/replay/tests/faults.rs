//! One bit of memory, between stages, between substeps, or before a stage reads it.

mod kinds;

use super::{Dice, PUSHED, shake, world_of_everything};
use crate::World;
use crate::replay::evidence::{Evidence, Origin, Taker};
use crate::replay::finding::{Divergence, Finding};
use crate::solver::Substep;
use crate::store::Draft;
use crate::threads::Crew;
use crate::world::{Stage, Watch};
pub(super) use kinds::{Done, Kind, state};
use kinds::{bits_of_blocks, derived, flip, results};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// When in a tick a fault comes.
#[derive(Clone, Copy, PartialEq)]
enum When {
    /// When a stage has ended, before anybody looks.
    End(Stage),
    /// After somebody has looked at the end of a stage, so that the next one reads it.
    Next(Stage),
}

/// Takes evidence of a tick with a fault in it, as far as the fault is seen.
struct Faulty<'f, F> {
    taker: Taker<'f>,
    when: When,
    fault: F,
    done: &'f mut Done,
    over: bool,
}

impl<F: FnMut(&mut World) -> Done> Watch for Faulty<'_, F> {
    fn stage(&mut self, stage: Stage, world: &mut World) {
        if self.when == When::End(stage) {
            *self.done = (self.fault)(world);
            self.over = true;
        }
        self.taker.stage(stage, world);
        if self.over {
            // No hook, no message: the rest of the tick does not matter.
            resume_unwind(Box::new(()));
        }
        if self.when == When::Next(stage) {
            *self.done = (self.fault)(world);
            self.over = true;
        }
    }

    fn substep(&mut self, at: u32, substep: Substep<'_>) {
        self.taker.substep(at, substep);
    }
}

/// Evidence of the next tick of a world, with a fault; and what the fault did.
fn evidence_with(world: &World, when: When, fault: impl FnMut(&mut World) -> Done) -> (Evidence, Done) {
    let (mut evidence, mut draft, mut done) = (Evidence::default(), Draft::default(), None);
    let mut world = world.clone();
    evidence.begin(&world, &mut draft, Origin::Taken);
    let taker = Taker { evidence: &mut evidence, draft: &mut draft };
    let mut faulty = Faulty { taker, when, fault, done: &mut done, over: false };
    let _ = catch_unwind(AssertUnwindSafe(|| world.step_through(&mut faulty, Crew::ALONE)));
    (evidence, done)
}

/// Evidence of the next tick of a world in which something happens when a stage has ended, before anybody looks.
pub(super) fn evidence_of(world: &World, stage: Stage, fault: fn(&mut World)) -> Evidence {
    let happens = |world: &mut World| {
        fault(world);
        None
    };
    evidence_with(world, When::End(stage), happens).0
}

/// The words for what a row is of.
fn object(world: &World, kind: &Kind, finding: &Finding, row: usize) {
    let words = match kind.table {
        "bodies" | "motion" | "quiet" | "prepared motion" | "mobilities" => format!("body {row}v"),
        "colliders" => format!("collider {row}v"),
        "attractors" => format!("attractor {row}v"),
        "forms" | "outlines" => format!("form {row}"),
        "configuration" | "clock" | "scales" | "sleepers" | "slots of bodies" => "the world".into(),
        "status" => format!("number {row}"),
        _ => return,
    };
    assert!(finding.object.starts_with(&words), "{finding}: not {words}, tick {}", world.tick());
}

pub(super) fn check(world: &World, kind: &Kind, (row, before, after): (usize, u128, u128), divergence: &Divergence) {
    let finding = &divergence.findings[0];
    assert_eq!((finding.table.as_str(), finding.field.as_str()), (kind.table, kind.field), "{finding}");
    let bits = |value: &Option<crate::replay::FieldValue>| {
        let text = &value.as_ref().expect("both sides have it").bits;
        u128::from_str_radix(&text[2..], 16).expect("hexadecimal")
    };
    assert_eq!((bits(&finding.a), bits(&finding.b)), (before, after), "{finding}");
    assert!(finding.is_one_bit());
    object(world, kind, finding, row);
}

/// A world and its twin, some random ticks on, ready for a tick.
fn ready(world: &mut World, dice: &mut Dice) {
    for _ in 0..=dice.below(40) {
        shake(world, world.tick(), PUSHED);
        world.step();
    }
    shake(world, world.tick(), PUSHED);
}

/// After a stage has written, and before anybody reads: one bit, one finding.
#[test]
fn a_fault_between_stages_is_named_exactly() {
    let mut dice = Dice(1);
    let mut world = world_of_everything();
    for _ in 0..60 {
        world.step();
    }
    let kinds: Vec<Kind> = [state(), derived(), results()].into_iter().flatten().collect();
    let mut tried = vec![0u32; kinds.len()];
    for _ in 0..8 {
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        for (at, kind) in kinds.iter().enumerate() {
            let stages: Vec<Stage> = Stage::ALL
                .iter()
                .copied()
                .filter(|s| (kind.stages[0].max(Stage::Forces)..=kind.stages[1]).contains(s) && *s != Stage::Wake)
                .collect();
            for _ in 0..3 {
                let stage = stages[dice.below(stages.len())];
                let (faulty, done) = evidence_with(&world, When::End(stage), |world| (kind.flip)(world, &mut dice));
                let Some(done) = done else { continue };
                let divergence = clean.first_difference(&faulty).expect("evidence").expect("it differs");
                assert_eq!((divergence.stage, divergence.substep), (stage, 0), "{} {}", kind.table, kind.field);
                // Rows are named by their pair, so what a pair is of shows in them too.
                let echoes = usize::from(kind.field == "colliders[0]" && divergence.findings.len() == 2);
                assert_eq!(divergence.findings.len(), 1 + echoes, "{divergence:?}");
                assert_eq!(divergence.tick, world.tick() + 1);
                check(&world, kind, done, &divergence);
                tried[at] += 1;
            }
        }
    }
    for (kind, tried) in kinds.iter().zip(&tried) {
        assert!(*tried >= 2, "{} {} was hit {tried} times", kind.table, kind.field);
    }
    println!("{} kinds of fields, {} faults", kinds.len(), tried.iter().sum::<u32>());
}

/// A bit of a block is that of one contact.
#[test]
fn a_fault_in_a_bit_of_a_block_is_that_of_its_contact() {
    let (mut dice, mut world) = (Dice(3), world_of_everything());
    (0..60).for_each(|_| world.step());
    let clean = Evidence::of_step(&mut world.clone());
    for kind in bits_of_blocks() {
        // Not every pair has rows.
        let mut tries = (0..50).map(|_| {
            let (faulty, done) =
                evidence_with(&world, When::End(Stage::Prepare), |world| (kind.flip)(world, &mut dice));
            Some((faulty, done?))
        });
        let (faulty, done) = tries.find_map(|tried| tried).expect("some have");
        let divergence = clean.first_difference(&faulty).expect("evidence").expect("it differs");
        assert_eq!((divergence.stage, divergence.findings.len()), (Stage::Prepare, 1), "{divergence:?}");
        check(&world, &kind, done, &divergence);
    }
}

/// Before a stage reads it, and after everybody has looked: what follows from it differs as well, and the fault stands first.
#[test]
fn a_fault_that_a_stage_goes_on_with_is_named_first() {
    let mut dice = Dice(2);
    let mut world = world_of_everything();
    for _ in 0..60 {
        world.step();
    }
    // Not what would make the rest of the stage read beyond its memory.
    const SOUND: [&str; 14] = [
        "position.x",
        "position.y",
        "velocity.x",
        "velocity.y",
        "angle",
        "angular_velocity",
        "force.x",
        "force.y",
        "points[0].normal",
        "tangent",
        "friction",
        "restitution",
        "kick[0]",
        "kick[1]",
    ];
    let kinds: Vec<Kind> = [state(), derived()]
        .into_iter()
        .flatten()
        .filter(|kind| SOUND.contains(&kind.field) && kind.table != "pairs")
        .collect();
    let (mut first, mut all, mut gone) = (0, 0, 0);
    for _ in 0..15 {
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        for kind in &kinds {
            let stage = [Stage::Forces, Stage::Sort, Stage::Find, Stage::Prepare, Stage::Integrate, Stage::Solve]
                [dice.below(6)];
            let (faulty, done) = evidence_with(&world, When::Next(stage), |world| (kind.flip)(world, &mut dice));
            let Some((row, ..)) = done else { continue };
            // What the stage writes anew without reading it is no fault any more.
            let Some(divergence) = clean.first_difference(&faulty).expect("evidence") else {
                gone += 1;
                continue;
            };
            all += 1;
            let hit = |finding: &Finding| (finding.table.as_str(), finding.field.as_str()) == (kind.table, kind.field);
            if divergence.findings.first().is_some_and(hit) {
                first += 1;
                object(&world, kind, &divergence.findings[0], row);
            } else {
                // Some of these are written by the very stage that read them.
                assert!(["motion", "contacts"].contains(&kind.table), "{} {}: {divergence:?}", kind.table, kind.field);
            }
        }
    }
    println!("{first} of {all} are named first; {gone} were written over");
    assert!(first * 10 >= all * 8, "{first} of {all}");
}

/// Between substeps, in what the next one reads.
#[test]
fn a_fault_between_substeps_is_named_exactly() {
    struct Inside<'t> {
        taker: Taker<'t>,
        at: u32,
        dice: Dice,
        done: Done,
    }
    impl Watch for Inside<'_> {
        fn stage(&mut self, stage: Stage, world: &mut World) {
            self.taker.stage(stage, world);
        }

        fn substep(&mut self, at: u32, substep: Substep<'_>) {
            if at == self.at {
                let row = 1 + self.dice.below(substep.movers.lanes.len() - 1);
                let mover = &mut substep.movers.lanes[row];
                let dice = &mut self.dice;
                self.done = match dice.below(4) {
                    0 => flip(&mut mover.v[0], row, dice),
                    1 => flip(&mut mover.v[1], row, dice),
                    2 => flip(&mut mover.w, row, dice),
                    _ => flip(&mut mover.d[1], row, dice),
                };
            }
            self.taker.substep(at, substep);
            if at == self.at {
                resume_unwind(Box::new(()));
            }
        }
    }
    let (mut world, mut dice) = (world_of_everything(), Dice(3));
    let mut named = 0;
    for seed in 0..40 {
        // In time its bodies go where nothing touches them.
        if seed % 10 == 0 {
            world = world_of_everything();
        }
        ready(&mut world, &mut dice);
        let clean = Evidence::of_step(&mut world.clone());
        let (mut evidence, mut draft) = (Evidence::default(), Draft::default());
        evidence.begin(&world, &mut draft, Origin::Taken);
        let at = 1 + dice.below(10) as u32;
        let taker = Taker { evidence: &mut evidence, draft: &mut draft };
        let mut inside = Inside { taker, at, dice: Dice(seed), done: None };
        let mut copy = world.clone();
        let _ = catch_unwind(AssertUnwindSafe(|| copy.step_through(&mut inside, Crew::ALONE)));
        // Without contacts a tick has no substeps.
        let Some((_, before, after)) = inside.done else { continue };
        named += 1;
        let divergence = clean.first_difference(&evidence).expect("evidence").expect("it differs");
        assert_eq!((divergence.stage, divergence.substep), (Stage::Solve, at));
        let finding = &divergence.findings[0];
        assert_eq!((divergence.findings.len(), finding.table.as_str()), (1, "movers"));
        let bits = |value: &Option<crate::replay::FieldValue>| {
            u128::from_str_radix(&value.as_ref().expect("there").bits[2..], 16).expect("hexadecimal")
        };
        assert_eq!((bits(&finding.a), bits(&finding.b)), (before, after));
        assert!(finding.object.starts_with("body "), "{finding}");
    }
    assert!(named >= 20, "{named}");
}
