//! Textbook sections against conformal mapping (`sections.json`) and published values.

use crate::common::reference;
use snapload_hydro::{Place, Shape, added_mass_of_section};

/// All rows: eight digits submerged, six floating.
#[test]
fn sections_agree_with_the_table() {
    let table = reference("sections.json");
    let rows = table["rows"].as_array().expect("rows");
    assert!(rows.len() > 20);
    for row in rows {
        let number = |of: &serde_json::Value, key: &str| of[key].as_f64().expect("a number");
        let shape = match row["section"].as_str().expect("a name") {
            "ellipse" => Shape::Ellipse,
            _ => Shape::Rectangle,
        };
        let (b, t) = (number(row, "b"), number(row, "T"));
        let size = b.max(t);
        let of = |place| added_mass_of_section(shape, place, b, t).expect("a section");
        let (submerged, floating) = (of(Place::Submerged), of(Place::Floating));
        let deep = &row["submerged"];
        let high = &row["floating_infinite_frequency"];
        for (found, expected, unit, error) in [
            (submerged[(0, 0)], number(deep, "a_x"), t * t, 5e-7),
            (submerged[(1, 1)], number(deep, "a_z"), b * b, 5e-7),
            (submerged[(2, 2)], number(deep, "a_rot"), size.powi(4), 2e-7),
            (floating[(0, 0)], number(high, "A11"), t * t, 2e-6),
            (floating[(1, 1)], number(high, "A33"), b * b, 2e-6),
            (floating[(2, 2)], number(high, "A55"), size.powi(4), 2e-6),
            (floating[(0, 2)], number(high, "A15"), size.powi(3), 2e-6),
        ] {
            let off = (found - expected).abs() / unit;
            assert!(off < error, "{row}: {found} {expected}");
        }
        assert_eq!(floating[(0, 2)], floating[(2, 0)]);
    }
}

/// Newman's table 4.3: the square 4.754 and 0.725 (about its centre), and a thin plate, π and π/8;
/// DNV's coefficients of π a² for rectangles.
#[test]
fn sections_agree_with_textbooks() {
    let deep = |shape, b, t| added_mass_of_section(shape, Place::Submerged, b, t).expect("one");
    let square = deep(Shape::Rectangle, 1.0, 1.0);
    assert!((square[(1, 1)] - 4.754).abs() < 5e-4 && (square[(2, 2)] - 0.725).abs() < 5e-4);
    let plate = deep(Shape::Ellipse, 1.0, 1e-6);
    let pi = std::f64::consts::PI;
    assert!((plate[(1, 1)] - pi).abs() < 1e-9 && (plate[(2, 2)] - pi / 8.0).abs() < 1e-9);
    for (ratio, coefficient) in [(1.0, 1.51), (2.0, 1.36), (5.0, 1.21), (10.0, 1.14)] {
        let found = deep(Shape::Rectangle, ratio, 1.0)[(1, 1)] / (pi * ratio * ratio);
        assert!((found - coefficient).abs() < 0.01, "{ratio}: {found}");
    }
}

/// Between the rows the spline is as smooth as they are: a rectangle turned by a quarter is the
/// same rectangle, and sizes scale.
#[test]
fn sections_between_the_rows_are_sound() {
    for step in 0..=60 {
        let ratio = 10f64.powf(f64::from(step) / 60.0);
        let deep =
            |b, t| added_mass_of_section(Shape::Rectangle, Place::Submerged, b, t).expect("one");
        let (wide, high) = (deep(ratio, 1.0), deep(1.0, ratio));
        // The table is denser for wide ones, so that this shows the spline's own error.
        assert!((wide[(0, 0)] / high[(1, 1)] - 1.0).abs() < 0.01, "{ratio}");
        assert!((wide[(2, 2)] / high[(2, 2)] - 1.0).abs() < 0.02, "{ratio}");
        let large = deep(3.0 * ratio, 3.0);
        assert!((large[(2, 2)] / wide[(2, 2)] / 81.0 - 1.0).abs() < 1e-12);
    }
    let refused = |b, t| {
        let section = added_mass_of_section(Shape::Rectangle, Place::Floating, b, t);
        section.expect_err("a refusal").to_string()
    };
    assert!(refused(20.0, 1.0).contains("0.1 to 10"));
    assert!(refused(-1.0, 1.0).contains("above 0"));
}
