//! Orbits that are proved to exist.
//!
//! Everything else in this crate is computed in doubles. Here the existence of an orbit, for a case
//! whose values are decimals, is proved with numbers of many digits that have bounds on their
//! errors: see [`prove_orbit`].

use crate::orbit::{Orbit, Proof};
use serde::Serialize;
use snapload::TautSet;
use snapload::analysis::{Cancelled, Counter, OnProgress, in_parallel};
use snapload_certificate::{CandidateOrbit, ExactCase, ProvedOrbit, prove_orbit};

/// The number of orbits that are proved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Proofs {
    /// The number of orbits proved to exist.
    pub proved: usize,
    /// The number of those that are certainly different from each other.
    pub distinct: usize,
}

impl Orbit {
    /// Proves that there is an orbit with these snaps near this one, for the case of decimals to
    /// which it belongs.
    pub fn prove(&self, case: &ExactCase) -> Proof {
        let taut_sets = self.lap.sequence.taut_sets().into_iter();
        let taut = taut_sets.fold(TautSet::SLACK, TautSet::union);
        if let Some(cable) = taut.iter().next() {
            return Err(format!(
                "cable {} is taut on a part of the lap, but proofs of orbits cover slack flight only",
                cable + 1
            ));
        }
        if let Some(why) = self.why_not.first() {
            return Err(format!("the orbit is not admissible: {why}"));
        }
        let candidate = CandidateOrbit {
            phase: self.phase,
            periods: self.periods,
            state: self.z,
            struck: &self.lap.sequence.struck(),
        };
        prove_orbit(case, &candidate)
    }
}

/// Proves orbits of one case on all threads, and counts those that are certainly different ones.
///
/// # Errors
/// [`Cancelled`] if it is cancelled.
pub fn prove_all(
    orbits: &mut [Orbit],
    case: &ExactCase,
    on_progress: OnProgress,
) -> Result<Proofs, Cancelled> {
    let counter = Counter::new("proofs", 0, orbits.len() as u64, on_progress);
    let proofs = in_parallel(orbits.len(), |k| {
        let proof = orbits[k].prove(case);
        counter.add(1)?;
        Ok(proof)
    })?;
    let mut distinct: Vec<&ProvedOrbit> = Vec::new();
    let proved: Vec<&ProvedOrbit> = proofs
        .iter()
        .filter_map(|proof| proof.as_ref().ok())
        .collect();
    for orbit in &proved {
        if distinct.iter().all(|other| orbit.differs_from(other)) {
            distinct.push(orbit);
        }
    }
    let counted = Proofs {
        proved: proved.len(),
        distinct: distinct.len(),
    };
    for (orbit, proof) in orbits.iter_mut().zip(proofs) {
        orbit.proof = Some(proof);
    }
    Ok(counted)
}
