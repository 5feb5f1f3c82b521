//! Section 6.4.1: how the motion changes with restitution and with the force. The claims on the shape
//! and on the frequency have files of their own.

use super::near::{
    Near, ending, endings, exceeds, falling, judged, list, mean, nominal, places, range,
};
use super::{Claim, Verdict, ensemble, robust, section_6_4_1_shape, section_6_4_1_waves};
use crate::study::{Reading, Study};
use rayon::prelude::*;
use snapload::analysis::{CriticalForce, ForceScan, Outcome};
use snapload::{Case, CaseError, Parameters, State, Stop, Trajectory};

const SECTION: &str = "6.4.1";
/// e = 1, 0.9, 0.7, 0.5.
const RESTITUTIONS: [&str; 4] = [
    "1110001000-359",
    "1910001000-359",
    "1710001000-359",
    "1510001000-359",
];
/// f_o = 0.1, 0.2 … 0.5.
const FORCES: [&str; 5] = [
    "1910001000-159",
    "1910001000-259",
    "1910001000-359",
    "1910001000-459",
    "1910001000-559",
];

/// Checks the claims of this section.
///
/// # Errors
/// [`CaseError`] only for a fault of the program.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let near = Near::table(study, 8)?;
    let mut all = section_6_4_1_shape::claims(study, &near)?;
    all.extend(restitution(&near)?);
    all.extend(force(study, &near)?);
    all.extend(section_6_4_1_waves::claims(&near));
    Ok(all)
}

fn restitution(near: &Near) -> Result<Vec<Claim>, CaseError> {
    let members = near.of(&RESTITUTIONS);
    let elastic: Vec<&Trajectory> = members.iter().filter_map(|m| m.first().copied()).collect();
    Ok(vec![
        less_active(&members),
        velocities_fall(&members),
        longest(&members),
        chaotic(&elastic),
        elastic_rotates(&elastic),
        nothing_lost(&elastic),
        lower_loads(&members),
        settles_sooner(&members)?,
    ])
}

/// Length of the centre's path, range of x, and ρ3.
fn activity(run: &Trajectory) -> [f64; 3] {
    let points = places(run, (0.0, run.end().t), 0.01);
    let step = |pair: &[(f64, f64)]| match pair {
        [p, q] => (q.0 - p.0).hypot(q.1 - p.1),
        _ => 0.0,
    };
    let (low, high) = range(points.iter().map(|p| p.0));
    [
        points.windows(2).map(step).sum(),
        high - low,
        run.norms().rho3,
    ]
}

fn less_active(members: &[Vec<&Trajectory>]) -> Claim {
    let measured: Vec<[Vec<f64>; 3]> = members
        .par_iter()
        .map(|runs| {
            let all: Vec<[f64; 3]> = runs.iter().map(|run| activity(run)).collect();
            [
                all.iter().map(|[path, _, _]| *path).collect(),
                all.iter().map(|[_, x, _]| *x).collect(),
                all.iter().map(|[_, _, rho]| *rho).collect(),
            ]
        })
        .collect();
    let falls = |all: &[Vec<f64>; 3]| all.iter().all(|values| falling(values));
    let evidence = measured.first().map_or(String::new(), |[path, x, rho]| {
        let (path, x, rho) = (list(path, 2), list(x, 3), list(rho, 2));
        format!("path {path}; range of x {x}; sum of snap velocities {rho}")
    });
    judged(
        ("6.4.1-15", SECTION),
        "Motion is less active as e falls from 1 over 0.9 and 0.7 to 0.5.",
        robust(measured.iter().map(falls)),
        evidence,
        "",
    )
}

/// Mean snap velocity in the second half of the time over that in the first.
fn later_to_earlier(run: &Trajectory) -> f64 {
    let half = run.end().t / 2.0;
    let of = |late: bool| {
        let hits = run
            .impacts()
            .iter()
            .filter(move |hit| (hit.t >= half) == late);
        mean(hits.map(|hit| hit.v_n))
    };
    of(true) / of(false)
}

fn velocities_fall(members: &[Vec<&Trajectory>]) -> Claim {
    let holds = |runs: &Vec<&Trajectory>| match runs.split_first() {
        Some((elastic, others)) => {
            let others = others.iter().all(|run| later_to_earlier(run) < 0.5);
            others && later_to_earlier(elastic) > 0.8
        }
        None => false,
    };
    judged(
        ("6.4.1-16", SECTION),
        "Snap velocities fall with time where e < 1, and do not where e = 1.",
        robust(members.iter().map(holds)),
        format!(
            "mean in the second half of the run over that in the first: {}",
            nominal(members, 3, later_to_earlier)
        ),
        "",
    )
}

