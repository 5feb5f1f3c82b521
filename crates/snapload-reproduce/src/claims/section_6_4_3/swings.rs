//! The swings of the rotation over the force amplitude.

use super::{Run, SUMS, Sweep, Sweeps, below_critical, halves, listed, over_force, own, place};
use crate::claims::numbers::{range, span, spearman};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};

/// Checks the claims on the swings.
pub(super) fn claims(sweeps: &Sweeps) -> Vec<Claim> {
    vec![
        claim(
            "6.4.3-11",
            "For r = 1.5 the swings of θ stay small under weak forces, then grow in size and \
             number.",
            growing_swings(sweeps),
        ),
        claim(
            "6.4.3-12",
            "More rotation goes with smaller ρ2 and ρ3, for r = 1.5.",
            rotation_and_norms(sweeps),
        ),
        claim(
            "6.4.3-14",
            "For r = 2.5 the swings of θ rise, fall and rise again as f_o grows.",
            rise_fall_rise(sweeps),
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
    let own = own(&sweeps.short);
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
    Finding::new(Verdict::robust(sweeps.short.iter().map(holds)), evidence)
}

fn rotation_and_norms(sweeps: &Sweeps) -> Finding {
    /// A rank correlation that one calls an association.
    const ASSOCIATION: f64 = 0.4;
    // Of ρ2 and ρ3, with the sum of the large swings and with the largest rotation.
    let correlations = |sweep: &[Run]| -> Vec<f64> {
        let with = |sum: fn(&Run) -> f64, figure: fn(&Run) -> f64| {
            let points = below_critical(sweep)
                .iter()
                .map(|run| (figure(run), sum(run)));
            spearman(&points.collect::<Vec<_>>())
        };
        let of = |sum: fn(&Run) -> f64| {
            let swings = with(sum, |run| run.large_swings().sum());
            [swings, with(sum, |run| run.norms.theta_max)]
        };
        SUMS.into_iter().flat_map(of).collect()
    };
    let holds = |sweep: &Sweep| correlations(sweep).iter().all(|rho| *rho < -ASSOCIATION);
    let all = sweeps.short.iter().flat_map(|sweep| correlations(sweep));
    Finding::new(
        Verdict::robust(sweeps.short.iter().map(holds)),
        format!(
            "rank correlations of ρ2 and ρ3 with the sum of the large swings and with the largest \
             rotation: {} by start",
            span(all, 2)
        ),
    )
}

/// By how much swings rise, fall and rise again, in parts of where they come from; nothing if there are
/// too few.
fn ups_and_downs(swings: &[f64]) -> Option<[f64; 3]> {
    let top = place(swings, 1, swings.len().saturating_sub(1), 1.0)?;
    let low = place(swings, top + 1, swings.len(), -1.0)?;
    let (before, _) = range(swings.iter().take(top).copied());
    let (_, after) = range(swings.iter().skip(low).copied());
    let (top, low) = (*swings.get(top)?, *swings.get(low)?);
    Some([top / before - 1.0, 1.0 - low / top, after / low - 1.0])
}

fn rise_fall_rise(sweeps: &Sweeps) -> Finding {
    /// A change that one sees in a plot.
    const SEEN: f64 = 0.05;
    let of = |sweep: &Sweep| {
        let swings: Vec<f64> = sweep.iter().map(Run::largest_swing).collect();
        ups_and_downs(&swings).unwrap_or_default()
    };
    let found: Vec<[f64; 3]> = sweeps.long.iter().map(of).collect();
    let seen = |changes: &[f64; 3]| changes.iter().all(|change| *change > SEEN);
    let swings = listed(&sweeps.long, Run::largest_swing, 3);
    let last = span(found.iter().map(|changes| 100.0 * changes[2]), 0);
    Finding::new(
        Verdict::robust(found.iter().map(seen)),
        format!("largest swing {swings}"),
    )
    .because(
        Verdict::NotReproduced,
        found
            .iter()
            .all(|changes| changes[0] > SEEN && changes[1] > SEEN),
        format!(
            "They rise and fall, but the last rise is one of {last} %. The words leave open which \
             measure of the swings is meant."
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rise_that_is_missing_is_seen() {
        let rises = |swings: &[f64]| ups_and_downs(swings).map(|c| c.map(|c| c > 0.05));
        assert_eq!(rises(&[1.0, 2.0, 1.0, 3.0]), Some([true; 3]));
        assert_eq!(rises(&[1.0, 3.0, 2.0, 1.0]), Some([true, true, false]));
        assert_eq!(rises(&[1.0]), None);
    }
}
