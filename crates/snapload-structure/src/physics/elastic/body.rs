//! A body on elastic lines: the forces of the lines at a state, and the acceleration.

use super::law::ElasticLine;
use snapload::{Complex, FreeMotion, State, Stretch, System, TautSet};
use std::cell::RefCell;

/// A body on elastic lines.
pub(super) struct BodyOnElasticLines<'a> {
    pub(super) system: &'a System,
    pub(super) elastic_lines: &'a [ElasticLine],
    free: RefCell<FreeMotion>,
}

/// The state of one line.
pub(super) struct Elongation {
    /// Unit vector along the line.
    n: [f64; 2],
    /// Lever arm.
    arm: f64,
    /// δ.
    elongation: f64,
    /// δ̇.
    pub(super) rate: f64,
    /// k δ + c δ̇.
    pub(super) force: f64,
}

impl<'a> BodyOnElasticLines<'a> {
    pub(super) fn new(system: &'a System, elastic_lines: &'a [ElasticLine]) -> Self {
        Self {
            system,
            elastic_lines,
            free: RefCell::new(FreeMotion::new(system)),
        }
    }

    pub(super) fn elongation(&self, line: usize, state: &State) -> Elongation {
        let Stretch { normal, elongation } = self.system.cables[line].stretch(state);
        let rate = normal.velocity(state);
        Elongation {
            n: normal.n.components(),
            arm: normal.arm,
            elongation,
            rate,
            force: self.elastic_lines[line].force(elongation, rate),
        }
    }

    /// The row (n, s) of a line and its elongation δ.
    pub(super) fn row(&self, line: usize, state: &State) -> ([f64; 3], f64) {
        let Elongation {
            n: [x, y],
            arm,
            elongation,
            ..
        } = self.elongation(line, state);
        ([x, y, arm], elongation)
    }

    /// The lines that pull at a state.
    pub(super) fn pulling(&self, state: &State) -> TautSet {
        let pulls = |line: &usize| {
            let Elongation {
                elongation, force, ..
            } = self.elongation(*line, state);
            elongation > 0.0 && force > 0.0
        };
        (0..self.elastic_lines.len()).filter(pulls).collect()
    }

    /// The event function of a line: positive as long as it continues to pull, or not to pull.
    pub(super) fn until_change(&self, line: usize, state: &State, pulls: bool) -> f64 {
        let Elongation {
            elongation, force, ..
        } = self.elongation(line, state);
        match (pulls, elongation <= 0.0) {
            (true, _) => force,
            (false, true) => -elongation,
            (false, false) => -force,
        }
    }

    /// The smooth function whose zero the change is at, near it: the elongation of a line that
    /// becomes taut, its force where it is stretched but has contracted too quickly to pull.
    pub(super) fn crossing(&self, line: usize, state: &State, pulls: bool) -> f64 {
        let Elongation {
            elongation,
            force,
            rate,
            ..
        } = self.elongation(line, state);
        match (pulls, rate > 0.0) {
            (true, _) => force,
            (false, true) => -elongation,
            (false, false) => -force,
        }
    }

    /// The largest angular frequency sqrt(k w) of a pulling line; at least 1.
    pub(super) fn quickest(&self, state: &State, pulling: TautSet) -> f64 {
        let body = &self.system.body;
        pulling.iter().fold(1.0, |quickest: f64, line| {
            let inverse_mass =
                body.largest_inverse_effective_mass(self.elongation(line, state).arm);
            quickest.max((self.elastic_lines[line].rate * inverse_mass).sqrt())
        })
    }

    /// A bound on the rates at which the lines let it oscillate and damp it: all of them pull, in
    /// the same direction, each with its longest arm.
    pub(super) fn quickest_of_all(&self) -> f64 {
        let mut sums = [0.0; 2];
        for (cable, line) in self.system.cables.iter().zip(self.elastic_lines) {
            let arm = cable.fairlead().length();
            let inverse_mass = self.system.body.largest_inverse_effective_mass(arm);
            sums[0] += line.rate * inverse_mass;
            sums[1] += line.damping * inverse_mass;
        }
        sums[0].sqrt().max(sums[1])
    }

    /// The accelerations, given the water's memory, whose rates of change are written to `rates`.
    pub(super) fn rates(
        &self,
        t: f64,
        state: &State,
        memory: &[Complex],
        rates: &mut [Complex],
        pulling: TautSet,
    ) -> [f64; 3] {
        let free = self.free.borrow_mut().rates(t, state, memory, rates);
        pulling.iter().fold(free, |[x, y, theta], line| {
            let Elongation { n, arm, force, .. } = self.elongation(line, state);
            let pull = [force * n[0], force * n[1], force * arm];
            let [by_x, by_y, by_theta] = self.system.body.moved_by(pull);
            [x - by_x, y - by_y, theta - by_theta]
        })
    }
}
