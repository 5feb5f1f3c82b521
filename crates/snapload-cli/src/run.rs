//! `snapload run`: one case, from its start to its end.
use crate::bar::Bar;
use crate::case_input::{CaseArgs, Input};
use crate::certify::exact;
use crate::failure::{Failure, print};
use crate::json::{Json, JsonArgs, refuse_directory};
use crate::option_values::whole_number;
use crate::pending_outputs::{PendingOutputs, TargetFolder};
use crate::pictures::pictures;
use crate::uncertainty::{UncertaintyArgs, of_option};
use snapload::analysis::{MEMBERS, Progress};
use snapload::{Case, Sampling};
use snapload_certificate::Cancelled;
use snapload_report::{
    Certified, Report, RunWithTrust, case_as_written, case_in_words, prove, summary, tables,
    write_json,
};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  snapload run
      the standard case, with a short printed summary
  snapload run --case 1910001000-459 --set t_end=20 --set stop_when_settled=false
      a built-in case that continues after it settles, up to t = 20
  snapload run --set body=point --set y=0.2
      a point mass that starts higher
  snapload run mooring.toml --out results --sample 0.01
      your own case: tables, pictures and run.json in the directory results
  snapload run --set f_o=0.5 --uncertainty 1e-3 --uncertainty f_o=0.01
      how far the run can be trusted if the start is known to 1e-3 and the force to 0.01
  snapload run --certify
      with a proof of the impacts and the end, and where the run departs from the proof
  snapload run --json - --sample 0.1 | jq .norms
      all results as JSON, for another program";

/// What to run and where to put it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    json: JsonArgs,
    /// Write tables (CSV), run.json and pictures into a directory, created if absent
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    uncertainty: UncertaintyArgs,
    /// Number of neighbours to run if the end is past the horizon of trust; 0 for none. If left
    /// out, 1000, or 200 if those end alike
    #[arg(long, value_name = "N", value_parser = whole_number::<u32>(MEMBERS.called("ensemble")))]
    ensemble: Option<u32>,
    /// Prove the run as snapload certify does, with the decimals of the case taken as exact; with
    /// --out, the certificate is written as run.cert
    #[arg(long)]
    certify: bool,
    /// Time step at which --json and --out write the motion
    #[arg(long, value_name = "DT", value_parser = step)]
    sample: Option<f64>,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.sample.is_some() && args.json.json.is_none() && args.out.is_none() {
        return Err(Failure::bad_input(
            "--sample is the time step of the written motion, but nothing is written; add --json FILE or --out DIR",
        ));
    }
    let input = args.case.read()?;
    // A run may end early, but when is not known before it is run.
    let longest = input.case.parameters().t_end;
    args.sample
        .map(|dt| sampling(dt, longest, "; or a lower t_end"))
        .transpose()?;
    let mut outputs = Outputs::open(args)?;
    let trusted = trusted(args, &input.case)?;
    let certified = certified(args, &input, &trusted)?;
    // A proof is about the numbers as they were written.
    let (name, parameters) = (&input.name, input.case.parameters());
    let caption = match certified {
        Some(_) => case_as_written(name, parameters, &input.entries),
        None => case_in_words(name, parameters),
    };
    let trajectory = &trusted.run;
    let sampling = args
        .sample
        .map(|dt| sampling(dt, trajectory.end().t, ""))
        .transpose()?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let report = Report::new(input.case.parameters(), &trusted, sampling, &on_progress)
        .with_certificate(certified.as_ref());

    if let Some((folder, directory)) = outputs.directory.take() {
        let pending = &mut outputs.pending;
        write_directory(pending, folder, &directory, &caption, &trusted, sampling)?;
        pending.write(folder, directory.join("run.json"), |out| {
            write_json(&report, out)
        })?;
        let certificate = directory.join(CERTIFICATE);
        match &certified {
            Some(certified) => {
                pending.write(folder, certificate, |out| write_json(&certified.proof, out))?
            }
            None => pending.remove(certificate),
        }
    }
    match outputs.json.write(outputs.pending, &report)? {
        Some(written) => print(&summary(
            &caption,
            parameters,
            &trusted,
            certified.as_ref(),
            &written,
        )),
        None => Ok(()),
    }
}

