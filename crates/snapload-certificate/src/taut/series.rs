//! Taylor coefficients of a motion, order by order: a list of operations on power series, evaluated
//! over balls, or over balls with their derivatives by the state at the begin.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::elementary::Elementary;

/// Coordinates of taut motion with one cable: φ, θ and their rates.
pub(crate) const DIMENSION: usize = 4;

/// Numbers that power series are made of.
pub(crate) trait Scalar: Clone {
    /// A number that does not depend on the state.
    fn constant(ball: Ball) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, by: &Ball) -> Self;
    fn over_small(&self, divisor: u64) -> Self;
    fn reciprocal(&self) -> Option<Self>;
    fn sin_cos(&self, functions: &Elementary) -> (Self, Self);
}

impl Scalar for Ball {
    fn constant(ball: Ball) -> Self {
        ball
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn scaled(&self, by: &Ball) -> Self {
        self * by
    }
    fn over_small(&self, divisor: u64) -> Self {
        Self::over_small(self, divisor)
    }
    fn reciprocal(&self) -> Option<Self> {
        Self::reciprocal(self)
    }
    fn sin_cos(&self, functions: &Elementary) -> (Self, Self) {
        functions.sin_cos(self)
    }
}

/// A ball with its derivatives by the four coordinates at the begin.
#[derive(Clone, Debug)]
pub(crate) struct Jet {
    pub(crate) value: Ball,
    pub(crate) slopes: [Ball; DIMENSION],
}

impl Jet {
    /// A coordinate at the begin.
    pub(crate) fn coordinate(value: Ball, which: usize) -> Self {
        let slopes = std::array::from_fn(|i| Ball::integer(i64::from(i == which)));
        Self { value, slopes }
    }

    fn with(value: Ball, slope: impl Fn(usize) -> Ball) -> Self {
        let slopes = std::array::from_fn(slope);
        Self { value, slopes }
    }
}

impl Scalar for Jet {
    fn constant(ball: Ball) -> Self {
        Self::with(ball, |_| Ball::zero())
    }
    fn plus(&self, other: &Self) -> Self {
        Self::with(&self.value + &other.value, |i| {
            &self.slopes[i] + &other.slopes[i]
        })
    }
    fn minus(&self, other: &Self) -> Self {
        Self::with(&self.value - &other.value, |i| {
            &self.slopes[i] - &other.slopes[i]
        })
    }
    fn times(&self, other: &Self) -> Self {
        Self::with(&self.value * &other.value, |i| {
            &self.slopes[i] * &other.value + &self.value * &other.slopes[i]
        })
    }
    fn scaled(&self, by: &Ball) -> Self {
        Self::with(&self.value * by, |i| &self.slopes[i] * by)
    }
    fn over_small(&self, divisor: u64) -> Self {
        Self::with(self.value.over_small(divisor), |i| {
            self.slopes[i].over_small(divisor)
        })
    }
    fn reciprocal(&self) -> Option<Self> {
        let inverse = self.value.reciprocal()?;
        let slope = -inverse.squared();
        Some(Self::with(inverse, |i| &slope * &self.slopes[i]))
    }
    fn sin_cos(&self, functions: &Elementary) -> (Self, Self) {
        let (sine, cosine) = functions.sin_cos(&self.value);
        let first = Self::with(sine.clone(), |i| &cosine * &self.slopes[i]);
        let second = Self::with(cosine.clone(), |i| -(&sine * &self.slopes[i]));
        (first, second)
    }
}

/// The place of a series in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Term(usize);

enum Operation {
    Coordinate(usize),
    Constant(Ball),
    /// Ωt, of the time since the begin.
    Phase(Ball),
    Add(Term, Term),
    Subtract(Term, Term),
    Multiply(Term, Term),
    Scale(Term, Ball),
    Reciprocal(Term),
    /// Its cosine is the next in the list.
    Sine(Term),
    Cosine(Term),
}

/// A system of differential equations and what is to be known along its motion.
pub(crate) struct Program {
    operations: Vec<Operation>,
    /// The derivatives of the coordinates by time.
    pub(crate) rates: Vec<Term>,
    /// What is watched.
    pub(crate) outputs: Vec<Term>,
}

impl Program {
    pub(crate) fn new() -> Self {
        Self {
            operations: Vec::new(),
            rates: Vec::new(),
            outputs: Vec::new(),
        }
    }

    fn push(&mut self, operation: Operation) -> Term {
        self.operations.push(operation);
        Term(self.operations.len() - 1)
    }

