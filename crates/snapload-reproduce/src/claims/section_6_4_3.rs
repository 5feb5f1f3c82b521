//! Section 6.4.3: the norms over the force amplitude, and the comparison with the point mass.

mod point_mass;
mod swings;

use super::tools::{
    Finding, ensemble, judged, mean_and_deviation, range, robust, run_all, spearman,
};
use super::{Claim, Verdict};
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::{Case, CaseError, Norms, Parameters, Stop, Trajectory};

/// Neighbours of every run.
const NEIGHBOURS: usize = 8;
/// A swing that is large \[rad\].
const LARGE: f64 = 0.5;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let sweeps = Sweeps::new(study)?;
    let mut all = of_extremes(&sweeps);
    all.extend(of_norms(study, &sweeps)?);
    all.extend(swings::claims(&sweeps));
    all.extend(point_mass::claims(study)?);
    all.sort_by_key(|claim| claim.id);
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
        let turns: Vec<f64> = run
            .impacts()
            .iter()
            .filter(|i| i.before.vtheta * i.after.vtheta < 0.0 || i.before.vtheta == 0.0)
            .map(|i| i.before.theta)
            .collect();
        let pairs = turns.iter().zip(turns.iter().skip(1));
        Self {
            f_o,
            norms: *run.norms(),
            reason: run.end().reason,
            t: run.end().t,
            strongest: strongest(run),
            swings: pairs.map(|(a, b)| (b - a).abs()).collect(),
        }
    }

    fn largest_swing(&self) -> f64 {
        self.swings.iter().copied().fold(0.0, f64::max)
    }

    fn large_swings(&self) -> impl Iterator<Item = f64> {
        self.swings.iter().copied().filter(|swing| *swing > LARGE)
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
            let case = Reading::Chapter.apply(Parameters {
                r,
                ..Parameters::STANDARD
            });
            ensemble(&case, NEIGHBOURS)
                .iter()
                .map(|member| sweep(member, &forces))
                .collect()
        };
        Ok(Self {
            short: of(1.5)?,
            long: of(2.5)?,
        })
    }

    fn both(&self) -> [&[Sweep]; 2] {
        [&self.short, &self.long]
    }

    /// A statement of the runs at either length, from all starts.
    fn judge(&self, holds: impl Fn(&[Run]) -> bool) -> Verdict {
        robust(
            self.short
                .iter()
                .chain(&self.long)
                .map(|sweep| holds(sweep)),
        )
    }

    /// A figure of the case itself at either length.
    fn show(&self, text: impl Fn(&[Run]) -> String) -> String {
        let one = |sweeps: &[Sweep]| sweeps.first().map(|sweep| text(sweep)).unwrap_or_default();
        let [short, long] = self.both().map(one);
        format!("r = 1.5: {short}; r = 2.5: {long}")
    }
}

fn sweep(case: &Parameters, forces: &[f64]) -> Result<Sweep, CaseError> {
    forces
        .par_iter()
        .map(|f_o| {
            Ok(Run::new(
                *f_o,
                &Case::new(Parameters { f_o: *f_o, ..*case })?.run(),
            ))
        })
        .collect()
}

/// All but the last, which exceeds.
fn below_critical(sweep: &[Run]) -> &[Run] {
    sweep.split_last().map_or(&[], |(_, rest)| rest)
}

