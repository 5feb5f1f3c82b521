//! Capytaine's datasets: time goes as e^{−iωt}, the incident wave is η = Re e^{i(kx cos β − ωt)}.
//!
//! Source: the documentation of Capytaine, sections "Conventions" and "Export".

use super::dataset::Dataset;
use super::plane::{IN_PLANE, Plane};
use super::table::{Row, Table};
use super::{Format, Given, agreed, agreed_point, agreed_water, within};
use crate::coefficients::{Hydrodynamics, Hydrostatics};
use crate::error::HydroError;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::PI;

/// The names of the frequency dimension in different versions of Capytaine.
const FREQUENCIES: [&str; 5] = ["omega", "freq", "period", "wavenumber", "wavelength"];
/// The dimension of values that a file with several bodies has for each of them.
const BODY: &str = "body";
const ROW: &str = "influenced_dof";
const COLUMN: &str = "radiating_dof";
const WAVES: &str = "wave_direction";
/// Where the crest of the waves is at t = 0, if not at x = 0. Datasets of Capytaine do not have it.
const CREST: &str = "crest_x";

/// The coefficients of a dataset as Capytaine's `assemble_dataset` makes it, with complex values
/// separated (`export_dataset`, `separate_complex_values`).
///
/// # Errors
/// A [`HydroError`] if something is missing, has another layout, or is not a number.
pub fn from_dataset(dataset: &Dataset, given: &Given) -> Result<Hydrodynamics, HydroError> {
    given.refuse_those_of_wamit(Format::Capytaine)?;
    refuse_speed(dataset)?;
    let body = chosen_body(dataset.words(ROW)?, given)?;
    let dataset = &values_of(dataset, body.as_deref())?.with_dimension(WAVES);
    let (plane, rows) = freedoms(dataset, ROW, body.as_deref())?;
    let (_, columns) = freedoms(dataset, COLUMN, body.as_deref())?;
    let dim = frequency_dimension(dataset)?;
    let omega = frequencies(dataset, &dim)?;
    let numbers = ["rho", "g", "water_depth"].map(|name| dataset.scalar(name));
    let [density, gravity, depth] = numbers;
    let water = agreed_water([density?, gravity?, depth?], given)?;
    let matrices = |name: &str| -> Result<Vec<Matrix3<f64>>, HydroError> {
        let values = dataset.arranged(name, &[&dim, ROW, COLUMN])?;
        let (n, m) = (names(dataset, ROW)?, names(dataset, COLUMN)?);
        if values.len() != omega.len() * n * m {
            let found = format!("{} values", values.len());
            let expected = "one for each frequency, force and motion is expected";
            return Err(HydroError::layout(name, found, expected));
        }
        let of = |block: &[f64]| picked(block, m, &rows, &columns, plane);
        Ok(values.chunks_exact(n * m).map(of).collect())
    };
    let added_mass = matrices("added_mass")?;
    let damping = matrices("radiation_damping")?;
    let (directions, forces) = excitation(dataset, &dim, omega.len(), plane, &rows)?;
    let row = |(index, omega): (usize, &f64)| Row {
        omega: *omega,
        added_mass: added_mass[index],
        damping: damping[index],
        excitation: forces.iter().map(|force| force[index]).collect(),
    };
    let hydrostatics = hydrostatics(dataset, given, plane, &rows, &columns)?;
    let reference_m = point(dataset, "rotation_center", plane)?;
    let table = Table {
        rows: omega.iter().enumerate().map(row).collect(),
        directions,
        water,
        reference_m: reference(reference_m, given)?,
        crest_m: within(CREST, dataset.scalar(CREST)?.unwrap_or(0.0), -1e6..=1e6)?,
        hydrostatics,
    };
    table.into_hydrodynamics()
}

fn refuse_speed(dataset: &Dataset) -> Result<(), HydroError> {
    match dataset.scalar("forward_speed")? {
        Some(speed) if speed != 0.0 => Err(HydroError::value(
            "forward_speed",
            speed,
            "only bodies without forward speed can be simulated",
        )),
        _ => Ok(()),
    }
}

