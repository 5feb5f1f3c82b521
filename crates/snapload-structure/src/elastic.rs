//! Lines that stretch: the alternative to the inextensible line.
//!
//! A line is a spring with a damper beside it that can only pull (docs/structures.md):
//!
//! ```text
//! T = k δ + c δ̇  while δ > 0 and this is positive, else 0        δ = |P − A| − r
//! ```
//!
//! Between the instants at which a line takes hold or lets go the forces are smooth. So the motion is integrated from
//! one such instant to the next with the set of pulling lines fixed, by the pair of order 8 of Dormand and Prince,
//! and the instants are found on its dense output, at [`LOOKS`] places in each step and then by bisection.
//!
//! Library: `differential-equations` (DOP853 with dense output, few dependencies). Its own detection of events passes
//! over the first step and over two crossings within one, so only its integrator is used.

use crate::assess::Prepared;
use crate::structure::Structure;
use differential_equations::prelude::{
    ControlFlag, ExplicitRungeKutta, IVP, Interpolation, ODE, Solout, Solution,
};
use snapload::{CaseError, State, System, TautSet};
use std::f64::consts::FRAC_PI_2;

/// Tolerance of a step, relative and absolute, in the engine's units.
const TOLERANCE: f64 = 1e-11;
/// Steps are no longer than this part of 1/ω, ω = sqrt(k w) of the stiffest line that pulls: the dense output, on which
/// lines let go, is of order 7 and would else be less exact than the steps.
const STEP: f64 = 0.25;
/// So many such steps are made between two looks at whether to stop.
const TOGETHER: f64 = 4000.0;
/// The longest time in one go while no line pulls.
const AT_A_TIME: f64 = 1.0;
/// Places in a step at which forces are looked at.
const LOOKS: u32 = 16;
/// A force below zero by less than this, where a line has just taken hold or let go, is rounding.
const NOISE: f64 = 1e-12;

/// Less restitution takes a damper that is all there is of the line.
const LEAST_RESTITUTION: f64 = 0.01;

/// A line as spring and damper, in the engine's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// k \[F/L\].
    pub rate: f64,
    /// c \[F T/L\].
    pub damping: f64,
}

/// A line that pulls for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// The line, by index from 0.
    pub line: usize,
    /// When it took hold \[s\].
    pub from_s: f64,
    /// When it let go, or the run ended \[s\].
    pub to_s: f64,
    /// Speed at which it was being stretched when it took hold \[m/s\].
    pub speed_m_s: f64,
    /// Speed at which it was getting shorter when it let go; none if it pulls to the end \[m/s\].
    pub rebound_m_s: Option<f64>,
    /// The largest tension \[N\].
    pub peak_n: f64,
    /// When \[s\].
    pub peak_s: f64,
}

/// State and tensions at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The time \[s\].
    pub t_s: f64,
    /// The state, in the engine's units.
    pub state: State,
    /// Tension of each line \[N\].
    pub tension_n: Vec<f64>,
}

/// A motion on lines that stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticRun {
    /// Every pull, in the order in which lines took hold.
    pub pulls: Vec<Pull>,
    /// The motion at the times asked for.
    pub looks: Vec<Look>,
    /// When it ended \[s\].
    pub end_s: f64,
    /// The state then, in the engine's units.
    pub end: State,
}

/// The damping ratio ζ = c/(2 sqrt(k m)) of a spring and damper from which a mass rebounds at e times its speed, let go
/// of when the force is back at zero: e = exp(−2ζ arccos ζ/sqrt(1 − ζ²)), with arcosh and ζ² − 1 beyond ζ = 1
/// (Schwager & Pöschel, *Granular Matter* 9 (2007) 465, eq. 17 and 18, in which β/ω₀ is ζ).
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let rebound = |ratio: f64| {
        let root = (1.0 - ratio * ratio).abs().sqrt();
        let angle = if ratio < 1.0 {
            ratio.acos()
        } else {
            ratio.acosh()
        };
        // Towards ζ = 1 the angle over the root goes to 1.
        let quotient = if root < 1e-6 { 1.0 } else { angle / root };
        (-2.0 * ratio * quotient).exp()
    };
    let (mut low, mut high) = (0.0, 1.0);
    while rebound(high) > restitution && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if rebound(middle) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The lines of a structure as springs, `stiffer` times as stiff as they are, with dampers that give its restitution
