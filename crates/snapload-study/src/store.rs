//! Where the rows of a study are kept until all are there.
//!
//! Beside the file to come stands the directory `FILE.parts`. Each chunk of rows is written there under a
//! scratch name, brought to the disk, and renamed: it is whole or not at all. When nothing is missing the
//! chunks are joined, the file is brought to the disk and renamed into its place, and the directory goes. At
//! whichever point the power fails, what was renamed is still there, and all else is done again.

use crate::whole::{identity_of, join, to_bytes};
use crate::{Identity, Row, Study, StudyError, rows};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The description of the study to which the chunks belong.
const STUDY: &str = "study.toml";
/// Held by the program that is at work.
const LOCK: &str = "lock";
/// Whatever is not yet whole.
const SCRATCH: &str = "scratch";

/// A study's rows, in the making.
#[derive(Debug)]
pub struct Store {
    target: PathBuf,
    directory: PathBuf,
    identity: Identity,
    /// The chunks that are there: first row, and the one after the last.
    chunks: BTreeMap<u64, u64>,
    _lock: File,
}

/// What was found where the file is to be.
#[derive(Debug)]
pub enum Opened {
    /// The file itself, complete.
    Complete,
    /// Something to do.
    Work(Store),
}

impl Store {
    /// Opens the place of a file. Rows of an earlier run are taken up only if `resume` says so.
    ///
    /// # Errors
    /// [`StudyError::Input`] if something else stands there, if another study was begun there, or this one
    /// was and is not to be resumed, or if another program is at work there.
    pub fn open(target: &Path, identity: Identity, resume: bool) -> Result<Opened, StudyError> {
        let mut name = OsString::from(target);
        name.push(".parts");
        let directory = PathBuf::from(name);
        if fs::symlink_metadata(target).is_ok() {
            return finished(target, &directory, &identity, resume);
        }
        folder_of(target)?;
        let text = describe(&identity);
        let known = fs::read_to_string(directory.join(STUDY)).ok();
        if let Some(known) = &known {
            if *known != text {
                return Err(other_study(&directory, known, &text));
            }
        } else {
            match fs::create_dir(&directory) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                    return Err(StudyError::write(&directory, error).of_input());
                }
                _ => {}
            }
        }
        let lock = lock(&directory)?;
        let mut store = Self {
            target: target.to_owned(),
            chunks: BTreeMap::new(),
            identity,
            directory,
            _lock: lock,
        };
        if known.is_none() {
            store.put(STUDY, text.as_bytes())?;
        }
        store.find_chunks()?;
        if store.safe() > 0 && !resume {
            return Err(StudyError::Input(format!(
                "{} holds {} of {} rows of this study already; go on with --resume, or remove it to begin anew",
                store.directory.display(),
                store.safe(),
                store.asked(),
            )));
        }
        Ok(Opened::Work(store))
    }

    /// How many rows are safe.
    pub fn safe(&self) -> u64 {
        self.chunks.iter().map(|(start, end)| end - start).sum()
    }

    /// How many rows there are to be.
    pub fn asked(&self) -> u64 {
        self.identity.rows.end - self.identity.rows.start
    }

    /// The first rows that are missing, up to the next ones that are there.
    pub fn gap(&self) -> Option<Range<u64>> {
        self.gaps().next()
    }

    /// Every stretch of rows that are missing.
    pub fn gaps(&self) -> impl Iterator<Item = Range<u64>> + '_ {
        let Range { start, end } = self.identity.rows;
        let ends = std::iter::once(start).chain(self.chunks.values().copied());
        let starts = self.chunks.keys().copied().chain(std::iter::once(end));
        ends.zip(starts)
            .map(|(from, to)| from..to)
            .filter(|gap| !gap.is_empty())
    }

    /// Keeps rows, whole or not at all.
    ///
    /// # Errors
    /// [`StudyError::Failed`] if the disk is full, for instance.
    pub fn save(&mut self, range: Range<u64>, rows: &[Row]) -> Result<(), StudyError> {
        let bytes = encode(&self.identity, range.clone(), rows);
        let bytes = bytes.map_err(|error| StudyError::write(&self.directory, error))?;
        self.put(&chunk_name(&range), &bytes)?;
        self.chunks.insert(range.start, range.end);
        Ok(())
    }

    /// Keeps rows that [`chunk`] made, perhaps on another machine.
    ///
    /// # Errors
    /// [`StudyError::Input`] if they are not those rows of this study, computed by this version of the program;
    /// [`StudyError::Failed`] if they can not be written.
    pub fn keep(&mut self, range: Range<u64>, bytes: &[u8]) -> Result<(), StudyError> {
        let name = chunk_name(&range);
        self.put(&name, bytes)?;
        let path = self.directory.join(name);
        let found = identity_of(&path);
        if found.is_some_and(|found| found.goes_with(&self.identity) && found.rows == range) {
            self.chunks.insert(range.start, range.end);
            return Ok(());
        }
        let _ = fs::remove_file(&path);
        Err(StudyError::Input(format!(
            "rows {} to {} came from another study or another version of snapload; every machine needs version {}",
            range.start,
            range.end - 1,
            self.identity.version
        )))
    }

    /// Joins all rows into the file and puts it in its place.
    ///
    /// # Errors
    /// [`StudyError::Failed`] if the disk is full, for instance; the rows stay where they are.
    pub fn finish(self) -> Result<(), StudyError> {
        let chunks = self.chunks.iter();
        let chunks = chunks.map(|(start, end)| self.directory.join(chunk_name(&(*start..*end))));
        let scratch = self.directory.join(SCRATCH);
        let joined = join(&chunks.collect::<Vec<_>>(), &scratch, &self.identity).and_then(|()| {
            place(&scratch, &self.target).map_err(|error| StudyError::write(&self.target, error))
        });
        if joined.is_err() {
            // Half a file helps nobody, and takes room where there may be none.
            let _ = fs::remove_file(&scratch);
        } else {
            // The file is safe; what is left behind the next --resume takes away.
            let _ = fs::remove_dir_all(&self.directory);
        }
        joined
    }

    /// Writes a file of the directory.
    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
        let (scratch, path) = (self.directory.join(SCRATCH), self.directory.join(name));
        let write = || {
            let mut file = File::create(&scratch)?;
            file.write_all(bytes)?;
            file.sync_all()?;
            place(&scratch, &path)
        };
        write().map_err(|error| {
            let _ = fs::remove_file(&scratch);
            StudyError::write(&path, error)
        })
    }

    /// Takes up the chunks that are there and whole; what is not is done again.
    fn find_chunks(&mut self) -> Result<(), StudyError> {
        let entries = fs::read_dir(&self.directory);
        let entries = entries.map_err(|error| StudyError::read(&self.directory, error))?;
        let mut found: Vec<Range<u64>> = entries
            .filter_map(|entry| parse_chunk_name(entry.ok()?.file_name().to_str()?))
            .collect();
        found.sort_by_key(|range| range.start);
        let mut next = self.identity.rows.start;
        for range in found {
            let path = self.directory.join(chunk_name(&range));
            let fits = next <= range.start && range.end <= self.identity.rows.end;
            let ours =
                |identity: Identity| identity.goes_with(&self.identity) && identity.rows == range;
            if fits && identity_of(&path).is_some_and(ours) {
                next = range.end;
                self.chunks.insert(range.start, range.end);
            } else {
                fs::remove_file(&path).map_err(|error| StudyError::write(&path, error))?;
            }
        }
        Ok(())
    }
}

