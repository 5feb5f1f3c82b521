//! Columns of tables: their names, units and meanings, and how their values are taken from a row.

use crate::parquet_file::{ColumnType, Values};
use crate::parquet_writer::Field;
use crate::{Row, Run};
use snapload::analysis::Horizon;
use snapload::{FirstImpact, Get, Parameters, Stop, Value, quantity};
use std::ops::Range;

/// How a column's values are taken from a row; none if the row has no such value.
pub enum ColumnValue<R = Run> {
    /// A number.
    Number(fn(&R) -> Option<f64>),
    /// A whole number.
    Count(fn(&R) -> Option<u64>),
    /// Yes or no.
    Flag(fn(&R) -> Option<bool>),
    /// One of a few words.
    Word(fn(&R) -> &'static str),
}

/// A column of a table.
pub struct Column<R = Run> {
    /// Its name.
    pub name: &'static str,
    /// Its symbol in the text of the model; the name if it has none.
    pub symbol: &'static str,
    /// Its unit, as in [`snapload::Key::unit`]; empty if it has none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Its values.
    pub value: ColumnValue<R>,
}

impl<R> Column<R> {
    /// A column; the arguments are in the order of the columns of a table of columns.
    pub const fn new(
        name: &'static str,
        symbol: &'static str,
        unit: &'static str,
        value: ColumnValue<R>,
        meaning: &'static str,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            meaning,
            value,
        }
    }

    /// One of the model's quantities, under its own name; an unknown name has neither unit nor
    /// meaning.
    pub const fn quantity(name: &'static str, value: ColumnValue<R>) -> Self {
        match quantity(name) {
            Some(known) => Self::new(name, known.symbol, known.unit, value, known.meaning),
            None => Self::new(name, name, "", value, ""),
        }
    }

    /// Whether it holds numbers.
    pub fn is_number(&self) -> bool {
        matches!(self.value, ColumnValue::Number(_) | ColumnValue::Count(_))
    }

    /// Its values; none where there is no row.
    pub fn values<'a>(&self, rows: impl Iterator<Item = Option<&'a R>>) -> Values
    where
        R: 'a,
    {
        match self.value {
            ColumnValue::Number(of) => Values::Numbers(rows.map(|row| of(row?)).collect()),
            ColumnValue::Count(of) => {
                Values::Counts(rows.map(|row| of(row?).map(signed)).collect())
            }
            ColumnValue::Flag(of) => Values::Flags(rows.map(|row| of(row?)).collect()),
            ColumnValue::Word(of) => Values::Words(rows.map(|row| Some(of(row?).into())).collect()),
        }
    }

    /// The type of its values.
    pub fn column_type(&self) -> ColumnType {
        match self.value {
            ColumnValue::Number(_) => ColumnType::Numbers,
            ColumnValue::Count(_) => ColumnType::Counts,
            ColumnValue::Flag(_) => ColumnType::Flags,
            ColumnValue::Word(_) => ColumnType::Words,
        }
    }
}

impl Column {
    /// Its possible words, if its values are words.
    pub fn words(&self) -> Vec<&'static str> {
        match self.value {
            ColumnValue::Word(_) => Stop::ALL.map(Stop::name).to_vec(),
            ColumnValue::Flag(_) => vec!["true", "false"],
            ColumnValue::Number(_) | ColumnValue::Count(_) => Vec::new(),
        }
    }
}

fn first<T>(run: &Run, of: fn(FirstImpact) -> T) -> Option<T> {
    run.outcome.first.map(of)
}

fn horizon<T>(run: &Run, of: fn(Horizon) -> T) -> Option<T> {
    run.certainty?.horizon.map(of)
}

/// The columns of a study besides the row's number, the keys and the error, in their order.
#[rustfmt::skip] // one row a column
static COLUMNS: [Column; 18] = [
    Column::new("end", "end", "", ColumnValue::Word(|a| a.outcome.end.reason.name()),
        "why the run ended, in the words of run --json"),
    Column::new("t", "t", "T", ColumnValue::Number(|a| Some(a.outcome.end.t)), "when"),
    Column::new("impacts_1", "impacts of cable 1", "", ColumnValue::Count(|a| Some(a.outcome.impacts[0])),
        "impacts of cable 1"),
    Column::new("impacts_2", "impacts of cable 2", "", ColumnValue::Count(|a| Some(a.outcome.impacts[1])),
        "impacts of cable 2"),
    Column::quantity("rho1", ColumnValue::Number(|a| Some(a.outcome.norms.rho1))),
    Column::quantity("rho2", ColumnValue::Number(|a| Some(a.outcome.norms.rho2))),
    Column::quantity("rho3", ColumnValue::Number(|a| Some(a.outcome.norms.rho3))),
    Column::quantity("y_max", ColumnValue::Number(|a| Some(a.outcome.norms.y_max))),
    Column::quantity("theta_max", ColumnValue::Number(|a| Some(a.outcome.norms.theta_max))),
    Column::new("first_t", "time of the first impact", "T", ColumnValue::Number(|a| first(a, |f| f.t)),
        "time of the first impact"),
    Column::new("first_cable", "cable of the first impact", "", ColumnValue::Count(|a| first(a, |f| f.cable as u64 + 1)),
        "its cable, 1 or 2"),
    Column::new("first_v_n", "*v*ₙ of the first impact", "L/T", ColumnValue::Number(|a| first(a, |f| f.v_n)),
        "its normal velocity"),
    Column::new("t_slack", "time slack", "T", ColumnValue::Number(|a| Some(a.outcome.slack())), "time without a taut cable"),
    Column::new("t_sliding", "time sliding", "T", ColumnValue::Number(|a| Some(a.outcome.sliding)),
        "time with one taut cable"),
    Column::new("t_rocking", "time rocking", "T", ColumnValue::Number(|a| Some(a.outcome.rocking)), "time with both"),
    Column::new("horizon_t", "horizon", "T", ColumnValue::Number(|a| horizon(a, |h| h.t)),
        "time up to which the run can be trusted; null if to its end, or if the case could not be run"),
    Column::new("horizon_impact", "impact at the horizon", "", ColumnValue::Count(|a| horizon(a, |h| h.impact as u64)),
        "the number of the impact there"),
    Column::new("certain", "end certain", "", ColumnValue::Flag(|a| a.certainty.map(|c| c.decides_the_end())),
        "whether the way it ends is certain; null without trust"),
];

