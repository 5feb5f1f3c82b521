//! A plot within a plot: an enlarged part, or the whole of which the plot shows a part.

use crate::pictures::picture;
use snapload::{Case, CaseError, Parameters, named_case};
use snapload_figures::{Axis, Colour, Inset, Layer, Plot, Range, RunPlot, RunPlots, Shape, Stroke};

/// A line from the origin to a point.
fn line(to: f64) -> Plot {
    let points = vec![[0.0, 0.0], [to, to]];
    Plot {
        x: Axis::new("x", Range::Auto),
        y: Axis::new("y", Range::Auto),
        layers: vec![Layer::Line(vec![points], Stroke::default(), String::new())],
        ..Plot::default()
    }
}

fn words(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("the picture is XML");
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    texts
        .filter_map(|node| Some(node.text()?.to_owned()))
        .collect()
}

/// The frames of a picture: left, top, width, height.
fn frames(svg: &str) -> Vec<[f64; 4]> {
    let document = roxmltree::Document::parse(svg).expect("the picture is XML");
    let frames = document
        .descendants()
        .filter(|node| node.has_tag_name("rect") && node.attribute("fill") == Some("none"));
    let side = |node: roxmltree::Node, name| node.attribute(name)?.parse().ok();
    let sides = |node| ["x", "y", "width", "height"].map(|name| side(node, name).unwrap_or(0.0));
    frames.map(sides).collect()
}

#[test]
fn an_inset_stands_within_the_frame_with_numbers_of_its_own() {
    let with = Plot {
        inset: Some(Box::new(Inset {
            plot: line(0.004),
            place: [0.5, 0.1, 0.95, 0.6],
        })),
        ..line(700.0)
    };
    let (plain, with) = (picture(line(700.0)), picture(with));
    assert_eq!(
        (frames(plain.svg()).len(), frames(with.svg()).len()),
        (1, 2)
    );
    let [outer, inner] = [0, 1].map(|k| frames(with.svg())[k]);
    for k in 0..2 {
        assert!(inner[k] > outer[k] && inner[k] + inner[k + 2] < outer[k] + outer[k + 2]);
    }
    assert!(words(with.svg()).len() > words(plain.svg()).len());
}

#[test]
fn markers_of_plots_that_are_compared_have_one_size() {
    let marked = |count: usize, at_least: usize| Plot {
        markers: at_least,
        layers: vec![Layer::Markers(
            (0..count).map(|k| [k as f64, 1.0 + k as f64]).collect(),
            Shape::Circle,
            Colour::BLACK,
            String::new(),
        )],
        ..line(1.0)
    };
    // Alone, few markers are larger than many; beside many they are as small.
    let few = picture(marked(3, 0)).svg().to_owned();
    let beside = picture(marked(3, 500)).svg().to_owned();
    assert_ne!(few, beside);
    assert_eq!(picture(marked(500, 0)).svg(), picture(marked(500, 3)).svg());
}

/// The picture of a run that continues without snaps shows the part with snaps, and the whole as an
/// inset; that of a run that snaps to its end has no inset.
#[test]
fn snaps_are_shown_where_they_are() -> Result<(), CaseError> {
    let plot = |code: &str| -> Result<Plot, CaseError> {
        let run = Case::new(named_case(code)?.parameters)?.run();
        Ok(RunPlots::new(&run).plot(RunPlot::Snaps))
    };
    let quiet = plot("rocking-example")?;
    let inset = quiet.inset.expect("an inset");
    assert!(matches!(quiet.x.range, Range::Fixed(0.0, end) if end < 10.0));
    assert_eq!(inset.plot.x.range, Range::AtLeast(0.0, 100.0));
    assert!(plot("1910001000-359")?.inset.is_none());
    Ok(())
}

/// A run with its few snaps in a small part of its time: the inset covers none of them, as every
/// marker of the part that is shown is outside of its place.
#[test]
fn an_inset_covers_no_snap() -> Result<(), CaseError> {
    for given in [
        Parameters {
            vx: 50.0,
            t_end: 1.0,
            ..Parameters::STANDARD
        },
        Parameters {
            e: 0.0,
            f_o: 0.2,
            t_end: 400.0,
            stop_when_settled: false,
            ..Parameters::STANDARD
        },
        named_case("rocking-example")?.parameters,
    ] {
        let run = Case::new(given)?.run();
        let plot = RunPlots::new(&run).plot(RunPlot::Snaps);
        let [left, bottom, right, top] = plot.inset.expect("an inset").place;
        let Range::Fixed(0.0, end) = plot.x.range else {
            panic!("{:?}", plot.x.range);
        };
        let snaps = run.impacts().iter().filter(|impact| impact.v_n > 0.0);
        let snaps: Vec<_> = snaps.map(|impact| (impact.t, impact.v_n)).collect();
        let highest = snaps.iter().map(|snap| snap.1).fold(0.0, f64::max);
        assert!(!snaps.is_empty());
        for (t, v_n) in snaps {
            // The axis ends between the highest snap and a tenth above it.
            let [along, low, high] = [t / end, v_n / (1.1 * highest), v_n / highest];
            let beside = along < left || along > right;
            assert!(
                beside || high < bottom || low > top,
                "{t} {v_n} {left} {bottom}"
            );
        }
    }
    Ok(())
}
