//! The page: panels below each other, with their axes, legends and titles.

use crate::area::Area;
use crate::axis::{Span, Ticks, as_wide, is_constant, resolve, ticks, union};
use crate::error::FigureError;
use crate::layers::draw_layers;
use crate::legend::Legend;
use crate::map::{BAR_GAP, Bar, has_uncertain, range};
use crate::picture::Picture;
use crate::plot::{self, Axis, Inset, Layer, Plot, Range, Width, drawable};
use crate::svg::{Anchor, FRAME, SvgCanvas};
use crate::text::{
    CAP_HEIGHT, LABEL, NAME_GAP, ROW, SMALL, TICK, TICK_GAP, fitted, plain, widest, width,
};
use kurbo::{Point, Rect, Vec2};

/// The white margin of the page, in points.
const RIM: f64 = 2.0;
/// The distance between panels.
const BETWEEN: f64 = 6.0;

/// Draws plots below each other, with one x axis for all.
///
/// `name` is the stem of the file's name. Panels in a stack show the union of their ranges of x
/// and the x label of the last one.
///
/// # Errors
///
/// [`FigureError::NoPanel`] without plots, or with a map without cells, and
/// [`FigureError::EqualScaleInStack`] if one of several plots asks for equal scale.
pub fn draw(name: &str, page: Width, panels: &[Plot]) -> Result<Picture, FigureError> {
    let maps = || panels.iter().filter_map(Plot::map);
    if panels.is_empty() || maps().any(|map| map.x.is_empty() || map.y.is_empty()) {
        return Err(FigureError::NoPanel);
    }
    if panels.len() > 1 && panels.iter().any(|plot| plot.equal_scale) {
        return Err(FigureError::EqualScaleInStack);
    }
    let mut canvas = SvgCanvas::default();
    if maps().next().is_some() {
        canvas.define_hatch();
    }
    if maps().any(has_uncertain) {
        canvas.define_uncertain();
    }
    let mut legend = Legend::default();
    let mut top = RIM;
    for (index, (plot, mut area)) in panels.iter().zip(lay_out(page, panels)).enumerate() {
        let bar = plot.map().and_then(Bar::of);
        top = draw_title(&mut canvas, plot, &area, top);
        top = legend.draw(&mut canvas, plot, &area, top);
        let y = ticks(plot.y.ticks, area.y);
        top = draw_factors(&mut canvas, &y, bar.as_ref(), area.rect, top);
        area.rect = area.rect + Vec2::new(0.0, top + 2.5);
        draw_layers(&mut canvas, area, plot);
        draw_y_axis(&mut canvas, &plot.y.label, &y, &area);
        if let Some(inset) = &plot.inset {
            draw_inset(&mut canvas, area.rect, inset);
        }
        if let Some(bar) = bar {
            bar.draw(&mut canvas, area.rect);
        }
        let last = index + 1 == panels.len();
        top = draw_x_axis(&mut canvas, &plot.x, &area, last);
        top += if last { RIM } else { BETWEEN };
    }
    let size = (page.points(), top);
    let svg = canvas.finish(size.0, size.1, &spoken_title(name, panels));
    Ok(Picture::new(name, svg, size))
}

/// The title of the document for readers who can not see it.
fn spoken_title(name: &str, panels: &[Plot]) -> String {
    let words = panels
        .iter()
        .flat_map(|plot| [plain(&plot.title), plain(&plot.description)]);
    let words: Vec<String> = words.filter(|words| !words.is_empty()).collect();
    if words.is_empty() {
        name.to_string()
    } else {
        words.join("; ")
    }
}

/// The area of each panel, all at the top of the page.
fn lay_out(page: Width, panels: &[Plot]) -> Vec<Area> {
    let mut areas: Vec<Area> = panels.iter().map(ranges).collect();
    let x = areas
        .iter()
        .map(|area| area.x)
        .reduce(union)
        .unwrap_or((0.0, 1.0));
    areas.iter_mut().for_each(|area| area.x = x);
    let rect = inner_rect(page, panels, &areas);
    areas.iter_mut().for_each(|area| area.rect = rect);
    if panels.iter().any(|plot| plot.equal_scale) {
        // The page must have space for a caption.
        let tallest = match page {
            Width::Column => 1.1,
            Width::Page => 0.8,
        };
        for area in &mut areas {
            let shape = (area.y.1 - area.y.0) / (area.x.1 - area.x.0);
            area.rect.y1 = area.rect.width() * shape.clamp(0.5, tallest);
            *area = widened(*area);
        }
        // The widened range may have longer numbers at its ticks.
        let Rect { x0, x1, .. } = inner_rect(page, panels, &areas);
        for area in &mut areas {
            area.rect = Rect {
                x0,
                x1,
                ..area.rect
            };
            *area = widened(*area);
        }
    }
    areas
}

