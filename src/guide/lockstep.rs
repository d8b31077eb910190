//! # A lockstep game in 20 minutes
//!
//! Every peer runs the whole game; only inputs go over the network. The crate `ggrs` moves them, predicts those that are late
//! and says when to go back; [`lockstep`](crate::lockstep) (feature `ggrs`, rustc 1.87 or newer) does what it asks for.
//!
//! ```toml
//! [dependencies]
//! tamias2d = { version = "0.1", features = ["ggrs"] }
//! ggrs = "0.13"
//! serde = { version = "1", features = ["derive"] }
//! ```
//!
//! ## 1. The rules (10 minutes)
//!
//! A game is its state beside the world, and what inputs do. Here two discs push each other off a platform. All of `Sumo` is
//! state; sprites and sounds live elsewhere. The program ends with the test that every lockstep game needs: each tick is computed
//! again, up to seven times, from restored states, and must give the same.
//!
// Without the feature there is nothing to point at.
#![cfg_attr(not(feature = "ggrs"), allow(rustdoc::broken_intra_doc_links))]
#![cfg_attr(feature = "ggrs", doc = "```")]
#![cfg_attr(not(feature = "ggrs"), doc = "```ignore")]
//! use ggrs::SessionBuilder;
//! use serde::{Deserialize, Serialize};
//! use tamias2d::lockstep::{Game, Lockstep, Net, Turn};
//! use tamias2d::{BodyDef, BodyId, BodyKind, ColliderDef, Commands, Length, Shape, Vec2, World, WorldDef};
//!
//! /// What a player does in a tick. Whole numbers: a stick's float is made one here, before it is anybody's input.
//! #[derive(Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
//! struct Input {
//!     push: i8, // -1, 0, 1
//!     jump: bool,
//! }
//!
//! /// All state beside the world.
//! #[derive(Serialize, Deserialize)]
//! struct Sumo {
//!     discs: Vec<BodyId>,
//!     fallen: Vec<u32>,
//! }
//!
//! impl Game for Sumo {
//!     type Input = Input;
//!
//!     fn act(&mut self, inputs: &[Option<Input>], turn: &mut Turn<'_>) {
//!         for (player, input) in inputs.iter().enumerate() {
//!             let Some(input) = input else { continue }; // cut off
//!             let disc = self.discs[player];
//!             let push = Vec2::from_f64(6.0 * f64::from(input.push.signum()), 0.0).expect("small");
//!             // The world may refuse a command, on all peers alike; then nothing has happened.
//!             let _ = turn.apply_force(disc, push, None);
//!             if input.jump {
//!                 let _ = turn.apply_impulse(disc, Vec2::from_f64(0.0, 1.5).expect("small"), None);
//!             }
//!             // Who has fallen comes back.
//!             let abyss = Length::from_f64(-8.0).expect("small");
//!             if turn.world().body(disc).is_some_and(|disc| disc.position().y < abyss) {
//!                 self.fallen[player] += 1;
//!                 let _ = turn.set_position(disc, Vec2::from_f64(0.0, 3.0).expect("small"));
//!                 let _ = turn.set_velocity(disc, Vec2::default());
//!             }
//!         }
//!     }
//! }
//!
//! /// Where a match begins: the same on every peer.
//! fn begin() -> Result<(Sumo, World), Box<dyn std::error::Error>> {
//!     let gravity = Vec2::from_f64(0.0, -9.8)?;
//!     let mut world = World::new(&WorldDef { gravity, ..WorldDef::default() })?;
//!     let platform = ColliderDef::new(Shape::Box { width: "10".parse()?, height: "1".parse()? });
//!     world.create_body(&BodyDef { kind: BodyKind::Static, colliders: vec![platform], ..BodyDef::default() })?;
//!     let mut discs = Vec::new();
//!     for x in [-2.0, 2.0] {
//!         let disc = ColliderDef::new(Shape::Circle { radius: "0.5".parse()? });
//!         let position = Vec2::from_f64(x, 1.5)?;
//!         discs.push(world.create_body(&BodyDef { position, colliders: vec![disc], ..BodyDef::default() })?);
//!     }
//!     Ok((Sumo { discs, fallen: vec![0; 2] }, world))
//! }
//!
//! let (game, world) = begin()?;
//! let mut lockstep = Lockstep::new(game, world)?;
//! let builder = SessionBuilder::<Net<Sumo>>::new().with_num_players(2)?;
//! let mut session = builder.with_check_distance(7).start_synctest_session()?;
//! for tick in 0..600u32 {
//!     for player in 0..2 {
//!         let push = if tick / 50 % 2 == player { 1 } else { -1 };
//!         session.add_local_input(player as usize, Input { push, jump: tick % 97 == 0 })?;
//!     }
//!     lockstep.advance(&mut session)?; // an error if a tick comes out differently
//! }
//! assert!(lockstep.game().fallen.iter().sum::<u32>() > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What happens in a step (who touched whom) is read after it, in [`Game::watch`](crate::lockstep::Game): a world that was restored
//! has no events.
//!
//! ## 2. The peers (10 minutes)
//!
//! The same loop on every peer. Before it they tell each other who they are ([`Hello`](crate::hello::Hello)): another law, format,
//! game or scene is refused by a sentence that says which and what to do, instead of a desync minutes later.
//!
#![cfg_attr(feature = "ggrs", doc = "```")]
#![cfg_attr(not(feature = "ggrs"), doc = "```ignore")]
//! # use serde::{Deserialize, Serialize};
//! # use tamias2d::lockstep::{Game, Turn};
//! # use tamias2d::{BodyDef, BodyId, Commands, Vec2, World, WorldDef};
//! # #[derive(Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
//! # struct Input { push: i8, jump: bool }
//! # #[derive(Serialize, Deserialize)]
//! # struct Sumo { discs: Vec<BodyId> }
//! # impl Game for Sumo {
//! #     type Input = Input;
//! #     fn act(&mut self, inputs: &[Option<Input>], turn: &mut Turn<'_>) {
//! #         for (disc, input) in self.discs.iter().zip(inputs) {
//! #             let push = f64::from(input.unwrap_or_default().push);
//! #             let _ = turn.apply_force(*disc, Vec2::from_f64(push, 0.0).expect("small"), None);
//! #         }
//! #     }
//! # }
//! # fn begin() -> Result<(Sumo, World), Failure> {
//! #     let mut world = World::new(&WorldDef::default())?;
//! #     let discs = vec![world.create_body(&BodyDef::default())?, world.create_body(&BodyDef::default())?];
//! #     Ok((Sumo { discs }, world))
//! # }
//! # type Failure = Box<dyn std::error::Error + Send + Sync>;
//! # use std::sync::mpsc::{Receiver, Sender, channel};
//! # struct Lobby { to: Sender<Vec<u8>>, from: Receiver<Vec<u8>> }
//! # impl Lobby {
//! #     fn exchange(&self, packet: Vec<u8>) -> Result<Vec<u8>, Failure> { self.to.send(packet)?; Ok(self.from.recv()?) }
//! # }
//! use ggrs::{DesyncDetection, GgrsEvent, PlayerType, SessionBuilder, UdpNonBlockingSocket};
//! use std::net::SocketAddr;
//! use tamias2d::hello::Hello;
//! use tamias2d::lockstep::{Lockstep, Net};
//! use tamias2d::replay::Recorder;
//!
//! const GAME: u64 = 1; // another number for each release that plays differently
//!
//! fn peer(me: usize, port: u16, other: SocketAddr, lobby: Lobby) -> Result<u64, Failure> {
//!     let (game, world) = begin()?;
//!     let hello = Hello::new(&world, GAME);
//!     let theirs = Hello::decode(&lobby.exchange(hello.encode())?)?; // by whatever brings the players together
//!     hello.check(&theirs)?;
//!
//!     let mut recorder = Recorder::new(world.clone(), Vec::new())?; // a file, in earnest
//!     let mut lockstep = Lockstep::new(game, world)?;
//!     let mut session = SessionBuilder::<Net<Sumo>>::new()
//!         .with_num_players(2)?
//!         .with_max_prediction_window(8)
//!         .with_desync_detection_mode(DesyncDetection::On { interval: 1 })
//!         .add_player(PlayerType::Local, me)?
//!         .add_player(PlayerType::Remote(other), 1 - me)?
//!         .start_p2p_session(UdpNonBlockingSocket::bind_to_port(port)?)?;
//!
//! #   // Where both have been: one may be confirmed farther when it ends.
//! #   let mut end = 0;
//!     while recorder.world().tick() < 300 {
//!         let push = if recorder.world().tick() % 60 < 30 { 1 } else { -1 }; // the keyboard, in earnest
//!         session.add_local_input(me, Input { push, jump: false })?;
//!         lockstep.advance(&mut session)?; // false: waits for the other one
//!         for event in session.events() {
//!             if let GgrsEvent::DesyncDetected { frame, local_checksum, remote_checksum, .. } = event {
//!                 return Err(lockstep.alarm(frame, local_checksum, remote_checksum).to_string().into());
//!             }
//!         }
//!         // What no late input can change any more is recorded, and computed a second time by that: without rollbacks.
//!         while let Some(confirmed) = lockstep.confirmed() {
//!             for command in confirmed.commands {
//!                 recorder.apply(command.clone())?;
//!             }
//!             recorder.step();
//!             assert_eq!(recorder.world().hash(), confirmed.world, "this machine's memory is at fault");
//! #           end = if recorder.world().tick() == 300 { confirmed.world } else { end };
//!         }
//!         // Here a game draws lockstep.world() and waits for its next frame.
//!         std::thread::sleep(std::time::Duration::from_millis(1));
//!     }
//! #   for _ in 0..500 {
//! #       session.poll_remote_clients();
//! #       std::thread::sleep(std::time::Duration::from_millis(1));
//! #   }
//! #   assert!(end != 0, "tick 300 was confirmed");
//! #   Ok(end)
//! }
//! # let free = || Ok::<_, Failure>(std::net::UdpSocket::bind("127.0.0.1:0")?);
//! # let sockets = [free()?, free()?];
//! # let [a, b] = [sockets[0].local_addr()?, sockets[1].local_addr()?];
//! # drop(sockets);
//! # let ((to_b, from_a), (to_a, from_b)) = (channel(), channel());
//! # let first = std::thread::spawn(move || peer(0, a.port(), b, Lobby { to: to_b, from: from_b }));
//! # let second = std::thread::spawn(move || peer(1, b.port(), a, Lobby { to: to_a, from: from_a }));
//! # assert_eq!(first.join().expect("no panic")?, second.join().expect("no panic")?);
//! # Ok::<(), Failure>(())
//! ```
//!
//! `cargo run --release --features ggrs --example p2p` is a game for two to four processes, with all of this page in it: ten minutes
//! of play in rough weather, every confirmed state compared. `--help` says what can be done to it.
//!
//! ## Rollback or input delay
//!
//! | | prediction window | input delay | a late packet |
//! |---|---|---|---|
//! | rollback | 8 | 0 … 2 | is corrected: go back, compute again |
//! | lockstep | 1 | 3 … 6 | stops everybody until it comes |
//! | lockstep without checksums | 0 | 3 … 6 | the same |
//!
//! With a window of 1 ggrs predicts nothing but the very first tick, and yet saves every state, so checksums are compared. With 0 it
//! saves none and compares none. A rollback of eight ticks costs nine steps in one frame: the report
//! (`benches/report/README.md`) says how many a frame has room for. `lockstep.advance` is told by the session which of these it is; the game does not change.
//!
//! ## Sounds and other things that happen once
//!
//! A tick that is computed again has its events again, or others. An [`EventLog`](crate::EventLog) tells each once: what is new (play it),
//! what did not happen after all (fade it out), what is confirmed (it plays already).
//!
//! ```text
//! let mut log = EventLog::new(10); // the prediction window and two more
//! lockstep.advance_telling(&mut session, |world| {
//!     for event in log.tell(world).events.new { … }
//! })?;
//! ```
//!
//! What must not be wrong even for a moment (a score, the end of a match) waits for its tick to be
//! [`confirmed`](crate::lockstep::Lockstep::confirmed).
//!
//! ## Spectators, and who comes late
//!
//! A spectator has a `SpectatorSession` and the same `Lockstep`: `lockstep.advance(&mut spectator)`. ggrs knows spectators from
//! the beginning on only, has room for 60 ticks on their side, and cuts off who leaves 128 unanswered: a host that does not run by the
//! clock looks at `network_stats` and waits for them.
//!
//! Who comes later gets the match itself. The host sends `lockstep.snapshot(&hello)` and, from then on, `confirmed.inputs` of each
//! tick, by a connection that loses nothing; the other one calls [`Lockstep::join`](crate::lockstep::Lockstep::join), which refuses
//! what is damaged or of another game, and then `lockstep.follow(&inputs)` for each tick. To let him play, end the session, let all
//! peers [`restart`](crate::lockstep::Lockstep::restart) at a tick that each has settled, and begin a session with one more player there.
//!
//! ## When the alarm rings
//!
//! [`Alarm`](crate::lockstep::Alarm) says at which tick, and whether the worlds differ or the game's own states. Its tick is the first
//! that was compared, and reports of checksums are lost as other packets are: the recordings say exactly which tick was the first.
//!
//! * The recorder's hash differs from the confirmed one: memory or a restored state on *this* machine, since that tick.
//! * Only the game's own state differs: something in `act` goes by more than its arguments, see [`determinism`](super::determinism).
//! * The worlds differ: `lockstep.keep_evidence(64)` keeps what memory held about each of the last ticks. A few ticks after the alarm
//!   write `lockstep.evidence(tick)` of those around it to files on both machines. `tamias2d diff HERE THERE` of two files of one
//!   tick, or [`Evidence::first_difference`](crate::replay::Evidence::first_difference), names stage, object, field and both values; and
//!   `tamias2d diff RECORDING EVIDENCE` of one machine does so without the other, for the recording is computed again. What happened
//!   between two ticks shows at the beginning of the second.
//! * Recordings made as above hold commands, computed a second time beside the match: a fault of memory is not in them, but what
//!   the game commanded because of it is. `tamias2d diff` of two of them names the first tick at which commands differ.
