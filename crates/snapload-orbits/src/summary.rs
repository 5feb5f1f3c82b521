//! The answers as a few lines of text.

use crate::basin::Basin;
use crate::diagram::DiagramPoint;
use crate::erosion::{Erosion, KNEE};
use crate::exponents_text::{exponent_text, exponents_text};
use crate::orbit::Orbit;
use crate::section::Section;
use crate::sequence::Sequence;
use crate::window::Window;
use snapload::TautSet;
use snapload::analysis::START_KEYS;
use std::fmt::Write;

/// Why a window has no legal cell.
const NO_START: &str =
    "each start of the window is beyond a cable or a limit; choose another window";

/// An orbit.
pub fn orbit_summary(orbit: &Orbit) -> String {
    let stability = orbit.stability().name();
    let mut text = format!(
        "Orbit     {stability}, of {} (t = {:.6})\nEvents    {}\n",
        of_the_forcing(orbit.periods as usize),
        orbit.length,
        orbit.lap.sequence.in_words()
    );
    text += &always_taut_text(&orbit.lap.sequence);
    if orbit.smallest_periods < orbit.periods {
        let _ = writeln!(
            text,
            "Repeats   itself after {}: this lap goes round that orbit {} times",
            periods(orbit.smallest_periods as usize),
            orbit.periods / orbit.smallest_periods
        );
    }
    // Adding 0 makes 0 of -0.
    let named = START_KEYS.iter().zip(&orbit.z);
    let state: Vec<String> = named
        .map(|(key, component)| format!("{key} = {:.9}", component + 0.0))
        .collect();
    let _ = writeln!(text, "Section   {}", state.join(", "));
    let multiplier = |[re, im]: &[f64; 2]| match *im {
        0.0 if *re != 0.0 && re.abs() < 1e-3 => format!("{re:.6e}"),
        0.0 => format!("{re:.6}"),
        im => format!("{re:.6}{im:+.6}i"),
    };
    let all: Vec<String> = orbit.multipliers.values.iter().map(multiplier).collect();
    let _ = writeln!(text, "Multiplier {}", all.join(", "));
    for why in &orbit.why_not {
        let _ = writeln!(text, "Not admissible: {why}");
    }
    if let Some(error) = orbit.return_error {
        let _ = writeln!(text, "Returns   to within {error:.1e} when it is simulated");
    }
    let _ = match &orbit.proof {
        Some(Ok(proved)) => writeln!(
            text,
            "Proved    to exist within {:.1e} of the section, with no other orbit of as many periods within {:.1e}{}",
            proved.error_of(&orbit.z),
            proved.unique_within,
            match proved.is_prime() {
                true => "",
                false => "; fewer periods are not ruled out",
            }
        ),
        Some(Err(why)) => writeln!(text, "Unproved  {why}"),
        None => Ok(()),
    };
    text
}

pub(crate) fn periods(n: usize) -> String {
    match n {
        1 => "one period".to_owned(),
        n => format!("{n} periods"),
    }
}

fn of_the_forcing(n: usize) -> String {
    format!("{} of the forcing", periods(n))
}

/// The cables that are taut during the whole lap, and so have no events.
fn always_taut_text(sequence: &Sequence) -> String {
    let sets = sequence.taut_sets().into_iter();
    let always = sets.reduce(TautSet::intersection).unwrap_or(TautSet::SLACK);
    let cables: Vec<String> = always.iter().map(|cable| (cable + 1).to_string()).collect();
    match cables.len() {
        0 => String::new(),
        1 => format!("Taut      cable {} all the time\n", cables[0]),
        _ => format!("Taut      cables {} all the time\n", cables.join(", ")),
    }
}

/// A message if a motion stopped before the first point of its section; it continues "the motion of
/// this start".
pub fn without_points_summary(section: &Section) -> Option<String> {
    let stop = section.stop.filter(|_| section.points.is_empty())?;
    Some(format!(
        "stops at t = {:.4}{}: {}. That is before the first point of the section, which comes after {}",
        section.end.1,
        doubt(section.stop_is_certain()),
        stop.reason_text(),
        of_the_forcing(section.first as usize)
    ))
}

