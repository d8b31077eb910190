//! The constants of a world's contact solver.

use crate::contact::Margins;
use crate::num::{TURN_PER_RADIAN_Q64, Time, clamp_i64, div, mul, round_shift};

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
/// The overlap from which on a contact is four times as stiff: 1/512 m, 26 fraction bits.
///
/// A soft row yields by its load over its own bodies' mass, so a light body under a pile would sink by centimetres. Eight
/// times as stiff, a stack with a heavy top rings; stiff without end, heaps quake and 1000 kg sink through 1 kg.
const FIRM: i64 = 1 << 17;
/// The load from which on a contact is heavy, as the change of speed by which its impulse of one substep drives its bodies
/// apart: 1 m/s, 48 fraction bits. For a box at rest on the ground that is 0.016 m/s. What is stiffer must be heavy: with
/// 2 m/s, 100 kg on 1 kg never come to rest, and on three boxes of 1 kg they walk.
const HEAVY: i64 = 1 << 48;
/// The load from which on a contact makes its island hard, as [`HEAVY`]: 3/4 m/s, half of it once it is. A stack of 24 boxes
/// has it at its foot, the pyramid of 40 rows does not; one of 20 would take five times as long.
const HARD: i64 = 3 << 46;
/// The load from which on what overlaps by more than [`SLACK`] twice is held back, as [`HEAVY`]: 6 m/s. Such a row has stored some
/// 10 J/kg. With 8 m/s, discs between two walls slip out at 8 m/s instead of 6; with 4 m/s at 5, but heaps that are turned over
/// overlap by a third more, and with 2 m/s twice as much.
const SQUEEZED: i64 = 6 << 48;
/// The speed with which overlaps are pushed apart at most: 1 m/s, 20 fraction bits. It bounds what is left of an overlap's bias
/// after the load has taken its part, so a row bears the more the deeper it is. Were it the bias that is bounded, a row would
/// bear nothing more beyond 3 cm, and discs in a room that is too small would never find where to rest.
const PUSH: i64 = 1 << 20;
/// The distance at which contacts are looked for: 2 cm, 32 fraction bits.
const MARGIN: i64 = 85_899_346;

/// 1 mm, 32 fraction bits.
const SLACK: i64 = 4_294_967;
/// 1 m/s, 48 fraction bits.
const SPEED: i64 = 1 << 48;

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
    /// With which part of itself in a second an overlap of rigid rows opens, Q14: an eighth in a tick. With a fifth in a
    /// substep a tower that becomes rigid would kick itself over, for to right a tilt at once takes more than its load.
    pub(crate) rigid_rate: i32,
    /// How fast an overlap opens at most, Q20.
    pub(crate) push: i64,
    pub(crate) soft: [i32; 2],
    /// 3/4 of the load that a row bears at the overlap from which on it is stiffer, Q20; below 2²⁸.
    pub(crate) firm: i32,
    pub(crate) margins: Margins,
    /// A tick in seconds over 2π, 63 fraction bits.
    pub(crate) tick_turn: i64,
    /// What of an overlap is no more than bodies at rest have, Q32 m.
    pub(crate) slack: i64,
    /// How fast overlaps are pushed apart at most, Q48 m/s over 2^k.
    pub(crate) recovery: i64,
    /// The overlap from which on an island is hard, Q32 m: sweeps would let what is pushed apart fly.
    pub(crate) deep: i64,
    /// How near is touching, Q32 m.
    pub(crate) touching: i64,
    /// The change of speed with which a body comes [`Scales::astray`] within a tick, Q48 m/s over 2^k.
    pub(crate) aside: i64,
}

impl Scales {
    pub(crate) fn new(tick_rate: u32, substeps: u32, shift: u32) -> Scales {
        let rate = i64::from(tick_rate).saturating_mul(substeps.into());
        let push_rate = round_shift(i128::from(SOFT.bias).saturating_mul(rate.into()), 16) as i32;
        // At rest the bias of an overlap bears the load: mass·overlap·bias/h = give·λ̂. From Q26·Q14 to Q20.
        let firm = i128::from(FIRM.saturating_mul(push_rate.into())).saturating_mul(SOFT.mass.into()) >> 20;
        let firm = div(firm.saturating_mul(3), i128::from(SOFT.impulse).saturating_mul(4)) as i32;
        Scales {
            shift,
            substeps,
            rate,
            line: div(1 << 63, rate.into()) as i64,
            turn: div(TURN_PER_RADIAN_Q64, i128::from(rate).saturating_mul(2)) as i64,
            coarse: div(1 << 30, rate.into()) as i32,
            close_rate: (rate << 14) as i32,
            push_rate,
            rigid_rate: i32::try_from(tick_rate).unwrap_or(i32::MAX >> 12) << 12,
            push: -PUSH,
            soft: [SOFT.mass, SOFT.impulse],
            firm,
            margins: Margins { base: MARGIN << shift, tick: div(1 << 63, tick_rate.into()) as i64 },
            tick_turn: div(TURN_PER_RADIAN_Q64, i128::from(tick_rate).saturating_mul(2)) as i64,
            slack: SLACK << shift,
            recovery: PUSH << 28,
            deep: (SLACK << shift).saturating_mul(10),
            touching: i64::from(SLOP) << shift.saturating_add(6),
            aside: (MARGIN / 2).saturating_mul(tick_rate.into()) << 16,
        }
    }

