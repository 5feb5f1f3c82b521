//! `snapload merge`: the parts of a study, joined into the file that one run would have written.
use crate::failure::Failure;
use crate::pending_outputs::{PendingOutputs, is_same};
use crate::study_csv::RowFiles;
use crate::study_picture::PictureArgs;
use crate::study_summary::Summary;
use snapload_study::{check_name, identity_of, merge, parent_of};
use std::path::PathBuf;

/// Which parts, and where the whole goes.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  snapload merge part-*.parquet --out map.parquet
  snapload merge part-*.parquet --out map.parquet --plot map.svg --show rho1
  snapload merge map.parquet --out map.csv
      a complete file as CSV")]
pub(crate) struct Args {
    /// All files that snapload sweep --shard wrote, in any order
    #[arg(value_name = "PART.parquet", required = true)]
    parts: Vec<PathBuf>,
    /// The file to write. For a name that ends in .csv the rows are written as CSV, too, beside
    /// FILE.parquet
    #[arg(long, value_name = "FILE.parquet|FILE.csv")]
    out: PathBuf,
    #[command(flatten)]
    picture: PictureArgs,
}

/// Joins them.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let files = RowFiles::named(&args.out);
    let out = &*files.parquet;
    check_name(out)?;
    files.check(false)?;
    // Of a complete file only the CSV is missing.
    let complete =
        files.has_csv() && matches!(&args.parts[..], [only] if only.exists() && is_same(only, out));
    if !complete && std::fs::symlink_metadata(out).is_ok() {
        return Err(Failure::BadInput(format!(
            "{} exists already; choose another --out, or remove it",
            out.display()
        )));
    }
    if let Some(identity) = args.parts.first().and_then(|part| identity_of(part)) {
        args.picture.check(&identity.study, false)?;
    }
    let mut pending = PendingOutputs::default();
    let folder = pending.open(parent_of(out))?;
    pending.place(folder, out.to_owned(), |scratch| {
        Ok(merge(&args.parts, scratch)?)
    })?;
    match complete {
        // It was only checked: its own bytes remain.
        true => drop(pending),
        false => drop(pending.commit()?),
    }
    let csv = files.write_csv()?;
    let picture = args.picture.draw(out)?;
    let cases = identity_of(out).map_or(0, |identity| identity.cases);
    Summary::of(out, cases, [csv, picture])?.print(true)
}
