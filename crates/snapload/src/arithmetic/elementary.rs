//! Sine and cosine of doubles, by plain arithmetic in a fixed order.
//!
//! Two polynomials serve all: E and O with (1 − cos z)/z² = E(z²) and (z − sin z)/z³ = O(z²) for
//! |z| ≤ 1.6. They are best approximations (Remez exchange at 60 digits) with the first coefficient
//! of the Taylor series held; their relative errors are below 4e-17 and 6e-18, a sixth of a
//! rounding. The terms are added by Estrin's scheme, which lets a processor do several at once.

use crate::arithmetic::lane::{Lane, Mask};

/// E and O hold up to this angle, a little above π/2.
const POLYNOMIAL: f64 = 1.6;

const EVEN: [f64; 8] = [
    0.5,
    -0.041_666_666_666_666_48,
    0.001_388_888_888_886_475,
    -2.480_158_729_243_913_2e-5,
    2.755_731_767_581_831e-7,
    -2.087_662_106_978_830_7e-9,
    1.146_429_540_050_868_2e-11,
    -4.622_086_600_292_003e-14,
];
const ODD: [f64; 8] = [
    1.0 / 6.0,
    -0.008_333_333_333_333_323,
    0.000_198_412_698_412_571_05,
    -2.755_731_921_915_9e-6,
    2.505_210_756_864_253e-8,
    -1.605_897_213_763_634_8e-10,
    7.643_761_975_332_012e-13,
    -2.728_493_330_434_836e-15,
];

/// One or several doubles, of which each can be read and set.
pub(crate) trait Doubles: Lane {
    /// The number of doubles.
    const WIDTH: usize = <Self::Mask as Mask>::WIDTH;
    /// As many of them as one register holds.
    type Register: Doubles;

    /// The double in a lane.
    fn get(&self, lane: usize) -> f64;
    /// Puts a double into a lane.
    fn set(&mut self, lane: usize, value: f64);

    /// Both results of a function of one double, lane by lane.
    fn each(self, f: fn(f64) -> (f64, f64)) -> (Self, Self) {
        let (mut first, mut second) = (self, self);
        for lane in 0..Self::WIDTH {
            let (a, b) = f(self.get(lane));
            first.set(lane, a);
            second.set(lane, b);
        }
        (first, second)
    }
}

impl Doubles for f64 {
    type Register = Self;

    fn get(&self, _: usize) -> f64 {
        *self
    }
    fn set(&mut self, _: usize, value: f64) {
        *self = value;
    }
}

/// c_0 + c_1 u + … + c_7 u⁷.
#[inline(always)]
fn estrin<L: Lane>(c: &[f64; 8], u: L, u2: L, u4: L) -> L {
    let low = line(c[2], c[3], u).mul_add(u2, line(c[0], c[1], u));
    let high = line(c[6], c[7], u).mul_add(u2, line(c[4], c[5], u));
    high.mul_add(u4, low)
}

/// a + b u.
#[inline(always)]
fn line<L: Lane>(a: f64, b: f64, u: L) -> L {
    u.mul_add(L::from_f64(b), L::from_f64(a))
}

/// E(z²) and z O(z²).
#[inline(always)]
fn polynomials<L: Lane>(z: L) -> (L, L) {
    let u = z * z;
    let u2 = u * u;
    let u4 = u2 * u2;
    (estrin(&EVEN, u, u2, u4), z * estrin(&ODD, u, u2, u4))
}

/// ( (1 − cos z)/z², (z − sin z)/z² ), without cancellation at small z; (½, 0) at z = 0.
#[inline(always)]
pub(crate) fn versines<L: Doubles>(z: L) -> (L, L) {
    let small = polynomials(z);
    let large = L::from_f64(POLYNOMIAL).below(z.abs());
    if !large.any() {
        return small;
    }
    let (half_sine, half_cosine) = sin_cos(z * 0.5);
    let square = z * z;
    (
        L::select(large, half_sine * half_sine * 2.0 / square, small.0),
        L::select(large, (z - half_sine * half_cosine * 2.0) / square, small.1),
    )
}

