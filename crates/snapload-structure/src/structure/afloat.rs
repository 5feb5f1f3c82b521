//! The table `[float]`: the coefficients of a floating body, with the memory of the waves it makes.

use super::{BodySi, Outline, Site};
use crate::text_layout::decimals;
use nalgebra::Vector3;
use snapload::{CaseError, Entries, Fields, FromValue};
use snapload_hydro::{
    FirstColumn, FitOptions, Format, Given, GivenMemory, GivenSource, HydroError, Reading, Report,
    Request, SectionBody, Shape, Water, Weight, files_of, read,
};
use std::path::{Path, PathBuf};

/// The largest relative difference of the file's displaced mass and the case's volume.
const SAME_VOLUME: f64 = 0.01;
/// The largest distance in x of the body by the file from that of the case, as a part of its width.
const SAME_PLACE: f64 = 0.01;
/// A circle counts as half immersed if its centre is within this part of its width of the still
/// water.
const HALF_IMMERSED: f64 = 0.01;
/// The message for a key that names a file in a case that has no folder for files.
pub const NO_FILES_HERE: &str = "nothing in a case that is read without the files beside it; \
                                  without this key a body floats by textbook values of its section";
/// The name that is shown if there is no file.
const SECTION: &str = "textbook values of its section";

/// The forces of the water on a floating body, about the body's centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Afloat {
    /// Coefficients, memory, and results without lines. Its warnings are also those of the case.
    pub report: Report,
    /// The body's weight, stiffness and damping.
    pub body: snapload_hydro::Body,
    /// A constant moment, counter-clockwise \[N m\].
    pub constant_moment_n_m: f64,
}

impl Afloat {
    /// The constant loads on the body at its mean position, besides those of water and lines: in
    /// surge, heave and pitch, which is clockwise \[N, N m\].
    pub(crate) fn steady(&self) -> Vector3<f64> {
        self.body.constant_force - Vector3::new(0.0, 0.0, self.constant_moment_n_m)
    }

    /// Reads the coefficients from files next to a case file and fits their memory; without a
    /// folder the case may not name files.
    ///
    /// # Errors
    /// A [`CaseError`] that says what is wrong with the file or missing in it.
    pub(super) fn read(
        entries: &Entries,
        folder: Option<&Path>,
        site: &Site,
        body: &BodySi,
    ) -> Result<Self, CaseError> {
        let fields = entries.table("float", 0);
        let own = entries.table("body", 0);
        let [file, memory] = [
            path(fields, "file", folder)?,
            path(fields, "memory", folder)?,
        ];
        if let Some(value) = own.given("added_mass") {
            let allowed = "nothing beside [float], whose file has the added mass";
            return Err(own.refuse("added_mass", value, allowed));
        }
        let mut reading = coefficients(entries, file.as_deref(), site, body)?;
        let bad = |error: HydroError| refused(fields, &error);
        // A memory without a reference point has that of the file.
        let memory = read_memory(fields, memory.as_deref())?.map(|memory| GivenMemory {
            reference_m: memory.reference_m.or(Some(reading.hydro.reference_m)),
            ..memory
        });
        reading.hydro = reading.hydro.about(body.position_m);
        let inertia = own.get("moment_of_inertia")?;
        let without = reading.hydro.hydrostatics.inertia.is_none();
        let uniform = without.then_some(body.moment_of_inertia_kg_m2);
        let request = Request {
            weight: Weight {
                mass_kg: Some(body.mass_kg),
                centre_m: fields.get("centre_of_gravity")?,
                inertia_kg_m2: inertia.or(uniform),
            },
            damping: fields.get("damping")?.unwrap_or_default(),
            fit: FitOptions {
                pairs: fields.get::<u64>("pairs")?.and_then(|n| n.try_into().ok()),
            },
            memory,
            ..Request::default()
        };
        let file: Option<String> = fields.get("file")?;
        let name = file.as_deref().unwrap_or(SECTION);
        let report = Report::new(name, reading, &request).map_err(bad)?;
        let floating = report.floating.clone().map_err(bad)?;
        Ok(Self {
            body: floating.body,
            report,
            constant_moment_n_m: fields.need("constant_moment")?,
        })
    }