/// The columns with the results of a run.
pub fn columns() -> &'static [Column] {
    &COLUMNS
}

/// The columns in their order: `row`, the keys, the results, `error`.
pub(crate) fn fields() -> Vec<Field> {
    let field = |name, column_type| Field {
        name,
        column_type,
        required: name == "row",
    };
    let key_holds = |get: Get| match get {
        Get::Number(_) => ColumnType::Numbers,
        Get::Count(_) => ColumnType::Counts,
        Get::Flag(_) => ColumnType::Flags,
        Get::Word(_) => ColumnType::Words,
    };
    let keys = Parameters::keys().map(|(key, get)| field(key.name, key_holds(get)));
    let ends = COLUMNS.iter().map(|c| field(c.name, c.column_type()));
    std::iter::once(field("row", ColumnType::Counts))
        .chain(keys)
        .chain(ends)
        .chain([field("error", ColumnType::Words)])
        .collect()
}

/// So many rows stay in the processor's caches while their columns are taken from them one by one.
const BLOCK: usize = 256;

/// Rows as columns; `range` are their indices in the study, from 0.
pub(crate) fn columns_of(range: Range<u64>, rows: &[&Row]) -> Vec<Values> {
    let fields = fields();
    let with_room = |field: &Field| Values::with_room(field.column_type, rows.len());
    let mut columns: Vec<Values> = fields.iter().map(with_room).collect();
    let mut start = range.start;
    for block in rows.chunks(BLOCK) {
        let end = start + block.len() as u64;
        for (column, more) in columns.iter_mut().zip(columns_of_block(start..end, block)) {
            column.append(more);
        }
        start = end;
    }
    columns
}

fn columns_of_block(range: Range<u64>, rows: &[&Row]) -> Vec<Values> {
    let mut columns = vec![Values::Counts(range.map(signed).map(Some).collect())];
    for (k, (_, get)) in Parameters::keys().enumerate() {
        columns.push(key_values(rows, k, get));
    }
    for column in &COLUMNS {
        let runs = rows.iter().map(|row| row.as_ref().ok().map(|(_, run)| run));
        columns.push(column.values(runs));
    }
    let error = |row: &&Row| Some(row.as_ref().err()?.error.to_string().into());
    columns.push(Values::Words(rows.iter().map(error).collect()));
    columns
}

/// The values of the k-th key. A value of another type, in a row with an error, is left out, as the
/// error contains it.
fn key_values(rows: &[&Row], k: usize, get: Get) -> Values {
    /// Values by `of` for cases that could be run, and by `given` for the others.
    fn values<T>(
        rows: &[&Row],
        k: usize,
        of: impl Fn(&Parameters) -> Option<T>,
        given: impl Fn(&Value) -> Option<T>,
    ) -> Vec<Option<T>> {
        let value = |row: &&Row| match row {
            Ok((parameters, _)) => of(parameters),
            Err(no_case) => no_case.keys[k].as_ref().and_then(&given),
        };
        rows.iter().map(value).collect()
    }
    match get {
        Get::Number(of) => Values::Numbers(values(rows, k, of, Value::number)),
        Get::Count(of) => Values::Counts(values(
            rows,
            k,
            |p| Some(signed(of(p))),
            |value| match value {
                Value::Integer(number) => Some(*number),
                _ => None,
            },
        )),
        Get::Flag(of) => Values::Flags(values(
            rows,
            k,
            |p| Some(of(p)),
            |value| match value {
                Value::Bool(flag) => Some(*flag),
                _ => None,
            },
        )),
        Get::Word(of) => Values::Words(values(
            rows,
            k,
            |p| Some(of(p).into()),
            |value| value.text().map(|text| text.to_owned().into()),
        )),
    }
}

fn signed(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}
