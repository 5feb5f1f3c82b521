//! The positions of a map's areas on paper, and their shades.

use crate::paper::Paper;
use snapload_figures::{Axis, Cell, Layer, Map, Plot, Range, Width, draw};

/// The colours and places of the areas of a map of values, in the order in which they are drawn.
fn areas(map: Map) -> Vec<([u8; 3], Vec<f64>)> {
    let plot = Plot {
        layers: vec![Layer::Map(map)],
        ..Plot::default()
    };
    let picture = draw("test", Width::Column, &[plot]).expect("one panel can be drawn");
    let document = roxmltree::Document::parse(picture.svg()).expect("the picture is XML");
    let areas = document
        .descendants()
        .filter(|node| node.has_attribute("shape-rendering"));
    let area = |node: roxmltree::Node| {
        let colour = node
            .attribute("fill")
            .and_then(|fill| fill.strip_prefix('#'));
        let colour = u32::from_str_radix(colour.expect("a colour"), 16).expect("a number");
        let [_, r, g, b] = colour.to_be_bytes();
        let d = node
            .attribute("d")
            .expect("a path")
            .replace(['M', 'H', 'V', 'z'], " ");
        (
            [r, g, b],
            d.split_whitespace()
                .map(|word| word.parse().expect("a number"))
                .collect(),
        )
    };
    areas.map(area).collect()
}

fn map(x: &[f64], cells: Vec<Cell>) -> Map {
    Map {
        x: x.to_vec(),
        y: vec![0.0],
        cells,
        ..Map::default()
    }
}

#[test]
fn shades_grow_lighter_from_end_to_end() {
    let cells = [2.0, 3.0, 4.0].map(Cell::Value).to_vec();
    let areas = areas(map(&[0.0, 1.0, 2.0], cells));
    // Three cells, then the bar from its lower end to its upper one.
    let (cells, bar) = areas.split_at(3);
    let light = |[r, g, b]: [u8; 3]| 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
    assert_eq!(bar.len(), 64);
    assert!(
        bar.windows(2)
            .all(|pair| light(pair[0].0) < light(pair[1].0))
    );
    assert_eq!(
        (bar[0].0, bar[63].0),
        ([0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25])
    );
    let mut colours: Vec<[u8; 3]> = cells.iter().map(|cell| cell.0).collect();
    colours.sort_by(|a, b| light(*a).total_cmp(&light(*b)));
    assert_eq!(colours, [bar[0].0, bar[32].0, bar[63].0]);
}

#[test]
fn borders_of_cells_are_halfway_between_values() {
    let borders = |x: &[f64]| {
        let cells = (0..x.len()).map(|k| Cell::Value(k as f64)).collect();
        let areas = areas(map(x, cells));
        let mut sides: Vec<f64> = areas[..x.len()]
            .iter()
            .flat_map(|area| [area.1[0], area.1[2]])
            .collect();
        sides.sort_by(f64::total_cmp);
        sides.dedup();
        let (first, last) = (sides[0], sides[sides.len() - 1]);
        sides
            .into_iter()
            .map(|side| (side - first) / (last - first))
            .collect::<Vec<f64>>()
    };
    // From −0.5 to 4.
    let expected = [0.0, 1.0, 2.5, 4.5].map(|side| side / 4.5);
    for (side, expected) in borders(&[0.0, 1.0, 3.0]).into_iter().zip(expected) {
        assert!((side - expected).abs() < 1e-3);
    }
    let alone = Map {
        x: vec![2.0],
        y: vec![0.0],
        cells: vec![Cell::Value(1.0)],
        ..Map::default()
    };
    let x = Axis::new("", Range::Auto);
    let numbers = Paper::of(Plot {
        x,
        layers: vec![Layer::Map(alone)],
        ..Plot::default()
    })
    .words;
    for expected in ["1.90", "2.10"] {
        assert!(
            numbers.iter().any(|number| number == expected),
            "{numbers:?}"
        );
    }
}
