//! Symmetric positive definite systems in integers: L·D·Lᵀ, each row from its first entry on (an envelope).
//!
//! A is scaled so that its diagonal is in 1 … 4 and a little above what makes it definite: a floor under every pivot bounds
//! all else, |L_ij|·√D_j ≤ √A_ii.
//!
//! | value | format | bound | why |
//! |---|---|---|---|
//! | A, C = L·D | Q58, i64 | 2⁶¹ | \|C_ij\| ≤ √(A_ii·D_j) ≤ 4 |
//! | D | Q58 | 2⁴⁴ … 2⁶¹ | at least [`FLOOR`] |
//! | 1/D | Q44 | 2⁵⁸ | of the above |
//! | L | Q52 | 2⁶¹ | \|L_ij\| ≤ 2/√D_j ≤ 2⁸ |
//! | right side, solution | Q44 | 2⁵⁷ (8192) | refused beyond |
//!
//! A product of factors stays below √(A_ii·A_jj) with all of its sum, and sums of at most [`ROWS`] products of L and a
//! solution are below 2⁸·2⁶¹·2⁵⁷ = 2¹²⁶: all fit 128 bits.

/// How many rows a system may have.
pub(crate) const ROWS: usize = 256;
/// The least pivot, 2⁻¹⁴.
const FLOOR: i64 = 1 << 44;
/// The bound of right sides and solutions.
const FAR: u64 = 1 << 57;

/// A system and its factors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Envelope {
    /// By row: its first column, and where that is among the entries. Its last one is the diagonal's neighbour.
    first: Vec<u32>,
    start: Vec<u32>,
    /// Left of the diagonal: A, then C.
    entries: Vec<i64>,
    /// Left of the diagonal: L.
    lower: Vec<i64>,
    /// The diagonal: A, then D.
    pivots: Vec<i64>,
    inverses: Vec<i64>,
}

/// `value / 2^shift` to nearest and odd. Range: |value| < 2¹²⁶, 1 ≤ shift ≤ 125.
#[inline(always)]
const fn rounded(value: i128, shift: u32) -> i64 {
    ((value + (1 << (shift - 1)) + (value >> 127)) >> shift) as i64
}

#[inline(always)]
fn product(a: &[i64], b: &[i64]) -> i128 {
    a.iter().zip(b).map(|(&a, &b)| a as i128 * b as i128).sum()
}

impl Envelope {
    /// Forgets the system.
    pub(crate) fn clear(&mut self) {
        let Envelope { first, start, entries, lower, pivots, inverses } = self;
        for column in [first, start] {
            column.clear();
        }
        for column in [entries, lower, pivots, inverses] {
            column.clear();
        }
    }

    /// Adds a row that begins at a column, of zeros but for the diagonal.
    pub(crate) fn push(&mut self, first: usize, diagonal: i64) {
        let row = self.pivots.len();
        let first = first.min(row);
        self.first.push(first as u32);
        self.start.push(self.entries.len() as u32);
        self.entries.resize(self.entries.len() + row - first, 0);
        self.pivots.push(diagonal);
    }

    /// Sets an entry left of the diagonal of the last row, from its first column on.
    pub(crate) fn set(&mut self, column: usize, value: i64) {
        let row = self.pivots.len() - 1;
        let at = (self.start[row] as usize + column) - self.first[row] as usize;
        self.entries[at] = value;
    }

    /// How many products it takes to factor it, at most.
    pub(crate) fn work(&self) -> u64 {
        let width = |(row, &first): (usize, &u32)| (row as u64) - u64::from(first);
        self.first.iter().enumerate().map(width).map(|width| width * (width + 1) / 2).sum()
    }

    /// Factors the system. Whether it is clearly positive definite.
    pub(crate) fn factor(&mut self) -> bool {
        let Envelope { first, start, entries, lower, pivots, inverses } = self;
        lower.clear();
        lower.resize(entries.len(), 0);
        inverses.clear();
        if pivots.len() > ROWS {
            return false;
        }
        for i in 0..pivots.len() {
            let (from, begin) = (first[i] as usize, start[i] as usize);
            let own = &mut entries[begin..begin + i - from];
            for j in from..i {
                let (from_j, begin_j) = (first[j] as usize, start[j] as usize);
                let k = from.max(from_j);
                if k < j {
                    let sum = product(&own[k - from..j - from], &lower[begin_j + k - from_j..begin_j + j - from_j]);
                    own[j - from] -= rounded(sum, 52);
                }
            }
            let below = &mut lower[begin..begin + i - from];
            for ((l, &c), &inverse) in below.iter_mut().zip(&*own).zip(&inverses[from..i]) {
                *l = rounded(c as i128 * inverse as i128, 50);
            }
            let pivot = pivots[i] - rounded(product(own, below), 52);
            if pivot < FLOOR {
                return false;
            }
            pivots[i] = pivot;
            inverses.push((((1 << 102) + (pivot as i128 >> 1)) / pivot as i128) as i64);
        }
        true
    }

