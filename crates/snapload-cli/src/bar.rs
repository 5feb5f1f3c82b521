//! The one bar of progress, on standard error and on a terminal only.
use indicatif::{ProgressBar, ProgressStyle};
use snapload::analysis::Progress;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// So much time passes without a bar.
const PATIENCE: Duration = Duration::from_secs(2);
/// How much has come of how much, in per cent.
const PARTS: &str = "{msg} {bar:40} {percent} %, {eta} left";
/// The same in numbers, with the pace.
const COUNTS: &str = "{msg} {bar:30} {human_pos} of {human_len}, {per_sec:0}, {eta} left";

/// Shows how far work has come; goes away when it is dropped.
pub(crate) struct Bar {
    counts: bool,
    stage: Mutex<Stage>,
}

/// What is being done, since when, and the bar that shows it.
struct Stage {
    doing: String,
    part: f64,
    began: Instant,
    bar: Option<ProgressBar>,
}

impl Bar {
    /// For whatever may take longer than two seconds.
    pub(crate) fn new() -> Self {
        Self {
            counts: false,
            stage: Mutex::new(Stage::new("")),
        }
    }

    /// For many cases, which are counted and shown from the beginning.
    pub(crate) fn counting() -> Self {
        Self {
            counts: true,
            ..Self::new()
        }
    }

    /// What long work calls; it always goes on.
    pub(crate) fn show(&self, progress: Progress) -> ControlFlow<()> {
        // Whoever comes while another thread is at it leaves it to that one.
        if let Ok(mut stage) = self.stage.try_lock() {
            let part = progress.done / progress.of;
            if stage.doing != progress.doing && part <= stage.part {
                *stage = Stage::new(progress.doing);
            }
            stage.part = part;
            if self.counts {
                stage.count(progress);
            } else if stage.began.elapsed() >= PATIENCE {
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
