//! Section 6.4.1: the frequency of the forcing, and the snaps of the two cables.

use crate::claims::numbers::{list, mean, range, rising, span, spearman};
use crate::claims::runs::{CLEAR, Tabled, clear, endings, exceeds, nominal};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use snapload::{Impact, Trajectory};

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
type Members<'a> = [Vec<&'a Trajectory>];

pub(super) fn claims(tabled: &Tabled) -> Vec<Claim> {
    let members = tabled.of(&FREQUENCIES);
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
    claim(
        "6.4.1-26",
        "The body stays within the limits with frequencies 0.5, 0.75, 0.9 and 1.5, not with 2.0.",
        Finding::new(Verdict::robust(members.iter().map(holds)), endings(members)),
    )
}

fn grows(members: &Members) -> Claim {
    let rotation = |run: &Trajectory| run.norms().theta_max;
    let holds = |runs: &Vec<&Trajectory>| {
        let values: Vec<f64> = runs.iter().map(|run| rotation(run)).collect();
        rising(&values)
    };
    let own: Vec<f64> = members
        .first()
        .into_iter()
        .flatten()
        .map(|run| rotation(run))
        .collect();
    let back = own.windows(2).filter(|pair| !rising(pair)).count();
    let ends = own.first() < own.last();
    claim(
        "6.4.1-27",
        "The rotations get larger with the frequency.",
        Finding::new(
            Verdict::robust(members.iter().map(holds)),
            format!("largest rotation {}", nominal(members, 3, rotation)),
        )
        .because(
            Verdict::NotReproduced,
            ends,
            format!("It holds of the ends of the range; steps the other way: {back} of 4."),
        ),
    )
}

/// What is still plain to see in a plot.
const PLAIN: f64 = 3.0 * CLEAR;

/// The longest run of impacts above some velocity on one cable; the first of equal ones.
fn longest(run: &Trajectory, above: f64) -> Vec<&Impact> {
    let hits: Vec<&Impact> = run.impacts().iter().filter(|hit| hit.v_n > above).collect();
    let mut best: &[&Impact] = &[];
    for stretch in hits.chunk_by(|p, q| p.cable == q.cable) {
        if stretch.len() > best.len() {
            best = stretch;
        }
    }
    best.to_vec()
}

fn one_mark_only(members: &Members) -> Claim {
    let length = |run: &Trajectory, above: f64| longest(run, above).len();
    let holds = |runs: &Vec<&Trajectory>| {
        [CLEAR, PLAIN].into_iter().all(|above| {
            let with = of(runs, &STRETCHES).map(|run| length(run, above)).min();
            let without = of(runs, &NO_STRETCHES).map(|run| length(run, above)).max();
            with > without
        })
    };
    let lengths = |above: f64| nominal(members, 0, |run| length(run, above) as f64);
    claim(
        "6.4.1-28",
        "Figs 6.22, 6.24 and 6.26 have stretches of marks of one boundary only; the other two do \
         not.",
        Finding::new(
            Verdict::robust(members.iter().map(holds)),
            format!(
                "most snaps in a row on one cable: {} (v_n > {PLAIN}), {} (v_n > {CLEAR})",
                lengths(PLAIN),
                lengths(CLEAR)
            ),
        ),
    )
}

/// Stretches of at least five clear snaps on one cable: by how much the body rises over each.
fn rises(run: &Trajectory) -> Vec<f64> {
    let hits: Vec<&Impact> = clear(run).collect();
    let stretches = hits.chunk_by(|p, q| p.cable == q.cable);
    let rise = |hits: &[&Impact]| match hits {
        [first, .., last] if hits.len() >= 5 => Some(last.before.y - first.before.y),
        _ => None,
    };
    stretches.filter_map(rise).collect()
}

