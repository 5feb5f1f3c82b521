//! The comparison with the point mass.

use crate::claims::tools::{Finding, first_exceeding, judged, range, run_all, spearman};
use crate::claims::{Claim, Verdict};
use crate::study::{Reading, Study};
use snapload::analysis::ForceScan;
use snapload::{BodyKind, Case, CaseError, Parameters, Playback, Trajectory};

/// The point mass in the place of the body.
fn point(parameters: Parameters) -> Parameters {
    Parameters {
        body: BodyKind::Point,
        a: 0.0,
        b: 0.0,
        inertia: None,
        ..Reading::Chapter.apply(parameters)
    }
}

/// Checks the claims on the point mass.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    Ok(vec![
        judged(
            "6.4.3-06",
            "For the point mass ρ1 grows with f_o.",
            point_mass_norm()?,
            "No such growth.",
        ),
        judged(
            "6.4.3-08",
            "From the same start the rigid body is nearer to the boundaries than the point mass.",
            slack_at_start()?,
            "h follows from r and a such that the lowest place is the origin for both: a larger body \
             is not nearer.",
        ),
        judged(
            "6.4.3-09",
            "The stronger the force, the farther the point mass gets before its first impact, compared \
             with the rigid body.",
            way_to_first_impact()?,
            "The point mass hits earlier. ρ1 of the rigid body is flat since its largest snap is the \
             second.",
        ),
        judged(
            "6.4.3-17",
            "The rigid body's critical force is lower than the point mass's.",
            point_mass_critical(study)?,
            "It is not lower.",
        ),
    ])
}

fn point_mass_norm() -> Result<Finding, CaseError> {
    let case = |k: u32| {
        let f_o = f64::from(k) / 20.0;
        point(Parameters {
            f_o,
            ..Parameters::STANDARD
        })
    };
    let cases: Vec<Parameters> = (0..=19).map(case).collect();
    let runs = run_all(&cases)?;
    let points = cases
        .iter()
        .zip(&runs)
        .map(|(case, run)| (case.f_o, run.norms().rho1));
    let points: Vec<(f64, f64)> = points.collect();
    let at = |k: usize| points.get(k).map_or(0.0, |p| p.1);
    let (rho, growth) = (spearman(&points), at(10) / at(0) - 1.0);
    let evidence = format!(
        "ρ1 {:.3}, {:.3}, {:.3} at f_o = 0, 0.5, 0.9; rank correlation {rho:.2}",
        at(0),
        at(10),
        at(18)
    );
    Ok((Verdict::of(rho > 1.0 - 1e-9 && growth > 0.1), evidence))
}

/// The rigid body and the point mass of one case.
fn pair(parameters: Parameters) -> Result<[Case; 2], CaseError> {
    Ok([
        Case::new(Reading::Chapter.apply(parameters))?,
        Case::new(point(parameters))?,
    ])
}

fn slack_at_start() -> Result<Finding, CaseError> {
    let mut less = true;
    let mut texts = Vec::new();
    for r in [1.5, 2.5] {
        let f_o = 0.0;
        let slack = |case: &Case| {
            let simulation = case.simulation();
            let spans = simulation.system().cables.iter().map(|cable| {
                let [x, y] = cable.span(simulation.state());
                cable.length() - x.hypot(y)
            });
            range(spans).0
        };
        let cases = pair(Parameters {
            r,
            f_o,
            ..Parameters::STANDARD
        })?;
        let [rigid, point] = cases.each_ref().map(slack);
        let drop = |case: &Case| {
            case.run()
                .impacts()
                .first()
                .map_or(0.0, |i| 0.1 - i.before.y)
        };
        let drops = cases.each_ref().map(drop);
        less &= rigid < point;
        texts.push(format!(
            "r = {r}: slack {rigid:.4} (rigid), {point:.4} (point), drop without force {:.4}, {:.4}",
            drops[0], drops[1]
        ));
    }
    Ok((Verdict::of(less), texts.join("; ")))
}

fn way_to_first_impact() -> Result<Finding, CaseError> {
    let mut farther = true;
    let mut texts = Vec::new();
    for f_o in [0.1, 0.3, 0.5, 1.0] {
        let [rigid, point] = pair(Parameters {
            f_o,
            ..Parameters::STANDARD
        })?
        .map(|c| way(&c.run()));
        farther &= point > rigid;
        texts.push(format!("{rigid:.4}/{point:.4} at {f_o}"));
    }
    Ok((
        Verdict::of(farther),
        format!("way, rigid/point: {}", texts.join(", ")),
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

fn point_mass_critical(study: &Study) -> Result<Finding, CaseError> {
    let scan = ForceScan::new(0.01, 3.0)?;
    let mut lower = true;
    let mut texts = Vec::new();
    for r in [1.5, 2.5] {
        let case = point(Parameters {
            r,
            ..Parameters::STANDARD
        });
        let found = first_exceeding(&case, scan)?.map_or(f64::INFINITY, |x| x.0);
        let curve = study.norms.iter().find(|norms| norms.r == r);
        let last = curve.and_then(|norms| norms.points.chapter.last());
        let rigid = last
            .filter(|p| p.1.exceeds())
            .map_or(f64::INFINITY, |p| p.0);
        lower &= rigid < found;
        texts.push(format!("r = {r}: {rigid:.2} (rigid), {found:.2} (point)"));
    }
    Ok((Verdict::of(lower), texts.join("; ")))
}
