//! Proofs of runs, and runs compared with their proofs.

use crate::errors::error_of_work;
use crate::interrupt::interruptible;
use crate::run::{Run, to_json};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use snapload::analysis::Cancelled;
use snapload_certificate::{ExactCase, PrintedImpact};
use snapload_report::{CertificateRow, Certified, nearest, prove};

/// What is proved, for Python.
#[derive(Serialize)]
struct Answer<'a> {
    certificate: CertificateRow<'a>,
    digits: &'a [Option<f64>],
    cable: Vec<usize>,
    t: Vec<f64>,
    v_n: Vec<f64>,
    t_exact: Vec<&'a str>,
    v_n_exact: Vec<&'a str>,
    words: String,
    text: String,
}

impl<'a> Answer<'a> {
    fn new(certified: &'a Certified) -> Self {
        let impacts: Vec<PrintedImpact> = certified.proof.proved_impacts().collect();
        Self {
            certificate: certified.row(),
            digits: &certified.confirmed,
            cable: impacts.iter().map(|impact| impact.cable + 1).collect(),
            t: impacts.iter().map(|impact| nearest(impact.t)).collect(),
            v_n: impacts.iter().map(|impact| nearest(impact.v_n)).collect(),
            t_exact: impacts.iter().map(|impact| impact.t).collect(),
            v_n_exact: impacts.iter().map(|impact| impact.v_n).collect(),
            words: certified.in_words(),
            text: certified.proof.text() + "\n",
        }
    }
}

/// Proves a run; the answer is JSON.
#[pyfunction]
pub(crate) fn certify(
    py: Python<'_>,
    run: &Run,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let parameters = *run.case()?.parameters();
    let case = ExactCase::of(&parameters, |_| None).map_err(PyValueError::new_err)?;
    let proof = interruptible(py, progress, move |shared| {
        prove(&case, parameters.t_end, &|progress| shared.report(progress))
    })?;
    let proof = proof.map_err(|_| error_of_work(Cancelled { done: 0.0 }.into()))?;
    let proof = proof.map_err(PyValueError::new_err)?;
    to_json(&Answer::new(&Certified::new(proof, run.trajectory())))
}
