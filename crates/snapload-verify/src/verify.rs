//! Verification by more digits: the same motion again in multi-precision.

use crate::decimals::Decimals;
use crate::digits_left::{Neighbour, difference, numbers, relative, sticks, written};
use snapload::analysis::{OnProgress, Progress, Trust, Uncertainty, Unfinished, trusted_run};
use snapload::{
    CASE, Case, CaseError, Entries, Impact, Precise, Real, Simulation, Stop, Trajectory, Value,
};

/// The most digits that [`verify`] can compute with.
pub const MOST_DIGITS: u32 = Precise::<16>::DIGITS;

/// An ordinary run together with the same run in many digits.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Decimal digits with which the second run was computed.
    pub digits: u32,
    /// The digits of these that are still right at its end, as a neighbour shows that differs in
    /// the last digits of the case; zero if they are lost before.
    pub digits_left: f64,
    /// The ordinary run.
    pub run: Trajectory,
    /// The trust that was computed for it.
    pub trust: Trust,
    /// Difference of the two runs at each impact up to the first that is of another cable in the
    /// ordinary run, or missing: the largest of the time and the states' components, each relative
    /// to its value where that is above 1.
    pub differences: Vec<f64>,
    /// The first impact, numbered from 1, that differs by more than the tolerance, or that only one
    /// of them has, among those that many digits know. The end counts as the impact after the last.
    pub first_wrong: Option<usize>,
    /// How the run with many digits ends; none if a cable stuck first, as the verification covers
    /// slack flight, impacts and the stop rules, and none if its digits are lost before.
    pub end: Option<Stop>,
    /// When it ends \[T\], with decimals as in an impact; none if its digits are lost before.
    pub t: Option<String>,
    /// Its impacts, up to its end or to the last one that it knows.
    pub impacts: Vec<ExactImpact>,
}

/// An impact of the run with many digits: numbers with as many decimals as remain after the growth
/// of its own errors, and two fewer, as that is an estimate; at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactImpact {
    /// Time \[T\].
    pub t: String,
    /// The cable, by index from 0.
    pub cable: usize,
    /// Normal velocity just before \[L/T\].
    pub v_n: String,
    /// Impulse in the cable \[m L/T\].
    pub impulse: String,
}

/// Runs a case with at least `digits` decimal digits, together with the ordinary run.
///
/// The numbers of the case are taken as decimals: 0.1 is a tenth in the run with many digits, while
/// the ordinary one uses the double next to it.
///
/// # Errors
/// A [`CaseError`] if more digits are asked for than [`MOST_DIGITS`], or if the start, at the very
/// edge of what is legal, is illegal with more digits; and [`Unfinished::Cancelled`].
pub fn verify(
    case: &Case,
    digits: u32,
    tolerance: f64,
    on_progress: OnProgress,
) -> Result<Verification, Unfinished> {
    verify_as_written(case, &Entries::new(&CASE), digits, tolerance, on_progress)
}

/// The same for a case whose keys were given as text: `entries` keep the digits in which its
/// numbers were written, and all of these count.
///
/// # Errors
/// As for [`verify`]; also a [`CaseError`] for a number of more than 399 characters or with a power
/// of ten beyond 400.
pub fn verify_as_written(
    case: &Case,
    entries: &Entries,
    digits: u32,
    tolerance: f64,
    on_progress: OnProgress,
) -> Result<Verification, Unfinished> {
    if digits <= Precise::<4>::DIGITS {
        with_words::<4>(case, entries, tolerance, on_progress)
    } else if digits <= Precise::<8>::DIGITS {
        with_words::<8>(case, entries, tolerance, on_progress)
    } else if digits <= MOST_DIGITS {
        with_words::<16>(case, entries, tolerance, on_progress)
    } else {
        let allowed = format!("1 <= digits <= {MOST_DIGITS}");
        Err(CaseError::value("digits", Value::Integer(digits.into()), allowed).into())
    }
}

