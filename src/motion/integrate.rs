//! The integrators: a scheme is a list of stages, and a tick carries it out.
//!
//! | scheme | one step of T | when |
//! |---|---|---|
//! | glide | x += v·T + ½·a·T², v += a·T, once a tick | [`Integrator::ForestRuth`], nothing attracts |
//! | Forest–Ruth | four kicks v += a(x)·wT between five drifts x += v·wT | [`Integrator::ForestRuth`] with attraction |
//! | Euler | v += a(x)·T, x += v·T in each substep | [`Integrator::SymplecticEuler`] |
//!
//! For constant acceleration the composed scheme *is* the glide, up to rounding, so a scene without attraction does it
//! in one. With attraction it is of fourth order and symplectic: an orbit's energy error stays bounded. It evaluates
//! a(x) four times a step, so four substeps make one step: at the same cost as a leapfrog over the substeps, an orbit of
//! eccentricity 0.6 with 600 ticks has its energy right to 6e-8 instead of 9e-6 (kick-first leapfrog: 5e-5). From an
//! eccentricity of 0.95 on, where the nearest point takes less than a tick, the leapfrog would be better; both want more
//! substeps there. It begins with a drift, so no acceleration is kept from tick to tick.
//!
//! Source: Omelyan, Mryglod, Folk, "Optimized Forest–Ruth- and Suzuki-like algorithms for integration of motion in
//! many-body systems", Computer Physics Communications 146 (2002), position-extended form.

use super::drive::{BOW_SHIFT, Damped, Drive};
use super::gravity;
use super::span::Span;
use crate::body::Bodies;
use crate::num::{Length, Quantity, add_sat, clamp_i64, mul, mul_add};
use crate::store::{Cells, Show, record_enum};
use crate::threads::Crew;
use core::fmt;
use core::ops::Range;
use serde::{Deserialize, Serialize};

/// How motion is integrated (LC:Variable-ODE-Solver).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Integrator {
    /// Exact for constant acceleration; fourth order and symplectic under attraction. The default.
    #[default]
    ForestRuth,
    /// First order, symplectic: what most game engines do, for comparison.
    SymplecticEuler,
}

record_enum!(Integrator { 0 => ForestRuth {}, 1 => SymplecticEuler {} } shown);

/// A part of an integrator's step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stage {
    /// The whole tick under constant acceleration and damping, exactly.
    Glide,
    /// Velocities by the accelerations at the present positions.
    Kick(Span),
    /// Positions by the present velocities.
    Drift(Span),
    /// Velocities by damping.
    Decay,
}

impl Show for Stage {
    fn show(&self, cells: &mut Cells<'_>) {
        let (tag, span) = match self {
            Stage::Glide => (0u8, None),
            Stage::Kick(span) => (1, Some(span)),
            Stage::Drift(span) => (2, Some(span)),
            Stage::Decay => (3, None),
        };
        cells.field("kind", |c| tag.show(c));
        cells.field("span", |c| span.show(c));
    }
}

/// The weights of the composed scheme, with 62 fraction bits: drifts ξ, χ, 1 − 2(χ + ξ), χ, ξ and between them kicks
/// (1 − 2λ)/2, λ, λ, (1 − 2λ)/2, where ξ = 0.1786178958448091, λ = −0.2123418310626054, χ = −0.06626458266981849.
/// The drifts add up to exactly 1, and so do the kicks.
const XI: i64 = 823_729_652_908_425_552;
const CHI: i64 = -305_591_449_415_327_722;
const LAMBDA: i64 = -979_253_853_438_687_736;

/// The stages of a step, how many steps a tick has, and the span of a glide or a decay as parts of a second.
pub(crate) fn stages(
    integrator: Integrator,
    tick_rate: u32,
    substeps: u32,
    attraction: bool,
) -> (Vec<Stage>, u32, u32) {
    const ONE: i64 = 1 << 62;
    const OUTER: i64 = ONE / 2 - LAMBDA;
    const MIDDLE: i64 = ONE - 2 * (CHI + XI);
    match integrator {
        Integrator::ForestRuth if !attraction => (vec![Stage::Glide], 1, tick_rate),
        Integrator::ForestRuth => {
            let steps = substeps.div_ceil(4);
            let per_second = tick_rate.saturating_mul(steps);
            let step = Span::new(per_second);
            let (drift, kick) = (|part| Stage::Drift(step.part(part)), |part| Stage::Kick(step.part(part)));
            let composed = vec![
                Stage::Decay,
                drift(XI),
                kick(OUTER),
                drift(CHI),
                kick(LAMBDA),
                drift(MIDDLE),
                kick(LAMBDA),
                drift(CHI),
                kick(OUTER),
                drift(XI),
                Stage::Decay,
            ];
            // Half of the damping on either side keeps the step symmetric.
            (composed, steps, per_second.saturating_mul(2))
        }
        Integrator::SymplecticEuler => {
            let per_second = tick_rate.saturating_mul(substeps);
            let step = Span::new(per_second);
            (vec![Stage::Kick(step), Stage::Decay, Stage::Drift(step)], substeps, per_second)
        }
    }
}

