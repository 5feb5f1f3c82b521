//! From a case to a certificate: only proved statements are written.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::{fixed, significant};
use crate::case::ExactCase;
use crate::format::{
    CaseText, CertificateText, EndText, FORMAT, Line, MODEL, TAUT_FORMAT, TautSegment, UNDECIDED,
};
use crate::proof::prove;
use crate::proved::{Proved, Reason};
use crate::verdict::{FIRST_LIMBS, ProofFailure, with_more_bits};
use serde::{Serialize, Serializer};
use std::ops::ControlFlow;

/// Places after the point of times and of the state at the end.
pub(crate) const PLACES: i64 = 25;
/// Significant digits of normal velocities.
const DIGITS: i64 = 17;

/// The result of a proof.
#[derive(Clone, Debug)]
pub struct Certification {
    /// How many impacts were proved.
    pub impacts: usize,
    /// How many segments with a taut cable.
    pub taut_segments: usize,
    /// The time of the last proved event: the end, or the last impact.
    pub t: String,
    /// How the run ends, or what could not be decided.
    pub end: Ended,
    /// The bits of the numbers in the proof.
    pub bits: usize,
    written: CertificateText,
}

/// How far a proof came.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// To the end of the run, or to the first cable that stays taut.
    Proved(Reason),
    /// No further than this.
    Undecided {
        /// What could not be decided.
        what: String,
        /// After the impact or start at this time.
        t: f64,
    },
}

/// An impact as a certificate states it; each number is within half a unit of its last digit of the
/// true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedImpact<'a> {
    /// By index from 0.
    pub cable: usize,
    /// Its time, as a decimal.
    pub t: &'a str,
    /// Its normal velocity, as a decimal.
    pub v_n: &'a str,
}

impl Certification {
    /// The impacts that are proved, one after the other.
    pub fn proved_impacts(&self) -> impl Iterator<Item = PrintedImpact<'_>> {
        self.written.impacts.iter().filter_map(|line| match line {
            Line::Impact(cable, t, v_n) => Some(PrintedImpact {
                cable: usize::from(*cable) - 1,
                t,
                v_n,
            }),
            Line::TautSegment(_) => None,
        })
    }

    /// The certificate as compact JSON. If the end of the run is not proved, it states that as its
    /// reason.
    pub fn text(&self) -> String {
        // Writing strings, whole numbers and flags can not fail.
        serde_json::to_string(self).unwrap_or_default()
    }
}

impl Serialize for Certification {
    /// The certificate.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.written.serialize(serializer)
    }
}

/// The caller cancelled the proof.
#[derive(Clone, Copy, Debug)]
pub struct Cancelled;

/// The impacts and taut segments that are to be written.
type Lines = Vec<Line>;
/// The reason, time and state of an end as they are to be written.
type PrintedEnd = (Reason, String, [String; 6]);

/// Proves the run of a case; `on_progress` receives the time of each impact and of each step of
/// taut motion, and may end the work. Where a cable stays taut and no rule stops the run, the proof
/// ends as `sticks`, or continues if `taut`.
///
/// # Errors
/// In words, why a case has no motion; or [`Cancelled`].
pub fn certify(
    case: &ExactCase,
    taut: bool,
    on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Result<Certification, String>, Cancelled> {
    // The longest of all attempts.
    let (mut best, mut bits) = (Lines::new(), 0);
    let found = with_more_bits(FIRST_LIMBS, |limbs| {
        let mut impacts = Lines::new();
        let end = attempt(case, limbs, taut, &mut impacts, on_progress);
        if impacts.len() >= best.len() {
            (best, bits) = (impacts, 64 * limbs);
        }
        end
    });
    let last = best.last().map(|line| line.time().to_owned());
    let segments = best
        .iter()
        .filter(|line| matches!(line, Line::TautSegment(_)))
        .count();
    let (end, t, written) = match found {
        Ok(((reason, t, state), _)) => {
            let written = EndText {
                reason: reason.name().to_owned(),
                t: Some(t.clone()),
                state: Some(state),
            };
            (Ended::Proved(reason), t, written)
        }
        Err(ProofFailure::Undecided { what, t, .. }) => {
            let written = EndText {
                reason: UNDECIDED.to_owned(),
                t: None,
                state: None,
            };
            let t = t.unwrap_or(0.0);
            let last = last.unwrap_or_else(|| "0".to_owned());
            (Ended::Undecided { what, t }, last, written)
        }
        Err(ProofFailure::Refuted(what)) => return Ok(Err(what)),
        Err(ProofFailure::Cancelled | ProofFailure::StoppedEarly) => return Err(Cancelled),
    };
    Ok(Ok(Certification {
        impacts: best.len() - segments,
        taut_segments: segments,
        t,
        end,
        bits,
        written: CertificateText {
            format: if segments > 0 { TAUT_FORMAT } else { FORMAT }.to_owned(),
            model: MODEL.to_owned(),
            bits: bits as u64,
            case: CaseText::of(case),
            impacts: best,
            end: written,
        },
    }))
}

/// One proof with numbers of `limbs` limbs, of which everything is kept that can be printed.
fn attempt(
    case: &ExactCase,
    limbs: usize,
    taut: bool,
    impacts: &mut Lines,
    on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<PrintedEnd, ProofFailure> {
    let end = prove(case, limbs, taut, &mut |proved| {
        if on_progress(proved.time().to_f64()).is_break() {
            return ControlFlow::Break(ProofFailure::Cancelled);
        }
        if matches!(proved, Proved::Step(_)) {
            return ControlFlow::Continue(());
        }
        match written(&proved) {
            Some(line) => {
                impacts.push(line);
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(digits(&proved)),
        }
    })?;
    let printed = fixed(&end.t, PLACES).zip(printed(&end.state));
    let failure = || ProofFailure::undecided("the digits of the end").at(end.t.to_f64());
    let (t, state) = printed.ok_or_else(failure)?;
    Ok((end.reason, t, state))
}

fn written(proved: &Proved) -> Option<Line> {
    let t = fixed(proved.time(), PLACES)?;
    Some(match proved {
        Proved::Step(_) => return None,
        Proved::Impact(impact) => {
            let v_n = significant(&impact.v_n, DIGITS)?;
            Line::Impact(impact.cable as u8 + 1, t, v_n)
        }
        Proved::Segment(segment) => Line::TautSegment(TautSegment {
            mode: segment.mode(),
            from: fixed(&segment.from, PLACES)?,
            until: t,
            event: segment.event.clone(),
        }),
    })
}

fn digits(proved: &Proved) -> ProofFailure {
    ProofFailure::undecided("the digits of a time or speed").at(proved.time().to_f64())
}

fn printed(state: &[Ball; 6]) -> Option<[String; 6]> {
    let printed: Option<Vec<String>> = state.iter().map(|ball| fixed(ball, PLACES)).collect();
    printed?.try_into().ok()
}