fn with_words<const WORDS: usize>(
    case: &Case,
    entries: &Entries,
    tolerance: f64,
    on_progress: OnProgress,
) -> Result<Verification, Unfinished> {
    let decimals = Decimals::new::<WORDS>(case, entries)?;
    let uncertainty = Uncertainty {
        tolerance,
        ..Uncertainty::default()
    };
    let (run, trust) = trusted_run(case, &uncertainty, on_progress)?;
    let simulation = decimals.simulation::<WORDS>(|_| Precise::ONE);
    let mut simulation = simulation.map_err(|_| {
        let allowed =
            "a start that is legal with more digits, too; this one is exactly at the limit";
        CaseError::value("x, y, theta", "(the start)", allowed)
    })?;
    let mut compared = Compared::<WORDS> {
        run: &run,
        neighbour: Neighbour::new(decimals, &trust),
        differences: Vec::new(),
        parted: None,
        impacts: Vec::new(),
    };
    let mut known = true;
    let t_end = case.parameters().t_end;
    while known && let Some(step) = simulation.step() {
        known = step.impacts().all(|exact| compared.impact(&exact));
        let t = simulation.time().to_f64();
        Progress::new("computing with many digits", t, t_end).report(on_progress)?;
        if sticks(&step) {
            break;
        }
    }
    let left = known.then(|| compared.neighbour.compare_end(&simulation));
    let t = left.and_then(|left| written(simulation.time(), left));
    let end = simulation.stop().filter(|_| t.is_some());
    let first_wrong = compared.first_wrong(&simulation, end, tolerance);
    let (differences, impacts) = (compared.differences, compared.impacts);
    Ok(Verification {
        digits: Precise::<WORDS>::DIGITS,
        digits_left: left.filter(|_| t.is_some()).unwrap_or(0.0),
        run,
        trust,
        differences,
        first_wrong,
        end,
        t,
        impacts,
    })
}

/// The impacts of the run with many digits so far, compared with those of an ordinary one.
struct Compared<'a, const WORDS: usize> {
    run: &'a Trajectory,
    neighbour: Neighbour<'a, WORDS>,
    differences: Vec<f64>,
    /// The first impact, from 1, that is of another cable in the ordinary run, or missing. Impacts
    /// of the same number are not the same ones after it.
    parted: Option<usize>,
    impacts: Vec<ExactImpact>,
}

impl<const WORDS: usize> Compared<'_, WORDS> {
    /// Takes the next impact; false if its digits are lost.
    fn impact(&mut self, exact: &Impact<Precise<WORDS>>) -> bool {
        let left = self.neighbour.compare(exact);
        let numbers_known = [
            written(exact.t, left.motion),
            written(exact.v_n, left.v_n),
            written(exact.impulse, left.impulse),
        ];
        let [Some(t), Some(v_n), Some(impulse)] = numbers_known else {
            return false;
        };
        // A cable whose speed can not be told from zero may as well not snap.
        let snaps = v_n.contains(|digit| ('1'..='9').contains(&digit));
        if !snaps && exact.v_n > Precise::ZERO {
            return false;
        }
        if self.parted.is_none() {
            match self.run.impacts().get(self.impacts.len()) {
                Some(ours) if ours.cable == exact.cable => {
                    let ours = numbers(ours).map(Precise::from_f64);
                    self.differences.push(difference(ours, numbers(exact)));
                }
                _ => self.parted = Some(self.impacts.len() + 1),
            }
        }
        self.impacts.push(ExactImpact {
            t,
            cable: exact.cable,
            v_n,
            impulse,
        });
        true
    }

    /// The first impact, from 1, at which the ordinary run is wrong; `end` is how the exact one
    /// ends, if that is known.
    fn first_wrong(
        &self,
        exact: &Simulation<Precise<WORDS>>,
        end: Option<Stop>,
        tolerance: f64,
    ) -> Option<usize> {
        let wrong = self.differences.iter().position(|d| *d > tolerance);
        let impact = [self.parted, wrong.map(|k| k + 1)]
            .into_iter()
            .flatten()
            .min();
        let ours = self.run.end();
        let ends_otherwise = end.is_some_and(|stop| {
            let late = relative(Precise::from_f64(ours.t), exact.time()) > tolerance;
            self.run.impacts().len() != self.impacts.len() || stop != ours.reason || late
        });
        impact.or(ends_otherwise.then_some(self.impacts.len() + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::Parameters;
    use std::ops::ControlFlow::{Break, Continue};
    use std::sync::Mutex;

    /// It reports its progress, which only increases, and ends when it is cancelled.
    #[test]
    fn a_proof_reports_progress_and_can_be_cancelled() -> Result<(), Unfinished> {
        let case = Case::new(Parameters::STANDARD)?;
        let reports = Mutex::new(Vec::new());
        verify(&case, 60, 1e-3, &|progress| {
            assert!((0.0..=progress.of).contains(&progress.done));
            let mut reports = reports.lock().expect("no panic");
            reports.push((progress.doing.to_owned(), progress.done));
            Continue(())
        })?;
        let reports = reports.into_inner().expect("no panic");
        assert!(!reports.is_empty());
        assert!(
            reports
                .windows(2)
                .all(|pair| pair[0].0 != pair[1].0 || pair[0].1 <= pair[1].1)
        );
        let cancelled = verify(&case, 60, 1e-3, &|_| Break(()));
        assert!(matches!(cancelled, Err(Unfinished::Cancelled(_))));
        Ok(())
    }
}
