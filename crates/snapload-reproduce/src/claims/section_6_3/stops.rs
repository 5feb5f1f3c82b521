//! Sections 6.3.1 and 6.3.2: the stop rules, and the start of the standard case.

use crate::ReportError;
use crate::claims::motions::{ending, exceeds, places};
use crate::claims::numbers::{max, min, span};
use crate::claims::runs::{
    FEW, MANY, SAME, TableRuns, case, chapter, critical_force, first_rocking, from_starts, near,
    outcome, past_settling, run, shapes_under, shown_span, standard,
};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::analysis::in_parallel;
use snapload::{Case, CaseError, Outcome, Parameters, Playback, State, Stop, Trajectory};
use snapload_verify::RoundedRun;

pub(super) const CHECKS: &Checks<fn(&TableRuns) -> Checked> = &[
    ("6.3.1-01", rotates_easily),
    ("6.3.1-02", parts_pass_first),
    ("6.3.1-03", energy_after_settling),
    ("6.3.1-04", |_| rocks_while_settling()),
    ("6.3.1-05", slides_for_a_while),
    ("6.3.2-01", |table_runs| {
        let strong = case(table_runs.study, "1910001000-559")?.parameters;
        let runs = near(&chapter(strong), MANY, RoundedRun::of_doubles)?;
        Ok(Finding::robust(&runs, exceeds)
            .value(
                "ending",
                ending(case(table_runs.study, "1910001000-559")?.exact.end()),
            )
            .list("impacts", runs.iter().map(|run| run.snaps() as f64)))
    }),
    ("6.3.2-02", |_| initial_spin()),
    ("6.3.1-06", below_critical),
    ("6.3.1-07", |_| ellipse_turns()),
];

/// A case with the initial spins -6, -4 … 6.
fn spins(case: &Parameters) -> impl Iterator<Item = Parameters> + use<> {
    let (case, spins) = (chapter(*case), [-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0]);
    spins
        .into_iter()
        .map(move |vtheta| Parameters { vtheta, ..case })
}

fn rotates_easily(table_runs: &TableRuns) -> Checked {
    let forced: Vec<Parameters> = table_runs.cases.iter().flat_map(spins).collect();
    let free = forced.iter().map(|case| Parameters { f_o: 0.0, ..*case });
    let free: Vec<Parameters> = free.collect();
    let limit = |case: &Parameters| Ok(outcome(case)?.end.reason == Stop::RotationLimit);
    let [with, without] = [&forced, &free].map(|cases| from_starts(cases, FEW, limit));
    // The numbers that reach the limit when started from rest and with a spin.
    let counts = |reached: &Vec<bool>| {
        let reached = forced.iter().zip(reached).filter(|(_, reached)| **reached);
        let (rest, spun): (Vec<_>, Vec<_>) = reached.partition(|(case, _)| case.vtheta == 0.0);
        [rest.len(), spun.len()]
    };
    let (with, without) = (with?, without?);
    let members = with.iter().zip(&without);
    let members: Vec<[[usize; 2]; 2]> = members.map(|(p, q)| [counts(p), counts(q)]).collect();
    let more = |[with, without]: &[[usize; 2]; 2]| with[0] > without[0] && with[1] > without[1];
    let cases = table_runs.cases.len();
    Ok(Finding::robust(&members, more)
        .values("cases spins", [cases, forced.len() - cases])
        .by_start(
            "forced",
            members
                .iter()
                .map(|[forced, _]| forced.map(|count| count as f64)),
        )
        .by_start(
            "free",
            members
                .iter()
                .map(|[_, free]| free.map(|count| count as f64)),
        ))
}

