//! `snapload merge`: the parts of a study, joined into the file that one run would have written.
use crate::failure::Failure;
use crate::pending_outputs::PendingOutputs;
use crate::study_picture::PictureArgs;
use crate::study_summary::Summary;
use snapload_study::{check_name, identity_of, merge, parent_of};
use std::path::PathBuf;

/// Which parts, and where the whole goes.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  snapload merge part-*.parquet --out map.parquet
  snapload merge part-*.parquet --out map.parquet --plot map.svg --show rho1")]
pub(crate) struct Args {
    /// All files that snapload sweep --shard wrote, in any order
    #[arg(value_name = "PART.parquet", required = true)]
    parts: Vec<PathBuf>,
    /// The file to write
    #[arg(long, value_name = "FILE.parquet")]
    out: PathBuf,
    #[command(flatten)]
    picture: PictureArgs,
}

/// Joins them.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    check_name(&args.out)?;
    if std::fs::symlink_metadata(&args.out).is_ok() {
        return Err(Failure::BadInput(format!(
            "{} exists already; choose another --out, or remove it",
            args.out.display()
        )));
    }
    if let Some(identity) = args.parts.first().and_then(|part| identity_of(part)) {
        args.picture.check(&identity.study, false)?;
    }
    let mut pending = PendingOutputs::default();
    let folder = pending.open(parent_of(&args.out))?;
    pending.place(folder, args.out.clone(), |scratch| {
        Ok(merge(&args.parts, scratch)?)
    })?;
    pending.commit()?;
    let picture = args.picture.draw(&args.out)?;
    let cases = identity_of(&args.out).map_or(0, |identity| identity.cases);
    Summary::of(&args.out, cases, picture)?.print(true)
}
