//! Properties of lines by type and diameter.
//!
//! Mass, axial stiffness and the strength of ropes: Orcina, *OrcaFlex documentation*, pages "Chain" and
//! "Rope/wire", for d in metres there in te/m and kN, here in kg/m and N. Strength of chains:
//! c d² (44 − 80 d) with d in metres; the coefficients c of the offshore grades R3, R3S and R4 give the breaking
//! loads that makers of chain print (38 mm: 1319, 1473 and 1621 kN), which a test holds.
//! They are typical values for a first design, not those of a product.

/// The types of line by their names.
pub(crate) const TYPES: &[&str] = &[
    "studless chain",
    "stud chain",
    "wire rope, fibre core",
    "wire rope, steel core",
    "polyester",
    "nylon",
];

/// The grades of chain.
pub(crate) const GRADES: &[&str] = &["R3", "R3S", "R4"];

/// What one metre of a line is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Mass per length μ in air \[kg/m\].
    pub mass_per_length_kg_m: f64,
    /// Axial stiffness EA \[N\].
    pub stiffness_n: f64,
    /// Minimum breaking load \[N\].
    pub breaking_load_n: f64,
}

/// The section of a line of a type, such as `studless chain`, and a diameter, a chain of a grade; `None` for another name.
pub fn section(kind: &str, diameter_m: f64, grade: Option<&str>) -> Option<Section> {
    let d2 = diameter_m * diameter_m;
    let of = |mass: f64, stiffness: f64, strength: f64| {
        Some(Section {
            mass_per_length_kg_m: mass * d2,
            stiffness_n: stiffness * d2,
            breaking_load_n: strength * d2,
        })
    };
    let chain = || {
        let c = match grade.unwrap_or("R3") {
            "R3S" => 2.49e7,
            "R4" => 2.74e7,
            _ => 2.23e7,
        };
        c * (44.0 - 80.0 * diameter_m)
    };
    match kind {
        "studless chain" => of(19.9e3, 0.854e11, chain()),
        "stud chain" => of(21.9e3, 1.01e11, chain()),
        "wire rope, fibre core" => of(3610.9, 3.67e10, 584_175e3),
        "wire rope, steel core" => of(3989.7, 4.04e10, 633_358e3),
        "polyester" => of(797.8, 1.09e9, 170_466e3),
        "nylon" => of(647.6, 1.18e8, 139_357e3),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Breaking loads from a maker's table of offshore mooring chain, in kN, rounded there to 1 kN.
    #[test]
    fn chains_break_where_their_makers_say() {
        let table = [
            (0.038, [1319.0, 1473.0, 1621.0]),
            (0.050, [2230.0, 2490.0, 2740.0]),
            (0.066, [3762.0, 4200.0, 4622.0]),
        ];
        for (diameter, loads) in table {
            for (grade, load) in GRADES.iter().zip(loads) {
                let ours = section("studless chain", diameter, Some(grade))
                    .unwrap()
                    .breaking_load_n
                    / 1e3;
                assert!(
                    (ours - load).abs() < 1.0,
                    "{grade} {diameter}: {ours} {load}"
                );
            }
        }
    }

    #[test]
    fn every_type_has_a_section_and_nothing_else_has() {
        assert!(TYPES.iter().all(|kind| section(kind, 0.05, None).is_some()));
        assert_eq!(section("spaghetti", 0.05, None), None);
    }
}
