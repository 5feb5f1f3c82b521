//! Events along a branch: test functions, and their zeros.

use crate::branch_point::branch_point;
use crate::continuation::{BranchStep, Unknowns};
use crate::hybrid::{DURATION, Family, Hybrid, Jet, Point, constant};
use crate::multipliers::Multipliers;
use crate::orbit::Orbit;
use crate::roots::root;
use crate::survey::Extreme;
use nalgebra::DVector;
use snapload::Limit;

/// The kind of an event along a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The branch turns back in the parameter: μ = 1.
    Fold,
    /// μ = −1: a branch of orbits of twice the length begins.
    PeriodDoubling,
    /// |μ| = 1 for a complex pair: a torus begins.
    NeimarkSacker,
    /// μ = 1 where another branch crosses this one, as at the end of a symmetry.
    BranchPoint,
    /// A surface is touched with zero velocity.
    Graze,
    /// Two surfaces are struck at one instant.
    Corner,
    /// The tension of a held surface is zero.
    TensionLost,
    /// A limit is reached.
    Limit(Limit),
}

impl Kind {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        let events = [
            Self::Fold,
            Self::PeriodDoubling,
            Self::NeimarkSacker,
            Self::BranchPoint,
            Self::Graze,
            Self::Corner,
            Self::TensionLost,
        ];
        events.into_iter().chain(Limit::ALL.map(Self::Limit))
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::PeriodDoubling => "period_doubling",
            Self::NeimarkSacker => "neimark_sacker",
            Self::BranchPoint => "branch_point",
            Self::Graze => "graze",
            Self::Corner => "corner",
            Self::TensionLost => "tension_lost",
            Self::Limit(limit) => limit.stop().name(),
        }
    }
}

/// An event of a branch.
#[derive(Clone, Debug)]
pub struct BranchEvent {
    /// Its kind.
    pub kind: Kind,
    /// The values of the two parameters.
    pub value: [f64; 2],
    /// The orbit there.
    pub orbit: Orbit,
    /// The surface concerned.
    pub surface: Option<usize>,
    /// The time within the lap.
    pub t: Option<f64>,
    /// a = −g̈/2r at a graze, with which the gap opens on either side.
    pub normal_acceleration: Option<f64>,
    /// (1 + e) √(2a): the jump of the normal velocity is this times the root of the depth h by
    /// which the surface would be passed (A. B. Nordmark, *J. Sound Vib.* 145 (1991) 279).
    pub sqrt_coefficient: Option<f64>,
    /// Whether a snap of the sequence itself grazes, and not a contact in addition to it.
    pub is_own_snap: bool,
    /// The length along the branch from the orbit with which it was started.
    pub arclength: f64,
    /// Between which values of the first parameter it lies, where it is not located: the orbit is
    /// then that of a point of the branch just beyond it.
    pub between: Option<[f64; 2]>,
    /// The position between the two points of the branch.
    pub(crate) sigma: f64,
}

/// An orbit counts as special if a multiplier, a gap or a velocity is this close to its critical
/// value.
const SPECIAL_WITHIN: f64 = 1e-6;

impl BranchEvent {
    /// An event without a contact, at a position between the two points of a branch.
    pub(crate) fn plain(kind: Kind, orbit: Orbit, sigma: f64) -> Self {
        Self {
            kind,
            value: orbit.at,
            orbit,
            surface: None,
            t: None,
            normal_acceleration: None,
            sqrt_coefficient: None,
            is_own_snap: false,
            arclength: sigma,
            between: None,
            sigma,
        }
    }

    /// Whether a branch ends there.
    pub(crate) fn ends_branch(&self) -> bool {
        self.kind == Kind::Corner || (self.kind == Kind::Graze && self.is_own_snap)
    }

    /// Whether a multiplier is on the unit circle there.
    pub fn is_bifurcation(&self) -> bool {
        matches!(
            self.kind,
            Kind::Fold | Kind::PeriodDoubling | Kind::NeimarkSacker | Kind::BranchPoint
        )
    }

