//! Weak rocking: the example of eq. 6.69.

use super::example::Rocking;
use crate::claims::numbers::{range, span, spearman};
use crate::claims::runs::CLEAR;
use crate::claims::verdict::{Claim, Finding, Verdict, claim};
use snapload::{Impact, Motion, State, System};

/// Checks the claims on it.
pub(super) fn claims(members: &[Rocking]) -> Vec<Claim> {
    let Some(own) = members.first() else {
        return Vec::new();
    };
    let weak = Weak::new(members, own);
    let mut all = of_weak_run(&weak);
    all.extend(of_arc(&weak));
    all
}

/// The example f_o = 0.1, its neighbours, and what happens in it.
struct Weak<'a> {
    members: &'a [Rocking],
    own: &'a Rocking,
    /// The impacts of the example before rocking, by place above the arc.
    impacts: Vec<Above>,
}

/// An impact as seen from the arc on which the body rocks.
struct Above {
    clear: bool,
    /// Height of the centre above the arc at the same x.
    height: f64,
    /// Rotation away from the one on the arc there.
    turned: f64,
}

impl<'a> Weak<'a> {
    fn new(members: &'a [Rocking], own: &'a Rocking) -> Self {
        let system = own.run.system();
        let before = own.run.impacts().iter().filter(|hit| hit.t < own.start);
        let above = |impact: &Impact| {
            let arc = arc_at(system, impact.before.x);
            Above {
                clear: impact.v_n > CLEAR,
                height: impact.before.y - arc.y,
                turned: (impact.before.theta - arc.theta).abs(),
            }
        };
        Self {
            members,
            own,
            impacts: before.map(above).collect(),
        }
    }

    /// The largest of a figure while rocking.
    fn largest(&self, figure: impl Fn(&Motion) -> f64) -> f64 {
        range(self.own.motion.iter().map(figure)).1
    }
}

/// The place at which both cables are straight, for a given x: Newton's iteration in y and θ, followed
/// from the lowest place.
fn arc_at(system: &System, x: f64) -> State {
    let steps = 8;
    let mut state = State::default();
    for k in 1..=steps {
        state.x = x * f64::from(k) / f64::from(steps);
        newton(
            system,
            &mut state,
            |state, [y, theta]| {
                state.y += y;
                state.theta += theta;
            },
            |span, lever| [span[1], span[1] * lever[0] - span[0] * lever[1]],
        );
    }
    state
}

/// The same for a given θ, in x and y.
fn arc_of(system: &System, theta: f64) -> State {
    let steps = 8;
    let mut state = State::default();
    for k in 1..=steps {
        state.theta = theta * f64::from(k) / f64::from(steps);
        newton(
            system,
            &mut state,
            |state, [x, y]| {
                state.x += x;
                state.y += y;
            },
            |span, _| span,
        );
    }
    state
}

/// Solves g = 0 of the first two cables in two unknowns; `slope` is half of the slopes of a gap.
fn newton(
    system: &System,
    state: &mut State,
    step: impl Fn(&mut State, [f64; 2]),
    slope: impl Fn([f64; 2], [f64; 2]) -> [f64; 2],
) {
    for _ in 0..12 {
        let (sine, cosine) = state.theta.sin_cos();
        let mut rows = system.cables.iter().map(|cable| {
            let row = slope(
                cable.span(state).components(),
                cable.lever(sine, cosine).components(),
            );
            (row, 0.5 * cable.gap(state))
        });
        let (Some(([a, b], p)), Some(([c, d], q))) = (rows.next(), rows.next()) else {
            return;
        };
        let determinant = a * d - b * c;
        let by = [(b * q - d * p) / determinant, (c * p - a * q) / determinant];
        step(state, by);
    }
}

fn of_weak_run(weak: &Weak) -> Vec<Claim> {
    vec![
        claim(
            "6.5.2.2-05",
            "At f_o = 0.1 both cables stay taut near the bottom.",
            stays(weak),
        ),
        claim(
            "6.5.2.2-06",
            "Once the body rocks at f_o = 0.1 the force can not pull it off.",
            holds_on(weak),
        ),
        claim(
            "6.5.2.2-07",
            "At f_o = 0.1 rocking begins where both gaps are all but zero as the bouncing ends.",
            begins_at_once(weak),
        ),
        claim(
            "6.5.2.2-08",
            "While it rocks it is the horizontal force that counts.",
            horizontal(weak),
        ),
    ]
}

fn stays(weak: &Weak) -> Finding {
    let low = |of: &Rocking| of.motion.iter().all(|now| now.state.y < 0.05);
    Finding::new(
        Verdict::robust(weak.members.iter().map(|of| of.goes_on() && low(of))),
        format!(
            "rocks from t = {} on; y up to {:.4}, |θ| up to {:.2}",
            span(weak.members.iter().map(|of| of.start), 3),
            weak.largest(|now| now.state.y),
            weak.largest(|now| now.state.theta.abs())
        ),
    )
}

