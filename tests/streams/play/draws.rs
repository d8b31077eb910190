//! Numbers that look random, and quantities made of them: integers alone, so the same on every machine.

use tamias2d::num::Quantity;
use tamias2d::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Density, Force, Friction, Impulse, Inertia, Length,
    Mass, Mu, Restitution, Torque, Velocity,
};

/// A generator (SplitMix64).
pub struct Draws {
    state: u64,
    /// Of a hundred quantities, so many are at the ends of their range, just outside, or of any size between.
    pub edges: u64,
}

impl Draws {
    pub fn new(seed: u64) -> Draws {
        Draws { state: seed, edges: 0 }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// `low ..= high`.
    pub fn between(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low) as u64 + 1) as i64
    }

    pub fn chance(&mut self, percent: u64) -> bool {
        self.below(100) < percent
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len() as u64) as usize]
    }

    /// The bits of a quantity between two numbers of thousandths, or at an edge of its range.
    fn quantity(&mut self, [low, high]: [i64; 2], frac: u32, [least, most]: [i128; 2]) -> i128 {
        if !self.chance(self.edges) {
            return ((i128::from(self.between(low, high)) << frac) / 1000).clamp(least, most);
        }
        match self.below(12) {
            0 | 1 => least,
            2 | 3 => most,
            4 => least + 1,
            5 => most - 1,
            // Refused.
            6 => least - 1,
            7 => most + 1,
            _ => {
                let wide = i128::from(self.bits() as i64) << 64 | i128::from(self.bits());
                (wide >> self.below(128)).clamp(least, most)
            }
        }
    }
}

macro_rules! quantities {
    ($($name:ident: $quantity:ident, $bits:ty;)*) => {
        /// Each from a range in thousandths of its unit.
        impl Draws {
            $(pub fn $name(&mut self, low: i64, high: i64) -> $quantity {
                let range = [$quantity::MIN.to_bits() as i128, $quantity::MAX.to_bits() as i128];
                $quantity::from_bits(self.quantity([low, high], $quantity::FRAC, range) as $bits)
            })*
        }
    };
}

quantities! {
    length: Length, i64;
    velocity: Velocity, i64;
    spin: AngularVelocity, i64;
    acceleration: Acceleration, i64;
    angle: Angle, i64;
    mass: Mass, i128;
    inertia: Inertia, i128;
    force: Force, i128;
    torque: Torque, i128;
    impulse: Impulse, i128;
    angular_impulse: AngularImpulse, i128;
    density: Density, i128;
    restitution: Restitution, i64;
    friction: Friction, i64;
    damping: Damping, i64;
    mu: Mu, u128;
}
