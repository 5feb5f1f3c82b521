//! A study: the base case of all its cases, and what varies.

use crate::list::ListRow;
use crate::{Plan, StudyError};
use snapload::{Case, CaseError, KEYS, Key, Parameters, Value, check_entry};
use std::fmt::Write;
use std::ops::Range;

/// A base case and a plan.
#[derive(Debug)]
pub struct Study {
    base: Vec<(&'static str, Value)>,
    plan: Plan,
    trust: bool,
}

/// A case of a study that can not be run.
#[derive(Clone, Debug, PartialEq)]
pub struct NoCase {
    /// The values of all keys in the order of the schema: those given, and the defaults of the
    /// others; none for the columns of a row that can not be read.
    pub keys: Vec<Option<Value>>,
    /// Why it can not be run.
    pub error: CaseError,
}

/// Some cases of a study, in order. Each is made when it is needed.
pub struct StudyCases<'a> {
    study: &'a Study,
    range: Range<u64>,
    /// The rows of the list, if it is one.
    listed: Vec<ListRow>,
}

impl Study {
    /// A study of the given keys and of what varies. With `trust` the certainty of every run is
    /// computed.
    ///
    /// # Errors
    /// [`StudyError::Input`] if a key of the base is unknown or can not take its value. Whether the
    /// values are compatible depends on those that vary.
    pub fn new(
        base: impl IntoIterator<Item = (String, Value)>,
        plan: Plan,
        trust: bool,
    ) -> Result<Self, StudyError> {
        let mut given: Vec<(&'static str, Value)> = Vec::new();
        for (name, value) in base {
            let key = check_entry(&name, &value)?.name;
            given.retain(|(known, _)| *known != key);
            given.push((key, value));
        }
        let place = |name: &str| KEYS.iter().position(|key| key.name == name);
        given.sort_by_key(|(name, _)| place(name));
        Ok(Self {
            base: given,
            plan,
            trust,
        })
    }

    /// The number of its cases.
    pub fn count(&self) -> u64 {
        self.plan.count()
    }

    /// The plan of what varies.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Whether the certainty of every run is computed.
    pub fn trust(&self) -> bool {
        self.trust
    }

    /// Some of its cases, in order.
    ///
    /// # Errors
    /// [`StudyError::Failed`] if the list of cases can no longer be read.
    pub fn cases(&self, range: Range<u64>) -> Result<StudyCases<'_>, StudyError> {
        let listed = match &self.plan {
            Plan::List(list) => list.read(range.clone())?,
            Plan::Grid(_) | Plan::Random { .. } => Vec::new(),
        };
        let study = self;
        Ok(StudyCases {
            study,
            range,
            listed,
        })
    }

    /// The study as a study file. Two studies with the same text have the same rows.
    pub fn describe(&self) -> String {
        let mut text = String::new();
        // Writing to a string can not fail.
        for (key, value) in &self.base {
            let _ = writeln!(text, "{key} = {value}");
        }
        let _ = writeln!(text, "trust = {}", self.trust);
        match &self.plan {
            Plan::Grid(axes) => {
                let _ = writeln!(text, "\n[vary]");
                for axis in axes {
                    let _ = writeln!(text, "{} = {axis}", axis.key());
                }
            }
            Plan::Random {
                ranges,
                count,
                seed,
                ..
            } => {
                let _ = writeln!(text, "random = {count}\nseed = {seed}\n\n[vary]");
                for range in ranges {
                    let _ = writeln!(text, "{} = \"{range}\"", range.key());
                }
            }
            Plan::List(list) => {
                let _ = writeln!(text, "list = {:?}", list.name());
                let _ = writeln!(text, "list_sha256 = \"{}\"", list.sha256());
            }
        }
        text
    }
}

impl StudyCases<'_> {
    /// Whether the certainty of each run is to be computed.
    pub fn trust(&self) -> bool {
        self.study.trust
    }

    /// The number of cases.
    pub fn count(&self) -> usize {
        (self.range.end - self.range.start) as usize
    }

    /// The values given for the k-th case, from 0: keys and values, those of the base first. For a
    /// key given twice the last value counts.
    ///
    /// # Errors
    /// A [`CaseError`] if that row of a list can not be read.
    pub fn given(&self, k: usize) -> Result<Vec<(&'static str, Value)>, CaseError> {
        Ok([&self.study.base[..], &self.varied(k)?].concat())
    }

    fn varied(&self, k: usize) -> ListRow {
        match self.listed.get(k) {
            Some(row) => row.clone(),
            None => Ok(self.study.plan.entries(self.range.start + k as u64)),
        }
    }

    /// The k-th case, from 0, checked and ready to run.
    ///
    /// # Errors
    /// A [`NoCase`] if it can not be run.
    pub fn case(&self, k: usize) -> Result<Case, Box<NoCase>> {
        let varied = self.varied(k);
        let made = match &varied {
            Ok(varied) => Case::from_entries(self.study.base.iter().chain(varied).cloned())
                .map_err(|error| with_hint_for_missing(error, &self.study.plan, varied)),
            Err(error) => Err(error.clone()),
        };
        made.map_err(|error| {
            let unread = match (&self.study.plan, &varied) {
                (Plan::List(list), Err(_)) => list.keys(),
                _ => &[],
            };
            let varied = varied.unwrap_or_default();
            let given = [&self.study.base[..], &varied].concat();
            Box::new(NoCase::of(&given, unread, error))
        })
    }
}

/// Adds what stands for a missing value to the error of a row that has another sign for it.
fn with_hint_for_missing(
    error: CaseError,
    plan: &Plan,
    varied: &[(&'static str, Value)],
) -> CaseError {
    let is_sign = |value: &Value| match value {
        Value::Number(number) => number.is_nan(),
        Value::Text(text) => {
            let signs = ["NA", "<NA>", "N/A", "null", "None", "missing"];
            signs.iter().any(|sign| text.eq_ignore_ascii_case(sign))
        }
        _ => false,
    };
    let listed = matches!(plan, Plan::List(_));
    let given = varied.iter().find(|(key, _)| *key == error.key);
    match given.is_some_and(|(_, value)| listed && is_sign(value)) {
        true => error.with_hint("leave the cell empty for the value of the base case"),
        false => error,
    }
}

impl NoCase {
    /// `unread` are the keys of a row that can not be read, whose values are not known.
    fn of(given: &[(&'static str, Value)], unread: &[&str], error: CaseError) -> Self {
        let value = |key: &Key| match given.iter().rfind(|(name, _)| *name == key.name) {
            _ if unread.contains(&key.name) => None,
            Some((_, value)) => Some(value.clone()),
            // Values that are derived from wrong ones are left out.
            None if key.name == "inertia" => None,
            None => Parameters::STANDARD.get(key.name),
        };
        let keys = KEYS.iter().map(value).collect();
        Self { keys, error }
    }
}
