//! The largest rotation and height over the force amplitude.

use super::{Run, Sweep, Sweeps, below_critical, over_force, own};
use crate::claims::numbers::{range, spearman};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};

/// Checks the claims on them.
pub(super) fn claims(sweeps: &Sweeps) -> Vec<Claim> {
    vec![
        claim(
            "6.4.3-01",
            "The largest rotation grows with f_o to π/2, which it reaches at the critical force \
             (Figs 6.31, 6.35).",
            rotation(sweeps),
        ),
        claim(
            "6.4.3-02",
            "Under a weak force the body never rises above its start at y = 0.1 (Figs 6.32, 6.36).",
            low_heights(sweeps),
        ),
        claim(
            "6.4.3-03",
            "Under a stronger force it may rise above its start, for r = 1.5.",
            height(&sweeps.short, |rises| rises > 0),
        ),
        claim(
            "6.4.3-04",
            "For r = 2.5 it stays below its start up to the critical force.",
            height(&sweeps.long, |rises| rises == 0),
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
    Finding::new(verdict, sweeps.show(text))
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
    Finding::new(verdict, sweeps.show(text))
}

fn height(members: &[Sweep], holds: impl Fn(usize) -> bool) -> Finding {
    let count = |sweep: &Sweep| {
        below_critical(sweep)
            .iter()
            .filter(|run| rises(run))
            .count()
    };
    let verdict = Verdict::robust(members.iter().map(|sweep| holds(count(sweep))));
    let own = own(members);
    let (_, highest) = range(below_critical(own).iter().map(|run| run.norms.y_max));
    let rising = own.iter().filter(|run| rises(run)).map(|run| run.f_o);
    let (first, _) = range(rising);
    let evidence = if first.is_finite() {
        format!("highest y below f_cr {highest:.3}, above the start from f_o = {first:.2} on")
    } else {
        format!("highest y below f_cr {highest:.3}")
    };
    Finding::new(verdict, evidence)
}
