//! A quick picture of a study: a line over one key, or a map over two.
use crate::failure::Failure;
use crate::stage::Stage;
use crate::study_input::axes_of;
use crate::sweep::showable;
use snapload::{Value, key_named};
use snapload_figures::{
    Axis as PlotAxis, Cell, FigureError, Layer, Map, Picture, Plot, Range, Stroke, Width, draw,
    draw_map,
};
use snapload_study::{Axis, Column, Shown, columns, folder_of, identity_of, read_shown};
use std::path::{Path, PathBuf};

/// The most cells of a map, and points of a line: more are not seen, and make the file large.
const MOST_CELLS: u64 = 250_000;
/// Pixels per point of a PNG: 300 dpi.
const PNG_SCALE: f32 = 300.0 / 72.0;

/// Which picture.
#[derive(clap::Args)]
pub(crate) struct PictureArgs {
    /// Draw a picture: a line over one key that varies, a map over two
    #[arg(long, value_name = "FILE.svg|png")]
    plot: Option<PathBuf>,
    /// The column to draw; if left out, rho1 as a line, the end as a map
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    show: Option<String>,
}

/// A picture that can be drawn.
struct Wanted {
    path: PathBuf,
    axes: Vec<Axis>,
    column: &'static Column,
}

impl PictureArgs {
    /// Refuses what can not be drawn, before anything is computed.
    pub(crate) fn check(&self, study: &str) -> Result<(), Failure> {
        self.wanted(study).map(|_| ())
    }

    fn wanted(&self, study: &str) -> Result<Option<Wanted>, Failure> {
        let Some(path) = &self.plot else {
            return Ok(None);
        };
        let wrong = |words: String| Failure::BadInput(format!("--plot: {words}"));
        let ending = path.extension().unwrap_or_default();
        if ending != "svg" && ending != "png" {
            let shown = path.display();
            return Err(wrong(format!("{shown} ends neither in .svg nor in .png")));
        }
        folder_of(path).map_err(|error| wrong(error.to_string()))?;
        let axes = axes_of(study).unwrap_or_default();
        let axes: Vec<Axis> = axes.into_iter().filter(|axis| axis.count() > 1).collect();
        if !(1..=2).contains(&axes.len()) {
            let what = "a picture needs a grid over one or two keys";
            return Err(wrong(format!(
                "{what}; read the file with pandas or polars for others"
            )));
        }
        if let Some(axis) = axes.iter().find(|axis| number(&axis.value(0)).is_none()) {
            return Err(wrong(format!(
                "{} holds no numbers to draw along",
                axis.key()
            )));
        }
        let default = if axes.len() == 1 { "rho1" } else { "end" };
        let name = self.show.as_deref().unwrap_or(default);
        let column = columns().iter().find(|column| column.name == name);
        let column = column.ok_or_else(|| {
            let known = showable();
            Failure::BadInput(format!(
                "--show: there is no column {name:?}\nthe columns are {known}"
            ))
        })?;
        if axes.len() == 1 && !column.is_number() {
            return Err(Failure::BadInput(format!(
                "--show: {name} holds no numbers to draw a line of; choose another column"
            )));
        }
        Ok(Some(Wanted {
            path: path.clone(),
            axes,
            column,
        }))
    }

    /// Draws the picture of a finished file, if one is wanted, and says where it is.
    pub(crate) fn draw(&self, file: &Path) -> Result<Option<PathBuf>, Failure> {
        let Some((study, _)) = description_of(file) else {
            return Ok(None);
        };
        let Some(wanted) = self.wanted(&study)? else {
            return Ok(None);
        };
        let picture = wanted.picture(file)?;
        let broken =
            |error: FigureError| Failure::Failed(format!("the picture can not be drawn: {error}"));
        let bytes = if wanted
            .path
            .extension()
            .is_some_and(|ending| ending == "png")
        {
            picture.png(PNG_SCALE).map_err(broken)?
        } else {
            picture.svg().as_bytes().to_vec()
        };
        let mut stage = Stage::default();
        let room = stage.open(folder_of(&wanted.path)?)?;
        stage.write(room, wanted.path.clone(), |out| out.write_all(&bytes))?;
        stage.commit()?;
        Ok(Some(wanted.path))
    }
}

/// The study that a file holds, and how many cases it has.
pub(crate) fn description_of(file: &Path) -> Option<(String, u64)> {
    let identity = identity_of(file)?;
    Some((identity.study, identity.cases))
}

impl Wanted {
    fn picture(&self, file: &Path) -> Result<Picture, Failure> {
        let drawn = match &self.axes[..] {
            [x, y] => self.map(file, x, y)?,
            [x] => self.line(file, x)?,
            _ => Err(FigureError::NoPanel),
        };
        drawn.map_err(|error| Failure::Failed(format!("the picture can not be drawn: {error}")))
    }