/// The reference point of the file, or the given one.
fn reference(file: Option<[f64; 2]>, given: &Given) -> Result<[f64; 2], HydroError> {
    let what = ["the reference point's x", "the reference point's z"];
    let point = agreed_point(what, file, (given.reference_m, given.source))?;
    point.ok_or_else(|| {
        HydroError::missing(
            "the reference point (rotation_center)",
            "the file does not say about which point its pitch turns; give the reference point",
        )
    })
}

fn names(dataset: &Dataset, dim: &str) -> Result<usize, HydroError> {
    Ok(dataset.words(dim)?.len())
}

/// The directions β of the waves \[rad\].
fn waves(dataset: &Dataset) -> Result<Vec<f64>, HydroError> {
    dataset.arranged(WAVES, &[WAVES])
}

/// The indices in the file of surge, heave and pitch, or of sway, heave and roll: the latter where
/// it lacks one of the former, or no waves along x.
fn freedoms(
    dataset: &Dataset,
    dim: &str,
    body: Option<&str>,
) -> Result<(Plane, [usize; 3]), HydroError> {
    let words = dataset.words(dim)?;
    let place = |freedom: &str| {
        words
            .iter()
            .position(|word| match (word.split_once("__"), body) {
                (Some((name, of)), Some(body)) => name == body && of == freedom,
                (None, None) => word == freedom,
                _ => false,
            })
    };
    let mut planes = [Plane::X, Plane::Y];
    let betas = waves(dataset)?;
    let has_waves = |plane: Plane| betas.iter().any(|beta| plane.direction(*beta).is_some());
    if has_waves(Plane::Y) && !has_waves(Plane::X) {
        planes.reverse();
    }
    for plane in planes {
        if let [Some(a), Some(b), Some(c)] = plane.freedoms().map(place) {
            return Ok((plane, [a, b, c]));
        }
    }
    let lacks: Vec<&str> = Plane::X
        .freedoms()
        .into_iter()
        .filter(|freedom| place(freedom).is_none())
        .collect();
    let advice = format!(
        "{dim} has {}; Surge, Heave and Pitch are required, or Sway, Heave and Roll",
        words.join(", ")
    );
    Err(HydroError::missing(
        format!("the freedom {}", lacks.join(", ")),
        advice,
    ))
}

/// With several bodies, degrees of freedom are called `name__Heave`.
fn chosen_body(words: &[String], given: &Given) -> Result<Option<String>, HydroError> {
    let mut bodies: Vec<&str> = words
        .iter()
        .filter_map(|word| Some(word.split_once("__")?.0))
        .collect();
    bodies.dedup();
    match (bodies.as_slice(), &given.body) {
        ([], None) => Ok(None),
        ([], Some(body)) => {
            let advice = "the file has one body, without a name; leave the name out";
            Err(HydroError::missing(format!("the body {body}"), advice))
        }
        (bodies, Some(wanted)) if bodies.contains(&wanted.as_str()) => Ok(Some(wanted.clone())),
        ([one], None) => Ok(Some((*one).to_owned())),
        (bodies, wanted) => {
            let what = match wanted {
                Some(body) => format!("the body {body}"),
                None => "the choice of a body".to_owned(),
            };
            let advice = format!("the file has {}; name one of them", bodies.join(", "));
            Err(HydroError::missing(what, advice))
        }
    }
}

/// The dataset with the values of one body where it has some for each body: masses, centres and
/// rotation centres.
fn values_of(dataset: &Dataset, body: Option<&str>) -> Result<Dataset, HydroError> {
    let (Some(body), true) = (body, dataset.has(BODY)) else {
        return Ok(dataset.clone());
    };
    let bodies = dataset.words(BODY)?;
    let index = bodies.iter().position(|name| name == body).ok_or_else(|| {
        let found = format!("its values are those of {}", bodies.join(", "));
        HydroError::layout(BODY, found, format!("those of {body} are expected"))
    })?;
    Ok(dataset.at(BODY, index))
}

