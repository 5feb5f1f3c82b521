//! The effect of one step of a run on small deviations: a linear map, and its application to one or
//! many of them.
//!
//! Deviations are given at the events, as (w, τ): see [`crate::motion::tangent`], which makes these
//! maps. For a floating body the deviations of the water's memory are additional rows, which other
//! bodies do not have.

use crate::motion::water_flow::WaterFlow;

/// ∂z/∂z, rows by what changes: 6 × 6, order x, y, θ, ẋ, ẏ, θ̇.
pub type Matrix = [[f64; 6]; 6];

/// A deviation (w, τ): six of the state, and the time.
pub type Deviation = [f64; 7];

/// Deviations side by side: a row for each of their seven components, a column for each deviation,
/// so that one operation acts on all of them.
pub(crate) type Block<const M: usize> = [[f64; M]; 7];

/// One step of the linearised motion.
#[derive(Clone, Debug)]
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
    /// The rates of the water's memory, if the body floats.
    pub(super) memory: Option<Box<MemoryRates>>,
}

/// The rates of each state of the water's memory, real and imaginary part in turn.
#[derive(Clone, Debug)]
pub(super) struct MemoryRates {
    /// ż₋ − Φ ż₊.
    pub(super) lag: Vec<f64>,
    /// ż₋.
    pub(super) rate: Vec<f64>,
    /// ż after the event.
    pub(super) rate_after: Vec<f64>,
}

/// Φ along a stretch.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    /// How long it is.
    pub(super) s: f64,
    /// Φ where accelerations depend on the state: with taut cables, or drag. None where positions
    /// only drift with the velocities.
    pub(super) driven: Option<Matrix>,
    /// Φ of a floating body.
    pub(super) water: Option<Box<WaterFlow>>,
}

impl Flow {
    #[inline(always)]
    pub(super) fn carry<const M: usize>(&self, block: &mut Block<M>, memory: &mut [[f64; M]]) {
        if let Some(water) = &self.water {
            water.carry(block, memory);
            return;
        }
        match &self.driven {
            None => {
                for i in 0..3 {
                    add_row(block, i, &block[i + 3].clone(), self.s);
                }
            }
            Some(phi) => {
                let mut moved = [[0.0; M]; 6];
                for (moved, row) in moved.iter_mut().zip(phi) {
                    *moved = combined(block, row);
                }
                block[..6].copy_from_slice(&moved);
            }
        }
    }
}

impl StepMap {
    /// Along the stretch: (w, τ) just before the event, at the previous event's time.
    pub fn along(&self, deviation: &Deviation) -> Deviation {
        self.single(deviation, |block, memory| self.carry_along(block, memory))
    }

    /// To the event's own time.
    pub fn meet(&self, deviation: &Deviation) -> Deviation {
        self.single(deviation, |block, memory| self.carry_to_meet(block, memory))
    }

    /// Through the law of the event.
    #[inline(always)]
    pub fn through(&self, deviation: &Deviation) -> Deviation {
        self.single(deviation, |block, _| self.carry_through(block))
    }

    /// [`StepMap::along`] for many deviations.
    #[inline(always)]
    pub(crate) fn carry_along<const M: usize>(
        &self,
        block: &mut Block<M>,
        memory: &mut [[f64; M]],
    ) {
        self.flow.carry(block, memory);
        let tau = block[6];
        for (i, lag) in self.lag.iter().enumerate() {
            add_row(block, i, &tau, *lag);
        }
        if let Some(rates) = &self.memory {
            add_rows(memory, &rates.lag, &tau, 1.0);
        }
    }

    /// [`StepMap::meet`] for many deviations.
    #[inline(always)]
    pub(crate) fn carry_to_meet<const M: usize>(
        &self,
        block: &mut Block<M>,
        memory: &mut [[f64; M]],
    ) {
        let later = combined(block, &self.delay);
        for (i, rate) in self.rate.iter().enumerate() {
            add_row(block, i, &later, *rate);
        }
        add_row(block, 6, &later, 1.0);
        if let Some(rates) = &self.memory {
            add_rows(memory, &rates.rate, &later, 1.0);
        }
    }

