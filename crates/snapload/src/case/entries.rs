//! The keys that a case gives, with the places where they stand.

use crate::case::error::CaseError;
use crate::case::key::{DefaultValue, Key};
use crate::case::schema::{Heading, Schema, Table};
use crate::case::value::Value;

#[derive(Clone, Debug)]
struct Entry {
    table: &'static str,
    index: usize,
    key: &'static Key,
    value: Value,
    /// The name of the key in errors.
    path: String,
    /// Where its value was given.
    place: String,
    /// A number in the digits in which it was given, which may be more than a double has.
    written: Option<String>,
}

/// The keys that a case gives: each is known, has the right type and range, and occurs once.
#[derive(Clone, Debug)]
pub struct Entries {
    pub(crate) schema: &'static Schema,
    entries: Vec<Entry>,
    /// How many tables of each name there are.
    counts: Vec<usize>,
}

impl Entries {
    /// None yet.
    pub fn new(schema: &'static Schema) -> Self {
        let (entries, counts) = (Vec::new(), vec![0; schema.tables.len()]);
        Self {
            schema,
            entries,
            counts,
        }
    }

    /// Sets a key of the n-th table of a name, from 0, to a value, which replaces an earlier one;
    /// `place` says where the value was given.
    ///
    /// # Errors
    /// A [`CaseError`] if there is no such key, or it can not take the value.
    ///
    /// # Panics
    /// If the schema has no such table.
    pub fn give(
        &mut self,
        table: &'static str,
        index: usize,
        key: &str,
        value: Value,
        place: &str,
    ) -> Result<(), CaseError> {
        let described = self.described(table);
        let path = described.path(index, key);
        let key = described.key(&path, key);
        let key = key.map_err(|error| error.given(&value).at(place))?;
        if !described.unchecked {
            key.check(&path, &value).map_err(|error| error.at(place))?;
        }
        let place = place.to_owned();
        self.have(table, index + 1);
        self.entries
            .retain(|entry| entry.path != path || entry.table != table);
        self.entries.push(Entry {
            table,
            index,
            key,
            value,
            path,
            place,
            written: None,
        });
        Ok(())
    }

    /// Keeps the digits of the number that was given last.
    #[cfg(feature = "toml")]
    pub(crate) fn keep_written(&mut self, written: Option<String>) {
        if let Some(entry) = self.entries.last_mut() {
            entry.written = written;
        }
    }

    /// The digits of a key's number, if it was given as text; `path` is the key's name in errors.
    pub fn written(&self, path: &str) -> Option<&str> {
        let entry = self.entries.iter().find(|entry| entry.path == path);
        entry.and_then(|entry| entry.written.as_deref())
    }

    /// Makes sure that there are at least this many tables of a name.
    fn have(&mut self, table: &str, least: usize) {
        let tables = self.schema.tables.iter().zip(&mut self.counts);
        for (_, count) in tables.filter(|(described, _)| described.name == table) {
            *count = least.max(*count);
        }
    }

    /// Adds a table of a name; returns its index.
    pub fn add(&mut self, table: &str) -> usize {
        let index = self.count(table);
        self.have(table, index + 1);
        index
    }

    /// Removes all tables of a name, with their keys.
    pub fn remove(&mut self, table: &str) {
        self.entries.retain(|entry| entry.table != table);
        let tables = self.schema.tables.iter().zip(&mut self.counts);
        for (_, count) in tables.filter(|(described, _)| described.name == table) {
            *count = 0;
        }
    }

    /// How many tables of a name there are.
    pub fn count(&self, table: &str) -> usize {
        let mut tables = self.schema.tables.iter().zip(&self.counts);
        let found = tables.find(|(described, _)| described.name == table);
        found.map_or(0, |(_, count)| *count)
    }

