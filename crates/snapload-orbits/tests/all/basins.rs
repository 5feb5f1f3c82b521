//! Safe basins, cell by cell.

use crate::common::{number, parameters, reference};
use serde_json::Value as Json;
use snapload::analysis::no_progress;
use snapload::{Parameters, Stop, key_named};
use snapload_orbits::{Basin, Cell, Erosion, KNEE, Window, basin_summary, erosion_summary};

/// Evenly spaced decimals, as in a grid of the command.
fn even(axis: &Json) -> (&'static str, Vec<f64>) {
    let key = key_named(axis[0].as_str().unwrap()).unwrap().name;
    let [first, last] = [1, 2].map(|i| number(&axis[i]));
    let count = axis[3].as_u64().unwrap() as usize;
    let value = |k: usize| first + (last - first) * k as f64 / (count - 1) as f64;
    // The nearest short decimals.
    let written = |k| (value(k) * 1e12).round() / 1e12;
    (key, (0..count).map(written).collect())
}

fn window(grid: &Json) -> Window {
    let [(a, first), (b, second)] = [0, 1].map(|i| even(&grid["axes"][i]));
    Window {
        base: Parameters {
            t_end: number(&grid["t_end"]),
            ..parameters(&grid["base"])
        },
        keys: [a, b],
        values: [first, second],
    }
}

fn letter(cell: &Cell) -> char {
    match cell.end {
        None => '.',
        Some((Stop::Settled, _)) => 's',
        Some((Stop::EndTime, _)) => 't',
        Some((Stop::RotationLimit, _)) => 'R',
        Some((Stop::UpperBound, _)) => 'U',
        Some((other, _)) => panic!("{other:?}"),
    }
}

/// Decided cells agree whether they are safe, nearly all of them how they end, and so do the
/// measures.
fn agrees(name: &str, trust: bool) {
    let grid = &reference()["grids"][name];
    let basin = Basin::of(window(grid), trust, &no_progress).unwrap();
    let known: String = grid["rows"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row.as_str().unwrap())
        .collect();
    assert_eq!(known.len(), basin.cells.len());
    // A start whose cable is exactly taut is legal here, and was not in the reference.
    let (mut compared, mut on_the_edge) = (0, 0);
    let is_safe = |letter: char| "st".contains(letter);
    for (k, (cell, known)) in basin.cells.iter().zip(known.chars()).enumerate() {
        if known == '.' && cell.end.is_some() {
            on_the_edge += 1;
        } else if cell.decided && !"?!".contains(known) {
            let found = letter(cell);
            let at = basin.window.at(k);
            assert_eq!(is_safe(found), is_safe(known), "{name} at {at:?}");
            compared += usize::from(found == known);
        }
    }
    let measures = basin.measures;
    println!("{name}: {compared} compared, {measures:?}");
    assert_eq!(
        (measures.legal - on_the_edge) as f64,
        number(&grid["legal"])
    );
    assert!(on_the_edge <= 2);
    assert!(compared > basin.cells.len() * 97 / 100);
    let [low, high] = [0, 1].map(|i| number(&grid["wilson95"][i]));
    let [ours_low, ours_high] = measures.interval;
    assert!(low < measures.gim && measures.gim < high);
    assert!((ours_low - low).abs() < 0.002 && (ours_high - high).abs() < 0.002);
    if let Some(lim) = grid["LIM"].as_f64() {
        assert!((measures.lim.unwrap() - lim).abs() < 1e-12);
    }
    if let Some(radius) = grid["IF"].as_f64() {
        assert!(
            (measures.integrity_factor.unwrap() - radius).abs() < 1e-9,
            "{measures:?}"
        );
    }
}

#[test]
fn cells_are_those_of_the_reference() {
    agrees("circle_xy_f0.1", true);
    agrees("circle_xy_f0.3", false);
    agrees("circle_f_omega", false);
}

/// Without waves many cells are undecided, and nearly all of them ended as safe: the knee is still
/// that of the reference, which lies between the bounds from these cells.
#[test]
fn the_knee_is_that_of_the_decided_cells() {
    let curve = &reference()["curves"]["circle_xy"];
    let points = curve["points"].as_array().unwrap();
    let chosen: Vec<_> = [0, 1, 9, 10].map(|k| &points[k]).to_vec();
    let [first, .., before, after] = [0, 1, 2, 3].map(|k| number(&chosen[k]["fraction"]));
    assert!(before > KNEE * first && after < KNEE * first);
    let values: Vec<f64> = chosen.iter().map(|point| number(&point["f_o"])).collect();
    let erosion = Erosion::of(&window(curve), "f_o", &values, true, &no_progress).unwrap();
    assert_eq!(erosion.knee(), Some(values[2]));
    // As a part of all cells the first value's safe part is too large, so that the knee is too
    // early.
    let [low, high] = erosion.knee_between().unwrap();
    assert!(low.is_some_and(|low| low < values[2]), "{low:?}");
    assert!(high.is_none_or(|high| high >= values[2]), "{high:?}");
    let text = erosion_summary(&erosion);
    assert!(
        text.contains("depending on how undecided cells end"),
        "{text}"
    );
}

