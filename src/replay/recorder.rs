//! Recording: a world, and a file of everything that is done to it.

use super::evidence::Evidence;
use super::flight::Flight;
use super::format::{RecordWriter, tag};
use super::keyframe::{Head, Keyframe, States, encode_index, history};
use crate::World;
use crate::store::{Record, put};
use crate::threads::Threads;
use crate::world::{Command, CommandError, Commands, Reply};
use std::io::{self, Write};

/// What a recording holds besides commands and hashes. The default is for games that are recorded all the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recording {
    /// So many seconds lie between keyframes, from which it can be played without what comes before; 0 for none. 60 by default.
    pub keyframe_seconds: u32,
    /// So many ticks lie between hashes of the state's parts; 0 for none. 60 by default.
    pub parts_ticks: u32,
    /// Of so many last ticks evidence is held in memory, for [`Recorder::alarm`]; 0, the default, for none: a tick of 100
    /// bodies in a pile takes 2.7 ms with it instead of 0.2.
    pub flight_ticks: u32,
}

impl Default for Recording {
    fn default() -> Self {
        Recording { keyframe_seconds: 60, parts_ticks: 60, flight_ticks: 0 }
    }
}

/// A world whose commands and ticks are recorded.
///
/// It owns the world, so nothing reaches it unrecorded: commands go through [`Commands`], ticks through
/// [`Recorder::step`]. Dropped without [`Recorder::finish`], it leaves a file that is cut off but plays.
///
/// ```
/// use tamias2d::replay::{Player, Recorder};
/// use tamias2d::{BodyDef, Commands, Vec2, World, WorldDef};
///
/// let mut game = Recorder::new(World::new(&WorldDef::default())?, Vec::new())?;
/// let ship = game.create_body(&BodyDef::default())?;
/// for _ in 0..10 {
///     game.input(b"thrust".to_vec())?;
///     game.apply_force(ship, Vec2::from_f64(3.0, 0.0)?, None)?;
///     game.step();
/// }
/// let file = game.finish()?;
/// let played = Player::new(file.as_slice())?.verify()?;
/// assert_eq!(played.ticks, 10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Recorder<W> {
    pub(super) world: World,
    writer: RecordWriter<W>,
    /// The commands since the last tick, encoded after room for a hash.
    pending: Vec<u8>,
    ticks: u64,
    commands: u64,
    history: u64,
    options: Recording,
    states: States,
    keyframes: Vec<Keyframe>,
    flight: Option<Flight>,
    threads: Threads,
    /// The first tick at which memory did not hold what it had been given.
    fault: Option<u64>,
    scratch: Vec<u8>,
    /// The first error of the destination; nothing is written after it.
    error: Option<io::Error>,
}

/// Room for the hash in front of a tick's commands.
const HASH: usize = 8;

impl<W: Write> Recorder<W> {
    /// Starts a recording at the world's present state.
    ///
    /// `out` gets a small write per tick: give it a `BufWriter`. Errors: those of writing.
    pub fn new(world: World, out: W) -> io::Result<Self> {
        Recorder::with(world, out, Recording::default())
    }

    /// As [`Recorder::new`], and says what is recorded besides commands and hashes.
    pub fn with(world: World, out: W, options: Recording) -> io::Result<Self> {
        let mut writer = RecordWriter::new(out, world.config().tick_rate)?;
        let (place, _) = writer.place();
        writer.record(tag::WORLD, &world.save())?;
        let mut states = States::default();
        states.resume(&world, place);
        Ok(Recorder {
            history: world.hash(),
            world,
            writer,
            pending: vec![0; HASH],
            ticks: 0,
            commands: 0,
            options,
            states,
            keyframes: Vec::new(),
            flight: (options.flight_ticks > 0).then(|| Flight::new(options.flight_ticks)),
            threads: Threads::default(),
            fault: None,
            scratch: Vec::new(),
            error: None,
        })
    }

    /// The world, to look at.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Has these threads step the world from now on. The recording is the same, to the byte.
    pub fn use_threads(&mut self, threads: &Threads) {
        self.threads = threads.clone();
    }

