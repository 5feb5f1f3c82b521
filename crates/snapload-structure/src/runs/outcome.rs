//! The outcome of one run.

use crate::physics::emergence::Emergence;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::snap::{Snap, snaps_of_step};
use crate::physics::waterline::Waterline;
use crate::physics::waves_of_tension::WavesOfTension;
use crate::structure::Structure;
use serde::Serialize;
use snapload::analysis::{OnProgress, Unfinished, follow};
use snapload::{Simulation, Step, Stop};

/// The outcome of one run for one line.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LineOutcome {
    /// Snaps of [`crate::SLOWEST_M_S`] and above; this and all that follows is after the transient.
    pub snaps: u64,
    /// The fastest \[m/s\].
    #[serde(rename = "fastest_snap_m_s")]
    pub speed_m_s: f64,
    /// Impacts that snaps of other lines passed on to it while it was taut, if they count.
    #[serde(skip)]
    pub impacts_while_taut: u64,
    /// Snaps and impacts while taut that are too slow to be counted.
    #[serde(skip)]
    pub slower: u64,
    /// Whether it snaps, however slowly: impacts that are passed on to it while it is taut do not
    /// tell that it would.
    #[serde(skip)]
    pub snaps_at_all: bool,
    /// The largest estimate of tension in a snap or an impact while
    /// taut, slower ones included \[N\].
    #[serde(rename = "peak_tension_n")]
    pub peak_n: Option<f64>,
    /// The largest tension while the line stays taut \[N\].
    #[serde(rename = "held_tension_n")]
    pub largest_taut_n: f64,
    /// The largest tension, in a snap too, while linear hydrostatics hold \[N\].
    #[serde(skip)]
    pub reliable_n: f64,
    /// The smallest tension, 0 if it goes slack; none if the run ends before the judged time \[N\].
    #[serde(rename = "least_tension_n")]
    pub least_n: Option<f64>,
    /// The part of the whole time in which it has no tension.
    pub slack_fraction: f64,
    /// The largest part of its slack at rest that is used up, 1 if it becomes taut; none for a line
    /// with tension at rest, or without judged time.
    #[serde(skip)]
    pub slack_used: Option<f64>,
    /// The largest tension before the judged time, while taut or in a snap if that is known \[N\].
    #[serde(skip)]
    pub early_n: f64,
}

impl LineOutcome {
    /// The larger of its tension while taut and in a snap; none if it snaps and that tension is not
    /// known, or without judged time \[N\].
    pub fn largest_n(&self) -> Option<f64> {
        self.least_n?;
        let no_snap = (self.counted() + self.slower == 0).then_some(0.0);
        Some(self.peak_n.or(no_snap)?.max(self.largest_taut_n))
    }

    /// The number of snaps and impacts while taut that count.
    pub(crate) fn counted(&self) -> u64 {
        self.snaps + self.impacts_while_taut
    }

    /// Whether it is slack at rest and never becomes taut in the judged time.
    pub(crate) fn stays_slack(&self) -> bool {
        self.slack_used.is_some_and(|used| used < 1.0) && self.largest_n() == Some(0.0)
    }
}

/// The outcome of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// By line.
    pub lines: Vec<LineOutcome>,
    /// How it ended.
    pub stop: Stop,
    /// When it ended \[s\].
    pub end_s: f64,
    /// The largest rotation on either side \[rad\].
    pub turned_rad: f64,
    /// The largest horizontal distance from the position of rest at the ends of the segments of
    /// its motion \[m\].
    pub excursion_m: f64,
    /// The extreme positions of a floating body relative to the still water; none for a submerged
    /// one.
    pub waterline: Option<Waterline>,
    /// How far a submerged body comes out of the water.
    pub emergence: Emergence,
    /// Peak tensions of all counted snaps, if they are known \[N\].
    pub peaks_n: Vec<f64>,
    /// Their speeds \[m/s\].
    pub speeds_m_s: Vec<f64>,
    /// Crest and trough of every wave of tension of every line \[N\].
    pub waves_n: Vec<[f64; 2]>,
}

impl Outcome {
    /// Runs a structure in waves `height` times as high and keeps the outcome.
    ///
    /// # Errors
    /// A [`snapload::CaseError`] if it can not start, and [`Unfinished::Cancelled`].
    pub fn of(
        prepared: &ModelAtRest,
        height: f64,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let mut outcome_counter = OutcomeCounter::new(prepared);
        let simulation = follow(prepared.begin(height)?, on_progress, |simulation, step| {
            outcome_counter.add_step(simulation, step);
        })?;
        let stop = simulation.stop().unwrap_or(Stop::EndTime);
        Ok(outcome_counter.finish(simulation.time(), stop))
    }

