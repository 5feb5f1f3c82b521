//! The critical force: the smallest force amplitude at which the rotation limit or the upper bound
//! is reached (chapter 6.4.2), and all larger amplitudes of the scan that reach one of them.

use crate::analysis::ensemble::Ensemble;
use crate::analysis::outcomes::{on_all_threads, outcomes_on_one_thread};
use crate::analysis::progress::{Cancelled, Counter, OnProgress, Unfinished};
use crate::analysis::trust::{Certainty, Uncertainty};
use crate::batch::lanes::Lanes;
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::parameters::Parameters;
use crate::case::value::Value;
use crate::model::rules::Stop;
use crate::motion::trajectory::End;

/// The force amplitudes that are tried: f_o = step, 2 step, … up to `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceScan {
    step: f64,
    count: u32,
}

/// The most amplitudes that one scan may have.
const MOST: f64 = 1e6;

impl Default for ForceScan {
    /// Steps of 0.01 up to 1.
    fn default() -> Self {
        Self {
            step: 0.01,
            count: 100,
        }
    }
}

impl ForceScan {
    /// Steps of `step` up to `max`.
    ///
    /// # Errors
    /// A [`CaseError`] if `step` is not above 0, or `max` is below it or more than a million steps.
    pub fn new(step: f64, max: f64) -> Result<Self, CaseError> {
        let wrong =
            |key, value, allowed: String| Err(CaseError::value(key, Value::Number(value), allowed));
        if !(step > 0.0 && step.is_finite()) {
            return wrong("step", step, "a number above 0, such as 0.01".to_owned());
        }
        // The last multiple may fall short of `max` by rounding.
        let count = (max / step * (1.0 + 1e-12)).floor();
        if !(1.0..=MOST).contains(&count) {
            let step = Value::Number(step);
            let allowed =
                format!("at least one step, which is {step}, and at most a million steps");
            return wrong("max", max, allowed);
        }
        Ok(Self {
            step,
            count: count as u32,
        })
    }

    /// The amplitudes: the doubles nearest to the decimal multiples of the step. The step is taken
    /// as 1/n if n is a whole number, as for 0.01, and else as the shortest decimal that is read
    /// back as the same double, so that five times 0.07 is 0.35.
    pub fn amplitudes(self) -> impl Iterator<Item = f64> {
        let inverse = (1.0 / self.step).round();
        let whole = (inverse * self.step - 1.0).abs() < 1e-12;
        let digits = decimal(self.step);
        (1..=self.count).map(move |k| match digits {
            _ if whole => f64::from(k) / inverse,
            Some((digits, power)) => multiple(digits * u128::from(k), power),
            None => f64::from(k) * self.step,
        })
    }
}

/// The shortest decimal that is read back as a number: its digits, and the power of ten of the last
/// one.
fn decimal(number: f64) -> Option<(u128, i32)> {
    let text = format!("{number:e}");
    let (digits, power) = text.split_once('e')?;
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let digits = format!("{whole}{fraction}").parse().ok()?;
    let fraction = i32::try_from(fraction.len()).ok()?;
    Some((digits, power.parse::<i32>().ok()? - fraction))
}

/// The double nearest to a decimal, found by writing and reading it as text, which rounds once.
fn multiple(digits: u128, power: i32) -> f64 {
    format!("{digits}e{power}").parse().unwrap_or(f64::NAN)
}

/// The first amplitude that exceeds a limit, and how its run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceedance {
    /// The critical force f_cr.
    pub f_o: f64,
    /// Which limit is reached.
    pub reason: Stop,
    /// The time at which it is reached \[T\].
    pub t: f64,
}