    fn line(&self, file: &Path, x: &Axis) -> Result<Result<Picture, FigureError>, Failure> {
        let thin = Thin::of(x, MOST_CELLS);
        let mut at = thin.values(x).into_iter();
        let (mut points, mut faults) = (Vec::new(), Vec::new());
        read_shown(file, self.column, |row, shown| {
            if !row.is_multiple_of(thin.step) {
                return;
            }
            let Some(x) = at.next() else { return };
            let y = match shown {
                Shown::Number(y) => y,
                _ => f64::NAN,
            };
            points.push([x, y]);
            if matches!(shown, Shown::Fault) {
                faults.push(x);
            }
        })?;
        let mut layers: Vec<Layer> = shades(&points, &faults);
        layers.push(Layer::Line {
            pieces: vec![points],
            stroke: Stroke::default(),
            legend: String::new(),
        });
        let plot = Plot {
            description: format!("{} against {}", self.column.name, x.key()),
            x: PlotAxis {
                // Where there is no legal case, too.
                range: range_of(x),
                ..labelled(&key_label(x.key()))
            },
            y: labelled(&self.label()),
            layers,
            ..Plot::default()
        };
        Ok(draw(self.column.name, Width::Page, &[plot]))
    }

    fn map(
        &self,
        file: &Path,
        x: &Axis,
        y: &Axis,
    ) -> Result<Result<Picture, FigureError>, Failure> {
        let side = MOST_CELLS.isqrt();
        // An axis that needs less than its share leaves the rest to the other.
        let of_x = Thin::of(x, side.max(MOST_CELLS / y.count().min(side)));
        let of_y = Thin::of(y, MOST_CELLS / of_x.count(x));
        let mut map = Map {
            description: format!("{} over {} and {}", self.column.name, x.key(), y.key()),
            x: of_x.values(x),
            x_label: key_label(x.key()),
            y: of_y.values(y),
            y_label: key_label(y.key()),
            value_label: self.label(),
            ..Map::default()
        };
        let words = self.column.words();
        map.classes = words.iter().map(|word| word.replace('_', " ")).collect();
        read_shown(file, self.column, |row, shown| {
            let (i, j) = (row / y.count(), row % y.count());
            if i.is_multiple_of(of_x.step) && j.is_multiple_of(of_y.step) {
                map.cells.push(match shown {
                    Shown::Number(value) => Cell::Value(value),
                    Shown::Word(word) => {
                        let class = words.iter().position(|known| *known == word);
                        class.map_or(Cell::Empty, Cell::Class)
                    }
                    Shown::Nothing => Cell::Empty,
                    Shown::Fault => Cell::Fault,
                });
            }
        })?;
        Ok(draw_map(self.column.name, Width::Page, &map))
    }

    fn label(&self) -> String {
        with_unit(self.column.symbol, self.column.unit)
    }
}

/// Every how many-th value of an axis is drawn.
struct Thin {
    step: u64,
}

impl Thin {
    fn of(axis: &Axis, most: u64) -> Self {
        let step = axis.count().div_ceil(most.max(1));
        Self { step }
    }

    fn count(&self, axis: &Axis) -> u64 {
        axis.count().div_ceil(self.step)
    }

    fn values(&self, axis: &Axis) -> Vec<f64> {
        let all = (0..axis.count()).step_by(self.step as usize);
        all.filter_map(|k| number(&axis.value(k))).collect()
    }
}

fn range_of(axis: &Axis) -> Range {
    let [first, last] = [0, axis.count() - 1].map(|k| number(&axis.value(k)).unwrap_or_default());
    Range::AtLeast(first, last)
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        Value::Bool(_) | Value::Text(_) => None,
    }
}

/// Grey where there is no legal case: half the way to the neighbours.
fn shades(points: &[[f64; 2]], faults: &[f64]) -> Vec<Layer> {
    let half = match points {
        [a, b, ..] => (b[0] - a[0]).abs() / 2.0,
        _ => 0.0,
    };
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for x in faults {
        match runs.last_mut() {
            Some(run) if (x - run.1).abs() < 3.0 * half => run.1 = *x,
            _ => runs.push((*x, *x)),
        }
    }
    let shade = |(from, to): (f64, f64)| Layer::Shade {
        from: from.min(to) - half,
        to: from.max(to) + half,
        legend: "no legal case".to_owned(),
    };
    runs.into_iter().map(shade).collect()
}

fn labelled(label: &str) -> PlotAxis {
    PlotAxis {
        label: label.to_owned(),
        ..PlotAxis::default()
    }
}

fn key_label(name: &str) -> String {
    match key_named(name) {
        Ok(key) => {
            // As the report's figures have it: the f of f_o alone in italics.
            let symbol = match key.symbol.split_once("_o") {
                Some((letter, "")) => format!("*{letter}*ₒ"),
                _ => format!("*{}*", key.symbol),
            };
            with_unit(&symbol, key.unit)
        }
        Err(_) => name.to_owned(),
    }
}

fn with_unit(symbol: &str, unit: &str) -> String {
    match unit {
        "" | "1" => symbol.to_owned(),
        unit => format!("{symbol} ({unit})"),
    }
}
