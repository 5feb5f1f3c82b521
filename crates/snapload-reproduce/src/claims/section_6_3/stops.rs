//! Sections 6.3.1 and 6.3.2: the stop rules, and the start of the standard case.

use crate::claims::numbers::{range, span};
use crate::claims::runs::{
    FEW, MANY, Tabled, chapter, ending, ensemble, exceeds, first_rocking, near, of_all, places,
    run_all, table_codes,
};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use rayon::prelude::*;
use snapload::{Case, CaseError, Outcome, Parameters, State, Stop, Trajectory};

/// Checks the claims of these sections.
pub(super) fn claims(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        claim(
            "6.3.1-01",
            "Forced motion reaches the rotation limit more easily than free motion.",
            rotates_easily(study)?,
        ),
        claim(
            "6.3.1-02",
            "Some part of a body that rotates passes the upper level before its centre does.",
            parts_pass_first(study)?,
        ),
        claim(
            "6.3.1-03",
            "A body that the settling rule stops has too little energy left to rise far again.",
            little_energy(study, tabled)?,
        ),
        claim(
            "6.3.1-04",
            "While a body settles both cables can become taut, and it rocks.",
            rocks_while_settling()?,
        ),
        claim(
            "6.3.1-05",
            "The forcing can hold a body at one boundary, its cable taut, for a finite time.",
            slides_for_a_while(study)?,
        ),
        claim(
            "6.3.2-01",
            "A force amplitude of 0.5 is above the critical one of the standard rigid body.",
            above_critical(study)?,
        ),
        claim(
            "6.3.2-02",
            "An initial rotation can take the standard case past the rotation limit.",
            initial_spin()?,
        ),
    ])
}

fn unforced(parameters: Parameters) -> Parameters {
    Parameters {
        f_o: 0.0,
        ..parameters
    }
}

/// A case with the initial spins -6, -4 … 6.
fn spins(case: Parameters) -> impl Iterator<Item = Parameters> {
    (-3..=3).map(move |v| Parameters {
        vtheta: 2.0 * f64::from(v),
        ..chapter(case)
    })
}

/// How many of the cases of Table 6.1 reach the rotation limit, started with spins from -6 to 6.
#[derive(Clone, Copy, Default)]
struct Rotating {
    /// From rest: with forcing and without.
    rest: [usize; 2],
    /// With a spin: with forcing and without.
    spun: [usize; 2],
}

impl Rotating {
    fn of(starts: &[Parameters]) -> Result<Self, CaseError> {
        let free: Vec<Parameters> = starts.iter().copied().map(unforced).collect();
        let limit = |case: Case| Outcome::of(&case).end.reason == Stop::RotationLimit;
        let reached = [of_all(starts, limit)?, of_all(&free, limit)?];
        let count = |forcing: usize, rest: bool| {
            let pairs = starts.iter().zip(&reached[forcing]);
            let own = pairs.filter(|(start, _)| (start.vtheta == 0.0) == rest);
            own.filter(|(_, reached)| **reached).count()
        };
        Ok(Self {
            rest: [0, 1].map(|forcing| count(forcing, true)),
            spun: [0, 1].map(|forcing| count(forcing, false)),
        })
    }
}

fn rotates_easily(study: &Study) -> Result<Finding, CaseError> {
    let codes = table_codes();
    let cases = codes.iter().filter_map(|code| study.case(code));
    let starts: Vec<Parameters> = cases.flat_map(|case| spins(case.parameters)).collect();
    let member = |k: usize| {
        let own = |case: &Parameters| ensemble(case, FEW).get(k).copied();
        Rotating::of(&starts.iter().filter_map(own).collect::<Vec<_>>())
    };
    let members: Vec<Rotating> = (0..=FEW).map(member).collect::<Result<_, _>>()?;
    let more = |m: &Rotating| m.rest[0] > m.rest[1] && m.spun[0] > m.spun[1];
    let own = members.first().copied().unwrap_or_default();
    Ok(Finding::new(
        Verdict::robust(members.iter().map(more)),
        format!(
            "from rest {} of {} cases reach it with forcing and {} without; with initial spins up \
             to ±6 {} of {} and {}",
            own.rest[0],
            codes.len(),
            own.rest[1],
            own.spun[0],
            starts.len() - codes.len(),
            own.spun[1]
        ),
    ))
}

