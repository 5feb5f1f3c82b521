//! The snaps of a structure's run that a page lists.
use serde::Serialize;
use snapload_structure::{Assessment, Snap};

/// The most snaps from the start, and the most within the interval that is shown.
const MOST_SHOWN: usize = 20_000;
/// The numbers of the hardest ones: of those that are judged, and of those in the transient.
const JUDGED: usize = 10;
const EARLY: usize = 3;

/// The snaps that count as columns, in kN and m/s.
#[derive(Serialize)]
pub(super) struct Snaps {
    /// Counted from 1: of many snaps some are left out.
    number: Vec<usize>,
    t: Vec<f64>,
    line: Vec<usize>,
    jolt: Vec<bool>,
    speed: Vec<f64>,
    peak: Vec<Option<f64>>,
    utilisation: Vec<Option<f64>>,
    /// The hardest of all as rows of these columns, in the order of time.
    hardest: Vec<usize>,
    /// The number of snaps.
    all: usize,
}

impl Snaps {
    pub(super) fn of(assessment: &Assessment, window: [f64; 2]) -> Self {
        let transient_s = assessment.prepared.structure.transient_s;
        let all = assessment.snaps.iter().filter(|snap| snap.counts());
        Self::listed(&all.collect::<Vec<_>>(), transient_s, window, MOST_SHOWN)
    }

    /// The first ones, those of the interval with one before and one after, and the hardest.
    fn listed(all: &[&Snap], transient_s: f64, [from, to]: [f64; 2], most: usize) -> Self {
        let hardest = hardest(all, transient_s);
        let begin = all.partition_point(|snap| snap.t_s < from);
        let end = all.partition_point(|snap| snap.t_s <= to);
        let end = end.min(begin + most) + 1;
        let within = begin.saturating_sub(1)..end.min(all.len());
        let mut rows: Vec<usize> = (0..all.len().min(most)).chain(within).collect();
        rows.extend(&hardest);
        rows.sort_unstable();
        rows.dedup();
        let place = |of: &usize| rows.binary_search(of).ok();
        let hardest = hardest.iter().filter_map(place).collect();
        let shown: Vec<&Snap> = rows.iter().map(|&row| all[row]).collect();
        Self {
            number: rows.iter().map(|row| row + 1).collect(),
            t: shown.iter().map(|snap| snap.t_s).collect(),
            line: shown.iter().map(|snap| snap.line + 1).collect(),
            jolt: shown.iter().map(|snap| snap.is_impact_while_taut).collect(),
            speed: shown.iter().map(|snap| snap.effective_speed_m_s).collect(),
            peak: shown
                .iter()
                .map(|snap| snap.peak_n.map(|peak| peak / 1e3))
                .collect(),
            utilisation: shown.iter().map(|snap| snap.utilisation).collect(),
            hardest,
            all: all.len(),
        }
    }
}

/// The times of the last snap that counts before a time, and of the first after it \[s\].
pub(super) fn around(snaps: &[Snap], t_s: f64) -> [Option<f64>; 2] {
    let counting = || snaps.iter().filter(|snap| snap.counts());
    let before = counting().rfind(|snap| snap.t_s < t_s);
    let after = counting().find(|snap| snap.t_s > t_s);
    [before, after].map(|found| found.map(|snap| snap.t_s))
}

/// The hardest ones, judged and in the transient, in the order of time.
fn hardest(all: &[&Snap], transient_s: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&a, &b| all[b].by_hardness(all[a]));
    let (judged, early): (Vec<usize>, Vec<usize>) =
        order.iter().partition(|&&row| all[row].t_s >= transient_s);
    let mut found: Vec<usize> = judged.into_iter().take(JUDGED).collect();
    found.extend(early.into_iter().take(EARLY));
    found.sort_unstable();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn snap(t_s: f64, speed_m_s: f64) -> Snap {
        Snap {
            t_s,
            line: 0,
            is_impact_while_taut: false,
            speed_m_s,
            impulse_n_s: 0.0,
            energy_lost_j: 0.0,
            effective_mass_kg: 1.0,
            effective_speed_m_s: speed_m_s,
            energy_peak_n: None,
            handbook_n: None,
            first_instant_n: None,
            peak_n: None,
            utilisation: None,
        }
    }

    #[test]
    fn the_snaps_around_a_time_are_those_that_count() {
        // The third is too slow to count, and two are at one instant.
        let all = [(1.0, 1.0), (2.0, 1.0), (3.0, 1e-4), (4.0, 1.0), (4.0, 2.0)];
        let snaps = all.map(|(t, speed)| snap(t, speed));
        assert_eq!(around(&snaps, 0.5), [None, Some(1.0)]);
        assert_eq!(around(&snaps, 2.0), [Some(1.0), Some(4.0)]);
        assert_eq!(around(&snaps, 4.0), [Some(2.0), None]);
    }

    #[test]
    fn the_hardest_are_of_all_snaps_however_few_are_listed() {
        // One a second, each harder than the one before.
        let snaps: Vec<Snap> = (0..100)
            .map(|k| snap(f64::from(k), f64::from(k + 1)))
            .collect();
        let all: Vec<&Snap> = snaps.iter().collect();
        let listed = Snaps::listed(&all, 50.0, [69.5, 71.5], 5);
        let hardest: Vec<usize> = listed
            .hardest
            .iter()
            .map(|&row| listed.number[row])
            .collect();
        let expected: Vec<usize> = (48..=50).chain(91..=100).collect();
        assert_eq!(hardest, expected);
        let rest: Vec<usize> = (1..=5).chain(70..=73).collect();
        let others = listed.number.iter().filter(|row| !expected.contains(row));
        assert_eq!(others.copied().collect::<Vec<_>>(), rest);
        assert_eq!(listed.all, 100);
        // Where all fit, all are listed.
        let listed = Snaps::listed(&all, 50.0, [69.5, 71.5], 100);
        assert_eq!(listed.number, (1..=100).collect::<Vec<_>>());
    }
}
