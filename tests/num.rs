//! Numbers against exact arithmetic: kernels, text, `f64`, angles and μ.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod num_oracle;

use core::fmt::Debug;
use core::str::FromStr;
use num_bigint::{BigInt, BigUint};
use num_oracle::{
    any_i64, any_u128, decimal_expansion, decimal_rounded, decimal_value, draws, limited, nearest_away, nearest_even,
    nearest_root, pi, power, ratio, signed,
};
use num_rational::BigRational;
use proptest::prelude::*;
use tamias2d::num::{
    Decimal, Quantity, add_sat, clamp_i64, cross, cross_wide, div, dot, hypot, mul, mul_add, mul_div, round_shift, sqrt,
};
use tamias2d::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Damping, Energy, Force, Impulse, Inertia, Length, Mass, Mu,
    NumError, Radians, RangeError, Torque, Velocity,
};

fn big(value: impl Into<BigInt>) -> BigInt {
    value.into()
}

/// `sum / 2^shift` as the product kernels promise it.
fn product(sum: BigInt, shift: u32) -> BigInt {
    limited(nearest_away(&ratio(sum, power(shift))), 63)
}

// Kernels.

proptest! {
    #![proptest_config(draws(20_000))]

    #[test]
    fn round_shift_is_the_nearest_integer_for_every_shift(value in signed(128), shift in 0u32..=127) {
        prop_assert_eq!(big(round_shift(value, shift)), nearest_away(&ratio(value, power(shift))));
    }

    #[test]
    fn round_shift_beyond_the_width_gives_zero(value in signed(128), shift in 128u32..) {
        prop_assert_eq!(round_shift(value, shift), 0);
    }

    #[test]
    fn clamp_i64_limits_to_the_symmetric_range(value in signed(128)) {
        prop_assert_eq!(big(clamp_i64(value)), limited(big(value), 63));
    }

    #[test]
    fn add_sat_is_the_sum_in_the_symmetric_range(a in any_i64(), b in any_i64()) {
        prop_assert_eq!(big(add_sat(a, b)), limited(big(a) + b, 63));
    }

    #[test]
    fn mul_is_the_rounded_product(a in any_i64(), b in any_i64(), shift in 1u32..=126) {
        prop_assert_eq!(big(mul(a, b, shift)), product(big(a) * b, shift));
    }

    #[test]
    fn mul_add_rounds_once(
        a in any_i64(), b in any_i64(), c in any_i64(), lift in 0u32..=62, shift in 1u32..=126,
    ) {
        prop_assert_eq!(big(mul_add(a, b, c, lift, shift)), product(big(a) * b + (big(c) << lift), shift));
    }

    #[test]
    fn cross_wide_rounds_an_exact_difference_once(
        a in [signed(127), signed(127)], b in [signed(127), signed(127)], shift in 1u32..=127, alike in any::<bool>(),
    ) {
        // Also nearly parallel vectors, whose products cancel.
        let b = if alike { [a[0].saturating_add(b[0] >> 90), a[1].saturating_add(b[1] >> 90)] } else { b };
        let limit = |v: [i128; 2]| v.map(|x| limited(big(x), 126));
        let ([ax, ay], [bx, by]) = (limit(a), limit(b));
        let exact = nearest_away(&ratio(ax * by - ay * bx, power(shift)));
        prop_assert_eq!(big(cross_wide(a, b, shift)), limited(exact, 127));
    }

    #[test]
    fn dot_rounds_once(
        ax in any_i64(), ay in any_i64(), bx in any_i64(), by in any_i64(), shift in 0u32..=127,
    ) {
        prop_assert_eq!(big(dot([ax, ay], [bx, by], shift)), product(big(ax) * bx + big(ay) * by, shift));
    }

    #[test]
    fn cross_rounds_once(
        ax in any_i64(), ay in any_i64(), bx in any_i64(), by in any_i64(), shift in 0u32..=127,
    ) {
        prop_assert_eq!(big(cross([ax, ay], [bx, by], shift)), product(big(ax) * by - big(ay) * bx, shift));
    }

    #[test]
    fn div_is_the_nearest_integer(n in signed(128), d in signed(128)) {
        prop_assert_eq!(big(div(n, d)), quotient(big(n), d));
    }

    #[test]
    fn div_is_the_nearest_integer_for_operands_of_a_size(n in signed(128), d in signed(64)) {
        prop_assert_eq!(big(div(n, d)), quotient(big(n), d));
        // An exact tie where the numbers have room for it.
        if let Some(tie) = d.checked_mul(n % (1 << 60)).and_then(|m| m.checked_add(d / 2)) {
            prop_assert_eq!(big(div(tie, d)), quotient(big(tie), d));
        }
    }

    #[test]
    fn mul_div_is_the_nearest_integer(a in signed(128), b in signed(128), d in signed(128)) {
        prop_assert_eq!(big(mul_div(a, b, d)), quotient(big(a) * b, d));
    }

    #[test]
    fn mul_div_meets_its_ties(quotients in signed(100), d in signed(128)) {
        // a·2/d with a = q·d/2: a tie for every odd q·d.
        let even = quotients & !1;
        if let Some(a) = (even / 2).checked_mul(d) {
            prop_assert_eq!(mul_div(a, 2, d), if d == 0 { 0 } else { even });
            prop_assert_eq!(big(mul_div(a, 3, d)), quotient(big(a) * 3, d));
        }
    }

    #[test]
    fn sqrt_is_the_nearest_root(value in any_u128()) {
        prop_assert_eq!(BigUint::from(sqrt(value)), nearest_root(&value.into()).min(u64::MAX.into()));
    }

    #[test]
    fn hypot_is_the_nearest_length(x in any_i64(), y in any_i64()) {
        let square = (big(x) * x + big(y) * y).magnitude().clone();
        prop_assert_eq!(BigUint::from(hypot(x, y)), nearest_root(&square));
    }

    #[test]
    fn every_kernel_is_odd(a in any_i64(), b in any_i64(), c in any_i64(), d in signed(128), shift in 1u32..=126) {
        // The least values have no negation; the limited ones have.
        let [a, b, c] = [a, b, c].map(|value| value.max(-i64::MAX));
        let d = d.max(-i128::MAX);
        prop_assert_eq!(round_shift(-d, shift), -round_shift(d, shift));
        prop_assert_eq!(clamp_i64(-d), -clamp_i64(d));
        prop_assert_eq!(add_sat(-a, -b), -add_sat(a, b));
        prop_assert_eq!(mul(-a, b, shift), -mul(a, b, shift));
        prop_assert_eq!(mul_add(-a, b, -c, shift % 63, shift), -mul_add(a, b, c, shift % 63, shift));
        prop_assert_eq!(dot([-a, -b], [b, a], shift), -dot([a, b], [b, a], shift));
        prop_assert_eq!(cross([-a, -b], [b, b], shift), -cross([a, b], [b, b], shift));
        prop_assert_eq!(div(-d, c.into()), -div(d, c.into()));
        prop_assert_eq!(mul_div(-d, c.into(), a.into()), -mul_div(d, c.into(), a.into()));
        if c != 0 {
            prop_assert_eq!(div(d, (-c).into()), -div(d, c.into()));
        }
    }
}