/// The answer of a scan over the force amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalForce {
    /// The smallest amplitude that exceeds; none if none does.
    pub first: Option<Exceedance>,
    /// All amplitudes that exceed, as intervals of neighbouring ones `[from, to]`. There may be
    /// several intervals: a run above the critical amplitude may settle.
    pub exceeding: Vec<[f64; 2]>,
    /// All amplitudes at which neighbours disagree, as such intervals: the run passes its horizon
    /// of trust, and of [`NEIGHBOURS`] neighbours within rounding, or of those of an
    /// [`crate::analysis::ExceedanceCurve`], some exceed and others do not or are cut short.
    pub uncertain: Vec<[f64; 2]>,
    /// All amplitudes whose run is cut short ([`Stop::cuts_short`]), as such intervals:
    /// whether they exceed is not known.
    pub cut_short: Vec<[f64; 2]>,
    /// The largest amplitude of the scan.
    pub up_to: f64,
    /// Whether the run of the first ends before its horizon, and no smaller amplitude is uncertain
    /// or cut short; if none exceeds, whether none is.
    pub certain: bool,
}

/// The neighbours of a run past its horizon, of which all must exceed if it does, and none if not.
pub const NEIGHBOURS: u32 = 20;

/// So many of them are run first.
const FIRST_NEIGHBOURS: u32 = 4;

/// Of so many runs at once, which fills all lanes and needs little memory.
const AT_ONCE: usize = 1000;

/// So many of the runs themselves are made at once, likewise.
const RUNS_AT_ONCE: usize = 10_000;

impl CriticalForce {
    /// Runs the case at every amplitude of the scan, on all threads that there are.
    ///
    /// # Errors
    /// A [`CaseError`] if the case is not legal, and [`Unfinished::Cancelled`].
    pub fn scan(
        parameters: &Parameters,
        scan: ForceScan,
        on_progress: OnProgress,
    ) -> Result<Self, Unfinished> {
        let amplitudes: Vec<f64> = scan.amplitudes().collect();
        let case = |f_o: &f64| {
            Case::new(Parameters {
                f_o: *f_o,
                ..*parameters
            })
        };
        let cases = |some: &[f64]| some.iter().map(case).collect::<Result<Vec<_>, _>>();
        let counter = Counter::new("running", 0, amplitudes.len() as u64, on_progress);
        let mut ends = Vec::with_capacity(amplitudes.len());
        for some in amplitudes.chunks(RUNS_AT_ONCE) {
            let cases = cases(some)?;
            let runs = on_all_threads(cases.len(), |numbers| {
                let cases = numbers.map(|k| cases[k].clone());
                Certainty::with_outcomes(Lanes::best(), cases, &counter)
            })?;
            let runs = some.iter().zip(runs.iter());
            ends.extend(runs.map(|(f_o, (outcome, certainty))| DecidedEnd {
                f_o: *f_o,
                end: outcome.end,
                certain: certainty.decides_the_end(),
                decided: certainty.decides_the_end(),
            }));
        }
        let undecided: Vec<usize> = (0..ends.len()).filter(|k| !ends[*k].decided).collect();
        let all = undecided.len() as u64 * u64::from(NEIGHBOURS);
        let counter = Counter::new("neighbours", 0, all, on_progress);
        for some in undecided.chunks(AT_ONCE) {
            let at: Vec<f64> = some.iter().map(|k| ends[*k].f_o).collect();
            let exceed = some.iter().map(|k| ends[*k].end.reason.exceeds());
            let agree = neighbours_agree(&cases(&at)?, &exceed.collect::<Vec<_>>(), &counter)?;
            for (k, agree) in some.iter().zip(agree) {
                ends[*k].decided = agree;
            }
        }
        Ok(Self::of(&ends))
    }

    /// The answer from the end of the run at each amplitude.
    pub(crate) fn of(ends: &[DecidedEnd]) -> Self {
        let exceeds = |end: &DecidedEnd| end.end.reason.exceeds();
        let cut_short = |end: &DecidedEnd| end.end.reason.cuts_short();
        let first = ends.iter().position(exceeds);
        let up_to = first.unwrap_or(ends.len());
        Self {
            certain: first.is_none_or(|first| ends[first].certain)
                && ends[..up_to]
                    .iter()
                    .all(|end| end.decided && !cut_short(end)),
            first: first.map(|first| Exceedance {
                f_o: ends[first].f_o,
                reason: ends[first].end.reason,
                t: ends[first].end.t,
            }),
            exceeding: intervals(ends, exceeds),
            uncertain: intervals(ends, |end| !end.decided && !cut_short(end)),
            cut_short: intervals(ends, cut_short),
            up_to: ends.last().map_or(0.0, |end| end.f_o),
        }
    }
}

