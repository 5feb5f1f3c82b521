//! What one step of a run does to small deviations: a linear map, and how it acts on one or on many
//! of them.
//!
//! Deviations are told at the events, as (w, τ): see [`crate::motion::tangent`], which makes these
//! maps.

/// ∂z/∂z, rows by what changes: 6 × 6, order x, y, θ, ẋ, ẏ, θ̇.
pub type Matrix = [[f64; 6]; 6];

/// A deviation (w, τ): six of the state, and the time.
pub type Deviation = [f64; 7];

/// Deviations side by side: a row for each of their seven components, a column for each of them, so
/// that one operation does them all.
pub(crate) type Block<const M: usize> = [[f64; M]; 7];

/// One step of the linearised motion.
#[derive(Clone, Copy, Debug)]
pub struct StepMap {
    pub(super) flow: Flow,
    /// ż₋ − Φ ż₊.
    pub(super) lag: [f64; 6],
    /// ż₋.
    pub(super) rate: [f64; 6],
    /// −∇h/ḣ; zero without an event.
    pub(super) delay: [f64; 6],
    /// Rows of R' that belong to the velocities; none without an impact.
    pub(super) law: Option<[[f64; 6]; 3]>,
    /// ż after the event.
    pub(super) rate_after: [f64; 6],
}

/// Φ along a stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow {
    /// How long it is.
    pub(super) s: f64,
    /// Φ where velocities change by the state: with taut cables, or drag. Else positions drift with
    /// the velocities.
    pub(super) driven: Option<Matrix>,
}

impl Flow {
    #[inline(always)]
    pub(super) fn carry<const M: usize>(&self, block: &mut Block<M>) {
        match &self.driven {
            None => {
                for i in 0..3 {
                    add_row(block, i, &block[i + 3].clone(), self.s);
                }
            }
            Some(phi) => {
                let moved = phi.map(|row| combined(block, &row));
                block[..6].copy_from_slice(&moved);
            }
        }
    }
}

impl StepMap {
    /// Along the stretch: (w, τ) just before the event, told at the previous event's time.
    pub fn along(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_along(block))
    }

    /// To the event's own time.
    pub fn meet(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_to_meet(block))
    }

    /// Through the law of the event.
    #[inline(always)]
    pub fn through(&self, deviation: &Deviation) -> Deviation {
        single(deviation, |block| self.carry_through(block))
    }

    /// [`StepMap::along`] of many.
    #[inline(always)]
    pub(crate) fn carry_along<const M: usize>(&self, block: &mut Block<M>) {
        self.flow.carry(block);
        let tau = block[6];
        for (i, lag) in self.lag.iter().enumerate() {
            add_row(block, i, &tau, *lag);
        }
    }

    /// [`StepMap::meet`] of many.
    #[inline(always)]
    pub(crate) fn carry_to_meet<const M: usize>(&self, block: &mut Block<M>) {
        let later = combined(block, &self.delay);
        for (i, rate) in self.rate.iter().enumerate() {
            add_row(block, i, &later, *rate);
        }
        add_row(block, 6, &later, 1.0);
    }

    /// [`StepMap::through`] of many.
    #[inline(always)]
    pub(crate) fn carry_through<const M: usize>(&self, block: &mut Block<M>) {
        if let Some(law) = &self.law {
            let mut velocities = [[0.0; M]; 3];
            for (velocity, row) in velocities.iter_mut().zip(law) {
                *velocity = combined(block, row);
            }
            block[3..6].copy_from_slice(&velocities);
        }
    }

    /// All of the step for many deviations at one time, at its start and at its end.
    #[inline(always)]
    pub(crate) fn carry_at_one_time<const M: usize>(&self, block: &mut Block<M>) {
        block[6] = [0.0; M];
        self.carry_along(block);
        self.carry_to_meet(block);
        self.carry_through(block);
        let tau = block[6];
        for (i, rate) in self.rate_after.iter().enumerate() {
            add_row(block, i, &tau, -rate);
        }
    }

    /// What [`StepMap::meet`] undoes: the deviation told at the previous event's time, when τ was
    /// `tau`.
    pub(crate) fn before_meeting(&self, deviation: &Deviation, tau: f64) -> Deviation {
        let (w, now) = split(deviation);
        join(&add_scaled(&w, &self.rate, tau - now), tau)
    }

    /// The deviation at one time, of one that is told at the event at the end of the step.
    pub fn at_one_time(&self, deviation: &Deviation) -> [f64; 6] {
        let (w, tau) = split(deviation);
        add_scaled(&w, &self.rate_after, -tau)
    }

    /// All of the step for a deviation at one time, at its start and at its end.
    pub fn fundamental(&self, deviation: &[f64; 6]) -> [f64; 6] {
        let end = single(&join(deviation, 0.0), |block| self.carry_at_one_time(block));
        split(&end).0
    }

    /// −∇h/ḣ: how much later the event comes for a deviation just before it.
    pub fn delay(&self) -> &[f64; 6] {
        &self.delay
    }

    /// The square of the length of (ż₊ − R' ż₋) ∇h/ḣ: by how much a deviation can grow because the event comes at
    /// another time.
    #[inline(always)]
    pub(crate) fn magnification_squared(&self) -> f64 {
        let through = self.through(&join(&self.rate, 0.0));
        let jump = add_scaled(&self.rate_after, &split(&through).0, -1.0);
        dot6(&jump, &jump) * dot6(&self.delay, &self.delay)
    }

    /// The derivatives of the velocities after an impact by the state before it.
    pub(crate) fn slopes_of_law(&self) -> Option<&[[f64; 6]; 3]> {
        self.law.as_ref()
    }

    /// ż just before the event.
    pub fn rate(&self) -> &[f64; 6] {
        &self.rate
    }

    /// Whether the step ends with an impact.
    pub fn has_impact(&self) -> bool {
        self.law.is_some()
    }
}

/// Adds to a row of a block.
#[inline(always)]
fn add_row<const M: usize>(block: &mut Block<M>, to: usize, row: &[f64; M], factor: f64) {
    for (sum, entry) in block[to].iter_mut().zip(row) {
        *sum += factor * entry;
    }
}

/// A linear function of the state, of every deviation.
#[inline(always)]
pub(crate) fn combined<const M: usize>(block: &Block<M>, factors: &[f64; 6]) -> [f64; M] {
    let mut sum = [0.0; M];
    for (row, factor) in block.iter().zip(factors) {
        for (sum, entry) in sum.iter_mut().zip(row) {
            *sum += factor * entry;
        }
    }
    sum
}

/// An operation on blocks, on one deviation.
#[inline(always)]
pub(super) fn single(deviation: &Deviation, carry: impl Fn(&mut Block<1>)) -> Deviation {
    let mut block = deviation.map(|component| [component]);
    carry(&mut block);
    block.map(|[component]| component)
}

#[inline(always)]
pub(super) fn add_scaled(a: &[f64; 6], b: &[f64; 6], scale: f64) -> [f64; 6] {
    let mut sum = *a;
    for (sum, b) in sum.iter_mut().zip(b) {
        *sum += b * scale;
    }
    sum
}

#[inline(always)]
pub(super) fn split(deviation: &Deviation) -> ([f64; 6], f64) {
    let [x, y, theta, vx, vy, vtheta, tau] = *deviation;
    ([x, y, theta, vx, vy, vtheta], tau)
}

#[inline(always)]
pub(super) fn join(w: &[f64; 6], tau: f64) -> Deviation {
    [w[0], w[1], w[2], w[3], w[4], w[5], tau]
}

#[inline(always)]
pub(crate) fn dot6(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
