//! The derivatives of the acceleration with some cables taut: by force, and by the state.

use crate::arithmetic::plane::{Rotation, Vector2};
use crate::model::cable::Normal;
use crate::model::mass::{Mass, Matrix3};
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, TautSet};
use crate::motion::complementarity::solve;

/// The change of (ẍ, ÿ, θ̈) per force (f_x, f_y) and moment, by columns, with the cables of `taut`
/// taut: M⁻¹ (1 − Gᵀ W⁻¹ G M⁻¹).
#[inline(always)]
pub(crate) fn response_to_force(system: &System, state: &State, taut: TautSet) -> Matrix3 {
    let (normals, mass) = (system.normals(state, taut), &system.body.mass);
    let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
    let mut response = [[0.0; 3]; 3];
    for j in 0..3 {
        let mut force = [0.0; 3];
        force[j] = 1.0;
        let free = mass.moved_by(force);
        let mut load = [0.0; MAX_CABLES];
        for cable in taut.iter() {
            load[cable] = along(&normals[cable], &free);
        }
        let tension = solve(taut, w, &load);
        let held = taut.iter().fold(free, |held, cable| {
            mass.less(held, &normals[cable], tension[cable])
        });
        for (row, entry) in response.iter_mut().zip(held) {
            row[j] = entry;
        }
    }
    response
}

/// The data of a taut cable for the derivatives of the acceleration.
struct TautCable {
    normal: Normal,
    lever: Vector2,
    /// Ṗ.
    velocity: Vector2,
    per_length: f64,
}

impl TautCable {
    #[inline(always)]
    fn new(system: &System, state: &State, cable: usize) -> Self {
        let tether = &system.cables[cable];
        let turn = Rotation::by(state.theta);
        let lever = tether.lever(turn.sine, turn.cosine);
        let span = tether.span_moved(tether.moved(state, &turn));
        Self {
            normal: tether.normal_along(span, lever),
            lever,
            velocity: state
                .velocity()
                .plus_scaled(lever.quarter_turn(), state.vtheta),
            per_length: tether.per_length(),
        }
    }

    /// b = n·f + |Ṗ|²/r − θ̇² n·ρ.
    #[inline(always)]
    fn load(&self, force: Vector2, spin: f64) -> f64 {
        let Normal { n, .. } = self.normal;
        n.dot(force) + self.velocity.dot(self.velocity) * self.per_length
            - spin * spin * n.dot(self.lever)
    }

    /// δn and δs, and δb, for deviations of 1 in x, y and θ.
    #[inline(always)]
    fn changes_by_place(&self, force: Vector2, spin: f64) -> [(Normal, f64); 3] {
        let Self {
            normal: Normal { n, .. },
            lever,
            velocity,
            per_length,
        } = *self;
        let moved = |x: f64, y: f64| {
            let dn = Vector2 { x, y }.scaled(per_length);
            let arm = lever.cross(dn);
            let load = dn.dot(force) - spin * spin * dn.dot(lever);
            (Normal { n: dn, arm }, load)
        };
        let quarter = lever.quarter_turn();
        let dn = quarter.scaled(per_length);
        let arm = quarter.cross(n) + lever.cross(dn);
        let load = dn.dot(force)
            - 2.0 * per_length * spin * velocity.dot(lever)
            - spin * spin * (dn.dot(lever) + n.dot(quarter));
        let turned = (Normal { n: dn, arm }, load);
        [moved(1.0, 0.0), moved(0.0, 1.0), turned]
    }

    /// δb for deviations of 1 in ẋ, ẏ and θ̇, which do not change n and s.
    #[inline(always)]
    fn changes_by_velocity(&self, spin: f64) -> [f64; 3] {
        let Self {
            normal: Normal { n, .. },
            lever,
            velocity,
            per_length,
        } = *self;
        let by_velocity = velocity.scaled(2.0 * per_length);
        let by_spin = by_velocity.dot(lever.quarter_turn()) - 2.0 * spin * n.dot(lever);
        [by_velocity.x, by_velocity.y, by_spin]
    }
}

/// The derivatives of the [`acceleration`](crate::motion::active_set::acceleration) by (x, y, θ, ẋ,
/// ẏ, θ̇) with one or two independent taut cables, for a unit mass without drag and not afloat;
/// none otherwise. With a = f − p, p = M⁻¹ Gᵀ T and W T = b,
///
/// ```text
/// W δT = δb − δG p − G M⁻¹ δGᵀ T        δa = −M⁻¹ (δGᵀ T + Gᵀ δT)
/// ```
#[inline(always)]
pub(crate) fn slopes_of_acceleration(
    system: &System,
    around: &Surroundings,
    state: &State,
    taut: TautSet,
) -> Option<[[f64; 6]; 3]> {
    let mut cables = taut.iter();
    let first = cables.next()?;
    let second = cables.next();
    let Mass::Unit { inverse_inertia } = system.body.mass else {
        return None;
    };
    if system.drag.is_some() || system.floating.is_some() || cables.next().is_some() {
        return None;
    }
    let (force, spin) = (around.force, state.vtheta);
    // A single cable is treated as two, of which the second has no tension.
    let one = TautCable::new(system, state, first);
    let two = TautCable::new(system, state, second.unwrap_or(first));
    let pair = Pair::new(&one.normal, &two.normal, inverse_inertia, second.is_some())?;
    let tension = pair.solved([one.load(force, spin), two.load(force, spin)]);
    let both = [&one.normal, &two.normal];
    let pull = pair.acceleration_by_tensions(both, tension);
    let mut slopes = [[0.0; 6]; 3];
    let by_place = [&one, &two].map(|cable| cable.changes_by_place(force, spin));
    let by_velocity = [&one, &two].map(|cable| cable.changes_by_velocity(spin));
    for k in 0..3 {
        let [(dg, db), (dg_two, db_two)] = [by_place[0][k], by_place[1][k]];
        let turned = pair.acceleration_by_tensions([&dg, &dg_two], tension);
        let load = [
            db - along(&dg, &pull) - along(&one.normal, &turned),
            db_two - along(&dg_two, &pull) - along(&two.normal, &turned),
        ];
        let more = pair.acceleration_by_tensions(both, pair.solved(load));
        let load = [by_velocity[0][k], by_velocity[1][k]];
        let braked = pair.acceleration_by_tensions(both, pair.solved(load));
        for i in 0..3 {
            slopes[i][k] = -(turned[i] + more[i]);
            slopes[i][k + 3] = -braked[i];
        }
    }
    Some(slopes)
}

