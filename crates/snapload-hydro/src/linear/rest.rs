//! Where a body rests on its lines in still water, and its small motions about that position.

use super::body::Body;
use super::damped::{Damped, Mode};
use super::natural::{Natural, natural, reduced};
use crate::coefficients::Hydrodynamics;
use crate::error::HydroError;
use crate::memory::Memory;
use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, RowVector3, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;

/// The most lines that can be taut at once: there are three degrees of freedom.
const MOST_TAUT: usize = 3;
/// The most steps of Newton's method.
const STEPS: usize = 60;
/// A step of less than this part of the unit of length is rounding; the second one in turn is the
/// last.
const ROUNDING: f64 = 1e-13;
/// An eigenvalue of NᵀHN below this part of the unit of force over that of length counts as no
/// stiffness.
const SINGULAR: f64 = 1e-9;

/// An inextensible line from an anchor to a point of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The anchor (x, z) \[m\].
    pub anchor_m: [f64; 2],
    /// The fairlead relative to the reference point, in the body at its mean position \[m\].
    pub fairlead_m: [f64; 2],
    /// Its length \[m\].
    pub length_m: f64,
}

/// A position of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// q \[m, m, rad\].
    pub q: Vector3<f64>,
    /// The taut lines, from 0 on.
    pub taut: Vec<usize>,
    /// The tension of each line \[N\], 0 if slack.
    pub tension_n: Vec<f64>,
    /// The slack of each line \[m\].
    pub slack_m: Vec<f64>,
    /// A basis of the motions that the taut lines allow, one motion in each column.
    pub motions: DMatrix<f64>,
    /// NᵀHN.
    pub stiffness: DMatrix<f64>,
    /// H, the stiffness of the body and of the tensions together.
    pub whole: Matrix3<f64>,
}

/// A line at a position of the body.
struct LineGeometry {
    /// From the reference point to the fairlead.
    r: Vector2<f64>,
    /// Distance of fairlead and anchor, and the direction.
    distance: f64,
    n: Vector2<f64>,
}

impl LineGeometry {
    fn at(line: &Line, reference: [f64; 2], q: &Vector3<f64>) -> Self {
        let (sine, cosine) = q[2].sin_cos();
        let [x, z] = line.fairlead_m;
        let r = Vector2::new(x * cosine + z * sine, -x * sine + z * cosine);
        let place = Vector2::new(reference[0] + q[0] + r[0], reference[1] + q[1] + r[1]);
        let separation = place - Vector2::from(line.anchor_m);
        let distance = separation.norm();
        Self {
            r,
            distance,
            n: separation / distance.max(f64::MIN_POSITIVE),
        }
    }

    /// G = (nx, nz, nx rz − nz rx).
    fn row(&self) -> RowVector3<f64> {
        let turn = self.n[0] * self.r[1] - self.n[1] * self.r[0];
        RowVector3::new(self.n[0], self.n[1], turn)
    }

    /// The second derivative of the distance, (JᵀJ − GᵀG)/r + diag(0, 0, −(nx rx + nz rz)) with J =
    /// [[1, 0, rz], [0, 1, −rx]].
    fn second_derivative(&self) -> Matrix3<f64> {
        let j = Matrix2x3::new(1.0, 0.0, self.r[1], 0.0, 1.0, -self.r[0]);
        let row = self.row();
        let mut second_derivative = (j.transpose() * j - row.transpose() * row) / self.distance;
        second_derivative[(2, 2)] -= self.n.dot(&self.r);
        second_derivative
    }
}

struct RestProblem<'a> {
    lines: &'a [Line],
    reference: [f64; 2],
    body: &'a Body,
    /// Units of length and force, in which Newton's steps are measured.
    length: f64,
    force: f64,
}

