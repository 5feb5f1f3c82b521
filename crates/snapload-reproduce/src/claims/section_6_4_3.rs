//! Section 6.4.3: the norms over the force amplitude, and the comparison with the point mass.

mod heights;
mod point_mass;
mod swings;

use super::numbers::{falling, list, mean, mean_and_deviation, range, span};
use super::runs::{LARGE_SWING, MANY, chapter, ensemble, near, of_all, swings, table_codes};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{CaseError, Norms, Parameters, Stop, Trajectory};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let sweeps = Sweeps::new(study)?;
    let mut all = heights::claims(&sweeps);
    all.extend(of_norms(study, &sweeps)?);
    all.extend(swings::claims(&sweeps));
    all.extend(point_mass::claims(&sweeps)?);
    Ok(all)
}

/// What is asked of one run.
struct Run {
    f_o: f64,
    norms: Norms,
    reason: Stop,
    t: f64,
    /// Which impact is the largest snap, from 1.
    strongest: usize,
    /// The swings of θ between its turning points.
    swings: Vec<f64>,
}

impl Run {
    fn new(f_o: f64, run: &Trajectory) -> Self {
        Self {
            f_o,
            norms: *run.norms(),
            reason: run.end().reason,
            t: run.end().t,
            strongest: strongest(run),
            swings: swings(run),
        }
    }

    fn largest_swing(&self) -> f64 {
        self.swings.iter().copied().fold(0.0, f64::max)
    }

    fn large_swings(&self) -> impl Iterator<Item = f64> {
        self.swings
            .iter()
            .copied()
            .filter(|swing| *swing > LARGE_SWING)
    }
}

fn strongest(run: &Trajectory) -> usize {
    let impacts = run.impacts().iter().enumerate();
    let largest = impacts.max_by(|p, q| p.1.v_n.total_cmp(&q.1.v_n));
    largest.map_or(0, |(k, _)| k + 1)
}

/// Runs over f_o = 0.01 .. f_cr.
type Sweep = Vec<Run>;

/// The sweeps from all starts, the case itself first.
struct Sweeps {
    short: Vec<Sweep>,
    long: Vec<Sweep>,
}

impl Sweeps {
    fn new(study: &Study) -> Result<Self, CaseError> {
        let of = |r: f64| -> Result<Vec<Sweep>, CaseError> {
            let norms = study.norms.iter().filter(|norms| norms.r == r);
            let forces: Vec<f64> = norms
                .flat_map(|norms| norms.points.chapter.iter().map(|p| p.0))
                .collect();
            let case = chapter(Parameters {
                r,
                ..Parameters::STANDARD
            });
            ensemble(&case, MANY)
                .iter()
                .map(|member| sweep(member, &forces))
                .collect()
        };
        Ok(Self {
            short: of(1.5)?,
            long: of(2.5)?,
        })
    }

    /// A statement of the runs at either length, from all starts.
    fn judge(&self, holds: impl Fn(&[Run]) -> bool) -> Verdict {
        Verdict::robust(self.short.iter().chain(&self.long).map(|s| holds(s)))
    }

    /// A figure of the case itself at either length.
    fn show(&self, text: impl Fn(&[Run]) -> String) -> String {
        let [short, long] = [&self.short, &self.long].map(|members| text(own(members)));
        format!("r = 1.5: {short}; r = 2.5: {long}")
    }
}

fn sweep(case: &Parameters, forces: &[f64]) -> Result<Sweep, CaseError> {
    let cases: Vec<Parameters> = forces
        .iter()
        .map(|f_o| Parameters { f_o: *f_o, ..*case })
        .collect();
    of_all(&cases, |case| case.run()).map(|runs| {
        let pairs = forces.iter().zip(&runs);
        pairs.map(|(f_o, run)| Run::new(*f_o, run)).collect()
    })
}

/// The case itself.
fn own(members: &[Sweep]) -> &[Run] {
    members.first().map_or(&[], Vec::as_slice)
}

/// All but the last, which exceeds.
fn below_critical(sweep: &[Run]) -> &[Run] {
    sweep.split_last().map_or(&[], |(_, rest)| rest)
}

