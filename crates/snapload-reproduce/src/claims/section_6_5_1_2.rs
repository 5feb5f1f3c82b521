//! 6.5.1.2: when bodies slide, and the sliding example (eq. 6.57).

use super::sliding_story::{LEFT, Story};
use super::tools::claim;
use super::{Claim, Verdict, ensemble, robust};
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::analysis::{ForceScan, Outcome};
use snapload::{
    Case, CaseError, Impact, Parameters, Playback, Stop, TABLE_6_1, TautSet, Trajectory,
    named_case, natural_inertia,
};

/// Neighbours of a start.
const NEIGHBOURS: usize = 8;

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let mut all = vec![table_6_1(study)?];
    all.extend(sweep(study)?);
    all.push(slow_starts()?);
    let parameters = named_case("sliding-example")?.parameters;
    let runs = ensemble(&parameters, NEIGHBOURS)
        .into_par_iter()
        .map(|member| Ok(Case::new(member)?.run()))
        .collect::<Result<Vec<Trajectory>, CaseError>>()?;
    let stories: Vec<Story> = runs.par_iter().filter_map(Story::of).collect();
    all.extend(first_slide(&stories, runs.len()));
    all.extend(hits(&stories, runs.len()));
    all.extend(rocking(&stories, runs.len()));
    all.push(ends(study)?);
    all.sort_by_key(|claim| claim.id);
    Ok(all)
}

fn slides(parameters: Parameters) -> Result<bool, CaseError> {
    let outcome = Outcome::of(&Case::new(Reading::Chapter.apply(parameters))?);
    Ok(outcome.end.reason == Stop::SlidingStart)
}

fn table_6_1(study: &Study) -> Result<Claim, CaseError> {
    let by_code = |code: &str| TABLE_6_1.iter().any(|(_, of)| *of == code);
    let (table, printed): (Vec<_>, Vec<_>) =
        study.cases.iter().partition(|case| by_code(case.code));
    // By member: how many of the cases slide.
    let mut sliding = [0_usize; NEIGHBOURS + 1];
    for case in &table {
        let members = ensemble(&case.parameters, NEIGHBOURS)
            .into_par_iter()
            .map(slides)
            .collect::<Result<Vec<bool>, CaseError>>()?;
        for (count, slides) in sliding.iter_mut().zip(members) {
            *count += usize::from(slides);
        }
    }
    let others = printed
        .iter()
        .filter(|case| case.runs.chapter.end().reason == Stop::SlidingStart);
    let codes: Vec<&str> = others.map(|case| case.code).collect();
    Ok(claim(
        "6.5.1.2-01",
        "No case of Table 6.1 slides.",
        robust(sliding.iter().map(|count| *count == 0)),
        format!(
            "{} of {} by their codes, {} at most from starts 1e-12 away; with the printed f_o = 0.5 also {}",
            sliding.first().copied().unwrap_or(0),
            table.len(),
            sliding.iter().max().copied().unwrap_or(0),
            if codes.is_empty() {
                "none".to_owned()
            } else {
                codes.join(", ")
            }
        ),
        "The runs themselves agree; in a motion this sensitive chance can still bring a slide.",
    ))
}

