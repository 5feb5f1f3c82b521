//! The law of impact: Newton-Moreau.

use crate::arithmetic::real::Real;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::complementarity::complementary;
use crate::motion::least_norm::least_norm;

/// A cable snapping taut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact<T = f64> {
    /// Time \[T\].
    pub t: T,
    /// The cable, by index from 0.
    pub cable: usize,
    /// Normal velocity just before, v_n⁻ ≥ 0 \[L/T\]; 0 where a taut cable only takes part in the
    /// impulse of another.
    pub v_n: T,
    /// Impulse in the cable \[m L/T\].
    pub impulse: T,
    /// Energy lost \[F L\].
    pub energy_lost: T,
    /// State just before.
    pub before: State<T>,
    /// State just after.
    pub after: State<T>,
}

/// The result of an impact: impulses, and normal velocities before and after, by cable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImpactResult<T> {
    pub(crate) impulse: PerCable<T>,
    pub(crate) pulling: TautSet,
    pub(crate) v_before: PerCable<T>,
    pub(crate) v_after: PerCable<T>,
    pub(crate) after: State<T>,
}

impl<T: Real> ImpactResult<T> {
    /// The impulse of a closed cable or, where it has none, its normal velocity after the impact,
    /// per impulse of the cable among `struck` that has the largest one.
    pub(crate) fn reaction(&self, cable: usize, struck: TautSet) -> T {
        let larger = |p: T, q: T| if q > p { q } else { p };
        let snap = struck.iter().map(|i| self.impulse[i]).fold(T::ZERO, larger);
        if self.pulling.contains(cable) {
            self.impulse[cable] / snap
        } else {
            self.v_after[cable] / snap
        }
    }

    /// Of one cable.
    pub(crate) fn of_one(
        cable: usize,
        [v_before, v_after]: [T; 2],
        impulse: T,
        after: State<T>,
    ) -> Self {
        let mut result = Self {
            impulse: [T::ZERO; MAX_CABLES],
            pulling: TautSet::only(cable),
            v_before: [T::ZERO; MAX_CABLES],
            v_after: [T::ZERO; MAX_CABLES],
            after,
        };
        result.impulse[cable] = impulse;
        result.v_before[cable] = v_before;
        result.v_after[cable] = v_after;
        result
    }
}

/// Impact of the closed cables, of which `taut` ones have no normal velocity (docs/model.md section
/// 5):
///
/// ```text
/// 0 ≤ p  ⟂  −(v⁺ + e max(v⁻, 0)) ≥ 0,    v⁺ = v⁻ − W p,    W = G M⁻¹ Gᵀ
/// ```
///
/// For one cable alone this is p = (1 + e) v_n / w. A taut cable stays taut if the impulse loads it
/// and goes slack if the impulse unloads it.
///
/// Where more cables have impulses than the body has degrees of freedom, the impulses are those of
/// least norm with the same effect.
///
/// A closed cable that opens takes no part, as it is in flight. Under the law as written it would
/// *gain* energy, p |v⁻|/2, whenever the impulse of another turns it round; here it snaps by itself
/// instead, at the same time. Source: Moreau, in *Nonsmooth Mechanics and Applications* (1988);
/// Brogliato, *Nonsmooth Mechanics*.
#[inline(always)]
pub(crate) fn impact<T: Real>(
    system: &System<T>,
    before: &State<T>,
    closed: TautSet,
    taut: TautSet,
) -> ImpactResult<T> {
    let contact = system.contact_law();
    let mass = &system.body.mass;
    let normals = system.normals(before, closed);
    let mut v_before = [T::ZERO; MAX_CABLES];
    let mut load = [T::ZERO; MAX_CABLES];
    for cable in closed.iter().filter(|&cable| !taut.contains(cable)) {
        let v = normals[cable].velocity(before);
        v_before[cable] = v;
        load[cable] = contact.load(v);
    }
    let w = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
    let held: TautSet = closed
        .iter()
        .filter(|&cable| v_before[cable] >= T::ZERO)
        .collect();
    let (fewest, _) = complementary(held, w, &load);
    let impulse = least_norm(held, w, &load, fewest);
    let pulling: TautSet = held
        .iter()
        .filter(|&cable| impulse[cable] > T::ZERO)
        .collect();

    let mut after = *before;
    let mut v_after = [T::ZERO; MAX_CABLES];
    for cable in pulling.iter() {
        mass.apply_impulse(&normals[cable], &mut after, impulse[cable]);
    }
    for cable in closed.iter() {
        v_after[cable] = if pulling.contains(cable) {
            contact.velocity_after(v_before[cable])
        } else {
            pulling
                .iter()
                .fold(v_before[cable], |v, j| v - w(cable, j) * impulse[j])
        };
    }
    ImpactResult {
        impulse,
        pulling,
        v_before,
        v_after,
        after,
    }
}

