//! A cable: its gap, its normal and its lever arm.

use crate::arithmetic::lane::Lane;
use crate::arithmetic::plane::{Rotation, Vector2};
use crate::arithmetic::processor::{Kernel, dispatch_over};
use crate::arithmetic::real::Real;
use crate::model::state::State;

/// An inextensible cable from a fixed anchor to a point of the body (docs/model.md section 2).
///
/// It is stored by its span at x = y = θ = 0 and its gap there, because the rounding error of a gap
/// that is computed as an increment from there is proportional to the body's displacement, not to
/// the square of the cable's length.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Cable<T = f64> {
    fairlead: Vector2<T>,
    length: T,
    /// 1/r.
    per_length: T,
    rest_span: Vector2<T>,
    rest_gap: T,
    rest_gap_error: T,
}

/// The constraint direction of a cable: the row (n_x, n_y, s) of the constraint matrix G. The gap
/// changes at ġ = 2 r v_n, with the normal velocity v_n = n·Ṗ = n_x ẋ + n_y ẏ + s θ̇.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Normal<T = f64> {
    /// Unit normal n = (P − A)/r.
    pub n: Vector2<T>,
    /// Moment arm s = ρ_x n_y − ρ_y n_x \[L\].
    pub arm: T,
}

impl<L: Lane> Normal<L> {
    /// Normal velocity v_n, positive while the gap closes.
    #[inline(always)]
    pub fn velocity(&self, state: &State<L>) -> L {
        self.arm.mul_add(state.vtheta, self.n.dot(state.velocity()))
    }

    /// W_ij = G_i M⁻¹ G_jᵀ of a unit mass; with itself the inverse effective mass w = 1 + s²/I.
    #[inline(always)]
    pub fn coupling(&self, other: &Self, inverse_inertia: L) -> L {
        (self.arm * other.arm).mul_add(inverse_inertia, self.n.dot(other.n))
    }

    /// The state of a unit mass after an impulse p in the cable: (ẋ, ẏ) −= p n, θ̇ −= p s/I
    /// (docs/model.md section 5).
    #[inline(always)]
    pub fn apply_impulse(&self, state: &mut State<L>, impulse: L, inverse_inertia: L) {
        // Not fused, so that the impulses of two cables that mirror each other cancel to the last
        // bit.
        state.vx = state.vx - impulse * self.n.x;
        state.vy = state.vy - impulse * self.n.y;
        state.vtheta = state.vtheta - impulse * self.arm * inverse_inertia;
    }
}

/// A cable of any length, as an elastic line sees it.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Stretch<T = f64> {
    /// Its direction d/|d| and moment arm: where the gap is zero, the normal of the constraint.
    pub normal: Normal<T>,
    /// Elongation δ = |d| − r, negative while slack \[L\].
    pub elongation: T,
}

/// The stretch of a cable at a state.
struct Stretching<'a, T>(&'a Cable<T>, &'a State<T>);

impl<T: Real> Kernel for Stretching<'_, T> {
    type Output = Stretch<T>;
    #[inline(always)]
    fn run(self) -> Stretch<T> {
        let Self(cable, state) = self;
        let turn = Rotation::by(state.theta);
        let moved = cable.moved(state, &turn);
        let span = cable.span_moved(moved);
        let reach = span.length();
        let n = span.map(|component| component / reach);
        Stretch {
            normal: Normal {
                n,
                arm: cable.lever(turn.sine, turn.cosine).cross(n),
            },
            elongation: cable.gap_moved(moved) / (reach + cable.length),
        }
    }
}

impl<T: Real> Cable<T> {
    /// A cable from `anchor` A to `fairlead` (in the body's frame), of length r > 0.
    pub fn new(anchor: impl Into<Vector2<T>>, fairlead: impl Into<Vector2<T>>, length: T) -> Self {
        let fairlead = fairlead.into();
        let rest_span = fairlead - anchor.into();
        Self {
            fairlead,
            length,
            per_length: T::ONE / length,
            rest_span,
            rest_gap: rest_span.dot(rest_span) - length.squared(),
            rest_gap_error: length.squared() * T::EPSILON * 4.0,
        }
    }

    /// A cable that is taut by construction where x = y = θ = 0: `rest_span`, which leads from the
    /// anchor to the fairlead there, has the length r up to rounding.
    pub fn taut_at_rest(
        rest_span: impl Into<Vector2<T>>,
        fairlead: impl Into<Vector2<T>>,
        length: T,
    ) -> Self {
        Self {
            fairlead: fairlead.into(),
            length,
            per_length: T::ONE / length,
            rest_span: rest_span.into(),
            rest_gap: T::ZERO,
            rest_gap_error: T::ZERO,
        }
    }

