//! The page: panels one below the other, with their axes, legends and titles.

use crate::area::{Area, SMALL, draw_layers, fitted};
use crate::axis::{Span, Ticks, resolve, ticks, union};
use crate::error::FigureError;
use crate::legend::Legend;
use crate::picture::Picture;
use crate::plot::{Layer, Plot, Width};
use crate::polyline::Rect;
use crate::svg::{Anchor, FRAME, Sheet};
use crate::text::{CAP_HEIGHT, plain, width};

/// The size of the labels of axes, in points.
pub(crate) const LABEL: f64 = 8.0;
/// The length of a tick.
pub(crate) const TICK: f64 = 2.5;
/// From a tick to its number.
pub(crate) const GAP: f64 = 2.0;
/// The white rim of the page.
pub(crate) const RIM: f64 = 2.0;
/// From one panel to the next.
const BETWEEN: f64 = 6.0;
/// The height of a line of small text.
pub(crate) const ROW: f64 = 10.0;

/// Draws plots one below the other, with one x axis for all.
///
/// `name` is the stem of the file's name. Panels in a stack show the union of their ranges of x
/// and the x label of the last one.
///
/// # Errors
///
/// [`FigureError::NoPanel`] without plots, and [`FigureError::EqualScaleInStack`] if one of
/// several plots asks for equal scale.
pub fn draw(name: &str, width: Width, panels: &[Plot]) -> Result<Picture, FigureError> {
    let Some(last) = panels.last() else {
        return Err(FigureError::NoPanel);
    };
    if panels.len() > 1 && panels.iter().any(|plot| plot.equal_scale) {
        return Err(FigureError::EqualScaleInStack);
    }
    let areas = lay_out(width, panels);
    let mut sheet = Sheet::default();
    let mut legend = Legend::default();
    let mut top = RIM;
    for (index, (plot, mut area)) in panels.iter().zip(areas).enumerate() {
        top = draw_header(&mut sheet, &mut legend, plot, &area, top);
        area.rect.top = top;
        draw_layers(&mut sheet, area, plot);
        draw_y_axis(&mut sheet, plot, &area);
        top = area.rect.bottom();
        if index + 1 == panels.len() {
            top = draw_x_axis(&mut sheet, last, &area, true);
        } else {
            draw_x_axis(&mut sheet, plot, &area, false);
            top += BETWEEN;
        }
    }
    let size = (width.points(), top + RIM);
    let svg = sheet.finish(size.0, size.1, &spoken_title(name, panels));
    Ok(Picture::new(name, svg, size))
}

/// The title of the document for those who do not see it.
fn spoken_title(name: &str, panels: &[Plot]) -> String {
    let words: Vec<String> = panels
        .iter()
        .flat_map(|plot| [plain(&plot.title), plain(&plot.description)])
        .filter(|words| !words.is_empty())
        .collect();
    if words.is_empty() {
        name.to_string()
    } else {
        words.join("; ")
    }
}

/// The area of each panel, all at the top of the page.
fn lay_out(page: Width, panels: &[Plot]) -> Vec<Area> {
    let x = panels
        .iter()
        .map(|plot| resolve(plot.x.range, plot.shown().map(|[x, _]| x)))
        .reduce(union)
        .unwrap_or((0.0, 1.0));
    let mut spans: Vec<(Span, Span)> = panels
        .iter()
        .map(|plot| (x, resolve(plot.y.range, plot.shown().map(|[_, y]| y))))
        .collect();
    let mut rect = inner_rect(page, panels, &spans);
    for (plot, span) in panels.iter().zip(&mut spans) {
        if plot.equal_scale {
            (rect.height, *span) = equal_scale(page, &rect, *span);
            // The widened range may have longer numbers at its ticks.
            let height = rect.height;
            rect = inner_rect(page, panels, std::slice::from_ref(span));
            rect.height = height;
            *span = widened(&rect, *span);
        }
    }
    spans
        .into_iter()
        .map(|(x, y)| Area { rect, x, y })
        .collect()
}

/// The rectangle of a panel: the page less what is written beside it.
fn inner_rect(page: Width, panels: &[Plot], spans: &[(Span, Span)]) -> Rect {
    let widest = |texts: &mut dyn Iterator<Item = &str>| {
        texts.map(|text| width(text) * SMALL).fold(0.0, f64::max)
    };
    let (mut numbers, mut names) = (0.0_f64, 0.0_f64);
    for (plot, (x, y)) in panels.iter().zip(spans) {
        let along_y = ticks(plot.y.ticks, *y);
        numbers = numbers.max(widest(
            &mut along_y.at.iter().map(|(_, text)| text.as_str()),
        ));
        names = names.max(widest(&mut plot.layers.iter().map(|layer| match layer {
            Layer::Horizontal { label, .. } => label.as_str(),
            _ => "",
        })));
        // Half the number at the right end of the x axis.
        let along_x = ticks(plot.x.ticks, *x);
        names =
            names.max(widest(&mut along_x.at.last().iter().map(|(_, text)| text.as_str())) / 2.0);
    }
    let page_width = page.points();
    let left = (RIM + LABEL + 2.0 + numbers + GAP + TICK).min(page_width / 2.0);
    let right = (RIM + 2.5 + names).min(page_width / 4.0);
    let width = page_width - left - right;
    let shape = match (page, panels.len()) {
        (Width::Column, 1) => 0.62,
        (Width::Column, _) => 0.42,
        (Width::Page, 1) => 0.4,
        (Width::Page, _) => 0.2,
    };
    Rect {
        left,
        top: 0.0,
        width,
        height: shape * width,
    }
}