    /// The n-th table of a name, from 0, to be read key by key.
    ///
    /// # Panics
    /// If the schema has no such table.
    pub fn table(&self, name: &str, index: usize) -> Fields<'_> {
        Fields {
            entries: self,
            table: self.described(name),
            index,
        }
    }

    fn described(&self, table: &str) -> &'static Table {
        let mut tables = self.schema.tables.iter();
        let found = tables.find(|described| described.name == table);
        found.expect("the program asks for tables of its own schema")
    }

    /// The keys of a table that are given, with their values, in the order in which they were
    /// given.
    pub fn values(&self, table: &str) -> impl Iterator<Item = (&'static str, Value)> {
        let of_table = self
            .entries
            .iter()
            .filter(move |entry| entry.table == table);
        of_table.map(|entry| (entry.key.name, entry.value.clone()))
    }

    /// Where the value of a key was given; `path` is the key's name in errors.
    pub fn place(&self, path: &str) -> Option<&str> {
        let entry = self.entries.iter().find(|entry| entry.path == path);
        entry.map(|entry| entry.place.as_str())
    }

    /// Adds to an error the place of the key that it names.
    #[must_use]
    pub fn locate(&self, error: CaseError) -> CaseError {
        match self.place(&error.key) {
            Some(place) if error.place.is_none() => error.at(place),
            _ => error,
        }
    }

    /// Each table that is given, and with `least` = 1 also each that is required.
    fn tables(&self, least: usize) -> impl Iterator<Item = Fields<'_>> {
        self.schema.tables.iter().flat_map(move |table| {
            let needed = matches!(table.heading, Heading::None | Heading::One);
            let count = self.count(table.name).max(if needed { least } else { 0 });
            (0..count).map(|index| self.table(table.name, index))
        })
    }

    /// Required keys that are not given, such as `body.width`.
    pub fn missing(&self) -> Vec<String> {
        let missing = self.tables(1).flat_map(|fields| {
            let keys = fields.table.keys.iter();
            let required = keys.filter(|key| key.default == DefaultValue::Required);
            let missing = required.filter(move |key| fields.given(key.name).is_none());
            missing.map(move |key| fields.path(key.name))
        });
        missing.collect()
    }

    /// A case file with these keys, in the order of the schema.
    pub fn to_toml(&self) -> String {
        let tables = self.tables(0).map(|fields| {
            let keys = fields.table.keys.iter();
            let given = keys.filter_map(|key| Some((key.name, fields.given(key.name)?)));
            let lines = given.map(|(key, value)| match value {
                // Large whole numbers with all their digits, as newtons are usually written.
                Value::Number(n) if n.fract() == 0.0 && n.abs() < 1e15 => {
                    format!("{key} = {}\n", *n as i64)
                }
                value => format!("{key} = {value}\n"),
            });
            format!("{}\n{}", fields.table.header(), lines.collect::<String>())
        });
        tables.collect::<Vec<_>>().join("\n")
    }
}

/// One table of [`Entries`], read key by key.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a> {
    entries: &'a Entries,
    table: &'static Table,
    index: usize,
}

impl<'a> Fields<'a> {
    /// The name of a key in errors: `body.mass`, `line.2.length`.
    pub fn path(&self, key: &str) -> String {
        self.table.path(self.index, key)
    }

    /// The error of a value of one of its keys.
    pub fn refuse(
        &self,
        key: &str,
        shown: impl std::fmt::Display,
        allowed: impl Into<String>,
    ) -> CaseError {
        CaseError::value(&self.path(key), shown, allowed)
    }

    /// The value that is given for a key.
    pub fn given(&self, key: &str) -> Option<&'a Value> {
        let mut entries = self.entries.entries.iter();
        let place = (self.table.name, self.index, key);
        let found = entries.find(|entry| (entry.table, entry.index, entry.key.name) == place);
        found.map(|entry| &entry.value)
    }

    /// The value of a key: the given one, or its default; none if there is neither.
    ///
    /// # Errors
    /// A [`CaseError`] if a required key is left out.
    pub fn get<T: FromValue>(&self, key: &str) -> Result<Option<T>, CaseError> {
        if let Some(value) = self.given(key) {
            return Ok(T::from_value(value));
        }
        let path = self.path(key);
        let described = self.table.key(&path, key)?;
        if described.default == DefaultValue::Required {
            let hint = format!("{key}: {}", described.meaning);
            return Err(described.refuse(&path, "(left out)").with_hint(hint));
        }
        Ok(described.default.value().as_ref().and_then(T::from_value))
    }

    /// The same for a key that is required or has a plain default.
    ///
    /// # Errors
    /// A [`CaseError`] if it is left out.
    pub fn need<T: FromValue>(&self, key: &str) -> Result<T, CaseError> {
        let value = self.get(key)?;
        value.ok_or_else(|| self.refuse(key, "(left out)", "a value"))
    }
}

/// A type as which the value of a key can be read.
pub trait FromValue: Sized {
    /// None if the value is of another type.
    fn from_value(value: &Value) -> Option<Self>;
}

impl FromValue for f64 {
    fn from_value(value: &Value) -> Option<Self> {
        value.number()
    }
}

impl FromValue for u64 {
    fn from_value(value: &Value) -> Option<Self> {
        value.count()
    }
}

impl FromValue for [f64; 2] {
    fn from_value(value: &Value) -> Option<Self> {
        value.pair()
    }
}

impl FromValue for [f64; 3] {
    fn from_value(value: &Value) -> Option<Self> {
        value.triple()
    }
}

impl FromValue for bool {
    fn from_value(value: &Value) -> Option<Self> {
        match value {
            Value::Bool(flag) => Some(*flag),
            _ => None,
        }
    }
}

impl FromValue for String {
    fn from_value(value: &Value) -> Option<Self> {
        value.text().map(str::to_owned)
    }
}
