//! Who is refused before a match, and in which words. And snapshots of a running match, which begin with a hello.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::world;
use tamias2d::hello::{Hello, HelloError};
use tamias2d::replay::REPLAY_VERSION;
use tamias2d::{BodyDef, Commands, LAW, SAVE_VERSION};

fn hello() -> Hello {
    Hello::new(&world(0.0, -9.8), 7)
}

#[test]
fn bytes_are_read_as_they_were_written() {
    let hello = hello();
    let Hello { law, save, replay, game, tick_rate, tick, .. } = hello;
    assert_eq!((law, save, replay, game, tick_rate, tick), (LAW, SAVE_VERSION, REPLAY_VERSION, 7, 60, 0));
    let packet = hello.encode();
    assert_eq!(packet.len(), Hello::LENGTH);
    let first: Vec<u8> =
        [1, LAW, SAVE_VERSION, REPLAY_VERSION].iter().flat_map(|number| number.to_le_bytes()).collect();
    assert_eq!(packet[..24], [b"TAMIAS-H".as_slice(), &first].concat());
    assert_eq!(Hello::decode(&packet), Ok(hello));
    assert_eq!(hello.check(&hello), Ok(()));
}

#[test]
fn every_changed_byte_and_every_cut_is_refused() {
    let packet = hello().encode();
    for at in 0..packet.len() {
        for bit in 0..8 {
            let mut changed = packet.clone();
            changed[at] ^= 1 << bit;
            let expected = match at {
                0..8 => HelloError::NotAHello,
                8..12 => HelloError::Version {
                    found: u32::from_le_bytes(changed[8..12].try_into().expect("four bytes")),
                    known: 1,
                },
                _ => HelloError::Damaged,
            };
            assert_eq!(Hello::decode(&changed), Err(expected), "byte {at}");
        }
        let expected = if at < 8 { HelloError::NotAHello } else { HelloError::Damaged };
        assert_eq!(Hello::decode(&packet[..at]), Err(expected), "cut at {at}");
    }
    let longer = [packet.as_slice(), &[0]].concat();
    assert_eq!(Hello::decode(&longer), Err(HelloError::Damaged));
}

#[test]
fn a_refusal_says_what_and_what_to_do() {
    let ours = Hello { law: 5, save: 4, replay: 2, game: 7, tick_rate: 60, tick: 0, world: 0x0123_4567_89ab_cdef };
    let says = |theirs: Hello, text: &str| assert_eq!(ours.check(&theirs).expect_err("refused").to_string(), text);
    says(
        Hello { law: 6, world: 1, ..ours },
        "the peer computes by arithmetic law 6, this build by law 5: their worlds would part; give both the same release of the game",
    );
    says(
        Hello { save: 5, ..ours },
        "the peer saves worlds in format version 5, this build in version 4: give both the same release of the game",
    );
    says(
        Hello { replay: 3, ..ours },
        "the peer records replays in format version 3, this build in version 2: give both the same release of the game",
    );
    says(Hello { game: 8, ..ours }, "the peer plays version 8 of the game, this is version 7: update the older one");
    says(
        Hello { tick_rate: 50, ..ours },
        "the peer's world has 50 ticks per second, this one 60: begin with the same scene",
    );
    says(
        Hello { tick: 90, ..ours },
        "the peer begins at tick 90, this one at tick 0: take a snapshot of the running match, or begin anew together",
    );
    says(
        Hello { world: 0xfedc_ba98_7654_3210, ..ours },
        "the peer begins with world fedcba9876543210, this one with 0123456789abcdef: load the same scene, or take its snapshot",
    );
    let told = |bytes: &[u8]| Hello::decode(bytes).expect_err("refused").to_string();
    assert_eq!(
        told(b"GET / HTTP/1.1"),
        "the packet is no hello of tamias2d: the peer is another program, or one that sends its packets of play first"
    );
    let mut newer = ours.encode();
    newer[8] = 2;
    assert_eq!(
        told(&newer),
        "the peer's hello is of version 2, this build reads version 1: give both the same release of the game"
    );
    assert_eq!(told(&ours.encode()[..40]), "the hello is damaged: have it sent again");
}

#[test]
fn another_world_is_another_scene() {
    let mut other = world(0.0, -9.8);
    other.create_body(&BodyDef::default()).expect("accepted");
    let error = hello().check(&Hello::new(&other, 7)).expect_err("another scene");
    assert!(matches!(error, HelloError::Differs { what: tamias2d::hello::Term::Scene, .. }));
}

