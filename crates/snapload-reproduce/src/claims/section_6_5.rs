//! Section 6.5: the three kinds of motion, and rocking. The claims on slides in many runs are in
//! section 6.5.1, those on rocking in 6.5.2.2; the two examples have files of their own.

mod example;
mod slides;
mod weak;

use super::numbers::{max, min, span};
use super::runs::{FEW, from_starts, near, past_settling, run, shapes_under, standard};
use super::verdict::{Checked, Checks, Claim, Finding, run_checks};
use crate::ReportError;
use crate::study::Study;
use example::{LOW, Rocking, example, leaves_rocking, rocks_on};
use slides::Slides;
use snapload::{CaseError, ModeInterval, Parameters, Playback, Trajectory};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    let cases = shapes_under(study, &forces())
        .into_iter()
        .map(past_settling);
    let until = |case| Parameters {
        t_end: UNTIL,
        ..case
    };
    let sweeps = from_starts(&cases.map(until).collect::<Vec<_>>(), FEW, run)?;
    let forced = past_settling(standard(|p| p.f_o = 0.4));
    let material = Material {
        study,
        slides: sweeps.iter().map(|runs| Slides::of(runs)).collect(),
        sweeps,
        forced: near(&forced, FEW, run)?,
        strong: example("sliding-example")?,
        weak: example("rocking-example")?,
    };
    run_checks(
        &[CHECKS, slides::CHECKS, example::CHECKS, weak::CHECKS],
        &material,
    )
}

/// The amplitudes under which all shapes are run, and the end of these runs.
fn forces() -> Vec<f64> {
    (1..=14).map(|k| f64::from(k) / 20.0).collect()
}
const UNTIL: f64 = 60.0;

/// The runs on which the claims rest.
struct Material<'a> {
    study: &'a Study,
    /// All shapes under these amplitudes, `[start][case]`.
    sweeps: Vec<Vec<Trajectory>>,
    /// The counts of slides in them, by start.
    slides: Vec<Slides>,
    /// The standard case at f_o = 0.4 and its neighbours.
    forced: Vec<Trajectory>,
    /// The example of eq. 6.57, f_o = 0.27, and its neighbours.
    strong: Vec<Rocking>,
    /// The example of eq. 6.69, f_o = 0.1, and its neighbours.
    weak: Vec<Rocking>,
}

const CHECKS: &Checks<fn(&Material) -> Checked> = &[
    ("6.5-01", |of| {
        let kinds = ["slack", "sliding", "rocking"];
        let all = |run: &Trajectory| kinds.iter().all(|kind| count(run, &[kind]) > 0);
        let intervals = |run: &Trajectory| kinds.map(|kind| count(run, &[kind]) as f64);
        Ok(Finding::robust(&of.forced, all).by_start("intervals", of.forced.iter().map(intervals)))
    }),
    ("6.5-02", |of| {
        let kinds = ["slack", "sliding", "rocking", "sliding", "slack"];
        let chains = of.count(&kinds);
        let with =
            |runs: &Vec<Trajectory>| runs.iter().filter(|run| count(run, &kinds) > 0).count();
        let found = Finding::robust(&chains, |chains| *chains > 0.0);
        Ok(of
            .with_counts(found)
            .list("chains", chains)
            .list("with", of.sweeps.iter().map(|runs| with(runs) as f64)))
    }),
    ("6.5-03", slack_is_taut),
    ("6.5.2.2-01", |of| {
        let counts: Vec<[usize; 2]> = of.forced.iter().map(climbs).collect();
        let words = counts.iter().map(|[all, up]| format!("{up} of {all}"));
        let total = |which: usize| {
            let of_runs =
                move |runs: &Vec<Trajectory>| runs.iter().map(|run| climbs(run)[which]).sum();
            of.sweeps
                .iter()
                .map(of_runs)
                .map(|count: usize| count as f64)
        };
        let found = Finding::robust(&counts, |[_, up]| *up > 0);
        Ok(of
            .with_counts(found)
            .value("by_start", words.collect::<Vec<_>>().join(", "))
            .list("all", total(0))
            .list("up", total(1)))
    }),
    ("6.5.2.2-02", |of| {
        let slack = of.count(&["rocking", "slack"]);
        let sliding = of.count(&["rocking", "sliding"]);
        let found = Finding::robust(&slack, |slack| *slack > 0.0);
        Ok(of
            .with_counts(found)
            .list("ends", slack.iter().zip(&sliding).map(|(p, q)| p + q))
            .list("after", of.count(&["rocking", "sliding", "slack"]))
            .condition("by_sliding", min(sliding.iter().copied()) > 0.0)
            .list("slack", slack))
    }),
    ("6.5.2.2-12", |of| {
        let starts = of.rocking_starts();
        Ok(of
            .with_counts(Finding::robust(&starts, |of| of.long > 0))
            .list("long", starts.iter().map(|of| of.long as f64))
            .list("short", starts.iter().map(|of| of.short as f64))
            .list("all", starts.iter().map(|of| of.all as f64))
            .value("shortest", SHORTEST))
    }),
    ("6.5.2.2-16", |of| {
        let starts = of.rocking_starts();
        Ok(of
            .with_counts(Finding::robust(&starts, RockingStarts::usually_settle))
            .list("settling", starts.iter().map(|of| of.settling as f64))
            .list("all", starts.iter().map(|of| of.all as f64))
            .values("low shortest", [LOW, SHORTEST]))
    }),
    ("6.5.2.2-17", |of| {
        let starts = of.rocking_starts();
        Ok(of
            .with_counts(Finding::robust(&starts, RockingStarts::in_two_ways))
            .list("neither", starts.iter().map(|of| of.neither() as f64))
            .list("all", starts.iter().map(|of| of.all as f64))
            .values("low shortest", [LOW, SHORTEST])
            .value("few", 100.0 * FEW_OTHERS))
    }),
    ("6.5.2.2-13", |_| lasting()),
    ("6.5.2.2-18", |_| ellipse_frees()),
];

