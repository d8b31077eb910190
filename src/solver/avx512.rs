//! Eight lanes side by side in AVX-512's instructions: the words that `sweep` is written in, as in `avx2`, with eight numbers
//! of 64 bits in one register, a shift that keeps their sign, and their limits.
//!
//! Compilers have these instructions from 1.89 on; `build.rs` says whether this one has.
#![allow(unsafe_code, reason = "instructions that the processor was asked for, see `Avx512`")]
#![allow(clippy::incompatible_msrv, reason = "older compilers do not get to see this file")]

use core::arch::x86_64::*;

use super::mover::Mover;
use super::prepare::Joints;
use super::rows::{Block, LANES, Lane};
use super::scales::Scales;
use super::sweep;
use super::words::{self, Eight, Factor as _, Reach, Wide as _, Words};

/// That this processor has AVX-512 with its instructions for shorter vectors. Of it come all values of the types below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(());

/// Eight numbers of 32 bits, in order, with 64 for each: the rows of a contact wait for each other, and what becomes a factor
/// or was a sum need not be turned into anything on the way.
#[derive(Clone, Copy)]
pub(super) struct Narrow(__m512i);

/// Eight numbers of 64 bits, in order.
#[derive(Clone, Copy)]
pub(super) struct Wide(__m512i);

/// Eight numbers of 32 bits in the lower halves of [`Wide`]; the upper ones mean nothing where [`words::Wide::low`] made them.
#[derive(Clone, Copy)]
pub(super) struct Factor(__m512i);

/// By lane, from the lowest bit.
#[derive(Clone, Copy)]
pub(super) struct Mask(__mmask8);

/// A vector of one instruction each. Sound because [`Narrow`], [`Wide`], [`Factor`] and [`Mask`] exist only where there is
/// AVX-512.
macro_rules! vector {
    ($($call:tt)*) => {{
        // SAFETY: the processor has AVX-512: an operand, or an `Avx512`, says so. Pointers come from references to as much.
        unsafe { $($call)* }
    }};
}

impl Avx512 {
    /// If the processor has it.
    pub(crate) fn detect() -> Option<Avx512> {
        let has = std::arch::is_x86_feature_detected!("avx512f")
            && std::arch::is_x86_feature_detected!("avx512vl")
            && std::arch::is_x86_feature_detected!("avx512dq");
        has.then_some(Avx512(()))
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
        #[target_feature(enable = "avx512f,avx512vl")]
        unsafe fn with_avx512<const BIASED: bool, const FRICTION: bool>(
            avx512: Avx512,
            block: &mut Block,
            lanes: u8,
            movers: &mut [Mover],
            scales: &Scales,
        ) -> (u8, u8) {
            sweep::sweep::<_, BIASED, FRICTION>(avx512, block, lanes, movers, scales)
        }
        // SAFETY: `self` says that the processor has AVX-512.
        unsafe { with_avx512::<BIASED, FRICTION>(self, block, lanes, movers, scales) }
    }

    /// The rows of eight contacts, see [`Joints::write`].
    #[inline]
    pub(super) fn prepare(self, joints: &Joints, block: &mut Block, shift: u32) -> u8 {
        #[target_feature(enable = "avx512f,avx512vl,avx512dq")]
        unsafe fn with_avx512(joints: &Joints, block: &mut Block, shift: u32) -> u8 {
            joints.write(block, shift)
        }
        // SAFETY: `self` says that the processor has AVX-512.
        unsafe { with_avx512(joints, block, shift) }
    }

    /// Last tick's impulses, see [`sweep::warm_start`].
    #[inline]
    pub(super) fn warm_start(self, block: &Block, movers: &mut [Mover]) {
        #[target_feature(enable = "avx512f,avx512vl")]
        unsafe fn with_avx512(avx512: Avx512, block: &Block, movers: &mut [Mover]) {
            sweep::warm_start(avx512, block, movers);
        }
        // SAFETY: `self` says that the processor has AVX-512.
        unsafe { with_avx512(self, block, movers) }
    }

    /// The first four numbers of two movers: v, w and φ of one, then of the other.
    #[inline(always)]
    fn pair(self, movers: &[Mover], one: u32, other: u32) -> __m512i {
        let one = core::ptr::from_ref(&movers[one as usize]).cast();
        let other = core::ptr::from_ref(&movers[other as usize]).cast();
        vector!(_mm512_inserti64x4::<1>(_mm512_castsi256_si512(_mm256_loadu_si256(one)), _mm256_loadu_si256(other)))
    }
}

