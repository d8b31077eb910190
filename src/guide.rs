//! Guide. Chapters are documentation only; their programs are tests.
//!
//! # Impacts
//!
//! Two colliders that come together fast collide at a time within the tick, t_c of IM:col2D: both go as they went until
//! then, are answered there by impulses, and go on from there with what is left of the tick, gravity included. Nothing of it
//! depends on where ticks begin, and at default settings what is fast does not pass through another: static, moving or
//! turning, two fast ones, needles, many at once.
//!
//! ```
//! use tamias2d::{BodyDef, ColliderDef, Commands, Shape, Vec2, World, WorldDef};
//!
//! // 1 kg at 2 m/s and 3 kg at −2 m/s, elastic: they part with −4 and 0 m/s.
//! let mut world = World::new(&WorldDef::default())?;
//! let mut face = ColliderDef::new(Shape::Box { width: "1".parse()?, height: "1".parse()? });
//! face.restitution = "1".parse()?;
//! let mut add = |x: f64, v: f64, mass: &str| -> Result<_, Box<dyn std::error::Error>> {
//!     let (position, velocity) = (Vec2::from_f64(x, 0.0)?, Vec2::from_f64(v, 0.0)?);
//!     let mass = Some(mass.parse()?);
//!     let colliders = vec![face.clone()];
//!     Ok(world.create_body(&BodyDef { position, velocity, mass, colliders, ..BodyDef::default() })?)
//! };
//! let (light, heavy) = (add(0.0, 2.0, "1")?, add(3.0, -2.0, "3")?);
//! let collision = loop {
//!     world.step();
//!     if let [collision] = world.collisions() {
//!         break *collision;
//!     }
//! };
//! // Their gap of 2 m closes at 4 m/s: at t_c = 0.5 s, which is when tick 30 begins.
//! let t_c = (world.tick() - 1) as f64 / 60.0 + collision.time.to_f64();
//! assert!((t_c - 0.5).abs() < 1e-7);
//! let speed = |id| world.body(id).expect("nobody destroyed it").velocity().x.to_f64();
//! assert!((speed(light) + 4.0).abs() < 2e-6 && speed(heavy).abs() < 2e-6);
//! assert!((collision.impulse.x.to_f64().abs() - 6.0).abs() < 1e-5); // N s
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## What is an impact
//!
//! What comes together faster than a threshold. The rest is pressed together by the contact solver and comes to rest.
//!
//! | pair | an impact from |
//! |---|---|
//! | C_R = 1 | 1 µm/s on |
//! | 0 < C_R < 1 | g·T/(2·C_R) on, with T the tick, from 1 cm/s to 1 m/s: a slower bounce would end within the tick, less than a millimetre high. 0.1 m/s at 60 ticks/s, 9.8 m/s² and C_R = 0.8 |
//! | both bodies lie among others | 4·g·T on: 0.65 m/s |
//! | C_R = 0 | 1 m/s on, so that nothing is passed through; between bodies that lie among others none |
//!
//! Speeds are multiplied by 2^k, with k the world's `unit_shift`. Scenes in which nothing comes together so fast pay
//! nothing for impacts.
//!
//! ## What is promised
//!
//! * **Momentum**: what one body gets, the other loses, to one rounding of each velocity (2⁻⁴⁸ m/s).
//! * **Energy** is never gained by an impact beyond rounding. 200 polygons that bounce elastically for 10 000 ticks keep
//!   theirs to 1e-8.
//! * **All points of one time at once.** Both points of a flat face, and all contacts that meet within 16 ns and hang
//!   together by bodies that move, are one answer: impulses that do not pull, after which each point that came closer parts
//!   with C_R times its speed, or faster. A box that lands flat bounces without spin. Of several C_R in one answer each
//!   contact has its own.
//! * **Only what comes closer takes part.** What touches at rest is not moved by a blow that goes through it, but struck in
//!   its turn, at the same time. So chains act as if there were small gaps between their links, however small: in a cradle
//!   of equal elastic bodies as many leave as came, and one that hits two that touch stops, and the last one leaves.
//!   With C_R below 1 a chain comes apart from its far end, without it the whole goes on as one.
//! * **Sides are equal.** One that is hit from both sides at once is one answer: 1, 0, −1 m/s give −1, 0, 1, and 2, 0, −1
//!   give −4/3, 2/3, 5/3. The order in which bodies were created has no say.
//!
//! It is not promised that hits at one time are the limit of hits one after the other: 2, 0, −1 would give −1, 0, 2 in
//! either order. The rule by which all contacts that touch take part would: but then a cradle would go apart as
//! −3/5, 2/5, 2/5, 2/5, 2/5, with momentum and energy as exact, which nobody expects of one.
//!
//! * **What rests bears.** A contact through which a load goes when a body is struck leaves blows below 2 m/s (without
//!   restitution 8 m/s) to the contact solver: a pile is not a cradle.
//! * A box that lands a thousandth of a radian askew has two impacts, one after the other, and leaves with a spin. That is
//!   how rigid bodies are, not an error.
//!
//! ## Limits
//!
//! After 8 answers in a tick two bodies that are not elastic go on as one until it ends, as long as they touch: what rolls on
//! another, or is squeezed between two, would close without end. After 256 answers of one body nothing bounces off it in that
//! tick, after 320 it stays where it is; [`World::status`](crate::World::status) names it then, as
//! [`Bound::Impacts`](crate::Bound::Impacts), and has it in its hash.
//!
//! A world answers 2048 times in a tick, and 8 times more for each body that may be struck: then nothing bounces in it
//! until the tick ends, and after twice as many who is struck stays, and is named as well. Speeds are limited to 8192·2^k m/s.
//!
//! Without restitution, or with little, bodies that spin fast while they roll on each other may overlap by centimetres for
//! some ticks; they do not come out on the other side. The rooms of `tests/tunnelling.rs` measure it. What rests or is
//! pressed is the contact solver's, which goes by where things are when the tick begins: a kinematic wall whose points
//! curve by centimetres in a tick (ω²·r·T²/2), and walls of a few millimetres under a load, may be pressed through.
//!
//! ## What is told
//!
//! [`World::collisions`](crate::World::collisions) has the last step's in the order in which they happened: t_c, point,
//! normal, impulse, and the velocities of both bodies before and after. They are a value of the step, neither saved nor
//! hashed. What rests has no collisions; that it touches at all is in [`World::events`](crate::World::events).
//!
//! # Sleeping
//!
//! What rests need not be computed. A world whose definition has `sleeping: Some(Sleeping::default())` lets bodies fall
//! asleep; without it, the default, none of this costs anything or changes a bit. It is off because it changes motion: what
//! drifts more slowly than the threshold is stopped.
//!
//! ```
//! use tamias2d::{BodyDef, BodyKind, ColliderDef, Commands, Shape, Sleeping, Vec2, World, WorldDef};
//!
//! let gravity = Vec2::from_f64(0.0, -9.8)?;
//! let mut world = World::new(&WorldDef { gravity, sleeping: Some(Sleeping::default()), ..WorldDef::default() })?;
//! let face = ColliderDef::new(Shape::Box { width: "1".parse()?, height: "1".parse()? });
//! let mut add = |world: &mut World, kind, y: f64| {
//!     let position = Vec2::from_f64(0.0, y).expect("in range");
//!     world.create_body(&BodyDef { kind, position, colliders: vec![face.clone()], ..BodyDef::default() })
//! };
//! add(&mut world, BodyKind::Static, 0.0)?;
//! let (lower, upper) = (add(&mut world, BodyKind::Dynamic, 1.0)?, add(&mut world, BodyKind::Dynamic, 2.0)?);
//! for _ in 0..90 {
//!     world.step();
//! }
//! let awake = |world: &World, id| world.body(id).expect("it exists").is_awake();
//! assert!(!awake(&world, lower) && !awake(&world, upper));
//! world.apply_impulse(upper, Vec2::from_f64(1.0, 0.0)?, None)?;
//! assert!(awake(&world, lower), "the whole island wakes");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Who falls asleep
//!
//! An *island*: dynamic bodies that hang together by contacts. Static and kinematic bodies connect nothing, nor do sensors. It
//! falls asleep at the end of the tick in which each of its bodies has been quiet for [`Sleeping::time`](crate::Sleeping): its
//! speed and that of its rim (|ω| times its reach) were at most [`Sleeping::speed`](crate::Sleeping) in each of these ticks.
//! Bodies that may not sleep (`allow_sleep: false`) keep their island awake, and so do a kinematic body that moves and touches
//! it, however slowly, and forces that are applied tick by tick. A force that was set may press what sleeps against a wall. While
//! a body pulls others (`mu`) and is not static, nothing falls asleep.
//!
//! Velocities become zero, exactly; places and impulses of contacts stay as they are. So nothing creeps, what wakes has lost
//! energy and gained none, and a stack that wakes stands as it stood: twenty boxes begin with 1e-3 m/s at most.
//!
//! ## Who wakes, and when
//!
//! The whole island, by
//!
//! * what touches it: in the very tick. The tick is computed as if the island had been awake when it began, so a hit is as exact
//!   as any other, also if what is hit hits farther sleepers in the same tick. What only passes nearby wakes nobody;
//! * a command that changes one of its bodies or colliders, but for user data; one that changes nothing does not. Applied
//!   forces and impulses do always;
//! * a command that moves, changes or destroys what one of its bodies touches, or puts something where one of them is;
//! * a change of gravity, of an attractor, or of what pulls;
//! * [`Commands::wake`](crate::Commands::wake).
//!
//! [`Commands::put_to_sleep`](crate::Commands::put_to_sleep) lets an island fall asleep at once, in the air as well.
//!
//! Who sleeps, for how long each has been quiet, and the contacts of what sleeps are state: saved, hashed, compared, in
//! replays. In which order islands are found has no say. Events of contacts do not end because bodies fall asleep; sensors tell of
//! sleepers as of others; queries find them.
