//! The answer as a page for a design note: one file of HTML that needs nothing else.

mod plots;
mod scan;
mod seas;

pub use scan::{Scan, scan};
pub use seas::seas_page;

use crate::assess::Assessment;
use crate::snap::Snap;
use crate::structure::{Outline, Structure, Water};
use crate::verdict::{Standing, end_words};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use snapload_figures::{FigureError, Picture};

/// Readable on a phone, in print, in light and dark.
const STYLE: &str = include_str!("note.css");
/// So many of the hardest snaps are listed.
const LISTED: usize = 12;

/// The page. `command` is the command line that makes it again.
///
/// # Errors
/// A [`FigureError`] if a plot can not be drawn.
pub fn page(
    name: &str,
    command: &str,
    assessment: &Assessment,
    scan: Option<&Scan>,
) -> Result<String, FigureError> {
    let verdict = assessment.verdict();
    let plots = plots::all(assessment)?;
    let scanned = scan
        .map(|scan| Ok((plots::of_scan(scan, &assessment.prepared.structure)?, scan)))
        .transpose()?;
    let class = match verdict.standing {
        Standing::Holds => "holds",
        Standing::Breaks | Standing::Exceeds => "fails",
        Standing::Unknown => "open",
    };
    let body = html! {
        header {
            h1 { "Mooring note: " (name) }
            p class={ "verdict " (class) } { (verdict.words) }
            p { (assessment.trust_words()) }
        }
        (lines(assessment))
        (warnings(assessment))
        section {
            h2 { "Motion and snaps" }
            div.figures { @for (plot, words) in &plots { (figure(plot, words)) } }
            (snaps(assessment))
        }
        @if let Some((picture, scan)) = &scanned {
            section {
                h2 { "Other waves" }
                div.figures { (figure(picture, &scan.words())) }
            }
        }
        (inputs_of(&assessment.prepared.structure))
        (units(assessment))
        (assumptions(&assessment.prepared.structure))
    };
    Ok(whole(&format!("Mooring note: {name}"), command, &body))
}

/// A page that needs nothing beside it.
fn whole(title: &str, command: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (body)
                footer {
                    p { "Made by snapload " (env!("CARGO_PKG_VERSION")) " with the command" }
                    p { code { (command) } }
                }
            }
        }
    };
    page.into_string()
}

fn figure(picture: &Picture, words: &str) -> Markup {
    html! {
        figure { (PreEscaped(picture.svg())) figcaption { (words) } }
    }
}

fn kilo(newtons: f64) -> String {
    format!("{:.0}", newtons / 1e3)
}

fn maybe_kilo(newtons: Option<f64>) -> String {
    newtons.map_or("not known".to_owned(), kilo)
}

fn lines(assessment: &Assessment) -> Markup {
    let structure = &assessment.prepared.structure;
    let utilisations = assessment.outcome.utilisations(structure);
    html! {
        section {
            h2 { "Lines" }
            div.wide { table {
                thead { tr {
                    th { "line" } th { "what" } th { "at rest" br; "kN" } th { "held" br; "kN" } th { "slack" br; "% of time" }
                    th { "snaps" } th { "fastest" br; "m/s" } th { "snap tension" br; "kN" } th { "breaks at" br; "kN" } th { "utilisation" }
                } }
                tbody { @for (index, line) in structure.lines.iter().enumerate() {
                    @let outcome = &assessment.outcome.lines[index];
                    tr {
                        td { (index + 1) } td { (if line.name.is_empty() { "own values" } else { &line.name }) }
                        td { (kilo(assessment.prepared.rest.tension_n[index])) } td { (kilo(outcome.held_n)) }
                        td { (format!("{:.1}", 100.0 * outcome.slack_fraction)) } td { (outcome.snaps) }
                        td { (format!("{:.2}", outcome.speed_m_s)) }
                        td { @if outcome.snaps + outcome.jolts == 0 { "none" } @else { (maybe_kilo(outcome.peak_n)) } }
                        td { (maybe_kilo(line.breaking_load_n)) }
                        td { (utilisations[index].map_or("not known".to_owned(), |u| format!("{u:.2}"))) }
                    }
                } }
            } }
            p.small {
                "Held: the largest tension while the line stays taut. Snap tension: the estimated peak (see Assumptions). "
                "Utilisation: the larger of held and snap tension over the breaking load, without any factor of safety. Snaps slower "
                "than 1 cm/s are lines settling down and are not counted; snaps before t = "
                (format!("{:.0}", structure.transient_s)) " s are not judged, as the waves begin at once on a body at rest. The run "
                (end_words(assessment.outcome.stop)) ", " (format!("{:.0}", assessment.outcome.end_s)) " s."
                @if assessment.prepared.rest.indeterminate {
                    " At rest more lines are taut than the body has freedoms; the tensions there are those of least sum of squares, \
                      and the true ones depend on how stiff the lines are."
                }
            }
        }
    }
}

