//! The outcome of one run on elastic lines.

use super::outcome::{LineOutcome, Outcome};
use crate::physics::elastic::{ElasticRun, elastic_lines, run_elastic};
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::snap::SLOWEST_M_S;
use snapload::Stop;
use snapload::analysis::{OnProgress, Unfinished};

impl Outcome {
    /// Runs a structure on elastic lines, from its position of rest on them, and returns the
    /// outcome, with the structure about that position.
    ///
    /// # Errors
    /// A [`snapload::CaseError`] if a line has no stiffness or the body rests nowhere on them, and
    /// [`Unfinished::Cancelled`].
    pub fn with_elastic_lines(
        prepared: &ModelAtRest,
        on_progress: OnProgress,
    ) -> Result<(ModelAtRest, Self), Unfinished> {
        let elastic_lines = elastic_lines(prepared, 1.0)?;
        let elastic_case = prepared.with_elastic_lines(&elastic_lines)?;
        let run = run_elastic(&elastic_case, &elastic_lines, f64::INFINITY, on_progress)?;
        let outcome = Self::of_pulls(&elastic_case, &run);
        Ok((elastic_case, outcome))
    }

    /// The outcome of a motion on elastic lines. A snap is a pull that begins at
    /// [`SLOWEST_M_S`] or more.
    pub(super) fn of_pulls(elastic_case: &ModelAtRest, run: &ElasticRun) -> Self {
        let transient_s = elastic_case.structure.transient_s;
        let judged = || run.pulls.iter().filter(|pull| pull.peak_s >= transient_s);
        let early = || run.pulls.iter().filter(|pull| pull.peak_s < transient_s);
        let beginning = || judged().filter(|pull| pull.from_s >= transient_s);
        let snapping = || beginning().filter(|pull| pull.speed_m_s >= SLOWEST_M_S);
        let of_line = |line: usize| {
            let speeds = || {
                snapping()
                    .filter(|pull| pull.line == line)
                    .map(|pull| pull.speed_m_s)
            };
            LineOutcome {
                snaps: speeds().count() as u64,
                speed_m_s: speeds().fold(0.0, f64::max),
                snaps_at_all: beginning().any(|pull| pull.line == line),
                impacts_while_taut: 0,
                slower: beginning()
                    .filter(|pull| pull.line == line && pull.speed_m_s < SLOWEST_M_S)
                    .count() as u64,
                peak_n: Some(run.peaks_n[line]),
                largest_taut_n: run.peaks_n[line],
                reliable_n: run.reliable_peaks_n[line],
                least_n: run.least_n[line],
                slack_fraction: run.slack_fraction(line),
                slack_used: run.slack_used[line],
                early_n: early()
                    .filter(|pull| pull.line == line)
                    .map(|pull| pull.peak_n)
                    .fold(0.0, f64::max),
            }
        };
        Self {
            lines: (0..run.peaks_n.len()).map(of_line).collect(),
            stop: run.stop.unwrap_or(Stop::EndTime),
            end_s: run.end_s,
            turned_rad: run.turned_rad,
            excursion_m: run.excursion_m,
            waterline: run.waterline,
            emergence: run.emergence,
            peaks_n: snapping().map(|pull| pull.peak_n).collect(),
            speeds_m_s: snapping().map(|pull| pull.speed_m_s).collect(),
            waves_n: run.waves_n.clone(),
        }
    }
}
