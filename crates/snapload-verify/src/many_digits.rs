//! Runs of many digits, rounded to doubles afterwards, and runs of doubles in the same form.

use snapload::{
    Case, CaseError, End, Impact, Norms, Parameters, Precise, Real, Rules, Simulation, State,
    Steps, Stop, System,
};

/// The number types with the digits for runs in which errors grow little, and for others.
type Digits76 = Precise<4>;
type Digits153 = Precise<8>;

/// A run for tables: of doubles, or of many digits rounded to doubles.
#[derive(Clone, Debug)]
pub struct RoundedRun {
    system: System,
    /// The beginning of each segment, from which the motion within it is computed.
    segments: Vec<(f64, State)>,
    impacts: Vec<Impact>,
    end: End,
    norms: Norms,
}

impl RoundedRun {
    /// In doubles.
    pub fn of_doubles(parameters: &Parameters) -> Result<Self, CaseError> {
        let case = Case::new(*parameters)?;
        let system = case.simulation().system().clone();
        Ok(Self::of(system, case.into_simulation()))
    }

    /// In 76 digits, for the decimals of the case.
    pub fn of_76_digits(parameters: &Parameters) -> Result<Self, CaseError> {
        Self::of_digits(parameters, Digits76::from_decimal)
    }

    /// In 153 digits.
    pub fn of_153_digits(parameters: &Parameters) -> Result<Self, CaseError> {
        Self::of_digits(parameters, Digits153::from_decimal)
    }

    fn of_digits<T: Steps>(
        parameters: &Parameters,
        number: impl Fn(f64) -> T,
    ) -> Result<Self, CaseError> {
        let case = Case::new(*parameters)?;
        let system = case.simulation().system().clone();
        let simulation = case.simulation_over(|_, value| number(value));
        let simulation = simulation.map_err(|_| {
            let value = snapload::Value::Number(parameters.y);
            CaseError::value("y", value, "a start that is legal with more digits, too")
        })?;
        Ok(Self::of(system, simulation))
    }

    fn of<T: Steps>(system: System, mut simulation: Simulation<T>) -> Self {
        let (mut segments, mut impacts) = (Vec::new(), Vec::new());
        let mut norms = Norms::default();
        while let Some(step) = simulation.step() {
            let [t_start, t_end] = [step.t_start, step.t_end].map(Real::to_f64);
            if t_end > t_start {
                segments.push((t_start, rounded(&step.start)));
            }
            for impact in step.impacts() {
                let v_n = impact.v_n.to_f64();
                norms.rho1 = norms.rho1.max(v_n);
                norms.rho2 += if t_end <= 10.0 { v_n } else { 0.0 };
                norms.rho3 += v_n;
                impacts.push(Impact {
                    t: t_end,
                    cable: impact.cable,
                    v_n,
                    impulse: impact.impulse.to_f64(),
                    energy_lost: impact.energy_lost.to_f64(),
                    before: rounded(&impact.before),
                    after: rounded(&impact.after),
                });
            }
        }
        norms.y_max = simulation.y_max().to_f64();
        norms.theta_max = simulation.theta_max().to_f64();
        let end = End {
            reason: simulation.stop().unwrap_or(Stop::EndTime),
            t: simulation.time().to_f64(),
            t_limit: simulation.t_limit().map(Real::to_f64),
            state: rounded(simulation.state()),
        };
        segments.push((end.t, end.state));
        Self {
            system,
            segments,
            impacts,
            end,
            norms,
        }
    }

    /// The system that moved.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Its impacts in order of time.
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// The impacts of slack cables: an impulse that is passed into a taut one does not count.
    pub fn snaps(&self) -> usize {
        self.impacts.iter().filter(|hit| hit.v_n > 0.0).count()
    }

    /// How it ended.
    pub fn end(&self) -> &End {
        &self.end
    }

    /// Its norms.
    pub fn norms(&self) -> &Norms {
        &self.norms
    }

    /// The state at a time within it.
    pub fn at(&self, t: f64) -> State {
        let after = self.segments.partition_point(|(from, _)| *from <= t);
        let (from, start) = self.segments[after.saturating_sub(1)];
        let on = || Simulation::new(self.system.clone(), Rules::until(t), from, start).ok();
        match on().filter(|_| t > from) {
            Some(mut simulation) => {
                simulation.step();
                *simulation.state()
            }
            None => start,
        }
    }
}

fn rounded<T: Real>(state: &State<T>) -> State {
    State::from_components(state.components().map(Real::to_f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first impacts agree with those of doubles, the last ones do not; and the motion between
    /// them is that of the run.
    #[test]
    fn a_run_of_many_digits_is_one_of_doubles_until_these_are_used_up() -> Result<(), CaseError> {
        let case = Parameters::STANDARD;
        let (exact, doubles) = (
            RoundedRun::of_76_digits(&case)?,
            RoundedRun::of_doubles(&case)?,
        );
        for (p, q) in exact.impacts().iter().zip(doubles.impacts()).take(100) {
            assert!((p.t - q.t).abs() < 1e-6 && p.cable == q.cable);
        }
        // The number that `snapload certify` proves, and the number in doubles.
        assert_eq!((exact.snaps(), doubles.snaps()), (290, 300));
        assert!((exact.end().t - 7.246_303_94).abs() < 1e-6);
        let run = Case::new(case)?.run();
        assert_eq!((run.norms(), run.end()), (doubles.norms(), doubles.end()));
        for k in 0..70 {
            let t = 0.1 * f64::from(k);
            let (p, q) = (doubles.at(t).components(), run.at(t).state.components());
            assert!(p.iter().zip(q).all(|(p, q)| (p - q).abs() < 1e-12), "{t}");
        }
        Ok(())
    }
}
