//! The motion of a structure within a time interval, as columns in metres, kilonewtons and seconds.
use serde::ser::{Serialize, SerializeMap, Serializer};
use snapload::{Impact, Motion, Playback, State, Trajectory};
use snapload_structure::{ElasticRun, Scales};

/// Rows within the interval that is shown.
const ROWS: u32 = 1500;

/// Times, positions, velocities and tensions, one row for each time; angles and positions are for z
/// up. Times are doubles; the rest is drawn, for which single precision is enough.
#[derive(Default)]
pub(super) struct Columns {
    t: Vec<f64>,
    state: [Vec<f32>; 6],
    /// By line.
    tension: Vec<Vec<f32>>,
}

impl Columns {
    fn new(lines: usize) -> Self {
        Self {
            tension: vec![Vec::new(); lines],
            ..Self::default()
        }
    }

    /// Of inextensible lines, with rows just before and just after each snap.
    pub(super) fn of(run: &Trajectory, scales: &Scales, [from, to]: [f64; 2]) -> Self {
        let mut columns = Self::new(run.system().cables.len());
        let mut playback = Playback::new(run);
        let unit = scales.time_s;
        let first = run
            .impacts()
            .partition_point(|impact| impact.t * unit < from);
        let within = run.impacts()[first..]
            .iter()
            .take_while(|impact| impact.t * unit <= to);
        let mut snaps = within.peekable();
        for k in 0..=ROWS {
            let t = from + (to - from) * f64::from(k) / f64::from(ROWS);
            while let Some(snap) = snaps.next_if(|snap| snap.t * unit <= t) {
                columns.before_and_after(&mut playback, scales, snap);
            }
            columns.at(&mut playback, scales, t / unit);
        }
        columns
    }

    /// One row: that of a motion at one time.
    pub(super) fn at_instant(run: &Trajectory, scales: &Scales, motion: &Motion) -> Self {
        let mut columns = Self::new(run.system().cables.len());
        columns.push_motion(motion, scales);
        columns
    }

    fn before_and_after(&mut self, playback: &mut Playback<'_>, scales: &Scales, snap: &Impact) {
        let t = snap.t * scales.time_s;
        // Snaps of several lines at one instant share their rows.
        if self.t.last().is_some_and(|last| *last >= t) {
            return;
        }
        let before = playback.at(snap.t.next_down());
        self.push(scales, t, &before.state, |line| {
            before.tensions[line] * scales.force_n
        });
        self.at(playback, scales, snap.t);
    }

    fn at(&mut self, playback: &mut Playback<'_>, scales: &Scales, t: f64) {
        self.push_motion(&playback.at(t), scales);
    }

    fn push_motion(&mut self, motion: &Motion, scales: &Scales) {
        self.push(scales, motion.t * scales.time_s, &motion.state, |line| {
            motion.tensions[line] * scales.force_n
        });
    }

    /// Of elastic lines.
    pub(super) fn of_elastic(run: &ElasticRun, scales: &Scales, [from, to]: [f64; 2]) -> Self {
        let lines = run
            .samples
            .first()
            .map_or(0, |sample| sample.tension_n.len());
        let mut columns = Self::new(lines);
        let first = run.samples.partition_point(|sample| sample.t_s < from);
        let within = run.samples[first..]
            .iter()
            .take_while(|sample| sample.t_s <= to);
        let count = within.clone().count();
        // At most as many rows as for the other model; the peaks between them are sent separately.
        let stride = count.div_ceil(ROWS as usize).max(1);
        for sample in within.step_by(stride) {
            columns.push(scales, sample.t_s, &sample.state, |line| {
                sample.tension_n[line]
            });
        }
        columns
    }

    fn push(&mut self, scales: &Scales, t_s: f64, state: &State, newtons: impl Fn(usize) -> f64) {
        let [x, z] = scales.to_si([state.x, state.y]);
        let speed = scales.speed_m_s();
        let turning = 1.0 / scales.time_s;
        let row = [
            x,
            z,
            -state.theta,
            state.vx * speed,
            -state.vy * speed,
            -state.vtheta * turning,
        ];
        self.t.push(t_s);
        for (column, number) in self.state.iter_mut().zip(row) {
            column.push(number as f32);
        }
        for (line, column) in self.tension.iter_mut().enumerate() {
            column.push((newtons(line).max(0.0) / 1e3) as f32);
        }
    }
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("t", &self.t)?;
        let names = ["x", "z", "theta", "vx", "vz", "vtheta"];
        for (name, column) in names.iter().zip(&self.state) {
            map.serialize_entry(name, column)?;
        }
        map.serialize_entry("tensions", &self.tension)?;
        map.end()
    }
}