/// `n / d` as `div` and `mul_div` promise it.
fn quotient(n: BigInt, d: i128) -> BigInt {
    let zero = big(0);
    let limit: BigInt = power(127) - 1;
    match (d, n.cmp(&zero)) {
        (0, core::cmp::Ordering::Less) => -limit,
        (0, core::cmp::Ordering::Equal) => zero,
        (0, core::cmp::Ordering::Greater) => limit,
        _ => limited(nearest_away(&ratio(n, d)), 127),
    }
}

#[test]
fn kernels_hold_at_the_ends_of_their_types() {
    const EDGES: [i64; 7] = [i64::MIN, -i64::MAX, -1, 0, 1, i64::MAX - 1, i64::MAX];
    for a in EDGES {
        for b in EDGES {
            assert_eq!(big(add_sat(a, b)), limited(big(a) + b, 63), "{a} + {b}");
            assert_eq!(BigUint::from(hypot(a, b)), nearest_root((big(a) * a + big(b) * b).magnitude()), "{a}, {b}");
            for shift in [1, 2, 62, 63, 64, 65, 125, 126] {
                assert_eq!(big(mul(a, b, shift)), product(big(a) * b, shift), "{a}·{b} >> {shift}");
                assert_eq!(big(dot([a, a], [b, b], shift)), product(big(a) * b * 2, shift), "2·{a}·{b} >> {shift}");
                assert_eq!(big(cross([a, b], [b, a], shift)), product(big(a) * a - big(b) * b, shift), "{a}, {b}");
                for (c, lift) in EDGES.into_iter().flat_map(|c| [(c, 0), (c, 1), (c, 61), (c, 62)]) {
                    let exact = product(big(a) * b + (big(c) << lift), shift);
                    assert_eq!(big(mul_add(a, b, c, lift, shift)), exact, "({a}·{b} + {c} << {lift}) >> {shift}");
                }
            }
        }
    }
    for a in [i128::MIN, -i128::MAX, -1, 0, 1, i128::MAX] {
        for shift in [0, 1, 2, 126, 127] {
            assert_eq!(big(round_shift(a, shift)), nearest_away(&ratio(a, power(shift))), "{a} >> {shift}");
        }
        assert_eq!(round_shift(a, 200), 0);
        for b in [i128::MIN, -i128::MAX, -2, -1, 0, 1, 2, i128::MAX] {
            assert_eq!(big(div(a, b)), quotient(big(a), b), "{a} / {b}");
            for d in [i128::MIN, -i128::MAX, -2, -1, 0, 1, 2, i128::MAX] {
                assert_eq!(big(mul_div(a, b, d)), quotient(big(a) * b, d), "{a}·{b} / {d}");
            }
        }
    }
}

#[test]
fn round_shift_is_exact_for_all_small_numbers() {
    for value in -4096i128..=4096 {
        for shift in 0..=16 {
            // Nearest, ties away: the only integer q with |2·value − 2·q·2^shift| < 2^shift, or the outer one at a tie.
            let (q, unit) = (round_shift(value, shift), 1i128 << shift);
            let off = 2 * (q * unit - value).abs();
            assert!(off < unit || (off == unit && (q * unit).abs() > value.abs()), "{value} >> {shift} gave {q}");
        }
    }
}

#[test]
fn div_is_exact_for_all_small_numbers() {
    for n in -64i128..=64 {
        for d in (-64i128..=64).filter(|&d| d != 0) {
            let q = div(n, d);
            let off = 2 * (q * d - n).abs();
            assert!(off < d.abs() || (off == d.abs() && (q * d).abs() > n.abs()), "{n} / {d} gave {q}");
            for b in [-7, -1, 0, 1, 2, 64] {
                assert_eq!(mul_div(n, b, d), div(n * b, d), "{n}·{b} / {d}");
            }
        }
        assert_eq!(div(n, 0), n.signum() * i128::MAX);
    }
}

