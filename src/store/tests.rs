//! Tables compared: rows that one side alone has, and rows with other fields.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use super::{Cells, Draft, Kind, Sheet, Show, Spot, Tables};

/// Of two colliders, with something that it may have.
#[derive(Clone, Copy)]
struct Pair(u32, u32, Option<i64>);

impl Show for Pair {
    fn show(&self, cells: &mut Cells<'_>) {
        let Pair(a, b, value) = self;
        cells.field("a", |c| a.show(c));
        cells.field("b", |c| b.show(c));
        cells.field("value", |c| value.show(c));
    }
}

struct Kept(Vec<u8>);

impl Tables for Kept {
    fn table(&mut self, _: &'static str, bytes: &[u8]) {
        self.0 = bytes.to_vec();
    }
}

fn table(kind: Kind, rows: &[Pair]) -> Vec<u8> {
    let mut kept = Kept(Vec::new());
    Draft::default().table(&mut kept, "pairs", kind, rows.iter());
    kept.0
}

/// Rows of either side, the field, and both values.
type Place = ([Option<usize>; 2], String, [Option<i128>; 2]);

fn differences(kind: Kind, a: &[Pair], b: &[Pair], most: usize) -> Vec<Place> {
    let (a, b) = (table(kind, a), table(kind, b));
    let [a, b] = [&a, &b].map(|bytes| Sheet::read(bytes).expect("a table"));
    let spots = a.differences(&b, most);
    spots.into_iter().map(|Spot { rows, field, cells }| (rows, field, cells.map(|cell| Some(cell?.value)))).collect()
}

const PAIRS: [Pair; 4] = [Pair(0, 1, Some(5)), Pair(0, 2, Some(6)), Pair(1, 2, Some(7)), Pair(3, 4, Some(8))];

#[test]
fn equal_tables_differ_nowhere() {
    for kind in [Kind::Pair, Kind::List] {
        assert_eq!(differences(kind, &PAIRS, &PAIRS, 9), []);
        assert_eq!(differences(kind, &[], &[], 9), []);
    }
}

#[test]
fn pairs_that_one_side_alone_has_are_rows_of_their_own() {
    let without = [PAIRS[0], PAIRS[2], PAIRS[3]];
    let alone = |rows| (rows, String::new(), [None, None]);
    assert_eq!(differences(Kind::Pair, &PAIRS, &without, 9), [alone([Some(1), None])]);
    assert_eq!(differences(Kind::Pair, &without, &PAIRS, 9), [alone([None, Some(1)])]);
    // On either side one of its own, and the last one is another.
    let other = [PAIRS[0], PAIRS[2], Pair(2, 3, Some(1)), Pair(3, 4, Some(9))];
    let eight_and_nine = ([Some(3), Some(3)], "value".to_owned(), [Some(8), Some(9)]);
    assert_eq!(
        differences(Kind::Pair, &PAIRS, &other, 9),
        [alone([Some(1), None]), alone([None, Some(2)]), eight_and_nine]
    );
    // The first places only.
    assert_eq!(differences(Kind::Pair, &PAIRS, &other, 2), [alone([Some(1), None]), alone([None, Some(2)])]);
    assert_eq!(differences(Kind::Pair, &PAIRS[..2], &[], 9), [alone([Some(0), None]), alone([Some(1), None])]);
}

#[test]
fn a_key_that_a_fault_changed_is_named_as_a_field() {
    let mut faulty = PAIRS;
    faulty[1].1 = 2 | 1 << 20;
    let field = ([Some(1), Some(1)], "b".to_owned(), [Some(2), Some(2 | 1 << 20)]);
    assert_eq!(differences(Kind::Pair, &PAIRS, &faulty, 9), [field]);
}

#[test]
fn what_has_no_keys_goes_by_its_order() {
    let shorter = &PAIRS[..3];
    assert_eq!(differences(Kind::List, &PAIRS, shorter, 9), [([Some(3), None], String::new(), [None, None])]);
    let places = differences(Kind::List, shorter, &PAIRS[1..], 9);
    let fields: Vec<_> = places.iter().map(|(rows, field, _)| (rows[0], field.as_str())).collect();
    assert_eq!(fields[..3], [(Some(0), "b"), (Some(0), "value"), (Some(1), "a")]);
}

#[test]
fn rows_with_other_fields_are_compared_by_name() {
    let mut less = PAIRS;
    less[2].2 = None;
    let rows = [Some(2), Some(2)];
    let given = |a: i128, b: i128| (rows, "value.given".to_owned(), [Some(a), Some(b)]);
    let value = |values| (rows, "value".to_owned(), values);
    assert_eq!(differences(Kind::Pair, &PAIRS, &less, 9), [given(1, 0), value([Some(7), None])]);
    assert_eq!(differences(Kind::Pair, &less, &PAIRS, 9), [given(0, 1), value([None, Some(7)])]);
}