/// Some rows of a study, computed on the threads that there are, as a file that [`Store::keep`] takes. `done` is
/// called for each case.
///
/// # Errors
/// [`StudyError::Failed`] if the list of cases can not be read.
pub fn chunk(
    study: &Study,
    range: Range<u64>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<u8>, StudyError> {
    let rows = rows(&study.draw(range.clone())?, study.trust(), done);
    let bytes = encode(&Identity::new(study, None), range, &rows);
    bytes.map_err(|error| StudyError::Failed(error.to_string()))
}

fn encode(whole: &Identity, rows: Range<u64>, made: &[Row]) -> io::Result<Vec<u8>> {
    let identity = Identity {
        rows,
        ..whole.clone()
    };
    to_bytes(&identity, made)
}

/// A finished file where one is to be made.
fn finished(
    target: &Path,
    directory: &Path,
    identity: &Identity,
    resume: bool,
) -> Result<Opened, StudyError> {
    let shown = target.display();
    let ours = identity_of(target).is_some_and(|found| found == *identity);
    if ours && resume {
        let _ = fs::remove_dir_all(directory);
        return Ok(Opened::Complete);
    }
    Err(StudyError::Input(if ours {
        format!(
            "{shown} is there already and holds this very study, complete; --resume takes it as it is"
        )
    } else {
        format!(
            "{shown} is there already, and holds something else; choose another --out, or remove it"
        )
    }))
}

fn describe(identity: &Identity) -> String {
    let Identity {
        study,
        version,
        cases,
        rows,
    } = identity;
    format!(
        "# snapload {version}: rows {} to {} of {cases}\n{study}",
        rows.start, rows.end
    )
}

/// The folder in which a file is to be.
///
/// # Errors
/// [`StudyError::Input`] if there is none.
pub fn folder_of(file: &Path) -> Result<&Path, StudyError> {
    let parent = file
        .parent()
        .filter(|parent| !parent.as_os_str().is_empty());
    let folder = parent.unwrap_or(Path::new("."));
    if folder.is_dir() {
        return Ok(folder);
    }
    Err(StudyError::Input(format!(
        "can not write {}: there is no folder {}; make it first",
        file.display(),
        folder.display()
    )))
}

fn other_study(directory: &Path, known: &str, wanted: &str) -> StudyError {
    let only = |one: &str, other: &str| {
        let mut lines = one
            .lines()
            .filter(|line| !other.lines().any(|o| o == *line));
        lines.next().unwrap_or("(nothing of the kind)").to_owned()
    };
    let (there, here) = (only(known, wanted), only(wanted, known));
    let directory = directory.display();
    StudyError::Input(format!(
        "{directory} holds rows of another study\nthere: {there}\nhere:  {here}\nhint: choose another --out, \
         or remove {directory} to begin anew"
    ))
}

fn lock(directory: &Path) -> Result<File, StudyError> {
    let path = directory.join(LOCK);
    let file = OpenOptions::new().create(true).append(true).open(&path);
    let file = file.map_err(|error| StudyError::write(&path, error))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(StudyError::Input(format!(
            "another snapload is at work in {}; wait for it, or choose another --out",
            directory.display()
        ))),
        // Where the file system knows no locks, as some of clusters do not, there is nothing to hold.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

/// Renames a file that is on the disk, and brings the new name there, too.
fn place(scratch: &Path, path: &Path) -> io::Result<()> {
    fs::rename(scratch, path)?;
    #[cfg(unix)]
    {
        let parent = path
            .parent()
            .filter(|parent| !parent.as_os_str().is_empty());
        File::open(parent.unwrap_or(Path::new(".")))?.sync_all()?;
    }
    Ok(())
}

fn chunk_name(range: &Range<u64>) -> String {
    format!("rows-{:013}-{:013}.parquet", range.start, range.end)
}

fn parse_chunk_name(name: &str) -> Option<Range<u64>> {
    let name = name.strip_prefix("rows-")?.strip_suffix(".parquet")?;
    let (start, end) = name.split_once('-')?;
    let range = start.parse().ok()?..end.parse().ok()?;
    (chunk_name(&range) == format!("rows-{name}.parquet") && range.start < range.end)
        .then_some(range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Finished, Grid, Plan, Watch, sweep};

    fn study(count: u64) -> Study {
        let grid = Grid::new("0.1", "0.6", count).unwrap();
        let plan = Plan::grid(vec![Axis::even("f_o", grid).unwrap()]).unwrap();
        Study::new([("t_end".to_owned(), 0.1.into())], plan, false).unwrap()
    }

    fn open(target: &Path, study: &Study, resume: bool) -> Result<Opened, StudyError> {
        Store::open(target, Identity::new(study, None), resume)
    }

    fn work(target: &Path, study: &Study) -> Store {
        match open(target, study, true).unwrap() {
            Opened::Work(store) => store,
            Opened::Complete => panic!("complete"),
        }
    }

    /// Rows that were computed elsewhere make the same file; those of another study are refused.
    #[test]
    fn rows_come_from_elsewhere() {
        let (study, other) = (study(5), study(6));
        let directory = tempfile::tempdir().unwrap();
        let (here, there) = (directory.path().join("a"), directory.path().join("b"));
        let mut store = work(&here, &study);
        assert!(
            store
                .keep(0..2, &chunk(&other, 0..2, &|| ()).unwrap())
                .is_err()
        );
        for range in [3..5, 0..3] {
            store
                .keep(range.clone(), &chunk(&study, range, &|| ()).unwrap())
                .unwrap();
        }
        assert_eq!(store.gap(), None);
        store.finish().unwrap();
        let watch = Watch {
            done: &|| (),
            stop: &|| false,
        };
        sweep(&study, work(&there, &study), &watch).unwrap();
        assert_eq!(fs::read(here).unwrap(), fs::read(there).unwrap());
    }

    fn save(store: &mut Store, study: &Study, range: Range<u64>) {
        let drawn = study.draw(range.clone()).unwrap();
        store.save(range, &rows(&drawn, false, &|| ())).unwrap();
    }

    fn complete(target: &Path, study: &Study) -> Vec<u8> {
        let watch = Watch {
            done: &|| (),
            stop: &|| false,
        };
        let finished = sweep(study, work(target, study), &watch).unwrap();
        assert_eq!(finished, Finished::Complete);
        fs::read(target).unwrap()
    }

    /// However the rows were cut, and whatever a crash left behind.
    #[test]
    fn the_file_depends_on_the_rows_alone() {
        let directory = tempfile::tempdir().unwrap();
        let (study, whole) = (study(700), directory.path().join("whole"));
        let wanted = complete(&whole, &study);
        let target = directory.path().join("torn");
        let parts = directory.path().join("torn.parts");
        let mut store = work(&target, &study);
        for range in [0..1, 1..130, 200..201, 600..700] {
            save(&mut store, &study, range);
        }
        assert_eq!((store.gap(), store.safe()), (Some(130..200), 231));
        drop(store);
        // A chunk cut short, one that is none, one that overlaps another, and half a whole.
        let torn = parts.join(chunk_name(&(1..130)));
        let bytes = fs::read(&torn).unwrap();
        fs::write(&torn, &bytes[..bytes.len() / 2]).unwrap();
        fs::write(parts.join(chunk_name(&(300..400))), "nothing").unwrap();
        fs::copy(
            parts.join(chunk_name(&(0..1))),
            parts.join(chunk_name(&(0..2))),
        )
        .unwrap();
        fs::write(parts.join(SCRATCH), &wanted[..100]).unwrap();
        assert!(work(&target, &study).gap() == Some(1..200));
        assert!(complete(&target, &study) == wanted);
        assert!(!parts.exists());
    }

    #[test]
    fn only_one_is_at_work() {
        let directory = tempfile::tempdir().unwrap();
        let target = directory.path().join("file");
        let store = work(&target, &study(3));
        let error = open(&target, &study(3), true).unwrap_err().to_string();
        assert!(error.contains("another snapload is at work"), "{error}");
        drop(store);
        let error = open(&target, &study(4), true).unwrap_err().to_string();
        assert!(error.contains("there: # snapload"), "{error}");
        complete(&target, &study(3));
        assert!(matches!(
            open(&target, &study(3), true),
            Ok(Opened::Complete)
        ));
        assert!(open(&target, &study(3), false).is_err());
    }
}
