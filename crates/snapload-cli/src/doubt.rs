//! What of a case is uncertain, and the run that is told so: the options, and the progress shown meanwhile.
use crate::failure::Failure;
use crate::progress::Progress;
use snapload::Case;
use snapload::analysis::{DEFAULT_MEMBERS, START_KEYS, Uncertainty};
use snapload_report::Trusted;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// What counts as known, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct ToleranceArgs {
    /// Error of state and time above which a result counts as not known
    #[arg(
        long,
        value_name = "SIZE",
        default_value_t = 1e-3,
        allow_negative_numbers = true
    )]
    tolerance: f64,
}

impl ToleranceArgs {
    /// Reads it.
    pub(crate) fn read(&self) -> Result<f64, Failure> {
        let tolerance = self.tolerance;
        if tolerance > 0.0 && tolerance.is_finite() {
            return Ok(tolerance);
        }
        Err(Failure::BadInput(format!(
            "--tolerance {tolerance}: allowed is a number above 0, such as 1e-3"
        )))
    }
}

/// What is uncertain, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct DoubtArgs {
    /// How far every start value may be off, or one key; may be repeated
    #[arg(long, value_name = "SIZE|KEY=SIZE", allow_negative_numbers = true)]
    uncertainty: Vec<String>,
    #[command(flatten)]
    tolerance: ToleranceArgs,
    /// Which neighbours an ensemble draws
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
}

impl DoubtArgs {
    /// Reads them and checks them against a case.
    pub(crate) fn read(&self, case: &Case) -> Result<Uncertainty, Failure> {
        let mut uncertainty = Uncertainty {
            tolerance: self.tolerance.read()?,
            ..Uncertainty::default()
        };
        for text in &self.uncertainty {
            set(&mut uncertainty, text, case)?;
        }
        Ok(uncertainty)
    }

    /// Whether anything was said to be uncertain.
    pub(crate) fn is_given(&self) -> bool {
        !self.uncertainty.is_empty()
    }

    pub(crate) fn seed(&self) -> u64 {
        self.seed
    }
}

fn set(uncertainty: &mut Uncertainty, text: &str, case: &Case) -> Result<(), Failure> {
    let wrong = |what: &str| {
        Failure::BadInput(format!(
            "--uncertainty {text:?}: {what}; write a number such as 1e-3 for all start values, or \
             KEY=NUMBER such as f_o=0.01"
        ))
    };
    let parse = |size: &str| size.trim().parse::<f64>().map_err(|_| wrong("no number"));
    let (keys, size) = match text.split_once('=') {
        Some((key, size)) => {
            let (key, size) = (key.trim(), parse(size)?);
            if START_KEYS.contains(&key) && !case.parameters().moves_by(key) {
                return Err(wrong("this case has no such quantity"));
            }
            (vec![key], size)
        }
        None => (START_KEYS.to_vec(), parse(text)?),
    };
    for key in keys {
        uncertainty
            .set(key, size)
            .map_err(|error| Failure::BadInput(format!("--uncertainty: {error}")))?;
    }
    Ok(())
}

/// How many neighbours to run where one run can not tell.
#[derive(clap::Args)]
pub(crate) struct EnsembleArgs {
    /// Neighbours to run where the end is past the horizon; 0 for none
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MEMBERS)]
    ensemble: u32,
}

/// Runs a case, and its neighbours where it takes them, under progress bars.
pub(crate) fn trusted(
    case: &Case,
    uncertainty: &DoubtArgs,
    ensemble: &EnsembleArgs,
) -> Result<Trusted, Failure> {
    let members = ensemble.ensemble;
    let mut running = Progress::new("running", case.parameters().t_end);
    let neighbours = Mutex::new(None);
    let done = AtomicU64::new(0);
    let neighbour = || {
        let count = done.fetch_add(1, Ordering::Relaxed);
        if let Ok(mut progress) = neighbours.try_lock() {
            let new = || Progress::new("neighbours", f64::from(members));
            progress.get_or_insert_with(new).show(count as f64);
        }
    };
    Trusted::run(
        case,
        uncertainty.read(case)?,
        members,
        uncertainty.seed(),
        |t| running.at(t),
        neighbour,
    )
    .map_err(|error| Failure::BadInput(format!("--uncertainty: {error}")))
}
