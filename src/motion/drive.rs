//! What constant acceleration does to each body in one step of the scheme: derived from the cold data, kept so that
//! a tick does one product per coordinate, and renewed by the commands that change it.

use super::damping::Decay;
use super::gravity::Source;
use super::integrate::{Integrator, Stage, stages};
use super::span::Span;
use crate::body::{Attractor, Bodies, BodyData, BodyKind};
use crate::geom::Vec2;
use crate::num::{Acceleration, Damping, Force, Mu, Torque, clamp_i64, mul, mul_div};
use crate::store::{Arena, Cells, Draft, Kind, Show, Tables, clone_fields, record, show};

/// A force and a torque that act on a body for one tick.
#[derive(Debug, PartialEq)]
pub(crate) struct Push {
    pub(crate) slot: u32,
    pub(crate) force: Vec2<Force>,
    pub(crate) torque: Torque,
}

record!(Push { slot, force, torque } shown);

/// Fraction bits of [`Drive::bow`]: a·T²/2 ≤ 32 768/450 < 2⁷ m for T ≤ 1/15 s, and 2⁷·2⁵⁶ fits.
const BOW_FRAC: u32 = 56;
/// What brings a bow to the 48 + 63 fraction bits of the product v·T.
pub(crate) const BOW_SHIFT: u32 = 48 + 63 - BOW_FRAC;

/// A body with damping: its factors over one [`Stage::Glide`] or [`Stage::Decay`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damped {
    pub(crate) slot: u32,
    /// The rates that the factors are for.
    rates: [Damping; 2],
    /// Along a line, and the multiplier T·φ₁ that takes a velocity to a way.
    pub(crate) line: Decay,
    pub(crate) line_span: i64,
    /// The same for turning.
    pub(crate) turn: Decay,
    pub(crate) turn_span: i64,
}

show!(Damped { slot, rates, line, line_span, turn, turn_span });

/// The prepared motion of all bodies. Everything in it is derived.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Drive {
    /// What a step of the integrator consists of, and how many steps a tick has.
    pub(crate) stages: Vec<Stage>,
    pub(crate) steps: u32,
    /// The span that damping is prepared for: that of a glide, or of a decay.
    decay_span: u32,
    /// Per body, for x, y and turning: the change of velocity in a glide; in other schemes the acceleration. 48
    /// fraction bits.
    pub(crate) kick: [Vec<i64>; 3],
    /// What acceleration adds to the way in a glide: 56 fraction bits, metres and turns. In other schemes zero.
    pub(crate) bow: [Vec<i64>; 3],
    /// Bodies with damping, by slot.
    pub(crate) damped: Vec<Damped>,
    /// Bodies whose constant acceleration had to be limited to its format, by slot.
    pub(crate) limited: Vec<u32>,
    /// Where in the list of this tick's forces a body's are, by slot; `u32::MAX` for none.
    pub(crate) push_at: Vec<u32>,
    /// What pulls: attractors by slot, then bodies by slot. Their order is the order of summation.
    pub(crate) sources: Vec<Source>,
}

clone_fields!(Drive { stages, steps, decay_span, kick, bow, damped, limited, push_at, sources });

/// What is prepared for one body.
struct Driven<'d>(&'d Drive, usize);

impl Show for Driven<'_> {
    fn show(&self, cells: &mut Cells<'_>) {
        let Driven(drive, slot) = *self;
        let of = |columns: &[Vec<i64>; 3]| columns.each_ref().map(|column| column[slot]);
        cells.field("kick", |c| of(&drive.kick).show(c));
        cells.field("bow", |c| of(&drive.bow).show(c));
        cells.field("push", |c| drive.push_at[slot].show(c));
    }
}

