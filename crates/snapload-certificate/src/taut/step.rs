//! One step of taut motion by its Taylor polynomial, with a bound on the remainder.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::elementary::Elementary;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::{Jet, Scalar};
use crate::model::{EventValue, Model};
use crate::slack::search::Path;
use crate::slack::set::Set;
use crate::taut::chart::{Chart, EventFunction};
use crate::taut::enclosure::enclosed;
use crate::taut::series::{Expansion, Program};
use crate::verdict::ProofFailure;

/// The equations of a motion, at full precision and in intervals of doubles.
pub(crate) struct Equations<'a> {
    pub(crate) model: &'a Model,
    pub(crate) program: Program,
    pub(crate) few: Program<Interval>,
    /// For intervals.
    pub(crate) functions: Elementary,
    pub(crate) event_functions: Vec<EventFunction>,
}

/// A program at full precision and in intervals of doubles.
pub(crate) struct TwoPrecisions {
    pub(crate) exact: Program,
    pub(crate) few: Program<Interval>,
}

impl TwoPrecisions {
    pub(crate) fn of(exact: Program) -> Self {
        Self {
            few: exact.map(Interval::of),
            exact,
        }
    }
}

impl<'a> Equations<'a> {
    pub(crate) fn of<const N: usize>(chart: &impl Chart<N>, model: &'a Model) -> Self {
        let terms = chart.terms(model);
        Self {
            model,
            few: terms.program.map(Interval::of),
            functions: Elementary::new(2),
            program: terms.program,
            event_functions: terms.event_functions,
        }
    }
}

/// Motion over [0, H] from a set of states at a time, which is a single number.
pub(crate) struct Step<'a, const N: usize> {
    equations: &'a Equations<'a>,
    /// H, a number.
    pub(crate) length: Ball,
    centre: Expansion<Ball, N>,
    /// The series from all states of the set, with derivatives with respect to them; the last
    /// coefficients are those of order n + 1 over all states passed, and bound the remainder.
    whole: Expansion<Jet<Interval, N>, N>,
    /// For each output the coefficients of its derivative, for the centre and for all states.
    rates: Vec<(Vec<Ball>, Vec<Jet<Interval, N>>)>,
    /// The difference of any state of the set from the centre.
    spread: [Ball; N],
    /// For each output the coefficients of the second and third derivative over the set, the
    /// remainder's as the last.
    higher_derivatives: Vec<[Vec<Interval>; 2]>,
}

/// The remainder of the polynomial is kept below 2^(−38 · limbs).
const REMAINDER_BITS: f64 = 38.0;
/// The most lengths that are tried for a step.
const MOST_TRIALS: u32 = 40;

/// The order of the polynomial, by the number of limbs.
fn order(limbs: usize) -> usize {
    8 + 8 * limbs
}

impl<'a, const N: usize> Step<'a, N> {
    /// A step whose length is chosen here, at most `most`.
    ///
    /// Let P be the Taylor polynomial of order n of the solution from a state x of the set X. If
    /// for a box Y and R, the coefficients of order n + 1 over Y and the times passed, the range of
    /// P over [0, H] with R [0, H]^(n+1) is within Y for every x, then each solution exists on [0,
    /// H], is within Y, and is within P + R τ^(n+1) (Nedialkov and Jackson's enclosure of higher
    /// order; the remainder is Lagrange's). The derivatives by x solve the variational equation,
    /// and are enclosed alike: their coefficients over Y and a box that is proved to hold them.
    pub(crate) fn new(
        equations: &'a Equations<'a>,
        time: &Ball,
        set: &Set<N>,
        most: f64,
    ) -> Result<Self, ProofFailure> {
        let Equations {
            model,
            program,
            few,
            functions,
            ..
        } = equations;
        let n = order(model.limbs);
        let lost = || ProofFailure::undecided("the forces of a taut motion");
        let centre = program.expand(set.centre(), time, n, &model.functions);
        let centre = centre.ok_or_else(lost)?;
        let hull = set.hull();
        let one = Interval::of(&Ball::integer(1));
        let jets = std::array::from_fn(|i| Jet::coordinate(Interval::of(&hull[i]), i, &one));
        let whole = few.expand(&jets, &Jet::constant(&Interval::of(time)), n, functions);
        let whole = whole.ok_or_else(lost)?;
        let spread = std::array::from_fn(|i| &hull[i] - &set.centre()[i]);
        let mut length = likely_length(&centre, model.limbs).min(most);
        for _ in 0..MOST_TRIALS {
            let h = Ball::double(length).with_limbs(model.limbs);
            let wide = enclosed(equations, time, &whole, length);
            let bits = wide.as_ref().map_or(f64::INFINITY, |wide| wide.bits);
            let most_bits = -REMAINDER_BITS * model.limbs as f64;
            let is_little = bits <= most_bits;
            let rest = wide
                .filter(|_| is_little)
                .and_then(|wide| wide.rest(&whole));
            if let Some(rest) = rest {
                let whole = with_last(whole, &rest);
                let outputs = centre.outputs.iter().zip(&whole.outputs);
                let rates = outputs.map(|(centre, whole)| (derivative(centre), derivative(whole)));
                return Ok(Self {
                    equations,
                    length: h,
                    rates: rates.collect(),
                    centre,
                    higher_derivatives: higher_derivatives(&whole),
                    whole,
                    spread,
                });
            }
            // The remainder decreases with the power n + 1 of the length, and a bit faster.
            let over = if is_little {
                f64::INFINITY
            } else {
                (bits - most_bits) / (n + 1) as f64
            };
            length = rounded(length * (-over).exp2().max(0.5));
        }
        Err(ProofFailure::undecided("an enclosure of the taut motion"))
    }

