//! The sliding example (eq. 6.57).

use super::story::{LEFT, Story};
use crate::claims::numbers::{range, span};
use crate::claims::runs::{CLEAR, MANY, near, places};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use rayon::prelude::*;
use snapload::{CaseError, Impact, TautSet, named_case};

/// Checks the claims on the example.
pub(super) fn claims() -> Result<Vec<Claim>, CaseError> {
    let runs = near(&named_case("sliding-example")?.parameters, MANY)?;
    let stories: Vec<Story> = runs.par_iter().filter_map(Story::of).collect();
    let mut all = first_slide(&stories, runs.len());
    all.extend(hits(&stories, runs.len()));
    all.extend(rocking(&stories, runs.len()));
    Ok(all)
}

/// The verdict on all members; one without a slide is none of which it holds.
fn over(stories: &[Story], members: usize, holds: impl Fn(&Story) -> bool) -> Verdict {
    let missing = members.saturating_sub(stories.len());
    let absent = std::iter::repeat_n(false, missing);
    Verdict::robust(stories.iter().map(holds).chain(absent))
}

fn first_slide(stories: &[Story], members: usize) -> Vec<Claim> {
    let places = || stories.iter().map(|s| s.start.state.x);
    let all_places = stories.iter().flat_map(|s| &s.sliding).map(|m| m.state.x);
    let times = span(stories.iter().map(|s| s.start.t), 4);
    let left = over(stories, members, |s| s.first.taut == TautSet::only(LEFT));
    let sides = over(stories, members, |s| {
        s.start.state.x < 0.0 && s.sliding.iter().any(|m| m.state.x > 0.0)
    });
    vec![
        claim(
            "6.5.1.2-05",
            "The example slides up, slides down, and turns about its connection point.",
            three_ways(stories, members),
        ),
        claim(
            "6.5.1.2-06",
            "The example (f_o = 0.27) comes to slide along the boundary of its left cable.",
            Finding::new(
                left,
                format!("first at t = {times}, {} of {members} slide", stories.len()),
            ),
        ),
        claim(
            "6.5.1.2-07",
            "By the chapter's own rule (y ≥ 0.05) the example slides and has not settled.",
            not_settled(stories, members),
        ),
        claim(
            "6.5.1.2-12",
            "The example slides first on the left (x < 0) and later on the right.",
            Finding::new(
                sides,
                format!(
                    "x = {} at the start, {} in all slides",
                    span(places(), 3),
                    span(all_places, 3)
                ),
            )
            .because(
                Verdict::NotReproduced,
                left == Verdict::Reproduced && places().all(|x| x > 0.0),
                format!(
                    "The boundary agrees, the side does not: turned by θ = {} the body meets it \
                     on the right.",
                    span(stories.iter().map(|s| s.start.state.theta), 2)
                ),
            ),
        ),
    ]
}

fn three_ways(stories: &[Story], members: usize) -> Finding {
    /// Speed of a resting connection point, in parts of the centre's.
    const TURNS: f64 = 0.5;
    let ways = |s: &Story| [s.goes(|v| v > 0.0), s.goes(|v| v < 0.0)];
    let count = |way: usize| stories.iter().filter(|s| ways(s)[way]).count();
    let turns = |s: &Story| s.least_turning() < TURNS;
    let turning = stories.iter().filter(|s| turns(s)).count();
    let least = || span(stories.iter().map(Story::least_turning), 2);
    Finding::new(
        over(stories, members, |s| ways(s) == [true; 2] && turns(s)),
        format!(
            "up in {} of {members}, down in {}, turning in {turning}: the connection point moves \
             at least at {} of the centre's speed",
            count(0),
            count(1),
            least()
        ),
    )
    .because(
        Verdict::NotReproduced,
        turning == 0,
        "The connection point never nearly rests while the body slides, so it does not merely \
         turn about it.",
    )
}

