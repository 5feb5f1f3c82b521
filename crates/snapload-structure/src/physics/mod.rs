//! The physics of a moored structure: waves, forces, rest, and the two models of a line.

pub(crate) mod afloat;
pub(crate) mod elastic;
pub(crate) mod emergence;
pub(crate) mod equilibrium;
pub(crate) mod implausible;
pub(crate) mod mean_drag;
pub(crate) mod model;
pub(crate) mod model_at_rest;
pub(crate) mod periods;
pub(crate) mod rates;
pub(crate) mod sea;
pub(crate) mod sea_records;
pub(crate) mod settling;
pub(crate) mod snap;
pub(crate) mod softness;
pub(crate) mod warning;
pub(crate) mod warnings;
pub(crate) mod waterline;
pub(crate) mod wave;
pub(crate) mod waves_of_tension;
