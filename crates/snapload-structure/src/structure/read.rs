//! Reads a structure from the keys of a case.

use crate::catalogue::{GRADES, Section, TYPES, is_chain, section};
use crate::schema::STRUCTURE;
use crate::structure::check::check;
use crate::structure::design::{read_design, read_project};
use crate::structure::{
    AddedMass, AddedMassDefaults, Afloat, BodySi, IrregularSea, LineSi, Outline, Site,
    SpectrumShape, Structure, THREE_HOURS_S, Water, Wave,
};
use snapload::{CaseError, Entries, Fields, MAX_CABLES};
use std::path::Path;
use std::sync::Arc;

/// The number of periods of a regular wave that are computed by default.
const PERIODS: f64 = 100.0;
/// The number of periods of the transient by default.
const TRANSIENT: f64 = 10.0;
/// Time that is computed in still water by default \[s\].
const STILL_S: f64 = 60.0;

impl Water {
    /// Whether there are waves; those of no height are still water.
    pub(crate) fn has_waves(self) -> bool {
        match self {
            Self::Still => false,
            Self::Wave(wave) => wave.height_m > 0.0,
            Self::Sea(sea) => sea.significant_height_m > 0.0,
        }
    }

    /// The transient unless one is given: some periods of the waves, at most half of the duration
    /// \[s\].
    pub(crate) fn usual_transient_s(self, duration_s: f64) -> f64 {
        let transient_s = match self {
            Self::Wave(wave) if self.has_waves() => TRANSIENT * wave.period_s,
            Self::Sea(sea) if self.has_waves() => TRANSIENT * sea.peak_period_s,
            _ => 0.0,
        };
        transient_s.min(duration_s / 2.0)
    }
}

impl Structure {
    /// Reads a case file; `name` is its name in errors.
    ///
    /// # Errors
    /// A [`CaseError`] that names the line, the key, its value and what is allowed.
    pub fn parse(name: &str, text: &str) -> Result<Self, CaseError> {
        Self::from_entries(&Entries::parse(&STRUCTURE, name, text)?)
    }

    /// Reads the keys that a case gives, which may not name files: no file is read.
    ///
    /// # Errors
    /// A [`CaseError`] that names the key, its value and what is allowed.
    pub fn from_entries(entries: &Entries) -> Result<Self, CaseError> {
        read(entries, None).map_err(|error| entries.locate(error))
    }

    /// The same, with files that the case names in this folder.
    ///
    /// # Errors
    /// As above, and if a file can not be read or used.
    pub fn from_entries_beside(entries: &Entries, folder: &Path) -> Result<Self, CaseError> {
        read(entries, Some(folder)).map_err(|error| entries.locate(error))
    }
}

/// Reads and checks a structure; without a folder the case may not name files.
fn read(entries: &Entries, folder: Option<&Path>) -> Result<Structure, CaseError> {
    let site = read_site(entries.table("site", 0))?;
    let floats = entries.count("float") > 0;
    let mut body = read_body(entries.table("body", 0), &site, floats)?;
    let afloat = match floats {
        true => Some(Afloat::read(entries, folder, &site, &body)?),
        false => None,
    };
    if let Some(afloat) = &afloat {
        body.weigh(afloat);
    }
    let count = entries.count("line");
    if !(1..=MAX_CABLES).contains(&count) {
        let allowed = format!("1 to {MAX_CABLES} of them");
        let hint = "write [[line]] once for each line, and below it anchor, fairlead and length";
        return Err(
            CaseError::value("[[line]]", format!("({count} given)"), allowed).with_hint(hint),
        );
    }
    let lines = (0..count)
        .map(|index| read_line(entries.table("line", index)))
        .collect::<Result<Vec<_>, _>>()?;
    let (water, heading) = read_water(entries)?;
    let run = entries.table("run", 0);
    let duration = match water {
        Water::Still => STILL_S,
        Water::Wave(wave) => PERIODS * wave.period_s,
        Water::Sea(_) => THREE_HOURS_S,
    };
    let duration_s = run.get("duration")?.unwrap_or(duration);
    let given: Option<f64> = run.get("transient")?;
    if let Some(transient) = given.filter(|transient| *transient >= duration_s) {
        let allowed = format!("less than the {duration_s} s that are computed");
        return Err(run
            .refuse("transient", transient, allowed)
            .with_hint("make run.duration longer, or transient shorter"));
    }
    let structure = Structure {
        project: read_project(entries)?,
        body,
        lines,
        site,
        afloat: afloat.map(Arc::new),
        water,
        heading,
        restitution: run.need("restitution")?,
        duration_s,
        transient_s: given.unwrap_or_else(|| water.usual_transient_s(duration_s)),
        transient_is_given: given.is_some(),
        start_m: run.get("start")?,
        max_snaps: run.need("max_snaps")?,
        design: read_design(entries)?,
    };
    check(&structure)?;
    Ok(structure)
}

