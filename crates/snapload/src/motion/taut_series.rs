//! The Taylor series of all motion without a closed form: sliding, rocking, any other set of taut
//! cables, motion with drag, with a mass other than the unit one, or afloat, and slack flight under
//! more than eight sinusoids.
//!
//! Taut motion is a differential-algebraic problem of index 3 (docs/model.md section 6):
//!
//! ```text
//! (ẍ, ÿ) = f(t) − Σ T_i n_i,   θ̈ = −Σ T_i s_i / I,   g̈_i = 0 for the taut cables i
//! ```
//!
//! All of it is polynomial in x, y, θ, sin θ, cos θ and the tensions, so the coefficients of their
//! Taylor series follow one after the other. With the motion known to order k + 1 and the tensions
//! to k − 1,
//!
//! ```text
//! (k+1)(k+2) (x, y)_{k+2} = f_k − Σ q_{i,k},   (k+1)(k+2) θ_{k+2} = −Σ (ρ_i × q_i)_k / I,   q_i = T_i n_i
//! ```
//!
//! are linear in the T_{i,k}, and so is the coefficient of order k + 2 of |P_i − A_i|² = r_i², the
//! constraint:
//!
//! ```text
//! Σ_j W_ij T_{j,k} = n_i·a + s_i α + (k+1)(k+2) b_i,   W_ij = n_i·n_j + s_i s_j / I
//! ```
//!
//! with W, n and s at the start, a and α the accelerations without the part of T_k, and b_i the
//! part of the constraint that does not depend on the accelerations: n_i·ρ_i of the orders of θ
//! below k + 2, and Σ d_j·d_{k+2−j}/2r_i, 0 < j < k + 2. At k = 0 this is the centripetal term, b_i
//! = |Ṗ_i|²/2r_i − θ̇² n_i·ρ_i/2. It holds for every taut set, with parallel cables and b ≠ 0; the
//! gaps of the slack cables and the tensions result as polynomials on the step, in which
//! [`crate::motion::events`] finds events with the same guarantee as in flight.
//!
//! With any other mass matrix all accelerations are M⁻¹ times forces and moments, and W = G M⁻¹ Gᵀ;
//! for a floating body the force has the terms of [`crate::motion::water_series`].
//!
//! Libraries considered: `ode_solvers` and `differential-equations` (Dormand-Prince 5 and 8: their
//! step control uses powers of the platform's libm, and they allocate their output during the
//! integration), `diffsol` (implicit and embedded pairs: likewise, and made for large stiff
//! systems). None gives dense output accurate to rounding, which the guarantee needs. A Taylor
//! method of fixed order is some hundred lines of plain arithmetic, gives the same bits everywhere,
//! and does not allocate. Source: Jorba & Zou, *Experimental Mathematics* 14 (2005) 99.

use crate::arithmetic::polynomial::{ORDER, Polynomial};
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::drag::DragSeries;
use crate::model::floating::Complex;
use crate::model::mass::Mass;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::{MAX_CABLES, PerCable, TautSet};
use crate::motion::active_set::ActiveSet;
use crate::motion::cable_series::CableSeries;
use crate::motion::complementarity::Factored;
use crate::motion::contact::{Contact, Contacts};
use crate::motion::limits::Limits;
use crate::motion::limits::law::EventSeries;
use crate::motion::taut_series::body::BodySeries;
use crate::motion::water_series::WaterSeries;
use crate::motion::waves::sinusoids::Expanded;

mod body;
mod events;
mod rocking;
mod water;

pub(crate) use rocking::RockingSeries;

/// A displacement along a step of less than this, or than a taut cable's length, counts as rest:
/// the terms need not converge relative to each other, only stay below its rounding \[L\], \[rad\].
pub(crate) const STILL: f64 = 1e-12;

/// The gap of a cable, and its tension where it carries.
#[derive(Clone, Copy, Debug, Default)]
struct Line<T: Real> {
    gap: Polynomial<T>,
    tension: Polynomial<T>,
}

/// Where an expansion begins.
pub(crate) struct SeriesStart<'a, T: Real> {
    /// The series of the external forces about its time.
    pub(crate) around: &'a Expanded<T>,
    pub(crate) state: &'a State<T>,
    /// The state of the water's memory.
    pub(crate) memory: &'a [Complex<T>],
    pub(crate) contacts: &'a Contacts<T>,
    pub(crate) active: ActiveSet,
}