#[test]
fn sqrt_is_exact_for_all_small_numbers_and_around_the_squares_at_word_ends() {
    for value in 0..1u128 << 16 {
        assert_eq!(BigUint::from(sqrt(value)), nearest_root(&value.into()), "the root of {value}");
    }
    for middle in [1u128 << 16, 1 << 32, 1 << 63, 1 << 64] {
        for root in middle - 400..middle + 400 {
            // The square, the last value that rounds down to its root, the first that rounds up, and neighbours.
            let square = BigUint::from(root) * root;
            for by in [0, 1, root - 1, root, root + 1, root + 2, 2 * root, 2 * root + 1] {
                for value in [&square + by, &square - by.min(root)] {
                    let Ok(small) = u128::try_from(value.clone()) else { continue };
                    let exact = nearest_root(&value).min(u64::MAX.into());
                    assert_eq!(BigUint::from(sqrt(small)), exact, "the root of {value}");
                }
            }
        }
    }
    assert_eq!(sqrt(u128::MAX), u64::MAX);
}

// Quantities.

/// What the tests need of a quantity beyond its trait: raw bits, text and `f64`.
trait Sample: Quantity + Debug + FromStr<Err = NumError> {
    /// Bits in the format.
    const WIDTH: u32;
    const SIGNED: bool;
    fn of(bits: &BigInt) -> Self;
    fn raw(self) -> BigInt;
    fn float(value: f64) -> Result<Self, NumError>;
    fn to_float(self) -> f64;
}

macro_rules! samples {
    ($($name:ident $signed:literal)*) => {$(
        impl Sample for $name {
            const WIDTH: u32 = 8 * size_of::<$name>() as u32;
            const SIGNED: bool = $signed;

            fn of(bits: &BigInt) -> Self {
                $name::from_bits(bits.clone().try_into().expect("bits of the format"))
            }

            fn raw(self) -> BigInt {
                self.to_bits().into()
            }

            fn float(value: f64) -> Result<Self, NumError> {
                $name::from_f64(value)
            }

            fn to_float(self) -> f64 {
                $name::to_f64(self)
            }
        }
    )*};
}

samples! {
    Acceleration true Angle true AngularImpulse true AngularVelocity true Damping true Energy true Force true
    Impulse true Inertia true Length true Mass true Mu false Radians true Torque true Velocity true
}

/// Calls a generic function for every quantity.
macro_rules! for_all {
    ($function:ident($($argument:expr),*)) => {{
        $function::<Acceleration>($($argument),*);
        $function::<Angle>($($argument),*);
        $function::<AngularImpulse>($($argument),*);
        $function::<AngularVelocity>($($argument),*);
        $function::<Damping>($($argument),*);
        $function::<Energy>($($argument),*);
        $function::<Force>($($argument),*);
        $function::<Impulse>($($argument),*);
        $function::<Inertia>($($argument),*);
        $function::<Length>($($argument),*);
        $function::<Mass>($($argument),*);
        $function::<Mu>($($argument),*);
        $function::<Radians>($($argument),*);
        $function::<Torque>($($argument),*);
        $function::<Velocity>($($argument),*);
    }};
}

/// Bits of the format drawn from `raw`; of [`Mu`], which prints no more, within what its accepted range can hold.
fn bits_of<Q: Sample>(raw: i128) -> BigInt {
    if Q::SIGNED { big(raw >> (128 - Q::WIDTH)) } else { big(raw.unsigned_abs() >> 1) }
}

fn range_text<Q: Sample>(value: &str) -> String {
    let (name, unit, accepted) = (Q::NAME, Q::UNIT, Q::ACCEPTED);
    format!("{name} {value} {unit} is outside {accepted} {unit}")
}

fn is_accepted<Q: Sample>(bits: &BigInt) -> bool {
    (Q::MIN.raw()..=Q::MAX.raw()).contains(bits)
}

fn text_is_exact<Q: Sample>(raw: i128) {
    let bits = bits_of::<Q>(raw);
    let value = Q::of(&bits);
    let text = decimal_expansion(&bits, Q::FRAC);
    assert_eq!(value.to_string(), text);
    assert_eq!(format!("{value:?}"), format!("{text} {}", Q::UNIT));
    match text.parse::<Q>() {
        Ok(read) => {
            assert_eq!(read.raw(), bits, "{} {text}", Q::NAME);
            assert!(is_accepted::<Q>(&bits), "{} {text} was accepted", Q::NAME);
        }
        Err(error) => {
            assert_eq!(error.to_string(), range_text::<Q>(&text));
            assert!(!is_accepted::<Q>(&bits), "{} {text} was refused", Q::NAME);
        }
    }
    let checked = value.checked().map(Q::raw).map_err(|error| error.to_string());
    assert_eq!(checked, if is_accepted::<Q>(&bits) { Ok(bits) } else { Err(range_text::<Q>(&text)) });
}

/// Reads `text` and compares with the fraction it denotes, rounded to nearest, ties to even.
fn reads_as<Q: Sample>(text: &str) {
    let exact = nearest_even(&(decimal_value(text) * power(Q::FRAC)));
    match text.parse::<Q>() {
        Ok(read) => {
            assert_eq!(read.raw(), exact, "{} {text}", Q::NAME);
            assert!(is_accepted::<Q>(&exact), "{} {text} was accepted", Q::NAME);
        }
        Err(NumError::Range(error)) => {
            assert!(!is_accepted::<Q>(&exact), "{} {text} was refused: {error}", Q::NAME);
            assert_eq!((error.quantity, error.unit, error.accepted), (Q::NAME, Q::UNIT, Q::ACCEPTED));
        }
        Err(other) => panic!("{} {text}: {other}", Q::NAME),
    }
}