/// A figure over the force amplitude.
fn over_force(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> Vec<(f64, f64)> {
    sweep.iter().map(|run| (run.f_o, figure(run))).collect()
}

/// ρ2 and ρ3.
const SUMS: [fn(&Run) -> f64; 2] = [|run| run.norms.rho2, |run| run.norms.rho3];

/// Mean and deviation of a figure at the lower and at the higher amplitudes below f_cr.
fn halves(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> [(f64, f64); 2] {
    let values: Vec<f64> = below_critical(sweep).iter().map(figure).collect();
    let (low, high) = values.split_at(values.len() / 2);
    [mean_and_deviation(low), mean_and_deviation(high)]
}

fn share(sweep: &[Run], holds: impl Fn(&Run) -> bool) -> f64 {
    sweep.iter().filter(|run| holds(run)).count() as f64 / sweep.len().max(1) as f64
}

fn of_norms(study: &Study, sweeps: &Sweeps) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        claim(
            "6.4.3-05",
            "ρ1 hardly changes as f_o grows (Figs 6.33, 6.37).",
            steady_largest(sweeps),
        ),
        claim(
            "6.4.3-07",
            "The largest snap is about the first impact (Figs 6.22-6.26).",
            first_is_largest(study, sweeps)?,
        ),
        claim(
            "6.4.3-10",
            "For r = 1.5, ρ2 and ρ3 are constant under weak forces, lower and erratic under \
             strong ones.",
            erratic(sweeps),
        ),
        claim(
            "6.4.3-13",
            "For r = 2.5, ρ2 and ρ3 fall, rise and fall again as f_o grows.",
            fall_rise_fall(sweeps),
        ),
        claim(
            "6.4.3-19",
            "The norms do not grow steadily with the force.",
            not_steady(sweeps),
        ),
        claim(
            "6.4.3-20",
            "For r = 2.5 the energy is dissipated best at an amplitude in between.",
            optimum(sweeps),
        ),
        claim(
            "6.4.3-15",
            "ρ2 equals ρ3 as most runs are over by t = 10.",
            over_by_ten(study, sweeps),
        ),
        claim(
            "6.4.3-16",
            "The plots of ρ2 and ρ3 look alike.",
            alike(sweeps),
        ),
        claim(
            "6.4.3-18",
            "Wave energy is dissipated within a short time, t ≤ 10.",
            soon_settled(sweeps),
        ),
    ])
}

/// Range over mean of ρ1 that one calls constant.
const STEADY: f64 = 0.1;

/// Range over mean.
fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let (low, high) = range(values.clone());
    (high - low) / mean(values)
}

fn steady_largest(sweeps: &Sweeps) -> Finding {
    let spread = |sweep: &[Run]| spread(sweep.iter().map(|run| run.norms.rho1));
    let text = |sweep: &[Run]| format!("ρ1 varies by {:.1} %", 100.0 * spread(sweep));
    Finding::new(
        sweeps.judge(|sweep| spread(sweep) < STEADY),
        sweeps.show(text),
    )
}

fn first_is_largest(study: &Study, sweeps: &Sweeps) -> Result<Finding, CaseError> {
    /// Figs 6.22-6.26.
    const FIGURES: [&str; 5] = ["355", "3575", "359", "3515", "3520"];
    let mut figures: Vec<Vec<usize>> = Vec::new();
    for code in FIGURES {
        if let Some(case) = study.case(&format!("1910001000-{code}")) {
            let runs = near(&chapter(case.parameters), MANY)?;
            figures.push(runs.iter().map(strongest).collect());
        }
    }
    // About the first: among the first three.
    let early = |k: &usize| *k <= 3;
    let of_figures = figures
        .iter()
        .map(|figure| Verdict::robust(figure.iter().map(early)));
    let drawn = of_figures.filter(|v| *v == Verdict::Reproduced).count();
    let shares = sweeps
        .short
        .iter()
        .map(|sweep| share(sweep, |run| early(&run.strongest)));
    // Usually: in four of five.
    let holds = |share: f64| share >= 0.8 && drawn >= 4;
    let strongest: Vec<String> = figures
        .iter()
        .flat_map(|f| f.first())
        .map(usize::to_string)
        .collect();
    let seconds = 100.0 * share(own(&sweeps.short), |run| run.strongest == 2);
    let evidence = format!(
        "the largest is impact number {} in the figures; among the first three in {} % of the \
         runs over f_o, the second in {seconds:.0} %",
        strongest.join(", "),
        span(shares.clone().map(|share| 100.0 * share), 0)
    );
    Ok(Finding::new(Verdict::robust(shares.map(holds)), evidence))
}

fn erratic(sweeps: &Sweeps) -> Finding {
    /// A deviation that one calls constant, in parts of the mean.
    const CONSTANT: f64 = 0.05;
    let holds = |sweep: &Sweep| {
        SUMS.iter().all(|figure| {
            let [low, high] = halves(sweep, figure);
            low.1 < CONSTANT * low.0 && high.1 >= 2.0 * low.1 && high.0 < low.0
        })
    };
    let words = SUMS.map(|figure| {
        let [low, high] = halves(own(&sweeps.short), figure);
        format!(
            "{:.2} ± {:.2}, then {:.2} ± {:.2}",
            low.0, low.1, high.0, high.1
        )
    });
    Finding::new(
        Verdict::robust(sweeps.short.iter().map(holds)),
        format!(
            "lower and upper half of the amplitudes: ρ2 {}; ρ3 {}",
            words[0], words[1]
        ),
    )
}

/// The place of the best value by some order among `from..to`.
fn place(values: &[f64], from: usize, to: usize, sign: f64) -> Option<usize> {
    let part = values.iter().enumerate().take(to).skip(from);
    part.max_by(|p, q| (sign * p.1).total_cmp(&(sign * q.1)))
        .map(|(k, _)| k)
}

