//! Section 6.5: the three kinds of motion, and rocking. What is said of slides in many runs stands
//! in sections 6.5.1, of rocking in 6.5.2.2; its two examples have files of their own.

mod example;
mod slides;
mod weak;

use super::numbers::max;
use super::runs::{FEW, each, from_starts, near, past_settling, run, shapes_under, standard};
use super::verdict::{Claim, Finding, Judged, Judges, ask};
use crate::ReportError;
use crate::study::Study;
use example::{LOW, Rocking, example, rocks_on};
use slides::Slides;
use snapload::{ModeInterval, Parameters, Playback, Trajectory};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, ReportError> {
    // All shapes under 14 amplitudes, until t = 60.
    let forces: Vec<f64> = (1..=14).map(|k| f64::from(k) / 20.0).collect();
    let cases = shapes_under(study, &forces).into_iter().map(past_settling);
    let until = |case| Parameters {
        t_end: 60.0,
        ..case
    };
    let sweep = each(&cases.map(until).collect::<Vec<_>>(), run)?;
    let forced = past_settling(standard(|p| p.f_o = 0.4));
    let material = Material {
        study,
        slides: Slides::of(&sweep),
        sweep,
        forced: near(&forced, FEW, run)?,
        strong: example("sliding-example")?,
        weak: example("rocking-example")?,
    };
    ask(
        &[JUDGES, slides::JUDGES, example::JUDGES, weak::JUDGES],
        &material,
    )
}

/// The runs on which the claims rest.
struct Material<'a> {
    study: &'a Study,
    /// All shapes under 14 amplitudes.
    sweep: Vec<Trajectory>,
    slides: Slides,
    /// The standard case at f_o = 0.4 and its neighbours.
    forced: Vec<Trajectory>,
    /// The example of eq. 6.57, f_o = 0.27, and its neighbours.
    strong: Vec<Rocking>,
    /// The example of eq. 6.69, f_o = 0.1, and its neighbours.
    weak: Vec<Rocking>,
}

const JUDGES: &Judges<fn(&Material) -> Judged> = &[
    ("6.5-01", |of| {
        let kinds = ["slack", "sliding", "rocking"];
        let all = |run: &Trajectory| kinds.iter().all(|kind| count(run, &[kind]) > 0);
        let intervals = |run: &Trajectory| kinds.map(|kind| count(run, &[kind]) as f64);
        Ok(Finding::robust(&of.forced, all).by_start("intervals", of.forced.iter().map(intervals)))
    }),
    ("6.5-02", |of| {
        let kinds = ["slack", "sliding", "rocking", "sliding", "slack"];
        let chains = of.count(&kinds);
        let with = of.sweep.iter().filter(|run| count(run, &kinds) > 0).count();
        Ok(Finding::of(chains > 0).values("chains with runs", [chains, with, of.sweep.len()]))
    }),
    ("6.5-03", slack_is_taut),
    ("6.5.2.2-01", |of| {
        let counts: Vec<[usize; 2]> = of.forced.iter().map(climbs).collect();
        let words = counts.iter().map(|[all, up]| format!("{up} of {all}"));
        let in_sweep: Vec<[usize; 2]> = of.sweep.iter().map(climbs).collect();
        let [all, up] = [0, 1].map(|k| in_sweep.iter().map(|run| run[k]).sum());
        Ok(Finding::robust(&counts, |[_, up]| *up > 0)
            .value("by_start", words.collect::<Vec<_>>().join(", "))
            .values("up all runs", [up, all, of.sweep.len()]))
    }),
    ("6.5.2.2-02", |of| {
        let slack = of.count(&["rocking", "slack"]);
        let sliding = of.count(&["rocking", "sliding"]);
        let after = of.count(&["rocking", "sliding", "slack"]);
        Ok(Finding::of(slack > 0)
            .values("slack ends", [slack, slack + sliding])
            .values("after runs", [after, of.sweep.len()])
            .found("by_sliding", sliding > 0))
    }),
    ("6.5.2.2-12", |of| {
        let begins = of.rocking_begins();
        let [long, short] = [Begin::after_a_slide, Begin::after_a_short_slide]
            .map(|such| begins.iter().filter(|begin| such(begin)).count());
        Ok(Finding::of(long > 0)
            .values("long short all", [long, short, begins.len()])
            .values("runs", [of.sweep.len()])
            .value("shortest", SHORTEST))
    }),
    ("6.5.2.2-16", |of| {
        let begins = of.rocking_begins();
        let settling = begins.iter().filter(|begin| begin.settles()).count();
        Ok(Finding::of(2 * settling > begins.len())
            .values(
                "settling all runs",
                [settling, begins.len(), of.sweep.len()],
            )
            .values("low shortest", [LOW, SHORTEST]))
    }),
    ("6.5.2.2-13", |_| lasting()),
];

