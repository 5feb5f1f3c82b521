//! The built-in cases: every code of the chapter's Table 6.1, and its two examples.
//!
//! A code such as `1911001000-359` lists r, e, a, b, x, ẋ, y, ẏ, θ, θ̇ - f_o, ν, Ω. Where the
//! printed table differs from the codes, the codes are taken; the misprints are listed beside the
//! test.
use crate::case::error::CaseError;
use crate::case::parameters::{Parameters, natural_inertia};
use crate::case::value::Value;

/// A built-in case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedCase {
    /// Its code.
    pub code: &'static str,
    /// Where it stems from.
    pub about: &'static str,
    /// Its values.
    pub parameters: Parameters,
}

impl NamedCase {
    /// The keys and values to start from; the moment of inertia follows from the size, so that a
    /// case which is changed afterwards (another `a`) gets the inertia of its new size.
    pub fn entries(&self) -> Vec<(&'static str, Value)> {
        let stated = self
            .parameters
            .entries()
            .filter(|(key, _)| *key != "inertia");
        stated
            .filter_map(|(key, value)| Some((key, value?)))
            .collect()
    }

    /// The series of Table 6.1 that the case belongs to, or another remark on its origin.
    pub fn origin(&self) -> String {
        let series: Vec<&str> = series_of(self.code).collect();
        if series.is_empty() {
            self.about.to_owned()
        } else {
            series.join(", ")
        }
    }
}

/// Code, \[r, e, a, b, f_o, Ω\], and the origin of a case that is not in Table 6.1. All of them
/// start at rest at x = 0, y = 0.1, θ = 0, with ν = 0.5.
type Row = (&'static str, [f64; 6], &'static str);

const SLIDING: &str = "sliding-example";
const ROCKING: &str = "rocking-example";
const SQUARE: &str = "a=b (square), as printed";
const RECTANGLE: &str = "a>b (rectangle), as printed";

#[rustfmt::skip] // a table
const ROWS: &[Row] = &[
    ("1910001000-359", [1.5, 0.9, 0.1, 0.0, 0.3, 0.9], ""),
    ("2910001000-359", [2.5, 0.9, 0.1, 0.0, 0.3, 0.9], ""),
    ("1911001000-359", [1.5, 0.9, 0.1, 0.1, 0.3, 0.9], ""),
    ("2911001000-359", [2.5, 0.9, 0.1, 0.1, 0.3, 0.9], ""),
    ("1921001000-359", [1.5, 0.9, 0.2, 0.1, 0.3, 0.9], ""),
    ("2921001000-359", [2.5, 0.9, 0.2, 0.1, 0.3, 0.9], ""),
    ("1510001000-359", [1.5, 0.5, 0.1, 0.0, 0.3, 0.9], ""),
    ("1710001000-359", [1.5, 0.7, 0.1, 0.0, 0.3, 0.9], ""),
    ("1110001000-359", [1.5, 1.0, 0.1, 0.0, 0.3, 0.9], ""),
    ("1920001000-359", [1.5, 0.9, 0.2, 0.0, 0.3, 0.9], ""),
    ("1930001000-359", [1.5, 0.9, 0.3, 0.0, 0.3, 0.9], ""),
    ("1922001000-359", [1.5, 0.9, 0.2, 0.2, 0.3, 0.9], ""),
    ("1933001000-359", [1.5, 0.9, 0.3, 0.3, 0.3, 0.9], ""),
    ("1931001000-359", [1.5, 0.9, 0.3, 0.1, 0.3, 0.9], ""),
    ("1910001000-159", [1.5, 0.9, 0.1, 0.0, 0.1, 0.9], ""),
    ("1910001000-259", [1.5, 0.9, 0.1, 0.0, 0.2, 0.9], ""),
    ("1910001000-459", [1.5, 0.9, 0.1, 0.0, 0.4, 0.9], ""),
    ("1910001000-559", [1.5, 0.9, 0.1, 0.0, 0.5, 0.9], ""),
    ("1910001000-355", [1.5, 0.9, 0.1, 0.0, 0.3, 0.5], ""),
    ("1910001000-3575", [1.5, 0.9, 0.1, 0.0, 0.3, 0.75], ""),
    ("1910001000-3515", [1.5, 0.9, 0.1, 0.0, 0.3, 1.5], ""),
    ("1910001000-3520", [1.5, 0.9, 0.1, 0.0, 0.3, 2.0], ""),
    ("1911001000-559", [1.5, 0.9, 0.1, 0.1, 0.5, 0.9], SQUARE),
    ("1922001000-559", [1.5, 0.9, 0.2, 0.2, 0.5, 0.9], SQUARE),
    ("1933001000-559", [1.5, 0.9, 0.3, 0.3, 0.5, 0.9], SQUARE),
    ("1921001000-559", [1.5, 0.9, 0.2, 0.1, 0.5, 0.9], RECTANGLE),
    ("1931001000-559", [1.5, 0.9, 0.3, 0.1, 0.5, 0.9], RECTANGLE),
    (SLIDING, [1.5, 0.9, 0.1, 0.0, 0.27, 0.9], "eq. 6.57 (1910001000-2759)"),
    (ROCKING, [1.5, 0.9, 0.1, 0.0, 0.1, 0.9], "eq. 6.69"),
];

