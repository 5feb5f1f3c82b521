//! Section 6.4.1, last part: the frequency of the forcing, and the snaps of the two cables.

use super::near::{Near, clear, endings, exceeds, judged, list, mean, nominal, range, rising};
use super::{Claim, Verdict, robust};
use snapload::{Impact, Trajectory};

const SECTION: &str = "6.4.1";
/// Figs 6.22-6.26: Ω = 0.5, 0.75, 0.9, 1.5, 2.0.
const FREQUENCIES: [&str; 5] = [
    "1910001000-355",
    "1910001000-3575",
    "1910001000-359",
    "1910001000-3515",
    "1910001000-3520",
];
/// Of these the figures with stretches of one mark, and the others.
const STRETCHES: [usize; 3] = [0, 2, 4];
const NO_STRETCHES: [usize; 2] = [1, 3];
/// The figures that are likened to braids, and the others.
const BRAIDS: [usize; 2] = [1, 2];
const NO_BRAIDS: [usize; 3] = [0, 3, 4];
/// What a printed plot shows of a snap velocity.
const CLEAR: f64 = 1e-2;

type Members<'a> = [Vec<&'a Trajectory>];

pub(super) fn claims(near: &Near) -> Vec<Claim> {
    let members = near.of(&FREQUENCIES);
    vec![
        within_limit(&members),
        grows(&members),
        one_mark_only(&members),
        down_a_boundary(&members),
        higher_on_one(&members),
        grazes_the_other(&members),
        serpentine(&members),
        braided(&members),
        towards_the_boundary(&members),
    ]
}

/// The runs of some of the figures.
fn of<'a>(runs: &'a [&'a Trajectory], which: &'a [usize]) -> impl Iterator<Item = &'a Trajectory> {
    which.iter().filter_map(|k| runs.get(*k).copied())
}

fn within_limit(members: &Members) -> Claim {
    let holds = |runs: &Vec<&Trajectory>| match runs.split_last() {
        Some((last, others)) => exceeds(last) && !others.iter().any(|run| exceeds(run)),
        None => false,
    };
    judged(
        ("6.4.1-26", SECTION),
        "The body stays within the limits with frequencies 0.5, 0.75, 0.9 and 1.5, not with 2.0.",
        robust(members.iter().map(holds)),
        endings(members),
        "",
    )
}

fn grows(members: &Members) -> Claim {
    let rotation = |run: &Trajectory| run.norms().theta_max;
    let holds = |runs: &Vec<&Trajectory>| {
        let values: Vec<f64> = runs.iter().map(|run| rotation(run)).collect();
        rising(&values)
    };
    judged(
        ("6.4.1-27", SECTION),
        "The rotations get larger with the frequency.",
        robust(members.iter().map(holds)),
        format!("largest rotation {}", nominal(members, 3, rotation)),
        "True of the ends of the range, but not of every step.",
    )
}

/// The longest run of impacts on one cable; the first of equal ones.
fn longest(run: &Trajectory, above: f64) -> Vec<&Impact> {
    let hits = clear(run, above);
    let mut best: &[&Impact] = &[];
    for stretch in hits.chunk_by(|p, q| p.cable == q.cable) {
        if stretch.len() > best.len() {
            best = stretch;
        }
    }
    best.to_vec()
}

fn one_mark_only(members: &Members) -> Claim {
    let length = |run: &Trajectory| longest(run, CLEAR).len();
    let holds = |runs: &Vec<&Trajectory>| {
        let with = of(runs, &STRETCHES).map(length).min();
        let without = of(runs, &NO_STRETCHES).map(length).max();
        with > without
    };
    let lengths = |above: f64| nominal(members, 0, |run| longest(run, above).len() as f64);
    judged(
        ("6.4.1-28", SECTION),
        "Figs 6.22, 6.24 and 6.26 have stretches of marks of one boundary only; the other two do not.",
        robust(members.iter().map(holds)),
        format!(
            "most snaps in a row on one cable: {} (v_n > 0.03), {} (v_n > 0.01)",
            lengths(3.0 * CLEAR),
            lengths(CLEAR)
        ),
        "",
    )
}

