//! The results as a page for a design note: one self-contained file of HTML. Its texts are in
//! `templates/`.

mod inputs;
mod layout;
mod plots;

pub use crate::runs::scan::{LENGTH, Scan, ScanCell, scan};
pub use inputs::inputs;
pub use plots::window;

use crate::physics::model_at_rest::ModelAtRest;
use crate::physics::periods::periods_text;
use crate::physics::snap::Snap;
use crate::physics::warning::Warning;
use crate::report::{Verdict, end_text};
use crate::runs::assess::Assessment;
use crate::runs::design::Check;
use crate::runs::gumbel::{Estimate, Gumbel};
use crate::runs::seas::{Lines, Seas};
use crate::runs::three_hours::NoDistribution;
use crate::structure::Structure;
use crate::text_layout::{digits, kilo, kilo_or_not_known, rate_text, ratio, tenths};
use askama::Template;
use inputs::resistance;
use snapload_figures::{FigureError, Picture};
use std::fmt;

/// Readable on a phone, in print, in light and dark.
const STYLE: &str = include_str!("../../templates/note.css");
/// The number of the hardest snaps in the list.
const LISTED: usize = 12;
/// Snaps that differ by less than this part are listed once.
const EQUAL_WITHIN: f64 = 1e-3;

/// The origin of a note.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The name of the case.
    pub name: &'a str,
    /// The command line that reproduces the note.
    pub command: &'a str,
    /// SHA-256 of the case's file, as `sha256sum` prints it; none where there is no file.
    pub sha256: Option<&'a str>,
}

#[derive(Template)]
#[template(path = "note.html")]
struct NotePage<'a> {
    title: &'static str,
    source: Source<'a>,
    warnings: &'a [Warning],
    layout: Picture,
    prepared: &'a ModelAtRest,
    /// Whether the lines are elastic.
    elastic: bool,
    class: &'static str,
    note: &'a Assessment,
    structure: &'a Structure,
    verdict: Verdict,
    utilisations: Vec<Option<f64>>,
    end: &'static str,
    /// Path, snaps, tension, rotation and the water's surface, in the time shown.
    plots: Vec<Picture>,
    hardness: plots::Hardness,
    window: [f64; 2],
    /// The hardest judged snaps out of `all`, each with the number of equal ones.
    hardest: Vec<(&'a Snap, usize)>,
    all: usize,
    horizon_s: f64,
    /// The checks by the rule of the case, and the neighbours that agree with each.
    checks: Vec<(Check, usize)>,
    /// The map of other waves, if there is one.
    scanned: Option<Picture>,
}

#[derive(Template)]
#[template(path = "sea-note.html")]
struct SeaPage<'a> {
    title: &'static str,
    source: Source<'a>,
    warnings: &'a [Warning],
    layout: Picture,
    prepared: &'a ModelAtRest,
    /// Whether the lines are elastic.
    elastic: bool,
    class: &'static str,
    seas: &'a Seas,
    structure: &'a Structure,
    /// Part of the time that each line is slack.
    slack: Vec<f64>,
    /// The largest tension of each line, where it is known.
    largest_n: Vec<Option<f64>>,
    /// Whether a record lasts until judging begins.
    judged: bool,
    /// Whether the plots are of tensions, and not of speeds.
    tensions: bool,
    plots: [Picture; 2],
}

