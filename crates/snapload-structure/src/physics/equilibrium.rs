//! The position of rest in still water.
//!
//! Lines pull only where they are taut, so the position of rest is the minimum of the potential
//! energy −F·(x, z), F the buoyancy and all other constant forces, within reach of all lines, g_i ≤
//! 0. There the Karush-Kuhn-Tucker conditions hold (J. Nocedal and S. Wright, *Numerical
//! Optimization* (2006), theorems 12.1, 12.5 and 12.6): tensions T_i ≥ 0, zero where a line is
//! slack, that balance buoyancy, and curvature Σ T_i ∇(n_i, s_i) that is not negative along the
//! motions that keep the taut lines taut. Each set of one to three lines is tried, as three hold a
//! body in the plane, from several positions and rotations; of all solutions the one of least
//! energy is taken, which is the highest if buoyancy is the only force.

use super::model::Model;
use crate::structure::{LineSi, Structure};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use snapload::{CaseError, State, System};
use snapload_hydro::shortest_solution;
use std::f64::consts::FRAC_PI_2;

/// The tolerance of a closed gap and of a balance of forces, in the engine's units.
const BALANCED: f64 = 1e-9;
/// A line counts as taut at rest if its gap is within this of zero, which is 0.1 µm on a line of
/// 100 m.
pub(super) const TOUCHING: f64 = 1e-9;
/// The most steps of Newton's method.
const STEPS: usize = 30;
/// Step of the difference quotients for the derivatives of the normals.
const DIFFERENCE: f64 = 1e-6;

/// The position of rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Equilibrium {
    /// Centre `[x, z]` \[m\].
    pub place_m: [f64; 2],
    /// Rotation, counter-clockwise with z up \[rad\].
    pub theta_rad: f64,
    /// Tension of each line, 0 where it is slack \[N\].
    pub tension_n: Vec<f64>,
    /// False if no place of rest is known; the place is then that of the case's start, without
    /// tensions.
    pub rests: bool,
    /// The lines that are just taut, by index, a slack one that touches included.
    pub taut: Vec<usize>,
    /// Whether more lines are taut than the body has degrees of freedom, so that the distribution
    /// of the load depends on their stiffness; if that is not known the tensions are those of the
    /// least sum of squares. Equal lines with the same ends count as one, as they share evenly.
    pub indeterminate: bool,
    /// Set if the stretch of the lines changes the distribution of the load: `tension_n` are then
    /// the tensions by stiffness.
    pub by_stiffness: Option<DistributionByStiffness>,
    /// Whether the body would rest as well on elastic lines turned to the other side, with the same
    /// energy.
    pub either_side: bool,
    /// The tensions of a floating body's elastic lines, if their sum differs and the lines
    /// share it in the same proportions \[N\].
    pub elastic_tension_n: Option<Vec<f64>>,
    /// Whether the body has no such place on elastic lines of the stiffness given.
    pub not_on_elastic_lines: bool,
}

/// The tensions on inextensible lines, and the position on elastic lines.
#[derive(Clone, Debug, PartialEq)]
pub struct DistributionByStiffness {
    /// The tensions of inextensible lines \[N\].
    pub inextensible_n: Vec<f64>,
    /// Centre `[x, z]` on elastic lines \[m\].
    pub place_m: [f64; 2],
}

/// Finds the position of rest.
///
/// # Errors
/// A [`CaseError`] if there is no such position below the surface.
pub fn equilibrium(structure: &Structure) -> Result<Equilibrium, CaseError> {
    let model = Model::about(structure, structure.body.position_m, &[]);
    let system = &model.still();
    let starts = starts(structure, model.scales.length_m);
    let places = sets(system.cables.len()).into_iter().flat_map(|set| {
        let at = |start: &State| rest(system, &set, *start);
        starts.iter().filter_map(at).collect::<Vec<_>>()
    });
    let best = places
        .min_by(|a, b| {
            let [a, b] = [a, b].map(|place| -system.forcing.constant.dot(place.centre()));
            a.total_cmp(&b)
        })
        .ok_or_else(|| no_equilibrium_error(structure))?;
    let taut = touching(system, &best);
    let (tension, left) = tensions(system, &taut, &best);
    if left > 1e-6 {
        return Err(no_equilibrium_error(structure));
    }
    let place_m = model.scales.to_si([best.x, best.y]);
    check_submerged(structure, place_m, best.theta)?;
    Ok(Equilibrium {
        place_m,
        theta_rad: -best.theta,
        tension_n: of_all(&model, &taut, &tension),
        rests: true,
        indeterminate: dependent(system, &one_of_each(structure, &taut), &best),
        taut,
        ..Equilibrium::default()
    })
}