/// A bound that a step ran into; the value has been limited to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Bound {
    /// A position component at ±10⁹ m.
    Position,
    /// The count of whole turns at ±32 767; the orientation itself stays right.
    Turns,
    /// A velocity at ±32 768 m/s.
    Velocity,
    /// An angular velocity at ±32 768 rad/s.
    AngularVelocity,
    /// An acceleration at ±32 768 m/s² or rad/s².
    Acceleration,
    /// A speed in a substep with contacts: ±400·2^k m/s along an axis or at the rim of the body, or an eighth of a turn a
    /// substep.
    ContactSpeed,
    /// The impacts of a body in one tick at 256, or those of its world at 2048 and 8 a body: from then on nothing bounces off
    /// it in that tick.
    Impacts,
}

record_enum!(Bound { 0 => Position {}, 1 => Turns {}, 2 => Velocity {}, 3 => AngularVelocity {}, 4 => Acceleration {}, 5 => ContactSpeed {}, 6 => Impacts {} } shown);

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Bound::Position => "position",
            Bound::Turns => "count of turns",
            Bound::Velocity => "velocity",
            Bound::AngularVelocity => "angular velocity",
            Bound::Acceleration => "acceleration",
            Bound::ContactSpeed => "speed in contact",
            Bound::Impacts => "number of impacts in a tick",
        })
    }
}

impl Show for Fault {
    fn show(&self, cells: &mut Cells<'_>) {
        let Fault { slot, bound } = self;
        cells.field("slot", |c| (*slot as u32).show(c));
        cells.field("bound", |c| bound.show(c));
    }
}

/// Which body ran into which bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) slot: usize,
    pub(crate) bound: Bound,
}

/// So many bodies make a piece, 5 µs a column; and so many pairs of a body and what attracts it.
const SLOTS: usize = 4096;
const PULLS: usize = 256;

/// One tick of motion.
pub(crate) fn integrate(bodies: &mut Bodies, drive: &mut Drive, faults: &mut Vec<Fault>, crew: Crew) {
    faults.extend(drive.limited.iter().map(|&slot| Fault { slot: slot as usize, bound: Bound::Acceleration }));
    for _ in 0..drive.steps {
        for at in 0..drive.stages.len() {
            match drive.stages[at] {
                Stage::Glide => glide(bodies, drive, faults, crew),
                Stage::Kick(span) => {
                    kick(bodies, drive, faults, |acceleration| mul(acceleration, span.line, 63), crew);
                    attract(bodies, drive, span, faults, crew);
                }
                Stage::Drift(span) => {
                    for at in 0..bodies.rest.runs() {
                        let run = bodies.rest.run(at);
                        drift(bodies, drive, run, [span.line, span.turn], faults, crew);
                    }
                }
                Stage::Decay => decay(bodies, drive),
            }
        }
    }
}

/// The whole tick: positions with the bow of constant acceleration, then velocities. Damped bodies have spans of
/// their own.
fn glide(bodies: &mut Bodies, drive: &Drive, faults: &mut Vec<Fault>, crew: Crew) {
    let Span { line, turn } = drive.glide_span();
    // Of what sleeps nothing is damped.
    let mut damped = drive.damped.iter().peekable();
    for at in 0..bodies.rest.runs() {
        let Range { mut start, end } = bodies.rest.run(at);
        while let Some(damped) = damped.next_if(|damped| (damped.slot as usize) < end) {
            let slot = damped.slot as usize;
            let next = slot.saturating_add(1);
            drift(bodies, drive, start..slot, [line, turn], faults, crew);
            drift(bodies, drive, slot..next, [damped.line_span, damped.turn_span], faults, crew);
            start = next;
        }
        drift(bodies, drive, start..end, [line, turn], faults, crew);
    }
    decay(bodies, drive);
    kick(bodies, drive, faults, |change| change, crew);
}

/// The bodies of `run`, whose velocities act for `line` (seconds) and `turn` (seconds/2π), 63 fraction bits each.
fn drift(
    bodies: &mut Bodies,
    drive: &Drive,
    run: Range<usize>,
    [line, turn]: [i64; 2],
    faults: &mut Vec<Fault>,
    crew: Crew,
) {
    let Bodies { cold: _, rest: _, x, y, vx, vy, angle, omega } = bodies;
    let [bow_x, bow_y, bow_turn] = &drive.bow;
    // v with 48 fraction bits times T with 63, to the 32 of a position and the 48 of an angle.
    const TO_LENGTH: u32 = 48 + 63 - 32;
    const TO_ANGLE: u32 = 63;

    for (x, v, bow) in [(x, vx, bow_x), (y, vy, bow_y)] {
        let columns = (&mut x.bits_mut()[run.clone()], &v.bits()[run.clone()], &bow[run.clone()]);
        crew.gather((run.clone(), columns), SLOTS, faults, |(run, (x, v, bow)), faults| {
            for (slot, ((x, &v), &bow)) in run.zip(x.iter_mut().zip(v).zip(bow)) {
                let moved = x.saturating_add(mul_add(v, line, bow, BOW_SHIFT, TO_LENGTH));
                *x = moved.clamp(Length::MIN.to_bits(), Length::MAX.to_bits());
                if *x != moved {
                    faults.push(Fault { slot, bound: Bound::Position });
                }
            }
        });
    }
    let columns = (&mut angle.bits_mut()[run.clone()], &omega.bits()[run.clone()], &bow_turn[run.clone()]);
    crew.gather((run, columns), SLOTS, faults, |(run, (angle, w, bow)), faults| {
        for (slot, ((angle, &w), &bow)) in run.zip(angle.iter_mut().zip(w).zip(bow)) {
            let turned = turn_by(*angle, mul_add(w, turn, bow, BOW_SHIFT, TO_ANGLE));
            *angle = turned.0;
            if turned.1 {
                faults.push(Fault { slot, bound: Bound::Turns });
            }
        }
    });
}

