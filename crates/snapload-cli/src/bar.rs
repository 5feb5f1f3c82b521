//! The progress bar, on standard error and only on a terminal.
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressStyle};
use snapload::analysis::Progress;
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

/// The time that passes before a bar is shown.
const DELAY: Duration = Duration::from_secs(2);
/// The time between two drawings of a bar, which cost more than a case does.
const PAUSE: Duration = Duration::from_millis(50);
/// The form of a bar in per cent.
const PARTS: &str = "{msg} {bar:40} {percent} %{prefix}";
/// The form of a bar in numbers, with the rate.
const COUNTS: &str = "{msg} {bar:30} {human_pos} of {human_len}{prefix}";

/// Shows the progress of work; it disappears when it is dropped.
pub(crate) struct Bar {
    counts: bool,
    began: Instant,
    stage: Arc<Mutex<Stage>>,
}

/// The work that is being done, its beginning, and the bar that shows it.
struct Stage {
    doing: String,
    done: f64,
    of: f64,
    began: Instant,
    /// What was done already when it began.
    done_before: f64,
    /// When its bar was drawn last.
    drawn: Instant,
    bar: Option<ProgressBar>,
}

impl Bar {
    /// A bar for work that may take longer than two seconds.
    pub(crate) fn new() -> Self {
        let bar = Self {
            counts: false,
            began: Instant::now(),
            stage: Arc::new(Mutex::new(Stage::new(Progress::new("", 0.0, 1.0)))),
        };
        if std::io::stderr().is_terminal() {
            show_late(Arc::downgrade(&bar.stage));
        }
        bar
    }

    /// A bar for many cases, which are counted and shown from the beginning.
    pub(crate) fn counting() -> Self {
        let mut bar = Self::new();
        bar.counts = true;
        bar
    }

    /// The callback for long work; it always lets the work continue.
    pub(crate) fn show(&self, progress: Progress) -> ControlFlow<()> {
        // If another thread is updating the bar, this update is skipped.
        if let Ok(mut stage) = self.stage.try_lock() {
            stage.update(progress);
            let is_fresh = stage.bar.is_some() && stage.drawn.elapsed() < PAUSE;
            if !is_fresh && self.counts {
                stage.count();
            } else if !is_fresh && self.began.elapsed() >= DELAY {
                stage.part();
            }
        }
        ControlFlow::Continue(())
    }
}

/// Shows the bar after the delay if work has begun but has reported nothing since.
fn show_late(stage: Weak<Mutex<Stage>>) {
    std::thread::spawn(move || {
        std::thread::sleep(DELAY);
        let Some(stage) = stage.upgrade() else { return };
        if let Ok(mut stage) = stage.lock()
            && !stage.doing.is_empty()
            && stage.bar.is_none()
        {
            stage.part();
        }
    });
}

impl Stage {
    fn new(progress: Progress) -> Self {
        Self {
            doing: progress.doing.to_owned(),
            done: progress.done,
            of: progress.of,
            began: Instant::now(),
            done_before: progress.done,
            drawn: Instant::now(),
            bar: None,
        }
    }

    /// Work of another name that has not come as far is another stage, with a bar of its own.
    fn update(&mut self, progress: Progress) {
        let is_new = self.doing != progress.doing;
        if is_new && progress.done / progress.of <= self.done / self.of {
            *self = Self::new(progress);
        } else {
            (self.done, self.of) = (progress.done, progress.of);
            if is_new {
                self.doing = progress.doing.to_owned();
            }
        }
    }

    fn part(&mut self) {
        let left = self.left().unwrap_or_default();
        let position = (1000.0 * self.done / self.of) as u64;
        // Its first drawing is with the position already.
        let new = || styled(PARTS, 1000).with_position(position);
        let bar = self.bar.get_or_insert_with(new);
        if bar.message() != self.doing {
            bar.set_message(self.doing.clone());
        }
        bar.set_prefix(left);
        bar.set_position(position);
        self.drawn = Instant::now();
    }

    fn count(&mut self) {
        let words = match (self.rate(), self.left()) {
            (Some(rate), Some(left)) => format!(", {}/s{left}", HumanCount(rate as u64)),
            _ => String::new(),
        };
        let new = || {
            let bar = styled(COUNTS, self.of as u64).with_position(self.done as u64);
            bar.with_message(self.doing.clone())
        };
        let bar = self.bar.get_or_insert_with(new);
        bar.set_prefix(words);
        bar.set_position(self.done as u64);
        self.drawn = Instant::now();
    }

    /// What is done in a second, on average since this work began; none before something is done.
    fn rate(&self) -> Option<f64> {
        let rate = (self.done - self.done_before) / self.began.elapsed().as_secs_f64();
        (rate > 0.0 && rate.is_finite()).then_some(rate)
    }

    /// How long the rest takes at that rate, in words.
    fn left(&self) -> Option<String> {
        let seconds = (self.of - self.done) / self.rate()?;
        let left = Duration::try_from_secs_f64(seconds).ok()?;
        Some(format!(", {:#} left", HumanDuration(left)))
    }
}

fn styled(template: &str, length: u64) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    ProgressBar::new(length).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

impl Drop for Bar {
    /// Removes the bar now, even if the thread of [`show_late`] still holds the stage.
    fn drop(&mut self) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = Stage::new(Progress::new("", 0.0, 1.0));
        }
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Work that goes on as it began: after ten seconds a quarter is done, and three times as long
    /// is left. Before anything is done nothing is known, and what takes for ever has no words.
    #[test]
    fn the_rest_takes_as_long_as_what_is_done() {
        let words = |done, done_before| {
            let mut stage = Stage::new(Progress::new("running", done_before, 100.0));
            stage.began -= Duration::from_millis(10_010);
            stage.update(Progress::new("running", done, 100.0));
            stage.left()
        };
        assert_eq!(words(25.0, 0.0).as_deref(), Some(", 30s left"));
        assert_eq!(words(60.0, 20.0).as_deref(), Some(", 10s left"));
        assert_eq!(words(20.0, 20.0), None);
        assert_eq!(words(1e-300, 0.0), None);
    }
}
