//! The engine as a Python module, `snapload._engine`: plain functions and classes over the library
//! crates. What makes it pleasant to use is the typed Python around it, in `python/snapload`.

mod case;
mod certify;
mod command;
mod critical;
mod errors;
mod hydro;
mod interrupt;
mod long_run;
mod options;
mod orbit;
mod pool;
mod question;
mod run;
mod schema;
mod structure;
mod study;
mod system;
mod table;

use pyo3::prelude::*;

/// The engine of snapload.
#[pymodule]
mod _engine {
    use super::*;

    #[pymodule_export]
    use super::case::Case;
    #[pymodule_export]
    use super::certify::certify;
    #[pymodule_export]
    use super::command::{command, reproduce};
    #[pymodule_export]
    use super::critical::{critical_force, critical_force_of_ensemble, critical_force_over};
    #[pymodule_export]
    use super::hydro::hydro;
    #[pymodule_export]
    use super::long_run::{basins_of_attraction, diagram, erosion, safe_basin, section};
    #[pymodule_export]
    use super::options::whole;
    #[pymodule_export]
    use super::orbit::{Branch, Orbit, continuation, find_orbits, orbit, orbit_of_system};
    #[pymodule_export]
    use super::question::answer;
    #[pymodule_export]
    use super::run::{Run, ensemble, run, run_alone};
    #[pymodule_export]
    use super::schema::{columns, keys, named_case, named_cases, quantities, stops};
    #[pymodule_export]
    use super::structure::{Assessment, Elastic, Structure};
    #[pymodule_export]
    use super::study::{
        Store, Study, check_place, evenly, identity, merge, range_values, read_column, threads_for,
    };
    #[pymodule_export]
    use super::system::{System, run_system, sweep_systems};
    #[pymodule_export]
    use super::table::Table;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("MAX_CABLES", snapload::MAX_CABLES)?;
        module.add("ATTRACTOR_PERIODS", snapload_orbits::ATTRACTOR_PERIODS)
    }
}
