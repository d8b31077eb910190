//! Frames: what a tick changes, apart from what only commands do.

use super::tables::{Change, Digests, Tables};
use super::{HashPart, Hashes, header, root};
use crate::World;
use crate::body::{Motion, Rest};
use crate::contact::Contacts;
use crate::motion::Push;
use crate::store::{DecodeError, Record, hash_bytes, hash_numbers, put, record};
use crate::world::Status;
use core::fmt;

/// What a [`World::step`] can change: where bodies are and how they move, who sleeps, contacts with the impulses with which the next
/// tick begins, forces of one tick, the status, the tick. And digests of what only commands change (the tables: configuration,
/// bodies' constants, colliders, attractors), by which a world sees whether it is a frame of it.
///
/// Size, here and encoded: 48 bytes a body, 52 with sleeping; 48 a contact; a few hundred besides. A frame that is
/// used again reuses its memory. Where bodies come and go, [`Rollback`](crate::Rollback) keeps the tables as well.
///
/// ```
/// use tamias2d::{BodyDef, Commands, Frame, Vec2, World, WorldDef};
/// let mut world = World::new(&WorldDef::default())?;
/// let ball = world.create_body(&BodyDef { velocity: Vec2::from_f64(3.0, 0.0)?, ..BodyDef::default() })?;
/// let mut frame = Frame::default();
/// world.save_frame(&mut frame);
/// world.step();
/// let (after, hash) = (world.body(ball).expect("there").position(), world.hash());
/// world.restore_frame(&frame)?;
/// assert_eq!((world.tick(), world.hash()), (0, frame.hash()));
/// world.step();
/// assert_eq!((world.body(ball).expect("there").position(), world.hash()), (after, hash));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct Frame {
    tick: u64,
    digests: Digests,
    /// The hash of the configuration with the tick, as it is part of the state's.
    clock: u64,
    motion: Motion,
    quiet: Vec<u32>,
    contacts: Contacts,
    resting: Contacts,
    pushes: Vec<Push>,
    status: Status,
    /// The hash of `resting`. Derived.
    asleep: u64,
    /// Whether contacts may be on the wrong list.
    stirred: bool,
    /// Whether it comes from bytes: then nobody knows whether a step could have made it.
    foreign: bool,
}

record!(Frame { tick, digests, clock, motion, quiet, contacts, resting, pushes, status } derived { asleep, stirred, foreign });

/// Why a frame is none of a world. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameError {
    /// The world has other tables than that which the frame was saved of.
    Tables {
        /// The frame's tick.
        tick: u64,
        /// The first table that differs: `configuration`, `bodies`, `colliders` or `attractors`.
        what: &'static str,
        /// Its digest in the frame.
        frame: u64,
        /// And in the world.
        world: u64,
    },
    /// A frame from bytes that no step of this world makes.
    Unsound {
        /// The frame's tick.
        tick: u64,
    },
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FrameError::Tables { tick, what, frame, world } => write!(
                f,
                "the frame of tick {tick} was saved with another table of {what} (digest {frame:016x}) than the world has \
                 ({world:016x}): restore it into the world it is of, or load a whole save"
            ),
            FrameError::Unsound { tick } => {
                write!(
                    f,
                    "the frame of tick {tick} is none that a step of this world makes: ask for it again, or load a whole save"
                )
            }
        }
    }
}

impl core::error::Error for FrameError {}

impl World {
    /// Saves what ticks change into a frame, whose memory is used again: nothing is allocated once it has held as much.
    ///
    /// Cost: one copy of the columns and the contacts; no pass that hashes them.
    pub fn save_frame(&self, frame: &mut Frame) {
        self.save_frame_of(frame, Digests::of(self));
    }

    /// As [`World::save_frame`], of a world whose tables have these digests.
    pub(crate) fn save_frame_of(&self, frame: &mut Frame, known: Digests) {
        // All of the world, so that what is new in it has to be said here.
        let World {
            config: _,
            tick,
            bodies,
            colliders: _,
            attractors: _,
            pushes,
            contacts,
            resting,
            status,
            drive: _,
            touch: _,
            solver: _,
            events: _,
            faults: _,
            next: _,
        } = self;
        let Frame {
            tick: when,
            digests,
            clock,
            motion,
            quiet,
            contacts: awake,
            resting: still,
            pushes: forces,
            status: limited,
            asleep,
            stirred,
            foreign,
        } = frame;
        (*when, *digests, *clock, *foreign) = (*tick, known, self.clock_hash(), false);
        motion.copy_from(bodies);
        quiet.clear();
        quiet.extend_from_slice(bodies.rest.numbers());
        awake.clone_from(contacts);
        if *asleep != resting.hash() || still.len() != resting.contacts.len() {
            still.clone_from(&resting.contacts);
        }
        (*asleep, *stirred) = (resting.hash(), resting.is_stirred());
        forces.clone_from(pushes);
        limited.clone_from(status);
    }

    /// Goes back, or on, to the tick of a frame: the next step gives the bits that it gave then. Events and collisions of the
    /// last step are gone, as in a world just loaded.
    ///
    /// Errors: a frame of a world with other tables; one from bytes that no step makes. Nothing has changed then.
    pub fn restore_frame(&mut self, frame: &Frame) -> Result<(), FrameError> {
        let tick = frame.tick;
        if let Some((what, frame, world)) = frame.digests.difference(&Digests::of(self)) {
            return Err(FrameError::Tables { tick, what, frame, world });
        }
        if frame.foreign && !self.could_be_at(frame) {
            return Err(FrameError::Unsound { tick });
        }
        self.go_to(frame, None);
        Ok(())
    }