/// An angle turned further. The fraction of a turn is always exact; the count of whole turns stops at ±32 767, and
/// whether it had to is the second value.
pub(crate) fn turn_by(angle: i64, by: i64) -> (i64, bool) {
    const TURN: i64 = 1 << 48;
    const LAST_TURN: i64 = i64::MAX - (TURN - 1);
    match angle.checked_add(by) {
        Some(sum) if sum != i64::MIN => (sum, false),
        _ => {
            // The fraction of the magnitude, so that opposite spins stay opposite.
            let sum = angle.wrapping_add(by);
            let magnitude = LAST_TURN | ((if by > 0 { sum } else { sum.wrapping_neg() }) & (TURN - 1));
            (if by > 0 { magnitude } else { magnitude.saturating_neg() }, true)
        }
    }
}

/// Damping of the bodies that have it.
fn decay(bodies: &mut Bodies, drive: &Drive) {
    for Damped { slot, line, turn, .. } in &drive.damped {
        let slot = *slot as usize;
        for (column, decay) in
            [(bodies.vx.bits_mut(), line), (bodies.vy.bits_mut(), line), (bodies.omega.bits_mut(), turn)]
        {
            column[slot] = decay.slow(column[slot]);
        }
    }
}

/// Velocities by what `change` makes of the prepared kicks.
#[inline]
fn kick(bodies: &mut Bodies, drive: &Drive, faults: &mut Vec<Fault>, change: impl Fn(i64) -> i64 + Sync, crew: Crew) {
    let Bodies { cold: _, rest, x: _, y: _, vx, vy, angle: _, omega } = bodies;
    let [kick_x, kick_y, kick_turn] = &drive.kick;
    for (velocity, kicks, bound) in [
        (vx.bits_mut(), kick_x, Bound::Velocity),
        (vy.bits_mut(), kick_y, Bound::Velocity),
        (omega.bits_mut(), kick_turn, Bound::AngularVelocity),
    ] {
        for run in rest.all_runs() {
            let columns = (&mut velocity[run.clone()], &kicks[run.clone()]);
            crew.gather((run, columns), SLOTS, faults, |(run, (velocity, kicks)), faults| {
                for (slot, (v, &by)) in run.zip(velocity.iter_mut().zip(kicks)) {
                    add(v, change(by), slot, bound, faults);
                }
            });
        }
    }
}

/// Velocities of dynamic bodies by attraction, at the bodies' present positions.
fn attract(bodies: &mut Bodies, drive: &mut Drive, span: Span, faults: &mut Vec<Fault>, crew: Crew) {
    if drive.sources.is_empty() {
        return;
    }
    drive.follow(bodies);
    let Bodies { cold, rest, x, y, vx, vy, angle: _, omega: _ } = bodies;
    let (x, y, vx, vy) = (x.bits(), y.bits(), vx.bits_mut(), vy.bits_mut());
    let least = PULLS.checked_div(drive.sources.len()).unwrap_or(0).max(1);
    for run in rest.all_runs() {
        let columns = (&mut vx[run.clone()], &mut vy[run.clone()]);
        crew.gather((run, columns), least, faults, |(run, (vx, vy)), faults| {
            for (slot, (vx, vy)) in run.zip(vx.iter_mut().zip(vy)).filter(|&(slot, _)| cold.value(slot).is_dynamic()) {
                let wide = gravity::pull(&drive.sources, slot, x[slot], y[slot]);
                let pull = wide.map(clamp_i64);
                if pull.map(i128::from) != wide {
                    faults.push(Fault { slot, bound: Bound::Acceleration });
                }
                add(vx, mul(pull[0], span.line, 63), slot, Bound::Velocity, faults);
                add(vy, mul(pull[1], span.line, 63), slot, Bound::Velocity, faults);
            }
        });
    }
}

/// `v += by`, limited to the format.
#[inline]
fn add(v: &mut i64, by: i64, slot: usize, bound: Bound, faults: &mut Vec<Fault>) {
    let (sum, wrapped) = v.overflowing_add(by);
    if wrapped || sum == i64::MIN {
        *v = add_sat(*v, by);
        faults.push(Fault { slot, bound });
    } else {
        *v = sum;
    }
}