/// The position of rest with the lowest potential V = ½ qᵀCq − F_cᵀq at which no line is longer
/// than its length. For every set of up to three lines Newton's method solves
///
/// ```text
/// C q − F_c + Σ T_i G_iᵀ = 0,    |P_i − A_i| = r_i
/// ```
///
/// from several starting points; a solution is accepted if T_i > 0, the other lines are slack, and
/// NᵀHN is positive definite, with H = C + Σ T_i ∂²|P_i − A_i|/∂q² and N a basis of the null space
/// of the taut lines' G.
///
/// # Errors
/// [`HydroError::Impossible`] if there is none, for example if no taut line holds surge.
pub fn rest(hydro: &Hydrodynamics, body: &Body, lines: &[Line]) -> Result<Rest, HydroError> {
    let mut length: f64 = 1.0;
    for (index, line) in lines.iter().enumerate() {
        let numbers = [line.length_m, line.anchor_m[0], line.anchor_m[1]];
        if !(line.length_m > 0.0 && numbers.iter().all(|number| number.is_finite())) {
            let what = format!("the length of line {}", index + 1);
            return Err(HydroError::value(what, line.length_m, "it must be above 0"));
        }
        length = length.max(line.length_m);
    }
    let weight = body.mass_kg * hydro.water.gravity_m_s2;
    let [along, up, moment] = body.constant_force.abs().into();
    let problem = RestProblem {
        lines,
        reference: hydro.reference_m,
        body,
        length,
        force: weight.max(along).max(up).max(moment / length),
    };
    let mut best: Option<(f64, Rest)> = None;
    for taut in sets(lines.len()) {
        for start in problem.starts(&taut) {
            let Some(found) = problem.solve(&taut, start) else {
                continue;
            };
            let potential = problem.potential(&found.q);
            let lower =
                |(least, _): &(f64, Rest)| potential < least - 1e-9 * problem.force * length;
            if best.as_ref().is_none_or(lower) {
                best = Some((potential, found));
            }
        }
    }
    best.map(|(_, rest)| rest).ok_or_else(|| {
        let message = "there is no place of rest: no taut line holds the body in surge, or nothing \
                     holds it up; give lines that hold it, or a place to start from";
        HydroError::Impossible(message.to_owned())
    })
}

/// Where a body floats that no line holds in surge, at a surge that is given: without tension, in
/// balance of heave and pitch by its stiffness. None if a force pushes it away in surge, if water
/// does not hold it up and upright, or if a line would be too short there. With it comes how far
/// the ends of each line are apart there \[m\].
pub fn rest_without_tension(
    hydro: &Hydrodynamics,
    body: &Body,
    lines: &[Line],
    surge_m: f64,
) -> Option<(Vector3<f64>, Vec<f64>)> {
    let weight = body.mass_kg * hydro.water.gravity_m_s2;
    if body.constant_force[0].abs() > 1e-9 * weight {
        return None;
    }
    let place = body.balance()?;
    let q = Vector3::new(surge_m, place[0], place[1]);
    let distance = |line: &Line| LineGeometry::at(line, hydro.reference_m, &q).distance;
    let distances_m: Vec<f64> = lines.iter().map(distance).collect();
    let reaches = |(line, distance): (&Line, &f64)| *distance <= line.length_m * (1.0 + 1e-9);
    let all_reach = lines.iter().zip(&distances_m).all(reaches);
    (q[2].abs() < FRAC_PI_2 && all_reach).then_some((q, distances_m))
}

/// All sets of at most three of n lines.
fn sets(n: usize) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = vec![Vec::new()];
    let mut at = 0;
    while at < sets.len() {
        let set = sets[at].clone();
        if set.len() < MOST_TAUT {
            let from = set.last().map_or(0, |last| last + 1);
            for line in from..n {
                let mut more = set.clone();
                more.push(line);
                sets.push(more);
            }
        }
        at += 1;
    }
    sets
}

