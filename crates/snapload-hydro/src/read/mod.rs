//! Reads the files of panel codes into a [`Hydrodynamics`].

mod capytaine;
mod checks;
mod dataset;
mod fortran;
mod nemoh;
mod netcdf;
mod plane;
mod table;
mod wamit;
mod wamit_hydrostatics;
mod wamit_text;

pub use capytaine::from_dataset;
pub use dataset::{Dataset, Values, Variable};
pub use nemoh::from_nemoh;
pub use wamit::{WamitText, from_wamit};
pub use wamit_text::FirstColumn;

use crate::coefficients::Hydrodynamics;
use crate::error::{GivenSource, HydroError, Warning};
use crate::water::Water;
use std::fmt;
use std::path::{Path, PathBuf};

/// The programs whose files are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// netCDF.
    Capytaine,
    /// `.1`, `.3` or `.2`, and `.hst`.
    Wamit,
    /// `RadiationCoefficients.tec` and `ExcitationForce.tec`.
    Nemoh,
    /// No file: textbook values of a section.
    Section,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Capytaine => "Capytaine",
            Self::Wamit => "WAMIT",
            Self::Nemoh => "Nemoh",
            Self::Section => "textbook values of a section",
        })
    }
}

/// Values that are given in addition to the file. Values that the file has, too, must agree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Given {
    /// ρ \[kg/m³\].
    pub density_kg_m3: Option<f64>,
    /// g \[m/s²\].
    pub gravity_m_s2: Option<f64>,
    /// Depth of the water \[m\]; infinite for deep water.
    pub depth_m: Option<f64>,
    /// The reference point O \[m\].
    pub reference_m: Option<[f64; 2]>,
    /// The centre of gravity that the file's stiffness assumes \[m\].
    pub centre_of_gravity_m: Option<[f64; 2]>,
    /// ρV \[kg\].
    pub displaced_mass_kg: Option<f64>,
    /// WAMIT's ULEN \[m\].
    pub unit_length_m: Option<f64>,
    /// What the first column of WAMIT's files holds; by default periods.
    pub first_column: Option<FirstColumn>,
    /// The body, if the file has several.
    pub body: Option<String>,
    /// Where these values are given.
    pub source: GivenSource,
}

impl Given {
    /// Refuses values that would have no effect on a file that is not one of WAMIT.
    fn refuse_those_of_wamit(&self, format: Format) -> Result<(), HydroError> {
        let both = [
            ("unit_length", self.unit_length_m.is_some()),
            ("first_column", self.first_column.is_some()),
        ];
        match both.into_iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(HydroError::OnlyForWamit {
                key,
                format: format.to_string(),
                source_of_given: self.source,
            }),
            None => Ok(()),
        }
    }
}

/// Coefficients that passed the checks, with warnings.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The file's format.
    pub format: Format,
    /// The coefficients.
    pub hydro: Hydrodynamics,
    /// Warnings.
    pub warnings: Vec<Warning>,
}

impl Reading {
    /// Checks coefficients against the conventions of their format.
    ///
    /// # Errors
    /// A [`HydroError`] that says which convention is violated.
    pub fn new(format: Format, hydro: Hydrodynamics) -> Result<Self, HydroError> {
        let warnings = checks::check(format, &hydro)?;
        Ok(Self {
            format,
            hydro,
            warnings,
        })
    }
}

/// Reads the file of a panel code, whose format follows from its name: Capytaine's `.nc`; one of
/// WAMIT's `.1`, `.3`, `.2` and `.hst`, together with the others of the same name; Nemoh's
/// `RadiationCoefficients.tec` or the folder that contains it.
///
/// # Errors
/// A [`HydroError`] if it can not be read or violates a convention.
pub fn read(path: &Path, given: &Given) -> Result<Reading, HydroError> {
    let extension = path.extension().and_then(|end| end.to_str());
    let extension = extension.map(str::to_ascii_lowercase);
    match extension.as_deref() {
        Some("nc" | "nc4" | "netcdf" | "h5") => {
            let dataset = Dataset::from_netcdf(&bytes(path, path)?)?;
            Reading::new(Format::Capytaine, from_dataset(&dataset, given)?)
        }
        Some("1" | "2" | "3" | "hst") => {
            Reading::new(Format::Wamit, from_wamit(&wamit_text(path)?, given)?)
        }
        _ if path.is_dir() || extension.as_deref() == Some("tec") => {
            let [radiation, excitation] = nemoh_files(path).map(|file| text(path, &file));
            let hydro = from_nemoh(&radiation?, &excitation?, given)?;
            Reading::new(Format::Nemoh, hydro)
        }
        _ => Err(HydroError::Unreadable(
            "it is none of these: Capytaine's .nc; WAMIT's .1, .3, .2, .hst; Nemoh's .tec or its folder"
                .to_owned(),
        )),
    }
}

/// The files that [`read`] reads for a path; some of them may not be there.
#[must_use]
pub fn files_of(path: &Path) -> Vec<PathBuf> {
    let extension = path.extension().and_then(|end| end.to_str());
    match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("1" | "2" | "3" | "hst") => wamit_files(path).to_vec(),
        ending if path.is_dir() || ending == Some("tec") => nemoh_files(path).to_vec(),
        _ => vec![path.to_owned()],
    }
}

