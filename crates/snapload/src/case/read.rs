//! Reads keys and values from TOML and from `--set KEY=VALUE`. Only text is read here; callers read
//! the files.

use crate::case::entries::Entries;
use crate::case::error::{CaseError, Fault, SET, echo};
use crate::case::schema::{Heading, Schema, Table};
use crate::case::value::Value;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

impl Entries {
    /// The keys of a case file; `name` is the file's name in errors.
    ///
    /// # Errors
    /// A [`CaseError`] that names the line, the key, its value and what is allowed.
    pub fn parse(schema: &'static Schema, name: &str, text: &str) -> Result<Self, CaseError> {
        let mut entries = Self::new(schema);
        let line = |at: usize| format!("{name}, line {}", line_of(text, at));
        let document = DeTable::parse(text);
        let document = document.map_err(|error| malformed(schema, name, text, &error))?;
        for (key, value) in in_order(document.get_ref()) {
            let (word, at) = (key.get_ref().as_ref(), key.span().start);
            match (schema.table(word), schema.top(word)) {
                (Ok(table), _) => {
                    for keys in tables(table, value.get_ref()).map_err(|e| e.at(line(at)))? {
                        let index = entries.add(table.name);
                        for (key, value) in in_order(keys) {
                            let place = line(key.span().start);
                            entries.read(table, index, key.get_ref(), value.get_ref(), &place)?;
                        }
                    }
                }
                (_, Some(table)) => entries.read(table, 0, word, value.get_ref(), &line(at))?,
                (Err(unknown), None) => {
                    return Err(with_heading_hint(schema, word, unknown).at(line(at)));
                }
            }
        }
        Ok(entries)
    }

    fn read(
        &mut self,
        table: &'static Table,
        index: usize,
        key: &str,
        value: &DeValue<'_>,
        place: &str,
    ) -> Result<(), CaseError> {
        match value_of(value) {
            Ok(read) => {
                let schema = self.schema;
                self.give(table.name, index, key, read, place)
                    .map_err(|error| with_heading_hint(schema, key, error))?;
                self.keep_written(digits_of(value));
                Ok(())
            }
            Err(shown) => {
                let error = refuse(table, &table.path(index, key), key, &shown).at(place);
                let heading = value.is_table() && table.heading == Heading::None;
                Err(match error.fault {
                    Fault::UnknownKey { .. } if heading => error.with_hint(format!(
                        "the keys of {} have no heading; leave out the line [{}]",
                        table.meaning,
                        echo(key)
                    )),
                    _ => error,
                })
            }
        }
    }

    /// Changes one key, from text such as `f_o=0.5` or `line.2.length = 6`; `line.length` changes
    /// every line. A word needs no quotes.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key, its value and what is allowed.
    pub fn set(&mut self, text: &str) -> Result<(), CaseError> {
        let (path, value) = text.split_once('=').ok_or_else(|| self.no_setting(text))?;
        let (path, value) = (path.trim(), value.trim());
        let mut change = || -> Result<(), CaseError> {
            let (table, mut indices, key) = self.resolve_path(path)?;
            let written = DeValue::parse(value).ok();
            let written = written.and_then(|value| digits_of(value.get_ref()));
            let value = parse_value(value).map_err(|shown| refuse(table, path, key, &shown))?;
            let known = table.key(path, key);
            known.map_err(|error| self.with_path_hint(key, error.given(&value)))?;
            indices.try_for_each(|index| {
                self.give(table.name, index, key, value.clone(), SET)?;
                self.keep_written(written.clone());
                Ok(())
            })
        };
        change().map_err(|error| error.at(SET))
    }

    /// Adds to the error of a key that is not where it was written the paths by which it is.
    fn with_path_hint(&self, key: &str, error: CaseError) -> CaseError {
        let with_key = self.schema.with_key(key).into_iter();
        let paths: Vec<String> = with_key.map(|of| format!("{}.{key}", of.name)).collect();
        match paths.is_empty() {
            true => error,
            false => error.with_hint(format!("write {}", paths.join(" or "))),
        }
    }