/// The height of a plot with equal scale, and its ranges.
fn equal_scale(page: Width, rect: &Rect, (x, y): (Span, Span)) -> (f64, (Span, Span)) {
    let shape = (y.1 - y.0) / (x.1 - x.0);
    // Room must be left on the page for a caption.
    let tallest = match page {
        Width::Column => 1.1,
        Width::Page => 0.8,
    };
    let height = rect.width * shape.clamp(0.5, tallest);
    (height, widened(&Rect { height, ..*rect }, (x, y)))
}

/// The ranges, one of them widened about its middle, that make the scales equal.
fn widened(rect: &Rect, (x, y): (Span, Span)) -> (Span, Span) {
    let unit = ((x.1 - x.0) / rect.width).max((y.1 - y.0) / rect.height);
    let about = |(lo, hi): Span, length: f64| {
        let (middle, half) = (lo + (hi - lo) / 2.0, unit * length / 2.0);
        (middle - half, middle + half)
    };
    (about(x, rect.width), about(y, rect.height))
}

/// Title, legend and the power of ten of the y axis; returns where the frame starts.
fn draw_header(
    sheet: &mut Sheet,
    legend: &mut Legend,
    plot: &Plot,
    area: &Area,
    mut top: f64,
) -> f64 {
    let left = area.rect.left;
    if !plot.title.is_empty() {
        let size = fitted(&plot.title, LABEL, area.rect.width);
        sheet.text(&plot.title, [left, top + LABEL], size, Anchor::Start);
        top += ROW + 1.5;
    }
    top = legend.draw(sheet, plot, area, top);
    let factor = ticks(plot.y.ticks, area.y).factor;
    if !factor.is_empty() {
        sheet.text(&factor, [left, top + SMALL], SMALL, Anchor::Start);
        top += ROW;
    }
    top + 2.5
}

pub(crate) fn draw_y_axis(sheet: &mut Sheet, plot: &Plot, area: &Area) {
    let left = area.rect.left;
    for (value, text) in ticks(plot.y.ticks, area.y).at {
        let [_, y] = area.to_page([area.x.0, value]);
        sheet.segment([left - TICK, y], [left, y], FRAME);
        let base = y + 0.5 * CAP_HEIGHT * SMALL;
        sheet.text(&text, [left - TICK - GAP, base], SMALL, Anchor::End);
    }
    let size = fitted(&plot.y.label, LABEL, area.rect.height + BETWEEN);
    let middle = area.rect.top + area.rect.height / 2.0;
    sheet.text_upwards(&plot.y.label, [RIM + 0.8 * LABEL, middle], size);
}

/// Ticks and, for the lowest panel, numbers and label; returns where the page may end.
pub(crate) fn draw_x_axis(sheet: &mut Sheet, plot: &Plot, area: &Area, numbered: bool) -> f64 {
    let bottom = area.rect.bottom();
    let Ticks { at, factor } = ticks(plot.x.ticks, area.x);
    let numbers_at = bottom + TICK + GAP + CAP_HEIGHT * SMALL;
    let every = labelled_every(&at, area);
    for (index, (value, text)) in at.iter().enumerate() {
        let [x, _] = area.to_page([*value, area.y.0]);
        sheet.segment([x, bottom], [x, bottom + TICK], FRAME);
        if numbered && index % every == 0 {
            sheet.text(text, [x, numbers_at], SMALL, Anchor::Middle);
        }
    }
    if !numbered {
        return bottom;
    }
    let label_at = numbers_at + 4.0 + CAP_HEIGHT * LABEL;
    let taken = width(&factor) * SMALL;
    sheet.text(&factor, [area.rect.right(), label_at], SMALL, Anchor::End);
    let size = fitted(&plot.x.label, LABEL, area.rect.width - 2.0 * taken);
    let middle = area.rect.left + area.rect.width / 2.0;
    sheet.text(&plot.x.label, [middle, label_at], size, Anchor::Middle);
    label_at + 0.24 * LABEL
}

/// Which ticks get a number so that the numbers do not touch: every first, second, ...
fn labelled_every(at: &[(f64, String)], area: &Area) -> usize {
    let widest = at
        .iter()
        .map(|(_, text)| width(text) * SMALL)
        .fold(0.0, f64::max);
    let apart = area.rect.width / (area.x.1 - area.x.0)
        * at.windows(2)
            .map(|pair| pair[1].0 - pair[0].0)
            .fold(f64::INFINITY, f64::min);
    let every = ((widest + 5.0) / apart).ceil();
    if every.is_finite() {
        (every as usize).max(1)
    } else {
        1
    }
}
