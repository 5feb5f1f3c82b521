//! Section 6.3: the numbering of the cases and the printed Table 6.1.

mod stops;

use super::runs::Tabled;
use super::verdict::{Claim, Finding, Verdict, claim};
use crate::study::Study;
use snapload::{CaseError, Parameters, anchor_height};

/// Table 6.1 as printed.
const PRINTED: &str = include_str!("../../data/table_6_1.csv");

/// Checks the claims of sections 6.3 to 6.3.2.
pub(super) fn claims(study: &Study, tabled: &Tabled) -> Result<Vec<Claim>, CaseError> {
    let table = Table::read(PRINTED);
    let mut all = vec![
        claim(
            "6.3-01",
            "A case number spells out the values in its row of Table 6.1.",
            codes(&table),
        ),
        claim(
            "6.3-02",
            "Every series of Table 6.1 varies a single parameter.",
            one_parameter(&table),
        ),
        claim(
            "6.3-03",
            "The standard case bears the number 1910001000-559.",
            standard_code(),
        ),
        claim(
            "6.3-04",
            "The heights h in Table 6.1 are those of its r and a.",
            heights(&table),
        ),
    ];
    all.extend(stops::claims(study, tabled)?);
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

    /// NaN, which agrees with nothing, where there is no number.
    fn number(&self, row: &Row, column: &str) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }

    /// The keys that vary over some rows.
    fn varied(&self, rows: &[&Row]) -> Vec<&'static str> {
        let varies = |column: &&&str| {
            let mut values = rows.iter().map(|row| self.text(row, column));
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let columns = self.columns.iter().filter(varies).copied();
        columns
            .filter(|column| !["series", "case", "h"].contains(column))
            .collect()
    }
}

/// The keys in the order in which a case number lists them, the frequency after them.
const PLACES: [&str; 12] = [
    "r", "e", "a", "b", "x", "vx", "y", "vy", "theta", "vtheta", "f_o", "nu",
];

/// The case number of values.
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
    let with_force = |row: &Row, f_o: Option<f64>| {
        encode(|key| match (key, f_o) {
            ("f_o", Some(f_o)) => f_o,
            _ => table.number(row, key),
        })
    };
    let agrees = |row: &&Row, f_o| with_force(row, f_o) == table.text(row, "case");
    let wrong: Vec<&Row> = table.rows.iter().filter(|r| !agrees(r, None)).collect();
    let mut series: Vec<&str> = wrong.iter().map(|row| table.text(row, "series")).collect();
    series.dedup();
    let only_force = wrong.iter().filter(|row| agrees(row, Some(0.3))).count();
    let evidence = format!(
        "{} of {} rows agree; {} do not (series {}), {only_force} of them in f_o alone: 0.3 by \
         the number",
        table.rows.len() - wrong.len(),
        table.rows.len(),
        wrong.len(),
        series.join(", ")
    );
    Finding::new(
        Verdict::of(wrong.is_empty() && !table.rows.is_empty()),
        evidence,
    )
    .because(
        Verdict::NotReproduced,
        only_force == wrong.len(),
        "A slip in the column f_o of the table: captions of figures bear the same numbers. The \
         number is taken here; both forces are computed.",
    )
}

fn one_parameter(table: &Table) -> Finding {
    let mut found = Vec::new();
    let mut wrong = Vec::new();
    for rows in table.rows.chunk_by(|p, q| p.first() == q.first()) {
        let rows: Vec<&Row> = rows.iter().collect();
        let mut keys = table.varied(&rows);
        // A square has one size, in two columns.
        if rows
            .iter()
            .all(|r| table.text(r, "a") == table.text(r, "b"))
        {
            keys.retain(|key| *key != "b");
        }
        let series = rows.first().map_or("", |row| table.text(row, "series"));
        found.push(format!("{series}: {}", keys.join(" and ")));
        if keys.len() != 1 {
            wrong.push(rows);
        }
    }
    // A grid varies one key at a time all the same, in its parts.
    let shape = |row: &&Row| [table.text(row, "a"), table.text(row, "b")];
    let mut parts = wrong
        .iter()
        .flat_map(|rows| rows.chunk_by(|p, q| shape(p) == shape(q)));
    let grid = parts.all(|rows| table.varied(rows) == ["r"]);
    Finding::new(
        Verdict::of(wrong.is_empty() && !found.is_empty()),
        format!("varied in series {}", found.join("; ")),
    )
    .because(
        Verdict::NotReproduced,
        grid,
        "What varies more is a grid of cable length and shape: for each of its shapes r alone \
         varies.",
    )
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
    Finding::new(
        Verdict::of(follows == named),
        format!("the values of eq. 6.1 give {follows}"),
    )
    .because(
        Verdict::NotReproduced,
        with_force(0.5) == named,
        "The number is that of f_o = 0.5, the force of the point mass's standard case: perhaps \
         left over from there.",
    )
}

fn heights(table: &Table) -> Finding {
    /// Half of the last printed digit, and a little for its rounding.
    const PRINTED_WITHIN: f64 = 5.1e-4;
    let h = |row: &Row| anchor_height(table.number(row, "r"), table.number(row, "a"));
    let printed = |row: &Row| table.number(row, "h");
    let agrees = |p: &Row, q: &Row| (h(p) - printed(q)).abs() <= PRINTED_WITHIN;
    let wrong: Vec<&Row> = table.rows.iter().filter(|row| !agrees(row, row)).collect();
    let of_another = |row: &&&Row| table.rows.iter().any(|other| agrees(other, row));
    let taken = wrong.iter().filter(of_another).count();
    let words = wrong.iter().map(|row| {
        let code = table.text(row, "case");
        format!("{code} prints {:.3} for {:.3}", printed(row), h(row))
    });
    let (all, bad) = (table.rows.len(), wrong.len());
    Finding::new(
        Verdict::of(bad == 0 && all > 0),
        format!(
            "{} of {all} rows agree; {}",
            all - bad,
            words.collect::<Vec<_>>().join(", ")
        ),
    )
    .because(
        Verdict::NotReproduced,
        taken == bad,
        "Misprints: each is the height of another row. The runs take h from r and a.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table 6.1 with one text put in the place of another.
    fn altered(from: &str, to: &str) -> Table {
        let text = PRINTED.replace(from, to);
        assert_ne!(text, PRINTED);
        Table::read(Box::leak(text.into_boxed_str()))
    }

    #[test]
    fn a_table_without_slips_is_reproduced_and_a_slip_is_seen() {
        let row = |table: &Table, keep: &dyn Fn(&str) -> bool| Table {
            columns: table.columns.clone(),
            rows: table
                .rows
                .iter()
                .filter(|row| keep(row[0]))
                .cloned()
                .collect(),
        };
        let series = |name: &'static str| move |series: &str| series == name;
        let table = Table::read(PRINTED);
        let good = row(&table, &series("e"));
        for check in [codes, one_parameter, heights] {
            assert_eq!(check(&good).verdict, Verdict::Reproduced);
        }
        let bad = altered(
            "e,1510001000-359,1.5,1.200,0.5",
            "e,1510001000-359,1.5,1.250,0.6",
        );
        let bad = row(&bad, &series("e"));
        for check in [codes, heights] {
            assert_eq!(check(&bad).verdict, Verdict::NotReproduced);
        }
        let bad = altered(
            "e,1510001000-359,1.5,1.200,0.5,0.1",
            "e,1510001000-359,1.5,1.200,0.5,0.2",
        );
        assert_eq!(
            one_parameter(&row(&bad, &series("e"))).verdict,
            Verdict::NotReproduced
        );
    }
}
