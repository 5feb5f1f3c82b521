//! The position and velocity of the body.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::real::Real;

/// Position and velocity of the body in the thesis's axes, which are upside down: y points to the
/// anchors at the sea floor, the net buoyancy pulls towards −y, θ turns counter-clockwise.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct State<T = f64> {
    /// Centre, horizontal \[L\].
    pub x: T,
    /// Centre, vertical \[L\].
    pub y: T,
    /// Rotation \[rad\].
    pub theta: T,
    /// Velocity of the centre, horizontal \[L/T\].
    pub vx: T,
    /// Velocity of the centre, vertical \[L/T\].
    pub vy: T,
    /// Angular velocity \[rad/T\].
    pub vtheta: T,
}

impl<T> State<T> {
    /// x, y, θ, ẋ, ẏ, θ̇.
    pub fn components(self) -> [T; 6] {
        [self.x, self.y, self.theta, self.vx, self.vy, self.vtheta]
    }

    /// From its components, in the same order.
    pub fn from_components([x, y, theta, vx, vy, vtheta]: [T; 6]) -> Self {
        Self {
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
        }
    }
}

impl<T: Real> State<T> {
    /// Whether all components are finite.
    #[inline(always)]
    pub(crate) fn is_finite(&self) -> bool {
        self.components().into_iter().all(T::is_finite)
    }
}

impl<T: Copy> State<T> {
    /// The centre (x, y).
    #[inline(always)]
    pub fn centre(&self) -> Vector2<T> {
        [self.x, self.y].into()
    }

    /// The velocity (ẋ, ẏ) of the centre.
    #[inline(always)]
    pub fn velocity(&self) -> Vector2<T> {
        [self.vx, self.vy].into()
    }

    /// A function of each number and the other state's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &State<M>,
        number: impl Fn(T, M) -> U,
    ) -> State<U> {
        State {
            x: number(self.x, other.x),
            y: number(self.y, other.y),
            theta: number(self.theta, other.theta),
            vx: number(self.vx, other.vx),
            vy: number(self.vy, other.vy),
            vtheta: number(self.vtheta, other.vtheta),
        }
    }
}
