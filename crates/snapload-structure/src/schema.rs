//! The keys of a structure's case: tables, names, units, ranges, defaults and help texts.

use crate::catalogue::{GRADES, TYPES};
use crate::options::PAIRS;
use snapload::DefaultValue::{Count, Derived, Flag, Number, Required, Word};
use snapload::{Heading, Key, Kind, Schema, Table};
use snapload_hydro::FirstColumn;

/// The bounds of lengths \[m\]; the lower ones are below those of the smallest models.
const SHORTEST: f64 = 1e-4;
const LONGEST: f64 = 1e5;
/// The bounds of masses, forces and stiffnesses, in their SI units.
const LIGHTEST: f64 = 1e-6;
const HEAVIEST: f64 = 1e13;

const MASS: Kind = Kind::number(LIGHTEST, HEAVIEST);
const LENGTH: Kind = Kind::number(SHORTEST, LONGEST);
const PLACE: Kind = Kind::Pair(LONGEST);
const FACTOR: Kind = Kind::number(1e-3, 100.0);
const DIRECTION: Kind = Kind::Choice(&["+x", "-x"]);

#[rustfmt::skip] // one row a key
const BODY: &[Key] = &[
    Key::new("mass", "kg", MASS, Required, "mass, ballast included"),
    Key::new("displaced_volume", "m^3", Kind::number(1e-9, 1e9), Required, "volume of water it displaces when submerged"),
    Key::new("added_mass", "kg", Kind::PerFreedom(1e18),
        Derived("of the outline in two-dimensional flow (DNV-RP-C205, table D-1)"),
        "added mass of the water: [surge, heave, pitch], pitch in kg m^2 about the centre, or one number for x and z"),
    Key::new("shape", "", Kind::Choice(&["circle", "rectangle"]), Word("circle"), "its outline in the x-z plane"),
    Key::new("width", "m", LENGTH, Required, "size in x; the diameter of a circle"),
    Key::new("height", "m", LENGTH, Derived("the width; a rectangle needs it"), "size in z; leave it out for a circle"),
    Key::new("moment_of_inertia", "kg m^2", Kind::number(1e-14, 1e18),
        Derived("of a uniform body: mass width^2/8 (circle), mass (width^2 + height^2)/12 (rectangle)"),
        "about the centre; includes that of the water where added_mass is one number; a hollow cylinder has nearly mass width^2/4"),
    Key::new("drag_area", "m^2", Kind::number(0.0, 1e6), Number(0.0),
        "C_d A of the quadratic drag, water_density C_d A |u| u / 2 with the velocity u of the water past the centre"),
    Key::new("linear_damping", "N s/m", Kind::number(0.0, HEAVIEST), Number(0.0), "force on the body per velocity of the water past it"),
    Key::new("turning_damping", "N m s", Kind::number(0.0, 1e18), Number(0.0), "moment on the body per angular velocity"),
    Key::new("constant_force", "N", Kind::Pair(HEAVIEST), Derived("none"),
        "[x, z] of a constant load: mean drift of the waves, wind"),
    Key::new("position", "m", PLACE, Required, "[x, z] of its centre for which the fairleads are given; z is up from the still water"),
];

#[rustfmt::skip] // one row a key
const LINE: &[Key] = &[
    Key::new("anchor", "m", PLACE, Required, "[x, z] of the anchor"),
    Key::new("fairlead", "m", PLACE, Required, "[x, z] where it is attached, with the body at position and upright"),
    Key::new("length", "m", LENGTH, Required, "unstretched length"),
    Key::new("type", "", Kind::Choice(TYPES), Derived("none"),
        "a type of line; with diameter it gives stiffness, mass_per_length and breaking_load"),
    Key::new("diameter", "m", Kind::number(1e-5, 0.4), Derived("none"), "nominal diameter; for a chain that of its bar"),
    Key::new("grade", "", Kind::Choice(GRADES), Derived("R3 for a chain"), "steel grade of a chain"),
    Key::new("stiffness", "N", MASS, Derived("from type and diameter"), "axial stiffness EA"),
    Key::new("spring_rate", "N/m", MASS, Derived("stiffness / length"), "k, in place of the axial stiffness"),
    Key::new("mass_per_length", "kg/m", Kind::number(1e-6, 1e5), Derived("from type and diameter"), "mass per metre in air"),
    Key::new("breaking_load", "N", MASS, Derived("from type and diameter"), "minimum breaking load"),
];

