//! Every picture is well-formed, labelled and of the right size, and none causes a panic.

use proptest::prelude::*;
use snapload_figures::{
    Axis, Cell, Colour, FigureError, Layer, Map, Mark, Mode, PathPart, Picture, Plot, Point, Range,
    Shape, Stroke, TickStyle, Width, draw, energy, rotation, snap_velocities, tensions, trajectory,
};

/// The five figures, all from the same points.
fn figures(points: &[Point], horizon: Option<f64>) -> Vec<Plot> {
    let parts: Vec<PathPart> = [
        Mode::Slack,
        Mode::Sliding,
        Mode::Rocking,
        Mode::BeyondHorizon,
    ]
    .into_iter()
    .map(|mode| PathPart {
        mode,
        points: points.to_vec(),
    })
    .collect();
    let letters = ["I", "S", "R", "G", "E"].into_iter().zip(points);
    let marks: Vec<Mark> = letters
        .map(|(letter, &at)| Mark {
            at,
            letter: letter.to_string(),
        })
        .collect();
    let pieces: Vec<Vec<Point>> = points
        .chunks(3.max(points.len() / 20))
        .map(<[Point]>::to_vec)
        .collect();
    vec![
        trajectory(&parts, [points, points], &marks),
        rotation(points, horizon),
        snap_velocities([points, points], horizon),
        tensions([&pieces, &pieces], horizon),
        energy(points, horizon),
    ]
}

pub fn picture(plot: Plot) -> Picture {
    draw("test", Width::Column, &[plot]).expect("one panel can be drawn")
}

/// All letters of a picture, without its title; asserts that it is XML and all its numbers finite.
fn letters(picture: &Picture) -> Vec<String> {
    let document = roxmltree::Document::parse(picture.svg()).expect("the picture is XML");
    let root = document.root_element();
    assert_eq!(root.attribute("role"), Some("img"));
    assert!(
        root.first_element_child()
            .is_some_and(|child| child.has_tag_name("title"))
    );
    for attribute in root.descendants().flat_map(|node| node.attributes()) {
        let value = attribute.value();
        assert!(!value.contains("NaN") && !value.contains("inf"), "{value}");
    }
    root.descendants()
        .filter(|node| node.has_tag_name("text"))
        .map(|node| {
            node.descendants()
                .filter_map(|child| child.is_text().then(|| child.text()).flatten())
                .collect()
        })
        .collect()
}

#[track_caller]
fn assert_contains_texts(plot: Plot, words: &[&str]) {
    let texts = letters(&picture(plot));
    for word in words {
        assert!(
            texts.iter().any(|text| text == word),
            "{word:?} is not among {texts:?}"
        );
    }
}

#[test]
fn what_lies_past_the_horizon_is_grey_and_nothing_else_is() {
    let grey = |mode| {
        let points = vec![[0.0, 0.0], [1.0, 2.0], [2.0, 1.0]];
        let plot = trajectory(&[PathPart { mode, points }], [&[], &[]], &[]);
        picture(plot).svg().contains("#999")
    };
    assert!(grey(Mode::BeyondHorizon));
    assert!(
        ![Mode::Slack, Mode::Sliding, Mode::Rocking]
            .into_iter()
            .any(grey)
    );
}

#[test]
fn every_figure_contains_its_labels() {
    let wave: Vec<Point> = (0..200)
        .map(|i| f64::from(i) / 20.0)
        .map(|t| [t, 2.0 + t.sin()])
        .collect();
    let up: Vec<Point> = vec![[0.0, 1.0], [3.0, 3.0]];
    let down: Vec<Point> = vec![[6.0, 3.0], [10.0, 1.0]];
    let parts = [
        PathPart {
            mode: Mode::Slack,
            points: wave.clone(),
        },
        PathPart {
            mode: Mode::Rocking,
            points: up.clone(),
        },
    ];
    let mark = |letter: &str, at| Mark {
        at,
        letter: letter.to_string(),
    };
    let marks = [
        mark("I", wave[0]),
        mark("S", [5.0, 2.0]),
        mark("G", [5.001, 2.0]),
    ];
    assert_contains_texts(
        trajectory(&parts, [&up, &down], &marks),
        &[
            "x (L)",
            "y (L)",
            "g₁ = 0, θ = 0",
            "g₂ = 0, θ = 0",
            "I",
            "S,G",
            "slack",
            "rocking",
        ],
    );
    assert_contains_texts(
        rotation(&wave, Some(4.0)),
        &["θ (rad)", "t (T)", "π/2", "−π/2", "past the horizon"],
    );
    assert_contains_texts(
        snap_velocities([&wave, &wave], None),
        &["vₙ⁻ (L/T)", "t (T)", "cable 1", "cable 2"],
    );
    assert_contains_texts(
        tensions([&[up], &[down]], None),
        &["T (F)", "t (T)", "cable 1", "cable 2"],
    );
    assert_contains_texts(energy(&wave, None), &["E (F L)", "t (T)"]);
}