/// What a shape of Table 6.2 does over all amplitudes.
struct Sweep {
    class: (&'static str, bool),
    amplitudes: usize,
    intervals: usize,
    robust: bool,
}

fn sweep_of(row: &crate::study::CriticalRow) -> Result<Sweep, CaseError> {
    let [a, b] = row.size;
    let at = |f_o: f64| Parameters {
        r: row.r,
        a,
        b,
        inertia: natural_inertia(a, b),
        f_o,
        ..Parameters::STANDARD
    };
    let amplitudes: Vec<f64> = ForceScan::default().amplitudes().collect();
    let found = amplitudes
        .par_iter()
        .map(|f_o| slides(at(*f_o)))
        .collect::<Result<Vec<bool>, CaseError>>()?;
    let mut robustly = false;
    for (f_o, _) in amplitudes.iter().zip(&found).filter(|(_, slid)| **slid) {
        let mut all = true;
        for member in ensemble(&at(*f_o), NEIGHBOURS) {
            all = all && slides(member)?;
        }
        if all {
            robustly = true;
            break;
        }
    }
    Ok(Sweep {
        class: (row.shape, row.r > 2.0),
        amplitudes: found.iter().filter(|slid| **slid).count(),
        intervals: found
            .chunk_by(|p, q| p == q)
            .filter(|part| part.first() == Some(&true))
            .count(),
        robust: robustly,
    })
}

fn range(values: impl Iterator<Item = usize> + Clone) -> String {
    let least = values.clone().min().unwrap_or(0);
    format!("{least} to {}", values.max().unwrap_or(0))
}

fn sweep(study: &Study) -> Result<[Claim; 2], CaseError> {
    let sweeps = study
        .critical
        .par_iter()
        .map(sweep_of)
        .collect::<Result<Vec<Sweep>, CaseError>>()?;
    let each = |holds: fn(&Sweep) -> bool| {
        sweeps
            .iter()
            .all(|of| sweeps.iter().any(|s| s.class == of.class && holds(s)))
    };
    let everywhere = match (each(|s| s.robust), each(|s| s.amplitudes > 0)) {
        (true, _) => Verdict::Reproduced,
        (false, true) => Verdict::NotDecidable,
        _ => Verdict::NotReproduced,
    };
    let scattered = sweeps.iter().filter(|s| s.intervals >= 2).count();
    let shapes = sweeps.len();
    Ok([
        claim(
            "6.5.1.2-02",
            "Bodies of all shapes slide, with both lengths of the cables.",
            everywhere,
            format!(
                "{} of 100 amplitudes slide, over {shapes} shapes; robustly somewhere for {} of them",
                range(sweeps.iter().map(|s| s.amplitudes)),
                sweeps.iter().filter(|s| s.robust).count()
            ),
            "",
        ),
        claim(
            "6.5.1.2-03",
            "No simple rule tells which amplitudes lead to sliding.",
            Verdict::of(scattered + 2 >= shapes && shapes > 2),
            format!(
                "{} separate intervals of amplitudes slide, two or more for {scattered} of {shapes} shapes",
                range(sweeps.iter().map(|s| s.intervals))
            ),
            "",
        ),
    ])
}

fn slow_starts() -> Result<Claim, CaseError> {
    let (mut all, mut slow) = (0_usize, 0_usize);
    for f_o in [0.2, 0.27, 0.4, 0.44] {
        let run = Case::new(Parameters {
            f_o,
            stop_when_settled: false,
            ..Parameters::STANDARD
        })?
        .run();
        for pair in run.modes().windows(2) {
            let [before, mode] = pair else { continue };
            if !before.taut.is_empty() || mode.taut.len() != 1 {
                continue;
            }
            let begins = |impact: &&Impact| {
                (impact.t - mode.t_start).abs() < 1e-12 && mode.taut.contains(impact.cable)
            };
            let last = run.impacts().iter().rfind(begins);
            all += 1;
            slow += usize::from(last.is_some_and(|i| i.v_n < Parameters::STANDARD.v_stick));
        }
    }
    Ok(claim(
        "6.5.1.2-04",
        "Sliding starts where the normal velocity is very low.",
        Verdict::of(all > 0 && slow == all),
        format!("{slow} of {all} slides out of slack motion follow an impact below 1e-6"),
        "",
    ))
}

/// The verdict on all members; one without a slide is none of which it holds.
fn over(stories: &[Story], members: usize, holds: impl Fn(&Story) -> bool) -> Verdict {
    let missing = members.saturating_sub(stories.len());
    let absent = std::iter::repeat_n(false, missing);
    robust(stories.iter().map(holds).chain(absent))
}

/// The span of a number over members.
fn span(values: impl Iterator<Item = f64>, digits: usize) -> String {
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(p, q), v| {
        (p.min(v), q.max(v))
    });
    format!("{least:.digits$} to {most:.digits$}")
}

