//! The quantity types: a fixed-point format, a unit and an accepted range each.

use super::decimal::{Decimal, is_bounded};
use core::fmt;
use core::str::FromStr;
use fixed::types::extra::{U32, U48, U56, U64};
use fixed::{FixedI64, FixedI128, FixedU128};

/// What every quantity type has. Sealed: the engine's formats are part of its arithmetic law.
pub trait Quantity: Copy + PartialEq + fmt::Display + sealed::Bits {
    /// The quantity's name, as messages print it.
    const NAME: &'static str;
    /// The unit, as messages print it.
    const UNIT: &'static str;
    /// The accepted range, as messages print it.
    const ACCEPTED: &'static str;
    /// How many of the bits are fraction.
    const FRAC: u32;
    /// The least accepted value.
    const MIN: Self;
    /// The greatest accepted value.
    const MAX: Self;

    /// The exact value, for messages and tables.
    fn decimal(self) -> Decimal {
        Decimal { bits: self.wide_bits(), frac: Self::FRAC }
    }

    /// The value itself when it lies in `MIN ..= MAX`, else the error that names it and its limits.
    fn checked(self) -> Result<Self, RangeError> {
        let bits = self.wide_bits();
        if bits < Self::MIN.wide_bits() || bits > Self::MAX.wide_bits() {
            return Err(RangeError::new::<Self>(self.decimal()));
        }
        Ok(self)
    }
}

pub(crate) mod sealed {
    /// Raw access behind [`super::Quantity`].
    pub trait Bits: Sized {
        /// The bits as the widest integer; a `Mu` above its accepted range is limited to `i128::MAX`.
        fn wide_bits(self) -> i128;
    }
}

/// A value outside its quantity's accepted range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeError {
    /// The quantity's name.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What was given; limited to ±2⁹⁵ where it came from beyond the format.
    pub value: Decimal,
    /// The accepted range, as the range table of [`num`](crate::num) has it.
    pub accepted: &'static str,
}

impl RangeError {
    pub(crate) fn new<Q: Quantity>(value: Decimal) -> Self {
        RangeError { quantity: Q::NAME, unit: Q::UNIT, value, accepted: Q::ACCEPTED }
    }
}

impl fmt::Display for RangeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RangeError { quantity, unit, value, accepted } = self;
        let unit = Unit(unit);
        write!(f, "{quantity} {value}{unit} is outside {accepted}{unit}")
    }
}

/// A unit behind a number; none for a pure number.
struct Unit(&'static str);

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() { Ok(()) } else { write!(f, " {}", self.0) }
    }
}

impl core::error::Error for RangeError {}

/// Why text or an `f64` is no value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumError {
    /// NaN or an infinity.
    NotFinite {
        /// The quantity's name.
        quantity: &'static str,
    },
    /// Not a decimal number, or one of more than [`decimal::MAX_TEXT`](super::decimal::MAX_TEXT) bytes or with an
    /// exponent beyond ±[`decimal::MAX_EXPONENT`](super::decimal::MAX_EXPONENT).
    Malformed {
        /// The quantity's name.
        quantity: &'static str,
    },
    /// A number outside the accepted range.
    Range(RangeError),
}