/// The Taylor expansion of a motion with a fixed set of taut cables.
#[derive(Clone, Debug)]
pub(crate) struct Series<T: Real> {
    active: ActiveSet,
    body: BodySeries<T>,
    /// The forces, including those of the water.
    force: [Polynomial<T>; 2],
    /// The moment of the water on the body, or for a unit mass its θ̈.
    turning: Polynomial<T>,
    drag: DragSeries<T>,
    /// The series of the water, if the body floats.
    water: Option<Box<WaterSeries<T>>>,
    pairs: CableSeries<T>,
    lines: Vec<Line<T>>,
    contacts: Contacts<T>,
    /// Cables whose tension is known to be zero at the start, and to rise.
    touching: TautSet,
    /// A gap below this counts as zero while its cable rests.
    touch: PerCable<T>,
    /// The truncation error of the series of a slack flight by waves, up to a power of the time.
    waves_left_out: T,
    /// The truncation error of the gaps within the step.
    left_out: PerCable<T>,
    limits: Limits<T>,
    step: T,
    /// The event functions that may be reached within the step, except the gaps of `lines`.
    event_series: Vec<EventSeries<T>>,
    /// Whether the coefficients of the next step are known already, from [`RockingSeries`].
    extended: bool,
}

impl<T: Real> Series<T> {
    /// An expansion without content. Memory for the cables is allocated with the first expansion,
    /// as most runs make none.
    pub(crate) fn new(system: &System<T>, rules: &Rules<T>) -> Self {
        Self {
            active: ActiveSet::default(),
            body: BodySeries::default(),
            force: [Polynomial::default(); 2],
            turning: Polynomial::default(),
            drag: DragSeries::default(),
            water: system
                .floating
                .as_ref()
                .map(|water| Box::new(WaterSeries::new(system, water))),
            pairs: CableSeries::default(),
            lines: Vec::new(),
            contacts: [Contact::CLOSED; MAX_CABLES],
            touching: TautSet::SLACK,
            touch: [T::ZERO; MAX_CABLES],
            waves_left_out: water::waves_left_out(system),
            left_out: [T::ZERO; MAX_CABLES],
            limits: Limits::of(system, rules),
            step: T::ZERO,
            event_series: Vec::new(),
            extended: false,
        }
    }

    /// Expands the motion from a start, and chooses the length on which the expansion is used.
    #[inline(always)]
    pub(crate) fn expand(&mut self, system: &System<T>, start: &SeriesStart<T>) {
        self.begin(system, start);
        self.extend(system);
        self.close(system, start.state, start.memory);
    }

    /// Begins an expansion: all coefficients up to the first order.
    #[inline(always)]
    pub(super) fn begin(&mut self, system: &System<T>, start: &SeriesStart<T>) {
        let &SeriesStart {
            around,
            state,
            memory,
            contacts,
            active,
        } = start;
        apart!(T, {
            self.active = active;
            self.contacts = *contacts;
            let cables = system.cables.len();
            self.lines.resize_with(cables, Line::default);
            for (cable, tether) in system.cables.iter().enumerate() {
                self.touch[cable] = tether.length().squared() * T::EPSILON * 4.0;
            }
            self.force = around.force;
            if system.drag.is_some() {
                self.drag.begin(&around.water);
            }
            if let Some(series) = &mut self.water {
                series.begin(&around.excitation, memory);
            }
            self.body.begin(state);
            self.pairs.begin(system);
            for k in 0..2 {
                self.extend_pairs(k);
            }
            for (cable, tether) in system.cables.iter().enumerate() {
                self.pairs.set_span(cable, tether.span(state));
            }
        })
    }

    /// Adds the other coefficients, order by order.
    #[inline(always)]
    pub(super) fn extend(&mut self, system: &System<T>) {
        apart!(T, {
            let mass = &system.body.mass;
            let normals = self.pairs.set_carrying(self.active.carrying);
            let coupling = |i: usize, j: usize| mass.coupling(&normals[i], &normals[j]);
            let ready = Factored::new(self.active.carrying, coupling);
            self.keep_gaps(1);
            for k in 0..ORDER - 1 {
                self.extend_drag(system, k);
                self.extend_water(system, k);
                self.extend_motion(k, mass, &ready);
                self.extend_pairs(k + 2);
                self.keep_gaps(k + 2);
                self.keep_tensions(k);
            }
            self.close_water(system);
        })
    }

