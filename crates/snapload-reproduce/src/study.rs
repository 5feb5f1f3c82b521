//! Every run that the report needs, each computed once.

use crate::critical_row::CriticalRow;
use crate::proved::Proved;
pub(crate) use crate::reading::{Both, Reading};
use crate::reading::{first_exceeding, standard, up_to_exceeding};
use snapload::analysis::{
    ForceScan, OnProgress, Progress, Uncertainty, Unfinished, in_parallel, no_progress, trusted_run,
};
use snapload::{Case, CaseError, Outcome, Parameters, Trajectory, Value, named_case, table_6_1};
use snapload_verify::RoundedRun;

/// A built-in case, its runs, and their proofs.
#[derive(Clone, Debug)]
pub(crate) struct CaseRuns {
    pub(crate) code: &'static str,
    pub(crate) parameters: Parameters,
    pub(crate) runs: Both<Known>,
    /// The proved ends of its runs, if no cable stays taut before a stop rule ends them.
    pub(crate) proved: Both<Option<&'static Proved>>,
    /// The run with many digits, in the chapter's reading.
    pub(crate) exact: RoundedRun,
}

/// A run in doubles.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    pub(crate) run: Trajectory,
    /// Its horizon, as in `snapload run`; none if it is known to its end.
    pub(crate) horizon: Option<f64>,
    /// The number of the first impact past the horizon.
    pub(crate) first_unknown: Option<usize>,
}

impl Known {
    pub(crate) fn new(parameters: Parameters) -> Result<Self, Unfinished> {
        let case = Case::new(parameters)?;
        let (run, trust) = trusted_run(&case, &Uncertainty::default(), &no_progress)?;
        Ok(Self {
            run,
            horizon: trust.horizon.map(|horizon| horizon.t),
            first_unknown: trust.horizon.map(|horizon| horizon.impact),
        })
    }

    /// Whether a time is before the horizon.
    pub(crate) fn is_known_at(&self, t: f64) -> bool {
        self.horizon.is_none_or(|horizon| t < horizon)
    }
}

/// A point of a curve of critical force: the value of the key, and f_cr if there is one.
pub(crate) type CriticalPoint = (f64, Option<f64>);

/// A curve of critical force over one key, `e` or `omega`.
#[derive(Clone, Debug)]
pub(crate) struct CriticalCurve {
    /// Cable length.
    pub(crate) r: f64,
    pub(crate) key: &'static str,
    pub(crate) points: Both<Vec<CriticalPoint>>,
}

/// The norms over the force amplitude, up to the critical force.
#[derive(Clone, Debug)]
pub(crate) struct NormCurve {
    /// Cable length.
    pub(crate) r: f64,
    /// Amplitude and outcome.
    pub(crate) points: Both<Vec<(f64, Outcome)>>,
}

/// The largest amplitude in the scans for the curves of critical force.
pub(crate) const LARGEST: f64 = 2.0;

/// The values over which the curves of critical force are drawn: key, first, last, number.
const CURVES: [(&str, f64, f64, usize); 2] = [("e", 0.3, 1.0, 71), ("omega", 0.4, 2.4, 101)];

/// The cable lengths of these curves.
const LENGTHS: [f64; 2] = [1.5, 2.5];

/// All computed results.
#[derive(Clone, Debug)]
pub struct Study {
    /// The cases of Table 6.1 in the order of first mention, and the printed variants.
    pub(crate) cases: Vec<CaseRuns>,
    /// Table 6.2.
    pub(crate) critical: Vec<CriticalRow>,
    /// Figs 6.27-6.30.
    pub(crate) curves: Vec<CriticalCurve>,
    /// Figs 6.31-6.38.
    pub(crate) norms: Vec<NormCurve>,
    /// The sliding example (eq. 6.57).
    pub(crate) sliding: Known,
    /// The rocking example (eq. 6.69).
    pub(crate) rocking: Known,
}

