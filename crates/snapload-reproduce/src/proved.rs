//! Proved ends of runs: computed once and stored with the program, each row with the command that
//! proves it again.
//!
//! `cargo run --release -p snapload-reproduce --example prove` writes the files in `data` again.

use crate::reading::{Reading, published};
use snapload::analysis::{ForceScan, in_parallel};
use snapload::{CaseError, Parameters, Stop, natural_inertia};
use snapload_certificate::{Cancelled, Ended, ExactCase, Reason, certify};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::LazyLock;

/// How a run ends, as a theorem about the decimals of its case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Proved {
    pub(crate) reason: Stop,
    /// The time of the end, as a decimal whose digits are all right.
    pub(crate) t: String,
    pub(crate) impacts: usize,
}

/// The keys in which the cases of the tables differ; all else is as in the standard case.
const KEYS: [&str; 6] = ["r", "e", "a", "b", "f_o", "omega"];

static STORED: LazyLock<HashMap<&str, Proved>> = LazyLock::new(|| {
    let lines = include_str!("../data/proved.csv").lines().skip(1);
    lines.filter_map(read).collect()
});

/// A line: the case, and its proved end.
fn read(line: &str) -> Option<(&str, Proved)> {
    let (rest, impacts) = line.rsplit_once(',')?;
    let (rest, t) = rest.rsplit_once(',')?;
    let (case, end) = rest.rsplit_once(',')?;
    let reason = Stop::ALL.into_iter().find(|stop| stop.name() == end)?;
    let proved = Proved {
        reason,
        t: t.to_owned(),
        impacts: impacts.parse().ok()?,
    };
    Some((case, proved))
}

/// The values of a case, which are the beginning of its line.
fn case(parameters: &Parameters) -> String {
    let number = |key: &str| parameters.get(key).and_then(|value| value.number());
    let numbers = KEYS.map(|key| number(key).unwrap_or(f64::NAN).to_string());
    format!("{},{}", numbers.join(","), parameters.stop_when_sliding)
}

/// Whether a case has the standard value of every key that its line does not contain.
fn line_contains_all_differences(parameters: &Parameters) -> bool {
    let Parameters {
        r,
        e,
        a,
        b,
        f_o,
        omega,
        stop_when_sliding,
        ..
    } = *parameters;
    let from_line = Parameters {
        r,
        e,
        a,
        b,
        f_o,
        omega,
        stop_when_sliding,
        inertia: natural_inertia(a, b),
        ..Parameters::STANDARD
    };
    from_line == *parameters
}

impl Proved {
    /// The stored end of a case; none if a cable stays taut before a stop rule ends the run, and
    /// none for a case that differs from the standard one in a key that lines do not contain.
    pub(crate) fn stored(parameters: &Parameters) -> Option<&'static Self> {
        let known = STORED.get(case(parameters).as_str());
        known.filter(|_| line_contains_all_differences(parameters))
    }

    /// The proof, made again.
    pub(crate) fn compute(parameters: &Parameters) -> Option<Self> {
        let case = ExactCase::of(parameters, |_| None).ok()?;
        let proof = match certify(&case, false, &mut |_| ControlFlow::Continue(())) {
            Ok(proof) => proof.ok()?,
            Err(Cancelled) => return None,
        };
        match proof.end {
            Ended::Proved(Reason::Stop(reason)) => Some(Self {
                reason,
                t: proof.t,
                impacts: proof.impacts,
            }),
            _ => None,
        }
    }

    /// The time of the end, as the double next to it.
    pub(crate) fn time(&self) -> f64 {
        self.t.parse().unwrap_or(f64::NAN)
    }
}

/// The scan for the critical force of a body continues until an amplitude exceeds before this time.
pub(crate) const EARLY: f64 = 18.0;

/// The amplitudes of a row of Table 6.2 whose proofs are stored, in the chapter's reading: up to
/// the published one, and to the first that exceeds early.
pub(crate) fn amplitudes(
    parameters: &Parameters,
    proved: impl Fn(&Parameters) -> Option<Proved>,
    published: f64,
) -> Vec<(f64, Option<Proved>)> {
    let mut found = Vec::new();
    let mut early = false;
    for f_o in ForceScan::default().amplitudes() {
        if early && f_o > published {
            break;
        }
        let proof = proved(&Reading::Chapter.apply(Parameters { f_o, ..*parameters }));
        let exceeds = |proof: &Proved| proof.reason.exceeds() && proof.time() <= EARLY;
        early |= proof.as_ref().is_some_and(exceeds);
        found.push((f_o, proof));
    }
    found
}

/// The standard case under another force amplitude, in the chapter's reading.
fn under(f_o: f64) -> Parameters {
    Reading::Chapter.apply(Parameters {
        f_o,
        ..Parameters::STANDARD
    })
}

/// The proved ends of the standard case, in the chapter's reading, under each amplitude up to 1.
pub(crate) fn over_force() -> impl Iterator<Item = (f64, Option<&'static Proved>)> {
    let forces = ForceScan::default().amplitudes();
    forces.map(|f_o| (f_o, Proved::stored(&under(f_o))))
}

/// The standard case with another restitution, in the chapter's reading.
pub(crate) fn with_restitution(e: f64) -> Parameters {
    Reading::Chapter.apply(Parameters {
        e,
        ..Parameters::STANDARD
    })
}