/// The knee and the rows are those of the values, in whatever order these are given.
#[test]
fn the_order_of_the_values_does_not_matter() {
    let window = Window {
        base: Parameters {
            t_end: 20.0,
            ..Parameters::STANDARD
        },
        keys: ["x", "y"],
        values: [vec![-0.2, 0.0, 0.2], vec![0.1, 0.3, 0.5]],
    };
    let text = |values: &[f64]| {
        let over = Erosion::of(&window, "f_o", values, false, &no_progress).unwrap();
        let given: Vec<f64> = over.points.iter().map(|(value, _)| *value).collect();
        assert_eq!(given, [0.0, 0.2, 0.4, 0.6, 0.8]);
        (over.knee(), erosion_summary(&over))
    };
    let rising = text(&[0.0, 0.2, 0.4, 0.6, 0.8]);
    assert!(rising.0.is_some(), "{}", rising.1);
    for given in [[0.8, 0.6, 0.4, 0.2, 0.0], [0.4, 0.0, 0.8, 0.6, 0.2]] {
        assert_eq!(text(&given), rising);
    }
}

#[test]
fn a_window_beyond_the_cables_is_reported() {
    let window = Window {
        base: Parameters::STANDARD,
        keys: ["x", "y"],
        values: [vec![5.0, 6.0], vec![5.0, 6.0]],
    };
    let text = basin_summary(&Basin::of(window, false, &no_progress).unwrap());
    assert!(
        text.contains("no cell is legal") && !text.contains("NaN"),
        "{text}"
    );
}

/// Distances from the equilibrium are told in planes that hold it, and in no other: there no start
/// is nearer to it than what the other keys are. A run that stops at the impact limit is neither
/// safe nor unsafe: what counts as safe, the safe part and the disc are no more than without that
/// limit, and the nearest unsafe start may be nearer.
#[test]
fn cells_that_are_cut_short_are_not_safe() {
    let window = |max_impacts| Window {
        base: Parameters {
            t_end: 60.0,
            max_impacts,
            ..Parameters::STANDARD
        },
        keys: ["x", "y"],
        values: [(-10, 10), (1, 18)].map(|(first, last): (i32, i32)| {
            let all = first..=last;
            all.map(|k| f64::from(k) * 0.04).collect()
        }),
    };
    let basin = |max_impacts, trust| Basin::of(window(max_impacts), trust, &no_progress).unwrap();
    let whole = basin(1_000_000, false);
    assert_eq!(whole.measures.cut_short, 0);
    for (max_impacts, trust) in [(3, false), (3, true), (10, false)] {
        let cut = basin(max_impacts, trust);
        let (few, all) = (&cut.measures, &whole.measures);
        let unsafe_cells = cut.cells.iter().filter(|cell| cell.escapes()).count();
        assert!(few.cut_short > 0 && few.safe < all.safe);
        assert_eq!(few.legal, few.safe + unsafe_cells + few.cut_short);
        assert!(few.undecided >= few.cut_short);
        for (cut, whole) in cut.cells.iter().zip(&whole.cells) {
            assert!(!cut.is_safe() || whole.is_safe());
        }
        assert!(few.integrity_factor <= all.integrity_factor);
        assert_eq!(few.lim, None);
        assert!(basin_summary(&cut).contains(&format!("Cut short {}", few.cut_short)));
    }
}

/// The run from the equilibrium itself is cut short, so that a start next to it need not be the
/// nearest unsafe one: without the limit its own cell is.
#[test]
fn the_equilibrium_itself_may_be_cut_short() {
    let basin = |max_impacts| {
        let base = Parameters {
            f_o: 0.6,
            y: 0.0,
            t_end: 60.0,
            stop_when_settled: false,
            max_impacts,
            ..Parameters::STANDARD
        };
        let values = [
            vec![-0.2, -0.1, 0.0, 0.1, 0.2],
            (-4..=4).map(f64::from).collect(),
        ];
        let keys = ["x", "vx"];
        Basin::of(Window { base, keys, values }, false, &no_progress).unwrap()
    };
    let whole = basin(100_000);
    assert_eq!((whole.measures.lim, whole.iim()), (Some(0.0), Some(0.0)));
    let cut = basin(100);
    assert_eq!(cut.measures.cut_short, 1);
    assert_eq!((cut.measures.lim, cut.iim()), (None, None));
}

