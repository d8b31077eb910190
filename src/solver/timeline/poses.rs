//! Outlines as they were last turned: an impact looks at a body with all its neighbours, which are the next one's as well.

use crate::geom::Rot;
use crate::num::Angle;
use crate::shape::{Outline, Placed};

/// How many are kept: the collider's slot says which.
const KEPT: usize = 64;

/// Of colliders of this tick.
#[derive(Debug)]
pub(super) struct Poses {
    /// The collider and the angle of its body, Q48 turns, of each; [`NOBODY`] of none.
    keys: [(u32, i64); KEPT],
    placed: Vec<Placed>,
}

const NOBODY: (u32, i64) = (u32::MAX, 0);

impl Default for Poses {
    fn default() -> Self {
        Poses { keys: [NOBODY; KEPT], placed: Vec::new() }
    }
}

impl Poses {
    /// Forgets all: commands may change what a collider is.
    pub(super) fn clear(&mut self) {
        self.keys = [NOBODY; KEPT];
    }

    /// Two outlines, each of a collider and turned by an angle.
    pub(super) fn of(&mut self, colliders: [u32; 2], outlines: [&Outline; 2], angles: [i64; 2]) -> [&Placed; 2] {
        let seat = |body: usize| colliders[body] as usize % KEPT;
        // Those of a pair keep out of each other's way.
        let seats = [seat(0), if seat(1) == seat(0) { seat(1) ^ 1 } else { seat(1) }];
        let room = seats[0].max(seats[1]).saturating_add(1);
        if self.placed.len() < room {
            self.placed.resize(room, Placed::default());
        }
        for body in 0..2 {
            let (seat, key) = (seats[body], (colliders[body], angles[body]));
            if self.keys[seat] != key {
                self.keys[seat] = key;
                self.placed[seat] = Placed::new(outlines[body], Rot::new(Angle::from_bits(angles[body])));
            }
        }
        seats.map(|seat| &self.placed[seat])
    }
}
