//! The chapter's figures, each under its number, from the list in `data/figures.toml`.

mod curves;
mod run;
mod state;

use crate::ReportError;
use crate::source::Number;
use crate::study::Study;
use curves::{Curve, Key, Norms};
use run::{Axes, Example, RunFigure};
use serde::Deserialize;
use snapload_figures::{Layer, Picture, Plot, Point, Width, draw};
use state::StateFigure;
use std::collections::HashMap;

/// The contents of `data/figures.toml`.
#[derive(Deserialize)]
struct Lists {
    keys: HashMap<String, Key>,
    norms: HashMap<String, Norms>,
    row: Vec<Row<Listed>>,
}

/// Figures that the chapter compares, which are shown side by side.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Row<Figure> {
    /// Their common title.
    pub(crate) title: String,
    /// The number of figures side by side if there is room.
    pub(crate) columns: usize,
    pub(crate) figures: Vec<Figure>,
}

#[derive(Deserialize)]
struct Listed {
    number: String,
    #[serde(flatten)]
    shows: Shows,
}

/// The contents of a figure.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Shows {
    /// A run of Table 6.1.
    Run(RunFigure),
    /// Critical force over a key.
    Critical(Curve),
    /// Norms over the force amplitude.
    Norms(Curve),
    /// Body and cables at an instant.
    State(StateFigure),
    /// The path of the sliding or the rocking example.
    Example(Example),
}

/// A figure of the report.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// The chapter's number, such as `6.12`.
    pub(crate) number: String,
    pub(crate) picture: Picture,
    /// The points behind it, as CSV.
    pub(crate) data: String,
    pub(crate) about: About,
}

/// The texts about a figure.
#[derive(Clone, Debug)]
pub(crate) struct About {
    /// What it shows, in our words.
    pub(crate) caption: String,
    /// The results of its run, each with its name.
    pub(crate) numbers: Vec<(&'static str, Number)>,
    /// The commands that compute it.
    pub(crate) sources: Vec<Source>,
}

/// A command that computes a figure, or a part of it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// The part; empty for the whole figure.
    pub(crate) part: &'static str,
    pub(crate) command: String,
    /// Where the points are in the output of the command.
    pub(crate) place: String,
}

impl Source {
    /// One source for a whole figure.
    fn whole(command: String, place: &str) -> Vec<Self> {
        vec![Self {
            part: "",
            command,
            place: place.to_owned(),
        }]
    }
}

/// Draws all of them, in the chapter's order.
pub(crate) fn figures(study: &Study) -> Result<Vec<Row<Figure>>, ReportError> {
    let lists: Lists = toml::from_str(include_str!("../data/figures.toml"))?;
    let row = |row: &Row<Listed>| {
        let axes = Axes::shared(study, row)?;
        // A figure that has a row of its own has the width of the page.
        let page = if row.columns == 1 {
            Width::Page
        } else {
            Width::Column
        };
        let figure = |figure: &Listed| figure.draw(study, &lists, axes, page);
        Ok(Row {
            title: row.title.clone(),
            columns: row.columns,
            figures: row
                .figures
                .iter()
                .map(figure)
                .collect::<Result<_, ReportError>>()?,
        })
    };
    lists.row.iter().map(row).collect()
}

impl Listed {
    fn draw(
        &self,
        study: &Study,
        lists: &Lists,
        axes: Axes,
        page: Width,
    ) -> Result<Figure, ReportError> {
        let name = format!("figure-{}", self.number.replace('.', "-"));
        let (mut plot, about) = match &self.shows {
            Shows::Run(run) => run.draw(&name, study, axes)?,
            Shows::Critical(curve) => curve.critical(study, lists)?,
            Shows::Norms(curve) => curve.norms(study, lists)?,
            Shows::State(state) => state.draw(study)?,
            Shows::Example(example) => example.draw(study, &name)?,
        };
        // Each figure has a title for readers who can not see it.
        plot.description = format!("Fig. {}. {}", self.number, about.caption);
        Ok(Figure {
            number: self.number.clone(),
            data: csv(&plot),
            picture: draw(&name, page, &[plot])?,
            about,
        })
    }
}

/// The points of a plot: series, piece, x, y.
fn csv(plot: &Plot) -> String {
    let mut text = String::from("series,piece,x,y\n");
    let mut add = |series: &str, piece: usize, points: &[Point]| {
        let series = series.replace([',', '*'], "");
        for [x, y] in points {
            text.push_str(&format!("{series},{piece},{x},{y}\n"));
        }
    };
    for layer in &plot.layers {
        match layer {
            Layer::Line(pieces, _, legend) => {
                let series = if legend.is_empty() { "line" } else { legend };
                for (k, points) in pieces.iter().enumerate() {
                    add(series, k, points);
                }
            }
            Layer::Markers(points, .., legend) => add(legend, 0, points),
            Layer::Boundary(points, label) => add(label, 0, points),
            _ => {}
        }
    }
    text
}
