//! Certificates: a run of hundreds of impacts as a theorem, with its proof and its check.
//!
//! A certificate states of one case of decimals that its motion has exactly the impacts that are
//! listed, of these cables, at these times, and ends as it says, every number to half a unit of the
//! last digit that is printed. [`certify`] proves it before anything is written; [`check`] proves
//! it again from the case alone and compares. The statement contains no floating-point number, time
//! step or tolerance; the proofs use enclosures of many digits throughout.
//!
//! ```
//! use snapload_certificate::{Ended, ExactCase, Verdict, certify, check};
//! use snapload::Parameters;
//! use std::ops::ControlFlow;
//!
//! let case = Parameters { e: 0.5, ..Parameters::STANDARD };
//! let case = ExactCase::of(&case, |_| None).expect("a legal case");
//! let proof = certify(&case, false, &mut |_| ControlFlow::Continue(())).expect("not cancelled");
//! let proof = proof.expect("a legal start");
//! assert!(matches!(proof.end, Ended::Proved(_)));
//! assert!(matches!(check(&proof.text()), Verdict::Proved { .. }));
//! ```

mod arithmetic;
mod case;
mod checker;
mod format;
mod model;
mod orbit;
mod proof;
mod proved;
mod run;
mod slack;
mod taut;
mod verdict;
mod writer;

pub use arithmetic::decimal::Decimal;
pub use case::{ExactCase, NUMBERS};
pub use checker::{Verdict, check, check_with};
pub use orbit::{CandidateOrbit, ProvedOrbit, prove_orbit};
pub use proved::Reason;
pub use writer::{Cancelled, Certification, Ended, PrintedImpact, certify};
