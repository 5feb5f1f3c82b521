//! `--plot` and `--show` of sections, branches, curves, erosion and
//! diagrams, and `--plot` of basins.
use crate::failure::Failure;
use crate::outputs::{OutFile, Outputs};
use snapload::{key_named, quantity};
use snapload_figures::{
    Axis, Colour, Dash, FigureError, Layer, Mark, PNG_SCALE, Plot, Point, Range, Stroke, Width,
    draw,
};
use snapload_orbits::{BranchEvent, Kind, Orbit, Stability};
use snapload_study::{key_label, with_unit};
use std::path::{Path, PathBuf};

/// Which picture, and where it goes.
#[derive(clap::Args)]
pub(crate) struct PlotArgs {
    /// Draw a picture, FILE.svg or FILE.png
    #[arg(long, value_name = "FILE.svg|png")]
    plot: Option<PathBuf>,
    /// Numeric columns of the table to draw: the vertical axis, or the
    /// horizontal and the vertical axis
    #[arg(long, value_name = "COLUMN[,COLUMN]", requires = "plot")]
    show: Option<String>,
}

/// A picture that is to be drawn.
pub(crate) struct PlotFile {
    file: OutFile,
    /// The columns on the horizontal and the vertical axis.
    pub(crate) axes: [String; 2],
    /// The phase of the forcing at which the drawn period begins, if one is drawn.
    pub(crate) phase_from: f64,
    /// The values of the key on the horizontal axis, which it shows also where nothing is drawn.
    along: Option<[f64; 2]>,
    /// The label of the vertical axis, if the column's own does not do.
    pub(crate) upwards: Option<String>,
}

impl PlotArgs {
    /// Opens the place, and checks the columns, so that errors are known before anything is
    /// computed; none if no picture is wanted.
    pub(crate) fn open(
        &self,
        outputs: &mut Outputs,
        usual: [&str; 2],
        known: &[&str],
    ) -> Result<Option<PlotFile>, Failure> {
        let Some(plot) = PlotFile::open(outputs, self.plot.as_deref(), usual)? else {
            return Ok(None);
        };
        let shown = self.show.as_deref().unwrap_or_default();
        let words: Vec<&str> = shown.split(',').map(str::trim).collect();
        let axes = match words[..] {
            [""] => usual,
            [upwards] => [usual[0], upwards],
            [right, upwards] => [right, upwards],
            _ => return Err(no_columns(shown, known)),
        };
        if !axes.iter().all(|name| known.contains(name)) {
            return Err(no_columns(shown, known));
        }
        Ok(Some(PlotFile {
            axes: axes.map(str::to_owned),
            ..plot
        }))
    }
}

fn no_columns(shown: &str, known: &[&str]) -> Failure {
    Failure::BadInput(format!(
        "--show {shown:?}: write one or two of the columns {}, with a comma between two",
        known.join(", ")
    ))
}

impl PlotFile {
    /// Opens the place of a picture with these axes; none if no picture is wanted.
    pub(crate) fn open(
        outputs: &mut Outputs,
        path: Option<&Path>,
        axes: [&str; 2],
    ) -> Result<Option<Self>, Failure> {
        let file = outputs.file("--plot", path, &["svg", "png"])?;
        Ok(file.map(|file| Self {
            file,
            axes: axes.map(str::to_owned),
            phase_from: 0.0,
            along: None,
            upwards: None,
        }))
    }

    /// The columns on its axes.
    pub(crate) fn axes(&self) -> [&str; 2] {
        self.axes.each_ref().map(String::as_str)
    }

    /// Shows all values of a key if that is on the horizontal axis, also where nothing is drawn.
    pub(crate) fn spans(&mut self, key: &str, values: &[f64]) {
        if let ([first, .., last], true) = (values, self.axes[0] == key) {
            self.along = Some([first.min(*last), first.max(*last)]);
        }
    }

