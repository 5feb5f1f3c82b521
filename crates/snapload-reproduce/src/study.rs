//! Every run that the report needs, each computed once.

use crate::proved::Proved;
use snapload::analysis::{
    CriticalForce, ExceedanceCurve, ForceScan, OnProgress, Progress, Uncertainty, Unfinished,
    in_parallel, unwatched,
};
use snapload::{
    Case, CaseError, Outcome, Parameters, Stop, Trajectory, named_case, natural_inertia, table_6_1,
};

/// How a run that begins to slide is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Reading {
    /// As the chapter's own studies did: the run ends there (6.3.1).
    Chapter,
    /// As it is: the motion slides on.
    SlidingOn,
}

impl Reading {
    /// Both, the chapter's first.
    pub(crate) const BOTH: [Self; 2] = [Self::Chapter, Self::SlidingOn];

    /// The first of two values in the chapter's reading, the second in the other.
    pub(crate) fn either<T>(self, chapter: T, sliding_on: T) -> T {
        match self {
            Self::Chapter => chapter,
            Self::SlidingOn => sliding_on,
        }
    }

    /// The parameters, read so.
    pub(crate) fn apply(self, parameters: Parameters) -> Parameters {
        Parameters {
            stop_when_sliding: self == Self::Chapter,
            ..parameters
        }
    }

    /// In words, as a heading.
    pub(crate) fn words(self) -> &'static str {
        self.either("sliding ends the run (the chapter)", "sliding goes on")
    }

    /// What to add to a command line.
    pub(crate) fn option(self) -> &'static str {
        self.either(" --set stop_when_sliding=true", "")
    }
}

/// One of each reading.
#[derive(Clone, Debug)]
pub(crate) struct Both<T> {
    pub(crate) chapter: T,
    pub(crate) sliding_on: T,
}

impl<T> Both<T> {
    fn try_new(make: impl Fn(Reading) -> Result<T, Unfinished>) -> Result<Self, Unfinished> {
        Ok(Self {
            chapter: make(Reading::Chapter)?,
            sliding_on: make(Reading::SlidingOn)?,
        })
    }

    pub(crate) fn of(&self, reading: Reading) -> &T {
        reading.either(&self.chapter, &self.sliding_on)
    }
}

/// A built-in case, its runs, and what is proved of them.
#[derive(Clone, Debug)]
pub(crate) struct CaseRuns {
    pub(crate) code: &'static str,
    pub(crate) parameters: Parameters,
    pub(crate) runs: Both<Trajectory>,
    pub(crate) proved: Both<Option<Proved>>,
}

/// A row of Table 6.2.
#[derive(Clone, Debug)]
pub(crate) struct CriticalRow {
    /// Cable length.
    pub(crate) r: f64,
    pub(crate) shape: &'static str,
    /// Half-sizes.
    pub(crate) size: [f64; 2],
    /// The published critical force.
    pub(crate) published: f64,
    /// The computed ones, with all amplitudes that exceed.
    pub(crate) computed: Both<CriticalForce>,
    /// How many neighbours exceed, at amplitudes up to [`CriticalRow::looked_up_to`].
    pub(crate) probable: Both<ExceedanceCurve>,
}

/// Neighbours of each run of Table 6.2, 1e-12 away at the most.
pub(crate) const NEIGHBOURS: u32 = 20;

/// Table 6.2 as published: r, shape, half-sizes, f_cr.
const TABLE_6_2: [(f64, &str, [f64; 2], f64); 16] = [
    (1.5, "circle", [0.1, 0.0], 0.31),
    (1.5, "circle", [0.2, 0.0], 0.42),
    (1.5, "circle", [0.3, 0.0], 0.40),
    (1.5, "square", [0.1, 0.1], 0.32),
    (1.5, "square", [0.2, 0.2], 0.34),
    (1.5, "square", [0.3, 0.3], 0.60),
    (1.5, "rectangle", [0.2, 0.1], 0.68),
    (1.5, "rectangle", [0.3, 0.1], 0.67),
    (2.5, "circle", [0.1, 0.0], 0.10),
    (2.5, "circle", [0.2, 0.0], 0.18),
    (2.5, "circle", [0.3, 0.0], 0.30),
    (2.5, "square", [0.1, 0.1], 0.28),
    (2.5, "square", [0.2, 0.2], 0.33),
    (2.5, "square", [0.3, 0.3], 0.35),
    (2.5, "rectangle", [0.2, 0.1], 0.27),
    (2.5, "rectangle", [0.3, 0.1], 0.35),
];

impl CriticalRow {
    /// The body with all else as in the standard case.
    pub(crate) fn parameters(&self) -> Parameters {
        of_shape(self.r, self.size)
    }

    /// The larger of the published critical force and the computed ones.
    pub(crate) fn looked_up_to(&self) -> f64 {
        looked_up_to(self.published, &self.computed)
    }

    /// Whether arithmetic in doubles can decide the published value: at no amplitude up to it
    /// neighbours disagree.
    pub(crate) fn decidable(&self, reading: Reading) -> bool {
        let points = self.probable.of(reading).points.iter();
        points
            .filter(|point| point.f_o <= self.published)
            .all(|point| point.share.count == 0 || point.share.count == point.share.of)
    }
}

fn looked_up_to(published: f64, computed: &Both<CriticalForce>) -> f64 {
    Reading::BOTH
        .into_iter()
        .filter_map(|reading| computed.of(reading).first)
        .fold(published, |largest, first| largest.max(first.f_o))
}

/// The standard case with cables of another length.
fn standard(r: f64) -> Parameters {
    Parameters {
        r,
        ..Parameters::STANDARD
    }
}

