//! netCDF4, which is HDF5 with named dimensions.
//!
//! A dimension is a dataset of the attribute CLASS = "DIMENSION_SCALE", whose name is the
//! dimension's; every other dataset has an attribute DIMENSION_LIST with a reference to one of them
//! for each of its axes. Source: *NetCDF-4 File Format*, in the documentation of netCDF-C.
//!
//! Numbers may be packed: value = scale_factor × stored + add_offset, and stored ones that are
//! _FillValue or missing_value are none. Source: *CF Conventions*, sections 2.5.1 and 8.1. Files of
//! the classic model have strings as arrays of letters along a last dimension.

use super::dataset::{Dataset, Values, Variable};
use crate::error::HydroError;
use hdf5_reader::error::Error;
use hdf5_reader::reference::read_object_references;
use hdf5_reader::{ByteOrder, Datatype, Hdf5File, StringSize};
use std::collections::BTreeMap;

/// The most numbers that a variable may hold; the coefficients of one body are a few thousand.
const LARGEST: u64 = 20_000_000;

impl Dataset {
    /// Reads the bytes of a netCDF4 file.
    ///
    /// # Errors
    /// [`HydroError::Unreadable`] if the bytes are not of this format, or are damaged.
    pub fn from_netcdf(bytes: &[u8]) -> Result<Self, HydroError> {
        if bytes.starts_with(b"CDF") {
            let message = "it is netCDF 3; save it as netCDF4, as Capytaine does";
            return Err(HydroError::Unreadable(message.to_owned()));
        }
        variables(bytes).map_err(|error| HydroError::Unreadable(format!("as netCDF4: {error}")))?
    }
}

fn variables(bytes: &[u8]) -> Result<Result<Dataset, HydroError>, Error> {
    let file = Hdf5File::from_bytes(bytes)?;
    let root = file.root_group()?;
    let offset_size = root.offset_size();
    let sets = root.datasets()?;
    let name_at: BTreeMap<u64, &str> = sets.iter().map(|set| (set.address(), set.name())).collect();
    let mut variables = Vec::new();
    for set in sets.iter().filter(|set| !stands_for_a_dimension(set)) {
        let count = set
            .shape()
            .iter()
            .try_fold(1u64, |n, length| n.checked_mul(*length));
        if count.is_none_or(|count| count > LARGEST) {
            let message = format!("{} is too large, {:?}", set.name(), set.shape());
            return Err(Error::InvalidData(message));
        }
        let mut dims = dimensions(set, &name_at, offset_size)?;
        let mut shape: Vec<usize> = set.shape().iter().map(|length| *length as usize).collect();
        // Along a dimension's own axis there is a letter for each place, and not one string.
        let along_another = dims.last().is_some_and(|axis| axis != set.name());
        let values = if is_letter(set.dtype()) && along_another {
            dims.pop();
            let length = shape.pop().unwrap_or(0);
            Values::Words(words_of_letters(&set.read_raw_bytes()?, length))
        } else {
            values(set)?
        };
        let variable = Variable {
            dims,
            shape,
            values,
        };
        variables.push((set.name().to_owned(), variable));
    }
    Ok(Dataset::new(variables))
}

/// Whether a dataset stands for a dimension without coordinates: its numbers, zeros, are not data.
fn stands_for_a_dimension(set: &hdf5_reader::Dataset) -> bool {
    let name = set.attribute("NAME");
    name.is_ok_and(|name| {
        name.raw_data
            .starts_with(b"This is a netCDF dimension but not a netCDF variable")
    })
}

/// The names of the axes.
fn dimensions(
    set: &hdf5_reader::Dataset,
    name_at: &BTreeMap<u64, &str>,
    offset_size: u8,
) -> Result<Vec<String>, Error> {
    let axes = set.ndim();
    if axes == 0 {
        return Ok(Vec::new());
    }
    let Ok(list) = set.attribute("DIMENSION_LIST") else {
        // The values of a dimension itself, or an axis without a name.
        let name = |axis: usize| match axis {
            0 => set.name().to_owned(),
            more => format!("{}_{more}", set.name()),
        };
        return Ok((0..axes).map(name).collect());
    };
    let size = set.vlen_reference_size();
    let mut names = Vec::with_capacity(axes);
    for entry in list.raw_data.chunks_exact(size).take(axes) {
        let bytes = set.resolve_vlen_reference_bytes(entry, usize::from(offset_size))?;
        let references = read_object_references(&bytes, offset_size)?;
        let name = references.first().and_then(|address| name_at.get(address));
        let name = name.ok_or_else(|| {
            Error::InvalidData(format!(
                "{} has an axis whose dimension is not found",
                set.name()
            ))
        })?;
        names.push((*name).to_owned());
    }
    match names.len() == axes {
        true => Ok(names),
        false => Err(Error::InvalidData(format!(
            "{} does not name all of its axes",
            set.name()
        ))),
    }
}

