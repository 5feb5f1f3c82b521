//! The comparison with the point mass.

use super::{STEADY, Sweeps, spread};
use crate::ReportError;
use crate::claims::numbers::{min, span, spearman};
use crate::claims::runs::{FEW, chapter, each, near, row, run, standard};
use crate::claims::verdict::{Checked, Checks, Finding, Verdict};
use snapload::analysis::ForceScan;
use snapload::{Case, CaseError, Limit, Parameters, Playback, Rules, Simulation, Stop, Trajectory};

pub(super) const CHECKS: &Checks<fn(&Sweeps) -> Checked> = &[
    ("6.4.3-06", |sweeps| {
        let points = largest_snaps((0..=19).map(|k| f64::from(k) / 20.0), point)?;
        let (rank, at) = (spearman(&points), [0, 10, 18].map(|k| points[k].1));
        let same = largest_snaps(same_forces(sweeps), point)?;
        let finding = Finding::of(rank > 1.0 - 1e-9 && at[1] / at[0] - 1.0 > STEADY);
        let same = spread(same.iter().map(|p| p.1));
        Ok(finding
            .list("rho1", at)
            .values("rank same steady", [rank, 100.0 * same, 100.0 * STEADY]))
    }),
    ("6.4.3-08", |_| slack_at_start()),
    ("6.4.3-09", |_| path_to_first_impact()),
    ("6.4.3-17", |sweeps| {
        let proved = |r: f64| {
            let first = row(sweeps.study, r, [0.1, 0.0])?.first();
            Ok::<_, ReportError>(first.map_or(f64::INFINITY, |(f_o, _)| f_o))
        };
        let rigid = [proved(1.5)?, proved(2.5)?];
        let lower = |points: &[f64; 2]| rigid.iter().zip(points).all(|(p, q)| p < q);
        let [short, long] = &sweeps.points;
        let points: Vec<[f64; 2]> = short.iter().zip(long).map(|(p, q)| [*p, *q]).collect();
        Ok(Finding::robust(&points, lower)
            .values("rigid_short rigid_long", rigid)
            .list("short", short.iter().copied())
            .list("long", long.iter().copied()))
    }),
    ("6.4.3-22", |sweeps| {
        let lengths = LENGTHS.iter().zip(&sweeps.points).map(|(r, points)| {
            let rigid = chapter(standard(|p| p.r = *r));
            Ok::<_, CaseError>((first_at_bound(&rigid)?, points))
        });
        let lengths: Vec<(Vec<f64>, &Vec<f64>)> = lengths.collect::<Result<_, _>>()?;
        let words = |(rigid, points): &(Vec<f64>, &Vec<f64>)| {
            let [rigid, points] = [rigid, *points].map(|of| span(of.iter().copied(), 2));
            format!("{rigid} (rigid), {points} (point)")
        };
        let verdicts = lengths
            .iter()
            .map(|(rigid, points)| not_lower(rigid, points));
        let finding = Finding::new(Verdict::families(verdicts));
        Ok(finding.values("short long", [0, 1].map(|k| words(&lengths[k]))))
    }),
    ("6.4.3-21", |sweeps| {
        // A moment of inertia so large that no impact turns the body.
        let heavy = |case| Parameters {
            inertia: Some(1e6),
            ..chapter(case)
        };
        let held = largest_snaps(same_forces(sweeps), heavy)?;
        let held = spread(held.iter().map(|p| p.1));
        let turning = spread(sweeps.short[0].iter().map(|run| run.norms.rho1));
        Ok(Finding::of(constant_because_of_rotation(held, turning))
            .condition("constant_anyway", held < STEADY && turning < STEADY)
            .values(
                "held turning steady",
                [held, turning, STEADY].map(|part| 100.0 * part),
            ))
    }),
];

/// Whether ρ1 is constant for a body that can turn and not for one that can not.
fn constant_because_of_rotation(held: f64, turning: f64) -> bool {
    held >= STEADY && turning < STEADY
}

/// The point mass in place of the body.
fn point(parameters: Parameters) -> Parameters {
    Parameters {
        a: 0.0,
        b: 0.0,
        inertia: None,
        ..chapter(parameters)
    }
}

/// The lengths of the cables.
const LENGTHS: [f64; 2] = [1.5, 2.5];

/// The critical force of the point mass for both lengths, from each start.
pub(super) fn critical_forces() -> Result<[Vec<f64>; 2], CaseError> {
    let [short, long] = LENGTHS.map(|r| first_at_bound(&point(standard(|p| p.r = r))));
    Ok([short?, long?])
}

/// Whether the rigid body's force is no lower than the point mass's, from all starts.
fn not_lower(rigid: &[f64], points: &[f64]) -> Verdict {
    Verdict::robust(rigid.iter().zip(points).map(|(p, q)| p >= q))
}

/// The first amplitude at which a body reaches the upper bound, at whatever rotation, from each
/// start.
fn first_at_bound(parameters: &Parameters) -> Result<Vec<f64>, CaseError> {
    near(parameters, FEW, |case| {
        for f_o in ForceScan::new(0.01, 3.0)?.amplitudes() {
            if reaches_bound(&Parameters { f_o, ..*case })? {
                return Ok(f_o);
            }
        }
        Ok(f64::INFINITY)
    })
}

