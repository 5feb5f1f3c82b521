//! Named variables with named dimensions, as in netCDF and in xarray.

use crate::error::HydroError;
use std::collections::BTreeMap;

/// The values of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers, the last dimension fastest.
    Numbers(Vec<f64>),
    /// Strings.
    Words(Vec<String>),
    /// Something else, such as pairs or text of fixed length; in words.
    Other(String),
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// The names of its dimensions, the slowest first.
    pub dims: Vec<String>,
    /// Their lengths.
    pub shape: Vec<usize>,
    /// Its values.
    pub values: Values,
}

/// Variables by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dataset {
    variables: BTreeMap<String, Variable>,
}

impl Dataset {
    /// A dataset of variables by name, as an xarray dataset gives them.
    ///
    /// # Errors
    /// [`HydroError::Layout`] if a variable does not have as many values as its dimensions say.
    pub fn new(
        variables: impl IntoIterator<Item = (String, Variable)>,
    ) -> Result<Self, HydroError> {
        let mut set = Self::default();
        let mut lengths: BTreeMap<String, usize> = BTreeMap::new();
        for (name, variable) in variables {
            let count = match &variable.values {
                Values::Numbers(numbers) => Some(numbers.len()),
                Values::Words(words) => Some(words.len()),
                Values::Other(_) => None,
            };
            let expected = variable
                .shape
                .iter()
                .try_fold(1usize, |product, length| product.checked_mul(*length));
            if variable.dims.len() != variable.shape.len()
                || count.is_some_and(|count| Some(count) != expected)
            {
                let found = format!(
                    "dimensions {:?} of lengths {:?} with {} values",
                    variable.dims,
                    variable.shape,
                    count.unwrap_or(0)
                );
                return Err(HydroError::layout(
                    name,
                    found,
                    "there must be as many values as the product of the lengths of its dimensions",
                ));
            }
            for (dim, length) in variable.dims.iter().zip(&variable.shape) {
                let known = *lengths.entry(dim.clone()).or_insert(*length);
                if known != *length {
                    let found = format!("it has {length} values along {dim}");
                    let expected = format!("other variables have {known}");
                    return Err(HydroError::layout(name, found, expected));
                }
            }
            set.variables.insert(name, variable);
        }
        Ok(set)
    }

    /// The part at one index of a dimension, which the variables along it no longer have.
    #[must_use]
    pub fn at(&self, dim: &str, index: usize) -> Self {
        let cut = |(name, variable): (&String, &Variable)| (name.clone(), variable.at(dim, index));
        Self {
            variables: self.variables.iter().map(cut).collect(),
        }
    }

    /// The dataset with a dimension again of which one place was selected, as by `isel` of xarray:
    /// its variable then is one number, and the others no longer are along it.
    pub(super) fn with_dimension(mut self, dim: &str) -> Self {
        if self
            .variables
            .get(dim)
            .is_some_and(|own| own.dims.is_empty())
        {
            for variable in self.variables.values_mut() {
                variable.dims.insert(0, dim.to_owned());
                variable.shape.insert(0, 1);
            }
        }
        self
    }

    /// All variables with their names.
    pub fn variables(&self) -> impl Iterator<Item = (&String, &Variable)> {
        self.variables.iter()
    }

    /// Whether there is a variable of this name.
    pub fn has(&self, name: &str) -> bool {
        self.variables.contains_key(name)
    }

    /// A variable.
    ///
    /// # Errors
    /// [`HydroError::Missing`] if there is none of this name.
    pub fn variable(&self, name: &str) -> Result<&Variable, HydroError> {
        self.variables.get(name).ok_or_else(|| {
            let names: Vec<&str> = self.variables.keys().map(String::as_str).collect();
            let advice = match names.is_empty() {
                true => "the file is empty".to_owned(),
                false => format!("the file has {}", names.join(", ")),
            };
            HydroError::missing(format!("the variable {name}"), advice)
        })
    }

    /// The strings of a variable.
    ///
    /// # Errors
    /// A [`HydroError`] if there is none of this name, or it holds something else.
    pub fn words(&self, name: &str) -> Result<&[String], HydroError> {
        let variable = self.variable(name)?;
        match &variable.values {
            Values::Words(words) => Ok(words),
            _ => Err(HydroError::layout(
                name,
                "it does not hold strings",
                "names are expected",
            )),
        }
    }

