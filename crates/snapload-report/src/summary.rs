//! A run in a few lines of text.
use crate::digits::{count, digits};
use crate::run_with_trust::{snaps, snaps_before};
use crate::{Certified, RunWithTrust, outcome_in_words, trust_in_words};
use serde::Serialize;
use snapload::analysis::{NormErrors, Trust, digits_within};
use snapload::{Impact, Mode, ModeInterval, Norms, Parameters, SETTLING_HEIGHT, Stop, Trajectory};
use std::fmt::Write;
use std::path::PathBuf;

/// If there are more intervals than this, only their sums are given.
const FEW_MODES: usize = 6;

/// The summary of a run of a case with this caption, with its proof if there is one and the files
/// that were written.
pub fn summary(
    caption: &str,
    parameters: &Parameters,
    trusted: &RunWithTrust,
    certified: Option<&Certified>,
    written: &[PathBuf],
) -> String {
    let mut lines = summary_lines(caption, parameters, trusted, certified);
    for (i, path) in written.iter().enumerate() {
        let label = if i == 0 { "Written" } else { "" };
        lines.push((label, path.display().to_string()));
    }
    let lines = lines.iter();
    lines
        .map(|(label, text)| format!("{label:<9} {}\n", indented(text)))
        .collect()
}

/// At what time the impacts of a run accumulate, if that ends it.
pub fn accumulation_in_words(run: &Trajectory) -> Option<String> {
    let limit = run.end().t_limit?;
    Some(format!("the impacts accumulate at t = {}", digits(limit)))
}

/// The lines of a summary: a label, empty if the line continues the one above, and a text, which
/// may have several lines itself.
pub fn summary_lines(
    caption: &str,
    parameters: &Parameters,
    trusted: &RunWithTrust,
    certified: Option<&Certified>,
) -> Vec<(&'static str, String)> {
    let run = &trusted.run;
    let mut lines = vec![
        ("Case", caption.to_owned()),
        ("End", end_with_digits(trusted, parameters, certified)),
    ];
    lines.extend(accumulation_in_words(run).map(|words| ("", words)));
    lines.push(("Outcome", outcome_in_words(trusted)));
    lines.push(("Trust", trust_in_words(trusted)));
    lines.extend(certified.map(|certified| ("Proved", certified.in_words())));
    lines.push(("Impacts", impacts(trusted)));
    lines.extend(hardest(trusted));
    let norms = run.norms();
    let known = NormsKnown::of(norms, &NormErrors::of(run, &trusted.trust));
    let norm =
        |name: &str, value: f64, known: &str| format!("{name} = {} ({known})", digits(value));
    let rho1 = norm("rho1", norms.rho1, &known.rho1);
    let rho2 = norm("rho2", norms.rho2, &known.rho2);
    let rho3 = norm("rho3", norms.rho3, &known.rho3);
    lines.push(("Norms", format!("{rho1}, {rho2}, {rho3}")));
    let mut reached = norm("y_max", norms.y_max, &known.y_max);
    // A point mass has no rotation.
    if !parameters.is_point() {
        let turned = digits(norms.theta_max);
        let _ = write!(reached, ", theta_max = {turned} rad ({})", known.theta_max);
    }
    lines.push(("", reached));
    let doubt = doubt_at(trusted, run.end().t);
    lines.push(("Modes", modes(run.modes()) + doubt));
    if (2..=FEW_MODES).contains(&run.modes().len()) {
        let words = |mode: &ModeInterval| interval(mode) + doubt_at(trusted, mode.t_end);
        lines.extend(run.modes().iter().map(|mode| ("", words(mode))));
    }
    lines
}

/// A text of several lines, the later ones indented to align with the first.
pub fn indented(text: &str) -> String {
    text.replace('\n', "\n          ")
}

/// The number of known digits of each norm, in words.
#[derive(Serialize)]
pub struct NormsKnown {
    rho1: String,
    rho2: String,
    rho3: String,
    y_max: String,
    theta_max: String,
}

impl NormsKnown {
    /// The known digits of norms with these errors.
    pub fn of(norms: &Norms, errors: &NormErrors) -> Self {
        Self {
            rho1: known(norms.rho1, errors.rho1),
            rho2: known(norms.rho2, errors.rho2),
            rho3: known(norms.rho3, errors.rho3),
            y_max: known(norms.y_max, errors.y_max),
            theta_max: known(norms.theta_max, errors.theta_max),
        }
    }
}

/// The text for a number that is not known at all.
const NOT_CERTAIN: &str = "not certain";

/// The remark on results of the motion up to some time, if that is past the horizon.
fn doubt_at(trusted: &RunWithTrust, t: f64) -> &'static str {
    match trusted.horizon() {
        Some(horizon) if t >= horizon => " (not certain)",
        _ => "",
    }
}