#[test]
fn empty_figures_have_a_note() {
    assert_contains_texts(
        tensions([&[], &[]], None),
        &["no interval with a taut cable"],
    );
    assert_contains_texts(
        snap_velocities([&[], &[]], Some(1.0)),
        &["no cable snapped taut"],
    );
    assert_contains_texts(energy(&[[f64::NAN, 1.0]], None), &["no data"]);
    assert_contains_texts(trajectory(&[], [&[], &[]], &[]), &["no data"]);
    assert_contains_texts(rotation(&[], None), &["no data", "π/2"]);
}

#[test]
fn a_horizon_outside_the_picture_is_not_mentioned() {
    let texts = letters(&picture(energy(&[[0.0, 1.0], [1.0, 2.0]], Some(5.0))));
    assert!(!texts.iter().any(|text| text.contains("horizon")));
}

#[test]
fn hostile_points_make_pictures() {
    let extremes: [&[Point]; 8] = [
        &[],
        &[[1.0, 1.0]],
        &[[0.0, 0.0]; 5],
        &[[0.0, 3.0], [1.0, 3.0]],
        &[[0.0, 1e-12], [1e-12, 3e-12]],
        &[[0.0, 1e6], [1e6, -1e6]],
        &[
            [f64::NAN, 1.0],
            [1.0, f64::INFINITY],
            [2.0, 2.0],
            [f64::MAX, f64::MIN],
            [3.0, 1.0],
        ],
        &[[1e6, 7.2], [1e6 + 1e-6, 7.2 + 1e-8]],
    ];
    for points in extremes {
        for horizon in [None, Some(0.5), Some(f64::NAN), Some(f64::NEG_INFINITY)] {
            let plots = figures(points, horizon);
            for plot in plots.clone() {
                letters(&picture(plot));
            }
            let stack = draw("stack", Width::Page, &plots[1..]).expect("four panels can be drawn");
            letters(&stack);
        }
    }
}

#[test]
fn hostile_words_are_written_as_they_stand() {
    let words = "a<b>&\"c'\u{0}\u{7}\n *d* *".to_string();
    let plot = Plot {
        title: words.clone(),
        description: words.clone(),
        note: words.clone(),
        x: Axis {
            label: words.repeat(50),
            ..Axis::default()
        },
        layers: vec![
            Layer::Horizontal(0.5, words.repeat(50)),
            Layer::Boundary(vec![[0.0, 0.0], [1.0, 1.0]], words.clone()),
            Layer::Letters(vec![Mark {
                at: [0.5, 0.5],
                letter: words.repeat(50),
            }]),
        ],
        ..Plot::default()
    };
    assert!(
        letters(&picture(plot))
            .iter()
            .any(|text| text.starts_with("a<b>&\"c'"))
    );
}

#[test]
fn letters_between_asterisks_are_italic() {
    let svg = |words: &str| {
        let (title, description) = (words.to_string(), words.to_string());
        picture(Plot {
            title,
            description,
            ..Plot::default()
        })
        .svg()
        .to_string()
    };
    assert!(svg("*t* in s").contains("><tspan font-style=\"italic\">t</tspan> in s</text>"));
    assert!(svg("a < b").contains(">a &lt; b</text>"));
    assert!(svg("*x* 2*3").contains("><tspan font-style=\"italic\">x</tspan> 2*3</text>"));
    assert!(svg("case *π*").contains("<title>case π; case π</title>"));
    assert!(svg("*").contains("<title>*; *</title>"));
    assert!(svg("").contains("<title>test</title>"));
}

fn map(cells: Vec<Cell>) -> Plot {
    let map = Map {
        x: vec![0.0, 1.0, 2.0],
        y: vec![0.0, 0.5],
        cells,
        classes: vec!["settled".to_string(), "upper bound".to_string()],
        value_label: "*t* (T)".to_string(),
        ..Map::default()
    };
    Plot {
        layers: vec![Layer::Map(map)],
        ..Plot::default()
    }
}

#[test]
fn values_have_a_bar_and_classes_a_legend() {
    use Cell::{Class, Empty, Illegal, Value};
    let values = picture(map(vec![
        Value(0.0),
        Value(1.0),
        Value(2.0),
        Value(3.0),
        Empty,
        Illegal,
    ]));
    let texts = letters(&values);
    for expected in ["no legal case", "no value", "t (T)", "0", "3"] {
        assert!(
            texts.iter().any(|text| text == expected),
            "{expected} is not among {texts:?}"
        );
    }
    assert!(!texts.iter().any(|text| text == "settled"));
    for expected in ["url(#hatch)", "#440154", "#fde725"] {
        assert!(values.svg().contains(expected), "{expected} is missing");
    }
    let classes = picture(map(vec![Class(0); 6]));
    let texts = letters(&classes);
    assert!(texts.iter().any(|text| text == "settled"));
    assert!(
        !texts
            .iter()
            .any(|text| text == "upper bound" || text == "no data")
    );
    assert!(!classes.svg().contains("#440154"));
}

