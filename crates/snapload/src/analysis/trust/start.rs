//! Where neighbours may begin otherwise than the run.
//!
//! A cable that has its full length at the start of the run may be slack in neighbours, as far as
//! they reach; beyond its end none of them starts. If it closes, all neighbours snap, each at −g/ġ,
//! which is an impact like any other: the run is at the end of their range. If it opens, a
//! neighbour that is slack opens, too, unless its gap rises again. Of legal neighbours g' ≤ 0 at
//! the start, and along a flight in which all feel the same force
//!
//! ```text
//! g'(s) = g'(0) + ∫ ġ' ≤ g(s) + ∫ D      D = max |ġ' − ġ| ≤ Σ max |∂ġ/∂z_i| |δz_i|
//! ```
//!
//! since g(0) = 0. So none of them closes before g(s) + ∫ D reaches zero. The neighbours drift away
//! from the run with constant velocities, so that each is furthest from it at an end of the flight.
//! In any other motion nothing is known of a neighbour between the ends of a step.
//!
//! With v_n and α at the first snap of such a cable, a neighbour that began δ from its end snaps at
//! √(v_n² + 2αδ). The linearised motion says what follows where 2|α|δ is a small part of v_n²:
//! within a tenth its error is a fortieth of the deviation.

use crate::analysis::trust::HorizonCause;
use crate::analysis::trust::causes::Closing;
use crate::analysis::trust::covariance::{CovarianceFactor, SIGMA_REACH};
use crate::analysis::trust::neighbours::Spread;
use crate::model::cable::Normal;
use crate::model::rules::Rules;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::simulation::{Simulation, Step};
use crate::motion::start::{START_TOLERANCE, start_tolerance};
use crate::motion::step_map::Deviation;

/// Neighbours snap like the run where 2|α|δ is at most this part of v_n².
const ALIKE: f64 = 0.1;

/// The closed cables at the start, as neighbours have them.
pub(super) struct Beginning {
    /// Why trust ends there, if it does.
    pub(super) cause: Option<HorizonCause>,
    /// Cables that may be slack in neighbours.
    pub(super) maybe_slack: TautSet,
    /// Those of them that open.
    pub(super) opening: TautSet,
}

impl Beginning {
    /// How a motion may begin for neighbours with this spread.
    pub(super) fn of(simulation: &Simulation, covariance: &CovarianceFactor) -> Self {
        let system = simulation.system();
        let at_end = |&cable: &usize| {
            simulation.contact(cable).gap >= -start_tolerance(&system.cables[cable])
        };
        let closed: TautSet = system.all_cables().iter().filter(at_end).collect();
        let starts = closed
            .iter()
            .map(|i| (i, cable_start(simulation, covariance, i)));
        let with = |which: fn(&CableStart) -> bool| -> TautSet {
            let chosen = starts.clone().filter(|(_, start)| which(start));
            chosen.map(|(cable, _)| cable).collect()
        };
        let maybe_slack = with(|start| start.maybe_slack);
        let closing = with(|start| start.closes);
        // What is closed when a cable snaps has moved on where a neighbour snaps later.
        let in_order = maybe_slack.is_empty() || closing.is_empty() || closed.len() == 1;
        let mut doubtful = with(|start| !start.certain).iter();
        let cable = doubtful
            .next()
            .or_else(|| maybe_slack.iter().find(|_| !in_order));
        Self {
            cause: cable.map(|cable| HorizonCause::Start { cable }),
            maybe_slack,
            opening: closing.iter().fold(maybe_slack, TautSet::without),
        }
    }
}

/// How a closed cable begins in neighbours.
struct CableStart {
    /// Whether it may be slack.
    maybe_slack: bool,
    /// Whether it snaps at once, in the run.
    closes: bool,
    /// Whether it moves in the same direction in all of them or, if it rests, rests in all; and
    /// whether more than rounding tells if it is taut.
    certain: bool,
}

fn cable_start(simulation: &Simulation, covariance: &CovarianceFactor, cable: usize) -> CableStart {
    let (system, state) = (simulation.system(), simulation.state());
    let tether = &system.cables[cable];
    let (normal, slopes) = tether.normal_and_slopes(state);
    let [x, y, theta] =
        slopes.map(|slopes| slopes[0] * state.vx + slopes[1] * state.vy + slopes[2] * state.vtheta);
    let [a, b, arm] = [normal.n.x, normal.n.y, normal.arm];
    let gap = 2.0 * tether.length() * covariance.along(&[a, b, arm, 0.0, 0.0, 0.0]);
    let maybe_slack = SIGMA_REACH * gap > start_tolerance(tether);
    let speed = SIGMA_REACH * covariance.along(&[x, y, theta, a, b, arm]);
    let (v_n, rests) = (normal.velocity(state), simulation.resting().contains(cable));
    let goes_on = match rests {
        true => !maybe_slack && speed <= START_TOLERANCE,
        false => speed < v_n.abs(),
    };
    CableStart {
        maybe_slack,
        closes: !rests && v_n > 0.0,
        certain: goes_on && !simulation.undecided_at_start().contains(cable),
    }
}

