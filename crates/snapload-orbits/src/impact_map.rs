//! The section at impacts: one point for each impact, with the phase of the forcing.
//!
//! The stroboscopic section records a motion at one phase of the forcing, this one at each impact,
//! at whatever phase. For one bouncing coordinate the phase and the velocity after the impact
//! determine the whole motion (P. J. Holmes, *J. Sound Vib.* 84 (1982) 173).

use crate::hybrid::Point;
use serde::Serialize;
use snapload::Step;

/// An impact of a long motion.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ImpactPoint {
    /// When.
    pub t: f64,
    /// The fractional part of t in periods of the forcing: from 0 to below 1.
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

/// The most impacts that are kept, which take some 300 MB.
pub const MOST_KEPT: usize = 2_000_000;

/// The impacts that are kept.
#[derive(Clone, Debug, Default)]
pub struct Impacts {
    /// The impacts, in their order.
    pub points: Vec<ImpactPoint>,
    /// The number of impacts after the last one kept.
    pub left_out: u64,
}

impl Impacts {
    /// Keeps those at the end of a step, without impulses that a taut cable only takes with
    /// another's.
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

/// The fractional part of a time in periods. A time that rounds to a whole number of periods gives
/// 0.
fn phase_of(t: f64, period: f64) -> f64 {
    let phase = (t / period).rem_euclid(1.0);
    if phase < 1.0 { phase } else { 0.0 }
}
