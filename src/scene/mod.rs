//! Scenes as JSON: worlds and scripted commands for people without Rust. Feature `scene`.
//!
//! Every number is taken from its decimal digits, exactly, and rounded once to its quantity's format; none goes
//! through a float. Unknown keys are refused, and every error names its place.
//!
//! ```json
//! { "name": "tc2", "gravity": [0, 0], "tick_rate": 60,
//!   "bodies": [ { "name": "left", "kind": "dynamic", "position": [20, 20], "angle": 0, "velocity": [0, 0],
//!                 "angular_velocity": 0, "force": [100, 0], "torque": 0, "mass": 10, "inertia": 15,
//!                 "colliders": [ { "box": [2, 1], "restitution": 0.5 } ] } ],
//!   "attractors": [ { "position": [0, 0], "mu": 1000 } ],
//!   "commands": [ { "tick": 30, "do": { "apply_impulse": { "body": "left", "impulse": [0, 5] } } } ] }
//! ```
//!
//! # Keys of a scene
//!
//! | key | value | default |
//! |---|---|---|
//! | `name` | text | – |
//! | `tick_rate` | ticks per second, a whole number of 15 … 1000 | – |
//! | `bodies` | a list of bodies | – |
//! | `substeps` | steps per tick of contacts and of motion that is not exact in one, 1 … 64; four make one fourth-order step | as [`WorldDef`](crate::WorldDef) |
//! | `integrator` | `"forest_ruth"` or `"symplectic_euler"` | `"forest_ruth"` |
//! | `gravity` | [x, y] in m/s² | [0, 0] |
//! | `unit_shift` | k, 0 … 10: contacts are solved in units of 2^k m, for scenes that count in pixels | 0 |
//! | `sleeping` | whether what rests falls asleep: `true`, `false`, or `{ "speed", "time" }` in m/s and s, each as [`Sleeping`](crate::Sleeping) if left out | false |
//! | `attractors` | a list of `{ "name", "position", "mu" }`; `name` may be left out | none |
//! | `commands` | a list of `{ "tick", "do" }` | none |
//! | `ticks` | how long a recording of the scene is, if nobody says otherwise | 600 |
//! | `about` | text for people | empty |
//!
//! # Keys of a body
//!
//! | key | value | default |
//! |---|---|---|
//! | `name` | text, once in the scene; the scene refers to the body by it | its index |
//! | `kind` | `"dynamic"`, `"kinematic"` or `"static"` | `"dynamic"` |
//! | `position` | [x, y] in m | [0, 0] |
//! | `angle` | radians in [0, 2π] | 0 |
//! | `velocity`, `angular_velocity` | [x, y] in m/s, rad/s; 0 for a static body | 0 |
//! | `force`, `torque` | [x, y] in N, N m, each tick; 0 unless the body is dynamic | 0 |
//! | `mass` | kg | that of its colliders by their densities, or 1 |
//! | `inertia` | kg m² about the centre of mass | that of its colliders, scaled to its mass, or `mass` times 1 m² |
//! | `center` | the centre of mass, [x, y] in the body's axes from its origin, in m | that of its colliders; the origin if it has none, or mass and inertia are both given |
//! | `fixed_rotation` | whether forces do not turn it | false |
//! | `linear_damping`, `angular_damping` | rates of decay in 1/s; 0 unless the body is dynamic | 0 |
//! | `mu` | μ = G·M in m³/s² by which it pulls other bodies | 0 |
//! | `user_data` | a whole number | 0 |
//! | `allow_sleep` | whether it may fall asleep | true |
//! | `colliders` | a list of what of it collides | none |
//!
//! # Keys of a collider
//!
//! Exactly one of `box`, `polygon` and `circle`; sizes and places are in m, in the collider's axes.
//!
//! | key | value | default |
//! |---|---|---|
//! | `box` | [width, height], its full size, about the collider's origin | – |
//! | `polygon` | 3 to 8 vertices [x, y], strictly convex, either way round | – |
//! | `circle` | its radius, about the collider's origin | – |
//! | `offset` | where the collider's origin is, [x, y] in the body's axes from its origin | [0, 0] |
//! | `angle` | by how much it is turned against the body, radians in [0, 2π] | 0 |
//! | `density` | kg/m², for bodies whose mass, inertia or centre is not given | 1 |
//! | `restitution` | 0 … 1; of two colliders the larger counts | 0 |
//! | `friction` | the coefficient; of two colliders the geometric mean counts | 0.6 |
//! | `filter` | `{ "category", "mask" }`, 32 bits each as a whole number: two colliders meet if each has a category that the other's mask has | 1, all bits |
//! | `sensor` | whether it only reports what overlaps it: no contact, no mass | false |
//!
//! # Commands
//!
//! A command is carried out before the step of its tick, so `"tick": 0` acts on the first step; commands of one tick
//! in their order in the file. `do` holds one key, the command's name in the library ([`Command`](crate::Command)) in
//! lower case, with its values:
//! `create_body` (the keys of a body), `destroy_body`, `set_kind`, `set_position`, `set_angle`, `set_velocity`,
//! `set_angular_velocity`, `set_force`, `set_torque`, `set_mass` (`inertia`: left out, as for a body),
//! `set_fixed_rotation`, `set_damping`, `set_mu`, `set_user_data`, `apply_force`, `apply_torque`, `apply_impulse`
//! (`point` [x, y] in the world; the centre of mass if left out), `apply_angular_impulse`, `create_attractor`,
//! `set_attractor`, `destroy_attractor`, `set_gravity`, `set_surface` (`restitution`, `friction`), `set_filter`
//! (`category`, `mask`), `set_allow_sleep` (`allow`), `wake`, `put_to_sleep`, `clear_status`, `input` (`text`). A body is referred to by its name, or by its index in order of
//! creation; attractors likewise. `set_surface` and `set_filter` change the body's collider with the index `collider` in
//! its list, from 0; the first if that is left out.

mod collider;
mod error;
mod json;
mod number;
mod object;
mod script;
mod stage;

pub use error::SceneError;
pub use script::{Scene, Script};
pub use stage::Stage;
