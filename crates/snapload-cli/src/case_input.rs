//! The case that a command line asks for: built-in or from a file, then changed by `--set`.
use crate::failure::{Failure, plain};
use snapload::{Case, CaseError, Parameters, Value, check_entry, key_named, named_case};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The largest case file: a case has some twenty lines, and `/dev/zero` never ends.
const LARGEST_FILE: u64 = 1 << 20;

/// Which case, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct CaseArgs {
    /// Case file in TOML, one `key = value` a line (keys: snapload keys)
    #[arg(value_name = "CASE.toml", conflicts_with = "case")]
    file: Option<PathBuf>,
    /// Built-in case (list: snapload cases)
    #[arg(long, value_name = "CODE")]
    case: Option<String>,
    /// Change one key, after the file or the built-in case; may be repeated, the last one counts
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A case with the name to show for it.
pub(crate) struct Input {
    /// Code or file name.
    pub(crate) name: String,
    /// The case, checked.
    pub(crate) case: Case,
    entries: Vec<Entry>,
}

impl Input {
    /// The same case with one key changed; what follows from it, such as the inertia, follows anew.
    pub(crate) fn with(&self, key: &str, value: Value) -> Result<Parameters, CaseError> {
        let given = self
            .entries
            .iter()
            .map(|e| (e.key.as_str(), e.value.clone()));
        Parameters::from_entries(given.chain([(key, value)]))
    }
}

/// A key and its value, with the place it came from for the error messages.
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) value: Value,
    origin: String,
}

/// What a command line gives before it is put together: keys of a case, each of them legal, and beside them
/// what a file says that is no key of a case.
pub(crate) struct Given {
    /// Code or file name.
    name: String,
    /// The keys, of the built-in case first, then of the file, then of `--set`.
    pub(crate) entries: Vec<Entry>,
    /// The rest.
    pub(crate) aside: toml::Table,
}

impl CaseArgs {
    /// The file, if there is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Reads the keys. Those of `aside` are let through as they are, and `case` among them names the built-in
    /// case that a file begins with.
    pub(crate) fn given(&self, aside: &[&str]) -> Result<Given, Failure> {
        let (name, file) = match (&self.file, &self.case) {
            (Some(path), _) => (path.display().to_string(), read_file(path, aside)?),
            (None, Some(code)) => (code.clone(), (built_in(code)?, toml::Table::new())),
            (None, None) => ("standard case".to_owned(), Default::default()),
        };
        let (mut entries, aside) = file;
        match aside.get("case") {
            None => {}
            Some(toml::Value::String(code)) => {
                let of_case = built_in(code)
                    .map_err(|failure| failure.with_prefix(&format!("{name}: case = {code:?}")))?;
                entries.splice(0..0, of_case);
            }
            Some(_) => {
                let what = "case is the code of a built-in case, a text in quotes";
                return Err(Failure::BadInput(format!("{name}: {what}")));
            }
        }
        for text in &self.set {
            entries.push(parse_set(text)?);
        }
        for Entry { key, value, origin } in &entries {
            check_entry(key, value).map_err(|e| Failure::BadInput(format!("{origin}: {e}")))?;
        }
        Ok(Given {
            name,
            entries,
            aside,
        })
    }

    /// Reads and checks the case.
    pub(crate) fn read(&self) -> Result<Input, Failure> {
        let Given { name, entries, .. } = self.given(&[])?;
        let values = entries
            .iter()
            .map(|entry| (&entry.key, entry.value.clone()));
        let case = Parameters::from_entries(values).and_then(Case::new);
        let case = case.map_err(|error| located(&error, &entries))?;
        Ok(Input {
            name,
            case,
            entries,
        })
    }
}

/// Puts the place of the offending entry before an error of values that do not go together; of a
/// key given more than once the last value is in effect.
fn located(error: &CaseError, entries: &[Entry]) -> Failure {
    match entries.iter().rfind(|entry| entry.key == error.key) {
        Some(Entry { origin, .. }) => Failure::BadInput(format!("{origin}: {error}")),
        None => Failure::bad_input(error),
    }
}

fn built_in(code: &str) -> Result<Vec<Entry>, Failure> {
    let case = named_case(code).map_err(|error| {
        Failure::BadInput(format!(
            "--case: {error}\nhint: snapload cases lists them all"
        ))
    })?;
    let origin = format!("--case {code}");
    let entry = |(key, value): (&str, Value)| Entry {
        key: key.to_owned(),
        value,
        origin: origin.clone(),
    };
    Ok(case.entries().into_iter().map(entry).collect())
}

fn parse_set(text: &str) -> Result<Entry, Failure> {
    let Some((key, value)) = text.split_once('=') else {
        return Err(Failure::BadInput(format!(
            "--set {text:?}: no value; write --set KEY=VALUE, such as --set f_o=0.5"
        )));
    };
    let (key, value) = (key.trim(), value.trim());
    let value = parse_value(key, value).map_err(|e| Failure::BadInput(format!("--set: {e}")))?;
    Ok(Entry {
        key: key.to_owned(),
        value,
        origin: "--set".to_owned(),
    })
}

/// A value as it stands on a command line.
pub(crate) fn parse_value(key: &str, text: &str) -> Result<Value, CaseError> {
    if text.is_empty() {
        return Err(key_named(key)?.refuse_text("(nothing)"));
    }
    // What is no TOML value is a bare word: right for `body=point`, else refused with its key.
    match text.parse::<toml::Value>() {
        Ok(parsed) => from_toml(key, &parsed),
        Err(_) => Ok(Value::Text(text.to_owned())),
    }
}

