//! Matches by ggrs within one process: the network is a queue, so what happens is the same in every run. Peers, a player who
//! comes in the middle, lockstep by input delay, events that are told once, and the alarm.
#![cfg(feature = "ggrs")]
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{at, disc, newton_seconds, rectangle, world};
use ggrs::{DesyncDetection, GgrsEvent, Message, NonBlockingSocket, P2PSession, PlayerType, SessionBuilder};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::rc::Rc;
use tamias2d::hello::Hello;
use tamias2d::lockstep::{Alarm, Game, Lockstep, LockstepError, Net, Turn};
use tamias2d::replay::{Player, Recorder};
use tamias2d::{BodyDef, BodyId, BodyKind, Commands, EventId, EventLog, Velocity, World};

/// Discs that jump about on a floor. Whoever is in the session has one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Jumpers {
    discs: Vec<BodyId>,
    jumps: u32,
    landings: u32,
}

impl Game for Jumpers {
    type Input = i8;

    fn act(&mut self, inputs: &[Option<i8>], turn: &mut Turn<'_>) {
        while self.discs.len() < inputs.len() {
            let position = at(self.discs.len() as f64 * 3.0 - 3.0, 2.0);
            let def = BodyDef { position, colliders: vec![disc(0.5)], ..BodyDef::default() };
            self.discs.push(turn.create_body(&def).expect("in range"));
        }
        for (disc, input) in self.discs.iter().zip(inputs) {
            let Some(push @ (-1 | 1)) = input else { continue };
            let low = turn.world().body(*disc).is_some_and(|disc| disc.position().y < at(0.0, 1.05).y);
            self.jumps += u32::from(low);
            let up = if low { 1.0 } else { 0.0 };
            turn.apply_impulse(*disc, newton_seconds(f64::from(*push) * 0.3, up), None).expect("it is there");
        }
    }

    fn watch(&mut self, world: &World) {
        self.landings += world.events().len() as u32;
    }
}

fn begin() -> (Jumpers, World) {
    let mut world = world(0.0, -9.8);
    let floor = vec![rectangle(1000.0, 1.0)];
    world.create_body(&BodyDef { kind: BodyKind::Static, colliders: floor, ..BodyDef::default() }).expect("in range");
    (Jumpers { discs: Vec::new(), jumps: 0, landings: 0 }, world)
}

/// Presses a button for some ticks, another for others: some predictions are wrong.
fn input(player: usize, frame: i32) -> i8 {
    [1, 0, 0, -1, 0][((frame / 4) as usize * 7 + player * 3 + (frame / 11) as usize) % 5]
}

/// From whom, the poll of the receiver at which it is there, and what.
type Mail = VecDeque<(usize, u64, Message)>;

struct Wire {
    own: usize,
    boxes: Rc<RefCell<BTreeMap<usize, Mail>>>,
    polls: u64,
    delay: u64,
}

impl NonBlockingSocket<usize> for Wire {
    fn send_to(&mut self, message: &Message, to: &usize) {
        let mut boxes = self.boxes.borrow_mut();
        boxes.entry(*to).or_default().push_back((self.own, self.polls + self.delay, message.clone()));
    }

    fn receive_all_messages(&mut self) -> Vec<(usize, Message)> {
        self.polls += 1;
        let mut boxes = self.boxes.borrow_mut();
        let mail = boxes.entry(self.own).or_default();
        let due = mail.iter().take_while(|(_, due, _)| *due <= self.polls).count();
        mail.drain(..due).map(|(from, _, message)| (from, message)).collect()
    }
}

type Jumping = Net<Jumpers, ggrs::PredictRepeatLast, usize>;

/// How a session is set up.
#[derive(Clone, Copy)]
struct Setting {
    window: usize,
    input_delay: usize,
    /// Of packets, in polls.
    delay: u64,
}

const ROLLBACK: Setting = Setting { window: 8, input_delay: 0, delay: 3 };

fn sessions(players: usize, setting: Setting) -> Vec<P2PSession<Jumping>> {
    let boxes = Rc::new(RefCell::new(BTreeMap::new()));
    let session = |own: usize| {
        let mut builder = SessionBuilder::<Jumping>::new()
            .with_num_players(players)
            .expect("some")
            .with_max_prediction_window(setting.window)
            .with_input_delay(setting.input_delay)
            .with_desync_detection_mode(DesyncDetection::On { interval: 1 });
        for player in 0..players {
            let kind = if player == own { PlayerType::Local } else { PlayerType::Remote(player) };
            builder = builder.add_player(kind, player).expect("a place");
        }
        let wire = Wire { own, boxes: boxes.clone(), polls: 0, delay: setting.delay };
        builder.start_p2p_session(wire).expect("all are there")
    };
    (0..players).map(session).collect()
}