#[rustfmt::skip] // one row a key
const SITE: &[Key] = &[
    Key::new("depth", "m", Kind::positive(12_000.0), Required, "depth of still water; the floor is at z = -depth"),
    Key::new("water_density", "kg/m^3", Kind::number(900.0, 1300.0), Number(1025.0), "density of the water"),
    Key::new("current", "m/s", Kind::number(-10.0, 10.0), Number(0.0),
        "velocity of the water to +x in addition to that of the waves, the same at all depths and times; needs drag"),
    Key::new("gravity", "m/s^2", Kind::number(1.0, 30.0), Number(9.806_65), "acceleration of gravity"),
];

#[rustfmt::skip] // one row a key
const FLOAT: &[Key] = &[
    Key::new("file", "", Kind::Text, Derived("textbook values of the outline's section"),
        "coefficients of a panel code, beside this file: Capytaine's .nc or WAMIT's .1"),
    Key::new("deep_water", "", Kind::Flag, Flag(false), "accept coefficients of deep water although the site is not deep"),
    Key::new("centre_of_gravity", "m", PLACE, Derived("the file's"), "[x, z] of the centre of gravity, from the same origin as body.position; body.moment_of_inertia is about it"),
    Key::new("damping", "N s/m", Kind::Triple(1e18), Derived("none"),
        "[surge, heave, pitch], pitch in N m s: linear damping in addition to that of waves"),
    Key::new("constant_moment", "N m", Kind::number(-1e18, 1e18), Number(0.0),
        "a constant moment, counter-clockwise: of wind on the deck, or of an eccentric load"),
    Key::new("pairs", "1", PAIRS.kind, Derived("as many as 1 % accuracy needs"), "pairs of poles of the memory"),
    Key::new("memory", "", Kind::Text, Derived("fitted"), "a memory that snapload hydro --json wrote, in place of a fit"),
    Key::new("reference", "m", PLACE, Derived("the file's"), "[x, z] about which the file's pitch is, where the file does not give it"),
    Key::new("file_centre_of_gravity", "m", PLACE, Derived("the file's"),
        "[x, z] of the centre of gravity of the file's stiffness, where the file does not give it"),
    Key::new("unit_length", "m", LENGTH, Derived("none"), "WAMIT's unit of length ULEN"),
    Key::new("first_column", "", Kind::Choice(&FirstColumn::WORDS), Word("period"),
        "what the first column of WAMIT's files holds (IPEROUT = 1 to 4)"),
    Key::new("name", "", Kind::Text, Derived("the only one"), "name of the body, where the file has several"),
];

#[rustfmt::skip] // one row a key
const WAVE: &[Key] = &[
    Key::new("height", "m", Kind::number(0.0, 50.0), Required, "from trough to crest").usual(0.0, 6.0),
    Key::new("period", "s", Kind::number(0.5, 60.0), Required, "from crest to crest").usual(2.0, 16.0),
    Key::new("direction", "", DIRECTION, Word("+x"), "direction of travel"),
];

/// The last seed of a sea.
pub(crate) const LAST_SEED: u64 = u32::MAX as u64;

#[rustfmt::skip] // one row a key
const SEA: &[Key] = &[
    Key::new("spectrum", "", Kind::Choice(&["jonswap", "pierson-moskowitz"]), Word("jonswap"), "shape of the spectrum"),
    Key::new("hs", "m", Kind::number(0.0, 30.0), Required, "significant wave height, 4 sqrt(m0)").symbol("H_s").usual(0.0, 6.0),
    Key::new("tp", "s", Kind::number(1.0, 40.0), Required, "peak period").symbol("T_p").usual(2.0, 16.0),
    Key::new("gamma", "1", Kind::number(1.0, 10.0), Number(3.3), "peak enhancement of a JONSWAP spectrum").symbol("γ").usual(1.0, 7.0),
    Key::new("seed", "1", Kind::Count(0, LAST_SEED), Count(1), "of the random frequencies and phases; the same seed gives the same sea"),
    Key::new("components", "1", Kind::Count(10, 1000), Count(200), "number of sinusoids in the sea"),
    Key::new("direction", "", DIRECTION, Word("+x"), "direction of travel"),
];

