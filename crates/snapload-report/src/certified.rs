//! A run with its proof: what is proved, and where the run of doubles differs from it.
use crate::digits::{count, digits};
use serde::Serialize;
use snapload::analysis::{OnProgress, Progress, digits_within};
use snapload::{Impact, Trajectory};
use snapload_certificate::{
    Cancelled, Certification, Ended, ExactCase, PrintedImpact, Reason, certify,
};

/// A proof, and a run of doubles compared with it.
pub struct Certified {
    /// The proof.
    pub proof: Certification,
    /// For each impact of the run, the number of digits of its time that the proof confirms; none
    /// if no such impact is proved, from the first one of another cable on, and for impulses that
    /// pass into a taut cable.
    pub confirmed: Vec<Option<f64>>,
    /// Where the run differs from the proof, if it does.
    pub departure: Option<Departure>,
}

/// The first impact of a run that differs from the proved one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Departure {
    /// Its row in the table of impacts, from 1; one more than there are if only the end differs, or
    /// if impacts are missing.
    pub impact: usize,
    /// The difference.
    pub differs: Differs,
}

/// How a run differs from its proof.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Differs {
    /// The cable of an impact.
    Cable,
    /// Its time, in the five digits of a summary.
    Time,
    /// Its normal velocity, in five digits.
    Speed,
    /// The run has fewer impacts than are proved.
    Missing,
    /// The run has more impacts than the motion.
    Extra,
    /// The reason of the end, or its time in five digits.
    End,
}

impl Differs {
    fn label(self) -> &'static str {
        match self {
            Self::Cable => "is in the other cable",
            Self::Time => "differs in the first five digits of its time",
            Self::Speed => "differs in the first five digits of v_n",
            Self::Missing => "is missing",
            Self::Extra => "does not exist",
            Self::End => "does not occur, as the run ends otherwise",
        }
    }
}

/// `"certificate"` in the JSON of a run.
#[derive(Serialize)]
pub struct CertificateRow<'a> {
    proved: bool,
    impacts: usize,
    t: &'a str,
    reason: Option<&'static str>,
    undecided: Option<&'a str>,
    bits: usize,
    departure: Option<Departure>,
}

/// Proves the run of a case to its end, also through motion with taut cables.
///
/// # Errors
/// In words, why a case has no motion; or [`Cancelled`].
pub fn prove(
    case: &ExactCase,
    t_end: f64,
    on_progress: OnProgress,
) -> Result<Result<Certification, String>, Cancelled> {
    certify(case, true, &mut |t| {
        on_progress(Progress::new("proving", t, t_end))
    })
}

impl Certified {
    /// Compares a run with its proof.
    pub fn new(proof: Certification, run: &Trajectory) -> Self {
        let mut proved = proof.proved_impacts();
        let (mut departure, mut cables_differ) = (None, false);
        let mut confirmed = Vec::new();
        for (number, impact) in (1..).zip(run.impacts()) {
            // An impulse that passes into a taut cable is not an impact.
            if impact.v_n <= 0.0 {
                confirmed.push(None);
                continue;
            }
            let exact = proved.next();
            cables_differ |= exact.is_some_and(|exact| exact.cable != impact.cable);
            let close = exact.filter(|_| !cables_differ);
            confirmed.push(close.map(|exact| confirmed_digits(impact.t, nearest(exact.t))));
            let differs = match exact {
                Some(exact) => difference(impact, &exact),
                None => ended(&proof).map(|_| Differs::Extra),
            };
            let of = |differs| Departure {
                impact: number,
                differs,
            };
            departure = departure.or(differs.map(of));
        }
        let rest = match proved.next() {
            Some(_) => Some(Differs::Missing),
            None => ended(&proof)
                .is_some_and(|reason| ends_otherwise(run, reason, &proof.t))
                .then_some(Differs::End),
        };
        departure = departure.or(rest.map(|differs| Departure {
            impact: run.impacts().len() + 1,
            differs,
        }));
        drop(proved);
        Self {
            proof,
            confirmed,
            departure,
        }
    }

