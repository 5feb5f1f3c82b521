//! Sliding, rocking, and motion with any other set of taut cables, and all motion with drag: its Taylor series.
//!
//! Taut motion is a differential-algebraic problem of index 3 (docs/model.md section 6):
//!
//! ```text
//! (ẍ, ÿ) = f(t) − Σ T_i n_i,   θ̈ = −Σ T_i s_i / I,   g̈_i = 0 for the taut cables i
//! ```
//!
//! With the tensions eliminated it reads W T = b, W_ij = n_i·n_j + s_i s_j / I,
//! b_i = n_i·f + |Ṗ_i|²/r_i − θ̇² n_i·ρ_i. All of it is polynomial in x, y, θ, sin θ, cos θ, so the
//! coefficients of the motion's Taylor series follow one after the other from those before, the
//! matrix W at the start being the only one to solve with. One text serves every taut set, parallel
//! cables and b ≠ 0 among them; the gaps of the slack cables and the tensions come out as
//! polynomials on the step, in which [`crate::event`] finds events with the guarantee it has in flight.
//!
//! Libraries weighed for this: `ode_solvers` and `differential-equations` (Dormand-Prince 5 and 8:
//! their step control raises to powers with the platform's libm, and they allocate their output as
//! they go), `diffsol` (implicit and embedded pairs: likewise, and made for large stiff systems).
//! None gives dense output near rounding, which the guarantee needs. A Taylor method of fixed order is
//! some hundred lines of plain arithmetic, gives the same bits everywhere, and does not allocate.
//! Source: Jorba & Zou, *Experimental Mathematics* 14 (2005) 99.

use crate::complementarity::{PerCable, solve};
use crate::contact::{Contact, Contacts};
use crate::drag::DragSeries;
use crate::event::{Jet, Jets, Watch, Watched};
use crate::polynomial::{ORDER, Polynomial, convolve, convolve_tail};
use crate::real::{Real, dot};
use crate::taut_set::MAX_CABLES;
use crate::{State, System, TautSet};

/// A motion by less than this along a step counts as rest: its terms need not converge among
/// themselves, only stay below rounding of this \[L\], \[rad\].
const STILL: f64 = 1e-12;

/// Series of one cable's geometry: a pair of polynomials each for ρ and d = P − A, the gap, and where
/// taut the tension, the normal n = d/r and the arm s.
#[derive(Clone, Copy, Debug, Default)]
struct Line<T: Real> {
    lever: [Polynomial<T>; 2],
    span: [Polynomial<T>; 2],
    /// Ṗ.
    velocity: [Polynomial<T>; 2],
    normal: [Polynomial<T>; 2],
    arm: Polynomial<T>,
    /// n·ρ.
    reach: Polynomial<T>,
    gap: Polynomial<T>,
    tension: Polynomial<T>,
    load: Polynomial<T>,
}

/// The Taylor expansion of a motion with a fixed set of taut cables.
#[derive(Clone, Debug)]
pub(crate) struct Series<T: Real> {
    taut: TautSet,
    cables: usize,
    x: Polynomial<T>,
    y: Polynomial<T>,
    theta: Polynomial<T>,
    sine: Polynomial<T>,
    cosine: Polynomial<T>,
    /// θ̇ and θ̇².
    theta_rate: Polynomial<T>,
    spin: Polynomial<T>,
    /// The forces, drag included.
    force: [Polynomial<T>; 2],
    /// θ̈ by drag.
    turning: Polynomial<T>,
    drag: DragSeries<T>,
    lines: Vec<Line<T>>,
    /// W_ij of taut cables, symmetric: entry (i, j) with i ≤ j.
    coupling: Vec<Polynomial<T>>,
    contacts: Contacts<T>,
    /// A gap below this counts as zero while its cable rests.
    touch: PerCable<T>,
    tops: [Polynomial<T>; 4],
    tops_count: usize,
    rotation_limit: Option<T>,
    step: T,
    /// What may be reached within the step: event functions, as far as they are not the gaps of `lines`.
    watched: Vec<(Watch, Polynomial<T>, usize)>,
}

impl<T: Real> Series<T> {
    /// An expansion not yet made, with room for the cables of `system`.
    pub(crate) fn new(system: &System<T>, rotation_limit: Option<T>) -> Self {
        let cables = system.cables.len();
        Self {
            taut: TautSet::SLACK,
            cables,
            x: Polynomial::default(),
            y: Polynomial::default(),
            theta: Polynomial::default(),
            sine: Polynomial::default(),
            cosine: Polynomial::default(),
            theta_rate: Polynomial::default(),
            spin: Polynomial::default(),
            force: [Polynomial::default(); 2],
            turning: Polynomial::default(),
            drag: DragSeries::default(),
            lines: vec![Line::default(); cables],
            coupling: vec![Polynomial::default(); cables * cables],
            contacts: [Contact::CLOSED; MAX_CABLES],
            touch: [T::ZERO; MAX_CABLES],
            tops: [Polynomial::default(); 4],
            tops_count: 0,
            rotation_limit,
            step: T::ZERO,
            watched: Vec::new(),
        }
    }

