//! How long work reports its progress, and learns whether to continue.
//!
//! Every function that may take longer than a moment takes an [`OnProgress`] and calls it
//! repeatedly, from any thread. If that answers `Break`, the work ends soon after, without a
//! result, as [`Cancelled`].

use crate::case::Case;
use crate::case::error::CaseError;
use crate::motion::outcome::Outcome;
use crate::motion::simulation::{Simulation, Step};
use crate::motion::trajectory::Trajectory;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How far some work has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// The name of the work, in a word or two; work of several stages reports them one after the
    /// other.
    pub doing: &'a str,
    /// How much of it is done: a number of cases, or the time that a run has reached.
    pub done: f64,
    /// How much there is to do.
    pub of: f64,
}

/// The callback that receives the progress, and answers whether to continue.
pub type OnProgress<'a> = &'a (dyn Fn(Progress<'_>) -> ControlFlow<()> + Sync);

/// For work whose progress nobody needs: it always continues.
pub fn no_progress(_: Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The work had to end before it had an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cancelled {
    /// How much was done by then.
    pub done: f64,
}

/// Why work that can fail has no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfinished {
    /// It was cancelled.
    Cancelled(Cancelled),
    /// A case is not legal.
    Case(CaseError),
}

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("cancelled")
    }
}

impl std::error::Error for Cancelled {}

impl fmt::Display for Unfinished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled(cancelled) => cancelled.fmt(f),
            Self::Case(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unfinished {}

impl From<Cancelled> for Unfinished {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

impl From<CaseError> for Unfinished {
    fn from(error: CaseError) -> Self {
        Self::Case(error)
    }
}

impl<'a> Progress<'a> {
    /// The progress of some work.
    pub fn new(doing: &'a str, done: f64, of: f64) -> Self {
        Self { doing, done, of }
    }

    /// Reports it.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is to end.
    pub fn report(self, on_progress: OnProgress) -> Result<(), Cancelled> {
        match on_progress(self) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Cancelled { done: self.done }),
        }
    }
}

/// Fractions of a part that are counted: few enough for 2^48 parts; of more, the first so many are
/// counted.
const FRACTIONS: u64 = 1 << 16;

/// Counts the parts of some work that are finished and fractions of those under way, on any thread,
/// and reports them.
pub struct Counter<'a> {
    doing: &'a str,
    /// What is done, as a number of fractions.
    done: AtomicU64,
    of: u64,
    /// The same as a number of fractions.
    all: u64,
    /// Locked during a report, so that no thread reports less after another has reported more.
    reporting: Mutex<()>,
    /// Whether the work is to end.
    ended: AtomicBool,
    on_progress: OnProgress<'a>,
}

impl<'a> Counter<'a> {
    /// A counter up to `of`, with `done` done already. It reports that this work begins, unless
    /// there is nothing to do, so that it is seen before a part is finished. If the answer is to
    /// end, it ends with the next part.
    pub fn new(doing: &'a str, done: u64, of: u64, on_progress: OnProgress<'a>) -> Self {
        let counter = Self {
            doing,
            done: AtomicU64::new(done.saturating_mul(FRACTIONS)),
            of,
            all: of.saturating_mul(FRACTIONS),
            reporting: Mutex::new(()),
            ended: AtomicBool::new(false),
            on_progress,
        };
        if of > 0 {
            let _ = counter.add(0);
        }
        counter
    }

    /// Does one part, whose own progress counts as a fraction of it. A part of several stages counts
    /// only what goes beyond the earlier ones.
    ///
    /// # Errors
    /// Those of the part, and [`Cancelled`] if the work is to end.
    pub fn part<T, E: From<Cancelled>>(
        &self,
        work: impl FnOnce(OnProgress) -> Result<T, E>,
    ) -> Result<T, E> {
        let counted = AtomicU64::new(0);
        let within = |progress: Progress| {
            let fraction = (progress.done / progress.of).clamp(0.0, 1.0);
            let reached = (fraction * FRACTIONS as f64) as u64;
            let before = counted.fetch_max(reached, Ordering::Relaxed);
            match self.advance(reached.saturating_sub(before)) {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            }
        };
        let result = work(&within)?;
        self.advance(FRACTIONS - counted.into_inner())?;
        Ok(result)
    }

    /// Counts `more` parts as done; with 0 it only asks whether to continue.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is to end.
    pub fn add(&self, more: u64) -> Result<(), Cancelled> {
        self.advance(more.saturating_mul(FRACTIONS))
    }

