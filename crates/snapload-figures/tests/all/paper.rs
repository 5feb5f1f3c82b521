//! The positions of lines and ticks on paper.

use proptest::prelude::*;
use snapload_figures::{
    Axis, Colour, Layer, Plot, Point, Range, Shape, Stroke, TickStyle, Width, draw,
};

/// How far a thinned line may stray from the given one, in points on paper.
const VISIBLE: f64 = 0.2;
/// Numbers are written with two decimals.
const ROUNDING: f64 = 0.01;
/// The ranges in which lines are drawn here.
const RANGES: [f64; 2] = [200.0, 100.0];

/// The elements of a picture, as read from its SVG.
pub(crate) struct Paper {
    /// Left, top, width and height of the frame.
    frame: [f64; 4],
    /// The pieces of the lines of the data.
    line: Vec<Vec<Point>>,
    /// The ticks.
    ticks: Vec<Vec<Point>>,
    /// The words at the ends of y ticks, from low to high, and other small words.
    numbers: Vec<String>,
    pub(crate) words: Vec<String>,
}

impl Paper {
    pub(crate) fn of(plot: Plot) -> Self {
        let picture = draw("test", Width::Column, &[plot]).expect("one panel can be drawn");
        let document = roxmltree::Document::parse(picture.svg()).expect("the picture is XML");
        let nodes = |name: &'static str| {
            document
                .descendants()
                .filter(move |node| node.has_tag_name(name))
        };
        let texts = |numbers: bool| -> Vec<String> {
            nodes("text")
                .filter(|node| (node.attribute("text-anchor") == Some("end")) == numbers)
                .map(|node| words_of(node))
                .collect()
        };
        let frame = nodes("rect").find(|node| node.attribute("fill") == Some("none"));
        let frame = frame.expect("a frame");
        let side = |name| {
            frame
                .attribute(name)
                .and_then(|text| text.parse().ok())
                .expect("a number")
        };
        let lines = |width: &str| -> Vec<Vec<Point>> {
            nodes("path")
                .filter(|node| node.attribute("stroke-width") == Some(width))
                .filter_map(|node| node.attribute("d"))
                .flat_map(pieces)
                .collect()
        };
        Self {
            frame: ["x", "y", "width", "height"].map(side),
            line: lines(".7"),
            ticks: lines(".5"),
            numbers: texts(true),
            words: texts(false),
        }
    }

    fn place(&self, [x, y]: Point) -> Point {
        let [left, top, width, height] = self.frame;
        [
            left + x / RANGES[0] * width,
            top + height - y / RANGES[1] * height,
        ]
    }

    fn all_held(&self) -> bool {
        self.line.iter().flatten().all(|point| self.holds(*point))
    }

    fn holds(&self, [x, y]: Point) -> bool {
        let [left, top, width, height] = self.frame;
        (left - ROUNDING..left + width + ROUNDING).contains(&x)
            && (top - ROUNDING..top + height + ROUNDING).contains(&y)
    }
}

fn words_of(node: roxmltree::Node) -> String {
    let texts = node.descendants().filter(|part| part.is_text());
    texts.filter_map(|part| part.text()).collect()
}

/// The pieces of path data of the form `M1 2l.5-.25 .5 .25`.
fn pieces(d: &str) -> Vec<Vec<Point>> {
    let piece = |text: &str| {
        let spaced = text.replace('-', " -").replace('l', " ");
        let numbers = spaced
            .split_whitespace()
            .map(|word| word.parse().expect("a number"));
        let numbers: Vec<f64> = numbers.collect();
        let mut at = [0.0, 0.0];
        let step = |by: &[f64]| {
            at = [at[0] + by[0], at[1] + by[1]];
            at
        };
        numbers.chunks_exact(2).map(step).collect()
    };
    d.split('M')
        .skip(1)
        .filter(|text| !text.contains(['a', 'm', 'z', 'H']))
        .map(piece)
        .collect()
}

/// A plot of the given layers in ranges that make positions easy to compute.
fn plot(layers: Vec<Layer>) -> Plot {
    let [x, y] = RANGES.map(|end| Axis::new("", Range::Fixed(0.0, end)));
    Plot {
        x,
        y,
        layers,
        ..Plot::default()
    }
}

