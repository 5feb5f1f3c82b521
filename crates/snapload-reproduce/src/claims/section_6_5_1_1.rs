//! 6.5.1.1: the equations of sliding, against Newton's law with a multiplier.

mod states;

use super::engine::tension_residual;
use super::equations::*;
use super::newton::{Jet, Mooring, Side, holds, identity, largest, verdict, words};
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{Parameters, Real, Trajectory};
use states::{Sliding, pointing_to_the_centre, random_states};

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Vec<Claim> {
    let (left, right): (Vec<Sliding>, Vec<Sliding>) = random_states()
        .into_iter()
        .partition(|state| state.side == Side::Left);
    let mut all = geometry(&left);
    all.extend(energies(&left));
    all.extend(motion(&left));
    all.extend(multiplier(study, &left));
    all.push(loss(&left, &right));
    all.extend(right_cable(&right));
    all.push(validity(&left, &right));
    all.push(origin(study));
    all.push(double_pendulum(&left));
    all
}

/// The largest of what a residual comes to over states.
fn over<I: IntoIterator<Item = f64>>(states: &[Sliding], residual: impl Fn(&Sliding) -> I) -> f64 {
    largest(states.iter().flat_map(residual))
}

fn differences<const N: usize>(p: [f64; N], q: [f64; N]) -> impl Iterator<Item = f64> {
    p.into_iter().zip(q).map(|(p, q)| p - q)
}

fn gap(state: &Sliding) -> [f64; 1] {
    [state.moment.mooring.gap_at(state.side, state.moment.place)]
}

fn rates(state: &Sliding) -> impl Iterator<Item = f64> + use<> {
    let printed = eq_6_6_rates(&state.moment.mooring, state.side, &state.angles);
    differences(printed, state.moment.velocity)
}

fn round_trip(state: &Sliding) -> impl Iterator<Item = f64> + use<> {
    let (moment, angles) = (&state.moment, &state.angles);
    let back = eq_6_11_angles(&moment.mooring, state.side, moment.place, moment.velocity);
    differences(
        [back.alpha, back.beta, back.alpha_rate, back.beta_rate],
        [
            angles.alpha,
            angles.beta,
            angles.alpha_rate,
            angles.beta_rate,
        ],
    )
}

fn geometry(left: &[Sliding]) -> Vec<Claim> {
    let n = left.len();
    vec![
        identity(
            "6.5.1.1-01",
            "Eqs 6.5, 6.7 and 6.9 put the body where its left cable is exactly taut.",
            over(left, gap),
            n,
        ),
        identity(
            "6.5.1.1-02",
            "Eqs 6.6, 6.8 and 6.10 are the time derivatives of 6.5, 6.7 and 6.9.",
            over(left, rates),
            n,
        ),
        identity(
            "6.5.1.1-03",
            "Eqs 6.11 to 6.14 turn 6.5 to 6.10 round.",
            over(left, round_trip),
            n,
        ),
    ]
}

fn energies(left: &[Sliding]) -> Vec<Claim> {
    let kinetic = over(left, |state| {
        let m = &state.moment.mooring;
        [eq_6_18_kinetic(m, &state.angles) - eq_6_17_kinetic(m, state.moment.velocity)]
    });
    let shortfall = |state: &Sliding| {
        eq_6_20_potential(&state.moment.mooring, &state.angles) - state.moment.place[1]
    };
    let potential = over(left, |state| [shortfall(state)]);
    let with_b = over(left, |state| [shortfall(state) + state.moment.mooring.b]);
    vec![
        identity(
            "6.5.1.1-04",
            "The kinetic energy in α and β, 6.18, is that of 6.17.",
            kinetic,
            left.len(),
        ),
        claim(
            "6.5.1.1-05",
            "The potential energy in α and β, 6.20, is the height y.",
            Finding::new(
                verdict(potential),
                format!(
                    "off by up to {}; with b added {}",
                    words(potential),
                    words(with_b)
                ),
            )
            .because(
                Verdict::NotReproduced,
                holds(with_b),
                "The constant b is left out, which no equation of motion notices.",
            ),
        ),
    ]
}

