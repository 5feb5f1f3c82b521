//! The section at impacts: a point an impact, with the phase of the forcing.
//!
//! The stroboscopic section looks at a motion at one phase of the forcing, whatever it does then; this
//! one where a cable is struck, whatever the phase is. For one bouncing coordinate the phase and the
//! velocity after the impact tell all of the motion (P. J. Holmes, *J. Sound Vib.* 84 (1982) 173).

use crate::hybrid::Point;
use serde::Serialize;
use snapload::Step;

/// An impact of a long motion.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ImpactPoint {
    /// When.
    pub t: f64,
    /// t in periods of the forcing, without the whole ones: from 0 to below 1.
    pub phase: f64,
    /// The cable, from 1.
    pub cable: usize,
    /// The velocity v_n at which it is struck.
    pub v_n: f64,
    /// Its impulse.
    pub impulse: f64,
    /// The state just before.
    pub before: Point,
    /// The state just after.
    pub after: Point,
}

/// More impacts than this are not kept: they take some 300 MB.
pub const MOST_KEPT: usize = 2_000_000;

/// Impacts as they are kept.
#[derive(Clone, Debug, Default)]
pub struct Impacts {
    /// The impacts, in their order.
    pub points: Vec<ImpactPoint>,
    /// How many came after the last that is kept.
    pub left_out: u64,
}

impl Impacts {
    /// Keeps those at the end of a step; a taut cable that only passes an impulse on is not struck.
    pub(crate) fn take(&mut self, step: &Step, period: f64) {
        for impact in step.impacts().filter(|impact| impact.v_n > 0.0) {
            if self.points.len() == MOST_KEPT {
                self.left_out += 1;
                continue;
            }
            self.points.push(ImpactPoint {
                t: impact.t,
                phase: phase_of(impact.t, period),
                cable: impact.cable + 1,
                v_n: impact.v_n,
                impulse: impact.impulse,
                before: impact.before.components(),
                after: impact.after.components(),
            });
        }
    }
}

/// A time in periods without the whole ones. What rounds to a whole one is 0.
fn phase_of(t: f64, period: f64) -> f64 {
    let phase = (t / period).rem_euclid(1.0);
    if phase < 1.0 { phase } else { 0.0 }
}
