//! Runs of other engines, as they were written down.

use crate::scenes::{Kind, Scene};
use crate::stage::{Setting, Stage, State, Trial};
use serde_json::Value;
use tamias2d::{Inertia, Mass};

/// The states of a run at some of its ticks, looked at one after the other.
pub struct Trace {
    /// Tick, and the state of every body of the scene.
    rows: Vec<(u64, Vec<State>)>,
    now: usize,
    /// Mass and moment of inertia; 0 unless a body is dynamic.
    masses: Vec<[f64; 2]>,
}

/// A number; what an engine had none for is NaN.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn masses(scene: &Scene) -> Vec<[f64; 2]> {
    let stage = Stage::new(scene, Setting::default());
    let of = |at: usize| {
        let def = stage.world.body(stage.ids[at]).expect("scenes keep their bodies").def();
        let inertia = def.inertia.map_or(0.0, Inertia::to_f64);
        if stage.mass(at) > 0.0 { [def.mass.map_or(0.0, Mass::to_f64), inertia] } else { [0.0, 0.0] }
    };
    (0..scene.things.len()).map(of).collect()
}

impl Trace {
    /// `None` where the line has no samples.
    pub fn new(scene: &Scene, line: &Value) -> Option<Trace> {
        let start = Stage::new(scene, Setting::default());
        let mut last: Vec<State> = (0..scene.things.len()).map(|at| start.state(at)).collect();
        let mut rows = Vec::new();
        for sample in line["samples"].as_array()? {
            let moving = scene.things.iter().enumerate().filter(|(_, thing)| thing.kind == Kind::Dynamic);
            for ((at, _), row) in moving.zip(sample[1].as_array()?) {
                let [x, y, angle, vx, vy, spin] = [0, 1, 2, 3, 4, 5].map(|k| number(&row[k]));
                // Some engines give angles without their whole turns: the nearest to the last one is taken.
                let turns = ((last[at].angle - angle) / std::f64::consts::TAU).round();
                let angle = angle + turns * std::f64::consts::TAU;
                last[at] = State { at: [x, y], angle, velocity: [vx, vy], spin };
            }
            let tick = sample[0].as_u64()?;
            // What only its own velocities move is where they bring it.
            let t = tick as f64 / 60.0;
            for (at, _) in scene.things.iter().enumerate().filter(|(_, thing)| thing.kind == Kind::Kinematic) {
                let State { at: [x, y], angle, velocity: [vx, vy], spin } = start.state(at);
                let place = [x + vx * t, y + vy * t];
                last[at] = State { at: place, angle: angle + spin * t, ..start.state(at) };
            }
            rows.push((tick, last.clone()));
        }
        Some(Trace { rows, now: 0, masses: masses(scene) })
    }

    /// All states at the start, in the middle and at the end.
    pub fn thirds(&self) -> [&[State]; 3] {
        [0, self.rows.len() / 2, self.rows.len() - 1].map(|at| self.rows[at].1.as_slice())
    }

    /// KE + PE of states under a gravity straight down, in J, and the weight of all on earth in N.
    pub fn energy(&self, states: &[State], gravity: f64) -> [f64; 2] {
        let of = |(state, [mass, inertia]): (&State, &[f64; 2])| {
            let [vx, vy] = state.velocity;
            let potential = if *mass > 0.0 { mass * gravity * state.at[1] } else { 0.0 };
            0.5 * (mass * (vx * vx + vy * vy) + inertia * state.spin * state.spin) + potential
        };
        let weight = self.masses.iter().map(|[mass, _]| mass * 9.81).sum();
        [states.iter().zip(&self.masses).map(of).sum(), weight]
    }
}

impl Trial for Trace {
    fn run(&mut self, ticks: u64) {
        let to = self.rows[self.now].0 + ticks;
        while self.now + 1 < self.rows.len() && self.rows[self.now].0 < to {
            self.now += 1;
        }
    }

    fn state(&self, at: usize) -> State {
        self.rows[self.now].1[at]
    }

    fn count(&self) -> usize {
        self.masses.len()
    }

    fn rate(&self) -> f64 {
        60.0
    }

    fn kinetic(&self) -> f64 {
        self.energy(&self.rows[self.now].1, 0.0)[0]
    }

    fn meeting(&self) -> Option<f64> {
        None
    }
}