/// Reads the tie just above `bits` and what lies just beside it.
fn ties_read_to_even<Q: Sample>(raw: i128, off: usize) {
    let tie: BigInt = bits_of::<Q>(raw) * 2 + 1;
    let text = decimal_expansion(&tie, Q::FRAC + 1);
    reads_as::<Q>(&text);
    reads_as::<Q>(&format!("{text}{}1", "0".repeat(off)));
    // One unit of the last place less in magnitude: the expansion of a tie ends in 5.
    let below = format!("{}4{}", text.strip_suffix('5').expect("a tie ends in 5"), "9".repeat(off));
    reads_as::<Q>(&below);
}

fn decimal_text() -> impl Strategy<Value = String> {
    let exponent = prop_oneof![
        3 => Just(String::new()),
        2 => ("[eE][+-]?", 0..=99u32).prop_map(|(e, n)| format!("{e}{n}")),
        2 => ("[eE][+-]?", 0..=20u32).prop_map(|(e, n)| format!("{e}{n:03}")),
    ];
    let mantissa = prop_oneof![
        "[0-9]{1,12}(\\.[0-9]{1,30})?",
        "[0-9]{1,40}(\\.[0-9]{1,100})?",
        "0\\.0{0,20}[0-9]{1,20}",
        "[1-9]0{0,25}(\\.0{0,10}1)?",
    ];
    (prop_oneof![Just(""), Just("-")], mantissa, exponent).prop_map(|(sign, m, e)| format!("{sign}{m}{e}"))
}

proptest! {
    #![proptest_config(draws(3_000))]

    #[test]
    fn every_quantity_prints_exactly_and_reads_back(raw in prop_oneof![any::<i128>(), signed(128)]) {
        for_all!(text_is_exact(raw));
    }

    #[test]
    fn small_values_print_exactly_and_read_back(raw in signed(64), shift in 0u32..64) {
        for_all!(text_is_exact((raw << 64) >> shift));
    }

    #[test]
    fn text_reads_to_the_nearest_value(text in decimal_text()) {
        for_all!(reads_as(&text));
    }

    #[test]
    fn ties_in_text_read_to_even(raw in prop_oneof![any::<i128>(), signed(128)], off in 0usize..60) {
        // Not at the format's end, where the tie above the greatest value lies.
        for_all!(ties_read_to_even(raw, off));
    }

    #[test]
    fn decimal_prints_all_digits_or_rounds_ties_away(bits in signed(128), frac in 0u32..=64, places in 0u32..=64) {
        let decimal = Decimal { bits, frac };
        prop_assert_eq!(decimal.to_string(), decimal_expansion(&big(bits), frac));
        let places_wide = places as usize;
        prop_assert_eq!(format!("{decimal:.places_wide$}"), decimal_rounded(&big(bits), frac, places));
    }

    #[test]
    fn decimal_rounds_ties_away_where_there_are_ties(whole in -2000i128..2000, frac in 1u32..=64) {
        // An odd numerator over 2^(places + 1) ends in 5 at its last place: a tie for one place less.
        let bits = 2 * whole + 1;
        for places in [frac as usize - 1, frac.saturating_sub(2) as usize] {
            let decimal = Decimal { bits, frac };
            prop_assert_eq!(format!("{decimal:.places$}"), decimal_rounded(&big(bits), frac, places as u32));
        }
    }
}

#[test]
fn decimal_rounding_carries_through_nines() {
    for (bits, frac, places, text) in [
        (i128::MAX, 64, 0, "9223372036854775808"),
        (i128::MIN, 64, 0, "-9223372036854775808"),
        (i128::MIN, 0, 2, "-170141183460469231731687303715884105728.00"),
        (-1, 64, 3, "0.000"),
        (-1, 1, 0, "-1"),
        (1, 1, 0, "1"),
        (319, 5, 1, "10.0"),
        (-319, 5, 1, "-10.0"),
        (0, 64, 4, "0.0000"),
    ] {
        assert_eq!(format!("{:.places$}", Decimal { bits, frac }), text);
    }
}

fn refuses_malformed_text<Q: Sample>() {
    let long = format!("1.{}", "0".repeat(255));
    assert_eq!(long.len(), 257);
    let malformed = [
        "",
        "-",
        "--1",
        "+",
        "+1",
        ".",
        ".5",
        "-.5",
        "1.",
        "1.e5",
        "1..2",
        "1.2.3",
        "e",
        "e5",
        "1e",
        "1e+",
        "1e-",
        "1e100",
        "1e-100",
        "1e99999999999999999999",
        "1e1.5",
        "1e5e5",
        "0x1",
        "0b1",
        "1_000",
        "1,5",
        " 1",
        "1 ",
        "1\n",
        "\t1",
        "nan",
        "NaN",
        "inf",
        "-inf",
        "infinity",
        "１",
        "٣",
        "1\u{a0}",
        "−1",
        "½",
        "1\0",
        &long,
    ];
    let expected = format!("{} is not a decimal number of at most 256 characters with an exponent within ±99", Q::NAME);
    for text in malformed {
        let error = text.parse::<Q>().expect_err(text);
        assert_eq!(error, NumError::Malformed { quantity: Q::NAME }, "{text:?}");
        assert_eq!(error.to_string(), expected, "{text:?}");
    }
}

#[test]
fn malformed_text_is_refused_by_every_quantity() {
    for_all!(refuses_malformed_text());
}

