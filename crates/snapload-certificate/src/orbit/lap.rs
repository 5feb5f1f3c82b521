//! The motion of a box of states over one lap, with its derivative.

use crate::arithmetic::ball::Ball;
use crate::case::ExactCase;
use crate::model::{Model, State};
use crate::proved::{ProvedImpact, Reason};
use crate::run::{Next, Run};
use crate::slack::impact::Matrix;
use crate::slack::set::product;
use crate::verdict::ProofFailure;
use snapload::Stop;

/// The data for proofs about laps: a case at high and at low precision, and the time at which a lap
/// begins.
pub(super) struct Laps {
    case: ExactCase,
    fine: Model,
    coarse: Model,
    start: Ball,
    /// The ends of the periods of the forcing within a lap, as times since its beginning.
    sections: Vec<Ball>,
}

/// What is proved for all states of a box.
pub(super) struct Lap {
    /// The states after the lap.
    pub(super) image: State,
    /// ∂(the state after the lap)/∂(the one before), over all of the box.
    pub(super) derivative: Matrix,
    /// All impacts.
    pub(super) impacts: Vec<ProvedImpact>,
    /// The states after each period of the forcing but the last.
    pub(super) sections: Vec<State>,
}

impl Laps {
    /// Laps of a case that begin at a given part of the forcing's period, in numbers of `limbs`
    /// limbs.
    pub(super) fn new(
        case: &ExactCase,
        (phase, periods): (&Ball, u32),
        limbs: usize,
    ) -> Result<Self, ProofFailure> {
        let mut fine = Model::new(case, limbs)?;
        let mut coarse = Model::new(case, limbs.div_ceil(3).max(2))?;
        if fine.is_steady {
            return Err(ProofFailure::not_covered("a constant force has no period"));
        }
        // T = 2π/|Ω|.
        let period = fine.functions.half_pi() * &fine.inverse_omega.abs();
        let period = period.scaled(2);
        let start = &period * phase;
        let sections: Vec<Ball> = (1..=periods)
            .map(|k| &period * &Ball::integer(i64::from(k)))
            .collect();
        let end = sections.last().map_or(start.clone(), |last| &start + last);
        (fine.t_end, coarse.t_end) = (end.clone(), end);
        Ok(Self {
            case: case.without_end(),
            fine,
            coarse,
            start,
            sections,
        })
    }

    /// Proves that a lap of all states of a box has these snaps and nothing else, and encloses the
    /// states after it.
    pub(super) fn of(&self, states: &State, struck: &[usize]) -> Result<Lap, ProofFailure> {
        let models = [&self.fine, &self.coarse];
        let mut run = Run::of_states(&self.case, models, &self.start, states);
        let mut derivative = unit();
        let (mut impacts, mut sections) = (Vec::new(), Vec::new());
        loop {
            match run.next_event()? {
                Next::Impact(root) => {
                    self.pass(&run, &root.whole, &mut sections)?;
                    let snap = run.apply_impact(&root)?;
                    let expected = struck.get(impacts.len()).copied();
                    if expected != Some(snap.impact.cable) {
                        return Err(other_events(snap.impact.cable, impacts.len()));
                    }
                    if snap.stick.is_some() || snap.end.is_some() {
                        let what =
                            "a cable stays taut, but proofs of orbits cover slack flight only";
                        return Err(ProofFailure::not_covered(what));
                    }
                    derivative = product(&snap.jacobian, &derivative);
                    impacts.push(snap.impact);
                }
                Next::End(end) if end.reason == Reason::Stop(Stop::EndTime) => {
                    if impacts.len() < struck.len() {
                        let (found, all) = (impacts.len(), struck.len());
                        let what = format!("the lap has {found} snaps, not {all}");
                        return Err(ProofFailure::Refuted(what));
                    }
                    let left = &end.t - &run.t;
                    self.pass(&run, &left, &mut sections)?;
                    return Ok(Lap {
                        image: end.state,
                        derivative: product(&self.flight_jacobian(&left), &derivative),
                        impacts,
                        sections,
                    });
                }
                Next::End(end) => {
                    let what = end.reason.name().replace('_', " ");
                    let t = end.t.to_f64();
                    return Err(ProofFailure::Refuted(format!(
                        "the motion ends at t = {t:.6}: {what}"
                    )));
                }
            }
        }
    }

    /// Keeps the states at the sections that a flight passes before `end`, a time since the
    /// flight's T.
    fn pass(&self, run: &Run<'_>, end: &Ball, kept: &mut Vec<State>) -> Result<(), ProofFailure> {
        let within = self.sections.len() - 1;
        while let Some(section) = self.sections[..within].get(kept.len()) {
            let tau = &self.start + section - &run.t;
            if end.is_below(&tau) {
                break;
            }
            if !(tau.is_below(end) && run.is_under_way(&tau)) {
                return Err(ProofFailure::undecided(
                    "a snap at the instant of a section",
                ));
            }
            kept.push(run.flight(&self.fine).at(&tau).0);
        }
        Ok(())
    }

    /// ∂(state)/∂(state before) of a flight: the force does not depend on the state, so that a
    /// deviation of the position grows at the rate of the velocity's deviation, which is constant.
    fn flight_jacobian(&self, time: &Ball) -> Matrix {
        let time = time.with_limbs(self.coarse.limbs);
        let mut matrix = unit();
        for i in 0..3 {
            matrix[i][i + 3] = time.clone();
        }
        matrix
    }
}

fn unit() -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| Ball::integer(i64::from(i == j))))
}

fn other_events(cable: usize, before: usize) -> ProofFailure {
    ProofFailure::Refuted(format!(
        "the motion has other snaps: one of cable {} follows after {before} snaps",
        cable + 1
    ))
}
