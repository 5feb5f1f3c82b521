//! The motion at evenly spaced times: its columns, its rows and its times.

use serde::{Serialize, Serializer};
use snapload::Motion;

/// The columns of the motion.
pub const MOTION: [&str; 10] = [
    "t", "x", "y", "theta", "vx", "vy", "vtheta", "T1", "T2", "energy",
];

/// The times at which a motion is written: every multiple of a step before the end, and the end
/// itself once.
#[derive(Clone, Copy)]
pub struct Sampling {
    dt: f64,
    /// The digits of the step as a whole number, and the power of ten by which to divide it, if
    /// doubles hold both exactly.
    decimal: Option<[f64; 2]>,
    most: u64,
    end: f64,
}

/// Doubles hold all whole numbers up to this one, and all powers of ten up to that exponent.
const WHOLE: f64 = 9_007_199_254_740_992.0;
const POWERS: usize = 22;

/// The most rows of a sampled motion.
const MOST_ROWS: u64 = 10_000_000;

impl Sampling {
    /// Steps of `dt`.
    ///
    /// # Errors
    /// What is allowed, if the steps are not possible or would give too many rows.
    pub fn every(dt: f64, end: f64) -> Result<Self, String> {
        let most = MOST_ROWS - 1;
        // Rounding may keep the last multiple below the end, so the condition is checked as it is
        // computed.
        if dt > 0.0 && dt.is_finite() && most as f64 * dt >= end {
            let decimal = decimal(dt);
            return Ok(Self {
                dt,
                decimal,
                most,
                end,
            });
        }
        let least = end / most as f64 * 1.05;
        Err(format!(
            "a number above 0 that gives no more than {MOST_ROWS:e} rows for a run up to t = {end}: \
             {least:.1e} or above"
        ))
    }

    /// A thousand equal steps, at the times of [`Self::every`] with such a step.
    pub fn thousand(end: f64) -> Self {
        let dt = end / 1000.0;
        Self {
            dt,
            decimal: decimal(dt),
            most: 1000,
            end,
        }
    }

    /// The times.
    pub fn times(self) -> impl Iterator<Item = f64> {
        let multiples = (0..self.most).map(move |k| self.multiple(k as f64));
        multiples
            .take_while(move |t| *t < self.end)
            .chain(std::iter::once(self.end))
    }

    /// k steps: for a step that is a decimal number the double nearest to the exact decimal, 0.3
    /// and not 0.30000000000000004.
    fn multiple(self, k: f64) -> f64 {
        match self.decimal {
            Some([digits, power]) if k * digits <= WHOLE => k * digits / power,
            _ => k * self.dt,
        }
    }
}

/// The digits of a number in decimal notation and the power of ten below them.
fn decimal(number: f64) -> Option<[f64; 2]> {
    let text = format!("{number}");
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let digits: f64 = format!("{whole}{fraction}").parse().ok()?;
    let power: f64 = format!("1e{}", fraction.len()).parse().ok()?;
    (digits <= WHOLE && fraction.len() <= POWERS).then_some([digits, power])
}

/// One line of the sampled motion: the values of [`MOTION`], in that order.
pub struct MotionRow(pub [f64; 10]);

impl MotionRow {
    /// Of a motion.
    pub fn new(motion: &Motion) -> Self {
        let [x, y, theta, vx, vy, vtheta] = motion.state.components();
        let [tension_1, tension_2, ..] = motion.tensions;
        Self([
            motion.t,
            x,
            y,
            theta,
            vx,
            vy,
            vtheta,
            tension_1,
            tension_2,
            motion.energy,
        ])
    }
}

impl Serialize for MotionRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(MOTION.iter().zip(&self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_the_decimals_that_one_writes() -> Result<(), String> {
        for (dt, places) in [(0.1, 1), (0.07, 2), (1e-3, 3), (20.0, 0)] {
            let times: Vec<f64> = Sampling::every(dt, 1000.0 * dt)?.times().collect();
            assert_eq!(times.len(), 1001);
            for (k, time) in times.into_iter().enumerate() {
                let written = format!("{:.places$}", k as f64 * dt);
                assert_eq!(Ok(time), written.parse(), "{written}");
            }
        }
        Ok(())
    }
}
