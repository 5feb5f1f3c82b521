//! The motion of an assessment at given times, in SI.

use super::assess::Assessment;
use snapload::Playback;

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
    pub fn motion_at(&self, times_s: &[f64]) -> Vec<MotionSi> {
        let scales = &self.prepared.model.scales;
        let lines = self.prepared.structure.lines.len();
        let mut playback = Playback::new(&self.run);
        let one = |t_s: &f64| {
            let t = (t_s / scales.time_s).clamp(0.0, self.run.end().t);
            let motion = playback.at(t);
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
        times_s.iter().map(one).collect()
    }
}
