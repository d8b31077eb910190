//! Evidence: what memory held before a tick, after each stage of it, and after it.
//!
//! A divergence that comes from memory, a compiler or a machine is not in the log of commands, and computing the tick again
//! does not show it. What was taken as it happened does: [`Flight`](super::Flight) keeps it for the last ticks.

use crate::World;
use crate::solver::Substep;
use crate::store::{DecodeError, Draft, Reader, Sheet, Tables, hash_bytes, put, put_count, put_text, take_text};
use crate::threads::Threads;
use crate::world::{Stage, Watch};
use core::ops::Range;

/// The format version of evidence.
pub const EVIDENCE_VERSION: u32 = 1;
const MAGIC: &[u8; 8] = b"TAMIAS-E";

/// A tick has at most so many moments, 10 attempts of 64 substeps and a dozen stages, and a moment so many tables: what claims more
/// would only be slow to read.
const MOMENTS: usize = 1024;
const TABLES: usize = 64;

/// How evidence came to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// Taken from memory while the tick happened.
    #[default]
    Taken,
    /// Of the same tick computed again, from a recording: it shows what this build makes of it, no fault of memory.
    Recomputed,
}

/// A table of a moment: its digest, and where its bytes are among the blobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    digest: u64,
    blob: u32,
}

/// A moment of the tick: after a stage, or after a substep of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Moment {
    stage: Stage,
    /// A substep from 1 on; 0 for the stage itself.
    substep: u32,
    /// Its tables end here among the parts.
    end: u32,
}

/// What memory held before a tick, after each stage, and after it.
///
/// ```
/// use tamias2d::replay::Evidence;
/// use tamias2d::{World, WorldDef};
/// let mut world = World::new(&WorldDef::default())?;
/// let evidence = Evidence::of_step(&mut world);
/// assert_eq!((evidence.tick(), world.tick()), (1, 1));
/// assert!(evidence.first_difference(&Evidence::decode(&evidence.encode())?)?.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evidence {
    tick: u64,
    hash: u64,
    origin: Origin,
    build: String,
    /// Saves; the one after is empty for evidence of a state without its tick.
    before: Vec<u8>,
    after: Vec<u8>,
    /// The bytes of all tables, each distinct one once.
    bytes: Vec<u8>,
    blobs: Vec<Range<usize>>,
    parts: Vec<Part>,
    moments: Vec<Moment>,
}

/// What computed it, for people.
fn build() -> String {
    let endian = if cfg!(target_endian = "little") { "little" } else { "big" };
    let profile = if cfg!(debug_assertions) { "with assertions" } else { "optimised" };
    format!("tamias2d {} {} {endian}-endian {profile}", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH)
}

impl Evidence {
    /// Advances the world by one tick, as [`World::step`], and keeps what memory holds meanwhile.
    pub fn of_step(world: &mut World) -> Evidence {
        let mut evidence = Evidence::default();
        evidence.take(world, &mut Draft::default(), Origin::Recomputed, &Threads::default());
        evidence
    }

    /// What memory holds now; its tick is that of the world.
    pub fn of_state(world: &World) -> Evidence {
        let mut evidence = Evidence { origin: Origin::Taken, ..Evidence::default() };
        evidence.clear(world);
        (evidence.tick, evidence.hash) = (world.tick(), world.hash());
        evidence.note(Stage::Begin, 0, |tables| world.show(Stage::Begin, &mut Draft::default(), tables));
        evidence
    }

    /// Steps the world and keeps the tick, in the memory that this has.
    pub(super) fn take(&mut self, world: &mut World, draft: &mut Draft, origin: Origin, threads: &Threads) {
        self.begin(world, draft, origin);
        threads.work(world.effort(), |crew| world.step_through(&mut Taker { evidence: self, draft }, crew));
        (self.tick, self.hash) = (world.tick(), world.hash());
        world.save_into(&mut self.after);
    }

    /// Keeps what memory holds before the tick.
    pub(super) fn begin(&mut self, world: &World, draft: &mut Draft, origin: Origin) {
        self.clear(world);
        self.origin = origin;
        self.note(Stage::Begin, 0, |tables| world.show(Stage::Begin, draft, tables));
    }

    fn clear(&mut self, world: &World) {
        if self.build.is_empty() {
            self.build = build();
        }
        world.save_into(&mut self.before);
        self.after.clear();
        self.bytes.clear();
        self.blobs.clear();
        self.parts.clear();
        self.moments.clear();
    }

