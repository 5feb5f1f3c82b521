//! The set of states that a proof carries: c + B r, with a vector c, a matrix B of doubles and a
//! box r about zero (Lohner's method).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::verdict::ProofFailure;

/// A square matrix of doubles, by rows.
pub(crate) type Doubles<const N: usize> = [[f64; N]; N];

/// All c + B ρ with |ρ_i| ≤ r_i.
#[derive(Clone, Debug)]
pub(crate) struct Set<const N: usize> {
    centre: [Ball; N],
    axes: Doubles<N>,
    sides: [Radius; N],
}

impl<const N: usize> Set<N> {
    /// The set that equals a box of balls.
    pub(crate) fn of_box(state: &[Ball; N]) -> Self {
        Self {
            centre: std::array::from_fn(|i| state[i].centre()),
            axes: std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j)))),
            sides: std::array::from_fn(|i| state[i].radius()),
        }
    }

    pub(crate) fn centre(&self) -> &[Ball; N] {
        &self.centre
    }

    /// The smallest box of balls that contains the set: |(B ρ)_i| ≤ Σ |B_ij| r_j.
    pub(crate) fn hull(&self) -> [Ball; N] {
        std::array::from_fn(|i| {
            let row = self.axes[i].iter().zip(&self.sides);
            let spread = row.fold(Radius::ZERO, |sum, (axis, side)| {
                sum.plus(Ball::double(*axis).upper().times(*side))
            });
            self.centre[i].clone().widened(spread)
        })
    }

    /// The image under a map into M dimensions that takes the centre into `image`, and whose
    /// Jacobian is within `jacobian` everywhere on the hull.
    ///
    /// By the mean value theorem, row by row, the image lies in image + J B r. With any invertible
    /// B' that is c' + B' r', where c' is the middle of `image`, δ its radius and
    ///
    /// ```text
    /// r' = (B'⁻¹ J B) r + B'⁻¹ δ
    /// ```
    ///
    /// Let B'ᵀB' = 1 + E and ε < 1 bound the sums of |E| along rows. Then B'⁻¹ y = (1 + E)⁻¹ B'ᵀ
    /// y, and by Neumann's series (1 + E)⁻¹ z differs from z by no more than ε/(1 − ε) max |z|,
    /// at most 2 ε max |z| for ε ≤ 1/2.
    pub(crate) fn mapped<const M: usize>(
        &self,
        image: &[Ball; M],
        jacobian: &[[Ball; N]; M],
    ) -> Result<Set<M>, ProofFailure> {
        let old = self.axes.map(|row| row.map(Ball::double));
        let moved = product(jacobian, &old);
        let axes = self.new_axes(&moved);
        let transposed: [[Ball; M]; M] =
            std::array::from_fn(|i| std::array::from_fn(|j| Ball::double(axes[j][i])));
        let new = axes.map(|row| row.map(Ball::double));
        let epsilon = departure(&product(&transposed, &new));
        if epsilon > Radius::power_of_two(-1) {
            return Err(ProofFailure::undecided(
                "a set of states that has become too flat",
            ));
        }
        let turned = product(&transposed, &moved);
        let reach: [Radius; M] = std::array::from_fn(|i| {
            let carried = (0..N).fold(Radius::ZERO, |sum, j| {
                sum.plus(turned[i][j].upper().times(self.sides[j]))
            });
            (0..M).fold(carried, |sum, j| {
                sum.plus(transposed[i][j].upper().times(image[j].radius()))
            })
        });
        let largest = reach.iter().copied().max().unwrap_or(Radius::ZERO);
        let more = epsilon.times(largest).scaled(1);
        Ok(Set {
            centre: std::array::from_fn(|i| image[i].centre()),
            axes,
            sides: reach.map(|side| side.plus(more)),
        })
    }

    /// Orthonormal directions along the columns of a matrix, beginning with those along which the
    /// set is longest. The proof does not depend on their accuracy.
    fn new_axes<const M: usize>(&self, moved: &[[Ball; N]; M]) -> Doubles<M> {
        let columns: [[f64; M]; N] =
            std::array::from_fn(|j| std::array::from_fn(|i| moved[i][j].to_f64()));
        let length = |v: &[f64; M]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let longest = self.sides.iter().copied().max().unwrap_or(Radius::ZERO);
        let weight = |j: usize| match longest.is_zero() {
            true => length(&columns[j]),
            false => self.sides[j].over(longest).to_f64() * length(&columns[j]),
        };
        let mut order: [usize; N] = std::array::from_fn(|j| j);
        order.sort_by(|a, b| weight(*b).total_cmp(&weight(*a)));
        let units = (0..M).map(|k| std::array::from_fn(|i| f64::from(u8::from(i == k))));
        let mut found: Vec<[f64; M]> = Vec::with_capacity(M);
        for column in order.map(|j| columns[j]).into_iter().chain(units) {
            let least = 1e-12 * length(&column);
            let mut v = column;
            // Twice, as rounding in the first pass leaves components along the earlier directions.
            for u in found.iter().chain(&found) {
                let along: f64 = u.iter().zip(&v).map(|(a, b)| a * b).sum();
                for (x, a) in v.iter_mut().zip(u) {
                    *x -= along * a;
                }
            }
            let size = length(&v);
            if size > least && size.is_finite() && found.len() < M {
                found.push(v.map(|x| x / size));
            }
        }
        std::array::from_fn(|i| std::array::from_fn(|j| found.get(j).map_or(0.0, |v| v[i])))
    }
}

/// The product of two matrices.
pub(crate) fn product<const M: usize, const K: usize, const N: usize>(
    a: &[[Ball; K]; M],
    b: &[[Ball; N]; K],
) -> [[Ball; N]; M] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            (1..K).fold(&a[i][0] * &b[0][j], |sum, k| sum + &a[i][k] * &b[k][j])
        })
    })
}

/// The largest sum along a row of |A − 1|.
fn departure<const N: usize>(a: &[[Ball; N]; N]) -> Radius {
    let row = |i: usize| {
        (0..N).fold(Radius::ZERO, |sum, j| {
            let off = &a[i][j] - &Ball::integer(i64::from(i == j));
            sum.plus(off.upper())
        })
    };
    (0..N).map(row).max().unwrap_or(Radius::ZERO)
}
