//! Section 6.3: the numbering of the cases and the printed Table 6.1; the claims on the stop rules
//! and on the start of the standard case are in a file of their own.

mod stops;

use super::runs::TableRuns;
use super::verdict::{Checked, Checks, Claim, Finding, run_checks};
use crate::ReportError;
use snapload::{Parameters, anchor_height};

/// Table 6.1 as printed.
const PRINTED: &str = include_str!("../../data/table_6_1.csv");

const CHECKS: &Checks<fn(&Table) -> Checked> = &[
    ("6.3-01", |table| Ok(codes(table))),
    ("6.3-02", |table| Ok(one_parameter(table))),
    ("6.3-03", |_| Ok(standard_code())),
    ("6.3-04", |table| Ok(heights(table))),
];

/// Checks the claims of sections 6.3 to 6.3.2.
pub(super) fn claims(table_runs: &TableRuns) -> Result<Vec<Claim>, ReportError> {
    let mut all = run_checks(&[CHECKS], &Table::read(PRINTED))?;
    all.extend(run_checks(&[stops::CHECKS], table_runs)?);
    Ok(all)
}

/// A printed table: columns by name.
struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Row>,
}

type Row = Vec<&'static str>;

impl Table {
    fn read(text: &'static str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').collect());
        Self {
            columns: lines.next().unwrap_or_default(),
            rows: lines.collect(),
        }
    }

    fn text(&self, row: &Row, column: &str) -> &'static str {
        let place = self.columns.iter().position(|name| *name == column);
        place.and_then(|k| row.get(k)).copied().unwrap_or("")
    }

    /// NaN, which equals nothing, if there is no number.
    fn number(&self, row: &Row, column: &str) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }

    /// The keys that vary over the rows.
    fn varied(&self, rows: &[Row]) -> Vec<&'static str> {
        let varies = |column: &&str| {
            let mut values = rows.iter().map(|row| self.text(row, column));
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let keys = self.columns.iter().copied();
        keys.filter(|column| !["series", "case", "h"].contains(column))
            .filter(varies)
            .collect()
    }
}

/// The keys in the order in which a case number lists them, the frequency after them.
const PLACES: [&str; 12] = [
    "r", "e", "a", "b", "x", "vx", "y", "vy", "theta", "vtheta", "f_o", "nu",
];

/// The case number for given values.
fn encode(value: impl Fn(&str) -> f64) -> String {
    let mut code = String::new();
    for key in PLACES {
        let v = value(key);
        let digit = match key {
            "r" => v.floor(),
            "e" if v == 1.0 => 1.0,
            _ => (10.0 * v).round(),
        };
        if key == "f_o" {
            code.push('-');
        }
        code.push_str(&format!("{digit:.0}"));
    }
    let omega = format!("{:?}", value("omega")).replace('.', "");
    code.push_str(omega.strip_prefix('0').unwrap_or(&omega));
    code
}

fn codes(table: &Table) -> Finding {
    let number = |row: &Row, f_o: Option<f64>| {
        encode(|key| match (key, f_o) {
            ("f_o", Some(f_o)) => f_o,
            _ => table.number(row, key),
        })
    };
    let agrees = |row: &Row, f_o| number(row, f_o) == table.text(row, "case");
    let (right, wrong): (Vec<&Row>, Vec<_>) = table.rows.iter().partition(|r| agrees(r, None));
    let mut series: Vec<&str> = wrong.iter().map(|row| table.text(row, "series")).collect();
    series.dedup();
    let only_force = wrong.iter().filter(|row| agrees(row, Some(0.3))).count();
    Finding::of(wrong.is_empty() && !table.rows.is_empty())
        .values("right wrong", [right.len(), wrong.len()])
        .values("all only_force", [table.rows.len(), only_force])
        .value("series", series.join(", "))
        .condition("only_force", only_force == wrong.len())
}