/// at the effective mass M/w that each line has to stop where the structure rests.
///
/// # Errors
/// A [`CaseError`] if a line has no stiffness.
pub fn springs(prepared: &Prepared, stiffer: f64) -> Result<Vec<Spring>, CaseError> {
    let Prepared {
        structure, model, ..
    } = prepared;
    if structure.restitution < LEAST_RESTITUTION {
        let shown = structure.restitution;
        let allowed = format!("{LEAST_RESTITUTION} or more for lines that stretch");
        return Err(CaseError::value("run.restitution", shown, allowed).with_hint(
            "a damper for less pulls many times harder at first touch than the spring ever does",
        ));
    }
    let ratio = damping_ratio(structure.restitution);
    let rest = model.at_rest(prepared.rest.place_m, prepared.rest.theta_rad);
    let unit = model.scales.force_n / model.scales.length_m;
    let lines = structure.lines.iter().enumerate();
    lines
        .map(|(index, line)| {
            let rate = line.spring_rate_n_m().ok_or_else(|| {
                let allowed = "a stiffness, which a line that stretches needs";
                CaseError::value(
                    &format!("line.{}.stiffness", index + 1),
                    "(left out)",
                    allowed,
                )
                .with_hint("give stiffness (EA in N), spring_rate, or a type and diameter")
            })? * stiffer
                / unit;
            let normal = model.system.cables[index].normal(&rest);
            let mass = 1.0 / normal.coupling(&normal, model.system.body.inverse_inertia());
            Ok(Spring {
                rate,
                damping: 2.0 * ratio * (rate * mass).sqrt(),
            })
        })
        .collect()
}

/// What one line does at one state.
struct Grip {
    /// Unit vector along the line.
    n: [f64; 2],
    /// Moment arm.
    arm: f64,
    /// δ.
    stretch: f64,
    /// δ̇.
    rate: f64,
    /// k δ + c δ̇.
    force: f64,
}

/// A body on springs.
struct Elastic<'a> {
    system: &'a System,
    springs: &'a [Spring],
}

impl Elastic<'_> {
    fn grip(&self, line: usize, state: &State) -> Grip {
        let (cable, spring) = (&self.system.cables[line], &self.springs[line]);
        let span = cable.span(state);
        let reach = span[0].hypot(span[1]);
        let n = span.map(|component| component / reach);
        let (sine, cosine) = state.theta.sin_cos();
        let lever = cable.lever(sine, cosine);
        let arm = lever[0] * n[1] - lever[1] * n[0];
        // From the gap |d|² − r², which is free of cancellation.
        let stretch = cable.gap(state) / (reach + cable.length());
        let rate = n[0] * state.vx + n[1] * state.vy + arm * state.vtheta;
        Grip {
            n,
            arm,
            stretch,
            rate,
            force: spring.rate * stretch + spring.damping * rate,
        }
    }

    /// Positive while the line goes on as it does: pulling, or not.
    fn keeps(&self, line: usize, state: &State, pulls: bool) -> f64 {
        let grip = self.grip(line, state);
        if pulls {
            grip.force
        } else if grip.stretch <= 0.0 {
            -grip.stretch
        } else {
            -grip.force
        }
    }

    fn pulling(&self, state: &State) -> TautSet {
        let pulls = |line: &usize| {
            let grip = self.grip(*line, state);
            grip.stretch > 0.0 && grip.force > 0.0
        };
        (0..self.springs.len()).filter(pulls).collect()
    }

    fn longest_step(&self, state: &State, pulling: TautSet) -> f64 {
        let inverse_inertia = self.system.body.inverse_inertia();
        let quickest = pulling.iter().fold(1.0, |quickest: f64, line| {
            let inverse_mass = 1.0 + self.grip(line, state).arm.powi(2) * inverse_inertia;
            quickest.max((self.springs[line].rate * inverse_mass).sqrt())
        });
        STEP / quickest
    }

    fn acceleration(&self, t: f64, state: &State, pulling: TautSet) -> [f64; 3] {
        let inverse_inertia = self.system.body.inverse_inertia();
        let free = self.system.free_acceleration(t, state);
        pulling.iter().fold(free, |[x, y, theta], line| {
            let Grip { n, arm, force, .. } = self.grip(line, state);
            [
                x - force * n[0],
                y - force * n[1],
                theta - force * arm * inverse_inertia,
            ]
        })
    }
}

