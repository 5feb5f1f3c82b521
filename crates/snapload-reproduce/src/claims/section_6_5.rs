//! Section 6.5: the three kinds of motion, and rocking.

mod weak;

use super::tools::{Finding, ensemble, judged, range, robust, run_all};
use super::{Claim, Verdict};
use crate::study::Study;
use snapload::{
    CaseError, ModeInterval, Motion, Parameters, Playback, Stop, Trajectory, named_case,
    natural_inertia,
};

/// Neighbours of one example, and of each run of a sweep.
const NEIGHBOURS: [usize; 2] = [8, 3];
/// Times between the samples of a rocking motion.
const SAMPLE: f64 = 0.02;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let sweep = shapes(study)?;
    let mut all = of_kinds(study, &sweep)?;
    all.extend(of_strong_rocking(study)?);
    all.extend(weak::claims(study)?);
    all.push(judged(
        "6.5.2.2-12",
        "Rocking may begin as a sliding body hits the other boundary.",
        begins_from_sliding(&sweep),
        "Not met.",
    ));
    all.push(judged(
        "6.5.2.2-13",
        "The weaker the force, the longer the rocking lasts.",
        lasting()?,
        "Not so.",
    ));
    all.sort_by_key(|claim| claim.id);
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
    let case = |r, [a, b]: [f64; 2], k: u32| Parameters {
        r,
        a,
        b,
        inertia: natural_inertia(a, b),
        t_end: 60.0,
        ..going_on(f64::from(k) / 20.0)
    };
    let rows = study.critical.iter();
    let cases: Vec<Parameters> = rows
        .flat_map(|row| (1..=14).map(move |k| case(row.r, row.size, k)))
        .collect();
    run_all(&cases)
}

