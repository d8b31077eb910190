//! The words in which a sweep over eight contacts side by side is written, whatever instructions a processor has for them.
//!
//! A set of words is a type whose values exist only where its instructions do; for plain arrays (`plain.rs`) there are words
//! of two lanes, which a loop says four times. What a word means is said here once; the definition, of which all sets give the
//! bits, is [`Block::solve`](super::rows::Block::solve).

use super::mover::Mover;
use super::rows::{LANES, Lane};

/// A set of words.
pub(super) trait Words: Copy {
    /// Eight numbers of 32 bits.
    type Narrow: Narrow<Self>;
    /// Eight numbers of 64 bits.
    type Wide: Wide<Self>;
    /// Eight numbers of 32 bits where products want them.
    type Factor: Factor<Self>;
    /// Yes or no, eight times.
    type Mask: Mask<Self>;

    fn narrow(self, value: i32) -> Self::Narrow;
    fn wide(self, value: i64) -> Self::Wide;
    fn load(self, lane: &Lane) -> Self::Narrow;
    fn store(self, narrow: Self::Narrow, lane: &mut Lane);

    #[inline(always)]
    fn factor(self, lane: &Lane) -> Self::Factor {
        self.load(lane).factor()
    }

    /// Velocities limited to ±2⁵⁷: [`held`](crate::num::lane::held).
    fn held(self, eight: Eight<Self>) -> Eight<Self>;
}

/// Words of all eight lanes: they reach bodies in any order, and say yes or no.
pub(super) trait Reach: Words {
    /// Those of eight contacts that are to be solved: their bits are set, and their bodies are two.
    fn chosen(self, bodies: &[[u32; LANES]; 2], lanes: u8) -> Self::Mask;

    /// The movers at these places.
    fn gather(self, movers: &[Mover], places: &[u32; LANES]) -> Eight<Self>;

    /// Puts them back. Of places that are equal one wins.
    fn scatter(self, eight: Eight<Self>, movers: &mut [Mover], places: &[u32; LANES]);

    /// How far those at these places have gone, x and y.
    fn ways(self, movers: &[Mover], places: &[u32; LANES]) -> [Self::Factor; 2];

    /// Whether any bit is set.
    fn any(self, narrow: Self::Narrow) -> bool;

    /// By lane, from the lowest bit.
    fn bits(self, mask: Self::Mask) -> u8;
}

/// Eight movers.
#[derive(Clone, Copy)]
pub(super) struct Eight<K: Words> {
    pub(super) v: [K::Wide; 2],
    pub(super) w: K::Wide,
    pub(super) phi: K::Wide,
}

pub(super) trait Narrow<K: Words>: Copy {
    fn factor(self) -> K::Factor;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn abs(self) -> Self;
    /// Divided by 2^SHIFT, rounded down.
    fn shifted<const SHIFT: i32>(self) -> Self;
    fn or(self, other: Self) -> Self;
    /// Where it is greater.
    fn above(self, other: Self) -> K::Mask;
}

pub(super) trait Factor<K: Words>: Copy {
    /// The exact products.
    fn mul(self, other: Self) -> K::Wide;
    fn narrow(self) -> K::Narrow;
}

pub(super) trait Wide<K: Words>: Copy {
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// Where it is greater.
    fn above(self, other: Self) -> K::Mask;
    /// The lower halves.
    fn low(self) -> K::Factor;
    /// Divided by 2^SHIFT, rounded down.
    fn shifted<const SHIFT: i32>(self, words: K) -> Self;
    /// `self + 2^(SHIFT−1)`, and one less of what is negative: shifting that rounds to nearest and odd.
    fn half<const SHIFT: i32>(self, words: K) -> Self;
    /// `self / 2^SHIFT` to nearest and odd, if it fits 32 bits.
    fn round<const SHIFT: i32>(self, words: K) -> K::Factor;
    /// `self / 2^28` rounded down, limited to ±2³⁰.
    fn limited(self, words: K) -> K::Narrow;

    /// `self / 2^28` to nearest and odd, limited to ±2³⁰.
    #[inline(always)]
    fn round_limited(self, words: K) -> K::Narrow {
        self.half::<28>(words).limited(words)
    }
}

pub(super) trait Mask<K: Words>: Copy {
    fn and(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self;
    /// Where it is set `yes`, else `no`.
    fn pick(self, yes: K::Narrow, no: K::Narrow) -> K::Narrow;
}