/// The cables that may be slack in neighbours at the start, up to the first event.
#[derive(Clone, Debug)]
pub(super) struct MaybeSlack {
    /// Those that open.
    pub(super) opening: TautSet,
    t: f64,
    /// How far neighbours begin from the end of each of them.
    reach: PerCable<f64>,
    /// Standard deviations of the neighbours at the start.
    sizes: Deviation,
    /// By how much the gaps of neighbours may exceed those of the run by now.
    margins: PerCable<f64>,
}

impl MaybeSlack {
    /// Those of a motion about to begin with this spread; none if there are none.
    pub(super) fn of(
        simulation: &Simulation,
        spread: &Spread,
        [maybe_slack, opening]: [TautSet; 2],
    ) -> Option<Box<Self>> {
        let [mut reach, mut margins] = [[0.0; MAX_CABLES]; 2];
        for cable in maybe_slack.iter() {
            let Normal { n, arm } = simulation.system().cables[cable].normal(simulation.state());
            reach[cable] = spread.reach(&[n.x, n.y, arm, 0.0, 0.0, 0.0]);
            margins[cable] = -simulation.contact(cable).gap;
        }
        let all = Self {
            opening,
            t: simulation.time(),
            reach,
            sizes: spread.sizes,
            margins,
        };
        (!maybe_slack.is_empty()).then(|| Box::new(all))
    }

    /// Why and when trust ends if one of them may close again within the step for some
    /// neighbours, or snaps there otherwise than for these; `along` is their spread at its
    /// end, at the time of the start.
    pub(super) fn cause(
        &mut self,
        simulation: &Simulation,
        step: &Step,
        along: &Spread,
        closing: Option<Closing>,
    ) -> Option<(HorizonCause, f64)> {
        let unlike = closing.filter(|&Closing { cable, v_n, alpha }| {
            self.reach[cable] > 0.0 && 2.0 * alpha.abs() * self.reach[cable] >= ALIKE * v_n * v_n
        });
        let cable = unlike.map(|closing| closing.cable);
        let cable = cable.or_else(|| self.may_close(simulation, step, along))?;
        Some((HorizonCause::Start { cable }, self.t))
    }

    /// The first that opens and may close again within the step.
    fn may_close(&mut self, simulation: &Simulation, step: &Step, along: &Spread) -> Option<usize> {
        let (system, s) = (simulation.system(), step.t_end - step.t_start);
        let feel_one_force = system.drag.is_none()
            && system.floating.is_none()
            && along.covariance.columns.is_empty();
        let is_flight = s > 0.0 && step.taut.is_empty() && feel_one_force;
        self.opening.iter().find(|&cable| {
            let slopes = simulation.slope_bounds_of_gap_rate(step, cable);
            let sizes = self.sizes.iter().zip(&along.sizes);
            let each = slopes.iter().zip(sizes);
            let rate: f64 = each.map(|(slope, (a, b))| slope * a.max(*b)).sum();
            let rate = SIGMA_REACH * rate;
            let margin = self.margins[cable];
            self.margins[cable] += rate * s;
            !is_flight
                || simulation
                    .slack_gap(step, cable)
                    .first_near([margin, rate])
                    .is_some()
        })
    }
}

/// Whether a run that starts at a limit, or on its cables at the settling height, may stop there
/// while a neighbour does not. No neighbour starts beyond a limit by more than the start's
/// tolerance.
pub(super) fn may_stop(simulation: &Simulation, spread: &Spread) -> bool {
    let (system, state) = (simulation.system(), simulation.state());
    let Rules {
        limits,
        settled_below,
        sliding_above,
        t_end: _,
        max_impacts: _,
        v_stick: _,
    } = simulation.rules();
    let near = |place: f64, margin: f64| place.abs() <= margin;
    let limits = limits.iter().any(|(limit, bound)| {
        let slopes = limit.slope_bounds(system, bound);
        let margin = spread.at_most(&slopes).min(START_TOLERANCE);
        near(limit.quantity(system, state) - bound, margin)
    });
    let heights = [*settled_below, *sliding_above];
    let margin = SIGMA_REACH * spread.sizes[1];
    let settles = heights
        .into_iter()
        .flatten()
        .any(|height| near(state.y - height, margin));
    limits || settles && !simulation.closed().is_empty()
}