    /// Counts fractions, and reports the count unless another thread is reporting: that one reports
    /// again if all was done meanwhile, so that the last report is never left out.
    fn advance(&self, fractions: u64) -> Result<(), Cancelled> {
        let all = self.all;
        let mut reported = self.done.fetch_add(fractions, Ordering::SeqCst);
        reported = reported.saturating_add(fractions);
        while let Ok(reporting) = self.reporting.try_lock() {
            reported = self.done.load(Ordering::SeqCst);
            if self.progress(reported).report(self.on_progress).is_err() {
                self.ended.store(true, Ordering::SeqCst);
            }
            drop(reporting);
            if reported >= all || self.done.load(Ordering::SeqCst) < all {
                break;
            }
        }
        match self.ended.load(Ordering::SeqCst) {
            true => Err(Cancelled {
                done: self.progress(reported).done,
            }),
            false => Ok(()),
        }
    }

    fn progress(&self, fractions: u64) -> Progress<'a> {
        Progress::new(
            self.doing,
            fractions as f64 / FRACTIONS as f64,
            self.of as f64,
        )
    }
}

/// A run reports its progress after this many steps: often enough to be cancelled at once, and
/// rarely enough that the reports cost nothing noticeable.
const STEPS: u32 = 64;

/// Reports how far a run has come.
struct RunProgress<'a> {
    steps: u32,
    reached: f64,
    on_progress: OnProgress<'a>,
}

impl<'a> RunProgress<'a> {
    fn new(on_progress: OnProgress<'a>) -> Self {
        Self {
            steps: 0,
            reached: 0.0,
            on_progress,
        }
    }

    fn step(&mut self, simulation: &Simulation) -> ControlFlow<()> {
        self.steps = self.steps.wrapping_add(1);
        if !self.steps.is_multiple_of(STEPS) {
            return ControlFlow::Continue(());
        }
        self.reached = simulation.time();
        let progress = Progress::new("running", self.reached, simulation.rules().t_end);
        (self.on_progress)(progress)
    }

    fn cancelled(&self) -> Cancelled {
        Cancelled { done: self.reached }
    }
}

/// Runs a simulation to its end and keeps all of it; `see` is called with the simulation and the
/// step after every step.
///
/// # Errors
/// [`Cancelled`] if it is to end before.
pub fn record(
    simulation: Simulation,
    on_progress: OnProgress,
    mut see: impl FnMut(&Simulation, &Step),
) -> Result<Trajectory, Cancelled> {
    let mut progress = RunProgress::new(on_progress);
    let run = Trajectory::record_while(simulation, |simulation, step| {
        see(simulation, step);
        progress.step(simulation)
    });
    run.ok_or_else(|| progress.cancelled())
}

/// Follows a simulation to its end and keeps nothing of it; `see` is called with the simulation and
/// the step after every step. The result is the simulation at its end.
///
/// # Errors
/// [`Cancelled`] if it is to end before.
pub fn follow(
    mut simulation: Simulation,
    on_progress: OnProgress,
    mut see: impl FnMut(&Simulation, &Step),
) -> Result<Simulation, Cancelled> {
    let mut progress = RunProgress::new(on_progress);
    while let Some(step) = simulation.step() {
        see(&simulation, &step);
        if progress.step(&simulation).is_break() {
            return Err(progress.cancelled());
        }
    }
    Ok(simulation)
}

/// The outcome of a case's run.
///
/// # Errors
/// [`Cancelled`] if it is to end before.
pub fn outcome(case: &Case, on_progress: OnProgress) -> Result<Outcome, Cancelled> {
    let mut progress = RunProgress::new(on_progress);
    let outcome = Outcome::of_while(case, |simulation| progress.step(simulation));
    outcome.ok_or_else(|| progress.cancelled())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Many threads count at once: no report is less than the one before, and the last is of all.
    #[test]
    fn reports_only_grow_and_end_with_all() {
        for parts in [1, 2, 1000] {
            let latest = Mutex::new(0.0);
            let on_progress = |progress: Progress| {
                let mut latest = latest.lock().expect("no panic");
                assert!(*latest <= progress.done, "{latest} {}", progress.done);
                *latest = progress.done;
                ControlFlow::Continue(())
            };
            let counter = Counter::new("counting", 0, 4 * parts, &on_progress);
            std::thread::scope(|scope| {
                for _ in 0..4 {
                    scope.spawn(|| (0..parts).for_each(|_| counter.add(1).expect("goes on")));
                }
            });
            assert_eq!(*latest.lock().expect("no panic"), (4 * parts) as f64);
        }
    }

    /// Once one report is answered by `Break`, every thread ends.
    #[test]
    fn all_threads_end_after_one_answer() {
        let asked = AtomicU64::new(0);
        let on_progress = |_: Progress| match asked.fetch_add(1, Ordering::SeqCst) {
            3 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let counter = Counter::new("counting", 0, 100, &on_progress);
        let ended = |_| counter.add(1).is_err();
        let ended: Vec<bool> = (0..5).map(ended).collect();
        assert_eq!(ended, [false, false, true, true, true]);
    }
}
