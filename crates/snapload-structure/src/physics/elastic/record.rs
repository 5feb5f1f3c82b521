//! The record of a motion on elastic lines.

use super::body::BodyOnElasticLines;
use crate::options::sampling;
use crate::physics::emergence::Emergence;
use crate::physics::model::Scales;
use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::snap::number_of_line;
use crate::physics::waterline::Waterline;
use crate::physics::waves_of_tension::WavesOfTension;
use crate::structure::Structure;
use serde::Serialize;
use snapload::{CaseError, MAX_CABLES, Sampling, State, Stop, TautSet};
use std::iter::Peekable;

/// A time interval in which a line pulls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pull {
    /// The line, by index from 0.
    #[serde(serialize_with = "number_of_line")]
    pub line: usize,
    /// When it began to pull \[s\].
    pub from_s: f64,
    /// When it ceased to pull, or the run ended \[s\].
    pub to_s: f64,
    /// The rate of its elongation when it became taut \[m/s\].
    pub speed_m_s: f64,
    /// The rate of its contraction when it ceased to pull; none if it pulls to the end \[m/s\].
    pub rebound_m_s: Option<f64>,
    /// The largest tension \[N\].
    pub peak_n: f64,
    /// When \[s\].
    pub peak_s: f64,
}

/// State and tensions at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The time \[s\].
    pub t_s: f64,
    /// The state, in the engine's units.
    pub state: State,
    /// Tension of each line \[N\].
    pub tension_n: Vec<f64>,
}

/// A motion on elastic lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElasticRun {
    /// Every pull, in the order of their beginnings.
    pub pulls: Vec<Pull>,
    /// The motion at the requested times.
    pub samples: Vec<Sample>,
    /// When it ended \[s\].
    pub end_s: f64,
    /// The state then, in the engine's units.
    pub end: State,
    /// What ended it early, if anything.
    pub stop: Option<Stop>,
    /// The largest rotation in either direction \[rad\].
    pub turned_rad: f64,
    /// The largest horizontal distance from the position of rest on these lines \[m\].
    pub excursion_m: f64,
    /// The extreme positions of a floating body relative to the still water.
    pub waterline: Option<Waterline>,
    /// How far a submerged body comes out of the water.
    pub emergence: Emergence,
    /// The largest tension of each line after the transient \[N\].
    pub peaks_n: Vec<f64>,
    /// The same while linear hydrostatics hold \[N\].
    pub reliable_peaks_n: Vec<f64>,
    /// The smallest, 0 if it goes slack; none if the run ends before the transient is over \[N\].
    pub least_n: Vec<Option<f64>>,
    /// The largest part of its slack at rest that each line uses up after the transient, 1 if it
    /// becomes taut; none for a line with tension at rest.
    pub slack_used: Vec<Option<f64>>,
    /// Crest and trough of every wave of tension of every line after the transient \[N\].
    pub waves_n: Vec<[f64; 2]>,
    /// (x, y, θ) at [`MARKS`] equal parts of the duration, up to its end, in the engine's units: by
    /// these the same motion in other steps is compared.
    marks: Vec<[f64; 3]>,
}

/// The number of instants at which two integrations of a motion are compared.
const MARKS: u32 = 4096;

impl ElasticRun {
    /// The part of the time in which a line does not pull.
    pub fn slack_fraction(&self, line: usize) -> f64 {
        let pulls = self.pulls.iter().filter(|pull| pull.line == line);
        1.0 - pulls.map(|pull| pull.to_s - pull.from_s).sum::<f64>() / self.end_s
    }

    /// The time up to which another integration of the same motion differs by at most `tolerance`
    /// in each of x, y and θ, in the engine's units; none if it does so to the end \[s\].
    pub(crate) fn agrees_until(
        &self,
        other: &Self,
        tolerance: f64,
        duration_s: f64,
    ) -> Option<f64> {
        let close = |(a, b): &(&[f64; 3], &[f64; 3])| {
            a.iter().zip(*b).all(|(a, b)| (a - b).abs() <= tolerance)
        };
        let both = || self.marks.iter().zip(&other.marks);
        let alike = both().take_while(close).count();
        let ends = [self, other].map(|run| [run.end.x, run.end.y, run.end.theta]);
        let to_the_end =
            alike == both().count() && self.stop == other.stop && close(&(&ends[0], &ends[1]));
        // Before the first mark nothing is compared.
        let until_s = duration_s * alike as f64 / f64::from(MARKS);
        (!to_the_end).then(|| until_s.min(self.end_s).min(other.end_s))
    }
}

