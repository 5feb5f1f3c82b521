//! Section 6.5: the three kinds of motion, and rocking.

mod slides;
mod weak;

use super::numbers::{range, span};
use super::runs::{FEW, MANY, ensemble, near, run_all};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{
    CaseError, ModeInterval, Motion, Parameters, Playback, State, Stop, Trajectory, named_case,
    natural_inertia,
};

/// Times between the samples of a rocking motion.
const SAMPLE: f64 = 0.02;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let sweep = shapes(study)?;
    let mut all = of_kinds(study, &sweep)?;
    all.extend(of_strong_rocking(study)?);
    all.extend(weak::claims(study)?);
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

/// The tensions of all cables.
fn tension(run: &Trajectory, now: &Motion) -> impl Iterator<Item = f64> {
    now.tensions.into_iter().take(run.system().cables.len())
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
fn example(code: &str) -> Result<Vec<Trajectory>, CaseError> {
    near(&named_case(code)?.parameters, MANY)
}

fn of_strong_rocking(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let runs = example("sliding-example")?;
    Ok(vec![
        claim(
            "6.5.2.2-03",
            "At f_o = 0.27 the rocking soon ends as one cable loses its tension and a second \
             sliding begins.",
            short_rocking(&runs),
        ),
        claim(
            "6.5.2.2-04",
            "That example then comes to rest at the bottom.",
            rests(&runs),
        ),
        claim(
            "6.5.2.2-14",
            "In the end rocking stops as the body comes to rest in equilibrium.",
            dies_out(&study.rocking, &runs),
        ),
    ])
}

fn short_rocking(runs: &[Trajectory]) -> Finding {
    let slides = |run: &Trajectory| from_rocking(run).iter().any(|mode| kind(mode) == "sliding");
    let on = runs.iter().filter(|run| rocks_on(run)).count();
    let start = |run: &Trajectory| {
        from_rocking(run)
            .first()
            .map_or(f64::NAN, |mode| mode.t_start)
    };
    let least = runs
        .iter()
        .map(|run| least_tension(run, &sampled(run, start(run))));
    Finding::new(
        Verdict::robust(runs.iter().map(slides)),
        format!(
            "rocks from t = {}, smallest tension {}; unbroken to t = 100 from {on} of {} starts",
            span(runs.iter().map(start), 3),
            span(least.clone(), 3),
            runs.len()
        ),
    )
    .because(
        Verdict::NotReproduced,
        on == runs.len(),
        format!(
            "Here both cables go on pulling, with {} at the least. How near that comes to 0 \
             depends on the state in which the rocking begins, so another law for an impact that \
             meets a taut cable may end it.",
            span(least, 3)
        ),
    )
}

/// The highest y of the last 20 T.
fn highest_late(run: &Trajectory) -> f64 {
    let late = sampled(run, run.end().t - 20.0);
    range(late.iter().map(|now| now.state.y)).1
}

fn rests(runs: &[Trajectory]) -> Finding {
    let heights: Vec<f64> = runs.iter().map(highest_late).collect();
    let on = runs.iter().all(rocks_on);
    Finding::new(
        Verdict::robust(heights.iter().map(|y| *y < 0.05)),
        format!(
            "highest y of the last 20 T: {} by start",
            span(heights.iter().copied(), 3)
        ),
    )
    .because(
        Verdict::NotReproduced,
        on,
        "It rocks on under the force. With both cables taut there are no impacts, and nothing \
         else in the model takes energy.",
    )
}

/// The largest |θ| of 20 T late in a rocking, over that of its first 20 T.
fn remaining(run: &Trajectory) -> f64 {
    let Some(start) = from_rocking(run).first().map(|mode| mode.t_start) else {
        return f64::NAN;
    };
    let motion = sampled(run, start);
    let widest = |from: f64| {
        let part = motion
            .iter()
            .filter(|now| (from..from + 20.0).contains(&now.t));
        range(part.map(|now| now.state.theta.abs())).1
    };
    widest(run.end().t - 20.0) / widest(start)
}

fn dies_out(weak: &Trajectory, strong: &[Trajectory]) -> Finding {
    /// What is left of a motion that dies out.
    const DYING: f64 = 0.1;
    let strong: Vec<f64> = strong.iter().map(remaining).collect();
    let all = std::iter::once(remaining(weak)).chain(strong.iter().copied());
    Finding::new(
        Verdict::robust(all.map(|left| left < DYING)),
        format!(
            "widest rotation of the last 20 T over that of the first: {:.2} at f_o = 0.1, {} at \
             f_o = 0.27",
            remaining(weak),
            span(strong.iter().copied(), 2)
        ),
    )
    .because(
        Verdict::NotReproduced,
        true,
        "Rocking loses no energy in this model, and the force goes on: it does not die out.",
    )
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
