//! A moored body held by its cables, in x, y and θ alone: Newton's second law with multipliers for the
//! cables' gaps, from their definition. What the chapter derives is measured against it.

use super::verdict::{Claim, Finding, Verdict, claim};
use snapload::{Real, anchor_height};
use std::ops::{Add, Div, Mul, Sub};

/// A function of time with its first and second derivative at one moment, exact by the rules of
/// differentiation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) rate: f64,
    pub(super) second: f64,
}

impl Jet {
    pub(super) fn new(value: f64, rate: f64, second: f64) -> Self {
        Self {
            value,
            rate,
            second,
        }
    }

    pub(super) fn constant(value: f64) -> Self {
        Self::new(value, 0.0, 0.0)
    }

    /// f(self), where f has this value and these derivatives.
    fn through(self, value: f64, first: f64, second: f64) -> Self {
        Self::new(
            value,
            first * self.rate,
            second * self.rate * self.rate + first * self.second,
        )
    }

    pub(super) fn sin_cos(self) -> (Self, Self) {
        let (s, c) = Real::sin_cos(self.value);
        (self.through(s, c, -s), self.through(c, -s, -c))
    }

    pub(super) fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let first = 0.5 / root;
        self.through(root, first, -0.5 * first / self.value)
    }

    pub(super) fn square(self) -> Self {
        self * self
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(
            self.value + other.value,
            self.rate + other.rate,
            self.second + other.second,
        )
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.second * other.value + 2.0 * self.rate * other.rate + self.value * other.second,
        )
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let square = inverse * inverse;
        self * other.through(inverse, -square, 2.0 * square * inverse)
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(
            self.value * factor,
            self.rate * factor,
            self.second * factor,
        )
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, term: f64) -> Self {
        Self::new(self.value + term, self.rate, self.second)
    }
}

/// A cable, as one sees it in the chapter's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// Cable 1, of the gap g1.
    Right,
    /// Cable 2, of the gap g2.
    Left,
}

impl Side {
    pub(super) const BOTH: [Self; 2] = [Self::Right, Self::Left];

    /// The cable's index in the engine.
    pub(super) fn cable(self) -> usize {
        match self {
            Self::Right => 0,
            Self::Left => 1,
        }
    }

    /// The one of a cable's index.
    pub(super) fn of(cable: usize) -> Self {
        if cable == 0 { Self::Right } else { Self::Left }
    }

    /// x of its anchor; the fairlead lies on the same side.
    fn anchor(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }
}

/// Sizes of a body and its mooring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mooring {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) r: f64,
    pub(super) inertia: f64,
}

/// One body and its motion: place and velocity in x, y and θ, and the wave's force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub(super) mooring: Mooring,
    pub(super) place: [f64; 3],
    pub(super) velocity: [f64; 3],
    pub(super) force: [f64; 2],
}

/// What holds a body on taut cables: the multiplier of each gap, and the acceleration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held<const N: usize> {
    pub(super) lambda: [f64; N],
    pub(super) acceleration: [f64; 3],
}

impl Mooring {
    /// Height h of the anchors over the fairleads at rest.
    pub(super) fn h(&self) -> f64 {
        anchor_height(self.r, self.a)
    }

    /// Span from the anchor to the fairlead of a body at x, y, θ.
    fn span(&self, side: Side, [x, y, theta]: [Jet; 3]) -> [Jet; 2] {
        let (sine, cosine) = theta.sin_cos();
        let a = side.anchor() * self.a;
        [
            x + cosine * a - sine * self.b + -side.anchor(),
            y + sine * a + cosine * self.b + -(self.h() + self.b),
        ]
    }

    /// Gap |P − A|² − r².
    pub(super) fn gap(&self, side: Side, at: [Jet; 3]) -> Jet {
        let [x, y] = self.span(side, at);
        x.square() + y.square() + -self.r * self.r
    }

    /// The gap of a body that stands still.
    pub(super) fn gap_at(&self, side: Side, place: [f64; 3]) -> f64 {
        self.gap(side, place.map(Jet::constant)).value
    }
}

impl Moment {
    /// Force and weight over the mass, in x, y and θ.
    fn free(&self) -> [f64; 3] {
        [self.force[0], self.force[1] - 1.0, 0.0]
    }

    /// The place, moving on at these velocities without acceleration.
    pub(super) fn path(&self, velocity: [f64; 3]) -> [Jet; 3] {
        let [x, y, theta] = self.place;
        let [vx, vy, vtheta] = velocity;
        [
            Jet::new(x, vx, 0.0),
            Jet::new(y, vy, 0.0),
            Jet::new(theta, vtheta, 0.0),
        ]
    }

