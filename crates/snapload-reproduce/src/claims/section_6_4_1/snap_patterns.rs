//! Section 6.4.1: the frequency of the forcing, and the snaps of the two cables.

use crate::claims::motions::{CLEAR, attachment_speed, clear, endings, exceeds, push, rotation};
use crate::claims::numbers::{list, marked_over_others, max, mean, min, rising, span, spearman};
use crate::claims::runs::{by_case, measured};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::Impact;
use snapload_verify::RoundedRun;

/// Figs 6.22-6.26: Ω = 0.5, 0.75, 0.9, 1.5, 2.0.
pub(super) const FREQUENCIES: [&str; 5] = [
    "1910001000-355",
    "1910001000-3575",
    "1910001000-359",
    "1910001000-3515",
    "1910001000-3520",
];
type Runs<'a> = [&'a RoundedRun; 5];
/// The figures among these that have sequences of one mark.
const WITH_ONE_CABLE: [usize; 3] = [0, 2, 4];
/// The figures that the chapter compares with braids.
const BRAIDS: [usize; 2] = [1, 2];

pub(super) const CHECKS: &Checks<fn(&[Runs]) -> Checked> = &[
    ("6.4.1-26", |members| {
        let only_last = |runs: &Runs| runs.map(exceeds) == [false, false, false, false, true];
        Ok(Finding::robust(members, only_last).value("endings", endings(members)))
    }),
    ("6.4.1-27", |members| {
        let own = members[0].map(rotation);
        let back = own.windows(2).filter(|pair| !rising(pair)).count();
        Ok(measured("rotations", members, rotation, |all| rising(all))
            .value("back", back)
            .condition("ends", own[0] < own[4]))
    }),
    ("6.4.1-28", |members| {
        /// The least snap velocity that is easy to see in a plot.
        const PLAIN: f64 = 3.0 * CLEAR;
        let longer = |runs: &Runs, above| {
            let with = WITH_ONE_CABLE.map(|k| longest(runs[k], above));
            with.iter().min() > [1, 3].map(|k| longest(runs[k], above)).iter().max()
        };
        let lengths = |above: f64| {
            let of = move |runs: &Runs| runs.map(|run| longest(run, above) as f64);
            members.iter().map(of).collect::<Vec<_>>()
        };
        let finding = Finding::robust(members, |runs| longer(runs, CLEAR) && longer(runs, PLAIN));
        Ok(finding
            .values("plain_above clear_above", [PLAIN, CLEAR])
            .by_start("plain", lengths(PLAIN))
            .by_start("clear", lengths(CLEAR)))
    }),
    ("6.4.1-29", down_a_boundary),
    ("6.4.1-30", |members| {
        /// A share of the time, in per cent, from which on a plot looks uniform.
        const THROUGHOUT: f64 = 90.0;
        let by_start = members.iter().map(|runs| share(runs[0]));
        let throughout = |share: f64| share.max(100.0 - share) >= THROUGHOUT;
        Ok(Finding::measured("by_start", by_start, throughout)
            .by_start("by_figure", members.iter().map(|runs| runs.map(share)))
            .value("throughout", THROUGHOUT))
    }),
    ("6.4.1-31", |members| {
        /// The largest ratio of the velocities of grazing and of direct snaps.
        const SOFT: f64 = 0.6;
        let found = members.iter().map(|runs| harder_and_other(runs[0]));
        let found: Vec<[[f64; 2]; 2]> = found.collect();
        let grazes = |[hard, soft]: &[[f64; 2]; 2]| soft[0] < SOFT * hard[0] && soft[1] < hard[1];
        let speeds = found.iter().map(|[hard, soft]| [hard[0], soft[0]]);
        let shares = found.iter().map(|[hard, soft]| [hard[1], soft[1]]);
        Ok(Finding::robust(&found, grazes)
            .by_start("speeds", speeds)
            .by_start("shares", shares)
            .values("soft clear", [SOFT, CLEAR]))
    }),
    ("6.4.1-32", |members| {
        let lines: Vec<Vec<f64>> = members.iter().map(|runs| difference(runs[3]).0).collect();
        Ok(Finding::robust(&lines, |line| nears_and_parts(line))
            .list("crossings", lines.iter().map(|line| crossings(line) as f64))
            .list("extremes", extremes(&lines[0]))
            .values("near clear", [NEAR, CLEAR]))
    }),
    ("6.4.1-33", |members| {
        let braided = measured("rates", members, crossing_rate, cross_more_often);
        Ok(braided.values(
            "often more clear",
            [LEAST_CROSSING_RATE, LEAST_RATIO, CLEAR],
        ))
    }),
    ("6.4.1-34", towards_the_boundary),
];