impl RestProblem<'_> {
    fn geometry(&self, line: usize, q: &Vector3<f64>) -> LineGeometry {
        LineGeometry::at(&self.lines[line], self.reference, q)
    }

    fn potential(&self, q: &Vector3<f64>) -> f64 {
        0.5 * q.dot(&(self.body.stiffness * q)) - self.body.constant_force.dot(q)
    }

    /// Starting points: the mean position, the position without lines, and points to the side and
    /// below it; above each anchor.
    fn starts(&self, taut: &[usize]) -> Vec<Vector3<f64>> {
        let heave = self.body.stiffness[(1, 1)];
        let free = match heave > 0.0 {
            true => self.body.constant_force[1] / heave,
            false => 0.0,
        };
        let free = free.clamp(-self.length, self.length);
        let shifted =
            |x: f64, z: f64, turn: f64| Vector3::new(x * self.length, z * self.length, turn);
        let mut starts = vec![
            Vector3::zeros(),
            Vector3::new(0.0, free, 0.0),
            shifted(0.1, 0.0, 0.0),
            shifted(-0.1, 0.0, 0.0),
            shifted(0.3, -0.1, 0.1),
            shifted(-0.3, -0.1, -0.1),
        ];
        for line in taut {
            let line = &self.lines[*line];
            let above = line.anchor_m[0] - self.reference[0] - line.fairlead_m[0];
            starts.push(Vector3::new(above, 0.0, 0.0));
        }
        starts
    }

    fn solve(&self, taut: &[usize], start: Vector3<f64>) -> Option<Rest> {
        let m = taut.len();
        let mut q = start;
        // First tensions that let lines hold surge: the lift, divided among them.
        let lift = (self.body.constant_force[1] / m.max(1) as f64).max(0.1 * self.force);
        let mut tension = vec![lift; m];
        let mut settled = 0;
        for _ in 0..STEPS {
            let geometries: Vec<LineGeometry> =
                taut.iter().map(|line| self.geometry(*line, &q)).collect();
            let (matrix, right) = self.newton(taut, &geometries, &q, &tension);
            let step = matrix.lu().solve(&right)?;
            let part = step.rows(0, 3).amax() / self.length;
            // A long step is shortened, as the equations are nonlinear.
            let scale = (0.3 / part.max(1e-300)).min(1.0);
            for i in 0..3 {
                let unit = if i == 2 { 1.0 / self.length } else { 1.0 };
                q[i] += scale * step[i] * unit;
            }
            for (k, tension) in tension.iter_mut().enumerate() {
                *tension += scale * step[3 + k] * self.force;
            }
            if !(part.is_finite() && q.amax() < 1e3 * self.length) {
                return None;
            }
            settled = if part < ROUNDING { settled + 1 } else { 0 };
            if settled == 2 {
                return self.accepted(taut, q, &tension);
            }
        }
        // Rounding may keep the last step slightly above the bound.
        let geometries: Vec<LineGeometry> =
            taut.iter().map(|line| self.geometry(*line, &q)).collect();
        let (_, right) = self.newton(taut, &geometries, &q, &tension);
        (right.amax() < 1e-11).then(|| self.accepted(taut, q, &tension))?
    }

    /// Newton's matrix and right side, lengths in units of the longest line (the rotation in
    /// radians), forces in their unit.
    fn newton(
        &self,
        taut: &[usize],
        geometries: &[LineGeometry],
        q: &Vector3<f64>,
        tension: &[f64],
    ) -> (DMatrix<f64>, DVector<f64>) {
        let m = taut.len();
        let mut hessian = self.body.stiffness;
        let mut force = self.body.constant_force - self.body.stiffness * q;
        for (geometry, tension) in geometries.iter().zip(tension) {
            hessian += geometry.second_derivative() * *tension;
            force -= geometry.row().transpose() * *tension;
        }
        // q_i = s_i u_i with s = (1, 1, 1/length), so that moments and lengths are of comparable
        // size.
        let unit = |i: usize| if i == 2 { 1.0 / self.length } else { 1.0 };
        let mut matrix = DMatrix::zeros(3 + m, 3 + m);
        let mut right = DVector::zeros(3 + m);
        for i in 0..3 {
            for j in 0..3 {
                matrix[(i, j)] = hessian[(i, j)] * unit(i) * unit(j) / self.force;
            }
            right[i] = force[i] * unit(i) / self.force;
            for (k, geometry) in geometries.iter().enumerate() {
                matrix[(i, 3 + k)] = geometry.row()[i] * unit(i);
                matrix[(3 + k, i)] = matrix[(i, 3 + k)];
            }
        }
        for (k, (geometry, line)) in geometries.iter().zip(taut).enumerate() {
            right[3 + k] = self.lines[*line].length_m - geometry.distance;
        }
        (matrix, right)
    }

    /// The position, if it is accepted as one of rest.
    fn accepted(&self, taut: &[usize], q: Vector3<f64>, tension: &[f64]) -> Option<Rest> {
        if tension.iter().any(|tension| *tension <= 1e-9 * self.force) {
            return None;
        }
        let geometries: Vec<LineGeometry> = (0..self.lines.len())
            .map(|line| self.geometry(line, &q))
            .collect();
        let slack = geometries
            .iter()
            .zip(self.lines)
            .map(|(geometry, line)| line.length_m - geometry.distance);
        let slack_m: Vec<f64> = slack.collect();
        let outside = |line: usize| !taut.contains(&line) && slack_m[line] < -1e-9 * self.length;
        if (0..self.lines.len()).any(outside) {
            return None;
        }
        let mut whole = self.body.stiffness;
        let mut tension_n = vec![0.0; self.lines.len()];
        let mut rows = DMatrix::zeros(taut.len(), 3);
        for (k, (line, tension)) in taut.iter().zip(tension).enumerate() {
            tension_n[*line] = *tension;
            whole += geometries[*line].second_derivative() * *tension;
            rows.row_mut(k).copy_from(&geometries[*line].row());
        }
        let motions = null_space(&rows);
        let stiffness = reduced(&whole, &motions);
        let least = SINGULAR * self.force / self.length;
        // Three lines may leave no motion, and a matrix without entries has no eigenvalues.
        let soft = |value: &f64| *value <= least;
        if !stiffness.is_empty() && stiffness.clone().symmetric_eigenvalues().iter().any(soft) {
            return None;
        }
        Some(Rest {
            q,
            taut: taut.to_vec(),
            tension_n,
            slack_m,
            motions,
            stiffness,
            whole,
        })
    }
}