impl Drive {
    /// Hands on all of it as tables.
    pub(crate) fn show(&self, draft: &mut Draft, tables: &mut impl Tables) {
        let Drive { stages, steps, decay_span, kick: _, bow: _, damped, limited, push_at, sources } = self;
        draft.table(tables, "prepared motion", Kind::Body, (0..push_at.len()).map(|slot| Driven(self, slot)));
        draft.table(tables, "prepared damping", Kind::OfBody, damped.iter());
        draft.table(tables, "limited accelerations", Kind::OfBody, limited.iter());
        draft.table(tables, "sources", Kind::List, sources.iter());
        draft.table(tables, "integrator's stages", Kind::List, stages.iter());
        draft.table(tables, "integrator's steps", Kind::List, [steps, decay_span].into_iter());
    }
}

/// The constant acceleration of a body in m/s² and rad/s², 48 fraction bits, not yet limited to its format.
///
/// Why nothing overflows: quotients have 256-bit numerators and saturate, as the sums do.
pub(crate) fn acceleration(data: &BodyData, gravity: Vec2<Acceleration>, push: Option<&Push>) -> [i128; 3] {
    if !data.is_dynamic() {
        return [0; 3];
    }
    let along = |force: i128, push: Option<i128>, gravity: Acceleration| {
        let force = force.saturating_add(push.unwrap_or(0));
        mul_div(force, 1 << 48, data.mass.to_bits()).saturating_add(gravity.to_bits().into())
    };
    let alpha = if data.fixed_rotation {
        0
    } else {
        let torque = data.torque.to_bits().saturating_add(push.map_or(0, |p| p.torque.to_bits()));
        mul_div(torque, 1 << 48, data.inertia.to_bits())
    };
    [
        along(data.force.x.to_bits(), push.map(|p| p.force.x.to_bits()), gravity.x),
        along(data.force.y.to_bits(), push.map(|p| p.force.y.to_bits()), gravity.y),
        alpha,
    ]
}

impl Drive {
    /// Everything anew: after loading, and when the scheme, the span or the sources change.
    pub(crate) fn prepare(
        &mut self,
        integrator: Integrator,
        tick_rate: u32,
        substeps: u32,
        bodies: &Bodies,
        attractors: &Arena<Attractor>,
    ) {
        self.sources.clear();
        let fixed = attractors.iter().filter(|(_, a)| a.mu != Mu::ZERO);
        self.sources.extend(fixed.map(|(slot, a)| Source::fixed(slot, *a)));
        let heavy = bodies.cold.iter().filter(|(_, data)| data.mu != Mu::ZERO);
        self.sources.extend(heavy.map(|(slot, data)| Source::carried(slot, data.mu)));

        let scheme = stages(integrator, tick_rate, substeps, !self.sources.is_empty());
        (self.stages, self.steps, self.decay_span) = scheme;
        self.damped.clear();
        self.limited.clear();
        self.grow(bodies.cold.len());
    }

    /// Room for `slots` bodies.
    pub(crate) fn grow(&mut self, slots: usize) {
        for column in self.kick.iter_mut().chain(&mut self.bow) {
            column.resize(slots, 0);
        }
        self.push_at.resize(slots, u32::MAX);
    }

    /// Renews where each body's forces are in the list.
    pub(crate) fn index_pushes(&mut self, pushes: &[Push]) {
        self.push_at.fill(u32::MAX);
        for (at, push) in pushes.iter().enumerate() {
            self.push_at[push.slot as usize] = at as u32;
        }
    }