fn one_parameter(table: &Table) -> Finding {
    let mut found = Vec::new();
    let mut wrong = Vec::new();
    for rows in table.rows.chunk_by(|p, q| p.first() == q.first()) {
        let mut keys = table.varied(rows);
        // A square has one size, in two columns.
        let square = |row: &Row| table.text(row, "a") == table.text(row, "b");
        if rows.iter().all(square) {
            keys.retain(|key| *key != "b");
        }
        let series = table.text(&rows[0], "series");
        found.push(format!("{series}: {}", keys.join(" and ")));
        if keys.len() != 1 {
            wrong.push(rows);
        }
    }
    // Within each part of a grid, one key varies at a time.
    let shape = |row: &Row| [table.text(row, "a"), table.text(row, "b")];
    let of_one = |p: &Row, q: &Row| shape(p) == shape(q);
    let mut parts = wrong.iter().flat_map(|rows| rows.chunk_by(of_one));
    Finding::of(wrong.is_empty() && !found.is_empty())
        .value("varied", found.join("; "))
        .condition("grid", parts.all(|rows| table.varied(rows) == ["r"]))
}

fn standard_code() -> Finding {
    let with_force = |f_o: f64| {
        encode(|key| match (key, Parameters::STANDARD.get(key)) {
            ("f_o", _) => f_o,
            (_, Some(snapload::Value::Number(v))) => v,
            _ => f64::NAN,
        })
    };
    let (named, follows) = ("1910001000-559", with_force(Parameters::STANDARD.f_o));
    Finding::of(follows == named)
        .condition("force_of_point", with_force(0.5) == named)
        .value("code", follows)
}

fn heights(table: &Table) -> Finding {
    /// Half of the last printed digit, and a little for its rounding.
    const PRINTED_WITHIN: f64 = 5.1e-4;
    let h = |row: &Row| anchor_height(table.number(row, "r"), table.number(row, "a"));
    let printed = |row: &Row| table.number(row, "h");
    let agrees = |p: &Row, q: &Row| (h(p) - printed(q)).abs() <= PRINTED_WITHIN;
    let (right, wrong): (Vec<&Row>, Vec<_>) = table.rows.iter().partition(|row| agrees(row, row));
    let of_another = |row: &&Row| table.rows.iter().any(|other| agrees(other, row));
    let misprints = wrong.iter().map(|row| {
        let code = table.text(row, "case");
        format!("{code} prints {:.3} for {:.3}", printed(row), h(row))
    });
    Finding::of(wrong.is_empty() && !table.rows.is_empty())
        .values("right all", [right.len(), table.rows.len()])
        .value("misprints", misprints.collect::<Vec<_>>().join(", "))
        .condition("of_another_row", wrong.iter().all(of_another))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims::Verdict;

    /// Table 6.1 with one text put in the place of another.
    fn altered(from: &str, to: &str) -> Table {
        let text = PRINTED.replace(from, to);
        assert_ne!(text, PRINTED);
        Table::read(Box::leak(text.into_boxed_str()))
    }

    #[test]
    fn a_table_without_misprints_is_reproduced_and_a_misprint_is_found() {
        let series_e = |mut table: Table| {
            table.rows.retain(|row| row[0] == "e");
            table
        };
        let good = series_e(Table::read(PRINTED));
        for check in [codes, one_parameter, heights] {
            assert_eq!(check(&good).verdict, Verdict::Reproduced);
        }
        let from = "e,1510001000-359,1.5,1.200,0.5,0.1";
        let bad = series_e(altered(from, "e,1510001000-359,1.5,1.250,0.6,0.1"));
        for check in [codes, heights] {
            assert_eq!(check(&bad).verdict, Verdict::NotReproduced);
        }
        let bad = series_e(altered(from, "e,1510001000-359,1.5,1.200,0.5,0.2"));
        assert_eq!(one_parameter(&bad).verdict, Verdict::NotReproduced);
    }
}