    /// Expands the motion about time `t`, and chooses how far the expansion is used.
    pub(crate) fn begin(
        &mut self,
        system: &System<T>,
        t: T,
        start: &State<T>,
        contacts: &Contacts<T>,
        taut: TautSet,
        upper_bound: Option<T>,
    ) {
        self.taut = taut;
        self.contacts = *contacts;
        for (cable, tether) in system.cables.iter().enumerate() {
            self.touch[cable] = tether.length().squared() * T::EPSILON * 4.0;
        }
        self.expand_force(system, t);
        (self.x[0], self.x[1]) = (start.x, start.vx);
        (self.y[0], self.y[1]) = (start.y, start.vy);
        (self.theta[0], self.theta[1]) = (start.theta, start.vtheta);
        (self.sine[0], self.cosine[0]) = start.theta.sin_cos();
        for line in 0..self.cables {
            self.extend_geometry(system, line, 0);
            let span = system.cables[line].span(start);
            for (series, value) in self.lines[line].span.iter_mut().zip(span) {
                series[0] = value;
            }
            self.extend_normal(system, line, 0);
        }
        for k in 0..ORDER - 1 {
            self.extend_rotation(k + 1);
            self.theta_rate[k] = self.theta[k + 1] * (k + 1) as f64;
            self.spin[k] = convolve(&self.theta_rate, &self.theta_rate, k);
            for line in 0..self.cables {
                self.extend_geometry(system, line, k + 1);
            }
            for line in self.taut.iter() {
                self.extend_normal(system, line, k + 1);
            }
            self.extend_drag(system, k);
            self.extend_motion(system, k);
        }
        self.expand_gaps();
        self.expand_tops(system, upper_bound);
        self.step = self.choose_step(system);
        self.choose_watched();
    }

    /// Leaves out what provably is not reached within the step.
    fn choose_watched(&mut self) {
        let step = self.step;
        self.watched.clear();
        for cable in 0..self.cables {
            let line = &self.lines[cable];
            let (watch, function, order) = if self.taut.contains(cable) {
                (Watch::Tension(cable), line.tension.negated(), ORDER - 2)
            } else {
                (Watch::Gap(cable), line.gap, ORDER - 1)
            };
            if !function.stays_negative(step, order) {
                self.watched.push((watch, function, order));
            }
        }
        for mut theta in [self.theta, self.theta.negated()] {
            let Some(limit) = self.rotation_limit else {
                break;
            };
            theta[0] -= limit;
            if !theta.stays_negative(step, ORDER) {
                self.watched.push((Watch::Rotation, theta, ORDER));
            }
        }
        for top in &self.tops[..self.tops_count] {
            if !top.stays_negative(step, ORDER - 1) {
                self.watched.push((Watch::Top, *top, ORDER - 1));
            }
        }
    }

    /// f(t0 + s) as a power series.
    fn expand_force(&mut self, system: &System<T>, t: T) {
        self.force = [Polynomial::default(); 2];
        for i in 0..2 {
            self.force[i][0] = system.forcing.constant[i];
        }
        for harmonic in &system.forcing.harmonics {
            harmonic.expand(t, &mut self.force);
        }
        if let Some(drag) = &system.drag {
            self.drag.begin(drag, t);
        }
    }

    /// Adds the k-th coefficients of the drag, which those of the velocities give.
    fn extend_drag(&mut self, system: &System<T>, k: usize) {
        let Some(drag) = &system.drag else { return };
        let velocity = [&self.x, &self.y].map(|p| p[k + 1] * (k + 1) as f64);
        let found = self.drag.extend(drag, velocity, k);
        for (force, drag) in self.force.iter_mut().zip(found) {
            force[k] += drag;
        }
        self.turning[k] = -(drag.turning * self.theta_rate[k]);
    }

    /// sin θ and cos θ to order k from θ: k S_k = Σ j θ_j C_{k−j}, k C_k = −Σ j θ_j S_{k−j}.
    fn extend_rotation(&mut self, k: usize) {
        let (mut sine, mut cosine) = (T::ZERO, T::ZERO);
        for j in 1..=k {
            let weight = self.theta[j] * j as f64;
            sine += weight * self.cosine[k - j];
            cosine -= weight * self.sine[k - j];
        }
        self.sine[k] = sine / k as f64;
        self.cosine[k] = cosine / k as f64;
    }