    pub(crate) fn coordinate(&mut self, which: usize) -> Term {
        self.push(Operation::Coordinate(which))
    }
    pub(crate) fn constant(&mut self, ball: Ball) -> Term {
        self.push(Operation::Constant(ball))
    }
    pub(crate) fn phase(&mut self, omega: Ball) -> Term {
        self.push(Operation::Phase(omega))
    }
    pub(crate) fn add(&mut self, a: Term, b: Term) -> Term {
        self.push(Operation::Add(a, b))
    }
    pub(crate) fn subtract(&mut self, a: Term, b: Term) -> Term {
        self.push(Operation::Subtract(a, b))
    }
    pub(crate) fn multiply(&mut self, a: Term, b: Term) -> Term {
        self.push(Operation::Multiply(a, b))
    }
    pub(crate) fn scale(&mut self, a: Term, by: Ball) -> Term {
        self.push(Operation::Scale(a, by))
    }
    pub(crate) fn reciprocal(&mut self, a: Term) -> Term {
        self.push(Operation::Reciprocal(a))
    }
    pub(crate) fn sin_cos(&mut self, a: Term) -> (Term, Term) {
        let sine = self.push(Operation::Sine(a));
        (sine, self.push(Operation::Cosine(a)))
    }

    /// All series up to an order; none where something is divided by zero. Each coefficient follows
    /// from those before it:
    ///
    /// (ab)_k = Σ a_i b_{k−i},   (1/a)_k = −(1/a)_0 Σ_{i≥1} a_i (1/a)_{k−i},
    /// (sin a)_k = Σ i a_i (cos a)_{k−i}/k,   (cos a)_k = −Σ i a_i (sin a)_{k−i}/k,
    ///
    /// and a coordinate's from its rate, y_k = ẏ_{k−1}/k.
    pub(crate) fn expand<S: Scalar>(
        &self,
        begin: &[S; DIMENSION],
        time: &Ball,
        order: usize,
        functions: &Elementary,
    ) -> Option<Expansion<S>> {
        let mut list: Vec<Vec<S>> = self.operations.iter().map(|_| Vec::new()).collect();
        let mut state: [Vec<S>; DIMENSION] = std::array::from_fn(|j| vec![begin[j].clone()]);
        for k in 0..=order {
            if k > 0 {
                for (series, rate) in state.iter_mut().zip(&self.rates) {
                    series.push(list[rate.0][k - 1].over_small(k as u64));
                }
            }
            for at in 0..self.operations.len() {
                let next = self.coefficient(at, k, &list, &state, time, functions)?;
                list[at].push(next);
            }
        }
        let outputs = self
            .outputs
            .iter()
            .map(|term| list[term.0].clone())
            .collect();
        Some(Expansion { state, outputs })
    }

    fn coefficient<S: Scalar>(
        &self,
        at: usize,
        k: usize,
        list: &[Vec<S>],
        state: &[Vec<S>; DIMENSION],
        time: &Ball,
        functions: &Elementary,
    ) -> Option<S> {
        let zero = || S::constant(Ball::zero());
        let angle_sum = |angle: Term, other: usize| {
            let terms = (1..=k).map(|i| {
                let part = list[angle.0][i].times(&list[other][k - i]);
                part.scaled(&Ball::integer(i as i64))
            });
            let sum = terms.reduce(|sum, term| sum.plus(&term));
            sum.unwrap_or_else(zero).over_small(k as u64)
        };
        Some(match &self.operations[at] {
            Operation::Coordinate(which) => state[*which][k].clone(),
            Operation::Constant(ball) if k == 0 => S::constant(ball.clone()),
            Operation::Phase(omega) if k == 0 => S::constant(omega * time),
            Operation::Phase(omega) if k == 1 => S::constant(omega.clone()),
            Operation::Constant(_) | Operation::Phase(_) => zero(),
            Operation::Add(a, b) => list[a.0][k].plus(&list[b.0][k]),
            Operation::Subtract(a, b) => list[a.0][k].minus(&list[b.0][k]),
            Operation::Scale(a, by) => list[a.0][k].scaled(by),
            Operation::Multiply(a, b) => {
                let terms = (0..=k).map(|i| list[a.0][i].times(&list[b.0][k - i]));
                terms
                    .reduce(|sum, term| sum.plus(&term))
                    .unwrap_or_else(zero)
            }
            Operation::Reciprocal(a) if k == 0 => list[a.0][0].reciprocal()?,
            Operation::Reciprocal(a) => {
                let terms = (1..=k).map(|i| list[a.0][i].times(&list[at][k - i]));
                let sum = terms
                    .reduce(|sum, term| sum.plus(&term))
                    .unwrap_or_else(zero);
                zero().minus(&sum.times(&list[at][0]))
            }
            Operation::Sine(a) if k == 0 => list[a.0][0].sin_cos(functions).0,
            Operation::Cosine(a) if k == 0 => list[a.0][0].sin_cos(functions).1,
            Operation::Sine(a) => angle_sum(*a, at + 1),
            Operation::Cosine(a) => zero().minus(&angle_sum(*a, at - 1)),
        })
    }
}

/// Power series of a motion.
pub(crate) struct Expansion<S> {
    pub(crate) state: [Vec<S>; DIMENSION],
    pub(crate) outputs: Vec<Vec<S>>,
}
