//! `snapload sweep`: a study, a row a case, in one Parquet file, and as CSV.
use crate::bar::Bar;
use crate::failure::Failure;
use crate::interrupt::{self, Graceful, print_error_line};
use crate::option_values::whole_number;
use crate::study_csv::RowFiles;
use crate::study_input::StudyArgs;
use crate::study_picture::PictureArgs;
use crate::study_summary::Summary;
use snapload::analysis::{Cancelled, Progress};
use snapload_report::shell_command;
use snapload_study::{Identity, Opened, Shard, Store, StudyError, THREADS, sweep, threads_for};
use std::ops::ControlFlow;
use std::path::PathBuf;

const EXAMPLES: &str = "\
A key varies over first:last:n (n evenly spaced values, each the decimal that one would write) or over a list
v1,v2,... All combinations are run, and the first key varies slowest. Every chunk of rows is saved as soon as it is
computed. After an interruption of any kind the same command with --resume continues, and the finished file is the
same to the byte.

Examples:
  snapload sweep --vary f_o=0.01:0.6:60 --vary omega=0.4:2.4:51 --out map.parquet --plot map.svg
      a map over force and frequency, with a picture of how the runs end
  snapload sweep --vary f_o=0.01:0.6:60 --vary omega=0.4:2.4:51 --out map.parquet --resume
      the same study, continued after an interruption
  snapload sweep mooring.toml --vary e=0.5:1:501 --no-trust --out e.parquet --plot e.png --show rho1
      a line plot over the restitution, for your own case
  snapload sweep --vary f_o=0.1:0.6 --vary x=-0.05:0.05 --random 100000 --seed 1 --out box.parquet
      Sobol points in a box
  snapload sweep --list cases.csv --out results.csv
      the cases of a table with one column per key; the rows as results.csv and results.parquet
  snapload sweep study.toml --shard 3/8 --out part-3.parquet
      the third of eight parts, for one of eight machines; snapload merge joins them";

/// Which study, and where its rows go.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    study: StudyArgs,
    /// The file to write; its parts are kept in FILE.parquet.parts until it is complete. For a
    /// name that ends in .csv the rows are written as CSV, too, beside FILE.parquet
    #[arg(long, value_name = "FILE.parquet|FILE.csv")]
    out: PathBuf,
    /// Continue where an earlier run of this command stopped; also allowed for a first run
    #[arg(long)]
    resume: bool,
    /// Compute only the i-th of n parts
    #[arg(long, value_name = "i/n", conflicts_with = "plot")]
    shard: Option<String>,
    /// Number of threads; by default as many as the machine has, at most four times as many
    #[arg(long, value_name = "N", value_parser = whole_number::<u16>(THREADS))]
    threads: Option<u16>,
    #[command(flatten)]
    picture: PictureArgs,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let study = args.study.read()?;
    let shard = args.shard.as_deref().map(Shard::parse).transpose();
    let shard = shard.map_err(|error| Failure::from(error).with_prefix("--shard"))?;
    let identity = Identity::new(&study, shard);
    let files = RowFiles::named(&args.out);
    files.check(args.resume)?;
    args.picture.check(&identity.study, args.resume)?;
    args.threads.map(start_threads).transpose()?;
    let rows = identity.rows.end - identity.rows.start;
    match Store::open(&files.parquet, identity, args.resume)? {
        Opened::Complete => {}
        Opened::Work(store) => {
            if store.damaged() > 0 {
                let (rows, out) = (store.damaged(), files.parquet.display());
                print_error_line(&format!(
                    "{rows} rows in {out}.parts were damaged, and are computed again"
                ));
            }
            interrupt::end_gracefully(Graceful {
                on_first: Box::new(|| {
                    print_error_line(
                        "stopping after the cases in progress; interrupt again to stop at once",
                    );
                }),
                after_second: "the saved rows are kept, and --resume continues from there",
            });
            let bar = Bar::counting();
            let on_progress = |progress: Progress| match interrupt::stop_requested() {
                true => ControlFlow::Break(()),
                false => bar.show(progress),
            };
            let swept = sweep(&study, store, &on_progress);
            drop(bar);
            swept.map_err(|error| with_resume_hint(error, rows))?;
        }
    }
    let csv = files.write_csv().map_err(|error| match error {
        Failure::Failed(message) => rows_are_kept(&message),
        other => other,
    })?;
    let picture = args.picture.draw(&files.parquet)?;
    let whole = args.shard.is_none();
    Summary::of(&files.parquet, rows, [csv, picture])?
        .with(study.plan())
        .print(whole)
}

/// Starts as many threads as asked for, up to a few for each that the machine runs at a time.
fn start_threads(asked: u16) -> Result<(), Failure> {
    let (threads, fewer) = threads_for(asked.into());
    if let Some(why) = fewer {
        print_error_line(&format!("--threads {asked}: {why}"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let built = pool.build_global();
    built.map_err(|error| Failure::Failed(format!("can not start {threads} threads: {error}")))
}

/// The error, and the remark that no more than a few seconds of work are lost.
fn with_resume_hint(error: StudyError, rows: u64) -> Failure {
    match error {
        StudyError::Cancelled(Cancelled { done }) => Failure::Interrupted(format!(
            "{done} of {rows} rows are saved; to continue:\n  {}",
            resume_command()
        )),
        StudyError::Failed(message) => rows_are_kept(&message),
        StudyError::Damaged { .. } => Failure::Failed(format!(
            "{error}\nhint: rows were repeatedly read back other than they were written; use an --out on another disk, \
             or compute them again here with\n  {}",
            resume_command()
        )),
        other => other.into(),
    }
}

fn rows_are_kept(message: &str) -> Failure {
    Failure::Failed(format!(
        "{message}\nhint: the saved rows are kept; once this is corrected, continue with\n  {}",
        resume_command()
    ))
}

/// The command that was given, with --resume.
fn resume_command() -> String {
    let mut words = crate::given_words();
    if !words.iter().any(|word| word == "--resume") {
        words.push("--resume".into());
    }
    shell_command(words.iter().map(|word| &**word))
}
