//! Erosion of safe basins: how much of a window is safe as a third key changes.

use crate::basin::Basin;
use crate::measures::Measures;
use crate::window::{Window, check_varies};
use snapload::analysis::{OnProgress, Progress, Unfinished};
use snapload::{CaseError, Value};

/// Safe basins for values of a key.
#[derive(Clone, Debug)]
pub struct Erosion {
    /// The key.
    pub key: &'static str,
    /// Its values from the smallest to the largest, each with its basin.
    pub points: Vec<(f64, Basin)>,
}

/// Fraction of the safe part at the first value that defines the knee.
pub const KNEE: f64 = 0.9;

impl Erosion {
    /// Runs the window at each value, from the smallest to the largest.
    ///
    /// # Errors
    /// As for [`Basin::of`].
    pub fn of(
        window: &Window,
        key: &'static str,
        values: &[f64],
        trust: bool,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        if window.keys.contains(&key) {
            let error = CaseError::value("over", Value::Text(key.to_owned()), "a key not varied");
            return Err(error.into());
        }
        check_varies("over", &window.base, key)?;
        // The knee is where the safe part falls as the key rises, however its values are given.
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        let mut points = Vec::with_capacity(values.len());
        for (done, value) in values.iter().enumerate() {
            let base = window
                .base
                .over(|name, other| if name == key { *value } else { other });
            base.check()?;
            let here = Window {
                base,
                ..window.clone()
            };
            let share = |progress: Progress| {
                let part = progress.done / progress.of;
                on_progress(Progress::new(
                    "erosion",
                    done as f64 + part,
                    values.len() as f64,
                ))
            };
            points.push((*value, Basin::of(here, trust, &share)?));
        }
        Ok(Self { key, points })
    }

    /// Whether neighbours and horizons were computed: without them no cell counts as undecided.
    pub fn neighbours_run(&self) -> bool {
        self.points.iter().all(|(_, basin)| basin.neighbours_run)
    }

    /// Whether any run is cut short, so that its cell is undecided without neighbours, too.
    pub(crate) fn is_cut_short(&self) -> bool {
        let cut_short = |(_, basin): &(f64, Basin)| basin.measures.cut_short > 0;
        self.points.iter().any(cut_short)
    }

    /// The last value up to which the safe part of the decided cells does not fall below nine
    /// tenths of that at the first value; none if it never falls below.
    ///
    /// Undecided cells are left out, as their ends carry no information: for symmetric starts they
    /// are many, and all at one value. A value without decided cells is skipped. If neighbours were
    /// not computed, all cells count as decided whose runs are not cut short.
    pub fn knee(&self) -> Option<f64> {
        self.knee_of(|m| m.decided_part().map(|part| [part; 2]))
    }

    /// The values that have decided cells, each with the safe part of these.
    pub fn decided(&self) -> Vec<(f64, f64)> {
        let part = |(value, basin): &(f64, Basin)| Some((*value, basin.measures.decided_part()?));
        self.points.iter().filter_map(part).collect()
    }

    /// The least and the greatest value that the knee can have, for all possible ends of the
    /// undecided cells; each is none if there is no knee then. None at all if neighbours were not
    /// computed and no run is cut short, so that none are known.
    pub fn knee_between(&self) -> Option<[Option<f64>; 2]> {
        let part = |cells: usize, m: &Measures| cells as f64 / m.legal as f64;
        let low = |m: &Measures| part(m.safe - m.undecided_safe, m);
        let high = |m: &Measures| part(m.safe + m.undecided - m.undecided_safe, m);
        // Without a safe start at the first value there is no knee; one of them gives the greatest.
        let least_safe = |m: &Measures| low(m).max(part(1, m)).min(high(m));
        (self.neighbours_run() || self.is_cut_short()).then(|| {
            [
                self.knee_of(|m| (m.legal > 0).then(|| [high(m), low(m)])),
                self.knee_of(|m| (m.legal > 0).then(|| [least_safe(m), high(m)])),
            ]
        })
    }