impl Study {
    /// Computes everything.
    ///
    /// # Errors
    /// [`Unfinished::Cancelled`]; a case that is not legal would be an error of the program.
    pub fn compute(on_progress: OnProgress) -> Result<Self, Unfinished> {
        let report_progress =
            |doing: &str, part: f64| Progress::new(doing, part, 1.0).report(on_progress);
        report_progress("the cases of Table 6.1", 0.0)?;
        let cases = cases()?;
        report_progress("Table 6.2", 0.1)?;
        let critical = CriticalRow::all()?;
        let mut curves = Vec::new();
        for over in CURVES {
            for r in LENGTHS {
                let part = 0.2 + 0.15 * curves.len() as f64;
                report_progress(&format!("critical force over {}, r = {r}", over.0), part)?;
                curves.push(curve(r, over)?);
            }
        }
        report_progress("the norms", 0.8)?;
        let norms = LENGTHS.into_iter().map(|r| {
            let of = |reading: Reading| {
                let points = up_to_exceeding(&reading.apply(standard(r)), ForceScan::default());
                points.map_err(Unfinished::from)
            };
            let points = Both::try_new(of)?;
            Ok(NormCurve { r, points })
        });
        let example = |code| Known::new(named_case(code)?.parameters);
        Ok(Self {
            cases,
            critical,
            curves,
            norms: norms.collect::<Result<_, Unfinished>>()?,
            sliding: example("sliding-example")?,
            rocking: example("rocking-example")?,
        })
    }

    /// A built-in case by its code.
    pub(crate) fn case(&self, code: &str) -> Option<&CaseRuns> {
        self.cases.iter().find(|case| case.code == code)
    }
}

fn cases() -> Result<Vec<CaseRuns>, Unfinished> {
    let mut codes: Vec<&'static str> = Vec::new();
    let printed = snapload::named_cases().map(|case| case.code);
    let table = table_6_1().map(|(_, code)| code);
    for code in table.chain(printed.filter(|code| code.ends_with("-559"))) {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    in_parallel(codes.len(), |k| CaseRuns::new(codes[k]))
}

impl CaseRuns {
    fn new(code: &'static str) -> Result<Self, Unfinished> {
        let parameters = named_case(code)?.parameters;
        let proved = Both {
            chapter: Proved::stored(&Reading::Chapter.apply(parameters)),
            sliding_on: Proved::stored(&Reading::SlidingOn.apply(parameters)),
        };
        Ok(Self {
            code,
            parameters,
            runs: Both::try_new(|reading| Known::new(reading.apply(parameters)))?,
            exact: exact(&Reading::Chapter.apply(parameters), proved.chapter)?,
            proved,
        })
    }
}

/// The run with enough digits that its end agrees with the proved one, if there is a proof.
pub(crate) fn exact(
    parameters: &Parameters,
    proved: Option<&Proved>,
) -> Result<RoundedRun, CaseError> {
    let run = RoundedRun::of_76_digits(parameters)?;
    let Some(proved) = proved else {
        return Ok(run);
    };
    let is_proved = |run: &RoundedRun| {
        run.end().reason == proved.reason
            && run.snaps() == proved.impacts
            && (run.end().t - proved.time()).abs() < 1e-12
    };
    if is_proved(&run) {
        return Ok(run);
    }
    let run = RoundedRun::of_153_digits(parameters)?;
    if is_proved(&run) {
        return Ok(run);
    }
    let t = Value::Number(run.end().t);
    Err(CaseError::value(
        "t",
        t,
        format!("the proved end, {}", proved.t),
    ))
}

fn curve(
    r: f64,
    (key, first, last, count): (&'static str, f64, f64, usize),
) -> Result<CriticalCurve, Unfinished> {
    let point = |k: usize, reading: Reading| {
        // Rounded to readable decimals.
        let value = first + (last - first) * k as f64 / (count - 1) as f64;
        let value = (value * 1000.0).round() / 1000.0;
        let mut parameters = standard(r);
        match key {
            "e" => parameters.e = value,
            _ => parameters.omega = value,
        }
        let scan = ForceScan::new(0.01, LARGEST)?;
        let first = first_exceeding(&reading.apply(parameters), scan)?;
        Ok((value, first.map(|(f_o, _)| f_o)))
    };
    let points = |reading| in_parallel(count, |k| point(k, reading));
    Ok(CriticalCurve {
        r,
        key,
        points: Both::try_new(points)?,
    })
}