    /// The event at an orbit that is itself special, such as one that was found as an event of a
    /// branch before.
    pub fn here(kind: Kind, orbit: &Orbit) -> Option<Self> {
        let values = &orbit.multipliers.values;
        let near = |extreme: &Extreme| extreme.value.abs() < SPECIAL_WITHIN;
        let gap = orbit.survey.largest_gap.filter(near);
        let speed = orbit.survey.least_speed.filter(near);
        let at = |place: f64| {
            let near = |[re, im]: &[f64; 2]| (re - place).hypot(*im) < SPECIAL_WITHIN;
            values.iter().filter(|value| near(value)).count() == 1
        };
        let pair = |[re, im]: &[f64; 2]| *im > 0.0 && (re.hypot(*im) - 1.0).abs() < SPECIAL_WITHIN;
        let is_there = match kind {
            Kind::Fold => at(1.0),
            Kind::PeriodDoubling => at(-1.0),
            Kind::NeimarkSacker => values.iter().filter(|value| pair(value)).count() == 1,
            Kind::Graze => gap.is_some() || speed.is_some(),
            Kind::BranchPoint | Kind::Corner | Kind::TensionLost | Kind::Limit(_) => false,
        };
        let nearest = gap.or(speed).filter(|_| kind == Kind::Graze);
        is_there.then(|| Self {
            surface: nearest.map(|extreme| extreme.surface),
            t: nearest.map(|extreme| extreme.t),
            is_own_snap: gap.is_none() && speed.is_some(),
            ..Self::plain(kind, orbit.clone(), 0.0)
        })
    }
}

/// A function that is zero at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Test {
    Fold,
    PeriodDoubling,
    NeimarkSacker,
    BranchPoint,
    Speed,
    Gap,
    Corner,
    Tension,
    Limit(Limit),
}

impl Test {
    /// All of them.
    fn all() -> impl Iterator<Item = Self> {
        let tests = [
            Self::Fold,
            Self::PeriodDoubling,
            Self::NeimarkSacker,
            Self::BranchPoint,
            Self::Speed,
            Self::Gap,
            Self::Corner,
            Self::Tension,
        ];
        tests.into_iter().chain(Limit::ALL.map(Self::Limit))
    }

    /// Whether it vanishes where a multiplier is on the unit circle.
    fn is_of_multipliers(self) -> bool {
        matches!(
            self,
            Self::Fold | Self::PeriodDoubling | Self::NeimarkSacker | Self::BranchPoint
        )
    }
}

/// A test function smaller than this is taken as identically zero, as on a family of neutral
/// orbits.
const NOT_CROSSING: f64 = 1e-9;
/// A test function above this is not identically zero, wherever else it vanishes.
const CROSSING: f64 = 1e-7;
/// The largest value of a test function that is accepted as a zero.
const ZERO: f64 = 1e-6;

/// A point of a branch, as far as the events before and after it are concerned.
pub(crate) struct Tested {
    /// The values of all test functions; NaN for those that do not exist.
    tests: Vec<(Test, f64)>,
    multipliers: Multipliers,
}

impl Tested {
    pub(crate) fn new(orbit: &Orbit, tangent: &DVector<f64>) -> Self {
        let tests = Test::all().map(|test| (test, value(test, orbit, tangent)));
        Self {
            tests: tests.collect(),
            multipliers: orbit.multipliers.clone(),
        }
    }

    /// The same, reached from another point: a test function that vanishes just here counts as
    /// still on the side of that point, so that the next step has the change of sign.
    pub(crate) fn reached_from(mut self, before: &Self) -> Self {
        for ((test, here), (_, there)) in self.tests.iter_mut().zip(&before.tests) {
            if test.is_of_multipliers() && here.is_nan() && there.abs() > CROSSING {
                *here = NOT_CROSSING.copysign(*there);
            }
        }
        self
    }

    /// The test functions that change their signs up to another point, with their values here and
    /// there.
    pub(crate) fn changed<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (Test, f64, f64)> + 'a {
        let both = self.tests.iter().zip(&other.tests);
        both.map(|((test, a), (_, b))| (*test, *a, *b))
            .filter(|(_, a, b)| a.is_finite() && b.is_finite() && (*a < 0.0) != (*b < 0.0))
    }

    /// The kind of event by which the number of multipliers outside the unit circle certainly
    /// changes up to other multipliers, by the one nearest to the circle; none if it may be the
    /// same.
    pub(crate) fn stability_changes(&self, other: &Multipliers) -> Option<Kind> {
        let [[low, high], [other_low, other_high]] =
            [&self.multipliers, other].map(Multipliers::outside);
        if low <= other_high && other_low <= high {
            return None;
        }
        let values = self.multipliers.values.iter().chain(&other.values);
        let off = |[re, im]: &[f64; 2]| (re.hypot(*im) - 1.0).abs();
        let nearest = values.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        Some(match *nearest {
            [_, im] if im != 0.0 => Kind::NeimarkSacker,
            [re, _] if re < 0.0 => Kind::PeriodDoubling,
            _ => Kind::BranchPoint,
        })
    }
}