/// J^T f, with the Jacobian of 6.5, 6.7 (6.45, 6.47) by exact differentiation.
fn virtual_work(state: &Sliding) -> impl Iterator<Item = f64> + use<> {
    let q = &state.angles;
    let m = &state.moment.mooring;
    let [fx, fy] = state.moment.force;
    let work = [[1.0, 0.0], [0.0, 1.0]].map(|[alpha, beta]| {
        let path = [Jet::new(q.alpha, alpha, 0.0), Jet::new(q.beta, beta, 0.0)];
        let [x, y, _] = eq_6_5_place(m, state.side, path);
        fx * x.rate + fy * y.rate
    });
    differences(state.forces(), work)
}

/// What 6.29 leaves over once 6.35 has the term it lacks.
fn mended(state: &Sliding) -> f64 {
    let [_, second] = state.motion_residuals();
    second - missing_in_6_35(&state.moment.mooring, &state.angles)
}

fn motion(left: &[Sliding]) -> Vec<Claim> {
    let n = left.len();
    let printed = over(left, |state| [state.motion_residuals()[1]]);
    let circles = largest(
        left.iter()
            .filter(|state| state.moment.mooring.b == 0.0)
            .map(|state| state.motion_residuals()[1]),
    );
    let with_term = over(left, |state| [mended(state)]);
    let of_beta = Finding::new(
        verdict(printed),
        format!(
            "as printed off by up to {}; with + b cos β {}; circles (b = 0) {}",
            words(printed),
            words(with_term),
            words(circles)
        ),
    )
    .because(
        Verdict::NotReproduced,
        holds(with_term) && holds(circles),
        "6.35 lacks + b cos β. It is right for the circle, which the chapter's examples use; \
         boxes would slide wrongly by it.",
    );
    vec![
        identity(
            "6.5.1.1-06",
            "Eqs 6.24 to 6.27 give the generalized forces.",
            over(left, virtual_work),
            n,
        ),
        identity(
            "6.5.1.1-07",
            "The equation of α (6.28 with 6.30 to 6.32 and 6.34) follows.",
            over(left, |state| [state.motion_residuals()[0]]),
            n,
        ),
        claim(
            "6.5.1.1-08",
            "The equation of β (6.29 with 6.33 and 6.35) follows.",
            of_beta,
        ),
    ]
}

fn length([x, y, _]: [f64; 3]) -> f64 {
    (x * x + y * y).sqrt()
}

fn multiplier(study: &Study, left: &[Sliding]) -> Vec<Claim> {
    let terms =
        |state: &Sliding| eq_6_40_terms(&state.moment.mooring, state.lambda(), state.moment.place);
    let constraint = over(left, |state| {
        let gradient = state.moment.gradient(state.side);
        differences(terms(state), gradient.map(|g| g * state.lambda()))
    });
    let compression = over(left, |state| {
        [length(terms(state)) - 2.0 * state.lambda().abs() * state.moment.mooring.r]
    });
    // A force along the span, from the anchor to the body, pushes the body away.
    let pushes = left.iter().all(|state| {
        let [gx, gy, _] = state.moment.gradient(state.side);
        let [fx, fy, _] = terms(state);
        (fx * gx + fy * gy > 0.0) == (state.lambda() > 0.0)
    });
    let (tension, moments) = tension_residual(&study.sliding, 1);
    let in_angles = over(left, |state| {
        let m = &state.moment.mooring;
        let bracket = eq_6_43_bracket(m, &state.angles);
        [m.inertia * state.second[1] - 2.0 * state.lambda() * m.r * bracket]
    });
    vec![
        identity(
            "6.5.1.1-09",
            "Eqs 6.40 to 6.42 are the equations of motion with the left cable as a constraint.",
            constraint,
            left.len(),
        ),
        claim(
            "6.5.1.1-10",
            "The taut cable bears a compression of 2 λ r.",
            Finding::new(
                Verdict::of(holds(compression) && pushes && moments > 0 && holds(tension)),
                format!(
                    "residual {}; tension of the sliding example against -2 λ r at {moments} \
                     times {}",
                    words(compression),
                    words(tension)
                ),
            ),
        ),
        identity(
            "6.5.1.1-11",
            "Eq. 6.43 is 6.42 in α and β.",
            in_angles,
            left.len(),
        ),
    ]
}

