//! The position of rest on elastic lines.
//!
//! Pulling lines are stretched, so that the body rests higher than on inextensible lines,
//! and the distribution of the load among several lines follows from their stiffness. The position
//! of rest is the minimum of the potential energy of buoyancy and springs,
//!
//! ```text
//! V = −F·(x, y) + Σ ½ k_i max(δ_i, 0)²,    ∇V = −(F, 0) + Σ T_i (n_i, s_i),    T_i = k_i max(δ_i, 0)
//! ```
//!
//! to which ½ qᵀCq − F_cᵀq of the hydrostatics is added for a floating body, q = (x, y, θ). It is
//! found by the method of Levenberg and Marquardt (J. Nocedal and S. Wright, *Numerical
//! Optimization* (2006), chapter 4): Newton's step with a multiple of the identity added to the
//! second derivatives, large enough for the energy to decrease. It also ends at a balance that is
//! no minimum if it begins on an axis of symmetry; such a balance is left along the motion in
//! which the energy decreases, to both sides, and the search goes on. But rounding may take it from
//! such an axis to either side before it has reached the balance, so that a second search begins
//! where the lines are stretched and the body has not yet turned.

use super::body::BodyOnElasticLines;
use super::law::ElasticLine;
use crate::physics::equilibrium::{Equilibrium, check_submerged, moved, unstable_motion};
use crate::physics::model::Model;
use crate::physics::model_at_rest::ModelAtRest;
use nalgebra::{DMatrix, Matrix3, Vector3};
use snapload::{CaseError, State};
use std::f64::consts::FRAC_PI_2;

/// The largest residual force before the last step, for springs of up to 1 F/L together; that of
/// stiffer ones is larger in proportion, as the rounding of their forces is.
const BALANCED: f64 = 1e-12;
/// The largest residual force of springs of any stiffness.
const LARGEST_RESIDUAL: f64 = 1e-3;
/// The most steps of the search.
const STEPS: usize = 400;
/// Step of the difference quotients for the derivatives of rows.
const DIFFERENCE: f64 = 1e-6;
/// The largest turn of one step within 90 degrees, where a longer one could pass over a place of
/// rest \[rad\].
const LARGEST_TURN: f64 = 0.2;
/// How far an unstable balance is left, in the engine's units.
const ASIDE: f64 = 1e-2;
/// The most unstable balances that are left one after the other.
const UNSTABLE_BALANCES: usize = 3;
/// Energies that differ by no more than their rounding, in the engine's units.
const EQUAL_ENERGY: f64 = 1e-10;
/// The same for minima: mirror images on coefficients of a panel code, which are not quite
/// symmetric.
const SAME_MINIMUM: f64 = 1e-6;
/// The least difference in turn of two places of rest \[rad\].
const APART: f64 = 1e-4;
/// What lines have to do for a body to rest on them.
const ELASTIC_LINES_THAT_HOLD: &str = "elastic lines that hold the body at rest";
/// What is added to the second derivatives at first, and at most, for springs of up to 1 F/L
/// together; it is larger in proportion for stiffer ones.
const DAMPING: [f64; 2] = [1e-6, 1e12];

impl ModelAtRest {
    /// The same structure about its position of rest on elastic lines, from which it starts in the
    /// waves at that depth, unless the case gives a start.
    ///
    /// # Errors
    /// A [`CaseError`] if it has no position of rest on them.
    pub fn with_elastic_lines(&self, elastic_lines: &[ElasticLine]) -> Result<Self, CaseError> {
        let still = self.model.still();
        let body = BodyOnElasticLines::new(&still, elastic_lines);
        let start = self.model.at_rest(self.rest.place_m, self.rest.theta_rad);
        let (rest, either_side) = place_of_rest(&body, start)?;
        if rest.theta.abs() >= FRAC_PI_2 {
            let shown = format!("(turned by {:.0} degrees)", rest.theta.abs().to_degrees());
            return Err(
                CaseError::value("line.stiffness", shown, ELASTIC_LINES_THAT_HOLD)
                    .with_hint("check the lengths of the lines and the moments on the body"),
            );
        }
        let place_m = self.model.scales.to_si([rest.x, rest.y]);
        if self.structure.afloat.is_none() {
            check_submerged(&self.structure, place_m, rest.theta)?;
        }
        let tension = |line: usize| body.elongation(line, &rest).force.max(0.0);
        let tension_n =
            (0..elastic_lines.len()).map(|line| tension(line) * self.model.scales.force_n);
        let tension_n: Vec<f64> = tension_n.collect();
        let taut = (0..elastic_lines.len()).filter(|&line| tension_n[line] > 0.0);
        let rest = Equilibrium {
            place_m,
            theta_rad: -rest.theta,
            rests: true,
            taut: taut.collect(),
            tension_n,
            either_side,
            ..Equilibrium::default()
        };
        let structure = self.structure.clone();
        // With a start of the case the run is compared with inextensible lines, in the same
        // waves.
        let model = match structure.start_m {
            // The coefficients of a floating body refer to the mean position, which does not change
            // either.
            None if structure.afloat.is_some() => self.model.clone(),
            Some(_) => self.model.clone(),
            None => Model::about(&structure, rest.place_m, &[]),
        };
        let mut elastic_case = Self::starting(structure, rest, model);
        elastic_case
            .modes_on_taut_lines
            .clone_from(&self.modes_on_taut_lines);
        Ok(elastic_case)
    }

