//! The parts of a plot: two axes, layers of data, and a few texts.

/// A point or a displacement, `[x, y]`, in the data's own units.
pub type Point = [f64; 2];

/// One plot. Write the fields that matter and leave the rest to `..Plot::default()`.
///
/// In every text, letters between asterisks are set in italics: `"*t* (T)"`. A single asterisk is
/// printed as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plot {
    /// A small line above the plot, such as the code of a case; empty for none.
    pub title: String,
    /// A description of the plot, in a sentence, for readers who cannot see it; not printed.
    pub description: String,
    /// The axis along the bottom.
    pub x: Axis,
    /// The axis along the left side.
    pub y: Axis,
    /// Whether the scales of x and y are equal. One of the two ranges, even a fixed one, is then
    /// widened so that the plot has a suitable shape.
    pub equal_scale: bool,
    /// The data, drawn in this order. A point with a coordinate that is not finite, or beyond
    /// 1e100, is skipped, and a line is broken there.
    pub layers: Vec<Layer>,
    /// A text in the middle of the plot, such as the reason why it is empty; empty for none.
    pub note: String,
    /// A smaller plot within the frame, such as an enlarged part of it, or the whole of which it is
    /// a part.
    pub inset: Option<Box<Inset>>,
    /// The least number of markers that is assumed for their size, so that plots which are compared
    /// have markers of the same size.
    pub markers: usize,
}

/// A smaller plot within the frame of another one: on white, with numbers along its axes, without
/// labels and legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Inset {
    /// Its contents.
    pub plot: Plot,
    /// Its position including its numbers: left, bottom, right and top side, as parts of the frame.
    pub place: [f64; 4],
}

/// One axis of a plot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Symbol and unit.
    pub label: String,
    /// The range that is shown.
    pub range: Range,
    /// The positions of its ticks.
    pub ticks: TickStyle,
}

/// The range that an axis shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Range {
    /// All points of the lines and markers, with a small margin that does not extend across zero.
    /// Data that are constant to ten digits are shown as constant.
    #[default]
    Auto,
    /// As [`Range::Auto`], and including the interval from the first number to the second.
    AtLeast(f64, f64),
    /// From the first number to the second; data outside are cut off.
    Fixed(f64, f64),
}

/// The positions of the ticks of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TickStyle {
    /// At 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// At multiples of π/4, for angles; as [`TickStyle::Decimal`] where the range holds fewer than
    /// three of them, or thousands of turns.
    Angle,
}

/// One layer of a plot. Its text is in the legend, or where the layer says; it may be empty.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line: its pieces, each a polyline, its stroke, and its text. A piece of a single point is
    /// drawn as a dot.
    Line(Vec<Vec<Point>>, Stroke, String),
    /// A marker at each point, and their text. Large numbers of markers are drawn smaller, and of
    /// thousands that cover one another some are left out.
    Markers(Vec<Point>, Shape, Colour, String),
    /// The boundary of a region, dotted, and its name, written along it where there is space. It is
    /// included in an automatic range only if there are no data.
    Boundary(Vec<Point>, String),
    /// A dashed line across the plot at a height, and its name, written at its right end. It is not
    /// included in an automatic range.
    Horizontal(f64, String),
    /// A light grey background from one x to another, which may be infinite, and its text. It is
    /// not included in an automatic range.
    Shade(f64, f64, String),
    /// Dots with letters next to them. Where dots coincide on paper the letters are joined: "S,G".
    Letters(Vec<Mark>),
    /// A value or a class for every cell of a grid. The axes end where the grid does.
    Map(Map),
}

/// A dot with a letter (or a short word) next to it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mark {
    /// The position of the dot.
    pub at: Point,
    /// The text next to it.
    pub letter: String,
}

/// A grid of cells. Its colours can be distinguished by colour-blind readers and in grey print.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// The values of x, rising or falling, each in the middle of its cells.
    pub x: Vec<f64>,
    /// The values of y.
    pub y: Vec<f64>,
    /// The cells: for the first x all of y, then for the next.
    pub cells: Vec<Cell>,
    /// The label of the values, along the colour bar.
    pub value_label: String,
    /// The names of the classes.
    pub classes: Vec<String>,
    /// The meaning of empty cells; "no value" if it is empty.
    pub empty: String,
    /// Which cells are uncertain, in the order of the cells; these are hatched. Cells for which the
    /// list has no entry are not.
    pub uncertain: Vec<bool>,
    /// The meaning of those; "not certain" if it is empty.
    pub uncertain_words: String,
}

/// The contents of a cell of a [`Map`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Cell {
    /// A number; one that is not finite counts as empty.
    Value(f64),
    /// One of the classes, by its index in their list.
    Class(usize),
    /// Nothing.
    #[default]
    Empty,
    /// A value that could not be computed; hatched.
    Illegal,
}

