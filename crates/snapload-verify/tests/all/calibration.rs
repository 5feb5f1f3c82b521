//! The calibration of the reported errors and horizons: random cases of every kind are compared
//! with the same cases with 76 digits, including taut motion.
//!
//! By docs/trust.md an error is two standard deviations, so a horizon is too late in a run whose
//! actual error is larger than that.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use snapload::analysis::{NormErrors, Trust, Uncertainty, Unfinished, no_progress, trusted_run};
use snapload::{Case, CaseError, Impact, Parameters, Precise, Real, Simulation, Trajectory, Value};
use std::fmt::Write;

pub type Digits = Precise<4>;

const TOLERANCES: [f64; 2] = [1e-3, 1e-6];
/// The run with many digits is followed for at most this number of impacts.
const MOST_IMPACTS: usize = 300;
/// It is followed for at most this number of expansions of taut motion, for which many digits take
/// a hundred times as long as doubles.
const MOST_EXPANSIONS: usize = 30;

const STRATA: [&str; 8] = [
    "thesis's range",
    "long cables, r to 1000",
    "large bodies, b to 30",
    "light and heavy, I / (a² + b²) from 1e-6 to 1000",
    "fast waves, Ω to 1000",
    "point masses",
    "taut motion",
    "e from 0.95 to 1",
];

/// Random numbers of four digits, like those that people write.
struct Draw(ChaCha8Rng);

impl Draw {
    fn unit(&mut self) -> f64 {
        self.0.next_u32() as f64 / 2.0_f64.powi(32)
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        written(low + (high - low) * self.unit())
    }
    /// Uniform in the logarithm.
    fn over(&mut self, low: f64, high: f64) -> f64 {
        written(low * (high / low).powf(self.unit()))
    }
}

fn written(number: f64) -> f64 {
    format!("{number:.3e}").parse().expect("a number")
}

/// A random case of a kind.
pub fn random_case(index: usize) -> Case {
    let seed = u64::try_from(index).expect("few");
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
    (0..1000)
        .find_map(|_| drawn(index % STRATA.len(), &mut draw).ok())
        .expect("a legal start")
}

/// A random case of a stratum; an error if its start is not legal.
fn drawn(stratum: usize, draw: &mut Draw) -> Result<Case, CaseError> {
    let mut e = draw.between(0.6, 1.0);
    let mut r = draw.between(1.05, 3.0);
    let mut a = draw.between(0.03, 0.6);
    let mut b = if draw.unit() < 0.4 {
        0.0
    } else {
        draw.between(0.03, 0.6)
    };
    let mut f_o = draw.between(-0.6, 0.6);
    let mut omega = draw.between(0.3, 2.5);
    let (mut t_end, mut size) = (60.0, 1.0);
    let mut more = Vec::new();
    match stratum {
        1 => (r, size) = (draw.over(3.0, 1000.0), 3.0),
        2 => {
            (a, b) = (draw.over(0.1, 10.0), draw.over(0.6, 30.0));
            r = (r + (1.0 - a).abs()) * draw.over(1.0, 10.0);
        }
        3 => {
            let inertia = draw.over(1e-6, 1e3) * (a * a + b * b);
            more.push(("inertia", Value::Number(written(inertia))));
        }
        4 => (omega, f_o) = (draw.over(3.0, 1000.0), f_o * draw.over(1.0, 10.0)),
        5 => (a, b) = (0.0, 0.0),
        6 => {
            (e, f_o, t_end) = (draw.between(0.0, 0.6), 0.5 * f_o, 25.0);
            more.push(("stop_when_settled", Value::Bool(false)));
        }
        7 => e = draw.between(0.95, 1.0),
        _ => {}
    }
    let number = |key, value| (key, Value::Number(written(value)));
    let mut entries = vec![
        number("r", r),
        number("e", e),
        number("f_o", f_o),
        number("omega", omega),
        number("nu", draw.between(-1.0, 1.0)),
        number("x", size * draw.between(-0.3, 0.3)),
        number("y", size * draw.between(0.05, 0.6)),
        number("vx", draw.between(-0.5, 0.5)),
        number("vy", draw.between(-0.5, 0.5)),
        number("t_end", t_end),
    ];
    entries.extend(if stratum == 5 {
        vec![("body", Value::from("point"))]
    } else {
        let (theta, vtheta) = (draw.between(-0.3, 0.3), draw.between(-0.3, 0.3));
        vec![
            number("a", a),
            number("b", b),
            number("theta", theta),
            number("vtheta", vtheta),
        ]
    });
    entries.extend(more);
    Parameters::from_entries(entries).and_then(Case::new)
}

/// A run, and its differences from the one with many digits.
struct Judged {
    index: usize,
    trusts: [Trust; 2],
    /// The difference at each impact that both runs have.
    differences: Vec<f64>,
    /// The first impact, from 1, that only one of them has, the end counted as one more.
    parted: Option<usize>,
}

