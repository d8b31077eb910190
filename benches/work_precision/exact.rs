//! Cases with a known outcome: scenes, how long they run, and how far off they end.

use crate::reference;
use crate::scenes::{MILLI, ONE, Scene, exact};
use crate::stage::{Setting, Stage, Trial};
use std::f64::consts::{FRAC_PI_4, SQRT_2};

/// A case.
pub struct Case {
    /// Of its file and its line in tables.
    pub name: &'static str,
    /// Its title.
    pub title: &'static str,
    /// What its error is, with the unit.
    pub error: &'static str,
    pub scene: fn() -> Scene,
    pub seconds: f64,
    /// Runs it for so many ticks and says how far off it was.
    pub judge: fn(&mut dyn Trial, u64) -> f64,
}

impl Case {
    pub fn ticks(&self, setting: Setting) -> u64 {
        (self.seconds * f64::from(setting.rate)).round() as u64
    }

    /// How far off it ends with this setting.
    pub fn measure(&self, setting: Setting) -> f64 {
        (self.judge)(&mut Stage::new(&(self.scene)(), setting), self.ticks(setting))
    }
}

const G: f64 = 9.81;
const FAR: i64 = 1_000_000 * ONE;

/// All of them: motion, friction, impacts, rest.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { name: "throw", title: "throw, 1 s", error: "place, m", scene: exact::throw, seconds: 1.0, judge: throw },
    Case { name: "damped-throw", title: "throw with damping, 10 s", error: "place, m", scene: exact::damped_throw, seconds: 10.0, judge: damped_throw },
    Case { name: "orbit", title: "orbit, e = 0.6, 9.5 turns", error: "place, m (a = 10 m)", scene: exact::orbit, seconds: 60.0, judge: orbit },
    Case { name: "spin", title: "spin at 10 rad/s, 60 s", error: "angle, rad", scene: exact::spin, seconds: 60.0, judge: spin },
    Case { name: "drift-far", title: "drift of 10 m at 10⁶ m", error: "way, m", scene: || exact::drift(FAR), seconds: 10.0, judge: drift_far },
    Case { name: "topple", title: "box that topples, 0.6 s", error: "angle, rad", scene: exact::topple, seconds: 0.6, judge: topple },
    Case { name: "slide", title: "sliding stop from 3 m/s", error: "way, m (0.76 m)", scene: || exact::sliding_stop(0), seconds: 3.0, judge: slide },
    Case { name: "slide-far", title: "sliding stop at 10⁶ m", error: "way, m (0.76 m)", scene: || exact::sliding_stop(FAR), seconds: 3.0, judge: slide_far },
    Case { name: "incline", title: "sliding down a slope, 1 s", error: "way, m (1.8 m)", scene: exact::incline, seconds: 1.0, judge: incline },
    Case { name: "incline-roll", title: "rolling down a slope, 1 s", error: "way, m (2.0 m)", scene: exact::incline_roll, seconds: 1.0, judge: incline_roll },
    Case { name: "slide-to-roll", title: "disc that slides, then rolls, 2 s", error: "way, m (4.1 m)", scene: exact::slide_to_roll, seconds: 2.0, judge: slide_to_roll },
    Case { name: "incline-rest", title: "at rest on a slope, 10 s", error: "way, m", scene: exact::incline_rest, seconds: 10.0, judge: incline_rest },
    Case { name: "bounce-disc", title: "disc, C_R 0.8, five peaks", error: "height, part of e²ⁿ", scene: || exact::bounce(true, 800 * MILLI), seconds: 4.0, judge: bounce_disc },
    Case { name: "bounce-box", title: "box, C_R 0.5, three peaks", error: "height, part of e²ⁿ", scene: || exact::bounce(false, 500 * MILLI), seconds: 4.0, judge: bounce_box },
    Case { name: "head-on", title: "boxes 1 and 3 kg head-on, C_R 1", error: "speed, m/s", scene: exact::head_on, seconds: 3.0, judge: head_on },
    Case { name: "typical", title: "typical collision, C_R 0.8", error: "speed, m/s", scene: exact::typical, seconds: 3.0, judge: typical },
    Case { name: "one-hits-two", title: "one disc hits two, C_R 1", error: "speed, m/s", scene: exact::one_hits_two, seconds: 3.0, judge: one_hits_two },
    Case { name: "corner-on-bar", title: "corner on a bar, C_R 0.5", error: "speeds, m/s and rad/s", scene: exact::corner_on_bar, seconds: 0.5, judge: corner_on_bar },
    Case { name: "turning-corner", title: "corner of a box that turns", error: "speeds, m/s and rad/s", scene: exact::turning_corner, seconds: 1.0, judge: turning_corner },
    Case { name: "turning-time", title: "the same: when it meets", error: "time, s", scene: exact::turning_corner, seconds: 1.0, judge: turning_time },
    Case { name: "gas", title: "50 elastic polygons, 10 s", error: "energy, part", scene: || exact::gas(50), seconds: 10.0, judge: gas },
    Case { name: "stack", title: "stack of 10, 10 s", error: "sag, m", scene: || exact::stack(10, ONE), seconds: 10.0, judge: sag },
    Case { name: "heavy", title: "100 kg on 1 kg, 10 s", error: "sag, m", scene: || exact::stack(2, 100 * ONE), seconds: 10.0, judge: sag },
    Case { name: "seesaw", title: "see-saw, 0.6 s, against 64 substeps at 960/s", error: "place, m", scene: exact::seesaw, seconds: 0.6, judge: seesaw },
];

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The time that so many ticks take, in seconds.
fn seconds(stage: &dyn Trial, ticks: u64) -> f64 {
    ticks as f64 / stage.rate()
}

