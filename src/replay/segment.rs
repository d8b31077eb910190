//! Segments: a recording split at its keyframes, so that cores verify it side by side.

use super::error::ReplayError;
use super::keyframe::Keyframe;
use super::player::{Contents, Player, Summary};
use std::io::{Read, Seek};

/// What lies between two keyframes of a replay; or the beginning, or the end.
///
/// ```
/// use tamias2d::replay::{Player, Recorder, Segment};
/// use tamias2d::{World, WorldDef};
/// let mut game = Recorder::new(World::new(&WorldDef::default())?, std::io::Cursor::new(Vec::new()))?;
/// for _ in 0..8000 {
///     game.step();
/// }
/// let file = game.finish()?;
/// let contents = Player::new(file.get_ref().as_slice())?.inspect()?;
/// let segments = Segment::of(&contents);
/// assert_eq!(segments.len(), 3); // a keyframe a minute
/// for segment in segments {
///     segment.verify(file.clone(), |_| ())?; // in any order, on any thread
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Where it begins; `None`: with the recording.
    pub from: Option<Keyframe>,
    /// Where it ends; `None`: with the recording.
    pub to: Option<Keyframe>,
}

impl Segment {
    /// The segments of a replay, in order.
    pub fn of(contents: &Contents) -> Vec<Segment> {
        let starts = core::iter::once(None).chain(contents.keyframes.iter().copied().map(Some));
        let ends = contents.keyframes.iter().copied().map(Some).chain(core::iter::once(None));
        starts.zip(ends).map(|(from, to)| Segment { from, to }).collect()
    }

    /// The same in at most so many pieces, one at least. Each piece loads a world, and who has made a file may have put a keyframe
    /// behind every tick.
    pub fn few(contents: &Contents, most: usize) -> Vec<Segment> {
        let all = Segment::of(contents);
        let run = all.len().div_ceil(most.max(1)).max(1);
        let join = |run: &[Segment]| Some(Segment { from: run.first()?.from, to: run.last()?.to });
        all.chunks(run).filter_map(join).collect()
    }

    /// The ticks before it.
    pub fn start(&self) -> u64 {
        self.from.map_or(0, |keyframe| keyframe.tick)
    }

    /// Plays it: it must end in the world that the next keyframe holds, or as the recording does. `each` gets the hash of every
    /// tick. Of the summary only the last segment's is that of the recording.
    ///
    /// Errors: as [`Player::step`]'s; ticks are counted from the start of the recording.
    pub fn verify(&self, mut input: impl Read + Seek, mut each: impl FnMut(u64)) -> Result<Summary, ReplayError> {
        let mut player = match &self.from {
            Some(keyframe) => Player::at(input, keyframe)?,
            None => {
                input.rewind().map_err(ReplayError::Io)?;
                Player::new(input)?
            }
        };
        match &self.to {
            Some(keyframe) => player.verify_to(keyframe, each)?,
            None => {
                while let Some(hash) = player.step()? {
                    each(hash);
                }
            }
        }
        Ok(player.summary())
    }
}
