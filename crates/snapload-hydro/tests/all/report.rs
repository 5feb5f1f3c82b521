//! Reports on coefficients: they are complete, and files with less data give fewer results.

use crate::common::{hydro, reading};
use crate::linear::near;
use snapload_hydro::{
    Body, FitOptions, Format, GivenMemory, Line, Reading, Report, Request, Weight, page,
    wave_number,
};

fn request() -> Request {
    Request {
        fit: FitOptions { pairs: Some(4) },
        ..Request::default()
    }
}

/// A page with all pictures and warnings, a summary, and JSON with all numbers.
#[test]
fn everything_is_reported() {
    let mut request = request();
    let line = |x: f64| Line {
        anchor_m: [3.0 * x, -10.0],
        fairlead_m: [x, -1.2],
        length_m: 9.666436778876,
    };
    request.lines = vec![line(2.0), line(-2.0)];
    request.weight.mass_kg = Some(80_000.0);
    let report = Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report");
    let page = page(&report, &[], "snapload hydro <pontoon>").expect("a page");
    assert_eq!(page.matches("<svg").count(), 5);
    for message in [
        "held by its lines",
        "Memory K(t)",
        "Quality of the memory",
        "high frequencies",
    ] {
        assert!(page.contains(message), "{message}");
    }
    assert!(!page.contains("<pontoon>") && !page.contains("NaN"));
    let labels: Vec<String> = report
        .summary()
        .into_iter()
        .map(|(label, _)| label)
        .collect();
    for label in [
        "file", "memory", "body", "periods", "response", "rest", "held", "warning",
    ] {
        assert!(labels.iter().any(|known| known == label), "{label}");
    }
    let json = serde_json::to_value(report.to_json()).expect("JSON");
    assert_eq!(json["omega_rad_s"].as_array().expect("ω").len(), 58);
    assert_eq!(json["floating"]["rest"]["taut"], serde_json::json!([1, 2]));
    assert_eq!(
        json["floating"]["responses"]
            .as_array()
            .expect("responses")
            .len(),
        2
    );
    assert!(json["water"]["depth_m"].is_null());
}

/// Three lines that leave a body no motion are reported in words, on a page and in JSON.
#[test]
fn a_body_that_is_held_fast_is_reported() {
    let mut request = request();
    let line = |anchor: f64, fairlead: f64, length_m: f64| Line {
        anchor_m: [anchor, -10.0],
        fairlead_m: [fairlead, -1.2],
        length_m,
    };
    request.lines = vec![
        line(6.0, 2.0, 9.666),
        line(-6.0, -2.0, 9.666),
        line(-6.0, 2.0, 11.8),
    ];
    request.weight.mass_kg = Some(80_000.0);
    let report = Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report");
    let held = report
        .summary()
        .into_iter()
        .find(|(label, _)| label == "held");
    assert!(held.expect("a row").1.contains("allow no motion"));
    let page = page(&report, &[], "snapload hydro").expect("a page");
    assert!(page.contains("allow no motion") && !page.contains("NaN"));
    let json = serde_json::to_value(report.to_json()).expect("JSON");
    assert_eq!(json["floating"]["rest"]["natural"], serde_json::json!([]));
}

/// A file without hydrostatics has a memory but no periods, and a message names what is missing.
#[test]
fn files_without_hydrostatics_are_reported() {
    let mut bare = hydro("sphere.nc");
    bare.hydrostatics = Default::default();
    let reading = Reading::new(Format::Nemoh, bare).expect("a reading");
    // No mass or centre of gravity makes up for the stiffness, so that it is the one that is named.
    let report = Report::new("sphere", reading, &request()).expect("a report");
    let summary = report.summary();
    let missing = summary
        .iter()
        .find(|(label, _)| label == "omitted")
        .expect("a row");
    let named = missing.1.contains("the hydrostatic stiffness is missing");
    assert!(named && missing.1.contains("Nemoh"), "{missing:?}");
    assert_eq!(
        page(&report, &[], "")
            .expect("a page")
            .matches("<svg")
            .count(),
        4
    );
}

/// The largest response is at the resonance, between the file's frequencies, and a narrow peak is
/// reported to depend on its damping; the JSON has the same.
#[test]
fn the_largest_response_is_that_of_the_resonance() {
    let answer = |damping: f64| {
        let mut request = request();
        request.fit = FitOptions::default();
        request.damping = [0.0, 0.0, damping];
        Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report")
    };
    let found = |report: &Report| {
        let rows = report.summary();
        let row = rows.into_iter().find(|(label, _)| label == "response");
        row.expect("a row").1
    };
    let report = answer(0.0);
    let json = serde_json::to_value(report.to_json()).expect("JSON");
    let floating = &json["floating"];
    let largest = &floating["responses"][0]["largest"][2];
    let of = |name: &str| largest[name].as_f64().expect("a number");
    // It is at the natural frequency, to which none of the file's frequencies is close enough.
    let mode = &floating["natural"][0];
    assert_eq!(mode["freedom"], "pitch");
    let damped = mode["damped_period_s"].as_f64().expect("a period");
    assert!((of("period_s") - damped).abs() < 2e-3 * damped);
    let on_the_grid = |xi: &nalgebra::Vector3<nalgebra::Complex<f64>>| xi[2].norm();
    let floating = report.floating.as_ref().expect("answers");
    let amplitudes = floating.responses[0][0].amplitude.iter();
    let coarse = amplitudes.map(on_the_grid).fold(0.0, f64::max);
    assert!(of("amplitude") > 2.0 * coarse, "{largest} {coarse}");
    let message = found(&report);
    let degrees = format!("pitch {:.0} °/m at 3.80 s", of("amplitude").to_degrees());
    assert!(message.contains(&degrees), "{message}");
    assert!(
        message.contains("pitch is so narrow that it is only as accurate as the damping, 0.61 %")
    );
    let damped = found(&answer(5e4));
    assert!(!damped.contains("narrow"), "{damped}");
}

