//! What a file and a command line say, before it is a case: keys with values, and where they stand.

use crate::schema::{Key, Kind, Need, TABLES, Table, table_named};
use snapload::CaseError;
use std::fmt;

/// A value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// Two numbers.
    Pair([f64; 2]),
    /// A word.
    Word(String),
}

/// A place in a case: the table, which of several, and the key.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    table: &'static str,
    index: usize,
    key: &'static str,
}

#[derive(Clone, Debug)]
struct Entry {
    place: Place,
    value: Value,
    origin: String,
}

/// The keys that a case gives, each known and of the right type and range.
#[derive(Clone, Debug, Default)]
pub struct Entries {
    entries: Vec<Entry>,
    lines: usize,
    present: Vec<&'static str>,
}

/// An error of a case with the place it comes from, such as `mooring.toml, line 3`.
#[derive(Clone, Debug, PartialEq)]
pub struct InputError {
    /// Where; empty where there is no one place.
    pub origin: String,
    /// What.
    pub error: Box<CaseError>,
}

impl InputError {
    /// An error with its place.
    fn at(origin: &str, error: CaseError) -> Self {
        Self {
            origin: origin.to_owned(),
            error: Box::new(error),
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.origin.is_empty() {
            write!(f, "{}", self.error)
        } else {
            write!(f, "{}: {}", self.origin, self.error)
        }
    }
}

impl std::error::Error for InputError {}

impl From<CaseError> for InputError {
    fn from(error: CaseError) -> Self {
        Self {
            origin: String::new(),
            error: Box::new(error),
        }
    }
}

impl Entries {
    /// Reads a case file; `name` is what errors call it.
    ///
    /// # Errors
    /// An [`InputError`] that names the line, the key, its value and what is allowed.
    pub fn parse(name: &str, text: &str) -> Result<Self, InputError> {
        let document =
            toml::de::DeTable::parse(text).map_err(|error| malformed(name, text, &error))?;
        let mut entries = Self::default();
        // In the order of the file, so that the first fault in it is the one reported.
        let mut tables: Vec<_> = document.get_ref().iter().collect();
        tables.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in tables {
            let at = |start: usize| format!("{name}, line {}", line_of(text, start));
            let origin = at(key.span().start);
            let located = |error| InputError::at(&origin, error);
            let table = table_named(key.get_ref()).map_err(located)?;
            entries.take_table(table, value, &at).map_err(|mut error| {
                if error.origin.is_empty() {
                    error.origin = at(value.span().start);
                }
                error
            })?;
        }
        Ok(entries)
    }

    fn take_table(
        &mut self,
        table: &'static Table,
        value: &toml::Spanned<toml::de::DeValue<'_>>,
        at: &dyn Fn(usize) -> String,
    ) -> Result<(), InputError> {
        use toml::de::DeValue;
        let name = table.name;
        self.present.push(name);
        match (value.get_ref(), table.many) {
            (DeValue::Table(keys), false) => self.take_keys(table, 0, keys, at),
            (DeValue::Array(items), true) => {
                for item in items.iter() {
                    let DeValue::Table(keys) = item.get_ref() else {
                        return Err(not_a_table(table).into());
                    };
                    self.lines += 1;
                    self.take_keys(table, self.lines - 1, keys, at)?;
                }
                Ok(())
            }
            _ => Err(not_a_table(table).into()),
        }
    }

    fn take_keys(
        &mut self,
        table: &'static Table,
        index: usize,
        keys: &toml::de::DeTable<'_>,
        at: &dyn Fn(usize) -> String,
    ) -> Result<(), InputError> {
        let mut keys: Vec<_> = keys.iter().collect();
        keys.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in keys {
            let origin = at(key.span().start);
            let path = path_of(table, index, key.get_ref());
            let take = || -> Result<(&'static Key, Value), CaseError> {
                let key = table.key(&path, key.get_ref())?;
                let value =
                    from_toml(value.get_ref()).ok_or_else(|| refuse(key, &path, "(a table)"))?;
                Ok((key, checked(key, &path, value)?))
            };
            let (key, value) = take().map_err(|error| InputError::at(&origin, error))?;
            self.put(table.name, index, key.name, value, origin);
        }
        Ok(())
    }

