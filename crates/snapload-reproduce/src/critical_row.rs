//! The rows of Table 6.2: what is published, what is proved, and the results of neighbours.

use crate::proved::{self, Proved};
use crate::reading::{Both, Reading, TABLE_6_2, first_exceeding, of_shape};
use crate::verdict::Verdict;
use snapload::analysis::{
    CriticalForce, ExceedanceCurve, ForceScan, Uncertainty, Unfinished, no_progress,
};
use snapload::{Parameters, Stop};

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
    /// The computed ones, with all amplitudes that exceed, in doubles.
    pub(crate) computed: Both<CriticalForce>,
    /// The first amplitude that exceeds in doubles if only the two limits end a run.
    pub(crate) limits_alone: Option<(f64, Stop)>,
    /// The numbers of exceeding neighbours, in the chapter's reading.
    pub(crate) probable: ExceedanceCurve,
    /// The proofs for the amplitudes, in the chapter's reading.
    pub(crate) proved: Vec<(f64, Option<Proved>)>,
}

/// The number of neighbours of each run of Table 6.2, which are 1e-12 away at most.
pub(crate) const NEIGHBOURS: u32 = 100;

impl CriticalRow {
    /// All rows, in the order of the table.
    pub(crate) fn all() -> Result<Vec<Self>, Unfinished> {
        TABLE_6_2.into_iter().map(Self::new).collect()
    }

    fn new(
        (r, shape, size, published): (f64, &'static str, [f64; 2], f64),
    ) -> Result<Self, Unfinished> {
        let parameters = of_shape(r, size);
        let computed = Both::try_new(|reading| {
            CriticalForce::scan(
                &reading.apply(parameters),
                ForceScan::default(),
                &no_progress,
            )
        })?;
        let (chapter, uncertainty) = (Reading::Chapter.apply(parameters), Uncertainty::default());
        let scan = ForceScan::default();
        let alone = Parameters {
            stop_when_settled: false,
            ..parameters
        };
        Ok(Self {
            r,
            shape,
            size,
            published,
            computed,
            limits_alone: first_exceeding(&alone, scan)?,
            probable: ExceedanceCurve::scan(
                &chapter,
                scan,
                &uncertainty,
                NEIGHBOURS,
                1,
                &no_progress,
            )?,
            proved: proved::amplitudes(
                &parameters,
                |case| Proved::stored(case).cloned(),
                published,
            ),
        })
    }

    /// The case of this body and cables, otherwise the standard case.
    pub(crate) fn parameters(&self) -> Parameters {
        of_shape(self.r, self.size)
    }

    /// The first amplitude that exceeds the limits before a time, with its proof; all smaller ones
    /// are proved not to.
    pub(crate) fn first_by(&self, t_end: f64) -> Option<(f64, &Proved)> {
        let proved = self
            .proved
            .iter()
            .map_while(|(f_o, proved)| Some((*f_o, proved.as_ref()?)));
        let exceeds = |proved: &Proved| proved.reason.exceeds() && proved.time() <= t_end;
        let mut exceeding = proved.filter(|(_, proved)| exceeds(proved));
        exceeding.next()
    }

    /// The proved critical force of the chapter's reading.
    pub(crate) fn first(&self) -> Option<(f64, &Proved)> {
        self.first_by(Parameters::STANDARD.t_end)
    }

    /// The proof for the published amplitude.
    pub(crate) fn at_published(&self) -> Option<&Proved> {
        let same = |f_o: f64| (f_o - self.published).abs() < 0.005;
        let found = self.proved.iter().find(|(f_o, _)| same(*f_o));
        found.and_then(|(_, proved)| proved.as_ref())
    }

    /// The part of the neighbours that exceed at an amplitude.
    pub(crate) fn part_exceeding(&self, f_o: f64) -> f64 {
        let same = |at: f64| (at - f_o).abs() < 0.005;
        let found = self.probable.points.iter().find(|point| same(point.f_o));
        found.map_or(0.0, |point| point.part)
    }

    /// Whether the published value agrees with the proof and with all neighbours, certainly does
    /// not, or is undecidable: it differs, but neighbours at or below it disagree.
    pub(crate) fn verdict(&self) -> Verdict {
        let below = || {
            let points = self.probable.points.iter();
            points.filter(|point| point.f_o < self.published - 0.005)
        };
        let at_published = self.part_exceeding(self.published);
        let equal = self
            .first()
            .is_some_and(|(f_o, _)| (f_o - self.published).abs() < 0.005);
        let none_below = below().all(|point| point.part == 0.0);
        match equal {
            true if none_below && at_published == 1.0 => Verdict::Reproduced,
            false if at_published == 0.0 || below().any(|point| point.part == 1.0) => {
                Verdict::NotReproduced
            }
            _ => Verdict::NotDecidable,
        }
    }
}
