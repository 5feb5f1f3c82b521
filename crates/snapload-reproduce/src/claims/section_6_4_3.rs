//! Section 6.4.3: the norms over the force amplitude. The claims on the swings of the rotation, and
//! the comparison with the point mass, are in files of their own.

mod energy;
mod point_mass;
mod swings;

use super::motions::swings;
use super::numbers::{count, falling, max, mean, mean_and_deviation, min, span, spearman};
use super::runs::{MANY, case, chapter, near, of_exact_runs, run, standard, table_codes};
use super::verdict::{Checked, Checks, Claim, Finding, Verdict, run_checks};
use crate::ReportError;
use crate::study::Study;
use snapload::{CaseError, Impact, Norms, Parameters, Stop};
use snapload_verify::RoundedRun;
use std::f64::consts::FRAC_PI_2;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let of = |r| Sweeps::of(study, r);
    let (short, long) = (of(1.5)?, of(2.5)?);
    let sweeps = Sweeps {
        study,
        short,
        long,
        points: point_mass::critical_forces()?,
    };
    run_checks(
        &[CHECKS, energy::CHECKS, swings::CHECKS, point_mass::CHECKS],
        &sweeps,
    )
}

const CHECKS: &Checks<fn(&Sweeps) -> Checked> = &[
    ("6.4.3-01", |sweeps| {
        let at_limit = |run: &Swept| run.norms.theta_max > FRAC_PI_2 - 1e-9;
        let correlation = |sweep: &[Swept]| spearman(&over_force(sweep, |run| run.norms.theta_max));
        let grows = |sweep: &[Swept]| {
            let first = sweep.iter().position(at_limit);
            correlation(sweep) >= GROWTH && first == Some(sweep.len() - 1)
        };
        let text = |starts: &[Sweep]| {
            let below =
                |sweep: &Sweep| max(below_critical(sweep).iter().map(|run| run.norms.theta_max));
            let before = span(starts.iter().map(below), 3);
            let rho = span(starts.iter().map(|sweep| correlation(sweep)), 2);
            let f_cr = starts[0][starts[0].len() - 1].f_o;
            format!("rank correlation {rho}, largest below f_cr = {f_cr:.2} is {before}")
        };
        let finding = sweeps.robust(grows).value("growth", GROWTH);
        Ok(finding.values(
            "short long",
            [&sweeps.short, &sweeps.long].map(|of| text(of)),
        ))
    }),
    ("6.4.3-02", |sweeps| {
        let low = |sweep: &[Swept]| sweep.iter().all(|run| run.f_o > WEAK || !rises(run));
        let last = |sweep: &[Swept]| {
            let low = sweep.iter().take_while(|run| !rises(run));
            low.last().map_or(0.0, |run| run.f_o)
        };
        Ok(sweeps
            .robust(low)
            .both_by_start(sweeps, last)
            .value("weak", WEAK))
    }),
    ("6.4.3-03", |sweeps| {
        Ok(height(&sweeps.short, |rises| rises > 0))
    }),
    ("6.4.3-04", |sweeps| {
        Ok(height(&sweeps.long, |rises| rises == 0))
    }),
    ("6.4.3-05", |sweeps| {
        let spread = |sweep: &[Swept]| spread(sweep.iter().map(|run| run.norms.rho1));
        let steady = sweeps.robust(|sweep| spread(sweep) < STEADY);
        let steady = steady.both_by_start(sweeps, |sweep| 100.0 * spread(sweep));
        Ok(steady.value("steady", 100.0 * STEADY))
    }),
    ("6.4.3-07", first_is_largest),
    ("6.4.3-10", |sweeps| {
        let erratic = |[low, high]: [(f64, f64); 2]| {
            is_constant(low) && high.1 >= 2.0 * low.1 && high.0 < low.0
        };
        let text = |figure: fn(&Swept) -> f64| {
            let of = |half: usize| {
                let (mean, deviation): (Vec<f64>, Vec<f64>) = sweeps
                    .short
                    .iter()
                    .map(|sweep| halves(sweep, figure)[half])
                    .unzip();
                format!("{} ± {}", span(mean, 2), span(deviation, 2))
            };
            format!("{}, then {}", of(0), of(1))
        };
        let both = |sweep: &Sweep| SUMS.iter().all(|sum| erratic(halves(sweep, sum)));
        Ok(Finding::robust(&sweeps.short, both)
            .values("rho2 rho3", SUMS.map(text))
            .value("constant", 100.0 * CONSTANT))
    }),
    ("6.4.3-13", |sweeps| {
        let both = |sweep: &Sweep| {
            SUMS.iter()
                .all(|sum| falls_rises_falls(&figure(sweep, sum)))
        };
        let rho3 = |sweep: &Sweep| figure(sweep, SUMS[1]);
        let first = |sweep: &Sweep| 100.0 * (rho3(sweep)[1] / rho3(sweep)[0] - 1.0);
        let starts = &sweeps.long;
        Ok(Finding::robust(starts, both)
            .by_start("rho3", starts.iter().map(rho3))
            .by_start("first", starts.iter().map(|sweep| [first(sweep)]))
            .value("change", 100.0 * CHANGE)
            .condition(
                "rises_first",
                starts.iter().all(|sweep| first(sweep) > 100.0 * CHANGE),
            ))
    }),
    ("6.4.3-19", |sweeps| {
        let back = |sweep: &[Swept]| {
            let falls = |values: Vec<f64>| values.windows(2).filter(|pair| falling(pair)).count();
            SUMS.map(|sum| falls(figure(sweep, sum)))
        };
        let text = |starts: &[Sweep]| {
            let of = |k: usize| span(starts.iter().map(|sweep| back(sweep)[k] as f64), 0);
            let steps = starts[0].len() - 1;
            format!(
                "ρ2 falls in {} and ρ3 in {} of {steps} steps of f_o",
                of(0),
                of(1)
            )
        };
        let finding = sweeps.robust(|sweep| !back(sweep).contains(&0));
        Ok(finding.values(
            "short long",
            [&sweeps.short, &sweeps.long].map(|of| text(of)),
        ))
    }),
    ("6.4.3-15", |sweeps| {
        let over = |run: &Swept| run.t <= 10.0 && run.norms.rho2 == run.norms.rho3;
        let (codes, mut soon) = (table_codes(), 0);
        for code in &codes {
            soon += usize::from(case(sweeps.study, code)?.exact.end().t <= 10.0);
        }
        let usual = sweeps.robust(|sweep| share(sweep, over) > USUAL);
        Ok(usual
            .both_by_start(sweeps, |sweep| 100.0 * share(sweep, over))
            .values("soon cases", [soon, codes.len()])
            .value("usual", 100.0 * USUAL))
    }),
    ("6.4.3-16", |sweeps| {
        let differ = |run: &Swept| (run.norms.rho3 - run.norms.rho2).abs() / run.norms.rho3;
        /// A difference that is not visible in a plot, as a part of ρ3.
        const ALIKE: f64 = 0.05;
        let alike = |sweep: &[Swept]| share(sweep, |run| differ(run) < ALIKE) >= USUAL;
        let most = |sweep: &[Swept]| 100.0 * max(sweep.iter().map(differ));
        let finding = sweeps.robust(alike).both_by_start(sweeps, most);
        Ok(finding.values("alike usual", [100.0 * ALIKE, 100.0 * USUAL]))
    }),
];