#[test]
fn the_longest_and_smallest_texts_are_read() {
    let longest = format!("1.{}", "0".repeat(254));
    assert_eq!(longest.len(), 256);
    assert_eq!(longest.parse::<Length>(), Ok(Length::from_bits(1 << 32)));
    let digits = "9".repeat(256);
    let refused = digits.parse::<Length>().expect_err("far outside").to_string();
    assert!(refused.starts_with("length ") && refused.ends_with(" m is outside ±1000000000 m"), "{refused}");
    for (text, bits) in [
        ("0", 0),
        ("-0", 0),
        ("-0.0e-99", 0),
        ("0e99", 0),
        ("1e-99", 0),
        ("-1e-99", 0),
        ("000000000000001", 1 << 32),
        ("1e0", 1 << 32),
        ("1E+00", 1 << 32),
        ("10e-01", 1 << 32),
        ("0.000000001e+9", 1 << 32),
        ("-2.5", -5 << 31),
        // Half a unit, exactly, is a tie; three halves another.
        ("0.000000000116415321826934814453125", 0),
        ("0.000000000349245965480804443359375", 2),
        ("0.000000000116415321826934814453126", 1),
    ] {
        assert_eq!(text.parse::<Length>(), Ok(Length::from_bits(bits)), "{text}");
    }
}

#[test]
fn a_negative_zero_reads_as_zero_where_nothing_negative_is_accepted() {
    for text in ["-0", "-0.000", "-0e5", "-1e-99"] {
        assert_eq!(text.parse::<Mu>().map(Mu::to_bits), Ok(0), "mu {text}");
        assert_eq!(text.parse::<Damping>().map(Damping::to_bits), Ok(0), "damping {text}");
    }
    assert_eq!(Mu::from_f64(-0.0).map(Mu::to_bits), Ok(0));
    assert_eq!(Damping::from_f64(-0.0).map(Damping::to_bits), Ok(0));
}

fn limits_are_accepted_and_one_unit_more_is_not<Q: Sample>() {
    let (least, greatest) = (Q::MIN.raw(), Q::MAX.raw());
    let (format_least, format_greatest): (BigInt, BigInt) =
        if Q::SIGNED { (-power(Q::WIDTH - 1), power(Q::WIDTH - 1) - 1) } else { (big(0), power(Q::WIDTH) - 1) };
    for end in [&least, &greatest] {
        let text = decimal_expansion(end, Q::FRAC);
        assert_eq!(text.parse::<Q>().map(Q::raw), Ok(end.clone()), "{} {text}", Q::NAME);
        assert_eq!(Q::of(end).checked().map(Q::raw), Ok(end.clone()));
    }
    for beyond in [least - 1, greatest + 1] {
        let text = decimal_expansion(&beyond, Q::FRAC);
        let error = text.parse::<Q>().expect_err("beyond the range").to_string();
        // What 64 whole bits hold is named exactly.
        if beyond.bits() < u64::from(63 + Q::FRAC) {
            assert_eq!(error, range_text::<Q>(&text));
        }
        if (format_least.clone()..=format_greatest.clone()).contains(&beyond) {
            let value = Q::of(&beyond);
            let error = value.checked().expect_err("beyond the range");
            assert_eq!(error.to_string(), range_text::<Q>(&text));
            let expected =
                RangeError { quantity: Q::NAME, unit: Q::UNIT, value: value.decimal(), accepted: Q::ACCEPTED };
            assert_eq!(error, expected);
        }
    }
}

#[test]
fn limits_are_accepted_by_every_quantity_and_one_unit_more_is_not() {
    for_all!(limits_are_accepted_and_one_unit_more_is_not());
}

#[test]
fn range_errors_name_the_value_and_the_range() {
    fn refused<Q: Sample>(text: &str) -> String {
        text.parse::<Q>().expect_err(text).to_string()
    }
    assert_eq!(refused::<Length>("1000000000.5"), "length 1000000000.5 m is outside ±1000000000 m");
    assert_eq!(refused::<Length>("-1e10"), "length -10000000000 m is outside ±1000000000 m");
    assert_eq!(refused::<Mass>("0"), "mass 0 kg is outside 0.000001 … 2100000000 kg");
    assert_eq!(refused::<Mass>("-1"), "mass -1 kg is outside 0.000001 … 2100000000 kg");
    assert_eq!(refused::<Inertia>("0"), "inertia 0 kg m² is outside 1e-12 … 1e18 kg m²");
    assert_eq!(refused::<Force>("1e15"), "force 1000000000000000 N is outside ±1e14 N");
    assert_eq!(refused::<Torque>("-2e18"), "torque -2000000000000000000 N m is outside ±1e18 N m");
    assert_eq!(refused::<Damping>("-0.5"), "damping -0.5 1/s is outside 0 … 1000 1/s");
    assert_eq!(refused::<Damping>("1000.5"), "damping 1000.5 1/s is outside 0 … 1000 1/s");
    assert_eq!(refused::<Mu>("-1"), "mu -1 m³/s² is outside 0 … 2e21 m³/s²");
    assert_eq!(refused::<Mu>("2.1e21"), "mu 2100000000000000000000 m³/s² is outside 0 … 2e21 m³/s²");
}

/// Whether a fraction lies inside the accepted range, its ends left out.
fn is_inside<Q: Sample>(value: &BigRational) -> bool {
    let end = |q: Q| ratio(q.raw(), power(Q::FRAC));
    *value > end(Q::MIN) && *value < end(Q::MAX)
}

fn names_no_value_inside<Q: Sample>(text: &str) {
    if let Err(error) = text.parse::<Q>() {
        let NumError::Range(RangeError { value: Decimal { bits, frac }, .. }) = error else { panic!("{error}") };
        assert!(!is_inside::<Q>(&ratio(bits, power(frac))), "{text} was refused with: {error}");
    }
    let float: f64 = text.parse().expect("a number");
    if let Err(error) = Q::float(float) {
        let NumError::Range(RangeError { value: Decimal { bits, frac }, .. }) = error else { panic!("{error}") };
        assert!(!is_inside::<Q>(&ratio(bits, power(frac))), "{text} as f64 was refused with: {error}");
    }
}