impl fmt::Display for NumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NumError::NotFinite { quantity } => write!(f, "{quantity} is not a finite number"),
            NumError::Malformed { quantity } => {
                write!(f, "{quantity} is not a decimal number of at most 256 characters with an exponent within ±99")
            }
            NumError::Range(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for NumError {}

impl From<RangeError> for NumError {
    fn from(error: RangeError) -> Self {
        NumError::Range(error)
    }
}

/// Declares the quantity types: name, format, bits, unit, accepted range in bits.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $fixed:ty, $bits:ty, $frac:literal, $text:literal, $unit:literal, $accepted:literal, $min:expr, $max:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name($fixed);

        impl $name {
            /// Zero.
            pub const ZERO: Self = Self::from_bits(0);

            /// The value whose raw bits are `bits`. Not range-checked: the door that takes it is.
            #[inline]
            pub const fn from_bits(bits: $bits) -> Self {
                Self(<$fixed>::from_bits(bits))
            }

            /// The raw bits.
            #[inline]
            pub const fn to_bits(self) -> $bits {
                self.0.to_bits()
            }

            /// From the `fixed` type of the same format. Not range-checked.
            #[inline]
            pub const fn from_fixed(value: $fixed) -> Self {
                Self(value)
            }

            /// As the `fixed` type of the same format; mind its operators' overflow and rounding.
            #[inline]
            pub const fn to_fixed(self) -> $fixed {
                self.0
            }
        }

        impl sealed::Bits for $name {
            #[inline]
            #[allow(clippy::useless_conversion, reason = "u128 needs it, i64 and i128 do not")]
            fn wide_bits(self) -> i128 {
                i128::try_from(self.to_bits()).unwrap_or(i128::MAX)
            }
        }

        impl Quantity for $name {
            const NAME: &'static str = $text;
            const UNIT: &'static str = $unit;
            const ACCEPTED: &'static str = $accepted;
            const FRAC: u32 = $frac;
            const MIN: Self = Self::from_bits($min);
            const MAX: Self = Self::from_bits($max);
        }

        impl fmt::Display for $name {
            /// All digits, exactly; a precision rounds.
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.decimal().fmt(f)
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}{}", self.decimal(), Unit($unit))
            }
        }

        impl FromStr for $name {
            type Err = NumError;

            /// Reads a decimal number (`-12.5`, `1e-3`), rounded once to nearest, and checks its range.
            fn from_str(text: &str) -> Result<Self, NumError> {
                if !is_bounded(text) {
                    return Err(NumError::Malformed { quantity: $text });
                }
                match <$fixed>::from_str(text) {
                    Ok(value) => Ok(Self(value).checked()?),
                    Err(_) => Err(NumError::Range(RangeError::new::<Self>(beyond(text)))),
                }
            }
        }

        impl serde::Serialize for $name {
            /// Raw bits in binary formats, exact decimal text in readable ones.
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                if serializer.is_human_readable() { serializer.collect_str(self) } else { self.to_bits().serialize(serializer) }
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            /// The range is not checked here: every door checks it.
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                if deserializer.is_human_readable() {
                    let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
                    text.parse().map_err(serde::de::Error::custom)
                } else {
                    <$bits>::deserialize(deserializer).map(Self::from_bits)
                }
            }
        }
    )*};
}

/// What a number beyond its format is shown as: itself where 96 whole bits hold it, else their end.
fn beyond(text: &str) -> Decimal {
    if let Ok(value) = FixedI128::<U64>::from_str(text) {
        return Decimal { bits: value.to_bits(), frac: 64 };
    }
    let end = if text.starts_with('-') { i128::MIN } else { i128::MAX };
    Decimal { bits: FixedI128::<U32>::from_str(text).map_or(end, FixedI128::to_bits), frac: 32 }
}

const METRE: i64 = 1 << 32;
const UNIT_64: i128 = 1 << 64;