/// The motion with one set of pulling lines, from `begin` on.
struct Stretch<'a> {
    elastic: &'a Elastic<'a>,
    begin: f64,
    pulling: TautSet,
}

impl ODE<f64, [f64; 6]> for Stretch<'_> {
    fn diff(&self, s: f64, y: &[f64; 6], dydt: &mut [f64; 6]) {
        let state = State::from_components(*y);
        let t = self.begin + s;
        let [ax, ay, atheta] = self.elastic.acceleration(t, &state, self.pulling);
        *dydt = [state.vx, state.vy, state.vtheta, ax, ay, atheta];
    }
}

/// Looks on while a stretch is integrated.
struct Watch<'a, 'b> {
    stretch: &'a Stretch<'a>,
    see: &'b mut dyn FnMut(f64, &State),
    found: &'b mut Found,
}

/// What was found along a stretch.
struct Found {
    /// Lines that have just taken hold or let go, and whose force is zero but for rounding.
    fresh: TautSet,
    change: Option<Change>,
    /// The state at the end of the latest step, as the integrator keeps none when it is looked on.
    reached: [f64; 6],
}

/// Where a line took hold or let go, found on the dense output of a step.
#[derive(Clone, Copy)]
struct Change {
    line: usize,
    /// Time since the stretch began.
    s: f64,
    /// The step's own begin, from which the state there is integrated: the dense output is less exact.
    from: (f64, [f64; 6]),
}

impl Watch<'_, '_> {
    /// A line that no longer does what the stretch takes it to do.
    fn changed(&mut self, state: &State) -> Option<usize> {
        let Stretch {
            elastic, pulling, ..
        } = self.stretch;
        for line in 0..elastic.springs.len() {
            let keeps = elastic.keeps(line, state, pulling.contains(line));
            if keeps > 0.0 {
                self.found.fresh = self.found.fresh.without(line);
            } else if !self.found.fresh.contains(line) || keeps < -NOISE {
                return Some(line);
            }
        }
        None
    }

    fn locate<I>(&self, line: usize, mut low: f64, mut high: f64, dense: &mut I) -> f64
    where
        I: Interpolation<f64, [f64; 6]> + ?Sized,
    {
        let Stretch {
            elastic, pulling, ..
        } = self.stretch;
        let mut at = |s: f64| dense.interpolate(s).map(State::from_components).ok();
        while high - low > f64::EPSILON * high.abs().max(1.0) {
            let middle = 0.5 * (low + high);
            let goes_on = at(middle)
                .is_some_and(|state| elastic.keeps(line, &state, pulling.contains(line)) > 0.0);
            if goes_on {
                low = middle;
            } else {
                high = middle;
            }
            if middle == low && middle == high {
                break;
            }
        }
        high
    }
}