fn is_letter(dtype: &Datatype) -> bool {
    let size = StringSize::Fixed(1);
    matches!(dtype, Datatype::String { size: own, .. } if *own == size)
}

/// Strings of so many letters, filled up with zeros or spaces.
fn words_of_letters(letters: &[u8], length: usize) -> Vec<String> {
    let word = |letters: &[u8]| {
        let word = String::from_utf8_lossy(letters);
        word.trim_end_matches(['\0', ' ']).to_owned()
    };
    letters.chunks_exact(length.max(1)).map(word).collect()
}

/// Numbers of any size, or strings.
fn values(set: &hdf5_reader::Dataset) -> Result<Values, Error> {
    if let Datatype::String { .. } | Datatype::VarLen { .. } = set.dtype() {
        return Ok(match set.read_strings() {
            Ok(words) => Values::Words(words),
            Err(error) => Values::Other(error.to_string()),
        });
    }
    Ok(match number_type(set.dtype()) {
        Some(stored) => Values::Numbers(unpacked(set, stored.numbers(&set.read_raw_bytes()?))?),
        None => Values::Other(kind(set.dtype()).to_owned()),
    })
}

/// What a type is that holds neither numbers nor strings.
fn kind(dtype: &Datatype) -> &'static str {
    match dtype {
        Datatype::Compound { .. } => "pairs or other groups of numbers, as complex ones are stored",
        Datatype::Enum { .. } => "words of a list (an enumeration)",
        Datatype::Array { .. } => "arrays",
        _ => "neither numbers nor strings",
    }
}

/// The stored numbers as the attributes of packing say what they are; missing ones are NaN.
fn unpacked(set: &hdf5_reader::Dataset, stored: Vec<f64>) -> Result<Vec<f64>, Error> {
    let given = |name: &str| match set.attribute(name) {
        Ok(attribute) => match number_type(&attribute.datatype) {
            Some(kind) => Ok(kind.numbers(&attribute.raw_data)),
            None => {
                let message = format!("the {name} of {} is no number", set.name());
                Err(Error::InvalidData(message))
            }
        },
        Err(_) => Ok(Vec::new()),
    };
    let missing = [given("_FillValue")?, given("missing_value")?].concat();
    let scale = given("scale_factor")?.first().copied().unwrap_or(1.0);
    let offset = given("add_offset")?.first().copied().unwrap_or(0.0);
    let value = |stored: f64| match missing.contains(&stored) {
        true => f64::NAN,
        false => stored * scale + offset,
    };
    Ok(stored.into_iter().map(value).collect())
}

/// How numbers are stored.
struct NumberType {
    size: usize,
    order: ByteOrder,
    signed: bool,
    decode: fn([u8; 8]) -> f64,
}

/// The type of numbers of a size that is read; none for what is no number.
fn number_type(dtype: &Datatype) -> Option<NumberType> {
    let (size, order) = match dtype {
        Datatype::FloatingPoint { size, byte_order } => (*size, *byte_order),
        Datatype::FixedPoint {
            size, byte_order, ..
        } => (*size, *byte_order),
        _ => return None,
    };
    let signed = matches!(dtype, Datatype::FixedPoint { signed: true, .. });
    let decode: fn([u8; 8]) -> f64 = match (dtype, size) {
        (Datatype::FloatingPoint { .. }, 8) => |b| f64::from_le_bytes(b),
        (Datatype::FloatingPoint { .. }, 4) => {
            |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        }
        (Datatype::FixedPoint { .. }, 1..=8) if signed => |b| i64::from_le_bytes(b) as f64,
        (Datatype::FixedPoint { .. }, 1..=8) => |b| u64::from_le_bytes(b) as f64,
        _ => return None,
    };
    Some(NumberType {
        size: usize::from(size),
        order,
        signed,
        decode,
    })
}

impl NumberType {
    fn numbers(&self, raw: &[u8]) -> Vec<f64> {
        let size = self.size;
        let number = |bytes: &[u8]| {
            let mut ordered = [0; 8];
            ordered[..size].copy_from_slice(bytes);
            if self.order == ByteOrder::BigEndian {
                ordered[..size].reverse();
            }
            if self.signed && ordered[size - 1] >= 0x80 {
                ordered[size..].fill(0xff);
            }
            (self.decode)(ordered)
        };
        raw.chunks_exact(size).map(number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_neither_numbers_nor_strings_is_named_in_words() {
        let pair = Datatype::Compound {
            size: 16,
            fields: Vec::new(),
        };
        assert!(number_type(&pair).is_none());
        assert!(kind(&pair).contains("complex"));
    }
}