/// A figure over the force amplitude.
fn over_force(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> Vec<(f64, f64)> {
    sweep.iter().map(|run| (run.f_o, figure(run))).collect()
}

/// Mean and deviation of a figure at the lower and at the higher amplitudes below f_cr.
fn halves(sweep: &[Run], figure: impl Fn(&Run) -> f64) -> [(f64, f64); 2] {
    let values: Vec<f64> = below_critical(sweep).iter().map(figure).collect();
    let (low, high) = values.split_at(values.len() / 2);
    [mean_and_deviation(low), mean_and_deviation(high)]
}

fn share(sweep: &[Run], holds: impl Fn(&Run) -> bool) -> f64 {
    sweep.iter().filter(|run| holds(run)).count() as f64 / sweep.len().max(1) as f64
}

fn of_extremes(sweeps: &Sweeps) -> Vec<Claim> {
    vec![
        judged(
            "6.4.3-01",
            "The largest rotation grows with f_o to π/2, which it reaches at the critical force \
             (Figs 6.31, 6.35).",
            rotation(sweeps),
            "No such growth.",
        ),
        judged(
            "6.4.3-02",
            "Under a weak force the body never rises above its start at y = 0.1 (Figs 6.32, 6.36).",
            low_heights(sweeps),
            "It rises higher.",
        ),
        judged(
            "6.4.3-03",
            "Under a stronger force it may rise above its start, for r = 1.5.",
            height(&sweeps.short, |rises| rises > 0),
            "It does not, below the critical force.",
        ),
        judged(
            "6.4.3-04",
            "For r = 2.5 it stays below its start up to the critical force.",
            height(&sweeps.long, |rises| rises == 0),
            "It rises higher.",
        ),
    ]
}

fn rotation(sweeps: &Sweeps) -> Finding {
    let at_limit = |run: &Run| run.norms.theta_max > std::f64::consts::FRAC_PI_2 - 1e-9;
    let correlation = |sweep: &[Run]| spearman(&over_force(sweep, |run| run.norms.theta_max));
    let verdict = sweeps.judge(|sweep| {
        correlation(sweep) >= 0.9
            && sweep.last().is_some_and(at_limit)
            && !below_critical(sweep).iter().any(at_limit)
    });
    let text = |sweep: &[Run]| {
        let (_, before) = range(below_critical(sweep).iter().map(|run| run.norms.theta_max));
        let f_cr = sweep.last().map_or(0.0, |run| run.f_o);
        let rho = correlation(sweep);
        format!("rank correlation {rho:.2}, largest below f_cr = {f_cr:.2} is {before:.3}")
    };
    (verdict, sweeps.show(text))
}

/// Whether the body rises above its start.
fn rises(run: &Run) -> bool {
    run.norms.y_max > 0.1 + 1e-9
}

fn low_heights(sweeps: &Sweeps) -> Finding {
    let verdict = sweeps.judge(|sweep| sweep.iter().all(|run| run.f_o > 0.055 || !rises(run)));
    let text = |sweep: &[Run]| {
        let last = sweep.iter().take_while(|run| !rises(run)).last();
        format!("up to f_o = {:.2}", last.map_or(0.0, |run| run.f_o))
    };
    (verdict, sweeps.show(text))
}

fn height(members: &[Sweep], holds: impl Fn(usize) -> bool) -> Finding {
    let count = |sweep: &Sweep| {
        below_critical(sweep)
            .iter()
            .filter(|run| rises(run))
            .count()
    };
    let verdict = robust(members.iter().map(|sweep| holds(count(sweep))));
    let own = members.first().map(Vec::as_slice).unwrap_or_default();
    let (_, highest) = range(below_critical(own).iter().map(|run| run.norms.y_max));
    let rising = own.iter().filter(|run| rises(run)).map(|run| run.f_o);
    let (first, _) = range(rising);
    let evidence = if first.is_finite() {
        format!("highest y below f_cr {highest:.3}, above the start from f_o = {first:.2} on")
    } else {
        format!("highest y below f_cr {highest:.3}")
    };
    (verdict, evidence)
}

fn of_norms(study: &Study, sweeps: &Sweeps) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        judged(
            "6.4.3-05",
            "ρ1 hardly changes as f_o grows (Figs 6.33, 6.37).",
            steady_largest(sweeps),
            "It changes more.",
        ),
        judged(
            "6.4.3-07",
            "The largest snap is about the first impact (Figs 6.22-6.26).",
            first_is_largest(study, sweeps)?,
            "It is later in too many runs.",
        ),
        judged(
            "6.4.3-10",
            "For r = 1.5, ρ2 and ρ3 are constant under weak forces, lower and erratic under strong \
             ones.",
            erratic(sweeps),
            "No such difference.",
        ),
        judged(
            "6.4.3-13",
            "For r = 2.5, ρ2 and ρ3 fall, rise and fall again as f_o grows.",
            fall_rise_fall(sweeps),
            "Not in this order.",
        ),
        judged(
            "6.4.3-15",
            "ρ2 equals ρ3 as most runs are over by t = 10.",
            over_by_ten(study, sweeps),
            "Too many go on.",
        ),
        judged(
            "6.4.3-16",
            "The plots of ρ2 and ρ3 look alike.",
            alike(sweeps),
            "They differ.",
        ),
        judged(
            "6.4.3-18",
            "Wave energy is dissipated within a short time, t ≤ 10.",
            soon_settled(sweeps),
            "Too many runs go on.",
        ),
    ])
}

fn steady_largest(sweeps: &Sweeps) -> Finding {
    let spread = |sweep: &[Run]| {
        let values: Vec<f64> = sweep.iter().map(|run| run.norms.rho1).collect();
        let (low, high) = range(values.iter().copied());
        (high - low) / mean_and_deviation(&values).0
    };
    let text = |sweep: &[Run]| format!("ρ1 varies by {:.1} %", 100.0 * spread(sweep));
    (sweeps.judge(|sweep| spread(sweep) < 0.1), sweeps.show(text))
}