/// Whether values fall, rise and fall again, by a twentieth each time.
fn falls_rises_falls(values: &[f64]) -> bool {
    let last = values.len().saturating_sub(1);
    let check = || {
        let i = place(values, 1, last, -1.0)?;
        let j = place(values, i + 1, last, 1.0)?;
        let (low, high) = (*values.get(i)?, *values.get(j)?);
        let (_, start) = range(values.iter().take(2).copied());
        Some(start > 1.05 * low && high > 1.05 * low && *values.last()? < 0.95 * high)
    };
    check().unwrap_or(false)
}

fn fall_rise_fall(sweeps: &Sweeps) -> Finding {
    let of =
        |sweep: &Sweep, figure: fn(&Run) -> f64| -> Vec<f64> { sweep.iter().map(figure).collect() };
    let holds = |sweep: &Sweep| {
        SUMS.iter()
            .all(|figure| falls_rises_falls(&of(sweep, *figure)))
    };
    Finding::new(
        Verdict::robust(sweeps.long.iter().map(holds)),
        format!("ρ3 {}", listed(&sweeps.long, |run| run.norms.rho3, 2)),
    )
}

fn not_steady(sweeps: &Sweeps) -> Finding {
    let back = |sweep: &[Run]| {
        SUMS.map(|figure| {
            let values: Vec<f64> = sweep.iter().map(figure).collect();
            values.windows(2).filter(|pair| falling(pair)).count()
        })
    };
    let text = |sweep: &[Run]| {
        let [rho2, rho3] = back(sweep);
        let steps = sweep.len().saturating_sub(1);
        format!("ρ2 falls in {rho2} and ρ3 in {rho3} of {steps} steps of f_o")
    };
    Finding::new(
        sweeps.judge(|sweep| back(sweep).iter().all(|count| *count > 0)),
        sweeps.show(text),
    )
}

fn optimum(sweeps: &Sweeps) -> Finding {
    // Where the snaps take the least to bring the body to rest, among the runs that settle.
    let best = |sweep: &Sweep| {
        let settled = sweep.iter().filter(|run| run.reason == Stop::Settled);
        let settled: Vec<(f64, f64)> = settled.map(|run| (run.f_o, run.norms.rho3)).collect();
        let values: Vec<f64> = settled.iter().map(|p| p.1).collect();
        let k = place(&values, 0, values.len(), -1.0)?;
        let inside = k > 0 && k + 1 < values.len();
        settled.get(k).map(|p| (p.0, p.1, inside))
    };
    let found: Vec<Option<(f64, f64, bool)>> = sweeps.long.iter().map(best).collect();
    let places = || found.iter().flatten().map(|best| best.0);
    let (low, high) = range(places());
    let same = high - low < 0.015;
    let inside = |best: &Option<(f64, f64, bool)>| same && best.is_some_and(|best| best.2);
    let least = found.iter().flatten().map(|best| best.1);
    Finding::new(
        Verdict::robust(found.iter().map(inside)),
        format!(
            "r = 2.5: least ρ3 of a run that settles {} at f_o = {}",
            span(least, 2),
            span(places(), 2)
        ),
    )
}

/// The values of a figure over f_o, from the case itself.
fn listed(members: &[Sweep], figure: impl Fn(&Run) -> f64, digits: usize) -> String {
    let values: Vec<f64> = own(members).iter().map(figure).collect();
    list(&values, digits)
}

fn over_by_ten(study: &Study, sweeps: &Sweeps) -> Finding {
    let over = |run: &Run| run.t <= 10.0 && run.norms.rho2 == run.norms.rho3;
    let verdict = sweeps.judge(|sweep| share(sweep, over) > 0.8);
    let codes = table_codes();
    let tabled = codes.iter().filter_map(|code| study.case(code));
    let soon = tabled.filter(|c| c.runs.chapter.end().t <= 10.0).count();
    let text = |sweep: &[Run]| format!("{:.0} %", 100.0 * share(sweep, over));
    Finding::new(
        verdict,
        format!(
            "{} of the runs over f_o; of the cases of Table 6.1 {soon} of {}",
            sweeps.show(text),
            codes.len()
        ),
    )
}

fn alike(sweeps: &Sweeps) -> Finding {
    let differ = |run: &Run| (run.norms.rho3 - run.norms.rho2).abs() / run.norms.rho3;
    let text = |sweep: &[Run]| {
        let (_, most) = range(sweep.iter().map(differ));
        format!("they differ by {:.1} % at most", 100.0 * most)
    };
    let verdict = sweeps.judge(|sweep| share(sweep, |run| differ(run) < 0.05) >= 0.8);
    Finding::new(verdict, sweeps.show(text))
}

fn soon_settled(sweeps: &Sweeps) -> Finding {
    let soon = |run: &Run| run.reason == Stop::Settled && run.t < 10.0;
    let verdict = sweeps.judge(|sweep| share(below_critical(sweep), soon) >= 0.8);
    let text = |sweep: &[Run]| {
        let below = below_critical(sweep);
        format!(
            "{} of {}",
            below.iter().filter(|run| soon(run)).count(),
            below.len()
        )
    };
    Finding::new(verdict, format!("settled by t = 10, {}", sweeps.show(text)))
}
