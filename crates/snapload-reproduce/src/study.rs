//! Every run that the report needs, each computed once.

use rayon::prelude::*;
use snapload::analysis::{CriticalForce, ExceedanceCurve, ForceScan, Uncertainty};
use snapload::{
    Case, CaseError, Outcome, Parameters, Stop, TABLE_6_1, Trajectory, named_case, natural_inertia,
};

/// How a run that begins to slide is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reading {
    /// As the chapter's own studies did: the run ends there (6.3.1).
    Chapter,
    /// As it is: the motion slides on.
    SlidingOn,
}

impl Reading {
    /// Both, the chapter's first.
    pub const BOTH: [Self; 2] = [Self::Chapter, Self::SlidingOn];

    /// The parameters, read so.
    pub fn apply(self, parameters: Parameters) -> Parameters {
        Parameters {
            stop_when_sliding: self == Self::Chapter,
            ..parameters
        }
    }

    /// In words, as a heading.
    pub fn words(self) -> &'static str {
        match self {
            Self::Chapter => "sliding ends the run (the chapter)",
            Self::SlidingOn => "sliding goes on",
        }
    }

    /// What to add to a command line.
    pub fn option(self) -> &'static str {
        match self {
            Self::Chapter => " --set stop_when_sliding=true",
            Self::SlidingOn => "",
        }
    }
}

/// One of each reading.
#[derive(Clone, Debug)]
pub struct Both<T> {
    /// The chapter's.
    pub chapter: T,
    /// The other.
    pub sliding_on: T,
}

impl<T> Both<T> {
    fn try_new(make: impl Fn(Reading) -> Result<T, CaseError>) -> Result<Self, CaseError> {
        Ok(Self {
            chapter: make(Reading::Chapter)?,
            sliding_on: make(Reading::SlidingOn)?,
        })
    }

    /// That of a reading.
    pub fn of(&self, reading: Reading) -> &T {
        match reading {
            Reading::Chapter => &self.chapter,
            Reading::SlidingOn => &self.sliding_on,
        }
    }
}

/// A built-in case and its runs.
#[derive(Clone, Debug)]
pub struct CaseRuns {
    /// Its code.
    pub code: &'static str,
    /// Its values.
    pub parameters: Parameters,
    /// The runs.
    pub runs: Both<Trajectory>,
}

/// A row of Table 6.2.
#[derive(Clone, Debug)]
pub struct CriticalRow {
    /// Cable length.
    pub r: f64,
    /// `circle`, `square` or `rectangle`.
    pub shape: &'static str,
    /// Half-sizes.
    pub size: [f64; 2],
    /// The published critical force.
    pub published: f64,
    /// The computed ones, with all amplitudes that exceed.
    pub computed: Both<CriticalForce>,
    /// How many neighbours exceed, at amplitudes up to [`CriticalRow::looked_up_to`].
    pub probable: Both<ExceedanceCurve>,
}

/// Neighbours of each run of Table 6.2, 1e-12 away at the most.
pub const NEIGHBOURS: u32 = 20;

impl CriticalRow {
    /// The body with all else as in the standard case.
    pub fn parameters(&self) -> Parameters {
        of_shape(self.r, self.size)
    }

    /// The larger of the published critical force and the computed ones.
    pub fn looked_up_to(&self) -> f64 {
        looked_up_to(self.published, &self.computed)
    }

