//! The lines and units of WAMIT's text files.

use super::fortran::number;
use crate::error::HydroError;
use crate::water::Water;
use std::f64::consts::PI;

/// What the first column of a file holds: WAMIT's IPEROUT from 1 to 4, with its length L (ULEN).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstColumn {
    /// T \[s\].
    #[default]
    Period,
    /// ω \[rad/s\]; zero and negative values stand for zero and infinite frequency.
    Frequency,
    /// KL with K = ω²/g whatever the depth; zero and negative values as for the frequency.
    InfiniteDepthWaveNumber,
    /// kL at the depth h, ω² = g k tanh(kh); zero and negative values as for the frequency.
    WaveNumber,
}

impl FirstColumn {
    /// The words for them, in cases and options.
    pub const WORDS: [&str; 4] = [
        "period",
        "frequency",
        "infinite-depth-wavenumber",
        "wavenumber",
    ];

    /// The one that a word means.
    #[must_use]
    pub fn from_word(word: &str) -> Option<Self> {
        match word {
            "period" => Some(Self::Period),
            "frequency" => Some(Self::Frequency),
            "infinite-depth-wavenumber" => Some(Self::InfiniteDepthWaveNumber),
            "wavenumber" => Some(Self::WaveNumber),
            _ => None,
        }
    }
}

/// The numbers of surge, heave and pitch among WAMIT's modes.
pub(super) const MODES: [usize; 3] = [1, 3, 5];

/// The units of a model's files.
pub(super) struct Units {
    pub water: Water,
    /// L \[m\].
    pub length: f64,
    pub first: FirstColumn,
}

impl Units {
    /// ω from a first column.
    pub fn omega(&self, first: f64) -> f64 {
        let g = self.water.gravity_m_s2;
        match self.first {
            FirstColumn::Period if first < 0.0 => 0.0,
            FirstColumn::Period if first == 0.0 => f64::INFINITY,
            FirstColumn::Period => 2.0 * PI / first,
            _ if first < 0.0 => f64::INFINITY,
            FirstColumn::Frequency => first,
            FirstColumn::InfiniteDepthWaveNumber => (g * first / self.length).sqrt(),
            FirstColumn::WaveNumber if first == 0.0 => 0.0,
            FirstColumn::WaveNumber => {
                let k = first / self.length;
                (g * k * (k * self.water.depth_m).tanh()).sqrt()
            }
        }
    }

    /// L to a power.
    pub fn power(&self, exponent: usize) -> f64 {
        self.length.powi(exponent as i32)
    }
}

/// The number of each line, from 1 on, and its numbers. Lines before the first line of numbers are
/// skipped.
pub(super) fn lines<'a>(
    name: &'static str,
    text: &'a str,
    counts: std::ops::RangeInclusive<usize>,
) -> impl Iterator<Item = Result<(usize, Vec<f64>), HydroError>> + 'a {
    let refused = separated_otherwise(text).map(|(index, line)| {
        let beginning: String = line.trim().chars().take(60).collect();
        let found = format!("line {} is {beginning:?}", index + 1);
        let expected = "numbers with decimal points and spaces between them are expected";
        Err(HydroError::layout(name, found, expected))
    });
    let lines = text.lines().enumerate();
    let lines = lines.skip_while(|(_, line)| !begins_with_two_numbers(line));
    let lines = lines.filter(|(_, line)| !line.trim().is_empty());
    let lines = lines.map(move |(index, line)| {
        let numbers: Option<Vec<f64>> = line.split_whitespace().map(number).collect();
        match numbers {
            Some(numbers) if counts.contains(&numbers.len()) => Ok((index + 1, numbers)),
            Some(numbers) => {
                let found = format!("line {} has {} numbers", index + 1, numbers.len());
                let expected = match (counts.start(), counts.end()) {
                    (least, most) if least == most => format!("{most} are expected"),
                    (least, most) => format!("{least} or {most} are expected"),
                };
                Err(HydroError::layout(name, found, expected))
            }
            None => {
                let beginning: String = line.trim().chars().take(60).collect();
                let found = format!("line {} is {beginning:?}", index + 1);
                Err(HydroError::layout(name, found, "numbers are expected"))
            }
        }
    });
    refused.into_iter().chain(lines)
}

/// The first line of numbers, and its index, if commas or semicolons separate those of all lines.
fn separated_otherwise(text: &str) -> Option<(usize, &str)> {
    if text.lines().any(begins_with_two_numbers) {
        return None;
    }
    let mut lines = text.lines().enumerate();
    lines.find(|(_, line)| begins_with_two_numbers(&line.replace([';', ','], " ")))
}

/// Whether a line begins as all lines of numbers do, with two of them, even if they or what follows
/// can not be read: then it is no heading.
fn begins_with_two_numbers(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let mut next = || words.next().is_some_and(is_like_a_number);
    next() && next()
}

/// Whether a word is a number, has only the letters of one, or is what Fortran writes where it does
/// not fit.
fn is_like_a_number(word: &str) -> bool {
    let of_number = |c: char| c.is_ascii_digit() || "+-.eEdD*".contains(c);
    let of_value = |c: char| c.is_ascii_digit() || c == '*';
    number(word).is_some() || word.chars().all(of_number) && word.contains(of_value)
}

/// A mode, 1 to 6; those of further bodies are refused.
pub(super) fn mode(name: &'static str, value: f64) -> Result<usize, HydroError> {
    let whole = value.fract() == 0.0 && (1.0..=6.0).contains(&value);
    if whole {
        return Ok(value as usize);
    }
    let expected = "the modes of one body are expected, 1 to 6";
    Err(HydroError::value(
        format!("a mode of {name}"),
        value,
        expected,
    ))
}

pub(super) fn place(mode: usize) -> Option<usize> {
    MODES.iter().position(|known| *known == mode)
}

/// 1 for a rotation, else 0.
pub(super) fn rotation(mode: usize) -> usize {
    usize::from(mode > 3)
}

/// Whether values differ that are given twice. Damping at ω = 0 and ∞ may be no number.
pub(super) fn differ(before: &[f64], now: &[f64]) -> bool {
    let mut pairs = before.iter().zip(now);
    pairs.any(|(a, b)| a != b && !(a.is_nan() && b.is_nan()))
}

/// A copy of a line does no harm, but of two different ones it is not known which one is right.
pub(super) fn twice(name: &'static str, what: String) -> HydroError {
    let expected = "both have to be the same; is it two runs in one file?";
    HydroError::layout(
        name,
        format!("{what} occurs twice, with different values"),
        expected,
    )
}