    /// Becomes what a frame and its tables say; without tables they are the world's own.
    pub(crate) fn go_to(&mut self, frame: &Frame, tables: Option<&Tables>) {
        let Frame {
            tick,
            digests: _,
            clock: _,
            motion,
            quiet,
            contacts,
            resting,
            pushes,
            status,
            asleep,
            stirred,
            foreign: _,
        } = frame;
        // Space: bodies of which what is derived is not right any more.
        let mut changed = core::mem::take(&mut self.resting.found);
        changed.clear();
        for push in self.pushes.drain(..) {
            self.drive.push_at[push.slot as usize] = u32::MAX;
        }
        let change = tables.map_or(Change::NONE, |tables| tables.copy_to(self, &mut changed));
        // The broad phase looks after what moves by itself.
        self.touch.find_displaced(|body| motion.is_elsewhere(body, &self.bodies), &mut changed);
        motion.copy_to(&mut self.bodies);
        let known = changed.len();
        self.bodies.rest.revert(quiet, self.config.sleeping.is_some(), self.bodies.cold.len(), &mut changed);
        let same = tables.is_none() && changed.len() == known;
        self.contacts.clone_from(contacts);
        let World { bodies, colliders, contacts, resting: still, .. } = self;
        still.revert((resting, *asleep), (same, *stirred), contacts, bodies, colliders);
        self.pushes.clone_from(pushes);
        change.derive(self, &changed);
        for (at, push) in self.pushes.iter().enumerate() {
            self.drive.push_at[push.slot as usize] = at as u32;
        }
        self.status.clone_from(status);
        self.tick = *tick;
        self.events.clear();
        self.solver.forget_collisions();
        self.solver.repose.clear();
        self.resting.found = changed;
    }

    /// Whether a step of this world, whose tables are those of the frame, could have come to it: what [`World::load`] asks of a save.
    fn could_be_at(&self, frame: &Frame) -> bool {
        let Frame { tick, motion, quiet, contacts, resting, pushes, status, clock, .. } = frame;
        let mut copy = self.clone();
        copy.tick = *tick;
        motion.copy_to(&mut copy.bodies);
        copy.bodies.rest = Rest::of(quiet);
        copy.contacts.clone_from(contacts);
        copy.resting.contacts.clone_from(resting);
        copy.pushes.clone_from(pushes);
        copy.status.clone_from(status);
        copy.clock_hash() == *clock && copy.bodies.check_values().is_ok() && copy.check_lists().is_ok()
    }
}

impl Frame {
    /// The tick that the world had reached.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The hash of the world's state, [`World::hash`]. Cost: one pass over what the frame holds.
    pub fn hash(&self) -> u64 {
        root(&self.parts())
    }

    /// How many bytes of memory it uses, without what is kept for larger ones.
    pub fn memory(&self) -> usize {
        let Frame { motion, quiet, contacts, resting, pushes, status, .. } = self;
        let lists = [
            motion.memory(),
            size_of_val(quiet.as_slice()),
            contacts.memory(),
            resting.memory(),
            size_of_val(pushes.as_slice()),
            size_of_val(status.entries()),
        ];
        lists.into_iter().fold(size_of::<Frame>(), usize::saturating_add)
    }

    fn parts(&self) -> [HashPart; 9] {
        let Frame { tick: _, digests, clock, motion, quiet, contacts, pushes, status, asleep, .. } = self;
        let [bodies, colliders, attractors] = digests.parts();
        let hashes = Hashes {
            clock: *clock,
            bodies,
            motion: motion.hash(),
            colliders,
            attractors,
            pushes,
            contacts: contacts.hash(),
            sleep: [hash_numbers(quiet), *asleep],
            status,
        };
        hashes.parts()
    }

    /// The frame as bytes, the same on every machine, behind what is in `bytes`: a magic, the format version of saves, the law, the fields,
    /// the state's hash, and XXH3-64 of all of these bytes. 48 bytes a body and a contact, about 200 besides.
    pub fn encode_into(&self, bytes: &mut Vec<u8>) {
        let start = bytes.len();
        header::put(bytes, header::FRAME);
        self.save(bytes);
        put(bytes, self.hash());
        let seal = hash_bytes(&bytes[start..]);
        put(bytes, seal);
    }

    /// The frame that was encoded.
    ///
    /// Errors: everything but the exact bytes of a frame of this law, by place. What is well written but no state of a world
    /// is refused by [`World::restore_frame`].
    pub fn decode(bytes: &[u8]) -> Result<Frame, DecodeError> {
        let mut reader = header::take(bytes, header::FRAME)?;
        let mut frame: Frame = Record::load(&mut reader, "frame")?;
        frame.asleep = frame.resting.hash();
        (frame.stirred, frame.foreign) = (true, true);
        let hash = reader.take("hash")?;
        let sealed = reader.offset() as usize;
        let seal = reader.take("seal")?;
        reader.finish()?;
        // The state's hash says nothing of the tick and the configuration apart.
        for (saved, computed) in [(hash, frame.hash()), (seal, hash_bytes(&bytes[..sealed]))] {
            if saved != computed {
                return Err(DecodeError::Hash { saved, computed });
            }
        }
        Ok(frame)
    }
}
