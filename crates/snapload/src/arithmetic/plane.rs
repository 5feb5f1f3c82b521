//! Vectors in the plane, and rotations: no other file assumes a plane motion.

use crate::arithmetic::lane::Lane;
use std::ops::{Add, Sub};

/// A vector of the plane.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Vector2<T = f64> {
    /// Its horizontal component.
    pub x: T,
    /// Its vertical component.
    pub y: T,
}

impl<T> From<[T; 2]> for Vector2<T> {
    #[inline(always)]
    fn from([x, y]: [T; 2]) -> Self {
        Self { x, y }
    }
}

impl<T> From<Vector2<T>> for [T; 2] {
    #[inline(always)]
    fn from(vector: Vector2<T>) -> Self {
        vector.components()
    }
}

impl<T> Vector2<T> {
    /// x and y.
    #[inline(always)]
    pub fn components(self) -> [T; 2] {
        [self.x, self.y]
    }

    /// A function of each component.
    #[inline(always)]
    pub fn map<U>(self, number: impl Fn(T) -> U) -> Vector2<U> {
        Vector2 {
            x: number(self.x),
            y: number(self.y),
        }
    }

    /// A function of each component and the other vector's.
    #[inline(always)]
    pub(crate) fn zip_with<M, U>(
        self,
        other: Vector2<M>,
        number: impl Fn(T, M) -> U,
    ) -> Vector2<U> {
        Vector2 {
            x: number(self.x, other.x),
            y: number(self.y, other.y),
        }
    }
}

impl<L: Lane> Add for Vector2<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
        }
    }
}

impl<L: Lane> Sub for Vector2<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
        }
    }
}

impl<L: Lane> Vector2<L> {
    /// The zero vector.
    pub(crate) const ZERO: Self = Self {
        x: L::ZERO,
        y: L::ZERO,
    };

    /// a·b = a_x b_x + a_y b_y.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x.mul_add(other.x, self.y * other.y)
    }

    /// a × b = a_x b_y − a_y b_x.
    #[inline(always)]
    pub fn cross(self, other: Self) -> L {
        self.x.mul_add(other.y, -(self.y * other.x))
    }

    /// |a|.
    #[inline(always)]
    pub fn length(self) -> L {
        self.dot(self).sqrt()
    }

    /// A bound on |a|, at most an eighth above it: the larger component and half of the smaller, as
    /// (x + y/2)² ≥ x² + y² for 0 ≤ y ≤ x.
    #[inline(always)]
    pub(crate) fn length_bound(self) -> L {
        let (x, y) = (self.x.abs(), self.y.abs());
        x.smaller(y).mul_add(L::from_f64(0.5), x.larger(y))
    }

    /// The vector turned by a quarter, counter-clockwise: the velocity of a point at `self` on a
    /// body that turns at unit rate.
    #[inline(always)]
    pub(crate) fn quarter_turn(self) -> Self {
        Self {
            x: -self.y,
            y: self.x,
        }
    }

    /// k a.
    #[inline(always)]
    pub(crate) fn scaled(self, k: L) -> Self {
        Self {
            x: self.x * k,
            y: self.y * k,
        }
    }

    /// a + k b.
    #[inline(always)]
    pub(crate) fn plus_scaled(self, other: Self, k: L) -> Self {
        Self {
            x: other.x.mul_add(k, self.x),
            y: other.y.mul_add(k, self.y),
        }
    }

    /// p u + q v.
    #[inline(always)]
    pub(crate) fn combined(p: L, u: Self, q: L, v: Self) -> Self {
        v.scaled(q).plus_scaled(u, p)
    }

    /// One of two, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            x: L::select(mask, yes.x, no.x),
            y: L::select(mask, yes.y, no.y),
        }
    }
}

/// A rotation by an angle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rotation<L> {
    pub(crate) sine: L,
    pub(crate) cosine: L,
    /// 1 − cos, without cancellation.
    pub(crate) versine: L,
    /// The angle less its sine, without cancellation.
    pub(crate) angle_minus_sine: L,
}

impl<L: Lane> Rotation<L> {
    #[inline(always)]
    pub(crate) fn by(angle: L) -> Self {
        let (even, odd) = angle.versines();
        let square = angle * angle;
        let (versine, angle_minus_sine) = (square * even, square * odd);
        Self {
            sine: angle - angle_minus_sine,
            cosine: L::ONE - versine,
            versine,
            angle_minus_sine,
        }
    }
}

impl<L: Copy> Rotation<L> {
    /// A function of each number and the other rotation's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &Rotation<M>,
        number: impl Fn(L, M) -> U,
    ) -> Rotation<U> {
        Rotation {
            sine: number(self.sine, other.sine),
            cosine: number(self.cosine, other.cosine),
            versine: number(self.versine, other.versine),
            angle_minus_sine: number(self.angle_minus_sine, other.angle_minus_sine),
        }
    }
}
