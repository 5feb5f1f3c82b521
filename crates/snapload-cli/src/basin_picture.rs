//! What `--plot` draws of basins, erosion and diagrams.
use snapload::{Stop, key_named};
use snapload_figures::{Cell, Colour, Dash, Layer, MOST_CLASSES, Map, Mark, Point, Shape, Stroke};
use snapload_orbits::{Attraction, Basin, CellOutcome, DiagramPoint, Erosion, Window};
use snapload_study::{Values, with_unit};

/// The map of a basin: how each run ends, hatched where it is not decided whether it is safe. Which
/// of two safe ends it is may differ among neighbours without a hatch.
pub(crate) fn basin_layers(basin: &Basin) -> Vec<Layer> {
    let ends = basin.cells.iter();
    let ends = ends.map(|cell| cell.end.map(|(stop, _)| Reached::End(stop)));
    let uncertain = basin.cells.iter().map(|cell| !cell.decided).collect();
    map(
        &basin.window,
        ends,
        Stop::ALL.map(Reached::End).to_vec(),
        (uncertain, "undecided whether safe"),
    )
}

/// The map of the attractors that the cells reach, or of how their runs end, hatched where that is
/// not decided.
pub(crate) fn attraction_layers(found: &Attraction) -> Vec<Layer> {
    let reached = |outcome: &CellOutcome| match outcome {
        CellOutcome::Illegal => None,
        CellOutcome::Attracted(k) => Some(Reached::Attractor(*k)),
        CellOutcome::Aperiodic => Some(Reached::NoPeriod),
        CellOutcome::Stopped(stop, _) => Some(Reached::End(*stop)),
    };
    let outcomes = || found.cells.iter().map(|cell| &cell.outcome);
    let mut classes: Vec<Reached> = outcomes().filter_map(reached).collect();
    classes.sort_unstable();
    classes.dedup();
    let in_colours = in_colours(&classes);
    let mut classes: Vec<Reached> = classes.into_iter().map(&in_colours).collect();
    classes.dedup();
    map(
        &found.window,
        outcomes().map(|outcome| reached(outcome).map(&in_colours)),
        classes,
        (
            found.cells.iter().map(|cell| !cell.decided).collect(),
            "undecided",
        ),
    )
}

/// What a cell reaches; in the order of a legend.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reached {
    Attractor(usize),
    Others { first: usize, last: usize },
    NoPeriod,
    End(Stop),
}

impl Reached {
    fn words(self) -> String {
        match self {
            Self::Attractor(k) => format!("attractor {}", k + 1),
            Self::Others { first, last } => format!("attractors {} to {}", first + 1, last + 1),
            Self::NoPeriod => "no period found".to_owned(),
            Self::End(stop) => stop.label().to_owned(),
        }
    }
}

/// The classes in which those that occur have a colour each: attractors beyond the colours have one
/// together, as others would be taken for another class.
fn in_colours(occurring: &[Reached]) -> impl Fn(Reached) -> Reached + use<> {
    let is_attractor = |class: &&Reached| matches!(class, Reached::Attractor(_));
    let attractors = occurring.iter().filter(is_attractor).count();
    let most = MOST_CLASSES.saturating_sub(occurring.len() - attractors);
    let first = most.saturating_sub(1);
    move |class| match class {
        Reached::Attractor(k) if attractors > most && k >= first => Reached::Others {
            first,
            last: attractors - 1,
        },
        class => class,
    }
}

/// A map of what cells reach, each among these classes; the others are not legal.
fn map(
    window: &Window,
    cells: impl Iterator<Item = Option<Reached>>,
    classes: Vec<Reached>,
    (uncertain, uncertain_words): (Vec<bool>, &str),
) -> Vec<Layer> {
    let place = |reached| classes.iter().position(|class| *class == reached);
    let cell =
        |reached: Option<Reached>| reached.and_then(place).map_or(Cell::Illegal, Cell::Class);
    let [x, y] = window.values.clone();
    vec![Layer::Map(Map {
        x,
        y,
        cells: cells.map(cell).collect(),
        classes: classes.iter().map(|class| class.words()).collect(),
        uncertain,
        uncertain_words: uncertain_words.to_owned(),
        ..Map::default()
    })]
}