fn down_a_boundary(members: &Members) -> Claim {
    let heights = |run: &Trajectory| {
        let stretch = longest(run, CLEAR);
        let first = stretch.first().map_or(f64::NAN, |hit| hit.before.y);
        (first, stretch.last().map_or(f64::NAN, |hit| hit.before.y))
    };
    let holds = |runs: &Vec<&Trajectory>| {
        of(runs, &STRETCHES).all(|run| {
            let (first, last) = heights(run);
            last < first
        })
    };
    let words: Vec<String> = members.first().map_or(Vec::new(), |runs| {
        let heights = of(runs, &STRETCHES).map(heights);
        heights.map(|(p, q)| format!("{p:.3} to {q:.3}")).collect()
    });
    judged(
        ("6.4.1-29", SECTION),
        "In those stretches the body bounces down along the boundary.",
        robust(members.iter().map(holds)),
        format!(
            "height at the first and the last of them: {}",
            words.join(", ")
        ),
        "The stretch is the first of the longest; with it not every figure goes down.",
    )
}

/// Difference of the snap velocities of cables 1 and 2, each a line through its clear impacts, at
/// times evenly spread over the span that they share; and that span.
fn difference(run: &Trajectory) -> (Vec<f64>, f64) {
    let hits = clear(run, CLEAR);
    let line = |cable: usize| -> Vec<(f64, f64)> {
        let own = hits.iter().filter(|hit| hit.cable == cable);
        own.map(|hit| (hit.t, hit.v_n)).collect()
    };
    let (one, two) = (line(0), line(1));
    let ends = |line: &[(f64, f64)]| Some((line.first()?.0, line.last()?.0));
    let (Some(p), Some(q)) = (ends(&one), ends(&two)) else {
        return (Vec::new(), 0.0);
    };
    let (from, to) = (p.0.max(q.0), p.1.min(q.1));
    let values = (0..=4000)
        .map(|k| from + (to - from) * f64::from(k) / 4000.0)
        .map(|t| on_line(&one, t) - on_line(&two, t))
        .collect();
    (values, to - from)
}

/// A line through points, at a time.
fn on_line(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.partition_point(|p| p.0 <= t);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some(p), Some(q)) => p.1 + (q.1 - p.1) * (t - p.0) / (q.0 - p.0),
        (Some(p), None) | (None, Some(p)) => p.1,
        (None, None) => f64::NAN,
    }
}

fn crossings(values: &[f64]) -> usize {
    let cross = |pair: &&[f64]| matches!(pair, [p, q] if (*p > 0.0) != (*q > 0.0));
    values.windows(2).filter(cross).count()
}

/// Share of the time in which cable 1 snaps harder.
fn share(run: &Trajectory) -> f64 {
    let (values, _) = difference(run);
    mean(values.iter().map(|d| f64::from(u8::from(*d > 0.0))))
}

/// The runs of one of the figures, by member.
fn figure<'a>(members: &'a Members<'a>, which: usize) -> Vec<&'a Trajectory> {
    let runs = members.iter().filter_map(|runs| runs.get(which));
    runs.copied().collect()
}

fn higher_on_one(members: &Members) -> Claim {
    let shares: Vec<f64> = figure(members, 0).into_iter().map(share).collect();
    let (low, high) = range(shares.iter().copied());
    judged(
        ("6.4.1-30", SECTION),
        "In Fig. 6.22 the snaps of one boundary are the harder ones all the time.",
        robust(shares.iter().map(|s| *s >= 0.95 || *s <= 0.05)),
        format!(
            "cable 1 is the harder for {:.0} to {:.0} % of the time",
            100.0 * low,
            100.0 * high
        ),
        "All but all of the time; a neighbour or more falls short of the 95 % asked for here.",
    )
}

/// Mean snap velocity and number of the clear impacts of the harder cable, then of the other.
fn harder_and_other(run: &Trajectory) -> [(f64, usize); 2] {
    let hits = clear(run, CLEAR);
    let of = |cable: usize| {
        let own = hits.iter().filter(|hit| hit.cable == cable);
        (mean(own.clone().map(|hit| hit.v_n)), own.count())
    };
    let (one, two) = (of(0), of(1));
    if one.0 >= two.0 {
        [one, two]
    } else {
        [two, one]
    }
}

fn grazes_the_other(members: &Members) -> Claim {
    let found: Vec<[(f64, usize); 2]> = figure(members, 0)
        .into_iter()
        .map(harder_and_other)
        .collect();
    let evidence = found.first().map_or(String::new(), |[hard, soft]| {
        format!(
            "mean {:.3} over {} snaps, and {:.3} over {}",
            hard.0, hard.1, soft.0, soft.1
        )
    });
    let holds = |[hard, soft]: &[(f64, usize); 2]| soft.0 < 0.6 * hard.0 && soft.1 > hard.1;
    judged(
        ("6.4.1-31", SECTION),
        "There the one boundary is grazed softly and often, the other struck hard.",
        robust(found.iter().map(holds)),
        evidence,
        "",
    )
}