/// The least rank correlation that counts as growth.
const GROWTH: f64 = 0.9;

/// The quantities of one run.
#[derive(Clone)]
struct Swept {
    f_o: f64,
    norms: Norms,
    reason: Stop,
    t: f64,
    /// The number of the impact that is the largest snap, from 1.
    strongest: usize,
    largest_swing: f64,
    /// Turning points of the rotation per unit of time.
    turns: f64,
    /// The sizes of the large swings of θ.
    large_swings: Vec<f64>,
    /// Energy lost in its impacts.
    lost: f64,
}

impl Swept {
    fn new(run: &RoundedRun) -> Self {
        let swings = swings(run);
        let large = swings.iter().filter(|swing| swing.is_large());
        Self {
            // The force at the start.
            f_o: run.system().forcing.at(0.0).x,
            norms: *run.norms(),
            reason: run.end().reason,
            t: run.end().t,
            strongest: strongest(run.impacts()),
            largest_swing: swings.iter().map(|swing| swing.size()).fold(0.0, f64::max),
            turns: (swings.len() + 1) as f64 / run.end().t,
            large_swings: large.map(|swing| swing.size()).collect(),
            lost: run.impacts().iter().map(|hit| hit.energy_lost).sum(),
        }
    }
}

fn strongest(impacts: &[Impact]) -> usize {
    let impacts = impacts.iter().enumerate();
    let largest = impacts.max_by(|p, q| p.1.v_n.total_cmp(&q.1.v_n));
    largest.map_or(0, |(k, _)| k + 1)
}

