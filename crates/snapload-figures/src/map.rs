//! Maps: a value, or a class, for every cell of a grid over two axes.

use crate::area::{Area, SMALL, fitted};
use crate::axis::{Span, Ticks, resolve, ticks};
use crate::draw::{GAP, LABEL, RIM, ROW, TICK, draw_x_axis, draw_y_axis};
use crate::error::FigureError;
use crate::picture::Picture;
use crate::plot::{Axis, Plot, Range, TickStyle, Width};
use crate::polyline::Rect;
use crate::scale::{CLASSES, LEVELS, level, shade};
use crate::svg::{Anchor, FRAME, Fill, Sheet};
use crate::text::{CAP_HEIGHT, plain, width};
use std::collections::BTreeMap;

/// The width of the colour bar, in points.
const BAR: f64 = 9.0;
/// From the map to the bar.
const BESIDE: f64 = 8.0;
/// The side of a sample in the legend.
const SAMPLE: f64 = 7.0;

/// A map. Its colours are told apart by colour-blind readers and in grey print.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// A small line above it; empty for none.
    pub title: String,
    /// What it shows, in a sentence, for readers who cannot see it; not printed.
    pub description: String,
    /// Symbol and unit of the axis along the bottom.
    pub x_label: String,
    /// The values along it, rising or falling, each in the middle of its cells.
    pub x: Vec<f64>,
    /// Symbol and unit of the axis along the left side.
    pub y_label: String,
    /// The values along it.
    pub y: Vec<f64>,
    /// The cells: for the first x all of y, then for the next.
    pub cells: Vec<Cell>,
    /// What the values are, written along the colour bar.
    pub value_label: String,
    /// The names of the classes.
    pub classes: Vec<String>,
}

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Cell {
    /// A number; one that is not finite counts as nothing.
    Value(f64),
    /// One of the classes, by its place in their list.
    Class(usize),
    /// Nothing.
    #[default]
    Empty,
    /// What could not be computed; hatched.
    Fault,
}

/// Draws a map.
///
/// # Errors
///
/// [`FigureError::NoPanel`] without values along an axis.
pub fn draw_map(name: &str, page: Width, map: &Map) -> Result<Picture, FigureError> {
    if map.x.is_empty() || map.y.is_empty() {
        return Err(FigureError::NoPanel);
    }
    let plot = map.frame();
    let bar = map.bar();
    let mut area = lay_out(page, &plot, bar.as_ref(), map);
    let mut sheet = Sheet::default();
    sheet.define_hatch();
    let mut top = RIM;
    if !map.title.is_empty() {
        let size = fitted(&map.title, LABEL, area.rect.width);
        sheet.text(
            &map.title,
            [area.rect.left, top + LABEL],
            size,
            Anchor::Start,
        );
        top += ROW + 1.5;
    }
    top = draw_legend(&mut sheet, map, &area, top);
    let factors = [
        ticks(plot.y.ticks, area.y).factor,
        bar.as_ref()
            .map(|b| b.ticks.factor.clone())
            .unwrap_or_default(),
    ];
    if factors.iter().any(|factor| !factor.is_empty()) {
        sheet.text(
            &factors[0],
            [area.rect.left, top + SMALL],
            SMALL,
            Anchor::Start,
        );
        sheet.text(
            &factors[1],
            [area.rect.right() + BESIDE, top + SMALL],
            SMALL,
            Anchor::Start,
        );
        top += ROW;
    }
    area.rect.top = top + 2.5;
    draw_cells(&mut sheet, map, &area, bar.as_ref());
    sheet.frame(&area.rect);
    draw_y_axis(&mut sheet, &plot, &area);
    if let Some(bar) = &bar {
        draw_bar(&mut sheet, map, &area, bar);
    }
    let bottom = draw_x_axis(&mut sheet, &plot, &area, true);
    let size = (page.points(), bottom + RIM);
    let words: Vec<String> = [plain(&map.title), plain(&map.description)]
        .into_iter()
        .filter(|w| !w.is_empty())
        .collect();
    let spoken = if words.is_empty() {
        name.to_string()
    } else {
        words.join("; ")
    };
    Ok(Picture::new(
        name,
        sheet.finish(size.0, size.1, &spoken),
        size,
    ))
}

/// The colour bar: the range of the values, and its ticks.
struct Bar {
    span: Span,
    ticks: Ticks,
}

