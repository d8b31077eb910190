//! Which code solves blocks: the definition, or lanes side by side where the processor can. The bits are the same.
//!
//! On x86_64 it is asked for AVX-512 and AVX2 once a world. On aarch64, and on WebAssembly with `simd128`, there are plain arrays
//! (`build.rs`); all others have the definition alone. Tests have all of them.

#[cfg(target_arch = "x86_64")]
use super::avx2::Avx2;
#[cfg(all(target_arch = "x86_64", avx512))]
use super::avx512::Avx512;
use super::mover::Mover;
#[cfg(any(test, plain))]
use super::plain;
use super::prepare::Joints;
use super::rows::Block;
#[cfg(any(test, plain, target_arch = "x86_64"))]
use super::rows::ROUNDS;
use super::scales::Scales;

#[derive(Clone, Copy, Debug)]
pub(crate) enum Kernel {
    /// One contact after the other.
    Definition,
    #[cfg(any(test, plain))]
    Plain,
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(all(target_arch = "x86_64", avx512))]
    Avx512(Avx512),
}

impl Default for Kernel {
    /// The fastest that this processor has, or what the build is told to take; see `build.rs`.
    fn default() -> Self {
        let taken = |kernel: &Kernel| match kernel {
            Kernel::Definition => true,
            #[cfg(any(test, plain))]
            Kernel::Plain => cfg!(plain),
            #[cfg(target_arch = "x86_64")]
            _ => !cfg!(tamias_lanes = "plain"),
        };
        let lanes = !cfg!(tamias_lanes = "none");
        Kernel::all().filter(taken).last().filter(|_| lanes).unwrap_or(Kernel::Definition)
    }
}

impl Kernel {
    /// All that this processor has, slowest first.
    pub(super) fn all() -> impl Iterator<Item = Kernel> {
        let all = [
            Some(Kernel::Definition),
            #[cfg(any(test, plain))]
            Some(Kernel::Plain),
            #[cfg(target_arch = "x86_64")]
            Avx2::detect().map(Kernel::Avx2),
            #[cfg(all(target_arch = "x86_64", avx512))]
            Avx512::detect().map(Kernel::Avx512),
        ];
        all.into_iter().flatten()
    }

    /// [`Block::solve`].
    #[inline]
    pub(super) fn solve<const BIASED: bool>(self, block: &mut Block, lanes: u8, movers: &mut [Mover], scales: &Scales) {
        match self {
            Kernel::Definition => block.solve::<BIASED>(lanes, movers, scales),
            #[cfg(any(test, plain))]
            Kernel::Plain => {
                let (blows, pushes) = plain::sweep::<BIASED, true>(block, lanes, movers, scales);
                block.pushes = pushes;
                if blows != 0 {
                    let again = |block: &mut Block, lanes, movers: &mut [Mover]| {
                        plain::sweep::<BIASED, false>(block, lanes, movers, scales).0
                    };
                    go_round::<BIASED>(block, blows, movers, scales, again);
                }
            }
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => {
                let (blows, pushes) = avx2.sweep::<BIASED, true>(block, lanes, movers, scales);
                block.pushes = pushes;
                if blows != 0 {
                    let again = |block: &mut Block, lanes, movers: &mut [Mover]| {
                        avx2.sweep::<BIASED, false>(block, lanes, movers, scales).0
                    };
                    go_round::<BIASED>(block, blows, movers, scales, again);
                }
            }
            #[cfg(all(target_arch = "x86_64", avx512))]
            Kernel::Avx512(avx512) => {
                let (blows, pushes) = avx512.sweep::<BIASED, true>(block, lanes, movers, scales);
                block.pushes = pushes;
                if blows != 0 {
                    let again = |block: &mut Block, lanes, movers: &mut [Mover]| {
                        avx512.sweep::<BIASED, false>(block, lanes, movers, scales).0
                    };
                    go_round::<BIASED>(block, blows, movers, scales, again);
                }
            }
        }
    }

    /// [`Block::warm_start`].
    #[inline]
    pub(super) fn warm_start(self, block: &Block, movers: &mut [Mover]) {
        match self {
            Kernel::Definition => block.warm_start(movers),
            #[cfg(any(test, plain))]
            Kernel::Plain => plain::warm_start(block, movers),
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => avx2.warm_start(block, movers),
            #[cfg(all(target_arch = "x86_64", avx512))]
            Kernel::Avx512(avx512) => avx512.warm_start(block, movers),
        }
    }

    /// [`Joints::write`].
    #[inline]
    pub(super) fn prepare(self, joints: &Joints, block: &mut Block, shift: u32) -> u8 {
        match self {
            Kernel::Definition => joints.write(block, shift),
            #[cfg(any(test, plain))]
            Kernel::Plain => joints.write(block, shift),
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => avx2.prepare(joints, block, shift),
            #[cfg(all(target_arch = "x86_64", avx512))]
            Kernel::Avx512(avx512) => avx512.prepare(joints, block, shift),
        }
    }
}

/// As the definition has blows go round, several of them side by side: they share no body. A single one is faster alone.
#[cfg(any(test, plain, target_arch = "x86_64"))]
#[cold]
fn go_round<const BIASED: bool>(
    block: &mut Block,
    mut blows: u8,
    movers: &mut [Mover],
    scales: &Scales,
    together: impl Fn(&mut Block, u8, &mut [Mover]) -> u8,
) {
    for _ in 1..ROUNDS {
        blows = match blows.count_ones() {
            0 => return,
            1 => block.go_round_once::<BIASED>(blows, movers, scales),
            _ => together(block, blows, movers),
        };
    }
}