    /// Which key of which tables a path refers to; all tables of the name if the path has no
    /// number.
    fn resolve_path<'a>(
        &self,
        path: &'a str,
    ) -> Result<(&'static Table, std::ops::Range<usize>, &'a str), CaseError> {
        if let Some(table) = self.schema.top(path) {
            return Ok((table, 0..1, path));
        }
        let (name, rest) = path.split_once('.').unwrap_or((path, ""));
        let table = self.schema.table(name);
        let table = table.map_err(|error| self.with_path_hint(path, error))?;
        if rest.is_empty() {
            let keys = table.keys.iter().map(|key| format!("{name}.{}", key.name));
            let allowed = format!("one of its keys: {}", keys.collect::<Vec<_>>().join(", "));
            return Err(CaseError::value(name, "(a table)", allowed));
        }
        let (count, many) = (self.count(name), table.heading == Heading::Many);
        let Some((number, key)) = rest.split_once('.') else {
            return Ok((table, 0..if many { count } else { 1 }, rest));
        };
        match number.parse::<usize>() {
            Ok(n) if many && (1..=count).contains(&n) => Ok((table, n - 1..n, key)),
            _ => {
                let allowed = match many {
                    true => format!("the number of a {name}, from 1 to {count}"),
                    false => format!("no number, as there is only one {}", table.header()),
                };
                let path = format!("{name}.{number}");
                Err(CaseError::value(&path, "(given)", allowed))
            }
        }
    }

    fn no_setting(&self, text: &str) -> CaseError {
        let Schema {
            tables, example, ..
        } = self.schema;
        let headed = tables.iter().all(|table| table.heading != Heading::None);
        let form = if headed { "TABLE.KEY" } else { "KEY" };
        let message = format!("no value; write {SET} {form}=VALUE, such as {SET} {example}");
        CaseError::syntax(message).at(format!("{SET} {text:?}"))
    }
}

/// A value as it stands on a command line, where a word needs no quotes, and a number needs no digit
/// on one side of its point; else what it is instead.
pub fn parse_value(text: &str) -> Result<Value, Cow<'static, str>> {
    match DeValue::parse(text) {
        _ if text.is_empty() => Err("(nothing)".into()),
        Ok(value) => value_of(value.get_ref()),
        Err(_) => Ok(match open_decimal(text) {
            Some(number) => Value::Number(number),
            None => Value::Text(text.to_owned()),
        }),
    }
}

/// The number of a decimal that has digits on one side of its point only, such as `.5` or `5.`,
/// which other programs write and TOML does not have.
fn open_decimal(text: &str) -> Option<f64> {
    let is_digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
    let (whole, fraction) = text.split_once('.')?;
    let sides = (whole.as_bytes().last(), fraction.as_bytes().first());
    let open = is_digit(sides.0) != is_digit(sides.1);
    let number = text.parse().ok();
    number.filter(|number: &f64| open && number.is_finite())
}

/// The names of the tables in a file, `[name]` or `[[name]]`; none if it is no TOML.
pub fn table_names(text: &str) -> Vec<String> {
    let document = DeTable::parse(text).map(Spanned::into_inner);
    let tables = document
        .unwrap_or_default()
        .into_iter()
        .filter(|(_, value)| {
            let value = value.get_ref();
            value.is_table() || value.is_array()
        });
    tables
        .map(|(key, _)| key.into_inner().into_owned())
        .collect()
}

/// Sorts by position in the file, so that the first error in it is the one reported.
fn in_order<'a, 'i>(
    table: &'a DeTable<'i>,
) -> Vec<(&'a Spanned<DeString<'i>>, &'a Spanned<DeValue<'i>>)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

/// The keys below each heading of a table.
fn tables<'a, 'i>(
    table: &Table,
    value: &'a DeValue<'i>,
) -> Result<Vec<&'a DeTable<'i>>, CaseError> {
    let tables: Option<Vec<_>> = match (value, table.heading) {
        (DeValue::Table(keys), Heading::One | Heading::Optional) => Some(vec![keys]),
        (DeValue::Array(items), Heading::Many) => {
            items.iter().map(|item| item.get_ref().as_table()).collect()
        }
        _ => None,
    };
    tables.ok_or_else(|| {
        let allowed = format!("a line {} with its keys below it", table.header());
        CaseError::value(table.name, in_place_of_a_table(value), allowed)
    })
}

/// What stands in a file in place of a table, in words or as it is written.
fn in_place_of_a_table(value: &DeValue<'_>) -> String {
    match value {
        DeValue::Table(_) => "(one table)".to_owned(),
        DeValue::Array(items) if items.iter().any(|item| item.get_ref().is_table()) => {
            "(an array of tables, in double brackets)".to_owned()
        }
        other => match value_of(other) {
            Ok(value) => value.to_string(),
            Err(words) => words.into_owned(),
        },
    }
}

/// Adds to the error of a key that is not where it was written the heading below which it belongs.
fn with_heading_hint(schema: &Schema, key: &str, error: CaseError) -> CaseError {
    if !matches!(error.fault, Fault::UnknownKey { .. }) {
        return error;
    }
    let with_key = schema.with_key(key).into_iter();
    let headers: Vec<String> = with_key.map(Table::header).collect();
    match headers.is_empty() {
        true => error,
        false => error.with_hint(format!(
            "{key} is a key of {}; write it below that line",
            headers.join(" and of ")
        )),
    }
}

fn refuse(table: &Table, path: &str, key: &str, shown: &str) -> CaseError {
    match table.key(path, key) {
        Ok(key) => key.refuse(path, shown),
        Err(error) => error,
    }
}