    /// Whether the body makes waves, which damp its motion; one without a file does not.
    pub(crate) fn makes_waves(&self) -> bool {
        !self.report.fit.memory.terms.is_empty()
    }
}

/// The path of the file that a key names, if it names one.
fn path(
    fields: Fields<'_>,
    key: &str,
    folder: Option<&Path>,
) -> Result<Option<PathBuf>, CaseError> {
    let Some(name) = fields.get::<String>(key)? else {
        return Ok(None);
    };
    match folder {
        Some(folder) => Ok(Some(folder.join(name))),
        None => Err(fields.refuse(key, format!("{name:?}"), NO_FILES_HERE)),
    }
}

/// The files that a case in this folder is computed from, besides its own.
#[must_use]
pub fn files_beside(entries: &Entries, folder: &Path) -> Vec<PathBuf> {
    let fields = entries.table("float", 0);
    let [file, memory] = ["file", "memory"].map(|key| path(fields, key, Some(folder)));
    // A name that is refused names no file.
    let file = file.ok().flatten().map(|file| files_of(&file));
    let memory = memory.ok().flatten();
    file.into_iter().flatten().chain(memory).collect()
}

/// The coefficients of a file, or of the textbook if there is none.
fn coefficients(
    entries: &Entries,
    file: Option<&Path>,
    site: &Site,
    body: &BodySi,
) -> Result<Reading, CaseError> {
    let fields = entries.table("float", 0);
    let Some(file) = file else {
        return section(fields, site, body);
    };
    let reading = read(file, &given(fields, site, body)?);
    let mut reading = reading.map_err(|error| refused(fields, &error))?;
    same_volume(entries.table("body", 0), site, body, &mut reading)?;
    same_place(body, &reading)?;
    Ok(reading)
}

/// The error of coefficients that do not fit this body.
fn refused(fields: Fields<'_>, error: &HydroError) -> CaseError {
    if let HydroError::OnlyForWamit { key, format, .. } = error
        && let Some(value) = fields.given(key)
    {
        let allowed = format!("nothing for a file of {format}; only files of WAMIT need it");
        return fields.refuse(key, value, allowed);
    }
    let given = fields.given("file");
    let shown = given.map_or("(left out)".to_owned(), ToString::to_string);
    let allowed = format!("coefficients of this body in this water; {error}");
    fields.refuse("file", shown, allowed)
}

/// The keys that only have a meaning with a file.
const KEYS_OF_A_FILE: [&str; 8] = [
    "deep_water",
    "pairs",
    "memory",
    "reference",
    "file_centre_of_gravity",
    "unit_length",
    "first_column",
    "name",
];

/// The textbook's coefficients of a body whose outline is its section, if no file is named.
fn section(fields: Fields<'_>, site: &Site, body: &BodySi) -> Result<Reading, CaseError> {
    for key in KEYS_OF_A_FILE {
        if let Some(value) = fields.given(key) {
            let allowed = "nothing without float.file, as textbook values of a section do not \
                           depend on it";
            return Err(fields.refuse(key, value, allowed));
        }
    }
    let [x, z] = body.position_m;
    let draft_m = 0.5 * body.height_m - z;
    let refuse = |allowed: String| {
        fields
            .refuse("file", "(left out)", allowed)
            .with_hint("give float.file, the coefficients from a panel code")
    };
    let shape = match body.outline {
        Outline::Rectangle => Shape::Rectangle,
        Outline::Circle if z.abs() > HALF_IMMERSED * body.width_m => {
            let allowed = "a file, as textbook values of a circle are for one with its centre in the \
                           still water";
            return Err(refuse(allowed.to_owned()));
        }
        Outline::Circle => Shape::Ellipse,
    };
    let of_section = SectionBody {
        shape,
        half_width_m: 0.5 * body.width_m,
        draft_m,
        length_m: 0.0,
        x_m: x,
        centre_of_gravity_m: body.position_m,
    };
    let water = Water {
        density_kg_m3: site.water_density_kg_m3,
        gravity_m_s2: site.gravity_m_s2,
        depth_m: site.depth_m,
    };
    let of_section = of_section.displacing(body.displaced_volume_m3);
    of_section
        .reading(water)
        .map_err(|error| refuse(format!("a file for such a body; {error}")))
}