fn not_settled(stories: &[Story], members: usize) -> Finding {
    /// The height from which on a stuck cable means sliding.
    const SLIDING_ABOVE: f64 = 0.05;
    let heights = || stories.iter().map(|s| s.start.state.y);
    Finding::new(
        over(stories, members, |s| s.start.state.y >= SLIDING_ABOVE),
        format!("the cable sticks at y = {}", span(heights(), 4)),
    )
    .because(
        Verdict::NotReproduced,
        heights().all(|y| y < SLIDING_ABOVE),
        "The rule would have called it settled; it must have been put aside to show the example.",
    )
}

fn hits(stories: &[Story], members: usize) -> Vec<Claim> {
    let first: Vec<&Impact> = stories.iter().filter_map(|s| s.hits.first()).collect();
    let slides_on = |s: &Story| {
        let hit = s.hits.first();
        hit.and_then(|hit| s.taut_after(hit.t)) == Some(TautSet::only(LEFT))
    };
    let clear = |s: &Story| s.hits.iter().filter(|hit| hit.v_n > CLEAR).count() as f64;
    let going_on = stories.iter().filter(|s| slides_on(s)).count();
    let many = Finding::new(
        over(stories, members, |s| s.hits.len() >= 3),
        format!(
            "{} times, {} of them with v_n > {CLEAR}",
            span(stories.iter().map(|s| s.hits.len() as f64), 0),
            span(stories.iter().map(clear), 0)
        ),
    );
    let goes_on = Finding::new(
        over(stories, members, slides_on),
        format!("the left cable stays taut through it in {going_on} of {members}"),
    )
    .because(
        Verdict::NotReproduced,
        going_on == 0,
        "The snap of one cable unloads the other here. The chapter's impact knows one cable at a \
         time and leaves open what a taut one does.",
    );
    let hits = Finding::new(
        over(stories, members, |s| !s.hits.is_empty()),
        format!(
            "first at t = {} with v_n = {}",
            span(first.iter().map(|i| i.t), 4),
            span(first.iter().map(|i| i.v_n), 4)
        ),
    );
    vec![
        claim(
            "6.5.1.2-08",
            "While it slides it hits the other boundary.",
            hits,
        ),
        claim("6.5.1.2-09", "After that hit it goes on sliding.", goes_on),
        claim(
            "6.5.1.2-10",
            "It hits the other boundary many times while the first cable is taut.",
            many,
        ),
    ]
}

/// How far y rises from the first slide on, and falls from there to the first rocking.
fn rise_and_fall(story: &Story) -> Option<[f64; 2]> {
    let (rocking, _) = story.rocks?;
    let (from, to) = (story.start.t, rocking.t);
    let path = places(story.run, (from, to), (to - from) / 1000.0);
    let (_, top) = range(path.iter().map(|p| p.1));
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
        let own = story.impacts().filter(move |i| i.cable == cable);
        range(own.map(|i| i.before.x))
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
            Finding::new(
                over(stories, members, bounces),
                format!(
                    "up by {}, down by {}; |g2| at its impacts at most {:.1e}",
                    span(moves.iter().map(|m| m[0]), 3),
                    span(moves.iter().map(|m| m[1]), 3),
                    stories.iter().map(widest).fold(0.0, f64::max)
                ),
            ),
        ),
        claim(
            "6.5.1.2-13",
            "As the body turns, both boundaries can be met on the same side.",
            Finding::new(
                over(stories, members, |s| overlaps(s).is_some()),
                format!("both cables are hit at x = {}", span(common.flatten(), 3)),
            ),
        ),
        claim(
            "6.5.1.2-14",
            "The sliding ends in rocking, with both cables taut.",
            Finding::new(
                over(stories, members, after_slide),
                format!("at t = {}", span(times, 3)),
            ),
        ),
        claim(
            "6.5.1.2-15",
            "It does not come to rest at once but rocks.",
            Finding::new(
                over(stories, members, |s| {
                    after_slide(s) && kinetic(s).is_some_and(|energy| energy > MOVING)
                }),
                format!(
                    "kinetic energy {} where it begins",
                    span(stories.iter().filter_map(kinetic), 3)
                ),
            ),
        ),
    ]
}
