//! Sobol points with Owen's scrambling, each of which can be computed by itself.
//!
//! The available crates are limited to 65,536 points in single precision, or compute each point
//! from the one before; a study needs ten million points in any order. Direction numbers: S. Joe and
//! F. Y. Kuo, *Constructing Sobol sequences with better two-dimensional projections*, SIAM J. Sci.
//! Comput. 30 (2008) 2635-2654, set new-joe-kuo-6.21201.

/// Bits of a coordinate: as many as a double below 1 holds.
const BITS: usize = 53;

/// One dimension: degree s and coefficients a of its primitive polynomial, first direction numbers
/// m.
struct Direction {
    s: usize,
    a: u64,
    m: &'static [u64],
}

const fn row(s: usize, a: u64, m: &'static [u64]) -> Direction {
    Direction { s, a, m }
}

/// The dimensions after the first.
const DIRECTIONS: [Direction; 20] = [
    row(1, 0, &[1]),
    row(2, 1, &[1, 3]),
    row(3, 1, &[1, 3, 1]),
    row(3, 2, &[1, 1, 1]),
    row(4, 1, &[1, 1, 3, 3]),
    row(4, 4, &[1, 3, 5, 13]),
    row(5, 2, &[1, 1, 5, 5, 17]),
    row(5, 4, &[1, 1, 5, 5, 5]),
    row(5, 7, &[1, 1, 7, 11, 19]),
    row(5, 11, &[1, 1, 5, 1, 1]),
    row(5, 13, &[1, 1, 1, 3, 11]),
    row(5, 14, &[1, 3, 5, 5, 31]),
    row(6, 1, &[1, 3, 3, 9, 7, 49]),
    row(6, 13, &[1, 1, 1, 15, 21, 21]),
    row(6, 16, &[1, 3, 1, 13, 27, 49]),
    row(6, 19, &[1, 1, 1, 15, 7, 5]),
    row(6, 22, &[1, 3, 1, 15, 13, 25]),
    row(6, 25, &[1, 1, 5, 5, 19, 61]),
    row(7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    row(7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// A scrambled sequence in the unit cube.
#[derive(Clone, Debug, PartialEq)]
pub struct Sobol {
    vectors: Vec<[u64; BITS]>,
    seed: u64,
}

impl Sobol {
    /// The most dimensions.
    pub const MOST: usize = DIRECTIONS.len() + 1;

    /// A sequence of `dimensions` dimensions; none beyond [`Sobol::MOST`]. The seed selects the
    /// scrambling.
    pub fn new(dimensions: usize, seed: u64) -> Option<Self> {
        let rest = DIRECTIONS.get(..dimensions.checked_sub(1)?)?;
        let first = std::array::from_fn(|j| 1 << (BITS - 1 - j));
        let vectors = std::iter::once(first).chain(rest.iter().map(vectors));
        Some(Self {
            vectors: vectors.collect(),
            seed,
        })
    }

    /// Coordinate `dimension` of point `index`, in [0, 1).
    pub fn coordinate(&self, index: u64, dimension: usize) -> f64 {
        let key = mix(self.seed.wrapping_add(mix(dimension as u64 + 1)));
        let scrambled = scramble(self.plain(index, dimension), key);
        scrambled as f64 / (1_u64 << BITS) as f64
    }

    /// Before scrambling, as a whole number of 2^-53.
    fn plain(&self, index: u64, dimension: usize) -> u64 {
        let vectors = &self.vectors[dimension];
        let mut gray = (index ^ (index >> 1)) & ((1 << BITS) - 1);
        let mut point = 0;
        while gray != 0 {
            point ^= vectors[gray.trailing_zeros() as usize];
            gray &= gray - 1;
        }
        point
    }
}

/// The direction vectors of one dimension: the recurrence of the paper, m as fractions.
fn vectors(direction: &Direction) -> [u64; BITS] {
    let Direction { s, a, m } = *direction;
    let mut v = [0_u64; BITS];
    for j in 0..BITS {
        v[j] = match m.get(j) {
            Some(m) => m << (BITS - 1 - j),
            None => (1..s)
                .filter(|k| a >> (s - 1 - k) & 1 == 1)
                .fold(v[j - s] ^ (v[j - s] >> s), |sum, k| sum ^ v[j - k]),
        };
    }
    v
}

/// Owen's nested scrambling: every bit is flipped or not, by a pseudorandom bit that depends on the
/// bits above it.
fn scramble(point: u64, key: u64) -> u64 {
    (0..BITS).fold(0, |scrambled, j| {
        let shift = BITS - 1 - j;
        // The bits above, with a leading one that encodes their number.
        let above = (1_u64 << j) | (point >> shift >> 1);
        let coin = mix(key ^ mix(above)) >> 63;
        scrambled | ((point >> shift & 1 ^ coin) << shift)
    })
}

/// The finaliser of splitmix64 (Steele, Lea and Flood 2014).
fn mix(z: u64) -> u64 {
    let z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[rustfmt::skip]
    const FIFTH: [f64; 21] = [
        0.875, 0.875, 0.125, 0.375, 0.875, 0.625, 0.875, 0.375, 0.375, 0.125, 0.375, 0.875, 0.875, 0.125, 0.875, 0.375, 0.875, 0.375, 0.375, 0.625, 0.625,
    ];
    #[rustfmt::skip]
    const MILLIONTH: [f64; 21] = [
        0.026474952697753906, 0.3119192123413086, 0.8279962539672852, 0.6682462692260742, 0.6286592483520508, 0.7950620651245117, 0.9707460403442383, 0.016793251037597656, 0.3004159927368164, 0.25440120697021484, 0.638331413269043, 0.9311761856079102, 0.27321720123291016, 0.5333433151245117, 0.6491060256958008, 0.7160959243774414, 0.4430112838745117, 0.25748538970947266, 0.5928945541381836, 0.3822927474975586, 0.040129661560058594,
    ];

    /// Points 1 and 5 agree with scipy.stats.qmc.Sobol(21, scramble=False), which uses the same
    /// direction numbers, and so does point 1,000,000 in its last dimensions.
    #[test]
    fn plain_points_are_those_of_other_programs() {
        let sobol = Sobol::new(Sobol::MOST, 0).expect("as many as there are");
        let unit = (1_u64 << BITS) as f64;
        let point = |index| -> Vec<f64> {
            (0..Sobol::MOST)
                .map(|d| sobol.plain(index, d) as f64 / unit)
                .collect()
        };
        assert_eq!(point(1), vec![0.5; Sobol::MOST]);
        assert_eq!(point(5), FIFTH);
        assert_eq!(point(1_000_000), MILLIONTH);
    }

    /// Of 2^m points each of the 2^m equal intervals of every coordinate contains one, also with
    /// scrambling.
    #[test]
    fn every_interval_has_its_point() {
        let sobol = Sobol::new(Sobol::MOST, 7).expect("as many as there are");
        for dimension in 0..Sobol::MOST {
            let mut cells: Vec<u64> = (0..256)
                .map(|index| (sobol.coordinate(index, dimension) * 256.0) as u64)
                .collect();
            cells.sort_unstable();
            assert!(cells.into_iter().eq(0..256), "dimension {dimension}");
        }
    }

    #[test]
    fn a_seed_is_another_sequence_and_the_same_seed_the_same() {
        let of = |seed| Sobol::new(3, seed).expect("few").coordinate(12345, 2);
        assert_eq!(of(1), of(1));
        assert!(of(1) != of(2) && of(1) != 0.0);
        assert_eq!(Sobol::new(Sobol::MOST + 1, 0), None);
        assert_eq!(Sobol::new(0, 0), None);
    }
}
