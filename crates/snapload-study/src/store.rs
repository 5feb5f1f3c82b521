//! Keeps the rows of a study until all are complete.
//!
//! Beside the final file there is the directory `FILE.parts`. Each chunk of rows is written there
//! under a temporary name, synced to the disk, and renamed: so it is either complete or absent.
//! When nothing is missing the chunks are joined, the file is synced and renamed to its final name,
//! and the directory is deleted. Whenever the power fails, renamed chunks are still there, and the
//! others are computed again. A chunk whose contents on the disk have changed does not count: its
//! rows are missing.

use crate::checksum::{damage, damage_of};
use crate::study_file::{identity_of, join, to_bytes};
use crate::{Identity, Occupied, Row, Study, StudyError, rows};
use snapload::analysis::{Counter, OnProgress, ThreadResults};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Cursor, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The description of the study to which the chunks belong.
const STUDY: &str = "study.toml";
/// Locked by the program that is working there.
const LOCK: &str = "lock";
/// The temporary name of files that are not complete.
const SCRATCH: &str = "scratch";

/// The rows of a study that is not complete yet.
#[derive(Debug)]
pub struct Store {
    target: PathBuf,
    directory: PathBuf,
    identity: Identity,
    /// The complete chunks: first row, and the one after the last.
    chunks: BTreeMap<u64, u64>,
    /// The number of rows that were damaged when it was opened.
    damaged: u64,
    _lock: File,
}

/// The state of the final file.
#[derive(Debug)]
pub enum Opened {
    /// The file exists and is complete.
    Complete,
    /// There are rows to compute.
    Work(Store),
}