#[test]
fn a_range_error_never_names_a_value_inside_the_range() {
    for text in ["1e10", "1e15", "2e18", "1e19", "2.1e21", "2.4e21", "4e21", "5e21", "1e30", "1e99"] {
        for_all!(names_no_value_inside(text));
        for_all!(names_no_value_inside(&format!("-{text}")));
    }
}

/// The ends that a range's text names, where it names plain numbers: `±a` or `a … b`.
fn ends_named_are_accepted<Q: Sample>() {
    let ends = match (Q::ACCEPTED.strip_prefix('±'), Q::ACCEPTED.split_once(" … ")) {
        (Some(end), None) => [format!("-{end}"), end.to_owned()],
        (None, Some((least, greatest))) => [least.to_owned(), greatest.to_owned()],
        _ => panic!("{} is another way to write a range", Q::ACCEPTED),
    };
    for end in ends.iter().filter(|end| end.bytes().all(|b| b.is_ascii_digit() || b"-.e".contains(&b))) {
        if let Err(error) = end.parse::<Q>() {
            panic!("{end} is named as an end of the range, but: {error}");
        }
    }
}

#[test]
fn the_ends_that_range_errors_name_are_accepted_in_every_bounded_format() {
    ends_named_are_accepted::<AngularImpulse>();
    ends_named_are_accepted::<Damping>();
    ends_named_are_accepted::<Energy>();
    ends_named_are_accepted::<Force>();
    ends_named_are_accepted::<Impulse>();
    ends_named_are_accepted::<Length>();
    ends_named_are_accepted::<Mass>();
    ends_named_are_accepted::<Mu>();
    ends_named_are_accepted::<Torque>();
}

#[test]
fn the_ends_that_range_errors_name_are_accepted_for_inertia() {
    ends_named_are_accepted::<Inertia>();
    assert!(Inertia::from_f64(1e-12).is_ok());
}

#[test]
fn the_ends_that_range_errors_name_are_accepted_in_whole_formats() {
    ends_named_are_accepted::<Acceleration>();
    ends_named_are_accepted::<Angle>();
    ends_named_are_accepted::<AngularVelocity>();
    ends_named_are_accepted::<Radians>();
    ends_named_are_accepted::<Velocity>();
}

// serde.

mod readable {
    //! The two directions of a readable format: a formatter writes, a text is read.
    use serde::de::IntoDeserializer;
    use serde::{Deserialize, Serialize};

    pub struct Written<'a, T>(pub &'a T);

    impl<T: Serialize> core::fmt::Display for Written<'_, T> {
        fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            self.0.serialize(f)
        }
    }

    pub fn read<'de, T: Deserialize<'de>>(text: &'de str) -> Result<T, String> {
        let deserializer: serde::de::value::StrDeserializer<'de, serde::de::value::Error> = text.into_deserializer();
        T::deserialize(deserializer).map_err(|error| error.to_string())
    }
}

#[test]
fn readable_formats_carry_the_exact_text() {
    let length = Length::from_bits(-1);
    let text = readable::Written(&length).to_string();
    assert_eq!(text, "-0.00000000023283064365386962890625");
    assert_eq!(readable::read::<Length>(&text), Ok(length));
    let inertia = Inertia::MAX;
    assert_eq!(readable::read(&readable::Written(&inertia).to_string()), Ok(inertia));
    assert_eq!(readable::Written(&Mu::MAX).to_string(), "2000000000000000000000");
    let refused = readable::read::<Mass>("0").expect_err("no mass");
    assert_eq!(refused, "mass 0 kg is outside 0.000001 … 2100000000 kg");
    let refused = readable::read::<Mass>("heavy").expect_err("no number");
    assert_eq!(refused, "mass is not a decimal number of at most 256 characters with an exponent within ±99");
}

// f64.

/// `from_f64` against the fraction that an `f64` is.
fn converts_from_f64<Q: Sample>(value: f64) {
    let fraction = BigRational::from_float(value).expect("a finite number");
    let exact = nearest_even(&(&fraction * power(Q::FRAC)));
    match Q::float(value) {
        Ok(read) => {
            assert_eq!(read.raw(), exact, "{} {value:e}", Q::NAME);
            assert!(is_accepted::<Q>(&exact), "{} {value:e} was accepted", Q::NAME);
            if fraction == ratio(exact, power(Q::FRAC)) {
                assert!(read.to_float() == value, "{} {value:e} came back as {:e}", Q::NAME, read.to_float());
            }
        }
        Err(NumError::Range(error)) => {
            assert!(!is_accepted::<Q>(&exact), "{} {value:e} was refused: {error}", Q::NAME);
            assert_eq!((error.quantity, error.unit, error.accepted), (Q::NAME, Q::UNIT, Q::ACCEPTED));
        }
        Err(other) => panic!("{} {value:e}: {other}", Q::NAME),
    }
}

/// `to_f64` against both neighbours: none is nearer, and at a tie the even one is given.
fn converts_to_nearest_f64<Q: Sample>(raw: i128) {
    let bits = bits_of::<Q>(raw);
    let value = Q::of(&bits).to_float();
    let exact = ratio(bits, power(Q::FRAC));
    let off = |float: f64| {
        let by = BigRational::from_float(float).expect("finite") - &exact;
        if by < ratio(0, 1) { -by } else { by }
    };
    let pattern = value.to_bits();
    let even = pattern & 1 == 0;
    if value == 0.0 {
        assert_eq!(exact, ratio(0, 1));
        return;
    }
    for neighbour in [pattern - 1, pattern + 1].map(f64::from_bits) {
        let (here, there) = (off(value), off(neighbour));
        assert!(here < there || (here == there && even), "{} {exact} gave {value:e}", Q::NAME);
    }
}

