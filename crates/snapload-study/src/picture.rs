//! A quick picture of a study: a line over one key, or a map over two.

use crate::error::StudyError;
use crate::parquet_file::ColumnType;
use crate::plan::Axis;
use crate::study_file::{ShownValue, ends, read_shown};
use crate::table::{Column, columns};
use snapload::key_named;
use snapload_figures::{
    Axis as PlotAxis, Cell, Colour, Layer, Map, NOT_CERTAIN, Picture, Plot, Range, Shape, Stroke,
    Width, draw,
};
use std::path::Path;

/// The most cells of a map, and points of a line: more would not be visible, and make the file
/// large.
const MOST_CELLS: u64 = 250_000;

/// A picture of a study.
pub struct StudyPicture {
    axes: Vec<Axis>,
    column: &'static Column,
}

impl StudyPicture {
    /// A picture over the axes of a grid: rho1 as a line over one, the end of the runs as a map
    /// over two.
    ///
    /// # Errors
    /// [`StudyError::Input`] unless one or two axes have several values, which are numbers.
    pub fn over(axes: impl IntoIterator<Item = Axis>) -> Result<Self, StudyError> {
        let axes: Vec<Axis> = axes.into_iter().filter(|axis| axis.count() > 1).collect();
        let column = match axes.len() {
            1 => named("rho1")?,
            2 => named("end")?,
            _ => {
                return Err(StudyError::Input(
                    "a picture needs a grid over one or two keys; read the file with pandas or polars for others"
                        .to_owned(),
                ));
            }
        };
        match axes.iter().find(|axis| axis.value(0).number().is_none()) {
            Some(axis) => Err(StudyError::Input(format!(
                "{} can not be an axis, as its values are not numbers",
                axis.key()
            ))),
            None => Ok(Self { axes, column }),
        }
    }

    /// The same of another column.
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is no such column, or it can not be drawn as a line.
    pub fn showing(self, name: &str) -> Result<Self, StudyError> {
        let column = named(name)?;
        if self.axes.len() == 1 && !column.is_number() {
            return Err(StudyError::Input(format!(
                "{name} can not be drawn as a line, as its values are not numbers; choose another column"
            )));
        }
        Ok(Self { column, ..self })
    }

    /// Draws it from the file of the study.
    ///
    /// # Errors
    /// [`StudyError::Failed`] if the file can not be read.
    pub fn draw(&self, file: &Path) -> Result<Picture, StudyError> {
        let cannot = |error| StudyError::Failed(format!("the picture can not be drawn: {error}"));
        let plot = match &self.axes[..] {
            [x] => self.line(file, x)?,
            [x, y, ..] => self.map(file, x, y)?,
            [] => Plot::default(),
        };
        draw(self.column.name, Width::Page, &[plot]).map_err(cannot)
    }

    fn line(&self, file: &Path, x: &Axis) -> Result<Plot, StudyError> {
        let thinned = Thinned::of(x, MOST_CELLS);
        let mut cells = Vec::new();
        self.read(file, |row, cell, doubt| {
            if row.is_multiple_of(thinned.step) {
                cells.push((cell, doubt));
            }
        })?;
        let layers = line_layers(thinned.values.into_iter().zip(cells).collect());
        // Also if there is no legal case.
        let [first, last] = [0, x.count() - 1].map(|k| x.value(k).number().unwrap_or_default());
        Ok(Plot {
            description: format!("{} against {}", self.column.name, x.key()),
            x: PlotAxis::new(key_label(x.key()), Range::AtLeast(first, last)),
            y: PlotAxis::new(self.label(), Range::Auto),
            layers,
            ..Plot::default()
        })
    }

    fn map(&self, file: &Path, x: &Axis, y: &Axis) -> Result<Plot, StudyError> {
        let side = MOST_CELLS.isqrt();
        // If an axis needs less than its share of the cells, the other gets the rest.
        let of_x = Thinned::of(x, side.max(MOST_CELLS / y.count().min(side)));
        let of_y = Thinned::of(y, MOST_CELLS / of_x.values.len() as u64);
        let (mut cells, mut uncertain) = (Vec::new(), Vec::new());
        self.read(file, |row, cell, doubt| {
            let (i, j) = (row / y.count(), row % y.count());
            if i.is_multiple_of(of_x.step) && j.is_multiple_of(of_y.step) {
                cells.push(match cell {
                    Cell::Value(number) if self.column.name == CABLE => {
                        Cell::Class(number as usize - 1)
                    }
                    cell => cell,
                });
                uncertain.push(doubt);
            }
        })?;
        let is_of_trust = ["horizon_t", "horizon_impact"].contains(&self.column.name);
        let is_trusted = is_of_trust && ends(file)?.judged > 0;
        let map = rising(Map {
            x: of_x.values,
            y: of_y.values,
            cells,
            value_label: self.label(),
            classes: classes(self.column),
            empty: if is_trusted { "trusted to the end" } else { "" }.to_owned(),
            uncertain,
            ..Map::default()
        });
        Ok(Plot {
            description: format!("{} over {} and {}", self.column.name, x.key(), y.key()),
            x: PlotAxis::new(key_label(x.key()), Range::Auto),
            y: PlotAxis::new(key_label(y.key()), Range::Auto),
            layers: vec![Layer::Map(map)],
            ..Plot::default()
        })
    }

