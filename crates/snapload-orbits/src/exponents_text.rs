//! Lyapunov exponents in words.

use crate::section::Section;

/// An exponent with its standard error, which is rounded up so that the accuracy is not overstated.
pub(crate) fn exponent_text([mean, error]: [f64; 2]) -> String {
    let known = (error * 1e4).ceil().max(1.0) / 1e4;
    match (mean.is_finite(), error.is_finite()) {
        // Adding 0 makes 0 of -0.
        (true, true) => format!("{:.4} +- {known:.4}", (mean * 1e4).round() / 1e4 + 0.0),
        (true, false) if error.is_nan() => {
            format!("{mean:.4} (too few periods for an error estimate)")
        }
        (true, false) => format!("{mean:.4} (not known: it depends on v_stick)"),
        (false, _) => "-inf".to_owned(),
    }
}

/// The exponents of a section in a line.
pub(crate) fn exponents_text(section: &Section) -> String {
    let exponents = &section.exponents;
    let left = exponents.iter().filter(|[mean, _]| mean.is_finite());
    let mut all: Vec<String> = left.map(|both| exponent_text(*both)).collect();
    let closed = exponents.len() - all.len();
    if closed > 0 {
        // Each taut cable closes two directions, for good; what a snap closes is not counted.
        let times = section.contacts.get(closed.div_ceil(2) - 1).copied();
        let times = match times.unwrap_or(0) {
            0 => String::new(),
            1 => ", once".to_owned(),
            n => format!(", {n} times"),
        };
        all.push(format!(
            "{closed} of -inf (directions closed by contact{times})"
        ));
    }
    all.join(", ")
}

#[cfg(test)]
mod tests {
    use super::exponent_text;

    #[test]
    fn no_exponent_is_reported_as_known_better_than_it_is() {
        let text = exponent_text;
        assert_eq!(text([-0.5, 1e-14]), "-0.5000 +- 0.0001");
        assert_eq!(text([-1e-9, 2.1e-4]), "0.0000 +- 0.0003");
        assert_eq!(
            text([0.5, f64::INFINITY]),
            "0.5000 (not known: it depends on v_stick)"
        );
        assert!(text([0.5, f64::NAN]).contains("too few periods"));
    }
}
