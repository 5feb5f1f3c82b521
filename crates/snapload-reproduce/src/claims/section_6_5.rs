//! Section 6.5: the three kinds of motion, and rocking.

mod example;
mod slides;
mod weak;

use super::numbers::range;
use super::runs::{FEW, ensemble, run_all};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::{CriticalRow, Study};
use example::{example, rocks_on};
use snapload::{CaseError, ModeInterval, Parameters, Playback, State, Trajectory};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let sweep = shapes(study)?;
    let mut all = of_kinds(study, &sweep)?;
    let (strong, weak) = (example("sliding-example")?, example("rocking-example")?);
    all.extend(example::claims(&strong, &weak));
    all.extend(weak::claims(&weak));
    all.extend(slides::claims(&sweep));
    all.push(claim(
        "6.5.2.2-12",
        "Rocking may begin as a sliding body hits the other boundary.",
        begins_from_sliding(&sweep),
    ));
    all.push(claim(
        "6.5.2.2-13",
        "The weaker the force, the more surely a body goes on rocking.",
        lasting()?,
    ));
    Ok(all)
}

/// The parameters of a run that goes on after it has settled.
fn going_on(f_o: f64) -> Parameters {
    Parameters {
        f_o,
        stop_when_settled: false,
        ..Parameters::STANDARD
    }
}

/// The shapes of Table 6.2 under 14 amplitudes, until t = 60.
fn shapes(study: &Study) -> Result<Vec<Trajectory>, CaseError> {
    let of_shape = |row: &CriticalRow| {
        let case = row.parameters();
        (1..=14).map(move |k| Parameters {
            f_o: f64::from(k) / 20.0,
            stop_when_settled: false,
            t_end: 60.0,
            ..case
        })
    };
    let cases: Vec<Parameters> = study.critical.iter().flat_map(of_shape).collect();
    run_all(&cases)
}

fn kind(mode: &ModeInterval) -> &'static str {
    mode.taut.mode().name()
}

/// How often some kinds of motion follow each other.
fn count(run: &Trajectory, kinds: &[&str]) -> usize {
    let same = |modes: &[ModeInterval]| modes.iter().map(kind).eq(kinds.iter().copied());
    run.modes()
        .windows(kinds.len())
        .filter(|modes| same(modes))
        .count()
}

fn count_all(runs: &[Trajectory], kinds: &[&str]) -> usize {
    runs.iter().map(|run| count(run, kinds)).sum()
}

fn of_kinds(study: &Study, sweep: &[Trajectory]) -> Result<Vec<Claim>, CaseError> {
    let strong = run_all(&ensemble(&going_on(0.4), FEW))?;
    Ok(vec![
        claim(
            "6.5-01",
            "The body knows three kinds of motion: slack, sliding, rocking.",
            three_kinds(&strong),
        ),
        claim(
            "6.5-02",
            "One run may go from slack through sliding into rocking, and back through sliding.",
            chain(sweep),
        ),
        claim(
            "6.5-03",
            "Slack motion is described as one with both cables taut.",
            slack_is_taut(&study.sliding),
        ),
        claim(
            "6.5.2.2-01",
            "Rocking may end with the body climbing one boundary, sliding.",
            ends_in_sliding(&strong, sweep),
        ),
        claim(
            "6.5.2.2-02",
            "Rocking may end in slack motion at once.",
            ends_in_slack(sweep),
        ),
    ])
}

fn three_kinds(runs: &[Trajectory]) -> Finding {
    let kinds = ["slack", "sliding", "rocking"];
    let holds = |run: &Trajectory| kinds.iter().all(|kind| count(run, &[kind]) > 0);
    let own = runs.first();
    let texts = kinds.map(|kind| {
        let times = own.map_or(0, |run| count(run, &[kind]));
        format!("{times} intervals {kind}")
    });
    Finding::new(
        Verdict::robust(runs.iter().map(holds)),
        format!("f_o = 0.4: {}", texts.join(", ")),
    )
}

fn chain(sweep: &[Trajectory]) -> Finding {
    let kinds = ["slack", "sliding", "rocking", "sliding", "slack"];
    let chains = count_all(sweep, &kinds);
    let with = sweep.iter().filter(|run| count(run, &kinds) > 0).count();
    let evidence = format!("{chains} such chains in {with} of {} runs", sweep.len());
    Finding::new(Verdict::of(chains > 0), evidence)
}