/// A peer: the match, and what it has confirmed: hashes of world and game by tick.
struct Peer {
    lockstep: Lockstep<Jumpers>,
    confirmed: BTreeMap<u64, [u64; 2]>,
    recorder: Recorder<Vec<u8>>,
    alarm: Option<Alarm>,
}

impl Peer {
    fn new() -> Peer {
        let (game, world) = begin();
        let recorder = Recorder::new(world.clone(), Vec::new()).expect("memory");
        Peer::of(Lockstep::new(game, world).expect("small"), recorder)
    }

    fn of(lockstep: Lockstep<Jumpers>, recorder: Recorder<Vec<u8>>) -> Peer {
        Peer { lockstep, confirmed: BTreeMap::new(), recorder, alarm: None }
    }

    fn advance(&mut self, player: usize, session: &mut P2PSession<Jumping>, told: impl FnMut(&World)) {
        session.add_local_input(player, input(player, session.current_frame())).expect("a player");
        self.lockstep.advance_telling(session, told).expect("no failure");
        while let Some(confirmed) = self.lockstep.confirmed() {
            let before = self.confirmed.insert(confirmed.tick, [confirmed.world, confirmed.own]);
            assert_eq!(before, None, "tick {} came twice", confirmed.tick);
            for command in confirmed.commands {
                self.recorder.apply(command.clone()).expect("accepted before");
            }
            self.recorder.step();
        }
        for event in session.events() {
            if let GgrsEvent::DesyncDetected { frame, local_checksum, remote_checksum, .. } = event {
                let alarm = self.lockstep.alarm(frame, local_checksum, remote_checksum);
                self.alarm = self.alarm.or(Some(alarm));
            }
        }
    }
}

/// Advances all until each has settled a tick.
fn play(peers: &mut [Peer], sessions: &mut [P2PSession<Jumping>], to: u64) {
    for _ in 0..10_000 {
        if peers.iter().all(|peer| peer.lockstep.settled() >= to) {
            return;
        }
        for (player, (peer, session)) in peers.iter_mut().zip(sessions.iter_mut()).enumerate() {
            peer.advance(player, session, |_| ());
        }
    }
    panic!("no end");
}

fn assert_equal(peers: &[Peer], ticks: std::ops::RangeInclusive<u64>) {
    for tick in ticks {
        for peer in peers {
            assert_eq!(peer.confirmed.get(&tick), peers[0].confirmed.get(&tick), "tick {tick}");
            assert!(peer.confirmed.contains_key(&tick), "tick {tick}");
        }
    }
}

#[test]
fn peers_are_equal_and_their_recordings_verify() {
    let (mut peers, mut sessions) = (vec![Peer::new(), Peer::new()], sessions(2, ROLLBACK));
    play(&mut peers, &mut sessions, 300);
    assert_equal(&peers, 1..=300);
    for peer in peers {
        assert!(peer.lockstep.steps() > 450, "it went back: {}", peer.lockstep.steps());
        assert_eq!(peer.alarm, None);
        let last = *peer.confirmed.last_key_value().expect("it played").0;
        let file = peer.recorder.finish().expect("memory");
        let played = Player::new(file.as_slice()).expect("a replay").verify().expect("it plays");
        assert_eq!((played.ticks, played.hash), (last, peer.confirmed[&last][0]));
    }
}

/// With a window of 1 there is no prediction but of the first tick, with 0 none; the states are those of rollback with that delay.
#[test]
fn lockstep_by_input_delay_is_the_same_game() {
    let mut outcomes = Vec::new();
    for window in [0, 1, 8] {
        let setting = Setting { window, input_delay: 4, delay: 3 };
        let (mut peers, mut sessions) = (vec![Peer::new(), Peer::new()], sessions(2, setting));
        play(&mut peers, &mut sessions, 200);
        assert_equal(&peers, 1..=200);
        for peer in &peers {
            let predicted = peer.lockstep.steps() - peer.lockstep.world().tick();
            assert!(if window < 2 { predicted <= 1 } else { true }, "window {window}: {predicted}");
        }
        outcomes.push(peers.swap_remove(0).confirmed[&200]);
    }
    assert_eq!(outcomes[1..], [outcomes[0], outcomes[0]]);
}

