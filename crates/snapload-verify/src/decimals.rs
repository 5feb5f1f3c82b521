//! The numbers of a case as the decimals in which they were written.

use snapload::{Case, CaseError, Entries, Parameters, Precise, Real, Simulation, StartError};

/// The numbers of a case: of a key that was given as text the decimal that was written, of another
/// the shortest that is read back as the same double.
#[derive(Clone, Copy)]
pub(crate) struct Decimals<'a> {
    parameters: &'a Parameters,
    entries: &'a Entries,
}

impl<'a> Decimals<'a> {
    pub(crate) fn new<const WORDS: usize>(
        case: &'a Case,
        entries: &'a Entries,
    ) -> Result<Self, CaseError> {
        let parameters = case.parameters();
        let mut refused = Ok(());
        parameters.map(|key, _| {
            if let Some(text) = entries.written(key)
                && Precise::<WORDS>::of_decimal(text).is_none()
            {
                let allowed = "a decimal of at most 399 characters and a power of ten within 400, \
                               such as 0.25 or 1e-6";
                refused = Err(CaseError::value(key, text, allowed));
            }
        });
        refused.map(|()| Self {
            parameters,
            entries,
        })
    }

    /// The motion at its start, with each number multiplied by a factor.
    pub(crate) fn simulation<const WORDS: usize>(
        &self,
        factor: impl Fn(&str) -> Precise<WORDS>,
    ) -> Result<Simulation<Precise<WORDS>>, StartError> {
        let written = |key| self.entries.written(key).and_then(Precise::of_decimal);
        let mut numbers = self.parameters.over(|key, number| {
            written(key).unwrap_or_else(|| Precise::from_decimal(number)) * factor(key)
        });
        // An inertia that was written does not follow the size, even where both are one double.
        if let (Some(inertia), Some(written)) = (&mut numbers.inertia, written("inertia")) {
            *inertia = written;
        }
        numbers.simulation()
    }
}