fn first_is_largest(study: &Study, sweeps: &Sweeps) -> Result<Finding, CaseError> {
    let codes = ["355", "3575", "359", "3515", "3520"];
    let mut figures: Vec<Vec<usize>> = Vec::new();
    for code in codes {
        let Some(case) = study.case(&format!("1910001000-{code}")) else {
            return Ok((Verdict::NotReproduced, format!("no case {code}")));
        };
        let members = ensemble(&Reading::Chapter.apply(case.parameters), NEIGHBOURS);
        figures.push(run_all(&members)?.iter().map(strongest).collect());
    }
    let early = |k: &usize| *k <= 3;
    let holds = |(member, sweep): (usize, &Sweep)| {
        let own = figures.iter().filter_map(|figure| figure.get(member));
        let drawn = own.filter(|k| early(k)).count();
        share(sweep, |run| early(&run.strongest)) >= 0.8 && drawn >= 4
    };
    let verdict = robust(sweeps.short.iter().enumerate().map(holds));
    let drawn: Vec<String> = figures
        .iter()
        .flat_map(|f| f.first())
        .map(usize::to_string)
        .collect();
    let own = sweeps.short.first().map(Vec::as_slice).unwrap_or_default();
    let part = 100.0 * share(own, |run| early(&run.strongest));
    let seconds = 100.0 * share(own, |run| run.strongest == 2);
    let drawn = drawn.join(", ");
    let evidence = format!(
        "the largest is impact number {drawn} in the figures; among the first three in {part:.0} % of \
         the runs over f_o, the second in {seconds:.0} %"
    );
    Ok((verdict, evidence))
}

fn erratic(sweeps: &Sweeps) -> Finding {
    let figures: [fn(&Run) -> f64; 2] = [|run| run.norms.rho2, |run| run.norms.rho3];
    let holds = |sweep: &Sweep| {
        figures.iter().all(|figure| {
            let [low, high] = halves(sweep, figure);
            high.1 >= 2.0 * low.1 && high.0 < low.0
        })
    };
    let own = sweeps.short.first().map(Vec::as_slice).unwrap_or_default();
    let [low, high] = halves(own, |run| run.norms.rho3);
    let evidence = format!(
        "ρ3 {:.2} ± {:.2}, then {:.2} ± {:.2}",
        low.0, low.1, high.0, high.1
    );
    (robust(sweeps.short.iter().map(holds)), evidence)
}

/// The place of the best value by some order among `from..to`.
fn place(values: &[f64], from: usize, to: usize, sign: f64) -> Option<usize> {
    let part = values.iter().enumerate().take(to).skip(from);
    part.max_by(|p, q| (sign * p.1).total_cmp(&(sign * q.1)))
        .map(|(k, _)| k)
}

fn fall_rise_fall(sweeps: &Sweeps) -> Finding {
    let rho3 = |sweep: &[Run]| -> Vec<f64> { sweep.iter().map(|run| run.norms.rho3).collect() };
    let holds = |sweep: &Sweep| {
        let rho = rho3(sweep);
        let last = rho.len().saturating_sub(1);
        let check = || {
            let i = place(&rho, 1, last, -1.0)?;
            let j = place(&rho, i + 1, last, 1.0)?;
            let (low, high) = (*rho.get(i)?, *rho.get(j)?);
            let (_, start) = range(rho.iter().take(2).copied());
            Some(start > 1.05 * low && high > 1.05 * low && *rho.last()? < 0.95 * high)
        };
        check().unwrap_or(false)
    };
    (
        robust(sweeps.long.iter().map(holds)),
        listed(&sweeps.long, |run| run.norms.rho3, 2),
    )
}

/// The values of a figure over f_o, from the case itself.
fn listed(members: &[Sweep], figure: impl Fn(&Run) -> f64, digits: usize) -> String {
    let own = members.first().map(Vec::as_slice).unwrap_or_default();
    let texts: Vec<String> = own
        .iter()
        .map(|run| format!("{:.digits$}", figure(run)))
        .collect();
    texts.join(" ")
}

fn over_by_ten(study: &Study, sweeps: &Sweeps) -> Finding {
    let over = |run: &Run| run.t <= 10.0 && run.norms.rho2 == run.norms.rho3;
    let verdict = sweeps.judge(|sweep| share(sweep, over) > 0.8);
    let tabled = || {
        study
            .cases
            .iter()
            .filter(|c| snapload::TABLE_6_1.iter().any(|(_, code)| *code == c.code))
    };
    let soon = tabled().filter(|c| c.runs.chapter.end().t <= 10.0).count();
    let text = |sweep: &[Run]| format!("{:.0} %", 100.0 * share(sweep, over));
    let (shares, all) = (sweeps.show(text), tabled().count());
    (
        verdict,
        format!("{shares} of the runs over f_o; of the cases of Table 6.1 {soon} of {all}"),
    )
}

fn alike(sweeps: &Sweeps) -> Finding {
    let differ = |run: &Run| (run.norms.rho3 - run.norms.rho2).abs() / run.norms.rho3;
    let text = |sweep: &[Run]| {
        let (_, most) = range(sweep.iter().map(differ));
        format!("they differ by {:.1} % at most", 100.0 * most)
    };
    let verdict = sweeps.judge(|sweep| share(sweep, |run| differ(run) < 0.05) >= 0.8);
    (verdict, sweeps.show(text))
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
    (verdict, format!("settled by t = 10, {}", sweeps.show(text)))
}