#[test]
fn one_more_player_comes_in_the_middle() {
    let (mut peers, mut two) = (vec![Peer::new(), Peer::new()], sessions(2, ROLLBACK));
    let hello = Hello::new(&begin().1, 1);
    play(&mut peers, &mut two, 100);
    let tick = peers.iter().map(|peer| peer.lockstep.settled()).min().expect("two");
    for peer in &mut peers {
        let later = peer.lockstep.settled() + 1;
        assert_eq!(peer.lockstep.restart(later), Err(LockstepError::Gone { tick: later }));
        peer.lockstep.restart(tick).expect("it is settled and kept");
        peer.confirmed.clear();
    }
    let snapshot = peers[0].lockstep.snapshot(&hello).expect("it is kept");
    let joined = Lockstep::join(&hello, &snapshot).expect("the same game");
    assert_eq!((joined.game(), joined.settled()), (peers[1].lockstep.game(), tick));
    // Recordings begin anew as well.
    for peer in &mut peers {
        peer.recorder = Recorder::new(peer.lockstep.world().clone(), Vec::new()).expect("memory");
    }
    let recorder = Recorder::new(joined.world().clone(), Vec::new()).expect("memory");
    peers.push(Peer::of(joined, recorder));
    let mut three = sessions(3, ROLLBACK);
    play(&mut peers, &mut three, tick + 150);
    assert_equal(&peers, tick + 1..=tick + 150);
    assert_eq!(peers[2].lockstep.game().discs.len(), 3);
    for peer in &peers {
        let (tick, hashes) = peer.confirmed.last_key_value().expect("it played");
        assert_eq!((peer.recorder.world().tick(), peer.recorder.world().hash()), (*tick, hashes[0]));
    }
}

/// Whatever was told and not cancelled is what happened.
#[test]
fn events_are_told_once() {
    let (mut peers, mut sessions) = (vec![Peer::new(), Peer::new()], sessions(2, ROLLBACK));
    let (mut log, mut heard, mut cancelled) = (EventLog::new(10), BTreeSet::<EventId>::new(), 0);
    while peers[0].lockstep.settled() < 800 {
        let listen = |world: &World| {
            let told = log.tell(world);
            for event in told.events.new {
                assert!(heard.insert(event.id()), "told twice: {event:?}");
            }
            for event in told.events.cancelled {
                cancelled += 1;
                assert!(heard.remove(&event.id()), "never told: {event:?}");
            }
        };
        peers[0].advance(0, &mut sessions[0], listen);
        peers[1].advance(1, &mut sessions[1], |_| ());
    }
    // The same ticks without rollbacks.
    let settled = peers[0].confirmed.len() as u64;
    let file = peers.swap_remove(0).recorder.finish().expect("memory");
    let mut player = Player::new(file.as_slice()).expect("a replay");
    let mut happened = BTreeSet::new();
    while player.step().expect("it plays").is_some() {
        happened.extend(player.world().events().iter().map(tamias2d::Event::id));
    }
    heard.retain(|id| id.tick < settled);
    assert!(happened.len() > 50 && cancelled > 0, "{} and {cancelled}", happened.len());
    assert_eq!(heard, happened);
}