    /// ρ and d of one cable to order k; d but for its constant.
    fn extend_geometry(&mut self, system: &System<T>, cable: usize, k: usize) {
        let lever = system.cables[cable].lever(self.sine[k], self.cosine[k]);
        let centre = [self.x[k], self.y[k]];
        let line = &mut self.lines[cable];
        for i in 0..2 {
            line.lever[i][k] = lever[i];
            line.span[i][k] = centre[i] + lever[i];
            if k > 0 {
                line.velocity[i][k - 1] = line.span[i][k] * k as f64;
            }
        }
    }

    /// n, s and n·ρ to order k.
    fn extend_normal(&mut self, system: &System<T>, cable: usize, k: usize) {
        let length = system.cables[cable].length();
        let line = &mut self.lines[cable];
        for i in 0..2 {
            line.normal[i][k] = line.span[i][k] / length;
        }
        line.arm[k] = convolve(&line.lever[0], &line.normal[1], k)
            - convolve(&line.lever[1], &line.normal[0], k);
        line.reach[k] = convolve(&line.normal[0], &line.lever[0], k)
            + convolve(&line.normal[1], &line.lever[1], k);
    }

    /// The k-th coefficients of the tensions, hence those of order k + 2 of the motion.
    fn extend_motion(&mut self, system: &System<T>, k: usize) {
        let inverse_inertia = system.body.inverse_inertia();
        let taut = self.taut;
        for i in taut.iter() {
            self.lines[i].load[k] = self.load(system, i, k);
            for j in taut.iter().filter(|&j| j >= i) {
                let (a, b) = (&self.lines[i], &self.lines[j]);
                self.coupling[i * self.cables + j][k] = convolve(&a.normal[0], &b.normal[0], k)
                    + convolve(&a.normal[1], &b.normal[1], k)
                    + convolve(&a.arm, &b.arm, k) * inverse_inertia;
            }
        }
        let mut right = [T::ZERO; MAX_CABLES];
        for i in taut.iter() {
            right[i] = taut.iter().fold(self.lines[i].load[k], |sum, j| {
                sum - convolve_tail(self.coupling(i, j), &self.lines[j].tension, k)
            });
        }
        let tension = solve(taut, |i, j| self.coupling(i, j)[0], &right);
        let mut accel = [self.force[0][k], self.force[1][k], self.turning[k]];
        for i in taut.iter() {
            let line = &mut self.lines[i];
            line.tension[k] = tension[i];
            accel[0] -= convolve(&line.tension, &line.normal[0], k);
            accel[1] -= convolve(&line.tension, &line.normal[1], k);
            accel[2] -= convolve(&line.tension, &line.arm, k) * inverse_inertia;
        }
        let factor = T::ONE / ((k + 1) * (k + 2)) as f64;
        self.x[k + 2] = accel[0] * factor;
        self.y[k + 2] = accel[1] * factor;
        self.theta[k + 2] = accel[2] * factor;
    }

    fn coupling(&self, i: usize, j: usize) -> &Polynomial<T> {
        &self.coupling[i.min(j) * self.cables + i.max(j)]
    }

    /// b_i = n·f + s θ̈ + |Ṗ|²/r − θ̇² n·ρ to order k, with the f and θ̈ of forces and drag.
    fn load(&self, system: &System<T>, cable: usize, k: usize) -> T {
        let line = &self.lines[cable];
        let push = convolve(&line.normal[0], &self.force[0], k)
            + convolve(&line.normal[1], &self.force[1], k);
        let push = if system.drag.is_some() {
            push + convolve(&line.arm, &self.turning, k)
        } else {
            push
        };
        let [u, v] = &line.velocity;
        let speed = convolve(u, u, k) + convolve(v, v, k);
        let centripetal = convolve(&self.spin, &line.reach, k);
        push + speed / system.cables[cable].length() - centripetal
    }

    /// g = d·d − r² of the slack cables, with the first coefficients as they are known.
    fn expand_gaps(&mut self) {
        for cable in (0..self.cables).filter(|&cable| !self.taut.contains(cable)) {
            let contact = self.contacts[cable];
            let line = &mut self.lines[cable];
            for k in 1..ORDER {
                line.gap[k] = convolve(&line.span[0], &line.span[0], k)
                    + convolve(&line.span[1], &line.span[1], k);
            }
            line.gap[0] = contact.gap;
            if contact.resting {
                line.gap[1] = T::ZERO;
            }
        }
    }