fn sized_f64() -> impl Strategy<Value = f64> {
    // 53 bits at an exponent around the formats' own, sign and trailing zeros at random.
    (any::<i64>(), 0u32..53, -150i32..80).prop_map(|(raw, zeros, exponent)| {
        let mantissa = (raw >> 10 >> zeros << zeros) as f64;
        mantissa * 2f64.powi(exponent - 53)
    })
}

proptest! {
    #![proptest_config(draws(3_000))]

    #[test]
    fn every_f64_is_read_exactly_or_to_nearest(value in sized_f64()) {
        for_all!(converts_from_f64(value));
    }

    #[test]
    fn f64_of_any_bits_is_read_or_refused(pattern in any::<u64>()) {
        let value = f64::from_bits(pattern);
        if value.is_finite() {
            for_all!(converts_from_f64(value));
        }
    }

    #[test]
    fn f64_ties_are_read_to_even(n in -(1i64 << 51)..1 << 51, zeros in 0u32..51) {
        let odd = (2 * (n >> zeros) + 1) as f64;
        for frac in [32, 48, 56, 64] {
            for_all!(converts_from_f64(odd * 2f64.powi(-(frac + 1))));
        }
    }

    #[test]
    fn every_quantity_gives_the_nearest_f64(raw in prop_oneof![any::<i128>(), signed(128)]) {
        for_all!(converts_to_nearest_f64(raw));
    }
}

fn refuses_what_is_no_number<Q: Sample>() {
    for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = Q::float(value).map(Q::raw).expect_err("not finite");
        assert_eq!(error, NumError::NotFinite { quantity: Q::NAME });
        assert_eq!(error.to_string(), format!("{} is not a finite number", Q::NAME));
    }
    for value in [f64::MAX, f64::MIN, 1e22, -1e22] {
        let error = Q::float(value).map(Q::raw).expect_err("out of range");
        assert!(matches!(error, NumError::Range(_)), "{} {value:e}", Q::NAME);
    }
}

#[test]
fn nan_infinities_and_huge_f64_are_refused_by_every_quantity() {
    for_all!(refuses_what_is_no_number());
    let error = Length::from_f64(1e9 + 0.5).expect_err("too far");
    assert_eq!(error.to_string(), "length 1000000000.5 m is outside ±1000000000 m");
    let error = Velocity::from_f64(-40_000.25).expect_err("too fast");
    assert_eq!(error.to_string(), format!("velocity -40000.25 m/s is outside {} m/s", Velocity::ACCEPTED));
}

// Angles.

/// 2⁻²⁰⁰ more exact than any format here.
const PI_BITS: u32 = 256;

fn tau() -> BigRational {
    ratio(pi(PI_BITS) * 2, power(PI_BITS))
}

/// One turn in the bits of an angle.
const TURN: i64 = 1 << 48;

fn absolute(value: BigRational) -> BigRational {
    if value < ratio(0, 1) { -value } else { value }
}

/// The greatest bits of radians that are at most 2π.
fn tau_bits() -> i64 {
    (tau() * power(48)).floor().to_integer().try_into().expect("2π in 48 fraction bits")
}

#[test]
fn an_orientation_is_accepted_from_zero_to_two_pi() {
    let of = |bits| Angle::from_radians(Radians::from_bits(bits));
    assert_eq!(of(0), Ok(Angle::ZERO));
    assert_eq!(of(1), Ok(Angle::ZERO));
    // Two pi, down to where the rounding to 2⁻⁴⁸ turns no longer reaches the whole turn.
    let tau = tau_bits();
    assert_eq!(tau, 1_768_559_438_007_110);
    for below in 0..=3 {
        assert_eq!(of(tau - below), Ok(Angle::ZERO), "2π − {below} units");
    }
    assert_eq!(of(tau - 4), Ok(Angle::from_bits(TURN - 1)));
    // Up to half a unit of 2⁻⁴⁸ turns above, which is π units of 2⁻⁴⁸ rad, 2π is what is meant.
    for above in 1..=3 {
        assert_eq!(of(tau + above), Ok(Angle::ZERO), "2π + {above} units");
    }
    for bits in [tau + 4, tau + 100, tau * 2, i64::MAX, -1, -tau, i64::MIN] {
        let error = of(bits).expect_err("outside");
        assert_eq!(error.to_string(), format!("angle {} rad is outside 0 … 2π rad", Radians::from_bits(bits)));
    }
}

#[test]
fn radians_never_reach_two_pi() {
    // All ones: 2π less 2⁻⁴⁸ turns, floored to the unit of the radians.
    let greatest = (tau() * big(TURN - 1)).floor().to_integer();
    assert_eq!(greatest, big(tau_bits() - 7));
    for whole in [0, 1, -1, 32_767, -32_768] {
        let radians = |fraction: i64| big(Angle::from_bits((whole << 48) | fraction).radians().to_bits());
        assert_eq!(radians(0), big(0));
        assert_eq!(radians(TURN / 2), big(tau_bits() / 2));
        assert_eq!(radians(TURN - 1), greatest);
    }
}

/// How far the unwrapped angle of `bits` radians is from the exact one, in units of 2⁻⁴⁸ turns.
fn from_radians_error(bits: i64, tau: &BigRational) -> BigRational {
    let exact = ratio(bits, 1) / tau;
    absolute(ratio(Angle::from_any_radians(Radians::from_bits(bits)).to_bits(), 1) - exact)
}