/// The files of WAMIT that belong to one of them: that one, and the others of its name, as `.1`,
/// wave forces, and `.hst`. Of `.3` and `.2`, which both have the wave forces, it is the one that
/// was asked for, else `.3`.
fn wamit_files(asked: &Path) -> [PathBuf; 3] {
    let is_asked = |ending: &str| {
        asked
            .extension()
            .is_some_and(|own| own.eq_ignore_ascii_case(ending))
    };
    let with = |ending: &str| {
        if is_asked(ending) {
            return asked.to_owned();
        }
        let beside =
            [ending.to_owned(), ending.to_uppercase()].map(|end| asked.with_extension(end));
        let there = beside.iter().find(|path| path.exists());
        there.unwrap_or(&beside[0]).clone()
    };
    let (third, hst) = (with("3"), with("hst"));
    let takes_third = !is_asked("2") && (is_asked("3") || third.exists());
    [with("1"), if takes_third { third } else { with("2") }, hst]
}

/// Their text; only the hydrostatics may be missing, unless they were asked for.
fn wamit_text(asked: &Path) -> Result<WamitText, HydroError> {
    let [radiation, excitation, hst] = wamit_files(asked);
    Ok(WamitText {
        radiation: text(asked, &radiation)?,
        excitation: text(asked, &excitation)?,
        hydrostatics: match hst == asked || hst.exists() {
            true => Some(text(asked, &hst)?),
            false => None,
        },
    })
}

/// The files of Nemoh that belong to one of them, or that are in a folder.
fn nemoh_files(path: &Path) -> [PathBuf; 2] {
    let folder = if path.is_dir() {
        nemoh_folder(path)
    } else {
        path.parent().unwrap_or(Path::new("")).to_owned()
    };
    ["RadiationCoefficients.tec", "ExcitationForce.tec"].map(|name| folder.join(name))
}

/// Nemoh writes its results into a folder `results` or `Results`.
fn nemoh_folder(path: &Path) -> PathBuf {
    let below = ["results", "Results"].map(|name| path.join(name));
    let found = below.into_iter().find(|folder| folder.is_dir());
    found.unwrap_or_else(|| path.to_owned())
}

/// The bytes of a file that belongs to the one that was `asked` for.
fn bytes(asked: &Path, path: &Path) -> Result<Vec<u8>, HydroError> {
    std::fs::read(path).map_err(|error| {
        let mut message = error.to_string();
        message.truncate(message.find(" (os error").unwrap_or(message.len()));
        unreadable(asked, path, &message)
    })
}

/// The text of a file that belongs to the one that was `asked` for.
fn text(asked: &Path, path: &Path) -> Result<String, HydroError> {
    let text = String::from_utf8(bytes(asked, path)?);
    let text = text.map_err(|_| unreadable(asked, path, "it is not text"))?;
    // Some editors begin a file with a mark of its encoding.
    Ok(text.trim_start_matches('\u{feff}').to_owned())
}

/// The message names the file only if it is not the requested one.
fn unreadable(asked: &Path, path: &Path, message: &str) -> HydroError {
    let name = path.file_name().filter(|_| path != asked);
    HydroError::Unreadable(match name {
        Some(name) => format!("{}: {message}", name.display()),
        None => message.to_owned(),
    })
}

/// The value of the file or the given one, if there is only one of them; two have to agree up to a
/// part.
fn agreed(
    what: &'static str,
    file: Option<f64>,
    (given, source_of_given): (Option<f64>, GivenSource),
    part: f64,
) -> Result<Option<f64>, HydroError> {
    if let (Some(file), Some(given)) = (file, given) {
        // A finite depth never agrees with an infinite one.
        let near = (file - given).abs() <= part * given.abs().min(file.abs());
        if file != given && !near {
            return Err(HydroError::Disagreement {
                what,
                file,
                given,
                source_of_given,
            });
        }
    }
    Ok(file.or(given))
}

/// The same of a point, whose coordinates have to agree to a millimetre.
fn agreed_point(
    what: [&'static str; 2],
    file: Option<[f64; 2]>,
    (given, source_of_given): (Option<[f64; 2]>, GivenSource),
) -> Result<Option<[f64; 2]>, HydroError> {
    if let (Some(file), Some(given)) = (file, given) {
        for (axis, what) in what.into_iter().enumerate() {
            if (file[axis] - given[axis]).abs() > 1e-3 {
                return Err(HydroError::Disagreement {
                    what,
                    file: file[axis],
                    given: given[axis],
                    source_of_given,
                });
            }
        }
    }
    Ok(file.or(given))
}

/// The water by the file and the given values, checked.
fn agreed_water(file: [Option<f64>; 3], given: &Given) -> Result<Water, HydroError> {
    let [density, gravity, depth] = file;
    let need = |what: &'static str, value: Option<f64>| {
        let advice = "the file does not have it; give it";
        value.ok_or_else(|| HydroError::missing(what, advice))
    };
    let what = "the density of the water in kg/m³";
    let density = agreed(what, density, (given.density_kg_m3, given.source), 1e-3)?;
    let density_kg_m3 = within(what, need(what, density)?, 500.0..=2000.0)?;
    let what = "gravity in m/s²";
    let gravity = agreed(what, gravity, (given.gravity_m_s2, given.source), 1e-3)?;
    let gravity_m_s2 = within(what, need(what, gravity)?, 0.1..=100.0)?;
    let what = "the depth of the water in m";
    let depth = agreed(what, depth, (given.depth_m, given.source), 1e-2)?;
    let depth_m = within(what, need(what, depth)?, 1e-3..=f64::INFINITY)?;
    Ok(Water {
        density_kg_m3,
        gravity_m_s2,
        depth_m,
    })
}

/// The value, if it lies in a range.
fn within(what: &str, value: f64, range: std::ops::RangeInclusive<f64>) -> Result<f64, HydroError> {
    if range.contains(&value) {
        return Ok(value);
    }
    let (low, high) = (range.start(), range.end());
    let expected = format!("{low} to {high} is allowed; is it in other units?");
    Err(HydroError::value(what, value, expected))
}
