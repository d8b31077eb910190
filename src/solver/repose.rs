//! Repose: islands that a tick leaves as they are.
//!
//! Rows leave some µm/s over, so nothing would ever come to rest exactly: a pile would tremble and creep, and cost what it costs
//! when it moves. Bodies that are neighbours, of which none went faster in a tick than that, or is left faster, end the tick as they
//! began it, but without velocity; their contacts keep their impulses as well. That is so if contacts hold each of them to something
//! that stands; or else if the tick has left it where it was, with the velocity that it had. From then on each tick of them is the
//! same one, and what is known need not be computed: as long as they lie among the same neighbours under the same forces, they get no
//! rows.
//!
//! The first is law. The second is a memory of the law's results: it may be empty at any time, and makes no difference.

#[cfg(test)]
mod tests;

use super::Solver;
use super::color::VACANT as NONE;
use super::island::{leader_of, unite};
use super::mover::Movers;
use super::rows::LANES;
use super::scales::Scales;
use crate::body::{Bodies, BodyKind};
use crate::contact::{Contact, Contacts, NEW, Pair};
use crate::geom::Vec2;
use crate::motion::{Drive, Fault};
use crate::num::{Angle, AngularVelocity, Length};

/// How fast a body in repose went in the tick, and how fast it is when rows are done with it, at most: 16·2⁻²⁰ m/s, Q20. So what
/// forces would add to it by 15 µm/s a tick stays: 0.9 mm/s² at 60 ticks/s, 15 mm/s² at 1000. With 4, one of 4000 boxes kept all of
/// a settled pile from it for four seconds.
const LEAST: u32 = 16;

/// As a number of pairs: more than are ever found.
const FORGOTTEN: u32 = NONE - 1;

/// The islands that are known to end a tick as they begin it. All of it is derived.
#[derive(Debug, Default)]
pub(crate) struct Repose {
    members: Vec<Member>,
    /// By slot of a body: the one that stands for its island, or [`NONE`].
    island: Vec<u32>,
    /// By slot of one that stands for an island: how many pairs that has, and how many of them are there in this tick; [`NONE`] if
    /// one is another.
    pairs: Vec<u32>,
    found: Vec<u32>,
    calm: Calm,
}

/// A body in repose: where it is, and what forces do to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Member {
    slot: u32,
    at: [i64; 3],
    kick: [i64; 3],
    /// What forces add to its way. Of accelerations that give the same kick, one may be rounded up here.
    bow: [i64; 3],
}

/// The islands of a tick, by place among the movers.
#[derive(Debug, Default)]
struct Calm {
    /// Whether contacts move it.
    moves: Vec<bool>,
    /// Another one of its island, nearer to the one that stands for it.
    leader: Vec<u32>,
    /// Whether it does not repose; of one that stands for an island, whether that does not.
    up: Vec<bool>,
    /// Another one that a contact presses it to, nearer to the one that stands for all that hang together by such; 0 for a body that
    /// contacts do not move and that stands.
    holder: Vec<u32>,
    /// Of one that stands for an island: whether the next tick may be another one; how many pairs it has.
    fresh: Vec<bool>,
    pairs: Vec<u32>,
}

impl Member {
    fn new(slot: usize, bodies: &Bodies, drive: &Drive) -> Member {
        let at = pose(bodies, slot);
        let of = |columns: &[Vec<i64>; 3]| columns.each_ref().map(|column| column[slot]);
        Member { slot: slot as u32, at, kick: of(&drive.kick), bow: of(&drive.bow) }
    }

    /// Whether nothing about it has changed.
    fn is(&self, bodies: &Bodies, drive: &Drive) -> bool {
        let slot = self.slot as usize;
        !moves(bodies, slot) && *self == Member::new(slot, bodies, drive)
    }
}

