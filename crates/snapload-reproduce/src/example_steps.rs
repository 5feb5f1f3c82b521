//! The two examples that slide and rock, step by step from their proofs.

use crate::source::Number;
use snapload::CaseError;
use snapload_certificate::{ExactCase, certify};
use std::ops::ControlFlow;

/// A proved interval of motion with taut cables.
#[derive(Clone, Debug, PartialEq)]
struct TautInterval {
    /// The taut cables, by number: `1`, `2` or `1+2`.
    taut: String,
    from: String,
    until: String,
    /// The event that ends it, in the words of a certificate.
    event: String,
    /// The velocity of the snap that ends it, if one does.
    v_n: Option<f64>,
    /// The number of snaps and intervals before it, which is its index in the certificate.
    place: usize,
    /// The number of snaps among these.
    snaps: usize,
}

/// The end of the proofs of the examples. After it there is one interval of rocking.
const UNTIL: f64 = 12.0;
/// The examples.
const CASES: [&str; 2] = ["sliding-example", "rocking-example"];
/// The beginning of the event's name if a snap ends the interval.
const SNAP: &str = "impact";
/// Shorter intervals are described together.
const SHORT: f64 = 0.02;

/// The command that proves an example.
pub(crate) fn proof(case: &str) -> String {
    format!("snapload certify --taut --case {case} --set t_end={UNTIL} --json -")
}

/// The file of intervals, made again.
///
/// # Errors
/// A case that is not legal, or a proof that did not succeed, which would be errors of the program.
pub fn taut_intervals() -> Result<String, CaseError> {
    let proved = CASES.map(|code| proved(code, UNTIL));
    let lines: Vec<String> = proved.into_iter().collect::<Result<_, _>>()?;
    Ok(String::from("case,taut,from,until,event,v_n,place,snaps\n") + &lines.concat())
}

/// The intervals of an example up to a time, one in each line.
fn proved(code: &str, until: f64) -> Result<String, CaseError> {
    let mut parameters = snapload::named_case(code)?.parameters;
    parameters.t_end = until;
    let fault = || CaseError::value("case", code, "a case that can be proved");
    let case = ExactCase::of(&parameters, |_| None).map_err(|_| fault())?;
    let proof = certify(&case, true, &mut |_| ControlFlow::Continue(()));
    let proof = proof.ok().and_then(Result::ok).ok_or_else(fault)?;
    let written: serde_json::Value = serde_json::from_str(&proof.text()).unwrap_or_default();
    let (mut text, mut snaps) = (String::new(), 0);
    let lines = written["impacts"].as_array().map_or(&[][..], Vec::as_slice);
    for (place, line) in lines.iter().enumerate() {
        let word = |key: &str| line[key].as_str().unwrap_or_default();
        let Some(mode) = line["mode"].as_array() else {
            snaps += 1;
            continue;
        };
        let taut: Vec<String> = mode.iter().map(ToString::to_string).collect();
        let (taut, event) = (taut.join("+"), word("event"));
        let (from, until) = (word("from"), word("until"));
        // The snap that ends an interval is in the following line; its velocity is the third value.
        let snap = lines.get(place + 1).filter(|_| event.starts_with(SNAP));
        let v_n = snap.and_then(|snap| snap[2].as_str()).unwrap_or_default();
        text += &format!("{code},{taut},{from},{until},{event},{v_n},{place},{snaps}\n");
    }
    Ok(text)
}

/// The stored intervals of an example.
fn stored(code: &str) -> Vec<TautInterval> {
    let lines = include_str!("../data/stretches.csv").lines();
    lines
        .filter_map(|line| read(line.strip_prefix(code)?))
        .collect()
}

fn read(line: &str) -> Option<TautInterval> {
    let fields: Vec<&str> = line.split(',').collect();
    let [_, taut, from, until, event, v_n, place, snaps] = fields.try_into().ok()?;
    let [taut, from, until, event] = [taut, from, until, event].map(str::to_owned);
    Some(TautInterval {
        taut,
        from,
        until,
        event,
        v_n: v_n.parse().ok(),
        place: place.parse().ok()?,
        snaps: snaps.parse().ok()?,
    })
}