impl Words for Avx512 {
    type Narrow = Narrow;
    type Wide = Wide;
    type Factor = Factor;
    type Mask = Mask;

    #[inline(always)]
    fn narrow(self, value: i32) -> Narrow {
        Narrow(vector!(_mm512_set1_epi64(value.into())))
    }

    #[inline(always)]
    fn wide(self, value: i64) -> Wide {
        Wide(vector!(_mm512_set1_epi64(value)))
    }

    #[inline(always)]
    fn load(self, lane: &Lane) -> Narrow {
        Narrow(vector!(_mm512_cvtepi32_epi64(_mm256_loadu_si256(lane.as_ptr().cast()))))
    }

    #[inline(always)]
    fn store(self, narrow: Narrow, lane: &mut Lane) {
        vector!(_mm256_storeu_si256(lane.as_mut_ptr().cast(), _mm512_cvtepi64_epi32(narrow.0)));
    }

    #[inline(always)]
    fn held(self, eight: Eight<Avx512>) -> Eight<Avx512> {
        let [least, most] = [self.wide(-(1 << 57)), self.wide(1 << 57)];
        let within = |speed: Wide| speed.min(most).max(least);
        let Eight { v: [x, y], w, phi } = eight;
        Eight { v: [within(x), within(y)], w: within(w), phi }
    }
}

impl Reach for Avx512 {
    #[inline(always)]
    fn chosen(self, bodies: &[[u32; LANES]; 2], lanes: u8) -> Mask {
        let a = vector!(_mm256_loadu_si256(bodies[0].as_ptr().cast()));
        let b = vector!(_mm256_loadu_si256(bodies[1].as_ptr().cast()));
        Mask(vector!(_mm256_mask_cmpneq_epi32_mask(lanes, a, b)))
    }

    /// Two movers in a register, so that turning rows to columns within halves, and picking quarters, leaves them in order.
    #[inline(always)]
    fn gather(self, movers: &[Mover], &[a, b, c, d, e, f, g, h]: &[u32; LANES]) -> Eight<Avx512> {
        let [ac, bd] = [self.pair(movers, a, c), self.pair(movers, b, d)];
        let [eg, fh] = [self.pair(movers, e, g), self.pair(movers, f, h)];
        // x and w, y and φ of the first four, and of the last four.
        let [xw, yp] = [vector!(_mm512_unpacklo_epi64(ac, bd)), vector!(_mm512_unpackhi_epi64(ac, bd))];
        let [xw_next, yp_next] = [vector!(_mm512_unpacklo_epi64(eg, fh)), vector!(_mm512_unpackhi_epi64(eg, fh))];
        Eight {
            v: [
                Wide(vector!(_mm512_shuffle_i64x2::<0b10_00_10_00>(xw, xw_next))),
                Wide(vector!(_mm512_shuffle_i64x2::<0b10_00_10_00>(yp, yp_next))),
            ],
            w: Wide(vector!(_mm512_shuffle_i64x2::<0b11_01_11_01>(xw, xw_next))),
            phi: Wide(vector!(_mm512_shuffle_i64x2::<0b11_01_11_01>(yp, yp_next))),
        }
    }

    #[inline(always)]
    fn scatter(self, eight: Eight<Avx512>, movers: &mut [Mover], &[a, b, c, d, e, f, g, h]: &[u32; LANES]) {
        let Eight { v: [Wide(x), Wide(y)], w: Wide(w), phi: Wide(p) } = eight;
        let first = vector!(_mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11));
        let last = vector!(_mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15));
        let [xy, wp] = [vector!(_mm512_unpacklo_epi64(x, y)), vector!(_mm512_unpacklo_epi64(w, p))];
        let [xy_next, wp_next] = [vector!(_mm512_unpackhi_epi64(x, y)), vector!(_mm512_unpackhi_epi64(w, p))];
        set_pair(movers, [a, c], vector!(_mm512_permutex2var_epi64(xy, first, wp)));
        set_pair(movers, [b, d], vector!(_mm512_permutex2var_epi64(xy_next, first, wp_next)));
        set_pair(movers, [e, g], vector!(_mm512_permutex2var_epi64(xy, last, wp)));
        set_pair(movers, [f, h], vector!(_mm512_permutex2var_epi64(xy_next, last, wp_next)));
    }

    #[inline(always)]
    fn ways(self, movers: &[Mover], &[a, b, c, d, e, f, g, h]: &[u32; LANES]) -> [Factor; 2] {
        // x below, y above.
        let way = |place: u32| {
            let [x, y] = movers[place as usize].d;
            i64::from(y) << 32 | i64::from(x as u32)
        };
        let both = vector!(_mm512_setr_epi64(way(a), way(b), way(c), way(d), way(e), way(f), way(g), way(h)));
        [Factor(both), Factor(vector!(_mm512_srli_epi64::<32>(both)))]
    }

    #[inline(always)]
    fn any(self, narrow: Narrow) -> bool {
        vector!(_mm512_test_epi64_mask(narrow.0, narrow.0)) != 0
    }

    #[inline(always)]
    fn bits(self, mask: Mask) -> u8 {
        mask.0
    }
}