/// Records a motion.
pub(super) struct PullRecorder<'a> {
    scales: &'a Scales,
    structure: &'a Structure,
    /// The structure about its position of rest on these lines.
    prepared: &'a ModelAtRest,
    body: &'a BodyOnElasticLines<'a>,
    /// The times of the samples that are still to come, before the end \[s\].
    samples: Peekable<Box<dyn Iterator<Item = f64>>>,
    kept: bool,
    /// When judging begins, in seconds and in the engine's units.
    transient_s: f64,
    transient: f64,
    /// Whether the instant at which it begins is still to be recorded.
    to_be_judged: bool,
    run: ElasticRun,
    /// The duration, in the engine's units.
    duration: f64,
    /// The current wave of tension of each line.
    waves: Vec<WavesOfTension>,
    /// The current pull of each line, by its index among the pulls.
    open: Vec<Option<usize>>,
}

impl<'a> PullRecorder<'a> {
    /// Of a run whose state is kept at every multiple of `every_s` and at its end,
    /// or nowhere if that is infinite.
    ///
    /// # Errors
    /// A [`CaseError`] if that is no time, or gives too many samples.
    pub(super) fn new(
        prepared: &'a ModelAtRest,
        body: &'a BodyOnElasticLines<'a>,
        every_s: f64,
    ) -> Result<Self, CaseError> {
        let scales = &prepared.model.scales;
        let end_s = prepared.structure.duration_s;
        let kept = sampling(end_s, every_s)?;
        let times = kept.into_iter().flat_map(Sampling::times);
        let samples: Box<dyn Iterator<Item = f64>> =
            Box::new(times.take_while(move |t| *t < end_s));
        Ok(Self {
            scales,
            structure: &prepared.structure,
            prepared,
            body,
            samples: samples.peekable(),
            kept: kept.is_some(),
            transient_s: prepared.structure.transient_s,
            transient: prepared.structure.transient_s / scales.time_s,
            to_be_judged: true,
            duration: prepared.model.rules.t_end,
            run: ElasticRun {
                waterline: Waterline::before(&prepared.structure),
                peaks_n: vec![0.0; body.elastic_lines.len()],
                reliable_peaks_n: vec![0.0; body.elastic_lines.len()],
                least_n: vec![None; body.elastic_lines.len()],
                slack_used: vec![None; body.elastic_lines.len()],
                ..ElasticRun::default()
            },
            waves: WavesOfTension::of_lines(&prepared.rest),
            open: vec![None; body.elastic_lines.len()],
        })
    }

