//! The tables of a run as CSV, and their columns for whoever writes them in another form.
use crate::motion::{MOTION, MotionRow};
use serde::{Serialize, Serializer};
use snapload::{Impact, Playback, Sampling, Trajectory};
use snapload_study::{Column, ColumnValue};
use std::io::{self, Write};

/// An impact with the number of its decimal digits that are expected to be right.
pub struct ImpactRow(pub Impact, pub f64);

const fn number(
    name: &'static str,
    unit: &'static str,
    of: fn(&ImpactRow) -> Option<f64>,
    meaning: &'static str,
) -> Column<ImpactRow> {
    Column::new(name, name, unit, ColumnValue::Number(of), meaning)
}

/// The columns of the impacts.
#[rustfmt::skip] // one row a column
pub static IMPACTS: [Column<ImpactRow>; 18] = [
    Column::quantity("t", ColumnValue::Number(|i| Some(i.0.t))),
    Column::new("cable", "cable", "", ColumnValue::Count(|i| Some(i.0.cable as u64 + 1)), "number of the cable"),
    number("v_n", "L/T", |i| Some(i.0.v_n), "normal velocity just before; 0 where an impulse was passed on"),
    Column::quantity("impulse", ColumnValue::Number(|i| Some(i.0.impulse))),
    Column::quantity("energy_lost", ColumnValue::Number(|i| Some(i.0.energy_lost))),
    number("before_x", "L", |i| Some(i.0.before.x), "just before"),
    number("before_y", "L", |i| Some(i.0.before.y), "just before"),
    number("before_theta", "rad", |i| Some(i.0.before.theta), "just before"),
    number("before_vx", "L/T", |i| Some(i.0.before.vx), "just before"),
    number("before_vy", "L/T", |i| Some(i.0.before.vy), "just before"),
    number("before_vtheta", "rad/T", |i| Some(i.0.before.vtheta), "just before"),
    number("after_x", "L", |i| Some(i.0.after.x), "just after"),
    number("after_y", "L", |i| Some(i.0.after.y), "just after"),
    number("after_theta", "rad", |i| Some(i.0.after.theta), "just after"),
    number("after_vx", "L/T", |i| Some(i.0.after.vx), "just after"),
    number("after_vy", "L/T", |i| Some(i.0.after.vy), "just after"),
    number("after_vtheta", "rad/T", |i| Some(i.0.after.vtheta), "just after"),
    number("digits", "1", |i| Some(i.1), "decimal digits expected to be right"),
];

/// The columns of the modes.
const MODES: [&str; 4] = ["mode", "taut", "t_start", "t_end"];

/// The impacts of a run with their digits.
pub fn impact_rows(
    run: &Trajectory,
    digits: impl Iterator<Item = f64>,
) -> impl Iterator<Item = ImpactRow> {
    let rows = run.impacts().iter().zip(digits);
    rows.map(|(impact, digits)| ImpactRow(*impact, digits))
}

impl Serialize for ImpactRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(IMPACTS.iter().map(|column| Cell::new(column, self)))
    }
}

/// A number of a table in as few digits as give it back: with an exponent below 1e-5 and from 1e16
/// on, as the writer of CSV has it, where all the rest would be zeros.
pub fn in_digits(number: f64) -> String {
    match number == 0.0 || !number.is_finite() || (1e-5..1e16).contains(&number.abs()) {
        true => number.to_string(),
        false => format!("{number:e}"),
    }
}

/// A value of a table: a number with or without a fraction, a flag, a word or nothing.
#[derive(Serialize)]
#[serde(untagged)]
#[allow(missing_docs, reason = "they are what they are called")]
pub enum Cell {
    Number(Option<f64>),
    Count(Option<u64>),
    Flag(Option<bool>),
    Word(&'static str),
}

impl Cell {
    /// The cell of a column in a row.
    pub fn new<R>(column: &Column<R>, row: &R) -> Self {
        match column.value {
            ColumnValue::Number(of) => Self::Number(of(row)),
            ColumnValue::Count(of) => Self::Count(of(row)),
            ColumnValue::Flag(of) => Self::Flag(of(row)),
            ColumnValue::Word(of) => Self::Word(of(row)),
        }
    }
}

/// `impacts.csv`: one row for each impact and cable, with the known digits of each.
///
/// # Errors
/// Those of the writer.
pub fn impacts(
    run: &Trajectory,
    digits: impl Iterator<Item = f64>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let names = IMPACTS.each_ref().map(|column| column.name);
    write(&names, impact_rows(run, digits), out)
}

/// `modes.csv`: one row for each interval; the taut cables are separated by blanks.
///
/// # Errors
/// Those of the writer.
pub fn modes(run: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let rows = run.modes().iter().map(|interval| {
        let taut: Vec<String> = interval.taut.iter().map(|c| (c + 1).to_string()).collect();
        let mode = interval.taut.mode().name();
        (mode, taut.join(" "), interval.t_start, interval.t_end)
    });
    write(&MODES, rows, out)
}

/// `motion.csv`: one row for each time.
///
/// # Errors
/// Those of the writer.
pub fn motion(run: &Trajectory, sampling: Sampling, out: &mut dyn Write) -> io::Result<()> {
    let mut playback = Playback::new(run);
    let rows = sampling.times().map(|t| MotionRow::new(&playback.at(t)).0);
    write(&MOTION, rows, out)
}

fn write<R: Serialize>(
    header: &[&str],
    rows: impl Iterator<Item = R>,
    out: &mut dyn Write,
) -> io::Result<()> {
    // The header is written here, as csv would leave it out for a table without rows.
    let mut table = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(out);
    table.write_record(header)?;
    for row in rows {
        table.serialize(row)?;
    }
    table.flush()
}

#[cfg(test)]
mod tests {
    use super::in_digits;
    use snapload_study::in_digits_with_fraction;

    #[test]
    fn numbers_have_no_row_of_zeros_and_are_read_back() {
        let examples = [
            (5.810_268_896_183_074e-20, "5.810268896183074e-20"),
            (-9.9e-6, "-9.9e-6"),
            (1e-5, "0.00001"),
            (0.0, "0"),
            (0.1, "0.1"),
            (1.0, "1"),
            (9e15, "9000000000000000"),
            (1e16, "1e16"),
            (f64::NAN, "NaN"),
        ];
        for (number, words) in examples {
            assert_eq!(in_digits(number), words);
            let read: f64 = words.parse().expect("a number");
            assert_eq!(read.to_bits(), number.to_bits());
            let with_fraction = in_digits_with_fraction(number);
            assert!(number.is_nan() || with_fraction.contains(['.', 'e']));
            let read: f64 = with_fraction.parse().expect("a number");
            assert_eq!(read.to_bits(), number.to_bits());
        }
    }
}
