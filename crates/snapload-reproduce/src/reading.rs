//! The readings of the chapter, the bodies of Table 6.2, and scans over the force.

use snapload::analysis::{ForceScan, Unfinished};
use snapload::{Case, CaseError, Outcome, Parameters, Stop, natural_inertia};

/// How a run that begins to slide is treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Reading {
    /// As in the chapter's own studies: the run ends there (6.3.1).
    Chapter,
    /// As the actual motion: it continues to slide.
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

    /// The parameters for this reading.
    pub(crate) fn apply(self, parameters: Parameters) -> Parameters {
        Parameters {
            stop_when_sliding: self == Self::Chapter,
            ..parameters
        }
    }

    /// In words, as a heading.
    pub(crate) fn heading(self) -> &'static str {
        self.either("sliding ends the run (the chapter)", "sliding goes on")
    }

    /// The option on a command line.
    pub(crate) fn option(self) -> &'static str {
        self.either(" --set stop_when_sliding=true", "")
    }
}

/// A value for each reading.
#[derive(Clone, Debug)]
pub(crate) struct Both<T> {
    pub(crate) chapter: T,
    pub(crate) sliding_on: T,
}

impl<T> Both<T> {
    pub(crate) fn try_new(
        make: impl Fn(Reading) -> Result<T, Unfinished>,
    ) -> Result<Self, Unfinished> {
        Ok(Self {
            chapter: make(Reading::Chapter)?,
            sliding_on: make(Reading::SlidingOn)?,
        })
    }

    pub(crate) fn of(&self, reading: Reading) -> &T {
        reading.either(&self.chapter, &self.sliding_on)
    }
}

/// The standard case with cables of another length.
pub(crate) fn standard(r: f64) -> Parameters {
    Parameters {
        r,
        ..Parameters::STANDARD
    }
}

/// Table 6.2 as published: r, shape, half-sizes, f_cr.
pub(crate) const TABLE_6_2: [(f64, &str, [f64; 2], f64); 16] = [
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

/// The cases of Table 6.2 and their published values.
pub(crate) fn published() -> [(Parameters, f64); 16] {
    TABLE_6_2.map(|(r, _, size, published)| (of_shape(r, size), published))
}

/// The standard case with another body and cables.
pub(crate) fn of_shape(r: f64, [a, b]: [f64; 2]) -> Parameters {
    let inertia = natural_inertia(a, b);
    Parameters {
        a,
        b,
        inertia,
        ..standard(r)
    }
}

/// The outcomes of a case over the force amplitudes of a scan, up to the first that exceeds.
pub(crate) fn up_to_exceeding(
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

/// The first force amplitude of a scan that exceeds, with the reason; larger ones are not run.
pub(crate) fn first_exceeding(
    parameters: &Parameters,
    scan: ForceScan,
) -> Result<Option<(f64, Stop)>, CaseError> {
    let last = up_to_exceeding(parameters, scan)?.pop();
    let exceeding = last.filter(|(_, outcome)| outcome.exceeds());
    Ok(exceeding.map(|(f_o, outcome)| (f_o, outcome.end.reason)))
}