impl Solout<f64, [f64; 6]> for Watch<'_, '_> {
    fn solout<I>(
        &mut self,
        now: f64,
        before: f64,
        reached: &[f64; 6],
        start: &[f64; 6],
        dense: &mut I,
        _: &mut Solution<f64, [f64; 6]>,
    ) -> ControlFlag<f64, [f64; 6]>
    where
        I: Interpolation<f64, [f64; 6]> + ?Sized,
    {
        if now <= before {
            return ControlFlag::Continue;
        }
        let mut last = before;
        for k in 1..=LOOKS {
            let s = before + (now - before) * f64::from(k) / f64::from(LOOKS);
            let Ok(y) = dense.interpolate(s) else {
                continue;
            };
            let state = State::from_components(y);
            if let Some(line) = self.changed(&state) {
                self.found.change = Some(Change {
                    line,
                    s: self.locate(line, last, s, dense),
                    from: (before, *start),
                });
                return ControlFlag::Terminate;
            }
            (self.see)(self.stretch.begin + s, &state);
            last = s;
        }
        self.found.reached = *reached;
        ControlFlag::Continue
    }
}

/// Runs a structure on lines that stretch, to the end of its duration or until it is turned by a quarter.
/// `look_s` is the time between the states that are kept; `stop` is asked now and then whether to end.
///
/// # Errors
/// A [`CaseError`] if there are not as many springs as lines, or the integrator gives up.
pub fn run_elastic(
    prepared: &Prepared,
    springs: &[Spring],
    look_s: f64,
    stop: impl Fn() -> bool,
) -> Result<ElasticRun, CaseError> {
    let model = &prepared.model;
    let start = prepared.start();
    if springs.len() != model.system.cables.len() {
        let shown = springs.len().to_string();
        return Err(CaseError::value("springs", shown, "one for each line"));
    }
    let elastic = Elastic {
        system: &model.system,
        springs,
    };
    let mut record = Record::new(prepared, &elastic, look_s);
    let (mut t, mut state) = (0.0, start);
    let (mut pulling, mut fresh) = (elastic.pulling(&state), TautSet::SLACK);
    record.change(t, &state, TautSet::SLACK, pulling);
    record.see(t, &state, pulling);
    let end = model.rules.t_end;
    while t < end && state.theta.abs() < FRAC_PI_2 && !stop() {
        let step = elastic.longest_step(&state, pulling);
        let until = end.min(t + AT_A_TIME.min(TOGETHER * step));
        let stretch = Stretch {
            elastic: &elastic,
            begin: t,
            pulling,
        };
        let mut see = |t: f64, state: &State| record.see(t, state, pulling);
        let mut found = Found {
            fresh,
            change: None,
            reached: state.components(),
        };
        let watch = Watch {
            stretch: &stretch,
            see: &mut see,
            found: &mut found,
        };
        let method = || {
            let method = ExplicitRungeKutta::dop853();
            method.rtol(TOLERANCE).atol(TOLERANCE).h_max(step)
        };
        let solved = IVP::ode(&stretch, 0.0, until - t, state.components())
            .solout(watch)
            .method(method())
            .solve();
        solved.map_err(|error| gave_up(&error))?;
        let reached = match found.change {
            Some(Change {
                s, from: (s0, y0), ..
            }) if s > s0 => {
                let again = IVP::ode(&stretch, s0, s, y0).method(method()).solve();
                let again = again.map_err(|error| gave_up(&error))?;
                again.y.last().copied().unwrap_or(y0)
            }
            Some(Change { from: (_, y0), .. }) => y0,
            None => found.reached,
        };
        let reached = State::from_components(reached);
        (state, fresh) = (reached, found.fresh);
        let Some(Change { line, s, .. }) = found.change else {
            t = until;
            continue;
        };
        let before = pulling;
        pulling = if pulling.contains(line) {
            pulling.without(line)
        } else {
            pulling.with(line)
        };
        (t, fresh) = (t + s, fresh.with(line));
        record.see(t, &state, before);
        record.change(t, &state, before, pulling);
    }
    Ok(record.finish(t, state))
}