/// Up to this many multiples of π/2 are subtracted exactly.
const MOST_QUARTERS: f64 = 1e6;
/// 1.5 · 2^52: added and subtracted, it rounds a number to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// π/2 in three parts (Cody and Waite): n times either of the first two, of 33 bits, is exact.
const QUARTER: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];

/// The integer next to a number of moderate size.
#[inline(always)]
pub(crate) fn rounded<L: Lane>(x: L) -> L {
    (x + ROUNDER) - ROUNDER
}

/// Sine and cosine, with an error of about one rounding.
#[inline(always)]
pub(crate) fn sin_cos<L: Doubles>(z: L) -> (L, L) {
    let far = L::from_f64(MOST_QUARTERS).below(z.abs());
    let n = rounded(z * std::f64::consts::FRAC_2_PI);
    let [first, second, third] = QUARTER;
    let r = n.mul_add(L::from_f64(-first), z);
    let r = n.mul_add(L::from_f64(-second), r);
    let r = n.mul_add(L::from_f64(-third), r);
    let (even, odd) = polynomials(r);
    let square = r * r;
    let (sine, cosine) = ((-square).mul_add(odd, r), (-square).mul_add(even, L::ONE));
    // n mod 4 as one of −2, −1, 0, 1, 2.
    let quadrant = n - rounded(n * 0.25) * 4.0;
    let odd_turn = quadrant.abs().below(L::from_f64(1.5)) & L::from_f64(0.5).below(quadrant.abs());
    let half_turn = L::from_f64(1.5).below(quadrant.abs());
    let (a, b) = (
        L::select(odd_turn, cosine, sine),
        L::select(odd_turn, sine, cosine),
    );
    // A quarter turn has (cos, −sin), one backwards (−cos, sin), a half turn (−sin, −cos).
    let sine_negative = half_turn | quadrant.below(L::from_f64(-0.5));
    let cosine_negative = half_turn | (odd_turn & L::ZERO.below(quadrant));
    let near = (
        L::select(sine_negative, -a, a),
        L::select(cosine_negative, -b, b),
    );
    if !far.any() {
        return near;
    }
    // Angles of a million and more use the Rust port in the crate `libm`, which is plain arithmetic
    // too.
    let (sine, cosine) = z.each(libm::sincos);
    (L::select(far, sine, near.0), L::select(far, cosine, near.1))
}

#[cfg(test)]
mod tests {
    use crate::arithmetic::precise::Precise;
    use crate::arithmetic::real::Real;

    /// Compared with many digits: the error in roundings of the value, or of its difference from 1
    /// where that is near zero.
    #[test]
    fn functions_agree_with_many_digits() {
        let mut worst = [0.0_f64; 3];
        for k in -300..300_i32 {
            let k = f64::from(k) * 20.0;
            for z in [
                k * 0.001,
                k * 0.0173,
                k * 1.37,
                k * k * 3.1e-2,
                k * k * k * 7e-5,
            ] {
                let exact = Precise::<4>::from_f64(z);
                let off = |got: f64, exact: Precise<4>, least: f64| {
                    let difference = (exact - got).to_f64().abs();
                    difference / (exact.to_f64().abs().max(least) * f64::EPSILON)
                };
                let ((s, c), (s_exact, c_exact)) = (super::sin_cos(z), exact.sin_cos());
                let ((e, o), (e_exact, o_exact)) = (super::versines(z), exact.versines());
                worst[0] = worst[0]
                    .max(off(s, s_exact, 1e-9))
                    .max(off(c, c_exact, 1e-9));
                worst[1] = worst[1].max(off(e, e_exact, 1e-6 / (1.0 + z * z)));
                worst[2] = worst[2].max(off(o, o_exact, 1e-300));
            }
        }
        // A correctly rounded function is off by half of ε at most.
        assert!(
            worst[0] < 1.5 && worst[1] < 3.0 && worst[2] < 2.0,
            "{worst:?}"
        );
        assert_eq!(super::versines(0.0), (0.5, 0.0));
        assert_eq!(super::sin_cos(0.0), (0.0, 1.0));
        assert_eq!(super::sin_cos(1e7), libm::sincos(1e7));
    }
}