#[cfg(feature = "ggrs")]
mod joining {
    use super::*;
    use serde::{Deserialize, Serialize};
    use tamias2d::lockstep::{Game, Lockstep, LockstepError, Turn};
    use tamias2d::{BodyId, World};

    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    struct Pusher {
        body: BodyId,
        pushed: u64,
    }

    impl Game for Pusher {
        type Input = bool;

        fn act(&mut self, inputs: &[Option<bool>], turn: &mut Turn<'_>) {
            if inputs[0] == Some(true) {
                self.pushed += 1;
                turn.apply_impulse(self.body, common::newton_seconds(0.5, 1.0), None).expect("it is there");
            }
        }
    }

    fn begin() -> (Pusher, World) {
        let mut world = world(0.0, -9.8);
        let body = world.create_body(&BodyDef::default()).expect("accepted");
        (Pusher { body, pushed: 0 }, world)
    }

    /// A match of 40 ticks, and its snapshot.
    fn running() -> (Lockstep<Pusher>, Hello, Vec<u8>) {
        let (game, world) = begin();
        let hello = Hello::new(&world, 7);
        let mut lockstep = Lockstep::new(game, world).expect("small");
        for tick in 0..40 {
            lockstep.follow(&[Some(tick % 3 == 0)]).expect("it is kept");
        }
        let snapshot = lockstep.snapshot(&hello).expect("it is kept");
        (lockstep, hello, snapshot)
    }

    #[test]
    fn who_joins_goes_on_as_the_others() {
        let (mut host, hello, snapshot) = running();
        let mut late = Lockstep::<Pusher>::join(&hello, &snapshot).expect("its own");
        assert_eq!((late.settled(), late.game()), (40, host.game()));
        for tick in 0..40 {
            for peer in [&mut host, &mut late] {
                peer.follow(&[Some(tick % 5 == 0)]).expect("it is kept");
            }
            let hashes = |peer: &mut Lockstep<Pusher>| {
                let confirmed = peer.confirmed().expect("it followed");
                (confirmed.tick, confirmed.world, confirmed.own)
            };
            assert_eq!(hashes(&mut host), hashes(&mut late));
        }
        assert_eq!(host.game().pushed, 14 + 8);
    }

    #[test]
    fn every_changed_bit_and_every_cut_is_refused() {
        let (_, hello, snapshot) = running();
        let refused = |bytes: &[u8], at: usize| match Lockstep::<Pusher>::join(&hello, bytes).err() {
            Some(LockstepError::NotASnapshot) => assert!(at < 8),
            Some(LockstepError::Peer(_)) => assert!((8..8 + Hello::LENGTH).contains(&at)),
            Some(LockstepError::Damaged) => assert!(at >= 8),
            other => panic!("byte {at}: {other:?}"),
        };
        for at in 0..snapshot.len() {
            let mut changed = snapshot.clone();
            changed[at] ^= 1 << (at % 8);
            refused(&changed, at);
            refused(&snapshot[..at], at);
        }
    }

    #[test]
    fn a_refusal_says_what_and_what_to_do() {
        let (_, hello, snapshot) = running();
        let told = |hello: &Hello, bytes: &[u8]| {
            Lockstep::<Pusher>::join(hello, bytes).err().map(|error| error.to_string()).unwrap_or_default()
        };
        let law = LAW + 1;
        assert_eq!(
            told(&Hello { law, ..hello }, &snapshot),
            format!(
                "the snapshot is refused: the peer computes by arithmetic law {LAW}, this build by law {law}: their worlds would part; give both the same release of the game"
            )
        );
        assert_eq!(
            told(&Hello { game: 9, ..hello }, &snapshot),
            "the snapshot is refused: the peer plays version 7 of the game, this is version 9: update the older one"
        );
        let scene = told(&Hello { world: 1, ..hello }, &snapshot);
        assert!(
            scene.ends_with("this one with 0000000000000001: load the same scene, or take its snapshot"),
            "{scene}"
        );
        assert_eq!(told(&hello, b"TAMIAS-W"), "not a snapshot of a match: ask the host for one");
        assert_eq!(
            told(&hello, &snapshot[..snapshot.len() - 1]),
            "the snapshot is damaged, its hash does not fit it: have it sent again"
        );
    }
}
