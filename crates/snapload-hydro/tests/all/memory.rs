//! Memories fitted to files, against independent fits and against the properties that a memory must
//! have.

use crate::common::{hydro, reference};
use nalgebra::{Complex, Matrix3, Vector3};
use proptest::prelude::*;
use snapload_hydro::{Fit, FitOptions, Memory, TermRow, fit, given};
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

/// The fit of a file, made once.
fn fitted(name: &'static str) -> Fit {
    static FITS: Mutex<BTreeMap<&str, Fit>> = Mutex::new(BTreeMap::new());
    let mut fits = FITS.lock().expect("the fits");
    let new = || fit(&hydro(name), FitOptions::default()).expect(name);
    fits.entry(name).or_insert_with(new).clone()
}

/// The good files: within 1 % of B + iω(A − A∞) and of K, passive, without damping at rest.
#[test]
fn good_files_are_fitted_within_one_percent() {
    for name in ["pontoon-deep.nc", "sphere.nc", "cylinder.nc"] {
        let fit = fitted(name);
        for entry in &fit.entries {
            assert!(
                entry.rms < 0.01 && entry.kernel_rms < 0.01,
                "{name}: {entry:?}"
            );
            assert!(entry.outliers_rad_s.is_empty(), "{name}: {entry:?}");
        }
        let last = hydro(name).range_rad_s()[1];
        assert!(fit.memory.least_eigenvalue(last) > -2e-9, "{name}");
        assert!(fit.blocks.iter().all(|block| !block.damped));
        assert_eq!(fit.memory.damping, Matrix3::zeros());
        let size = fit.memory.transform(0.5 * last).map(|k| k.norm()).max();
        assert!(fit.memory.transform(0.0).map(|k| k.norm()).max() < 1e-9 * size);
        // Heave alone, surge with pitch; no coupling between them.
        for (i, j) in [(0, 1), (1, 2)] {
            assert_eq!(fit.memory.kernel(0.3)[(i, j)], 0.0);
        }
        fit.memory.check().expect("a memory");
    }
}

/// A memory is passive at all frequencies, and not only at those of some grid: at a hundred
/// thousand of them, 0.0001 rad/s apart, no damping is negative by more than 1e-9 of the largest.
/// Between them it falls by less, as its minima are wider than 0.01 rad/s.
#[test]
fn memories_are_passive_between_the_frequencies_of_a_grid() {
    for name in ["pontoon-deep.nc", "pontoon.nc"] {
        let memory = fitted(name).memory;
        let real = |omega: f64| memory.transform(omega).map(|entry| entry.re);
        let coarse: Vec<Matrix3<f64>> = (1..100).map(|k| real(0.1 * f64::from(k))).collect();
        let root = |i: usize| coarse.iter().map(|b| b[(i, i)]).fold(0.0, f64::max).sqrt();
        let unit = [0, 1, 2].map(|i| root(i).recip());
        for k in 1..=100_000 {
            let omega = 1e-4 * f64::from(k);
            let b = real(omega);
            let b = Matrix3::from_fn(|i, j| b[(i, j)] * unit[i] * unit[j]);
            let least = b.symmetric_eigenvalues().min();
            assert!(least > -2e-9, "{name}: {least:e} at {omega}");
        }
    }
}

/// Another program's fit of the same files, by its own least squares, is the same memory within the
/// errors of both fits.
#[test]
fn fits_agree_with_another_programs() {
    for (name, file) in [
        ("pontoon", "pontoon-deep.nc"),
        ("cylinder", "cylinder.nc"),
        ("sphere", "sphere.nc"),
    ] {
        let rows: Vec<TermRow> =
            serde_json::from_value(reference("fits.json")[name]["memory"].clone()).expect("rows");
        let theirs = Memory::from_rows(&rows).expect("a memory");
        let ours = fitted(file).memory;
        for i in 0..3 {
            let k0 = theirs.kernel(0.0)[(i, i)];
            let mut worst: f64 = 0.0;
            for step in 4..200 {
                let t = 0.1 * f64::from(step);
                let difference = (ours.kernel(t) - theirs.kernel(t))[(i, i)];
                worst = worst.max(difference.abs() / k0);
            }
            assert!(worst < 0.02, "{name} {i}: {worst}");
        }
    }
}