    /// Changes one key after the file, from text such as `line.2.length = 6`; `line.length` changes every line.
    ///
    /// # Errors
    /// An [`InputError`] that names the key, its value and what is allowed.
    pub fn set(&mut self, text: &str) -> Result<(), InputError> {
        let located = |error| InputError::at("--set", error);
        let refused = |allowed: &str| {
            let shown = if text.is_empty() { "(nothing)" } else { text };
            located(CaseError::value("--set", shown, allowed))
        };
        let form = "TABLE.KEY=VALUE, such as wave.height=2 or line.1.length=6";
        let (path, value) = text.split_once('=').ok_or_else(|| refused(form))?;
        let (path, value) = (path.trim(), value.trim());
        let parts: Vec<&str> = path.split('.').collect();
        let (table, index, key) = match parts[..] {
            [table, key] => (table, None, key),
            [table, index, key] => (table, Some(index), key),
            _ => return Err(refused(form)),
        };
        let table = table_named(table).map_err(located)?;
        let indices = self.indices(table, index).map_err(located)?;
        let key = table.key(path, key).map_err(located)?;
        let value = from_words(value).ok_or_else(|| located(refuse(key, path, "(nothing)")))?;
        let value = checked(key, path, value).map_err(located)?;
        for index in indices {
            self.put(
                table.name,
                index,
                key.name,
                value.clone(),
                "--set".to_owned(),
            );
        }
        Ok(())
    }

    /// Which tables of a name are meant; all where none is said.
    fn indices(&self, table: &'static Table, index: Option<&str>) -> Result<Vec<usize>, CaseError> {
        match index {
            None if table.many => Ok((0..self.lines).collect()),
            None => Ok(vec![0]),
            Some(text) => {
                let number = text.parse::<usize>().ok();
                let known = number.filter(|n| table.many && (1..=self.lines).contains(n));
                let allowed = if table.many {
                    format!("the number of a {}, from 1 to {}", table.name, self.lines)
                } else {
                    format!("no number, as there is one [{}] only", table.name)
                };
                let path = format!("{}.{text}", table.name);
                let known = known.ok_or_else(|| CaseError::value(&path, "(given)", allowed))?;
                Ok(vec![known - 1])
            }
        }
    }

    fn put(
        &mut self,
        table: &'static str,
        index: usize,
        key: &'static str,
        value: Value,
        origin: String,
    ) {
        let place = Place { table, index, key };
        if !self.present.contains(&table) {
            self.present.push(table);
        }
        self.entries.retain(|entry| entry.place != place);
        self.entries.push(Entry {
            place,
            value,
            origin,
        });
    }

    /// Gives one key a value.
    pub(crate) fn give(
        &mut self,
        table: &'static str,
        index: usize,
        key: &'static str,
        value: Value,
        origin: &str,
    ) -> Result<(), CaseError> {
        let table = table_named(table)?;
        let path = path_of(table, index, key);
        let key = table.key(&path, key)?;
        let value = checked(key, &path, value)?;
        self.put(table.name, index, key.name, value, origin.to_owned());
        Ok(())
    }

    /// One line more; returns its index.
    pub(crate) fn add_line(&mut self) -> usize {
        self.lines += 1;
        self.lines - 1
    }

    /// What is given for a key.
    pub(crate) fn given(&self, table: &str, index: usize, key: &str) -> Option<&Value> {
        let entry = self.entries.iter().find(|entry| {
            let place = &entry.place;
            place.table == table && place.index == index && place.key == key
        });
        entry.map(|entry| &entry.value)
    }

    /// How many lines there are.
    pub(crate) fn lines(&self) -> usize {
        self.lines
    }

    /// Whether a table is there.
    pub(crate) fn has(&self, table: &str) -> bool {
        self.present.contains(&table)
    }

