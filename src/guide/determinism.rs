//! # Determinism
//!
//! ## What is promised
//!
//! * **The same world and the same commands give the same bits**, tick for tick: on 32 and 64 bits, little- and big-endian, with and
//!   without AVX2, in debug and release builds, whatever the compiler, on one thread or several
//!   ([`Threads`](crate::Threads)). There are no floats in a step, no clocks, no addresses, no hash maps, and nothing that
//!   could tell which thread was first.
//! * **A world that was saved, sent, loaded, copied or rolled back goes on as the one it was**: there is no state outside what
//!   [`World::save`](crate::World::save) writes. Ids come out the same too.
//! * **The hash covers all of it.** Two worlds with one [`World::hash`](crate::World::hash) go on alike; those that will not, differ in it
//!   now, not when bodies are already in other places.
//! * [`LAW`](crate::LAW) names the arithmetic. A build refuses saves, replays and peers of another law, because they would go on
//!   differently; it does not convert them.
//!
//! ```
//! use tamias2d::{BodyDef, ColliderDef, Commands, Rollback, Shape, Vec2, World, WorldDef};
//!
//! let mut world = World::new(&WorldDef { gravity: Vec2::from_f64(0.0, -9.8)?, ..WorldDef::default() })?;
//! for x in 0..4 {
//!     let face = ColliderDef::new(Shape::Circle { radius: "0.5".parse()? });
//!     let position = Vec2::from_f64(0.3 * f64::from(x), f64::from(x))?;
//!     world.create_body(&BodyDef { position, colliders: vec![face], ..BodyDef::default() })?;
//! }
//! let mut ring = Rollback::new(2);
//! ring.save(&world);
//! let mut loaded = World::load(&world.save())?;
//! for _ in 0..30 {
//!     world.step();
//!     loaded.step();
//! }
//! assert_eq!(world.hash(), loaded.hash());
//! ring.restore(&mut world, 0)?;
//! for _ in 0..30 {
//!     world.step();
//! }
//! assert_eq!(world.save(), loaded.save());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It is not promised that two *versions* of this crate give the same bits, nor that a scene built in another order does: order is
//! data, and commands are carried out in theirs.
//!
//! ## What the game must do
//!
//! | do | else |
//! |---|---|
//! | give every peer the same commands in the same order in the same tick | desync |
//! | decide by inputs, the world and your own saved state only | desync, often in the first rollback |
//! | keep random numbers' state in your own state | the second computing of a tick draws others |
//! | iterate over what has an order: vectors, `BTreeMap`, [`World::bodies`](crate::World::bodies) | a `HashMap` has another order in each process |
//! | make inputs whole numbers before they are sent | two peers round a stick's float differently |
//! | read events and collisions right after the step | a world just restored has none |
//! | take the outcome of a command as it comes: what one world refuses, all refuse | a retry that only one peer makes |
//!
//! Floats are dangerous, not forbidden. `from_f64` of a literal, or of sums and products of literals and small whole numbers, is the
//! same everywhere: IEEE says so. `sin`, `powf` and whatever a library computes is not. What went through `to_f64` is for drawing, and does not
//! come back: [`num`](crate::num) has roots and trigonometry that are exact.
//!
//! ## What is checked where
//!
//! | what | by |
//! |---|---|
//! | your rules | ggrs's `SyncTestSession` with check distance 7: [`lockstep`](super::lockstep) does it in ten lines. Have it in your tests, with real inputs |
//! | peers before a match | [`Hello`](crate::hello::Hello): law, formats, game, tick rate, scene |
//! | peers in a match | checksums of every confirmed tick (`DesyncDetection::On { interval: 1 }`): all of the world and all of your state |
//! | this machine | a recorder that computes the confirmed commands a second time: a difference is this machine's memory, not the network |
//! | a finished match | [`replays`](super::replays): every tick's hash, on any machine, at any time |
//! | a state from outside | [`World::load`](crate::World::load) refuses what is not exactly a save, and what breaks an invariant |
//! | this engine | goldens and random scenes in many builds and on many platforms, every tick compared (`replays/PLATFORMS.md`); its rules against floats, clocks and hash maps are a test |
//!
//! ## Hazards
//!
//! * **A fault in memory** that hits what only commands change (masses, shapes) is not in the hash until the state is saved and loaded;
//!   [`World::check`](crate::World::check) finds it. Keyframes of recordings look for it.
//! * **User data** is hashed. A pointer or a frame counter in it is a desync.
//! * **Pausing** one peer is not a tick: a tick without inputs is still a tick. Stop all, or none.
//! * **Time** is `tick / tick_rate`. A variable time step does not exist here.
//! * **Who is cut off** may be cut off at another tick for another peer, until they agree: ggrs goes back for it. What was recorded as
//!   confirmed within the last moments before a disconnect may come once more.
