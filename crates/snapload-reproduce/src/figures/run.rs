//! Figures of single runs: Figs 6.1-6.26, 6.43 and 6.45.

use super::{About, Listed, Row, Shows, Source};
use crate::ReportError;
use crate::study::{CaseRuns, Known, Reading, Study};
use crate::tables::outcome;
use serde::Deserialize;
use snapload::Mode;
use snapload_figures::{Inset, Layer, Mark, Plot, Range, RunPlot, RunPlots};

/// A figure of a run of Table 6.1.
#[derive(Deserialize)]
pub(super) struct RunFigure {
    case: String,
    view: View,
    /// The size of a path's window, relative to that of Figs 6.1-6.6.
    #[serde(default = "one")]
    window: f64,
    /// Whether the time axis differs from that of the row.
    #[serde(default)]
    own_time_axis: bool,
    /// Whether the motion fills so little of the window that it is shown enlarged as well.
    #[serde(default)]
    enlarged: bool,
    #[serde(default)]
    remark: String,
}

fn one() -> f64 {
    1.0
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum View {
    Path,
    Rotation,
    Snaps,
}

impl View {
    /// The names of its points and its picture among the files of `snapload run --out`.
    fn place(self) -> &'static str {
        match self {
            Self::Path => "x and y in motion.csv; trajectory.svg",
            Self::Rotation => "t and theta in motion.csv; rotation.svg",
            Self::Snaps => "t and v_n in impacts.csv; snaps.svg",
        }
    }
}

/// The window that Figs 6.1-6.6 share: x from, x to, y from, y to.
const WINDOW: [f64; 4] = [-0.8, 0.8, -0.05, 0.8];

/// The least ranges of the axes of the figures of a row.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    t: f64,
    v_n: f64,
    /// The largest number of snaps of a figure, which determines the size of markers.
    snaps: usize,
}

impl Axes {
    pub(super) fn shared(study: &Study, row: &Row<Listed>) -> Result<Self, ReportError> {
        let mut axes = Self {
            t: 0.0,
            v_n: 0.0,
            snaps: 0,
        };
        for figure in &row.figures {
            if let Shows::Run(figure) = &figure.shows {
                let run = &figure.case(study)?.runs.chapter.run;
                axes.v_n = axes.v_n.max(run.norms().rho1);
                axes.snaps = axes.snaps.max(run.impacts().len());
                if !figure.own_time_axis {
                    axes.t = axes.t.max(run.end().t);
                }
            }
        }
        Ok(axes)
    }
}

impl RunFigure {
    fn case<'a>(&self, study: &'a Study) -> Result<&'a CaseRuns, ReportError> {
        let case = study.case(&self.case);
        case.ok_or_else(|| ReportError::Missing(format!("the case {}", self.case)))
    }

    pub(super) fn draw(
        &self,
        name: &str,
        study: &Study,
        axes: Axes,
    ) -> Result<(Plot, About), ReportError> {
        let (plot, what) = match self.view {
            View::Path => (RunPlot::Trajectory, "Path of the body's centre"),
            View::Rotation => (RunPlot::Rotation, "Rotation against time"),
            View::Snaps => (
                RunPlot::Snaps,
                "Normal velocity before each snap against time",
            ),
        };
        let case = self.case(study)?;
        let known = &case.runs.chapter;
        let mut plot = RunPlots::new(&known.run)
            .with_horizon(known.horizon)
            .plot(plot);
        if self.enlarged {
            plot.inset = Some(Box::new(enlarged(&mut plot)));
        }
        if self.view == View::Path {
            let [left, right, bottom, top] = WINDOW.map(|side| side * self.window);
            plot.x.range = Range::Fixed(left, right);
            plot.y.range = Range::Fixed(bottom, top);
        } else if !self.own_time_axis {
            plot.x.range = Range::AtLeast(0.0, axes.t);
        }
        if self.view == View::Snaps {
            // With room for a whole marker at the top.
            plot.y.range = Range::AtLeast(0.0, 1.05 * axes.v_n);
            plot.markers = axes.snaps;
        }
        let (p, code, remark) = (&case.parameters, case.code, &self.remark);
        let caption = format!(
            "{what}, case {code}: r = {}, e = {}, a = {}, b = {}, f_o = {}, Ω = {}.{remark}{}",
            p.r,
            p.e,
            p.a,
            p.b,
            p.f_o,
            p.omega,
            horizon_remark(known)
        );
        let option = Reading::Chapter.option();
        let command = format!("snapload run --case {code}{option} --out {name}");
        let about = About {
            caption,
            numbers: ["Ends: ", "t = "]
                .into_iter()
                .zip(outcome(case, Reading::Chapter))
                .collect(),
            sources: Source::whole(command, self.view.place()),
        };
        Ok((plot, about))
    }
}

