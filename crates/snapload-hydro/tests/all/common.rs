//! Files and tables that several tests use.

use snapload_hydro::{Dataset, Given, Hydrodynamics, Reading, Values, Variable, WamitText, read};
use std::path::{Path, PathBuf};

/// A file beside the tests.
pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

pub fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).expect(name)
}

pub fn reading(name: &str) -> Reading {
    read(&path(name), &Given::default()).expect(name)
}

pub fn hydro(name: &str) -> Hydrodynamics {
    reading(name).hydro
}

/// The dataset of a file, to be altered.
pub fn dataset(name: &str) -> Spoilt {
    Spoilt(Dataset::from_netcdf(&bytes(name)).expect(name))
}

/// A dataset in which single things are changed.
pub struct Spoilt(pub Dataset);

impl Spoilt {
    pub fn with(self, name: &str, change: impl FnOnce(&mut Variable)) -> Self {
        let mut variable = self.0.variable(name).expect(name).clone();
        change(&mut variable);
        let kept = |(known, _): &(String, Variable)| known != name;
        let mut all: Vec<(String, Variable)> = self.all().into_iter().filter(kept).collect();
        all.push((name.to_owned(), variable));
        Self(Dataset::new(all).expect("a dataset"))
    }

    pub fn without(self, names: &[&str]) -> Self {
        let all = self.all().into_iter();
        let kept = all.filter(|(known, _)| !names.contains(&known.as_str()));
        Self(Dataset::new(kept).expect("a dataset"))
    }

    pub fn numbers(self, name: &str, change: impl Fn(usize, f64) -> f64) -> Self {
        self.with(name, |variable| {
            let Values::Numbers(numbers) = &mut variable.values else {
                unreachable!("{name} holds no numbers");
            };
            for (index, number) in numbers.iter_mut().enumerate() {
                *number = change(index, *number);
            }
        })
    }

    pub fn all(&self) -> Vec<(String, Variable)> {
        let variables = self.0.variables();
        variables
            .map(|(name, variable)| (name.clone(), variable.clone()))
            .collect()
    }
}

/// The pontoon's files in the format of WAMIT.
pub fn wamit_files() -> WamitText {
    let text = |end: &str| String::from_utf8(bytes(&format!("pontoon-deep.{end}"))).expect("text");
    WamitText {
        radiation: text("1"),
        excitation: text("3"),
        hydrostatics: Some(text("hst")),
    }
}

/// What those files do not say of the pontoon.
pub fn wamit_given() -> Given {
    Given {
        density_kg_m3: Some(1025.0),
        gravity_m_s2: Some(9.81),
        depth_m: Some(f64::INFINITY),
        reference_m: Some([0.0, 0.0]),
        centre_of_gravity_m: Some([0.0, -0.2]),
        displaced_mass_kg: Some(98_400.0),
        unit_length_m: Some(1.0),
        ..Given::default()
    }
}

/// A table of reference results.
pub fn reference(name: &str) -> serde_json::Value {
    serde_json::from_slice(&bytes(name)).expect(name)
}
