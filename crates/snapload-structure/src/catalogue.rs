//! Properties of lines by type and diameter.
//!
//! Mass and axial stiffness of chains: Orcina, *OrcaFlex documentation*, page "Chain", for d in
//! metres there in te/m and kN, here in kg/m and N. Ropes have the values of its page "Rope/wire"
//! as MoorPy prints them (docs/structures.md). Strength of chains:
//! c d² (44 − 80 d) with d in metres; the coefficients c of the offshore grades R3, R3S and R4 give
//! the breaking loads that makers of chain print (38 mm: 1319, 1473 and 1621 kN), which a test
//! checks. They are typical values for a first design, not those of a product.

/// A type of line by its name: mass \[kg/m\], stiffness and strength \[N\] of a diameter of 1 m.
/// The strength of a chain follows from its grade.
const LINES: [(&str, f64, f64, Option<f64>); 6] = [
    ("studless chain", 19.9e3, 0.854e11, None),
    ("stud chain", 21.9e3, 1.01e11, None),
    ("wire rope, fibre core", 3610.9, 3.67e10, Some(584_175e3)),
    ("wire rope, steel core", 3989.7, 4.04e10, Some(633_358e3)),
    ("polyester", 797.8, 1.09e9, Some(170_466e3)),
    ("nylon", 647.6, 1.18e8, Some(139_357e3)),
];
/// The coefficient c of each grade of chain \[N/m²\]; the first one is used for a chain without a
/// grade.
const CHAINS: [(&str, f64); 3] = [("R3", 2.23e7), ("R3S", 2.49e7), ("R4", 2.74e7)];

/// The types of line by their names.
#[rustfmt::skip]
pub(crate) const TYPES: &[&str] =
    &[LINES[0].0, LINES[1].0, LINES[2].0, LINES[3].0, LINES[4].0, LINES[5].0];
/// The grades of chain.
pub(crate) const GRADES: &[&str] = &[CHAINS[0].0, CHAINS[1].0, CHAINS[2].0];

/// Whether a type of line is a chain, whose strength follows from a grade.
pub(crate) fn is_chain(kind: &str) -> bool {
    LINES
        .iter()
        .any(|(name, .., strength)| *name == kind && strength.is_none())
}

/// The properties of one metre of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Mass per length μ in air \[kg/m\].
    pub mass_per_length_kg_m: f64,
    /// Axial stiffness EA \[N\].
    pub stiffness_n: f64,
    /// Minimum breaking load \[N\].
    pub breaking_load_n: f64,
}

/// The section of a line of a type, such as `studless chain`, and a diameter, a chain of a grade;
/// `None` for another name.
pub fn section(kind: &str, diameter_m: f64, grade: Option<&str>) -> Option<Section> {
    let (_, mass, stiffness, strength) = LINES.into_iter().find(|(name, ..)| *name == kind)?;
    let d2 = diameter_m * diameter_m;
    let strength = strength.unwrap_or_else(|| {
        let graded = CHAINS.iter().find(|(name, _)| Some(*name) == grade);
        graded.unwrap_or(&CHAINS[0]).1 * (44.0 - 80.0 * diameter_m)
    });
    Some(Section {
        mass_per_length_kg_m: mass * d2,
        stiffness_n: stiffness * d2,
        breaking_load_n: strength * d2,
    })
}