    /// The largest estimate of tension in a snap of any line \[N\].
    pub fn peak_n(&self) -> Option<f64> {
        let peaks = self.lines.iter().filter_map(|line| line.peak_n);
        peaks.reduce(f64::max)
    }

    /// The largest tension of any line, while taut or in a snap if that is known \[N\].
    pub fn largest_n(&self) -> f64 {
        let held = self.lines.iter().map(|line| line.largest_taut_n);
        held.fold(self.peak_n().unwrap_or(0.0), f64::max)
    }

    /// The same; none if a tension is not known, or nothing is judged \[N\].
    pub fn known_largest_n(&self) -> Option<f64> {
        let of_lines = self.lines.iter().map(LineOutcome::largest_n);
        let known: Option<Vec<f64>> = of_lines.collect();
        known?.into_iter().reduce(f64::max)
    }

    /// The largest estimate of tension in a snap of any line; none if that of one that snaps is not
    /// known \[N\].
    pub fn known_peak_n(&self) -> Option<f64> {
        let unknown =
            |line: &LineOutcome| line.peak_n.is_none() && line.counted() + line.slower > 0;
        self.peak_n().filter(|_| !self.lines.iter().any(unknown))
    }

    /// The fastest snap of any line \[m/s\].
    pub fn speed_m_s(&self) -> f64 {
        let speeds = self.lines.iter().map(|line| line.speed_m_s);
        speeds.fold(0.0, f64::max)
    }

    /// Whether the run ended before the judged time: then its lines have no results.
    pub fn is_unjudged(&self) -> bool {
        self.lines.iter().all(|line| line.least_n.is_none())
    }

    /// Snaps of all lines.
    pub fn snaps(&self) -> u64 {
        self.lines.iter().map(|line| line.snaps).sum()
    }

    /// Whether a line snaps in the judged time, however slowly.
    pub(crate) fn has_snaps(&self) -> bool {
        self.lines.iter().any(|line| line.snaps_at_all)
    }

    /// Whether snaps of other lines load a line while it is taut.
    pub(crate) fn has_impacts_while_taut(&self) -> bool {
        self.lines.iter().any(|line| line.impacts_while_taut > 0)
    }

    /// Whether a line would break before the judged time.
    pub fn breaks_early(&self, structure: &Structure) -> bool {
        let mut lines = self.lines.iter().zip(&structure.lines);
        lines.any(|(outcome, line)| {
            line.breaking_load_n
                .is_some_and(|load| outcome.early_n >= load)
        })
    }

    /// Whether the largest tension of a line is one for which linear hydrostatics do not hold, and
    /// no line breaks while they hold.
    pub(crate) fn depends_on_hydrostatics(&self, structure: &Structure) -> bool {
        let mut lines = self.lines.iter().zip(&structure.lines);
        let breaks = lines.any(|(outcome, line)| {
            let reliable_n = self.reliable_n(outcome);
            reliable_n.is_some_and(|n| line.breaking_load_n.is_some_and(|load_n| n >= load_n))
        });
        !breaks && self.exceeds_hydrostatics()
    }

    /// Whether the largest tension of a line is one for which linear hydrostatics do not hold, or a
    /// submerged body came out of the water.
    pub(crate) fn exceeds_hydrostatics(&self) -> bool {
        let mut lines = self.lines.iter();
        self.emergence.matters || lines.any(|line| line.largest_n() > self.reliable_n(line))
    }

    /// The largest tension of a line while linear hydrostatics hold, as they do for a submerged
    /// body until it comes out of the water; none if that is not known \[N\].
    pub(crate) fn reliable_n(&self, line: &LineOutcome) -> Option<f64> {
        let largest_n = line.largest_n()?;
        let may_not_hold = self.waterline.is_some() || self.emergence.matters;
        Some(if may_not_hold {
            line.reliable_n
        } else {
            largest_n
        })
    }

    /// Whether a line breaks in the judged time, the body turns over or touches the
    /// floor; none if that depends on tensions for which linear hydrostatics do not
    /// hold, or is not known as computed.
    pub(crate) fn fails(&self, structure: &Structure) -> Option<bool> {
        match self.depends_on_hydrostatics(structure) && !self.stop.exceeds() {
            true => None,
            false => self.fails_as_computed(structure),
        }
    }