impl TautInterval {
    fn lasts(&self) -> f64 {
        let time = |text: &str| text.parse().unwrap_or(f64::NAN);
        time(&self.until) - time(&self.from)
    }

    /// A description of the interval and its end; `next` is the one after it.
    fn description(&self, next: Option<&Self>) -> String {
        let lasts = self.lasts();
        let what = match self.taut.as_str() {
            "1" => "slides with the right cable taut",
            "2" => "slides with the left cable taut",
            _ => return "rocks with both cables taut, from here on".to_owned(),
        };
        let how = match (self.event.as_str(), next) {
            (event, Some(next)) if event.starts_with(SNAP) && next.from == self.until => {
                ", until it hits the other boundary and stays on this one"
            }
            (event, _) if event.starts_with(SNAP) => {
                ", until it hits the other boundary and leaves this one"
            }
            _ => "",
        };
        format!("{what} for {lasts:.4}{how}")
    }
}

/// The proved slides of an example, up to its rocking: the duration of each, and the velocity of
/// the other cable's snap that ends it.
pub(crate) fn slides(code: &str) -> Vec<(f64, Option<f64>)> {
    let slides = stored(code)
        .into_iter()
        .filter(|interval| interval.taut.len() == 1);
    slides
        .map(|interval| (interval.lasts(), interval.v_n))
        .collect()
}

/// The steps of an example: when each begins, except the first, and what happens.
pub(crate) fn steps(code: &str) -> Vec<(Option<Number>, String)> {
    let (intervals, command) = (stored(code), proof(code));
    let begins = |k: usize| {
        let (interval, key) = (
            &intervals[k],
            format!(".impacts[{}].from", intervals[k].place),
        );
        Number::decimal(&interval.from, 4, &command, &format!("{key} | tonumber"))
    };
    let mut steps = vec![(
        None,
        slack_text(intervals.first().map_or(0, |first| first.snaps)),
    )];
    let mut k = 0;
    while k < intervals.len() {
        let short = |interval: &&TautInterval| interval.lasts() < SHORT;
        let together = intervals[k..].iter().take_while(short).count();
        let number = begins(k);
        let (what, next) = if together > 1 {
            let (first, next) = (&intervals[k], intervals.get(k + together));
            let snaps = next.map_or(0, |next| next.snaps - first.snaps);
            let what = format!(
                "slides {together} times with the left cable taut, none for longer than {SHORT}, with {snaps} \
                 snaps"
            );
            (what, k + together)
        } else {
            let next = intervals.get(k + 1);
            let snaps = next.map_or(0, |next| next.snaps - intervals[k].snaps);
            let then = match snaps {
                0 | 1 => String::new(),
                _ => format!("; then {}", slack_text(snaps)),
            };
            (intervals[k].description(next) + &then, k + 1)
        };
        steps.push((Some(number), what));
        k = next;
    }
    steps
}

fn slack_text(snaps: usize) -> String {
    format!("moves with both cables slack, with {snaps} snaps")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_taut_intervals_are_proved_again() -> Result<(), CaseError> {
        let again = proved(CASES[1], 8.15594)?;
        let (stored, again) = (stored(CASES[1]), again.lines().collect::<Vec<_>>());
        assert!(again.len() > 3);
        for (line, stored) in again[..again.len() - 1].iter().zip(stored) {
            assert_eq!(line.strip_prefix(CASES[1]).and_then(read), Some(stored));
        }
        Ok(())
    }

    #[test]
    fn both_examples_end_in_rocking() {
        for code in CASES {
            let intervals = stored(code);
            assert!(intervals.len() > 10);
            let last = intervals.last().expect("an interval");
            assert_eq!(
                (last.taut.as_str(), last.event.as_str()),
                ("1+2", "end_time")
            );
            let snaps = |interval: &TautInterval| interval.event.starts_with(SNAP);
            let velocities = intervals.iter().filter(|s| snaps(s) != s.v_n.is_some());
            assert_eq!(velocities.count(), 0);
            // In order, and none begins before the previous one ends.
            let in_order = |pair: &[TautInterval]| pair[0].until <= pair[1].from;
            assert!(intervals.windows(2).all(in_order));
        }
    }
}
