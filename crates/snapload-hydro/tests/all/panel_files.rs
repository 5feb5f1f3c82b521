//! Files of panel codes with several bodies, with noise, with outlying frequencies, and with parts
//! missing.

use crate::common::{Spoilt, dataset, wamit_files, wamit_given};
use snapload_hydro::{
    Dataset, FitOptions, Format, Given, Hydrodynamics, Reading, Report, Request, Values, Variable,
    WamitText, from_dataset, from_wamit, page,
};

fn pontoon() -> Spoilt {
    dataset("pontoon-deep.nc")
}

fn warnings(spoilt: Spoilt) -> Vec<&'static str> {
    let hydro = from_dataset(&spoilt.0, &Given::default()).expect("coefficients");
    let reading = Reading::new(Format::Capytaine, hydro).expect("a reading");
    reading
        .warnings
        .iter()
        .map(|warning| warning.what)
        .collect()
}

/// Two bodies in one file: `left` is the pontoon, `right` the same with other centres and mass,
/// and nothing couples them.
fn two_bodies() -> Vec<(String, Variable)> {
    let freedoms = ["influenced_dof", "radiating_dof"];
    let per_body = [
        "disp_mass",
        "center_of_mass",
        "center_of_buoyancy",
        "rotation_center",
    ];
    let twice = |(name, variable): (String, Variable)| {
        let Values::Numbers(numbers) = &variable.values else {
            if freedoms.contains(&name.as_str()) {
                let words = ["left", "right"].map(|body| {
                    ["Surge", "Heave", "Pitch"].map(|freedom| format!("{body}__{freedom}"))
                });
                let values = Values::Words(words.concat());
                let shape = vec![6];
                return (
                    name,
                    Variable {
                        shape,
                        values,
                        ..variable
                    },
                );
            }
            return (name, variable);
        };
        let mut doubled = variable.clone();
        if per_body.contains(&name.as_str()) {
            let right = numbers.iter().map(|value| 2.0 * value - 0.5);
            doubled.values = Values::Numbers(numbers.iter().copied().chain(right).collect());
            doubled.dims.insert(0, "body".to_owned());
            doubled.shape.insert(0, 2);
            return (name, doubled);
        }
        for dim in freedoms {
            doubled = with_six_along(&doubled, dim);
        }
        (name, doubled)
    };
    let mut all: Vec<(String, Variable)> = pontoon().all().into_iter().map(twice).collect();
    let body = Variable {
        dims: vec!["body".to_owned()],
        shape: vec![2],
        values: Values::Words(vec!["left".to_owned(), "right".to_owned()]),
    };
    all.push(("body".to_owned(), body));
    all
}

/// The variable with its values along a dimension of three, and then the same values again.
fn with_six_along(variable: &Variable, dim: &str) -> Variable {
    let Some(place) = variable.dims.iter().position(|name| name == dim) else {
        return variable.clone();
    };
    let Values::Numbers(numbers) = &variable.values else {
        unreachable!("numbers");
    };
    let inner: usize = variable.shape[place + 1..].iter().product();
    let blocks = numbers.chunks(3 * inner);
    let values = blocks.flat_map(|block| [block, block].concat()).collect();
    let mut shape = variable.shape.clone();
    shape[place] = 6;
    Variable {
        shape,
        values: Values::Numbers(values),
        ..variable.clone()
    }
}

fn of_body(dataset: &Dataset, body: &str) -> Result<Hydrodynamics, String> {
    let given = Given {
        body: Some(body.to_owned()),
        ..Given::default()
    };
    from_dataset(dataset, &given).map_err(|error| error.to_string())
}

/// Each body of a file has its own mass and centres. A dataset that was cut to one of the bodies has
/// those of that body alone.
#[test]
fn a_body_is_read_with_its_own_mass_and_centres() {
    let both = Dataset::new(two_bodies()).expect("a dataset");
    let alone = from_dataset(&pontoon().0, &Given::default()).expect("coefficients");
    assert_eq!(of_body(&both, "left"), Ok(alone.clone()));
    let right = of_body(&both, "right").expect("coefficients");
    let statics = &right.hydrostatics;
    let mass = alone.hydrostatics.displaced_mass_kg.expect("a mass");
    let [x, z] = alone.hydrostatics.centre_of_mass_m.expect("a centre");
    assert_eq!(statics.displaced_mass_kg, Some(2.0 * mass - 0.5));
    assert_eq!(
        statics.centre_of_mass_m,
        Some([2.0 * x - 0.5, 2.0 * z - 0.5])
    );
    assert_eq!(right.reference_m, [-0.5, -0.5]);
    assert_eq!(right.added_mass, alone.added_mass);

    let left = both.at("body", 0);
    assert_eq!(of_body(&left, "left"), Ok(alone));
    let message = of_body(&left, "right").expect_err("a refusal");
    assert!(
        message.contains("left") && message.contains("right"),
        "{message}"
    );
    let message = from_dataset(&both, &Given::default()).expect_err("a refusal");
    assert!(message.to_string().contains("left, right"), "{message}");
}