fn throw(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    let t = seconds(stage, ticks);
    apart(stage.state(0).at, [10.0 * t, 10.0 * t - 0.5 * G * t * t])
}

/// v' = g − c·v.
fn damped_throw(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    let (t, c) = (seconds(stage, ticks), 0.5f64);
    let part = -(-c * t).exp_m1() / c;
    apart(stage.state(0).at, [20.0 * part, (10.0 + G / c) * part - G / c * t])
}

fn orbit(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    apart(stage.state(0).at, reference::kepler(10.0, 0.6, 1000.0, seconds(stage, ticks)))
}

fn spin(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    (stage.state(0).angle - 10.0 * seconds(stage, ticks)).abs()
}

/// How far the last body went to the right.
fn way(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let last = stage.count() - 1;
    let from = stage.state(last).at[0];
    stage.run(ticks);
    stage.state(last).at[0] - from
}

fn drift_far(stage: &mut dyn Trial, ticks: u64) -> f64 {
    (way(stage, ticks) - 10.0).abs()
}

fn slide(stage: &mut dyn Trial, ticks: u64) -> f64 {
    (way(stage, ticks) - 9.0 / (2.0 * 0.6 * G)).abs()
}

fn slide_far(stage: &mut dyn Trial, ticks: u64) -> f64 {
    slide(stage, ticks)
}

/// How far the last body went down a slope of 3 in 4.
fn down(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let from = stage.state(1).at;
    stage.run(ticks);
    let to = stage.state(1).at;
    0.8 * (from[0] - to[0]) + 0.6 * (from[1] - to[1])
}

/// a = g·(sin − μ·cos).
fn incline(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let t = seconds(stage, ticks);
    (down(stage, ticks) - 0.5 * G * (0.6 - 0.3 * 0.8) * t * t).abs()
}

/// a = g·sin / (1 + ½).
fn incline_roll(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let t = seconds(stage, ticks);
    (down(stage, ticks) - 0.5 * G * 0.6 / 1.5 * t * t).abs()
}

fn incline_rest(stage: &mut dyn Trial, ticks: u64) -> f64 {
    down(stage, ticks).abs()
}

/// It slides until v = 2/3 v₀ and rolls from then on.
fn slide_to_roll(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let (t, a) = (seconds(stage, ticks), 0.6 * G);
    let slid = 3.0 / (3.0 * a);
    let want = 3.0 * slid - 0.5 * a * slid * slid + 2.0 * (t - slid);
    (way(stage, ticks) - want).abs()
}

/// The worst of some peaks above the floor, against e²ⁿ m. Each is the top of the parabola through three ticks.
fn bounce(stage: &mut dyn Trial, ticks: u64, e: f64, count: usize) -> f64 {
    let height = |stage: &dyn Trial| stage.state(1).at[1] - 0.25;
    let mut last = [height(stage); 3];
    let (mut peaks, mut rising) = (Vec::new(), false);
    for _ in 0..ticks {
        stage.run(1);
        last = [last[1], last[2], height(stage)];
        let [a, b, c] = last;
        if rising && c <= b {
            let (slope, bend) = ((c - a) / 2.0, a - 2.0 * b + c);
            peaks.push(if bend < 0.0 { b - slope * slope / (2.0 * bend) } else { b });
            rising = false;
        } else if c > b && b <= a {
            rising = true;
        }
    }
    let off = |n: usize| (peaks.get(n).unwrap_or(&0.0) / e.powi(2 * n as i32 + 2) - 1.0).abs();
    (0..count).map(off).fold(0.0, f64::max)
}

fn bounce_disc(stage: &mut dyn Trial, ticks: u64) -> f64 {
    bounce(stage, ticks, 0.8, 5)
}

fn bounce_box(stage: &mut dyn Trial, ticks: u64) -> f64 {
    bounce(stage, ticks, 0.5, 3)
}

/// The worst of speeds to the right, or spins.
fn speeds(stage: &mut dyn Trial, ticks: u64, want: &[f64]) -> f64 {
    stage.run(ticks);
    let off = |(at, want): (usize, &f64)| {
        let state = stage.state(at);
        (state.velocity[0] - want).abs().max(state.velocity[1].abs()).max(state.spin.abs())
    };
    want.iter().enumerate().map(off).fold(0.0, f64::max)
}