    /// Whether arithmetic in doubles can decide the published value: at no amplitude up to it neighbours
    /// disagree.
    pub fn decidable(&self, reading: Reading) -> bool {
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

/// The standard case with another body and cables.
fn of_shape(r: f64, [a, b]: [f64; 2]) -> Parameters {
    Parameters {
        r,
        a,
        b,
        inertia: natural_inertia(a, b),
        ..Parameters::STANDARD
    }
}

/// A point of a curve of critical force: the value of the key, and f_cr where there is one.
pub type CriticalPoint = (f64, Option<f64>);

/// A curve of critical force over one key.
#[derive(Clone, Debug)]
pub struct CriticalCurve {
    /// Cable length.
    pub r: f64,
    /// `e` or `omega`.
    pub key: &'static str,
    /// The curve.
    pub points: Both<Vec<CriticalPoint>>,
}

/// The norms over the force amplitude, up to the critical force.
#[derive(Clone, Debug)]
pub struct NormCurve {
    /// Cable length.
    pub r: f64,
    /// Amplitude and outcome.
    pub points: Both<Vec<(f64, Outcome)>>,
}

/// Everything that was computed.
#[derive(Clone, Debug)]
pub struct Study {
    /// The cases of Table 6.1 in the order of first mention, and the printed variants.
    pub cases: Vec<CaseRuns>,
    /// Table 6.2.
    pub critical: Vec<CriticalRow>,
    /// Figs 6.27-6.30.
    pub curves: Vec<CriticalCurve>,
    /// Figs 6.31-6.38.
    pub norms: Vec<NormCurve>,
    /// The sliding example (eq. 6.57).
    pub sliding: Trajectory,
    /// The rocking example (eq. 6.69).
    pub rocking: Trajectory,
}

/// Table 6.2 as published: r, shape, a, b, f_cr.
const TABLE_6_2: [(f64, &str, f64, f64, f64); 16] = [
    (1.5, "circle", 0.1, 0.0, 0.31),
    (1.5, "circle", 0.2, 0.0, 0.42),
    (1.5, "circle", 0.3, 0.0, 0.40),
    (1.5, "square", 0.1, 0.1, 0.32),
    (1.5, "square", 0.2, 0.2, 0.34),
    (1.5, "square", 0.3, 0.3, 0.60),
    (1.5, "rectangle", 0.2, 0.1, 0.68),
    (1.5, "rectangle", 0.3, 0.1, 0.67),
    (2.5, "circle", 0.1, 0.0, 0.10),
    (2.5, "circle", 0.2, 0.0, 0.18),
    (2.5, "circle", 0.3, 0.0, 0.30),
    (2.5, "square", 0.1, 0.1, 0.28),
    (2.5, "square", 0.2, 0.2, 0.33),
    (2.5, "square", 0.3, 0.3, 0.35),
    (2.5, "rectangle", 0.2, 0.1, 0.27),
    (2.5, "rectangle", 0.3, 0.1, 0.35),
];

/// The values over which the curves of critical force are drawn: key, first, last, how many.
const CURVES: [(&str, f64, f64, usize); 2] = [("e", 0.3, 1.0, 71), ("omega", 0.4, 2.4, 101)];

/// How far the study has come: what is being computed, and which part of all.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

impl Study {
    /// Computes everything.
    ///
    /// # Errors
    /// None but for a fault of the program: every case is legal.
    pub fn compute(progress: Progress) -> Result<Self, CaseError> {
        progress("the cases of Table 6.1", 0.0);
        let cases = cases()?;
        progress("Table 6.2", 0.1);
        let critical = TABLE_6_2
            .iter()
            .map(critical_row)
            .collect::<Result<_, _>>()?;
        let mut curves = Vec::new();
        for (k, (key, first, last, count)) in CURVES.into_iter().enumerate() {
            for (j, r) in [1.5, 2.5].into_iter().enumerate() {
                let part = 0.2 + 0.15 * (2 * k + j) as f64;
                progress(&format!("critical force over {key}, r = {r}"), part);
                curves.push(curve(key, r, (first, last, count))?);
            }
        }
        progress("the norms", 0.8);
        let norms = [1.5, 2.5]
            .into_iter()
            .map(norm_curve)
            .collect::<Result<_, _>>()?;
        let example = |code| -> Result<Trajectory, CaseError> {
            Ok(Case::new(named_case(code)?.parameters)?.run())
        };
        Ok(Self {
            cases,
            critical,
            curves,
            norms,
            sliding: example("sliding-example")?,
            rocking: example("rocking-example")?,
        })
    }

    /// A built-in case by its code.
    pub fn case(&self, code: &str) -> Option<&CaseRuns> {
        self.cases.iter().find(|case| case.code == code)
    }
}

fn cases() -> Result<Vec<CaseRuns>, CaseError> {
    let mut codes: Vec<&'static str> = Vec::new();
    let printed = snapload::named_cases().map(|case| case.code);
    let table = TABLE_6_1.iter().map(|(_, code)| *code);
    for code in table.chain(printed.filter(|code| code.ends_with("-559"))) {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    codes
        .into_par_iter()
        .map(|code| {
            let parameters = named_case(code)?.parameters;
            Ok(CaseRuns {
                code,
                parameters,
                runs: Both::try_new(|reading| Ok(Case::new(reading.apply(parameters))?.run()))?,
            })
        })
        .collect()
}

fn critical_row(
    &(r, shape, a, b, published): &(f64, &'static str, f64, f64, f64),
) -> Result<CriticalRow, CaseError> {
    let parameters = of_shape(r, [a, b]);
    let computed = Both::try_new(|reading| {
        CriticalForce::scan(&reading.apply(parameters), ForceScan::default())
    })?;
    let scan = ForceScan::new(0.01, looked_up_to(published, &computed))?;
    let uncertainty = Uncertainty::default();
    Ok(CriticalRow {
        r,
        shape,
        size: [a, b],
        published,
        computed,
        probable: Both::try_new(|reading| {
            ExceedanceCurve::scan(
                &reading.apply(parameters),
                scan,
                &uncertainty,
                NEIGHBOURS,
                1,
                |_| {},
            )
        })?,
    })
}

fn curve(
    key: &'static str,
    r: f64,
    (first, last, count): (f64, f64, usize),
) -> Result<CriticalCurve, CaseError> {
    let points = |reading: Reading| {
        (0..count)
            .into_par_iter()
            .map(|k| {
                // Rounded to the decimals that one would write.
                let value = first + (last - first) * k as f64 / (count - 1) as f64;
                let value = (value * 1000.0).round() / 1000.0;
                let mut parameters = Parameters {
                    r,
                    ..Parameters::STANDARD
                };
                match key {
                    "e" => parameters.e = value,
                    _ => parameters.omega = value,
                }
                let first = first_exceeding(&reading.apply(parameters), ForceScan::default())?;
                Ok((value, first.map(|(f_o, _)| f_o)))
            })
            .collect::<Result<Vec<_>, CaseError>>()
    };
    Ok(CriticalCurve {
        r,
        key,
        points: Both::try_new(points)?,
    })
}

/// The first force amplitude of a scan that exceeds, with the reason; nothing beyond it is run.
pub(crate) fn first_exceeding(
    parameters: &Parameters,
    scan: ForceScan,
) -> Result<Option<(f64, Stop)>, CaseError> {
    for f_o in scan.amplitudes() {
        let outcome = Outcome::of(&Case::new(Parameters { f_o, ..*parameters })?);
        if outcome.exceeds() {
            return Ok(Some((f_o, outcome.end.reason)));
        }
    }
    Ok(None)
}

fn norm_curve(r: f64) -> Result<NormCurve, CaseError> {
    let points = |reading: Reading| {
        let mut points = Vec::new();
        for f_o in ForceScan::default().amplitudes() {
            let parameters = Parameters {
                r,
                f_o,
                ..Parameters::STANDARD
            };
            let outcome = Outcome::of(&Case::new(reading.apply(parameters))?);
            points.push((f_o, outcome));
            if outcome.exceeds() {
                break;
            }
        }
        Ok(points)
    };
    Ok(NormCurve {
        r,
        points: Both::try_new(points)?,
    })
}
