//! Moored bodies in SI units: kilograms, metres, newtons and seconds.
//!
//! A case names a body, its lines, the place and the waves; [`Structure`] is that case, checked. [`Model`] is the same
//! in the units of the engine, [`snapload::System`], which computes the motion. How the one follows from the other,
//! with sources, is told in `docs/structures.md`.
//!
//! The picture is the usual one: x to the right, z up from the still water, waves along x. The engine's is upside
//! down; see [`Scales`].

mod catalogue;
mod entries;
mod model;
mod plausible;
mod schema;
mod sea;
mod structure;
mod wave;

pub use catalogue::{Section, section};
pub use entries::{Entries, InputError, Value, is_structure};
pub use model::{Groups, Model, PhasedWave, Scales, force_per_acceleration};
pub use plausible::{Warning, warnings};
pub use schema::{Key, Kind, Need, TABLES, Table, table_named};
pub use sea::{Component, Spectrum, components};
pub use structure::{
    BodySi, IrregularSea, LineSi, Outline, Site, SpectrumShape, Structure, THREE_HOURS_S, Water,
    Wave,
};
pub use wave::{LinearWave, wave_number};