impl Judged {
    fn new(index: usize) -> Self {
        let case = random_case(index);
        let [(run, coarse), (_, fine)] = TOLERANCES.map(|tolerance| {
            let uncertainty = Uncertainty {
                tolerance,
                ..Uncertainty::default()
            };
            trusted_run(&case, &uncertainty, &no_progress).expect("legal")
        });
        let exact = case.simulation_over(|_, number| Digits::from_decimal(number));
        let (differences, parted) = compared(&run, exact.expect("a legal start"), MOST_EXPANSIONS);
        Self {
            index,
            trusts: [coarse, fine],
            differences,
            parted,
        }
    }

    /// The first impact that is wrong by more than a tolerance.
    fn wrong(&self, tolerance: f64) -> Option<usize> {
        let wrong = self.differences.iter().position(|d| *d > tolerance);
        wrong.map(|k| k + 1).or(self.parted)
    }

    /// The number of impacts by which the horizon is reported too late, or, if negative, too early;
    /// none if there is no horizon, or none that was reached.
    fn late(&self, which: usize) -> Option<i64> {
        let followed = self.differences.len() + 1;
        let (wrong, horizon) = (self.wrong(TOLERANCES[which]), self.trusts[which].horizon);
        if wrong.is_none() && horizon.is_none_or(|horizon| horizon.impact > followed) {
            return None;
        }
        let place = |impact: Option<usize>| impact.unwrap_or(followed).min(followed) as i64;
        Some(place(horizon.map(|horizon| horizon.impact)) - place(wrong))
    }

    /// Whether the whole run is wrongly called known.
    fn wrongly_certain(&self, which: usize) -> bool {
        self.trusts[which].horizon.is_none() && self.wrong(TOLERANCES[which]).is_some()
    }

    /// The differences before the horizon, divided by the reported errors.
    fn ratios(&self) -> Vec<f64> {
        let pairs = self.differences.iter().zip(&self.trusts[0].errors);
        let horizon = self.trusts[0]
            .horizon
            .map_or(usize::MAX, |horizon| horizon.impact - 1);
        pairs
            .take(horizon)
            .map(|(difference, error)| difference / error)
            .collect()
    }
}

/// The differences from the run with many digits, as far as that is followed, and where the two no
/// longer have the same events.
pub fn compared(
    run: &Trajectory,
    mut exact: Simulation<Digits>,
    most_expansions: usize,
) -> (Vec<f64>, Option<usize>) {
    let (mut differences, mut expansions) = (Vec::new(), 0);
    while let Some(step) = exact.step() {
        expansions += usize::from(!step.taut.is_empty());
        for theirs in step.impacts() {
            let place = differences.len();
            match run.impacts().get(place) {
                Some(ours) if ours.cable == theirs.cable => {
                    differences.push(difference(ours, &theirs));
                }
                _ => return (differences, Some(place + 1)),
            }
        }
        let lost = differences.last().is_some_and(|d| *d > 0.1);
        if lost || differences.len() > MOST_IMPACTS || expansions > most_expansions {
            return (differences, None);
        }
    }
    let alike = exact.stop() == Some(run.end().reason) && differences.len() == run.impacts().len();
    let end = differences.len() + 1;
    (differences, (!alike).then_some(end))
}

fn difference(ours: &Impact, theirs: &Impact<Digits>) -> f64 {
    let relative = |ours: f64, theirs: Digits| {
        let off = (Digits::from_f64(ours) - theirs).to_f64().abs();
        off / theirs.to_f64().abs().max(1.0)
    };
    let states = [(&ours.before, &theirs.before), (&ours.after, &theirs.after)];
    let states = states.map(|(ours, theirs)| {
        let pairs = ours.components().into_iter().zip(theirs.components());
        pairs
            .map(|(ours, theirs)| relative(ours, theirs))
            .fold(0.0, f64::max)
    });
    relative(ours.t, theirs.t).max(states[0]).max(states[1])
}

fn part(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1) as f64;
    sorted
        .get((part * last).round() as usize)
        .copied()
        .unwrap_or(f64::NAN)
}

/// The results of a sample, in a row of a table.
struct Row {
    horizons: usize,
    /// The part of the horizons that is too late, and the largest delay in impacts.
    late: f64,
    latest: i64,
    /// The median number of impacts by which they are too early.
    early: f64,
    /// The impacts compared, the median of difference over error, and the part above three.
    impacts: usize,
    median: f64,
    overstated: f64,
    wrongly_certain: Vec<usize>,
}