/// The dimension of the frequencies.
fn frequency_dimension(dataset: &Dataset) -> Result<String, HydroError> {
    let variable = dataset.variable("added_mass")?;
    let found = variable
        .dims
        .iter()
        .find(|dim| FREQUENCIES.contains(&dim.as_str()));
    found.cloned().ok_or_else(|| {
        let found = format!("its dimensions are {}", variable.dims.join(", "));
        let expected = format!("one of {} is expected", FREQUENCIES.join(", "));
        HydroError::layout("added_mass", found, expected)
    })
}

/// ω along that dimension, whose variable may have another name.
fn frequencies(dataset: &Dataset, dim: &str) -> Result<Vec<f64>, HydroError> {
    type Known = (&'static str, fn(f64) -> f64);
    let known: [Known; 3] = [
        ("omega", |omega| omega),
        ("period", |period| 2.0 * PI / period),
        ("freq", |frequency| 2.0 * PI * frequency),
    ];
    for (name, omega) in known {
        if dataset.has(name) {
            let values = dataset.arranged(name, &[dim])?;
            return Ok(values.into_iter().map(omega).collect());
        }
    }
    Err(HydroError::missing(
        "omega",
        format!("neither omega nor period nor freq is given along {dim}"),
    ))
}

/// Three rows and columns of a block with `width` columns.
fn picked(
    block: &[f64],
    width: usize,
    rows: &[usize; 3],
    columns: &[usize; 3],
    plane: Plane,
) -> Matrix3<f64> {
    let sign = plane.signs();
    Matrix3::from_fn(|i, j| sign[i] * sign[j] * block[rows[i] * width + columns[j]])
}

type Forces = Vec<Vec<Vector3<Complex<f64>>>>;

/// The directions in the plane, and the forces of each at all frequencies.
fn excitation(
    dataset: &Dataset,
    dim: &str,
    count: usize,
    plane: Plane,
    rows: &[usize; 3],
) -> Result<(Vec<f64>, Forces), HydroError> {
    let betas = waves(dataset)?;
    if let Some(beta) = betas.iter().find(|beta| beta.abs() > 2.0 * PI + IN_PLANE) {
        let expected = "radians are expected, at most 2π; is it in degrees?";
        return Err(HydroError::value(WAVES, *beta, expected));
    }
    let parts: Vec<&str> = match dataset.has("diffraction_force") {
        true => vec!["diffraction_force", "Froude_Krylov_force"],
        false => vec!["excitation_force"],
    };
    let mut sum: Vec<Complex<f64>> = Vec::new();
    for name in parts {
        let values = complex(dataset, name, dim)?;
        match sum.is_empty() {
            true => sum = values,
            false => sum
                .iter_mut()
                .zip(values)
                .for_each(|(sum, value)| *sum += value),
        }
    }
    let freedoms = names(dataset, ROW)?;
    if sum.len() != count * betas.len() * freedoms {
        let found = format!("{} values", sum.len());
        let expected = "one for each frequency, direction and freedom is expected";
        return Err(HydroError::layout("the wave force", found, expected));
    }
    let sign = plane.signs();
    let (mut directions, mut forces): (Vec<f64>, Forces) = (Vec::new(), Vec::new());
    for (index, beta) in betas.iter().enumerate() {
        let Some(direction) = plane.direction(*beta) else {
            continue;
        };
        if directions.contains(&direction) {
            continue;
        }
        let force = |step: usize| {
            let from = (step * betas.len() + index) * freedoms;
            Vector3::from_fn(|i, _| sum[from + rows[i]] * sign[i])
        };
        directions.push(direction);
        forces.push((0..count).map(force).collect());
    }
    if directions.is_empty() {
        let in_plane = match plane {
            Plane::X => "0 or π",
            Plane::Y => "π/2 or −π/2",
        };
        let found = format!("{betas:?} rad");
        let expected = format!("waves in the plane of motion are required, {in_plane} within 1e-6");
        return Err(HydroError::layout(WAVES, found, expected));
    }
    Ok((directions, forces))
}

/// A complex variable, whose dimension `complex` has the labels re and im.
fn complex(dataset: &Dataset, name: &str, dim: &str) -> Result<Vec<Complex<f64>>, HydroError> {
    let advice = "a dimension `complex` with the labels re and im is expected, as Capytaine's \
                  separate_complex_values makes it";
    let variable = dataset.variable(name)?;
    if !variable.dims.iter().any(|name| name == "complex") && !variable.is_other() {
        let found = format!("its dimensions are {}", variable.dims.join(", "));
        return Err(HydroError::layout(name, found, advice));
    }
    let order = ["complex", dim, WAVES, ROW];
    let values = dataset.arranged(name, &order)?;
    let labels = dataset.words("complex")?;
    let place = |label: &str| {
        let found = labels.iter().position(|word| word == label);
        found.ok_or_else(|| {
            let found = format!("its labels are {}", labels.join(", "));
            HydroError::layout("complex", found, "re and im are expected")
        })
    };
    let (re, im) = (place("re")?, place("im")?);
    if labels.len() != 2 || values.len() % 2 != 0 {
        let found = format!("{} labels", labels.len());
        return Err(HydroError::layout(
            "complex",
            found,
            "re and im are expected",
        ));
    }
    let half = values.len() / 2;
    let of = |k: usize| Complex::new(values[re * half + k], values[im * half + k]);
    Ok((0..half).map(of).collect())
}

/// A point (x, z) or (y, z), if the file has it and its values are numbers.
fn point(dataset: &Dataset, name: &str, plane: Plane) -> Result<Option<[f64; 2]>, HydroError> {
    if !dataset.has(name) {
        return Ok(None);
    }
    let values = dataset.arranged(name, &["space_coordinate"])?;
    let labels = match dataset.has("space_coordinate") {
        true => dataset.words("space_coordinate")?.to_vec(),
        false => ["x", "y", "z"].map(str::to_owned).to_vec(),
    };
    let of = |label: &str| {
        let at = labels.iter().position(|word| word == label)?;
        values.get(at).copied().filter(|value| value.is_finite())
    };
    let axes = [["x", "y"][plane.axis()], "z"];
    Ok(match axes.map(of) {
        [Some(x), Some(z)] => Some([x, z]),
        _ => None,
    })
}

fn hydrostatics(
    dataset: &Dataset,
    given: &Given,
    plane: Plane,
    rows: &[usize; 3],
    columns: &[usize; 3],
) -> Result<Hydrostatics, HydroError> {
    let matrix = |name: &str| -> Result<Option<Matrix3<f64>>, HydroError> {
        if !dataset.has(name) {
            return Ok(None);
        }
        let values = dataset.arranged(name, &[ROW, COLUMN])?;
        let width = names(dataset, COLUMN)?;
        if values.len() != width * names(dataset, ROW)? {
            let found = format!("{} values", values.len());
            return Err(HydroError::layout(
                name,
                found,
                "one for each pair of degrees of freedom is expected",
            ));
        }
        let matrix = picked(&values, width, rows, columns, plane);
        Ok(matrix
            .iter()
            .all(|value| value.is_finite())
            .then_some(matrix))
    };
    let displaced = dataset.scalar("disp_mass")?.filter(|mass| mass.is_finite());
    let what = "the displaced mass in kg";
    let centre = [
        "the x of the centre of gravity that the file's stiffness assumes",
        "the z of the centre of gravity that the file's stiffness assumes",
    ];
    let own_centre = point(dataset, "center_of_mass", plane)?;
    Ok(Hydrostatics {
        stiffness: matrix("hydrostatic_stiffness")?,
        displaced_mass_kg: agreed(
            what,
            displaced,
            (given.displaced_mass_kg, given.source),
            1e-3,
        )?,
        centre_of_mass_m: agreed_point(
            centre,
            own_centre,
            (given.centre_of_gravity_m, given.source),
        )?,
        centre_of_buoyancy_x_m: point(dataset, "center_of_buoyancy", plane)?.map(|[x, _]| x),
        inertia: matrix("inertia_matrix")?,
    })
}
