//! Templates as text: paragraphs, and labels with their texts. The texts are in `templates/`.

use askama::Template;
pub(crate) use snapload_hydro::digits::{
    count, decimals, decimals_for, digits, in_full, kilo, rounded_down, tenths,
};

/// Columns of the text next to a label.
const WIDTH: usize = 98;

/// The text of a template as one paragraph.
pub(crate) fn paragraph(template: &impl Template) -> String {
    let text = template.to_string();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A ratio that is judged by whether it reaches 1, with two decimals; one next to 1 with as many as
/// show on which side of it it is.
pub(crate) fn ratio(value: &f64) -> String {
    let written = |decimals: usize| format!("{value:.decimals$}");
    let is_below = |text: &String| text.parse().is_ok_and(|number: f64| number < 1.0);
    let mut all = (2..=6).map(written);
    let shown = all.find(|text| is_below(text) == (*value < 1.0));
    shown
        .filter(|_| *value < 1e6)
        .unwrap_or_else(|| decimals(value, 2))
}

/// The lines of a template; below the first line, those with a bar are a label and its text.
pub(crate) fn lay_out(template: &impl Template) -> String {
    let text = template.to_string();
    let (heading, rows) = text.split_once('\n').unwrap_or((&text, ""));
    let row = |row: &str| match row.split_once('|') {
        Some((label, text)) => labelled_row(label, text),
        None => format!("{row}\n"),
    };
    format!("{heading}\n{}", rows.lines().map(row).collect::<String>())
}

/// A label and its text, wrapped to a readable width.
pub fn labelled_row(label: &str, text: &str) -> String {
    let mut row = format!("  {label:<10}");
    let mut column = 0;
    for word in text.split(' ') {
        let width = word.chars().count();
        if column > 0 && column + 1 + width > WIDTH {
            row.push_str("\n            ");
            column = 0;
        }
        if column > 0 {
            row.push(' ');
            column += 1;
        }
        row.push_str(word);
        column += width;
    }
    row.push('\n');
    row
}

/// A number of snaps in three hours, which is not 0 if there are any.
pub(crate) fn rate_text(snaps: f64) -> String {
    let decimals = if snaps >= 9.5 { 0 } else { 2 };
    format!("{snaps:.decimals$}")
}

/// Kilonewtons of a tension that is not always known.
pub(crate) fn kilo_or_not_known(newtons: &Option<f64>) -> String {
    newtons.map_or("not known".to_owned(), |newtons| kilo(&newtons, 0))
}

#[cfg(test)]
mod tests {
    use super::ratio;

    #[test]
    fn a_ratio_is_written_on_its_side_of_one() {
        let written = [0.74, 0.996, 0.9977, 0.99999, 1.0, 1.001].map(|value| ratio(&value));
        assert_eq!(
            written,
            ["0.74", "0.996", "0.998", "0.99999", "1.00", "1.00"]
        );
    }
}