/// Sequences of impacts above some velocity on one cable.
fn on_one_cable(run: &RoundedRun, above: f64) -> Vec<Vec<&Impact>> {
    let hits: Vec<&Impact> = run.impacts().iter().filter(|hit| hit.v_n > above).collect();
    hits.chunk_by(|p, q| p.cable == q.cable)
        .map(<[_]>::to_vec)
        .collect()
}

fn longest(run: &RoundedRun, above: f64) -> usize {
    let lengths = on_one_cable(run, above).into_iter().map(|hits| hits.len());
    lengths.max().unwrap_or(0)
}

/// The least number of snaps in a sequence.
const SEVERAL: usize = 5;

/// The rise of the body over each sequence of clear snaps.
fn rises(run: &RoundedRun) -> Vec<f64> {
    let long = on_one_cable(run, CLEAR)
        .into_iter()
        .filter(|hits| hits.len() >= SEVERAL);
    long.map(|hits| hits[hits.len() - 1].before.y - hits[0].before.y)
        .collect()
}

fn down_a_boundary(members: &[Runs]) -> Checked {
    /// The least rise that is visible in a plot.
    const SEEN: f64 = 0.05;
    // The body falls in more of these sequences than it rises in.
    let all = by_case(members, |run| {
        let rises = rises(run);
        2 * rises.iter().filter(|rise| **rise < 0.0).count() > rises.len()
    });
    let verdicts = WITH_ONE_CABLE.map(|k| all[k]);
    let own = WITH_ONE_CABLE.map(|k| rises(members[0][k]));
    let up = max(own.iter().flatten().copied());
    Ok(Finding::new(Verdict::families(verdicts))
        .value("rises", own.map(|rises| list(&rises, 3)).join("; "))
        .value("sure", Verdict::Reproduced.count(verdicts))
        .values("up clear several", [up, CLEAR, SEVERAL as f64])
        .condition("rises_too", up >= SEEN))
}

/// Difference of the snap velocities of cables 1 and 2, each interpolated linearly between its
/// clear impacts, at times evenly spaced over their common span; and that span.
fn difference(run: &RoundedRun) -> (Vec<f64>, f64) {
    let line = |cable: usize| -> Vec<(f64, f64)> {
        let own = clear(run).filter(|hit| hit.cable == cable);
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

/// Linear interpolation between points, at a time.
fn on_line(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.partition_point(|p| p.0 <= t);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some(p), Some(q)) => p.1 + (q.1 - p.1) * (t - p.0) / (q.0 - p.0),
        (Some(p), None) | (None, Some(p)) => p.1,
        (None, None) => f64::NAN,
    }
}

fn crossings(values: &[f64]) -> usize {
    let cross = |pair: &&[f64]| (pair[0] > 0.0) != (pair[1] > 0.0);
    values.windows(2).filter(cross).count()
}

/// Lines count as near if their distance is below this part of that before and after.
const NEAR: f64 = 1.0 / 3.0;

/// Whether two lines, given their difference, approach each other and separate without crossing.
fn nears_and_parts(difference: &[f64]) -> bool {
    let near = |three: &[f64]| three[1] < NEAR * three[0].min(three[2]);
    crossings(difference) == 0 && extremes(difference).windows(3).any(near)
}

/// Lines count as braids if they cross at least this often per T, and this many times as often as
/// the others.
const LEAST_CROSSING_RATE: f64 = 0.5;
const LEAST_RATIO: f64 = 2.0;

/// Whether the crossing rates of the braids exceed those of the other figures.
fn cross_more_often(rates: &[f64; 5]) -> bool {
    let least = min(BRAIDS.map(|k| rates[k]));
    least >= LEAST_CROSSING_RATE && least > LEAST_RATIO * max([0, 3, 4].map(|k| rates[k]))
}

/// Crossings of the two lines per unit time.
fn crossing_rate(run: &RoundedRun) -> f64 {
    let (values, span) = difference(run);
    if span > 0.0 {
        crossings(&values) as f64 / span
    } else {
        0.0
    }
}

/// Share of the time, in per cent, in which cable 1 snaps harder.
fn share(run: &RoundedRun) -> f64 {
    let (values, _) = difference(run);
    100.0 * mean(values.iter().map(|d| f64::from(u8::from(*d > 0.0))))
}

