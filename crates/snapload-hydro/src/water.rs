//! The water in which a body floats.

/// The water for which the coefficients were computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Water {
    /// ρ \[kg/m³\].
    pub density_kg_m3: f64,
    /// g \[m/s²\].
    pub gravity_m_s2: f64,
    /// Depth \[m\]; infinite for deep water.
    pub depth_m: f64,
}
