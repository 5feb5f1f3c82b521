//! The motion at evenly spaced times: its columns and its rows.

use serde::{Serialize, Serializer};
use snapload::Motion;

/// The columns of the motion.
pub const MOTION: [&str; 10] = [
    "t", "x", "y", "theta", "vx", "vy", "vtheta", "T1", "T2", "energy",
];

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