/// The values of the case that are given to the reader of the file.
fn given(fields: Fields<'_>, site: &Site, body: &BodySi) -> Result<Given, CaseError> {
    let deep = fields.get("deep_water")?.unwrap_or(false);
    let unit_length_m: Option<f64> = fields.get("unit_length")?;
    // The files of WAMIT, which alone need a unit of length, have no volume of their own.
    let displaced_mass_kg = site.water_density_kg_m3 * body.displaced_volume_m3;
    Ok(Given {
        density_kg_m3: Some(site.water_density_kg_m3),
        gravity_m_s2: Some(site.gravity_m_s2),
        depth_m: Some(if deep { f64::INFINITY } else { site.depth_m }),
        reference_m: fields.get("reference")?,
        centre_of_gravity_m: fields.get("file_centre_of_gravity")?,
        displaced_mass_kg: unit_length_m.map(|_| displaced_mass_kg),
        unit_length_m,
        first_column: fields
            .given("first_column")
            .and_then(|word| FirstColumn::from_word(&String::from_value(word)?)),
        body: fields.get("name")?,
        source: GivenSource::Case,
    })
}

/// Adds the case's displaced volume to coefficients whose file has none, and refuses a different
/// one.
fn same_volume(
    own: Fields<'_>,
    site: &Site,
    body: &BodySi,
    reading: &mut Reading,
) -> Result<(), CaseError> {
    let case = site.water_density_kg_m3 * body.displaced_volume_m3;
    let file = *reading
        .hydro
        .hydrostatics
        .displaced_mass_kg
        .get_or_insert(case);
    if (file / case - 1.0).abs() <= SAME_VOLUME {
        return Ok(());
    }
    let volume = file / site.water_density_kg_m3;
    let allowed = format!("the {volume:.3} m^3 that the body of the file displaces, to 1 %");
    Err(own.refuse("displaced_volume", body.displaced_volume_m3, allowed))
}

/// Refuses a file that has the body elsewhere in x than the case, in which the lines are. The
/// outline of the case is symmetric, so that its centre is above or below that of the file's
/// buoyancy, or of its waterplane, C35 = −C33 x, if the file does not have the former. That of a file
/// of WAMIT follows from a centre of gravity that is given, and says nothing of the hull.
fn same_place(body: &BodySi, reading: &Reading) -> Result<(), CaseError> {
    let hydro = &reading.hydro;
    let statics = &hydro.hydrostatics;
    let of_buoyancy = statics.centre_of_buoyancy_x_m;
    let of_buoyancy = of_buoyancy.filter(|_| reading.format != Format::Wamit);
    let of_waterplane = || {
        let stiffness = statics.stiffness.as_ref()?;
        Some(hydro.reference_m[0] - stiffness[(1, 2)] / stiffness[(1, 1)])
    };
    let [x, z] = body.position_m;
    let Some(file_x) = of_buoyancy.or_else(of_waterplane) else {
        return Ok(());
    };
    // A file without a waterplane is refused for that elsewhere.
    if !file_x.is_finite() || (file_x - x).abs() <= SAME_PLACE * body.width_m {
        return Ok(());
    }
    let allowed = format!(
        "x = {}, where the file has the body, to 1 % of its width, as the x of the file are \
         those of the case",
        decimals(&file_x, 3)
    );
    let error = CaseError::value("body.position", format!("[{x}, {z}]"), allowed);
    Err(error.with_hint(format!(
        "move all places of the case by {} m in x, or compute the file with the body elsewhere",
        decimals(&(file_x - x), 3)
    )))
}

/// The memory that a file of JSON holds, if there is one.
fn read_memory(fields: Fields<'_>, file: Option<&Path>) -> Result<Option<GivenMemory>, CaseError> {
    let Some(file) = file else {
        return Ok(None);
    };
    let refuse = |allowed: String| {
        let shown = fields
            .given("memory")
            .map_or(String::new(), ToString::to_string);
        fields.refuse("memory", shown, allowed)
    };
    let text = std::fs::read_to_string(file)
        .map_err(|error| refuse(format!("a file that can be read; {error}")))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let memory = serde_json::from_str(text).map_err(|error| {
        refuse(format!(
            "a memory as snapload hydro --json writes it; {error}"
        ))
    })?;
    Ok(Some(memory))
}
