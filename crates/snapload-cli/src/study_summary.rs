//! A summary of the file of a study.
use crate::failure::{Failure, print};
use snapload_study::{Axis, Plan, RandomRange, StudyEnds, ends};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A complete file of rows.
pub(crate) struct Summary<'a> {
    file: &'a Path,
    rows: u64,
    tally: StudyEnds,
    /// The files that were made from it.
    others: Vec<PathBuf>,
    plan: Option<&'a Plan>,
}

impl<'a> Summary<'a> {
    /// Reads the file, from which others may have been made.
    pub(crate) fn of(
        file: &'a Path,
        rows: u64,
        others: [Option<PathBuf>; 2],
    ) -> Result<Self, Failure> {
        Ok(Self {
            file,
            rows,
            tally: ends(file)?,
            others: others.into_iter().flatten().collect(),
            plan: None,
        })
    }

    /// The same with a description of what varied.
    pub(crate) fn with(self, plan: &'a Plan) -> Self {
        let plan = Some(plan);
        Self { plan, ..self }
    }

    /// Prints it. A whole study without a single run is bad input: the file exists, and contains
    /// the reasons.
    pub(crate) fn print(&self, whole: bool) -> Result<(), Failure> {
        print(&self.in_words())?;
        if !whole || self.tally.errors < self.rows {
            return Ok(());
        }
        Err(Failure::BadInput(format!(
            "none of the {} cases could be run; the column error of {} gives the reasons",
            self.rows,
            self.file.display()
        )))
    }

    fn in_words(&self) -> String {
        let tally = &self.tally;
        let mut text = format!("Cases     {}\n", self.rows);
        // Writing to a string can not fail.
        if let Some(plan) = self.plan {
            let _ = writeln!(text, "Varied    {}", varied(plan));
        }
        let counts = tally.ends.iter();
        let counts: Vec<String> = counts
            .map(|(end, n)| format!("{} {n}", end.replace('_', " ")))
            .collect();
        let ends = if counts.is_empty() {
            "none".to_owned()
        } else {
            counts.join(", ")
        };
        let _ = writeln!(text, "Ends      {ends}");
        if tally.judged > 0 {
            let StudyEnds {
                certain, judged, ..
            } = tally;
            let _ = writeln!(
                text,
                "Trust     {certain} of {judged} ends are certain (see the column certain)"
            );
        }
        if let Some((row, error)) = &tally.first_error {
            let first = error.lines().next().unwrap_or_default();
            let place = self.line(*row);
            let _ = writeln!(
                text,
                "Errors    {}; the first, in row {row}{place}: {first}",
                tally.errors
            );
        }
        let _ = writeln!(text, "Written   {}", self.file.display());
        for path in &self.others {
            let _ = writeln!(text, "{:<9} {}", "", path.display());
        }
        text
    }

    /// The position of a row in its list: lines as a text editor counts them, or rows as a reader
    /// of the table counts them.
    fn line(&self, row: u64) -> String {
        let Some(Plan::List(list)) = self.plan else {
            return String::new();
        };
        match list.line(row) {
            Some(line) => format!(", line {line} of {}", list.name()),
            None => format!(" of {}, counted from 0", list.name()),
        }
    }
}

/// Which keys varied, and how.
fn varied(plan: &Plan) -> String {
    match plan {
        Plan::Grid(axes) if axes.is_empty() => "nothing".to_owned(),
        Plan::Grid(axes) => {
            let axis = |axis: &Axis| match axis.count() {
                1 => format!("{} (1 value)", axis.key()),
                n => format!("{} ({n} values)", axis.key()),
            };
            axes.iter().map(axis).collect::<Vec<_>>().join(", ")
        }
        Plan::Random { ranges, seed, .. } => {
            let keys: Vec<&str> = ranges.iter().map(RandomRange::key).collect();
            format!("{} (random points, seed {seed})", keys.join(", "))
        }
        Plan::List(list) => {
            let keys = list.keys().join(", ");
            let empty = match list.empty_lines_at_end() {
                0 => String::new(),
                1 => "; the empty line at its end is no row".to_owned(),
                n => format!("; the {n} empty lines at its end are no rows"),
            };
            format!("{keys} (columns of {}{empty})", list.name())
        }
    }
}
