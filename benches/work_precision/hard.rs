//! The hard cases: what became of each.

use crate::clock::time;
use crate::scenes::hard::{Case, Should, all};
use crate::scenes::{G, Kind, ONE};
use crate::stage::{Setting, Stage, State, Trial};
use crate::yardstick::worst_overlap;
use std::fmt::Write;

/// What became of a case. Lengths in metres, speeds in m/s.
pub struct Outcome {
    pub name: &'static str,
    pub what: &'static str,
    pub survived: bool,
    /// Whether it should stand: else ways have no meaning.
    pub stands: bool,
    pub ways: Ways,
    /// The greatest rise of KE + PE above its least so far, as the height to which it would lift everything on earth; `None`
    /// where something is driven.
    pub gain: Option<f64>,
    /// Whether the same scene elsewhere gave the same bits; `None` if that was not looked at.
    pub same: Option<bool>,
    /// What the world's status names.
    pub status: String,
    /// Microseconds a tick.
    pub tick: f64,
}

/// KE + PE since the start, in J.
struct Energy {
    masses: Vec<f64>,
    gravity: [f64; 2],
    start: Vec<State>,
}

impl Energy {
    fn new(stage: &Stage, case: &Case) -> Energy {
        let places = 0..stage.ids.len();
        let gravity = case.scene.gravity.map(|g| g as f64 / ONE as f64);
        let masses = places.clone().map(|at| stage.mass(at)).collect();
        Energy { masses, gravity, start: places.map(|at| stage.state(at)).collect() }
    }

    fn of(&self, stage: &Stage) -> f64 {
        let fallen = |at: usize| {
            let ([x, y], [x0, y0], [gx, gy]) = (stage.state(at).at, self.start[at].at, self.gravity);
            -self.masses[at] * (gx * (x - x0) + gy * (y - y0))
        };
        let potential: f64 = (0..self.masses.len()).filter(|&at| self.masses[at] > 0.0).map(fallen).sum();
        stage.kinetic() + potential
    }

    /// The weight of all on earth, in N.
    fn weight(&self) -> f64 {
        self.masses.iter().sum::<f64>() * G as f64 / ONE as f64
    }
}

/// Whether two worlds are alike but for where their origin is.
fn alike(a: &Stage, b: &Stage, moved: i64) -> bool {
    let by = moved << 32;
    a.ids.iter().zip(&b.ids).all(|(&a_id, &b_id)| {
        let (p, q) = (a.world.body(a_id).expect("kept"), b.world.body(b_id).expect("kept"));
        p.position().x.to_bits() + by == q.position().x.to_bits()
            && p.position().y == q.position().y
            && p.angle() == q.angle()
            && p.velocity() == q.velocity()
            && p.angular_velocity() == q.angular_velocity()
    })
}

/// Whether the same scene gives the same bits, looked at in every tick.
fn same_elsewhere(case: &Case) -> Option<bool> {
    let mut here = Stage::new(&case.scene, Setting::default());
    let moved = |&by: &i64| (by, Stage::new(&case.scene.clone().moved(by * ONE), Setting::default()));
    let mut there: Vec<(i64, Stage)> = case.moved.iter().map(moved).collect();
    for _ in 0..case.ticks {
        here.run(1);
        for (by, stage) in &mut there {
            stage.run(1);
            if !alike(&here, stage, *by) {
                return Some(false);
            }
        }
    }
    (!there.is_empty()).then_some(true)
}

/// What of an outcome follows from where bodies were at the start, in the middle and at the end.
pub struct Ways {
    /// The greatest way sideways of a body from where it began, and down.
    pub drift: f64,
    pub sag: f64,
    /// The greatest way of a body in the second half.
    pub creep: f64,
    pub overlap: f64,
    /// The fastest body at the end, turning counted as m/s at half a metre.
    pub speed: f64,
    /// Whether all are where they should be.
    pub right: bool,
}