    pub(crate) fn event_function(&self, which: usize) -> EventFunction {
        self.equations.event_functions[which]
    }

    pub(crate) fn limbs(&self) -> usize {
        self.equations.model.limbs
    }

    /// The states of the set after τ in [0, H].
    pub(crate) fn at(&self, tau: &Ball) -> [Ball; N] {
        std::array::from_fn(|i| self.with_spread(&self.centre.state[i], &self.whole.state[i], tau))
    }

    /// The polynomial of the centre with its remainder, plus, by the mean value theorem, the
    /// derivatives over the set times the differences from the centre.
    fn with_spread(&self, centre: &[Ball], whole: &[Jet<Interval, N>], tau: &Ball) -> Ball {
        let slopes = slopes_of(whole, Interval::of(tau)).map(some_ball);
        let pairs = slopes.iter().zip(&self.spread);
        let off = pairs.fold(Ball::zero(), |sum, (slope, off)| sum + slope * off);
        polynomial(centre, whole, tau) + off
    }

    /// The set after the whole step.
    pub(crate) fn end(&self, set: &Set<N>) -> Result<Set<N>, ProofFailure> {
        let h = &self.length;
        let image = self.centre_at(h);
        let over = Interval::of(h);
        let jacobian =
            std::array::from_fn(|i| slopes_of(&self.whole.state[i], over).map(some_ball));
        set.mapped(&image, &jacobian)
    }

    /// The coordinates of the centre after τ in [0, H].
    fn centre_at(&self, tau: &Ball) -> [Ball; N] {
        std::array::from_fn(|i| polynomial(&self.centre.state[i], &self.whole.state[i], tau))
    }

    /// The set after τ in [0, H], each state at an instant τ* of its own within `whole`, at which
    /// the output `which` is zero; `centre` is the instant of the set's centre.
    ///
    /// With q(τ, x) the coordinates and f the output, dq/dx = ∂q/∂x + q̇ dτ*/dx and
    /// dτ*/dx = −(∂f/∂x)/ḟ.
    pub(crate) fn crossed(
        &self,
        which: usize,
        time: &Ball,
        [centre, whole]: [&Ball; 2],
        place: &TwoPrecisions,
    ) -> Option<([Ball; 7], [[Ball; N]; 7])> {
        let rate = Interval::of(&self.event_value(which, whole).rate).reciprocal()?;
        let slope = slopes_of(&self.whole.outputs[which], Interval::of(whole));
        let instant = slope.map(|slope| Interval::zero().minus(&slope.times(&rate)));
        self.moved(time, [centre, whole], instant, place)
    }

    /// The map to the state at an instant τ* and to that instant, from the derivatives of τ*.
    fn moved(
        &self,
        time: &Ball,
        [centre, whole]: [&Ball; 2],
        instant: [Interval; N],
        place: &TwoPrecisions,
    ) -> Option<([Ball; 7], [[Ball; N]; 7])> {
        let over = Interval::of(whole);
        let at = self.at(whole);
        let jets: [Jet<Interval, N>; N] = std::array::from_fn(|i| {
            let series: Vec<Interval> = self.whole.state[i].iter().map(|jet| jet.value).collect();
            let speed = value_of(&derivative(&series), over);
            let slopes = slopes_of(&self.whole.state[i], over);
            Jet {
                value: Interval::of(&at[i]),
                slopes: std::array::from_fn(|j| slopes[j].plus(&speed.times(&instant[j]))),
            }
        });
        let jets = place.few.evaluate(&jets, &self.equations.functions)?;
        let mean = self.centre_at(centre);
        let state = place
            .exact
            .evaluate::<Ball, N>(&mean, &self.equations.model.functions)?;
        let mut image = state.into_iter().chain([time + centre]);
        let mut rows = jets.iter().map(|jet| jet.slopes).chain([instant]);
        let image = std::array::from_fn(|_| image.next().unwrap_or_else(Ball::zero));
        let rows = std::array::from_fn(|_| rows.next().unwrap_or([Interval::zero(); N]));
        Some((image, rows.map(|row| row.map(some_ball))))
    }

    /// The set after a time τ that does not depend on the state.
    pub(crate) fn at_time(
        &self,
        time: &Ball,
        tau: &Ball,
        place: &TwoPrecisions,
        set: &Set<N>,
    ) -> Result<Set<7>, ProofFailure> {
        let fixed = [Interval::zero(); N];
        let lost = || ProofFailure::undecided("the state at the end of time");
        let (image, jacobian) = self
            .moved(time, [tau, tau], fixed, place)
            .ok_or_else(lost)?;
        set.mapped(&image, &jacobian)
    }

