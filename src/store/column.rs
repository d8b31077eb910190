//! Columns: one quantity of all bodies, side by side in memory.

use super::codec::{DecodeError, Reader, Sink, hash_bytes, put_count};
use super::record::{Diff, Record};
use crate::num::Quantity;
use core::marker::PhantomData;

/// A quantity whose bits are an `i64`, as the columns hold them.
pub(crate) trait Narrow: Quantity + Record {
    fn narrow(self) -> i64;
    fn widen(bits: i64) -> Self;
}

macro_rules! narrow {
    ($($type:ident)*) => {$(
        impl Narrow for crate::num::$type {
            #[inline]
            fn narrow(self) -> i64 {
                self.to_bits()
            }

            #[inline]
            fn widen(bits: i64) -> Self {
                Self::from_bits(bits)
            }
        }
    )*};
}

narrow! { Angle AngularVelocity Length Velocity }

/// One quantity per slot, as raw bits; its little-endian bytes are what is saved and hashed.
#[derive(Debug)]
pub(crate) struct Column<Q> {
    bits: Vec<i64>,
    quantity: PhantomData<Q>,
}

impl<Q> Default for Column<Q> {
    fn default() -> Self {
        Column { bits: Vec::new(), quantity: PhantomData }
    }
}

impl<Q> Clone for Column<Q> {
    fn clone(&self) -> Self {
        Column { bits: self.bits.clone(), quantity: PhantomData }
    }

    fn clone_from(&mut self, source: &Self) {
        self.bits.clone_from(&source.bits);
    }
}

impl<Q: Narrow> Column<Q> {
    pub(crate) fn len(&self) -> usize {
        self.bits.len()
    }

    pub(crate) fn push(&mut self, value: Q) {
        self.bits.push(value.narrow());
    }

    #[inline]
    pub(crate) fn get(&self, slot: usize) -> Q {
        Q::widen(self.bits[slot])
    }

    #[inline]
    pub(crate) fn set(&mut self, slot: usize, value: Q) {
        self.bits[slot] = value.narrow();
    }

    /// The raw bits, for the loops of the step.
    #[inline]
    pub(crate) fn bits(&self) -> &[i64] {
        &self.bits
    }

    /// The raw bits, for the loops of the step.
    #[inline]
    pub(crate) fn bits_mut(&mut self) -> &mut [i64] {
        &mut self.bits
    }

    /// XXH3-64 of the elements' little-endian bytes: one pass over memory where that is how memory holds them.
    pub(crate) fn hash(&self) -> u64 {
        if cfg!(target_endian = "little") {
            hash_bytes(bytemuck::cast_slice(&self.bits))
        } else {
            let swapped: Vec<i64> = self.bits.iter().map(|bits| bits.to_le()).collect();
            hash_bytes(bytemuck::cast_slice(&swapped))
        }
    }
}

impl<Q: Narrow> Record for Column<Q> {
    const LEAST: usize = 4;

    fn save(&self, sink: &mut impl Sink) {
        put_count(sink, self.bits.len());
        if cfg!(target_endian = "little") {
            sink.bytes(bytemuck::cast_slice(&self.bits));
        } else {
            for bits in &self.bits {
                sink.bytes(&bits.to_le_bytes());
            }
        }
    }

    fn load(reader: &mut Reader<'_>, field: &'static str) -> Result<Self, DecodeError> {
        let count = reader.take_count(Q::LEAST, field)?;
        let mut column = Column { bits: Vec::with_capacity(count), quantity: PhantomData };
        for _ in 0..count {
            column.push(Q::load(reader, field)?);
        }
        Ok(column)
    }

    fn diff(&self, other: &Self, diff: &mut Diff) {
        for (slot, (a, b)) in self.bits.iter().zip(&other.bits).enumerate() {
            diff.element(slot, |d| Q::widen(*a).diff(&Q::widen(*b), d));
        }
    }
}