    /// The structure about its position of rest on these lines.
    pub(super) fn prepared(&self) -> &'a ModelAtRest {
        self.prepared
    }

    /// The next instant up to a time at which motions are compared, in the engine's units.
    pub(super) fn next_mark(&self, until: f64) -> Option<f64> {
        let t = self.duration * (self.run.marks.len() + 1) as f64 / f64::from(MARKS);
        (t <= until).then_some(t)
    }

    /// The instant at which judging begins, if it is up to a time and was not asked for.
    pub(super) fn next_beginning(&mut self, until: f64) -> Option<f64> {
        let begins = self.to_be_judged && self.transient <= until;
        self.to_be_judged &= !begins;
        begins.then_some(self.transient)
    }

    /// Keeps the position there.
    pub(super) fn mark(&mut self, state: &State) {
        self.run.marks.push([state.x, state.y, state.theta]);
    }

    /// The next sample that is to be kept up to a time, in seconds and in the engine's units.
    pub(super) fn next_sample(&mut self, until: f64) -> Option<(f64, f64)> {
        let time_s = self.scales.time_s;
        let t_s = self.samples.next_if(|t_s| t_s / time_s <= until)?;
        Some((t_s, t_s / time_s))
    }

    /// Keeps the state at a sample.
    pub(super) fn keep(&mut self, t_s: f64, state: &State, pulling: TautSet) {
        let tension = |line| match pulling.contains(line) {
            true => self.tension_n(line, state),
            false => 0.0,
        };
        let tension_n = (0..self.open.len()).map(tension).collect();
        self.run.samples.push(Sample {
            t_s,
            state: *state,
            tension_n,
        });
    }

    /// The tension of a line that pulls \[N\].
    fn tension_n(&self, line: usize, state: &State) -> f64 {
        self.scales.force_n * self.body.elongation(line, state).force.max(0.0)
    }

    /// Records a state along the motion.
    pub(super) fn add(&mut self, t: f64, state: &State, pulling: TautSet) {
        let t_s = match t == self.transient {
            // As it was given, not converted back from the engine's units.
            true => self.transient_s,
            false => t * self.scales.time_s,
        };
        self.run.turned_rad = self.run.turned_rad.max(state.theta.abs());
        let [x, z] = self.scales.to_si([state.x, state.y]);
        self.run.excursion_m = self
            .run
            .excursion_m
            .max((x - self.prepared.rest.place_m[0]).abs());
        let is_judged = t_s >= self.transient_s;
        let place = [z, state.theta];
        self.run.emergence.add(self.prepared, place, t_s);
        if let Some(seen) = &mut self.run.waterline {
            *seen = seen.with(&Waterline::at(self.structure, place, None));
        }
        let mut tensions = [0.0; MAX_CABLES];
        for line in pulling.iter() {
            tensions[line] = self.tension_n(line, state);
        }
        let tensions = &tensions[..self.open.len()];
        if is_judged {
            for (line, &tension) in tensions.iter().enumerate() {
                let (peak, least) = (&mut self.run.peaks_n[line], &mut self.run.least_n[line]);
                *peak = peak.max(tension);
                *least = Some(least.map_or(tension, |least| least.min(tension)));
                if let Some(used) = self.prepared.slack_used(line, [*state]) {
                    let most = &mut self.run.slack_used[line];
                    *most = Some(most.map_or(used, |before| before.max(used)));
                }
                self.run.waves_n.extend(self.waves[line].add([tension; 2]));
            }
            self.add_reliable(place, t_s, tensions);
        }
        for (line, &tension) in tensions.iter().enumerate() {
            if let Some(pull) = self.open[line].map(|place| &mut self.run.pulls[place])
                && tension > pull.peak_n
            {
                (pull.peak_n, pull.peak_s) = (tension, t_s);
            }
        }
    }

    /// Takes in the tensions at a position in z and θ if linear hydrostatics hold there, which is
    /// asked only where a line pulls more than before.
    fn add_reliable(&mut self, place: [f64; 2], t_s: f64, tensions_n: &[f64]) {
        let reliable = &mut self.run.reliable_peaks_n;
        let mut peaks = reliable.iter().zip(tensions_n);
        if self.run.emergence.matters || peaks.all(|(peak, pull)| pull <= peak) {
            return;
        }
        if let Some(seen) = &mut self.run.waterline {
            let now = Waterline::in_waves(self.prepared, place, t_s);
            *seen = seen.with(&now);
            if !now.allows_hydrostatics() {
                return;
            }
        }
        for (peak, pull) in reliable.iter_mut().zip(tensions_n) {
            *peak = peak.max(*pull);
        }
    }

    /// Records that lines begin or cease to pull, and the tensions then: that of a strong damper is
    /// the largest of its pull at the first instant.
    pub(super) fn change(&mut self, t: f64, state: &State, before: TautSet, after: TautSet) {
        let t_s = t * self.scales.time_s;
        for line in 0..self.open.len() {
            let speed = self.body.elongation(line, state).rate * self.scales.speed_m_s();
            match (before.contains(line), after.contains(line)) {
                (false, true) => {
                    self.open[line] = Some(self.run.pulls.len());
                    self.run.pulls.push(Pull {
                        line,
                        from_s: t_s,
                        to_s: t_s,
                        speed_m_s: speed,
                        rebound_m_s: None,
                        peak_n: 0.0,
                        peak_s: t_s,
                    });
                }
                (true, false) => {
                    if let Some(place) = self.open[line].take() {
                        let pull = &mut self.run.pulls[place];
                        (pull.to_s, pull.rebound_m_s) = (t_s, Some(-speed));
                    }
                }
                _ => {}
            }
        }
        self.add(t, state, after);
    }

    /// Ends the record; what pulls then pulls to the end.
    pub(super) fn finish(
        mut self,
        t: f64,
        state: State,
        pulling: TautSet,
        stop: Option<Stop>,
    ) -> ElasticRun {
        self.run.stop = stop;
        self.run.end_s = match stop {
            // The requested duration, not converted back from the engine's units.
            None => self.structure.duration_s,
            Some(_) => t * self.scales.time_s,
        };
        if self.kept {
            self.keep(self.run.end_s, &state, pulling);
        }
        self.run.end = state;
        for place in self.open.into_iter().flatten() {
            self.run.pulls[place].to_s = self.run.end_s;
        }
        self.run
    }
}
