//! Curves of special orbits in two parameters: folds, period doublings, Neimark-Sacker points,
//! grazes.
//!
//! The unknowns are the state at the section, the times from event to event, and both parameters;
//! the equations those of the closed lap and one condition ([`crate::condition`]). A curve is
//! followed by pseudo-arclength as a branch is.

use crate::branch_events::{BranchEvent, Kind};
use crate::continuation::{Continuation, Unknowns};
use crate::curve_borders::{Border, NO_LOSS, loses_less, margins, passed};
use crate::follower::check_followed;
use crate::hybrid::Family;
use crate::multipliers::{NEAR_CIRCLE, Stability};
use crate::normal_form::{Coefficient, coefficient};
use crate::on_curve::OnCurve;
use crate::orbit::{NoOrbit, Orbit};
use nalgebra::DVector;
use snapload::analysis::{Cancelled, OnProgress, Progress};

/// How a curve is followed.
#[derive(Clone, Copy, Debug)]
pub struct CurveOptions {
    /// The least and the greatest value of either parameter.
    pub ranges: [[f64; 2]; 2],
    /// The length of the first step, in the space of state, times and parameters.
    pub step: f64,
    /// The most points in either direction.
    pub most: usize,
}

/// A point of a curve.
#[derive(Clone, Debug)]
pub struct CurvePoint {
    /// The special orbit, which may be inadmissible.
    pub orbit: Orbit,
    /// The stability by its other multipliers, besides those that make it special: whether a stable
    /// orbit loses its stability or ends here.
    pub others: Stability,
    /// The length along the curve from its first point.
    pub arclength: f64,
    /// The coefficient of the normal form: that of the square at a fold, and that of the
    /// cube at a period doubling, where a positive one says that the orbits of twice the
    /// length are stable if all other multipliers are. That of a fold is of eigenvectors
    /// that point alike along the curve.
    pub coefficient: Option<f64>,
    eigenvector: Option<DVector<f64>>,
    /// a = −g̈/2r at a graze.
    pub normal_acceleration: Option<f64>,
    /// (1 + e) √(2a) at a graze.
    pub sqrt_coefficient: Option<f64>,
}

/// An end of a curve: both values, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveEnd {
    /// The values of the parameters.
    pub at: [f64; 2],
    /// Why.
    pub because: String,
}

/// A curve of special orbits.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Their kind.
    pub kind: Kind,
    /// Its points, from one end to the other.
    pub points: Vec<CurvePoint>,
    /// Its two ends.
    pub ends: [CurveEnd; 2],
}

/// The longest and the shortest step, in units of the first.
const LONGEST_STEP: f64 = 6.0;
const SHORTEST_STEP: f64 = 1e-6;
/// From the first number of the corrector's iterations on, the next step is made shorter; up to the
/// second, longer.
const SHORTEN_FROM: usize = 7;
const LENGTHEN_TO: usize = 4;
impl Curve {
    /// The kinds of special orbits that have curves.
    pub const KINDS: [Kind; 4] = [
        Kind::Fold,
        Kind::PeriodDoubling,
        Kind::NeimarkSacker,
        Kind::Graze,
    ];

