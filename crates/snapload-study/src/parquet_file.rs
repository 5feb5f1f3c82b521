//! Reads columns of Parquet files, from any row.
//!
//! The Parquet project's own readers and writers of columns do this without Arrow, whose code for
//! all types takes longer to compile than all other dependencies of the command line.

use half::f16;
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, get_typed_column_reader};
use parquet::data_type::{
    BoolType, ByteArrayType, DataType, DoubleType, FixedLenByteArrayType, FloatType, Int32Type,
    Int64Type,
};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::FileMetaData;
use parquet::file::reader::FileReader;
use parquet::file::serialized_reader::{ReadOptionsBuilder, SerializedFileReader};
use parquet::schema::types::Type;
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

/// The type of a column's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnType {
    /// Doubles.
    Numbers,
    /// Whole numbers.
    Counts,
    /// True and false.
    Flags,
    /// Texts.
    Words,
}

/// The values of a column, each of which may be missing.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Doubles.
    Numbers(Vec<Option<f64>>),
    /// Whole numbers.
    Counts(Vec<Option<i64>>),
    /// True and false.
    Flags(Vec<Option<bool>>),
    /// Texts.
    Words(Vec<Option<Cow<'static, str>>>),
}

/// Applies the same expression to each type of values.
macro_rules! of_each {
    ($values:expr, $list:ident => $do:expr) => {
        match $values {
            Values::Numbers($list) => $do,
            Values::Counts($list) => $do,
            Values::Flags($list) => $do,
            Values::Words($list) => $do,
        }
    };
}

impl Values {
    /// An empty column.
    pub(crate) fn none(column_type: ColumnType) -> Self {
        Self::with_room(column_type, 0)
    }

    /// An empty column with room for so many values.
    pub(crate) fn with_room(column_type: ColumnType, count: usize) -> Self {
        match column_type {
            ColumnType::Numbers => Self::Numbers(Vec::with_capacity(count)),
            ColumnType::Counts => Self::Counts(Vec::with_capacity(count)),
            ColumnType::Flags => Self::Flags(Vec::with_capacity(count)),
            ColumnType::Words => Self::Words(Vec::with_capacity(count)),
        }
    }

    /// The number of values.
    pub(crate) fn len(&self) -> usize {
        of_each!(self, list => list.len())
    }

    /// Appends values of the same type.
    pub(crate) fn append(&mut self, others: Self) {
        match (self, others) {
            (Self::Numbers(list), Self::Numbers(more)) => list.extend(more),
            (Self::Counts(list), Self::Counts(more)) => list.extend(more),
            (Self::Flags(list), Self::Flags(more)) => list.extend(more),
            (Self::Words(list), Self::Words(more)) => list.extend(more),
            _ => {}
        }
    }

    /// Removes and returns the first `count` values.
    pub(crate) fn take_first(&mut self, count: usize) -> Self {
        match self {
            Self::Numbers(list) => Self::Numbers(list.drain(..count).collect()),
            Self::Counts(list) => Self::Counts(list.drain(..count).collect()),
            Self::Flags(list) => Self::Flags(list.drain(..count).collect()),
            Self::Words(list) => Self::Words(list.drain(..count).collect()),
        }
    }
}

/// With these bytes a Parquet file begins and ends.
const MAGIC: &[u8; 4] = b"PAR1";

/// Whether a file begins as one of Parquet does, and may be damaged at the most.
pub(crate) fn is_parquet(path: &Path) -> io::Result<bool> {
    let mut begin = Vec::new();
    File::open(path)?
        .take(MAGIC.len() as u64)
        .read_to_end(&mut begin)?;
    Ok(begin == MAGIC)
}

/// A file that is read.
pub(crate) struct Reader {
    pub(crate) reader: SerializedFileReader<File>,
    /// The same, for its bytes.
    pub(crate) file: File,
}

impl Reader {
    /// The compressions that can be read, besides none.
    pub(crate) const CODECS: &'static str = "snappy, gzip, brotli, lz4, zstd";

