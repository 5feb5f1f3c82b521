//! The common options of the commands for coefficients of floating bodies: the file, and values
//! that it lacks.
use crate::case_input::read_text;
use crate::failure::Failure;
use crate::option_values::whole_number;
use snapload_hydro::{
    FirstColumn, FitOptions, Given, GivenMemory, GivenSource, HydroError, Line, Report, Request,
    Weight, read,
};
use snapload_structure::PAIRS;
use std::path::{Path, PathBuf};

/// The file of a panel code, the body's weight, and the memory.
#[derive(clap::Args)]
pub(crate) struct HydroArgs {
    /// Capytaine file (.nc), WAMIT file (.1, .2, .3 or .hst) with the others in the same folder, or
    /// Nemoh folder of results (for its memory alone, as it has no hydrostatic stiffness)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Density of the water in kg/m³, if the file does not give it
    #[arg(long, value_name = "NUMBER", help_heading = "The file")]
    density: Option<f64>,
    /// Gravitational acceleration in m/s²
    #[arg(long, value_name = "NUMBER", help_heading = "The file")]
    gravity: Option<f64>,
    /// Depth of the water in m, or inf
    #[arg(long, value_name = "NUMBER", help_heading = "The file")]
    depth: Option<f64>,
    /// Reference point: the centre of pitch, relative to which the motion is measured; needed where
    /// the file does not give it, and has to agree where it does
    #[arg(long, value_name = "X,Z", value_parser = pair, allow_hyphen_values = true, help_heading = "The file")]
    reference: Option<[f64; 2]>,
    /// Length unit ULEN of WAMIT in m
    #[arg(long, value_name = "NUMBER", help_heading = "The file")]
    unit_length: Option<f64>,
    /// Quantity in the first column of the WAMIT files, as IPEROUT has it: period (1),
    /// frequency (2), infinite-depth-wavenumber ω² ULEN/g (3), or wavenumber k ULEN at
    /// the depth (4); by default period
    #[arg(long, value_name = "WHAT", value_parser = FirstColumn::WORDS, help_heading = "The file")]
    first_column: Option<String>,
    /// Mass of the displaced water in kg, if the file does not give it
    #[arg(long, value_name = "NUMBER", help_heading = "The file")]
    displaced_mass: Option<f64>,
    /// Centre of gravity used for the stiffness in the file, if the file does not give it; where the file
    /// has no centre of buoyancy (WAMIT without 4,6, Nemoh) that is taken to be below it
    #[arg(long, value_name = "X,Z", value_parser = pair, allow_hyphen_values = true, help_heading = "The file")]
    file_centre: Option<[f64; 2]>,
    /// Name of the body, if the file has several
    #[arg(long, value_name = "NAME", help_heading = "The file")]
    body: Option<String>,
    /// Mass of the body in kg; by default the mass of the displaced water
    #[arg(long, value_name = "NUMBER", help_heading = "The body")]
    mass: Option<f64>,
    /// Centre of gravity of the body; by default that of the file
    #[arg(long, value_name = "X,Z", value_parser = pair, allow_hyphen_values = true, help_heading = "The body")]
    centre: Option<[f64; 2]>,
    /// Moment of inertia about the centre of gravity in kg m²; by default that of the file, with a
    /// warning if --mass differs from the mass of the file
    #[arg(long, value_name = "NUMBER", help_heading = "The body")]
    inertia: Option<f64>,
    /// Linear damping of surge, heave and pitch in addition to wave
    /// radiation, in N s/m, N s/m, N m s
    #[arg(long, value_name = "B1,B3,B5", value_parser = triple, help_heading = "The body")]
    damping: Option<[f64; 3]>,
    /// Number of pole pairs in the fit of the memory; by default as many as 1 % accuracy needs
    #[arg(long, value_name = "NUMBER", value_parser = whole_number::<usize>(PAIRS), help_heading = "The memory")]
    pairs: Option<usize>,
    /// Read the fitted memory from a file that --json wrote, instead of fitting it
    #[arg(
        long,
        value_name = "FILE.json",
        conflicts_with = "pairs",
        help_heading = "The memory"
    )]
    memory: Option<PathBuf>,
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let parts: Vec<Result<f64, _>> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers: Result<Vec<f64>, _> = parts.into_iter().collect();
    let numbers = numbers
        .ok()
        .and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    numbers.ok_or_else(|| format!("allowed: {N} numbers, {form}"))
}

/// Two numbers.
pub(crate) fn pair(text: &str) -> Result<[f64; 2], String> {
    numbers(text, "x,z")
}

/// Three numbers.
pub(crate) fn triple(text: &str) -> Result<[f64; 3], String> {
    numbers(text, "of surge, heave and pitch")
}

/// A line: its anchor, its fairlead and its length.
pub(crate) fn line(text: &str) -> Result<Line, String> {
    let form = "anchor x, anchor z, fairlead x, fairlead z, length";
    let [ax, az, fx, fz, length_m] = numbers(text, form)?;
    Ok(Line {
        anchor_m: [ax, az],
        fairlead_m: [fx, fz],
        length_m,
    })
}

impl HydroArgs {
    /// The name of the file.
    pub(crate) fn name(&self) -> String {
        self.file.display().to_string()
    }

    /// Reads the file and answers.
    pub(crate) fn report(
        &self,
        lines: Vec<Line>,
        force: Option<[f64; 3]>,
    ) -> Result<Report, Failure> {
        let name = self.name();
        let bad = |error: HydroError| Failure::bad_input(error).with_prefix(&name);
        let given = Given {
            density_kg_m3: self.density,
            gravity_m_s2: self.gravity,
            depth_m: self.depth,
            reference_m: self.reference,
            centre_of_gravity_m: self.file_centre,
            displaced_mass_kg: self.displaced_mass,
            unit_length_m: self.unit_length,
            first_column: self
                .first_column
                .as_deref()
                .and_then(FirstColumn::from_word),
            body: self.body.clone(),
            source: GivenSource::CommandLine,
        };
        let request = Request {
            weight: Weight {
                mass_kg: self.mass,
                centre_m: self.centre,
                inertia_kg_m2: self.inertia,
            },
            damping: self.damping.unwrap_or_default(),
            force: force.unwrap_or_default(),
            lines,
            fit: FitOptions { pairs: self.pairs },
            memory: match &self.memory {
                Some(path) => Some(memory(path)?),
                None => None,
            },
        };
        let reading = read(&self.file, &given).map_err(bad)?;
        Report::new(&name, reading, &request).map_err(bad)
    }
}

fn memory(path: &Path) -> Result<GivenMemory, Failure> {
    let text = read_text(path)?;
    serde_json::from_str(&text).map_err(|error| {
        let words = format!(
            "{}: not a file as --json writes it, with added_mass_inf and memory: {error}",
            path.display()
        );
        Failure::BadInput(words)
    })
}