impl Store {
    /// Opens the place of a file. Rows of an earlier run are used only if `resume` is set.
    ///
    /// # Errors
    /// [`StudyError::Occupied`] if something else is there, if another study was begun there, if
    /// this one was begun and is not to be resumed, or if another program is working there;
    /// [`StudyError::Input`] if there is no such folder, or the name is not that of a Parquet file.
    pub fn open(target: &Path, identity: Identity, resume: bool) -> Result<Opened, StudyError> {
        check_name(target)?;
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
            damaged: 0,
            identity,
            directory,
            _lock: lock,
        };
        if known.is_none() {
            store.write_file(STUDY, text.as_bytes())?;
        }
        store.find_chunks()?;
        if store.saved() > 0 && !resume {
            return Err(StudyError::Occupied(Occupied::Partial {
                directory: store.directory.clone(),
                saved: store.saved(),
                total: store.total(),
            }));
        }
        Ok(Opened::Work(store))
    }

    /// The number of rows that are saved.
    pub fn saved(&self) -> u64 {
        self.chunks.iter().map(|(start, end)| end - start).sum()
    }

    /// The number of rows that were found damaged, and are missing again.
    pub fn damaged(&self) -> u64 {
        self.damaged
    }

    /// The rows of the final file.
    pub fn rows(&self) -> Range<u64> {
        self.identity.rows.clone()
    }

    /// The number of rows of the final file.
    pub fn total(&self) -> u64 {
        self.identity.rows.end - self.identity.rows.start
    }

    /// The first missing rows, up to the next ones that exist.
    pub fn gap(&self) -> Option<Range<u64>> {
        self.gaps().next()
    }

    /// Every range of missing rows.
    pub fn gaps(&self) -> impl Iterator<Item = Range<u64>> + '_ {
        let Range { start, end } = self.identity.rows;
        let ends = std::iter::once(start).chain(self.chunks.values().copied());
        let starts = self.chunks.keys().copied().chain(std::iter::once(end));
        ends.zip(starts)
            .map(|(from, to)| from..to)
            .filter(|gap| !gap.is_empty())
    }

    /// Saves rows, either completely or not at all.
    ///
    /// # Errors
    /// [`StudyError::Failed`], for example if the disk is full.
    pub fn save(&mut self, range: Range<u64>, rows: &ThreadResults<Row>) -> Result<(), StudyError> {
        let bytes = encode(&self.identity, range.clone(), rows);
        let bytes = bytes.map_err(|error| StudyError::write(&self.directory, error))?;
        self.write_file(&chunk_name(&range), &bytes)?;
        self.chunks.insert(range.start, range.end);
        Ok(())
    }

    /// Saves rows that [`chunk`] made, perhaps on another machine.
    ///
    /// # Errors
    /// [`StudyError::Input`] if they are not these rows of this study, computed by this version of
    /// the program; [`StudyError::Failed`] if they can not be written.
    pub fn save_chunk(&mut self, range: Range<u64>, bytes: &[u8]) -> Result<(), StudyError> {
        let name = chunk_name(&range);
        if let Ok(Some(why)) = damage_of(Cursor::new(bytes)) {
            return Err(StudyError::Input(format!(
                "rows {} to {} can not be used: {why}; compute them again",
                range.start,
                range.end - 1
            )));
        }
        self.write_file(&name, bytes)?;
        let path = self.directory.join(name);
        let found = identity_of(&path);
        if found.is_some_and(|found| found.is_same_study_as(&self.identity) && found.rows == range)
        {
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

    /// Joins all rows into the final file.
    ///
    /// # Errors
    /// [`StudyError::Failed`], for example if the disk is full; the rows are kept.
    /// [`StudyError::Damaged`] if the contents of some on the disk have changed: those are missing
    /// now, and all others are kept.
    pub fn finish(&mut self) -> Result<(), StudyError> {
        let scratch = self.directory.join(SCRATCH);
        let joined = self.join_to(&scratch).and_then(|()| {
            place(&scratch, &self.target).map_err(|error| StudyError::write(&self.target, error))
        });
        if joined.is_err() {
            // An incomplete file is useless, and takes space that may be needed.
            let _ = fs::remove_file(&scratch);
        } else {
            // The final file is safe; whatever remains is deleted by the next --resume.
            let _ = fs::remove_dir_all(&self.directory);
        }
        joined
    }

    fn join_to(&mut self, scratch: &Path) -> Result<(), StudyError> {
        let path = |(start, end): (&u64, &u64)| self.directory.join(chunk_name(&(*start..*end)));
        let paths: Vec<PathBuf> = self.chunks.iter().map(path).collect();
        let damaged_part = |path: &PathBuf| damage(path).map(|why| StudyError::damaged(path, why));
        let mut wrong: Vec<StudyError> = paths.iter().filter_map(damaged_part).collect();
        if wrong.is_empty() {
            wrong.extend(join(&paths, scratch, &self.identity).err());
        }
        for error in &wrong {
            if let StudyError::Damaged { file, .. } = error {
                self.remove_chunk(file)?;
            }
        }
        wrong.into_iter().next().map_or(Ok(()), Err)
    }

    /// Removes a chunk whose contents have changed.
    fn remove_chunk(&mut self, path: &Path) -> Result<(), StudyError> {
        let name = path.file_name().and_then(OsStr::to_str);
        if let Some(range) = name.and_then(parse_chunk_name) {
            self.chunks.remove(&range.start);
        }
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(StudyError::write(path, error))
            }
            _ => Ok(()),
        }
    }

    /// Writes a file of the directory.
    fn write_file(&self, name: &str, bytes: &[u8]) -> Result<(), StudyError> {
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

    /// Finds the complete chunks; others are computed again.
    fn find_chunks(&mut self) -> Result<(), StudyError> {
        let entries = fs::read_dir(&self.directory);
        let entries = entries.map_err(|error| StudyError::read(self.directory.display(), error))?;
        let mut found: Vec<Range<u64>> = entries
            .filter_map(|entry| parse_chunk_name(entry.ok()?.file_name().to_str()?))
            .collect();
        found.sort_by_key(|range| range.start);
        let mut next = self.identity.rows.start;
        for range in found {
            let path = self.directory.join(chunk_name(&range));
            let fits = next <= range.start && range.end <= self.identity.rows.end;
            let ours = |identity: Identity| {
                identity.is_same_study_as(&self.identity) && identity.rows == range
            };
            let intact = damage(&path).is_none();
            if fits && intact && identity_of(&path).is_some_and(ours) {
                next = range.end;
                self.chunks.insert(range.start, range.end);
            } else {
                if !intact {
                    self.damaged += range.end - range.start;
                }
                fs::remove_file(&path).map_err(|error| StudyError::write(&path, error))?;
            }
        }
        Ok(())
    }
}

/// Some rows of a study, computed on all threads, as a file for [`Store::save_chunk`].
///
/// # Errors
/// [`StudyError::Failed`] if the list of cases can not be read, and [`StudyError::Cancelled`].
pub fn chunk(
    study: &Study,
    range: Range<u64>,
    on_progress: OnProgress,
) -> Result<Vec<u8>, StudyError> {
    let counter = Counter::new("running", 0, range.end - range.start, on_progress);
    let rows = rows(&study.cases(range.clone())?, &counter, &|| false)?;
    let bytes = encode(&Identity::new(study, None), range, &rows);
    bytes.map_err(|error| StudyError::Failed(error.to_string()))
}

