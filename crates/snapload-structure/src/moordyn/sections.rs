//! The sections of a MoorDyn file as rows of words.

use crate::InputError;
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
    /// One whose header is not known.
    Other,
}

/// Words of a header, in capitals, that tell which section it begins; the first that fits counts.
const HEADERS: &[(&str, Section)] = &[
    ("LINE TYPE", Section::LineTypes),
    ("LINE DICTIONARY", Section::LineTypes),
    ("ROD TYPE", Section::RodTypes),
    ("ROD DICTIONARY", Section::RodTypes),
    ("BODIES", Section::Bodies),
    ("BODY LIST", Section::Bodies),
    ("BODY PROPERTIES", Section::Bodies),
    ("RODS", Section::Rods),
    ("ROD LIST", Section::Rods),
    ("ROD PROPERTIES", Section::Rods),
    ("POINTS", Section::Points),
    ("POINT LIST", Section::Points),
    ("POINT PROPERTIES", Section::Points),
    ("CONNECTION", Section::Points),
    ("NODE PROPERTIES", Section::Points),
    ("FAILURE", Section::Failure),
    ("CONTROL", Section::Control),
    ("LOADS", Section::Loads),
    ("OPTIONS", Section::Options),
    ("OUTPUT", Section::Outputs),
    ("LINES", Section::Lines),
    ("LINE LIST", Section::Lines),
    ("LINE PROPERTIES", Section::Lines),
];

impl Section {
    fn of_header(header: &str) -> Option<Self> {
        let capitals = header.to_uppercase();
        let found = HEADERS.iter().find(|(words, _)| capitals.contains(words));
        found.map(|(_, section)| *section)
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
    /// What errors call the thing it describes: `point 3`.
    pub(super) what: String,
    pub(super) words: Vec<&'a str>,
}

impl Row<'_> {
    /// The word of a column; `column` is what errors call it.
    pub(super) fn word(&self, index: usize, column: &str) -> Result<&str, InputError> {
        self.words.get(index).copied().ok_or_else(|| {
            let allowed = format!(
                "a value in column {}; the row ends before it, and every column must have one",
                index + 1
            );
            self.refuse(column, "(missing)", &allowed)
        })
    }

    /// The number of a column.
    pub(super) fn number(&self, index: usize, column: &str) -> Result<f64, InputError> {
        let word = self.word(index, column)?;
        number(word).ok_or_else(|| self.refuse(column, word, "a number"))
    }

    /// The numbers of a column, which bars separate.
    pub(super) fn numbers(&self, index: usize, column: &str) -> Result<Vec<f64>, InputError> {
        let word = self.word(index, column)?;
        let numbers: Option<Vec<f64>> = word.split('|').map(number).collect();
        numbers.ok_or_else(|| self.refuse(column, word, "numbers, with | between them"))
    }

    pub(super) fn refuse(&self, column: &str, shown: &str, allowed: &str) -> InputError {
        let key = format!("{}, {column}", self.what);
        self.fault(CaseError::value(&key, shown, allowed))
    }

    pub(super) fn refuse_with(
        &self,
        column: &str,
        shown: &str,
        allowed: &str,
        hint: &str,
    ) -> InputError {
        let key = format!("{}, {column}", self.what);
        self.fault(CaseError::value(&key, shown, allowed).with_hint(hint))
    }

    pub(super) fn fault(&self, error: CaseError) -> InputError {
        InputError {
            origin: self.origin.clone(),
            error: Box::new(error),
        }
    }
}

/// A finite number.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A file, cut into its sections.
#[derive(Debug, Default)]
pub(super) struct Sections<'a> {
    /// Lines before the first section, with their origins.
    pub(super) front: Vec<(String, &'a str)>,
    rows: Vec<(Section, Row<'a>)>,
    found: Vec<(Section, String)>,
}

impl<'a> Sections<'a> {
    /// Cuts a file; `name` is what errors call it.
    pub(super) fn parse(name: &str, text: &'a str) -> Result<Self, InputError> {
        let mut sections = Self::default();
        let mut now: Option<(Section, usize)> = None;
        for (index, line) in text.lines().enumerate() {
            let origin = format!("{name}, line {}", index + 1);
            if line.contains("---") {
                match (Section::of_header(line), &now) {
                    (Some(section), _) => {
                        sections.found.push((section, origin));
                        now = Some((section, section.preamble()));
                    }
                    (None, Some(_)) => now = Some((Section::Other, 0)),
                    (None, None) => {}
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
                first_version(&origin, line)?;
                continue;
            }
            let line = line.split(['!', '#', '%']).next().unwrap_or_default();
            let words: Vec<&str> = line.split_whitespace().collect();
            if let Some(first) = words.first() {
                let what = format!("{} {first}", section.noun());
                sections.rows.push((
                    *section,
                    Row {
                        origin,
                        what,
                        words,
                    },
                ));
            }
        }
        Ok(sections)
    }

    /// The rows of a section.
    pub(super) fn rows(&self, section: Section) -> impl Iterator<Item = &Row<'a>> {
        self.rows
            .iter()
            .filter(move |(of, _)| *of == section)
            .map(|(_, row)| row)
    }

    pub(super) fn has(&self, section: Section) -> bool {
        self.found.iter().any(|(found, _)| *found == section)
    }
}

impl Section {
    /// What one row of it describes.
    fn noun(self) -> &'static str {
        match self {
            Self::LineTypes => "line type",
            Self::RodTypes => "rod type",
            Self::Bodies => "body",
            Self::Rods => "rod",
            Self::Points => "point",
            Self::Lines => "line",
            Self::Failure => "failure",
            Self::Control => "control channel",
            Self::Loads => "external load",
            Self::Options => "option",
            Self::Outputs => "output",
            Self::Other => "row",
        }
    }
}

/// The columns of version 1 stand in another order; its names give it away.
fn first_version(origin: &str, line: &str) -> Result<(), InputError> {
    let old = ["NodeAnch", "NodeFair", "MassDenInAir", "MassDen"];
    let Some(word) = line
        .split_whitespace()
        .find(|word| old.iter().any(|old| word.eq_ignore_ascii_case(old)))
    else {
        return Ok(());
    };
    let allowed = "the columns of MoorDyn version 2; this is a file of version 1";
    Err(InputError {
        origin: origin.to_owned(),
        error: Box::new(
            CaseError::value("column", word, allowed)
                .with_hint("write LINE TYPES, POINTS and LINES as the manual of MoorDyn v2 has them, ID LineType AttachA AttachB UnstrLen NumSegs for a line"),
        ),
    })
}