fn value(test: Test, orbit: &Orbit, tangent: &DVector<f64>) -> f64 {
    let survey = &orbit.survey;
    let extreme = |extreme: Option<Extreme>, none| extreme.map_or(none, |e: Extreme| e.value);
    let multipliers = &orbit.multipliers.values;
    let cleared = |value: f64| {
        if value.abs() < NOT_CROSSING {
            f64::NAN
        } else {
            value
        }
    };
    match test {
        Test::Fold => cleared(tangent[tangent.len() - 1]),
        Test::PeriodDoubling => {
            cleared(product(multipliers.iter().map(|[re, im]| [1.0 + re, *im])))
        }
        Test::NeimarkSacker => cleared(pairs(multipliers)),
        // The determinant of the derivatives bordered by the direction, up to a factor without a
        // zero: where the branch turns back both are zero.
        Test::BranchPoint => {
            let along = cleared(tangent[tangent.len() - 1]);
            cleared(product(multipliers.iter().map(|[re, im]| [1.0 - re, *im]))) / along
        }
        Test::Speed => extreme(survey.least_speed, f64::NAN),
        Test::Gap => extreme(survey.largest_gap, -1.0),
        Test::Corner => extreme(survey.corner_gap, -1.0),
        Test::Tension => extreme(survey.slackest(), f64::NAN),
        Test::Limit(limit) => survey.limits[limit as usize],
    }
}

/// The product of complex numbers that come in conjugate pairs.
fn product(numbers: impl Iterator<Item = [f64; 2]>) -> f64 {
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    numbers.fold([1.0, 0.0], times)[0]
}

/// Π (1 − μ_i μ_j), i < j: zero where a pair has the product 1.
fn pairs(multipliers: &[[f64; 2]]) -> f64 {
    let mut factors = Vec::new();
    for (i, [a, b]) in multipliers.iter().enumerate() {
        for [c, d] in &multipliers[i + 1..] {
            factors.push([1.0 - (a * c - b * d), -(a * d + b * c)]);
        }
    }
    product(factors.into_iter())
}

/// The event between two points at which a test function changes its sign; none if that is not a
/// zero of it, or not the event wanted.
pub(crate) fn located<F: Family>(
    branch_step: &BranchStep<F>,
    test: Test,
    before: f64,
    after: f64,
) -> Option<BranchEvent> {
    let (continuation, tangent) = (branch_step.continuation, branch_step.tangent);
    if test == Test::BranchPoint {
        let guess = branch_step.length * before / (before - after);
        let (u, sigma) = branch_point(branch_step, guess)?;
        let orbit = orbit_of(branch_step, &u);
        return Some(BranchEvent::plain(Kind::BranchPoint, orbit, sigma));
    }
    let orbit_at = |sigma: f64| {
        let (u, ..) = continuation.corrected(branch_step.from, tangent, sigma)?;
        let direction = continuation.tangent(&u, tangent)?;
        Some((Orbit::of(&continuation.lap(u.at), &u.closed()), direction))
    };
    let of = |sigma: f64| {
        let found = orbit_at(sigma);
        found.map_or(f64::NAN, |(orbit, direction)| raw(test, &orbit, &direction))
    };
    let first = first_place(&of, before, (branch_step.length, after));
    let sigma = root(&of, first, (branch_step.length, after));
    let (orbit, direction) = orbit_at(sigma)?;
    if raw(test, &orbit, &direction).abs() > ZERO || !is_meant(test, &orbit) {
        return None;
    }
    let survey = &orbit.survey;
    let (kind, extreme) = match test {
        Test::Fold => (Kind::Fold, None),
        Test::PeriodDoubling => (Kind::PeriodDoubling, None),
        Test::NeimarkSacker => (Kind::NeimarkSacker, None),
        Test::BranchPoint => (Kind::BranchPoint, None),
        Test::Speed => (Kind::Graze, survey.least_speed),
        Test::Gap => (Kind::Graze, survey.largest_gap),
        Test::Corner => (Kind::Corner, survey.corner_gap),
        Test::Tension => (Kind::TensionLost, survey.slackest()),
        Test::Limit(limit) => (Kind::Limit(limit), None),
    };
    let grazes = extreme.filter(|_| kind == Kind::Graze);
    let acceleration = grazes.map(|extreme| normal_acceleration(branch_step, &orbit, &extreme));
    let (u, ..) = continuation.corrected(branch_step.from, tangent, sigma)?;
    let orbit = orbit_of(branch_step, &u);
    let orbit = match kind {
        Kind::Graze => orbit.by_survey(),
        _ => orbit,
    };
    let restitution = continuation.family.snap_contraction(orbit.at).sqrt();
    Some(BranchEvent {
        surface: extreme.map(|extreme| extreme.surface),
        t: extreme.map(|extreme| extreme.t),
        normal_acceleration: acceleration,
        sqrt_coefficient: acceleration.map(|a| (1.0 + restitution) * (2.0 * a).max(0.0).sqrt()),
        is_own_snap: test == Test::Speed,
        ..BranchEvent::plain(kind, orbit, sigma)
    })
}

