//! One step of taut motion by its Taylor polynomial, with a bound on what is left out.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::radius::Radius;
use crate::model::{Model, Watched};
use crate::slack::search::Path;
use crate::slack::set::Set;
use crate::taut::series::{DIMENSION, Expansion, Jet, Program};
use crate::taut::sliding::Coordinates;
use crate::verdict::Trouble;

/// Motion over [0, H] from a set of states at a time, which is a number.
pub(crate) struct Step<'a> {
    model: &'a Model,
    /// H, a number.
    pub(crate) length: Ball,
    centre: Expansion<Ball>,
    whole: Expansion<Jet>,
    /// Of each coordinate and output the coefficient after the last, over all states passed.
    rest: Expansion<Ball>,
    /// From the centre to any state of the set.
    spread: Coordinates,
    /// Of each output the coefficients over the set, with the remainder's as the last, and those of its
    /// first and second derivative.
    outputs: Vec<[Vec<Ball>; 3]>,
}

/// Terms of the polynomial, by the limbs of its numbers.
pub(crate) fn order(limbs: usize) -> usize {
    8 + 8 * limbs
}

impl<'a> Step<'a> {
    /// A step of a length of its own choice, at most `most`.
    ///
    /// Let P be the Taylor polynomial of order N of the solution from a state x of the set X. If for a
    /// box Y and R, the coefficients of order N + 1 over Y and the times passed, the range of P over
    /// [0, H] with R [0, H]^(N+1) is within Y for every x, then each solution exists on [0, H], is
    /// within Y, and is within P + R τ^(N+1) (Nedialkov and Jackson's enclosure of higher order; the
    /// remainder is Lagrange's).
    pub(crate) fn new(
        model: &'a Model,
        program: &Program,
        time: &Ball,
        set: &Set<DIMENSION>,
        most: f64,
    ) -> Result<Self, Trouble> {
        let n = order(model.limbs);
        let lost = || Trouble::undecided("the forces of a taut motion");
        let functions = &model.functions;
        let centre = program.expand(set.centre(), time, n, functions);
        let centre = centre.ok_or_else(lost)?;
        let hull = set.hull();
        let jets = std::array::from_fn(|i| Jet::coordinate(hull[i].clone(), i));
        let whole = program.expand(&jets, time, n, functions).ok_or_else(lost)?;
        let spread = std::array::from_fn(|i| &hull[i] - &set.centre()[i]);
        let mut length = likely_length(&centre, model.limbs).min(most);
        for _ in 0..12 {
            let h = Ball::double(length).with_limbs(model.limbs);
            if let Some(rest) = enclosed(program, model, time, &whole, &h, n) {
                let outputs = outputs(&whole, &rest);
                return Ok(Self {
                    model,
                    length: h,
                    centre,
                    whole,
                    rest,
                    spread,
                    outputs,
                });
            }
            length = rounded(length / 2.0);
        }
        Err(Trouble::undecided("an enclosure of the taut motion"))
    }

    /// The states of the set after τ in [0, H]: P of the centre, and by the mean value theorem the
    /// derivative of P over the set times what is between.
    pub(crate) fn at(&self, tau: &Ball) -> Coordinates {
        let power = self.last_power(tau);
        std::array::from_fn(|i| {
            let mut sum = horner(&self.centre.state[i], tau) + &self.remainder(i) * &power;
            for (j, off) in self.spread.iter().enumerate() {
                sum = sum + self.slope(i, j, tau) * off;
            }
            sum
        })
    }

    /// The set after the whole step.
    pub(crate) fn end(&self, set: &Set<DIMENSION>) -> Result<Set<DIMENSION>, Trouble> {
        let h = &self.length;
        let power = self.last_power(h);
        let image =
            std::array::from_fn(|i| horner(&self.centre.state[i], h) + &self.remainder(i) * &power);
        let jacobian = std::array::from_fn(|i| std::array::from_fn(|j| self.slope(i, j, h)));
        set.mapped(&image, &jacobian)
    }

    fn remainder(&self, i: usize) -> Ball {
        last(&self.rest.state[i])
    }