/// Whether 6.44 says that tension is lost.
fn said_lost(state: &Sliding) -> bool {
    eq_6_44_lost(&state.moment.mooring, &state.angles, state.second[1])
}

fn loss(left: &[Sliding], right: &[Sliding]) -> Claim {
    let agree = |states: &[Sliding]| {
        let same = |state: &&Sliding| said_lost(state) == (state.lambda() > 0.0);
        states.iter().filter(same).count()
    };
    let compressed = |states: &[Sliding]| states.iter().filter(|s| s.lambda() > 0.0).count();
    let (of_left, of_right) = (agree(left), agree(right));
    let blind = pointing_to_the_centre();
    let evidence = format!(
        "{of_left} of {} states agree for the left cable ({} have lost it), {of_right} of {} for \
         the right ({}); where the cable points to the centre 6.44 reads 0 > 0: {} of {} have \
         lost it, {} are seen",
        left.len(),
        compressed(left),
        right.len(),
        compressed(right),
        compressed(&blind),
        blind.len(),
        blind.iter().filter(|state| said_lost(state)).count()
    );
    let all = of_left == left.len() && of_right == right.len();
    claim(
        "6.5.1.1-12",
        "Tension is lost where 6.44 holds and nowhere else (save where both its sides are 0).",
        Finding::new(Verdict::of(all && compressed(left) > 0), evidence),
    )
}

fn right_cable(right: &[Sliding]) -> Vec<Claim> {
    let n = right.len();
    let motion = over(right, |state| [state.motion_residuals()[0], mended(state)]);
    vec![
        identity(
            "6.5.1.1-13",
            "Eqs 6.45 to 6.50 put the body where its right cable is taut, and move it so.",
            over(right, gap).max(over(right, rates)),
            n,
        ),
        identity(
            "6.5.1.1-14",
            "Eqs 6.51 to 6.54 turn them round.",
            over(right, round_trip),
            n,
        ),
        identity(
            "6.5.1.1-15",
            "Eqs 6.55 and 6.56 are the generalized forces for the right cable.",
            over(right, virtual_work),
            n,
        ),
        identity(
            "6.5.1.1-16",
            "For the right cable only the sign of f_x changes: the equations of motion stay (6.35 \
             with the term that it lacks).",
            motion,
            n,
        ),
    ]
}

fn validity(left: &[Sliding], right: &[Sliding]) -> Claim {
    let lost = || left.iter().chain(right).filter(|state| said_lost(state));
    let pulling = lost().filter(|state| state.lambda() < 0.0).count();
    let all = lost().count();
    let evidence = format!("the cable pulls in {pulling} of the {all} states in which 6.44 holds");
    claim(
        "6.5.1.1-17",
        "The sliding solution is valid while 6.44 is satisfied.",
        Finding::new(Verdict::of(all > 0 && pulling == all), evidence).because(
            Verdict::NotReproduced,
            all > 0 && pulling == 0,
            "A slip: it should say not satisfied, as the chapter itself has it where it \
             introduces 6.44.",
        ),
    )
}

/// Where the sliding example first hits its other cable's boundary while it slides.
fn first_hit(run: &Trajectory) -> Option<[f64; 3]> {
    let hit = run.impacts().iter().find(|impact| {
        impact.v_n > 0.0
            && run.modes().iter().any(|mode| {
                mode.taut.len() == 1
                    && !mode.taut.contains(impact.cable)
                    && mode.t_start < impact.t
                    && impact.t <= mode.t_end
            })
    })?;
    Some([hit.before.x, hit.before.y, hit.before.theta])
}

