//! Numbers and pairs of numbers from their decimal digits.

use crate::geom::Vec2;
use crate::num::{NumError, Quantity};
use core::fmt;
use core::marker::PhantomData;
use core::str::FromStr;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use serde_json::value::RawValue;

/// A quantity, from the very characters that the file has for it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Number<Q>(pub(super) Q);

impl<'de, Q: Quantity + FromStr<Err = NumError>> Deserialize<'de> for Number<Q> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <&RawValue>::deserialize(deserializer)?.get();
        if !text.starts_with(|c: char| c == '-' || c.is_ascii_digit()) {
            return Err(D::Error::custom(format_args!("{} is expected to be a number in {}", Q::NAME, Q::UNIT)));
        }
        text.parse().map(Number).map_err(D::Error::custom)
    }
}

/// [x, y].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair<Q>(pub(super) Vec2<Q>);

struct PairVisitor<Q>(PhantomData<Q>);

impl<'de, Q: Quantity + FromStr<Err = NumError>> Visitor<'de> for PairVisitor<Q> {
    type Value = Pair<Q>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} as a list of two numbers, [x, y], in {}", Q::NAME, Q::UNIT)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let Number(x) = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let Number(y) = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
        if seq.next_element::<serde::de::IgnoredAny>()?.is_some() {
            return Err(A::Error::invalid_length(3, &self));
        }
        Ok(Pair(Vec2::new(x, y)))
    }
}

impl<'de, Q: Quantity + FromStr<Err = NumError>> Deserialize<'de> for Pair<Q> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(PairVisitor(PhantomData))
    }
}