/// What follows the time of a stop that rounding decides.
pub(crate) fn doubt(certain: Option<bool>) -> &'static str {
    match certain {
        Some(false) => " (not certain)",
        _ => "",
    }
}

/// A section.
pub fn section_summary(section: &Section) -> String {
    let mut text = String::new();
    if let Some(why) = without_points_summary(section) {
        return format!("Stopped   the motion from this start {why}\n");
    }
    if let Some(stop) = section.stop {
        let _ = writeln!(
            text,
            "Stopped   at t = {:.4}{}: {}",
            section.end.1,
            doubt(section.stop_is_certain()),
            stop.reason_text()
        );
        if section.stop_is_certain() == Some(false) {
            text += "          rounding decides the time: with another number of periods the motion may stop at another \
                     time, or not at all\n";
        }
        return text;
    }
    let _ = match section.period() {
        Some(n) => writeln!(text, "Repeats   itself after {}", of_the_forcing(n)),
        None => writeln!(
            text,
            "Repeats   itself after no number of periods of the forcing up to {}, the most that {} points can show",
            section.longest_period(),
            section.points.len()
        ),
    };
    if !section.exponents.is_empty() {
        let all = exponents_text(section);
        let _ = writeln!(
            text,
            "Exponents per unit of time, with standard errors: {all}"
        );
    }
    if let Some(kept) = &section.impacts {
        let velocities = || kept.points.iter().map(|impact| impact.v_n);
        let hardest = velocities().fold(0.0, f64::max);
        let softest = velocities().fold(f64::INFINITY, f64::min);
        let _ = match kept.points.len() {
            0 => writeln!(text, "Impacts   none"),
            count => writeln!(
                text,
                "Impacts   {count}, v_n from {softest:.6} to {hardest:.6}"
            ),
        };
    }
    text
}

/// A diagram.
pub fn diagram_summary(key: &str, found: &[DiagramPoint]) -> String {
    let mut text = format!("{key:<12} period  snaps    exponent\n");
    let first = found.first().map(|at| at.value);
    let begins_anew = |at: &DiagramPoint| at.restarted && Some(at.value) != first;
    for at in found {
        let period = at.period.map_or("none".to_owned(), |n| n.to_string());
        let snaps = at
            .snaps()
            .map_or("-".to_owned(), |snaps| format!("{snaps:.3}"));
        let exponent = at.section.exponents.first();
        let exponent = exponent.map_or("-".to_owned(), |both| exponent_text(*both));
        let mark = if begins_anew(at) { "*" } else { "" };
        let value = six_digits(at.value) + mark;
        let _ = match at.stop() {
            Some(stop) => writeln!(
                text,
                "{value:<12} {}{}",
                stop.label(),
                doubt(at.stop_is_certain())
            ),
            None => writeln!(text, "{value:<12} {period:<7} {snaps:<8} {exponent}"),
        };
    }
    let none = found
        .iter()
        .filter(|at| at.stop().is_none() && at.period.is_none());
    if found.iter().any(|at| !at.section.exponents.is_empty()) {
        text += "exponent: the largest, per unit of time, with its standard error\n";
    }
    if let Some(longest) = none.map(|at| at.section.longest_period()).max() {
        let _ = writeln!(text, "none: no period of the forcing up to {longest}");
    }
    if found.iter().any(begins_anew) {
        text += "*: from the start of the case, as the motion before had stopped or its last state is not legal here\n";
    }
    let doubtful = |at: &DiagramPoint| at.stop_is_certain() == Some(false);
    if found.iter().any(doubtful) {
        text += "not certain: rounding decides whether and when the motion stops, here or in the chaotic motion before\n\
                 it; with another number of periods a chaotic motion may also stop where this one does not\n";
    }
    text
}

