//! From a certificate to a verdict. Only the case is taken from the certificate: the proof is made
//! anew from the start, finds every impact by itself, and is then compared with the claims. The
//! certificate's bit count is only the precision with which the checker begins.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::fixed;
use crate::case::ExactCase;
use crate::format::{
    CertificateText, FORMAT, Line, MODEL, TAUT_FORMAT, UNDECIDED, cut, decimal, placed, quoted,
    velocity,
};
use crate::proof::prove;
use crate::proved::{Proved, ProvedEnd, ProvedImpact, Reason};
use crate::verdict::{ProofFailure, with_more_bits};
use crate::writer::PLACES;
use std::ops::ControlFlow;

/// The bit counts that a certificate may state.
const BITS: std::ops::RangeInclusive<u64> = 64..=3000;

/// The longest message about text that is no certificate, in characters.
const LONGEST_ERROR: usize = 300;

/// A callback that receives a time and the last one.
type OnProgress<'a> = &'a mut dyn FnMut(f64, f64) -> ControlFlow<()>;

/// The verdict of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Every obligation is proved and every number is right.
    Proved {
        /// How many impacts.
        impacts: usize,
        /// How the run ends.
        reason: Reason,
        /// The time of the end, as the certificate states it.
        t: String,
        /// The bits with which the proof succeeded.
        bits: usize,
    },
    /// All impacts are proved, of a certificate that states that the run's end is undecided.
    ProvedInPart {
        /// How many impacts.
        impacts: usize,
        /// The bits with which the proof succeeded.
        bits: usize,
    },
    /// A number or an event is wrong.
    Refused(String),
    /// Some quantity's sign stayed undecided up to the largest number of bits.
    Undecided(String),
    /// Not a certificate: its shape, its keys or its decimals are wrong, or the case is not legal.
    Malformed(String),
}

impl Verdict {
    /// The exit status of a program that reports the verdict: 0 proved, 1 refused, 2 undecided (or
    /// proved in part), 3 not a certificate.
    pub fn status(&self) -> u8 {
        match self {
            Self::Proved { .. } => 0,
            Self::Refused(_) => 1,
            Self::ProvedInPart { .. } | Self::Undecided(_) => 2,
            Self::Malformed(_) => 3,
        }
    }
}

/// Checks a certificate.
pub fn check(text: &str) -> Verdict {
    check_with(text, &mut |_, _| ControlFlow::Continue(()))
}

/// The same; `on_progress` receives the time that the proof has reached and `t_end`, and may end
/// the work, after which the verdict is undecided.
pub fn check_with(text: &str, on_progress: OnProgress<'_>) -> Verdict {
    let certificate = match CertificateText::read(text) {
        Ok(certificate) => certificate,
        Err(error) => {
            // It may repeat a key, however long.
            let error = cut(&error.to_string(), LONGEST_ERROR);
            return Verdict::Malformed(format!("it can not be read as a certificate: {error}"));
        }
    };
    match shape(&certificate) {
        Ok(case) => compare(&certificate, &case, on_progress),
        Err(what) => Verdict::Malformed(what),
    }
}

/// Whether it is a certificate of this format, with a legal case and decimals where they belong.
fn shape(certificate: &CertificateText) -> Result<ExactCase, String> {
    let is_known = [FORMAT, TAUT_FORMAT].contains(&certificate.format.as_str());
    if !is_known || certificate.model != MODEL {
        return Err(format!(
            "format {} of model {} is not known",
            quoted(&certificate.format),
            quoted(&certificate.model)
        ));
    }
    if !BITS.contains(&certificate.bits) {
        return Err(format!("bits = {} is not allowed", certificate.bits));
    }
    for line in &certificate.impacts {
        match line {
            Line::Impact(cable, t, v_n) if (1..=2).contains(cable) => {
                placed("the time", t)?;
                velocity("v_n", v_n)?;
            }
            Line::TautSegment(segment) if certificate.format == TAUT_FORMAT => {
                placed("the time", &segment.from)?;
                placed("the time", &segment.until)?;
            }
            _ => return Err("a line that is neither an impact nor a stretch".to_owned()),
        }
    }
    let end = &certificate.end;
    match (&end.t, &end.state) {
        (Some(t), Some(state)) if Reason::named(&end.reason).is_some() => {
            placed("the time", t)?;
            state.iter().try_for_each(|s| placed("the state", s))?;
        }
        (None, None) if end.reason == UNDECIDED => {}
        _ => {
            return Err(format!(
                "an end with the reason {} is not allowed, or it has t and state where it must not, or lacks them",
                quoted(&end.reason)
            ));
        }
    }
    certificate.case.exact()
}

fn compare(
    certificate: &CertificateText,
    case: &ExactCase,
    on_progress: OnProgress<'_>,
) -> Verdict {
    let t_end = case.number("t_end").ball(2).to_f64();
    let claims = &certificate.impacts;
    let is_partial = certificate.end.reason == UNDECIDED;
    let first = certificate.bits.div_ceil(64) as usize;
    let result = with_more_bits(first, |limbs| {
        if is_partial && claims.is_empty() {
            return Ok(());
        }
        let mut seen = 0;
        let taut = certificate.format == TAUT_FORMAT;
        let proved = prove(case, limbs, taut, &mut |proved| {
            if on_progress(proved.time().to_f64(), t_end).is_break() {
                return ControlFlow::Break(ProofFailure::Cancelled);
            }
            if matches!(proved, Proved::Step(_)) {
                return ControlFlow::Continue(());
            }
            seen += 1;
            let enough = is_partial && seen == claims.len();
            match (agrees(&proved, seen, claims.get(seen - 1)), enough) {
                (Err(failure), _) => ControlFlow::Break(failure),
                (Ok(()), true) => ControlFlow::Break(ProofFailure::StoppedEarly),
                (Ok(()), false) => ControlFlow::Continue(()),
            }
        });
        match proved {
            Err(ProofFailure::StoppedEarly) => Ok(()),
            Err(failure) => Err(failure),
            Ok(_) if seen != claims.len() => Err(ProofFailure::Refuted(format!(
                "the run has {seen} impacts and stretches, but {} are claimed",
                claims.len()
            ))),
            Ok(end) => end_agrees(&end, certificate),
        }
    });
    verdict(certificate, result.map(|((), limbs)| limbs))
}