fn warnings(assessment: &Assessment) -> Markup {
    html! {
        section {
            h2 { "Warnings" }
            @if assessment.warnings.is_empty() {
                p { "None: the case is within the range of every rule that was looked at (submergence, free surface, floor, breaking \
                     waves, linear theory, drag, diffraction, instant snaps, phase, light lines)." }
            } @else {
                ul.warnings { @for warning in &assessment.warnings { li { b { (warning.rule) } ": " (warning.message) "." } } }
            }
        }
    }
}

fn snaps(assessment: &Assessment) -> Markup {
    let transient = assessment.prepared.structure.transient_s;
    let mut hardest: Vec<&Snap> = assessment
        .snaps
        .iter()
        .filter(|snap| snap.counts() && snap.t_s >= transient)
        .collect();
    hardest.sort_by(|a, b| b.effective_speed_m_s.total_cmp(&a.effective_speed_m_s));
    let all = hardest.len();
    hardest.truncate(LISTED);
    hardest.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    let horizon = assessment.horizon_s();
    html! {
        @if hardest.is_empty() {
            p { "No line snaps at 1 cm/s or more after the start." }
        } @else {
            h3 { "The hardest " (hardest.len()) " of " (all) " snaps that are judged" }
            div.wide { table {
                thead { tr {
                    th { "t" br; "s" } th { "line" } th { "speed" br; "m/s" } th { "impulse" br; "kN s" } th { "energy lost" br; "kJ" }
                    th { "effective mass" br; "t" } th { "spring" br; "kN" } th { "first instant" br; "kN" } th { "peak" br; "kN" } th { "utilisation" } th {}
                } }
                tbody { @for snap in &hardest { tr {
                    td { (format!("{:.2}", snap.t_s)) } td { (snap.line + 1) } td { (format!("{:.3}", snap.speed_m_s)) }
                    td { (format!("{:.1}", snap.impulse_n_s / 1e3)) } td { (format!("{:.2}", snap.energy_lost_j / 1e3)) }
                    td { (format!("{:.0}", snap.effective_mass_kg / 1e3)) } td { (maybe_kilo(snap.energy_peak_n)) }
                    td { (maybe_kilo(snap.front_n)) } td { (maybe_kilo(snap.peak_n)) }
                    td { (snap.utilisation.map_or("not known".to_owned(), |u| format!("{u:.2}"))) }
                    td {
                        @if snap.is_jolt { "passed on to a taut line " }
                        @if horizon.is_some_and(|horizon| snap.t_s > horizon) { "past the horizon" }
                    }
                } } }
            } }
        }
    }
}

fn inputs_of(structure: &Structure) -> Markup {
    let (body, site) = (&structure.body, &structure.site);
    let place = |[x, z]: [f64; 2]| format!("({x}, {z})");
    let shape = match body.outline {
        Outline::Circle => format!("circle, {} m in diameter", body.width_m),
        Outline::Rectangle => format!(
            "rectangle, {} m wide and {} m high",
            body.width_m, body.height_m
        ),
    };
    let mut rows = vec![
        ("Body", shape),
        ("Mass", format!("{} kg", body.mass_kg)),
        (
            "Displaced volume",
            format!("{} m³", body.displaced_volume_m3),
        ),
        (
            "Added mass",
            format!(
                "{:.0} kg (C_a = {:.3})",
                body.added_mass_kg,
                structure.added_mass_coefficient()
            ),
        ),
        (
            "Moment of inertia",
            format!("{:.0} kg m²", body.moment_of_inertia_kg_m2),
        ),
        ("Drag and damping", resistance(structure)),
        (
            "Drawn with the centre at",
            format!("{} m", place(body.position_m)),
        ),
        (
            "Depth, density, gravity",
            format!(
                "{} m, {} kg/m³, {} m/s²",
                site.depth_m, site.water_density_kg_m3, site.gravity_m_s2
            ),
        ),
        ("Water", water(structure)),
        (
            "Coefficient of restitution",
            structure.restitution.to_string(),
        ),
        (
            "Time computed",
            format!(
                "{:.0} s, of which the first {:.0} s are not judged",
                structure.duration_s, structure.transient_s
            ),
        ),
    ];
    if let Some(start) = structure.start_m {
        rows.push(("Begins at rest at", format!("{} m", place(start))));
    }
    for (number, line) in (1..).zip(&structure.lines) {
        let own = |label: &str, value: Option<f64>, unit: &str, scale: f64| {
            value.map_or(format!("{label} not known"), |value| {
                format!("{label} {:.1} {unit}", value / scale)
            })
        };
        rows.push((
            "Line",
            format!(
                "{number}: {}anchor {} m, fairlead {} m, length {} m; {}, {}, {}",
                if line.name.is_empty() {
                    String::new()
                } else {
                    format!("{}; ", line.name)
                },
                place(line.anchor_m),
                place(line.fairlead_m),
                line.length_m,
                own("EA", line.stiffness_n, "MN", 1e6),
                own("mass", line.mass_per_length_kg_m, "kg/m", 1.0),
                own("breaking load", line.breaking_load_n, "kN", 1e3),
            ),
        ));
    }
    html! {
        section {
            h2 { "Inputs" }
            (picture_of_rows(&rows))
        }
    }
}

