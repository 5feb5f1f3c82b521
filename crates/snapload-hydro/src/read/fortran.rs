//! Numbers as Fortran writes them.

/// A number, whose exponent may have a D for its E, or no letter where it takes three digits, which
/// leave no room for one: `0.123-104`.
pub(super) fn number(word: &str) -> Option<f64> {
    let word = word.replace(['d', 'D'], "e");
    let all_digits = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
    let cut = word
        .len()
        .checked_sub(4)
        .filter(|&k| word.is_char_boundary(k));
    if let Some((mantissa, exponent)) = cut.map(|k| word.split_at(k))
        && exponent.starts_with(['+', '-'])
        && all_digits(&exponent[1..])
        && mantissa.contains('.')
        && mantissa.ends_with(|last: char| last.is_ascii_digit() || last == '.')
    {
        return format!("{mantissa}e{exponent}").parse().ok();
    }
    word.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn exponents_are_read_in_all_ways_to_write_them() {
        for (word, value) in [
            ("0.125E+02", 12.5),
            ("-0.125D-02", -1.25e-3),
            ("1.25d1", 12.5),
            ("-0.12345-104", -1.2345e-105),
            ("0.12345+104", 1.2345e103),
            ("12.-100", 1.2e-99),
            ("1.5E-104", 1.5e-104),
            ("-104", -104.0),
        ] {
            assert_eq!(number(word), Some(value), "{word}");
        }
        // Two numbers without a space between them, as in a field that is too narrow.
        for word in [
            "1.25-2.25",
            "1.25-25",
            "125-104",
            "1.25E+02-104",
            "-",
            "±104",
            "1.5--104",
        ] {
            assert_eq!(number(word), None, "{word}");
        }
    }
}