fn read_site(fields: Fields<'_>) -> Result<Site, CaseError> {
    Ok(Site {
        depth_m: fields.need("depth")?,
        water_density_kg_m3: fields.need("water_density")?,
        current_m_s: fields.need("current")?,
        gravity_m_s2: fields.need("gravity")?,
    })
}

fn read_body(fields: Fields<'_>, site: &Site, floats: bool) -> Result<BodySi, CaseError> {
    let mass: f64 = fields.need("mass")?;
    let volume: f64 = fields.need("displaced_volume")?;
    let width: f64 = fields.need("width")?;
    let outline = match fields.get::<String>("shape")?.as_deref() {
        Some("rectangle") => Outline::Rectangle,
        _ => Outline::Circle,
    };
    let given_height: Option<f64> = fields.get("height")?;
    let (height, inertia) = match outline {
        Outline::Circle => {
            if let Some(height) = given_height.filter(|height| *height != width) {
                let allowed = format!("the width, {width}, for a circle");
                return Err(fields
                    .refuse("height", height, allowed)
                    .with_hint("leave height out, or set shape = \"rectangle\""));
            }
            (width, mass * width * width / 8.0)
        }
        Outline::Rectangle => {
            let allowed = "a value, which a rectangle needs";
            let left_out = || fields.refuse("height", "(left out)", allowed);
            let height: f64 = given_height.ok_or_else(left_out)?;
            (height, mass * (width * width + height * height) / 12.0)
        }
    };
    let given_inertia: Option<f64> = fields.get("moment_of_inertia")?;
    let size = [width, height];
    let added_mass = match floats {
        true => AddedMass::given([0.0; 3]),
        false => read_added_mass(fields, site, outline, (size, volume), given_inertia)?,
    };
    Ok(BodySi {
        mass_kg: mass,
        added_mass,
        outline,
        width_m: width,
        height_m: height,
        displaced_volume_m3: volume,
        moment_of_inertia_kg_m2: given_inertia.unwrap_or(inertia),
        drag_area_m2: fields.need("drag_area")?,
        linear_damping_n_s_m: fields.need("linear_damping")?,
        turning_damping_n_m_s: fields.need("turning_damping")?,
        constant_force_n: fields.get("constant_force")?.unwrap_or_default(),
        position_m: fields.need("position")?,
    })
}

/// The added mass: three numbers are used as given, a single one is for both axes. With a single
/// one a given moment of inertia includes the water's; if none is given, the water's is the
/// textbook's, as is all of it if the added mass is left out.
fn read_added_mass(
    fields: Fields<'_>,
    site: &Site,
    outline: Outline,
    (size, volume): ([f64; 2], f64),
    inertia: Option<f64>,
) -> Result<AddedMass, CaseError> {
    if let Some(numbers) = fields.get::<[f64; 3]>("added_mass")? {
        return Ok(AddedMass::given(numbers));
    }
    let one: Option<f64> = fields.get("added_mass")?;
    if let (Some(one), Some(_)) = (one, inertia) {
        return Ok(AddedMass::given([one, one, 0.0]));
    }
    let density = site.water_density_kg_m3;
    let length = volume / outline.area_m2(size);
    let textbook = AddedMass::of_textbook(outline, size, length, [density, density * volume]);
    let textbook = textbook.map_err(|error| {
        let allowed = format!("[surge, heave, pitch], as the textbook has none: {error}");
        let shown = one.map_or("(left out)".to_owned(), |one| one.to_string());
        fields.refuse("added_mass", shown, allowed)
    })?;
    Ok(match one {
        Some(one) => AddedMass {
            by_default: AddedMassDefaults::Rotation,
            ..AddedMass::given([one, one, textbook.pitch_kg_m2])
        },
        None => textbook,
    })
}