fn encode(whole: &Identity, rows: Range<u64>, made: &ThreadResults<Row>) -> io::Result<Vec<u8>> {
    let identity = Identity {
        rows,
        shard: None,
        ..whole.clone()
    };
    let made: Vec<&Row> = made.iter().collect();
    to_bytes(&identity, &made)
}

/// Handles a file that already exists in the final place.
fn finished(
    target: &Path,
    directory: &Path,
    identity: &Identity,
    resume: bool,
) -> Result<Opened, StudyError> {
    let ours = identity_of(target).is_some_and(|found| found == *identity);
    if ours && damage(target).is_some() {
        return Err(StudyError::Occupied(Occupied::Damaged(target.to_owned())));
    }
    if ours && resume {
        let _ = fs::remove_dir_all(directory);
        return Ok(Opened::Complete);
    }
    let there = if ours {
        Occupied::Complete
    } else {
        Occupied::OtherFile
    };
    Err(StudyError::Occupied(there(target.to_owned())))
}

fn describe(identity: &Identity) -> String {
    let Identity {
        study,
        version,
        cases,
        rows,
        ..
    } = identity;
    format!(
        "# snapload {version}: rows {} to {} of {cases}\n{study}",
        rows.start, rows.end
    )
}

/// Checks that the name of a file of rows ends in `.parquet` or has no ending, and is not `-`, which
/// elsewhere is the standard output.
///
/// # Errors
/// [`StudyError::Input`] if it has another ending.
pub fn check_name(file: &Path) -> Result<(), StudyError> {
    match file.extension() {
        Some(ending) if !ending.eq_ignore_ascii_case("parquet") => Err(StudyError::Input(format!(
            "can not write {}: rows are written as Parquet; choose a name that ends in .parquet\nhint: the commands \
             snapload sweep and snapload merge write CSV beside it, if --out ends in .csv",
            file.display()
        ))),
        None if is_ending(file) => Err(StudyError::Input(format!(
            "can not write {}: this is an ending without a name before it",
            file.display()
        ))),
        None if file.as_os_str() == "-" => Err(StudyError::Input(
            "can not write rows to the standard output, as they are kept in a file until all are there; choose a \
             name that ends in .parquet"
                .to_owned(),
        )),
        _ => Ok(()),
    }
}

/// Whether the name of a file is nothing but an ending of a study's files.
fn is_ending(file: &Path) -> bool {
    let name = file.file_name().unwrap_or_default();
    [".csv", ".parquet"]
        .iter()
        .any(|ending| name.eq_ignore_ascii_case(ending))
}

/// The folder in a file's path, whether it exists or not: `.` if there is none.
pub fn parent_of(file: &Path) -> &Path {
    let parent = file.parent();
    let named = parent.filter(|parent| !parent.as_os_str().is_empty());
    named.unwrap_or(Path::new("."))
}

/// The existing folder for a file.
///
/// # Errors
/// [`StudyError::Input`] if there is none.
pub fn folder_of(file: &Path) -> Result<&Path, StudyError> {
    let folder = parent_of(file);
    if folder.is_dir() {
        return Ok(folder);
    }
    Err(StudyError::Input(format!(
        "can not write {}: there is no folder {}; make it first",
        file.display(),
        folder.display()
    )))
}

fn other_study(directory: &Path, known: &str, expected: &str) -> StudyError {
    let only = |one: &str, other: &str| {
        let mut lines = one
            .lines()
            .filter(|line| !other.lines().any(|o| o == *line));
        lines.next().unwrap_or("(no such line)").to_owned()
    };
    StudyError::Occupied(Occupied::OtherStudy {
        directory: directory.to_owned(),
        there: only(known, expected),
        here: only(expected, known),
    })
}

fn lock(directory: &Path) -> Result<File, StudyError> {
    let path = directory.join(LOCK);
    let file = OpenOptions::new().create(true).append(true).open(&path);
    let file = file.map_err(|error| StudyError::write(&path, error))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            let there = Occupied::InUse(directory.to_owned());
            Err(StudyError::Occupied(there))
        }
        // If the file system does not support locks, as some of clusters do not, none is taken.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

/// Renames a file that is synced to the disk, and syncs the new name, too.
fn place(scratch: &Path, path: &Path) -> io::Result<()> {
    fs::rename(scratch, path)?;
    #[cfg(unix)]
    {
        File::open(parent_of(path))?.sync_all()?;
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