    /// Advances the world by one tick and records it.
    ///
    /// Never fails: where writing does, the simulation goes on, and [`Recorder::error`] and [`Recorder::finish`]
    /// say so.
    pub fn step(&mut self) {
        match &mut self.flight {
            Some(flight) => flight.step_on(&mut self.world, &self.threads),
            None => self.world.step_on(&self.threads),
        }
        self.ticks = self.ticks.saturating_add(1);
        self.write(if self.pending.len() == HASH { tag::IDLE } else { tag::TICK });
        let due = |every: u64| self.ticks.checked_rem(every) == Some(0);
        let rate = u64::from(self.world.config().tick_rate);
        let keyframe = due(u64::from(self.options.keyframe_seconds).saturating_mul(rate));
        if keyframe || due(self.options.parts_ticks.into()) {
            self.write_parts(keyframe);
        }
        if keyframe && self.fault.is_none() {
            self.write_keyframe();
        }
    }

    /// Writes what happened since the last record under `tag`.
    fn write(&mut self, tag: u8) {
        self.pending[..HASH].copy_from_slice(&self.world.hash().to_le_bytes());
        self.history = history(self.history, &self.pending);
        let pending = core::mem::take(&mut self.pending);
        self.record(tag, &pending);
        self.pending = pending;
        self.pending.truncate(HASH);
    }

    fn record(&mut self, tag: u8, payload: &[u8]) {
        if self.error.is_none() {
            self.error = self.writer.record(tag, payload).err();
        }
    }

    /// Writes the hashes of the state's parts; at keyframes as memory holds them now, and an alarm if that is not what it was given.
    fn write_parts(&mut self, afresh: bool) {
        let kept = self.world.hash_parts();
        let parts = if afresh { self.world.hash_parts_afresh() } else { kept };
        let mut payload = core::mem::take(&mut self.scratch);
        payload.clear();
        for part in &parts {
            put(&mut payload, part.hash);
        }
        self.record(tag::PARTS, &payload);
        self.scratch = payload;
        if parts != kept && self.fault.is_none() {
            self.fault = Some(self.world.tick());
            let evidence = Evidence::of_state(&self.world).encode();
            self.record(tag::EVIDENCE, &evidence);
        }
    }

    fn write_keyframe(&mut self) {
        let (offset, chain) = self.writer.place();
        let base = self.states.base(&self.world).unwrap_or(offset);
        let head = Head { tick: self.ticks, commands: self.commands, history: self.history, chain, base };
        let mut payload = core::mem::take(&mut self.scratch);
        payload.clear();
        head.write(&mut payload);
        payload.extend_from_slice(self.states.write(&self.world, offset, base));
        self.record(tag::KEYFRAME, &payload);
        self.scratch = payload;
        if self.error.is_none() {
            self.keyframes.push(Keyframe { tick: self.ticks, offset, history: self.history });
        }
    }

    /// An alarm rang: another machine has another hash at this tick of the world (that after its step). Appends what is held of
    /// the tick and of the one before. Whether it is still held; without [`Recording::flight_ticks`] nothing is.
    pub fn alarm(&mut self, tick: u64) -> bool {
        let Some(flight) = &self.flight else { return false };
        let of = |tick: u64| flight.evidence(tick).map(Evidence::encode);
        let (before, at) = (tick.checked_sub(1).and_then(of), of(tick));
        let held = at.is_some();
        for evidence in [before, at].into_iter().flatten() {
            self.record(tag::EVIDENCE, &evidence);
        }
        held
    }

    /// What is held of the last ticks.
    pub fn flight(&self) -> Option<&Flight> {
        self.flight.as_ref()
    }

    /// The first tick of the world at which memory was seen to hold something else than it was given. Looked for at keyframes; from
    /// then on there are none.
    pub fn fault(&self) -> Option<u64> {
        self.fault
    }

    /// The first error of writing, if there was one; the file ends there.
    pub fn error(&self) -> Option<&io::Error> {
        self.error.as_ref()
    }

    /// Ends the recording. Commands after the last tick are recorded without one. Errors: the first of writing.
    pub fn finish(mut self) -> io::Result<W> {
        if self.pending.len() > HASH {
            self.write(tag::TAIL);
        }
        let mut place = 0;
        if !self.keyframes.is_empty() && self.error.is_none() {
            let (offset, chain) = self.writer.place();
            place = offset;
            let index = encode_index(chain, &self.keyframes);
            self.record(tag::INDEX, &index);
        }
        match self.error {
            Some(error) => Err(error),
            None => self.writer.end(self.ticks, place),
        }
    }
}

impl<W: Write> Commands for Recorder<W> {
    fn apply(&mut self, command: Command) -> Result<Reply, CommandError> {
        let length = self.pending.len();
        command.save(&mut self.pending);
        let reply = self.world.apply(command);
        if reply.is_err() {
            self.pending.truncate(length);
        } else {
            self.commands = self.commands.saturating_add(1);
        }
        reply
    }
}