fn longest(members: &[Vec<&Trajectory>]) -> Claim {
    let holds = |runs: &Vec<&Trajectory>| match runs.split_first() {
        Some((elastic, others)) => {
            let (_, last) = range(others.iter().map(|run| run.end().t));
            elastic.end().t > 2.0 * last
        }
        None => false,
    };
    judged(
        ("6.4.1-17", SECTION),
        "The run with e = 1 needs a longer axis of time than the others.",
        robust(members.iter().map(holds)),
        format!("runs end at {}", nominal(members, 2, |run| run.end().t)),
        "",
    )
}

fn apart(a: &State, b: &State) -> f64 {
    let differences = [
        a.x - b.x,
        a.y - b.y,
        a.theta - b.theta,
        a.vx - b.vx,
        a.vy - b.vy,
        a.vtheta - b.vtheta,
    ];
    differences
        .into_iter()
        .fold(0.0, |most, d| most.max(d.abs()))
}

/// The largest difference from the first run at the k-th impact; none once the cables differ.
fn divergence(runs: &[&Trajectory], k: usize) -> Option<f64> {
    let (first, others) = runs.split_first()?;
    let hit = first.impacts().get(k.checked_sub(1)?)?;
    others.iter().try_fold(0.0_f64, |most, run| {
        let other = run.impacts().get(k - 1)?;
        let same = other.cable == hit.cable;
        same.then(|| most.max(apart(&hit.before, &other.before)))
    })
}

fn chaotic(elastic: &[&Trajectory]) -> Claim {
    let at = |k: usize| divergence(elastic, k);
    let found = (at(1), at(9), at(90));
    let same_order = (1..=90).all(|k| at(k).is_some());
    let holds = match found {
        (Some(first), _, Some(last)) => same_order && last > 1e3 * first,
        _ => false,
    };
    let evidence = match found {
        (Some(first), Some(early), Some(last)) => format!(
            "starts 1e-12 apart differ by {first:.0e} at impact 1, {early:.0e} at 9, {last:.0e} at 90: \
             tenfold every {:.0} impacts",
            81.0 / (last / early).log10()
        ),
        _ => "neighbours struck the cables in another order within 90 impacts".to_owned(),
    };
    judged(
        ("6.4.1-18", SECTION),
        "The case with e = 1 is chaotic.",
        Verdict::of(holds),
        evidence,
        "",
    )
}

fn elastic_rotates(elastic: &[&Trajectory]) -> Claim {
    let evidence = elastic.first().map_or(String::new(), |run| {
        format!("{} after {} impacts", ending(run), run.impacts().len())
    });
    judged(
        ("6.4.1-19", SECTION),
        "With e = 1 the rotation passes its limit and the run stops.",
        robust(
            elastic
                .iter()
                .map(|run| run.end().reason == Stop::RotationLimit),
        ),
        evidence,
        "",
    )
}

fn nothing_lost(elastic: &[&Trajectory]) -> Claim {
    let lost = |run: &Trajectory| -> f64 { run.impacts().iter().map(|hit| hit.energy_lost).sum() };
    let small = |run: &&Trajectory| lost(run).abs() < 1e-12 * run.impacts().len() as f64;
    let (_, most) = range(elastic.iter().map(|run| lost(run).abs()));
    judged(
        ("6.4.1-20", SECTION),
        "With e = 1 the impacts lose no energy.",
        robust(elastic.iter().map(small)),
        format!("lost in all impacts: {most:.0e}"),
        "",
    )
}

fn lower_loads(members: &[Vec<&Trajectory>]) -> Claim {
    let rho = |run: &Trajectory| run.norms().rho1;
    let impulse = |run: &Trajectory| range(run.impacts().iter().map(|hit| hit.impulse)).1;
    let falls = |runs: &Vec<&Trajectory>| {
        let values: Vec<f64> = runs.iter().map(|run| rho(run)).collect();
        falling(&values)
    };
    judged(
        ("6.4.1-21", SECTION),
        "A lower e goes with lower snap loads.",
        robust(members.iter().map(falls)),
        format!(
            "e = 1, 0.9, 0.7, 0.5: largest snap velocity {}; largest impulse {}",
            nominal(members, 3, rho),
            nominal(members, 3, impulse)
        ),
        "",
    )
}