    /// The position of a column's value: a phase is moved into the drawn period.
    pub(crate) fn placed(&self, column: &str, value: f64) -> f64 {
        match column {
            "phase" => value - (value - self.phase_from).floor(),
            _ => value,
        }
    }

    /// The range of a phase is the whole period and a little more, so that no marker is cut off.
    fn range(&self, column: &str) -> Range {
        const MORE: f64 = 0.015;
        match column {
            "phase" => Range::Fixed(self.phase_from - MORE, self.phase_from + 1.0 + MORE),
            "gim" => Range::AtLeast(0.0, 1.0),
            _ => Range::Auto,
        }
    }

    /// Draws the layers and adds the picture to the outputs.
    pub(crate) fn add_to(
        self,
        outputs: &mut Outputs,
        title: &str,
        layers: Vec<Layer>,
    ) -> Result<(), Failure> {
        let cannot = |error: FigureError| {
            Failure::Failed(format!("--plot: the picture can not be drawn: {error}"))
        };
        let [x, y] = &self.axes;
        let empty = layers.is_empty();
        let along = self.along.map(|[first, last]| Range::AtLeast(first, last));
        let upwards = self.upwards.clone().unwrap_or_else(|| label(y));
        let plot = Plot {
            title: title.to_owned(),
            description: format!("{y} against {x}"),
            x: Axis::new(label(x), along.unwrap_or(self.range(x))),
            y: Axis::new(upwards, self.range(y)),
            layers,
            note: if empty { "nothing to draw" } else { "" }.to_owned(),
            ..Plot::default()
        };
        let picture = draw("orbits", Width::Page, &[plot]).map_err(cannot)?;
        let bytes = match self.file.ending {
            "png" => picture.png(PNG_SCALE).map_err(cannot)?,
            _ => picture.svg().as_bytes().to_vec(),
        };
        outputs.write(self.file, |out| out.write_all(&bytes))
    }
}

/// The label of an axis: a key's, or that of a quantity, with the unit.
fn label(column: &str) -> String {
    let named = |name: &str| {
        let of_orbits = snapload_orbits::QUANTITIES.iter();
        let known = quantity(name).or_else(|| of_orbits.into_iter().find(|q| q.name == name));
        match known.filter(|_| key_named(name).is_err()) {
            Some(quantity) => with_unit(&quantity.symbol.replace('_', " "), quantity.unit),
            None => key_label(name).replace('_', " "),
        }
    };
    if column == "phase" {
        return "phase of the forcing, *t*/*T*".to_owned();
    }
    for (side, words) in [
        ("_before", "before the impact"),
        ("_after", "after the impact"),
    ] {
        if let Some(key) = column.strip_suffix(side) {
            return format!("{} {words}", named(key));
        }
    }
    match column.strip_prefix("least_") {
        Some(name) => format!("least {}", named(name)),
        None => named(column),
    }
}

/// An orbit of a branch, for drawing.
pub(crate) struct Drawn<'a> {
    /// Its position.
    pub(crate) at: Point,
    pub(crate) orbit: &'a Orbit,
    pub(crate) stability: Stability,
    /// The event, if it is a special point.
    pub(crate) event: Option<&'a BranchEvent>,
}

/// The strokes of each sort of orbits: stable, neutral, unstable and inadmissible ones.
const STROKES: [Stroke; 4] = [
    Stroke::new(Colour::BLACK, 1.3, Dash::Solid),
    Stroke::new(Colour::GREEN, 1.0, Dash::Solid),
    Stroke::new(Colour::BLUE, 0.9, Dash::Dashed),
    Stroke::new(Colour::VERMILION, 0.8, Dash::Dotted),
];

fn sort(drawn: &Drawn) -> usize {
    sort_of(drawn.stability, drawn.orbit.is_admissible())
}

fn sort_of(stability: Stability, is_admissible: bool) -> usize {
    match stability {
        _ if !is_admissible => 3,
        Stability::Stable | Stability::Superstable => 0,
        Stability::Neutral => 1,
        Stability::Unstable => 2,
    }
}

