//! What a run comes to, as one row of a study: more than [`Outcome`](super::Outcome), and still no run kept.

use super::{Doubt, Witness};
use crate::{Case, End, Norms, Simulation, Step};

/// The cables of a case.
const CABLES: usize = 2;

/// A run in a few numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account {
    /// How it ended.
    pub end: End,
    /// The norms.
    pub norms: Norms,
    /// How many impacts each cable had, impulses passed into it while taut not among them.
    pub impacts: [u64; CABLES],
    /// The first of them.
    pub first: Option<FirstImpact>,
    /// Time without a taut cable.
    pub slack: f64,
    /// Time with one taut cable.
    pub sliding: f64,
    /// Time with both.
    pub rocking: f64,
    /// How far the run can be trusted, if that was asked for.
    pub certainty: Option<Certainty>,
}

/// The first snap of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstImpact {
    /// When \[T\].
    pub t: f64,
    /// The cable, by index from 0.
    pub cable: usize,
    /// Normal velocity just before \[L/T\].
    pub v_n: f64,
}

/// How far a run can be trusted, of values that are exact: what rounding leaves of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty {
    /// Where trust ends, as time and number of the impact; none if nowhere.
    pub horizon: Option<(f64, u64)>,
    /// Whether the way in which the run ends is certain.
    pub certain: bool,
}

impl Account {
    /// Runs a case to its end. With `trust` its rounding errors are followed, too, which takes about as long
    /// again.
    pub fn of(case: &Case, trust: bool) -> Self {
        let mut simulation = case.simulation();
        let mut witness =
            trust.then(|| Witness::new(&simulation, &[0.0; 6], Doubt::default().tolerance));
        let mut account = Self::begin(&simulation);
        while let Some(step) = simulation.step() {
            account.take(&step);
            if let Some(witness) = &mut witness {
                witness.follow(&simulation, &step);
            }
        }
        account.end = End::of(&simulation);
        account.norms.y_max = simulation.y_max();
        account.norms.theta_max = simulation.theta_max();
        account.certainty = witness.map(|witness| {
            let trust = witness.verdict();
            Certainty {
                horizon: trust.horizon.map(|at| (at.t, at.impact as u64)),
                certain: trust.decides_the_end(),
            }
        });
        account
    }

    fn begin(simulation: &Simulation) -> Self {
        Self {
            end: End::of(simulation),
            norms: Norms::default(),
            impacts: [0; CABLES],
            first: None,
            slack: 0.0,
            sliding: 0.0,
            rocking: 0.0,
            certainty: None,
        }
    }

    fn take(&mut self, step: &Step) {
        let time = match step.taut.len() {
            0 => &mut self.slack,
            1 => &mut self.sliding,
            _ => &mut self.rocking,
        };
        *time += step.t_end - step.t_start;
        for impact in step.impacts() {
            self.norms.take(&impact);
            if impact.v_n > 0.0 {
                if let Some(count) = self.impacts.get_mut(impact.cable) {
                    *count += 1;
                }
                self.first.get_or_insert(FirstImpact {
                    t: impact.t,
                    cable: impact.cable,
                    v_n: impact.v_n,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{Outcome, trusted_run};
    use crate::{CaseError, named_case};

    /// Every number is that of the kept run.
    #[test]
    fn an_account_tells_of_the_run() -> Result<(), CaseError> {
        for code in ["sliding-example", "rocking-example", "1910001000-359"] {
            let case = Case::new(named_case(code)?.parameters)?;
            let account = Account::of(&case, true);
            let (run, trust) = trusted_run(&case, &Doubt::default())?;
            let outcome = Outcome::of(&case);
            assert_eq!((account.end, account.norms), (outcome.end, outcome.norms));
            assert_eq!(account.impacts.iter().sum::<u64>(), outcome.impacts);
            let first = run.impacts().iter().find(|impact| impact.v_n > 0.0);
            assert_eq!(account.first.map(|f| f.t), first.map(|f| f.t));
            for (mode, time) in [
                ("slack", account.slack),
                ("sliding", account.sliding),
                ("rocking", account.rocking),
            ] {
                let of_mode = run.modes().iter().filter(|i| i.taut.mode() == mode);
                let sum: f64 = of_mode.map(|i| i.t_end - i.t_start).sum();
                assert!((sum - time).abs() < 1e-9, "{code}: {mode} {sum} {time}");
            }
            let certainty = account.certainty.map(|c| (c.horizon, c.certain));
            let horizon = trust.horizon.map(|h| (h.t, h.impact as u64));
            assert_eq!(certainty, Some((horizon, trust.decides_the_end())));
            let plain = Account::of(&case, false);
            assert_eq!(
                plain,
                Account {
                    certainty: None,
                    ..account
                }
            );
        }
        Ok(())
    }
}
