//! The kinds of runs: one case with its neighbours, many records of a sea, other waves, both models
//! of a line.

pub(crate) mod assess;
pub(crate) mod design;
pub(crate) mod elastic_comparison;
pub(crate) mod elastic_outcome;
pub(crate) mod further;
pub(crate) mod gumbel;
pub(crate) mod motion;
pub(crate) mod neighbours;
pub(crate) mod outcome;
pub(crate) mod quantile;
pub(crate) mod scan;
pub(crate) mod seas;
pub(crate) mod three_hours;
pub(crate) mod variations;
