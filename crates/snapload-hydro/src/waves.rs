//! Linear (Airy) waves over a flat floor: dispersion, and the water's acceleration.
//!
//! Source: R. G. Dean and R. A. Dalrymple, *Water Wave Mechanics for Engineers and Scientists*
//! (1991), chapter 3.

/// The wave number k > 0 \[1/m\] with ω² = g k tanh kd, to rounding; infinite depth is allowed.
///
/// Newton's method on q tanh q = ω²d/g =: c for q = kd, from the larger of the limits of shallow
/// water, q = sqrt(c), and of deep water, q = c; a dozen steps reach the rounding from any depth.
pub fn wave_number(omega_rad_s: f64, depth_m: f64, gravity_m_s2: f64) -> f64 {
    if !depth_m.is_finite() {
        return omega_rad_s * omega_rad_s / gravity_m_s2;
    }
    let c = omega_rad_s * omega_rad_s * depth_m / gravity_m_s2;
    let mut q = c.sqrt().max(c);
    for _ in 0..40 {
        let tanh = q.tanh();
        let residual = q * tanh - c;
        let slope = tanh + q * (1.0 - tanh * tanh);
        let before = q;
        q -= residual / slope;
        if (q - before).abs() <= f64::EPSILON * before {
            break;
        }
    }
    q / depth_m
}

/// The amplitudes of the water's acceleration along x and z at a level z ≤ 0, in a wave of
/// amplitude A with ω and k \[m/s²\]:
///
/// ```text
/// a_x = ω² A cosh k(z + d)/sinh kd,    a_z = ω² A sinh k(z + d)/sinh kd
/// ```
///
/// Written with decaying exponentials, so that neither short waves nor deep water overflow.
pub fn water_acceleration(
    [amplitude_m, omega_rad_s]: [f64; 2],
    wave_number_1_m: f64,
    depth_m: f64,
    z_m: f64,
) -> [f64; 2] {
    let k = wave_number_1_m;
    let floor = 1.0 - (-2.0 * k * depth_m).exp();
    let mirrored = (-2.0 * k * (z_m + depth_m)).exp();
    let scale = omega_rad_s * omega_rad_s * amplitude_m * (k * z_m).exp() / floor;
    [scale * (1.0 + mirrored), scale * (1.0 - mirrored)]
}