/// The ranges of a plot: those of its map, or those of its axes. Without data they include the
/// boundaries.
pub(crate) fn ranges(plot: &Plot) -> Area {
    let mut shown: Vec<plot::Point> = plot.data().collect();
    if shown.is_empty() {
        let boundaries = plot.layers.iter().filter_map(|layer| match layer {
            Layer::Boundary(points, _) => Some(points),
            _ => None,
        });
        shown = boundaries.flatten().copied().filter(drawable).collect();
    }
    let requested = match plot.map() {
        Some(map) => [range(&map.x), range(&map.y)],
        None => [plot.x.range, plot.y.range],
    };
    let along = |k: usize| shown.iter().map(move |point| point[k]);
    let [mut x, mut y] = [0, 1].map(|k| resolve(requested[k], along(k)));
    if plot.equal_scale {
        match [0, 1].map(|k| requested[k] == Range::Auto && is_constant(along(k))) {
            [true, false] => x = as_wide(x, y),
            [false, true] => y = as_wide(y, x),
            _ => {}
        }
    }
    Area {
        rect: Rect::ZERO,
        x,
        y,
    }
}

/// The rectangle of a panel: the page without the texts next to it.
fn inner_rect(page: Width, panels: &[Plot], areas: &[Area]) -> Rect {
    let (mut numbers, mut beside) = (0.0_f64, 0.0_f64);
    for (plot, area) in panels.iter().zip(areas) {
        numbers = numbers.max(widest(ticks(plot.y.ticks, area.y).texts()));
        // Half of the number at the right end of the x axis.
        let along_x = ticks(plot.x.ticks, area.x);
        let half = widest(along_x.texts().last().into_iter()) / 2.0;
        let names = plot.layers.iter().filter_map(|layer| match layer {
            Layer::Horizontal(_, name) => Some(name.as_str()),
            _ => None,
        });
        beside = beside.max(match plot.map() {
            Some(map) => half.max(Bar::of(map).map_or(0.0, |bar| bar.room())),
            None => NAME_GAP + half.max(widest(names)),
        });
    }
    let left = (RIM + LABEL + 2.0 + numbers + TICK_GAP + TICK).min(page.points() / 2.0);
    let right = page.points() - (RIM + beside).min(page.points() / 4.0);
    let shape = match (page, panels) {
        (Width::Column, [plot]) if plot.map().is_some() => 0.75,
        (Width::Page, [plot]) if plot.map().is_some() => 0.62,
        (Width::Column, [_]) => 0.62,
        (Width::Column, _) => 0.42,
        (Width::Page, [_]) => 0.4,
        (Width::Page, _) => 0.2,
    };
    Rect::new(left, 0.0, right, shape * (right - left))
}

/// The area with one of its ranges widened symmetrically, so that the scales are equal.
fn widened(Area { rect, x, y }: Area) -> Area {
    let unit = ((x.1 - x.0) / rect.width()).max((y.1 - y.0) / rect.height());
    let about = |(lo, hi): Span, length: f64| {
        let (middle, half) = (lo + (hi - lo) / 2.0, unit * length / 2.0);
        (middle - half, middle + half)
    };
    let (x, y) = (about(x, rect.width()), about(y, rect.height()));
    Area { rect, x, y }
}

/// Draws a smaller plot into a part of a frame.
fn draw_inset(canvas: &mut SvgCanvas, frame: Rect, inset: &Inset) {
    /// The margin within its part.
    const AIR: f64 = 3.0;
    let Inset { plot, place } = inset;
    let [left, bottom, right, top] = *place;
    let at = |x: f64, y: f64| {
        let (width, height) = (frame.width(), frame.height());
        Point::new(frame.x0 + x * width, frame.y1 - y * height)
    };
    let part = Rect::from_points(at(left, bottom), at(right, top));
    canvas.blank(part);
    let mut area = ranges(plot);
    // Space for the numbers to the side and below; those of the widened range may be longer.
    for _ in 0..2 {
        let numbers = widest(ticks(plot.y.ticks, area.y).texts());
        let half = widest(ticks(plot.x.ticks, area.x).texts().last().into_iter()) / 2.0;
        area.rect = Rect {
            x0: part.x0 + AIR + numbers + TICK_GAP + TICK,
            y0: part.y0 + AIR,
            x1: part.x1 - AIR.max(half),
            y1: part.y1 - AIR - TICK - TICK_GAP - SMALL,
        };
        if plot.equal_scale {
            area = widened(area);
        }
    }
    draw_layers(canvas, area, plot);
    draw_y_axis(canvas, "", &ticks(plot.y.ticks, area.y), &area);
    let unnamed = Axis {
        label: String::new(),
        ..plot.x.clone()
    };
    draw_x_axis(canvas, &unnamed, &area, true);
}

