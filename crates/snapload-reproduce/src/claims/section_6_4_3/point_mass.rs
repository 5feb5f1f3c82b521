//! The comparison with the point mass.

use super::{STEADY, Sweeps, below_critical, own, spread};
use crate::claims::numbers::{range, spearman};
use crate::claims::runs::{chapter, run_all};
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use crate::study::first_exceeding;
use snapload::analysis::ForceScan;
use snapload::{BodyKind, Case, CaseError, Impact, Parameters, Playback, Stop, Trajectory};

/// The point mass in the place of the body.
fn point(parameters: Parameters) -> Parameters {
    Parameters {
        body: BodyKind::Point,
        a: 0.0,
        b: 0.0,
        inertia: None,
        ..chapter(parameters)
    }
}

/// Checks the claims on the point mass.
pub(super) fn claims(sweeps: &Sweeps) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        claim(
            "6.4.3-06",
            "For the point mass ρ1 grows with f_o.",
            point_mass_norm(sweeps)?,
        ),
        claim(
            "6.4.3-08",
            "From the same start the rigid body is nearer to the boundaries than the point mass.",
            slack_at_start()?,
        ),
        claim(
            "6.4.3-09",
            "The stronger the force, the farther the point mass gets before its first impact, \
             compared with the rigid body.",
            way_to_first_impact()?,
        ),
        claim(
            "6.4.3-17",
            "The rigid body's critical force is lower than the point mass's.",
            point_mass_critical(sweeps)?,
        ),
        claim(
            "6.4.3-21",
            "ρ1 of the rigid body is constant as the body rotates.",
            rotation_held(sweeps)?,
        ),
    ])
}

/// ρ1 over the amplitudes of a body.
fn largest_snaps(
    forces: impl Iterator<Item = f64>,
    body: impl Fn(Parameters) -> Parameters,
) -> Result<Vec<(f64, f64)>, CaseError> {
    let with = |f_o| Parameters {
        f_o,
        ..Parameters::STANDARD
    };
    let cases: Vec<Parameters> = forces.map(|f_o| body(with(f_o))).collect();
    let runs = run_all(&cases)?;
    let pairs = cases.iter().zip(&runs);
    Ok(pairs
        .map(|(case, run)| (case.f_o, run.norms().rho1))
        .collect())
}

/// The amplitudes over which ρ1 of the rigid body was looked at.
fn same_forces(sweeps: &Sweeps) -> impl Iterator<Item = f64> {
    own(&sweeps.short).iter().map(|run| run.f_o)
}

fn point_mass_norm(sweeps: &Sweeps) -> Result<Finding, CaseError> {
    let points = largest_snaps((0..=19).map(|k| f64::from(k) / 20.0), point)?;
    let at = |k: usize| points.get(k).map_or(0.0, |p| p.1);
    let (rho, growth) = (spearman(&points), at(10) / at(0) - 1.0);
    let same = largest_snaps(same_forces(sweeps), point)?;
    let same = 100.0 * spread(same.iter().map(|p| p.1));
    Ok(Finding::new(
        Verdict::of(rho > 1.0 - 1e-9 && growth > STEADY),
        format!(
            "ρ1 {:.3}, {:.3}, {:.3} at f_o = 0, 0.5, 0.9; rank correlation {rho:.2}; over the \
             amplitudes up to the rigid body's critical one it varies by {same:.1} %",
            at(0),
            at(10),
            at(18)
        ),
    ))
}

fn rotation_held(sweeps: &Sweeps) -> Result<Finding, CaseError> {
    /// A moment of inertia that no impact turns.
    const HELD: f64 = 1e6;
    let held = |case: Parameters| {
        chapter(Parameters {
            inertia: Some(HELD),
            ..case
        })
    };
    let held = largest_snaps(same_forces(sweeps), held)?;
    let held = spread(held.iter().map(|p| p.1));
    let turning = spread(own(&sweeps.short).iter().map(|run| run.norms.rho1));
    let evidence = format!(
        "over the same amplitudes ρ1 varies by {:.1} % if the body can not turn, by {:.1} % if it \
         can",
        100.0 * held,
        100.0 * turning
    );
    Ok(
        Finding::new(Verdict::of(held >= STEADY && turning < STEADY), evidence).because(
            Verdict::NotReproduced,
            held < STEADY && turning < STEADY,
            "Held from turning the body has a constant ρ1, too, by the same measure: amplitudes \
             so small change it little for any body.",
        ),
    )
}

