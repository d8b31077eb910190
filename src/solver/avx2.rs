//! Eight lanes side by side in AVX2's instructions: the words that `sweep` is written in.
//!
//! One of the two files with `unsafe`: all of it are instructions that a processor may not have, behind values that exist only
//! where it has them. Products of 32 bits with 64-bit sums go four at a time, the even lanes and the odd ones.
#![allow(unsafe_code, reason = "instructions that the processor was asked for, see `Avx2`")]

use core::arch::x86_64::*;

use super::mover::Mover;
use super::prepare::Joints;
use super::rows::{Block, LANES, Lane};
use super::scales::Scales;
use super::sweep;
use super::words::{self, Eight, Factor as _, Mask as _, Narrow as _, Reach, Wide as _, Words};

/// That this processor has AVX2. Of it come all values of the types below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

/// Eight numbers of 32 bits, in order.
#[derive(Clone, Copy)]
pub(super) struct Narrow(__m256i);

/// Eight numbers of 64 bits: lanes 0, 2, 4, 6 and lanes 1, 3, 5, 7.
#[derive(Clone, Copy)]
pub(super) struct Wide(__m256i, __m256i);

/// Eight numbers of 32 bits where products want them: in the lower halves of [`Wide`]; the upper ones mean nothing.
#[derive(Clone, Copy)]
pub(super) struct Factor(__m256i, __m256i);

/// All bits of the chosen of eight lanes of 32 bits.
#[derive(Clone, Copy)]
pub(super) struct Mask(__m256i);

/// A vector of one instruction each. Sound because [`Narrow`], [`Wide`], [`Factor`] and [`Mask`] exist only where there is AVX2.
macro_rules! vector {
    ($($call:tt)*) => {{
        // SAFETY: the processor has AVX2: an operand, or an `Avx2`, says so. Pointers come from references to as much.
        unsafe { $($call)* }
    }};
}

impl Avx2 {
    /// If the processor has it.
    pub(crate) fn detect() -> Option<Avx2> {
        std::arch::is_x86_feature_detected!("avx2").then_some(Avx2(()))
    }

    /// One sweep over a block, see [`sweep::sweep`].
    #[inline]
    pub(super) fn sweep<const BIASED: bool, const FRICTION: bool>(
        self,
        block: &mut Block,
        lanes: u8,
        movers: &mut [Mover],
        scales: &Scales,
    ) -> (u8, u8) {
        #[target_feature(enable = "avx2")]
        unsafe fn with_avx2<const BIASED: bool, const FRICTION: bool>(
            avx2: Avx2,
            block: &mut Block,
            lanes: u8,
            movers: &mut [Mover],
            scales: &Scales,
        ) -> (u8, u8) {
            sweep::sweep::<_, BIASED, FRICTION>(avx2, block, lanes, movers, scales)
        }
        // SAFETY: `self` says that the processor has AVX2.
        unsafe { with_avx2::<BIASED, FRICTION>(self, block, lanes, movers, scales) }
    }

    /// The rows of eight contacts, see [`Joints::write`].
    #[inline]
    pub(super) fn prepare(self, joints: &Joints, block: &mut Block, shift: u32) -> u8 {
        #[target_feature(enable = "avx2")]
        unsafe fn with_avx2(joints: &Joints, block: &mut Block, shift: u32) -> u8 {
            joints.write(block, shift)
        }
        // SAFETY: `self` says that the processor has AVX2.
        unsafe { with_avx2(joints, block, shift) }
    }

    /// Last tick's impulses, see [`sweep::warm_start`].
    #[inline]
    pub(super) fn warm_start(self, block: &Block, movers: &mut [Mover]) {
        #[target_feature(enable = "avx2")]
        unsafe fn with_avx2(avx2: Avx2, block: &Block, movers: &mut [Mover]) {
            sweep::warm_start(avx2, block, movers);
        }
        // SAFETY: `self` says that the processor has AVX2.
        unsafe { with_avx2(self, block, movers) }
    }
}

