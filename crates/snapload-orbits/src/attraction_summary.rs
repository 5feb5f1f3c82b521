//! Basins of attraction as a few lines of text.

use crate::attraction::{Attraction, CellOutcome, LONGEST_SHOWN};
use crate::sequence::symbol_text;
use crate::summary::periods;
use std::fmt::Write;

/// The most characters of a symbol that are printed.
const LONGEST_SYMBOL: usize = 60;

/// Basins of attraction.
pub fn attraction_summary(found: &Attraction) -> String {
    let mut text = String::new();
    let no_orbit = match found.window.are_starts() {
        true => "orbit not found",
        false => "orbit not searched for, as the keys change the motion itself",
    };
    for (attractor, number) in found.attractors.iter().zip(1..) {
        let symbol = attractor
            .orbit
            .as_ref()
            .map(|orbit| symbol_text(&orbit.lap.sequence));
        let _ = writeln!(
            text,
            "Attractor {number}: {}, {}, {}",
            cells(attractor.cells),
            periods(attractor.period),
            symbol.map_or(no_orbit.to_owned(), |symbol| beginning(&symbol))
        );
    }
    let stopped = found.count(|outcome| matches!(outcome, CellOutcome::Stopped(..)));
    let _ = writeln!(text, "Stopped   {}", cells(stopped));
    let open = found.count(|outcome| *outcome == CellOutcome::Aperiodic);
    if open > 0 {
        let _ = writeln!(
            text,
            "Open      {}: no period up to {LONGEST_SHOWN} was found; a longer transient may show one",
            cells(open)
        );
    }
    if let Some(undecided) = found.undecided() {
        let _ = writeln!(
            text,
            "Undecided {} (neighbours end in another way)",
            cells(undecided)
        );
    }
    let legal = found.count(|outcome| *outcome != CellOutcome::Illegal);
    let _ = writeln!(text, "Legal     {legal} of {}", cells(found.cells.len()));
    text
}

fn cells(count: usize) -> String {
    match count {
        1 => "1 cell".to_owned(),
        _ => format!("{count} cells"),
    }
}

/// A symbol, or the beginning of one that is longer than a line, as where snaps accumulate.
fn beginning(symbol: &str) -> String {
    match symbol.char_indices().nth(LONGEST_SYMBOL) {
        None => format!("symbol {symbol}"),
        Some((end, _)) => format!("symbol {}… (--json has all of it)", &symbol[..end]),
    }
}