fn parts_pass_first(table_runs: &TableRuns) -> Checked {
    const FORCES: [f64; 4] = [0.6, 0.7, 0.8, 0.9];
    let strong = shapes_under(table_runs.study, &FORCES);
    // The height of the highest point above the centre at any rotation, and the centre's height at
    // the stop.
    let found = from_starts(&strong, FEW, |parameters| {
        let case = Case::new(chapter(*parameters))?;
        let (end, simulation) = (Outcome::of(&case).end, case.simulation());
        let system = simulation.system();
        let tilted = |k: i32| [0.0, 0.0, f64::from(k).to_radians(), 0.0, 0.0, 0.0];
        let tops = (-90..=90).map(|k| system.top(&State::from_components(tilted(k))));
        let below = system.cables[0].anchor().y - end.state.y;
        Ok((min(tops), (end.reason == Stop::UpperBound).then_some(below)))
    })?;
    let least = min(found.iter().flatten().map(|(top, _)| *top));
    let stops = |of: &Vec<(f64, Option<f64>)>| of.iter().filter_map(|(_, below)| *below).collect();
    let stops: Vec<Vec<f64>> = found.iter().map(stops).collect();
    let passes = |below: &Vec<f64>| least > 0.0 && below.iter().all(|below| *below > 0.0);
    Ok(
        Finding::robust(&stops, |below| !below.is_empty() && passes(below))
            .values(
                "least nearest",
                [least, min(stops.iter().flatten().copied())],
            )
            .list("stops", stops.iter().map(|of| of.len() as f64))
            .value("runs", strong.len())
            .list("forces", FORCES),
    )
}

/// The height of the start; a body that rises above it has risen far.
const FAR: f64 = 0.1;

/// The behaviour of a settled case in another 20 T: whether it stays low, over its members, and a
/// description.
fn continued_after_settling(
    code: &str,
    case: Parameters,
    settled: &RoundedRun,
) -> Result<(Verdict, String), CaseError> {
    let from = settled.end().t;
    let mut case = past_settling(case);
    case.t_end = from + 20.0;
    let runs = near(&case, FEW, run)?;
    let highest = |run: &Trajectory| {
        let mut playback = Playback::new(run);
        let points = places(|t| playback.at(t).state, (from, run.end().t), 0.05);
        max(points.iter().map(|p| p[1]))
    };
    let beyond = |run: &Trajectory| run.end().reason.exceeds();
    let low = runs.iter().map(|run| !beyond(run) && highest(run) < FAR);
    let words = match runs.iter().filter(|run| beyond(run)).count() {
        0 => format!("{code} rises to {}", span(runs.iter().map(highest), 3)),
        count => format!("{code} exceeds from {count} of {} starts", runs.len()),
    };
    Ok((Verdict::robust(low), words))
}

fn energy_after_settling(table_runs: &TableRuns) -> Checked {
    let own = table_runs.codes.iter().zip(table_runs.own());
    let settled: Vec<_> = own
        .filter(|(_, run)| run.end().reason == Stop::Settled)
        .collect();
    let on = in_parallel(settled.len(), |k| {
        let (code, run) = settled[k];
        let (low, words) =
            continued_after_settling(code, case(table_runs.study, code)?.parameters, run)?;
        Ok::<_, ReportError>((low, words, run.system().energy(&run.end().state)))
    })?;
    let with = |verdict| on.iter().filter(move |case| case.0 == verdict);
    let high = || with(Verdict::NotReproduced);
    let words: Vec<&str> = high().map(|case| &*case.1).collect();
    Ok(
        Finding::new(Verdict::families(on.iter().map(|case| case.0)))
            .values("cases low", [on.len(), with(Verdict::Reproduced).count()])
            .value("far", FAR)
            .value("high", words.join(", "))
            .list("energy_high", high().map(|case| case.2))
            .list("energy_low", with(Verdict::Reproduced).map(|case| case.2)),
    )
}

fn rocks_while_settling() -> Checked {
    let forces = (1..=27).map(|k| f64::from(k) / 100.0);
    let cases: Vec<_> = forces
        .map(|f_o| past_settling(standard(|p| p.f_o = f_o)))
        .collect();
    let starts = from_starts(&cases, FEW, first_rocking)?;
    let rocks = |k: usize| Verdict::robust(starts.iter().map(|all| all[k].is_some()));
    let rocks: Vec<Verdict> = (0..cases.len()).map(rocks).collect();
    let sure = Verdict::Reproduced.count(rocks.iter().copied());
    Ok(Finding::new(Verdict::any(rocks)).values("sure all", [sure, cases.len()]))
}

fn slides_for_a_while(table_runs: &TableRuns) -> Checked {
    const CODE: &str = "1921001000-559";
    /// The shortest time that is visible in a plot.
    const SHORTEST_SLIDE: f64 = 0.1;
    let runs = near(&case(table_runs.study, CODE)?.parameters, MANY, run)?;
    let slide = |run: &Trajectory| {
        let first = run.modes().iter().find(|mode| mode.taut.len() == 1);
        first.map(|mode| (mode.t_start, mode.t_end))
    };
    let long = |run: &Trajectory| slide(run).is_some_and(|(from, to)| to - from > SHORTEST_SLIDE);
    let slides: Vec<(f64, f64)> = runs.iter().filter_map(slide).collect();
    Ok(Finding::robust(&runs, long)
        .value("case", CODE.to_owned())
        .list("from", slides.iter().map(|slide| slide.0))
        .list("to", slides.iter().map(|slide| slide.1))
        .value("while", SHORTEST_SLIDE))
}