/// A safe basin.
pub fn basin_summary(basin: &Basin) -> String {
    let m = &basin.measures;
    if m.legal == 0 {
        return format!("Safe      none, as no cell is legal: {NO_START}\n");
    }
    let mut text = format!(
        "Safe      {} of {} legal cells: {:.4} ({:.4} to {:.4})\n",
        m.safe, m.legal, m.gim, m.interval[0], m.interval[1]
    );
    for (stop, count) in basin
        .by_outcome()
        .into_iter()
        .filter(|(_, count)| *count > 0)
    {
        let _ = writeln!(text, "          {count} {}", stop.label());
    }
    if basin.neighbours_run {
        let _ = writeln!(text, "Undecided {}", m.undecided);
    }
    text += &cut_short_text(m.cut_short);
    text += &distances_text(basin);
    text
}

/// How far from the equilibrium the safe basin reaches, and what limits that knowledge.
fn distances_text(basin: &Basin) -> String {
    let m = &basin.measures;
    let mut text = String::new();
    let [unknown, limits] = match m.cut_short {
        0 => [
            "lie beyond the window's border",
            "the window's border limits it",
        ],
        _ => [
            "lie beyond the window's border or were not run to their end",
            "the window's border or starts not run to their end limit it",
        ],
    };
    if let Some(lim) = m.lim {
        let _ = writeln!(
            text,
            "Nearest   unsafe start {lim:.4} from the equilibrium (LIM){}",
            cautious(m.lim, m.at_least.lim)
        );
    }
    if let Some(lim) = m.lim_at_most {
        let _ = writeln!(
            text,
            "Nearest   unsafe start at most {lim:.4} from the equilibrium (LIM unknown): nearer starts {unknown}"
        );
    }
    text += &distances_undefined_text(&basin.window);
    if let Some(radius) = m.integrity_factor {
        let limited = match m.disc_meets_unknown {
            true => format!("; {limits}"),
            false => String::new(),
        };
        let _ = writeln!(
            text,
            "Disc      of radius {radius:.4} without unsafe starts (IF){limited}{}",
            cautious(m.integrity_factor, m.at_least.integrity_factor)
        );
    }
    for (axis, key) in basin.window.keys.iter().enumerate() {
        if let Some(speed) = m.iim[axis] {
            let _ = writeln!(
                text,
                "Velocity  {key} of {speed:.4} is the least unsafe one in the row of the equilibrium (IIM){}",
                cautious(m.iim[axis], m.at_least.iim[axis])
            );
        }
    }
    text
}

/// A distance where undecided starts count as unsafe; nothing where it is the same.
fn cautious(distance: Option<f64>, at_least: Option<f64>) -> String {
    match at_least {
        Some(least) if at_least < distance => {
            format!("; {least:.4} if undecided ones are unsafe")
        }
        _ => String::new(),
    }
}

/// What is not known of cells whose runs are cut short; nothing where there are none.
fn cut_short_text(cells: usize) -> String {
    match cells {
        0 => String::new(),
        _ => format!(
            "Cut short {cells}: not known whether safe, as the runs stopped at the impact limit or a standstill \
             (max_impacts sets the limit)\n"
        ),
    }
}

/// Why a plane of starts has no distances from the equilibrium; nothing where it has them.
fn distances_undefined_text(window: &Window) -> String {
    let off = window.keys_off_equilibrium();
    if !window.are_starts() || off.is_empty() {
        return String::new();
    }
    let keys = off.iter().map(|(key, value)| format!("{key} = {value}"));
    let keys = keys.collect::<Vec<_>>().join(", ");
    format!("Nearest   undefined (LIM, IIM): the equilibrium is not in this plane, as {keys}\n")
}

