//! Angles between radians, at the interface's edge, and turns, everywhere else.

use super::{Angle, Quantity, Radians, RangeError, round_shift};

/// 2π with 60 fraction bits.
pub(crate) const TAU_Q60: i128 = 7_244_019_458_077_122_842;
/// 1/2π with 64 fraction bits.
pub(crate) const TURN_PER_RADIAN_Q64: i128 = 2_935_890_503_282_001_226;
/// One turn in the 48 fraction bits of [`Angle`].
const TURN: i64 = 1 << 48;

impl Angle {
    /// An orientation given in radians, in [0, 2π]; 2π is stored as 0.
    ///
    /// Rounding: nearest, to 2⁻⁴⁸ turns (2.2e-14 rad). Errors: radians outside [0, 2π] by more than that rounding.
    ///
    /// ```
    /// use tamias2d::{Angle, Radians};
    /// let quarter: Radians = "1.5707963267948966".parse()?;
    /// assert_eq!(Angle::from_radians(quarter)?, Angle::from_bits(1 << 46));
    /// assert!(Angle::from_radians("6.2831853072".parse()?).is_err());
    /// # Ok::<(), tamias2d::NumError>(())
    /// ```
    pub fn from_radians(radians: Radians) -> Result<Angle, RangeError> {
        let angle = Angle::from_any_radians(radians);
        if radians.to_bits() < 0 || angle.to_bits() > TURN {
            return Err(RangeError {
                quantity: Radians::NAME,
                unit: Radians::UNIT,
                value: radians.decimal(),
                accepted: "0 … 2π",
            });
        }
        Ok(Angle::from_bits(angle.to_bits() & (TURN - 1)))
    }

    /// An unwrapped angle given in radians, of any size and sign.
    ///
    /// Error: half a unit of 2⁻⁴⁸ turns, and a quarter more at ±32 768 rad, from the 64 bits of 1/2π.
    pub const fn from_any_radians(radians: Radians) -> Angle {
        // 2^63 · 2^62 fits; the result is below the input.
        Angle::from_bits(round_shift(radians.to_bits() as i128 * TURN_PER_RADIAN_Q64, 64) as i64)
    }

    /// φ in [0, 2π), floored to 2⁻⁴⁸ rad so that it never reaches 2π.
    pub const fn radians(self) -> Radians {
        // 2^48 · 2^63 fits.
        Radians::from_bits(((self.fraction() as i128 * TAU_Q60) >> 60) as i64)
    }

    /// The fraction of a turn, in units of 2⁻⁴⁸: φ without its whole turns, exactly.
    #[inline]
    pub const fn fraction(self) -> u64 {
        (self.to_bits() & (TURN - 1)) as u64
    }
}
