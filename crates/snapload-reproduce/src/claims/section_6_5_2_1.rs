//! 6.5.2.1: the equations of rocking, against Newton's law with two multipliers.

use super::engine::tension_residual;
use super::equations::*;
use super::newton::{Jet, Moment, Mooring, Numbers, Side, holds, identity, largest, words};

use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{Case, CaseError, Parameters, Playback, TautSet, Trajectory};

/// So many random states.
const STATES: usize = 600;
/// Their seed.
const SEED: u64 = 6_521;

/// Circles that rock, at random angles; and as many anywhere, by which the gaps are compared.
fn random_states() -> (Vec<Moment>, Vec<Moment>) {
    let mut numbers = Numbers::new(SEED);
    let (mut rocking, mut anywhere) = (Vec::new(), Vec::new());
    for _ in 0..STATES {
        let a = numbers.between(0.05, 0.6);
        let mooring = Mooring {
            a,
            b: 0.0,
            r: numbers.between(1.2, 3.0),
            inertia: a * a,
        };
        let (theta, rate) = (numbers.between(-1.5, 1.5), numbers.normal(1.5));
        let force = [numbers.normal(0.4), numbers.normal(0.4)];
        let [x, y] = eq_6_61_place(&mooring, Jet::new(theta, rate, 0.0));
        let moment = Moment {
            mooring,
            place: [x.value, y.value, theta],
            velocity: [x.rate, y.rate, rate],
            force,
        };
        rocking.push(moment);
        anywhere.push(Moment {
            place: [numbers.normal(0.5), numbers.normal(0.5), theta],
            ..moment
        });
    }
    (rocking, anywhere)
}

/// Checks the claims of the section.
pub(super) fn claims(study: &Study) -> Result<Vec<Claim>, CaseError> {
    let (rocking, anywhere) = random_states();
    let mut all = geometry(&rocking, &anywhere);
    all.push(one_degree(&rocking));
    all.extend(motion(study, &rocking));
    all.push(loss(&rocking)?);
    Ok(all)
}

fn over<I: IntoIterator<Item = f64>>(states: &[Moment], residual: impl Fn(&Moment) -> I) -> f64 {
    largest(states.iter().flat_map(residual))
}

fn geometry(rocking: &[Moment], anywhere: &[Moment]) -> Vec<Claim> {
    let gaps = over(anywhere, |state| {
        let m = &state.mooring;
        let printed = eq_6_59_gaps(m, state.place);
        let defined = Side::BOTH.map(|side| m.gap_at(side, state.place));
        printed.into_iter().zip(defined).map(|(p, q)| p - q)
    });
    let closed = over(rocking, |state| eq_6_59_gaps(&state.mooring, state.place));
    vec![
        identity(
            "6.5.2.1-01",
            "Eqs 6.59 and 6.60 are the gaps of a circle.",
            gaps,
            anywhere.len(),
        ),
        identity(
            "6.5.2.1-02",
            "Eqs 6.61 and 6.62 close both gaps.",
            closed,
            rocking.len(),
        ),
    ]
}

fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|z| z * z).sum::<f64>().sqrt()
}

fn one_degree(rocking: &[Moment]) -> Claim {
    /// Sine of the angle between the gradients of gaps that depend on each other.
    const DEPENDENT: f64 = 1e-9;
    let least = rocking
        .iter()
        .map(|state| {
            let [p, q] = Side::BOTH.map(|side| state.gradient(side));
            length(cross(p, q)) / (length(p) * length(q))
        })
        .fold(f64::INFINITY, f64::min);
    claim(
        "6.5.2.1-03",
        "With both cables taut one degree of freedom is left.",
        Finding::new(
            Verdict::of(least > DEPENDENT),
            format!(
                "the gradients of the gaps are independent in {} states (sine of their angle \
                 above {least:.2})",
                rocking.len()
            ),
        ),
    )
}

fn motion(study: &Study, rocking: &[Moment]) -> Vec<Claim> {
    let n = rocking.len();
    let second = over(rocking, |state| {
        let [_, _, theta] = state.place;
        let [_, _, rate] = state.velocity;
        let [_, _, newton] = state.held_by_both().acceleration;
        let printed = eq_6_63_second(&state.mooring, theta, rate, state.force);
        [(printed - newton) / (1.0 + newton.abs())]
    });
    let factors = over(rocking, |state| {
        let printed = eq_6_66_factors(&state.mooring, state.place);
        let gradients = Side::BOTH.map(|side| state.gradient(side));
        let pairs = printed.into_iter().flatten();
        pairs
            .zip(gradients.into_iter().flatten())
            .map(|(p, q)| p - q)
    });
    let compression = over(rocking, |state| {
        let lambda = state.held_by_both().lambda;
        let factors = eq_6_66_factors(&state.mooring, state.place);
        let r = state.mooring.r;
        lambda
            .into_iter()
            .zip(factors)
            .map(move |(lambda, [x, y, _])| {
                // Of a force relative to its size, which has no bound where the cables are nearly in line.
                length([x * lambda, y * lambda, 0.0]) / (2.0 * lambda.abs() * r) - 1.0
            })
    });
    let (tension, times) = tension_residual(&study.rocking, 2);
    vec![
        identity(
            "6.5.2.1-04",
            "Eq. 6.63 with 6.65 gives the θ̈ of 6.66 to 6.68 with both constraints.",
            second,
            n,
        ),
        identity(
            "6.5.2.1-05",
            "Eqs 6.66 to 6.68 are the equations of motion with two multipliers.",
            factors,
            n,
        ),
        claim(
            "6.5.2.1-06",
            "The compressions are 2 λ1 r in the right cable and 2 λ2 r in the left one.",
            Finding::new(
                Verdict::of(holds(compression) && times > 0 && holds(tension)),
                format!(
                    "residual {}; tensions of the rocking example against -2 λ r at {times} times \
                     {}",
                    words(compression),
                    words(tension)
                ),
            ),
        ),
    ]
}