impl words::Narrow<Avx512> for Narrow {
    #[inline(always)]
    fn factor(self) -> Factor {
        Factor(self.0)
    }

    #[inline(always)]
    fn add(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm512_add_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn sub(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm512_sub_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm512_min_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn max(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm512_max_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn abs(self) -> Narrow {
        Narrow(vector!(_mm512_abs_epi64(self.0)))
    }

    #[inline(always)]
    fn shifted<const SHIFT: i32>(self) -> Narrow {
        Narrow(vector!(_mm512_srav_epi64(self.0, _mm512_set1_epi64(SHIFT.into()))))
    }

    #[inline(always)]
    fn or(self, other: Narrow) -> Narrow {
        Narrow(vector!(_mm512_or_si512(self.0, other.0)))
    }

    #[inline(always)]
    fn above(self, other: Narrow) -> Mask {
        Mask(vector!(_mm512_cmpgt_epi64_mask(self.0, other.0)))
    }
}

impl words::Mask<Avx512> for Mask {
    #[inline(always)]
    fn and(self, other: Mask) -> Mask {
        Mask(self.0 & other.0)
    }

    #[inline(always)]
    fn or(self, other: Mask) -> Mask {
        Mask(self.0 | other.0)
    }

    #[inline(always)]
    fn pick(self, yes: Narrow, no: Narrow) -> Narrow {
        Narrow(vector!(_mm512_mask_blend_epi64(self.0, no.0, yes.0)))
    }
}

impl words::Factor<Avx512> for Factor {
    #[inline(always)]
    fn mul(self, other: Factor) -> Wide {
        Wide(vector!(_mm512_mul_epi32(self.0, other.0)))
    }

    #[inline(always)]
    fn narrow(self) -> Narrow {
        Narrow(self.0)
    }
}

impl words::Wide<Avx512> for Wide {
    #[inline(always)]
    fn add(self, other: Wide) -> Wide {
        Wide(vector!(_mm512_add_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn sub(self, other: Wide) -> Wide {
        Wide(vector!(_mm512_sub_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Wide) -> Wide {
        Wide(vector!(_mm512_min_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn max(self, other: Wide) -> Wide {
        Wide(vector!(_mm512_max_epi64(self.0, other.0)))
    }

    #[inline(always)]
    fn above(self, other: Wide) -> Mask {
        Mask(vector!(_mm512_cmpgt_epi64_mask(self.0, other.0)))
    }

    #[inline(always)]
    fn low(self) -> Factor {
        Factor(self.0)
    }

    #[inline(always)]
    fn shifted<const SHIFT: i32>(self, avx512: Avx512) -> Wide {
        Wide(vector!(_mm512_srav_epi64(self.0, avx512.wide(SHIFT.into()).0)))
    }

    #[inline(always)]
    fn half<const SHIFT: i32>(self, avx512: Avx512) -> Wide {
        self.add(self.shifted::<63>(avx512)).add(avx512.wide((1 << SHIFT) >> 1))
    }

    #[inline(always)]
    fn round<const SHIFT: i32>(self, avx512: Avx512) -> Factor {
        self.half::<SHIFT>(avx512).shifted::<SHIFT>(avx512).low()
    }

    #[inline(always)]
    fn limited(self, avx512: Avx512) -> Narrow {
        let quotient = self.shifted::<28>(avx512);
        quotient.min(avx512.wide(1 << 30)).max(avx512.wide(-(1 << 30))).low().narrow()
    }
}

/// Puts back what [`Avx512::pair`] took.
#[inline(always)]
fn set_pair(movers: &mut [Mover], [one, other]: [u32; 2], both: __m512i) {
    let one = core::ptr::from_mut(&mut movers[one as usize]).cast();
    vector!(_mm256_storeu_si256(one, _mm512_castsi512_si256(both)));
    let other = core::ptr::from_mut(&mut movers[other as usize]).cast();
    vector!(_mm256_storeu_si256(other, _mm512_extracti64x4_epi64::<1>(both)));
}
