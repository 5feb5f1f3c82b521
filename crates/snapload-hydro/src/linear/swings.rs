//! The turns of a decay, and its swings from one to the next.

use super::decay::Decay;
use std::f64::consts::PI;

/// Where a freedom turns back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// When \[s\].
    pub t_s: f64,
    /// Where, measured from zero \[m, rad\].
    pub height: f64,
}

/// One swing of a decay, from one turning point to the next on the same side.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// When it begins \[s\].
    pub from_s: f64,
    /// The amplitude there: from zero, or of a freedom that does not come back there from where it
    /// swings about.
    pub amplitude: f64,
    /// How long it takes \[s\].
    pub period_s: f64,
    /// ζ = δ/sqrt(4π² + δ²), δ the logarithm of the ratio of the amplitudes.
    pub damping_ratio: f64,
}

/// Ways between turns below so much of the furthest turn are rounding.
const ROUNDING: f64 = 1e-9;

/// Halvings of a step in the search for a turn, down to the rounding of a double.
const HALVINGS: u32 = 53;

impl Turn {
    /// The release, if it is not at zero.
    pub(super) fn at_release(height: f64) -> Option<Self> {
        (height != 0.0).then_some(Self { t_s: 0.0, height })
    }

    /// The turn in a step from t that takes h, from place and velocity at its start and the
    /// velocity and the accelerations at both ends. The velocity between them is taken as a cubic.
    pub(super) fn between([t_s, h_s]: [f64; 2], x: f64, [v0, v1]: [f64; 2], a: [f64; 2]) -> Self {
        let [a0, a1] = a.map(|a| a * h_s);
        let (b, c) = (3.0 * (v1 - v0) - 2.0 * a0 - a1, 2.0 * (v0 - v1) + a0 + a1);
        let velocity = |s: f64| v0 + s * (a0 + s * (b + s * c));
        let [mut before, mut after] = [0.0, 1.0];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (before + after);
            if changes_sign([v0, velocity(middle)]) {
                after = middle;
            } else {
                before = middle;
            }
        }
        let s = after;
        let way = s * (v0 + s * (a0 / 2.0 + s * (b / 3.0 + s * c / 4.0)));
        Self {
            t_s: t_s + s * h_s,
            height: x + h_s * way,
        }
    }
}

/// Whether the velocity changes its sign or becomes zero. One that was zero before has turned
/// already.
pub(super) fn changes_sign([before, after]: [f64; 2]) -> bool {
    before != 0.0 && (after == 0.0 || (before > 0.0) != (after > 0.0))
}

/// The swings of one freedom, from its turning points: about zero where a stiffness brings it back
/// there. Surge without lines stays where it ends, and is described by the distances between its
/// turns: in a swing with the ratio q² of one amplitude to the next about any place, the way from a
/// turn to the next is the amplitude times 1 + q. Swings below a thousandth of the first are left
/// out.
pub fn swings(decay: &Decay, freedom: usize) -> Vec<Swing> {
    let turns = &decay.turns[freedom];
    let about_zero = decay.comes_back[freedom];
    let heights: Vec<f64> = match about_zero {
        true => turns.iter().map(|turn| turn.height).collect(),
        false => turns
            .windows(2)
            .map(|two| two[0].height - two[1].height)
            .collect(),
    };
    let furthest = turns
        .iter()
        .map(|turn| turn.height.abs())
        .fold(0.0, f64::max);
    let first = heights.first().map_or(0.0, |height| height.abs());
    let least = (1e-3 * first).max(ROUNDING * furthest);
    let swing = |k: usize| {
        let (x0, x1) = (heights[k], heights[k + 2]);
        let ratio = x1 / x0;
        (ratio > 0.0 && ratio.is_finite() && x1.abs() > least).then(|| {
            let delta = -ratio.ln();
            Swing {
                from_s: turns[k].t_s,
                amplitude: if about_zero {
                    x0
                } else {
                    x0 / (1.0 + ratio.sqrt())
                },
                period_s: turns[k + 2].t_s - turns[k].t_s,
                damping_ratio: delta / (4.0 * PI * PI + delta * delta).sqrt(),
            }
        })
    };
    (0..heights.len().saturating_sub(2))
        .filter_map(swing)
        .collect()
}