fn read_line(fields: Fields<'_>) -> Result<LineSi, CaseError> {
    let length: f64 = fields.need("length")?;
    let (name, catalogued) = read_section(fields)?.unwrap_or_default();
    let stiffness = fields.get::<f64>("stiffness")?;
    let rate = fields.get::<f64>("spring_rate")?;
    if stiffness.is_some() && rate.is_some() {
        return Err(fields.refuse("spring_rate", "(given)", "one of stiffness and spring_rate"));
    }
    let own = stiffness.or(rate.map(|rate| rate * length));
    Ok(LineSi {
        anchor_m: fields.need("anchor")?,
        fairlead_m: fields.need("fairlead")?,
        length_m: length,
        name,
        stiffness_n: own.or(catalogued.map(|section| section.stiffness_n)),
        mass_per_length_kg_m: fields
            .get("mass_per_length")?
            .or(catalogued.map(|section| section.mass_per_length_kg_m)),
        breaking_load_n: fields
            .get("breaking_load")?
            .or(catalogued.map(|section| section.breaking_load_n)),
    })
}

/// The name of a line of a type and a diameter, and its section; none if neither is given.
fn read_section(fields: Fields<'_>) -> Result<Option<(String, Option<Section>)>, CaseError> {
    let kind = fields.get::<String>("type")?;
    let diameter = fields.get::<f64>("diameter")?;
    let grade = fields.get::<String>("grade")?;
    let left_out = |key, allowed: &str| Err(fields.refuse(key, "(left out)", allowed));
    let (kind, diameter) = match (kind, diameter) {
        (None, None) => return Ok(None),
        (None, Some(_)) => {
            let types = TYPES.join("\" or \"");
            return left_out("type", &format!("\"{types}\", as diameter is given"));
        }
        (Some(_), None) => {
            return left_out("diameter", "the diameter of the line, as its type is given");
        }
        (Some(kind), Some(diameter)) => (kind, diameter),
    };
    let is_chain = is_chain(&kind);
    if grade.is_some() && !is_chain {
        return Err(fields.refuse("grade", "(given)", "no grade, as the line is not a chain"));
    }
    let section = section(&kind, diameter, grade.as_deref());
    let grade = match is_chain {
        true => format!(" {}", grade.as_deref().unwrap_or(GRADES[0])),
        false => String::new(),
    };
    Ok(Some((
        format!("{kind}{grade}, {} mm", millimetres(diameter)),
        section,
    )))
}

/// Rounded to a tenth.
fn millimetres(metres: f64) -> f64 {
    (metres * 1e4).round() / 10.0
}

fn read_water(entries: &Entries) -> Result<(Water, f64), CaseError> {
    let heading = |fields: Fields<'_>| -> Result<f64, CaseError> {
        let against = fields.get::<String>("direction")?.as_deref() == Some("-x");
        Ok(if against { -1.0 } else { 1.0 })
    };
    match (entries.count("wave") > 0, entries.count("sea") > 0) {
        (true, true) => {
            let allowed = "one of [wave] and [sea]";
            Err(CaseError::value("[sea]", "(beside [wave])", allowed)
                .with_hint("remove one of them"))
        }
        (false, false) => Ok((Water::Still, 1.0)),
        (true, false) => {
            let fields = entries.table("wave", 0);
            let wave = Wave {
                height_m: fields.need("height")?,
                period_s: fields.need("period")?,
            };
            Ok((Water::Wave(wave), heading(fields)?))
        }
        (false, true) => {
            let fields = entries.table("sea", 0);
            let shape = match fields.get::<String>("spectrum")?.as_deref() {
                Some("pierson-moskowitz") => SpectrumShape::PiersonMoskowitz,
                _ => SpectrumShape::Jonswap(fields.need("gamma")?),
            };
            let sea = IrregularSea {
                shape,
                significant_height_m: fields.need("hs")?,
                peak_period_s: fields.need("tp")?,
                seed: fields.need("seed")?,
                components: usize::try_from(fields.need::<u64>("components")?)
                    .unwrap_or(usize::MAX),
            };
            Ok((Water::Sea(sea), heading(fields)?))
        }
    }
}
