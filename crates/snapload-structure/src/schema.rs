//! The one description of the keys of a structure's case: tables, names, units, ranges, defaults and help
//! texts. The reader, `--set`, the error texts, the listing and the manual's tables derive from it.

use snapload::CaseError;

/// Lengths are at most this \[m\].
const LONGEST: f64 = 1e5;
/// Masses, forces and stiffnesses are at most this, in their SI units.
const HEAVIEST: f64 = 1e13;

/// The type of a key and the range of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A finite number above 0 and at most so large.
    Positive(f64),
    /// A finite number from the first to the second, both allowed.
    Number(f64, f64),
    /// Two numbers `[x, z]`, neither larger in magnitude than this.
    Pair(f64),
    /// A whole number from the first to the second, both allowed.
    Count(u64, u64),
    /// One of some words.
    Choice(&'static [&'static str]),
}

/// What holds where a key is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Need {
    /// It must not be.
    Required,
    /// This number.
    Number(f64),
    /// This whole number.
    Count(u64),
    /// This word.
    Word(&'static str),
    /// What these words say.
    Derived(&'static str),
}

/// One key of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Its SI unit; `1` where it has none, empty for words.
    pub unit: &'static str,
    /// Its type and range.
    pub kind: Kind,
    /// What holds without it.
    pub need: Need,
    /// What it means.
    pub meaning: &'static str,
}

/// One table of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Its name in brackets.
    pub name: &'static str,
    /// Whether there may be several, `[[line]]`.
    pub many: bool,
    /// What it describes.
    pub meaning: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
}

const fn key(
    name: &'static str,
    unit: &'static str,
    kind: Kind,
    need: Need,
    meaning: &'static str,
) -> Key {
    Key {
        name,
        unit,
        kind,
        need,
        meaning,
    }
}

const MASS: Kind = Kind::Positive(HEAVIEST);
const LENGTH: Kind = Kind::Positive(LONGEST);
const PLACE: Kind = Kind::Pair(LONGEST);
const DIRECTION: Kind = Kind::Choice(&["+x", "-x"]);

/// Every table of a case, in the order in which they are listed.
#[rustfmt::skip] // one row a key
pub static TABLES: &[Table] = &[
    Table { name: "body", many: false, meaning: "the moored body: buoyant, submerged, seen from its side", keys: &[
        key("mass", "kg", MASS, Need::Required, "mass, ballast included"),
        key("displaced_volume", "m^3", Kind::Positive(1e9), Need::Required, "volume of water it displaces when submerged"),
        key("added_mass", "kg", Kind::Number(0.0, HEAVIEST),
            Need::Derived("circle: water_density displaced_volume (C_a = 1); a rectangle needs it"),
            "mass of water that moves with it, the same in x and z"),
        key("shape", "", Kind::Choice(&["circle", "rectangle"]), Need::Word("circle"), "its outline in the x-z plane"),
        key("width", "m", LENGTH, Need::Required, "size in x; the diameter of a circle"),
        key("height", "m", LENGTH, Need::Derived("the width; a rectangle needs it"), "size in z; leave it out for a circle"),
        key("moment_of_inertia", "kg m^2", Kind::Positive(1e18),
            Need::Derived("of a uniform body: mass width^2/8 (circle), mass (width^2 + height^2)/12 (rectangle)"),
            "about the centre, the part of the added mass included; a hollow cylinder has nearly mass width^2/4"),
        key("drag_area", "m^2", Kind::Number(0.0, 1e6), Need::Number(0.0),
            "C_d A of the quadratic drag, water_density C_d A |u| u / 2 with the velocity u of the water past the centre"),
        key("linear_damping", "N s/m", Kind::Number(0.0, HEAVIEST), Need::Number(0.0), "force on the body per velocity of the water past it"),
        key("turning_damping", "N m s", Kind::Number(0.0, 1e18), Need::Number(0.0), "moment on the body per angular velocity"),
        key("position", "m", PLACE, Need::Required, "[x, z] of its centre to which the fairleads are drawn; z is up from the still water"),
    ]},
    Table { name: "line", many: true, meaning: "a mooring line; write [[line]] once for each, 1 to 16 of them", keys: &[
        key("anchor", "m", PLACE, Need::Required, "[x, z] of the anchor"),
        key("fairlead", "m", PLACE, Need::Required, "[x, z] where it is made fast, with the body at position and upright"),
        key("length", "m", LENGTH, Need::Required, "unstretched length"),
        key("type", "", Kind::Choice(crate::catalogue::TYPES), Need::Derived("none"),
            "a type of line; with diameter it gives what the four keys below would"),
        key("diameter", "m", Kind::Positive(0.4), Need::Derived("none"), "nominal diameter; of a chain, of its bar"),
        key("grade", "", Kind::Choice(crate::catalogue::GRADES), Need::Derived("R3 for a chain"), "steel grade of a chain"),
        key("stiffness", "N", MASS, Need::Derived("from type and diameter"), "axial stiffness EA"),
        key("spring_rate", "N/m", MASS, Need::Derived("stiffness / length"), "k, in place of the axial stiffness"),
        key("mass_per_length", "kg/m", Kind::Positive(1e5), Need::Derived("from type and diameter"), "mass of a metre of it in air"),
        key("breaking_load", "N", MASS, Need::Derived("from type and diameter"), "minimum breaking load"),
    ]},
    Table { name: "site", many: false, meaning: "the place", keys: &[
        key("depth", "m", Kind::Positive(12_000.0), Need::Required, "depth of still water; the floor is at z = -depth"),
        key("water_density", "kg/m^3", Kind::Number(900.0, 1300.0), Need::Number(1025.0), "density of the water"),
        key("gravity", "m/s^2", Kind::Number(1.0, 30.0), Need::Number(9.806_65), "acceleration of gravity"),
    ]},
    Table { name: "wave", many: false, meaning: "a regular wave; one of wave and sea may be given", keys: &[
        key("height", "m", Kind::Number(0.0, 50.0), Need::Required, "from trough to crest"),
        key("period", "s", Kind::Number(0.5, 60.0), Need::Required, "from crest to crest"),
        key("direction", "", DIRECTION, Need::Word("+x"), "where it goes"),
    ]},
    Table { name: "sea", many: false, meaning: "an irregular, long-crested sea", keys: &[
        key("spectrum", "", Kind::Choice(&["jonswap", "pierson-moskowitz"]), Need::Word("jonswap"), "shape of the spectrum"),
        key("hs", "m", Kind::Number(0.0, 30.0), Need::Required, "significant wave height, 4 sqrt(m0)"),
        key("tp", "s", Kind::Number(1.0, 40.0), Need::Required, "peak period"),
        key("gamma", "1", Kind::Number(1.0, 10.0), Need::Number(3.3), "peak enhancement of a JONSWAP spectrum"),
        key("seed", "1", Kind::Count(0, u32::MAX as u64), Need::Count(1), "of the random phases; the same seed is the same sea"),
        key("components", "1", Kind::Count(10, 1000), Need::Count(200), "sinusoids that the sea is made of"),
        key("direction", "", DIRECTION, Need::Word("+x"), "where it goes"),
    ]},
    Table { name: "run", many: false, meaning: "what is computed", keys: &[
        key("restitution", "1", Kind::Number(0.0, 1.0), Need::Required,
            "part of the closing speed that a snap gives back: 0 a line that absorbs all, 1 one that absorbs nothing"),
        key("duration", "s", Kind::Positive(1e6), Need::Derived("100 wave periods; three hours of a sea"), "time that is computed"),
        key("transient", "s", Kind::Number(0.0, 1e6), Need::Derived("10 wave periods, or peak periods of a sea, at most half the duration; 0 in still water"),
            "snaps before this are shown but not judged, as the waves begin at once on a body at rest"),
        key("start", "m", PLACE, Need::Derived("where the body rests in still water"), "[x, z] of the centre at the start, at rest"),
        key("max_snaps", "1", Kind::Count(1, 10_000_000), Need::Count(1_000_000), "the run ends at more snaps than this"),
    ]},
];