/// A body whose centre of gravity lies above its metacentre turns over, which is reported.
#[test]
fn a_body_that_turns_over_is_reported() {
    let answer = |z: f64| {
        let mut request = request();
        request.weight.centre_m = Some([0.0, z]);
        Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report")
    };
    for (z, turns) in [(-1.0, false), (1.5, true)] {
        let report = answer(z);
        let body = report.floating.as_ref().expect("a body");
        assert_eq!(body.body.stiffness[(2, 2)] <= 0.0, turns);
        let warned = report
            .warnings
            .iter()
            .any(|warning| warning.what == "stability");
        assert_eq!(warned, turns, "{z}");
    }
}

/// A given mass with the inertia of the file's body causes a warning, in words and in JSON; the
/// reported inertia is about the same point as `--inertia`.
#[test]
fn an_inertia_that_is_not_given_with_a_mass_is_reported() {
    let answer = |mass: Option<f64>, inertia: Option<f64>| {
        let mut request = request();
        request.weight.mass_kg = mass;
        request.weight.inertia_kg_m2 = inertia;
        Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report")
    };
    let warned = |report: &Report| {
        let warning = |(label, message): &(String, String)| {
            label == "warning" && message.starts_with("moment of inertia: the mass is 80.0 t")
        };
        let json = serde_json::to_value(report.to_json()).expect("JSON");
        let rows = json["warnings"].as_array().expect("warnings").clone();
        let in_json = rows.iter().any(|row| row["what"] == "moment of inertia");
        assert_eq!(in_json, report.summary().iter().any(warning));
        in_json
    };
    assert!(warned(&answer(Some(8e4), None)));
    assert!(!warned(&answer(None, None)) && !warned(&answer(Some(98_400.0), None)));
    let own = answer(Some(8e4), Some(133_000.0));
    assert!(!warned(&own));
    let rows = own.summary();
    let (_, body) = rows
        .iter()
        .find(|(label, _)| label == "body")
        .expect("a row");
    assert!(
        body.contains("moment of inertia 133.0000 t m² about it"),
        "{body}"
    );
    let json = serde_json::to_value(own.to_json()).expect("JSON");
    let inertia = json["floating"]["moment_of_inertia_kg_m2"].as_f64();
    assert!((inertia.expect("a number") - 133_000.0).abs() < 1e-6);
}

/// A centre of gravity beside that of buoyancy turns the body by its weight's arm over the
/// stiffness, which is told in words and in JSON; one under it does not.
#[test]
fn a_moment_that_turns_the_body_is_reported() {
    let report = |x: f64| {
        let mut request = request();
        request.weight.centre_m = Some([x, -0.2]);
        Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report")
    };
    let of = |report: &Report| -> Vec<String> {
        let found = report.warnings.iter();
        let found = found.filter(|warning| warning.what == "balance");
        found.map(|warning| warning.message.clone()).collect()
    };
    let balance = |report: &Report| {
        let rows = report.summary();
        rows.into_iter().find(|(label, _)| label == "balance")
    };
    let upright = report(0.0);
    assert_eq!((of(&upright), balance(&upright)), (Vec::new(), None));
    let turned = report(0.15);
    let body = &turned.floating.as_ref().expect("a body").body;
    let arm = 0.15 * body.mass_kg * 9.81;
    let angle = (arm / body.stiffness[(2, 2)]).to_degrees();
    let message = of(&turned).concat();
    assert!(message.contains(&format!("{angle:.1}°")), "{message}");
    let (_, message) = balance(&turned).expect("a row");
    let expected = format!(
        "a moment of {:.1} kN m is balanced at {angle:.1}°",
        arm / 1e3
    );
    assert!(message.contains(&expected), "{message}");
    let json = serde_json::to_value(turned.to_json()).expect("JSON");
    assert!(json["warnings"].to_string().contains("upright"));
    // To the other side both have the other sign.
    let other = report(-0.15);
    let message = of(&other).concat();
    assert!(message.contains(&format!("-{angle:.1}°")), "{message}");
    let (_, message) = balance(&other).expect("a row");
    let expected = format!("a moment of -{:.1} kN m", arm / 1e3);
    assert!(message.contains(&expected), "{message}");
}