/// Uncertain cells keep their colour and are hatched on top; cells without a value are not hatched.
#[test]
fn uncertain_cells_are_hatched() {
    use Cell::{Class, Empty, Illegal};
    let hatched = |cells: Vec<Cell>, uncertain: Vec<bool>| {
        let mut plot = map(cells);
        if let Layer::Map(map) = &mut plot.layers[0] {
            map.uncertain = uncertain;
        }
        picture(plot)
    };
    let some = hatched(vec![Class(0); 6], vec![false, true, true]);
    assert!(letters(&some).iter().any(|text| text == "not certain"));
    // The cells, and the sample of the legend.
    assert_eq!(some.svg().matches("fill=\"url(#doubt)\"").count(), 2);
    let certain = hatched(vec![Class(0); 6], Vec::new());
    // Everything that is drawn without uncertainty is drawn with it, too.
    for line in certain.svg().lines() {
        assert!(some.svg().contains(line), "{line}");
    }
    let nothing = hatched([Empty, Illegal].repeat(3), vec![true; 6]);
    assert!(!nothing.svg().contains("doubt"));
    assert!(!letters(&nothing).iter().any(|text| text == "not certain"));

    let mut plot = map(vec![Class(0); 6]);
    if let Layer::Map(map) = &mut plot.layers[0] {
        map.uncertain = vec![true];
        map.uncertain_words = "at least".to_owned();
    }
    let texts = letters(&picture(plot));
    assert!(texts.iter().any(|text| text == "at least"));
    assert!(!texts.iter().any(|text| text == "not certain"));
}

#[test]
fn a_map_becomes_pixels_and_an_empty_one_is_an_error() {
    let even = picture(map(vec![Cell::Value(1.0); 6]));
    assert!(even.png(2.0).expect("a PNG").starts_with(b"\x89PNG"));
    let empty = Plot {
        layers: vec![Layer::Map(Map::default())],
        ..Plot::default()
    };
    assert_eq!(draw("m", Width::Page, &[empty]), Err(FigureError::NoPanel));
}

#[test]
fn a_hundred_thousand_points_stay_small() {
    let n = 100_000;
    let time = |i: u32| 7.2 * f64::from(i) / f64::from(n);
    let noise = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / 1e8;
    let smooth: Vec<Point> = (0..n).map(|i| [time(i), (9.0 * time(i)).sin()]).collect();
    let rough: Vec<Point> = (0..n).map(|i| [time(i), noise(i)]).collect();
    let spiral: Vec<Point> = (0..n).map(|i| [time(i), 9.0 * time(i)]).collect();
    let spiral: Vec<Point> = spiral
        .iter()
        .map(|[r, a]| [r * a.cos(), r * a.sin()])
        .collect();
    for points in [smooth, rough] {
        for plot in figures(&points, None).into_iter().skip(1) {
            let size = draw("long", Width::Page, &[plot])
                .expect("one panel")
                .svg()
                .len();
            assert!(size < 500_000, "{size}");
        }
    }
    let path = trajectory(
        &[PathPart {
            mode: Mode::Slack,
            points: spiral,
        }],
        [&[], &[]],
        &[],
    );
    let size = picture(path).svg().len();
    assert!(size < 100_000, "{size}");
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    assert_eq!(draw("none", Width::Column, &[]), Err(FigureError::NoPanel));
    let equal = Plot {
        equal_scale: true,
        ..Plot::default()
    };
    let stack = [equal, Plot::default()];
    assert_eq!(
        draw("two", Width::Column, &stack),
        Err(FigureError::EqualScaleInStack)
    );
}

#[test]
fn the_same_points_give_the_same_bytes() {
    let points: Vec<Point> = (0..500)
        .map(f64::from)
        .map(|t| [t, (t / 9.0).cos()])
        .collect();
    let draw_all = || -> Vec<String> {
        figures(&points, Some(100.0))
            .into_iter()
            .map(|plot| picture(plot).svg().to_string())
            .collect()
    };
    assert_eq!(draw_all(), draw_all());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_points_and_no_range_make_a_panic(
        points in prop::collection::vec(prop::array::uniform2(any::<f64>()), 0..40),
        small in prop::collection::vec(prop::array::uniform2(-1.0..1.0_f64), 0..40),
        ends in prop::array::uniform4(any::<f64>()),
        equal_scale in any::<bool>(),
    ) {
        let all: Vec<Point> = points.into_iter().chain(small).collect();
        for plot in figures(&all, Some(ends[0])) {
            letters(&picture(plot));
        }
        let legend = "all".to_string();
        let shape = Shape::Circle;
        let plot = Plot {
            equal_scale,
            x: Axis { range: Range::Fixed(ends[0], ends[1]), ..Axis::default() },
            y: Axis { range: Range::AtLeast(ends[2], ends[3]), ticks: TickStyle::Angle, ..Axis::default() },
            layers: vec![
                Layer::Line(vec![all.clone()], Stroke::default(), legend.clone()),
                Layer::Markers(all, shape, Colour::default(), legend),
            ],
            ..Plot::default()
        };
        letters(&picture(plot));
    }
}