    /// Notes the tables of a moment; those that are as they last were, only by reference.
    fn note(&mut self, stage: Stage, substep: u32, show: impl FnOnce(&mut Noted<'_>)) {
        let Evidence { bytes, blobs, parts, .. } = self;
        show(&mut Noted { bytes, blobs, parts });
        let end = self.parts.len() as u32;
        self.moments.push(Moment { stage, substep, end });
    }

    /// The tick, as the world counts them: that after its step.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The hash of the state after it.
    pub fn hash(&self) -> u64 {
        self.hash
    }

    /// How it came to be.
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// What computed it: version, processor, profile.
    pub fn build(&self) -> &str {
        &self.build
    }

    /// The world before the tick, after its commands, as a save; what a fault has damaged may not load.
    pub fn before(&self) -> &[u8] {
        &self.before
    }

    /// The world after the tick, as a save; empty for evidence of a state alone.
    pub fn after(&self) -> &[u8] {
        &self.after
    }

    /// Whether it is of a state alone, without its tick.
    pub fn is_of_state(&self) -> bool {
        self.after.is_empty()
    }

    /// The end of its tick alone: what memory held after it.
    pub fn ending(&self) -> Evidence {
        let mut last = Evidence { moments: Vec::new(), parts: Vec::new(), after: Vec::new(), ..self.clone() };
        if !self.is_of_state() {
            last.before.clone_from(&self.after);
        }
        let start =
            self.moments.len().checked_sub(2).and_then(|at| self.moments.get(at)).map_or(0, |moment| moment.end);
        last.parts.extend_from_slice(&self.parts[start as usize..]);
        last.moments.push(Moment { stage: Stage::Begin, substep: 0, end: last.parts.len() as u32 });
        last
    }

    /// The tables of a moment, in order: digest and bytes.
    fn tables(&self, moment: usize) -> impl Iterator<Item = (u64, &[u8])> + '_ {
        let start = moment.checked_sub(1).and_then(|at| self.moments.get(at)).map_or(0, |moment| moment.end);
        let end = self.moments.get(moment).map_or(start, |moment| moment.end);
        let parts = &self.parts[start as usize..end as usize];
        parts.iter().map(|part| (part.digest, &self.bytes[self.blobs[part.blob as usize].clone()]))
    }

    /// How many moments there are.
    pub(super) fn count(&self) -> usize {
        self.moments.len()
    }

    pub(super) fn moment(&self, at: usize) -> Option<(Stage, u32)> {
        self.moments.get(at).map(|moment| (moment.stage, moment.substep))
    }

    /// The digests of the tables of a moment, each with the table's name.
    pub(super) fn sheets(&self, moment: usize) -> Result<Vec<(u64, Sheet<'_>)>, DecodeError> {
        self.tables(moment).map(|(digest, bytes)| Ok((digest, Sheet::read(bytes)?))).collect()
    }

    /// The same, without reading more of a table than its name.
    pub(super) fn titles(&self, moment: usize) -> Result<Vec<(u64, String)>, DecodeError> {
        let title = |bytes: &[u8]| take_text(&mut Reader::new(bytes), "table's name");
        self.tables(moment).map(|(digest, bytes)| Ok((digest, title(bytes)?))).collect()
    }

    /// Whether a moment has the same tables as one of another evidence.
    pub(super) fn agrees(&self, other: &Evidence, moment: usize) -> bool {
        let digests = |evidence: &Evidence| evidence.tables(moment).map(|(digest, _)| digest).collect::<Vec<_>>();
        self.moment(moment) == other.moment(moment) && digests(self) == digests(other)
    }

    /// As a file, or as a record's payload; `replays/FORMAT.md` has the bytes.
    pub fn encode(&self) -> Vec<u8> {
        let Evidence { tick, hash, origin, build, before, after, bytes, blobs, parts, moments } = self;
        let mut file = MAGIC.to_vec();
        put(&mut file, EVIDENCE_VERSION);
        put(&mut file, crate::LAW);
        put(&mut file, *tick);
        put(&mut file, *hash);
        put(&mut file, matches!(origin, Origin::Recomputed) as u8);
        put_text(&mut file, build);
        for save in [before, after] {
            put_count(&mut file, save.len());
            file.extend_from_slice(save);
        }
        put_count(&mut file, blobs.len());
        for blob in blobs {
            put_count(&mut file, blob.len());
            file.extend_from_slice(&bytes[blob.clone()]);
        }
        put_count(&mut file, moments.len());
        let mut start = 0;
        for Moment { stage, substep, end } in moments {
            put(&mut file, stage.number());
            put(&mut file, *substep);
            let own = &parts[start as usize..*end as usize];
            put_count(&mut file, own.len());
            for Part { digest, blob } in own {
                put(&mut file, *digest);
                put(&mut file, *blob);
            }
            start = *end;
        }
        let check = hash_bytes(&file);
        put(&mut file, check);
        file
    }

