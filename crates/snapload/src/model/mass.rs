//! The mass of a body, and the metric that it gives to the plane.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::real::Real;
use crate::model::cable::Normal;
use crate::model::state::State;

/// A matrix over (x, y, θ), row by row.
pub type Matrix3<T = f64> = [[T; 3]; 3];

/// The mass matrix M of a body over (x, y, θ), which includes the added mass of water.
///
/// Every constraint uses it: the inverse effective masses W = G M⁻¹ Gᵀ, impulses, and projections,
/// which make the least change in its metric. M does not turn with the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mass<T = f64> {
    /// Unit mass in both directions, and 1/I about the centre; 0 for a point mass.
    Unit { inverse_inertia: T },
    /// Any symmetric, positive definite matrix, and its inverse.
    Full {
        matrix: Matrix3<T>,
        inverse: Matrix3<T>,
    },
}

impl<T: Real> Mass<T> {
    /// None unless the matrix is symmetric and positive definite, or if its inverse, or a product
    /// on the way to it, overflows or is rounded to zero.
    pub(crate) fn full(matrix: Matrix3<T>) -> Option<Self> {
        let [[a, b, c], [d, e, f], [g, h, i]] = matrix;
        let minor = a * e - b * b;
        let cofactors = [e * i - f * f, c * f - b * i, b * f - c * e];
        let determinant = a * cofactors[0] + b * cofactors[1] + c * cofactors[2];
        let definite = a > T::ZERO && minor > T::ZERO && determinant > T::ZERO;
        if (b, c, f) != (d, g, h) || !definite {
            return None;
        }
        let [aa, ab, ac] = cofactors.map(|cofactor| cofactor / determinant);
        let (bb, bc) = ((a * i - c * c) / determinant, (b * c - a * f) / determinant);
        let inverse = [[aa, ab, ac], [ab, bb, bc], [ac, bc, minor / determinant]];
        let finite = inverse.iter().flatten().all(|entry| entry.is_finite());
        let known = finite && (0..3).all(|i| inverse[i][i] > T::ZERO);
        known.then_some(Self::Full { matrix, inverse })
    }