fn parts_pass_first(study: &Study) -> Result<Finding, CaseError> {
    let strong = study.critical.iter().flat_map(|row| {
        [0.6, 0.7, 0.8, 0.9].map(|f_o| {
            chapter(Parameters {
                f_o,
                ..row.parameters()
            })
        })
    });
    let strong: Vec<Parameters> = strong.collect();
    // How far the highest point is above the centre at any tilt, and where the centre is at the stop.
    let found = of_all(&strong, |case| {
        let end = Outcome::of(&case).end;
        let simulation = case.simulation();
        let system = simulation.system();
        let top = |k: i32| {
            system.top(&State {
                theta: f64::from(k).to_radians(),
                ..State::default()
            })
        };
        let level = system.cables.first().map_or(f64::NAN, |c| c.anchor().y);
        let stopped = end.reason == Stop::UpperBound;
        let below = stopped.then_some(level - end.state.y);
        (range((-90..=90).map(top)).0, below)
    })?;
    let (least, _) = range(found.iter().map(|(top, _)| *top));
    let stops = found.iter().filter_map(|(_, below)| *below);
    let (nearest, _) = range(stops.clone());
    let count = stops.count();
    Ok(Finding::new(
        Verdict::of(count > 0 && nearest > 0.0 && least > 0.0),
        format!(
            "the top is at least {least:.2} above the centre in every shape at any tilt; at \
             {count} stops at the level the centre is at least {nearest:.2} below it"
        ),
    ))
}

/// The height of the start; what rises above it rises far.
const FAR: f64 = 0.1;

/// A settled case that goes on for 20 T.
struct GoneOn {
    /// Whether it stays low, over its members.
    low: Verdict,
    /// Its energy as it settles.
    energy: f64,
    words: String,
}

impl GoneOn {
    fn new(code: &str, parameters: Parameters, settled: &Trajectory) -> Result<Self, CaseError> {
        let from = settled.end().t;
        let runs = near(
            &Parameters {
                stop_when_settled: false,
                t_end: from + 20.0,
                ..parameters
            },
            FEW,
        )?;
        let after = |run: &Trajectory| {
            let points = places(run, (from, run.end().t), 0.05);
            range(points.iter().map(|p| p.1)).1
        };
        let low = |run: &Trajectory| !exceeds(run) && after(run) < FAR;
        let words = match runs.first() {
            Some(run) if exceeds(run) => format!("{code} {}", ending(run)),
            Some(run) => format!("{code} rises to {:.3}", after(run)),
            None => String::new(),
        };
        Ok(Self {
            low: Verdict::robust(runs.iter().map(low)),
            energy: settled.system().energy(&settled.end().state),
            words,
        })
    }
}

fn little_energy(study: &Study, tabled: &Tabled) -> Result<Finding, CaseError> {
    let codes = table_codes();
    let members = tabled.all();
    let own = codes.iter().zip(members.first().into_iter().flatten());
    let settled: Vec<_> = own
        .filter(|(_, run)| run.end().reason == Stop::Settled)
        .filter_map(|(code, run)| Some((*code, study.case(code)?.parameters, *run)))
        .collect();
    let gone_on: Vec<GoneOn> = settled
        .into_par_iter()
        .map(|(code, parameters, run)| GoneOn::new(code, parameters, run))
        .collect::<Result<_, _>>()?;
    let with = |verdict: Verdict| gone_on.iter().filter(move |case| case.low == verdict);
    let high: Vec<&str> = with(Verdict::NotReproduced)
        .map(|case| &*case.words)
        .collect();
    let energy = |verdict| span(with(verdict).map(|case| case.energy), 3);
    let evidence = format!(
        "of {} cases that settle {} stay below y = {FAR} for another 20 T; not so: {}",
        gone_on.len(),
        with(Verdict::Reproduced).count(),
        high.join(", ")
    );
    let verdict = Verdict::all(gone_on.iter().map(|case| case.low));
    Ok(Finding::new(verdict, evidence).because(
        Verdict::NotReproduced,
        true,
        format!(
            "Energy as these settle {} (as the others do {}), of which {FAR} would lift a body so \
             high: the rule asks for the height and the velocity along one cable, not for the \
             energy, and the force goes on.",
            energy(Verdict::NotReproduced),
            energy(Verdict::Reproduced)
        ),
    ))
}

