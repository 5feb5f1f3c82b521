//! The comparison with the point mass.

use super::{STEADY, Sweeps, spread};
use crate::claims::numbers::{min, spearman};
use crate::claims::runs::{chapter, each, run, standard};
use crate::claims::verdict::{Finding, Judged, Judges, Verdict};
use crate::reading::first_exceeding;
use snapload::analysis::ForceScan;
use snapload::{Case, CaseError, Parameters, Playback, Rules, Simulation, Stop, Trajectory};

pub(super) const JUDGES: &Judges<fn(&Sweeps) -> Judged> = &[
    ("6.4.3-06", |sweeps| {
        let points = largest_snaps((0..=19).map(|k| f64::from(k) / 20.0), point)?;
        let (rank, at) = (spearman(&points), [0, 10, 18].map(|k| points[k].1));
        let same = largest_snaps(same_forces(sweeps), point)?;
        let finding = Finding::of(rank > 1.0 - 1e-9 && at[1] / at[0] - 1.0 > STEADY);
        Ok(finding.list("rho1", at).values(
            "rank same",
            [rank, 100.0 * spread(same.iter().map(|p| p.1))],
        ))
    }),
    ("6.4.3-08", |_| slack_at_start()),
    ("6.4.3-09", |_| way_to_first_impact()),
    ("6.4.3-17", |sweeps| {
        let scan = ForceScan::new(0.01, 3.0)?;
        let force = |r: f64| first_exceeding(&point(standard(|p| p.r = r)), scan);
        let [short, long] = [force(1.5)?, force(2.5)?].map(|f| f.map_or(f64::INFINITY, |f| f.0));
        let [rigid_short, rigid_long] = [&sweeps.short, &sweeps.long].map(|starts| {
            let last = starts[0].last().filter(|run| run.reason.exceeds());
            last.map_or(f64::INFINITY, |run| run.f_o)
        });
        Ok(Finding::of(rigid_short < short && rigid_long < long)
            .values("short long", [short, long])
            .values("rigid_short rigid_long", [rigid_short, rigid_long]))
    }),
    ("6.4.3-22", |_| {
        let scan = ForceScan::new(0.01, 3.0)?;
        let by_bound = [1.5, 2.5].map(|r| {
            let case = standard(|p| p.r = r);
            Ok::<_, CaseError>([
                first_at_bound(&chapter(case), scan)?,
                first_at_bound(&point(case), scan)?,
            ])
        });
        let [short, long] = by_bound;
        let [short, long] = [short?, long?];
        let not_lower = |[rigid, point]: [f64; 2]| Verdict::of(rigid >= point);
        let words = |[rigid, point]: [f64; 2]| format!("{rigid:.2} (rigid), {point:.2} (point)");
        Ok(
            Finding::new(Verdict::families([short, long].map(not_lower)))
                .values("short long", [short, long].map(words)),
        )
    }),
    ("6.4.3-21", |sweeps| {
        // A moment of inertia that no impact turns.
        let heavy = |case| Parameters {
            inertia: Some(1e6),
            ..chapter(case)
        };
        let held = largest_snaps(same_forces(sweeps), heavy)?;
        let held = spread(held.iter().map(|p| p.1));
        let turning = spread(sweeps.short[0].iter().map(|run| run.norms.rho1));
        Ok(Finding::of(held >= STEADY && turning < STEADY)
            .found("constant_anyway", held < STEADY && turning < STEADY)
            .values("held turning", [100.0 * held, 100.0 * turning]))
    }),
];

/// The point mass in the place of the body.
fn point(parameters: Parameters) -> Parameters {
    Parameters {
        a: 0.0,
        b: 0.0,
        inertia: None,
        ..chapter(parameters)
    }
}

/// The first amplitude at which a body reaches the upper bound, at whatever rotation.
fn first_at_bound(parameters: &Parameters, scan: ForceScan) -> Result<f64, CaseError> {
    for f_o in scan.amplitudes() {
        let simulation = Case::new(Parameters { f_o, ..*parameters })?.into_simulation();
        let rules = Rules {
            rotation_limit: None,
            ..*simulation.rules()
        };
        let (system, start) = (simulation.system().clone(), *simulation.state());
        let mut simulation = Simulation::new(system, rules, 0.0, start)
            .map_err(|_| CaseError::value("f_o", f_o, "a legal start"))?;
        while simulation.step().is_some() {}
        if simulation.stop() == Some(Stop::UpperBound) {
            return Ok(f_o);
        }
    }
    Ok(f64::INFINITY)
}

/// The force amplitude and ρ1 of a body.
fn largest_snaps(
    forces: impl Iterator<Item = f64>,
    body: fn(Parameters) -> Parameters,
) -> Result<Vec<(f64, f64)>, CaseError> {
    let cases: Vec<_> = forces.map(|f_o| body(standard(|p| p.f_o = f_o))).collect();
    each(&cases, |case| Ok((case.f_o, run(case)?.norms().rho1)))
}

/// The amplitudes over which ρ1 of the rigid body was looked at.
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

fn slack_at_start() -> Judged {
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
        .found("both_fall_equally", found.iter().all(|f| f.1))
        .value("lengths", texts.join("; ")))
}

fn way_to_first_impact() -> Judged {
    let mut found = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.1, 0.3, 0.5, 1.0] {
        let runs = pair(standard(|p| p.f_o = f_o))?.map(|case| case.run());
        let [rigid, point] = runs.each_ref().map(way);
        let first = |run: &Trajectory| run.impacts().first().map(|hit| (hit.t, hit.v_n));
        let [p, q] = runs
            .each_ref()
            .map(|run| first(run).unwrap_or((f64::NAN, f64::NAN)));
        found.push((point - rigid, q.0 < p.0));
        texts.push(format!(
            "{rigid:.4}/{point:.4} and v_n {:.3}/{:.3} at {f_o}",
            p.1, q.1
        ));
    }
    // Farther, and the more so the stronger the force.
    let more = found.windows(2).all(|pair| pair[1].0 > pair[0].0);
    Ok(Finding::of(more && found.iter().all(|f| f.0 > 0.0))
        .found("earlier", found.iter().all(|f| f.0 < 0.0 && f.1))
        .value("ways", texts.join(", ")))
}

/// The way of the centre until the first impact: its speed at the middle of each of many steps.
fn way(run: &Trajectory) -> f64 {
    let steps = 400;
    let until = run.impacts().first().map_or(run.end().t, |impact| impact.t);
    let mut playback = Playback::new(run);
    let middle = |k: i32| until * (f64::from(k) + 0.5) / f64::from(steps);
    let states = (0..steps).map(|k| playback.at(middle(k)).state);
    states.map(|now| now.vx.hypot(now.vy)).sum::<f64>() * until / f64::from(steps)
}
