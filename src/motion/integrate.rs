//! The integrators: one tick of motion for all bodies, one function per scheme behind one signature.
//!
//! | scheme | one span T | when |
//! |---|---|---|
//! | exact | x += v·T + ½·a·T², v += a·T over the whole tick | [`Integrator::Verlet`], nothing attracts |
//! | leapfrog | x += v·T/2, v += a(x)·T, x += v·T/2 in each substep | [`Integrator::Verlet`] with attraction |
//! | Euler | v += a(x)·T, x += v·T in each substep | [`Integrator::SymplecticEuler`] |
//!
//! The leapfrog *is* the exact scheme when a is constant, so a scene without attraction does once per tick what would
//! give the same result, up to rounding, in substeps. It is symplectic: energy errors of an orbit stay bounded. The
//! form that drifts first needs one evaluation of a(x) per substep and keeps no acceleration from tick to tick.

use super::drive::{BOW_SHIFT, Damped, Drive};
use super::gravity;
use super::span::Span;
use crate::body::Bodies;
use crate::num::{Length, Quantity, add_sat, clamp_i64, mul, mul_add};
use crate::store::record_enum;
use core::fmt;
use core::ops::Range;
use serde::{Deserialize, Serialize};

/// How motion is integrated (LC:Variable-ODE-Solver).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Integrator {
    /// Second order, symplectic, exact for constant acceleration. The default.
    #[default]
    Verlet,
    /// First order, symplectic: what most game engines do, for comparison.
    SymplecticEuler,
}

record_enum!(Integrator { 0 => Verlet {}, 1 => SymplecticEuler {} });

/// The integrator as this world needs it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Scheme {
    #[default]
    Exact,
    Leapfrog {
        substeps: u32,
    },
    Euler {
        substeps: u32,
    },
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
}

record_enum!(Bound { 0 => Position {}, 1 => Turns {}, 2 => Velocity {}, 3 => AngularVelocity {}, 4 => Acceleration {} });

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Bound::Position => "position",
            Bound::Turns => "count of turns",
            Bound::Velocity => "velocity",
            Bound::AngularVelocity => "angular velocity",
            Bound::Acceleration => "acceleration",
        })
    }
}

/// Which body ran into which bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) slot: usize,
    pub(crate) bound: Bound,
}

/// One tick of motion.
pub(crate) fn integrate(bodies: &mut Bodies, drive: &mut Drive, faults: &mut Vec<Fault>) {
    faults.extend(drive.limited.iter().map(|&slot| Fault { slot: slot as usize, bound: Bound::Acceleration }));
    match drive.scheme {
        Scheme::Exact => {
            drift(bodies, drive, drive.span, faults);
            decay(bodies, drive);
            kick(bodies, drive, faults);
        }
        Scheme::Leapfrog { substeps } => {
            drift(bodies, drive, drive.half, faults);
            for substep in 1..=substeps {
                decay(bodies, drive);
                kick(bodies, drive, faults);
                attract(bodies, drive, faults);
                // The half drifts of neighbouring substeps are one.
                let last = substep == substeps;
                drift(bodies, drive, if last { drive.half } else { drive.span }, faults);
            }
        }
        Scheme::Euler { substeps } => {
            for _ in 0..substeps {
                decay(bodies, drive);
                kick(bodies, drive, faults);
                attract(bodies, drive, faults);
                drift(bodies, drive, drive.span, faults);
            }
        }
    }
}

/// Positions and angles by their velocities over `span`, and by the bow of constant acceleration in the exact scheme.
fn drift(bodies: &mut Bodies, drive: &Drive, span: Span, faults: &mut Vec<Fault>) {
    let exact = drive.scheme == Scheme::Exact;
    let mut start = 0;
    for damped in drive.damped.iter().filter(|_| exact) {
        let slot = damped.slot as usize;
        drift_run(bodies, drive, start..slot, span.line, span.turn, faults);
        drift_run(bodies, drive, slot..slot.saturating_add(1), damped.line_span, damped.turn_span, faults);
        start = slot.saturating_add(1);
    }
    drift_run(bodies, drive, start..bodies.x.len(), span.line, span.turn, faults);
}