    /// Visits the cells in their order, each with whether it is uncertain.
    fn read(&self, file: &Path, mut visit: impl FnMut(u64, Cell, bool)) -> Result<(), StudyError> {
        let words = self.column.words();
        let column = self.column.name;
        read_shown(file, self.column, |row, shown, horizon| {
            let cell = match shown {
                ShownValue::Number(value) => Cell::Value(value),
                ShownValue::Word(word) => {
                    let class = words.iter().position(|known| *known == word);
                    class.map_or(Cell::Empty, Cell::Class)
                }
                ShownValue::Nothing => Cell::Empty,
                ShownValue::Fault => Cell::Illegal,
            };
            visit(row, cell, is_uncertain(column, horizon));
        })
    }

    fn label(&self) -> String {
        with_unit(self.column.symbol, self.column.unit)
    }
}

/// The column with the number of a cable, which is a name and no quantity.
const CABLE: &str = "first_cable";

/// The names of the classes in a map of a column.
fn classes(column: &Column) -> Vec<String> {
    match (column.name, column.column_type()) {
        (CABLE, _) => [1, 2].map(|cable| format!("cable {cable} first")).to_vec(),
        (_, ColumnType::Flags) => {
            let words = column.words().into_iter();
            words
                .map(|word| format!("{}: {word}", column.symbol))
                .collect()
        }
        _ => column
            .words()
            .iter()
            .map(|word| word.replace('_', " "))
            .collect(),
    }
}

/// Whether a column's value of a run is uncertain, given the number of the impact at which trust in
/// the run ends, if it ends before the run does. The first impact is known if it is before that one,
/// and the end of trust itself is known.
fn is_uncertain(column: &str, horizon: Option<i64>) -> bool {
    match column {
        "first_t" | "first_cable" | "first_v_n" => horizon.is_some_and(|impact| impact <= 1),
        "certain" | "horizon_t" | "horizon_impact" => false,
        _ => horizon.is_some(),
    }
}

fn named(name: &str) -> Result<&'static Column, StudyError> {
    let column = columns().iter().find(|column| column.name == name);
    column.ok_or_else(|| {
        let known: Vec<&str> = columns().iter().map(|column| column.name).collect();
        let known = known.join(", ");
        StudyError::Input(format!(
            "there is no column {name:?}\nthe columns are {known}"
        ))
    })
}

/// The values of an axis that are drawn, and the step between them.
struct Thinned {
    step: u64,
    values: Vec<f64>,
}

impl Thinned {
    fn of(axis: &Axis, most: u64) -> Self {
        let step = axis.count().div_ceil(most.max(1));
        let drawn = (0..axis.count()).step_by(step as usize);
        let values = drawn.filter_map(|k| axis.value(k).number()).collect();
        Self { step, values }
    }
}

/// A map with the values of its axes in rising order: the keys may be given in any.
fn rising(map: Map) -> Map {
    let order = |along: &[f64]| {
        let mut order: Vec<usize> = (0..along.len()).collect();
        order.sort_by(|a, b| along[*a].total_cmp(&along[*b]));
        order
    };
    let [of_x, of_y] = [order(&map.x), order(&map.y)];
    let rows = map.y.len();
    let places = || {
        of_x.iter()
            .flat_map(|i| of_y.iter().map(move |j| i * rows + j))
    };
    Map {
        x: of_x.iter().map(|i| map.x[*i]).collect(),
        y: of_y.iter().map(|j| map.y[*j]).collect(),
        cells: places().map(|k| map.cells[k]).collect(),
        uncertain: places().map(|k| map.uncertain[k]).collect(),
        ..map
    }
}

