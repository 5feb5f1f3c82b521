//! 6.5.1.1: the tension of the cable on which a body slides, and where it is lost.

use super::{BODIES, FORCE, Material, SEED, Sliding};
use crate::claims::newton::{LEFT, Numbers, length, over, tension_residual};
use crate::claims::numbers::holds;
use crate::claims::verdict::{Checked, Finding};

pub(super) fn compression(of: &Material) -> Checked {
    let size = |q: &Sliding| length(q.terms().into_iter().take(2));
    let residual = over(&of.left, |q| [size(q) - 2.0 * q.lambda.abs() * q.m.r]);
    // A force along the span, from the anchor to the body, pushes the body away.
    let pushes = of.left.iter().all(|q| {
        let ([gx, gy, _], [fx, fy, _]) = (q.moment.gradient(q.side), q.terms());
        (fx * gx + fy * gy > 0.0) == (q.lambda > 0.0)
    });
    let (tension, times) = tension_residual(&of.study.sliding.run, 1);
    let finding = Finding::of(holds(residual) && pushes && times > 0 && holds(tension));
    Ok(finding
        .value("times", times)
        .values("residual tension", [residual, tension]))
}

pub(super) fn loss(of: &Material) -> Checked {
    let count =
        |states: &[Sliding], holds: fn(&&Sliding) -> bool| states.iter().filter(holds).count();
    let agree = |states| count(states, |q| q.has_lost_tension() == (q.lambda > 0.0));
    let lost = |states| count(states, |q| q.lambda > 0.0);
    let (left, right, blind) = (&of.left[..], &of.right[..], &pointing_to_the_centre()[..]);
    let all = agree(left) == left.len() && agree(right) == right.len();
    Ok(Finding::of(all && lost(left) > 0)
        .values(
            "left left_agree left_lost",
            [left.len(), agree(left), lost(left)],
        )
        .values(
            "right right_agree right_lost",
            [right.len(), agree(right), lost(right)],
        )
        .values("blind blind_lost", [blind.len(), lost(blind)])
        .value("seen", count(blind, |q| q.has_lost_tension())))
}

/// Circles whose cable points to their centre, β = α, for which 6.44 is not defined.
fn pointing_to_the_centre() -> Vec<Sliding> {
    let mut numbers = Numbers::new(SEED + 1);
    let mut state = || {
        let sizes = numbers.sizes(0.0);
        let alpha = numbers.between(0.2, 1.2);
        let [ad, bd] = [0.2; 2].map(|deviation| numbers.normal(deviation));
        let force = [FORCE; 2].map(|deviation| numbers.normal(deviation));
        Sliding::new(sizes, LEFT, [alpha, alpha, ad, bd], force)
    };
    (0..BODIES).map(|_| state()).collect()
}