fn kind(mode: &ModeInterval) -> &'static str {
    mode.taut.mode().name()
}

/// How often a sequence of kinds of motion occurs.
fn count(run: &Trajectory, kinds: &[&str]) -> usize {
    let same = |modes: &&[ModeInterval]| modes.iter().map(kind).eq(kinds.iter().copied());
    run.modes().windows(kinds.len()).filter(same).count()
}

impl Material<'_> {
    /// How often a sequence of kinds of motion occurs over all shapes and amplitudes, by start.
    fn count(&self, kinds: &[&str]) -> Vec<f64> {
        let of_runs = |runs: &Vec<Trajectory>| runs.iter().map(|run| count(run, kinds)).sum();
        let counts = self.sweeps.iter().map(of_runs);
        counts.map(|count: usize| count as f64).collect()
    }

    /// Adds the numbers of starts and runs to the finding.
    fn with_counts(&self, finding: Finding) -> Finding {
        let (starts, runs) = (self.sweeps.len(), self.sweeps.first().map_or(0, Vec::len));
        let forces = span(forces(), 2);
        let words = format!(
            "{runs} runs, of the shapes of Table 6.2 under f_o = {forces} in steps of 0.05 until t = {UNTIL}, the \
             settling rule off, from each of {starts} starts"
        );
        finding.value("runs", words)
    }
}

fn slack_is_taut(of: &Material) -> Checked {
    let gaps_of = |run: &Trajectory| -> Vec<f64> {
        let mut playback = Playback::new(run);
        let flights = run.modes().iter().filter(|mode| mode.taut.is_empty());
        let gaps = flights.map(|mode| {
            let state = playback.at(0.5 * (mode.t_start + mode.t_end)).state;
            max(run.system().cables.iter().map(|cable| cable.gap(&state)))
        });
        gaps.collect()
    };
    let members: Vec<Vec<f64>> = of.strong.iter().map(|of| gaps_of(&of.run)).collect();
    let nearest = max(members.iter().flatten().copied());
    let taut = |gaps: &Vec<f64>| !gaps.is_empty() && max(gaps.iter().copied()) >= 0.0;
    Ok(Finding::robust(&members, taut)
        .list("intervals", members.iter().map(|gaps| gaps.len() as f64))
        .value("nearest", nearest)
        .condition("slack", nearest < 0.0))
}

/// A shorter slide moves the body by nothing visible.
const SHORTEST: f64 = 1e-3;

/// The largest part that counts as few.
const FEW_OTHERS: f64 = 0.2;

/// The beginning of a rocking motion.
#[derive(Clone, Copy, Debug)]
struct RockingStart {
    /// How long the body slid just before; 0 if it did not.
    slid: f64,
    /// The height of its centre.
    y: f64,
}

/// The counts of the ways in which the rocking of many runs begins.
#[derive(Clone, Copy, Debug, Default)]
struct RockingStarts {
    all: usize,
    /// After a slide, and after a slide too short to be visible.
    long: usize,
    short: usize,
    /// At a small height, and after bouncing.
    settling: usize,
}

impl RockingStarts {
    fn of(starts: impl Iterator<Item = RockingStart>) -> Self {
        starts.fold(Self::default(), |of, RockingStart { slid, y }| Self {
            all: of.all + 1,
            long: of.long + usize::from(slid >= SHORTEST),
            short: of.short + usize::from(slid > 0.0 && slid < SHORTEST),
            settling: of.settling + usize::from(slid < SHORTEST && y < LOW),
        })
    }

    fn usually_settle(&self) -> bool {
        2 * self.settling > self.all
    }