impl Map {
    /// The axes, in the form in which they are drawn.
    fn frame(&self) -> Plot {
        let axis = |label: &str, at: &[f64]| {
            let edges = edges(at);
            let ends = (edges[0], edges[edges.len() - 1]);
            Axis {
                label: label.to_string(),
                range: Range::Fixed(ends.0.min(ends.1), ends.0.max(ends.1)),
                ticks: TickStyle::Decimal,
            }
        };
        Plot {
            x: axis(&self.x_label, &self.x),
            y: axis(&self.y_label, &self.y),
            ..Plot::default()
        }
    }

    fn bar(&self) -> Option<Bar> {
        let values = self.cells.iter().filter_map(|cell| match cell {
            Cell::Value(value) if value.is_finite() => Some((*value, *value)),
            _ => None,
        });
        let (low, high) = values.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let span = resolve(Range::Fixed(low, high), std::iter::once(low));
        let ticks = ticks(TickStyle::Decimal, span);
        Some(Bar { span, ticks })
    }

    fn cell(&self, i: usize, j: usize) -> Cell {
        let cell = self.cells.get(i * self.y.len() + j);
        cell.copied().unwrap_or_default()
    }
}

/// The borders of cells around values: halfway between neighbours.
fn edges(at: &[f64]) -> Vec<f64> {
    let between = |k: usize| at[k] + (at[k + 1] - at[k]) / 2.0;
    let last = at.len() - 1;
    if last == 0 {
        let half = if at[0] == 0.0 {
            0.5
        } else {
            0.05 * at[0].abs()
        };
        return vec![at[0] - half, at[0] + half];
    }
    let inner = (0..last).map(between);
    std::iter::once(2.0 * at[0] - between(0))
        .chain(inner)
        .chain(std::iter::once(2.0 * at[last] - between(last - 1)))
        .collect()
}

/// The place of the map on the page, at its top.
fn lay_out(page: Width, plot: &Plot, bar: Option<&Bar>, map: &Map) -> Area {
    let [x, y] = [&plot.x, &plot.y].map(|axis| resolve(axis.range, std::iter::empty()));
    let widest = |ticks: &Ticks| {
        let texts = ticks.at.iter().map(|(_, text)| width(text) * SMALL);
        texts.fold(0.0, f64::max)
    };
    let left = RIM + LABEL + 2.0 + widest(&ticks(plot.y.ticks, y)) + GAP + TICK;
    let overhang = widest(&ticks(plot.x.ticks, x)) / 2.0;
    let right = match bar {
        Some(bar) if map.value_label.is_empty() => BESIDE + BAR + TICK + GAP + widest(&bar.ticks),
        Some(bar) => BESIDE + BAR + TICK + GAP + widest(&bar.ticks) + 3.0 + LABEL,
        None => 0.0,
    };
    let width = page.points() - left - RIM - right.max(overhang);
    let shape = match page {
        Width::Column => 0.75,
        Width::Page => 0.62,
    };
    let rect = Rect {
        left,
        top: 0.0,
        width,
        height: shape * width,
    };
    Area { rect, x, y }
}

/// What stands for a cell.
fn fill(cell: Cell, bar: Option<&Bar>) -> Fill {
    match (cell, bar) {
        (Cell::Value(value), Some(bar)) if value.is_finite() => {
            Fill::Colour(shade(level(value, bar.span)))
        }
        (Cell::Class(class), _) => Fill::Colour(CLASSES[class % CLASSES.len()]),
        (Cell::Fault, _) => Fill::Hatch,
        _ => Fill::Blank,
    }
}

/// One path for all the cells of a colour; neighbours above one another are one rectangle.
fn draw_cells(sheet: &mut Sheet, map: &Map, area: &Area, bar: Option<&Bar>) {
    let mut of_fill: BTreeMap<Fill, Vec<Rect>> = BTreeMap::new();
    let (across, up) = (edges(&map.x), edges(&map.y));
    for i in 0..map.x.len() {
        let mut start = 0;
        for j in 0..map.y.len() {
            let this = fill(map.cell(i, j), bar);
            let ends = j + 1 == map.y.len() || fill(map.cell(i, j + 1), bar) != this;
            if ends {
                let [x0, y0] = area.to_page([across[i], up[start]]);
                let [x1, y1] = area.to_page([across[i + 1], up[j + 1]]);
                of_fill.entry(this).or_default().push(Rect {
                    left: x0.min(x1),
                    top: y0.min(y1),
                    width: (x1 - x0).abs(),
                    height: (y1 - y0).abs(),
                });
                start = j + 1;
            }
        }
    }
    for (fill, rects) in of_fill {
        sheet.rects(&rects, fill);
    }
}

