//! Questions about one case. Each is defined once, as a [`Question`]: its name, what it asks, its
//! options and how it is answered. The command line makes a subcommand of it, Python a function and
//! the server of the page a path, without further code.
use crate::caption::case_as_written;
use serde::Serialize;
use serde_json::value::{RawValue, to_raw_value};
use snapload::analysis::{OnProgress, Unfinished};
use snapload::{
    Case, CaseError, DefaultValue, Entries, FromValue, Heading, Key, Kind, Table, Value,
};

/// A question about one case.
pub struct Question {
    /// The name of its command, which Python and the page also use.
    pub name: &'static str,
    /// What it asks, in one line.
    pub asks: &'static str,
    /// Further explanations, and examples of the command.
    pub help: &'static str,
    /// Its options; the symbol of each is the name of its value in the help of the command.
    pub options: &'static [Key],
    /// The function that answers it.
    pub(crate) answer: fn(&Case, &Options, OnProgress) -> Result<Answer, Unfinished>,
}

impl Question {
    /// The option of a name.
    ///
    /// # Errors
    /// A [`CaseError`] with the nearest name if there is no such option.
    pub fn option(&self, name: &str) -> Result<&'static Key, CaseError> {
        Table::new(self.name, Heading::None, self.asks, self.options).key(name, name)
    }

    /// Asks it about a case. Where the answer depends on them, all digits count in
    /// which numbers were written, if `entries` have them; without, a number is the
    /// shortest decimal of its double. An option that is left out has its default; for
    /// one given twice the last value counts.
    ///
    /// # Errors
    /// A [`CaseError`] if an option or the case does not allow an answer, and
    /// [`Unfinished::Cancelled`].
    pub fn ask<K: AsRef<str>>(
        &self,
        case: &Case,
        entries: &Entries,
        given: impl IntoIterator<Item = (K, Value)>,
        on_progress: OnProgress,
    ) -> Result<Answer, Unfinished> {
        let mut options = Options {
            keys: self.options,
            entries,
            given: Vec::new(),
        };
        for (name, value) in given {
            let key = self.option(name.as_ref());
            let key = key.map_err(|error| error.given(&value))?;
            key.check(key.name, &value)?;
            options.given.push((key.name, value));
        }
        (self.answer)(case, &options, on_progress)
    }
}

/// The options of a question, each value checked by the description of its option.
pub struct Options<'a> {
    keys: &'static [Key],
    /// The keys of the case that were given as text.
    pub(crate) entries: &'a Entries,
    given: Vec<(&'static str, Value)>,
}

impl Options<'_> {
    /// The value of an option: the given one, or its default.
    ///
    /// # Errors
    /// A [`CaseError`] if there is neither.
    pub(crate) fn get<T: FromValue>(&self, name: &str) -> Result<T, CaseError> {
        let given = self.given.iter().rev().find(|(given, _)| *given == name);
        let key = self.keys.iter().find(|key| key.name == name);
        let value = match given {
            Some((_, value)) => Some(value.clone()),
            None => key.and_then(|key| key.default.value()),
        };
        let value = value.as_ref().and_then(T::from_value);
        value.ok_or_else(|| match key {
            Some(key) => key.refuse(name, "(left out)"),
            None => CaseError::value(name, "(left out)", "a value"),
        })
    }
}

/// The answer to a question.
#[derive(Serialize)]
pub struct Answer {
    /// For people, in lines that begin with a label.
    pub words: String,
    /// For programs, as JSON.
    pub answer: Box<RawValue>,
}

impl Answer {
    /// An answer in words, and as a row for JSON.
    ///
    /// # Errors
    /// A [`CaseError`] if the row can not be written as JSON.
    pub(crate) fn new(words: String, row: &impl Serialize) -> Result<Self, CaseError> {
        let answer = to_raw_value(row).map_err(|error| {
            CaseError::syntax(format!("the answer can not be written as JSON: {error}"))
        })?;
        Ok(Self { words, answer })
    }

    /// The same with the name of its case in the first line; `entries` keep the digits in which its
    /// numbers were written.
    #[must_use]
    pub fn about(mut self, name: &str, case: &Case, entries: &Entries) -> Self {
        let case = case_as_written(name, case.parameters(), entries);
        self.words = format!("Case      {case}\n{}", self.words);
        self
    }
}

/// The option with the tolerance of known results.
pub const TOLERANCE: Key = Key::new(
    "tolerance",
    "1",
    Kind::positive(f64::MAX),
    DefaultValue::Number(1e-3),
    "error of state and time, relative to values above 1, above which a result counts as not known",
)
.symbol("SIZE");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verified::VERIFY;
    use snapload::analysis::no_progress;
    use snapload::{CASE, Parameters};

    fn refused(given: &[(&str, Value)]) -> Result<String, CaseError> {
        let case = Case::new(Parameters::STANDARD)?;
        match VERIFY.ask(
            &case,
            &Entries::new(&CASE),
            given.iter().cloned(),
            &no_progress,
        ) {
            Err(Unfinished::Case(error)) => Ok(error.to_string()),
            _ => Ok("(nothing)".to_owned()),
        }
    }

    #[test]
    fn an_option_is_refused_in_the_words_of_its_row() -> Result<(), CaseError> {
        for (name, value, words) in [
            (
                "digits",
                Value::from(0_i64),
                "digits = 0 is not allowed; allowed: a whole number, 1 <= digits <= 307",
            ),
            (
                "tolerance",
                f64::NAN.into(),
                "tolerance = NaN is not allowed; allowed: a number above 0, such as 0.001",
            ),
            (
                "tolerance",
                f64::INFINITY.into(),
                "tolerance = inf is not allowed; allowed: a number above 0, such as 0.001",
            ),
            (
                "digit",
                Value::from(60_i64),
                "there is no key \"digit\" (digit = 60); did you mean digits?\n\
                 the keys are digits, tolerance",
            ),
        ] {
            assert_eq!(refused(&[(name, value)])?, words);
        }
        Ok(())
    }

    #[test]
    fn the_last_value_counts_and_what_is_left_out_has_its_default() -> Result<(), CaseError> {
        let options = Options {
            keys: VERIFY.options,
            entries: &Entries::new(&CASE),
            given: vec![("digits", 70_i64.into()), ("digits", 80_i64.into())],
        };
        assert_eq!(options.get::<u64>("digits")?, 80);
        assert_eq!(options.get::<f64>("tolerance")?, 1e-3);
        Ok(())
    }
}
