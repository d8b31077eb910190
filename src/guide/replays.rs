//! # Replays
//!
//! Record always. A recording holds the world as it began, every command, and the hash of the complete state after each tick; an
//! idle tick costs 9 bytes. It is a save game, a highlight, a bug report, and the only proof of what a machine computed.
//!
//! ```
//! use tamias2d::replay::{Player, Recorder};
//! use tamias2d::{BodyDef, Commands, Vec2, World, WorldDef};
//!
//! // Recording: whatever has the commands of a world is played by a recorder.
//! let mut game = Recorder::new(World::new(&WorldDef::default())?, Vec::new())?;
//! let ship = game.create_body(&BodyDef::default())?;
//! for tick in 0..120 {
//!     if tick % 10 == 0 {
//!         game.input(vec![tick as u8])?; // the game's own: players' buttons, chat, whose turn it is
//!         game.apply_impulse(ship, Vec2::from_f64(0.5, 0.0)?, None)?;
//!     }
//!     game.step();
//! }
//! let file = game.finish()?;
//!
//! // Verifying: every tick is computed again and its hash compared.
//! let played = Player::new(file.as_slice())?.verify()?;
//! assert_eq!((played.ticks, played.commands), (120, 1 + 2 * 12));
//!
//! // Playing: to look at, tick by tick.
//! let mut player = Player::new(file.as_slice())?;
//! while player.step()?.is_some() {
//!     let _ = player.world().body(ship).expect("it is there").position().to_f64();
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In a match of [`lockstep`](super::lockstep) the confirmed ticks are recorded, one by one as they come.
//!
//! ## Keyframes
//!
//! Every minute a recording has the whole state, a *keyframe*, from which it can be played without what comes before; every second
//! it has the hashes of the state's parts. [`Recording`](crate::replay::Recording) says how often, and [`Player`](crate::replay::Player) can
//! begin at them. So a long recording is verified by all cores at once, each from one keyframe to the next, whose hash it must
//! meet, and a fault in ten minutes is found without computing ten minutes.
//!
//! ## By the program
//!
//! | command | what it does |
//! |---|---|
//! | `tamias2d verify FILE…` | computes every tick again and compares; names the first that differs. By keyframes on all cores |
//! | `tamias2d verify FILE --evidence OUT` | the same, and writes what memory holds at the tick that differs |
//! | `tamias2d diff A B` | where two recordings, saves or pieces of evidence part: tick, stage, object, field, both values; or how far that can be said, and what to run on the other machine |
//! | `tamias2d info FILE` | what a recording holds, without computing it |
//!
//! ## Two machines differ. Then what?
//!
//! 1. `tamias2d verify` both recordings on one machine. One that does not verify was computed by a machine that differs; if both do, the
//!    inputs differed.
//! 2. `tamias2d diff A B` names the first tick that differs, and where both sides have evidence of it, the field. What is equal on
//!    both sides before a stage and differs after it, that stage computed differently: a compiler or a processor. What differs where
//!    the stage writes nothing is memory; a single bit makes it certain.
//! 3. Without evidence it prints the command to run on the other machine.
//!
//! A recorder with `flight_ticks` in its [`Recording`](crate::replay::Recording) holds evidence of the last ticks in memory; when the alarm rings,
//! [`Recorder::alarm`](crate::replay::Recorder::alarm) appends it to the file. A tick costs several times as much then.
//!
//! ## What a recording survives
//!
//! A crash: what was written until then plays, and is reported as cut off. Another machine, another compiler, another profile: that is
//! the point. Another release of this crate: if its [`LAW`](crate::LAW) is the same, it plays; if not, it is refused by name, because it would play
//! differently. Keep the release that recorded it if it must play for years. A changed, moved or lost byte is found, at its place.