/// Draws the title below `top`; this and the following functions return the position where they
/// end.
fn draw_title(canvas: &mut SvgCanvas, plot: &Plot, area: &Area, top: f64) -> f64 {
    if plot.title.is_empty() {
        return top;
    }
    let size = fitted(&plot.title, LABEL, area.rect.width());
    canvas.text(
        &plot.title,
        Point::new(area.rect.x0, top + LABEL),
        size,
        Anchor::Start,
    );
    top + ROW + 1.5
}

/// Draws the powers of ten of the y axis and of the colour bar.
fn draw_factors(canvas: &mut SvgCanvas, y: &Ticks, bar: Option<&Bar>, rect: Rect, top: f64) -> f64 {
    let of_bar = bar.map_or("", |bar| &bar.ticks.factor);
    for (factor, left) in [(y.factor.as_str(), rect.x0), (of_bar, rect.x1 + BAR_GAP)] {
        canvas.text(factor, Point::new(left, top + SMALL), SMALL, Anchor::Start);
    }
    let none = y.factor.is_empty() && of_bar.is_empty();
    top + if none { 0.0 } else { ROW }
}

fn draw_y_axis(canvas: &mut SvgCanvas, label: &str, ticks: &Ticks, area: &Area) {
    let left = area.rect.x0;
    for (value, text) in &ticks.at {
        let at = area.to_page([area.x.0, *value]);
        canvas.segment(Point::new(left - TICK, at.y), Point::new(left, at.y), FRAME);
        let base = Point::new(left - TICK - TICK_GAP, at.y + 0.5 * CAP_HEIGHT * SMALL);
        canvas.text(text, base, SMALL, Anchor::End);
    }
    let size = fitted(label, LABEL, area.rect.height() + BETWEEN);
    let middle = Point::new(RIM + 0.8 * LABEL, area.rect.center().y);
    canvas.text_upwards(label, middle, size);
}

/// Draws ticks and, for the lowest panel, numbers and label; returns where the page may end.
fn draw_x_axis(canvas: &mut SvgCanvas, axis: &Axis, area: &Area, numbered: bool) -> f64 {
    let bottom = area.rect.y1;
    let Ticks { at, factor } = ticks(axis.ticks, area.x);
    let numbers_at = bottom + TICK + TICK_GAP + CAP_HEIGHT * SMALL;
    let places = at
        .iter()
        .map(|(value, text)| (area.to_page([*value, area.y.0]).x, text));
    let places: Vec<(f64, &String)> = places.collect();
    // If numbers would touch one another, only every second or third tick has one.
    let apart = places
        .array_windows()
        .map(|[a, b]| b.0 - a.0)
        .fold(f64::INFINITY, f64::min);
    let every = ((widest(at.iter().map(|(_, text)| text.as_str())) + 5.0) / apart).ceil();
    for (index, (x, text)) in places.into_iter().enumerate() {
        canvas.segment(Point::new(x, bottom), Point::new(x, bottom + TICK), FRAME);
        if numbered && index.is_multiple_of((every as usize).max(1)) {
            canvas.text(text, Point::new(x, numbers_at), SMALL, Anchor::Middle);
        }
    }
    if !numbered {
        return bottom;
    }
    let label_at = numbers_at + 4.0 + CAP_HEIGHT * LABEL;
    let taken = width(&factor) * SMALL;
    canvas.text(
        &factor,
        Point::new(area.rect.x1, label_at),
        SMALL,
        Anchor::End,
    );
    let size = fitted(&axis.label, LABEL, area.rect.width() - 2.0 * taken);
    let middle = Point::new(area.rect.center().x, label_at);
    canvas.text(&axis.label, middle, size, Anchor::Middle);
    label_at + 0.24 * LABEL
}
