//! The contribution of linear water to the series of a motion.

use crate::arithmetic::polynomial::ORDER;
use crate::arithmetic::real::Real;
use crate::model::cable::Cable;
use crate::model::floating::Complex;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable};
use crate::motion::taut_series::{STILL, Series};
use crate::motion::water_series::{SeriesEnd, derivatives_of_forcing};

impl<T: Real> Series<T> {
    /// Adds the k-th coefficients of the forces of linear water.
    #[inline(always)]
    pub(super) fn extend_water(&mut self, system: &System<T>, k: usize) {
        let (place, velocity) = (self.place(k), self.velocity(k));
        let (Some(series), Some(water)) = (&mut self.water, &system.floating) else {
            return;
        };
        let [x, y, moment] = series.extend(water, k, place, velocity);
        self.force[0][k] += x;
        self.force[1][k] += y;
        let before = if system.drag.is_some() {
            self.turning[k]
        } else {
            T::ZERO
        };
        self.turning[k] = before + system.body.mass.load_of_moment(moment);
    }

    /// Extends the memory to the last order, and finds the truncation error of the series.
    #[inline(always)]
    pub(super) fn close_water(&mut self, system: &System<T>) {
        let orders = [ORDER - 1, ORDER];
        let end = SeriesEnd {
            places: orders.map(|k| self.place(k)),
            speed: self.velocity(ORDER - 1),
            forces: orders.map(|k| [self.force[0][k], self.force[1][k]]),
        };
        if let (Some(series), Some(water)) = (&mut self.water, &system.floating) {
            series.close(system, water, &end, self.active.taut.is_empty());
        }
    }

    /// The k-th coefficients of q.
    #[inline(always)]
    fn place(&self, k: usize) -> [T; 3] {
        [self.body.x[k], self.body.y[k], self.body.theta[k]]
    }

    /// The k-th coefficients of q̇.
    #[inline(always)]
    fn velocity(&self, k: usize) -> [T; 3] {
        self.place(k + 1).map(|next| next * (k + 1) as f64)
    }

    /// The longest part of a step, found by repeated division by √2, on which the truncation errors
    /// of the gaps and of the body's outline are below a part of a rounding of the displacements of
    /// the cables' ends.
    #[inline(always)]
    pub(super) fn shortened(&self, system: &System<T>, mut step: T) -> T {
        if self.is_followed_by_its_terms(system) {
            return step;
        }
        let [first, second] = [1, 2].map(|k| {
            let [x, y, theta] = self.place(k).map(T::abs);
            x + y + theta
        });
        let longest = system.cables.iter().map(Cable::length);
        let longest = longest.fold(T::ONE, T::max) * (T::EPSILON * 0.1);
        while step > T::EPSILON {
            let of_outline = system.body.reach() * self.left_out_of_circle(system, step);
            let mut left_out = self.left_out_of_motion(step).max(of_outline);
            let of_gaps = self.left_out_of_gaps(system, step);
            for of_gap in &of_gaps[..system.cables.len()] {
                left_out = left_out.max(*of_gap);
            }
            if left_out <= ((first + second * step) * step + STILL) * longest {
                break;
            }
            step = step * 0.7;
        }
        step
    }

    /// Whether the last terms of the series also show the size of its products' truncation errors.
    /// Where the motion has singularities its products have the same ones, and their last terms are
    /// about as small as its own: so it is with taut cables and a unit mass. Slack flight is a sum
    /// of exponentials, as is that of a floating body, or nearly so where drag is weak: its squares
    /// grow twice as fast, and the truncation error of their series is 2^28 times as large.
    fn is_followed_by_its_terms(&self, system: &System<T>) -> bool {
        self.water.is_none() && system.body.mass.is_unit() && !self.active.taut.is_empty()
    }

    /// Bound on the truncation error of the series of the position up to a time `s`, and of those
    /// of velocity and memory if there is a memory. With drag or taut cables there is no such
    /// bound: the last terms of the series are below rounding there, and nothing is added.
    #[inline(always)]
    pub(super) fn left_out_of_motion(&self, s: T) -> T {
        match &self.water {
            Some(water) => water.remainder(s),
            None if self.active.taut.is_empty() => {
                let mut left_out = self.waves_left_out;
                for _ in 0..=ORDER {
                    left_out = left_out * s;
                }
                left_out
            }
            None => T::ZERO,
        }
    }

    /// Bound on the truncation error of (cos θ, sin θ) up to a time `s`. These solve ċ = −θ̇ s,
    /// ṡ = θ̇ c up to the products beyond the last order, and a rotation does not let an error
    /// grow; an error of θ̇ turns them by that of θ.
    #[inline(always)]
    pub(super) fn left_out_of_circle(&self, system: &System<T>, s: T) -> T {
        if self.is_followed_by_its_terms(system) {
            return T::ZERO;
        }
        let mut power = s;
        for _ in 0..ORDER {
            power = power * s;
        }
        let [cosine, sine] = self.body.spin.beyond_product(&self.body.circle, s);
        (cosine + sine) * power + self.left_out_of_motion(s)
    }

