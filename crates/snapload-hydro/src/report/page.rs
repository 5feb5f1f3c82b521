//! The answers as one self-contained page of HTML.

use super::{Report, plots};
use crate::coefficients::FREEDOMS;
use crate::linear::{Mode, Natural};
use askama::Template;
use snapload_figures::{FigureError, Picture};

const STYLE: &str = include_str!("../../templates/hydro.css");

#[derive(Template)]
#[template(path = "hydro.html")]
struct Page<'a> {
    report: &'a Report,
    summary: Vec<(String, String)>,
    command: &'a str,
    pictures: Vec<Picture>,
    periods: Vec<Period>,
}

/// A row of the table of natural motions.
struct Period {
    held: bool,
    freedom: &'static str,
    natural: Natural,
    mode: Mode,
}

/// The page, with `further` rows of a label and a text below those of the report. `command` is the
/// command line that reproduces it.
///
/// # Errors
/// A [`FigureError`] if a picture can not be drawn.
pub fn page(
    report: &Report,
    further: &[(String, String)],
    command: &str,
) -> Result<String, FigureError> {
    let mut periods = Vec::new();
    if let Ok(floating) = &report.floating {
        let free = floating.natural.iter().zip(&floating.modes);
        let free = free.map(|pair| (false, pair));
        let held = floating.rest.iter();
        let held = held.flat_map(|(_, natural, modes)| natural.iter().zip(modes));
        for (held, (natural, mode)) in free.chain(held.map(|pair| (true, pair))) {
            periods.push(Period {
                held,
                freedom: FREEDOMS[natural.freedom],
                natural: natural.clone(),
                mode: mode.clone(),
            });
        }
    }
    let page = Page {
        summary: [report.summary(), further.to_vec()].concat(),
        pictures: plots::all(report)?,
        report,
        command,
        periods,
    };
    Ok(page.to_string())
}

impl Report {
    /// The pictures of the page: added mass, damping, memory, excitation, response.
    ///
    /// # Errors
    /// A [`FigureError`] if one can not be drawn.
    pub fn pictures(&self) -> Result<Vec<Picture>, FigureError> {
        plots::all(self)
    }
}