/// Runs over f_o = 0.01 .. f_cr.
type Sweep = Vec<Swept>;

/// The sweeps from all starts, the case itself in many digits first, with the shorter and with the
/// longer cables.
struct Sweeps<'a> {
    study: &'a Study,
    short: Vec<Sweep>,
    long: Vec<Sweep>,
    /// The critical force of the point mass, with the shorter and with the longer cables, from each
    /// start.
    points: [Vec<f64>; 2],
}

impl Sweeps<'_> {
    /// The sweeps with cables of this length.
    fn of(study: &Study, r: f64) -> Result<Vec<Sweep>, CaseError> {
        let curves = study.norms.iter().filter(|norms| norms.r == r);
        let forces = curves.flat_map(|norms| norms.points.chapter.iter().map(|p| p.0));
        let cases = forces.map(|f_o| chapter(standard(|p| (p.r, p.f_o) = (r, f_o))));
        of_exact_runs(&cases.collect::<Vec<_>>(), MANY, Swept::new)
    }

    /// The finding on a statement about the runs at either length, from all starts.
    fn robust(&self, holds: impl Fn(&[Swept]) -> bool) -> Finding {
        let all = self.short.iter().chain(&self.long);
        Finding::new(Verdict::robust(all.map(|sweep| holds(sweep))))
    }
}

impl Finding {
    /// Gives a number for both lengths of the cables, by start: `short` and `long`.
    fn both_by_start(self, sweeps: &Sweeps, number: impl Fn(&[Swept]) -> f64) -> Self {
        let of = |starts: &[Sweep]| -> Vec<[f64; 1]> {
            starts.iter().map(|sweep| [number(sweep)]).collect()
        };
        let [short, long] = [&sweeps.short, &sweeps.long].map(|starts| of(starts));
        self.by_start("short", short).by_start("long", long)
    }
}

/// All runs but the last, which exceeds.
fn below_critical(sweep: &[Swept]) -> &[Swept] {
    &sweep[..sweep.len().saturating_sub(1)]
}

/// A quantity of each run.
fn figure(sweep: &[Swept], figure: impl Fn(&Swept) -> f64) -> Vec<f64> {
    sweep.iter().map(figure).collect()
}

/// A quantity over the force amplitude.
fn over_force(sweep: &[Swept], figure: impl Fn(&Swept) -> f64) -> Vec<(f64, f64)> {
    sweep.iter().map(|run| (run.f_o, figure(run))).collect()
}

/// ρ2 and ρ3.
const SUMS: [fn(&Swept) -> f64; 2] = [|run| run.norms.rho2, |run| run.norms.rho3];

/// The largest deviation that counts as constant, as a part of the mean.
const CONSTANT: f64 = 0.05;

/// Whether values with this mean and deviation count as constant.
fn is_constant((mean, deviation): (f64, f64)) -> bool {
    deviation <= CONSTANT * mean
}

/// Mean and deviation of a quantity at the lower and at the higher amplitudes below f_cr.
fn halves(sweep: &[Swept], of: impl Fn(&Swept) -> f64) -> [(f64, f64); 2] {
    let values = figure(below_critical(sweep), of);
    let (low, high) = values.split_at(values.len() / 2);
    [mean_and_deviation(low), mean_and_deviation(high)]
}

/// The least share that counts as usual: four of five.
const USUAL: f64 = 0.8;

fn share(sweep: &[Swept], holds: impl Fn(&Swept) -> bool) -> f64 {
    count(sweep, holds) as f64 / sweep.len().max(1) as f64
}

