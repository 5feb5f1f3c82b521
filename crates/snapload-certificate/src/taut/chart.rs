//! Coordinates of motion with taut cables, in which the lengths of those cables are exact.

use crate::arithmetic::ball::Ball;
use crate::arithmetic::interval::Interval;
use crate::arithmetic::scalar::Jet;
use crate::model::{Model, State};
use crate::taut::series::{Program, Term};
use crate::verdict::ProofFailure;

/// The event functions along a taut motion: the motion ends where one of them reaches
/// zero from below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EventFunction {
    /// −T of a taut cable, T its tension; by index from 0.
    Tension(usize),
    /// The gap of a slack one.
    Gap(usize),
    /// θ − π/2 or −θ − π/2.
    Rotation,
    /// The height of a top over the anchors' level.
    Top,
}

impl EventFunction {
    /// The event that ends the motion where it reaches zero, in words.
    pub(crate) fn event_name(self) -> String {
        match self {
            Self::Tension(cable) => format!("the end of the tension of cable {}", cable + 1),
            Self::Gap(cable) => format!("the length of cable {}", cable + 1),
            Self::Rotation => "the rotation limit".to_owned(),
            Self::Top => "the upper bound".to_owned(),
        }
    }
}

/// The equations of motion as terms, with the event functions as their outputs.
pub(crate) struct Terms {
    pub(crate) program: Program,
    pub(crate) event_functions: Vec<EventFunction>,
}

impl Terms {
    /// Adds an output.
    pub(crate) fn add_event_function(&mut self, what: EventFunction, value: Term) {
        self.event_functions.push(what);
        self.program.outputs.push(value);
    }

    /// Adds both sides of the rotation limit.
    pub(crate) fn add_rotation_events(&mut self, model: &Model, theta: Term) {
        let limit = self.program.constant(model.functions.half_pi().clone());
        let minus_theta = self.program.negate(theta);
        for angle in [theta, minus_theta] {
            let over = self.program.subtract(angle, limit);
            self.add_event_function(EventFunction::Rotation, over);
        }
    }
}

/// x, y, θ and their rates, with their derivatives with respect to the six coordinates and the
/// time.
pub(crate) type StateJets = [Jet<Interval, 7>; 6];

/// N coordinates of the motion with some cables taut, their rates included.
pub(crate) trait Chart<const N: usize> {
    fn terms(&self, model: &Model) -> Terms;
    /// The coordinates of a state in which those cables are taut and have no normal velocity.
    fn coordinates(&self, model: &Model, state: &State) -> Result<[Ball; N], ProofFailure>;
    /// The derivatives of the coordinates of such a state; none where they are not known.
    fn slopes(&self, model: &Model, state: &StateJets) -> Option<[[Interval; 7]; N]>;
    /// A program whose outputs are the state that belongs to given coordinates.
    fn place(&self, model: &Model) -> Program;
}

/// f_x and f_y − 1.
pub(crate) fn force(p: &mut Program, model: &Model) -> [Term; 2] {
    let weight = p.constant(Ball::integer(1));
    if model.is_steady {
        let nothing = p.constant(Ball::zero());
        let fx = p.constant(model.f_o.clone());
        return [fx, p.subtract(nothing, weight)];
    }
    let phase = p.phase(model.omega.clone());
    let (sine, cosine) = p.sin_cos(phase);
    let fx = p.scale(cosine, model.f_o.clone());
    let fy = p.scale(sine, &model.nu * &model.f_o);
    [fx, p.subtract(fy, weight)]
}

/// The vector of the body rotated by θ, from sin θ and cos θ.
pub(crate) fn arm(p: &mut Program, [a, b]: [&Ball; 2], [sine, cosine]: [Term; 2]) -> [Term; 2] {
    let [a_cos, a_sin] = [p.scale(cosine, a.clone()), p.scale(sine, a.clone())];
    let [b_cos, b_sin] = [p.scale(cosine, b.clone()), p.scale(sine, b.clone())];
    [p.subtract(a_cos, b_sin), p.add(a_sin, b_cos)]
}

/// 1 for the right cable, −1 for the left one.
pub(crate) fn side(cable: usize) -> i64 {
    if cable == 0 { 1 } else { -1 }
}

/// ρ and D = P − A of a cable, for a position of the centre.
pub(crate) fn end(
    p: &mut Program,
    model: &Model,
    cable: usize,
    at: [Term; 2],
    turn: [Term; 2],
) -> [[Term; 2]; 2] {
    let a = &model.a * &Ball::integer(side(cable));
    let lever = arm(p, [&a, &model.b], turn);
    let anchor = p.constant(Ball::integer(side(cable)));
    let level = p.constant(model.level.clone());
    let end = p.sum(at, lever);
    [lever, p.difference(end, [anchor, level])]
}