    /// The same by all tensions as they are computed; none if no line is known to break, and the
    /// run ended early or a tension or a breaking load is not known.
    pub(crate) fn fails_as_computed(&self, structure: &Structure) -> Option<bool> {
        let parts = self.utilisations(structure);
        let breaks = parts.iter().flatten().any(|part| *part >= 1.0);
        if breaks || self.stop.exceeds() {
            return Some(true);
        }
        let whole = self.stop == Stop::EndTime && parts.iter().all(Option::is_some);
        whole.then_some(false)
    }

    /// Whether it is not known whether it fails, for another reason than linear hydrostatics.
    pub(crate) fn lacks_an_answer(&self, structure: &Structure) -> bool {
        self.fails(structure).is_none() && !self.depends_on_hydrostatics(structure)
    }

    /// Whether a breaking load is not known, or a tension in the judged time.
    pub(crate) fn lacks_a_load(&self, structure: &Structure) -> bool {
        let mut lines = self.lines.iter().zip(&structure.lines);
        lines.any(|(outcome, line)| {
            let judged = outcome.least_n.is_some();
            line.breaking_load_n.is_none() || judged && outcome.largest_n().is_none()
        })
    }

    /// The largest tension of each line divided by its breaking load, if that is known.
    pub fn utilisations(&self, structure: &Structure) -> Vec<Option<f64>> {
        let one = |(outcome, line): (&LineOutcome, &crate::structure::LineSi)| {
            Some(outcome.largest_n()? / line.breaking_load_n?)
        };
        self.lines.iter().zip(&structure.lines).map(one).collect()
    }
}

/// Sums up a run, step by step.
pub(super) struct OutcomeCounter<'a> {
    prepared: &'a ModelAtRest,
    lines: Vec<LineOutcome>,
    /// Time without tension, in the engine's units.
    slack: Vec<f64>,
    turned_rad: f64,
    excursion_m: f64,
    waterline: Option<Waterline>,
    emergence: Emergence,
    peaks_n: Vec<f64>,
    speeds_m_s: Vec<f64>,
    /// The current wave of tension of each line, and the finished ones.
    waves: Vec<WavesOfTension>,
    waves_n: Vec<[f64; 2]>,
}

impl<'a> OutcomeCounter<'a> {
    pub(super) fn new(prepared: &'a ModelAtRest) -> Self {
        let count = prepared.structure.lines.len();
        Self {
            prepared,
            lines: vec![LineOutcome::default(); count],
            slack: vec![0.0; count],
            turned_rad: 0.0,
            excursion_m: 0.0,
            waterline: Waterline::before(&prepared.structure),
            emergence: Emergence::default(),
            peaks_n: Vec::new(),
            speeds_m_s: Vec::new(),
            waves: WavesOfTension::of_lines(&prepared.rest),
            waves_n: Vec::new(),
        }
    }

    /// Takes in a step; returns the snaps at its end.
    pub(super) fn add_step(&mut self, simulation: &Simulation, step: &Step) -> Vec<Snap> {
        add_slack(&mut self.slack, step);
        self.turned_rad = simulation.theta_max();
        let state = simulation.state();
        let [x, z] = self.prepared.model.scales.to_si([state.x, state.y]);
        let excursion_m = (x - self.prepared.rest.place_m[0]).abs();
        self.excursion_m = self.excursion_m.max(excursion_m);
        let scales = &self.prepared.model.scales;
        let transient_s = self.prepared.structure.transient_s;
        let end_s = step.t_end * scales.time_s;
        let place = [z, state.theta];
        self.emergence.add(self.prepared, place, end_s);
        if let Some(seen) = &mut self.waterline {
            *seen = seen.with(&Waterline::at(&self.prepared.structure, place, None));
        }
        // Of a step in which judging begins, only the part from there on is judged.
        let length = step.t_end - step.t_start;
        let from = (transient_s / scales.time_s - step.t_start).clamp(0.0, length);
        if from > 0.0 {
            self.add_early(&simulation.tension_ranges_between(step, [0.0, from]));
        }
        let is_judged = end_s >= transient_s;
        let judged = is_judged.then(|| simulation.tension_ranges_between(step, [from, length]));
        if let Some(ranges) = &judged {
            self.add_judged(simulation, step, from, ranges);
        }
        let snaps = snaps_of_step(self.prepared, simulation, step);
        // A snap that is too slow to be counted loads its line, too.
        for snap in &snaps {
            let line = &mut self.lines[snap.line];
            if snap.t_s < transient_s {
                line.early_n = line.early_n.max(snap.peak_n.unwrap_or(0.0));
                continue;
            }
            if let Some(peak) = snap.peak_n {
                line.peak_n = Some(line.peak_n.unwrap_or(0.0).max(peak));
            }
            line.snaps_at_all |= !snap.is_impact_while_taut;
            match snap.counts() {
                true => self.count(snap),
                false => line.slower += 1,
            }
        }
        if let Some(ranges) = judged {
            let mut pulls_n = ranges.map(|[_, most]| most * scales.force_n);
            for snap in &snaps {
                pulls_n[snap.line] = pulls_n[snap.line].max(snap.peak_n.unwrap_or(0.0));
            }
            self.add_reliable(place, end_s, &pulls_n);
        }
        snaps
    }

