//! Maps: a value, or a class, for every cell of a grid over two axes.

use crate::area::Area;
use crate::axis::{Span, Ticks, resolve, ticks, union};
use crate::plot::{Cell, Colour, Map, Range, TickStyle};
use crate::svg::{Anchor, FRAME, Fill, SvgCanvas};
use crate::text::{CAP_HEIGHT, LABEL, SMALL, TICK, TICK_GAP, fitted, widest};
use kurbo::{Point, Rect, Vec2};
use std::collections::BTreeMap;

/// The width of the colour bar, in points.
const BAR: f64 = 9.0;
/// The distance from the map to the bar.
pub(crate) const BAR_GAP: f64 = 8.0;
/// The number of shades of a scale: more can not be distinguished, and fewer keep a file small.
const LEVELS: usize = 64;
/// Points of the scale viridis of matplotlib (CC0), evenly spaced: its lightness increases evenly,
/// so that it can be read without distinguishing red and green, and in grey print.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x49, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6e, 0xce, 0x58],
    [0xb5, 0xde, 0x2b],
    [0xfd, 0xe7, 0x25],
];
/// The most classes of a map that have a colour each; the colours of more repeat.
pub const MOST_CLASSES: usize = 7;
/// The colours of classes, in an order in which neighbours also differ in lightness.
const CLASSES: [Colour; MOST_CLASSES] = [
    Colour::BLUE,
    Colour::ORANGE,
    Colour::GREEN,
    Colour::YELLOW,
    Colour::PURPLE,
    Colour::BLACK,
    Colour::SKY_BLUE,
];

/// The colour of one of the [`LEVELS`].
fn shade(level: usize) -> Fill {
    let along = level * (VIRIDIS.len() - 1);
    let (k, rest) = (along / (LEVELS - 1), along % (LEVELS - 1));
    let part = rest as f64 / (LEVELS - 1) as f64;
    let (from, to) = (VIRIDIS[k], VIRIDIS[(k + 1).min(VIRIDIS.len() - 1)]);
    Fill::Colour(Colour(std::array::from_fn(|c| {
        let (from, to) = (f64::from(from[c]), f64::from(to[c]));
        (from + part * (to - from)).round() as u8
    })))
}

fn class(index: usize) -> Fill {
    Fill::Colour(CLASSES[index % CLASSES.len()])
}

/// The shade of a value in the range of the colour bar, from 0.
fn level(value: f64, (low, high): Span) -> usize {
    let part = (value - low) / (high - low);
    ((part * LEVELS as f64) as usize).min(LEVELS - 1)
}

/// The fill of a cell.
fn fill(cell: Cell, values: Span) -> Fill {
    match cell {
        Cell::Value(value) if value.is_finite() => shade(level(value, values)),
        Cell::Class(index) => class(index),
        Cell::Illegal => Fill::Hatch,
        Cell::Value(_) | Cell::Empty => Fill::Blank,
    }
}

/// The borders of cells around values: halfway between neighbours.
fn edges(at: &[f64]) -> Vec<f64> {
    let mut edges: Vec<f64> = at.array_windows().map(|[a, b]| a + (b - a) / 2.0).collect();
    if let ([first, ..], [.., last]) = (at, at) {
        let alone = if *first == 0.0 {
            0.5
        } else {
            0.05 * first.abs()
        };
        let low = edges
            .first()
            .map_or(first - alone, |edge| 2.0 * first - edge);
        let high = edges.last().map_or(last + alone, |edge| 2.0 * last - edge);
        edges.insert(0, low);
        edges.push(high);
    }
    edges
}

/// The part of an axis that the cells around some values take.
pub(crate) fn range(at: &[f64]) -> Range {
    match (edges(at).first(), edges(at).last()) {
        (Some(first), Some(last)) => Range::Fixed(*first, *last),
        _ => Range::Auto,
    }
}

/// The range of the values of a map, if it has any.
fn values_of(map: &Map) -> Option<Span> {
    let values = map.cells.iter().filter_map(|cell| match cell {
        Cell::Value(value) if value.is_finite() => Some((*value, *value)),
        _ => None,
    });
    let (low, high) = values.reduce(union)?;
    Some(resolve(Range::Fixed(low, high), std::iter::once(low)))
}

/// Draws one path for all the cells of a colour, and one for the uncertain ones on top.
pub(crate) fn draw_cells(canvas: &mut SvgCanvas, map: &Map, area: Area) {
    let values = values_of(map).unwrap_or_default();
    let colour = |k: usize| {
        let cell = map.cells.get(k).copied();
        Some(fill(cell.unwrap_or_default(), values))
    };
    let uncertain = |k: usize| is_uncertain(map, k).then_some(Fill::Uncertain);
    for (fill, rects) in rects(map, area, colour) {
        canvas.rects(&rects, fill);
    }
    for (fill, rects) in rects(map, area, uncertain) {
        canvas.rects(&rects, fill);
    }
}

