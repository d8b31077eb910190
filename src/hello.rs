//! What peers tell each other before a session: whether they would compute the same.
//!
//! Two builds may differ in the arithmetic law, in formats, in the game or in the scene they begin with. Found out in the
//! middle of a match it is a desync that nobody explains, so it is asked first: each peer sends its [`Hello`], and checks
//! those it gets.

use crate::replay::REPLAY_VERSION;
use crate::snapshot::{LAW, SAVE_VERSION};
use crate::store::{Reader, hash_bytes, put};
use crate::world::World;
use core::fmt;

const MAGIC: &[u8; 8] = b"TAMIAS-H";
/// The version of the packet itself.
const VERSION: u32 = 1;

/// A peer's introduction: by which law it computes, which formats it reads, which game it is, and where it begins.
///
/// ```
/// use tamias2d::hello::Hello;
/// use tamias2d::{World, WorldDef};
///
/// const GAME: u64 = 3; // the game's own version: another rule, another number
/// let world = World::new(&WorldDef::default())?;
/// let packet = Hello::new(&world, GAME).encode();
/// // … sent, received by the other peer:
/// let theirs = Hello::decode(&packet)?;
/// Hello::new(&world, GAME).check(&theirs)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hello {
    /// The arithmetic law, [`LAW`].
    pub law: u32,
    /// The format of saved worlds, [`SAVE_VERSION`].
    pub save: u32,
    /// The format of replays, [`REPLAY_VERSION`].
    pub replay: u32,
    /// The game's own: a number that changes whenever its rules, its inputs or its transport do.
    pub game: u64,
    /// Ticks per second.
    pub tick_rate: u32,
    /// The tick of the world with which the session begins.
    pub tick: u64,
    /// The hash of that world.
    pub world: u64,
}

impl Hello {
    /// How many bytes an encoded one has.
    pub const LENGTH: usize = 60;

    /// The introduction of a peer that begins with `world`; `game` is the game's own version.
    pub fn new(world: &World, game: u64) -> Hello {
        let tick_rate = world.config().tick_rate;
        Hello {
            law: LAW,
            save: SAVE_VERSION,
            replay: REPLAY_VERSION,
            game,
            tick_rate,
            tick: world.tick(),
            world: world.hash(),
        }
    }

    /// As a packet: `TAMIAS-H`, then little-endian the packet's version, the fields in their order, and XXH3-64 of all
    /// before it.
    pub fn encode(&self) -> Vec<u8> {
        let Hello { law, save, replay, game, tick_rate, tick, world } = *self;
        let mut bytes = MAGIC.to_vec();
        for number in [VERSION, law, save, replay] {
            put(&mut bytes, number);
        }
        put(&mut bytes, game);
        put(&mut bytes, tick_rate);
        put(&mut bytes, tick);
        put(&mut bytes, world);
        let check = hash_bytes(&bytes);
        put(&mut bytes, check);
        bytes
    }

    /// Reads a packet. Errors: everything but the exact bytes of one. Another law or format is no error here: that
    /// [`Hello::check`] says, which knows both sides.
    pub fn decode(bytes: &[u8]) -> Result<Hello, HelloError> {
        if bytes.get(..MAGIC.len()) != Some(MAGIC) {
            return Err(HelloError::NotAHello);
        }
        let mut reader = Reader::new(bytes.get(MAGIC.len()..).unwrap_or(&[]));
        let damaged = |_| HelloError::Damaged;
        let found = reader.take("version").map_err(damaged)?;
        if found != VERSION {
            return Err(HelloError::Version { found, known: VERSION });
        }
        let mut hello = Hello { law: 0, save: 0, replay: 0, game: 0, tick_rate: 0, tick: 0, world: 0 };
        let Hello { law, save, replay, game, tick_rate, tick, world } = &mut hello;
        for field in [law, save, replay] {
            *field = reader.take("format").map_err(damaged)?;
        }
        *game = reader.take("game").map_err(damaged)?;
        *tick_rate = reader.take("tick rate").map_err(damaged)?;
        *tick = reader.take("tick").map_err(damaged)?;
        *world = reader.take("world").map_err(damaged)?;
        if hello.encode() != bytes {
            return Err(HelloError::Damaged);
        }
        Ok(hello)
    }

    /// Whether a peer that introduces itself so computes what this one does. Errors: the first thing in which they differ,
    /// the most basic one first.
    pub fn check(&self, theirs: &Hello) -> Result<(), HelloError> {
        let differ = |what, ours: u64, theirs: u64| {
            if ours == theirs { Ok(()) } else { Err(HelloError::Differs { what, ours, theirs }) }
        };
        differ(Term::Law, self.law.into(), theirs.law.into())?;
        differ(Term::Save, self.save.into(), theirs.save.into())?;
        differ(Term::Replay, self.replay.into(), theirs.replay.into())?;
        differ(Term::Game, self.game, theirs.game)?;
        differ(Term::TickRate, self.tick_rate.into(), theirs.tick_rate.into())?;
        differ(Term::Tick, self.tick, theirs.tick)?;
        differ(Term::Scene, self.world, theirs.world)
    }
}

/// In what peers must agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Term {
    /// The arithmetic law.
    Law,
    /// The format of saved worlds.
    Save,
    /// The format of replays.
    Replay,
    /// The game's own version.
    Game,
    /// Ticks per second.
    TickRate,
    /// The tick at which the session begins.
    Tick,
    /// The world with which it begins.
    Scene,
}

/// Why there is no session with a peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HelloError {
    /// The bytes are no introduction.
    NotAHello,
    /// They were one, and are damaged.
    Damaged,
    /// An introduction of another version.
    Version {
        /// The version found.
        found: u32,
        /// The version this build reads.
        known: u32,
    },
    /// The peers would not compute the same, or not understand each other.
    Differs {
        /// In what.
        what: Term,
        /// What this peer has.
        ours: u64,
        /// What the other one has.
        theirs: u64,
    },
}

impl fmt::Display for HelloError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            HelloError::NotAHello => f.write_str(
                "the packet is no hello of tamias2d: the peer is another program, or one that sends its packets of play first",
            ),
            HelloError::Damaged => f.write_str("the hello is damaged: have it sent again"),
            HelloError::Version { found, known } => write!(
                f,
                "the peer's hello is of version {found}, this build reads version {known}: give both the same release of the game"
            ),
            HelloError::Differs { what, ours, theirs } => match what {
                Term::Law => write!(
                    f,
                    "the peer computes by arithmetic law {theirs}, this build by law {ours}: their worlds would part; give both the same release of the game"
                ),
                Term::Save => write!(
                    f,
                    "the peer saves worlds in format version {theirs}, this build in version {ours}: give both the same release of the game"
                ),
                Term::Replay => write!(
                    f,
                    "the peer records replays in format version {theirs}, this build in version {ours}: give both the same release of the game"
                ),
                Term::Game => write!(
                    f,
                    "the peer plays version {theirs} of the game, this is version {ours}: update the older one"
                ),
                Term::TickRate => write!(
                    f,
                    "the peer's world has {theirs} ticks per second, this one {ours}: begin with the same scene"
                ),
                Term::Tick => write!(
                    f,
                    "the peer begins at tick {theirs}, this one at tick {ours}: take a snapshot of the running match, or begin anew together"
                ),
                Term::Scene => write!(
                    f,
                    "the peer begins with world {theirs:016x}, this one with {ours:016x}: load the same scene, or take its snapshot"
                ),
            },
        }
    }
}

impl core::error::Error for HelloError {}