/// What follows from a proof that agrees with the certificate, at this many limbs, or from its
/// failure.
fn verdict(certificate: &CertificateText, result: Result<usize, ProofFailure>) -> Verdict {
    let claims = certificate.impacts.iter();
    let impacts = claims
        .filter(|line| matches!(line, Line::Impact(..)))
        .count();
    match (result, Reason::named(&certificate.end.reason)) {
        (Ok(limbs), Some(reason)) => Verdict::Proved {
            impacts,
            reason,
            t: certificate.end.t.clone().unwrap_or_default(),
            bits: 64 * limbs,
        },
        (Ok(limbs), None) => Verdict::ProvedInPart {
            impacts,
            bits: 64 * limbs,
        },
        (Err(ProofFailure::Refuted(what)), _) => Verdict::Refused(what),
        (Err(ProofFailure::Undecided { what, t, .. }), _) => {
            let at = t.map_or_else(String::new, |t| format!(", after t = {t}"));
            Verdict::Undecided(format!("{what}{at}"))
        }
        (Err(ProofFailure::StoppedEarly | ProofFailure::Cancelled), _) => {
            Verdict::Undecided("the proof was given up".to_owned())
        }
    }
}

/// Compares the next proved event with the next claimed one.
fn agrees(proved: &Proved, nth: usize, claim: Option<&Line>) -> Result<(), ProofFailure> {
    match (proved, claim) {
        (Proved::Impact(impact), Some(Line::Impact(cable, t, v_n))) => {
            impact_agrees(impact, nth, (*cable, t, v_n))
        }
        (Proved::Segment(ours), Some(Line::TautSegment(theirs))) => {
            if theirs.mode != ours.mode() || theirs.event != ours.event {
                return Err(ProofFailure::Refuted(format!(
                    "entry {nth} is a stretch of cables {:?} that ends with {}, but another is claimed",
                    ours.mode(),
                    ours.event
                )));
            }
            equals(
                &format!("the beginning of the stretch in entry {nth}"),
                &ours.from,
                &theirs.from,
            )?;
            equals(
                &format!("the end of the stretch in entry {nth}"),
                &ours.until,
                &theirs.until,
            )
        }
        _ => Err(ProofFailure::Refuted(format!(
            "entry {nth} of the run is not the claimed one, or none is claimed"
        ))),
    }
}

fn impact_agrees(
    impact: &ProvedImpact,
    nth: usize,
    (cable, t, v_n): (u8, &str, &str),
) -> Result<(), ProofFailure> {
    if impact.cable + 1 != usize::from(cable) {
        return Err(ProofFailure::Refuted(format!(
            "the impact in entry {nth} is of cable {}, but cable {cable} is claimed",
            impact.cable + 1
        )));
    }
    equals(
        &format!("the time of the impact in entry {nth}"),
        &impact.t,
        t,
    )?;
    equals(
        &format!("v_n of the impact in entry {nth}"),
        &impact.v_n,
        v_n,
    )
}

fn end_agrees(end: &ProvedEnd, certificate: &CertificateText) -> Result<(), ProofFailure> {
    let claim = &certificate.end;
    if end.reason.name() != claim.reason {
        return Err(ProofFailure::Refuted(format!(
            "the run ends with {}, but {} is claimed",
            end.reason.name(),
            claim.reason
        )));
    }
    let (Some(t), Some(state)) = (&claim.t, &claim.state) else {
        return Err(ProofFailure::Refuted(
            "the end has no time and no state".to_owned(),
        ));
    };
    equals("the time of the end", &end.t, t)?;
    for (k, (ball, text)) in end.state.iter().zip(state).enumerate() {
        equals(
            &format!("component {} of the state at the end", k + 1),
            ball,
            text,
        )?;
    }
    Ok(())
}

/// Whether the printed number is the true one, rounded to nearest: |true − printed| ≤ half a unit
/// of the last place that is printed.
fn equals(what: &str, ball: &Ball, text: &str) -> Result<(), ProofFailure> {
    let printed = decimal(what, text).map_err(ProofFailure::Refuted)?;
    let limbs = ball.mid().limbs.len().max(2);
    let off = (ball - &printed.ball(limbs)).abs();
    let half = printed.half_unit().ball(limbs);
    let room = half - off;
    if room.is_positive() {
        Ok(())
    } else if room.is_negative() {
        // With the decimals of certificates, as a double may not tell the two apart.
        let proved = fixed(ball, PLACES).unwrap_or_else(|| ball.to_f64().to_string());
        let message = format!("{what} is {proved}, but {text} is claimed");
        Err(ProofFailure::Refuted(message))
    } else {
        Err(ProofFailure::undecided(format!("the last digit of {what}")))
    }
}
