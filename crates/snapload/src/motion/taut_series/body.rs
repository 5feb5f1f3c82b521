//! The Taylor series of a body's position and rotation, of one run or of several side by side.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::polynomial::Polynomial;
use crate::arithmetic::processor::apart;
use crate::arithmetic::vector_series::VectorSeries;
use crate::model::state::State;

/// The series of x, y and θ, and of what follows from θ.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodySeries<L> {
    pub(super) x: Polynomial<L>,
    pub(super) y: Polynomial<L>,
    pub(super) theta: Polynomial<L>,
    /// cos θ and sin θ.
    pub(super) circle: VectorSeries<L, 2>,
    /// k θ_k.
    pub(super) spin: VectorSeries<L, 1>,
}

impl<L: Lane> Default for BodySeries<L> {
    fn default() -> Self {
        Self {
            x: Polynomial::default(),
            y: Polynomial::default(),
            theta: Polynomial::default(),
            circle: VectorSeries::default(),
            spin: VectorSeries::default(),
        }
    }
}

impl<L: Lane> BodySeries<L> {
    /// Begins new series.
    #[inline(always)]
    pub(super) fn begin(&mut self, start: &State<L>) {
        (self.x[0], self.x[1]) = (start.x, start.vx);
        (self.y[0], self.y[1]) = (start.y, start.vy);
        self.clear();
        self.turn(0, start.theta);
        self.turn(1, start.vtheta);
        let (sine, cosine) = start.theta.sin_cos();
        self.circle[0] = [cosine, sine];
        let [sine, cosine] = self.rotation(1);
        self.circle[1] = [cosine, sine];
    }

    /// Removes the coefficients that are summed before they are known.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.circle.clear();
        self.spin.clear();
    }

    /// The series of x, y and θ.
    #[inline(always)]
    pub(super) fn place(&self) -> [&Polynomial<L>; 3] {
        [&self.x, &self.y, &self.theta]
    }

    /// Sets the k-th coefficient of θ.
    #[inline(always)]
    fn turn(&mut self, k: usize, theta: L) {
        self.theta[k] = theta;
        self.spin[k] = [theta * k as f64];
    }

    /// Coefficients of order k of sin θ and cos θ: k S_k = Σ j θ_j C_{k−j}, k C_k = −Σ j θ_j
    /// S_{k−j}.
    #[inline(always)]
    fn rotation(&self, k: usize) -> [L; 2] {
        apart!(L, {
            let [sine, cosine] = self.spin.convolve(&self.circle, k);
            let share = L::ONE / L::from_f64(k as f64);
            [sine * share, -(cosine * share)]
        })
    }

    /// The part of the same coefficients that follows from the lower orders of θ.
    #[inline(always)]
    pub(super) fn known_rotation(&mut self, k: usize) -> [L; 2] {
        self.turn(k, L::ZERO);
        self.rotation(k)
    }

    /// The coefficients of order k + 2 of the motion from those of order k of (ẍ, ÿ, θ̈), and the
    /// [`BodySeries::known_rotation`].
    #[inline(always)]
    pub(super) fn extend(&mut self, k: usize, acceleration: [L; 3], [sine, cosine]: [L; 2]) {
        let share = L::ONE / L::from_f64(((k + 1) * (k + 2)) as f64);
        let [x, y, theta] = acceleration;
        (self.x[k + 2], self.y[k + 2]) = (x * share, y * share);
        let theta = theta * share;
        self.turn(k + 2, theta);
        let [cosine_0, sine_0] = self.circle[0];
        self.circle[k + 2] = [cosine - theta * sine_0, sine + theta * cosine_0];
    }
}
