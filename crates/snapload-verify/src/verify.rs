//! Verification by more digits: the same motion again in multi-precision.

use crate::digits_left::{Neighbour, difference, numbers, relative};
use snapload::analysis::{OnProgress, Progress, Trust, Uncertainty, Unfinished, trusted_run};
use snapload::{Case, CaseError, Impact, Precise, Real, Simulation, Stop, Trajectory, Value};

/// The most digits that [`verify`] can compute with.
pub const MOST_DIGITS: u32 = Precise::<16>::DIGITS;

/// An ordinary run together with the same run in many digits.
#[derive(Clone, Debug)]
pub struct Verification {
    /// Decimal digits with which the second run was computed.
    pub digits: u32,
    /// The digits of these that are still right at its end, as a neighbour shows that differs in
    /// the last digits of its coefficients.
    pub digits_left: f64,
    /// The ordinary run.
    pub run: Trajectory,
    /// The trust that was computed for it.
    pub trust: Trust,
    /// Difference of the two runs at each impact that both have: the largest of the time and the
    /// states' components, each relative to its value where that is above 1.
    pub differences: Vec<f64>,
    /// The first impact, numbered from 1, that differs by more than the tolerance, or that only one
    /// of them has. The end counts as the impact after the last.
    pub first_wrong: Option<usize>,
    /// How the run with many digits ends; none if a cable stuck first, as the verification covers
    /// slack flight, impacts and the stop rules.
    pub end: Option<Stop>,
    /// When it ends.
    pub t: f64,
    /// Its impacts.
    pub impacts: Vec<ExactImpact>,
}

/// An impact of the run with many digits: numbers with as many decimals as remain after the growth
/// of its own errors, and two fewer, as that is an estimate.
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
    if digits <= Precise::<4>::DIGITS {
        with_words::<4>(case, tolerance, on_progress)
    } else if digits <= Precise::<8>::DIGITS {
        with_words::<8>(case, tolerance, on_progress)
    } else if digits <= MOST_DIGITS {
        with_words::<16>(case, tolerance, on_progress)
    } else {
        let allowed = format!("1 <= digits <= {MOST_DIGITS}");
        Err(CaseError::value("digits", Value::Integer(digits.into()), allowed).into())
    }
}

fn with_words<const WORDS: usize>(
    case: &Case,
    tolerance: f64,
    on_progress: OnProgress,
) -> Result<Verification, Unfinished> {
    let uncertainty = Uncertainty {
        tolerance,
        ..Uncertainty::default()
    };
    let (run, trust) = trusted_run(case, &uncertainty, on_progress)?;
    let simulation = case.simulation_over(|_, number| Precise::<WORDS>::from_decimal(number));
    let mut simulation = simulation.map_err(|_| {
        let allowed =
            "a start that is legal with more digits, too; this one is exactly at the limit";
        CaseError::value("x, y, theta", "(the start)", allowed)
    })?;
    let mut differences = Vec::new();
    let mut first_wrong = None;
    let mut impacts = Vec::new();
    let mut neighbour = Neighbour::<WORDS>::new(case, &trust);
    let t_end = case.parameters().t_end;
    while let Some(step) = simulation.step() {
        let stuck = simulation.stop().is_none() && !step.taut_after.is_empty();
        for exact in step.impacts() {
            match run.impacts().get(impacts.len()) {
                Some(ours) if ours.cable == exact.cable => {
                    let ours = numbers(ours).map(Precise::from_f64);
                    differences.push(difference(ours, numbers(&exact)));
                }
                _ => {
                    first_wrong.get_or_insert(impacts.len() + 1);
                }
            }
            // Two digits are kept in reserve for the roundings on the way.
            let decimals = (neighbour.compare(&exact) - 2.0).max(0.0) as usize;
            impacts.push(ExactImpact::new(&exact, decimals));
        }
        let t = simulation.time().to_f64();
        Progress::new("computing with many digits", t, t_end).report(on_progress)?;
        if stuck {
            break;
        }
    }
    let wrong = differences.iter().position(|d| *d > tolerance);
    first_wrong = [first_wrong, wrong.map(|k| k + 1)]
        .into_iter()
        .flatten()
        .min();
    if ends_otherwise(&run, &simulation, impacts.len(), tolerance) {
        first_wrong = first_wrong.or(Some(impacts.len() + 1));
    }
    Ok(Verification {
        digits: Precise::<WORDS>::DIGITS,
        digits_left: neighbour.left(),
        run,
        trust,
        differences,
        first_wrong,
        end: simulation.stop(),
        t: simulation.time().to_f64(),
        impacts,
    })
}

