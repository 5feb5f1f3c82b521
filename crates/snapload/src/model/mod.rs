//! The mechanical system: a body, its cables, the forces, and the rules that stop a run.

pub(crate) mod body;
pub(crate) mod cable;
pub(crate) mod contact_law;
pub(crate) mod drag;
pub(crate) mod floating;
pub(crate) mod floating_units;
pub(crate) mod forcing;
pub(crate) mod mass;
pub(crate) mod quantity;
pub(crate) mod rules;
pub(crate) mod state;
pub(crate) mod surroundings;
pub(crate) mod system;
pub(crate) mod taut_set;
