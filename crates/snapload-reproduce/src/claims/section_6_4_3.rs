//! Section 6.4.3: the norms over the force amplitude. The claims on the swings of the rotation, and
//! the comparison with the point mass, have files of their own.

mod point_mass;
mod swings;

use super::numbers::{count, falling, max, mean, mean_and_deviation, min, spearman};
use super::runs::{
    LARGE_SWING, MANY, case, chapter, from_starts, near, run, standard, swings, table_codes,
};
use super::verdict::{Claim, Finding, Judged, Judges, Verdict, ask};
use super::words::Value;
use crate::ReportError;
use crate::study::Study;
use snapload::{CaseError, Norms, Parameters, Stop, Trajectory};
use std::f64::consts::FRAC_PI_2;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let of = |r| Sweeps::of(study, r);
    let (short, long) = (of(1.5)?, of(2.5)?);
    let sweeps = Sweeps { study, short, long };
    ask(&[JUDGES, swings::JUDGES, point_mass::JUDGES], &sweeps)
}

const JUDGES: &Judges<fn(&Sweeps) -> Judged> = &[
    ("6.4.3-01", |sweeps| {
        let at_limit = |run: &Run| run.norms.theta_max > FRAC_PI_2 - 1e-9;
        let correlation = |sweep: &[Run]| spearman(&over_force(sweep, |run| run.norms.theta_max));
        let grows = |sweep: &[Run]| {
            let first = sweep.iter().position(at_limit);
            correlation(sweep) >= 0.9 && first == Some(sweep.len() - 1)
        };
        let text = |sweep: &[Run]| {
            let before = max(below_critical(sweep).iter().map(|run| run.norms.theta_max));
            let (f_cr, rho) = (sweep[sweep.len() - 1].f_o, correlation(sweep));
            format!("rank correlation {rho:.2}, largest below f_cr = {f_cr:.2} is {before:.3}")
        };
        Ok(sweeps.judge(grows).both(sweeps, text))
    }),
    ("6.4.3-02", |sweeps| {
        let low = |sweep: &[Run]| sweep.iter().all(|run| run.f_o > WEAK || !rises(run));
        let last = |sweep: &[Run]| {
            let low = sweep.iter().take_while(|run| !rises(run));
            low.last().map_or(0.0, |run| run.f_o)
        };
        Ok(sweeps.judge(low).both(sweeps, last))
    }),
    ("6.4.3-03", |sweeps| {
        Ok(height(&sweeps.short, |rises| rises > 0))
    }),
    ("6.4.3-04", |sweeps| {
        Ok(height(&sweeps.long, |rises| rises == 0))
    }),
    ("6.4.3-05", |sweeps| {
        let spread = |sweep: &[Run]| spread(sweep.iter().map(|run| run.norms.rho1));
        let steady = sweeps.judge(|sweep| spread(sweep) < STEADY);
        Ok(steady.both(sweeps, |sweep| 100.0 * spread(sweep)))
    }),
    ("6.4.3-07", first_is_largest),
    ("6.4.3-10", |sweeps| {
        /// A deviation that one calls constant, in parts of the mean.
        const CONSTANT: f64 = 0.05;
        let erratic = |[low, high]: [(f64, f64); 2]| {
            low.1 < CONSTANT * low.0 && high.1 >= 2.0 * low.1 && high.0 < low.0
        };
        let text = |figure: fn(&Run) -> f64| {
            let words = |(mean, deviation)| format!("{mean:.2} ± {deviation:.2}");
            halves(&sweeps.short[0], figure).map(words).join(", then ")
        };
        let both = |sweep: &Sweep| SUMS.iter().all(|sum| erratic(halves(sweep, sum)));
        Ok(Finding::robust(&sweeps.short, both).values("rho2 rho3", SUMS.map(text)))
    }),
    ("6.4.3-13", |sweeps| {
        let both = |sweep: &Sweep| {
            SUMS.iter()
                .all(|sum| falls_rises_falls(&figure(sweep, sum)))
        };
        Ok(Finding::robust(&sweeps.long, both).list("rho3", figure(&sweeps.long[0], SUMS[1])))
    }),
    ("6.4.3-19", |sweeps| {
        let back = |sweep: &[Run]| {
            let falls = |values: Vec<f64>| values.windows(2).filter(|pair| falling(pair)).count();
            SUMS.map(|sum| falls(figure(sweep, sum)))
        };
        let text = |sweep: &[Run]| {
            let ([rho2, rho3], steps) = (back(sweep), sweep.len() - 1);
            format!("ρ2 falls in {rho2} and ρ3 in {rho3} of {steps} steps of f_o")
        };
        Ok(sweeps
            .judge(|sweep| !back(sweep).contains(&0))
            .both(sweeps, text))
    }),
    ("6.4.3-20", optimum),
    ("6.4.3-15", |sweeps| {
        let over = |run: &Run| run.t <= 10.0 && run.norms.rho2 == run.norms.rho3;
        let (codes, mut soon) = (table_codes(), 0);
        for code in &codes {
            soon += usize::from(case(sweeps.study, code)?.runs.chapter.end().t <= 10.0);
        }
        let usual = sweeps.judge(|sweep| share(sweep, over) > USUAL);
        Ok(usual
            .both(sweeps, |sweep| 100.0 * share(sweep, over))
            .values("soon cases", [soon, codes.len()]))
    }),
    ("6.4.3-16", |sweeps| {
        let differ = |run: &Run| (run.norms.rho3 - run.norms.rho2).abs() / run.norms.rho3;
        let alike = |sweep: &[Run]| share(sweep, |run| differ(run) < 0.05) >= USUAL;
        let most = |sweep: &[Run]| 100.0 * max(sweep.iter().map(differ));
        Ok(sweeps.judge(alike).both(sweeps, most))
    }),
    ("6.4.3-18", |sweeps| {
        let soon = |run: &Run| run.reason == Stop::Settled && run.t < 10.0;
        let text = |sweep: &[Run]| {
            let below = below_critical(sweep);
            format!(
                "{} of {}",
                below.iter().filter(|run| soon(run)).count(),
                below.len()
            )
        };
        let usual = sweeps.judge(|sweep| share(below_critical(sweep), soon) >= USUAL);
        Ok(usual.both(sweeps, text))
    }),
];

