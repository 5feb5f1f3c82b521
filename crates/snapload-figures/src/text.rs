//! The letters of a picture: embedded fonts, their widths, and italics between asterisks.

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::{FontRef, MetadataProvider};

/// DejaVu Sans, the letters that a figure may need.
pub(crate) const UPRIGHT: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");
/// DejaVu Sans Oblique, for symbols.
pub(crate) const ITALIC: &[u8] = include_bytes!("../assets/DejaVuSans-Oblique-subset.ttf");
/// The fonts that a reader of the SVG looks for, in this order.
pub(crate) const FAMILY: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";
/// The height of a capital letter or a digit, in units of the font size.
pub(crate) const CAP_HEIGHT: f64 = 0.729;

/// A run of letters of one kind.
struct Run<'a> {
    text: &'a str,
    italic: bool,
}

/// Splits a text at its pairs of asterisks.
fn runs(text: &str) -> Vec<Run<'_>> {
    let mut parts: Vec<&str> = text.split('*').collect();
    let mut found = Vec::new();
    if parts.len().is_multiple_of(2) {
        // The last asterisk has no partner: it stands for itself, with what follows.
        let last = parts.pop().map_or(0, str::len);
        let kept = text.len() - last - 1;
        let open = kept - parts.pop().map_or(0, str::len);
        parts.push(&text[open..]);
    }
    for (index, text) in parts.into_iter().enumerate() {
        if !text.is_empty() {
            found.push(Run {
                text,
                italic: index % 2 == 1,
            });
        }
    }
    found
}

/// The width of a text in units of the font size.
pub(crate) fn width(text: &str) -> f64 {
    runs(text)
        .iter()
        .map(|run| run_width(run).unwrap_or(0.6 * run.text.len() as f64))
        .sum()
}

fn run_width(run: &Run<'_>) -> Option<f64> {
    let font = FontRef::new(if run.italic { ITALIC } else { UPRIGHT }).ok()?;
    let metrics = GlyphMetrics::new(&font, Size::new(1.0), LocationRef::default());
    let charmap = font.charmap();
    let advance = |c| {
        charmap
            .map(c)
            .and_then(|glyph| metrics.advance_width(glyph))
    };
    Some(
        run.text
            .chars()
            .map(|c| f64::from(advance(c).unwrap_or(0.6)))
            .sum(),
    )
}

/// A text as the content of an SVG `text` element.
pub(crate) fn markup(text: &str) -> String {
    runs(text)
        .iter()
        .map(|run| match (run.italic, escape(run.text)) {
            (true, text) => format!("<tspan font-style=\"italic\">{text}</tspan>"),
            (false, text) => text,
        })
        .collect()
}

/// A text without its marks for italics.
pub(crate) fn plain(text: &str) -> String {
    runs(text).iter().map(|run| run.text).collect()
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
    fn letters_between_asterisks_are_italic() {
        assert_eq!(
            markup("*t* in s"),
            "<tspan font-style=\"italic\">t</tspan> in s"
        );
        assert_eq!(markup("a < b"), "a &lt; b");
        assert_eq!(
            markup("*x* 2*3"),
            "<tspan font-style=\"italic\">x</tspan> 2*3"
        );
        assert_eq!(plain("case *π*"), "case π");
        assert_eq!(plain("*"), "*");
        assert_eq!(plain(""), "");
    }

    #[test]
    fn texts_are_measured() {
        assert!((width("0") - 0.636).abs() < 0.01);
        assert!(width("*θ*₁ = π/2") > 2.0);
        assert!((width("−") - 0.838).abs() < 0.01);
    }

    #[test]
    fn every_letter_that_a_figure_may_need_has_a_glyph() {
        let font = FontRef::new(UPRIGHT).expect("the embedded font is a font");
        let letters = "−±π×∘·≤≥√∞⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹₀₁₂₃ₙ→←↑↓θωνξ°éü";
        for c in letters.chars() {
            assert!(font.charmap().map(c).is_some(), "no glyph for {c}");
        }
    }
}