/// The page.
///
/// # Errors
/// A [`FigureError`] if a plot can not be drawn.
pub fn page(
    source: Source<'_>,
    assessment: &Assessment,
    scan: Option<&Scan>,
) -> Result<String, FigureError> {
    let prepared = &assessment.prepared;
    let verdict = assessment.verdict();
    let mut hardest: Vec<&Snap> = assessment.judged().collect();
    let all = hardest.len();
    hardest.sort_by(|a, b| b.by_hardness(a));
    let mut hardest = group_equal(&hardest);
    hardest.truncate(LISTED);
    hardest.sort_by(|(a, _), (b, _)| a.t_s.total_cmp(&b.t_s));
    let scanned = scan.map(|scan| plots::of_scan(scan, &prepared.structure));
    let page = NotePage {
        title: "Mooring note",
        source,
        warnings: &assessment.warnings,
        layout: layout::of(prepared)?,
        prepared,
        elastic: false,
        class: verdict.standing.class(),
        note: assessment,
        structure: &prepared.structure,
        verdict,
        utilisations: assessment.utilisations(),
        end: end_text(assessment.outcome.stop),
        plots: plots::of_run(assessment)?,
        hardness: plots::hardness(assessment),
        window: plots::window(assessment),
        hardest,
        all,
        horizon_s: assessment.horizon_s().unwrap_or(f64::INFINITY),
        checks: assessment.checks(),
        scanned: scanned.transpose()?,
    };
    Ok(page.to_string())
}

/// The first of each group of equal snaps, as a regular motion repeats them, and their number:
/// consecutive snaps of one line that are equal within the digits shown.
fn group_equal<'a>(snaps: &[&'a Snap]) -> Vec<(&'a Snap, usize)> {
    let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= EQUAL_WITHIN * a.abs().max(b.abs()),
        (a, b) => a == b,
    };
    let mut groups: Vec<(&Snap, usize)> = Vec::new();
    for snap in snaps {
        let same = groups.iter_mut().rev().take(LISTED).find(|(first, _)| {
            first.line == snap.line
                && first.is_impact_while_taut == snap.is_impact_while_taut
                && near(first.peak_n, snap.peak_n)
                && near(
                    Some(first.effective_speed_m_s),
                    Some(snap.effective_speed_m_s),
                )
        });
        match same {
            Some((first, count)) => {
                *count += 1;
                *first = if snap.t_s < first.t_s { snap } else { first };
            }
            None => groups.push((snap, 1)),
        }
    }
    groups
}

/// The page of many records of a sea.
///
/// # Errors
/// A [`FigureError`] if a plot can not be drawn.
pub fn seas_page(source: Source<'_>, seas: &Seas) -> Result<String, FigureError> {
    let page = SeaPage {
        title: "Sea note",
        source,
        warnings: &seas.warnings,
        layout: layout::of(&seas.prepared)?,
        prepared: &seas.prepared,
        elastic: seas.lines == Lines::Elastic,
        class: seas.standing().class(),
        seas,
        structure: &seas.prepared.structure,
        slack: seas.slack_fractions(),
        largest_n: seas.largest_of_lines_n(),
        judged: seas.judged_s() > 0.0,
        tensions: seas.largest_n().is_some(),
        plots: plots::of_seas(seas)?,
    };
    Ok(page.to_string())
}

/// Escapes what HTML would read as markup.
#[derive(Clone, Copy)]
pub(crate) struct Escaper;

impl askama::filters::Escaper for Escaper {
    fn write_escaped_str<W: fmt::Write>(&self, mut to: W, text: &str) -> fmt::Result {
        text.chars().try_for_each(|character| match character {
            '&' => to.write_str("&amp;"),
            '<' => to.write_str("&lt;"),
            '>' => to.write_str("&gt;"),
            '"' => to.write_str("&quot;"),
            other => to.write_char(other),
        })
    }
}

fn part_or_not_known(part: &Option<f64>) -> String {
    part.map_or("not known".to_owned(), |part| ratio(&part))
}

fn value_or_not_known(value: &Option<f64>) -> String {
    value.map_or("not known".to_owned(), |value| format!("{value:.3}"))
}

/// The mean and the values that 50, 90 and 99 % stay below.
fn expected(fit: Result<Gumbel, NoDistribution>, unit: f64, digits: usize) -> [String; 4] {
    let cell = |estimate: Estimate| estimate.text_with_error(unit, digits);
    match fit {
        Ok(fit) => {
            let [half, most, nearly_all] = [0.5, 0.9, 0.99].map(|p| cell(fit.quantile(p)));
            [cell(fit.mean()), half, most, nearly_all]
        }
        Err(_) => ["not known", "", "", ""].map(str::to_owned),
    }
}
