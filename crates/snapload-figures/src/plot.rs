//! What a plot is made of: two axes, layers of data, and a few words.

/// A point or a displacement, `[x, y]`, in the data's own units.
pub type Point = [f64; 2];

/// One plot. Write the fields that matter and leave the rest to `..Plot::default()`.
///
/// In every text, letters between asterisks are set in italics: `"*t* (nondimensional)"`.
/// An asterisk without its partner is printed as it stands.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plot {
    /// A small line above the plot, such as the code of a case; empty for none.
    pub title: String,
    /// What the plot shows, in a sentence, for readers who cannot see it; not printed.
    pub description: String,
    /// The axis along the bottom.
    pub x: Axis,
    /// The axis along the left side.
    pub y: Axis,
    /// Whether a unit of x is drawn as long as a unit of y. One of the two ranges, a fixed one too,
    /// is then widened until the plot has a fair shape.
    pub equal_scale: bool,
    /// The data, drawn in this order. A point with a coordinate that is not finite, or beyond
    /// 1e100, is skipped, and a line is broken there.
    pub layers: Vec<Layer>,
    /// Words in the middle of the plot, such as the reason why it is empty; empty for none.
    pub note: String,
}

/// One axis of a plot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Symbol and unit.
    pub label: String,
    /// What part of the axis is shown.
    pub range: Range,
    /// Where its ticks stand.
    pub ticks: TickStyle,
}

/// What part of an axis is shown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Range {
    /// All points of the lines and markers, with a little air that does not reach across zero.
    /// Data that are constant to ten digits are shown as constant.
    #[default]
    Auto,
    /// As [`Range::Auto`], and at least from the first number to the second.
    AtLeast(f64, f64),
    /// From the first number to the second and no more; what lies outside is cut off.
    Fixed(f64, f64),
}

/// Where the ticks of an axis stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TickStyle {
    /// At 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// At multiples of π/4, for angles; as [`TickStyle::Decimal`] where the range holds fewer than
    /// three of them, or thousands of turns.
    Angle,
}

/// One layer of a plot.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line of one or several pieces. A piece of a single point is drawn as a dot.
    Line {
        /// The pieces, each a polyline.
        pieces: Vec<Vec<Point>>,
        /// How it is drawn.
        stroke: Stroke,
        /// Its words in the legend; empty for none.
        legend: String,
    },
    /// A marker at each point. They shrink as they grow many, and of thousands that cover one
    /// another some are left out.
    Markers {
        /// Where.
        points: Vec<Point>,
        /// What each looks like.
        shape: Shape,
        /// Its colour.
        colour: Colour,
        /// Its words in the legend; empty for none.
        legend: String,
    },
    /// The boundary of a region, thin and grey. It enters an automatic range only
    /// where there are no data.
    Boundary {
        /// The polyline.
        points: Vec<Point>,
        /// Its name, written along it where there is room; empty for none.
        label: String,
    },
    /// A dashed line across the plot. It does not enter an automatic range.
    Horizontal {
        /// Its height.
        y: f64,
        /// Its name, written at its right end; empty for none.
        label: String,
    },
    /// A light grey background over part of the x axis. It does not enter an automatic range.
    Shade {
        /// Where it starts.
        from: f64,
        /// Where it ends; may be infinite.
        to: f64,
        /// Its words in the legend; empty for none.
        legend: String,
    },
    /// Dots with letters beside them. Where dots coincide on paper the letters are joined: "S,G".
    Letters(Vec<Mark>),
}

/// A dot with a letter (or a short word) beside it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mark {
    /// Where the dot is.
    pub at: Point,
    /// What stands beside it.
    pub letter: String,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width on paper, in points (1/72 inch).
    pub width_pt: f64,
    /// Its dashes.
    pub dash: Dash,
}

impl Default for Stroke {
    /// Black, solid, 0.7 points.
    fn default() -> Self {
        Self {
            colour: Colour::Black,
            width_pt: 0.7,
            dash: Dash::Solid,
        }
    }
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

/// The colours of Okabe and Ito, which colour-blind readers tell apart, without the yellow that
/// is too pale for a thin line, and a grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Colour {
    /// Black.
    #[default]
    Black,
    /// Middle grey.
    Grey,
    /// Orange.
    Orange,
    /// Sky blue.
    SkyBlue,
    /// Bluish green.
    Green,
    /// Blue.
    Blue,
    /// Vermilion.
    Vermilion,
    /// Reddish purple.
    Purple,
}

/// How wide the picture is on paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Width {
    /// One column of a journal, 85 mm.
    #[default]
    Column,
    /// Both columns, 170 mm.
    Page,
}

impl Plot {
    /// The points of the layers that can be placed on paper.
    pub(crate) fn data(&self) -> impl Iterator<Item = Point> {
        self.layers.iter().flat_map(Layer::data).filter(drawable)
    }

    /// What an automatic range shows: the data, or without any the boundaries.
    pub(crate) fn shown(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        if self.data().next().is_some() {
            return Box::new(self.data());
        }
        let boundary = |layer: &Layer| match layer {
            Layer::Boundary { points, .. } => points.clone(),
            _ => Vec::new(),
        };
        Box::new(self.layers.iter().flat_map(boundary).filter(drawable))
    }
}

impl Layer {
    fn data(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        match self {
            Self::Line { pieces, .. } => Box::new(pieces.iter().flatten().copied()),
            Self::Markers { points, .. } => Box::new(points.iter().copied()),
            Self::Letters(marks) => Box::new(marks.iter().map(|mark| mark.at)),
            Self::Boundary { .. } | Self::Horizontal { .. } | Self::Shade { .. } => {
                Box::new(std::iter::empty())
            }
        }
    }

    /// The words of this layer in the legend.
    pub(crate) fn legend(&self) -> &str {
        match self {
            Self::Line { legend, .. }
            | Self::Markers { legend, .. }
            | Self::Shade { legend, .. } => legend,
            Self::Boundary { .. } | Self::Horizontal { .. } | Self::Letters(_) => "",
        }
    }
}

impl Colour {
    /// As SVG writes it.
    pub(crate) fn hex(self) -> &'static str {
        match self {
            Self::Black => "#000",
            Self::Grey => "#888",
            Self::Orange => "#e69f00",
            Self::SkyBlue => "#56b4e9",
            Self::Green => "#009e73",
            Self::Blue => "#0072b2",
            Self::Vermilion => "#d55e00",
            Self::Purple => "#cc79a7",
        }
    }
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

/// Whether a point can be placed on paper: beyond 1e100 the arithmetic of ranges would overflow.
pub(crate) fn drawable(point: &Point) -> bool {
    point.iter().all(|v| v.abs() < 1e100)
}