fn origin(study: &Study) -> Claim {
    const CLOSED: f64 = 1e-12;
    let gaps = study.critical.iter().flat_map(|row| {
        let [a, b] = row.size;
        let mooring = Mooring {
            a,
            b,
            r: row.r,
            inertia: Parameters::STANDARD.inertia.unwrap_or(1.0),
        };
        Side::BOTH.map(|side| mooring.gap_at(side, [0.0; 3]))
    });
    let largest_gap = largest(gaps);
    let elsewhere = first_hit(&study.sliding).map_or_else(String::new, |[x, y, theta]| {
        format!("; the sliding example meets both at x = {x:.3}, y = {y:.3}, θ = {theta:.2}")
    });
    claim(
        "6.5.1.1-18",
        "At the origin both cables are taut.",
        Finding::new(
            Verdict::of(!study.critical.is_empty() && largest_gap < CLOSED),
            format!(
                "gaps {} for {} shapes{elsewhere}",
                words(largest_gap),
                study.critical.len()
            ),
        ),
    )
}

/// A double pendulum by d'Alembert's principle: a massless leg r at the angle α, a leg a at β, at its
/// end a mass 1 with a moment of inertia. What the virtual work of all forces comes to.
fn pendulum(m: &Mooring, q: &Angles, [alpha, beta]: [f64; 2]) -> [f64; 2] {
    let place = |[alpha, beta]: [Jet; 2]| {
        let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
        [sa * m.r + sb * m.a, (ca * m.r + cb * m.a) * -1.0]
    };
    let [x, y] = place(q.path(alpha, beta));
    let ((sa, ca), (sb, cb)) = (Real::sin_cos(q.alpha), Real::sin_cos(q.beta));
    let work = |leg: f64, [tx, ty]: [f64; 2]| leg * (x.second * tx + (y.second + 1.0) * ty);
    [work(m.r, [ca, sa]), work(m.a, [cb, sb]) + m.inertia * beta]
}

fn double_pendulum(left: &[Sliding]) -> Claim {
    let residual = over(left, |state| {
        let circle = Mooring {
            b: 0.0,
            ..state.moment.mooring
        };
        let matrix = eq_6_30_matrix(&circle, &state.angles);
        let right_sides = eq_6_34_right_sides(&circle, &state.angles, [0.0; 2]);
        pendulum(&circle, &state.angles, eq_6_28_solved(matrix, right_sides))
    });
    identity(
        "6.5.1.1-19",
        "Without height and forcing the sliding body is a double pendulum.",
        residual,
        left.len(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_with_another_sign_or_size_is_not_reproduced() {
        let states = random_states();
        let left: Vec<Sliding> = states
            .into_iter()
            .filter(|s| s.side == Side::Left)
            .collect();
        assert_eq!(verdict(over(&left, rates)), Verdict::Reproduced);
        assert_eq!(verdict(over(&left, virtual_work)), Verdict::Reproduced);
        // 6.6 by the signs of 6.46, and forces a little too large.
        let other = |state: &Sliding| {
            let printed = eq_6_6_rates(&state.moment.mooring, Side::Right, &state.angles);
            differences(printed, state.moment.velocity)
        };
        assert_eq!(verdict(over(&left, other)), Verdict::NotReproduced);
        let larger = |state: &Sliding| {
            let forces = state.forces();
            virtual_work(state).chain(forces.map(|force| 1e-6 * force))
        };
        assert_eq!(verdict(over(&left, larger)), Verdict::NotReproduced);
        let nothing = identity("6.5.1.1-01", "of no state", over(&[], rates), 0);
        assert_eq!(nothing.verdict, Verdict::NotReproduced);
    }
}
