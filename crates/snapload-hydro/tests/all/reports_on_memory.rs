//! What reports say of a memory that was fitted or given.

use crate::common::reading;
use snapload_hydro::{EntryQuality, FitOptions, GivenMemory, Report, Request};

/// The report on a sphere with a memory that is given, or fitted.
fn sphere(memory: Option<GivenMemory>) -> Report {
    let request = Request {
        memory,
        ..Request::default()
    };
    Report::new("sphere", reading("sphere.nc"), &request).expect("a report")
}

/// Damping that a memory needs to be passive acts with its exponentials alone: the response by the
/// file solves (−ω²(M + A) − iωB + C) ξ = X with its own numbers. With the memory it is written to
/// a file and read again, about another point, too, on which no period depends.
#[test]
fn damping_that_was_added_belongs_to_the_memory() {
    let poor = || reading("pontoon-poor.nc");
    let report = Report::new("poor", poor(), &Request::default()).expect("a report");
    assert!(report.fit.memory.damping.amax() > 0.0);
    let (hydro, floating) = (
        &report.reading.hydro,
        report.floating.as_ref().expect("a body"),
    );
    let (mass, stiffness) = (floating.body.mass, floating.body.afloat().stiffness);
    let [of_the_file, _] = &floating.responses[0];
    for (k, xi) in of_the_file.amplitude.iter().enumerate() {
        let omega = hydro.omega_rad_s[k];
        let real = stiffness - (mass + hydro.added_mass[k]) * (omega * omega);
        let imaginary = hydro.damping[k] * -omega;
        let force = &hydro.excitation[0].force[k];
        let left = real.zip_map(&imaginary, nalgebra::Complex::new) * xi - force;
        assert!(left.norm() < 1e-9 * force.norm(), "{omega}: {left}");
    }
    let json = serde_json::to_string(&report.to_json()).expect("JSON");
    for point in [[0.0, 0.0], [0.3, -0.5]] {
        let mut reading = poor();
        reading.hydro = reading.hydro.about(point);
        let request = Request {
            memory: Some(serde_json::from_str(&json).expect("a memory")),
            ..Request::default()
        };
        let again = Report::new("poor", reading, &request).expect("a report");
        let modes = &again.floating.as_ref().expect("a body").modes;
        for (found, known) in modes.iter().zip(&floating.modes) {
            let apart = (found.eigenvalue - known.eigenvalue).norm();
            assert!(apart < 1e-9, "{point:?}: {found:?} {known:?}");
        }
        assert!(again.memory_summary().ends_with("; damping added"));
        assert!(
            !again
                .warnings
                .iter()
                .any(|warning| warning.what == "passivity")
        );
    }
}

/// A memory that can feed energy into the motion is not called passive.
#[test]
fn a_memory_that_is_not_passive_is_not_called_so() {
    let fitted = sphere(None);
    assert!(fitted.memory_summary().ends_with("; passive"));
    let json = serde_json::to_string(&fitted.to_json()).expect("JSON");
    let mut memory: GivenMemory = serde_json::from_str(&json).expect("a memory");
    let same = sphere(Some(memory.clone())).memory_summary();
    assert!(
        same.starts_with("given, ") && same.ends_with("; passive"),
        "{same}"
    );
    for row in &mut memory.memory {
        let numbers = row.residue.as_flattened_mut().as_flattened_mut();
        numbers.iter_mut().for_each(|number| *number = -*number);
    }
    let feeds = sphere(Some(memory.clone())).memory_summary();
    assert!(feeds.ends_with("; not passive"), "{feeds}");
    memory.memory.clear();
    let empty = sphere(Some(memory)).memory_summary();
    assert!(
        empty.starts_with("given, 0 states; differs from the file by at most 100.00 %"),
        "{empty}"
    );
}

/// A given memory is used with its own A(∞), and that is what another one of the file is compared
/// with: nothing is said of the file's damping.
#[test]
fn the_added_mass_of_a_given_memory_is_not_that_of_the_files_damping() {
    let json = serde_json::to_string(&sphere(None).to_json()).expect("JSON");
    let mut memory: GivenMemory = serde_json::from_str(&json).expect("a memory");
    memory.added_mass_inf[1][1] *= 2.0;
    let report = sphere(Some(memory));
    let mut warnings = report.warnings.iter();
    let said = warnings.find(|warning| warning.what == "added mass at infinity");
    let words = &said.expect("a warning").message;
    assert!(
        words.starts_with("the file's A(∞) of heave differs by -")
            && words.ends_with("from that of the given memory; the latter is used"),
        "{words}"
    );
}

/// What a memory is off the file by is said of the entry that it is said of, and of a block that
/// fits badly the entry that fits worse than the whole.
#[test]
fn a_fit_is_no_better_than_its_worst_entry() {
    let request = Request {
        fit: FitOptions { pairs: Some(2) },
        ..Request::default()
    };
    let report = Report::new("pontoon", reading("pontoon-deep.nc"), &request).expect("a report");
    let worst = EntryQuality::worst(&report.fit.entries).expect("entries");
    let expected = format!(
        "{:.2} % (root mean square; {})",
        100.0 * worst.rms,
        worst.name()
    );
    assert!(report.memory_summary().contains(&expected), "{expected}");
    let mut blocks = report.fit.blocks.iter();
    assert!(blocks.any(|block| block.freedoms.len() > 1));
    for block in report
        .fit
        .blocks
        .iter()
        .filter(|block| block.freedoms.len() > 1)
    {
        let own = report.fit.entries.iter();
        let own = own.filter(|entry| block.freedoms.contains(&entry.force));
        let worst = EntryQuality::worst(own).expect("entries");
        assert!(worst.rms > block.rms && block.rms > 0.02, "{block:?}");
        let expected = format!("{} alone to {:.1} %", worst.name(), 100.0 * worst.rms);
        assert!(
            report
                .warnings
                .iter()
                .any(|warning| warning.message.contains(&expected))
        );
    }
}