impl Ways {
    pub fn new(case: &Case, start: &[State], half: &[State], end: &[State]) -> Ways {
        let metre = |micro: i64| micro as f64 / ONE as f64;
        let far = |a: &State, b: &State| (a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1]);
        let places = || case.scene.things.iter().enumerate().filter(|(_, t)| t.kind == Kind::Dynamic).map(|(at, _)| at);
        let heights = || places().map(|at| start[at].at[1]);
        let tall = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
        let right = |at: usize| {
            let (from, to) = (&start[at], &end[at]);
            match case.should {
                Should::Stand(within) => {
                    let (side, sag) = ((to.at[0] - from.at[0]).abs(), (to.at[1] - from.at[1]).abs());
                    side < metre(within) && sag < metre(within).max(0.1 * tall)
                }
                Should::StayIn(low, high) => (0..2).all(|i| metre(low[i]) <= to.at[i] && to.at[i] <= metre(high[i])),
                Should::Topple => to.angle - from.angle < -1.0,
                Should::NotGain => true,
            }
        };
        let most = |of: &dyn Fn(usize) -> f64| places().map(of).fold(0.0, f64::max);
        Ways {
            drift: most(&|at| (end[at].at[0] - start[at].at[0]).abs()),
            sag: most(&|at| start[at].at[1] - end[at].at[1]),
            creep: most(&|at| far(&half[at], &end[at])),
            overlap: worst_overlap(&case.scene, end),
            speed: most(&|at| {
                let State { velocity: [x, y], spin, .. } = end[at];
                x.hypot(y).max(spin.abs() / 2.0)
            }),
            right: places().all(right),
        }
    }
}

fn states(stage: &Stage) -> Vec<State> {
    (0..stage.count()).map(|at| stage.state(at)).collect()
}

fn run(case: &Case) -> Outcome {
    let mut stage = Stage::new(&case.scene, Setting::default());
    let energy = Energy::new(&stage, case);
    let driven = case.scene.things.iter().any(|thing| thing.kind == Kind::Kinematic);
    let (mut least, mut gain, mut spent, mut half) = (energy.of(&stage), 0.0f64, 0.0, Vec::new());
    // Energy is looked at in every tick of short runs.
    let stride = case.ticks.div_ceil(4000);
    for k in 0..case.ticks / stride {
        if k == case.ticks / stride / 2 {
            half = states(&stage);
        }
        spent += time(|| stage.run(stride));
        let now = energy.of(&stage);
        gain = gain.max(now - least);
        least = least.min(now);
    }
    let ways = Ways::new(case, &energy.start, &half, &states(&stage));
    let gain = gain / energy.weight();
    let entries: Vec<String> = stage.world.status().entries().iter().map(|e| e.bound.to_string()).collect();
    Outcome {
        name: case.name,
        what: case.what,
        survived: ways.right && (!matches!(case.should, Should::NotGain) || gain < 1e-3),
        stands: matches!(case.should, Should::Stand(_)),
        ways,
        gain: (!driven).then_some(gain),
        same: same_elsewhere(case),
        status: entries.join(", "),
        tick: spent * 1e-3 / (case.ticks / stride * stride) as f64,
    }
}

/// Runs all of them.
pub fn measure() -> Vec<Outcome> {
    let report = |case: &Case| {
        let outcome = run(case);
        eprintln!(
            "{}: {} ({:.0} µs a tick)",
            case.name,
            if outcome.survived { "survived" } else { "FAILED" },
            outcome.tick
        );
        outcome
    };
    all().iter().map(report).collect()
}

/// As a table of comma-separated values.
pub fn csv(outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "case,what,survived,drift_m,sag_m,creep_in_2nd_half_m,overlap_m,end_speed_m_per_s,energy_gain_m_of_height,same_bits_elsewhere,status,us_per_tick\n",
    );
    for o in outcomes {
        let [drift, sag, creep] =
            [o.ways.drift, o.ways.sag, o.ways.creep].map(|v| if o.stands { format!("{v:.3e}") } else { String::new() });
        let same = o.same.map_or(String::new(), |same| same.to_string());
        let gain = o.gain.map_or(String::new(), |gain| format!("{gain:.3e}"));
        let _ = writeln!(
            text,
            "{},\"{}\",{},{drift},{sag},{creep},{:.3e},{:.3e},{gain},{same},\"{}\",{:.2}",
            o.name, o.what, o.survived, o.ways.overlap, o.ways.speed, o.status, o.tick
        );
    }
    text
}