    /// Whether a contact with these impulses (Q48) of its points is heavy: it bears dozens of times its bodies' weight.
    pub(crate) fn is_heavy(normal: [i64; 2]) -> bool {
        normal[0].saturating_add(normal[1]) >= HEAVY
    }

    /// Whether a contact with these impulses (Q48) of its points makes its island hard: soft rows would yield by a millimetre.
    /// `was`: whether its island was; half of it is enough then, or islands would go to and fro.
    pub(crate) fn is_hard(normal: [i64; 2], was: bool) -> bool {
        normal[0].saturating_add(normal[1]) >= if was { HARD >> 1 } else { HARD }
    }

    /// Whether bodies that overlap by `overlap`, Q32 m, with these impulses (Q48) of their points are squeezed.
    pub(crate) fn is_squeezed(&self, normal: [i64; 2], overlap: i64) -> bool {
        normal[0].saturating_add(normal[1]) >= SQUEEZED && overlap > self.slack.saturating_mul(2)
    }

    /// When the n-th substep begins and ends, from 1 on; Q32 of the tick.
    pub(crate) fn span(&self, substep: u32) -> [i64; 2] {
        let begins = |n: u32| (i64::from(n) << 32).checked_div(self.substeps.into()).unwrap_or(0);
        [begins(substep.saturating_sub(1)), begins(substep)]
    }

    /// The speed of approach from which on a pair with this C_R (Q48) strikes instead of being pressed together, Q48 m/s.
    /// `press`: what forces add in a tick to the speed of one of them ([`weight`]); `among`: whether both lie among others.
    ///
    /// Below g·T/2·C_R a bounce would end within the tick, at a height of a third of a millimetre. What does not bounce is
    /// the rows' up to 1 m/s, which they stop as well; and so is a pile that settles, up to 4·g·T.
    pub(crate) fn threshold(&self, restitution: i64, press: i64, among: bool) -> i64 {
        if restitution >= SPEED {
            return 0;
        }
        let most = SPEED << self.shift;
        if restitution == 0 {
            return most;
        }
        let fast = div(i128::from(press) << 47, restitution.into()).clamp((most / 100).into(), most.into()) as i64;
        if among { fast.max(press.saturating_mul(4)) } else { fast }
    }

    /// The least speed of approach at which what was taken from the rows is answered as an impact, Q48 m/s; `borne`: rows
    /// bear a load there, and take what is slower, and goes in a substep less than an eighth of what reaches so far, Q32 m.
    pub(crate) fn least_strike(&self, restitution: i64, borne: bool, reach: i64) -> i64 {
        if restitution >= SPEED {
            return SPEED / 1_000_000;
        }
        let plain = if restitution > 0 { SPEED / 100 } else { SPEED / 2 } << self.shift;
        if !borne {
            return plain;
        }
        let most = if restitution > 0 { SPEED * 2 } else { SPEED * 8 } << self.shift;
        most.min(clamp_i64(i128::from(reach).saturating_mul(self.rate.into()) << 13)).max(plain)
    }

    /// The speed beyond which a near pair parts, Q48 m/s: slower ones may be at rest, unless they bounce off everything.
    /// In a pile much parts slowly, and comes to rest only if rows have it. `threshold`, `press`: as above.
    pub(crate) fn parting(&self, restitution: i64, gap: bool, threshold: i64, press: i64) -> i64 {
        match (restitution >= SPEED, gap) {
            (true, true) => -1,
            (true, false) => (SPEED / 100) << self.shift,
            (false, _) if press == 0 => threshold,
            (false, _) => SPEED << self.shift,
        }
    }

    /// How far from the way on which it was looked for neighbours a body that rows push may be, Q32 m: half of what is
    /// looked around for contacts, so that two that meet have come as far as that together.
    pub(crate) fn astray(&self) -> i64 {
        self.margins.base / 2
    }

    /// The speed of rims from which on what touches elsewhere may follow, Q48 m/s: 1 m/s, 2 cm in a tick.
    pub(crate) fn swinging(&self) -> i64 {
        SPEED << self.shift
    }

    /// How fast contacts separate that are at rest all the same, Q48 m/s: 1 mm/s.
    pub(crate) fn still(&self) -> i64 {
        (SPEED / 1000) << self.shift
    }

    /// A part of the tick in seconds.
    pub(crate) fn time(&self, part: i64) -> Time {
        Time::from_bits(mul(part, self.margins.tick, 47))
    }

    /// The same for what came to rest in this tick: 0.1 m/s, 2 mm until the rows have it.
    pub(crate) fn least_settled(&self) -> i64 {
        (SPEED / 10) << self.shift
    }
}

/// What forces add in a tick to a body's speed, in whatever direction: in a pile loads come from all sides. At most an
/// eighth too much.
pub(crate) fn weight(gain: [i64; 2]) -> i64 {
    let [x, y] = gain.map(i64::saturating_abs);
    x.max(y).saturating_add(x.min(y) >> 1)
}