    /// The derivative of the force on a body at rest on elastic lines, as by
    /// [`ModelAtRest::with_elastic_lines`], with respect to its position: the second derivatives of
    /// V over (x, y, θ), in the engine's units.
    pub(in crate::physics) fn stiffness_on(&self, elastic_lines: &[ElasticLine]) -> Matrix3<f64> {
        let body = BodyOnElasticLines::new(&self.model.system, elastic_lines);
        let at = self.model.at_rest(self.rest.place_m, self.rest.theta_rad);
        curvature(&body, &at)
    }

    /// The same with respect to its velocity: Σ c_i (n_i, s_i)ᵀ(n_i, s_i) over the stretched lines.
    pub(in crate::physics) fn damping_on(&self, elastic_lines: &[ElasticLine]) -> Matrix3<f64> {
        let body = BodyOnElasticLines::new(&self.model.system, elastic_lines);
        let at = self.model.at_rest(self.rest.place_m, self.rest.theta_rad);
        let rows = elastic_lines
            .iter()
            .enumerate()
            .filter_map(|(line, elastic_line)| {
                let (row, elongation) = body.row(line, &at);
                (elongation > 0.0).then(|| (Vector3::from(row), elastic_line.damping))
            });
        rows.fold(Matrix3::zeros(), |sum, (row, damping)| {
            sum + row * row.transpose() * damping
        })
    }
}

/// V at a position, and ∇V.
fn energy(body: &BodyOnElasticLines, at: &State) -> (f64, Vector3<f64>) {
    let force = body.system.forcing.constant;
    let mut energy = -(force.x * at.x + force.y * at.y);
    let mut gradient = Vector3::new(-force.x, -force.y, 0.0);
    if let Some(water) = &body.system.floating {
        let q = Vector3::new(at.x, at.y, at.theta);
        let stiffness = Matrix3::from(water.stiffness).transpose();
        let constant = Vector3::from(water.constant);
        energy += 0.5 * q.dot(&(stiffness * q)) - constant.dot(&q);
        gradient += stiffness * q - constant;
    }
    for (line, elastic_line) in body.elastic_lines.iter().enumerate() {
        let (row, elongation) = body.row(line, at);
        if elongation > 0.0 {
            energy += 0.5 * elastic_line.rate * elongation * elongation;
            gradient += Vector3::from(row) * (elastic_line.rate * elongation);
        }
    }
    (energy, gradient)
}

/// The second derivatives of V, Σ k_i ((n_i, s_i)ᵀ(n_i, s_i) + δ_i ∇(n_i, s_i)) over the stretched
/// lines. Only the rows are differentiated numerically, as the elongation of a line may be smaller
/// than the step of the differences.
fn curvature(body: &BodyOnElasticLines, at: &State) -> Matrix3<f64> {
    let water = body.system.floating.as_ref();
    let mut curvature = water.map_or(Matrix3::zeros(), |water| Matrix3::from(water.stiffness));
    for (line, elastic_line) in body.elastic_lines.iter().enumerate() {
        let (row, elongation) = body.row(line, at);
        if elongation <= 0.0 {
            continue;
        }
        let row = Vector3::from(row);
        curvature += row * row.transpose() * elastic_line.rate;
        for k in 0..3 {
            let mut step = Vector3::zeros();
            step[k] = DIFFERENCE;
            let [ahead, behind] = [step, -step].map(|step| body.row(line, &moved(at, &step)).0);
            let slope = (Vector3::from(ahead) - Vector3::from(behind)) / (2.0 * DIFFERENCE);
            let mut column = curvature.column_mut(k);
            column += slope * (elastic_line.rate * elongation);
        }
    }
    (curvature + curvature.transpose()) * 0.5
}

/// The place of rest, and whether there is one with the same energy that is turned to the other
/// side.
fn place_of_rest(body: &BodyOnElasticLines, start: State) -> Result<(State, bool), CaseError> {
    let stable = |start: State| stable_rest(body, start, UNSTABLE_BALANCES);
    let direct = stable(start);
    let stretched = least_energy(body, start, false).and_then(stable);
    let found = [&direct, &stretched].into_iter().flatten().flatten();
    let found: Vec<State> = found.copied().collect();
    let Some(rest) = lowest(body, &found) else {
        return direct.map(|found| (found[0], false));
    };
    let [least, turn] = [energy(body, &rest).0, rest.theta.abs()];
    let other_side = |other: &State| {
        let opposite = other.theta * rest.theta < 0.0 && turn.min(other.theta.abs()) > APART;
        opposite && (energy(body, other).0 - least).abs() < SAME_MINIMUM
    };
    Ok((rest, found.iter().any(other_side)))
}