fn down_a_boundary(members: &Members) -> Claim {
    // More fall in such stretches than rise.
    let down = |run: &&Trajectory| {
        let rises = rises(run);
        let falls = rises.iter().filter(|rise| **rise < 0.0).count();
        2 * falls > rises.len()
    };
    let verdicts: Vec<Verdict> = STRETCHES
        .iter()
        .map(|k| Verdict::robust(figure(members, *k).iter().map(down)))
        .collect();
    let words = STRETCHES.iter().map(|k| {
        let runs = figure(members, *k);
        let own = runs.first().map(|run| rises(run)).unwrap_or_default();
        list(&own, 3)
    });
    let own = members.first().map_or(&[][..], Vec::as_slice);
    let (_, up) = range(of(own, &STRETCHES).flat_map(rises));
    let sure = verdicts
        .iter()
        .filter(|v| **v == Verdict::Reproduced)
        .count();
    claim(
        "6.4.1-29",
        "In those stretches the body bounces down along the boundary.",
        Finding::new(
            Verdict::all(verdicts),
            format!(
                "rise over each stretch of five or more snaps on one cable: {}; most fall from \
                 every start in {sure} of 3 figures",
                words.collect::<Vec<_>>().join("; ")
            ),
        )
        .because(
            Verdict::NotReproduced,
            up >= 0.05,
            format!(
                "It bounces up along a boundary in just such a stretch, too, by up to {up:.3}."
            ),
        ),
    )
}

/// Difference of the snap velocities of cables 1 and 2, each a line through its clear impacts, at
/// times evenly spread over the span that they share; and that span.
fn difference(run: &Trajectory) -> (Vec<f64>, f64) {
    let hits: Vec<&Impact> = clear(run).collect();
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
    /// A share of the time with which a plot looks the same throughout.
    const THROUGHOUT: f64 = 0.9;
    let shares: Vec<f64> = figure(members, 0).into_iter().map(share).collect();
    let one_sided = |s: &f64| s.max(1.0 - s) >= THROUGHOUT;
    claim(
        "6.4.1-30",
        "In Fig. 6.22 the snaps of one boundary are the harder ones throughout.",
        Finding::new(
            Verdict::robust(shares.iter().map(one_sided)),
            format!(
                "cable 1 is the harder for {} % of the time by start; in Figs 6.22-6.26 for {} %",
                span(shares.iter().map(|s| 100.0 * s), 0),
                nominal(members, 0, |run| 100.0 * share(run))
            ),
        ),
    )
}

/// Mean snap velocity, and mean share of it in the speed of the attachment, at the clear impacts of the
/// harder cable, then of the other.
fn harder_and_other(run: &Trajectory) -> [[f64; 2]; 2] {
    let speed = |hit: &Impact| {
        let (s, c) = hit.before.theta.sin_cos();
        let lever = run
            .system()
            .cables
            .get(hit.cable)
            .map(|cable| cable.lever(s, c).components());
        let [x, y] = lever.unwrap_or_default();
        let turn = hit.before.vtheta;
        (hit.before.vx - turn * y).hypot(hit.before.vy + turn * x)
    };
    let of = |cable: usize| {
        let own = clear(run).filter(|hit| hit.cable == cable);
        let share = own.clone().map(|hit| hit.v_n / speed(hit));
        [mean(own.map(|hit| hit.v_n)), mean(share)]
    };
    let (one, two) = (of(0), of(1));
    if one[0] >= two[0] {
        [one, two]
    } else {
        [two, one]
    }
}