quantities! {
    /// A position coordinate or a length, in metres: `I32F32`, ±1e9, resolution 2.3e-10.
    Length: FixedI64<U32>, i64, 32, "length", "m", "±1000000000", -1_000_000_000 * METRE, 1_000_000_000 * METRE;
    /// A velocity component in m/s: `I16F48`, the whole format.
    Velocity: FixedI64<U48>, i64, 48, "velocity", "m/s", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// An angular velocity in rad/s, counter-clockwise positive: `I16F48`, the whole format.
    AngularVelocity: FixedI64<U48>, i64, 48, "angular velocity", "rad/s", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// An acceleration component in m/s²: `I16F48`, the whole format.
    Acceleration: FixedI64<U48>, i64, 48, "acceleration", "m/s²", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// An orientation in turns, unwrapped: `I16F48`. The low 48 bits are the fraction of a turn, exactly.
    Angle: FixedI64<U48>, i64, 48, "angle", "turns", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// An angle in radians, for the edges of the interface only: `I16F48`.
    Radians: FixedI64<U48>, i64, 48, "angle", "rad", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// A time in seconds: `I16F48`.
    Time: FixedI64<U48>, i64, 48, "time", "s", "±(32768 − 2⁻⁴⁸)", -i64::MAX, i64::MAX;
    /// A mass in kg: `I64F64`, 1e-6 … 2.1e9. With 32 fraction bits a body of 10 g would accelerate wrongly by 1e-8.
    Mass: FixedI128<U64>, i128, 64, "mass", "kg", "0.000001 … 2100000000", 18_446_744_073_710, 2_100_000_000 * UNIT_64;
    /// A moment of inertia about the centre of mass in kg m²: `I64F64`, 1e-12 … 1e18.
    Inertia: FixedI128<U64>, i128, 64, "inertia", "kg m²", "1e-12 … 1e18", 18_446_744, 1_000_000_000_000_000_000 * UNIT_64;
    /// A force component in N: `I64F64`, ±1e14.
    Force: FixedI128<U64>, i128, 64, "force", "N", "±1e14", -100_000_000_000_000 * UNIT_64, 100_000_000_000_000 * UNIT_64;
    /// A torque in N m, counter-clockwise positive: `I64F64`, ±1e18.
    Torque: FixedI128<U64>, i128, 64, "torque", "N m", "±1e18", -1_000_000_000_000_000_000 * UNIT_64, 1_000_000_000_000_000_000 * UNIT_64;
    /// An impulse component in N s: `I64F64`, ±1e14.
    Impulse: FixedI128<U64>, i128, 64, "impulse", "N s", "±1e14", -100_000_000_000_000 * UNIT_64, 100_000_000_000_000 * UNIT_64;
    /// An angular impulse in N m s, counter-clockwise positive: `I64F64`, ±1e18.
    AngularImpulse: FixedI128<U64>, i128, 64, "angular impulse", "N m s", "±1e18", -1_000_000_000_000_000_000 * UNIT_64, 1_000_000_000_000_000_000 * UNIT_64;
    /// A mass per area in kg/m²: `I64F64`, 1e-9 … 1e12.
    Density: FixedI128<U64>, i128, 64, "density", "kg/m²", "0.000000001 … 1e12", 18_446_744_074, 1_000_000_000_000 * UNIT_64;
    /// A coefficient of restitution C_R: `I16F48`, 0 … 1.
    Restitution: FixedI64<U48>, i64, 48, "restitution", "", "0 … 1", 0, 1 << 48;
    /// A coefficient of friction: `I16F48`, 0 … 100.
    Friction: FixedI64<U48>, i64, 48, "friction", "", "0 … 100", 0, 100 << 48;
    /// A rate of exponential decay of velocity in 1/s: `I16F48`, 0 … 1000.
    Damping: FixedI64<U48>, i64, 48, "damping", "1/s", "0 … 1000", 0, 1000 << 48;
    /// A gravitational parameter μ = G·M in m³/s²: `U72F56`, 0 … 2e21.
    Mu: FixedU128<U56>, u128, 56, "mu", "m³/s²", "0 … 2e21", 0, 2_000_000_000_000_000_000_000 << 56;
    /// An energy in J: `I64F64`; an output, it saturates.
    Energy: FixedI128<U64>, i128, 64, "energy", "J", "±9.2e18", -i128::MAX, i128::MAX;
}

impl Mu {
    /// G·M of a mass in whole kilograms, with G = 6.6743e-11 m³/(kg s²) (CODATA 2018).
    ///
    /// Rounding: nearest, once. Errors: a μ above the accepted range.
    /// G alone is below one unit of most formats, so it exists here only, with 128 fraction bits.
    ///
    /// ```
    /// let earth = tamias2d::Mu::of_kilograms(5_972_168_000_000_000_000_000_000)?;
    /// assert_eq!(format!("{earth:.0}"), "398600408824000");
    /// # Ok::<(), tamias2d::RangeError>(())
    /// ```
    pub fn of_kilograms(mass: u128) -> Result<Self, RangeError> {
        // μ·2^56 = M · 66743 · 2^56 / 10^15.
        let mass = i128::try_from(mass).unwrap_or(i128::MAX);
        let bits = super::mul_div(mass, 66_743 << 56, 1_000_000_000_000_000).unsigned_abs();
        Mu::from_bits(bits).checked()
    }
}