/// No angle is told at which linear hydrostatics do not hold: the weight of a body whose centre of
/// gravity lies outside of its hull turns it over.
#[test]
fn a_moment_that_turns_the_body_far_is_not_balanced() {
    for x in [5.0, -5.0] {
        let mut request = request();
        request.weight.centre_m = Some([x, -0.2]);
        let report =
            Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report");
        let rows = report.summary();
        let says = |label: &str, message: &str| {
            let mut rows = rows.iter();
            rows.any(|(known, row)| known == label && row.contains(message))
        };
        assert!(
            says("balance", "is not balanced within 15° of pitch"),
            "{rows:?}"
        );
        assert!(
            says("warning", "the body turns by more than 15°, if not over"),
            "{rows:?}"
        );
        assert!(!rows.iter().any(|(_, row)| row.contains("405")));
    }
}

/// A symmetric body of any weight floats upright, and one whose centre of gravity is too high turns
/// over, about whatever point its moment and its stiffness are.
#[test]
fn stability_does_not_depend_on_the_reference_point() {
    for (z, turns) in [(-0.2, false), (1.5, true)] {
        for x in [0.0, -0.5, 3.0] {
            let mut reading = reading("pontoon-deep.nc");
            reading.hydro = reading.hydro.about([x, 0.0]);
            let mut request = request();
            // Hydrostatics alone decide; no memory has to be fitted.
            let last = reading.hydro.added_mass.last().expect("frequencies");
            request.memory = Some(GivenMemory {
                added_mass_inf: std::array::from_fn(|i| std::array::from_fn(|k| last[(i, k)])),
                added_damping: Default::default(),
                memory: Vec::new(),
                reference_m: None,
            });
            request.weight.mass_kg = Some(85_000.0);
            request.weight.centre_m = Some([0.0, z]);
            let report = Report::new("pontoon", reading, &request).expect("a report");
            let warned = |what| report.warnings.iter().any(|warning| warning.what == what);
            assert!(!warned("balance"), "{x} {z}");
            assert_eq!(warned("stability"), turns, "{x} {z}");
        }
    }
}

/// Where a box floats without lines, and how it rolls there, by the hydrostatics of a box
/// of its own draft, about whatever point the file is: BM − BG = b²/(12
/// d) + d/2 − (height of G above the keel).
#[test]
fn a_body_without_lines_has_the_hydrostatics_of_where_it_floats() {
    let (length, breadth, draft, gravity, density) = (20.0, 4.0, 1.2, 9.81, 1025.0);
    for mass in [50_000.0, 80_000.0, 115_000.0] {
        let floats = mass / (density * length * breadth);
        let above_keel = draft - 0.2;
        let metacentric = breadth * breadth / (12.0 * floats) + 0.5 * floats - above_keel;
        for z in [0.0, -0.2, 1.0] {
            let hydro = hydro("pontoon-deep.nc").about([0.0, z]);
            let weight = Weight {
                mass_kg: Some(mass),
                centre_m: Some([0.05, -0.2]),
                inertia_kg_m2: Some(1.6 * mass),
            };
            let body = Body::new(&hydro, &weight).expect("a body");
            let righting = body.afloat().stiffness[(2, 2)];
            near(
                righting,
                mass * gravity * metacentric,
                0.01,
                "the stiffness",
            );
            let pitch = body.unbalanced_pitch().expect("a pitch");
            near(pitch, 0.05 / metacentric, 0.01, "the pitch");
        }
    }
}

/// Damping below zero would feed energy into the motion; that of the file is not asked.
#[test]
fn damping_below_zero_is_refused() {
    for (damping, freedom) in [
        ([0.0, -1.5e5, 0.0], "heave"),
        ([0.0, 0.0, f64::NAN], "pitch"),
        ([f64::INFINITY, 0.0, 0.0], "surge"),
    ] {
        let request = Request {
            damping,
            ..Request::default()
        };
        let report = Report::new("pontoon", reading("pontoon.nc"), &request);
        let error = report.expect_err("a refusal").to_string();
        let words = format!("the damping of {freedom}");
        assert!(
            error.contains(&words) && error.contains("0 or above"),
            "{error}"
        );
    }
}

/// Long waves in water of depth h carry a body along by coth kh of their amplitude, the more the
/// longer they are: its largest surge is at the end of a file, and said to be. Its heave has a
/// peak.
#[test]
fn a_largest_response_at_the_end_of_a_file_is_named() {
    let report = Report::new("pontoon", reading("pontoon.nc"), &request()).expect("a report");
    let floating = report.floating.as_ref().expect("answers");
    let [(surge, _), _, _] = floating.largest(0);
    let k = wave_number(surge.omega_rad_s, 10.0, 9.81);
    near(surge.amplitude, 1.0 / (k * 10.0).tanh(), 0.02, "surge");
    let response = report.summary().into_iter();
    let mut response = response.filter(|(label, _)| label == "response");
    let (_, words) = response.next().expect("a response");
    assert!(
        words.contains(" s (the lowest frequency), heave"),
        "{words}"
    );
    assert_eq!(words.matches("frequency)").count(), 1, "{words}");
}
