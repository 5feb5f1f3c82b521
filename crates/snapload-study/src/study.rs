//! A study: what is the same in all its cases, and what varies.

use crate::{Plan, StudyError};
use snapload::{CaseError, KEYS, Parameters, Value, check_entry};
use std::fmt::Write;
use std::ops::Range;

/// A base case and a plan.
#[derive(Debug)]
pub struct Study {
    base: Vec<(&'static str, Value)>,
    plan: Plan,
    trust: bool,
}

/// A case of a study before it is run: what was given for it, and what that makes.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its place in the study, from 0.
    pub index: u64,
    /// Keys and values given, those of the base first; of a key given twice the last value counts.
    pub given: Vec<(&'static str, Value)>,
    /// The case, or why there is none.
    pub parameters: Result<Parameters, CaseError>,
}

impl Study {
    /// A study of the keys given and of what varies. With `trust` every run says how far it can be
    /// trusted.
    ///
    /// # Errors
    /// [`StudyError::Input`] if a key of the base is unknown or can not take its value. Whether the
    /// values go together shows only with those that vary.
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

    /// How many cases it has.
    pub fn count(&self) -> u64 {
        self.plan.count()
    }

    /// What varies.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Whether every run says how far it can be trusted.
    pub fn trust(&self) -> bool {
        self.trust
    }

    /// Some of its cases, in order.
    ///
    /// # Errors
    /// [`StudyError::Failed`] if the list of cases can no longer be read.
    pub fn draw(&self, range: Range<u64>) -> Result<Vec<Drawn>, StudyError> {
        match &self.plan {
            Plan::List(list) => {
                let rows = list.read(range.clone())?;
                let drawn = range.zip(rows);
                Ok(drawn
                    .map(|(index, row)| match row {
                        Ok(entries) => self.case(index, entries),
                        Err(error) => Drawn {
                            parameters: Err(error),
                            ..self.case(index, Vec::new())
                        },
                    })
                    .collect())
            }
            plan => Ok(range.map(|i| self.case(i, plan.entries(i))).collect()),
        }
    }

    fn case(&self, index: u64, varied: Vec<(&'static str, Value)>) -> Drawn {
        let given: Vec<_> = self.base.iter().cloned().chain(varied).collect();
        let parameters = Parameters::from_entries(given.iter().cloned());
        Drawn {
            index,
            given,
            parameters,
        }
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
                sides, count, seed, ..
            } => {
                let _ = writeln!(text, "random = {count}\nseed = {seed}\n\n[vary]");
                for side in sides {
                    let _ = writeln!(text, "{} = \"{side}\"", side.key());
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