/// The pontoon with A and B of the freedoms changed: by frequency, force and motion.
fn changed(name: &str, change: impl Fn(usize, usize, usize, f64) -> f64) -> Spoilt {
    let spoilt = pontoon();
    let names = ["influenced_dof", "radiating_dof"].map(|dim| spoilt.0.words(dim).expect("words"));
    assert_eq!(names, [["Surge", "Heave", "Pitch"]; 2]);
    let dims = &spoilt.0.variable(name).expect("a variable").dims;
    assert_eq!(dims[1..], ["influenced_dof", "radiating_dof"]);
    spoilt.numbers(name, |at, value| change(at / 9, at / 3 % 3, at % 3, value))
}

/// A circle that turns about its centre moves no water: what a panel code has for that is noise, in
/// which A and its transpose differ by as much as they are.
#[test]
fn noise_of_a_turning_circle_is_no_asymmetry() {
    let noise = |_, force: usize, motion: usize, value: f64| match (force, motion) {
        (2, 2) => 5e-27,
        (0, 2) => 2e-13,
        (2, 0) => -1e-13,
        (1, 2) | (2, 1) => 0.0,
        _ => value,
    };
    let added = changed("added_mass", noise);
    let both = added.with("radiation_damping", |variable| {
        let of = changed("radiation_damping", noise);
        *variable =
            of.0.variable("radiation_damping")
                .expect("a variable")
                .clone();
    });
    assert!(!warnings(both).contains(&"symmetry"));
}

/// One irregular frequency does not hide that the rest is symmetric; mixed rows are refused as
/// before.
#[test]
fn one_frequency_does_not_make_a_file_asymmetric() {
    let one = changed("added_mass", |k, force, motion, value| {
        match (k, force, motion) {
            (20, 0, 2) => 1.8 * value,
            _ => value,
        }
    });
    let hydro = from_dataset(&one.0, &Given::default()).expect("coefficients");
    assert!(
        hydro.asymmetry > 1e-3 && hydro.asymmetry < 0.1,
        "{}",
        hydro.asymmetry
    );
    Reading::new(Format::Capytaine, hydro).expect("a reading");

    let all = changed("added_mass", |_, force, motion, value| {
        match (force, motion) {
            (0, 2) => -value,
            _ => value,
        }
    });
    let hydro = from_dataset(&all.0, &Given::default()).expect("coefficients");
    let refusal = Reading::new(Format::Capytaine, hydro).expect_err("a refusal");
    assert!(refusal.to_string().contains("symmetry"), "{refusal}");
}

/// Added mass that varies with frequency has damping with it.
#[test]
fn missing_damping_is_noticed() {
    assert!(!warnings(pontoon()).contains(&"no damping"));
    let none = changed("radiation_damping", |_, force, motion, value| {
        match (force, motion) {
            (1, 1) => 0.0,
            _ => value,
        }
    });
    assert!(warnings(none).contains(&"no damping"));
}

/// A centre of gravity 0.3 m beside that of buoyancy.
fn given() -> Given {
    Given {
        centre_of_gravity_m: Some([0.3, -0.2]),
        ..wamit_given()
    }
}

/// C(4,6) = m g x_G − ρ g V x_B of a body whose mass is the displaced one: with 96 m³ and a centre
/// of gravity 0.3 m beside that of buoyancy it is 28.8 m⁴ in WAMIT's units of ρ g L⁴. In another
/// unit of length, L = 2 m, it is 28.8/16.
#[test]
fn wamits_stiffness_has_the_centre_of_buoyancy() {
    let with = |entry: &str| {
        let mut files = wamit_files();
        let hst = files.hydrostatics.take().expect("a file");
        let kept = hst
            .lines()
            .filter(|line| !line.split_whitespace().take(2).eq(["4", "6"]));
        let kept = kept.collect::<Vec<_>>().join("\n");
        files.hydrostatics = Some(format!("{kept}\n{entry}\n"));
        files
    };
    let x_b = |files: &WamitText, given: &Given| {
        from_wamit(files, given).map(|hydro| hydro.hydrostatics.centre_of_buoyancy_x_m)
    };
    assert_eq!(x_b(&with(""), &given()), Ok(None));
    let found = x_b(&with("4 6 28.8"), &given())
        .expect("coefficients")
        .expect("a centre");
    assert!(found.abs() < 1e-12, "{found}");
    let unknown = Given {
        displaced_mass_kg: None,
        ..given()
    };
    assert_eq!(x_b(&with("4 6 28.8"), &unknown), Ok(None));
    let double = Given {
        unit_length_m: Some(2.0),
        displaced_mass_kg: Some(8.0 * 98_400.0),
        centre_of_gravity_m: Some([0.6, -0.4]),
        ..given()
    };
    let found = x_b(&with("4 6 28.8"), &double)
        .expect("coefficients")
        .expect("a centre");
    assert!(found.abs() < 1e-12, "{found}");
    let refusal = x_b(&with("4 6 28.8\n4 6 28.7"), &given()).expect_err("a refusal");
    assert!(
        refusal.to_string().contains("4,6 occurs twice"),
        "{refusal}"
    );
}