    /// The reader of one table.
    pub(crate) fn table(&self, name: &'static str, index: usize) -> Fields<'_> {
        Fields {
            entries: self,
            table: name,
            index,
        }
    }

    /// Puts the place of the key that an error names before it.
    pub(crate) fn locate(&self, error: CaseError) -> InputError {
        let entry = self.entries.iter().find(|entry| {
            let place = &entry.place;
            table_named(place.table)
                .is_ok_and(|table| path_of(table, place.index, place.key) == error.key)
        });
        InputError::at(entry.map_or("", |entry| &entry.origin), error)
    }
}

/// One table of [`Entries`], read key by key.
#[derive(Clone, Copy)]
pub(crate) struct Fields<'a> {
    entries: &'a Entries,
    table: &'static str,
    index: usize,
}

impl Fields<'_> {
    /// How errors call a key: `body.mass`, `line.2.length`.
    pub(crate) fn path(&self, key: &str) -> String {
        table_named(self.table)
            .map_or_else(|_| key.to_owned(), |table| path_of(table, self.index, key))
    }

    fn value(&self, key: &str) -> Result<Option<Value>, CaseError> {
        let path = self.path(key);
        let described = table_named(self.table)?.key(&path, key)?;
        let given = self.entries.given(self.table, self.index, key);
        Ok(match (given, described.need) {
            (Some(value), _) => Some(value.clone()),
            (None, Need::Number(number)) => Some(Value::Number(number)),
            (None, Need::Count(count)) => Some(Value::Number(count as f64)),
            (None, Need::Word(word)) => Some(Value::Word(word.to_owned())),
            (None, Need::Derived(_)) => None,
            (None, Need::Required) => {
                let hint = format!("{}: {}", key, described.meaning);
                return Err(refuse(described, &path, "(left out)").with_hint(hint));
            }
        })
    }

    /// A number that may be left out.
    pub(crate) fn maybe_number(&self, key: &str) -> Result<Option<f64>, CaseError> {
        Ok(match self.value(key)? {
            Some(Value::Number(number)) => Some(number),
            _ => None,
        })
    }

    /// A number that is required or has a default.
    pub(crate) fn number(&self, key: &str) -> Result<f64, CaseError> {
        self.maybe_number(key)?.ok_or_else(|| self.missing(key))
    }

    /// A whole number that is required or has a default.
    pub(crate) fn count(&self, key: &str) -> Result<u64, CaseError> {
        // Whole and within the bounds of its key, so the cast is exact.
        Ok(self.number(key)? as u64)
    }

    /// A place that may be left out.
    pub(crate) fn maybe_pair(&self, key: &str) -> Result<Option<[f64; 2]>, CaseError> {
        Ok(match self.value(key)? {
            Some(Value::Pair(pair)) => Some(pair),
            _ => None,
        })
    }

    /// A place.
    pub(crate) fn pair(&self, key: &str) -> Result<[f64; 2], CaseError> {
        self.maybe_pair(key)?.ok_or_else(|| self.missing(key))
    }

    /// A word; empty where it is left out.
    pub(crate) fn word(&self, key: &str) -> Result<String, CaseError> {
        Ok(match self.value(key)? {
            Some(Value::Word(word)) => word,
            _ => String::new(),
        })
    }

    fn missing(&self, key: &str) -> CaseError {
        CaseError::value(&self.path(key), "(left out)", "a value")
    }
}

fn path_of(table: &Table, index: usize, key: &str) -> String {
    if table.many {
        format!("{}.{}.{key}", table.name, index + 1)
    } else {
        format!("{}.{key}", table.name)
    }
}

fn not_a_table(table: &Table) -> CaseError {
    let form = if table.many {
        format!("[[{}]]", table.name)
    } else {
        format!("[{}]", table.name)
    };
    CaseError::value(
        table.name,
        "(something else)",
        format!("a line {form} with its keys below it"),
    )
}