/// The picture of a line.
fn drawn(points: &[Point]) -> Paper {
    let line = Layer::Line(vec![points.to_vec()], Stroke::default(), String::new());
    Paper::of(plot(vec![line]))
}

/// The largest distance of a given point from the drawn line.
fn error(points: &[Point], paper: &Paper) -> f64 {
    let nearest = |point: &Point| {
        let segments = paper.line.iter().flat_map(|piece| piece.windows(2));
        let place = paper.place(*point);
        segments
            .map(|ends| distance(place, ends[0], ends[1]))
            .fold(f64::INFINITY, f64::min)
    };
    points.iter().map(nearest).fold(0.0, f64::max)
}

fn distance(point: Point, from: Point, to: Point) -> f64 {
    let d = [to[0] - from[0], to[1] - from[1]];
    let r = [point[0] - from[0], point[1] - from[1]];
    let along = (r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    let along = if along.is_nan() {
        0.0
    } else {
        along.clamp(0.0, 1.0)
    };
    f64::hypot(r[0] - along * d[0], r[1] - along * d[1])
}

#[test]
fn a_path_is_a_point_and_steps_in_short_numbers() {
    let line = |points: &[Point]| {
        let layer = Layer::Line(vec![points.to_vec()], Stroke::default(), String::new());
        let picture = draw("test", Width::Column, &[plot(vec![layer])]).expect("one panel");
        let path = picture
            .svg()
            .lines()
            .find(|line| line.contains("\".7\""))
            .map(str::to_owned);
        path.and_then(|path| path.split('"').nth(1).map(str::to_owned))
    };
    let Paper {
        frame: [left, top, width, height],
        ..
    } = drawn(&[]);
    // Data for which the steps on paper are those of the wanted path.
    let data = |[x, y]: Point| {
        [
            (x - left) / width * RANGES[0],
            (top + height - y) / height * RANGES[1],
        ]
    };
    let bent = [[100.0, 40.0], [100.5, 39.75], [101.0, 40.0], [88.65, 47.0]].map(data);
    assert_eq!(
        line(&bent).as_deref(),
        Some("M100 40l.5-.25 .5 .25-12.35 7")
    );
    assert_eq!(line(&bent[..1]).as_deref(), Some("M100 40l0 0"));
    assert_eq!(line(&[]), None);
}

#[test]
fn a_long_smooth_line_needs_few_points() {
    let wave = |i: u32| {
        let t = f64::from(i) / 500.0;
        [t, 50.0 + 40.0 * (t / 18.0).sin()]
    };
    let points: Vec<Point> = (0..100_000).map(wave).collect();
    let line = drawn(&points);
    assert!(line.line[0].len() < 600, "{}", line.line[0].len());
    let sample: Vec<Point> = points.iter().copied().step_by(97).collect();
    assert!(error(&sample, &line) < VISIBLE);
}

#[track_caller]
fn assert_drawn(points: &[Point], expected: &[&[Point]]) {
    let paper = drawn(points);
    assert_eq!(paper.line.len(), expected.len());
    for (piece, expected) in paper.line.iter().zip(expected) {
        assert_eq!(piece.len(), expected.len());
        for (at, expected) in piece.iter().zip(*expected) {
            assert!(distance(*at, paper.place(*expected), paper.place(*expected)) < 2.0 * ROUNDING);
        }
    }
}

#[test]
fn a_line_is_cut_at_the_frame() {
    assert_drawn(
        &[[-10.0, 50.0], [10.0, 50.0], [10.0, 150.0], [20.0, 50.0]],
        &[
            &[[0.0, 50.0], [10.0, 50.0], [10.0, 100.0]],
            &[[15.0, 100.0], [20.0, 50.0]],
        ],
    );
    assert_drawn(&[[-1.0, 0.0]], &[]);
    assert_drawn(&[], &[]);
    // Along the frame, and a lone point on it.
    assert_drawn(
        &[[0.0, 100.0], [200.0, 100.0]],
        &[&[[0.0, 100.0], [200.0, 100.0]]],
    );
    assert_drawn(&[[200.0, 0.0]], &[&[[200.0, 0.0], [200.0, 0.0]]]);
}

#[test]
fn an_end_far_away_does_not_pull_the_other_out_of_the_frame() {
    for to in [[500.0, 50.0], [1e20, 60.0], [100.0, 50.0]] {
        let paper = drawn(&[[1e99, 50.0], to]);
        assert!(paper.all_held());
    }
}

#[test]
fn many_markers_are_thinned_and_few_are_not() {
    let markers = |count: u32| {
        let at = |i| [f64::from(i) * 200.0 / f64::from(count), f64::from(i % 100)];
        let points = (0..count).map(at).collect();
        let layer = Layer::Markers(points, Shape::Circle, Colour::BLACK, String::new());
        let picture = draw("test", Width::Column, &[plot(vec![layer])]).expect("one panel");
        // The path of a circle is closed, and no other is.
        picture.svg().matches("0z").count()
    };
    assert_eq!(markers(100), 100);
    assert_eq!(markers(6_000), 6_000);
    assert!((600..=6_000).contains(&markers(100_000)));
}

fn axis(style: TickStyle, range: Range) -> Paper {
    let y = Axis {
        label: String::new(),
        range,
        ticks: style,
    };
    Paper::of(Plot {
        y,
        ..Plot::default()
    })
}

fn numbers(style: TickStyle, from: f64, to: f64) -> Vec<String> {
    axis(style, Range::Fixed(from, to)).numbers
}

#[test]
fn ticks_are_written_as_a_reader_would() {
    use TickStyle::{Angle, Decimal};
    assert_eq!(numbers(Decimal, 0.0, 0.65), ["0.0", "0.2", "0.4", "0.6"]);
    assert_eq!(
        numbers(Decimal, -1.0, 1.0),
        ["−1.0", "−0.5", "0.0", "0.5", "1.0"]
    );
    assert_eq!(numbers(Decimal, 0.0, 30.0), ["0", "10", "20", "30"]);
    assert_eq!(
        numbers(Angle, -1.7, 1.7),
        ["−π/2", "−π/4", "0", "π/4", "π/2"]
    );
    assert_eq!(numbers(Angle, 0.0, 10.0), ["0", "π", "2π", "3π"]);
    assert_eq!(numbers(Angle, 0.0, 0.3), ["0.0", "0.1", "0.2", "0.3"]);
}

#[test]
fn large_and_small_numbers_share_a_power_of_ten() {
    let small = axis(TickStyle::Decimal, Range::Fixed(0.0, 3.0e-12));
    assert!(
        small.words.contains(&"×10⁻¹²".to_string()),
        "{:?}",
        small.words
    );
    assert_eq!(small.numbers, ["0", "1", "2", "3"]);
    let large = axis(TickStyle::Decimal, Range::Fixed(0.0, 3.0e6));
    assert!(
        large.words.contains(&"×10⁶".to_string()),
        "{:?}",
        large.words
    );
    let plain = axis(TickStyle::Decimal, Range::Fixed(0.0, 300.0));
    assert!(!plain.words.iter().any(|word| word.starts_with('×')));
}

/// The height in data of the lowest and highest tick of y, and their number, read from the picture.
fn ticks(plot: Plot, (low, high): (f64, f64)) -> (f64, f64, usize) {
    let paper = Paper::of(plot);
    let [left, top, _, height] = paper.frame;
    // The ticks of y are horizontal.
    let of_y = paper
        .ticks
        .iter()
        .filter(|tick| tick[0][1] == tick[1][1] && tick[0][0] < left);
    let height_of = |tick: &Vec<Point>| low + (top + height - tick[0][1]) / height * (high - low);
    let heights: Vec<f64> = of_y.map(height_of).collect();
    (heights[0], heights[heights.len() - 1], heights.len())
}

#[test]
fn a_range_is_never_empty() {
    let numbers = |range, data: &[f64]| {
        let points = data.iter().map(|y| [0.0, *y]).collect();
        let layers = vec![Layer::Markers(
            points,
            Shape::Cross,
            Colour::BLACK,
            String::new(),
        )];
        Paper::of(Plot {
            y: Axis::new("", range),
            layers,
            ..Plot::default()
        })
        .numbers
    };
    assert_eq!(
        numbers(Range::Auto, &[]),
        ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
    );
    assert_eq!(
        numbers(Range::Fixed(1.0, 1.0), &[2.0]),
        ["1.8", "1.9", "2.0", "2.1", "2.2"]
    );
    assert_eq!(
        numbers(Range::AtLeast(0.0, 0.0), &[]),
        numbers(Range::Auto, &[])
    );
    assert_eq!(
        numbers(Range::AtLeast(0.0, 0.0), &[0.0, 1.0]),
        numbers(Range::Auto, &[])
    );
    assert_eq!(
        numbers(Range::AtLeast(-1.0, 3.0), &[2.0]),
        ["−1", "0", "1", "2", "3"]
    );
}

/// On equal scales a line along one axis fills its frame but for the margin of 4 % at each end,
/// however short it is.
#[test]
fn a_line_along_an_axis_is_seen_on_equal_scales() {
    for length in [0.1, 1e-7] {
        for (end, across) in [([0.0, length], 1), ([length, 0.0], 0)] {
            let line = vec![vec![[0.0, 0.0], end]];
            let layers = vec![Layer::Line(line, Stroke::default(), String::new())];
            let paper = Paper::of(Plot {
                layers,
                equal_scale: true,
                ..Plot::default()
            });
            let ends: Vec<f64> = paper.line[0].iter().map(|point| point[across]).collect();
            let part = (ends[ends.len() - 1] - ends[0]).abs() / paper.frame[2 + across];
            assert!(part > 1.0 / 1.08 - 1e-3, "{part} {end:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn ticks_cover_the_range_in_steps_of_one_two_five(
        middle in -1.0e3..1.0e3_f64, size in -12.0..8.0_f64, angle in any::<bool>(),
    ) {
        let half = 10_f64.powf(size);
        // A range that is too narrow for its magnitude is widened, so that its ends are not known
        // here.
        prop_assume!(2.0 * half > 2e-10 * (middle.abs() + half));
        let (low, high) = (middle - half, middle + half);
        let style = if angle { TickStyle::Angle } else { TickStyle::Decimal };
        let y = Axis { ticks: style, ..Axis::new("", Range::Fixed(low, high)) };
        let (first, last, count) = ticks(Plot { y, ..Plot::default() }, (low, high));
        prop_assert!((3..=9).contains(&count), "{count} on {low} to {high}");
        let step = (last - first) / (count - 1) as f64;
        // Places are rounded to a hundredth of a point on a frame of some hundred points.
        let air = 1e-3 * (high - low);
        prop_assert!(first >= low - air && first - step < low + air);
        prop_assert!(last <= high + air && last + step > high - air);
        if !angle {
            let mantissa = step / 10_f64.powf((step * 1.01).log10().floor());
            prop_assert!([1.0, 2.0, 5.0].iter().any(|m| (mantissa / m - 1.0).abs() < 1e-2));
        }
    }

    #[test]
    fn any_two_numbers_make_a_range(a in any::<f64>(), b in any::<f64>(), v in -1e99..1e99_f64) {
        for range in [Range::Fixed(a, b), Range::AtLeast(a, b), Range::Auto] {
            for data in [vec![], vec![v], vec![v, 0.0], vec![v, v * (1.0 + 1e-12)]] {
                let points = data.into_iter().map(|y| [0.0, y]).collect();
                let layers = vec![Layer::Markers(points, Shape::Cross, Colour::BLACK, String::new())];
                let paper = Paper::of(Plot { y: Axis::new("", range), layers, ..Plot::default() });
                prop_assert!((3..=9).contains(&paper.numbers.len()), "{:?}", paper.numbers);
                prop_assert!(paper.frame.iter().all(|side| side.is_finite()));
            }
        }
    }

    #[test]
    fn thinning_is_not_seen(
        noise in prop::collection::vec(0.0..100.0_f64, 2..800), repeat in 1..20_usize,
    ) {
        let n = noise.len() * repeat;
        let at = |i: usize| [200.0 * i as f64 / n as f64, noise[i % noise.len()]];
        let points: Vec<Point> = (0..n).map(at).collect();
        let line = drawn(&points);
        prop_assert!(line.line.iter().map(Vec::len).sum::<usize>() <= n);
        let sample: Vec<Point> = points.iter().copied().step_by(1 + n / 500).collect();
        prop_assert!(error(&sample, &line) < VISIBLE);
    }

    #[test]
    fn what_is_cut_lies_in_the_frame(
        points in prop::collection::vec(prop::array::uniform2(-300.0..300.0_f64), 0..50),
    ) {
        let paper = drawn(&points);
        prop_assert!(paper.all_held());
    }
}