fn gave_up(error: &impl std::fmt::Debug) -> CaseError {
    let shown: String = format!("({error:?})").chars().take(80).collect();
    let allowed = "lines that the integrator can follow";
    CaseError::value("line.stiffness", shown, allowed)
        .with_hint("lower the stiffness, or the duration")
}

/// What is kept of a motion.
struct Record<'a> {
    prepared: &'a Prepared,
    elastic: &'a Elastic<'a>,
    look: f64,
    next: f64,
    run: ElasticRun,
    /// The pull that each line is in, by its place among the pulls.
    open: Vec<Option<usize>>,
}

impl<'a> Record<'a> {
    fn new(prepared: &'a Prepared, elastic: &'a Elastic<'a>, look_s: f64) -> Self {
        Self {
            prepared,
            elastic,
            look: look_s / prepared.model.scales.time_s,
            next: 0.0,
            run: ElasticRun {
                pulls: Vec::new(),
                looks: Vec::new(),
                end_s: 0.0,
                end: State::default(),
            },
            open: vec![None; elastic.springs.len()],
        }
    }

    fn see(&mut self, t: f64, state: &State, pulling: TautSet) {
        let scales = &self.prepared.model.scales;
        let tension = |line: usize| scales.force_n * self.elastic.grip(line, state).force.max(0.0);
        let t_s = t * scales.time_s;
        for line in pulling.iter() {
            if let Some(pull) = self.open[line].map(|place| &mut self.run.pulls[place]) {
                let now = tension(line);
                if now > pull.peak_n {
                    (pull.peak_n, pull.peak_s) = (now, t_s);
                }
            }
        }
        if t >= self.next {
            let lines = 0..self.open.len();
            let held = |line: usize| {
                if pulling.contains(line) {
                    tension(line)
                } else {
                    0.0
                }
            };
            self.run.looks.push(Look {
                t_s,
                state: *state,
                tension_n: lines.map(held).collect(),
            });
            self.next = t + self.look;
        }
    }

    fn change(&mut self, t: f64, state: &State, before: TautSet, after: TautSet) {
        let scales = &self.prepared.model.scales;
        let t_s = t * scales.time_s;
        for line in 0..self.open.len() {
            let grip = self.elastic.grip(line, state);
            let speed = grip.rate * scales.speed_m_s();
            match (before.contains(line), after.contains(line)) {
                (false, true) => {
                    self.open[line] = Some(self.run.pulls.len());
                    self.run.pulls.push(Pull {
                        line,
                        from_s: t_s,
                        to_s: t_s,
                        speed_m_s: speed,
                        rebound_m_s: None,
                        peak_n: scales.force_n * grip.force.max(0.0),
                        peak_s: t_s,
                    });
                }
                (true, false) => {
                    if let Some(place) = self.open[line].take() {
                        let pull = &mut self.run.pulls[place];
                        (pull.to_s, pull.rebound_m_s) = (t_s, Some(-speed));
                    }
                }
                _ => {}
            }
        }
    }

    fn finish(mut self, t: f64, state: State) -> ElasticRun {
        self.run.end_s = t * self.prepared.model.scales.time_s;
        self.run.end = state;
        for place in self.open.into_iter().flatten() {
            self.run.pulls[place].to_s = self.run.end_s;
        }
        self.run
    }
}

impl ElasticRun {
    /// The largest tension of each line \[N\].
    pub fn peaks_n(&self, structure: &Structure) -> Vec<f64> {
        let mut peaks = vec![0.0_f64; structure.lines.len()];
        for pull in &self.pulls {
            peaks[pull.line] = peaks[pull.line].max(pull.peak_n);
        }
        peaks
    }

    /// The part of the time in which a line does not pull.
    pub fn slack_fraction(&self, line: usize) -> f64 {
        let pulls = self.pulls.iter().filter(|pull| pull.line == line);
        1.0 - pulls.map(|pull| pull.to_s - pull.from_s).sum::<f64>() / self.end_s
    }
}
