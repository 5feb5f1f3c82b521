//! The progress bar, on standard error and only on a terminal.
use indicatif::{ProgressBar, ProgressStyle};
use snapload::analysis::Progress;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The time that passes before a bar is shown.
const DELAY: Duration = Duration::from_secs(2);
/// The form of a bar in per cent.
const PARTS: &str = "{msg} {bar:40} {percent} %, {eta} left";
/// The form of a bar in numbers, with the rate.
const COUNTS: &str = "{msg} {bar:30} {human_pos} of {human_len}, {per_sec:0}, {eta} left";

/// Shows the progress of work; it disappears when it is dropped.
pub(crate) struct Bar {
    counts: bool,
    stage: Mutex<Stage>,
}

/// The work that is being done, its beginning, and the bar that shows it.
struct Stage {
    doing: String,
    part: f64,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Bar {
    /// A bar for work that may take longer than two seconds.
    pub(crate) fn new() -> Self {
        Self {
            counts: false,
            stage: Mutex::new(Stage::new("")),
        }
    }

    /// A bar for many cases, which are counted and shown from the beginning.
    pub(crate) fn counting() -> Self {
        Self {
            counts: true,
            ..Self::new()
        }
    }

    /// The callback for long work; it always lets the work continue.
    pub(crate) fn show(&self, progress: Progress) -> ControlFlow<()> {
        // If another thread is updating the bar, this update is skipped.
        if let Ok(mut stage) = self.stage.try_lock() {
            let part = progress.done / progress.of;
            if stage.doing != progress.doing && part <= stage.part {
                *stage = Stage::new(progress.doing);
            }
            stage.part = part;
            if self.counts {
                stage.count(progress);
            } else if stage.began.elapsed() >= DELAY {
                stage.part(progress);
            }
        }
        ControlFlow::Continue(())
    }
}

impl Stage {
    fn new(doing: &str) -> Self {
        Self {
            doing: doing.to_owned(),
            part: 0.0,
            began: Instant::now(),
            bar: None,
        }
    }

    fn part(&mut self, progress: Progress) {
        let began = self.began;
        let new = || styled(PARTS, 1000, progress.doing).with_elapsed(began.elapsed());
        let bar = self.bar.get_or_insert_with(new);
        if self.doing != progress.doing {
            self.doing = progress.doing.to_owned();
            bar.set_message(self.doing.clone());
        }
        bar.set_position((1000.0 * self.part) as u64);
    }

    fn count(&mut self, progress: Progress) {
        let done = progress.done as u64;
        let new = || {
            let bar = styled(COUNTS, progress.of as u64, progress.doing).with_position(done);
            bar.reset_eta();
            bar
        };
        self.bar.get_or_insert_with(new).set_position(done);
    }
}

fn styled(template: &str, length: u64, doing: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    ProgressBar::new(length)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        .with_message(doing.to_owned())
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