impl Repose {
    /// Knows nothing any more.
    pub(crate) fn clear(&mut self) {
        for member in self.members.drain(..) {
            self.island[member.slot as usize] = NONE;
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// Who stands for the island of a body that is known to end the tick as it begins it.
    #[inline]
    fn island(&self, slot: u32) -> Option<usize> {
        self.island.get(slot as usize).filter(|&&island| island != NONE).map(|&island| island as usize)
    }

    /// Whether a body is known to end the tick as it begins it.
    #[inline]
    pub(crate) fn holds(&self, slot: u32) -> bool {
        self.island(slot).is_some()
    }

    /// A command has made another one of a body: its island is forgotten when the tick begins.
    pub(crate) fn forget(&mut self, slot: usize) {
        if let Some(island) = self.island(slot as u32) {
            self.pairs[island] = FORGOTTEN;
        }
    }

    /// The bodies that are known to end the tick as they begin it.
    pub(super) fn slots(&self) -> impl Iterator<Item = usize> + '_ {
        self.members.iter().map(|member| member.slot as usize)
    }

    /// Forgets the islands of which not all pairs were found.
    fn drop_others(&mut self) {
        let Repose { members, island, pairs, found, .. } = self;
        members.retain(|member| {
            let of = &mut island[member.slot as usize];
            let same = found[*of as usize] == pairs[*of as usize];
            *of = if same { *of } else { NONE };
            same
        });
    }

    /// When the pairs of a tick are found: forgets what is not as it was, and notes the pairs of what is.
    pub(crate) fn confirm(&mut self, pairs: &mut [Pair], bodies: &Bodies, drive: &Drive) {
        if self.is_empty() {
            return;
        }
        let Repose { members, island, found, .. } = self;
        for member in &*members {
            found[island[member.slot as usize] as usize] = 0;
        }
        for member in members.iter().filter(|member| !member.is(bodies, drive)) {
            found[island[member.slot as usize] as usize] = NONE;
        }
        for pair in pairs.iter().filter(|pair| !pair.sensor) {
            let islands = pair.bodies.map(|slot| self.island(slot));
            // What is of no island is what contacts do not move, and stays.
            let stays = |at: usize| islands[at].is_some() || stays(bodies, pair.bodies[at] as usize);
            let same = pair.known && stays(0) && stays(1) && (islands[0] == islands[1] || islands.contains(&None));
            let other = islands[1].filter(|_| islands[1] != islands[0]);
            for island in islands[0].into_iter().chain(other) {
                let found = &mut self.found[island];
                *found = if same { found.saturating_add(1) } else { NONE };
            }
        }
        self.drop_others();
        for pair in pairs.iter_mut().filter(|pair| !pair.sensor) {
            pair.stays = pair.bodies.iter().any(|&slot| self.holds(slot));
        }
    }

    /// Puts the bodies back that had no rows.
    pub(crate) fn put_back(&self, bodies: &mut Bodies) {
        for &Member { slot, at, .. } in &self.members {
            put(bodies, slot as usize, at);
        }
    }

    /// Knows the calm islands of which the next tick will be what this one was.
    fn remember(&mut self, calm: &mut Calm, movers: &Movers, bodies: &Bodies, drive: &Drive) {
        let Repose { members, island, pairs, found, .. } = self;
        let slots = bodies.cold.len();
        island.resize(slots, NONE);
        pairs.resize(slots, 0);
        found.resize(slots, 0);
        for place in 1..calm.moves.len() {
            let Some(leader) = calm.island(place as u32).filter(|&leader| !calm.fresh[leader]) else { continue };
            let (slot, stands) = (movers.slot(place as u32), movers.slot(leader as u32));
            members.push(Member::new(slot, bodies, drive));
            (island[slot], pairs[stands]) = (stands as u32, calm.pairs[leader]);
        }
    }
}

impl Calm {
    /// Who stands for the island in repose of one that contacts move.
    fn island(&mut self, place: u32) -> Option<usize> {
        let leader = leader_of(&mut self.leader, place) as usize;
        (self.moves[place as usize] && !self.up[leader]).then_some(leader)
    }