impl Words for Avx2 {
    type Narrow = Narrow;
    type Wide = Wide;
    type Factor = Factor;
    type Mask = Mask;

    #[inline(always)]
    fn narrow(self, value: i32) -> Narrow {
        Narrow(vector!(_mm256_set1_epi32(value)))
    }

    #[inline(always)]
    fn wide(self, value: i64) -> Wide {
        let all = vector!(_mm256_set1_epi64x(value));
        Wide(all, all)
    }

    #[inline(always)]
    fn load(self, lane: &Lane) -> Narrow {
        Narrow(vector!(_mm256_loadu_si256(lane.as_ptr().cast())))
    }

    #[inline(always)]
    fn store(self, narrow: Narrow, lane: &mut Lane) {
        vector!(_mm256_storeu_si256(lane.as_mut_ptr().cast(), narrow.0));
    }

    #[inline(always)]
    fn held(self, eight: Eight<Avx2>) -> Eight<Avx2> {
        let [least, most] = [self.wide(-(1 << 57)), self.wide(1 << 57)];
        let Eight { v: [x, y], w, phi } = eight;
        let over = x.add(most).or(y.add(most)).or(w.add(most)).down::<58>();
        if !self.any(over.low().narrow()) {
            return eight;
        }
        // Nearly never.
        let within = |speed: Wide| speed.min(most).max(least);
        Eight { v: [within(x), within(y)], w: within(w), phi }
    }
}

impl Reach for Avx2 {
    #[inline(always)]
    fn chosen(self, bodies: &[[u32; LANES]; 2], lanes: u8) -> Mask {
        let bits = vector!(_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128));
        let a = vector!(_mm256_loadu_si256(bodies[0].as_ptr().cast()));
        let b = vector!(_mm256_loadu_si256(bodies[1].as_ptr().cast()));
        let same = vector!(_mm256_cmpeq_epi32(a, b));
        let set = vector!(_mm256_cmpeq_epi32(_mm256_and_si256(self.narrow(lanes.into()).0, bits), bits));
        Mask(vector!(_mm256_andnot_si256(same, set)))
    }

    #[inline(always)]
    fn gather(self, movers: &[Mover], [a, b, c, d, e, f, g, h]: &[u32; LANES]) -> Eight<Avx2> {
        let even = [self.first(movers, a), self.first(movers, c), self.first(movers, e), self.first(movers, g)];
        let odd = [self.first(movers, b), self.first(movers, d), self.first(movers, f), self.first(movers, h)];
        let [even, odd] = [turned(even), turned(odd)];
        Eight {
            v: [Wide(even[0], odd[0]), Wide(even[1], odd[1])],
            w: Wide(even[2], odd[2]),
            phi: Wide(even[3], odd[3]),
        }
    }

    #[inline(always)]
    fn scatter(self, eight: Eight<Avx2>, movers: &mut [Mover], [a, b, c, d, e, f, g, h]: &[u32; LANES]) {
        let Eight { v: [x, y], w, phi } = eight;
        let even = turned([x.0, y.0, w.0, phi.0]);
        let odd = turned([x.1, y.1, w.1, phi.1]);
        set_first(movers, a, even[0]);
        set_first(movers, b, odd[0]);
        set_first(movers, c, even[1]);
        set_first(movers, d, odd[1]);
        set_first(movers, e, even[2]);
        set_first(movers, f, odd[2]);
        set_first(movers, g, even[3]);
        set_first(movers, h, odd[3]);
    }

    #[inline(always)]
    fn ways(self, movers: &[Mover], [a, b, c, d, e, f, g, h]: &[u32; LANES]) -> [Factor; 2] {
        let even = vector!(_mm256_setr_epi64x(way(movers, a), way(movers, c), way(movers, e), way(movers, g)));
        let odd = vector!(_mm256_setr_epi64x(way(movers, b), way(movers, d), way(movers, f), way(movers, h)));
        let both = Wide(even, odd);
        [Factor(even, odd), both.down::<32>().low()]
    }

    #[inline(always)]
    fn any(self, narrow: Narrow) -> bool {
        vector!(_mm256_testz_si256(narrow.0, narrow.0)) == 0
    }

    #[inline(always)]
    fn bits(self, mask: Mask) -> u8 {
        vector!(_mm256_movemask_ps(_mm256_castsi256_ps(mask.0))) as u8
    }
}