/// The appearance of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width on paper, in points (1/72 inch).
    pub width_pt: f64,
    /// Its dashes.
    pub dash: Dash,
}

/// The dashes of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dash {
    /// None.
    #[default]
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
}

/// The shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shape {
    /// A diagonal cross, ×.
    #[default]
    Cross,
    /// An open circle, ∘.
    Circle,
}

/// Red, green and blue. The named ones are those of Okabe and Ito, which colour-blind readers can
/// distinguish. Grey is reserved for what is past the horizon of trust.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Colour(pub [u8; 3]);

/// How wide the picture is on paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Width {
    /// One column of a journal, 85 mm.
    #[default]
    Column,
    /// Both columns, 170 mm.
    Page,
}

impl Axis {
    /// An axis with decimal ticks.
    pub fn new(label: impl Into<String>, range: Range) -> Self {
        let (label, ticks) = (label.into(), TickStyle::Decimal);
        Self {
            label,
            range,
            ticks,
        }
    }
}

impl Layer {
    /// A grey background where the flags along an axis are set, each up to halfway to the next
    /// value, and its text. The values are evenly spaced, and rise or fall.
    pub fn shades(along: &[(f64, bool)], words: &str) -> Vec<Self> {
        let half = match along {
            [(a, _), (b, _), ..] => (b - a).abs() / 2.0,
            _ => 0.0,
        };
        let shade = |run: &[(f64, bool)]| match run {
            [(from, true), ..] => {
                let to = run[run.len() - 1].0;
                let (low, high) = (from.min(to) - half, from.max(to) + half);
                Some(Self::Shade(low, high, words.to_owned()))
            }
            _ => None,
        };
        let runs = along.chunk_by(|a, b| a.1 == b.1);
        runs.filter_map(shade).collect()
    }

    fn points(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        match self {
            Self::Line(pieces, ..) => Box::new(pieces.iter().flatten().copied()),
            Self::Markers(points, ..) => Box::new(points.iter().copied()),
            Self::Letters(marks) => Box::new(marks.iter().map(|mark| mark.at)),
            _ => Box::new(std::iter::empty()),
        }
    }
}

impl Mark {
    /// A dot with a letter.
    pub fn new(letter: impl Into<String>, at: Point) -> Self {
        let letter = letter.into();
        Self { at, letter }
    }
}

impl Stroke {
    /// A line of a colour and a width.
    pub const fn new(colour: Colour, width_pt: f64, dash: Dash) -> Self {
        Self {
            colour,
            width_pt,
            dash,
        }
    }
}

impl Default for Stroke {
    /// Black, solid, 0.7 points.
    fn default() -> Self {
        Self::new(Colour::BLACK, 0.7, Dash::Solid)
    }
}

#[allow(missing_docs)]
impl Colour {
    pub const BLACK: Self = Self([0x00, 0x00, 0x00]);
    /// Reserved for what is past the horizon of trust.
    pub const GREY: Self = Self([0x99, 0x99, 0x99]);
    pub const ORANGE: Self = Self([0xe6, 0x9f, 0x00]);
    pub const SKY_BLUE: Self = Self([0x56, 0xb4, 0xe9]);
    pub const GREEN: Self = Self([0x00, 0x9e, 0x73]);
    /// Too pale for a thin line.
    pub const YELLOW: Self = Self([0xf0, 0xe4, 0x42]);
    pub const BLUE: Self = Self([0x00, 0x72, 0xb2]);
    pub const VERMILION: Self = Self([0xd5, 0x5e, 0x00]);
    /// Reddish.
    pub const PURPLE: Self = Self([0xcc, 0x79, 0xa7]);
}

impl Width {
    /// In points (1/72 inch).
    pub(crate) fn points(self) -> f64 {
        match self {
            Self::Column => 85.0 * 72.0 / 25.4,
            Self::Page => 170.0 * 72.0 / 25.4,
        }
    }
}

impl Plot {
    /// The points of lines, markers and letters that can be placed on paper.
    pub(crate) fn data(&self) -> impl Iterator<Item = Point> {
        self.layers.iter().flat_map(Layer::points).filter(drawable)
    }

    /// The map among the layers.
    pub(crate) fn map(&self) -> Option<&Map> {
        self.layers.iter().find_map(|layer| match layer {
            Layer::Map(map) => Some(map),
            _ => None,
        })
    }
}

/// Whether a point can be placed on paper: beyond 1e100 the computation of ranges would overflow.
pub(crate) fn drawable(point: &Point) -> bool {
    point.iter().all(|v| v.abs() < 1e100)
}