/// Without neighbours, too, the knee is that of the runs that are not cut short, and says so; whatever
/// the others do, it lies in a range that holds the one without that limit.
#[test]
fn the_knee_of_runs_that_are_cut_short_has_a_range() {
    let eroded = |max_impacts| {
        let window = Window {
            base: Parameters {
                max_impacts,
                ..Parameters::STANDARD
            },
            keys: ["x", "y"],
            values: [
                (-4..=4).map(|k| f64::from(k) * 0.05).collect(),
                (1..=8).map(|k| f64::from(k) * 0.05).collect(),
            ],
        };
        let forces: Vec<f64> = (1..=6).map(|k| f64::from(k) * 0.1).collect();
        Erosion::of(&window, "f_o", &forces, false, &no_progress).unwrap()
    };
    let (whole, cut) = (eroded(1_000_000), eroded(200));
    assert_eq!(whole.knee_between(), None);
    let knee = whole.knee().unwrap();
    let [low, high] = cut.knee_between().unwrap();
    assert!(low.is_some_and(|low| low <= knee), "{low:?}");
    assert!(high.is_none_or(|high| high >= knee), "{high:?}");
    let words = erosion_summary(&cut);
    assert!(
        words.contains("safe part of the cells run to their end"),
        "{words}"
    );
    assert!(
        words.contains("depending on how undecided cells end"),
        "{words}"
    );
    let words = erosion_summary(&whole);
    assert!(
        words.contains("up to which the safe part is at least"),
        "{words}"
    );
}

/// Keys that an erosion can not vary are refused, as those of the window are.
#[test]
fn an_erosion_is_over_a_number_of_the_body() {
    let window = |base| Window {
        base,
        keys: ["x", "y"],
        values: [vec![-0.1, 0.0, 0.1], vec![0.1, 0.2]],
    };
    let over = |base: Parameters, key: &'static str| {
        let eroded = Erosion::of(&window(base), key, &[1.0, 2.0], false, &no_progress);
        eroded.map(|eroded| eroded.points.len())
    };
    let short = Parameters {
        t_end: 1.0,
        ..Parameters::STANDARD
    };
    for key in ["max_impacts", "body", "stop_when_settled"] {
        let error = over(short, key).unwrap_err().to_string();
        assert!(
            error.starts_with("over = ") && error.contains(key),
            "{error}"
        );
    }
    let point = Parameters {
        a: 0.0,
        inertia: None,
        ..short
    };
    assert!(over(point, "inertia").is_err());
    assert_eq!(over(short, "t_end").unwrap(), 2);
}

#[test]
fn a_plane_without_the_equilibrium_has_no_distances_from_it() {
    let mut window = window(&reference()["grids"]["circle_xy_f0.3"]);
    window.values = [vec![-0.1, 0.0, 0.1], vec![0.1, 0.3, 0.5]];
    let basin = Basin::of(window.clone(), false, &no_progress).unwrap();
    let lim = basin.measures.lim.unwrap();
    assert!(basin_summary(&basin).contains(&format!("{lim:.4} from the equilibrium (LIM)")));
    window.base.vy = -0.2;
    let basin = Basin::of(window, false, &no_progress).unwrap();
    assert_eq!((basin.measures.lim, basin.iim()), (None, None));
    assert!(basin.measures.integrity_factor.is_some());
    let words = basin_summary(&basin);
    assert!(
        words.contains("the equilibrium is not in this plane, as vy = -0.2\n"),
        "{words}"
    );
}

/// The plane of an erosion moves with a start key, and one that is always beside the
/// equilibrium says by which key.
#[test]
fn an_erosion_reports_in_which_planes_there_are_distances() {
    let mut window = window(&reference()["grids"]["circle_xy_f0.3"]);
    window.values = [vec![-0.1, 0.1], vec![0.1, 0.3]];
    window.base.t_end = 2.0;
    let words = |window: &Window, key: &'static str, values: &[f64]| {
        let erosion = Erosion::of(window, key, values, false, &no_progress).unwrap();
        erosion_summary(&erosion)
    };
    assert!(!words(&window, "f_o", &[0.1, 0.2]).contains("undefined (LIM"));
    let moving = words(&window, "vy", &[-0.1, 0.0, 0.1]);
    assert!(moving.contains("where one of the other start keys, such as vy, is not 0"));
    window.base.vx = 0.1;
    let beside = words(&window, "f_o", &[0.1, 0.2]);
    assert!(
        beside.contains("not in this plane, as vx = 0.1"),
        "{beside}"
    );
}