proptest! {
    #![proptest_config(draws(20_000))]

    #[test]
    fn radians_of_any_angle_are_floored_into_one_turn(bits in any_i64()) {
        let angle = Angle::from_bits(bits);
        let fraction = bits.rem_euclid(TURN);
        prop_assert_eq!(big(angle.fraction()), big(fraction));
        let radians = angle.radians().to_bits();
        prop_assert!((0..=tau_bits()).contains(&radians));
        // Floored to 2⁻⁴⁸ rad, of a 2π with 60 fraction bits: within one unit and 2⁻¹³ of it.
        let short = ratio(fraction, 1) * tau() - ratio(radians, 1);
        prop_assert!(short > ratio(-1, 1 << 13) && short < ratio((1 << 13) + 1, 1 << 13));
        // The way back is exact: a unit of the radians is a sixth of one of the turns.
        prop_assert_eq!(Angle::from_radians(angle.radians()).map(Angle::to_bits), Ok(fraction));
    }

    #[test]
    fn unwrapped_angles_are_odd(bits in any_i64()) {
        let bits = bits.max(-i64::MAX);
        let of = |bits| Angle::from_any_radians(Radians::from_bits(bits)).to_bits();
        prop_assert_eq!(of(-bits), -of(bits));
    }

    #[test]
    fn unwrapped_angles_are_nearest(bits in any_i64()) {
        // 1/2π has 64 fraction bits: at 2^63 units of radians its own rounding adds up to a quarter of a unit.
        let slack = ratio(1, 2) + ratio(big(bits).magnitude().clone(), power(65));
        prop_assert!(from_radians_error(bits, &tau()) <= slack);
    }

    #[test]
    fn radians_come_back_from_an_orientation(share in 0u64..1 << 50) {
        // Half a unit of 2⁻⁴⁸ turns is π units of 2⁻⁴⁸ rad, and the floor takes one more: at most 4.15 units,
        // 1.5e-14 rad.
        let bits = (((tau_bits() - 4) as i128 * share as i128) >> 50) as i64;
        let back = Angle::from_radians(Radians::from_bits(bits)).map(|angle| angle.radians().to_bits());
        prop_assert!(back.is_ok_and(|back| (back - bits).abs() <= 4), "{bits} came back as {back:?}");
    }
}

#[test]
fn orientations_in_degrees_are_within_half_a_unit() {
    // The measured bound, over 2^16 angles of one turn: half a unit of 2⁻⁴⁸ turns and less than 2⁻¹⁴ of one more.
    let (tau, top) = (tau(), tau_bits());
    let worst = (0..1i64 << 16).map(|k| from_radians_error(((top as i128 * k as i128) >> 16) as i64, &tau)).max();
    assert!(worst.is_some_and(|worst| worst < ratio(1, 2) + ratio(1, 1 << 14)));
}

#[test]
fn angles_for_drawing_are_within_an_ulp() {
    for (bits, radians) in [(0, 0.0), (TURN / 4, 0.5), (TURN / 2, 1.0), (-TURN / 4, -0.5), (-1000 * TURN, -2000.0)] {
        let drawn = Angle::from_bits(bits).to_radians_f64();
        let expected = radians * core::f64::consts::PI;
        assert!((drawn - expected).abs() <= 1e-14 + 1e-15 * expected.abs(), "{bits} units are {drawn}");
    }
    assert_eq!(Angle::from_radians_f64(core::f64::consts::PI), Ok(Angle::from_bits(TURN / 2)));
    assert!(Angle::from_radians_f64(-0.1).is_err());
    assert!(Angle::from_radians_f64(f64::NAN).is_err());
}

// μ.

#[test]
fn mu_of_kilograms_is_g_times_m_rounded_once() {
    let gravity = ratio(66_743, big(10).pow(15));
    let exact = |mass: u128| nearest_away(&(&gravity * big(mass) * power(56)));
    let largest = (ratio(Mu::MAX.raw(), power(56)) / &gravity).floor().to_integer();
    let largest = u128::try_from(largest).expect("a mass");
    for mass in [0, 1, 2, 7, 1000, 5_972_168_000_000_000_000_000_000, 1_988_416 << 80, largest - 1, largest] {
        assert_eq!(Mu::of_kilograms(mass).map(Mu::raw), Ok(exact(mass)), "{mass} kg");
    }
    assert_eq!(Mu::of_kilograms(0), Ok(Mu::ZERO));
    assert_eq!(
        format!("{:.0}", Mu::of_kilograms(5_972_168_000_000_000_000_000_000).expect("the Earth")),
        "398600408824000"
    );
    for mass in [largest + 1, largest * 2, i128::MAX as u128, i128::MAX as u128 + 1, u128::MAX] {
        let error = Mu::of_kilograms(mass).expect_err("too heavy");
        assert_eq!((error.quantity, error.accepted), ("mu", "0 … 2e21"));
        assert!(ratio(error.value.bits, power(error.value.frac)) > ratio(Mu::MAX.raw(), power(56)), "{error}");
    }
}

proptest! {
    #![proptest_config(draws(5_000))]

    #[test]
    fn mu_of_any_mass_is_rounded_once_or_refused(mass in any_u128()) {
        let exact = nearest_away(&(ratio(66_743, big(10).pow(15)) * big(mass) * power(56)));
        match Mu::of_kilograms(mass) {
            Ok(mu) => prop_assert_eq!(mu.raw(), exact),
            Err(_) => prop_assert!(exact > Mu::MAX.raw()),
        }
    }
}
