//! The swings of the rotation over the force amplitude.

use super::{
    CONSTANT, SUMS, Sweep, Sweeps, Swept, below_critical, figure, halves, is_constant, over_force,
    place,
};
use crate::claims::motions::LARGE;
use crate::claims::numbers::{max, min, span, spearman};
use crate::claims::verdict::{Checked, Checks, Finding};

pub(super) const CHECKS: &Checks<fn(&Sweeps) -> Checked> = &[
    ("6.4.3-11", |sweeps| {
        Ok(change_with_force(sweeps, |run| run.largest_swing))
    }),
    ("6.4.3-23", |sweeps| {
        let rates = sweeps.short.iter().map(|sweep| {
            let [low, high] = halves(sweep, |run| run.turns);
            [low.0, high.0]
        });
        let number = change_with_force(sweeps, |run| run.large_swings.len() as f64);
        Ok(number.value("angle", LARGE).by_start("rates", rates))
    }),
    ("6.4.3-12", |sweeps| {
        let found = sweeps
            .short
            .iter()
            .map(|sweep| associations(below_critical(sweep)));
        let found: Vec<[[f64; 2]; 4]> = found.collect();
        let of = |k: usize| found.iter().flatten().map(move |rho| rho[k]);
        Ok(Finding::robust(&found, is_associated)
            .list("rho", of(0))
            .list("given", of(1))
            .value("association", -ASSOCIATION))
    }),
    ("6.4.3-14", |sweeps| {
        /// The least change that is visible in a plot.
        const SEEN: f64 = 0.05;
        let swings = |sweep: &Sweep| figure(sweep, |run| run.largest_swing);
        let changes = |sweep: &Sweep| ups_and_downs(&swings(sweep)).unwrap_or_default();
        let changes: Vec<[f64; 3]> = sweeps.long.iter().map(changes).collect();
        Ok(Finding::robust(&changes, |all| min(*all) > SEEN)
            .condition(
                "but_the_last",
                changes.iter().all(|[p, q, _]| p.min(*q) > SEEN),
            )
            .by_start("swings", sweeps.long.iter().map(swings))
            .value("seen", 100.0 * SEEN)
            .list("last", changes.iter().map(|all| 100.0 * all[2])))
    }),
];

/// A quantity of the swings: its mean and deviation in both halves of the amplitudes, and its rank
/// correlation with these.
type Growth = ([(f64, f64); 2], f64);

/// Whether a quantity is constant under weak forces, and grows to more than twice that under strong
/// ones.
fn constant_then_grows(([low, high], rho): &Growth) -> bool {
    is_constant(*low) && high.0 > 2.0 * low.0 && *rho > TREND
}

/// The finding on a quantity of the swings under weak forces and under strong ones.
fn change_with_force(sweeps: &Sweeps, figure: fn(&Swept) -> f64) -> Finding {
    let of = |sweep: &Sweep| {
        let rho = spearman(&over_force(below_critical(sweep), figure));
        (halves(sweep, figure), rho)
    };
    let measured: Vec<Growth> = sweeps.short.iter().map(of).collect();
    let half = |k: usize| {
        let (means, deviations): (Vec<f64>, Vec<f64>) =
            measured.iter().map(|growth| growth.0[k]).unzip();
        format!("{} ± {}", span(means, 2), span(deviations, 2))
    };
    Finding::robust(&measured, constant_then_grows)
        .values("low high", [half(0), half(1)])
        .list("rho", measured.iter().map(|growth| growth.1))
        .values("constant trend", [100.0 * CONSTANT, TREND])
}

/// The least rank correlation that counts as a trend.
const TREND: f64 = 0.5;

/// The least rank correlation that counts as an association.
const ASSOCIATION: f64 = 0.4;

/// Rank correlations of ρ2 and of ρ3 with the sum of the large swings and with the largest
/// rotation: each as it is, and with the effect of the force amplitude removed.
fn associations(sweep: &[Swept]) -> [[f64; 2]; 4] {
    let rotations: [fn(&Swept) -> f64; 2] = [
        |run: &Swept| run.large_swings.iter().sum(),
        |run| run.norms.theta_max,
    ];
    let force: fn(&Swept) -> f64 = |run| run.f_o;
    let rho = |p: fn(&Swept) -> f64, q: fn(&Swept) -> f64| {
        spearman(&sweep.iter().map(|run| (p(run), q(run))).collect::<Vec<_>>())
    };
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(sum, rotation)| {
        let (sum, rotation) = (SUMS[sum], rotations[rotation]);
        let plain = rho(rotation, sum);
        [plain, given(plain, rho(rotation, force), rho(sum, force))]
    })
}

/// Whether more rotation is associated with smaller sums beyond the effect of the force alone.
fn is_associated(all: &[[f64; 2]; 4]) -> bool {
    max(all.iter().map(|rho| rho[1])) < -ASSOCIATION
}

/// The partial correlation of two quantities given a third, from the three correlations.
fn given(of_two: f64, with_first: f64, with_second: f64) -> f64 {
    let left = (1.0 - with_first * with_first) * (1.0 - with_second * with_second);
    if left > 0.0 {
        (of_two - with_first * with_second) / left.sqrt()
    } else {
        0.0
    }
}

/// The relative changes of swings that rise, fall and rise again; none if there are too few.
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
    fn what_the_force_brings_about_is_no_association() {
        // Both depend on a third quantity only.
        assert!(given(0.64, 0.8, 0.8).abs() < 1e-12);
        assert!((given(-0.66, 0.0, 0.0) + 0.66).abs() < 1e-12);
        assert_eq!(given(0.5, 1.0, 0.5), 0.0);
        assert!(!is_associated(&[[-0.66, -0.08]; 4]) && is_associated(&[[-0.66, -0.5]; 4]));
    }

    #[test]
    fn what_grows_from_the_first_on_is_not_constant_at_first() {
        let growth = |deviation, high| ([(0.6, deviation), (high, 0.5)], 0.9);
        assert!(constant_then_grows(&growth(0.02, 1.6)));
        assert!(!constant_then_grows(&growth(0.1, 1.6)));
        assert!(!constant_then_grows(&growth(0.02, 0.7)));
        // Zero under weak forces, but not under strong ones.
        assert!(constant_then_grows(&([(0.0, 0.0), (0.5, 0.9)], 0.6)));
    }

    #[test]
    fn a_rise_that_is_missing_is_seen() {
        let rises = |swings: &[f64]| ups_and_downs(swings).map(|c| c.map(|c| c > 0.05));
        assert_eq!(rises(&[1.0, 2.0, 1.0, 3.0]), Some([true; 3]));
        assert_eq!(rises(&[1.0, 3.0, 2.0, 1.0]), Some([true, true, false]));
        assert_eq!(rises(&[1.0]), None);
    }
}