fn first_slide(stories: &[Story], members: usize) -> Vec<Claim> {
    /// Speed of a resting connection point, in parts of the centre's.
    const TURNS: f64 = 0.5;
    /// The height from which on a stuck cable means sliding.
    const SLIDING_ABOVE: f64 = 0.05;
    let ways = |s: &Story| (s.goes(|v| v > 0.0), s.goes(|v| v < 0.0));
    let all_three = |s: &Story| ways(s) == (true, true) && s.least_turning() < TURNS;
    let both_ways = stories.iter().filter(|s| ways(s) == (true, true)).count();
    let turners = stories.iter().filter(|s| s.least_turning() < TURNS).count();
    let turning = span(stories.iter().map(Story::least_turning), 2);
    let heights = span(stories.iter().map(|s| s.start.state.y), 4);
    let times = span(stories.iter().map(|s| s.start.t), 4);
    let places = span(stories.iter().map(|s| s.start.state.x), 3);
    let xs = stories.iter().flat_map(|s| &s.sliding).map(|m| m.state.x);
    vec![
        claim(
            "6.5.1.2-05",
            "The example slides up, slides down, and turns about its connection point.",
            over(stories, members, all_three),
            format!(
                "up and down in {both_ways} of {members}, turning in {turners}: the connection point moves at least at {turning} of \
                 the centre's speed"
            ),
            "It goes up, and in most members visibly down; the connection point moves faster than the centre and never nearly rests.",
        ),
        claim(
            "6.5.1.2-06",
            "The example (f_o = 0.27) comes to slide along the boundary of its left cable.",
            over(stories, members, |s| s.first.taut == TautSet::only(LEFT)),
            format!("first at t = {times}, {} of {members} slide", stories.len()),
            "",
        ),
        claim(
            "6.5.1.2-07",
            "By the chapter's own rule (y >= 0.05) the example slides and has not settled.",
            over(stories, members, |s| s.start.state.y >= SLIDING_ABOVE),
            format!("the cable sticks at y = {heights}"),
            "The rule would have called it settled; it must have been put aside to show the example.",
        ),
        claim(
            "6.5.1.2-12",
            "The example slides first on the left (x < 0) and later on the right.",
            over(stories, members, |s| {
                s.start.state.x < 0.0 && s.sliding.iter().any(|m| m.state.x > 0.0)
            }),
            format!("x = {places} at the start, {} in all slides", span(xs, 3)),
            "The boundary agrees, the side does not: so far turned, the body meets it on the right.",
        ),
    ]
}

fn hits(stories: &[Story], members: usize) -> Vec<Claim> {
    let first: Vec<&Impact> = stories.iter().filter_map(|s| s.hits.first()).collect();
    let slides_on = |s: &Story| {
        let hit = s.hits.first();
        hit.and_then(|hit| s.taut_after(hit.t)) == Some(TautSet::only(LEFT))
    };
    let going_on = stories.iter().filter(|s| slides_on(s)).count();
    vec![
        claim(
            "6.5.1.2-08",
            "While it slides it hits the other boundary.",
            over(stories, members, |s| !s.hits.is_empty()),
            format!(
                "first at t = {} with v_n = {}",
                span(first.iter().map(|i| i.t), 4),
                span(first.iter().map(|i| i.v_n), 4)
            ),
            "",
        ),
        claim(
            "6.5.1.2-09",
            "After that hit it goes on sliding.",
            over(stories, members, slides_on),
            format!("the left cable stays taut through it in {going_on} of {members}"),
            "The snap of one cable unloads the other here. The chapter's impact knows one cable at a time and \
             leaves open what a taut one does.",
        ),
        claim(
            "6.5.1.2-10",
            "It hits the other boundary many times while the first cable is taut.",
            over(stories, members, |s| s.hits.len() >= 3),
            format!("{} times", range(stories.iter().map(|s| s.hits.len()))),
            "",
        ),
    ]
}

/// How far y rises from the first slide on, and falls from there to the first rocking.
fn rise_and_fall(story: &Story) -> Option<[f64; 2]> {
    let (rocking, _) = story.rocks?;
    let (from, to) = (story.start.t, rocking.t);
    let mut playback = Playback::new(story.run);
    let top = (0..=1000)
        .map(|k| {
            playback
                .at(from + (to - from) * f64::from(k) / 1000.0)
                .state
                .y
        })
        .fold(f64::NEG_INFINITY, f64::max);
    Some([top - story.start.state.y, top - rocking.state.y])
}

/// The largest |g2| at its impacts from the first slide to the first rocking.
fn widest(story: &Story) -> f64 {
    let left = story.run.system().cables.get(LEFT);
    let gap = |impact: &Impact| left.map_or(f64::INFINITY, |cable| cable.gap(&impact.before).abs());
    story.impacts().map(gap).fold(0.0, f64::max)
}