    /// The numbers of a variable, arranged with the dimensions in this order. Its other dimensions
    /// must be of length 1.
    ///
    /// # Errors
    /// A [`HydroError`] if there is none of this name, it does not hold numbers, or it has other
    /// dimensions.
    pub fn arranged(&self, name: &str, dims: &[&str]) -> Result<Vec<f64>, HydroError> {
        let variable = self.variable(name)?;
        let numbers = match &variable.values {
            Values::Numbers(numbers) => numbers,
            Values::Words(_) => {
                return Err(HydroError::layout(
                    name,
                    "it holds strings",
                    "numbers are expected",
                ));
            }
            Values::Other(kind) => {
                let advice = "real numbers are expected, complex ones with a dimension `complex` of \
                              re and im, as Capytaine's separate_complex_values gives them";
                return Err(HydroError::layout(
                    name,
                    format!("its values are {kind}"),
                    advice,
                ));
            }
        };
        let (strides, lengths) = variable.order(name, dims)?;
        let count: usize = lengths.iter().product();
        let place = |index: usize| {
            let mut rest = index;
            let steps = strides.iter().zip(&lengths).rev().map(|(stride, length)| {
                let step = rest % length;
                rest /= length;
                step * stride
            });
            numbers[steps.sum::<usize>()]
        };
        Ok((0..count).map(place).collect())
    }

    /// The one number of a variable, none if there is no such variable.
    ///
    /// # Errors
    /// [`HydroError::Layout`] if it has several.
    pub fn scalar(&self, name: &str) -> Result<Option<f64>, HydroError> {
        if !self.has(name) {
            return Ok(None);
        }
        let numbers = self.arranged(name, &[])?;
        Ok(numbers.first().copied())
    }
}

impl Variable {
    /// The strides and lengths of dimensions in another order than they are stored in.
    fn order(&self, name: &str, dims: &[&str]) -> Result<(Vec<usize>, Vec<usize>), HydroError> {
        let refuse = |found: String| {
            let expected = match dims {
                [] => "one number is expected".to_owned(),
                [dim] => format!("the dimension {dim} is expected"),
                dims => format!("the dimensions {} are expected", dims.join(", ")),
            };
            Err(HydroError::layout(name, found, expected))
        };
        for (dim, length) in self.dims.iter().zip(&self.shape) {
            if !dims.contains(&dim.as_str()) && *length != 1 {
                return refuse(format!(
                    "it has {length} values along {dim}, where one is expected (several depths, \
                     densities or bodies?)"
                ));
            }
        }
        let mut strides = Vec::new();
        let mut lengths = Vec::new();
        for dim in dims {
            let Some(at) = self.dims.iter().position(|name| name == dim) else {
                return refuse(format!("its dimensions are {}", self.dims.join(", ")));
            };
            strides.push(self.shape[at + 1..].iter().product());
            lengths.push(self.shape[at]);
        }
        Ok((strides, lengths))
    }
}

impl Variable {
    /// The part at one index of a dimension; all of it if it does not have that dimension.
    fn at(&self, dim: &str, index: usize) -> Self {
        let Some(place) = self.dims.iter().position(|name| name == dim) else {
            return self.clone();
        };
        let inner: usize = self.shape[place + 1..].iter().product();
        let block = inner * self.shape[place];
        let kept = |k: usize| k % block / inner == index;
        let (mut dims, mut shape) = (self.dims.clone(), self.shape.clone());
        dims.remove(place);
        shape.remove(place);
        let values = match &self.values {
            Values::Numbers(numbers) => Values::Numbers(filtered(numbers, kept)),
            Values::Words(words) => Values::Words(filtered(words, kept)),
            Values::Other(kind) => Values::Other(kind.clone()),
        };
        Self {
            dims,
            shape,
            values,
        }
    }

    /// Whether it holds something that is neither numbers nor strings.
    pub(super) fn is_other(&self) -> bool {
        matches!(self.values, Values::Other(_))
    }
}

/// The values whose places are kept.
fn filtered<T: Clone>(values: &[T], kept: impl Fn(usize) -> bool) -> Vec<T> {
    let all = values.iter().enumerate();
    all.filter(|(place, _)| kept(*place))
        .map(|(_, value)| value.clone())
        .collect()
}