fn refuse(key: &Key, path: &str, shown: &str) -> CaseError {
    CaseError::value(path, shown, key.allowed())
}

/// The value, if the key can take it.
fn checked(key: &Key, path: &str, value: Value) -> Result<Value, CaseError> {
    let fits = match (&value, key.kind) {
        // NaN fails every comparison, infinity the upper or the lower one.
        (Value::Number(n), Kind::Positive(high)) => *n > 0.0 && *n <= high,
        (Value::Number(n), Kind::Number(low, high)) => *n >= low && *n <= high,
        (Value::Number(n), Kind::Count(low, high)) => {
            n.fract() == 0.0 && *n >= low as f64 && *n <= high as f64
        }
        (Value::Pair(pair), Kind::Pair(limit)) => pair.iter().all(|n| n.abs() <= limit),
        (Value::Word(word), Kind::Choice(words)) => words.contains(&word.as_str()),
        _ => false,
    };
    if fits {
        Ok(value)
    } else {
        Err(refuse(key, path, &shown(&value)))
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        Value::Pair([x, z]) => format!("[{x}, {z}]"),
        Value::Word(word) => format!("\"{word}\""),
    }
}

fn number_of(value: &toml::de::DeValue<'_>) -> Option<f64> {
    use toml::de::DeValue;
    match value {
        // Digits as they stand, separators taken out; only decimal whole numbers make sense here.
        DeValue::Integer(digits) => i64::from_str_radix(digits.as_str(), digits.radix())
            .ok()
            .map(|n| n as f64),
        DeValue::Float(digits) => digits.as_str().parse().ok(),
        _ => None,
    }
}

fn from_toml(value: &toml::de::DeValue<'_>) -> Option<Value> {
    use toml::de::DeValue;
    match value {
        DeValue::String(word) => Some(Value::Word(word.to_string())),
        DeValue::Boolean(flag) => Some(Value::Word(flag.to_string())),
        DeValue::Array(items) => {
            let numbers: Option<Vec<f64>> =
                items.iter().map(|item| number_of(item.get_ref())).collect();
            match numbers?[..] {
                [x, z] => Some(Value::Pair([x, z])),
                _ => Some(Value::Word("a list of another length".to_owned())),
            }
        }
        other => number_of(other).map(Value::Number),
    }
}

/// A value as it stands on a command line, where a word needs no quotes.
fn from_words(text: &str) -> Option<Value> {
    if text.is_empty() {
        return None;
    }
    let document = format!("v = {text}");
    let parsed = toml::de::DeTable::parse(&document).ok();
    let value = parsed.as_ref().and_then(|table| table.get_ref().get("v"));
    let value = value.and_then(|value| from_toml(value.get_ref()));
    Some(value.unwrap_or_else(|| Value::Word(text.to_owned())))
}

fn malformed(name: &str, text: &str, error: &toml::de::Error) -> InputError {
    let line = line_of(text, error.span().map_or(0, |span| span.start));
    let said: String = error
        .message()
        .chars()
        .filter(|c| !c.is_control())
        .collect();
    let allowed =
        "tables such as [body] and below each one `key = value` a line, such as `mass = 72453`";
    let error = CaseError::value(&format!("the file, at {said:?},"), "(no TOML)", allowed)
        .with_hint("words stand in quotes, and decimals have a point");
    InputError::at(&format!("{name}, line {line}"), error)
}

fn line_of(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1
}

/// Whether a text looks like the case of a structure, so that it has a table of one.
pub fn is_structure(text: &str) -> bool {
    use toml::de::DeValue;
    let known = |name: &str| {
        TABLES
            .iter()
            .any(|table| table.name == name && table.name != "run")
    };
    toml::de::DeTable::parse(text).is_ok_and(|document| {
        document.get_ref().iter().any(|(key, value)| {
            // `body = "point"` is a key of the other sort of case.
            let is_table = matches!(value.get_ref(), DeValue::Table(_) | DeValue::Array(_));
            is_table && known(key.get_ref())
        })
    })
}