    /// A event function of the centre after τ.
    pub(crate) fn centre_value(&self, which: usize, tau: &Ball) -> Ball {
        polynomial(&self.centre.outputs[which], &self.whole.outputs[which], tau)
    }
}

/// Σ c_k τ^k of the centre, and R τ^(n+1) with the last coefficient of all states.
fn polynomial<const N: usize>(centre: &[Ball], whole: &[Jet<Interval, N>], tau: &Ball) -> Ball {
    let rest = whole.last().map_or_else(Interval::zero, |jet| jet.value);
    horner(centre, tau) + some_ball(rest) * power(tau, centre.len())
}

/// τ^n.
fn power(tau: &Ball, n: usize) -> Ball {
    (1..n).fold(tau.clone(), |power, _| power * tau)
}

/// The derivatives of a polynomial at τ by the coordinates at the start.
pub(super) fn slopes_of<const N: usize>(
    whole: &[Jet<Interval, N>],
    tau: Interval,
) -> [Interval; N] {
    std::array::from_fn(|j| {
        let slopes: Vec<Interval> = whole.iter().map(|jet| jet.slopes[j]).collect();
        value_of(&slopes, tau)
    })
}

/// A ball that contains an interval. For an unbounded interval the ball is so large that every
/// product with it, unless the factor is exactly zero, has an undecided sign.
pub(crate) fn some_ball(interval: Interval) -> Ball {
    let endless = || Ball::within(Radius::power_of_two(1 << 20));
    interval.ball().unwrap_or_else(endless)
}

fn higher_derivatives<const N: usize>(
    whole: &Expansion<Jet<Interval, N>, N>,
) -> Vec<[Vec<Interval>; 2]> {
    let all = whole.outputs.iter().map(|series| {
        let value: Vec<Interval> = series.iter().map(|jet| jet.value).collect();
        let second = derivative(&derivative(&value));
        let third = derivative(&second);
        [second, third]
    });
    all.collect()
}

/// A polynomial with one more coefficient, the last of another.
fn with_last<S: Scalar, const N: usize>(
    mut series: Expansion<S, N>,
    rest: &Expansion<S, N>,
) -> Expansion<S, N> {
    let outputs = series.outputs.iter_mut().zip(&rest.outputs);
    for (series, rest) in series.state.iter_mut().zip(&rest.state).chain(outputs) {
        series.extend(rest.last().cloned());
    }
    series
}

/// An output f is a function of the solution, so that f is its own polynomial with the coefficient
/// of order n + 1 taken over Y, and a derivative of f that polynomial's derivative: that of order d
/// has as its Lagrange remainder the derivative of order n + 1 of f, over Y, divided by (n + 1 −
/// d)!.
impl<const N: usize> Path for Step<'_, N> {
    fn count(&self) -> usize {
        self.higher_derivatives.len()
    }

    fn event_name(&self, which: usize) -> String {
        self.equations.event_functions[which].event_name()
    }

    fn event_value(&self, which: usize, tau: &Ball) -> EventValue {
        let (centre, whole) = (&self.centre.outputs[which], &self.whole.outputs[which]);
        let (centre_rates, rates) = &self.rates[which];
        EventValue {
            value: self.with_spread(centre, whole, tau),
            rate: self.with_spread(centre_rates, rates, tau),
        }
    }

    fn second_derivatives(&self, middle: &Ball, half: Radius) -> Vec<Ball> {
        let over = Interval::of(&middle.clone().widened(half));
        let higher_derivatives = self.higher_derivatives.iter();
        higher_derivatives
            .map(|[second, _]| some_ball(value_of(second, over)))
            .collect()
    }

    fn third(&self, which: usize, middle: &Ball, half: Radius) -> Option<Ball> {
        let over = Interval::of(&middle.clone().widened(half));
        let [_, third] = &self.higher_derivatives[which];
        Some(some_ball(value_of(third, over)))
    }
}

/// Σ c_k τ^k.
fn horner(coefficients: &[Ball], tau: &Ball) -> Ball {
    let series = coefficients.iter().rev();
    series.fold(Ball::zero(), |sum, next| sum * tau + next)
}

/// Σ c_k τ^k.
pub(super) fn value_of(coefficients: &[Interval], tau: Interval) -> Interval {
    let series = coefficients.iter().rev();
    series.fold(Interval::zero(), |sum, next| sum.times(&tau).plus(next))
}

fn derivative<S: Scalar>(coefficients: &[S]) -> Vec<S> {
    let terms = coefficients.iter().enumerate().skip(1);
    terms.map(|(k, c)| c.times_small(k as u32)).collect()
}

/// A length at which the last terms of the polynomial are as small as the precision requires.
fn likely_length<const N: usize>(centre: &Expansion<Ball, N>, limbs: usize) -> f64 {
    let bits = REMAINDER_BITS * limbs as f64;
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

/// The length rounded to a double of few bits, so that sums of times stay short.
fn rounded(length: f64) -> f64 {
    let unit = (length.log2().floor() - 6.0).exp2();
    (length / unit).floor() * unit
}