/// The run, and its neighbours if needed, with a progress bar.
fn trusted(args: &Args, case: &Case) -> Result<RunWithTrust, Failure> {
    let uncertainty = args.uncertainty.read(case)?;
    let (bar, seed) = (Bar::new(), args.uncertainty.seed());
    let on_progress = |progress: Progress| bar.show(progress);
    RunWithTrust::run(case, uncertainty, args.ensemble, seed, &on_progress).map_err(of_option)
}

/// The proof of the run, if it is asked for.
fn certified(
    args: &Args,
    input: &Input,
    trusted: &RunWithTrust,
) -> Result<Option<Certified>, Failure> {
    if !args.certify {
        return Ok(None);
    }
    let (case, t_end) = (
        exact(input.case.parameters(), &input.entries)?,
        input.case.parameters().t_end,
    );
    let bar = Bar::new();
    let proof = prove(&case, t_end, &|progress| bar.show(progress));
    let proof =
        proof.map_err(|Cancelled| Failure::Interrupted("nothing was written".to_owned()))?;
    let proof = proof.map_err(|why| Failure::BadInput(format!("--certify: {why}")))?;
    Ok(Some(Certified::new(proof, &trusted.run)))
}

/// A time step, parsed for clap.
fn step(text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(dt) if dt > 0.0 && dt.is_finite() => Ok(dt),
        _ => Err("allowed: a number above 0, such as 0.01"),
    }
}

/// The times of a run up to `end`; `instead` is advice for the error message.
fn sampling(dt: f64, end: f64, instead: &str) -> Result<Sampling, Failure> {
    Sampling::every(dt, end).map_err(|allowed| {
        Failure::BadInput(format!(
            "--sample {dt:e} is not allowed; allowed: {allowed}{instead}"
        ))
    })
}

/// The places of the output, opened before the run so that an error is known at once.
struct Outputs {
    pending: PendingOutputs,
    directory: Option<(TargetFolder, PathBuf)>,
    json: Json,
}

/// The certificate in an output directory.
const CERTIFICATE: &str = "run.cert";
/// The files of an output directory, without the pictures.
const FILES: [&str; 5] = [
    "impacts.csv",
    "modes.csv",
    "motion.csv",
    "run.json",
    CERTIFICATE,
];

impl Outputs {
    fn open(args: &Args) -> Result<Self, Failure> {
        let mut pending = PendingOutputs::default();
        let json = args.json.open(&mut pending)?;
        let directory = match &args.out {
            None => None,
            Some(directory) => {
                let folder = pending.create_and_open(directory)?;
                FILES
                    .iter()
                    .try_for_each(|name| refuse_directory(&directory.join(name)))?;
                Some((folder, directory.clone()))
            }
        };
        Ok(Self {
            pending,
            directory,
            json,
        })
    }
}

fn write_directory(
    pending: &mut PendingOutputs,
    folder: TargetFolder,
    directory: &Path,
    caption: &str,
    trusted: &RunWithTrust,
    sampling: Option<Sampling>,
) -> Result<(), Failure> {
    let trajectory = &trusted.run;
    let sampling = sampling.unwrap_or_else(|| Sampling::thousand(trajectory.end().t));
    let place = |name: &str| directory.join(name);
    pending.write(folder, place("impacts.csv"), |out| {
        tables::impacts(trajectory, trusted.trust.digits(), out)
    })?;
    pending.write(folder, place("modes.csv"), |out| {
        tables::modes(trajectory, out)
    })?;
    pending.write(folder, place("motion.csv"), |out| {
        tables::motion(trajectory, sampling, out)
    })?;
    for picture in pictures(caption, trusted)? {
        pending.write(folder, place(&picture.name), |out| {
            out.write_all(&picture.bytes)
        })?;
    }
    Ok(())
}