    fn slope(&self, i: usize, j: usize, tau: &Ball) -> Ball {
        let mut series = self.whole.state[i].iter().rev();
        let first = series
            .next()
            .map_or_else(Ball::zero, |jet| jet.slopes[j].clone());
        series.fold(first, |sum, jet| sum * tau + &jet.slopes[j])
    }

    fn last_power(&self, tau: &Ball) -> Ball {
        let n = self.centre.state[0].len();
        (1..n).fold(tau.clone(), |power, _| power * tau)
    }
}

fn outputs(whole: &Expansion<Jet>, rest: &Expansion<Ball>) -> Vec<[Vec<Ball>; 3]> {
    let pairs = whole.outputs.iter().zip(&rest.outputs);
    let all = pairs.map(|(known, rest)| {
        let known = known.iter().map(|jet| jet.value.clone());
        let value: Vec<Ball> = known.chain([last(rest)]).collect();
        let rate = derivative(&value);
        let bend = derivative(&rate);
        [value, rate, bend]
    });
    all.collect()
}

fn last(series: &[Ball]) -> Ball {
    series.last().cloned().unwrap_or_else(Ball::zero)
}

impl Path for Step<'_> {
    fn limbs(&self) -> usize {
        self.model.limbs
    }

    fn count(&self) -> usize {
        self.outputs.len()
    }

    /// An output f is a function of the solution, so that it is its own polynomial with the
    /// coefficient of order N + 1 taken over Y, and ḟ likewise with (N + 1) times that.
    fn one_watched(&self, which: usize, tau: &Ball) -> Watched {
        let [value, rate, _] = &self.outputs[which];
        Watched {
            value: horner(value, tau),
            rate: horner(rate, tau),
        }
    }

    fn bends(&self, middle: &Ball, half: Radius) -> Vec<Ball> {
        let over = middle.clone().widened(half);
        let bends = self.outputs.iter().map(|[.., bend]| horner(bend, &over));
        bends.collect()
    }
}

/// Σ c_k τ^k.
fn horner(coefficients: &[Ball], tau: &Ball) -> Ball {
    let mut series = coefficients.iter().rev();
    let first = series.next().cloned().unwrap_or_else(Ball::zero);
    series.fold(first, |sum, next| sum * tau + next)
}

fn derivative(coefficients: &[Ball]) -> Vec<Ball> {
    let terms = coefficients.iter().enumerate().skip(1);
    terms.map(|(k, c)| c * &Ball::integer(k as i64)).collect()
}

/// The coefficients of order N + 1 over a box that is proved to hold the motion; none if the box is
/// too small.
fn enclosed(
    program: &Program,
    model: &Model,
    time: &Ball,
    whole: &Expansion<Jet>,
    h: &Ball,
    n: usize,
) -> Option<Expansion<Ball>> {
    let within = h.half().widened(h.upper().scaled(-1));
    let range: Coordinates = std::array::from_fn(|i| {
        let series: Vec<Ball> = whole.state[i].iter().map(|jet| jet.value.clone()).collect();
        horner(&series, &within)
    });
    let room = Radius::power_of_two(-48);
    let wide: Coordinates = std::array::from_fn(|i| range[i].clone().widened(room));
    let times = time + &within;
    let rest = program.expand(&wide, &times, n + 1, &model.functions)?;
    let power = (0..n).fold(h.upper(), |power, _| power.times(h.upper()));
    // The range and what is left out stay within the box if that is less than the room.
    let fits = rest
        .state
        .iter()
        .all(|series| last(series).upper().times(power) < room);
    fits.then_some(rest)
}

/// A length at which the last terms of the polynomial are as small as the digits ask for.
fn likely_length(centre: &Expansion<Ball>, limbs: usize) -> f64 {
    let bits = 38.0 * limbs as f64;
    let mut least = 0.25f64;
    for series in &centre.state {
        for (k, coefficient) in series.iter().enumerate().skip(series.len() - 4) {
            let size = coefficient.upper().to_f64();
            if size > 0.0 {
                least = least.min(((-bits - size.log2()) / k as f64).exp2());
            }
        }
    }
    rounded(least)
}

/// A double of few bits, so that times stay short.
fn rounded(length: f64) -> f64 {
    let unit = (length.log2().floor() - 6.0).exp2();
    (length / unit).floor() * unit
}