/// Where the search for a zero begins: at the start of the step or, where the test function all but
/// vanishes there, so little before it that the zero lies between.
fn first_place(of: &dyn Fn(f64) -> f64, before: f64, (length, after): (f64, f64)) -> (f64, f64) {
    if before.abs() <= NOT_CROSSING {
        let place = -2.0 * length * before / (before - after);
        let value = of(place);
        if (value < 0.0) == (before < 0.0) && value.is_finite() {
            return (place, value);
        }
    }
    (0.0, before)
}

/// The orbit at a point of a step; if events have passed the section, they are numbered from there.
fn orbit_of<F: Family>(branch_step: &BranchStep<F>, u: &Unknowns) -> Orbit {
    let continuation = branch_step.continuation;
    match continuation.renumbered(u) {
        Some((moved, u, _)) => Orbit::of(&moved.lap(u.at), &u.closed()),
        None => Orbit::of(&continuation.lap(u.at), &u.closed()),
    }
}

/// a = −g̈/2r of a surface at an instant of a lap.
fn normal_acceleration<F: Family>(branch_step: &BranchStep<F>, orbit: &Orbit, at: &Extreme) -> f64 {
    let continuation = branch_step.continuation;
    let system = continuation.family.plain(orbit.at);
    let legs = continuation
        .lap(orbit.at)
        .legs(&system, &orbit.z, &orbit.lap.durations);
    let leg = legs[at.leg];
    let jets = continuation.family.jets(orbit.at);
    let start: Point<Jet> = leg.start.map(constant);
    let s = Jet::variable(at.t - leg.t, DURATION);
    let there = jets.flow(leg.taut, constant(leg.t), &start, s);
    -jets.speed(at.surface, &there).slope[DURATION]
}

/// The test function without the guard against families of neutral orbits.
fn raw(test: Test, orbit: &Orbit, tangent: &DVector<f64>) -> f64 {
    let multipliers = &orbit.multipliers.values;
    match test {
        Test::Fold => tangent[tangent.len() - 1],
        Test::PeriodDoubling => product(multipliers.iter().map(|[re, im]| [1.0 + re, *im])),
        Test::NeimarkSacker => pairs(multipliers),
        _ => value(test, orbit, tangent),
    }
}

/// Whether the multipliers are those of the event: two real ones whose product is 1 are not a
/// torus.
fn is_meant(test: Test, orbit: &Orbit) -> bool {
    let multipliers = &orbit.multipliers.values;
    match test {
        // Where later contact erases all deviations, the value changes with the square of the speed
        // of a snap: at its graze it turns back, but no multiplier is 1.
        Test::Fold => multipliers
            .iter()
            .any(|[re, im]| (re - 1.0).hypot(*im) < 1e-2),
        Test::PeriodDoubling => multipliers
            .iter()
            .any(|[re, im]| (re + 1.0).hypot(*im) < 1e-4),
        Test::NeimarkSacker => multipliers
            .iter()
            .any(|[re, im]| *im != 0.0 && (re.hypot(*im) - 1.0).abs() < 1e-5),
        _ => true,
    }
}
