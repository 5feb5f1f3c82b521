//! The body: its inertia and its outline.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::real::Real;
use crate::model::cable::Normal;
use crate::model::mass::{Mass, Matrix3};

/// The outline of the body, which only the upper bound depends on (docs/model.md section 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<T = f64> {
    /// A point.
    Point,
    /// A circle about the centre.
    Circle {
        /// Its radius \[L\].
        radius: T,
    },
    /// A rectangle about the centre.
    Rectangle {
        /// Half its width \[L\].
        half_width: T,
        /// Half its height \[L\].
        half_height: T,
    },
}

/// A rigid body of unit mass, or a point mass (docs/model.md section 2), or a body with any mass
/// matrix, such as one with added mass of water (docs/floating.md).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<T = f64> {
    pub(crate) shape: Shape<T>,
    pub(crate) mass: Mass<T>,
}

impl<T: Real> Body<T> {
    /// A rigid body with its moment of inertia about the centre, `inertia` > 0 \[m L²\].
    pub fn rigid(shape: Shape<T>, inertia: T) -> Self {
        Self {
            shape,
            mass: Mass::Unit {
                inverse_inertia: T::ONE / inertia,
            },
        }
    }

    /// A point mass. It has no rotation: 1/I = 0, so that no impulse ever turns it.
    pub fn point() -> Self {
        Self {
            shape: Shape::Point,
            mass: Mass::Unit {
                inverse_inertia: T::ZERO,
            },
        }
    }

    /// A rigid body with this mass matrix over (x, y, θ), in units in which the forces on it are
    /// given. None unless the matrix is symmetric and positive definite, and its inverse, with the
    /// products that lead to it, can be represented: of entries about 1 they always can.
    pub fn with_mass_matrix(shape: Shape<T>, matrix: Matrix3<T>) -> Option<Self> {
        Some(Self {
            shape,
            mass: Mass::full(matrix)?,
        })
    }

    /// The same body in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U) -> Body<U> {
        let shape = match self.shape {
            Shape::Point => Shape::Point,
            Shape::Circle { radius } => Shape::Circle {
                radius: number(radius),
            },
            Shape::Rectangle {
                half_width,
                half_height,
            } => Shape::Rectangle {
                half_width: number(half_width),
                half_height: number(half_height),
            },
        };
        Body {
            shape,
            mass: self.mass.map(&number),
        }
    }

    /// The outline.
    pub fn shape(&self) -> Shape<T> {
        self.shape
    }

    /// 1/I; 0 for a point mass. With a mass matrix M it is the entry of M⁻¹.
    pub fn inverse_inertia(&self) -> T {
        self.mass.inverse_inertia()
    }

    /// I; 0 for a point mass, whose rotation carries no energy.
    pub fn inertia(&self) -> T {
        self.mass.inertia()
    }

    /// W = G M⁻¹ Gᵀ of a cable, the inverse of its effective mass: 1 + s²/I for a unit mass.
    pub fn inverse_effective_mass(&self, normal: &Normal<T>) -> T {
        self.mass.coupling(normal, normal)
    }

    /// A bound on W of any cable with this moment arm, in whatever direction. For a unit mass it is
    /// the largest W; with a mass matrix it may be several times that.
    pub fn largest_inverse_effective_mass(&self, arm: T) -> T {
        self.mass.largest_coupling(arm.squared())
    }

    /// (ẍ, ÿ, θ̈) under a force (f_x, f_y) and a moment: M⁻¹ times these.
    pub fn moved_by(&self, force: [T; 3]) -> [T; 3] {
        self.mass.moved_by(force)
    }

    /// The points of the outline, in the body's frame, one of which is the highest at any rotation,
    /// and the radius of the disc about each.
    pub fn outline(&self) -> (Outline<T>, T) {
        let outline = match self.shape {
            Shape::Point | Shape::Circle { .. } => Outline::centre(),
            Shape::Rectangle {
                half_width: a,
                half_height: b,
            } => Outline {
                points: [[a, b], [-a, b], [-a, -b], [a, -b]].map(Vector2::from),
                count: 4,
            },
        };
        (outline, self.disc_radius())
    }

    /// The sizes of the outline, by name.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = (&'static str, T)> {
        let sizes = match self.shape {
            Shape::Point => [None; 2],
            Shape::Circle { radius } => [Some(("radius", radius)), None],
            Shape::Rectangle {
                half_width,
                half_height,
            } => [
                Some(("half_width", half_width)),
                Some(("half_height", half_height)),
            ],
        };
        sizes.into_iter().flatten()
    }

    /// The radius of the disc about each point of the outline.
    pub(crate) fn disc_radius(&self) -> T {
        match self.shape {
            Shape::Circle { radius } => radius,
            Shape::Point | Shape::Rectangle { .. } => T::ZERO,
        }
    }

    /// The largest distance of the outline from the centre.
    pub(crate) fn reach(&self) -> T {
        let (outline, radius) = self.outline();
        outline
            .points()
            .iter()
            .fold(T::ZERO, |reach, point| reach.max(point.length()))
            + radius
    }

    /// Height of the highest point above the centre, at the rotation with this sine and cosine.
    pub fn top(&self, sine: T, cosine: T) -> T {
        match self.shape {
            Shape::Point => T::ZERO,
            Shape::Circle { radius } => radius,
            Shape::Rectangle {
                half_width,
                half_height,
            } => (half_width * sine).abs() + (half_height * cosine).abs(),
        }
    }
}

/// At most four points of a body.
#[derive(Clone, Copy, Debug)]
pub struct Outline<T> {
    points: [Vector2<T>; 4],
    count: usize,
}

impl<T: Real> Outline<T> {
    fn centre() -> Self {
        Self {
            points: [Vector2::ZERO; 4],
            count: 1,
        }
    }

    /// The points.
    pub fn points(&self) -> &[Vector2<T>] {
        &self.points[..self.count]
    }
}
