//! The Taylor series of several runs side by side, each of which rocks on two taut cables.
//!
//! The coefficients of one run are a chain: each order needs the one before, and most of the time
//! the processor waits. Several runs in the lanes of its registers take little longer than one.
//! Every lane performs the operations of [`Series::extend`] for two carrying cables and a unit
//! mass, in the same order, so that it has the bits of a run by itself.

use crate::arithmetic::elementary::Doubles;
use crate::arithmetic::lane::Lane;
use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::model::mass::less_pull_of_unit_mass;
use crate::motion::cable_series::CablePair;
use crate::motion::complementarity::{Factored, TwoByTwoLanes};
use crate::motion::taut_series::Series;
use crate::motion::taut_series::body::BodySeries;

/// The series of the runs in all lanes.
#[derive(Clone, Debug)]
pub(crate) struct RockingSeries<L: Lane> {
    body: BodySeries<L>,
    pair: CablePair<L>,
    force: [Polynomial<L>; 2],
    inverse_inertia: L,
    equations: TwoByTwoLanes<L>,
}

impl<L: Doubles> RockingSeries<L> {
    /// Series of no runs.
    pub(crate) fn empty() -> Self {
        Self {
            body: BodySeries::default(),
            pair: CablePair::default(),
            force: [Polynomial::default(); 2],
            inverse_inertia: L::ZERO,
            equations: TwoByTwoLanes::unit(),
        }
    }

    /// Removes the coefficients of all runs, which are summed before they are known again.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.body.clear();
        self.pair.clear();
    }

    /// Puts the beginning of a series into a lane, that of a body of unit mass on two cables,
    /// without drag and not afloat; returns whether this can extend it, which it can where both
    /// cables carry and are not along one line.
    pub(crate) fn put(
        &mut self,
        lane: usize,
        series: &mut Series<f64>,
        inverse_inertia: f64,
    ) -> bool {
        let carrying = series.active.carrying;
        let normals = series.pairs.set_carrying(carrying);
        let coupling = |i: usize, j: usize| normals[i].coupling(&normals[j], inverse_inertia);
        let equations = Factored::new(carrying, coupling);
        if !self.equations.put(lane, &equations) || !self.pair.put(lane, &series.pairs) {
            return false;
        }
        self.inverse_inertia.set(lane, inverse_inertia);
        self.body.put(lane, &series.body);
        for (all, one) in self.force.iter_mut().zip(&series.force) {
            for k in 0..ORDER - 1 {
                all[k].set(lane, one[k]);
            }
        }
        true
    }

    /// Adds the other coefficients, order by order.
    #[inline(always)]
    pub(crate) fn extend(&mut self) {
        let Self {
            body,
            pair,
            force,
            inverse_inertia,
            equations,
        } = self;
        let [along, up] = force;
        for k in 0..ORDER - 1 {
            let turned = body.known_rotation(k + 2);
            let load = [along[k], up[k], L::ZERO];
            let mut pulls = [L::ZERO; 3];
            let known = pair.known_forces(k);
            for i in 0..3 {
                pulls[i] = pulls[i] + known[i];
            }
            let known = less_pull_of_unit_mass(load, pulls, *inverse_inertia);
            let load = pair.load(k, known, turned);
            let pulls = pair.take(k, equations.solve(load));
            let acceleration = less_pull_of_unit_mass(known, pulls, *inverse_inertia);
            body.extend(k, acceleration, turned);
            pair.extend(k + 2, [body.x[k + 2], body.y[k + 2]], body.circle[k + 2]);
        }
    }

    /// Puts the coefficients of a lane into the series of its run, which makes a step with them.
    pub(crate) fn get(&self, lane: usize, series: &mut Series<f64>) {
        series.extended = true;
        self.body.get(lane, &mut series.body);
        for k in 0..ORDER - 1 {
            let tensions = self.pair.tensions(k);
            for (line, tension) in series.lines.iter_mut().zip(tensions) {
                line.tension[k] = tension.get(lane);
            }
        }
    }
}

impl<L: Doubles> BodySeries<L> {
    /// Puts the coefficients up to the first order of a run into a lane.
    fn put(&mut self, lane: usize, one: &BodySeries<f64>) {
        for k in 0..2 {
            self.x[k].set(lane, one.x[k]);
            self.y[k].set(lane, one.y[k]);
            self.theta[k].set(lane, one.theta[k]);
            self.spin[k][0].set(lane, one.spin[k][0]);
            for i in 0..2 {
                self.circle[k][i].set(lane, one.circle[k][i]);
            }
        }
    }

    /// Puts the others of a lane into the series of its run.
    fn get(&self, lane: usize, one: &mut BodySeries<f64>) {
        for k in 2..=ORDER {
            one.x[k] = self.x[k].get(lane);
            one.y[k] = self.y[k].get(lane);
            one.theta[k] = self.theta[k].get(lane);
            for i in 0..2 {
                one.circle[k][i] = self.circle[k][i].get(lane);
            }
        }
    }
}