/// The cables that the signs of λ1 and λ2 leave taut.
fn by_signs(state: &Moment) -> TautSet {
    let lambda = state.held_by_both().lambda;
    Side::BOTH
        .into_iter()
        .zip(lambda)
        .filter(|(_, lambda)| *lambda < 0.0)
        .map(|(side, _)| side.cable())
        .collect()
}

/// The cables that stay taut: no cable pushes, no gap opens past its cable, and each pulls or goes
/// slack. Of the four choices the one that fails least.
fn complementary(state: &Moment) -> TautSet {
    let both = Side::BOTH;
    let w = |p, q| state.coupling(p, q);
    let mut best = (f64::INFINITY, TautSet::SLACK);
    let mut consider = |failure: f64, set: TautSet| {
        if failure < best.0 {
            best = (failure, set);
        }
    };
    let opening = both.map(|side| state.opening(side));
    consider(opening[0].max(opening[1]), TautSet::SLACK);
    for (side, other) in [(both[0], both[1]), (both[1], both[0])] {
        let [lambda] = state.held(side).lambda;
        let rest = state.opening(other) + w(other, side) * lambda;
        let push = lambda * w(side, side);
        consider(rest.max(push), TautSet::only(side.cable()));
    }
    let [right, left] = state.held_by_both().lambda;
    let push = (right * w(both[0], both[0])).max(left * w(both[1], both[1]));
    consider(push, both.into_iter().map(Side::cable).collect());
    best.1
}

/// The same state under the wave force that takes the tension of one cable to just below zero.
fn at_loss(state: &Moment, side: Side) -> Option<Moment> {
    /// λ of the cable that has just lost its tension.
    const JUST: f64 = 1e-6;
    let with = |force| Moment { force, ..*state };
    let of = |moment: &Moment| moment.held_by_both().lambda.get(side.cable()).copied();
    let other = |moment: &Moment| moment.held_by_both().lambda.get(1 - side.cable()).copied();
    let [_, fy] = state.force;
    let start = of(&with([0.0, fy]))?;
    let slope = of(&with([1.0, fy]))? - start;
    let lost = with([(JUST - start) / slope, fy]);
    // The other one must pull, and by more than rounding.
    (slope.abs() > 1e-3 && other(&lost)? < -1e-3).then_some(lost)
}

/// Of the losses of tension of a run that rocks: how many, and after how many the run goes on with the
/// cable that still pulls.
fn losses_of(run: &Trajectory) -> (usize, usize) {
    let mut playback = Playback::new(run);
    let (mut all, mut agree) = (0, 0);
    for pair in run.modes().windows(2) {
        let [mode, next] = pair else { continue };
        if mode.taut.len() < 2 {
            continue;
        }
        let near = mode.t_end - 1e-6 * (mode.t_end - mode.t_start);
        let tensions = playback.at(near).tensions;
        let pulling = mode.taut.iter().max_by(|&i, &j| {
            let of = |k: usize| tensions.get(k).copied().unwrap_or(0.0);
            of(i).total_cmp(&of(j))
        });
        all += 1;
        agree += usize::from(pulling.map(TautSet::only) == Some(next.taut));
    }
    (all, agree)
}

fn loss(rocking: &[Moment]) -> Result<Claim, CaseError> {
    let run = Case::new(Parameters {
        f_o: 0.4,
        stop_when_settled: false,
        ..Parameters::STANDARD
    })?
    .run();
    let (seen, slid) = losses_of(&run);
    let lost: Vec<Moment> = rocking
        .iter()
        .flat_map(|state| Side::BOTH.map(|side| at_loss(state, side)))
        .flatten()
        .collect();
    let same = |states: &[Moment]| {
        let agree = |state: &&Moment| by_signs(state) == complementary(state);
        states.iter().filter(agree).count()
    };
    let (at_loss, anywhere) = (same(&lost), same(rocking));
    Ok(claim(
        "6.5.2.1-07",
        "The signs of λ1 and λ2 tell the next mode: both positive slack, one positive sliding on \
         the other cable.",
        Finding::new(
            Verdict::of(!lost.is_empty() && at_loss == lost.len() && slid == seen),
            format!(
                "true at {at_loss} of {} moments of loss, in {slid} of {seen} losses of a run at \
                 f_o = 0.4 and in {anywhere} of {} random states",
                lost.len(),
                rocking.len()
            ),
        ),
    ))
}
