//! A sign of life from whatever takes longer than two seconds: on standard error, on a terminal only.
use indicatif::{ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// So much time passes without a bar.
const PATIENCE: Duration = Duration::from_secs(2);

/// Reports how far something has come.
pub(crate) struct Progress {
    what: &'static str,
    whole: f64,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Of something that goes from 0 to `whole`.
    pub(crate) fn new(what: &'static str, whole: f64) -> Self {
        Self {
            what,
            whole,
            began: Instant::now(),
            bar: None,
        }
    }

    /// It has come to `part`.
    pub(crate) fn show(&mut self, part: f64) {
        if self.began.elapsed() < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let style = ProgressStyle::with_template("{msg} {bar:40} {percent} %, {eta} left");
            let bar = ProgressBar::new(1000).with_message(self.what);
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
                .with_elapsed(self.began.elapsed())
        });
        bar.set_position((1000.0 * part / self.whole) as u64);
    }
}

/// Counts what is done of many, from any thread, with the rate and the time left.
pub(crate) struct Counter(ProgressBar);

impl Counter {
    /// Of so many, some of which were there before.
    pub(crate) fn new(what: &'static str, all: u64, before: u64) -> Self {
        let style = ProgressStyle::with_template(
            "{msg} {bar:30} {human_pos} of {human_len}, {per_sec:0}, {eta} left",
        );
        let bar = ProgressBar::new(all)
            .with_message(what)
            .with_position(before);
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.reset_eta();
        Self(bar)
    }

    /// One more.
    pub(crate) fn one(&self) {
        self.0.inc(1);
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