impl words::Narrow<Avx2> for Narrow {
    #[inline(always)]
    fn factor(self) -> Factor {
        Factor(self.0, vector!(_mm256_srli_epi64::<32>(self.0)))
    }

    #[inline(always)]
    fn add(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm256_add_epi32(self.0, other.0)))
    }

    #[inline(always)]
    fn sub(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm256_sub_epi32(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm256_min_epi32(self.0, other.0)))
    }

    #[inline(always)]
    fn max(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm256_max_epi32(self.0, other.0)))
    }

    #[inline(always)]
    fn abs(self) -> Narrow {
        Narrow(vector!(_mm256_abs_epi32(self.0)))
    }

    #[inline(always)]
    fn shifted<const SHIFT: i32>(self) -> Narrow {
        Narrow(vector!(_mm256_srai_epi32::<SHIFT>(self.0)))
    }

    #[inline(always)]
    fn or(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm256_or_si256(self.0, other.0)))
    }

    #[inline(always)]
    fn above(self, other: Narrow) -> Mask {
        Mask(vector!(_mm256_cmpgt_epi32(self.0, other.0)))
    }
}

impl words::Mask<Avx2> for Mask {
    #[inline(always)]
    fn and(self, other: Mask) -> Mask {
        Mask(vector!(_mm256_and_si256(self.0, other.0)))
    }

    #[inline(always)]
    fn or(self, other: Mask) -> Mask {
        Mask(vector!(_mm256_or_si256(self.0, other.0)))
    }

    #[inline(always)]
    fn pick(self, yes: Narrow, no: Narrow) -> Narrow {
        Narrow(vector!(_mm256_blendv_epi8(no.0, yes.0, self.0)))
    }
}

impl words::Factor<Avx2> for Factor {
    #[inline(always)]
    fn mul(self, other: Factor) -> Wide {
        Wide(vector!(_mm256_mul_epi32(self.0, other.0)), vector!(_mm256_mul_epi32(self.1, other.1)))
    }

    #[inline(always)]
    fn narrow(self) -> Narrow {
        Narrow(vector!(_mm256_blend_epi32::<0b1010_1010>(self.0, _mm256_slli_epi64::<32>(self.1))))
    }
}

impl words::Wide<Avx2> for Wide {
    #[inline(always)]
    fn add(self, other: Wide) -> Wide {
        Wide(vector!(_mm256_add_epi64(self.0, other.0)), vector!(_mm256_add_epi64(self.1, other.1)))
    }

    #[inline(always)]
    fn sub(self, other: Wide) -> Wide {
        Wide(vector!(_mm256_sub_epi64(self.0, other.0)), vector!(_mm256_sub_epi64(self.1, other.1)))
    }

    #[inline(always)]
    fn min(self, other: Wide) -> Wide {
        self.greater(other).pick(other, self)
    }

    #[inline(always)]
    fn max(self, other: Wide) -> Wide {
        self.greater(other).pick(self, other)
    }

    #[inline(always)]
    fn above(self, other: Wide) -> Mask {
        let Wide(even, odd) = self.greater(other);
        Mask(vector!(_mm256_blend_epi32::<0b1010_1010>(even, odd)))
    }

    #[inline(always)]
    fn low(self) -> Factor {
        Factor(self.0, self.1)
    }

    /// There is no such shift that brings in signs: numbers are moved up to be positive, and back.
    #[inline(always)]
    fn shifted<const SHIFT: i32>(self, avx2: Avx2) -> Wide {
        self.sub(avx2.wide(i64::MIN)).down::<SHIFT>().sub(avx2.wide(i64::MIN).down::<SHIFT>())
    }