/// The bodies of `run`, whose velocities act for `line` (seconds) and `turn` (seconds/2π), 63 fraction bits each.
fn drift_run(bodies: &mut Bodies, drive: &Drive, run: Range<usize>, line: i64, turn: i64, faults: &mut Vec<Fault>) {
    let Bodies { cold: _, x, y, vx, vy, angle, omega } = bodies;
    let [bow_x, bow_y, bow_turn] = &drive.bow;
    // v with 48 fraction bits times T with 63, to the 32 of a position and the 48 of an angle.
    const TO_LENGTH: u32 = 48 + 63 - 32;
    const TO_ANGLE: u32 = 63;

    for (x, v, bow) in [(x, vx, bow_x), (y, vy, bow_y)] {
        let columns = x.bits_mut()[run.clone()].iter_mut().zip(&v.bits()[run.clone()]).zip(&bow[run.clone()]);
        for (slot, ((x, &v), &bow)) in columns.enumerate() {
            let moved = x.saturating_add(mul_add(v, line, bow, BOW_SHIFT, TO_LENGTH));
            *x = moved.clamp(Length::MIN.to_bits(), Length::MAX.to_bits());
            if *x != moved {
                faults.push(Fault { slot: run.start.saturating_add(slot), bound: Bound::Position });
            }
        }
    }
    let columns = angle.bits_mut()[run.clone()].iter_mut().zip(&omega.bits()[run.clone()]).zip(&bow_turn[run.clone()]);
    for (slot, ((angle, &w), &bow)) in columns.enumerate() {
        let turned = turn_by(*angle, mul_add(w, turn, bow, BOW_SHIFT, TO_ANGLE));
        *angle = turned.0;
        if turned.1 {
            faults.push(Fault { slot: run.start.saturating_add(slot), bound: Bound::Turns });
        }
    }
}

/// An angle turned further. The fraction of a turn is always exact; the count of whole turns stops at ±32 767, and
/// whether it had to is the second value.
fn turn_by(angle: i64, by: i64) -> (i64, bool) {
    const TURN: i64 = 1 << 48;
    match angle.checked_add(by) {
        Some(sum) if sum != i64::MIN => (sum, false),
        _ => {
            let fraction = angle.wrapping_add(by) & (TURN - 1);
            // The last turn that the format holds on either side.
            let whole = if by > 0 { i64::MAX - (TURN - 1) } else { -i64::MAX - 1 + TURN };
            (whole.saturating_add(fraction), true)
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

/// Velocities by constant acceleration.
fn kick(bodies: &mut Bodies, drive: &Drive, faults: &mut Vec<Fault>) {
    let Bodies { cold: _, x: _, y: _, vx, vy, angle: _, omega } = bodies;
    let [kick_x, kick_y, kick_turn] = &drive.kick;
    for (velocity, kicks, bound) in [
        (vx.bits_mut(), kick_x, Bound::Velocity),
        (vy.bits_mut(), kick_y, Bound::Velocity),
        (omega.bits_mut(), kick_turn, Bound::AngularVelocity),
    ] {
        for (slot, (v, &by)) in velocity.iter_mut().zip(kicks).enumerate() {
            add(v, by, slot, bound, faults);
        }
    }
}

/// Velocities of dynamic bodies by attraction, at the bodies' present positions.
fn attract(bodies: &mut Bodies, drive: &mut Drive, faults: &mut Vec<Fault>) {
    drive.follow(bodies);
    let Bodies { cold, x, y, vx, vy, angle: _, omega: _ } = bodies;
    let (x, y, vx, vy) = (x.bits(), y.bits(), vx.bits_mut(), vy.bits_mut());
    for (slot, _) in cold.iter().filter(|(_, data)| data.is_dynamic()) {
        let wide = gravity::pull(&drive.sources, slot, x[slot], y[slot]);
        let pull = wide.map(clamp_i64);
        if pull.map(i128::from) != wide {
            faults.push(Fault { slot, bound: Bound::Acceleration });
        }
        add(&mut vx[slot], mul(pull[0], drive.span.line, 63), slot, Bound::Velocity, faults);
        add(&mut vy[slot], mul(pull[1], drive.span.line, 63), slot, Bound::Velocity, faults);
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