    /// The curve through a special point of a branch in the first parameter.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled; within it [`NoOrbit`] if the point is not of such a
    /// kind, no such orbit is found there, or a range or the step is not allowed.
    pub fn of<F: Family>(
        family: &F,
        event: &BranchEvent,
        options: &CurveOptions,
        on_progress: OnProgress,
    ) -> Result<Result<Self, NoOrbit>, Cancelled> {
        if let Err(error) = check_followed(&options.ranges, options.step) {
            return Ok(Err(NoOrbit(error.to_string())));
        }
        let orbit = &event.orbit;
        let continuation = Continuation {
            family,
            sequence: orbit.lap.sequence.clone(),
            phase: orbit.phase,
            periods: orbit.periods,
        };
        let start = Unknowns {
            z: orbit.z,
            durations: orbit.lap.durations.clone(),
            at: orbit.at,
        };
        let Some(on_curve) = OnCurve::start_at(continuation, start, event) else {
            let name = event.kind.name().replace('_', " ");
            let why = match orbit.lap.accumulates() {
                true => {
                    "; rows of ever slower snaps, as this orbit has before a cable stays taut, can not be followed"
                }
                false => "",
            };
            return Ok(Err(NoOrbit(format!(
                "Newton's method finds no point of the curve from the {name} at {:.9}{why}",
                event.value[0]
            ))));
        };
        let first = point(&on_curve, on_curve.orbit(), 0.0);
        let mut follower = Follower {
            options,
            on_progress,
            done: 0,
        };
        let backward = follower.run(on_curve.turned())?;
        let forward = match backward.closed {
            true => HalfCurve::empty(on_curve.here.at, "the curve is closed"),
            false => follower.run(on_curve)?,
        };
        let mut points = backward.points;
        points
            .iter_mut()
            .for_each(|point| point.arclength = -point.arclength);
        points.reverse();
        points.push(first);
        points.extend(forward.points);
        if event.kind == Kind::Fold {
            orient(&mut points);
        }
        Ok(Ok(Self {
            kind: event.kind,
            points,
            ends: [backward.end, forward.end],
        }))
    }
}

/// Gives the coefficients of folds the signs of eigenvectors that point alike along the curve: the
/// eigenvector by itself is known up to its sign.
fn orient(points: &mut [CurvePoint]) {
    let mut last: Option<DVector<f64>> = None;
    for point in points {
        let form = point.coefficient.zip(point.eigenvector.take());
        if let Some((value, eigenvector)) = form {
            let mut form = Coefficient { value, eigenvector };
            form.oriented(last.as_ref());
            point.coefficient = Some(form.value);
            last = Some(form.eigenvector);
        }
    }
}

/// The curve in one direction.
struct HalfCurve {
    points: Vec<CurvePoint>,
    end: CurveEnd,
    closed: bool,
}

impl HalfCurve {
    fn empty(at: [f64; 2], because: &str) -> Self {
        Self {
            points: Vec::new(),
            end: CurveEnd {
                at,
                because: because.to_owned(),
            },
            closed: false,
        }
    }

    /// Closes it at its first point, which becomes its last one, too.
    fn close<F: Family>(&mut self, first: &OnCurve<F>, arclength: f64) {
        self.end.at = first.here.at;
        self.end.because = "the curve is closed".to_owned();
        self.closed = true;
        self.points.push(point(first, first.orbit(), arclength));
    }

    /// Ends at a border that is passed at this arclength; its last point is on the border if that
    /// was found.
    fn end_on<F: Family>(&mut self, border: Border<F>, arclength: f64, ranges: &[[f64; 2]; 2]) {
        self.end.because = border.what.to_owned();
        let is_between_sequences = border.is_between_sequences();
        if let Some(last) = border.place {
            let mut point = point(&last, last.orbit(), arclength + border.sigma);
            if is_between_sequences {
                point.orbit = point.orbit.by_survey();
            }
            // The value itself where Newton's method comes to it up to rounding.
            if let Some(value) = ranges.as_flattened().get(border.number) {
                point.orbit.at[border.number / 2] = *value;
            }
            self.end.at = point.orbit.at;
            self.points.push(point);
        }
    }
}

/// The stability by the multipliers other than the one nearest to 1 or to −1, or than the pair of a
/// torus.
fn others(kind: Kind, orbit: &Orbit) -> Stability {
    let mut left = orbit.multipliers.clone();
    let mut take_at = |critical: f64| {
        let off = |[re, im]: [f64; 2]| (re - critical).hypot(im);
        let values = left.values.iter().enumerate();
        let nearest = values.min_by(|a, b| off(*a.1).total_cmp(&off(*b.1)));
        if let Some((place, _)) = nearest {
            left.values.remove(place);
        }
        // Two that meet there, as without losses, are known to half of the digits.
        let near = |value: &&mut [f64; 2]| off(**value) < NEAR_CIRCLE;
        let double = left.values.iter_mut().filter(near);
        double.for_each(|value| *value = [critical, 0.0]);
    };
    match kind {
        Kind::Fold => take_at(1.0),
        Kind::PeriodDoubling => take_at(-1.0),
        Kind::NeimarkSacker => {
            if let Some([i, j]) = left.pair_of_torus() {
                left.values.remove(j);
                left.values.remove(i);
            }
        }
        _ => {}
    }
    left.stability()
}