/// Table 6.1: its series with their codes, in its order; several codes belong to several series.
#[rustfmt::skip] // a table
const SERIES: &[(&str, &[&str])] = &[
    ("r", &["1910001000-359", "2910001000-359", "1911001000-359", "2911001000-359", "1921001000-359", "2921001000-359"]),
    ("e", &["1510001000-359", "1710001000-359", "1910001000-359", "1110001000-359"]),
    ("b=0 (circle)", &["1910001000-359", "1920001000-359", "1930001000-359"]),
    ("a=b (square)", &["1911001000-359", "1922001000-359", "1933001000-359"]),
    ("a>b (rectangle)", &["1911001000-359", "1921001000-359", "1931001000-359"]),
    ("f_o", &["1910001000-159", "1910001000-259", "1910001000-359", "1910001000-459", "1910001000-559"]),
    ("Ω", &["1910001000-355", "1910001000-3575", "1910001000-359", "1910001000-3515", "1910001000-3520"]),
];

/// The rows of Table 6.1 as (series, code), in its order.
pub fn table_6_1() -> impl Iterator<Item = (&'static str, &'static str)> {
    let series = SERIES.iter();
    series.flat_map(|(series, codes)| codes.iter().map(move |code| (*series, *code)))
}

/// The built-in cases, the standard one first.
pub fn named_cases() -> impl ExactSizeIterator<Item = NamedCase> {
    ROWS.iter()
        .map(|&(code, [r, e, a, b, f_o, omega], about)| NamedCase {
            code,
            about,
            parameters: Parameters {
                r,
                e,
                a,
                b,
                inertia: natural_inertia(a, b),
                f_o,
                omega,
                stop_when_settled: ![SLIDING, ROCKING].contains(&code),
                ..Parameters::STANDARD
            },
        })
}

/// The series of Table 6.1 to which a code belongs, in its order.
pub fn series_of(code: &str) -> impl Iterator<Item = &'static str> + '_ {
    let rows = table_6_1().filter(move |(_, of)| *of == code);
    rows.map(|(series, _)| series)
}

/// The built-in case of a code, or an error with the nearest codes.
///
/// ```
/// let case = snapload::named_case("1910001000-459")?;
/// assert_eq!(case.parameters.f_o, 0.4);
/// let error = snapload::named_case("1910001000-495").unwrap_err();
/// assert!(error.to_string().contains("1910001000-459"));
/// # Ok::<(), snapload::CaseError>(())
/// ```
pub fn named_case(code: &str) -> Result<NamedCase, CaseError> {
    named_cases().find(|case| case.code == code).ok_or_else(|| {
        // The distance is quadratic in the length, and a code is short.
        let searched: String = code.chars().take(40).collect();
        let score = |(code, _, about): &Row| match !searched.is_empty() && about.contains(&searched)
        {
            true => 1.0, // the chapter's own code of an example
            false => strsim::normalized_damerau_levenshtein(&searched, code),
        };
        let mut nearest: Vec<&Row> = ROWS.iter().collect();
        nearest.sort_by(|p, q| score(q).total_cmp(&score(p)));
        let nearest: Vec<&str> = nearest.iter().take(3).map(|row| row.0).collect();
        CaseError::unknown_case(code, &nearest)
    })
}