    /// The same cable in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Cable<U> {
        Cable {
            fairlead: self.fairlead.map(number),
            length: number(self.length),
            per_length: U::ONE / number(self.length),
            rest_span: self.rest_span.map(number),
            rest_gap: number(self.rest_gap),
            rest_gap_error: number(self.rest_gap_error),
        }
    }

    /// The span at x = y = θ = 0, if the cable is taut there by construction.
    pub(crate) fn span_taut_at_rest(&self) -> Option<Vector2<T>> {
        let by_construction = self.rest_gap == T::ZERO && self.rest_gap_error == T::ZERO;
        by_construction.then_some(self.rest_span)
    }

    /// Anchor A \[L\].
    pub fn anchor(&self) -> Vector2<T> {
        self.fairlead - self.rest_span
    }

    /// Span d = P − A from the anchor to the attachment.
    #[inline(always)]
    pub fn span(&self, state: &State<T>) -> Vector2<T> {
        self.span_moved(self.moved(state, &Rotation::by(state.theta)))
    }

    /// Gap g = |P − A|² − r²: negative while slack, zero while taut.
    #[inline(always)]
    pub fn gap(&self, state: &State<T>) -> T {
        self.gap_and_error(state).0
    }

    /// The gap and a bound on its rounding error.
    #[inline(always)]
    pub(crate) fn gap_and_error(&self, state: &State<T>) -> (T, T) {
        let moved = self.moved(state, &Rotation::by(state.theta));
        let error = self.gap_error(moved, state.theta, self.fairlead.length());
        (self.gap_moved(moved), error)
    }

    /// The constraint's direction, and how its entries n_x, n_y and s change with x, y and θ:
    /// ∂n = (δP)/r, ∂s = δρ × n + ρ × ∂n, as P moves by (δx, δy) and by δθ about the centre.
    #[inline(always)]
    pub(crate) fn normal_and_slopes(&self, state: &State<T>) -> (Normal<T>, [[T; 3]; 3]) {
        let (sine, cosine) = state.theta.sin_cos();
        let lever = self.lever(sine, cosine);
        let span = self.span(state);
        let n = span.map(|component| component / self.length);
        let normal = Normal {
            n,
            arm: lever.cross(n),
        };
        let (along, across) = (lever.x / self.length, lever.y / self.length);
        let stretch = T::ONE / self.length;
        let turning = lever.x * along + lever.y * across - n.dot(lever);
        let slopes = [
            [stretch, T::ZERO, -across],
            [T::ZERO, stretch, along],
            [-across, along, turning],
        ];
        (normal, slopes)
    }

    /// The constraint direction; to be used where the gap is closed, so that n has unit length.
    #[inline(always)]
    pub fn normal(&self, state: &State<T>) -> Normal<T> {
        let turn = Rotation::by(state.theta);
        let span = self.span_moved(self.moved(state, &turn));
        self.normal_along(span, self.lever(turn.sine, turn.cosine))
    }

    /// Direction and elongation at any state; δ = (|d|² − r²)/(|d| + r), the gap over a sum, is free
    /// of cancellation.
    pub fn stretch(&self, state: &State<T>) -> Stretch<T> {
        dispatch_over::<T, _>(Stretching(self, state))
    }
}

impl<L: Copy> Cable<L> {
    /// A function of each number and the other cable's.
    #[inline(always)]
    pub(crate) fn zip_with<M: Copy, U>(
        &self,
        other: &Cable<M>,
        number: impl Fn(L, M) -> U + Copy,
    ) -> Cable<U> {
        Cable {
            fairlead: self.fairlead.zip_with(other.fairlead, number),
            length: number(self.length, other.length),
            per_length: number(self.per_length, other.per_length),
            rest_span: self.rest_span.zip_with(other.rest_span, number),
            rest_gap: number(self.rest_gap, other.rest_gap),
            rest_gap_error: number(self.rest_gap_error, other.rest_gap_error),
        }
    }
}

impl<L: Lane> Cable<L> {
    /// Length r \[L\].
    #[inline(always)]
    pub fn length(&self) -> L {
        self.length
    }

    /// 1/r \[1/L\].
    #[inline(always)]
    pub(crate) fn per_length(&self) -> L {
        self.per_length
    }