/// An erosion: a row a value, and after an empty line what they come to.
pub fn erosion_summary(erosion: &Erosion) -> String {
    let mut text = format!(
        "{:<12} safe     undecided  of decided  nearest  disc\n",
        erosion.key
    );
    let some_undecided = erosion.neighbours_run() || erosion.is_cut_short();
    for (value, basin) in &erosion.points {
        text += &erosion_row(*value, basin, some_undecided);
    }
    let part = |(value, basin): &(f64, Basin)| {
        let [low, high] = basin.measures.interval;
        let (safe, value) = (basin.measures.gim, six_digits(*value));
        format!(
            "{safe:.4} ({low:.4} to {high:.4}) at {} = {value}",
            erosion.key
        )
    };
    let legal = |(_, basin): &&(f64, Basin)| basin.measures.legal > 0;
    let mut there = erosion.points.iter().filter(legal);
    text.push('\n');
    let _ = match (there.next(), there.next_back()) {
        (Some(first), Some(last)) => writeln!(text, "Safe      {}, {}", part(first), part(last)),
        (Some(only), None) => writeln!(text, "Safe      {}", part(only)),
        (None, _) => Ok(()),
    };
    let _ = writeln!(text, "Knee      {}", knee_text(erosion));
    let mut windows = erosion.points.iter().map(|(_, basin)| &basin.window);
    text += &match windows.next() {
        // The plane moves with the key itself.
        Some(first) if first.are_starts() && START_KEYS.contains(&erosion.key) => format!(
            "Nearest   undefined (LIM, IIM) where one of the other start keys, such as {}, is not 0: the equilibrium \
             is not in that plane\n",
            erosion.key
        ),
        Some(first) => distances_undefined_text(first),
        None => String::new(),
    };
    if !erosion.neighbours_run() {
        text += "Undecided unknown, as neighbours were not run\n";
    }
    text += &cut_short_text(
        erosion
            .points
            .iter()
            .map(|(_, b)| b.measures.cut_short)
            .sum(),
    );
    text
}

fn erosion_row(value: f64, basin: &Basin, some_undecided: bool) -> String {
    let maybe = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
    let m = &basin.measures;
    let (lim, disc) = (maybe(m.lim), maybe(m.integrity_factor));
    let safe = maybe((m.legal > 0).then_some(m.gim));
    let undecided = match basin.neighbours_run {
        true => m.undecided.to_string(),
        false => "-".to_owned(),
    };
    let decided = maybe(m.decided_part().filter(|_| some_undecided));
    let value = six_digits(value);
    format!("{value:<12} {safe:<8} {undecided:<10} {decided:<11} {lim:<8} {disc}\n")
}

/// A value of a grid with at most six digits, as a third between two values has seventeen.
fn six_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// Where the knee is and what it means, or why there is none.
fn knee_text(erosion: &Erosion) -> String {
    let key = erosion.key;
    if erosion
        .points
        .iter()
        .all(|(_, basin)| basin.measures.legal == 0)
    {
        return format!("none, as no start is legal at any value: {NO_START}");
    }
    let (cell, safe) = match (erosion.neighbours_run(), erosion.is_cut_short()) {
        (true, _) => ("decided cell", "safe part of the decided cells"),
        (false, true) => (
            "cell run to its end",
            "safe part of the cells run to their end",
        ),
        (false, false) => ("legal cell", "safe part"),
    };
    let knee = erosion.knee();
    let text = match (knee, erosion.decided().as_slice()) {
        (Some(knee), [(first, part), ..]) => {
            let (knee, first) = (six_digits(knee), six_digits(*first));
            format!(
                "at {key} = {knee}, up to which the {safe} is at least {KNEE} of that at {key} = {first}, {part:.4}"
            )
        }
        (_, []) => format!("none, as no value has a {cell}"),
        (None, [(first, 0.0), ..]) => {
            let first = six_digits(*first);
            format!("none, as no {cell} is safe at the first value, {key} = {first}")
        }
        (None, [(only, _)]) => {
            let only = six_digits(*only);
            format!("none, as {key} = {only} alone has a {cell}, with nothing to compare it with")
        }
        (None, [(first, _), ..]) => {
            let first = six_digits(*first);
            format!("none, as the {safe} never falls below {KNEE} of that at {key} = {first}")
        }
    };
    let beyond = || "beyond the last value".to_owned();
    let place = |value: Option<f64>| value.map_or_else(beyond, six_digits);
    match erosion.knee_between() {
        Some([low, high]) if [low, high] != [knee; 2] => {
            let (low, high) = (place(low), place(high));
            format!("{text}; from {low} to {high}, depending on how undecided cells end")
        }
        _ => text,
    }
}