    /// The knee, where `parts` gives the safe part that counts as the reference at the first value
    /// and the one that is compared with it, for the values that have such parts.
    fn knee_of(&self, parts: impl Fn(&Measures) -> Option<[f64; 2]>) -> Option<f64> {
        let of = |(value, basin): &(f64, Basin)| parts(&basin.measures).map(|both| (*value, both));
        let mut points = self.points.iter().filter_map(of);
        let (mut last, [whole, _]) = points.next()?;
        for (value, [_, left]) in points {
            if left < KNEE * whole {
                return Some(last);
            }
            last = value;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::Distances;
    use snapload::Parameters;

    /// Basins of a hundred legal cells, given the numbers of safe, of undecided, and of undecided
    /// safe ones.
    fn eroded(neighbours_run: bool, counts: &[[usize; 3]]) -> Erosion {
        let basin = |&[safe, undecided, undecided_safe]: &[usize; 3]| Basin {
            window: Window {
                base: Parameters::STANDARD,
                keys: ["x", "y"],
                values: [vec![0.0], vec![0.0]],
            },
            cells: Vec::new(),
            neighbours_run,
            measures: Measures {
                legal: 100,
                safe,
                undecided,
                undecided_safe,
                past_horizon: 0,
                gim: safe as f64 / 100.0,
                interval: [0.0, 1.0],
                lim: None,
                lim_at_most: None,
                integrity_factor: None,
                cut_short: 0,
                disc_meets_unknown: false,
                iim: [None; 2],
                at_least: Distances::default(),
            },
        };
        let points = (0u8..).map(f64::from).zip(counts.iter().map(basin));
        Erosion {
            key: "f_o",
            points: points.collect(),
        }
    }

    #[test]
    fn a_value_without_decided_cells_hides_no_knee() {
        let erosion = eroded(
            true,
            &[[90, 100, 90], [80, 0, 0], [75, 100, 75], [40, 0, 0]],
        );
        assert_eq!(erosion.knee(), Some(1.0));
        assert_eq!(erosion.knee_between(), Some([Some(0.0), None]));
    }

    #[test]
    fn without_neighbours_nothing_is_claimed_of_how_certain_the_knee_is() {
        let erosion = eroded(false, &[[90, 0, 0], [40, 0, 0]]);
        assert_eq!(erosion.knee(), Some(0.0));
        assert_eq!(erosion.knee_between(), None);
        let text = text_after_table(&erosion);
        assert!(text.contains("neighbours were not run"), "{text}");
    }

    /// What is printed after the table.
    fn text_after_table(erosion: &Erosion) -> String {
        let text = crate::erosion_summary(erosion);
        text.split_once("\n\n").unwrap().1.to_owned()
    }

    #[test]
    fn the_knee_is_reported_with_the_value_that_it_is_measured_by() {
        let text = text_after_table(&eroded(false, &[[90, 0, 0], [85, 0, 0], [40, 0, 0]]));
        let safe =
            "Safe      0.9000 (0.0000 to 1.0000) at f_o = 0, 0.4000 (0.0000 to 1.0000) at f_o = 2";
        assert!(text.contains(safe), "{text}");
        let knee =
            "at f_o = 1, up to which the safe part is at least 0.9 of that at f_o = 0, 0.9000\n";
        assert!(text.contains(knee), "{text}");
        let text = text_after_table(&eroded(
            true,
            &[[90, 100, 90], [80, 0, 0], [75, 100, 75], [40, 0, 0]],
        ));
        let doubt = "is at least 0.9 of that at f_o = 1, 0.8000; from 0 to beyond the last value, depending on how";
        assert!(text.contains(doubt), "{text}");
    }

    #[test]
    fn the_table_has_the_cells_that_the_knee_leaves_out_and_the_part_that_it_is_measured_by() {
        let text = crate::erosion_summary(&eroded(true, &[[60, 20, 20], [45, 0, 0]]));
        let rows: Vec<Vec<&str>> = text
            .lines()
            .take(3)
            .map(|line| {
                line.split("  ")
                    .map(str::trim)
                    .filter(|word| !word.is_empty())
                    .collect()
            })
            .collect();
        assert_eq!(
            rows[0],
            ["f_o", "safe", "undecided", "of decided", "nearest", "disc"]
        );
        assert_eq!(rows[1], ["0", "0.6000", "20", "0.5000", "-", "-"]);
        assert_eq!(rows[2], ["1", "0.4500", "0", "0.4500", "-", "-"]);
        let unknown = crate::erosion_summary(&eroded(false, &[[60, 0, 0], [45, 0, 0]]));
        assert!(
            unknown.contains("\n0            0.6000   -          -  "),
            "{unknown}"
        );
    }

    #[test]
    fn values_between_decimals_are_printed_with_six_digits() {
        let mut erosion = eroded(false, &[[90, 0, 0], [85, 0, 0], [40, 0, 0]]);
        for (row, (value, _)) in erosion.points.iter_mut().enumerate() {
            *value = row as f64 / 3.0 - 1.0;
        }
        let text = crate::erosion_summary(&erosion);
        assert!(text.contains("\n-0.666667    0.8500"), "{text}");
        assert!(
            text.contains("at f_o = -0.666667, up to which") && !text.contains("6666666"),
            "{text}"
        );
    }

    #[test]
    fn why_there_is_no_knee_is_reported() {
        let text = |counts: &[[usize; 3]]| text_after_table(&eroded(false, counts));
        for (counts, why) in [
            (
                &[[90, 0, 0], [85, 0, 0]][..],
                "never falls below 0.9 of that at f_o = 0",
            ),
            (
                &[[0, 0, 0], [85, 0, 0]],
                "no legal cell is safe at the first value, f_o = 0",
            ),
            (&[[90, 0, 0]], "f_o = 0 alone has a legal cell"),
        ] {
            assert!(text(counts).contains(why), "{}", text(counts));
        }
        let undecided = text_after_table(&eroded(true, &[[90, 100, 90], [80, 100, 80]]));
        assert!(
            undecided.contains("no value has a decided cell"),
            "{undecided}"
        );
    }

    #[test]
    fn values_without_a_legal_start_are_no_safe_part() {
        let mut erosion = eroded(false, &[[0, 0, 0], [85, 0, 0], [40, 0, 0], [0, 0, 0]]);
        for k in [0, 3] {
            erosion.points[k].1.measures.legal = 0;
        }
        let text = text_after_table(&erosion);
        assert!(text.contains(" at f_o = 1, 0.4000 "), "{text}");
        assert!(text.contains("Knee      at f_o = 1, up to which"), "{text}");
        for (_, basin) in &mut erosion.points {
            basin.measures.legal = 0;
        }
        let text = text_after_table(&erosion);
        assert!(
            text.contains("no start is legal at any value") && !text.contains("Safe"),
            "{text}"
        );
    }
}