/// The derivatives of (ẋ, ẏ, θ̇) after the impact of a single closing cable by (x, y, θ, ẋ, ẏ, θ̇)
/// before it: of v⁺ = v − M⁻¹Gᵀ p with p = (1 + e) v_n/w, v_n = G v, w = G M⁻¹Gᵀ,
///
/// ```text
/// δp = (1 + e) (δv_n/w − v_n δw/w²),   δv⁺ = δv − M⁻¹(Gᵀ δp + δGᵀ p)
/// ```
#[inline(always)]
pub(crate) fn slope_of_impact_alone(
    system: &System,
    before: &State,
    cable: usize,
) -> [[f64; 6]; 3] {
    let mass = &system.body.mass;
    let (normal, slopes) = system.cables[cable].normal_and_slopes(before);
    let g = [normal.n.x, normal.n.y, normal.arm];
    let moved = mass.moved_by(g);
    let v_n = normal.velocity(before);
    let w = mass.coupling(&normal, &normal);
    let contact = system.contact_law();
    let gain = contact.impulse_per_velocity(w);
    let velocity = [before.vx, before.vy, before.vtheta];
    let mut rows = [[0.0; 6]; 3];
    for k in 0..3 {
        let dg = slopes.map(|slope| slope[k]);
        let dv_n: f64 = (0..3).map(|i| dg[i] * velocity[i]).sum();
        let dw: f64 = (0..3).map(|i| 2.0 * moved[i] * dg[i]).sum();
        let dp = contact.snap_slope([v_n, w], [dv_n, dw]);
        let kick = gain * v_n;
        let changed = mass.moved_by([0, 1, 2].map(|i| g[i] * dp + dg[i] * kick));
        for i in 0..3 {
            rows[i][k] = -changed[i];
            rows[i][3 + k] = f64::from(i == k) - moved[i] * gain * g[k];
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::dual::Dual;
    use crate::model::body::{Body, Shape};
    use crate::model::forcing::Harmonic;

    fn breakwater(e: f64) -> System {
        let a = 0.1;
        System::moored_breakwater(
            Body::rigid(Shape::of_half_sizes(a, 0.0), a * a),
            [a, 0.0],
            1.5,
            e,
            Harmonic::ellipse(0.0, 0.0, 0.0),
        )
    }

    #[test]
    fn single_impact_reverses_the_normal_velocity_and_loses_what_it_must() {
        let system = breakwater(0.7);
        let before = State {
            vx: 0.3,
            vy: -0.5,
            vtheta: 0.2,
            ..State::default()
        };
        let normal = system.cables[1].normal(&before);
        let v_n = normal.velocity(&before);
        let w = system.body.inverse_effective_mass(&normal);
        let result = impact(&system, &before, TautSet::only(1), TautSet::SLACK);
        assert!((result.impulse[1] - 1.7 * v_n / w).abs() < 1e-15);
        assert!((normal.velocity(&result.after) + 0.7 * v_n).abs() < 1e-15);
        let lost = system.energy(&before) - system.energy(&result.after);
        assert!((lost - (1.0 - 0.49) * v_n * v_n / (2.0 * w)).abs() < 1e-15);
        assert!((lost - result.impulse[1] * (v_n - 0.7 * v_n) / 2.0).abs() < 1e-15);
    }

    /// The law over dual numbers against its explicit derivatives.
    #[test]
    fn slopes_of_a_single_impact_are_those_of_the_law() {
        let system = breakwater(0.7);
        let before = State {
            x: 0.05,
            y: -0.02,
            theta: 0.4,
            vx: 0.3,
            vy: -0.5,
            vtheta: 0.2,
        };
        let over = system.map(Dual::<f64, 6>::constant);
        let mut i = 0;
        let variables = before.components().map(|component| {
            i += 1;
            Dual::variable(component, i - 1)
        });
        let variables = State::from_components(variables);
        let mut closing = 0;
        for cable in [0, 1] {
            let after = impact(&over, &variables, TautSet::only(cable), TautSet::SLACK).after;
            let written = slope_of_impact_alone(&system, &before, cable);
            if after == variables {
                continue;
            }
            closing += 1;
            for (row, velocity) in written.iter().zip([after.vx, after.vy, after.vtheta]) {
                for (ours, law) in row.iter().zip(velocity.slope) {
                    assert!((ours - law).abs() < 1e-14, "{ours} {law}");
                }
            }
        }
        assert!(closing > 0);
    }

    #[test]
    fn symmetric_double_impact_rebounds_vertically() {
        let system = breakwater(0.5);
        let before = State {
            vy: -0.4,
            ..State::default()
        };
        let both = TautSet::only(0).with(1);
        let result = impact(&system, &before, both, TautSet::SLACK);
        assert_eq!((result.after.vx, result.after.vtheta), (0.0, 0.0));
        assert!((result.after.vy - 0.2).abs() < 1e-15);
        assert_eq!(result.impulse[0], result.impulse[1]);
    }

    #[test]
    fn a_taut_cable_stays_taut_or_goes_slack_as_the_impulse_tells() {
        // At x = y = θ = 0 the coupling W_12 of the standard body decides for all impacts there.
        let system = breakwater(0.9);
        let at = State::default();
        let normals = system.normals(&at, system.all_cables());
        let coupling = system.body.mass.coupling(&normals[0], &normals[1]);
        let along = State {
            vx: normals[1].n.y,
            vy: -normals[1].n.x,
            ..at
        };
        let closing = normals[0].velocity(&along);
        let sign = closing.signum();
        let before = State {
            vx: sign * along.vx,
            vy: sign * along.vy,
            ..at
        };
        let result = impact(&system, &before, system.all_cables(), TautSet::only(1));
        assert!(result.impulse[0] > 0.0);
        assert_eq!(result.pulling.contains(1), coupling < 0.0);
        assert!(normals[1].velocity(&result.after) <= 1e-15);
    }
}