/// A∞ from the damping: the value of the other program, and the sphere's exact one (A33 = 130,900
/// kg for this sphere; P. McIver and C. M. Linton).
#[test]
fn added_mass_at_infinity_follows_from_the_damping() {
    for (name, file) in [
        ("pontoon", "pontoon-deep.nc"),
        ("cylinder", "cylinder.nc"),
        ("sphere", "sphere.nc"),
    ] {
        let rows: [[f64; 3]; 3] =
            serde_json::from_value(reference("fits.json")[name]["added_mass_inf"].clone())
                .expect("a matrix");
        let theirs = Matrix3::from_fn(|i, j| rows[i][j]);
        let ours = snapload_hydro::added_mass_at_infinity(&hydro(file));
        let off = (ours - theirs).component_div(&theirs.map(|a| a.abs().max(1.0)));
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 2)] {
            assert!(off[(i, j)].abs() < 3e-4, "{name} {i}{j}: {ours}{theirs}");
        }
    }
    let sphere = snapload_hydro::added_mass_at_infinity(&hydro("sphere.nc"));
    assert!((sphere[(1, 1)] / 130_900.0 - 1.0).abs() < 5e-4);
}

/// There are warnings of poor files, with the outlying frequencies.
#[test]
fn poor_files_cause_warnings() {
    let poor = fitted("pontoon-poor.nc");
    let about = |what: &str| {
        let warnings = poor.warnings.iter().filter(|warning| warning.what == what);
        warnings
            .map(|warning| warning.message.as_str())
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert!(about("fit").contains("heave"), "{:?}", poor.warnings);
    let irregular = about("irregular frequencies");
    for omega in ["heave", "5.000", "5.100", "5.200", "5.300", "5.900"] {
        assert!(irregular.contains(omega), "{irregular}");
    }
    // What is computed without the memory has them.
    assert!(irregular.contains("responses by the file"), "{irregular}");
    assert!(
        about("added mass at infinity").contains("heave"),
        "{:?}",
        poor.warnings
    );
    assert!(!about("passivity").is_empty());
    for warning in &poor.warnings {
        let broken = warning.message.contains('\n') || warning.message.contains("  ");
        assert!(!broken, "{:?}", warning.message);
    }
    // With the damping that is added the sum is passive.
    let mut least = f64::INFINITY;
    for step in 1..4000 {
        let omega = 0.005 * f64::from(step);
        let b = poor.memory.transform(omega).map(|k| k.re);
        least = least.min(b.symmetric_eigenvalues().min());
    }
    assert!(
        least > -1e-6 * poor.memory.damping.amax(),
        "{least} {}",
        poor.memory.damping
    );
}

/// A memory that feeds energy into the motion at every frequency is −100 % passive, and one that
/// leaves all waves out is off the file by all of them.
#[test]
fn given_memories_that_are_wrong_are_reported() {
    let (sphere, whole) = (hydro("sphere.nc"), fitted("sphere.nc"));
    let inf = std::array::from_fn(|i| std::array::from_fn(|j| whole.added_mass_inf[(i, j)]));
    let mut rows = whole.memory.rows();
    let feeds = Memory::from_rows(&rows).expect("a memory");
    assert!(feeds.least_eigenvalue(4.0) > -2e-9);
    for part in rows
        .iter_mut()
        .flat_map(|row| row.residue.as_flattened_mut())
    {
        *part = part.map(|number| -number);
    }
    let message = |rows: &[TermRow], what: &str| {
        let fit = given(&sphere, inf, Default::default(), rows).expect("a fit");
        let of = fit
            .warnings
            .into_iter()
            .filter(|warning| warning.what == what);
        of.map(|warning| warning.message).collect::<String>()
    };
    let passivity = message(&rows, "passivity");
    assert!(passivity.contains("falls to -100.00 %"), "{passivity}");
    let fit = message(&[], "fit");
    assert!(fit.contains("differs from the file by 100.0 %"), "{fit}");
    assert_eq!(message(&[], "passivity"), "");
    assert_eq!(message(&whole.memory.rows(), "passivity"), "");
}

/// A file of medium quality, of finite depth, is accepted with warnings.
#[test]
fn middling_files_are_taken_with_warnings() {
    let fit = fitted("pontoon.nc");
    let about = |what: &str| fit.warnings.iter().any(|warning| warning.what == what);
    // A∞ of the file and of its damping differ by 5 % in surge and by 2 % in heave.
    let off = fit
        .warnings
        .iter()
        .filter(|w| w.what == "added mass at infinity")
        .count();
    assert!(off == 2 && about("fit"), "{:?}", fit.warnings);
    assert!(!about("irregular frequencies") && !about("passivity") && !about("frequency steps"));
    assert!(fit.memory.least_eigenvalue(3.62) > -2e-9);
    // The same body's memory in deep water lasts for more than 3 s, which can not be resolved with
    // frequencies 1.12 rad/s apart.
    let whole = fitted("pontoon-deep.nc");
    let inf = std::array::from_fn(|i| std::array::from_fn(|j| whole.added_mass_inf[(i, j)]));
    let dropped: Vec<usize> = (0..58).filter(|k| k % 14 != 0).collect();
    let sparse = hydro("pontoon-deep.nc").without(&dropped);
    let sparse = given(&sparse, inf, Default::default(), &whole.memory.rows()).expect("a fit");
    let steps = sparse
        .warnings
        .iter()
        .any(|warning| warning.what == "frequency steps");
    assert!(steps, "{:?}", sparse.warnings);
}

/// Surge and pitch that do not couple, as about the point where they do not or as in a file that
/// has no such rows, have memories of their own, each as good as with the coupling.
#[test]
fn freedoms_without_coupling_are_fitted() {
    let mut body = hydro("pontoon-deep.nc");
    for matrix in body.added_mass.iter_mut().chain(&mut body.damping) {
        (matrix[(0, 2)], matrix[(2, 0)]) = (0.0, 0.0);
    }
    let fit = fit(&body, FitOptions::default()).expect("a fit");
    let names: Vec<String> = fit.entries.iter().map(|entry| entry.name()).collect();
    assert_eq!(names, ["heave", "surge", "pitch"]);
    for entry in &fit.entries {
        assert!(entry.rms < 0.01 && entry.kernel_rms < 0.01, "{entry:?}");
    }
    assert_eq!(fit.memory.kernel(0.3)[(0, 2)], 0.0);
    let least = fit.memory.least_eigenvalue(body.range_rad_s()[1]);
    assert!(least > -1e-5, "{least}");
    assert_eq!(fit.blocks.len(), 3);
    assert!(fit.warnings.is_empty(), "{:?}", fit.warnings);
}

/// The transform is the integral of the memory.
#[test]
fn the_transform_is_that_of_the_kernel() {
    let memory = fitted("sphere.nc").memory;
    for omega in [0.3, 1.1, 2.4] {
        let steps = 40_000;
        let dt = 60.0 / f64::from(steps);
        let mut sum = Matrix3::zeros();
        for step in 0..=steps {
            let t = dt * f64::from(step);
            let ends = if step == 0 || step == steps { 0.5 } else { 1.0 };
            let turn = Complex::from_polar(ends * dt, -omega * t);
            sum += memory.kernel(t).map(|k| turn * k);
        }
        let transform = memory.transform(omega);
        let size = transform.map(|k| k.norm()).max();
        assert!((sum - transform).map(|k| k.norm()).max() < 1e-4 * size);
    }
}

/// A memory written as JSON and read again is identical; bad ones are refused.
#[test]
fn memories_are_printed_and_read() {
    let memory = fitted("cylinder.nc").memory;
    let text = serde_json::to_string(&memory.rows()).expect("text");
    let rows: Vec<TermRow> = serde_json::from_str(&text).expect("rows");
    let again = Memory::from_rows(&rows).expect("a memory");
    for (a, b) in again.terms.iter().zip(&memory.terms) {
        assert!((a.pole - b.pole).norm() <= 1e-15 * b.pole.norm());
        let difference = (a.residue - b.residue).map(|r| r.norm()).max();
        assert!(difference <= 1e-15 * b.residue.map(|r| r.norm()).max());
    }
    let refused = |change: fn(&mut TermRow)| {
        let mut rows = rows.clone();
        change(&mut rows[0]);
        Memory::from_rows(&rows).expect_err("a refusal").to_string()
    };
    assert!(refused(|row| row.pole[0] = 0.1).contains("memory[0].pole[0] = 0.1"));
    assert!(refused(|row| row.residue[0][1][0] += 1e6).contains("transpose"));
    assert!(refused(|row| row.pole[1] = 0.0).contains("real pole"));
    assert!(refused(|row| row.residue[1][1][0] = f64::NAN).contains("residue"));
}

/// The number of pairs can be chosen.
#[test]
fn the_number_of_poles_can_be_chosen() {
    let hydro = hydro("sphere.nc");
    let few = fit(&hydro, FitOptions { pairs: Some(4) }).expect("a fit");
    assert!(few.blocks.iter().all(|block| block.pairs == 4));
    // Four pairs act on heave, four on surge and on pitch.
    assert_eq!(few.memory.states(), 8 + 2 * 8);
    assert!(fit(&hydro, FitOptions { pairs: Some(0) }).is_err());
    assert!(fit(&hydro, FitOptions { pairs: Some(1000) }).is_err());
}

/// Of a file with few frequencies no more pairs of poles are sought than it has frequencies.
#[test]
fn few_frequencies_get_few_poles() {
    let all = hydro("pontoon.nc");
    let count = all.omega_rad_s.len();
    let apart: Vec<usize> = (0..count).filter(|k| k % (count / 7) != 3).collect();
    let few = all.without(&apart);
    let left = few.omega_rad_s.len();
    assert!((7..=8).contains(&left));
    let fitted = fit(&few, FitOptions::default()).expect("a fit");
    assert!(fitted.blocks.iter().all(|block| block.pairs <= left));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    /// Random bodies whose waves take energy out, as sums of band passes v vᵀ s/(s² + 2ζω s + ω²),
    /// get memories that are passive, too, and that are close to the exact ones.
    #[test]
    fn memories_of_random_bodies_are_passive(
        heave in prop::array::uniform2((0.2..1.0_f64, 1.0..3.0_f64, 0.2..0.9_f64)),
        surge in prop::array::uniform2((
            prop::array::uniform2(-1.0..1.0_f64), 1.0..3.0_f64, 0.2..0.9_f64,
        )),
    ) {
        let mut body = hydro("sphere.nc");
        let pass = |omega: f64, (at, zeta): (f64, f64)| {
            let s = Complex::new(0.0, omega);
            s / (s * s + s * (2.0 * zeta * at) + at * at) * 1e5
        };
        for (k, omega) in body.omega_rad_s.clone().into_iter().enumerate() {
            let mut whole = Matrix3::zeros();
            for (size, at, zeta) in heave {
                whole[(1, 1)] += pass(omega, (at, zeta)) * size;
            }
            for ([x, turn], at, zeta) in surge {
                let v = Vector3::new(x, 0.0, turn);
                let one = pass(omega, (at, zeta));
                whole += (v * v.transpose()).map(|part| one * part);
            }
            body.damping[k] = whole.map(|z| z.re);
            body.added_mass[k] = Matrix3::from_diagonal_element(1e5) + whole.map(|z| z.im / omega);
        }
        let fit = snapload_hydro::fit(&body, FitOptions { pairs: Some(6) }).expect("a fit");
        prop_assert!(fit.memory.least_eigenvalue(4.64) > -2e-9);
        prop_assert!(fit.blocks.iter().all(|block| !block.damped));
        // Their damping falls more slowly beyond the last frequency than any body's.
        for block in &fit.blocks {
            prop_assert!(block.rms < 0.03, "{block:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// A passive memory takes energy out of every motion from rest: ∫
    /// q̇ᵀ F_mem dt ≥ 0 at all times.
    #[test]
    fn memories_feed_no_energy(
        a in prop::array::uniform3(-1.0..1.0_f64),
        b in prop::array::uniform3(-1.0..1.0_f64),
        omega in 0.1..5.0_f64,
        jump in 0.0..8.0_f64,
    ) {
        let memory = sphere_memory();
        let dt = 0.01;
        let mut z: Vec<Vector3<Complex<f64>>> = vec![Vector3::zeros(); memory.terms.len()];
        let (mut work, mut size): (f64, f64) = (0.0, 0.0);
        for step in 0..1500 {
            let t = dt * (f64::from(step) + 0.5);
            // A motion with a snap: its velocity jumps.
            let v = Vector3::from(a) * (omega * t).sin()
                + if t > jump { Vector3::from(b) } else { Vector3::zeros() };
            let v = Vector3::new(v[0], v[1], 0.2 * v[2]);
            let mut force = Vector3::zeros();
            for (z, term) in z.iter_mut().zip(&memory.terms) {
                // Exact for a velocity that is constant within the step; the force at its middle.
                let (p, one) = (term.pole, Complex::new(1.0, 0.0));
                let v = v.map(|v| Complex::new(v, 0.0));
                let half = *z * (p * 0.5 * dt).exp() + v * (((p * 0.5 * dt).exp() - one) / p);
                force += (term.residue * half).map(|f| f.re);
                *z = *z * (p * dt).exp() + v * (((p * dt).exp() - one) / p);
            }
            work += v.dot(&force) * dt;
            size = size.max(work.abs());
            prop_assert!(work > -1e-4 * size, "{work} of {size} at {t}");
        }
    }
}

fn sphere_memory() -> &'static Memory {
    static MEMORY: OnceLock<Memory> = OnceLock::new();
    MEMORY.get_or_init(|| fitted("sphere.nc").memory)
}