fn head_on(stage: &mut dyn Trial, ticks: u64) -> f64 {
    speeds(stage, ticks, &[-2.0, 0.0])
}

fn typical(stage: &mut dyn Trial, ticks: u64) -> f64 {
    speeds(stage, ticks, &[0.251, 2.259])
}

fn one_hits_two(stage: &mut dyn Trial, ticks: u64) -> f64 {
    speeds(stage, ticks, &[0.0, 0.0, 3.0])
}

/// IM:col2D with the corner straight below the middle: j acts on the bar 1 m from its middle, and does not turn the square.
fn corner_on_bar(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    let (square, bar) = (1.4 * 1.4, 4.0);
    let inertia = bar * (16.0 + 1.0) / 12.0;
    let j = 1.5 * 3.0 / (1.0 / square + 1.0 / bar + 1.0 / inertia);
    let (b, s) = (stage.state(0), stage.state(1));
    let off = [s.velocity[1] + 3.0 - j / square, s.spin, b.velocity[1] + j / bar, b.spin + j / inertia];
    off.into_iter().chain([s.velocity[0], b.velocity[0]]).map(f64::abs).fold(0.0, f64::max)
}

/// When, after the start, the corner that comes first is on the floor, and where it is from the middle then.
fn first_corner() -> (f64, [f64; 2]) {
    let meets = |k: u32| {
        let phase = f64::from(k) * 2.0 * FRAC_PI_4 + FRAC_PI_4;
        let height = move |t: f64| 2.0 - 2.0 * t + (phase + 4.0 * t).sin() / SQRT_2;
        let t = reference::first_root(height, 0.0, 1.0);
        (t, [(phase + 4.0 * t).cos() / SQRT_2, (phase + 4.0 * t).sin() / SQRT_2])
    };
    (0..4).map(meets).min_by(|a, b| a.0.total_cmp(&b.0)).expect("four corners")
}

/// IM:col2D at the corner that meets the floor first.
fn turning_corner(stage: &mut dyn Trial, _: u64) -> f64 {
    let (_, [x, _]) = first_corner();
    let before = |stage: &dyn Trial| stage.state(1).velocity[1] < -1.999_999 && stage.state(1).spin > 3.999_999;
    let most = seconds(stage, 1).recip() as u64;
    let mut ticks = 0;
    while before(stage) && ticks < most {
        stage.run(1);
        ticks += 1;
    }
    // Some engines bounce a tick after they have stopped what comes.
    stage.run(1);
    let inertia = 1.0 / 6.0;
    let j = 1.5 * (2.0 - 4.0 * x) / (1.0 + x * x / inertia);
    let state = stage.state(1);
    (state.velocity[1] + 2.0 - j).abs().max((state.spin - 4.0 - x * j / inertia).abs()).max(state.velocity[0].abs())
}

/// By what the world says of its first collision.
fn turning_time(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let (t, _) = first_corner();
    for tick in 0..ticks {
        stage.run(1);
        if let Some(meeting) = stage.meeting() {
            return (seconds(stage, tick) + meeting - t).abs();
        }
    }
    f64::NAN
}

/// Of kinetic energy, which the gas keeps.
fn gas(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let before = stage.kinetic();
    stage.run(ticks);
    (stage.kinetic() / before - 1.0).abs()
}

/// How far the top one sank.
fn sag(stage: &mut dyn Trial, ticks: u64) -> f64 {
    let top = stage.count() - 1;
    let from = stage.state(top).at[1];
    stage.run(ticks);
    (from - stage.state(top).at[1]).abs()
}

/// The box turns about a corner that does not slip, at the distance r from its middle: r²·(1 + 1/3)·φ'' = −g·x.
fn topple(stage: &mut dyn Trial, ticks: u64) -> f64 {
    stage.run(ticks);
    let r2 = 1.25f64;
    let start = [1.0f64.atan2(-0.5), -1.5];
    let bend = |phi: f64| -G * r2.sqrt() * phi.cos() / (r2 * 4.0 / 3.0);
    let turned = reference::integrate(start, bend, seconds(stage, ticks))[0] - start[0];
    (stage.state(1).angle - turned).abs()
}

/// Against the engine itself, as fine as it goes: there is no closed form.
fn seesaw(stage: &mut dyn Trial, ticks: u64) -> f64 {
    static FINE: std::sync::OnceLock<[[f64; 2]; 3]> = std::sync::OnceLock::new();
    let places = |stage: &dyn Trial| [1, 2, 3].map(|at| stage.state(at).at);
    let fine = FINE.get_or_init(|| {
        let mut fine = Stage::new(&exact::seesaw(), Setting { rate: 960, substeps: 64 });
        fine.run(576);
        places(&fine)
    });
    stage.run(ticks);
    places(stage).iter().zip(fine).map(|(a, b)| apart(*a, *b)).fold(0.0, f64::max)
}