    /// The compression of a column that can not be read, if there is one.
    pub(crate) fn codec_without_reader(&self) -> Option<&'static str> {
        let groups = self.reader.metadata().row_groups().iter();
        let mut codecs = groups
            .flat_map(|group| group.columns())
            .map(|column| column.compression());
        codecs
            .any(|codec| codec == Compression::LZO)
            .then_some("lzo")
    }

    pub(crate) fn open(file: File) -> Result<Self> {
        let all = ReadOptionsBuilder::new().with_encoding_stats_as_mask(false);
        let reader = SerializedFileReader::new_with_options(file.try_clone()?, all.build())?;
        Ok(Self { reader, file })
    }

    /// The metadata of the file.
    pub(crate) fn about(&self) -> &FileMetaData {
        self.reader.metadata().file_metadata()
    }

    /// The names of the columns, and their types; none for a type that is not in [`Values`].
    pub(crate) fn fields(&self) -> impl Iterator<Item = (&Type, Option<ColumnType>)> {
        let fields = self.about().schema().get_fields().iter();
        fields.map(|field| (&**field, column_type(field)))
    }

    /// The number of rows of each group.
    pub(crate) fn groups(&self) -> impl ExactSizeIterator<Item = u64> {
        let groups = self.reader.metadata().row_groups().iter();
        groups.map(|group| group.num_rows().unsigned_abs())
    }

    /// Values of columns, given by index, in some rows of a group.
    pub(crate) fn read(
        &self,
        group: usize,
        columns: &[usize],
        rows: Range<u64>,
    ) -> Result<Vec<Values>> {
        let fields: Vec<(&Type, Option<ColumnType>)> = self.fields().collect();
        let group = self.reader.get_row_group(group)?;
        let read = |&place: &usize| match fields.get(place) {
            Some((field, Some(_))) => get(group.get_column_reader(place)?, field, &rows),
            _ => Err(ParquetError::General(format!(
                "column {} can not be read",
                place + 1
            ))),
        };
        columns.iter().map(read).collect()
    }
}

/// The type of a column's values, for numbers, texts, and true or false.
fn column_type(field: &Type) -> Option<ColumnType> {
    use ConvertedType as As;
    let about = field.get_basic_info();
    if !field.is_primitive() || about.repetition() == Repetition::REPEATED {
        return None;
    }
    match (
        field.get_physical_type(),
        about.converted_type(),
        about.logical_type_ref(),
    ) {
        (Physical::BOOLEAN, ..) => Some(ColumnType::Flags),
        (Physical::FLOAT | Physical::DOUBLE, ..) => Some(ColumnType::Numbers),
        (_, As::DECIMAL, _) => Some(ColumnType::Numbers),
        (Physical::FIXED_LEN_BYTE_ARRAY, _, Some(LogicalType::Float16)) => {
            Some(ColumnType::Numbers)
        }
        // A column of only empty cells has the unknown type.
        (Physical::INT32 | Physical::INT64, As::NONE, None | Some(LogicalType::Unknown)) => {
            Some(ColumnType::Counts)
        }
        (Physical::INT32 | Physical::INT64, kind, _) if is_whole(kind) => Some(ColumnType::Counts),
        (Physical::BYTE_ARRAY, As::UTF8 | As::JSON, _) => Some(ColumnType::Words),
        _ => None,
    }
}

fn is_whole(kind: ConvertedType) -> bool {
    use ConvertedType as As;
    let signed = matches!(kind, As::INT_8 | As::INT_16 | As::INT_32 | As::INT_64);
    signed || matches!(kind, As::UINT_8 | As::UINT_16 | As::UINT_32 | As::UINT_64)
}

