//! # Sleeping
//!
//! What rests need not be computed. A world whose definition has `sleeping: Some(Sleeping::default())` lets bodies fall
//! asleep; without it, the default, none of this costs anything or changes a bit. It is off because it changes motion: what
//! drifts more slowly than the threshold is stopped.
//!
//! Without it, too, what contacts hold comes to rest, to the bit: an island that lies on something, and of which no body was faster
//! than 15 µm/s in a tick, ends that tick as it began it, is left so for good, and is hardly computed any more until something is
//! new to it. That stops what forces would make faster by less than that in a tick (times 2^k): 0.9 mm/s² at 60 ticks/s, 15 mm/s² at
//! 1000, a disc at rest on a slope of 0.008° or 0.12°.
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