    #[inline(always)]
    fn half<const SHIFT: i32>(self, avx2: Avx2) -> Wide {
        self.add(avx2.wide(0).greater(self)).add(avx2.wide((1 << SHIFT) >> 1))
    }

    #[inline(always)]
    fn round<const SHIFT: i32>(self, avx2: Avx2) -> Factor {
        self.half::<SHIFT>(avx2).down::<SHIFT>().low()
    }

    #[inline(always)]
    fn limited(self, avx2: Avx2) -> Narrow {
        // By the upper halves: the quotient is in ±2³⁰ if those are in ±2²⁶.
        let high = Narrow(vector!(_mm256_blend_epi32::<0b1010_1010>(_mm256_srli_epi64::<32>(self.0), self.1)));
        let inner = self.down::<28>().low().narrow();
        let inner = high.above(avx2.narrow((1 << 26) - 1)).pick(avx2.narrow(1 << 30), inner);
        avx2.narrow(-(1 << 26)).above(high).pick(avx2.narrow(-(1 << 30)), inner)
    }
}

impl Wide {
    #[inline(always)]
    fn or(self, other: Wide) -> Wide {
        Wide(vector!(_mm256_or_si256(self.0, other.0)), vector!(_mm256_or_si256(self.1, other.1)))
    }

    /// All bits of the lanes that are greater.
    #[inline(always)]
    fn greater(self, other: Wide) -> Wide {
        Wide(vector!(_mm256_cmpgt_epi64(self.0, other.0)), vector!(_mm256_cmpgt_epi64(self.1, other.1)))
    }

    /// Of a mask of whole lanes: where it is set `yes`, else `no`.
    #[inline(always)]
    fn pick(self, yes: Wide, no: Wide) -> Wide {
        Wide(vector!(_mm256_blendv_epi8(no.0, yes.0, self.0)), vector!(_mm256_blendv_epi8(no.1, yes.1, self.1)))
    }

    /// Shifted right, zeros coming in.
    #[inline(always)]
    fn down<const SHIFT: i32>(self) -> Wide {
        Wide(vector!(_mm256_srli_epi64::<SHIFT>(self.0)), vector!(_mm256_srli_epi64::<SHIFT>(self.1)))
    }
}

impl Avx2 {
    /// The first four numbers of a mover: v, w and φ.
    #[inline(always)]
    fn first(self, movers: &[Mover], place: &u32) -> __m256i {
        let mover = &movers[*place as usize];
        vector!(_mm256_loadu_si256(core::ptr::from_ref(mover).cast()))
    }
}

#[inline(always)]
fn set_first(movers: &mut [Mover], place: &u32, first: __m256i) {
    let mover = &mut movers[*place as usize];
    vector!(_mm256_storeu_si256(core::ptr::from_mut(mover).cast(), first));
}

/// A mover's way: x below, y above.
#[inline(always)]
fn way(movers: &[Mover], place: &u32) -> i64 {
    let [x, y] = movers[*place as usize].d;
    i64::from(y) << 32 | i64::from(x as u32)
}

/// Rows as columns.
#[inline(always)]
fn turned([a, b, c, d]: [__m256i; 4]) -> [__m256i; 4] {
    let [low, high] = [vector!(_mm256_unpacklo_epi64(a, b)), vector!(_mm256_unpackhi_epi64(a, b))];
    let [low_next, high_next] = [vector!(_mm256_unpacklo_epi64(c, d)), vector!(_mm256_unpackhi_epi64(c, d))];
    [
        vector!(_mm256_permute2x128_si256::<0x20>(low, low_next)),
        vector!(_mm256_permute2x128_si256::<0x20>(high, high_next)),
        vector!(_mm256_permute2x128_si256::<0x31>(low, low_next)),
        vector!(_mm256_permute2x128_si256::<0x31>(high, high_next)),
    ]
}
