//! The motion of a run as columns, at the times that a page asks for.
use serde::ser::{Serialize, Serializer};
use snapload::{Impact, Motion, Playback, Trajectory};
use snapload_report::{MOTION, MotionRow};

/// A motion as columns, under the names of `motion.csv`.
pub(crate) struct Columns([Vec<f64>; 10]);

impl Columns {
    /// The motion at the requested times, and just before and just after each impact.
    pub(crate) fn of(run: &Trajectory, impacts: &[Impact], sampling: Times) -> Self {
        let mut columns = Self(Default::default());
        let mut playback = Playback::new(run);
        let mut instants = impacts.chunk_by(|p, q| p.t == q.t).peekable();
        let mut latest = f64::NEG_INFINITY;
        for t in sampling.of(run) {
            while let Some([first, ..]) = instants.next_if(|instant| instant[0].t <= t) {
                let mut before = playback.at(first.t.next_down());
                before.t = first.t;
                before.state = first.before;
                before.energy = run.system().energy(&first.before);
                columns.push(&before);
                columns.push(&playback.at(first.t));
                latest = first.t;
            }
            if t > latest {
                columns.push(&playback.at(t));
            }
        }
        columns
    }

    /// One row: that of a motion at one time.
    pub(crate) fn at(motion: &Motion) -> Self {
        let mut columns = Self(Default::default());
        columns.push(motion);
        columns
    }

    fn push(&mut self, motion: &Motion) {
        for (column, number) in self.0.iter_mut().zip(MotionRow::new(motion).0) {
            column.push(number);
        }
    }
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(MOTION.iter().zip(&self.0))
    }
}

/// The times at which a motion is sent.
#[derive(Clone, Copy)]
pub(crate) struct Times {
    pub(crate) samples: u32,
    pub(crate) window: Option<[f64; 2]>,
}

impl Times {
    /// Evenly spaced from the start to the end, and more densely within the window.
    fn of(self, run: &Trajectory) -> Vec<f64> {
        let end = run.end().t;
        let mut times: Vec<f64> = self.evenly(0.0, end).collect();
        if let Some([from, to]) = self.window.filter(|[from, _]| *from < end) {
            times.extend(self.evenly(from, to.min(end)));
            times.sort_unstable_by(f64::total_cmp);
            times.dedup();
        }
        times
    }

    fn evenly(self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let last = self.samples - 1;
        (0..self.samples).map(move |k| match k == last {
            true => to,
            false => from + (to - from) * f64::from(k) / f64::from(last),
        })
    }
}