/// One bit of one peer's memory: both are told, with the tick, and the states of that tick name the field.
#[test]
fn a_flipped_bit_raises_the_alarm() {
    let setting = Setting { window: 1, input_delay: 4, delay: 1 };
    let (mut peers, mut sessions) = (vec![Peer::new(), Peer::new()], sessions(2, setting));
    for peer in &mut peers {
        peer.lockstep.keep_evidence(32);
    }
    play(&mut peers, &mut sessions, 60);
    let struck = peers[1].lockstep.world().tick();
    let disc = peers[1].lockstep.game().discs[0];
    peers[1].lockstep.tamper(|world| {
        let mut velocity = world.body(disc).expect("it is there").velocity();
        velocity.y = Velocity::from_bits(velocity.y.to_bits() ^ 1);
        world.set_velocity(disc, velocity).expect("in range");
    });
    for _ in 0..20 {
        for (player, (peer, session)) in peers.iter_mut().zip(&mut sessions).enumerate() {
            peer.advance(player, session, |_| ());
        }
    }
    let alarms: Vec<Alarm> = peers.iter().map(|peer| peer.alarm.expect("it rang")).collect();
    // The state of the tick in which it was struck had been kept already.
    let [here, there] = alarms[0].world;
    assert_eq!(alarms[1].world, [there, here]);
    assert!(alarms.iter().all(|alarm| (struck..=struck + 1).contains(&alarm.tick)), "{struck}: {alarms:?}");
    let told = format!(
        "desync at tick {}: the worlds differ, {here:016x} here and {there:016x} there; compare the evidence or the recordings of both: tamias2d diff HERE THERE",
        alarms[0].tick
    );
    assert_eq!(alarms[0].to_string(), told);
    let evidence = |peer: usize| peers[peer].lockstep.evidence(struck + 1).expect("it is kept");
    let divergence = evidence(0).first_difference(evidence(1)).expect("readable").expect("they differ");
    assert_eq!((divergence.tick, divergence.findings.len()), (struck + 1, 1));
    let finding = &divergence.findings[0];
    assert!(finding.is_one_bit());
    assert_eq!((finding.object.as_str(), finding.field.as_str()), ("body 1v0", "velocity.y"));
}

/// The other alarm: rules that go by something else than state and inputs.
#[test]
fn an_alarm_tells_the_world_from_the_game() {
    let lockstep = Peer::new().lockstep;
    let checksum = |world: u64, own: u64| u128::from(own) << 64 | u128::from(world);
    let alarm = lockstep.alarm(7, checksum(1, 2), checksum(1, 3));
    assert_eq!(alarm, Alarm { tick: 7, world: [1, 1], own: [2, 3] });
    assert_eq!(
        alarm.to_string(),
        "desync at tick 7: the game's own states differ, 0000000000000002 here and 0000000000000003 there, and the worlds do not; look for rules that go by anything but state and inputs"
    );
    assert_eq!(
        lockstep.alarm(7, checksum(1, 2), checksum(4, 3)).to_string(),
        "desync at tick 7: the worlds differ, 0000000000000001 here and 0000000000000004 there, and the game's own states, 0000000000000002 and 0000000000000003; compare the evidence or the recordings of both: tamias2d diff HERE THERE"
    );
}

/// A type that does not read what it writes is told from a state that is not kept.
#[test]
fn a_state_that_cannot_be_read_back_says_so() {
    #[derive(Serialize, Deserialize)]
    struct Forgetful {
        #[serde(skip_serializing)]
        score: u32,
    }
    impl Game for Forgetful {
        type Input = i8;
        fn act(&mut self, _: &[Option<i8>], _: &mut Turn<'_>) {
            self.score += 1;
        }
    }
    let mut lockstep = Lockstep::new(Forgetful { score: 0 }, world(0.0, 0.0)).expect("small");
    let builder = SessionBuilder::<Net<Forgetful>>::new().with_num_players(1).expect("one");
    let mut session = builder.with_check_distance(2).start_synctest_session().expect("a session");
    let mut tick = || {
        session.add_local_input(0, 0).expect("a player");
        lockstep.advance(&mut session)
    };
    let error = (0..9).find_map(|_| tick().err()).expect("it goes back, and cannot");
    assert_eq!(error, LockstepError::Unreadable);
    assert!(error.to_string().contains("cannot be read back"), "{error}");
}

/// As large as it may be, of what takes more room in memory than as bytes.
#[test]
fn a_state_of_nearly_a_mebibyte_goes_back() {
    #[derive(Serialize, Deserialize)]
    struct Large {
        map: Vec<(u8, u64)>,
        names: Vec<String>,
    }
    impl Game for Large {
        type Input = i8;
        fn act(&mut self, _: &[Option<i8>], _: &mut Turn<'_>) {
            self.map[0].1 += 1;
        }
    }
    let game = Large { map: vec![(1, 2); 90_000], names: vec!["abcdefgh".into(); 14_000] };
    let mut lockstep = Lockstep::new(game, world(0.0, 0.0)).expect("1 034 000 bytes");
    let builder = SessionBuilder::<Net<Large>>::new().with_num_players(1).expect("one");
    let mut session = builder.with_check_distance(2).start_synctest_session().expect("a session");
    for _ in 0..6 {
        session.add_local_input(0, 0).expect("a player");
        lockstep.advance(&mut session).expect("it goes back");
    }
    assert_eq!(lockstep.game().map[0].1, 8);
}