fn kind(mode: &ModeInterval) -> &'static str {
    mode.taut.mode().name()
}

/// How often some kinds of motion follow each other.
fn count(run: &Trajectory, kinds: &[&str]) -> usize {
    let same = |modes: &&[ModeInterval]| modes.iter().map(kind).eq(kinds.iter().copied());
    run.modes().windows(kinds.len()).filter(same).count()
}

impl Material<'_> {
    /// How often some kinds of motion follow each other over all shapes and amplitudes.
    fn count(&self, kinds: &[&str]) -> usize {
        self.sweep.iter().map(|run| count(run, kinds)).sum()
    }
}

fn slack_is_taut(of: &Material) -> Judged {
    let run = &of.study.sliding.run;
    let mut playback = Playback::new(run);
    let flights = run.modes().iter().filter(|mode| mode.taut.is_empty());
    let gaps = flights.map(|mode| {
        let state = playback.at(0.5 * (mode.t_start + mode.t_end)).state;
        max(run.system().cables.iter().map(|cable| cable.gap(&state)))
    });
    let gaps: Vec<f64> = gaps.collect();
    let nearest = max(gaps.iter().copied());
    Ok(Finding::of(!gaps.is_empty() && nearest >= 0.0)
        .value("intervals", gaps.len())
        .value("nearest", nearest)
        .found("slack", nearest < 0.0))
}

/// A slide shorter than this moves nothing that one could see.
const SHORTEST: f64 = 1e-3;

/// How a rocking begins.
#[derive(Clone, Copy, Debug)]
struct Begin {
    /// How long the body slid just before; 0 if it did not.
    slid: f64,
    /// Where its centre is.
    y: f64,
}

impl Begin {
    fn after_a_slide(&self) -> bool {
        self.slid >= SHORTEST
    }

    fn after_a_short_slide(&self) -> bool {
        self.slid > 0.0 && self.slid < SHORTEST
    }

    /// Low, and out of bouncing.
    fn settles(&self) -> bool {
        self.slid < SHORTEST && self.y < LOW
    }
}

impl Material<'_> {
    /// How the rocking of all shapes and amplitudes begins, each time.
    fn rocking_begins(&self) -> Vec<Begin> {
        let of_run = |run: &Trajectory| {
            let mut playback = Playback::new(run);
            let pairs = run
                .modes()
                .windows(2)
                .filter(|pair| kind(&pair[1]) == "rocking");
            let begins = pairs.map(|pair| Begin {
                slid: match kind(&pair[0]) {
                    "sliding" => pair[0].t_end - pair[0].t_start,
                    _ => 0.0,
                },
                y: playback.at(pair[1].t_start).state.y,
            });
            begins.collect::<Vec<_>>()
        };
        self.sweep.iter().flat_map(of_run).collect()
    }
}

/// How often a run rocks and then slides, and how often it climbs in that slide.
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

fn lasting() -> Judged {
    let forces = (1..=50).map(|k| f64::from(k) / 100.0);
    let cases: Vec<_> = forces
        .map(|f_o| past_settling(standard(|p| p.f_o = f_o)))
        .collect();
    let on = from_starts(&cases, FEW, |case| Ok(rocks_on(&run(case)?)))?;
    let counts = |on: &Vec<bool>| {
        let (low, high) = on.split_at(on.len() / 2);
        [low, high].map(|part| part.iter().filter(|on| **on).count())
    };
    let counts: Vec<[usize; 2]> = on.iter().map(counts).collect();
    Ok(Finding::robust(&counts, |[low, high]| low > high).values("low high", counts[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slide_of_no_length_is_none() {
        let begin = |slid, y| Begin { slid, y };
        assert!(begin(0.01, 0.02).after_a_slide() && !begin(0.01, 0.02).settles());
        assert!(!begin(1e-4, 0.02).after_a_slide() && begin(1e-4, 0.02).settles());
        assert!(!begin(0.0, 0.2).settles() && !begin(0.0, 0.02).after_a_short_slide());
    }
}