fn get(reader: ColumnReader, field: &Type, rows: &Range<u64>) -> Result<Values> {
    use ConvertedType as As;
    let kind = field.get_basic_info().converted_type();
    if kind == As::DECIMAL {
        return decimals(reader, rows, 10_f64.powi(field.get_scale())).map(Values::Numbers);
    }
    Ok(match reader {
        ColumnReader::BoolColumnReader(_) => {
            Values::Flags(list::<BoolType, _>(reader, rows, |flag| Ok(*flag))?)
        }
        ColumnReader::FloatColumnReader(_) => {
            Values::Numbers(list::<FloatType, _>(reader, rows, |n| Ok(f64::from(*n)))?)
        }
        ColumnReader::DoubleColumnReader(_) => {
            Values::Numbers(list::<DoubleType, _>(reader, rows, |n| Ok(*n))?)
        }
        ColumnReader::Int32ColumnReader(_) => {
            let unsigned = matches!(kind, As::UINT_8 | As::UINT_16 | As::UINT_32);
            let whole = |n: i32| match unsigned {
                true => i64::from(n as u32),
                false => i64::from(n),
            };
            Values::Counts(list::<Int32Type, _>(reader, rows, |n| Ok(whole(*n)))?)
        }
        ColumnReader::Int64ColumnReader(_) => {
            let unsigned = kind == As::UINT_64;
            let counts = list::<Int64Type, _>(reader, rows, |n| Ok(*n))?;
            let too_large = |n: &i64| unsigned && *n < 0;
            match counts.iter().flatten().any(too_large) {
                // As doubles, so that the key refuses them in the rows where they are.
                true => Values::Numbers(
                    counts
                        .into_iter()
                        .map(|n| n.map(|n| n as u64 as f64))
                        .collect(),
                ),
                false => Values::Counts(counts),
            }
        }
        ColumnReader::ByteArrayColumnReader(_) => {
            Values::Words(list::<ByteArrayType, _>(reader, rows, |word| {
                Ok(String::from_utf8_lossy(word.data()).into_owned().into())
            })?)
        }
        ColumnReader::FixedLenByteArrayColumnReader(_) => {
            Values::Numbers(list::<FixedLenByteArrayType, _>(reader, rows, |n| {
                let bytes = n.data().try_into();
                let bytes = bytes.map_err(|_| refused("half a double takes two bytes"))?;
                Ok(f16::from_le_bytes(bytes).to_f64())
            })?)
        }
        ColumnReader::Int96ColumnReader(_) => {
            return Err(refused("a date or time is not a number"));
        }
    })
}

/// Whole numbers of any width, divided by the scale of their column.
fn decimals(reader: ColumnReader, rows: &Range<u64>, scale: f64) -> Result<Vec<Option<f64>>> {
    let of_bytes = |bytes: &[u8]| Ok(whole(bytes) / scale);
    match reader {
        ColumnReader::Int32ColumnReader(_) => {
            list::<Int32Type, _>(reader, rows, |n| Ok(f64::from(*n) / scale))
        }
        ColumnReader::Int64ColumnReader(_) => {
            list::<Int64Type, _>(reader, rows, |n| Ok(*n as f64 / scale))
        }
        ColumnReader::ByteArrayColumnReader(_) => {
            list::<ByteArrayType, _>(reader, rows, |n| of_bytes(n.data()))
        }
        ColumnReader::FixedLenByteArrayColumnReader(_) => {
            list::<FixedLenByteArrayType, _>(reader, rows, |n| of_bytes(n.data()))
        }
        _ => Err(refused("a decimal is a whole number or bytes")),
    }
}

fn refused(why: &str) -> ParquetError {
    ParquetError::General(why.to_owned())
}

/// The integer of bytes in two's complement, the highest first; rounded if it is so large that no
/// key accepts it.
fn whole(bytes: &[u8]) -> f64 {
    let negative = bytes.first().is_some_and(|byte| *byte > 0x7f);
    let start = if negative { -1_i128 } else { 0 };
    let exact = bytes.iter().try_fold(start, |number, byte| {
        Some(number.checked_mul(256)? | i128::from(*byte))
    });
    let rounded = || {
        let start = if negative { -1.0 } else { 0.0 };
        let next = |number: f64, byte: &u8| number * 256.0 + f64::from(*byte);
        bytes.iter().fold(start, next)
    };
    exact.map_or_else(rounded, |number| number as f64)
}

fn list<D: DataType, V>(
    reader: ColumnReader,
    rows: &Range<u64>,
    read: impl Fn(&D::T) -> Result<V>,
) -> Result<Vec<Option<V>>> {
    let (skip, count) = (rows.start as usize, (rows.end - rows.start) as usize);
    let mut reader = get_typed_column_reader::<D>(reader);
    reader.skip_records(skip)?;
    let (mut values, mut there) = (Vec::new(), Vec::new());
    let (found, ..) = reader.read_records(count, Some(&mut there), None, &mut values)?;
    let mut values = values.iter();
    // A column in which no value may be missing has no definition levels.
    there.resize(found, 1);
    let list = there.into_iter().map(|level: i16| match level {
        0 => Ok(None),
        _ => values.next().map(&read).transpose(),
    });
    list.collect()
}
