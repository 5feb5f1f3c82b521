//! Taylor coefficients of a motion, order by order: a list of operations on power series, evaluated
//! over balls or intervals, with or without derivatives with respect to the initial state.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::elementary::Elementary;
use crate::arithmetic::scalar::Scalar;

/// The index of a series in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Term(usize);

enum Operation<C> {
    Coordinate(usize),
    Constant(C),
    /// Ωt, with t the time since the beginning.
    Phase(C),
    Add(Term, Term),
    Subtract(Term, Term),
    Multiply(Term, Term),
    Scale(Term, C),
    Reciprocal(Term),
    Root(Term),
    /// Its cosine is the next in the list.
    Sine(Term),
    Cosine(Term),
}

/// A system of differential equations and the quantities that are evaluated along its motion.
pub(crate) struct Program<C = Ball> {
    operations: Vec<Operation<C>>,
    /// The derivatives of the coordinates by time.
    pub(crate) rates: Vec<Term>,
    /// The event functions.
    pub(crate) outputs: Vec<Term>,
}

impl Program<Ball> {
    pub(crate) fn new() -> Self {
        Self {
            operations: Vec::new(),
            rates: Vec::new(),
            outputs: Vec::new(),
        }
    }

    fn push(&mut self, operation: Operation<Ball>) -> Term {
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
    pub(crate) fn root(&mut self, a: Term) -> Term {
        self.push(Operation::Root(a))
    }
    pub(crate) fn negate(&mut self, a: Term) -> Term {
        self.scale(a, Ball::integer(-1))
    }
    pub(crate) fn dot(&mut self, a: [Term; 2], b: [Term; 2]) -> Term {
        let [x, y] = [self.multiply(a[0], b[0]), self.multiply(a[1], b[1])];
        self.add(x, y)
    }
    pub(crate) fn sum(&mut self, a: [Term; 2], b: [Term; 2]) -> [Term; 2] {
        [self.add(a[0], b[0]), self.add(a[1], b[1])]
    }
    pub(crate) fn difference(&mut self, a: [Term; 2], b: [Term; 2]) -> [Term; 2] {
        [self.subtract(a[0], b[0]), self.subtract(a[1], b[1])]
    }
    pub(crate) fn times(&mut self, a: [Term; 2], by: Term) -> [Term; 2] {
        a.map(|term| self.multiply(term, by))
    }
    pub(crate) fn sin_cos(&mut self, a: Term) -> (Term, Term) {
        let sine = self.push(Operation::Sine(a));
        (sine, self.push(Operation::Cosine(a)))
    }

    /// The same program with its constants in another number type.
    pub(crate) fn map<C>(&self, number: impl Fn(&Ball) -> C) -> Program<C> {
        let operations = self.operations.iter().map(|operation| match operation {
            Operation::Coordinate(which) => Operation::Coordinate(*which),
            Operation::Constant(ball) => Operation::Constant(number(ball)),
            Operation::Phase(ball) => Operation::Phase(number(ball)),
            Operation::Add(a, b) => Operation::Add(*a, *b),
            Operation::Subtract(a, b) => Operation::Subtract(*a, *b),
            Operation::Multiply(a, b) => Operation::Multiply(*a, *b),
            Operation::Scale(a, ball) => Operation::Scale(*a, number(ball)),
            Operation::Reciprocal(a) => Operation::Reciprocal(*a),
            Operation::Root(a) => Operation::Root(*a),
            Operation::Sine(a) => Operation::Sine(*a),
            Operation::Cosine(a) => Operation::Cosine(*a),
        });
        Program {
            operations: operations.collect(),
            rates: self.rates.clone(),
            outputs: self.outputs.clone(),
        }
    }
}

impl<C: Clone> Program<C> {
    /// All series up to an order; none where a divisor may be zero. Each coefficient follows from
    /// those before it:
    ///
    /// (ab)_k = Σ a_i b_{k−i},   (1/a)_k = −(1/a)_0 Σ_{i≥1} a_i (1/a)_{k−i},
    /// (√a)_k = (a_k − Σ_{0<i<k} (√a)_i (√a)_{k−i})/(2 (√a)_0),
    /// (sin a)_k = Σ i a_i (cos a)_{k−i}/k,   (cos a)_k = −Σ i a_i (sin a)_{k−i}/k,
    ///
    /// and a coordinate's coefficient from that of its rate, y_k = ẏ_{k−1}/k.
    pub(crate) fn expand<S: Scalar<Constant = C>, const N: usize>(
        &self,
        start: &[S; N],
        time: &S,
        order: usize,
        functions: &Elementary,
    ) -> Option<Expansion<S, N>> {
        let mut list: Vec<Vec<S>> = self.operations.iter().map(|_| Vec::new()).collect();
        let mut state: [Vec<S>; N] = std::array::from_fn(|j| vec![start[j].clone()]);
        for k in 0..=order {
            if k > 0 {
                for (series, rate) in state.iter_mut().zip(&self.rates) {
                    series.push(list[rate.0][k - 1].over_small(k as u32));
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

    /// The outputs at given coordinates, which are taken as constant.
    pub(crate) fn evaluate<S: Scalar<Constant = C>, const N: usize>(
        &self,
        start: &[S; N],
        functions: &Elementary,
    ) -> Option<Vec<S>> {
        let found = self.expand(start, &S::zero(), 0, functions)?;
        let outputs = found.outputs.into_iter();
        outputs.map(|series| series.into_iter().next()).collect()
    }

    fn coefficient<S: Scalar<Constant = C>, const N: usize>(
        &self,
        at: usize,
        k: usize,
        list: &[Vec<S>],
        state: &[Vec<S>; N],
        time: &S,
        functions: &Elementary,
    ) -> Option<S> {
        let product = |a: &[S], b: &[S]| {
            let pairs = a.iter().zip(b.iter().rev());
            pairs
                .filter(|(a, b)| !(a.is_exact_zero() || b.is_exact_zero()))
                .map(|(a, b)| a.times(b))
                .reduce(|sum, term| sum.plus(&term))
                .unwrap_or_else(S::zero)
        };
        // Σ i a_i b_{k−i}/k.
        let angle_sum = |angle: Term, other: usize| {
            let a = list[angle.0][1..=k].iter().enumerate();
            let terms = a
                .filter(|(_, a)| !a.is_exact_zero())
                .map(|(i, a)| a.times_small(i as u32 + 1).times(&list[other][k - i - 1]));
            let sum = terms.reduce(|sum, term| sum.plus(&term));
            sum.unwrap_or_else(S::zero).over_small(k as u32)
        };
        Some(match &self.operations[at] {
            Operation::Coordinate(which) => state[*which][k].clone(),
            Operation::Constant(constant) if k == 0 => S::constant(constant),
            Operation::Phase(omega) if k == 0 => time.scaled(omega),
            Operation::Phase(omega) if k == 1 => S::constant(omega),
            Operation::Constant(_) | Operation::Phase(_) => S::zero(),
            Operation::Add(a, b) => list[a.0][k].plus(&list[b.0][k]),
            Operation::Subtract(a, b) => list[a.0][k].minus(&list[b.0][k]),
            Operation::Scale(a, by) => list[a.0][k].scaled(by),
            Operation::Multiply(a, b) => product(&list[a.0], &list[b.0]),
            Operation::Reciprocal(a) if k == 0 => list[a.0][0].reciprocal()?,
            Operation::Reciprocal(a) => {
                let sum = product(&list[a.0][1..], &list[at]);
                S::zero().minus(&sum.times(&list[at][0]))
            }
            Operation::Root(a) if k == 0 => list[a.0][0].sqrt()?,
            Operation::Root(a) => {
                let sum = product(&list[at][1..], &list[at][1..]);
                let inverse = list[at][0].reciprocal()?;
                list[a.0][k].minus(&sum).times(&inverse).over_small(2)
            }
            Operation::Sine(a) if k == 0 => list[a.0][0].sin_cos(functions)?.0,
            Operation::Cosine(a) if k == 0 => list[a.0][0].sin_cos(functions)?.1,
            Operation::Sine(a) => angle_sum(*a, at + 1),
            Operation::Cosine(a) => S::zero().minus(&angle_sum(*a, at - 1)),
        })
    }
}

/// Power series of a motion.
pub(crate) struct Expansion<S, const N: usize> {
    pub(crate) state: [Vec<S>; N],
    pub(crate) outputs: Vec<Vec<S>>,
}