fn kind(mode: &ModeInterval) -> &'static str {
    mode.taut.mode()
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
    let strong = run_all(&ensemble(&going_on(0.4), NEIGHBOURS[1]))?;
    Ok(vec![
        judged(
            "6.5-01",
            "The body knows three kinds of motion: slack, sliding, rocking.",
            three_kinds(&strong),
            "Not all of them are met.",
        ),
        judged(
            "6.5-02",
            "One run may go from slack through sliding into rocking, and back through sliding.",
            chain(sweep),
            "Not met.",
        ),
        judged(
            "6.5-03",
            "Slack motion is described as one with both cables taut.",
            slack_is_taut(&study.sliding),
            "A misprint: both are slack.",
        ),
        judged(
            "6.5.2.2-01",
            "Rocking may end with the body climbing one boundary, sliding.",
            ends_in_sliding(&strong, sweep),
            "Not met.",
        ),
        judged(
            "6.5.2.2-02",
            "Rocking may end in slack motion at once.",
            ends_in_slack(sweep),
            "Both tensions would have to vanish at one instant: possible in principle, not met.",
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
    (
        robust(runs.iter().map(holds)),
        format!("f_o = 0.4: {}", texts.join(", ")),
    )
}

fn chain(sweep: &[Trajectory]) -> Finding {
    let kinds = ["slack", "sliding", "rocking", "sliding", "slack"];
    let chains = count_all(sweep, &kinds);
    let with = sweep.iter().filter(|run| count(run, &kinds) > 0).count();
    let evidence = format!("{chains} such chains in {with} of {} runs", sweep.len());
    (Verdict::of(chains > 0), evidence)
}

fn slack_is_taut(run: &Trajectory) -> Finding {
    let mut playback = Playback::new(run);
    let flights = run.modes().iter().filter(|mode| mode.taut.is_empty());
    let (mut number, mut most) = (0, 0.0);
    for flight in flights {
        let now = playback.at(0.5 * (flight.t_start + flight.t_end));
        number += 1;
        most = tension(run, &now).fold(most, f64::max);
    }
    let evidence = format!("largest tension in {number} intervals of slack motion: {most}");
    (Verdict::of(number > 0 && most > 0.0), evidence)
}

/// The tensions of all cables.
fn tension(run: &Trajectory, now: &Motion) -> impl Iterator<Item = f64> {
    now.tensions.into_iter().take(run.system().cables.len())
}

fn ends_in_sliding(strong: &[Trajectory], sweep: &[Trajectory]) -> Finding {
    let pair = ["rocking", "sliding"];
    let counts: Vec<usize> = strong.iter().map(|run| count(run, &pair)).collect();
    let texts: Vec<String> = counts.iter().map(usize::to_string).collect();
    let (texts, all) = (texts.join(", "), count_all(sweep, &pair));
    let evidence = format!(
        "{texts} times at f_o = 0.4 by start; {all} times in {} runs",
        sweep.len()
    );
    (robust(counts.iter().map(|n| *n > 0)), evidence)
}

fn ends_in_slack(sweep: &[Trajectory]) -> Finding {
    let slack = count_all(sweep, &["rocking", "slack"]);
    let all = slack + count_all(sweep, &["rocking", "sliding"]);
    let evidence = format!("{slack} of {all} ends of rocking in {} runs", sweep.len());
    (Verdict::of(slack > 0), evidence)
}

fn begins_from_sliding(sweep: &[Trajectory]) -> Finding {
    let sliding = count_all(sweep, &["sliding", "rocking"]);
    let all = sliding + count_all(sweep, &["slack", "rocking"]);
    let evidence = format!(
        "{sliding} of {all} beginnings of rocking in {} runs",
        sweep.len()
    );
    (Verdict::of(sliding > 0), evidence)
}

/// The first interval of rocking and those after it.
fn from_rocking(run: &Trajectory) -> &[ModeInterval] {
    let modes = run.modes();
    let first = modes.iter().position(|mode| kind(mode) == "rocking");
    first.and_then(|k| modes.get(k..)).unwrap_or_default()
}

/// Whether a run rocks from its first rocking to the end of its time.
fn rocks_on(run: &Trajectory) -> bool {
    from_rocking(run).len() == 1 && run.end().reason == Stop::EndTime
}

/// The motion from some time on, sampled.
fn sampled(run: &Trajectory, from: f64) -> Vec<Motion> {
    let mut playback = Playback::new(run);
    let steps = ((run.end().t - from) / SAMPLE).max(0.0) as usize;
    (1..=steps)
        .map(|k| playback.at(from + SAMPLE * k as f64))
        .collect()
}

fn least_tension(run: &Trajectory, motion: &[Motion]) -> f64 {
    let rocking = motion.iter().filter(|now| now.taut.len() == 2);
    range(rocking.flat_map(|now| tension(run, now))).0
}

/// An example and its neighbours.
fn example(code: &str, own: &Trajectory) -> Result<Vec<Trajectory>, CaseError> {
    let members = ensemble(&named_case(code)?.parameters, NEIGHBOURS[0]);
    let others = run_all(members.get(1..).unwrap_or_default())?;
    Ok(std::iter::once(own.clone()).chain(others).collect())
}

fn of_strong_rocking(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let runs = example("sliding-example", &study.sliding)?;
    Ok(vec![
        judged(
            "6.5.2.2-03",
            "At f_o = 0.27 the rocking soon ends as one cable loses its tension and a second sliding \
             begins.",
            short_rocking(&runs),
            "Here the rocking goes on, from all starts. A short one needs another state as rocking \
             begins.",
        ),
        judged(
            "6.5.2.2-04",
            "That example then comes to rest at the bottom.",
            rests(&runs),
            "A forced rocking that never dies out: rocking loses no energy in this model. To settle \
             is a word of the stop rule.",
        ),
    ])
}

fn short_rocking(runs: &[Trajectory]) -> Finding {
    let slides = |run: &Trajectory| from_rocking(run).iter().any(|mode| kind(mode) == "sliding");
    let on = runs.iter().filter(|run| rocks_on(run)).count();
    let text = |run: &Trajectory| {
        let start = from_rocking(run)
            .first()
            .map_or(f64::NAN, |mode| mode.t_start);
        let least = least_tension(run, &sampled(run, start));
        format!("rocks from {start:.3}, smallest tension {least:.3}")
    };
    let own = runs.first().map(text).unwrap_or_default();
    let evidence = format!(
        "{own}; unbroken to t = 100 from {on} of {} starts",
        runs.len()
    );
    (robust(runs.iter().map(slides)), evidence)
}

fn rests(runs: &[Trajectory]) -> Finding {
    let heights: Vec<f64> = runs
        .iter()
        .map(|run| {
            range(
                sampled(run, run.end().t - 20.0)
                    .iter()
                    .map(|now| now.state.y),
            )
            .1
        })
        .collect();
    let (low, high) = range(heights.iter().copied());
    let evidence = format!("highest y of the last 20: {low:.3} to {high:.3} by start");
    (robust(heights.iter().map(|y| *y < 0.05)), evidence)
}

fn lasting() -> Result<Finding, CaseError> {
    let members = ensemble(&going_on(0.0), NEIGHBOURS[1]);
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
    Ok((robust((0..number).map(holds)), evidence))
}