/// The number of known decimal digits of a value, of its fraction if it is below 1; empty if there
/// is no error from which to compute it.
fn known(value: f64, error: Option<f64>) -> String {
    let Some(error) = error.filter(|error| error.is_finite()) else {
        return NOT_CERTAIN.to_owned();
    };
    in_digits(digits_within(error / value.abs().max(1.0)))
}

fn in_digits(digits: f64) -> String {
    let digits = digits.floor();
    let plural = if digits == 1.0 { "" } else { "s" };
    format!("{digits} digit{plural}")
}

/// How a run ended, and the accuracy of its time: by its proof if there is one.
fn end_with_digits(
    trusted: &RunWithTrust,
    parameters: &Parameters,
    certified: Option<&Certified>,
) -> String {
    let proved = certified.and_then(|certified| certified.confirmed_end(&trusted.run));
    let known = match proved {
        Some(digits) => format!("{} by the proof", in_digits(digits)),
        None => end_known(&trusted.run, &trusted.trust),
    };
    end_with_known(&trusted.run, parameters, &known)
}

/// The number of known digits of the time at which a run ended.
pub(crate) fn end_known(run: &Trajectory, trust: &Trust) -> String {
    let error = Some(trust.end_error).filter(|error| error.is_finite());
    known(run.end().t, error)
}

/// How a run ended, with what is known of its time. An end that was requested is exact.
pub(crate) fn end_with_known(run: &Trajectory, parameters: &Parameters, known: &str) -> String {
    let (end, words) = (run.end(), end_in_words(run, parameters));
    if end.reason == Stop::EndTime {
        return words;
    }
    let at = format!("t = {}", digits(end.t));
    words.replacen(&at, &format!("{at} ({known})"), 1)
}

/// The limits of the thesis's case in its own numbers, which is more specific than their general
/// names.
const LIMITS_HERE: [(Stop, &str); 2] = [
    (Stop::RotationLimit, "|theta| reached pi/2"),
    (
        Stop::UpperBound,
        "the body reached the level of the anchors",
    ),
];

/// How a run ended, and when.
pub fn end_in_words(trajectory: &Trajectory, parameters: &Parameters) -> String {
    let end = trajectory.end();
    let t = digits(end.t);
    match end.reason {
        Stop::Settled => format!("settled at t = {t}: taut below y = {SETTLING_HEIGHT}"),
        Stop::SlidingStart => {
            format!(
                "sliding starts at t = {t}: a cable stays taut at or above y = {SETTLING_HEIGHT}"
            )
        }
        Stop::EndTime => format!("end of the requested time, t = {t}"),
        Stop::ImpactLimit => {
            format!(
                "impact limit at t = {t}: more than {} impacts",
                parameters.max_impacts
            )
        }
        limit => {
            let here = LIMITS_HERE.iter().find(|(stop, _)| *stop == limit);
            let what = here.map_or(limit.reason_text(), |(_, what)| what);
            format!("{} at t = {t}: {what}", limit.label())
        }
    }
}

/// The number of impacts, and the number of certain ones if not all are: snaps of each cable.
/// Beside them the impulses passed into a taut cable, with v_n = 0, which do not count as impacts.
fn impacts(trusted: &RunWithTrust) -> String {
    let impacts = trusted.run.impacts();
    if impacts.is_empty() {
        return "none".to_owned();
    }
    let of_cable = |cable: usize| {
        let mine = |impact: &&Impact| impact.cable == cable && impact.v_n > 0.0;
        impacts.iter().filter(mine).count()
    };
    let count = snaps(impacts);
    let mut text = format!("{count}");
    if let Some(horizon) = trusted.trust.horizon {
        let known = snaps_before(horizon, impacts);
        let _ = write!(text, " ({known} certain)");
    }
    let cables = (0..snapload::MAX_CABLES).map(|cable| (of_cable(cable), cable + 1));
    let parts: Vec<String> = cables
        .filter(|(count, _)| *count > 0)
        .map(|(count, cable)| format!("{count} of cable {cable}"))
        .collect();
    if !parts.is_empty() {
        let _ = write!(text, ": {}", parts.join(", "));
    }
    let passed = impacts.len() - count;
    if passed > 0 {
        let s = if passed == 1 { "" } else { "s" };
        let _ = write!(text, "; {passed} impulse{s} passed into a taut cable");
    }
    text
}