/// The rigid body and the point mass of one case.
fn pair(parameters: Parameters) -> Result<[Case; 2], CaseError> {
    Ok([
        Case::new(chapter(parameters))?,
        Case::new(point(parameters))?,
    ])
}

fn slack_at_start() -> Result<Finding, CaseError> {
    let slack = |case: &Case| {
        let simulation = case.simulation();
        let spans = simulation.system().cables.iter().map(|cable| {
            let [x, y] = cable.span(simulation.state()).components();
            cable.length() - x.hypot(y)
        });
        range(spans).0
    };
    let drop = |case: &Case| {
        let run = case.run();
        let start = case.simulation().state().y;
        run.impacts()
            .first()
            .map_or(f64::NAN, |hit| start - hit.before.y)
    };
    let mut found = Vec::new();
    let mut texts = Vec::new();
    for r in [1.5, 2.5] {
        let cases = pair(Parameters {
            r,
            f_o: 0.0,
            ..Parameters::STANDARD
        })?;
        let [rigid, point] = cases.each_ref().map(slack);
        let drops = cases.each_ref().map(drop);
        texts.push(format!(
            "r = {r}: slack {rigid:.4} (rigid), {point:.4} (point), drop without force {:.4}, \
             {:.4}",
            drops[0], drops[1]
        ));
        found.push((rigid < point, (drops[0] - drops[1]).abs() < 1e-9));
    }
    Ok(
        Finding::new(Verdict::of(found.iter().all(|f| f.0)), texts.join("; ")).because(
            Verdict::NotReproduced,
            found.iter().all(|f| f.1),
            "h follows from r and a such that both fall equally far: a body with a width is \
             moored the higher for it.",
        ),
    )
}

fn way_to_first_impact() -> Result<Finding, CaseError> {
    let mut found = Vec::new();
    let mut texts = Vec::new();
    for f_o in [0.1, 0.3, 0.5, 1.0] {
        let runs = pair(Parameters {
            f_o,
            ..Parameters::STANDARD
        })?
        .map(|case| case.run());
        let [rigid, point] = runs.each_ref().map(way);
        let first = |run: &Trajectory| run.impacts().first().copied();
        let [first, second] = runs.each_ref().map(first);
        let earlier = matches!((first, second), (Some(p), Some(q)) if q.t < p.t);
        let v_n = |hit: Option<Impact>| hit.map_or(f64::NAN, |hit| hit.v_n);
        texts.push(format!(
            "{rigid:.4}/{point:.4} and v_n {:.3}/{:.3} at {f_o}",
            v_n(first),
            v_n(second)
        ));
        found.push((point - rigid, earlier));
    }
    // Farther, and the more so the stronger the force.
    let more = found.windows(2).all(|pair| pair[1].0 > pair[0].0);
    Ok(Finding::new(
        Verdict::of(more && found.iter().all(|f| f.0 > 0.0)),
        format!("way, rigid/point: {}", texts.join(", ")),
    )
    .because(
        Verdict::NotReproduced,
        found.iter().all(|f| f.0 < 0.0 && f.1),
        "The point mass meets its boundary earlier, not later, under each of these forces.",
    ))
}

/// The way of the centre until the first impact.
fn way(run: &Trajectory) -> f64 {
    let steps = 400;
    let until = run.impacts().first().map_or(run.end().t, |impact| impact.t);
    let mut playback = Playback::new(run);
    // The speed at the middle of each step.
    let speed = |k: i32| {
        let now = playback
            .at(until * (f64::from(k) + 0.5) / f64::from(steps))
            .state;
        now.vx.hypot(now.vy)
    };
    (0..steps).map(speed).sum::<f64>() * until / f64::from(steps)
}

fn point_mass_critical(sweeps: &Sweeps) -> Result<Finding, CaseError> {
    let scan = ForceScan::new(0.01, 3.0)?;
    let mut lower = true;
    let mut texts = Vec::new();
    for (r, members) in [(1.5, &sweeps.short), (2.5, &sweeps.long)] {
        let case = point(Parameters {
            r,
            ..Parameters::STANDARD
        });
        let found = first_exceeding(&case, scan)?.map_or(f64::INFINITY, |x| x.0);
        let sweep = own(members);
        let last = sweep.get(below_critical(sweep).len());
        let last = last.filter(|run| matches!(run.reason, Stop::RotationLimit | Stop::UpperBound));
        let rigid = last.map_or(f64::INFINITY, |run| run.f_o);
        lower &= rigid < found;
        texts.push(format!("r = {r}: {rigid:.2} (rigid), {found:.2} (point)"));
    }
    Ok(Finding::new(Verdict::of(lower), texts.join("; ")))
}
