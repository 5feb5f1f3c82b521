//! Elastic lines: the alternative to the inextensible line (docs/elastic.md).

mod body;
mod law;
mod motion;
mod phase;
mod record;
mod rest;

pub(crate) use law::LEAST_RESTITUTION;
pub(super) use law::undamped;
pub use law::{ElasticLine, damping_ratio, elastic_lines};
pub use motion::run_elastic;
pub(crate) use motion::{Stepping, run_in_steps};
pub use record::{ElasticRun, Pull, Sample};
