//! Cells of a basin of which a neighbour is safe and they are not, or the other way round.

use snapload::analysis::no_progress;
use snapload::{Case, Parameters, Stop};
use snapload_orbits::{Basin, Distances, Window, basin_summary};

/// Evenly spaced hundredths.
fn hundredths(from: i32, to: i32, by: usize) -> Vec<f64> {
    (from..=to)
        .step_by(by)
        .map(|k| f64::from(k) / 100.0)
        .collect()
}

fn basin(base: Parameters, [x, y]: [Vec<f64>; 2]) -> Basin {
    let window = Window {
        base,
        keys: ["x", "y"],
        values: [x, y],
    };
    Basin::of(window, true, &no_progress).unwrap()
}

/// Whether the run from a start reaches a limit; none if the start is not legal.
fn is_unsafe(base: Parameters, [x, y]: [f64; 2]) -> Option<bool> {
    let case = Case::new(Parameters { x, y, ..base }).ok()?;
    let stop = case.run().end().reason;
    assert!(matches!(
        stop,
        Stop::Settled | Stop::EndTime | Stop::RotationLimit | Stop::UpperBound
    ));
    Some(stop.exceeds())
}

/// The distances where undecided cells count as unsafe, cell by cell: here the nearest unsafe start
/// among the neighbours is nearer than the nearest unsafe cell (0.12), at (0.03999999, 0.1): 0.1077
/// away, it turns over at t = 21.626, as an independent integration in 113 bits found, too.
#[test]
fn undecided_cells_may_be_the_nearest_unsafe_ones() {
    let base = Parameters {
        e: 0.97,
        f_o: 0.3,
        t_end: 60.0,
        ..Parameters::STANDARD
    };
    assert_eq!(is_unsafe(base, [0.039_999_99, 0.1]), Some(true));
    let basin = basin(base, [hundredths(-40, 40, 2), hundredths(2, 72, 2)]);
    let cells = basin.cells.iter().enumerate();
    let places = |which: &dyn Fn(&snapload_orbits::Cell) -> bool| -> Vec<[f64; 2]> {
        let such = cells.clone().filter(|(_, cell)| which(cell));
        such.map(|(k, _)| basin.window.at(k)).collect()
    };
    let all_unsafe = places(&|cell| cell.escapes() || !cell.decided);
    let distance = |[x, y]: [f64; 2], [u, v]: [f64; 2]| (x - u).hypot(y - v);
    let nearest = |at: [f64; 2]| all_unsafe.iter().map(move |other| distance(at, *other));
    let lim = nearest([0.0, 0.0]).fold(f64::INFINITY, f64::min);
    let measures = basin.measures;
    assert!((measures.at_least.lim.unwrap() - lim).abs() < 1e-12);
    assert!(
        lim <= 0.1078 && measures.lim.unwrap() > 0.11,
        "{measures:?}"
    );
    let safe = places(&|cell| cell.is_safe() && cell.decided);
    let radii = safe
        .iter()
        .map(|at| nearest(*at).fold(f64::INFINITY, f64::min));
    let disc = radii.fold(0.0, f64::max);
    assert!((measures.at_least.integrity_factor.unwrap() - disc).abs() < 1e-9);
    assert!(disc < measures.integrity_factor.unwrap());
    let words = basin_summary(&basin);
    // Without neighbours it is not known which are.
    let alone = Basin::of(basin.window.clone(), false, &no_progress).unwrap();
    assert_eq!(alone.measures.at_least, Distances::default());
    assert_eq!(
        words.matches("if undecided ones are unsafe").count(),
        2,
        "{words}"
    );
}

/// A cell is decided where all of its neighbours are safe as it is, whether their runs settle or
/// last to the end of time.
#[test]
fn neighbours_that_are_all_safe_decide() {
    let base = Parameters {
        e: 0.95,
        f_o: 0.1,
        t_end: 40.0,
        ..Parameters::STANDARD
    };
    let basin = basin(base, [hundredths(-20, 20, 2), hundredths(2, 22, 2)]);
    let mut seen = 0;
    for (k, cell) in basin
        .cells
        .iter()
        .enumerate()
        .filter(|(_, cell)| cell.is_safe())
    {
        let [x, y] = basin.window.at(k);
        let around = [-1e-8, 0.0, 1e-8].map(|u| [-1e-8, 0.0, 1e-8].map(|v| [x + u, y + v]));
        let mut around = around.iter().flatten();
        let unsafe_near = around.any(|at| is_unsafe(base, *at) == Some(true));
        assert!(!unsafe_near || !cell.decided, "{x} {y}");
        seen += usize::from(!unsafe_near && cell.decided);
    }
    let undecided = basin.measures.undecided;
    assert!(
        undecided <= 2 && seen + undecided >= basin.measures.safe,
        "{seen} {undecided}"
    );
}