/// The snap of the largest velocity, and the impact of the largest impulse if that is another.
fn hardest(trusted: &RunWithTrust) -> Vec<(&'static str, String)> {
    let (impacts, errors) = (trusted.run.impacts(), &trusted.trust.errors);
    let rows = || impacts.iter().zip(errors).zip(1..);
    let snaps = rows().filter(|((impact, _), _)| impact.v_n > 0.0);
    let Some(fastest) = snaps.max_by(|((p, _), _), ((q, _), _)| p.v_n.total_cmp(&q.v_n)) else {
        return Vec::new();
    };
    // Its known digits; past the horizon none are known.
    let in_words = |((impact, error), number): ((&Impact, &f64), usize)| {
        let horizon = trusted.trust.horizon;
        let certain = horizon.is_none_or(|horizon| horizon.is_after(number));
        format!(
            "v_n = {}, impulse {}, at t = {} in cable {} ({})",
            digits(impact.v_n),
            digits(impact.impulse),
            digits(impact.t),
            impact.cable + 1,
            known(1.0, Some(*error).filter(|_| certain))
        )
    };
    let ((snap, _), _) = fastest;
    let harder = rows().filter(|((impact, _), _)| impact.impulse > snap.impulse);
    let largest = harder.max_by(|((p, _), _), ((q, _), _)| p.impulse.total_cmp(&q.impulse));
    let mut lines = vec![("Hardest", in_words(fastest))];
    lines.extend(largest.map(|row| ("", format!("largest impulse: {}", in_words(row)))));
    lines
}

/// The total duration of each mode.
fn modes(intervals: &[ModeInterval]) -> String {
    let sums = Mode::ALL.map(|mode| {
        let of_mode = intervals.iter().filter(|i| i.taut.mode() == mode);
        let (number, time) =
            of_mode.fold((0, 0.0), |(n, sum), i| (n + 1, sum + i.t_end - i.t_start));
        (number > 0).then(|| {
            format!(
                "{} {} in {}",
                mode.name(),
                digits(time),
                count(number, "interval")
            )
        })
    });
    let sums: Vec<String> = sums.into_iter().flatten().collect();
    match sums.is_empty() {
        true => "none: the run ended where it started".to_owned(),
        false => sums.join(", "),
    }
}

fn interval(interval: &ModeInterval) -> String {
    let taut: Vec<String> = interval.taut.iter().map(|c| (c + 1).to_string()).collect();
    let on = if taut.is_empty() { "" } else { " on " };
    format!(
        "  {} to {}: {}{on}{}",
        digits(interval.t_start),
        digits(interval.t_end),
        interval.taut.mode().name(),
        taut.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::analysis::{Uncertainty, Unfinished, no_progress};
    use snapload::{Case, Outcome};

    /// A body that is hit by a fast snap far from its centre, and by a slower one near it.
    #[test]
    fn the_largest_impulse_is_printed_where_another_snap_is_the_fastest() -> Result<(), Unfinished>
    {
        let words = |parameters| {
            let case = Case::new(parameters)?;
            let trusted = RunWithTrust::run_alone(&case, Uncertainty::default(), &no_progress)?;
            let impulses = trusted.run.impacts().iter().map(|impact| impact.impulse);
            let largest = format!("impulse {}, ", digits(impulses.fold(0.0, f64::max)));
            Ok::<_, Unfinished>((hardest(&trusted), largest))
        };
        let (lines, largest) = words(Parameters {
            r: 2.2,
            a: 0.25,
            b: 0.15,
            x: 0.05,
            vx: 0.2,
            t_end: 30.0,
            ..Parameters::STANDARD
        })?;
        assert_eq!(lines.len(), 2);
        assert!(!lines[0].1.contains(&largest) && lines[1].1.contains(&largest));
        let (lines, largest) = words(Parameters::STANDARD)?;
        assert!(lines.len() == 1 && lines[0].1.contains(&largest));
        Ok(())
    }

    /// The summary counts the impacts as an outcome and a sweep do, and impulses passed into a taut
    /// cable beside them.
    #[test]
    fn impacts_are_counted_without_impulses_passed_into_a_taut_cable() -> Result<(), Unfinished> {
        let case = Case::new(Parameters {
            f_o: 0.27,
            t_end: 9.0,
            stop_when_settled: false,
            ..Parameters::STANDARD
        })?;
        let trusted = RunWithTrust::run_alone(&case, Uncertainty::default(), &no_progress)?;
        let outcome = Outcome::of(&case);
        let (rows, all) = (trusted.run.impacts().len(), outcome.snaps() as usize);
        let passed = rows - all;
        assert!(passed > 1);
        let of_cables = format!(
            "{} of cable 1, {} of cable 2; {passed} impulses passed into a taut cable",
            outcome.impacts[0], outcome.impacts[1]
        );
        let words = impacts(&trusted);
        assert!(words.starts_with(&format!("{all} (")), "{words}");
        assert!(words.ends_with(&of_cables), "{words}");
        let trust = trust_in_words(&trusted);
        assert!(trust.contains(&format!(" of {all},")), "{trust}");
        Ok(())
    }
}
