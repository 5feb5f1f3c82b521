//! 6.5.1.2: when bodies slide, and the sliding example.

mod example;
mod story;

use super::numbers::{range, span};
use super::runs::{MANY, chapter, ensemble, of_all, table_codes};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::{CriticalRow, Study};
use rayon::prelude::*;
use snapload::analysis::ForceScan;
use snapload::{Case, CaseError, Outcome, Parameters, Stop};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let mut all = vec![claim(
        "6.5.1.2-01",
        "No case of Table 6.1 slides.",
        table_6_1(study)?,
    )];
    all.extend(sweep(study)?);
    all.push(claim(
        "6.5.1.2-04",
        "Sliding starts where the normal velocity has become very low.",
        dying_snaps()?,
    ));
    all.extend(example::claims()?);
    all.push(claim(
        "6.5.1.2-16",
        "Runs that slide end by settling, at the rotation limit or in rocking, and in no other \
         way.",
        ends(study)?,
    ));
    Ok(all)
}

fn slides(parameters: Parameters) -> Result<bool, CaseError> {
    let outcome = Outcome::of(&Case::new(chapter(parameters))?);
    Ok(outcome.end.reason == Stop::SlidingStart)
}

fn table_6_1(study: &Study) -> Result<Finding, CaseError> {
    let codes = table_codes();
    let (table, printed): (Vec<_>, Vec<_>) = study
        .cases
        .iter()
        .partition(|case| codes.contains(&case.code));
    // By case: whether it and its neighbours slide.
    let found = table
        .par_iter()
        .map(|case| {
            ensemble(&case.parameters, MANY)
                .into_iter()
                .map(slides)
                .collect()
        })
        .collect::<Result<Vec<Vec<bool>>, CaseError>>()?;
    let own = found
        .iter()
        .filter(|case| case.first() == Some(&true))
        .count();
    let some = found.iter().filter(|case| case.contains(&true)).count();
    let verdicts = found
        .iter()
        .map(|case| Verdict::robust(case.iter().map(|slides| !slides)));
    let printed = printed
        .iter()
        .filter(|case| case.runs.chapter.end().reason == Stop::SlidingStart);
    let printed: Vec<&str> = printed.map(|case| case.code).collect();
    let others = if printed.is_empty() {
        "none".to_owned()
    } else {
        printed.join(", ")
    };
    Ok(Finding::new(
        Verdict::all(verdicts),
        format!(
            "{own} of {} by their numbers, {some} from some start 1e-12 away; of the rows that \
             print f_o = 0.5 with a number of 0.3, run at 0.5: {others}",
            table.len()
        ),
    ))
}

/// What a shape of Table 6.2 does over all amplitudes.
struct Sweep {
    class: (&'static str, bool),
    amplitudes: usize,
    intervals: usize,
    robust: bool,
}

fn sweep_of(row: &CriticalRow) -> Result<Sweep, CaseError> {
    let case = row.parameters();
    let at = |f_o: f64| Parameters { f_o, ..case };
    let amplitudes: Vec<f64> = ForceScan::default().amplitudes().collect();
    let found = amplitudes
        .par_iter()
        .map(|f_o| slides(at(*f_o)))
        .collect::<Result<Vec<bool>, CaseError>>()?;
    let mut robustly = false;
    for (f_o, _) in amplitudes.iter().zip(&found).filter(|(_, slid)| **slid) {
        let mut all = true;
        for member in ensemble(&at(*f_o), MANY) {
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
            Finding::new(
                everywhere,
                format!(
                    "{} of 100 amplitudes slide, over {shapes} shapes; robustly somewhere for {} \
                     of them",
                    span(sweeps.iter().map(|s| s.amplitudes as f64), 0),
                    sweeps.iter().filter(|s| s.robust).count()
                ),
            ),
        ),
        claim(
            "6.5.1.2-03",
            "No simple rule tells which amplitudes lead to sliding.",
            Finding::new(
                Verdict::of(scattered + 2 >= shapes && shapes > 2),
                format!(
                    "{} separate intervals of amplitudes slide, two or more for {scattered} of \
                     {shapes} shapes",
                    span(sweeps.iter().map(|s| s.intervals as f64), 0)
                ),
            ),
        ),
    ])
}