fn grazes_the_other(members: &Members) -> Claim {
    let runs = figure(members, 0);
    let found: Vec<[[f64; 2]; 2]> = runs.into_iter().map(harder_and_other).collect();
    let evidence = found.first().map_or(String::new(), |[hard, soft]| {
        format!(
            "mean snap velocity {:.3} and {:.3}; its mean share in the speed of the attachment \
             {:.2} and {:.2}",
            hard[0], soft[0], hard[1], soft[1]
        )
    });
    let holds = |[hard, soft]: &[[f64; 2]; 2]| soft[0] < 0.6 * hard[0] && soft[1] < hard[1];
    claim(
        "6.4.1-31",
        "There the one boundary is grazed, the other struck more directly.",
        Finding::new(Verdict::robust(found.iter().map(holds)), evidence),
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
    claim(
        "6.4.1-32",
        "In Fig. 6.25 the snaps of the two boundaries draw near and part again without crossing.",
        Finding::new(Verdict::robust(lines.iter().map(holds)), evidence),
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
    claim(
        "6.4.1-33",
        "In Figs 6.23 and 6.24 the two braid.",
        Finding::new(
            Verdict::robust(members.iter().map(holds)),
            format!("crossings per T: {}", nominal(members, 2, crossing_rate)),
        ),
    )
}

/// The push of the wave force towards the struck cable, at the instant of the impact and on the mean
/// since the one before it, with its snap velocity.
fn pushes(run: &Trajectory) -> Vec<([f64; 2], f64)> {
    let system = run.system();
    let weight = system.forcing.constant.y;
    let push = |hit: &Impact, t: f64| {
        let normal = system
            .cables
            .get(hit.cable)
            .map(|c| c.normal(&hit.before).n.components());
        let [nx, ny] = normal.unwrap_or_default();
        let [fx, fy] = system.forcing.at(t).components();
        nx * fx + ny * (fy - weight)
    };
    let pairs = run.impacts().windows(2).filter_map(|pair| match pair {
        [before, hit] if hit.v_n > CLEAR => Some((before.t, hit)),
        _ => None,
    });
    pairs
        .map(|(from, hit)| {
            let times = (0..16).map(|k| from + (hit.t - from) * (f64::from(k) + 0.5) / 16.0);
            (
                [push(hit, hit.t), mean(times.map(|t| push(hit, t)))],
                hit.v_n,
            )
        })
        .collect()
}

/// Mean snap velocity where the force pushes towards the cable over that where it does not.
fn with_over_against(pushes: &[([f64; 2], f64)], which: usize) -> f64 {
    let of = |with: bool| {
        let some = pushes.iter().filter(|p| (p.0[which] > 0.0) == with);
        mean(some.map(|p| p.1))
    };
    of(true) / of(false)
}

/// Rank correlation of a snap velocity with the one before it on the same cable.
fn memory(run: &Trajectory) -> f64 {
    let hits: Vec<&Impact> = clear(run).collect();
    let points = [0, 1].iter().flat_map(|cable| {
        let own: Vec<f64> = hits
            .iter()
            .filter(|hit| hit.cable == *cable)
            .map(|hit| hit.v_n)
            .collect();
        own.windows(2)
            .map(|pair| (pair[0], pair[1]))
            .collect::<Vec<_>>()
    });
    spearman(&points.collect::<Vec<_>>())
}

fn towards_the_boundary(members: &Members) -> Claim {
    let ratios = |which: usize| -> Vec<Vec<f64>> {
        let of = |k: &usize| {
            let runs = figure(members, *k).into_iter().map(pushes);
            runs.map(|found| with_over_against(&found, which)).collect()
        };
        BRAIDS.iter().map(of).collect()
    };
    let both = [0, 1].map(ratios);
    let verdict = |all: &Vec<Vec<f64>>| {
        Verdict::all(
            all.iter()
                .map(|of| Verdict::robust(of.iter().map(|r| *r > 1.0))),
        )
    };
    let words = both.each_ref().map(|all| {
        let spans: Vec<String> = all.iter().map(|of| span(of.iter().copied(), 2)).collect();
        spans.join(", ")
    });
    let verdicts = both.each_ref().map(verdict);
    let memories = || {
        members
            .iter()
            .flat_map(|runs| of(runs, &BRAIDS))
            .map(memory)
    };
    claim(
        "6.4.1-34",
        "Snaps are harder where the force acts towards the struck boundary.",
        Finding::new(
            // Either reading of the force at a snap would do.
            Verdict::any(verdicts),
            format!(
                "Ω = 0.75, 0.9: mean snap velocity with the force over that against it, by the \
                 force at the snap {}, by the mean force since the snap before {}",
                words[0], words[1]
            ),
        )
        .because(
            Verdict::NotReproduced,
            memories().all(|rho| rho > 0.5),
            format!(
                "How hard a snap is follows from the one before it on the same cable (rank \
                 correlation {}) more than from the force of the moment.",
                span(memories(), 2)
            ),
        ),
    )
}