impl Row {
    fn of<'a>(sample: impl Iterator<Item = &'a Judged> + Clone) -> Self {
        let both = || {
            sample
                .clone()
                .flat_map(|judged| [0, 1].map(|which| (judged, which)))
        };
        let late: Vec<i64> = both()
            .filter_map(|(judged, which)| judged.late(which))
            .collect();
        let early: Vec<f64> = late.iter().map(|late| -late as f64).collect();
        let ratios: Vec<f64> = sample.clone().flat_map(Judged::ratios).collect();
        let wrong = both().filter(|(judged, which)| judged.wrongly_certain(*which));
        let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
        Self {
            horizons: late.len(),
            late: share(late.iter().filter(|late| **late > 0).count(), late.len()),
            latest: late.iter().copied().max().unwrap_or(0).max(0),
            early: part(&early, 0.5),
            impacts: ratios.len(),
            median: part(&ratios, 0.5),
            overstated: share(
                ratios.iter().filter(|ratio| **ratio > 3.0).count(),
                ratios.len(),
            ),
            wrongly_certain: wrong.map(|(judged, _)| judged.index).collect(),
        }
    }

    fn line(&self, name: &str) -> String {
        let mut line = format!("| {name} | {} | {:.1} %", self.horizons, 100.0 * self.late);
        let _ = write!(
            line,
            " | {} | {:.0} | {}",
            self.latest, self.early, self.impacts
        );
        let _ = write!(
            line,
            " | {:.2} | {:.2} %",
            self.median,
            100.0 * self.overstated
        );
        let _ = write!(line, " | {} |", self.wrongly_certain.len());
        line
    }

    fn holds(&self) {
        assert!(
            self.late <= 0.05 && self.latest <= 5,
            "{}",
            self.line("late")
        );
        assert!(self.early <= 5.0, "{}", self.line("early"));
        assert!(self.overstated <= 0.01, "{}", self.line("overstated"));
        assert!(
            (0.05..1.0).contains(&self.median),
            "{}",
            self.line("median")
        );
        assert_eq!(self.wrongly_certain, [0; 0]);
    }
}

fn judged(count: usize) -> Vec<Judged> {
    (0..count).into_par_iter().map(Judged::new).collect()
}

#[test]
fn what_is_said_to_be_known_is() {
    let sample = judged(48);
    let row = Row::of(sample.iter());
    println!("{}", row.line("all"));
    assert!(row.horizons > 20 && row.impacts > 1500);
    row.holds();
}

/// `bench/trust` prints the table of docs/trust.md with this.
#[test]
#[ignore = "takes minutes"]
fn large_sample() {
    let sample = judged(400);
    for (stratum, name) in STRATA.into_iter().enumerate() {
        let of_it = sample
            .iter()
            .filter(|judged| judged.index % STRATA.len() == stratum);
        println!("{}", Row::of(of_it).line(name));
    }
    let row = Row::of(sample.iter());
    println!("{}", row.line("all"));
    row.holds();
}

/// Of random runs that are certain, the highest y and the largest |θ| with 76 digits are within
/// the errors: by start, body, forcing and restitution, so that they are reached at the start,
/// within flights, at impacts and at the limits.
#[test]
fn extremes_with_many_digits_are_within_the_errors() -> Result<(), Unfinished> {
    let (mut compared, mut sharp) = (0, 0);
    for k in 0..600 {
        // Points of a low-discrepancy sequence in seven dimensions.
        let at = |root: f64| (f64::from(k) * root.sqrt()).fract();
        let parameters = Parameters {
            r: 1.2 + 2.0 * at(2.0),
            e: 0.3 + 0.65 * at(3.0),
            f_o: 0.8 * at(5.0),
            omega: 0.3 + 3.0 * at(7.0),
            y: 0.05 + 0.3 * at(11.0),
            vy: 0.8 * at(13.0) - 0.3,
            vtheta: 0.8 * at(17.0) - 0.4,
            inertia: Some(0.01 + 0.03 * at(19.0)),
            t_end: 3.0,
            ..Parameters::STANDARD
        };
        let Ok(case) = Case::new(parameters) else {
            continue;
        };
        let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
        let slack = run.modes().iter().all(|mode| mode.taut.is_empty());
        let exact = case.simulation_over(|_, number| Digits::from_decimal(number));
        let (true, true, Ok(mut exact)) = (trust.decides_the_end(), slack, exact) else {
            continue;
        };
        while exact.step().is_some() {}
        let errors = NormErrors::of(&run, &trust);
        let norms = run.norms();
        for (ours, exact, error) in [
            (norms.y_max, exact.y_max(), errors.y_max),
            (norms.theta_max, exact.theta_max(), errors.theta_max),
        ] {
            let error = error.unwrap_or(f64::NAN);
            assert!(error.is_finite(), "{parameters:?}");
            // A maximum that is a limit or the start is known to its rounding.
            let off = (exact - Digits::from_f64(ours)).to_f64().abs();
            assert!(
                off <= error + 2.0 * f64::EPSILON,
                "{parameters:?}: {off:e} {error:e}"
            );
            compared += 1;
            sharp += usize::from(error < 1e-12 + 1e4 * off);
        }
    }
    assert!(compared > 200 && sharp * 2 > compared, "{compared} {sharp}");
    Ok(())
}
