//! Evenly spaced values are the expected decimals.
use snapload_study::Grid;

#[test]
fn values_are_as_one_writes_them() {
    for (first, last, count, scale) in [
        ("0.01", "0.6", 60, 100),
        ("0.001", "0.6", 600, 1000),
        ("1e-2", "0.60", 60, 100),
        ("-0.01", "-6e-1", 60, -100),
    ] {
        let grid = Grid::new(first, last, count).unwrap();
        for k in 0..count {
            let written = format!("{}", (k + 1) as f64 / f64::from(scale));
            assert_eq!(grid.value(k).to_string(), written);
            assert_eq!(grid.value(k), written.parse().unwrap());
        }
    }
    let grid = Grid::new("0.4", "2.4", 501).unwrap();
    for k in 0..501_u64 {
        let thousandths = 400 + 4 * k;
        let written = format!("{}.{:03}", thousandths / 1000, thousandths % 1000);
        assert_eq!(grid.value(k), written.parse().unwrap());
    }
}

#[test]
fn ends_are_exact_and_one_value_is_the_first() {
    let grid = Grid::new("0.1", "0.7", 600).unwrap();
    assert_eq!((grid.value(0), grid.value(599)), (0.1, 0.7));
    assert_eq!(Grid::new("0.3", "0.9", 1).unwrap().value(0), 0.3);
    assert_eq!(Grid::new("5e-324", "1e-323", 2).unwrap().value(1), 1e-323);
    assert_eq!(Grid::new("+1", "2.", 2).unwrap().value(1), 2.0);
}

#[test]
fn what_is_no_number_is_refused() {
    for text in [
        "", "x", "inf", "NaN", "1e999", "1e-999", "1,5", "0x1", "1e", "--1",
    ] {
        assert_eq!(Grid::new(text, "1", 3), None, "{text}");
    }
    assert_eq!(Grid::new("0", "1", 0), None);
    assert_eq!(Grid::new("1e-999999999999999999999", "1", 3), None);
}
