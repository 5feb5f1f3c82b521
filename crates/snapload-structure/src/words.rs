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

#[cfg(test)]
mod tests {
    use super::decimals;

    #[test]
    fn rounding_leaves_no_sign_and_no_endless_digits() {
        let written = [-0.0004, -0.0006, 0.0, -2.0, f64::INFINITY].map(|value| decimals(&value, 3));
        assert_eq!(written, ["0.000", "-0.001", "0.000", "-2.000", "inf"]);
        assert_eq!(decimals(&5.1e302, 1), "5.1e302");
    }
}