    /// [`StepMap::through`] for many deviations; an impact does not change the memory.
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

    /// The whole step for many deviations, each at one common time at its start and at its end.
    #[inline(always)]
    pub(crate) fn carry_at_one_time<const M: usize>(
        &self,
        block: &mut Block<M>,
        memory: &mut [[f64; M]],
    ) {
        block[6] = [0.0; M];
        self.carry_along(block, memory);
        self.carry_to_meet(block, memory);
        self.carry_through(block);
        let tau = block[6];
        for (i, rate) in self.rate_after.iter().enumerate() {
            add_row(block, i, &tau, -rate);
        }
        if let Some(rates) = &self.memory {
            add_rows(memory, &rates.rate_after, &tau, -1.0);
        }
    }

    /// The inverse of [`StepMap::meet`]: the deviation at the previous event's time, when τ was
    /// `tau`.
    pub(crate) fn before_meeting(&self, deviation: &Deviation, tau: f64) -> Deviation {
        let (w, now) = split(deviation);
        join(&add_scaled(&w, &self.rate, tau - now), tau)
    }

    /// The deviation at one common time that corresponds to a deviation at the event at the end of
    /// the step.
    pub fn at_one_time(&self, deviation: &Deviation) -> [f64; 6] {
        let (w, tau) = split(deviation);
        add_scaled(&w, &self.rate_after, -tau)
    }

    /// The whole step for a deviation at one common time at its start and at its end. For a
    /// floating body the water's memory has no deviation at the start.
    pub fn fundamental(&self, deviation: &[f64; 6]) -> [f64; 6] {
        self.fundamental_with_memory(deviation, &mut vec![0.0; self.memory_rows()])
    }

    /// The same with a deviation of the water's memory, real and imaginary part of each state in
    /// turn.
    pub fn fundamental_with_memory(&self, deviation: &[f64; 6], memory: &mut [f64]) -> [f64; 6] {
        let mut block = join(deviation, 0.0).map(|component| [component]);
        let mut rows: Vec<[f64; 1]> = memory.iter().map(|component| [*component]).collect();
        self.carry_at_one_time(&mut block, &mut rows);
        for (component, [row]) in memory.iter_mut().zip(rows) {
            *component = row;
        }
        split(&block.map(|[component]| component)).0
    }

    /// The number of rows of the water's memory: two for each of its states.
    pub(crate) fn memory_rows(&self) -> usize {
        self.memory.as_ref().map_or(0, |rates| rates.rate.len())
    }

    /// ż of the water's memory just before the event.
    pub(crate) fn memory_rate(&self) -> &[f64] {
        self.memory.as_ref().map_or(&[], |rates| &rates.rate)
    }

    /// Applies an operation on blocks to one deviation, without the water's memory.
    #[inline(always)]
    fn single(
        &self,
        deviation: &Deviation,
        carry: impl Fn(&mut Block<1>, &mut [[f64; 1]]),
    ) -> Deviation {
        let mut block = deviation.map(|component| [component]);
        carry(&mut block, &mut vec![[0.0]; self.memory_rows()]);
        block.map(|[component]| component)
    }

    /// −∇h/ḣ: the delay of the event per deviation just before it.
    pub fn delay(&self) -> &[f64; 6] {
        &self.delay
    }

    /// The square of the length of (ż₊ − R' ż₋) ∇h/ḣ, which is the largest factor by which a
    /// deviation can grow because the event comes at another time.
    #[inline(always)]
    pub fn magnification_squared(&self) -> f64 {
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

/// Adds rates times a row, row by row.
#[inline(always)]
fn add_rows<const M: usize>(rows: &mut [[f64; M]], rates: &[f64], by: &[f64; M], factor: f64) {
    for (row, rate) in rows.iter_mut().zip(rates) {
        for (sum, entry) in row.iter_mut().zip(by) {
            *sum += factor * rate * entry;
        }
    }
}

/// A linear function of the state for every deviation.
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
pub(crate) fn join(w: &[f64; 6], tau: f64) -> Deviation {
    [w[0], w[1], w[2], w[3], w[4], w[5], tau]
}

#[inline(always)]
pub(crate) fn dot6(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
