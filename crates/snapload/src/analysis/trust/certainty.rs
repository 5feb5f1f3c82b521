//! How far a run can be trusted if its values are exact, and nothing more.

use crate::analysis::trust::Horizon;
use crate::analysis::trust::monitor::TrustMonitor;
use crate::case::Case;

/// What rounding leaves of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty {
    /// Where trust ends; none if nowhere.
    pub horizon: Option<Horizon>,
}

impl Certainty {
    /// Of a case; the run is followed as far as its horizon.
    pub fn of(case: &Case) -> Self {
        let mut simulation = case.simulation();
        let mut monitor = TrustMonitor::of_exact_case(case, &simulation);
        while monitor.horizon().is_none()
            && let Some(step) = simulation.step()
        {
            monitor.follow_spread(&simulation, &step);
        }
        Self {
            horizon: monitor.horizon(),
        }
    }

    /// Whether the way in which the run ends is certain.
    pub fn decides_the_end(&self) -> bool {
        self.horizon.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::progress::{Unfinished, unwatched};
    use crate::analysis::trust::{Uncertainty, trusted_run};
    use crate::case::named::named_case;

    #[test]
    fn certainty_is_that_of_the_trusted_run() -> Result<(), Unfinished> {
        for code in ["sliding-example", "rocking-example", "1910001000-359"] {
            let case = Case::new(named_case(code)?.parameters)?;
            let (_, trust) = trusted_run(&case, &Uncertainty::default(), &unwatched)?;
            assert_eq!(Certainty::of(&case).horizon, trust.horizon);
        }
        Ok(())
    }
}