/// The lines that are just taut.
fn touching(system: &System, at: &State) -> Vec<usize> {
    let lines = 0..system.cables.len();
    lines
        .filter(|&line| system.cables[line].gap(at) >= -TOUCHING)
        .collect()
}

/// The tension of each line, from those of the taut ones \[N\].
fn of_all(model: &Model, taut: &[usize], pulls: &[f64]) -> Vec<f64> {
    let mut tension_n = vec![0.0; model.system.cables.len()];
    for (line, pull) in taut.iter().zip(pulls) {
        tension_n[*line] = pull * model.scales.force_n;
    }
    tension_n
}

impl Equilibrium {
    /// The tension of each line at rest \[N\]; none where no place of rest is known.
    pub fn known_tensions_n(&self) -> Vec<Option<f64>> {
        let known = |tension: &f64| self.rests.then_some(*tension);
        self.tension_n.iter().map(known).collect()
    }

    /// The tension of each inextensible line at rest, with which the motion on them is computed
    /// \[N\].
    pub(crate) fn inextensible_tensions_n(&self) -> &[f64] {
        match &self.by_stiffness {
            Some(by_stiffness) => &by_stiffness.inextensible_n,
            None => &self.tension_n,
        }
    }

    /// The tension at rest of a line as it stretches, where that is reported because inextensible
    /// lines share the load in another way \[N\].
    pub(crate) fn stretched_n(&self, line: usize) -> Option<f64> {
        self.by_stiffness.as_ref().map(|_| self.tension_n[line])
    }

    /// Distributes the load of a floating body that is held by more lines than necessary with the
    /// least sum of squares, as for a submerged one.
    pub(super) fn distribute_by_least_squares(&mut self, structure: &Structure, model: &Model) {
        let at = model.at_rest(self.place_m, self.theta_rad);
        let taut = touching(&model.system, &at);
        if taut.len() > 1 && dependent(&model.system, &taut, &at) {
            let (tension, _) = tensions(&model.system, &taut, &at);
            self.tension_n = of_all(model, &taut, &tension);
            self.indeterminate = dependent(&model.system, &one_of_each(structure, &taut), &at);
            self.taut = taut;
        }
    }
}

/// The force on a body at rest that its lines have to balance: constant forces, reduced by the
/// hydrostatic ones if it floats.
fn load(system: &System, at: &State) -> Vector3<f64> {
    let constant = system.forcing.constant;
    let load = Vector3::new(constant.x, constant.y, 0.0);
    let Some(water) = &system.floating else {
        return load;
    };
    let stiffness = Matrix3::from(water.stiffness).transpose();
    load + Vector3::from(water.constant) - stiffness * Vector3::new(at.x, at.y, at.theta)
}

/// The error of a body without a position of rest under its steady loads, if it would have one
/// without them.
pub(super) fn steady_load_error_if_cause(
    structure: &Structure,
    rests: impl FnOnce(&Structure) -> bool,
) -> Option<CaseError> {
    let mut calm = structure.clone();
    calm.body.constant_force_n = [0.0; 2];
    calm.site.current_m_s = 0.0;
    let allowed = "a load with which the lines hold the body at rest";
    let found = steady_load_error(structure, allowed);
    found.filter(|_| rests(&calm))
}

/// The error that a steady load is not allowed, if there is one.
pub(super) fn steady_load_error(structure: &Structure, allowed: &str) -> Option<CaseError> {
    let (key, shown) = match (structure.body.constant_force_n, structure.site.current_m_s) {
        ([0.0, 0.0], 0.0) => return None,
        ([0.0, 0.0], current) => ("site.current", current.to_string()),
        ([x, z], _) => ("body.constant_force", format!("[{x}, {z}]")),
    };
    Some(CaseError::value(key, shown, allowed))
}

fn no_equilibrium_error(structure: &Structure) -> CaseError {
    if let Some(error) = steady_load_error_if_cause(structure, |calm| equilibrium(calm).is_ok()) {
        return error;
    }
    let allowed = "lines with which the body can rest upright";
    CaseError::value("line.length", lengths(structure), allowed).with_hint(
        "check anchors, fairleads and lengths: every line must reach, and together they must \
         hold the body without turning it over",
    )
}

/// A body without hydrostatics has to rest under water, on inextensible lines and on elastic ones.
pub(super) fn check_submerged(
    structure: &Structure,
    place_m: [f64; 2],
    theta_rad: f64,
) -> Result<(), CaseError> {
    let top = place_m[1] + structure.body.half_height_m(theta_rad);
    if top <= 0.0 {
        return Ok(());
    }
    let allowed = format!(
        "lines that hold the body under water; with these it rises until its top is {top:.2} m above the still water"
    );
    Err(CaseError::value("line.length", lengths(structure), allowed)
        .with_hint("shorten the lines, add lines, or use stiffer ones"))
}

