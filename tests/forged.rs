//! Saves and frames that somebody has made on purpose, hashes and all.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{at, disc, world};
use tamias2d::{BodyDef, BodyKind, Commands, DecodeError, Frame, FrameError, World};

const ROW: usize = 48;

/// Two discs, one of them fixed, that touch: one contact, in a world in which nobody sleeps.
fn touching() -> World {
    let mut world = world(0.0, -10.0);
    let fixed = BodyDef { kind: BodyKind::Static, colliders: vec![disc(0.5)], ..BodyDef::default() };
    world.create_body(&fixed).expect("accepted");
    let ball = BodyDef { position: at(0.0, 0.999), colliders: vec![disc(0.5)], ..BodyDef::default() };
    world.create_body(&ball).expect("accepted");
    world.step();
    world
}

/// The contact that ends `tail` bytes before the end, put on the list of what sleeps, which comes next and is empty.
fn lulled(bytes: &mut [u8], tail: usize) {
    let end = bytes.len() - tail;
    let list = &mut bytes[end - 8 - ROW..end];
    assert_eq!((&list[..4], &list[4 + ROW..]), (&[1, 0, 0, 0][..], &[0; 4][..]), "one contact, and none that sleeps");
    list.copy_within(4..4 + ROW, 8);
    list[..8].copy_from_slice(&[0, 0, 0, 0, 1, 0, 0, 0]);
}

fn repair(bytes: &mut [u8], place: usize, error: &DecodeError) {
    let DecodeError::Hash { computed, .. } = error else { panic!("{error}") };
    bytes[place..place + 8].copy_from_slice(&computed.to_le_bytes());
}

#[test]
fn contacts_of_what_sleeps_in_a_save_of_a_world_where_nobody_can_are_refused() {
    let mut bytes = touching().save();
    let end = bytes.len() - 8;
    // Behind it: no status, the hash.
    lulled(&mut bytes, 12);
    let error = World::load(&bytes).expect_err("its hash is another");
    repair(&mut bytes, end, &error);
    let error = World::load(&bytes).expect_err("nobody can sleep");
    assert!(matches!(error, DecodeError::Invalid { .. }), "{error}");
}

#[test]
fn contacts_of_what_sleeps_in_a_frame_of_a_world_where_nobody_can_are_refused() {
    let mut world = touching();
    let mut frame = Frame::default();
    world.save_frame(&mut frame);
    let mut bytes = Vec::new();
    frame.encode_into(&mut bytes);
    let end = bytes.len() - 16;
    // Behind it: no forces, no status, the hash, the seal.
    lulled(&mut bytes, 24);
    for place in [end, end + 8] {
        let error = Frame::decode(&bytes).expect_err("its hash is another");
        repair(&mut bytes, place, &error);
    }
    let forged = Frame::decode(&bytes).expect("well written");
    let before = world.save();
    assert_eq!(world.restore_frame(&forged), Err(FrameError::Unsound { tick: 1 }));
    assert!(world.save() == before);
}