/// A window that is written from its largest values down has the
/// measures of the same cells upwards.
#[test]
fn measures_do_not_hang_on_the_order_of_the_cells() {
    let upwards = window(&reference()["grids"]["circle_xy_f0.3"]);
    let mut downwards = upwards.clone();
    for values in &mut downwards.values {
        values.reverse();
    }
    let [one, other] =
        [upwards, downwards].map(|window| Basin::of(window, false, &no_progress).unwrap().measures);
    assert_eq!(
        (one.safe, one.legal, one.lim),
        (other.safe, other.legal, other.lim)
    );
    let [radius, turned] = [one, other].map(|measures| measures.integrity_factor.unwrap());
    assert!(radius > 0.1 && (radius - turned).abs() < 1e-12);
}

/// Starts at the equilibrium with a velocity, a point mass's plane of two velocities.
fn velocities(first: (&'static str, [i32; 2]), second: (&'static str, [i32; 2])) -> Window {
    let values = |[low, high]: [i32; 2]| (low..=high).map(|k| f64::from(k) * 0.04).collect();
    Window {
        base: Parameters {
            y: 0.0,
            t_end: 30.0,
            ..Parameters::STANDARD
        },
        keys: [first.0, second.0],
        values: [values(first.1), values(second.1)],
    }
}

/// A disc in a part of a window is one of the whole window, and an unsafe start of a part one of
/// the whole. What lies beyond the border of a part is not known from it.
#[test]
fn a_part_of_a_window_has_no_larger_disc_than_the_whole() {
    let of = |x: [i32; 2], y: [i32; 2]| {
        Basin::of(velocities(("vx", x), ("vy", y)), false, &no_progress).unwrap()
    };
    let whole = of([-20, 20], [-20, 20]);
    let (lim, disc) = (
        whole.measures.lim.unwrap(),
        whole.measures.integrity_factor.unwrap(),
    );
    for (x, y) in [
        ([-10, 2], [-10, 5]),
        ([-10, 7], [-10, 7]),
        ([-3, 3], [-3, 3]),
    ] {
        let part = of(x, y);
        let words = basin_summary(&part);
        assert!(part.measures.integrity_factor.unwrap() <= disc, "{words}");
        assert!(
            words.contains("(IF); the window's border limits it"),
            "{words}"
        );
        assert!(part.measures.lim.is_none_or(|part| part == lim), "{words}");
    }
    let aside = of([5, 10], [8, 10]);
    let words = basin_summary(&aside);
    assert_eq!((aside.measures.lim, aside.iim()), (None, None), "{words}");
    assert!(aside.measures.lim_at_most.unwrap() > lim, "{words}");
    assert!(
        words.contains("from the equilibrium (LIM unknown)"),
        "{words}"
    );
}

/// Either velocity has its own impulsive measure, whichever is named first: the least unsafe one in
/// the row in which the other is 0.
#[test]
fn either_velocity_has_its_own_impulsive_measure() {
    let axes = [("vx", [-20, 20]), ("vy", [-20, 20])];
    let [one, other] = [[0, 1], [1, 0]]
        .map(|[a, b]| Basin::of(velocities(axes[a], axes[b]), false, &no_progress).unwrap());
    let [x, y] = one.measures.iim.map(|speed| speed.unwrap());
    assert_eq!(other.measures.iim, [Some(y), Some(x)]);
    assert_eq!((one.iim(), other.iim()), (None, None));
    let words = basin_summary(&one);
    for (key, speed) in [("vx", x), ("vy", y)] {
        assert!(
            words.contains(&format!("{key} of {speed:.4} is the least")),
            "{words}"
        );
        let in_row = one.cells.iter().enumerate().filter(|(k, cell)| {
            let [vx, vy] = one.window.at(*k);
            cell.escapes() && (if key == "vx" { vy } else { vx }) == 0.0
        });
        let along = in_row.map(|(k, _)| one.window.at(k).map(f64::abs).into_iter().sum::<f64>());
        assert_eq!(along.min_by(f64::total_cmp), Some(speed));
    }
    let above = Window {
        keys: ["vx", "y"],
        values: [one.window.values[0].clone(), vec![0.3, 0.32]],
        ..one.window.clone()
    };
    assert_eq!(Basin::of(above, false, &no_progress).unwrap().iim(), None);
}