    /// Height over the upper bound of each point of the outline.
    fn expand_tops(&mut self, system: &System<T>, upper_bound: Option<T>) {
        self.tops_count = 0;
        let Some(level) = upper_bound else { return };
        let (outline, radius) = system.body.outline();
        for [px, py] in outline.points() {
            let top = &mut self.tops[self.tops_count];
            for k in 0..ORDER {
                top[k] = self.y[k] + *px * self.sine[k] + *py * self.cosine[k];
            }
            top[0] = top[0] + radius - level;
            self.tops_count += 1;
        }
    }

    /// The longest step, up to one unit of time, on which the last terms of the motion and of the
    /// tensions are below rounding.
    ///
    /// A rounding of the tension turns a body of small inertia by ε T (ρ/I) h²/2, which moves the
    /// attachment off its constraint by ρ times that: the step is held to where this is a few ε.
    fn choose_step(&self, system: &System<T>) -> T {
        let light = self.taut.iter().fold(T::ONE, |w, cable| {
            let fairlead = system.cables[cable].fairlead();
            w.max(T::ONE + dot(fairlead, fairlead) * system.body.inverse_inertia())
        });
        let still = T::from_f64(STILL);
        let longest = T::ONE.min((T::from_f64(8.0) / light).sqrt());
        let mut step = [&self.x, &self.y, &self.theta]
            .iter()
            .fold(longest, |step, p| p.converged_within(step, ORDER, still));
        for cable in self.taut.iter() {
            let tension = &self.lines[cable].tension;
            let scale = (tension[0].abs() + 1.0) * 20.0;
            step = tension.converged_within(step, ORDER - 2, scale);
        }
        step
    }

    /// How far the expansion may be used.
    pub(crate) fn step(&self) -> T {
        self.step
    }

    /// The state a time `s` after the start.
    pub(crate) fn state(&self, s: T) -> State<T> {
        let (x, y, theta) = (
            self.x.jet(s, ORDER),
            self.y.jet(s, ORDER),
            self.theta.jet(s, ORDER),
        );
        State {
            x: x[0],
            y: y[0],
            theta: theta[0],
            vx: x[1],
            vy: y[1],
            vtheta: theta[1],
        }
    }

    /// The gap of a slack cable a time `s` after the start.
    pub(crate) fn contact(&self, cable: usize, s: T) -> Contact<T> {
        let ([value, ..], noise) = self.lines[cable].gap.jet_and_noise(s, ORDER - 1);
        Contact {
            gap: value,
            error: self.contacts[cable].error + noise,
            resting: false,
        }
    }

    /// The tension of a taut cable a time `s` after the start.
    pub(crate) fn tension(&self, cable: usize, s: T) -> T {
        let [tension, ..] = self.lines[cable].tension.jet(s, ORDER - 2);
        tension
    }

    /// g and ġ of a slack cable a time `s` after the start.
    pub(crate) fn gap_and_rate(&self, cable: usize, s: T) -> (T, T) {
        let [gap, rate, _] = self.lines[cable].gap.jet(s, ORDER - 1);
        (gap, rate)
    }

    /// Bound on |g̈| of a slack cable over the step.
    pub(crate) fn gap_bend(&self, cable: usize) -> T {
        self.lines[cable]
            .gap
            .derivative_bound(2, self.step, ORDER - 1)
    }

    /// Bounds on |ÿ| and |θ̈| over the step.
    pub(crate) fn steepest(&self) -> [T; 2] {
        [&self.y, &self.theta].map(|p| p.derivative_bound(2, self.step, ORDER))
    }

    fn jet(&self, watch: Watch, polynomial: &Polynomial<T>, order: usize, s: T) -> Jet<T> {
        let ([value, rate, accel], noise) = polynomial.jet_and_noise(s, order);
        Jet {
            third: polynomial.derivative_bound(3, self.step, order),
            noise,
            ..Jet::new(watch, value, rate, accel)
        }
    }

    fn gap_jet(&self, cable: usize, s: T) -> Jet<T> {
        let gap = &self.lines[cable].gap;
        let contact = &self.contacts[cable];
        let jet = self.jet(Watch::Gap(cable), gap, ORDER - 1, s);
        if s > T::ZERO {
            return Jet {
                noise: jet.noise + contact.error,
                ..jet
            };
        }
        Jet {
            noise: contact.error,
            blur: self.touch[cable],
            resting: contact.resting,
            jerk: gap[3] * 6.0,
            fourth: if contact.resting {
                gap.derivative_bound(4, self.step, ORDER - 1)
            } else {
                T::ZERO
            },
            ..jet
        }
    }
}

impl<T: Real> Watched<T> for Series<T> {
    fn watch(&self, s: T, jets: &mut Jets<T>) {
        for (watch, polynomial, order) in &self.watched {
            jets.push(match *watch {
                Watch::Gap(cable) => self.gap_jet(cable, s),
                other => self.jet(other, polynomial, *order, s),
            });
        }
    }
}