/// Whether a run ends in another way, later or sooner than the one with many digits, which has
/// `impacts` impacts; unknown if that has not ended.
fn ends_otherwise<T: Real>(
    run: &Trajectory,
    exact: &Simulation<T>,
    impacts: usize,
    tolerance: f64,
) -> bool {
    let ours = run.end();
    exact.stop().is_some_and(|stop| {
        let alike = stop == ours.reason && relative(T::from_f64(ours.t), exact.time()) <= tolerance;
        run.impacts().len() != impacts || !alike
    })
}

impl ExactImpact {
    fn new<const WORDS: usize>(impact: &Impact<Precise<WORDS>>, decimals: usize) -> Self {
        Self {
            t: impact.t.to_decimals(decimals),
            cable: impact.cable,
            v_n: impact.v_n.to_decimals(decimals),
            impulse: impact.impulse.to_decimals(decimals),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snapload::Parameters;
    use snapload::analysis::no_progress;
    use std::ops::ControlFlow::{Break, Continue};
    use std::sync::Mutex;

    /// With twice the digits each decimal is the same, up to a rounding of the last one; also where the
    /// comparison ends in taut motion, which goes on in the ordinary run.
    #[test]
    fn printed_decimals_are_right() -> Result<(), Unfinished> {
        let rocking = snapload::named_case("rocking-example").map_err(Unfinished::from)?;
        decimals_are_right(&Case::new(Parameters::STANDARD)?)?;
        decimals_are_right(&Case::new(rocking.parameters)?)
    }

    fn decimals_are_right(case: &Case) -> Result<(), Unfinished> {
        let few = verify(case, 60, 1e-3, &no_progress)?;
        let many = verify(case, 150, 1e-3, &no_progress)?;
        assert_eq!(few.impacts.len(), many.impacts.len());
        // What is reported to be left is what is printed, with two digits in reserve.
        let last = few.impacts.last().map_or(0, |impact| {
            impact.t.split_once('.').map_or(0, |(_, d)| d.len())
        });
        assert!(
            (few.digits_left - 2.0 - last as f64).abs() < 2.0,
            "{} {last}",
            few.digits_left
        );
        let units = |text: &str, decimals: usize| {
            let (whole, fraction) = text.split_once('.').expect("decimals");
            format!("{whole}{}", &fraction[..decimals])
        };
        for (few, many) in few.impacts.iter().zip(&many.impacts) {
            assert_eq!(few.cable, many.cable);
            let pairs = [
                (&few.t, &many.t),
                (&few.v_n, &many.v_n),
                (&few.impulse, &many.impulse),
            ];
            for (few, many) in pairs {
                let decimals = few
                    .split_once('.')
                    .map_or(0, |(_, fraction)| fraction.len());
                assert!(decimals >= 30 && many.len() > few.len(), "{few} {many}");
                // The last 30 places of both, which fit into the integers.
                let last = |text: &str| -> i128 {
                    let units = units(text, decimals);
                    units[units.len() - 30..].parse().expect("digits")
                };
                assert!((last(few) - last(many)).abs() <= 1, "{few} {many}");
            }
        }
        Ok(())
    }

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
