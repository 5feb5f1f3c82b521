//! The swings of the rotation over the force amplitude.

use super::{Run, Sweep, Sweeps, below_critical, halves, listed, over_force, place};
use crate::claims::Claim;
use crate::claims::tools::{Finding, judged, range, robust, spearman};

/// Checks the claims on the swings.
pub(super) fn claims(sweeps: &Sweeps) -> Vec<Claim> {
    vec![
        judged(
            "6.4.3-11",
            "For r = 1.5 the swings of θ stay small under weak forces, then grow in size and number.",
            growing_swings(sweeps),
            "No such growth.",
        ),
        judged(
            "6.4.3-12",
            "More rotation goes with smaller ρ2 and ρ3, for r = 1.5.",
            rotation_and_norms(sweeps),
            "No such association.",
        ),
        judged(
            "6.4.3-14",
            "For r = 2.5 the swings of θ rise, fall and rise again as f_o grows.",
            rise_fall_rise(sweeps),
            "The last rise is too small to count; the words leave open which measure of the swings is \
             meant.",
        ),
    ]
}

fn growing_swings(sweeps: &Sweeps) -> Finding {
    let figures: [fn(&Run) -> f64; 2] =
        [Run::largest_swing, |run| run.large_swings().count() as f64];
    let holds = |sweep: &Sweep| {
        figures.iter().all(|figure| {
            let [low, high] = halves(sweep, figure);
            let points = over_force(below_critical(sweep), figure);
            high.0 > 2.0 * low.0 && spearman(&points) > 0.8
        })
    };
    let own = sweeps.short.first().map(Vec::as_slice).unwrap_or_default();
    let text = |figure: &fn(&Run) -> f64| {
        let [low, high] = halves(own, figure);
        let rho = spearman(&over_force(below_critical(own), figure));
        format!(
            "{:.2} then {:.2} on the mean (rank correlation {rho:.2})",
            low.0, high.0
        )
    };
    let [size, number] = figures.each_ref().map(text);
    let evidence = format!("largest swing {size}; large swings {number}");
    (robust(sweeps.short.iter().map(holds)), evidence)
}

fn rotation_and_norms(sweeps: &Sweeps) -> Finding {
    let correlations = |sweep: &[Run]| {
        let below = below_critical(sweep);
        let with = |figure: fn(&Run) -> f64| {
            let points = below.iter().map(|run| (figure(run), run.norms.rho3));
            spearman(&points.collect::<Vec<_>>())
        };
        [
            with(|run| run.large_swings().sum()),
            with(|run| run.norms.theta_max),
        ]
    };
    let holds = |sweep: &Sweep| correlations(sweep).iter().all(|rho| *rho < -0.4);
    let own = sweeps.short.first().map(Vec::as_slice).unwrap_or_default();
    let [swings, largest] = correlations(own);
    let evidence = format!(
        "rank correlation of ρ3 with the sum of the large swings {swings:.2}, with the largest \
         rotation {largest:.2}"
    );
    (robust(sweeps.short.iter().map(holds)), evidence)
}

fn rise_fall_rise(sweeps: &Sweeps) -> Finding {
    let holds = |sweep: &Sweep| {
        let swing: Vec<f64> = sweep.iter().map(Run::largest_swing).collect();
        let check = || {
            let top = place(&swing, 1, swing.len().saturating_sub(1), 1.0)?;
            let low = place(&swing, top + 1, swing.len(), -1.0)?;
            let (before, _) = range(swing.iter().take(top).copied());
            let (_, after) = range(swing.iter().skip(low).copied());
            let (top, low) = (*swing.get(top)?, *swing.get(low)?);
            Some(top > 1.05 * before && low < 0.95 * top && after > 1.05 * low)
        };
        check().unwrap_or(false)
    };
    let verdict = robust(sweeps.long.iter().map(holds));
    let swings = listed(&sweeps.long, Run::largest_swing, 3);
    (verdict, format!("largest swing {swings}"))
}