    /// The same in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Mass<U> {
        match self {
            Self::Unit { inverse_inertia } => Mass::Unit {
                inverse_inertia: number(*inverse_inertia),
            },
            // The inverse is computed again, with the precision of the other arithmetic.
            Self::Full { matrix, inverse } => {
                let matrix = matrix.map(|row| row.map(&number));
                Mass::full(matrix).unwrap_or(Mass::Full {
                    matrix,
                    inverse: inverse.map(|row| row.map(&number)),
                })
            }
        }
    }

    /// Whether it is the unit mass, for which flight has a closed form.
    pub(crate) fn is_unit(&self) -> bool {
        matches!(self, Self::Unit { .. })
    }

    /// M⁻¹_θθ: 1/I.
    #[inline(always)]
    pub(crate) fn inverse_inertia(&self) -> T {
        match self {
            Self::Unit { inverse_inertia } => *inverse_inertia,
            Self::Full { inverse, .. } => inverse[2][2],
        }
    }

    /// M_θθ: I; 0 for a point mass, whose rotation carries no energy.
    pub(crate) fn inertia(&self) -> T {
        match self {
            Self::Unit { inverse_inertia } if *inverse_inertia > T::ZERO => {
                T::ONE / *inverse_inertia
            }
            Self::Unit { .. } => T::ZERO,
            Self::Full { matrix, .. } => matrix[2][2],
        }
    }

    /// A bound on W_ii of a cable whose fairlead is at this squared distance from the centre.
    pub(crate) fn largest_coupling(&self, reach_squared: T) -> T {
        match self {
            Self::Unit { inverse_inertia } => T::ONE + reach_squared * *inverse_inertia,
            Self::Full { inverse, .. } => {
                let [[xx, ..], [_, yy, _], [_, _, turn]] = *inverse;
                // (u + w)ᵀA(u + w) ≤ 2 (uᵀAu + wᵀAw) with u = (n, 0) and w = (0, 0, s).
                (xx + yy + reach_squared * turn) * 2.0
            }
        }
    }

    /// W_ij = G_i M⁻¹ G_jᵀ; with itself the inverse effective mass of a cable.
    #[inline(always)]
    pub(crate) fn coupling(&self, one: &Normal<T>, other: &Normal<T>) -> T {
        match self {
            Self::Unit { inverse_inertia } => one.coupling(other, *inverse_inertia),
            Self::Full { inverse, .. } => {
                let [x, y, turn] = times(inverse, row(other));
                one.arm.mul_add(turn, one.n.y.mul_add(y, one.n.x * x))
            }
        }
    }

    /// M⁻¹ times a generalised force or impulse.
    #[inline(always)]
    pub(crate) fn moved_by(&self, force: [T; 3]) -> [T; 3] {
        match self {
            Self::Unit { inverse_inertia } => [force[0], force[1], force[2] * *inverse_inertia],
            Self::Full { inverse, .. } => times(inverse, force),
        }
    }

    /// A change of velocity, position or acceleration minus M⁻¹ Gᵀ p of one cable; for a unit mass
    /// (ẋ, ẏ) − p n and θ̇ − p s/I.
    #[inline(always)]
    pub(crate) fn less(&self, [x, y, turn]: [T; 3], normal: &Normal<T>, p: T) -> [T; 3] {
        match self {
            // Not fused, so that the impulses of two cables that mirror each other cancel to the
            // last bit.
            Self::Unit { inverse_inertia } => [
                x - p * normal.n.x,
                y - p * normal.n.y,
                turn - p * normal.arm * *inverse_inertia,
            ],
            Self::Full { inverse, .. } => {
                let [by_x, by_y, by_turn] = times(inverse, row(normal));
                [x - p * by_x, y - p * by_y, turn - p * by_turn]
            }
        }
    }

    /// The state after an impulse p in a cable (docs/model.md section 5).
    #[inline(always)]
    pub(crate) fn apply_impulse(&self, normal: &Normal<T>, state: &mut State<T>, p: T) {
        let velocity = [state.vx, state.vy, state.vtheta];
        [state.vx, state.vy, state.vtheta] = self.less(velocity, normal, p);
    }

    /// The same for the position: moves the body against the normal in the metric of M.
    #[inline(always)]
    pub(crate) fn displace(&self, normal: &Normal<T>, state: &mut State<T>, distance: T) {
        let place = [state.x, state.y, state.theta];
        [state.x, state.y, state.theta] = self.less(place, normal, distance);
    }

    /// The entry of a moment in a load vector: the moment itself, or for a unit mass, whose load is
    /// the acceleration, the moment divided by I.
    #[inline(always)]
    pub(crate) fn load_of_moment(&self, moment: T) -> T {
        match self {
            Self::Unit { inverse_inertia } => moment * *inverse_inertia,
            Self::Full { .. } => moment,
        }
    }

    /// The entry in a load vector of a moment that is given for unit moment of inertia.
    #[inline(always)]
    pub(crate) fn load_of_turning(&self, turning: T) -> T {
        match self {
            Self::Unit { .. } => turning,
            Self::Full { matrix, .. } => turning * matrix[2][2],
        }
    }

    /// A load minus the forces and the moment of cables.
    #[inline(always)]
    pub(crate) fn less_pull(&self, load: [T; 3], pull: [T; 3]) -> [T; 3] {
        let [x, y, moment] = pull;
        match self {
            Self::Unit { inverse_inertia } => less_pull_of_unit_mass(load, pull, *inverse_inertia),
            Self::Full { .. } => [load[0] - x, load[1] - y, load[2] - moment],
        }
    }

    /// (ẍ, ÿ, θ̈) under a load.
    #[inline(always)]
    pub(crate) fn accelerated_by(&self, load: [T; 3]) -> [T; 3] {
        match self {
            Self::Unit { .. } => load,
            Self::Full { inverse, .. } => times(inverse, load),
        }
    }

    /// An acceleration minus that due to the forces and the moment of cables.
    #[inline(always)]
    pub(crate) fn slowed_by(&self, acceleration: [T; 3], pull: [T; 3]) -> [T; 3] {
        match self {
            Self::Unit { .. } => self.less_pull(acceleration, pull),
            Self::Full { inverse, .. } => {
                let [x, y, turn] = times(inverse, pull);
                [
                    acceleration[0] - x,
                    acceleration[1] - y,
                    acceleration[2] - turn,
                ]
            }
        }
    }

    /// M q̇; for a point mass without angular momentum.
    pub(crate) fn momentum(&self, velocity: [T; 3]) -> [T; 3] {
        match self {
            Self::Unit { .. } => [velocity[0], velocity[1], self.inertia() * velocity[2]],
            Self::Full { matrix, .. } => times(matrix, velocity),
        }
    }

    /// q̇ᵀ M q̇ / 2.
    pub(crate) fn kinetic_energy(&self, state: &State<T>) -> T {
        match self {
            Self::Unit { .. } => {
                let translation = state.vx.squared() + state.vy.squared();
                let rotation = self.inertia() * state.vtheta.squared();
                (translation + rotation) * 0.5
            }
            Self::Full { .. } => {
                let velocity = [state.vx, state.vy, state.vtheta];
                dot(velocity, self.momentum(velocity)) * 0.5
            }
        }
    }
}