    /// Puts the solution in place of a right side. Whether all of it stayed in its range.
    pub(crate) fn solve(&self, x: &mut [i64]) -> bool {
        let Envelope { first, start, entries: _, lower, pivots: _, inverses } = self;
        let row = |i: usize| (first[i] as usize, &lower[start[i] as usize..start[i] as usize + i - first[i] as usize]);
        for i in 0..x.len() {
            let (from, l) = row(i);
            let sum = rounded(product(l, &x[from..i]), 52);
            x[i] = x[i].saturating_sub(sum);
            if x[i].unsigned_abs() > FAR {
                return false;
            }
        }
        for (x, &inverse) in x.iter_mut().zip(inverses) {
            let value = rounded(*x as i128 * inverse as i128, 44);
            if value.unsigned_abs() > FAR {
                return false;
            }
            *x = value;
        }
        for i in (0..x.len()).rev() {
            let value = x[i];
            if value.unsigned_abs() > FAR {
                return false;
            }
            let (from, l) = row(i);
            for (x, &l) in x[from..i].iter_mut().zip(l) {
                *x = x.saturating_sub(rounded(l as i128 * value as i128, 52));
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{Envelope, FAR, FLOOR, ROWS};

    /// An arrow and a band, Q58.
    fn entry(i: usize, j: usize) -> i64 {
        match i - j {
            1 => -(1 << 57) + (i as i64) * 12_345_678_901,
            2 if i % 3 == 0 => 1 << 55,
            _ => 0,
        }
    }

    #[test]
    fn a_solution_put_in_gives_the_right_side_and_the_negative_gives_the_negative() {
        let size = 40usize;
        let mut envelope = Envelope::default();
        for i in 0..size {
            let first = i.saturating_sub(2);
            envelope.push(first, 5 << 56);
            for j in first..i {
                envelope.set(j, entry(i, j));
            }
        }
        assert!(envelope.factor());
        let right: Vec<i64> = (0..size as i64).map(|i| ((i * i * 7919) % 1000 - 500) << 36).collect();
        let mut x = right.clone();
        assert!(envelope.solve(&mut x));
        for (i, &right) in right.iter().enumerate() {
            let sum: i128 = (0..size)
                .map(|j| {
                    let a = if i == j { 5 << 56 } else { entry(i.max(j), i.min(j)) };
                    a as i128 * x[j] as i128
                })
                .sum();
            let off = (sum >> 58) - right as i128;
            assert!(off.abs() < 64, "row {i} is off by {off}");
        }
        let mut negative: Vec<i64> = right.iter().map(|r| -r).collect();
        assert!(envelope.solve(&mut negative));
        assert!(negative.iter().zip(&x).all(|(n, x)| *n == -*x), "odd");
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let mut envelope = Envelope::default();
        envelope.push(0, 1 << 58);
        envelope.push(0, 1 << 58);
        envelope.set(0, 1 << 58);
        assert!(!envelope.factor());
        envelope.clear();
        envelope.push(0, 1 << 58);
        assert!(envelope.factor());
        assert!(!envelope.solve(&mut [1 << 60]));
    }

    /// Rows without anything left of the diagonal.
    fn diagonal(rows: usize, pivot: i64) -> Envelope {
        let mut envelope = Envelope::default();
        (0..rows).for_each(|row| envelope.push(row, pivot));
        envelope
    }

    #[test]
    fn what_it_takes_ends_where_the_table_says() {
        assert!(diagonal(ROWS, 1 << 58).factor());
        assert!(!diagonal(ROWS + 1, 1 << 58).factor());
        assert!(diagonal(1, FLOOR).factor());
        assert!(!diagonal(1, FLOOR - 1).factor());
        let one = |pivot: i64, right: i64| {
            let mut envelope = diagonal(1, pivot);
            assert!(envelope.factor());
            let mut x = [right];
            envelope.solve(&mut x).then_some(x[0])
        };
        let far = FAR as i64;
        for sign in [1, -1] {
            assert_eq!(one(1 << 58, sign * far), Some(sign * far));
            assert_eq!(one(1 << 58, sign * (far + 1)), None);
            // A solution beyond its range is refused as well: of a half, twice the right side.
            assert_eq!(one(1 << 57, sign * (far >> 1)), Some(sign * far));
            assert_eq!(one(1 << 57, sign * ((far >> 1) + 1)), None);
        }
        // What a row above adds counts: x0 = b0 + x1/2.
        let two = |right: [i64; 2]| {
            let mut envelope = Envelope::default();
            envelope.push(0, 1 << 58);
            envelope.push(0, 5 << 56);
            envelope.set(0, -(1 << 57));
            assert!(envelope.factor());
            let mut x = right;
            envelope.solve(&mut x).then_some(x)
        };
        assert_eq!(two([far >> 1, far - (far >> 2)]), Some([far, far]));
        assert_eq!(two([(far >> 1) + 2, far - (far >> 2)]), None);
    }

    #[test]
    fn its_work_is_the_products_that_it_takes() {
        let mut envelope = Envelope::default();
        // Widths 0, 1, 2, 1, 4.
        [0, 0, 0, 2, 0].into_iter().for_each(|first| envelope.push(first, 1 << 58));
        assert_eq!(envelope.work(), 1 + 3 + 1 + 10);
        envelope.clear();
        assert_eq!(envelope.work(), 0);
    }
}
