//! The external forces on the body at one instant, which do not depend on its motion.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::real::Real;

/// The sums over all sinusoids at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Surroundings<T = f64> {
    /// The force f, including its constant part \[F\].
    pub force: Vector2<T>,
    /// The velocity w of the water at the body; zero where there is no drag \[L/T\].
    pub water: Vector2<T>,
    /// F_w + F_c of linear water; zero where the body does not float \[F, F, F L\].
    pub excitation: [T; 3],
}

impl<T: Real> Surroundings<T> {
    /// The same in another arithmetic.
    #[inline(always)]
    pub(crate) fn map<U>(&self, number: impl Fn(T) -> U + Copy) -> Surroundings<U> {
        Surroundings {
            force: self.force.map(number),
            water: self.water.map(number),
            excitation: self.excitation.map(number),
        }
    }
}
