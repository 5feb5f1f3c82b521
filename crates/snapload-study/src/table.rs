//! The columns of a study's file.

use crate::Row;
use crate::parquet_file::{Field, Holds, Values};
use snapload::analysis::{Certainty, Horizon};
use snapload::{FirstImpact, KEYS, Kind, Outcome, Stop, Value};

/// How a column's values are taken from a run.
#[derive(Clone, Copy)]
enum Take {
    Number(fn(&Run) -> Option<f64>),
    Count(fn(&Run) -> Option<u64>),
    Flag(fn(&Run) -> Option<bool>),
    Word(fn(&Run) -> &'static str),
}

/// What there is to tell of a row that could be run.
#[derive(Clone, Copy)]
struct Run<'a> {
    outcome: &'a Outcome,
    certainty: Option<Certainty>,
}

/// A column that tells what a run comes to.
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Its symbol in the text of the model; the name where there is none.
    pub symbol: &'static str,
    /// Its unit, as in [`snapload::Key::unit`]; empty where it has none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    take: Take,
}

impl Column {
    /// Whether it holds numbers.
    pub fn is_number(&self) -> bool {
        matches!(self.take, Take::Number(_) | Take::Count(_))
    }

    /// The words it may hold, where it holds words.
    pub fn words(&self) -> Vec<&'static str> {
        match self.take {
            Take::Word(_) => Stop::ALL.map(Stop::name).to_vec(),
            Take::Flag(_) => vec!["true", "false"],
            Take::Number(_) | Take::Count(_) => Vec::new(),
        }
    }
}

const fn column(
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    take: Take,
    meaning: &'static str,
) -> Column {
    Column {
        name,
        symbol,
        unit,
        meaning,
        take,
    }
}

fn first<T>(run: &Run, of: fn(FirstImpact) -> T) -> Option<T> {
    run.outcome.first.map(of)
}

fn horizon<T>(run: &Run, of: fn(Horizon) -> T) -> Option<T> {
    run.certainty?.horizon.map(of)
}

/// The columns beside the row's number, the keys and the error, in their order.
#[rustfmt::skip] // one row a column
static COLUMNS: [Column; 18] = [
    column("end", "end", "", Take::Word(|a| a.outcome.end.reason.name()),
        "why the run ended, in the words of run --json"),
    column("t", "t", "T", Take::Number(|a| Some(a.outcome.end.t)), "when"),
    column("impacts_1", "impacts of cable 1", "", Take::Count(|a| Some(a.outcome.impacts[0])),
        "impacts of cable 1"),
    column("impacts_2", "impacts of cable 2", "", Take::Count(|a| Some(a.outcome.impacts[1])),
        "impacts of cable 2"),
    column("rho1", "ρ₁", "L/T", Take::Number(|a| Some(a.outcome.norms.rho1)), "largest v_n of a snap"),
    column("rho2", "ρ₂", "L/T", Take::Number(|a| Some(a.outcome.norms.rho2)), "sum of v_n up to t = 10"),
    column("rho3", "ρ₃", "L/T", Take::Number(|a| Some(a.outcome.norms.rho3)), "sum of v_n"),
    column("y_max", "*y*ₘₐₓ", "L", Take::Number(|a| Some(a.outcome.norms.y_max)), "highest y of the centre"),
    column("theta_max", "|*θ*|ₘₐₓ", "rad", Take::Number(|a| Some(a.outcome.norms.theta_max)),
        "largest rotation"),
    column("first_t", "time of the first impact", "T", Take::Number(|a| first(a, |f| f.t)),
        "time of the first impact"),
    column("first_cable", "cable of the first impact", "", Take::Count(|a| first(a, |f| f.cable as u64 + 1)),
        "its cable, 1 or 2"),
    column("first_v_n", "*v*ₙ of the first impact", "L/T", Take::Number(|a| first(a, |f| f.v_n)),
        "its normal velocity"),
    column("t_slack", "time slack", "T", Take::Number(|a| Some(a.outcome.slack())), "time without a taut cable"),
    column("t_sliding", "time sliding", "T", Take::Number(|a| Some(a.outcome.sliding)),
        "time with one taut cable"),
    column("t_rocking", "time rocking", "T", Take::Number(|a| Some(a.outcome.rocking)), "time with both"),
    column("horizon_t", "horizon", "T", Take::Number(|a| horizon(a, |h| h.t)),
        "time up to which the run can be trusted; null if to its end"),
    column("horizon_impact", "impact at the horizon", "", Take::Count(|a| horizon(a, |h| h.impact as u64)),
        "the number of the impact there"),
    column("certain", "end certain", "", Take::Flag(|a| a.certainty.map(|c| c.decides_the_end())),
        "whether the way it ends is certain; null without trust"),
];