/// An orthonormal basis of the vectors that are orthogonal to all rows: the axes, orthogonalised
/// against the rows by Gram and Schmidt's procedure, beginning with the one of which most is left.
fn null_space(rows: &DMatrix<f64>) -> DMatrix<f64> {
    let mut known: Vec<DVector<f64>> = Vec::new();
    let left = |vector: DVector<f64>, known: &[DVector<f64>]| {
        // Two passes give orthogonality to rounding.
        let once = |vector: DVector<f64>| {
            known
                .iter()
                .fold(vector, |left, one| &left - one * one.dot(&left))
        };
        once(once(vector))
    };
    for row in rows.row_iter() {
        let vector = left(row.transpose(), &known);
        if vector.norm() > 1e-9 * row.norm() {
            known.push(vector.normalize());
        }
    }
    let held = known.len();
    let axis = |i: usize| DVector::from_fn(3, |k, _| if k == i { 1.0 } else { 0.0 });
    while known.len() < 3 {
        let vectors = (0..3).map(|i| left(axis(i), &known));
        let longest = vectors.max_by(|a, b| a.norm().total_cmp(&b.norm()));
        match longest {
            Some(vector) => known.push(vector.normalize()),
            None => break,
        }
    }
    DMatrix::from_fn(3, 3 - held, |i, k| known[held + k][i])
}

impl Rest {
    /// Natural motions about this position with the taut lines taut: without damping from A(ω) of
    /// the file, NᵀHN − ω² Nᵀ(M + A(ω))N, and with the memory's damping.
    ///
    /// # Errors
    /// [`HydroError::Impossible`] if mass and added mass are not positive definite.
    pub fn natural(
        &self,
        hydro: &Hydrodynamics,
        body: &Body,
        memory: &Memory,
        added_mass_inf: &Matrix3<f64>,
    ) -> Result<(Vec<Natural>, Vec<Mode>), HydroError> {
        if self.motions.ncols() == 0 {
            return Ok((Vec::new(), Vec::new()));
        }
        let found = natural(hydro, &body.mass, &self.whole, &self.motions)?;
        let damped = Damped {
            body,
            stiffness: &self.whole,
            memory,
            added_mass_inf,
            basis: &self.motions,
        };
        let modes = damped.modes(&found)?;
        Ok((found, modes))
    }
}