    /// Chooses, once all coefficients are known, the length of the step and its event functions.
    #[inline(always)]
    pub(super) fn close(&mut self, system: &System<T>, start: &State<T>, memory: &[Complex<T>]) {
        apart!(T, {
            self.set_known_gaps();
            self.step = self.choose_step(system);
            self.left_out = self.left_out_of_gaps(system, self.step);
            let taut = self.active.taut.iter();
            self.active.taut = taut.filter(|&cable| self.holds(system, cable)).collect();
            self.choose_event_series(system, start, memory);
        })
    }

    /// Adds the k-th coefficients of the drag, which follow from those of the velocities.
    #[inline(always)]
    fn extend_drag(&mut self, system: &System<T>, k: usize) {
        let Some(drag) = &system.drag else { return };
        let order = (k + 1) as f64;
        let velocity = [self.body.x[k + 1] * order, self.body.y[k + 1] * order];
        let found = self.drag.extend(drag, velocity, k);
        for (force, drag) in self.force.iter_mut().zip(found) {
            force[k] += drag;
        }
        let turning = -(drag.turning * self.body.theta[k + 1] * (k + 1) as f64);
        self.turning[k] = system.body.mass.load_of_turning(turning);
    }

    /// Extends ρ and d of every cable to order k; the constant of d is given separately.
    #[inline(always)]
    fn extend_pairs(&mut self, k: usize) {
        let body = &self.body;
        self.pairs.extend(k, [body.x[k], body.y[k]], body.circle[k]);
    }

    /// The k-th coefficients of the tensions, and those of order k + 2 of the motion.
    #[inline(always)]
    fn extend_motion(
        &mut self,
        k: usize,
        mass: &Mass<T>,
        ready: &Factored<T, impl Fn(usize, usize) -> T>,
    ) {
        let turned = self.body.known_rotation(k + 2);
        let load = [self.force[0][k], self.force[1][k], self.turning[k]];
        let pulls = self.pairs.known_forces(k);
        let known = mass.accelerated_by(mass.less_pull(load, pulls));
        let pulls = self.pairs.find_tensions(k, known, turned, ready);
        self.body.extend(k, mass.slowed_by(known, pulls), turned);
    }

    /// The gap of every cable to order k, once d is known to that order; if all cables carry, no
    /// gap is needed.
    #[inline(always)]
    fn keep_gaps(&mut self, k: usize) {
        if self.active.carrying.len() == self.lines.len() {
            return;
        }
        for (pair, lines) in self.lines.chunks_mut(2).enumerate() {
            for (line, gap) in lines.iter_mut().zip(self.pairs.gaps(pair, k)) {
                line.gap[k] = gap;
            }
        }
    }

    #[inline(always)]
    fn keep_tensions(&mut self, k: usize) {
        for (pair, lines) in self.lines.chunks_mut(2).enumerate() {
            for (line, tension) in lines.iter_mut().zip(self.pairs.tensions(pair, k)) {
                line.tension[k] = tension;
            }
        }
    }

    /// Sets the first coefficients of the gaps to their known values.
    #[inline(always)]
    fn set_known_gaps(&mut self) {
        for (line, contact) in self.lines.iter_mut().zip(&self.contacts) {
            line.gap[0] = contact.gap;
            if contact.resting {
                line.gap[1] = T::ZERO;
            }
        }
    }

    /// The longest step, up to one unit of time, on which the last terms of the motion and of the
    /// tensions are below rounding.
    ///
    /// A rounding of the tension turns a body of small inertia by ε T (ρ/I) h²/2, which moves the
    /// attachment off its constraint by ρ times that: the step is held to where this is a few ε.
    #[inline(always)]
    fn choose_step(&self, system: &System<T>) -> T {
        apart!(T, {
            let (mut light, mut still) = (T::ONE, T::from_f64(STILL));
            for cable in self.active.carrying.iter() {
                let fairlead = system.cables[cable].fairlead();
                light = light.max(system.body.mass.largest_coupling(fairlead.dot(fairlead)));
                still = still.min(system.cables[cable].length());
            }
            let longest = T::ONE.min((T::from_f64(8.0) / light).sqrt());
            let mut step = longest;
            for motion in self.body.place() {
                step = motion.converged_within(step, ORDER, still);
            }
            for cable in self.active.carrying.iter() {
                let tension = &self.lines[cable].tension;
                let scale = (tension[0].abs() + 1.0) * 20.0;
                step = tension.converged_within(step, ORDER - 2, scale);
            }
            self.shortened(system, step)
        })
    }