/// A column of an erosion over its key. Along the safe part are its interval, the safe part of the
/// decided cells where some are not, and the knee, which is computed from these.
pub(crate) fn erosion_layers(
    erosion: &Erosion,
    columns: &[(&'static str, Values)],
    axes: [&str; 2],
) -> Vec<Layer> {
    let [key, column] = axes;
    let line = |column, stroke, words: &str| {
        let mut points = points(columns, [key, column]);
        for (point, (_, basin)) in points.iter_mut().zip(&erosion.points) {
            if basin.measures.legal == 0 {
                point[1] = f64::NAN;
            }
        }
        let is_known = points.iter().any(|point| point[1].is_finite());
        is_known.then(|| Layer::Line(vec![points], stroke, words.to_owned()))
    };
    if [key, column] != [erosion.key, "gim"] {
        return line(column, Stroke::default(), "").into_iter().collect();
    }
    let solid = Stroke::new(Colour::BLACK, 1.2, Dash::Solid);
    let dotted = Stroke::new(Colour::BLUE, 0.7, Dash::Dotted);
    let dashed = Stroke::new(Colour::VERMILION, 0.9, Dash::Dashed);
    let lines = [
        line("gim", solid, "safe part (GIM)"),
        line("low", dotted, "its 95 % interval"),
        line("high", dotted, "its 95 % interval"),
    ];
    let mut layers: Vec<Layer> = lines.into_iter().flatten().collect();
    let of_decided = erosion.decided();
    let undecided = |(_, basin): &(f64, Basin)| basin.measures.undecided > 0;
    if erosion.points.iter().any(undecided) && !of_decided.is_empty() {
        let points = of_decided.iter().map(|(value, part)| [*value, *part]);
        let words = "of the decided cells".to_owned();
        layers.push(Layer::Line(vec![points.collect()], dashed, words));
    }
    let knee = of_decided
        .iter()
        .find(|(value, _)| Some(*value) == erosion.knee());
    if let Some((value, part)) = knee {
        layers.push(Layer::Letters(vec![Mark::new("knee", [*value, *part])]));
    }
    layers
}

/// The label of a measure of a basin, whose unit may depend on the keys of the window; none for
/// other columns.
pub(crate) fn measure_label(column: &str, keys: [&str; 2]) -> Option<String> {
    let [first, second] = keys.map(|key| key_named(key).map_or("", |key| key.unit));
    let distance = if first == second { first } else { "" };
    let (words, unit) = match column {
        "gim" => ("safe part of the legal cells", ""),
        "lim" => ("distance of the nearest unsafe start", distance),
        "if" => ("radius of the largest disc without unsafe starts", distance),
        "iim" => ("least unsafe velocity", ""),
        _ => return None,
    };
    Some(with_unit(words, unit))
}

/// The section points of a diagram, grey where the motion stops.
pub(crate) fn diagram_layers(
    found: &[DiagramPoint],
    columns: &[(&'static str, Values)],
    [x, y]: [&str; 2],
) -> Vec<Layer> {
    let mut layers = Vec::new();
    if Some(x) == columns.first().map(|(key, _)| *key) {
        let stopped: Vec<_> = found
            .iter()
            .map(|at| (at.value, at.stop().is_some()))
            .collect();
        let uncertain = |at: &DiagramPoint| at.stop_is_certain() == Some(false);
        let words = match found.iter().any(uncertain) {
            true => "the motion stops, not certain at some values",
            false => "the motion stops",
        };
        layers = Layer::shades(&stopped, words);
    }
    let points = points(columns, [x, y]);
    let has_place = |[x, y]: &Point| x.is_finite() && y.is_finite();
    if points.iter().any(has_place) {
        layers.push(Layer::Markers(
            points,
            Shape::Circle,
            Colour::BLACK,
            String::new(),
        ));
    }
    layers
}

/// The columns of a table that are numbers.
pub(crate) fn numeric(columns: &[(&'static str, Values)]) -> Vec<&'static str> {
    let number = |values: &Values| matches!(values, Values::Numbers(_) | Values::Counts(_));
    columns
        .iter()
        .filter(|(_, values)| number(values))
        .map(|(name, _)| *name)
        .collect()
}

/// Two columns as points; not finite where one has no value.
fn points(columns: &[(&'static str, Values)], [x, y]: [&str; 2]) -> Vec<Point> {
    let column = |name: &str| -> Vec<f64> {
        let found = columns.iter().find(|(known, _)| *known == name);
        match found.map(|(_, values)| values) {
            Some(Values::Numbers(list)) => list.iter().map(|v| v.unwrap_or(f64::NAN)).collect(),
            Some(Values::Counts(list)) => list
                .iter()
                .map(|v| v.map_or(f64::NAN, |v| v as f64))
                .collect(),
            _ => Vec::new(),
        }
    };
    column(x)
        .into_iter()
        .zip(column(y))
        .map(Point::from)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{MOST_CLASSES, Reached, in_colours};
    use snapload::Stop;

    /// No two classes of a map have the same colour, however many attractors there are.
    #[test]
    fn attractors_beyond_the_colours_have_one_together() {
        for attractors in 0..20 {
            let all = (0..attractors).map(Reached::Attractor);
            let all = all.chain([Reached::NoPeriod, Reached::End(Stop::UpperBound)]);
            let occurring: Vec<Reached> = all.collect();
            let shown = in_colours(&occurring);
            let mut classes: Vec<Reached> = occurring.iter().map(|class| shown(*class)).collect();
            classes.dedup();
            assert_eq!(classes.len(), occurring.len().min(MOST_CLASSES));
            let words: Vec<String> = classes.iter().map(|class| class.words()).collect();
            let together = format!("attractors 5 to {attractors}");
            assert_eq!(words.contains(&together), attractors > 5, "{words:?}");
        }
    }
}