/// A matrix times a vector.
#[inline(always)]
pub(crate) fn times<T: Real>(matrix: &Matrix3<T>, v: [T; 3]) -> [T; 3] {
    let mut product = [T::ZERO; 3];
    for (entry, row) in product.iter_mut().zip(matrix) {
        *entry = dot(*row, v);
    }
    product
}

/// Σ a_i b_i.
#[inline(always)]
pub(crate) fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

/// G of one cable.
#[inline(always)]
fn row<T: Copy>(normal: &Normal<T>) -> [T; 3] {
    [normal.n.x, normal.n.y, normal.arm]
}

/// A load on a body of unit mass minus the forces and the moment of cables, and likewise an
/// acceleration minus what they cause, of one run or of several side by side.
#[inline(always)]
pub(crate) fn less_pull_of_unit_mass<L: Lane>(
    load: [L; 3],
    [x, y, moment]: [L; 3],
    inverse_inertia: L,
) -> [L; 3] {
    [load[0] - x, load[1] - y, load[2] - moment * inverse_inertia]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_matrix_has_its_inverse_and_is_checked() {
        let matrix = [[2.0, 0.3, -0.4], [0.3, 1.5, 0.2], [-0.4, 0.2, 0.7]];
        let mass = Mass::full(matrix).expect("it is positive definite");
        for i in 0..3 {
            let force = [0, 1, 2].map(|j| f64::from(u8::from(i == j)));
            let back = times(&matrix, mass.moved_by(force));
            for (back, force) in back.into_iter().zip(force) {
                assert!((back - force).abs() < 1e-15);
            }
        }
        let normal = Normal {
            n: [0.6, -0.8].into(),
            arm: 0.3,
        };
        let w = mass.coupling(&normal, &normal);
        assert!((w - dot(row(&normal), mass.moved_by(row(&normal)))).abs() < 1e-15);
        assert!(w <= mass.largest_coupling(0.09));
        // The determinant of the first is infinite, and its inverse would be zero; that of the
        // second is zero.
        for size in [1e103, 1e120, 1e-110] {
            let diagonal = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { size } else { 0.0 }));
            assert!(Mass::full(diagonal).is_none(), "{size}");
        }
        let mut lopsided = matrix;
        lopsided[0][1] = 0.31;
        let indefinite = [[1.0, 0.0, 2.0], [0.0, 1.0, 0.0], [2.0, 0.0, 1.0]];
        assert!(Mass::full(lopsided).is_none() && Mass::full(indefinite).is_none());
    }

    /// diag(1, 1, I) as a full matrix gives the results of the unit mass.
    #[test]
    fn the_unit_mass_is_a_case_of_the_full_matrix() {
        let inertia = 0.03;
        let unit = Mass::Unit {
            inverse_inertia: 1.0 / inertia,
        };
        let full = Mass::full([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, inertia]]);
        let full = full.expect("positive definite");
        let normal = Normal {
            n: [0.6, -0.8].into(),
            arm: 0.2,
        };
        let other = Normal {
            n: [-0.28, 0.96].into(),
            arm: -0.1,
        };
        let state = State {
            vx: 0.3,
            vy: 0.1,
            vtheta: -2.0,
            ..State::default()
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
        close(
            unit.coupling(&normal, &other),
            full.coupling(&normal, &other),
        );
        close(unit.kinetic_energy(&state), full.kinetic_energy(&state));
        close(unit.inertia(), full.inertia());
        let velocity = [state.vx, state.vy, state.vtheta];
        let momenta = [unit, full].map(|mass| mass.momentum(velocity));
        (0..3).for_each(|i| close(momenta[0][i], momenta[1][i]));
        let load = |mass: &Mass| {
            [
                0.4,
                -0.2,
                mass.load_of_turning(0.7) + mass.load_of_moment(0.05),
            ]
        };
        let pull = [0.1, 0.9, -0.02];
        let accelerations = [unit, full].map(|mass| {
            let less = mass.accelerated_by(mass.less_pull(load(&mass), pull));
            let slowed = mass.slowed_by(mass.accelerated_by(load(&mass)), pull);
            (0..3).for_each(|i| close(less[i], slowed[i]));
            mass.less(less, &normal, 0.4)
        });
        (0..3).for_each(|i| close(accelerations[0][i], accelerations[1][i]));
    }
}
