//! The orbits that `snapload orbit` finds: of one case or of many, and their proofs.
use crate::bar::Bar;
use crate::certify::{exact, exact_but};
use crate::failure::Failure;
use crate::orbit_columns::{ORBIT_COLUMNS, of_orbit, text_columns};
use serde::Serialize;
use snapload::analysis::{OnProgress, Progress};
use snapload::{Entries, Parameters};
use snapload_certificate::ExactCase;
use snapload_orbits::{
    Moored, Orbit, OrbitRequest, OrbitRow, Point, Proofs, Starts, find_orbits, followed_key,
    of_attractor, period_of, prove_all,
};
use snapload_report::CaseEcho;
use snapload_study::Values;

#[derive(Serialize)]
pub(crate) struct ManyOrbits<'a> {
    case: CaseEcho<'a>,
    starts: u32,
    seed: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    vary: Option<&'static str>,
    #[serde(flatten)]
    proofs: Option<Proofs>,
    orbits: Vec<OrbitOfCase>,
}

#[derive(Serialize)]
struct OrbitOfCase {
    /// The value of the key that is varied.
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(flatten)]
    orbit: OrbitRow,
}

/// The search and its case, as given on the command line.
pub(crate) struct Search<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) entries: &'a Entries,
    pub(crate) request: &'a OrbitRequest,
    /// A key, and its values.
    pub(crate) along: Option<(&'static str, Vec<f64>)>,
    /// Whether the orbits found are proved.
    pub(crate) prove: bool,
}

/// One case, and the same in decimals if orbits are proved.
pub(crate) struct OneCase {
    parameters: Parameters,
    value: Option<f64>,
    exact: Option<ExactCase>,
}

/// The orbits found.
pub(crate) struct FoundOrbits {
    vary: Option<&'static str>,
    /// The value of that key of each orbit.
    values: Vec<Option<f64>>,
    pub(crate) orbits: Vec<Orbit>,
    pub(crate) proofs: Option<Proofs>,
}

impl Search<'_> {
    /// The cases of all values, checked.
    pub(crate) fn cases(&self) -> Result<Vec<OneCase>, Failure> {
        let Some((key, values)) = &self.along else {
            let exact = self.prove.then(|| exact(self.parameters, self.entries));
            return Ok(vec![OneCase {
                parameters: *self.parameters,
                value: None,
                exact: exact.transpose()?,
            }]);
        };
        followed_key("vary", self.parameters, key)?;
        let case = |value: &f64| {
            let parameters = self.parameters.over(|name, other| match name {
                _ if name == *key => *value,
                _ => other,
            });
            parameters.check()?;
            period_of(&parameters)?;
            let decimals = || exact_but(&parameters, self.entries, key);
            Ok(OneCase {
                parameters,
                value: Some(*value),
                exact: self.prove.then(decimals).transpose()?,
            })
        };
        values.iter().map(case).collect()
    }

    /// The orbit near a start, or the one that the motion of the case approaches.
    pub(crate) fn one(&self, case: &OneCase, start: Option<Point>) -> Result<FoundOrbits, Failure> {
        let bar = Bar::new();
        let on_progress = |progress: Progress| bar.show(progress);
        let orbit = match start {
            Some(start) => {
                let family = Moored::case(case.parameters, [None; 2]);
                family.orbit([0.0; 2], &start, self.request)
            }
            None => of_attractor(&case.parameters, self.request, &on_progress)?,
        };
        let no_orbit = |why| Failure::Failed(format!("no orbit was found: {why}"));
        let mut found = FoundOrbits::none(None);
        found.add(case, vec![orbit.map_err(no_orbit)?], &on_progress)?;
        Ok(found)
    }

    /// All orbits that random starts lead to.
    pub(crate) fn many(
        &self,
        cases: &[OneCase],
        (starts, seed): (u32, u64),
    ) -> Result<FoundOrbits, Failure> {
        let bar = Bar::new();
        let mut found = FoundOrbits::none(self.along.as_ref().map(|(key, _)| *key));
        let mut near = Vec::new();
        for (k, case) in cases.iter().enumerate() {
            // The bar covers the searches and the proofs of all cases.
            let steps = 1 + usize::from(self.prove);
            let within = |step: usize, progress: Progress| {
                let done = (steps * k + step) as f64 + progress.done / progress.of;
                bar.show(Progress::new("starts", done, (steps * cases.len()) as f64))
            };
            let on_search = |progress: Progress| within(0, progress);
            let on_proof = |progress: Progress| within(1, progress);
            let starts = Starts {
                count: starts as usize,
                seed,
                near: &near,
            };
            let orbits = find_orbits(&case.parameters, &starts, self.request, &on_search)?;
            near = orbits.iter().map(|orbit| orbit.z).collect();
            found.add(case, orbits, &on_proof)?;
        }
        Ok(found)
    }
}

impl FoundOrbits {
    fn none(vary: Option<&'static str>) -> Self {
        Self {
            vary,
            values: Vec::new(),
            orbits: Vec::new(),
            proofs: None,
        }
    }

    /// Adds the orbits of a case, and proves them if that is asked for. Orbits of different cases
    /// count as different.
    fn add(
        &mut self,
        case: &OneCase,
        mut orbits: Vec<Orbit>,
        on_progress: OnProgress,
    ) -> Result<(), Failure> {
        if let Some(exact) = &case.exact {
            let here = prove_all(&mut orbits, exact, on_progress)?;
            let all = self.proofs.get_or_insert_default();
            all.proved += here.proved;
            all.distinct += here.distinct;
        }
        self.values.extend(orbits.iter().map(|_| case.value));
        self.orbits.extend(orbits);
        Ok(())
    }

    pub(crate) fn row<'a>(&self, case: CaseEcho<'a>, starts: u32, seed: u64) -> ManyOrbits<'a> {
        let orbits = self.orbits.iter().zip(&self.values);
        let orbits = orbits.map(|(orbit, value)| OrbitOfCase {
            value: *value,
            orbit: OrbitRow::new(orbit),
        });
        ManyOrbits {
            case,
            starts,
            seed,
            vary: self.vary,
            proofs: self.proofs,
            orbits: orbits.collect(),
        }
    }
}

/// The columns of a table with one row for each orbit.
pub(crate) fn columns(found: &FoundOrbits) -> Vec<(&'static str, Values)> {
    let orbits = &found.orbits;
    let number = |column: &'static str| {
        let values = orbits.iter().map(|o| of_orbit(column, ["", ""], o, 0.0));
        let values = values.map(|value| Some(value).filter(|value| value.is_finite()));
        (column, Values::Numbers(values.collect()))
    };
    let others = ORBIT_COLUMNS.into_iter();
    let mut columns: Vec<_> = others
        .filter(|column| *column != "arclength")
        .map(number)
        .collect();
    columns.extend(text_columns(&orbits.iter().collect::<Vec<_>>()));
    let proved = |orbit: &Orbit| Some(matches!(orbit.proof, Some(Ok(_))));
    columns.push(("proved", Values::Flags(orbits.iter().map(proved).collect())));
    let bound = |orbit: &Orbit| {
        let proof = orbit.proof.as_ref()?.as_ref().ok()?;
        Some(proof.error_of(&orbit.z))
    };
    let bounds = orbits.iter().map(bound).collect();
    columns.push(("error_bound", Values::Numbers(bounds)));
    if let Some(key) = found.vary {
        columns.insert(0, (key, Values::Numbers(found.values.clone())));
    }
    columns
}
