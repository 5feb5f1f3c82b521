//! The letters of a picture: embedded fonts, their widths, and italics between asterisks.

use ttf_parser::Face;

/// DejaVu Sans, with the letters that a figure may need.
pub(crate) const UPRIGHT: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");
/// DejaVu Sans Oblique, for symbols.
pub(crate) const ITALIC: &[u8] = include_bytes!("../assets/DejaVuSans-Oblique-subset.ttf");
/// The font families of the SVG, in order of preference.
pub(crate) const FAMILY: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";
/// The height of a capital letter or a digit, in units of the font size.
pub(crate) const CAP_HEIGHT: f64 = 0.729;
/// The size of letters next to ticks, in legends and at marks, in points.
pub(crate) const SMALL: f64 = 7.0;
/// The size of titles and of the labels of axes.
pub(crate) const LABEL: f64 = 8.0;

/// The height of a line of small text.
pub(crate) const ROW: f64 = 10.0;

/// The length of a tick.
pub(crate) const TICK: f64 = 2.5;
/// The distance from a tick to its number.
pub(crate) const TICK_GAP: f64 = 2.0;
/// The distance from the right side of a plot to the names of the lines across it.
pub(crate) const NAME_GAP: f64 = 2.5;

/// The parts of a text, and whether each is in italics. A single asterisk is a letter.
fn runs(text: &str) -> impl Iterator<Item = (&str, bool)> {
    let paired = text.matches('*').count().is_multiple_of(2);
    let lone = text.rfind('*').filter(|_| !paired);
    let (marked, rest) = text.split_at(lone.unwrap_or(text.len()));
    let parts = marked.split('*').enumerate();
    let parts = parts.map(|(index, part)| (part, index % 2 == 1));
    parts
        .chain([(rest, false)])
        .filter(|(part, _)| !part.is_empty())
}

/// The width of a text in units of the font size.
pub(crate) fn width(text: &str) -> f64 {
    runs(text)
        .map(|(part, italic)| run_width(part, italic))
        .sum()
}

fn run_width(text: &str, italic: bool) -> f64 {
    /// The width of a letter that the font does not have.
    const UNKNOWN: f64 = 0.6;
    let Ok(font) = Face::parse(if italic { ITALIC } else { UPRIGHT }, 0) else {
        return UNKNOWN * text.len() as f64;
    };
    let unit = f64::from(font.units_per_em());
    let advance = |c| {
        font.glyph_index(c)
            .and_then(|glyph| font.glyph_hor_advance(glyph))
    };
    text.chars()
        .map(|c| advance(c).map_or(UNKNOWN, |advance| f64::from(advance) / unit))
        .sum()
}

/// The width on paper of the widest of some small texts.
pub(crate) fn widest<'a>(texts: impl Iterator<Item = &'a str>) -> f64 {
    texts.map(|text| width(text) * SMALL).fold(0.0, f64::max)
}

/// The size at which a text fits the space, at most `size`.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> f64 {
    let wide = width(text) * size;
    if wide > room {
        size * (room / wide).max(0.05)
    } else {
        size
    }
}

/// A text as the content of an SVG `text` element.
pub(crate) fn markup(text: &str) -> String {
    let markup = |(part, italic)| match (italic, escape(part)) {
        (true, part) => format!("<tspan font-style=\"italic\">{part}</tspan>"),
        (false, part) => part,
    };
    runs(text).map(markup).collect()
}

/// A text without its marks for italics.
pub(crate) fn plain(text: &str) -> String {
    runs(text).map(|(part, _)| part).collect()
}

/// A text as XML content or attribute; characters that XML forbids become U+FFFD.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => out.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_measured_and_every_letter_that_a_figure_may_need_has_a_glyph() {
        assert!((width("0") - 0.636).abs() < 0.01);
        assert!(width("*θ*₁ = π/2") > 2.0);
        assert!((width("−") - 0.838).abs() < 0.01);
        let font = Face::parse(UPRIGHT, 0).expect("the embedded font is a font");
        let letters = "−±π×∘·≤≥√∞⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹₀₁₂₃ₙ→←↑↓θωνξ°éü";
        for c in letters.chars() {
            assert!(font.glyph_index(c).is_some(), "no glyph for {c}");
        }
    }
}