/// W of two cables, or of one alone.
struct Pair {
    inverse_inertia: f64,
    /// W_11, W_12 and W_22.
    w: [f64; 3],
    /// 1/W_11 for one cable, 1/det W for two.
    scale: f64,
    both: bool,
}

impl Pair {
    /// None if the two are dependent or nearly so.
    #[inline(always)]
    fn new(one: &Normal, two: &Normal, inverse_inertia: f64, both: bool) -> Option<Self> {
        /// Cables whose W is closer to singular than this are left to the general solver.
        const NEARLY_DEPENDENT: f64 = 1e-6;
        let w = [
            one.coupling(one, inverse_inertia),
            one.coupling(two, inverse_inertia),
            two.coupling(two, inverse_inertia),
        ];
        let determinant = w[0] * w[2] - w[1] * w[1];
        if both && determinant < NEARLY_DEPENDENT * w[0] * w[2] {
            return None;
        }
        Some(Self {
            inverse_inertia,
            w,
            scale: 1.0 / if both { determinant } else { w[0] },
            both,
        })
    }

    /// W⁻¹ b.
    #[inline(always)]
    fn solved(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let [one, across, two] = self.w;
        if self.both {
            [
                (two * a - across * b) * self.scale,
                (one * b - across * a) * self.scale,
            ]
        } else {
            [a * self.scale, 0.0]
        }
    }

    /// M⁻¹ Gᵀ T.
    #[inline(always)]
    fn acceleration_by_tensions(&self, [a, b]: [&Normal; 2], tension: [f64; 2]) -> [f64; 3] {
        [
            a.n.x * tension[0] + b.n.x * tension[1],
            a.n.y * tension[0] + b.n.y * tension[1],
            (a.arm * tension[0] + b.arm * tension[1]) * self.inverse_inertia,
        ]
    }
}

/// G p.
#[inline(always)]
fn along(normal: &Normal, [x, y, theta]: &[f64; 3]) -> f64 {
    normal.n.x * x + normal.n.y * y + normal.arm * theta
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::dual::Dual;
    use crate::model::body::{Body, Shape};
    use crate::model::forcing::Harmonic;
    use crate::motion::active_set::acceleration;

    /// The acceleration over dual numbers against the explicit derivatives: for a rigid body and a
    /// point mass, on either cable and on both.
    #[test]
    fn slopes_are_those_of_the_acceleration() {
        let bodies = [
            (
                Body::rigid(Shape::of_half_sizes(0.2, 0.1), 0.03),
                [0.2, 0.1],
            ),
            (Body::point(), [0.0, 0.0]),
        ];
        let mut compared = 0;
        for (body, fairlead) in bodies {
            let wave = Harmonic::ellipse(0.3, 0.5, 0.9);
            let system = System::moored_breakwater(body, fairlead, 1.5, 0.7, wave);
            let over = system.map(Dual::<f64, 6>::constant);
            let point = system.body.inverse_inertia() == 0.0;
            let turn = if point { 0.0 } else { 1.0 };
            let state = State {
                x: 0.05,
                y: -0.02,
                theta: 0.4 * turn,
                vx: 0.3,
                vy: -0.5,
                vtheta: 0.7 * turn,
            };
            let mut i = 0;
            let variables = State::from_components(state.components().map(|component| {
                i += 1;
                Dual::variable(component, i - 1)
            }));
            for taut in [TautSet::only(0), TautSet::only(1), TautSet::only(0).with(1)] {
                let still = [Dual::constant(0.0); 3];
                let around = system.surroundings(0.3);
                let dual = around.map(Dual::constant);
                let dual = acceleration(&over, &dual, &variables, still, taut);
                let slopes = slopes_of_acceleration(&system, &around, &state, taut);
                let slopes = slopes.expect("two cables that are independent");
                for (written, law) in slopes.iter().zip(dual) {
                    for (ours, theirs) in written.iter().zip(law.slope) {
                        assert!((ours - theirs).abs() < 1e-13, "{ours} {theirs}");
                        compared += 1;
                    }
                }
            }
        }
        assert_eq!(compared, 2 * 3 * 18);
    }
}