/// A value of TOML as a value of a key; else what it is instead, in words, or as it is written.
fn value_of(value: &DeValue<'_>) -> Result<Value, Cow<'static, str>> {
    Ok(match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Boolean(flag) => Value::Bool(*flag),
        DeValue::Integer(digits) => {
            let number = i64::from_str_radix(digits.as_str(), digits.radix());
            Value::Integer(number.map_err(|_| digits.as_str().to_owned())?)
        }
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            // A finite number that no double holds would be reported as one that nobody wrote.
            Ok(number) if number.is_infinite() && !digits.as_str().ends_with("inf") => {
                return Err(digits.as_str().to_owned().into());
            }
            Ok(number) => Value::Number(number),
            Err(_) => return Err(digits.as_str().to_owned().into()),
        },
        DeValue::Array(items) => {
            let values = items.iter().map(|item| value_of(item.get_ref()));
            Value::List(values.collect::<Result<_, _>>().map_err(|_| "(a list)")?)
        }
        DeValue::Table(_) => return Err("(a table)".into()),
        DeValue::Datetime(_) => return Err("(a date or time)".into()),
    })
}

/// The digits of a number as they are written in the file.
fn digits_of(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::Float(digits) => Some(digits.as_str().to_owned()),
        DeValue::Integer(digits) if digits.radix() == 10 => Some(digits.as_str().to_owned()),
        _ => None,
    }
}

fn line_of(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1
}

/// The message for a key or a heading that occurs twice.
fn duplicate_message(schema: &Schema, name: &str, line: &str) -> String {
    let name = echo(name);
    if !line.trim_start().starts_with('[') {
        return format!("the key {name} occurs twice");
    }
    match schema.table(&name) {
        Ok(table) if table.heading == Heading::Many => {
            format!("[{name}] occurs twice; write {} for each", table.header())
        }
        _ => format!("[{name}] occurs twice; write all its keys below one"),
    }
}

/// The message for two common errors in a line: a missing value, or true or false in capital
/// letters.
fn common_mistake(line: &str) -> Option<String> {
    let (key, value) = line.split_once('=')?;
    let value = value.split('#').next().unwrap_or_default().trim();
    let (key, value) = (echo(key.trim()), echo(value));
    let small = value.to_ascii_lowercase();
    if value.is_empty() {
        Some(format!("{key} has no value"))
    } else if ["true", "false"].contains(&small.as_str()) {
        Some(format!(
            "{key} = {value} has capital letters; write {small}"
        ))
    } else {
        None
    }
}

/// The error of text that is not TOML: the line, and the parser's message. The line itself is not
/// repeated, since it may be long or contain control sequences for a terminal; a key that occurs
/// twice is named.
fn malformed(schema: &Schema, name: &str, text: &str, error: &toml::de::Error) -> CaseError {
    let span = error.span().unwrap_or_default();
    let at = span.start;
    let before = text.get(..at).unwrap_or_default();
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let line = text.lines().nth(line_of(text, at) - 1).unwrap_or_default();
    let message = match text.get(span) {
        Some(name) if error.message() == "duplicate key" => duplicate_message(schema, name, line),
        _ => common_mistake(line).unwrap_or_else(|| error.message().to_owned()),
    };
    let message: String = message.chars().filter(|c| !c.is_control()).collect();
    let form = schema.form;
    CaseError::syntax(message)
        .with_hint(format!(
            "a case file has {form}; words are in quotes, and decimals have a point"
        ))
        .at(format!(
            "{name}, line {}, column {column}",
            line_of(text, at)
        ))
}

#[cfg(test)]
mod tests {
    use super::{Value, parse_value};

    /// The numbers are those of Rust's own parser; TOML has neither form.
    #[test]
    fn a_point_needs_digits_on_one_side_only() {
        for (text, number) in [
            (".5", 0.5),
            ("5.", 5.0),
            ("-.25", -0.25),
            ("+5.e-1", 0.5),
            (".1e2", 10.0),
        ] {
            assert_eq!(parse_value(text), Ok(Value::Number(number)), "{text}");
        }
        for text in [".", "-.", "a.5", ".5x", "1e400.", "5..", "1.2.", "05"] {
            assert_eq!(parse_value(text), Ok(Value::from(text)), "{text}");
        }
    }

    /// The parser of TOML is the judge: a text is read as it was, whatever characters it has.
    #[test]
    fn texts_are_written_as_toml_reads_them() {
        let all: String = ('\0'..='\u{17f}')
            .chain(['\u{2028}', '\u{1f30a}'])
            .collect();
        for text in [
            &*all,
            "",
            "a\\tb",
            "\"",
            "\\",
            "Pier \"A\" \\ east",
            "two\r\nlines",
            "true",
        ] {
            let written = Value::from(text).to_string();
            assert_eq!(written.lines().count(), 1, "{written}");
            assert_eq!(parse_value(&written), Ok(Value::from(text)));
        }
        assert_eq!(Value::from("point").to_string(), "\"point\"");
    }
}
