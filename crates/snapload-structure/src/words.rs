//! Templates as text: paragraphs, and labels with their texts. The texts are in `templates/`.

use askama::Template;

/// Columns of the text beside a label.
const WIDTH: usize = 98;

/// The text of a template as one paragraph.
pub(crate) fn paragraph(template: &impl Template) -> String {
    let text = template.to_string();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The lines of a template; below the first line, those with a bar are a label and its text.
pub(crate) fn laid_out(template: &impl Template) -> String {
    let text = template.to_string();
    let (heading, rows) = text.split_once('\n').unwrap_or((&text, ""));
    let row = |row: &str| match row.split_once('|') {
        Some((label, words)) => told(label, words),
        None => format!("{row}\n"),
    };
    format!("{heading}\n{}", rows.lines().map(row).collect::<String>())
}

/// A label and its text, wrapped to a readable width.
pub fn told(label: &str, words: &str) -> String {
    let mut text = format!("  {label:<10}");
    let mut column = 0;
    for word in words.split(' ') {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > WIDTH {
            text.push_str("\n            ");
            column = 0;
        }
        if column > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += width;
    }
    text.push('\n');
    text
}

/// Larger numbers are written with a power of ten.
const LONGEST: f64 = 1e12;

/// A number with `digits` decimals; a value that rounds to zero has no sign.
pub(crate) fn decimals(value: &f64, digits: usize) -> String {
    if value.abs() >= LONGEST {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(magnitude) if magnitude.bytes().all(|b| matches!(b, b'0' | b'.')) => magnitude.into(),
        _ => text,
    }
}

/// Less than this is what rounding leaves of nothing.
const NOTHING: f64 = 1e-7;

/// How many decimals a number is told with: so many where they show two digits of it, else as many
/// as show three, so that what is small is not told as nothing.
pub(crate) fn decimals_for(value: f64, least: usize) -> usize {
    if value.abs() < NOTHING {
        return least;
    }
    let before = value.abs().log10().floor() as i32;
    match before + least as i32 >= 1 {
        true => least,
        false => (2 - before).max(0) as usize,
    }
}

/// A number with as many decimals as [`decimals_for`] has for it.
pub(crate) fn digits(value: &f64, least: usize) -> String {
    decimals(value, decimals_for(*value, least))
}

/// A thousandth of a number in the same way: newtons as kilonewtons, kilograms as tonnes.
pub(crate) fn kilo(value: &f64, least: usize) -> String {
    digits(&(value / 1e3), least)
}

/// Kilonewtons of a tension that is not always known.
pub(crate) fn maybe_kilo(newtons: &Option<f64>) -> String {
    newtons.map_or("not known".to_owned(), |newtons| kilo(&newtons, 0))
}

/// A number to a tenth, without one where it is whole.
pub(crate) fn tenths(value: &f64) -> String {
    let rounded = (10.0 * value).round() / 10.0;
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::{decimals, digits, kilo};

    #[test]
    fn small_numbers_keep_three_digits() {
        let written = [132.4, 99.6, 12.3, 9.874, 0.011_123, -0.4567, 3e-9, 0.0];
        let written = written.map(|value| digits(&value, 0));
        let known = ["132", "100", "12", "9.87", "0.0111", "-0.457", "0", "0"];
        assert_eq!(written, known);
        assert_eq!([digits(&7.34, 1), digits(&0.734, 1)], ["7.3", "0.734"]);
        assert_eq!(kilo(&11.1, 0), "0.0111");
    }

    #[test]
    fn rounding_leaves_no_sign_and_no_endless_digits() {
        let written = [-0.0004, -0.0006, 0.0, -2.0, f64::INFINITY].map(|value| decimals(&value, 3));
        assert_eq!(written, ["0.000", "-0.001", "0.000", "-2.000", "inf"]);
        assert_eq!(decimals(&5.1e302, 1), "5.1e302");
    }
}