/// Of places of rest within 90 degrees the one of least energy, and of those with the same the one
/// that is turned counter-clockwise, for which θ is negative.
fn lowest(body: &BodyOnElasticLines, places: &[State]) -> Option<State> {
    let lower = |one: State, other: State| {
        let more = energy(body, &other).0 - energy(body, &one).0;
        match more < -SAME_MINIMUM || (more < SAME_MINIMUM && other.theta < one.theta - APART) {
            true => other,
            false => one,
        }
    };
    let upright = places.iter().copied();
    let upright = upright.filter(|rest| rest.theta.abs() < FRAC_PI_2);
    upright.reduce(lower)
}

/// Minima of V, at least one. A balance that is none is left to both sides.
fn stable_rest(
    body: &BodyOnElasticLines,
    start: State,
    unstable_balances: usize,
) -> Result<Vec<State>, CaseError> {
    let balance = least_energy(body, start, true)?;
    let curvature = curvature(body, &balance);
    let curvature = DMatrix::from_fn(3, 3, |i, j| curvature[(i, j)]);
    let Some(motion) = unstable_motion(curvature) else {
        return Ok(vec![balance]);
    };
    let error = || {
        let shown = "(the only balance found is unstable)".to_owned();
        CaseError::value("line.stiffness", shown, ELASTIC_LINES_THAT_HOLD)
            .with_hint("use stiffer lines, or add lines that keep the body from turning")
    };
    let left = unstable_balances.checked_sub(1).ok_or_else(error)?;
    // An eigenvector has no sign of its own: a turn is counter-clockwise first.
    let aside = ASIDE * -motion[motion.iamax()].signum();
    let sides = [aside, -aside].map(|aside| {
        let step = Vector3::new(motion[0], motion[1], motion[2]) * aside;
        stable_rest(body, moved(&balance, &step), left)
    });
    let mut minima: Vec<State> = sides.into_iter().flatten().flatten().collect();
    minima.retain(|rest| rest.theta.abs() < FRAC_PI_2);
    if minima.is_empty() {
        return Err(error());
    }
    Ok(minima)
}

/// A balance at which V is less than at the start, of the body free to turn or at the rotation of
/// the start.
fn least_energy(body: &BodyOnElasticLines, start: State, turns: bool) -> Result<State, CaseError> {
    let energy = |at: &State| {
        let (energy, mut gradient) = energy(body, at);
        gradient[2] = if turns { gradient[2] } else { 0.0 };
        (energy, gradient)
    };
    let mut at = start;
    let [mut damping, most] = DAMPING;
    let (mut least, mut gradient) = energy(&at);
    for _ in 0..STEPS {
        let scale = body
            .elastic_lines
            .iter()
            .map(|elastic_line| elastic_line.rate)
            .sum::<f64>();
        let mut second = curvature(body, &at);
        if !turns {
            second.fill_row(2, 0.0);
            second.fill_column(2, 0.0);
            second[(2, 2)] = 1.0;
        }
        if gradient.amax() <= (BALANCED * scale.max(1.0)).min(LARGEST_RESIDUAL) {
            // A last Newton step reduces the error to rounding.
            let step = second.lu().solve(&-gradient);
            return Ok(step.map_or(at, |step| moved(&at, &step)));
        }
        let largest_turn = match at.theta.abs() < FRAC_PI_2 {
            true => LARGEST_TURN,
            false => f64::INFINITY,
        };
        loop {
            let damped = second + Matrix3::identity() * (damping * scale.max(1.0));
            let step = damped.lu().solve(&-gradient);
            let shorter = |step: Vector3<f64>| step * (largest_turn / step[2].abs()).min(1.0);
            let tried = step.map(|step| moved(&at, &shorter(step)));
            if let Some(tried) = tried
                && let (energy, slope) = energy(&tried)
                // Close to rest the values of V differ only by rounding, and its gradient decides.
                && (energy < least
                    || (energy < least + EQUAL_ENERGY && slope.amax() < 0.5 * gradient.amax()))
            {
                (at, least, gradient) = (tried, energy, slope);
                damping = (damping / 10.0).max(1e-15);
                break;
            }
            damping *= 10.0;
            if damping > most {
                return no_equilibrium_error(&gradient);
            }
        }
    }
    no_equilibrium_error(&gradient)
}

fn no_equilibrium_error(left: &Vector3<f64>) -> Result<State, CaseError> {
    let shown = format!(
        "(forces out of balance by {:.1e} of the buoyancy)",
        left.amax()
    );
    Err(
        CaseError::value("line.stiffness", shown, ELASTIC_LINES_THAT_HOLD)
            .with_hint("give run.start, or check the stiffness and the lengths of the lines"),
    )
}