    /// Evidence from its bytes. Errors: everything but the exact bytes of evidence under this law, by place; the memory used is
    /// bounded by the bytes given.
    pub fn decode(file: &[u8]) -> Result<Evidence, DecodeError> {
        let mut reader = Reader::new(file);
        if reader.take_bytes(MAGIC.len(), "magic").ok() != Some(MAGIC) {
            return Err(reader.invalid(0, "magic", "is not that of evidence"));
        }
        let found = reader.take("format version")?;
        if found != EVIDENCE_VERSION {
            return Err(DecodeError::Version { found, known: EVIDENCE_VERSION });
        }
        let found = reader.take("arithmetic law")?;
        if found != crate::LAW {
            return Err(DecodeError::Law { found, known: crate::LAW });
        }
        // Before anything is believed.
        let Some((body, check)) = file.split_last_chunk::<8>() else {
            return Err(DecodeError::Truncated { offset: reader.offset(), field: "hash" });
        };
        let (saved, computed) = (u64::from_le_bytes(*check), hash_bytes(body));
        if saved != computed {
            return Err(DecodeError::Hash { saved, computed });
        }
        let mut evidence = Evidence { tick: reader.take("tick")?, hash: reader.take("hash")?, ..Evidence::default() };
        let offset = reader.offset();
        evidence.origin = match reader.take::<u8>("origin")? {
            0 => Origin::Taken,
            1 => Origin::Recomputed,
            _ => return Err(reader.invalid(offset, "origin", "is none")),
        };
        evidence.build = take_text(&mut reader, "build")?;
        for save in [&mut evidence.before, &mut evidence.after] {
            let length = reader.take_count(1, "save")?;
            save.extend_from_slice(reader.take_bytes(length, "save")?);
        }
        let blobs = reader.take_count(4, "tables")?;
        for _ in 0..blobs {
            let length = reader.take_count(1, "table")?;
            let start = evidence.bytes.len();
            evidence.bytes.extend_from_slice(reader.take_bytes(length, "table")?);
            evidence.blobs.push(start..evidence.bytes.len());
        }
        evidence.take_moments(&mut reader)?;
        reader.take::<u64>("hash")?;
        reader.finish()?;
        Ok(evidence)
    }

    fn take_moments(&mut self, reader: &mut Reader<'_>) -> Result<(), DecodeError> {
        let digests: Vec<u64> = self.blobs.iter().map(|blob| hash_bytes(&self.bytes[blob.clone()])).collect();
        let offset = reader.offset();
        let moments = reader.take_count(9, "moments")?;
        if moments > MOMENTS {
            return Err(reader.invalid(offset, "moments", "are more than a tick has"));
        }
        for _ in 0..moments {
            let offset = reader.offset();
            let first = self.parts.len();
            let stage = Stage::of(reader.take("stage")?).ok_or(reader.invalid(offset, "stage", "is none"))?;
            let substep = reader.take("substep")?;
            for _ in 0..reader.take_count(12, "parts")? {
                let offset = reader.offset();
                let part = Part { digest: reader.take("digest")?, blob: reader.take("table's number")? };
                if digests.get(part.blob as usize) != Some(&part.digest) {
                    return Err(reader.invalid(offset, "part", "is not the table that it names"));
                }
                if self.parts.len().saturating_sub(first) >= TABLES || self.parts[first..].contains(&part) {
                    return Err(reader.invalid(offset, "part", "is one too many"));
                }
                self.parts.push(part);
            }
            self.moments.push(Moment { stage, substep, end: self.parts.len() as u32 });
        }
        Ok(())
    }
}

/// Looks at a tick from inside, and keeps it.
pub(super) struct Taker<'t> {
    pub(super) evidence: &'t mut Evidence,
    pub(super) draft: &'t mut Draft,
}

impl Watch for Taker<'_> {
    fn stage(&mut self, stage: Stage, world: &mut World) {
        self.evidence.note(stage, 0, |tables| world.show(stage, self.draft, tables));
    }

    fn substep(&mut self, at: u32, substep: Substep<'_>) {
        self.evidence.note(Stage::Solve, at, |tables| substep.show(self.draft, tables));
    }
}

/// Where the tables of a moment go.
struct Noted<'e> {
    bytes: &'e mut Vec<u8>,
    blobs: &'e mut Vec<Range<usize>>,
    parts: &'e mut Vec<Part>,
}

impl Tables for Noted<'_> {
    fn table(&mut self, _: &'static str, bytes: &[u8]) {
        let digest = hash_bytes(bytes);
        // Most tables are as they were; those that change do so a few times, so that looking from the end on is short.
        let known = self.parts.iter().rev().find(|part| part.digest == digest).map(|part| part.blob);
        let blob = known.unwrap_or_else(|| {
            let start = self.bytes.len();
            self.bytes.extend_from_slice(bytes);
            self.blobs.push(start..self.bytes.len());
            self.blobs.len().saturating_sub(1) as u32
        });
        self.parts.push(Part { digest, blob });
    }
}