/// The layers of a line over one key, from its values, each with its cell and whether that is
/// uncertain. The key may be given in any order; a value that is not certain has a grey circle.
fn line_layers(mut row: Vec<(f64, (Cell, bool))>) -> Vec<Layer> {
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    let point = |x: f64, cell: &Cell| match cell {
        Cell::Value(value) => [x, *value],
        _ => [x, f64::NAN],
    };
    let points = row.iter().map(|(x, (cell, _))| point(*x, cell)).collect();
    let uncertain = row.iter().filter(|(_, (_, uncertain))| *uncertain);
    let uncertain: Vec<_> = uncertain.map(|(x, (cell, _))| point(*x, cell)).collect();
    let illegal: Vec<_> = (row.iter())
        .map(|(x, (cell, _))| (*x, *cell == Cell::Illegal))
        .collect();
    let mut layers = Layer::shades(&illegal, "no legal case");
    layers.push(Layer::Line(vec![points], Stroke::default(), String::new()));
    if uncertain.iter().any(|point| point[1].is_finite()) {
        let text = NOT_CERTAIN.to_owned();
        layers.push(Layer::Markers(uncertain, Shape::Circle, Colour::GREY, text));
    }
    layers
}

/// The symbol of a key with its unit, for an axis; the name itself if there is no such key.
pub fn key_label(name: &str) -> String {
    let Ok(key) = key_named(name) else {
        return name.to_owned();
    };
    // As in the report's figures, only the f of f_o is italic.
    let symbol = match (key.symbol.split_once("_o"), key.name) {
        (Some((letter, "")), _) => format!("*{letter}*ₒ"),
        // The font of pictures has no dotted letters.
        (_, "vx") => "d*x*/d*t*".to_owned(),
        (_, "vy") => "d*y*/d*t*".to_owned(),
        (_, "vtheta") => "d*θ*/d*t*".to_owned(),
        _ => format!("*{}*", key.symbol),
    };
    with_unit(&symbol, key.unit)
}

/// A symbol with its unit, for an axis; without where it has none.
pub fn with_unit(symbol: &str, unit: &str) -> String {
    match unit {
        "" | "1" => symbol.to_owned(),
        unit => format!("{symbol} ({unit})"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, Layer, Map, is_uncertain, line_layers, rising};

    /// Values that are not certain have a circle each and the words of maps; of cells without a
    /// value there is none. Values in another order than that of the axis make the same line.
    #[test]
    fn a_line_marks_what_is_not_certain() {
        let value = |x: f64, doubt: bool| (x, (Cell::Value(10.0 * x), doubt));
        let row = vec![
            value(0.5, false),
            value(0.9, true),
            value(0.7, false),
            (0.8, (Cell::Empty, true)),
        ];
        let layers = line_layers(row);
        let [Layer::Line(line, ..), Layer::Markers(marked, _, _, words)] = &layers[..] else {
            panic!("{layers:?}");
        };
        let along: Vec<f64> = line[0].iter().map(|point| point[0]).collect();
        assert_eq!(along, [0.5, 0.7, 0.8, 0.9]);
        let marked: Vec<_> = marked.iter().filter(|point| point[1].is_finite()).collect();
        assert_eq!(marked, [&[0.9, 9.0]]);
        assert_eq!(words, "not certain");
        let layers = line_layers(vec![value(0.5, false), value(0.6, false)]);
        assert!(matches!(&layers[..], [Layer::Line(..)]));
    }

    /// Each cell keeps its two values, its contents and its hatching, in whatever order the keys
    /// are given.
    #[test]
    fn a_map_is_drawn_in_the_order_of_its_axes() {
        let (x, y) = ([0.3, 0.1, 0.5], [2.0, 1.0]);
        let pairs: Vec<_> = x.iter().flat_map(|x| y.map(|y| (*x, y))).collect();
        let content = |(x, y): &(f64, f64)| (Cell::Value(10.0 * x + y), *x > 0.2 && *y > 1.5);
        let map = rising(Map {
            x: x.to_vec(),
            y: y.to_vec(),
            cells: pairs.iter().map(|pair| content(pair).0).collect(),
            uncertain: pairs.iter().map(|pair| content(pair).1).collect(),
            ..Map::default()
        });
        assert_eq!(
            (&map.x[..], &map.y[..]),
            (&[0.1, 0.3, 0.5][..], &[1.0, 2.0][..])
        );
        let mut k = 0;
        for x in &map.x {
            for y in &map.y {
                assert_eq!((map.cells[k], map.uncertain[k]), content(&(*x, *y)));
                k += 1;
            }
        }
    }

    /// Trust that ends at a later impact leaves the first one known; what is counted or measured to
    /// the end of the run is not known then.
    #[test]
    fn the_first_impact_is_uncertain_only_where_trust_ends_at_it() {
        for first in ["first_t", "first_cable", "first_v_n"] {
            assert!(is_uncertain(first, Some(1)), "{first}");
            assert!(!is_uncertain(first, Some(2)), "{first}");
        }
        for column in crate::columns() {
            assert!(!is_uncertain(column.name, None), "{}", column.name);
        }
        assert!(is_uncertain("end", Some(150)) && is_uncertain("rho1", Some(2)));
        assert!(!is_uncertain("horizon_t", Some(1)));
    }
}