/// What is asked of one run.
struct Run {
    f_o: f64,
    norms: Norms,
    reason: Stop,
    t: f64,
    /// Which impact is the largest snap, from 1.
    strongest: usize,
    largest_swing: f64,
    /// Those swings of θ between its turning points that are large.
    large_swings: Vec<f64>,
}

impl Run {
    fn new(case: &Parameters) -> Result<Self, CaseError> {
        let run = run(case)?;
        let mut swings = swings(&run);
        let largest_swing = swings.iter().copied().fold(0.0, f64::max);
        swings.retain(|swing| *swing > LARGE_SWING);
        Ok(Self {
            f_o: case.f_o,
            norms: *run.norms(),
            reason: run.end().reason,
            t: run.end().t,
            strongest: strongest(&run),
            largest_swing,
            large_swings: swings,
        })
    }
}

fn strongest(run: &Trajectory) -> usize {
    let impacts = run.impacts().iter().enumerate();
    let largest = impacts.max_by(|p, q| p.1.v_n.total_cmp(&q.1.v_n));
    largest.map_or(0, |(k, _)| k + 1)
}

/// Runs over f_o = 0.01 .. f_cr.
type Sweep = Vec<Run>;

/// The sweeps from all starts, the case itself first, with the shorter and with the longer cables.
struct Sweeps<'a> {
    study: &'a Study,
    short: Vec<Sweep>,
    long: Vec<Sweep>,
}

impl Sweeps<'_> {
    /// With cables of this length.
    fn of(study: &Study, r: f64) -> Result<Vec<Sweep>, CaseError> {
        let curves = study.norms.iter().filter(|norms| norms.r == r);
        let forces = curves.flat_map(|norms| norms.points.chapter.iter().map(|p| p.0));
        let cases = forces.map(|f_o| chapter(standard(|p| (p.r, p.f_o) = (r, f_o))));
        from_starts(&cases.collect::<Vec<_>>(), MANY, Run::new)
    }

    /// A statement of the runs at either length, from all starts.
    fn judge(&self, holds: impl Fn(&[Run]) -> bool) -> Finding {
        let all = self.short.iter().chain(&self.long);
        Finding::new(Verdict::robust(all.map(|sweep| holds(sweep))))
    }
}

impl Finding {
    /// Gives a value of the case itself for both lengths of the cables: `short` and `long`.
    fn both<V: Into<Value>>(self, sweeps: &Sweeps, value: impl Fn(&[Run]) -> V) -> Self {
        self.values(
            "short long",
            [&sweeps.short, &sweeps.long].map(|starts| value(&starts[0])),
        )
    }
}

/// All but the last, which exceeds.
fn below_critical(sweep: &[Run]) -> &[Run] {
    &sweep[..sweep.len().saturating_sub(1)]
}