/// How the run at one amplitude ends.
#[derive(Clone, Copy)]
pub(crate) struct DecidedEnd {
    pub(crate) f_o: f64,
    pub(crate) end: End,
    /// Whether it ends before its horizon of trust.
    pub(crate) certain: bool,
    /// Whether it does, or all neighbours exceed if it does, and none otherwise.
    pub(crate) decided: bool,
}

/// For each case, given whether its run exceeds, whether all its neighbours exceed if it does, and
/// none otherwise; they do not if some can not be drawn or are cut short. The neighbours of all
/// cases are run side by side: the first few, which mostly show where they disagree, and then the
/// others of those that agree so far.
fn neighbours_agree(
    cases: &[Case],
    exceed: &[bool],
    counter: &Counter,
) -> Result<Vec<bool>, Cancelled> {
    let about = |case| Ensemble::about(case, &Uncertainty::default(), NEIGHBOURS, 1);
    let ensembles: Vec<Ensemble> = cases.iter().map(about).collect();
    let mut agree = vec![true; cases.len()];
    for members in [0..FIRST_NEIGHBOURS, FIRST_NEIGHBOURS..NEIGHBOURS] {
        let mut neighbours = Vec::new();
        for (k, ensemble) in ensembles.iter().enumerate() {
            let members = members.clone().filter(|_| agree[k]);
            match members
                .map(|index| ensemble.member(index))
                .collect::<Result<Vec<_>, _>>()
            {
                Ok(cases) => neighbours.extend(cases.into_iter().map(|case| (k, case))),
                Err(_) => agree[k] = false,
            }
        }
        let outcomes = on_all_threads(neighbours.len(), |numbers| {
            outcomes_on_one_thread(numbers.map(|n| neighbours[n].1.clone()), counter)
        })?;
        for ((k, _), outcome) in neighbours.iter().zip(outcomes.iter()) {
            let cut_short = outcome.end.reason.cuts_short();
            agree[*k] &= !cut_short && outcome.exceeds() == exceed[*k];
        }
        counter.add((cases.len() * members.len() - neighbours.len()) as u64)?;
    }
    Ok(agree)
}

/// The amplitudes whose ends are such, as intervals of neighbouring ones.
fn intervals(ends: &[DecidedEnd], is_such: impl Fn(&DecidedEnd) -> bool) -> Vec<[f64; 2]> {
    let alike = ends.chunk_by(|a, b| is_such(a) == is_such(b));
    let such = alike.filter(|some| is_such(&some[0]));
    such.map(|some| [some[0].f_o, some[some.len() - 1].f_o])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amplitudes_are_decimals() -> Result<(), CaseError> {
        let all: Vec<f64> = ForceScan::default().amplitudes().collect();
        assert_eq!((all.len(), all[56], all[99]), (100, 0.57, 1.0));
        let typed = |step, max| ForceScan::new(step, max).map(|scan| scan.amplitudes().collect());
        let sevens: Vec<f64> = typed(0.07, 0.7)?;
        assert_eq!((sevens.len(), sevens[2], sevens[4]), (10, 0.21, 0.35));
        let threes: Vec<f64> = typed(0.3, 1.0)?;
        assert_eq!(threes, [0.3, 0.6, 0.9]);
        let thirds: Vec<f64> = typed(1.0 / 3.0, 1.0)?;
        assert_eq!(thirds, [1.0 / 3.0, 2.0 / 3.0, 1.0]);
        let large: Vec<f64> = typed(2.5e10, 1e11)?;
        assert_eq!(large, [2.5e10, 5e10, 7.5e10, 1e11]);
        for (step, max) in [
            (0.0, 1.0),
            (-0.1, 1.0),
            (f64::NAN, 1.0),
            (0.1, 0.05),
            (1e-9, 1.0),
        ] {
            assert!(ForceScan::new(step, max).is_err(), "{step} {max}");
        }
        Ok(())
    }
}