fn lengths(structure: &Structure) -> String {
    let all = structure.lines.iter().map(|line| line.length_m.to_string());
    format!("[{}]", all.collect::<Vec<_>>().join(", "))
}

/// Every set of one to three of so many lines.
fn sets(count: usize) -> Vec<Vec<usize>> {
    let mut sets = Vec::new();
    for i in 0..count {
        sets.push(vec![i]);
        for j in i + 1..count {
            sets.push(vec![i, j]);
            sets.extend((j + 1..count).map(|k| vec![i, j, k]));
        }
    }
    sets
}

/// Starting points of the search: the position drawn, positions to its side and turned, and above
/// each line's anchor.
fn starts(structure: &Structure, unit_m: f64) -> Vec<State> {
    let drawn = structure.body.position_m[0];
    let anchors = structure.lines.iter().map(|line| line.anchor_m[0]);
    let above = anchors.map(|anchor| (anchor - drawn) / unit_m);
    let places: Vec<f64> = [0.0, 0.3, -0.3].into_iter().chain(above).collect();
    let turned = |x: f64| {
        [0.0, 0.4, -0.4, 1.0, -1.0].map(|theta| State {
            x,
            theta,
            ..State::default()
        })
    };
    places.into_iter().flat_map(turned).collect()
}

/// The row (n_x, n_y, s) of a line.
fn row(system: &System, line: usize, at: &State) -> Vector3<f64> {
    let normal = system.cables[line].normal(at);
    Vector3::new(normal.n.x, normal.n.y, normal.arm)
}

/// A state with its position changed by a step.
pub(super) fn moved(at: &State, step: &Vector3<f64>) -> State {
    State {
        x: at.x + step[0],
        y: at.y + step[1],
        theta: at.theta + step[2],
        ..*at
    }
}

/// The derivatives of the row of a line by x, y and θ, by differences.
fn row_gradient(system: &System, line: usize, at: &State) -> Matrix3<f64> {
    let mut gradient = Matrix3::zeros();
    for k in 0..3 {
        let mut step = Vector3::zeros();
        step[k] = DIFFERENCE;
        let ahead = row(system, line, &moved(at, &step));
        let behind = row(system, line, &moved(at, &-step));
        gradient.set_column(k, &((ahead - behind) / (2.0 * DIFFERENCE)));
    }
    gradient
}

/// A stable position of rest at which exactly these lines pull, or none from this start: Newton's
/// method on
///
/// ```text
/// Σ T_i (n_i, s_i) = (F, 0),    g_i/(2r) = 0
/// ```
fn rest(system: &System, set: &[usize], start: State) -> Option<State> {
    let m = set.len();
    let (mut at, mut tension) = (start, DVector::from_element(m, 1.0 / m as f64));
    for _ in 0..STEPS {
        let mut residual = DVector::zeros(3 + m);
        let mut matrix = DMatrix::zeros(3 + m, 3 + m);
        let load = system.forcing.constant;
        (residual[0], residual[1]) = (-load.x, -load.y);
        for (i, &line) in set.iter().enumerate() {
            let normal = row(system, line, &at);
            let gradient = row_gradient(system, line, &at) * tension[i];
            for k in 0..3 {
                residual[k] += tension[i] * normal[k];
                matrix[(k, 3 + i)] = normal[k];
                matrix[(3 + i, k)] = normal[k];
                for j in 0..3 {
                    matrix[(k, j)] += gradient[(k, j)];
                }
            }
            let cable = &system.cables[line];
            residual[3 + i] = cable.gap(&at) / (2.0 * cable.length());
        }
        if residual.amax() < 1e-15 {
            break;
        }
        let mut entries = matrix.iter().chain(residual.iter());
        if !entries.all(|entry: &f64| entry.is_finite()) {
            return None;
        }
        // If the body can turn freely the matrix is singular; the shortest step does not turn it.
        let step = shortest_solution(&matrix, &-residual, 1e-10)?;
        let shorter = (0.5 / step.rows(0, 3).norm()).min(1.0);
        at = moved(&at, &(Vector3::new(step[0], step[1], step[2]) * shorter));
        tension += step.rows(3, m) * shorter;
    }
    let within = system.cables.iter().all(|cable| cable.gap(&at) <= TOUCHING);
    let pulls = tension.iter().all(|pull| *pull > -BALANCED);
    let closed = |line: &usize| system.cables[*line].gap(&at).abs() <= TOUCHING;
    let rests = within
        && pulls
        && set.iter().all(closed)
        && at.theta.abs() < FRAC_PI_2
        && tensions(system, set, &at).1 < BALANCED
        && SmallMotions::new(system, set, tension.as_slice(), &at).is_stable();
    rests.then_some(at)
}

