//! `tamias2d run`

use super::table::{Columns, Format, Table};
use super::{Failure, progress, read_scene, say};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use tamias2d::replay::Recorder;
use tamias2d::scene::{Scene, Script, Stage};
use tamias2d::{StatusEntry, World};

/// Run a scene and print where its bodies are.
///
/// One row per body and tick, from tick 0 on: tick, time in s, body (its name, or its index), x and y in m, angle in
/// radians in [0, 2π), turns (the unwrapped angle), vx and vy in m/s, omega in rad/s. x, y, turns, vx, vy and omega
/// are printed exactly, with all their digits; time and angle to 15 decimals. With sleeping there is a last column, asleep.
///
/// With --events instead one row per event, in the order of the engine: tick (after its step), event (contact_begin,
/// contact_end, sensor_begin, sensor_end), and the two colliders, each as its body and its index in that body's list,
/// from 0. A body that was destroyed is still named; what it touched ends in the step after.
///
/// With --collisions one row per collision that was answered at its time: tick (after its step), time of the collision in s,
/// order (collisions with one number were answered together), both colliders, the point, the normal from b to a, and the
/// impulse on a in N s. What rests has none.
#[derive(clap::Args)]
#[command(after_long_help = "\
A scene:
  { \"name\": \"tc2\", \"tick_rate\": 60, \"gravity\": [0, -9.8],
    \"bodies\": [
      { \"name\": \"left\", \"position\": [20, 20], \"velocity\": [0, 5], \"mass\": 10, \"inertia\": 15,
        \"colliders\": [ { \"box\": [2, 1], \"restitution\": 0.5 } ] },
      { \"name\": \"floor\", \"kind\": \"static\", \"colliders\": [ { \"box\": [100, 2], \"friction\": 0.8 } ] } ],
    \"attractors\": [ { \"position\": [0, 0], \"mu\": 1000 } ],
    \"commands\": [
      { \"tick\": 30, \"do\": { \"apply_impulse\": { \"body\": \"left\", \"impulse\": [0, 5] } } } ] }

Only name, tick_rate and bodies are needed; other keys are refused. SI units, angles in radians;
in brackets what is accepted, and after = what stands for a key that is left out, else 0 or none.
  scene      name, tick_rate (15 to 1000 ticks per second), bodies, substeps (1 to 64) = 10,
             integrator (forest_ruth, symplectic_euler) = forest_ruth, gravity,
             unit_shift (k, 0 to 10: contacts are solved in units of 2^k m, about 6 for pixels),
             sleeping (true, or { speed, time }: what is slower for so long falls asleep; true is
             0.05 m/s and 0.5 s) = false, attractors, commands,
             ticks (length of a recording; `run` goes by --ticks) = 600, about
  body       name = its index, kind (dynamic, kinematic, static) = dynamic, position,
             angle (0 to 2π), velocity, angular_velocity, force, torque, mass = by its colliders'
             densities, or 1, inertia = by its colliders, or mass times 1 m², center (of mass) = of
             its colliders, fixed_rotation = false, linear_damping, angular_damping (0 to 1000 1/s),
             mu (G M, m³/s²), user_data, allow_sleep = true, colliders
  collider   one of box ([width, height]), polygon (3 to 8 vertices, convex) and circle (radius);
             offset, angle, density (kg/m²) = 1, restitution (0 to 1), friction (0 to 100) = 0.6,
             filter (category = 1, mask = all bits), sensor (true: it only reports overlaps)
  attractor  name, position, mu (m³/s²)

Commands, before the step of their tick (none where the run ends sooner); \"body\" and \"attractor\"
are a name or an index:
  create_body (a body), destroy_body, set_kind, set_position, set_angle, set_velocity,
  set_angular_velocity, set_force, set_torque, set_mass (mass, inertia), set_fixed_rotation
  (fixed), set_damping (linear, angular), set_mu, set_user_data, apply_force (force, point),
  apply_torque, apply_impulse (impulse, point), apply_angular_impulse (impulse),
  create_attractor (an attractor), set_attractor, destroy_attractor, set_gravity,
  set_surface (collider, restitution, friction) and set_filter (collider, category, mask), where
  collider is an index in the body's list, the first if left out; set_allow_sleep (allow),
  wake, put_to_sleep, clear_status, input (text)")]
pub(crate) struct Run {
    /// The scene, a JSON file; - is standard input. See `tamias2d scenes` for examples
    scene: String,
    /// How many ticks to run
    #[arg(long, value_name = "N")]
    ticks: u64,
    /// Print every K-th tick only
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    every: u64,
    /// Print what begins and ends to touch instead of where bodies are
    #[arg(long, conflicts_with = "every")]
    events: bool,
    /// Print what collides, and when, instead of where bodies are
    #[arg(long, conflicts_with_all = ["every", "events"])]
    collisions: bool,
    /// How to print
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
    /// Record a replay into this file
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
}

impl Run {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let scene = read_scene(&self.scene)?;
        let (world, script) = scene.start().map_err(|error| Failure::usage(format_args!("{}: {error}", self.scene)))?;
        let Some(path) = &self.record else { return self.steps(script, world).map(drop) };
        let shown = path.display();
        let failed = |error| Failure::failed(format_args!("{shown}: {error}"));
        // Creating the file would empty the scene before anybody noticed.
        if let (Ok(scene), Ok(replay)) = (std::fs::canonicalize(&self.scene), std::fs::canonicalize(path)) {
            if scene == replay {
                return Err(Failure::usage(format_args!("{shown}: is the scene itself")));
            }
        }
        let file = File::create(path).map_err(|error| Failure::usage(format_args!("{shown}: {error}")))?;
        let recorder = Recorder::new(world, BufWriter::new(file)).map_err(failed)?;
        let recorder = self.steps(script, recorder).map_err(|failure| match failure.status {
            0 => Failure::failed(format_args!("{shown}: cut off, because the output was closed")),
            _ => failure,
        })?;
        recorder.finish().map_err(failed)?;
        Ok(())
    }

    fn steps<S: Stage>(&self, mut script: Script<'_>, mut stage: S) -> Result<S, Failure> {
        let out = BufWriter::new(std::io::stdout().lock());
        let columns = match (self.events, self.collisions) {
            (true, _) => Columns::Events,
            (_, true) => Columns::Collisions,
            _ => Columns::Bodies { sleeping: stage.world().config().sleeping.is_some() },
        };
        let mut table = Table::new(out, self.format, columns, stage.world().config().tick_rate)?;
        let bar = progress(self.ticks, "ticks");
        for tick in 0..=self.ticks {
            if tick > 0 {
                let error = |error| Failure::failed(format_args!("{}: tick {}: {error}", self.scene, tick - 1));
                script.apply(tick - 1, &mut stage).map_err(error)?;
                stage.step();
            }
            if self.events {
                for event in stage.world().events() {
                    table.event(tick, event, &script)?;
                }
            } else if self.collisions {
                for collision in stage.world().collisions() {
                    table.collision(tick, collision, &script)?;
                }
            } else if tick % self.every == 0 {
                for body in stage.world().bodies() {
                    table.row(tick, script.label(body.id()), &body)?;
                }
            }
            if tick % 1024 == 0 {
                bar.set_position(tick);
            }
        }
        bar.finish_and_clear();
        table.finish()?;
        report_status(&self.scene, stage.world(), &script);
        Ok(stage)
    }
}

/// Says on stderr what went out of range: the run is good, but the numbers hit a bound.
fn report_status(scene: &str, world: &World, script: &Script<'_>) {
    for StatusEntry { tick, body, bound } in world.status().entries() {
        let body = script.label(*body);
        say(&format!("{scene}: tick {tick}: body {body} was limited in its {bound}"));
    }
}

/// Records a scene for its own number of ticks; `each` sees the world at tick 0 and after each tick.
pub(crate) fn record_scene<W: Write>(
    scene: &Scene,
    out: W,
    mut each: impl FnMut(&World, &Script<'_>),
) -> Result<W, Failure> {
    let name = scene.name();
    let failed = |error: &dyn std::fmt::Display| Failure::failed(format_args!("{name}: {error}"));
    let (world, mut script) = scene.start().map_err(|error| failed(&error))?;
    let mut recorder = Recorder::new(world, out).map_err(|error| failed(&error))?;
    each(recorder.world(), &script);
    for tick in 0..scene.ticks() {
        script.apply(tick, &mut recorder).map_err(|error| failed(&error))?;
        recorder.step();
        each(recorder.world(), &script);
    }
    recorder.finish().map_err(|error| failed(&error))
}