    /// Each body by itself; whether any is calm.
    fn find(&mut self, movers: &Movers, before: &[[i64; 6]], free: &[bool], bodies: &Bodies, scales: &Scales) -> bool {
        let Calm { moves, leader, up, holder, fresh, pairs } = self;
        moves.clear();
        for own in [leader, holder] {
            own.clear();
            own.extend(0..free.len() as u32);
        }
        up.clear();
        fresh.clear();
        fresh.resize(free.len(), false);
        pairs.clear();
        pairs.resize(free.len(), 0);
        for (place, (&free, &[x, y, angle, ..])) in free.iter().zip(before).enumerate() {
            let slot = if place == 0 { 0 } else { movers.slot(place as u32) };
            let own = place != 0 && !free && !bodies.rest.is_asleep(slot);
            moves.push(own);
            let stays = || movers.creeps(place, LEAST, scales).unwrap_or_else(|| pose(bodies, slot) == [x, y, angle]);
            up.push(!own || !stays());
        }
        up.contains(&false)
    }

    /// What rows hold together, and what of it moves on.
    fn join(&mut self, places: &[[u32; 2]], before: &[[i64; 6]]) {
        for &[a, b] in places {
            let own = [a, b].map(|place| self.moves[place as usize]);
            let calm = [own[0] && !self.up[a as usize], own[1] && !self.up[b as usize]];
            if calm == [false; 2] {
                continue;
            }
            // A kinematic body that moves, or one beside it that does not repose.
            let drags = |at: usize, place: u32| {
                if own[at] { !calm[at] } else { before[place as usize][3..] != [0; 3] }
            };
            if drags(0, a) || drags(1, b) {
                self.rouse([a, b]);
            } else if calm == [true; 2] {
                unite(&mut self.leader, [a, b]);
            }
        }
    }

    /// Those that contacts move do not repose.
    fn rouse(&mut self, places: [u32; 2]) {
        for place in places.map(|place| place as usize) {
            self.up[place] |= self.moves[place];
        }
    }

    /// Says of islands what was said of one of their bodies. Whether any is calm.
    fn lead(&mut self) -> bool {
        let Calm { moves, leader, up, .. } = self;
        for place in 1..up.len() {
            let leader = leader_of(leader, place as u32) as usize;
            up[leader] |= up[place] && moves[place];
        }
        (1..up.len()).any(|place| moves[place] && !up[leader_of(leader, place as u32) as usize])
    }
}

impl Solver {
    /// Finds the islands that end the tick as they began it, and leaves them so. The faults from `ends` on are bounds that bodies met
    /// where rows or flights put them: they go for those that are put back.
    pub(super) fn settle(
        &mut self,
        pairs: &mut [Pair],
        contacts: &Contacts,
        bodies: &mut Bodies,
        drive: &Drive,
        (faults, ends): (&mut Vec<Fault>, usize),
    ) {
        // What attracts pulls otherwise in each tick.
        let lasting = drive.sources.is_empty();
        let mut calm = core::mem::take(&mut self.repose.calm);
        if calm.find(&self.movers, &self.before, &self.free, bodies, &self.scales)
            && self.find_calm(&mut calm, pairs, contacts, bodies)
        {
            for place in 1..calm.moves.len() {
                let Some(island) = calm.island(place as u32) else { continue };
                let [x, y, angle, velocity @ ..] = self.before[place];
                put(bodies, self.movers.slot(place as u32), [x, y, angle]);
                self.movers.stay(place);
                calm.fresh[island] |= !lasting || velocity != [0; 3];
            }
            for pair in pairs.iter_mut().filter(|pair| !pair.sensor && !pair.stays) {
                let [a, b] = pair.bodies.map(|slot| calm.island(self.movers.place_of(slot)));
                for island in a.into_iter().chain(b.filter(|_| a != b)) {
                    // What has no rows may strike in the next tick.
                    calm.fresh[island] |= pair.row == NEW;
                    calm.pairs[island] = calm.pairs[island].saturating_add(1);
                    pair.stays = pair.row != NEW;
                }
            }
            let mut at = 0..faults.len();
            faults.retain(|fault| {
                at.next() < Some(ends) || calm.island(self.movers.place_of(fault.slot as u32)).is_none()
            });
            self.repose.remember(&mut calm, &self.movers, bodies, drive);
        }
        self.repose.calm = calm;
    }