fn picture_of_rows(rows: &[(&str, String)]) -> Markup {
    html! { table.pairs { tbody { @for (label, value) in rows { tr { th scope="row" { (label) } td { (value) } } } } } }
}

fn water(structure: &Structure) -> String {
    match structure.water {
        Water::Still => "still".to_owned(),
        Water::Wave(wave) => format!(
            "regular wave, H = {} m, T = {} s",
            wave.height_m, wave.period_s
        ),
        Water::Sea(sea) => format!(
            "irregular sea, {}, Hs = {} m, Tp = {} s, {} components, seed {}",
            sea.shape.words(),
            sea.significant_height_m,
            sea.peak_period_s,
            sea.components,
            sea.seed
        ),
    }
}

fn units(assessment: &Assessment) -> Markup {
    let prepared = &assessment.prepared;
    let (scales, groups) = (&prepared.model.scales, &prepared.model.groups);
    let mut rows = vec![
        (
            "Length L",
            format!(
                "{:.4} m, half the distance of the outermost anchors",
                scales.length_m
            ),
        ),
        (
            "Mass M",
            format!("{:.0} kg, added mass included", scales.mass_kg),
        ),
        (
            "Force F",
            format!("{:.1} kN, the net buoyancy", scales.force_n / 1e3),
        ),
        ("Time T", format!("{:.4} s = √(M L/F)", scales.time_s)),
        (
            "Centre",
            format!(
                "x = {:.4} m, z = {:.4} m, where the body rests",
                scales.origin_m[0] + 0.0,
                scales.origin_m[1]
            ),
        ),
        (
            "r/L",
            groups
                .r
                .iter()
                .map(|r| format!("{r:.4}"))
                .collect::<Vec<_>>()
                .join(", "),
        ),
        ("a, b", format!("{:.4}, {:.4}", groups.a, groups.b)),
        ("I", format!("{:.5}", groups.inertia)),
    ];
    if let Some([f_o, nu, omega]) = groups.wave {
        rows.push(("f_o, ν, Ω", format!("{f_o:.4}, {nu:.4}, {omega:.4}")));
    }
    if let ([only], Water::Wave(_)) = (&prepared.model.waves[..], prepared.structure.water) {
        let wave = &only.wave;
        rows.push(("Wave", format!(
            "k = {:.4} 1/m, λ = {:.1} m, kd = {:.2}; the water at the body accelerates by {:.3} m/s² in x and {:.3} m/s² in z",
            wave.wave_number_1_m, wave.length_m(), wave.wave_number_1_m * prepared.structure.site.depth_m,
            wave.a_x_m_s2, wave.a_z_m_s2,
        )));
    }
    html! {
        section {
            h2 { "In the units of the computation" }
            (picture_of_rows(&rows))
        }
    }
}

/// What the water does to a body that moves through it.
fn resistance(structure: &Structure) -> String {
    let body = &structure.body;
    let parts = [
        ("C_d A =", body.drag_area_m2, "m²"),
        ("linear", body.linear_damping_n_s_m, "N s/m"),
        ("turning", body.turning_damping_n_m_s, "N m s"),
    ];
    let given: Vec<String> = parts
        .into_iter()
        .filter(|(_, value, _)| *value > 0.0)
        .map(|(name, value, unit)| format!("{name} {value} {unit}"))
        .collect();
    if given.is_empty() {
        "none".to_owned()
    } else {
        given.join(", ")
    }
}

fn assumptions(structure: &Structure) -> Markup {
    let drag = if resistance(structure) == "none" {
        "neither drag nor damping"
    } else {
        "drag or damping only as given above, and none"
    };
    html! {
        section {
            h2 { "Assumptions" }
            ul {
                li { "The motion is in the plane of the waves; the body is rigid and submerged." }
                li { "Lines are inextensible and massless until they snap. A snap takes no time; the body loses part of its closing speed \
                      by the coefficient of restitution." }
                li { "Linear waves. The force is that of Froude and Krylov with added mass, ρV(1 + C" sub { "a" } ") times the acceleration \
                      the water would have at the place of rest: it depends on time alone, not on where the body has moved, and there is " (drag) " by waves that the body makes." }
                li { "An inextensible line gives an impulse, never a force. The snap tension is therefore estimated: as a spring, \
                      T" sub { "0" } " + u √(k m); for the first instant, u √(EA μ); and for the peak as the sum of both with the line's own \
                      mass added to m, or the spring alone where the line's mass is not known. u is the speed that the line has to stop, the \
                      closing speed where one line snaps by itself, m the mass, T" sub { "0" } " its tension at rest, k = EA/length, μ its mass per \
                      length." }
                li { "Properties of lines by type and diameter are typical values (Orcina, OrcaFlex documentation, pages Chain and \
                      Rope/wire), not those of a product." }
            }
        }
    }
}