fn rocks_while_settling() -> Result<Finding, CaseError> {
    let amplitudes = (1..=27).map(|k| f64::from(k) / 100.0);
    let rocks: Vec<Verdict> = amplitudes
        .map(|f_o| {
            let case = Parameters {
                f_o,
                stop_when_settled: false,
                ..Parameters::STANDARD
            };
            let starts = of_all(&ensemble(&case, FEW), |case| first_rocking(&case))?;
            Ok(Verdict::robust(starts.iter().map(Option::is_some)))
        })
        .collect::<Result<_, CaseError>>()?;
    let count = rocks.iter().filter(|v| **v == Verdict::Reproduced).count();
    let evidence = format!(
        "f_o = 0.01 to 0.27: {count} of {} come to rock from every start",
        rocks.len()
    );
    Ok(Finding::new(Verdict::any(rocks), evidence))
}

fn slides_for_a_while(study: &Study) -> Result<Finding, CaseError> {
    const CODE: &str = "1921001000-559";
    /// A time that a plot shows.
    const WHILE: f64 = 0.1;
    let Some(case) = study.case(CODE) else {
        return Ok(Finding::new(Verdict::NotReproduced, "no such case"));
    };
    let runs = near(&case.parameters, MANY)?;
    let slides: Vec<Option<(f64, f64)>> = runs
        .iter()
        .map(|run| run.modes().iter().find(|mode| mode.taut.len() == 1))
        .map(|mode| mode.map(|mode| (mode.t_start, mode.t_end)))
        .collect();
    let long = |slide: &Option<(f64, f64)>| slide.is_some_and(|(from, to)| to - from > WHILE);
    let evidence = match slides.first() {
        Some(Some((from, to))) => format!("{CODE} slides from t = {from:.3} to {to:.3}"),
        _ => format!("{CODE} does not slide"),
    };
    Ok(Finding::new(
        Verdict::robust(slides.iter().map(long)),
        evidence,
    ))
}

fn above_critical(study: &Study) -> Result<Finding, CaseError> {
    let case = study.case("1910001000-559");
    let parameters = case.map_or(Parameters::STANDARD, |case| case.parameters);
    let runs = near(&chapter(parameters), MANY)?;
    let evidence = runs.first().map_or(String::new(), |run| {
        format!("{} after {} impacts", ending(run), run.impacts().len())
    });
    Ok(Finding::new(
        Verdict::robust(runs.iter().map(exceeds)),
        evidence,
    ))
}

fn initial_spin() -> Result<Finding, CaseError> {
    let starts: Vec<Parameters> = spins(Parameters::STANDARD).collect();
    let members = (0..=FEW).map(|k| {
        let own: Vec<Parameters> = starts
            .iter()
            .filter_map(|s| ensemble(s, FEW).get(k).copied())
            .collect();
        let runs = run_all(&own)?;
        let found = own.iter().zip(&runs).filter(|(_, run)| exceeds(run));
        Ok(found.map(|(case, _)| case.vtheta).collect())
    });
    let found: Vec<Vec<f64>> = members.collect::<Result<_, CaseError>>()?;
    let rest = found.iter().filter(|spins| spins.contains(&0.0)).count();
    let evidence = format!(
        "of initial spins -6 to 6 those of {:?} exceed; from rest {rest} of {} members do",
        found.first().map_or(&[][..], |spins| spins),
        found.len()
    );
    let holds = |spins: &Vec<f64>| !spins.is_empty() && !spins.contains(&0.0);
    Ok(Finding::new(
        Verdict::robust(found.iter().map(holds)),
        evidence,
    ))
}
