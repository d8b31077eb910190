//! The constants of a world's contact solver.

use crate::contact::Margins;
use crate::num::{TURN_PER_RADIAN_Q64, div, round_shift};

/// Softness: a contact is a spring and damper of this frequency, as a part of the substep rate, and of this damping
/// ratio; then nothing depends on the rate. Of it follow, with x = 2π·c and a = 2ζ + x:
/// bias = x/a, mass scale = x·a/(1 + x·a), impulse scale = 1/(1 + x·a). 30 fraction bits each.
///
/// Source: Catto, "Solver2D" (2024), soft constraints with relaxation. The compliance is what damps the errors that sweeps
/// leave over: with c = 3/16 and a sweep after every fourth substep that takes back the pushes, a pyramid of 40 rows
/// walks; with 3/20 and every fifth it stands, at the same cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness {
    pub(crate) bias: i64,
    pub(crate) mass: i32,
    pub(crate) impulse: i32,
}

/// c = 3/20, ζ = 10: with the default of 600 substeps per second contacts have 90 Hz.
const SOFT: Softness = Softness { bias: 48_321_781, mass: 1_021_964_838, impulse: 51_776_986 };

/// The bound of a body's speed in substeps with contacts, lanes' metres per second.
pub(crate) const SPEED_MAX: i64 = 400;
/// The overlap that is left alone: 0.1 mm, 26 fraction bits.
pub(crate) const SLOP: i32 = 6711;
/// The speed with which overlaps are pushed apart at most: 1 m/s, 20 fraction bits.
const PUSH: i64 = 1 << 20;
/// The distance at which contacts are looked for: 2 cm, 32 fraction bits.
const MARGIN: i64 = 85_899_346;

/// What a world's configuration makes of them. Lanes hold metres and metres per second over 2^k.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scales {
    /// k, 0 … 10.
    pub(crate) shift: u32,
    pub(crate) substeps: u32,
    /// Substeps per second, at most 64 000.
    pub(crate) rate: i64,
    /// A substep h in seconds, 63 fraction bits, and h/2π.
    pub(crate) line: i64,
    pub(crate) turn: i64,
    /// h with 30 fraction bits, for the positions that rows read.
    pub(crate) coarse: i32,
    /// 1/h and bias/h in 1/s, 14 fraction bits.
    pub(crate) close_rate: i32,
    pub(crate) push_rate: i32,
    /// The bias of overlaps at most, Q20.
    pub(crate) push: i64,
    pub(crate) soft: [i32; 2],
    pub(crate) margins: Margins,
}

impl Scales {
    pub(crate) fn new(tick_rate: u32, substeps: u32, shift: u32) -> Scales {
        let rate = i64::from(tick_rate).saturating_mul(substeps.into());
        Scales {
            shift,
            substeps,
            rate,
            line: div(1 << 63, rate.into()) as i64,
            turn: div(TURN_PER_RADIAN_Q64, i128::from(rate).saturating_mul(2)) as i64,
            coarse: div(1 << 30, rate.into()) as i32,
            close_rate: (rate << 14) as i32,
            push_rate: round_shift(i128::from(SOFT.bias).saturating_mul(rate.into()), 16) as i32,
            push: -PUSH,
            soft: [SOFT.mass, SOFT.impulse],
            margins: Margins { base: MARGIN << shift, tick: div(1 << 63, tick_rate.into()) as i64 },
        }
    }
}