fn draw_bar(sheet: &mut Sheet, map: &Map, area: &Area, bar: &Bar) {
    let rect = Rect {
        left: area.rect.right() + BESIDE,
        width: BAR,
        ..area.rect
    };
    let step = rect.height / LEVELS as f64;
    for level in 0..LEVELS {
        let piece = Rect {
            top: rect.bottom() - (level + 1) as f64 * step,
            height: step,
            ..rect
        };
        sheet.rects(&[piece], Fill::Colour(shade(level)));
    }
    sheet.frame(&rect);
    let mut widest = 0.0_f64;
    for (value, text) in &bar.ticks.at {
        let part = (value - bar.span.0) / (bar.span.1 - bar.span.0);
        let y = rect.bottom() - part * rect.height;
        sheet.segment([rect.right(), y], [rect.right() + TICK, y], FRAME);
        let base = y + 0.5 * CAP_HEIGHT * SMALL;
        sheet.text(
            text,
            [rect.right() + TICK + GAP, base],
            SMALL,
            Anchor::Start,
        );
        widest = widest.max(width(text) * SMALL);
    }
    let size = fitted(&map.value_label, LABEL, rect.height);
    let x = rect.right() + TICK + GAP + widest + 3.0 + 0.8 * LABEL;
    sheet.text_upwards(&map.value_label, [x, rect.top + rect.height / 2.0], size);
}

/// Samples of the classes that occur, and of what is no value, from `top` down; returns where they end.
fn draw_legend(sheet: &mut Sheet, map: &Map, area: &Area, top: f64) -> f64 {
    let occurs = |wanted: Cell| map.cells.contains(&wanted);
    let mut entries: Vec<(Fill, &str)> = map
        .classes
        .iter()
        .enumerate()
        .filter(|(class, _)| occurs(Cell::Class(*class)))
        .map(|(class, name)| (fill(Cell::Class(class), None), name.as_str()))
        .collect();
    if occurs(Cell::Empty) {
        entries.push((Fill::Blank, "none"));
    }
    if occurs(Cell::Fault) {
        entries.push((Fill::Hatch, "no legal case"));
    }
    let (mut cursor, mut row) = (area.rect.left, top);
    for (fill, words) in &entries {
        let wide = SAMPLE + 3.0 + width(words) * SMALL;
        if cursor > area.rect.left && cursor + wide > area.rect.right() {
            (cursor, row) = (area.rect.left, row + ROW);
        }
        let base = row + ROW - 2.5;
        let sample = Rect {
            left: cursor,
            top: base - SAMPLE + 1.0,
            width: SAMPLE,
            height: SAMPLE,
        };
        sheet.rects(&[sample], *fill);
        sheet.frame(&sample);
        sheet.text(words, [cursor + SAMPLE + 3.0, base], SMALL, Anchor::Start);
        cursor += wide + 10.0;
    }
    if entries.is_empty() { top } else { row + ROW }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(cells: Vec<Cell>) -> Map {
        Map {
            x: vec![0.0, 1.0, 2.0],
            y: vec![0.0, 0.5],
            cells,
            classes: vec!["settled".to_string(), "upper bound".to_string()],
            value_label: "*t* (T)".to_string(),
            ..Map::default()
        }
    }

    #[test]
    fn borders_are_halfway_between_values() {
        assert_eq!(edges(&[0.0, 1.0, 3.0]), [-0.5, 0.5, 2.0, 4.0]);
        assert_eq!(edges(&[2.0]), [1.9, 2.1]);
    }

    #[test]
    fn values_have_a_bar_and_classes_a_legend() -> Result<(), FigureError> {
        use Cell::{Class, Empty, Fault, Value};
        let values = map(vec![
            Value(0.0),
            Value(1.0),
            Value(2.0),
            Value(3.0),
            Empty,
            Fault,
        ]);
        let svg = draw_map("m", Width::Column, &values)?.svg().to_string();
        for wanted in ["no legal case", "none", "url(#hatch)", "#440154", "#fde725"] {
            assert!(svg.contains(wanted), "{wanted} is missing");
        }
        assert!(!svg.contains("settled"));
        let classes = map(vec![Class(0); 6]);
        let svg = draw_map("m", Width::Column, &classes)?.svg().to_string();
        assert!(
            svg.contains("settled") && !svg.contains("upper bound") && !svg.contains("#440154")
        );
        Ok(())
    }

    #[test]
    fn cells_cover_the_frame_without_a_seam() -> Result<(), FigureError> {
        let picture = draw_map("m", Width::Page, &map(vec![Cell::Value(1.0); 6]))?;
        assert!(picture.png(2.0)?.starts_with(b"\x89PNG"));
        assert!(draw_map("m", Width::Page, &Map::default()).is_err());
        Ok(())
    }
}
