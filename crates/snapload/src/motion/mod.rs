//! How they move: slack flight, taut motion, events, the law of contact, and the loop around them.

pub(crate) mod active_set;
pub(crate) mod attachment;
pub(crate) mod bounce;
pub(crate) mod bounce_map;
pub(crate) mod cable_series;
pub(crate) mod complementarity;
pub(crate) mod contact;
pub(crate) mod events;
pub(crate) mod extremes;
pub(crate) mod flight;
pub(crate) mod impact;
pub(crate) mod least_norm;
pub(crate) mod limits;
pub(crate) mod outcome;
pub(crate) mod playback;
pub(crate) mod projection;
pub(crate) mod segments;
pub(crate) mod simulation;
pub(crate) mod start;
pub(crate) mod step_map;
pub(crate) mod tangent;
pub(crate) mod taut_series;
pub(crate) mod trajectory;
pub(crate) mod two_cable_flight;
pub(crate) mod two_cables;
pub(crate) mod water_series;