/// The largest ratio of range to mean of ρ1 that counts as constant.
const STEADY: f64 = 0.1;

/// The ratio of range to mean.
fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    (max(values.clone()) - min(values.clone())) / mean(values)
}

/// The largest force amplitude that counts as weak.
const WEAK: f64 = 0.055;

/// Whether the body rises above its start.
fn rises(run: &Swept) -> bool {
    run.norms.y_max > Parameters::STANDARD.y + 1e-9
}

/// The finding on a statement about the number of amplitudes below the critical one that lift the
/// body above its start.
fn height(starts: &[Sweep], holds: impl Fn(usize) -> bool) -> Finding {
    let rising = |sweep: &Sweep| count(below_critical(sweep), rises);
    let first = starts[0].iter().find(|run| rises(run));
    let first = first.map(|run| format!(", above the start from f_o = {:.2} on", run.f_o));
    let highest = |sweep: &Sweep| max(below_critical(sweep).iter().map(|run| run.norms.y_max));
    Finding::robust(starts, |sweep| holds(rising(sweep)))
        .by_start("highest", starts.iter().map(|sweep| [highest(sweep)]))
        .value("first", first.unwrap_or_default())
}

/// The number of impacts that count as the first ones, and the least number of the five figures in
/// which the largest snap is one of them.
const FIRST: usize = 3;
const FIGURES: usize = 4;

fn first_is_largest(sweeps: &Sweeps) -> Checked {
    let mut figures: Vec<Vec<usize>> = Vec::new();
    // Figs 6.22-6.26.
    for code in ["355", "3575", "359", "3515", "3520"] {
        let case = case(sweeps.study, &format!("1910001000-{code}"))?;
        let impact = |case: &Parameters| Ok(strongest(run(case)?.impacts()));
        figures.push(near(&chapter(case.parameters), MANY, impact)?);
    }
    let early = |k: &usize| *k <= FIRST;
    let drawn = count(&figures, |figure| figure.iter().all(early));
    let shares = sweeps.short.iter();
    let shares = shares.map(|sweep| share(sweep, |run| early(&run.strongest)));
    let usual = |share: f64| share >= 100.0 * USUAL && drawn >= FIGURES;
    let finding = Finding::measured("early", shares.map(|share| 100.0 * share), usual);
    Ok(finding
        .list("impacts", figures.iter().map(|figure| figure[0] as f64))
        .values("first figures", [FIRST, FIGURES])
        .value("usual", 100.0 * USUAL)
        .value(
            "second",
            100.0 * share(&sweeps.short[0], |run| run.strongest == 2),
        ))
}

/// The index of the greatest value (1) or of the least (-1) among `from..to`.
fn place(values: &[f64], from: usize, to: usize, sign: f64) -> Option<usize> {
    (from..to).max_by(|p, q| (sign * values[*p]).total_cmp(&(sign * values[*q])))
}

/// The least change that is visible in a plot, as a part of the smaller value.
const CHANGE: f64 = 0.05;

/// Whether values fall at first, rise and fall again, each time by a visible amount.
fn falls_rises_falls(values: &[f64]) -> bool {
    let last = values.len().saturating_sub(1);
    let check = || {
        let low = place(values, 1, last, -1.0)?;
        let high = place(values, low + 1, last, 1.0)?;
        let more = |p: usize, q: usize| values[p] > (1.0 + CHANGE) * values[q];
        // While falling, no value is above the first.
        let falls = values[..low]
            .iter()
            .all(|v| *v <= (1.0 + CHANGE) * values[0]);
        Some(falls && more(0, low) && more(high, low) && more(high, last))
    };
    check().unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_that_rises_first_does_not_fall_rise_and_fall() {
        assert!(falls_rises_falls(&[8.0, 7.0, 5.0, 6.0, 7.0, 5.0]));
        // A first step up by 39 %.
        assert!(!falls_rises_falls(&[5.5, 7.7, 5.0, 6.0, 7.0, 5.0]));
        assert!(!falls_rises_falls(&[8.0, 7.0, 6.0, 5.0]));
        assert!(!falls_rises_falls(&[8.0, 7.0, 5.0, 6.0, 7.0, 7.1]));
    }
}
