//! Numbers in words, with as many digits as they need.

use std::borrow::Borrow;

/// Larger numbers are written with a power of ten.
const LONGEST: f64 = 1e12;

/// Smaller numbers are rounding errors of zero.
const ZERO: f64 = 1e-7;

/// A number with `digits` decimals; a value that rounds to zero has no sign.
pub fn decimals(value: &f64, digits: usize) -> String {
    if value.abs() >= LONGEST {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(magnitude) if magnitude.bytes().all(|b| matches!(b, b'0' | b'.')) => magnitude.into(),
        _ => text,
    }
}

/// The number of decimals with which a number is written: `least` if they show two digits of it,
/// and otherwise as many as show three, so that a small number is not written as zero.
pub fn decimals_for(value: f64, least: usize) -> usize {
    if value.abs() < ZERO || !value.is_finite() {
        return least;
    }
    let before = value.abs().log10().floor() as i32;
    match before + least as i32 >= 1 {
        true => least,
        false => (2 - before).max(0) as usize,
    }
}

/// A number with as many decimals as [`decimals_for`] has for it.
pub fn digits(value: &f64, least: usize) -> String {
    decimals(value, decimals_for(*value, least))
}

/// A thousandth of a number in the same way: newtons as kilonewtons, kilograms as tonnes.
pub fn kilo(value: &f64, least: usize) -> String {
    digits(&(value / 1e3), least)
}

/// A number to a tenth, without a decimal if it is whole; a number below 1 with two digits.
pub fn tenths(value: &f64) -> String {
    let unit = match value.abs() {
        small if (ZERO..1.0).contains(&small) => 10_f64.powi(1 - small.log10().floor() as i32),
        _ => 10.0,
    };
    ((unit * value).round() / unit).to_string()
}

/// A number as it was given: all of its digits, with a power of ten where there would be too many.
pub fn in_full(value: &f64) -> String {
    match value.abs() {
        usual if usual == 0.0 || (1e-4..1e7).contains(&usual) => value.to_string(),
        _ if !value.is_finite() => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// The most that is allowed, in four digits, which do not exceed it.
pub fn rounded_down(most: f64) -> f64 {
    let unit = 10_f64.powi((most.log10().floor() - 3.0) as i32);
    let near = [most, most - 0.5 * unit].map(|value| format!("{value:.3e}").parse());
    let shown = near.into_iter().flatten().find(|shown| *shown <= most);
    shown.unwrap_or(most)
}

/// A number of things, such as `1 snap` or `2 snaps`.
pub fn count(number: impl Borrow<u64>, noun: &str) -> String {
    let number = *number.borrow();
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::{count, decimals, digits, kilo, rounded_down, tenths};

    #[test]
    fn one_thing_has_no_plural() {
        assert_eq!(
            [0, 1, 2].map(|n| count(n, "snap")),
            ["0 snaps", "1 snap", "2 snaps"]
        );
    }

    #[test]
    fn rounding_leaves_no_sign_and_no_endless_digits() {
        let written = [-0.0004, -0.0006, 0.0, -2.0, f64::INFINITY].map(|value| decimals(&value, 3));
        assert_eq!(written, ["0.000", "-0.001", "0.000", "-2.000", "inf"]);
        assert_eq!(decimals(&5.1e302, 1), "5.1e302");
    }

    #[test]
    fn small_numbers_keep_three_digits() {
        let written = [132.4, 99.6, 12.3, 9.874, 0.011_123, -0.4567, 3e-9, 0.0];
        let written = written.map(|value| digits(&value, 0));
        let known = ["132", "100", "12", "9.87", "0.0111", "-0.457", "0", "0"];
        assert_eq!(written, known);
        assert_eq!([digits(&7.34, 1), digits(&0.734, 1)], ["7.3", "0.734"]);
        assert_eq!(kilo(&11.1, 0), "0.0111");
        let none = [f64::INFINITY, f64::NAN].map(|value| digits(&value, 1));
        assert_eq!(none, ["inf", "NaN"]);
    }

    #[test]
    fn a_limit_that_is_shown_is_allowed() {
        assert_eq!(rounded_down(0.0), 0.0);
        for k in 0..20_000 {
            let most = 1.000_37_f64.powi(k - 10_000);
            let shown = rounded_down(most);
            assert!(shown <= most && shown > most * 0.999, "{most:e} {shown:e}");
        }
    }

    #[test]
    fn times_are_written_to_a_tenth() {
        let written = [8.54, 60.0, 0.04, 0.0437, 0.0, 10800.04].map(|value| tenths(&value));
        assert_eq!(written, ["8.5", "60", "0.04", "0.044", "0", "10800"]);
    }
}