/// How the distance of the two lines goes up and down: its extremes, the ends among them.
fn extremes(values: &[f64]) -> Vec<f64> {
    let distance: Vec<f64> = values.iter().map(|d| d.abs()).collect();
    let turning = distance.windows(3).filter_map(|three| match three {
        [p, q, r] if (q - p) * (r - q) < 0.0 => Some(*q),
        _ => None,
    });
    let ends = (distance.first().copied(), distance.last().copied());
    ends.0.into_iter().chain(turning).chain(ends.1).collect()
}

fn approaches(extremes: &[f64]) -> usize {
    let near = |three: &&[f64]| matches!(three, [p, q, r] if 3.0 * q < *p && 3.0 * q < *r);
    extremes.windows(3).filter(near).count()
}

fn serpentine(members: &Members) -> Claim {
    let lines: Vec<Vec<f64>> = figure(members, 3)
        .into_iter()
        .map(|run| difference(run).0)
        .collect();
    let holds = |d: &Vec<f64>| crossings(d) <= 1 && approaches(&extremes(d)) >= 1;
    let evidence = lines.first().map_or(String::new(), |d| {
        format!(
            "{} crossings; the lines are apart by {} in turn",
            crossings(d),
            list(&extremes(d), 3)
        )
    });
    judged(
        ("6.4.1-32", SECTION),
        "In Fig. 6.25 the snaps of the two boundaries draw near and part again without crossing.",
        robust(lines.iter().map(holds)),
        evidence,
        "",
    )
}

/// Crossings of the two lines per unit time.
fn crossing_rate(run: &Trajectory) -> f64 {
    let (values, span) = difference(run);
    if span > 0.0 {
        crossings(&values) as f64 / span
    } else {
        0.0
    }
}

fn braided(members: &Members) -> Claim {
    let holds = |runs: &Vec<&Trajectory>| {
        let (least, _) = range(of(runs, &BRAIDS).map(crossing_rate));
        let (_, most) = range(of(runs, &NO_BRAIDS).map(crossing_rate));
        least >= 0.5 && least > 2.0 * most
    };
    judged(
        ("6.4.1-33", SECTION),
        "In Figs 6.23 and 6.24 the two braid.",
        robust(members.iter().map(holds)),
        format!("crossings per T: {}", nominal(members, 2, crossing_rate)),
        "",
    )
}

/// Mean of the clear snap velocities with the force towards the boundary, then of the others.
fn by_force(run: &Trajectory) -> (f64, f64) {
    let system = run.system();
    let towards = |hit: &Impact| {
        let normal = system
            .cables
            .get(hit.cable)
            .map(|cable| cable.normal(&hit.before).n);
        let [nx, ny] = normal.unwrap_or_default();
        let force = system.forcing.harmonics.iter().map(|wave| {
            let (s, c) = (wave.omega * hit.t).sin_cos();
            let along = |v: [f64; 2]| nx * v[0] + ny * v[1];
            along(wave.cosine) * c + along(wave.sine) * s
        });
        force.sum::<f64>() > 0.0
    };
    let hits = clear(run, CLEAR);
    let of = |with: bool| {
        let some = hits.iter().filter(|hit| towards(hit) == with);
        mean(some.map(|hit| hit.v_n))
    };
    (of(true), of(false))
}

fn towards_the_boundary(members: &Members) -> Claim {
    let found: Vec<Vec<(f64, f64)>> = members
        .iter()
        .map(|runs| of(runs, &BRAIDS).map(by_force).collect())
        .collect();
    let all = |test: fn(&(f64, f64)) -> bool| found.iter().all(|means| means.iter().all(test));
    let verdict = match (
        all(|(with, against)| with > against),
        all(|(with, against)| with < against),
    ) {
        (true, _) => Verdict::Reproduced,
        (_, true) => Verdict::NotReproduced,
        _ => Verdict::NotDecidable,
    };
    let words: Vec<String> = found
        .first()
        .into_iter()
        .flatten()
        .map(|(with, against)| format!("{with:.3} and {against:.3}"))
        .collect();
    judged(
        ("6.4.1-34", SECTION),
        "Snaps are harder where the force acts towards the struck boundary at that instant.",
        verdict,
        format!(
            "frequency 0.75, 0.9: mean with the force and against it {}",
            words.join("; ")
        ),
        "The force of the instant hardly counts: between snaps it acts for a part of its period only, \
         and the velocity remembers former snaps.",
    )
}