    /// Takes in the range of each tension in time that is not judged.
    fn add_early(&mut self, ranges: &[[f64; 2]]) {
        let force_n = self.prepared.model.scales.force_n;
        for (line, [_, largest]) in self.lines.iter_mut().zip(ranges) {
            line.early_n = line.early_n.max(largest * force_n);
        }
    }

    /// Takes in the judged part of a step, which begins `from` after the step: the range of each
    /// tension, and the slack that is used up.
    fn add_judged(&mut self, simulation: &Simulation, step: &Step, from: f64, ranges: &[[f64; 2]]) {
        let quarter = 0.25 * (step.t_end - step.t_start - from);
        let along = || (0..=4).map(|k| simulation.within(step, from + f64::from(k) * quarter));
        let lines = self.lines.iter_mut().zip(&mut self.waves).enumerate();
        for ((index, (line, wave)), range) in lines.zip(ranges) {
            // A taut line can not push: a negative tension is rounding.
            let [least, largest] =
                range.map(|tension| tension.max(0.0) * self.prepared.model.scales.force_n);
            self.waves_n.extend(wave.add([least, largest]));
            line.largest_taut_n = line.largest_taut_n.max(largest);
            line.least_n = Some(line.least_n.map_or(least, |before| before.min(least)));
            if let Some(used) = self.prepared.slack_used(index, along()) {
                line.slack_used = Some(line.slack_used.map_or(used, |before| before.max(used)));
            }
        }
    }

    /// Takes in the tensions at a position in z and θ if linear hydrostatics hold there, which is
    /// asked only where a line pulls more than before.
    fn add_reliable(&mut self, place: [f64; 2], t_s: f64, pulls_n: &[f64]) {
        let mut lines = self.lines.iter().zip(pulls_n);
        let emerged = self.emergence.matters;
        if emerged || lines.all(|(line, pull)| *pull <= line.reliable_n) {
            return;
        }
        if let Some(seen) = &mut self.waterline {
            let now = Waterline::in_waves(self.prepared, place, t_s);
            *seen = seen.with(&now);
            if !now.allows_hydrostatics() {
                return;
            }
        }
        for (line, pull) in self.lines.iter_mut().zip(pulls_n) {
            line.reliable_n = line.reliable_n.max(*pull);
        }
    }

    /// Counts a judged snap.
    fn count(&mut self, snap: &Snap) {
        let line = &mut self.lines[snap.line];
        if snap.is_impact_while_taut {
            line.impacts_while_taut += 1;
        } else {
            line.snaps += 1;
            line.speed_m_s = line.speed_m_s.max(snap.speed_m_s);
            self.speeds_m_s.push(snap.speed_m_s);
            self.peaks_n.extend(snap.peak_n);
        }
        if let Some(peak) = snap.peak_n {
            self.waves_n.extend(self.waves[snap.line].add([peak; 2]));
        }
    }

    /// The outcome of a run that ended at a time, in the engine's units.
    pub(super) fn finish(mut self, end: f64, stop: Stop) -> Outcome {
        for (line, slack) in self.lines.iter_mut().zip(&self.slack) {
            line.slack_fraction = if end > 0.0 { slack / end } else { 0.0 };
        }
        let ModelAtRest {
            structure, model, ..
        } = self.prepared;
        Outcome {
            lines: self.lines,
            stop,
            // The duration as it was given, not converted back from the engine's units.
            end_s: match stop {
                Stop::EndTime => structure.duration_s,
                _ => end * model.scales.time_s,
            },
            turned_rad: self.turned_rad,
            excursion_m: self.excursion_m,
            waterline: self.waterline,
            emergence: self.emergence,
            peaks_n: self.peaks_n,
            speeds_m_s: self.speeds_m_s,
            waves_n: self.waves_n,
        }
    }
}

/// Adds a step to the time that each line is slack.
pub(super) fn add_slack(slack: &mut [f64], step: &Step) {
    for (line, slack) in slack.iter_mut().enumerate() {
        if !step.taut.contains(line) {
            *slack += step.t_end - step.t_start;
        }
    }
}
