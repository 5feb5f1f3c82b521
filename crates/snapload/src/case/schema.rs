//! The keys of one sort of case, in tables. Everything else is made from these descriptions: the
//! reader of files and of `--set`, the texts of errors, `snapload keys`, the tables of the manual,
//! JSON and the types of Python.

use crate::case::error::CaseError;
use crate::case::key::{DefaultValue, Key};
use std::fmt::Write;

/// How the keys of a table are written in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// At its top, without any heading.
    None,
    /// Below the line `[name]`.
    One,
    /// Below such a line, if there is one.
    Optional,
    /// Below lines `[[name]]`, one for each thing of this kind.
    Many,
}

/// A table of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Its name.
    pub name: &'static str,
    /// How it stands in a file.
    pub heading: Heading,
    /// What it describes.
    pub meaning: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
    /// Quantities that may be mistaken for keys but follow from others: name, what is allowed
    /// instead, and advice.
    pub follows: &'static [(&'static str, &'static str, &'static str)],
    /// Whether values of its keys are not checked here but by the caller, because they may be lists
    /// or ranges.
    pub unchecked: bool,
}

impl Table {
    /// A table below a heading.
    pub const fn new(
        name: &'static str,
        heading: Heading,
        meaning: &'static str,
        keys: &'static [Key],
    ) -> Self {
        let (follows, unchecked): (&[_], _) = (&[], false);
        Self {
            name,
            heading,
            meaning,
            keys,
            follows,
            unchecked,
        }
    }

    /// The name of a key of the n-th table, from 0, in errors: `e`, `body.mass`, `line.2.length`.
    pub fn path(&self, index: usize, key: &str) -> String {
        match self.heading {
            Heading::None => key.to_owned(),
            Heading::One | Heading::Optional => format!("{}.{key}", self.name),
            Heading::Many => format!("{}.{}.{key}", self.name, index + 1),
        }
    }

    /// Its line in a file; empty where it has none.
    pub fn header(&self) -> String {
        match self.heading {
            Heading::None => String::new(),
            Heading::One | Heading::Optional => format!("[{}]", self.name),
            Heading::Many => format!("[[{}]]", self.name),
        }
    }

    /// The key of a name, or an error with the nearest one; `path` is the key's name in the error.
    pub fn key(&self, path: &str, name: &str) -> Result<&'static Key, CaseError> {
        if let Some(key) = self.keys.iter().find(|key| key.name == name) {
            return Ok(key);
        }
        if let Some((_, allowed, hint)) = self.follows.iter().find(|follows| follows.0 == name) {
            return Err(CaseError::value(path, "(given)", *allowed).with_hint(*hint));
        }
        let known: Vec<&str> = self.keys.iter().map(|key| key.name).collect();
        Err(CaseError::unknown_key(path, self.nearest(name), &known))
    }

    /// The key that was probably meant by a name.
    pub fn nearest(&self, name: &str) -> Option<&'static str> {
        let searched = name.to_lowercase();
        let by_symbol = |key: &&Key| !name.is_empty() && key.symbol.to_lowercase() == searched;
        match self.keys.iter().find(by_symbol) {
            Some(key) => Some(key.name),
            None => nearest(name, self.keys.iter().map(|key| key.name)),
        }
    }

    /// Its keys as a text for a terminal.
    fn listing(&self) -> String {
        let mut text = match self.heading {
            Heading::None => String::new(),
            _ => format!("{}  {}\n", self.header(), self.meaning),
        };
        for key in self.keys {
            let (name, meaning, allowed) = (key.name, key.meaning, key.allowed());
            let unit = key
                .own_unit()
                .map_or(String::new(), |unit| format!(" [{unit}]"));
            let default = match key.default {
                DefaultValue::Required => "required".to_owned(),
                _ => format!("default {}", key.default_words()),
            };
            // Writing to a string can not fail.
            let _ = writeln!(text, "{name:<18} {meaning}{unit}");
            let _ = writeln!(
                text,
                "{:<18}   {default}\n{:<18}   allowed {allowed}",
                "", ""
            );
        }
        text
    }

    /// Its keys as a table of the manual, in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("**`{}`**: {}\n\n", self.header(), self.meaning);
        text += "| key | unit | meaning | allowed | default |\n| --- | --- | --- | --- | --- |\n";
        for key in self.keys {
            let (allowed, default) = (key.allowed(), key.default_words());
            let Key {
                name,
                unit,
                meaning,
                ..
            } = key;
            let _ = writeln!(
                text,
                "| `{name}` | {unit} | {meaning} | {allowed} | {default} |"
            );
        }
        text
    }
}

/// The name that was probably meant; most errors are in upper and lower case and underscores.
fn nearest(name: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    // The length is limited, as the cost of the distance is quadratic in it.
    let plain = |text: &str| -> String {
        let letters = text.chars().take(40).filter(char::is_ascii);
        let letters = letters.filter(|c| !"_- ".contains(*c));
        letters.collect::<String>().to_lowercase()
    };
    let searched = plain(name);
    let mut best = (0.5, None);
    for known in known {
        let score = strsim::normalized_damerau_levenshtein(&searched, &plain(known));
        if score > best.0 || (score == best.0 && best.1.is_none()) {
            best = (score, Some(known));
        }
    }
    best.1.filter(|_| !searched.is_empty())
}

/// All keys of one sort of case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schema {
    /// Its tables, in the order in which they are listed.
    pub tables: &'static [Table],
    /// A key with a value in the notation of `--set`, such as `f_o=0.5`.
    pub example: &'static str,
    /// What a file has, in words.
    pub form: &'static str,
}

impl Schema {
    /// Its keys as a text for a terminal.
    pub fn listing(&self) -> String {
        let tables: Vec<String> = self.tables.iter().map(Table::listing).collect();
        tables.join("\n")
    }

    fn headed(&self) -> impl Iterator<Item = &'static Table> {
        let tables = self.tables.iter();
        tables.filter(|table| table.heading != Heading::None)
    }

    /// The table of a name that stands below a heading, or an error with the nearest one.
    pub(crate) fn table(&self, name: &str) -> Result<&'static Table, CaseError> {
        if let Some(table) = self.headed().find(|table| table.name == name) {
            return Ok(table);
        }
        let known: Vec<&'static str> = self.headed().map(|table| table.name).collect();
        let meant = nearest(name, known.iter().copied());
        Err(CaseError::unknown_key(name, meant, &known))
    }

    /// The tables below a heading that have a key of this name.
    pub(crate) fn with_key(&self, name: &str) -> Vec<&'static Table> {
        let has = |table: &&Table| table.keys.iter().any(|key| key.name == name);
        self.headed().filter(has).collect()
    }

    /// The table at the top of a file that has a key of this name; the first such table if none has
    /// it.
    pub(crate) fn top(&self, name: &str) -> Option<&'static Table> {
        let mut top = self
            .tables
            .iter()
            .filter(|table| table.heading == Heading::None);
        let first = top.clone().next();
        top.find(|table| table.keys.iter().any(|key| key.name == name))
            .or(first)
    }
}