/// The sort of the orbits from one point of a branch to the next one, `all[k]` and `all[k + 1]`. A
/// special point is at the border of two sorts: then the other point has it. Between two special
/// points an orbit has what changes at neither: whether it is admissible does not change at a
/// bifurcation, and its stability only there. What changes at both is that of the nearest other
/// point.
fn sort_between(all: &[Drawn], k: usize) -> usize {
    let pair = || [&all[k + 1], &all[k]].into_iter();
    let is_regular = |drawn: &&Drawn| drawn.event.is_none();
    if let Some(regular) = pair().find(is_regular) {
        return sort(regular);
    }
    let beyond = all[k + 1..].iter().find(is_regular);
    let nearest = beyond.or(all[..k].iter().rfind(is_regular));
    let nearest = nearest.unwrap_or(&all[k]);
    let bifurcates = |drawn: &&Drawn| drawn.event.is_some_and(BranchEvent::is_bifurcation);
    let keeps = |drawn: &&Drawn| !bifurcates(drawn) || drawn.stability == Stability::Unstable;
    let stability = pair().find(keeps).unwrap_or(nearest).stability;
    let admissible = pair().find(bifurcates).unwrap_or(nearest);
    sort_of(stability, admissible.orbit.is_admissible())
}

/// A branch as a line, which is broken where `jumps` and changes with the sort of orbit, and its
/// special points with names.
pub(crate) fn branch_layers(all: &[Drawn], jumps: bool, words: [&str; 4]) -> Vec<Layer> {
    let mut pieces: [Vec<Vec<Point>>; 4] = Default::default();
    let mut last = None;
    for (k, [from, to]) in all.array_windows().enumerate() {
        let other = sort_between(all, k);
        let symbols = [from, to].map(|drawn| drawn.orbit.lap.sequence.symbol());
        if jumps && symbols[0] != symbols[1] {
            last = None;
            continue;
        }
        let lines = &mut pieces[other];
        match lines.last_mut().filter(|_| last == Some(other)) {
            Some(line) => line.push(to.at),
            None => lines.push(vec![from.at, to.at]),
        }
        last = Some(other);
    }
    let mut layers = Vec::new();
    for (lines, (words, stroke)) in pieces.into_iter().zip(words.into_iter().zip(STROKES)) {
        if !lines.is_empty() {
            layers.push(Layer::Line(lines, stroke, words.to_owned()));
        }
    }
    let events = all
        .iter()
        .filter_map(|drawn| drawn.event.map(|event| (event, drawn.at)));
    let marks: Vec<Mark> = events
        .map(|(event, at)| Mark::new(short(event.kind), at))
        .collect();
    if !marks.is_empty() {
        layers.push(Layer::Letters(marks));
    }
    layers
}

/// The name of a special point beside its dot.
fn short(kind: Kind) -> &'static str {
    match kind {
        Kind::Fold => "fold",
        Kind::PeriodDoubling => "doubling",
        Kind::NeimarkSacker => "torus",
        Kind::BranchPoint => "crossing",
        Kind::Graze => "graze",
        Kind::Corner => "corner",
        Kind::TensionLost => "slack",
        Kind::Limit(limit) => limit.stop().label(),
    }
}

#[cfg(test)]
mod tests {
    use super::label;

    #[test]
    fn axes_have_units() {
        for (column, words) in [
            ("f_o", "*f*ₒ (F)"),
            ("t", "*t* (T)"),
            ("impulse", "*p* (m L/T)"),
            ("least_v_n", "least *v*ₙ (L/T)"),
            ("vy_after", "d*y*/d*t* (L/T) after the impact"),
            ("theta_max", "|*θ*|ₘₐₓ (rad)"),
            ("largest_multiplier", "largest multiplier"),
        ] {
            assert_eq!(label(column), words);
        }
    }
}