/// Whether both cables are hit at the same x somewhere.
fn overlaps(story: &Story) -> Option<[f64; 2]> {
    let ends = |cable: usize| {
        let xs = story.impacts().filter(move |i| i.cable == cable);
        xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(p, q), i| {
            (p.min(i.before.x), q.max(i.before.x))
        })
    };
    let (right, left) = (ends(0), ends(LEFT));
    let common = [right.0.max(left.0), right.1.min(left.1)];
    (common[0] < common[1]).then_some(common)
}

fn rocking(stories: &[Story], members: usize) -> Vec<Claim> {
    const CLEARLY: f64 = 0.005;
    const NEAR: f64 = 0.01;
    const MOVING: f64 = 1e-3;
    let bounces = |s: &Story| {
        rise_and_fall(s).is_some_and(|both| both.iter().all(|d| *d > CLEARLY)) && widest(s) < NEAR
    };
    let moves: Vec<[f64; 2]> = stories.iter().filter_map(rise_and_fall).collect();
    let kinetic = |s: &Story| s.rocks.map(|(motion, _)| motion.energy - motion.state.y);
    let after_slide = |s: &Story| s.rocks.is_some_and(|(_, after)| after);
    let common = stories.iter().filter_map(overlaps);
    let times = stories.iter().filter_map(|s| s.rocks.map(|(m, _)| m.t));
    vec![
        claim(
            "6.5.1.2-11",
            "From its first slide until it rocks it goes up and then down along the boundary.",
            over(stories, members, bounces),
            format!(
                "up by {}, down by {}; |g2| at its impacts at most {:.1e}",
                span(moves.iter().map(|m| m[0]), 3),
                span(moves.iter().map(|m| m[1]), 3),
                stories.iter().map(widest).fold(0.0, f64::max)
            ),
            "",
        ),
        claim(
            "6.5.1.2-13",
            "As the body turns, both boundaries can be met on the same side.",
            over(stories, members, |s| overlaps(s).is_some()),
            format!("both cables are hit at x = {}", span(common.flatten(), 3)),
            "",
        ),
        claim(
            "6.5.1.2-14",
            "The sliding ends in rocking, with both cables taut.",
            over(stories, members, after_slide),
            format!("at t = {}", span(times, 3)),
            "",
        ),
        claim(
            "6.5.1.2-15",
            "It does not come to rest at once but rocks.",
            over(stories, members, |s| {
                after_slide(s) && kinetic(s).is_some_and(|energy| energy > MOVING)
            }),
            format!(
                "kinetic energy {} where it begins",
                span(stories.iter().filter_map(kinetic), 3)
            ),
            "",
        ),
    ]
}

/// How a run ends that has slid.
fn end_if_slid(parameters: Parameters) -> Result<Option<Stop>, CaseError> {
    let mut simulation = Case::new(parameters)?.simulation();
    let mut slid = false;
    while let Some(step) = simulation.step() {
        slid |= step.taut.len() == 1 && step.t_end > step.t_start;
    }
    Ok(simulation.stop().filter(|_| slid))
}

fn ends(study: &Study) -> Result<Claim, CaseError> {
    let cases: Vec<Parameters> = study
        .critical
        .iter()
        .flat_map(|row| {
            let [a, b] = row.size;
            (1..=18).map(move |k| Parameters {
                r: row.r,
                a,
                b,
                inertia: natural_inertia(a, b),
                f_o: f64::from(k) / 20.0,
                ..Parameters::STANDARD
            })
        })
        .collect();
    let ends = cases
        .into_par_iter()
        .map(end_if_slid)
        .collect::<Result<Vec<_>, CaseError>>()?;
    let count = |reason: Stop| ends.iter().filter(|end| **end == Some(reason)).count();
    let [settled, limit] = [Stop::Settled, Stop::RotationLimit].map(count);
    let [bound, going] = [Stop::UpperBound, Stop::EndTime].map(count);
    let all = ends.iter().flatten().count();
    Ok(claim(
        "6.5.1.2-16",
        "Runs that slide end by settling, at the rotation limit or in rocking, and in no other way.",
        Verdict::of(all > 0 && settled + limit == all),
        format!(
            "of {all} runs that slide {settled} settle, {limit} reach the rotation limit, {bound} the upper \
             bound, and {going} still move at t = 100"
        ),
        "The upper bound occurs too, for boxes under forces that the chapter may not have tried.",
    ))
}
