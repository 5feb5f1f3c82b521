//! Section 6.4.1: how the motion changes with restitution and with the force. The claims on the region,
//! on rotations and on the frequency have files of their own.

mod region;
mod rotation;
mod waves;

use super::numbers::{falling, list, mean, range, span};
use super::runs::{
    MANY, Tabled, chapter, ending, endings, ensemble, exceeds, near, nominal, of_all, places,
};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::{Study, first_exceeding};
use rayon::prelude::*;
use snapload::analysis::{CriticalForce, ForceScan};
use snapload::{CaseError, Outcome, Parameters, Playback, State, Stop, Trajectory};

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
pub(super) fn claims(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    let mut all = region::claims(study, tabled);
    all.extend(rotation::claims(study, tabled)?);
    all.extend(restitution(study, tabled)?);
    all.extend(force(study, tabled)?);
    all.extend(waves::claims(tabled));
    Ok(all)
}

fn restitution(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    let members = tabled.of(&RESTITUTIONS);
    let elastic: Vec<&Trajectory> = members.iter().filter_map(|m| m.first().copied()).collect();
    Ok(vec![
        less_active(&members),
        velocities_fall(&members),
        longest(&members),
        chaotic(&elastic),
        chaos_of_forcing(study, &elastic)?,
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
    claim(
        "6.4.1-15",
        "Motion is less active as e falls from 1 over 0.9 and 0.7 to 0.5.",
        Finding::new(Verdict::robust(measured.iter().map(falls)), evidence),
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
    claim(
        "6.4.1-16",
        "Snap velocities fall with time where e < 1, and do not where e = 1.",
        Finding::new(
            Verdict::robust(members.iter().map(holds)),
            format!(
                "mean in the second half of the run over that in the first: {}",
                nominal(members, 3, later_to_earlier)
            ),
        ),
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
    claim(
        "6.4.1-17",
        "The run with e = 1 needs a longer axis of time than the others.",
        Finding::new(
            Verdict::robust(members.iter().map(holds)),
            format!("runs end at {}", nominal(members, 2, |run| run.end().t)),
        ),
    )
}

/// The largest distance of neighbours from the first run in x, y and θ, early and late in their motion.
fn apart(runs: &[&Trajectory]) -> [f64; 2] {
    let (end, _) = range(runs.iter().map(|run| run.end().t));
    // A period at either end, for the distance swings, too.
    let late = end - 2.0 * std::f64::consts::PI / Parameters::STANDARD.omega;
    [0.0, late].map(|from| {
        let times = (0..=100).map(|k| from + (end - late) * f64::from(k) / 100.0);
        let paths = runs.iter().map(|run| {
            let mut playback = Playback::new(run);
            let at = |t| playback.at(t).state;
            times.clone().map(at).map(|s| [s.x, s.y, s.theta]).collect()
        });
        let paths: Vec<Vec<[f64; 3]>> = paths.collect();
        let own = paths.first().into_iter().flatten().flatten();
        let own: Vec<f64> = own.copied().collect();
        let differences = paths.iter().flat_map(|path| {
            let values = path.iter().flatten();
            values
                .zip(&own)
                .map(|(p, q)| (p - q).abs())
                .collect::<Vec<_>>()
        });
        range(differences).1
    })
}

/// By how much neighbours part over a run, and in words.
fn growth(runs: &[&Trajectory]) -> (f64, String) {
    let [early, late] = apart(runs);
    let (end, _) = range(runs.iter().map(|run| run.end().t));
    let words = format!(
        "starts 1e-12 apart are up to {early:.0e} apart in the first period and {late:.0e} in the \
         last, t = {end:.1}"
    );
    (late / early, words)
}

/// A growth of differences that no steady motion has over so short a run.
const CHAOS: f64 = 1e4;

fn chaotic(elastic: &[&Trajectory]) -> Claim {
    let (factor, evidence) = growth(elastic);
    claim(
        "6.4.1-18",
        "The case with e = 1 is chaotic.",
        Finding::new(Verdict::of(factor > CHAOS), evidence),
    )
}

fn chaos_of_forcing(study: &Study, elastic: &[&Trajectory]) -> Result<Claim, CaseError> {
    /// Off the middle, where free motion would meet both boundaries at once for ever.
    const OFF: f64 = 0.02;
    let case = study.case(RESTITUTIONS[0]);
    let free = Parameters {
        f_o: 0.0,
        x: OFF,
        t_end: elastic.first().map_or(0.0, |run| run.end().t),
        ..case.map_or(Parameters::STANDARD, |case| case.parameters)
    };
    let runs = near(&chapter(free), MANY)?;
    let (without, evidence) = growth(&runs.iter().collect::<Vec<_>>());
    let (with, _) = growth(elastic);
    let finding = Finding::new(
        Verdict::of(with > CHAOS && without < CHAOS),
        format!("without forcing, started at x = {OFF}: {evidence}"),
    )
    .because(
        Verdict::NotReproduced,
        without >= CHAOS,
        "A body that bounces between two cables and turns is chaotic without waves, too.",
    );
    Ok(claim(
        "6.4.1-36",
        "That the case with e = 1 is chaotic is owed to the forcing.",
        finding,
    ))
}

fn elastic_rotates(elastic: &[&Trajectory]) -> Claim {
    let evidence = elastic.first().map_or(String::new(), |run| {
        format!("{} after {} impacts", ending(run), run.impacts().len())
    });
    claim(
        "6.4.1-19",
        "With e = 1 the rotation passes its limit and the run stops.",
        Finding::new(
            Verdict::robust(
                elastic
                    .iter()
                    .map(|run| run.end().reason == Stop::RotationLimit),
            ),
            evidence,
        ),
    )
}

fn nothing_lost(elastic: &[&Trajectory]) -> Claim {
    /// Rounding of one impact's energies.
    const ROUNDING: f64 = 1e-14;
    let lost = |run: &Trajectory| {
        let energy = |state: &State| run.system().energy(state);
        let of = run
            .impacts()
            .iter()
            .map(|hit| energy(&hit.before) - energy(&hit.after));
        range(of.map(f64::abs)).1
    };
    let most = elastic.iter().map(|run| lost(run));
    let impacts = elastic.first().map_or(0, |run| run.impacts().len());
    claim(
        "6.4.1-20",
        "With e = 1 the impacts lose no energy.",
        Finding::new(
            Verdict::robust(most.clone().map(|lost| lost < ROUNDING)),
            format!(
                "most that an impact changes the energy: {:.0e} in {impacts} impacts",
                range(most).1
            ),
        ),
    )
}

fn lower_loads(members: &[Vec<&Trajectory>]) -> Claim {
    let rho = |run: &Trajectory| run.norms().rho1;
    let impulse = |run: &Trajectory| range(run.impacts().iter().map(|hit| hit.impulse)).1;
    let falls = |runs: &Vec<&Trajectory>| {
        let values: Vec<f64> = runs.iter().map(|run| rho(run)).collect();
        falling(&values)
    };
    claim(
        "6.4.1-21",
        "A lower e goes with lower snap loads.",
        Finding::new(
            Verdict::robust(members.iter().map(falls)),
            format!(
                "e = 1, 0.9, 0.7, 0.5: largest snap velocity {}; largest impulse {}",
                nominal(members, 3, rho),
                nominal(members, 3, impulse)
            ),
        ),
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
    let with = |k: u8| Parameters {
        e: f64::from(95 - 5 * k) / 100.0,
        ..Parameters::STANDARD
    };
    let cases: Vec<Parameters> = (0..10).map(|k| chapter(with(k))).collect();
    let fine = of_all(&cases, |case| Outcome::of(&case).end)?;
    let settled = fine.iter().filter(|end| end.reason == Stop::Settled);
    let fine: Vec<f64> = settled.map(|end| end.t).collect();
    let back = fine.windows(2).filter(|pair| !falling(pair)).count();
    let own = members.first().map(times).unwrap_or_default();
    let evidence = format!(
        "settles at {} with e = 0.9, 0.7, 0.5; in steps of 0.05 from 0.95 {} settle, at {} \
         ({back} steps the other way)",
        list(&own, 3),
        fine.len(),
        list(&fine, 2)
    );
    Ok(claim(
        "6.4.1-22",
        "The lower e, the sooner the body settles.",
        Finding::new(Verdict::robust(members.iter().map(holds)), evidence),
    ))
}

fn force(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    let members = tabled.of(&FORCES);
    let first = first_rotating(&ensemble(&chapter(Parameters::STANDARD), MANY))?;
    let row = study
        .critical
        .iter()
        .find(|row| row.r == 1.5 && row.size == [0.1, 0.0]);
    Ok(vec![
        tenths(&members),
        hundredths(&first),
        settles_above_critical(&members, &first, row.map(|row| &row.computed.chapter)),
    ])
}

/// For each start the first of the amplitudes 0.01, 0.02 … that exceeds, if it does so by rotation.
fn first_rotating(starts: &[Parameters]) -> Result<Vec<Option<f64>>, CaseError> {
    let first = |start: &Parameters| {
        let found = first_exceeding(start, ForceScan::default())?;
        let by_rotation = found.filter(|(_, reason)| *reason == Stop::RotationLimit);
        Ok(by_rotation.map(|(f_o, _)| f_o))
    };
    starts.par_iter().map(first).collect()
}

fn tenths(members: &[Vec<&Trajectory>]) -> Claim {
    let only_last = |runs: &Vec<&Trajectory>| match runs.split_last() {
        Some((last, others)) => {
            last.end().reason == Stop::RotationLimit && !others.iter().any(|run| exceeds(run))
        }
        None => false,
    };
    claim(
        "6.4.1-23",
        "In steps of 0.1 the force first brings about the rotation limit at 0.5.",
        Finding::new(
            Verdict::robust(members.iter().map(only_last)),
            format!("f_o = 0.1 to 0.5: {}", endings(members)),
        ),
    )
}

fn hundredths(first: &[Option<f64>]) -> Claim {
    let found = first.iter().flatten();
    claim(
        "6.4.1-24",
        "In steps of 0.01 it does so first at 0.31.",
        Finding::new(
            Verdict::robust(first.iter().map(|f_o| *f_o == Some(0.31))),
            format!(
                "first at {} in {} of {} starts",
                span(found.clone().copied(), 2),
                found.count(),
                first.len()
            ),
        ),
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
    let at = members.iter().filter_map(|runs| Some(runs.get(3)?.end().t));
    let exceeding = scan.map_or(&[][..], |scan| &scan.exceeding).iter().take(4);
    let exceeding: Vec<String> = exceeding.map(|[a, b]| format!("{a:.2}-{b:.2}")).collect();
    claim(
        "6.4.1-25",
        "All forces of the series below 0.5 settle, even 0.4, which is above the critical one.",
        Finding::new(
            Verdict::robust(holds),
            format!(
                "0.4 ends at t = {}; forces that exceed: {} …",
                span(at, 2),
                exceeding.join(", ")
            ),
        ),
    )
}
