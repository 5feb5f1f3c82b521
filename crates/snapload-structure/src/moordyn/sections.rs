//! The sections of a MoorDyn file as rows of words.

use snapload::CaseError;

/// A section of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    LineTypes,
    RodTypes,
    Bodies,
    Rods,
    Points,
    Lines,
    Failure,
    Control,
    Loads,
    Options,
    Outputs,
    /// A section with an unknown header.
    Other,
}

/// What a row of each section describes, and words of its header, in capitals; a header belongs to
/// the first section of which it contains a word.
const SECTIONS: &[(Section, &str, &[&str])] = &[
    (
        Section::LineTypes,
        "line type",
        &["LINE TYPE", "LINE DICTIONARY"],
    ),
    (
        Section::RodTypes,
        "rod type",
        &["ROD TYPE", "ROD DICTIONARY"],
    ),
    (
        Section::Bodies,
        "body",
        &["BODIES", "BODY LIST", "BODY PROPERTIES"],
    ),
    (
        Section::Rods,
        "rod",
        &["RODS", "ROD LIST", "ROD PROPERTIES"],
    ),
    (
        Section::Points,
        "point",
        &[
            "POINTS",
            "POINT LIST",
            "POINT PROPERTIES",
            "CONNECTION",
            "NODE PROPERTIES",
        ],
    ),
    (Section::Failure, "failure", &["FAILURE"]),
    (Section::Control, "control channel", &["CONTROL"]),
    (Section::Loads, "external load", &["LOADS"]),
    (Section::Options, "option", &["OPTIONS"]),
    (Section::Outputs, "output", &["OUTPUT"]),
    (
        Section::Lines,
        "line",
        &["LINES", "LINE LIST", "LINE PROPERTIES"],
    ),
];

impl Section {
    fn of_header(header: &str) -> Option<Self> {
        let capitals = header.to_uppercase();
        let mut sections = SECTIONS.iter();
        let named = sections.find(|(_, _, words)| words.iter().any(|word| capitals.contains(word)));
        named.map(|(section, ..)| *section)
    }

    /// What one of its rows describes.
    fn noun(self) -> &'static str {
        let found = SECTIONS.iter().find(|(section, ..)| *section == self);
        found.map_or("row", |(_, noun, _)| noun)
    }

    /// Lines below the header that name columns and units; MoorDyn reads neither.
    fn preamble(self) -> usize {
        match self {
            Self::Options | Self::Outputs => 0,
            _ => 2,
        }
    }
}

/// A row of a table.
#[derive(Clone, Debug)]
pub(super) struct Row<'a> {
    /// `FILE, line N`.
    pub(super) origin: String,
    /// The name of the object in errors: `point 3`.
    pub(super) what: String,
    pub(super) words: Vec<&'a str>,
}

impl Row<'_> {
    /// The word in a column; `column` is its name in errors.
    pub(super) fn word(&self, index: usize, column: &str) -> Result<&str, CaseError> {
        self.words.get(index).copied().ok_or_else(|| {
            let allowed = format!(
                "a value in column {}; the row ends before it, and every column must have one",
                index + 1
            );
            self.refuse(column, "(missing)", &allowed, "")
        })
    }

    /// The number in a column.
    pub(super) fn number(&self, index: usize, column: &str) -> Result<f64, CaseError> {
        let word = self.word(index, column)?;
        number(word).ok_or_else(|| self.refuse(column, word, "a number", ""))
    }

    /// The numbers in a column, separated by bars.
    pub(super) fn numbers(&self, index: usize, column: &str) -> Result<Vec<f64>, CaseError> {
        let word = self.word(index, column)?;
        let numbers: Option<Vec<f64>> = word.split('|').map(number).collect();
        numbers.ok_or_else(|| self.refuse(column, word, "numbers, with | between them", ""))
    }

    /// The position in three consecutive columns.
    pub(super) fn place(&self, index: usize, columns: [&str; 3]) -> Result<[f64; 3], CaseError> {
        let [x, y, z] = columns;
        Ok([
            self.number(index, x)?,
            self.number(index + 1, y)?,
            self.number(index + 2, z)?,
        ])
    }

    /// Refuses nonzero numbers in a column.
    pub(super) fn zero(
        &self,
        index: usize,
        column: &str,
        allowed: &str,
        hint: &str,
    ) -> Result<(), CaseError> {
        match self
            .numbers(index, column)?
            .iter()
            .all(|number| *number == 0.0)
        {
            true => Ok(()),
            false => Err(self.refuse(column, self.words[index], allowed, hint)),
        }
    }

    /// An error about a column, with advice unless it is empty.
    pub(super) fn refuse(
        &self,
        column: &str,
        shown: impl std::fmt::Display,
        allowed: &str,
        hint: &str,
    ) -> CaseError {
        let error = CaseError::value(&format!("{}, {column}", self.what), shown, allowed);
        self.fault(match hint {
            "" => error,
            hint => error.with_hint(hint),
        })
    }

    pub(super) fn fault(&self, error: CaseError) -> CaseError {
        error.at(self.origin.as_str())
    }
}

