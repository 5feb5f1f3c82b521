//! The uncertainties of a case, as given on the command line.
use crate::failure::Failure;
use crate::option_values::whole_number;
use snapload::Case;
use snapload::analysis::{SEED, UNCERTAINTY, Uncertainty, Unfinished};
use snapload_report::TOLERANCE;

/// What counts as known, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct ToleranceArgs {
    /// Error of state and time, relative to values above 1, above
    /// which a result counts as not known
    #[arg(long, value_name = "SIZE", default_value_t = DEFAULT_TOLERANCE)]
    tolerance: f64,
}

const DEFAULT_TOLERANCE: f64 = 1e-3;

impl ToleranceArgs {
    /// Reads it.
    pub(crate) fn read(&self) -> Result<f64, Failure> {
        TOLERANCE.check("--tolerance", &self.tolerance.into())?;
        Ok(self.tolerance)
    }
}

/// What is uncertain, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct UncertaintyArgs {
    /// Uncertainty of every start value, or of one key; may be repeated
    #[arg(long, value_name = "SIZE|KEY=SIZE")]
    uncertainty: Vec<String>,
    #[command(flatten)]
    tolerance: ToleranceArgs,
    /// Seed with which an ensemble draws its neighbours
    #[arg(long, value_name = "NUMBER", default_value_t = DEFAULT_SEED, value_parser = whole_number::<u64>(SEED))]
    seed: u64,
}

const DEFAULT_SEED: u64 = 1;

impl UncertaintyArgs {
    /// Reads them and checks them against a case.
    pub(crate) fn read(&self, case: &Case) -> Result<Uncertainty, Failure> {
        let mut uncertainty = Uncertainty {
            tolerance: self.tolerance.read()?,
            ..Uncertainty::default()
        };
        let mut set = |text: &String| {
            let (key, size) = parse(text)?;
            let set = uncertainty.set_for(case.parameters(), key, size);
            set.map_err(|error| Failure::bad_input(error).with_prefix(OPTION))
        };
        self.uncertainty.iter().try_for_each(&mut set)?;
        Ok(uncertainty)
    }

    /// An option that changes something, if there is one.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            (!self.uncertainty.is_empty(), OPTION),
            (self.tolerance.tolerance != DEFAULT_TOLERANCE, "--tolerance"),
            (self.seed != DEFAULT_SEED, "--seed"),
        ];
        given
            .into_iter()
            .find_map(|(given, name)| given.then_some(name))
    }

    pub(crate) fn seed(&self) -> u64 {
        self.seed
    }
}

/// An error of work with neighbours; one that names the uncertainty names the option instead.
pub(crate) fn with_option(error: Unfinished) -> Unfinished {
    match error {
        Unfinished::Case(mut error) if error.key == UNCERTAINTY => {
            error.key = OPTION.to_owned();
            Unfinished::Case(error)
        }
        other => other,
    }
}

/// The same where every other error is one of the uncertainty, too.
pub(crate) fn of_option(error: Unfinished) -> Failure {
    match with_option(error) {
        Unfinished::Case(error) if error.key != OPTION => Failure::from(error).with_prefix(OPTION),
        other => other.into(),
    }
}

/// The option.
const OPTION: &str = "--uncertainty";

/// The meaning of one `--uncertainty`: a key, or none for all start values, and a size.
fn parse(text: &str) -> Result<(Option<&str>, f64), Failure> {
    let (key, size) = match text.split_once('=') {
        Some((key, size)) => (Some(key.trim()), size),
        None => (None, text),
    };
    let size = size.trim().parse().map_err(|_| {
        Failure::BadInput(format!(
            "--uncertainty {text:?}: no number; write a number such as 1e-3 for all start values, or KEY=NUMBER such \
             as f_o=0.01"
        ))
    })?;
    Ok((key, size))
}
