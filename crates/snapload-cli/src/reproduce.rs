//! `snapload reproduce`: the chapter's tables and figures as one report.
use crate::bar::Bar;
use crate::failure::{Failure, print};
use crate::pending_outputs::PendingOutputs;
use snapload::analysis::Progress;
use snapload_reproduce::{Report, Study};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Computes every run of the studies in chapter 6 of the thesis in two readings: with runs that end when the body
begins to slide, as in the chapter, and with runs that continue. Writes report.html (one self-contained page), the
tables as CSV, and every figure as SVG with its data as CSV.

Examples:
  snapload reproduce
      write the report into the directory `reproduction`
  snapload reproduce --out chapter-6";

/// Where to put it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Directory of the report, created if absent
    #[arg(long, value_name = "DIR", default_value = "reproduction")]
    out: PathBuf,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut pending = PendingOutputs::default();
    let folder = pending.create_and_open(&args.out)?;
    let pictures = args.out.join("figures");
    let picture_folder = pending.create_and_open(&pictures)?;

    let bar = Bar::new();
    let study = Study::compute(&|progress| bar.show(progress));
    let study = study.map_err(|error| Failure::Failed(format!("the study failed: {error}")))?;
    let _ = bar.show(Progress::new("the figures", 0.9, 1.0));
    let report = Report::new(&study)
        .map_err(|error| Failure::Failed(format!("the report failed: {error}")))?;
    drop(bar);

    for (name, contents) in &report.files {
        let folder = if name.starts_with("figures/") {
            picture_folder
        } else {
            folder
        };
        pending.write(folder, args.out.join(name), |out| out.write_all(contents))?;
    }
    let written = pending.commit()?.len();
    let page = args.out.join("report.html");
    print(&format!(
        "{}\nand {} files beside it\n",
        page.display(),
        written - 1
    ))
}
