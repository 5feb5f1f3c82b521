//! The motion of an assessment at given times, in SI.

use super::assess::Assessment;
use snapload::{CaseError, Playback};

/// Position, rotation and tensions at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSi {
    /// Centre `[x, z]` \[m\].
    pub place_m: [f64; 2],
    /// Rotation, counter-clockwise with z up \[rad\].
    pub theta_rad: f64,
    /// Tension of each line, 0 where it is slack \[N\].
    pub tension_n: Vec<f64>,
}

impl Assessment {
    /// The motion at times within the run, most quickly for increasing times \[s\].
    ///
    /// # Errors
    /// A [`CaseError`] that names the first time before the start or after the end of the run.
    pub fn motion_at(&self, times_s: &[f64]) -> Result<Vec<MotionSi>, CaseError> {
        let scales = &self.prepared.model.scales;
        let lines = self.prepared.structure.lines.len();
        let end = self.run.end().t;
        let end_s = self.outcome.end_s;
        if let Some(outside) = times_s.iter().find(|t_s| !(0.0..=end_s).contains(*t_s)) {
            let allowed = format!("0 to {end_s} s, the end of the run");
            return Err(CaseError::value("times", outside, allowed));
        }
        let mut playback = Playback::new(&self.run);
        let one = |t_s: &f64| {
            // The end may be rounded up in the engine's units.
            let motion = playback.at((t_s / scales.time_s).min(end));
            let tension = |line: usize| match motion.taut.contains(line) {
                true => motion.tensions[line] * scales.force_n,
                false => 0.0,
            };
            MotionSi {
                place_m: scales.to_si([motion.state.x, motion.state.y]),
                theta_rad: 0.0 - motion.state.theta,
                tension_n: (0..lines).map(tension).collect(),
            }
        };
        Ok(times_s.iter().map(one).collect())
    }
}
