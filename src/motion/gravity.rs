//! Universal gravitation by μ = G·M: a = μ·d/|d|³ (TM:UniversalGravLaw).
//!
//! | value | form | bound |
//! |---|---|---|
//! | d | `i64`, 32 fraction bits | 2·10⁹ m: below 2⁶³ |
//! | d² | `u128`, 64 fraction bits | below 2¹²⁷ |
//! | 1/d, 1/d³, μ | 64-bit mantissas, highest bit kept up, with an exponent | relative error below 2⁻⁶⁰ |
//! | a | `i128`, 48 fraction bits | saturates at ±2¹⁰⁰, so that sums do not wrap; the caller limits the sum |

use crate::body::{Attractor, Bodies};
use crate::geom::Vec2;
use crate::num::{Length, Mu, round_shift};
use crate::store::{Cells, Show};

/// Where one source's pull saturates: far above what the sum may be, far below where sums of 2²⁵ pulls wrap.
const PULL_MAX: i128 = 1 << 100;

/// What a source belongs to. The order is that of summation: attractors by slot, then bodies by slot.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) enum Carrier {
    Attractor(u32),
    Body(u32),
}

/// Something that pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Source {
    x: i64,
    y: i64,
    /// What it belongs to.
    carrier: Carrier,
    /// μ = mantissa·2^(8 − zeros), the mantissa's highest bit set.
    mantissa: u64,
    zeros: u32,
}

impl Show for Source {
    /// Where a body carries it, the last evaluation decides, and the next one moves it first: that is not shown.
    fn show(&self, cells: &mut Cells<'_>) {
        let Source { x, y, carrier, mantissa, zeros } = self;
        let (kind, slot) = match carrier {
            Carrier::Attractor(slot) => (0u8, slot),
            Carrier::Body(slot) => (1, slot),
        };
        cells.turn(kind.into());
        cells.field("carrier", |c| kind.show(c));
        cells.field("slot", |c| slot.show(c));
        cells.field("mantissa", |c| mantissa.show(c));
        cells.field("zeros", |c| zeros.show(c));
        if let Carrier::Attractor(_) = carrier {
            cells.field("x", |c| x.show(c));
            cells.field("y", |c| y.show(c));
        }
    }
}

impl Source {
    fn new(carrier: Carrier, position: Vec2<Length>, mu: Mu) -> Source {
        let zeros = mu.to_bits().leading_zeros();
        let mantissa = (mu.to_bits() << (zeros & 127) >> 64) as u64;
        Source { x: position.x.to_bits(), y: position.y.to_bits(), carrier, mantissa, zeros }
    }

    /// The attractor in a slot.
    pub(crate) fn fixed(slot: usize, attractor: Attractor) -> Source {
        Source::new(Carrier::Attractor(slot as u32), attractor.position, attractor.mu)
    }

    /// A source that a body carries; where, [`Source::follow`] says.
    pub(crate) fn carried(slot: usize, mu: Mu) -> Source {
        Source::new(Carrier::Body(slot as u32), Vec2::default(), mu)
    }

    /// Its place among the sources.
    pub(crate) fn order(&self) -> Carrier {
        self.carrier
    }

    /// The slot of the body that carries it, if one does.
    pub(crate) fn body(&self) -> Option<usize> {
        match self.carrier {
            Carrier::Body(slot) => Some(slot as usize),
            Carrier::Attractor(_) => None,
        }
    }

    /// Whether μ is not 0.
    pub(crate) fn pulls(&self) -> bool {
        self.mantissa != 0
    }

    /// Moves a carried source to where its body is.
    pub(crate) fn follow(&mut self, bodies: &Bodies) {
        if let Carrier::Body(slot) = self.carrier {
            let position = bodies.position(slot as usize);
            (self.x, self.y) = (position.x.to_bits(), position.y.to_bits());
        }
    }
}

/// The sum of all pulls on the body in `slot` at (x, y), in the order of the sources; 48 fraction bits.
///
/// A body does not pull itself, and a source at distance 0 does not pull. Rounding: nearest, once per source, odd.
pub(crate) fn pull(sources: &[Source], slot: usize, x: i64, y: i64) -> [i128; 2] {
    let mut sum = [0i128; 2];
    for source in sources {
        if source.carrier == Carrier::Body(slot as u32) {
            continue;
        }
        // Positions are within ±10⁹ m, so the difference fits.
        let one = attraction(source, source.x.saturating_sub(x), source.y.saturating_sub(y));
        sum = [sum[0].saturating_add(one[0]), sum[1].saturating_add(one[1])];
    }
    sum
}

/// The high half of a product of mantissas.
#[inline]
fn mul_high(a: u64, b: u64) -> u64 {
    (u128::from(a).wrapping_mul(u128::from(b)) >> 64) as u64
}

/// One source's pull towards (dx, dy).
#[inline]
fn attraction(source: &Source, dx: i64, dy: i64) -> [i128; 2] {
    let square = |d: i64| u128::from(d.unsigned_abs()).saturating_mul(u128::from(d.unsigned_abs()));
    let distance2 = square(dx).saturating_add(square(dy));
    if distance2 == 0 {
        return [0; 2];
    }
    // d = root·2^(−even/2) in units of 2⁻³² m, with the root's highest bit set.
    let even = distance2.leading_zeros() & !1;
    let root = (distance2 << even).isqrt() as u64;
    // 1/d as inverse·2^−127; a root of exactly 2⁶³ would give 2⁶⁴, one unit too many.
    let inverse = (u128::MAX >> 1).checked_div(root.into()).unwrap_or(0) as u64;
    let cube = mul_high(mul_high(inverse, inverse), inverse);
    let factor = mul_high(cube, source.mantissa);
    // With d, 1/d and μ as above, a·2⁴⁸ = d·factor·2^(3·even/2 − zeros − 69).
    let halves = (even as i32).saturating_mul(3) >> 1;
    let exponent = halves.saturating_sub(source.zeros as i32).saturating_sub(69);
    [dx, dy].map(|d| scale(i128::from(d), factor, exponent))
}

/// `d·factor·2^exponent`, rounded; limited to ±`PULL_MAX`.
#[inline]
fn scale(d: i128, factor: u64, exponent: i32) -> i128 {
    // |d| < 2⁶³ and factor < 2⁶⁴: the product fits.
    let product = d.saturating_mul(i128::from(factor));
    if exponent <= 0 {
        return round_shift(product, exponent.unsigned_abs()).clamp(-PULL_MAX, PULL_MAX);
    }
    let exponent = exponent.unsigned_abs();
    if product.unsigned_abs().leading_zeros() <= exponent.saturating_add(1) {
        return if product == 0 { 0 } else { PULL_MAX.saturating_mul(product.signum()) };
    }
    (product << exponent).clamp(-PULL_MAX, PULL_MAX)
}