/// The restitutions for which the text says when the body settles, and whether it exceeds: 0.95,
/// 0.9 … 0.5, and 1, 0.99 … 0.9.
pub(crate) fn restitutions() -> [Vec<f64>; 2] {
    let hundredths = |k: i32| f64::from(k) / 100.0;
    [
        (10..=19).rev().map(|k| hundredths(5 * k)).collect(),
        (90..=100).rev().map(hundredths).collect(),
    ]
}

/// Further cases whose ends occur in claims, in the chapter's reading.
fn further() -> Vec<Parameters> {
    let forces = ForceScan::default().amplitudes().map(under);
    let restitutions = restitutions().concat().into_iter().map(with_restitution);
    forces.chain(restitutions).collect()
}

/// The file of proofs, made again: the cases of Table 6.1 in both readings, the amplitudes of Table
/// 6.2, and further cases that occur in claims. This takes minutes.
///
/// # Errors
/// A case that is not legal, which would be an error of the program.
pub fn proofs() -> Result<String, CaseError> {
    let line = |parameters: &Parameters, proved: &Proved| {
        let Proved { reason, t, impacts } = proved;
        format!("{},{},{t},{impacts}\n", case(parameters), reason.name())
    };
    let named: Vec<Parameters> = snapload::named_cases()
        .map(|case| case.parameters)
        .collect();
    let of_table_6_1 = in_parallel(named.len(), |k| {
        let both = Reading::BOTH.map(|reading| reading.apply(named[k]));
        let lines = both.iter().filter(|case| case.stop_when_settled);
        let lines = lines.filter_map(|case| Some(line(case, &Proved::compute(case)?)));
        Ok::<String, CaseError>(lines.collect())
    })?;
    let rows = published();
    let of_table_6_2 = in_parallel(rows.len(), |k| {
        let (parameters, published) = rows[k];
        let found = amplitudes(&parameters, Proved::compute, published);
        let lines = found.iter().filter_map(|(f_o, proved)| {
            let case = Parameters {
                f_o: *f_o,
                ..parameters
            };
            Some(line(&Reading::Chapter.apply(case), proved.as_ref()?))
        });
        Ok::<String, CaseError>(lines.collect())
    })?;
    let further = further();
    let of_claims = in_parallel(further.len(), |k| {
        let proved = Proved::compute(&further[k]);
        Ok::<String, CaseError>(proved.map_or_else(String::new, |p| line(&further[k], &p)))
    })?;
    let mut lines: Vec<String> = of_table_6_1.concat().lines().map(str::to_owned).collect();
    for line in (of_table_6_2.concat() + &of_claims.concat()).lines() {
        if !lines.iter().any(|known| known == line) {
            lines.push(line.to_owned());
        }
    }
    let header = format!("{},stop_when_sliding,end,t,impacts\n", KEYS.join(","));
    Ok(header + &lines.join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload_verify::RoundedRun;

    /// Some of the stored proofs give the same results again; and so does the run of 76 digits.
    #[test]
    fn stored_proofs_are_proved_again() -> Result<(), CaseError> {
        let rows = published();
        let of = |row: usize, f_o: f64| {
            let (parameters, _) = rows[row];
            Reading::Chapter.apply(Parameters { f_o, ..parameters })
        };
        let standard = Reading::Chapter.apply(Parameters::STANDARD);
        // The counterexample to the rotation limit, and an entry that depends on the reading.
        let e = with_restitution(0.65);
        for case in [
            standard,
            of(7, 0.6),
            of(14, 0.24),
            of(0, 0.31),
            of(0, 0.9),
            e,
        ] {
            let stored = Proved::stored(&case);
            assert_eq!(Proved::compute(&case).as_ref(), stored, "{case:?}");
            let (stored, run) = (stored.expect("a proof"), RoundedRun::of_76_digits(&case)?);
            assert_eq!(
                (run.end().reason, run.snaps()),
                (stored.reason, stored.impacts)
            );
            assert!((run.end().t - stored.time()).abs() < 1e-12);
        }
        Ok(())
    }

    #[test]
    fn every_line_is_read_and_every_case_stands_once() {
        let lines = include_str!("../data/proved.csv").lines().count() - 1;
        assert!(
            lines > 500 && STORED.len() == lines,
            "{lines} {}",
            STORED.len()
        );
        // A changed case has no proof, an unknown end no line.
        let altered = Parameters {
            f_o: 0.123,
            ..Parameters::STANDARD
        };
        assert_eq!(Proved::stored(&altered), None);
        // Nor does a case that is changed in a key that lines do not contain.
        let standard = Parameters::STANDARD;
        assert!(Proved::stored(&standard).is_some());
        let inertia = Some(0.02);
        for other in [
            Parameters {
                nu: 0.4,
                ..standard
            },
            Parameters {
                v_stick: 1e-8,
                ..standard
            },
            Parameters {
                inertia,
                ..standard
            },
        ] {
            assert_eq!(Proved::stored(&other), None, "{other:?}");
        }
        assert_eq!(read("1.5,0.9,0.1,0,0.3,0.9,true,drifted,7.2,290"), None);
    }
}
