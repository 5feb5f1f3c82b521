//! What is proved of the rows of Table 6.1.

use snapload::{Parameters, Stop};
use snapload_certificate::{Cancelled, Ended, ExactCase, Reason, certify};
use std::ops::ControlFlow;

/// How a run ends, as a theorem.
#[derive(Clone, Debug)]
pub(crate) struct Proved {
    pub(crate) reason: Stop,
    /// When, as a decimal whose digits are all right.
    pub(crate) t: String,
    pub(crate) impacts: usize,
}

impl Proved {
    /// Of a case; none where a cable stays taut before a stop rule ends the run, from where on it is
    /// not known here.
    pub(crate) fn of(parameters: &Parameters) -> Option<Self> {
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
}