/// A finite number.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A file, divided into its sections.
#[derive(Debug, Default)]
pub(super) struct Sections<'a> {
    /// Lines before the first section, with their origins.
    pub(super) front: Vec<(String, &'a str)>,
    rows: Vec<(Section, Row<'a>)>,
    found: Vec<Section>,
}

impl<'a> Sections<'a> {
    /// Divides a file into sections; `name` is its name in errors.
    pub(super) fn parse(name: &str, text: &'a str) -> Result<Self, CaseError> {
        let mut sections = Self::default();
        let mut now: Option<(Section, usize)> = None;
        for (index, line) in text.lines().enumerate() {
            let origin = format!("{name}, line {}", index + 1);
            if line.contains("---") {
                match Section::of_header(line) {
                    Some(section) => {
                        sections.found.push(section);
                        now = Some((section, section.preamble()));
                    }
                    None => now = now.map(|_| (Section::Other, 0)),
                }
                continue;
            }
            let Some((section, preamble)) = &mut now else {
                sections.front.push((origin, line));
                continue;
            };
            if line.trim().is_empty() {
                continue;
            }
            if *preamble > 0 {
                *preamble -= 1;
                refuse_first_lines(&origin, line)?;
                continue;
            }
            let line = line.split(['!', '#', '%']).next().unwrap_or_default();
            let words: Vec<&str> = line.split_whitespace().collect();
            if let Some(first) = words.first() {
                let what = format!("{} {first}", section.noun());
                let row = Row {
                    origin,
                    what,
                    words,
                };
                refuse_first_version(*section, &row)?;
                sections.rows.push((*section, row));
            }
        }
        Ok(sections)
    }

    /// The rows of a section.
    pub(super) fn rows(&self, section: Section) -> impl Iterator<Item = &Row<'a>> {
        let rows = self.rows.iter().filter(move |(of, _)| *of == section);
        rows.map(|(_, row)| row)
    }

    pub(super) fn has(&self, section: Section) -> bool {
        self.found.contains(&section)
    }
}

/// The number of columns of a type of version 1; one of version 2 has ten or more.
const COLUMNS_OF_FIRST_VERSION: usize = 9;

/// Refuses a type of version 1, whose columns have another meaning. Their names in the header do
/// not tell the versions apart: MoorDyn does not read them, and files of version 2 keep old ones.
fn refuse_first_version(section: Section, row: &Row<'_>) -> Result<(), CaseError> {
    if section != Section::LineTypes || row.words.len() != COLUMNS_OF_FIRST_VERSION {
        return Ok(());
    }
    let allowed = "ten or more, as in MoorDyn version 2; a file of version 1 has nine";
    let shown = COLUMNS_OF_FIRST_VERSION;
    Err(row.refuse("number of columns", shown, allowed, SECOND_VERSION))
}

/// Refuses the names that only the columns of lines of version 1 have, which are in another order.
fn refuse_first_lines(origin: &str, line: &str) -> Result<(), CaseError> {
    let old = ["NodeAnch", "NodeFair"];
    let is_old = |word: &&str| old.iter().any(|old| word.eq_ignore_ascii_case(old));
    let Some(word) = line.split_whitespace().find(is_old) else {
        return Ok(());
    };
    let allowed = "the columns of MoorDyn version 2; this is a file of version 1";
    let error = CaseError::value("column", word, allowed);
    Err(error.with_hint(SECOND_VERSION).at(origin))
}

const SECOND_VERSION: &str = "write LINE TYPES, POINTS and LINES as in the manual of MoorDyn v2, \
                              with the columns ID LineType AttachA AttachB UnstrLen NumSegs for a \
                              line";