/// The table of a name, or an error with the nearest one.
pub fn table_named(name: &str) -> Result<&'static Table, CaseError> {
    let known: Vec<&'static str> = TABLES.iter().map(|table| table.name).collect();
    TABLES
        .iter()
        .find(|table| table.name == name)
        .ok_or_else(|| {
            let hint = TABLES
                .iter()
                .find(|table| table.keys.iter().any(|key| key.name == name));
            let error = CaseError::unknown_key(name, nearest(name, &known), &known);
            match hint {
                Some(table) => error.with_hint(format!(
                    "{name} is a key of [{}]; write it below that line",
                    table.name
                )),
                None => error,
            }
        })
}

impl Table {
    /// The key of a name, or an error with the nearest one; `path` is how the error calls it.
    pub fn key(&self, path: &str, name: &str) -> Result<&'static Key, CaseError> {
        let keys = table_named(self.name)?.keys;
        let known: Vec<&'static str> = keys.iter().map(|key| key.name).collect();
        keys.iter()
            .find(|key| key.name == name)
            .ok_or_else(|| CaseError::unknown_key(path, nearest(name, &known), &known))
    }
}

impl Key {
    /// The allowed values in words.
    pub fn allowed(&self) -> String {
        let unit = if matches!(self.unit, "" | "1") {
            String::new()
        } else {
            format!(" {}", self.unit)
        };
        match self.kind {
            Kind::Positive(high) => format!("a number above 0 and at most {high}{unit}"),
            Kind::Number(low, high) => format!("a number from {low} to {high}{unit}"),
            Kind::Pair(limit) => format!("two numbers [x, z], each from -{limit} to {limit}{unit}"),
            Kind::Count(low, high) => format!("a whole number from {low} to {high}"),
            Kind::Choice(words) => {
                let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(" or ")
            }
        }
    }

    /// What holds without it, in words.
    pub fn default_words(&self) -> String {
        match self.need {
            Need::Required => "required".to_owned(),
            Need::Number(number) => number.to_string(),
            Need::Count(count) => count.to_string(),
            Need::Word(word) => format!("\"{word}\""),
            Need::Derived(words) => words.to_owned(),
        }
    }
}

/// The name that was probably meant.
fn nearest(name: &str, known: &[&'static str]) -> Option<&'static str> {
    let wanted: String = name.chars().take(40).collect::<String>().to_lowercase();
    known
        .iter()
        .map(|known| {
            (
                strsim::normalized_damerau_levenshtein(&wanted, known),
                *known,
            )
        })
        .filter(|(score, _)| *score > 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}
