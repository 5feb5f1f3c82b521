//! The range of an axis, and the ticks on it.

use crate::plot::{Range, TickStyle, drawable};
use std::f64::consts::FRAC_PI_4;

/// An interval shown by an axis; the first number is the smaller.
pub(crate) type Span = (f64, f64);

/// The interval that `range` asks for, given the values of the data.
pub(crate) fn resolve(range: Range, data: impl Iterator<Item = f64>) -> Span {
    let requested = match range {
        Range::Fixed(a, b) => match ordered(a, b) {
            Some(span) if !narrow(span) => return span,
            _ => None,
        },
        Range::AtLeast(a, b) => ordered(a, b),
        Range::Auto => None,
    };
    match (data.map(|v| (v, v)).reduce(union), requested) {
        (Some(seen), Some(requested)) => union(with_air(seen), requested),
        (Some(seen), None) => with_air(seen),
        (None, Some(requested)) if !narrow(requested) => requested,
        (None, _) => (0.0, 1.0),
    }
}

/// The smallest interval that holds both.
pub(crate) fn union(a: Span, b: Span) -> Span {
    (a.0.min(b.0), a.1.max(b.1))
}

fn ordered(a: f64, b: f64) -> Option<Span> {
    drawable(&[a, b]).then(|| (a.min(b), a.max(b)))
}

/// Whether an interval is too short, absolutely or relative to its values, for ticks.
fn narrow((lo, hi): Span) -> bool {
    hi - lo <= 1e-10 * lo.abs().max(hi.abs()) || hi - lo < 1e-100
}

/// Whether the data are all one value.
pub(crate) fn is_constant(data: impl Iterator<Item = f64>) -> bool {
    let seen = data.map(|v| (v, v)).reduce(union);
    seen.is_none_or(narrow)
}

/// The interval with the width of another one, on an axis of the same scale.
pub(crate) fn as_wide((lo, hi): Span, other: Span) -> Span {
    let (middle, half) = (lo + (hi - lo) / 2.0, (other.1 - other.0) / 2.0);
    let wide = (middle - half, middle + half);
    if narrow(wide) { (lo, hi) } else { wide }
}

/// The interval of the data with a small margin at its ends, which does not extend across zero.
fn with_air((lo, hi): Span) -> Span {
    if narrow((lo, hi)) {
        let middle = lo + (hi - lo) / 2.0;
        let size = middle.abs();
        let half = if size < 1e-100 { 1.0 } else { 0.1 * size };
        return (middle - half, middle + half);
    }
    let air = 0.04 * (hi - lo);
    let lowered = |end: f64| {
        let moved = end - air;
        if end < 0.0 { moved } else { moved.max(0.0) }
    };
    (lowered(lo), -lowered(-hi))
}

/// The ticks on an axis and their texts.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    /// Each tick's position and text.
    pub(crate) at: Vec<(f64, String)>,
    /// A power of ten that multiplies all the texts, such as "×10⁻¹²"; empty for one.
    pub(crate) factor: String,
}

impl Ticks {
    /// The texts.
    pub(crate) fn texts(&self) -> impl Iterator<Item = &str> {
        self.at.iter().map(|(_, text)| text.as_str())
    }
}

/// Three to nine ticks on the interval.
pub(crate) fn ticks(style: TickStyle, span: Span) -> Ticks {
    // A multiple of π with many digits is less readable than a power of ten.
    let few_turns = span.0.abs().max(span.1.abs()) < 1e4;
    if style == TickStyle::Angle && few_turns && span.1 - span.0 >= 3.0 * FRAC_PI_4 {
        angle_ticks(span)
    } else {
        decimal_ticks(span)
    }
}

/// Ticks at the largest step of 1, 2 or 5 times a power of ten that gives three ticks on the
/// interval.
fn decimal_ticks((lo, hi): Span) -> Ticks {
    let (mantissa, exponent) = step_of((hi - lo) / 3.0);
    // Whole multiples of the step, so that a tick is exact and prints without 0.30000000000000004.
    let step = scaled(mantissa, exponent);
    let slack = 1e-9 * (hi - lo) / step;
    let first = (lo / step - slack).ceil() as i64;
    let last = (hi / step + slack).floor() as i64;
    let largest = lo.abs().max(hi.abs());
    let plain = (1e-3..1e5).contains(&largest);
    let power = if plain {
        0
    } else {
        largest.log10().floor() as i32
    };
    let places = (power - exponent).max(0) as usize;
    let tick = |k: i64| {
        let digits = k.saturating_mul(mantissa);
        let text = format!("{:.places$}", scaled(digits, exponent - power));
        (scaled(digits, exponent), text.replace('-', "−"))
    };
    let factor = if plain {
        String::new()
    } else {
        format!("×10{}", superscript(power))
    };
    let at = (first..=last).map(tick).collect();
    Ticks { at, factor }
}

/// The largest `(m, e)` with `m` one of 1, 2, 5 and `m × 10^e` not above `bound`.
fn step_of(bound: f64) -> (i64, i32) {
    let guess = bound.log10().floor() as i32;
    let bound = bound * (1.0 + 1e-9);
    // The logarithm may be off by one at a power of ten.
    [(1, guess + 1), (5, guess), (2, guess), (1, guess)]
        .into_iter()
        .find(|&(m, e)| scaled(m, e) <= bound)
        .unwrap_or((5, guess - 1))
}

/// `digits × 10^exponent`, rounded once where the power is exact.
fn scaled(digits: i64, exponent: i32) -> f64 {
    let power = 10_f64.powi(exponent.abs());
    if exponent < 0 {
        digits as f64 / power
    } else {
        digits as f64 * power
    }
}

fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    n.to_string().chars().map(raised).collect()
}

/// Ticks at multiples of π/4, π/2 or a round number of π.
fn angle_ticks((lo, hi): Span) -> Ticks {
    let third = (hi - lo) / 3.0 / FRAC_PI_4;
    // The step in quarters of π.
    let quarters = match third {
        ..2.0 => 1,
        2.0..4.0 => 2,
        _ => {
            let (mantissa, exponent) = step_of(third / 4.0);
            (4.0 * scaled(mantissa, exponent)) as i64
        }
    };
    let step = quarters as f64 * FRAC_PI_4;
    let (first, last) = ((lo / step).ceil() as i64, (hi / step).floor() as i64);
    let tick = |k: i64| (k as f64 * step, angle(k.saturating_mul(quarters)));
    Ticks {
        at: (first..=last).map(tick).collect(),
        factor: String::new(),
    }
}

/// `quarters × π/4`, as a fraction in lowest terms.
fn angle(quarters: i64) -> String {
    let sign = if quarters < 0 { "−" } else { "" };
    let (top, bottom) = match quarters.unsigned_abs() {
        0 => return "0".to_string(),
        n if n % 4 == 0 => (n / 4, ""),
        n if n % 2 == 0 => (n / 2, "/2"),
        n => (n, "/4"),
    };
    let top = if top == 1 {
        String::new()
    } else {
        top.to_string()
    };
    format!("{sign}{top}π{bottom}")
}
