//! Values that are given beside a file.

use crate::common::{dataset, path};
use snapload_hydro::{FirstColumn, Format, Given, GivenSource, Reading, from_dataset, read};

/// A value that has no effect on a file of Capytaine is refused, and so is another centre of
/// gravity than the file's, which would be ignored.
#[test]
fn nothing_that_is_given_is_ignored() {
    let refusal = |given: Given| {
        let given = Given {
            source: GivenSource::CommandLine,
            ..given
        };
        let error = read(&path("pontoon-deep.nc"), &given).expect_err("a refusal");
        error.to_string()
    };
    let length = refusal(Given {
        unit_length_m: Some(7.0),
        ..Given::default()
    });
    let column = refusal(Given {
        first_column: Some(FirstColumn::Frequency),
        ..Given::default()
    });
    for (words, key) in [(length, "unit_length"), (column, "first_column")] {
        let says = [
            key,
            "on the command line",
            "Capytaine",
            "only files of WAMIT",
        ];
        assert!(says.iter().all(|part| words.contains(part)), "{words}");
    }
    let centre = |x: f64, z: f64| Given {
        centre_of_gravity_m: Some([x, z]),
        ..Given::default()
    };
    let words = refusal(centre(3.0, -0.2));
    assert!(words.contains("is 0 in the file and 3 on"), "{words}");
    let words = refusal(centre(0.0, 5.0));
    assert!(words.contains("is -0.2 in the file and 5 on"), "{words}");
    assert!(read(&path("pontoon-deep.nc"), &centre(0.0, -0.2)).is_ok());
}

/// That no frequency is low is a warning about the file, and not one of each direction.
#[test]
fn high_frequencies_are_told_once() {
    let high = dataset("pontoon-deep.nc").numbers("omega", |_, omega| 20.0 * omega);
    let hydro = from_dataset(&high.0, &Given::default()).expect("coefficients");
    assert_eq!(hydro.excitation.len(), 2);
    let reading = Reading::new(Format::Capytaine, hydro).expect("a reading");
    let warnings = reading.warnings.iter();
    let told = warnings.filter(|warning| warning.what == "low frequencies");
    assert_eq!(told.count(), 1);
}