/// The standard case with another body and cables.
fn of_shape(r: f64, [a, b]: [f64; 2]) -> Parameters {
    let inertia = natural_inertia(a, b);
    Parameters {
        a,
        b,
        inertia,
        ..standard(r)
    }
}

/// A point of a curve of critical force: the value of the key, and f_cr where there is one.
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

/// The values over which the curves of critical force are drawn: key, first, last, how many.
const CURVES: [(&str, f64, f64, usize); 2] = [("e", 0.3, 1.0, 71), ("omega", 0.4, 2.4, 101)];

/// The cable lengths of these curves.
const LENGTHS: [f64; 2] = [1.5, 2.5];

/// Everything that was computed.
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
    pub(crate) sliding: Trajectory,
    /// The rocking example (eq. 6.69).
    pub(crate) rocking: Trajectory,
}

impl Study {
    /// Computes everything.
    ///
    /// # Errors
    /// [`Unfinished::Cancelled`]; a case that is not legal would be a fault of the program.
    pub fn compute(on_progress: OnProgress) -> Result<Self, Unfinished> {
        let tell = |doing: &str, part: f64| Progress::new(doing, part, 1.0).tell(on_progress);
        tell("the cases of Table 6.1", 0.0)?;
        let cases = cases()?;
        tell("Table 6.2", 0.1)?;
        let critical = TABLE_6_2.into_iter().map(critical_row);
        let critical = critical.collect::<Result<_, _>>()?;
        let mut curves = Vec::new();
        for over in CURVES {
            for r in LENGTHS {
                let part = 0.2 + 0.15 * curves.len() as f64;
                tell(&format!("critical force over {}, r = {r}", over.0), part)?;
                curves.push(curve(r, over)?);
            }
        }
        tell("the norms", 0.8)?;
        let norms = LENGTHS.into_iter().map(|r| {
            let of = |reading: Reading| {
                let points = up_to_exceeding(&reading.apply(standard(r)), ForceScan::default());
                points.map_err(Unfinished::from)
            };
            let points = Both::try_new(of)?;
            Ok(NormCurve { r, points })
        });
        let example = |code| -> Result<Trajectory, Unfinished> {
            Ok(Case::new(named_case(code)?.parameters)?.run())
        };
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
    let case = |code| {
        let parameters = named_case(code)?.parameters;
        Ok(CaseRuns {
            code,
            parameters,
            runs: Both::try_new(|reading| Ok(Case::new(reading.apply(parameters))?.run()))?,
            proved: proved(parameters),
        })
    };
    in_parallel(codes.len(), |k| case(codes[k]))
}

/// What is proved in both readings.
fn proved(parameters: Parameters) -> Both<Option<Proved>> {
    let of = |reading: Reading| Proved::of(&reading.apply(parameters));
    let chapter = of(Reading::Chapter);
    // A run that ends before it slides is one in both readings.
    let sliding_on = match &chapter {
        Some(proved) if proved.reason != Stop::SlidingStart => chapter.clone(),
        _ => of(Reading::SlidingOn),
    };
    Both {
        chapter,
        sliding_on,
    }
}

fn critical_row(
    (r, shape, size, published): (f64, &'static str, [f64; 2], f64),
) -> Result<CriticalRow, Unfinished> {
    let parameters = of_shape(r, size);
    let computed = Both::try_new(|reading| {
        CriticalForce::scan(&reading.apply(parameters), ForceScan::default(), &unwatched)
    })?;
    let scan = ForceScan::new(0.01, looked_up_to(published, &computed))?;
    let neighbours = |reading: Reading| {
        let (parameters, uncertainty) = (reading.apply(parameters), Uncertainty::default());
        ExceedanceCurve::scan(&parameters, scan, &uncertainty, NEIGHBOURS, 1, &unwatched)
    };
    Ok(CriticalRow {
        r,
        shape,
        size,
        published,
        computed,
        probable: Both::try_new(neighbours)?,
    })
}

fn curve(
    r: f64,
    (key, first, last, count): (&'static str, f64, f64, usize),
) -> Result<CriticalCurve, Unfinished> {
    let point = |k: usize, reading: Reading| {
        // Rounded to the decimals that one would write.
        let value = first + (last - first) * k as f64 / (count - 1) as f64;
        let value = (value * 1000.0).round() / 1000.0;
        let mut parameters = standard(r);
        match key {
            "e" => parameters.e = value,
            _ => parameters.omega = value,
        }
        let first = first_exceeding(&reading.apply(parameters), ForceScan::default())?;
        Ok((value, first.map(|(f_o, _)| f_o)))
    };
    let points = |reading| in_parallel(count, |k| point(k, reading));
    Ok(CriticalCurve {
        r,
        key,
        points: Both::try_new(points)?,
    })
}

/// The outcomes of a case over the force amplitudes of a scan, up to the first that exceeds.
fn up_to_exceeding(
    parameters: &Parameters,
    scan: ForceScan,
) -> Result<Vec<(f64, Outcome)>, CaseError> {
    let mut outcomes = Vec::new();
    for f_o in scan.amplitudes() {
        let outcome = Outcome::of(&Case::new(Parameters { f_o, ..*parameters })?);
        outcomes.push((f_o, outcome));
        if outcome.exceeds() {
            break;
        }
    }
    Ok(outcomes)
}

/// The first force amplitude of a scan that exceeds, with the reason; nothing beyond it is run.
pub(crate) fn first_exceeding(
    parameters: &Parameters,
    scan: ForceScan,
) -> Result<Option<(f64, Stop)>, CaseError> {
    let last = up_to_exceeding(parameters, scan)?.pop();
    let exceeding = last.filter(|(_, outcome)| outcome.exceeds());
    Ok(exceeding.map(|(f_o, outcome)| (f_o, outcome.end.reason)))
}