fn settles_sooner(members: &[Vec<&Trajectory>]) -> Result<Claim, CaseError> {
    let times = |runs: &Vec<&Trajectory>| -> Vec<f64> {
        let settled = runs.iter().filter(|run| run.end().reason == Stop::Settled);
        settled.map(|run| run.end().t).collect()
    };
    let holds = |runs: &Vec<&Trajectory>| {
        let times = times(runs);
        times.len() == 3 && falling(&times)
    };
    // From 0.95 down to 0.5.
    let fine: Vec<(Stop, f64)> = (0..10)
        .into_par_iter()
        .map(|k| {
            let e = f64::from(95 - 5 * k) / 100.0;
            let case = Parameters {
                e,
                ..Parameters::STANDARD
            };
            let end = Outcome::of(&Case::new(Reading::Chapter.apply(case))?).end;
            Ok((end.reason, end.t))
        })
        .collect::<Result<_, CaseError>>()?;
    let settled = fine.iter().filter(|(reason, _)| *reason == Stop::Settled);
    let fine: Vec<f64> = settled.map(|(_, t)| *t).collect();
    let back = fine.windows(2).filter(|pair| !falling(pair)).count();
    let evidence = format!(
        "settles at {} with e = 0.9, 0.7, 0.5; in steps of 0.05 from 0.95 {} settle, at {} ({back} steps \
         the other way)",
        members
            .first()
            .map_or(String::new(), |runs| list(&times(runs), 3)),
        fine.len(),
        list(&fine, 2)
    );
    Ok(judged(
        ("6.4.1-22", SECTION),
        "The lower e, the sooner the body settles.",
        robust(members.iter().map(holds)),
        evidence,
        "",
    ))
}

fn force(study: &Study, near: &Near) -> Result<Vec<Claim>, CaseError> {
    let members = near.of(&FORCES);
    let first_critical = critical_forces(8)?;
    let row = study
        .critical
        .iter()
        .find(|row| row.r == 1.5 && row.size == [0.1, 0.0]);
    Ok(vec![
        tenths(&members),
        hundredths(&first_critical),
        settles_above_critical(
            &members,
            &first_critical,
            row.map(|row| &row.computed.chapter),
        ),
    ])
}

/// The critical force of the standard case and of its neighbours.
fn critical_forces(neighbours: usize) -> Result<Vec<Option<f64>>, CaseError> {
    ensemble(&Reading::Chapter.apply(Parameters::STANDARD), neighbours)
        .into_par_iter()
        .map(|member| {
            for f_o in ForceScan::default().amplitudes() {
                if Outcome::of(&Case::new(Parameters { f_o, ..member })?).exceeds() {
                    return Ok(Some(f_o));
                }
            }
            Ok(None)
        })
        .collect()
}

fn tenths(members: &[Vec<&Trajectory>]) -> Claim {
    let only_last = |runs: &Vec<&Trajectory>| match runs.split_last() {
        Some((last, others)) => exceeds(last) && !others.iter().any(|run| exceeds(run)),
        None => false,
    };
    judged(
        ("6.4.1-23", SECTION),
        "In steps of 0.1 the force first brings about the rotation limit at 0.5.",
        robust(members.iter().map(only_last)),
        endings(members),
        "",
    )
}

fn hundredths(critical: &[Option<f64>]) -> Claim {
    let (low, high) = range(critical.iter().flatten().copied());
    judged(
        ("6.4.1-24", SECTION),
        "In steps of 0.01 it does so first at 0.31.",
        robust(critical.iter().map(|f_o| *f_o == Some(0.31))),
        format!(
            "first at {low:.2} to {high:.2} in {} members",
            critical.len()
        ),
        "",
    )
}

fn settles_above_critical(
    members: &[Vec<&Trajectory>],
    critical: &[Option<f64>],
    scan: Option<&CriticalForce>,
) -> Claim {
    let settles = |runs: &Vec<&Trajectory>| {
        let settled = |run: &&Trajectory| run.end().reason == Stop::Settled;
        matches!(runs.split_last(), Some((_, others)) if others.iter().all(settled))
    };
    let below = |first: &Option<f64>| first.is_some_and(|f_o| f_o < 0.4);
    let holds = members
        .iter()
        .zip(critical)
        .map(|(runs, first)| settles(runs) && below(first));
    let at: Vec<f64> = members
        .iter()
        .filter_map(|runs| Some(runs.get(3)?.end().t))
        .collect();
    let (low, high) = range(at);
    let exceeding = scan.map_or(&[][..], |scan| &scan.exceeding).iter().take(4);
    let exceeding: Vec<String> = exceeding.map(|[a, b]| format!("{a:.2}-{b:.2}")).collect();
    judged(
        ("6.4.1-25", SECTION),
        "All forces of the series below 0.5 settle, even 0.4, which is above the critical one.",
        robust(holds),
        format!(
            "0.4 ends at t = {low:.2} to {high:.2}; forces that exceed: {} …",
            exceeding.join(", ")
        ),
        "",
    )
}
