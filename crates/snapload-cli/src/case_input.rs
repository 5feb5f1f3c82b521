//! The case that a command line asks for: built-in or from a file, then changed by `--set`.
use crate::failure::{Failure, without_number};
use snapload::{CASE, Case, CaseError, Entries, Parameters, Schema, Value, named_case};
use snapload_report::shell_command;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The size of the largest case file: a case has some twenty lines, while `/dev/zero` is endless.
const LARGEST_FILE: u64 = 1 << 20;

/// Which case, as given on the command line.
#[derive(clap::Args)]
pub(crate) struct CaseArgs {
    /// Case file in TOML, with one `key = value` per line (snapload keys lists the keys)
    #[arg(value_name = "CASE.toml", conflicts_with = "case")]
    file: Option<PathBuf>,
    /// Built-in case (snapload cases lists them)
    #[arg(long, value_name = "CODE")]
    case: Option<String>,
    /// Change one key of the file or the built-in case; may be repeated, the last value counts
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A case with its name for messages.
pub(crate) struct Input {
    /// Code or file name.
    pub(crate) name: String,
    /// The case, checked.
    pub(crate) case: Case,
    /// Its keys as they were given.
    pub(crate) entries: Entries,
}

impl Input {
    /// The same case with one key changed; derived values, such as the inertia, are computed again.
    pub(crate) fn with(&self, key: &'static str, value: Value) -> Result<Parameters, CaseError> {
        Parameters::from_entries(self.entries.values("case").chain([(key, value)]))
    }
}

impl CaseArgs {
    /// The file, if there is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The changes by `--set`.
    #[cfg(feature = "explore")]
    pub(crate) fn changes(&self) -> &[String] {
        &self.set
    }

    /// Reads the keys that `schema` describes: of the built-in case or the file, then of `--set`.
    /// Returns them with the case's name for messages.
    pub(crate) fn entries(&self, schema: &'static Schema) -> Result<(String, Entries), Failure> {
        let (name, mut entries) = match (&self.file, &self.case) {
            (Some(path), _) => (path.display().to_string(), read_file(schema, path)?),
            (None, Some(code)) => {
                let mut entries = Entries::new(schema);
                add_case_defaults(&mut entries, code).map_err(|error| error.at("--case"))?;
                (code.clone(), entries)
            }
            (None, None) => ("standard case".to_owned(), Entries::new(schema)),
        };
        self.set.iter().try_for_each(|text| entries.set(text))?;
        Ok((name, entries))
    }

    /// Reads and checks the values of the case, whose start need not be legal.
    pub(crate) fn parameters(&self) -> Result<(String, Parameters), Failure> {
        let (name, parameters, _) = self.parameters_as_given()?;
        Ok((name, parameters))
    }

    /// The same with the keys as they were given.
    pub(crate) fn parameters_as_given(&self) -> Result<(String, Parameters, Entries), Failure> {
        let (name, entries) = self.entries(&CASE)?;
        let parameters = Parameters::from_entries(entries.values("case"));
        let parameters = parameters.map_err(|error| entries.locate(error))?;
        Ok((name, parameters, entries))
    }

    /// Reads and checks the case.
    pub(crate) fn read(&self) -> Result<Input, Failure> {
        let (name, entries) = self.entries(&CASE)?;
        let case = Parameters::from_entries(entries.values("case")).and_then(Case::new);
        let case = case.map_err(|error| entries.locate(error))?;
        Ok(Input {
            name,
            case,
            entries,
        })
    }
}

/// Adds the keys of a built-in case that are not given yet.
pub(crate) fn add_case_defaults(entries: &mut Entries, code: &str) -> Result<(), CaseError> {
    let case = named_case(code);
    let case = case.map_err(|error| error.with_hint("snapload cases lists them all"))?;
    for (key, value) in case.entries() {
        if entries.table("case", 0).given(key).is_none() {
            entries.give("case", 0, key, value, &format!("--case {code}"))?;
        }
    }
    Ok(())
}

fn read_file(schema: &'static Schema, path: &Path) -> Result<Entries, Failure> {
    let (text, shown) = (read_text(path)?, path.display().to_string());
    let varies = |text: &str| {
        snapload::table_names(text)
            .iter()
            .any(|name| name == "vary")
    };
    let is_of_a_case = schema.tables.iter().all(|table| table.name != "vary");
    if is_of_a_case && varies(&text) {
        let what = "this is the file of a study, as it has [vary]";
        let words = ["snapload", "sweep", &shown, "--out", "study.parquet"];
        let hint = format!("write {}", shell_command(words));
        return Err(CaseError::syntax(what).with_hint(hint).at(shown).into());
    }
    #[cfg(feature = "structure")]
    if snapload_structure::is_structure(&text) {
        let what = "this is the case of a structure in metres and kilograms";
        let hint = format!("write {}", shell_command(["snapload", "assess", &shown]));
        return Err(CaseError::syntax(what).with_hint(hint).at(shown).into());
    }
    Ok(Entries::parse(schema, &shown, &text)?)
}

/// The text of a case file.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    read_up_to(
        path,
        LARGEST_FILE,
        "larger than 1 MiB, and thus not a case file",
    )
}

/// What may have been meant by the name of a file that is not there.
fn hint_for_no_file(name: &str) -> String {
    if named_case(name).is_ok() {
        return format!("\nhint: for the built-in case write --case {name}");
    }
    match name.split_once('=') {
        Some((key, _)) if !key.contains(['/', '\\']) => {
            format!("\nhint: each key has an option of its own: --set {name}")
        }
        _ => String::new(),
    }
}

/// The text of a file of at most `largest` bytes, without the mark of its encoding with which some
/// programs begin it; for a larger file the error `too_large`.
pub(crate) fn read_up_to(path: &Path, largest: u64, too_large: &str) -> Result<String, Failure> {
    let shown = path.display();
    let bad = |what: &str| Failure::BadInput(format!("{shown}: {what}"));
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(largest + 1).read_to_end(&mut bytes));
    match read {
        Ok(length) if length as u64 > largest => Err(bad(too_large)),
        Ok(_)
            if [&b"\x89HDF"[..], b"CDF"]
                .iter()
                .any(|mark| bytes.starts_with(mark)) =>
        {
            Err(bad(
                "a netCDF file, not a case file; snapload hydro reads the file of a panel code, and the key float.file \
                 names it in the case of a structure",
            ))
        }
        Ok(_) => match String::from_utf8(bytes) {
            Ok(text) => Ok(match text.strip_prefix('\u{feff}') {
                Some(rest) => rest.to_owned(),
                None => text,
            }),
            Err(error) => {
                let at = error.utf8_error().valid_up_to();
                Err(bad(&format!(
                    "not a text file in UTF-8 (byte {at}); save it as UTF-8"
                )))
            }
        },
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let hint = hint_for_no_file(&shown.to_string());
            Err(bad(&format!("there is no such file{hint}")))
        }
        Err(error) if error.kind() == ErrorKind::IsADirectory => {
            Err(bad("a directory, not a file"))
        }
        Err(error) => Err(bad(&format!("can not be read: {}", without_number(&error)))),
    }
}

#[cfg(test)]
mod tests {
    use super::{CaseArgs, read_file};
    use crate::failure::Failure;
    use proptest::prelude::*;
    use snapload::{CASE, Entries};

    /// Any text is either read, or refused as bad input with a message.
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
                refused_in_words(Entries::new(&CASE).set(text).map_err(Failure::from))?;
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
            refused_in_words(read_file(&CASE, file.path()))?;
        }
    }
}