    /// Velocity of the fairlead.
    pub(super) fn fairlead_velocity(&self, side: Side) -> [f64; 2] {
        self.mooring
            .span(side, self.path(self.velocity))
            .map(|span| span.rate)
    }

    /// Gradient of a gap.
    pub(super) fn gradient(&self, side: Side) -> [f64; 3] {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|along| self.mooring.gap(side, self.path(along)).rate)
    }

    /// Product of two gradients in the inverse of the masses.
    fn product(&self, p: [f64; 3], q: [f64; 3]) -> f64 {
        p[0] * q[0] + p[1] * q[1] + p[2] * q[2] / self.mooring.inertia
    }

    /// g̈ of a gap if no cable pulled.
    pub(super) fn opening(&self, side: Side) -> f64 {
        let [g, free] = [self.gradient(side), self.free()];
        let bend = self.mooring.gap(side, self.path(self.velocity)).second;
        g[0] * free[0] + g[1] * free[1] + bend
    }

    /// How the pull of one cable changes the gap of another.
    pub(super) fn coupling(&self, p: Side, q: Side) -> f64 {
        self.product(self.gradient(p), self.gradient(q))
    }

    fn pulled(&self, pulls: impl IntoIterator<Item = (Side, f64)>) -> [f64; 3] {
        let mut sum = self.free();
        for (side, lambda) in pulls {
            let g = self.gradient(side);
            sum[0] += lambda * g[0];
            sum[1] += lambda * g[1];
            sum[2] += lambda * g[2] / self.mooring.inertia;
        }
        sum
    }

    /// Held by one cable: M q̈ = Q + λ grad g with g̈ = 0.
    pub(super) fn held(&self, side: Side) -> Held<1> {
        let lambda = -self.opening(side) / self.coupling(side, side);
        Held {
            lambda: [lambda],
            acceleration: self.pulled([(side, lambda)]),
        }
    }

    /// Held by both.
    pub(super) fn held_by_both(&self) -> Held<2> {
        let w = |p, q| self.coupling(p, q);
        let (right, left) = (Side::Right, Side::Left);
        let [c1, c2] = [self.opening(right), self.opening(left)];
        let [a, b, c] = [w(right, right), w(right, left), w(left, left)];
        let determinant = a * c - b * b;
        let lambda = [
            -(c * c1 - b * c2) / determinant,
            -(a * c2 - b * c1) / determinant,
        ];
        Held {
            lambda,
            acceleration: self.pulled(Side::BOTH.into_iter().zip(lambda)),
        }
    }
}

/// Numbers that look random and are the same everywhere (SplitMix64).
#[derive(Clone, Debug)]
pub(super) struct Numbers(u64);

impl Numbers {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Evenly from an interval.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let bits = (z ^ (z >> 31)) >> 11;
        low + (high - low) * (bits as f64 / (1_u64 << 53) as f64)
    }

    /// Nearly normal with this deviation: a sum of twelve even ones.
    pub(super) fn normal(&mut self, deviation: f64) -> f64 {
        (0..12).map(|_| self.between(-0.5, 0.5)).sum::<f64>() * deviation
    }
}

/// The largest size among residuals; infinite if one is no number.
pub(super) fn largest(residuals: impl IntoIterator<Item = f64>) -> f64 {
    residuals.into_iter().fold(0.0, |most: f64, r| {
        if r.is_nan() {
            f64::INFINITY
        } else {
            most.max(r.abs())
        }
    })
}

/// Residuals below this are rounding.
const ROUNDING: f64 = 1e-9;

/// Whether an identity with such residuals holds.
pub(super) fn holds(residual: f64) -> bool {
    residual < ROUNDING
}

/// The verdict on such an identity.
pub(super) fn verdict(residual: f64) -> Verdict {
    Verdict::of(holds(residual))
}

/// A claim that an equation holds, by the largest residual in so many states.
pub(super) fn identity(
    id: &'static str,
    text: &'static str,
    residual: f64,
    states: usize,
) -> Claim {
    let evidence = format!("largest residual {} in {states} states", words(residual));
    let finding = Finding::new(Verdict::of(holds(residual) && states > 0), evidence);
    claim(id, text, finding)
}

/// A residual in words: rounding by its decade, anything else as it is.
pub(super) fn words(residual: f64) -> String {
    if !holds(residual) {
        return format!("{residual:.2}");
    }
    let mut bound = 1e-9;
    let mut decade = 9;
    while decade < 16 && residual < bound / 10.0 {
        bound /= 10.0;
        decade += 1;
    }
    format!("below 1e-{decade}")
}