fn holds_on(weak: &Weak) -> Finding {
    let on = weak.members.iter().filter(|of| of.goes_on()).count();
    let least = || weak.members.iter().map(Rocking::least_tension);
    let held = |of: &Rocking| of.goes_on() && of.least_tension() > 0.0;
    Finding::new(
        Verdict::robust(weak.members.iter().map(held)),
        format!(
            "rocks unbroken to t = 100 from {on} of {} starts, smallest tension {}",
            weak.members.len(),
            span(least(), 3)
        ),
    )
}

fn begins_at_once(weak: &Weak) -> Finding {
    let sticks = |of: &Rocking| {
        let first = of.run.modes().iter().find(|mode| !mode.taut.is_empty());
        first.map_or(f64::NAN, |mode| mode.t_start)
    };
    let wait = |of: &Rocking| of.start - sticks(of);
    let (least, most) = range(weak.members.iter().map(wait));
    Finding::new(
        Verdict::robust(weak.members.iter().map(|of| wait(of) < 0.01)),
        format!(
            "the first cable sticks at t = {}, rocking follows {least:.1e} to {most:.1e} later",
            span(weak.members.iter().map(sticks), 5)
        ),
    )
}

fn horizontal(weak: &Weak) -> Finding {
    let run = &weak.own.run;
    let (mut along, mut up) = (0.0, 0.0);
    for now in weak
        .own
        .motion
        .iter()
        .filter(|now| now.state.vtheta.abs() > 1e-3)
    {
        let [f_x, f_y] = run.system().forcing.at(now.t).components();
        let weight = run.system().forcing.constant.y;
        along += (f_x * now.state.vx / now.state.vtheta).powi(2);
        up += ((f_y - weight) * now.state.vy / now.state.vtheta).powi(2);
    }
    let ratio = (up / along).sqrt();
    let evidence =
        format!("generalised force of the vertical part over that of the horizontal: {ratio:.3}");
    Finding::new(Verdict::of(ratio < 0.2), evidence)
}

fn of_arc(weak: &Weak) -> Vec<Claim> {
    vec![
        claim(
            "6.5.2.2-09",
            "The turning points of the bouncing lie above the arc of rocking (Fig 6.45).",
            above_arc(weak),
        ),
        claim(
            "6.5.2.2-10",
            "At those impacts the body is turned away from the rotation at which both cables are \
             taut.",
            turned_away(weak),
        ),
        claim(
            "6.5.2.2-11",
            "The curve of rocking is an arc of a circle.",
            circle(weak),
        ),
    ]
}

fn above_arc(weak: &Weak) -> Finding {
    let (lowest, _) = range(weak.impacts.iter().map(|impact| impact.height));
    let clear = weak.impacts.iter().filter(|impact| impact.clear);
    let (lowest_clear, _) = range(clear.clone().map(|impact| impact.height));
    let evidence = format!(
        "{} impacts, the lowest {lowest:.0e} above it; {} clear ones, the lowest \
         {lowest_clear:.0e}",
        weak.impacts.len(),
        clear.count()
    );
    Finding::new(Verdict::of(lowest >= -1e-9 && lowest_clear > 0.0), evidence)
}

fn turned_away(weak: &Weak) -> Finding {
    let clear = weak.impacts.iter().filter(|impact| impact.clear);
    let points: Vec<(f64, f64)> = clear.map(|impact| (impact.height, impact.turned)).collect();
    let rho = spearman(&points);
    let evidence = format!("rank correlation of height above the arc and rotation away: {rho:.3}");
    Finding::new(
        Verdict::of(rho > 0.5 && points.iter().all(|p| p.0 > 0.0)),
        evidence,
    )
}

fn circle(weak: &Weak) -> Finding {
    let run = &weak.own.run;
    let widest = weak.largest(|now| now.state.theta.abs());
    let (radius, miss) = fit_circle(run.system(), widest);
    let (_, miss_wide) = fit_circle(run.system(), 1.4);
    let evidence = format!(
        "over |θ| <= {widest:.2}: radius {radius:.3}, off by {:.2} % of it; over |θ| <= 1.4: \
         {:.1} %",
        100.0 * miss,
        100.0 * miss_wide
    );
    Finding::new(Verdict::of(miss < 0.01), evidence)
}

/// Radius of the circle x² + y² = 2my + c nearest to the arc, and its largest miss over the radius. The
/// arc is symmetric, so the centre has x = 0.
fn fit_circle(system: &System, widest: f64) -> (f64, f64) {
    let theta = |k: i32| widest * f64::from(k) / 20.0;
    let points: Vec<State> = (-20..=20).map(|k| arc_of(system, theta(k))).collect();
    let number = points.len() as f64;
    let square = |p: &State| p.x * p.x + p.y * p.y;
    let mean = |figure: &dyn Fn(&State) -> f64| points.iter().map(figure).sum::<f64>() / number;
    let (y, s) = (mean(&|p| p.y), mean(&square));
    let slope = mean(&|p| (p.y - y) * (square(p) - s)) / mean(&|p| (p.y - y).powi(2));
    let centre = 0.5 * slope;
    let radius = (s - slope * y + centre * centre).sqrt();
    let miss = |p: &State| (p.x.hypot(p.y - centre) - radius).abs() / radius;
    (radius, range(points.iter().map(miss)).1)
}