/// A figure of each run.
fn figure(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> Vec<f64> {
    sweep.iter().map(figure).collect()
}

/// A figure over the force amplitude.
fn over_force(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> Vec<(f64, f64)> {
    sweep.iter().map(|run| (run.f_o, figure(run))).collect()
}

/// ρ2 and ρ3.
const SUMS: [fn(&Run) -> f64; 2] = [|run| run.norms.rho2, |run| run.norms.rho3];

/// Mean and deviation of a figure at the lower and at the higher amplitudes below f_cr.
fn halves(sweep: &[Run], of: impl Fn(&Run) -> f64) -> [(f64, f64); 2] {
    let values = figure(below_critical(sweep), of);
    let (low, high) = values.split_at(values.len() / 2);
    [mean_and_deviation(low), mean_and_deviation(high)]
}

/// A share that one would call usual: four of five.
const USUAL: f64 = 0.8;

fn share(sweep: &[Run], holds: impl Fn(&Run) -> bool) -> f64 {
    count(sweep, holds) as f64 / sweep.len().max(1) as f64
}

/// Range over mean of ρ1 that one calls constant.
const STEADY: f64 = 0.1;

/// Range over mean.
fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    (max(values.clone()) - min(values.clone())) / mean(values)
}

/// Force amplitudes up to this are weak.
const WEAK: f64 = 0.055;

/// Whether the body rises above its start.
fn rises(run: &Run) -> bool {
    run.norms.y_max > Parameters::STANDARD.y + 1e-9
}

/// Of a statement on how many amplitudes below the critical one lift the body above its start.
fn height(starts: &[Sweep], holds: impl Fn(usize) -> bool) -> Finding {
    let rising = |sweep: &Sweep| count(below_critical(sweep), rises);
    let first = starts[0].iter().find(|run| rises(run));
    let first = first.map(|run| format!(", above the start from f_o = {:.2} on", run.f_o));
    let heights = below_critical(&starts[0]).iter().map(|run| run.norms.y_max);
    Finding::robust(starts, |sweep| holds(rising(sweep)))
        .value("highest", max(heights))
        .value("first", first.unwrap_or_default())
}

fn first_is_largest(sweeps: &Sweeps) -> Judged {
    let mut figures: Vec<Vec<usize>> = Vec::new();
    // Figs 6.22-6.26.
    for code in ["355", "3575", "359", "3515", "3520"] {
        let case = case(sweeps.study, &format!("1910001000-{code}"))?;
        let impact = |case: &Parameters| Ok(strongest(&run(case)?));
        figures.push(near(&chapter(case.parameters), MANY, impact)?);
    }
    // About the first: among the first three.
    let early = |k: &usize| *k <= 3;
    let drawn = count(&figures, |figure| figure.iter().all(early));
    let shares = sweeps.short.iter();
    let shares = shares.map(|sweep| share(sweep, |run| early(&run.strongest)));
    let usual = |share: f64| share >= 100.0 * USUAL && drawn >= 4;
    let finding = Finding::measured("early", shares.map(|share| 100.0 * share), usual);
    Ok(finding
        .list("impacts", figures.iter().map(|figure| figure[0] as f64))
        .value(
            "second",
            100.0 * share(&sweeps.short[0], |run| run.strongest == 2),
        ))
}

/// The place of the greatest value (1) or of the least (-1) among `from..to`.
fn place(values: &[f64], from: usize, to: usize, sign: f64) -> Option<usize> {
    (from..to).max_by(|p, q| (sign * values[*p]).total_cmp(&(sign * values[*q])))
}

/// Whether values fall, rise and fall again, by a twentieth each time.
fn falls_rises_falls(values: &[f64]) -> bool {
    let last = values.len().saturating_sub(1);
    let check = || {
        let i = place(values, 1, last, -1.0)?;
        let j = place(values, i + 1, last, 1.0)?;
        let (start, low, high) = (values[0].max(values[1]), values[i], values[j]);
        Some(start > 1.05 * low && high > 1.05 * low && values[last] < 0.95 * high)
    };
    check().unwrap_or(false)
}

fn optimum(sweeps: &Sweeps) -> Judged {
    // Where the snaps take the least to bring the body to rest, among the runs that settle: the
    // place, the force and ρ3.
    let best = sweeps.long.iter().map(|sweep| {
        let settled = sweep.iter().filter(|run| run.reason == Stop::Settled);
        let settled: Vec<&Run> = settled.collect();
        let rho3: Vec<f64> = settled.iter().map(|run| run.norms.rho3).collect();
        let k = place(&rho3, 0, rho3.len(), -1.0)?;
        Some((k > 0 && k + 1 < rho3.len(), settled[k].f_o, rho3[k]))
    });
    let best: Vec<Option<(bool, f64, f64)>> = best.collect();
    let forces = || best.iter().flatten().map(|best| best.1);
    let same = max(forces()) - min(forces()) < 0.015;
    let finding = Finding::robust(&best, |best| same && best.is_some_and(|best| best.0));
    Ok(finding
        .list("least", best.iter().flatten().map(|best| best.2))
        .list("forces", forces()))
}