    /// The row for JSON.
    pub fn row(&self) -> CertificateRow<'_> {
        let (reason, undecided) = match &self.proof.end {
            Ended::Proved(reason) => (Some(reason.name()), None),
            Ended::Undecided { what, .. } => (None, Some(what.as_str())),
        };
        CertificateRow {
            proved: undecided.is_none(),
            impacts: self.proof.impacts,
            t: &self.proof.t,
            reason,
            undecided,
            bits: self.proof.bits,
            departure: self.departure,
        }
    }

    /// The number of digits of the end's time that the proof confirms, if the proved end is of the
    /// same kind.
    pub(crate) fn confirmed_end(&self, run: &Trajectory) -> Option<f64> {
        let end = run.end();
        let reason = ended(&self.proof)?;
        let exact = nearest(&self.proof.t);
        (reason == Reason::Stop(end.reason)).then(|| confirmed_digits(end.t, exact))
    }

    /// What is proved, and on a line of its own where the run differs.
    pub fn in_words(&self) -> String {
        let proved = proved_in_words(&self.proof);
        match self.comparison() {
            Some(comparison) => format!("{proved}\n{comparison}"),
            None => proved,
        }
    }

    /// Where the run differs from the proof; none if there is nothing to compare.
    pub fn comparison(&self) -> Option<String> {
        let to_the_end = ended(&self.proof).is_some();
        Some(match self.departure {
            None if to_the_end => "the run agrees in five digits".to_owned(),
            None if self.proof.impacts == 0 => return None,
            None => "the run agrees up to there in five digits".to_owned(),
            Some(Departure {
                differs: Differs::End,
                ..
            }) => format!(
                "the run has the same {}, but a different end",
                count(self.proof.impacts, "impact")
            ),
            Some(Departure { impact, differs }) => format!(
                "the run departs from the proof at impact {impact}, which {}",
                differs.label()
            ),
        })
    }
}

/// How much is proved and how the run ends, or why the proof stopped.
pub fn proved_in_words(proof: &Certification) -> String {
    let (count, t, bits) = (count(proof.impacts, "impact"), &proof.t, proof.bits);
    match &proof.end {
        Ended::Proved(reason) => {
            let reason = reason.name().replace('_', " ");
            format!("{count}, {reason} at t = {t} ({bits} bits)")
        }
        Ended::Undecided { what, .. } => {
            format!("{count}, up to t = {t} ({bits} bits)\nthen undecided: {what}")
        }
    }
}

fn ended(proof: &Certification) -> Option<Reason> {
    match proof.end {
        Ended::Proved(reason) => Some(reason),
        Ended::Undecided { .. } => None,
    }
}

/// The double next to a decimal of a certificate.
pub fn nearest(decimal: &str) -> f64 {
    decimal.parse().unwrap_or(f64::NAN)
}

fn confirmed_digits(t: f64, exact: f64) -> f64 {
    digits_within((t - exact).abs() / exact.abs().max(1.0))
}

/// Numbers that differ by no more agree, whatever their digits: those of a run are of order 1, and
/// known to so much, where it is best known.
const ROUNDINGS: f64 = 1e-12;

/// Whether two numbers agree in the five digits that are printed, or up to rounding.
fn agree(number: f64, decimal: &str) -> bool {
    let exact = nearest(decimal);
    digits(number) == digits(exact) || (number - exact).abs() <= ROUNDINGS
}

fn difference(impact: &Impact, exact: &PrintedImpact) -> Option<Differs> {
    if impact.cable != exact.cable {
        Some(Differs::Cable)
    } else if !agree(impact.t, exact.t) {
        Some(Differs::Time)
    } else if !agree(impact.v_n, exact.v_n) {
        Some(Differs::Speed)
    } else {
        None
    }
}

fn ends_otherwise(run: &Trajectory, reason: Reason, t: &str) -> bool {
    let end = run.end();
    reason != Reason::Stop(end.reason) || !agree(end.t, t)
}
