//! The inputs that a note lists.

use crate::structure::{Outline, Structure, Water};
use crate::text_layout::{digits, kilo, tenths};
use askama::Template;

#[derive(Template)]
#[template(path = "inputs.html")]
struct Inputs<'a> {
    structure: &'a Structure,
}

/// The section of a page that lists the case's data of body, site, water, run and lines.
pub fn inputs(structure: &Structure) -> String {
    Inputs { structure }.to_string()
}

fn place([x, z]: &[f64; 2]) -> String {
    format!("({x}, {z})")
}

/// The drag and damping of the water on a moving body.
pub(super) fn resistance(structure: &Structure) -> Vec<String> {
    let body = &structure.body;
    let parts = [
        ("C_d A =", body.drag_area_m2, "m²"),
        ("linear", body.linear_damping_n_s_m, "N s/m"),
        ("turning", body.turning_damping_n_m_s, "N m s"),
    ];
    let afloat = structure.afloat.iter().flat_map(|afloat| {
        let damping = &afloat.body.damping;
        let names = match afloat.makes_waves() {
            true => [
                "surge (besides radiation)",
                "heave (besides radiation)",
                "pitch (besides radiation)",
            ],
            false => ["surge", "heave", "pitch"],
        };
        [
            (names[0], damping[(0, 0)], "N s/m"),
            (names[1], damping[(1, 1)], "N s/m"),
            (names[2], damping[(2, 2)], "N m s"),
        ]
    });
    let given = parts.into_iter().chain(afloat);
    let given = given.filter(|(_, value, _)| *value > 0.0);
    given
        .map(|(name, value, unit)| format!("{name} {value} {unit}"))
        .collect()
}