/// The columns that tell what a run comes to.
pub fn columns() -> &'static [Column] {
    &COLUMNS
}

/// The name of a reason to stop.
pub fn reason(stop: Stop) -> &'static str {
    stop.name()
}

/// The columns in their order: `row`, the keys, what the runs come to, `error`.
pub(crate) fn fields() -> Vec<Field> {
    let field = |name, holds| Field {
        name,
        holds,
        required: name == "row",
    };
    let key_holds = |kind: &Kind| match kind {
        Kind::Number { .. } => Holds::Numbers,
        Kind::Count { .. } => Holds::Counts,
        Kind::Flag => Holds::Flags,
        Kind::Choice(_) => Holds::Words,
    };
    let take_holds = |take: Take| match take {
        Take::Number(_) => Holds::Numbers,
        Take::Count(_) => Holds::Counts,
        Take::Flag(_) => Holds::Flags,
        Take::Word(_) => Holds::Words,
    };
    let keys = KEYS.iter().map(|key| field(key.name, key_holds(&key.kind)));
    let ends = COLUMNS.iter().map(|c| field(c.name, take_holds(c.take)));
    std::iter::once(field("row", Holds::Counts))
        .chain(keys)
        .chain(ends)
        .chain([field("error", Holds::Words)])
        .collect()
}

/// Rows as columns.
pub(crate) fn columns_of(rows: &[Row]) -> Vec<Values> {
    let index = rows.iter().map(|row| Some(signed(row.index)));
    let mut columns = vec![Values::Counts(index.collect())];
    for (k, key) in KEYS.iter().enumerate() {
        let values = rows.iter().map(|row| row.keys[k].as_ref());
        columns.push(key_values(&key.kind, values));
    }
    for column in &COLUMNS {
        columns.push(run_values(column.take, rows));
    }
    let errors = rows
        .iter()
        .map(|row| row.outcome.as_ref().err().map(ToString::to_string));
    columns.push(Values::Words(errors.collect()));
    columns
}

/// The values of a key. A value of another type, in a row with an error, is left out: the error tells it.
fn key_values<'a>(kind: &Kind, values: impl Iterator<Item = Option<&'a Value>>) -> Values {
    match kind {
        Kind::Number { .. } => Values::Numbers(
            values
                .map(|v| match v? {
                    Value::Number(number) => Some(*number),
                    Value::Integer(number) => Some(*number as f64),
                    _ => None,
                })
                .collect(),
        ),
        Kind::Count { .. } => Values::Counts(
            values
                .map(|v| match v? {
                    Value::Integer(number) => Some(*number),
                    _ => None,
                })
                .collect(),
        ),
        Kind::Flag => Values::Flags(
            values
                .map(|v| match v? {
                    Value::Bool(flag) => Some(*flag),
                    _ => None,
                })
                .collect(),
        ),
        Kind::Choice(_) => Values::Words(
            values
                .map(|v| match v? {
                    Value::Text(text) => Some(text.clone()),
                    _ => None,
                })
                .collect(),
        ),
    }
}

fn run_values(take: Take, rows: &[Row]) -> Values {
    let runs = rows.iter().map(|row| {
        let (outcome, certainty) = (row.outcome.as_ref().ok()?, row.certainty);
        Some(Run { outcome, certainty })
    });
    match take {
        Take::Number(of) => Values::Numbers(runs.map(|run| of(&run?)).collect()),
        Take::Count(of) => Values::Counts(runs.map(|run| of(&run?).map(signed)).collect()),
        Take::Flag(of) => Values::Flags(runs.map(|run| of(&run?)).collect()),
        Take::Word(of) => Values::Words(runs.map(|run| Some(of(&run?).to_owned())).collect()),
    }
}

fn signed(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}