/// A TOML value as the value of a key; tables, lists and dates are refused.
pub(crate) fn from_toml(key: &str, value: &toml::Value) -> Result<Value, CaseError> {
    let what = match value {
        toml::Value::Float(number) => return Ok(Value::Number(*number)),
        toml::Value::Integer(number) => return Ok(Value::Integer(*number)),
        toml::Value::Boolean(flag) => return Ok(Value::Bool(*flag)),
        toml::Value::String(text) => return Ok(Value::Text(text.clone())),
        toml::Value::Array(_) => "(a list)",
        toml::Value::Table(_) => "(a table)",
        toml::Value::Datetime(_) => "(a date or time)",
    };
    Err(key_named(key)?.refuse_text(what))
}

/// The keys of a file, and what it says under the names of `aside`.
fn read_file(path: &Path, aside: &[&str]) -> Result<(Vec<Entry>, toml::Table), Failure> {
    let text = read_text(path)?;
    let shown = path.display();
    #[cfg(feature = "structure")]
    if snapload_structure::is_structure(&text) {
        return Err(Failure::BadInput(format!(
            "{shown}: this is the case of a structure in metres and kilograms\nhint: write snapload assess {shown}"
        )));
    }
    // Once for the values, once for the lines on which they stand.
    let mut table: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| malformed(path, &text, &error))?;
    let spans = toml::de::DeTable::parse(&text)
        .map(toml::Spanned::into_inner)
        .unwrap_or_default();
    let mut entries = Vec::new();
    let mut apart = toml::Table::new();
    for key in spans.keys() {
        let name = key.get_ref().as_ref();
        if aside.contains(&name) {
            apart.extend(table.remove_entry(name));
            continue;
        }
        let start = key.span().start;
        let origin = format!("{shown}, line {}", line_of(&text, start));
        let Some(value) = table.get(key.get_ref().as_ref()) else {
            continue;
        };
        let value = from_toml(key.get_ref(), value)
            .map_err(|e| Failure::BadInput(format!("{origin}: {e}")))?;
        entries.push((
            start,
            Entry {
                key: key.get_ref().to_string(),
                value,
                origin,
            },
        ));
    }
    // In the order of the file, so that the first fault in it is the one reported.
    entries.sort_by_key(|(start, _)| *start);
    Ok((entries.into_iter().map(|(_, entry)| entry).collect(), apart))
}

/// Text that is no TOML: where, and what the reader of TOML says. The line itself is not repeated, since
/// it may be long, or hold what a terminal would obey.
fn malformed(path: &Path, text: &str, error: &toml::de::Error) -> Failure {
    let at = error.span().map_or(0, |span| span.start);
    let line = line_of(text, at);
    let before = text.get(..at).unwrap_or_default();
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let said: String = error
        .message()
        .chars()
        .filter(|c| !c.is_control())
        .collect();
    Failure::BadInput(format!(
        "{}, line {line}, column {column}: {said}\nhint: a case file has one `key = value` a line, such as `f_o = 0.5`; \
         words stand in quotes, and decimals have a point",
        path.display()
    ))
}

fn line_of(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1
}

/// The text of a case file.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    let shown = path.display();
    let bad = |what: &str| Failure::BadInput(format!("{shown}: {what}"));
    let mut bytes = Vec::new();
    let read =
        File::open(path).and_then(|file| file.take(LARGEST_FILE + 1).read_to_end(&mut bytes));
    match read {
        Ok(length) if length as u64 > LARGEST_FILE => {
            Err(bad("larger than 1 MiB, which no case file is"))
        }
        Ok(_) => String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            bad(&format!(
                "not a text file in UTF-8 (byte {at}); save it as UTF-8"
            ))
        }),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let known = named_case(&shown.to_string()).is_ok();
            let hint = if known {
                format!("\nhint: for the built-in case write --case {shown}")
            } else {
                String::new()
            };
            Err(bad(&format!("there is no such file{hint}")))
        }
        Err(error) if error.kind() == ErrorKind::IsADirectory => {
            Err(bad("a directory, not a case file"))
        }
        Err(error) => Err(bad(&format!("can not be read: {}", plain(&error)))),
    }
}

#[cfg(test)]
mod tests {
    use super::{CaseArgs, parse_set, read_file};
    use crate::failure::Failure;
    use proptest::prelude::*;

    /// Anything is read, or refused as bad input in words.
    fn refused_in_words<T>(result: Result<T, Failure>) -> Result<(), TestCaseError> {
        match result {
            Ok(_) => Ok(()),
            Err(Failure::BadInput(message)) if !message.is_empty() => Ok(()),
            Err(other) => Err(TestCaseError::fail(format!("{other:?}"))),
        }
    }

    proptest! {
        #[test]
        fn any_set_is_read_or_refused(set in prop::collection::vec(any::<String>(), 0..3)) {
            for text in &set {
                refused_in_words(parse_set(text))?;
            }
            refused_in_words(CaseArgs { file: None, case: None, set }.read())?;
        }

        #[test]
        fn any_value_of_a_key_is_read_or_refused(
            key in prop::sample::select(vec!["e", "r", "body", "max_impacts", "x", "stop_when_settled"]),
            value in "[-+0-9.e_a-z\"'\\[\\]{}=, ]{0,12}",
        ) {
            let set = vec![format!("{key}={value}")];
            refused_in_words(CaseArgs { file: None, case: None, set }.read())?;
        }

        #[test]
        fn any_file_is_read_or_refused(
            bytes in prop_oneof![
                prop::collection::vec(any::<u8>(), 0..200),
                "([a-z_]{1,8} = [-0-9.e\"\\[\\]{}]{0,6}\n?){0,6}".prop_map(String::into_bytes),
            ],
        ) {
            let file = tempfile::NamedTempFile::new().expect("a scratch file");
            std::fs::write(file.path(), bytes).expect("a writable scratch file");
            refused_in_words(read_file(file.path(), &[]))?;
        }
    }
}
