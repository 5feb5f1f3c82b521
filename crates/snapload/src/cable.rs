//! A cable: its gap, its normal and its lever arm.

use crate::State;
use crate::real::{Real, dot, length, quarter_turn};

/// An inextensible cable from a fixed anchor to a point of the body (docs/model.md section 2).
///
/// It is kept by its span where the body is at rest, x = y = θ = 0, and its gap there, because a gap
/// computed as an increment from that place rounds in proportion to how far the body has moved, not
/// to the square of the cable's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cable<T = f64> {
    fairlead: [T; 2],
    length: T,
    rest_span: [T; 2],
    rest_gap: T,
    rest_gap_error: T,
}

/// The direction in which a cable holds the body: the row (n_x, n_y, s) of the constraint matrix G.
/// The gap changes at ġ = 2 r v_n, with the normal velocity v_n = n·Ṗ = n_x ẋ + n_y ẏ + s θ̇.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Normal<T = f64> {
    /// Unit normal n = (P − A)/r.
    pub n: [T; 2],
    /// Moment arm s = ρ_x n_y − ρ_y n_x \[L\].
    pub arm: T,
}

impl<T: Real> Normal<T> {
    /// Normal velocity v_n, positive while the gap closes.
    pub fn velocity(&self, state: &State<T>) -> T {
        dot(self.n, [state.vx, state.vy]) + self.arm * state.vtheta
    }

    /// W_ij = G_i M⁻¹ G_jᵀ; with itself the inverse effective mass w = 1 + s²/I.
    pub fn coupling(&self, other: &Self, inverse_inertia: T) -> T {
        dot(self.n, other.n) + self.arm * other.arm * inverse_inertia
    }

    /// The state after an impulse p in the cable: (ẋ, ẏ) −= p n, θ̇ −= p s/I (docs/model.md section 5).
    pub fn kick(&self, state: &mut State<T>, impulse: T, inverse_inertia: T) {
        state.vx -= impulse * self.n[0];
        state.vy -= impulse * self.n[1];
        state.vtheta -= impulse * self.arm * inverse_inertia;
    }

    /// The same for the position: moves the body against the normal by `distance` in the mass metric.
    pub fn shift(&self, state: &mut State<T>, distance: T, inverse_inertia: T) {
        state.x -= distance * self.n[0];
        state.y -= distance * self.n[1];
        state.theta -= distance * self.arm * inverse_inertia;
    }
}

impl<T: Real> Cable<T> {
    /// A cable from `anchor` A to `fairlead` (in the body's frame), of length r > 0.
    pub fn new(anchor: [T; 2], fairlead: [T; 2], length: T) -> Self {
        let rest_span = [0, 1].map(|i| fairlead[i] - anchor[i]);
        Self {
            fairlead,
            length,
            rest_span,
            rest_gap: dot(rest_span, rest_span) - length.squared(),
            rest_gap_error: length.squared() * T::EPSILON * 4.0,
        }
    }

    /// A cable that is taut by construction where x = y = θ = 0: `rest_span`, which leads from the
    /// anchor to the fairlead there, has the length r up to rounding.
    pub fn taut_at_rest(rest_span: [T; 2], fairlead: [T; 2], length: T) -> Self {
        Self {
            fairlead,
            length,
            rest_span,
            rest_gap: T::ZERO,
            rest_gap_error: T::ZERO,
        }
    }

    /// The same cable in another arithmetic.
    pub(crate) fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> Cable<U> {
        Cable {
            fairlead: self.fairlead.map(number),
            length: number(self.length),
            rest_span: self.rest_span.map(number),
            rest_gap: number(self.rest_gap),
            rest_gap_error: number(self.rest_gap_error),
        }
    }

    /// Length r \[L\].
    pub fn length(&self) -> T {
        self.length
    }

    /// Attachment to the body, in the body's frame \[L\].
    pub fn fairlead(&self) -> [T; 2] {
        self.fairlead
    }

    /// Anchor A \[L\].
    pub fn anchor(&self) -> [T; 2] {
        [0, 1].map(|i| self.fairlead[i] - self.rest_span[i])
    }

    /// Lever ρ = R(θ) · fairlead, from the centre to the attachment.
    pub fn lever(&self, sine: T, cosine: T) -> [T; 2] {
        let [a, b] = self.fairlead;
        [a * cosine - b * sine, a * sine + b * cosine]
    }

    /// Span d = P − A from the anchor to the attachment.
    pub fn span(&self, state: &State<T>) -> [T; 2] {
        let moved = self.moved(state);
        [0, 1].map(|i| self.rest_span[i] + moved[i])
    }

    /// How far the attachment is from where it is at rest.
    fn moved(&self, state: &State<T>) -> [T; 2] {
        let theta = state.theta;
        let (even, odd) = theta.versines();
        let (chord, sine) = (theta * theta * even, theta - theta * theta * odd);
        let turn = quarter_turn(self.fairlead);
        let centre = [state.x, state.y];
        [0, 1].map(|i| centre[i] + (turn[i] * sine - self.fairlead[i] * chord))
    }

    /// Gap g = |P − A|² − r²: negative while slack, zero while taut.
    pub fn gap(&self, state: &State<T>) -> T {
        self.gap_and_error(state).0
    }

    /// The gap and a bound on its rounding error.
    pub(crate) fn gap_and_error(&self, state: &State<T>) -> (T, T) {
        let moved = self.moved(state);
        let linear = dot(self.rest_span, moved) * 2.0;
        let size = (length(moved) + state.theta.abs() * length(self.fairlead)) * self.length;
        let square = dot(moved, moved);
        (
            self.rest_gap + (linear + square),
            self.rest_gap_error + (self.rest_gap.abs() + size * 2.0 + square) * T::EPSILON * 4.0,
        )
    }

    /// The constraint's direction, and how its entries n_x, n_y and s change with x, y and θ:
    /// ∂n = (δP)/r, ∂s = δρ × n + ρ × ∂n, as P moves by (δx, δy) and by δθ about the centre.
    pub(crate) fn normal_and_slopes(&self, state: &State<T>) -> (Normal<T>, [[T; 3]; 3]) {
        let (sine, cosine) = state.theta.sin_cos();
        let lever = self.lever(sine, cosine);
        let span = self.span(state);
        let n = [span[0] / self.length, span[1] / self.length];
        let normal = Normal {
            n,
            arm: lever[0] * n[1] - lever[1] * n[0],
        };
        let (along, across) = (lever[0] / self.length, lever[1] / self.length);
        let stretch = T::ONE / self.length;
        let turning = lever[0] * along + lever[1] * across - dot(n, lever);
        let slopes = [
            [stretch, T::ZERO, -across],
            [T::ZERO, stretch, along],
            [-across, along, turning],
        ];
        (normal, slopes)
    }

    /// The constraint's direction; meant where the gap is closed, so that n has unit length.
    pub fn normal(&self, state: &State<T>) -> Normal<T> {
        let (sine, cosine) = state.theta.sin_cos();
        let lever = self.lever(sine, cosine);
        let span = self.span(state);
        let n = [span[0] / self.length, span[1] / self.length];
        Normal {
            n,
            arm: lever[0] * n[1] - lever[1] * n[0],
        }
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
        assert_eq!(cable.anchor(), [1.0, 1.3]);
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