/// A path as an inset, with the letters of the plot, which then has none; the boundaries keep their
/// names outside the inset.
fn enlarged(plot: &mut Plot) -> Inset {
    let mut whole = plot.clone();
    plot.layers
        .retain(|layer| !matches!(layer, Layer::Letters(_)));
    for layer in &mut whole.layers {
        if let Layer::Boundary(_, name) = layer {
            name.clear();
        }
    }
    Inset {
        plot: whole,
        place: [0.3, 0.38, 0.985, 0.98],
    }
}

/// The path of the sliding or the rocking example.
#[derive(Deserialize)]
pub(super) struct Example {
    case: String,
    /// Its name in the chapter.
    chapter: String,
}

impl Example {
    pub(super) fn draw(&self, study: &Study, name: &str) -> Result<(Plot, About), ReportError> {
        let Self { case, chapter } = self;
        let known = match case.as_str() {
            "sliding-example" => &study.sliding,
            "rocking-example" => &study.rocking,
            other => return Err(ReportError::Missing(format!("the example {other}"))),
        };
        let (run, plots) = (&known.run, RunPlots::new(&known.run));
        let still = match run.modes().last().map(|mode| mode.taut.mode()) {
            Some(Mode::Rocking) => ", where it still rocks",
            _ => "",
        };
        let mut plot = plots.with_horizon(known.horizon).plot(RunPlot::Trajectory);
        plot.inset = enlargement_of_coinciding_points(&plot).map(Box::new);
        let inset = match plot.inset {
            Some(_) => " The inset enlarges the place of S, G and R.",
            None => "",
        };
        let caption = format!(
            "Path of the body's centre in the {case} ({chapter}), the settling rule off: I start, S sliding \
             starts, G the other boundary is hit while one cable is taut, R rocking starts, E the end at \
             t = {}{still}.{inset}{}",
            run.end().t,
            horizon_remark(known)
        );
        let command = format!("snapload run --case {case} --out {name}");
        let about = About {
            caption,
            numbers: Vec::new(),
            sources: Source::whole(command, View::Path.place()),
        };
        Ok((plot, about))
    }
}

/// An enlargement of the place where S, G and R almost coincide, so that they can be distinguished.
fn enlargement_of_coinciding_points(plot: &Plot) -> Option<Inset> {
    /// The margin around that place, as a part of its size: so small that S and G, which follow
    /// each other closely, are two dots.
    const MARGIN: f64 = 0.2;
    /// Letters almost coincide within this part of the distance of all letters.
    const ONE_PLACE: f64 = 1e-2;
    let marks = plot.layers.iter().find_map(|layer| match layer {
        Layer::Letters(marks) => Some(marks),
        _ => None,
    })?;
    let some: Vec<&Mark> = marks
        .iter()
        .filter(|mark| "SGR".contains(&mark.letter))
        .collect();
    let range = |points: &mut dyn Iterator<Item = f64>| {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        points.fold((least, most), |(p, q), v| (p.min(v), q.max(v)))
    };
    let [x, y] = [0, 1].map(|k| range(&mut some.iter().map(|mark| mark.at[k])));
    let whole = range(&mut marks.iter().map(|mark| mark.at[0]));
    let size = (x.1 - x.0).max(y.1 - y.0);
    if some.len() < 2 || size > ONE_PLACE * (whole.1 - whole.0) || size <= 0.0 {
        return None;
    }
    let Inset { plot: mut part, .. } = enlarged(&mut plot.clone());
    let about = |(from, to): (f64, f64)| Range::Fixed(from - MARGIN * size, to + MARGIN * size);
    (part.x.range, part.y.range) = (about(x), about(y));
    Some(Inset {
        plot: part,
        place: [0.02, 0.5, 0.42, 0.98],
    })
}

/// A remark on a picture that is partly past the horizon of its run.
fn horizon_remark(known: &Known) -> String {
    match known.horizon {
        Some(t) => format!(
            " In doubles the motion is known up to t = {t:.2}; later parts are marked in grey."
        ),
        None => String::new(),
    }
}