#[rustfmt::skip] // one row a key
const RUN: &[Key] = &[
    Key::new("restitution", "1", Kind::number(0.0, 1.0), Required,
        "part of the closing speed that a snap returns: 0 if the line absorbs all, 1 if it absorbs nothing").usual(0.0, 1.0),
    Key::new("duration", "s", Kind::positive(1e6), Derived("100 wave periods; three hours of a sea; 60 s in still water"), "simulated time"),
    Key::new("transient", "s", Kind::number(0.0, 1e6), Derived("10 wave periods, or peak periods of a sea, at most half the duration; 0 in still water"),
        "snaps and tensions before this are shown but not judged, as the waves begin at once on a body at rest"),
    Key::new("start", "m", PLACE, Derived("where the body rests in still water"), "[x, z] of the centre at the start, at rest"),
    Key::new("max_snaps", "1", Kind::Count(1, 10_000_000), Count(1_000_000), "the run ends after more snaps than this"),
];

#[rustfmt::skip] // one row a key
const DESIGN: &[Key] = &[
    Key::new("pretension_factor", "1", FACTOR, Derived("no check"), "partial factor on the tension at rest; goes with the next two"),
    Key::new("environment_factor", "1", FACTOR, Derived("no check"), "partial factor on the largest tension minus that at rest"),
    Key::new("strength_factor", "1", FACTOR, Derived("no check"), "characteristic strength over breaking_load"),
    Key::new("least_share", "1", Kind::number(0.0, 1.0), Derived("no check"),
        "the least tension of a line must be above this share of its tension at rest; 0: no line goes slack"),
    Key::new("rest_factor", "1", FACTOR, Derived("no check"),
        "factor on the tension at rest; this factor times that tension must exceed dynamic_factor times (tension at rest minus least tension)"),
    Key::new("dynamic_factor", "1", FACTOR, Derived("no check"), "factor on the tension at rest minus the least tension; goes with rest_factor"),
    Key::new("force_share", "1", FACTOR, Derived("no check"),
        "the vertical force of the waves must be at most this share of the net buoyancy; not for a floating body"),
];

#[rustfmt::skip] // one row a key
const PROJECT: &[Key] = &[
    Key::new("name", "", Kind::Text, Derived("none"), "project to which the structure belongs"),
    Key::new("client", "", Kind::Text, Derived("none"), "client of the note"),
    Key::new("author", "", Kind::Text, Derived("none"), "author of the note"),
    Key::new("date", "", Kind::Text, Derived("none"), "date of the note, such as \"2026-05-04\""),
];

/// The case file of a structure.
#[rustfmt::skip] // one row a table
pub static STRUCTURE: Schema = Schema {
    tables: &[
        Table::new("project", Heading::Optional, "texts at the head of the page; no result depends on them", PROJECT),
        Table::new("body", Heading::One, "the moored body, seen from its side: buoyant and submerged, or afloat with [float]", BODY),
        Table::new("line", Heading::Many, "a mooring line; write [[line]] once for each, 1 to 16 of them", LINE),
        Table::new("site", Heading::One, "the place", SITE),
        Table::new("float", Heading::Optional, "a floating body: its hydrodynamic coefficients, from a panel code or a textbook", FLOAT),
        Table::new("wave", Heading::Optional, "a regular wave; at most one of wave and sea may be given", WAVE),
        Table::new("sea", Heading::Optional, "an irregular, long-crested sea", SEA),
        Table::new("run", Heading::One, "what is computed", RUN),
        Table::new("design", Heading::Optional,
            "checks by your design rule; a check is made where its factors are given, and none of them has a default", DESIGN),
    ],
    example: "wave.height=2",
    form: "tables such as [body], and below each of them one `key = value` per line, such as `mass = 72453`",
};

/// Whether a text looks like the case of a structure, by having one of its tables.
pub fn is_structure(text: &str) -> bool {
    // `body = "point"` is a key of the thesis's case, which has no tables.
    let own = |name: &String| {
        STRUCTURE
            .tables
            .iter()
            .any(|table| table.name == name && name != "run")
    };
    snapload::table_names(text).iter().any(own)
}