    /// Of islands of calm bodies, those of which no contact became another one, and nobody goes on whom nothing holds. Whether there
    /// may be one.
    fn find_calm(&self, calm: &mut Calm, pairs: &[Pair], contacts: &Contacts, bodies: &Bodies) -> bool {
        calm.join(&self.constraints.places, &self.before);
        let may_have_met = self.fast.iter().chain(&self.timeline.met).chain(&self.turning);
        let met = may_have_met.map(|&at| &pairs[at as usize]).filter(|pair| pair.met);
        for bodies in met.map(|pair| pair.bodies).chain(self.timeline.late.iter().map(|&[_, bodies]| bodies)) {
            calm.rouse(bodies.map(|slot| self.movers.place_of(slot)));
        }
        if !calm.lead() {
            return false;
        }
        for pair in pairs.iter().filter(|pair| !pair.sensor && !pair.stays) {
            let places = pair.bodies.map(|slot| self.movers.place_of(slot) as usize);
            let islands = places.map(|place| calm.island(place as u32));
            if islands == [None; 2] {
                continue;
            }
            let same = is_same(&self.outcome(pair), pair, contacts);
            for island in islands.into_iter().flatten() {
                calm.up[island] |= !same;
            }
            let stands = |place: usize| !calm.moves[place] && self.before[place][3..] == [0; 3];
            if self.presses(pair) {
                let holders = places.map(|place| if stands(place) { 0 } else { place as u32 });
                unite(&mut calm.holder, holders);
            }
        }
        for place in 1..calm.moves.len() {
            let Some(island) = calm.island(place as u32) else { continue };
            let slot = self.movers.slot(place as u32);
            let [x, y, angle, vx, vy, omega] = self.before[place];
            // What is too slow to get anywhere, and becomes no faster, goes nowhere.
            let faster = moves(bodies, slot) && velocity_of(bodies, slot) != [vx, vy, omega];
            let goes = faster || pose(bodies, slot) != [x, y, angle];
            calm.up[island] |= goes && leader_of(&mut calm.holder, place as u32) != 0;
        }
        true
    }

    /// Whether rows of a pair pushed in this tick.
    fn presses(&self, pair: &Pair) -> bool {
        pair.row != NEW && {
            let seat = self.colors.seats[pair.row as usize] as usize;
            self.blocks[seat / LANES].spent(seat % LANES)
        }
    }
}

/// Whether a contact is what it was but for its impulses.
fn is_same(contact: &Contact, pair: &Pair, contacts: &Contacts) -> bool {
    let last = pair.last(contacts);
    contact.lasts() == (pair.old != NEW) && (contact.touching, contact.mode) == (last.touching, last.mode)
}

/// Whether a body has a velocity.
fn moves(bodies: &Bodies, slot: usize) -> bool {
    !bodies.velocity(slot).is_zero() || bodies.omega.get(slot) != AngularVelocity::ZERO
}

/// Whether no contact moves a body, and it stays where it is in this tick. Not who sleeps: in his rows others may be as well, and
/// which sweep solves these depends on how many rows he has.
fn stays(bodies: &Bodies, slot: usize) -> bool {
    bodies.cold.value(slot).kind != BodyKind::Dynamic && !moves(bodies, slot)
}

/// Where a body is, and how it is turned.
fn pose(bodies: &Bodies, slot: usize) -> [i64; 3] {
    [bodies.x.bits()[slot], bodies.y.bits()[slot], bodies.angle.bits()[slot]]
}

fn velocity_of(bodies: &Bodies, slot: usize) -> [i64; 3] {
    let velocity = bodies.velocity(slot);
    [velocity.x.to_bits(), velocity.y.to_bits(), bodies.omega.get(slot).to_bits()]
}

/// Puts a body somewhere, without velocity.
fn put(bodies: &mut Bodies, slot: usize, [x, y, angle]: [i64; 3]) {
    bodies.set_position(slot, Vec2::new(Length::from_bits(x), Length::from_bits(y)));
    bodies.angle.set(slot, Angle::from_bits(angle));
    bodies.set_velocity(slot, Vec2::default());
    bodies.omega.set(slot, AngularVelocity::ZERO);
}