fn slack_is_taut(run: &Trajectory) -> Finding {
    let mut playback = Playback::new(run);
    let flights = run.modes().iter().filter(|mode| mode.taut.is_empty());
    let middle = |mode: &ModeInterval| playback.at(0.5 * (mode.t_start + mode.t_end)).state;
    let states: Vec<State> = flights.map(middle).collect();
    let gaps = states
        .iter()
        .flat_map(|state| run.system().cables.iter().map(|cable| cable.gap(state)));
    let (_, nearest) = range(gaps);
    let number = states.len();
    Finding::new(
        Verdict::of(number > 0 && nearest >= 0.0),
        format!("in the middle of {number} slack intervals the gaps are {nearest:.1e} at most"),
    )
    .because(
        Verdict::NotReproduced,
        nearest < 0.0,
        "A slip of words: in slack motion neither cable is taut.",
    )
}

/// How often a run rocks and then slides, and how often it climbs in that slide.
fn climbs(run: &Trajectory) -> (usize, usize) {
    let mut playback = Playback::new(run);
    let mut y = |t: f64| playback.at(t).state.y;
    let pairs = run.modes().windows(2).filter_map(|pair| match pair {
        [mode, next] if kind(mode) == "rocking" && kind(next) == "sliding" => Some(next),
        _ => None,
    });
    let up = |mode: &ModeInterval| {
        // The end of an interval is the start of the next motion.
        let end = mode.t_end - 1e-3 * (mode.t_end - mode.t_start);
        y(end) > y(mode.t_start)
    };
    let up: Vec<bool> = pairs.map(up).collect();
    (up.len(), up.iter().filter(|up| **up).count())
}

fn ends_in_sliding(strong: &[Trajectory], sweep: &[Trajectory]) -> Finding {
    let counts: Vec<(usize, usize)> = strong.iter().map(climbs).collect();
    let texts: Vec<String> = counts
        .iter()
        .map(|(all, up)| format!("{up} of {all}"))
        .collect();
    let all = sweep.iter().map(climbs);
    let (all, up) = all.fold((0, 0), |sum, run| (sum.0 + run.0, sum.1 + run.1));
    Finding::new(
        Verdict::robust(counts.iter().map(|(_, up)| *up > 0)),
        format!(
            "at f_o = 0.4 {} slides out of rocking climb, by start; {up} of {all} in {} runs",
            texts.join(", "),
            sweep.len()
        ),
    )
}

fn ends_in_slack(sweep: &[Trajectory]) -> Finding {
    let slack = count_all(sweep, &["rocking", "slack"]);
    let sliding = count_all(sweep, &["rocking", "sliding"]);
    let after = count_all(sweep, &["rocking", "sliding", "slack"]);
    Finding::new(
        Verdict::of(slack > 0),
        format!(
            "{slack} of {} ends of rocking in {} runs",
            slack + sliding,
            sweep.len()
        ),
    )
    .because(
        Verdict::NotReproduced,
        sliding > 0,
        format!(
            "Both tensions would have to vanish at one instant, which was not met. By way of a \
             slide the body comes off {after} times."
        ),
    )
}

fn begins_from_sliding(sweep: &[Trajectory]) -> Finding {
    let sliding = count_all(sweep, &["sliding", "rocking"]);
    let all = sliding + count_all(sweep, &["slack", "rocking"]);
    let evidence = format!(
        "{sliding} of {all} beginnings of rocking in {} runs",
        sweep.len()
    );
    Finding::new(Verdict::of(sliding > 0), evidence)
}

fn lasting() -> Result<Finding, CaseError> {
    let members = ensemble(&going_on(0.0), FEW);
    let number = members.len();
    let of_force = |k: u32| {
        let f_o = f64::from(k) / 100.0;
        members
            .iter()
            .map(move |member| Parameters { f_o, ..*member })
    };
    let cases: Vec<Parameters> = (1..=50).flat_map(of_force).collect();
    let on: Vec<bool> = run_all(&cases)?.iter().map(rocks_on).collect();
    let counts = |member: usize| {
        let own: Vec<bool> = on.iter().skip(member).step_by(number).copied().collect();
        let (low, high) = own.split_at(own.len() / 2);
        [low, high].map(|part| part.iter().filter(|on| **on).count())
    };
    let holds = |member: usize| {
        let [low, high] = counts(member);
        low > high
    };
    let [low, high] = counts(0);
    let evidence =
        format!("unbroken to t = 100 at {low} of 25 amplitudes up to 0.25, at {high} of 25 above");
    Ok(Finding::new(
        Verdict::robust((0..number).map(holds)),
        evidence,
    ))
}
