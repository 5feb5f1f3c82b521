//! Root mean squares in a sea.

use crate::common::hydro;
use nalgebra::{Complex, Matrix3, Vector3};
use snapload_hydro::{Body, Memory, Weight, fine_responses};
use std::f64::consts::PI;

/// An oscillator under white noise S0 of its force has the variance π S0/(2 b c), whatever its
/// mass, as ∫ dω/((c − m ω²)² + b² ω²) from 0 on is π/(2 b c). Heave is one if its coefficients do
/// not depend on the frequency; its peak becomes narrower and narrower.
#[test]
fn a_narrow_peak_has_its_part_of_the_variance() {
    let mut hydro = hydro("pontoon.nc");
    let mut body = Body::new(&hydro, &Weight::default()).expect("a body");
    body.mass = Matrix3::from_diagonal(&Vector3::repeat(1e5));
    let stiffness = 1e5 * 1.837_f64.powi(2);
    body.stiffness = Matrix3::from_diagonal(&Vector3::new(0.0, stiffness, 0.0));
    hydro.added_mass.fill(Matrix3::zeros());
    hydro.damping.fill(Matrix3::zeros());
    for excitation in &mut hydro.excitation {
        let push = Vector3::new(0.0, 1.0, 0.0);
        let push = push.map(|force: f64| Complex::new(1e5 * force, 0.0));
        excitation.force.fill(push);
    }
    let memory = Memory::default();
    for ratio in [1e-3, 1e-4, 3e-5, 1e-6] {
        body.damping[(1, 1)] = 2.0 * ratio * (1e5 * stiffness).sqrt();
        let exponentials = (&memory, &Matrix3::zeros());
        // The peak is searched for about a frequency that is only near its own.
        let responses = fine_responses(&hydro, &body, exponentials, 1.0, &[1.8371]);
        let [response, _] = responses.expect("responses");
        let variance = PI * 1e10 / (2.0 * body.damping[(1, 1)] * stiffness);
        let ([_, heave, _], _) = response.in_a_sea(|_| 1.0);
        let off = heave * heave / variance - 1.0;
        // What is outside the file's frequencies is a few ζ of it.
        assert!(off.abs() < 2e-3 + 2.0 * ratio, "ζ = {ratio}: {off}");
    }
}
