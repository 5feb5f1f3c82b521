//! The tables of a run as CSV: the columns carry the names of the JSON.
use crate::{MotionRow, Sampling, components};
use serde::Serialize;
use snapload::{Playback, Trajectory};

use std::io::{self, Write};

const IMPACTS: [&str; 18] = [
    "t",
    "cable",
    "v_n",
    "impulse",
    "energy_lost",
    "before_x",
    "before_y",
    "before_theta",
    "before_vx",
    "before_vy",
    "before_vtheta",
    "after_x",
    "after_y",
    "after_theta",
    "after_vx",
    "after_vy",
    "after_vtheta",
    "digits",
];
const MODES: [&str; 4] = ["mode", "taut", "t_start", "t_end"];
/// The columns of the motion.
pub const MOTION: [&str; 10] = [
    "t", "x", "y", "theta", "vx", "vy", "vtheta", "T1", "T2", "energy",
];

/// `impacts.csv`: one row an impact and cable, with the digits that are known of each.
///
/// # Errors
/// Those of the writer.
pub fn impacts(
    trajectory: &Trajectory,
    digits: impl Iterator<Item = f64>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let impacts = trajectory.impacts().iter().zip(digits);
    let rows = impacts.map(|(impact, digits)| {
        let scalars = (
            impact.t,
            impact.cable + 1,
            impact.v_n,
            impact.impulse,
            impact.energy_lost,
        );
        (
            scalars,
            components(&impact.before),
            components(&impact.after),
            digits,
        )
    });
    write(&IMPACTS, rows, out)
}

/// `modes.csv`: one row an interval; the taut cables stand with blanks between them.
///
/// # Errors
/// Those of the writer.
pub fn modes(trajectory: &Trajectory, out: &mut dyn Write) -> io::Result<()> {
    let rows = trajectory.modes().iter().map(|interval| {
        let taut: Vec<String> = interval.taut.iter().map(|c| (c + 1).to_string()).collect();
        (
            interval.taut.mode().name(),
            taut.join(" "),
            interval.t_start,
            interval.t_end,
        )
    });
    write(&MODES, rows, out)
}

/// `motion.csv`: one row a time.
///
/// # Errors
/// Those of the writer.
pub fn motion(trajectory: &Trajectory, sampling: Sampling, out: &mut dyn Write) -> io::Result<()> {
    let mut playback = Playback::new(trajectory);
    let rows = sampling.times().map(|t| MotionRow::new(&playback.at(t)));
    write(&MOTION, rows, out)
}

fn write<R: Serialize>(
    header: &[&str],
    rows: impl Iterator<Item = R>,
    out: &mut dyn Write,
) -> io::Result<()> {
    // The header is written by us: csv would leave it out of a table without rows.
    let mut table = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(out);
    table.write_record(header)?;
    for row in rows {
        table.serialize(row)?;
    }
    table.flush()
}