/// The small motions of a body on inextensible lines.
pub(super) struct SmallMotions {
    /// Σ T_i ∇(n_i, s_i) over (x, y, θ), symmetric.
    pub(super) curvature: Matrix3<f64>,
    /// Directions that span the motions that keep taut every line that pulls.
    free: Vec<Vector3<f64>>,
}

impl SmallMotions {
    /// The small motions of a body at a position, on lines with these tensions; lines with almost
    /// no tension are left out.
    pub(super) fn new(system: &System, lines: &[usize], tension: &[f64], at: &State) -> Self {
        let mut curvature = Matrix3::zeros();
        let mut held = Matrix3::zeros();
        let pulling = lines.iter().zip(tension).filter(|(_, pull)| **pull > 1e-6);
        for (&line, pull) in pulling {
            curvature += row_gradient(system, line, at) * *pull;
            let normal = row(system, line, at);
            held += normal * normal.transpose();
        }
        // The free motions are the directions that no pulling line resists.
        let frame = held.symmetric_eigen();
        let free = (0..3).filter(|&k| frame.eigenvalues[k] < 1e-9);
        let free = free.map(|k| frame.eigenvectors.column(k).into_owned());
        Self {
            curvature: (curvature + curvature.transpose()) * 0.5,
            free: free.collect(),
        }
    }

    /// The free motions, one in each column.
    pub(super) fn basis(&self) -> DMatrix<f64> {
        DMatrix::from_fn(3, self.free.len(), |i, j| self.free[j][i])
    }

    /// Whether the curvature is not negative along the free motions.
    fn is_stable(&self) -> bool {
        let basis = self.basis();
        unstable_motion(basis.transpose() * self.curvature * basis).is_none()
    }
}

/// The motion along which the curvature of the energy is most negative, if it is by more than
/// rounding, so that a balance is not one of rest; curvature and motion in the engine's units.
pub(super) fn unstable_motion(curvature: DMatrix<f64>) -> Option<DVector<f64>> {
    // A body that is held fast has no motion, and a matrix without entries no eigenvalues.
    if curvature.is_empty() {
        return None;
    }
    let frame = curvature.symmetric_eigen();
    let (least, value) = frame.eigenvalues.argmin();
    (value <= -1e-6).then(|| frame.eigenvectors.column(least).into_owned())
}

/// The tensions ≥ 0 of least sum of squares that balance the load, and the largest residual.
fn tensions(system: &System, taut: &[usize], at: &State) -> (Vec<f64>, f64) {
    let rows: Vec<Vector3<f64>> = taut.iter().map(|&line| row(system, line, at)).collect();
    let load = load(system, at);
    // Least squares, repeated without the lines that would push.
    let mut kept: Vec<usize> = (0..taut.len()).collect();
    loop {
        if kept.is_empty() {
            return (vec![0.0; taut.len()], load.amax());
        }
        let matrix = DMatrix::from_fn(3, kept.len(), |k, i| rows[kept[i]][k]);
        let right = DVector::from_fn(3, |k, _| load[k]);
        let solution = shortest_solution(&matrix, &right, 1e-10);
        let solution = solution.unwrap_or_else(|| DVector::zeros(kept.len()));
        let pushing = (0..kept.len())
            .filter(|&i| solution[i] < -1e-9)
            .min_by(|&a, &b| solution[a].total_cmp(&solution[b]));
        if let Some(worst) = pushing {
            kept.remove(worst);
            continue;
        }
        let left = (matrix * &solution - right).amax();
        let mut all = vec![0.0; taut.len()];
        for (i, &line) in kept.iter().enumerate() {
            all[line] = solution[i].max(0.0);
        }
        return (all, left);
    }
}

/// Whether the taut lines' directions depend on each other.
fn dependent(system: &System, taut: &[usize], at: &State) -> bool {
    let matrix = DMatrix::from_fn(3, taut.len(), |k, i| row(system, taut[i], at)[k]);
    matrix.rank(1e-9) < taut.len()
}

/// The taut lines without those that pull as an earlier one does: with the same ends, length and
/// stiffness they share evenly.
fn one_of_each(structure: &Structure, taut: &[usize]) -> Vec<usize> {
    let lines = &structure.lines;
    let is_as = |line: &LineSi, other: &LineSi| {
        let known = line.stiffness_n.is_some();
        known && line.stiffness_n == other.stiffness_n && line.is_strand_with(other)
    };
    let mut different: Vec<usize> = Vec::new();
    for &line in taut {
        if !different
            .iter()
            .any(|&other| is_as(&lines[line], &lines[other]))
        {
            different.push(line);
        }
    }
    different
}