/// Mean snap velocity, and its mean share of the attachment's speed, at the clear impacts of the
/// cable that snaps harder, then of the other.
fn harder_and_other(run: &RoundedRun) -> [[f64; 2]; 2] {
    let of = |cable: usize| {
        let own = clear(run).filter(|hit| hit.cable == cable);
        let share = own.clone();
        let share = share.map(|hit| hit.v_n / attachment_speed(run.system(), cable, &hit.before));
        [mean(own.map(|hit| hit.v_n)), mean(share)]
    };
    let (one, two) = (of(0), of(1));
    if one[0] >= two[0] {
        [one, two]
    } else {
        [two, one]
    }
}

/// The local extremes of the distance of the two lines, including the ends.
fn extremes(values: &[f64]) -> Vec<f64> {
    let distance: Vec<f64> = values.iter().map(|d| d.abs()).collect();
    let turning = distance
        .windows(3)
        .filter(|three| (three[1] - three[0]) * (three[2] - three[1]) < 0.0)
        .map(|three| three[1]);
    let ends = (distance.first().copied(), distance.last().copied());
    ends.0.into_iter().chain(turning).chain(ends.1).collect()
}

/// Ratio of the mean snap velocity where the force pushes towards the struck cable to that where it
/// does not; by the force at the instant of the impact, and by its mean since the previous impact.
fn with_over_against(run: &RoundedRun) -> [f64; 2] {
    let system = run.system();
    let pairs = run.impacts().windows(2).filter(|pair| pair[1].v_n > CLEAR);
    let pushes: Vec<([f64; 2], f64)> = pairs
        .map(|pair| {
            let (from, hit) = (pair[0].t, &pair[1]);
            let push = |t: f64| push(system, hit.cable, t, &hit.before);
            let times = (0..16).map(|k| from + (hit.t - from) * (f64::from(k) + 0.5) / 16.0);
            ([push(hit.t), mean(times.map(push))], hit.v_n)
        })
        .collect();
    [0, 1]
        .map(|which| marked_over_others(pushes.iter().map(|(push, v_n)| (push[which] > 0.0, *v_n))))
}

/// Rank correlation of a snap velocity with the one before it on the same cable.
fn memory(run: &RoundedRun) -> f64 {
    let pairs = [0, 1].map(|cable| {
        let own = clear(run).filter(move |hit| hit.cable == cable);
        let later = own.clone().skip(1);
        own.zip(later)
            .map(|(p, q)| (p.v_n, q.v_n))
            .collect::<Vec<_>>()
    });
    spearman(&pairs.concat())
}

fn towards_the_boundary(members: &[Runs]) -> Checked {
    // By definition of the force at a snap, figure and start.
    let ratios = [0, 1].map(|which| {
        BRAIDS.map(|k| {
            let ratios = members.iter().map(|runs| with_over_against(runs[k]));
            ratios.map(|ratios| ratios[which]).collect()
        })
    });
    let harder = |of: &Vec<f64>| Verdict::robust(of.iter().map(|ratio| *ratio > 1.0));
    let verdicts = ratios
        .each_ref()
        .map(|figures| Verdict::all(figures.each_ref().map(harder)));
    let words = ratios.map(|figures| figures.map(|of| span(of, 2)).join(", "));
    let memories = members.iter().map(|runs| BRAIDS.map(|k| memory(runs[k])));
    let memories: Vec<f64> = memories.flatten().collect();
    // It is enough if the claim holds for one definition of the force at a snap.
    Ok(Finding::new(Verdict::any(verdicts))
        .values("at_the_snap on_the_mean", words)
        .value("clear", CLEAR)
        .condition("remembered", memories.iter().all(|rho| *rho > 0.5))
        .list("memories", memories))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_cross_or_stay_apart_do_not_draw_near_and_part() {
        assert!(nears_and_parts(&[3.0, 2.0, 0.5, 2.0, 3.0]));
        assert!(!nears_and_parts(&[3.0, 2.0, -0.5, 2.0, 3.0]));
        assert!(!nears_and_parts(&[3.0, 2.5, 2.0, 2.5, 3.0]) && !nears_and_parts(&[]));
    }

    #[test]
    fn lines_that_cross_as_often_elsewhere_are_no_braids() {
        assert!(cross_more_often(&[0.3, 1.0, 0.8, 0.0, 0.1]));
        assert!(
            !cross_more_often(&[0.5, 1.0, 0.8, 0.0, 0.1])
                && !cross_more_often(&[0.0, 1.0, 0.4, 0.0, 0.0])
        );
    }
}
