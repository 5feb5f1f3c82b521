//! Cubic splines through given points.

/// A cubic spline through points, with the third derivative continuous at the second and the last
/// but one of them ("not-a-knot"), so that a cubic is reproduced exactly. Two points give a line,
/// three a parabola.
#[derive(Clone, Debug)]
pub struct Spline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// The second derivative at each point.
    second_derivatives: Vec<f64>,
}

impl Spline {
    /// The spline through points with rising x, of which there is at least one.
    pub fn new(x: &[f64], y: &[f64]) -> Self {
        Self {
            x: x.to_vec(),
            y: y.to_vec(),
            second_derivatives: second_derivatives(x, y),
        }
    }

    /// The first and the last x.
    pub fn ends(&self) -> [f64; 2] {
        [self.x[0], self.x[self.x.len() - 1]]
    }

    /// The value at x; outside of the points the value at the nearest.
    pub fn clamped(&self, x: f64) -> f64 {
        let [first, last] = self.ends();
        if self.x.len() == 1 {
            return self.y[0];
        }
        let x = x.clamp(first, last);
        let right = self.x.partition_point(|knot| *knot < x);
        let right = right.clamp(1, self.x.len() - 1);
        let left = right - 1;
        let h = self.x[right] - self.x[left];
        let (a, b) = (self.x[right] - x, x - self.x[left]);
        let cubic = (self.second_derivatives[left] * a * a * a
            + self.second_derivatives[right] * b * b * b)
            / (6.0 * h);
        let line = |index: usize| self.y[index] / h - self.second_derivatives[index] * h / 6.0;
        cubic + line(left) * a + line(right) * b
    }
}

/// The second derivatives m_i:
///
/// ```text
/// h_{i−1} m_{i−1} + 2(h_{i−1} + h_i) m_i + h_i m_{i+1} = 6 (Δ_i − Δ_{i−1}),    Δ_i = (y_{i+1} − y_i)/h_i
/// m_0 = ((h_0 + h_1) m_1 − h_0 m_2)/h_1, and so at the other end
/// ```
///
/// where the outer two are eliminated first, and the rest follow by elimination.
/// Source: C. de Boor, *A Practical Guide to Splines* (1978), chapter IV.
fn second_derivatives(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let slope: Vec<f64> = (0..n.saturating_sub(1))
        .map(|i| (y[i + 1] - y[i]) / h[i])
        .collect();
    if n < 3 {
        return vec![0.0; n];
    }
    if n == 3 {
        return vec![2.0 * (slope[1] - slope[0]) / (h[0] + h[1]); 3];
    }
    let inner = n - 2;
    let (mut below, mut on, mut above, mut right) = (
        vec![0.0; inner],
        vec![0.0; inner],
        vec![0.0; inner],
        vec![0.0; inner],
    );
    for k in 0..inner {
        let i = k + 1;
        below[k] = h[i - 1];
        on[k] = 2.0 * (h[i - 1] + h[i]);
        above[k] = h[i];
        right[k] = 6.0 * (slope[i] - slope[i - 1]);
    }
    let (p, q) = (h[0], h[1]);
    on[0] += p * (p + q) / q;
    above[0] -= p * p / q;
    let (p, q) = (h[n - 2], h[n - 3]);
    on[inner - 1] += p * (p + q) / q;
    below[inner - 1] -= p * p / q;
    for k in 1..inner {
        let factor = below[k] / on[k - 1];
        on[k] -= factor * above[k - 1];
        right[k] -= factor * right[k - 1];
    }
    let mut second = vec![0.0; n];
    for k in (0..inner).rev() {
        let next = if k + 1 < inner { second[k + 2] } else { 0.0 };
        second[k + 1] = (right[k] - above[k] * next) / on[k];
    }
    second[0] = ((h[0] + h[1]) * second[1] - h[0] * second[2]) / h[1];
    second[n - 1] = ((h[n - 2] + h[n - 3]) * second[n - 2] - h[n - 2] * second[n - 3]) / h[n - 3];
    second
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic is reproduced, on uneven points; two and three points give a line and a parabola.
    #[test]
    fn polynomials_come_back() {
        let x = [0.0, 0.3, 1.1, 1.5, 2.9, 3.0, 4.2];
        for (points, degree) in [(7, 3), (5, 3), (4, 3), (3, 2), (2, 1), (1, 0)] {
            let f = |x: f64| {
                (0..=degree)
                    .map(|k| (k as f64 - 1.7) * x.powi(k))
                    .sum::<f64>()
            };
            let y: Vec<f64> = x[..points].iter().map(|x| f(*x)).collect();
            let spline = Spline::new(&x[..points], &y);
            for k in 0..=40 {
                let at = x[points - 1] * f64::from(k) / 40.0;
                let error = (spline.clamped(at) - f(at)).abs();
                assert!(error < 1e-12, "{points} points, x = {at}: {error}");
            }
            assert_eq!(spline.clamped(-1.0), spline.clamped(0.0));
        }
    }
}