    /// Neither after a slide nor as the body settles.
    fn neither(&self) -> usize {
        self.all - self.long - self.settling
    }

    /// Whether both ways occur, and few rockings begin otherwise.
    fn in_two_ways(&self) -> bool {
        let few = self.neither() as f64 <= FEW_OTHERS * self.all as f64;
        self.long > 0 && self.settling > 0 && few
    }
}

impl Material<'_> {
    /// The ways in which each rocking of all shapes and amplitudes begins, by start.
    fn rocking_starts(&self) -> Vec<RockingStarts> {
        let of_run = |run: &Trajectory| {
            let mut playback = Playback::new(run);
            let pairs = run
                .modes()
                .windows(2)
                .filter(|pair| kind(&pair[1]) == "rocking");
            let starts = pairs.map(|pair| RockingStart {
                slid: match kind(&pair[0]) {
                    "sliding" => pair[0].t_end - pair[0].t_start,
                    _ => 0.0,
                },
                y: playback.at(pair[1].t_start).state.y,
            });
            starts.collect::<Vec<_>>()
        };
        let sweeps = self.sweeps.iter();
        sweeps
            .map(|runs| RockingStarts::of(runs.iter().flat_map(of_run)))
            .collect()
    }
}

/// How often a run rocks and then slides, and how often it rises in that slide.
fn climbs(run: &Trajectory) -> [usize; 2] {
    let mut playback = Playback::new(run);
    let mut y = |t: f64| playback.at(t).state.y;
    let pairs = run.modes().windows(2);
    let slides = pairs.filter(|pair| kind(&pair[0]) == "rocking" && kind(&pair[1]) == "sliding");
    let up = slides.map(|pair| {
        let mode = pair[1];
        // The end of an interval is the start of the next motion.
        let end = mode.t_end - 1e-3 * (mode.t_end - mode.t_start);
        y(end) > y(mode.t_start)
    });
    up.fold([0, 0], |[all, climbing], up| {
        [all + 1, climbing + usize::from(up)]
    })
}

/// The standard case, continued after it has settled, under each amplitude up to a half, with the
/// forcing on an ellipse or along a line.
fn up_to_a_half(nu: f64) -> Vec<Parameters> {
    let forces = (1..=50).map(|k| f64::from(k) / 100.0);
    let cases = forces.map(|f_o| past_settling(standard(|p| (p.f_o, p.nu) = (f_o, nu))));
    cases.collect()
}

fn lasting() -> Checked {
    let cases = up_to_a_half(Parameters::STANDARD.nu);
    let on = from_starts(&cases, FEW, |case| Ok(rocks_on(&run(case)?)))?;
    let counts = |on: &Vec<bool>| {
        let (low, high) = on.split_at(on.len() / 2);
        [low, high].map(|part| part.iter().filter(|on| **on).count())
    };
    let counts: Vec<[usize; 2]> = on.iter().map(counts).collect();
    let of = |half: usize| counts.iter().map(move |counts| counts[half] as f64);
    Ok(Finding::robust(&counts, |[low, high]| low > high)
        .list("low", of(0))
        .list("high", of(1)))
}

/// Whether a body leaves rocking under more amplitudes if the force is on an ellipse.
fn ellipse_frees() -> Checked {
    let freed = |nu: f64| {
        let found = from_starts(&up_to_a_half(nu), FEW, |case| {
            Ok(leaves_rocking(&run(case)?))
        })?;
        let count = |freed: &Vec<bool>| freed.iter().filter(|freed| **freed).count();
        Ok::<Vec<usize>, CaseError>(found.iter().map(count).collect())
    };
    let (ellipse, line) = (freed(Parameters::STANDARD.nu)?, freed(0.0)?);
    let members: Vec<[usize; 2]> = ellipse.iter().zip(&line).map(|(p, q)| [*p, *q]).collect();
    Ok(Finding::robust(&members, |[ellipse, line]| ellipse > line)
        .list("ellipse", ellipse.iter().map(|count| *count as f64))
        .list("line", line.iter().map(|count| *count as f64)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slide_of_no_length_is_none() {
        let start = |slid, y| RockingStart { slid, y };
        let of = |starts: &[RockingStart]| RockingStarts::of(starts.iter().copied());
        let [slid, settled, high] = [start(0.01, 0.02), start(1e-4, 0.02), start(0.0, 0.2)];
        let all = of(&[slid, settled, high]);
        assert_eq!(
            (all.long, all.short, all.settling, all.neither()),
            (1, 1, 1, 1)
        );
        // As many settle as not; one of three begins in neither way.
        assert!(of(&[slid, settled, settled]).usually_settle() && !all.usually_settle());
        assert!(of(&[slid, settled]).in_two_ways() && !all.in_two_ways());
        assert!(!of(&[settled, settled]).in_two_ways());
    }
}