    /// The forces of this tick on a body.
    pub(crate) fn push_of<'p>(&self, slot: usize, pushes: &'p [Push]) -> Option<&'p Push> {
        pushes.get(*self.push_at.get(slot)? as usize)
    }

    /// What constant forces add to a body's velocity in a tick of 1/`tick` s (Q63), Q48 m/s; without damping, if any.
    pub(crate) fn gain(&self, slot: usize, tick: i64) -> [i64; 2] {
        let [x, y, _] = &self.kick;
        let kick = [x[slot], y[slot]];
        if self.stages == [Stage::Glide] { kick } else { kick.map(|a| mul(a, tick, 63)) }
    }

    /// The span of a glide for bodies without damping.
    pub(crate) fn glide_span(&self) -> Span {
        Span::new(self.decay_span)
    }

    /// Puts a source in its place, in that of another by the same carrier, or takes that one out if its μ is 0.
    /// Whether there are sources now and were none, or the other way round: then the scheme is another one.
    pub(crate) fn set_source(&mut self, source: Source) -> bool {
        let was_empty = self.sources.is_empty();
        let at = self.sources.partition_point(|other| other.order() < source.order());
        let present = self.sources.get(at).is_some_and(|other| other.order() == source.order());
        match (present, source.pulls()) {
            (true, true) => self.sources[at] = source,
            (true, false) => drop(self.sources.remove(at)),
            (false, true) => self.sources.insert(at, source),
            (false, false) => {}
        }
        was_empty != self.sources.is_empty()
    }

    /// Whether a body that may move pulls others.
    pub(crate) fn is_pulled_by_movers(&self, bodies: &Bodies) -> bool {
        let carriers = self.sources.iter().filter_map(|source| source.body());
        carriers.into_iter().any(|slot| bodies.cold.value(slot).kind != BodyKind::Static)
    }

    /// Moves the sources that bodies carry to where these are.
    pub(crate) fn follow(&mut self, bodies: &Bodies) {
        for source in &mut self.sources {
            source.follow(bodies);
        }
    }

    /// The motion of the body in `slot` from its constant acceleration and its damping.
    pub(crate) fn set(&mut self, slot: usize, data: &BodyData, gravity: Vec2<Acceleration>, push: Option<&Push>) {
        let Damped { line: decay_line, turn: decay_turn, .. } = self.damping(slot, data);
        let wide = acceleration(data, gravity, push);
        let accelerations = wide.map(clamp_i64);
        let limited = accelerations.map(i128::from) != wide;
        let [ax, ay, alpha] = accelerations;
        let (kicks, bows) = if self.stages == [Stage::Glide] {
            // v·e + a·T·φ₁ and v·T·φ₁ + a·T²·φ₂.
            let span = self.glide_span();
            let squared = span.squared();
            let (kick_line, bow_line) = decay_line.scale(span.line, squared.line);
            let (kick_turn, bow_turn) = decay_turn.scale(span.line, squared.turn);
            let kicks = [mul(ax, kick_line, 63), mul(ay, kick_line, 63), mul(alpha, kick_turn, 63)];
            (kicks, [mul(ax, bow_line, BOW_SHIFT), mul(ay, bow_line, BOW_SHIFT), mul(alpha, bow_turn, BOW_SHIFT)])
        } else {
            (accelerations, [0; 3])
        };
        for (column, kick) in self.kick.iter_mut().zip(kicks) {
            column[slot] = kick;
        }
        for (column, bow) in self.bow.iter_mut().zip(bows) {
            column[slot] = bow;
        }
        let at = self.limited.partition_point(|&other| (other as usize) < slot);
        match (self.limited.get(at) == Some(&(slot as u32)), limited) {
            (true, false) => drop(self.limited.remove(at)),
            (false, true) => self.limited.insert(at, slot as u32),
            _ => {}
        }
    }

    /// The factors of a body's damping; those of bodies that have some are kept until their rates change.
    fn damping(&mut self, slot: usize, data: &BodyData) -> Damped {
        let rates = [data.linear_damping, data.angular_damping];
        let at = self.damped.partition_point(|d| (d.slot as usize) < slot);
        let kept = self.damped.get(at).filter(|d| d.slot as usize == slot).copied();
        match kept {
            Some(damped) if damped.rates == rates => return damped,
            Some(_) => drop(self.damped.remove(at)),
            None => {}
        }
        let span = self.glide_span();
        let [line, turn] = rates.map(|rate| Decay::new(rate, self.decay_span));
        let (line_span, turn_span) = (line.scale(span.line, 0).0, turn.scale(span.turn, 0).0);
        let damped = Damped { slot: slot as u32, rates, line, line_span, turn, turn_span };
        if rates != [Damping::ZERO; 2] {
            self.damped.insert(at, damped);
        }
        damped
    }
}