/// When the first slide of a run begins.
fn first_slide(case: &Case) -> Option<f64> {
    let mut simulation = case.simulation();
    while let Some(step) = simulation.step() {
        if step.taut.len() == 1 && step.t_end > step.t_start {
            return Some(step.t_start);
        }
    }
    None
}

fn dying_snaps() -> Result<Finding, CaseError> {
    /// A difference of times that no plot shows.
    const SAME: f64 = 1e-3;
    /// Velocities at which a cable is taken to stick. If the snaps die out there, it does not matter which.
    const STICKS: [f64; 2] = [1e-6, 1e-8];
    let forces = [0.2, 0.27, 0.4, 0.44];
    let with = |f_o: f64, v_stick: f64| Parameters {
        f_o,
        v_stick,
        stop_when_settled: false,
        ..Parameters::STANDARD
    };
    let mut verdicts = Vec::new();
    let mut words = Vec::new();
    for f_o in forces {
        let cases = STICKS.map(|v_stick| with(f_o, v_stick));
        let starts = of_all(&cases, |case| first_slide(&case))?;
        let (low, high) = range(starts.iter().flatten().copied());
        let all = starts.iter().all(Option::is_some);
        verdicts.push(Verdict::of(all && high - low < SAME));
        words.push(format!("{} at f_o = {f_o}", span([low, high], 4)));
    }
    Ok(Finding::new(
        Verdict::all(verdicts),
        format!(
            "the first slide begins at the same time whether snaps below 1e-6 or 1e-8 are taken \
             to stick: {}",
            words.join(", ")
        ),
    ))
}

/// How a run ends.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Settles,
    RotationLimit,
    Rocks,
    UpperBound,
    GoesOn,
}

/// How a run ends that has slid.
fn end_if_slid(case: &Case) -> Option<End> {
    let mut simulation = case.simulation();
    let mut slid = false;
    while let Some(step) = simulation.step() {
        slid |= step.taut.len() == 1 && step.t_end > step.t_start;
    }
    let end = match simulation.stop()? {
        Stop::Settled => End::Settles,
        Stop::RotationLimit => End::RotationLimit,
        Stop::UpperBound => End::UpperBound,
        _ if simulation.taut().len() > 1 => End::Rocks,
        _ => End::GoesOn,
    };
    slid.then_some(end)
}

fn ends(study: &Study) -> Result<Finding, CaseError> {
    let of_shape = |row: &CriticalRow| {
        let case = row.parameters();
        (1..=18).map(move |k| Parameters {
            f_o: f64::from(k) / 20.0,
            ..case
        })
    };
    let cases: Vec<Parameters> = study.critical.iter().flat_map(of_shape).collect();
    let ends = of_all(&cases, |case| end_if_slid(&case))?;
    let count = |end: End| ends.iter().filter(|found| **found == Some(end)).count();
    let [settle, limit, rock] = [End::Settles, End::RotationLimit, End::Rocks].map(count);
    let [bound, going] = [End::UpperBound, End::GoesOn].map(count);
    let all = settle + limit + rock + bound + going;
    let at_bound = cases
        .iter()
        .zip(&ends)
        .filter(|(_, end)| **end == Some(End::UpperBound));
    let forces = span(at_bound.map(|(case, _)| case.f_o), 2);
    Ok(Finding::new(
        Verdict::of(all > 0 && bound + going == 0),
        format!(
            "of {all} runs that slide {settle} settle, {limit} reach the rotation limit, {rock} \
             rock and {going} move otherwise at t = 100, {bound} reach the upper bound"
        ),
    )
    .because(
        Verdict::NotReproduced,
        bound > 0,
        format!(
            "The upper bound is reached under f_o = {forces}; the chapter may not have gone so \
             high. {going} runs have not ended."
        ),
    ))
}