    /// Attachment to the body, in the body's frame \[L\].
    #[inline(always)]
    pub fn fairlead(&self) -> Vector2<L> {
        self.fairlead
    }

    /// Lever ρ = R(θ) · fairlead, from the centre to the attachment.
    #[inline(always)]
    pub fn lever(&self, sine: L, cosine: L) -> Vector2<L> {
        Vector2::combined(cosine, self.fairlead, sine, self.fairlead.quarter_turn())
    }

    /// The displacement of the attachment from its position at rest, with the body turned by θ.
    #[inline(always)]
    pub(crate) fn moved(&self, state: &State<L>, rotation: &Rotation<L>) -> Vector2<L> {
        let quarter = self.fairlead.quarter_turn();
        let swing = Vector2::combined(rotation.sine, quarter, -rotation.versine, self.fairlead);
        state.centre() + swing
    }

    /// The span of an attachment with this displacement.
    #[inline(always)]
    pub(crate) fn span_moved(&self, moved: Vector2<L>) -> Vector2<L> {
        self.rest_span + moved
    }

    /// The gap of an attachment with this displacement.
    #[inline(always)]
    pub(crate) fn gap_moved(&self, moved: Vector2<L>) -> L {
        let linear = self.rest_span.dot(moved);
        self.rest_gap + linear.mul_add(L::from_f64(2.0), moved.dot(moved))
    }

    /// Bound on the rounding error of [`Cable::gap_moved`]; `reach` is the length of the fairlead.
    #[inline(always)]
    pub(crate) fn gap_error(&self, moved: Vector2<L>, theta: L, reach: L) -> L {
        let square = moved.dot(moved);
        let size = theta.abs().mul_add(reach, moved.length_bound()) * self.length;
        let size = size.mul_add(L::from_f64(2.0), self.rest_gap.abs() + square);
        size.mul_add(L::EPSILON * 4.0, self.rest_gap_error)
    }

    /// n = d/r and s = ρ_x n_y − ρ_y n_x.
    #[inline(always)]
    pub(crate) fn normal_along(&self, span: Vector2<L>, lever: Vector2<L>) -> Normal<L> {
        let n = span.scaled(self.per_length);
        Normal {
            n,
            arm: lever.cross(n),
        }
    }

    /// One of two cables, lane by lane.
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        yes.zip_with(no, |yes, no| L::select(mask, yes, no))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gap_is_the_definition() {
        let cable: Cable = Cable::new([1.0, 1.3], [0.2, 0.1], 1.5);
        let state = State {
            x: 0.3,
            y: -0.2,
            theta: 0.7,
            ..State::default()
        };
        let (s, c) = 0.7_f64.sin_cos();
        let p = [0.3 + 0.2 * c - 0.1 * s, -0.2 + 0.2 * s + 0.1 * c];
        let g = (p[0] - 1.0).powi(2) + (p[1] - 1.3).powi(2) - 2.25;
        assert!((cable.gap(&state) - g).abs() < 2e-15);
        assert_eq!(cable.anchor(), [1.0, 1.3].into());
    }

    /// A cable from (0, 2) to a point at (1, 0) of a body turned by a quarter, of length 2: the
    /// point is at (0, 1) from the centre.
    #[test]
    fn stretch_is_the_definition() {
        let cable: Cable = Cable::new([0.0, 2.0], [1.0, 0.0], 2.0);
        let state = State {
            x: 3.0,
            y: -3.0,
            theta: std::f64::consts::FRAC_PI_2,
            ..State::default()
        };
        let Stretch { normal, elongation } = cable.stretch(&state);
        // d = (3, -4), ρ = (0, 1).
        assert!((normal.n - Vector2::from([0.6, -0.8])).length() < 1e-15);
        assert!((normal.arm + 0.6).abs() < 1e-15);
        assert!((elongation - 3.0).abs() < 1e-15);
    }

    /// The gap of the standard breakwater 1e-9 away from rest is known to nine digits and more.
    #[test]
    fn gap_keeps_its_digits_near_rest() {
        let h = 1.2_f64;
        let cable = Cable::taut_at_rest([0.1 - 1.0, -h], [0.1, 0.0], 1.5);
        let state = State {
            y: 1e-9,
            ..State::default()
        };
        let exact = -2.0 * h * 1e-9 + 1e-18;
        assert!((cable.gap(&state) / exact - 1.0).abs() < 1e-15);
    }
}
