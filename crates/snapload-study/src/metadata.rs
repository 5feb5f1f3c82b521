//! The metadata of a file: which study, which program, which rows.

use crate::{Study, StudyError};
use parquet::file::metadata::KeyValue;
use std::fmt;
use std::ops::Range;

/// The study, as a study file.
const STUDY: &str = "snapload.study";
/// The version of the program.
const VERSION: &str = "snapload.version";
/// How many cases the study has.
const CASES: &str = "snapload.cases";
/// The first row and the one after the last; only if a file does not contain all rows.
const ROWS: &str = "snapload.rows";

/// The case of a table that is no study, as JSON.
const CASE: &str = "snapload.case";

/// Which part of how many; only if a file is a part.
const SHARD: &str = "snapload.shard";

/// Which rows of which study a file contains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The study, as by [`Study::describe`].
    pub study: String,
    /// The version of the program that computed it, as the last bits of another one may differ.
    pub version: String,
    /// How many cases the study has.
    pub cases: u64,
    /// The rows of this file.
    pub rows: Range<u64>,
    /// Which part they are, if they are one.
    pub shard: Option<Shard>,
}

/// The i-th of n parts of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    part: u64,
    of: u64,
}

impl Shard {
    /// Reads `i/n`, such as `1/4` for the first of four.
    ///
    /// # Errors
    /// [`StudyError::Input`] if the text has another form.
    pub fn parse(text: &str) -> Result<Self, StudyError> {
        let parts = text.split_once('/');
        let numbers =
            parts.and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        match numbers {
            Some((part, of)) if 1 <= part && part <= of && of <= 1_000_000 => Ok(Self { part, of }),
            _ => Err(StudyError::Input(format!(
                "{text:?} is not a part; write i/n with 1 <= i <= n <= 1000000, such as 1/4 for the first of four"
            ))),
        }
    }

    /// All parts of the same division, in order.
    pub(crate) fn all(self) -> impl Iterator<Item = Self> {
        (1..=self.of).map(move |part| Self { part, ..self })
    }

    /// Its rows, of a study with this number of cases.
    pub fn rows(self, cases: u64) -> Range<u64> {
        let bound = |i: u64| (u128::from(cases) * u128::from(i) / u128::from(self.of)) as u64;
        bound(self.part - 1)..bound(self.part)
    }
}

impl fmt::Display for Shard {
    /// In its notation, `i/n`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

impl Identity {
    /// Of a study, or of a part of it.
    pub fn new(study: &Study, shard: Option<Shard>) -> Self {
        let cases = study.count();
        Self {
            study: study.describe(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            cases,
            rows: shard.map_or(0..cases, |shard| shard.rows(cases)),
            shard,
        }
    }

    /// Whether both are of the same study and program.
    pub(crate) fn is_same_study_as(&self, other: &Self) -> bool {
        (&self.study, &self.version, self.cases) == (&other.study, &other.version, other.cases)
    }

    /// For the metadata of a file.
    pub(crate) fn to_metadata(&self) -> Vec<KeyValue> {
        let entry = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
        let mut entries = vec![
            entry(STUDY, self.study.clone()),
            entry(VERSION, self.version.clone()),
            entry(CASES, self.cases.to_string()),
        ];
        if self.rows != (0..self.cases) {
            let Range { start, end } = self.rows;
            entries.push(entry(ROWS, format!("{start}:{end}")));
        }
        entries.extend(self.shard.map(|shard| entry(SHARD, shard.to_string())));
        entries
    }

    /// From the metadata of a file; none if it is no file of a study.
    pub(crate) fn from_metadata(entries: &[KeyValue]) -> Option<Self> {
        let find = |key: &str| {
            let entry = entries.iter().find(|entry| entry.key == key)?;
            entry.value.clone()
        };
        let cases = find(CASES)?.parse().ok()?;
        let rows = match find(ROWS) {
            Some(text) => {
                let (start, end) = text.split_once(':')?;
                start.parse().ok()?..end.parse().ok()?
            }
            None => 0..cases,
        };
        Some(Self {
            study: find(STUDY)?,
            version: find(VERSION)?,
            cases,
            rows,
            shard: match find(SHARD) {
                Some(text) => Some(Shard::parse(&text).ok()?),
                None => None,
            },
        })
    }
}

/// The metadata of a table of results of a case, which is given as JSON.
pub(crate) fn of_table(case: String) -> Vec<KeyValue> {
    let version = env!("CARGO_PKG_VERSION").to_owned();
    vec![
        KeyValue::new(CASE.to_owned(), case),
        KeyValue::new(VERSION.to_owned(), version),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_the_whole() {
        for (cases, n) in [(10, 3), (7, 7), (3, 5), (1_000_000_000_000, 999)] {
            let mut next = 0;
            for i in 1..=n {
                let rows = Shard::parse(&format!("{i}/{n}"))
                    .expect("a shard")
                    .rows(cases);
                assert_eq!(rows.start, next);
                next = rows.end;
            }
            assert_eq!(next, cases);
        }
        for text in ["", "0/4", "5/4", "1", "a/b", "1/0", "-1/4"] {
            assert!(Shard::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn metadata_identifies_a_file() {
        let whole = Identity {
            study: "trust = true\n".to_owned(),
            version: "1".to_owned(),
            cases: 10,
            rows: 0..10,
            shard: None,
        };
        let part = Identity {
            rows: 3..6,
            shard: Shard::parse("2/3").ok(),
            ..whole.clone()
        };
        for identity in [whole, part] {
            let read = Identity::from_metadata(&identity.to_metadata());
            assert_eq!(read, Some(identity));
        }
        assert_eq!(Identity::from_metadata(&[]), None);
    }
}