fn initial_spin() -> Checked {
    let starts: Vec<Parameters> = spins(&Parameters::STANDARD).collect();
    let exceed = from_starts(&starts, FEW, |case| Ok(outcome(case)?.exceeds()))?;
    let spins = exceed.iter().map(|exceed| {
        let pairs = starts.iter().zip(exceed).filter(|(_, exceeds)| **exceeds);
        pairs.map(|(case, _)| case.vtheta).collect()
    });
    let spins: Vec<Vec<f64>> = spins.collect();
    let rest = spins.iter().filter(|spins| spins.contains(&0.0)).count();
    let finding = Finding::robust(&spins, |spins| !spins.is_empty() && !spins.contains(&0.0));
    let same = spins.iter().filter(|of| **of == spins[0]).count();
    Ok(finding
        .value("spins", format!("{:?}", spins[0]))
        .values("same rest members", [same, rest, spins.len()]))
}

/// Whether the runs that settle do so under a force below the critical one of their body and
/// cables.
fn below_critical(table_runs: &TableRuns) -> Checked {
    let settled: Vec<usize> = (0..table_runs.codes.len())
        .filter(|k| table_runs.own()[*k].end().reason == Stop::Settled)
        .collect();
    let first = in_parallel(settled.len(), |k| {
        let case = &table_runs.cases[settled[k]];
        near(case, FEW, critical_force)
    })?;
    let below = settled.iter().zip(&first).map(|(k, first)| {
        Verdict::robust(
            first
                .iter()
                .map(|f_cr| table_runs.cases[*k].f_o < f_cr - SAME),
        )
    });
    let below: Vec<Verdict> = below.collect();
    let rows = settled.iter().zip(&below).zip(&first);
    let above = rows.filter(|((_, below), _)| **below != Verdict::Reproduced);
    let words = above.map(|((k, _), first)| {
        let (f_o, code) = (table_runs.cases[*k].f_o, table_runs.codes[*k]);
        format!(
            "{code} ({f_o} against {})",
            shown_span(first.iter().copied())
        )
    });
    Ok(Finding::new(Verdict::families(below.iter().copied()))
        .values(
            "cases below",
            [
                settled.len(),
                Verdict::Reproduced.count(below.iter().copied()),
            ],
        )
        .value("above", words.collect::<Vec<_>>().join(", ")))
}

/// Whether a force on an ellipse leads to the rotation limit at more amplitudes than one along the
/// horizontal.
fn ellipse_turns() -> Checked {
    let amplitudes = || (1..=100).map(|k| f64::from(k) / 100.0);
    let with = |r: f64, nu: f64| {
        let cases =
            amplitudes().map(|f_o| chapter(standard(|p| (p.r, p.nu, p.f_o) = (r, nu, f_o))));
        let cases: Vec<Parameters> = cases.collect();
        let limit = |case: &Parameters| Ok(outcome(case)?.end.reason == Stop::RotationLimit);
        let reached = from_starts(&cases, FEW, limit)?;
        let count = |reached: &Vec<bool>| reached.iter().filter(|reached| **reached).count();
        Ok::<Vec<usize>, CaseError>(reached.iter().map(count).collect())
    };
    let mut verdicts = Vec::new();
    let mut words = Vec::new();
    for r in [1.5, 2.5] {
        let (ellipse, line) = (with(r, Parameters::STANDARD.nu)?, with(r, 0.0)?);
        let more = ellipse
            .iter()
            .zip(&line)
            .map(|(ellipse, line)| ellipse > line);
        verdicts.push(Verdict::robust(more));
        let text = |counts: &[usize]| span(counts.iter().map(|count| *count as f64), 0);
        words.push(format!(
            "r = {r}: {} against {}",
            text(&ellipse),
            text(&line)
        ));
    }
    Ok(Finding::new(Verdict::families(verdicts)).value("counts", words.join("; ")))
}