    /// Whether the coefficients of the step that comes next are known already; true only once.
    pub(super) fn take_extended(&mut self) -> bool {
        std::mem::take(&mut self.extended)
    }

    /// Sets the taut cables whose tension is known to be zero at the start, and to rise.
    pub(crate) fn set_touching(&mut self, cables: TautSet) {
        self.touching = cables;
    }

    /// Whether the tension of a cable is known to be zero at the start, and to rise.
    pub(crate) fn rises_from_zero(&self, cable: usize) -> bool {
        self.touching.contains(cable)
    }

    /// The cables that are taut within the step, and the carrying ones among them.
    pub(crate) fn active(&self) -> ActiveSet {
        self.active
    }

    /// How far the expansion may be used.
    pub(crate) fn step(&self) -> T {
        self.step
    }

    /// The state a time `s` after the start.
    #[inline(always)]
    pub(crate) fn state(&self, s: T) -> State<T> {
        apart!(T, { state_at(self.body.place(), s) })
    }

    /// The expansions of x, y and θ.
    #[inline(always)]
    pub(crate) fn motion(&self) -> [Polynomial<T>; 3] {
        [self.body.x, self.body.y, self.body.theta]
    }

    /// The gap of a slack cable a time `s` after the start.
    #[inline(always)]
    pub(crate) fn contact(&self, cable: usize, s: T) -> Contact<T> {
        let ([value, ..], noise) = self.lines[cable].gap.jet_and_noise(s, ORDER);
        Contact {
            gap: value,
            error: self.contacts[cable].error + noise + self.left_out[cable],
            resting: false,
        }
    }

    /// The tension of a taut cable a time `s` after the start.
    #[inline(always)]
    pub(crate) fn tension(&self, cable: usize, s: T) -> T {
        let [tension, ..] = self.lines[cable].tension.jet(s, ORDER - 2);
        tension
    }

    /// The tension of a taut cable at some times after the start.
    #[inline(always)]
    pub(crate) fn tensions<const N: usize>(&self, cable: usize, times: &[T; N]) -> [T; N] {
        self.lines[cable].tension.values(times, ORDER - 2)
    }

    /// g and ġ of a slack cable a time `s` after the start.
    #[inline(always)]
    pub(crate) fn gap_and_rate(&self, cable: usize, s: T) -> (T, T) {
        let [gap, rate, _] = self.lines[cable].gap.jet(s, ORDER);
        (gap, rate)
    }

    /// Whether a cable was known to be closed and at rest at the start.
    pub(crate) fn rested(&self, cable: usize) -> bool {
        self.contacts[cable].resting
    }

    /// ġ and g̈ of a slack cable a time `s` after the start.
    #[inline(always)]
    pub(crate) fn gap_rate_and_acceleration(&self, cable: usize, s: T) -> (T, T) {
        let [_, rate, acceleration] = self.lines[cable].gap.jet(s, ORDER);
        (rate, acceleration)
    }

    /// Bound on |g⃛| of a slack cable over the step.
    pub(crate) fn gap_jerk_bound(&self, cable: usize) -> T {
        self.lines[cable].gap.derivative_bound(3, self.step, ORDER)
    }

    /// Bound on |g̈| of a slack cable over the step.
    pub(crate) fn gap_acceleration_bound(&self, cable: usize) -> T {
        self.lines[cable].gap.derivative_bound(2, self.step, ORDER)
    }

    /// A bound on the n-th derivative of x, y or θ (0, 1, 2) over the step.
    #[inline(always)]
    pub(crate) fn derivative_bound(&self, n: usize, coordinate: usize) -> T {
        let place = self.body.place()[coordinate];
        place.derivative_bound(n, self.step, ORDER)
    }
}

/// The state a time `s` after the start of series of x, y and θ.
#[inline(always)]
pub(crate) fn state_at<T: Real>([x, y, theta]: [&Polynomial<T>; 3], s: T) -> State<T> {
    let (x, y, theta) = (x.jet(s, ORDER), y.jet(s, ORDER), theta.jet(s, ORDER));
    State {
        x: x[0],
        y: y[0],
        theta: theta[0],
        vx: x[1],
        vy: y[1],
        vtheta: theta[1],
    }
}
