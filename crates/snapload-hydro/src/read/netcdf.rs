//! netCDF4, which is HDF5 with named dimensions.
//!
//! A dimension is a dataset of the attribute CLASS = "DIMENSION_SCALE", whose name is the
//! dimension's; every other dataset has an attribute DIMENSION_LIST with a reference to one of them
//! for each of its axes. Source: *NetCDF-4 File Format*, in the documentation of netCDF-C.

use super::dataset::{Dataset, Values, Variable};
use crate::error::HydroError;
use hdf5_reader::error::Error;
use hdf5_reader::reference::read_object_references;
use hdf5_reader::{ByteOrder, Datatype, Hdf5File};
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
    for set in &sets {
        let count = set
            .shape()
            .iter()
            .try_fold(1u64, |n, length| n.checked_mul(*length));
        if count.is_none_or(|count| count > LARGEST) {
            let message = format!("{} is too large, {:?}", set.name(), set.shape());
            return Err(Error::InvalidData(message));
        }
        let variable = Variable {
            dims: dimensions(set, &name_at, offset_size)?,
            shape: set.shape().iter().map(|length| *length as usize).collect(),
            values: values(set)?,
        };
        variables.push((set.name().to_owned(), variable));
    }
    Ok(Dataset::new(variables))
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

/// Numbers of any size, or strings.
fn values(set: &hdf5_reader::Dataset) -> Result<Values, Error> {
    let (size, order) = match set.dtype() {
        Datatype::FloatingPoint { size, byte_order } => (*size, *byte_order),
        Datatype::FixedPoint {
            size, byte_order, ..
        } => (*size, *byte_order),
        Datatype::String { .. } | Datatype::VarLen { .. } => {
            return Ok(match set.read_strings() {
                Ok(words) => Values::Words(words),
                Err(error) => Values::Other(error.to_string()),
            });
        }
        other => return Ok(Values::Other(format!("{other:?}"))),
    };
    let decode: fn([u8; 8]) -> f64 = match (set.dtype(), size) {
        (Datatype::FloatingPoint { .. }, 8) => |b| f64::from_le_bytes(b),
        (Datatype::FloatingPoint { .. }, 4) => {
            |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        }
        (Datatype::FixedPoint { signed: true, .. }, 1..=8) => |b| i64::from_le_bytes(b) as f64,
        (Datatype::FixedPoint { .. }, 1..=8) => |b| u64::from_le_bytes(b) as f64,
        (other, _) => return Ok(Values::Other(format!("{other:?}"))),
    };
    let signed = matches!(set.dtype(), Datatype::FixedPoint { signed: true, .. });
    let size = size as usize;
    let number = |bytes: &[u8]| {
        let mut ordered = [0; 8];
        ordered[..size].copy_from_slice(bytes);
        if order == ByteOrder::BigEndian {
            ordered[..size].reverse();
        }
        if signed && ordered[size - 1] >= 0x80 {
            ordered[size..].fill(0xff);
        }
        decode(ordered)
    };
    let raw = set.read_raw_bytes()?;
    Ok(Values::Numbers(
        raw.chunks_exact(size).map(number).collect(),
    ))
}
