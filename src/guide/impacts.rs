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
