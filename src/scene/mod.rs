//! Scenes as JSON: worlds and scripted commands for people without Rust. Feature `scene`.
//!
//! Every number is taken from its decimal digits, exactly, and rounded once to its quantity's format; none goes
//! through a float. Unknown keys are refused, and every error names its place.
//!
//! ```json
//! { "name": "tc2", "gravity": [0, 0], "tick_rate": 60, "substeps": 4,
//!   "bodies": [ { "name": "left", "kind": "dynamic", "position": [20, 20], "angle": 0, "velocity": [0, 0],
//!                 "angular_velocity": 0, "force": [100, 0], "torque": 0, "mass": 10, "inertia": 15, "colliders": [] } ],
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
//! | `substeps` | steps per tick of motion that is not exact in one, 1 … 64; four make one fourth-order step | 4 |
//! | `integrator` | `"forest_ruth"` or `"symplectic_euler"` | `"forest_ruth"` |
//! | `gravity` | [x, y] in m/s² | [0, 0] |
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
//! | `mass` | kg | 1 |
//! | `inertia` | kg m² about the centre of mass | `mass` times 1 m² |
//! | `fixed_rotation` | whether forces do not turn it | false |
//! | `linear_damping`, `angular_damping` | rates of decay in 1/s; 0 unless the body is dynamic | 0 |
//! | `mu` | μ = G·M in m³/s² by which it pulls other bodies | 0 |
//! | `user_data` | a whole number | 0 |
//! | `colliders` | a list; this version accepts an empty one only | none |
//!
//! # Commands
//!
//! A command is carried out before the step of its tick, so `"tick": 0` acts on the first step; commands of one tick
//! in their order in the file. `do` holds one key, the command's name in the library ([`Command`](crate::Command)) in
//! lower case, with its values:
//! `create_body` (the keys of a body), `destroy_body`, `set_kind`, `set_position`, `set_angle`, `set_velocity`,
//! `set_angular_velocity`, `set_force`, `set_torque`, `set_mass` (`inertia` as for a body), `set_fixed_rotation`,
//! `set_damping`, `set_mu`, `set_user_data`, `apply_force`, `apply_torque`, `apply_impulse` (`point` [x, y] in the
//! world; the centre of mass if left out), `apply_angular_impulse`, `create_attractor`, `set_attractor`,
//! `destroy_attractor`, `set_gravity`, `clear_status`, `input` (`text`). A body is referred to by its name, or by its
//! index in order of creation; attractors likewise.

mod error;
mod json;
mod number;
mod object;
mod script;

pub use error::SceneError;
pub use script::{Scene, Script};