/// What is no number, missing or cut off is named, with its line or its place.
#[test]
fn parts_of_wamits_files_that_are_missing_are_named() {
    let refusal = |files: &WamitText| {
        let error = from_wamit(files, &given()).expect_err("a refusal");
        error.to_string()
    };
    let mut files = wamit_files();
    files.hydrostatics = Some("3 3 80\n5 5 nan\n".to_owned());
    let message = refusal(&files);
    assert!(
        message.contains("line 2") && message.contains("NaN"),
        "{message}"
    );

    let mut files = wamit_files();
    let mut of_pitch = 0;
    let kept = files.excitation.lines().filter(|line| {
        let is_pitch = line.split_whitespace().nth(2) == Some("5");
        of_pitch += usize::from(is_pitch);
        !(is_pitch && of_pitch == 9)
    });
    files.excitation = kept.collect::<Vec<_>>().join("\n");
    let message = refusal(&files);
    for part in ["the force 5 at ω = ", "BETA = ", "missing", "add the line"] {
        assert!(message.contains(part), "{message}");
    }

    let mut files = wamit_files();
    let lines: Vec<&str> = files.radiation.lines().collect();
    let cut = lines.len() - 3;
    let last: Vec<&str> = lines[cut].split_whitespace().collect();
    files.radiation = [&lines[..cut], &[&last[..4].join(" ")]].concat().join("\n");
    let message = refusal(&files);
    assert!(
        message.contains(&format!("line {} has no damping", cut + 1)),
        "{message}"
    );
}

/// A mass of other units than the added mass is noticed.
#[test]
fn units_that_do_not_fit_are_noticed() {
    let said = |given: &Given| {
        let hydro = from_wamit(&wamit_files(), given).expect("coefficients");
        let reading = Reading::new(Format::Wamit, hydro).expect("a reading");
        reading
            .warnings
            .iter()
            .any(|warning| warning.what == "size" && warning.message.contains("unit_length"))
    };
    assert!(!said(&given()));
    let tonnes = Given {
        displaced_mass_kg: Some(98.4),
        ..given()
    };
    assert!(said(&tonnes));
}

/// A body that is not symmetric responds otherwise to waves from either side: its page draws both.
/// Rows that a command adds are on it, too.
#[test]
fn both_directions_of_waves_are_drawn() {
    let drawn = |spoilt: Spoilt| {
        let hydro = from_dataset(&spoilt.0, &Given::default()).expect("coefficients");
        let reading = Reading::new(Format::Capytaine, hydro).expect("a reading");
        let request = Request {
            fit: FitOptions { pairs: Some(3) },
            ..Request::default()
        };
        let report = Report::new("a body", reading, &request).expect("a report");
        let further = [("sea".to_owned(), "in a sea of 1 m".to_owned())];
        let page = page(&report, &further, "snapload hydro").expect("a page");
        assert!(page.contains("<dt>sea</dt><dd>in a sea of 1 m</dd>"));
        let [picture] = report
            .pictures()
            .expect("pictures")
            .into_iter()
            .filter(|picture| picture.name == "response")
            .map(|picture| picture.svg().to_owned())
            .collect::<Vec<_>>()
            .try_into()
            .expect("one picture");
        picture.matches("exponentials, to").count()
    };
    assert_eq!(drawn(pontoon()), 0);
    let spoilt = pontoon();
    let dims = spoilt
        .0
        .variable("diffraction_force")
        .expect("a force")
        .dims
        .clone();
    let shape = spoilt
        .0
        .variable("diffraction_force")
        .expect("a force")
        .shape
        .clone();
    let waves = dims
        .iter()
        .position(|dim| dim == "wave_direction")
        .expect("directions");
    let inner: usize = shape[waves + 1..].iter().product();
    let one_side = |at: usize, value: f64| match at / inner % shape[waves] {
        0 => 1.5 * value,
        _ => value,
    };
    let askew = spoilt
        .numbers("diffraction_force", one_side)
        .numbers("Froude_Krylov_force", one_side);
    assert!(drawn(askew) > 0);
}
