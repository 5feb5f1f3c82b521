//! The swings of the rotation over the force amplitude.

use super::{Run, SUMS, Sweep, Sweeps, below_critical, figure, halves, over_force, place};
use crate::claims::numbers::{max, min, spearman};
use crate::claims::verdict::{Finding, Judged, Judges};

pub(super) const JUDGES: &Judges<fn(&Sweeps) -> Judged> = &[
    ("6.4.3-11", |sweeps| {
        let figures: [fn(&Run) -> f64; 2] = [
            |run: &Run| run.largest_swing,
            |run| run.large_swings.len() as f64,
        ];
        // Their means in both halves of the amplitudes, and their rank correlation with those.
        let measured = sweeps.short.iter().map(|sweep| {
            figures.map(|figure| {
                let [low, high] = halves(sweep, figure).map(|half| half.0);
                [
                    low,
                    high,
                    spearman(&over_force(below_critical(sweep), figure)),
                ]
            })
        });
        let measured: Vec<[[f64; 3]; 2]> = measured.collect();
        let grows = |[low, high, rho]: &[f64; 3]| *high > 2.0 * low && *rho > 0.8;
        let text = |[low, high, rho]: [f64; 3]| {
            format!("{low:.2} then {high:.2} on the mean (rank correlation {rho:.2})")
        };
        let finding = Finding::robust(&measured, |figures| figures.iter().all(grows));
        Ok(finding.values("size number", measured[0].map(text)))
    }),
    ("6.4.3-12", |sweeps| {
        /// A rank correlation that one calls an association.
        const ASSOCIATION: f64 = 0.4;
        let rotations: [fn(&Run) -> f64; 2] = [
            |run: &Run| run.large_swings.iter().sum(),
            |run| run.norms.theta_max,
        ];
        // Of ρ2 and ρ3, with the sum of the large swings and with the largest rotation.
        let correlations = sweeps.short.iter().map(|sweep| {
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(sum, rotation)| {
                let runs = below_critical(sweep).iter();
                let points = runs.map(|run| (rotations[rotation](run), SUMS[sum](run)));
                spearman(&points.collect::<Vec<_>>())
            })
        });
        let found: Vec<[f64; 4]> = correlations.collect();
        Ok(Finding::robust(&found, |all| max(*all) < -ASSOCIATION).list("rho", found.concat()))
    }),
    ("6.4.3-14", |sweeps| {
        /// A change that one sees in a plot.
        const SEEN: f64 = 0.05;
        let swings = |sweep: &Sweep| figure(sweep, |run| run.largest_swing);
        let changes = |sweep: &Sweep| ups_and_downs(&swings(sweep)).unwrap_or_default();
        let changes: Vec<[f64; 3]> = sweeps.long.iter().map(changes).collect();
        Ok(Finding::robust(&changes, |all| min(*all) > SEEN)
            .found(
                "but_the_last",
                changes.iter().all(|[p, q, _]| p.min(*q) > SEEN),
            )
            .list("swings", swings(&sweeps.long[0]))
            .list("last", changes.iter().map(|all| 100.0 * all[2])))
    }),
];

/// By how much swings rise, fall and rise again, in parts of where they come from; nothing if there
/// are too few.
fn ups_and_downs(swings: &[f64]) -> Option<[f64; 3]> {
    let top = place(swings, 1, swings.len().saturating_sub(1), 1.0)?;
    let low = place(swings, top + 1, swings.len(), -1.0)?;
    let before = min(swings[..top].iter().copied());
    let after = max(swings[low..].iter().copied());
    let (top, low) = (swings[top], swings[low]);
    Some([top / before - 1.0, 1.0 - low / top, after / low - 1.0])
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