/// The cells of each fill, by index; vertical neighbours are joined to one rectangle.
fn rects(map: &Map, area: Area, fill: impl Fn(usize) -> Option<Fill>) -> BTreeMap<Fill, Vec<Rect>> {
    let mut of_fill: BTreeMap<Fill, Vec<Rect>> = BTreeMap::new();
    let (across, up) = (edges(&map.x), edges(&map.y));
    let rows = map.y.len();
    for i in 0..map.x.len() {
        let mut start = 0;
        for j in 0..rows {
            let this = fill(i * rows + j);
            if j + 1 == rows || fill(i * rows + j + 1) != this {
                let from = area.to_page([across[i], up[start]]);
                let to = area.to_page([across[i + 1], up[j + 1]]);
                if let Some(this) = this {
                    let rects = of_fill.entry(this).or_default();
                    rects.push(Rect::from_points(from, to));
                }
                start = j + 1;
            }
        }
    }
    of_fill
}

/// Whether a cell, by index, is uncertain; an empty cell is not.
fn is_uncertain(map: &Map, k: usize) -> bool {
    let something = matches!(map.cells.get(k), Some(Cell::Value(_) | Cell::Class(_)));
    something && map.uncertain.get(k) == Some(&true)
}

/// Whether any cell is uncertain.
pub(crate) fn has_uncertain(map: &Map) -> bool {
    (0..map.cells.len()).any(|k| is_uncertain(map, k))
}

/// The words for what is past the horizon of trust, in a legend.
pub const NOT_CERTAIN: &str = "not certain";

/// The classes that occur, cells without a value, and uncertain ones, for the legend.
pub(crate) fn samples(map: &Map) -> Vec<(Fill, String)> {
    let classes = map.classes.iter().enumerate();
    let classes = classes.map(|(index, name)| (Cell::Class(index), name.as_str()));
    let empty = match map.empty.as_str() {
        "" => "no value",
        words => words,
    };
    let others = [(Cell::Empty, empty), (Cell::Illegal, "no legal case")];
    let occurring = classes
        .chain(others)
        .filter(|(cell, _)| map.cells.contains(cell));
    let sample = |(cell, words): (Cell, &str)| (fill(cell, (0.0, 1.0)), words.to_owned());
    let doubt = match map.uncertain_words.as_str() {
        "" => NOT_CERTAIN,
        words => words,
    };
    let uncertain = has_uncertain(map).then(|| (Fill::Uncertain, doubt.to_owned()));
    occurring.map(sample).chain(uncertain).collect()
}

/// The colour bar next to a map of values.
pub(crate) struct Bar<'a> {
    values: Span,
    label: &'a str,
    pub(crate) ticks: Ticks,
}

impl<'a> Bar<'a> {
    /// The bar of a map, if it has values.
    pub(crate) fn of(map: &'a Map) -> Option<Self> {
        let values = values_of(map)?;
        let (label, ticks) = (map.value_label.as_str(), ticks(TickStyle::Decimal, values));
        Some(Self {
            values,
            label,
            ticks,
        })
    }

    /// The distance from the map to the label of the bar, which depends on the width of its
    /// numbers.
    fn label_at(&self) -> f64 {
        BAR_GAP + BAR + TICK + TICK_GAP + widest(self.ticks.texts())
    }

    /// The space that it needs to the right of the map.
    pub(crate) fn room(&self) -> f64 {
        let label = if self.label.is_empty() {
            0.0
        } else {
            3.0 + LABEL
        };
        self.label_at() + label
    }

    /// Draws it next to the frame of the map.
    pub(crate) fn draw(&self, canvas: &mut SvgCanvas, map: Rect) {
        let x0 = map.x1 + BAR_GAP;
        let rect = Rect {
            x0,
            x1: x0 + BAR,
            ..map
        };
        let step = rect.height() / LEVELS as f64;
        for level in 0..LEVELS {
            let y0 = rect.y1 - (level + 1) as f64 * step;
            canvas.rects(
                &[Rect {
                    y0,
                    y1: y0 + step,
                    ..rect
                }],
                shade(level),
            );
        }
        canvas.frame(rect);
        let area = Area {
            rect,
            x: (0.0, 1.0),
            y: self.values,
        };
        for (value, text) in &self.ticks.at {
            let at = area.to_page([1.0, *value]);
            canvas.segment(at, at + Vec2::new(TICK, 0.0), FRAME);
            let base = at + Vec2::new(TICK + TICK_GAP, 0.5 * CAP_HEIGHT * SMALL);
            canvas.text(text, base, SMALL, Anchor::Start);
        }
        let size = fitted(self.label, LABEL, rect.height());
        let x = map.x1 + self.label_at() + 3.0 + 0.8 * LABEL;
        canvas.text_upwards(self.label, Point::new(x, rect.center().y), size);
    }
}
