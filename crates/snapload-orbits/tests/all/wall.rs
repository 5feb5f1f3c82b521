//! ẍ + 2ζẋ + x = F cos Ωt with a wall at x ≤ s: x and ẋ are the first and the fourth component.

use snapload::{PerCable, Real, TautSet};
use snapload_orbits::{Family, Hybrid, Jet, PARAMETER, Point, Simulated};

pub struct Wall {
    pub zeta: f64,
    pub omega: f64,
    pub place: f64,
    pub restitution: f64,
}

/// The same, generic over the number type, with the amplitude of its force.
pub struct WallOver<T> {
    zeta: T,
    omega: T,
    place: T,
    restitution: T,
    force: T,
}

/// e^x by its series, for |x| up to some tens.
fn exp<T: Real>(x: T) -> T {
    let part = x * (1.0 / 1024.0);
    let mut sum = T::ONE;
    for k in (1..12).rev() {
        sum = T::ONE + part * sum / f64::from(k);
    }
    (0..10).fold(sum, |power, _| power * power)
}

impl<T: Real> WallOver<T> {
    /// The forced motion and its velocity: (c cos Ωt + d sin Ωt) with (1 − Ω²) c + 2ζΩ d = F,
    /// −2ζΩ c + (1 − Ω²) d = 0.
    fn forced(&self, t: T) -> [T; 2] {
        let (a, b) = (
            T::ONE - self.omega * self.omega,
            self.zeta * self.omega * 2.0,
        );
        let size = self.force / (a * a + b * b);
        let (c, d) = (a * size, b * size);
        let (sine, cosine) = (self.omega * t).sin_cos();
        [c * cosine + d * sine, self.omega * (d * cosine - c * sine)]
    }
}

impl<T: Real> Hybrid<T> for WallOver<T> {
    fn surfaces(&self) -> TautSet {
        TautSet::only(0)
    }

    fn flow(&self, _: TautSet, t: T, z: &Point<T>, s: T) -> Point<T> {
        let [x0, v0] = self.forced(t);
        let (x, v) = (z[0] - x0, z[3] - v0);
        let own = (T::ONE - self.zeta * self.zeta).sqrt();
        let (sine, cosine) = (own * s).sin_cos();
        let fade = exp(-(self.zeta * s));
        let other = (v + self.zeta * x) / own;
        let free = fade * (x * cosine + other * sine);
        let rate = fade * (other * cosine - x * sine) * own - self.zeta * free;
        let [x1, v1] = self.forced(t + s);
        let zero = T::ZERO;
        [x1 + free, zero, zero, v1 + rate, zero, zero]
    }

    fn gap(&self, _: usize, z: &Point<T>) -> T {
        z[0] - self.place
    }

    fn speed(&self, _: usize, z: &Point<T>) -> T {
        z[3]
    }

    fn tension(&self, _: usize, _: TautSet, _: T, _: &Point<T>) -> T {
        T::ZERO
    }

    fn law(&self, _: TautSet, _: TautSet, z: &Point<T>) -> (Point<T>, PerCable<T>) {
        let mut after = *z;
        after[3] = -(self.restitution * z[3]);
        let mut impulse = [T::ZERO; 16];
        impulse[0] = z[3] - after[3];
        (after, impulse)
    }

    fn placed(&self, _: TautSet, _: TautSet, z: &Point<T>) -> Point<T> {
        *z
    }
}

impl Wall {
    fn over<T: Real>(&self, force: T) -> WallOver<T> {
        WallOver {
            zeta: T::from_f64(self.zeta),
            omega: T::from_f64(self.omega),
            place: T::from_f64(self.place),
            restitution: T::from_f64(self.restitution),
            force,
        }
    }
}

impl Family for Wall {
    type Plain = WallOver<f64>;
    type Jets = WallOver<Jet>;

    fn variables(&self) -> &'static [usize] {
        &[0, 3]
    }

    fn plain(&self, at: [f64; 2]) -> WallOver<f64> {
        self.over(at[0])
    }

    fn jets(&self, at: [f64; 2]) -> WallOver<Jet> {
        self.over(Jet::variable(at[0], PARAMETER))
    }

    fn forcing_period(&self, _: [f64; 2]) -> Jet {
        Jet::constant(std::f64::consts::TAU / self.omega)
    }

    fn contraction(&self, _: [f64; 2]) -> Option<f64> {
        Some(2.0 * self.zeta)
    }

    fn snap_contraction(&self, _: [f64; 2]) -> f64 {
        self.restitution * self.restitution
    }

    fn simulate(&self, _: [f64; 2], _: f64, _: &Point, _: f64) -> Option<Simulated> {
        None
    }
}
