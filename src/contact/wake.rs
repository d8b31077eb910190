//! What wakes: which sleeping bodies a tick would move.

use super::find::{Pair, Touch};
use super::row::Contact;
use crate::body::{Bodies, Colliders};
use crate::geom::{Aabb, Rot};
use crate::shape::Placed;

impl Touch {
    /// The sleeping bodies that a step has touched, into `found`: `outcome` says what the solver made of a pair.
    pub(crate) fn find_touched(&self, bodies: &Bodies, outcome: impl Fn(&Pair) -> Contact, found: &mut Vec<u32>) {
        found.clear();
        for pair in self.pairs.iter().filter(|pair| !pair.sensor) {
            let asleep = pair.bodies.map(|slot| bodies.rest.is_asleep(slot as usize));
            if asleep != [false; 2] && outcome(pair).lasts() {
                found.extend(pair.bodies.into_iter().zip(asleep).filter(|&(_, asleep)| asleep).map(|(slot, _)| slot));
            }
        }
    }

    /// The sleeping bodies whose colliders' boxes overlap those of a body's, into `found`.
    pub(crate) fn find_in_place(&self, slot: usize, bodies: &Bodies, colliders: &Colliders, found: &mut Vec<u32>) {
        found.clear();
        let list = |slot: usize| colliders.list(bodies.cold.value(slot).first);
        for collider in list(slot) {
            let own = bounds(collider, bodies, colliders);
            self.around(&own, |other| {
                let of = colliders.rows.value(other as usize).body;
                // Exactly, so that what the broad phase hands out besides has no say.
                if bodies.rest.is_asleep(of as usize) && bounds(other as usize, bodies, colliders).overlaps(&own) {
                    found.push(of);
                }
            });
        }
    }
}

/// The box around a collider as it lies now.
fn bounds(collider: usize, bodies: &Bodies, colliders: &Colliders) -> Aabb {
    let body = colliders.rows.value(collider).body as usize;
    let placed = Placed::new(colliders.outline(collider), Rot::new(bodies.angle.get(body)));
    super::ways::around(bodies.position(body), placed.min, placed.max)
}
