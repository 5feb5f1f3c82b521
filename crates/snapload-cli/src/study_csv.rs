//! `--out FILE.csv`: the rows of a study as CSV, beside the Parquet file that they are copied from.
use crate::failure::Failure;
use crate::pending_outputs::PendingOutputs;
use snapload_study::{folder_of, write_study_csv};
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

/// The files of a study's rows.
pub(crate) struct RowFiles<'a> {
    /// The Parquet file, which knows its study and carries a checksum.
    pub(crate) parquet: Cow<'a, Path>,
    csv: Option<&'a Path>,
}

impl<'a> RowFiles<'a> {
    /// Those that `--out` asks for: a Parquet file alone, unless the name ends in `.csv`.
    pub(crate) fn named(out: &'a Path) -> Self {
        let is_csv = out
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        match is_csv {
            true => Self {
                parquet: out.with_extension("parquet").into(),
                csv: Some(out),
            },
            false => Self {
                parquet: out.into(),
                csv: None,
            },
        }
    }

    /// Whether there is a CSV file besides.
    pub(crate) fn has_csv(&self) -> bool {
        self.csv.is_some()
    }

    /// Refuses an existing CSV file before anything is computed. Whoever resumes may have written it
    /// already, so then it may be there.
    pub(crate) fn check(&self, resume: bool) -> Result<(), Failure> {
        match self.csv {
            Some(csv) if !resume && is_there(csv) => Err(occupied(csv, "")),
            _ => Ok(()),
        }
    }

    /// Writes the CSV file, if one is wanted, from the complete Parquet file, and returns its path.
    pub(crate) fn write_csv(&self) -> Result<Option<PathBuf>, Failure> {
        let Some(csv) = self.csv else {
            return Ok(None);
        };
        let mut pending = PendingOutputs::default();
        let folder = pending.open(folder_of(csv)?)?;
        pending.place(folder, csv.to_owned(), |scratch| {
            let failed = |error| Failure::write(csv.display(), &error);
            let mut out = BufWriter::new(File::create_new(scratch).map_err(failed)?);
            write_study_csv(&self.parquet, &mut out)?
                .and_then(|()| out.flush())
                .map_err(failed)?;
            match is_there(csv) && !has_same_bytes(scratch, csv).map_err(failed)? {
                true => Err(occupied(csv, " and is not the CSV of this study")),
                false => Ok(()),
            }
        })?;
        pending.commit()?;
        Ok(Some(csv.to_owned()))
    }
}

fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// An existing file is not overwritten, as rows are not.
fn occupied(csv: &Path, with: &str) -> Failure {
    Failure::BadInput(format!(
        "{} exists already{with}; choose another --out, or remove it",
        csv.display()
    ))
}

fn has_same_bytes(one: &Path, other: &Path) -> io::Result<bool> {
    let open = |path| Ok::<_, io::Error>(BufReader::new(File::open(path)?).bytes());
    let (mut one, mut other) = (open(one)?, open(other)?);
    loop {
        match (one.next().transpose()?, other.next().transpose()?) {
            (None, None) => return Ok(true),
            (here, there) if here != there => return Ok(false),
            _ => {}
        }
    }
}