fn reaches_bound(parameters: &Parameters) -> Result<bool, CaseError> {
    let simulation = Case::new(*parameters)?.into_simulation();
    let rules = Rules {
        limits: simulation.rules().limits.with(Limit::Rotation, None),
        ..*simulation.rules()
    };
    let (system, start) = (simulation.system().clone(), *simulation.state());
    let mut simulation = Simulation::new(system, rules, 0.0, start)
        .map_err(|_| CaseError::value("f_o", parameters.f_o, "a legal start"))?;
    while simulation.step().is_some() {}
    Ok(simulation.stop() == Some(Stop::UpperBound))
}

/// The force amplitude and ρ1 of a body.
fn largest_snaps(
    forces: impl Iterator<Item = f64>,
    body: fn(Parameters) -> Parameters,
) -> Result<Vec<(f64, f64)>, CaseError> {
    let cases: Vec<_> = forces.map(|f_o| body(standard(|p| p.f_o = f_o))).collect();
    each(&cases, |case| Ok((case.f_o, run(case)?.norms().rho1)))
}

/// The amplitudes at which ρ1 of the rigid body was computed.
fn same_forces(sweeps: &Sweeps) -> impl Iterator<Item = f64> {
    sweeps.short[0].iter().map(|run| run.f_o)
}

/// The rigid body and the point mass of one case.
fn pair(parameters: Parameters) -> Result<[Case; 2], CaseError> {
    Ok([
        Case::new(chapter(parameters))?,
        Case::new(point(parameters))?,
    ])
}

fn slack_at_start() -> Checked {
    let slack = |case: &Case| {
        let simulation = case.simulation();
        let cables = simulation.system().cables.iter();
        min(cables.map(|cable| {
            let [x, y] = cable.span(simulation.state()).components();
            cable.length() - x.hypot(y)
        }))
    };
    let drop = |case: &Case| {
        let (start, run) = (case.simulation().state().y, case.run());
        run.impacts()
            .first()
            .map_or(f64::NAN, |hit| start - hit.before.y)
    };
    let mut found = Vec::new();
    let mut texts = Vec::new();
    for r in [1.5, 2.5] {
        let cases = pair(standard(|p| (p.r, p.f_o) = (r, 0.0)))?;
        let ([rigid, point], [p, q]) = (cases.each_ref().map(slack), cases.each_ref().map(drop));
        found.push((rigid < point, (p - q).abs() < 1e-9));
        texts.push(format!(
            "r = {r}: slack {rigid:.4} (rigid), {point:.4} (point), drop without force {p:.4}, \
             {q:.4}"
        ));
    }
    Ok(Finding::of(found.iter().all(|f| f.0))
        .condition("both_fall_equally", found.iter().all(|f| f.1))
        .value("lengths", texts.join("; ")))
}

fn path_to_first_impact() -> Checked {
    let mut found = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.1, 0.3, 0.5, 1.0] {
        let runs = pair(standard(|p| p.f_o = f_o))?.map(|case| case.run());
        let [rigid, point] = runs.each_ref().map(path_length);
        let first = |run: &Trajectory| run.impacts().first().map(|hit| (hit.t, hit.v_n));
        let [p, q] = runs
            .each_ref()
            .map(|run| first(run).unwrap_or((f64::NAN, f64::NAN)));
        found.push((point - rigid, q.0 < p.0));
        texts.push(format!(
            "{rigid:.4}/{point:.4} and v_n {:.3}/{:.3} at f_o = {f_o}",
            p.1, q.1
        ));
    }
    // The path is longer, and the more so the stronger the force.
    let more = found.windows(2).all(|pair| pair[1].0 > pair[0].0);
    Ok(Finding::of(more && found.iter().all(|f| f.0 > 0.0))
        .condition("earlier", found.iter().all(|f| f.0 < 0.0 && f.1))
        .value("ways", texts.join(", ")))
}

/// The length of the centre's path up to the first impact, from its speed at the middle of each of
/// many steps.
fn path_length(run: &Trajectory) -> f64 {
    let steps = 400;
    let until = run.impacts().first().map_or(run.end().t, |impact| impact.t);
    let mut playback = Playback::new(run);
    let middle = |k: i32| until * (f64::from(k) + 0.5) / f64::from(steps);
    let states = (0..steps).map(|k| playback.at(middle(k)).state);
    states.map(|now| now.vx.hypot(now.vy)).sum::<f64>() * until / f64::from(steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_is_lower_from_some_starts_decides_nothing() {
        assert_eq!(not_lower(&[1.2, 1.3], &[1.1, 1.2]), Verdict::Reproduced);
        assert_eq!(not_lower(&[0.9, 0.9], &[1.1, 1.2]), Verdict::NotReproduced);
        assert_eq!(not_lower(&[0.9, 1.3], &[1.1, 1.2]), Verdict::NotDecidable);
    }

    #[test]
    fn a_constant_without_rotation_is_not_because_of_rotation() {
        assert!(constant_because_of_rotation(0.2, 0.04));
        assert!(
            !constant_because_of_rotation(0.07, 0.04) && !constant_because_of_rotation(0.2, 0.2)
        );
    }
}