    /// Bound on the truncation error of each gap up to a time `s`:
    ///
    /// - for |d|², the products beyond the last order;
    /// - for d, |ρ| times the error of (cos θ, sin θ);
    /// - for the position, the error of the motion.
    ///
    /// An error of d changes the gap by 2r times that error, as |d| ≤ r up to the first closing.
    #[inline(always)]
    pub(super) fn left_out_of_gaps(&self, system: &System<T>, s: T) -> PerCable<T> {
        let mut left_out = [T::ZERO; MAX_CABLES];
        if self.is_followed_by_its_terms(system) {
            return left_out;
        }
        let mut power = s;
        for _ in 0..ORDER {
            power = power * s;
        }
        let of_motion = self.left_out_of_motion(s);
        let turned = self.left_out_of_circle(system, s);
        for (pair, tethers) in system.cables.chunks(2).enumerate() {
            let beyond = self.pairs.beyond_gaps(pair, s);
            for (place, tether) in tethers.iter().enumerate() {
                let end = tether.fairlead().length() * turned + of_motion * 2.0;
                left_out[2 * pair + place] = beyond[place] * power + end * tether.length() * 2.0;
            }
        }
        left_out
    }

    /// The force of the water's memory a time `s` after the start.
    #[inline(always)]
    pub(crate) fn memory_force(&self, s: T) -> [T; 3] {
        match &self.water {
            None => [T::ZERO; 3],
            Some(water) => water.memory_force(s),
        }
    }

    /// The memory itself at the start.
    #[inline(always)]
    pub(crate) fn memory_at_start(&self, into: &mut [Complex<T>]) {
        if let Some(water) = &self.water {
            water.memory_at_start(into);
        }
    }

    /// The memory a time `s` after it.
    #[inline(always)]
    pub(crate) fn memory(&self, s: T, into: &mut [Complex<T>]) {
        if let Some(water) = &self.water {
            water.memory(s, into);
        }
    }
}

/// The truncation error of the position in a slack flight by waves alone is at most this times s^n,
/// n = [`ORDER`] + 1: Σ ‖a_j‖ Ω_j^{n−2}/n!. Zero with drag.
pub(super) fn waves_left_out<T: Real>(system: &System<T>) -> T {
    match system.drag {
        Some(_) => T::ZERO,
        None => derivatives_of_forcing(system, ORDER - 1) / (ORDER * (ORDER + 1)) as f64,
    }
}

#[cfg(test)]
mod tests {
    use crate::model::body::{Body, Shape};
    use crate::model::drag::Drag;
    use crate::model::forcing::Harmonic;
    use crate::model::rules::Rules;
    use crate::model::state::State;
    use crate::model::system::System;
    use crate::model::taut_set::TautSet;
    use crate::motion::active_set::ActiveSet;
    use crate::motion::contact::Contact;
    use crate::motion::prescribed_motion::PrescribedTaut;
    use crate::motion::taut_series::{Series, SeriesStart};
    use crate::motion::waves::Waves;

    /// The gap of a body in a short wave at the end of a step agrees with its closed form within
    /// the stated error: with drag coefficients of zero, and among eight waves of zero height. A
    /// step chosen by the position alone would be too long for the gap, which is quadratic in it.
    #[test]
    fn gaps_in_quick_waves_are_those_of_the_closed_form() {
        let drag = Drag {
            linear: 0.0,
            quadratic: 0.0,
            turning: 0.0,
            water: Vec::new(),
        };
        for k in 0..200_u32 {
            let part = |by: u32| f64::from(k * by % 199) / 199.0;
            let omega = 3.0 + 30.0 * part(7);
            let wave = Harmonic::ellipse(0.3 * omega * omega, 0.7, omega);
            let body = Body::rigid(Shape::of_half_sizes(0.2, 0.1), 0.02);
            let free = System::moored_breakwater(body, [0.2, 0.1], 1.5, 0.9, wave);
            let flat = |j: u32| Harmonic::ellipse(0.0, 1.0, omega * (0.3 + 0.07 * f64::from(j)));
            let mut among_others = free.clone();
            among_others.forcing.harmonics = (0..8).map(flat).chain([wave]).collect();
            let dragged = System {
                drag: Some(drag.clone()),
                ..free.clone()
            };
            let state = State {
                x: 0.2 * part(11) - 0.1,
                y: 0.3 * part(13),
                theta: 0.2 * part(17),
                vx: part(19),
                vtheta: 0.3 * part(23),
                ..State::default()
            };
            for system in [among_others, dragged] {
                let (slack, rules) = (TautSet::default(), Rules::until(1e3));
                let contacts =
                    std::array::from_fn(|cable| Contact::evaluated(&free, cable.min(1), &state));
                let active = ActiveSet {
                    taut: slack,
                    carrying: slack,
                };
                let mut waves = Waves::new(&system);
                waves.cover(0.0, 0.0);
                let mut series = Series::new(&system, &rules);
                let around = waves.expanded(&system, 0.0);
                let start = SeriesStart {
                    around: &around,
                    state: &state,
                    memory: &[],
                    contacts: &contacts,
                    active,
                };
                series.expand(&system, &start);
                let s = series.step();
                let there = PrescribedTaut::new(free.clone()).carried(slack, 0.0, &state, s);
                for cable in 0..2 {
                    let found = series.contact(cable, s);
                    let off = found.gap - free.cables[cable].gap(&there);
                    assert!(off.abs() < found.error + 1e-14, "{k}: {off:e}");
                }
            }
        }
    }
}