fn point<F: Family>(on_curve: &OnCurve<F>, orbit: Orbit, arclength: f64) -> CurvePoint {
    let acceleration = on_curve
        .condition
        .normal_acceleration(&on_curve.continuation, &on_curve.here);
    let restitution = on_curve
        .continuation
        .family
        .snap_contraction(on_curve.here.at)
        .sqrt();
    let kind = on_curve.condition.kind();
    let orbit = match kind {
        Kind::Graze => orbit.by_survey(),
        _ => orbit,
    };
    let form = coefficient(&on_curve.continuation, &on_curve.here, kind);
    CurvePoint {
        others: others(kind, &orbit),
        orbit,
        arclength,
        coefficient: form.as_ref().map(|form| form.value),
        eigenvector: form.map(|form| form.eigenvector),
        normal_acceleration: acceleration,
        sqrt_coefficient: acceleration.map(|a| (1.0 + restitution) * (2.0 * a).max(0.0).sqrt()),
    }
}

/// Follows curves.
struct Follower<'a> {
    options: &'a CurveOptions,
    on_progress: OnProgress<'a>,
    done: usize,
}

impl Follower<'_> {
    fn run<F: Family>(&mut self, mut on_curve: OnCurve<F>) -> Result<HalfCurve, Cancelled> {
        let first = on_curve.copied();
        let mut half = HalfCurve::empty(first.here.at, "");
        let ranges = self.options.ranges;
        let mut before = margins(ranges, &on_curve, &on_curve.orbit());
        let (mut step, mut arclength) = (self.options.step, 0.0);
        while half.end.because.is_empty() {
            if half.points.len() >= self.options.most {
                half.end.because = format!("the limit of {} points is reached", self.options.most);
                break;
            }
            let stepped = on_curve.stepped(step).map(|(next, steps)| {
                let orbit = next.orbit();
                let reached = margins(ranges, &next, &orbit);
                (next, steps, orbit, reached)
            });
            let border = stepped
                .as_ref()
                .and_then(|(.., reached)| passed(ranges, &on_curve, step, &before, reached));
            let lost = border.as_ref().is_some_and(|border| border.place.is_none());
            let Some((next, steps, orbit, reached)) = stepped.filter(|_| !lost) else {
                step *= 0.5;
                if step < self.options.step * SHORTEST_STEP {
                    half.end.because = "Newton's method finds no further point".to_owned();
                }
                continue;
            };
            if loses_less(&before, &reached) {
                half.end.because = NO_LOSS.to_owned();
                break;
            }
            if let Some(sigma) = on_curve.passes(&first, step).filter(|_| border.is_none()) {
                half.close(&first, arclength + sigma);
                break;
            }
            if let Some(border) = border {
                half.end_on(border, arclength, &ranges);
                break;
            }
            arclength += step;
            half.end.at = next.here.at;
            if !next.condition.is_met(&orbit) {
                half.end.because =
                    "the pair of multipliers is not on the unit circle from here on".to_owned();
                break;
            }
            (on_curve, before) = (next, reached);
            let orbit = match on_curve.renumber_events() {
                true => on_curve.orbit(),
                false => orbit,
            };
            half.points.push(point(&on_curve, orbit, arclength));
            self.done += 1;
            let of = (2 * self.options.most) as f64;
            Progress::new("points", self.done as f64, of).report(self.on_progress)?;
            step = self.next_length(step, steps);
        }
        Ok(half)
    }

    /// The length of the next step, from the number of Newton's iterations in the last one.
    fn next_length(&self, step: f64, steps: usize) -> f64 {
        match steps {
            SHORTEN_FROM.. => step * 0.6,
            0..=LENGTHEN_TO => (step * 1.4).min(self.options.step * LONGEST_STEP),
            _ => step,
        }
    }
}
