//! A body that slides on one taut cable: at random, in the terms of the chapter and of Newton's law.

use crate::claims::equations::*;
use crate::claims::newton::{Held, Jet, Moment, Mooring, Numbers, Side};

/// So many random bodies; each hangs on its left cable and on its right one.
const BODIES: usize = 300;
/// Deviation of the forces: as large as the weight, so that cables lose their tension, too.
const FORCE: f64 = 1.0;
/// The seed of the random states.
const SEED: u64 = 6_511;

/// A body on one taut cable.
pub(super) struct Sliding {
    pub(super) side: Side,
    pub(super) angles: Angles,
    pub(super) moment: Moment,
    pub(super) held: Held<1>,
    /// α̈ and β̈ by Newton's law.
    pub(super) second: [f64; 2],
}

impl Sliding {
    pub(super) fn new(mooring: Mooring, side: Side, angles: Angles, force: [f64; 2]) -> Self {
        let [x, y, theta] = eq_6_5_place(&mooring, side, angles.path(0.0, 0.0));
        let moment = Moment {
            mooring,
            place: [x.value, y.value, theta.value],
            velocity: [x.rate, y.rate, theta.rate],
            force,
        };
        let held = moment.held(side);
        let [ax, ay, atheta] = held.acceleration;
        // θ̈ tells β̈; what ẍ and ÿ then still lack is α̈ along the cable's turning.
        let beta = atheta * [-1.0, 1.0][usize::from(side == Side::Left)];
        let [x, y, _] = eq_6_5_place(&mooring, side, angles.path(0.0, beta));
        let [along_x, along_y, _] = eq_6_5_place(
            &mooring,
            side,
            [Jet::new(angles.alpha, 1.0, 0.0), Jet::constant(angles.beta)],
        );
        let alpha = ((ax - x.second) * along_x.rate + (ay - y.second) * along_y.rate)
            / (mooring.r * mooring.r);
        Self {
            side,
            angles,
            moment,
            held,
            second: [alpha, beta],
        }
    }

    pub(super) fn lambda(&self) -> f64 {
        self.held.lambda[0]
    }

    pub(super) fn forces(&self) -> [f64; 2] {
        eq_6_26_forces(
            &self.moment.mooring,
            self.side,
            &self.angles,
            self.moment.force,
        )
    }

    /// What 6.28 and 6.29 leave over, as printed.
    pub(super) fn motion_residuals(&self) -> [f64; 2] {
        let m = &self.moment.mooring;
        let [a11, a12, a22] = eq_6_30_matrix(m, &self.angles);
        let [b1, b2] = eq_6_34_right_sides(m, &self.angles, self.forces());
        let [alpha, beta] = self.second;
        [a11 * alpha + a12 * beta - b1, a12 * alpha + a22 * beta - b2]
    }
}

/// The random bodies, each on both cables in turn.
pub(super) fn random_states() -> Vec<Sliding> {
    let mut numbers = Numbers::new(SEED);
    let mut all = Vec::new();
    for _ in 0..BODIES {
        let circle = numbers.between(0.0, 1.0) < 0.3;
        let height = numbers.between(0.0, 0.4);
        let mooring = Mooring {
            a: numbers.between(0.05, 0.4),
            b: if circle { 0.0 } else { height },
            r: numbers.between(1.2, 3.0),
            inertia: numbers.between(0.005, 0.2),
        };
        let angles = Angles {
            alpha: numbers.between(-1.2, 1.2),
            beta: numbers.between(0.2, std::f64::consts::PI - 0.2),
            alpha_rate: numbers.normal(1.0),
            beta_rate: numbers.normal(1.0),
        };
        let force = [numbers.normal(FORCE), numbers.normal(FORCE)];
        all.extend(Side::BOTH.map(|side| Sliding::new(mooring, side, angles, force)));
    }
    all
}

/// Circles whose cable points to their centre, β = α, which 6.44 can not judge.
pub(super) fn pointing_to_the_centre() -> Vec<Sliding> {
    let mut numbers = Numbers::new(SEED + 1);
    let mut state = || {
        let mooring = Mooring {
            a: numbers.between(0.05, 0.4),
            b: 0.0,
            r: numbers.between(1.2, 3.0),
            inertia: numbers.between(0.005, 0.2),
        };
        let alpha = numbers.between(0.2, 1.2);
        let angles = Angles {
            alpha,
            beta: alpha,
            alpha_rate: numbers.normal(0.2),
            beta_rate: numbers.normal(0.2),
        };
        let force = [numbers.normal(FORCE), numbers.normal(FORCE)];
        Sliding::new(mooring, Side::Left, angles, force)
    };
    (0..BODIES).map(|_| state()).collect()
}
