//! How a motion begins at the end of another: the states, each known at an instant of its own, are
//! carried to one common time.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::radius::Radius;
use crate::arithmetic::scalar::{Jet, Scalar};
use crate::slack::set::Set;
use crate::taut::chart::{Chart, StateJets};
use crate::taut::law::{Law, after, jets_after};
use crate::taut::step::{Equations, some_ball};
use crate::verdict::ProofFailure;

/// States (x, y, θ, ẋ, ẏ, θ̇, t), each at an instant t of its own.
pub(crate) type Instants = Set<7>;

/// The states at an instant, and the instant.
pub(crate) fn hull_of(instants: &Instants) -> ([Ball; 6], Ball) {
    parts(instants.hull())
}

fn parts([x, y, theta, vx, vy, spin, t]: [Ball; 7]) -> ([Ball; 6], Ball) {
    ([x, y, theta, vx, vy, spin], t)
}

/// Where a motion begins.
pub(crate) struct Started<const N: usize> {
    /// A number before all instants at which it begins.
    pub(crate) t: Ball,
    /// The states at that time, of the motions continued to there along their own equations;
    /// nothing that is proved of the time before the beginning is used.
    pub(crate) set: Set<N>,
    /// The motion begins between this common time and this long after it.
    pub(crate) slack: Radius,
}

/// The beginning of a motion after the laws of an event.
///
/// Let y be the coordinates after the event, at the instant t*, and T the required
/// time. The state at T is z = Φ(y), the flow of the new equations q̇ = F over
/// T − t*, and as a function of y and t*
///
/// dz = DΦ (dy − F(y) dt*).
///
/// The flow stays in a box W with y + [0, T − t*] F(W) within W (Picard), so that z is within
/// y + (T − t*) F(W); and with η = |T − t*| L, L a bound on the row sums of |∂F/∂q| over W, every
/// entry of DΦ − 1 is at most e^η − 1, no more than 2η for η ≤ 1 (Grönwall).
pub(crate) fn start_motion<const N: usize>(
    equations: &Equations<'_>,
    chart: &impl Chart<N>,
    laws: &[Law],
    instants: &Instants,
) -> Result<Started<N>, ProofFailure> {
    let model = equations.model;
    let lost = || ProofFailure::undecided("the beginning of a motion");
    let (whole, when) = hull_of(instants);
    // T + 1 has one limb less than the model's numbers, so that T + H is exact, too, also next to
    // t = 0, where T alone would have as many digits below them.
    let last = Radius::power_of_two(64 - 64 * model.limbs as i64);
    let before = &when.centre() - &Ball::bound(when.radius().plus(last)).twice();
    let one = Ball::integer(1).with_limbs(model.limbs);
    let shifted = (&before + &one).with_limbs(model.limbs - 1).centre();
    let t = (shifted.with_limbs(model.limbs) - one).centre();
    if !t.is_below(&when) {
        return Err(lost());
    }
    let (centre, centre_when) = parts(instants.centre().clone());
    let centre = after(laws, model, &centre).ok_or_else(lost)?;
    let centre = chart.coordinates(model, &centre)?;
    let shift = &t - &centre_when;
    let inside = picard(equations, &centre_when, &centre, &shift)?;
    let image: [Ball; N] = std::array::from_fn(|i| &centre[i] + &(&inside.speeds[i] * &shift));

    let one = Interval::of(&Ball::integer(1));
    let jets: StateJets =
        std::array::from_fn(|i| Jet::coordinate(Interval::of(&whole[i]), i, &one));
    let jets = jets_after(laws, model, jets).ok_or_else(lost)?;
    let slopes = chart.slopes(model, &jets).ok_or_else(lost)?;
    let state = after(laws, model, &whole).ok_or_else(lost)?;
    let all = chart.coordinates(model, &state)?;
    let shift = &t - &when;
    let inside = picard(equations, &when, &all, &shift)?;
    let moved: [[Ball; 7]; N] = std::array::from_fn(|k| {
        std::array::from_fn(|j| {
            let slope = some_ball(slopes[k][j]);
            if j == 6 {
                &slope - &inside.speeds[k]
            } else {
                slope
            }
        })
    });
    let eta = shift.upper().times(inside.steepness);
    if eta > Radius::power_of_two(0) {
        return Err(lost());
    }
    let off = Ball::within(eta.scaled(1));
    let jacobian = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let others = (0..N).map(|k| &off * &moved[k][j]);
            others.fold(moved[i][j].clone(), |sum, term| sum + term)
        })
    });
    Ok(Started {
        set: instants.mapped(&image, &jacobian)?,
        slack: (&when - &t).upper(),
        t,
    })
}

/// What is known of a motion over a short time.
struct ShortTimeBox<const N: usize> {
    /// F on the box.
    speeds: [Ball; N],
    /// The largest row sum of |∂F/∂q| there.
    steepness: Radius,
}

/// A box about states that is proved to hold their motion over a short time, and the speeds in it.
fn picard<const N: usize>(
    equations: &Equations<'_>,
    time: &Ball,
    at: &[Ball; N],
    shift: &Ball,
) -> Result<ShortTimeBox<N>, ProofFailure> {
    let lost = || ProofFailure::undecided("the beginning of a motion");
    let span = shift.upper();
    let times = time.clone().widened(span);
    let model = equations.model;
    let speeds = |state: &[Ball; N]| -> Option<[Ball; N]> {
        let expansion = equations
            .program
            .expand(state, &times, 1, &model.functions)?;
        Some(std::array::from_fn(|i| expansion.state[i][1].clone()))
    };
    let guess = speeds(at).ok_or_else(lost)?;
    let reach: [Radius; N] =
        std::array::from_fn(|i| guess[i].upper().scaled(1).plus(Radius::power_of_two(-32)));
    let wide: [Ball; N] = std::array::from_fn(|i| at[i].clone().widened(reach[i].times(span)));
    let speeds = speeds(&wide).ok_or_else(lost)?;
    if !(0..N).all(|i| speeds[i].upper() < reach[i]) {
        return Err(lost());
    }
    let one = Interval::of(&Ball::integer(1));
    let jets: [Jet<Interval, N>; N] =
        std::array::from_fn(|i| Jet::coordinate(Interval::of(&wide[i]), i, &one));
    let times = Jet::constant(&Interval::of(&times));
    let slopes = equations.few.expand(&jets, &times, 1, &equations.functions);
    let slopes = slopes.ok_or_else(lost)?;
    let mut steepness = Radius::ZERO;
    for series in &slopes.state {
        let row = series[1].slopes.iter().map(Interval::upper);
        let row: Option<Vec<Radius>> = row.collect();
        let sum = row
            .ok_or_else(lost)?
            .into_iter()
            .fold(Radius::ZERO, Radius::plus);
        steepness = steepness.max(sum);
    }
    Ok(ShortTimeBox { speeds, steepness })
}
